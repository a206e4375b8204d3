"""Grid lines: points along an axis, evenly spaced or crowded towards the ends."""

from __future__ import annotations

import itertools
import math

import numpy as np

from bearingdyn.types import Array


def crowded(a: float, b: float, count: int) -> Array:
    """Grid lines from a to b, crowded towards both ends: (a + b)/2 − (b − a)/2 cos(πi/count).

    A soft layer bonded to something stiff has singular stresses where its free edge meets the bond.

    Parameters
    ----------
    a, b
        The ends, m.
    count
        Number of steps between them.

    Returns
    -------
    Array
        (count + 1,), m.

    Raises
    ------
    ValueError
        Unless a < b and count ≥ 1.
    """
    if not (math.isfinite(a) and math.isfinite(b) and a < b and count >= 1):
        raise ValueError(f"lines from {a} to {b} in {count} steps: they must rise, in one step or more")
    lines = 0.5 * (a + b) - 0.5 * (b - a) * np.cos(np.pi * np.arange(count + 1) / count)
    lines[[0, -1]] = a, b
    return lines


def lines_through(stops: list[float], size: float, least: int = 1) -> Array:
    """Grid lines through all stops, no step longer than size, at least ``least`` steps between two stops."""
    sorted_stops = np.unique(np.round(np.array(stops), 12))
    parts = [sorted_stops[:1]]
    for a, b in itertools.pairwise(sorted_stops):
        parts.append(np.linspace(a, b, max(least, math.ceil((b - a) / size - 1e-9)) + 1)[1:])
    return np.concatenate(parts)


def graded_line(a: float, b: float, first: float, cap: float, growth: float) -> Array:
    """Grid lines from a to b, graded and symmetric: steps near `first` at the ends, growing up to `cap`."""
    steps: list[float] = []
    step, reach, half = min(first, cap), 0.0, 0.5 * (b - a)
    while reach < half:
        steps.append(step)
        reach += step
        step = min(step * growth, cap)
    sizes = np.array(steps) * (half / reach)
    left = np.concatenate([[0.0], np.cumsum(sizes)])
    points = np.concatenate([left[:-1], [half], 2 * half - left[-2::-1]])
    points += a
    points[0], points[-1] = a, b
    return points
