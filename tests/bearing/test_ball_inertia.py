"""Balls with inertia: the equilibrium of Jones and Harris against equations written out here."""

from __future__ import annotations

import dataclasses
import math

import numpy as np
import pytest

from bearingdyn.bearing import BallBearing, Running, Waviness
from bearingdyn.material import Elastic
from verified.closed_forms import inertia_forces, jones

RPM = math.pi / 30
# the 218 of Harris' examples: 40°, sixteen balls of 7/8 inch, osculation .5232
B218 = BallBearing(16, 22.225e-3, 125.26e-3, 0.5232, 0.5232, contact_angle=math.radians(40))
DEEP = BallBearing(9, 7.94e-3, 39.04e-3, 0.52, 0.53, clearance=10e-6)


def load(**components: float) -> np.ndarray:
    return np.array([components.get(name, 0.0) for name in ("Fx", "Fy", "Fz", "Mx", "My", "Mz")])


class TestJonesAndHarris:
    @pytest.mark.parametrize("axial", [8e3, 17.8e3, 44.5e3])
    def test_218_at_ten_thousand_turns(self, axial):
        running = Running(B218, 10_000 * RPM)
        balls = running.balls(running.displacement(load(Fz=axial)))
        a_i, a_o, Q_i, Q_o = jones(B218, 10_000 * RPM, axial)
        # two solutions of one set of equations: the root finder's 1e-12 over indentations of 1e-2 A
        np.testing.assert_allclose(balls.alpha_i, a_i, rtol=1e-8)
        np.testing.assert_allclose(balls.alpha_o, a_o, rtol=1e-8)
        np.testing.assert_allclose(balls.Q_i, Q_i, rtol=1e-8)
        np.testing.assert_allclose(balls.Q_o, Q_o, rtol=1e-8)
        F_c, M_g = inertia_forces(B218, 10_000 * RPM, a_i, a_o)
        np.testing.assert_allclose(balls.centrifugal, F_c, rtol=1e-8)
        np.testing.assert_allclose(balls.gyroscopic, M_g, rtol=1e-8)
        # thrown outwards: a steeper inner and a flatter outer contact
        assert a_o < math.radians(40) < a_i

    def test_sense_of_rotation_does_not_matter(self):
        f = load(Fx=3e3, Fz=17.8e3)
        there, back = (Running(B218, s * 10_000 * RPM).displacement(f) for s in (1, -1))
        np.testing.assert_allclose(there, back, rtol=1e-9, atol=1e-15)

    @pytest.mark.parametrize("brg", [B218, DEEP, dataclasses.replace(DEEP, film=0.3e-6)])
    @pytest.mark.parametrize("speed", [0.0, 1e-4])
    def test_off_is_on_at_zero_speed(self, brg, speed):
        C0 = brg.static_rating
        f = load(Fx=0.1 * C0, Fy=-0.05 * C0, Fz=0.2 * C0, My=0.02 * C0 * brg.arm)
        running = Running(brg, speed)
        q = brg.displacement(f, 0.1)
        np.testing.assert_allclose(running.displacement(f, 0.1), q, rtol=1e-7, atol=1e-12)
        # two springs in series are one, to the round-off of distances over indentations
        np.testing.assert_allclose(
            running.force(q, 0.1), brg.force(q, 0.1), rtol=1e-8, atol=1e-8 * C0 * brg.arm
        )
        K = brg.stiffness(q, 0.1)
        np.testing.assert_allclose(running.stiffness(q, 0.1), K, rtol=1e-6, atol=1e-7 * np.abs(K).max())
        balls = running.balls(q, 0.1)
        loads = brg.ball_loads(q, 0.1)
        np.testing.assert_allclose(balls.Q_i, loads, rtol=1e-7, atol=1e-9 * loads.max())
        np.testing.assert_allclose(balls.Q_o, loads, rtol=1e-7, atol=1e-9 * loads.max())
        held = loads > 0
        np.testing.assert_allclose(balls.alpha_i[held], balls.alpha_o[held], rtol=1e-6)

    @pytest.mark.parametrize("control", ["outer", "inner"])
    @pytest.mark.parametrize(
        ("brg", "speed", "f"),
        [
            (B218, 10_000 * RPM, load(Fx=5e3, Fy=1e3, Fz=17.8e3, Mx=40.0)),
            (DEEP, 2000.0, load(Fx=800.0, Fz=300.0, My=2.0)),
        ],
    )
    def test_tangent_is_the_derivative_of_the_force(self, brg, speed, f, control):
        running = Running(brg, speed, control)
        q = running.displacement(f, 0.2)
        np.testing.assert_allclose(running.force(q, 0.2), f, rtol=0, atol=1e-8 * np.abs(f).max())
        step = np.diag([1e-9, 1e-9, 1e-9, 1e-8, 1e-8, 1e-8])
        columns = [(running.force(q + d, 0.2) - running.force(q - d, 0.2)) / (2 * d.sum()) for d in step]
        scale = np.array([1, 1, 1, brg.arm, brg.arm, brg.arm])
        K = running.stiffness(q, 0.2) / np.outer(scale, scale)
        # second order in 1e-9 m over indentations of 1e-6 m and more, and balance to 1e-11 over 1e-9 m
        np.testing.assert_allclose(
            np.array(columns).T / np.outer(scale, scale), K, rtol=0, atol=2e-5 * np.abs(K).max()
        )

    def test_forces_on_every_ball_balance(self):
        # shared control, combined load: the balance of each ball, and of the ring, from what is reported
        running = Running(B218, 10_000 * RPM, "inner")
        f = load(Fx=5e3, Fz=17.8e3)
        q = running.displacement(f)
        b = running.balls(q)
        T = b.gyroscopic / B218.Dw
        axial = (
            b.Q_i * np.sin(b.alpha_i)
            + T * np.cos(b.alpha_i)
            - b.Q_o * np.sin(b.alpha_o)
            - T * np.cos(b.alpha_o)
        )
        radial = (
            b.Q_i * np.cos(b.alpha_i)
            - T * np.sin(b.alpha_i)
            - b.Q_o * np.cos(b.alpha_o)
            + T * np.sin(b.alpha_o)
        )
        # 1e-11 of the loads, some thousand N
        np.testing.assert_allclose(axial, 0, atol=1e-6)
        np.testing.assert_allclose(radial + b.centrifugal, 0, atol=1e-6)
        assert (b.Q_i * np.sin(b.alpha_i) + T * np.cos(b.alpha_i)).sum() == pytest.approx(17.8e3, rel=1e-9)

    def test_unloaded_balls_are_thrown_on_the_outer_race(self):
        running = Running(DEEP, 2000.0)
        b = running.balls(running.displacement(load(Fx=800.0)))
        away = b.Q_i == 0
        assert away.any()
        np.testing.assert_allclose(b.Q_o[away], b.centrifugal[away], rtol=1e-9)
        np.testing.assert_allclose(b.alpha_o[away], 0, atol=1e-9)

    @pytest.mark.parametrize("speed", [100 * RPM, 3000 * RPM, 10_000 * RPM])
    def test_radial_load_alone_on_an_angular_contact_bearing(self, speed):
        # it gives way along z until its contacts are radial; balls opposite are far from the inner race
        # alone it would have to be held by its neighbour: refused, unless it is said to have both shoulders
        running = Running(dataclasses.replace(B218, open_side=None), speed)
        f = load(Fx=20e3)
        q = running.displacement(f)
        np.testing.assert_allclose(running.force(q), f, atol=1e-5)
        b = running.balls(q)
        held = b.Q_i > 0
        assert 1 < held.sum() < 9
        np.testing.assert_allclose(b.alpha_i[held], 0, atol=1e-6)

    def test_ceramic_balls_are_thrown_less(self):
        ceramic = dataclasses.replace(B218, ball_material=Elastic(310e9, 0.26, 3200.0))
        spread = []
        for brg in (B218, ceramic):
            running = Running(brg, 10_000 * RPM)
            b = running.balls(running.displacement(load(Fz=17.8e3)))
            spread.append(b.alpha_i[0] - b.alpha_o[0])
        assert spread[1] < 0.6 * spread[0]

    @pytest.mark.parametrize(
        ("make", "field"),
        [
            (lambda: Running(DEEP, math.nan), "speed"),
            (lambda: Running(DEEP, 1.0, "cage"), "control"),
            (lambda: Running(dataclasses.replace(DEEP, oversize=(1e-6,) * 9), 1.0), "bearing"),
            (
                lambda: Running(dataclasses.replace(DEEP, waviness=(Waviness("inner", 3, 1e-7),)), 1.0),
                "bearing",
            ),
            (lambda: Running("6205", 1.0), "bearing"),
            (lambda: Running(DEEP, 1.0).displacement([1.0, 2.0]), "load"),
            (lambda: Running(DEEP, 1.0).force(np.zeros(6), math.inf), "angle"),
        ],
    )
    def test_bad_input_is_named(self, make, field):
        with pytest.raises(ValueError, match=f"{field} is "):
            make()
