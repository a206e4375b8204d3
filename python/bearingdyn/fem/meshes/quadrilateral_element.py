"""The 9-node quadrilateral: its shape functions, products of Lagrange functions."""

from __future__ import annotations

import numpy as np

from bearingdyn.types import Array


def lagrange(x: Array) -> tuple[Array, Array]:
    """Lagrange functions of a quadrilateral's side, nodes −1, 0, 1, and their derivatives.

    Parameters
    ----------
    x
        (points,) places along the side, −1…1.

    Returns
    -------
    tuple of Array
        The functions and their derivatives, (points, 3) each.
    """
    N = np.stack([0.5 * x * (x - 1), 1 - x * x, 0.5 * x * (x + 1)], axis=-1)
    return N, np.stack([x - 0.5, -2 * x, x + 0.5], axis=-1)


def shape_functions(xi: Array, eta: Array) -> tuple[Array, Array, Array]:
    """N, ∂N/∂ξ, ∂N/∂η of the 9-node quadrilateral at points (q,), (q, 9) each; nodes as in RevolutionMesh."""
    (a, da), (b, db) = lagrange(xi), lagrange(eta)
    return tuple((f[:, :, None] * g[:, None, :]).reshape(-1, 9) for f, g in ((a, b), (da, b), (a, db)))  # type: ignore[return-value]
