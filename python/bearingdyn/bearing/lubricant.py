"""Lubricating oils: viscosity over temperature, and its rise with pressure."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal

from bearingdyn.bearing.pressure_viscosity import barus, roelands, roelands_exponent, wooster
from bearingdyn.checks import nonnegative, number, positive, require
from bearingdyn.pictures import page
from bearingdyn.plausible_ranges import MAGNITUDES, plausible

_ZERO_CELSIUS = 273.15
# lg lg(ν + 0.7) at 2 and at 2e7 mm²/s, between which the constant 0.7 holds (ASTM D341)
_LEAST, _MOST = (math.log10(math.log10(nu + 0.7)) for nu in (2.0 * (1 - 1e-12), 2e7 * (1 + 1e-12)))
# Kinematic viscosity at 100 °C, mm²/s, common for mineral hydraulic oils of viscosity index near 100.
# ISO 3448 fixes the 40 °C value only. VG 32 is theory's; the rest is customary and unverified.
_VG_AT_100 = {10: 2.6, 15: 3.4, 22: 4.3, 32: 5.4, 46: 6.7, 68: 8.6, 100: 11.1, 150: 14.8, 220: 19.0}


@dataclass(frozen=True)
class Walther:
    """Kinematic viscosity of a lubricant, lg lg(ν + 0.7) = A − B lg T, ν in mm²/s, T in K (ASTM D341).

    Parameters
    ----------
    A, B
        Constants of the oil, dimensionless; B > 0.

    Raises
    ------
    ValueError
        If a constant is not finite or B not positive.

    Examples
    --------
    >>> from bearingdyn.bearing import Walther
    >>> oil = Walther.iso_vg(32)
    >>> round(oil.viscosity(70.0) * 1e6, 3)  # mm²/s
    11.186
    """

    A: float
    B: float

    def __post_init__(self) -> None:
        number("A", self.A)
        positive("B", self.B, "it must be positive: oils thin with temperature")

    @classmethod
    def from_two_points(cls, T1: float, nu1: float, T2: float, nu2: float) -> Walther:
        """Oil whose kinematic viscosities are nu1 and nu2, m²/s, at the temperatures T1 < T2, °C.

        Raises
        ------
        ValueError
            Unless T1 < T2 and nu1 > nu2 ≥ 2 mm²/s, below which the law does not hold.
        """
        first, second = _kelvin("T1", T1), _kelvin("T2", T2)
        require(first < second, "T1, T2", (T1, T2), "temperatures in °C must increase")
        x, y = (
            plausible("kinematic viscosity", name, positive(name, nu)) * 1e6
            for name, nu in (("nu1", nu1), ("nu2", nu2))
        )
        require(y >= 2, "nu2", nu2, "it must be 2e-6 m²/s or more (give m²/s: 32 mm²/s is 32e-6)")
        require(x > y, "nu1, nu2", (nu1, nu2), "an oil thins with temperature: nu1 must exceed nu2")
        a, b = math.log10(math.log10(x + 0.7)), math.log10(math.log10(y + 0.7))
        B = (a - b) / (math.log10(second) - math.log10(first))
        return cls(a + B * math.log10(first), B)

    @classmethod
    def iso_vg(cls, grade: int, nu_100: float | None = None) -> Walther:
        """Oil of an ISO viscosity grade: grade, mm²/s, at 40 °C and nu_100, m²/s, at 100 °C.

        Without nu_100 a customary value for mineral oil of viscosity index near 100 is taken for grades 10 to
        220; the standard does not fix it, and the customary values are unverified: prefer the data sheet's.

        Raises
        ------
        ValueError
            For a grade outside 10..220 without nu_100.
        """
        number("grade", grade, "it must be an ISO viscosity grade, as 32")
        if nu_100 is None:
            grades = ", ".join(map(str, _VG_AT_100))
            require(
                float(grade) in _VG_AT_100,
                "grade",
                grade,
                f"it must be one of {grades} where nu_100 is not given",
            )
            nu_100 = _VG_AT_100[int(grade)] * 1e-6
        return cls.from_two_points(40.0, positive("grade", grade) * 1e-6, 100.0, nu_100)

    def viscosity(self, T: float) -> float:
        """Kinematic viscosity, m²/s, at T in °C.

        Raises
        ------
        ValueError
            Where it would lie outside 2 to 2e7 mm²/s, in which the law holds (ASTM D341).
        """
        kelvin = _kelvin("T", T)
        double_log = self.A - self.B * math.log10(kelvin)
        # lg(20 000 000.7) at one end, lg(2.7) at the other
        if not _LEAST <= double_log <= _MOST:
            limits = ", ".join(
                f"{10 ** ((self.A - y) / self.B) - _ZERO_CELSIUS:.0f}" for y in (_MOST, _LEAST)
            )
            remedy = f"outside the viscosity law of this oil (2 to 2e7 mm²/s), which holds in {limits} °C"
            remedy += MAGNITUDES["oil temperature"].guess(float(T))
            require(False, "T", T, remedy)
        return float((10 ** (10**double_log) - 0.7) * 1e-6)


@dataclass(frozen=True)
class Lubricant:
    """A lubricant: an oil, or the base oil of a grease.

    Parameters
    ----------
    kinematic
        Kinematic viscosity over temperature.
    density
        Mass density, kg/m³, taken constant. The default is that of a mineral oil at 45 °C (870 at 15 °C, less
        0.65 a degree).
    alpha
        Pressure–viscosity coefficient α, 1/Pa, taken constant; None: of a mineral oil by its viscosity
        (`pressure_coefficient`). Data sheets seldom have it, and films and damping hang on it: know it. Of a
        6205 under 1 kN on VG 32 at 60 °C and 3000 rpm, α of 1.2, 1.6, 2.0 and 2.4e-8 make the inner film
        .128, .150, .171 and .190 µm (as α^0.57) and a ball's damping 30, 34, 37 and 40 N s/m (as α^0.40).
        `Lubrication.alpha_damping` tells it of a bearing.

    Raises
    ------
    ValueError
        If density or alpha is not positive.
    """

    kinematic: Walther
    density: float = 850.0
    alpha: float | None = None

    _repr_html_ = page

    def __post_init__(self) -> None:
        require(isinstance(self.kinematic, Walther), "kinematic", self.kinematic, "give a Walther")
        positive("density", self.density, "the mass density in kg/m³ must be positive and finite")
        plausible("oil density", "density", self.density)
        if self.alpha is not None:
            remedy = "α in 1/Pa must be positive (oils: 1e-8 to 3e-8), or None: by Wooster's rule"
            plausible("pressure coefficient", "alpha", positive("alpha", self.alpha, remedy))

    def pressure_coefficient(self, T: float) -> float:
        """α, 1/Pa, at T in °C: `alpha`, or that of a mineral oil of this viscosity, falling with temperature.

        The rule is Wooster's, (0.6 + 0.965 lg η0)·1e-8 with η0 in mPa s: 1.98e-8 at 40 °C and 1.54e-8 at
        70 °C for VG 32.
        """
        return wooster(self.viscosity(T)) if self.alpha is None else self.alpha

    def viscosity(self, T: float, p: float = 0.0, law: Literal["roelands", "barus"] = "roelands") -> float:
        """Dynamic viscosity, Pa s, at T in °C and the pressure p in Pa.

        Warns
        -----
        UnusualMagnitude
            For a pressure that no contact has, or one at which Barus' law is far too high.
        """
        eta0 = self.kinematic.viscosity(T) * self.density
        require(law in ("roelands", "barus"), "law", law, 'it must be "roelands" or "barus"')
        plausible("oil pressure", "p", nonnegative("p", p))
        if p == 0:
            return eta0
        alpha = self.pressure_coefficient(T)
        if law == "barus":
            plausible("pressure by Barus", "p", p)
            return barus(eta0, alpha, p)
        return roelands(eta0, roelands_exponent(eta0, alpha), p)


def _kelvin(field: str, T: float) -> float:
    kelvin = number(field, T, "it must be a finite temperature in °C") + _ZERO_CELSIUS
    require(kelvin > 0, field, T, "it must lie above absolute zero, −273.15 °C")
    plausible("oil temperature", field, T)
    return kelvin
