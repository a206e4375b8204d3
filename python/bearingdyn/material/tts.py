"""Time-temperature superposition: isotherms shifted along the frequency axis to one master curve.

The reduced frequency of a point is f·a_T(T); the shifts log10 a_T of the isotherms are free numbers, found
first from the overlap of neighbouring isotherms, then all together as those by which one non-negative
relaxation spectrum renders every point best, storage and loss modulus alike. A law is fitted to them
afterwards.
"""

from __future__ import annotations

import warnings
from collections.abc import Mapping
from dataclasses import dataclass, field
from itertools import pairwise
from typing import Literal

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import PchipInterpolator
from scipy.optimize import least_squares

from bearingdyn.material.dma import DMAData, Mode
from bearingdyn.material.shift import GAS_CONSTANT, WLF, ZERO_CELSIUS, Arrhenius, ShiftTable
from bearingdyn.material.spectrum import (
    Strengths,
    branch_columns,
    branch_slopes,
    dense_times,
    solve_strengths,
)

Array = NDArray[np.float64]
LawName = Literal["wlf", "arrhenius", "free"]

_JITTER = 0.5  # K; as far as a mean temperature may miss the one that was meant
_STEEPEST = 1e4  # largest C1 sought
_LAW_MISFIT = 0.3  # decades rms, beyond which a law misleads: a factor of two in frequency


@dataclass(frozen=True, eq=False)
class MasterCurve:
    """Moduli against reduced frequency at one reference temperature.

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
        points.
    law
        Law fitted to the shifts.
    law_residual
        rms deviation of the shifts from the law, decades.
    kk_residual
        rms relative deviation of G′ and of G″ from the nearest modulus with a non-negative relaxation
        spectrum, which satisfies the Kramers–Kronig relations exactly.
    source
        Where the data come from.
    """

    frequency: Array
    storage: Array
    loss: Array
    temperature: Array
    mode: Mode
    T_ref: float
    shifts: Mapping[float, float]
    shift_errors: Mapping[float, float]
    law: WLF | Arrhenius | ShiftTable
    law_residual: float
    kk_residual: tuple[float, float]
    source: str = field(default="", repr=False)

    @property
    def tan_delta(self) -> Array:
        """Loss factor tan δ of each point, (n,)."""
        return np.asarray(self.loss / self.storage)


def master_curve(dma: DMAData, T_ref: float = 20.0, law: LawName = "wlf") -> MasterCurve:
    """Shift the isotherms of a DMA measurement to a master curve.

    Parameters
    ----------
    dma
        Frequency sweeps at two temperatures at least.
    T_ref
        Reference temperature, °C; need not be one that was measured.
    law
        "wlf" or "arrhenius", fitted to the free shifts and good beyond the measured temperatures too,
        or "free": the shifts themselves, interpolated.

    Raises
    ------
    ValueError
        If there is only one isotherm, neighbouring isotherms share no moduli, or T_ref lies where the law
        cannot reach.
    """
    if law not in ("wlf", "arrhenius", "free"):
        raise ValueError(f"law = {law!r}: must be 'wlf', 'arrhenius' or 'free'")
    if not -ZERO_CELSIUS < T_ref < 1e4:
        raise ValueError(f"T_ref = {T_ref!r} °C: must be a temperature in °C")
    T = dma.isotherm_temperatures
    if T.size < 2:
        raise ValueError(
            f"{dma.source}: one isotherm only, at {T[0]:.4g} °C: shifts need frequency sweeps at two "
            "temperatures or more"
        )
    if not T[0] - _JITTER <= T_ref <= T[-1] + _JITTER:
        warnings.warn(
            f"T_ref = {T_ref:g} °C lies outside the measured {T[0]:.4g} to {T[-1]:.4g} °C: the law "
            "extrapolates",
            stacklevel=2,
        )
    anchor = int(np.argmin(np.abs(T - T_ref)))
    start = _pairwise_shifts(dma)
    refined = _Refinement(dma, anchor, start - start[anchor]).run()
    fitted, offset = _fit_law(T, refined.shifts, refined.errors, T_ref, law)
    shifts = refined.shifts - offset
    residual = float(np.sqrt(np.mean((shifts - fitted.log_shift(T)) ** 2)))
    if not residual < _LAW_MISFIT:
        warnings.warn(
            f"{dma.source}: the shifts deviate from the {law} law by {residual:.2g} decades rms: a WLF or "
            "Arrhenius law "
            "does not hold through a glass transition; take law='free' or fewer isotherms",
            stacklevel=2,
        )
    frequency = dma.frequency * 10 ** (refined.point_shifts - offset)
    order = np.argsort(frequency, kind="stable")
    return MasterCurve(
        frequency[order],
        dma.storage[order],
        dma.loss[order],
        dma.temperature[order],
        dma.mode,
        float(T_ref),
        dict(zip(T.tolist(), shifts.tolist(), strict=True)),
        dict(zip(T.tolist(), refined.errors.tolist(), strict=True)),
        fitted,
        residual,
        refined.residual,
        dma.source,
    )


