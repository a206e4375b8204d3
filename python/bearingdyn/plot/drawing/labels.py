"""What is written about the section: balloons, names of places, dimensions and the axes."""

from __future__ import annotations

import itertools
from typing import TYPE_CHECKING, Any

import numpy as np

from bearingdyn.application import GROUND, Place
from bearingdyn.plot.drawing.shown_machine import Machine
from bearingdyn.plot.drawing.words import designation
from bearingdyn.types import Array

if TYPE_CHECKING:
    from matplotlib.axes import Axes

TEXT = 8.0  # points


def spread(wanted: Array, least: float) -> Array:
    """Spread labels of a drawing: places (n,) nearest the wanted, in order, at least `least` apart."""
    order = np.argsort(wanted, kind="stable")
    # isotonic regression of what is wanted less the steps: pools of neighbours that press on each other
    pools: list[list[float]] = []
    for k, i in enumerate(order):
        pools.append([float(wanted[i]) - k * least, 1.0])
        while len(pools) > 1 and pools[-2][0] >= pools[-1][0]:
            value, weight = pools.pop()
            pools[-1] = [
                (pools[-1][0] * pools[-1][1] + value * weight) / (pools[-1][1] + weight),
                pools[-1][1] + weight,
            ]
    flat = [value for value, weight in pools for _ in range(int(weight))]
    found = np.zeros(len(wanted))
    for k, i in enumerate(order):
        found[i] = flat[k] + k * least
    return found


def balloons(ax: Axes, shown: Machine, names: list[str], top: float, scale: float) -> None:
    """Labels of a drawing: a number in a circle for each part and bearing, with a line to a dot in it."""
    targets: dict[str, tuple[float, float]] = {}
    for part in shown.parts:
        targets[part.name] = _inside(part.profiles)
    for name, joint in shown.plan.bearings.items():
        at = shown.balls(joint)
        if at is not None:
            targets[name] = (float(at[2]), float(at[1]) + 0.5e3 * joint.bearing.Dpw)
    for name, fit in shown.plan.fits.items():
        at = shown.places.get(str(fit.bore)) if fit.bore != GROUND else None
        if at is not None:
            targets[name] = (float(at[2]), float(at[1]))
    # of what stands above one another the lower is reached from further left
    order = sorted((n for n in names if n in targets), key=lambda n: (round(targets[n][0], 3), targets[n][1]))
    if not order:
        return
    ticks = np.array([targets[n][0] + 1e-6 * k for k, n in enumerate(order)])
    x = spread(ticks, 19 * scale)
    y = top + 46 * scale
    for name, across in zip(order, x, strict=True):
        z, r = targets[name]
        ax.plot([across, z], [y - 7 * scale, r], color="0.25", linewidth=0.5, zorder=9)
        ax.plot([z], [r], marker="o", markersize=2.4, color="0.1", zorder=9.5)
        ax.plot(
            [across], [y], marker="o", markersize=14, markerfacecolor="white", markeredgecolor="0.1",
            markeredgewidth=0.8, zorder=10,
        )  # fmt: skip
        number = str(names.index(name) + 1)
        ax.text(across, y, number, ha="center", va="center", fontsize=TEXT, zorder=10.5)
        hung = shown.plan.bearings.get(name)
        if hung is not None and (named := designation(hung.bearing)[0]):
            ax.text(across, y + 9.5 * scale, named, ha="center", va="bottom", fontsize=TEXT, weight="bold")


def _inside(profiles: Any) -> tuple[float, float]:
    """A point in the uppermost outline of a part where a leader ends."""
    best = max(profiles, key=lambda p: (float(p.corners[:, 1].max()), float(np.ptp(p.corners[:, 0]))))
    if best.matter in ("shaft", "body"):
        widest = max(profiles, key=lambda p: float(np.ptp(p.corners[:, 0])))
        z, y = widest.corners[:, 0], widest.corners[:, 1]
        return float(z.min() + 0.3 * np.ptp(z)), float(y.min() + 0.8 * np.ptp(y))
    z, y = best.corners[:, 0], best.corners[:, 1]
    return float(z.min() + 0.5 * np.ptp(z)), float(y.min() + 0.5 * np.ptp(y))


