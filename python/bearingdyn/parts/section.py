"""What a body of revolution is drawn with: rings of one material, and faces that move as rigid bodies."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from bearingdyn.cms import modulus_levels
from bearingdyn.fem.revolution_mesh import SAME, Rectangle, RevolutionMesh
from bearingdyn.material import Elastic


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


@dataclass(frozen=True)
class Region:
    """A ring of rectangular section and one material; r, z: (from, to), m.

    graded: crowd the mesh towards its sides; None: do so if the material is viscoelastic.
    """

    r: tuple[float, float]
    z: tuple[float, float]
    material: Elastic | ViscoelasticSolid
    graded: bool | None = None

    def __post_init__(self) -> None:
        Rectangle(self.r, self.z)
        if not (
            isinstance(self.material, Elastic) or callable(getattr(self.material, "complex_modulus", None))
        ):
            raise ValueError(
                f"material is {self.material!r}; it must be Elastic or have complex_modulus(omega)"
            )

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
class Cylinder:
    """Cylindrical face of radius r, m, over z = (from, to); None: all of the body at that radius."""

    r: float
    z: tuple[float, float] | None = None


@dataclass(frozen=True)
class EndFace:
    """Flat face at z, m, over r = (from, to); None: all of the body at that z."""

    z: float
    r: tuple[float, float] | None = None


@dataclass(frozen=True)
class Face:
    """An interface on a mesh: its nodes and z of its reference point on the axis, m."""

    nodes: NDArray[np.intp]
    reference: float


def find_face(mesh: RevolutionMesh, name: str, surface: Cylinder | EndFace) -> Face:
    """The nodes of a surface. Raises ValueError, naming the interface, where the body has no such face."""
    upright = isinstance(surface, Cylinder)
    if isinstance(surface, Cylinder):
        along, span, line = mesh.z, surface.z, (surface.r, surface.r)
    else:
        along, span, line = mesh.r, surface.r, (surface.z, surface.z)
    lo, hi = span or (-math.inf, math.inf)
    if not lo < hi:
        raise ValueError(f"interfaces[{name!r}] runs over {span}; it must be (from, to), rising, m")
    nodes = mesh.nodes_on(line, (lo, hi)) if upright else mesh.nodes_on((lo, hi), line)
    if nodes.size < 3:
        raise ValueError(f"interfaces[{name!r}] is {surface}, where the body has no face")
    first, last = float(along[nodes].min()), float(along[nodes].max())
    if span is None:
        lo, hi = first, last
    e = SAME * mesh.size
    lines = np.unique(np.round(along[(along >= lo - e) & (along <= hi + e)] / e)).size
    if not (abs(first - lo) < e and abs(last - hi) < e and nodes.size == lines):
        raise ValueError(f"interfaces[{name!r}] is {surface}; the body does not reach along all of it")
    return Face(nodes, 0.5 * (first + last) if upright else float(line[0]))


def shape_moduli(regions: Sequence[Region], moduli: Sequence[float] | None) -> list[list[float]]:
    """Real shear moduli, Pa, at which shapes are taken: a list over the regions per level."""
    soft = [i for i, q in enumerate(regions) if not isinstance(q.material, Elastic)]
    shear = [q.material.G if isinstance(q.material, Elastic) else 0.0 for q in regions]
    materials = [q.material for q in regions if not isinstance(q.material, Elastic)]
    levels = np.tile(shear, (len(given := modulus_levels(materials, moduli)), 1))
    levels[:, soft] = given
    return [level.tolist() for level in levels]
