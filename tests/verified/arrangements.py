"""Sets of bearings, clamped balls and loaded cages in an application."""

from __future__ import annotations

import math

import numpy as np
import scipy

import bearingdyn as bd
from bearingdyn.bearing import BallBearing, Pair
from verified.closed_forms import axial
from verified.row import INDEPENDENT, RPM, Row, rows, steel

ROW = BallBearing(13, 7.938e-3, 38.5e-3, 0.52, 0.53, contact_angle=math.radians(25))


def _rotor(bearing: object, load: tuple[float, ...]) -> bd.Equilibrium:
    app = bd.Application()
    app.add("rotor", bd.RigidBody(1.0, (1e-3, 1e-3, 1e-3), rotating=True))
    app.bearing("b", bearing, inner="rotor.centre", outer="ground")  # type: ignore[arg-type]
    app.load("rotor.centre", load)
    return bd.equilibrium(app)


def arranged() -> list[Row]:
    """Thrust on a preloaded pair, rings that clamp their balls, and the cage under thrust."""
    pair, s = Pair(ROW, "DB", 0.015, preload=30e-6), 15e-6
    z = scipy.optimize.brentq(
        lambda z: axial(ROW, s + z) - axial(ROW, s - z) - 400.0, -3e-4, 3e-4, xtol=1e-18
    )
    found = _rotor(pair, (0, 0, 400.0, 0, 0, 0))
    metal = steel(207e9)
    deep = BallBearing(8, 5.953e-3, 25e-3, 0.52, 0.53, clearance=10e-6, material=metal, ball_material=metal)
    clamped = BallBearing(
        8, 5.953e-3, 25e-3, 0.52, 0.53, clearance=-8e-6, material=metal, ball_material=metal
    )
    stiffness = 6 * clamped.kappa * math.sqrt(4e-6)
    held = _rotor(clamped, (0.0,) * 6).bearings["b"]
    speed = 5000 * RPM
    cage = bd.cage_ratios(_rotor(deep, (0, 0, 180.0, 0, 0, 0)), speed)["b"]
    return (
        rows(
            "§2", 1e-9, "two searches, each to 1e-12 of the load", "f(s + z) − f(s − z) = F",
            [("DB pair, 30 µm, 400 N: shift (µm)", z * 1e6, found.displacement("rotor.centre")[2] * 1e6),
             ("DB pair, 30 µm, 400 N: first row (N)", axial(ROW, s + z), found.bearings["b-1"].force[2])],
        )
        + rows(
            "§2", 1e-9, "round-off", "κ(Pd/2)^{3/2} and Z/2 · 3/2 κ(Pd/2)^{1/2}",
            [("clamped by 8 µm: ball load (N)", clamped.kappa * (4e-6) ** 1.5, held.loads[0]),
             ("clamped by 8 µm: radial stiffness (N/µm)", stiffness / 1e6, held.radial_stiffness / 1e6)],
        )
        + rows(
            "§4.5", 8e-5, "hypotheses of race control are 1.3e-4 apart, and the reference lies between",
            INDEPENDENT,
            [("6202, 180 N, 5000 rpm: BPFO (Hz)", 256.63, 8 * cage * speed / (2 * np.pi))],
        )
    )  # fmt: skip
