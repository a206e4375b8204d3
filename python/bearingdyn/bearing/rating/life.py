"""Basic reference rating life from the load of every ball (ISO/TS 16281): ball bearings with radial ratings.

A race is worn by the loads that pass over it: where it turns against the load every spot meets every load,
where it stands the most heavily loaded spot decides. The two races fail independently.
"""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Literal, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from bearingdyn.bearing.ball_bearing import BallBearing
from bearingdyn.bearing.contact_pressure import check_light
from bearingdyn.bearing.rating.iso_ratings import Ratings, check_given, iso_ratings
from bearingdyn.checks import instance, one_of, positive, require, vector
from bearingdyn.types import Array

Arm = Literal["mean", "groove"]


class Races(NamedTuple):
    """A number for each race, as the rating life needs it."""

    inner: float
    outer: float


def ratings_of(bearing: BallBearing) -> Ratings:
    """For the life of a bearing, its ratings C by ISO 281 and C0 by ISO 76, N.

    Parameters
    ----------
    bearing
        Deep groove (nominal angle 0) or angular contact.
    """
    instance("bearing", bearing, BallBearing, "give a BallBearing")
    return iso_ratings(bearing.Z, bearing.Dw, bearing.Dpw, bearing.contact_angle or 0.0)


def race_capacities(bearing: BallBearing, C: float) -> Races:
    """Ball load, N, with which each race has a life of a million revolutions: Qci, Qce of ISO/TS 16281.

    Parameters
    ----------
    bearing
        Its balls, grooves and nominal contact angle count.
    C
        Basic dynamic radial rating, N.
    """
    instance("bearing", bearing, BallBearing, "give a BallBearing")
    rating = positive("C", C, "the dynamic rating in N must be positive and finite")
    gamma, Dw = bearing.geometry.gamma, bearing.Dw
    ri, ro = bearing.fi * Dw, bearing.fo * Dw
    spread = (ri / ro * (2 * ro - Dw) / (2 * ri - Dw)) ** 0.41
    X = 1.044 * ((1 - gamma) / (1 + gamma)) ** 1.72 * spread
    share = bearing.Z * math.cos(bearing.contact_angle or 0.0) ** 0.7
    return Races(
        inner=rating * (1 + X ** (10 / 3)) ** 0.3 / (0.407 * share),
        outer=rating * (1 + X ** (-10 / 3)) ** 0.3 / (0.389 * share),
    )


def equivalent_ball_loads(bearing: BallBearing, inner: ArrayLike, outer: ArrayLike) -> Races:
    """Dynamic equivalent ball load of each race for its rating life, N, from the loads of the balls.

    (Σ Q³/Z)^{1/3} of a race that turns against the load, (Σ Q^{10/3}/Z)^{3/10} of one that stands; the load
    is taken to stand in space, and which ring turns is said by the bearing's `turning`.

    Parameters
    ----------
    bearing
        Whose `turning` says which ring turns.
    inner, outer
        (Z,) loads of the contacts, N.
    """
    power = [3.0 if ratio != 0 else 10 / 3 for ratio in bearing.ring_speeds]
    means = []
    for field, loads, p in (("inner", inner, power[0]), ("outer", outer, power[1])):
        Q = vector(field, loads, (bearing.Z,), "loads of the balls, N")
        require(bool((Q >= 0).all()), field, loads, "no ball pulls: loads must be zero or positive")
        means.append(float((Q**p).mean() ** (1 / p)))
    return Races(*means)


def life_of_loads(
    bearing: BallBearing, inner: ArrayLike, outer: ArrayLike | None = None, *, C: float | None = None
) -> float:
    """Basic reference rating life L10r, million revolutions, from the loads of the balls.

    Parameters
    ----------
    bearing
        Its geometry, and which ring turns.
    inner, outer
        (Z,) loads of the contacts, N, as of an equilibrium, of a flexible ring, or of balls with inertia;
        outer None: the same.
    C
        Basic dynamic radial rating, N; None: by ISO 281.

    Returns
    -------
    float
        inf where no ball is loaded.

    Warns
    -----
    UnusualMagnitude
        For a C far from what the balls have by ISO 281.

    References
    ----------
    ISO/TS 16281:2008, 4.2.

    Examples
    --------
    >>> from bearingdyn.bearing import BallBearing
    >>> from bearingdyn.bearing.rating import life_of_loads
    >>> ball = BallBearing(7, 11.5e-3, 43.5e-3, 0.52, 0.53, clearance=0.0)
    >>> round(life_of_loads(ball, [0, 100.0, 500.0, 800.0, 500.0, 100.0, 0], C=23400.0))
    5087
    """
    found = ratings_of(bearing).C
    rating = found if C is None else check_given("C", C, found)
    Qc = race_capacities(bearing, rating)
    Qe = equivalent_ball_loads(bearing, inner, inner if outer is None else outer)
    try:
        wear = sum((e / c) ** (10 / 3) for e, c in zip(Qe, Qc, strict=True))
    except ArithmeticError:
        raise ValueError(f"C is {C!r} N; beside the loads it is too small for a life") from None
    return float(wear**-0.9) if wear > 0 else math.inf


def rating_life(
    bearing: BallBearing,
    load: ArrayLike,
    *,
    C: float | None = None,
    arm: Arm = "mean",
    angle: float = 0.0,
) -> float:
    """Basic reference rating life L10r, million revolutions, under a load on the inner ring (ISO/TS 16281).

    Parameters
    ----------
    bearing
        Ball bearing; which ring turns is said by its `turning`.
    load
        (6,) forces N and moments N m on the inner ring, standing in space.
    C
        Basic dynamic radial rating, N; None: by ISO 281.
    arm
        Of moments and tilts: "mean", Dpw/2, the standard's; or "groove", that of the bearing itself.
    angle
        Cage angle, rad: where the balls stand.

    Returns
    -------
    float
        inf where no ball is loaded.

    Raises
    ------
    ValueError
        As `BallBearing.displacement`; for a C that is not positive, or another word for the arm.
    ArithmeticError
        If no equilibrium is found.

    Examples
    --------
    >>> import bearingdyn as bd
    >>> ball = bd.BallBearing(7, 11.5e-3, 43.5e-3, 0.52, 0.53, clearance=0.0)  # ISO/TS 16281's bearing
    >>> round(bd.bearing.rating_life(ball, (1000.0, 0, 0, 0, 0, 0), C=23400.0))  # a commercial code: 13163
    13163
    """
    loads = loads_under(bearing, load, arm=arm, angle=angle)
    check_light(bearing, loads)
    return life_of_loads(bearing, loads, C=C)


def with_arm(bearing: BallBearing, arm: Arm) -> BallBearing:
    """The bearing for its rating life: with the arm of tilts and moments that the standard has, or its own.

    Parameters
    ----------
    bearing, arm
        As in `rating_life`.
    """
    one_of("arm", arm, ("mean", "groove"))
    if arm == "groove":
        return bearing
    return replace(bearing, overrides=bearing.overrides._replace(arm=bearing.Dpw / 2))


def loads_under(bearing: BallBearing, load: ArrayLike, *, arm: Arm = "mean", angle: float = 0.0) -> Array:
    """For the life under one load (6,), N and N m: loads of the balls (Z,), N, in its equilibrium.

    Parameters
    ----------
    bearing, load, arm, angle
        As in `rating_life`.
    """
    instance("bearing", bearing, BallBearing, "give a BallBearing")
    held = with_arm(bearing, arm)
    return np.asarray(held.ball_loads(held.displacement(load, angle), angle))
