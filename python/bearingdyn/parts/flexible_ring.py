"""The outer ring that bends between the balls, alone or with its rubber (the paper's special CMS)."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Literal

import numpy as np

from bearingdyn.checks import instance, one_of, positive
from bearingdyn.cms import Superelement
from bearingdyn.fem import Rectangle, RevolutionMesh, revolution_mesh
from bearingdyn.magnitude import plausible
from bearingdyn.material import STEEL, Elastic
from bearingdyn.parts.layer import Layer
from bearingdyn.parts.outline import Outline
from bearingdyn.parts.profile import Profile
from bearingdyn.parts.regions import Patch, Region
from bearingdyn.parts.revolved import Revolved
from bearingdyn.parts.revolved_faces import Cylinder, Face, Groove, Line, Where
from bearingdyn.parts.round_face import RoundFace
from bearingdyn.units import takes


@takes(r_inner="m", r_outer="m", width="m", arm="m", groove="m", groove_radius="m", f_max="Hz")
@dataclass(frozen=True)
class FlexibleRing:
    """A flexible outer ring, not turning, whose "raceway" carries the balls of one bearing.

    With `layer`, a rubber ring bonded around it, the outside of the rubber is the rigid interface "outer".
    Without a layer the ring's own outside is "outer", kept round by a rigid bore; or, with
    outside="flexible", it is the raceway "outside", as flexible as the raceway inside, and the ring is held
    only by what carries that raceway.

    Parameters
    ----------
    r_inner
        Bore at the shoulders, or at the bottom of the groove if no groove_radius is given.
    r_outer, width
        m. The plane of the balls is at mid-width.
    arm
        Radius, m, at which tilts become axial motion: the arm of the bearing that will run here
        (BallBearing.arm).
    order
        Highest Fourier order in the azimuth. Orders up to one more than the number of balls hold all the
        bending that the balls cause, which falls off as order⁻⁴. Far higher orders do no good: they add the
        dent around each ball, which falls off as 1/order only and which Hertz's contact has already.
    groove
        Axial width of the face that carries the balls, m; None: half of the ring's.
    groove_radius
        Radius of the groove's section, m (fo·Dw): the section then has the groove cut into it; None: a plain
        rectangle.
    layer
        Rubber, its r_inner equal to r_outer here; its material, moduli and refinement are taken.
    outside
        "rigid" or "flexible", where there is no layer.
    damping
        Ratio ζ of the ring's free elastic modes.
    refinement
        Mesh density.
    f_max
        Modes with the interfaces held are kept up to this frequency, Hz; 0: none, the default of bodies of
        revolution. In rubber static shapes alone are some 6 % off at 5 kHz; with three times the highest
        frequency of interest 0.2 % are left.

    Raises
    ------
    ValueError
        For dimensions out of order, a groove that does not fit, or a layer that does not touch.
    """

    r_inner: float
    r_outer: float
    width: float
    arm: float
    order: int = 10
    groove: float | None = None
    groove_radius: float | None = None
    layer: Layer | None = None
    outside: Literal["rigid", "flexible"] = "rigid"
    material: Elastic = STEEL
    damping: float = 0.0
    f_max: float = 0.0
    refinement: float = 1.0

    def __post_init__(self) -> None:
        positive("r_inner", self.r_inner, "it must be a positive radius in m")
        positive("r_outer", self.r_outer, "it must be a positive radius in m")
        if not self.r_inner < self.r_outer < math.inf:
            raise ValueError(f"r_outer is {self.r_outer}; it must exceed r_inner = {self.r_inner} m")
        positive("width", self.width, "it must be a positive length in m")
        positive("refinement", self.refinement, "it must be a positive mesh density, 1 by default")
        for name in ("r_outer", "width"):
            plausible("length", name, getattr(self, name))
        plausible("length", "arm", positive("arm", self.arm, "it must be a positive radius in m"))
        for name in ("groove", "groove_radius"):
            if getattr(self, name) is not None:
                positive(name, getattr(self, name), "it must be a positive length in m")
        if self.groove is not None and not 0 < self.groove <= self.width:
            raise ValueError(f"groove is {self.groove}; it must lie in 0...width = {self.width} m")
        if self.groove_radius is not None:
            half = 0.5 * self.track
            if not self.groove_radius > half or not self.track < self.width:
                raise ValueError(
                    f"groove_radius is {self.groove_radius}; it must exceed half the groove's width, "
                    f"{half} m, and the groove must be narrower than the ring"
                )
            if not self.depth < self.r_outer - self.r_inner:
                raise ValueError(f"the groove is {self.depth:g} m deep and cuts the ring; make it narrower")
        one_of("outside", self.outside, ("rigid", "flexible"))
        if self.layer is not None:
            instance("layer", self.layer, Layer, "it must be a bd.Layer(…), or None")
            if not math.isclose(self.layer.r_inner, self.r_outer, rel_tol=1e-9):
                raise ValueError(
                    f"layer.r_inner is {self.layer.r_inner}; a layer is bonded to the ring at "
                    f"r_outer = {self.r_outer} m"
                )
            if self.outside != "rigid":
                raise ValueError("outside is \"flexible\"; with a layer the ring's outside is the rubber's")
        _ = self.body

    @property
    def track(self) -> float:
        """Axial width of the face that carries the balls, m."""
        return 0.5 * self.width if self.groove is None else self.groove

    @property
    def depth(self) -> float:
        """Depth of the groove below the shoulders, m."""
        if self.groove_radius is None:
            return 0.0
        return self.groove_radius - math.sqrt(self.groove_radius**2 - (0.5 * self.track) ** 2)

    @cached_property
    def body(self) -> Revolved:
        """The ring, and its rubber, as a body of revolution."""
        half, track = 0.5 * self.width, 0.5 * self.track
        regions = [Region((self.r_inner, self.r_outer), (-half, half), self.material)]
        face: Face = Cylinder(self.r_inner, (-track, track))
        outer = self.r_outer
        if self.layer is not None:
            outer, reach = self.layer.r_outer, 0.5 * self.layer.width
            regions.append(Region((self.r_outer, outer), (-reach, reach), self.layer.material, graded=True))
        section = None
        if self.groove_radius is not None:
            face = Where(
                lambda r, z: (np.abs(z) <= track * (1 + 1e-9)) & (r <= self.r_inner + 1.01 * self.depth)
            )
            section = self._grooved([q.rectangle for q in regions], track)
        grooves = {"raceway": Groove(face, self.arm, self.order, z=0.0)}
        interfaces: dict[str, Face] = {}
        if self.layer is None and self.outside == "flexible":
            grooves["outside"] = Groove(Line((outer, -half), (outer, half)), outer, self.order, z=0.0)
        else:
            interfaces["outer"] = Cylinder(outer)
        return Revolved(
            tuple(regions) if section is None else tuple(Patch(q.material) for q in regions),
            interfaces,
            damping=self.damping,
            f_max=self.f_max,
            moduli=None if self.layer is None else self.layer.moduli,
            refinement=self.refinement,
            grooves=grooves,
            section=section,
        )

    def _grooved(self, rectangles: list[Rectangle], track: float) -> RevolutionMesh:
        """The mesh of the rectangles, the ring's lines bent so that the innermost follows the groove."""
        radius = self.groove_radius or 0.0
        mesh = revolution_mesh(rectangles, self.refinement, z_near=np.linspace(-track, track, 9))
        z = np.clip(mesh.z, -track, track)
        bottom = np.sqrt(radius**2 - z**2) - math.sqrt(radius**2 - track**2)
        share = (self.r_outer - mesh.r) / (self.r_outer - self.r_inner)
        return replace(mesh, r=mesh.r + np.maximum(share, 0.0) * bottom)

    def profile(self) -> list[Profile]:
        """What the plane x = 0 shows of it; see Revolved.profile."""
        return self.body.profile()

    def round_faces(self) -> Mapping[str, tuple[RoundFace, ...]]:
        """Cylinders at its interfaces, against which an application checks the neighbours."""
        bonded = self.layer is not None
        known = {k: tuple(replace(f, bonded=bonded) for f in v) for k, v in self.body.round_faces().items()}
        half = (-0.5 * self.width, 0.5 * self.width)
        if self.layer is None and self.outside == "flexible":
            known["outside"] = (RoundFace("shaft", self.r_outer, half),)
        return known

    def superelement(self) -> Superelement:
        """Reduced matrices: interface, raceway coefficients, internal modes; see Revolved.superelement."""
        return self.body.superelement()

    def outline(self) -> Outline:
        """Its surface; see Revolved.outline."""
        return self.body.outline()
