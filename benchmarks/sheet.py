"""Load cases of one bearing a second: equilibrium, ball loads, pressure and reference life, in one process.

The target is 10 000 a second on one core. Loads are drawn at random, radial, axial and moments, up to some
thirds of the static rating; CPU time is printed beside the clock's, which others on the machine may share.
"""

from __future__ import annotations

import argparse
import json
import time

import numpy as np

import bearingdyn as bd
from bearingdyn.types import Array

BEARINGS = ("6205", "6312", "61908", "7205", "7014C")
TARGET = 1e4


def loads(ball: bd.BallBearing, count: int) -> Array:
    """Loads (count, 6) at random; an angular contact bearing has thrust enough to keep its balls in place."""
    rng = np.random.default_rng(1)
    C0 = ball.static_rating
    f = np.zeros((count, 6))
    f[:, :2] = rng.normal(0, 0.1 * C0, (count, 2))
    if ball.contact_angle:
        f[:, 2] = 0.1 * C0 + 1.3 * np.hypot(f[:, 0], f[:, 1])
    else:
        f[:, 2] = rng.normal(0, 0.05 * C0, count)
    f[:, 3:5] = rng.normal(0, 1e-3 * C0 * ball.Dpw, (count, 2))
    return f


def main() -> None:
    """Print cases a second of each bearing, as a table or as JSON."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--json", action="store_true", help="print JSON")
    parser.add_argument("--cases", type=int, default=10_000, help="load cases of each bearing")
    arguments = parser.parse_args()
    found = {}
    for name in BEARINGS:
        ball = bd.catalogue.bearing(name)
        f = loads(ball, arguments.cases)
        bd.bearing.load_cases(ball, f[:10])
        clock, cpu = time.perf_counter(), time.process_time()
        bd.bearing.load_cases(ball, f)
        found[name] = {
            "cases": arguments.cases,
            "per_second": arguments.cases / (time.perf_counter() - clock),
            "per_cpu_second": arguments.cases / (time.process_time() - cpu),
        }
    if arguments.json:
        print(json.dumps({"target_per_cpu_second": TARGET, "bearings": found}, indent=1))
        return
    for name, one in found.items():
        print(f"{name:>7}: {one['per_second']:8.0f} cases/s, {one['per_cpu_second']:8.0f} per CPU second")


if __name__ == "__main__":
    main()
