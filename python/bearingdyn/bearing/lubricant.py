"""Lubricating oils (viscosity over temperature and pressure) and the film they keep between ball and race.

Temperatures in °C, as data sheets give them. The dimensionless groups are the authors' own: Hamrock & Dowson
(1977) with the mean surface speed, Nijenbanning, Venner & Moes (1994) with the sum of speeds.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal, NamedTuple

from bearingdyn.bearing.hertz import PointContact
from bearingdyn.checks import nonnegative, number, positive, require
from bearingdyn.magnitude import plausible

_ROELANDS_PRESSURE = 1.96e8  # Pa
_ROELANDS_LOG_VISCOSITY = 9.67  # −ln(6.31e-5 Pa s)
_ZERO_CELSIUS = 273.15

# lg lg(ν + 0.7) at 2 and at 2e7 mm²/s, between which the constant 0.7 holds (ASTM D341)
_LEAST, _MOST = (math.log10(math.log10(nu + 0.7)) for nu in (2.0 * (1 - 1e-12), 2e7 * (1 + 1e-12)))

# Kinematic viscosity at 100 °C, mm²/s, common for mineral hydraulic oils of viscosity index near 100.
# ISO 3448 fixes the 40 °C value only. VG 32 is theory's; the rest is customary and unverified.
_VG_AT_100 = {10: 2.6, 15: 3.4, 22: 4.3, 32: 5.4, 46: 6.7, 68: 8.6, 100: 11.1, 150: 14.8, 220: 19.0}


@dataclass(frozen=True)
class Walther:
    """Kinematic viscosity over temperature, lg lg(ν + 0.7) = A − B lg T, ν in mm²/s, T in K (ASTM D341).

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
                grade in _VG_AT_100, "grade", grade, f"it must be one of {grades} where nu_100 is not given"
            )
            nu_100 = _VG_AT_100[grade] * 1e-6
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
            require(False, "T", T, remedy)
        return float((10 ** (10**double_log) - 0.7) * 1e-6)


@dataclass(frozen=True)
class Lubricant:
    """An oil, or the base oil of a grease.

    Parameters
    ----------
    kinematic
        Kinematic viscosity over temperature.
    density
        Mass density, kg/m³, taken constant.
    alpha
        Pressure–viscosity coefficient α, 1/Pa, taken constant.

    Raises
    ------
    ValueError
        If density or alpha is not positive.
    """

    kinematic: Walther
    density: float = 870.0
    alpha: float = 2.0e-8

    def __post_init__(self) -> None:
        require(isinstance(self.kinematic, Walther), "kinematic", self.kinematic, "give a Walther")
        positive("density", self.density, "the mass density in kg/m³ must be positive and finite")
        plausible("oil density", "density", self.density)
        alpha = positive("alpha", self.alpha, "α in 1/Pa must be positive (oils: 1e-8 to 3e-8)")
        plausible("pressure coefficient", "alpha", alpha)

    def viscosity(self, T: float, p: float = 0.0, law: Literal["roelands", "barus"] = "roelands") -> float:
        """Dynamic viscosity, Pa s, at T in °C and the pressure p in Pa."""
        eta0 = self.kinematic.viscosity(T) * self.density
        require(law in ("roelands", "barus"), "law", law, 'it must be "roelands" or "barus"')
        if law == "barus":
            return barus(eta0, self.alpha, p)
        return roelands(eta0, roelands_exponent(eta0, self.alpha), p)


def barus(eta0: float, alpha: float, p: float) -> float:
    """Dynamic viscosity η0 e^{αp}, Pa s; far too high above some 0.1 GPa.

    Parameters
    ----------
    eta0
        Viscosity at ambient pressure, Pa s.
    alpha
        Pressure–viscosity coefficient, 1/Pa.
    p
        Pressure, Pa, zero or more.
    """
    return positive("eta0", eta0) * math.exp(positive("alpha", alpha) * nonnegative("p", p))


