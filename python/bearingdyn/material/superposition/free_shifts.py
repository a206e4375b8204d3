"""Superposition: all shifts at once, a dense non-negative relaxation spectrum being solved for inside.

On a glassy plateau, where the moduli hardly change, sweeps that do not superpose within their noise leave
the shifts to local minima. A prior on the curvature of log10 a_T(T) decides there: it is first strong, then
relaxed only until the data are rendered nearly as well as without it. Its strength starts from the scatter
of the residuals, their correlation within a sweep included, so that clean data are left to themselves. Kinks
are cheap in it (pseudo-Huber), because a shift curve has one at the glass transition.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
import scipy
from numpy.typing import NDArray

from bearingdyn.material.dma import DMAData
from bearingdyn.material.relaxation_spectrum import (
    Strengths,
    branch_columns,
    branch_slopes,
    dense_times,
    solve_strengths,
)
from bearingdyn.material.shift_laws import WLF
from bearingdyn.types import Array

_SEARCH, _FINE = 5, 12  # times per decade while the prior is chosen, and at the end
_LOSS_WEIGHT = 0.42  # of a relative deviation of G″ against one of G′, where the prior is at work
_CURVATURE = 0.07  # decades per (5 K)²; what is usual, for the prior's first strength
_KINK = 0.1  # decades per (5 K)², from which curvature is charged linearly
_ALLOWED = 1.08  # misfit with the prior over that without
_CLOSE = 0.2  # decades
_STRONG, _WEAKER, _RUNGS, _FLAT = 10.0, 1.6, 12, 2e-3


@dataclass(frozen=True)
class Superposed:
    """Free shifts that superpose: decades (k,), (k,), (n,); rms relative misfit of G′ and G″."""

    shifts: Array
    errors: Array
    point_shifts: Array
    misfit: tuple[float, float]
    smoothness: float


class Superposition:
    """Least squares of the relative deviations of G′ and G″ over the free shifts of the isotherms.

    Parameters
    ----------
    dma
        Positive moduli only.
    start
        First guess of the shifts, decades, (k,).
    free
        Numbers of the isotherms whose shift is sought; the others stay at `start`.
    """

    def __init__(self, dma: DMAData, start: Array, free: NDArray[np.int64]) -> None:
        self.dma, self.start, self.free = dma, start, free
        self.T = dma.isotherm_temperatures
        self.within = np.zeros(dma.frequency.size)
        self.density = _FINE
        self.even = np.ones(dma.frequency.size)
        self.light = np.full(dma.frequency.size, _LOSS_WEIGHT)
        self.weight = self.even
        self.tau = self._times(start)
        self._last: tuple[bytes, Strengths] | None = None

    def _times(self, shifts: Array) -> Array:
        omega = 2 * np.pi * self.dma.frequency * 10 ** shifts[self.dma.labels]
        return dense_times(float(omega.min()), float(omega.max()), self.density)

    def shifts(self, theta: Array) -> Array:
        """Shifts of all isotherms for free ones theta."""
        shifts = self.start.copy()
        shifts[self.free] = theta
        return shifts

    def point_shifts(self, shifts: Array) -> Array:
        """Shift of every point, its own temperature considered."""
        return np.asarray(shifts[self.dma.labels] + self.within)

    def _stack(self, storage: Array, loss: Array) -> Array:
        weighed = (self.weight / self.dma.loss)[:, None] * loss
        return np.vstack([storage / self.dma.storage[:, None], weighed])

    def solve(self, point_shifts: Array) -> Strengths:
        """Spectrum, spring first, at these shifts of the points."""
        key = point_shifts.tobytes()
        if self._last is None or self._last[0] != key:
            omega = 2 * np.pi * self.dma.frequency * 10**point_shifts
            storage, loss = branch_columns(omega, self.tau)
            spring = np.ones((omega.size, 1))
            A = self._stack(np.hstack([spring, storage]), np.hstack([0 * spring, loss]))
            target = np.concatenate([self.even, self.weight])
            self._last = key, solve_strengths(A, target)
        return self._last[1]

    def slopes(self, point_shifts: Array, direction: Array) -> Array:
        """Derivative of the residual along changes of the points' shifts, (n, p), strengths following."""
        solution = self.solve(point_shifts)
        omega = 2 * np.pi * self.dma.frequency * 10**point_shifts
        slope = [np.log(10) * (s @ solution.x[1:])[:, None] for s in branch_slopes(omega, self.tau)]
        return solution.project_out(self._stack(slope[0] * direction, slope[1] * direction))

    def deviations(self, point_shifts: Array) -> tuple[Array, Array]:
        """Relative deviation of G′ and of G″ of every point from the spectrum at these shifts, (n,)."""
        storage, loss = np.split(self.solve(point_shifts).residual, 2)
        return storage, loss / self.weight

    def misfit(self, point_shifts: Array) -> tuple[float, float]:
        """rms relative deviation of G′ and of G″."""
        storage, loss = self.deviations(point_shifts)
        return float(np.sqrt(np.mean(storage**2))), float(np.sqrt(np.mean(loss**2)))

    def weigh_evenly(self) -> None:
        """Let relative deviations of G′ and of G″ count alike from now on."""
        self.weight, self._last = self.even, None

    def _owner(self) -> Array:
        return np.where(self.dma.labels[:, None] == self.free, 1.0, 0.0)

    def _minimise(self, theta: Array, prior: float, tolerance: float) -> Array:
        """Free shifts from a start, under a curvature prior."""
        P, owner = _curvature(self.T), self._owner()

        def point(x: Array) -> Array:
            return self.point_shifts(self.shifts(x))

        for _ in range(3 if prior > 0 and P.size else 1):
            bend = P @ self.shifts(theta)
            rows = prior * (1 + (bend / _KINK) ** 2) ** -0.25

            def residual(x: Array, rows: Array = rows) -> Array:
                data = self.solve(point(x)).residual
                return np.concatenate([data, rows * (P @ self.shifts(x))]) if prior > 0 else data

            def jacobian(x: Array, rows: Array = rows) -> Array:
                data = self.slopes(point(x), owner)
                return np.vstack([data, rows[:, None] * P[:, self.free]]) if prior > 0 else data

            found = scipy.optimize.least_squares(
                residual,
                theta,
                jac=jacobian,
                method="lm",
                x_scale=0.1,
                xtol=tolerance,
                ftol=tolerance / 10,
                max_nfev=30,
            )
            theta = found.x
        return np.asarray(theta)

    def _settle(self, theta: Array) -> None:
        """Points placed by their own temperature, relaxation times over what the shifts reach."""
        self.within = self._within(self.shifts(theta))
        self.tau = self._times(self.shifts(theta))
        self._last = None

    def _stage(self, theta: Array, prior: float, rounds: int, tolerance: float) -> Array:
        for _ in range(rounds):
            theta = self._minimise(theta, prior, tolerance)
            self._settle(theta)
        return theta

    def run(self, smoothness: float | None, reference: int) -> Superposed:
        """The shifts; smoothness None chooses the strength of the prior, 0 does without.

        Standard errors are against the isotherm `reference`.
        """
        theta = self.start[self.free]
        if theta.size and smoothness is None and self.T.size > 3:
            smoothness, theta = self._choose(theta)
        smoothness = smoothness or 0.0
        self.weight, self.density = self.light if smoothness > 0 else self.even, _SEARCH
        if smoothness > 0 and theta.size:
            # where the weight of G″ does not matter for the shifts, both moduli count alike
            self.weight = self.even
            self._settle(theta)
            even = self._stage(theta, smoothness, 1, 1e-3)
            if np.abs(even - theta).max() < _CLOSE:
                theta = even
            else:
                self.weight = self.light
        self.density = _FINE
        self._settle(theta)
        if theta.size:
            theta = self._stage(
                theta, smoothness, 2 if smoothness > 0 else 3, 1e-5 if smoothness > 0 else 1e-6
            )
        shifts = self.shifts(theta)
        point = self.point_shifts(shifts)
        errors = np.zeros(self.T.size)
        if theta.size:
            J = self.slopes(point, self._owner())
            J = np.vstack([J, smoothness * _curvature(self.T)[:, self.free]])
            residual = self.solve(point).residual
            freedom = max(1, residual.size - theta.size - self.solve(point).basis.shape[1])
            variance = self._correlation(residual) ** 2 * float(residual @ residual) / freedom
            spread = np.zeros((self.T.size, self.T.size))
            spread[np.ix_(self.free, self.free)] = variance * np.linalg.pinv(J.T @ J)
            own = np.diag(spread)
            errors = np.sqrt(np.maximum(own + own[reference] - 2 * spread[reference], 0.0))
        self.weigh_evenly()
        return Superposed(shifts, errors, point, self.misfit(point), smoothness)

    def _choose(self, theta: Array) -> tuple[float, Array]:
        """Strongest prior, and the shifts with it, that costs at most a tenth of the misfit."""
        self.weight, self.density = self.even, _SEARCH
        self._settle(theta)
        alone = self._stage(theta, 0.0, 2, 1e-4)
        self.weight = self.light
        self._settle(alone)
        residual = self.solve(self.point_shifts(self.shifts(alone))).residual
        floor = float(np.linalg.norm(residual))
        scatter = float(np.sqrt(np.mean(np.split(residual, 2)[0] ** 2)))
        usual = self._correlation(residual) * scatter / _CURVATURE
        theta = self._stage(theta, _STRONG * usual, 1, 1e-3)
        rungs = []
        for prior in usual / _WEAKER ** np.arange(_RUNGS):
            theta = self._stage(theta, float(prior), 1, 1e-3)
            cost = float(np.linalg.norm(self.solve(self.point_shifts(self.shifts(theta))).residual))
            rungs.append((float(prior), cost, theta))
            if len(rungs) > 2 and cost > (1 - _FLAT) * rungs[-3][1]:
                break  # below here the prior no longer matters
        floor = min(floor, *(cost for _, cost, _ in rungs))
        return next(
            ((prior, theta) for prior, cost, theta in rungs if cost <= _ALLOWED * floor), (0.0, alone)
        )

    def _correlation(self, residual: Array) -> float:
        """By how much correlation within sweeps, first order, widens an average of the residuals of G′."""
        labels = self.dma.labels
        order = np.lexsort((self.dma.frequency, labels))
        q = np.split(residual, 2)[0][order]
        same = np.diff(labels[order]) == 0
        rho = float(np.mean((q[1:] * q[:-1])[same]) / np.mean(q * q)) if same.any() and q.any() else 0.0
        rho = min(max(rho, 0.0), 0.97)
        return float(np.sqrt((1 + rho) / (1 - rho)))

    def _within(self, shifts: Array) -> Array:
        """What a point's own temperature adds to its isotherm's shift, decades, (n,)."""
        slope = scipy.interpolate.PchipInterpolator(self.T, shifts).derivative()(self.T)
        labels = self.dma.labels
        return np.asarray(slope[labels] * (self.dma.temperature - self.T[labels]))


