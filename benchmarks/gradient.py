"""What exact derivatives cost: 30 parameters of the demo's motor against one response of 500 frequencies.

CPU time, the least of several runs. `python benchmarks/gradient.py --json` prints the figures as JSON.
"""

from __future__ import annotations

import json
import sys
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np

import bearingdyn as bd

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "examples"))
import motor

FREQUENCY = np.linspace(10.0, 6000.0, 500)
RUNS = 5


def least(work: Callable[[], object], runs: int = RUNS) -> float:
    """CPU seconds of the fastest of several runs."""
    found = []
    for _ in range(runs):
        start = time.process_time()
        work()
        found.append(time.process_time() - start)
    return min(found)


def parameters(eq: bd.Equilibrium) -> list[str]:
    """30 parameters of both layers, both bearings, preload and inertias, the branches first."""
    layers = ("left_layer", "right_layer")
    branches = eq.system.layers[0].material.G.size
    names = [
        f"{layer}.{name}" for layer in layers for name in ("r_inner", "r_outer", "width", "K", "density")
    ]
    names += ["left.clearance", "right.clearance", "load.shaft.middle.z", "left_ring.mass", "right_ring.mass"]
    shear = ["G0", "eta0", *(f"{s}{k + 1}" for k in range(branches) for s in ("G", "tau"))]
    return (names + [f"{layer}.{name}" for name in shear for layer in layers])[:30]


def main() -> int:
    """Print the figures; returns the exit code."""
    low = bd.fit_maxwell(
        bd.master_curve(bd.read_dma(bd.sample_dma_path()), T_ref=20.0),
        n=5,
        band=motor.BAND,
        K=motor.K_RUBBER,
        density=motor.DENSITY,
    )
    eq = bd.equilibrium(motor.motor(motor.Design("layer", 0.008, 0.0255, low)), modulus="instantaneous")
    names = parameters(eq)
    response = least(lambda: motor.response(eq, FREQUENCY))
    start = time.process_time()
    slope = bd.gradient(eq, names)
    prepared = time.process_time() - start

    def derivatives() -> object:
        return slope.response(FREQUENCY, [motor.INPUT], motor.OUTPUTS)

    gradient = least(derivatives)
    again = least(lambda: bd.gradient(eq, names), 2)
    figures = {
        "coordinates": eq.system.n,
        "frequencies": FREQUENCY.size,
        "parameters": len(names),
        "response, CPU s": response,
        "derivatives, CPU s": gradient,
        "derivatives over response": gradient / response,
        "of the system's matrices, CPU s": min(prepared, again),
        "all over response": (gradient + min(prepared, again)) / response,
    }
    if "--json" in sys.argv:
        print(json.dumps(figures, indent=1))
    else:
        for name, value in figures.items():
            print(f"{name:<34} {value:.4g}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
