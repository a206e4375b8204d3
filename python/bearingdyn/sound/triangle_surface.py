"""Closed surfaces of flat triangles, from which sound is radiated."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
import scipy.sparse
from numpy.typing import ArrayLike
from scipy.sparse.csgraph import connected_components

from bearingdyn.checks import number, real, require
from bearingdyn.short_repr import short
from bearingdyn.types import Array, Index

ON_FLOOR = 1e-9  # of a surface's extent: this near to the floor a point lies on it


@dataclass(frozen=True, eq=False)
class TriangleSurface:
    """A closed surface of flat triangles, or several, all outside one another.

    Parameters
    ----------
    points
        Corners (n, 3), m.
    faces
        Triangles (m, 3), their corners anticlockwise seen from outside.
    floor
        Height y of a rigid floor, m; None: free field. Triangles that lie on the floor radiate nothing and
        are left out: there a surface may be open.

    Raises
    ------
    ValueError
        For a surface that is open, has an edge of more than two triangles, is turned inside out or reaches
        below the floor, for triangles without area, and for a body that begins inside another.
    """

    points: Array
    faces: Index
    floor: float | None = None

    __repr__ = short

    def __post_init__(self) -> None:
        points = _points(self.points)
        used, faces = np.unique(_faces(self.faces, len(points)), return_inverse=True)
        points, faces = points[used], faces.reshape(-1, 3)
        if self.floor is not None:
            floor = number("floor", self.floor, "it must be a height y in m, or None")
            above = points[:, 1] - floor
            tiny = ON_FLOOR * float(np.ptp(points, axis=0).max())
            require(
                bool((above >= -tiny).all()),
                "floor",
                floor,
                f"the surface reaches down to y = {points[:, 1].min():.6g} m; put the floor at or below that",
            )
            points = points.copy()
            points[np.abs(above) <= tiny, 1] = floor
            faces = faces[~(points[faces, 1] == floor).all(axis=1)]
            require(len(faces) > 0, "floor", floor, "all of the surface lies on it; there must be some above")
            object.__setattr__(self, "floor", floor)
        used, faces = np.unique(faces, return_inverse=True)
        object.__setattr__(self, "points", points[used])
        object.__setattr__(self, "faces", np.ascontiguousarray(faces.reshape(-1, 3), dtype=np.int32))
        self._check_area()
        self._check_closed()
        self._check_outside()
        self._check_apart()

    def _check_area(self) -> None:
        flat = np.flatnonzero(~(self.areas > 1e-14 * self.extent**2))
        if flat.size:
            place = self.points[self.faces[flat[0]]].mean(axis=0).tolist()
            raise ValueError(f"faces[{flat[0]}], near {place} m, has no area; leave it out")

    def _check_closed(self) -> None:
        """Each edge must be run along once in each direction."""
        edges = np.stack([self.faces, np.roll(self.faces, -1, axis=1)], axis=2).reshape(-1, 2).astype(np.intp)
        if self.floor is not None:
            edges = edges[~(self.points[edges, 1] == self.floor).all(axis=1)]
        n = len(self.points)
        there, back = edges[:, 0] * n + edges[:, 1], edges[:, 1] * n + edges[:, 0]
        once, count = np.unique(there, return_counts=True)
        for wrong, what in (
            (
                once[count > 1],
                "is run along twice in one direction: neighbouring triangles are numbered against one "
                "another, or more than two meet there; number all anticlockwise seen from outside",
            ),
            (np.setdiff1d(there, back), "has a triangle on one side only: the surface is open; close it"),
        ):
            if wrong.size:
                ends = self.points[[wrong[0] // n, wrong[0] % n]].tolist()
                raise ValueError(f"the edge from {ends[0]} to {ends[1]} m {what} ({wrong.size} such edges)")

    def _check_outside(self) -> None:
        for k, at in enumerate(self.bodies):
            p = self.points[self.faces[at]]
            if self.floor is not None:
                p = p - [0.0, self.floor, 0.0]  # what is missing of the surface then adds no volume
            else:
                p = p - p.mean(axis=(0, 1))
            volume = float(np.einsum("fi,fi->", p[:, 0], np.cross(p[:, 1], p[:, 2])) / 6.0)
            if not volume > 0.0:
                raise ValueError(
                    f"the surface is inside out: body {k}, {at.size} triangles, has a volume of "
                    f"{volume:.3g} m³; number the corners the other way round"
                )

    def _check_apart(self) -> None:
        """No body may lie in another: seen from there the other fills all directions."""
        for k, at in enumerate(self.bodies):
            x = self.middles[at[0]]
            for j, around in enumerate(self.bodies):
                if j == k:
                    continue
                corners = self.points[self.faces[around]]
                seen = _solid_angle(corners - x)
                if self.floor is not None:  # with its image a body that is open below is closed
                    image = (corners * [1.0, -1.0, 1.0] + [0.0, 2.0 * self.floor, 0.0])[:, ::-1]
                    seen += _solid_angle(image - x)
                if abs(seen) > 2.0 * np.pi:
                    raise ValueError(
                        f"body {k} of the surface, {at.size} triangles, reaches into body {j} near "
                        f"{x.tolist()} m; leave out what lies inside, or move them apart"
                    )

    @cached_property
    def bodies(self) -> tuple[Index, ...]:
        """Triangles of each body that hangs together."""
        n = len(self.points)
        link = np.vstack([self.faces[:, :2], self.faces[:, 1:]])
        graph = scipy.sparse.coo_matrix((np.ones(len(link)), (link[:, 0], link[:, 1])), (n, n))
        count, label = connected_components(graph, directed=False)
        return tuple(np.flatnonzero(label[self.faces[:, 0]] == k) for k in range(count))

    @cached_property
    def _cross(self) -> Array:
        p = self.points[self.faces]
        return np.asarray(np.cross(p[:, 1] - p[:, 0], p[:, 2] - p[:, 0]))

    @property
    def areas(self) -> Array:
        """Of the triangles, (m,), m²."""
        return np.asarray(0.5 * np.linalg.norm(self._cross, axis=1))

    @property
    def normals(self) -> Array:
        """Outward normals of unit length, (m, 3)."""
        return np.asarray(self._cross / np.linalg.norm(self._cross, axis=1)[:, None])

    @property
    def middles(self) -> Array:
        """Centroids of the triangles, (m, 3), m."""
        return np.asarray(self.points[self.faces].mean(axis=1))

    @property
    def extent(self) -> float:
        """Longest side of the box around the surface, m."""
        return float(np.ptp(self.points, axis=0).max())

    @property
    def size(self) -> float:
        """Longest side of a triangle, m."""
        p = self.points[self.faces]
        return float(np.linalg.norm(p - np.roll(p, 1, axis=1), axis=2).max())


def _solid_angle(corners: Array) -> float:
    """Under which triangles (m, 3, 3) are seen from the origin (Van Oosterom and Strackee, 1983)."""
    r = np.linalg.norm(corners, axis=2)
    a, b, c = corners[:, 0], corners[:, 1], corners[:, 2]
    up = np.einsum("fi,fi->f", a, np.cross(b, c))
    along = [np.einsum("fi,fi->f", p, q) for p, q in ((a, b), (b, c), (c, a))]
    down = r[:, 0] * r[:, 1] * r[:, 2] + along[0] * r[:, 2] + along[1] * r[:, 0] + along[2] * r[:, 1]
    return float(2.0 * np.arctan2(up, down).sum())


def _points(given: ArrayLike) -> Array:
    remedy = "it must be corners (n, 3) in m, finite"
    try:
        points = real(given)
    except (TypeError, ValueError):
        raise ValueError(f"points is {given!r}; {remedy}") from None
    good = points.ndim == 2 and points.shape[1] == 3 and len(points) > 0 and bool(np.isfinite(points).all())
    if not good:
        raise ValueError(f"points has shape {points.shape}; {remedy}")
    return points


def _faces(given: ArrayLike, n: int) -> Index:
    faces = np.asarray(given)
    if faces.ndim != 2 or faces.shape[1] != 3 or not len(faces) or faces.dtype.kind not in "iu":
        raise ValueError(
            f"faces has shape {faces.shape} of {faces.dtype}; it must be triangles (m, 3) of whole numbers"
        )
    wrong = np.flatnonzero((faces < 0).any(axis=1) | (faces >= n).any(axis=1))
    if wrong.size:
        raise ValueError(
            f"faces[{wrong[0]}] is {faces[wrong[0]].tolist()}; its corners must be in 0...{n - 1}"
        )
    return faces.astype(np.intp)
