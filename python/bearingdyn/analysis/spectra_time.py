"""Spectra of signals that change with time: of the envelope in a band, and of one piece after another."""

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
    """Amplitude spectrum (zero-to-peak) of the envelope of a recorded channel within a band.

    The band is cut out with sharp edges in the frequency domain and made analytic there (Hilbert transform);
    the envelope is the absolute value. Impacts that excite a resonance in the band show at their rate of
    repetition. A carrier A (1 + m cos ω_m t) cos ω_c t shows A·m at ω_m.

    Parameters
    ----------
    result
        As `transient` returns it.
    channel
        Name of a recorded channel.
    band
        Lower and upper limit, Hz.
    window
        "hann" or "none".

    Returns
    -------
    xarray.Dataset
        amplitude (frequency), without the mean of the envelope, up to the width of the band; and envelope
        (time).

    Raises
    ------
    ValueError
        For an unknown channel or window, a band that does not rise or passes half the sampling rate, and for
        fewer than four samples.
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
    """Amplitude spectra (zero-to-peak) of one piece of a record after another.

    Parameters
    ----------
    result
        As `transient` returns it.
    channel
        Name of a recorded channel.
    length
        Of a piece, s; the resolution is 1/length.
    overlap
        Share of a piece that the next one repeats, 0 ≤ overlap < 1.
    window
        "hann" or "none".

    Returns
    -------
    xarray.Dataset
        amplitude (time, frequency) and speed (time), rad/s, at the middle of each piece.

    Raises
    ------
    ValueError
        For an unknown channel or window, a piece of fewer than four samples or longer than the record, and
        an overlap outside its range.
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
