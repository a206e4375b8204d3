"""Sets of bearings, clamped, askew and mirrored ones in an application, at rest and in motion."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

import bearingdyn as bd
from bearingdyn.bearing import BallBearing, Pair, Running, Triplet

ROW = BallBearing(13, 7.938e-3, 38.5e-3, 0.52, 0.53, contact_angle=math.radians(25), damping=30.0)
DEEP = BallBearing(9, 7.94e-3, 39.04e-3, 0.52, 0.53, clearance=10e-6)
EITHER = replace(ROW, open_side=None)
WIDTH = 15e-3
LOAD = (300.0, -200.0, 600.0, 3.0, -2.0, 0.0)


def rotor_on(bearing: object, load: tuple[float, ...] = (0.0,) * 6, **hung: object) -> bd.Application:
    app = bd.Application()
    app.add("rotor", bd.RigidBody(1.0, (1e-3, 1e-3, 1e-3), rotating=True))
    app.bearing("set", bearing, inner="rotor.centre", outer="ground", **hung)
    app.load("rotor.centre", load)
    return app


@pytest.mark.parametrize("row", [ROW, DEEP, EITHER])
@pytest.mark.parametrize("arrangement", ["DB", "DF"])
def test_a_pair_in_an_application_is_the_pair(row, arrangement):
    pair = Pair(row, arrangement, WIDTH, preload_force=200.0)
    eq = bd.equilibrium(rotor_on(pair, LOAD))
    q = pair.displacement(LOAD)
    size = np.array([1, 1, 1, row.arm, row.arm, 1])
    found = eq.displacement("rotor.centre")
    # the line of the work's list; both minimise to 1e-12 of the load
    np.testing.assert_allclose(found * size, q * size, rtol=0, atol=1e-9 * np.abs(q * size).max())
    for k, loads in enumerate(pair.ball_loads(q), 1):
        np.testing.assert_allclose(eq.bearings[f"set-{k}"].loads, loads, rtol=0, atol=1e-9 * loads.max())
    B = eq.system.B @ np.linalg.pinv(eq.system.rows("rotor.centre"))
    K = pair.stiffness(q)
    np.testing.assert_allclose(B.T @ eq.bearing_K @ B, K, rtol=0, atol=1e-8 * np.abs(K).max())


@pytest.mark.parametrize("arrangement", ["DBD", "DFD", "DTD"])
@pytest.mark.parametrize("mirrored", [False, True])
def test_a_triplet_in_an_application_is_the_triplet(arrangement, mirrored):
    """Hung the other way round (half a turn about x), it answers as to the load turned round."""
    held = Triplet(ROW, arrangement, WIDTH, preload=None if arrangement == "DTD" else 20e-6)
    turned = np.array([1, -1, -1, 1, -1, -1]) if mirrored else np.ones(6)
    load = np.array([0.0, 0.0, 600.0, 3.0, 0.0, 0.0])
    q = held.displacement(load)
    eq = bd.equilibrium(rotor_on(held, tuple(turned * load), mirrored=mirrored))
    size = np.array([1, 1, 1, ROW.arm, ROW.arm, 1])
    np.testing.assert_allclose(
        eq.displacement("rotor.centre") * size, turned * q * size, rtol=0, atol=1e-9 * np.abs(q * size).max()
    )


def test_a_triplet_shares_its_preload_and_its_stiffness():
    """The third row holds two: its axial force is twice theirs; stiffnesses add."""
    by_force = Triplet(ROW, "DBD", WIDTH, preload_force=300.0)
    thrust = [bd.equilibrium(rotor_on(by_force)).bearings[f"set-{k}"].force[2] for k in (1, 2, 3)]
    np.testing.assert_allclose(thrust, [150.0, 150.0, -300.0], rtol=1e-9)
    tandem, third = by_force.approaches
    by_spacer = Triplet(ROW, "DBD", WIDTH, preload=tandem + third)
    np.testing.assert_allclose(by_spacer.approaches, (tandem, third), rtol=1e-10)
    single = [ROW.stiffness([0, 0, s, 0, 0, 0])[2, 2] for s in (tandem, tandem, third)]
    assert by_force.stiffness([0.0] * 6)[2, 2] == pytest.approx(sum(single), rel=1e-12)


def test_the_march_of_a_pair_follows_it_quasi_statically():
    """A thrust that comes in 40 of the slowest periods ends where the pair stands."""
    pair = Pair(replace(ROW, damping=300.0), "DB", WIDTH, preload_force=200.0)
    app = rotor_on(pair)
    t = np.linspace(0.0, 0.05, 200)
    slow = 0.5 * (1 - np.cos(math.pi * np.minimum(t / 0.03, 1.0)))
    app.load("rotor.centre", LOAD, time=t, value=slow)
    names = [f"rotor.centre.{k}" for k in ("x", "y", "z")]
    found = bd.transient(app, speed=0.0, dt=2e-6, steps=25_000, record=names)
    q = pair.displacement(LOAD)[:3]
    end = found.record.values[-1]
    # the work's line; what the damped ring-down leaves is less
    np.testing.assert_allclose(end, q, rtol=0, atol=1e-6 * np.abs(q).max())


def test_thrust_reversal_passes_from_one_row_to_the_other_without_a_jump():
    """Of a preloaded DB pair: z is smooth in the thrust, its slope the compliance on either side."""
    pair = Pair(ROW, "DB", WIDTH, preload_force=200.0)
    thrust = np.linspace(-1500.0, 1500.0, 61)
    states = [bd.equilibrium(rotor_on(pair, (0, -50.0, F, 0, 0, 0))) for F in thrust]
    z = np.array([s.displacement("rotor.centre")[2] for s in states])
    slope = np.diff(z) / np.diff(thrust)
    K = pair.stiffness([0.0] * 6)[2, 2]
    # 2.83 of the preload open one row, and the other, pressed as hard, is softer than both: 1.28 is found. A
    # step of 50 N from there changes the slope by .11 of itself
    assert (slope > 0).all()
    assert 1 / K < slope.max() < 1.4 / K
    assert np.abs(np.diff(slope)).max() < 0.15 * slope.max()
    np.testing.assert_allclose(z, -z[::-1], rtol=0, atol=1e-9 * z.max())
    carried = np.array([[s.bearings[f"set-{k}"].force[2] for k in (1, 2)] for s in states])
    np.testing.assert_allclose(carried.sum(axis=1), thrust, rtol=0, atol=1e-6)
    assert carried[0, 1] < -1400 < carried[0, 0] == pytest.approx(0, abs=20.0)
    assert carried[-1, 0] > 1400 > carried[-1, 1] == pytest.approx(0, abs=20.0)


def test_the_march_of_a_reversal_has_no_jump():
    pair = Pair(replace(ROW, damping=300.0), "DB", WIDTH, preload_force=200.0)
    app = rotor_on(pair)
    app.load("rotor.centre", (0, 0, 500.0, 0, 0, 0), time=[0, 1e-2, 3e-2], value=[0, 1.0, -1.0])
    app.ground("rotor.centre", stiffness=[0] * 6, damping=[0, 0, 0, 0.1, 0.1, 0])
    found = bd.transient(app, speed=100.0, dt=5e-6, steps=6000, record=["rotor.centre.z"])
    z = found.record.values[:, 0]
    assert z.max() > 2e-6
    assert z.min() < -2e-6
    static = [pair.displacement([0, 0, F, 0, 0, 0])[2] for F in (500.0, -500.0)]
    # at the turn of the ramp it swings over by .6 %
    assert z.max() == pytest.approx(static[0], rel=0.01)
    assert z.min() == pytest.approx(static[1], rel=0.01)
    # the ramp of 50 kN/s turns round at 10 ms: it swings to three times its rate, the soft slope 1.3 times
    # the stiff one; 2.8 are found
    steady = 500.0 / 1e-2 / pair.stiffness([0.0] * 6)[2, 2] * 5e-6
    assert np.abs(np.diff(z[200:])).max() < 4 * steady


@pytest.mark.parametrize("means", ["spacer", "force", "spring"])
def test_preload_by_spacer_force_or_spring(means):
    """Three ways to 200 N between two angular contact bearings; a soft spring keeps it under thrust."""
    lift = Pair(ROW, "DB", WIDTH, preload_force=200.0).approach
    app = bd.Application()
    app.add("rotor", bd.RigidBody(1.0, (1e-3, 1e-3, 1e-3), rotating=True))
    app.add("ring", bd.RigidBody(0.1, (1e-5, 1e-5, 1e-5)))
    slides = [1e9, 1e9, 0.0, 1e6, 1e6, 1e6]
    if means == "spacer":
        app.ground("ring.centre")
    elif means == "force":
        app.ground("ring.centre", slides)
        app.load("ring.centre", (0, 0, 200.0, 0, 0, 0))
    else:
        slides[2] = 5e4
        app.ground("ring.centre", slides, offset=[0, 0, 200.0 / 5e4, 0, 0, 0])
    moved = 2 * lift if means == "spacer" else 0.0
    app.bearing("fixed", ROW, inner="rotor.centre", outer="ground", offset=moved)
    app.bearing("pushed", ROW, mirrored=True, inner="rotor.centre", outer="ring.centre")
    eq = bd.equilibrium(app)
    thrust = {name: b.force[2] for name, b in eq.bearings.items()}
    # the soft spring gives way by some 20 µm of its 4 mm
    assert thrust["fixed"] == pytest.approx(200.0, rel=1e-9 if means != "spring" else 1e-2)
    assert thrust["pushed"] == pytest.approx(-thrust["fixed"], rel=1e-9)
    app.load("rotor.centre", (0, 0, 100.0, 0, 0, 0))
    loaded = bd.equilibrium(app).bearings
    if means == "spacer":  # stiff against stiff: the thrust is shared
        assert 240 < loaded["fixed"].force[2] < 260
    else:
        assert loaded["fixed"].force[2] == pytest.approx(300.0, rel=1e-2)
        assert loaded["pushed"].force[2] == pytest.approx(-200.0, rel=1e-2)


def test_rings_that_clamp_their_balls():
    """−Pd/2 on every ball; centred, κ(Pd/2)^{3/2}, and the closed form of the radial stiffness."""
    clamped = replace(DEEP, clearance=-8e-6)
    Q = clamped.kappa * (4e-6) ** 1.5
    np.testing.assert_allclose(clamped.ball_loads([0.0] * 6), Q, rtol=1e-12)
    K = clamped.stiffness([0.0] * 6)
    A, Kn = clamped.geometry.A, 1.5 * clamped.kappa * (4e-6) ** 0.5
    assert K[0, 0] == pytest.approx(9 / 2 * Kn, rel=1e-12)  # α = 0
    assert K[2, 2] == pytest.approx(9 * Q / (A + 4e-6), rel=1e-12)
    eq = bd.equilibrium(rotor_on(clamped))
    np.testing.assert_allclose(eq.bearings["set"].loads, Q, rtol=1e-9)
    # a radial load below half of 9/2 Kn · 4 µm, 668 N, leaves no ball free
    q = clamped.displacement([0, -300.0, 0, 0, 0, 0])
    assert (clamped.ball_loads(q) > 0).all()
    np.testing.assert_allclose(clamped.force(q), [0, -300.0, 0, 0, 0, 0], atol=1e-6)
    # the more it is clamped the stiffer: from loose to tight without a jump
    play = np.array([2e-6, 1e-8, 0.0, -1e-8, -2e-6])
    y = [replace(DEEP, clearance=float(p)).displacement([0, -500.0, 0, 0, 0, 0])[1] for p in play]
    assert (np.diff(y) > 0).all()
    assert abs(y[2] - y[1]) < 2e-8
    with pytest.raises(ValueError, match=r"clearance is -0.0002; it must be at least -Dw/50, -0.0001588 m"):
        replace(DEEP, clearance=-2e-4)


@pytest.mark.parametrize("body", ["inner", "outer"])
def test_a_ring_that_sits_askew_is_the_ring_tilted(body):
    """At rest: the forces of a bearing whose inner ring is tilted, or whose outer ring is, the other way."""
    tilt = (1e-3, -5e-4)
    sign = 1 if body == "inner" else -1
    askew = DEEP.misaligned(**{body: tilt})
    q = np.array([1e-6, -2e-5, 3e-5, 2e-4, 1e-4, 0.0])
    tilted = q + sign * np.array([0, 0, 0, *tilt, 0])
    # the wave is an axial displacement of the groove, as the tilt is: equal to round-off
    np.testing.assert_allclose(askew.ball_loads(q), DEEP.ball_loads(tilted), rtol=1e-9, atol=1e-9)
    np.testing.assert_allclose(askew.force(q), DEEP.force(tilted), rtol=1e-8, atol=1e-6)


def test_an_askew_inner_ring_turns_with_the_shaft_and_an_outer_one_stands():
    """A held rotor tilts at the shaft's frequency by the inner ring, and stands tilted by the outer."""
    speed, amplitude = 2 * math.pi * 50.0, {}
    for body in ("inner", "outer"):
        ball = replace(DEEP, damping=100.0).misaligned(**{body: (1e-3, 0.0)})
        app = rotor_on(ball, (0, 0, 500.0, 0, 0, 0))
        app.ground("rotor.centre", [0, 0, 0, 300.0, 300.0, 0], [10, 10, 10, 1.0, 1.0, 0])
        found = bd.transient(app, speed=speed, dt=2e-5, steps=4000, record=["rotor.centre.rx"], settle=1000)
        tilt = found.record.values[:2000, 0]  # two turns
        line = np.fft.rfft(tilt) / tilt.size
        amplitude[body] = abs(line[0].real), 2 * abs(line[2])
    still, turning = amplitude["inner"]
    assert turning > 100 * still
    still, turning = amplitude["outer"]
    assert still > 100 * turning


