"""A Maxwell model with few branches fitted to a master curve.

Two stages. First the relaxation times are sought by variable projection on the relative deviations of G′ and
G″, the strengths being a non-negative least-squares problem inside, from a few fixed starts. Then everything
is polished on the deviations of ln G′ and ln tan δ, which are what the user is told.
"""

from __future__ import annotations

import math
import warnings
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import least_squares

from bearingdyn.material.maxwell import FitReport, Maxwell
from bearingdyn.material.spectrum import Strengths, branch_columns, branch_slopes, solve_strengths
from bearingdyn.material.tts import MasterCurve

Array = NDArray[np.float64]

_MARGIN = math.log(10.0)  # a relaxation time may lie a decade outside the band


def fit_maxwell(
    master: MasterCurve,
    n: int = 5,
    band: tuple[float, float] | None = None,
    *,
    K: float,
    density: float,
    dashpot: bool = True,
) -> Maxwell:
    """Fit spring, n branches and dashpot to the points of a master curve inside a band.

    Parameters
    ----------
    master
        Master curve; one measured in tension is turned into shear by G* = 3KE*/(9K − E*).
    n
        Number of branches; those the data give no strength are left out of the result.
    band
        Lowest and highest frequency at T_ref, Hz; all points when not given.
    K
        Bulk modulus, Pa.
    density
        Mass density, kg/m³.
    dashpot
        Whether η0 is fitted too; else it is zero.

    Returns
    -------
    Maxwell
        Relaxation times rising; `fit` reports the errors inside the band and the covariance; `law` is the
        master curve's, so that ``.at(T)`` works. The same data give the same model, bit for bit.

    Raises
    ------
    ValueError
        If the band is not one, holds too few points, or a value is out of range.

    Reference: paper §3.2, eqs 18 and 19.
    """
    if not (isinstance(n, int) and n >= 1):
        raise ValueError(f"n = {n!r}: the number of branches must be a positive integer")
    for name, value in (("K", K), ("density", density)):
        if not (value > 0 and math.isfinite(value)):
            raise ValueError(f"{name} = {value!r}: must be positive and finite")
    data = _Data.inside(master, band, K, n)
    guesses = [_Projection(data, n, dashpot).run(spread) for spread in (0.0, 0.4, -0.3)]
    polished = [_polish(data, tau, strengths) for tau, strengths in guesses]
    best = min(polished, key=lambda p: p.cost)
    order = np.argsort(best.tau)
    report = _report(data, best)
    return Maxwell(
        best.G0,
        best.G[order],
        best.tau[order],
        best.eta0,
        K=K,
        density=density,
        law=master.law,
        temperature=master.T_ref,
        fit=report,
    )


@dataclass(frozen=True)
class _Data:
    """Points inside the band: ω rad/s, shear moduli Pa."""

    omega: Array
    storage: Array
    loss: Array
    band: tuple[float, float]

    @classmethod
    def inside(cls, master: MasterCurve, band: tuple[float, float] | None, K: float, n: int) -> _Data:
        low, high = float(master.frequency[0]), float(master.frequency[-1])
        if band is None:
            band = (low, high)
        f_lo, f_hi = float(band[0]), float(band[1])
        if not 0 < f_lo < f_hi < math.inf:
            raise ValueError(f"band = {band!r} Hz: must be a lower and a higher frequency, both positive")
        keep = (master.frequency >= f_lo) & (master.frequency <= f_hi)
        points = int(np.count_nonzero(keep))
        if not points >= n + 2:
            raise ValueError(
                f"band = {f_lo:g} to {f_hi:g} Hz holds {points} points of the master curve, which reaches "
                "from "
                f"{low:.4g} to {high:.4g} Hz: {n} branches need at least {n + 2}"
            )
        if not (f_lo >= 0.5 * low and f_hi <= 2 * high):
            warnings.warn(
                f"band = {f_lo:g} to {f_hi:g} Hz goes beyond the master curve, {low:.4g} to {high:.4g} Hz: "
                "outside it the model is an extrapolation",
                stacklevel=3,
            )
        modulus = master.storage[keep] + 1j * master.loss[keep]
        if master.mode == "tension":
            if not np.all(modulus.real < 9 * K):
                raise ValueError(
                    f"K = {K:g} Pa: must exceed a ninth of the tensile modulus, here "
                    f"{modulus.real.max():.4g} Pa"
                )
            modulus = 3 * K * modulus / (9 * K - modulus)
        return cls(2 * np.pi * master.frequency[keep], modulus.real, modulus.imag, (f_lo, f_hi))

    @property
    def limits(self) -> tuple[float, float]:
        """ln of the shortest and the longest relaxation time the band can tell, s."""
        f_lo, f_hi = self.band
        return -math.log(2 * math.pi * f_hi) - _MARGIN, -math.log(2 * math.pi * f_lo) + _MARGIN


