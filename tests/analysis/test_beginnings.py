"""How a march begins: loads before their table, speed before its profile, the first acceleration."""

from __future__ import annotations

import math

import numpy as np
import pytest

from bearingdyn.analysis import equilibrium, transient
from bearingdyn.application import Application
from bearingdyn.parts import RigidBody
from rotors import oscillator

# ---------------------------------------------------------------- loads


def test_a_sampled_load_acts_with_its_first_value_before_its_table_and_with_its_last_after() -> None:
    """From rest under F held throughout: x = F/k (1 − cos ωt), and a = F/m at once."""
    m, k, F, dt = 2.0, 5e5, 100.0, 1e-5
    app = oscillator(m, 0.0, k)
    app.load("body.centre", (0, F, 0, 0, 0, 0), time=[0.01, 0.02], value=[1.0, 1.0])
    names = ["body.centre.y", "body.centre.y.acceleration"]
    found = transient(equilibrium(app), speed=0.0, dt=dt, steps=3000, record=names)
    t, w = found.time.values, math.sqrt(k / m)
    x, a = found.record.values.T
    # phase error ωt (ωΔt)²/12 of the average acceleration, at 15 rad
    error = 15 * (w * dt) ** 2 / 12
    np.testing.assert_allclose(x, F / k * (1 - np.cos(w * t)), atol=1.1 * error * F / k)
    np.testing.assert_allclose(a, F / m * np.cos(w * t), atol=1.1 * error * F / m)


def test_a_load_that_starts_late_holds_the_static_deflection_before() -> None:
    """A table that begins at 0.5 F and rises: well damped, the body waits at 0.5 F/k until the ramp."""
    m, k, F, late = 2.0, 5e5, 100.0, 0.05
    # half of critical damping: e^{−0.5·500·0.05} = 4e-6 is left of the start when the ramp begins
    app = oscillator(m, math.sqrt(k * m), k)
    app.load("body.centre", (0, F, 0, 0, 0, 0), time=[late, 2 * late], value=[0.5, 1.0])
    found = transient(equilibrium(app), speed=0.0, dt=1e-5, steps=15000, record=["body.centre.y"])
    y = found.record.values[:, 0]
    assert y[found.time.values < late][-1] == pytest.approx(0.5 * F / k, rel=1e-5)
    assert y[-1] == pytest.approx(F / k, rel=1e-5)


# ---------------------------------------------------------------- speed


@pytest.mark.parametrize("first", [0.0, 0.03])
def test_the_shaft_has_turned_since_time_zero_before_its_profile_begins(first: float) -> None:
    """An unbalance u at the angle φ = ∫Ω dt from t = 0: m ẍ + k x = u (Ω² cos φ + Ω̇ sin φ)."""
    m, k, u, dt = 2.0, 5e5, 1e-3, 2e-5
    times, speeds = np.array([first, first + 0.05]), np.array([150.0, 400.0])
    app = Application()
    app.add("rotor", RigidBody(m, (0.01, 0.01, 0.02), rotating=True))
    app.ground("rotor.centre", stiffness=(k,) * 6)
    app.unbalance("rotor.centre", u)
    names = [f"rotor.centre.{axis}{rate}" for axis in "xy" for rate in ("", ".acceleration")]
    found = transient(equilibrium(app), speed=(times, speeds), dt=dt, steps=5000, record=names)
    t = found.time.values
    speed = np.interp(t, times, speeds)
    rate = np.where((t > first) & (t < first + 0.05), 250.0 / 0.05, 0.0)
    # constant before, a parabola within, constant after
    within = np.clip(t - first, 0.0, 0.05)
    angle = 150.0 * t + 2500.0 * within**2 + 250.0 * np.maximum(t - first - 0.05, 0.0)
    x, ax, y, ay = found.record.values.T
    inside = np.abs(t - first) > dt
    inside &= np.abs(t - first - 0.05) > dt  # the rate jumps at the knots
    # the scheme satisfies the equation of motion at every step: round-off of k x
    for got, wanted in (
        (m * ax + k * x, u * (speed**2 * np.cos(angle) + rate * np.sin(angle))),
        (m * ay + k * y, u * (speed**2 * np.sin(angle) - rate * np.cos(angle))),
    ):
        np.testing.assert_allclose(got[inside], wanted[inside], atol=1e-9 * u * 400.0**2 * 10)


def test_balls_have_passed_as_often_as_the_shaft_has_turned_before_its_profile_begins() -> None:
    """The number of loaded balls changes with the cage: the same course as with the speed held from t = 0."""
    from bearingdyn.bearing import BallBearing

    app = Application()
    app.add("rotor", RigidBody(2.0, (0.01, 0.01, 0.005)))
    ball = BallBearing(8, 12.303e-3, 52e-3, 0.52, 0.53, clearance=40e-6, damping=300.0)
    app.bearing("b", ball, inner="rotor.centre", outer="ground")
    app.ground("rotor.centre", stiffness=(0, 0, 1e5, 1e4, 1e4, 1e4), damping=(1e3,) * 3 + (5.0,) * 3)
    app.load("rotor.centre", (0.0, -300.0, 0, 0, 0, 0))
    course = []
    speed, first = 100.0, 0.033
    for profile in (speed, ([first, 1.0], [speed, speed])):
        run = transient(equilibrium(app), speed=profile, dt=2e-5, steps=3000, record=["rotor.centre.x"])
        course.append(run.record.values[:, 0])
    # the ball passes 8·0.4·100/2π = 51 times a second: three passages in the record; Newton's 1e-9
    assert np.ptp(course[0]) > 1e-7
    np.testing.assert_allclose(course[1], course[0], atol=1e-6 * np.ptp(course[0]))


# ---------------------------------------------------------------- the first acceleration


@pytest.mark.parametrize("axis", ["x", "y"])
def test_a_tilted_disc_at_rest_is_pushed_across_its_tilt_when_it_is_spun_up(axis: str) -> None:
    """Angular momentum IpΩ n, n the tilted axis (θy, −θx, 1): It θ̈y = Ip Ω̇ θx and It θ̈x = −Ip Ω̇ θy.

    The first step of the average acceleration is v = (a(0) + a(Δt)) Δt/2, both the same to Δt.
    """
    It, Ip, tilt, rate, dt = 0.01, 0.018, 1e-3, 5000.0, 1e-6
    app = Application()
    app.add("disc", RigidBody(2.0, (It, It, Ip), rotating=True))
    # no stiffness across the tilt acts at the start, for nothing is displaced there
    app.ground("disc.centre", stiffness=(1e4, 1e4, 1e4, 1.0, 1.0, 1.0))
    start = {"disc.centre": [0, 0, 0, tilt, 0, 0] if axis == "x" else [0, 0, 0, 0, tilt, 0]}
    across, sign = ("y", 1.0) if axis == "x" else ("x", -1.0)
    found = transient(
        equilibrium(app),
        speed=([-1.0, 1.0], [-rate, rate]),  # at rest at t = 0, on its way up
        dt=dt,
        steps=1,
        record=[f"disc.centre.θ{across}.velocity"],
        initial=start,
    )
    wanted = sign * Ip * rate * tilt / It
    # what changes within the step: the speed, Ω̇Δt·Ip/It·θ̇ and the spring, 1e-6 of it
    assert found.record.values[0, 0] / dt == pytest.approx(wanted, rel=1e-5)
