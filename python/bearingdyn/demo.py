"""A small motor from end to end: rubber data, a layer, parts, response, march; a result file and a figure."""

from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

from bearingdyn import examples
from bearingdyn.analysis import equilibrium, frequency_response, transient
from bearingdyn.application import Application
from bearingdyn.material import Maxwell, fit_maxwell, master_curve, read_dma, sample_dma_path
from bearingdyn.results import save

SPEED = 3000 * math.pi / 30  # rad/s
FORCE, HOUSING = "shaft.middle.y", "left_housing.top.y"
FREQUENCY = np.linspace(20.0, 5000.0, 1000)
# the slowest mode, of ζ = 0.005 at 1.4 kHz, falls to e^{-20} while it settles
DT, STEPS, SETTLE = 2.5e-6, 40_000, 200_000


def motor(rubber: Maxwell | None) -> Application:
    """The demo's motor: a shaft in two 6203 bearings, each in a pedestal, with a layer of rubber or none."""
    return examples.motor(layers=rubber is not None, material=rubber)


def demo(folder: Path, tell: Callable[[str], object] = lambda _: None) -> dict[str, Any]:
    """The demo: the motor without and with its layer; writes result.nc and response.png to the folder.

    Parameters
    ----------
    folder
        Where result.nc and response.png are written; made if it is not there.
    tell
        Called with a line before each stage.

    Returns
    -------
    dict[str, Any]
        What the layer does, in numbers, and the files.

    Raises
    ------
    OSError
        Where the folder cannot be made or written.
    """
    from matplotlib.figure import Figure

    from bearingdyn import plot

    folder.mkdir(parents=True, exist_ok=True)
    tell("rubber: DMA data, master curve, Maxwell model")
    dma = read_dma(sample_dma_path())
    # pinned to the modulus that the curve has after a minute: the layers' at rest, at 20 °C
    curve = master_curve(dma, T_ref=20.0)
    rubber = fit_maxwell(curve, n=5, band=(10.0, 5e3), pin=60.0, K=2e9, density=1150.0)
    responses, runs, found = {}, {}, {}
    for label, material in (("no layer", None), ("layer", rubber)):
        tell(f"{label}: parts and equilibrium")
        state = equilibrium(motor(material))
        tell(f"{label}: response at {FREQUENCY.size} frequencies")
        responses[label] = frequency_response(state, FREQUENCY, [FORCE], [FORCE, HOUSING])
        tell(f"{label}: {STEPS + SETTLE} steps at {SPEED * 30 / math.pi:.0f} rpm")
        record = ["shaft.middle.x", FORCE, f"{HOUSING}.velocity"]
        runs[label] = transient(state, speed=SPEED, dt=DT, steps=STEPS, settle=SETTLE, record=record)
        H = np.abs(responses[label]["response"].values[:, :, 0])
        velocity = runs[label]["record"].sel(channel=f"{HOUSING}.velocity").values
        found[label] = {
            "receptance_20_Hz": float(H[0, 0]),
            "shaft_peak": float(H[:, 0].max()),
            "shaft_peak_frequency": float(FREQUENCY[H[:, 0].argmax()]),
            "housing_rms_1_to_5_kHz": float(np.sqrt((H[FREQUENCY >= 1e3, 1] ** 2).mean())),
            "housing_velocity_rms": float(velocity.std()),
        }
    tell("result file and figure")
    result, picture = folder / "result.nc", folder / "response.png"
    groups = {f"response {label}": data for label, data in responses.items()}
    save(groups | {f"transient {label}": data for label, data in runs.items()}, result)
    figure = Figure(figsize=(6.2, 5.0), layout="constrained")
    plot.frequency_response(responses, HOUSING, FORCE, ax=figure.add_subplot())
    figure.savefig(picture, dpi=150)
    return {**found, "files": [str(result), str(picture)]}