def _pairwise_shifts(dma: DMAData) -> Array:
    """First guess of the shifts, decades, (k,), from the overlap of neighbours, the coldest at zero."""
    isotherms = dma.isotherms
    steps = [_overlap_shift(cold, warm) for cold, warm in pairwise(isotherms)]
    return np.concatenate([[0.0], np.cumsum(steps)])


def _overlap_shift(cold: DMAData, warm: DMAData) -> float:
    """Shift of the warm isotherm against the cold one, decades, ≤ 0, that best joins ln G′ and ln tan δ
    together."""
    curves = []
    for sweep in (cold, warm):
        x, first = np.unique(np.log10(sweep.frequency), return_index=True)
        curves.append((x, np.log(sweep.storage[first]), np.log(sweep.tan_delta[first])))
    (xc, storage_c, tan_c), (xw, storage_w, tan_w) = curves
    span = min(np.ptp(xc), np.ptp(xw))
    # tan δ varies little where G′ varies much and the other way round: each is weighed by its own range
    scale_s = max(np.ptp(np.concatenate([storage_c, storage_w])), 1e-3)
    scale_t = max(np.ptp(np.concatenate([tan_c, tan_w])), 1e-3)
    best, best_cost = 0.0, np.inf
    for shift in np.arange(xc[0] - xw[-1] + 0.15 * span, xc[-1] - xw[0] - 0.15 * span, 0.01):
        if shift > 0:
            break
        inside = (xw + shift >= xc[0]) & (xw + shift <= xc[-1])
        if np.count_nonzero(inside) < 2:
            continue
        at = xw[inside] + shift
        ds = (np.interp(at, xc, storage_c) - storage_w[inside]) / scale_s
        dt = (np.interp(at, xc, tan_c) - tan_w[inside]) / scale_t
        cost = float(np.mean(ds * ds) + np.mean(dt * dt))
        if cost < best_cost:
            best, best_cost = float(shift), cost
    return best


@dataclass(frozen=True)
class _Refined:
    shifts: Array
    errors: Array
    point_shifts: Array
    residual: tuple[float, float]


class _Refinement:
    """Joint least squares of all shifts, a dense non-negative spectrum being solved for inside."""

    def __init__(self, dma: DMAData, anchor: int, start: Array) -> None:
        self.dma, self.anchor, self.start = dma, anchor, start
        self.T = dma.isotherm_temperatures
        self.free = np.array([k for k in range(start.size) if k != anchor])
        self.within = np.zeros(dma.frequency.size)
        self.tau = self._times(start)
        self._last: tuple[bytes, Strengths] | None = None

    def _times(self, shifts: Array) -> Array:
        omega = 2 * np.pi * self.dma.frequency * 10 ** shifts[self.dma.labels]
        return dense_times(float(omega.min()), float(omega.max()))

    def _shifts(self, theta: Array) -> Array:
        shifts = np.zeros(self.T.size)
        shifts[self.free] = theta
        return shifts

    def _omega(self, theta: Array) -> Array:
        return np.asarray(
            2 * np.pi * self.dma.frequency * 10 ** (self._shifts(theta)[self.dma.labels] + self.within)
        )

    def _stack(self, storage: Array, loss: Array) -> Array:
        return np.vstack([storage / self.dma.storage[:, None], loss / self.dma.loss[:, None]])

    def _solve(self, theta: Array) -> Strengths:
        key = theta.tobytes()
        if self._last is None or self._last[0] != key:
            storage, loss = branch_columns(self._omega(theta), self.tau)
            spring = np.ones((storage.shape[0], 1))
            A = self._stack(np.hstack([spring, storage]), np.hstack([0 * spring, loss]))
            self._last = key, solve_strengths(A, np.ones(A.shape[0]))
        return self._last[1]

    def _residual(self, theta: Array) -> Array:
        return self._solve(theta).residual

    def _jacobian(self, theta: Array) -> Array:
        solution = self._solve(theta)
        storage, loss = branch_slopes(self._omega(theta), self.tau)
        slope = self._stack(*(np.log(10) * (s @ solution.x[1:])[:, None] for s in (storage, loss)))[:, 0]
        owner = np.tile(self.dma.labels, 2)
        columns = np.where(owner[:, None] == self.free, slope[:, None], 0.0)
        return solution.project_out(columns)

    def _scatter(self, theta: Array) -> tuple[float, float]:
        storage, loss = np.split(self._residual(theta), 2)
        return float(np.sqrt(np.mean(storage**2))), float(np.sqrt(np.mean(loss**2)))

    def run(self) -> _Refined:
        theta = self.start[self.free]
        for _ in range(3):
            result = least_squares(
                self._residual,
                theta,
                jac=self._jacobian,
                method="lm",
                x_scale=0.1,
                xtol=1e-6,
                ftol=1e-8,
                max_nfev=40,
            )
            theta = result.x
            self.within = self._within(self._shifts(theta))
            self.tau = self._times(self._shifts(theta))
            self._last = None
        scatter = self._scatter(theta)
        J = self._jacobian(theta)
        freedom = max(1, J.shape[0] - J.shape[1] - self._solve(theta).basis.shape[1])
        variance = float(self._residual(theta) @ self._residual(theta)) / freedom
        errors = np.zeros(self.T.size)
        errors[self.free] = np.sqrt(variance * np.diag(np.linalg.pinv(J.T @ J)))
        shifts = self._shifts(theta)
        return _Refined(shifts, errors, shifts[self.dma.labels] + self.within, scatter)

    def _within(self, shifts: Array) -> Array:
        """What a point's own temperature adds to its isotherm's shift, decades, (n,)."""
        slope = PchipInterpolator(self.T, shifts).derivative()(self.T)
        labels = self.dma.labels
        return np.asarray(slope[labels] * (self.dma.temperature - self.T[labels]))


