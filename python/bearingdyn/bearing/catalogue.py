"""Deep groove and angular contact ball bearings by designation, and estimates from boundary dimensions.

Bore, outside diameter and width are standard (ISO 15). Balls, pitch and groove radii are not: makers differ,
and keep them to themselves. Each entry says where its internal geometry comes from; all are typical, none is
a maker's. Most are estimates by `estimate`.
"""

from __future__ import annotations

import difflib
import math
import re
from typing import Any, Literal, NamedTuple

from bearingdyn.bearing.ball_bearing import BallBearing
from bearingdyn.checks import positive, require
from bearingdyn.magnitude import plausible

Kind = Literal["deep groove", "angular contact"]

ESTIMATE = "estimated from the boundary dimensions, not a maker's geometry"

_BALL_STEP = 25.4e-3 / 64
"""Balls are made in steps of 1/64 inch (among others: ISO 3290-1), m."""
_BALL_SHARE = 0.3
"""Ball diameter over the height of the section, at most: rings and balls take about a third each."""
_FILLING = math.radians(196)
"""Arc over which the balls of a deep groove bearing lie side by side when it is filled: above it the last
one cannot be put in between the rings. 196° gives the number of balls of every entry with a source from its
own diameters."""
_CAGE = 1.1
"""Pitch of the balls of an angular contact bearing over their diameter: what a cage leaves between them."""
_RACES = (0.52, 0.53)
"""Groove radii over ball diameter up to which the ratings of ISO 76 and ISO 281 hold."""


class Entry(NamedTuple):
    """An entry of the catalogue: boundary dimensions (standard), internal geometry (typical), m and rad."""

    bore: float
    outside: float
    width: float
    Z: int
    Dw: float
    Dpw: float
    fi: float
    fo: float
    contact_angle: float | None = None
    source: str = ESTIMATE


def estimate(
    bore: float,
    outside: float,
    width: float,
    *,
    kind: Kind = "deep groove",
    contact_angle: float | None = None,
) -> Entry:
    """Typical internal geometry for boundary dimensions in m: an estimate, no maker's design.

    Pitch diameter midway. Balls: the largest in steps of 1/64 inch up to 0.3 of the section (outside − bore);
    in narrow bearings, up to 0.7 of the width. Deep groove: as many as can be filled in over 196°; angular
    contact: as many as stand 1.1 diameters apart. Groove radii .52 and .53 (ISO 76). The rule is our
    own, drawn from the entries of CATALOGUE that have a source: it gives their number of balls within one and
    their diameters within 7 %.

    Parameters
    ----------
    bore, outside, width
        m.
    kind
        "deep groove" or "angular contact"; the latter needs a contact angle.
    contact_angle
        rad.

    Raises
    ------
    ValueError
        If a dimension is not positive, the section is too thin for balls, or the angle does not go with the
        kind.
    """
    d, D = positive("bore", bore), positive("outside", outside)
    B = positive("width", width)
    plausible("length", "outside", D)
    require(D > d, "outside", outside, f"it must exceed the bore of {bore!r} m")
    require(
        kind in ("deep groove", "angular contact"), "kind", kind, 'give "deep groove" or "angular contact"'
    )
    angular = kind == "angular contact"
    remedy = "give it in rad for an angular contact bearing, and for no other"
    require((contact_angle is not None) == angular, "contact_angle", contact_angle, remedy)
    Dpw = (d + D) / 2
    Dw = math.floor(min(_BALL_SHARE * (D - d), 0.7 * B) / _BALL_STEP) * _BALL_STEP
    require(Dw > 0, "outside", outside, "it must leave room for a ball of 1/64 inch")
    if angular:
        Z = math.floor(math.pi / math.asin(_CAGE * Dw / Dpw))
    else:
        Z = 1 + math.floor(_FILLING / (2 * math.asin(Dw / Dpw)))
    return Entry(d, D, B, Z, Dw, Dpw, *_RACES, contact_angle)


# outside diameter and width in mm by bore in mm (ISO 15, dimension series 10, 02 and 03)
_SERIES_10 = {
    10: (26, 8), 12: (28, 8), 15: (32, 9), 17: (35, 10), 20: (42, 12), 25: (47, 12), 30: (55, 13),
    35: (62, 14), 40: (68, 15), 45: (75, 16), 50: (80, 16),
}  # fmt: skip
_SERIES_02 = {
    10: (30, 9), 12: (32, 10), 15: (35, 11), 17: (40, 12), 20: (47, 14), 25: (52, 15), 30: (62, 16),
    35: (72, 17), 40: (80, 18), 45: (85, 19), 50: (90, 20),
}  # fmt: skip
_SERIES_03 = {
    10: (35, 11), 12: (37, 12), 15: (42, 13), 17: (47, 14), 20: (52, 15), 25: (62, 17), 30: (72, 19),
    35: (80, 21), 40: (90, 23), 45: (100, 25), 50: (110, 27),
}  # fmt: skip
# nominal angles: 15° is usual for spindles, 40° for general use; other angles: dataclasses.replace
_SERIES = {
    "60": (_SERIES_10, None),
    "62": (_SERIES_02, None),
    "63": (_SERIES_03, None),
    "70": (_SERIES_10, math.radians(15)),
    "72": (_SERIES_02, math.radians(40)),
}
_CODE = {10: "00", 12: "01", 15: "02", 17: "03"}

