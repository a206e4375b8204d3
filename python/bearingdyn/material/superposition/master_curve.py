"""Time-temperature superposition: isotherms shifted along the frequency axis to one master curve.

The reduced frequency of a point is f·a_T(T); the shifts log10 a_T of the isotherms are free numbers, found
first from the overlap of neighbouring isotherms, then all together as those by which one non-negative
relaxation spectrum renders every point best, storage and loss modulus alike. A law is fitted to them
afterwards, and, if wished, once more directly to the data.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from bearingdyn.checks import instance, nonnegative, number, positive, require, truth
from bearingdyn.material.dma import DMAData, Mode, check_range
from bearingdyn.material.relaxation_data import RelaxationData
from bearingdyn.material.shear_from_tension import shear_modulus
from bearingdyn.material.shift_laws import ZERO_CELSIUS, Law, RhoT, ShiftTable
from bearingdyn.material.superposition.doubts import (
    doubt_gaps,
    doubt_law,
    doubt_points,
    doubt_runs,
    doubt_steps,
)
from bearingdyn.material.superposition.free_shifts import Superposed, Superposition, first_shifts
from bearingdyn.material.superposition.kramers_kronig import Suspect, summary, suspects
from bearingdyn.material.superposition.law_fit import LawName, fit_law, fit_law_to_data, require_isotherms
from bearingdyn.material.superposition.levels import Levels, find_levels, levelled
from bearingdyn.material.superposition.shared_temperatures import merged
from bearingdyn.notice import LeftOut, OutsideIsotherms, ThinIsotherm, warn
from bearingdyn.pictures import picture
from bearingdyn.types import Array

_JITTER = 0.5  # K; as far as a mean temperature may miss the one that was meant
_FAR = 100.0  # K; a T_ref further outside the data is taken for kelvin


@dataclass(frozen=True, eq=False)
class MasterCurve:
    """A master curve: moduli against reduced frequency at one reference temperature.

    Attributes
    ----------
    frequency
        Reduced frequency f·a_T, Hz, (n,), rising.
    storage, loss
        Moduli, Pa, (n,).
    temperature
        Temperature at which each point was measured, °C, (n,).
    mode
        "shear" or "tension", as measured.
    T_ref
        Reference temperature, °C.
    shifts
        log10 a_T of each isotherm by its mean temperature, °C; zero at T_ref by the law.
    shift_errors
        Standard error of each, decades, against the isotherm nearest to T_ref, from the scatter of the
        points with the levels of the runs held: `level_errors` come on top of it.
    law
        Law fitted to the shifts; None of a single sweep.
    law_residual
        rms deviation of the shifts from the law, decades.
    kk_residual
        rms relative deviation of G′ and of G″ from the nearest modulus with a non-negative relaxation
        spectrum, which satisfies the Kramers–Kronig relations exactly.
    source
        Where the data come from.
    left_out
        Points that no passive material could give, and that are not in the curve.
    smoothness
        Strength of the prior on the curvature of log10 a_T(T) the shifts were found with; 0 is none.
    vertical
        Vertical shift the moduli were divided by; None for none.
    notes
        What was assumed in reading, and what was converted.
    K
        Bulk modulus, Pa, that turned tension into shear; None if nothing did.
    levels
        Factor by which the moduli of each run were multiplied, by its name; the first run's is 1. Empty where
        there is one run, or levels were left alone.
    level_errors
        Standard error of each; inf of a run whose level nothing tells, 0 of one given by hand.
    """

    frequency: Array
    storage: Array
    loss: Array
    temperature: Array
    mode: Mode
    T_ref: float
    shifts: Mapping[float, float]
    shift_errors: Mapping[float, float]
    law: Law | None
    law_residual: float
    kk_residual: tuple[float, float]
    source: str = field(default="", repr=False)
    left_out: tuple[Suspect, ...] = field(default=(), repr=False)
    smoothness: float = 0.0
    vertical: RhoT | None = None
    notes: tuple[str, ...] = field(default=(), repr=False)
    K: float | None = None
    levels: Mapping[str, float] = field(default_factory=dict)
    level_errors: Mapping[str, float] = field(default_factory=dict)

    def _repr_html_(self) -> str:
        return str(picture("as_html", self))

    def __repr__(self) -> str:
        """One line: points, ranges, law and errors."""
        return (
            f"<MasterCurve in {self.mode} at {self.T_ref:g} °C, {self.frequency.size} points: "
            f"{self.frequency.min():.3g} to {self.frequency.max():.3g} Hz, storage modulus "
            f"{self.storage.min():.3g} to {self.storage.max():.3g} Pa, {type(self.law).__name__} law within "
            f"{self.law_residual:.2g} decades, {len(self.left_out)} points left out>"
        )

    @property
    def tan_delta(self) -> Array:
        """Loss factor tan δ of each point, (n,)."""
        return np.asarray(self.loss / self.storage)

    def to_shear(self, *, K: float | None = None, nu: float | None = None) -> MasterCurve:
        """The same curve in shear, by a bulk modulus or a Poisson's ratio, as :meth:`DMAData.to_shear`.

        Raises
        ------
        ValueError
            Unless exactly one of K, Pa, and nu is given, in its range, and the curve is in tension.
        """
        if self.mode != "tension":
            raise ValueError(f"mode is {self.mode!r}; only a measurement in tension is converted")
        modulus, note = shear_modulus(self.storage + 1j * self.loss, K, nu)
        notes = (*self.notes, note)
        known = None if K is None else float(K)
        return replace(self, storage=modulus.real, loss=modulus.imag, mode="shear", notes=notes, K=known)


def master_curve(
    dma: DMAData,
    T_ref: float = 20.0,
    law: LawName = "wlf",
    *,
    clean: bool = True,
    shifts: Mapping[float, float] | None = None,
    refine: bool = True,
    law_from: Literal["shifts", "data"] = "shifts",
    vertical: RhoT | Literal["rhoT"] | None = None,
    smoothness: float | None = None,
    levels: Literal["find"] | Mapping[str, float] | None = "find",
) -> MasterCurve:
    """Shift the isotherms of a DMA measurement to a master curve.

    Parameters
    ----------
    dma
        Frequency sweeps at two temperatures at least.
    T_ref
        Reference temperature, °C; it need not be one that was measured.
    law
        "wlf", "arrhenius", or "joined" (both, joined at Tg) hold beyond the measured temperatures too; "free"
        interpolates the shifts themselves.
    clean
        Leave out, with a warning, the points that no passive material could give (:func:`suspects`). Points
        with a modulus that is not positive are left out in any case.
    shifts
        log10 a_T by temperature, °C, set by hand for some or all isotherms (the nearest, within 2 K).
    refine
        Whether shifts set by hand are only a start; otherwise they are kept as they are.
    law_from
        Fit the law to the free shifts, or, from there, directly to the data; the curve is then shifted by
        the law, each point by its own temperature.
    vertical
        Divide moduli by b_T = ρT/(ρ_ref T_ref) first: a RhoT, or "rhoT" for one without expansion. None, the
        default, leaves them as measured.
    smoothness
        Strength of a prior on the curvature of log10 a_T(T); 0 for none, None to let the data choose it.
    levels
        Where the measurement is of several runs (specimens): "find" multiplies the moduli of each after the
        first by the factor that temperatures in common tell or, where there are none, with which the shifts
        follow the law best; {run: factor} gives factors by hand;
        None leaves moduli as measured. Shifts set by hand leave them, too.

    Returns
    -------
    MasterCurve
        Reduced frequency, Hz, and moduli, Pa, (n,), sorted by reduced frequency.

    Raises
    ------
    ValueError
        If there is only one isotherm, two isotherms of one run have the same temperature, or T_ref lies where
        the law cannot reach or more than 100 K outside the measured temperatures.

    References
    ----------
    Paper §3.2; M. L. Williams, R. F. Landel, J. D. Ferry, J. Am. Chem. Soc. 77 (1955) 3701 (WLF).
    """
    known = ("wlf", "arrhenius", "joined", "free")
    require(
        isinstance(law, str) and law in known, "law", law, "it must be 'wlf', 'arrhenius', 'joined' or 'free'"
    )
    possible = law_from == "shifts" or (law_from == "data" and law != "free")
    require(possible, "law_from", law_from, "it must be 'shifts', or 'data' with a law that has constants")
    T_ref = number("T_ref", T_ref, "it must be a temperature in °C")
    clean = truth("clean", clean)
    if shifts is not None:
        instance("shifts", shifts, Mapping, "it must be a mapping, temperature -> decades, or None")
    require(-ZERO_CELSIUS < T_ref < 1e4, "T_ref", T_ref, "it must be a temperature in °C")
    refine = truth("refine", refine)
    if smoothness is not None:
        smoothness = nonnegative("smoothness", smoothness)
        remedy = "the curve is smooth to the eye at 1, and a line at 1e6"
        require(smoothness <= 1e6, "smoothness", smoothness, remedy)
    instance("dma", dma, (DMAData, RelaxationData), "it must be the result of `read_dma`")
    check_range(dma)
    doubt_runs(dma)
    # converted relaxation is causal by construction
    used, left_out = _cleaned(dma, clean and not isinstance(dma, RelaxationData))
    if vertical is not None:
        vertical = RhoT(float(T_ref)) if isinstance(vertical, str) and vertical == "rhoT" else vertical
        instance("vertical", vertical, RhoT, "it must be 'rhoT', a RhoT(T_ref), or None")
        remedy = f"its T_ref must be that of the curve, {T_ref:g} °C"
        require(vertical.T_ref == T_ref, "vertical", vertical, remedy)
        factor = vertical.factor(used.temperature)
        used = replace(used, storage=used.storage / factor, loss=used.loss / factor)
    T = _temperatures(merged(used), T_ref)
    require_isotherms(law, T.size)
    known_levels = _levels(used, levels, bool(shifts), float(T_ref), law, smoothness)
    if known_levels is not None:
        which = np.array([used.runs.index(name) for name in used.run.tolist()])  # type: ignore[union-attr]
        factors = np.array([known_levels.factors[name] for name in used.runs])
        used = levelled(used, which, np.log(factors))
    used = merged(used)

    start = first_shifts(used)
    held = np.zeros(T.size, dtype=bool)
    if shifts:
        start, held = _by_hand(T, start, shifts)
    pinned = bool(shifts) and not refine
    nearest = int(np.argmin(np.abs(T - T_ref)))
    anchor = (T.size - 1) // 2  # whatever T_ref: the same data superpose in the same way
    fixed = held if pinned else np.arange(T.size) == anchor
    if not shifts:
        start = start - start[anchor]
    fit = Superposition(used, start, np.flatnonzero(~fixed))
    found = fit.run(smoothness, nearest)
    misfit_free = found.misfit
    fitted, offset = fit_law(T, found.shifts, float(T_ref), law, pinned)
    if law_from == "data":
        fitted, misfit, points = fit_law_to_data(fit, fitted, float(T_ref), law)
        found, offset = Superposed(found.shifts, found.errors, points, misfit, found.smoothness), 0.0
        by_law = fitted.log_shift(T)
        shifts_found = found.shifts - float(np.mean(found.shifts - by_law))
    else:
        by_law, shifts_found = fitted.log_shift(T), found.shifts - offset
    residual = float(np.sqrt(np.mean((shifts_found - by_law) ** 2)))
    if not isinstance(fitted, ShiftTable):
        fitted = replace(fitted, measured=(float(T[0]), float(T[-1])))
        error = float(np.sqrt(np.mean(found.errors**2)))
        missed = fit.misfit(fitted.log_shift(used.temperature) + offset)
        doubt_law(dma.source, law, residual, error, missed, misfit_free)
    doubt_steps(dma.source, T, found.shifts)
    doubt_gaps(used, found.point_shifts)
    doubt_points(used, fit.deviations(found.point_shifts))
    frequency = used.frequency * 10 ** (found.point_shifts - offset)
    order = np.argsort(frequency, kind="stable")
    return MasterCurve(
        frequency[order],
        used.storage[order],
        used.loss[order],
        used.temperature[order],
        used.mode,
        float(T_ref),
        dict(zip(T.tolist(), shifts_found.tolist(), strict=True)),
        dict(zip(T.tolist(), found.errors.tolist(), strict=True)),
        fitted,
        residual,
        found.misfit,
        used.source,
        left_out,
        found.smoothness,
        vertical,
        used.notes,
        used.K,
        {} if known_levels is None else known_levels.factors,
        {} if known_levels is None else known_levels.errors,
    )


def _levels(
    dma: DMAData,
    levels: Literal["find"] | Mapping[str, float] | None,
    by_hand: bool,
    T_ref: float,
    law: LawName,
    smoothness: float | None,
) -> Levels | None:
    """Factors of the runs, as asked for; None to leave moduli as measured."""
    if levels is None:
        return None
    if isinstance(levels, str):
        require(levels == "find", "levels", levels, "it must be 'find', {run: factor} or None")
        return None if by_hand else find_levels(dma, T_ref, law, smoothness)
    require(isinstance(levels, Mapping), "levels", levels, "it must be 'find', {run: factor} or None")
    require(bool(dma.runs), "levels", levels, "the data name no runs; read them with columns={'run': ...}")
    unknown = sorted(map(str, set(levels) - set(dma.runs)))
    require(not unknown, "levels", levels, f"there are the runs {list(dma.runs)}, not {unknown}")
    factors = {
        name: positive(f"levels[{name!r}]", levels.get(name, 1.0), "it must be a positive factor")
        for name in dma.runs
    }
    return Levels(factors, dict.fromkeys(factors, 0.0))


def _cleaned(dma: DMAData, clean: bool) -> tuple[DMAData, tuple[Suspect, ...]]:
    """The points to be shifted, and those left out, with a warning that counts them."""
    flagged, found = suspects(dma)
    if not clean:
        flagged = ~((dma.storage > 0) & (dma.loss > 0))
        found = tuple(s for s in found if s.reason == "negative modulus")
    if not found:
        return dma, ()
    if flagged.all():
        raise ValueError(f"{dma.source}: no point has positive moduli: the columns or their signs are wrong")
    more = "; clean=False keeps what is positive" if clean else ""
    warn(
        f"{dma.source}: {len(found)} of {flagged.size} points left out that no passive material could give: "
        f"{summary(found)}{more}",
        LeftOut,
    )
    return dma.take(np.flatnonzero(~flagged)), found


def _temperatures(dma: DMAData, T_ref: float) -> Array:
    """Temperatures of the isotherms, checked."""
    T = dma.isotherm_temperatures
    if T.size < 2:
        raise ValueError(
            f"{dma.source}: one isotherm only, at {T[0]:.4g} °C: shifts need frequency sweeps at two "
            "temperatures or more"
        )
    twin = np.flatnonzero(~(np.diff(T) > 1e-3))
    if twin.size:
        raise ValueError(
            f"{dma.source}: two isotherms at {T[twin[0]]:.4g} °C: a shift belongs to a temperature; leave "
            "one out, or give both the same isotherm number"
        )
    single = [k for k in range(T.size) if np.unique(dma.frequency[dma.labels == k]).size < 2]
    if len(single) == T.size:
        raise ValueError(
            f"{dma.source}: one frequency per isotherm: shifts need sweeps over several frequencies at each "
            "temperature"
        )
    if single:
        warn(
            f"{dma.source}: one frequency only at {', '.join(f'{T[k]:.4g}' for k in single)} °C: these "
            "shifts rest on a single point",
            ThinIsotherm,
        )
    if not T[0] - _FAR <= T_ref <= T[-1] + _FAR:
        raise ValueError(
            f"T_ref is {T_ref:g} °C, more than {_FAR:g} K outside the measured {T[0]:.4g} to "
            f"{T[-1]:.4g} °C: no shift law reaches there; is it in kelvin? T_ref is in °C"
        )
    if not T[0] - _JITTER <= T_ref <= T[-1] + _JITTER:
        warn(
            f"T_ref is {T_ref:g} °C, outside the measured {T[0]:.4g} to {T[-1]:.4g} °C: the law extrapolates",
            OutsideIsotherms,
        )
    return T


def _by_hand(T: Array, start: Array, shifts: Mapping[float, float]) -> tuple[Array, NDArray[np.bool_]]:
    """First shifts with those set by hand put in, the others moved along with them, and which are set."""
    held, values = np.zeros(T.size, dtype=bool), np.zeros(T.size)
    for temperature, shift in shifts.items():
        number("shifts", temperature, "its keys must be temperatures of isotherms, °C")
        number(f"shifts[{temperature!r}]", shift, "it must be a finite log10 a_T")
        k = int(np.argmin(np.abs(T - temperature)))
        if not abs(T[k] - temperature) <= 2.0 or held[k]:
            have = ", ".join(f"{t:.4g}" for t in T)
            raise ValueError(
                f"shifts: {temperature!r} °C names no isotherm, or one already named; there are {have} °C"
            )
        if not np.isfinite(shift):
            raise ValueError(f"shifts[{temperature!r}] is {shift!r}; it must be a finite log10 a_T")
        held[k], values[k] = True, shift
    correction = np.interp(T, T[held], (values - start)[held])
    return np.where(held, values, start + correction), held
