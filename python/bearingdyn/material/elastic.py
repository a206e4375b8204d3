"""Linear elastic, isotropic materials."""

from __future__ import annotations

from dataclasses import dataclass

from bearingdyn.checks import number, positive
from bearingdyn.pictures import picture
from bearingdyn.plausible_ranges import check_density, check_waves, plausible
from bearingdyn.units import takes


@takes(E="Pa", density="kg/m³")
@dataclass(frozen=True)
class Elastic:
    """Linear elastic, isotropic material.

    Parameters
    ----------
    E
        Young's modulus, Pa, at least 1e4.
    nu
        Poisson's ratio, −1 < nu < 0.5.
    density
        Mass density, kg/m³, 10 to 30000; 1e-4 to 0.1 stand for a body without inertia.

    Raises
    ------
    ValueError
        If a value is outside its range or not finite.

    Examples
    --------
    >>> import bearingdyn as bd
    >>> rubber = bd.Elastic(E=3e6, nu=0.4995, density=1150.0)
    >>> round(rubber.G / 1e6, 4), round(rubber.K / 1e9, 2)
    (1.0003, 1.0)
    """

    E: float
    nu: float
    density: float

    def _repr_html_(self) -> str:
        return str(picture("as_html", self))

    def __post_init__(self) -> None:
        positive("Elastic.E", self.E, "Young's modulus must be positive and finite, Pa")
        plausible("Young's modulus", "Elastic.E", self.E)
        if not -1 < number("Elastic.nu", self.nu, "Poisson's ratio must lie between -1 and 0.5") < 0.5:
            raise ValueError(
                f"Elastic.nu is {self.nu!r}; Poisson's ratio must lie strictly between -1 and 0.5 "
                "(for a nearly incompressible material take 0.4999, or Maxwell with a bulk modulus)"
            )
        positive("Elastic.density", self.density, "it must be positive and finite, kg/m³")
        check_density("Elastic.density", self.density)
        check_waves("Elastic.E", self.E, self.density)

    @property
    def G(self) -> float:
        """Shear modulus E/2(1+ν), Pa."""
        return self.E / (2 * (1 + self.nu))

    @property
    def K(self) -> float:
        """Bulk modulus E/3(1−2ν), Pa."""
        return self.E / (3 * (1 - 2 * self.nu))


STEEL = Elastic(E=210e9, nu=0.3, density=7850.0)
"""Bearing and structural steel: 210 GPa, 0.3, 7850 kg/m³."""
