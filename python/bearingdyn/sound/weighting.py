"""Frequency weightings A, C and Z of sound level meters."""

from __future__ import annotations

from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from bearingdyn.checks import one_of, reals
from bearingdyn.types import Array

Weighting = Literal["A", "C", "Z"]

# poles, Hz: IEC 61672-1, annex E, from the corner frequencies 10^1.5 and 10^3.9 Hz and the A's 10^2.45 Hz
F_R, F_L, F_H, F_A = 1000.0, 10**1.5, 10**3.9, 10**2.45


def _poles() -> tuple[float, float, float, float]:
    D = np.sqrt(0.5)
    b = (F_R**2 + F_L**2 * F_H**2 / F_R**2 - D * (F_L**2 + F_H**2)) / (1 - D)
    c = F_L**2 * F_H**2
    f1, f4 = (np.sqrt((-b + s * np.sqrt(b**2 - 4 * c)) / 2) for s in (-1, 1))
    f2, f3 = (F_A * (3 + s * np.sqrt(5)) / 2 for s in (-1, 1))
    return float(f1), float(f2), float(f3), float(f4)


POLES = _poles()  # 20.6, 107.7, 737.9 and 12194 Hz


def weighting(frequency: ArrayLike, kind: Weighting = "A") -> Array:
    """Frequency weighting in dB; 0 dB at 1 kHz.

    Parameters
    ----------
    frequency
        Hz, zero or more, of any shape.
    kind
        "A", "C" or "Z".

    Returns
    -------
    numpy.ndarray
        dB, of the same shape; −inf at 0 Hz but for Z.

    Raises
    ------
    ValueError
        For another kind, or a frequency below zero or not finite.

    References
    ----------
    IEC 61672-1:2013, annex E.
    """
    one_of("kind", kind, ("A", "C", "Z"))
    f = reals("frequency", frequency, "it must be Hz of zero or more, real numbers")
    if not bool((np.isfinite(f) & (f >= 0)).all()):
        raise ValueError(
            "frequency has an entry that is negative or not finite; all must be Hz of zero or more"
        )
    if kind == "Z":
        return np.zeros(f.shape)
    with np.errstate(divide="ignore"):
        return np.asarray(20.0 * np.log10(_gain(f, kind) / _gain(np.array(F_R), kind)))


def _gain(f: Array, kind: str) -> Array:
    f1, f2, f3, f4 = POLES
    gain = f**2 * f4**2 / ((f**2 + f1**2) * (f**2 + f4**2))
    if kind == "A":
        gain = gain * f**2 / np.sqrt((f**2 + f2**2) * (f**2 + f3**2))
    return np.asarray(gain)
