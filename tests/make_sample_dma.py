"""Makes the sample DMA table shipped with the package: python tests/make_sample_dma.py

The table is made from a stated Maxwell model and a stated WLF law with seeded noise. Nothing here uses the
package.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np

PATH = Path(__file__).parents[1] / "python" / "bearingdyn" / "material" / "sample_dma.csv"

G0 = 1.2e6  # Pa
G = np.array([15e6, 6e6, 2.5e6, 1.0e6, 0.5e6])  # Pa
TAU = np.array([1e-6, 3e-5, 1e-3, 3e-2, 1.0])  # s, at T_REF
C1, C2, T_REF = 8.0, 120.0, 20.0  # -, K, °C
NOISE, JITTER = 0.01, 0.05  # relative, of each modulus; K
TEMPERATURES = np.arange(-20.0, 61.0, 10.0)  # °C
FREQUENCIES = np.logspace(-1, np.log10(50.0), 15)  # Hz

HEADER = """\
# MADE DATA, not measured: from a generalised Maxwell model, a WLF law and noise (tests/make_sample_dma.py)
# G0 = 1.2 MPa; G = 15, 6, 2.5, 1, 0.5 MPa; tau = 1e-6, 3e-5, 1e-3, 3e-2, 1 s at 20 C; eta0 = 0
# log10 aT = -8 (T - 20)/(120 + T - 20); normal noise of 1 % on either modulus, 0.05 K on the temperature
"""


def log_shift(T):
    """log10 a_T of the stated law at T, °C."""
    return -C1 * (np.asarray(T) - T_REF) / (C2 + np.asarray(T) - T_REF)


def modulus(omega):
    """Complex modulus of the stated model, Pa, at ω, rad/s, and T_REF."""
    return G0 + sum(g / (1 + 1 / (1j * omega * t)) for g, t in zip(G, TAU, strict=True))


def points(seed, noise=NOISE, jitter=JITTER):
    """Frequency Hz, temperature °C, storage Pa and loss Pa of nine noisy isotherms."""
    rng = np.random.default_rng(seed)
    f = np.tile(FREQUENCIES, TEMPERATURES.size)
    T = np.repeat(TEMPERATURES, FREQUENCIES.size) + jitter * rng.standard_normal(f.size)
    exact = modulus(2 * np.pi * f * 10 ** log_shift(T))
    storage = exact.real * (1 + noise * rng.standard_normal(f.size))
    loss = exact.imag * (1 + noise * rng.standard_normal(f.size))
    return f, T, storage, loss


def table(seed=20):
    """Text of the sample file."""
    rows = zip(*points(seed), strict=True)
    body = "".join(f"{f:.6g},{T:.3f},{s:.6g},{q:.6g}\n" for f, T, s, q in rows)
    return HEADER + "frequency_Hz,temperature_C,G_storage_Pa,G_loss_Pa\n" + body


if __name__ == "__main__":
    PATH.write_text(table(), encoding="utf-8", newline="\n")
