"""Solids deformed between plates: a ring of bricks against the reference table, and published pads."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from scipy.optimize import brentq

from bearingdyn.fem import SolidMesh, box_mesh, ring_mesh
from bearingdyn.material import Elastic
from bearingdyn.parts import RigidSurface, Solid
from verified.row import INDEPENDENT, MM, Row, rows

G, K = 1e6, 2e9
RUBBER = Elastic(9 * K * G / (3 * K + G), (3 * K - 2 * G) / (6 * K + 2 * G), 1100.0)
PLATES = {"foot": "y-", "plate": "y+"}
A = 40 * MM


def crowded(length: float, n: int) -> np.ndarray:
    """Grid lines crowded to both ends, m."""
    return np.asarray(0.5 * length * (1 - np.cos(np.pi * np.arange(n + 1) / n)))


def recessed_ring() -> SolidMesh:
    """The ring R2 of rubber.md, 20/24×12 mm with ends hollowed by 1.2 mm, of bricks crowded to its ends."""
    plain = ring_mesh((20 * MM, 24 * MM), 12 * MM, across=4, along=8, around=16)
    p = plain.points.copy()
    across = (2 * np.hypot(p[:, 0], p[:, 1]) - 44 * MM) / (4 * MM)
    z = p[:, 2] - p[:, 2].mean()
    z = np.sign(z) * 6 * MM * (1 - (1 - np.abs(z) / (6 * MM)) ** 1.7)
    p[:, 2] = z * (1 - 0.2 * (1 - across**2))
    return replace(plain, points=p)


def deformed_solids() -> list[Row]:
    """R2 at 2 and 5 %, a pad pressed without friction, and bonded pads of published shape."""
    axes = {name: RigidSurface(name, "axis") for name in ("inner", "outer")}
    ring, cases = Solid(recessed_ring(), RUBBER, axes, 0.0), []
    table = {
        0.02: (445.42, 343.97, 2645.0, 165670, 95858),
        0.05: (1225.1, 337.13, 3134.3, 164870, 97422),
    }
    names = ("force (N)", "axial (N/mm)", "radial (N/mm)", "torsion (N mm/rad)", "tilt (N mm/rad)")
    for squeeze, wanted in table.items():
        found = ring.assembled({"outer": 4 * MM * squeeze})
        k = np.diag(found.stiffness().real)[6:]
        got = (found.force, k[2] / 1e3, k[0] / 1e3, k[5] * 1e3, k[3] * 1e3)
        cases += [
            (f"ring 20/24×12 of 512 bricks, recessed, squeezed by {squeeze:.0%}, {what}", want, value)
            for what, want, value in zip(names, wanted, got, strict=True)
        ]

    def nominal(side: float) -> tuple[float, float]:
        J, bar = 0.9 * side**2, np.array([0.9, side]) ** 2 * (0.9 * side**2) ** (-2 / 3)
        tau = G * (bar - (bar[0] + 2 * bar[1]) / 3) + K * (J - 1) * J
        return float(tau[0] / 0.9), float(tau[1] / side)

    side = float(brentq(lambda s: nominal(s)[1], 1.0, 1.2, xtol=1e-15))
    block = Solid(box_mesh(crowded(A, 4), crowded(10 * MM, 2), crowded(A, 4), "hex27"), RUBBER, PLATES, 0.0)
    pressed = block.assembled({"plate": 1 * MM}, slip=("foot", "plate"))
    stiff = Elastic(3e6 * (1 - 1e-6 / 6), 0.5 - 1e-6 / 2, 1100.0)  # K/G = 1e6
    mesh = box_mesh(crowded(A, 8), crowded(A / 40, 4), crowded(A, 8), "hex27")
    thin = Solid(mesh, stiff, PLATES, 0.0).stiffness()[7, 7].real
    return [
        *rows("§2 of rubber.md", 5e-3, "asked for to 0.5 %", INDEPENDENT, cases),
        Row(
            "square pad 40×10 mm pressed by 10 % without friction, force (N)",
            "closed form",
            -nominal(side)[0] * A**2,
            pressed.force,
            1e-6,
            "asked for to 1e-6; a homogeneous state",
        ),
        Row(
            "thin square pad of S = 10, stiffness over G S² A/t",
            "Kelly, Earthquake-Resistant Design with Rubber, 1997",
            6.73,
            thin * (A / 40) / A**2 / G / 100,
            0.03,
            "the formula leaves out terms of the order 1/S² and the edges",
        ),
    ]
