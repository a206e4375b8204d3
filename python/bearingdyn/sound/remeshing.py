"""A surface of triangles made anew with sides near a wanted length, its edges and corners kept.

Long sides are halved and short ones drawn together; sides of two triangles that lie in one plane are turned
where that makes rounder triangles; then points slide towards the middle of their neighbours.

References
----------
M. Botsch, L. Kobbelt, Symposium on Geometry Processing 2004, 185.
"""

from __future__ import annotations

import math

import numpy as np

from bearingdyn.types import Array, Index

CREASE = math.cos(math.radians(35.0))  # two triangles that turn by more have an edge between them
BEND = math.cos(math.radians(40.0))  # an edge that turns by more has a corner
TURN = 0.80  # least cosine by which a triangle may turn when its corner moves
FLAT = 0.95  # cosine above which two triangles count as one plane
LONG, SHORT = 4.0 / 3.0, 4.0 / 5.0  # of the wanted length: between them halves are no better than wholes
ROUNDS = 6

Point = tuple[float, float, float]


def _minus(a: Point, b: Point) -> Point:
    return a[0] - b[0], a[1] - b[1], a[2] - b[2]


def _dot(a: Point, b: Point) -> float:
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def _cross(a: Point, b: Point) -> Point:
    return a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]


def _mix(a: Point, b: Point, t: float) -> Point:
    return a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1]), a[2] + t * (b[2] - a[2])


