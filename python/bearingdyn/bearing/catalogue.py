"""Deep-groove ball bearings by designation.

Bore, outside diameter and width are standard (ISO 15). Balls, pitch and groove radii are not: makers differ,
and keep them to themselves. The values here are typical, from the literature named at each, not one maker's.
"""

from __future__ import annotations

from typing import Any, NamedTuple

from bearingdyn.bearing.ball_bearing import BallBearing
from bearingdyn.bearing.checks import require


class Entry(NamedTuple):
    """Boundary dimensions (standard) and internal geometry (typical), m."""

    bore: float
    outside: float
    width: float
    Z: int
    Dw: float
    Dpw: float
    fi: float
    fo: float


CATALOGUE: dict[str, Entry] = {
    # pitch (bore + outside)/2 and osculations .52/.53 unless a source gives other values
    "6202": Entry(15e-3, 35e-3, 11e-3, 8, 5.953e-3, 25e-3, 0.52, 0.53),
    # bearing of the Case Western Reserve University fan end
    "6203": Entry(17e-3, 40e-3, 12e-3, 8, 6.746e-3, 28.5e-3, 0.52, 0.53),
    # bearing of the Case Western Reserve University drive end
    "6205": Entry(25e-3, 52e-3, 15e-3, 9, 7.94e-3, 39.04e-3, 0.52, 0.53),
    # Harris, Rolling Bearing Analysis, example of the 209
    "6209": Entry(45e-3, 85e-3, 19e-3, 9, 12.7e-3, 65e-3, 0.52, 0.52),
    # ISO/TS 16281 worked cases
    "6305": Entry(25e-3, 62e-3, 17e-3, 7, 11.5e-3, 43.5e-3, 0.52, 0.53),
    # races 40.1 and 63.9 mm, the JIS 6306 of varying-compliance studies
    "6306": Entry(30e-3, 72e-3, 19e-3, 8, 11.9e-3, 52e-3, 0.52, 0.53),
}


def entry(designation: str) -> Entry:
    """Typical geometry of a designation; ValueError if it is not listed."""
    listed = ", ".join(CATALOGUE)
    require(designation in CATALOGUE, "designation", designation, f"must be one of {listed}")
    return CATALOGUE[designation]


def bearing(designation: str, *, clearance: float, **keywords: Any) -> BallBearing:
    """BallBearing with the typical internal geometry of a designation.

    Parameters
    ----------
    designation
        A key of CATALOGUE, such as "6305".
    clearance
        Diametral clearance, m.
    **keywords
        Passed to BallBearing: material, film, damping, and so on.

    Raises
    ------
    ValueError
        If the designation is not listed, or from BallBearing.
    """
    e = entry(designation)
    return BallBearing(e.Z, e.Dw, e.Dpw, e.fi, e.fo, clearance=clearance, **keywords)
