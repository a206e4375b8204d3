"""The figure of the stiffness of bearings over load."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from bearingdyn.bearing import BallBearing, Running
from bearingdyn.plot.arguments import figure, row, several
from bearingdyn.plot.frame import DASHES, colour, finish, new_axes, some, style

if TYPE_CHECKING:
    from matplotlib.axes import Axes


STIFFNESSES = {"x": 0, "y": 1, "z": 2, "θx": 3, "θy": 4}


@figure(
    bearings=several(BallBearing, Running, maker="a bd.BallBearing(…) or Running"),
    loads=row("it must be loads in N"),
)
def bearing_stiffness(
    bearings: Mapping[str, BallBearing | Running],
    direction: ArrayLike,
    loads: ArrayLike,
    component: str = "x",
    ax: Axes | None = None,
) -> Axes:
    """Draw the diagonal stiffness against load, several bearings by label, both axes logarithmic.

    Parameters
    ----------
    bearings
        Bearings by label, at rest, or with the inertia of their balls.
    direction
        (6,) load per unit of `loads`, N and N m; (1, 0, 0, 0, 0, 0) for a radial load.
    loads
        (n,) increasing and positive.
    component
        "x", "y", "z" (N/m), "θx" or "θy" (N m).
    ax
        Axes to draw into; None: those of a new figure.

    Returns
    -------
    Axes
        The axes drawn into.

    Raises
    ------
    ValueError
        For an unknown component or loads that do not increase from above zero.
    """
    F = np.asarray(loads, dtype=np.float64)
    if component not in STIFFNESSES:
        raise ValueError(f"component is {component!r}; it must be one of {', '.join(STIFFNESSES)}")
    if F.ndim != 1 or F.size < 2 or not (F > 0).all() or not (np.diff(F) > 0).all():
        raise ValueError("loads must be two or more positive numbers that increase, in N")
    k = STIFFNESSES[component]
    unit = np.asarray(direction, dtype=np.float64)
    curves = {
        label: [float(b.stiffness(b.displacement(force * unit))[k, k]) for force in F]
        for label, b in some(bearings).items()
    }
    with style():
        ax = ax or new_axes()
        for j, (label, values) in enumerate(curves.items()):
            ax.plot(F, values, color=colour(j), linestyle=DASHES[j % len(DASHES)], label=label)
        ax.set_xscale("log")
        ax.set_yscale("log")
        ax.set_xlim(float(F[0]), float(F[-1]))
        ax.set_xlabel("load, N")
        ax.set_ylabel(f"stiffness {component}{component}, {'N/m' if k < 3 else 'N m'}")
        finish(ax, "Stiffness of the bearing at its equilibrium", legend=True)
    return ax