class _Mesh:
    """Triangles that know their neighbours."""

    def __init__(self, points: Array, faces: Index) -> None:
        self.points: list[Point] = [(float(x), float(y), float(z)) for x, y, z in points]
        self.faces: dict[int, tuple[int, int, int]] = {}
        self.around: dict[int, set[int]] = {}
        self.next = 0
        for a, b, c in faces.tolist():
            self.add(a, b, c)
        self.creases: dict[int, set[int]] = {}
        for a, b in self.edges():
            one, two = self.sides(a, b)
            if not self.cosine(self.normal(*self.faces[one]), self.normal(*self.faces[two])) > CREASE:
                self.creases.setdefault(a, set()).add(b)
                self.creases.setdefault(b, set()).add(a)
        self.corners = {v for v, to in self.creases.items() if not self.runs_through(v, to)}

    def add(self, a: int, b: int, c: int) -> None:
        self.faces[self.next] = (a, b, c)
        for v in (a, b, c):
            self.around.setdefault(v, set()).add(self.next)
        self.next += 1

    def remove(self, f: int) -> None:
        for v in self.faces.pop(f):
            self.around[v].discard(f)

    def edges(self) -> list[tuple[int, int]]:
        return [(a, b) for f in self.faces.values() for a, b in zip(f, (*f[1:], f[0]), strict=True) if a < b]

    def sides(self, a: int, b: int) -> list[int]:
        return list(self.around[a] & self.around[b])

    def neighbours(self, v: int) -> set[int]:
        return {u for f in self.around[v] for u in self.faces[f]} - {v}

    def length(self, a: int, b: int) -> float:
        return math.dist(self.points[a], self.points[b])

    def normal(self, a: int, b: int, c: int) -> Point:
        p = self.points
        return _cross(_minus(p[b], p[a]), _minus(p[c], p[a]))

    @staticmethod
    def cosine(a: Point, b: Point) -> float:
        return _dot(a, b) / (math.sqrt(_dot(a, a) * _dot(b, b)) or 1.0)

    def runs_through(self, v: int, to: set[int]) -> bool:
        """Whether one edge passes a point, and does not turn much there."""
        if len(to) != 2:
            return False
        a, b = to
        return (
            -self.cosine(_minus(self.points[a], self.points[v]), _minus(self.points[b], self.points[v]))
            > BEND
        )

    def is_crease(self, a: int, b: int) -> bool:
        return b in self.creases.get(a, ())

    def third(self, f: int, a: int, b: int) -> int:
        return next(v for v in self.faces[f] if v not in (a, b))

    def replaced(self, f: int, old: int, new: int) -> tuple[int, int, int]:
        a, b, c = (new if v == old else v for v in self.faces[f])
        return a, b, c

    def split(self, a: int, b: int) -> None:
        m = len(self.points)
        self.points.append(_mix(self.points[a], self.points[b], 0.5))
        for f in self.sides(a, b):
            one, two = self.replaced(f, b, m), self.replaced(f, a, m)
            self.remove(f)
            self.add(*one)
            self.add(*two)
        if self.is_crease(a, b):
            self.creases[a] = self.creases[a] - {b} | {m}
            self.creases[b] = self.creases[b] - {a} | {m}
            self.creases[m] = {a, b}

    def collapse(self, a: int, b: int, longest: float) -> bool:
        """Draw a into b, where the surface stays what it is."""
        if a in self.corners or (a in self.creases and not self.is_crease(a, b)):
            return False
        if len(self.neighbours(a) & self.neighbours(b)) != 2:
            return False
        gone = self.sides(a, b)
        kept = self.around[a] - set(gone)
        for f in kept:
            new = self.replaced(f, a, b)
            n, before = self.normal(*new), self.normal(*self.faces[f])
            if not self.cosine(n, before) > TURN:
                return False
            sides = [self.length(u, v) for u, v in zip(new, (*new[1:], new[0]), strict=True)]
            # no longer than wanted, and no needles
            if not max(sides) <= longest or not math.sqrt(_dot(n, n)) > 0.2 * max(sides) ** 2:
                return False
        for f in gone:
            self.remove(f)
        for f in list(kept):
            new = self.replaced(f, a, b)
            self.remove(f)
            self.add(*new)
        for other in self.creases.pop(a, set()):
            self.creases[other].discard(a)
            if other != b:
                self.creases[other].add(b)
                self.creases[b].add(other)
        return True

    def flip(self, a: int, b: int) -> None:
        """Turn the side a b where the other diagonal sees smaller angles (Delaunay)."""
        if self.is_crease(a, b):
            return
        f, g = self.sides(a, b)
        if self.faces[f][(self.faces[f].index(a) + 1) % 3] != b:
            f, g = g, f
        c, d = self.third(f, a, b), self.third(g, a, b)
        if d in self.neighbours(c):
            return
        old = (self.normal(*self.faces[f]), self.normal(*self.faces[g]))
        if not self.cosine(*old) > FLAT:
            return
        p = self.points
        angles = sum(
            math.acos(max(-1.0, min(1.0, self.cosine(_minus(p[a], p[v]), _minus(p[b], p[v])))))
            for v in (c, d)
        )
        if not angles > math.pi + 1e-6:
            return
        new = (self.normal(a, d, c), self.normal(d, b, c))
        if not min(self.cosine(m, n) for m in new for n in old) > FLAT:
            return
        self.remove(f)
        self.remove(g)
        self.add(a, d, c)
        self.add(d, b, c)

    def slide(self, v: int) -> None:
        """Move a point of a smooth place half the way to the middle of its neighbours, along the surface."""
        if v in self.creases:
            return
        near = self.neighbours(v)
        x = self.points[v]
        middle = tuple(sum(self.points[u][i] for u in near) / len(near) for i in range(3))
        n = tuple(sum(self.normal(*self.faces[f])[i] for f in self.around[v]) for i in range(3))
        step = _minus((middle[0], middle[1], middle[2]), x)
        out = _dot(step, (n[0], n[1], n[2])) / _dot((n[0], n[1], n[2]), (n[0], n[1], n[2]))
        before = [self.normal(*self.faces[f]) for f in self.around[v]]
        self.points[v] = (
            x[0] + 0.5 * (step[0] - out * n[0]),
            x[1] + 0.5 * (step[1] - out * n[1]),
            x[2] + 0.5 * (step[2] - out * n[2]),
        )
        after = [self.normal(*self.faces[f]) for f in self.around[v]]
        if not min(self.cosine(m, n) for m, n in zip(before, after, strict=True)) > FLAT:
            self.points[v] = x

    def arrays(self) -> tuple[Array, Index]:
        used, faces = np.unique(np.array(list(self.faces.values())), return_inverse=True)
        return np.array(self.points)[used], faces.reshape(-1, 3)


def remeshed(points: Array, faces: Index, size: float) -> tuple[Array, Index]:
    """Remesh a closed surface of triangles, with sides near `size`.

    Parameters
    ----------
    points, faces
        Corners (n, 3), m, and triangles (m, 3) of the surface.
    size
        Wanted length of the sides, m.

    Returns
    -------
    tuple of numpy.ndarray
        Corners and triangles.
    """
    mesh = _Mesh(points, faces)
    for _ in range(ROUNDS):
        # the longest first, so that halves come out even
        for a, b in sorted(mesh.edges(), key=lambda e: -mesh.length(*e)):
            if mesh.length(a, b) > LONG * size:
                mesh.split(a, b)
        for length, a, b in sorted((mesh.length(a, b), a, b) for a, b in mesh.edges()):
            if length >= SHORT * size:
                break
            if mesh.around.get(a) and mesh.around.get(b) and len(mesh.sides(a, b)) == 2:
                if not mesh.collapse(a, b, LONG * size):
                    mesh.collapse(b, a, LONG * size)
        for a, b in mesh.edges():
            if len(mesh.sides(a, b)) == 2:
                mesh.flip(a, b)
        for v in [v for v, f in mesh.around.items() if f]:
            mesh.slide(v)
    return mesh.arrays()
