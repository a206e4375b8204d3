"""Small applications that several tests compute."""

from __future__ import annotations

from functools import cache

from bearingdyn.application import Application
from bearingdyn.bearing import BallBearing, FilmDamping
from bearingdyn.fem import Section
from bearingdyn.material import Elastic, Maxwell
from bearingdyn.parts import Disc, Layer, RigidBody, Shaft

RUBBER = Maxwell(G0=1e6, G=[2e6, 3e6], tau=[1e-3, 1e-4], eta0=3.0, K=2e9, density=1200.0)
BEARING = BallBearing(8, 12.303e-3, 52e-3, 0.52, 0.53, clearance=10e-6, damping=30.0)


# like the measured rubber at 20 °C from 10 to 4000 Hz, but without its slow relaxation: marches settle soon
LIKE_MEASURED = Maxwell(
    G0=4.74e6,
    G=[3.43e6, 0.967e6, 0.684e6, 0.559e6, 0.883e6],
    tau=[7.68e-6, 7.99e-5, 5.37e-4, 2.72e-3, 1.65e-2],
    K=2e9,
    density=1150.0,
)


@cache
def motor_rubber() -> Maxwell:
    """The rubber of examples/motor.py, measured; a similar one where the measurement is absent.

    The shipped sample that the example then takes is far more lossy; the motor's layers are not made for it.
    """
    import motor as example

    return example.rubber()[0] if example.MEASURED.exists() else LIKE_MEASURED


def oscillator(m: float = 2.0, c: float = 40.0, k: float = 5e5) -> Application:
    """A rigid body on equal springs and dampers in all directions."""
    app = Application()
    app.add("body", RigidBody(m, (1.0, 1.0, 1.0)))
    app.ground("body.centre", stiffness=(k,) * 6, damping=(c,) * 6)
    return app


def motor(rubber: Maxwell = RUBBER) -> Application:
    """A flexible shaft on two preloaded bearings; the left one's ring in a layer in a block on springs."""
    app = Application()
    shaft = Shaft(
        [Section(0.3, 0.03)],
        seats={"left": 0.06, "right": 0.24},
        points={"end": 0.0},
        damping=0.002,
        f_max=8e3,
    )
    app.add("shaft", shaft)
    app.add("ring", RigidBody.ring(0.03, 0.036, 0.019))
    app.add("layer", Layer(0.036, 0.039, 0.019, rubber, moduli=(1e6, 6e6), refinement=0.5))
    app.add("block", RigidBody(5.0, (0.03, 0.03, 0.03)))
    app.add("cap", RigidBody(1.0, (1e-3,) * 3))
    app.connect("ring.centre", "layer.inner")
    app.connect("layer.outer", "block.centre")
    app.ground("block.centre", stiffness=(1e8,) * 3 + (1e5,) * 3, damping=(1e3,) * 3 + (1.0,) * 3)
    app.ground("cap.centre", stiffness=(1e9, 1e9, 1e5, 1e6, 1e6, 1e6), damping=(1e3,) * 3 + (1.0,) * 3)
    app.bearing("left", BEARING, inner="shaft.left", outer="ring.centre")
    app.bearing("right", BEARING, inner="shaft.right", outer="cap.centre")
    app.load("cap.centre", (0, 0, 180.0, 0, 0, 0))
    app.load("shaft.end", (0, -50.0, 0, 0, 0, 0))
    return app


def friswell() -> Application:
    """Friswell, Penny, Garvey & Lees, Dynamics of Rotating Machines, example 5.9.1, through parts."""
    steel = Elastic(211e9, 211e9 / (2 * 81.2e9) - 1, 7810.0)
    shaft = Shaft(
        [Section(1.5, 0.05)],
        seats={"left": 0.0, "right": 1.5},
        discs=[
            Disc.cylinder(0.5, 0.28, 0.07, 0.05, material=steel),
            Disc.cylinder(1.0, 0.35, 0.07, 0.05, material=steel),
        ],
        material=steel,
        f_max=3e3,
        element_length=0.25,
    )
    app = Application()
    app.add("rotor", shaft)
    for end in ("left", "right"):
        app.ground(f"rotor.{end}", stiffness=(1e6, 1e6, 0, 0, 0, 0))
    return app


def jis_rotor() -> Application:
    """A rigid rotor on one JIS 6306, loaded along x."""
    app = _jis_rotor()
    app.ground("rotor.centre", damping=(200, 200, 200, 0.1, 0.1, 0.1))
    return app


def held_jis_rotor(clearance: float = 20e-6, damping: float | FilmDamping = 0.0) -> Application:
    """The same, moving in its plane alone: what is not x or y is held and damped; clearance a side, m."""
    app = _jis_rotor(clearance, damping)
    app.ground("rotor.centre", stiffness=(0, 0, 1e7, 1e5, 1e5, 1e5), damping=(200, 200, 1e4, 50, 50, 50))
    return app


def _jis_rotor(clearance: float = 20e-6, damping: float | FilmDamping = 0.0) -> Application:
    r_inner, r_outer = 40.1e-3, 63.9e-3  # raceways
    app = Application()
    app.add("rotor", RigidBody(20.0, (0.1, 0.1, 0.1)))
    bearing = BallBearing(
        8,
        (r_outer - r_inner) / 2,
        (r_outer + r_inner) / 2,
        0.52,
        0.52,
        clearance=2 * clearance,
        damping=damping,
        kappa=13.34e9,
        cage_ratio=r_inner / (r_inner + r_outer),
    )
    app.bearing("ball", bearing, inner="rotor.centre", outer="ground")
    app.load("rotor.centre", (196.0, 0, 0, 0, 0, 0))
    return app
