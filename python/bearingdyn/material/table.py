"""Text tables of an instrument: which column is which, in which unit, and what the numbers are."""

from __future__ import annotations

import csv
import math
import re
import warnings
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

import numpy as np
from numpy.typing import NDArray

_FREQUENCY = {"hz": 1.0, "1/s": 1.0, "khz": 1e3, "mhz": 1e-3, "rad/s": 1 / (2 * math.pi)}
_PRESSURE = {
    "pa": 1.0,
    "kpa": 1e3,
    "mpa": 1e6,
    "gpa": 1e9,
    "n/mm2": 1e6,
    "n/mm²": 1e6,
    "n/m2": 1.0,
    "n/m²": 1.0,
}
_TEMPERATURE = {"c": 0.0, "°c": 0.0, "degc": 0.0, "deg c": 0.0, "ºc": 0.0, "˚c": 0.0, "k": -273.15}
_NONE = {"": 1.0, "-": 1.0, "1": 1.0, "[]": 1.0}

_UNITS: dict[str, dict[str, float]] = {
    "frequency": _FREQUENCY,
    "temperature": _TEMPERATURE,
    "storage": _PRESSURE,
    "loss": _PRESSURE,
    "tan_delta": _NONE,
}
_REQUIRED = ("frequency", "temperature", "storage", "loss")

_ENDING = re.compile(
    r"(?:[\s_,/]+|^)("
    + "|".join(re.escape(u) for u in sorted({*_FREQUENCY, *_PRESSURE, *_TEMPERATURE}, key=len, reverse=True))
    + r")$",
    re.IGNORECASE,
)
_STORAGE = re.compile(r"^(?P<letter>[GE])?\s*(?:'|1|p|prime|stor|storage)(?:\s+modulus)?$", re.IGNORECASE)
_LOSS = re.compile(r"^(?P<letter>[GE])?\s*(?:\"|2|pp|double prime|loss)(?:\s+modulus)?$", re.IGNORECASE)
_KIND = re.compile(r"\b(shear|tensile|tension|young's)\b\s*", re.IGNORECASE)


@dataclass(frozen=True)
class Table:
    """Columns of a table by quantity, in SI units (temperature in °C), with the lines they stand on."""

    values: dict[str, NDArray[np.float64]]
    lines: tuple[int, ...]
    header_line: int
    mode: Literal["shear", "tension"] | None


@dataclass(frozen=True)
class _Column:
    index: int
    title: str
    unit: str
    letter: str


def _title(cell: str) -> tuple[str, str]:
    """Name and unit of a header cell."""
    text = cell.strip().strip('"') if cell.count('"') == 2 else cell.strip()
    text = re.sub("[’′´`]", "'", re.sub("[″”“]", '"', text)).replace("''", '"')
    bracket = re.search(r"[\[(]([^\[\]()]*)[\])]\s*$", text)
    if bracket and bracket.start() > 0 and bracket.group(1).strip().lower() not in ("δ", "delta", "d"):
        return text[: bracket.start()].strip(), bracket.group(1).strip()
    ending = _ENDING.search(text)
    if ending and ending.start() > 0:
        return text[: ending.start()].strip(), ending.group(1)
    return text, ""


def _quantity(name: str) -> tuple[str, str] | None:
    """Quantity a column's name stands for, and the letter G or E of its modulus."""
    words = re.sub(r"[\s_\-]+", " ", name).strip()
    low = words.lower()
    if words in ("f", "ω", "w") or low in (
        "freq",
        "frequency",
        "angular frequency",
        "ang frequency",
        "omega",
    ):
        return "frequency", ""
    if words in ("T", "Ts") or low in ("temp", "temperature", "sample temperature"):
        return "temperature", ""
    if low in ("set", "t nominal", "nominal temperature", "t set", "set temperature", "isotherm"):
        return "isotherm", ""
    if re.sub(r"[\s()]", "", low) in ("tandelta", "tanδ", "tand", "lossfactor"):
        return "tan_delta", ""
    kind = _KIND.search(words)
    words = _KIND.sub("", words).strip()
    for quantity, pattern in (("storage", _STORAGE), ("loss", _LOSS)):
        match = pattern.match(words)
        if match:
            letter = (match.group("letter") or "").upper()
            if not letter and kind:
                letter = "G" if kind.group(1).lower() == "shear" else "E"
            if letter or "modulus" in low or low in ("storage", "loss"):
                return quantity, letter
    return None


