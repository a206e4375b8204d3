"""Steady motions over speed: every branch with its stability and events, and the harmonics of one of them."""

from __future__ import annotations

from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from bearingdyn.checks import require
from bearingdyn.plot.arguments import figure, maybe, result, text
from bearingdyn.plot.frame import RPM, colour, engineering, finish, new_axes, style
from bearingdyn.types import Array, Index

if TYPE_CHECKING:
    import xarray
    from matplotlib.axes import Axes

# marker and hue of each event
EVENTS = {"fold": ("o", 1), "flip": ("D", 3), "neimark-sacker": ("s", 2), "failed": ("x", 5)}
# dB below the largest line, where a waterfall of harmonics begins to show anything
DEPTH = 80.0
HELD = ("channel", "unit", "peak_to_peak", "stable", "branch", "passages", "event")
LINES = ("channel", "speed", "peak_to_peak", "stable", "amplitude", "passage_frequency", "order")


@figure(data=result("bd.speed_map", *HELD), channel=maybe(text))
def speed_map(data: xarray.Dataset, channel: str | None = None, ax: Axes | None = None) -> Axes:
    """Draw all branches of a map: peak to peak of a channel over speed, stable ones full, others dashed.

    Branches whose period doubled have a hue of their own; folds, flips and Neimark–Sacker points are
    marked, and so is where a branch could be followed no further.

    Parameters
    ----------
    data
        Result of `bd.speed_map` or `bd.parameter_map`.
    channel
        Of the map; None: its first.
    ax
        Axes to draw into; None: those of a new figure.

    Returns
    -------
    Axes
        The axes drawn into.

    Raises
    ------
    ValueError
        For a channel that the map does not hold.
    """
    channel, at, name = _chosen(data, channel)
    swing = data["peak_to_peak"].sel(channel=channel).values
    stable, branch = data["stable"].values, data["branch"].values
    passages, event = data["passages"].values, data["event"].values
    unit = str(data["unit"].sel(channel=channel).values)
    with style():
        ax = ax or new_axes()
        named: set[str] = set()
        for k in np.unique(branch):
            own = np.flatnonzero(branch == k)
            period = int(passages[own[0]])
            hue = colour(0 if period == 1 else 4)
            for piece in _pieces(own, stable):
                steady = stable[piece[-1]] != 0
                what = ("stable" if steady else "unstable") + ("" if period == 1 else f", {period} passages")
                ax.plot(
                    at[piece], swing[piece], color=hue, linestyle="-" if steady else "--",
                    linewidth=1.5 if steady else 0.9, label=None if what in named else what,
                )  # fmt: skip
                named.add(what)
        for what, (marker, hue_of) in EVENTS.items():
            here = event == what
            if here.any():
                ax.plot(
                    at[here], swing[here], linestyle="none", marker=marker, markersize=5.5,
                    color=colour(hue_of), label=what.replace("neimark-sacker", "Neimark–Sacker"), zorder=4,
                )  # fmt: skip
        ax.set_yscale("log")
        ax.set_xlabel(name)
        unit = engineering(ax.yaxis, swing, unit)
        ax.set_ylabel(f"{channel}, peak to peak, {unit}")
        finish(ax, "steady motions", legend=True)
    return ax


@figure(data=result("bd.speed_map", *LINES), channel=maybe(text))
def speed_waterfall(data: xarray.Dataset, channel: str | None = None, ax: Axes | None = None) -> Axes:
    """Draw the lines of a map's stable motions over speed and frequency, in dB of the largest.

    Where several motions are stable at one speed, all of them are drawn.

    Parameters
    ----------
    data
        Result of `bd.speed_map`.
    channel
        Of the map; None: its first.
    ax
        Axes to draw into; None: those of a new figure.

    Returns
    -------
    Axes
        The axes drawn into.

    Raises
    ------
    ValueError
        For a channel that the map does not hold, and for a map over something else than speed.
    """
    channel, at, name = _chosen(data, channel)
    keep = (data["stable"].values == 1) & np.isfinite(data["peak_to_peak"].sel(channel=channel).values)
    size = np.abs(data["amplitude"].sel(channel=channel).values[keep][:, 1:])
    passage = data["passage_frequency"].values[keep]
    hertz = data["order"].values[1:] * passage[:, None]
    level = 20.0 * np.log10(np.maximum(size, 1e-300) / max(float(size.max(initial=0.0)), 1e-300))
    with style():
        ax = ax or new_axes()
        rpm = np.broadcast_to(at[keep][:, None], hertz.shape)
        seen = level > -DEPTH
        order = np.argsort(level[seen])
        drawn = ax.scatter(
            rpm[seen][order], hertz[seen][order], c=level[seen][order], s=6.0, marker="s", linewidths=0.0,
            vmin=-DEPTH, vmax=0.0,
        )  # fmt: skip
        ax.figure.colorbar(drawn, ax=ax, label=f"{channel}, dB of its largest line")
        ax.set_xlabel(name)
        ax.set_ylabel("frequency, Hz")
        finish(ax, "lines of the steady motions")
    return ax


def _chosen(data: xarray.Dataset, channel: str | None) -> tuple[str, Array, str]:
    """The channel, and the axis of the map with its name; speeds in rpm."""
    known = [str(c) for c in data["channel"].values]
    channel = known[0] if channel is None else channel
    require(channel in known, "channel", channel, f"it must be one of the map's: {', '.join(known)}")
    if "speed" in data:
        return channel, data["speed"].values * RPM, "speed, rpm"
    return channel, data["parameter"].values, "parameter"


def _pieces(own: Index, stable: Index) -> list[Index]:
    """Runs of points of one stability along a branch, each begun with the last point of the one before."""
    cuts = np.flatnonzero(np.diff(stable[own])) + 1
    return [own[max(a - 1, 0) : b] for a, b in pairwise([0, *cuts.tolist(), len(own)])]
