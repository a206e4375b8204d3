"""Rigid motions, factors and lowest modes of finite element matrices."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import scipy
from numpy.typing import ArrayLike

from bearingdyn.fem.ordering import elimination_order
from bearingdyn.types import Array, Index

DENSE_LIMIT = 400  # below this size LAPACK's dense eigensolver is quicker than a factorisation and Lanczos
DISSECT = 15_000  # above this size nested dissection of a solid fills less than minimum degree
PANEL = 20  # columns SuperLU updates at once; 8, its default, is a quarter slower on large solids


def rigid_motion(points: ArrayLike, reference: ArrayLike = (0.0, 0.0, 0.0)) -> Array:
    """Displacement of points that move rigidly with a reference point: u = d + θ × (p - reference).

    points: (n, 3), m. Returns (3 n, 6): the columns are unit x, y, z, θx, θy, θz of the reference
    point, the rows x, y, z of each point in turn.
    """
    p = np.atleast_2d(np.asarray(points, dtype=np.float64)) - np.asarray(reference, dtype=np.float64)
    R = np.zeros((len(p), 3, 6))
    R[:, [0, 1, 2], [0, 1, 2]] = 1.0
    R[:, 0, 4], R[:, 0, 5] = p[:, 2], -p[:, 1]
    R[:, 1, 3], R[:, 1, 5] = -p[:, 2], p[:, 0]
    R[:, 2, 3], R[:, 2, 4] = p[:, 1], -p[:, 0]
    return R.reshape(-1, 6)


def rigid_transfer(positions: ArrayLike, reference: ArrayLike = (0.0, 0.0, 0.0)) -> Array:
    """Motion (6 n, 6) of six-coordinate points that move rigidly with a reference point.

    positions: (n, 3), m; coordinates x, y, z, θx, θy, θz at each point and at the reference.
    """
    p = np.atleast_2d(np.asarray(positions, dtype=np.float64))
    R = np.zeros((len(p), 6, 6))
    R[:, :3] = rigid_motion(p, reference).reshape(-1, 3, 6)
    R[:, [3, 4, 5], [3, 4, 5]] = 1.0
    return R.reshape(-1, 6)


def rigid_body_inertia(M: Any, R: Array) -> Array:
    """Mass matrix (6, 6) of the rigid motions R (n, 6): mass, first moments, inertia about the reference."""
    return np.asarray(R.T @ (M @ R))


def rigid_body_residual(K: Any, R: Array) -> float:
    """max|K R| / max(|K| |R|) of rigid motions R (n, k): round-off, unless K resists rigid motion."""
    scale = float(np.max(abs(K) @ np.abs(R)))
    return float(np.max(np.abs(K @ R))) / scale if scale > 0 else 0.0


class Factors:
    """Factors of a matrix eliminated in a given order; ``.solve(b)`` for b (n,) or (n, m)."""

    def __init__(self, A: Any, order: Index) -> None:
        self.order = order
        self.lu = scipy.sparse.linalg.splu(
            scipy.sparse.csc_matrix(A[order][:, order]),
            permc_spec="NATURAL",
            diag_pivot_thresh=0.0,
            panel_size=PANEL,
            options={"SymmetricMode": True},
        )

    def solve(self, b: Any) -> Any:
        """A⁻¹ b."""
        x = np.empty_like(b)
        x[self.order] = self.lu.solve(np.ascontiguousarray(b[self.order]))
        return x


def factorise(A: Any) -> Any:
    """Factors of a sparse symmetric positive definite matrix; ``.solve(b)`` as scipy's splu gives it."""
    A = scipy.sparse.csc_matrix(A)
    return Factors(A, elimination_order(A)) if A.shape[0] > DISSECT else _by_minimum_degree(A)


def pivots(A: Any) -> Array:
    """Pivots (n,) of a sparse symmetric matrix, by its rows.

    As many are negative as eigenvalues are (Sylvester). −1 stands where rows were exchanged, which only a
    pivot of zero makes necessary.

    Raises RuntimeError for a singular matrix.
    """
    found = factorise(A)
    lu, order = (found.lu, found.order) if isinstance(found, Factors) else (found, np.arange(A.shape[0]))
    own = np.empty(len(order))
    # without exchanged rows the factors are those of L D Lᵀ
    own[order] = np.where(lu.perm_r == lu.perm_c, lu.U.diagonal()[lu.perm_c], -1.0)
    return own


def order_of(A: Any) -> Index:
    """Order of elimination (n,) for many matrices of one pattern, found once; see Factors."""
    return elimination_order(A) if A.shape[0] > DISSECT else np.argsort(_by_minimum_degree(A).perm_c)


def _by_minimum_degree(A: Any) -> Any:
    return scipy.sparse.linalg.splu(
        A, permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options={"SymmetricMode": True}
    )


def lowest_modes(
    K: Any, M: Any, f_max: float = math.inf, n_modes: int | None = None, lu: Any = None
) -> tuple[Array, Array]:
    """Rising frequencies (m,), Hz, and shapes (n, m) of unit modal mass of K φ = ω² M φ.

    K, M: (n, n) dense or sparse, positive definite. f_max, Hz, and n_modes bound the number of modes;
    lu: factors of K, if at hand. The shapes are the same in every run: the start vector is fixed and the
    largest entry is positive.
    """
    n = K.shape[0]
    limit = n if n_modes is None else min(n_modes, n)
    omega_max = 2.0 * math.pi * f_max
    k = min(limit, 20 if math.isfinite(f_max) else limit)
    if limit == 0:
        return np.zeros(0), np.zeros((n, 0))
    while n > DENSE_LIMIT and k < n // 2:
        lu = factorise(K) if lu is None else lu
        inverse = scipy.sparse.linalg.LinearOperator((n, n), matvec=lu.solve, dtype=np.float64)
        start = np.random.default_rng(0).standard_normal(n)
        lam, phi = scipy.sparse.linalg.eigsh(
            scipy.sparse.csc_matrix(K), k, scipy.sparse.csc_matrix(M), sigma=0.0, OPinv=inverse, v0=start
        )
        if k == limit or lam.max() > omega_max**2:
            break
        k = min(2 * k, limit)
    else:
        dense = [A.toarray() if scipy.sparse.issparse(A) else np.asarray(A) for A in (K, M)]
        lam, phi = scipy.linalg.eigh(dense[0], dense[1])
    order = np.argsort(lam)
    order = order[lam[order] <= omega_max**2][:limit]
    phi = phi[:, order]
    if phi.size:
        size = np.abs(phi)  # of entries equal by symmetry, the first: round-off must not turn the sign
        first = np.argmax(size > (1 - 1e-6) * size.max(axis=0), axis=0)
        phi = phi * np.sign(phi[first, np.arange(phi.shape[1])])
    return np.sqrt(np.maximum(lam[order], 0.0)) / (2.0 * math.pi), phi
