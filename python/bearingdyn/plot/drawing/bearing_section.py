"""A ball bearing in section: rings with their grooves and shoulders, balls, and the line of contact."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from bearingdyn.bearing import BallBearing, shoulder
from bearingdyn.types import Array

if TYPE_CHECKING:
    from matplotlib.axes import Axes

SHOULDER = 0.20  # of Dw: how far from the pitch circle the land beside the groove lies
LOW = 0.42  # of Dw: the same where there is no shoulder
RING, EDGE = "#c9d3dc", "0.1"


def draw_bearing(
    ax: Axes,
    bearing: BallBearing,
    at: Array,
    *,
    bore: float | None = None,
    outside: float | None = None,
    rings: tuple[bool, bool] = (True, True),
    zorder: float = 6.0,
) -> tuple[float, float, float]:
    """Draw a bearing in section, above the axis and below.

    Parameters
    ----------
    at
        (2,) z and y of its centre, mm.
    bore, outside
        Diameters of its seats, mm, where the bearing does not know its own; None: a third of a ball is left.
    rings
        Whether the inner and the outer ring are drawn; not where parts of their own stand for them.

    Returns
    -------
    tuple
        Bore radius, outside radius and width, mm.
    """
    from matplotlib.patches import Circle, Polygon

    Dw, pitch = 1e3 * bearing.Dw, 0.5e3 * bearing.Dpw
    if bearing.boundary is not None:
        r_bore, r_outside, width = (
            0.5e3 * bearing.boundary[0],
            0.5e3 * bearing.boundary[1],
            1e3 * bearing.boundary[2],
        )
    else:
        r_bore, r_outside, width = pitch - 0.83 * Dw, pitch + 0.83 * Dw, 1.6 * Dw
        if bore is not None and pitch - Dw < 0.5 * bore < pitch - 0.55 * Dw:
            r_bore = 0.5 * bore
        if outside is not None and pitch + 0.55 * Dw < 0.5 * outside < pitch + Dw:
            r_outside = 0.5 * outside
    side = shoulder(bearing.open_side, bearing.contact_angle)
    look: dict[str, Any] = {"facecolor": RING, "edgecolor": EDGE, "linewidth": 0.6}
    for up in (1.0, -1.0):
        for drawn, back, sign, slope in ((rings[0], r_bore, -1.0, -side), (rings[1], r_outside, 1.0, side)):
            if drawn:
                corners = _ring(back, pitch, Dw, width, sign, slope)
                shape = Polygon(
                    at + corners * (1.0, up),
                    zorder=zorder,
                    hatch="/////" if sign > 0 else "\\\\\\\\\\",
                    **look,
                )
                fine(shape)
                ax.add_patch(shape)
        centre = at + (0.0, up * pitch)
        ax.add_patch(
            Circle(
                tuple(centre), 0.5 * Dw, facecolor="white", edgecolor=EDGE, linewidth=0.7, zorder=zorder + 0.2
            )
        )
        cross: dict[str, Any] = {"color": "0.45", "linewidth": 0.4, "zorder": zorder + 0.3}
        if side == 0:
            for dz, dr in ((0.62 * Dw, 0.0), (0.0, 0.62 * Dw)):
                ax.plot([centre[0] - dz, centre[0] + dz], [centre[1] - dr, centre[1] + dr], **cross)
        else:
            angle = bearing.contact_angle or 0.0
            way = np.array([side * math.sin(angle), up * math.cos(angle)])
            reach = 0.75 * Dw
            ends = np.stack([centre - reach * way, centre + reach * way])
            ax.plot(ends[:, 0], ends[:, 1], **{**cross, "color": "#D55E00", "linewidth": 0.8})
    return r_bore, r_outside, width


def fine(shape: Any) -> None:
    """Thin hatching of a bearing's section, where this matplotlib can have it for one shape."""
    if hasattr(shape, "set_hatch_linewidth"):
        shape.set_hatch_linewidth(0.35)


def _ring(back: float, pitch: float, Dw: float, width: float, sign: float, slope: float) -> Array:
    """Corners (k, 2) z and r of a ring, its back at a radius, its groove around the ball.

    slope is +1 where the high shoulder stands at +z, −1 at −z, 0 where both are high.
    """
    half = 0.5 * width
    highs = {s: SHOULDER if slope in (0, s) else LOW for s in (-1.0, 1.0)}
    start, end = (math.acos(min(highs[s], 0.499) / 0.5) for s in (-1.0, 1.0))
    # from −z to +z below (or above) the ball
    angle = np.linspace(-start, end, 25)
    groove = np.stack([0.5 * Dw * np.sin(angle), pitch + sign * 0.5 * Dw * np.cos(angle)], axis=-1)
    land = {s: pitch + sign * highs[s] * Dw for s in (-1.0, 1.0)}
    first = [(-half, back), (-half, land[-1.0])]
    last = [(half, land[1.0]), (half, back)]
    return np.array([*first, *groove, *last])
