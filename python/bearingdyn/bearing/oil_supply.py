"""What a bearing is lubricated with, and how it runs: what its films and damping need but the load."""

from __future__ import annotations

from dataclasses import dataclass

from bearingdyn.bearing.lubricant import Lubricant
from bearingdyn.checks import positive, require
from bearingdyn.plausible_ranges import plausible


@dataclass(frozen=True)
class OilSupply:
    """Oil supplied to a running bearing: as its `lubrication`, film and damping follow from the equilibrium.

    Parameters
    ----------
    lubricant, temperature
        Oil, or base oil of a grease, and its temperature at the inlet of the contacts, °C.
    speed
        Of the shaft, rad/s, not zero; it may differ from the speed of a march, whose films then stay those of
        this speed.
    starvation
        Film over fully flooded film, in 0..1.

    Raises
    ------
    ValueError
        Naming the field: a value out of range, a temperature outside the oil's viscosity law.
    """

    lubricant: Lubricant
    temperature: float
    speed: float
    starvation: float = 1.0

    def __post_init__(self) -> None:
        require(isinstance(self.lubricant, Lubricant), "lubricant", self.lubricant, "give a Lubricant")
        omega = plausible("speed", "speed", self.speed, "it must be a finite speed in rad/s")
        object.__setattr__(self, "speed", float(omega))
        require(omega != 0, "speed", self.speed, "it must not be zero: without speed there is no film")
        share = positive("starvation", self.starvation)
        object.__setattr__(self, "starvation", share)
        require(share <= 1, "starvation", self.starvation, "it must be at most 1, fully flooded")
        self.lubricant.viscosity(self.temperature)
