"""What a part looks like: the polygons of its surface, and how its coordinates move them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol, runtime_checkable

import numpy as np

from bearingdyn.short_repr import short
from bearingdyn.types import Array, Index

AZIMUTHS = 48  # around a body of revolution


@dataclass(frozen=True, eq=False)
class Outline:
    """The outline of a part: its surface in its own frame.

    Parameters
    ----------
    points
        (p, 3), m.
    faces
        (f, 3 or 4), their corners among the points.
    rows
        (3 p, n): x, y, z of every point from the coordinates of the part's superelement.
    """

    points: Array
    faces: Index
    rows: Array

    __repr__ = short


@runtime_checkable
class Outlined(Protocol):
    """A part whose outline can be drawn."""

    def outline(self) -> Outline:
        """Its surface."""


def azimuths() -> Array:
    """The azimuths, rad, at which outlines of bodies of revolution are drawn."""
    return np.linspace(0.0, 2.0 * np.pi, AZIMUTHS, endpoint=False)


def revolved(r: Array, z: Array, lines: Index) -> tuple[Array, Index, Index]:
    """Outline of a section's lines (s, 2) turned about z: points, quadrilaterals, and its points (k,).

    Parameters
    ----------
    r, z
        Points of the section, m. The points (k · AZIMUTHS, 3) come circle by circle. Lines without length or
        on the axis have no face.
    """
    length = np.hypot(np.diff(r[lines]), np.diff(z[lines]))[:, 0]
    used, lines = np.unique(lines[(r[lines] > 0.0).any(axis=1) & (length > 0.0)], return_inverse=True)
    lines = lines.reshape(-1, 2)
    phi = azimuths()
    points = np.zeros((used.size, phi.size, 3))
    points[:, :, :2] = r[used, None, None] * np.stack([np.cos(phi), np.sin(phi)], axis=-1)
    points[:, :, 2] = z[used, None]
    this = np.arange(phi.size)
    after = (this + 1) % phi.size
    start, end = (phi.size * lines[:, k, None] for k in (0, 1))
    faces = np.stack([start + this, end + this, end + after, start + after], axis=-1)
    return points.reshape(-1, 3), faces.reshape(-1, 4), used


def cylinder(r_inner: float, r_outer: float, z: tuple[float, float]) -> tuple[Array, Index]:
    """Outline of a ring about z (a disc where r_inner is 0), m: points and faces."""
    r, height = np.array([r_inner, r_outer, r_outer, r_inner]), np.repeat(z, 2)
    return revolved(r, height, np.array([[0, 1], [1, 2], [2, 3], [3, 0]]))[:2]


def box(sides: Array) -> tuple[Array, Index]:
    """Outline of a box of these sides (3,), m, about the origin: points (8, 3) and faces (6, 4)."""
    corners = np.array([[x, y, z] for x in (-0.5, 0.5) for y in (-0.5, 0.5) for z in (-0.5, 0.5)])
    faces = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]]
    return corners * sides, np.array(faces)


def carried(motion: Array, arms: Array) -> Array:
    """Rows (3 p, n) of an outline's points carried by rigid bodies: u = t + θ × arm.

    Parameters
    ----------
    motion
        (6, n) of one body, or (p, 6, n) of one for each point.
    arms
        (p, 3), m.
    """
    turn = np.cross(motion[..., 3:, :], arms[:, :, None], axis=-2)
    return np.asarray((motion[..., :3, :] + turn).reshape(3 * len(arms), -1))
