"""One table within a file: its header, the rows below it, and the units of its columns."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from bearingdyn.material.columns import UNITS, Column, factor, is_number, number_of
from bearingdyn.material.source import Row, Source, Splitter
from bearingdyn.notice import warn

_HOT = 150.0  # °C; temperatures above it, without a unit, may be in K


@dataclass(frozen=True)
class Block:
    """One header, the rows below it down to the next, and its columns."""

    header: Row
    rows: tuple[Row, ...]
    splitter: Splitter
    columns: dict[str, Column]
    quantities: tuple[str, ...]
    labelled: bool


def units_row(block: Block) -> tuple[tuple[Row, ...], list[str], int]:
    """Rows of numbers; cells and line of a row of units above them, if there is one."""
    if block.rows:
        cells = aligned(block, block.rows[0])
        if not any(is_number(cell) for cell in cells):
            known = {u for table in UNITS.values() for u in table} - {""}
            here = [cell_at(cells, c.index).strip("[]() ").lower() for c in block.columns.values()]
            if any(unit in known for unit in here):
                return block.rows[1:], cells, block.rows[0].number
    return block.rows, [], 0


def aligned(block: Block, row: Row) -> list[str]:
    """Cells of a row; a label in front of the header has none in front of the numbers."""
    cells = block.splitter.cells(row)
    if block.labelled and cells and is_number(cells[0]):
        return ["", *cells]
    return cells


def cell_at(cells: list[str], index: int) -> str:
    """A cell, empty where the row is too short."""
    return cells[index].strip() if index < len(cells) else ""


def _unit(
    source: Source,
    block: Block,
    quantity: str,
    units: Mapping[str, str],
    unit_cells: list[str],
    unit_line: int,
    notes: list[str],
) -> float:
    """Factor of a column; what is assumed of a frequency is said."""
    column = block.columns[quantity]
    where, unit = source.at(block.header.number), column.unit
    if unit_cells and not unit and cell_at(unit_cells, column.index):
        where, unit = source.at(unit_line), cell_at(unit_cells, column.index)
    given = units.get(quantity, units.get("frequency") if quantity == "angular" else None)
    if given is None and quantity in ("frequency", "angular"):
        bare = unit.strip().strip("[]()").strip().lower()
        if not bare:
            unit = "Hz" if quantity == "frequency" else "rad/s"
            text = (
                f"{where}, column {column.title!r}: no unit for the {quantity} frequency: taken as {unit}; "
                "units={'frequency': ...} says otherwise"
            ).replace("frequency frequency", "frequency")
            notes.append(text)
            warn(text)
        elif quantity == "angular" and bare != "rad/s" and "ang" in column.title.lower():
            warn(
                f"{where}, column {column.title!r}: an angular frequency in {unit}: taken as {unit}, not "
                "rad/s",
            )
        note = f"frequency read in {unit.strip('[] ')}"
        if not any(n.endswith(note) for n in notes):
            notes.append(f"{where}: {note}")
    if quantity == "temperature" and given is None and not unit.strip(" []()"):
        first = next((cell_at(aligned(block, row), column.index) for row in units_row(block)[0]), "")
        if is_number(first) and number_of(first) <= _HOT:
            unit = "°C"
            text = (
                f"{where}, column {column.title!r}: no unit for the temperature: taken as °C; "
                "units={'temperature': ...} says otherwise"
            )
            notes.append(text)
            warn(text)
    return factor(quantity, unit if given is None else given, column, where)


def factors_of(
    source: Source, block: Block, wanted: Sequence[str], units: Mapping[str, str], notes: list[str]
) -> tuple[dict[str, float], list[str]]:
    """Factors of the columns, and what is wrong with their units."""
    _, unit_cells, unit_line = units_row(block)
    factors: dict[str, float] = {}
    faults = []
    for quantity in wanted:
        try:
            factors[quantity] = _unit(source, block, quantity, units, unit_cells, unit_line, notes)
        except ValueError as error:
            faults.append(str(error))
    return factors, faults
