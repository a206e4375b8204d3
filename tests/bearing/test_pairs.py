"""Paired bearings against closed forms of two preloaded rows."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.optimize import brentq

from bearingdyn.bearing import BallBearing, Pair
from verified.closed_forms import axial, closed_forms

ALPHA = math.radians(25)
ROW = BallBearing(13, 7.938e-3, 38.5e-3, 0.52, 0.53, contact_angle=ALPHA)
DEEP = BallBearing(9, 7.94e-3, 39.04e-3, 0.52, 0.53, clearance=10e-6)
WIDTH = 15e-3


def load(**components: float) -> np.ndarray:
    return np.array([components.get(name, 0.0) for name in ("Fx", "Fy", "Fz", "Mx", "My", "Mz")])


@pytest.mark.parametrize("row", [ROW, DEEP])
@pytest.mark.parametrize("arrangement", ["DB", "DF"])
def test_preload_displacement_curve_of_two_bearings(row, arrangement):
    pair = Pair(row, arrangement, WIDTH, preload=30e-6)
    lift = 15e-6
    for F in (0.0, 50.0, 400.0, -400.0, 3e3):
        # one row is pressed further, the other let go: F = f(s0 + z) − f(s0 − z)
        z = brentq(lambda z, F=F: axial(row, lift + z) - axial(row, lift - z) - F, -3e-4, 3e-4, xtol=1e-18)
        q = pair.displacement(load(Fz=F))
        # distances rounded to 1e-19 m in indentations of a µm
        assert q[2] == pytest.approx(z, rel=1e-9, abs=1e-15)
        np.testing.assert_allclose(np.delete(q, 2), 0, atol=1e-14)


@pytest.mark.parametrize("arrangement", ["DB", "DF"])
def test_preload_force_presses_each_row(arrangement):
    pair = Pair(ROW, arrangement, WIDTH, preload_force=200.0)
    for loads in pair.ball_loads(np.zeros(6)):
        Q = brentq(lambda s: axial(ROW, s) - 200.0, 0, 1e-4, xtol=1e-18)
        assert axial(ROW, pair.approach) == pytest.approx(200.0, rel=1e-9)
        assert pair.approach == pytest.approx(Q, rel=1e-9)
        assert np.ptp(loads) < 1e-9
    # the two rows hold each other, to the round-off of 200 N
    np.testing.assert_allclose(pair.force(np.zeros(6)), 0, atol=1e-10)
    # the same by displacement
    twin = Pair(ROW, arrangement, WIDTH, preload=2 * pair.approach)
    np.testing.assert_allclose(twin.stiffness(np.zeros(6)), pair.stiffness(np.zeros(6)), rtol=1e-12)


@pytest.mark.parametrize(("arrangement", "sense"), [("DB", 1), ("DF", -1)])
def test_stiffness_of_a_preloaded_pair(arrangement, sense):
    pair = Pair(ROW, arrangement, WIDTH, preload_force=200.0)
    K, one, s = pair.stiffness(np.zeros(6)), closed_forms(ROW, pair.approach), WIDTH / 2
    assert K[2, 2] == pytest.approx(2 * one["zz"], rel=1e-9)
    assert K[0, 0] == pytest.approx(2 * one["xx"], rel=1e-9)
    # textbook: rows at ±s add s² k_xx, and twice s k_xθ, which widens the base of DB and narrows that of DF
    tilt = 2 * (one["tt"] + s**2 * one["xx"] + sense * 2 * s * abs(one["xt"]))
    assert K[3, 3] == pytest.approx(tilt, rel=1e-9)
    assert K[4, 4] == pytest.approx(tilt, rel=1e-9)
    # a pair that is symmetric about its middle does not tilt under a radial load there
    np.testing.assert_allclose(K[0, 4], 0, atol=1e-9 * abs(one["xt"]))
    np.testing.assert_array_less(0, np.linalg.eigvalsh(K)[1:])


def test_back_to_back_holds_moments_best():
    stiff = {a: Pair(ROW, a, WIDTH, preload_force=200.0).stiffness(np.zeros(6))[4, 4] for a in ("DB", "DF")}
    # lines of contact meet the axis D/2·tanα outside or inside the rows: bases of 15 ± 18 mm, (33/3)² apart
    # but for the tilting of each row by itself, which is of the same size for both
    assert stiff["DB"] > 5 * stiff["DF"]


def test_tandem_shares_the_axial_load():
    pair = Pair(ROW, "DT", WIDTH)
    q = pair.displacement(load(Fz=1000.0))
    assert axial(ROW, q[2]) == pytest.approx(500.0, rel=1e-9)
    assert pair.stiffness(q)[2, 2] == pytest.approx(2 * closed_forms(ROW, q[2])["zz"], rel=1e-9)


@pytest.mark.parametrize("arrangement", ["DB", "DF", "DT"])
def test_combined_load_is_in_equilibrium_and_tangent_is_the_derivative(arrangement):
    pair = Pair(ROW, arrangement, WIDTH, preload_force=None if arrangement == "DT" else 150.0)
    f = load(Fx=300.0, Fy=-200.0, Fz=600.0, Mx=3.0, My=-2.0)
    q = pair.displacement(f, 0.2)
    np.testing.assert_allclose(pair.force(q, 0.2), f, atol=1e-7)
    for k, h in enumerate([1e-9, 1e-9, 1e-9, 1e-7, 1e-7]):
        d = np.zeros(6)
        d[k] = h
        column = (pair.force(q + d, 0.2) - pair.force(q - d, 0.2)) / (2 * h)
        K = pair.stiffness(q, 0.2)
        # central differences: second order in 1e-9 m over indentations of 1e-6 m
        np.testing.assert_allclose(column, K[:, k], rtol=1e-5, atol=1e-6 * np.abs(K[:, k]).max())
    np.testing.assert_allclose(K, K.T, atol=1e-12 * np.abs(K).max())


@pytest.mark.parametrize(
    ("make", "field"),
    [
        (lambda: Pair("6205", "DB", WIDTH), "row"),
        (lambda: Pair(ROW, "OO", WIDTH), "arrangement"),
        (lambda: Pair(ROW, "DT", WIDTH, preload=1e-6), "arrangement"),
        (lambda: Pair(ROW, "DB", 0.0), "distance"),
        (lambda: Pair(ROW, "DB", WIDTH, preload=-1e-6), "preload"),
        (lambda: Pair(ROW, "DB", WIDTH, preload_force=math.nan), "preload_force"),
        (lambda: Pair(ROW, "DB", WIDTH, preload=1e-6, preload_force=1.0), "preload_force"),
        (lambda: Pair(ROW, "DB", WIDTH).force([1.0]), "q"),
        (lambda: Pair(ROW, "DB", WIDTH).displacement([1.0]), "load"),
    ],
)
def test_bad_input_is_named(make, field):
    with pytest.raises(ValueError, match=f"^{field} is "):
        make()
