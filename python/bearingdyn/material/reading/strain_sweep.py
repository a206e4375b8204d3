"""A strain sweep: moduli at one frequency and temperature over the amplitude of strain."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import numpy as np

from bearingdyn.checks import instance, positive, reals, require
from bearingdyn.material.dma import Mode
from bearingdyn.material.reading.block import Block, cell_at
from bearingdyn.material.reading.columns import is_number, number_of, title_of
from bearingdyn.material.reading.errors import ReadingError
from bearingdyn.material.reading.request import Request
from bearingdyn.material.reading.source import Row, read_source, source_of
from bearingdyn.material.reading.table import TableReader
from bearingdyn.notice import AssumedMeaning, warn
from bearingdyn.pictures import page
from bearingdyn.plausible_ranges import plausible
from bearingdyn.short_repr import short
from bearingdyn.types import Array

_LARGEST = 1.0  # strain; dynamic tests stay far below
# of force/(|G| γ) over the specimen's area: instruments round, and a shape factor is up to some 5 %
_AREA_ERROR = 0.1
_AREA_SCATTER = 0.05  # of force/(|G| γ) among the points of one sweep
_STRAIN_TITLE = re.compile(r"strain|dehnung|deformation|^γ$|^ε$|gamma|epsilon", re.IGNORECASE)
_FORCE_TITLE = re.compile(r"force|kraft", re.IGNORECASE)
_PERCENT = re.compile(r"%|\bpct\b|percent|prozent", re.IGNORECASE)
_PEAK_TO_PEAK = re.compile(
    r"\bp-p\b|\bpp\b|pk[- ]?pk|peak[- ]?(to|2)?[- ]?peak|double amplitude|spitze", re.IGNORECASE
)
_FORCE_UNITS = {"n": 1.0, "": 1.0, "mn": 1e-3, "kn": 1e3}


@dataclass(frozen=True, eq=False)
class StrainSweep:
    """A strain sweep: moduli over the amplitude of strain, at one frequency and one temperature.

    Parameters
    ----------
    strain
        Amplitude, zero-to-peak, a fraction (not percent), (n,): shear strain, or elongation in tension.
    storage, loss
        Moduli, Pa, (n,).
    frequency
        Hz.
    temperature
        °C, mean of the sweep; NaN where it is not known.
    mode
        "shear", or "tension" for E′ and E″ over elongation.
    force
        Amplitude of the force, N, (n,), where the instrument gives it.
    source
        Where it comes from, for messages.

    Raises
    ------
    ValueError
        For fewer than three points, lengths that differ, and values that are not positive; for strains above
        1, which are in percent.
    """

    strain: Array
    storage: Array
    loss: Array
    frequency: float
    temperature: float = float("nan")
    mode: Mode = "shear"
    force: Array | None = None
    source: str = "arrays"
    notes: tuple[str, ...] = field(default=(), repr=False)

    __repr__ = short
    _repr_html_ = page

    def __post_init__(self) -> None:
        for name in ("source", "notes"):
            what = str if name == "source" else (tuple, list)
            instance(name, getattr(self, name), what, "it is a text" if name == "source" else "give a list")
        numbers_asked = "it must be real numbers, one for each point"
        n = np.size(self.strain)
        require(n >= 3, f"{self.source}: number of points", n, "a strain sweep needs three or more")
        names = ["strain", "storage", "loss", *([] if self.force is None else ["force"])]
        order = np.argsort(reals(f"{self.source}: strain", self.strain, numbers_asked), kind="stable")
        for name in names:
            values = reals(f"{self.source}: {name}", getattr(self, name), numbers_asked)
            if values.shape != (n,):
                raise ValueError(
                    f"{self.source}: {name} has shape {values.shape}; it must be one-dimensional, with "
                    f"{n} values, as many as strain"
                )
            good = np.isfinite(values) & (values > 0)
            if not good.all():
                i = int(np.argmin(good))
                raise ValueError(
                    f"{self.source}: {name}[{i}] is {values[i]:g}; it must be positive and finite"
                )
            values = values[order]
            values.flags.writeable = False
            object.__setattr__(self, name, values)
        top = float(self.strain[-1])
        require(
            top <= _LARGEST,
            f"{self.source}: the largest strain",
            top,
            f"a strain is a fraction of at most {_LARGEST:g}; was it in percent? Then divide by 100",
        )
        positive(f"{self.source}: frequency", self.frequency, "it must be positive and finite, Hz")
        for limit in (self.storage.min(), self.storage.max()):
            plausible("shear modulus", f"{self.source}: storage", float(limit))
        require(self.mode in ("shear", "tension"), "mode", self.mode, "it must be 'shear' or 'tension'")

    def to_shear(self) -> StrainSweep:
        """The sweep in shear, by G* = E*/3 and γ = √3 ε, as an incompressible rubber has them.

        √3 ε is the shear strain of equal deviatoric strain energy.
        """
        if self.mode == "shear":
            return self
        return replace(
            self,
            strain=np.sqrt(3.0) * self.strain,
            storage=self.storage / 3.0,
            loss=self.loss / 3.0,
            mode="shear",
            force=None,
            notes=(*self.notes, "tension turned into shear by G* = E*/3 and γ = √3 ε"),
        )

    def check_area(self, area: float | None = None) -> float | None:
        """Area that force, modulus and strain imply, m²: force/(|G| γ), None without a force.

        Raises
        ------
        ValueError
            Where the points imply different areas, or another one than given, m²: force, modulus or strain is
            then in another unit, or of another specimen. For an area where there are no forces.
        """
        given = None if area is None else positive("area", area, "it must be the specimen's area, m²")
        if self.force is None:
            if given is not None:
                raise ValueError(
                    f"area is {1e6 * given:.4g} mm², and {self.source} has no force to check it by: leave "
                    f"area out, or read the column of forces"
                )
            return None
        each = self.force / (np.hypot(self.storage, self.loss) * self.strain)
        implied = float(np.median(each))
        off = float(np.abs(each / implied - 1).max())
        if not off <= _AREA_SCATTER:
            raise ValueError(
                f"{self.source}: force/(|G|·strain) runs from {1e6 * each.min():.4g} to "
                f"{1e6 * each.max():.4g} mm², where one specimen has one area: force, modulus and strain do "
                f"not belong together, or one is peak-to-peak in some rows; leave force out, or correct it"
            )
        if given is not None and not abs(implied / given - 1) <= _AREA_ERROR:
            raise ValueError(
                f"area is {1e6 * given:.4g} mm²; force/(|G|·strain) of {self.source} makes "
                f"{1e6 * implied:.4g} mm², {implied / given:.3g} times as much: give the area that shears "
                f"(of both discs of a sandwich), and strain, force and moduli zero-to-peak in SI units"
            )
        return implied


class _SweepReader(TableReader):
    """Reads a table at one frequency, which the reader of frequency sweeps refuses."""

    def _refuse_amplitudes(self, block: Block, points: Any) -> None:
        """A sweep of amplitude is what is wanted."""


def read_strain_sweep(
    data: str | Path | Any,
    mode: Mode | None = None,
    *,
    columns: Mapping[str, str | int] | None = None,
    units: Mapping[str, str] | None = None,
    temperature: float | None = None,
) -> StrainSweep:
    """Read a strain sweep from a table with a header, as `read_dma` reads frequency sweeps.

    The table has a column of strain (in percent where its title or unit says %, pct or percent, else a
    fraction), and those of `read_dma`; a column of force is taken along. A strain that its title calls
    peak-to-peak (p-p, pk-pk) is halved.

    Parameters
    ----------
    data
        File to read, pandas frame, or mapping of columns by name.
    mode
        "shear" or "tension"; deduced from the letters G or E in the header when not given.
    columns
        Column titles by quantity, as in `read_dma`, and of "strain" and "force".
    units
        Units by quantity, as in `read_dma`; of "strain" "%" or "1", of "force" N, mN or kN.
    temperature
        °C, where the table has no such column.

    Raises
    ------
    FileNotFoundError
        If there is no such file.
    ValueError
        If there are several tables, or the table has no strain, several frequencies, or moduli that
        `read_dma` would refuse.

    Warns
    -----
    AssumedMeaning
        Where nothing says whether the strain is a fraction or in percent.
    """
    wanted, given = dict(columns or {}), dict(units or {})
    own: dict[str, str | int] = {q: wanted.pop(q) for q in ("strain", "force") if q in wanted}
    own_units: dict[str, str] = {q: given.pop(q) for q in ("strain", "force") if q in given}
    request = Request(mode, wanted, given, temperature)
    source = (read_source(Path(data)) if isinstance(data, str | Path) else [source_of(data)])[0]
    reader = _SweepReader(source, request)
    table = reader.read()
    name = str(data) if isinstance(data, str | Path) else "arrays"
    found_mode = table.asked_mode(mode)
    if found_mode is None:
        raise ReadingError(
            f"{table.header}: the header does not tell G from E: give mode='shear' or 'tension'"
        )
    block, *others = reader.blocks
    if others:
        raise ReadingError(
            f"{others[0].where}: a second table begins here, and a strain sweep is one; leave one in the file"
        )
    rows = {row.number: row for row in block.rows}
    strain = _column(block, [rows[k] for k in table.lines], "strain", _STRAIN_TITLE, own, own_units)
    if strain is None:
        raise ReadingError(
            f"{table.header}: no column of strain; name it by columns={{'strain': 'its title'}}", "columns"
        )
    force = _column(block, [rows[k] for k in table.lines], "force", _FORCE_TITLE, own, own_units)
    f = table.frequency
    require(
        bool(np.ptp(f) <= 1e-2 * f.max()),
        f"{name}: frequency",
        f"{f.min():g} to {f.max():g} Hz",
        "a strain sweep is at one frequency",
    )
    return StrainSweep(
        strain,
        table.storage,
        table.loss,
        float(f.mean()),
        float(table.temperature.mean()),
        found_mode,
        force,
        name,
        table.notes,
    )


def _column(
    block: Block,
    rows: list[Row],
    quantity: str,
    pattern: re.Pattern[str],
    columns: Mapping[str, str | int],
    units: Mapping[str, str],
) -> Array | None:
    """Numbers of strain, a fraction, or force, N, in these rows; None where no title is like it."""
    titles = [cell.strip() for cell in block.cells(block.header)]
    asked = columns.get(quantity)
    if asked is None:
        at = next((k for k, title in enumerate(titles) if pattern.search(title)), None)
    else:
        at = asked - 1 if isinstance(asked, int) else titles.index(asked) if asked in titles else None
        remedy = f"there are {titles}"
        require(at is not None and at < len(titles), f"columns[{quantity!r}]", asked, remedy)
    if at is None:
        return None
    text = titles[at]
    _, unit = title_of(text)
    below = [] if block.unit_row is None else block.cells(block.unit_row)
    unit = units.get(quantity, unit or cell_at(below, at))
    values = []
    for row in rows:
        cell = cell_at(block.cells(row), at)
        if not is_number(cell):
            raise ReadingError(f"{block.source.at(row.number)}, column {text!r}: {cell!r} is not a number")
        values.append(number_of(cell))
    if quantity == "strain":
        known = units.get("strain", unit) or _PERCENT.search(text.replace("_", " "))
        if not known and asked is None:
            warn(
                f"{block.source.at(block.header.number)}, column {text!r}: no unit for the strain: taken as "
                "a fraction; units={'strain': '%'} says otherwise",
                AssumedMeaning,
            )
        percent = bool(_PERCENT.search(units.get("strain", f"{text.replace('_', ' ')} {unit}")))
        # an amplitude is half of what is read from peak to peak
        half = 0.5 if _PEAK_TO_PEAK.search(text.replace("_", " ")) else 1.0
        return np.array(values) * (1e-2 if percent else 1.0) * half
    named = re.split(r"[\s_\[(]+", text.rstrip(")]"))[-1].lower() if not unit else unit.lower()
    return np.array(values) * _FORCE_UNITS.get(named if named in _FORCE_UNITS else "", 1.0)
