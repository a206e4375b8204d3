"""Bearings solved a second time, apart from the package: Jones' equations, and one row in axial load."""

from __future__ import annotations

import math

import numpy as np
from scipy.optimize import fsolve

from bearingdyn.bearing import BallBearing


def inertia_forces(brg: BallBearing, speed: float, a_i: float, a_o: float) -> tuple[float, float]:
    """F_c and M_g of a ball that rolls on both races without spin on the outer one, by vectors.

    Unknown: orbit ω_m, and the ball's rotation w = (radial, axial) in the frame of the cage. Axes (r, φ, z).
    """
    D, R = brg.Dw, brg.Dpw / 2
    inward, outward = (
        -np.array([math.cos(a_i), 0, math.sin(a_i)]),
        np.array([math.cos(a_o), 0, math.sin(a_o)]),
    )
    unit_r, unit_z = np.array([1.0, 0, 0]), np.array([0, 0, 1.0])
    rows, right = [], []
    for n, ring in ((inward, speed), (outward, 0.0)):
        radius = R + D / 2 * n[0]
        # surface of the ball at the contact moves as the race does, (ring − ω_m)·radius along φ
        rows.append([radius, *(np.cross(unit, D / 2 * n)[1] for unit in (unit_r, unit_z))])
        right.append(ring * radius)
    # no spin at the outer race: (w + ω_m e_z)·n = 0
    rows.append([outward[2], outward[0], outward[2]])
    right.append(0.0)
    orbit, w_r, w_z = np.linalg.solve(rows, right)
    mass = brg.ball_material.density * math.pi * D**3 / 6
    momentum = 0.1 * mass * D**2 * (w_r * unit_r + (w_z + orbit) * unit_z)
    rate = np.cross(orbit * unit_z, momentum)  # turns with the cage
    return mass * R * orbit**2, float(rate[1])


def jones(brg: BallBearing, speed: float, axial: float) -> tuple[float, float, float, float]:
    """α_i, α_o, Q_i, Q_o under pure axial load: five equations in Harris' unknowns, by a root finder."""
    A, D = brg.geometry.A, brg.Dw
    k_i, k_o = brg.inner_contact.kappa, brg.outer_contact.kappa
    l_i, l_o = (brg.fi - 0.5) * D, (brg.fo - 0.5) * D
    micro = 1e-6

    def state(u):
        X1, X2, d_i, d_o, d_a = (value * micro for value in u)
        A1 = A * math.sin(brg.contact_angle) + d_a
        A2 = A * math.cos(brg.contact_angle)
        return X1, X2, d_i, d_o, A1, A2

    def equations(u):
        X1, X2, d_i, d_o, A1, A2 = state(u)
        sin_o, cos_o = X1 / (l_o + d_o), X2 / (l_o + d_o)
        sin_i, cos_i = (A1 - X1) / (l_i + d_i), (A2 - X2) / (l_i + d_i)
        Q_i, Q_o = k_i * max(d_i, 0) ** 1.5, k_o * max(d_o, 0) ** 1.5
        F_c, M_g = inertia_forces(brg, speed, math.atan2(sin_i, cos_i), math.atan2(sin_o, cos_o))
        T = 2 * M_g / D  # all on the outer race
        return [
            ((A1 - X1) ** 2 + (A2 - X2) ** 2 - (l_i + d_i) ** 2) / A**2 * 1e4,
            (X1**2 + X2**2 - (l_o + d_o) ** 2) / A**2 * 1e4,
            (Q_o * sin_o + T * cos_o - Q_i * sin_i) / axial,
            (Q_o * cos_o - T * sin_o - Q_i * cos_i - F_c) / axial,
            brg.Z * Q_i * sin_i / axial - 1,
        ]

    guess = [l_o * math.sin(0.65) / micro, l_o * math.cos(0.65) / micro, 5.0, 6.0, 20.0]
    u, _, status, message = fsolve(equations, guess, xtol=1e-13, full_output=True)
    assert status == 1 or np.abs(equations(u)).max() < 1e-12, message
    X1, X2, d_i, d_o, A1, A2 = state(u)
    return math.atan2(A1 - X1, A2 - X2), math.atan2(X1, X2), k_i * d_i**1.5, k_o * d_o**1.5


def axial(brg: BallBearing, s: float) -> float:
    """Axial force of one row, s beyond touching: Z κ (Λ − A)^{3/2} sinα (theory.md §2)."""
    A = brg.geometry.A
    X, Y = A * math.sin(brg.geometry.alpha0) + s, A * math.cos(brg.geometry.alpha0)
    length = math.hypot(X, Y)
    return brg.Z * brg.kappa * max(length - A, 0.0) ** 1.5 * X / length


def closed_forms(brg: BallBearing, s: float) -> dict[str, float]:
    """Stiffness of one row in pure axial compression (theory.md §2)."""
    A, Z, R = brg.geometry.A, brg.Z, brg.arm
    X, Y = A * math.sin(brg.geometry.alpha0) + s, A * math.cos(brg.geometry.alpha0)
    length = math.hypot(X, Y)
    delta, sin, cos = length - A, X / length, Y / length
    Q, Kn = brg.kappa * delta**1.5, 1.5 * brg.kappa * math.sqrt(delta)
    kzz = Z * (Kn * sin**2 + Q / length * cos**2)
    return {
        "xx": Z / 2 * (Kn * cos**2 + Q / length * sin**2),
        "zz": kzz,
        "tt": R**2 * kzz / 2,
        "xt": -Z / 2 * R * (Kn - Q / length) * sin * cos,
    }