def roelands(eta0: float, z: float, p: float) -> float:
    """Dynamic viscosity η0 exp{(ln η0 + 9.67)[(1 + p/1.96e8)^z − 1]}, Pa s (C. J. A. Roelands 1966).

    Parameters
    ----------
    eta0
        Viscosity at ambient pressure, Pa s, above 6.31e-5.
    z
        Exponent, dimensionless.
    p
        Pressure, Pa, zero or more.
    """
    growth = (1 + nonnegative("p", p) / _ROELANDS_PRESSURE) ** positive("z", z) - 1
    return eta0 * math.exp(_roelands_log(eta0) * growth)


def roelands_exponent(eta0: float, alpha: float) -> float:
    """Exponent z that gives the pressure–viscosity coefficient α at p = 0: α = z (ln η0 + 9.67)/1.96e8.

    Parameters
    ----------
    eta0
        Viscosity at ambient pressure, Pa s.
    alpha
        Pressure–viscosity coefficient, 1/Pa.
    """
    return positive("alpha", alpha) * _ROELANDS_PRESSURE / _roelands_log(eta0)


class Film(NamedTuple):
    """Film thickness of one contact, m."""

    central: float
    minimum: float


def hamrock_dowson(contact: PointContact, F: float, u: float, eta0: float, alpha: float) -> Film:
    """Central and minimum film thickness, m (B. J. Hamrock, D. Dowson 1977), rolling across the minor axis.

    Parameters
    ----------
    contact
        Point contact with Rx ≤ Ry.
    F
        Load, N.
    u
        Mean surface speed ½(u1 + u2), m/s.
    eta0, alpha
        Dynamic viscosity at ambient pressure, Pa s, and pressure–viscosity coefficient, 1/Pa.

    Raises
    ------
    ValueError
        If a value is not positive, or Rx > Ry.
    """
    E, Rx = _film_scales(contact)
    U = positive("eta0", eta0) * positive("u", u, "it must be positive, in m/s") / (E * Rx)
    G = positive("alpha", alpha) * E
    W = positive("F", F, "it must be positive, in N") / (E * Rx**2)
    chi = contact.chi
    return Film(
        central=Rx * 2.69 * U**0.67 * G**0.53 * W**-0.067 * (1 - 0.61 * math.exp(-0.73 * chi)),
        minimum=Rx * 3.63 * U**0.68 * G**0.49 * W**-0.073 * (1 - math.exp(-0.68 * chi)),
    )


def nijenbanning_venner_moes(contact: PointContact, F: float, us: float, eta0: float, alpha: float) -> float:
    """Central film thickness, m (G. Nijenbanning, C. H. Venner, H. Moes 1994), rolling across the minor axis.

    As `hamrock_dowson`, but with the sum of the surface speeds us = u1 + u2, m/s; for all regimes.

    Parameters
    ----------
    contact
        Point contact with Rx ≤ Ry.
    F
        Load, N.
    us
        Sum of the surface speeds u1 + u2, m/s.
    eta0
        Dynamic viscosity at ambient pressure, Pa s.
    alpha
        Pressure–viscosity coefficient, 1/Pa.

    Raises
    ------
    ValueError
        If a value is not positive, or Rx > Ry.
    """
    E, Rx = _film_scales(contact)
    speed = positive("eta0", eta0) * positive("us", us, "it must be positive, in m/s (u1 + u2)") / (E * Rx)
    M = positive("F", F, "it must be positive, in N") / (E * Rx**2) * speed**-0.75
    L = positive("alpha", alpha) * E * speed**0.25
    return dimensionless_film(M, L, Rx / contact.Ry) * Rx * math.sqrt(speed)


