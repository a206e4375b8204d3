"""The spectrum of the envelope of a signal within a band, in which defects of bearings show."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from bearingdyn.analysis.spectrum import amplitudes, check_window
from bearingdyn.checks import vector
from bearingdyn.results import sampling_time, signal_of, unit_of

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
    low, high = vector("band", band, (2,), "lowest and highest frequency, Hz").tolist()
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
