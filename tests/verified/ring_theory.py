"""A ring under radial loads by theory: thin and thick curved beams, and plane elasticity order by order."""

from __future__ import annotations

import math

import numpy as np


def thin_ring(P: float, E: float, I: float, R: float) -> tuple[float, float]:
    """Change of the diameter along two opposed outward loads P and across them, m, bending alone.

    Timoshenko, Strength of Materials, part 1, art. 80.
    """
    along, across = math.pi / 4 - 2 / math.pi, 0.5 - 2 / math.pi
    return P * R**3 / (E * I) * along, P * R**3 / (E * I) * across


def thick_ring(P: float, E: float, nu: float, a: float, b: float, width: float) -> tuple[float, float]:
    """The same with curvature, hoop stretch and shear, rectangular section a < r < b.

    Roark's Formulas for Stress and Strain, 7th ed., table 9.2, case 1, with α = e/R and β = 2F(1 + ν)e/R
    for thick rings, F = 6/5.
    """
    R, h = 0.5 * (a + b), b - a
    e = R - h / math.log(b / a)
    k2 = 1 - e / R
    k1 = k2 + 2 * 1.2 * (1 + nu) * e / R
    unit = P * R**3 / (E * width * h**3 / 12)
    return unit * (k1 * math.pi / 4 - 2 * k2**2 / math.pi), -unit * (k1 / 2 - k2 + 2 * k2**2 / math.pi)


def annulus_compliance(n: int, E: float, nu: float, a: float, b: float) -> float:
    """u_r at r = a, m, for the pressure cos nφ of 1 Pa there, plane stress, outside free; n = 0 or n ≥ 2.

    Michell's solution: Barber, Elasticity, tables 8.1 and 9.1; n = 0: Lamé.
    """
    if n == 0:
        return a / E * ((b**2 + a**2) / (b**2 - a**2) + nu)
    mu, kappa = E / (2 * (1 + nu)), (3 - nu) / (1 + nu)

    def radial(r: float) -> list[float]:
        return [
            -(n + 1) * (n - 2) * r**n,
            -(n + 2) * (n - 1) * r**-n,
            -n * (n - 1) * r ** (n - 2),
            -n * (n + 1) * r ** (-n - 2),
        ]

    def shear(r: float) -> list[float]:
        return [
            n * (n + 1) * r**n,
            -n * (n - 1) * r**-n,
            n * (n - 1) * r ** (n - 2),
            -n * (n + 1) * r ** (-n - 2),
        ]

    # lengths in units of a
    ratio = b / a
    c = np.linalg.solve([radial(1.0), shear(1.0), radial(ratio), shear(ratio)], [-1.0, 0.0, 0.0, 0.0])
    return float(np.dot([kappa - n - 1, kappa + n - 1, -n, n], c)) * a / (2 * mu)


def annulus_on_bed(n: int, E: float, nu: float, a: float, b: float, bed: float) -> float:
    """u_r at r = b, m, for the traction cos nφ of 1 Pa there, plane stress, on radial springs at r = a.

    bed in N/m³. Michell's solution as in annulus_compliance; n ≥ 2.
    """
    mu, kappa = E / (2 * (1 + nu)), (3 - nu) / (1 + nu)

    def rows(r: float) -> tuple[list[float], list[float], list[float]]:
        up, down = r**n, r**-n
        stress = [-(n + 1) * (n - 2) * up, -(n + 2) * (n - 1) * down]
        stress += [-n * (n - 1) * up / r**2, -n * (n + 1) * down / r**2]
        shear = [n * (n + 1) * up, -n * (n - 1) * down, n * (n - 1) * up / r**2, -n * (n + 1) * down / r**2]
        move = [(kappa - n - 1) * up * r, (kappa + n - 1) * down * r, -n * up / r, n * down / r]
        return stress, shear, move

    # lengths in units of b
    stress, shear, move = rows(a / b)
    held = np.array(stress) - bed * b / (2 * mu) * np.array(move)
    outer_stress, outer_shear, outer_move = rows(1.0)
    c = np.linalg.solve([held, shear, outer_stress, outer_shear], [0.0, 0.0, 1.0, 0.0])
    return float(np.dot(outer_move, c)) * b / (2 * mu)


def annulus_hoop(n: int, a: float, b: float) -> float:
    """σ_φ at r = b over the pressure cos nφ at r = a, outside free, n ≥ 2; Michell's solution as above."""
    ratio = b / a

    def rows(r: float) -> tuple[list[float], list[float], list[float]]:
        up, down = r**n, r**-n
        radial = [-(n + 1) * (n - 2) * up, -(n + 2) * (n - 1) * down]
        radial += [-n * (n - 1) * up / r**2, -n * (n + 1) * down / r**2]
        shear = [n * (n + 1) * up, -n * (n - 1) * down, n * (n - 1) * up / r**2, -n * (n + 1) * down / r**2]
        hoop = [(n + 1) * (n + 2) * up, (n - 1) * (n - 2) * down]
        hoop += [n * (n - 1) * up / r**2, n * (n + 1) * down / r**2]
        return radial, shear, hoop

    (inner, slip, _), (outer, outer_slip, hoop) = rows(1.0), rows(ratio)
    return float(np.dot(hoop, np.linalg.solve([inner, slip, outer, outer_slip], [-1.0, 0.0, 0.0, 0.0])))


def annulus_in_bush(n: int, E: float, nu: float, a: float, b: float, c: float, bed: float) -> float:
    """u_r at r = a, m, for the pressure cos nφ of 1 Pa there, of a ring a…b in a bush b…c held at c, n ≥ 2.

    Between them radial springs, bed in N/m³, and no friction. Plane stress, Michell's solution as above, its
    tangential motions by Barber, table 9.1.
    """
    mu, kappa = E / (2 * (1 + nu)), (3 - nu) / (1 + nu)

    def rows(r: float) -> list[list[float]]:
        up, down = r**n, r**-n
        stress = [-(n + 1) * (n - 2) * up, -(n + 2) * (n - 1) * down]
        stress += [-n * (n - 1) * up / r**2, -n * (n + 1) * down / r**2]
        shear = [n * (n + 1) * up, -n * (n - 1) * down, n * (n - 1) * up / r**2, -n * (n + 1) * down / r**2]
        move = [(kappa - n - 1) * up * r, (kappa + n - 1) * down * r, -n * up / r, n * down / r]
        slide = [(kappa + n + 1) * up * r, -(kappa - n + 1) * down * r, n * up / r, n * down / r]
        return [stress, shear, move, slide]

    # lengths in units of b; the ring's four constants, then the bush's
    none = [0.0] * 4
    (pressed, slip, within, _), (stress, shear, move, _) = rows(a / b), rows(1.0)
    held, stuck = rows(c / b)[2:]
    gap = np.array([*move, *(-np.array(move))]) + 2 * mu / (bed * b) * np.array([*stress, *none])
    A = [
        [*pressed, *none], [*slip, *none], [*shear, *none], [*none, *shear],
        [*stress, *(-np.array(stress))], gap, [*none, *held], [*none, *stuck],
    ]  # fmt: skip
    found = np.linalg.solve(np.array(A), [-1.0] + [0.0] * 7)
    return float(np.dot(within, found[:4])) * b / (2 * mu)
