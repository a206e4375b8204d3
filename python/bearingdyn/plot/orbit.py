"""The figure of orbits."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np

from bearingdyn.plot.arguments import figure, results
from bearingdyn.plot.frame import (
    colour,
    finish,
    new_axes,
    some,
    style,
)

if TYPE_CHECKING:
    import xarray
    from matplotlib.axes import Axes


@figure(datasets=results("bd.orbit", "x", "y"))
def orbit(datasets: xarray.Dataset | Mapping[str, xarray.Dataset], ax: Axes | None = None) -> Axes:
    """Draw orbits by bd.orbit, several by label, in µm, each about its own mean, both axes to one scale.

    The mean of the record is what bd.orbit subtracts and keeps as mean_x and mean_y. The paper subtracts the
    static deflection; from that the mean differs by what speed adds to it.

    Parameters
    ----------
    datasets
        A result of `bd.orbit`, or several by label.
    ax
        Axes to draw into; None: those of a new figure.

    Returns
    -------
    Axes
        The axes drawn into.
    """
    datasets = some(datasets)
    first = next(iter(datasets.values()))
    with style():
        ax = ax or new_axes(width=4.6, height=4.9)
        curves = [(d["x"].values * 1e6, d["y"].values * 1e6) for d in datasets.values()]
        sizes = [float(np.hypot(x, y).max(initial=0.0)) for x, y in curves]
        for k, (label, (x, y)) in enumerate(zip(datasets, curves, strict=True)):
            above = 2.0 + sum(size > sizes[k] for size in sizes) / len(sizes)  # the smaller orbit on top
            ax.plot(x, y, color=colour(k), linewidth=0.6, label=label, zorder=above)
        for axis, name in ((ax.xaxis, "x"), (ax.yaxis, "y")):
            meanings = {str(data[name].attrs.get("long_name", name)) for data in datasets.values()}
            meaning = str(first[name].attrs["long_name"]) if len(meanings) == 1 else f"{name} about its mean"
            axis.set_label_text(f"{meaning}, µm")
        ax.set_aspect("equal", adjustable="datalim")
        ax.margins(0.08)
        finish(ax, "Orbit about its mean" if len(curves) == 1 else "Orbits about their means", legend=True)
    return ax
