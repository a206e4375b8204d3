"""The figure of a run-up: spectra over the speed of the shaft, or over time."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from bearingdyn.plot.arguments import figure, result
from bearingdyn.plot.frame import RPM, engineering, finish, new_axes, style

if TYPE_CHECKING:
    import xarray
    from matplotlib.axes import Axes

DEPTH = 1e-4  # of the largest line of a waterfall: 80 dB


@figure(data=result("bd.waterfall", "amplitude", "frequency"))
def waterfall(data: xarray.Dataset, ax: Axes | None = None, *, f_max: float | None = None) -> Axes:
    """Draw a waterfall: spectra of a record by bd.waterfall, frequency across, speed or time up.

    The upward axis is the speed if it changes from piece to piece without turning back, else the time. The
    colour is logarithmic over 80 dB.

    Parameters
    ----------
    data
        Result of `bd.waterfall`.
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
        If f_max is not positive.
    """
    if f_max is not None and not f_max > 0:
        raise ValueError(f"f_max is {f_max}; it must be a positive frequency, in Hz")
    from matplotlib.colors import LogNorm

    f = data["frequency"].values
    shown = f <= (f_max or f[-1])
    level = np.asarray(data["amplitude"].values[:, shown], dtype=np.float64)
    speed = np.asarray(data["speed"].values, dtype=np.float64) * RPM
    rising = speed.size > 1 and bool((np.diff(speed) > 0).all() or (np.diff(speed) < 0).all())
    up = speed if rising else np.asarray(data["time"].values, dtype=np.float64)
    largest = float(level.max(initial=0.0)) or 1.0
    with style():
        ax = ax or new_axes(height=4.0)
        mesh = ax.pcolormesh(
            f[shown], up, np.maximum(level, DEPTH * largest), norm=LogNorm(DEPTH * largest, largest),
            cmap="cividis", shading="nearest", rasterized=True,
        )  # fmt: skip
        bar = ax.figure.colorbar(mesh, ax=ax, pad=0.02)
        unit = engineering(
            bar.ax.yaxis, np.array([DEPTH * largest, largest]), data["amplitude"].attrs["units"]
        )
        bar.set_label(f"amplitude, zero-to-peak, {unit}")
        ax.set_xlabel("frequency, Hz")
        ax.set_ylabel("speed, rpm" if rising else "time, s")
        finish(ax, f"Waterfall of {data.attrs['channel']}")
        ax.grid(visible=False)
    return ax
