"""The figure of what sound power comes from: levels of paths or modes alone, and their shares below."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from bearingdyn.checks import one_of
from bearingdyn.plot.arguments import figure, result
from bearingdyn.plot.frame import DASHES, colour, finish, halve, new_axes, style, written_out
from bearingdyn.sound import level

if TYPE_CHECKING:
    import xarray
    from matplotlib.axes import Axes

SILENT = 1e-12  # of the largest power, below which a curve is left out
CUT = 300.0  # %
DEEP = 100.0  # dB that the levels show
WIDE = 5.0  # ratio of frequencies, from which on the axis is logarithmic


@figure(
    data=result("bd.sound_contributions", "power", "path_power", "path_alone", "mode_power", "mode_alone"),
    by=lambda name, value: one_of(name, value, ("path", "mode")),
)
def sound_contributions(data: xarray.Dataset, ax: Axes | None = None, *, by: str = "path") -> Axes:
    """Draw sound power by `bd.sound_contributions` over frequency, with what each path or mode gives.

    Above stand levels, dB re 1 pW for an input of one: the sound power in black, and what each path would
    radiate alone. Below stand the shares in the power, which add up to 100 %; they are cut at ±300 %, where
    paths cancel one another.

    Parameters
    ----------
    data
        Result of `bd.sound_contributions`.
    ax
        Axes to draw into, which are halved; None: those of a new figure.
    by
        "path" or "mode".

    Returns
    -------
    Axes
        The axes of the levels.
    """
    names = [str(name) for name in data[by].values]
    f, power = data["frequency"].values, data["power"].values
    alone, shares = data[f"{by}_alone"].values, data[f"{by}_power"].values
    # what gives nothing, as the direct path of a force on the shaft, is no curve
    audible = [k for k in range(len(names)) if alone[:, k].max() > SILENT * power.max()]
    with style():
        ax = ax or new_axes(height=4.8)
        lower = halve(ax, share=0.4)
        ax.plot(f, level(power, "power"), color="black", linewidth=1.6, label="together")
        for n, k in enumerate(audible):
            look: dict[str, Any] = {"color": colour(n), "linestyle": DASHES[n // 6 % len(DASHES)]}
            ax.plot(f, level(np.maximum(alone[:, k], 0.0), "power"), label=names[k], **look)
            with np.errstate(divide="ignore", invalid="ignore"):
                lower.plot(f, 100.0 * shares[:, k] / power, **look)
        lower.axhline(0.0, color="0.6", linewidth=0.7)
        low, high = lower.get_ylim()
        lower.set_ylim(max(low, -CUT), min(high, CUT))
        if f.min() > 0 and f.max() / f.min() >= WIDE:
            lower.set_xscale("log")
            written_out(lower.xaxis, float(np.log10(f.max() / f.min())))
        if f.size > 1:
            lower.set_xlim(f.min(), f.max())
        lower.set_xlabel("frequency, Hz")
        lower.set_ylabel("share, %")
        finish(lower)
        ax.set_ylabel("level, dB re 1 pW")
        low, high = ax.get_ylim()
        ax.set_ylim(max(low, high - DEEP), high)
        finish(ax, f"Sound power by {by}, an input of one at {data.attrs['input']}", legend=True)
    return ax
