"""Temperatures that several runs have in common: levels without a shift law, and one isotherm of both."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from bearingdyn.material.dma import DMAData
from bearingdyn.types import Array

_SAME = 1e-3  # K; two isotherms at one temperature have one shift
_FEWEST = 2  # points within the other's frequencies
_FLOOR = 2e-3  # of ln level, as of levels by the law: thermometers and clamps, whatever the scatter


@dataclass(frozen=True)
class Shared:
    """Levels of r runs that temperatures in common tell, within groups of runs that these hold together.

    Attributes
    ----------
    group
        (r,) number of each run's group; that of the first run is 0.
    logs, errors
        (r,) ln of each run's factor to the level of its group's first run, and its standard error.
    """

    group: NDArray[np.int64]
    logs: Array
    errors: Array


def shared_levels(dma: DMAData, run: NDArray[np.int64], runs: int) -> Shared:
    """Levels of the runs, `run` (n,) of each point, by moduli at one temperature and frequency."""
    pairs = _pairs(dma, run)
    group = np.arange(runs)
    for first, second, _, _ in pairs:
        both = group[first], group[second]
        group[group == max(both)] = min(both)
    group = np.unique(group, return_inverse=True)[1].reshape(-1)
    logs, errors = np.zeros(runs), np.zeros(runs)
    for g in range(int(group.max()) + 1):
        members = np.flatnonzero(group == g)
        own = [p for p in pairs if group[p[0]] == g]
        if not own:
            continue
        # of a later member the unknown, of the first none
        A = np.zeros((len(own), members.size - 1))
        for row, (first, second, _, _) in enumerate(own):
            for which, sign in ((first, -1.0), (second, 1.0)):
                at = int(np.flatnonzero(members == which)[0])
                if at:
                    A[row, at - 1] = sign
        d, s = (np.array([p[k] for p in own]) for k in (2, 3))
        found, *_ = np.linalg.lstsq(A / s[:, None], d / s, rcond=None)
        spread = np.linalg.pinv((A / s[:, None]).T @ (A / s[:, None]))
        freedom = len(own) - found.size
        # temperatures that disagree by more than their points scatter tell of a worse level
        chi = float(np.sum(((A @ found - d) / s) ** 2)) / freedom if freedom > 0 else 1.0
        logs[members[1:]] = found
        errors[members[1:]] = np.sqrt(np.diag(spread) * max(1.0, chi) + _FLOOR**2)
    return Shared(group.astype(np.int64), logs, errors)


def merged(dma: DMAData) -> DMAData:
    """The measurement with one isotherm of all runs at each temperature that several have in common."""
    if dma.run is None:
        return dma
    T, number = dma.isotherm_temperatures, np.arange(dma.isotherm_temperatures.size)
    for k in range(1, T.size):
        together = np.isin(dma.labels, np.flatnonzero(number == number[k - 1]))
        if T[k] - T[k - 1] <= _SAME and not set(dma.run[dma.labels == k]) & set(dma.run[together]):
            number[k] = number[k - 1]
    if (number == np.arange(T.size)).all():
        return dma
    labels = number[dma.labels]
    order = np.lexsort((dma.frequency, labels))
    known: dict[str, Any] = {name: getattr(dma, name) for name in dma.PER_POINT} | {"isotherm": labels}
    sorted_: dict[str, Any] = {name: None if v is None else v[order] for name, v in known.items()}
    return replace(dma, **sorted_)


def _pairs(dma: DMAData, run: NDArray[np.int64]) -> list[tuple[int, int, float, float]]:
    """(first run, later run, ln of the first's moduli over the later's, standard error) by temperature."""
    T, found = dma.isotherm_temperatures, []
    of = [int(run[np.argmax(dma.labels == k)]) for k in range(T.size)]
    for a in range(T.size):
        for b in range(a + 1, T.size):
            if not T[b] - T[a] <= _SAME or of[a] == of[b]:
                continue
            first, second = sorted((a, b), key=lambda k: of[k])
            means = []
            for modulus in (dma.storage, dma.loss):
                x, y = (_sorted(dma, modulus, k) for k in (first, second))
                inside = (y[0] >= x[0][0] - 1e-9) & (y[0] <= x[0][-1] + 1e-9)
                if inside.sum() < _FEWEST:
                    continue
                off = np.interp(y[0], *x)[inside] - y[1][inside]
                means.append((float(off.mean()), max(float(off.var(ddof=1)) / off.size, 1e-12)))
            if means:
                weight = sum(1.0 / v for _, v in means)
                mean = sum(m / v for m, v in means) / weight
                found.append((of[first], of[second], mean, weight**-0.5))
    return found


def _sorted(dma: DMAData, modulus: Array, isotherm: int) -> tuple[Array, Array]:
    """ln of frequency and of a modulus along an isotherm, frequency rising."""
    at = np.flatnonzero(dma.labels == isotherm)
    at = at[np.argsort(dma.frequency[at], kind="stable")]
    return np.log(dma.frequency[at]), np.log(modulus[at])
