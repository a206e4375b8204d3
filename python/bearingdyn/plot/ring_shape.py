"""The figure of a ring that bends between its balls, with their loads."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from bearingdyn.parts import FlexibleBearing
from bearingdyn.plot.arguments import figure, one
from bearingdyn.plot.frame import COLOURS, GREY, finish, new_axes, style

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_DEEPEST = 0.25  # of the race's radius, to which the largest motion is drawn
_LONGEST = 0.45  # the same of the largest ball load


@figure(bearing=one(FlexibleBearing, maker="a bd.FlexibleBearing(…)"))
def ring_shape(bearing: FlexibleBearing, load: ArrayLike, angle: float = 0.0, ax: Axes | None = None) -> Axes:
    """Draw the race of a bearing's outer ring under a load, its motion magnified, and the loads of the balls.

    Parameters
    ----------
    bearing
        With its flexible ring.
    load
        (6,) on the inner ring, N and N m.
    angle
        Of the cage, rad.
    ax
        Axes to draw into; None: those of a new figure.

    Returns
    -------
    Axes
        The axes drawn into; x to the right and y up, in mm.

    Raises
    ------
    ValueError
        For anything but a FlexibleBearing, or a load that has no equilibrium.
    """
    q = bearing.displacement(load, angle)
    loads = bearing.ball_loads(q, angle)
    psi = np.linspace(0.0, 2.0 * np.pi, 721)
    motion = bearing.race(q, psi, angle)[:, 0]
    radius = 1e3 * bearing.ring.r_inner
    largest = float(np.abs(motion).max())
    magnified = _DEEPEST * radius / largest if largest > 0 else 0.0
    around = np.stack([np.cos(psi), np.sin(psi)])
    at = bearing.bearing.angle0 + angle + 2.0 * np.pi * np.arange(loads.size) / loads.size
    with style():
        ax = ax or new_axes(width=4.8, height=4.8)
        ax.plot(*(radius * around), "--", color=GREY, linewidth=0.8, label="round")
        label = f"race, {1e-3 * magnified:.0f} times"
        ax.plot(*((radius + magnified * motion) * around), color=COLOURS[0], linewidth=2.0, label=label)
        reach = _LONGEST * radius / max(float(loads.max()), 1e-300)
        for k, (a, Q) in enumerate(zip(at, loads, strict=True)):
            tip = radius + magnified * np.interp(a % (2.0 * np.pi), psi, motion)
            ends = np.array([tip - reach * Q, tip])
            own = f"ball loads, to {loads.max():.0f} N" if k == 0 else None
            ax.plot(ends * np.cos(a), ends * np.sin(a), color=COLOURS[1], linewidth=2.5, label=own)
            ax.plot(tip * np.cos(a), tip * np.sin(a), "o", color=COLOURS[1] if Q > 0 else GREY, ms=4)
        ax.set_aspect("equal")
        ax.set_xlabel("x, mm")
        ax.set_ylabel("y, mm")
        finish(ax, f"The race moves by up to {1e6 * largest:.3g} µm", legend=True)
    return ax
