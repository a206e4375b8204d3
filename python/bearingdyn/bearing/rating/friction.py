"""Friction of a bearing by two named models, and the power it turns into heat.

"palmgren": a moment of the oil and one of the load (A. Palmgren; Harris' form). For usual loads (P0/C0 up to
some .5) and speeds up to the bearing's rated one; within a factor of 1.5. The form of M0, 160e-7 f0 dm³ below
νn = 2000, was read in a public program that cites it (axle box bearings, Vehicle System Dynamics 58, 2019).
f0 were read in Thermca (thermca/lib/bearing.py, after its [Jun10]): oil bath 2 of deep groove and 3.3 of
angular contact, half of it in oil and air, twice in an oil jet; grease 1 and 2 (2 of both in another program;
this one takes 2). Its f1, given for a tenth of C, are .00022 and .00046; here .00029 (6205) and .00054
(7205B). UNVERIFIED: the exponents .55 and .33 of f1, and its factors, .0006 to .0009 by the series (here
.00075 for all).

"four-term": rolling, sliding, seals and drag, as SKF's catalogues have it since 2003. For the minimum load or
more, a constant load, normal clearance in operation, κ from .1; its constants are by series. The forms of
its variables were read in the catalogue of 2013 (https://www.yumpu.com/en/document/view/55668573/skf-rolling-bearings/106,
μ on page 105). Compared with a table of SKF's constants in a public program of others: all four constants of
all seven series of deep groove bearings below, their K_Z of 3.1 and both K_rs agree; a second one has K_Z of
4.4 for angular contact, and the same variables. UNVERIFIED: the constants of 40° bearings (_STEEP and
_STEEP_CENTRIFUGAL) are from memory: no table of them was found. The first program takes a μ_bl of .12 in
motion instead of .15.

What another maker prints holds both: Koyo's friction coefficients, M = μPd/2, are .0010 to .0015 of deep
groove and .0012 to .0020 of angular contact bearings (www.koyousa.com/koyocatalog/technical/05/5_5main.htm).
At a tenth of C, 20 mm²/s and 3000 rpm, a full film, "palmgren" gives .0019 and .0026 with grease (.0032 in an
oil bath), "four-term" .0016 and .0029. In thin oil, κ well below 1, "four-term" of 40° gives up to .0058, as
its sliding goes with μ_bl.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal, NamedTuple

from bearingdyn.bearing.rating.iso_ratings import radial_and_axial, warn_of_overload
from bearingdyn.checks import nonnegative, one_of, positive, require
from bearingdyn.plausible_ranges import check_speed_value, plausible

FrictionModel = Literal["palmgren", "four-term"]
Supply = Literal["oil mist", "oil bath", "oil jet", "grease"]


class _Constants(NamedTuple):
    """R1, R2 of the rolling and S1, S2 of the sliding variable."""

    R1: float
    R2: float
    S1: float
    S2: float


# deep groove bearings, by series
_DEEP = {
    "62": _Constants(3.9e-7, 1.7, 3.23e-3, 36.5),
    "63": _Constants(3.7e-7, 1.7, 2.84e-3, 92.8),
    "64": _Constants(3.6e-7, 1.7, 2.43e-3, 198.0),
    "60": _Constants(4.1e-7, 1.7, 3.73e-3, 14.6),
    "160": _Constants(4.3e-7, 1.7, 4.63e-3, 4.25),
    "618": _Constants(4.7e-7, 1.7, 6.50e-3, 0.78),
    "619": _Constants(4.3e-7, 1.7, 4.75e-3, 3.6),
}
_ANGULAR = ("70", "72", "73")
# single row angular contact bearings of 40°; the third are of the load by centrifugal forces, R3 and S3
_STEEP = _Constants(5.03e-7, 1.97, 1.30e-2, 0.68)
_STEEP_CENTRIFUGAL = (1.90e-12, 1.91e-12)
_ANGULAR_FROM = 5.0  # °, of the nominal contact angle: angular contact from here
_CROWDING = {"deep": 3.1, "angular": 4.4}  # K_Z
_BOUNDARY, _FULL_FILM = 0.15, 0.05  # μ_bl, "generally"; μ_EHL of mineral oil (catalogue of 2013, page 105)

# Palmgren's f0: of deep groove, of single row angular contact bearings
_SUPPLY = {"oil mist": (1.0, 1.65), "oil bath": (2.0, 3.3), "oil jet": (4.0, 6.6), "grease": (2.0, 2.0)}
_STARVING = {"oil mist": 6e-8, "grease": 6e-8, "oil bath": 3e-8, "oil jet": 3e-8}  # K_rs


@dataclass(frozen=True)
class Friction:
    """Frictional moment of a bearing, N m, by where it comes from, and its power."""

    model: str
    rolling: float
    """Rolling in the oil; of Palmgren's the moment without load."""
    sliding: float
    """Sliding in the contacts; of Palmgren's the moment of the load."""
    seals: float
    drag: float
    speed: float
    """Of one ring against the other, rad/s."""

    @property
    def moment(self) -> float:
        """All together, N m."""
        return self.rolling + self.sliding + self.seals + self.drag

    @property
    def power(self) -> float:
        """Turned into heat, W."""
        return self.moment * abs(self.speed)

    def __repr__(self) -> str:
        """One line: the moment, its parts and the power."""
        parts = ", ".join(
            f"{name} {1e3 * value:.3g}"
            for name in ("rolling", "sliding", "seals", "drag")
            if (value := getattr(self, name))
        )
        return f"<Friction {self.model}: {1e3 * self.moment:.4g} N mm ({parts}), {self.power:.4g} W>"


