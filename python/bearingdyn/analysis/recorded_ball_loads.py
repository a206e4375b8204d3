"""How the balls of a bearing are loaded through a march, and when they lose contact."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from bearingdyn.analysis.equilibrium import Equilibrium
from bearingdyn.checks import instance
from bearingdyn.results import recorded, sampling_time, signal_of
from bearingdyn.system import System

if TYPE_CHECKING:
    import xarray


def ball_channels(source: Equilibrium | System, bearing: str) -> list[str]:
    """Channels of the loads of all balls of a bearing, "left.ball1" …, for the record of `transient`.

    Parameters
    ----------
    source
        Equilibrium, or a system.
    bearing
        Name of the bearing.

    Returns
    -------
    list of str
        One name for each ball, from 1.

    Raises
    ------
    ValueError
        For an unknown bearing.
    """
    remedy = "it must be an Equilibrium, bd.equilibrium(app), or a system"
    instance("source", source, (Equilibrium, System), remedy)
    system = source.system if isinstance(source, Equilibrium) else source
    for term in system.bearings:
        if term.name == bearing:
            return [f"{bearing}.ball{j + 1}" for j in range(term.bearing.Z)]
    raise ValueError(f"there is no bearing {bearing!r}; there are {[t.name for t in system.bearings]}")


def contact_statistics(result: xarray.Dataset, bearing: str) -> xarray.Dataset:
    """Loss of contact of every ball of a bearing, from its recorded loads (see `ball_channels`).

    Parameters
    ----------
    result
        As `transient` returns it.
    bearing
        Name of the bearing.

    Returns
    -------
    xarray.Dataset
        Over "ball" (from 1): free, share of the samples without load; losses, how often contact was lost
        within the record; longest, the longest time without contact, s (of a loss that began before the
        record or lasts beyond it, the part within); mean and peak load, N. Over "count": loaded, the share
        of the samples with that many balls loaded.

    Raises
    ------
    ValueError
        If not all balls were recorded, or the record is empty.
    """
    recorded(result)
    known = [str(c) for c in result["channel"].values]
    prefix = f"{bearing}.ball"
    numbers = sorted(int(c.removeprefix(prefix)) for c in known if c.startswith(prefix))
    if not numbers or numbers != list(range(1, len(numbers) + 1)):
        raise ValueError(
            f"the balls of {bearing!r} were not all recorded (found {numbers}); march with record="
            f"[*ball_channels(eq, {bearing!r})]"
        )
    loads = np.stack([signal_of(result, f"{prefix}{j}") for j in numbers], axis=1)
    if not len(loads):
        raise ValueError("the record is empty; march some steps")
    carries = loads > 0.0
    held = np.vstack([carries[:1], carries])
    losses = (held[:-1] & ~held[1:]).sum(axis=0)
    longest = np.zeros(len(numbers), dtype=np.intp)
    for j, column in enumerate(carries.T):
        edges = np.flatnonzero(np.diff(np.concatenate([[True], column, [True]])))
        if edges.size:
            longest[j] = int(np.diff(edges)[::2].max())
    count = np.bincount(carries.sum(axis=1), minlength=len(numbers) + 1) / len(carries)

    from bearingdyn.results import dataset

    return dataset(
        {
            "free": ("ball", 1.0 - carries.mean(axis=0), "1", "share of the time without contact"),
            "losses": ("ball", losses, "1", "times that contact was lost"),
            "longest": ("ball", longest * sampling_time(result), "s", "longest time without contact"),
            "mean": ("ball", loads.mean(axis=0), "N", "mean load"),
            "peak": ("ball", loads.max(axis=0), "N", "highest load"),
            "loaded": ("count", count, "1", "share of the time with so many balls loaded"),
        },
        {"analysis": "contact statistics", "bearing": bearing},
        {"ball": (numbers, ""), "count": (np.arange(len(numbers) + 1), "")},
    )