def test_the_cage_of_an_axially_loaded_6202_is_faster_than_its_ratio():
    """Reference §4.5: BPFO 253.96 Hz by the constant ratio, 256.63 by loaded angles and inertia."""
    steel = bd.Elastic(207e9, 0.3, 7850.0)
    ball = BallBearing(
        8, 5.953e-3, 25e-3, 0.52, 0.53, clearance=10e-6, material=steel, ball_material=steel, damping=100.0
    )
    speed = 5000 * math.pi / 30
    app = rotor_on(ball, (0, 0, 180.0, 0, 0, 0))
    eq = bd.equilibrium(app)
    by = {"nominal": eq.system.bearings[0].bearing, "loaded": None}
    moved = bd.with_loaded_cages(eq, speed)
    by["loaded"] = moved.system.bearings[0].bearing
    bpfo = {name: b.Z * b.cage_ratio * speed / (2 * math.pi) for name, b in by.items()}
    assert bpfo["nominal"] == pytest.approx(253.96, abs=0.01)
    # outer race control, ours, and inner race control, 0.033 Hz apart: the reference lies between
    balls = Running(replace(ball, damping=0.0), speed, "inner")
    inner = 8 * balls.balls(balls.displacement((0, 0, 180.0, 0, 0, 0))).orbit.mean() / (2 * math.pi)
    assert inner < 256.63 < bpfo["loaded"] < inner + 0.04
    assert bd.cage_ratios(eq, speed)["set"] == by["loaded"].cage_ratio


