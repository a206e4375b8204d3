"""Tables of an instrument: their numbers checked and brought to SI units, a block at a time."""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from bearingdyn.material.dma import Mode
from bearingdyn.material.reading.block import Block, cell_at, find_blocks
from bearingdyn.material.reading.columns import LABELS, RELAXATION, is_number, names_shear, number_of
from bearingdyn.material.reading.errors import HeaderError, NoStepError, ReadingError, together
from bearingdyn.material.reading.request import Request
from bearingdyn.material.reading.source import Row, Source
from bearingdyn.notice import AssumedMeaning, LeftOut, warn
from bearingdyn.types import Array

_MISSING = ("", "-", "--", "---", "nan", "n/a", "na", "null", "none", "#n/a")
_TEMPERATURE_LINE = re.compile(
    r"(?:temperatur(?:e|en)?\b[^\d\n]{0,20}?|\bT(?:_?ref)?\s*[=:]\s*|\bat\s+|\bbei\s+|@\s*)"
    r"([-−]?\d+(?:[.,]\d+)?)\s*(°\s*C|º\s*C|deg\s?C|C|K)\b",
    re.IGNORECASE,
)
_IN_NAME = re.compile(
    r"(?P<before>.?)(?P<sign>[-−+]|(?<![a-z])m(?:inus)?)?(?P<number>\d+(?:[.,]\d+)?)[ _]?"
    r"(?:°\s*C|º\s*C|deg[ _]?C?|grad|C)(?![a-z])",
    re.IGNORECASE,
)
_T_IN_NAME = re.compile(
    r"(?:^|[^a-zA-Z])T(?P<before>[_= ]?)(?P<sign>[-−+m])?(?P<number>\d+(?:[.,]\d+)?)(?!\d)"
)
_SECTION = re.compile(
    r"^\[[^\]]*\]$|^(step name|number of points|result|interval|project|test)\b", re.IGNORECASE
)
_LONG_LINE = 400  # characters of a line in which a temperature is sought
_REPEATS, _STEADY = 3, 0.5  # points in a row; K
_SHOWN = 8  # names of steps shown
NO_LETTER = "the header does not tell G (shear) from E (tension): give mode='shear' or mode='tension'"


@dataclass(frozen=True)
class Table:
    """A table as read: what stands in a source, by column, Hz, °C and Pa, (n,) each.

    Attributes
    ----------
    isotherm
        Nominal temperature or number of each point's isotherm; None if there is no such column.
    run
        Name of the run of each point; None if there is no such column.
    steps
        Name of the instrument's step each point comes from, (n,).
    strain
        Amplitude of the strain; NaN where there is no such column, (n,).
    relaxing
        Whether `frequency` holds times, s, and `storage` the relaxation modulus.
    lines
        Number of the row each point stands on, (n,).
    header
        File and line of the first header, for messages.
    mode
        "shear" or "tension" by the letters of the header; None if it has none.
    speaks_of_shear
        Whether the text down to the first header names what only a measurement in shear has.
    notes
        What was assumed in reading.
    """

    source: Source
    frequency: Array
    temperature: Array
    storage: Array
    loss: Array
    isotherm: Array | None
    run: tuple[str, ...] | None
    steps: tuple[str, ...]
    strain: Array
    relaxing: bool
    lines: tuple[int, ...]
    header: str
    mode: Mode | None
    speaks_of_shear: bool
    notes: tuple[str, ...]

    def asked_mode(self, mode: Mode | None) -> Mode | None:
        """Shear or tension as asked for, or as the header says; ReadingError where these differ."""
        if mode is not None and self.mode not in (None, mode):
            raise ReadingError(
                f"{self.header}: the header says {self.mode}, mode is {mode!r}; give the right mode, or "
                "name the right columns"
            )
        return mode or self.mode

    def at(self, point: int) -> str:
        """File and line of a point, for a message."""
        return self.source.at(self.lines[point])


@dataclass(frozen=True)
class _Point:
    """One row of numbers, Hz, °C and Pa."""

    line: int
    frequency: float
    temperature: float
    storage: float
    loss: float
    isotherm: float | None
    run: str
    step: str
    strain: float


class _LeftOutError(Exception):
    """A point is left out; the text says why."""


