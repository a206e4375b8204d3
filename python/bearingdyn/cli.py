"""The command line: `bearingdyn fit`, `show`, `check`, `demo` and `version`.

Results go to standard output; progress, and warnings and errors of one line each, to standard error. The exit
code is 0, 1 where a check does not hold, 2 for a command or input that cannot be used, 130 after Ctrl-C.
"""

from __future__ import annotations

import argparse
import json
import math
import os
import sys
import warnings
from collections.abc import Callable, Sequence
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal, TypeAlias

import numpy as np

from bearingdyn import results
from bearingdyn.material import MasterCurve, Maxwell, fit_maxwell, master_curve, read_dma

if TYPE_CHECKING:
    import xarray

Command: TypeAlias = Callable[[argparse.Namespace], tuple[str, int]]
"""a command's text for standard output, and its exit code"""

GOOD, FAILED, UNUSABLE, INTERRUPTED = 0, 1, 2, 130

EPILOG = """\
examples:
  bearingdyn fit rubber.csv --n 5 --band 10 5000 --out rubber.json
  bearingdyn show result.nc
  bearingdyn check
  bearingdyn demo --out demo

Every command takes --json and --help. Exit codes: 0 good, 1 a check does not hold, 2 a command or input
that cannot be used. SI units throughout, temperatures in C.
"""

# usual for rubber; said in the table where they were not given
BULK_MODULUS = 2e9
DENSITY = 1200.0
# of an attribute, in a listing
LONGEST = 120


def main(argv: Sequence[str] | None = None) -> int:
    """Run a command, sys.argv's when none is given, and return its exit code."""
    parser = _parser()
    try:
        arguments = parser.parse_args(argv)
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
        print(f"bearingdyn: {_line(error)}", file=sys.stderr)
        return UNUSABLE
    except KeyboardInterrupt:
        print("bearingdyn: interrupted", file=sys.stderr)
        return INTERRUPTED
    return code


def _line(message: object) -> str:
    return " ".join(str(message).split())


def _branches(text: str) -> int | Literal["auto"]:
    """A number of branches, or "auto"."""
    return "auto" if text == "auto" else int(text)


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="bearingdyn",
        description="Dynamics of rotors on ball bearings with viscoelastic layers.",
        epilog=EPILOG,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    commands = parser.add_subparsers(required=True, metavar="command")

    fit = commands.add_parser(
        "fit",
        help="a Maxwell model from measured DMA data",
        description="Shift the isotherms of a DMA measurement to a master curve and fit a Maxwell model.",
    )
    fit.set_defaults(run=_fit)
    fit.add_argument("data", help="table of isothermal frequency sweeps, with a header")
    fit.add_argument("--n", type=_branches, default=5, help='number of branches, or "auto" (default 5)')
    fit.add_argument(
        "--band", type=float, nargs=2, metavar=("LOW", "HIGH"), help="frequencies to fit between at T-ref, Hz"
    )
    fit.add_argument(
        "--T-ref", type=float, default=20.0, metavar="T", help="reference temperature, C (default 20)"
    )
    fit.add_argument(
        "--law", choices=("wlf", "arrhenius", "joined", "free"), default="wlf", help="shift law (default wlf)"
    )
    fit.add_argument("--K", type=float, help=f"bulk modulus, Pa (default {BULK_MODULUS:g}, usual for rubber)")
    fit.add_argument("--density", type=float, help=f"kg/m3 (default {DENSITY:g}, usual for rubber)")
    fit.add_argument("--mode", choices=("shear", "tension"), help="where the header does not say it")
    fit.add_argument("--f-max", type=float, metavar="F", help="leave out what was measured above, Hz")
    fit.add_argument("--no-clean", action="store_true", help="keep points that look like fixture resonance")
    fit.add_argument("--out", metavar="FILE", help="write the model there, as Maxwell.from_json reads it")
    fit.add_argument("--json", action="store_true", help="print JSON instead of a table")

    show = commands.add_parser(
        "show",
        help="what a result file holds",
        description="List groups, dimensions, variables with their units, and attributes of a result file, "
        "or of the file of a running march.",
    )
    show.set_defaults(run=_show)
    show.add_argument("result", help="file written by bearingdyn.save")
    show.add_argument("--json", action="store_true", help="print JSON instead of a table")

    check = commands.add_parser(
        "check",
        help="the installed package against published numbers and closed forms",
        description="Compute some thirty cases with a published value or a closed form, in a few seconds. "
        "The exit code is 1 where one does not hold.",
    )
    check.set_defaults(run=_check)
    check.add_argument("--json", action="store_true", help="print JSON instead of a table")

    demo = commands.add_parser(
        "demo",
        help="a small motor with and without a rubber layer, from shipped data",
        description="Fit a rubber from the data shipped with the package, put a layer of it around the "
        "bearings of a small motor, compute response and transient with it and without; write result.nc "
        "and response.png.",
    )
    demo.set_defaults(run=_demo)
    demo.add_argument(
        "--out", default="bearingdyn-demo", metavar="FOLDER", help="where to (default bearingdyn-demo)"
    )
    demo.add_argument("--json", action="store_true", help="print JSON instead of a table")

    about = commands.add_parser("version", help="versions of the package and what it computes with")
    about.set_defaults(run=_about)
    about.add_argument("--json", action="store_true", help="print JSON instead of a table")
    return parser


