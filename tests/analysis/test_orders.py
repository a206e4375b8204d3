"""Orders, envelopes, waterfalls and contact statistics, on signals whose answer is known."""

from __future__ import annotations

import math

import numpy as np
import pytest

from bearingdyn.analysis import (
    ball_channels,
    contact_statistics,
    envelope_spectrum,
    equilibrium,
    order_spectrum,
    shaft_angle,
    track_orders,
    transient,
    waterfall,
)
from bearingdyn.application import Application
from bearingdyn.bearing import BallBearing
from bearingdyn.parts import RigidBody
from bearingdyn.results import dataset
from rotors import motor

# a run-up from 20 to 60 turns a second within a second, then held
TIMES, SPEEDS = [0.1, 1.1], [2 * math.pi * 20.0, 2 * math.pi * 60.0]


def angle(t: np.ndarray) -> np.ndarray:
    """Angle of the run-up, written out: 20 Hz until 0.1 s, then growing by 40 Hz a second."""
    s = np.clip(t - 0.1, 0.0, 1.0)
    return 2 * np.pi * (20.0 * np.minimum(t, 0.1) + 20.0 * s + 20.0 * s**2 + 60.0 * np.maximum(t - 1.1, 0.0))


def record(n: int, dt: float, speed=None, decimate: int = 1, **channels):
    """A recorded march whose channels are functions of time."""
    t = dt * decimate * np.arange(1, n + 1)
    run_up = {"speed": np.array(SPEEDS), "speed_time": np.array(TIMES)}
    made = dataset(
        {"record": (("time", "channel"), np.stack([f(t) for f in channels.values()], axis=1), "", "")},
        {"dt": dt, "decimate": decimate, **(run_up if speed is None else {"speed": speed})},
        {"time": (t, "s"), "channel": (list(channels), "")},
    )
    return made.assign_coords(unit=("channel", ["m/s"] * len(channels)))


# ------------------------------------------------------------------- orders


def test_angle_of_the_shaft_is_the_integral_of_its_speed():
    data = record(3000, 5e-4, v=np.sin)
    # round-off of sums
    np.testing.assert_allclose(shaft_angle(data), angle(data.time.values), rtol=1e-12)
    steady = record(100, 1e-3, speed=-300.0, v=np.sin)
    np.testing.assert_allclose(shaft_angle(steady), -300.0 * steady.time.values, rtol=1e-15)


def test_angle_is_the_one_that_the_core_turns_unbalance_by():
    """A free mass pushed by an unbalance: a/Ω² and Ω̇ terms follow cos θ of the core's own angle."""
    app = Application()
    app.add("rotor", RigidBody(1.0, (1.0, 1.0, 1.0)))
    app.ground("rotor.centre", stiffness=(1e-3,) * 6)
    app.unbalance("rotor.centre", 1e-3)
    run = transient(
        equilibrium(app), speed=(TIMES, SPEEDS), dt=1e-4, steps=14000, record=["rotor.centre.x.acceleration"]
    )
    t = run.time.values
    held = t > 1.1005
    theta = shaft_angle(run)
    # past the run-up, x is negligible against 1/Ω²: a = u Ω² cos θ
    wanted = 1e-3 * SPEEDS[1] ** 2 * np.cos(theta[held])
    np.testing.assert_allclose(run.record.values[held, 0], wanted, atol=1e-6 * 1e-3 * SPEEDS[1] ** 2)


