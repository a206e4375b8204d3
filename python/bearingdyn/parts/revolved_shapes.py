"""Shapes of a body of revolution that rigid faces join, order by order; of raceways, see raceway_shapes."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from bearingdyn.cms import inertia_shapes, orthogonalise
from bearingdyn.fem import Harmonic, held_factors, lowest_modes
from bearingdyn.parts.revolved_joints import Boundaries
from bearingdyn.types import Array, Index

ROUND_OFF = 1e-9  # stiffness of a shape, over that of its parts, below which it is rigid motion


@dataclass(frozen=True, eq=False)
class Held:
    """Coordinates of a harmonic that its faces hold, their shapes R (at, columns), and those that remain."""

    at: Index
    R: Array
    inner: Index

    @classmethod
    def of(cls, h: Harmonic, boundaries: Boundaries) -> Held:
        """What the faces hold of a harmonic."""
        at, R = boundaries.held(h)
        left = np.zeros(h.n, dtype=bool)
        left[h.free] = True
        left[at] = False
        return cls(at, R, np.flatnonzero(left))


@dataclass(frozen=True, eq=False, kw_only=True)
class ShapeMaker:
    """Maker of the shapes of a body of revolution: what they depend on besides the moduli.

    Parameters
    ----------
    bulk, density
        Of each region, Pa and kg/m³.
    f_max
        Limit of the modes, Hz.
    size
        Of the section, m.
    inertia_rounds
        How often the inertia of the shapes is answered.
    """

    boundaries: Boundaries
    bulk: Sequence[complex]
    density: Sequence[float]
    f_max: float
    size: float
    inertia_rounds: int = 0

    def constraint_shapes(self, h: Harmonic, shear: Sequence[complex]) -> tuple[Any, Any]:
        """Static shapes (n, columns) of unit motions of the faces at given moduli, and their stiffness."""
        K = h.stiffness(self.bulk, shear)
        u = self._static(h, K, Held.of(h, self.boundaries))
        return u, u.T @ (K @ u)

    def _static(self, h: Harmonic, K: Any, held: Held) -> Any:
        """Static shapes (n, columns) of unit motions of the faces, by the stiffness."""
        u = np.zeros((h.n, held.R.shape[1]), dtype=K.dtype)
        u[held.at] = held.R
        if held.inner.size and held.R.shape[1]:
            u[held.inner] = -held_factors(h, K, held.inner).solve((K @ u)[held.inner])
        return u

    def basis(self, h: Harmonic, levels: Sequence[Sequence[float]]) -> tuple[Array, int]:
        """Basis (n, columns) of a family: constraint shapes, then internal ones; and the number of the first.

        Internal are the differences of constraint shapes between moduli, which vanish on the boundaries,
        and the modes with the interfaces held. They are made modes of each other, of unit modal mass, and
        those without energy of their own are dropped (torsion has none: it changes no volume, so its shape
        does not depend on the modulus).
        """
        held = Held.of(h, self.boundaries)
        K, M = h.stiffness(self.bulk, levels[0]), h.mass_matrix(self.density)
        static = self._static(h, K, held)
        energy = np.sum(static * (K @ static), axis=0)
        scale = np.sum(np.abs(static) * (abs(K) @ np.abs(static)), axis=0)
        moving = energy > ROUND_OFF * scale
        # Rigid motion of all boundaries has the same shape at every modulus: those of the first add nothing.
        moving[: held.R.shape[1] // max(len(self.boundaries.faces), 1)] = False
        unit = 1.0 / np.sqrt(energy[moving])
        extra = []
        # of one material without volumetric energy, as in torsion, the shapes are those of any modulus
        if len(self.bulk) > 1 or h.volumetric.any():
            for level in levels[1:]:
                shape = self._static(h, h.stiffness(self.bulk, level), held)
                extra.append((shape - static)[:, moving] * unit)
        if self.inertia_rounds:
            for level in levels:
                extra += self._inertia_shapes(h, h.stiffness(self.bulk, level), M, held)
        if self.f_max > 0:
            extra.append(self._modes(h, K, M, levels[0], held))
        internal = np.hstack(extra) if extra else np.zeros((h.n, 0))
        _, internal = orthogonalise(internal, K, M)
        return np.hstack([static, internal]), static.shape[1]

    def _inertia_shapes(self, h: Harmonic, K: Any, M: Any, held: Held) -> list[Array]:
        """Answers (n, m), at rest on the boundaries, to the inertia of the constraint shapes at a modulus."""
        inner = held.inner
        if not inner.size:
            return []
        static = self._static(h, K, held)
        lu = held_factors(h, K, inner)

        def answer(load: Array) -> Array:
            u = np.zeros((h.n, load.shape[1]))
            u[inner] = lu.solve(load)
            return u[inner]

        return inertia_shapes(answer, M, static, inner, self.inertia_rounds)

    def _modes(self, h: Harmonic, K: Any, M: Any, shear: Sequence[float], held: Held) -> Array:
        """Modes (n, m) with interfaces held."""
        inner = held.inner
        shift = 0.0 if held.at.size else self.slow_rate(shear) ** 2
        limit = math.sqrt(self.f_max**2 + shift / (2 * math.pi) ** 2)
        K_i, M_i = K[inner][:, inner], M[inner][:, inner]
        frequency, phi = lowest_modes(K_i + shift * M_i, M_i, f_max=limit)
        squares = (2 * math.pi * frequency) ** 2 - shift
        elastic = squares > 1e-6 * shift
        modes = np.zeros((h.n, int(elastic.sum())))
        modes[inner] = phi[:, elastic] / np.sqrt(squares[elastic])
        return modes

    def slow_rate(self, shear: Sequence[float]) -> float:
        """A tenth of the slowest shear wave's rate, 1/s: as a shift it holds a free body and keeps digits."""
        speeds = [math.sqrt(G / rho) for G, rho in zip(shear, self.density, strict=True)]
        return 0.1 * min(speeds) / self.size
