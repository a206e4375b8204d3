"""Spectra over orders of the shaft speed: an order keeps its place while the speed changes."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from bearingdyn.analysis.spectrum import amplitudes, check_window
from bearingdyn.analysis.speed_profile import shaft_angle, speed_profile
from bearingdyn.checks import numbers, positive, require, whole
from bearingdyn.results import signal_of, unit_of
from bearingdyn.types import Array

if TYPE_CHECKING:
    import xarray


# samples a turn, in units of the highest order
PER_ORDER = 8


def order_spectrum(
    result: xarray.Dataset, channel: str, highest: float, window: str = "hann"
) -> xarray.Dataset:
    """One-sided amplitude spectrum (zero-to-peak) over orders of the shaft speed, steady or not.

    Quintic splines resample the record at equal steps of the shaft's angle, over as many whole turns as it
    holds. The resolution is one over the number of turns.

    Parameters
    ----------
    result
        As `transient` returns it.
    channel
        Name of a recorded channel.
    highest
        The highest order wanted. Eight samples in its period keep its amplitude to 1e-3, sixteen to 1e-5.
    window
        "hann" or "none".

    Returns
    -------
    xarray.Dataset
        amplitude (order), in the unit of the channel.

    Raises
    ------
    ValueError
        For an unknown channel or window, a shaft that stands still or reverses, less than one turn, and a
        record too coarse for the highest order.
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

    All orders and a mean are fitted together by Hann-weighted least squares to pieces of `turns` turns, each
    of which overlaps the next by half. A cosine of steady amplitude in one of the orders is thus recovered
    exactly, even beside neighbours one order away.

    Parameters
    ----------
    result
        As `transient` returns it.
    channel
        Name of a recorded channel.
    orders
        Multiples of the shaft speed, positive.
    turns
        Length of a piece, at least 2.

    Returns
    -------
    xarray.Dataset
        amplitude (time, order), complex, zero-to-peak: the signal is Re(amplitude·e^{i·order·angle}), with
        the shaft's angle; and speed (time), rad/s. Both in the middle of each piece.

    Raises
    ------
    ValueError
        For an unknown channel, no order or one that is not positive, fewer than two turns, and as
        `order_spectrum`.
    """
    remedy = "give one or more positive orders of the shaft speed"
    wanted = numbers("orders", orders, remedy)
    require(bool((wanted > 0).all()), "orders", orders, remedy)
    turns = whole("turns", turns, 2)
    highest = float(wanted.max())
    angle, values = _over_angle(result, channel, highest)
    per_turn = int(np.ceil(PER_ORDER * highest))
    length = turns * per_turn
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
        {"analysis": "order tracking", "channel": channel, "turns": turns},
        {"time": (middle, "s"), "order": (wanted, "1")},
    )


def _over_angle(result: xarray.Dataset, channel: str, highest: float) -> tuple[Array, Array]:
    """Angle and samples of a channel, checked to be fine enough for the highest order."""
    highest = positive("highest", highest, "give the highest order wanted, above zero")
    values = signal_of(result, channel)
    angle = np.sign(np.sum(np.diff(shaft_angle(result)))) * shaft_angle(result)
    steps = np.diff(angle)
    if steps.size == 0 or not (steps > 0).all():
        raise ValueError("the shaft stands still or reverses; orders need a shaft that turns one way")
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