def test_orders_of_a_run_up_stand_where_a_frequency_smears():
    data = record(
        28000,
        5e-5,
        v=lambda t: 3.0 + 0.25 * np.cos(3 * angle(t) + 0.7) + 0.1 * np.cos(7.5 * angle(t)),
    )
    found = order_spectrum(data, "v", 10.0)
    # whole turns: 2 at 20 Hz, 40 on the way, 18 after; 7.5 and 3 lie on the grid of 1/turns
    assert found.attrs["turns"] == 59 or found.attrs["turns"] == 60
    turns = found.attrs["turns"]
    for order, size in ((3.0, 0.25), (7.5, 0.1)):
        at = round(order * turns)
        if abs(at / turns - order) < 1e-12:
            # splines through 40 or more samples a period
            assert found.amplitude.values[at] == pytest.approx(size, rel=1e-5)
        else:
            assert found.amplitude.values[at : at + 2].max() > 0.8 * size
    assert found.order.values[-1] <= 10.0
    assert found.order.values[round(3.0 * turns)] == pytest.approx(3.0, rel=1e-12)


@pytest.mark.parametrize(("samples", "tolerance"), [(8, 1e-3), (16, 1e-5)])
def test_amplitude_of_the_highest_order_is_as_good_as_promised(samples, tolerance):
    """Constant speed of one turn a second, order 5, so many samples in its period."""
    n = 20 * 5 * samples + 8
    data = record(
        n, 1 / (5 * samples) * (1 + 1e-9), speed=2 * math.pi, v=lambda t: 0.5 * np.cos(10 * np.pi * t)
    )
    found = order_spectrum(data, "v", 5.0)
    at = int(np.argmin(np.abs(found.order.values - 5.0)))
    assert found.amplitude.values[at] == pytest.approx(0.5, rel=tolerance)


def test_tracked_orders_are_found_as_they_are_with_neighbours_an_order_apart():
    data = record(
        28000,
        5e-5,
        v=lambda t: 1.0 + 0.25 * np.cos(3 * angle(t) + 0.7) + 0.5 * np.sin(4 * angle(t)),
    )
    found = track_orders(data, "v", [3.0, 4.0], turns=4)
    # splines through more than 40 samples a period
    np.testing.assert_allclose(found.amplitude.values[:, 0], 0.25 * np.exp(0.7j), rtol=1e-6)
    np.testing.assert_allclose(found.amplitude.values[:, 1], -0.5j, rtol=1e-6)
    np.testing.assert_allclose(
        found.speed.values,
        2 * np.pi * np.clip(20.0 + 40.0 * (found.time.values - 0.1), 20.0, 60.0),
        rtol=1e-12,
    )


def test_a_shaft_that_turns_backwards_has_the_phases_of_its_own_angle():
    data = record(4000, 1e-3, speed=-100.0, v=lambda t: np.cos(-100.0 * t + 0.7))
    found = track_orders(data, "v", [1.0], turns=4)
    # splines through more than 60 samples a turn
    np.testing.assert_allclose(found.amplitude.values[:, 0], np.exp(0.7j), rtol=1e-6)


def test_a_growing_order_is_followed():
    """Amplitude rising with the speed squared, as an unbalance's force does."""
    data = record(28000, 5e-5, v=lambda t: np.gradient(angle(t), t) ** 2 * np.cos(angle(t)))
    found = track_orders(data, "v", [1.0], turns=4)
    # on the ramp Ω² grows in proportion to the angle: the fit's mean is that of the middle, to what the skew
    # of its basis leaves; pieces across the ends of the ramp left out
    ramp = (found.speed.values > 140.0) & (found.speed.values < 360.0)
    assert ramp.sum() > 10
    size = np.abs(found.amplitude.values[ramp, 0])
    np.testing.assert_allclose(size, found.speed.values[ramp] ** 2, rtol=1e-5)


def test_orders_need_a_shaft_that_turns():
    data = record(400, 1e-3, speed=0.0, v=np.sin)
    with pytest.raises(ValueError, match="the shaft stands"):
        order_spectrum(data, "v", 5.0)
    slow = record(400, 1e-3, speed=2 * math.pi, v=np.sin)
    with pytest.raises(ValueError, match="less than one turn"):
        order_spectrum(slow, "v", 5.0)
    fast = record(400, 1e-3, speed=2 * math.pi * 100, v=np.sin)
    with pytest.raises(ValueError, match="two samples for order 5"):
        order_spectrum(fast, "v", 5.1)
    with pytest.raises(ValueError, match="orders is"):
        track_orders(fast, "v", [])
    with pytest.raises(ValueError, match="turns is 1"):
        track_orders(fast, "v", [1.0], turns=1)
    with pytest.raises(ValueError, match="less than 50 turns"):
        track_orders(fast, "v", [1.0], turns=50)


