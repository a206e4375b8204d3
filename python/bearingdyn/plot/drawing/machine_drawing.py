"""The sheet: a machine's section along its shaft, to scale, with loads, names, dimensions and parts list."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from bearingdyn.application import GROUND, Application, DirectedLoad, Place
from bearingdyn.checks import truth
from bearingdyn.plot.arguments import figure, one
from bearingdyn.plot.drawing.bearing_section import draw_bearing, fine
from bearingdyn.plot.drawing.labels import TEXT, axes_glyph, balloons, dimensions, place_names
from bearingdyn.plot.drawing.loads import draw_load
from bearingdyn.plot.drawing.shown_machine import Machine, machine, surface
from bearingdyn.plot.drawing.supports import damper, ground, spring
from bearingdyn.plot.drawing.words import parts_list
from bearingdyn.plot.frame import style
from bearingdyn.types import Array

if TYPE_CHECKING:
    from matplotlib.axes import Axes

LOOK: dict[str, dict[str, Any]] = {
    "shaft": {"facecolor": "#e9eef2", "hatch": "", "zorder": 4.0},
    "metal": {"facecolor": "#f4f1ea", "hatch": "////", "zorder": 2.0},
    "rubber": {"facecolor": "#f2b632", "hatch": "xxxx", "zorder": 3.0},
    "body": {"facecolor": "#e9eef255", "hatch": "", "zorder": 1.0, "linestyle": "--"},
}
WIDTH = 10.0  # inches of the sheet
LINE = 0.17  # inches from one line of the parts list to the next


@figure(app=one(Application, maker="an Application (bd.Application())"), table=truth)
def draw(app: Application, ax: Axes | None = None, *, table: bool = True) -> Axes:
    """Draw a machine on one sheet before anything is solved: the section along its shaft, to scale, in mm.

    Shafts are drawn whole, all else is cut by the plane x = 0: metal hatched, rubber crossed and yellow. The
    bearings have their rings, balls and line of contact. Red arrows are loads, with their values, hatched
    lines the ground; x points away from the reader. Numbered balloons belong to the parts list below.

    Parameters
    ----------
    app
        The application.
    ax
        Axes to draw into, without a parts list; None: those of a new sheet.
    table
        Whether a new sheet has the parts list.

    Returns
    -------
    Axes
        The axes of the section.

    Raises
    ------
    ValueError
        For an application without parts.
    """
    shown = machine(app.plan)
    if not app.plan.parts:
        raise ValueError("the application has no parts; there is nothing to draw: add some with app.add")
    own = ax is None
    rows = parts_list(app.plan)
    with style():
        low, high = _extent(shown)
        span = high - low
        if ax is None:
            ax = _sheet(span, len(rows) if table else 0)
        scale = _scale(ax, span)  # mm a point
        ax.set_aspect("equal", adjustable="datalim" if not own else "box")
        ax.axis("off")
        _parts(ax, shown)
        _bearings(ax, shown)
        reach = _supports(ax, shown, scale)
        ax.plot(
            [low[0] - 14 * scale, high[0] + 14 * scale], [0.0, 0.0], color="0.3", linewidth=0.6,
            linestyle=(0, (14, 3, 2, 3)), zorder=7,
        )  # fmt: skip
        bottom = min(low[1], reach)
        notes, tips = _loads(ax, shown, 34 * scale)
        summit = max(float(high[1]), tips - 18 * scale)
        if table or own:
            balloons(ax, shown, list(rows), summit, scale)
        axes_glyph(ax, float(low[0]) - 30 * scale, summit + 26 * scale, scale)
        under = place_names(ax, shown, bottom - 10 * scale, scale)
        foot = dimensions(ax, shown, under, scale)
        top = summit + (62 if table or own else 44) * scale
        ax.set_xlim(low[0] - 40 * scale, high[0] + 40 * scale)
        ax.set_ylim(foot - 10 * scale, top)
        if own and table:
            _resize(ax, foot - 10 * scale, top, LINE * (len(rows) + len(notes) + 3.4))
            _table(ax, rows.values(), notes + _lost(shown))
        elif own:
            _resize(ax, foot - 10 * scale, top, 0.1 + LINE * len(notes))
        if notes and not (own and table):
            ax.text(0.0, 0.0, "\n".join(notes), transform=ax.transAxes, fontsize=TEXT, va="top", color="0.2")
    return ax


# ------------------------------------------------------------------------------------------------- paper


def _extent(shown: Machine) -> tuple[Array, Array]:
    """Lowest and highest z and y, mm, of all that is drawn to scale, and of its places."""
    at = [shown.corners(), *(place[None, [2, 1]] for place in shown.places.values())]
    for joint in shown.plan.bearings.values():
        place = shown.balls(joint)
        if place is not None:
            r = 0.5e3 * (joint.bearing.Dpw + 1.7 * joint.bearing.Dw)
            at.append(
                place[[2, 1]] + np.array([[-0.8e3 * joint.bearing.Dw, -r], [0.8e3 * joint.bearing.Dw, r]])
            )
    points = np.concatenate(at)
    low, high = points.min(axis=0), points.max(axis=0)
    least = 1e-3 * max(float((high - low).max()), 1.0)
    return low - least, high + least


def _sheet(span: Array, rows: int) -> Axes:
    import matplotlib.pyplot as plt

    figure = plt.figure(figsize=(WIDTH, 5.0))
    return figure.add_axes((0.02, 0.3, 0.96, 0.68))


def _scale(ax: Axes, span: Array) -> float:
    """Millimetres on the machine that one point on paper stands for."""
    width = float(ax.bbox.width) / float(ax.figure.dpi) * 72.0
    height = float(ax.bbox.height) / float(ax.figure.dpi) * 72.0
    figure: Any = ax.figure
    if figure.get_size_inches()[0] == WIDTH:
        # the height of a sheet of our own follows; a tall machine is drawn narrower
        return float(max(span[0] / (width - 80.0), span[1] / 430.0))
    return float(max(span[0] / max(width - 80.0, 50.0), span[1] / max(height - 130.0, 50.0)))


def _resize(ax: Axes, foot: float, top: float, below: float) -> None:
    """Give the sheet the height that the section needs, and the list below it, inches."""
    figure: Any = ax.figure
    low, high = ax.get_xlim()
    wide = 0.96 * WIDTH
    tall = min(wide * (top - foot) / (high - low), 7.6)
    total = tall + below + 0.15
    figure.set_size_inches(WIDTH, total)
    ax.set_position((0.02, below / total, 0.96, tall / total))


def _table(ax: Axes, rows: Any, notes: Sequence[str]) -> None:
    """The parts list below the section."""
    figure: Any = ax.figure
    total = float(figure.get_size_inches()[1])
    y = float(ax.get_position().y0) - 0.6 * LINE / total
    step = LINE / total
    columns = (0.03, 0.075, 0.25, 0.97)
    look: dict[str, Any] = {"fontsize": TEXT, "va": "center", "transform": figure.transFigure}
    heads = ("no.", "name", "what (lengths in mm)", "mass")

    def line(at: float, width: float) -> None:
        from matplotlib.lines import Line2D

        figure.add_artist(Line2D([0.03, 0.97], [at, at], color="0.2", linewidth=width))

    line(y, 1.0)
    y -= 0.7 * step
    for x, head in zip(columns, heads, strict=True):
        figure.text(x, y, head, ha="right" if head == "mass" else "left", color="0.35", **look)
    y -= 0.6 * step
    line(y, 0.5)
    y -= 0.7 * step
    for k, (name, told, mass) in enumerate(rows, 1):
        for x, text in zip(columns, (str(k), name, told, mass), strict=True):
            figure.text(x, y, text, ha="right" if x == columns[-1] else "left", **look)
        y -= step
    line(y + 0.35 * step, 1.0)
    for note in notes:
        y -= 0.35 * step
        figure.text(columns[0], y, note, color="#8a1a1e", **look)
        y -= 0.65 * step


def _lost(shown: Machine) -> list[str]:
    if not shown.missing:
        return []
    return [
        f"not drawn, for nothing says where they stand or what they look like: {', '.join(shown.missing)}"
    ]


# ---------------------------------------------------------------------------------------------- machine


def _parts(ax: Axes, shown: Machine) -> None:
    from matplotlib.patches import Polygon

    for k, part in enumerate(shown.parts):
        for profile in part.profiles:
            look = dict(LOOK[profile.matter])
            # neighbours of metal are hatched in turn
            if profile.matter == "metal" and k % 2:
                look["hatch"] = "\\\\\\\\"
            size = float(np.ptp(profile.corners, axis=0).min())
            look["zorder"] -= 0.001 * min(size, 900.0)  # the smaller lies on top
            shape = Polygon(profile.corners, edgecolor="0.1", linewidth=0.8, **look)
            fine(shape)
            ax.add_patch(shape)


def _bearings(ax: Axes, shown: Machine) -> None:
    for joint in shown.plan.bearings.values():
        at = shown.balls(joint)
        if at is None:
            continue
        held = [_diameter(shown, place) for place in (joint.inner, joint.outer)]
        rings = (True, shown.plan.raceway(joint.outer) is None)
        draw_bearing(ax, joint.bearing, at[[2, 1]], bore=held[0], outside=held[1], rings=rings)


def _diameter(shown: Machine, place: Place) -> float | None:
    faces = () if place == GROUND else shown.plan.faces(place)
    return 2e3 * faces[-1].radius if faces else None


def _supports(ax: Axes, shown: Machine, scale: float) -> float:
    """The ground, springs and dampers; returns how far down they reach, mm."""
    lowest = float("inf")
    size = 7 * scale
    for place, support in shown.plan.supports.items():
        at = shown.places.get(str(place))
        if at is None:
            continue
        springs = support.stiffness is not None and bool(np.any(support.stiffness))
        dampers = support.damping is not None and bool(np.any(support.damping))
        if support.rigid:
            lowest = min(lowest, _rigid(ax, shown, place, at, size))
        elif springs or dampers:
            lowest = min(lowest, _sprung(ax, shown, place, at, scale, springs, dampers))
    for joint in shown.plan.bearings.values():
        at = shown.balls(joint)
        if joint.outer == GROUND and at is not None:
            r, half = _outside(joint.bearing)
            _round(ax, at, r, at[2] - half, at[2] + half, size, 1.0)
            lowest = min(lowest, float(at[1]) - r - size)
    for bush in shown.plan.springs:
        at = shown.places.get(str(bush.a))
        if at is None:
            continue
        if bush.b == GROUND:
            both = bool(np.any(bush.stiffness)), bool(np.any(bush.damping))
            lowest = min(lowest, _sprung(ax, shown, bush.a, at, scale, *both))
        else:
            _between(ax, shown, bush.a, bush.b, at, scale)
    return lowest


def _outside(bearing: Any) -> tuple[float, float]:
    """Radius and half the width of a bearing's outside, mm."""
    if bearing.boundary is not None:
        return 0.5e3 * bearing.boundary[1], 0.5e3 * bearing.boundary[2]
    return 0.5e3 * bearing.Dpw + 0.83e3 * bearing.Dw, 0.8e3 * bearing.Dw


