"""Files of numbers: their entries read strictly, and the sparse matrix of them.

A file is read in blocks of whole lines. Each block is first held against the exact form of its lines, at the
speed of one regular expression, and only then given to a fast parser: those take 2.0D+08 for 2.0 and 2,5 for
2, and some do not survive a line that is cut or a zero byte.
"""

from __future__ import annotations

import io
import re
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import BinaryIO

import numpy as np
import scipy

from bearingdyn.notice import UnfinishedLine, warn
from bearingdyn.types import Array, Index

BLOCK = 1 << 24  # bytes read at once; a line may be as long
LARGEST_INDEX = 2**53  # whole numbers a double tells apart
SHOWN = 60  # characters of a line in a message
ROWS = 2_000_000  # beyond, a matrix must have as many entries as rows, or its number of rows is a slip

_WHOLE = rb"[+-]?+\d{1,18}+"
_COUNT = rb"0*+[1-9]\d{0,17}+"
_NUMBER = rb"[+-]?+(?:\d++\.?+\d*+|\.\d++)(?:[eEdD][+-]?+\d++|[+-]\d++)?+"
_BLANK = re.compile(rb"\n[ \t]*\n")
_PLUS = re.compile(rb"(?<!e)\+")  # SciPy takes none before a number
_NO_LETTER = re.compile(rb"(?<=[\d.])(?=[+-])")  # Fortran leaves the letter out: 1.5-100


@dataclass(frozen=True)
class Form:
    """Text table of matrices: what each of its lines is.

    Parameters
    ----------
    columns
        Of each line: "whole" (may be negative), "count" (1 or more) or "number".
    separator
        "," or "" for blanks.
    comment
        The character that begins a line to leave out; "" for none.
    what
        The format and its columns in words.
    """

    columns: tuple[str, ...]
    separator: str
    comment: str
    what: str

    def pattern(self) -> re.Pattern[bytes]:
        """Of as many good lines as there are."""
        blank = rb"[ \t]*+"
        between = blank + b"," + blank if self.separator else rb"[ \t]++"
        part = {"whole": _WHOLE, "count": _COUNT, "number": _NUMBER}
        line = blank + between.join(part[c] for c in self.columns)
        line += blank + (b",?+" + blank if self.separator else b"")
        left_out = rb"|" + blank + re.escape(self.comment.encode()) + rb"[^\n]*+" if self.comment else b""
        return re.compile(rb"(?:(?:" + line + left_out + rb"|" + blank + rb")\r?+\n)*+")


def first_line(path: Path, comment: str) -> str:
    """The first line of a text table that holds something."""
    with path.open("rb") as stream:
        for _, block in _blocks(stream, path, 1):
            for line in block.split(b"\n"):
                if line.strip() and not line.lstrip().startswith(comment.encode()):
                    return line.decode("ascii", "replace")
    return ""


def triples(path: Path, stream: BinaryIO, form: Form, line: int = 1) -> tuple[Index, Index, Array]:
    """Rows, columns (from 0) and values (e,) of a text table whose lines are row, column, value.

    `line` is the number of the first of them.

    Raises
    ------
    ValueError
        Naming the file, the line and what is wrong with it.
    """
    rows, columns, values = [], [], []
    head = b"%%%%MatrixMarket matrix coordinate real general\n%d %d %d\n"
    for at, block, count in _clean(path, stream, form, line):
        try:
            A = scipy.io.mmread(io.BytesIO(head % (10**18, 10**18, count) + block))
        except (ValueError, OverflowError) as error:
            raise ValueError(f"{path}, in line {at} or below: {error}; {form.what}") from None
        rows.append(np.asarray(A.row, dtype=np.intp))
        columns.append(np.asarray(A.col, dtype=np.intp))
        values.append(_finite(path, np.asarray(A.data, dtype=np.float64), at))
    if not rows:
        raise ValueError(f"{path} has no numbers; {form.what}")
    return np.concatenate(rows), np.concatenate(columns), np.concatenate(values)


def table(path: Path, stream: BinaryIO, form: Form, line: int = 1) -> Array:
    """The numbers (lines, columns) of a text table. Raises as `triples` does."""
    width, found = len(form.columns), []
    for at, block, count in _clean(path, stream, form, line):
        numbers = np.fromstring(block.decode("ascii"), dtype=np.float64, sep=" ")
        found.append(_finite(path, numbers.reshape(count, width), at))
    if not found:
        raise ValueError(f"{path} has no numbers; {form.what}")
    return np.concatenate(found)


