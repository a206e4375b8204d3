"""Reading of DMA measurements: text tables, instruments' exports, spreadsheets, frames and arrays."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from bearingdyn.checks import number, require, truth
from bearingdyn.material.dma import DMAData, Mode, UnitError, check_range
from bearingdyn.material.isotherms import first_unsorted, group_isotherms
from bearingdyn.material.reading.errors import ReadingError
from bearingdyn.material.reading.request import Request, Step
from bearingdyn.material.reading.source import read_source, source_of
from bearingdyn.material.reading.table import NO_LETTER, Table, read_table
from bearingdyn.material.relaxation_data import RelaxationData
from bearingdyn.notice import AssumedMeaning, UnlikelyModulus, warn
from bearingdyn.plausible_ranges import SOFTEST
from bearingdyn.types import Index

_AMPLITUDE = 1.5  # ratio of two strains that are not meant to be the same


def read_dma(
    data: str | Path | Any,
    mode: Mode | None = None,
    *,
    columns: Mapping[str, str | int] | None = None,
    units: Mapping[str, str] | None = None,
    temperature: float | Sequence[float | None] | None = None,
    sort: bool = False,
    drop_invalid: bool = False,
    step: Step | None = None,
) -> DMAData:
    """Read a DMA measurement, isothermal frequency sweeps, from a table with a header.

    The reader understands plain tables (comma, semicolon, tab or blanks; decimal point or comma; UTF-8,
    UTF-16 or Latin-1; # opens a comment), exports of TA TRIOS (CSV and LIMS text) and Anton Paar
    RheoCompass, GABO Eplexor XLS, and XLSX. Columns are known by their names (frequency or angular
    frequency, temperature, storage and loss modulus, or one of them with tan δ or the phase, or |G*| with
    either, the nominal temperature or number of the isotherm, and the name of the run), in English or German,
    units by the name's ending, a bracket or a row of units. A table of time and relaxation modulus becomes
    :class:`RelaxationData`. Where one file holds several tables (a step each), all are read. Points with an
    empty or non-finite value are left out with a warning that counts them; negative moduli are kept, for
    :func:`master_curve` to leave out openly.

    Parameters
    ----------
    data
        File to read, or a list of files (one per temperature, say), or a pandas frame, a mapping of columns
        by name, or an array (n, 4) of frequency, Hz, temperature, °C, storage and loss modulus, Pa.
    mode
        "shear" or "tension"; deduced from the letters G or E in the header when not given.
    columns
        Column names by quantity ("frequency", "temperature", "storage", "loss", "tan_delta", "complex",
        "phase", "isotherm", "run", and "time" and "relaxation" of a relaxation), where the header is not
        understood; or their numbers, 1 the first, where two have the same name.
    units
        Units by quantity, where the file names none, e.g. {"storage": "MPa"}. A frequency without unit is
        taken as Hz, an angular frequency as rad/s, a temperature of up to 150 as °C, each with a warning.
    temperature
        Temperature of all points, °C, where the table has no such column; a list of them for a list of files.
        Without it a temperature stated above the table is taken, or, with a warning, one in the file's name
        (sweep_25C.csv).
    sort
        Sort the points by isotherm and frequency instead of refusing an unsorted table.
    drop_invalid
        Leave out points whose frequency or modulus is not positive, too.
    step
        Which steps of an instrument's file (or sheets) to read: a part of a name, a number, 1 the first, or a
        list of either; all when not given. Sweeps of amplitude or time are refused, not merged.

    Returns
    -------
    DMAData
        Frequency, Hz, temperature, °C, storage and loss modulus, Pa, (n,) each; `notes` say what was assumed.
        RelaxationData, which is one with times and relaxation moduli besides, of a table of relaxation.

    Raises
    ------
    FileNotFoundError
        If there is no such file.
    ValueError
        If the file is not such a table, or a spreadsheet needs a package that is not installed. The message
        names file, line, column, value and remedy.

    Examples
    --------
    >>> import bearingdyn as bd
    >>> dma = bd.read_dma({"f_Hz": [1, 10, 1, 10], "T_C": [0, 0, 20, 20],
    ...                    "Gp_MPa": [4, 5, 2, 3], "Gpp_MPa": [0.5, 0.6, 0.2, 0.3]},
    ...                   columns={"frequency": "f_Hz", "temperature": "T_C", "storage": "Gp_MPa",
    ...                            "loss": "Gpp_MPa"}, mode="shear")
    >>> dma.storage.tolist(), dma.isotherm.tolist()
    ([4000000.0, 5000000.0, 2000000.0, 3000000.0], [0, 0, 1, 1])
    """
    sort, drop_invalid = truth("sort", sort), truth("drop_invalid", drop_invalid)
    files = _files(data)
    if files is None:
        if temperature is not None and not isinstance(temperature, int | float):
            remedy = "one file has one temperature, °C; a list of files may have a list of them"
            require(np.ndim(np.asarray(temperature, dtype=object)) == 0, "temperature", temperature, remedy)
            temperature = number("temperature", temperature, "it must be a temperature in °C")
        return _read_one(
            data,
            Request(
                mode,
                {} if columns is None else columns,
                {} if units is None else units,
                temperature,
                drop_invalid,
                step,
            ),
            sort,
        )
    given = _temperatures(files, temperature)
    parts = [
        _read_one(
            path,
            Request(
                mode,
                {} if columns is None else columns,
                {} if units is None else units,
                T,
                drop_invalid,
                step,
            ),
            sort,
        )
        for path, T in zip(files, given, strict=True)
    ]
    return _together(files, parts)


def _files(data: Any) -> list[Path] | None:
    """The files of a list of them; None if it is not a list of files."""
    if not isinstance(data, list | tuple) or not any(isinstance(entry, str | Path) for entry in data):
        return None
    wrong = next((entry for entry in data if not isinstance(entry, str | Path)), None)
    require(wrong is None, "data", wrong, "every entry of a list of files must be a file's name")
    twice = next((entry for k, entry in enumerate(data) if entry in data[:k]), None)
    require(twice is None, "data", twice, "the file is named twice; name it once")
    return [Path(entry) for entry in data]


def _temperatures(files: Sequence[Path], temperature: Any) -> list[float | None]:
    """The temperature given for each file, °C, None where the file has to tell."""
    if temperature is None:
        return [None] * len(files)
    if len(files) > 1 and np.ndim(temperature) == 0:
        raise ReadingError(
            f"temperature is {temperature!r}, for {len(files)} files; give a list of {len(files)} of them, "
            "one per file, in °C",
            "temperature",
        )
    given = list(np.atleast_1d(temperature).tolist())
    remedy = f"there must be as many as files, {len(files)}, in °C"
    require(len(given) == len(files), "temperature", temperature, remedy)
    return [None if T is None else number("temperature", T, "it must be a temperature in °C") for T in given]


def _together(files: Sequence[Path], parts: Sequence[DMAData]) -> DMAData:
    """Measurements of several files as one; the isotherms of each stay its own."""
    first = parts[0]
    for path, part in zip(files, parts, strict=True):
        same = part.mode == first.mode and type(part) is type(first)
        what = "a relaxation" if isinstance(part, RelaxationData) else f"in {part.mode}"
        remedy = f"all files must be of the kind of {files[0]}, in {first.mode}"
        require(same, str(path), what, remedy)
    shift = np.cumsum([0, *(int(part.labels.max()) + 1 for part in parts[:-1])])
    joined: dict[str, Any] = {
        name: np.concatenate([getattr(part, name) for part in parts])
        for name in first.PER_POINT
        if name not in ("isotherm", "run")
    }
    runs = None
    if any(part.run is not None for part in parts):
        runs = np.concatenate(
            [
                np.full(part.frequency.size, path.stem) if part.run is None else part.run
                for path, part in zip(files, parts, strict=True)
            ]
        )
    return replace(
        first,
        **joined,
        isotherm=np.concatenate([part.labels + k for part, k in zip(parts, shift, strict=True)]),
        run=runs,
        source=f"{files[0]} and {len(files) - 1} more" if len(files) > 1 else first.source,
        notes=tuple(dict.fromkeys(note for part in parts for note in part.notes)),
    )


def _read_one(data: Any, request: Request, sort: bool) -> DMAData:
    """The measurement in one file, frame or array."""
    sources = read_source(Path(data)) if isinstance(data, str | Path) else [source_of(data)]
    table = read_table(sources, request)
    mode = _mode(table, request.mode)
    cold = int(np.argmin(table.temperature))
    if not table.temperature[cold] > -273.15:
        raise ReadingError(
            f"{table.at(cold)}: temperature {table.temperature[cold]:g} °C: must lie above -273.15 °C"
        )
    labels = _isotherms(table)
    order = _order(table, labels, sort)
    name = table.source.name if table.source.word == "row" else str(data)
    runs = None if table.run is None else np.array(table.run)[order]
    try:
        if table.relaxing:
            made: DMAData = RelaxationData.of(
                table.frequency[order],
                table.storage[order],
                table.temperature[order],
                mode,
                source=name,
                isotherm=labels[order],
                notes=table.notes,
                run=runs,
            )
        else:
            made = DMAData(
                table.frequency[order],
                table.temperature[order],
                table.storage[order],
                table.loss[order],
                mode,
                name,
                labels[order],
                table.notes,
                run=runs,
            )
    except ValueError as error:
        remedies = ("units",) if isinstance(error, UnitError) else ()
        raise ReadingError(f"{table.at(0)} to {table.lines[-1]}: {error}", *remedies) from error
    check_range(made)
    top = float(np.max(np.abs(made.storage)))
    if 10.0 <= top < SOFTEST:  # below, check_range has warned
        warn(
            f"{made.source}: no storage modulus above {top:.4g} Pa, softer than any rubber: are the numbers "
            "in kPa or MPa? Then give units={'storage': 'kPa', 'loss': 'kPa'}",
            UnlikelyModulus,
        )
    return made


def _mode(table: Table, mode: Mode | None) -> Mode:
    """Shear or tension: as asked for, as the header says, or as the file's words suggest."""
    if (known := table.asked_mode(mode)) is not None:
        return known
    if not table.speaks_of_shear:
        raise ReadingError(f"{table.header}: {NO_LETTER}", "mode")
    warn(
        f"{table.header}: the header does not tell G from E: taken as shear, because the file speaks of "
        "shear (torque, plates); mode='tension' says otherwise",
        AssumedMeaning,
    )
    return "shear"


def _isotherms(table: Table) -> NDArray[np.int64]:
    """Number of each point's isotherm, (n,), by the table's own column if there is one."""
    if table.isotherm is None:
        return group_isotherms(table.temperature, table.run)
    labels = np.unique(table.isotherm, return_inverse=True)[1].reshape(-1).astype(np.int64)
    if table.run is not None:  # isotherms of different runs stay apart
        run = np.unique(table.run, return_inverse=True)[1].reshape(-1)
        labels = (
            np.unique(labels * (int(run.max()) + 1) + run, return_inverse=True)[1]
            .reshape(-1)
            .astype(np.int64)
        )
    return labels


def _order(table: Table, labels: NDArray[np.int64], sort: bool) -> Index:
    """Order of the points, (n,): sorted, or as they stand, which has to be sorted within each isotherm."""
    if sort:
        order = np.lexsort((table.frequency, labels))
        _refuse_merging(table, labels, order)
        return order
    back = first_unsorted(table.frequency, labels)
    if back is not None:
        what = (
            f"time {table.frequency[back]:g} s"
            if table.relaxing
            else f"frequency {table.frequency[back]:g} Hz"
        )
        raise ReadingError(
            f"{table.at(back)}: {what} runs back within the isotherm at "
            f"{table.temperature[back]:.4g} °C: must rise throughout, or fall throughout; sort=True sorts "
            "the table; two sweeps at one temperature are told apart by a column 'isotherm' or 'run'",
            "sort",
        )
    return np.arange(table.frequency.size)


def _refuse_merging(table: Table, labels: NDArray[np.int64], order: Index) -> None:
    """ReadingError where sorting would merge what differs in amplitude or step into one sweep."""
    for a, b in pairwise(order.tolist()):
        if labels[a] != labels[b] or not np.isclose(table.frequency[a], table.frequency[b], rtol=1e-3):
            continue
        f, T, strains = table.frequency[a], table.temperature[a], (table.strain[a], table.strain[b])
        place = f"{table.at(a)} and {table.lines[b]}: both at {f:g} and {T:.4g} °C"
        if max(strains) > _AMPLITUDE * min(strains) > 0:
            raise ReadingError(
                f"{place}, at strains {strains[0]:g} and {strains[1]:g}: an amplitude sweep, "
                "which sort=True does not merge; leave one amplitude in the table",
            )
        if table.steps[a] != table.steps[b]:
            raise ReadingError(
                f"{place}, in steps {table.steps[a]!r} and {table.steps[b]!r}: sort=True does not merge "
                "steps; choose by step=...",
                "step",
            )
