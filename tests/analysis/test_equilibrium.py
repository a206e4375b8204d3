"""The static state: balances, closed forms, and the bearing by itself."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from bearingdyn import core
from bearingdyn.analysis import Equilibrium, equilibrium
from bearingdyn.application import Application
from bearingdyn.bearing import BallBearing
from bearingdyn.fem import Section
from bearingdyn.material import Elastic, Maxwell
from bearingdyn.parts import Layer, RigidBody, Shaft
from bearingdyn.system import assemble

RUBBER = Maxwell(G0=1e6, G=[2e6, 3e6], tau=[1e-3, 1e-5], K=2e9, density=1200.0)
B6306 = BallBearing(8, 12.303e-3, 52e-3, 0.52, 0.53, clearance=10e-6)
ROTOR = RigidBody(2.0, (0.01, 0.01, 0.005))
# 207 GPa, as the 6202-like case of the reference page §3.5
STEEL_207 = Elastic(207e9, 0.3, 7850.0)
B6202 = BallBearing(
    8, 5.953e-3, 25e-3, 0.52, 0.53, clearance=10e-6, material=STEEL_207, ball_material=STEEL_207
)


def on_ground(bearing: BallBearing, load: tuple[float, ...]) -> Equilibrium:
    app = Application()
    app.add("rotor", ROTOR)
    app.bearing("b", bearing, inner="rotor.centre", outer="ground")
    app.load("rotor.centre", load)
    return equilibrium(app)


@pytest.mark.parametrize(
    "load",
    [
        (0, -500.0, 0, 0, 0, 0),
        (0, 0, 180.0, 0, 0, 0),
        (300.0, -500.0, 180.0, 1.0, -2.0, 0),
        (1e-3, 0, 0, 0, 0, 0),
        (0, -1e5, 2e4, 0, 0, 0),
    ],
)
def test_a_rotor_on_one_bearing_sits_as_the_bearing_by_itself(load):
    q = on_ground(B6306, load).displacement("rotor.centre")
    # two different minimisations of one energy, each to 1e-12 of the load; a soft tilt divides that by 1e-3
    np.testing.assert_allclose(q, B6306.displacement(load), rtol=1e-8, atol=1e-13)


def test_6202_under_axial_preload_has_the_printed_numbers():
    """Reference page §3.5: 180 N axial, computed independently for this project; to the digits printed."""
    state = on_ground(B6202, (0, 0, 180.0, 0, 0, 0))
    z = state.displacement("rotor.centre")[2]
    assert z == pytest.approx(77.76e-6, abs=0.005e-6)
    assert z - B6202.geometry.A * np.sin(B6202.geometry.alpha0) == pytest.approx(23.43301e-6, abs=6e-12)
    bearing = state.bearings["b"]
    np.testing.assert_allclose(bearing.loads, 87.6163, atol=6e-5)
    R = B6202.arm
    K = bearing.K
    # half a unit of the seventh digit is up to 3.2e-7
    assert bearing.radial_stiffness == pytest.approx(9.533296e7, rel=3.5e-7)
    assert K[2, 2] == pytest.approx(1.561296e7, rel=3.5e-7)
    # coefficient 4 is +R θx, coefficient 3 is −R θy
    assert R * R * K[4, 4] == pytest.approx(1242.715, rel=5e-7)
    assert -R * K[0, 3] == pytest.approx(-3.157244e5, rel=3.5e-7)


def test_layer_in_series_adds_its_deflection():
    load = (0.0, 0.0, 180.0, 0.0, 0.0, 0.0)
    layer = Layer(0.036, 0.039, 0.019, RUBBER, moduli=(1e6, 6e6))
    app = Application()
    app.add("rotor", ROTOR)
    app.add("ring", RigidBody.ring(0.03, 0.036, 0.019))
    app.add("layer", layer)
    app.connect("ring.centre", "layer.inner")
    app.ground("layer.outer")
    app.bearing("b", B6306, inner="rotor.centre", outer="ring.centre")
    app.load("rotor.centre", load)
    state = equilibrium(app)
    own = B6306.displacement(load)[2]
    # the layer's full finite element model, re-solved at the relaxed modulus: one of the two the shapes were
    # taken at, so the reduction adds nothing and round-off is left
    k = layer.stiffness(0.0)[2, 2].real
    ring = state.displacement("ring.centre")[2]
    assert ring == pytest.approx(180.0 / k, rel=1e-7)
    assert state.displacement("rotor.centre")[2] == pytest.approx(own + 180.0 / k, rel=1e-7)


def two_bearings(preload: float, load: tuple[float, ...] = (0,) * 6) -> Application:
    """A stiff shaft in two bearings whose contact angles face each other; the right one's block is pushed."""
    app = Application()
    app.add("shaft", Shaft([Section(0.2, 0.06)], seats={"left": 0.05, "right": 0.15}, f_max=2e3))
    app.add("block", RigidBody(1.0, (0.01,) * 3))
    app.ground("block.centre", stiffness=(1e12, 1e12, 0, 1e9, 1e9, 1e9))
    # thicker than the bearings' bore, so that it is stiff
    app.bearing("left", B6306, inner="shaft.left", outer="ground", fits=False)
    app.bearing("right", B6306, inner="shaft.right", outer="block.centre", fits=False)
    app.load("block.centre", (0, 0, preload, 0, 0, 0))
    app.load("shaft.left", load)
    return app


