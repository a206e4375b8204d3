"""The operators of csrc/radiation.h for triangles that do not touch, by Gauss points on each."""

from __future__ import annotations

import numpy as np
from numpy.polynomial.legendre import leggauss
from numpy.typing import NDArray


def operators(
    points: NDArray[np.float64], faces: NDArray[np.int32], k: float, n: int = 12
) -> dict[str, NDArray[np.complex128]]:
    """V, V1, Kt, K, D; the pairs that share a corner are left out."""
    g, w = leggauss(n)
    g, w = 0.5 * (g + 1), 0.5 * w
    phi = np.array([[1 - u, u - u * v, u * v] for u in g for v in g])
    weight = np.array([2 * u * a * b for u, a in zip(g, w, strict=True) for b in w])
    m, p = len(faces), len(points)
    out = {
        "V": np.zeros((m, m), dtype=complex),
        "V1": np.zeros((p, m), dtype=complex),
        "Kt": np.zeros((p, m), dtype=complex),
        "K": np.zeros((p, p), dtype=complex),
        "D": np.zeros((p, p), dtype=complex),
    }
    corners = points[faces]
    cross = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    area = 0.5 * np.linalg.norm(cross, axis=1)
    normal = cross / (2 * area[:, None])
    gradient = np.stack(
        [np.cross(normal, corners[:, (a + 2) % 3] - corners[:, (a + 1) % 3]) for a in range(3)], axis=1
    ) / (2 * area[:, None, None])
    curl = np.cross(normal[:, None], gradient)
    for t in range(m):
        for s in range(m):
            if set(faces[t]) & set(faces[s]):
                continue
            d = (phi @ corners[s])[None] - (phi @ corners[t])[:, None]
            r = np.linalg.norm(d, axis=2)
            both = np.outer(weight, weight) * area[t] * area[s]
            G = both * np.exp(-1j * k * r) / (4 * np.pi * r)
            slope = -(1j * k + 1 / r) * G / r
            one = phi.T @ G @ phi
            along_y = phi.T @ (slope * (d @ normal[s])) @ phi
            along_x = phi.T @ (-slope * (d @ normal[t])) @ phi
            out["V"][t, s] = one.sum()
            out["V1"][faces[t], s] += one.sum(axis=1)
            out["Kt"][faces[t], s] += along_x.sum(axis=1)
            at = np.ix_(faces[t], faces[s])
            out["K"][at] += along_y
            out["D"][at] += curl[t] @ curl[s].T * one.sum() - k**2 * (normal[t] @ normal[s]) * one
    return out
