"""Harmonics cut off from a steady motion: what those next above the last would add, and the warning of it."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from bearingdyn.analysis.recordable_channels import CoreChannel
from bearingdyn.analysis.steady.balance import Balance, Pressed
from bearingdyn.analysis.steady.motion import FINER, MOTIONS
from bearingdyn.analysis.steady.torus import Lines
from bearingdyn.notice import CutHarmonics, warn
from bearingdyn.types import Array, Complex

# lines beyond the last that the estimate looks at
BEYOND = 12
# of a channel's largest line, what harmonics left out may add; and of its mean, below which it is no motion
CUT, LEAST = 0.02, 1e-6


def cut_off(
    balance: Balance, z: Complex, channels: Sequence[CoreChannel], fine: Pressed | None = None
) -> Array:
    """Amplitude of the motions on the lines next above the last (channels,): what the balance cut off.

    Parameters
    ----------
    balance, z
        The balance, and the amplitudes (L, m) of the bearings' coefficients, m.
    channels
        What is recorded. NaN comes of channels that are no motions, and of a balance of several bases.
    fine
        What the balls do, sampled `FINER` times as finely; None: found here.
    """
    out = np.full(len(channels), np.nan)
    moves = [c for c, channel in enumerate(channels) if channel[0] in MOTIONS]
    lines = balance.lines
    if lines.index.shape[1] != 1 or not moves:
        return out
    last = lines.count - 1
    count = min(BEYOND, lines.samples // 2 - 1 - last)
    more = Lines(np.arange(last + count + 1)[:, None], lines.steps, lines.samples * FINER)
    pressed = fine or balance.press(z, tangents=False, lines=lines.finer(FINER))
    g = np.zeros((more.samples, len(z[0])))
    for own, along in zip(balance.slots, pressed.bearings, strict=True):
        g[:, own] = along.g
    force = more.amplitudes(g)[last + 1 :]
    base = float(balance.bases.frequencies(balance.speed)[0])
    omega = np.arange(last + 1.0, last + count + 1.0) * base
    rows = np.array([channels[c][1] for c in moves])
    rate = np.array([MOTIONS.index(channels[c][0]) for c in moves])
    receptances = balance.receptances
    answer = receptances.answer(omega, balance.speed, rows, receptances.B)
    moved = np.abs((answer @ force[:, :, None])[:, :, 0]) * np.abs(omega[:, None]) ** rate
    out[moves] = np.sqrt((moved**2).sum(axis=0))
    return np.asarray(out)


def share_cut(amplitude: Array, cut: Array) -> Array:
    """Of each channel's largest line, the share that harmonics cut off would add; 0 of what does not move.

    Parameters
    ----------
    amplitude
        (…, L, channels), the mean first.
    cut
        (…, channels), NaN where it is not known.
    """
    size = np.abs(amplitude)
    largest, whole_size = size[..., 1:, :].max(axis=-2, initial=0.0), size.max(axis=-2, initial=0.0)
    with np.errstate(invalid="ignore"):
        moves = cut > LEAST * whole_size
    return np.where(moves, cut / np.maximum(largest, 1e-300), 0.0)


def warn_of_cut(what: str, harmonics: int, name: str, share: float, cut: float, unit: str) -> None:
    """Warn (CutHarmonics) of a channel whose `share` that was cut, amplitude `cut`, is more than `CUT`."""
    if share > CUT:
        warn(
            f"{what} wants more than {harmonics} harmonics: those next above would add {cut:.2g} to "
            f"{name!r}, whose largest line is {cut / share:.2g} {unit}; give more harmonics",
            CutHarmonics,
        )