_SOURCED: dict[str, Entry] = {
    "6202": Entry(
        15e-3, 35e-3, 11e-3, 8, 5.953e-3, 25e-3, 0.52, 0.53, None, "typical 6202 of the dynamics literature"
    ),
    "6203": Entry(
        17e-3, 40e-3, 12e-3, 8, 6.746e-3, 28.5e-3, 0.52, 0.53, None,
        "Case Western Reserve University, fan end bearing; groove radii as in ISO 76",
    ),
    "6205": Entry(
        25e-3, 52e-3, 15e-3, 9, 7.94e-3, 39.04e-3, 0.52, 0.53, None,
        "Case Western Reserve University, drive end bearing; groove radii as in ISO 76",
    ),
    "6209": Entry(
        45e-3, 85e-3, 19e-3, 9, 12.7e-3, 65e-3, 0.52, 0.52, None,
        "T. A. Harris, Rolling Bearing Analysis, example of the 209",
    ),
    "6305": Entry(25e-3, 62e-3, 17e-3, 7, 11.5e-3, 43.5e-3, 0.52, 0.53, None, "ISO/TS 16281, worked cases"),
    "6306": Entry(
        30e-3, 72e-3, 19e-3, 8, 11.9e-3, 52e-3, 0.52, 0.53, None,
        "races of 40.1 and 63.9 mm, the JIS 6306 of varying-compliance studies; groove radii as in ISO 76",
    ),
}  # fmt: skip


def _table() -> dict[str, Entry]:
    table = {}
    for series, (sizes, contact_angle) in _SERIES.items():
        kind: Kind = "deep groove" if contact_angle is None else "angular contact"
        for bore, (outside, width) in sizes.items():
            name = series + _CODE.get(bore, f"{bore // 5:02d}")
            estimated = estimate(
                bore * 1e-3, outside * 1e-3, width * 1e-3, kind=kind, contact_angle=contact_angle
            )
            table[name] = _SOURCED.get(name, estimated)
    return table


CATALOGUE: dict[str, Entry] = _table()
"""60xx, 62xx, 63xx (deep groove), 70xx (15°), 72xx (40°) with bores of 10 to 50 mm."""


def entry(designation: str | int) -> Entry:
    """Typical geometry of a designation, and its source.

    Parameters
    ----------
    designation
        A key of CATALOGUE, such as "6305"; the number 6305 will do.

    Raises
    ------
    ValueError
        If the designation is not listed.
    """
    name = str(designation)
    if name not in CATALOGUE:
        # a maker's name before, a cage, seal or clearance after it: "SKF 6203-2RS/C3"
        core = next(iter(re.findall(r"(?<!\d)\d{4}(?!\d)", name)), name)
        near = [core] if core in CATALOGUE else difflib.get_close_matches(core, CATALOGUE, n=1, cutoff=0.7)
        meant = f"did you mean {near[0]!r}? " if near else ""
        require(False, "designation", designation, f"{meant}it must be one of {', '.join(CATALOGUE)}")
    return CATALOGUE[name]


def bearing(designation: str | int, *, clearance: float | None = None, **keywords: Any) -> BallBearing:
    """BallBearing with the typical internal geometry of a designation.

    Parameters
    ----------
    designation
        A key of CATALOGUE, such as "6305" or "7205"; the number 6305 will do.
    clearance
        Diametral clearance, m: of a deep groove bearing, and of no other.
    **keywords
        Passed to BallBearing: material, film, damping, and so on.

    Raises
    ------
    ValueError
        If the designation is not listed, the clearance is missing or out of place, or from BallBearing.

    Examples
    --------
    >>> from bearingdyn.bearing.catalogue import bearing, entry
    >>> bearing("6305", clearance=10e-6).Z, entry("6305").source
    (7, 'ISO/TS 16281, worked cases')
    """
    return from_entry(entry(designation), clearance=clearance, **keywords)


def from_entry(entry: Entry, *, clearance: float | None = None, **keywords: Any) -> BallBearing:
    """BallBearing of an Entry of the catalogue, or of one by `estimate`.

    Parameters
    ----------
    entry
        Dimensions, listed or by `estimate`.
    clearance
        Diametral clearance, m: of a deep groove bearing, and of no other.
    **keywords
        Passed to BallBearing.
    """
    e = entry
    if e.contact_angle is None:
        require(
            clearance is not None,
            "clearance",
            clearance,
            "it must be given, diametral, in m, for a deep groove bearing",
        )
    else:
        require(clearance is None, "clearance", clearance, "it must not be given: the contact angle fixes it")
    return BallBearing(
        e.Z,
        e.Dw,
        e.Dpw,
        e.fi,
        e.fo,
        clearance=clearance,
        contact_angle=e.contact_angle,
        **{"boundary": (e.bore, e.outside, e.width), **keywords},
    )
