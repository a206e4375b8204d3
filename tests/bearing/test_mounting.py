"""Press fits and temperature: what they leave of the clearance."""

from __future__ import annotations

import math

import numpy as np
import pytest

from bearingdyn.bearing import BallBearing, Mounting, Seat
from bearingdyn.material import Elastic

BRG = BallBearing(9, 7.94e-3, 39.04e-3, 0.52, 0.53, clearance=20e-6)
BORE, OUTSIDE = 25e-3, 52e-3
RACE_I, RACE_O = 39.04e-3 - 7.94e-3, 39.04e-3 + 7.94e-3
ALUMINIUM = Elastic(70e9, 0.33, 2700.0)


def two_cylinders(seat, ring_other, mate_other, ring, mate, interference):
    """Change of diameter at the ring's free surface: u = a r + b/r in both bodies.

    Plane stress: σ_r = E/(1−ν²)[(1+ν)a − (1−ν)b/r²].
    """

    def stress(E, nu, r):
        return np.array([(1 + nu), -(1 - nu) / r**2]) * E / (1 - nu**2)

    s = seat / 2
    rows, right = [], []
    rows.append([*stress(ring.E, ring.nu, ring_other / 2), 0, 0])  # free surface of the ring
    right.append(0.0)
    rows.append([*stress(ring.E, ring.nu, s), *-stress(mate.E, mate.nu, s)])  # one pressure
    right.append(0.0)
    outwards = 1.0 if ring_other > seat else -1.0
    rows.append([s, 1 / s, -s, -1 / s])  # the gap closed by displacement
    right.append(outwards * interference / 2)
    # the mate: solid (no 1/r), thick (no r), or free at its other surface
    if mate_other == 0:
        rows.append([0, 0, 0, 1])
    elif mate_other == math.inf:
        rows.append([0, 0, 1, 0])
    else:
        rows.append([0, 0, *stress(mate.E, mate.nu, mate_other / 2)])
    right.append(0.0)
    scale = np.array([1, s**2, 1, s**2])
    u = np.linalg.solve(np.array(rows) * scale, right) * scale
    r = ring_other / 2
    return 2 * (u[0] * r + u[1] / r)


def test_steel_on_a_solid_steel_shaft_grows_in_the_ratio_of_diameters():
    # Harris: Δ = I·d/d_race for one material and a solid shaft; the same for a ring in a very thick housing
    on_shaft = Mounting(BORE, OUTSIDE, shaft=Seat(12e-6))
    assert on_shaft.clearance_change(BRG) == pytest.approx(-12e-6 * BORE / RACE_I, rel=1e-12)
    in_housing = Mounting(BORE, OUTSIDE, housing=Seat(9e-6))
    assert in_housing.clearance_change(BRG) == pytest.approx(-9e-6 * RACE_O / OUTSIDE, rel=1e-12)


@pytest.mark.parametrize("hollow", [0.0, 15e-3])
@pytest.mark.parametrize("around", [math.inf, 70e-3])
def test_lame_cylinders_of_two_materials(hollow, around):
    brass = Elastic(100e9, 0.35, 8500.0)
    mounting = Mounting(
        BORE, OUTSIDE, shaft=Seat(12e-6, hollow, brass), housing=Seat(9e-6, around, ALUMINIUM)
    )
    inner = two_cylinders(BORE, RACE_I, hollow, BRG.material, brass, 12e-6)
    outer = two_cylinders(OUTSIDE, RACE_O, around, BRG.material, ALUMINIUM, 9e-6)
    assert inner > 0 > outer
    assert mounting.clearance_change(BRG) == pytest.approx(outer - inner, rel=1e-9)
    assert mounting.mounted(BRG).clearance == pytest.approx(20e-6 + outer - inner, rel=1e-9)


def test_even_warming_changes_next_to_nothing():
    even = Mounting(BORE, OUTSIDE, Seat(warming=40.0), Seat(warming=40.0), 40.0, 40.0, 40.0)
    # races and balls of one steel, as far apart as before
    assert even.clearance_change(BRG) == pytest.approx(0.0, abs=1e-18)


def test_a_warmer_inner_ring_takes_clearance():
    # α d ΔT of the inner race, and of twice the balls
    warm = Mounting(BORE, OUTSIDE, Seat(warming=10.0), inner=10.0)
    assert warm.clearance_change(BRG) == pytest.approx(-11.5e-6 * 10 * RACE_I, rel=1e-12)
    balls = Mounting(BORE, OUTSIDE, balls=10.0, ball_expansion=3.2e-6)
    assert balls.clearance_change(BRG) == pytest.approx(-2 * 3.2e-6 * 10 * 7.94e-3, rel=1e-12)


def test_an_aluminium_housing_lets_go_when_it_warms():
    cold = Mounting(BORE, OUTSIDE, housing=Seat(20e-6, 70e-3, ALUMINIUM))
    warm = Mounting(
        BORE,
        OUTSIDE,
        Seat(warming=60.0),
        Seat(20e-6, 70e-3, ALUMINIUM, expansion=23.5e-6, warming=60.0),
        60.0,
        60.0,
        60.0,
    )
    # 52 mm · 12e-6/K · 60 K is more than the interference: the ring is free and as large as warmed alone
    assert cold.clearance_change(BRG) < -5e-6
    assert warm.clearance_change(BRG) == pytest.approx(0.0, abs=1e-18)


def test_free_contact_angle_of_an_angular_contact_bearing_follows():
    brg = BallBearing(13, 7.938e-3, 38.5e-3, 0.52, 0.53, contact_angle=math.radians(25))
    mounting = Mounting(BORE, OUTSIDE, shaft=Seat(10e-6))
    after = mounting.mounted(brg)
    # cosα = 1 − Pd/2A
    expected = math.acos(math.cos(math.radians(25)) - mounting.clearance_change(brg) / (2 * brg.geometry.A))
    assert after.contact_angle == pytest.approx(expected, rel=1e-12)
    assert after.contact_angle < brg.contact_angle


@pytest.mark.parametrize(
    ("make", "field"),
    [
        (lambda: Seat(-1e-6), "interference"),
        (lambda: Seat(warming=math.nan), "warming"),
        (lambda: Seat(material=210e9), "material"),
        (lambda: Seat(other=math.nan), "other"),
        (lambda: Mounting(0.0, OUTSIDE), "bore"),
        (lambda: Mounting(BORE, 20e-3), "outside"),
        (lambda: Mounting(BORE, OUTSIDE, Seat(other=26e-3)), "shaft.other"),
        (lambda: Mounting(BORE, OUTSIDE, housing=Seat(other=50e-3)), "housing.other"),
        (lambda: Mounting(BORE, OUTSIDE, inner=math.inf), "inner"),
        (lambda: Mounting(35e-3, OUTSIDE).clearance_change(BRG), "bore, outside"),
        (lambda: Mounting(BORE, OUTSIDE, Seat(400e-6)).mounted(BRG), "clearance"),
    ],
)
def test_bad_input_is_named(make, field):
    with pytest.raises(ValueError, match=f"^{field} is "):
        make()
