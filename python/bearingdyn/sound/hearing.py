"""What is heard: the pressure of a march at microphones, weighted signals, and loudness."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from bearingdyn.checks import one_of, reals, require
from bearingdyn.sound.signal_check import sample_rate, signal
from bearingdyn.sound.weighting import Weighting, weighting
from bearingdyn.types import Array, Complex

AUDIBLE = 44100.0  # samples a second that carry 20 kHz
SETTLED = 0.2  # s, in which the filters of the bands start


def weighted_signal(samples: ArrayLike, rate: float, kind: Weighting = "A") -> Array:
    """Hearing a signal: weighted by A, C or Z, its whole taken as one period.

    Parameters
    ----------
    samples
        (n,), evenly in time.
    rate
        Samples a second.
    kind
        "A", "C" or "Z".

    Returns
    -------
    numpy.ndarray
        (n,), of the same unit, without phase shifts.
    """
    x, rate = signal("samples", samples), sample_rate(rate)
    gain = 10.0 ** (weighting(np.fft.rfftfreq(x.size, 1.0 / rate), kind) / 20.0)
    return np.fft.irfft(np.fft.rfft(x) * gain, x.size)


def pressure_signal(force: ArrayLike, rate: float, frequency: ArrayLike, transfer: ArrayLike) -> Array:
    """Signal to be heard: sound pressure of a force signal, by pressure per unit of force over frequency.

    The signal is taken as one period of a steady state; its mean and what lies outside the
    transfer's frequencies are silent.

    Parameters
    ----------
    force
        (n,), N, evenly in time, or of several inputs (n, i).
    rate
        Samples a second.
    frequency
        (f,), Hz, ascending.
    transfer
        (f,) or (f, i) complex, Pa/N, as `sound_power` gives it at one microphone.

    Returns
    -------
    numpy.ndarray
        (n,), Pa.

    Raises
    ------
    ValueError
        For shapes that do not fit, and frequencies that the signal's step cannot carry.
    """
    rate = sample_rate(rate)
    x = np.atleast_1d(reals("force", force, "it must be real numbers, N, evenly in time"))
    x = x[:, None] if x.ndim == 1 else x
    f = reals("frequency", frequency, "it must hold two or more, ascending, in Hz")
    try:
        H = np.asarray(transfer, dtype=np.complex128)
    except (TypeError, ValueError, OverflowError):
        raise ValueError(f"transfer is {transfer!r}; it must be complex numbers, Pa/N") from None
    H = H[:, None] if H.ndim == 1 else H
    if f.ndim != 1 or f.size < 2 or not bool((np.diff(f) > 0).all()):
        raise ValueError("frequency must hold two or more, ascending, in Hz")
    if x.ndim != 2 or H.shape != (f.size, x.shape[1]):
        raise ValueError(
            f"transfer has shape {H.shape}; it must be ({f.size}, {x.shape[-1]}): frequencies by inputs"
        )
    for one in x.T:
        signal("force", one)
    require(
        rate >= 2.0 * f[-1],
        "rate",
        rate,
        f"its step cannot carry {f[-1]:.5g} Hz; it must be {2 * f[-1]:.5g} samples a second or more",
    )
    lines = np.fft.rfftfreq(len(x), 1.0 / rate)
    inside = (lines >= f[0]) & (lines <= f[-1]) & (lines > 0)
    spectrum = np.fft.rfft(x, axis=0)
    heard = np.zeros(lines.size, dtype=np.complex128)
    for i in range(x.shape[1]):
        heard[inside] += _between(f, H[:, i], lines[inside]) * spectrum[inside, i]
    return np.fft.irfft(heard, len(x))


def _between(f: Array, H: Complex, at: Array) -> Complex:
    """Linear in magnitude and in the phase's own run."""
    phase = np.unwrap(np.angle(H))
    return np.asarray(np.interp(at, f, np.abs(H)) * np.exp(1j * np.interp(at, f, phase)))


def loudness(pressure: ArrayLike, rate: float, field: str = "free") -> float:
    """Loudness of a steady sound as one hears it, sone, by the package mosqito (extra "sound").

    The bands are those of the standard's own filters, over the time in which they have settled; mosqito's
    `loudness_zwst` takes other filters, and their start with them: 4.14 sone of half a second of the tone of
    60 dB, instead of 4.02.

    Parameters
    ----------
    pressure
        (n,), Pa, half a second or more, of which the first fifth of a second only sets the filters going.
    rate
        Samples a second; other than 48 kHz it is resampled.
    field
        "free" or "diffuse".

    Returns
    -------
    float
        Sone: 1.00 of a tone of 1 kHz and 40 dB, 4.02 of 60 dB.

    Raises
    ------
    ImportError
        Where mosqito is not installed, or is of a version without these filters.
    ValueError
        For a signal that is too short, a rate that does not carry the audible band, and another field.

    References
    ----------
    ISO 532-1:2017 (Zwicker), clause 5: stationary sounds.
    """
    return float(_specific_loudness(pressure, rate, field, "loudness")[0])


