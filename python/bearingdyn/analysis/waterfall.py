"""Spectra of one piece of a record after another, as speed or time goes on."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from bearingdyn.analysis.spectrum import amplitudes, check_window
from bearingdyn.analysis.speed_profile import speed_profile
from bearingdyn.checks import number, positive
from bearingdyn.results import sampling_time, signal_of, unit_of

if TYPE_CHECKING:
    import xarray


def waterfall(
    result: xarray.Dataset, channel: str, length: float, overlap: float = 0.5, window: str = "hann"
) -> xarray.Dataset:
    """A waterfall: amplitude spectra (zero-to-peak) of one piece of a record after another.

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
    length, overlap = positive("length", length, "it must be a time, s"), number("overlap", overlap)
    n = round(length / dt)
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
