"""Isotherms judged against each other at equal reduced frequency: what a fixture adds at its own frequency.

A material says the same wherever two isotherms meet at one reduced frequency x = f·a_T; a fixture adds what
depends on the frequency f of the machine. So ln tan δ (and ln G′) of all points is split into a smooth
function of x and a free number e per frequency f, robustly and by least squares. A constant e, and one
proportional to ln f together with wrong shifts, cannot be told from material: e is taken about its median,
that of ln G′ about its line as well.
"""

from __future__ import annotations

import numpy as np
import scipy
from numpy.typing import NDArray

from bearingdyn.material.dma import DMAData
from bearingdyn.material.superposition.free_shifts import first_shifts
from bearingdyn.types import Array

_ISOTHERMS = 4  # below which a fixture's frequency cannot be told from the material
_PER_DECADE = 4  # knots of the smooth function; a relaxation is a decade wide
_SMOOTH, _WEAK = 0.05, 1e-3  # weights of curvature and of e itself, which settle what the data leave open
_ROUNDS = 3  # of reweighing points that stand out
_DEVIATION, _FLANK = 0.15, 0.08  # of tan δ or G′, relative; six and three times what clean isotherms leave
_TIMES_ERROR = 5.0  # of the standard error of e
_CLUSTERS = 4  # resonances sought
_CELL = 0.02  # decades, 5 %: drives miss their frequency


def cells_of(frequency: Array) -> NDArray[np.int64]:
    """Number of the cell of 5 % in which each frequency lies: points in one cell are of equal frequency."""
    return np.asarray(np.round(np.log10(frequency) / _CELL), dtype=np.int64)


def at_odds(dma: DMAData) -> NDArray[np.bool_]:
    """Points, (n,), at which isotherms contradict each other at equal frequency of the machine.

    The largest deviation is taken out with its flanks, and the rest judged again, as a resonance spoils the
    shifts too.
    """
    odd = np.zeros(dma.frequency.size, dtype=bool)
    cell = cells_of(dma.frequency)
    total = np.unique(cell).size
    for _ in range(_CLUSTERS):
        index = np.flatnonzero(~odd)
        kinds, deviation, limit = _deviations(dma.take(index))
        if kinds.size < _ISOTHERMS or not (deviation > limit).any():
            break
        peak = int(np.argmax(deviation - limit))
        low = high = peak
        while low > 0 and deviation[low - 1] > _FLANK:
            low -= 1
        while high < kinds.size - 1 and deviation[high + 1] > _FLANK:
            high += 1
        taken = odd | np.isin(cell, kinds[low : high + 1])
        if np.unique(cell[taken]).size > total / 2:  # then it is the material, or no superposition at all
            break
        odd = taken
    return odd


def _deviations(dma: DMAData) -> tuple[NDArray[np.int64], Array, Array]:
    """Cells of frequency, the larger of the relative deviations of tan δ and G′ in each, and its limit."""
    nothing = np.empty(0, dtype=np.int64), np.empty(0), np.empty(0)
    swept = [sweep for sweep in dma.isotherms if np.unique(sweep.frequency).size > 2]
    if len(swept) < max(_ISOTHERMS, int(dma.labels.max()) + 1):
        return nothing
    x = np.log10(dma.frequency) + first_shifts(dma)[dma.labels]
    kinds, where = np.unique(cells_of(dma.frequency), return_inverse=True)
    count = np.bincount(where)
    knots = np.linspace(x.min(), x.max(), max(6, int(np.ptp(x) * _PER_DECADE)))
    ends = np.concatenate([[knots[0]] * 3, knots, [knots[-1]] * 3])
    smooth = scipy.interpolate.BSpline.design_matrix(np.clip(x, knots[0], knots[-1]), ends, 3).toarray()
    n = smooth.shape[1]
    A = np.hstack([smooth, np.eye(kinds.size)[where]])
    bend = np.hstack([_SMOOTH * np.diff(np.eye(n), 2, axis=0), np.zeros((n - 2, kinds.size))])
    small = np.hstack([np.zeros((kinds.size, n)), _WEAK * np.eye(kinds.size)])
    held = np.vstack([bend, small])
    deviation, error = np.zeros(kinds.size), np.zeros(kinds.size)
    for y, tilted in ((np.log(dma.tan_delta), False), (np.log(dma.storage), True)):
        weight = np.ones(y.size)
        for _ in range(_ROUNDS):
            rows = np.vstack([A * weight[:, None], held])
            target = np.append(y * weight, np.zeros(held.shape[0]))
            solution = np.linalg.lstsq(rows, target, rcond=None)[0]
            residual = y - A @ solution
            scatter = max(1.4826 * float(np.median(np.abs(residual))), 1e-12)
            weight = 1 / np.sqrt(1 + (residual / (2 * scatter)) ** 2)
        e = solution[n:]
        if tilted and kinds.size > 2:
            line = scipy.stats.theilslopes(e, kinds)
            e = e - line.slope * kinds
        e = np.abs(e - np.median(e))
        e[0] = 0.0  # it has no neighbour below that would tell drift, or the edge of the fit, from a fixture
        deviation = np.maximum(deviation, np.where(count >= _ISOTHERMS - 1, e, 0.0))
        error = np.maximum(error, scatter / np.sqrt(count))
    return kinds, deviation, np.maximum(_DEVIATION, _TIMES_ERROR * error)
