"""Ratings, lives and heat: makers' printed figures, a commercial code, closed forms (reference page §4.5)."""

from __future__ import annotations

import dataclasses
import math

import numpy as np

from bearingdyn.analysis import ThermalNetwork
from bearingdyn.bearing import BallBearing, equivalent_load, load_distribution, rating_life
from bearingdyn.bearing.catalogue import CATALOGUE
from bearingdyn.bearing.rating import dynamic_factor, in_hours, static_factor
from verified.row import MM, RPM, Row, rows, steel

NSK = "NSK rolling bearings, E1102"
CODE = "commercial code, C = 23.4 kN"


def printed_ratings() -> list[Row]:
    """C and C0 of a bearing of each series, and the worst of all that are printed."""
    found = []
    for name in ("6008", "6205", "6310", "61815", "61907", "16010", "7014C", "7205B", "7312A"):
        entry = CATALOGUE[name]
        assert entry.printed is not None
        cosine = math.cos(entry.contact_angle or 0.0)
        f0 = entry.printed.f0
        if not f0 > 0:
            f0 = static_factor(entry.Dw * cosine / entry.Dpw, inner_only=True)
        found += [
            (f"{name}: C (N)", entry.printed.C, entry.ratings.C),
            (f"{name}: f0 Z Dw² cosα (N)", entry.printed.C0, f0 * entry.Z * (entry.Dw * 1e3) ** 2 * cosine),
        ]
    off = np.array([e.deviation for e in CATALOGUE.values() if e.deviation is not None])
    worst = 1 + np.abs(off).max(axis=0)
    reason = "three figures are printed, and balls come in steps of 1/64 inch"
    return rows("§4.5", 0.02, reason, NSK, found) + rows(
        "§4.5", 0.02, reason, NSK,
        [("all printed C, the worst over the print", 1.0, worst[0]),
         ("all printed C0, the worst over the print", 1.0, worst[1])],
    )  # fmt: skip


def factors() -> list[Row]:
    """fc of ISO 281 and f0 of ISO 76."""
    fc = {0.05: 46.7, 0.10: 55.5, 0.16: 59.6, 0.20: 59.9, 0.30: 56.0}
    f0 = {0.05: 15.7, 0.10: 16.4, 0.20: 13.9, 0.30: 11.6}
    return rows(
        "§4.5", 3e-3, "a table of three figures", "ISO 281, table of fc",
        [(f"fc at Dw/Dpw = {g}", want, dynamic_factor(g)) for g, want in fc.items()],
    ) + rows(
        "§4.5", 5e-3, "a table of three figures", "ISO 76, table of f0",
        [(f"f0 at Dw/Dpw = {g}", want, static_factor(g)) for g, want in f0.items()],
    )  # fmt: skip


