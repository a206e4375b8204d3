"""Surfaces of parts drawn in space, for figures: axes, light, sharp edges and frame."""

from __future__ import annotations

from typing import Any

import numpy as np

from bearingdyn.checks import require
from bearingdyn.plot.frame import STYLE
from bearingdyn.types import Array, Index

EDGE = 0.8  # cosine of the angle between two faces from which on their common edge is drawn
SHADE = 0.55  # of its colour that a face seen along its plane keeps
LIGHT = np.array([0.3, -0.5, 0.8])  # where the light comes from, in the axes z, x, y of the figure
TO_FIGURE = [2, 0, 1]  # z along the figure's first axis, y up


def axes_in_space() -> Any:
    """Axes in space of a new figure, for surfaces seen from the front, the right and above."""
    import matplotlib.pyplot as plt

    figure = plt.figure(figsize=(7.4, 4.6), layout="constrained")
    ax = figure.add_subplot(projection="3d", proj_type="ortho")
    ax.view_init(elev=20.0, azim=-60.0)
    return ax


def in_space(name: str, value: object) -> None:
    """Axes of a figure that are in space, or None."""
    require(
        value is None or hasattr(value, "get_zlim"),
        name,
        value,
        'it must be axes of projection "3d", or None',
    )


def shaded(colours: Array, polygons: Array, least: float = SHADE) -> Array:
    """Colours (f, 4) of surfaces' polygons (f, q, 3) in the figure's light; along it they keep `least`."""
    shade = least + (1.0 - least) * np.abs(_normals(polygons) @ (LIGHT / np.linalg.norm(LIGHT)))
    found = np.array(colours)
    found[:, :3] *= shade[:, None]
    return found


def draw_surfaces(ax: Any, polygons: list[Array], colours: Array, edges: Array) -> None:
    """Draw surfaces in space: polygons (q, 3) in their colours (f, 4), and edges (e, 2, 3), mm."""
    from mpl_toolkits.mplot3d.art3d import Line3DCollection, Poly3DCollection

    for drawn in (
        Poly3DCollection(polygons, facecolors=colours, edgecolors=colours, linewidths=0.2),
        Line3DCollection(edges, colors="0.35", linewidths=0.35),
    ):
        drawn.set_clip_on(False)
        ax.add_collection3d(drawn)
    _frame(ax, np.concatenate([*polygons, *(e.reshape(-1, 3) for e in edges)]))


def _normals(polygons: Array) -> Array:
    """Unit normals (f, 3) of polygons (f, q, 3), by Newell's sum; zero of those without area."""
    normal = np.cross(polygons, np.roll(polygons, -1, axis=1)).sum(axis=1)
    return np.asarray(normal / np.maximum(np.linalg.norm(normal, axis=1), 1e-300)[:, None])


def sharp_edges(points: Array, faces: Index) -> Index:
    """Edges (e, 2) at which a surface turns sharply, or ends, from points (p, 3) and faces (f, q)."""
    normals = np.repeat(_normals(points[faces]), faces.shape[1], axis=0)
    sides = np.sort(np.stack([faces, np.roll(faces, -1, axis=1)], axis=-1).reshape(-1, 2), axis=1)
    edges, which, count = np.unique(sides, axis=0, return_inverse=True, return_counts=True)
    pair = np.argsort(which.ravel(), kind="stable")
    first = np.cumsum(count) - count
    last = first + count - 1
    cosine = np.abs(np.sum(normals[pair[first]] * normals[pair[last]], axis=1))
    return np.asarray(edges[(count == 1) | (cosine < EDGE)])


def _frame(ax: Any, points: Array) -> None:
    """Equal scales, few ticks, names of the axes."""
    low, high = points.min(axis=0), points.max(axis=0)
    ax.set(xlim=(low[0], high[0]), ylim=(low[1], high[1]), zlim=(low[2], high[2]))
    ax.set_box_aspect(high - low, zoom=1.1)
    for axis, name in zip((ax.xaxis, ax.yaxis, ax.zaxis), "zxy", strict=True):
        axis.set_label_text(f"{name}, mm")
        axis.label.set_fontsize(STYLE["axes.labelsize"])
        axis.set_pane_color((1.0, 1.0, 1.0, 0.0))
    # as many ticks as there is room along each axis
    for axis, length in zip((ax.xaxis, ax.yaxis, ax.zaxis), high - low, strict=True):
        axis.set_major_locator(_few(max(1, round(4 * length / max(*(high - low), 1e-300)))))
    ax.tick_params(labelsize=8.0)
    ax.grid(False)


def _few(intervals: int) -> Any:
    from matplotlib.ticker import MaxNLocator

    return MaxNLocator(intervals)
