"""Ratings and equivalent loads of ball bearings: ISO 76 (static) and ISO 281 (dynamic).

Both hold for grooves up to .52 (inner) and .53 (outer) of the ball diameter; tighter grooves are not rated
higher. The factor fc is written out by its formula (ISO/TR 1281-1), whose values the table of ISO 281 rounds
to .1; f0 is Hertz's load at 4.2 GPa with E = 207 GPa, which is what the table of ISO 76 holds.
"""

from __future__ import annotations

import math
from functools import lru_cache
from typing import NamedTuple

import numpy as np

from bearingdyn.bearing.geometry import Geometry
from bearingdyn.bearing.hertz import race_contact
from bearingdyn.checks import nonnegative, positive, require, whole
from bearingdyn.material import Elastic
from bearingdyn.notice import BearingWarning, UnusualMagnitude, warn
from bearingdyn.plausible_ranges import plausible

STATIC_STEEL = Elastic(207e9, 0.3, 7850.0)
"""Steel of the ratings of ISO 76."""

GROOVES = (0.52, 0.53)
"""Inner and outer groove radius over ball diameter that the ratings stand for."""

_PRESSURE = 4.2e9
_INCH = 25.4e-3  # balls above it: Dw^1.4 in place of Dw^1.8
# a factor between a rating given and that of the balls that is doubted; makers differ by 1.3
_FAR = 3.0
_BM = 1.3  # ISO 281: today's steels
# 98.0665 N mm times .41 (ISO/TR 1281-1), reduced by λ = .95
_FC = 0.41 * 98.0665 * 0.95


class Thrust(NamedTuple):
    """Factors X and Y by the standard of an equivalent load, and the ratio Fa/Fr from which they hold."""

    X: float
    Y: float
    e: float


# f0 Fa/C0: e and Y; deep groove (X = .56) and 15° (X = .44)
_RELATIVE = (0.172, 0.345, 0.689, 1.03, 1.38, 2.07, 3.45, 5.17, 6.89)
_DEEP_E = (0.19, 0.22, 0.26, 0.28, 0.30, 0.34, 0.38, 0.42, 0.44)
_DEEP_Y = (2.30, 1.99, 1.71, 1.55, 1.45, 1.31, 1.15, 1.04, 1.00)
_RELATIVE_15 = (0.178, 0.357, 0.714, 1.07, 1.43, 2.14, 3.57, 5.35)
_E_15 = (0.38, 0.40, 0.43, 0.46, 0.47, 0.50, 0.55, 0.56)
_Y_15 = (1.47, 1.40, 1.30, 1.23, 1.19, 1.12, 1.02, 1.00)
# degrees: X, Y, e and the static Y0 (X0 = .5)
_STEEP_DEGREES = (20.0, 25.0, 30.0, 35.0, 40.0, 45.0)
_STEEP_X = (0.43, 0.41, 0.39, 0.37, 0.35, 0.33)
_STEEP_Y = (1.00, 0.87, 0.76, 0.66, 0.57, 0.50)
_STEEP_E = (0.57, 0.68, 0.80, 0.95, 1.14, 1.34)
_Y0_DEGREES = (15.0, 20.0, 25.0, 30.0, 35.0, 40.0, 45.0)
_Y0 = (0.46, 0.42, 0.38, 0.33, 0.29, 0.26, 0.22)


@lru_cache(maxsize=1024)
def static_factor(gamma: float, inner_only: bool = False) -> float:
    """Factor f0 by the standard ISO 76, N/mm², of Dw cosα/Dpw = γ: the ball load over 5 Dw² at 4.2 GPa.

    Parameters
    ----------
    gamma
        Dw cosα/Dpw, between 0 and 1.
    inner_only
        Leave the outer race aside, which decides where γ is below some .09. Makers' f0 of thin bearings is of
        the inner race alone.
    """
    require(0 < gamma < 1, "gamma", gamma, "it must lie between 0 and 1")
    diameter = 10e-3
    unit = Geometry(3, diameter, diameter / gamma, *GROOVES, clearance=0.0)
    races = ("inner",) if inner_only else ("inner", "outer")
    loads = [
        race_contact(unit, race, STATIC_STEEL, STATIC_STEEL).load_at_pressure(_PRESSURE)  # type: ignore[arg-type]
        for race in races
    ]
    return min(loads) / 5 / (diameter * 1e3) ** 2


