"""The derivative of a balance as one matrix, factored: for motions of few lines, of which many are wanted.

The tangents T(t) = Σ T̂_j e^{ijθ} couple the lines: a change z of the motion changes the force on line k by

    Σ_l T̂_{k−l} z_l + T̂_{k+l} z̄_l,   T̂ = K̂ + iω_l Ĉ of z_l and its conjugate of z̄_l

(half of it for the mean), and R makes a motion of that.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy

from bearingdyn.analysis.steady.balance import Balance, Pressed
from bearingdyn.types import Array, Complex

# real unknowns up to which factoring costs less than the products it saves
LARGEST = 800


def few(z: Complex) -> bool:
    """Whether a motion (L, m) has so few unknowns that its derivative is factored."""
    return 0 < 2 * z.size <= LARGEST


def jacobian(balance: Balance, pressed: Pressed, *, single: bool = False) -> Array:
    """Derivative of a balance's residual (2Lm, 2Lm), to be factored: amplitudes (L, m) as real numbers.

    In single precision with `single`: enough for corrections, whose residual has all digits.
    """
    number = np.complex64 if single else np.complex128
    lines, omega, R = balance.lines, balance.omega, balance.R.astype(number)
    count, m = R.shape[:2]
    away = (lines.place[:, None] - lines.place) % lines.samples
    towards = (lines.place[:, None] + lines.place) % lines.samples
    rate = (1j * omega[None, :, None, None]).astype(number)
    linear = np.zeros((count, m, count, m), dtype=number)
    mirrored = np.zeros_like(linear)
    for own, along in zip(balance.slots, pressed.bearings, strict=True):
        n = own.stop - own.start
        K, C = ((scipy.fft.fft(T, axis=0) / lines.samples).astype(number) for T in (along.K, along.C))
        straight, turned = K[away] + rate * C[away], K[towards] - rate * C[towards]
        straight[0] *= 0.5
        turned[0] *= 0.5
        # what the reference does is in R already
        at = np.arange(count)
        reference = balance.receptances
        straight[at, at] -= reference.K[own, own] + 1j * omega[:, None, None] * reference.C[own, own]
        for part, out in ((straight, linear), (turned, mirrored)):
            side = part.transpose(0, 2, 1, 3).reshape(count, n, count * n)
            out[:, :, :, own] += (R[:, :, own] @ side).reshape(count, m, count, n)
    _soften(balance, pressed, linear, mirrored)
    each = np.arange(count * m)
    linear.reshape(count * m, count * m)[each, each] += 1.0
    J = np.empty((count, m, 2, count, m, 2), dtype=linear.real.dtype)
    J[:, :, 0, :, :, 0] = linear.real + mirrored.real
    J[:, :, 0, :, :, 1] = mirrored.imag - linear.imag
    J[:, :, 1, :, :, 0] = linear.imag + mirrored.imag
    J[:, :, 1, :, :, 1] = linear.real - mirrored.real
    # the mean has no imaginary part
    J[0, :, 1] = 0.0
    J[:, :, :, 0, :, 1] = 0.0
    J[0, :, 1, 0, :, 1] = np.eye(m)
    return J.reshape(2 * count * m, 2 * count * m)


def _soften(balance: Balance, pressed: Pressed, linear: Complex, mirrored: Complex) -> None:
    """Adds what layers that soften do to the parts (L, m, L, m) of a derivative to be factored."""
    own, softened, R = balance.receptances.of_layers, pressed.softened, balance.R
    at = np.arange(len(R))
    linear[at, :, at, own] += R[:, :, own] * softened.change[:, None]
    for by, of in zip(softened.by, softened.of, strict=True):
        # Re conj(of) dy is half of it and half of its conjugate
        moved = 0.5 * np.einsum("lmk,lk->lm", R[:, :, own], by)
        linear[:, :, :, own] += moved[:, :, None, None] * of.conj()
        mirrored[:, :, :, own] += moved[:, :, None, None] * of


@dataclass(frozen=True, eq=False)
class Factored:
    """A factored derivative of a balance: a square matrix in triangles, for many right-hand sides."""

    triangles: Array
    pivots: Array

    @classmethod
    def of(cls, A: Array) -> Factored:
        """Of A (n, n) in rows, which is overwritten."""
        # in columns, as LAPACK has it, these rows are the transpose
        factor = scipy.linalg.lapack.sgetrf if A.dtype == np.float32 else scipy.linalg.lapack.dgetrf
        triangles, pivots, _ = factor(A.T, overwrite_a=True)
        return cls(triangles, pivots)

    def solve(self, right: Array) -> Array:
        """A⁻¹ right (n,)."""
        single = self.triangles.dtype == np.float32
        solve = scipy.linalg.lapack.sgetrs if single else scipy.linalg.lapack.dgetrs
        x, _ = solve(self.triangles, self.pivots, right, trans=1)
        return np.asarray(x, dtype=np.float64)