def _fit_law(
    T: Array, shifts: Array, errors: Array, T_ref: float, law: LawName
) -> tuple[WLF | Arrhenius | ShiftTable, float]:
    """Law through the shifts, decades, and the shift at T_ref it implies."""
    if law == "free":
        table = ShiftTable(tuple(T), tuple(shifts), T_ref)
        offset = float(PchipInterpolator(T, shifts)(T_ref))
        return ShiftTable(table.T, tuple(shifts - offset), T_ref), offset
    if law == "arrhenius":
        x = 1 / (T + ZERO_CELSIUS) - 1 / (T_ref + ZERO_CELSIUS)
        A = np.column_stack([x, np.ones_like(x)])
        (slope, offset), *_ = np.linalg.lstsq(A, shifts, rcond=None)
        misfit = shifts - A @ np.array([slope, offset])
        unit = GAS_CONSTANT * np.log(10)
        variance = float(misfit @ misfit) / max(1, T.size - 2) * float(np.linalg.inv(A.T @ A)[0, 0]) * unit**2
        if not slope > 0:
            raise ValueError("law = 'arrhenius': the shifts do not fall with temperature; take law='free'")
        return Arrhenius(float(slope * unit), float(T_ref), variance if T.size > 2 else None), float(offset)
    return _fit_wlf(T, shifts, T_ref)


def _fit_wlf(T: Array, shifts: Array, T_ref: float) -> tuple[WLF, float]:
    """WLF constants, with covariance, and the shift at T_ref: shifts ≈ offset − C1 x/(C2 + x), x = T −
    T_ref."""
    if T.size < 3:
        raise ValueError(
            f"law = 'wlf' has three constants, the data {T.size} isotherms: take law='arrhenius' or 'free'"
        )
    x = T - T_ref
    lowest = max(1.0, -float(min(x.min(), 0.0)) + 1.0)  # K: the pole stays 1 K below the coldest isotherm

    def residual(p: Array) -> Array:
        return np.asarray(p[0] - p[1] * x / (p[2] + x) - shifts)

    def jacobian(p: Array) -> Array:
        return np.column_stack([np.ones_like(x), -x / (p[2] + x), p[1] * x / (p[2] + x) ** 2])

    best = None
    for C2 in (lowest + 10.0, lowest + 50.0, lowest + 200.0):
        A = np.column_stack([np.ones_like(x), -x / (C2 + x)])
        offset, C1 = np.linalg.lstsq(A, shifts, rcond=None)[0]
        bounds = ([-np.inf, 1e-6, lowest], [np.inf, _STEEPEST, 1e5])
        found = least_squares(
            residual, [offset, max(C1, 0.1), C2], jac=jacobian, bounds=bounds, x_scale=[1, 10, 50]
        )
        if best is None or found.cost < best.cost * (1 - 1e-9):
            best = found
    assert best is not None
    offset, C1, C2 = best.x
    J = jacobian(best.x)
    covariance = None
    if (
        T.size > 3 and C1 < 0.99 * _STEEPEST
    ):  # at its bound the law is a straight line and C1, C2 mean nothing
        full = 2 * best.cost / (T.size - 3) * np.linalg.pinv(J.T @ J)
        covariance = tuple(tuple(float(v) for v in row) for row in full[1:, 1:])
    return WLF(float(C1), float(C2), float(T_ref), covariance), float(offset)
