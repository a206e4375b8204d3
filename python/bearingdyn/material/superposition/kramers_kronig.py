"""Cleaning: the local Kramers–Kronig ratio of each isotherm, and the points it, or their sign, gives away.

For a linear, causal material with a broad spectrum G″ ≈ (π/2) dG′/d ln ω (H.C. Booij, G.P.J.M. Thoone,
Rheol. Acta 21 (1982) 15), so that the ratio of the two is near one. It is not exactly one: a lone relaxation
gives 0.64 at its peak and more on both sides. What moves with temperature may therefore be material; what
stays at one frequency on all isotherms and grows towards it is the fixture.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from bearingdyn.checks import instance
from bearingdyn.material.dma import DMAData
from bearingdyn.material.superposition.equal_frequency import at_odds, cells_of
from bearingdyn.types import Array

Reason = Literal["negative modulus", "fixture resonance"]

LIMIT = 1.5
"""Median ratio over the isotherms above which a frequency is held to be a fixture's resonance."""

_WINDOW = 0.5  # decades to either side of the point over which G′ is smoothed
_ENOUGH = 5  # points a local parabola rests on
_ISOTHERMS = 4  # with fewer, what stays at one frequency cannot be told from what moves


@dataclass(frozen=True)
class Suspect:
    """A point that, by Kramers and Kronig, no passive material could give.

    Attributes
    ----------
    frequency, temperature
        Where it was measured, Hz and °C.
    reason
        "negative modulus", or "fixture resonance".
    ratio
        Local Kramers–Kronig ratio there; NaN where there is none.
    """

    frequency: float
    temperature: float
    reason: Reason
    ratio: float


def kk_ratio(dma: DMAData) -> Array:
    """Local Kramers–Kronig ratio G″/((π/2) dG′/d ln ω) of every point.

    The derivative is that of a parabola through ln G′ against ln ω of the same isotherm, over half a decade
    to either side and five points at least, weighed by distance.

    Parameters
    ----------
    dma
        The measurement.

    Returns
    -------
    Array
        (n,); NaN where the isotherm has fewer than three frequencies, the moduli are not positive, or G′ does
        not rise.
    """
    instance("dma", dma, DMAData, "it must be the result of `read_dma`")
    ratio = np.full(dma.frequency.size, np.nan)
    for k in range(int(dma.labels.max()) + 1):
        index = np.flatnonzero((dma.labels == k) & (dma.storage > 0))
        x, y = np.log(dma.frequency[index]), np.log(dma.storage[index])
        if np.unique(x).size < 3:
            continue
        for i, place in enumerate(index):
            distance = np.abs(x - x[i])
            reach = max(_WINDOW * np.log(10), np.sort(distance)[min(_ENOUGH, x.size) - 1])
            near = distance <= reach * 1.0001
            if np.unique(x[near]).size < 3:
                continue
            weight = (1 - (distance[near] / (1.01 * reach)) ** 3) ** 1.5
            powers = np.vander(x[near] - x[i], 3) * weight[:, None]
            slope = np.linalg.lstsq(powers, y[near] * weight, rcond=None)[0][1]
            if slope > 0 and dma.loss[place] > 0:
                ratio[place] = dma.loss[place] / (np.pi / 2 * slope * dma.storage[place])
    return ratio


def suspects(dma: DMAData) -> tuple[NDArray[np.bool_], tuple[Suspect, ...]]:
    """Points that, by Kramers and Kronig, no passive material could give.

    Negative (or zero) moduli are always among them. With four isotherms or more, so is every point from the
    frequency on at which the median ratio over the isotherms exceeds 1.5, provided that it does so up to the
    highest frequency, and at two frequencies at least. If it does so at all frequencies, the material is like
    that. Then comes every frequency at which the isotherms contradict each other at equal reduced frequency:
    a resonance inside the band.

    Parameters
    ----------
    dma
        The measurement.

    Returns
    -------
    mask : Array
        (n,) bool.
    found : tuple of Suspect
        What is wrong with each.
    """
    ratio = kk_ratio(dma)
    negative = ~((dma.storage > 0) & (dma.loss > 0))
    resonance = np.zeros(negative.size, dtype=bool)
    if dma.labels.max() + 1 >= _ISOTHERMS:
        cell = cells_of(dma.frequency)
        cells = np.unique(cell)
        median = np.array([_median(ratio[cell == c]) for c in cells])
        known = np.isfinite(median)
        above = known & (median > LIMIT)
        if known.any() and (known & ~above).any():
            last_good = int(np.flatnonzero(known & ~above)[-1])
            if cells.size - last_good > 2:  # a single frequency may be an effect of the edge
                resonance = (cell > cells[last_good]) & ~negative
        good = np.flatnonzero(~(negative | resonance))
        if good.size:
            resonance[_in_order(dma, good)] |= at_odds(dma.take(good))
    flagged = negative | resonance
    found = tuple(
        Suspect(
            float(dma.frequency[i]),
            float(dma.temperature[i]),
            "negative modulus" if negative[i] else "fixture resonance",
            float(ratio[i]),
        )
        for i in np.flatnonzero(flagged)
    )
    return flagged, found


def _in_order(dma: DMAData, index: NDArray[np.int64]) -> NDArray[np.int64]:
    """The indices in the order in which :meth:`DMAData.take` puts their points."""
    return index[np.lexsort((dma.frequency[index], dma.labels[index]))]


def _median(ratio: Array) -> float:
    finite = ratio[np.isfinite(ratio)]
    return float(np.median(finite)) if finite.size >= 3 else float("nan")


def summary(found: tuple[Suspect, ...]) -> str:
    """Kramers' and Kronig's relations in words: how many points fail, and why."""
    parts = []
    for reason in ("negative modulus", "fixture resonance"):
        those = [s for s in found if s.reason == reason]
        if those:
            f = [s.frequency for s in those]
            parts.append(f"{len(those)} for {reason} ({min(f):.4g} to {max(f):.4g} Hz)")
    return ", ".join(parts)
