"""Where tables come from: text files, spreadsheets, frames and arrays, all as numbered rows of cells."""

from __future__ import annotations

import csv
import re
import zipfile
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from bearingdyn.checks import existing
from bearingdyn.notice import CutFile, warn

_OLE, _ZIP = b"\xd0\xcf\x11\xe0", b"PK\x03\x04"
_EXTRA = "give it as CSV, or install the extra that reads it: pip install 'bearingdyn[xls]'"
_LARGEST = 32 << 20  # bytes of a file; 400 isotherms of 100 points and 20 columns have 16 MB
_UNPACKED = 16 << 20  # bytes of a packed one: 40 000 points of 10 columns, three seconds of reading
_MOST_ROWS, _MOST_CELLS = 200_000, 2_000_000
_LONGEST_LINE = 100_000  # characters; 2000 columns of 20 have 40 000
_SEPARATORS = ("\t", ";", ",")


@dataclass(frozen=True)
class Row:
    """A row of a source by its number in the file, 1 the first: a line of text, or the cells of a sheet."""

    number: int
    text: str
    cells: tuple[str, ...] | None = None


@dataclass(frozen=True)
class Source:
    """A source: its rows that are not blank, and what they come from.

    Attributes
    ----------
    name
        Name of the file, for messages.
    comments
        Rows that open with #.
    word
        What a row is called there.
    sheet, stem
        Name of the sheet, and of the file without folder and ending; empty where there is none.
    """

    name: str
    rows: tuple[Row, ...]
    comments: tuple[Row, ...] = ()
    word: str = "line"
    sheet: str = ""
    stem: str = ""

    def above(self, number: int) -> tuple[Row, ...]:
        """Rows above the one of this number, comments of a text among them."""
        return tuple(row for row in (*self.comments, *self.rows) if row.number < number)

    def at(self, number: int) -> str:
        """File and line, for a message."""
        return f"{self.name}, {self.word} {number}"


@dataclass(frozen=True)
class Splitter:
    """How the lines of a source come apart; blanks between cells if the separator is one."""

    separator: str
    quoted: bool

    @classmethod
    def of(cls, header: str) -> Splitter:
        """As the header shows it."""
        separator = next((mark for mark in _SEPARATORS if mark in header), " ")
        # a double quote that opens no cell is the mark of a loss modulus, E"
        return cls(separator, not ('"' in header and not re.search(r'(^|[,;\t]) *"', header)))

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
    """The sources in a file: one for a text, one for each sheet of a spreadsheet.

    ValueError naming the file if it is binary, of unknown encoding, a spreadsheet that cannot be read, or
    empty.
    """
    existing(path, "table")
    with path.open("rb") as file:
        data = file.read(_LARGEST + 1)
    if len(data) > _LARGEST:
        raise ValueError(
            f"{path}, line 1: larger than {_LARGEST >> 20} MB: no table of sweeps is; leave out what is not "
            "one"
        )
    if data[:4] == _OLE:
        return _sheets(path, _read_xls)
    if data[:4] == _ZIP:
        return _sheets(path, _read_xlsx)
    lines = re.split(r"\r\n|\r|\n", _decode(path, data))
    if len(lines) > _MOST_ROWS:
        raise ValueError(
            f"{path}, line {_MOST_ROWS + 1}: more than {_MOST_ROWS} lines: no table of sweeps has; leave "
            "out what is not one"
        )
    for number, line in enumerate(lines, 1):
        if len(line) > _LONGEST_LINE:
            raise ValueError(
                f"{path}, line {number}: {len(line)} characters: no table of sweeps has such lines; leave "
                "out what is not one"
            )
    lines = [line.replace("\ufeff", "") for line in lines]  # files put together carry marks inside
    rows = [Row(i, line) for i, line in enumerate(lines, 1) if line.strip() and line.lstrip()[0] != "#"]
    if not rows:
        raise ValueError(f"{path}, line 1: the file holds no table: a header and rows of numbers are needed")
    comments = tuple(Row(i, line) for i, line in enumerate(lines, 1) if line.lstrip().startswith("#"))
    return [Source(str(path), tuple(rows), comments, stem=path.stem)]


