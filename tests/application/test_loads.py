"""Gravity, a moving ground, preload by displacement, springs between parts, temperature of layers."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from bearingdyn.analysis import equilibrium, frequency_response, modes, transient
from bearingdyn.application import Application
from bearingdyn.bearing import BallBearing
from bearingdyn.cms import Superelement
from bearingdyn.fem import Section
from bearingdyn.material import STEEL, WLF, Maxwell, RhoT
from bearingdyn.parts import Housing, Layer, RigidBody, Ring, Shaft, damping_sample
from rotors import BEARING, RUBBER, motor, oscillator

WARM = Maxwell(
    G0=1e6,
    G=[2e6, 3e6],
    tau=[1e-3, 1e-4],
    eta0=3.0,
    K=2e9,
    density=1200.0,
    law=WLF(8.0, 120.0, 20.0),
    vertical=RhoT(20.0),
)
SMALL = Housing(0.08, 0.09, 0.02, 0.04, f_max=8e3, element_size=0.02)


# ------------------------------------------------------------------- rigid motion, gravity


@pytest.mark.parametrize(
    ("part", "arm"),
    [
        (Shaft([Section(0.2, 0.02)], seats={"left": 0.02, "right": 0.18}, f_max=2e4), 0.16),
        (Layer(0.026, 0.028, 0.016, RUBBER), 0.0),
        (Ring(0.02, 0.03, 0.01, f_max=6e4), 0.0),
        (damping_sample(RUBBER, f_max=12e3), 0.0),
        (SMALL, 0.045),
    ],
)
def test_a_part_moves_rigidly_without_force(part, arm):
    app = Application()
    app.add("part", part)
    R, element = app.plan.rigid_shapes("part"), app.plan.parts["part"]
    assert R is not None
    K = element.K + 1e6 * sum((t.H for t in element.viscoelastic), np.zeros_like(element.K))
    # round-off of the reduction
    assert np.abs(K @ R).max() < 1e-9 * np.abs(K).max()
    # mass as drawn, and turning about the first interface carries the second along its arm
    second = list(element.interfaces.values())[1]
    if arm == 0.16:  # along z: θy moves x
        assert R[second[0], 4] == pytest.approx(arm, rel=1e-9)
    elif arm:  # the feet lie below the bore: θz moves them along x
        assert R[second[0], 5] == pytest.approx(arm, rel=1e-9)
    np.testing.assert_allclose(R[second[:3], :3], np.eye(3), atol=1e-9)
    mass = R[:, 1] @ element.M @ R[:, 1]
    if isinstance(part, Layer):
        assert mass == pytest.approx(1200 * math.pi * (0.028**2 - 0.026**2) * 0.016, rel=1e-6)


def test_a_shaft_sags_under_its_own_weight():
    """Midspan sag of a beam on two pins, 5qL⁴/384EI + qL²/8κGA (Timoshenko)."""
    L, d = 0.6, 0.02
    shaft = Shaft([Section(L, d)], seats={"left": 0.0, "right": L}, points={"middle": L / 2}, f_max=3e4)
    app = Application()
    app.add("shaft", shaft)
    for end in ("left", "right"):
        app.ground(f"shaft.{end}", stiffness=(1e14, 1e14, 1e14, 0, 0, 1e8))
    app.gravity((0, -9.81, 0))
    sag = equilibrium(app).displacement("shaft.middle")[1]
    A, second, nu = math.pi * d**2 / 4, math.pi * d**4 / 64, STEEL.nu
    q = STEEL.density * A * 9.81
    kappa = 6 * (1 + nu) ** 2 / (7 + 12 * nu + 4 * nu**2)
    wanted = 5 * q * L**4 / (384 * STEEL.E * second) + q * L**2 / (8 * kappa * STEEL.G * A)
    # the modes above 30 kHz are left out; each adds n⁻⁵ of the sag
    assert -sag == pytest.approx(wanted, rel=1e-4)


def test_bearings_carry_the_weight_of_what_hangs_in_them():
    app = motor()
    app.plan.loads.clear()
    app.load("cap.centre", (0, 0, 180.0, 0, 0, 0))
    app.gravity((0.0, -9.81, 0.0))
    state = equilibrium(app)
    weight = app.mass("shaft") * 9.81
    held = sum(b.g[1] for b in state.bearings.values())
    # force known to 1e-12 of all that presses
    assert held == pytest.approx(-weight, rel=1e-8)
    # and the block's springs the rest on its side: ring, layer and its own
    below = -1e8 * state.displacement("block.centre")[1]
    own = sum(app.mass(p) for p in ("ring", "layer", "block")) * 9.81
    assert below == pytest.approx(own - state.bearings["left"].g[1], rel=1e-8)


def test_a_part_that_holds_itself_takes_no_gravity():
    class Held:
        def superelement(self) -> Superelement:
            return Superelement(
                M=np.eye(6),
                C=np.zeros((6, 6)),
                G=np.zeros((6, 6)),
                K=1e6 * np.eye(6),
                interfaces={"a": np.arange(6)},
            )

    app = Application()
    app.add("post", Held())
    app.free("post.a")
    app.gravity((0, -9.81, 0))
    with pytest.raises(ValueError, match="'post' has no rigid motion of its own"):
        equilibrium(app)


# ------------------------------------------------------------------- moving ground


def test_transmissibility_of_a_single_mass_has_the_closed_form():
    m, c, k = 2.0, 40.0, 5e5
    f = np.array([0.0, 5.0, 79.6, 400.0])
    w = 2 * math.pi * f
    wanted = (k + 1j * w * c) / (k - m * w**2 + 1j * w * c)
    for quantity in ("displacement", "velocity", "acceleration"):
        found = frequency_response(
            oscillator(m, c, k), f, ["ground.y"], ["body.centre.y", "body.centre.x"], quantity=quantity
        ).response.values[:, :, 0]
        # round-off of the solution, of which 1 is taken
        np.testing.assert_allclose(found[:, 0], wanted, rtol=1e-11)
        assert not found[:, 1].any()


def test_a_moving_ground_is_a_ground_part_of_huge_mass():
    """The same transmissibility by a second way: all grounds on a body of 1e6 kg that a force moves."""
    f = np.array([20.0, 300.0, 1500.0])
    outputs = ["shaft.end.y", "ring.centre.y", "block.centre.y"]
    moved = frequency_response(equilibrium(motor()), f, ["ground.y"], outputs).response.values[:, :, 0]

    app, heavy = motor(), 1e6
    app.add("floor", RigidBody(heavy, (1e8,) * 3))
    app.ground("floor.centre", stiffness=(1e7,) * 6)
    for name, support in list(app.plan.supports.items()):
        if str(name) != "floor.centre":
            del app.plan.supports[name]
            app.spring(str(name), "floor.centre", support.stiffness, support.damping)
    state = equilibrium(app)
    found = frequency_response(state, f, ["floor.centre.y"], [*outputs, "floor.centre.y"]).response.values
    # the static states differ by round-off of the floor's soft spring; the floor feels 1e-5 of its own mass
    np.testing.assert_allclose(found[:, :3, 0] / found[:, 3:, 0], moved, rtol=1e-4)


def test_march_and_harmonic_response_agree_on_a_moving_ground():
    """Steady motion under a ground acceleration of 50 Hz, against the response to "ground.y"."""
    f0, dt, a = 50.0, 2e-5, 1e-2
    per = round(1 / (f0 * dt))
    app = motor()
    app.base_motion((0.0, a, 0.0), frequency=f0)
    state = equilibrium(app)
    slowest = -modes(state, damped=True).eigenvalue.values.real.max()
    settle = per * math.ceil(12.0 / slowest / dt / per)  # e^{-12}
    out = ["shaft.end.y", "block.centre.y"]
    run = transient(state, speed=0.0, dt=dt, steps=4 * per, settle=settle, record=out)
    n = np.arange(1, 4 * per + 1)
    record = run.record.values - run.record.values.mean(axis=0)
    marched = 2 * np.mean(record * np.exp(-2j * math.pi * n / per)[:, None], axis=0)
    w = 2 * math.pi * f0
    H = frequency_response(state, [f0], ["ground.y"], out).response.values[0, :, 0]
    # recorded motions are relative to the ground, whose own is −a/ω²
    wanted = (H - 1.0) * (-a / w**2)
    # (ωΔt)²/12 = 3e-6; the transient's end e^{-12}; 1 µm/s² on balls pressed by 180 N: nonlinearity 1e-4
    np.testing.assert_allclose(marched, wanted, rtol=1e-3)


def test_force_on_the_ground_closes_the_balance():
    """The force on the ground is that of spring and damper; on a moving ground, the inertia of the mass."""
    m, c, k = 2.0, 40.0, 5e5
    f = np.array([0.0, 30.0, 200.0])
    w = 2 * math.pi * f
    found = frequency_response(
        oscillator(m, c, k),
        f,
        ["body.centre.y", "ground.y"],
        ["body.centre.force.y"],
        quantity="acceleration",
    ).response.values[:, 0]
    H = 1 / (k - m * w**2 + 1j * w * c)
    np.testing.assert_allclose(found[:, 0], (k + 1j * w * c) * H, rtol=1e-11)
    # the mass follows with T ü, and its inertia m T ü presses on the ground with the other sign
    np.testing.assert_allclose(found[:, 1], -m * (k + 1j * w * c) * H, rtol=1e-11)


def test_a_rigid_support_bears_what_the_part_puts_on_it():
    app = layered(RUBBER)
    f = np.array([10.0, 900.0])
    found = frequency_response(
        equilibrium(app),
        f,
        ["ring.centre.y"],
        ["ground.layer.outer.y", "layer.outer.force.y", "layer.inner.force.y", "ring.centre.y"],
    ).response.values[:, :, 0]
    np.testing.assert_array_equal(found[:, 0], found[:, 1])
    # all of the unit force but the inertia of the ring arrives at the layer
    np.testing.assert_allclose(-found[:, 2], 1.0 + (2 * math.pi * f) ** 2 * found[:, 3], rtol=1e-9)
    # slowly, all of it at the ground
    assert found[0, 0] == pytest.approx(1.0, rel=1e-3)


def test_force_through_layer_bearing_and_supports_is_that_of_the_bodies_between():
    state = equilibrium(motor())
    f = np.array([40.0, 700.0, 3000.0])
    w2 = (2 * math.pi * f) ** 2
    outputs = ["left.force.y", "right.force.y", "layer.outer.force.y", "layer.inner.force.y"]
    motions = ["block.centre.y", "cap.centre.y", "ring.centre.y"]
    H = frequency_response(state, f, ["shaft.end.y"], outputs + motions).response.values[:, :, 0]
    left, right, outer, inner, block, cap, ring = H.T
    C = 1e3 * 1j * 2 * math.pi * f
    # Newton's law of the cap, the ring and the block, each a rigid body
    np.testing.assert_allclose(right, (1e9 + C - 1.0 * w2) * cap, rtol=1e-9)
    mass = RigidBody.ring(0.03, 0.036, 0.019).mass
    np.testing.assert_allclose(left + inner, -mass * w2 * ring, rtol=1e-7)
    np.testing.assert_allclose(outer, (1e8 + C - 5.0 * w2) * block, rtol=1e-9)
    # and the force from the shaft's own side
    shaft = frequency_response(state, f, ["shaft.end.y"], ["shaft.left.force.y"]).response.values[:, 0, 0]
    np.testing.assert_allclose(shaft, left, rtol=1e-7)


@pytest.mark.parametrize(
    ("inputs", "outputs", "message"),
    [
        (["ground.θx"], ["ring.centre.y"], "the ground moves along"),
        (["shaft.end.y"], ["left.force.θx"], "bearing 'left' offers"),
        (["shaft.end.y"], ["layer.middle.force.y"], r"'layer' has \['inner', 'outer'\]"),
        (["shaft.end.y"], ["axle.a.force.y"], "neither a bearing nor an interface"),
        (["shaft.end.y"], ["layer.inner.force.w"], "not 'w'"),
        (["shaft.end.y"], ["ground.ring.centre.y"], "'ring.centre' is no interface that the ground holds"),
    ],
)
def test_unknown_forces_are_named(inputs, outputs, message):
    with pytest.raises(ValueError, match=message):
        frequency_response(equilibrium(motor()), [10.0], inputs, outputs)


# ------------------------------------------------------------------- preload, springs


def test_a_pressed_spring_shares_its_offset_with_what_it_presses():
    app = Application()
    app.add("body", RigidBody(1.0, (1e-3,) * 3))
    app.ground("body.centre", stiffness=(3e6,) * 6, offset=(0, 0, 1e-4, 0, 0, 0))
    app.spring("body.centre", "ground", (1e6,) * 6, (5.0,) * 6)
    state = equilibrium(app)
    # two springs in series: 1e-4·3/(3 + 1)
    np.testing.assert_allclose(state.displacement("body.centre"), [0, 0, 7.5e-5, 0, 0, 0], atol=1e-15)
    assert modes(app).frequency.values[0] == pytest.approx(math.sqrt(4e6) / (2 * math.pi), rel=1e-12)
    # and its dampers
    assert modes(app, damped=True).damping_ratio.values[0] == pytest.approx(
        5.0 / (2 * math.sqrt(4e6)), rel=1e-9
    )


def opposed(offset: float = 0.0, force: float = 0.0) -> Application:
    """A stiff shaft between two bearings; the right outer ring is free along z if a force presses it."""
    app = Application()
    app.add("shaft", Shaft([Section(0.2, 0.06)], seats={"left": 0.05, "right": 0.15}, f_max=2e3))
    app.add("block", RigidBody(1.0, (0.01,) * 3))
    app.ground("block.centre", stiffness=(1e12, 1e12, 0.0 if force else 1e13, 1e9, 1e9, 1e9))
    # thicker than the bearings' bore, so that it is stiff
    app.bearing("left", BEARING, inner="shaft.left", outer="ground", fits=False)
    app.bearing("right", BEARING, inner="shaft.right", outer="block.centre", offset=offset, fits=False)
    if force:
        app.load("block.centre", (0, 0, force, 0, 0, 0))
    return app


def test_bearings_preloaded_by_displacement_carry_the_force_that_the_same_displacement_takes():
    pressed = equilibrium(opposed(force=180.0))
    moved = float(pressed.displacement("block.centre")[2])
    # the ring moved along z by `moved` is the inner ring moved the other way
    preloaded = equilibrium(opposed(offset=-moved))
    for name, sign in (("left", 1.0), ("right", -1.0)):
        # the block's own spring of 1e13 N/m gives way by 2e-11 of 2e-4 m
        assert preloaded.bearings[name].g[2] == pytest.approx(sign * 180.0, rel=1e-6)
        np.testing.assert_allclose(preloaded.bearings[name].K, pressed.bearings[name].K, rtol=1e-5, atol=1.0)
    run = transient(preloaded, speed=0.0, dt=1e-5, steps=200, record=["left.force.z", "shaft.left.z"])
    # the march begins in balance and stays
    np.testing.assert_allclose(run.record.values[:, 0], preloaded.bearings["left"].g[2], rtol=1e-9)


def test_a_spring_between_parts_acts_on_their_relative_motion():
    app = Application()
    for name, mass in (("a", 1.0), ("b", 3.0)):
        app.add(name, RigidBody(mass, (1e-3,) * 3))
    app.spring("a.centre", "b.centre", (4e5,) * 6)
    found = modes(app).frequency.values
    # reduced mass ¾ kg; the pair by itself is free
    assert found[found > 1.0][0] == pytest.approx(math.sqrt(4e5 / 0.75) / (2 * math.pi), rel=1e-12)
    assert "a.centre = b.centre (springs and dampers)" in app.summary()


# ------------------------------------------------------------------- temperature


def layered(material: Maxwell) -> Application:
    app = Application()
    app.add("ring", RigidBody(1.0, (1e-3, 1e-3, 2e-3)))
    app.add("layer", Layer(0.036, 0.039, 0.019, material, moduli=(1e6, 6e6), refinement=0.5))
    app.connect("ring.centre", "layer.inner")
    app.ground("layer.outer")
    app.load("ring.centre", (0, -20.0, 0, 0, 0, 0))
    return app


def test_a_layer_at_temperature_is_the_layer_of_the_shifted_material():
    app, other = layered(WARM), layered(WARM.at(45.0))
    app.temperature("layer", 80.0)
    app.temperature("layer", 45.0)  # the last word counts
    assert "45 °C" in app.summary()
    a, b = equilibrium(app), equilibrium(other)
    np.testing.assert_allclose(a.x, b.x, rtol=1e-9, atol=1e-16)
    # rubber elasticity: stiffer when warm by T/T0, and the sag smaller
    cold = equilibrium(layered(WARM)).displacement("ring.centre")[1]
    assert a.displacement("ring.centre")[1] / cold == pytest.approx(293.15 / 318.15, rel=0.03)
    ask = ([300.0, 2000.0], ["ring.centre.y"], ["ring.centre.y"])
    np.testing.assert_allclose(
        frequency_response(a, *ask).response.values, frequency_response(b, *ask).response.values, rtol=1e-9
    )
    np.testing.assert_allclose(
        modes(a, damped=True).eigenvalue.values, modes(b, damped=True).eigenvalue.values, rtol=1e-7
    )
    arguments = {
        "speed": 0.0,
        "dt": 1e-5,
        "steps": 50,
        "record": ["ring.centre.y"],
        "initial": {"ring.centre": np.zeros(6)},
    }
    np.testing.assert_allclose(
        transient(a, **arguments).record.values, transient(b, **arguments).record.values, rtol=1e-8
    )


# ------------------------------------------------------------------- input, summary


def test_summary_names_what_nothing_holds():
    assert motor().summary().endswith("free motions\n  shaft θz")
    app = Application()
    app.add("rotor", RigidBody(2.0, (0.01, 0.01, 0.015), rotating=True))
    app.add("disc", RigidBody(1.0, (0.01, 0.01, 0.015), rotating=True))
    app.connect("rotor.centre", "disc.centre")
    app.ground("rotor.centre", stiffness=(1e6, 1e6, 0, 1e3, 1e3, 0))
    lines = app.summary().splitlines()
    assert lines[lines.index("free motions") + 1 :] == ["  rotor z, disc z", "  rotor θz, disc θz"]
    app.spring("disc.centre", "ground", (0, 0, 1e3, 0, 0, 1e3))
    assert app.summary().endswith("free motions\n  none")


@pytest.mark.parametrize(
    ("act", "message"),
    [
        (lambda a: a.gravity((0, -9.81)), "gravity is .*three finite numbers"),
        (lambda a: (a.gravity((0, 0, 1)), a.gravity((0, 0, 1))), "gravity is given already"),
        (lambda a: a.base_motion((0, np.nan, 0)), "acceleration of the base"),
        (lambda a: a.base_motion((0, 1, 0), time=[0, 1]), "load at ground: time has 2 samples and value 0"),
        (lambda a: a.temperature("axle", 40.0), "'axle' names no part"),
        (lambda a: a.temperature("shaft", 40.0), "'shaft' has no viscoelastic material"),
        (lambda a: a.temperature("layer", 40.0), "part 'layer' at 40.0 °C.*law is None"),
        (lambda a: a.spring("ring.centre", "ring.centre", (1,) * 6), "both ends at ring.centre"),
        (lambda a: a.spring("ring.hub", "ground", (1,) * 6), "'ring' has no interface 'hub'"),
        (lambda a: a.spring("ring.centre", "ground", (-1,) * 6), "cannot be negative"),
        (lambda a: a.spring("ring.centre", "ground", (0,) * 6, offset=(1,) * 6), "acts through springs"),
        (lambda a: a.ground("ring.centre", offset=(0, 0, 1e-5, 0, 0, 0)), "acts through springs"),
        (
            lambda a: a.bearing("b", BEARING, inner="shaft.left", outer="ground", offset=math.inf),
            "'b': offset is inf",
        ),
        (lambda a: a.add("gravity", RigidBody(1.0, (1.0,) * 3)), 'not "ground" or "gravity"'),
    ],
)
def test_bad_input_is_named(act, message):
    with pytest.raises(ValueError, match=message):
        act(motor())


def test_a_bearing_may_be_pressed_in_play():
    """An offset within the axial play loads nothing."""
    bearing = BallBearing(8, 12.303e-3, 52e-3, 0.52, 0.53, clearance=40e-6)
    app = Application()
    app.add("rotor", RigidBody(2.0, (0.01, 0.01, 0.005)))
    app.ground("rotor.centre", stiffness=(1e7,) * 3 + (1e4,) * 3)
    half = bearing.geometry.A * math.sin(bearing.geometry.alpha0)
    app.bearing("b", bearing, inner="rotor.centre", outer="ground", offset=0.9 * half)
    assert not equilibrium(app).bearings["b"].loads.any()


def test_the_ground_bears_all_that_is_fastened_to_an_interface_it_holds():
    """A ring that holds a bearing, a bush and a layer: Newton's law."""
    app = Application()
    app.add("rotor", RigidBody(2.0, (1e-2,) * 3))
    app.add("ring", RigidBody(0.1, (1e-4,) * 3))
    light = replace(RUBBER, density=1e-4)
    app.add("layer", Layer(0.036, 0.039, 0.019, light, moduli=(1e6, 6e6), refinement=0.5))
    app.add("sleeve", RigidBody(0.5, (1e-3,) * 3))
    app.connect("ring.centre", "layer.inner")
    app.connect("layer.outer", "sleeve.centre")
    app.ground("ring.centre")
    app.bearing("left", BEARING, inner="rotor.centre", outer="ring.centre")
    app.spring("ring.centre", "rotor.centre", (1e6,) * 6, damping=(100.0,) * 6)
    app.load("rotor.centre", (0, -300.0, 200.0, 0, 0, 0))
    state = equilibrium(app)
    f = np.array([30.0, 400.0])
    motions = ["rotor.centre.y", "sleeve.centre.y"]
    forces = ["ground.ring.centre.y", "ground.layer.inner.y"]
    inputs = ["rotor.centre.y", "sleeve.centre.y", "ring.centre.y", "ground.y"]
    found = frequency_response(state, f, inputs, motions + forces, quantity="acceleration").response
    # Newton's law along y: the loads, less what they accelerate; the layer weighs nothing
    a, force = found.sel(output=motions).values, found.sel(output=forces).values
    borne = np.array([1.0, 1.0, 1.0, -0.1]) - (2.0 * a[:, 0] + 0.5 * a[:, 1])
    # round-off of the tangents
    np.testing.assert_allclose(force, np.stack([borne, borne], axis=1), rtol=1e-8)
