"""Files of numbers: their columns, and the entries of a sparse matrix."""

from __future__ import annotations

import io
from pathlib import Path

import numpy as np
import scipy.sparse

from bearingdyn.types import Array, Index


def columns(path: Path, delimiter: str | None, widths: tuple[int, ...], kind: str) -> Array:
    """The numbers of a text file, (lines, columns); lines that begin with * are left out.

    Fortran's exponents (1.0D+05) are read too.

    Raises
    ------
    ValueError
        Naming the file where it does not hold as many columns as one of widths.
    """
    try:
        try:
            table = np.loadtxt(path, comments="*", delimiter=delimiter, ndmin=2)
        except ValueError:
            text = path.read_text(encoding="ascii").replace("D", "e").replace("d", "e")
            table = np.loadtxt(io.StringIO(text), comments="*", delimiter=delimiter, ndmin=2)
    except (ValueError, OSError) as error:
        raise ValueError(f"{path} cannot be read as {kind}: {error}") from error
    if table.size == 0 or table.shape[1] not in widths:
        wanted = " or ".join(str(w) for w in widths)
        raise ValueError(f"{path} has {table.shape[1]} columns of numbers; {kind} has {wanted}")
    return table


def whole(path: Path, table: Array) -> Index:
    """Integers written among other numbers. Raises ValueError where they are none."""
    rounded = np.rint(table)
    if not np.all(np.abs(table - rounded) < 1e-9):
        raise ValueError(f"{path} has a node or row number that is not an integer; check the export")
    return rounded.astype(np.intp)


def symmetric_from(row: Index, column: Index, value: Array, n: int) -> scipy.sparse.csr_matrix:
    """The matrix whose entries a file lists: of one triangle, which is mirrored, or of both."""
    A = scipy.sparse.csr_matrix((value, (row, column)), shape=(n, n))
    # a triangle in the file's own order need not be one in another: what counts are entries with partners
    off = row != column
    there = np.minimum(row, column)[off] * n + np.maximum(row, column)[off]
    if np.unique(there).size < there.size:
        return A
    return scipy.sparse.csr_matrix(A + A.T - scipy.sparse.diags(A.diagonal()))
