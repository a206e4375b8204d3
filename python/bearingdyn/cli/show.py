"""`bearingdyn show`: what a result file holds."""

from __future__ import annotations

import argparse
import json
from typing import TYPE_CHECKING, Any

import numpy as np

from bearingdyn import results
from bearingdyn.checks import existing
from bearingdyn.cli.outcome import GOOD

if TYPE_CHECKING:
    import xarray


# of an attribute, in a listing
LONGEST = 120


def run_show(arguments: argparse.Namespace) -> tuple[str, int]:
    """The command `bearingdyn show`: every group of a result file."""
    path = existing(arguments.result, "result")
    held = {name: _describe(results.open_result(path, name)) for name in results.groups(path) or [""]}
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