def _splitter(header: str) -> tuple[Callable[[str], list[str]], str]:
    """How the lines of a table come apart, judged by its header, and the separator."""
    separator = next((mark for mark in ("\t", ";", ",") if mark in header), " ")
    if separator == " ":
        return str.split, separator
    # a double quote that opens no cell is the mark of a loss modulus, E"
    if '"' in header and not re.search(r'(^|[,;\t])\s*"', header):
        return lambda line: line.split(separator), separator
    return lambda line: next(csv.reader([line], delimiter=separator), []), separator


def _read_lines(path: Path) -> list[tuple[int, str]]:
    """Numbered lines that are neither blank nor comments."""
    data = path.read_bytes()
    if data[:2] in (b"\xff\xfe", b"\xfe\xff"):
        text = data.decode("utf-16")
    elif b"\0" in data or data[:4] in (b"PK\x03\x04", b"\xd0\xcf\x11\xe0"):
        raise ValueError(
            f"{path}: a binary file (a spreadsheet or an instrument's own format), not a text table: "
            "export it as CSV"
        )
    else:
        try:
            text = data.decode("utf-8-sig")
        except UnicodeDecodeError:
            text = data.decode("latin-1")
    lines = [
        (i, line) for i, line in enumerate(text.splitlines(), 1) if line.strip() and line.lstrip()[0] != "#"
    ]
    if not lines:
        raise ValueError(f"{path}: the file holds no table: a header and rows of numbers are needed")
    return lines


def _columns_of(
    cells: list[str], wanted: Mapping[str, str]
) -> tuple[dict[str, _Column], list[tuple[str, str, str]]]:
    """Recognised columns of a line taken for a header, and those that are two of a kind."""
    found: dict[str, _Column] = {}
    doubles: list[tuple[str, str, str]] = []
    for index, cell in enumerate(cells):
        name, unit = _title(cell)
        named = next((q for q, title in wanted.items() if title in (cell.strip(), name)), None)
        recognised = _quantity(name)
        if named is not None:
            letter = recognised[1] if recognised and recognised[0] == named else ""
        elif recognised is None or recognised[0] in wanted:
            continue
        else:
            named, letter = recognised
        if named in found and named in (*_REQUIRED, "tan_delta"):
            doubles.append((named, found[named].title, cell.strip()))
        found.setdefault(named, _Column(index, cell.strip(), unit, letter))
    return found, doubles


def _find_header(
    path: Path, lines: list[tuple[int, str]], wanted: Mapping[str, str]
) -> tuple[int, dict[str, _Column], Callable[[str], list[str]], str]:
    """Position of the header among the lines, its columns, and the splitter."""
    best: tuple[int, set[str]] = (-1, set())
    for position, (number, line) in enumerate(lines):
        split, separator = _splitter(line)
        columns, doubles = _columns_of(split(line), wanted)
        if "tan_delta" in columns and "loss" not in columns:
            columns["loss"] = columns["tan_delta"]
        if columns.keys() >= set(_REQUIRED):
            for quantity, first, second in doubles:
                raise ValueError(
                    f"{path}, line {number}: columns {first!r} and {second!r} both look like the {quantity}: "
                    f"choose by columns={{{quantity!r}: ...}}"
                )
            return position, columns, split, separator
        if len(columns) > len(best[1]):
            best = (number, set(columns))
    missing = [q for q in _REQUIRED if q not in best[1]]
    where = f"{path}, line {best[0]}" if best[1] else f"{path}"
    raise ValueError(
        f"{where}: no column recognised as {', '.join(missing)}: the header must name frequency, "
        "temperature, "
        "storage modulus and loss modulus (or tan delta), or give columns={...} with the names used"
    )


def _number(cell: str, separator: str) -> float:
    text = cell.strip().strip('"')
    if separator != "," and "," in text and "." not in text:
        text = text.replace(",", ".")
    if "_" in text:
        raise ValueError(cell)
    return float(text)


def _is_number(cell: str, separator: str) -> bool:
    try:
        _number(cell, separator)
    except ValueError:
        return False
    return True


def _factor(quantity: str, unit: str, column: _Column, where: str) -> float:
    known = _UNITS[quantity]
    key = unit.strip().strip("[]()").strip().lower()
    if key not in known:
        stated = f"unit {unit.strip()!r}" if key else "no unit"
        raise ValueError(
            f"{where}, column {column.title!r}: {stated} for the {quantity}: known are {', '.join(known)}; "
            f"give units={{{quantity!r}: ...}}"
        )
    return known[key]


