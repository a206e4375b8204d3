"""Memory of a long march: 10 million steps of a rotor on two bearings, 12 channels, every 100th step kept.

python benchmarks/memory.py [--json] [--steps 10000000]

The march runs in a process of its own, whose largest resident set is read when it has ended. Beside it, what
a model of the core keeps over what M, C, G, K and N hold, block by block: of the demo's layered motor, and of
2000 coordinates that nothing couples.
"""

from __future__ import annotations

import argparse
import json
import resource
import subprocess
import sys
import time
from pathlib import Path

import numpy as np

STEPS, DECIMATE = 10_000_000, 100
LIMIT = 300.0  # MB
# What a model may keep over its matrices. The motor's loads, bearings and layers are small beside its blocks
# of 37 coordinates; a block of one has 40 bytes of matrices, and as many that say where it is.
KEPT_LIMITS = {"motor": 1.5, "2000 blocks of one": 3.0}


def march(steps: int) -> dict[str, float | int]:
    """The march, and the memory of the process that made it."""
    import bearingdyn as bd

    shaft = bd.Shaft(
        [bd.Section(0.5, 0.03)],
        seats={"left": 0.05, "right": 0.45},
        points={"disc": 0.25},
        discs=[bd.Disc(0.25, 4.0, 0.008, 0.014)],
        damping=0.005,
        f_max=5e3,
    )
    balls = bd.BallBearing(Z=8, Dw=9e-3, Dpw=40e-3, fi=0.52, fo=0.53, contact_angle=0.26, damping=100.0)
    app = bd.Application()
    app.add("shaft", shaft)
    for side in ("left", "right"):
        app.bearing(side, balls, inner=f"shaft.{side}", outer="ground")
    app.load("shaft.disc", (0.0, -1000.0, 600.0, 0.0, 0.0, 0.0))
    record = [f"shaft.{place}.{axis}" for place in ("left", "disc", "right") for axis in "xyz"]
    record += ["left.force.y", "left.ball1", "left.loaded"]
    eq = bd.equilibrium(app)
    before, began = _peak(), time.perf_counter()
    result = bd.transient(eq, speed=500.0, dt=2.5e-6, steps=steps, decimate=DECIMATE, record=record)
    kept = result["record"]
    return {
        "steps": steps,
        "rows": kept.sizes["time"],
        "channels": kept.sizes["channel"],
        "record_mb": round(kept.nbytes / 1e6, 1),
        "peak_mb_before_the_march": round(before, 1),
        "peak_mb": round(_peak(), 1),
        "limit_mb": LIMIT,
        "seconds": round(time.perf_counter() - began, 2),
    }


def kept_over_matrices() -> dict[str, float]:
    """Bytes that a model keeps over those of M, C, G, K and N within its blocks."""
    from scipy.sparse.csgraph import connected_components

    import bearingdyn as bd
    from bearingdyn import core

    sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "examples"))
    import motor

    low, _, _ = motor.rubber()
    system = bd.equilibrium(motor.motor(motor.designs(low)[2], motor.RADIAL)).system
    coupled = sum(
        abs(A) for A in (system.M, system.viscous(), system.G, system.stiffness("relaxed"), system.N)
    )
    coupled += sum(abs(t.L) @ abs(t.L.T) for t in system.layers)
    sizes = np.bincount(connected_components(coupled)[1])
    model = system.model([(core.CHANNEL_KINDS["displacement"], system.row("shaft.end.y"), 0, 0)])
    if model.blocks != len(sizes):
        raise RuntimeError(f"the core found {model.blocks} blocks, and SciPy {len(sizes)}")

    one, zero = np.eye(2000), np.zeros((2000, 2000))
    single = core.Model(one, zero, zero, one, zero, [], [], [], [])
    return {
        "motor": model.nbytes / (5 * 8 * int(np.sum(sizes**2))),
        "2000 blocks of one": single.nbytes / (5 * 8 * 2000),
    }


def _peak() -> float:
    """Largest resident set so far, MB; macOS counts in bytes, Linux in kB."""
    unit = 1e6 if sys.platform == "darwin" else 1e3
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / unit


def main() -> int:
    """Measure in a subprocess and print; 1 above a limit."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--json", action="store_true", help="print one JSON object")
    parser.add_argument("--steps", type=int, default=STEPS)
    parser.add_argument("--inside", action="store_true", help=argparse.SUPPRESS)
    options = parser.parse_args()
    if options.inside:
        print(json.dumps(march(options.steps)))
        return 0
    command = [sys.executable, __file__, "--inside", "--steps", str(options.steps)]
    answer = subprocess.run(command, check=True, capture_output=True, text=True).stdout
    result = json.loads(answer)
    kept = kept_over_matrices()
    result |= {f"kept over matrices, {name}": round(ratio, 2) for name, ratio in kept.items()}
    print(json.dumps(result) if options.json else "\n".join(f"{k:>38}: {v}" for k, v in result.items()))
    within = all(kept[name] <= limit for name, limit in KEPT_LIMITS.items())
    return 0 if result["peak_mb"] <= LIMIT and within else 1


if __name__ == "__main__":
    sys.exit(main())
