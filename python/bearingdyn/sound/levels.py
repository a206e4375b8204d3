"""Levels in decibels of sound power, pressure and vibration, in bands and in all; and measures of peaks."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from bearingdyn.checks import one_of, reals, require
from bearingdyn.plausible_ranges import plausible
from bearingdyn.sound.bands import Fraction, band_powers
from bearingdyn.sound.signal_check import sample_rate, signal
from bearingdyn.sound.weighting import Weighting, weighting
from bearingdyn.types import Array

if TYPE_CHECKING:
    import xarray

# reference values: ISO 1683
REFERENCES = {"power": 1e-12, "pressure": 20e-6, "velocity": 1e-9, "acceleration": 1e-6}
UNITS = {"power": "1 pW", "pressure": "20 µPa", "velocity": "1 nm/s", "acceleration": "1 µm/s²"}
SEVERITY = (10.0, 1000.0)  # Hz, over which ISO 20816-1 takes the rms of velocity


def level(value: ArrayLike, quantity: str) -> Array:
    """Level of a power, W, or of the rms of a pressure, velocity or acceleration, dB.

    Parameters
    ----------
    value
        W, Pa, m/s or m/s², of any shape, zero or more.
    quantity
        "power" re 1 pW, "pressure" re 20 µPa, "velocity" re 1 nm/s or "acceleration" re 1 µm/s².

    Returns
    -------
    numpy.ndarray
        dB, of the same shape; −inf of nothing.

    Raises
    ------
    ValueError
        For another quantity, or a value that is negative or NaN.

    References
    ----------
    ISO 1683:2015.
    """
    one_of("quantity", quantity, tuple(REFERENCES))
    x = reals("value", value, f"it must be a {quantity}, real numbers")
    require(
        bool((x >= 0).all()), "value", value, f"it must be a {quantity} of zero or more, an rms or a power"
    )
    with np.errstate(divide="ignore"):
        return np.asarray((10.0 if quantity == "power" else 20.0) * np.log10(x / REFERENCES[quantity]))


def total(levels: ArrayLike) -> float:
    """Level of several together, dB: their powers added.

    Parameters
    ----------
    levels
        dB; −inf of nothing.
    """
    x = reals("levels", levels, "it must be dB, real numbers")
    require(not bool(np.isnan(x).any()), "levels", levels, "it must be dB, none NaN")
    with np.errstate(divide="ignore"):
        return float(10.0 * np.log10(np.sum(10.0 ** (x / 10.0))))


def band_levels(
    frequency: ArrayLike,
    power: ArrayLike,
    quantity: str = "power",
    *,
    fraction: Fraction = 3,
    weighted: Weighting = "A",
) -> xarray.Dataset:
    """Levels of a spectrum of lines in bands, weighted, and in all.

    Parameters
    ----------
    frequency
        Of the lines (f,), Hz.
    power
        Of each line (f,): W, or the mean square of pressure, Pa², velocity, (m/s)², or acceleration, (m/s²)².
    quantity
        As in `level`.
    fraction
        3: third octaves; 1: octaves.
    weighted
        "A", "C" or "Z", applied line by line.

    Returns
    -------
    xarray.Dataset
        Over band, nominal Hz: level and weighted_level, dB; and total and weighted_total, dB, of all lines.

    Raises
    ------
    ValueError
        As `band_powers`, `level` and `weighting` do.
    """
    one_of("quantity", quantity, tuple(REFERENCES))
    f = reals("frequency", frequency, "it must be Hz, real numbers")
    p = reals("power", power, "it must be a mean square or W of each line, real numbers")
    gain = 10.0 ** (weighting(f, weighted) / 10.0)
    nominal, plain = band_powers(f, p, fraction)
    _, heard = band_powers(f, p * gain, fraction)
    root = (lambda x: x) if quantity == "power" else np.sqrt
    above = f > 0

    from bearingdyn.results import dataset

    unit = f"dB re {UNITS[quantity]}"
    return dataset(
        {
            "level": ("band", level(root(plain), quantity), unit, f"{quantity} level"),
            "weighted_level": ("band", level(root(heard), quantity), unit, f"{weighted}-weighted level"),
            "total": ((), level(root(p[above].sum()), quantity), unit, "of all lines"),
            "weighted_total": (
                (),
                level(root((p * gain)[above].sum()), quantity),
                unit,
                f"{weighted}-weighted",
            ),
        },
        {"analysis": "band levels", "quantity": quantity, "fraction": fraction, "weighting": weighted},
        {"band": (nominal, "Hz")},
    )


def mean_squares(samples: ArrayLike, rate: float) -> tuple[Array, Array]:
    """Mean squares for levels: of each line of a signal's spectrum, adding up to the signal's.

    Parameters
    ----------
    samples
        (n,), evenly in time.
    rate
        Samples a second.

    Returns
    -------
    tuple of numpy.ndarray
        Frequencies (n//2 + 1,), Hz, and mean squares.

    Raises
    ------
    ValueError
        For a signal of one sample or a rate that is not positive.
    """
    x, rate = signal("samples", samples), sample_rate(rate)
    c = np.fft.rfft(x) / x.size
    power = 2.0 * np.abs(c) ** 2
    power[0] *= 0.5
    if x.size % 2 == 0:
        power[-1] *= 0.5
    return np.asarray(np.fft.rfftfreq(x.size, 1.0 / rate), dtype=np.float64), power


def vibration_severity(velocity: ArrayLike, rate: float) -> float:
    """Level of vibration's severity by ISO 20816 (formerly 10816): rms velocity from 10 to 1000 Hz, m/s.

    Parameters
    ----------
    velocity
        (n,), m/s, evenly in time.
    rate
        Samples a second.

    Returns
    -------
    float
        m/s.

    Raises
    ------
    ValueError
        For a rate below 2000 samples a second, or a signal shorter than a period of 10 Hz.

    References
    ----------
    ISO 20816-1:2016.
    """
    rate = sample_rate(rate)
    low, high = SEVERITY
    require(rate >= 2 * high, "rate", rate, f"it must be {2 * high:g} samples a second or more")
    x = signal("velocity", velocity)
    plausible("velocity of a housing", "velocity, rms,", float(np.std(x)))
    seconds = x.size / rate
    require(seconds * low >= 1.0, "velocity", f"{seconds:.3g} s", f"it must last {1 / low:g} s or more")
    f, power = mean_squares(x, rate)
    return float(np.sqrt(power[(f >= low * (1 - 1e-9)) & (f <= high * (1 + 1e-9))].sum()))


def crest_factor(samples: ArrayLike) -> float:
    """Crest factor beside the levels of a signal: peak over rms, its mean taken off.

    Parameters
    ----------
    samples
        (n,).
    """
    x = signal("samples", samples)
    x = x - x.mean()
    rms = float(np.sqrt(np.mean(x**2)))
    require(rms > 0, "samples", "constant", "it must vary")
    return float(np.abs(x).max()) / rms


def kurtosis(samples: ArrayLike) -> float:
    """Kurtosis beside the levels of a signal: 3 of Gaussian noise, 1.5 of a tone.

    Parameters
    ----------
    samples
        (n,).
    """
    x = signal("samples", samples)
    x = x - x.mean()
    square = float(np.mean(x**2))
    require(square > 0, "samples", "constant", "it must vary")
    return float(np.mean(x**4)) / square**2
