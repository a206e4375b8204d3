"""Nearly incompressible elements in a deformed state: forces, tangents, and what depends on the frequency.

The pressure is p = K Π(J − 1), Π the projection on the functions `modes` of each element (linear in its
place before deformation), the mixed element Q2/P1 of the linear theory; undeformed, all matrices are those
of the linear theory.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from bearingdyn.fem.finite_strain.point import DEVIATORIC, ONE, SYMMETRIC, Point
from bearingdyn.material import Hyperelastic
from bearingdyn.types import Array, Index

CURRENT, SEPARABLE = "current", "separable"


@dataclass(frozen=True, eq=False, kw_only=True)
class Deformed:
    """Deformed elements (m) with q integration points each, and what one step needs of them.

    Parameters
    ----------
    F
        (m, q, 3, 3) deformation gradients.
    weights
        (m, q) reference volume of each point, m³.
    modes
        (m, q, k) functions that carry the pressure.
    laws
        Elements of each law, and the law.
    shear, bulk
        (m,) Pa.
    """

    F: Array
    weights: Array
    modes: Array
    laws: Sequence[tuple[Index, Hyperelastic]]
    shear: Array
    bulk: Array

    @cached_property
    def _points(self) -> list[tuple[Index, Point]]:
        q = self.F.shape[1]
        return [
            (at, Point(self.F[at], law, np.repeat(self.shear[at, None], q, axis=1))) for at, law in self.laws
        ]

    def _gathered(self, name: str) -> Array:
        parts = [(at, np.asarray(getattr(point, name))) for at, point in self._points]
        if len(parts) == 1 and parts[0][0].size == len(self.F):
            return parts[0][1]
        values = np.empty((len(self.F), *parts[0][1].shape[1:]))
        for at, part in parts:
            values[at] = part
        return values

    @cached_property
    def J(self) -> Array:
        """Volume ratio (m, q)."""
        return np.asarray(np.linalg.det(self.F))

    @cached_property
    def _gram(self) -> Array:
        return self.modes.transpose(0, 2, 1) @ (self.weights[:, :, None] * self.modes)

    @cached_property
    def _swelling(self) -> Array:
        """Π(J − 1) as coefficients of the modes, (m, k, 1)."""
        right = self.modes.transpose(0, 2, 1) @ (self.weights * (self.J - 1.0))[:, :, None]
        return np.asarray(np.linalg.solve(self._gram, right))

    @property
    def pressures(self) -> Array:
        """p as coefficients of the modes, (m, k, 1), Pa; tension positive."""
        return self.bulk[:, None, None] * self._swelling

    @cached_property
    def pressure(self) -> Array:
        """p (m, q), Pa; tension positive."""
        return np.asarray((self.modes @ self.pressures)[:, :, 0])

    def pressures_after(self, B: Array, du: Array) -> Array:
        """The pressures that a further motion du (m, c) leads to, linearised, (m, k, 1)."""
        return np.asarray(
            self.bulk[:, None, None]
            * (self._swelling + np.linalg.solve(self._gram, self.swelling_rows(B) @ du[:, :, None]))
        )

    def swelling_rows(self, B: Array) -> Array:
        """∫ modes δJ dV0 from the coordinates, (m, k, c)."""
        weighted = (self.weights * self.J)[..., None] * self.modes
        return np.asarray(weighted.transpose(0, 2, 1) @ (B[:, :, 0] + B[:, :, 4] + B[:, :, 8]))

    @property
    def energy(self) -> float:
        """Stored energy, J."""
        volumetric = np.sum(self._swelling * (self._gram @ self._swelling), axis=(1, 2))
        return float(np.sum(self.weights * self._gathered("energy")) + 0.5 * self.bulk @ volumetric)

    @cached_property
    def stress(self) -> Array:
        """Kirchhoff stress (m, q, 9), Pa."""
        tau = self._gathered("stress")
        return np.asarray(tau.reshape(*tau.shape[:2], 9) + (self.pressure * self.J)[..., None] * ONE)

    @property
    def cauchy(self) -> Array:
        """Cauchy stress (m, q, 3, 3), Pa."""
        return np.asarray((self.stress / self.J[..., None]).reshape(*self.J.shape, 3, 3))

    def _tangent(self, pressure: Array) -> Array:
        """A (m, q, 9, 9), Pa, at fixed pressure (m, q)."""
        A = np.empty((*self.J.shape, 9, 9))
        for at, point in self._points:
            A[at] = point.tangent(pressure[at])
        return A

    @property
    def stretches(self) -> Array:
        """Principal stretches (m, q, 3), rising."""
        return self._gathered("stretches")

    @property
    def stability(self) -> Array:
        """Least modulus of a further change of shape over twice the shear modulus (m, q); see Point."""
        return self._gathered("stability")

    def force(self, B: Array) -> Array:
        """Forces (m, c) on the elements' coordinates, N, with rows B (m, q, 9, c) of spatial gradients."""
        return np.asarray(np.einsum("mqi,mqic->mc", self.weights[..., None] * self.stress, B, optimize=True))

    def stiffness(self, B: Array, pressures: Array | None = None) -> Array:
        """Static tangent (m, c, c), N/m.

        Parameters
        ----------
        pressures
            (m, k, 1) to take the geometric part at, Pa; None: those of the deformation.
        """
        D = self.swelling_rows(B)
        volume = D.transpose(0, 2, 1) @ np.linalg.solve(self._gram, self.bulk[:, None, None] * D)
        p = self.pressure if pressures is None else (self.modes @ pressures)[:, :, 0]
        return self._integral(self._tangent(p), B) + volume

    def deviatoric(self, B: Array, branches: str) -> Array:
        """H (m, c, c), m: 2(G* − G0)H is what the frequency adds to the tangent.

        "current": ∫ dev d : dev d dV0 with d = sym l: branches at rest in the deformed state, starting anew.
        "separable": ∫ δE:C_iso:δE dV0 / 2G0, the static law's moduli times a function of time (Morman).
        """
        if branches == CURRENT:
            return self._integral(np.broadcast_to(DEVIATORIC, (*self.J.shape, 9, 9)), B)
        return self._integral(SYMMETRIC @ self._gathered("moduli") @ SYMMETRIC, B) / (
            2.0 * self.shear[:, None, None]
        )

    def _integral(self, A: Array, B: Array) -> Array:
        """∫ Bᵀ A B (m, c, c)."""
        AB = A @ B
        AB *= self.weights[..., None, None]
        m, q, _, c = B.shape
        K = B.reshape(m, 9 * q, c).transpose(0, 2, 1) @ AB.reshape(m, 9 * q, c)
        return np.asarray(0.5 * (K + K.transpose(0, 2, 1)))