def friction(
    model: FrictionModel = "palmgren",
    *,
    radial: float,
    axial: float,
    speed: float,
    viscosity: float,
    bore: float,
    outside: float,
    C0: float,
    contact_angle: float = 0.0,
    series: str = "62",
    supply: Supply = "oil bath",
    seals: float = 0.0,
    drag_factor: float = 0.0,
) -> Friction:
    """Frictional moment and power of a ball bearing.

    Parameters
    ----------
    model
        "palmgren" or "four-term"; their ranges are above.
    radial, axial
        Fr and Fa, N, zero or more.
    speed
        Of one ring against the other, rad/s.
    viscosity
        Kinematic, of the oil (or the grease's base oil) as it is in the bearing, m²/s.
    bore, outside
        m.
    C0
        Static rating, N.
    contact_angle
        Nominal, rad; the four-term model has constants of 0 and near 40°.
    series
        "60", "62", "63", "64", "160", "618" or "619": the four-term model's constants go by it.
    supply
        How the oil comes.
    seals
        Moment of contact seals, N m.
    drag_factor
        V_M of the four-term model, read off the maker's diagram by the oil level; 0: no oil bath to churn.

    Raises
    ------
    ValueError
        Naming what is out of range.

    Warns
    -----
    UnusualMagnitude
        For sizes, loads, a rating or a speed that no bearing of this size has.
    BearingWarning
        For a load above the static rating.

    Examples
    --------
    >>> from bearingdyn.bearing.rating import friction
    >>> size = {"bore": 0.025, "outside": 0.052, "C0": 7850.0}
    >>> friction("palmgren", radial=2000.0, axial=0.0, speed=314.0, viscosity=11e-6, **size)
    <Friction palmgren: 38.96 N mm (rolling 11.7, sliding 27.2), 12.23 W>
    """
    one_of("model", model, ("palmgren", "four-term"))
    one_of("supply", supply, tuple(_SUPPLY))
    one_of("series", series, (*_DEEP, *_ANGULAR))
    Fr, Fa = radial_and_axial(radial, axial)
    omega = plausible("speed", "speed", speed, "it must be a finite speed in rad/s")
    nu = plausible("kinematic viscosity", "viscosity", positive("viscosity", viscosity)) * 1e6
    d = plausible("length", "bore", positive("bore", bore)) * 1e3
    D = plausible("length", "outside", positive("outside", outside)) * 1e3
    require(D > d, "outside", outside, f"it must exceed the bore of {bore!r} m")
    static = plausible("rating", "C0", positive("C0", C0))
    by_size = f"C0 is {static:.6g} N with an outside diameter of {D:.4g} mm; C0/outside²"
    plausible("rating by size", by_size, static / (D * 1e-3) ** 2)
    check_speed_value("speed", omega, (d + D) / 2 * 1e-3)
    held = plausible("seal moment", "seals", nonnegative("seals", seals))
    churn = nonnegative("drag_factor", drag_factor)
    degrees = math.degrees(plausible("contact angle", "contact_angle", contact_angle))
    warn_of_overload(max(0.6 * Fr + 0.5 * Fa, Fr), static)
    n, dm = abs(omega) * 30 / math.pi, (d + D) / 2
    if n == 0:
        return Friction(model, 0.0, 0.0, 0.0, 0.0, 0.0)
    if model == "palmgren":
        f0 = _SUPPLY[supply][0 if degrees < _ANGULAR_FROM else 1]
        rolling, sliding = _palmgren(Fr, Fa, n, nu, dm, static, degrees, f0)
        drag = 0.0
    else:
        rolling, sliding, drag = _four_term(
            Fr, Fa, n, nu, d, D, static, degrees, series, _STARVING[supply], churn
        )
    return Friction(model, rolling * 1e-3, sliding * 1e-3, held, drag * 1e-3, omega)


