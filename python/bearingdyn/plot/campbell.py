"""The Campbell diagram: natural frequencies over the speed of the shaft."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from bearingdyn.plot.arguments import figure, result
from bearingdyn.plot.frame import RPM, colour, finish, new_axes, style
from bearingdyn.types import Array

if TYPE_CHECKING:
    import xarray
    from matplotlib.axes import Axes


# a mode that whirls at least as round as this is drawn as forward or backward
ROUND = 0.1
ROOM = 1.12  # above the highest mode of a Campbell diagram, for the names of the orders
NUMBER = 7.5  # size of the speeds beside the rings of a Campbell diagram, points


@figure(data=result("bd.campbell", "speed", "frequency", "whirl", "eigenvalue"))
def campbell(data: xarray.Dataset, orders: tuple[float, ...] = (1.0,), ax: Axes | None = None) -> Axes:
    """Draw the Campbell diagram of `bd.campbell` over the speed in rpm; modes told apart by their motion.

    Lateral modes that whirl are forward or backward, the others lateral; there are axial and torsional
    ones too.

    A ring stands where a mode that swings crosses an order (straight between the speeds computed), and
    beside it the speed in rpm where there is room.

    Parameters
    ----------
    data
        Result of `bd.campbell`.
    orders
        Orders of the shaft speed, drawn as rays.
    ax
        Axes to draw into; None: those of a new figure.

    Returns
    -------
    Axes
        The axes drawn into.
    """
    rpm = data["speed"].values * RPM
    order = np.argsort(rpm)
    frequency, whirl = data["frequency"].values[order], data["whirl"].values[order]
    rpm = rpm[order]
    kinds = {
        "forward": (0, "-"), "backward": (1, "--"), "lateral": (2, ":"),
        "axial": (3, "-."), "torsional": (4, "-."),
    }  # fmt: skip
    # results of before 0.3 do not say it
    direction = data["direction"].values if "direction" in data else ["lateral"] * frequency.shape[1]
    with style():
        ax = ax or new_axes()
        named: set[str] = set()
        for k in range(frequency.shape[1]):
            turn = float(np.mean(whirl[:, k]))
            kind = str(direction[k])
            if kind == "lateral" and abs(turn) > ROUND:
                kind = "forward" if turn > 0 else "backward"
            shade, dash = kinds[kind]
            label = kind if kind not in named else None
            named.add(kind)
            ax.plot(rpm, frequency[:, k], color=colour(shade), linestyle=dash, label=label)
        top = float(frequency.max(initial=0.0)) * ROOM
        for each in orders:
            ax.plot(rpm, each * rpm / 60, color="0.6", linewidth=0.7)
            leaves = 60 * top / each if each > 0 else np.inf  # order 0 never does
            end = min(float(rpm[-1]), leaves)
            inside = "bottom" if end < leaves else "top"  # where it leaves to the right, or above
            ax.annotate(
                f"{each:g}×", (end, each * end / 60), xytext=(-4.0, 0.0), textcoords="offset points",
                ha="right", va=inside, color="0.35",
            )  # fmt: skip
        ax.set_ylim(0.0, top)
        ax.set_xlim(float(rpm[0]), float(rpm[-1]))
        swinging = np.abs(data["eigenvalue"].values[order].imag) > 0
        _ring(ax, np.concatenate([_crossings(rpm, frequency, swinging, each) for each in [*orders] or [0.0]]))
        ax.set_xlabel("speed, rpm")
        ax.set_ylabel("natural frequency, Hz")
        finish(ax, "Campbell diagram", legend=True)
    return ax


def _crossings(rpm: Array, frequency: Array, swinging: NDArray[np.bool_], order: float) -> Array:
    """Speed, rpm, and frequency, Hz, (n, 2), where modes (speed, mode) cross an order above standstill."""
    gap = frequency - order * rpm[:, None] / 60
    below, above = gap[:-1], gap[1:]
    step, mode = np.nonzero((below * above <= 0) & (below != above) & swinging[:-1] & swinging[1:])
    share = below[step, mode] / (below[step, mode] - above[step, mode])
    speed = rpm[step] + share * (rpm[step + 1] - rpm[step])
    found = np.unique(np.column_stack([speed, order * speed / 60]), axis=0)
    return np.asarray(found[found[:, 1] > 0])


def _ring(ax: Axes, crossings: Array) -> None:
    """Rings (n, 2), each with its speed written below to the right unless another stands there."""
    if not crossings.size:
        return
    ax.plot(
        *crossings.T, linestyle="none", marker="o", markersize=7, markerfacecolor="none",
        markeredgecolor="0.2", label="crosses an order, rpm", zorder=4,
    )  # fmt: skip
    letter = NUMBER / 72 * ax.figure.dpi  # pixels
    taken: list[Array] = []
    for place in crossings[np.argsort(crossings[:, 0])]:
        at = ax.transData.transform(place)
        text = f"{place[0]:.0f}"
        width = 0.6 * letter * len(text)
        if at[0] + width + letter > ax.bbox.x1 or at[1] - 1.5 * letter < ax.bbox.y0:
            continue
        if any(at[0] - other[0] < width + letter and abs(at[1] - other[1]) < 1.3 * letter for other in taken):
            continue
        taken.append(at)
        ax.annotate(
            text, place, xytext=(4.0, -3.0), textcoords="offset points", ha="left", va="top",
            fontsize=NUMBER, color="0.2", zorder=5,
            bbox={"facecolor": "white", "edgecolor": "none", "alpha": 0.75, "pad": 0.3},
        )  # fmt: skip
