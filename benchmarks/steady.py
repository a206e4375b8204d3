"""Steady motions of the demo's motor without and with its layer: one speed, and a map from 500 to 12 000 rpm.

python benchmarks/steady.py [--json] [--points 500] [--one]

One speed is the balance from the equilibrium's own start to a Dataset, with and without stability, best of
ten; the march it replaces is the ring-down and record of the demo. A map follows all branches with stability.
CPU seconds beside those of the clock, for what shares the machine. With --one, one speed alone.
"""

from __future__ import annotations

import argparse
import json
import math
import sys
import time
import warnings
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


def whole_map(eq: bd.Equilibrium, points: int) -> dict[str, float]:
    """Seconds of a map, its points, and those that failed."""
    cpu, clock = time.process_time(), time.perf_counter()
    data = bd.speed_map(eq, speeds=(LOW, HIGH), record=RECORD, points=points, several=False, progress=False)
    return {
        "s": round(time.perf_counter() - clock, 1),
        "cpu_s": round(time.process_time() - cpu, 1),
        "points": data.sizes["point"],
        "branches": int(data["branch"].max()) + 1,
        "failed": int(data.attrs["failed"]),
    }


def main() -> int:
    """Print all figures."""
    asked = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    asked.add_argument("--json", action="store_true", help="print JSON")
    asked.add_argument("--points", type=int, default=500, help="of a branch that hardly bends")
    asked.add_argument("--one", action="store_true", help="one speed alone")
    given = asked.parse_args()
    low, _, _ = motor.rubber()
    bare, layered, *_ = motor.designs(low)
    found = {}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)
        for name, design in (("bare", bare), ("layered", layered)):
            eq = bd.equilibrium(motor.motor(design, motor.RADIAL))
            found[name] = {"one_speed": one_speed(eq)}
            if not given.one:
                found[name]["map"] = whole_map(eq, given.points)
    if given.json:
        print(json.dumps(found))
    else:
        for name, each in found.items():
            for what, figures in each.items():
                print(name, what, figures)
    return 0


if __name__ == "__main__":
    sys.exit(main())
