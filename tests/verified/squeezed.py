"""Squeezed rings, pads and O-rings: the reference table of finite strain, and closed forms."""

from __future__ import annotations

import math

import numpy as np
from scipy.optimize import brentq

from bearingdyn.material import Elastic, Maxwell, Yeoh
from bearingdyn.parts import EndFace, Layer, ORing, Region, Revolved
from verified.row import INDEPENDENT, MM, Row, rows

G, K = 1e6, 2e9
RUBBER = Elastic(9 * K * G / (3 * K + G), (3 * K - 2 * G) / (6 * K + 2 * G), 1100.0)
ASKED = "asked for to 0.5 %"

# case, recess m, how, squeeze: force N, axial, radial N/mm, torsion, tilt N mm/rad, of μ = 1, K = 2000 MPa
TABLE = (
    ("flat", 0.0, "bonded", 0.0, (None, 381.80, 2748.1, 197406, 109575)),
    ("recessed, bonded", 1.2 * MM, "bonded", 0.0, (None, 346.59, 2352.6, 166204, 94763)),
    ("recessed, bonded", 1.2 * MM, "bonded", 0.02, (445.42, 343.97, 2645.0, 165670, 95858)),
    ("recessed, bonded", 1.2 * MM, "bonded", 0.05, (1225.1, 337.13, 3134.3, 164870, 97422)),
    ("slid in", 0.0, "slip", 0.05, (395.63, 377.03, 3253.2, 195771, 112917)),
    ("slid in", 0.0, "slip", 0.10, (865.84, 371.36, 3897.3, 194140, 118209)),
)


def squeezed_rings() -> list[Row]:
    """The ring 20/24×12 of rubber.md §2, and a complex modulus about its squeezed state."""
    cases = []
    for name, recess, how, squeeze, wanted in TABLE:
        found = Layer(20 * MM, 24 * MM, 12 * MM, RUBBER, recess=recess).assembled(
            squeeze=squeeze, inside=how, outside=how
        )
        k = np.diag(found.stiffness().real)[6:]
        got = (found.force, k[2] / 1e3, k[0] / 1e3, k[5] * 1e3, k[3] * 1e3)
        names = (
            "force (N)",
            "axial (N/mm)",
            "radial (N/mm)",
            "torsion (N mm/rad)",
            "tilt (N mm/rad)",
        )
        cases += [
            (f"ring 20/24×12, {name}, squeezed by {squeeze:.0%}, {what}", want, value)
            for what, want, value in zip(names, wanted, got, strict=True)
            if want is not None
        ]
    rubber = Maxwell(G, [2e6], [1e6], eta0=0.6e6, K=K, density=1100.0)  # G*(1 rad/s) = 3 + .6i MPa
    ring = Layer(20 * MM, 24 * MM, 12 * MM, rubber).assembled(squeeze=0.10, inside="slip", outside="slip")
    ratio = np.diag(ring.stiffness(1.0))[6:] / np.diag(ring.stiffness().real)[6:]
    moving = [
        (f"ring 20/24×12, slid in, 10 %, G*/G0 = 3 + 0.6i, {what} over static", want, value)
        for what, want, value in (
            ("axial, real", 3.58, ratio[2].real),
            ("axial, imaginary", 0.77, ratio[2].imag),
            ("radial, real", 3.28, ratio[0].real),
            ("radial, imaginary", 0.67, ratio[0].imag),
        )
    ]
    return [
        *rows("§2 of rubber.md", 5e-3, ASKED, INDEPENDENT, cases),
        *rows("§2 of rubber.md", 7e-3, "half of the last digit given", INDEPENDENT, moving),
    ]


def squeezed_pads() -> list[Row]:
    """The pad r = 10, t = 5 squeezed without friction, then stuck; the reference bends it between plates."""
    cases = []
    table = {
        0.05: (49.640, 630.9, 58.66, 3306.9, 10219),
        0.10: (105.09, 723.0, 58.21, 3490.6, 12242),
    }
    for squeeze, wanted in table.items():
        t = 5 * MM
        found = pad().assembled({"plate": squeeze * t}, slip=("foot", "plate"))
        k = found.stiffness().real
        # pure bending: each plate turns about its own centre, by half of the angle, as the table has it
        bend = np.zeros(12)
        bend[[4, 10]] = -0.5, 0.5
        tilt = bend @ k @ bend
        got = (found.force, k[8, 8] / 1e3, k[6, 6] / 1e3, k[11, 11] * 1e3, tilt * 1e3)
        names = ("force (N)", "axial (N/mm)", "shear (N/mm)", "torsion (N mm/rad)", "tilt (N mm/rad)")
        cases += [
            (f"pad r = 10, t = 5, squeezed by {squeeze:.0%}, {what}", want, value)
            for what, want, value in zip(names, wanted, got, strict=True)
        ]
    rings = [
        (
            f"O-ring 4 mm at r = 22, squeezed by {squeeze:.0%}, force (N)",
            force,
            ORing(22 * MM, 4 * MM, RUBBER).assembled(squeeze=squeeze).force,
        )
        for squeeze, force in ((0.05, 39.7), (0.10, 99.3))
    ]
    law = Yeoh(0.5, -0.05, 0.02)
    lam = 0.9

    def nominal(side: float) -> tuple[float, float]:
        """Nominal stress along and across of a body (lam, side, side), Pa."""
        J = lam * side**2
        bar = np.array([lam, side]) ** 2 * J ** (-2 / 3)
        I1 = bar[0] + 2 * bar[1]
        W1 = G * (law.C10 + 2 * law.C20 * (I1 - 3) + 3 * law.C30 * (I1 - 3) ** 2)
        tau = 2 * W1 * (bar - I1 / 3) + K * (J - 1) * J
        return float(tau[0] / lam), float(tau[1] / side)

    side = float(brentq(lambda s: nominal(s)[1], 1.0, 1.2, xtol=1e-15))
    clamped = pad().assembled({"plate": 0.5 * MM}, slip=("foot", "plate"), law=law)
    W1 = G * law.derivatives((lam**2 + 2 * side**2) * (lam * side**2) ** (-2 / 3), 0.0)[1]
    torsion = 2 * W1 * (lam * side**2) ** (-2 / 3) * side**2 * math.pi * (10 * MM) ** 4 / (2 * 5 * MM)
    closed = [
        (
            "Yeoh pad, 10 % without friction, force (N)",
            -nominal(side)[0] * math.pi * (10 * MM) ** 2,
            clamped.force,
        ),
        ("Yeoh pad, 10 %, torsion once stuck (N m/rad)", float(torsion), clamped.stiffness()[11, 11].real),
    ]
    return [
        *rows("§2 of rubber.md", 5e-3, ASKED, INDEPENDENT, cases + rings),
        *[
            Row(name, "closed form", want, float(got), 1e-6, "asked for to 1e-6; a homogeneous state")
            for name, want, got in closed
        ],
    ]


def pad() -> Revolved:
    return Revolved(
        (Region((0.0, 10 * MM), (0.0, 5 * MM), RUBBER, graded=True),),
        {"foot": EndFace(0.0), "plate": EndFace(5 * MM)},
    )
