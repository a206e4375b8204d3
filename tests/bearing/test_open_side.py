"""An angular contact bearing bears axial load one way, and says so."""

from __future__ import annotations

import math
import warnings
from dataclasses import replace

import numpy as np
import pytest

from bearingdyn.bearing import BallBearing, Pair, Running
from bearingdyn.bearing.catalogue import CATALOGUE, bearing
from bearingdyn.notice import OpenSideWarning

MIRROR = np.array([1.0, 1.0, -1.0, -1.0, -1.0, 1.0])


def test_a_7205_refuses_thrust_on_the_side_without_shoulder():
    """The issue's numbers: 200 N would be carried at z = −0.513 mm by all balls at −40°."""
    ball = replace(bearing("7205"), fo=0.53)
    with pytest.raises(ValueError, match=r"load is \[0.0, 0.0, -200.0, .*13 of 13 balls .* at -40.*mirrored"):
        ball.displacement([0, 0, -200, 0, 0, 0])
    assert replace(ball, open_side=None).displacement([0, 0, -200, 0, 0, 0])[2] == pytest.approx(
        -0.513e-3, abs=5e-7
    )
    assert ball.displacement([0, 0, 200, 0, 0, 0])[2] > 0


def test_a_moment_alone_is_refused_too():
    """Half of the balls would be pressed the other way."""
    with pytest.raises(ValueError, match="open side"):
        bearing("7205").displacement([0, 0, 0, 20.0, 0, 0])


def test_radial_load_with_thrust_enough_is_carried():
    """Fa above some Fr tanα: every loaded ball leans on its shoulder."""
    ball = bearing("7205")
    q = ball.displacement([0, -100.0, 200.0, 0, 0, 0])
    np.testing.assert_allclose(ball.force(q)[:3], [0, -100.0, 200.0], atol=1e-6)


def test_the_bearing_the_other_way_round_is_its_mirror_image():
    ball = bearing("7205")
    other, load = ball.mirrored(), np.array([30.0, -100.0, 400.0, 0.2, -0.1, 0])
    q = ball.displacement(load)
    np.testing.assert_allclose(other.displacement(MIRROR * load), MIRROR * q, rtol=1e-9, atol=1e-15)
    np.testing.assert_allclose(other.stiffness(MIRROR * q), np.outer(MIRROR, MIRROR) * ball.stiffness(q))
    assert other.mirrored() == replace(ball, open_side="-z")
    with pytest.raises(ValueError, match="towards \\+z"):
        other.displacement([0, 0, 200.0, 0, 0, 0])
    balls, mirrored = Running(ball, 800.0).balls(q), Running(other, 800.0).balls(MIRROR * q)
    np.testing.assert_allclose(mirrored.alpha_o, -balls.alpha_o, rtol=1e-9)


def test_which_bearings_have_an_open_side():
    for name in CATALOGUE:
        made = bearing(name, clearance=None if name.startswith("7") else 1e-5)
        assert made.kernel().shoulder == (1 if name.startswith("7") else 0)
    deep = bearing("6205", clearance=1e-5)
    assert deep.displacement([0, 0, -200, 0, 0, 0])[2] < 0
    assert deep.mirrored() is deep
    free = BallBearing(13, 7e-3, 38.5e-3, 0.52, 0.53, contact_angle=0.7, open_side=None)
    assert free.displacement([0, 0, -200, 0, 0, 0])[2] < 0
    with pytest.raises(ValueError, match="open_side is None"):
        free.mirrored()
    with pytest.raises(ValueError, match="open_side is 'left'"):
        bearing("7205", open_side="left")


def test_a_counterbored_deep_groove_bearing_can_be_described():
    magneto = bearing("6205", clearance=1e-5, open_side="-z")
    assert magneto.displacement([0, 0, 200, 0, 0, 0])[2] > 0
    with pytest.raises(ValueError, match="open side"):
        magneto.displacement([0, 0, -200, 0, 0, 0])


def test_pairs_bear_both_ways_but_a_tandem_does_not():
    row = bearing("7205")
    for arrangement in ("DB", "DF"):
        pair = Pair(row, arrangement, 0.015, preload_force=300.0)
        up, down = (pair.displacement([0, 0, f, 0, 0, 0])[2] for f in (5000.0, -5000.0))
        assert up == pytest.approx(-down)
    tandem = Pair(row, "DT", 0.015)
    assert tandem.displacement([0, 0, 300.0, 0, 0, 0])[2] > 0
    with pytest.raises(ValueError, match="in the first row 13 of 13 balls"):
        tandem.displacement([0, 0, -300.0, 0, 0, 0])
    with pytest.raises(ValueError, match="a row by itself must carry towards"):
        Pair(row.mirrored(), "DB", 0.015)


def test_a_radial_load_alone_is_refused():
    """The ring slides along z until the balls stand on the bottom, at α = 0, where no shoulder begins."""
    ball = bearing("7205")
    assert math.degrees(math.asin(ball.kernel().open_sine)) == pytest.approx(5.0)
    for row in (ball, ball.mirrored(), bearing("6205", clearance=1e-5, open_side="-z")):
        with pytest.raises(
            ValueError, match=r"none of its \d loaded balls leans on the shoulder.*at -?0\.0°"
        ):
            row.displacement([0, -50.0, 0, 0, 0, 0])
    with pytest.raises(ValueError, match="in the first row none of its"):
        Pair(ball, "DT", 0.015).displacement([0, -50.0, 0, 0, 0, 0])
    # two set against each other hold one another, and a groove with two shoulders needs no hold
    assert Pair(ball, "DB", 0.015, preload_force=100.0).displacement([0, -50.0, 0, 0, 0, 0])[1] < 0
    assert replace(ball, open_side=None).displacement([0, -50.0, 0, 0, 0, 0])[1] < 0


def test_single_balls_may_stand_on_the_bottom_while_others_lean():
    """A fifth of the radial load as thrust: the heaviest ball stands below the free angle, others above."""
    ball = bearing("7205")
    q = ball.displacement([0, -300.0, 60.0, 0, 0, 0])
    np.testing.assert_allclose(ball.force(q)[:3], [0, -300.0, 60.0], atol=1e-5)


@pytest.mark.parametrize("what", ["force", "stiffness"])
def test_a_motion_that_presses_balls_onto_the_open_side_is_told_of(what):
    ball = replace(bearing("7205"), fo=0.53)
    place = [0, 0, -0.513e-3, 0, 0, 0]
    with pytest.warns(OpenSideWarning, match=r"at this q 13 of 13 balls .* at -40"):
        getattr(ball, what)(place)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        getattr(ball, what)([0, 0, 5e-6, 0, 0, 0])
        getattr(replace(ball, open_side=None), what)(place)
        getattr(ball, what)([0, 0, -1e-5, 0, 0, 0])  # nothing is pressed
