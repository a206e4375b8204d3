"""Layers, samples, free bodies and rotors (reference page §3.7 to §3.11)."""

from __future__ import annotations

import math

import numpy as np

from bearingdyn.analysis import modes
from bearingdyn.application import Application
from bearingdyn.fem import Section
from bearingdyn.material import STEEL, Elastic, Maxwell
from bearingdyn.parts import Disc, Layer, Region, Revolved, RigidBody, Ring, Shaft, damping_sample
from verified.row import INDEPENDENT, MM, RPM, Row, as_printed, rows, unit_rubber


def bonded_rings() -> list[Row]:
    """Stiffness of a rubber ring bonded inside and outside, G = 1."""
    table = """17.5 20 11 .45 487.56 2255.8 102322 | 17.5 20 11 .49 489.87 4281.3 107453 |
        17.5 20 11 .499 490.43 5708 109280 | 17.5 20 11 .4995 490.44 5821 109387 |
        10 20 20 .3 153.48 359.85 28254.2 | 10 20 20 .49 160.51 644.5 33863 |
        10 20 20 .4999 160.96 687.3 34375"""
    cases, torsion = [], []
    for line in table.split("|"):
        a, b, L, nu, *wanted = map(float, line.split())
        K = np.diag(as_printed(Layer(a * MM, b * MM, L * MM, unit_rubber(nu)).stiffness()))
        for name, want, at in zip(("axial", "radial", "tilt"), wanted, (2, 0, 3), strict=True):
            cases.append((f"bonded ring {a:g}/{b:g}×{L:g}, ν = {nu:g}, {name}", want, K[at]))
        if nu == 0.49:
            printed = {17.5: 180620.6, 10.0: 33510.32}[a]
            torsion.append((f"bonded ring {a:g}/{b:g}×{L:g}, torsion", printed, K[5]))
    return rows("§3.7", 1e-3, "asked for to 0.1 %", INDEPENDENT, cases) + rows(
        "§3.7", 1e-6, "exact closed form; the mesh to third order", "closed form", torsion
    )


def sample() -> list[Row]:
    """The three-ring damping sample, free, by itself and through an application."""
    body = damping_sample(Elastic(2 * 1e6 * 1.49, 0.49, 1200.0))
    axial, torsion = body.modes(0, 4).frequency[2:]
    tilt, radial = body.modes(1, 4).frequency[2:]
    names = ("axial", "torsion", "tilt", "radial", "next")
    wanted = (839.6, 924.6, 973.1, 2371.8, 5664.0)
    full = zip(names, wanted, (axial, torsion, tilt, radial, body.modes(2, 1).frequency[0]), strict=True)
    bulk = Elastic(2 * 1e6 * 1.49, 0.49, 1200.0).K
    app = Application()
    app.add("sample", damping_sample(Maxwell(1e6, [], [], K=bulk, density=1200.0)))
    for face in ("inner", "outer"):
        app.free(f"sample.{face}")
    frequency = modes(app).frequency.values
    elastic = frequency[frequency > 1.0][[0, 1, 2, 4]]
    reduced = zip(names[:4], wanted[:4], elastic, strict=True)
    return rows(
        "§3.8",
        1e-3,
        "the digits given, on the default mesh",
        INDEPENDENT,
        [(f"damping sample, {n} mode (Hz)", w, f) for n, w, f in full],
    ) + rows(
        "§3.8",
        5e-3,
        "asked for to 0.5 %: rigid faces, rubber's inertia static",
        INDEPENDENT,
        [(f"damping sample as a part, {n} mode (Hz)", w, f) for n, w, f in reduced],
    )


