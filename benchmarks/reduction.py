"""What reducing a solid costs: blocks of steel to two rigid faces (12 coordinates) and 20 modes.

python benchmarks/reduction.py [--json] [--sizes 10 30 100]

Bricks of 20 nodes, twice as long as wide and high, some 10, 30 and 100 thousand degrees of freedom
(--sizes, in thousands). Each size runs in a process of its own: seconds from the assembled matrices to the
superelement (on the clock, and of computing), its greatest memory, and the exponents of growth of computing
and memory from the first size to the last.
"""

from __future__ import annotations

import argparse
import json
import math
import resource
import subprocess
import sys
import time
from typing import Any

import numpy as np
import scipy

from bearingdyn import cms
from bearingdyn.fem import assemble_solid, box_mesh, rigid_motion
from bearingdyn.material import STEEL

SIZES = (10, 30, 100)  # thousands of degrees of freedom
MODES = 20


def block(thousands: int) -> cms.FullModel:
    """A block of 0.1 × 0.1 × 0.2 m, rigid at both ends, of about so many thousand coordinates."""
    wanted = 1000.0 * thousands / 3.0  # nodes: m (n+1)(4n+2) + (n+1)(3n+1) for n × n × m elements
    n = max(2, round((wanted / 8.4) ** (1 / 3)))
    m = max(2, round((wanted - (3 * n + 1) * (n + 1)) / ((4 * n + 2) * (n + 1))))
    x, z = np.linspace(0.0, 0.1, n + 1), np.linspace(0.0, 0.2, m + 1)
    mesh = box_mesh(x, x, z, "hex20")
    solid = assemble_solid(mesh)
    p = np.asarray(mesh.points)
    faces = {}
    for name, place in (("near", 0.0), ("far", 0.2)):
        nodes = np.flatnonzero(np.abs(p[:, 2] - place) < 1e-9)
        reference = np.array([0.05, 0.05, place])
        dofs = (3 * nodes[:, None] + np.arange(3)).ravel()
        faces[name] = cms.RigidInterface(dofs, rigid_motion(p[nodes], reference), reference)
    return cms.FullModel(M=STEEL.density * solid.mass, K=solid.stiffness(STEEL), interfaces=faces)


def measure(thousands: int) -> dict[str, Any]:
    """One size, in this process."""
    began = time.perf_counter()
    model = block(thousands)
    assembled = time.perf_counter()
    cpu = time.process_time()
    before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    element = cms.reduce(model, n_modes=MODES, inertia=0)
    seconds, cpu = time.perf_counter() - assembled, time.process_time() - cpu
    lowest = scipy.linalg.eigh(element.K, element.M, eigvals_only=True)[6]
    return {
        "degrees_of_freedom": model.n,
        "coordinates": element.n,
        "assembly_s": round(assembled - began, 2),
        "reduction_s": round(seconds, 2),
        "cpu_s": round(cpu, 2),
        "peak_MB": round(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024),
        "assembled_MB": round(before / 1024),
        "first_free_mode_Hz": round(math.sqrt(lowest) / (2 * math.pi), 1),
    }


def main() -> int:
    """Measure and print."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--json", action="store_true", help="print one JSON object")
    parser.add_argument("--sizes", nargs="+", type=int, default=SIZES, help="thousands of coordinates")
    parser.add_argument("--one", type=int, help=argparse.SUPPRESS)
    options = parser.parse_args()
    if options.one:
        print(json.dumps(measure(options.one)))
        return 0
    runs = []
    for size in options.sizes:
        command = [sys.executable, __file__, "--one", str(size)]
        done = subprocess.run(command, capture_output=True, text=True, check=False)
        if done.returncode:
            print(done.stderr, file=sys.stderr)
            return done.returncode
        runs.append(json.loads(done.stdout))
    result: dict[str, Any] = {"runs": runs}
    if len(runs) > 1:
        n, t, m = ([run[key] for run in runs] for key in ("degrees_of_freedom", "cpu_s", "peak_MB"))
        result["time_exponent"] = round(math.log(t[-1] / t[0]) / math.log(n[-1] / n[0]), 2)
        result["memory_exponent"] = round(math.log(m[-1] / m[0]) / math.log(n[-1] / n[0]), 2)
    if options.json:
        print(json.dumps(result))
    else:
        for run in runs:
            print("  ".join(f"{key} {value}" for key, value in run.items()))
        print({key: value for key, value in result.items() if key != "runs"})
    return 0


if __name__ == "__main__":
    sys.exit(main())
