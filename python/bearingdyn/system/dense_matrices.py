"""Dense symmetric matrices: their check, natural shapes, and factors."""

from __future__ import annotations

import numpy as np
import scipy.linalg

from bearingdyn.types import Array

# below this share of the largest eigenvalue of (K, M) its round-off may hide a slow mode
SLOW = 1e-6
# round-off left in φᵀKφ, as a share of |φ|ᵀ|K||φ|, and in the slow modes, as a share of the fastest of them
ROUND_OFF, SLOW_ROUND_OFF = 1e-12, 1e-13
# below this share of the largest (scaled) eigenvalue a matrix has none: rigid motions of a deviatoric one
RANK = 1e-11
# of two entries that should be equal, as a share of the largest of the matrix: far above the round-off of
# double precision in any change of coordinates, far below what a wrong sign makes
ASYMMETRY = 1e-9


def check_matrix(name: str, A: Array, n: int, sign: int) -> None:
    """Refuse A that is not (n, n), finite, and symmetric (sign 1) or skew-symmetric (sign −1): ValueError.

    Round-off of a congruence transformation, a share of the largest entry, is let through.
    """
    if A.shape != (n, n):
        raise ValueError(f"{name} has the shape {A.shape}; it must be {(n, n)}, as M")
    if not np.isfinite(A).all():
        i, j = np.argwhere(~np.isfinite(A))[0]
        raise ValueError(f"{name}[{i}, {j}] is {A[i, j]}; every entry must be finite")
    off = np.abs(A - sign * A.T)
    i, j = np.unravel_index(np.argmax(off), off.shape) if n else (0, 0)
    if n and off[i, j] > ASYMMETRY * np.abs(A).max():
        kind = "symmetric" if sign > 0 else "skew-symmetric"
        raise ValueError(
            f"{name}[{i}, {j}] is {A[i, j]:g} and {name}[{j}, {i}] is {A[j, i]:g}; {name} must be {kind}"
        )


def natural(K: Array, M: Array) -> tuple[Array, Array]:
    """ω² (n,) and mass-normalised shapes (n, n) of a symmetric (K, M); an ω² within round-off becomes zero.

    The ω² of a suspension at 1 Hz is 1e-12 of that of a layer's inner mode at 1 MHz. The slow modes are
    therefore solved for once more, among themselves.

    Raises
    ------
    ValueError
        For a mass matrix that is not positive definite.
    """
    try:
        squares, shapes = scipy.linalg.eigh(K, M)
    except np.linalg.LinAlgError:
        raise ValueError(
            "the mass matrix is not positive definite: a coordinate has no mass; give every body a mass and "
            "moments of inertia"
        ) from None
    slow = squares < SLOW * squares[-1]
    noise = np.zeros(len(squares))
    if slow.any():
        inner = shapes[:, slow].T @ K @ shapes[:, slow]
        squares[slow], turn = np.linalg.eigh(0.5 * (inner + inner.T))
        shapes[:, slow] = shapes[:, slow] @ turn
        noise[slow] = SLOW_ROUND_OFF * np.abs(squares[slow]).max()
    noise = np.maximum(noise, ROUND_OFF * np.sum(np.abs(shapes) * (np.abs(K) @ np.abs(shapes)), axis=0))
    squares[np.abs(squares) <= noise] = 0.0
    return squares, shapes


def factor(A: Array) -> Array:
    """L (n, rank) with A = L Lᵀ for a positive semi-definite A; directions within round-off are left out."""
    scale = np.sqrt(np.maximum(np.diag(A), 0.0))
    scale[scale == 0.0] = 1.0
    values, vectors = np.linalg.eigh(A / np.outer(scale, scale))
    keep = values > RANK * values[-1]
    return np.asarray(scale[:, None] * vectors[:, keep] * np.sqrt(values[keep]))
