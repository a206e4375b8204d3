"""Sparse Cholesky of Intel's PARDISO, out of the MKL that the extra `fast` installs."""

from __future__ import annotations

import ctypes
import ctypes.util
import importlib.metadata
import sys
import weakref
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import scipy

# its name for real symmetric positive definite matrices; its phases
POSITIVE_DEFINITE = 2
ANALYSE, FACTORISE, SOLVE, FREE = 11, 22, 33, -1
# its settings, by the places in its manual: given by hand, order by METIS, refinement only after a disturbed
# pivot. Its own default refines every solution twice, for three times the work, where the residual of a block
# of 30 thousand coordinates is 3e-13 of the load without and 2e-13 with it.
SETTINGS = {1: 1, 2: 2, 8: 0}
KEPT, LARGEST_KEPT = 2, 1_500_000  # patterns that are kept, and their entries at most: some 60 MB each
SAME_EACH_RUN = 2  # MKL_CBWR_AUTO: one order of summation on a machine, whichever thread is done first


class Cholesky:
    """Factors of a real positive definite matrix by Intel's PARDISO; ``.solve(b)`` for b (n,) or (n, m).

    Raises
    ------
    numpy.linalg.LinAlgError
        For a matrix that is not positive definite.
    """

    together = 4  # columns that it answers in the time of two

    def __init__(self, A: Any) -> None:
        upper = _upper(A)
        first = upper.indices[np.minimum(upper.indptr[:-1], upper.nnz - 1)]
        if not np.array_equal(first, np.arange(A.shape[0])):  # the library asks for every diagonal entry
            raise np.linalg.LinAlgError("the matrix is not positive definite: its diagonal has gaps")
        starts, columns = (np.asarray(x + 1, dtype=np.int32) for x in (upper.indptr, upper.indices))
        known, error = _analysed(starts, columns), 0
        self._call = _Call(starts, columns) if known is None else known
        if known is None:
            error = self._call(ANALYSE)
        # the factors are the library's, outside of what Python counts
        weakref.finalize(self, _rest, self._call)
        self._call.data = upper.data
        error = error or self._call(FACTORISE)
        if error:
            raise np.linalg.LinAlgError(f"PARDISO finds no factors: its error {error}")

    def solve(self, b: Any) -> Any:
        """A⁻¹ b."""
        if b.size == 0:
            return np.zeros_like(b)
        b = np.asfortranarray(b, dtype=np.float64)
        x = np.empty_like(b)
        error = self._call(SOLVE, b, x)
        if error:
            raise np.linalg.LinAlgError(f"PARDISO solves nothing: its error {error}")
        return x


class _Call:
    """The library's one function, with a matrix by rows and the factors' handle."""

    def __init__(self, starts: Any, columns: Any) -> None:
        self.data, self.starts, self.columns = np.ones(columns.size), starts, columns
        self.alone = _alone()
        self.handle, self.settings = np.zeros(64, dtype=np.int64), np.zeros(64, dtype=np.int32)
        for place, value in SETTINGS.items():
            self.settings[place - 1] = value

    def __call__(self, phase: int, b: Any = None, x: Any = None) -> int:
        """Run a phase, on columns b (n, m) with answers x in its place; returns the library's error."""
        one, silent, error = ctypes.c_int32(1), ctypes.c_int32(0), ctypes.c_int32(0)
        kind, n = ctypes.c_int32(POSITIVE_DEFINITE), ctypes.c_int32(self.starts.size - 1)
        columns = ctypes.c_int32(1 if b is None or b.ndim == 1 else b.shape[1])
        library = _library()
        # of this thread alone: in a solution, which memory bounds, a second thread mostly waits, and busily
        before = library.MKL_Set_Num_Threads_Local(1) if phase == SOLVE else None
        library.pardiso(
            self.handle.ctypes, *map(ctypes.byref, (one, one, kind, ctypes.c_int32(phase), n)),
            self.data.ctypes, self.starts.ctypes, self.columns.ctypes, None, ctypes.byref(columns),
            self.settings.ctypes, ctypes.byref(silent), None if b is None else b.ctypes,
            None if x is None else x.ctypes, ctypes.byref(error),
        )  # fmt: skip
        if before is not None:
            library.MKL_Set_Num_Threads_Local(before)
        return error.value


# Patterns that have been analysed and whose factors nobody asks any more. The analysis is half the work of a
# factorisation, and designs that differ in dimensions share it; its order depends on the pattern alone.
_idle: list[_Call] = []


def _analysed(starts: Any, columns: Any) -> _Call | None:
    """An idle call of this pattern, which is idle no more; None where there is none."""
    for call in list(_idle) if _alone() else ():
        if np.array_equal(call.starts, starts) and np.array_equal(call.columns, columns):
            try:
                _idle.remove(call)
            except ValueError:  # another thread has taken it
                continue
            return call
    return None


def _alone() -> bool:
    """Whether the library works in one thread."""
    return int(_library().MKL_Get_Max_Threads()) == 1


def _rest(call: _Call) -> None:
    """Keep what was found of a call's pattern, and the room of its factors, for the next of the same.

    With one thread alone, as in the workers of a study: solutions take one, and where factors took several
    the library crashes when it is to factorise once more.
    """
    if call.columns.size > LARGEST_KEPT or not (call.alone and _alone()):
        call(FREE)
        return
    _idle.append(call)
    while len(_idle) > KEPT:
        _idle.pop(0)(FREE)


@cache
def library_path() -> str | None:
    """Where Intel's library is: beside what pip installed, in the environment, or on the system; or None.

    It is sought once, without being loaded.
    """
    try:
        of = importlib.metadata.files("mkl") or []
    except importlib.metadata.PackageNotFoundError:
        of = []
    installed = [Path(str(file.locate())) for file in of if "mkl_rt" in file.name]
    for folder, name in (("lib", "libmkl_rt.*"), ("Library/bin", "mkl_rt*.dll")):
        installed += sorted((Path(sys.prefix) / folder).glob(name))
    for path in installed:
        if path.is_file() and path.suffix != ".lib":
            return str(path.resolve())
    return ctypes.util.find_library("mkl_rt")


@cache
def _library() -> Any:
    """The library, loaded once.

    Its results are the same in every run: what is kept by the hash of a reduced part is found again. Where
    something else in the process has used the library before, it is too late to ask for that.
    """
    found = ctypes.CDLL(library_path())
    found.MKL_CBWR_Set(SAME_EACH_RUN)
    found.pardiso.restype = None
    return found


def _upper(A: Any) -> Any:
    """Upper triangle of a symmetric matrix by rows, which are its columns too."""
    A = scipy.sparse.csc_matrix(A)
    A.sort_indices()
    row = np.repeat(np.arange(A.shape[0], dtype=A.indices.dtype), np.diff(A.indptr))
    kept = A.indices >= row
    ends = np.concatenate([[0], np.cumsum(kept)])[A.indptr]
    return scipy.sparse.csr_matrix((A.data[kept], A.indices[kept], ends), shape=A.shape)
