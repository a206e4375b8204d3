"""Fewer samples than steps without aliases: a low-pass of linear phase over the steps as they come."""

from __future__ import annotations

import math
from functools import cache

import numpy as np

from bearingdyn.types import Array

# of the low-pass, in units of the new Nyquist frequency 1/(2 decimate dt): level to PASS, gone from STOP on
PASS, STOP, ATTENUATION = 0.8, 1.0, 84.0  # dB
TRANSITION = (STOP - PASS) / 2  # cycles per kept sample


def half_length(every: int) -> int:
    """Steps that the decimation filter looks back, and ahead; Kaiser's (A − 7.95)/(14.36 Δf) taps in all."""
    return math.ceil((ATTENUATION - 7.95) / (14.36 * TRANSITION) * every / 2)


@cache
def taps(every: int) -> Array:
    """Weights (half_length + 1,) of the decimation filter from its middle: a sinc under Kaiser's window."""
    half = half_length(every)
    k = np.arange(half + 1)
    cutoff = (PASS + STOP) / 2 / every  # of the old Nyquist frequency
    window = np.i0(0.1102 * (ATTENUATION - 8.7) * np.sqrt(1 - (k / half) ** 2))
    weight = np.sinc(cutoff * k) * window
    weight /= weight[0] + 2 * weight[1:].sum()
    weight.flags.writeable = False
    return np.asarray(weight)


class Decimator:
    """Decimates a march: keeps every n-th step, low-passed; the same bits however the rows are cut.

    Parameters
    ----------
    every
        How many steps to a sample; samples lie where the count of steps is a multiple of it.
    plain
        (channels,) which are sampled as they are.
    count
        Steps behind the first row to come.
    past
        (half_length, channels) rows before it; None: the first row is held.
    """

    def __init__(self, every: int, plain: Array, count: int, past: Array | None) -> None:
        self.every, self.plain = every, plain
        self.half = half_length(every)
        self.rows = past
        self.count = self.given = count

    def skip(self, steps: int) -> None:
        """Steps whose rows are not known and not needed."""
        self.count += steps
        self.given = self.count

    def add(self, rows: Array) -> None:
        """Rows (steps, channels) of the next steps."""
        if len(rows):
            before = np.repeat(rows[:1], self.half, axis=0) if self.rows is None else self.rows
            self.rows = np.concatenate([before, rows])
            self.count += len(rows)

    def drop(self) -> None:
        """Give no samples of what was added so far."""
        self.given = self.count
        if self.rows is not None:
            self.rows = self.rows[-self.half :]

    def take(self, ahead: Array) -> Array:
        """Samples (n, channels) of all rows added since the last time.

        Parameters
        ----------
        ahead
            Rows that follow, up to half_length of them; where there are fewer the last one is held.
        """
        first = (self.given // self.every + 1) * self.every
        n = max((self.count - first) // self.every + 1, 0)
        if self.rows is None or n == 0:
            found = np.zeros((0, len(self.plain)))
        else:
            data = np.concatenate([self.rows, ahead])
            short = self.half - len(ahead)
            data = np.concatenate([data, np.repeat(data[-1:], short, axis=0)])
            found = self._filtered(data, first - (self.count - len(self.rows) + 1), n)
        self.drop()
        return found

    def _filtered(self, data: Array, at: int, n: int) -> Array:
        """n samples, the first of row `at`; tap by tap, so that no sum depends on how many there are."""
        every, weight = self.every, taps(self.every)
        padded = np.concatenate([data, np.zeros((-len(data) % every, data.shape[1]))])
        # (place in a sample, channel, sample): what a tap meets lies side by side
        phases = padded.reshape(-1, every, data.shape[1]).transpose(1, 2, 0).copy()

        def rows(start: int) -> Array:
            return np.asarray(phases[start % every, :, start // every : start // every + n])

        found = weight[0] * rows(at)
        for k in range(1, self.half + 1):
            found += weight[k] * (rows(at - k) + rows(at + k))
        found[self.plain] = rows(at)[self.plain]
        return np.ascontiguousarray(found.T)
