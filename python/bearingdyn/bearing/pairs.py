"""Two equal ball bearings side by side, set against each other (DB, DF) or one behind the other (DT)."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from bearingdyn.bearing.ball_bearing import BallBearing
from bearingdyn.bearing.contact_pressure import check_bearing_pressure
from bearingdyn.bearing.energy_minimum import minimum
from bearingdyn.bearing.load_and_motion_checks import check_load
from bearingdyn.bearing.open_side import OPEN_SIDE_REMEDY, runs_off, shoulder
from bearingdyn.checks import nonnegative, positive, require, vector
from bearingdyn.magnitude import plausible
from bearingdyn.types import Array

Arrangement = Literal["DB", "DF", "DT"]
_MIRROR = np.array([1.0, 1.0, -1.0, -1.0, -1.0, 1.0])
"""Reflection z → −z of a motion or of a load: axial vectors keep their component along z."""


@dataclass(frozen=True)
class Pair:
    """A pair of equal bearings on one shaft and in one housing, all four rings rigid.

    Motions q (6,) and loads (6,) are of both inner rings together relative to both outer rings, reference on
    the axis midway between the rows; q = 0 is the preloaded pair without load.

    Parameters
    ----------
    row
        One bearing; by itself its inner ring carries axial load towards +z.
    arrangement
        "DB" back to back: the lines of contact meet the axis outside the pair, as wide a base as there is for
        moments. "DF" face to face: they meet it between the rows. "DT" tandem: both rows carry towards +z.
    distance
        Between the middles of the rows, m.
    preload
        How much closer than touching the rings of the two rows are clamped, both rows together, m: the axial
        gap between the rings before clamping. Not for "DT".
    preload_force
        Axial force of each row on the other, N, instead of `preload`.

    Raises
    ------
    ValueError
        Naming the field: a wrong type or arrangement, a distance or preload that is not positive or zero,
        both preloads at once, or a preload of a tandem.

    Examples
    --------
    >>> import math
    >>> import bearingdyn as bd
    >>> from bearingdyn.bearing import Pair
    >>> row = bd.BallBearing(Z=14, Dw=9e-3, Dpw=50e-3, fi=0.52, fo=0.53, contact_angle=math.radians(15))
    >>> pair = Pair(row, "DB", distance=0.015, preload_force=200.0)
    >>> k = pair.stiffness([0.0] * 6)
    >>> bool(k[0, 0] > k[2, 2] > 0)  # radially stiffer than axially
    True
    """

    row: BallBearing
    arrangement: Arrangement
    distance: float
    preload: float | None = None
    preload_force: float | None = None

    def __post_init__(self) -> None:
        require(isinstance(self.row, BallBearing), "row", self.row, "give a BallBearing")
        known = self.arrangement in ("DB", "DF", "DT")
        require(known, "arrangement", self.arrangement, 'it must be "DB", "DF" or "DT"')
        side = shoulder(self.row.open_side, self.row.contact_angle)
        remedy = "a row by itself must carry towards +z: give the row as it is made, bearing.mirrored()"
        require(side >= 0, "row", self.row, remedy)
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
        free = self.arrangement != "DT" or not (self.preload or self.preload_force)
        require(
            free, "arrangement", self.arrangement, "a tandem has no preload of its own: load it from outside"
        )

    @cached_property
    def approach(self) -> float:
        """Axial approach of the rings of each row from touching, without load, m."""
        if self.preload_force:
            pressed = self.row.displacement([0, 0, self.preload_force, 0, 0, 0])[2]
            return float(pressed) - self._touch
        return (self.preload or 0.0) / 2

    @property
    def _touch(self) -> float:
        """Axial position of a row, from its own origin, at which all balls touch."""
        return 0.0 if self.row.clearance is None else self.row.geometry.Pe / 2

    @cached_property
    def _rows(self) -> tuple[tuple[Array, Array], ...]:
        """(T, q0) of each row: its own q is T q + q0, T (6, 6)."""
        towards = {"DB": (1, -1), "DF": (-1, 1), "DT": (1, 1)}[self.arrangement]
        rows = []
        for sign, place in zip(towards, (-self.distance / 2, self.distance / 2), strict=True):
            T = np.eye(6)
            # a small rotation moves the point (0, 0, place) by θ × (0, 0, place)
            T[0, 4], T[1, 3] = place, -place
            if sign < 0:
                T = _MIRROR[:, None] * T
            rows.append((T, np.array([0, 0, self._touch + self.approach, 0, 0, 0])))
        return tuple(rows)

    def row_displacements(self, q: ArrayLike) -> tuple[Array, Array]:
        """Motion (6,) of each row from its own origin, in its own frame (mirrored if it carries −z)."""
        x = vector("q", q, (6,), "(x, y, z, θx, θy, θz) of the inner rings relative to the outer rings")
        first, second = (T @ x + q0 for T, q0 in self._rows)
        return first, second

    def force(self, q: ArrayLike, angle: float = 0.0) -> Array:
        """Load (6,), N and N m, that holds the inner rings at q (6,), both cages at `angle`, rad."""
        places = self.row_displacements(q)
        parts = (T.T @ self.row.force(x, angle) for (T, _), x in zip(self._rows, places, strict=True))
        return np.asarray(sum(parts))

    def stiffness(self, q: ArrayLike, angle: float = 0.0) -> Array:
        """Tangent (6, 6) ∂force/∂q, symmetric, N/m, N and N m."""
        places = self.row_displacements(q)
        parts = (T.T @ self.row.stiffness(x, angle) @ T for (T, _), x in zip(self._rows, places, strict=True))
        return np.asarray(sum(parts))

    def ball_loads(self, q: ArrayLike, angle: float = 0.0) -> tuple[Array, Array]:
        """Contact loads (Z,) of the row at −distance/2 and of the row at +distance/2, N."""
        first, second = self.row_displacements(q)
        return self.row.ball_loads(first, angle), self.row.ball_loads(second, angle)

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

        def law(u: Array) -> tuple[float, Array, Array, float]:
            q, kappa = np.append(u * length, 0.0), self.row.kappa
            energy, g, K, held = 0.0, np.zeros(5), np.zeros((5, 5)), 0.0
            for (T, _), x in zip(self._rows, self.row_displacements(q), strict=True):
                # as far out as the search goes, whatever the pressures there
                B = self.row.coefficients() @ T[:, :5] * length
                g_row, K_row, _, loads = self.row.evaluate(x, angle)
                energy += float(0.4 * (loads * (loads / kappa) ** (2 / 3)).sum())
                g, K, held = g + B.T @ g_row, K + B.T @ K_row @ B, held + float(loads.sum())
            return energy, g, K, held

        check_load("load", f)
        target = f[:5] * length
        expected = (float(np.linalg.norm(target)) / self.row.kappa) ** (2 / 3) + self.approach
        q = np.append(minimum(law, target, expected or 1e-9) * length, 0.0)
        places = zip(("first", "second"), self.row_displacements(q), self.ball_loads(q, angle), strict=True)
        for name, place, loads in places:
            astray = runs_off(self.row.kernel(), self.row.relative(place), loads, self.row.angle0 + angle)
            if astray:
                raise ValueError(f"load is {f.tolist()}; in the {name} row {astray}; {OPEN_SIDE_REMEDY}")
            check_bearing_pressure(self.row, loads)
        return q
