"""The factor of a positive semi-definite matrix, of its own rank."""

from __future__ import annotations

import numpy as np

from bearingdyn.cms import coupled_blocks
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
        (n, rank); directions within round-off are left out. Coordinates that A does not couple share no
        column, so that the core sees what couples.
    """
    scale = np.sqrt(np.maximum(np.diag(A), 0.0))
    scale[scale == 0.0] = 1.0
    scaled = A / np.outer(scale, scale)
    parts = []
    for block in coupled_blocks(A):
        values, vectors = np.linalg.eigh(scaled[np.ix_(block, block)])
        columns = np.zeros((len(A), block.size))
        columns[block] = scale[block, None] * vectors * np.sqrt(np.maximum(values, 0.0))
        parts.append((values, columns))
    values = np.concatenate([values for values, _ in parts])
    keep = values > RANK * values.max()
    return np.asarray(np.hstack([columns for _, columns in parts])[:, keep])