def _curvature(T: Array) -> Array:
    """Second divided differences over the isotherms, to a spacing of 5 K: (k − 2, k)."""
    first = np.diff(np.eye(T.size), axis=0) / np.diff(T)[:, None]
    return np.asarray(np.diff(first, axis=0) / ((T[2:] - T[:-2]) / 2)[:, None] * 25.0)


def first_shifts(dma: DMAData) -> Array:
    """First guess of the free shifts, decades, (k,), the coldest at zero.

    From the overlap of neighbours; by the best of a grid of WLF laws where neighbours barely overlap.
    """
    T = dma.isotherm_temperatures
    pairs = [_overlap_shift(cold, warm) for cold, warm in pairwise(dma.isotherms)]
    shifts = np.concatenate([[0.0], np.cumsum([shift for shift, _ in pairs])])
    if all(joined for _, joined in pairs):
        return shifts
    fit = Superposition(dma, shifts, np.array([], dtype=np.int64))
    fit.density = 3
    return min([shifts, *_wlf_grid(T)], key=_cost(fit))


def _wlf_grid(T: Array) -> list[Array]:
    """Shifts by WLF laws referred to the coldest isotherm, over the constants polymers have."""
    laws = [
        WLF(C1, C2, float(T[0]))
        for C1 in (2.0, 4.0, 8.0, 12.0, 17.44, 25.0)
        for C2 in (25.0, 51.6, 100.0, 200.0)
    ]
    return [law.log_shift(T) for law in laws]


def _cost(fit: Superposition) -> Callable[[Array], float]:
    def cost(shifts: Array) -> float:
        fit.tau, fit._last = fit._times(shifts), None
        return float(np.linalg.norm(fit.solve(shifts[fit.dma.labels]).residual))

    return cost


def _overlap_shift(cold: DMAData, warm: DMAData) -> tuple[float, bool]:
    """Shift of the warm isotherm against the cold one, decades, ≤ 0, that best joins ln G′ and ln tan δ,
    and whether their storage moduli overlap."""
    curves = []
    for sweep in (cold, warm):
        x, first = np.unique(np.log10(sweep.frequency), return_index=True)
        curves.append((x, np.log(sweep.storage[first]), np.log(sweep.tan_delta[first])))
    (xc, storage_c, tan_c), (xw, storage_w, tan_w) = curves
    span = min(np.ptp(xc), np.ptp(xw))
    common = min(storage_c.max(), storage_w.max()) - max(storage_c.min(), storage_w.min())
    joined = bool(common > 0.1 * min(np.ptp(storage_c), np.ptp(storage_w)))
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
    return best, joined
