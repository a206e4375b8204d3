"""Tables of an instrument: found among the rows of a file, their numbers checked and brought to SI units."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Literal

import numpy as np

from bearingdyn.material.block import Block, aligned, cell_at, factors_of, units_row
from bearingdyn.material.columns import (
    UNITS,
    Column,
    choose,
    columns_of,
    is_number,
    names_shear,
    number_of,
    quantity_of,
    title_of,
)
from bearingdyn.material.source import Row, Source, Splitter
from bearingdyn.notice import warn
from bearingdyn.types import Array

_MISSING = ("", "-", "--", "---", "nan", "n/a", "na", "null", "none", "#n/a")
_TEMPERATURE_LINE = re.compile(
    r"^\s*temperature\s*[:;,\t]?\s*(-?\d+(?:[.,]\d+)?)\s*(°C|ºC|C|K)\b", re.IGNORECASE
)
NO_LETTER = "the header does not tell G (shear) from E (tension): give mode='shear' or mode='tension'"
KNOWN = (*UNITS, "isotherm")


@dataclass(frozen=True)
class Table:
    """Columns by quantity, Hz, °C and Pa, the rows they stand on, and what was assumed."""

    values: dict[str, Array]
    lines: tuple[int, ...]
    header_line: int
    mode: Literal["shear", "tension"] | None
    shear_named: bool
    notes: tuple[str, ...]


def read_table(
    source: Source,
    wanted: Mapping[str, str],
    units: Mapping[str, str],
    drop_invalid: bool,
    temperature: float | None,
    letters: bool = False,
) -> Table:
    """Every table of a source, one below the other, as one.

    Parameters
    ----------
    wanted, units
        Column names and units by quantity, that go before what the source says.
    drop_invalid
        Leave out, with a warning, points whose frequency or moduli are not positive too.
    temperature
        Of all points, °C, where the table has no such column.
    letters
        The header has to tell shear from tension; said only along with another fault.

    Raises
    ------
    ValueError
        Naming file, line, column, value and remedy.
    """
    for mapping, name in ((wanted, "columns"), (units, "units")):
        unknown = set(mapping) - set(KNOWN)
        if unknown:
            raise ValueError(f"{name}: unknown quantities {sorted(unknown)}: known are {list(KNOWN)}")
    blocks = _blocks(source, wanted, units)
    if temperature is None:
        temperature = _stated_temperature(source, blocks)
    kept: list[dict[str, float]] = []
    numbers: list[int] = []
    tally = _Tally(source)
    notes: list[str] = []
    silent = letters and _mode(source, blocks) is None and not _speaks_of_shear(source, blocks)
    more = [NO_LETTER] if silent else []
    for block in blocks:
        _read_block(source, block, units, drop_invalid, temperature, kept, numbers, tally, notes, more)
    tally.warn(len(kept))
    if not kept:
        first = blocks[0].header.number
        why = tally.first or f"{source.at(first)}: the table is empty: no rows of numbers follow the header"
        raise ValueError(f"{why}; no valid point is left" if tally.first else why)
    if not any(k["storage"] > 0 and k["loss"] > 0 for k in kept):
        bad = "storage" if not kept[0]["storage"] > 0 else "loss"
        column = blocks[0].columns.get(bad)
        title = f", column {column.title!r}" if column else ""
        raise ValueError(
            f"{source.at(numbers[0])}{title}: {kept[0][bad]:g} for the {bad}: must be positive and finite, "
            "and is so at no point"
        )
    common = set.intersection(*(set(k) for k in kept))
    values = {q: np.array([k[q] for k in kept]) for q in ("frequency", "temperature", "storage", "loss")}
    if "isotherm" in common:
        values["isotherm"] = np.array([k["isotherm"] for k in kept])
    return Table(
        values,
        tuple(numbers),
        blocks[0].header.number,
        _mode(source, blocks),
        _speaks_of_shear(source, blocks),
        tuple(dict.fromkeys(notes)),
    )


def _speaks_of_shear(source: Source, blocks: list[Block]) -> bool:
    """Whether what stands down to the first header speaks of shear."""
    return names_shear(" ".join(row.text for row in source.rows if row.number <= blocks[0].header.number))


class _Tally:
    """Rows left out, by reason, for one warning."""

    def __init__(self, source: Source) -> None:
        self.source, self.first, self.count = source, "", 0
        self.after: list[Row] = []

    def drop(self, reason: str) -> None:
        self.first = self.first or reason
        self.count += 1

    def warn(self, kept: int) -> None:
        if self.count:
            warn(
                f"{self.count} of {self.count + kept} points left out: first {self.first}",
            )
        if self.after:
            row = self.after[0]
            numbers = sum(any(is_number(c) for c in r.text.split()) for r in self.after)
            warn(
                f"{self.source.at(row.number)}: {len(self.after)} lines after the table left out, "
                f"{numbers} of "
                f"them with numbers: first {row.text.strip()[:60]!r}",
            )


def _blocks(source: Source, wanted: Mapping[str, str], units: Mapping[str, str]) -> list[Block]:
    """Headers and what stands below them."""
    heads: list[tuple[int, dict[str, Column], Splitter, tuple[str, str, str], bool]] = []
    best: tuple[int, dict[str, Column], Splitter] = (0, {}, Splitter.of(source.rows[0].text))
    for position, row in enumerate(source.rows):
        splitter = Splitter.of(row.text)
        cells = splitter.cells(row)
        columns, doubles = columns_of(cells, wanted)
        chosen = choose(columns)
        if chosen is None:
            if len(columns) > len(best[1]):
                best = (position, columns, splitter)
            continue
        for quantity, first, second in doubles:
            if quantity in (*chosen, "temperature"):
                raise ValueError(
                    f"{source.at(row.number)}: columns {first!r} and {second!r} both look like the "
                    f"{quantity}: "
                    f"choose by columns={{{quantity!r}: ...}}"
                )
        label = bool(cells) and cells[0].strip().endswith(":") and quantity_of(title_of(cells[0])[0]) is None
        heads.append((position, columns, splitter, chosen, label))
    if not heads:
        position, columns, splitter = best
        has = columns.keys() | ({"frequency"} if "angular" in columns else set())
        missing = [q for q in ("frequency", "temperature", "storage", "loss") if q not in has]
        known = tuple(q for q in columns if q != "isotherm")
        block = Block(source.rows[position], source.rows[position + 1 :], splitter, columns, known, False)
        faults = factors_of(source, block, known, units, [])[1]
        where = source.at(block.header.number)
        none = (
            f"{where}: no column recognised as {', '.join(missing)}: the header must name "
            "frequency, temperature, storage modulus and loss modulus (or tan delta, or |G*| and phase), or "
            "give columns={...} with the names used"
        )
        raise ValueError(_together(where, [none, *faults]))
    ends = [h[0] for h in heads[1:]] + [len(source.rows)]
    return [
        Block(source.rows[p], source.rows[p + 1 : end], splitter, columns, chosen, label)
        for (p, columns, splitter, chosen, label), end in zip(heads, ends, strict=True)
    ]


def _read_block(
    source: Source,
    block: Block,
    units: Mapping[str, str],
    drop_invalid: bool,
    temperature: float | None,
    kept: list[dict[str, float]],
    numbers: list[int],
    tally: _Tally,
    notes: list[str],
    more: list[str],
) -> None:
    wanted = list(block.quantities)
    faults: list[str] = []
    if "temperature" in block.columns:
        wanted.append("temperature")
    elif temperature is None:
        faults.append(
            f"{source.at(block.header.number)}: no column recognised as temperature: give "
            "temperature=..., °C, if the sweep is one isotherm, or columns={'temperature': ...}"
        )
    factors, wrong = factors_of(source, block, wanted, units, notes)
    faults += wrong
    if faults:
        raise ValueError(_together(source.at(block.header.number), [*faults, *more]))
    if "isotherm" in block.columns:
        wanted.append("isotherm")  # has no unit
    rows = units_row(block)[0]
    for position, row in enumerate(rows):
        cells = aligned(block, row)
        texts = {q: cell_at(cells, block.columns[q].index) for q in wanted}
        if not any(is_number(texts[q]) for q in (*block.quantities,)):
            empty = all(not t for t in texts.values()) and not any(c.strip() for c in cells)
            if empty:
                continue
            if any(t.lower() not in _MISSING for t in texts.values()) or len(cells) < 2:
                if position == 0:
                    q, text = next((q, t) for q, t in texts.items() if not is_number(t))
                    raise ValueError(
                        f"{source.at(row.number)}, column {block.columns[q].title!r}: {text!r} is not a "
                        "number: "
                        "must be a decimal number such as 1.25e6"
                    )
                if not _ends_section(row):
                    tally.after.extend(r for r in rows[position:] if not _ends_section(r))
                return
        point = _point(source, block, row, texts, drop_invalid, tally, factors)
        if point is None:
            continue
        if "temperature" not in point:
            assert temperature is not None  # checked above
            point["temperature"] = temperature
        kept.append(point)
        numbers.append(row.number)


def _together(where: str, faults: Sequence[str]) -> str:
    """All faults as one message, their place said once."""
    return "; ".join([faults[0], *(f.removeprefix(f"{where}, ") for f in faults[1:])])


def _ends_section(row: Row) -> bool:
    """Whether a row opens or describes a new step of the instrument, which belongs to no table."""
    text = row.text.strip()
    return bool(
        re.match(r"^\[[^\]]*\]$|^(step name|number of points|result|interval|project|test)\b", text, re.I)
    )


def _point(
    source: Source,
    block: Block,
    row: Row,
    texts: Mapping[str, str],
    drop_invalid: bool,
    tally: _Tally,
    factors: Mapping[str, float],
) -> dict[str, float] | None:
    """Frequency, moduli and temperature of a row, None if it is left out."""
    raw: dict[str, float] = {}
    for quantity, text in texts.items():
        where = f"{source.at(row.number)}, column {block.columns[quantity].title!r}"
        missing = text.lower() in _MISSING
        if not missing and not is_number(text):
            raise ValueError(f"{where}: {text!r} is not a number: must be a decimal number such as 1.25e6")
        value = math.nan if missing else number_of(text)
        if not math.isfinite(value):
            tally.drop(f"{where}: {text or 'empty'} for the {quantity}: must be finite")
            return None
        if quantity in ("frequency", "angular") and not value > 0:
            reason = f"{where}: {text} for the frequency: must be positive and finite"
            if not drop_invalid:
                raise ValueError(f"{reason}; drop_invalid=True leaves such points out")
            tally.drop(reason)
            return None
        raw[quantity] = (
            value * factors.get(quantity, 1.0) if quantity != "temperature" else value + factors[quantity]
        )
        if drop_invalid and quantity in ("storage", "loss", "complex", "tan_delta") and not value > 0:
            tally.drop(f"{where}: {text} for the {quantity}: must be positive")
            return None
    first, second = block.quantities[1:]
    storage, loss = _modulus(first, second, raw[first], raw[second])
    if not (math.isfinite(storage) and math.isfinite(loss)):
        raise ValueError(
            f"{source.at(row.number)}: {first} = {raw[first]:g} and {second} = {raw[second]:g}: make no "
            "finite modulus"
        )
    point = {"frequency": raw[block.quantities[0]], "storage": storage, "loss": loss}
    return point | {q: raw[q] for q in ("temperature", "isotherm") if q in raw}


def _modulus(first: str, second: str, a: float, b: float) -> tuple[float, float]:
    """Storage and loss modulus of a pair of quantities."""
    if second == "loss":
        return a, b
    if first == "storage":
        return a, a * (b if second == "tan_delta" else math.tan(b))
    angle = math.atan(b) if second == "tan_delta" else b
    return a * math.cos(angle), a * math.sin(angle)


def _stated_temperature(source: Source, blocks: list[Block]) -> float | None:
    """A temperature stated above a table without such a column."""
    if len(blocks) > 1 or "temperature" in blocks[0].columns:
        return None
    for row in source.rows:
        match = _TEMPERATURE_LINE.match(row.text)
        if match and row.number < blocks[0].header.number:
            value = float(match.group(1).replace(",", "."))
            return value - 273.15 if match.group(2).upper() == "K" else value
    return None


def _mode(source: Source, blocks: list[Block]) -> Literal["shear", "tension"] | None:
    used = [(b.header.number, b.columns[q]) for b in blocks for q in b.quantities[1:]]
    letters = {column.letter for _, column in used} - {""}
    if len(letters) > 1:
        (_, a), (number, b) = next(
            (x, y) for x, y in pairwise([u for u in used if u[1].letter]) if x[1].letter != y[1].letter
        )
        raise ValueError(
            f"{source.at(number)}: storage is {a.title!r}, loss {b.title!r}: must be both in shear (G) "
            "or both "
            "in tension (E)"
        )
    if not letters:
        return None
    return "shear" if letters == {"G"} else "tension"
