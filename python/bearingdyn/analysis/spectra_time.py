"""Spectra of what changes with time: the envelope of a band, and the spectrum piece by piece."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from bearingdyn.analysis.spectra import (
    amplitudes,
    check_window,
    sampling_time,
    signal_of,
    speed_profile,
    unit_of,
)

if TYPE_CHECKING:
    import xarray


def envelope_spectrum(
    result: xarray.Dataset, channel: str, band: tuple[float, float], window: str = "hann"
) -> xarray.Dataset:
    """Amplitude spectrum (zero-to-peak) of the envelope of a recorded channel within a band, Hz.

    The band is cut out without a skirt and made analytic in the frequency domain (Hilbert transform); the
    envelope is its modulus. Impacts that ring a resonance in the band show at the rate they repeat at. A
    carrier A (1 + m cos ω_m t) cos ω_c t shows A·m at ω_m.

    Returns a Dataset with amplitude (frequency), the mean of the envelope left out, up to the width of the
    band, and envelope (time).

    Raises ValueError for an unknown channel or window, a band that is none or beyond half the sampling rate,
    or fewer than four samples.
    """
    check_window(window)
    signal = signal_of(result, channel)
    n, dt = signal.size, sampling_time(result)
    if n < 4:
        raise ValueError(f"channel {channel!r} holds {n} samples; a spectrum needs four or more")
    low, high = (float(f) for f in band)
    if not 0 <= low < high <= 0.5 / dt * (1 + 1e-12):
        raise ValueError(f"band is {low:g} to {high:g} Hz; it must rise and end below {0.5 / dt:g} Hz")
    lines = np.fft.fft(signal)
    frequency = np.fft.fftfreq(n, dt)
    inside = (frequency >= low) & (frequency <= high) & (frequency > 0)
    analytic = np.fft.ifft(np.where(inside, 2.0 * lines, 0.0))
    envelope = np.abs(analytic)
    amplitude = amplitudes(envelope, window)
    over = np.fft.rfftfreq(n, dt)
    keep = over <= high - low

    from bearingdyn.results import dataset

    unit = unit_of(result, channel)
    return dataset(
        {
            "amplitude": ("frequency", amplitude[keep], unit, f"envelope of {channel}, zero-to-peak"),
            "envelope": ("time", envelope, unit, f"envelope of {channel}"),
        },
        {"analysis": "envelope spectrum", "channel": channel, "window": window, "band": [low, high]},
        {"frequency": (over[keep], "Hz"), "time": (result["time"].values, "s")},
    )


def waterfall(
    result: xarray.Dataset, channel: str, length: float, overlap: float = 0.5, window: str = "hann"
) -> xarray.Dataset:
    """Amplitude spectra (zero-to-peak) of pieces of a record, each `length` s long, one after another.

    overlap: share of a piece that the next repeats, 0 ≤ overlap < 1. The resolution is 1/length.

    Returns a Dataset with amplitude (time, frequency), at the middle of each piece, and speed (time), rad/s.

    Raises ValueError for an unknown channel or window, a piece of fewer than four samples or longer than the
    record, or an overlap outside its range.
    """
    check_window(window)
    signal = signal_of(result, channel)
    dt = sampling_time(result)
    n = round(length / dt) if length > 0 and np.isfinite(length) else 0
    if not 4 <= n <= signal.size:
        raise ValueError(
            f"length is {length} s, {n} samples; it must hold four or more and at most the record's "
            f"{signal.size}"
        )
    if not 0 <= overlap < 1:
        raise ValueError(f"overlap is {overlap}; it must lie in 0 <= overlap < 1")
    step = max(1, round(n * (1.0 - overlap)))
    pieces = np.lib.stride_tricks.sliding_window_view(signal, n)[::step]
    time = np.asarray(result["time"].values, dtype=np.float64)
    middle = time[: len(pieces) * step : step][: len(pieces)] + 0.5 * (n - 1) * dt

    from bearingdyn.results import dataset

    return dataset(
        {
            "amplitude": (
                ("time", "frequency"),
                amplitudes(pieces, window),
                unit_of(result, channel),
                f"{channel}, zero-to-peak",
            ),
            "speed": ("time", np.interp(middle, *speed_profile(result)), "rad/s", "speed of the shaft"),
        },
        {"analysis": "waterfall", "channel": channel, "window": window, "length": n * dt},
        {"time": (middle, "s"), "frequency": (np.fft.rfftfreq(n, dt), "Hz")},
    )
