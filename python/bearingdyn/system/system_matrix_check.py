"""Whether a matrix of a system is square, finite and symmetric, or skew-symmetric."""

from __future__ import annotations

import numpy as np

from bearingdyn.types import Array

# of two entries that should be equal, as a share of the largest of the matrix: far above the round-off of
# double precision in any change of coordinates, far below what a wrong sign makes
ASYMMETRY = 1e-9


def check_matrix(name: str, A: Array, n: int, sign: int) -> None:
    """Refuse a system's matrix that is not (n, n), finite, symmetric (sign 1) or skew (−1): ValueError.

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
