"""Faces of a body of revolution: what they are named by, and where they lie on a mesh."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from types import NoneType
from typing import Any, TypeAlias

import numpy as np

from bearingdyn.bearing import footprint_profile
from bearingdyn.checks import indices, instance, positive, require, two, vector, whole
from bearingdyn.fem import SAME, RevolutionMesh, lagrange
from bearingdyn.plausible_ranges import plausible
from bearingdyn.types import Array, Index

HIGHEST = 64  # Fourier order of a raceway: far more than any number of balls asks for


@dataclass(frozen=True)
class Cylinder:
    """Cylindrical face of a revolved body, of radius r, m, over z = (from, to); None: all at that radius.

    A body without such a face raises ValueError and names the interface.
    """

    r: float
    z: tuple[float, float] | None = None

    def __post_init__(self) -> None:
        plausible("length", "r", positive("r", self.r, "it must be a positive radius in m"))
        _check_span("z", self.z)


@dataclass(frozen=True)
class EndFace:
    """Flat face of a revolved body at z, m, over r = (from, to); None: all of the body at that z.

    A body without such a face raises ValueError and names the interface.
    """

    z: float
    r: tuple[float, float] | None = None

    def __post_init__(self) -> None:
        plausible("place", "z", self.z)
        _check_span("r", self.r)


@dataclass(frozen=True)
class Line:
    """Conical face of a revolved body: the straight line of its section between two points (r, z), m.

    Raises
    ------
    ValueError
        If both points are the same.
    """

    start: tuple[float, float]
    end: tuple[float, float]

    def __post_init__(self) -> None:
        for name in ("start", "end"):
            point = vector(name, getattr(self, name), (2,), "a point (r, z) in m")
            object.__setattr__(self, name, tuple(point.tolist()))
        if not math.hypot(self.end[0] - self.start[0], self.end[1] - self.start[1]) > 0:
            raise ValueError(f"start and end are both {self.start}; a line needs two points (r, z)")


@dataclass(frozen=True)
class Where:
    """Face of a revolved body where inside(r, z) is true on its outline; r, z (n,) arrays, m."""

    inside: Callable[[Array, Array], Any]

    def __post_init__(self) -> None:
        require(callable(self.inside), "inside", self.inside, "it must be a function of r and z")


@dataclass(frozen=True)
class MeshNodes:
    """Face of a revolved body by numbers of nodes, counted from 0 among the points of the given mesh."""

    nodes: tuple[int, ...]

    def __post_init__(self) -> None:
        nodes = indices("nodes", self.nodes, "it must be numbers of nodes, counted from 0")
        object.__setattr__(self, "nodes", tuple(np.atleast_1d(nodes).tolist()))


Face: TypeAlias = Cylinder | EndFace | Line | Where | MeshNodes
FACES = (Cylinder, EndFace, Line, Where, MeshNodes)


def _check_span(field: str, span: tuple[float, float] | None) -> None:
    if span is not None:
        low, high = two(field, span, "it must be (from, to), rising, m")
        require(low < high, field, span, "it must be (from, to), rising, m")


@dataclass(frozen=True)
class Footprint:
    """Footprint of the balls on a grooved face of a revolved body: the ellipse across the rolling direction.

    Parameters
    ----------
    point
        (r, z) of its middle, m.
    angle
        Of the line of contact, rad: the ring is pressed along (cos, sin) in (r, z).
    half_length
        Semi-axis, m.
    """

    point: tuple[float, float]
    angle: float
    half_length: float

    @property
    def normal(self) -> Array:
        """(2,) the line of contact in (r, z)."""
        return np.array([math.cos(self.angle), math.sin(self.angle)])

    def lines(self) -> tuple[float, ...]:
        """Places along z, m, at which a mesh should have lines."""
        reach = self.half_length * math.cos(self.angle)
        return tuple(self.point[1] + k * reach for k in (-1.0, -0.5, 0.0, 0.5, 1.0))


@dataclass(frozen=True)
class Groove:
    """Grooved face of a revolved body, a raceway: the motion of its groove centre by Fourier orders.

    At each azimuth a rigid motion is fitted to that of the face's section by least squares, and evaluated at
    radius `arm` and place `z`, as that of a rigid ring would be. A load of balls acts as the transpose:
    spread evenly along the section, its moment linearly.

    Parameters
    ----------
    surface
        The face that carries the balls.
    arm
        Radius, m, at which tilts become axial motion: the arm of the bearing that will run here
        (BallBearing.arm).
    order
        Highest Fourier order. Raise it, up to the number of balls, until what you need has converged.
    z
        Plane of the balls, m; None: the middle of the surface.
    footprint
        Where the balls touch. Along the line of contact the motion is then the average under Hertz's
        pressure, and loads act with that; None: everywhere over the surface.

    Raises
    ------
    ValueError
        For an arm that is not positive, or an order below 1.
    """

    surface: Face
    arm: float
    order: int = 8
    z: float | None = None
    footprint: Footprint | None = None

    def __post_init__(self) -> None:
        remedy = "it must be a Cylinder, EndFace, Line, Where or MeshNodes"
        instance("surface", self.surface, FACES, remedy)
        positive("arm", self.arm, "it must be a positive radius in m, as BallBearing.arm")
        plausible("length", "arm", self.arm)
        if self.z is not None:
            plausible("place", "z", self.z)
        instance("footprint", self.footprint, (Footprint, NoneType), "it must be a Footprint, or None")
        whole("order", self.order, 1, HIGHEST)


@dataclass(frozen=True)
class MeshFace:
    """A face on a revolved mesh: its nodes, sides (s, 3) and z of its reference point on the axis, m."""

    nodes: Index
    sides: Index
    reference: float


def find_face(mesh: RevolutionMesh, name: str, surface: Face) -> MeshFace:
    """The nodes and sides of a face of a revolved body, its reference in the middle of its reach along z.

    Raises
    ------
    ValueError
        If the body lacks the face or a part of it; the message names what asked for it.
    """
    e = SAME * mesh.size
    nodes, length = _select(mesh, name, surface)
    sides = mesh.edges[np.isin(mesh.edges, nodes).all(axis=1)]
    if nodes.size < 3 or not len(sides):
        raise ValueError(f"{name} is {surface}, where the body has no face")
    ends = sides[:, [0, 2]]
    own = float(np.hypot(np.diff(mesh.r[ends]), np.diff(mesh.z[ends])).sum())
    if np.setdiff1d(nodes, sides).size or (length is not None and not abs(own - length) < 10 * e):
        raise ValueError(f"{name} is {surface}; the body does not reach along all of it")
    z = mesh.z[nodes]
    return MeshFace(nodes, sides, 0.5 * (float(z.min()) + float(z.max())))


def _select(mesh: RevolutionMesh, name: str, surface: Face) -> tuple[Index, float | None]:
    """Nodes of a surface and, where it tells, the length of the section's line that they must cover."""
    if isinstance(surface, Where):
        r, z = mesh.r[mesh.outline], mesh.z[mesh.outline]
        return mesh.outline[np.broadcast_to(np.asarray(surface.inside(r, z), dtype=bool), r.shape)], None
    if isinstance(surface, MeshNodes):
        nodes = np.unique(np.array(surface.nodes, dtype=np.intp))
        if nodes.size and not (0 <= nodes[0] and nodes[-1] < mesh.r.size):
            raise ValueError(f"{name} names nodes outside 0...{mesh.r.size - 1}")
        return _with_middles(mesh, nodes), None
    if isinstance(surface, Line):
        start, end = np.array(surface.start), np.array(surface.end)
        length = float(np.hypot(*(end - start)))
        along = (end - start) / length
        r, z = mesh.r - start[0], mesh.z - start[1]
        s, off = r * along[0] + z * along[1], np.abs(r * along[1] - z * along[0])
        e = SAME * mesh.size
        return np.flatnonzero((off <= e) & (s >= -e) & (s <= length + e)), length
    upright = isinstance(surface, Cylinder)
    if isinstance(surface, Cylinder):
        span, line = surface.z, (surface.r, surface.r)
    else:
        span, line = surface.r, (surface.z, surface.z)
    lo, hi = span or (-math.inf, math.inf)
    if not lo < hi:
        raise ValueError(f"{name} runs over {span}; it must be (from, to), rising, m")
    nodes = mesh.nodes_on(line, (lo, hi)) if upright else mesh.nodes_on((lo, hi), line)
    if span is None and nodes.size:
        reach = (mesh.z if upright else mesh.r)[nodes]
        lo, hi = float(reach.min()), float(reach.max())
    return nodes, hi - lo if math.isfinite(hi - lo) else None


