"""A flexible housing: a block, or a tall pedestal, with a bore for a bearing."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np

from bearingdyn.checks import instance, named, nonnegative, positive, vector
from bearingdyn.cms import F_MAX, RoundFace, Superelement, check_damping, check_f_max
from bearingdyn.fem import block_with_bore
from bearingdyn.material import STEEL, Elastic
from bearingdyn.parts.outline import Outline
from bearingdyn.parts.profile import Profile, rectangle
from bearingdyn.parts.solid import RigidSurface, Solid
from bearingdyn.pictures import page
from bearingdyn.plausible_ranges import plausible
from bearingdyn.short_repr import short
from bearingdyn.units import takes

ELEMENTS = 300  # aimed at by the default element size: 4000 to 10000 coordinates, a second or so


@takes(width="m", height="m")
@dataclass(frozen=True)
class Feet:
    """The feet of a housing, on which it stands: two strips along z.

    Parameters
    ----------
    width
        Extent of each strip along x, m.
    height
        0: the strips are the left and right edges of the block's own base. Otherwise the height, m, of two
        flanges added to the sides of the block at its base; the strips are their undersides.

    Raises
    ------
    ValueError
        For a width that is not positive or a height below zero.
    """

    width: float
    height: float = 0.0

    def __post_init__(self) -> None:
        positive("Feet width", self.width, "it must be a positive width in m")
        nonnegative("Feet height", self.height, "it must be 0 or a height in m")


@takes(
    width="m",
    height="m",
    length="m",
    bore_diameter="m",
    bore_height="m",
    f_max="Hz",
    points="m",
    element_size="m",
)
@dataclass(frozen=True)
class Housing:
    """A housing: a block with a round bore through it along z, of three-dimensional finite elements.

    Two rigid interfaces: "bore", whose reference lies on the axis at mid-length, and "feet", whose reference
    lies below it on the base. Outputs: "top", the middle of the top face, and the points; rows (3, n).
    Surfaces: "top", "front" (at +z), "back", and "outside", all but the bore and the base.

    Parameters
    ----------
    width, height, length
        Extent along x, y and z, m; a small length makes a plate-like pedestal.
    bore_diameter
        Diameter of the bore, m.
    bore_height
        Height of the bore's axis above the base, m; None: mid-height.
    material
        Elastic material of the block.
    damping
        Ratio ζ of every mode of the housing held at its feet.
    feet
        What is held at the base: None, the whole of it, or two strips (Feet).
    f_max
        Modes with the interfaces held are kept up to this frequency, Hz; 0: none; by default 20 kHz.
    points
        name -> (x, y, z), m, from the bore's axis at mid-length: further outputs, at the nearest node.
    element_size
        Longest wanted side of an element, m; None: some 300 elements, more where the shape needs them.

    Raises
    ------
    ValueError
        For a bore that leaves no wall, a point outside, values that are not positive and finite, or a length
        above 10 m: it is then in mm.

    References
    ----------
    Paper section 4, which gives no dimensions.
    """

    width: float
    height: float
    length: float
    bore_diameter: float
    bore_height: float | None = None
    material: Elastic = STEEL
    damping: float = 0.0
    feet: Feet | None = None
    f_max: float = F_MAX
    points: Mapping[str, tuple[float, float, float]] = field(default_factory=dict)
    element_size: float | None = None

    __repr__ = short
    _repr_html_ = page

    def __post_init__(self) -> None:
        for name in ("width", "height", "length", "bore_diameter"):
            plausible(
                "length", name, positive(name, getattr(self, name), "it must be a positive length in m")
            )
        instance(
            "material", self.material, Elastic, "it must be a bd.Elastic(E, nu, density), such as bd.STEEL"
        )
        if self.feet is not None:
            instance("feet", self.feet, Feet, "it must be bd.Feet(width, height), or None for the whole base")
        for name in ("bore_height", "element_size"):
            if getattr(self, name) is not None:
                positive(name, getattr(self, name), "it must be a positive length in m")
        for name, at in named("points", self.points, "it must be a dict, name -> (x, y, z) in m").items():
            vector(f"points[{name!r}]", at, (3,), "x, y and z in m")
        check_f_max(self.f_max)
        check_damping(self.damping)
        d, axis = self.bore_diameter, self.axis
        if not math.isfinite(axis):
            raise ValueError(f"bore_height is {self.bore_height}; it must be a height in m")
        wall = 0.02 * d
        if not d <= self.width - 2 * wall:
            raise ValueError(f"bore_diameter is {d} m; it must leave a wall in a width of {self.width} m")
        if not 0.5 * d + wall <= axis <= self.height - 0.5 * d - wall:
            raise ValueError(
                f"bore_height is {axis} m; for a wall above and below the bore it must lie in "
                f"{0.5 * d + wall:.6g} to {self.height - 0.5 * d - wall:.6g} m"
            )
        if self.feet is not None:
            if self.feet.height == 0 and not self.feet.width < 0.5 * self.width:
                raise ValueError(f"feet.width is {self.feet.width} m; two must fit in {self.width} m")
            if not self.feet.height < self.height:
                raise ValueError(f"feet.height is {self.feet.height} m; it must be below {self.height} m")
        size = self.element_size
        if size is not None and size > max(self.width, self.height, self.length):
            raise ValueError(
                f"element_size is {size} m; it must not exceed the housing, "
                f"{self.width:g} × {self.height:g} × {self.length:g} m; is it in mm?"
            )
        if size is not None and not (size >= 0.01 * self.height and math.isfinite(size)):
            raise ValueError(f"element_size is {size}; it must be {0.01 * self.height:.3g} m or more")
        flange = self.feet.width if self.feet is not None and self.feet.height > 0 else 0.0
        reach = np.array([[0.5 * self.width + flange, self.height - axis, 0.5 * self.length]])
        for name, point in self.points.items():
            if name in ("bore", "feet", "top"):
                raise ValueError(f"points has {name!r}, a name the housing uses itself; choose another")
            p = np.asarray(point, dtype=np.float64)
            low = np.array([-reach[0, 0], -axis, -reach[0, 2]])
            if p.shape != (3,) or not np.all((p >= low - 1e-9) & (p <= reach[0] + 1e-9)):
                raise ValueError(
                    f"points[{name!r}] is {point!r}; it must be (x, y, z) in the block, "
                    f"from {low.tolist()} to {reach[0].tolist()} m"
                )
            if math.hypot(p[0], p[1]) < 0.5 * d * (1.0 - 1e-9):
                raise ValueError(f"points[{name!r}] is {point!r}, in the bore; it must be in the material")

    @property
    def axis(self) -> float:
        """Height of the bore's axis above the base, m."""
        return 0.5 * self.height if self.bore_height is None else self.bore_height

    def superelement(self) -> Superelement:
        """The housing reduced onto its bore and feet and the fixed-interface modes up to f_max."""
        return replace(self.body.superelement(), faces=self.round_faces())

    def outline(self) -> Outline:
        """Its surface; see Solid.outline."""
        return self.body.outline()

    def profile(self) -> list[Profile]:
        """What the plane x = 0 shows of it: the walls above and below the bore."""
        z, r = (-0.5 * self.length, 0.5 * self.length), 0.5 * self.bore_diameter
        walls = ((r, self.height - self.axis), (-self.axis, -r))
        return [Profile(rectangle(z, wall), "metal") for wall in walls]

    def round_faces(self) -> Mapping[str, tuple[RoundFace, ...]]:
        """Cylinders at its interfaces, against which an application checks the neighbours."""
        half = 0.5 * self.length
        return {"bore": (RoundFace("bore", 0.5 * self.bore_diameter, (-half, half)),)}

    @cached_property
    def body(self) -> Solid:
        """The housing as a solid; its mesh names the surfaces (fem.block_with_bore)."""
        volume = (self.width * self.height - 0.25 * math.pi * self.bore_diameter**2) * self.length
        feet = self.feet
        flanged = feet is not None and feet.height > 0
        mesh = block_with_bore(
            self.width,
            self.height,
            self.length,
            self.bore_diameter,
            self.axis,
            self.element_size or (volume / ELEMENTS) ** (1.0 / 3.0),
            flange=(feet.width, feet.height) if feet is not None and flanged else None,
            strip=feet.width if feet is not None and not flanged else None,
        )
        return Solid(
            mesh,
            self.material,
            {
                "bore": RigidSurface("bore", (0.0, 0.0, 0.0)),
                "feet": RigidSurface("feet", (0.0, -self.axis, 0.0)),
            },
            self.f_max,
            {"top": (0.0, self.height - self.axis, 0.0), **self.points},
            damping=self.damping,
            held="feet",
            attach=("top", *self.points),
            radiating=("outside", "top", "front", "back"),
        )
