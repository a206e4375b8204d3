"""What the film of a point contact costs, on one core: steady state, harmonic answer, step in time, look-up.

OPENBLAS_NUM_THREADS=1 python benchmarks/ehl.py [--json]

Times are of the processor, the least of a few.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Callable

import numpy as np
from printing import printed

from bearingdyn.bearing import ehl

NODES, REPEATS = (65, 129), 3
OMEGA = np.array([0.02, 0.1, 0.25, 0.5, 1.0, 2.0, 4.0, 8.0])
TARGET_STEADY, TARGET_HARMONIC, TARGET_LOOKUP = 1.0, 3.0, 20.0  # s, s, µs
LOADS = np.geomspace(50.0, 4000.0, 2000)
STEPS = 20


def seconds(work: Callable[[], object]) -> float:
    """Least processor time of the work."""
    best = float("inf")
    for _ in range(REPEATS):
        began = time.process_time()
        work()
        best = min(best, time.process_time() - began)
    return best


def measure() -> dict[str, float | int]:
    """Seconds of each."""
    result: dict[str, float | int] = {}
    for n in NODES:
        found = ehl.steady(100, 10, grid=n)
        alone = seconds(lambda n=n: ehl.steady(100, 10, grid=n))
        result[f"steady_{n}"] = round(alone, 3)
        result[f"steady_and_eight_frequencies_{n}"] = round(
            alone + seconds(lambda found=found: found.stiffness(OMEGA)), 3
        )
    result["target_steady_129"] = TARGET_STEADY
    result["target_steady_and_eight_frequencies_129"] = TARGET_HARMONIC
    result["automatic"] = round(seconds(lambda: ehl.steady(100, 10)), 3)
    many = seconds(lambda: [ehl.lookup(M, 10.0, 0.3) for M in LOADS])
    result["lookup_us"] = round(1e6 * many / len(LOADS), 1)
    result["target_lookup_us"] = TARGET_LOOKUP
    small = ehl.steady(100, 10, grid=65)
    marched = seconds(lambda: ehl.march(small, dt=0.1, steps=STEPS, mass=1.0, velocity=1e-3))
    result["step_in_time_65"] = round(marched / STEPS, 4)
    return result


if __name__ == "__main__":
    sys.exit(printed(__doc__, measure))
