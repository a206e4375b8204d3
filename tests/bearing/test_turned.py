"""A bearing with pits, seen at another cage angle: every pit stands where its body has carried it."""

from __future__ import annotations

import dataclasses
import math

import numpy as np
import pytest

from bearingdyn.analysis import equilibrium
from bearingdyn.application import Application
from bearingdyn.bearing import BallBearing, Pit
from bearingdyn.parts import RigidBody

PERFECT = BallBearing(8, 12.303e-3, 52e-3, 0.52, 0.53, clearance=10e-6)
PRESSED, DEPTH, WIDTH = 20e-6, 5e-6, 2e-3  # m; a ball reaches the floor of a pit this wide and shallow
ANGLE = 0.37  # of the cage, rad


def pit_below_first_ball(body: str, angle: float) -> Pit:
    """The pit, given at cage angle 0, that the first ball stands in once the cage is at `angle`.

    Kinematics of pure rolling with the outer ring at rest (Harris): the shaft turns by 2/(1 − Dw/Dpw) of the
    cage's angle, the ball the other way about its own axis by Dpw/2Dw (1 − (Dw/Dpw)²) of the shaft's.
    """
    ratio = PERFECT.Dw / PERFECT.Dpw
    shaft = 2 * angle / (1 - ratio)
    spun = shaft * (1 - ratio**2) / (2 * ratio)
    return Pit(body, {"inner": angle - shaft, "outer": angle, "ball": spun}[body], WIDTH, DEPTH)


@pytest.mark.parametrize("angle", [ANGLE, -1.3])
@pytest.mark.parametrize("body", ["inner", "outer", "ball"])
def test_a_ball_in_a_pit_is_pressed_by_its_depth_less(body: str, angle: float) -> None:
    """Q = κ(δ − depth)^{3/2}, at zero contact angle, δ = displacement − half the clearance."""
    pitted = dataclasses.replace(PERFECT, defects=(pit_below_first_ball(body, angle),))
    q = PRESSED * np.array([math.cos(angle), math.sin(angle), 0, 0, 0, 0])
    wanted = PERFECT.kappa * (PRESSED - PERFECT.clearance / 2 - DEPTH) ** 1.5
    # round-off of δ, a difference of millimetres
    assert pitted.ball_loads(q, angle)[0] == pytest.approx(wanted, rel=1e-9)
    assert pitted.turned(angle).ball_loads(q)[0] == pytest.approx(wanted, rel=1e-9)
    # and the pit is nowhere near the ball at angle 0
    there = PRESSED * np.array([1.0, 0, 0, 0, 0, 0])
    assert pitted.ball_loads(there)[0] > 1.2 * wanted


@pytest.mark.parametrize("body", ["inner", "outer", "ball"])
def test_a_ring_sinks_by_the_pit_at_the_angle_of_the_cage(body: str) -> None:
    """One ball carries a small radial load: the ring goes (Q/κ)^{2/3} + half the clearance + the depth."""
    pitted = dataclasses.replace(PERFECT, defects=(pit_below_first_ball(body, ANGLE),), clearance=60e-6)
    way = np.array([math.cos(ANGLE), math.sin(ANGLE), 0, 0, 0, 0])
    # the neighbours, 45° on, stay clear: the ring moves by 36 µm and they start at 30 µm/cos 45° = 42 µm
    wanted = (1.0 / pitted.kappa) ** (2 / 3) + 30e-6 + DEPTH
    app = Application()
    app.add("ring", RigidBody(1.0, (1e-3, 1e-3, 1e-3)))
    app.bearing("b", pitted, inner="ring.centre", outer="ground")
    # what holds the motions that one ball leaves free; 1e-7 of the contact's stiffness
    app.ground("ring.centre", stiffness=(1.0, 1.0, 1.0, 1.0, 1.0, 1.0))
    app.load("ring.centre", way)
    for found in (
        pitted.displacement(way, angle=ANGLE),
        pitted.turned(ANGLE).displacement(way),
        equilibrium(app, angle=ANGLE).displacement("ring.centre"),
    ):
        # the springs' share of the load, 4e-5 N in 1 N, moves the ring by 2/3 of that share of 1 µm
        assert found @ way == pytest.approx(wanted, rel=1e-6)
