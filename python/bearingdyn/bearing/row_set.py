"""Equal rows of balls that act as one bearing: inner rings on one shaft, outer rings in one housing."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import ClassVar, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from bearingdyn.bearing.ball_bearing import BallBearing
from bearingdyn.bearing.contact_pressure import check_bearing_pressure
from bearingdyn.bearing.energy_minimum import minimum
from bearingdyn.bearing.load_and_motion_checks import check_load
from bearingdyn.bearing.open_side import OPEN_SIDE_REMEDY, runs_off, shoulder
from bearingdyn.checks import nonnegative, positive, require, vector
from bearingdyn.pictures import page
from bearingdyn.plausible_ranges import plausible
from bearingdyn.types import Array

_MIRROR = np.array([1.0, 1.0, -1.0, -1.0, -1.0, 1.0])
"""Reflection z → −z of a motion or of a load: axial vectors keep their component along z."""


def touching(row: BallBearing) -> float:
    """Where a row of a set just touches with all its balls: axial position from its own origin, m.

    Clamped balls touch everywhere: theirs is the centred position.
    """
    return 0.0 if row.clearance is None else row.geometry.Pe / 2


class Row(NamedTuple):
    """One row of a set: where it stands, which way it carries, how it is preloaded."""

    place: float
    """Of its middle along z, from that of the set, m."""
    sense: int
    """+1: the inner ring carries axial load towards +z; −1: the row is mirrored."""
    lift: float
    """Axial approach of its rings from touching, without load, m."""

    def reversed(self) -> Row:
        """The row as it stands when the whole set is hung the other way round."""
        return Row(-self.place, -self.sense, self.lift)

    def hung(self, bearing: BallBearing) -> tuple[BallBearing, float]:
        """The row as a bearing by itself, and how far along z its inner ring is offset, m."""
        side = shoulder(bearing.open_side, bearing.contact_angle)
        own = bearing.mirrored() if self.sense < 0 and side else bearing
        return own, self.sense * (bearing.geometry.Pe / 2 + self.lift) - own.kernel().x0


def at_distance(place: float) -> Array:
    """Matrix (6, 6) from the motion of one row of a set to that of another point on the axis.

    Parameters
    ----------
    place
        How far along z the other point lies, m.
    """
    T = np.eye(6)
    # a small rotation moves the point (0, 0, place) by θ × (0, 0, place)
    T[0, 4], T[1, 3] = place, -place
    return T


@dataclass(frozen=True)
class RowSet(ABC):
    """A set of rows: what `Pair` and `Triplet` have in common, their fields and the law of all rows together.

    Parameters
    ----------
    row
        One bearing; by itself its inner ring carries axial load towards +z.
    arrangement
        Which way each row carries.
    distance
        Between the middles of neighbouring rows, m.
    preload
        How much closer than touching the rings are clamped, m. Not for a tandem.
    preload_force
        Axial force that the rows press on each other with, N, instead of `preload`.

    Raises
    ------
    ValueError
        Naming the field: a wrong type or arrangement, a distance or preload that is not positive or zero,
        both preloads at once, or a preload of a tandem.
    """

    SENSES: ClassVar[Mapping[str, tuple[int, ...]]]
    """Of the rows along z, by arrangement; a tandem's are all +1."""

    row: BallBearing
    arrangement: str
    distance: float
    preload: float | None = None
    preload_force: float | None = None

    _repr_html_ = page

    def __post_init__(self) -> None:
        require(isinstance(self.row, BallBearing), "row", self.row, "give a BallBearing")
        side = shoulder(self.row.open_side, self.row.contact_angle)
        remedy = "a row by itself must carry towards +z: give the row as it is made, bearing.mirrored()"
        require(side >= 0, "row", self.row, remedy)
        *others, last = (f'"{name}"' for name in self.SENSES)
        known = isinstance(self.arrangement, str) and self.arrangement in self.SENSES
        remedy = f"it must be {', '.join(others)} or {last}"
        require(known, "arrangement", self.arrangement, remedy)
        apart = positive(
            "distance", self.distance, "between the rows, in metres, must be positive and finite"
        )
        plausible("length", "distance", apart)
        remedy = "it must be zero or positive, and finite"
        if self.preload is not None:
            plausible("offset", "preload", nonnegative("preload", self.preload, f"in m, {remedy}"))
            both = self.preload_force is None
            require(both, "preload_force", self.preload_force, "give a preload or a preload_force, not both")
        if self.preload_force is not None:
            force = nonnegative("preload_force", self.preload_force, f"{remedy}, in N")
            plausible("force", "preload_force", force)
        tandem = len(set(self.SENSES[self.arrangement])) == 1
        remedy = "a tandem has no preload of its own: load it from outside"
        require(
            not (tandem and (self.preload or self.preload_force)), "arrangement", self.arrangement, remedy
        )

    @property
    @abstractmethod
    def lifts(self) -> tuple[float, ...]:
        """Axial approach of the rings of each row from touching, without load, in the order along z, m."""

    @cached_property
    def rows(self) -> tuple[Row, ...]:
        """The rows in their order along z, `distance` apart, their middle at zero."""
        senses = self.SENSES[self.arrangement]
        first = -0.5 * (len(senses) - 1)
        return tuple(
            Row((first + k) * self.distance, sense, lift)
            for k, (sense, lift) in enumerate(zip(senses, self.lifts, strict=True))
        )

    @cached_property
    def _maps(self) -> tuple[tuple[Array, Array], ...]:
        """(T, q0) of each row: its own q, mirrored if it carries −z, is T q + q0, T (6, 6)."""
        found = []
        for row in self.rows:
            T = at_distance(row.place)
            if row.sense < 0:
                T = _MIRROR[:, None] * T
            found.append((T, np.array([0, 0, touching(self.row) + row.lift, 0, 0, 0])))
        return tuple(found)

    def row_displacements(self, q: ArrayLike) -> tuple[Array, ...]:
        """Motion (6,) of each row from its own origin, in its own frame (mirrored if it carries −z)."""
        x = vector("q", q, (6,), "(x, y, z, θx, θy, θz) of the inner rings relative to the outer rings")
        return tuple(T @ x + q0 for T, q0 in self._maps)

    def force(self, q: ArrayLike, angle: float = 0.0) -> Array:
        """Load (6,), N and N m, that holds the inner rings at q (6,), all cages at `angle`, rad."""
        places = self.row_displacements(q)
        parts = (T.T @ self.row.force(x, angle) for (T, _), x in zip(self._maps, places, strict=True))
        return np.asarray(sum(parts))

    def stiffness(self, q: ArrayLike, angle: float = 0.0) -> Array:
        """Tangent (6, 6) ∂force/∂q, symmetric, N/m, N and N m."""
        places = self.row_displacements(q)
        parts = (T.T @ self.row.stiffness(x, angle) @ T for (T, _), x in zip(self._maps, places, strict=True))
        return np.asarray(sum(parts))

    def ball_loads(self, q: ArrayLike, angle: float = 0.0) -> tuple[Array, ...]:
        """Contact loads (Z,) of each row, N, in the order of the rows along z."""
        return tuple(self.row.ball_loads(x, angle) for x in self.row_displacements(q))

    def displacement(self, load: ArrayLike, angle: float = 0.0) -> Array:
        """Equilibrium q (6,) of the inner rings under a load (6,) in N and N m, θz held, outer rings fixed.

        Raises
        ------
        ValueError
            On a wrong shape or a value that is not finite, and for a load that presses balls onto the open
            side of a row.
        ArithmeticError
            If no equilibrium is found.
        """
        f = vector("load", load, (6,), "(Fx, Fy, Fz, Mx, My, Mz) on the inner rings in N and N m")
        length = np.array([1, 1, 1, 1 / self.row.arm, 1 / self.row.arm])
        maps = self._maps

        def law(u: Array) -> tuple[float, Array, Array, float]:
            q, kernel = np.append(u * length, 0.0), self.row.kernel()
            energy, g, K, held = 0.0, np.zeros(5), np.zeros((5, 5)), 0.0
            for (T, _), x in zip(maps, self.row_displacements(q), strict=True):
                # as far out as the search goes, whatever the pressures there
                B = self.row.coefficients() @ T[:, :5] * length
                g_row, K_row, _, loads = self.row.evaluate(x, angle)
                energy += kernel.stored(loads)
                g, K, held = g + B.T @ g_row, K + B.T @ K_row @ B, held + float(loads.sum())
            return energy, g, K, held

        check_load("load", f)
        target = f[:5] * length
        lift = max(row.lift for row in self.rows)
        expected = (float(np.linalg.norm(target)) / self.row.kappa) ** (2 / 3) + lift
        q = np.append(minimum(law, target, expected or 1e-9) * length, 0.0)
        names = ("first", "second", "third")
        for name, place, loads in zip(
            names, self.row_displacements(q), self.ball_loads(q, angle), strict=False
        ):
            astray = runs_off(self.row.kernel(), self.row.relative(place), loads, self.row.angle0 + angle)
            if astray:
                raise ValueError(f"load is {f.tolist()}; in the {name} row {astray}; {OPEN_SIDE_REMEDY}")
            check_bearing_pressure(self.row, loads)
        return q
