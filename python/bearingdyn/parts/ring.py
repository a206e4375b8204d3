"""The elastic ring of rectangular section."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from functools import cached_property

from bearingdyn.checks import positive
from bearingdyn.cms import RoundFace, Superelement
from bearingdyn.material import STEEL, Elastic
from bearingdyn.parts.outline import Outline
from bearingdyn.parts.profile import Profile
from bearingdyn.parts.regions import Region
from bearingdyn.parts.revolved import Revolved
from bearingdyn.parts.revolved_faces import Cylinder
from bearingdyn.parts.revolved_modes import RevolvedModes
from bearingdyn.pictures import page
from bearingdyn.plausible_ranges import plausible
from bearingdyn.units import takes


@takes(r_inner="m", r_outer="m", width="m", f_max="Hz")
@dataclass(frozen=True)
class Ring:
    """An elastic ring of rectangular section, not turning; its faces "inner" and "outer" are rigid.

    Parameters
    ----------
    r_inner, r_outer, width
        m. The reference point of both faces lies on the axis at mid-width.
    material
        Elastic material.
    damping
        Ratio ζ of its free elastic modes.
    f_max
        Modes with the interfaces held are kept up to this frequency, Hz; 0: none, the default of bodies of
        revolution.
    refinement
        Mesh density; 1 is the default.

    Raises
    ------
    ValueError
        For dimensions that are not positive, r_outer not above r_inner, or more than 10 m (given in mm).
    """

    r_inner: float
    r_outer: float
    width: float
    material: Elastic = STEEL
    damping: float = 0.0
    f_max: float = 0.0
    refinement: float = 1.0

    _repr_html_ = page

    def __post_init__(self) -> None:
        positive("r_inner", self.r_inner, "it must be a positive radius in m")
        positive("r_outer", self.r_outer, "it must be a positive radius in m")
        if not self.r_outer > self.r_inner:
            raise ValueError(f"r_outer is {self.r_outer}; it must exceed r_inner = {self.r_inner} m")
        positive("width", self.width, "it must be a positive length in m")
        positive("refinement", self.refinement, "it must be a positive mesh density, 1 by default")
        for name in ("r_outer", "width"):
            plausible("length", name, getattr(self, name))
        _ = self.body

    @cached_property
    def body(self) -> Revolved:
        """The ring as a body of revolution."""
        return Revolved(
            (Region((self.r_inner, self.r_outer), (-0.5 * self.width, 0.5 * self.width), self.material),),
            {"inner": Cylinder(self.r_inner), "outer": Cylinder(self.r_outer)},
            damping=self.damping,
            f_max=self.f_max,
            refinement=self.refinement,
        )

    def superelement(self) -> Superelement:
        """Reduced matrices with both faces rigid."""
        return self.body.superelement()

    def outline(self) -> Outline:
        """Its surface; see Revolved.outline."""
        return self.body.outline()

    def profile(self) -> list[Profile]:
        """What the plane x = 0 shows of it; see Revolved.profile."""
        return self.body.profile()

    def round_faces(self) -> Mapping[str, tuple[RoundFace, ...]]:
        """Cylinders at its interfaces, against which an application checks the neighbours."""
        return self.body.round_faces()

    def modes(self, order: int, count: int, fixed: Iterable[str] = ()) -> RevolvedModes:
        """Lowest modes of one Fourier order with its faces free (elastic), or some of them held still."""
        return self.body.modes(order, count, fixed=fixed)
