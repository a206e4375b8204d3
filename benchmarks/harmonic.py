"""What the harmonic response of the demo's layered motor costs: 2000 frequencies, 12 outputs, on one core.

python benchmarks/harmonic.py [--json]

The time is that of `bd.frequency_response` as a user calls it, from an equilibrium to a Dataset, the least of
many; and a line over 500 to 8000 frequencies with its exponent.
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

FREQUENCIES, TARGET = 2000, 0.2  # s
LINE = [500, 1000, 2000, 4000, 8000]
REPEATS = 20
OUTPUTS = [
    f"{place}.{axis}"
    for place in ("shaft.end", "shaft.middle", "left_housing.top", "right_housing.top")
    for axis in "xyz"
]


def seconds(eq: bd.Equilibrium, counts: list[int], repeats: int) -> list[float]:
    """Least time of a response over 10 Hz to 6 kHz for each number of frequencies, taken in turn."""
    best = [float("inf")] * len(counts)
    for _ in range(repeats):
        for k, count in enumerate(counts):
            frequency = np.linspace(10.0, 6e3, count)
            began = time.perf_counter()
            bd.frequency_response(eq, frequency, [motor.INPUT], OUTPUTS)
            best[k] = min(best[k], time.perf_counter() - began)
    return best


def measure() -> dict[str, float | int | list[int] | list[float]]:
    """Seconds, microseconds a frequency, and the line."""
    low, _, _ = motor.rubber()
    eq = bd.equilibrium(motor.motor(motor.designs(low)[2]))
    seconds(eq, [100], 1)  # the first call imports xarray
    line = seconds(eq, LINE, REPEATS)
    at = line[LINE.index(FREQUENCIES)]
    return {
        "seconds": round(at, 4),
        "target_seconds": TARGET,
        "us_per_frequency": round(1e6 * at / FREQUENCIES, 2),
        "n_frequencies": FREQUENCIES,
        "n_outputs": len(OUTPUTS),
        "n_coordinates": eq.system.n,
        "line_frequencies": LINE,
        "line_seconds": [round(t, 4) for t in line],
        "exponent": round(float(np.polyfit(np.log(LINE), np.log(line), 1)[0]), 3),
    }


def main() -> int:
    """Measure and print."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--json", action="store_true", help="print one JSON object")
    options = parser.parse_args()
    result = measure()
    print(json.dumps(result) if options.json else "\n".join(f"{k:>20}: {v}" for k, v in result.items()))
    return 0


if __name__ == "__main__":
    sys.exit(main())
