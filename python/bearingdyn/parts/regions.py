"""Regions of a body of revolution: what is of one material, and the moduli at which shapes are taken."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np

from bearingdyn.checks import truth
from bearingdyn.fem import Rectangle, RevolutionMesh
from bearingdyn.material import Elastic
from bearingdyn.plausible_ranges import plausible
from bearingdyn.types import Index

LOCKING = 0.45  # Poisson's ratio from which an elastic region counts as rubber, lest its elements lock


class ViscoelasticSolid(Protocol):
    """Material of a viscoelastic region: elastic in volume and viscoelastic in shear, such as Maxwell."""

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


def is_rubber(material: Any) -> bool:
    """Whether a region's material is nearly incompressible: viscoelastic, or elastic with ν of LOCKING up."""
    return not isinstance(material, Elastic) or material.nu >= LOCKING


@dataclass(frozen=True)
class Region:
    """A region of a body of revolution: a ring of rectangular section and one material.

    Parameters
    ----------
    r, z
        (from, to), m.
    material
        Elastic, or viscoelastic in shear.
    graded
        Crowd the mesh towards its sides; None: do so if the material is viscoelastic.

    Raises
    ------
    ValueError
        For a section without area or above 10 m, or a material that is neither elastic nor has G*(ω).
    """

    r: tuple[float, float]
    z: tuple[float, float]
    material: Elastic | ViscoelasticSolid
    graded: bool | None = None

    def __post_init__(self) -> None:
        Rectangle(self.r, self.z)
        if self.graded is not None:
            truth("graded", self.graded)
        plausible("length", "r[1]", self.r[1])
        plausible("length", "z[1] - z[0]", self.z[1] - self.z[0])
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
    """A region by the elements of a mesh whose `region` is this patch's place in the list of regions."""

    material: Elastic | ViscoelasticSolid

    def __post_init__(self) -> None:
        _check_material(self.material)


def rubbers_of(regions: Sequence[Region | Patch]) -> tuple[list[Any], Index]:
    """Viscoelastic materials of regions, and of each region the number of its own, -1 if it is elastic."""
    rubbers: list[Any] = []
    owner = np.full(len(regions), -1)
    for i, q in enumerate(regions):
        if not isinstance(q.material, Elastic):
            if not any(q.material is m for m in rubbers):
                rubbers.append(q.material)
            owner[i] = next(j for j, m in enumerate(rubbers) if q.material is m)
    return rubbers, owner


def soft_elements(mesh: RevolutionMesh, regions: Sequence[Region | Patch], owner: int | None = None) -> Index:
    """Elements of the viscoelastic regions, or of those of one material, numbered as in the superelement."""
    _, owners = rubbers_of(regions)
    wanted = owners >= 0 if owner is None else owners == owner
    return np.flatnonzero(wanted[mesh.region])