class _Projection:
    """Relaxation times by variable projection; strengths in the order spring, branches, dashpot."""

    def __init__(self, data: _Data, n: int, dashpot: bool) -> None:
        self.data, self.n, self.dashpot = data, n, dashpot
        self._last: tuple[bytes, Strengths] | None = None

    def _stack(self, storage: Array, loss: Array) -> Array:
        return np.vstack([storage / self.data.storage[:, None], loss / self.data.loss[:, None]])

    def _solve(self, theta: Array) -> Strengths:
        key = theta.tobytes()
        if self._last is None or self._last[0] != key:
            omega = self.data.omega
            storage, loss = branch_columns(omega, np.exp(theta))
            one, none = np.ones((omega.size, 1)), np.zeros((omega.size, 1))
            storage, loss = np.hstack([one, storage]), np.hstack([none, loss])
            if self.dashpot:
                storage, loss = np.hstack([storage, none]), np.hstack([loss, omega[:, None]])
            A = self._stack(storage, loss)
            self._last = key, solve_strengths(A, np.ones(A.shape[0]))
        return self._last[1]

    def _residual(self, theta: Array) -> Array:
        return self._solve(theta).residual

    def _jacobian(self, theta: Array) -> Array:
        solution = self._solve(theta)
        storage, loss = branch_slopes(self.data.omega, np.exp(theta))
        G = solution.x[1 : self.n + 1]
        return solution.project_out(self._stack(storage * G, loss * G))

    def run(self, spread: float) -> tuple[Array, Array]:
        """Times and strengths from a start equispaced over the band, widened by `spread` decades on both
        sides."""
        low, high = self.data.limits
        margin = _MARGIN * (1 - spread)
        edges = np.linspace(low + margin, high - margin, self.n + 1)
        start = (edges[:-1] + edges[1:]) / 2
        found = least_squares(
            self._residual, start, jac=self._jacobian, bounds=(low, high), xtol=1e-8, ftol=1e-10, max_nfev=150
        )
        x = self._solve(found.x).x
        return np.exp(found.x), x if self.dashpot else np.append(x, 0.0)


@dataclass(frozen=True)
class _Polished:
    G0: float
    G: Array
    tau: Array
    eta0: float
    cost: float
    names: tuple[str, ...]
    residual: Array
    jacobian: Array


def _polish(data: _Data, tau: Array, strengths: Array) -> _Polished:
    """Least squares of the deviations of ln G′ and ln tan δ over the logarithms of all that is not zero."""
    omega, low, high = data.omega, *data.limits
    active = strengths[1:-1] > 1e-9 * strengths[1:-1].max(initial=0.0)
    tau, m = tau[active], int(np.count_nonzero(active))
    has_spring, has_dashpot = bool(strengths[0] > 0), bool(strengths[-1] > 0)
    target = np.concatenate([np.log(data.storage), np.log(data.loss / data.storage)])
    spring, dashpot = np.ones((omega.size, 1)) * has_spring, omega[:, None] * has_dashpot
    none = np.zeros((omega.size, 1))
    used = np.concatenate([[has_spring], np.ones(m, bool), [has_dashpot]])

    def columns(theta: Array) -> tuple[Array, Array, Array]:
        x = np.zeros(m + 2)
        x[used] = np.exp(theta[m:])
        storage, loss = branch_columns(omega, np.exp(theta[:m]))
        return x, np.hstack([spring, storage, none]) * x, np.hstack([none, loss, dashpot]) * x

    def residual(theta: Array) -> Array:
        _, storage, loss = columns(theta)
        s, t = storage.sum(axis=1), loss.sum(axis=1)
        return np.asarray(np.concatenate([np.log(s), np.log(t / s)]) - target)

    def jacobian(theta: Array) -> Array:
        x, storage, loss = columns(theta)
        slope_s, slope_l = branch_slopes(omega, np.exp(theta[:m]))
        ds = np.hstack([slope_s * x[1 : m + 1], storage[:, used]]) / storage.sum(axis=1)[:, None]
        dl = np.hstack([slope_l * x[1 : m + 1], loss[:, used]]) / loss.sum(axis=1)[:, None]
        return np.vstack([ds, dl - ds])

    kept = strengths[np.concatenate([[has_spring], active, [has_dashpot]])]
    start = np.concatenate([np.clip(np.log(tau), low, high), np.log(kept)])
    lower = np.concatenate([np.full(m, low), np.full(start.size - m, -np.inf)])
    upper = np.concatenate([np.full(m, high), np.full(start.size - m, np.inf)])
    found = least_squares(
        residual,
        start,
        jac=jacobian,
        bounds=(lower, upper),
        x_scale="jac",
        xtol=1e-10,
        ftol=1e-12,
        max_nfev=300,
    )
    x = columns(found.x)[0]
    names = [f"ln tau{i + 1}" for i in range(m)]
    names += ["ln G0"] * has_spring + [f"ln G{i + 1}" for i in range(m)] + ["ln eta0"] * has_dashpot
    return _Polished(
        float(x[0]),
        x[1 : m + 1],
        np.exp(found.x[:m]),
        float(x[-1]),
        float(found.cost),
        tuple(names),
        found.fun,
        jacobian(found.x),
    )


def _report(data: _Data, best: _Polished) -> FitReport:
    """Errors inside the band and the covariance of the parameters, branches in rising order of time."""
    order = np.argsort(best.tau)
    m = order.size
    spring = best.names.count("ln G0")
    last = np.arange(2 * m + spring, len(best.names))
    J = best.jacobian[:, np.concatenate([order, np.arange(m, m + spring), m + spring + order, last])]
    freedom = max(1, J.shape[0] - J.shape[1])
    covariance = float(best.residual @ best.residual) / freedom * np.linalg.pinv(J.T @ J)
    storage, tan_delta = np.split(best.residual, 2)
    return FitReport(
        data.band,
        data.omega.size,
        float(np.sqrt(np.mean(storage**2))),
        float(np.abs(storage).max()),
        float(np.sqrt(np.mean(tan_delta**2))),
        float(np.abs(tan_delta).max()),
        best.names,
        covariance,
    )