def wijnant_damping(contact: PointContact, F: float, us: float, eta0: float, alpha: float) -> float:
    """Damping of one lubricated contact, N s/m, after Y. H. Wijnant (1998). UNVERIFIED.

    c = C (F/δ)(2a/us), C = r M^{−s}, r = .98 − L/60, s = .83 − .008L; δ the dry approach, a the half-width in
    rolling direction. The form was written from memory and not read again in its source; that its load number
    is the M of Nijenbanning, Venner and Moes is an assumption of this package. Values of 4 to 15 N s/m are
    quoted for it.

    Parameters
    ----------
    contact
        Point contact with Rx ≤ Ry.
    F
        Load, N.
    us
        Sum of the surface speeds u1 + u2, m/s.
    eta0
        Dynamic viscosity at ambient pressure, Pa s.
    alpha
        Pressure–viscosity coefficient, 1/Pa.

    Raises
    ------
    ValueError
        If a value is not positive, Rx > Ry, or L ≥ 58.8, where r vanishes.
    """
    E, Rx = _film_scales(contact)
    speed = positive("eta0", eta0) * positive("us", us, "it must be positive, in m/s (u1 + u2)") / (E * Rx)
    M = positive("F", F, "it must be positive, in N") / (E * Rx**2) * speed**-0.75
    L = positive("alpha", alpha) * E * speed**0.25
    require(
        L < 58.8,
        "alpha",
        alpha,
        f"it must give a lubricant number below 58.8, where the fit of the damping ends; here L is {L:.3g}",
    )
    C = (0.98 - L / 60) * M ** -(0.83 - 0.008 * L)
    return float(C * F / contact.approach(F) * 2 * contact.semi_axes(F)[1] / us)


def dimensionless_film(M: float, L: float, D: float) -> float:
    """Central film H of Nijenbanning, Venner, Moes from load M, lubricant L and radius ratio D = Rx/Ry ≤ 1.

    h = H Rx √(η0 us/(E′Rx)).

    Parameters
    ----------
    M
        Load number.
    L
        Lubricant number.
    D
        Radius ratio Rx/Ry, at most 1.

    Raises
    ------
    ValueError
        If a number is not positive or D > 1.
    """
    for name, value in (("M", M), ("L", L), ("D", D)):
        positive(name, value)
    require(D <= 1, "D", D, "it must be at most 1: rolling across the minor axis of the contact")
    phi = 1 + 0.006 * math.log(D) + 0.63 * D ** (4 / 7)
    rigid_iso = 145 * (1 + 0.796 * D ** (14 / 15)) ** (-15 / 7) / (D * M**2)
    elastic_iso = 3.18 * phi ** (-14 / 25) * D ** (-1 / 15) * M ** (-2 / 15)
    rigid_piezo = 1.29 * (1 + 0.691 * D) ** (-2 / 3) * L ** (2 / 3)
    elastic_piezo = 1.48 * phi ** (-7 / 20) * D ** (-1 / 24) * M ** (-1 / 12) * L**0.75
    flooded = 1.8 / D
    s = 1.5 * (1 + math.exp(-1.2 * elastic_iso / rigid_iso))
    iso = (rigid_iso**1.5 + (elastic_iso**-4 + flooded**-4) ** -0.375) ** (2 * s / 3)
    piezo = (rigid_piezo**-8 + elastic_piezo**-8) ** (-s / 8)
    return float((iso + piezo) ** (1 / s))


def _film_scales(contact: PointContact) -> tuple[float, float]:
    """E′ with 2/E′ = Σ(1 − ν²)/E, Pa, and Rx, m."""
    require(
        contact.Rx <= contact.Ry,
        "contact.Rx",
        contact.Rx,
        f"it must not exceed Ry, {contact.Ry!r} m: the formulas hold for rolling across the minor axis",
    )
    return 2 * contact.modulus, contact.Rx


def _roelands_log(eta0: float) -> float:
    log = math.log(positive("eta0", eta0, "it must be positive, in Pa s"))
    log += _ROELANDS_LOG_VISCOSITY
    require(log > 0, "eta0", eta0, "it must exceed 6.31e-5 Pa s for Roelands' law (give Pa s, not mPa s)")
    return log


def _kelvin(field: str, T: float) -> float:
    kelvin = number(field, T, "it must be a finite temperature in °C") + _ZERO_CELSIUS
    require(kelvin > 0, field, T, "it must lie above absolute zero, −273.15 °C")
    plausible("oil temperature", field, T)
    return kelvin
