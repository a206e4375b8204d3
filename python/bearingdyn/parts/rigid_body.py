"""A rigid body: six coordinates, a mass and its moments of inertia."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from bearingdyn.checks import instance, nonnegative, positive, vector
from bearingdyn.cms import RoundFace, Superelement
from bearingdyn.material import STEEL, Elastic
from bearingdyn.parts.outline import Outline, box, carried, cylinder
from bearingdyn.parts.profile import Profile, mirrored, rectangle
from bearingdyn.pictures import page
from bearingdyn.plausible_ranges import check_gyration, plausible
from bearingdyn.types import Array
from bearingdyn.units import takes


@takes(mass="kg", inertia="kg m²", measures="m")
@dataclass(frozen=True)
class RigidBody:
    """A rigid body with one interface, "centre", at its centre of mass.

    Parameters
    ----------
    mass
        kg.
    inertia
        (Ix, Iy, Iz), kg m², about the centre; the axes x, y, z are principal.
    rotating
        The body turns with the shaft about z; its polar inertia is then Iz, and Ix must equal Iy, for the
        inertia of an unequal body would vary with the angle.
    measures
        (r_inner, r_outer, width), m, of the ring it is drawn as; None: the box of its inertia.

    Raises
    ------
    ValueError
        For values that are not positive or that no body can have.

    Examples
    --------
    >>> import bearingdyn as bd
    >>> ring = bd.RigidBody.ring(r_inner=0.0, r_outer=0.1, width=0.02)  # a steel disc
    >>> round(ring.mass, 3), round(ring.inertia[2], 5)  # kg, m r²/2 in kg m²
    (4.932, 0.02466)
    """

    mass: float
    inertia: tuple[float, float, float]
    rotating: bool = False
    measures: tuple[float, float, float] | None = None

    _repr_html_ = page

    def __post_init__(self) -> None:
        plausible("mass", "mass", positive("mass", self.mass, "it must be a positive mass in kg"))
        instance("rotating", self.rotating, (bool, np.bool_), "it must be True or False")
        if self.measures is not None:
            meaning = "r_inner, r_outer and width in m"
            object.__setattr__(
                self, "measures", tuple(vector("measures", self.measures, (3,), meaning).tolist())
            )
        moments = vector("inertia", self.inertia, (3,), "three moments (Ix, Iy, Iz) in kg m²")
        inertia = tuple(moments.tolist())
        for name, value in zip(("Ix", "Iy", "Iz"), inertia, strict=True):
            positive(f"inertia {name}", value, "it must be a positive moment in kg m²")
        if not 2.0 * max(inertia) <= sum(inertia) * (1.0 + 1e-9):
            raise ValueError(f"inertia is {inertia}; no moment may exceed the sum of the other two")
        if self.rotating and not math.isclose(inertia[0], inertia[1], rel_tol=1e-9):
            raise ValueError(f"inertia is {inertia}; a rotating body needs Ix = Iy")
        for name, value in zip(("Ix", "Iy", "Iz"), inertia, strict=True):
            check_gyration(f"inertia {name}", value, self.mass)
        object.__setattr__(self, "inertia", inertia)

    @classmethod
    @takes(r_inner="m", r_outer="m", width="m")
    def ring(
        cls,
        r_inner: float,
        r_outer: float,
        width: float,
        material: Elastic = STEEL,
        *,
        rotating: bool = False,
    ) -> RigidBody:
        """A ring (a disc when r_inner is 0) about z, for example that of a bearing; radii and width in m.

        Raises
        ------
        ValueError
            Unless 0 <= r_inner < r_outer <= 10 m and 0 < width <= 10 m.
        """
        instance("material", material, Elastic, "it must be a bd.Elastic(E, nu, density), such as bd.STEEL")
        positive("r_outer", r_outer, "it must be a positive radius in m")
        nonnegative("r_inner", r_inner, "it must be a radius in m, 0 for a disc")
        if not 0 <= r_inner < r_outer:
            raise ValueError(f"r_inner is {r_inner}; it must be at least 0 and below r_outer = {r_outer} m")
        positive("width", width, "it must be a positive width in m")
        plausible("length", "r_outer", r_outer)
        plausible("length", "width", width)
        mass = material.density * math.pi * (r_outer**2 - r_inner**2) * width
        square = r_inner**2 + r_outer**2
        across = mass * (square / 4.0 + width**2 / 12.0)
        inertia = (across, across, mass * square / 2.0)
        return cls(mass, inertia, rotating, (r_inner, r_outer, width))

    def round_faces(self) -> Mapping[str, tuple[RoundFace, ...]]:
        """Bore and outside of a ring of known measures, against which neighbours are checked."""
        if self.measures is None:
            return {}
        r_inner, r_outer, width = self.measures
        half = (-0.5 * width, 0.5 * width)
        outside = RoundFace("shaft", r_outer, half, beside=True)
        bore = (RoundFace("bore", r_inner, half, beside=True),) if r_inner > 0 else ()
        return {"centre": (*bore, outside)}

    def superelement(self) -> Superelement:
        """Six coordinates, those of the interface "centre"; gyroscopic when rotating."""
        G = np.zeros((6, 6))
        if self.rotating:
            G[3, 4], G[4, 3] = self.inertia[2], -self.inertia[2]
        return Superelement(
            M=np.diag([self.mass] * 3 + list(self.inertia)),
            C=np.zeros((6, 6)),
            G=G,
            K=np.zeros((6, 6)),
            interfaces={"centre": np.arange(6)},
            faces=self.round_faces(),
        )

    def profile(self) -> list[Profile]:
        """What the plane x = 0 shows of it: the ring of its measures, or the box of its mass and inertia."""
        if self.measures is not None:
            r_inner, r_outer, width = self.measures
            return mirrored(rectangle((-0.5 * width, 0.5 * width), (r_inner, r_outer)), "metal")
        _, height, length = self._box()
        return [Profile(rectangle((-0.5 * length, 0.5 * length), (-0.5 * height, 0.5 * height)), "body")]

    def _box(self) -> Array:
        """Sides (3,), m, of the box of evenly spread mass that has its mass and inertia."""
        # I_x = m (b² + c²)/12, and so on
        moments = np.array(self.inertia)
        return np.asarray(np.sqrt(np.maximum(6.0 * (moments.sum() - 2.0 * moments) / self.mass, 0.0)))

    def outline(self) -> Outline:
        """The ring of its measures, or the box of evenly spread mass that has its mass and inertia."""
        if self.measures is not None:
            r_inner, r_outer, width = self.measures
            points, faces = cylinder(r_inner, r_outer, (-0.5 * width, 0.5 * width))
        else:
            points, faces = box(self._box())
        return Outline(points, faces, carried(np.eye(6), points))
