"""The lowest modes of a pair of stiffness and mass matrices."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import scipy

from bearingdyn.fem.block_lanczos import lowest_pairs
from bearingdyn.fem.factors import factorise
from bearingdyn.types import Array

DENSE_LIMIT = 400  # below this size LAPACK's dense eigensolver is quicker than a factorisation and Lanczos
EQUAL = 1e-10  # relative distance of ω² below which two modes are of one frequency, but for round-off
BEYOND = 1.5  # times the highest ω²: a first block of modes up to there has those wanted, though too high
SAME = 1e-8  # share of the largest part of vectors below which what one adds to the others is round-off
APART = 2  # vectors at a time where factors answer each by itself


def lowest_modes(
    K: Any,
    M: Any,
    f_max: float = math.inf,
    n_modes: int | None = None,
    lu: Any = None,
    near: Array | None = None,
) -> tuple[Array, Array]:
    """Lowest modes of K φ = ω² M φ: rising frequencies (m,), Hz, and shapes (n, m) of unit modal mass.

    Every run gives the same shapes: modes of equal frequency are turned to a fixed direction, and the largest
    entry of a shape is positive.

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
    near
        (n, k) vectors, if at hand, in which low modes are strong, as in static answers to inertia: where
        they are as good as a first block, it takes fewer steps.
    """
    n = K.shape[0]
    limit = n if n_modes is None else min(n_modes, n)
    omega_max = 2.0 * math.pi * f_max
    if limit == 0 or f_max == 0:
        return np.zeros(0), np.zeros((n, 0))
    found = None
    if n > DENSE_LIMIT and (math.isfinite(f_max) or limit < n // 2):
        lu = factorise(K) if lu is None else lu
        width = getattr(lu, "together", APART)
        mass = scipy.sparse.csc_matrix(M)
        start = None if near is None else _start(K, mass, near, limit, BEYOND * omega_max**2, width)
        found = lowest_pairs(lu.solve, mass, limit, omega_max**2, n // 2, width, start)
    if found is None:
        dense = [A.toarray() if scipy.sparse.issparse(A) else np.asarray(A) for A in (K, M)]
        found = scipy.linalg.eigh(dense[0], dense[1])
    lam, phi = found
    order = np.argsort(lam)
    order = order[lam[order] <= omega_max**2][:limit]
    phi = _turned(lam[order], phi[:, order])
    if phi.size:
        size = np.abs(phi)  # of entries equal by symmetry, the first: round-off must not turn the sign
        first = np.argmax(size > (1 - 1e-6) * size.max(axis=0), axis=0)
        phi = phi * np.sign(phi[first, np.arange(phi.shape[1])])
    return np.sqrt(np.maximum(lam[order], 0.0)) / (2.0 * math.pi), phi


def _start(K: Any, M: Any, near: Array, count: int, limit: float, width: int) -> Array | None:
    """The lowest modes (n, k) of K and M among combinations of vectors; None where they are too few."""
    squares, turn = np.linalg.eigh(near.T @ (M @ near))
    kept = squares > SAME * squares[-1]
    near = near @ (turn[:, kept] / np.sqrt(squares[kept]))
    lam, turn = np.linalg.eigh(near.T @ (K @ near))
    low = int(np.count_nonzero(lam[: count + 1] <= limit))
    return near @ turn[:, :low] if width <= low <= 2 * width else None


def _turned(lam: Array, phi: Array) -> Array:
    """Shapes of equal λ combined anew: the first of a set takes all of a fixed random direction."""
    ends = [*(np.flatnonzero(np.diff(lam) > EQUAL * lam[1:]) + 1).tolist(), lam.size]
    start, draws = 0, np.random.default_rng(0)
    phi = phi.copy()
    for end in ends:
        if end - start > 1:
            part = phi[:, start:end].T @ draws.standard_normal((len(phi), end - start))
            phi[:, start:end] = phi[:, start:end] @ np.linalg.qr(part)[0]
        start = end
    return phi
