"""`bearingdyn bearing`: the sheet of one bearing by its designation."""

from __future__ import annotations

import argparse
import json
import math
import re
from typing import Any

from bearingdyn.analysis import bearing_sheet, sheet_html, sheet_text, single_bearing
from bearingdyn.bearing import Lubricant, Walther, catalogue, read_designation
from bearingdyn.checks import require
from bearingdyn.cli.outcome import GOOD
from bearingdyn.writing import write_whole

LEAST_CLEARANCE = 0.1e-6  # m: no class of clearance is that small, and no gauge measures it


def run_bearing(arguments: argparse.Namespace) -> tuple[str, int]:
    """The command `bearingdyn bearing`: the sheet of a bearing under a load, as text, JSON or HTML."""
    designation = str(arguments.designation)
    entry, read = catalogue.entry(designation), read_designation(designation)
    name = read.number + read.letter
    clearance = None if arguments.clearance is None else arguments.clearance * 1e-6
    if clearance is not None and 0 < abs(clearance) < LEAST_CLEARANCE:
        given = arguments.clearance
        remedy = f"it is in micrometres; is it in mm? give {1e3 * given:.4g}"
        require(False, "--clearance", given, remedy)
    ball = catalogue.bearing(designation, clearance=clearance)
    state = single_bearing(ball, radial=arguments.radial, axial=arguments.axial, name=name)
    printed = entry.printed
    contamination: float | str = arguments.contamination
    if re.fullmatch(r"[0-9.]+", arguments.contamination):
        contamination = float(arguments.contamination)
    sheet = bearing_sheet(
        state,
        speed=arguments.rpm * math.pi / 30,
        oil=None if arguments.oil is None else oil_of(arguments.oil),
        temperature=arguments.temperature,
        contamination=contamination,
        reliability=arguments.reliability,
        friction_model=arguments.friction,
        C=None if printed is None else {name: printed.C},
        C0=None if printed is None else {name: printed.C0},
    )
    if arguments.html is not None:
        write_whole(arguments.html, sheet_html(sheet, f"Bearing {designation}").encode("utf-8"))
    rating = "by ISO 281 and ISO 76" if printed is None else "as NSK prints them"
    if arguments.json:
        return json.dumps(_plain(sheet, name, designation, rating), indent=1), GOOD
    text = sheet_text(sheet)
    return text if arguments.html is None else f"{text}; page in {arguments.html}", GOOD


def oil_of(text: str) -> Lubricant:
    """A mineral oil for the command `bearingdyn bearing` by its ISO grade: VG32, "ISO VG 46" or 68.

    Raises
    ------
    ValueError
        For a text that names no grade.
    """
    found = re.fullmatch(r"(?:ISO)?[\s-]*(?:VG)?[\s-]*([0-9]{1,9})", text.strip(), re.IGNORECASE)
    if found is None:
        raise ValueError(f"oil is {text!r}; give an ISO viscosity grade, such as VG32")
    return Lubricant(Walther.iso_vg(int(found[1])))


def _plain(sheet: Any, name: str, designation: str, rating: str) -> dict[str, Any]:
    """The sheet as numbers by name in SI, what is not known as null."""
    one = sheet.sel(bearing=name)
    found: dict[str, Any] = {"designation": designation, "ratings": rating}
    for key, variable in one.data_vars.items():
        value = variable.item()
        known = isinstance(value, str) or math.isfinite(value)
        found[str(key)] = {"value": value if known else None, "units": variable.attrs["units"]}
    return found
