"""The lowest modes of a pair of stiffness and mass matrices."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import scipy

from bearingdyn.fem.factors import factorise
from bearingdyn.types import Array

DENSE_LIMIT = 400  # below this size LAPACK's dense eigensolver is quicker than a factorisation and Lanczos


def lowest_modes(
    K: Any, M: Any, f_max: float = math.inf, n_modes: int | None = None, lu: Any = None
) -> tuple[Array, Array]:
    """Lowest modes of K φ = ω² M φ: rising frequencies (m,), Hz, and shapes (n, m) of unit modal mass.

    Every run gives the same shapes: the start vector is fixed, and the largest entry of a shape is positive.

    Parameters
    ----------
    K, M
        (n, n) dense or sparse, positive definite.
    f_max
        Highest frequency, Hz; 0: no modes.
    n_modes
        Highest number of modes.
    lu
        Factors of K, if at hand.
    """
    n = K.shape[0]
    limit = n if n_modes is None else min(n_modes, n)
    omega_max = 2.0 * math.pi * f_max
    k = min(limit, 20 if math.isfinite(f_max) else limit)
    if limit == 0 or f_max == 0:
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
