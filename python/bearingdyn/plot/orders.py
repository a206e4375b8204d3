"""Figures over orders of the shaft speed: a spectrum over them, and each along a run-up."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np

from bearingdyn.plot.arguments import figure, result, results
from bearingdyn.plot.frame import DASHES, RPM, colour, engineering, finish, halve, new_axes, some, style
from bearingdyn.plot.phase_axis import continuous_phase, finish_phase

if TYPE_CHECKING:
    import xarray
    from matplotlib.axes import Axes

DEPTH = 1e-6  # of the largest line: 120 dB, as in `spectrum`


@figure(datasets=results("bd.order_spectrum", "amplitude"))
def order_spectrum(datasets: Mapping[str, xarray.Dataset], ax: Axes | None = None) -> Axes:
    """Draw amplitudes by bd.order_spectrum over orders of the shaft speed, several by label, 120 dB deep.

    Parameters
    ----------
    datasets
        Results of `bd.order_spectrum` by label, in one unit.
    ax
        Axes to draw into; None: those of a new figure.

    Returns
    -------
    Axes
        The axes drawn into.

    Raises
    ------
    ValueError
        For a result that has no orders, or results in different units.
    """
    for label, data in some(datasets).items():
        if "order" not in data.coords or "time" in data.coords:
            raise ValueError(f"{label!r} is no spectrum over orders; make it with bd.order_spectrum")
    units = {str(data["amplitude"].attrs["units"]) for data in datasets.values()}
    if len(units) > 1:
        raise ValueError(f"spectra in {sorted(units)} do not go into one figure; draw one of each")
    channels = sorted({str(data.attrs["channel"]) for data in datasets.values()})
    with style():
        ax = ax or new_axes(width=6.8)
        drawn = []
        for k, (label, data) in enumerate(datasets.items()):
            order, amplitude = data["order"].values[1:], data["amplitude"].values[1:]  # the mean is left out
            ax.plot(order, amplitude, color=colour(k), linewidth=0.8, label=label, zorder=2 + 0.1 * k)
            drawn.append(amplitude)
        size = np.concatenate(drawn)
        largest = float(size.max(initial=0.0))
        if largest > 0:
            ax.set_yscale("log")
            ax.set_ylim(max(0.5 * float(size.min()), DEPTH * largest), 2.0 * largest)
            size = np.maximum(size, DEPTH * largest)
        ax.set_xlim(0.0, max(float(data["order"].values[-1]) for data in datasets.values()))
        ax.set_xlabel("order of the shaft speed")
        ax.set_ylabel(f"amplitude, zero-to-peak, {engineering(ax.yaxis, size, units.pop())}")
        finish(ax, f"Order spectrum of {', '.join(channels)}", legend=True)
    return ax


@figure(data=result("bd.track_orders", "amplitude"))
def orders(
    data: xarray.Dataset,
    wanted: Sequence[float] | None = None,
    ax: Axes | None = None,
    *,
    phase: bool = False,
) -> Axes:
    """Draw orders by bd.track_orders: amplitudes over the speed in rpm, on a log axis.

    They are drawn over the time if the speed does not change, or turns back. With `phase` the axes are
    halved, and the phases against the angle of the shaft stand below.

    Parameters
    ----------
    data
        Result of `bd.track_orders`.
    wanted
        Orders drawn; None: all of them.
    ax
        Axes to draw into; None: those of a new figure.
    phase
        Draw the phases too.

    Returns
    -------
    Axes
        The axes of the amplitudes.

    Raises
    ------
    ValueError
        For a result without tracked orders, or an order that was not tracked.
    """
    if "order" not in data.coords or "speed" not in data:
        raise ValueError("data is a result without tracked orders; make it with bd.track_orders")
    known = data["order"].values
    chosen = known if wanted is None else np.atleast_1d(np.asarray(wanted, dtype=np.float64))
    for order in chosen:
        if not (known == order).any():
            raise ValueError(
                f"wanted is {wanted!r}; order {order:g} was not tracked, it must be one of {known.tolist()}"
            )
    speed = np.asarray(data["speed"].values) * RPM
    one_way = speed.size > 1 and bool((np.diff(speed) > 0).all() or (np.diff(speed) < 0).all())
    across = speed if one_way else data["time"].values
    found = data["amplitude"].sel(order=chosen).values
    with style():
        ax = ax or new_axes(height=4.8 if phase else 3.4)
        lower = halve(ax, share=0.3) if phase else None
        for k, order in enumerate(chosen):
            dash = DASHES[k % len(DASHES)]
            ax.plot(across, np.abs(found[:, k]), color=colour(k), linestyle=dash, label=f"{order:g}×")
            if lower is not None:
                lower.plot(across, continuous_phase(found[:, k]), color=colour(k), linestyle=dash)
        size = np.abs(found)
        if size.any():
            ax.set_yscale("log")
        unit = engineering(ax.yaxis, size, str(data["amplitude"].attrs["units"]))
        ax.set_ylabel(f"amplitude, zero-to-peak, {unit}")
        bottom = lower or ax
        bottom.set_xlabel("speed, rpm" if one_way else "time, s")
        if across.size > 1:
            bottom.set_xlim(float(across.min()), float(across.max()))
        if lower is not None:
            finish_phase(lower)
        finish(ax, f"Orders of {data.attrs['channel']}", legend=True)
    return ax
