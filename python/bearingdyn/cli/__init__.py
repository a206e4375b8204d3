"""The command line: `fit`, `show`, `bearing`, `run`, `report`, `explore`, `check`, `demo`, `version`.

Results go to standard output; progress, and warnings and errors of one line each, to standard error. The exit
code is 0, 1 where a check does not hold, 2 for a command or input that cannot be used, 130 after Ctrl-C.
"""

from __future__ import annotations

import argparse
import functools
import os
import re
import sys
import warnings
from collections.abc import Sequence
from typing import Literal

from bearingdyn.cli.bearing import run_bearing
from bearingdyn.cli.check_demo_version import run_check, run_demo, run_version
from bearingdyn.cli.explore import run_explorer
from bearingdyn.cli.fit import BULK_MODULUS, DENSITY, LAW, T_REF, run_fit
from bearingdyn.cli.make_report import make_report
from bearingdyn.cli.outcome import GOOD, INTERRUPTED, UNUSABLE, Command
from bearingdyn.cli.run_model import run_model
from bearingdyn.cli.show import run_show
from bearingdyn.results import versions

EPILOG = """\
examples:
  bearingdyn fit rubber.csv --n 5 --band 10 5000 --out rubber.json
  bearingdyn fit sweep_20C.csv --temperature 20 --n auto
  bearingdyn fit trios.txt --step "Frequency sweep" --run a b
  bearingdyn show result.nc
  bearingdyn bearing 6205/C3 --radial 2000 --axial 300 --rpm 3000 --oil VG32 --temperature 70
  bearingdyn check
  bearingdyn check motor.toml
  bearingdyn run motor.toml --out motor.nc --set thickness=0.003
  bearingdyn report motor.toml --results motor.nc --out motor.html
  bearingdyn explore motor.toml
  bearingdyn demo --out demo

Every command takes --json and --help. Exit codes: 0 good, 1 a check does not hold, 2 a command or input
that cannot be used. SI units throughout, temperatures in C.
"""

NEGATIVE = re.compile(r"-([0-9]+\.?[0-9]*|\.[0-9]+)e[+-]?[0-9]+|-inf(inity)?|-nan", re.IGNORECASE)


def main(argv: Sequence[str] | None = None) -> int:
    """Run a command of the command line, by default that of sys.argv, and return its exit code."""
    parser = _parser()
    given = sys.argv[1:] if argv is None else argv
    try:
        arguments = parser.parse_args([_no_option(word) for word in given])
    except SystemExit as stop:  # argparse has said why
        return int(stop.code or 0)
    # a name with θ must not stop a terminal that cannot show it
    if hasattr(sys.stdout, "reconfigure"):
        sys.stdout.reconfigure(errors="backslashreplace")
    code = GOOD
    try:
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always", UserWarning)
            command: Command = arguments.run
            text, code = command(arguments)
        for warning in caught:
            if issubclass(warning.category, UserWarning):
                print(f"bearingdyn: warning: {_line(warning.message)}", file=sys.stderr)
        print(text, flush=True)
    except BrokenPipeError:  # the reader had enough, as `head` does
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return code
    except ModuleNotFoundError as error:
        print(f"bearingdyn: this needs the package {error.name}; pip install {error.name}", file=sys.stderr)
        return UNUSABLE
    except (ValueError, OSError) as error:
        print(f"bearingdyn: {_line(_reason(error))}", file=sys.stderr)
        return UNUSABLE
    except KeyboardInterrupt:
        print("bearingdyn: interrupted", file=sys.stderr)
        return INTERRUPTED
    return code


def _no_option(word: str) -> str:
    """The word, a negative number set off by a blank: argparse takes -5e2 and -inf for options."""
    return f" {word}" if NEGATIVE.fullmatch(word) else word


def _reason(error: Exception) -> str:
    """What an error says; of a file, its name and the reason, without the system's number."""
    if isinstance(error, OSError) and error.filename is not None and error.strerror:
        return f"{error.filename}: {error.strerror}"
    return str(error)


def _line(message: object) -> str:
    return " ".join(str(message).split())


