"""What a plane through the axis shows of a part: closed outlines, of metal or rubber, for the drawing."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal, Protocol, TypeAlias, runtime_checkable

import numpy as np

from bearingdyn.short_repr import short
from bearingdyn.types import Array, Index

Matter: TypeAlias = Literal["shaft", "metal", "rubber", "body"]
"""A turning shaft, which no section cuts; metal and rubber that are cut; a body of which only mass and
inertia are known."""


@dataclass(frozen=True, eq=False)
class Profile:
    """Profile of a part in the plane x = 0, or of one of its regions.

    Parameters
    ----------
    corners
        (k, 2) z and y, m, of a closed outline, from the part's first interface (or raceway).
    matter
        What lies within.
    """

    corners: Array
    matter: Matter

    __repr__ = short


@runtime_checkable
class HasProfile(Protocol):
    """A part that knows its profile."""

    def profile(self) -> Sequence[Profile]:
        """Its outlines in the plane x = 0."""


def rectangle(z: tuple[float, float], y: tuple[float, float]) -> Array:
    """Corners of the profile of a box, m."""
    return np.array([(z[0], y[0]), (z[1], y[0]), (z[1], y[1]), (z[0], y[1])])


def mirrored(corners: Array, matter: Matter) -> list[Profile]:
    """The profile of a body of revolution: its section (z, r) above the axis, and below it."""
    return [Profile(corners, matter), Profile(corners * np.array([1.0, -1.0]), matter)]


def loops(lines: Index) -> list[Index]:
    """Closed loops, for a profile, of lines (s, 2) between nodes, each node in two of them."""
    at: dict[int, list[int]] = {}
    for k, pair in enumerate(lines.tolist()):
        for node in pair:
            at.setdefault(node, []).append(k)
    left, found = set(range(len(lines))), []
    while left:
        k = min(left)
        left.discard(k)
        loop = [int(x) for x in lines[k]]
        while loop[-1] != loop[0]:
            ahead = [j for j in at[loop[-1]] if j in left]
            if not ahead:
                break
            left.discard(ahead[0])
            a, b = (int(x) for x in lines[ahead[0]])
            loop.append(b if a == loop[-1] else a)
        found.append(np.array(loop[:-1] if loop[-1] == loop[0] else loop, dtype=np.intp))
    return found


def cut(points: Array, faces: Index) -> list[Array]:
    """Corners of the profile of a closed surface: where the plane x = 0 cuts its polygons.

    Parameters
    ----------
    points
        (p, 3), m.
    faces
        (f, 3 or 4), their corners.

    Returns
    -------
    list of Array
        (k, 2) z and y of each closed line.
    """
    size = float(np.ptp(points, axis=0).max())
    x = points[:, 0] + 1e-7 * size  # no corner lies in the plane itself
    keys: dict[tuple[int, int], int] = {}
    where: list[Array] = []
    segments = []
    for face in faces[(x[faces] > 0).any(axis=1) & (x[faces] < 0).any(axis=1)]:
        ends = []
        for a, b in zip(face, np.roll(face, -1), strict=True):
            if x[a] * x[b] < 0:
                key = (int(min(a, b)), int(max(a, b)))
                if key not in keys:
                    keys[key] = len(where)
                    t = x[a] / (x[a] - x[b])
                    where.append(points[a] + t * (points[b] - points[a]))
                ends.append(keys[key])
        if len(ends) == 2:
            segments.append(ends)
    if not segments:
        return []
    at = np.array(where)[:, [2, 1]]
    return [at[loop] for loop in loops(np.array(segments, dtype=np.intp)) if loop.size > 2]
