"""Which layer for the motor? A design goes in; its isolation, resonance peak and sag come out.

`design` is what a study calls in each of its processes. Run it as `python examples/layer_study.py`; it
computes a grid of thickness, width and loss factor on all cores, keeps each finished case in out/layer_study,
marks the designs that no other one beats, and prints them. Then it goes for the best one: `slopes` knows the
derivatives of all that is asked, and `best` says which layer isolates best within what the air gap and the
rubber allow, and what each of these limits costs.
"""

from __future__ import annotations

import math
import sys
import warnings
from collections.abc import Callable, Mapping
from dataclasses import replace
from functools import cache
from operator import itemgetter
from pathlib import Path

import motor
import numpy as np
import xarray

import bearingdyn as bd
from bearingdyn import study
from bearingdyn.notice import StrainedLayer

GRID = {"thickness": [0.004, 0.006, 0.008, 0.011], "width": [0.017, 0.0255], "loss_factor": [0.3, 0.45, 0.6]}
FREQUENCY = np.linspace(10.0, 6000.0, 1000)
UNITS = {"thickness": "m", "width": "m", "isolation": "dB", "peak": "m/N", "sag": "m"}
NOISY = (1e3, 5e3)  # Hz, where the motor is too loud
# of the search: thickness and width, m, hardness over the measured rubber's, one more relaxation at 1 kHz, Pa
RANGES = {
    "thickness": (0.004, 0.0095),
    "width": (0.017, 0.0255),
    "hardness": (0.5, 2.0),
    "damper": (0.0, 5e6),
}
LIMITS = {"sag": 0.7e-3, "strain": 0.05}  # the air gap; what rubber that is to live strains at most
BORE = 0.041  # m, radius of the housing's bore: a steel sleeve on the ring fills what a thinner layer leaves


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


def under_load(app: bd.Application) -> bd.Equilibrium:
    """The motor under its radial load, which has rested for motor.RESTED."""
    app.load("shaft.middle", (0, -motor.RADIAL, 0, 0, 0, 0))
    with warnings.catch_warnings():
        # the study asks how far a layer strains, and the table says it, and from where on it is too far
        warnings.simplefilter("ignore", StrainedLayer)
        return bd.equilibrium(app, after=motor.RESTED)


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
    loaded = under_load(app)
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


def searched(case: Mapping[str, float]) -> motor.Design:
    """One layer of the search, in a bore that stays as it is."""
    base, hard = rubber(), case["hardness"]
    material = replace(
        base,
        G0=hard * base.G0,
        G=np.append(hard * base.G, case["damper"]),
        tau=np.append(base.tau, 1 / motor.ONE_KHZ),
        eta0=hard * base.eta0,
        fit=None,
        spread=None,
    )
    # shapes at moduli that do not move with the design
    moduli = base.G0, 4 * abs(complex(base.complex_modulus(motor.ONE_KHZ)))
    middle = BORE - 0.007, BORE, 0.021  # of one mesh for all
    return motor.Design("layer", case["thickness"], case["width"], material, BORE, moduli, middle)


def parameters(variant: motor.Design) -> dict[str, dict[str, float]]:
    """What each parameter of the search moves in the machine, on both sides."""
    base, R, w = rubber(), variant.inside, motor.RING[2]
    line = bd.STEEL.density * math.pi * w  # a thicker layer leaves a smaller sleeve
    sleeve = {
        "ring.mass": -2 * line * R,
        "ring.inertia.x": -line * (R**3 + w**2 * R / 6),
        "ring.inertia.y": -line * (R**3 + w**2 * R / 6),
        "ring.inertia.z": -2 * line * R**3,
    }
    strengths = {"layer.G0": base.G0, "layer.eta0": base.eta0}
    strengths |= {f"layer.G{k + 1}": float(G) for k, G in enumerate(base.G)}
    moved = {
        "thickness": {"layer.r_inner": -1.0, **sleeve},
        "width": {"layer.width": 1.0},
        "hardness": strengths,
        "damper": {f"layer.G{base.G.size + 1}": 1.0},
    }
    return {
        name: {f"{side}_{path}": weight for path, weight in one.items() for side in ("left", "right")}
        for name, one in moved.items()
    }


