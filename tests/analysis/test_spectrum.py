"""Spectra and orbits of recorded channels, on records whose content is known."""

from __future__ import annotations

import numpy as np
import pytest

from bearingdyn.analysis import orbit, spectrum
from bearingdyn.results import dataset


def record(n: int, dt: float = 1e-3, decimate: int = 1, **channels):
    """A recorded march whose channels are functions of time."""
    t = dt * decimate * np.arange(1, n + 1)
    made = dataset(
        {"record": (("time", "channel"), np.stack([f(t) for f in channels.values()], axis=1), "", "")},
        {"dt": dt, "decimate": decimate},
        {"time": (t, "s"), "channel": (list(channels), "")},
    )
    return made.assign_coords(unit=("channel", ["m/s"] * len(channels)))


@pytest.mark.parametrize("window", ["hann", "none"])
@pytest.mark.parametrize("n", [1000, 1001])
@pytest.mark.parametrize("decimate", [1, 4])
def test_a_sine_on_the_grid_shows_its_amplitude(window, n, decimate):
    line = 37 / (n * 1e-3 * decimate)
    data = record(n, decimate=decimate, v=lambda t: 5.0 + 0.25 * np.cos(2 * np.pi * line * t + 0.7))
    found = spectrum(data, "v", window)
    # round-off of the transform
    assert found.frequency.values[37] == pytest.approx(line, rel=1e-12)
    assert found.amplitude.values[37] == pytest.approx(0.25, rel=1e-12)
    beside = np.delete(found.amplitude.values, [36, 37, 38] if window == "hann" else [37])
    assert beside.max() < 1e-12
    if window == "hann":
        # a Hann window spreads half to each neighbour
        np.testing.assert_allclose(found.amplitude.values[[36, 38]], 0.125, rtol=1e-12)
    assert found.amplitude.attrs["units"] == "m/s"


def test_the_last_line_is_not_doubled():
    """At half the sampling frequency there is no mirror line."""
    data = record(64, v=lambda t: 0.5 * np.cos(np.pi * np.arange(64)))
    assert spectrum(data, "v", "none").amplitude.values[-1] == pytest.approx(0.5, rel=1e-13)


def test_energy_of_the_lines_is_that_of_the_signal():
    rng = np.random.default_rng(0)
    noise = rng.standard_normal(501)
    amplitude = spectrum(record(501, v=lambda t: noise), "v", "none").amplitude.values
    # Parseval, odd length: mean square = Σ A²/2
    assert (amplitude**2).sum() / 2 == pytest.approx(noise.var(), rel=1e-12)


def test_orbit_is_about_the_static_deflection():
    data = record(
        400,
        x=lambda t: 3e-6 + 1e-6 * np.cos(10 * np.pi * t),
        y=lambda t: -7e-6 + 2e-6 * np.sin(10 * np.pi * t),
    )
    found = orbit(data, "x", "y")
    assert found.attrs["mean_x"] == pytest.approx(3e-6, rel=1e-9)
    assert found.attrs["mean_y"] == pytest.approx(-7e-6, rel=1e-9)
    np.testing.assert_allclose((found.x / 1e-6) ** 2 + (found.y / 2e-6) ** 2, 1.0, rtol=1e-9)
    assert np.array_equal(found.time, data.time)


def test_unknown_requests_are_named():
    data = record(8, v=np.sin)
    with pytest.raises(ValueError, match=r"'w' was not recorded; there are \['v'\]"):
        spectrum(data, "w")
    with pytest.raises(ValueError, match="'w' was not recorded"):
        orbit(data, "v", "w")
    with pytest.raises(ValueError, match="window is 'flat'"):
        spectrum(data, "v", "flat")
    with pytest.raises(ValueError, match="3 samples"):
        spectrum(record(3, v=np.sin), "v")
