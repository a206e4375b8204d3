"""What exact derivatives cost: 30 parameters of the demo's motor against one response of 500 frequencies.

Both are of one force and four outputs, from a given equilibrium to a Dataset. Three ratios, each of CPU
times that are the least of several runs:

derivatives over response: `slope.response` over `frequency_response`. Target 3. The response itself and
    the adjoints of its outputs are counted, and what a `Gradient` prepares once for all its answers is not.
prepared and told over response: with `bd.gradient` itself, which differentiates the element matrices of
    the layers, their shapes and the equilibrium. A response has no such work: its layers were reduced when
    the machine was built.
a design with derivatives over one without: both from the drawing on, layers reduced anew, as a search sees
    them.

`python benchmarks/gradient.py --json` prints the figures as JSON.
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

    def built() -> bd.Equilibrium:
        variant = motor.Design("layer", 0.008, 0.0255, low)
        return bd.equilibrium(motor.motor(variant), modulus="instantaneous")

    eq = built()
    names = parameters(eq)
    slope = bd.gradient(eq, names)

    def derivatives(slope: bd.Gradient) -> object:
        return slope.response(FREQUENCY, [motor.INPUT], motor.OUTPUTS)

    response = least(lambda: motor.response(eq, FREQUENCY))
    gradient = least(lambda: derivatives(slope))
    prepared = least(lambda: bd.gradient(eq, names))
    # shaft and housing are kept, and reduced before
    design = least(lambda: motor.response(built(), FREQUENCY))
    design_with = least(lambda: derivatives(bd.gradient(built(), names)))
    figures = {
        "coordinates": eq.system.n,
        "frequencies": FREQUENCY.size,
        "parameters": len(names),
        "response, CPU s": response,
        "derivatives, CPU s": gradient,
        "derivatives over response": gradient / response,
        "preparing them, CPU s": prepared,
        "prepared and told over response": (gradient + prepared) / response,
        "a design without them, CPU s": design,
        "a design with derivatives over one without": design_with / design,
    }
    if "--json" in sys.argv:
        print(json.dumps(figures, indent=1))
    else:
        for name, value in figures.items():
            print(f"{name:<44} {value:.4g}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