def slopes(case: Mapping[str, float]) -> dict[str, tuple[float, dict[str, float]]]:
    """isolation, sag and strain of one layer of the search, each with its slopes by thickness, width …"""
    variant = searched(case)
    app, moved = motor.motor(variant), parameters(variant)
    slope = bd.gradient(bd.equilibrium(app), moved)
    found = slope.response(FREQUENCY, [motor.INPUT], motor.OUTPUTS[1:3])
    H, by = found["response"].values[:, :, 0], found["derivative"].values[..., 0]
    band = (FREQUENCY >= NOISY[0]) & (FREQUENCY <= NOISY[1])
    weight = FREQUENCY[band, None] ** 2
    after = (weight * np.abs(H[band]) ** 2).mean()
    change = (2 * weight * (np.conj(H[band]) * by[:, band]).real).mean(axis=(1, 2))
    loaded = bd.gradient(under_load(app), moved)
    sag, by_sag = loaded.displacement("shaft.middle.y")
    strain, by_strain = max((loaded.strain(f"{side}_layer") for side in ("left", "right")), key=itemgetter(0))

    def told(value: float, slopes: np.ndarray) -> tuple[float, dict[str, float]]:
        return value, dict(zip(moved, slopes.tolist(), strict=True))

    return {
        "isolation": told(
            isolation(FREQUENCY, H, without_layer()[:, 1:3]), -10 / math.log(10) * change / after
        ),
        "sag": told(-sag, -by_sag),
        "strain": told(strain, by_strain),
    }


def plainly(case: Mapping[str, float]) -> dict[str, float]:
    """isolation, sag and strain of one layer of the search, without slopes."""
    app = motor.motor(searched(case))
    H, loaded = receptance(app), under_load(app)
    return {
        "isolation": isolation(FREQUENCY, H[:, 1:3], without_layer()[:, 1:3]),
        "sag": float(-loaded.displacement("shaft.middle")[1]),
        "strain": float(bd.static_summary(loaded)["strain"].max()),
    }


def best(starts: int = 3) -> study.Optimum:
    """The layer that isolates best within LIMITS."""
    return study.optimise(slopes, RANGES, maximise="isolation", limits=LIMITS, starts=starts)


def told(found: study.Optimum) -> str:
    """The optimum in words, its prices in units that one can picture."""
    layer, values, prices = found.parameters, found.values, found.prices
    lines = [
        f"{layer['thickness'] * 1e3:.2f} mm thick, {layer['width'] * 1e3:.1f} mm wide, "
        f"{layer['hardness']:.2f} times as hard, a damper of {layer['damper'] / 1e6:.2f} MPa: "
        f"{values['isolation']:.2f} dB",
        f"sag {values['sag'] * 1e6:.0f} µm, strain {values['strain']:.1%}; {found.evaluations} designs, "
        f"residual {found.kkt:.1e}",
    ]
    if "sag" in prices:
        lines.append(f"the air gap is used up: {prices['sag'] * 1e-6:+.4f} dB for each µm more")
    if "strain" in prices:
        lines.append(
            f"the rubber strains as far as it may: {prices['strain'] * 1e-2:+.3f} dB for each % more"
        )
    ends = {
        "thickness": (1e-3, "mm"),
        "width": (1e-3, "mm"),
        "hardness": (1.0, "times"),
        "damper": (1e6, "MPa"),
    }
    for name, price in found.at_range.items():
        unit, word = ends[name]
        lines.append(f"{name} is at the end of its range: {price * unit:+.3f} dB for each {word} more")
    return "\n".join(lines)


def main() -> int:
    """Run the study; returns the exit code."""
    found = table(Path("out", "layer_study"), progress=True)
    front = found.isel(case=found["front"].values).sortby("sag")
    print(front.to_dataframe().drop(columns=["error", "front"]).to_string(float_format=lambda x: f"{x:.4g}"))
    print("a layer's linear stiffness is 1 % low at a strain of 4 % and 5 % low at 9 %: see StrainedLayer")
    print(told(best()))
    return 0


if __name__ == "__main__":
    sys.exit(main())
