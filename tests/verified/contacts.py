"""Lubricant, contact and single bearings (reference page §2, §3.1 to §3.5)."""

from __future__ import annotations

import dataclasses
import math

import numpy as np

from bearingdyn import core
from bearingdyn.analysis import equilibrium
from bearingdyn.application import Application
from bearingdyn.bearing import BallBearing
from bearingdyn.bearing.catalogue import bearing
from bearingdyn.bearing.film_thickness import dimensionless_film
from bearingdyn.bearing.hertz import PointContact
from bearingdyn.bearing.lubricant import Walther
from bearingdyn.parts import RigidBody
from verified.row import INDEPENDENT, MM, RPM, Row, rows, steel, to_the_digit


def lubricant() -> list[Row]:
    """Viscosity over temperature, and the film of Nijenbanning, Venner and Moes."""
    oil = Walther.from_two_points(40.0, 32e-6, 100.0, 5.4e-6)
    vg32 = [
        ("VG 32, Walther A", "9.53082", oil.A),
        ("VG 32, Walther B", "3.74658", oil.B),
        ("VG 32, viscosity at 70 °C (mm²/s)", "11.186", oil.viscosity(70.0) * 1e6),
    ]
    given = {(10, 1): "2.042", (100, 5): "3.055", (100, 10): "4.497", (1000, 10): "4.035"}
    film = [
        (f"circular film, M = {M}, L = {L}", H, dimensionless_film(M, L, 1.0)) for (M, L), H in given.items()
    ]
    return to_the_digit("§2", INDEPENDENT, vg32 + film)


def iso() -> list[Row]:
    """Single-bearing cases of ISO/TS 16281."""

    def at(load: tuple[float, ...], **geometry: float) -> np.ndarray:
        brg = BallBearing(7, 11.5 * MM, 43.5 * MM, 0.52, 0.53, **geometry)
        return brg.displacement(load)

    moment = (0, 0, 0, 0, 1.0, 0)
    kappa = BallBearing(7, 11.5 * MM, 43.5 * MM, 0.52, 0.53, clearance=0.0).kappa
    linear = at(moment, clearance=0.0, arm=43.5 * MM / 2)[4] * 1e3
    source = "ISO/TS 16281 case, commercial code"
    return (
        rows(
            "§3.1",
            1e-5,
            "the digits given",
            source,
            [
                ("contact stiffness (N/m^1.5)", 1.054911e10, kappa),
                ("radial displacement, 1 kN (µm)", 15.1101, at((1e3, 0, 0, 0, 0, 0), clearance=0.0)[0] * 1e6),
                (
                    "axial displacement, 1 kN (µm)",
                    149.1717,
                    at((0, 0, 1e3, 0, 0, 0), clearance=1e-5)[2] * 1e6,
                ),
            ],
        )
        + rows(
            "§3.1",
            2e-4,
            "the commercial code rotates by the exact angle, this package linearly",
            source,
            [("tilt, 1 N m, arm dm/2 (mrad)", 3.6957, linear)],
        )
        + to_the_digit(
            "§3.1",
            INDEPENDENT,
            [
                ("tilt, 1 N m, arm dm/2, linear (mrad)", "3.6952", linear),
                ("tilt, 1 N m, arm R_i, linear (mrad)", "3.647", at(moment, clearance=0.0)[4] * 1e3),
            ],
        )
    )


def hertz() -> list[Row]:
    """Harris' table of the Hertz point contact."""
    table = """.4795 1.4556 .7278 .9429 | .7948 2.265 .5480 .7961 | .90999 3.233 .4499 .6636 |
        .95738 4.395 .3830 .5551 | .983797 6.448 .3150 .4352 | .9989156 17.974 .18822 .2106 |
        .9998527 37.38 .13050 .11995"""
    cases = []
    for line in table.split("|"):
        F, *printed = map(float, line.split())
        contact = PointContact(Rx=1.0, Ry=(1 + F) / (1 - F), modulus=1.0)
        found = (contact.a_star, contact.b_star, contact.delta_star)
        cases += [
            (f"{n}, F(ρ) = {F:g}", p, c) for n, p, c in zip(("a*", "b*", "δ*"), printed, found, strict=True)
        ]
    reason = "the last digits of the table, and those of its F(ρ)"
    return rows("§3.2", 4e-4, reason, "T. A. Harris, Rolling Bearing Analysis", cases)


def load_distribution() -> list[Row]:
    """Sjövall's integrals, by so many balls that the sum is the integral."""
    table = """.1 .11557 .11960 | .3 .18918 .21103 | .5 .22883 .27821 | .7 .25054 .33736 | 1 .25465 .42441 |
        2.5 .13390 .72395"""
    alpha = 0.6
    brg = BallBearing(7, 11.5 * MM, 43.5 * MM, 0.52, 0.53, contact_angle=alpha)
    many = dataclasses.replace(brg.kernel(), Z=4000)
    cases = []
    for line in table.split("|"):
        _, Jr, Ja = line.split()
        epsilon = float(line.split()[0])
        dr = 1e-12 / math.cos(alpha) / (2 * epsilon)  # so light that the contact angle stays
        da = (2 * epsilon - 1) * dr / math.tan(alpha)
        g, _, _, loads = core.bearing_force(many, np.array([dr, 0, da, 0, 0]), np.zeros(5), 0.0, 0.0)
        total = many.Z * loads.max()
        cases.append((f"Jr({epsilon:g})", Jr, g[0] / (total * math.cos(alpha))))
        cases.append((f"Ja({epsilon:g})", Ja, g[2] / (total * math.sin(alpha))))
    return to_the_digit("§3.3", INDEPENDENT, cases)