def whole(path: Path, numbers: Array) -> Index:
    """Integers written among other numbers of a text table. Raises ValueError where one is not."""
    rounded = np.rint(numbers)
    if not np.all((np.abs(numbers - rounded) < 1e-9) & (np.abs(rounded) < LARGEST_INDEX)):
        raise ValueError(f"{path} has a node or row number that is not an integer; check the export")
    return rounded.astype(np.intp)


def rows_fit(path: Path, n: int, entries: int) -> None:
    """Raise ValueError for a number of rows that the entries of a text table cannot fill."""
    if n > max(ROWS, entries):
        raise ValueError(
            f"{path} names row {n} and has {entries} entries, fewer than one a row; check the export"
        )


def symmetric_from(row: Index, column: Index, value: Array, n: int) -> scipy.sparse.csr_matrix:
    """The sparse matrix that a text table lists: of one triangle, which is mirrored, or of both."""
    A = scipy.sparse.csr_matrix((value, (row, column)), shape=(n, n))
    if both_triangles(row, column, n):
        return A
    return scipy.sparse.csr_matrix(A + A.T - scipy.sparse.diags(A.diagonal()))


def both_triangles(row: Index, column: Index, n: int) -> bool:
    """Whether a text table lists both triangles: entries off the diagonal have partners (or come twice)."""
    # a triangle in the file's own order need not be one in another: what counts are entries with partners
    off = row != column
    there = np.minimum(row, column)[off] * n + np.maximum(row, column)[off]
    return bool(np.unique(there).size < there.size)


def _blocks(stream: BinaryIO, path: Path, line: int) -> Iterator[tuple[int, bytes]]:
    """Whole lines, and the number of the first; the last has a line end even where the file has none."""
    rest = b""
    while data := stream.read(BLOCK):
        data = rest + data
        cut = data.rfind(b"\n") + 1
        if not cut and len(data) > BLOCK:
            raise ValueError(f"{path}, line {line} is longer than {BLOCK} bytes; it is no table of numbers")
        rest = data[cut:]
        if cut:
            yield line, data[:cut]
            line += data.count(b"\n", 0, cut)
    if rest.strip():
        yield line, rest + b"\n"


def _clean(path: Path, stream: BinaryIO, form: Form, line: int) -> Iterator[tuple[int, bytes, int]]:
    """Blocks of good lines alone, columns between blanks and exponents after e; line of the first; lines."""
    good = form.pattern()
    left_out = re.compile(rb"(?m)^[ \t]*(?:" + (re.escape(form.comment.encode()) or b"(?!)") + rb".*)?\n")
    comment = form.comment.encode()
    letters = bytes.maketrans(b"DdE,\r", b"eee  ")
    for at, block in _blocks(stream, path, line):
        end = good.match(block).end()  # type: ignore[union-attr]  # it matches nothing at all, too
        if end < len(block):
            wrong = block[end : block.index(b"\n", end)].decode("ascii", "replace").strip()
            number = at + block.count(b"\n", 0, end)
            shown = wrong if len(wrong) <= SHOWN else wrong[:SHOWN] + "…"
            raise ValueError(f"{path}, line {number} is {shown!r}; {form.what}")
        numbers = block.translate(letters)
        # counting is ten times as fast as a search that finds nothing
        if (comment and comment in numbers) or numbers[:1] in b" \t\n" or _BLANK.search(numbers):
            numbers = left_out.sub(b"", numbers)
        powers = numbers.count(b"e+"), numbers.count(b"e-")
        front = sum(numbers.count(b + b"-") for b in (b" ", b"\t", b"\n")) + numbers.startswith(b"-")
        if (numbers.count(b"+"), numbers.count(b"-")) != (powers[0], powers[1] + front):
            numbers = _PLUS.sub(b" ", _NO_LETTER.sub(b"e", numbers))
        if numbers.strip():
            yield at, numbers, numbers.count(b"\n")
    if stream.seekable() and stream.tell() > 0:
        stream.seek(-1, io.SEEK_END)
        if stream.read(1) not in b"\n\x1a":
            warn(f"{path} ends within a line: its last number may be cut", UnfinishedLine)


def _finite(path: Path, values: Array, line: int) -> Array:
    """The values; ValueError where one is beyond the range of a double."""
    if not np.isfinite(values).all():
        raise ValueError(
            f"{path} has a number beyond 1.8e308 in line {line} or below; check the exponents of the export"
        )
    return values
