"""Dynamic mechanical analysis: isothermal frequency sweeps of the storage and loss modulus."""

from __future__ import annotations

import importlib.resources
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from bearingdyn.material.table import read_table

Mode = Literal["shear", "tension"]

_SPREAD = 6.0  # K; widest temperature range called one isotherm


@dataclass(frozen=True, eq=False)
class DMAData:
    """Storage and loss modulus at frequencies and temperatures, one value of each per point.

    Parameters
    ----------
    frequency
        Hz, (n,), positive.
    temperature
        °C, (n,).
    storage, loss
        Storage and loss modulus, Pa, (n,), positive.
    mode
        "shear" if the moduli are G′ and G″, "tension" if E′ and E″.
    source
        Where the data come from, for messages.
    isotherm
        Number of the isotherm each point belongs to, (n,), rising with temperature; found by
        :func:`group_isotherms` when not given.

    Raises
    ------
    ValueError
        If a table is empty, lengths differ, a value is out of range, an isotherm is wider than 6 K,
        or frequencies run to and fro within an isotherm.
    """

    frequency: NDArray[np.float64]
    temperature: NDArray[np.float64]
    storage: NDArray[np.float64]
    loss: NDArray[np.float64]
    mode: Mode
    source: str = "arrays"
    isotherm: NDArray[np.int64] | None = None

    def __post_init__(self) -> None:
        for name in ("frequency", "temperature", "storage", "loss"):
            values = np.array(getattr(self, name), dtype=np.float64)
            if values.ndim != 1:
                raise ValueError(f"{self.source}: {name} has shape {values.shape}: must be one-dimensional")
            self._store(name, values)
        n = self.frequency.size
        if n == 0:
            raise ValueError(
                f"{self.source}: the table is empty: at least one point of measurement is needed"
            )
        for name in ("temperature", "storage", "loss"):
            if getattr(self, name).size != n:
                raise ValueError(
                    f"{self.source}: {name} has {getattr(self, name).size} values, frequency {n}: must be "
                    "as many"
                )
        if self.mode not in ("shear", "tension"):
            raise ValueError(f"{self.source}: mode = {self.mode!r}: must be 'shear' (G) or 'tension' (E)")
        if not np.all(np.isfinite(self.temperature) & (self.temperature > -273.15)):
            raise ValueError(f"{self.source}: temperature: every value must be finite and above -273.15 °C")
        for name, unit in (("frequency", "Hz"), ("storage", "Pa"), ("loss", "Pa")):
            values = getattr(self, name)
            bad = ~(np.isfinite(values) & (values > 0))
            if bad.any():
                i = int(np.argmax(bad))
                raise ValueError(
                    f"{self.source}: {name}[{i}] = {values[i]:g} {unit}: must be positive and finite"
                )
        if self.isotherm is None:
            labels = group_isotherms(self.temperature)
        else:
            labels = np.unique(np.asarray(self.isotherm), return_inverse=True)[1].reshape(-1)
            if labels.size != n:
                raise ValueError(f"{self.source}: isotherm has {labels.size} labels, frequency {n} values")
            means = [self.temperature[labels == k].mean() for k in range(labels.max() + 1)]
            labels = np.argsort(np.argsort(means))[labels]
        self._store("isotherm", labels.astype(np.int64))
        self._check_isotherms(labels)

    def _store(self, name: str, values: NDArray[np.float64] | NDArray[np.int64]) -> None:
        values.flags.writeable = False
        object.__setattr__(self, name, values)

    def _check_isotherms(self, labels: NDArray[np.int64]) -> None:
        for k in range(int(labels.max()) + 1):
            T = self.temperature[labels == k]
            if not np.ptp(T) <= _SPREAD:
                raise ValueError(
                    f"{self.source}: temperatures {T.min():.4g} to {T.max():.4g} °C cannot be told apart "
                    "into "
                    f"isotherms at most {_SPREAD:g} K wide: measure frequency sweeps at steady temperatures, "
                    "or give each point's isotherm"
                )
        i = first_unsorted(self.frequency, labels)
        if i is not None:
            raise ValueError(
                f"{self.source}: frequency[{i}] = {self.frequency[i]:g} Hz runs back within the isotherm at "
                f"{self.temperature[i]:.4g} °C: must rise throughout, or fall throughout"
            )

    @property
    def tan_delta(self) -> NDArray[np.float64]:
        """Loss factor tan δ = loss/storage of each point, (n,)."""
        return np.asarray(self.loss / self.storage)

    @property
    def labels(self) -> NDArray[np.int64]:
        """Number of each point's isotherm, (n,), 0 the coldest."""
        assert self.isotherm is not None  # set in __post_init__
        return self.isotherm

    @property
    def isotherm_temperatures(self) -> NDArray[np.float64]:
        """Mean temperature of each isotherm, °C, rising."""
        return np.bincount(self.labels, self.temperature) / np.bincount(self.labels)

    @property
    def isotherms(self) -> tuple[DMAData, ...]:
        """The isotherms, coldest first, each in order of frequency."""
        return tuple(self._take(np.flatnonzero(self.labels == k)) for k in range(int(self.labels.max()) + 1))

    def _take(self, index: NDArray[np.int64]) -> DMAData:
        index = index[np.lexsort((self.frequency[index], self.labels[index]))]
        return DMAData(
            self.frequency[index],
            self.temperature[index],
            self.storage[index],
            self.loss[index],
            self.mode,
            self.source,
            self.labels[index],
        )

    def select(
        self, f_min: float = 0.0, f_max: float = np.inf, T: tuple[float, float] = (-np.inf, np.inf)
    ) -> DMAData:
        """The points with f_min ≤ frequency ≤ f_max, Hz, and T[0] ≤ temperature ≤ T[1], °C.

        To leave out, openly, what is known to be wrong: a fixture's resonance, a melted sample.
        ValueError if no point is left.
        """
        keep = (self.frequency >= f_min) & (self.frequency <= f_max)
        keep &= (self.temperature >= T[0]) & (self.temperature <= T[1])
        if not keep.any():
            raise ValueError(
                f"{self.source}: no point between f_min = {f_min:g} and f_max = {f_max:g} Hz, "
                f"T = {T[0]:g} to {T[1]:g} °C: data reach from {self.frequency.min():.4g} to "
                f"{self.frequency.max():.4g} Hz, {self.temperature.min():.4g} to "
                f"{self.temperature.max():.4g} °C"
            )
        return self._take(np.flatnonzero(keep))


