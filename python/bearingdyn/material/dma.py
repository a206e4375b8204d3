"""Dynamic mechanical analysis: isothermal frequency sweeps of the storage and loss modulus."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any, ClassVar, Literal, Self

import numpy as np
from numpy.typing import NDArray

from bearingdyn.checks import instance, items, positive, reals, require, truth, two
from bearingdyn.material.isotherms import first_unsorted, group_isotherms
from bearingdyn.material.shear_from_tension import shear_modulus
from bearingdyn.notice import UnlikelyModulus, warn
from bearingdyn.pictures import page
from bearingdyn.types import Array

Mode = Literal["shear", "tension"]
_SPREAD = 6.0  # K; widest temperature range called one isotherm
_SOFT, _HARD, _HARDEST = 10.0, 5e10, 1.2e12  # Pa; a soft gel, more than any polymer, diamond
_UNIT = "is the unit right (Pa, kPa, MPa, GPa)? Give units={'storage': ..., 'loss': ...}"


class UnitError(ValueError):
    """DMA data whose unit is wrong: moduli that no solid has."""


@dataclass(frozen=True, eq=False, repr=False)
class DMAData:
    """A dynamic mechanical analysis (DMA): storage and loss modulus, one value of each per point.

    Parameters
    ----------
    frequency
        Hz, (n,), positive.
    temperature
        °C, (n,).
    storage, loss
        Storage and loss modulus, Pa, (n,), finite. Negative ones are kept, and left out of master curves.
    mode
        "shear" if the moduli are G′ and G″, "tension" if they are E′ and E″.
    source
        Where the data come from, for messages.
    isotherm
        Number of the isotherm each point belongs to, (n,), rising with temperature; found by
        :func:`group_isotherms` when not given.
    notes
        What was assumed in reading, and what was converted.
    K
        Bulk modulus, Pa, with which :meth:`to_shear` turned tension into shear; None if it did not.
    run
        Name of the run (the specimen) each point belongs to, (n,); None if nothing says so. Isotherms of
        different runs stay apart.
    runs_chosen
        Whether several runs are together because :meth:`select` was asked for them.

    Raises
    ------
    ValueError
        If a table is empty, lengths differ, a value is out of range, an isotherm is wider than 6 K,
        or frequencies run to and fro within an isotherm.
    """

    frequency: Array
    temperature: Array
    storage: Array
    loss: Array
    mode: Mode
    source: str = "arrays"
    isotherm: NDArray[np.int64] | None = None
    notes: tuple[str, ...] = ()
    K: float | None = None
    run: NDArray[np.str_] | None = None
    runs_chosen: bool = False

    PER_POINT: ClassVar[tuple[str, ...]] = ("frequency", "temperature", "storage", "loss", "isotherm", "run")

    _repr_html_ = page

    def __repr__(self) -> str:
        """One line: points, isotherms, and ranges."""
        T, f = self.isotherm_temperatures, self.frequency
        runs = f", {len(self.runs)} runs" if self.runs else ""
        return (
            f"<{type(self).__name__} in {self.mode}, {f.size} points{runs}: {T.size} isotherms from "
            f"{T.min():.4g} to {T.max():.4g} °C, {f.min():.3g} to {f.max():.3g} Hz, storage "
            f"modulus {self.storage.min():.3g} to {self.storage.max():.3g} Pa; {self.source}>"
        )

    def __post_init__(self) -> None:
        instance("source", self.source, str, "it must be a text that says where the data come from")
        truth("runs_chosen", self.runs_chosen)
        for name in ("frequency", "temperature", "storage", "loss"):
            values = reals(f"{self.source}: {name}", getattr(self, name), "it must be numbers, one a point")
            if values.ndim != 1:
                raise ValueError(
                    f"{self.source}: {name} has shape {values.shape}; it must be one-dimensional"
                )
            self._store(name, values)
        n = self.frequency.size
        if n == 0:
            raise ValueError(
                f"{self.source}: the table is empty: at least one point of measurement is needed"
            )
        for name in ("temperature", "storage", "loss"):
            if getattr(self, name).size != n:
                raise ValueError(
                    f"{self.source}: {name} has {getattr(self, name).size} values, frequency {n}; there "
                    "must be as many"
                )
        if self.K is not None:
            positive(f"{self.source}: K", self.K, "it must be a positive bulk modulus in Pa, or None")
        if self.mode not in ("shear", "tension"):
            raise ValueError(f"{self.source}: mode is {self.mode!r}; it must be 'shear' (G) or 'tension' (E)")
        if not np.all(np.isfinite(self.temperature) & (self.temperature > -273.15)):
            raise ValueError(f"{self.source}: temperature: every value must be finite and above -273.15 °C")
        for name, unit in (("frequency", "Hz"), ("storage", "Pa"), ("loss", "Pa")):
            values = getattr(self, name)
            good = np.isfinite(values) & ((values > 0) if name == "frequency" else True)
            if not good.all():
                i = int(np.argmin(good))
                need = "positive and finite" if name == "frequency" else "finite"
                raise ValueError(f"{self.source}: {name}[{i}] is {values[i]:g} {unit}; it must be {need}")
        middle = float(np.median(np.abs(self.storage)))
        if middle > _HARDEST:
            raise UnitError(
                f"{self.source}: median storage modulus {middle:.3g} Pa: no solid is harder than diamond, "
                f"{_HARDEST:g} Pa: {_UNIT}"
            )
        if self.run is not None:
            run = np.array(self.run, dtype=np.str_)
            if run.shape != (n,):
                raise ValueError(
                    f"{self.source}: run has shape {run.shape}; it must name one run per point, ({n},)"
                )
            self._store("run", run)
        if self.isotherm is None:
            labels = group_isotherms(self.temperature, self.run)
        else:
            labels = np.unique(np.asarray(self.isotherm), return_inverse=True)[1].reshape(-1)
            if labels.size != n:
                raise ValueError(f"{self.source}: isotherm has {labels.size} labels, frequency {n} values")
            means = [self.temperature[labels == k].mean() for k in range(labels.max() + 1)]
            labels = np.argsort(np.argsort(means, kind="stable"))[labels]
        self._store("isotherm", labels.astype(np.int64))
        self._check_isotherms(labels)

    def _store(self, name: str, values: NDArray[Any]) -> None:
        values.flags.writeable = False
        object.__setattr__(self, name, values)

    def _check_isotherms(self, labels: NDArray[np.int64]) -> None:
        for k in range(int(labels.max()) + 1):
            T = self.temperature[labels == k]
            if not np.ptp(T) <= _SPREAD:
                raise ValueError(
                    f"{self.source}: temperatures {T.min():.4g} to {T.max():.4g} °C cannot be told apart "
                    f"into isotherms at most {_SPREAD:g} K wide: measure frequency sweeps at steady "
                    "temperatures, or give each point's isotherm"
                )
        i = first_unsorted(self.frequency, labels)
        if i is not None:
            raise ValueError(
                f"{self.source}: frequency[{i}] is {self.frequency[i]:g} Hz and runs back within the "
                f"isotherm at {self.temperature[i]:.4g} °C; it must rise throughout, or fall throughout"
            )

    @property
    def tan_delta(self) -> Array:
        """Loss factor tan δ = loss/storage of each point, (n,); not finite where storage is zero."""
        with np.errstate(divide="ignore", invalid="ignore"):
            return np.asarray(self.loss / self.storage)

    @property
    def labels(self) -> NDArray[np.int64]:
        """Number of each point's isotherm, (n,), 0 the coldest."""
        assert self.isotherm is not None  # set in __post_init__
        return self.isotherm

    @property
    def isotherm_temperatures(self) -> Array:
        """Mean temperature of each isotherm, °C, rising."""
        return np.bincount(self.labels, self.temperature) / np.bincount(self.labels)

    @property
    def isotherms(self) -> tuple[Self, ...]:
        """The isotherms, coldest first, each in order of frequency."""
        return tuple(self.take(np.flatnonzero(self.labels == k)) for k in range(int(self.labels.max()) + 1))

    @property
    def runs(self) -> tuple[str, ...]:
        """Names of the runs in the order in which they appear; none if nothing names them."""
        return () if self.run is None else tuple(dict.fromkeys(self.run.tolist()))

    def take(self, index: NDArray[np.int64]) -> Self:
        """The points of these indices, in order of isotherm and frequency."""
        index = index[np.lexsort((self.frequency[index], self.labels[index]))]
        known: dict[str, Any] = {name: getattr(self, name) for name in self.PER_POINT}
        taken: dict[str, Any] = {name: None if v is None else v[index] for name, v in known.items()}
        return replace(self, **taken)

    def to_shear(self, *, K: float | None = None, nu: float | None = None) -> DMAData:
        """The same measurement in shear, by a bulk modulus or by a Poisson's ratio.

        Parameters
        ----------
        K
            Constant bulk modulus, Pa, as the Maxwell model has it: G* = 3KE*/(9K − E*), complex.
        nu
            Constant real Poisson's ratio, 0 ≤ nu ≤ 0.5: G* = E*/2(1 + nu). Only with nu = 0.5, or moduli far
            below K, does it agree with a constant K.

        Raises
        ------
        ValueError
            Unless exactly one of K and nu is given, in its range, and the measurement is in tension.
        """
        if self.mode != "tension":
            raise ValueError(
                f"{self.source}: mode is {self.mode!r}; only a measurement in tension is converted"
            )
        modulus, note = shear_modulus(self.storage + 1j * self.loss, K, nu)
        return replace(
            self,
            storage=modulus.real,
            loss=modulus.imag,
            mode="shear",
            notes=(*self.notes, note),
            K=None if K is None else float(K),
        )

    def select(
        self,
        f_min: float = 0.0,
        f_max: float = np.inf,
        T: tuple[float, float] = (-np.inf, np.inf),
        run: str | Sequence[str] | None = None,
    ) -> Self:
        """The points with f_min ≤ frequency ≤ f_max, Hz, T[0] ≤ temperature ≤ T[1], °C, and of these runs.

        Use it to leave out, openly, what is known to be wrong: a fixture's resonance, a melted sample,
        another specimen. Several runs named are meant to stand together: :func:`master_curve` then does not
        warn.

        Raises
        ------
        ValueError
            If no point is left, or there is no such run.
        """
        f_min, f_max = two("f_min, f_max", (f_min, f_max), "each must be a frequency in Hz")
        cold, hot = two("T", T, "it must be (coldest, hottest) in °C")
        keep = (self.frequency >= f_min) & (self.frequency <= f_max)
        keep &= (self.temperature >= cold) & (self.temperature <= hot)
        asked = (
            [] if run is None else [run] if isinstance(run, str) else items("run", run, "give names of runs")
        )
        wanted = None if run is None else [str(name) for name in asked]
        if wanted is not None:
            have = list(self.runs)
            remedy = (
                f"there are {have}" if have else "no column of the table names runs (columns={'run': ...})"
            )
            require(bool(wanted) and set(wanted) <= set(have), f"{self.source}: run", run, remedy)
            keep &= np.isin(self.run, wanted)  # type: ignore[arg-type]
        if not keep.any():
            raise ValueError(
                f"{self.source}: no point between f_min = {f_min:g} and f_max = {f_max:g} Hz, "
                f"T = {cold:g} to {hot:g} °C{'' if run is None else f', run {run!r}'}: data reach from "
                f"{self.frequency.min():.4g} to {self.frequency.max():.4g} Hz, {self.temperature.min():.4g} "
                f"to {self.temperature.max():.4g} °C"
            )
        left = self.take(np.flatnonzero(keep))
        return left if wanted is None else replace(left, runs_chosen=True)


def check_range(dma: DMAData) -> None:
    """DMA data whose moduli gels, elastomers and polymers do not have: a warning that the unit is wrong."""
    middle = float(np.median(np.abs(dma.storage)))
    if middle > _HARD or 0 < middle < _SOFT:
        warn(
            f"{dma.source}: median storage modulus {middle:.3g} Pa in {dma.mode} lies outside {_SOFT:g} to "
            f"{_HARD:g} Pa, the range of gels, elastomers and polymers: {_UNIT}",
            UnlikelyModulus,
        )
