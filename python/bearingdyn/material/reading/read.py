"""Reading of DMA measurements: text tables, instruments' exports, spreadsheets, frames and arrays."""

from __future__ import annotations

import importlib.resources
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from bearingdyn.magnitude import SOFTEST
from bearingdyn.material.dma import DMAData, Mode, UnitError, check_range, first_unsorted, group_isotherms
from bearingdyn.material.reading.errors import ReadingError
from bearingdyn.material.reading.request import Request
from bearingdyn.material.reading.source import read_source, source_of
from bearingdyn.material.reading.table import NO_LETTER, Table, read_table
from bearingdyn.notice import AssumedMeaning, UnlikelyModulus, warn
from bearingdyn.types import Index


def read_dma(
    data: str | Path | Any,
    mode: Mode | None = None,
    *,
    columns: Mapping[str, str] | None = None,
    units: Mapping[str, str] | None = None,
    temperature: float | None = None,
    sort: bool = False,
    drop_invalid: bool = False,
) -> DMAData:
    """Read isothermal frequency sweeps from a table with a header.

    The reader understands plain tables (comma, semicolon, tab or blanks; decimal point or comma; UTF-8,
    UTF-16 or Latin-1; # opens a comment), exports of TA TRIOS (CSV and LIMS text) and Anton Paar
    RheoCompass, GABO Eplexor XLS, and XLSX. Columns are known by their names (frequency or angular
    frequency, temperature, storage and loss modulus, or one of them with tan δ or the phase, or |G*| with
    either, and the nominal temperature or number of the isotherm), units by the name's ending, a bracket or
    a row of units. Where one file holds several tables (a step each), all are read. Points with an empty or
    non-finite value are left out with a warning that counts them; negative moduli are kept, for
    :func:`master_curve` to leave out openly.

    Parameters
    ----------
    data
        File to read, or a pandas frame, a mapping of columns by name, or an array (n, 4) of frequency, Hz,
        temperature, °C, storage and loss modulus, Pa.
    mode
        "shear" or "tension"; deduced from the letters G or E in the header when not given.
    columns
        Column names by quantity ("frequency", "temperature", "storage", "loss", "tan_delta", "complex",
        "phase", "isotherm"), where the header is not understood.
    units
        Units by quantity, where the file names none, e.g. {"storage": "MPa"}. A frequency without unit is
        taken as Hz, an angular frequency as rad/s, a temperature of up to 150 as °C, each with a warning.
    temperature
        Temperature of all points, °C, where the table has no such column.
    sort
        Sort the points by isotherm and frequency instead of refusing an unsorted table.
    drop_invalid
        Leave out points whose frequency or modulus is not positive, too.

    Returns
    -------
    DMAData
        Frequency, Hz, temperature, °C, storage and loss modulus, Pa, (n,) each; `notes` say what was assumed.

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
    request = Request(mode, columns or {}, units or {}, temperature, drop_invalid)
    sources = read_source(Path(data)) if isinstance(data, str | Path) else [source_of(data)]
    table = read_table(sources, request)
    mode = _mode(table, mode)
    cold = int(np.argmin(table.temperature))
    if not table.temperature[cold] > -273.15:
        raise ReadingError(
            f"{table.at(cold)}: temperature {table.temperature[cold]:g} °C: must lie above -273.15 °C"
        )
    labels = _isotherms(table)
    order = _order(table, labels, sort)
    name = table.source.name if table.source.word == "row" else str(data)
    try:
        dma = DMAData(
            table.frequency[order],
            table.temperature[order],
            table.storage[order],
            table.loss[order],
            mode,
            name,
            labels[order],
            table.notes,
        )
    except ValueError as error:
        remedies = ("units",) if isinstance(error, UnitError) else ()
        raise ReadingError(f"{table.at(0)} to {table.lines[-1]}: {error}", *remedies) from error
    check_range(dma)
    top = float(np.max(np.abs(dma.storage)))
    if 10.0 <= top < SOFTEST:  # below, check_range has warned
        warn(
            f"{dma.source}: no storage modulus above {top:.4g} Pa, softer than any rubber: are the numbers "
            "in kPa or MPa? Then give units={'storage': 'kPa', 'loss': 'kPa'}",
            UnlikelyModulus,
        )
    return dma


def _mode(table: Table, mode: Mode | None) -> Mode:
    """Shear or tension: as asked for, as the header says, or as the file's words suggest."""
    if mode is not None:
        if table.mode not in (None, mode):
            raise ReadingError(
                f"{table.header}: the header says {table.mode}, mode is {mode!r}; give the right mode, or "
                "name the right columns"
            )
        return mode
    if table.mode is not None:
        return table.mode
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
        return group_isotherms(table.temperature)
    return np.unique(table.isotherm, return_inverse=True)[1].reshape(-1).astype(np.int64)


def _order(table: Table, labels: NDArray[np.int64], sort: bool) -> Index:
    """Order of the points, (n,): sorted, or as they stand, which has to be sorted within each isotherm."""
    if sort:
        return np.lexsort((table.frequency, labels))
    back = first_unsorted(table.frequency, labels)
    if back is not None:
        raise ReadingError(
            f"{table.at(back)}: frequency {table.frequency[back]:g} Hz runs back within the isotherm at "
            f"{table.temperature[back]:.4g} °C: must rise throughout, or fall throughout; sort=True sorts "
            "the table; two sweeps at one temperature are told apart by a column 'isotherm'",
            "sort",
        )
    return np.arange(table.frequency.size)


def sample_dma_path() -> Path:
    """Path of the sample table shipped with the package: made from a model its header states, not
    measured.

    Returns the path of a CSV: frequency, Hz, temperature, °C, storage and loss modulus in shear, Pa.
    """
    return Path(str(importlib.resources.files("bearingdyn.material") / "sample_dma.csv"))