def read_table(path: Path, wanted: Mapping[str, str], units: Mapping[str, str], drop_invalid: bool) -> Table:
    """Read the columns frequency, temperature, storage, loss and, if present, isotherm of a text table.

    Parameters
    ----------
    path
        File to read.
    wanted, units
        Column names and units by quantity, that go before what the file says.
    drop_invalid
        Leave out, with a warning, points with an empty, non-finite or non-positive value.

    Raises
    ------
    ValueError
        Naming file, line, column, value and remedy.
    """
    for mapping, name in ((wanted, "columns"), (units, "units")):
        unknown = set(mapping) - {*_UNITS, "isotherm"}
        if unknown:
            raise ValueError(
                f"{name}: unknown quantities {sorted(unknown)}: known are {[*_UNITS, 'isotherm']}"
            )
    lines = _read_lines(path)
    position, columns, split, separator = _find_header(path, lines, wanted)
    header_line = lines[position][0]
    rows = lines[position + 1 :]

    quantities = [*_REQUIRED, *(["isotherm"] if "isotherm" in columns else [])]
    by_tan = columns["loss"] is columns.get("tan_delta")
    unit_cells: list[str] = []
    if rows:
        cells = split(rows[0][1])
        if not any(_is_number(cell, separator) for cell in cells):
            unit_cells, unit_line, rows = cells, rows[0][0], rows[1:]
    if not rows:
        raise ValueError(
            f"{path}, line {header_line}: the table is empty: no rows of numbers follow the header"
        )

    factors: dict[str, float] = {}
    for quantity in _REQUIRED:
        column = columns[quantity]
        kind = "tan_delta" if quantity == "loss" and by_tan else quantity
        where, unit = f"{path}, line {header_line}", column.unit
        if column.index < len(unit_cells) and not unit:
            where, unit = f"{path}, line {unit_line}", unit_cells[column.index]
        factors[quantity] = _factor(kind, units.get(kind, unit), column, where)

    kept: list[list[float]] = []
    numbers: list[int] = []
    dropped: list[str] = []
    for number, line in rows:
        cells = split(line)
        row: list[float] = []
        reason = ""
        for quantity in quantities:
            column = columns[quantity]
            where = f"{path}, line {number}, column {column.title!r}"
            cell = cells[column.index].strip() if column.index < len(cells) else ""
            if cell and not _is_number(cell, separator):
                raise ValueError(
                    f"{where}: {cell!r} is not a number: must be a decimal number such as 1.25e6"
                )
            value = _number(cell, separator) if cell else math.nan
            positive = quantity in ("frequency", "storage", "loss")
            if not math.isfinite(value) or (positive and not value > 0):
                shown = cell or "empty"
                reason = f"{where}: {shown} for the {quantity}"
                if not drop_invalid:
                    need = "positive and finite" if positive else "finite"
                    raise ValueError(f"{reason}: must be {need}; drop_invalid=True leaves such points out")
            row.append(value)
        if reason:
            dropped.append(reason)
        else:
            kept.append(row)
            numbers.append(number)
    if dropped:
        warnings.warn(f"{len(dropped)} of {len(rows)} points left out: first {dropped[0]}", stacklevel=3)
    if not kept:
        raise ValueError(f"{path}: no valid point is left of {len(rows)}: first {dropped[0]}")

    values = dict(zip(quantities, np.array(kept, dtype=np.float64).T, strict=True))
    for quantity in ("frequency", "storage", "loss"):
        values[quantity] = values[quantity] * factors[quantity]
    values["temperature"] = values["temperature"] + factors["temperature"]
    if by_tan:
        values["loss"] = values["loss"] * values["storage"]
    letters = {columns[q].letter for q in ("storage", "loss")} - {""}
    if len(letters) > 1:
        raise ValueError(
            f"{path}, line {header_line}: storage is {columns['storage'].title!r}, loss "
            f"{columns['loss'].title!r}: "
            "must be both in shear (G) or both in tension (E)"
        )
    mode: Literal["shear", "tension"] | None = None
    if letters:
        mode = "shear" if letters == {"G"} else "tension"
    return Table(values, tuple(numbers), header_line, mode)
