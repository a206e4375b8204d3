"""Designs a minute: the demo's motor, its layer's geometry and rubber changed, on two workers.

A design is a new layer (thickness, width) of a new rubber (modulus, loss factor): its reduction, the
nonlinear equilibrium of the motor at 10 kN, and its response at 1000 frequencies at three outputs. Shaft and
housing stay, and each worker reduces them once: the bore is given, and a thinner layer has a thicker ring
within. With --bore the bore changes too, and with it the housing, which each design then reduces anew; with
--family it is a member of a family of housings, made once in each process (bd.solid_family).

Printed: designs a minute by the clock, and CPU time a design, with two workers and in this process alone;
starting the workers and the first reduction of what stays are left out, as a study of thousands sees them.
"""

from __future__ import annotations

import argparse
import functools
import json
import multiprocessing
import os
import sys
import time
from concurrent.futures import ProcessPoolExecutor, ThreadPoolExecutor
from pathlib import Path
from typing import Any

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "examples"))

import motor

import bearingdyn as bd
from bearingdyn.examples.paper import PRELOAD, paper_pedestal, paper_shaft, plain_6305

BORE = 0.039  # m, radius: a layer of 2 to 6 mm leaves a ring of 2 mm or more outside the raceway
FREQUENCY = np.linspace(10.0, 6000.0, 1000)
WORKERS = 2
RANGES = {"thickness": (0.002, 0.006), "width": (0.012, 0.026), "G0": (5e5, 5e6, "log"), "loss": (0.2, 3.0)}


@functools.cache
def shaft() -> bd.Superelement:
    """The shaft, reduced once in each process."""
    return paper_shaft().superelement()


@functools.lru_cache(maxsize=1)
def housing(bore: float) -> bd.Superelement:
    """The housing, reduced where the bore is another than before."""
    return paper_pedestal(2 * bore).superelement()


def pedestal(bore: float) -> bd.Housing:
    """The pedestal with a bore of this radius, m."""
    return paper_pedestal(2 * bore)


@functools.cache
def housings() -> bd.SolidFamily:
    """The pedestals of all bores, within 1 % of their full models to 5 kHz."""
    return bd.solid_family(pedestal, BORE, BORE + 1e-3, frequency=[100.0, 1000.0, 2500.0, 5000.0])


def build(case: dict[str, Any]) -> bd.Application:
    """The motor with the layer of this case on both sides."""
    bore, thickness, G0 = case["bore"], case["thickness"], case["G0"]
    rubber = bd.Maxwell(G0, [0.5 * G0, case["loss"] * G0], [1e-3, 5e-5], K=2e9, density=1150.0)
    layer = bd.Layer(bore - thickness, bore, case["width"], rubber)
    ring = bd.RigidBody.ring(motor.RING[0], bore - thickness, motor.RING[2])
    ball = plain_6305()
    stand = housings()(bore) if case["family"] else housing(bore)
    app = bd.Application()
    app.add("shaft", shaft())
    app.free("shaft.middle")
    for side in ("left", "right"):
        app.add(f"{side}_inner", bd.RigidBody.ring(*motor.INNER, rotating=True))
        app.add(f"{side}_ring", ring)
        app.add(f"{side}_layer", layer)
        app.add(f"{side}_housing", stand)
        app.connect(f"shaft.{side}", f"{side}_inner.centre")
        # the ring grows and shrinks with the layer, which stands over it on both sides
        app.connect(f"{side}_ring.centre", f"{side}_layer.inner", fits=False)
        app.connect(f"{side}_layer.outer", f"{side}_housing.bore")
        app.ground(f"{side}_housing.feet")
        app.bearing(side, ball, inner=f"shaft.{side}", outer=f"{side}_ring.centre", fits=False)
    app.load("shaft.middle", (0.0, -motor.RADIAL, PRELOAD, 0.0, 0.0, 0.0))
    return app


def design(case: dict[str, Any]) -> dict[str, float]:
    """Static and peak receptance at mid-shaft, mean of the housing's; CPU time it took, and the process."""
    began = time.process_time()
    state = bd.equilibrium(build(case))
    found = bd.frequency_response(state, FREQUENCY, [motor.INPUT], motor.OUTPUTS[1:])
    H = np.abs(found["response"].values[:, :, 0])
    return {
        "static": float(H[0, 2]),
        "peak": float(H[:, 2].max()),
        "housing": float(np.sqrt((H[:, :2] ** 2).mean())),
        "cpu": time.process_time() - began,
        "pid": os.getpid(),
    }


def cases(n: int, new_bore: bool, family: bool = False) -> list[dict[str, Any]]:
    """Designs that fill the ranges; the bore varies by up to 1 mm where it is to."""
    bores = {"bore": (BORE, BORE + 1e-3)} if new_bore or family else {}
    return [{"bore": BORE, "family": family} | case for case in bd.study.sobol(n, **RANGES, **bores)]


def measure(designs: int, new_bore: bool, family: bool) -> dict[str, Any]:
    """The same designs with two workers, then alone."""
    todo = cases(designs, new_bore, family)
    spawn = multiprocessing.get_context("spawn")
    with ProcessPoolExecutor(WORKERS, mp_context=spawn) as pool:
        started: set[float] = set()
        while len(started) < WORKERS:
            warm = bd.study.sweep(design, todo[: 2 * WORKERS], pool)
            started |= {case.values["pid"] for case in warm}
        began = time.perf_counter()
        shared = bd.study.sweep(design, todo, pool)
        seconds = time.perf_counter() - began
    design(todo[-1])  # what stays is reduced here too
    with ThreadPoolExecutor(1) as here:
        began = time.perf_counter()
        alone = bd.study.sweep(design, todo, here)
        seconds_alone = time.perf_counter() - began
    failed = [case.error for case in (*shared, *alone) if case.error is not None]
    if failed:
        raise RuntimeError(f"{len(failed)} designs failed, the first with: {failed[0]}")
    cpu, cpu_alone = (sum(case.values["cpu"] for case in run) / designs for run in (shared, alone))
    return {
        "designs": designs,
        "new_bore": new_bore or family,
        "family": family,
        "designs_per_minute": round(60 * designs / seconds, 1),
        "designs_per_minute_alone": round(60 * designs / seconds_alone, 1),
        "cpu_seconds_per_design": round(cpu, 4),
        "cpu_seconds_per_design_alone": round(cpu_alone, 4),
        "cpu_ratio": round(cpu / cpu_alone, 3),
        "workers": WORKERS,
        "busy_processors": round(os.getloadavg()[0], 1) if hasattr(os, "getloadavg") else None,
    }


def main() -> int:
    """Measure and print."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--json", action="store_true", help="print one JSON object")
    parser.add_argument("--designs", type=int, default=100, help="how many (default 100)")
    parser.add_argument("--bore", action="store_true", help="a new bore, and so a new housing, in each")
    parser.add_argument("--family", action="store_true", help="a new bore, its housing out of a family")
    options = parser.parse_args()
    result = measure(options.designs, options.bore, options.family)
    print(json.dumps(result) if options.json else "\n".join(f"{k:>30}: {v}" for k, v in result.items()))
    return 0


if __name__ == "__main__":
    sys.exit(main())
