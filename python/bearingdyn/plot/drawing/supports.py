"""The ground, springs and dampers as drawing symbols."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from bearingdyn.types import Array

if TYPE_CHECKING:
    from matplotlib.axes import Axes

LINE: dict[str, Any] = {"color": "0.15", "linewidth": 1.0, "solid_capstyle": "butt", "zorder": 5.0}


def ground(ax: Axes, start: Array, end: Array, size: float) -> None:
    """Draw a support's ground from start to end (2,), mm: hatched on its right hand, `size` deep."""
    along = end - start
    length = float(np.hypot(*along))
    if length <= 0:
        return
    along = along / length
    right = np.array([along[1], -along[0]])
    ax.plot(*np.stack([start, end]).T, **{**LINE, "linewidth": 1.3})
    step = 0.55 * size
    for k in range(max(int(length / step), 2)):
        foot = start + (k + 1) * length / max(int(length / step), 2) * along
        ends = np.stack([foot, foot + size * (right - along)])
        ax.plot(*ends.T, **{**LINE, "linewidth": 0.6})


def spring(ax: Axes, top: Array, bottom: Array, size: float) -> None:
    """Draw a support's spring between two points (2,), mm, `size` wide."""
    along = bottom - top
    across = np.array([-along[1], along[0]]) / max(float(np.hypot(*along)), 1e-12)
    t = np.array([0.0, 0.2, *np.linspace(0.24, 0.76, 9), 0.8, 1.0])
    wave = np.array([0.0, 0.0, *(0.5 * size * (-1.0) ** k for k in range(9)), 0.0, 0.0])
    points = top + t[:, None] * along + wave[:, None] * across
    ax.plot(*points.T, **{**LINE, "linewidth": 0.9})


def damper(ax: Axes, top: Array, bottom: Array, size: float) -> None:
    """Draw a support's dashpot between two points (2,), mm, `size` wide."""
    along = bottom - top
    across = np.array([-along[1], along[0]]) / max(float(np.hypot(*along)), 1e-12)
    half = 0.5 * size * across
    thin = {**LINE, "linewidth": 0.9}
    at = {t: top + t * along for t in (0.0, 0.35, 0.48, 0.65, 1.0)}
    ax.plot(*np.stack([at[0.0], at[0.48]]).T, **thin)
    ax.plot(*np.stack([at[0.48] - 0.8 * half, at[0.48] + 0.8 * half]).T, **{**thin, "linewidth": 1.6})
    cup = [at[0.35] - half, at[0.65] - half, at[0.65] + half, at[0.35] + half]
    ax.plot(*np.stack(cup).T, **thin)
    ax.plot(*np.stack([at[0.65], at[1.0]]).T, **thin)
