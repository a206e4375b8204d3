"""Headers found among the rows of a source, each with the rows below it: a block."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

from bearingdyn.material.reading.columns import (
    LONGEST_TITLE,
    UNIT_WORDS,
    UNITS,
    Column,
    choose,
    columns_of,
    is_number,
    quantity_of,
    title_of,
)
from bearingdyn.material.reading.errors import HeaderError, ReadingError, together
from bearingdyn.material.reading.request import Request
from bearingdyn.material.reading.source import Row, Source, Splitter
from bearingdyn.material.reading.units import ColumnUnits

_UNIT_WORDS = UNIT_WORDS | {"s", "h", "k", "c", "min"}
_STEP_NAME = re.compile(r"^step name\s*[:;,\t]?\s*(.+)$", re.IGNORECASE)
_STEP_HEAD = re.compile(r"^\[(.+)\]$")


@dataclass(frozen=True)
class Block:
    """A block: one header, the rows below it down to the next, and its columns.

    Attributes
    ----------
    columns
        Recognised columns by quantity.
    quantities
        Those a complex modulus is made of: a frequency and two others.
    labelled
        Whether a label stands in front of the header that has none in front of the numbers.
    step
        Name of the instrument's step, or "table 2" where it has none.
    """

    source: Source
    header: Row
    rows: tuple[Row, ...]
    splitter: Splitter
    columns: Mapping[str, Column]
    quantities: tuple[str, ...]
    labelled: bool = False
    step: str = ""

    @property
    def where(self) -> str:
        """File and line of the header, for a message."""
        return self.source.at(self.header.number)

    def cells(self, row: Row) -> list[str]:
        """Cells of a row, under those of the header."""
        cells = self.splitter.cells(row)
        return ["", *cells] if self.labelled and cells and is_number(cells[0]) else cells

    @cached_property
    def unit_row(self) -> Row | None:
        """The row of units between the header and the numbers, if there is one."""
        if not self.rows:
            return None
        cells = self.cells(self.rows[0])
        here = {cell_at(cells, c.index).strip("[]() ").lower() for c in self.columns.values()}
        return None if any(map(is_number, cells)) or not here & _UNIT_WORDS else self.rows[0]

    @property
    def numbers(self) -> tuple[Row, ...]:
        """The rows below the header and its units."""
        return self.rows if self.unit_row is None else self.rows[1:]

    def units(self, quantities: Sequence[str], given: Mapping[str, str]) -> ColumnUnits:
        """Units of these columns, read from the header, the row below it, or `given` by quantity."""
        below = [] if self.unit_row is None else self.cells(self.unit_row)
        first = self.cells(self.numbers[0]) if self.numbers else []
        units = ColumnUnits(given)
        for quantity in quantities:
            column = self.columns[quantity]
            where, cell = self.where, cell_at(below, column.index)
            if self.unit_row is not None and cell and not column.unit:
                where, column = self.source.at(self.unit_row.number), replace(column, unit=cell)
            units.read(quantity, column, where, cell_at(first, column.index))
        return units


def cell_at(cells: Sequence[str], index: int) -> str:
    """A cell of a block's row, empty where the row is too short."""
    return cells[index].strip() if index < len(cells) else ""


def find_blocks(source: Source, request: Request) -> list[Block]:
    """The blocks of a source, headers with the rows below them, from top to bottom.

    Raises
    ------
    HeaderError
        If no row is a header; the message says what the best candidate lacks.
    ReadingError
        If two columns of a header look like the same quantity.
    """
    heads: list[tuple[int, Block]] = []
    best: tuple[int, Splitter, dict[str, Column]] = (0, Splitter.of(source.rows[0].text), {})
    for position, row in enumerate(source.rows):
        splitter = Splitter.of(row.text)
        cells = splitter.cells(row)
        columns, doubles = columns_of(cells, request.columns)
        chosen = choose(columns)
        if chosen is None:
            if len(columns) > len(best[2]):
                best = (position, splitter, columns)
            continue
        for quantity, first, second in doubles:
            if quantity in (*chosen, "temperature", *request.columns):
                same = first.title == second.title
                choice = f"{first.index + 1} or {second.index + 1}, its number" if same else "..."
                raise ReadingError(
                    f"{source.at(row.number)}: columns {first.title!r} and {second.title!r} both look like "
                    f"the {quantity}: choose by columns={{{quantity!r}: {choice}}}",
                    "columns",
                )
        title = cells[0].strip()[-LONGEST_TITLE:] if cells else ""
        label = title.endswith(":") and quantity_of(title_of(title)[0]) is None
        heads.append((position, Block(source, row, (), splitter, columns, chosen, label)))
    if not heads:
        raise _no_header(source, request, *best)
    ends = [position for position, _ in heads[1:]] + [len(source.rows)]
    starts = [0, *(position + 1 for position, _ in heads[:-1])]
    return [
        replace(block, rows=source.rows[position + 1 : end], step=_step_name(source.rows[start:position], k))
        for k, ((position, block), start, end) in enumerate(zip(heads, starts, ends, strict=True), 1)
    ]


def _step_name(above: Sequence[Row], number: int) -> str:
    """Name of the step whose header the rows lead to; those of the table before it are among them."""
    for k in range(len(above) - 1, -1, -1):
        text = above[k].text.strip()
        if is_number(text.split()[-1]) and is_number(text.split()[0]):
            break  # the numbers of the table before
        named, head = _STEP_NAME.match(text), _STEP_HEAD.match(text)
        if named:
            return named.group(1).strip()
        if head and head.group(1).strip().lower() == "step" and k + 1 < len(above):
            return above[k + 1].text.strip()[:60]
        if head:
            return head.group(1).strip()
    return f"table {number}"


def _no_header(
    source: Source, request: Request, position: int, splitter: Splitter, columns: dict[str, Column]
) -> ReadingError:
    """What the row that resembles a header best lacks, and what is wrong with its units."""
    has = columns.keys() | ({"frequency"} if "angular" in columns else set())
    missing = [q for q in ("frequency", "temperature", "storage", "loss") if q not in has]
    known = tuple(q for q in columns if q in UNITS and q != "strain")
    block = Block(source, source.rows[position], source.rows[position + 1 :], splitter, columns, known)
    none = HeaderError(
        f"{block.where}: no column recognised as {', '.join(missing)}: the header must name "
        "frequency, temperature, storage modulus and loss modulus (or tan delta, or |G*| and phase), or "
        "give columns={...} with the names used",
        "columns",
    )
    return together(block.where, [none, *block.units(known, request.units).faults])
