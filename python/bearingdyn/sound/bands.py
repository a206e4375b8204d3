"""Octave and third-octave bands: of spectra by their lines, of signals by filters."""

from __future__ import annotations

from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike

from bearingdyn.checks import one_of, positive, reals, require
from bearingdyn.sound.signal_check import sample_rate, signal
from bearingdyn.types import Array

Fraction = Literal[1, 3]

RATIO = 10.0**0.3  # of an octave, IEC 61260-1's base-ten system
# nominal mid-band frequencies of thirds from 100 to 800, of which the others are decades
THIRDS = (100, 125, 160, 200, 250, 315, 400, 500, 630, 800)
ORDER = 6  # poles of a band's filter, of twice this many in all: within class 1, with room
SLOWEST = 20.0  # a filter is run at a rate of no more than this many times its mid-band frequency


def bands(low: float, high: float, fraction: Fraction = 3) -> tuple[Array, Array, Array]:
    """Octave or third-octave bands from `low` to `high`.

    Parameters
    ----------
    low, high
        Hz; the bands in which they lie are the first and the last.
    fraction
        1: octaves; 3: third octaves.

    Returns
    -------
    tuple of numpy.ndarray
        Exact mid-band frequencies (b,), edges (b + 1,) and nominal mid-band frequencies (b,), Hz.

    Raises
    ------
    ValueError
        For frequencies that are not positive or not in order, and another fraction.

    References
    ----------
    IEC 61260-1:2014, clause 5.
    """
    one_of("fraction", fraction, (1, 3))
    low, high = positive("low", low, "it must be a frequency in Hz"), positive("high", high)
    require(high >= low, "high", high, f"it must be at least low, {low}")
    step = RATIO ** (1.0 / fraction)
    # of the band in which a frequency lies: its edges are half a step from the middle
    first, last = (int(np.floor(np.log(f / 1000.0) / np.log(step) + 0.5 + 1e-9)) for f in (low, high))
    x = np.arange(first, last + 1)
    middle = 1000.0 * step**x
    edges = 1000.0 * step ** (np.arange(first, last + 2) - 0.5)
    return middle, edges, np.array([_nominal(k * (3 // fraction)) for k in x.tolist()])


def _nominal(third: int) -> float:
    """Nominal frequency of a third octave, counted from 1 kHz."""
    decade, at = divmod(third + 10, 10)
    return float(THIRDS[at] * 10.0**decade)


def band_powers(frequency: ArrayLike, power: ArrayLike, fraction: Fraction = 3) -> tuple[Array, Array]:
    """Powers in octave or third-octave bands of a spectrum of lines: they add up to what the lines hold.

    Parameters
    ----------
    frequency
        Of the lines (f,), Hz; lines at 0 Hz belong to no band.
    power
        Of each line, (f, ...): mean squares or watts.
    fraction
        1 or 3.

    Returns
    -------
    tuple of numpy.ndarray
        Nominal mid-band frequencies (b,), Hz, and powers (b, ...).

    Raises
    ------
    ValueError
        For lines without a positive frequency, or of another number.
    """
    f = reals("frequency", frequency, "it must be Hz, real numbers")
    p = reals("power", power, "it must be a mean square or W of each line, real numbers")
    if f.ndim != 1 or p.shape[:1] != f.shape or not bool(np.isfinite(f).all()):
        raise ValueError(f"power has shape {p.shape}; its first axis must be that of frequency, {f.shape}")
    there = f > 0
    require(bool(there.any()), "frequency", f.tolist()[:3], "it must hold a line above 0 Hz")
    _, edges, nominal = bands(float(f[there].min()), float(f.max()), fraction)
    at = np.clip(np.searchsorted(edges, f[there], side="right") - 1, 0, nominal.size - 1)
    found = np.zeros((nominal.size, *p.shape[1:]))
    np.add.at(found, at, p[there])
    return nominal, found


def band_filter(middle: float, rate: float, fraction: Fraction = 3) -> Any:
    """Filter of an octave or third-octave band as second-order sections: Butterworth's, 3 dB at its edges.

    Parameters
    ----------
    middle
        Exact mid-band frequency, Hz.
    rate
        Samples a second.
    fraction
        1 or 3.

    Returns
    -------
    numpy.ndarray
        (6, 6), as scipy.signal.sosfilt takes it.

    Raises
    ------
    ValueError
        For a rate that does not carry the band: it must be above twice its upper edge.
    """
    import scipy.signal

    one_of("fraction", fraction, (1, 3))
    middle, rate = positive("middle", middle), sample_rate(rate)
    half = RATIO ** (0.5 / fraction)
    require(
        rate > 2.1 * middle * half,
        "rate",
        rate,
        f"it must be above {2.1 * middle * half:.5g} samples a second for the band at {middle:.5g} Hz",
    )
    return scipy.signal.butter(ORDER, [middle / half, middle * half], "bandpass", fs=rate, output="sos")


def filtered_bands(
    samples: ArrayLike, rate: float, low: float = 25.0, high: float | None = None, fraction: Fraction = 3
) -> tuple[Array, Array]:
    """Mean squares of a signal in octave or third-octave bands by filters.

    Parameters
    ----------
    samples
        (n,), in any unit.
    rate
        Samples a second.
    low, high
        Hz; None: as high as the rate carries.
    fraction
        1 or 3.

    Returns
    -------
    tuple of numpy.ndarray
        Nominal mid-band frequencies (b,), Hz, and mean squares (b,).

    Raises
    ------
    ValueError
        For a signal of one sample, or a rate that does not carry `high`.

    References
    ----------
    IEC 61260-1:2014; the filters meet the limits of class 1.
    """
    import scipy.signal

    x, rate = signal("samples", samples), sample_rate(rate)
    most = rate / 2.6
    middle, _, nominal = bands(low, most if high is None else high, fraction)
    if high is None:
        half = RATIO ** (0.5 / fraction)
        kept = middle * half < most
        middle, nominal = middle[kept], nominal[kept]
    found = []
    for one in middle:
        # a narrow filter at a high rate loses digits: halve the rate while the band is far below it
        y, own = x, rate
        while own > 2.0 * SLOWEST * one and y.size > 64:
            y, own = scipy.signal.resample_poly(y, 1, 2), 0.5 * own
        out = scipy.signal.sosfilt(band_filter(float(one), own, fraction), y)
        found.append(float(np.mean(out**2)))
    return nominal, np.array(found)