def first_unsorted(frequency: NDArray[np.float64], labels: NDArray[np.int64]) -> int | None:
    """Index of the first point whose frequency turns back within its isotherm, None if there is none."""
    found = []
    for k in np.unique(labels):
        index = np.flatnonzero(labels == k)
        step = np.sign(np.diff(frequency[index]))
        moving = step[step != 0]
        if moving.size:
            turned = np.flatnonzero(step == -moving[0])
            found += [int(index[turned[0] + 1])] if turned.size else []
    return min(found, default=None)


def group_isotherms(temperature: ArrayLike) -> NDArray[np.int64]:
    """Number of the isotherm each temperature, °C, (n,), belongs to, 0 the coldest.

    Sorted temperatures are cut at their wide gaps; wide is what lies above the largest jump in the sizes of
    the gaps, 0.3 K at least and 3 K at most, so that jitter of a tenth of a kelvin and drift of one do no
    harm.
    """
    T = np.asarray(temperature, dtype=float)
    order = np.argsort(T, kind="stable")
    gap = np.diff(T[order])
    sizes = np.concatenate([[0.02], np.sort(np.clip(gap, 0.02, 3.0))])
    jump = np.where(sizes[1:] >= 0.3, sizes[1:] / sizes[:-1], 0.0)
    labels = np.zeros(T.size, dtype=np.int64)
    if jump.size and jump.max() > 0:
        threshold = sizes[1 + int(np.argmax(jump))]
        labels[order[1:]] = np.cumsum(np.minimum(gap, 3.0) >= threshold)
    return labels


def read_dma(
    path: str | Path,
    mode: Mode | None = None,
    *,
    columns: Mapping[str, str] | None = None,
    units: Mapping[str, str] | None = None,
    sort: bool = False,
    drop_invalid: bool = False,
) -> DMAData:
    """Read isothermal frequency sweeps from a text table with a header.

    Columns are known by their names (frequency or angular frequency, temperature, storage and loss modulus or
    tan δ, and, if there is one, the nominal temperature or number of the isotherm), units by the name's
    ending, a bracket or a row of units. Separators may be comma, semicolon, tab or blanks; lines beginning
    with # are comments.

    Parameters
    ----------
    path
        File to read.
    mode
        "shear" or "tension"; deduced from the letters G or E in the header when not given.
    columns
        Column names by quantity ("frequency", "temperature", "storage", "loss", "tan_delta", "isotherm"),
        where the header is not understood.
    units
        Units by quantity, where the file names none, e.g. {"storage": "MPa"}.
    sort
        Sort the points by isotherm and frequency instead of refusing an unsorted table.
    drop_invalid
        Leave out points with an empty, non-finite or non-positive value, with a warning that counts them,
        instead of refusing the table.

    Raises
    ------
    FileNotFoundError
        If there is no such file.
    ValueError
        If the file is not such a table; the message names file, line, column, value and remedy.
    """
    table = read_table(Path(path), columns or {}, units or {}, drop_invalid)
    if mode is None:
        mode = table.mode
        if mode is None:
            raise ValueError(
                f"{path}, line {table.header_line}: the header does not tell G (shear) from E (tension): "
                "give mode='shear' or mode='tension'"
            )
    elif table.mode is not None and table.mode != mode:
        raise ValueError(
            f"{path}, line {table.header_line}: the header says {table.mode}, mode = {mode!r}: give the "
            "right mode, "
            "or name the right columns"
        )
    values = {name: table.values[name] for name in ("frequency", "temperature", "storage", "loss")}
    if "isotherm" in table.values:
        labels = np.unique(table.values["isotherm"], return_inverse=True)[1].reshape(-1).astype(np.int64)
    else:
        labels = group_isotherms(values["temperature"])
    if sort:
        order = np.lexsort((values["frequency"], labels))
        values = {name: column[order] for name, column in values.items()}
        labels = labels[order]
    else:
        i = first_unsorted(values["frequency"], labels)
        if i is not None:
            raise ValueError(
                f"{path}, line {table.lines[i]}: frequency {values['frequency'][i]:g} Hz runs back within "
                "the "
                f"isotherm at {values['temperature'][i]:.4g} °C: must rise throughout, or fall throughout; "
                "sort=True sorts the table"
            )
    return DMAData(**values, mode=mode, source=str(path), isotherm=labels)


def sample_dma_path() -> Path:
    """Path of the sample table shipped with the package: made from a model its header states, not
    measured."""
    return Path(str(importlib.resources.files("bearingdyn.material") / "sample_dma.csv"))
