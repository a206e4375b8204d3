"""Loads as arrows with their values."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from bearingdyn.application import (
    GRAVITY,
    GROUND,
    ConstantLoad,
    DirectedLoad,
    HarmonicLoad,
    Load,
    SampledLoad,
    Unbalance,
)
from bearingdyn.plot.drawing.shown_machine import Machine
from bearingdyn.types import Array
from bearingdyn.units import PREFIXES

if TYPE_CHECKING:
    from matplotlib.axes import Axes

RED = "#C1272D"
HALO: dict[str, Any] = {
    "boxstyle": "round,pad=0.12",
    "facecolor": "white",
    "edgecolor": "none",
    "alpha": 0.85,
}


def value(x: float, unit: str) -> str:
    """Value of a drawn load in the multiple of its unit that suits it: "−1.5 kN"."""
    if x == 0:
        return f"0 {unit}"
    power = 3 * math.floor(math.log10(abs(x)) / 3 + 1e-9)
    power = min(max(power, min(PREFIXES)), max(PREFIXES))
    return f"{x / 10.0**power:.4g} {PREFIXES[power]}{unit}".replace("-", "−")


def course(load: Load) -> str:
    """Beside a drawn load, how its value goes in time, in words."""
    if isinstance(load, HarmonicLoad):
        return f" cos at {load.frequency:g} Hz"
    if isinstance(load, SampledLoad):
        return " × table(t)"
    return ""


def draw_load(ax: Axes, machine: Machine, load: Load, size: float, count: int) -> list[str]:
    """Draw one load as arrows of length `size`, mm; `count` loads stand at its place already.

    Returns
    -------
    list of str
        What has no place in the picture, in words.
    """
    if load.where in (GRAVITY, GROUND):
        assert isinstance(load, ConstantLoad | HarmonicLoad | SampledLoad)
        what = "gravity" if load.where == GRAVITY else "motion of the ground"
        told = ", ".join(
            f"{axis} {value(x, 'm/s²')}" for axis, x in zip("xyz", load.vector.tolist(), strict=True) if x
        )
        return [f"{what}: {told or '0'}{course(load)}"]
    at = machine.places.get(str(load.where))
    if at is None:
        return [f"load at {load.where}: {load.size}"]
    place = at[[2, 1]]
    reach = machine.reach(float(place[0]), load.where.part) or (place[1], place[1])
    if isinstance(load, Unbalance):
        z = machine.corners()[:, 0]
        left = place[0] > z.min() + 0.7 * (z.max() - z.min())
        _unbalance(ax, place, reach, size, load, left)
        return []
    if isinstance(load, DirectedLoad):
        tell = course(load)
        F, M = load.vector[:3], load.vector[3:]
        double = not isinstance(load, ConstantLoad)
        shift = 0.25 * size * count
        if F[1]:
            _arrow(ax, place + (shift, 0.0), reach, float(F[1]), size, value(abs(F[1]), "N") + tell, double)
        if F[2]:
            _along(ax, place, float(F[2]), size, value(abs(F[2]), "N") + tell, double)
        if F[0]:
            _through(ax, place, float(F[0]), size, value(abs(F[0]), "N") + tell)
        if M.any():
            given = zip("xyz", M.tolist(), strict=True)
            lines = [f"{value(moment, 'N m')}{tell} about {axis}" for axis, moment in given if moment]
            _moment(ax, place, float(M[0]), size, lines)
    return []


def _arrow(
    ax: Axes, place: Array, reach: tuple[float, float], force: float, size: float, told: str, double: bool
) -> None:
    """A vertical force, its point at the surface of what it presses."""
    tip = reach[1] if force < 0 else reach[0]
    away = size if force < 0 else -size
    _pointed(ax, (place[0], tip + away), (place[0], tip), double)
    ax.annotate(
        told, (place[0], tip + away), xytext=(4, 2 if away > 0 else -2), textcoords="offset points",
        color=RED, fontsize=8.5, va="bottom" if away > 0 else "top", ha="left", zorder=12, bbox=HALO,
    )  # fmt: skip


def _along(ax: Axes, place: Array, force: float, size: float, told: str, double: bool) -> None:
    """A force along the axis, from its place on."""
    end = place + (math.copysign(size, force), 0.0)
    _pointed(ax, tuple(place), tuple(end), double)
    ax.annotate(
        told, tuple(end), xytext=(math.copysign(4, force), 0), textcoords="offset points", color=RED,
        fontsize=8.5, va="center", ha="left" if force > 0 else "right", zorder=12, bbox=HALO,
    )  # fmt: skip


def _pointed(ax: Axes, start: Any, end: Any, double: bool) -> None:
    look = {"arrowstyle": "<|-|>" if double else "-|>", "color": RED, "linewidth": 1.6, "mutation_scale": 11}
    ax.annotate("", end, start, arrowprops={**look, "shrinkA": 0, "shrinkB": 0}, zorder=11)


def _through(ax: Axes, place: Array, force: float, size: float, told: str) -> None:
    """A force along x, which points into the paper: y is up and z to the right, so x is away from us."""
    from matplotlib.patches import Circle

    r = 0.11 * size
    ax.add_patch(Circle(tuple(place), r, facecolor="white", edgecolor=RED, linewidth=1.3, zorder=11))
    if force > 0:
        d = r / math.sqrt(2)
        for s in (1, -1):
            ends = np.array([place + (-d, -s * d), place + (d, s * d)])
            ax.plot(*ends.T, color=RED, linewidth=1.1, zorder=11.5)
    else:
        ax.add_patch(Circle(tuple(place), 0.3 * r, facecolor=RED, edgecolor="none", zorder=11.5))
    ax.annotate(
        f"{told} along x", tuple(place + (r, -r)), xytext=(3, -3), textcoords="offset points", color=RED,
        fontsize=8.5, va="top", zorder=12, bbox=HALO,
    )  # fmt: skip


def _moment(ax: Axes, place: Array, about_x: float, size: float, told: list[str]) -> None:
    """Moments in words; that about x is an arc: x points away from us, so it turns clockwise, y towards z."""
    if about_x:
        angles = np.radians(np.linspace(200, -20, 40))[:: 1 if about_x > 0 else -1]
        arc = place + 0.5 * size * np.stack([np.cos(angles), np.sin(angles)], axis=-1)
        ax.plot(*arc.T, color=RED, linewidth=1.4, zorder=11)
        _pointed(ax, tuple(arc[-3]), tuple(arc[-1]), False)
    ax.annotate(
        "\n".join(told), tuple(place + (0, 0.5 * size)), xytext=(0, 4), textcoords="offset points",
        color=RED, fontsize=8.5, ha="center", va="bottom", zorder=12, bbox=HALO,
    )  # fmt: skip


def _unbalance(
    ax: Axes, place: Array, reach: tuple[float, float], size: float, load: Unbalance, left: bool
) -> None:
    """A mass off the axis, as high as its phase puts it at the angle 0, its words to the left or right."""
    from matplotlib.patches import Circle

    # the section is seen along x: at phase 0 the mass is before the axis, not above or below it
    centre = (float(place[0]), float(place[1] + 0.9 * (place[1] - reach[0]) * math.sin(load.phase)))
    ax.add_patch(Circle(centre, 0.09 * size, facecolor=RED, edgecolor="white", linewidth=0.6, zorder=11))
    told = f"unbalance {load.moment * 1e6:.4g} g mm"
    told += f", {math.degrees(load.phase):.4g}° from x" if load.phase else ", towards x"
    ax.annotate(
        told, centre, xytext=(-8 if left else 8, 13), textcoords="offset points", color=RED, fontsize=8.5,
        va="center", ha="right" if left else "left", zorder=12, bbox=HALO,
    )  # fmt: skip
