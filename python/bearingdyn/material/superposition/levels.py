"""Levels of runs: the factor of each specimen's moduli that makes one material of all.

Two specimens of one rubber differ by some 5 %: thickness, clamping, age. Where a run ends and the next
begins, such a step looks like a shift, and the shifts leave every law. Runs that share a temperature tell
their levels there, by the moduli at each frequency. Of others the factors sought are those with which the
free shifts follow the law best, the law being fitted anew each time; the first run keeps its level.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import scipy
from numpy.typing import NDArray

from bearingdyn.material.dma import DMAData
from bearingdyn.material.superposition.doubts import GAP
from bearingdyn.material.superposition.free_shifts import Superposed, Superposition, first_shifts
from bearingdyn.material.superposition.law_fit import LawName, constants_of, fit_law
from bearingdyn.material.superposition.shared_temperatures import merged, shared_levels
from bearingdyn.notice import UnequalRuns, warn
from bearingdyn.types import Array

_STEP = 0.02  # of ln level, over which its effect is taken: above the jitter of the shifts, below their bends
_WIDEST = 0.5  # of ln level; specimens of one material do not differ by more
_KNOWN = 0.1  # of ln level, its standard error; beyond, runs do not hold together
_FLOOR = 2e-3  # of ln level: what prior and spacing of the spectrum leave, whatever the scatter
_TOLD, _ERRORS = 0.02, 3.0  # of ln level, and of its standard errors, from which runs disagree


@dataclass(frozen=True)
class Levels:
    """Levels of a measurement's runs: factor of each and its standard error; the first is 1."""

    factors: dict[str, float]
    errors: dict[str, float]


def find_levels(dma: DMAData, T_ref: float, law: LawName, smoothness: float | None) -> Levels | None:
    """Find the levels that make one material of the runs of a measurement; None where there is one run.

    Parameters
    ----------
    dma
        Positive moduli; a run's isotherms at different temperatures.
    T_ref
        °C.
    law
        The law the shifts shall follow; "free" stands for "wlf".
    smoothness
        As in `master_curve`.

    Warns
    -----
    UnequalRuns
        Where runs differ by more than 2 % and three standard errors, and where a run does not hold together
        with the others: it then keeps its level.
    """
    names = dma.runs
    if len(names) < 2:
        return None
    law = "wlf" if law == "free" else law
    run = _numbers_of_runs(dma, names)
    shared = shared_levels(dma, run, len(names))
    # runs that share a temperature are one group from here on
    dma = merged(levelled(dma, run, shared.logs))
    which = shared.group[_numbers_of_runs(dma, names)]
    later = int(shared.group.max())
    T = dma.isotherm_temperatures
    # each law has an offset besides its constants, and a level takes one more
    freedom = T.size - constants_of(law) - 1 - later
    if later and freedom < 1:
        warn(
            f"{dma.source}: {T.size} isotherms of {len(names)} runs do not tell the levels of the runs apart "
            f"from the constants of the {law} law: every run keeps its level; measure more temperatures, "
            f"or give levels={{run: factor}}",
            UnequalRuns,
        )
        return None
    prior = smoothness
    last: Superposed | None = None

    def off(logs: Array) -> Array:
        """Deviation of the free shifts from the law, decades, at these ln levels of the later groups."""
        nonlocal prior, last
        scaled = levelled(dma, which, np.concatenate([[0.0], logs]))
        start = first_shifts(scaled)
        anchor = (T.size - 1) // 2
        fit = Superposition(scaled, start - start[anchor], np.flatnonzero(np.arange(T.size) != anchor))
        last = fit.run(prior, anchor)
        prior = last.smoothness  # one prior for all levels: they are compared
        fitted, offset = fit_law(T, last.shifts, T_ref, law, False)
        return np.asarray(last.shifts - offset - fitted.log_shift(T))

    group_logs, group_errors = np.zeros(later + 1), np.zeros(later + 1)
    apart = np.zeros(later + 1, dtype=bool)
    if later:
        zero = np.zeros(later)
        try:
            off(zero)
            found = scipy.optimize.least_squares(
                off, zero, diff_step=_STEP, x_scale=0.05, bounds=(-_WIDEST, _WIDEST), xtol=1e-3, max_nfev=12
            )
        except ValueError:  # shifts that rise with temperature follow no law
            return None
        J = found.jac
        variance = 2 * found.cost / freedom
        group_errors[1:] = np.sqrt(np.diag(variance * np.linalg.pinv(J.T @ J)) + _FLOOR**2)
        group_logs[1:] = found.x
        off(found.x)
        assert last is not None
        apart = _apart(np.log10(dma.frequency) + last.point_shifts, which)
        apart[1:] |= ~(group_errors[1:] < _KNOWN) | (np.abs(found.x) > 0.99 * _WIDEST)
    errors = np.hypot(shared.errors, group_errors[shared.group])
    errors[0] = 0.0
    logs = shared.logs + group_logs[shared.group]
    loose = apart[shared.group]
    if loose.any():
        told = ", ".join(repr(names[k]) for k in np.flatnonzero(loose))
        warn(
            f"{dma.source}: runs without overlap: nothing tells the level of {told} against "
            f"{names[0]!r}: the curves do not meet, or the shifts follow the law with any level; it stays as "
            f"measured; measure a temperature in both runs, or give levels={{run: factor}}",
            UnequalRuns,
        )
    logs[loose] = shared.logs[loose]
    factors = np.exp(logs)
    own = np.where(loose, np.inf, errors * factors)
    unequal = [
        f"{name!r} {factors[k]:.3f} ± {own[k]:.3f}"
        for k, name in enumerate(names)
        if not loose[k] and abs(logs[k]) > max(_TOLD, _ERRORS * errors[k])
    ]
    if unequal:
        warn(
            f"{dma.source}: runs disagree by more than their scatter: with {names[0]!r} as it is, moduli are "
            f"multiplied by {', '.join(unequal)}, so that all are one material; levels=None leaves them as "
            f"measured. Which run is right, they do not say: check thickness and clamping of the specimens",
            UnequalRuns,
        )
    return Levels(
        dict(zip(names, factors.tolist(), strict=True)), dict(zip(names, own.tolist(), strict=True))
    )


def _numbers_of_runs(dma: DMAData, names: tuple[str, ...]) -> NDArray[np.int64]:
    """(n,) number of each point's run among these."""
    return np.array([names.index(name) for name in dma.run.tolist()], dtype=np.int64)  # type: ignore[union-attr]


def _apart(reduced: Array, which: NDArray[np.int64]) -> NDArray[np.bool_]:
    """Groups (g,) that no chain joins to the first, by log10 of the points' reduced frequency."""
    ends = [(reduced[which == g].min(), reduced[which == g].max()) for g in range(int(which.max()) + 1)]
    met = np.zeros(len(ends), dtype=bool)
    met[0] = True
    for _ in ends:
        for g, (low, high) in enumerate(ends):
            chain = [end for end, joined in zip(ends, met, strict=True) if joined]
            met[g] |= any(low <= end[1] + GAP and end[0] <= high + GAP for end in chain)
    return ~met


def levelled(dma: DMAData, which: NDArray[np.int64], logs: Array) -> DMAData:
    """A measurement levelled: the moduli of its runs, `which` (n,), times exp(logs) of their number."""
    factor = np.exp(logs[which])
    return replace(dma, storage=dma.storage * factor, loss=dma.loss * factor)
