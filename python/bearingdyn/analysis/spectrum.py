"""The amplitude spectrum of a recorded channel."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from bearingdyn.results import recorded_channel, sampling_time, signal_of, unit_of
from bearingdyn.types import Array

if TYPE_CHECKING:
    import xarray


WINDOWS = ("hann", "none")


def spectrum(result: xarray.Dataset, channel: str | None = None, window: str = "hann") -> xarray.Dataset:
    """Spectrum of a recorded channel: one-sided amplitudes (zero-to-peak), its mean removed.

    A sine of amplitude A whose frequency is on a line of the spectrum shows as A, whatever the window. The
    resolution is 1/T of a record of length T.

    Parameters
    ----------
    result
        As `transient` returns it.
    channel
        Name of a recorded channel; None: the only one.
    window
        "hann" or "none".

    Returns
    -------
    xarray.Dataset
        amplitude (frequency), in the unit of the channel.

    Raises
    ------
    ValueError
        For an unknown channel or window, and for fewer than four samples.
    """
    check_window(window)
    channel = recorded_channel(result, channel)
    signal = signal_of(result, channel)
    n = signal.size
    if n < 4:
        raise ValueError(f"channel {channel!r} holds {n} samples; a spectrum needs four or more")
    amplitude = amplitudes(signal, window)
    dt = sampling_time(result)

    from bearingdyn.results import dataset

    unit = unit_of(result, channel)
    return dataset(
        {"amplitude": ("frequency", amplitude, unit, f"{channel}, zero-to-peak")},
        {"analysis": "spectrum", "channel": channel, "window": window},
        {"frequency": (np.fft.rfftfreq(n, dt), "Hz")},
    )


def check_window(window: str) -> None:
    """Refuse an unknown window of a spectrum: ValueError."""
    if window not in WINDOWS:
        raise ValueError(f"window is {window!r}; it must be one of {list(WINDOWS)}")


def amplitudes(signal: Array, window: str) -> Array:
    """One-sided amplitude spectra (..., n//2 + 1), zero-to-peak, of signals (..., n) about their means."""
    n = signal.shape[-1]
    weight = 0.5 - 0.5 * np.cos(2 * np.pi * np.arange(n) / n) if window == "hann" else np.ones(n)
    centred = signal - signal.mean(axis=-1, keepdims=True)
    amplitude = 2.0 * np.abs(np.fft.rfft(centred * weight)) / weight.sum()
    if n % 2 == 0:
        amplitude[..., -1] /= 2.0
    return np.asarray(amplitude)
