"""Spheres that radiate: their meshes, and what they radiate by Legendre's polynomials."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.special import eval_legendre, spherical_jn, spherical_yn

DENSITY, SPEED = 1.204, 343.2
Array = NDArray[np.float64]


def sphere(
    n: int, radius: float = 1.0, centre: tuple[float, float, float] = (0.0, 0.0, 0.0)
) -> tuple[Array, Array]:
    """An octahedron cut into 8 n² triangles and blown up to a ball's volume: points and faces."""
    points: list[Array] = []
    index: dict[tuple[float, ...], int] = {}

    def at(x: Array) -> int:
        key = tuple(np.round(x, 9) + 0.0)
        if key not in index:
            index[key] = len(points)
            points.append(x)
        return index[key]

    faces = []
    for sx in (1, -1):
        for sy in (1, -1):
            for sz in (1, -1):
                a, b, c = np.diag([sx, sy, sz]).astype(float)
                if sx * sy * sz < 0:
                    b, c = c, b
                grid = {}
                for i in range(n + 1):
                    for j in range(n + 1 - i):
                        # even in angle, not in chord: triangles of a size
                        w = np.sin(0.5 * np.pi * np.array([n - i - j, i, j]) / n)
                        x = w[0] * a + w[1] * b + w[2] * c
                        grid[i, j] = at(x / np.linalg.norm(x))
                for i in range(n):
                    for j in range(n - i):
                        faces.append((grid[i, j], grid[i + 1, j], grid[i, j + 1]))
                        if i + j < n - 1:
                            faces.append((grid[i + 1, j], grid[i + 1, j + 1], grid[i, j + 1]))
    p, f = np.array(points), np.array(faces)
    x = p[f]
    volume = np.einsum("fi,fi->", x[:, 0], np.cross(x[:, 1], x[:, 2])) / 6
    return p * (4 * np.pi / 3 / volume) ** (1 / 3) * radius + np.array(centre), f


def shapes(
    points: Array, faces: Array, centre: tuple[float, float, float] = (0.0, 0.0, 0.0), radius: float = 1.0
) -> Array:
    """Normal velocity (m, 3): pulsating, moving along y as a rigid body, and P₂(y); the sphere's flux."""
    x = points[faces] - np.array(centre)
    cross = np.cross(x[:, 1] - x[:, 0], x[:, 2] - x[:, 0])
    area = 0.5 * np.linalg.norm(cross, axis=1)
    u = x.mean(axis=1) / np.linalg.norm(x.mean(axis=1), axis=1)[:, None]
    flux = 4 * np.pi * radius**2 / area.sum()
    ones = np.ones(len(faces)) * flux
    return np.stack([ones, 0.5 * cross[:, 1] / area, eval_legendre(2, u[:, 1]) * ones], axis=1)


def impedance(order: int, ka: float) -> complex:
    """Pressure over normal velocity of a sphere that moves as P_order, Pa s/m; time as exp(+iωt)."""

    def hankel(slope: bool) -> complex:
        return complex(spherical_jn(order, ka, slope) - 1j * spherical_yn(order, ka, slope))

    return -1j * DENSITY * SPEED * hankel(False) / hankel(True)


def power(order: int, ka: float, radius: float = 1.0) -> float:
    """Of a sphere that moves as P_order with an amplitude of 1 m/s, W."""
    return 0.5 * impedance(order, ka).real * 4 * np.pi * radius**2 / (2 * order + 1)


def decibels(a: float, b: float) -> float:
    return float(10 * np.log10(a / b))
