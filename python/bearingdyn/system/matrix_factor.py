"""The factor of a positive semi-definite matrix, of its own rank."""

from __future__ import annotations

import numpy as np

from bearingdyn.types import Array

# below this share of the largest (scaled) eigenvalue a matrix has none: rigid motions of a deviatoric one
RANK = 1e-11


def factor(A: Array) -> Array:
    """Factor L of a positive semi-definite matrix, A = L Lᵀ.

    Parameters
    ----------
    A
        (n, n), symmetric.

    Returns
    -------
    Array
        (n, rank); directions within round-off are left out.
    """
    scale = np.sqrt(np.maximum(np.diag(A), 0.0))
    scale[scale == 0.0] = 1.0
    values, vectors = np.linalg.eigh(A / np.outer(scale, scale))
    keep = values > RANK * values[-1]
    return np.asarray(scale[:, None] * vectors[:, keep] * np.sqrt(values[keep]))
