"""Dynamic stiffness of a full model over frequency: sparse complex solves with its interfaces held."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import scipy

from bearingdyn.cms.full_model import FullModel
from bearingdyn.fem import Factors, order_of
from bearingdyn.material import answer_of
from bearingdyn.short_repr import short
from bearingdyn.types import Array, Complex, Index

DENSE_LIMIT = 500  # below this size LAPACK solves quicker than sparse factors
RESIDUAL = 1e-10  # of a solve, over its right-hand side, after one refinement


@dataclass(frozen=True, eq=False)
class Transfer:
    """Dynamic stiffness at one frequency: p = D q − Aᵀ f, y = A q + Y f; q moves interfaces, f loads points.

    Parameters
    ----------
    D
        (r, r) dynamic stiffness of the interfaces, the forces p that hold them in motion.
    A
        (points, r) motion of the points.
    Y
        (points, points) their receptance with the interfaces held still.
    """

    D: Complex
    A: Complex
    Y: Complex

    __repr__ = short

    def receptance(self, free: Index) -> Complex:
        """Motion of the free interface coordinates, then the points, under forces on them; the rest held."""
        q = np.linalg.solve(self.D[np.ix_(free, free)], np.hstack([np.eye(free.size), self.A[:, free].T]))
        y = self.A[:, free] @ q
        y[:, free.size :] += self.Y
        return np.vstack([q, y])


class Dynamics:
    """Dynamic stiffness of a full model, Z(ω) = K + Σ 2 G*(ω) H + iω C − ω² M, matrices on one pattern.

    The order of elimination is found once.

    Parameters
    ----------
    points
        Rows (p, n) of the points loaded and observed.
    damper
        (B, c): the damping has B c Bᵀ besides, B (n, k) and c (k, k); low rank, so never formed.
    """

    def __init__(self, model: FullModel, points: Any, damper: tuple[Array, Array] | None = None) -> None:
        faces = list(model.interfaces.values())
        self.model = model
        held = np.concatenate([f.dofs for f in faces])
        T = scipy.linalg.block_diag(*[f.T for f in faces])
        self.inner = np.setdiff1d(np.arange(model.n), held)
        matrices = [model.M, model.K, *([model.C] if model.C is not None else [])]
        self._damped = model.C is not None
        matrices += [part.H for part in model.viscoelastic]
        rows, held_rows = [A[self.inner] for A in matrices], [A[held] for A in matrices]
        self._coupling = [np.asarray(A[:, held] @ T) for A in rows]
        self._corner = [T.T @ np.asarray(A[:, held] @ T) for A in held_rows]
        self._data, self._indices, self._indptr = _one_pattern([A[:, self.inner] for A in rows])
        self._order: Index | None = None
        points = scipy.sparse.csr_matrix(points)
        self._F_i, self._F_b = points[:, self.inner].toarray().T, np.asarray(points[:, held] @ T).T
        self._damper = None
        if damper is not None:
            B, c = damper
            self._damper = (B[self.inner], T.T @ B[held], c)

    def _weights(self, omega: float) -> list[complex]:
        weights: list[complex] = [-(omega**2), 1.0]
        if self._damped:
            weights.append(1j * omega)
        for part in self.model.viscoelastic:
            weights.append(2.0 * complex(answer_of(part.material, omega).item()))
        return weights

    def _solver(self, weights: Sequence[complex]) -> Any:
        real = all(complex(w).imag == 0.0 for w in weights)
        data = sum(
            (w.real if real else w) * d for w, d in zip(map(complex, weights), self._data, strict=True)
        )
        n = self.inner.size
        Z = scipy.sparse.csc_matrix((data, self._indices, self._indptr), shape=(n, n))
        if n <= DENSE_LIMIT:
            lu = scipy.linalg.lu_factor(Z.toarray())
            return lambda b: scipy.linalg.lu_solve(lu, b)
        return self._sparse_solver(Z)

    def _sparse_solver(self, Z: Any) -> Any:
        """Solve without pivoting and refine once; where that fails (Z may be indefinite), pivot."""
        if self._order is None:
            self._order = order_of(Z)
        factors = Factors(Z, self._order)

        def solve(b: Any) -> Any:
            if Z.dtype.kind == "c":
                b = b.astype(np.complex128)
            elif b.dtype.kind == "c":
                return solve(b.real) + 1j * solve(b.imag)
            x = factors.solve(b)
            x += factors.solve(b - Z @ x)
            if not np.linalg.norm(b - Z @ x) <= RESIDUAL * np.linalg.norm(b):
                lu = scipy.sparse.linalg.splu(Z)
                x = lu.solve(b)
                x += lu.solve(b - Z @ x)
            return x

        return solve

    def solve(self, omega: float) -> tuple[Transfer, Any, Any]:
        """Transfer at ω, rad/s; the motion (inner, r) with the interfaces moved, (inner, p) with loads."""
        weights = self._weights(omega)
        Z_ib: Any = sum(w * A for w, A in zip(weights, self._coupling, strict=True))
        Z_bb: Any = sum(w * A for w, A in zip(weights, self._corner, strict=True))
        backsolve = self._solver(weights)
        r = Z_ib.shape[1]
        if self._damper is None:
            u = backsolve(np.hstack([-Z_ib, self._F_i]))
        else:
            B_i, B_b, c = self._damper
            Z_ib = Z_ib + 1j * omega * B_i @ (c @ B_b.T)
            Z_bb = Z_bb + 1j * omega * B_b @ (c @ B_b.T)
            u = backsolve(np.hstack([-Z_ib, self._F_i, B_i]).astype(np.complex128))
            u, v = u[:, : r + self._F_i.shape[1]], u[:, r + self._F_i.shape[1] :]
            # (Z + iω B c Bᵀ)⁻¹ by Woodbury's formula, in the form that allows a singular c
            core = np.linalg.solve(np.eye(len(c)) + 1j * omega * c @ (B_i.T @ v), 1j * omega * c)
            u = u - v @ (core @ (B_i.T @ u))
        W, V = u[:, :r], u[:, r:]
        D = Z_bb + Z_ib.T @ W
        return (
            Transfer(
                (0.5 * (D + D.T)).astype(np.complex128),
                (self._F_b.T + self._F_i.T @ W).astype(np.complex128),
                (self._F_i.T @ V).astype(np.complex128),
            ),
            W,
            V,
        )


def _one_pattern(matrices: Sequence[Any]) -> tuple[list[Array], Any, Any]:
    """Data of square sparse matrices on the union of their patterns, and that pattern in csc form."""
    n = matrices[0].shape[0]
    sorted_ = []
    for A in matrices:
        A = scipy.sparse.csc_matrix(A)
        A.sum_duplicates()
        column = np.repeat(np.arange(n, dtype=np.int64), np.diff(A.indptr))
        sorted_.append((column * n + A.indices, A.data))
    keys = np.unique(np.concatenate([key for key, _ in sorted_]))
    data = []
    for key, values in sorted_:
        full = np.zeros(keys.size)
        full[np.searchsorted(keys, key)] = values
        data.append(full)
    indptr = np.searchsorted(keys, np.arange(n + 1, dtype=np.int64) * n).astype(np.intc)
    return data, (keys % n).astype(np.intc), indptr
