"""Spectra over the turn of the shaft: orders, which stay where they are while the speed changes."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from bearingdyn.analysis.spectra import amplitudes, check_window, signal_of, speed_profile, unit_of
from bearingdyn.types import Array

if TYPE_CHECKING:
    import xarray


# samples a turn, in units of the highest order
PER_ORDER = 8


def shaft_angle(result: xarray.Dataset) -> Array:
    """Angle of the shaft at every sample of a march, (n,), rad: the exact integral of its speed profile."""
    t = np.asarray(result["time"].values, dtype=np.float64)
    times, speeds = speed_profile(result)
    if speeds.size == 1:
        return np.asarray(speeds[0] * t)
    # as the core reckons: the first speed holds before the profile, the last after it
    at = np.concatenate([[0.0], np.cumsum(0.5 * (speeds[1:] + speeds[:-1]) * np.diff(times))])
    k = np.clip(np.searchsorted(times, t, side="right") - 1, 0, times.size - 2)
    inside = np.clip(t, times[0], times[-1]) - times[k]
    slope = (speeds[k + 1] - speeds[k]) / (times[k + 1] - times[k])
    angle = at[k] + speeds[k] * inside + 0.5 * slope * inside**2
    angle += speeds[0] * np.minimum(t - times[0], 0.0) + speeds[-1] * np.maximum(t - times[-1], 0.0)
    return np.asarray(angle + speeds[0] * times[0])


def order_spectrum(
    result: xarray.Dataset, channel: str, highest: float, window: str = "hann"
) -> xarray.Dataset:
    """One-sided amplitude spectrum (zero-to-peak) over orders of the shaft speed, through a run-up or not.

    The record is taken at equal steps of the shaft's angle by quintic splines, over as many whole turns as it
    holds; the resolution is one over their number. highest: the highest order wanted; eight samples in its
    period keep its amplitude to 1e-3, sixteen to 1e-5.

    Raises ValueError for an unknown channel or window, a shaft that stands or turns back, less than one turn,
    or a record too coarse for the highest order.
    """
    check_window(window)
    angle, values = _over_angle(result, channel, highest)
    turns = int((angle[-1] - angle[0]) / (2 * np.pi))
    if turns < 1:
        raise ValueError(f"channel {channel!r} holds less than one turn of the shaft; march longer")
    per_turn = int(np.ceil(PER_ORDER * highest))
    at = angle[0] + 2 * np.pi * np.arange(turns * per_turn) / per_turn
    amplitude = amplitudes(_resampled(angle, values, at), window)
    order = np.arange(amplitude.size) / turns
    keep = order <= highest

    from bearingdyn.results import dataset

    return dataset(
        {"amplitude": ("order", amplitude[keep], unit_of(result, channel), f"{channel}, zero-to-peak")},
        {"analysis": "order spectrum", "channel": channel, "window": window, "turns": turns},
        {"order": (order[keep], "1")},
    )


def track_orders(
    result: xarray.Dataset, channel: str, orders: Sequence[float], turns: int = 8
) -> xarray.Dataset:
    """Amplitude and phase of orders of the shaft speed along a run-up.

    Over every `turns` turns, half of them shared with the next, a Hann-weighted least-squares fit of all the
    orders and a mean: a cosine of one of them, of steady amplitude, is found as it is, even with neighbours
    an order apart.

    Returns a Dataset with amplitude (time, order), complex, zero-to-peak: Re(amplitude·e^{i·order·angle}) of
    the shaft's angle, and speed (time), rad/s, in the middle of each piece.

    Raises ValueError for an unknown channel, no order or one that is not positive, fewer than two turns, or
    as `order_spectrum`.
    """
    wanted = np.atleast_1d(np.asarray(orders, dtype=np.float64))
    if wanted.ndim != 1 or wanted.size == 0 or not (np.isfinite(wanted).all() and (wanted > 0).all()):
        raise ValueError(f"orders is {orders!r}; give one or more positive orders of the shaft speed")
    if not (turns >= 2 and turns % 1 == 0):
        raise ValueError(f"turns is {turns}; it must be a whole number of at least 2")
    highest = float(wanted.max())
    angle, values = _over_angle(result, channel, highest)
    per_turn = int(np.ceil(PER_ORDER * highest))
    length = int(turns) * per_turn
    count = int((angle[-1] - angle[0]) / (2 * np.pi) * per_turn)
    if count < length:
        raise ValueError(f"channel {channel!r} holds less than {turns} turns of the shaft; march longer")
    at = angle[0] + 2 * np.pi * np.arange(count) / per_turn
    even = _resampled(angle, values, at)
    starts = np.arange(0, count - length + 1, max(length // 2, 1))
    weight = np.sqrt(0.5 - 0.5 * np.cos(2 * np.pi * np.arange(length) / length))
    found = np.zeros((starts.size, wanted.size), dtype=np.complex128)
    for i, first in enumerate(starts):
        piece = slice(first, first + length)
        turned = np.outer(at[piece], wanted)
        basis = np.hstack([np.ones((length, 1)), np.cos(turned), -np.sin(turned)]) * weight[:, None]
        fit = np.linalg.lstsq(basis, even[piece] * weight, rcond=None)[0]
        found[i] = fit[1 : 1 + wanted.size] + 1j * fit[1 + wanted.size :]
    if shaft_angle(result)[-1] < shaft_angle(result)[0]:
        found = found.conj()  # the fit is over an angle that rises
    t = np.asarray(result["time"].values, dtype=np.float64)
    middle = np.interp(at[starts + length // 2], angle, t)

    from bearingdyn.results import dataset

    return dataset(
        {
            "amplitude": (
                ("time", "order"),
                found,
                unit_of(result, channel),
                f"{channel}, complex, zero-to-peak",
            ),
            "speed": ("time", np.interp(middle, *speed_profile(result)), "rad/s", "speed of the shaft"),
        },
        {"analysis": "order tracking", "channel": channel, "turns": int(turns)},
        {"time": (middle, "s"), "order": (wanted, "1")},
    )


def _over_angle(result: xarray.Dataset, channel: str, highest: float) -> tuple[Array, Array]:
    """Angle and samples of a channel, checked to be fine enough for the highest order."""
    if not (highest > 0 and np.isfinite(highest)):
        raise ValueError(f"highest is {highest}; give the highest order wanted, above zero")
    values = signal_of(result, channel)
    angle = np.sign(np.sum(np.diff(shaft_angle(result)))) * shaft_angle(result)
    steps = np.diff(angle)
    if steps.size == 0 or not (steps > 0).all():
        raise ValueError("the shaft stands or turns back; orders need a shaft that turns one way")
    finest = np.pi / float(steps.max())
    if highest > finest:
        raise ValueError(
            f"highest is {highest:g}; at the fastest the record has two samples for order {finest:.4g}: "
            "record more often"
        )
    return angle, values


def _resampled(angle: Array, values: Array, at: Array) -> Array:
    from scipy.interpolate import make_interp_spline

    return np.asarray(make_interp_spline(angle, values, k=5)(at))
