"""What is heard: the pressure of a march at microphones, weighted signals, and loudness."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from bearingdyn.checks import one_of, positive, require
from bearingdyn.sound.signal_check import signal
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
    x, rate = signal("samples", samples), positive("rate", rate)
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
    rate = positive("rate", rate)
    x = np.asarray(force, dtype=np.float64)
    x = x[:, None] if x.ndim == 1 else x
    f = np.asarray(frequency, dtype=np.float64)
    H = np.asarray(transfer, dtype=np.complex128)
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
    one_of("field", field, ("free", "diffuse"))
    x, rate = signal("pressure", pressure), positive("rate", rate)
    require(
        rate >= 0.5 * AUDIBLE,
        "rate",
        rate,
        f"its step cannot carry the audible band; it must be {AUDIBLE:g}, and half that at least",
    )
    require(x.size >= 0.5 * rate, "pressure", f"{x.size / rate:.3g} s", "it must last half a second or more")
    try:
        from mosqito.sq_metrics.loudness.loudness_zwst._calc_slopes import _calc_slopes
        from mosqito.sq_metrics.loudness.loudness_zwst._main_loudness import _main_loudness
        from mosqito.sq_metrics.loudness.loudness_zwtv._third_octave_levels import _third_octave_levels
    except ImportError as error:
        raise ImportError(f'loudness needs mosqito 1.2: pip install "bearingdyn[sound]" ({error})') from error
    import scipy.signal

    if rate != 48000.0:
        x = scipy.signal.resample(x, round(x.size * 48000.0 / rate))
    levels, time, _ = _third_octave_levels(x, 48000)
    mean = 10.0 * np.log10(np.mean(10.0 ** (levels[:, time > SETTLED] / 10.0), axis=1))
    return float(_calc_slopes(_main_loudness(mean, field))[0])