def reference_lives() -> list[Row]:
    """L10r of ISO/TS 16281's bearing, deflections of its combined case, Harris' 218."""
    tight = BallBearing(7, 11.5 * MM, 43.5 * MM, 0.52, 0.53, clearance=0.0)
    loose = dataclasses.replace(tight, clearance=10e-6)
    cases = [
        ("Fr = 1 kN, no clearance", tight, (1e3, 0, 0, 0, 0, 0), 13163.019),
        ("Fa = 1 kN, no clearance", tight, (0, 0, 1e3, 0, 0, 0), 2222.7318),
        ("Fr = Fa = 1 kN, 10 µm", loose, (1e3, 0, 1e3, 0, 0, 0), 1630.5367),
        ("M = 1 N m, no clearance", tight, (0, 0, 0, 1.0, 0, 0), 785144.75),
    ]
    # the same code's other cases, github.com/minzhun/ISO16281, Test_BallBearing.py
    others = [
        ("Fr = 1 kN, 10 µm", loose, (1e3, 0, 0, 0, 0, 0), 10795.7948),
        ("Fa = 1 kN, 10 µm", loose, (0, 0, 1e3, 0, 0, 0), 3115.8781),
        ("Fr = Fa = 1 kN, M = 1 N m, 10 µm", loose, (1e3, 0, 1e3, 1.0, 0, 0), 1627.7479),
    ]
    mean = dataclasses.replace(loose, overrides=loose.overrides._replace(arm=43.5 * MM / 2))
    q = mean.displacement((1e3, 0, 1e3, 0, 0, 0))
    metal = steel(206.843e9)
    harris = BallBearing(
        16, 22.23 * MM, 125.26 * MM, 0.5232, 0.5232, contact_angle=math.radians(40), material=metal,
        ball_material=metal,
    )  # fmt: skip
    thrust = load_distribution(harris, harris.displacement((0, 0, 17800.0, 0, 0, 0)))
    L10 = (55300.0 / equivalent_load(10e3, 0.0, 31500.0, f0=13.0)) ** 3
    return (
        rows(
            "§4.5", 3e-4, "the digits of the code's own deflections", CODE,
            [(f"{what}: L10r (million rev.)", life, rating_life(b, f, C=23400.0))
             for what, b, f, life in cases],
        )
        + rows(
            "§4.5", 3e-4, "the digits of the code's own deflections", f"{CODE}, github.com/minzhun/ISO16281",
            [(f"{what}: L10r (million rev.)", life, rating_life(b, f, C=23400.0))
             for what, b, f, life in others],
        )
        + rows(
            "§4.5", 1e-4, "the digits given", CODE,
            [("combined: radial (µm)", 19.5923, q[0] * 1e6), ("combined: axial (µm)", 146.4603, q[2] * 1e6),
             ("combined: tilt (mrad)", 2.6872, q[4] * 1e3)],
        )
        + rows(
            "§4.5", 3e-3, "the source reads a stiffness off a chart", "T. A. Harris, Rolling Bearings",
            [("218, 17.8 kN: contact angle (°)", 41.6, math.degrees(thrust.angle_inner[0])),
             ("218, 17.8 kN: ball load (N)", 1676.0, thrust.load_inner[0])],
        )
        + rows(
            "§4.5", 2e-3, "printed in round figures", "SKF general catalogue, example of the 6309",
            [("6309, 10 kN: L10 (million rev.)", 169.0, L10),
             ("6309, 10 kN, 3000 rpm: L10 (h)", 940.0, in_hours(L10, 3000 * RPM))],
        )
    )  # fmt: skip


def heat() -> list[Row]:
    """Slab and ring with heat of their own, in the thermal network."""
    slab, ring = ThermalNetwork(0.0), ThermalNetwork(0.0)
    slab.link("left", "air", 1e7)
    slab.link("right", "air", 1e7)
    slab.slab("rubber", "left", "right", area=0.01, thickness=0.004, conductivity=0.25)
    a, b, width, k, W = 0.02, 0.03, 0.016, 0.2, 5.0
    ring.link("outside", "air", 1e7)
    ring.ring("rubber", "inside", "outside", r_inner=a, r_outer=b, width=width, conductivity=k)
    q = W / (math.pi * (b**2 - a**2) * width)
    return rows(
        "§4.5", 5e-3, "24 cells through the thickness", "Carslaw and Jaeger, conduction of heat in solids",
        [("slab of 8 W, warmest (K)", 8.0 / 4e-5 * 0.004**2 / (8 * 0.25),
          slab.peak("rubber", {"rubber": 8.0})),
         ("slab of 8 W, mean (K)", 8.0 / 4e-5 * 0.004**2 / (12 * 0.25),
          slab.temperatures({"rubber": 8.0})["rubber"]),
         ("ring of 5 W, insulated within (K)", q / (4 * k) * (b**2 - a**2 - 2 * a**2 * math.log(b / a)),
          ring.temperatures({"rubber": W})["inside"])],
    )  # fmt: skip
