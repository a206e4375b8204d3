"""`bearingdyn report`: a page about a model file, or a result file."""

from __future__ import annotations

import argparse
import json
import sys
from pathlib import Path

from bearingdyn.cli.outcome import GOOD
from bearingdyn.cli.run_model import parameters_of


def make_report(arguments: argparse.Namespace) -> tuple[str, int]:
    """The command `bearingdyn report`."""
    from bearingdyn.model import read_model
    from bearingdyn.reporting import report

    source = Path(arguments.source)
    out = Path(arguments.out or source.with_suffix(".html").name)
    sounds: dict[str, str] = {}
    for text in arguments.sound:
        label, sign, file = text.partition("=")
        if not (sign and label and file):
            raise ValueError(f"--sound is {text!r}; it must be LABEL=FILE, such as before=motor.wav")
        sounds[label] = file
    is_model = source.suffix.lower() == ".toml"
    if not is_model and (arguments.results or arguments.set):
        raise ValueError(f"{source} is no model file; --results and --set need one (.toml)")
    given = parameters_of(arguments.set)
    machine = read_model(source, **given) if given else source
    if arguments.results:
        page = report(arguments.results, out, model=machine, sounds=sounds, title=arguments.title, tell=_tell)
    else:
        page = report(machine, out, sounds=sounds, title=arguments.title, tell=_tell)
    size = page.stat().st_size
    if arguments.json:
        return json.dumps({"file": str(page), "bytes": size}, indent=1), GOOD
    return f"written to {page}, {size / 1e6:.2f} MB; open it in a browser", GOOD


def _tell(line: str) -> None:
    print(f"bearingdyn: {line}", file=sys.stderr, flush=True)
