"""What is read off a record of a rig with a spall: envelope, lines, levels, and how well they repeat."""

from __future__ import annotations

import itertools
import math
from collections.abc import Mapping, Sequence

import numpy as np
import scipy
from cwru_rig import RATE

BAND = (2000.0, 5500.0)  # Hz, of the envelope: the housing's modes
LEVELS = tuple(range(2400, 4300, 100))  # Hz, edges of the bands whose levels are fitted


def envelope(signal: np.ndarray, band: tuple[float, float] = BAND) -> tuple[np.ndarray, np.ndarray]:
    """Frequencies, Hz, and amplitudes of the spectrum of the envelope in a band, zero-to-peak."""
    sos = scipy.signal.butter(6, band, "bandpass", fs=RATE, output="sos")
    size = np.abs(scipy.signal.hilbert(scipy.signal.sosfiltfilt(sos, signal - signal.mean())))
    n = len(size)
    spectrum = np.abs(np.fft.rfft((size - size.mean()) * np.hanning(n), 8 * n)) * 4 / n
    return np.fft.rfftfreq(8 * n, 1 / RATE), spectrum


def peak(
    spectrum: tuple[np.ndarray, np.ndarray], frequency: float, width: float = 1.5
) -> tuple[float, float]:
    """Frequency, Hz, and amplitude of the largest line within `width` Hz."""
    f, size = spectrum
    near = np.abs(f - frequency) < width
    at = int(size[near].argmax())
    return float(f[near][at]), float(size[near][at])


def lines_of(signal: np.ndarray, body: str, near: Mapping[str, float]) -> dict[str, tuple[float, float]]:
    """Name -> (frequency, amplitude) of the ball pass, its harmonics, and its sidebands at the shaft."""
    found, spectrum = {}, envelope(signal)
    base = peak(spectrum, near[body], 2.0)[0]
    for k in (1, 2, 3):
        for j in (0, -2, -1, 1, 2) if body == "inner" else (0,):
            found[f"{k}" + (f"{j:+d}" if j else "")] = peak(spectrum, k * base + j * near["shaft"])
    return found


def repeats(
    record: np.ndarray, body: str, near: Mapping[str, float], seconds: float = 1.0
) -> dict[str, tuple[float, float]]:
    """Line -> how far its level scatters from one piece of the record to the next, rms in dB, and how much
    lower it is in the whole record than in the pieces: what slip of the cage would spread."""
    count = int(len(record) / RATE / seconds)
    pieces = [lines_of(piece, body, near) for piece in np.array_split(record, count)]
    whole, found = lines_of(record, body, near), {}
    for name, (_, size) in whole.items():
        level = 20 * np.log10([piece[name][1] for piece in pieces])
        found[name] = float(level.std()), float(level.mean() - 20 * math.log10(size))
    return found


def statistics(signal: np.ndarray) -> tuple[float, float]:
    """Rms and kurtosis."""
    x = signal - signal.mean()
    return float(x.std()), float((x**4).mean() / x.var() ** 2)


def levels(signal: np.ndarray, edges: Sequence[float] = LEVELS) -> np.ndarray:
    """Rms in each of the bands between these frequencies, Hz."""
    f, power = scipy.signal.welch(signal, RATE, nperseg=512)
    return np.sqrt([power[(f >= a) & (f < b)].sum() * f[1] for a, b in itertools.pairwise(edges)])
