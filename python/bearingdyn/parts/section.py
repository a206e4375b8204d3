"""What a body of revolution is drawn with: rings of one material, and the faces that it is joined by."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, Protocol, TypeAlias

import numpy as np

from bearingdyn.cms import modulus_levels
from bearingdyn.fem.revolution_mesh import SAME, Rectangle, RevolutionMesh
from bearingdyn.magnitude import check_length
from bearingdyn.material import Elastic
from bearingdyn.types import Array, Index

HIGHEST = 64  # Fourier order of a raceway: far more than any number of balls asks for


class ViscoelasticSolid(Protocol):
    """A material elastic in volume and viscoelastic in shear, such as Maxwell."""

    @property
    def K(self) -> float:
        """Bulk modulus, Pa."""

    @property
    def density(self) -> float:
        """Mass density, kg/m³."""

    def complex_modulus(self, omega: Any) -> Any:
        """G*(ω), Pa, for ω in rad/s."""


def _check_material(material: object) -> None:
    if not (isinstance(material, Elastic) or callable(getattr(material, "complex_modulus", None))):
        raise ValueError(f"material is {material!r}; it must be Elastic or have complex_modulus(omega)")


@dataclass(frozen=True)
class Region:
    """A ring of rectangular section and one material; r, z: (from, to), m.

    graded: crowd the mesh towards its sides; None: do so if the material is viscoelastic.

    Raises ValueError for a section that is none or above 10 m, or a material that is neither elastic nor has
    G*(ω).
    """

    r: tuple[float, float]
    z: tuple[float, float]
    material: Elastic | ViscoelasticSolid
    graded: bool | None = None

    def __post_init__(self) -> None:
        Rectangle(self.r, self.z)
        check_length("r[1]", self.r[1])
        check_length("z[1] - z[0]", self.z[1] - self.z[0])
        _check_material(self.material)

    @property
    def rectangle(self) -> Rectangle:
        """The section for the mesher."""
        graded = not isinstance(self.material, Elastic) if self.graded is None else self.graded
        return Rectangle(self.r, self.z, graded)

    @property
    def mass(self) -> float:
        """Mass, kg."""
        return self.material.density * math.pi * (self.r[1] ** 2 - self.r[0] ** 2) * (self.z[1] - self.z[0])


@dataclass(frozen=True)
class Patch:
    """The elements of a mesh that was brought whose `region` is this one's place in the list of regions."""

    material: Elastic | ViscoelasticSolid

    def __post_init__(self) -> None:
        _check_material(self.material)


@dataclass(frozen=True)
class Cylinder:
    """Cylindrical face of radius r, m, over z = (from, to); None: all of the body at that radius.

    The body it belongs to raises ValueError, naming the interface, where it has no such face.
    """

    r: float
    z: tuple[float, float] | None = None


@dataclass(frozen=True)
class EndFace:
    """Flat face at z, m, over r = (from, to); None: all of the body at that z.

    The body it belongs to raises ValueError, naming the interface, where it has no such face.
    """

    z: float
    r: tuple[float, float] | None = None


@dataclass(frozen=True)
class Line:
    """Conical face: the straight line of the section between two points (r, z), m.

    Raises ValueError where both points are one.
    """

    start: tuple[float, float]
    end: tuple[float, float]

    def __post_init__(self) -> None:
        if not math.hypot(self.end[0] - self.start[0], self.end[1] - self.start[1]) > 0:
            raise ValueError(f"start and end are both {self.start}; a line needs two points (r, z)")


@dataclass(frozen=True)
class Where:
    """Face of the nodes on the section's outline where inside(r, z) is true; r, z (n,) arrays, m."""

    inside: Callable[[Array, Array], Any]


@dataclass(frozen=True)
class MeshNodes:
    """Face of the nodes with these numbers, of the points of the mesh that was brought."""

    nodes: tuple[int, ...]

    def __post_init__(self) -> None:
        object.__setattr__(self, "nodes", tuple(int(k) for k in self.nodes))


Surface: TypeAlias = Cylinder | EndFace | Line | Where | MeshNodes


@dataclass(frozen=True)
class Groove:
    """A raceway: the displacement of its groove centre, radial and axial, by Fourier orders in the azimuth.

    At each azimuth the face's section is given the rigid motion nearest to its own (least squares along the
    section), and that motion is evaluated at radius `arm` and place `z`, as a rigid ring would be. A load
    of balls acts as the transpose: spread evenly along the section, its moment linearly.

    surface: the face that carries the balls.
    arm: radius, m, at which tilts become axial motion: BallBearing.arm of the bearing to come.
    order: highest Fourier order; up to the number of balls, see the convergence of what you need.
    z: plane of the balls, m; None: the middle of the surface.

    Raises ValueError for an arm that is not positive, or an order below 1.
    """

    surface: Surface
    arm: float
    order: int = 8
    z: float | None = None

    def __post_init__(self) -> None:
        if not 0 < self.arm < math.inf:
            raise ValueError(f"arm is {self.arm}; it must be a positive radius in m, as BallBearing.arm")
        if not (self.order >= 1 and self.order % 1 == 0 and self.order <= HIGHEST):
            raise ValueError(f"order is {self.order}; the highest Fourier order is a number in 1...{HIGHEST}")


@dataclass(frozen=True)
class Face:
    """An interface on a mesh: its nodes, sides (s, 3) and z of its reference point on the axis, m."""

    nodes: Index
    sides: Index
    reference: float


def find_face(mesh: RevolutionMesh, name: str, surface: Surface) -> Face:
    """The nodes and sides of a surface, its reference in the middle of its reach along z.

    Raises ValueError, with the name of what asks for it, where the body has no such face or not all of it.
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
    return Face(nodes, sides, 0.5 * (float(z.min()) + float(z.max())))


def _select(mesh: RevolutionMesh, name: str, surface: Surface) -> tuple[Index, float | None]:
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


def groove_weights(mesh: RevolutionMesh, face: Face, arm: float, z: float) -> tuple[Index, Array]:
    """Nodes (k,) and weights (2, k, 2): radial and axial motion of the groove centre from U and W there.

    The least-squares rigid motion of the section, u_r = a + φ (z − z_m), u_z = b − φ (r − r_m), taken at
    (arm, z): exact for a rigid ring. V, along the track, does not enter: balls roll.
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
    return nodes, rows


def shape_moduli(regions: Sequence[Region | Patch], moduli: Sequence[float] | None) -> list[list[float]]:
    """Real shear moduli, Pa, at which shapes are taken: a list over the regions per level."""
    soft = [i for i, q in enumerate(regions) if not isinstance(q.material, Elastic)]
    shear = [q.material.G if isinstance(q.material, Elastic) else 0.0 for q in regions]
    materials = [q.material for q in regions if not isinstance(q.material, Elastic)]
    levels = np.tile(shear, (len(given := modulus_levels(materials, moduli)), 1))
    levels[:, soft] = given
    return [level.tolist() for level in levels]
