"""A bearing in a flexible ring: the rigid limit, energy, and what the ring does to the loads."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

import bearingdyn as bd
from bearingdyn.bearing.raceway_series import RacewaySeries
from bearingdyn.material import STEEL
from bearingdyn.parts import FlexibleBearing, FlexibleRing, RigidBody
from flexible_rings import (
    B6305,
    CUSHIONED,
    LAYER,
    LOAD,
    RING,
    SIZE,
    STIFF,
    hung,
)


@pytest.mark.parametrize(
    "load", [LOAD, (500.0, -3000.0, 0.0, 2.0, -1.0, 0.0), (0.0, 0.0, 800.0, 0.0, 0.0, 0.0)]
)
def test_a_stiff_ring_is_the_rigid_ring(load: tuple[float, ...]) -> None:
    stiff = FlexibleBearing(B6305, replace(RING, material=STIFF))
    q = B6305.displacement(load)
    # E is a million times steel's: what is left of the ring's give is 1e-7 of the balls'
    np.testing.assert_allclose(stiff.force(q), B6305.force(q), rtol=0, atol=1e-6 * np.abs(load).max())
    K = B6305.stiffness(q)
    np.testing.assert_allclose(stiff.stiffness(q), K, rtol=0, atol=1e-6 * np.abs(K).max())
    np.testing.assert_allclose(stiff.ball_loads(q), B6305.ball_loads(q), rtol=1e-6, atol=1e-3)
    np.testing.assert_allclose(stiff.displacement(load), q, rtol=1e-6, atol=1e-12)
    rigid = bd.equilibrium(hung(None, load))
    got = bd.equilibrium(hung(replace(RING, material=STIFF), load))
    q, wanted = (e.displacement("rotor.centre")[:5] * ([1.0] * 3 + [B6305.arm] * 2) for e in (got, rigid))
    np.testing.assert_allclose(q, wanted, rtol=0, atol=1e-6 * np.abs(wanted).max())


def test_a_stiff_ring_in_rubber_is_a_rigid_ring_on_a_layer() -> None:
    def app(flexible: bool) -> bd.Application:
        app = bd.Application()
        app.add("rotor", RigidBody(2.0, (0.01, 0.01, 0.005)))
        app.ground("rotor.centre", stiffness=(0, 0, 0, 1e4, 1e4, 1.0))
        outer = "ring.raceway"
        if flexible:
            # stiffer still, round-off of the metal would be felt by the rubber
            app.add("ring", replace(CUSHIONED, material=replace(STEEL, E=1e4 * STEEL.E)))
            app.ground("ring.outer")
        else:
            app.add("ring", RigidBody.ring(*SIZE))
            app.add("layer", LAYER)
            app.connect("ring.centre", "layer.inner")
            app.ground("layer.outer")
            outer = "ring.centre"
        app.bearing("b", B6305, inner="rotor.centre", outer=outer)
        app.load("rotor.centre", LOAD)
        return app

    one, other = (bd.equilibrium(app(flexible)) for flexible in (True, False))
    q, wanted = (e.displacement("rotor.centre") for e in (one, other))
    # one body of two regions against two parts on two meshes of the rubber, each good to some 1e-4
    np.testing.assert_allclose(q[1:4], wanted[1:4], rtol=2e-4)
    np.testing.assert_allclose(one.bearings["b"].loads, other.bearings["b"].loads, rtol=1e-3, atol=1.0)
    # beside metal stiffened so, the free spin's 2 Hz is round-off; the rubber's mass rides along alike
    low, high = (bd.modes(e)["frequency"].values[1:5] for e in (one, other))
    np.testing.assert_allclose(low, high, rtol=1e-3)


@pytest.mark.parametrize("ring", [RING, CUSHIONED], ids=["rigid bore", "rubber"])
def test_force_is_the_gradient_of_the_energy_of_balls_and_ring(ring: FlexibleRing) -> None:
    brg = FlexibleBearing(B6305, ring)
    q = brg.displacement(LOAD, angle=0.2) + np.array([1e-6, 2e-6, -1e-6, 1e-5, -2e-5, 0.0])
    force, K = brg.force(q, 0.2), brg.stiffness(q, 0.2)
    step = np.array([1e-8, 1e-8, 1e-8, 1e-6, 1e-6, 1e-6])
    for k, h in enumerate(step):
        up, down = (q + s * h * np.eye(6)[k] for s in (1, -1))
        slope = (brg.energy(up, 0.2) - brg.energy(down, 0.2)) / (2 * h)
        # truncation (h/s)²/24 of K h, s of some 10 µm; round-off 1e-16·0.05 J/h
        assert slope == pytest.approx(force[k], abs=1e-5 * np.abs(force).max() * (1 if k < 3 else B6305.arm))
        column = (brg.force(up, 0.2) - brg.force(down, 0.2)) / (2 * h)
        np.testing.assert_allclose(column, K[:, k], rtol=0, atol=1e-5 * np.abs(K[:, k]).max() + 1e-3)
    assert K == pytest.approx(K.T, rel=1e-12)
    assert np.linalg.eigvalsh(K[:3, :3]).min() > 0.0


def test_balls_and_ring_balance_each_ball_by_its_own_law() -> None:
    """Ball by ball: gap from the raceway's shape, load by κδ^1.5, and the ring's shape by those loads."""
    brg = FlexibleBearing(B6305, RING)
    q = brg.displacement(LOAD)
    Q, z = brg.ball_loads(q), brg.raceway(q)
    series = RacewaySeries.up_to(RING.order)
    kernel = B6305.kernel()
    psi = 2 * np.pi * np.arange(B6305.Z) / B6305.Z
    inner = B6305.relative(q)
    g = np.zeros(len(series))
    for j, angle in enumerate(psi):
        wave = np.array([math.sin(n * angle) if s else math.cos(n * angle) for _, n, s in series.terms])
        axial = np.array([a for a, _, _ in series.terms], dtype=bool)
        X = (
            kernel.x0
            + inner[2]
            + inner[3] * math.cos(angle)
            + inner[4] * math.sin(angle)
            - (wave * z)[axial].sum()
        )
        Y = kernel.y0 + inner[0] * math.cos(angle) + inner[1] * math.sin(angle) - (wave * z)[~axial].sum()
        length = math.hypot(X, Y)
        delta = max(length - kernel.A, 0.0)
        # Hertz, and what the ring gives at the ball by itself; round-off of A = 0.6 mm against δ of µm: 1e-10
        own = (Q[j] / kernel.kappa) ** (2 / 3) + RING.compliance.give * Q[j]
        assert own == pytest.approx(delta, rel=1e-8, abs=1e-15)
        g += Q[j] * wave * np.where(axial, X, Y) / length
    np.testing.assert_allclose(brg.raceway_stiffness @ z, g, rtol=0, atol=1e-9 * Q.sum())


def test_a_flexible_ring_is_softer_and_spreads_the_load(capsys: pytest.CaptureFixture[str]) -> None:
    """Direction of change.

    In a rigid bore the race lies on a wall 3.5 mm below it, where Hertz's half-space goes on: the contact is
    stiffer, the inner ring moves less and the heaviest ball takes more. With rubber around it the ring
    bends: it flattens under the loaded zone and follows the inner race, so the peak falls far and the zone
    widens.
    """
    load = (0.0, -3000.0, 0.0, 0.0, 0.0, 0.0)
    angle = -0.5 * math.pi  # a ball under the load
    rigid = B6305.displacement(load, angle)
    peak, loaded = B6305.ball_loads(rigid, angle).max(), np.count_nonzero(B6305.ball_loads(rigid, angle))
    lines = [f"rigid rings: {-rigid[1] * 1e6:.3f} µm, peak {peak:.1f} N, {loaded} balls"]
    bore = FlexibleBearing(B6305, RING)
    q = bore.displacement(load, angle)
    Q = bore.ball_loads(q, angle)
    lines.append(f"in a rigid bore: {-q[1] * 1e6:.3f} µm, peak {Q.max():.1f} N, {np.count_nonzero(Q)} balls")
    # an independent finite element model with the half-space taken out: 36.65 µm, 1971.5 N, to 0.3 and 0.2 %
    assert -q[1] == pytest.approx(36.65e-6, rel=3e-3)
    assert Q.max() == pytest.approx(1971.5, rel=2e-3)
    assert abs(q[1]) < 0.99 * abs(rigid[1])
    assert Q.max() > 1.0005 * peak
    assert np.count_nonzero(Q) == loaded
    # stiffer than rigid rings for every ball that carries: along the load
    assert bore.stiffness(rigid, angle)[1, 1] > 1.005 * B6305.stiffness(rigid, angle)[1, 1]

    # the same in rubber, against a rigid ring in the same rubber
    cushioned = [FlexibleBearing(B6305, replace(CUSHIONED, material=m)) for m in (STEEL, STIFF)]
    q, q_rigid = (b.displacement(load, angle) for b in cushioned)
    Q, Q_rigid = (b.ball_loads(x, angle) for b, x in zip(cushioned, (q, q_rigid), strict=True))
    for name, x, P in (("steel", q, Q), ("rigid", q_rigid, Q_rigid)):
        lines.append(
            f"{name} ring in rubber: {-x[1] * 1e6:.2f} µm, peak {P.max():.1f} N, {np.count_nonzero(P)} balls"
        )
    assert abs(q[1]) > abs(q_rigid[1])
    assert Q.max() < 0.98 * Q_rigid.max()
    assert np.count_nonzero(Q) >= np.count_nonzero(Q_rigid)
    with capsys.disabled():
        print("", *lines, sep="\n  ")


def test_orders_converge_where_they_pass_the_number_of_balls(capsys: pytest.CaptureFixture[str]) -> None:
    """At rest every order is there, carried or folded: with Z orders as with twice as many."""
    angle, load = 0.3, (0.0, -3000.0, 300.0, 0.0, 0.0, 0.0)
    orders = (7, 8, 10, 14)
    y, peak = [], []
    for order in orders:
        brg = FlexibleBearing(B6305, replace(CUSHIONED, order=order))
        q = brg.displacement(load, angle)
        y.append(-q[1])
        peak.append(brg.ball_loads(q, angle).max())
    with capsys.disabled():
        print("\n  order   y (µm)   peak (N)")
        for row in zip(orders, np.array(y) * 1e6, peak, strict=True):
            print("  {:5d} {:8.3f} {:10.2f}".format(*row))
    # radial orders are folded exactly; of axial ones beyond, which fall off as order⁻⁴, nothing is kept
    assert np.ptp(y) < 2e-4 * y[-1]
    assert np.ptp(peak) < 2e-4 * peak[-1]


@pytest.mark.parametrize("body", ["inner", "outer", "ball"])
def test_a_wavy_bearing_turns_alike_in_a_stiff_ring_and_in_a_rigid_one(body: str) -> None:
    """The inner race has turned by the shaft's angle, the balls by the cage's, and the outer race stands."""
    wave = bd.Waviness(body, order=3 if body != "ball" else 2, amplitude=2e-6, phase=0.4)
    wavy = replace(B6305, waviness=(wave,))
    stiff = FlexibleBearing(wavy, replace(RING, material=STIFF))
    q = B6305.displacement(LOAD)
    forces = [wavy.force(q, angle) for angle in (0.0, 0.35)]
    # the angle is felt, by far more than is allowed below
    assert np.abs(forces[1] - forces[0])[:3].max() > 1e-3 * np.abs(LOAD).max()
    for angle, force in zip((0.0, 0.35), forces, strict=True):
        np.testing.assert_allclose(stiff.force(q, angle), force, rtol=0, atol=1e-6 * np.abs(LOAD).max())
