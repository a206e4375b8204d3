"""The static state from any start, under any load and clearance, and what is said when there is none."""

from __future__ import annotations

import copy
import dataclasses
import math
import statistics
import time
from functools import cache

import motor as example
import numpy as np
import pytest

from bearingdyn.analysis import Equilibrium, equilibrium, frequency_response, modes, transient
from bearingdyn.analysis.static_balance import lost
from bearingdyn.application import Application
from bearingdyn.bearing import BallBearing, Pit, Waviness
from bearingdyn.parts import Layer, RigidBody
from rotors import BEARING, RUBBER, motor, motor_rubber


@cache
def built() -> Application:
    return example.motor(example.designs(motor_rubber())[2])


def layered_motor() -> Application:
    """The paper's motor with a layer around each outer ring, unloaded."""
    app = copy.copy(built())
    app.plan = copy.copy(app.plan)
    app.plan.loads, app.plan.bearings = [], dict(app.plan.bearings)
    return app


def loaded(rng: np.random.Generator) -> Application:
    """The motor under a random load from 1 N to 30 kN in any direction, and clearances up to 100 µm."""
    app = layered_motor()
    for place in ("shaft.middle", "shaft.left", "left_housing.bore"):
        direction = rng.standard_normal(5)
        size = 10 ** rng.uniform(0.0, 4.5)
        # about z the shaft turns freely
        force = size * direction[:3] / np.linalg.norm(direction)
        moment = 0.02 * size * direction[3:] / np.linalg.norm(direction)
        app.load(place, (*force, *moment, 0.0))
    for name, hung in app.plan.bearings.items():
        bearing = dataclasses.replace(hung.bearing, clearance=rng.uniform(0.0, 100e-6))
        app.plan.bearings[name] = dataclasses.replace(hung, bearing=bearing)
    return app


def unbalanced(state: Equilibrium) -> float:
    """Largest force left, as a share of the loads on it."""
    system = state.system
    g = np.concatenate([b.g for b in state.bearings.values()])
    left = system.stiffness() @ state.x + system.B.T @ g - system.static_load()
    # forces and moments of rigid bodies and modes together: scaled to accelerations by the mass
    scale = 1 / np.sqrt(np.diag(system.M))
    noise = 1e-15 * np.abs(scale * (np.abs(system.stiffness()) @ np.abs(state.x))).max()
    pressed = sum(b.loads.sum() for b in state.bearings.values())
    size = np.linalg.norm(scale * system.static_load()) + pressed * scale.max()
    return float(max(np.linalg.norm(scale * left) - noise, 0.0) / size)


@pytest.mark.parametrize("count", [100, pytest.param(1000, marks=pytest.mark.slow)])
def test_any_load_and_clearance_finds_its_balance(count):
    rng = np.random.default_rng(2024)
    seconds = []
    for _ in range(count):
        app = loaded(rng)
        began = time.process_time()
        state = equilibrium(app)
        seconds.append(time.process_time() - began)
        # every body of the motor is held: whatever the load, there is a balance, to Newton's tolerance
        assert unbalanced(state) < 1e-9
        assert all((b.loads >= 0).all() for b in state.bearings.values())
    print(
        f"{count} states, time of one core: median {1e3 * statistics.median(seconds):.1f} ms, "
        f"most {1e3 * max(seconds):.1f} ms"
    )


def test_the_state_is_the_same_from_any_start():
    rng = np.random.default_rng(7)
    states = [equilibrium(loaded(rng)) for _ in range(4)]
    wanted = equilibrium(loaded(np.random.default_rng(99)))
    for start in states:
        found = equilibrium(wanted.system, start=start)
        # both known to 1e-12 of what presses
        np.testing.assert_allclose(found.x, wanted.x, rtol=1e-6, atol=1e-9 * np.abs(wanted.x).max())


def test_a_start_of_another_application_is_refused():
    with pytest.raises(ValueError, match=r"start has \d+ coordinates"):
        equilibrium(layered_motor(), start=equilibrium(motor()))


def test_loads_unload_balls_one_by_one():
    """From pure axial, all balls, to radial, the loaded half: fewer and fewer carry."""
    counts = []
    for radial in (0.0, 300.0, 1e3, 1e4):
        app = layered_motor()
        app.load("shaft.middle", (0.0, -radial, 180.0, 0.0, 0.0, 0.0))
        counts.append(np.count_nonzero(equilibrium(app).bearings["left"].loads))
    assert counts[0] == 7
    assert counts[-1] < 7
    assert counts == sorted(counts, reverse=True)


@pytest.mark.parametrize("modulus", ["relaxed", "instantaneous"])
def test_layer_sags_by_the_modulus_asked_for(modulus):
    layer = Layer(0.036, 0.039, 0.019, RUBBER, moduli=(RUBBER.G0, RUBBER.G_instantaneous), refinement=0.5)
    app = Application()
    app.add("ring", RigidBody(1.0, (1e-3, 1e-3, 2e-3)))
    app.add("layer", layer)
    app.connect("ring.centre", "layer.inner")
    app.ground("layer.outer")
    app.load("ring.centre", (0, -20.0, 0, 0, 0, 0))
    state = equilibrium(app, modulus=modulus)
    rubber = dataclasses.replace(
        RUBBER, G0=getattr(RUBBER, {"relaxed": "G0"}.get(modulus, "G_instantaneous"))
    )
    k = dataclasses.replace(layer, material=rubber).stiffness(0.0)[1, 1].real
    # the layer's whole finite element model at a modulus of its shapes; the reduction adds nothing there
    assert state.displacement("ring.centre")[1] == pytest.approx(-20.0 / k, rel=1e-7)
    if modulus == "instantaneous":
        with pytest.raises(ValueError, match="a march starts with relaxed"):
            transient(state, speed=0.0, dt=1e-5, steps=1, record=[])


