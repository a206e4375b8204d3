"""Faces of a solid: their normal motion, from which sound is radiated."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import scipy.sparse
from numpy.typing import NDArray

from bearingdyn.fem.solid import serendipity_faces

Float = NDArray[np.float64]


def normal_motion(mesh: Any, on: Callable[[Float], NDArray[np.bool_]]) -> tuple[Any, Float]:
    """Outward normal displacement at the integration points of faces, and their weights.

    mesh: as for `assemble_solid`, bricks. on: which faces, from the middles (m, 3) of all boundary faces.

    Returns rows (q, 3n) sparse on the coordinates of `assemble_solid`, and weights (q,), m²: Σ weights·v² of
    v = rows @ u̇ is ∫ v_n² dA.
    """
    value, normals, places, weights, nodes, n = serendipity_faces(mesh)
    chosen = np.flatnonzero(on(places.mean(axis=1)))
    points = weights.shape[1]
    row = (np.arange(chosen.size)[:, None] * points + np.arange(points))[:, :, None, None]
    column = 3 * nodes[chosen][:, None, :, None] + np.arange(3)
    entry = value[chosen].transpose(0, 2, 1)[..., None] * normals[chosen][:, :, None, :]
    shape = (chosen.size * points, 3 * n)
    index = (np.broadcast_to(row, entry.shape).ravel(), np.broadcast_to(column, entry.shape).ravel())
    return scipy.sparse.csr_matrix((entry.ravel(), index), shape=shape), weights[chosen].ravel()