def free_bodies() -> list[Row]:
    """A free steel shaft, in three dimensions and as a beam, and a free steel ring."""
    wanted = (2244.63, 5929.7, 11005.0)
    section = (Region((0.0, 10 * MM), (-100 * MM, 100 * MM), STEEL),)
    solid = Revolved(section, refinement=2.0).modes(1, 5).frequency[2:]
    app = Application()
    app.add("shaft", Shaft([Section(0.2, 0.02)], seats={"seat": 0.0}, f_max=60e3))
    app.free("shaft.seat")
    beam = modes(app).frequency.values
    bending = beam[beam > 100.0]
    # both planes; the first twist and stretch lie at 8 and 13 kHz
    bending = [bending[np.argmin(np.abs(bending - f))] for f in wanted]
    ring = Ring(14 * MM, 17.5 * MM, 11 * MM)
    table = {(2, 0): 8857.0, (2, 1): 14525.0, (3, 0): 24248.0, (3, 1): 37807.0}
    plane = ("in plane", "out of plane")
    rings = [
        (f"free steel ring, n = {n}, {plane[k]} (Hz)", f, ring.modes(n, 2).frequency[k])
        for (n, k), f in table.items()
    ]
    return (
        rows(
            "§3.10",
            2e-4,
            "a mesh twice as fine as the default, which leaves 0.09 % in the third mode",
            INDEPENDENT,
            [
                (f"free steel shaft as a solid, bending {k + 1} (Hz)", f, solid[k])
                for k, f in enumerate(wanted)
            ],
        )
        + rows(
            "§3.10",
            5e-4,
            "Timoshenko's beam is within 0.01 % of the solid; modes up to 60 kHz leave the rest",
            INDEPENDENT,
            [
                (f"free steel shaft as a beam, bending {k + 1} (Hz)", f, bending[k])
                for k, f in enumerate(wanted)
            ],
        )
        + rows("§3.10", 2e-3, "the reference's own mesh is known to 0.1 %", INDEPENDENT, rings)
    )


def rigid_rotor() -> list[Row]:
    """A rigid rotor on springs k at ±a."""
    m, It, Ip, k, a, speed = 5.0, 0.02, 0.03, 1e6, 0.1, 700.0
    app = Application()
    app.add("rotor", RigidBody(m, (It, It, Ip), rotating=True))
    app.ground("rotor.centre", stiffness=(2 * k, 2 * k, k, 2 * k * a**2, 2 * k * a**2, 1e6))
    omega = 2 * math.pi * modes(app, speed=speed).frequency.values
    root = math.sqrt((Ip * speed) ** 2 + 8 * It * k * a**2)
    exact = {"backward": (root - Ip * speed) / (2 * It), "forward": (root + Ip * speed) / (2 * It)}
    cases = [
        (f"rigid rotor, {n} conical whirl (rad/s)", w, omega[np.argmin(np.abs(omega - w))])
        for n, w in exact.items()
    ]
    return rows("§3.10", 1e-12, "closed form", "closed form", cases)


def friswell() -> list[Row]:
    """Rotor with two discs on springs."""
    metal = Elastic(211e9, 211e9 / (2 * 81.2e9) - 1, 7810.0)
    shaft = Shaft(
        [Section(1.5, 0.05)],
        seats={"left": 0.0, "right": 1.5},
        discs=[Disc.cylinder(0.5, 0.28, 0.07, 0.05, metal), Disc.cylinder(1.0, 0.35, 0.07, 0.05, metal)],
        material=metal,
        f_max=3e3,
        element_length=0.25,
    )
    app = Application()
    app.add("rotor", shaft)
    for end in ("left", "right"):
        app.ground(f"rotor.{end}", stiffness=(1e6, 1e6, 0, 0, 0, 0))
    table = {
        0: (86.66, 86.66, 274.31, 274.31, 650.41, 716.78),
        4000: (85.39, 87.80, 251.78, 294.71, 600.18, 650.41),
    }
    cases = []
    for rpm, published in table.items():
        omega = 2 * math.pi * modes(app, speed=rpm * RPM).frequency.values
        found = omega[omega > 1.0][:6]
        cases += [
            (f"two-disc rotor at {rpm} rpm, mode {k + 1} (rad/s)", w, found[k])
            for k, w in enumerate(published)
        ]
    source = "Friswell, Penny, Garvey & Lees, Dynamics of Rotating Machines, example 5.9.1"
    return rows("§3.11", 1e-3, "asked for to 0.1 %; four to five digits are printed", source, cases)
