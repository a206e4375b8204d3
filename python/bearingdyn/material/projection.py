"""The two stages of a Maxwell fit: relaxation times by variable projection, then all parameters together."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
import scipy
from numpy.typing import NDArray

from bearingdyn.material.spectrum import (
    Strengths,
    branch_columns,
    branch_slopes,
    dense_times,
    solve_strengths,
)
from bearingdyn.types import Array, Complex, Index

MARGIN = math.log(10.0)  # a relaxation time may lie a decade outside the band


@dataclass(frozen=True)
class Points:
    """Points inside the band: ω rad/s, shear moduli Pa, number of the isotherm; the band, Hz."""

    omega: Array
    storage: Array
    loss: Array
    isotherm: NDArray[np.int64]
    band: tuple[float, float]

    @property
    def limits(self) -> tuple[float, float]:
        """ln of the shortest and the longest relaxation time the band can tell, s."""
        f_lo, f_hi = self.band
        return -math.log(2 * math.pi * f_hi) - MARGIN, -math.log(2 * math.pi * f_lo) + MARGIN

    def take(self, index: NDArray[np.int64]) -> Points:
        """These points, repeated ones counting twice."""
        return Points(
            self.omega[index], self.storage[index], self.loss[index], self.isotherm[index], self.band
        )

    def stack(self, storage: Array, loss: Array) -> Array:
        """Rows of G′ over those of G″, relative to what was measured."""
        return np.vstack([storage / self.storage[:, None], loss / self.loss[:, None]])

    def deviations(self, modulus: Complex) -> tuple[Array, Array]:
        """ln(model/measured) of G′ and of tan δ."""
        tan = np.log(modulus.imag / modulus.real) - np.log(self.loss / self.storage)
        return np.log(modulus.real / self.storage), tan

    def dense(self, per_decade: int = 12) -> tuple[Array, Array]:
        """Times of a dense spectrum, a decade beyond the points, and strengths: spring, branches, dashpot."""
        tau = dense_times(float(self.omega.min()), float(self.omega.max()), per_decade, 1.0)
        storage, loss = branch_columns(self.omega, tau)
        one, none = np.ones((self.omega.size, 1)), np.zeros((self.omega.size, 1))
        A = self.stack(np.hstack([one, storage, none]), np.hstack([none, loss, self.omega[:, None]]))
        relative, lossy = np.split(A, 2)
        # to first order the deviations of ln G′ and ln tan δ, linear in the strengths
        target = np.concatenate([np.ones(self.omega.size), np.zeros(self.omega.size)])
        return tau, solve_strengths(np.vstack([relative, lossy - relative]), target).x

    def floor(self) -> tuple[float, float]:
        """rms deviation of ln G′ and ln tan δ of the best dense non-negative spectrum."""
        tau, x = self.dense()
        storage, loss = branch_columns(self.omega, tau)
        modulus = x[0] + storage @ x[1:-1] + 1j * (loss @ x[1:-1] + self.omega * x[-1])
        ds, dt = self.deviations(modulus)
        return float(np.sqrt(np.mean(ds**2))), float(np.sqrt(np.mean(dt**2)))


@dataclass(frozen=True)
class Limits:
    """Bounds of the strengths (spring, branches, dashpot; n + 2) and of ln τ (n); equal where fixed."""

    lower: Array
    upper: Array
    log_lower: Array
    log_upper: Array

    @classmethod
    def of(
        cls,
        n: int,
        span: tuple[float, float],
        bounds: Mapping[str, tuple[float, float]],
        fixed: Mapping[str, float],
    ) -> Limits:
        """From bounds and fixed values by name: G0, G1 …, tau1 …, eta0; SI units.

        ValueError naming a parameter that does not exist, a range that is none, or a value out of range.
        """
        strengths = ["G0", *(f"G{i + 1}" for i in range(n)), "eta0"]
        times = [f"tau{i + 1}" for i in range(n)]
        lower, upper = np.zeros(n + 2), np.full(n + 2, np.inf)
        log_lower, log_upper = np.full(n, span[0]), np.full(n, span[1])
        both = set(bounds) & set(fixed)
        if both:
            raise ValueError(f"{sorted(both)}: both in bounds and in fixed: give one")
        wanted = {name: tuple(pair) for name, pair in bounds.items()}
        wanted |= {name: (value, value) for name, value in fixed.items()}
        for name, pair in wanted.items():
            what = "fixed" if name in fixed else "bounds"
            if name not in strengths and name not in times:
                raise ValueError(
                    f"{what}: {name!r} is no parameter: there are {', '.join(strengths + times)}"
                )
            if len(pair) != 2 or not 0 <= pair[0] <= pair[1] or math.isnan(pair[1]) or math.isinf(pair[0]):
                raise ValueError(
                    f"{what}[{name!r}] is {pair!r}; it must be a lower and an upper value, both >= 0"
                )
            if name in strengths:
                lower[strengths.index(name)], upper[strengths.index(name)] = pair
            else:
                if not pair[1] > 0 or (name in fixed and not pair[0] > 0):
                    raise ValueError(f"{what}[{name!r}] is {pair!r} s; a relaxation time must be positive")
                i = times.index(name)
                log_lower[i] = math.log(pair[0]) if pair[0] > 0 else min(span[0], math.log(pair[1]) - 1)
                log_upper[i] = math.log(pair[1]) if math.isfinite(pair[1]) else max(span[1], log_lower[i])
        return cls(lower, upper, log_lower, log_upper)


class Projection:
    """Relaxation times by variable projection; strengths in the order spring, branches, dashpot."""

    def __init__(self, points: Points, limits: Limits) -> None:
        self.points, self.limits = points, limits
        self.free = limits.log_upper > limits.log_lower
        self._last: tuple[bytes, Strengths] | None = None

    def _times(self, theta: Array) -> Array:
        log_tau = self.limits.log_lower.copy()
        log_tau[self.free] = theta
        return np.asarray(np.exp(log_tau))

    def _solve(self, theta: Array) -> Strengths:
        key = theta.tobytes()
        if self._last is None or self._last[0] != key:
            omega = self.points.omega
            storage, loss = branch_columns(omega, self._times(theta))
            one, none = np.ones((omega.size, 1)), np.zeros((omega.size, 1))
            A = self.points.stack(np.hstack([one, storage, none]), np.hstack([none, loss, omega[:, None]]))
            found = solve_strengths(A, np.ones(A.shape[0]), self.limits.lower, self.limits.upper)
            self._last = key, found
        return self._last[1]

    def _jacobian(self, theta: Array) -> Array:
        solution = self._solve(theta)
        storage, loss = branch_slopes(self.points.omega, self._times(theta))
        G = solution.x[1:-1]
        return solution.project_out(self.points.stack(storage * G, loss * G))[:, self.free]

    def run(self, spread: float) -> tuple[Array, Array]:
        """Times and strengths from a start equispaced over the band, widened by `spread` decades on both
        sides."""
        low, high = self.points.limits
        margin = MARGIN * (1 - spread)
        edges = np.linspace(low + margin, high - margin, self.free.size + 1)
        lower, upper = self.limits.log_lower[self.free], self.limits.log_upper[self.free]
        start = np.clip(((edges[:-1] + edges[1:]) / 2)[self.free], lower, upper)
        if start.size:
            start = scipy.optimize.least_squares(
                lambda theta: self._solve(theta).residual,
                start,
                jac=self._jacobian,
                bounds=(lower, upper),
                xtol=1e-8,
                ftol=1e-10,
                max_nfev=150,
            ).x
        return self._times(start), self._solve(start).x


@dataclass(frozen=True)
class Polished:
    """A fit: strengths (spring, branches, dashpot), times in rising order, and the problem around it.

    `names` are those of the columns of `jacobian` (2 p, free parameters), all logarithms;
    `theta` has their values.
    """

    strengths: Array
    tau: Array
    cost: float
    names: tuple[str, ...]
    theta: Array
    residual: Array
    jacobian: Array


def polish(points: Points, limits: Limits, tau: Array, strengths: Array) -> Polished:
    """Least squares of the deviations of ln G′ and ln tan δ over the logarithms of all that is not zero.

    A branch without strength is left out, unless its strength is bounded from below.
    """
    order = np.argsort(tau, kind="stable")
    place = np.concatenate([[0], 1 + order, [tau.size + 1]])
    tau, strengths = tau[order], strengths[place]
    lower, upper = limits.lower[place], limits.upper[place]
    log_lower, log_upper = limits.log_lower[order], limits.log_upper[order]
    # Pa and Pa s do not compare: the dashpot is judged by its share at the top of the band
    share = strengths.copy()
    share[-1] *= points.omega.max()
    used = (share > 1e-9 * share.max()) | (lower > 0)
    branch = used[1:-1]
    tau, log_lower, log_upper = tau[branch], log_lower[branch], log_upper[branch]
    m, omega = tau.size, points.omega
    one, none = np.ones((omega.size, 1)), np.zeros((omega.size, 1))
    with np.errstate(divide="ignore"):
        low = np.concatenate([log_lower, np.log(np.maximum(lower[used], 1e-12 * strengths[used]))])
        high = np.concatenate([log_upper, np.log(upper[used])])
    first = np.concatenate([np.log(tau), np.log(np.maximum(strengths[used], lower[used]))])
    first = np.clip(first, low, high)
    free = high > low
    target = np.concatenate([np.log(points.storage), np.log(points.loss / points.storage)])
    kept = np.concatenate([[0], 1 + np.flatnonzero(branch), [strengths.size - 1]])
    present = used[kept]

    def full(theta: Array) -> Array:
        return _filled(first, free, theta)

    def columns(theta: Array) -> tuple[Array, Array, Array]:
        p = full(theta)
        x = np.zeros(m + 2)
        x[present] = np.exp(p[m:])
        storage, loss = branch_columns(omega, np.exp(p[:m]))
        return x, np.hstack([one, storage, none]) * x, np.hstack([none, loss, omega[:, None]]) * x

    def residual(theta: Array) -> Array:
        _, storage, loss = columns(theta)
        s, t = storage.sum(axis=1), loss.sum(axis=1)
        return np.asarray(np.concatenate([np.log(s), np.log(t / s)]) - target)

    def jacobian(theta: Array) -> Array:
        x, storage, loss = columns(theta)
        slope_s, slope_l = branch_slopes(omega, np.exp(full(theta)[:m]))
        ds = np.hstack([slope_s * x[1:-1], storage[:, present]]) / storage.sum(axis=1)[:, None]
        dl = np.hstack([slope_l * x[1:-1], loss[:, present]]) / loss.sum(axis=1)[:, None]
        return np.vstack([ds, dl - ds])[:, free]

    theta = first[free]
    if theta.size:
        theta = scipy.optimize.least_squares(
            residual,
            theta,
            jac=jacobian,
            bounds=(low[free], high[free]),
            x_scale="jac",
            xtol=1e-10,
            ftol=1e-12,
            max_nfev=300,
        ).x
    x = columns(theta)[0]
    tau = np.exp(full(theta)[:m])
    share = x.copy()
    share[-1] *= omega.max()
    gone = present & (share <= 1e-9 * share.max()) & (lower[kept] == 0)
    if gone.any():  # at its bound: without it
        x[gone] = 0.0
        left = Limits(lower[kept], upper[kept], log_lower, log_upper)
        return polish(points, left, tau, x)
    order = np.argsort(tau, kind="stable")
    rank = np.argsort(order)
    names = [f"ln tau{rank[i] + 1}" for i in range(m)]
    names += [f"ln {name}" for name, there in zip(_strength_names(rank), present, strict=True) if there]
    free_names = [name for name, is_free in zip(names, free, strict=True) if is_free]
    column = sorted(range(len(free_names)), key=lambda i: _sort_key(free_names[i]))
    r = residual(theta)
    return Polished(
        np.concatenate([x[:1], x[1:-1][order], x[-1:]]),
        tau[order],
        float(r @ r) / 2,
        tuple(free_names[i] for i in column),
        theta[column],
        r,
        jacobian(theta)[:, column],
    )


def _filled(first: Array, free: NDArray[np.bool_], theta: Array) -> Array:
    p = first.copy()
    p[free] = theta
    return p


def _strength_names(rank: Index) -> list[str]:
    return ["G0", *(f"G{r + 1}" for r in rank), "eta0"]


def _sort_key(name: str) -> tuple[int, int]:
    """Times, spring, branches, dashpot; each by number."""
    if name == "ln eta0":
        return 3, 0
    digits = int("".join(c for c in name if c.isdigit()))
    return (0, digits) if "tau" in name else (1 if digits == 0 else 2, digits)