def harris_209() -> list[Row]:
    """The 209 deep-groove bearing of Harris' examples."""
    metal = steel(206.843e9)
    brg = BallBearing(9, 12.7 * MM, 65 * MM, 0.52, 0.52, clearance=15e-6, material=metal, ball_material=metal)
    geometry = brg.geometry
    # the load spread as over many balls, as the reference has it (Sjövall), each a share as stiff
    many = dataclasses.replace(brg.kernel(), Z=9 * 40, kappa=brg.kappa / 40)
    g, _, _, loads = core.bearing_force(many, np.array([0.06053e-3, 0, 0, 0, 0]), np.zeros(5), 0.0, 0.0)
    of_nine = brg.ball_loads(brg.displacement((8900.0, 0, 0, 0, 0, 0))).max()
    return (
        to_the_digit(
            "§3.4",
            INDEPENDENT,
            [
                ("209: A (mm)", "0.508", geometry.A * 1e3),
                ("209: free contact angle (°)", "9.858", math.degrees(geometry.alpha0)),
                ("209: axial play (mm)", "0.1739", geometry.Pe * 1e3),
                ("209: contact stiffness (N/mm^1.5)", "3.7011e5", brg.kappa * 1e-4 / math.sqrt(10)),
            ],
        )
        + rows(
            "§3.4",
            2e-4,
            "half of the last digit of the displacement is 1.5e-4 of the load",
            INDEPENDENT,
            [
                ("209: radial load at .06053 mm (N)", 8900.0, g[0]),
                ("209: largest ball load then (N)", 4519.8, 40 * loads.max()),
            ],
        )
    ) + rows(
        "§3.4",
        5e-3,
        "Harris spreads the load as over many balls; here are nine",
        "T. A. Harris, Rolling Bearing Analysis",
        [("209: largest ball load under 8900 N (N)", 4536.0, of_nine)],
    )


def preloaded_6202() -> list[Row]:
    """A 6202-like bearing under 180 N, through an application and its equilibrium."""
    metal = steel(207e9)
    brg = BallBearing(8, 5.953 * MM, 25 * MM, 0.52, 0.53, clearance=1e-5, material=metal, ball_material=metal)
    app = Application()
    app.add("rotor", RigidBody(0.5, (1e-3,) * 3))
    app.bearing("b", brg, inner="rotor.centre", outer="ground")
    app.load("rotor.centre", (0, 0, 180.0, 0, 0, 0))
    state = equilibrium(app)
    b, z, R = state.bearings["b"], state.displacement("rotor.centre")[2], brg.arm
    cases = [
        ("6202: contact stiffness (N/m^1.5)", "7.486282e9", brg.kappa),
        ("6202: axial displacement from touch (µm)", "23.43301", (z - brg.geometry.Pe / 2) * 1e6),
        ("6202: contact angle (°)", "14.8804", math.degrees(math.asin(180.0 / b.loads.sum()))),
        ("6202: ball load (N)", "87.6163", b.loads[0]),
        ("6202: kxx (N/m)", "9.533296e7", b.K[0, 0]),
        ("6202: kzz (N/m)", "1.561296e7", b.K[2, 2]),
        ("6202: kθθ (N m)", "1242.715", b.K[4, 4] * R**2),
        ("6202: k_xθy (N)", "-3.157244e5", -b.K[0, 3] * R),
        ("6202: axial displacement from centred (µm)", "77.76", z * 1e6),
    ]
    return to_the_digit("§3.5", INDEPENDENT, cases)


def catalogue() -> list[Row]:
    """Ball passes of a 6205, and pressures under half of 10 kN."""
    passes = [
        (
            "6205, outer ball pass at 1797 rpm (Hz)",
            "107.36",
            bearing("6205", clearance=1e-5).frequencies(1797 * RPM).BPFO,
        )
    ]
    pressures = []
    for name, balls, expected in (("6202", 8, 4.44), ("6305", 7, 3.04)):
        brg = bearing(name, balls=balls, clearance=0.0)
        Q = brg.ball_loads(brg.displacement((5e3, 0, 0, 0, 0, 0))).max()
        largest = max(brg.inner_contact.pressure(Q), brg.outer_contact.pressure(Q))
        pressures.append((f"{name}, contact pressure under 5 kN (GPa)", expected, largest * 1e-9))
    source = "Case Western Reserve University, bearing data"
    return to_the_digit("§2", source, passes) + rows(
        "§1", 0.01, "the reference does not spell out its geometries", INDEPENDENT, pressures
    )
