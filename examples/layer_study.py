"""Which layer for the motor? A design goes in; its isolation, resonance peak and sag come out.

`design` is what a study calls in each of its processes. Run it as `python examples/layer_study.py`; it
computes a grid of thickness, width and loss factor on all cores, keeps each finished case in out/layer_study,
marks the designs that no other one beats, and prints them.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Mapping
from functools import cache
from pathlib import Path

import motor
import numpy as np
import xarray

import bearingdyn as bd
from bearingdyn import study

GRID = {"thickness": [0.004, 0.006, 0.008, 0.011], "width": [0.017, 0.0255], "loss_factor": [0.3, 0.45, 0.6]}
FREQUENCY = np.linspace(10.0, 6000.0, 1000)
UNITS = {"thickness": "m", "width": "m", "isolation": "dB", "peak": "m/N", "sag": "m"}
NOISY = (1e3, 5e3)  # Hz, where the motor is too loud


@cache
def rubber() -> bd.Maxwell:
    """The rubber all designs start from: fitted once in each process."""
    return motor.rubber()[0]


@cache
def without_layer() -> np.ndarray:
    """Receptances (f, output) of the motor without layers, m/N."""
    return receptance(motor.motor(motor.Design("no layer")))


def receptance(app: bd.Application) -> np.ndarray:
    """Receptances (f, output) about the equilibrium of a motor, m/N."""
    return motor.response(bd.equilibrium(app), FREQUENCY)["response"].values[:, :, 0]


def isolation(frequency: np.ndarray, level: np.ndarray, plain: np.ndarray) -> float:
    """By how much the velocity in NOISY falls from receptances `plain` to `level`, both (f, outputs), dB."""
    band = (frequency >= NOISY[0]) & (frequency <= NOISY[1])
    before, after = ((frequency[band, None] * np.abs(H[band])) ** 2 for H in (plain, level))
    return float(10 * np.log10(before.mean() / after.mean()))


def design(case: Mapping[str, float]) -> dict[str, float]:
    """One layer: thickness and width, m, and loss factor at 1 kHz at equal |G*|.

    Returns isolation: by how much the velocity of the housing from 1 to 5 kHz falls, dB, mean of y and z;
    peak: the highest receptance of the shaft's end, m/N; sag: how far mid-shaft gives under 10 kN that have
    rested for motor.RESTED at 20 °C, m; strain: the layer's nominal strain under them.
    """
    material = rubber().with_relaxation(case["loss_factor"], motor.ONE_KHZ)
    variant = motor.Design("layer", case["thickness"], case["width"], material)
    app = motor.motor(variant)
    H = receptance(app)
    app.load("shaft.middle", (0, -motor.RADIAL, 0, 0, 0, 0))
    loaded = bd.equilibrium(app, after=motor.RESTED)
    still = bd.static_summary(loaded)
    return {
        "isolation": isolation(FREQUENCY, H[:, 1:3], without_layer()[:, 1:3]),
        "peak": float(np.abs(H[:, 0]).max()),
        "sag": float(-loaded.displacement("shaft.middle")[1]),
        "strain": float(still["strain"].max()),
    }


def table(
    store: Path | None = None,
    progress: Callable[[int, int], object] | bool = False,
    **axes: list[float],
) -> xarray.Dataset:
    """The study over GRID, or other axes, with the variable "front": designs no other one beats."""
    cases = study.sweep(design, study.grid(**(axes or GRID)), store=store, progress=progress)
    return study.pareto(study.table(cases, UNITS), minimise=["sag", "peak"], maximise=["isolation"])


def main() -> int:
    """Run the study; returns the exit code."""
    found = table(Path("out", "layer_study"), progress=True)
    front = found.isel(case=found["front"].values).sortby("sag")
    print(front.to_dataframe().drop(columns=["error", "front"]).to_string(float_format=lambda x: f"{x:.4g}"))
    return 0


if __name__ == "__main__":
    sys.exit(main())