# ------------------------------------------------------------------- envelope, waterfall


@pytest.mark.parametrize("window", ["hann", "none"])
def test_envelope_shows_the_modulation_of_a_carrier(window):
    """A (1 + m cos ω_m t) cos ω_c t beside a stronger low line and noise out of the band."""
    A, m = 0.02, 0.4

    def signal(t):
        carrier = A * (1 + m * np.cos(2 * np.pi * 37 * t + 0.3)) * np.cos(2 * np.pi * 3000 * t)
        return carrier + 1.5 * np.cos(2 * np.pi * 50 * t) + 0.3 * np.cos(2 * np.pi * 7000 * t)

    data = record(20000, 5e-5, speed=0.0, v=signal)
    found = envelope_spectrum(data, "v", (2500.0, 3500.0), window)
    # whole periods: round-off of the transform
    assert found.amplitude.values[37] == pytest.approx(A * m, rel=1e-9)
    assert found.envelope.values.mean() == pytest.approx(A, rel=1e-9)
    beside = np.delete(found.amplitude.values, [36, 37, 38])
    assert beside.max() < 1e-9 * A
    assert found.frequency.values[-1] == 1000.0


def test_impacts_that_ring_a_resonance_show_at_their_rate():
    """A pit met 90 times a second rings 4 kHz: 90 Hz is the strongest line of the envelope."""

    def ringing(t):
        since = np.mod(t, 1 / 90)
        return np.exp(-since / 8e-4) * np.sin(2 * np.pi * 4000 * since)

    data = record(40000, 2.5e-5, speed=0.0, v=ringing)
    found = envelope_spectrum(data, "v", (3000.0, 5000.0))
    assert found.frequency.values[int(found.amplitude.values.argmax())] == pytest.approx(90.0, abs=1.0)


def test_waterfall_holds_the_amplitude_in_every_piece():
    data = record(8000, 1e-4, decimate=2, v=lambda t: 2.0 + 0.3 * np.cos(2 * np.pi * 250 * t))
    found = waterfall(data, "v", 0.1, overlap=0.75)
    assert found.amplitude.shape == (61, 251)
    np.testing.assert_allclose(found.amplitude.values[:, 25], 0.3, rtol=1e-12)
    assert found.frequency.values[25] == pytest.approx(250.0)
    # middles of pieces of 500 samples, and the speed there
    assert found.time.values[0] == pytest.approx(0.5 * (2e-4 + 0.1), rel=1e-12)
    assert found.time.values[1] - found.time.values[0] == pytest.approx(0.025, rel=1e-9)
    wanted = 2 * np.pi * np.clip(20.0 + 40.0 * (found.time.values - 0.1), 20.0, 60.0)
    np.testing.assert_allclose(found.speed.values, wanted, rtol=1e-12)


def test_a_swept_line_climbs_through_the_waterfall():
    data = record(28000, 5e-5, v=lambda t: np.cos(5 * angle(t)))
    found = waterfall(data, "v", 0.1)
    peak = found.frequency.values[found.amplitude.values.argmax(axis=1)]
    # within 0.1 s the line moves by 20 Hz, two lines of the grid
    assert np.abs(peak - 5 * found.speed.values / (2 * np.pi)).max() <= 15.0


