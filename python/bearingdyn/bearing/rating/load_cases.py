"""Many load cases of one bearing at once: where the ring rests, what the balls bear, how long it lives."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from bearingdyn.bearing.ball_bearing import BallBearing
from bearingdyn.bearing.contact_pressure import STATIC_PRESSURE, check_light
from bearingdyn.bearing.open_side import OPEN_SIDE_REMEDY
from bearingdyn.bearing.rating.iso_ratings import check_given
from bearingdyn.bearing.rating.life import Arm, race_capacities, ratings_of, with_arm
from bearingdyn.checks import instance, real
from bearingdyn.notice import BearingWarning, warn
from bearingdyn.plausible_ranges import plausible
from bearingdyn.types import Array


@dataclass(frozen=True, eq=False)
class LoadCases:
    """Load cases: equilibria of one bearing under many loads.

    Parameters
    ----------
    q
        (m, 6) place of the inner ring, m and rad.
    ball_loads
        (m, Z), N.
    pressure
        (m,) largest contact pressure, Pa.
    life
        (m,) basic reference rating life L10r, million revolutions; inf without load.
    """

    q: Array
    ball_loads: Array
    pressure: Array
    life: Array

    def __repr__(self) -> str:
        """One line: how many, the shortest life and the highest pressure."""
        return (
            f"<LoadCases: {self.life.size} loads, L10r from {self.life.min(initial=math.inf):.4g} million "
            f"revolutions, up to {self.pressure.max(initial=0.0) / 1e9:.3g} GPa>"
        )


def load_cases(
    bearing: BallBearing,
    loads: ArrayLike,
    *,
    C: float | None = None,
    arm: Arm = "mean",
    angle: float = 0.0,
) -> LoadCases:
    """Load cases of a bearing: equilibrium, ball loads and basic reference rating life under each of many.

    The same as `rating_life` case by case, solved in C; tens of thousands of cases a second.

    Parameters
    ----------
    bearing
        Ball bearing; which ring turns is said by its `turning`.
    loads
        (m, 6) forces N and moments N m on the inner ring, standing in space.
    C
        Basic dynamic radial rating, N; None: by ISO 281.
    arm
        Of moments and tilts: "mean", Dpw/2, ISO/TS 16281's; or "groove", that of the bearing itself.
    angle
        Cage angle, rad.

    Raises
    ------
    ValueError
        For loads of another shape, and for the first load that presses balls onto an open side.
    ArithmeticError
        For the first load without an equilibrium.

    Warns
    -----
    BearingWarning
        Once, where contact pressures are above 4.2 GPa (ISO 76): names the worst case and counts the others.

    Examples
    --------
    >>> import numpy as np
    >>> import bearingdyn as bd
    >>> ball = bd.BallBearing(7, 11.5e-3, 43.5e-3, 0.52, 0.53, clearance=0.0)
    >>> found = bd.bearing.load_cases(ball, [[1e3, 0, 0, 0, 0, 0], [0, 0, 1e3, 0, 0, 0]], C=23400.0)
    >>> np.round(found.life, 0)
    array([13163.,  2223.])
    """
    from bearingdyn import core  # late: the compiled kernel is needed only here

    instance("bearing", bearing, BallBearing, "give a BallBearing")
    try:
        f = real(loads)
    except (TypeError, ValueError):
        f = np.zeros(0)
    if f.ndim != 2 or f.shape[1] != 6 or not np.isfinite(f).all():
        raise ValueError(f"loads has the shape {f.shape}; it must be (m, 6), finite, in N and N m")
    held = with_arm(bearing, arm)
    found = ratings_of(held).C
    rating = found if C is None else check_given("C", C, found)
    turn = plausible("turned angle", "angle", angle, "it must be a finite angle in rad")
    R = held.arm
    target = np.column_stack([f[:, 0], f[:, 1], f[:, 2], -f[:, 4] / R, f[:, 3] / R])
    size = np.linalg.norm(target, axis=1)
    radius = (size / held.kappa) ** (2 / 3) + abs(held.geometry.Pd) / 2 + held.film
    kernel = held.kernel()
    shaft = turn / held.cage_ratio if held.cage_ratio else 0.0
    z, Q, ended = core.bearing_settle(
        kernel, target, np.where(radius > 0, radius, 1e-9), held.angle0 + turn, shaft
    )
    check_light(bearing, Q, "loads")
    for word, error, what in (
        ("no equilibrium", ArithmeticError, "no equilibrium; is the load within what the bearing can carry?"),
        ("open side", ValueError, f"balls are pressed onto the open side; {OPEN_SIDE_REMEDY}"),
    ):
        wrong = np.flatnonzero(ended == core.SETTLED[word])
        if wrong.size:
            raise error(f"loads[{wrong[0]}] is {f[wrong[0]].tolist()}; {what}")
    q = np.column_stack([z[:, 0], z[:, 1], z[:, 2], z[:, 4] / R, -z[:, 3] / R, np.zeros(len(z))])
    peak = Q.max(axis=1, initial=0.0)
    pressure = max(c.pressure(1.0) for c in (held.inner_contact, held.outer_contact)) * np.cbrt(peak)
    over = np.flatnonzero(pressure > STATIC_PRESSURE)
    if over.size:
        worst = int(pressure.argmax())
        more = f", and {over.size - 1} more cases above it" if over.size > 1 else ""
        warn(
            f"loads[{worst}] is {f[worst].tolist()}: {pressure[worst] / 1e9:.3g} GPa in its worst contact, "
            f"over 4.2 GPa (ISO 76){more}; the bearing's static radial rating is {held.static_rating:.3g} N",
            BearingWarning,
        )
    return LoadCases(q, Q, pressure, lives(held, Q, Q, rating))


def lives(bearing: BallBearing, inner: Array, outer: Array, C: float) -> Array:
    """Load cases' lives (m,), million revolutions, from the loads of the balls (m, Z), N.

    Parameters
    ----------
    bearing
        Its geometry, and which ring turns.
    inner, outer
        (m, Z) loads of the contacts, N.
    C
        Basic dynamic radial rating, N.
    """
    wear = np.zeros(len(inner))
    for Q, capacity, ratio in zip(
        (inner, outer), race_capacities(bearing, C), bearing.ring_speeds, strict=True
    ):
        power = 3.0 if ratio != 0 else 10 / 3
        mean = ((Q / capacity) ** power).mean(axis=1) ** (1 / power)
        wear += mean ** (10 / 3)
    with np.errstate(divide="ignore"):
        return np.asarray(wear**-0.9)
