"""Non-negative relaxation spectra by least squares, strengths eliminated (variable projection).

A modulus Σ x_j φ_j(ω) with x ≥ 0 and causal φ_j (a spring, Maxwell branches, a dashpot) satisfies the
Kramers–Kronig relations whatever the x_j: what such a sum cannot render is not a linear, causal, passive
material.

Reference: G.H. Golub, V. Pereyra, Inverse Problems 19 (2003) R1, with Kaufman's simplified derivative.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy

from bearingdyn.types import Array


def branch_columns(omega: Array, tau: Array) -> tuple[Array, Array]:
    """Columns of a relaxation spectrum at ω (p,) of unit branches, τ (n,): storage and loss modulus (p, n).
    (18, 19)."""
    x = omega[:, None] * tau
    loss = x / (1 + x * x)
    return x * loss, loss


def unit_columns(omega: Array, tau: Array) -> tuple[Array, Array]:
    """Columns of a relaxation spectrum at ω (p,): a unit spring, unit branches, τ (n,), a unit dashpot.

    Two arrays (p, n + 2).
    """
    storage, loss = branch_columns(omega, tau)
    one, none = np.ones((omega.size, 1)), np.zeros((omega.size, 1))
    return np.hstack([one, storage, none]), np.hstack([none, loss, omega[:, None]])


def branch_slopes(omega: Array, tau: Array) -> tuple[Array, Array]:
    """Slopes of a spectrum's :func:`branch_columns` with respect to ln ω, or ln τ: (p, n) each."""
    storage, loss = branch_columns(omega, tau)
    return 2 * loss * loss, loss * (1 - 2 * storage)


@dataclass(frozen=True)
class Strengths:
    """Strengths of a relaxation spectrum: the non-negative least-squares solution of A x ≈ b.

    Attributes
    ----------
    x
        Solution, (n,), ≥ 0.
    residual
        A x − b, (m,).
    basis
        Orthonormal basis of the columns with x > 0, (m, r).
    """

    x: Array
    residual: Array
    basis: Array

    def project_out(self, columns: Array) -> Array:
        """The part of the columns, (m, k), that active strengths cannot take up (Kaufman's derivative)."""
        return np.asarray(columns - self.basis @ (self.basis.T @ columns))


def solve_strengths(A: Array, b: Array, lower: Array | None = None, upper: Array | None = None) -> Strengths:
    """Relaxation spectrum's strengths: min ‖A x − b‖, lower ≤ x ≤ upper (0 and ∞ unless given).

    A (m, n), b (m,), bounds (n,), lower ≥ 0; where they are equal the strength is fixed.
    """
    if lower is None or upper is None or not (lower.any() or np.isfinite(upper).any()):
        return _non_negative(A, b)
    x = lower.copy()
    free = upper > lower
    rest = b - A[:, ~free] @ x[~free]
    low, high = lower[free], upper[free]
    if not (low.any() or np.isfinite(high).any()):
        inner = _non_negative(A[:, free], rest)
        x[free] = inner.x
        return Strengths(x, A @ x - b, inner.basis)
    length = np.linalg.norm(A[:, free], axis=0)
    length[length == 0] = 1.0
    scaled = A[:, free] / length
    found = scipy.optimize.lsq_linear(scaled, rest, bounds=(low * length, high * length), method="bvls")
    x[free] = np.clip(found.x / length, low, high)
    inside = found.active_mask == 0
    return Strengths(x, A @ x - b, np.linalg.qr(scaled[:, inside])[0])


def _non_negative(A: Array, b: Array) -> Strengths:
    length = np.linalg.norm(A, axis=0)
    length[length == 0] = 1.0
    scaled = A / length
    n = A.shape[1]
    if n == 0:  # everything is fixed
        return Strengths(np.empty(0), -b, scaled)
    if A.shape[0] > 2 * n:  # the triangular factor poses the same problem in fewer rows
        R: Array = np.asarray(np.linalg.qr(np.column_stack([scaled, b]), mode="r"))
        y, _ = scipy.optimize.nnls(R[:, :n], R[:, n], maxiter=30 * n)
    else:
        y, _ = scipy.optimize.nnls(scaled, b, maxiter=30 * n)
    active = y > 0
    basis = np.linalg.qr(scaled[:, active])[0]
    return Strengths(y / length, scaled @ y - b, basis)


def dense_times(omega_min: float, omega_max: float, per_decade: int = 12, margin: float = 1.5) -> Array:
    """Relaxation times, s, equispaced in the logarithm, from margin decades below 1/ω_max to as far above
    1/ω_min."""
    low, high = -np.log10(omega_max) - margin, -np.log10(omega_min) + margin
    return np.asarray(np.logspace(low, high, 1 + int(np.ceil((high - low) * per_decade))))