def test_a_march_has_the_line_of_the_loaded_cage():
    """A pit in the outer race: its line stands at Z times the cage of the loaded balls."""
    speed = 5000 * math.pi / 30
    ball = BallBearing(
        8, 5.953e-3, 25e-3, 0.52, 0.53, clearance=10e-6, damping=100.0,
        defects=[bd.Pit("outer", 0.0, 0.5e-3, 1e-6)],
    )  # fmt: skip
    app = rotor_on(ball, (0, -20.0, 180.0, 0, 0, 0))
    app.ground("rotor.centre", [1e4, 1e4, 0, 1e3, 1e3, 0], [100, 100, 100, 0.1, 0.1, 0])
    eq = bd.with_loaded_cages(bd.equilibrium(app), speed)
    found = bd.transient(
        eq, speed=speed, dt=2.4e-6, steps=84_000, settle=16_000, record=["rotor.centre.x.acceleration"],
        decimate=4,
    )  # fmt: skip
    x = found.record.values[:, 0]
    size = np.abs(np.fft.rfft((x - x.mean()) * np.hanning(x.size), 8 * x.size))
    f = np.fft.rfftfreq(8 * x.size, 9.6e-6)
    near = (f > 245) & (f < 265)
    line = f[near][size[near].argmax()]
    own = eq.system.bearings[0].bearing
    assert line == pytest.approx(8 * own.cage_ratio * speed / (2 * math.pi), abs=0.5)
    assert abs(line - 253.96) > 2


