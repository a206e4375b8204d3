"""Regions of a body of revolution: what is of one material, and the moduli at which shapes are taken."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np

from bearingdyn.checks import positive, require
from bearingdyn.cms import modulus_levels
from bearingdyn.fem import Rectangle
from bearingdyn.magnitude import plausible
from bearingdyn.material import Elastic, warn_beyond

LOCKING = 0.45  # Poisson's ratio from which an elastic region counts as rubber, lest its elements lock


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


def quasi_static(material: Any, omega: float, after: float | None) -> complex:
    """G*(ω), Pa, or G(t) after a time, s, of a part by itself; warns where data do not speak of it."""
    if isinstance(material, Elastic):
        return complex(material.G)
    if after is not None:
        positive("after", after, "it must be a positive and finite time, s")
        require(omega == 0, "omega", omega, f"with after={after!r} the part is at rest: leave it out")
        if not callable(getattr(material, "relaxation", None)):
            raise ValueError(
                f"material is {type(material).__name__}; after= needs a relaxation modulus: take "
                f"material.maxwell(n, band=...)"
            )
    if omega == 0:
        warn_beyond(
            [("the part", material)],
            math.inf if after is None else after,
            "the static stiffness",
            "ask for stiffness(after=...) at a time that the data reach, ",
        )
    G = complex(material.complex_modulus(omega) if after is None else float(material.relaxation(after)))
    if not abs(G) > 1e-12 * getattr(material, "K", 0.0):
        raise ValueError(
            f"material has |G*| = {abs(G):.3g} Pa at omega = {omega} rad/s: no stiffness "
            "in shear to solve with; give a material with G0 > 0, or omega > 0"
        )
    return G


def is_rubber(material: Any) -> bool:
    """Whether a material is nearly incompressible: viscoelastic, or elastic with ν of LOCKING or more."""
    return not isinstance(material, Elastic) or material.nu >= LOCKING


@dataclass(frozen=True)
class Region:
    """A ring of rectangular section and one material.

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
    """The elements of a given mesh whose `region` is this patch's place in the list of regions."""

    material: Elastic | ViscoelasticSolid

    def __post_init__(self) -> None:
        _check_material(self.material)


def shape_moduli(regions: Sequence[Region | Patch], moduli: Sequence[float] | None) -> list[list[float]]:
    """Real shear moduli, Pa, at which shapes are taken: a list over the regions per level."""
    soft = [i for i, q in enumerate(regions) if not isinstance(q.material, Elastic)]
    shear = [q.material.G if isinstance(q.material, Elastic) else 0.0 for q in regions]
    materials = [q.material for q in regions if not isinstance(q.material, Elastic)]
    levels = np.tile(shear, (len(given := modulus_levels(materials, moduli)), 1))
    levels[:, soft] = given
    return [level.tolist() for level in levels]
