"""Decimation: no aliases, no delay, and the same bits however a march is cut."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import scipy.signal
import xarray

import bearingdyn as bd
from bearingdyn.analysis.decimation import Decimator, half_length, taps
from rotors import oscillator


@pytest.mark.parametrize("every", [2, 3, 10, 37, 100])
def test_the_low_pass_is_level_below_and_gone_above(every: int) -> None:
    """By SciPy's freqz of the whole filter: ±0.1 % to 0.8 of the new Nyquist, −80 dB from 1.0 on."""
    half = taps(every)
    whole = np.concatenate([half[:0:-1], half])
    f, response = scipy.signal.freqz(whole, worN=2**17, fs=2 * every)  # new Nyquist: 1
    level = np.abs(response)
    assert np.abs(level[f <= 0.8] - 1).max() < 1e-3
    assert level[f >= 1.0].max() < 1e-4
    assert len(half) - 1 == half_length(every) <= 26.5 * every + 1


@pytest.mark.parametrize("every", [2, 7])
def test_the_same_bits_in_any_pieces(every: int) -> None:
    rng = np.random.default_rng(every)
    rows, half = rng.standard_normal((3000, 3)), half_length(every)
    plain = np.array([False, True, False])
    whole = Decimator(every, plain, 5, None)
    whole.add(rows[:2000])
    expected = whole.take(rows[2000 : 2000 + half])
    # the filter of SciPy at the same places
    kernel = np.concatenate([taps(every)[:0:-1], taps(every)])
    centres = np.arange(2000)[(np.arange(2000) + 6) % every == 0]
    padded = np.concatenate([np.repeat(rows[:1], half, axis=0), rows])
    np.testing.assert_array_equal(expected[:, 1], rows[centres, 1])
    for channel in (0, 2):
        full = scipy.signal.convolve(padded[:, channel], kernel, mode="valid")
        np.testing.assert_allclose(expected[:, channel], full[centres], atol=1e-13)
    for _ in range(10):
        cuts = np.sort(rng.choice(np.arange(1, 2000), 5, replace=False))
        pieces, at = Decimator(every, plain, 5, None), 0
        found = []
        for cut in [*cuts, 2000]:
            pieces.add(rows[at:cut])
            found.append(pieces.take(rows[cut : cut + half]))
            at = cut
        np.testing.assert_array_equal(np.concatenate(found), expected)


def shaken(frequency: float = 400.0) -> bd.Equilibrium:
    app = oscillator(2.0, 400.0, 5e5)
    app.load("body.centre", (0, 10.0, 0, 0, 0, 0), frequency=frequency)
    return bd.equilibrium(app)


def test_what_is_too_fast_for_the_samples_is_gone_and_the_rest_is_where_it_was() -> None:
    """Two forces, 100 Hz and 9100 Hz; kept every 1 ms / 9 the second one would look like 100 Hz."""
    app = oscillator(2.0, 400.0, 5e5)
    app.load("body.centre", (0, 10.0, 0, 0, 0, 0), frequency=100.0)
    slow = bd.equilibrium(app)
    app.load("body.centre", (0, 1000.0, 0, 0, 0, 0), frequency=9100.0)
    both = bd.equilibrium(app)
    dt, every = 1e-5 / 9, 100
    arguments = {
        "speed": 0.0, "dt": dt, "steps": 20_000, "settle": 60_000, "record": ["body.centre.y.acceleration"]
    }  # fmt: skip
    fine = bd.transient(slow, **arguments).record.values[every - 1 :: every, 0]
    wanted = bd.transient(slow, decimate=every, filter=False, **arguments).record.values[:, 0]
    aliased = bd.transient(both, decimate=every, filter=False, **arguments).record.values[:, 0]
    found = bd.transient(both, decimate=every, **arguments)
    assert len(fine) == len(wanted) == len(found.time)
    size = np.abs(wanted).max()
    np.testing.assert_array_equal(wanted, fine)
    assert np.abs(aliased - wanted).max() > 10 * size
    # ±0.1 % of the slow one at no delay; −80 dB of the fast one, 500 m/s²
    np.testing.assert_allclose(found.record.values[:, 0], wanted, rtol=0, atol=1e-3 * size + 1e-4 * 500)
    assert found.attrs["filter"] == 1


RECORD = ["rotor.centre.y", "rotor.centre.y.velocity", "ball.loaded"]


def rattling() -> bd.Equilibrium:
    rubber = bd.Maxwell(4e6, [1e6, 2e6], [1e-4, 1e-3], K=2e9, density=1150.0)
    app = bd.Application()
    app.add("rotor", bd.RigidBody(4.0, (0.02, 0.02, 0.004), rotating=True))
    app.add("layer", bd.Layer(0.026, 0.029, 0.016, rubber))
    ball = bd.BallBearing(9, 7.94e-3, 39.04e-3, 0.52, 0.53, clearance=1e-5, damping=30.0)
    app.bearing("ball", ball, inner="rotor.centre", outer="layer.inner")
    app.ground("layer.outer")
    app.load("rotor.centre", (0, -400, 100, 0, 0, 0))
    return bd.equilibrium(app)


def run(start: bd.Equilibrium, **changes: object) -> xarray.Dataset:
    return bd.transient(
        start, **{"speed": 300.0, "dt": 5e-6, "steps": 3000, "decimate": 4, "record": RECORD} | changes
    )


@pytest.mark.parametrize("settle", [0, 50, 700])
def test_resumed_and_streamed_marches_are_the_same_bits(
    settle: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Cuts within the filter's reach of the start, of each other and of the end of settling."""
    start = rattling()
    whole = run(start, settle=settle)
    for cut in (5, 30, 431, 2990):
        first = run(start, settle=settle, steps=cut)
        second = run(start, steps=3000 - cut, resume=first)
        np.testing.assert_array_equal(np.concatenate([first.record, second.record]), whole.record)
        np.testing.assert_allclose(np.concatenate([first.time, second.time]), whole.time, rtol=1e-14)
        np.testing.assert_array_equal(second.state, whole.state)
    # pieces of 450 steps: 106 steps are looked back and ahead
    monkeypatch.setattr("bearingdyn.analysis.march_pieces.CHUNK_STEPS", 450)
    path = tmp_path / "a.run"
    np.testing.assert_array_equal(run(start, settle=settle, stream=path).record, whole.record)
    data = path.read_bytes()
    for share in (0.2, 0.5, 0.8, 0.99):
        path.write_bytes(data[: int(share * len(data))])
        again = run(start, settle=settle, stream=path)
        for name in ("record", "state", "time"):
            np.testing.assert_array_equal(again[name], whole[name])


def test_counts_are_sampled_and_one_in_one_is_untouched() -> None:
    start = rattling()
    plain, filtered = run(start, filter=False), run(start)
    loaded = {"channel": "ball.loaded"}
    np.testing.assert_array_equal(filtered.record.sel(loaded), plain.record.sel(loaded))
    assert not np.array_equal(filtered.record, plain.record)
    np.testing.assert_array_equal(filtered.state, plain.state)
    np.testing.assert_array_equal(filtered.time, plain.time)
    every, same = run(start, decimate=1, filter=False), run(start, decimate=1)
    np.testing.assert_array_equal(every.record, same.record)
    assert same.attrs["filter"] == 0
    assert "tail" not in same