def _rigid(ax: Axes, shown: Machine, place: Place, at: Array, size: float) -> float:
    face = surface(shown, place)
    if face is not None:
        sign, r, low, high = face
        _round(ax, at, r, low, high, size, sign)
        return float(at[1]) - r - size
    own = next((p for p in shown.parts if p.name == place.part), None)
    if own is not None:
        corners = np.concatenate([p.corners for p in own.profiles])
        z = corners[:, 0]
        below = abs(float(at[1]) - float(corners[:, 1].min())) < 1e-6 * max(float(np.ptp(corners)), 1.0)
        if not below and float(np.ptp(corners[:, 1])) > 0:
            # held somewhere within: the ground comes up beneath it
            low = float(corners[:, 1].min())
            ground(ax, np.array([z.min(), low]), np.array([z.max(), low]), size)
            return low - size
        margin = 0.15 * float(np.ptp(z))
        ground(ax, np.array([z.min() - margin, at[1]]), np.array([z.max() + margin, at[1]]), size)
    else:
        ground(ax, at[[2, 1]] + (-2 * size, 0.0), at[[2, 1]] + (2 * size, 0.0), size)
    return float(at[1]) - size


def _round(ax: Axes, at: Array, r: float, low: float, high: float, size: float, sign: float) -> None:
    """The ground around (sign 1) or within (−1) a cylinder."""
    for up in (1.0, -1.0):
        ends = [np.array([low, at[1] + up * r]), np.array([high, at[1] + up * r])]
        # hatched on the side away from the part
        start, end = ends if (up * sign) < 0 else ends[::-1]
        ground(ax, start, end, size)


