"""Matrices of a part, checked and made read-only."""

from __future__ import annotations

from typing import Any

import numpy as np
import scipy
from numpy.typing import ArrayLike

from bearingdyn.checks import reals
from bearingdyn.types import Array

# Largest accepted |A_ij ∓ A_ji| over the largest |A|. The round-off of a congruence of 1e5 coordinates is
# some 1e-11 of it, and matrices written with ten digits pass; a wrong sign or entry is not so small.
SYMMETRY = 1e-9


def frozen(name: str, value: ArrayLike, shape: tuple[int, ...]) -> Array:
    """A part's matrix or vector frozen, a read-only copy; ValueError for a wrong shape or entry."""
    array = reals(name, value, f"it must be real numbers, {shape}")
    if array.shape != shape:
        raise ValueError(f"{name} has shape {array.shape}; it must be {shape}")
    if not np.isfinite(array).all():
        raise ValueError(f"{name} has an entry that is not finite: {array[~np.isfinite(array)][0]}")
    array.setflags(write=False)
    return array


def frozen_sparse(name: str, value: Any, n: int, columns: int | None = None) -> scipy.sparse.csr_matrix:
    """A part's sparse matrix (csr), to be frozen; ValueError for another shape or a non-finite entry."""
    shape = (n, n if columns is None else columns)
    try:
        matrix = scipy.sparse.csr_matrix(value, dtype=np.float64)
    except (TypeError, ValueError, OverflowError):
        raise ValueError(f"{name} is {value!r}; it must be real numbers, {shape}") from None
    if matrix.shape != shape:
        raise ValueError(f"{name} has shape {matrix.shape}; it must be {shape}")
    if not np.isfinite(matrix.data).all():
        bad = matrix.data[~np.isfinite(matrix.data)][0]
        raise ValueError(f"{name} has an entry that is not finite: {bad}")
    return matrix


def _plainly_symmetric(A: Any, sign: int) -> bool:
    """Whether a sparse matrix has a symmetric pattern and such entries, which is sooner seen."""
    if not scipy.sparse.issparse(A) or not A.nnz:
        return False
    A = A.tocsr()
    turned = A.T.tocsr()
    if not (np.array_equal(A.indptr, turned.indptr) and np.array_equal(A.indices, turned.indices)):
        return False
    off = np.abs(A.data - sign * turned.data).max()
    return bool(off <= SYMMETRY * np.abs(A.data).max())


def check_symmetry(name: str, A: Any, sign: int) -> None:
    """Check that a matrix to be frozen, dense or sparse, is symmetric (sign 1) or skew-symmetric (sign −1).

    Raises
    ------
    ValueError
        Naming the matrix and the two entries farthest from it.
    """
    if 0 in A.shape or _plainly_symmetric(A, sign):
        return
    off, scale = abs(A - sign * A.T), float(abs(A).max())
    if not float(off.max()) <= SYMMETRY * scale:
        i, j = sorted(int(k) for k in np.unravel_index(off.argmax(), off.shape))
        kind = "symmetric" if sign > 0 else "skew-symmetric"
        raise ValueError(
            f"{name}[{i}, {j}] is {A[i, j]:.6g} and {name}[{j}, {i}] is {A[j, i]:.6g}; {name} must be "
            f"{kind}, to {SYMMETRY:g} of its largest entry, {scale:.6g}"
        )
