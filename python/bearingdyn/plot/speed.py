"""Figures over the speed of the shaft or the time of a run-up: Campbell diagram and waterfall."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from bearingdyn.plot.frame import COLOURS, finish, new_axes, style

if TYPE_CHECKING:
    import xarray
    from matplotlib.axes import Axes

RPM = 30.0 / math.pi
GREY = "0.45"
ROUND = 0.05  # whirl below which a mode is drawn as one along a line
DEPTH = 1e-4  # of the largest line of a waterfall: 80 dB


def campbell(
    data: xarray.Dataset,
    orders: Sequence[float] = (1.0,),
    ax: Axes | None = None,
    *,
    f_max: float | None = None,
) -> Axes:
    """Natural frequencies over the speed, by bd.campbell: whirl by colour, damping by size.

    orders: multiples of the shaft's speed, drawn as rays and named: 1 for unbalance, Z times the cage ratio
    for balls that pass. f_max: highest frequency drawn, Hz; that of the highest mode when not given. Modes
    without oscillation are left out.

    Raises ValueError if f_max or an order is not positive.
    """
    if f_max is not None and not f_max > 0:
        raise ValueError(f"f_max is {f_max}; it must be a positive frequency, in Hz")
    if not all(order > 0 for order in orders):
        raise ValueError(f"orders is {list(orders)}; multiples of the speed must be positive")
    speed = np.asarray(data["speed"].values, dtype=np.float64) * RPM
    swings = np.abs(data["eigenvalue"].values.imag) > 1e-6 * np.abs(data["eigenvalue"].values)
    frequency = np.where(swings, data["frequency"].values, np.nan)
    whirl, zeta = data["whirl"].values, np.clip(data["damping_ratio"].values, 0.0, 0.5)
    top = f_max or 1.05 * float(np.nanmax(frequency, initial=0.0))
    kinds = (
        ("forward", whirl > ROUND, COLOURS[0]),
        ("backward", whirl < -ROUND, COLOURS[1]),
        ("along a line", np.abs(whirl) <= ROUND, COLOURS[2]),
    )
    with style():
        ax = ax or new_axes(height=3.8)
        for k in range(frequency.shape[1]):
            ax.plot(speed, frequency[:, k], color="0.8", linewidth=0.8, zorder=1)
        for label, chosen, colour in kinds:
            at = chosen & np.isfinite(frequency) & (frequency <= top)
            if at.any():
                x = np.broadcast_to(speed[:, None], frequency.shape)
                ax.scatter(
                    x[at], frequency[at], s=5.0 + 120.0 * zeta[at], color=colour, linewidths=0.0, label=label
                )
        low, high = float(speed.min()), float(speed.max())
        ax.set_xlim(low, high)
        ax.set_ylim(0.0, top)
        for order in orders:
            ends = np.array([low, high]) * order / 60.0
            ax.plot([low, high], ends, color=GREY, linestyle=(0, (3, 3)), linewidth=0.7, zorder=0)
            reach = min(1.0, top / ends[1]) if ends[1] > 0 else 1.0
            ax.annotate(
                f"{order:g}×", (low + reach * (high - low), min(ends[1], top)), xytext=(3, 0),
                textcoords="offset points", fontsize=8, color=GREY, va="center", annotation_clip=False,
            )  # fmt: skip
        ax.set_xlabel("speed, rpm")
        ax.set_ylabel("natural frequency, Hz")
        finish(ax, "Campbell diagram", legend=True)
    return ax


def waterfall(data: xarray.Dataset, ax: Axes | None = None, *, f_max: float | None = None) -> Axes:
    """Spectra of a record piece by piece, by bd.waterfall: frequency across, speed or time up.

    Upwards stands the speed where it changes with the pieces and does not turn back, else the time. The
    colour is logarithmic, 80 dB deep. f_max: highest frequency drawn, Hz.

    Raises ValueError if f_max is not positive.
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
        bar.set_label(f"amplitude, zero-to-peak, {data['amplitude'].attrs['units']}")
        ax.set_xlabel("frequency, Hz")
        ax.set_ylabel("speed, rpm" if rising else "time, s")
        finish(ax, f"Waterfall of {data.attrs['channel']}")
        ax.grid(visible=False)
    return ax
