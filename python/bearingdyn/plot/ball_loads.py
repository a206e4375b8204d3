"""The figure of the loads of the balls around a bearing."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from bearingdyn.analysis import BearingState
from bearingdyn.plot.arguments import figure, row
from bearingdyn.plot.frame import (
    COLOURS,
    GREY,
    new_axes,
    style,
)

if TYPE_CHECKING:
    from matplotlib.axes import Axes


def _loads(name: str, value: object) -> None:
    if not isinstance(value, BearingState):
        row("it must be one finite load per ball, in N, or a bearing of an equilibrium")(name, value)


@figure(loads=_loads)
def ball_loads(loads: BearingState | ArrayLike, ax: Axes | None = None, *, angle: float = 0.0) -> Axes:
    """Draw the recorded load of each ball, N, around the bearing: azimuth from x (right) towards y (up).

    Parameters
    ----------
    loads
        A bearing of an equilibrium, or (Z,) N.
    ax
        Axes to draw into, polar; None: those of a new figure.
    angle
        Azimuth of the first ball, rad.

    Returns
    -------
    Axes
        The axes drawn into.

    Raises
    ------
    ValueError
        If the loads are not a list of finite numbers or the axes are not polar.
    """
    Q = np.asarray(loads.loads if isinstance(loads, BearingState) else loads, dtype=np.float64)
    if Q.ndim != 1 or Q.size == 0 or not np.isfinite(Q).all():
        raise ValueError(f"loads is an array of shape {Q.shape}; it must be one finite load per ball, in N")
    if ax is not None and ax.name != "polar":
        raise ValueError(f"ax has the projection {ax.name!r}; ball loads need projection='polar'")
    from matplotlib.ticker import MaxNLocator

    psi = angle + 2 * np.pi * np.arange(Q.size) / Q.size
    loaded = Q > 0
    with style():
        ax = ax or new_axes(width=4.4, height=4.6, projection="polar")
        scale: Any = ax  # polar
        ax.bar(psi, Q, width=0.5 * 2 * np.pi / Q.size, color=COLOURS[0], linewidth=0)
        largest = float(Q.max())
        top = 1.1 * largest if largest > 0 else 1.0
        ax.set_ylim(0.0, top)
        # the scale stands between two balls, on the side that carries least
        neighbours = Q + np.roll(Q, -1)
        between = psi[int(np.argmin(neighbours))] + np.pi / Q.size
        ax.yaxis.set_major_locator(MaxNLocator(4))
        scale.set_rlabel_position(float(np.degrees(between)) % 360)
        ax.set_xticks(psi % (2 * np.pi), [f"{k + 1}" for k in range(Q.size)])
        ax.set_xlabel(f"ball number at its azimuth; {np.count_nonzero(loaded)} of {Q.size} loaded")
        ax.set_ylabel("ball load, N", labelpad=24)
        ax.set_title(f"Ball loads, the largest {largest:.4g} N", pad=14)
        ax.tick_params(labelsize=8, colors=GREY)
        ax.grid(color="0.85", linewidth=0.6)
        ax.set_axisbelow(True)
    return ax