def _with_middles(mesh: RevolutionMesh, nodes: Index) -> Index:
    """Nodes and the middles of the sides both of whose ends are among them: 4-node meshes name none."""
    both = np.isin(mesh.edges[:, [0, 2]], nodes).all(axis=1)
    return np.union1d(nodes, mesh.edges[both, 1])


def groove_weights(
    mesh: RevolutionMesh, face: MeshFace, arm: float, z: float, footprint: Footprint | None = None
) -> tuple[Index, Array]:
    """Nodes (k,), weights (2, k, 2) of a grooved face: motion of the groove centre from U and W there.

    The least-squares rigid motion of the section, u_r = a + φ (z − z_m), u_z = b − φ (r − r_m), taken at
    (arm, z): exact for a rigid ring. Along the line of contact of a footprint it is the average under it
    instead, carried to the groove centre by the same turn φ. V, along the track, does not enter: balls roll.
    """
    ends = face.sides[:, [0, 2]]
    length = np.hypot(np.diff(mesh.r[ends]), np.diff(mesh.z[ends]))[:, 0]
    share = np.zeros(mesh.r.size)
    np.add.at(share, face.sides, length[:, None] * np.array([1.0, 4.0, 1.0]) / 6.0)  # Simpson's rule
    nodes = face.nodes
    w = share[nodes] / share[nodes].sum()
    r_m, z_m = float(w @ mesh.r[nodes]), float(w @ mesh.z[nodes])
    r, height = mesh.r[nodes] - r_m, mesh.z[nodes] - z_m
    turn = np.stack([w * height, -w * r], axis=-1) / float(w @ (r**2 + height**2))
    rows = np.zeros((2, nodes.size, 2))
    rows[0, :, 0] = rows[1, :, 1] = w
    rows[0] += (z - z_m) * turn
    rows[1] -= (arm - r_m) * turn
    if footprint is not None:
        normal = footprint.normal
        under = _pressed(mesh, face, footprint)[nodes]
        own = under[:, None] * normal
        # a turn about the origin moves (r, z) by (z, −r): what the footprint has of it, and the groove
        # centre should
        lacking = normal @ [z, -arm] - float(np.sum(own * np.stack([mesh.z[nodes], -mesh.r[nodes]], axis=-1)))
        across = np.array([-normal[1], normal[0]])
        rows = np.multiply.outer(normal, own + lacking * turn) + np.multiply.outer(
            across, np.tensordot(across, rows, 1)
        )
    return nodes, rows


def _pressed(mesh: RevolutionMesh, face: MeshFace, footprint: Footprint) -> Array:
    """Share (nodes,) of a ball's load at each node of the mesh, 1 in all.

    Raises
    ------
    ValueError
        If the footprint lies off the face.
    """
    x, weight = np.polynomial.legendre.leggauss(6)
    N, slope = lagrange(x)
    along = np.array([-footprint.normal[1], footprint.normal[0]])
    share = np.zeros(mesh.r.size)
    for side in face.sides:
        at = np.stack([mesh.r[side], mesh.z[side]])
        s = along @ (at @ N.T - np.array(footprint.point)[:, None])
        length = weight * np.hypot(*(at @ slope.T))
        np.add.at(share, side, N.T @ (length * footprint_profile(s / footprint.half_length)))
    total = float(share.sum()) / footprint.half_length
    if not total > 0.98:
        raise ValueError(
            f"the contact ellipse is {2e3 * footprint.half_length:.3g} mm long and {100 * (1 - total):.3g} % "
            f"of its load lies off the groove; widen the groove, or state a smaller load"
        )
    return np.asarray(share / share.sum())