def place_names(ax: Axes, shown: Machine, top: float, scale: float) -> float:
    """Labels of seats and points by name below the drawing, lines up to them; returns how far down, mm."""
    named: dict[tuple[float, float], list[str]] = {}
    for name, at in shown.places.items():
        key = (round(float(at[2]), 3), round(float(at[1]), 3))
        named.setdefault(key, []).append(name)
    if not named:
        return top
    # one label for each place: of the shaft first, what is joined there is in the list
    turning = {p.name for p in shown.parts if any(q.matter == "shaft" for q in p.profiles)}
    joined = {str(place) for c in shown.plan.connections for place in (c.a, c.b)}
    labels: list[tuple[float, float, str]] = []
    for (z, y), names in named.items():
        first = sorted(names, key=lambda n: (Place.parse(n).part not in turning, n in joined))
        own = [n for n in first if Place.parse(n).part in turning] or first[:1]
        labels.append((z, y, ", ".join(own)))
    labels.sort()
    room = 7.2 * scale if len(labels) > 6 else max(len(t) for *_, t in labels) * 4.4 * scale
    apart = np.diff([z for z, *_ in labels])
    upright = len(labels) > 1 and (float(apart.min()) < room or len(labels) > 6)
    x = spread(np.array([z + 1e-6 * k for k, (z, *_) in enumerate(labels)]), 9.5 * scale if upright else room)
    for across, (z, y, text) in zip(x, labels, strict=True):
        ax.plot([z, z, across], [y, top + 8 * scale, top], color="0.55", linewidth=0.45, zorder=1.5)
        ax.plot([z], [y], marker="o", markersize=3.2, markerfacecolor="white", markeredgecolor="#0072B2",
                markeredgewidth=1.0, zorder=10)  # fmt: skip
        ax.text(
            across, top - 1.5 * scale, text, rotation=90 if upright else 0, ha="center", va="top",
            fontsize=7.0 if upright else TEXT, color="#0072B2",
        )  # fmt: skip
    return top - (max(len(t) for *_, t in labels) * 3.9 if upright else 11.0) * scale


def dimensions(ax: Axes, shown: Machine, top: float, scale: float) -> float:
    """Label distances of bearings and the length of the shaft, mm; returns how far down they reach."""
    balls = [shown.balls(joint) for joint in shown.plan.bearings.values()]
    at = {round(float(each[2]), 3) for each in balls if each is not None}
    y = top - 12 * scale
    stations = sorted(at)
    for a, b in itertools.pairwise(stations):
        _dimension(ax, a, b, y, scale)
    if len(stations) > 1:
        y -= 15 * scale
    known = [(q.matter, q.corners[:, 0]) for p in shown.parts for q in p.profiles if q.matter != "body"]
    turning = [z for matter, z in known if matter == "shaft"]
    ends = np.concatenate(turning or [z for _, z in known] or [np.zeros(1)])
    if float(np.ptp(ends)) > 0:
        _dimension(ax, float(ends.min()), float(ends.max()), y, scale)
    return y - 6 * scale


def _dimension(ax: Axes, a: float, b: float, y: float, scale: float) -> None:
    look = {"arrowstyle": "<|-|>", "color": "0.2", "linewidth": 0.6, "mutation_scale": 6}
    ax.annotate("", (b, y), (a, y), arrowprops={**look, "shrinkA": 0, "shrinkB": 0})
    for z in (a, b):
        ax.plot([z, z], [y - 3 * scale, y + 7 * scale], color="0.2", linewidth=0.5)
    ax.text(
        0.5 * (a + b), y, f"{b - a:.5g}", ha="center", va="center", fontsize=TEXT,
        bbox={"facecolor": "white", "edgecolor": "none", "pad": 1.2},
    )  # fmt: skip


def axes_glyph(ax: Axes, z: float, y: float, scale: float) -> None:
    """Label a drawing's axes: which way z and y point; x points away from the reader."""
    look = {"arrowstyle": "-|>", "color": "0.3", "linewidth": 0.8, "mutation_scale": 7}
    for name, way in (("z", (22, 0)), ("y", (0, 22))):
        end = (z + way[0] * scale, y + way[1] * scale)
        ax.annotate("", end, (z, y), arrowprops={**look, "shrinkA": 0, "shrinkB": 0})
        ax.annotate(
            name, end, xytext=(way[0] / 7, way[1] / 7), textcoords="offset points", fontsize=TEXT,
            color="0.3", ha="center" if way[1] else "left", va="center" if way[0] else "bottom",
        )  # fmt: skip
