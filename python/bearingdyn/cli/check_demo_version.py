"""`bearingdyn check`, `demo` and `version`: what the package says of itself."""

from __future__ import annotations

import argparse
import json
import math
import sys
from dataclasses import asdict
from pathlib import Path
from typing import Any

from bearingdyn import results
from bearingdyn.checks import require
from bearingdyn.cli.outcome import FAILED, GOOD


def run_check(arguments: argparse.Namespace) -> tuple[str, int]:
    """The command `bearingdyn check`: a row for each case; the code says whether all hold. Or of a model."""
    if arguments.model is not None:
        from bearingdyn.cli.run_model import check_model

        return check_model(arguments)
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


def run_demo(arguments: argparse.Namespace) -> tuple[str, int]:
    """The command `bearingdyn demo`: what the layer changes, and the files written."""
    from bearingdyn.demo import demo

    folder = str(arguments.out)
    require(bool(folder) and "\0" not in folder, "--out", folder, "it must be the name of a folder")
    taken = Path(folder).exists() and not Path(folder).is_dir()
    require(not taken, "--out", folder, "it exists and is no folder; it must be the name of a folder")
    found = demo(Path(folder), _tell)
    if arguments.json:
        return json.dumps(found, indent=1), GOOD
    bare, layered = found["no layer"], found["layer"]
    lines = [f"{'zero-to-peak, per N at mid-shaft':<40} {'no layer':>12} {'layer':>12} {'change':>10}"]
    for name, label, unit in (
        ("receptance_20_Hz", "deflection of the shaft at 20 Hz, m/N", ""),
        ("shaft_peak", "highest peak of the shaft, m/N", "dB"),
        ("housing_rms_1_to_5_kHz", "housing over 1 to 5 kHz, rms, m/N", "dB"),
        ("housing_velocity_rms", "housing velocity at 3000 rpm, rms, m/s", "dB"),
    ):
        ratio = layered[name] / bare[name]
        change = f"{20 * math.log10(ratio):+.1f} dB" if unit else f"x {ratio:.2f}"
        lines.append(f"{label:<40} {bare[name]:12.3g} {layered[name]:12.3g} {change:>10}")
    return "\n".join([*lines, "", *(f"written to {path}" for path in found["files"])]), GOOD


def run_version(arguments: argparse.Namespace) -> tuple[str, int]:
    """The package's own version as a command, and what it computes with."""
    found = dict(results.versions())
    if arguments.json:
        return json.dumps(found, indent=1), GOOD
    own = found.pop("bearingdyn")
    return f"bearingdyn {own}\n" + ", ".join(f"{name} {number}" for name, number in found.items()), GOOD


def _tell(line: str) -> None:
    """Progress, where a person may be reading."""
    print(f"bearingdyn: {line}", file=sys.stderr, flush=True)