# ------------------------------------------------------------------- the turn


FLAWED = BallBearing(
    8,
    12.303e-3,
    52e-3,
    0.52,
    0.53,
    clearance=10e-6,
    waviness=[
        Waviness("inner", 5, 2e-6, phase=0.3),
        Waviness("inner", 2, 1e-6, direction="axial"),
        Waviness("outer", 3, 1.5e-6),
        Waviness("ball", 2, 1e-6, phase=0.4, ball=2),
    ],
    defects=[Pit("inner", 0.2, 1e-3, 5e-6), Pit("outer", 1.7, 2e-3, 5e-6), Pit("ball", 0.1, 2e-3, 5e-6)],
)


@pytest.mark.parametrize("angle", [0.0, 0.37, 2.9])
def test_a_turned_bearing_is_the_bearing_turned(angle):
    """Core's own turn of shaft, cage and balls against waves and pits moved to where it takes them."""
    q = np.array([3e-6, -8e-6, 20e-6, 1e-5, -2e-5, 0.0])
    np.testing.assert_allclose(
        FLAWED.turned(angle).ball_loads(q), _at(FLAWED, q, angle), rtol=1e-9, atol=1e-9
    )


def _at(bearing: BallBearing, q: np.ndarray, angle: float) -> np.ndarray:
    from bearingdyn import core

    shaft = angle / bearing.cage_ratio
    return core.bearing_force(
        bearing.kernel(), bearing.relative(q), np.zeros(5), bearing.angle0 + angle, 0.0, shaft
    )[3]


def rotor(bearing: BallBearing) -> Application:
    app = Application()
    app.add("rotor", RigidBody(2.0, (0.01, 0.01, 0.005)))
    app.bearing("b", bearing, inner="rotor.centre", outer="ground")
    app.load("rotor.centre", (30.0, -500.0, 200.0, 0, 0, 0))
    return app


def test_a_wavy_rotor_sits_where_the_bearing_by_itself_would_at_that_angle():
    for angle in (0.0, 0.5, 1.9):
        state = equilibrium(rotor(FLAWED), angle=angle)
        # two minimisations of one energy; `displacement` turns the shaft by its own way
        wanted = FLAWED.displacement((30.0, -500.0, 200.0, 0, 0, 0), angle=angle)
        np.testing.assert_allclose(state.displacement("rotor.centre"), wanted, rtol=1e-7, atol=1e-12)


def test_a_march_goes_on_from_where_the_shaft_was_turned_to():
    """A rotor turned slowly from angle 0 passes through the states of the angles on its way."""
    damped = dataclasses.replace(FLAWED, defects=())
    app = rotor(damped)
    app.ground("rotor.centre", damping=(2e3, 2e3, 2e3, 5.0, 5.0, 5.0))
    speed, dt = 0.05, 2e-3
    run = transient(
        equilibrium(app), speed=speed, dt=dt, steps=5000, record=["rotor.centre.x", "rotor.centre.y"]
    )
    reached = equilibrium(app, angle=damped.cage_ratio * speed * 5000 * dt).displacement("rotor.centre")[:2]
    # at 0.05 rad/s the dampers' drag has fallen to 1e-9 m, and in proportion to the speed
    np.testing.assert_allclose(run.record.values[-1], reached, atol=1e-9)


def test_tangents_may_be_averaged_over_a_ball_passage():
    app = motor()
    single = [equilibrium(app, angle=a * 2 * math.pi / 8 / 6) for a in range(6)]
    mean = equilibrium(app, average=6)
    for name in ("left", "right"):
        K = np.mean([s.bearings[name].K for s in single], axis=0)
        np.testing.assert_allclose(mean.bearings[name].K, K, rtol=1e-8, atol=1e-8 * np.abs(K).max())
    np.testing.assert_allclose(mean.x, single[0].x, rtol=1e-9, atol=1e-15)
    # under a vertical load through an upright ball x and y differ by more than their mean over a passage
    ask = ([200.0], ["shaft.end.x"], ["shaft.end.x"])
    both = [abs(frequency_response(s, *ask).response.values.item()) for s in (single[0], mean)]
    assert both[0] != both[1]
    with pytest.raises(ValueError, match="average is 0"):
        equilibrium(app, average=0)


# ------------------------------------------------------------------- no balance


def test_the_body_that_lost_its_support_is_named():
    system = equilibrium(motor()).system
    lever = np.linalg.pinv(system.rows("cap.centre"))[:, 2]
    assert lost(system, -3.0 * lever) == "'cap' finds no support along z: it has moved by -3 m there"


def test_a_search_that_ends_without_balance_says_who_lost_support(monkeypatch):
    from bearingdyn.bearing import energy_minimum as search

    monkeypatch.setattr(search, "_STEPS", 2)
    with pytest.raises(ArithmeticError, match=r"'\w+' finds no support along [xyz].*no equilibrium within 2"):
        equilibrium(motor())


def test_modes_follow_the_averaged_tangents():
    app = rotor(BEARING)
    mean = equilibrium(app, average=4)
    assert modes(mean).frequency.values[-1] > 0.0
