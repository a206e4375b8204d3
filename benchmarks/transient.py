"""What one step of the demo's layered motor costs: best of 20 marches of 20 000 steps, on one core.

python benchmarks/transient.py [--json] [--isa best|base|avx2|avx512]
"""

from __future__ import annotations

import argparse
import json
import sys
import time
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "examples"))

import motor

import bearingdyn as bd
from bearingdyn import core

STEPS, REPEATS = 20_000, 20


def measure(isa: str) -> dict[str, float | int | str]:
    """Microseconds a step of the layered motor at speed under load, its ring-down marched before."""
    low, _, _ = motor.rubber()
    layered = motor.designs(low)[2]
    system = bd.equilibrium(motor.motor(layered, motor.RADIAL))
    modal, T = system.system.modal()
    model = modal.model([(core.CHANNEL_KINDS["displacement"], modal.row("shaft.end.y"), 0, 0)])
    scheme = core.Scheme(motor.STEP, speed=motor.SPEED, isa=isa)
    state = model.state(0.0, T.T @ system.system.M @ system.x, np.zeros(modal.n))
    _, state, _ = core.march(model, state, scheme, 4000, 100, start=True)
    best, iterations = float("inf"), 0
    for _ in range(REPEATS):
        began = time.perf_counter()
        _, state, report = core.march(model, state, scheme, STEPS, 100)
        best = min(best, time.perf_counter() - began)
        iterations += report.iterations
    seconds = best / STEPS
    return {
        "us_per_step": round(1e6 * seconds, 3),
        "real_time_factor": round(seconds / motor.STEP, 3),
        "n_coordinates": modal.n,
        "n_blocks": model.blocks,
        "bearing_evaluations_per_step": round(iterations / (REPEATS * STEPS), 2),
        "isa": isa,
    }


def main() -> int:
    """Measure and print."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--json", action="store_true", help="print one JSON object")
    parser.add_argument("--isa", default="best", choices=sorted(core.ISAS), help="instruction set")
    options = parser.parse_args()
    result = measure(options.isa)
    print(json.dumps(result) if options.json else "\n".join(f"{k:>30}: {v}" for k, v in result.items()))
    return 0


if __name__ == "__main__":
    sys.exit(main())
