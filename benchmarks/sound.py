"""Sound: one frequency of 2048 panels, a response once the radiation is known, a whole band, and memory.

python benchmarks/sound.py [--json]     (pip install bempp-cl numba; absent: named and left out)

one frequency   a sphere of 2048 flat triangles that moves in 60 shapes, CPU seconds
200 frequencies what a study pays for a response of 120 coordinates once R is known
band            R of the demo's pedestal from 100 to 6000 Hz, panels and frequencies chosen by the program
peer            the same sphere in bempp-cl, which assembles the same equation of Burton and Miller on the
                same functions: CPU seconds of one frequency, its compilation left out, and by how much the
                power of each program departs from the closed form. bempp-cl's power is that of its pressure.

Exits 1 where a power departs by more than the tolerances below.
"""

from __future__ import annotations

import argparse
import contextlib
import importlib.util
import io
import json
import math
import resource
import sys
import time
from pathlib import Path
from typing import Any

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "tests"))

from bearingdyn.examples.paper import paper_pedestal
from bearingdyn.sound import TriangleSurface, solve
from bearingdyn.sound.radiators import Radiators
from bearingdyn.sound.resistance import Octave, octaves, solved_octave
from spheres import DENSITY, SPEED, decibels, power, shapes, sphere

MOTIONS = ("pulsating", "oscillating", "quadrupole")
# the quadrupole on flat triangles of the sphere's volume, ours and theirs
TOLERANCE, PEER_TOLERANCE = 0.05, 0.1
WAVES = (0.5, 1.0, math.pi)  # ka of the comparison; the last is a resonance of the inside
ABSENT = "bempp-cl is not installed (pip install bempp-cl numba)"


def octave_of(n: int, nodes: int) -> Octave:
    """An octave of made resistances, to be interpolated in."""
    half = np.random.default_rng(1).standard_normal((nodes, n, n))
    x = 750.0 - 250.0 * np.cos(np.pi * np.arange(nodes) / (nodes - 1))
    R = half @ half.transpose(0, 2, 1)
    return Octave(500.0, 1000.0, x, R, np.zeros((nodes, 0, n)), 0.01, 2048)


def band(low: float = 100.0, high: float = 6000.0) -> dict[str, Any]:
    """R of one pedestal over a band: seconds of clock and CPU, panels and frequencies."""
    skin = paper_pedestal(0.078).superelement().skin
    assert skin is not None
    bodies = Radiators([skin], np.zeros((1, 3)))
    clock, cpu = time.perf_counter(), time.process_time()
    found = [
        solved_octave(bodies, a, b, density=DENSITY, sound_speed=SPEED, microphones=np.zeros((0, 3)))
        for a, b in octaves(low, high)
    ]
    return {
        "band_s": round(time.perf_counter() - clock, 1),
        "band_cpu_s": round(time.process_time() - cpu, 1),
        "band_panels": max(one.panels for one in found),
        "band_frequencies": sum(len(one.nodes) for one in found),
    }


def ours(points: np.ndarray, faces: np.ndarray) -> dict[str, Any]:
    """Errors of the power, dB, by ka and motion."""
    surface, v = TriangleSurface(points, faces), shapes(points, faces)
    found = {}
    for ka in WAVES:
        R = solve(surface, v, ka * SPEED / (2 * math.pi), coarse=True).resistance
        found[f"{ka:.3g}"] = [decibels(0.5 * R[j, j], power(j, ka)) for j in range(3)]
    return found


def theirs(points: np.ndarray, faces: np.ndarray) -> dict[str, Any] | None:
    """The same by bempp-cl, and the CPU seconds of its quickest frequency; None where it is absent."""
    if importlib.util.find_spec("bempp_cl") is None or importlib.util.find_spec("numba") is None:
        return None
    with contextlib.redirect_stdout(io.StringIO()):
        import bempp_cl.api as bempp
    op, identity = bempp.operators.boundary.helmholtz, bempp.operators.boundary.sparse.identity
    grid = bempp.Grid(points.T.copy(), faces.T.astype(np.uint32))
    p1, p0 = bempp.function_space(grid, "P", 1), bempp.function_space(grid, "DP", 0)
    surface, v = TriangleSurface(points, faces), shapes(points, faces)
    errors, seconds = {}, []
    for ka in (WAVES[0], *WAVES):  # the first compiles
        began = time.process_time()
        alpha = 1j / ka  # time as exp(-iωt)
        left = (
            0.5 * identity(p1, p1, p1)
            - op.double_layer(p1, p1, p1, ka)
            + alpha * op.hypersingular(p1, p1, p1, ka)
        )
        right = op.single_layer(p0, p1, p1, ka) + alpha * (
            0.5 * identity(p0, p1, p1) + op.adjoint_double_layer(p0, p1, p1, ka)
        )
        A, B = (bempp.as_matrix(each.weak_form()) for each in (left, right))
        pressure = np.asarray(np.linalg.solve(A, -B @ (1j * ka * DENSITY * SPEED * v)))
        seconds.append(time.process_time() - began)
        work = surface.areas[:, None] * v * pressure[faces].mean(axis=1).real
        errors[f"{ka:.3g}"] = [decibels(0.5 * work[:, j].sum(), power(j, ka)) for j in range(3)]
    return {"errors": errors, "cpu_s": min(seconds[1:]), "version": bempp.__version__}


def figures() -> dict[str, Any]:
    """Every figure, by name."""
    points, faces = sphere(16)  # 2048 panels
    surface = TriangleSurface(points, faces)
    motions = np.random.default_rng(0).standard_normal((len(faces), 60))
    began = time.process_time()
    solve(surface, motions, 100.0, coarse=True)
    one = time.process_time() - began

    octave = octave_of(120, 17)
    f = np.linspace(500.0, 1000.0, 200)
    v = np.random.default_rng(2).standard_normal((200, 120)) + 0j
    many = math.inf
    for _ in range(5):
        began = time.process_time()
        octave.power(f, v)
        many = min(many, time.process_time() - began)
    found: dict[str, Any] = {
        "panels": len(faces),
        "one_frequency_cpu_s": round(one, 3),
        "response_of_200_frequencies_cpu_s": round(many, 4),
        **band(),
        "peak_memory_GB": round(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 2**20, 3),
        "errors_dB": ours(points, faces),
    }
    peer = theirs(points, faces)
    if peer is None:
        return found | {"bempp": ABSENT}
    return found | {
        "bempp": peer["version"],
        "bempp_one_frequency_cpu_s": round(peer["cpu_s"], 2),
        "bempp_errors_dB": peer["errors"],
    }


def largest(errors: dict[str, list[float]]) -> float:
    """Largest size of all errors, dB."""
    return max(abs(e) for each in errors.values() for e in each)


def main() -> int:
    """Print the figures; 1 where a power is wrong."""
    as_written = argparse.RawDescriptionHelpFormatter
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=as_written)
    parser.add_argument("--json", action="store_true")
    options, made = parser.parse_args(), figures()
    if options.json:
        print(json.dumps(made))
    else:
        for name, value in made.items():
            if isinstance(value, dict):
                for ka, errors in value.items():
                    said = ", ".join(f"{m} {e:+.4f}" for m, e in zip(MOTIONS, errors, strict=True))
                    print(f"{name.replace('_', ' ') + ' at ka ' + ka:32} {said}")
            else:
                print(f"{name.replace('_', ' '):32} {value}")
    wrong = largest(made["errors_dB"]) > TOLERANCE
    return int(wrong or largest(made.get("bempp_errors_dB", {"": [0.0]})) > PEER_TOLERANCE)


if __name__ == "__main__":
    sys.exit(main())