def dynamic_factor(gamma: float) -> float:
    """Factor fc by the standard ISO 281 of single-row ball bearings, of Dw cosα/Dpw = γ.

    Parameters
    ----------
    gamma
        Dw cosα/Dpw, between 0 and 1.
    """
    require(0 < gamma < 1, "gamma", gamma, "it must lie between 0 and 1")
    ratio = 1.04 * ((1 - gamma) / (1 + gamma)) ** 1.72
    races = (1 + ratio ** (10 / 3)) ** -0.3
    span = gamma**0.3 * (1 - gamma) ** 1.39 / (1 + gamma) ** (1 / 3)
    f = GROOVES[0]
    return float(_FC * races * span * (2 * f / (2 * f - 1)) ** 0.41)


class Ratings(NamedTuple):
    """Basic ratings C and C0 of a bearing by the standards, N."""

    C: float
    """Basic dynamic radial rating (ISO 281): 1 million revolutions at 90 %."""
    C0: float
    """Basic static radial rating (ISO 76): 4.2 GPa in the heaviest contact."""
    f0: float
    """N/mm², of C0 and of the factors X and Y."""


def iso_ratings(Z: int, Dw: float, Dpw: float, contact_angle: float = 0.0) -> Ratings:
    """Ratings by the standards of a single row of balls: C by ISO 281 and C0 by ISO 76.

    Parameters
    ----------
    Z
        Number of balls.
    Dw, Dpw
        Ball and pitch diameter, m.
    contact_angle
        Nominal, rad; 0 for deep groove bearings.

    Raises
    ------
    ValueError
        If a value is not positive, or of a magnitude that no bearing has.

    Examples
    --------
    >>> from bearingdyn.bearing.rating import iso_ratings
    >>> C, C0, f0 = iso_ratings(Z=9, Dw=7.94e-3, Dpw=39.04e-3)  # 6205; makers print 14 kN, 7.85 kN, 13.9
    >>> round(C), round(C0), round(f0, 1)
    (14032, 7872, 13.9)
    """
    whole("Z", Z, 1)
    d = plausible("ball diameter", "Dw", positive("Dw", Dw))
    D = plausible("pitch diameter", "Dpw", positive("Dpw", Dpw))
    cosine = math.cos(plausible("contact angle", "contact_angle", contact_angle))
    gamma = d * cosine / D
    millimetres = d * 1e3
    size = millimetres**1.8 if d <= _INCH else 3.647 * millimetres**1.4
    C = _BM * dynamic_factor(gamma) * cosine**0.7 * Z ** (2 / 3) * size
    f0 = static_factor(round(gamma, 9))
    return Ratings(float(C), f0 * Z * millimetres**2 * cosine, f0)


def dynamic_factors(ratio: float, contact_angle: float = 0.0) -> Thrust:
    """Factors X, Y and e by the standard ISO 281, P = X Fr + Y Fa; linear between the tables' values.

    Parameters
    ----------
    ratio
        f0 Fa/C0. Outside the table its ends hold.
    contact_angle
        Nominal, rad.
    """
    degrees = math.degrees(plausible("contact angle", "contact_angle", contact_angle))
    if degrees < 5:
        return Thrust(0.56, _between(ratio, _RELATIVE, _DEEP_Y), _between(ratio, _RELATIVE, _DEEP_E))
    if degrees < 18:
        return Thrust(0.44, _between(ratio, _RELATIVE_15, _Y_15), _between(ratio, _RELATIVE_15, _E_15))
    x, y, e = (_between(degrees, _STEEP_DEGREES, t) for t in (_STEEP_X, _STEEP_Y, _STEEP_E))
    return Thrust(x, y, e)