def _sprung(
    ax: Axes, shown: Machine, place: Place, at: Array, scale: float, springs: bool, dampers: bool
) -> float:
    z = float(at[2])
    reach = shown.reach(z, place.part)
    start = reach[0] if reach else float(at[1])
    length, size = 30 * scale, 8 * scale
    foot = start - length
    drawn = [kind for kind, there in ((spring, springs), (damper, dampers)) if there]
    for k, kind in enumerate(drawn):
        x = z + (k - 0.5 * (len(drawn) - 1)) * 2.2 * size
        kind(ax, np.array([x, start]), np.array([x, foot]), size)
    ground(ax, np.array([z - 2.4 * size, foot]), np.array([z + 2.4 * size, foot]), 6 * scale)
    return foot - 6 * scale


def _between(ax: Axes, shown: Machine, a: Place, b: Place, at: Array, scale: float) -> None:
    """A spring between two parts at one place: from the outside of the inner to the inside of the outer."""
    z, size = float(at[2]), 7 * scale
    ends = [shown.reach(z, place.part) for place in (a, b)]
    known = [end[1] for end in ends if end is not None]
    low = min(known) if known else float(at[1])
    high = max(known) if len(known) > 1 else low + 20 * scale
    if high - low < 12 * scale:
        high = low + 12 * scale
    spring(ax, np.array([z, high]), np.array([z, low]), size)


def _loads(ax: Axes, shown: Machine, size: float) -> tuple[list[str], float]:
    """Notes on loads without a place, and how far up the arrows reach, mm."""
    notes: list[str] = []
    tips = -float("inf")
    count: dict[Place, int] = {}
    for load in shown.plan.loads:
        notes += draw_load(ax, shown, load, size, count.get(load.where, 0))
        count[load.where] = count.get(load.where, 0) + 1
        at = shown.places.get(str(load.where))
        if at is not None and isinstance(load, DirectedLoad) and load.vector[1] < 0:
            reach = shown.reach(float(at[2]), load.where.part)
            tips = max(tips, (reach[1] if reach else float(at[1])) + 1.5 * size)
    return notes, tips