# ---------------------------------------------------------------- fit


def _fit(arguments: argparse.Namespace) -> tuple[str, int]:
    out = None if arguments.out is None else Path(arguments.out)
    if out is not None and not out.resolve().parent.is_dir():
        raise ValueError(f"--out {out}: there is no folder {out.parent}")
    if arguments.f_max is not None and not arguments.f_max > 0:
        raise ValueError(f"--f-max is {arguments.f_max}; it must be a positive frequency, in Hz")
    dma = read_dma(arguments.data, arguments.mode)
    if arguments.f_max is not None:
        dma = dma.select(f_max=arguments.f_max)
    curve = master_curve(dma, T_ref=arguments.T_ref, law=arguments.law, clean=not arguments.no_clean)
    band = None if arguments.band is None else (arguments.band[0], arguments.band[1])
    model = fit_maxwell(
        curve,
        n=arguments.n,
        band=band,
        K=BULK_MODULUS if arguments.K is None else arguments.K,
        density=DENSITY if arguments.density is None else arguments.density,
    )
    if out is not None:
        out.write_text(model.to_json() + "\n", encoding="utf-8")
    if arguments.json:
        return json.dumps({**_fit_record(curve, model), "data": arguments.data}, indent=1), GOOD
    text = _fit_table(
        curve, model, K_given=arguments.K is not None, density_given=arguments.density is not None
    )
    return (text if out is None else f"{text}\nwritten to {out}"), GOOD


def _fit_record(curve: MasterCurve, model: Maxwell) -> dict[str, Any]:
    report = model.fit
    assert report is not None  # fit_maxwell leaves one
    return {
        "maxwell": json.loads(model.to_json()),
        "fit": {
            "band": list(report.band),
            "points": report.points,
            "storage_rms": report.storage_rms,
            "storage_max": report.storage_max,
            "tan_delta_rms": report.tan_delta_rms,
            "tan_delta_max": report.tan_delta_max,
        },
        "master": {
            "T_ref": curve.T_ref,
            "mode": curve.mode,
            "frequency": [float(curve.frequency[0]), float(curve.frequency[-1])],
            "shifts": [{"temperature": T, "log_aT": shift} for T, shift in curve.shifts.items()],
            "law_residual": curve.law_residual,
            "kk_residual": list(curve.kk_residual),
        },
    }


def _fit_table(curve: MasterCurve, model: Maxwell, K_given: bool, density_given: bool) -> str:
    report = model.fit
    assert report is not None  # fit_maxwell leaves one

    storage, loss = curve.kk_residual

    def assumed(given: bool) -> str:
        return "" if given else "  (assumed)"

    lines = [
        f"master curve   {len(curve.shifts)} isotherms in {curve.mode}, {curve.frequency[0]:.3g} to "
        f"{curve.frequency[-1]:.3g} Hz at {curve.T_ref:g} C",
        f"shift law      {type(curve.law).__name__}, rms {curve.law_residual:.3f} decades",
        f"causality      rms {storage:.2%} of the storage, {loss:.2%} of the loss modulus",
        "",
        f"Maxwell model in shear at {curve.T_ref:g} C",
        f"  G0           {model.G0:12.5g} Pa",
        *(
            f"  G{i:<2d}          {G:12.5g} Pa     tau{i:<2d} {tau:12.5g} s"
            for i, (G, tau) in enumerate(zip(model.G, model.tau, strict=True), 1)
        ),
        f"  eta0         {model.eta0:12.5g} Pa s",
        f"  K            {model.K:12.5g} Pa{assumed(K_given)}",
        f"  density      {model.density:12.5g} kg/m3{assumed(density_given)}",
        "",
        f"errors of the {report.points} points from {report.band[0]:g} to {report.band[1]:g} Hz",
        f"  storage modulus  rms {report.storage_rms:.2%}   largest {report.storage_max:.2%}",
        f"  tan delta        rms {report.tan_delta_rms:.2%}   largest {report.tan_delta_max:.2%}",
    ]
    return "\n".join(lines)


# ---------------------------------------------------------------- show


def _show(arguments: argparse.Namespace) -> tuple[str, int]:
    path = Path(arguments.result)
    if not path.is_file():
        raise ValueError(
            f"{path}: " + ("is a folder, not a result file" if path.is_dir() else "no such file")
        )
    names = results.groups(path)
    held = {name: _describe(results.load(path, name)) for name in ("", *names)}
    if names and not held[""]["variables"]:
        del held[""]
    if arguments.json:
        return json.dumps({"file": str(path), "groups": held}, indent=1), GOOD
    return "\n\n".join(_listing(name, group) for name, group in held.items()), GOOD


