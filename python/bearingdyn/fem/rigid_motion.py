"""Rigid motions of points, the inertia of a body in them, and what a stiffness makes of them."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from bearingdyn.types import Array


def rigid_motion(points: ArrayLike, reference: ArrayLike = (0.0, 0.0, 0.0)) -> Array:
    """Displacement of points that move rigidly with a reference point: u = d + θ × (p - reference).

    Parameters
    ----------
    points
        (n, 3) positions, m.
    reference
        (3,) position of the reference point, m.

    Returns
    -------
    (3 n, 6) array
        Columns: unit x, y, z, θx, θy, θz of the reference point. Rows: x, y, z of each point in turn.
    """
    p = np.atleast_2d(np.asarray(points, dtype=np.float64)) - np.asarray(reference, dtype=np.float64)
    R = np.zeros((len(p), 3, 6))
    R[:, [0, 1, 2], [0, 1, 2]] = 1.0
    R[:, 0, 4], R[:, 0, 5] = p[:, 2], -p[:, 1]
    R[:, 1, 3], R[:, 1, 5] = -p[:, 2], p[:, 0]
    R[:, 2, 3], R[:, 2, 4] = p[:, 1], -p[:, 0]
    return R.reshape(-1, 6)


def rigid_transfer(positions: ArrayLike, reference: ArrayLike = (0.0, 0.0, 0.0)) -> Array:
    """Motion (6 n, 6) of six-coordinate points that move rigidly with a reference point.

    Parameters
    ----------
    positions
        (n, 3) positions, m.
    reference
        (3,) position of the reference point, m; it has the coordinates x, y, z, θx, θy, θz, as each point
        has.
    """
    p = np.atleast_2d(np.asarray(positions, dtype=np.float64))
    R = np.zeros((len(p), 6, 6))
    R[:, :3] = rigid_motion(p, reference).reshape(-1, 3, 6)
    R[:, [3, 4, 5], [3, 4, 5]] = 1.0
    return R.reshape(-1, 6)


def rigid_body_inertia(M: Any, R: Array) -> Array:
    """Mass matrix of rigid motions by finite elements: mass, first moments, inertia about the reference.

    Parameters
    ----------
    M
        Mass (n, n), kg.
    R
        Rigid motions (n, 6), as rigid_motion or rigid_transfer gives them.

    Returns
    -------
    Array
        (6, 6); kg, kg m, kg m².
    """
    return np.asarray(R.T @ (M @ R))


def rigid_body_residual(K: Any, R: Array) -> float:
    """Rigid motion against a stiffness: how much it resists, the largest of K R over the largest of |K| |R|.

    Parameters
    ----------
    K
        Stiffness (n, n), N/m.
    R
        Rigid motions (n, k).

    Returns
    -------
    float
        Round-off, unless K resists rigid motion.
    """
    scale = float(np.max(abs(K) @ np.abs(R)))
    return float(np.max(np.abs(K @ R))) / scale if scale > 0 else 0.0
