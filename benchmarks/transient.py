"""What one step of the demo's layered motor costs: best of 20 marches of 20 000 steps, on one core.

python benchmarks/transient.py [--json] [--isa best|base|avx2|avx512] [--scaling]

With --scaling, a made-up model instead, one dense block of modes with a layer of rank 6 and bearings of
eight balls: the time of a step along lines over coordinates, bearings and branches, each with the exponent
of its upper half; and steps a second of 1 and 2 threads marching models of their own (the GIL is dropped).
"""

from __future__ import annotations

import argparse
import json
import sys
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

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
    scheme = core.Stepping(motor.STEP, speed=motor.SPEED, scheme=core.Scheme(isa=isa))
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


BALLS = bd.BallBearing(Z=8, Dw=9e-3, Dpw=40e-3, fi=0.52, fo=0.53, contact_angle=0.26, damping=100.0)
PLAIN = {"coordinates": 64, "bearings": 2, "branches": 5}
LINES: dict[str, list[int]] = {
    "coordinates": [16, 32, 64, 128, 256, 512],
    "bearings": [1, 2, 4, 8],
    "branches": [1, 2, 5, 10, 20],
}
THREADS = (1, 2)


def made_up(coordinates: int, bearings: int, branches: int) -> core.Model:
    """Modes from 50 Hz to 20 kHz, coupled by a layer; every bearing moves with all of them."""
    rng = np.random.default_rng(1)
    omega = 2.0 * np.pi * np.geomspace(50.0, 2e4, coordinates)
    zero = np.zeros((coordinates, coordinates))
    L = 1e-3 * rng.standard_normal((coordinates, 6))
    layer = (L, np.geomspace(1e5, 1e6, branches), np.geomspace(1e-2, 1e-5, branches))
    share = 1.0 / np.sqrt(coordinates)
    kernel = BALLS.kernel().packed()
    hung = [(kernel, share * rng.standard_normal((5, coordinates))) for _ in range(bearings)]
    push = 50.0 * sum(B[0] + B[2] for _, B in hung)
    nothing = np.zeros(0)
    load = (core.LOAD_KINDS["constant"], 0.0, push, np.zeros(coordinates), nothing, nothing)
    damping, stiffness = np.diag(0.02 * omega), np.diag(omega**2)
    channel = (core.CHANNEL_KINDS["displacement"], np.eye(coordinates)[0], 0, 0)
    return core.Model(np.eye(coordinates), damping, zero, stiffness, zero, [layer], hung, [load], [channel])


def march_time(model: core.Model, n: int, scheme: core.Stepping, steps: int, repeats: int) -> float:
    """Least seconds a step, the preparation of the march taken off."""
    _, state, _ = core.march(model, model.state(0.0, np.zeros(n), np.zeros(n)), scheme, 1000, 100, start=True)
    least = {1: float("inf"), 1 + steps: float("inf")}
    for _ in range(repeats):
        for count in least:
            began = time.perf_counter()
            core.march(model, state, scheme, count, 100)
            least[count] = min(least[count], time.perf_counter() - began)
    return (least[1 + steps] - least[1]) / steps


def exponent(x: list[int], y: list[float]) -> float:
    """Slope of log y over log x, fitted to the upper half of a line, where fixed costs weigh least."""
    half = len(x) // 2
    return round(float(np.polyfit(np.log(x[half:]), np.log(y[half:]), 1)[0]), 2)


def ensemble(threads: int, scheme: core.Stepping, repeats: int) -> float:
    """Steps a second, in millions, of as many threads as given, each with a model of its own."""
    models = [made_up(**PLAIN) for _ in range(threads)]
    n, steps = PLAIN["coordinates"], 20_000
    states = [m.state(0.0, np.zeros(n), np.zeros(n)) for m in models]
    best = 0.0
    with ThreadPoolExecutor(threads) as pool:
        for _ in range(repeats):
            began = time.perf_counter()
            running = [
                pool.submit(core.march, m, s, scheme, steps, 100, start=True)
                for m, s in zip(models, states, strict=True)
            ]
            for one in running:
                one.result()
            best = max(best, 1e-6 * threads * steps / (time.perf_counter() - began))
    return best


def scaling(isa: str) -> dict[str, Any]:
    """Lines through the plain made-up model, one parameter varied at a time."""
    scheme = core.Stepping(motor.STEP, speed=motor.SPEED, scheme=core.Scheme(isa=isa))
    result: dict[str, Any] = {"isa": isa, "plain": PLAIN}
    for name, values in LINES.items():
        times = []
        for value in values:
            size = PLAIN | {name: value}
            steps = max(200, 100_000 // size["coordinates"])
            times.append(1e6 * march_time(made_up(**size), size["coordinates"], scheme, steps, 2 * REPEATS))
        result[name] = {
            "values": values,
            "us_per_step": [round(t, 3) for t in times],
            "exponent": exponent(values, times),
        }
    rates = [ensemble(count, scheme, REPEATS) for count in THREADS]
    result["threads"] = {
        "values": list(THREADS),
        "million_steps_per_second": [round(r, 3) for r in rates],
        "exponent": exponent([1, *THREADS], [rates[0], *rates]),
    }
    return result


def main() -> int:
    """Measure and print."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--json", action="store_true", help="print one JSON object")
    parser.add_argument("--isa", default="best", choices=sorted(core.ISAS), help="instruction set")
    parser.add_argument("--scaling", action="store_true", help="lines over size, bearings, branches, threads")
    options = parser.parse_args()
    result = scaling(options.isa) if options.scaling else measure(options.isa)
    print(json.dumps(result) if options.json else "\n".join(f"{k:>30}: {v}" for k, v in result.items()))
    return 0


if __name__ == "__main__":
    sys.exit(main())