def test_preload_passes_through_both_bearings():
    state = equilibrium(two_bearings(180.0))
    # the push on the right outer ring goes through the shaft to the left outer ring: each carries 180 N
    assert state.bearings["left"].g[2] == pytest.approx(180.0, rel=1e-9)
    assert state.bearings["right"].g[2] == pytest.approx(-180.0, rel=1e-9)
    np.testing.assert_allclose(state.bearings["left"].loads, state.bearings["right"].loads, rtol=1e-9)
    # and is as stiff as one bearing under 180 N
    own = B6306.stiffness(B6306.displacement((0, 0, 180.0, 0, 0, 0)))
    assert state.bearings["left"].radial_stiffness == pytest.approx(own[0, 0], rel=1e-9)


@given(
    st.lists(st.floats(-2e3, 2e3), min_size=3, max_size=3),
    st.lists(st.floats(-20, 20), min_size=2, max_size=2),
)
@settings(max_examples=25, deadline=None)
def test_forces_and_moments_balance_under_any_load(force, moment):
    load = np.array([*force, *moment, 0.0])
    app = two_bearings(180.0, tuple(load))
    state = equilibrium(app)
    system = state.system
    total = np.zeros(6)
    for name, seat, arm in (("left", 0.05, B6306.arm), ("right", 0.15, B6306.arm)):
        g = state.bearings[name].g
        F = np.array([g[0], g[1], g[2]])
        # moments about the left seat: −R g3 about y, +R g4 about x, and F at its lever
        M = np.array([arm * g[4], -arm * g[3], 0.0]) + np.cross([0, 0, seat - 0.05], F)
        total += [*F, *M]
    # what the bearings hold is what the load brings: force known to 1e-12 of all that presses
    scale = sum(b.loads.sum() for b in state.bearings.values()) + np.abs(load).max()
    np.testing.assert_allclose(total, load, atol=1e-9 * scale)
    # ball loads sum to the bearing's force, vector by vector (the cage at angle 0)
    for b in state.bearings.values():
        psi = 2 * np.pi * np.arange(8) / 8
        kernel = B6306.kernel()
        X = kernel.x0 + b.z[2] + b.z[3] * np.cos(psi) + b.z[4] * np.sin(psi)
        Y = kernel.y0 + b.z[0] * np.cos(psi) + b.z[1] * np.sin(psi)
        length = np.hypot(X, Y)
        radial, axial = b.loads * Y / length, b.loads * X / length
        arms = np.array(
            [radial * np.cos(psi), radial * np.sin(psi), axial, axial * np.cos(psi), axial * np.sin(psi)]
        )
        np.testing.assert_allclose(b.g, arms.sum(axis=1), rtol=1e-9, atol=1e-9 * scale)
        assert (b.loads >= 0).all()
    # the whole system is at rest: K x + Bᵀ g = f
    g = np.concatenate([b.g for b in state.bearings.values()])
    residual = system.stiffness() @ state.x + system.B.T @ g - system.static_load()
    # the residual of stiff springs is round-off of K x, term by term
    noise = 1e-13 * (np.abs(system.stiffness()) @ np.abs(state.x)).max()
    assert np.abs(residual).max() < 1e-9 * scale + noise