@pytest.mark.parametrize(
    ("act", "message"),
    [
        (lambda d: envelope_spectrum(d, "v", (100.0, 50.0)), "band is 100 to 50 Hz"),
        (lambda d: envelope_spectrum(d, "v", (100.0, 600.0)), "below 500 Hz"),
        (lambda d: envelope_spectrum(d, "w", (100.0, 200.0)), "'w' was not recorded"),
        (lambda d: envelope_spectrum(d, "v", (1.0, 2.0), "flat"), "window is 'flat'"),
        (lambda d: waterfall(d, "v", 5.0), "length is 5.0 s"),
        (lambda d: waterfall(d, "v", np.nan), "length is nan"),
        (lambda d: waterfall(d, "v", 0.1, overlap=1.0), "overlap is 1.0"),
        (lambda d: contact_statistics(d, "left"), "were not all recorded"),
    ],
)
def test_bad_requests_are_named(act, message):
    with pytest.raises(ValueError, match=message):
        act(record(1000, 1e-3, speed=1.0, v=np.sin))


# ------------------------------------------------------------------- contact


def test_contact_statistics_count_what_was_put_in():
    """Ball 1 always loaded; ball 2 free for 3 ms of 10, twice; ball 3 free but for the last millisecond."""
    t = np.arange(1, 101) * 1e-4

    def second(_):
        return np.where((np.arange(100) // 15) % 3 == 1, 0.0, 5.0)

    data = record(
        100,
        1e-4,
        speed=1.0,
        **{
            "left.ball1": lambda t: 10.0 + np.sin(t),
            "left.ball2": second,
            "left.ball3": lambda t: np.where(np.arange(100) >= 90, 2.0, 0.0),
        },
    )
    found = contact_statistics(data, "left")
    np.testing.assert_allclose(found.free.values, [0.0, 0.30, 0.90])
    assert list(found.losses.values) == [0, 2, 0]
    np.testing.assert_allclose(found.longest.values, [0.0, 15e-4, 90e-4])
    assert found.peak.values[0] == pytest.approx(10.0 + math.sin(t[-1]))
    assert found["mean"].values[2] == pytest.approx(0.2)
    assert found.loaded.values.sum() == pytest.approx(1.0)
    # ball 3's last ten: ball 2 is loaded there
    np.testing.assert_allclose(found.loaded.values, [0.0, 0.30, 0.60, 0.10])


def test_a_ball_passes_the_load_zone_once_a_cage_turn():
    """Radial load, clearance: every ball carries through the same zone and is free through the rest."""
    bearing = BallBearing(8, 12.303e-3, 52e-3, 0.52, 0.53, clearance=40e-6, damping=100.0)
    app = Application()
    app.add("rotor", RigidBody(5.0, (0.02, 0.02, 0.01)))
    app.ground("rotor.centre", damping=(2e4, 2e4, 2e4, 20.0, 20.0, 20.0))
    app.bearing("b", bearing, inner="rotor.centre", outer="ground")
    app.load("rotor.centre", (0, -800.0, 0, 0, 0, 0))
    state = equilibrium(app)
    turn = 2 * math.pi / (bearing.cage_ratio * 50.0)
    run = transient(
        state,
        speed=50.0,
        dt=turn / 8000,
        steps=16000,
        settle=8000,
        record=[*ball_channels(state, "b"), "b.loaded"],
    )
    found = contact_statistics(run, "b")
    assert list(found.losses.values) == [2] * 8
    # a quasi-static passage: alike for all balls, to a step or so
    np.testing.assert_allclose(found.free.values, found.free.values.mean(), atol=5e-3)
    # as many are loaded as the march's own channel says
    counts = np.bincount(run.record.sel(channel="b.loaded").values.astype(int), minlength=9) / 16000
    np.testing.assert_allclose(found.loaded.values, counts)
    with pytest.raises(ValueError, match="there is no bearing 'c'"):
        ball_channels(state, "c")


def test_ball_channels_are_those_that_the_march_records():
    state = equilibrium(motor())
    run = transient(state, speed=0.0, dt=1e-5, steps=2, record=ball_channels(state, "left"))
    np.testing.assert_allclose(run.record.values[0], state.bearings["left"].loads, rtol=1e-6)
