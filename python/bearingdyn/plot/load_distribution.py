"""The figure of who carries the load of a bearing."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from bearingdyn.bearing import LoadDistribution
from bearingdyn.plot.arguments import figure, several
from bearingdyn.plot.frame import DASHES, colour, new_axes, some, style

if TYPE_CHECKING:
    from matplotlib.axes import Axes


@figure(distributions=several(LoadDistribution, maker="the result of `load_distribution`"))
def load_distribution(distributions: Mapping[str, LoadDistribution], ax: Axes | None = None) -> Axes:
    """Draw how load is distributed over the inner contacts, N, around the bearing, several states by label.

    Parameters
    ----------
    distributions
        States by label, each by `bearing.load_distribution`.
    ax
        Axes to draw into, polar; None: those of a new figure.

    Returns
    -------
    Axes
        The axes drawn into.

    Raises
    ------
    ValueError
        If there are none or the axes are not polar.
    """
    if ax is not None and ax.name != "polar":
        raise ValueError(f"ax has the projection {ax.name!r}; a load distribution needs projection='polar'")
    from matplotlib.ticker import MaxNLocator

    with style():
        ax = ax or new_axes(width=4.8, height=4.8, projection="polar")
        scale: Any = ax  # polar
        largest = max(float(d.load_inner.max()) for d in some(distributions).values())
        for k, (label, d) in enumerate(distributions.items()):
            # out and back at each ball: a line without area, so that several states stay readable
            psi = np.repeat(d.azimuth, 3)
            spokes = np.column_stack([0 * d.load_inner, d.load_inner, 0 * d.load_inner]).ravel()
            ax.plot(psi, spokes, color=colour(k), linewidth=max(4.0 - 1.6 * k, 0.8))
            around = np.append(d.azimuth, d.azimuth[0] + 2 * np.pi)
            ring = np.append(d.load_inner, d.load_inner[0])
            name = f"{label}: {d.loaded} of {d.azimuth.size} loaded"
            ax.plot(
                around, ring, color=colour(k), linestyle=DASHES[k % len(DASHES)], marker="o", ms=3, label=name
            )
        ax.set_ylim(0.0, 1.05 * largest if largest > 0 else 1.0)
        ax.yaxis.set_major_locator(MaxNLocator(4))
        scale.set_rlabel_position(200.0)
        ax.set_xticks(np.radians([0, 90, 180, 270]), ["x", "y", "−x", "−y"])
        ax.set_xlabel("load of the inner contact, N, over the azimuth")
        ax.set_title(f"Load distribution, the largest {largest:.4g} N", pad=14)
        ax.tick_params(labelsize=8)
        ax.grid(color="0.85", linewidth=0.6)
        ax.legend(loc="upper center", bbox_to_anchor=(0.5, -0.12))
    return ax