def _branches(text: str) -> int | Literal["auto"]:
    """A number of branches, or "auto"."""
    if text == "auto":
        return "auto"
    if not re.fullmatch(r"-?[0-9]{1,9}", text):
        raise argparse.ArgumentTypeError(f"it is {text[:40]!r}; it must be a whole number, or auto")
    return int(text)


@functools.cache
def _parser() -> argparse.ArgumentParser:
    """Every command with its arguments; made once, since parsing leaves it as it is."""
    parser = argparse.ArgumentParser(
        prog="bearingdyn",
        description="Dynamics of rotors on ball bearings with viscoelastic layers.",
        epilog=EPILOG,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("--version", action="version", version=f"%(prog)s {versions()['bearingdyn']}")
    commands = parser.add_subparsers(required=True, metavar="command")

    def add(name: str, run: Command, summary: str, description: str) -> argparse.ArgumentParser:
        made = commands.add_parser(name, help=summary, description=description)
        made.set_defaults(run=run)
        made.add_argument("--json", action="store_true", help="print JSON instead of a table")
        return made

    fit = add(
        "fit",
        run_fit,
        "a Maxwell model from measured DMA data",
        "Shift the isotherms of a DMA measurement to a master curve and fit a Maxwell model to it. A single "
        "sweep, such as a supplier's finished curve, and a single relaxation are fitted as they are.",
    )
    fit.add_argument(
        "data", nargs="+", help="table of isothermal frequency sweeps, with a header; or several, one each"
    )
    fit.add_argument("--n", type=_branches, default=5, help='number of branches, or "auto" (default 5)')
    fit.add_argument(
        "--band", type=float, nargs=2, metavar=("LOW", "HIGH"), help="frequencies to fit between at T-ref, Hz"
    )
    fit.add_argument("--T-ref", type=float, metavar="T", help=f"reference temperature, C (default {T_REF:g})")
    fit.add_argument(
        "--law", choices=("wlf", "arrhenius", "joined", "free"), help=f"shift law (default {LAW})"
    )
    fit.add_argument("--K", type=float, help=f"bulk modulus, Pa (default {BULK_MODULUS:g}, usual for rubber)")
    fit.add_argument("--density", type=float, help=f"kg/m3 (default {DENSITY:g}, usual for rubber)")
    fit.add_argument(
        "--units",
        nargs="+",
        default=[],
        metavar="QUANTITY=UNIT",
        help="units the header does not name: storage=kPa loss=kPa temperature=C frequency=Hz",
    )
    fit.add_argument(
        "--columns",
        nargs="+",
        default=[],
        metavar="QUANTITY=TITLE",
        help="""titles of columns the header does not make plain: storage="G' (kPa)" """,
    )
    fit.add_argument("--mode", choices=("shear", "tension"), help="where the header does not say it")
    fit.add_argument(
        "--temperature",
        type=float,
        nargs="+",
        metavar="T",
        help="of all points, C, where the table has no such column; one for each file",
    )
    fit.add_argument(
        "--step",
        nargs="+",
        metavar="STEP",
        help="steps (or sheets) to read: parts of names, or numbers from 1",
    )
    fit.add_argument(
        "--run", nargs="+", dest="run_names", metavar="RUN", help="only these runs, as a column names them"
    )
    fit.add_argument(
        "--isotherms", type=float, nargs=2, metavar=("LOW", "HIGH"), help="temperatures to use, C"
    )
    fit.add_argument("--sort", action="store_true", help="sort the points instead of refusing unsorted ones")
    fit.add_argument(
        "--drop-invalid", action="store_true", help="leave out rows whose numbers are not positive"
    )
    fit.add_argument("--f-max", type=float, metavar="F", help="leave out what was measured above, Hz")
    fit.add_argument("--no-clean", action="store_true", help="keep points that look like fixture resonance")
    fit.add_argument("--out", metavar="FILE", help="write the model there, as Maxwell.from_json reads it")
    fit.add_argument(
        "--plot", metavar="FILE", help="draw the master curve and the model, as a PNG, PDF or SVG"
    )

    show = add(
        "show",
        run_show,
        "what a result file holds",
        "List groups, dimensions, variables with their units, and attributes of a result file, or of the "
        "file of a running march.",
    )
    show.add_argument("result", help="file written by bearingdyn.save")

    sheet = add(
        "bearing",
        run_bearing,
        "the sheet of one bearing: load, life, film, friction, stiffness, lines",
        "What a bearing bears, how long, how warm and how stiff, by its designation and load; the inner ring "
        "turns, the shaft holds it upright.",
    )
    sheet.add_argument("designation", help='as people write it: 6205, "SKF 6203-2RS/C3", "7014 ACD"')
    sheet.add_argument("--radial", type=float, default=0.0, metavar="N", help="radial load, N (default 0)")
    sheet.add_argument("--axial", type=float, default=0.0, metavar="N", help="axial load, N (default 0)")
    sheet.add_argument("--rpm", type=float, default=0.0, metavar="N", help="speed of the shaft, rpm")
    sheet.add_argument("--oil", metavar="GRADE", help="ISO viscosity grade, as VG32 (default: no oil)")
    sheet.add_argument(
        "--temperature", type=float, default=40.0, metavar="T", help="of the oil, C (default 40)"
    )
    sheet.add_argument(
        "--clearance", type=float, metavar="UM", help="diametral, micrometres (default: by the class)"
    )
    sheet.add_argument(
        "--contamination",
        default="normal cleanliness",
        metavar="E",
        help='e_C from 0 to 1, or words as "high cleanliness" (default "normal cleanliness")',
    )
    sheet.add_argument(
        "--reliability", type=float, default=90.0, metavar="R", help="90 to 99 percent (default 90)"
    )
    sheet.add_argument(
        "--friction", choices=("palmgren", "four-term"), default="palmgren", help="model (default palmgren)"
    )
    sheet.add_argument("--html", metavar="FILE", help="also write the sheet there as one page")
    check = add(
        "check",
        run_check,
        "the installed package against published numbers and closed forms",
        "Compute some thirty cases with a published value or a closed form, in a few seconds. The exit code "
        "is 1 where one does not hold. With a model file: read and join it, and say what it is.",
    )
    check.add_argument("model", nargs="?", help="model file (TOML) to check instead of the package")
    run = add(
        "run",
        run_model,
        "every analysis that a model file asks for",
        "Read a model (TOML), find its equilibrium, do its analyses, and write their results to one file.",
    )
    run.add_argument("model", help="model file (TOML)")
    run.add_argument("--out", metavar="FILE", help="result file (default: the model's name with .nc)")
    page = add(
        "report",
        make_report,
        "one page of HTML about a machine and its results",
        "Write a page that needs nothing else: drawing, inputs and their doubts, state at rest, modes in "
        "motion, curves to zoom. Of a model file, whose analyses are run, or of a result file.",
    )
    page.add_argument("source", help="model file (TOML), or result file")
    page.add_argument("--out", metavar="FILE", help="the page (default: the source's name with .html)")
    page.add_argument(
        "--results", metavar="FILE", help="of a model: result file to show instead of running its analyses"
    )
    page.add_argument(
        "--sound", nargs="+", default=[], metavar="LABEL=FILE", help=".wav files to listen to on the page"
    )
    page.add_argument("--title", default="", help="of the page")
    explore = add(
        "explore",
        run_explorer,
        "sliders for a machine, in the browser",
        "Serve a page with sliders for layers, rubber, loads and clearance of a model file; response and sag "
        "follow them. Ends with Ctrl-C.",
    )
    explore.add_argument("model", help="model file (TOML)")
    explore.add_argument("--port", type=int, default=0, help="of the page (default: one that is free)")
    explore.add_argument("--host", default="127.0.0.1", help="whom to listen for (default: this machine)")
    explore.add_argument(
        "--no-browser", action="store_true", help="do not open the page, only say where it is"
    )
    for command in (check, run, page, explore):
        command.add_argument(
            "--set", nargs="+", default=[], metavar="NAME=VALUE", help="values of the model's parameters"
        )
    demo = add(
        "demo",
        run_demo,
        "a small motor with and without a rubber layer, from shipped data",
        "Fit a rubber from the data shipped with the package, put a layer of it around the bearings of a "
        "small motor, compute response and transient with it and without; write result.nc and response.png.",
    )
    demo.add_argument(
        "--out", default="bearingdyn-demo", metavar="FOLDER", help="where to (default bearingdyn-demo)"
    )
    add("version", run_version, "versions of the package and what it computes with", "Say the versions.")
    return parser
