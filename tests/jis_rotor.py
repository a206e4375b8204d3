"""The rigid rotor on a JIS 6306 of the reference page (§3.6, §4.4), moving in its plane alone."""

from __future__ import annotations

import math

from bearingdyn.analysis import Equilibrium, equilibrium
from bearingdyn.application import Application
from bearingdyn.bearing import BallBearing
from bearingdyn.parts import RigidBody

Z, R_INNER, R_OUTER = 8, 40.1e-3, 63.9e-3
RPM = math.pi / 30


def rotor(clearance: float = 20e-6) -> Equilibrium:
    """m = 20 kg, W = 196 N along x, 200 N s/m; radial clearance per side, m. What is not x or y is held, damped."""
    app = Application()
    app.add("rotor", RigidBody(20.0, (0.1, 0.1, 0.1)))
    app.ground("rotor.centre", stiffness=(0, 0, 1e7, 1e5, 1e5, 1e5), damping=(200, 200, 1e4, 50, 50, 50))
    bearing = BallBearing(
        Z,
        (R_OUTER - R_INNER) / 2,
        (R_OUTER + R_INNER) / 2,
        0.52,
        0.52,
        clearance=2 * clearance,
        kappa=13.34e9,
        cage_ratio=R_INNER / (R_INNER + R_OUTER),
    )
    app.bearing("ball", bearing, inner="rotor.centre", outer="ground")
    app.load("rotor.centre", (196.0, 0, 0, 0, 0, 0))
    return equilibrium(app)