def test_the_balls_that_are_pressed_drive_the_cage():
    """Of nine balls four are pressed, to .3987 and .3988; all nine have a mean of .4031."""
    app = rotor_on(DEEP, (0, -500.0, 50.0, 0, 0, 0))
    app.ground("rotor.centre", [0, 0, 0, 1e5, 1e5, 0])
    eq, speed = bd.equilibrium(app), 500.0
    running = Running(DEEP, speed)
    balls = running.balls(running.displacement(DEEP.coefficients().T @ eq.bearings["set"].g))
    orbit, pressed = balls.orbit / speed, balls.Q_i > 0
    assert pressed.sum() == 4
    assert (
        orbit[pressed].min() < bd.cage_ratios(eq, speed)["set"] < orbit[pressed].max() < orbit.mean() - 3e-3
    )


def test_a_cage_that_no_ball_drives_keeps_its_nominal_ratio():
    """1 µm of clamping, 3000 rad/s: the balls are thrown off the inner race, and nothing else loads them."""
    clamped = replace(DEEP, clearance=-1e-6)
    eq = bd.equilibrium(rotor_on(clamped))
    assert (eq.bearings["set"].loads > 0).all()
    fast = Running(clamped, 3000.0)
    assert not fast.balls(fast.displacement([0.0] * 6)).Q_i.any()
    assert bd.cage_ratios(eq, 3000.0)["set"] == clamped.cage_ratio
    assert bd.cage_ratios(eq, 300.0)["set"] == pytest.approx(clamped.cage_ratio, rel=1e-6)


