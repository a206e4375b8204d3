"""Designations of ball bearings as people write them: what each sign means, and what is passed over.

Internal clearances are those of ISO 5753-1 for radial contact, groups 2, N, 3, 4 and 5, by bore; contact
angles go by the letters that makers put behind the number of an angular contact bearing.
"""

from __future__ import annotations

import math
import re
from dataclasses import dataclass

from bearingdyn.checks import positive, require

CLEARANCE_CLASSES = ("C2", "CN", "C3", "C4", "C5")

# bore up to and with, mm: (least, most) µm of the classes above (ISO 5753-1, deep groove bearings). Compared
# up to 100 mm with a maker's table, http://en.shjfbearing.com/news/eventsPage/2525: 87 of 90 figures agree,
# and the other three (18 to 24 mm: C3 up to 25 and C5 from 25; 50 to 65 mm: C5 up to 60) look like misprints
_CLEARANCES: dict[float, tuple[tuple[int, int], ...]] = {
    10: ((0, 7), (2, 13), (8, 23), (14, 29), (20, 37)),
    18: ((0, 9), (3, 18), (11, 25), (18, 33), (25, 45)),
    24: ((0, 10), (5, 20), (13, 28), (20, 36), (28, 48)),
    30: ((1, 11), (5, 20), (13, 28), (23, 41), (30, 53)),
    40: ((1, 11), (6, 20), (15, 33), (28, 46), (40, 64)),
    50: ((1, 11), (6, 23), (18, 36), (30, 51), (45, 73)),
    65: ((1, 15), (8, 28), (23, 43), (38, 61), (55, 90)),
    80: ((1, 15), (10, 30), (25, 51), (46, 71), (65, 105)),
    100: ((1, 18), (12, 36), (30, 58), (53, 84), (75, 120)),
    120: ((2, 20), (15, 41), (36, 66), (61, 97), (90, 140)),
}

# the first that fits; letters behind these are of the design and mean nothing here
_ANGLES = {"A5": 25, "ACD": 25, "AC": 25, "A": 30, "BE": 40, "B": 40, "CD": 15, "CE": 15, "C": 15, "E": 25}
_ANGULAR = ("70", "72", "73")

_NUMBER = re.compile(r"(?<![0-9])(618|619|160|60|62|63|64|68|69|70|72|73)([0-9]{2})(?=2RS|2Z|[^0-9]|$)")
# SKF's and FAG's signs of hybrid bearings; HC5 is no clearance C5
_CERAMIC = re.compile(r"(?:^|[\s/\-])(HC[0-9]?|SN24|CERAMIC|HYBRID)(?=$|P[0-9]|C[0-9N]|[\s/\-])")
_THIN = {"68": "618", "69": "619"}  # JIS writes 6805 for 61805


@dataclass(frozen=True)
class Designation:
    """What the designation of a bearing says: series, bore, clearance, angle.

    Parameters
    ----------
    number
        Series and bore: "6205", "61808", "7014".
    letter
        Of the contact angle, "" where there is none.
    contact_angle
        rad, by the letter; None where there is none.
    clearance_class
        One of CLEARANCE_CLASSES, or "" where none is written, which means CN.
    ignored
        What is passed over: the maker's name, seals, cages, tolerance classes.
    """

    number: str
    letter: str = ""
    contact_angle: float | None = None
    clearance_class: str = ""
    ignored: tuple[str, ...] = ()


def read_designation(designation: str | int) -> Designation:
    """Read the designation of a bearing as people write it, such as "6203-2RS/C3".

    Parameters
    ----------
    designation
        "6203-2RS/C3", "SKF 6203", "7014 ACD", "6205 C4", "6805" (JIS for 61805), or the number 6205.

    Raises
    ------
    ValueError
        If no number of a series that is known stands in it, or a sign of ceramic balls.

    Examples
    --------
    >>> from bearingdyn.bearing.designation import read_designation
    >>> read_designation("SKF 6203-2RS/C3")
    Designation(number='6203', letter='', contact_angle=None, clearance_class='C3', ignored=('SKF', '2RS'))
    """
    text = str(designation).strip().upper()
    found = _NUMBER.search(text)
    if found is None:
        remedy = (
            "it must hold a number of the series 60, 62, 63, 64, 618, 619, 160, 70, 72 or 73, such as '6205'"
        )
        raise ValueError(f"designation is {designation!r}; {remedy}")
    ceramic = _CERAMIC.search(text[: found.start()]) or _CERAMIC.search(text[found.end() :])
    if ceramic is not None:
        raise ValueError(
            f"designation is {designation!r}; {ceramic[1]} means ceramic balls, which the catalogue does not "
            f"take from a name: write {found[0]!r} and give ball_material=bd.Elastic(E=3.1e11, nu=0.26, "
            f"density=3200.0), silicon nitride"
        )
    series = _THIN.get(found[1], found[1])
    rest = text[found.end() :]
    letter, angle = "", None
    if series in _ANGULAR:
        bare = rest.lstrip(" -/")
        # a C before a digit is a clearance class
        letter = next((s for s in _ANGLES if bare.startswith(s) and not re.match(r"C[0-9]", bare)), "")
        if letter:
            angle = math.radians(_ANGLES[letter])
            rest = bare[len(letter) :]
    tolerance = re.search(r"P[4-6]([2-5])(?![0-9])", rest)  # P63: of class P6, with the clearance C3
    group = tolerance or re.search(r"C([2-5N])(?![0-9A-MO-Z]*[0-9])", rest) or re.search(r"C([2-5N])", rest)
    clearance = f"C{group[1]}" if group else ""
    if group:
        rest = rest[: group.start()] + (f" {tolerance[0][:2]} " if tolerance else " ") + rest[group.end() :]
    pieces = re.split(r"[\s/,.\-]+", text[: found.start()] + " " + rest)
    return Designation(series + found[2], letter, angle, clearance, tuple(p for p in pieces if p))


def clearance_range(bore: float, group: str = "CN") -> tuple[float, float]:
    """Clearance that a designation's class means: least and most radial internal clearance, m (ISO 5753-1).

    Before mounting and warming up; `Mounting` says what is left of it.

    Parameters
    ----------
    bore
        m, up to 0.12.
    group
        One of CLEARANCE_CLASSES.

    Raises
    ------
    ValueError
        For another group or a bore above 120 mm.
    """
    require(group in CLEARANCE_CLASSES, "group", group, f"it must be one of {', '.join(CLEARANCE_CLASSES)}")
    bore = positive("bore", bore, "it must be above 0 and at most 0.12 m, where the table ends")
    row = next((row for most, row in _CLEARANCES.items() if 0 < bore * 1e3 <= most + 1e-9), None)
    if row is None:
        raise ValueError(f"bore is {bore!r}; it must be above 0 and at most 0.12 m, where the table ends")
    least, most = row[CLEARANCE_CLASSES.index(group)]
    return least * 1e-6, most * 1e-6