class TableReader:
    """Reads every table of a source, one below the other, as one table. A reader is used once.

    Parameters
    ----------
    source
        Numbered rows of cells.
    request
        What the caller says about the table.

    Raises
    ------
    ReadingError
        If two columns look alike, or the header names both shear and tension.
    HeaderError
        If there is no header.
    """

    def __init__(self, source: Source, request: Request) -> None:
        self.source, self.request = source, request
        found = find_blocks(source, request)
        self.steps = tuple(block.step for block in found)
        self.blocks = [b for k, b in enumerate(found, 1) if request.wants(k, f"{source.sheet} {b.step}")]
        if not self.blocks:
            raise NoStepError(
                f"{found[0].where}: step is {request.step!r}; there are {self._offered()}, by name or number",
                "step",
            )
        self.relaxing = self.blocks[0].quantities == RELAXATION
        if any((block.quantities == RELAXATION) != self.relaxing for block in self.blocks):
            raise ReadingError(
                f"{source.at(self.blocks[1].header.number)}: a sweep of frequencies and a relaxation in one "
                f"file: choose by step=..., there are {self._offered()}",
                "step",
            )
        self.mode = self._mode()
        self.speaks_of_shear = names_shear(
            " ".join(row.text for row in source.rows if row.number <= self.blocks[0].header.number)
        )
        self.notes: list[str] = []
        self.temperature = self._stated_temperature() if request.temperature is None else request.temperature
        self.points: list[_Point] = []
        self.left_out: list[str] = []
        self.after: list[Row] = []

    def read(self) -> Table:
        """The points of all blocks.

        Raises
        ------
        ReadingError
            Naming file, line, column, value and remedy.
        HeaderError
            If no column is recognised as the temperature, and none is given.
        """
        for block in self.blocks:
            self._read_block(block)
        self._warn()
        self._require_points()
        labels = [p.isotherm for p in self.points if p.isotherm is not None]
        return Table(
            self.source,
            frequency=np.array([p.frequency for p in self.points]),
            temperature=np.array([p.temperature for p in self.points]),
            storage=np.array([p.storage for p in self.points]),
            loss=np.array([p.loss for p in self.points]),
            isotherm=np.array(labels) if len(labels) == len(self.points) else None,
            run=tuple(p.run for p in self.points) if any(p.run for p in self.points) else None,
            steps=tuple(p.step for p in self.points),
            strain=np.array([p.strain for p in self.points]),
            relaxing=self.relaxing,
            lines=tuple(p.line for p in self.points),
            header=self.blocks[0].where,
            mode=self.mode,
            speaks_of_shear=self.speaks_of_shear,
            notes=tuple(dict.fromkeys(self.notes)),
        )

    def _mode(self) -> Mode | None:
        """Shear or tension by the letters of the moduli."""
        used = [(block, block.columns[q]) for block in self.blocks for q in block.quantities[1:]]
        told = [(block, column) for block, column in used if column.letter]
        for (_, a), (block, b) in pairwise(told):
            if a.letter != b.letter:
                raise ReadingError(
                    f"{block.where}: storage is {a.title!r}, loss {b.title!r}: must be both in shear (G) "
                    "or both in tension (E)"
                )
        if not told:
            return None
        return "shear" if told[0][1].letter == "G" else "tension"

    def _stated_temperature(self) -> float | None:
        """A temperature stated above a table without such a column, °C."""
        first = self.blocks[0]
        if len(self.blocks) > 1 or "temperature" in first.columns:
            return None
        stated = []
        for row in self.source.above(first.header.number):
            for match in _TEMPERATURE_LINE.finditer(row.text[:_LONG_LINE]):
                value = number_of(match.group(1))
                stated.append(value - 273.15 if match.group(2).upper() == "K" else value)
                if row.text.strip().lower().startswith("temperature"):
                    return stated[-1]
        if stated and min(stated) == max(stated):
            return stated[0]
        return self._named_temperature() if not stated else None

    def _named_temperature(self) -> float | None:
        """A temperature in the file's name, °C, with a warning; none if its sign may be a hyphen."""
        name = self.source.stem
        matches = [m for pattern in (_IN_NAME, _T_IN_NAME) for m in pattern.finditer(name)]
        if len(matches) != 1:
            return None
        sign, before = matches[0].group("sign"), matches[0].group("before")
        if sign in ("-", "−") and before and before not in " _(=[":
            return None
        value = number_of(matches[0].group("number")) * (-1 if sign and sign != "+" else 1)
        warn(
            f"{self.source.name}: no temperature in the table: {value:g} °C is taken from the file's name; "
            "temperature=... says otherwise",
            AssumedMeaning,
        )
        self.notes.append(f"{self.source.name}: temperature {value:g} °C from the file's name")
        return value

    def _factors(self, block: Block) -> Mapping[str, float]:
        """Factors to SI of the columns to be read; every fault of the header is told at once."""
        faults: list[ReadingError] = []
        quantities = list(block.quantities)
        if "temperature" in block.columns:
            quantities.append("temperature")
        elif self.temperature is None:
            faults.append(
                HeaderError(
                    f"{block.where}: no column recognised as temperature: give "
                    "temperature=..., °C, if the sweep is one isotherm, or columns={'temperature': ...}",
                    "temperature",
                    "columns",
                )
            )
        units = block.units(quantities, self.request.units)
        faults += units.faults
        if faults and self.mode is None and self.request.mode is None and not self.speaks_of_shear:
            faults.append(ReadingError(NO_LETTER, "mode"))
        if faults:
            raise together(block.where, faults)
        self.notes += units.assumed
        if units.frequency_read is not None:
            where, unit = units.frequency_read
            note = f"frequency read in {unit}"
            if not any(said.endswith(note) for said in self.notes):
                self.notes.append(f"{where}: {note}")
        return units.factors

    def _read_block(self, block: Block) -> None:
        """The points of a block, down to its end or to a text that ends the table."""
        factors = self._factors(block)
        quantities = [*factors, *(q for q in LABELS if q in block.columns)]
        before = len(self.points)
        for position, row in enumerate(block.numbers):
            cells = block.cells(row)
            texts = {q: cell_at(cells, block.columns[q].index) for q in quantities}
            if not any(is_number(texts[q]) for q in block.quantities):
                if not any(cell.strip() for cell in cells):
                    continue
                if len(cells) < 2 or any(text.lower() not in _MISSING for text in texts.values()):
                    if position == 0:
                        quantity = next(q for q, text in texts.items() if not is_number(text))
                        raise _no_number(self._place(block, row, quantity), texts[quantity])
                    if not _ends_section(row):
                        self.after += [r for r in block.numbers[position:] if not _ends_section(r)]
                    break
            try:
                self.points.append(self._point(block, row, texts, factors))
            except _LeftOutError as reason:
                self.left_out.append(str(reason))
        if not self.relaxing:
            self._refuse_amplitudes(block, self.points[before:])

    def _refuse_amplitudes(self, block: Block, points: Sequence[_Point]) -> None:
        """ReadingError for a step that stays at one frequency while something else changes."""
        for k in range(len(points) - _REPEATS + 1):
            first, *rest = points[k : k + _REPEATS]
            if all(math.isclose(p.frequency, first.frequency, rel_tol=1e-3) for p in rest) and all(
                abs(p.temperature - first.temperature) <= _STEADY for p in rest
            ):
                several = len(self.steps) > 1
                remedy = f"choose by step=..., there are {self._offered()}" if several else "leave it out"
                raise ReadingError(
                    f"{self.source.at(first.line)} to {rest[-1].line}: {_REPEATS} points in a row at "
                    f"{first.frequency:g} Hz and {first.temperature:.4g} °C in {block.step!r}: a sweep of "
                    f"amplitude or time, not of frequency; {remedy}",
                    *(["step"] if several else []),
                )

    def _offered(self) -> str:
        return ", ".join(f"{k} {name!r}" for k, name in enumerate(self.steps[:_SHOWN], 1)) + (
            f" and {len(self.steps) - _SHOWN} more" if len(self.steps) > _SHOWN else ""
        )

    def _place(self, block: Block, row: Row, quantity: str) -> str:
        return f"{self.source.at(row.number)}, column {block.columns[quantity].title!r}"

    def _point(
        self, block: Block, row: Row, texts: Mapping[str, str], factors: Mapping[str, float]
    ) -> _Point:
        """The point a row holds; raises _LeftOutError if it is left out."""
        SI: dict[str, float] = {}
        for quantity, text in texts.items():
            if quantity == "run":
                continue
            value = self._value(self._place(block, row, quantity), quantity, text)
            factor = factors.get(quantity, 1.0)
            SI[quantity] = value + factor if quantity == "temperature" else value * factor
        frequency, first, second = (*block.quantities, "")[:3]
        storage, loss = _modulus(first, second, SI[first], SI.get(second, 0.0))
        if not (math.isfinite(storage) and math.isfinite(loss)):
            raise ReadingError(
                f"{self.source.at(row.number)}: {first} = {SI[first]:g} and {second} = "
                f"{SI.get(second, 0.0):g}: make no finite modulus"
            )
        temperature = SI.get("temperature", self.temperature)
        assert temperature is not None  # _factors has refused the block otherwise
        return _Point(
            row.number,
            SI[frequency],
            temperature,
            storage,
            loss,
            SI.get("isotherm"),
            texts.get("run", ""),
            block.step,
            self._strain(block, row),
        )

    def _strain(self, block: Block, row: Row) -> float:
        """The amplitude a row states, in whatever unit: only its changes count."""
        column = block.columns.get("strain")
        text = "" if column is None else cell_at(block.cells(row), column.index)
        return number_of(text) if is_number(text) else math.nan

    def _value(self, where: str, quantity: str, text: str) -> float:
        """The number in a cell; raises _LeftOutError if its point is left out."""
        missing = text.lower() in _MISSING
        if not missing and not is_number(text):
            raise _no_number(where, text)
        value = math.nan if missing else number_of(text)
        if not math.isfinite(value):
            raise _LeftOutError(f"{where}: {text or 'empty'} for the {quantity}: must be finite")
        if value > 0 or quantity in ("temperature", "isotherm", "phase"):
            return value
        if quantity == "time" and value == 0:
            raise _LeftOutError(f"{where}: {text} for the time: the moment of the step itself")
        if quantity in ("frequency", "angular", *RELAXATION):
            what = "frequency" if quantity == "angular" else quantity
            reason = f"{where}: {text} for the {what}: must be positive and finite"
            if not self.request.drop_invalid:
                raise ReadingError(f"{reason}; drop_invalid=True leaves such points out", "drop_invalid")
            raise _LeftOutError(reason)
        if self.request.drop_invalid:
            raise _LeftOutError(f"{where}: {text} for the {quantity}: must be positive")
        return value

    def _warn(self) -> None:
        """Say what was left out, and how much of it."""
        if self.left_out:
            total = len(self.left_out) + len(self.points)
            warn(f"{len(self.left_out)} of {total} points left out: first {self.left_out[0]}", LeftOut)
        if self.after:
            row = self.after[0]
            numbers = sum(any(map(is_number, r.text.split())) for r in self.after)
            warn(
                f"{self.source.at(row.number)}: {len(self.after)} lines after the table left out, {numbers} "
                f"of them with numbers: first {row.text.strip()[:60]!r}",
                LeftOut,
            )

    def _require_points(self) -> None:
        """ReadingError unless there is a point, and one of positive moduli."""
        block = self.blocks[0]
        if not self.points:
            if self.left_out:
                raise ReadingError(f"{self.left_out[0]}; no valid point is left")
            raise ReadingError(f"{block.where}: the table is empty: no rows of numbers follow the header")
        if not self.relaxing and not any(p.storage > 0 and p.loss > 0 for p in self.points):
            point = self.points[0]
            bad = "loss" if point.storage > 0 else "storage"
            column = block.columns.get(bad)
            title = f", column {column.title!r}" if column else ""
            raise ReadingError(
                f"{self.source.at(point.line)}{title}: {getattr(point, bad):g} for the {bad}: must be "
                "positive and finite, and is so at no point"
            )


