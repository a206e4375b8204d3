"""What the harmonic response of the demo's layered motor costs: 2000 frequencies, 12 outputs, on one core.

python benchmarks/harmonic.py [--json] [--cc gcc]

The time is that of `bd.frequency_response` as a user calls it, from an equilibrium to a Dataset, the least of
many; and a line over 500 to 8000 frequencies with its exponent. Beside it, by turns in the same run, the bare
loop of harmonic.c: the same blocks in their own modes, damping between modes left out, layers and bearings by
their low rank, one frequency after another, with everything that does not depend on frequency prepared.
"""

from __future__ import annotations

import argparse
import json
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "examples"))

import motor

import bearingdyn as bd
from bearingdyn.analysis.inputs_outputs import Input, Output, requested

FREQUENCIES, TARGET = 2000, 0.2  # s
LINE = [500, 1000, 2000, 4000, 8000]
REPEATS, ROUNDS = 10, 3
RATIO = 2.5  # to the bare loop
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


def bare_input(eq: bd.Equilibrium, frequency: np.ndarray) -> np.ndarray:
    """What harmonic.c reads, one array of doubles."""
    system, omega = eq.system, 2 * np.pi * frequency
    squares, T = system.basis([0.0] * len(system.layers))
    C = np.diag(T.T @ system.C @ T)
    force = np.array([Input.of(system, motor.INPUT).force])
    rows = requested([Output.of(system, name) for name in OUTPUTS], system.n)
    blocks = system.blocks()
    m = len(system.B)
    head = [frequency.size, len(blocks), m, len(force), len(rows)]
    parts = [np.array(head, float), omega, eq.bearing_K.ravel(), eq.bearing_C.ravel()]
    for block in blocks:
        layers = [layer for layer in system.layers if np.abs(layer.L[block]).max() > 0]
        U = T[:, block].T @ np.hstack([system.B.T, rows.T, force.T])
        which = np.flatnonzero(np.abs(U).max(axis=0) > 0)
        own = [T[:, block].T @ layer.L for layer in layers]
        rank = sum(columns.shape[1] for columns in own)
        modulus = layers[0].material.complex_modulus(omega) if layers else np.ones(omega.size)
        pairs = np.column_stack([modulus.real, modulus.imag])
        sizes = np.array([len(block), rank, rank + len(which)], float)
        places = np.concatenate([np.zeros(rank), which])
        parts += [sizes, places, squares[block], C[block], pairs.ravel()]
        parts += [np.hstack([*own, U[:, which]]).ravel()]
    return np.concatenate(parts)


def measure(compiler: str) -> dict[str, float | int | list[int] | list[float]]:
    """Seconds, microseconds a frequency, the ratio to the bare loop, and the line."""
    low, _, _ = motor.rubber()
    eq = bd.equilibrium(motor.motor(motor.designs(low)[2]))
    seconds(eq, [100], 1)  # the first call imports xarray
    frequency = np.linspace(10.0, 6e3, FREQUENCIES)
    with tempfile.TemporaryDirectory() as folder:
        program, given, answer = (str(Path(folder) / name) for name in ("loop", "in", "out"))
        source = str(Path(__file__).with_suffix(".c"))
        flags = ["-std=c11", "-D_POSIX_C_SOURCE=200809L", "-O3", "-march=native", "-fcx-limited-range"]
        subprocess.run([compiler, *flags, source, "-lm", "-o", program], check=True)
        bare_input(eq, frequency).tofile(given)
        ours, bare = float("inf"), float("inf")
        for _ in range(ROUNDS):  # by turns, so that both meet the same machine
            out = subprocess.run([program, given, answer], check=True, capture_output=True, text=True)
            bare = min(bare, float(out.stdout))
            ours = min(ours, *seconds(eq, [FREQUENCIES], REPEATS))
        found = np.fromfile(answer, np.complex128)
    exact = bd.frequency_response(eq, frequency, [motor.INPUT], OUTPUTS)["response"].values.ravel()
    line = seconds(eq, LINE, REPEATS)
    return {
        "seconds": round(ours, 4),
        "target_seconds": TARGET,
        "us_per_frequency": round(1e6 * ours / FREQUENCIES, 2),
        "bare_us_per_frequency": round(1e6 * bare / FREQUENCIES, 2),
        "ratio": round(ours / bare, 3),
        "target_ratio": RATIO,
        # worth of the damping between modes, which the loop leaves out; and that it solves this very motor
        "bare_rms_difference": round(float(np.linalg.norm(found - exact) / np.linalg.norm(exact)), 4),
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
    parser.add_argument("--cc", default="cc", help="C compiler")
    options = parser.parse_args()
    result = measure(options.cc)
    print(json.dumps(result) if options.json else "\n".join(f"{k:>20}: {v}" for k, v in result.items()))
    return 0


if __name__ == "__main__":
    sys.exit(main())
