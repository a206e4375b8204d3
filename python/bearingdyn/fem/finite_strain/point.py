"""Stress and moduli of nearly incompressible rubber at a point, in the deformed state.

With the gradient F of the deformation, J = det F and b̄ = J^(−2/3) F Fᵀ, the energy per reference volume is
G·W(Ī1, Ī2) + p(J − 1) − p²/2K, the pressure p an unknown of each element. All here is Kirchhoff's (per
reference volume): stress τ, moduli c of its Lie derivative, and A = c + the geometric part, so that the
second variation of the energy at fixed p is ∫ l:A:l dV0 for a further displacement of spatial gradient l
(Simo & Hughes, Computational Inelasticity, 1998, §9.2; Holzapfel, Nonlinear Solid Mechanics, 2000, §6.6).

Second-order tensors are (..., 3, 3), fourth-order ones (..., 9, 9) over pairs ij in the order 11, 12, ...,
33.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from bearingdyn.material import Hyperelastic
from bearingdyn.types import Array

ONE = np.eye(3).ravel()
SYMMETRIC = np.array(
    [
        [0.5 * (i == k) * (j == m) + 0.5 * (i == m) * (j == k) for k in range(3) for m in range(3)]
        for i in range(3)
        for j in range(3)
    ]
)
"""𝕀 = ½(δ_ik δ_jl + δ_il δ_jk), the identity on symmetric tensors."""
TURNED = np.array(
    [[float(i == m and j == k) for k in range(3) for m in range(3)] for i in range(3) for j in range(3)]
)
"""δ_il δ_jk, which transposes."""
DEVIATORIC = SYMMETRIC - np.outer(ONE, ONE) / 3.0


@dataclass(frozen=True, eq=False)
class Point:
    """Points of a material at finite strain: deformation, stress, tangent.

    Parameters
    ----------
    F
        (..., 3, 3) deformation gradients.
    law
        Strain energy for a shear modulus of one.
    shear
        (...,) shear modulus, Pa.
    """

    F: Array
    law: Hyperelastic
    shear: Array

    @cached_property
    def J(self) -> Array:
        """Volume over that in the reference, (...,)."""
        return np.asarray(np.linalg.det(self.F))

    @cached_property
    def b(self) -> Array:
        """Isochoric left Cauchy–Green tensor (..., 3, 3)."""
        b = self.F @ np.swapaxes(self.F, -1, -2)
        return np.asarray(b * np.cbrt(self.J)[..., None, None] ** -2)

    @cached_property
    def _invariants(self) -> tuple[Array, Array, Array]:
        """b̄², Ī1, Ī2."""
        square = self.b @ self.b
        first = np.trace(self.b, axis1=-2, axis2=-1)
        return square, first, 0.5 * (first**2 - np.trace(square, axis1=-2, axis2=-1))

    @cached_property
    def _derivatives(self) -> tuple[Array, ...]:
        _, first, second = self._invariants
        return tuple(self.shear * d for d in self.law.derivatives(first, second))

    @property
    def energy(self) -> Array:
        """Isochoric energy per reference volume, Pa, (...,)."""
        return self._derivatives[0]

    @cached_property
    def _fictitious(self) -> Array:
        """τ̃ = 2(W1 + Ī1 W2) b̄ − 2 W2 b̄², whose deviator is the stress."""
        square, first, _ = self._invariants
        _, W1, W2, _ = self._derivatives
        scale = 2.0 * (W1 + first * W2)
        return np.asarray(scale[..., None, None] * self.b - 2.0 * W2[..., None, None] * square)

    @cached_property
    def stress(self) -> Array:
        """Isochoric Kirchhoff stress τ (..., 3, 3), Pa."""
        return np.asarray(
            self._fictitious
            - np.trace(self._fictitious, axis1=-2, axis2=-1)[..., None, None] / 3.0 * np.eye(3)
        )

    @cached_property
    def moduli(self) -> Array:
        """Isochoric moduli c (..., 9, 9) of the Lie derivative of τ, Pa."""
        _, first, _ = self._invariants
        _, _, W2, W11 = self._derivatives
        b = self.b.reshape(*self.b.shape[:-2], 9)
        tau = self.stress.reshape(b.shape)
        trace = np.trace(self._fictitious, axis1=-2, axis2=-1)[..., None, None]
        c = 2.0 / 3.0 * trace * DEVIATORIC
        c -= 2.0 / 3.0 * (tau[..., :, None] * ONE + ONE[:, None] * tau[..., None, :])
        second = (W2 + W11)[..., None, None]
        if np.any(second):
            dev = b - first[..., None] / 3.0 * ONE
            c += 4.0 * second * dev[..., :, None] * dev[..., None, :]
        if np.any(W2):
            box = 0.5 * (
                np.einsum("...ik,...jl->...ijkl", self.b, self.b)
                + np.einsum("...il,...jk->...ijkl", self.b, self.b)
            ).reshape(c.shape)
            c -= 4.0 * W2[..., None, None] * (DEVIATORIC @ box @ DEVIATORIC)
        return np.asarray(c)

    def tangent(self, pressure: Array) -> Array:
        """A (..., 9, 9), Pa: l:A:l is the second variation of the energy at fixed pressure (...,), Pa."""
        A = self.moduli + _geometric(self.stress)
        pJ = (pressure * self.J)[..., None, None]
        return np.asarray(A + pJ * (np.outer(ONE, ONE) - TURNED))

    @property
    def stability(self) -> Array:
        """Least modulus of a further change of shape over twice the shear modulus, (...,).

        The quadratic form of Jaumann's rate of τ in deviatoric rates d: where it is not positive, the stress
        falls as the strain grows (Drucker).
        """
        form = self.moduli + 2.0 * SYMMETRIC @ _geometric(self.stress) @ SYMMETRIC
        form = DEVIATOR_BASIS.T @ form @ DEVIATOR_BASIS
        return np.asarray(np.linalg.eigvalsh(form)[..., 0] / (2.0 * self.shear))

    @property
    def stretches(self) -> Array:
        """Principal stretches (..., 3), rising."""
        return np.asarray(np.linalg.svd(self.F, compute_uv=False)[..., ::-1], dtype=np.float64)


def _geometric(stress: Array) -> Array:
    """δ_ik τ_jl (..., 9, 9)."""
    A = np.einsum("ik,...jl->...ijkl", np.eye(3), stress)
    return np.asarray(A.reshape(*stress.shape[:-2], 9, 9))


def _deviator_basis() -> Array:
    """Orthonormal symmetric tensors of no trace, (9, 5)."""
    value, vector = np.linalg.eigh(DEVIATORIC)
    return np.asarray(vector[:, value > 0.5])


DEVIATOR_BASIS = _deviator_basis()