def read_table(sources: Iterable[Source], request: Request) -> Table:
    """Table of the first sheet that has one, read; if none has, the error of the last."""
    sheets = list(sources)
    last: ReadingError | None = None
    for k, source in enumerate(sheets):
        try:
            table = TableReader(source, request).read()
        except HeaderError as error:
            last = error
            continue
        _tell_of_others(sheets[k + 1 :], request)
        return table
    assert last is not None  # there is a sheet
    raise last


def _tell_of_others(sheets: Sequence[Source], request: Request) -> None:
    """Warn of further sheets that hold tables and are not read."""
    names = []
    for sheet in sheets:
        try:
            TableReader(sheet, request)
        except ReadingError:
            continue
        names.append(sheet.sheet)
    if names:
        warn(
            f"{sheets[0].name}: the first sheet with a table is read, not {', '.join(map(repr, names))}: "
            "step='...' names another",
            AssumedMeaning,
        )


def _no_number(where: str, text: str) -> ReadingError:
    return ReadingError(f"{where}: {text!r} is not a number: must be a decimal number such as 1.25e6")


def _ends_section(row: Row) -> bool:
    """Whether a row opens or describes a new step of the instrument, which belongs to no table."""
    return bool(_SECTION.match(row.text.strip()))


def _modulus(first: str, second: str, a: float, b: float) -> tuple[float, float]:
    """Storage and loss modulus of a pair of quantities."""
    if second in ("loss", ""):
        return a, b
    if first == "storage":
        return a, a * (b if second == "tan_delta" else math.tan(b))
    angle = math.atan(b) if second == "tan_delta" else b
    return a * math.cos(angle), a * math.sin(angle)
