"""Two tones through rubber that softens: the pairs that are tried, and what a march is held against."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

import bearingdyn as bd

# two forces (N, Hz), and the periods of the slower that are read, of 240
PAIRS = (
    ([(6.0, 150.0), (6.0, 230.0)], 45),
    # on both flanks, where .1 % of stiffness is .2 % of motion
    ([(6.0, 200.0), (6.0, 320.0)], 40),
    ([(40.0, 100.0), (40.0, 160.0)], 40),
    ([(20.0, 330.0), (20.0, 400.0)], 66),
    ([(6.0, 230.0), (6.0, 260.0)], 46),
    # one of them far stronger
    ([(30.0, 200.0), (10.0, 300.0)], 40),
    ([(3.0, 240.0), (12.0, 280.0)], 48),
    ([(1.0, 260.0), (1.0, 390.0)], 48),
)


def inertia_of_a_step(hz: float, dt: float) -> float:
    """What the average acceleration makes of inertia in a vibration, over a march without a step.

    x'' of samples x e^(iωnΔt) is −(2/Δt tan ωΔt/2)² x instead of −ω² x; rubber's own error is far smaller.
    """
    half = np.pi * hz * dt
    return float((np.tan(half) / half) ** 2)


@dataclass(frozen=True)
class AtOneAmplitude:
    """A rubber with a law as it is met at a strain, in a vibration of this mean frequency, rad/s."""

    rubber: bd.Maxwell
    strain: float
    mean: float

    @classmethod
    def of(cls, rubber: bd.Maxwell, strain: float, hertz: list[float], motion: NDArray) -> AtOneAmplitude:
        """The mean frequency is that of tones of these motions."""
        squares, omega = np.abs(motion) ** 2, 2 * np.pi * np.array(hertz)
        return cls(rubber, strain, float(np.sqrt((squares * omega**2).sum() / squares.sum())))

    @property
    def K(self) -> float:
        """Bulk modulus, Pa."""
        return self.rubber.K

    @property
    def density(self) -> float:
        """kg/m³."""
        return self.rubber.density

    def complex_modulus(self, omega: NDArray[np.float64]) -> NDArray[np.complex128]:
        """G*, Pa."""
        return self.rubber.modulus_at(omega, self.strain, self.mean)
