"""What holds the outside of a ring all round or in places: beds, feet and arcs, by the ring's orders."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from bearingdyn.bearing import RacewaySeries
from bearingdyn.checks import items, nonnegative, number, positive, two
from bearingdyn.plausible_ranges import plausible
from bearingdyn.types import Array

_POINTS = 64  # Gauss points per order and arc of a turn: exact for products of cosines to round-off


@dataclass(frozen=True)
class RingBed:
    """Springs and dampers over the outside of a ring, all round or in an arc (Winkler's foundation).

    Parameters
    ----------
    stiffness
        Radial, N/m³: pressure by depth.
    axial
        The same along the axis, N/m³; None: as the radial one. It also holds the ring against tilting.
    damping
        Of the radial and the axial springs over their stiffness, s.
    arc
        (from, to), rad, rising by no more than a turn; None: all round.

    Raises
    ------
    ValueError
        For a stiffness that is not positive, or an arc that does not rise.
    """

    stiffness: float
    axial: float | None = None
    damping: float = 0.0
    arc: tuple[float, float] | None = None

    def __post_init__(self) -> None:
        positive("stiffness", self.stiffness, "it must be a positive stiffness in N/m³")
        if self.axial is not None:
            nonnegative("axial", self.axial, "it must be a stiffness in N/m³, zero or more")
        nonnegative("damping", self.damping, "it must be a time in s, zero or more")
        plausible("bed stiffness", "stiffness", self.stiffness)
        plausible("bed stiffness", "axial", self.axial or 0.0)
        plausible("support damping", "damping", self.damping)
        if self.arc is not None:
            start, end = two("arc", self.arc, "it must be (from, to) in rad, rising by up to a turn")
            if not 0.0 < end - start <= 2.0 * math.pi * (1 + 1e-12):
                raise ValueError(f"arc is {self.arc}; it must be (from, to) in rad, rising by up to a turn")

    def matrix(self, series: RacewaySeries, radius: float, width: float) -> Array:
        """Stiffness (n, n) on the coefficients of the outside of a ring, N/m."""
        start, end = (0.0, 2.0 * math.pi) if self.arc is None else self.arc
        highest = max(n for _, n, _ in series.terms)
        panels = max(1, math.ceil((highest + 1) * (end - start) / 8.0))
        x, weight = np.polynomial.legendre.leggauss(_POINTS)
        K = np.zeros((len(series), len(series)))
        axial = self.stiffness if self.axial is None else self.axial
        for a, b in pairwise(np.linspace(start, end, panels + 1)):
            psi = 0.5 * (a + b) + 0.5 * (b - a) * x
            share = radius * width * 0.5 * (b - a) * weight
            for kind, k in enumerate((self.stiffness, axial)):
                rows = waves(series, psi, kind)
                K += (k * share * rows.T) @ rows
        return K


@dataclass(frozen=True)
class RingPoints:
    """RingPoints, lines along the width, at which springs and dampers hold the outside of a ring.

    Parameters
    ----------
    azimuth
        (p,) rad.
    stiffness
        Radial, of each, N/m.
    axial
        Along the axis, of each, N/m; None: as the radial one.
    damping
        Over the stiffness, s.

    Raises
    ------
    ValueError
        For no azimuth, or a stiffness that is not positive.
    """

    azimuth: Sequence[float]
    stiffness: float
    axial: float | None = None
    damping: float = 0.0

    def __post_init__(self) -> None:
        given = items("azimuth", self.azimuth, "it must be a list of angles in rad")
        angles = tuple(number("azimuth", a, "it must hold angles in rad") for a in given)
        if not angles:
            raise ValueError("azimuth is empty; a ring needs a foot to stand on")
        object.__setattr__(self, "azimuth", angles)
        positive("stiffness", self.stiffness, "it must be a positive stiffness in N/m")
        if self.axial is not None:
            nonnegative("axial", self.axial, "it must be a stiffness in N/m, zero or more")
        nonnegative("damping", self.damping, "it must be a time in s, zero or more")
        for angle in angles:
            plausible("angle", "azimuth", angle)
        plausible("stiffness", "stiffness", self.stiffness)
        plausible("stiffness", "axial", self.axial or 0.0)
        plausible("support damping", "damping", self.damping)

    def matrix(self, series: RacewaySeries, radius: float, width: float) -> Array:
        """Stiffness (n, n) on the coefficients of the outside of a ring, N/m."""
        K = np.zeros((len(series), len(series)))
        axial = self.stiffness if self.axial is None else self.axial
        for kind, k in enumerate((self.stiffness, axial)):
            rows = waves(series, np.array(self.azimuth), kind)
            K += k * rows.T @ rows
        return K


def waves(series: RacewaySeries, psi: Array, axial: int) -> Array:
    """Waves along a ring's support: radial (axial 0) or axial (1) motion (p, n) at azimuths ψ (p,)."""
    rows = [
        (np.sin(n * psi) if sine else np.cos(n * psi)) * (kind == axial) for kind, n, sine in series.terms
    ]
    return np.stack(rows, axis=1)


def held_by(
    supports: Sequence[RingBed | RingPoints], rows: Array, series: RacewaySeries, radius: float, width: float
) -> tuple[Array, Array]:
    """Stiffness and damping (n + 6, n + 6) of a ring's supports in a rigid bore, which has six coordinates.

    rows (coefficients, n) are the motion of the ring's outside.
    """
    relative = np.hstack([rows, -series.rigid(radius)])
    K = np.zeros((relative.shape[1],) * 2)
    C = np.zeros_like(K)
    for support in supports:
        own = relative.T @ support.matrix(series, radius, width) @ relative
        own = 0.5 * (own + own.T)
        K += own
        C += support.damping * own
    return K, C
