"""Factors of sparse symmetric matrices, and their pivots.

SuperLU comes with SciPy and is the default. Where the extra `fast` is installed, large positive definite
matrices go to the sparse Cholesky of Intel's PARDISO, by pypardiso.
"""

from __future__ import annotations

import copy
import importlib.util
import os
import sys
import weakref
from functools import cache
from pathlib import Path
from typing import Any, Protocol

import numpy as np
import scipy

from bearingdyn.fem.elimination_order import elimination_order
from bearingdyn.types import Array, Index

DISSECT = 15_000  # above this size nested dissection of a solid fills less than minimum degree
PANEL = 20  # columns SuperLU updates at once; 8, its default, is a quarter slower on large solids
# from this size PARDISO is asked where it is installed
LARGE = 5_000
LIBRARY = "PYPARDISO_MKL_RT"  # the variable by which pypardiso is told where its library is
# its name for real symmetric positive definite matrices, and the phases: analyse and factorise, solve
POSITIVE_DEFINITE, FACTORISE, SOLVE = 2, 12, 33
# its settings, by the places in its manual: given by hand, order by METIS, refinement only after a disturbed
# pivot. Its own default refines every solution twice, for three times the work, where the residual of a block
# of 30 thousand coordinates is 3e-13 of the load without and 2e-13 with it.
SETTINGS = {1: 1, 2: 2, 8: 0}
SAME_EACH_RUN = 2  # MKL_CBWR_AUTO: one order of summation on a machine, whichever thread is done first


class Factor(Protocol):
    """Factors of a matrix A, by whichever library."""

    def solve(self, b: Any, /) -> Any:
        """A⁻¹ b of b (n,) or (n, m)."""


class Cholesky:
    """Factors of a real positive definite matrix by Intel's PARDISO; ``.solve(b)`` for b (n,) or (n, m).

    Raises
    ------
    numpy.linalg.LinAlgError
        For a matrix that is not positive definite.
    """

    def __init__(self, A: Any) -> None:
        self._upper = _upper(A)
        solver = copy.copy(_pardiso())
        solver.pt, solver.iparm = np.zeros_like(solver.pt), np.zeros_like(solver.iparm)
        for place, value in SETTINGS.items():
            solver.set_iparm(place, value)
        # the factors are the library's, outside of what Python counts
        weakref.finalize(self, solver.free_memory, everything=True)
        self._solver = solver
        from pypardiso.pardiso_wrapper import PyPardisoError

        # its public `solve` hashes the matrix anew at every call, which takes as long as a solution
        solver.set_phase(FACTORISE)
        try:
            solver._call_pardiso(self._upper, np.zeros((A.shape[0], 1)))
        except PyPardisoError as error:
            raise np.linalg.LinAlgError(str(error)) from error
        solver.set_phase(SOLVE)

    def solve(self, b: Any) -> Any:
        """A⁻¹ b."""
        if b.size == 0:
            return np.zeros_like(b)
        return self._solver._call_pardiso(self._upper, np.asfortranarray(b, dtype=np.float64)).reshape(
            b.shape
        )


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
    A = scipy.sparse.csc_matrix(A)
    if A.shape[0] >= LARGE and A.dtype == np.float64 and _has_pardiso():
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


def _upper(A: Any) -> Any:
    """Upper triangle of a symmetric matrix by rows, which are its columns too."""
    A = scipy.sparse.csc_matrix(A)
    A.sort_indices()
    row = np.repeat(np.arange(A.shape[0], dtype=A.indices.dtype), np.diff(A.indptr))
    kept = A.indices >= row
    ends = np.concatenate([[0], np.cumsum(kept)])[A.indptr]
    return scipy.sparse.csr_matrix((A.data[kept], A.indices[kept], ends), shape=A.shape)


@cache
def _has_pardiso() -> bool:
    return importlib.util.find_spec("pypardiso") is not None


@cache
def _pardiso() -> Any:
    """A solver of its own library handle, sought once.

    Its results are the same in every run: what is kept by the hash of a reduced part is found again. Where
    something else in the process has used the library before, it is too late to ask for that.
    """
    # its own search, at its import, walks through the whole installation for half a second
    beside = sorted((Path(sys.prefix) / "lib").glob("libmkl_rt.so*"), key=lambda path: len(path.name))
    told = bool(beside) and LIBRARY not in os.environ
    if told:
        os.environ[LIBRARY] = str(beside[0])
    try:
        import pypardiso

        solver = pypardiso.PyPardisoSolver(mtype=POSITIVE_DEFINITE)
    finally:
        if told:
            del os.environ[LIBRARY]
    solver.libmkl.MKL_CBWR_Set(SAME_EACH_RUN)
    return solver


def _by_minimum_degree(A: Any) -> Any:
    return scipy.sparse.linalg.splu(
        A, permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options={"SymmetricMode": True}
    )
