"""The O-ring between a shaft and a bore: it has a stiffness only once it is squeezed."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from bearingdyn.checks import nonnegative, number, positive, require
from bearingdyn.fem import (
    NoBalance,
    RevolutionMesh,
    disc_section,
    quadrilaterals,
)
from bearingdyn.material import Elastic, Hyperelastic
from bearingdyn.parts.regions import Patch, ViscoelasticSolid
from bearingdyn.parts.revolved import Revolved
from bearingdyn.parts.revolved_faces import MeshNodes
from bearingdyn.parts.squeezed import Squeezed
from bearingdyn.pictures import page
from bearingdyn.plausible_ranges import plausible
from bearingdyn.units import takes

HALF = math.pi / 4  # half of the angle, rad, of the evenly divided arcs on which it comes to touch
ACROSS = 16  # elements on each of those arcs, which ends of contact lie between


@takes(radius="m", cord="m", moduli="Pa")
@dataclass(frozen=True)
class ORing:
    """A rubber ring of round section, "inner" on a shaft and "outer" in a bore.

    Undeformed it touches both along a line, and has no stiffness: `assembled` makes a part of it.

    Parameters
    ----------
    radius
        Of the circle on which the cord's centre lies, m.
    cord
        Diameter of the cord, m.
    material
        Maxwell, or another viscoelastic or elastic one.
    moduli
        Real shear moduli, Pa, at which the superelement takes its shapes; see Layer.
    refinement
        Mesh density; 1 is the default.

    Raises
    ------
    ValueError
        For dimensions that are not positive, or a cord thicker than twice the radius.

    Examples
    --------
    >>> import bearingdyn as bd
    >>> rubber = bd.Maxwell(G0=1e6, G=[2e6], tau=[1e-4], K=2e9, density=1150.0)
    >>> seal = bd.ORing(radius=0.022, cord=0.004, material=rubber).assembled(squeeze=0.10)
    >>> f"{seal.force:.0f} N all around, {seal.widths['outer'] * 1e3:.1f} mm wide at the bore"
    '99 N all around, 1.2 mm wide at the bore'
    """

    radius: float
    cord: float
    material: Elastic | ViscoelasticSolid
    moduli: tuple[float, ...] | None = None
    refinement: float = 1.0

    _repr_html_ = page

    def __post_init__(self) -> None:
        positive("radius", self.radius, "it must be a positive radius in m")
        positive("cord", self.cord, "it must be a positive diameter in m")
        require(
            self.cord < 2.0 * self.radius, "cord", self.cord, f"it must be less than {2 * self.radius:g} m"
        )
        fine = number("refinement", self.refinement, "it must lie in 0.25...8")
        require(0.25 <= fine <= 8, "refinement", self.refinement, "it must lie in 0.25...8")
        plausible("length", "radius", self.radius)
        _ = self.body

    @cached_property
    def section(self) -> RevolutionMesh:
        """The mesh of the undeformed section."""
        a = 0.5 * self.cord
        across = 2 * math.ceil(0.5 * ACROSS * self.refinement)
        plane, quads = disc_section(
            a, HALF, np.linspace(0.0, 1.0, across + 1), math.ceil(5 * self.refinement)
        )
        mesh = quadrilaterals(plane + np.array([self.radius, 0.0]), quads)
        r, z = mesh.r - self.radius, mesh.z
        scale = np.ones_like(r)
        scale[mesh.outline] = a / np.hypot(r, z)[mesh.outline]  # middles of sides lie on chords
        return replace(mesh, r=self.radius + scale * r, z=scale * z)

    @cached_property
    def body(self) -> Revolved:
        """The ring as a body of revolution, its interfaces the two sides about each line of first contact."""
        mesh = self.section
        sides = mesh.outline_sides
        faces = {}
        for name, sign in (("inner", -1.0), ("outer", 1.0)):
            top = int(np.argmax(sign * mesh.r))
            faces[name] = MeshNodes(tuple(np.unique(sides[(sides == top).any(axis=1)]).tolist()))
        return Revolved((Patch(self.material),), faces, moduli=self.moduli, section=mesh)

    def assembled(
        self,
        *,
        squeeze: float,
        law: Hyperelastic | None = None,
        branches: str = "current",
        after: float | None = None,
    ) -> Squeezed:
        """The ring squeezed radially without friction, which then sticks where it touches.

        The bore moves inwards, the shaft stays; both are wide. Without the walls of a groove the ring may
        roll: its axial and tilting stiffness is then less than what sticking says.

        Parameters
        ----------
        squeeze
            Share of the cord's diameter, above 0 and less than 1.
        law, branches, after
            As for Layer.assembled.

        Raises
        ------
        ValueError
            For a squeeze out of range, and naming the squeeze that was reached, where it goes no further.
        """
        remedy = "it must be a share of the cord, above 0 and less than 1: unsqueezed it has no stiffness"
        require(0.0 < nonnegative("squeeze", squeeze, remedy) < 1.0, "squeeze", squeeze, remedy)

        def on(ring: ORing) -> Squeezed:
            return ring.body.squeezed(
                {"outer": squeeze * self.cord},
                slip=("inner", "outer"),
                law=law,
                branches=branches,
                after=after,
            )

        try:
            return on(self)
        except NoBalance as failure:
            raise ValueError(
                f"squeeze is {squeeze}; {failure.share * squeeze:.3g} of the cord is reached: "
                f"{failure.reason}"
            ) from None
