"""Meshes of the half plane (r, z): 9-node quadrilaterals; rectangles crowded where stresses are singular."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise

import numpy as np

from bearingdyn.checks import number, vector
from bearingdyn.fem.meshes.grid_lines import graded_line
from bearingdyn.fem.meshes.quadrilateral_element import shape_functions
from bearingdyn.fem.meshes.section_integrals import SectionIntegrals
from bearingdyn.short_repr import short
from bearingdyn.types import Array, Index

KEPT_BELOW = 1000  # elements: their integrals take 12 MB
SAME = 1e-9  # lengths closer than this fraction of the body are one grid line


@dataclass(frozen=True)
class Rectangle:
    """A rectangle of a revolution mesh: r and z are (from, to), m, with 0 <= r[0] < r[1] and z[0] < z[1].

    Parameters
    ----------
    graded
        Lines crowd towards its four sides. A soft layer bonded to something stiff has singular stresses where
        its free edge meets the bond, and its stiffness converges slowly on an even mesh.

    Raises
    ------
    ValueError
        For limits out of order or not finite.
    """

    r: tuple[float, float]
    z: tuple[float, float]
    graded: bool = False

    def __post_init__(self) -> None:
        for name in ("r", "z"):
            vector(name, getattr(self, name), (2,), "(from, to) in m")
        if not 0.0 <= self.r[0] < self.r[1] < math.inf:
            raise ValueError(f"r is {self.r}; a section needs 0 <= r[0] < r[1], m")
        if not -math.inf < self.z[0] < self.z[1] < math.inf:
            raise ValueError(f"z is {self.z}; a section needs z[0] < z[1], m")


# The four sides of an element, each from end to end.
SIDES = np.array([[0, 3, 6], [6, 7, 8], [8, 5, 2], [2, 1, 0]])


@dataclass(frozen=True, eq=False, kw_only=True)
class RevolutionMesh:
    """Mesh of a body of revolution: 9-node quadrilaterals in (r, z), straight or curved.

    Parameters
    ----------
    r, z
        (nodes,) coordinates, m.
    elements
        (m, 9) nodes, number 3 i + j being the i-th in ξ and the j-th in η; ξ runs along r and η along z in a
        mesh of rectangles, and ξ to η turns as r to z in any.
    region
        (m,) index of the region each element lies in.
    """

    r: Array
    z: Array
    elements: Index
    region: Index

    __repr__ = short

    @property
    def element_nodes(self) -> tuple[Array, Array]:
        """Nodes of every element, r and z (m, 9), m."""
        return self.r[self.elements], self.z[self.elements]

    @property
    def integrals(self) -> SectionIntegrals:
        """Integrals over the elements, from which the matrices of every order combine; kept by small ones."""
        small = len(self.elements) <= KEPT_BELOW
        return self._integrals if small else SectionIntegrals.of(*self.element_nodes)

    @cached_property
    def _integrals(self) -> SectionIntegrals:
        return SectionIntegrals.of(*self.element_nodes)

    @property
    def size(self) -> float:
        """Largest extent of the section, m."""
        return float(max(np.ptp(self.r), np.ptp(self.z)))

    @cached_property
    def edges(self) -> Index:
        """Sides of the elements, (sides, 3) nodes from end to end, each once."""
        return self._sides[0]

    @cached_property
    def outline(self) -> Index:
        """Nodes on the surface of the body: on sides that belong to one element."""
        return np.unique(self.outline_sides)

    @property
    def outline_sides(self) -> Index:
        """Sides on the surface of the body, or on the axis: those that belong to one element."""
        edges, count = self._sides
        return np.asarray(edges[count == 1])

    @cached_property
    def _sides(self) -> tuple[Index, Index]:
        every = self.elements[:, SIDES].reshape(-1, 3)
        _, first, count = np.unique(every[:, 1], return_index=True, return_counts=True)
        return every[first], count

    def nodes_on(self, r: tuple[float, float], z: tuple[float, float]) -> Index:
        """Nodes with r[0] <= r <= r[1] and z[0] <= z <= z[1]; a line is a rectangle without width."""
        e = SAME * self.size
        inside = (self.r >= r[0] - e) & (self.r <= r[1] + e) & (self.z >= z[0] - e) & (self.z <= z[1] + e)
        return np.flatnonzero(inside)

    def locate(self, r: float, z: float) -> tuple[int, float, float]:
        """Element that holds a point, and the point's local coordinates there, each in -1...1.

        Raises
        ------
        ValueError
            When the point lies outside the section.
        """
        R, Z = self.r[self.elements], self.z[self.elements]
        e = 1e-6 * self.size
        near = (R.min(axis=1) - e <= r) & (r <= R.max(axis=1) + e)
        near &= (Z.min(axis=1) - e <= z) & (z <= Z.max(axis=1) + e)
        found = np.flatnonzero(near)
        at = np.zeros((found.size, 2))
        point = np.array([r, z])
        nodes = np.stack([R[found], Z[found]], axis=-1)
        for _ in range(20):  # Newton; one step where the element is a parallelogram
            N, N_xi, N_eta = shape_functions(at[:, 0], at[:, 1])
            J = np.stack([np.einsum("ea,eac->ec", d, nodes) for d in (N_xi, N_eta)], axis=-1)
            gap = point - np.einsum("ea,eac->ec", N, nodes)
            step = (np.linalg.pinv(J) @ gap[:, :, None])[:, :, 0]
            at = np.clip(at + step, -1.5, 1.5)
            if np.abs(step).max(initial=0.0) < 1e-12:
                break
        distance = np.abs(at).max(axis=1) if found.size else np.ones(0)
        best = int(np.argmin(distance)) if found.size else -1
        if best < 0 or not distance[best] <= 1 + 1e-6:
            raise ValueError(f"the point r = {r}, z = {z} m lies outside the section")
        xi, eta = np.clip(at[best], -1, 1)
        return int(found[best]), float(xi), float(eta)


def _merge(values: Iterable[float], size: float) -> list[float]:
    lines: list[float] = []
    for value in sorted(values):
        if not lines or value - lines[-1] > SAME * size:
            lines.append(value)
    return lines


def _grid(
    cuts: Sequence[float], spans: Sequence[tuple[float, float, bool]], thin: float, refinement: float
) -> Array:
    """Grid lines along one axis, through all cuts, graded where a graded rectangle spans the interval.

    Parameters
    ----------
    thin
        Smallest width, across either axis, of the graded rectangles (or of all when none is graded), m.
    """
    pieces = []
    for a, b in pairwise(cuts):
        graded = any(g and lo <= a + 1e-6 * (b - a) and hi >= b - 1e-6 * (b - a) for lo, hi, g in spans)
        if graded:
            cap = max(0.15 * thin, (b - a) / 12) / refinement
            points = graded_line(a, b, EDGE * thin / refinement**3, cap, 1 + 1.0 / refinement)
        else:
            count = max(2, math.ceil(refinement * 2 * (b - a) / max(thin, (b - a) / 8)))
            points = np.linspace(a, b, count + 1)
        pieces.append(points[:-1])
    return np.concatenate([*pieces, [cuts[-1]]])


def _moved(lines: Array, fixed: Sequence[float], wanted: Iterable[float]) -> Array:
    """Grid lines with the nearest of them moved to each wanted place; a fixed one gets a new neighbour."""
    held = {float(v) for v in fixed}
    for v in wanted:
        k = int(np.argmin(np.abs(lines - v)))
        if not lines[0] < v < lines[-1] or abs(lines[k] - v) <= SAME * (lines[-1] - lines[0]):
            continue
        if float(lines[k]) in held:
            lines = np.sort(np.append(lines, v))
        else:
            lines[k] = v
        held.add(float(v))
    return lines


EDGE = 0.02  # first step at a graded side over the thickness; chosen by the reference cases of theory.md §3.7


def revolution_mesh(
    rectangles: Sequence[Rectangle],
    refinement: float = 1.0,
    r_cuts: Iterable[float] = (),
    z_cuts: Iterable[float] = (),
    z_near: Iterable[float] = (),
) -> RevolutionMesh:
    """Mesh a body of revolution, a union of rectangles, with grid lines along all their sides.

    Parameters
    ----------
    rectangles
        They may touch but not overlap.
    refinement
        Mesh density; 1 is the default. Steps shrink with it, and faster where the mesh is graded.
    r_cuts, z_cuts
        Further grid lines, m.
    z_near
        Places, m, to each of which the nearest line is moved; nothing is graded towards them.

    Raises
    ------
    ValueError
        For rectangles that overlap, or a refinement outside 0.25...8.
    """
    if not rectangles:
        raise ValueError("rectangles is empty; a body needs at least one region")
    remedy = "it must lie in 0.25...8, and 1 is the default density"
    if not 0.25 <= number("refinement", refinement, remedy) <= 8:
        raise ValueError(f"refinement is {refinement}; {remedy}")
    size = max(
        max(q.r[1] for q in rectangles) - min(q.r[0] for q in rectangles),
        max(q.z[1] for q in rectangles) - min(q.z[0] for q in rectangles),
    )
    chosen = [q for q in rectangles if q.graded] or list(rectangles)
    thin = min(min(q.r[1] - q.r[0], q.z[1] - q.z[0]) for q in chosen)
    r_ends = [v for q in rectangles for v in q.r]
    z_ends = [v for q in rectangles for v in q.z]
    r_lines = _merge([*r_ends, *(v for v in r_cuts if min(r_ends) < v < max(r_ends))], size)
    z_lines = _merge([*z_ends, *(v for v in z_cuts if min(z_ends) < v < max(z_ends))], size)
    R = _grid(r_lines, [(*q.r, q.graded) for q in rectangles], thin, refinement)
    Z = _moved(_grid(z_lines, [(*q.z, q.graded) for q in rectangles], thin, refinement), z_lines, z_near)

    r_mid, z_mid = 0.5 * (R[1:] + R[:-1]), 0.5 * (Z[1:] + Z[:-1])
    owner = np.full((r_mid.size, z_mid.size), -1, dtype=np.intp)
    for place, q in enumerate(rectangles):
        cells = np.ix_((r_mid > q.r[0]) & (r_mid < q.r[1]), (z_mid > q.z[0]) & (z_mid < q.z[1]))
        if (owner[cells] >= 0).any():
            raise ValueError(f"regions {int(owner[cells].max())} and {place} overlap; they may only touch")
        owner[cells] = place
    at_r, at_z = np.nonzero(owner >= 0)

    r_nodes = np.insert(R, np.arange(1, R.size), r_mid)
    z_nodes = np.insert(Z, np.arange(1, Z.size), z_mid)
    three = np.arange(3)
    i = (2 * at_r[:, None, None] + three[:, None]) + 0 * three
    j = (2 * at_z[:, None, None] + three) + 0 * three[:, None]
    used, elements = np.unique(i * z_nodes.size + j, return_inverse=True)
    return RevolutionMesh(
        r=r_nodes[used // z_nodes.size],
        z=z_nodes[used % z_nodes.size],
        elements=elements.reshape(-1, 9).astype(np.intp),
        region=owner[at_r, at_z],
    )
