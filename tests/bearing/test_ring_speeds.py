"""Cage, balls, waves and pits follow the ring that turns."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from tests.twins import bearing_twin

from bearingdyn import core
from bearingdyn.bearing import (
    BallBearing,
    Lubricant,
    Pit,
    Running,
    Walther,
    Waviness,
    fault_lines,
    lubricate,
    waviness_lines,
)
from bearingdyn.bearing.catalogue import bearing

SPEED = 1797 * math.pi / 30  # rad/s, of the issue and of the Case Western rig
OIL = Lubricant(Walther.iso_vg(32))
FLAWED = BallBearing(
    9,
    7.94e-3,
    39.04e-3,
    0.52,
    0.53,
    clearance=10e-6,
    damping=40.0,
    film=3e-7,
    waviness=[
        Waviness("inner", 8, 4e-7, 0.3),
        Waviness("inner", 9, 3e-7, 1.0, "axial"),
        Waviness("outer", 7, 3e-7, 2.0),
        Waviness("outer", 16, 2e-7, 0.0, "axial"),
        Waviness("ball", 2, 3e-7, 0.5),
    ],
    defects=[Pit("inner", 0.1, 4e-3, 2e-6), Pit("outer", 0.5, 4e-3, 3e-6), Pit("ball", 0.2, 3e-3, 2e-6, 3)],
    oversize=[0, 1e-6, 0, -5e-7, 0, 0, 3e-7, 0, 0],
)


def test_the_cage_of_a_6205_turns_at_18_hz_where_the_outer_ring_carries_the_shaft():
    """FTF = ½(1 ± γ) of 29.95 Hz, γ = 7.94/39.04: 11.93 and 18.02 Hz; the ball passes are the same."""
    ball = bearing("6205", clearance=10e-6)
    gamma = 7.94 / 39.04
    inside, outside = (replace(ball, turning=t).frequencies(SPEED) for t in ("inner", "outer"))
    assert ball.frequencies(SPEED) == inside
    assert inside.FTF == pytest.approx(29.95 * (1 - gamma) / 2)
    assert outside.FTF == pytest.approx(29.95 * (1 + gamma) / 2)
    assert round(inside.FTF, 1) == 11.9
    assert round(outside.FTF, 1) == 18.0
    assert outside[1:] == pytest.approx(inside[1:])
    assert fault_lines(replace(ball, turning="outer"), SPEED)["FTF"] == outside.FTF
    assert replace(ball, turning="both").frequencies(SPEED) == pytest.approx((29.95, 0, 0, 0))


def test_a_cage_ratio_of_ones_own_is_reckoned_against_the_ring_that_stands():
    """ω_c − ω_o = c (ω_i − ω_o): in the frame of the outer ring nothing else is known."""
    ball = BallBearing(9, 7.94e-3, 39.04e-3, 0.52, 0.53, clearance=10e-6, cage_ratio=0.4)
    ratios = [replace(ball, turning=t).cage_ratio for t in ("inner", "outer", "both", (1.0, -0.5))]
    assert ratios == pytest.approx([0.4, 0.6, 1.0, 0.1])


@pytest.mark.parametrize("theta", [0.0, 0.7, 11.3])
def test_the_same_relative_motion_gives_the_same_forces_whichever_ring_turns(theta):
    """Seen from its inner ring, a bearing whose inner ring turns by θ has an outer ring that turns by −θ."""
    rng = np.random.default_rng(5)
    omega, c = 300.0, FLAWED.cage_ratio
    z, rate = 1e-6 * rng.standard_normal(5), 1e-4 * rng.standard_normal(5)
    z[2] += 1.2e-4
    a, b = math.cos(theta), math.sin(theta)
    turn, slope = np.array([[a, b], [-b, a]]), omega * np.array([[-b, a], [-a, -b]])
    R, R_rate = np.eye(5), np.zeros((5, 5))
    for pair in ([0, 1], [3, 4]):
        R[np.ix_(pair, pair)], R_rate[np.ix_(pair, pair)] = turn, slope

    inner, outer = (replace(FLAWED, turning=t).kernel() for t in ("inner", "outer"))
    g, _K, C, loads = core.bearing_force(inner, z, rate, c * theta, c * omega, theta, omega)
    back = (1 - c) * -theta, (1 - c) * -omega, -theta, -omega
    g_o, _, C_o, loads_o = core.bearing_force(outer, R @ z, R @ rate + R_rate @ z, *back)
    assert (loads > 0).all()
    # round-off of a wave of order 16 at 11 rad: 16 · 11 · 1e-16 of its argument
    np.testing.assert_allclose(loads_o, loads, rtol=1e-11)
    np.testing.assert_allclose(g_o, R @ g, rtol=0, atol=1e-11 * np.abs(g).max())
    np.testing.assert_allclose(C_o, R @ C @ R.T, rtol=0, atol=1e-11 * np.abs(C).max())


def test_kernel_and_twin_agree_where_both_rings_turn():
    spec = replace(FLAWED, turning=(0.7, -0.4)).kernel()
    z, rate = np.array([2e-6, -1e-6, 9e-5, 1e-6, 2e-6]), np.array([1e-3, 2e-3, -1e-3, 0.0, 1e-3])
    case = (spec, z, rate, 0.9, 50.0, 2.1, 130.0)
    mine, its = core.bearing_force(*case), bearing_twin.bearing_force(*case)
    np.testing.assert_allclose(mine[0], its[0], rtol=0, atol=1e-12 * np.abs(mine[0]).max())


def test_a_turned_bearing_stands_where_its_rings_have_turned_to():
    """`turned` moves waves and pits as the kernel would by itself."""
    brg = replace(FLAWED, turning=(0.7, -0.4))
    z, still = np.array([2e-6, -1e-6, 9e-5, 1e-6, 2e-6]), np.zeros(5)
    cage = 0.8
    moved = brg.turned(cage)
    whole = core.bearing_force(brg.kernel(), z, still, cage, 0.0, cage / brg.cage_ratio)
    np.testing.assert_allclose(core.bearing_force(moved.kernel(), z, still, moved.angle0, 0.0)[0], whole[0])


def test_waves_of_a_turning_ring_show_beside_the_ball_passes():
    """Outer ring turning at ω: qZ(ω − ω_c) ± ω; the inner ring stands, and all its orders meet at qZω_c."""
    ball = replace(bearing("6205", clearance=10e-6), turning="outer")
    f, turn = ball.frequencies(SPEED), SPEED / (2 * math.pi)
    lines = waviness_lines(ball, SPEED)
    assert lines["outer 9 ax"] == pytest.approx(f.BPFO)
    assert lines["outer 8 rad"] == pytest.approx(f.BPFO - turn)
    assert lines["outer 10 rad"] == pytest.approx(f.BPFO + turn)
    assert lines["inner 9(±1)"] == pytest.approx(f.BPFI)
    # from the phases themselves: order n rides at n(ω_c − ω_o), projected on x at ω_c
    cage = 2 * math.pi * f.FTF
    for n in (8, 10):
        phase = abs(n * (cage - SPEED) + (1 if n == 8 else -1) * cage) / (2 * math.pi)
        assert lines[f"outer {n} rad"] == pytest.approx(phase)


def test_balls_orbit_faster_inside_a_turning_outer_ring_and_spin_the_other_way():
    """At low speed both contact angles are α: ω_m = ½ω(1 + γ), γ = Dw cosα/Dpw."""
    row = BallBearing(14, 9e-3, 50e-3, 0.52, 0.53, contact_angle=math.radians(25))
    q = row.displacement([0, 0, 300.0, 0, 0, 0])
    inner, outer, both = (Running(replace(row, turning=t), 20.0).balls(q) for t in ("inner", "outer", "both"))
    gamma = 9 / 50 * np.cos(inner.alpha_i)
    # the angles differ by the balls' own weightless inertia, below 1e-5 rad at 20 rad/s
    np.testing.assert_allclose(inner.orbit, 10.0 * (1 - gamma), rtol=1e-4)
    np.testing.assert_allclose(outer.orbit, 10.0 * (1 + gamma), rtol=1e-4)
    np.testing.assert_allclose(both.orbit, 20.0, rtol=1e-12)
    # M_g = J ω_m ω_R sinβ, ω_R ∝ ω_i − ω_o
    np.testing.assert_allclose(outer.gyroscopic / inner.gyroscopic, -outer.orbit / inner.orbit, rtol=1e-3)
    np.testing.assert_allclose(both.gyroscopic, 0.0, atol=1e-15)


def test_films_know_the_speed_of_rolling():
    ball = bearing("6205", clearance=10e-6)
    with pytest.raises(ValueError, match=r"bearing.turning is 'both'; both rings turn alike"):
        lubricate(replace(ball, turning="both"), OIL, 60.0, SPEED, [0, -500.0, 100, 0, 0, 0])
    alike = [
        lubricate(replace(ball, turning=t), OIL, 60.0, SPEED, [0, -500.0, 100, 0, 0, 0]).us
        for t in ("inner", "outer")
    ]
    assert alike[0] == alike[1]


@pytest.mark.parametrize("wrong", ["shaft", 3, (1.0,), (1.0, math.nan), ("a", "b")])
def test_a_wrong_turning_is_named(wrong):
    with pytest.raises(ValueError, match="turning is"):
        bearing("6205", clearance=10e-6, turning=wrong)
