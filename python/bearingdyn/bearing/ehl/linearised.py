"""The linearised equations: GMRES with the full deflection, preconditioned by an LU of the local one."""

from __future__ import annotations

from typing import Any

import numpy as np
import scipy
from numpy.typing import NDArray

from bearingdyn.bearing.ehl.reynolds import Reynolds
from bearingdyn.types import Array


class Linearised:
    """The linearised film equations, J p = ∂f/∂P p + ∂f/∂H K p on the nodes that are free, p zero elsewhere.

    Parameters
    ----------
    equations, P, H
        Where to linearise.
    free
        Nodes whose pressure may change, (ny, nx).
    rate
        Factor of ρ̄H that is added to the residual: of a time step, or iΩ.
    """

    def __init__(
        self, equations: Reynolds, P: Array, H: Array, free: NDArray[np.bool_], rate: complex = 0.0
    ) -> None:
        self._deflection = equations.deflection
        self._shape = P.shape
        self.rows = np.flatnonzero(free)
        by_P, by_H = equations.jacobian(P, H, rate)
        by_P, self.by_H = by_P[self.rows], by_H[self.rows]
        self._by_P = by_P[:, self.rows]
        self.by_approach = np.asarray(-self.by_H.sum(axis=1)).ravel()
        """∂f/∂δ = −∂f/∂H0 on the free nodes."""
        # cut to 3 × 3 the kernel saves a third of the iterations and costs four times the factorisation
        self.lu = factor(self._by_P + self.by_H[:, self.rows] * equations.deflection.near)
        self.iterations = 0

    def multiply(self, p: NDArray[Any]) -> NDArray[Any]:
        """J p."""
        full = np.zeros(self._shape, dtype=p.dtype)
        full.ravel()[self.rows] = p
        return np.asarray(self._by_P @ p + self.by_H @ self._deflection(full).ravel())

    def solve(self, right: NDArray[Any], tolerance: float) -> NDArray[Any]:
        """J p = right to a residual of tolerance × |right|."""
        p, self.iterations = gmres(self.multiply, self.lu.solve, right, tolerance)
        return p

    def bordered(
        self, right: Array, weights: Array, load: float, mass: float, tolerance: float
    ) -> tuple[Array, float]:
        """p and h of J p + ∂f/∂H0 h = right, weights·p + mass·h = load."""
        column = self.lu.solve(-self.by_approach)
        scale = float(np.linalg.norm(right)) or 1.0
        pivot = mass - float(weights @ column)
        unit = scale * tolerance  # of the border's residual

        def multiply(x: Array) -> Array:
            p, h = x[:-1], x[-1]
            return np.append(self.multiply(p) - self.by_approach * h, (weights @ p + mass * h) * unit)

        def precondition(r: Array) -> Array:
            p = self.lu.solve(r[:-1])
            h = (r[-1] / unit - weights @ p) / pivot
            return np.append(p - column * h, h)

        x, self.iterations = gmres(multiply, precondition, np.append(right, load * unit), tolerance)
        return x[:-1], float(x[-1])


def gmres(
    multiply: Any, precondition: Any, right: NDArray[Any], tolerance: float, limit: int = 200
) -> tuple[NDArray[Any], int]:
    """For the linearised film, a solution by GMRES (Y. Saad, M. H. Schultz 1986), and its iterations.

    Raises ArithmeticError if `limit` iterations do not reach |residual| ≤ tolerance |right|.
    """
    norm = float(np.linalg.norm(right))
    if norm == 0:
        return np.zeros_like(right), 0
    basis = [right / norm]
    directions: list[NDArray[Any]] = []
    R = np.zeros((limit + 1, limit), dtype=right.dtype)
    g = np.zeros(limit + 1, dtype=right.dtype)
    g[0] = norm
    rotations: list[tuple[Any, Any]] = []
    for k in range(limit):
        directions.append(precondition(basis[k]))
        v = multiply(directions[k])
        for i, u in enumerate(basis):
            R[i, k] = np.vdot(u, v)
            v = v - R[i, k] * u
        length = float(np.linalg.norm(v))
        for i, (c, s) in enumerate(rotations):
            R[i, k], R[i + 1, k] = c * R[i, k] + s * R[i + 1, k], -np.conj(s) * R[i, k] + c * R[i + 1, k]
        top = np.hypot(abs(R[k, k]), length)
        phase = R[k, k] / abs(R[k, k]) if R[k, k] != 0 else 1.0
        c, s = abs(R[k, k]) / top, phase * length / top
        rotations.append((c, s))
        R[k, k] = phase * top
        g[k], g[k + 1] = c * g[k], -np.conj(s) * g[k]
        if abs(g[k + 1]) <= tolerance * norm:
            y = scipy.linalg.solve_triangular(R[: k + 1, : k + 1], g[: k + 1])
            return np.asarray(np.array(directions).T @ y), k + 1
        basis.append(v / length)
    raise ArithmeticError(f"GMRES has not converged in {limit} iterations: {abs(g[k + 1]) / norm:.1e}")


def factor(matrix: Any) -> Any:
    """LU of a sparse matrix, the preconditioner of the linearised equations."""
    return scipy.sparse.linalg.splu(
        scipy.sparse.csc_array(matrix),
        permc_spec="MMD_AT_PLUS_A",
        diag_pivot_thresh=0.0,
        options=dict(SymmetricMode=True),
    )
