"""Isotherms: which points of a measurement belong to one temperature, and whether they are in order."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from bearingdyn.checks import items, numbers, require
from bearingdyn.types import Array


def first_unsorted(frequency: Array, labels: NDArray[np.int64]) -> int | None:
    """Index of the first point whose frequency turns back within its isotherm, None if there is none."""
    found = []
    for k in np.unique(labels):
        index = np.flatnonzero(labels == k)
        step = np.sign(np.diff(frequency[index]))
        moving = step[step != 0]
        if moving.size:
            turned = np.flatnonzero(step == -moving[0])
            found += [int(index[turned[0] + 1])] if turned.size else []
    return min(found, default=None)


def group_isotherms(temperature: ArrayLike, run: ArrayLike | None = None) -> NDArray[np.int64]:
    """Number of the isotherm that each temperature belongs to.

    Sorted temperatures are cut at their wide gaps; wide is what lies above the largest jump in the sizes of
    the gaps, 0.3 K at least and 3 K at most. A jitter of a tenth of a kelvin and a drift of one kelvin thus
    do no harm.

    Parameters
    ----------
    temperature
        (n,), °C.
    run
        (n,) the run of each point; each run has isotherms of its own. None: there is one run.

    Returns
    -------
    Array
        (n,), 0 the coldest.
    """
    T = numbers("temperature", temperature, "it must be a list of temperatures, °C")
    if run is not None:
        names = np.asarray(items("run", run, "it must be a list of names"))
        require(names.shape == T.shape, "run", run, f"it must be {T.size} names, one a temperature")
    if run is None:
        return _cut_at_gaps(T)
    labels = np.zeros(T.size, dtype=np.int64)
    used = 0
    for name in dict.fromkeys(np.asarray(run).tolist()):
        own = np.asarray(run) == name
        labels[own] = used + _cut_at_gaps(T[own])
        used = int(labels.max()) + 1
    means = np.bincount(labels, T) / np.bincount(labels)
    return np.argsort(np.argsort(means, kind="stable"))[labels].astype(np.int64)


def _cut_at_gaps(T: Array) -> NDArray[np.int64]:
    """Number of the isotherm of each temperature of one run."""
    order = np.argsort(T, kind="stable")
    gap = np.diff(T[order])
    sizes = np.concatenate([[0.02], np.sort(np.clip(gap, 0.02, 3.0))])
    jump = np.where(sizes[1:] >= 0.3, sizes[1:] / sizes[:-1], 0.0)
    labels = np.zeros(T.size, dtype=np.int64)
    if jump.size and jump.max() > 0:
        threshold = sizes[1 + int(np.argmax(jump))]
        labels[order[1:]] = np.cumsum(np.minimum(gap, 3.0) >= threshold)
    return labels
