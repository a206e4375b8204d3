"""A small model with everything in it, for the tests of the binding."""

from __future__ import annotations

from typing import Any

import numpy as np

from bearingdyn import core
from bearingdyn.bearing import BallBearing, TabulatedDamping

N = 6
BEARING = BallBearing(
    Z=7,
    Dw=11.5e-3,
    Dpw=43.5e-3,
    fi=0.52,
    fo=0.53,
    clearance=5e-6,
    damping=TabulatedDamping([0.0, 1e-5], [10.0, 30.0]),
)
KERNEL: dict[str, Any] = BEARING.kernel().packed()
CASTABLE = (np.float64, np.float32, np.int32, np.int64)


def arguments(seed: int = 1) -> dict[str, Any]:
    """Good arguments of Model: two blocks, a layer, a bearing, every load and channel."""
    rng = np.random.default_rng(seed)
    M, C, G, K, zero = np.eye(N), np.zeros((N, N)), np.zeros((N, N)), np.zeros((N, N)), np.zeros((N, N))
    w = 2 * np.pi * np.geomspace(60.0, 4e3, N)
    K, C = np.diag(w**2), np.diag(0.05 * w)
    G[0, 1], G[1, 0] = 0.1, -0.1
    L = np.zeros((N, 2))
    L[2:5] = rng.standard_normal((3, 2))
    B = 0.5 * rng.standard_normal((5, N))
    p = 100.0 * rng.standard_normal((2, N))
    return {
        "M": M,
        "C": C,
        "G": G,
        "K": K,
        "N": zero,
        "layers": [(L, np.array([1e5, 1e6]), np.array([1e-3, 1e-5]))],
        "bearings": [(KERNEL, B)],
        "loads": [
            (0, 0.0, p[0], p[1], np.zeros(0), np.zeros(0)),
            (1, 5e3, p[0], p[1], np.zeros(0), np.zeros(0)),
            (2, 0.0, 1e-6 * p[0], 1e-6 * p[1], np.zeros(0), np.zeros(0)),
            (3, 0.0, p[0], p[1], np.array([0.0, 1e-3]), np.array([0.0, 1.0])),
        ],
        "channels": [(k, np.eye(N)[k % N], 0, 0) for k in range(6)],
    }


def model(**changes: Any) -> core.Model:
    return core.Model(**(arguments() | changes))


def at_rest(m: core.Model) -> np.ndarray:
    return m.state(0.0, np.zeros(N), np.zeros(N))


def stepping(dt: float, speed: Any = 0.0, audit: bool = False, **scheme: Any) -> core.Stepping:
    return core.Stepping(dt, speed=speed, audit=audit, scheme=core.Scheme(**scheme))


SCHEME = stepping(dt=2.5e-6, speed=300.0)


def harmonic(m: core.Model, **changes: Any) -> np.ndarray:
    a = {
        "omega": np.array([0.0, 10.0, 2e3]),
        "modulus": np.full((3, 1), 1e6 + 1e5j),
        "bearing_K": 1e7 * np.eye(5),
        "bearing_C": 30.0 * np.eye(5),
        "force": np.eye(N)[:2],
        "row": np.eye(N)[:3],
    }
    return core.harmonic(m, **(a | changes))


def replaced(array: Any, at: Any, value: float) -> np.ndarray:
    array = np.array(array, dtype=float)
    array[at] = value
    return array
