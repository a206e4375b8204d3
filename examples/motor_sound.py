"""The motor as it is heard: sound power of its two pedestals in third octaves, A-weighted, design by design.

The cause is the same for all: a vertical force at mid-shaft of 1 N rms in each third octave, even within it.
`motor_report.py` prints the levels and draws them.
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import motor
import numpy as np
import xarray

import bearingdyn as bd

FORCE = 1.0  # N rms in each third octave
# Hz: whole third octaves. Above, the pedestals, one facing the other, echo so sharply that the radiation
# takes five times as many frequencies; below there is .1 % of the power
BANDS = bd.sound.bands(200.0, 1250.0)[1]
# m, of the panels: some .15 dB less power than with 12.5 mm, of every design and at 250 to 1250 Hz; 21 mm,
# for some .1 dB, take twice as long
PANELS = 0.024
# a step of .1 %: ten lines over the half-width of the sharpest peak of ζ = 1 %
FREQUENCY = np.geomspace(BANDS[0] * (1 + 1e-9), BANDS[-1] * (1 - 1e-9), 2800)


def force_lines(frequency: np.ndarray = FREQUENCY) -> np.ndarray:
    """Mean square (f,), N², that each line stands for: FORCE² in every third octave."""
    width = np.gradient(frequency)
    band = np.searchsorted(BANDS, frequency, side="right") - 1
    return np.asarray(FORCE**2 * width / np.bincount(band, width)[band])


def heard(eq: bd.Equilibrium, cache: Path | None = None) -> xarray.Dataset:
    """Levels of the sound power in third octaves, as `bd.sound.band_levels` gives them.

    With equivalent_total, dB(A), what the equivalent radiated power says instead, and interpolation_error,
    dB, of the weighted total: the errors of its lines, each weighted as its power is.
    """
    found = bd.sound_power(eq, FREQUENCY, [motor.INPUT], motor.SURFACES, element_size=PANELS, cache=cache)
    # a mean square is half the square of the zero-to-peak amplitude that the result is for
    lines = 2.0 * force_lines()
    power = np.maximum(found["power"].values[:, 0], 0.0) * lines
    plane = found["equivalent_radiated_power"].values[:, 0] * lines
    levels = bd.sound.band_levels(FREQUENCY, power)
    levels["equivalent_total"] = bd.sound.band_levels(FREQUENCY, plane)["weighted_total"]
    off = 10 ** (found["interpolation_error"].values[:, 0] / 10.0) * power
    unsure = bd.sound.band_levels(FREQUENCY, off)["weighted_total"] - levels["weighted_total"]
    levels["interpolation_error"] = ((), float(unsure), {"units": "dB"})
    return levels


def table(found: Mapping[str, xarray.Dataset]) -> None:
    """Print L_WA of each design, by how much a layer helps, and where most."""
    bare = found["no layer"]
    low, high = (float(bare["band"].values[k]) for k in (0, -1))
    print(f"\nsound power, {FORCE:g} N rms at mid-shaft in each third octave from {low:g} to {high:g} Hz")
    print(f"  {'':<24}{'L_WA':>12}{'against no layer':>18}{'most helped band':>30}{'L_WA by ERP':>14}")
    for label, levels in found.items():
        total = float(levels["weighted_total"])
        change = total - float(bare["weighted_total"])
        by_band = levels["level"].values - bare["level"].values
        k = int(np.argmin(by_band))
        most = (
            "" if label == "no layer" else f"{by_band[k]:+.1f} dB at {float(levels['band'].values[k]):g} Hz"
        )
        against = "" if label == "no layer" else f"{change:+.1f} dB"
        print(
            f"  {label:<24}{total:>6.1f} dB(A){against:>18}{most:>30}"
            f"{float(levels['equivalent_total']):>8.1f} dB(A)"
        )
    worst = max(float(levels["interpolation_error"]) for levels in found.values())
    print(f"  re 1 pW; interpolating the radiation over frequency leaves {worst:.2f} dB by its own estimate")
    print(
        f"  above {BANDS[-1]:.0f} Hz nothing is said, though the pedestals are right to 10 kHz: they face "
        f"one another, and their echoes ask for five times as many frequencies"
    )


def picture(found: Mapping[str, xarray.Dataset]) -> Any:
    """The third-octave picture: A-weighted levels, the designs side by side in each band."""
    from bearingdyn.plot.frame import colour, finish, new_axes, style

    with style():
        ax = new_axes(width=7.4, height=4.8)
        labels = list(found)
        wide = 0.8 / len(labels)
        # below the lowest, so that every band of every design has its bar
        lowest = min(float(levels["weighted_level"].min()) for levels in found.values())
        floor = 10.0 * np.floor(lowest / 10.0 - 0.2)
        for k, label in enumerate(labels):
            level = found[label]["weighted_level"].values
            at = np.arange(level.size) + (k - (len(labels) - 1) / 2) * wide
            total = float(found[label]["weighted_total"])
            ax.bar(
                at,
                level - floor,
                wide,
                bottom=floor,
                color=colour(k),
                label=f"{label}: {total:.0f} dB(A)",
            )
        band = found[labels[0]]["band"].values
        ax.set_xticks(np.arange(band.size), [f"{b:g}" for b in band])
        ax.set_xlabel("third octave, Hz")
        ax.set_ylabel("A-weighted sound power level, dB re 1 pW")
        finish(ax, f"Sound power, {FORCE:g} N rms in each band at mid-shaft", legend=True)
    return ax