def _decode(path: Path, data: bytes) -> str:
    wide = _wide(data)
    if wide:
        encodings = [wide]
        if len(data) % 2:
            last = max(data.rfind(b"\n\0"), data.rfind(b"\0\n"))
            last -= last % 2
            data = data[: max(last, 2)]
            warn(
                f"{path}, line {data.count(10) + 2}: the file ends inside a character, it was cut off: its "
                "last line is left out; copy or export it again",
                CutFile,
            )
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


def _wide(data: bytes) -> str:
    """Name of the encoding if it has two bytes a character, by its mark or its zeros; else empty."""
    if data[:2] in (b"\xff\xfe", b"\xfe\xff"):
        return "utf-16"
    head = data[:512]
    pairs = len(head) // 2
    if pairs >= 8:
        for first, encoding in ((1, "utf-16-le"), (0, "utf-16-be")):
            if head[first::2].count(0) > 0.9 * pairs and head[1 - first :: 2].count(0) == 0:
                return encoding
    return ""


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
            found.append(Source(f"{path}, sheet {name!r}", tuple(rows), sheet=name, stem=path.stem))
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

    with zipfile.ZipFile(path) as packed:
        # whatever their names: a table may be kept under any
        unpacked = sum(member.file_size for member in packed.infolist())
    if unpacked > _UNPACKED:
        raise ValueError(f"it unpacks to {unpacked / 1e6:.0f} MB, more than {_UNPACKED >> 20} MB")
    book = openpyxl.load_workbook(str(path), read_only=True, data_only=True)
    found, cells = [], 0
    try:
        for sheet in book.worksheets:
            sheet.reset_dimensions()  # what a file says of its size need not be so
            rows: list[list[str]] = []
            for row in sheet.iter_rows(values_only=True):
                cells += len(row)
                if cells > _MOST_CELLS or len(rows) >= _MOST_ROWS:
                    raise ValueError(
                        f"sheet {sheet.title!r} has more than {_MOST_ROWS} rows or {_MOST_CELLS} cells"
                    )
                rows.append([_text(v) for v in row])
            found.append((sheet.title, rows))
        return found
    finally:
        book.close()


def _text(value: Any) -> str:
    if value is None:
        return ""
    return repr(float(value)) if isinstance(value, int | float | np.number) else str(value)


def source_of(data: Any) -> Source:
    """The source that is a frame, a mapping, or an array (n, 4): frequency Hz, temperature °C, moduli Pa.

    ValueError if it is none of these, or the columns differ in length.
    """
    if hasattr(data, "columns") and hasattr(data, "__getitem__"):
        return _rows_of([str(name) for name in data.columns], _frame_columns(data))
    elif isinstance(data, Mapping):
        columns = {str(name): np.asarray(values, dtype=object) for name, values in data.items()}
    else:
        columns = _array_columns(data)
    return _rows_of(list(columns), list(columns.values()))


def _frame_columns(data: Any) -> list[Any]:
    """Columns of a frame, by position where it has one: two may have the same name."""
    by_place = getattr(data, "iloc", None)
    if by_place is not None:
        return [np.asarray(by_place[:, k], dtype=object) for k in range(len(data.columns))]
    return [np.asarray(data[name], dtype=object) for name in data.columns]


def _rows_of(names: Sequence[str], columns: Sequence[Any]) -> Source:
    """A header and rows of named columns."""
    shapes = [np.shape(values) for values in columns]
    if not columns or len(set(shapes)) != 1 or any(len(shape) != 1 for shape in shapes):
        lengths = dict(zip(names, shapes, strict=True))
        raise ValueError(f"data: columns must be one-dimensional and equally long, have {lengths}")
    header = Row(0, "\t".join(names), tuple(names))
    rows = [
        Row(i, "", tuple(_text(v) for v in values)) for i, values in enumerate(zip(*columns, strict=True))
    ]
    return Source("data", (header, *rows), word="row")


def _array_columns(data: Sequence[Any]) -> dict[str, Any]:
    try:
        array = np.asarray(data, dtype=np.float64)
    except (TypeError, ValueError, OverflowError):
        array = np.empty(0)
    if array.ndim != 2 or array.shape[1] != 4:
        raise ValueError(
            f"data of type {type(data).__name__}: must be a path, a pandas frame, a mapping of columns, or "
            "an array of four columns: frequency Hz, temperature °C, storage and loss modulus Pa"
        )
    names = ("frequency_Hz", "temperature_C", "storage modulus_Pa", "loss modulus_Pa")
    return {name: array[:, k].astype(object) for k, name in enumerate(names)}
