"""`bearingdyn run` and `bearingdyn check motor.toml`: a model file from the command line."""

from __future__ import annotations

import argparse
import json
import sys
from pathlib import Path
from typing import Any

from bearingdyn.cli.outcome import GOOD


def run_model(arguments: argparse.Namespace) -> tuple[str, int]:
    """The command `bearingdyn run`: every analysis of a model file, into one result file."""
    from bearingdyn.model import read_model
    from bearingdyn.results import save

    model = read_model(arguments.model, **parameters_of(arguments.set))
    out = Path(arguments.out or Path(arguments.model).with_suffix(".nc").name)
    found = model.run(lambda line: print(f"bearingdyn: {line}", file=sys.stderr, flush=True))
    if found:
        save(found, out)
    rows = {
        name: {"analysis": str(data.attrs.get("analysis", "")), "sizes": _sizes(data)}
        for name, data in found.items()
    }
    if arguments.json:
        return json.dumps({"file": str(out) if found else None, "results": rows}, indent=1), GOOD
    lines = [f"{name:<24} {row['analysis']}: {row['sizes']}" for name, row in rows.items()]
    if not found:
        return "the model asks for no analysis; add [[analyses]] with a type", GOOD
    return "\n".join([*lines, "", f"written to {out}"]), GOOD


def check_model(arguments: argparse.Namespace) -> tuple[str, int]:
    """The command `bearingdyn check motor.toml`: `run` without analyses; joins the model, says what it is."""
    from bearingdyn.model import read_model
    from bearingdyn.system import assemble

    model = read_model(arguments.model, **parameters_of(arguments.set))
    assemble(model.application)
    if arguments.json:
        plan = model.application.plan
        asked = {one.name: one.kind for one in model.analyses}
        held = {"parts": list(plan.parts), "bearings": list(plan.bearings), "analyses": asked}
        return json.dumps(
            {"title": model.title, "parameters": dict(model.parameters), **held}, indent=1
        ), GOOD
    lines = [model.title] if model.title else []
    lines += [model.application.summary(), "analyses"]
    lines += [f"  {one.name}: {one.kind}" for one in model.analyses] or ["  none"]
    return "\n".join(lines), GOOD


def parameters_of(given: list[str]) -> dict[str, Any]:
    """Parameters name=value for the command `bearingdyn run`: numbers where they are."""
    found: dict[str, Any] = {}
    for text in given:
        name, sign, value = text.partition("=")
        if not (sign and name):
            raise ValueError(f"--set is {text!r}; it must be NAME=VALUE, such as thickness=0.003")
        try:
            found[name] = float(value)
        except ValueError:
            found[name] = value
    return found


def _sizes(data: Any) -> str:
    """How large a Dataset is, in words."""
    return ", ".join(f"{count} {name}" for name, count in data.sizes.items())
