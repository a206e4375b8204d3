"""Sound: one frequency of 2000 panels, a response after the radiation is known, and memory.

Run it as `python benchmarks/sound.py`, with --json for one line that programs read.
"""

from __future__ import annotations

import argparse
import json
import resource
import time

import numpy as np

from bearingdyn.sound import TriangleSurface, solve
from bearingdyn.sound.resistance import Octave


def octahedral_sphere(n: int) -> tuple[np.ndarray, np.ndarray]:
    """8 n² triangles of a unit sphere."""
    index: dict[tuple[float, ...], int] = {}
    points, faces = [], []

    def at(x: np.ndarray) -> int:
        key = tuple(np.round(x, 9) + 0.0)
        if key not in index:
            index[key] = len(points)
            points.append(x)
        return index[key]

    for signs in np.ndindex(2, 2, 2):
        a, b, c = np.diag(1.0 - 2.0 * np.array(signs))
        b, c = (b, c) if sum(signs) % 2 == 0 else (c, b)
        grid = {}
        for i in range(n + 1):
            for j in range(n + 1 - i):
                x = (n - i - j) * a + i * b + j * c
                grid[i, j] = at(x / np.linalg.norm(x))
        for i, j in grid:
            if i + j < n:
                faces.append((grid[i, j], grid[i + 1, j], grid[i, j + 1]))
            if i + j < n - 1:
                faces.append((grid[i + 1, j], grid[i + 1, j + 1], grid[i, j + 1]))
    return np.array(points), np.array(faces)


def figures() -> dict[str, object]:
    points, faces = octahedral_sphere(16)  # 2048 panels
    surface = TriangleSurface(points, faces)
    shapes = np.random.default_rng(0).standard_normal((len(faces), 60))
    began = time.process_time()
    solve(surface, shapes, 100.0, coarse=True)
    one = time.process_time() - began

    n, nodes = 120, 17
    half = np.random.default_rng(1).standard_normal((nodes, n, n))
    x = 750.0 - 250.0 * np.cos(np.pi * np.arange(nodes) / (nodes - 1))
    octave = Octave(
        500.0, 1000.0, x, half @ half.transpose(0, 2, 1), np.zeros((nodes, 0, n)), 0.01, len(faces)
    )
    f = np.linspace(500.0, 1000.0, 200)
    v = np.random.default_rng(2).standard_normal((200, n)) + 0j
    began = time.perf_counter()
    octave.power(f, v)
    many = time.perf_counter() - began
    return {
        "panels": len(faces),
        "one_frequency_cpu_s": round(one, 3),
        "response_of_200_frequencies_s": round(many, 4),
        "peak_memory_GB": round(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 2**20, 3),
    }


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--json", action="store_true")
    made = figures()
    if parser.parse_args().json:
        print(json.dumps(made))
    else:
        for name, value in made.items():
            print(f"{name.replace('_', ' '):32} {value}")
