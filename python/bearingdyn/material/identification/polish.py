"""Second stage of a fit: all parameters together, on the deviations the user is told."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy
from numpy.typing import NDArray

from bearingdyn.material.identification.bounds import Limits
from bearingdyn.material.identification.points_in_band import PIN_WEIGHT, Points
from bearingdyn.material.relaxation_spectrum import branch_slopes, unit_columns
from bearingdyn.types import Array, Index


@dataclass(frozen=True)
class Polished:
    """A polished fit: strengths (spring, branches, dashpot), times rising, and the problem around it.

    `names` are those of the columns of `jacobian`, all logarithms; `theta` has their values. Rows are the
    deviations of ln G′, those of ln tan δ, and that of the pin, weighted, if there is one.
    """

    strengths: Array
    tau: Array
    cost: float
    names: tuple[str, ...]
    theta: Array
    residual: Array
    jacobian: Array

    @property
    def deviations(self) -> tuple[Array, Array]:
        """Of ln G′ and of ln tan δ at the points, (p,) each."""
        p = self.residual.size // 2  # a pin is one row more
        return self.residual[:p], self.residual[p : 2 * p]


def polish(points: Points, limits: Limits, tau: Array, strengths: Array) -> Polished:
    """Polish a fit: least squares of the deviations of ln G′ and ln tan δ over all logarithms together.

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
        storage, loss = unit_columns(omega, np.exp(p[:m]))
        return x, storage * x, loss * x

    def residual(theta: Array) -> Array:
        _, storage, loss = columns(theta)
        s, t = storage.sum(axis=1), loss.sum(axis=1)
        held = PIN_WEIGHT * np.log(points.pin_row(np.exp(full(theta)[:m])) @ columns(theta)[0])
        return np.concatenate([np.concatenate([np.log(s), np.log(t / s)]) - target, held])

    def jacobian(theta: Array) -> Array:
        x, storage, loss = columns(theta)
        slope_s, slope_l = branch_slopes(omega, np.exp(full(theta)[:m]))
        ds = np.hstack([slope_s * x[1:-1], storage[:, present]]) / storage.sum(axis=1)[:, None]
        dl = np.hstack([slope_l * x[1:-1], loss[:, present]]) / loss.sum(axis=1)[:, None]
        tau = np.exp(full(theta)[:m])
        row = points.pin_row(tau) * x
        held = np.hstack([points.pin_slope(tau) * x[1:-1], row[:, present]]) / row.sum(axis=1, keepdims=True)
        return np.vstack([ds, dl - ds, PIN_WEIGHT * held])[:, free]

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