@pytest.mark.parametrize("turning", ["inner", "outer", (1.0, -0.5)])
def test_loaded_cages_know_which_ring_turns(turning):
    """Slowly, the formula ½[ω_i(1 − γ) + ω_o(1 + γ)] at the loaded angle."""
    ball = replace(DEEP, turning=turning)
    app = bd.Application()
    app.add("rotor", bd.RigidBody(1.0, (1e-3, 1e-3, 1e-3)))
    app.bearing("b", ball, inner="rotor.centre", outer="ground")
    app.load("rotor.centre", (0, 0, 500.0, 0, 0, 0))
    eq = bd.equilibrium(app)
    angle = float(np.mean(Running(DEEP, 1.0).balls(DEEP.displacement([0, 0, 500.0, 0, 0, 0])).alpha_i))
    gamma = 7.94 / 39.04 * math.cos(angle)
    inner, outer = ball.ring_speeds
    expected = 0.5 * (inner * (1 - gamma) + outer * (1 + gamma))
    assert bd.cage_ratios(eq, 1.0)["b"] == pytest.approx(expected, rel=1e-6)
    moved = bd.with_loaded_cages(eq, 1.0).system.bearings[0].bearing
    assert moved.cage_ratio == pytest.approx(expected, rel=1e-6)


def test_bad_input_is_named():
    with pytest.raises(ValueError, match="speed is 0"):
        bd.cage_ratios(bd.equilibrium(rotor_on(DEEP, (0, -9.0, 0, 0, 0, 0))), 0.0)
    with pytest.raises(ValueError, match="mirrored is 2; it must be True or False"):
        rotor_on(ROW, mirrored=2)
    with pytest.raises(ValueError, match="arrangement is 'DBX'"):
        Triplet(ROW, "DBX", WIDTH)
    with pytest.raises(ValueError, match="tandem has no preload"):
        Triplet(ROW, "DTD", WIDTH, preload=1e-6)
    with pytest.raises(ValueError, match="tilt of the inner ring"):
        DEEP.misaligned(inner=(1.0,))
    app = rotor_on(Pair(ROW, "DB", WIDTH, preload_force=10.0))
    with pytest.raises(ValueError, match="'set-1': the name is taken"):
        app.bearing("set", Pair(ROW, "DB", WIDTH), inner="rotor.centre", outer="ground")
    assert "set-2: rotor.centre in ground, 13 balls, at 0.0075 m" in app.summary()
