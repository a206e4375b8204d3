"""Levels of runs: the factor of each specimen's moduli that makes one material of all.

Two specimens of one rubber differ by some 5 %: thickness, clamping, age. Where a run ends and the next
begins, such a step looks like a shift, and the shifts leave every law. The factors sought are those with
which the free shifts follow the law best, the law being fitted anew each time; the first run keeps its level.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import scipy
from numpy.typing import NDArray

from bearingdyn.material.dma import DMAData
from bearingdyn.material.superposition.free_shifts import Superposition, first_shifts
from bearingdyn.material.superposition.law_fit import LawName, constants_of, fit_law
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
        Positive moduli, isotherms at different temperatures.
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
    T = dma.isotherm_temperatures
    # each law has an offset besides its constants, and a level takes one more
    freedom = T.size - constants_of(law) - 1 - (len(names) - 1)
    which = np.array([names.index(name) for name in dma.run.tolist()])  # type: ignore[union-attr]
    if freedom < 1:
        warn(
            f"{dma.source}: {T.size} isotherms of {len(names)} runs do not tell the levels of the runs apart "
            f"from the constants of the {law} law: every run keeps its level; measure more temperatures, "
            f"or give levels={{run: factor}}",
            UnequalRuns,
        )
        return None
    prior = smoothness

    def off(logs: Array) -> Array:
        """Deviation of the free shifts from the law, decades, at these ln levels of the later runs."""
        nonlocal prior
        scaled = levelled(dma, which, np.concatenate([[0.0], logs]))
        start = first_shifts(scaled)
        anchor = (T.size - 1) // 2
        fit = Superposition(scaled, start - start[anchor], np.flatnonzero(np.arange(T.size) != anchor))
        found = fit.run(prior, anchor)
        prior = found.smoothness  # one prior for all levels: they are compared
        fitted, offset = fit_law(T, found.shifts, T_ref, law, False)
        return np.asarray(found.shifts - offset - fitted.log_shift(T))

    zero = np.zeros(len(names) - 1)
    try:
        off(zero)
        found = scipy.optimize.least_squares(
            off, zero, diff_step=_STEP, x_scale=0.05, bounds=(-_WIDEST, _WIDEST), xtol=1e-3, max_nfev=12
        )
    except ValueError:  # shifts that rise with temperature follow no law
        return None
    J = found.jac
    variance = 2 * found.cost / freedom
    errors = np.sqrt(np.diag(variance * np.linalg.pinv(J.T @ J)) + _FLOOR**2)
    logs = found.x.copy()
    loose = [
        names[k + 1] for k in range(logs.size) if not errors[k] < _KNOWN or abs(logs[k]) > 0.99 * _WIDEST
    ]
    if loose:
        warn(
            f"{dma.source}: runs without overlap: nothing tells the level of {', '.join(map(repr, loose))} "
            f"against {names[0]!r} (its standard error is {errors.max():.2g}); it stays as measured; "
            f"measure a temperature in both runs, or give levels={{run: factor}}",
            UnequalRuns,
        )
    keep = np.array([name in loose for name in names[1:]])
    logs[keep] = 0.0
    factors = np.exp(np.concatenate([[0.0], logs]))
    own = np.concatenate([[0.0], np.where(keep, np.inf, errors * np.exp(logs))])
    apart = [
        f"{name!r} {factors[k]:.3f} ± {own[k]:.3f}"
        for k, name in enumerate(names)
        if k and abs(logs[k - 1]) > max(_TOLD, _ERRORS * errors[k - 1])
    ]
    if apart:
        warn(
            f"{dma.source}: runs disagree by more than their scatter: with {names[0]!r} as it is, moduli are "
            f"multiplied by {', '.join(apart)}, so that all are one material; levels=None leaves them as "
            f"measured. Which run is right, they do not say: check thickness and clamping of the specimens",
            UnequalRuns,
        )
    return Levels(
        dict(zip(names, factors.tolist(), strict=True)), dict(zip(names, own.tolist(), strict=True))
    )


def levelled(dma: DMAData, which: NDArray[np.int64], logs: Array) -> DMAData:
    """A measurement levelled: the moduli of its runs, `which` (n,), times exp(logs) of their number."""
    factor = np.exp(logs[which])
    return replace(dma, storage=dma.storage * factor, loss=dma.loss * factor)
