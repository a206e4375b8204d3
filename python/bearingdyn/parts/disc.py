"""Rigid discs on a shaft."""

from __future__ import annotations

from dataclasses import dataclass

from bearingdyn.checks import instance, nonnegative, number, positive
from bearingdyn.fem import Section
from bearingdyn.material import STEEL, Elastic
from bearingdyn.pictures import page
from bearingdyn.plausible_ranges import check_gyration, plausible
from bearingdyn.units import takes


@takes(z="m", mass="kg", Id="kg m²", Ip="kg m²")
@dataclass(frozen=True)
class Disc:
    """A rigid disc on a shaft.

    Parameters
    ----------
    z
        Position along the shaft, m.
    mass
        kg.
    Id, Ip
        Diametral and polar moment of inertia, kg m².

    Raises
    ------
    ValueError
        For a mass or moment that is not positive, or that no disc can have.
    """

    z: float
    mass: float
    Id: float
    Ip: float

    _repr_html_ = page

    def __post_init__(self) -> None:
        if abs(number("Disc z", self.z, "it must be a position in m")) > 1.0:
            plausible("shaft length", "Disc z", self.z)
        plausible("mass", "Disc mass", positive("Disc mass", self.mass, "it must be a positive mass in kg"))
        nonnegative("Disc Id", self.Id, "it must be a moment in kg m², not negative")
        nonnegative("Disc Ip", self.Ip, "it must be a moment in kg m², not negative")
        if not self.Ip <= 2.0 * self.Id * (1.0 + 1e-9):
            raise ValueError(f"Disc Ip is {self.Ip}; no disc has Ip above 2 Id = {2.0 * self.Id} kg m²")
        check_gyration("Disc Id", self.Id, self.mass)

    @classmethod
    @takes(z="m", d_outer="m", width="m", d_inner="m")
    def cylinder(
        cls, z: float, d_outer: float, width: float, d_inner: float = 0.0, material: Elastic = STEEL
    ) -> Disc:
        """A cylinder centred at z with the shaft's diameter d_inner left out; lengths in m.

        Raises
        ------
        ValueError
            For measures that make no cylinder.
        """
        instance("material", material, Elastic, "it must be a bd.Elastic(E, nu, density), such as bd.STEEL")
        body = Section(width, d_outer, d_inner)
        mass = material.density * body.area * width
        square = d_outer**2 + d_inner**2
        return cls(z, mass, mass * (square / 16.0 + width**2 / 12.0), mass * square / 8.0)
