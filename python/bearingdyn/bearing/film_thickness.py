"""Film thickness of a lubricated contact: formulas of Hamrock and Dowson, and of Nijenbanning et al."""

from __future__ import annotations

import math
from typing import NamedTuple

from bearingdyn.bearing.hertz import PointContact
from bearingdyn.checks import instance, positive, require

# By which the film of Nijenbanning, Venner and Moes, fitted to an oil that does not yield, lies above the
# solutions when divided by ρ̄(p_h): fitted, the middle of −3.9 to +5.7 % over the table from three times the
# turn on. What is left is the formula's own: mass carried to the centre gives ρ̄ the power of one, and α by
# 1/∫(η0/η)dp would take 5 % off at D = 1 as at D = .02, where −3 and +6 % are left.
YIELDING = 1.009


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
    E, Rx = film_scales(contact)
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
    M, L, speed = moes_groups(contact, F, us, eta0, alpha)
    try:
        return dimensionless_film(M, L, contact.Rx / contact.Ry) * contact.Rx * math.sqrt(speed)
    except ArithmeticError:  # numbers of no contact there is
        raise ValueError(
            f"F is {F:g} N, us {us:g} m/s, eta0 {eta0:g} Pa s and alpha {alpha:g} 1/Pa; no film has numbers "
            f"of this size (M {M:g}, L {L:g})"
        ) from None


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
    return film_formula(M, L, D)


def film_formula(M: float, L: float, D: float) -> float:
    """`dimensionless_film` of numbers that are known to be positive, D ≤ 1."""
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


def film_scales(contact: PointContact) -> tuple[float, float]:
    """E′ with 2/E′ = Σ(1 − ν²)/E, Pa, and Rx, m, the scales of the film formulas."""
    instance("contact", contact, PointContact, "give a bearing's inner_contact or outer_contact")
    require(
        contact.Rx <= contact.Ry,
        "contact.Rx",
        contact.Rx,
        f"it must not exceed Ry, {contact.Ry!r} m: the formulas hold for rolling across the minor axis",
    )
    return 2 * contact.modulus, contact.Rx


def moes_groups(
    contact: PointContact, F: float, us: float, eta0: float, alpha: float
) -> tuple[float, float, float]:
    """What formulas of film thickness take: load M and lubricant L of Moes, and the speed η0 us/(E′ Rx)."""
    E, Rx = film_scales(contact)
    speed = positive("eta0", eta0) * positive("us", us, "it must be positive, in m/s (u1 + u2)") / (E * Rx)
    M = positive("F", F, "it must be positive, in N") / (E * Rx**2) * speed**-0.75
    L = positive("alpha", alpha) * E * speed**0.25
    return M, L, speed