def _describe(data: xarray.Dataset) -> dict[str, Any]:
    return {
        "dims": {str(name): int(size) for name, size in data.sizes.items()},
        "coords": {str(name): _variable(v) for name, v in data.coords.items()},
        "variables": {str(name): _variable(v) for name, v in data.data_vars.items()},
        "attrs": {str(name): _plain(value) for name, value in data.attrs.items()},
    }


def _variable(array: xarray.DataArray) -> dict[str, Any]:
    return {
        "dims": [str(d) for d in array.dims],
        "dtype": "text" if array.dtype.kind in "OUS" else str(array.dtype),
        "units": str(array.attrs.get("units", "")),
        "long_name": str(array.attrs.get("long_name", "")),
    }


def _plain(value: Any) -> Any:
    return value.tolist() if isinstance(value, np.ndarray | np.generic) else value


def _listing(name: str, group: dict[str, Any]) -> str:
    lines = [f"group {name}" if name else "root group"]
    lines.append("  dims   " + ", ".join(f"{dim} {size}" for dim, size in group["dims"].items()))
    for kind in ("coords", "variables"):
        for variable, about in group[kind].items():
            label = f"  {'coord' if kind == 'coords' else 'var':<6} {variable} ({', '.join(about['dims'])})"
            unit = f"[{about['units']}]" if about["units"] else ""
            lines.append(f"{label:<44} {about['dtype']:<10} {unit:<8} {about['long_name']}".rstrip())
    lines += [f"  attr   {key} = {_short(value)}" for key, value in group["attrs"].items()]
    return "\n".join(lines)


def _short(value: Any) -> str:
    text = str(value)
    return text if len(text) <= LONGEST else f"{text[:LONGEST]} … ({len(text)} characters, whole with --json)"


# ---------------------------------------------------------------- check, demo


def _check(arguments: argparse.Namespace) -> tuple[str, int]:
    from bearingdyn.check import check

    found = check(lambda done, total: _tell(f"check {done} of {total}"))
    code = GOOD if all(row.holds for row in found) else FAILED
    if arguments.json:
        rows = [{**asdict(row), "error": row.error, "holds": row.holds} for row in found]
        plain = json.dumps({"holds": code == GOOD, "rows": _finite(rows)}, indent=1)
        return plain, code
    lines = [f"{'case':<54} {'expected':>12} {'computed':>12} {'error':>8} {'allowed':>8}  source"]
    for row in found:
        mark = row.source if row.holds else f"DOES NOT HOLD {row.raised or row.source}"
        numbers = f"{row.expected:12.7g} {row.computed:12.7g} {row.error:8.1e} {row.tolerance:8.1e}"
        lines.append(f"{row.case:<54} {numbers}  {mark}")
    bad = sum(not row.holds for row in found)
    lines += ["", f"{len(found)} cases, " + ("all hold" if not bad else f"{bad} DO NOT HOLD")]
    return "\n".join(lines), code


def _finite(value: Any) -> Any:
    """With None for what JSON has no number for."""
    if isinstance(value, list):
        return [_finite(item) for item in value]
    if isinstance(value, dict):
        return {key: _finite(item) for key, item in value.items()}
    return None if isinstance(value, float) and not math.isfinite(value) else value


def _demo(arguments: argparse.Namespace) -> tuple[str, int]:
    from bearingdyn.demo import demo

    found = demo(Path(arguments.out), _tell)
    if arguments.json:
        return json.dumps(found, indent=1), GOOD
    bare, layered = found["no layer"], found["layer"]
    lines = [f"{'zero-to-peak, per N at mid-shaft':<40} {'no layer':>12} {'layer':>12} {'change':>10}"]
    for name, label, unit in (
        ("static_receptance", "static deflection of the shaft, m/N", ""),
        ("shaft_peak", "highest peak of the shaft, m/N", "dB"),
        ("housing_rms_1_to_5_kHz", "housing over 1 to 5 kHz, rms, m/N", "dB"),
        ("housing_velocity_rms", "housing velocity at 3000 rpm, rms, m/s", "dB"),
    ):
        ratio = layered[name] / bare[name]
        change = f"{20 * math.log10(ratio):+.1f} dB" if unit else f"x {ratio:.2f}"
        lines.append(f"{label:<40} {bare[name]:12.3g} {layered[name]:12.3g} {change:>10}")
    return "\n".join([*lines, "", *(f"written to {path}" for path in found["files"])]), GOOD


def _tell(line: str) -> None:
    """Progress, where a person may be reading."""
    print(f"bearingdyn: {line}", file=sys.stderr, flush=True)


# ---------------------------------------------------------------- version


def _about(arguments: argparse.Namespace) -> tuple[str, int]:
    found = dict(results.versions())
    if arguments.json:
        return json.dumps(found, indent=1), GOOD
    own = found.pop("bearingdyn")
    return f"bearingdyn {own}\n" + ", ".join(f"{name} {number}" for name, number in found.items()), GOOD


if __name__ == "__main__":
    sys.exit(main())
