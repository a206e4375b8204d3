"""Hertz's elliptic point contact, solved exactly.

With k² = 1/χ² the complete elliptic integrals are taken in Carlson's symmetric forms, which keep all digits
from the circle (χ = 1, where the textbook form of F(ρ) is 0/0) to very long ellipses:
F(ρ) = 1 − 2k² D/E with D = (K − E)/(1 − k²) = R_D(0, k², 1)/3 and E = 2 R_G(0, k², 1).
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import Literal

import scipy

from bearingdyn.bearing.geometry import Geometry
from bearingdyn.checks import instance, nonnegative, number, positive, require
from bearingdyn.material import Elastic


def contact_modulus(first: Elastic, second: Elastic) -> float:
    """Hertz' contact modulus E* of two elastic bodies, 1/E* = Σ(1 − ν²)/E, Pa.

    Parameters
    ----------
    first
        One body.
    second
        The other body.
    """
    instance("first", first, Elastic, "give a material.Elastic, such as STEEL")
    instance("second", second, Elastic, "give a material.Elastic, such as STEEL")
    return 1 / ((1 - first.nu**2) / first.E + (1 - second.nu**2) / second.E)


def resultant_deflection_coefficient(*kappa: float) -> float:
    """Hertz contacts in series, κ_res = (Σ κ^{−2/3})^{−3/2}, N/m^1.5 (paper eq. 2).

    Parameters
    ----------
    *kappa
        Deflection coefficient of each contact, N/m^1.5.

    Raises
    ------
    ValueError
        Unless every κ is positive and finite.
    """
    require(len(kappa) > 0, "kappa", kappa, "give at least one deflection coefficient")
    return math.pow(math.fsum(math.pow(positive("kappa", k), -2 / 3) for k in kappa), -1.5)


def ellipticity(F: float) -> float:
    """Hertz' ellipticity χ = a/b ≥ 1 of the contact from the curvature difference F(ρ), 0 ≤ F < 1.

    Parameters
    ----------
    F
        Curvature difference F(ρ), 0 ≤ F < 1.

    Raises
    ------
    ValueError
        If F is outside [0, 1).

    References
    ----------
    Harris, Rolling Bearing Analysis, F(ρ) = [(χ²+1)E − 2K]/[(χ²−1)E].
    """
    value = number("F", F, "it must satisfy 0 <= F < 1")
    require(0 <= value < 1, "F", F, "it must satisfy 0 <= F < 1")
    return _ellipticity(1 - value)


def _ellipticity(complement: float) -> float:
    """χ from 1 − F(ρ) in (0, 1]: monotone in ln χ, so a bracketing root finder cannot fail."""
    if complement >= 1:
        return 1.0

    def excess(t: float) -> float:
        k2 = math.exp(-2 * t)
        return math.log(
            k2 * float(scipy.special.elliprd(0, k2, 1)) / (3 * float(scipy.special.elliprg(0, k2, 1)))
        ) - math.log(complement)

    # 1 − F → 2 ln(4χ)/χ² for long ellipses, hence ln χ < 1 − ln(1 − F) always
    upper = 1 - math.log(complement)
    if excess(0.0) <= 0:
        return 1.0
    return math.exp(scipy.optimize.brentq(excess, 0.0, upper, xtol=1e-15, rtol=1e-15))


@dataclass(frozen=True)
class PointContact:
    """Hertz' point contact of two elastic bodies.

    Parameters
    ----------
    Rx
        Effective radius in the rolling direction (1/Rx is the sum of the bodies' curvatures there), m.
    Ry
        Effective radius across the rolling direction, m.
    modulus
        Contact modulus E*, 1/E* = Σ(1 − ν²)/E, Pa.

    Raises
    ------
    ValueError
        If a radius or the modulus is not positive and finite.
    """

    Rx: float
    Ry: float
    modulus: float

    def __post_init__(self) -> None:
        positive("Rx", self.Rx, "it must be positive and finite, in m")
        positive("Ry", self.Ry, "it must be positive and finite, in m")
        positive("modulus", self.modulus, "it must be positive and finite, in Pa")

    @property
    def sum_rho(self) -> float:
        """Curvature sum Σρ = 1/Rx + 1/Ry, 1/m."""
        return 1 / self.Rx + 1 / self.Ry

    @property
    def F_rho(self) -> float:
        """Curvature difference |1/Rx − 1/Ry|/Σρ."""
        return abs(1 / self.Rx - 1 / self.Ry) / self.sum_rho

    @cached_property
    def chi(self) -> float:
        """Ellipticity a/b ≥ 1; a lies along the direction of the larger effective radius."""
        return _ellipticity(2 / max(self.Rx, self.Ry) / self.sum_rho)

    @cached_property
    def _K(self) -> float:
        return float(scipy.special.elliprf(0, self.chi**-2, 1))

    @cached_property
    def _E(self) -> float:
        return 2 * float(scipy.special.elliprg(0, self.chi**-2, 1))

    @property
    def a_star(self) -> float:
        """Dimensionless major semi-axis a* = (2χ²E/π)^⅓."""
        return float((2 * self.chi**2 * self._E / math.pi) ** (1 / 3))

    @property
    def b_star(self) -> float:
        """Dimensionless minor semi-axis b* = (2E/πχ)^⅓."""
        return float((2 * self._E / (math.pi * self.chi)) ** (1 / 3))

    @property
    def delta_star(self) -> float:
        """Dimensionless approach δ* = (2K/π)(π/2χ²E)^⅓."""
        return float(2 * self._K / math.pi * (math.pi / (2 * self.chi**2 * self._E)) ** (1 / 3))

    @cached_property
    def kappa(self) -> float:
        """Deflection coefficient of Q = κ δ^{3/2}: (2Σρ E*/3)(2/(δ*Σρ))^{3/2}, N/m^1.5."""
        return 2 * self.sum_rho * self.modulus / 3 * float((2 / (self.delta_star * self.sum_rho)) ** 1.5)

    def semi_axes(self, Q: float) -> tuple[float, float]:
        """Semi-axes (a, b), a ≥ b, of the contact ellipse under the load Q ≥ 0 in N, m."""
        load = nonnegative("Q", Q, "it must be zero or positive, in N")
        scale = (3 * load / (2 * self.sum_rho * self.modulus)) ** (1 / 3)
        return self.a_star * scale, self.b_star * scale

    def pressure(self, Q: float) -> float:
        """Largest contact pressure 3Q/2πab under the load Q ≥ 0 in N, Pa."""
        a, b = self.semi_axes(Q)
        return 1.5 * Q / (math.pi * a * b) if Q > 0 else 0.0

    def approach(self, Q: float) -> float:
        """Approach δ = (Q/κ)^{2/3} of the bodies under the load Q ≥ 0 in N, m."""
        load = nonnegative("Q", Q, "it must be zero or positive, in N")
        return math.pow(load / self.kappa, 2 / 3)

    def load_at_pressure(self, p: float) -> float:
        """Contact load at which the largest pressure reaches p > 0 in Pa, N."""
        peak = positive("p", p, "it must be positive and finite, in Pa")
        return (peak / self.pressure(1.0)) ** 3


def race_contact(
    geometry: Geometry, race: Literal["inner", "outer"], ring: Elastic, ball: Elastic
) -> PointContact:
    """Hertz' contact of a ball with a race: Rx = (D/2)(1 ∓ γ) (inner −, outer +), Ry = f D/(2f − 1).

    Parameters
    ----------
    geometry
        Balls and grooves.
    race
        "inner" or "outer".
    ring
        Material of the ring.
    ball
        Material of the balls.

    Raises
    ------
    ValueError
        If `race` is neither "inner" nor "outer".
    """
    require(race in ("inner", "outer"), "race", race, 'it must be "inner" or "outer"')
    f, sign = (geometry.fi, -1.0) if race == "inner" else (geometry.fo, 1.0)
    return PointContact(
        Rx=geometry.Dw / 2 * (1 + sign * geometry.gamma),
        Ry=f * geometry.Dw / (2 * f - 1),
        modulus=contact_modulus(ring, ball),
    )
