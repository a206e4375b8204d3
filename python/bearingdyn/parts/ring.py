"""Ready forms of bodies of revolution: the rectangular ring, and the damping sample of three rings."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from functools import cached_property

from bearingdyn.checks import positive
from bearingdyn.cms import Superelement
from bearingdyn.magnitude import check_length
from bearingdyn.material import STEEL, Elastic
from bearingdyn.parts.faces import Cylinder
from bearingdyn.parts.outline import Outline
from bearingdyn.parts.regions import Region, ViscoelasticSolid
from bearingdyn.parts.revolved import Revolved, RevolvedModes


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

    def __post_init__(self) -> None:
        positive("r_inner", self.r_inner, "it must be a positive radius in m")
        if not self.r_outer > self.r_inner:
            raise ValueError(f"r_outer is {self.r_outer}; it must exceed r_inner = {self.r_inner} m")
        positive("width", self.width, "it must be a positive length in m")
        for name in ("r_outer", "width"):
            check_length(name, getattr(self, name))
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

    def modes(self, order: int, count: int, fixed: Iterable[str] = ()) -> RevolvedModes:
        """Lowest modes of one Fourier order with its faces free (elastic), or some of them held still."""
        return self.body.modes(order, count, fixed=fixed)


def damping_sample(
    material: Elastic | ViscoelasticSolid,
    radii: tuple[float, float, float, float] = (0.015, 0.0175, 0.020, 0.026),
    width: float = 0.011,
    metal: Elastic = STEEL,
    damping: float = 0.0,
    f_max: float = 0.0,
    refinement: float = 1.0,
) -> Revolved:
    """Two concentric metal rings with a layer bonded between them, the paper's sample (figure 3); SI units.

    Parameters
    ----------
    radii
        Bore, inner bond, outer bond, outside. Interfaces "inner" (the bore) and "outer" (the outside) are
        rigid.

    Raises
    ------
    ValueError
        For radii that do not rise.

    References
    ----------
    Paper section 3.4.

    Examples
    --------
    >>> import bearingdyn as bd
    >>> sample = bd.damping_sample(bd.Elastic(2.98e6, 0.49, 1200.0))  # G = 1 MPa
    >>> [round(float(f)) for f in sample.modes(0, 4).frequency[2:]]  # axial, torsion, Hz
    [840, 925]
    """
    half = (-0.5 * width, 0.5 * width)
    a, b, c, d = radii
    return Revolved(
        (
            Region((a, b), half, metal),
            Region((b, c), half, material, graded=True),
            Region((c, d), half, metal),
        ),
        {"inner": Cylinder(a), "outer": Cylinder(d)},
        damping=damping,
        f_max=f_max,
        refinement=refinement,
    )
