"""Equilibria under one load while the cage turns by one ball spacing, and their mean stiffness."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from bearingdyn.bearing.ball_bearing import BallBearing
from bearingdyn.bearing.ball_inertia import Running
from bearingdyn.checks import instance, reals, require, vector
from bearingdyn.notice import UnloadedBearing, warn
from bearingdyn.short_repr import short
from bearingdyn.types import Array


@dataclass(frozen=True, eq=False)
class Passage:
    """The passage of one ball: equilibria under one load while the cage turns by one ball spacing."""

    angle: Array
    """(n,) cage angle, rad."""
    displacement: Array
    """(n, 6) of the inner ring, m and rad."""
    stiffness: Array
    """(n, 6, 6) tangent at each equilibrium, N/m, N and N m."""

    __repr__ = short

    @property
    def mean_displacement(self) -> Array:
        """(6,) mean over the passage, m and rad."""
        return np.asarray(self.displacement.mean(axis=0))

    @property
    def mean_stiffness(self) -> Array:
        """(6, 6) mean over the passage, N/m, N and N m."""
        return np.asarray(self.stiffness.mean(axis=0))


def passage(bearing: BallBearing | Running, load: ArrayLike, n: int = 16) -> Passage:
    """Equilibria under a load (6,), N and N m, at n cage angles over the passage of one ball.

    The mean of equally spaced values of a periodic function: it converges fast unless balls come and go.

    Parameters
    ----------
    bearing
        At rest, or with the inertia of its balls.
    load
        (6,) on the inner ring, N and N m.
    n
        Number of cage angles.

    Raises
    ------
    ValueError
        If n is not a positive whole number, on a wrong load, or for a bearing with waviness, defects or
        unequal balls, which does not repeat after a ball spacing.
    ArithmeticError
        If no equilibrium is found.

    Warns
    -----
    UnloadedBearing
        For a load of zero.
    """
    require(isinstance(n, int) and n >= 1, "n", n, "it must be a whole number of positions, one or more")
    instance("bearing", bearing, (BallBearing, Running), "give a BallBearing")
    load = vector("load", load, (6,), "(Fx, Fy, Fz, Mx, My, Mz) on the inner ring in N and N m")
    brg = bearing.bearing if isinstance(bearing, Running) else bearing
    smooth = not (brg.waviness or brg.defects or brg.oversize)
    require(smooth, "bearing", brg, "it must have neither waviness, defects nor unequal balls")
    if not np.any(load):
        warn(
            "load is zero: a bearing that bears nothing has no place of its own, and no stiffness unless it "
            "is clamped; give the load that it runs under",
            UnloadedBearing,
        )
    angle = 2 * math.pi / brg.Z * np.arange(n) / n
    q = np.array([bearing.displacement(load, float(a)) for a in angle])
    K = np.array([bearing.stiffness(place, float(a)) for place, a in zip(q, angle, strict=True)])
    return Passage(angle, q, K)


def without_spin(stiffness: ArrayLike) -> Array:
    """(…, 5, 5) over (x, y, z, θx, θy) of a passage's stiffness (…, 6, 6): about its axis none is held.

    Parameters
    ----------
    stiffness
        (…, 6, 6), N/m, N and N m.

    Raises
    ------
    ValueError
        If the last two axes are not 6 long.
    """
    K = reals("stiffness", stiffness, "it must be real numbers, its last two axes 6 long")
    require(K.shape[-2:] == (6, 6), "stiffness", K.shape, "its last two axes must be 6 long")
    return K[..., :5, :5]
