"""Life in a given oil: viscosity ratio, contamination and reliability (ISO 281:2007), in hours.

The factor a_ISO is that of radial ball bearings; it ends at 50. Fatigue limits are by the simple rule.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass
from typing import NamedTuple

from bearingdyn.bearing.rating.iso_ratings import warn_of_overload
from bearingdyn.checks import items, meant, nonnegative, number, positive, reals, require
from bearingdyn.plausible_ranges import check_speed_value, plausible

LEAST_KAPPA = 0.1
"""Viscosity ratio below which ISO 281 knows no a_ISO."""
_MOST_KAPPA, _MOST_FACTOR = 4.0, 50.0

# middle of the ranges that ISO 281 (annex A) and makers give, up to and above Dpw = 100 mm
CONTAMINATION = {
    "extreme cleanliness": (1.0, 1.0),
    "high cleanliness": (0.7, 0.85),
    "normal cleanliness": (0.55, 0.7),
    "slight contamination": (0.4, 0.5),
    "typical contamination": (0.2, 0.3),
    "severe contamination": (0.05, 0.05),
    "very severe contamination": (0.0, 0.0),
}
"""e_C by words: for Dpw below 100 mm, and from there on."""

# %: a1 of ISO 281:2007
_RELIABILITY = {90: 1.0, 95: 0.64, 96: 0.55, 97: 0.47, 98: 0.37, 99: 0.25}


def reference_viscosity(speed: float, Dpw: float) -> float:
    """Reference viscosity ν1 for the modified life, m²/s: separates the surfaces at a speed (ISO 281).

    Parameters
    ----------
    speed
        rad/s, not zero.
    Dpw
        Pitch diameter, m.
    """
    n = abs(plausible("speed", "speed", speed)) * 30 / math.pi
    require(n > 0, "speed", speed, "it must not be zero: at rest there is no film")
    D = plausible("pitch diameter", "Dpw", positive("Dpw", Dpw)) * 1e3
    check_speed_value("speed", speed, Dpw)
    # as ISO 281 has it, and as others quote it of SKF's catalogue
    return float((45000 * n**-0.83 if n < 1000 else 4500 * n**-0.5) * D**-0.5 * 1e-6)


def fatigue_limit(C0: float, Dpw: float) -> float:
    """Fatigue load limit C_u for the modified life, N: C0/22, less above Dpw = 100 mm (ISO 281, simple).

    Parameters
    ----------
    C0
        Static rating, N.
    Dpw
        Pitch diameter, m.
    """
    static = plausible("rating", "C0", positive("C0", C0))
    pitch = plausible("pitch diameter", "Dpw", positive("Dpw", Dpw))
    text = f"C0 is {static:.6g} N with a pitch diameter of {1e3 * pitch:.4g} mm; C0/Dpw²"
    plausible("rating by size", text, static / pitch**2)
    return static / 22 * min(1.0, math.sqrt(0.1 / pitch))


def contamination_factor(contamination: float | str, Dpw: float) -> float:
    """Contamination factor e_C for the modified life, of a word of CONTAMINATION, or the number itself.

    Parameters
    ----------
    contamination
        Number or word.
    Dpw
        Pitch diameter, m.
    """
    if isinstance(contamination, str):
        known = contamination in CONTAMINATION
        require(known, "contamination", contamination, meant(contamination, CONTAMINATION))
        return CONTAMINATION[contamination][0 if nonnegative("Dpw", Dpw) < 0.1 else 1]
    remedy = "e_C must lie in 0..1 (ISO 281: 0 is very severe contamination, 1 extreme cleanliness)"
    nonnegative("Dpw", Dpw)
    e = number("contamination", contamination, remedy)
    require(0 <= e <= 1, "contamination", contamination, remedy)
    return e


def life_factor(kappa: float, contamination: float, Cu: float, P: float) -> float:
    """Factor a_ISO of the modified life of a radial ball bearing, at most 50 (ISO 281:2007, eqs 31 to 33).

    Parameters
    ----------
    kappa
        Viscosity ratio ν/ν1, at least .1; above 4 it counts as 4.
    contamination
        e_C, 0 to 1.
    Cu
        Fatigue load limit, N.
    P
        Equivalent load, N.

    Raises
    ------
    ValueError
        For κ below .1, which the standard does not cover, or contamination outside 0 to 1.

    Examples
    --------
    >>> from bearingdyn.bearing.rating import life_factor
    >>> round(life_factor(1.0, 0.5, 1000.0, 5000.0), 3)
    2.431
    """
    k = number("kappa", kappa)
    remedy = (
        "ISO 281 has no a_ISO below 0.1: the film is too thin; give a thicker or cooler oil, or more speed"
    )
    require(k >= LEAST_KAPPA, "kappa", kappa, remedy)
    e = contamination_factor(contamination, 0.0)
    limit = e * positive("Cu", Cu) / positive("P", P)
    k = min(k, _MOST_KAPPA)
    film = 2.2649 * k**-0.054381 if k < 0.4 else 1.9987 * k**-0.19087 if k < 1 else 1.9987 * k**-0.071739
    left = 1 - (2.5671 - film) ** 0.83 * limit ** (1 / 3)
    if left <= 0:
        return _MOST_FACTOR
    return float(min(0.1 * left**-9.3, _MOST_FACTOR))


def reliability_factor(reliability: float) -> float:
    """Factor a1 of the modified life for a reliability of 90 to 99 % (ISO 281:2007), between by logarithms.

    Parameters
    ----------
    reliability
        %, 90 to 99.
    """
    r = number("reliability", reliability)
    require(90 <= r <= 99, "reliability", reliability, "it must lie in 90...99 %")
    points = sorted(_RELIABILITY)
    low = max(p for p in points if p <= r)
    high = min(p for p in points if p >= r)
    if low == high:
        return _RELIABILITY[low]
    share = (r - low) / (high - low)
    return math.exp((1 - share) * math.log(_RELIABILITY[low]) + share * math.log(_RELIABILITY[high]))


@dataclass(frozen=True)
class ModifiedLife:
    """Modified life: what ISO 281 makes of a rating life in a given oil."""

    kappa: float
    """Viscosity ratio ν/ν1."""
    reference_viscosity: float
    """ν1, m²/s."""
    contamination: float
    """e_C."""
    Cu: float
    """Fatigue load limit, N."""
    factor: float
    """a1 a_ISO."""
    revolutions: float
    """L_nm, million revolutions."""
    hours: float
    """The same in hours."""


def modified_life(
    L10: float,
    P: float,
    *,
    C0: float,
    Dpw: float,
    speed: float,
    viscosity: float,
    contamination: float | str = "normal cleanliness",
    reliability: float = 90.0,
) -> ModifiedLife:
    """Modified life in a given oil from the basic one: a1 a_ISO L10.

    Parameters
    ----------
    L10
        Basic rating life, or basic reference rating life, million revolutions; inf stays inf.
    P
        The load that belongs to it, N: C/L10^{1/3}.
    C0
        Static rating, N.
    Dpw
        Pitch diameter, m.
    speed
        Of one ring against the other, rad/s.
    viscosity
        Kinematic, of the oil at the temperature that it has in the bearing, m²/s.
    contamination
        e_C, 0 to 1, or a word of CONTAMINATION.
    reliability
        %, 90 to 99.

    Raises
    ------
    ValueError
        Naming what is out of range: κ below .1, e_C outside 0 to 1, a speed of zero.

    Warns
    -----
    UnusualMagnitude
        For a rating, a diameter, a viscosity or a speed that hardly a bearing has.
    BearingWarning
        For a load above the static rating.
    """
    L10 = _life("L10", L10)
    speed, Dpw = number("speed", speed), positive("Dpw", Dpw)
    nu = plausible("kinematic viscosity", "viscosity", positive("viscosity", viscosity))
    nu1 = reference_viscosity(speed, Dpw)
    kappa, e, Cu = nu / nu1, contamination_factor(contamination, Dpw), fatigue_limit(C0, Dpw)
    load = plausible("force", "P", nonnegative("P", P))
    warn_of_overload(load, C0)
    factor = life_factor(kappa, e, Cu, load) if load > 0 else _MOST_FACTOR
    factor *= reliability_factor(reliability)
    revolutions = factor * L10
    return ModifiedLife(kappa, nu1, e, Cu, factor, revolutions, in_hours(revolutions, speed))


def _life(field: str, value: float) -> float:
    """Million revolutions, zero or more; inf where nothing wears. ValueError for anything else."""
    endless = isinstance(value, float) and value == math.inf
    return math.inf if endless else nonnegative(field, value, "it must be a life in million revolutions")


def in_hours(revolutions: float, speed: float) -> float:
    """Modified life in hours, from million revolutions and a speed in rad/s; inf at rest.

    Parameters
    ----------
    revolutions
        Million revolutions.
    speed
        rad/s.
    """
    revolutions = _life("revolutions", revolutions)
    turns = abs(plausible("speed", "speed", speed)) / (2 * math.pi)  # per second
    return revolutions * 1e6 / turns / 3600 if turns > 0 else math.inf


class Phase(NamedTuple):
    """A phase of a duty cycle, for the modified life of the whole."""

    share: float
    """Of the time, 0 to 1."""
    speed: float
    """rad/s."""
    life: float
    """Million revolutions, as if it went on for ever."""


def equivalent_life(phases: Iterable[Phase]) -> tuple[float, float]:
    """Modified life of a duty cycle by the rule of Palmgren and Miner, in million revolutions and hours.

    Parameters
    ----------
    phases
        Shares of the time, which are scaled to 1, speeds and lives.

    Returns
    -------
    tuple
        Million revolutions and hours; a phase at rest wears nothing.

    Raises
    ------
    ValueError
        Without a phase, or for a share or life that is not positive.
    """
    cycle = items("phases", phases, "it must be phases of a duty cycle")
    for k, phase in enumerate(cycle):
        remedy = "it must be a share of the time, a speed in rad/s and a life in million revolutions"
        require(reals(f"phases[{k}]", phase, remedy).shape == (3,), f"phases[{k}]", phase, remedy)
    require(len(cycle) > 0, "phases", cycle, "give at least one phase")
    total, turned, worn = 0.0, 0.0, 0.0
    for k, (share, speed, life) in enumerate(cycle):
        hours = positive(f"phases[{k}].share", share)
        turns = abs(number(f"phases[{k}].speed", speed)) / (2 * math.pi) * 3600 * 1e-6  # million an hour
        require(life > 0, f"phases[{k}].life", life, "it must be positive, in million revolutions")
        total += hours
        turned += hours * turns
        worn += hours * turns / life
    if worn == 0:
        return math.inf, math.inf
    return turned / worn, total / worn
