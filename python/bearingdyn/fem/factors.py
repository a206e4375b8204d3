"""Factors of sparse symmetric matrices, and their pivots.

SuperLU comes with SciPy and is the default. Where the extra `fast` is installed, large positive definite
matrices go to the sparse Cholesky of Intel's PARDISO.
"""

from __future__ import annotations

from typing import Any, Protocol

import numpy as np
import scipy

from bearingdyn.fem.elimination_order import elimination_order
from bearingdyn.fem.pardiso import Cholesky, library_path
from bearingdyn.types import Array, Index

DISSECT = 15_000  # above this size nested dissection of a solid fills less than minimum degree
PANEL = 20  # columns SuperLU updates at once; 8, its default, is a quarter slower on large solids
# from this size PARDISO is asked where it is installed
LARGE = 5_000


class Factor(Protocol):
    """Factors of a matrix A, by whichever library."""

    def solve(self, b: Any, /) -> Any:
        """A⁻¹ b of b (n,) or (n, m)."""


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


def factorise(A: Any) -> Factor:
    """Factors of a sparse symmetric positive definite matrix.

    Parameters
    ----------
    A
        (n, n), sparse.

    Returns
    -------
    Factor
        Its ``.solve(b)`` takes b (n,) or (n, m).
    """
    # of a symmetric matrix, rows are columns
    A = A.T if scipy.sparse.issparse(A) and A.format == "csr" else scipy.sparse.csc_matrix(A)
    if A.shape[0] >= LARGE and A.dtype == np.float64 and library_path() is not None:
        try:
            return Cholesky(A)
        except np.linalg.LinAlgError:  # not positive definite: SuperLU asks for no sign
            pass
    found: Factor = _by_superlu(A)
    return found


def pivots(A: Any) -> Array:
    """Pivots (n,) of the factors of a sparse symmetric matrix, by its rows.

    As many are negative as eigenvalues are (Sylvester). −1 stands where rows were exchanged, which only a
    pivot of zero makes necessary.

    Raises
    ------
    RuntimeError
        For a singular matrix.
    """
    found = _by_superlu(scipy.sparse.csc_matrix(A))
    lu, order = (found.lu, found.order) if isinstance(found, Factors) else (found, np.arange(A.shape[0]))
    own = np.empty(len(order))
    # without exchanged rows the factors are those of L D Lᵀ
    own[order] = np.where(lu.perm_r == lu.perm_c, lu.U.diagonal()[lu.perm_c], -1.0)
    return own


def order_of(A: Any) -> Index:
    """Factors of many matrices of one pattern: the order they share, found once.

    Parameters
    ----------
    A
        (n, n), sparse, of the pattern.

    Returns
    -------
    Array
        Permutation (n,).
    """
    return elimination_order(A) if A.shape[0] > DISSECT else np.argsort(_by_minimum_degree(A).perm_c)


def _by_superlu(A: Any) -> Any:
    """Factors or scipy.sparse.linalg.SuperLU, by size."""
    return Factors(A, elimination_order(A)) if A.shape[0] > DISSECT else _by_minimum_degree(A)


def _by_minimum_degree(A: Any) -> Any:
    return scipy.sparse.linalg.splu(
        A, permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options={"SymmetricMode": True}
    )