def sharpness(pressure: ArrayLike, rate: float, field: str = "free") -> float:
    """Sharpness of a steady sound as one hears it, acum, by the package mosqito (extra "sound").

    Parameters
    ----------
    pressure, rate, field
        As in `loudness`, on whose bands it stands.

    Returns
    -------
    float
        Acum: 1 of noise a critical band wide about 1 kHz at 60 dB.

    Raises
    ------
    ImportError
        Where mosqito is not installed, or is of a version without these filters.
    ValueError
        As `loudness`, and for a sound that cannot be heard, which has no sharpness.

    References
    ----------
    DIN 45692:2009.
    """
    heard, specific = _specific_loudness(pressure, rate, field, "sharpness")
    from mosqito.sq_metrics.sharpness.sharpness_din.sharpness_din_from_loudness import (
        sharpness_din_from_loudness,
    )

    require(
        heard > 0.0, "pressure", f"of {heard:g} sone", "it must be heard; a silent sound has no sharpness"
    )
    return float(np.squeeze(sharpness_din_from_loudness(np.array([heard]), specific, "din")))


def roughness(pressure: ArrayLike, rate: float) -> float:
    """Roughness of a steady sound as one hears it, asper, by the package mosqito (extra "sound").

    Parameters
    ----------
    pressure
        (n,), Pa, a fifth of a second or more: the mean over windows of .2 s that overlap by half.
    rate
        Samples a second.

    Returns
    -------
    float
        Asper: 1 of a tone of 1 kHz and 60 dB, fully modulated at 70 Hz.

    Raises
    ------
    ImportError
        Where mosqito is not installed.
    ValueError
        For a signal that is too short, and a rate that does not carry the audible band.

    References
    ----------
    P. Daniel, R. Weber, Acustica 83 (1997) 113.
    """
    x, rate = _audible(pressure, rate, 0.2)
    try:
        from mosqito.sq_metrics.roughness.roughness_dw.roughness_dw import roughness_dw
    except ImportError as error:
        raise _lacking("roughness", error) from error
    return float(np.mean(roughness_dw(_at_48_kilohertz(x, rate), 48000, overlap=0.5)[0]))


def _audible(pressure: ArrayLike, rate: float, least: float) -> tuple[Array, float]:
    """A signal that lasts at least so many seconds, and whose rate carries most of what is heard."""
    x, rate = signal("pressure", pressure), sample_rate(rate)
    require(
        rate >= 0.5 * AUDIBLE,
        "rate",
        rate,
        f"its step cannot carry the audible band; it must be {AUDIBLE:g}, and half that at least",
    )
    require(x.size >= least * rate, "pressure", f"{x.size / rate:.3g} s", f"it must last {least:g} s or more")
    return x, rate


def _at_48_kilohertz(x: Array, rate: float) -> Array:
    import scipy.signal

    return x if rate == 48000.0 else np.asarray(scipy.signal.resample(x, round(x.size * 48000.0 / rate)))


def _lacking(what: str, error: ImportError) -> ImportError:
    return ImportError(f'{what} needs mosqito 1.2: pip install "bearingdyn[sound]" ({error})')


def _specific_loudness(pressure: ArrayLike, rate: float, field: str, what: str) -> tuple[float, Array]:
    """Loudness, sone, and loudness of each tenth of a Bark, sone/Bark."""
    one_of("field", field, ("free", "diffuse"))
    x, rate = _audible(pressure, rate, 0.5)
    try:
        from mosqito.sq_metrics.loudness.loudness_zwst._calc_slopes import _calc_slopes
        from mosqito.sq_metrics.loudness.loudness_zwst._main_loudness import _main_loudness
        from mosqito.sq_metrics.loudness.loudness_zwtv._third_octave_levels import _third_octave_levels
    except ImportError as error:
        raise _lacking(what, error) from error
    levels, time, _ = _third_octave_levels(_at_48_kilohertz(x, rate), 48000)
    mean = 10.0 * np.log10(np.mean(10.0 ** (levels[:, time > SETTLED] / 10.0), axis=1))
    total, specific = _calc_slopes(_main_loudness(mean, field))[:2]
    return float(total), np.asarray(specific)
