"""Steady motions of the demo's motor without and with its layer: one speed, and a map from 500 to 12 000 rpm.

python benchmarks/steady.py [--json] [--points 500] [--one] [--cores 2]

One speed is the balance from the equilibrium's own start to a Dataset, with and without stability, best of
ten; the march it replaces is the ring-down and record of the demo. A map follows all branches with stability,
its searches spread over processes; both designs' maps run at once. Beside the seconds of the clock stand the
CPU seconds of each process, for what shares the machine: an idle one takes about as long as the largest of
them. With --one, one speed alone.
"""

from __future__ import annotations

import argparse
import json
import math
import os
import sys
import time
import warnings
from concurrent.futures import Executor, ProcessPoolExecutor, ThreadPoolExecutor
from multiprocessing import get_context
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "examples"))

import motor

import bearingdyn as bd

RECORD = ["shaft.end.y.velocity", "left_housing.top.y.velocity"]
RPM = math.pi / 30
LOW, HIGH = 500 * RPM, 12_000 * RPM
REPEATS = 10


def one_speed(eq: bd.Equilibrium) -> dict[str, float]:
    """Least CPU milliseconds of one steady state at 5000 rpm."""
    least = {True: math.inf, False: math.inf}
    for stability in least:
        for _ in range(REPEATS):
            began = time.process_time()
            found = bd.steady_state(eq, speed=motor.SPEED, record=RECORD, stability=stability)
            least[stability] = min(least[stability], time.process_time() - began)
    return {
        "ms": round(1e3 * least[False], 1),
        "ms_with_stability": round(1e3 * least[True], 1),
        "energy_balance": float(found.attrs["energy_balance"]),
    }


def whole_map(eq: bd.Equilibrium, points: int, pool: Executor | None = None) -> dict[str, float]:
    """Seconds of a map, its points, and those that failed."""
    cpu, clock = time.thread_time(), time.perf_counter()
    data = bd.speed_map(
        eq,
        speeds=(LOW, HIGH),
        record=RECORD,
        points=points,
        several=False,
        executor=pool,
        progress=False,
    )
    return {
        "s": round(time.perf_counter() - clock, 1),
        "cpu_s": round(time.thread_time() - cpu, 1),
        "points": data.sizes["point"],
        "branches": int(data["branch"].max()) + 1,
        "failed": int(data.attrs["failed"]),
    }


def worker() -> tuple[int, float]:
    """A process of the pool, and its CPU seconds; it waits a little, so that each is asked."""
    time.sleep(0.2)
    return os.getpid(), time.process_time()


def both_maps(designs: dict[str, bd.Equilibrium], points: int, cores: int) -> dict[str, object]:
    """Maps of both designs over so many processes; here, nothing runs but what puts them together."""
    with ProcessPoolExecutor(cores, mp_context=get_context("spawn")) as pool:
        workers = [pool.submit(worker) for _ in range(4 * cores)]
        before = dict(w.result() for w in workers)
        clock, cpu = time.perf_counter(), time.process_time()
        with ThreadPoolExecutor(len(designs)) as threads:
            made = {name: threads.submit(whole_map, eq, points, pool) for name, eq in designs.items()}
            found: dict[str, object] = {name: m.result() for name, m in made.items()}
        found["s"] = round(time.perf_counter() - clock, 1)
        found["cpu_s"] = round(time.process_time() - cpu, 1)
        workers = [pool.submit(worker) for _ in range(4 * cores)]
        after = dict(w.result() for w in workers)
    found["cpu_s_of_processes"] = [round(after[pid] - before.get(pid, 0.0), 1) for pid in after]
    return found


def main() -> int:
    """Print all figures."""
    asked = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    asked.add_argument("--json", action="store_true", help="print JSON")
    asked.add_argument("--points", type=int, default=500, help="of a branch that hardly bends")
    asked.add_argument("--cores", type=int, default=2, help="processes of the maps")
    asked.add_argument("--one", action="store_true", help="one speed alone")
    given = asked.parse_args()
    low, _, _ = motor.rubber()
    bare, layered, *_ = motor.designs(low)
    found: dict[str, object] = {}
    designs = {}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)
        for name, design in (("bare", bare), ("layered", layered)):
            eq = designs[name] = bd.equilibrium(motor.motor(design, motor.RADIAL))
            found[name] = one_speed(eq)
        if not given.one:
            found["maps"] = both_maps(designs, given.points, given.cores)
    if given.json:
        print(json.dumps(found))
    else:
        for name, figures in found.items():
            print(name, figures)
    return 0


if __name__ == "__main__":
    sys.exit(main())