def test_clearance_is_run_through_before_a_ball_carries():
    """One ball at the bottom: x = Pd/2 + (F/κ)^⅔ while the neighbours' gaps stay open."""
    bearing = BallBearing(8, 12.303e-3, 52e-3, 0.52, 0.53, clearance=100e-6)
    state = on_ground(bearing, (50.0, 0, 0, 0, 0, 0))
    # δ = x cos 45° − Pd/2 is still open at the next balls
    assert state.displacement("rotor.centre")[0] == pytest.approx(
        50e-6 + (50.0 / bearing.kappa) ** (2 / 3), rel=1e-9
    )
    np.testing.assert_allclose(state.bearings["b"].loads, [50.0] + [0.0] * 7, atol=1e-9)


def test_unloaded_system_stays_where_it_was_built():
    state = equilibrium(two_bearings(0.0))
    assert not state.x.any()
    assert not state.bearings["left"].loads.any()


def test_a_free_spin_stays_at_zero():
    state = equilibrium(two_bearings(180.0, (100.0, -300.0, 0, 0, 0, 0)))
    # the shaft's rigid spin holds no energy; what is left of it is round-off
    assert abs(state.displacement("shaft.left")[5]) < 1e-12


def test_state_is_the_gradient_of_an_energy():
    """Virtual work: moving a hair from equilibrium in any direction costs second order, and costs."""
    state = equilibrium(two_bearings(180.0, (100.0, -3000.0, 0, 0, 5.0, 0)))
    system = state.system
    K = system.stiffness()

    def energy(x: np.ndarray) -> float:
        stored = 0.5 * x @ K @ x - system.static_load() @ x
        for term in system.bearings:
            kernel = term.bearing.kernel()
            loads = core.bearing_force(kernel, term.B @ x, np.zeros(5), 0.0, 0.0)[3]
            stored += 0.4 * (loads * (loads / kernel.kappa) ** (2 / 3)).sum()
        return float(stored)

    rng = np.random.default_rng(0)
    for _ in range(5):
        d = np.linalg.pinv(np.vstack([system.rows(n)[:5] for n in ("shaft.left", "shaft.right")])) @ (
            rng.standard_normal(10) * 1e-7 * np.array([1, 1, 1, 10, 10] * 2)
        )
        up, down, here = energy(state.x + d), energy(state.x - d), energy(state.x)
        assert up > here
        assert down > here
        # odd part over even part of a 0.1 µm step: the third derivative, ~δ/δ0 = 1e-7/1e-5
        assert abs(up - down) < 0.05 * (up + down - 2 * here)


def test_linearised_system_is_the_tangent_of_the_nonlinear_one():
    load = (0.0, -2000.0, 0.0, 0.0, 0.0, 0.0)
    state = equilibrium(two_bearings(180.0, load))
    step = np.array([0.0, 1e-3, 0, 0, 0, 0])
    nearby = equilibrium(two_bearings(180.0, tuple(np.array(load) + step)))
    linear = state.linearised()
    assert linear.bearings == ()
    assert linear.loads == ()
    free = linear.free_motions()
    K = linear.stiffness() + free @ free.T * 1e6
    dx = np.linalg.solve(K, linear.rows("shaft.left").T @ step)
    moved = nearby.displacement("shaft.left") - state.displacement("shaft.left")
    # 1 mN of 2 kN: curvature 1e-6; the difference of two states each known to 1e-12 of 1e-5 m: 1e-17/1e-12
    assert moved[1] == pytest.approx(linear.row("shaft.left.y") @ dx, rel=1e-4)


def test_cage_angle_turns_the_balls():
    app = two_bearings(180.0, (0, -2000.0, 0, 0, 0, 0))
    spacing = 2 * np.pi / 8
    a, b, c = (equilibrium(app, angle=t) for t in (0.0, spacing / 2, spacing))
    # one spacing on, ball j stands where j + 1 stood
    np.testing.assert_allclose(c.x, a.x, atol=1e-12)
    np.testing.assert_allclose(np.roll(c.bearings["left"].loads, 1), a.bearings["left"].loads, rtol=1e-6)
    assert np.abs(b.x - a.x).max() > 1e-8


def test_a_system_may_be_given_instead_of_an_application():
    app = two_bearings(180.0)
    assert np.array_equal(equilibrium(assemble(app)).x, equilibrium(app).x)
