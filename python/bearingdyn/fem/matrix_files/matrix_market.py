"""MatrixMarket files (.mtx).

Format: R. Boisvert, R. Pozo, K. Remington, "The Matrix Market exchange formats: initial design", NISTIR 5935
(1996): one line of words, comments that begin with %, a line of sizes, entries.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any, BinaryIO

import numpy as np
import scipy.sparse

from bearingdyn.checks import existing
from bearingdyn.fem.matrix_files.fe_matrices import FEMatrices, Points
from bearingdyn.fem.matrix_files.free_body_checks import checked_files
from bearingdyn.fem.matrix_files.text_tables import Form, both_triangles, rows_fit, table, triples

BANNER = b"%%matrixmarket"
FIELDS = ("real", "double", "integer", "unsigned-integer")
ENTRIES = Form(
    ("count", "count", "number"), "", "%",
    "each line must be row, column and value, rows and columns counted from 1, numbers with a point",
)  # fmt: skip
COLUMN = Form(("number",), "", "%", "each line must be one number, with a point")
LONGEST_LINE = 1024  # of the format
_MOST_COMMENTS = 100_000  # lines; exports have some ten


def is_matrix_market(path: Path) -> bool:
    """Whether a file is in MatrixMarket's format, by its beginning."""
    with path.open("rb") as stream:
        return stream.read(len(BANNER)).lower() == BANNER


def read_matrix_market(
    stiffness: str | Path, mass: str | Path, points: Points | None = None, **check: Any
) -> FEMatrices:
    """Read a stiffness and a mass matrix from two MatrixMarket files (.mtx).

    Fortran's exponents (2.0D+08) are read.

    Parameters
    ----------
    stiffness, mass
        Paths of the files.
    points
        Positions of the nodes, as in check_matrices.
    **check
        Further arguments of check_matrices.

    Returns
    -------
    FEMatrices

    Raises
    ------
    FileNotFoundError
        If there is no such file.
    ValueError
        Naming the file and the line that is not MatrixMarket's, or where check_matrices does.
    """
    files = [existing(stiffness), existing(mass)]
    return checked_files(files, _read(files[0]), _read(files[1]), points, **check)


def _read(path: Path) -> Any:
    with path.open("rb") as stream:
        words = stream.readline(LONGEST_LINE).lower().decode("ascii", "replace").split()
        if len(words) != 5 or words[0].encode() != BANNER or words[1] != "matrix":
            raise ValueError(
                f"{path}, line 1 is {' '.join(words)[:80]!r}; a MatrixMarket file begins with "
                "'%%MatrixMarket matrix coordinate real symmetric', or 'array' and 'general' in their places"
            )
        layout, field, symmetry = words[2:]
        if field == "pattern":
            raise ValueError(f"{path} holds a pattern, which entries there are without values; export 'real'")
        if field not in FIELDS or layout not in ("coordinate", "array"):
            raise ValueError(
                f"{path} is {layout!r} of {field!r} numbers; a stiffness or mass must be 'coordinate' or "
                "'array' and 'real'"
            )
        if symmetry not in ("general", "symmetric"):
            raise ValueError(
                f"{path} is {symmetry!r}; a stiffness or mass must be 'symmetric', or 'general' with both "
                "triangles"
            )
        sizes, line = _sizes(path, stream, 3 if layout == "coordinate" else 2)
        if sizes[0] != sizes[1]:
            raise ValueError(f"{path} has {sizes[0]} rows and {sizes[1]} columns; it must be square")
        n = sizes[0]
        if layout == "array":
            return _array(path, stream, n, symmetry, line)
        row, column, value = triples(path, stream, ENTRIES, line)
    if len(value) != sizes[2]:
        raise ValueError(
            f"{path} has {len(value)} entries where its sizes say {sizes[2]}; the file is cut, or not of one "
            "piece; export again"
        )
    largest = int(max(row.max(), column.max())) + 1
    if largest > n:
        raise ValueError(f"{path} has row or column {largest}, where its sizes say {n}; export again")
    rows_fit(path, n, len(value))
    A = scipy.sparse.csr_matrix((value, (row, column)), shape=(n, n))
    if symmetry == "general":
        return A
    if both_triangles(row, column, n):
        raise ValueError(
            f"{path} says 'symmetric' and holds entries of both triangles, or one twice: write 'general' in "
            "its first line if both are there, or leave one triangle out"
        )
    return A + A.T - scipy.sparse.diags(A.diagonal())


def _sizes(path: Path, stream: BinaryIO, count: int) -> tuple[list[int], int]:
    """The line of sizes behind the comments, and the number of the line after it."""
    line = 2
    while text := stream.readline(1 << 20):
        if text.strip() and not text.lstrip().startswith(b"%"):
            words = text.split()
            if len(words) != count or not all(w.isdigit() and len(w) < 16 for w in words) or b"0" in words:
                shown = text.decode("ascii", "replace").strip()[:80]
                raise ValueError(
                    f"{path}, line {line} is {shown!r}; it must be the sizes: rows, columns"
                    + (" and number of entries" if count == 3 else "")
                )
            return [int(word) for word in words], line + 1
        line += 1
        if line > _MOST_COMMENTS:
            raise ValueError(f"{path}, line {line}: so many comments, and no line of sizes; export again")
    raise ValueError(f"{path} ends before the line of sizes; export again")


def _array(path: Path, stream: BinaryIO, n: int, symmetry: str, line: int) -> Any:
    """Dense columns one after the other, of a symmetric matrix from the diagonal down."""
    needed = n * n if symmetry == "general" else n * (n + 1) // 2
    value = table(path, stream, COLUMN, line)[:, 0]
    if len(value) != needed:
        raise ValueError(
            f"{path} has {len(value)} numbers where {n} rows of a {symmetry!r} array are {needed}; "
            "export again"
        )
    if symmetry == "general":
        return value.reshape(n, n).T
    A = np.zeros((n, n))
    A.T[np.triu_indices(n)] = value  # by columns from the diagonal down
    return A + A.T - np.diag(A.diagonal())
