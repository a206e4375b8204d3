"""The figure of sound intensity on the panels of radiating parts."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from bearingdyn.plot.arguments import figure, result
from bearingdyn.plot.frame import STYLE, engineering, style
from bearingdyn.plot.surfaces_in_space import (
    TO_FIGURE,
    axes_in_space,
    draw_surfaces,
    in_space,
    shaded,
    sharp_edges,
)
from bearingdyn.units import suited

if TYPE_CHECKING:
    import xarray
    from matplotlib.axes import Axes

MAP = "RdBu_r"  # red where sound leaves, blue where it is taken in
PALE = 0.85  # of its colour that a face along the light keeps: white must stay white


@figure(data=result("bd.sound_intensity", "intensity", "corners"), ax=in_space)
def sound_intensity(data: xarray.Dataset, ax: Axes | None = None) -> Axes:
    """Draw sound intensity by `bd.sound_intensity` on the geometry: red leaves, blue enters.

    Parameters
    ----------
    data
        Result of `bd.sound_intensity`.
    ax
        Axes to draw into, of projection "3d"; None: those of a new figure. `ax.view_init` turns it.

    Returns
    -------
    Axes
        The axes drawn into.
    """
    from matplotlib import colormaps
    from matplotlib.cm import ScalarMappable
    from matplotlib.colors import Normalize

    corners = 1e3 * data["corners"].values[:, :, TO_FIGURE]
    intensity = data["intensity"].values
    largest = float(np.abs(intensity).max()) or 1.0
    scale = Normalize(-largest, largest)
    # panels that meet share a corner to the last bit
    points, faces = np.unique(corners.reshape(-1, 3), axis=0, return_inverse=True)
    edges = points[sharp_edges(points, faces.reshape(-1, 3))]
    on: Any = ax
    with style():
        if on is None:
            on = axes_in_space()
        draw_surfaces(on, list(corners), shaded(colormaps[MAP](scale(intensity)), corners, PALE), edges)
        bar = on.figure.colorbar(ScalarMappable(scale, MAP), ax=on, shrink=0.6, pad=0.12)
        unit = engineering(bar.ax.yaxis, intensity, data["intensity"].attrs["units"])
        bar.set_label(f"sound intensity, {unit}", size=STYLE["axes.labelsize"])
        bar.ax.tick_params(labelsize=8.0)
        size, watts, _ = suited(float(data["power"]), data["power"].attrs["units"])
        power = float(data["power"]) / 10.0**size
        on.set_title(
            f"{float(data.attrs['frequency']):.4g} Hz, {data.attrs['input']}: {power:.3g} {watts}",
            loc="left",
            pad=12.0,
        )
    drawn_in: Axes = on
    return drawn_in
