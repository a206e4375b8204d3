"""The figure of a mode from the side, part by part."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from bearingdyn.application import Place
from bearingdyn.plot.arguments import figure, result
from bearingdyn.plot.frame import colour, finish, new_axes, style

if TYPE_CHECKING:
    import xarray
    from matplotlib.axes import Axes


# of the size of the structure, by which the largest motion of a shape is drawn
SWING = 0.1


@figure(data=result("bd.mode_shapes", "frequency", "motion"))
def mode_shape(data: xarray.Dataset, mode: int, ax: Axes | None = None, *, axis: str = "y") -> Axes:
    """Draw a mode by `bd.mode_shapes` from the side, part by part: motion along `axis` over z, rest in grey.

    The largest motion is drawn a tenth as long as the structure. Phases are turned so that it is real; the
    motion of a damped mode a quarter period later is drawn thin. Where the largest motion is along z, arrows
    at the bottom say where each place moves.

    Parameters
    ----------
    data
        Result of `bd.mode_shapes`.
    mode
        Its place in the dataset, counted from 0 as in `data.isel(mode=mode)`; the title gives it so.
    ax
        Axes to draw into; None: those of a new figure.
    axis
        "x" or "y", drawn upwards.

    Returns
    -------
    Axes
        The axes drawn into.

    Raises
    ------
    ValueError
        For a mode or an axis that is not there.
    """
    if axis not in ("x", "y"):
        raise ValueError(f"axis is {axis!r}; it must be 'x' or 'y', drawn upwards")
    count = data.sizes["mode"]
    if not 0 <= mode < count:
        raise ValueError(f"mode is {mode}; it must be one of 0 to {count - 1}")
    motion = data["motion"].values[mode]
    up, along = (motion[:, "xyz".index(a)] for a in (axis, "z"))
    z = data["position"].sel(axis="z").values
    height = data["position"].sel(axis=axis).values
    both = np.concatenate([up, along])
    largest = both[int(np.argmax(np.abs(both)))]
    along_only = float(np.abs(along).max()) > float(np.abs(up).max())  # along the line drawn: hard to see
    size = max(float(np.ptp(z)), float(np.ptp(height)), 1e-3)
    scale = SWING * size / largest if largest else 0.0
    up, along = up * scale, along * scale
    parts: dict[str, list[int]] = {}
    for k, name in enumerate(data["place"].values):
        parts.setdefault(Place.parse(str(name)).part, []).append(k)
    with style():
        ax = ax or new_axes(width=6.8)
        for k, (part, members) in enumerate(parts.items()):
            at = np.array(sorted(members, key=lambda i: z[i]))
            ax.plot(z[at] * 1e3, height[at] * 1e3, color="0.75", linewidth=0.8, marker=".", zorder=1)
            for turn, width in ((1.0, 1.6), (-1j, 0.6)):
                x, y = z[at] + (along[at] * turn).real, height[at] + (up[at] * turn).real
                label = part if width > 1.0 else None
                ax.plot(
                    x * 1e3, y * 1e3, color=colour(k), linewidth=width, marker="o", markersize=3, label=label
                )
        low, high = ax.get_ylim()
        least = 2e3 * SWING * size  # mm; round-off beside an axial motion is not drawn large
        if high - low < least:
            ax.set_ylim((low + high - least) / 2, (low + high + least) / 2)
        if along_only:
            look = {"arrowstyle": "->", "color": "0.2", "linewidth": 1.2, "shrinkA": 0, "shrinkB": 0}
            foot = ax.get_xaxis_transform()
            for start, shift in zip(z * 1e3, along.real * 1e3, strict=True):
                ax.annotate("", (start + shift, 0.02), (start, 0.02), xycoords=foot, arrowprops=look)
        ax.set_xlabel("z, mm" + ("; arrows: the motion along z" if along_only else ""))
        ax.set_ylabel(f"{axis}, mm")
        frequency = float(data["frequency"].values[mode])
        drawn = f", the largest motion drawn {1e3 * SWING * size:.3g} mm long"
        finish(ax, f"Mode {mode} (from 0) at {frequency:.4g} Hz{drawn}", legend=True)
    return ax
