"""Coupling of coordinates: which ones any matrix joins."""

from __future__ import annotations

import numpy as np
import scipy

from bearingdyn.types import Array, Index


def coupled_blocks(*matrices: Array) -> list[Index]:
    """Coordinates that any nonzero entry of the matrices couples, block by block.

    Parameters
    ----------
    *matrices
        (n, n) each, of the same coordinates.

    Returns
    -------
    list of Array
        Indices of the coordinates of each block; every coordinate is in one of them.
    """
    pattern = scipy.sparse.csr_matrix(sum((np.asarray(A) != 0.0) for A in matrices))
    count, label = scipy.sparse.csgraph.connected_components(pattern, directed=False)
    return [np.flatnonzero(label == b) for b in range(count)]
