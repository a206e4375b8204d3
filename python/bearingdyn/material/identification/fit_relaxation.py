"""A Maxwell model fitted to a measured relaxation modulus, in time, by least relative squares."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Literal

import numpy as np
import scipy

from bearingdyn.checks import require, two
from bearingdyn.material.fit_report import FitReport
from bearingdyn.material.maxwell import Maxwell
from bearingdyn.material.relaxation_data import RelaxationData
from bearingdyn.material.relaxation_spectrum import Strengths, dense_times, solve_strengths
from bearingdyn.notice import FewerBranches, warn
from bearingdyn.types import Array

_MOST = 20  # branches tried by n = "auto"
_SPREADS = (0.0, 0.5, -0.5)  # decades by which the starts are wider than the times
_MARGIN = math.log(10.0)  # a relaxation time may lie a decade outside the times
_BAND = "it must be a lower and a higher frequency, both positive, Hz"


def fit_relaxation(
    data: RelaxationData,
    n: int | Literal["auto"],
    band: tuple[float, float] | None,
    *,
    K: float,
    density: float,
    fixed: Mapping[str, float] | None,
    tolerance: float,
) -> Maxwell:
    """Fit a Maxwell model to a measured relaxation modulus: Σ ln²(model/measured) is least, to first order.

    Times before 1/(2π·highest) and after 1/(2π·lowest frequency of `band` are left out. The report's storage
    errors are those of G(t); its errors of tan δ are NaN, no loss having been measured.

    Raises
    ------
    ValueError
        If there are several isotherms, fewer points than unknowns, or anything but G0 is fixed.
    """
    held = dict(fixed or {})
    known = set(held) <= {"G0"} and all(value >= 0 for value in held.values())
    require(known, "fixed", fixed, "of a relaxation only G0 can be fixed, in Pa, zero or positive")
    t, g = _in_shear(data, band, K)
    count = t.size
    least = 2 if n == "auto" else n + 1
    if not count >= least + 1:
        raise ValueError(
            f"{data.source}: {count} points of relaxation; {n} branches and a spring need at least "
            f"{least + 1}"
        )
    spring = held.get("G0")
    floor = _rms(_strengths(t, g, dense_times(1 / t.max(), 1 / t.min(), 12, 1.0), spring).residual)
    counts = range(1, min(_MOST, count - 2) + 1) if n == "auto" else [n]
    best: tuple[float, Array, Strengths] | None = None
    for branches in counts:
        found = min((_search(t, g, branches, spread, spring) for spread in _SPREADS), key=lambda f: f[0])
        if best is None or found[0] < best[0]:
            best = found
        if best[0] <= max(tolerance, 1.2 * floor):
            break
    assert best is not None  # one number is tried at least
    _, tau, solution = best
    G0 = float(solution.x[0]) if spring is None else float(spring)
    G = solution.x[1:] if spring is None else solution.x
    used = G > 0
    order = np.argsort(tau[used])
    tau, G = tau[used][order], G[used][order]
    warn_of_fewer(n, G.size)
    T = float(data.isotherm_temperatures[0])
    report = _report(t, g, G0, G, tau, floor, spring is None)
    return Maxwell(G0, G, tau, 0.0, K=K, density=density, temperature=T, fit=report)


def warn_of_fewer(n: int | Literal["auto"], found: int) -> None:
    """Warn of a fit, to relaxation data or others, that has fewer branches than the n asked for.

    Warns
    -----
    FewerBranches
        With the number that the data hold.
    """
    if n != "auto" and found < n:
        hold = "1 branch" if found == 1 else f"{found or 'no'} branches"
        warn(
            f"n is {n}, and the data hold {hold}: more would have no strength, or change nothing, and are "
            f'left out; ask for n={max(found, 1)}, or n="auto"',
            FewerBranches,
        )


def _in_shear(data: RelaxationData, band: tuple[float, float] | None, K: float) -> tuple[Array, Array]:
    """Times, s, rising, and relaxation moduli in shear, Pa, of the one isotherm."""
    T = data.isotherm_temperatures
    if T.size > 1:
        raise ValueError(
            f"{data.source}: relaxation at {T.size} temperatures, {T[0]:.4g} to {T[-1]:.4g} °C: fit one, "
            f"data.select(T=({T[0] - 1:.4g}, {T[0] + 1:.4g})), or superpose them, master_curve(data)"
        )
    low, high = (0.0, math.inf) if band is None else two("band", band, _BAND)
    if not 0 <= low < high:
        raise ValueError(f"band is {band!r} Hz; it must be a lower and a higher frequency, both positive")
    keep = (data.frequency >= low) & (data.frequency <= high)
    order = np.argsort(data.time[keep], kind="stable")
    t, g = data.time[keep][order], data.relaxation[keep][order]
    if data.mode == "tension":  # quasi-elastic, exact where E is small against K
        if not np.all(g < 9 * K):
            raise ValueError(
                f"K is {K:g} Pa; it must exceed a ninth of the tensile modulus, here {g.max():.4g} Pa"
            )
        g = 3 * K * g / (9 * K - g)
    return t, g


def _strengths(t: Array, g: Array, tau: Array, spring: float | None) -> Strengths:
    branches = np.exp(-t[:, None] / tau) / g[:, None]
    if spring is None:
        return solve_strengths(np.column_stack([1 / g, branches]), np.ones(t.size))
    return solve_strengths(branches, 1 - spring / g)


def _rms(residual: Array) -> float:
    return float(np.sqrt(np.mean(residual**2)))


def _search(
    t: Array, g: Array, n: int, spread: float, spring: float | None
) -> tuple[float, Array, Strengths]:
    """rms relative deviation, relaxation times and strengths from one start, strengths eliminated."""
    low, high = math.log(t[0]), math.log(t[-1])
    inner = (high - low) / (n + 1)
    wide = spread * math.log(10)
    start = (
        np.linspace(low + inner / 2 - wide, high - inner / 2 + wide, n)
        if n > 1
        else np.array([(low + high) / 2])
    )
    bounds = (low - _MARGIN, high + _MARGIN)

    def residual(p: Array) -> Array:
        return _strengths(t, g, np.exp(p), spring).residual

    def jacobian(p: Array) -> Array:
        tau = np.exp(p)
        solution = _strengths(t, g, tau, spring)
        x = t[:, None] / tau
        G = solution.x[1:] if spring is None else solution.x
        return solution.project_out(x * np.exp(-x) * G / g[:, None])

    found = scipy.optimize.least_squares(
        residual,
        np.clip(start, bounds[0] + 1e-9, bounds[1] - 1e-9),
        jac=jacobian,
        bounds=bounds,
        xtol=1e-12,
        ftol=1e-14,
        gtol=1e-14,
        max_nfev=400,
    )
    tau = np.exp(found.x)
    solution = _strengths(t, g, tau, spring)
    return _rms(solution.residual), tau, solution


def _report(t: Array, g: Array, G0: float, G: Array, tau: Array, floor: float, free: bool) -> FitReport:
    """Errors of G(t) and the covariance of the logarithms of the parameters."""
    x = t[:, None] / tau
    parts = np.exp(-x) * G
    model = G0 + parts.sum(axis=1)
    deviation = np.log(model / g)
    columns = [parts / model[:, None], x * parts / model[:, None]]
    names = [f"ln G{k}" for k in range(1, G.size + 1)] + [f"ln tau{k}" for k in range(1, G.size + 1)]
    if free and G0 > 0:
        columns, names = [(G0 / model)[:, None], *columns], ["ln G0", *names]
    J = np.hstack(columns)
    freedom = max(1, t.size - J.shape[1])
    band = (float(1 / (2 * np.pi * t.max())), float(1 / (2 * np.pi * t.min())))
    return FitReport(
        band,
        band,
        t.size,
        _rms(deviation),
        float(np.abs(deviation).max()),
        math.nan,
        math.nan,
        tuple(names),
        float(deviation @ deviation) / freedom * np.linalg.pinv(J.T @ J),
        (floor, math.nan),
    )
