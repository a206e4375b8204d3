"""What a finished superposition leaves doubtful: a law that misses its shifts, zigzags, mixed runs."""

from __future__ import annotations

import numpy as np

from bearingdyn.material.dma import DMAData
from bearingdyn.notice import MixedRuns, OddPoints, PoorLaw, UnevenShifts, warn
from bearingdyn.types import Array

_LAW_MISFIT = 0.3  # decades rms, beyond which a law misleads: a factor of two in frequency
_TIMES_ERROR, _NOTICED = (
    10.0,
    0.02,
)  # of the shifts' own errors; decades, 5 % in frequency, that matter at all
_TIMES_MISFIT = 2.0  # misfit of the moduli by the law over that by the shifts
_UNEVEN = 2.0  # a step against its neighbours' rates, which through Tg change less between isotherms
GAP = 0.3  # decades without a point between isotherms; inside sweeps points stand 0.2 to 0.3 apart
_APART, _TIMES_SCATTER, _SHOWN = 0.1, 10.0, 3  # a deviation that no scatter makes; how many are named
_UNEVEN_DECADES = 0.15  # by which a step must stand out; steps are known to a tenth of a decade


def doubt_law(
    source: str,
    law: str,
    residual: float,
    error: float,
    by_law: tuple[float, float],
    by_shifts: tuple[float, float],
) -> None:
    """Doubt a law: warn where it renders the shifts far worse than they are known.

    Parameters
    ----------
    residual, error
        rms deviation of the shifts from the law, and their own rms standard error, decades.
    by_law, by_shifts
        rms relative misfit of G′ and of G″, shifted by the law and by the shifts.
    """
    worse = float(np.hypot(*by_law) / max(np.hypot(*by_shifts), 1e-12))
    far = residual > _NOTICED and (residual > _TIMES_ERROR * error or worse > _TIMES_MISFIT)
    if residual < _LAW_MISFIT and not far:
        return
    warn(
        f"{source}: the shifts deviate from the {law} law by {residual:.2g} decades rms, their own standard "
        f"error is {error:.2g}; shifted by the law the moduli miss one causal material by {by_law[0]:.2%} "
        "of G' "
        f'and {by_law[1]:.2%} of G", by the shifts {by_shifts[0]:.2%} and {by_shifts[1]:.2%}: a WLF or '
        "Arrhenius law does not hold through a glass transition; take another law, 'joined' or 'free', or "
        "fewer isotherms",
        PoorLaw,
    )


def doubt_steps(source: str, T: Array, shifts: Array) -> None:
    """Doubt shifts, decades at T °C: warn where they zigzag or rise, naming the temperatures."""
    step = np.diff(shifts)
    rate = step / np.diff(T)
    odd = step > _UNEVEN_DECADES
    for k in range(1, step.size - 1):
        near, far = sorted((abs(rate[k - 1]), abs(rate[k + 1])))
        expected = near if abs(rate[k]) < near else far
        stands_out = abs(rate[k] - np.sign(rate[k]) * expected) * (T[k + 1] - T[k]) > _UNEVEN_DECADES
        odd[k] |= stands_out and (abs(rate[k]) < near / _UNEVEN or abs(rate[k]) > _UNEVEN * far)
    if not odd.any():
        return
    # the neighbours show what a step stands out of
    shown = [k for k in range(step.size) if odd[max(0, k - 1) : k + 2].any()]
    steps = ", ".join(f"{-step[k]:.3g} from {T[k]:.4g} to {T[k + 1]:.4g} °C" for k in shown)
    warn(
        f"{source}: the shifts of neighbouring isotherms do not follow one curve: decades {steps}: an "
        "isotherm there is shifted wrongly, or belongs to another specimen; leave it out, give its shift by "
        "hand (shifts={T: ...}), or measure it again",
        UnevenShifts,
    )


def doubt_gaps(dma: DMAData, shifts: Array) -> None:
    """Doubt shifts, decades of each point: warn where neighbouring isotherms, shifted, do not meet."""
    reduced = np.log10(dma.frequency) + shifts
    ends = [(reduced[dma.labels == k].min(), reduced[dma.labels == k].max()) for k in np.unique(dma.labels)]
    T = dma.isotherm_temperatures
    ends.sort()
    told, reach = [], ends[0][1]
    for low, high in ends[1:]:
        if low - reach > GAP:
            told.append(f"{low - reach:.2g} decades about {10 ** ((low + reach) / 2):.3g} Hz")
        reach = max(reach, high)
    if told:
        warn(
            f"{dma.source}: the {T.size} isotherms leave gaps in the master curve, {', '.join(told)}: over "
            "these no modulus was measured, and the shifts across them are a guess of a smooth spectrum; "
            "measure a temperature in between, or a wider range of frequency",
            UnevenShifts,
        )


def doubt_points(dma: DMAData, deviations: tuple[Array, Array]) -> None:
    """Doubt points, by their deviations from one causal spectrum: warn of those that stand alone."""
    told = []
    for name, off in zip(("G′", "G″"), deviations, strict=True):
        scatter = 1.4826 * float(np.median(np.abs(off)))
        for i in np.flatnonzero(np.abs(off) > max(_APART, _TIMES_SCATTER * scatter)):
            told.append((float(abs(off[i])), name, int(i), scatter))
    if not told:
        return
    told.sort(reverse=True)
    words = ", ".join(
        f"{name} at {dma.frequency[i]:.4g} Hz and {dma.temperature[i]:.4g} °C by {size:.0%}"
        for size, name, i, _ in told[:_SHOWN]
    )
    more = f" and {len(told) - _SHOWN} more" if len(told) > _SHOWN else ""
    warn(
        f"{dma.source}: {len(told)} moduli stand off the curve that the others make, {words}{more}, where "
        f"they scatter by {told[0][3]:.2%}; they are kept: measure them again, or leave them out by dma.take",
        OddPoints,
    )


def doubt_runs(dma: DMAData) -> None:
    """Doubt points of several runs that nobody chose: warn, with what they say where they overlap."""
    if dma.run is None or dma.runs_chosen:
        return
    names = list(dict.fromkeys(dma.run.tolist()))
    if len(names) < 2:
        return
    spans = []
    for name in names:
        T = dma.temperature[dma.run == name]
        spans.append(f"{name!r} ({T.min():.4g} to {T.max():.4g} °C)")
    warn(
        f"{dma.source}: points of {len(names)} runs in one curve, {', '.join(spans)}: the levels of two "
        f"specimens often differ by some 5 %; dma.select(run={names[0]!r}) takes one, "
        f"dma.select(run={names!r}) says that they are meant together",
        MixedRuns,
    )
