"""Damping from a table whose first value is not zero, in contacts that only the film presses."""

from __future__ import annotations

import math

import numpy as np
import pytest

from bearingdyn import core
from bearingdyn.bearing import BallBearing, FilmDamping, TabulatedDamping
from twins import bearing_twin

FILM, C = 2e-6, (10.0, 30.0)  # m, N s/m
TABLE = (2e-6, 8e-6)  # m


# z of the inner ring, m, and the c that the table gives there: held below and above, linear between
@pytest.mark.parametrize("z", [-1e-6, 1e-6, 12e-6, 40e-6])
def test_ends_of_a_damping_table_are_held(z: float) -> None:
    """Axially, F = Z sin α (κ(δ + film)^{3/2} + c(δ) δ̇) with c below the table its first value."""
    free = 0.4
    ball = BallBearing(
        8, 12.303e-3, 52e-3, 0.52, 0.53, contact_angle=free, film=FILM, damping=TabulatedDamping(TABLE, C)
    )
    A = 0.05 * ball.Dw  # (fi + fo − 1) Dw
    length = math.hypot(A * math.sin(free) + z, A * math.cos(free))
    sine, delta = (A * math.sin(free) + z) / length, length - A
    c = float(np.interp(delta, TABLE, C))
    q, velocity = np.array([0, 0, z, 0, 0, 0]), np.array([0, 0, 1e-3, 0, 0, 0])
    press = ball.kappa * (delta + FILM) ** 1.5
    assert press > 0  # the film carries, below zero indentation too
    # round-off of δ, a difference of millimetres, in its film
    assert ball.force(q)[2] == pytest.approx(8 * sine * press, rel=1e-8)
    assert ball.force(q, velocity=velocity)[2] == pytest.approx(
        8 * sine * (press + c * sine * 1e-3), rel=1e-8
    )
    assert ball.damping_matrix(q)[2, 2] == pytest.approx(8 * c * sine**2, rel=1e-8)


def test_the_table_covers_all_three_cases() -> None:
    """The z above lie below the table (one with δ < 0), within it and beyond it."""
    deltas = [
        math.hypot(0.05 * 12.303e-3 * math.sin(0.4) + z, 0.05 * 12.303e-3 * math.cos(0.4)) - 0.05 * 12.303e-3
        for z in (-1e-6, 1e-6, 12e-6, 40e-6)
    ]
    assert -FILM < deltas[0] < 0 < deltas[1] < TABLE[0] < deltas[2] < TABLE[1] < deltas[3]


W = np.linspace(0, 1, 65)
FADING = FilmDamping(2e-6, 40 * W**3 * (1.4 - 0.5 * W))


def test_film_damping_is_the_curve_of_its_nodes() -> None:
    ball = BallBearing(8, 12.303e-3, 52e-3, 0.52, 0.53, contact_angle=0.4, film=FILM, damping=FADING)
    A = 0.05 * ball.Dw
    for z in (-4e-6, -1e-6, 1e-6, 12e-6, 60e-6):
        length = math.hypot(A * math.sin(0.4) + z, A * math.cos(0.4))
        sine, s = (A * math.sin(0.4) + z) / length, length - A + FILM
        w = math.sqrt(s) / (math.sqrt(s) + math.sqrt(2e-6))
        # cubics between nodes 1/64 apart follow a quartic to (1/64)³ of its bends
        assert ball.damping_matrix([0, 0, z, 0, 0, 0])[2, 2] == pytest.approx(
            8 * sine**2 * 40 * w**3 * (1.4 - 0.5 * w), rel=2e-3
        )


@pytest.mark.parametrize("Z", [3, 5, 9, 17, 24, 33, 35, 47, 65])
def test_a_film_law_of_many_balls_is_that_of_each(Z: int) -> None:
    """Registers go in groups (csrc/ehl.c): of any number of balls, against the twin, ball by ball."""
    ball = BallBearing(Z, 2e-3, 60e-3, 0.52, 0.53, contact_angle=0.4, film=FILM, damping=FADING)
    kernel = ball.kernel()
    z, rate = np.array([2e-6, -9e-6, 3e-6, 1e-6, -2e-6]), np.array([1e-3, -2e-3, 1e-3, 0.02, 0.01])
    got = core.bearing_force(kernel, z, rate, 0.3, 200.0)
    want = bearing_twin.bearing_force(kernel, z, rate, 0.3, 200.0)
    assert 0 < np.count_nonzero(got[3]) < Z
    for each, other in zip(got, want, strict=True):
        # round-off of δ, a difference of 60 mm, in its film
        np.testing.assert_allclose(each, other, rtol=1e-9, atol=1e-9 * np.abs(other).max())


def test_force_and_tangent_vanish_together_where_contact_is_lost() -> None:
    ball = BallBearing(8, 12.303e-3, 52e-3, 0.52, 0.53, contact_angle=0.4, film=FILM, damping=FADING)
    A = 0.05 * ball.Dw
    # the film opens where the line between the groove centres is FILM shorter than A
    lost = math.sqrt((A - FILM) ** 2 - (A * math.cos(0.4)) ** 2) - A * math.sin(0.4)
    last = np.inf
    for step in (1e-7, 1e-8, 1e-9):
        q = [0, 0, lost + step, 0, 0, 0]
        # both parts fall as s^1.5, to .03 for a tenth of s; round-off of s spoils the last
        force = abs(ball.force(q, velocity=[0, 0, 1e-2, 0, 0, 0])[2])
        assert force < 0.2 * last
        last = force
    assert ball.damping_matrix([0, 0, lost - 1e-9, 0, 0, 0])[2, 2] == 0


@pytest.mark.parametrize(
    ("scale", "c", "message"),
    [
        (0.0, W, "damping.scale is 0.0"),
        (1e-6, W + 1, r"damping.c\[0\] is 1.0"),
        (1e-6, -W, "damping.c is "),
        (1e-6, W[1:], "damping.c "),
        (1e-6, np.where(W == 1, np.nan, W), "damping.c"),
    ],
)
def test_bad_film_damping_is_named(scale: float, c: np.ndarray, message: str) -> None:
    with pytest.raises(ValueError, match=message):
        FilmDamping(scale, c)
