"""Where tables come from: text files, spreadsheets, frames and arrays, all as numbered rows of cells."""

from __future__ import annotations

import csv
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from bearingdyn.checks import existing

_OLE, _ZIP = b"\xd0\xcf\x11\xe0", b"PK\x03\x04"
_EXTRA = "give it as CSV, or install the extra that reads it: pip install 'bearingdyn[xls]'"
_SEPARATORS = ("\t", ";", ",")


@dataclass(frozen=True)
class Row:
    """A row by its number in the file, 1 the first: the line of a text, or the cells of a sheet."""

    number: int
    text: str
    cells: tuple[str, ...] | None = None


@dataclass(frozen=True)
class Source:
    """Rows that are not blank, the name of the file for messages, and what a row is called there."""

    name: str
    rows: tuple[Row, ...]
    word: str = "line"

    def at(self, number: int) -> str:
        """File and line, for a message."""
        return f"{self.name}, {self.word} {number}"


@dataclass(frozen=True)
class Splitter:
    """How the lines of a table come apart; blanks between cells if the separator is one."""

    separator: str
    quoted: bool

    @classmethod
    def of(cls, header: str) -> Splitter:
        """As the header shows it."""
        separator = next((mark for mark in _SEPARATORS if mark in header), " ")
        # a double quote that opens no cell is the mark of a loss modulus, E"
        return cls(separator, not ('"' in header and not re.search(r'(^|[,;\t])\s*"', header)))

    def cells(self, row: Row) -> list[str]:
        """Cells of a row."""
        if row.cells is not None:
            return list(row.cells)
        if self.separator == " ":
            return row.text.split()
        if not self.quoted:
            return row.text.split(self.separator)
        try:
            return next(csv.reader([row.text], delimiter=self.separator), [])
        except csv.Error:  # a cell too long, or a quote astray
            return row.text.split(self.separator)


def read_source(path: Path) -> list[Source]:
    """The sheets of a file: one for a text, several for a spreadsheet.

    ValueError naming the file if it is binary, of unknown encoding, a spreadsheet that cannot be read, or
    empty.
    """
    existing(path, "table")
    with path.open("rb") as file:
        data = file.read()
    if data[:4] == _OLE:
        return _sheets(path, _read_xls)
    if data[:4] == _ZIP:
        return _sheets(path, _read_xlsx)
    lines = re.split(r"\r\n|\r|\n", _decode(path, data))
    rows = [Row(i, line) for i, line in enumerate(lines, 1) if line.strip() and line.lstrip()[0] != "#"]
    if not rows:
        raise ValueError(f"{path}, line 1: the file holds no table: a header and rows of numbers are needed")
    return [Source(str(path), tuple(rows))]


def _decode(path: Path, data: bytes) -> str:
    if data[:2] in (b"\xff\xfe", b"\xfe\xff"):
        encodings = ["utf-16"]
    elif b"\0" in data:
        raise ValueError(
            f"{path}, line {1 + data[: data.index(0)].count(10)}: a binary file (an instrument's own "
            "format), not a text table: export it as CSV"
        )
    else:
        encodings = ["utf-8-sig", "latin-1"]  # the second takes any bytes
    for encoding in encodings:
        try:
            return data.decode(encoding)
        except UnicodeDecodeError as error:
            place = 1 + data[: error.start].count(b"\n")
    raise ValueError(f"{path}, line {place}: not a text in {encodings[0]}, as its first bytes say")


def _sheets(path: Path, read: Any) -> list[Source]:
    try:
        tables = read(path)
    except ImportError as error:
        raise ValueError(
            f"{path}, line 1: a spreadsheet, and {error.name} is not installed: {_EXTRA}"
        ) from error
    except Exception as error:  # a broken spreadsheet ends in whatever the reader trips over
        raise ValueError(
            f"{path}, line 1: a spreadsheet that cannot be read ({error}): export it as CSV"
        ) from error
    found = []
    for name, cells in tables:
        rows = [
            Row(i, "\t".join(line), tuple(line))
            for i, line in enumerate(cells, 1)
            if any(c.strip() for c in line)
        ]
        if rows:
            found.append(Source(f"{path}, sheet {name!r}", tuple(rows)))
    if not found:
        raise ValueError(f"{path}, line 1: the spreadsheet is empty")
    return found


def _read_xls(path: Path) -> list[tuple[str, list[list[str]]]]:
    import io

    import xlrd

    book = xlrd.open_workbook(str(path), logfile=io.StringIO())
    return [
        (sheet.name, [[_text(v) for v in sheet.row_values(r)] for r in range(sheet.nrows)])
        for sheet in book.sheets()
    ]


def _read_xlsx(path: Path) -> list[tuple[str, list[list[str]]]]:
    import openpyxl

    book = openpyxl.load_workbook(str(path), read_only=True, data_only=True)
    try:
        return [
            (sheet.title, [[_text(v) for v in row] for row in sheet.iter_rows(values_only=True)])
            for sheet in book.worksheets
        ]
    finally:
        book.close()


def _text(value: Any) -> str:
    if value is None:
        return ""
    return repr(float(value)) if isinstance(value, int | float | np.number) else str(value)


def source_of(data: Any) -> Source:
    """A pandas frame, a mapping of columns, or an array (n, 4) of frequency Hz, temperature °C, moduli Pa.

    ValueError if it is none of these, or the columns differ in length.
    """
    if hasattr(data, "columns") and hasattr(data, "__getitem__"):
        columns = {str(name): np.asarray(data[name], dtype=object) for name in data.columns}
    elif isinstance(data, Mapping):
        columns = {str(name): np.asarray(values, dtype=object) for name, values in data.items()}
    else:
        columns = _array_columns(data)
    lengths = {name: values.shape for name, values in columns.items()}
    if not columns or len(set(lengths.values())) != 1 or any(len(shape) != 1 for shape in lengths.values()):
        raise ValueError(f"data: columns must be one-dimensional and equally long, have {lengths}")
    header = Row(0, "\t".join(columns), tuple(columns))
    rows = [
        Row(i, "", tuple(_text(v) for v in values))
        for i, values in enumerate(zip(*columns.values(), strict=True))
    ]
    return Source("data", (header, *rows), "row")


def _array_columns(data: Sequence[Any]) -> dict[str, Any]:
    try:
        array = np.asarray(data, dtype=np.float64)
    except (TypeError, ValueError):
        array = np.empty(0)
    if array.ndim != 2 or array.shape[1] != 4:
        raise ValueError(
            f"data of type {type(data).__name__}: must be a path, a pandas frame, a mapping of columns, or "
            "an array of four columns: frequency Hz, temperature °C, storage and loss modulus Pa"
        )
    names = ("frequency_Hz", "temperature_C", "storage modulus_Pa", "loss modulus_Pa")
    return {name: array[:, k].astype(object) for k, name in enumerate(names)}