def equivalent_load(
    radial: float, axial: float, C0: float, *, contact_angle: float = 0.0, f0: float
) -> float:
    """Dynamic equivalent radial load P of a single bearing by the standard ISO 281, N.

    Parameters
    ----------
    radial, axial
        Fr and Fa, N, zero or more.
    C0
        Static rating, N.
    contact_angle
        Nominal, rad.
    f0
        Of the bearing, as `iso_ratings` gives it.

    Warns
    -----
    BearingWarning
        Where the static equivalent load exceeds C0: above it, and above Fa = .5 C0, the factors do not hold.
    """
    Fr, Fa = radial_and_axial(radial, axial)
    static = plausible("rating", "C0", positive("C0", C0))
    X, Y, e = dynamic_factors(positive("f0", f0) * Fa / static, contact_angle)
    warn_of_overload(equivalent_static_load(Fr, Fa, contact_angle), static)
    return Fr if Fa <= e * Fr else max(X * Fr + Y * Fa, Fr)


def equivalent_static_load(radial: float, axial: float, contact_angle: float = 0.0) -> float:
    """Static equivalent radial load P0 by the standard ISO 76, N: .6 Fr + .5 Fa, at least Fr.

    Parameters
    ----------
    radial, axial
        Fr and Fa, N, zero or more.
    contact_angle
        Nominal, rad; from 15° on X0 = .5 and Y0 by the table.
    """
    Fr, Fa = radial_and_axial(radial, axial)
    degrees = math.degrees(plausible("contact angle", "contact_angle", contact_angle))
    X0, Y0 = (0.6, 0.5) if degrees < 5 else (0.5, _between(degrees, _Y0_DEGREES, _Y0))
    return max(X0 * Fr + Y0 * Fa, Fr)


def check_given(what: str, given: float, found: float, who: str = "") -> float:
    """Check a rating that was given, N, against what the standard gives to the bearing's balls.

    Parameters
    ----------
    what
        "C" or "C0".
    given, found
        N: the one given, and that of `iso_ratings`.
    who
        Of which bearing, for the message.

    Warns
    -----
    UnusualMagnitude
        For a factor of more than 3 between the two; makers differ by 1.3.
    """
    value = positive(f"{what}{who}", given, "the rating in N must be positive and finite")
    if not 1 / _FAR < value / found < _FAR:
        kilo = 1 / _FAR < 1e3 * value / found < _FAR
        guess = f"; is it in kN? give {1e3 * value:.4g} N" if kilo else ""
        warn(
            f"{what}{who} is {value:.4g} N, and the bearing's balls give {found:.4g} N by ISO{guess}",
            UnusualMagnitude,
        )
    return value


def radial_and_axial(radial: float, axial: float) -> tuple[float, float]:
    """ISO ratings: check of the two loads of an equivalent load, N: of a force's magnitude, none negative.

    Parameters
    ----------
    radial, axial
        Fr and Fa, N.
    """
    Fr, Fa = nonnegative("radial", radial), nonnegative("axial", axial)
    return plausible("force", "radial", Fr), plausible("force", "axial", Fa)


def warn_of_overload(P0: float, C0: float) -> None:
    """ISO ratings: warn (BearingWarning) of an equivalent static load above the static rating, both N.

    Parameters
    ----------
    P0, C0
        N.
    """
    if P0 > C0:
        kilo = f"; is C0 in kN? give {1e3 * C0:.4g} N" if 30 * C0 < P0 <= 1e3 * C0 else ""
        warn(
            f"the static equivalent load is {P0:.4g} N, above the static rating C0 of {C0:.4g} N: the balls "
            f"dent the races, and what is computed of their life and friction does not hold{kilo}",
            BearingWarning,
        )


def _between(x: float, at: tuple[float, ...], value: tuple[float, ...]) -> float:
    return float(np.interp(x, at, value))
