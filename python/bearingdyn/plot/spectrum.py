"""The figure of amplitude spectra."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np

from bearingdyn.plot.arguments import figure, frequencies, maybe, results
from bearingdyn.plot.frame import (
    GREY,
    colour,
    finish,
    kind_of,
    new_axes,
    some,
    style,
)
from bearingdyn.types import Array

if TYPE_CHECKING:
    import xarray
    from matplotlib.axes import Axes


# a spectrum is drawn this far below its largest line: 120 dB, below which round-off begins
DEPTH = 1e-6
POINT = 1.0 / 72.0  # inch
# names of lines: their size, points; what one takes along the axis, in that size; height of the leaders, of
# the axes
NAME, PITCH, LEADER = 8.0, 1.35, 0.07


@figure(datasets=results("bd.spectrum", "frequency", "amplitude"), lines=maybe(frequencies))
def spectrum(
    datasets: Mapping[str, xarray.Dataset],
    lines: Mapping[str, float] | None = None,
    ax: Axes | None = None,
    *,
    f_max: float | None = None,
) -> Axes:
    """Draw amplitude spectra by bd.spectrum or bd.envelope_spectrum, several by label, 120 dB deep at most.

    Parameters
    ----------
    datasets
        Results of `bd.spectrum` or `bd.envelope_spectrum` by label, in one unit.
    lines
        Name -> frequency, Hz, such as {"BPFO": 107.4}: marked and named where they fall inside the figure.
    ax
        Axes to draw into; None: those of a new figure.
    f_max
        Highest frequency drawn, Hz; None: the whole of the spectra.

    Returns
    -------
    Axes
        The axes drawn into.

    Raises
    ------
    ValueError
        If f_max is not positive or the spectra have different units.
    """
    if f_max is not None and not f_max > 0:
        raise ValueError(f"f_max is {f_max}; it must be a positive frequency, in Hz")
    units = {str(data["amplitude"].attrs["units"]) for data in some(datasets).values()}
    if len(units) > 1:
        raise ValueError(f"spectra in {sorted(units)} do not go into one figure; draw one of each")
    end = f_max or max(float(data["frequency"].values[-1]) for data in datasets.values())
    channels = sorted({str(data.attrs["channel"]) for data in datasets.values()})
    with style():
        ax = ax or new_axes(width=6.8)
        largest, smallest = 0.0, np.inf
        for k, (label, data) in enumerate(datasets.items()):
            shown = (data["frequency"].values > 0) & (data["frequency"].values <= end)
            f, amplitude = data["frequency"].values[shown], data["amplitude"].values[shown]
            ax.plot(f, amplitude, color=colour(k), linewidth=0.8, label=label, zorder=2 + 0.1 * k)
            largest = max(largest, float(amplitude.max(initial=0.0)))
            smallest = min(smallest, float(amplitude.min(initial=np.inf)))
        ax.set_xlim(0.0, end)
        room = _mark(ax, {name: f for name, f in (lines or {}).items() if 0 <= f <= end})
        if largest > 0:
            ax.set_yscale("log")
            low = max(0.5 * smallest, DEPTH * largest)
            ax.set_ylim(low, low * (2 * largest / low) ** (1 / (1 - room)))
        ax.set_xlabel("frequency, Hz")
        ax.set_ylabel(f"amplitude, zero-to-peak, {units.pop()}")
        kinds = dict.fromkeys(kind_of(data) for data in datasets.values())
        title = f"{' and '.join(kinds)} of {', '.join(channels)}"
        finish(ax, title[0].upper() + title[1:], legend=True)
    return ax


def _mark(ax: Axes, lines: Mapping[str, float]) -> float:
    """Dashed verticals, each led to its name in one row at the top: no line goes through a name.

    The names keep the order of the lines; where those are closer than letters are wide, the names move apart
    and slanted leaders join them. Returns the share of the height of the axes that names and leaders take.
    """
    if not lines:
        return 0.0
    from matplotlib.patches import ConnectionPatch

    names = sorted(lines, key=lambda name: lines[name])
    at = np.array([lines[name] for name in names]) / ax.get_xlim()[1]
    # in shares of the axes: what a name takes along them; names too many for them are written smaller
    size = min(NAME, ax.bbox.width / (PITCH * len(names) * POINT * ax.figure.dpi))
    letter = size * POINT * ax.figure.dpi
    stands = _spread(at, PITCH * letter / ax.bbox.width)
    height = max(map(len, names)) * 0.6 * letter / ax.bbox.height + 0.02
    moved = bool(np.abs(stands - at).max() * ax.bbox.width > 0.5)  # pixels
    foot = 1.0 - height - (LEADER if moved else 0.01)
    for name, stand in zip(names, stands, strict=True):
        ax.axvline(
            lines[name], ymax=foot, color=GREY, linestyle=(0, (3, 3)), linewidth=0.7, zorder=1, gid=name
        )
        leader = ConnectionPatch(
            (lines[name], foot), (stand, 1.0 - height), ax.get_xaxis_transform(), ax.transAxes,
            color=GREY, linewidth=0.7, zorder=1, gid=name,
        )  # fmt: skip
        leader.set_in_layout(False)
        ax.add_artist(leader)
        ax.text(
            stand, 1.0 - height + 0.005, name, rotation=90, transform=ax.transAxes,
            ha="center", va="bottom", fontsize=size, color=GREY, zorder=5,
        )  # fmt: skip
    return min(1.0 - foot + 0.01, 0.5)


def _spread(at: Array, pitch: float) -> Array:
    """Places (n,) in 0 … 1, `pitch` apart at least, in the order of `at` and nearest to it in squares."""
    from scipy.optimize import isotonic_regression

    rank = np.arange(len(at)) * pitch
    most = max(1.0 - (len(at) - 0.5) * pitch, 0.5 * pitch)
    return np.asarray(np.clip(isotonic_regression(at - rank).x, 0.5 * pitch, most) + rank)