def _palmgren(
    Fr: float, Fa: float, n: float, nu: float, dm: float, C0: float, degrees: float, f0: float
) -> tuple[float, float]:
    """M0 and M1, N mm."""
    product = nu * n
    M0 = 1e-7 * f0 * product ** (2 / 3) * dm**3 if product >= 2000 else 160e-7 * f0 * dm**3
    if degrees < _ANGULAR_FROM:
        factor, exponent = 0.00075, 0.55  # .0006 (light series) to .0009 (heavy)
        P0, P1 = max(0.6 * Fr + 0.5 * Fa, Fr), max(3 * Fa - 0.1 * Fr, Fr)
    else:
        factor, exponent = 0.001, 0.33
        P0, P1 = max(0.5 * Fr + 0.3 * Fa, Fr), max(Fa - 0.1 * Fr, Fr)
    return M0, factor * (P0 / C0) ** exponent * P1 * dm


def _four_term(
    Fr: float,
    Fa: float,
    n: float,
    nu: float,
    d: float,
    D: float,
    C0: float,
    degrees: float,
    series: str,
    K_rs: float,
    V_M: float,
) -> tuple[float, float, float]:
    """M_rr, M_sl and M_drag, N mm."""
    dm = (d + D) / 2
    if degrees < _ANGULAR_FROM:
        known = ", ".join(_DEEP)
        require(series in _DEEP, "series", series, f"the four-term model has constants of {known}")
        R1, R2, S1, S2 = _DEEP[series]
        if Fa > 0:
            sine = math.sin(math.radians(24.6 * (Fa / C0) ** 0.24))
            G_rr = R1 * dm**1.96 * (Fr + R2 / sine * Fa) ** 0.54
            G_sl = S1 * dm**-0.145 * (Fr**5 + S2 * dm**1.5 / sine * Fa**4) ** (1 / 3)
        else:
            G_rr = R1 * dm**1.96 * Fr**0.54
            G_sl = S1 * dm**-0.26 * Fr ** (5 / 3)
        K_Z = _CROWDING["deep"]
    else:
        remedy = "the four-term model has constants of 0 and 40° alone: take friction='palmgren'"
        require(30 < degrees < 50, "contact_angle", round(degrees, 3), remedy)
        R1, R2, S1, S2 = _STEEP
        F_rr, F_sl = (c * dm**4 * n**2 for c in _STEEP_CENTRIFUGAL)
        G_rr = R1 * dm**1.97 * (Fr + F_rr + R2 * Fa) ** 0.54
        G_sl = S1 * dm**0.26 * ((Fr + F_sl) ** (4 / 3) + S2 * Fa ** (4 / 3))
        K_Z = _CROWDING["angular"]
    shear = 1 / (1 + 1.84e-9 * (n * dm) ** 1.28 * nu**0.64)
    starved = math.exp(-K_rs * nu * n * (d + D) * math.sqrt(K_Z / (2 * (D - d))))
    M_rr = shear * starved * G_rr * (nu * n) ** 0.6
    mixed = math.exp(-2.6e-8 * (n * nu) ** 1.4 * dm)
    M_sl = G_sl * (mixed * _BOUNDARY + (1 - mixed) * _FULL_FILM)
    K_ball = K_Z * (d + D) / (D - d) * 1e-12
    return M_rr, M_sl, 0.4 * V_M * K_ball * dm**5 * n**2
