"""A finite element model read from elsewhere."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
import scipy.sparse
import scipy.sparse.linalg
from numpy.typing import ArrayLike

from bearingdyn.fem.rigid_motion import rigid_transfer
from bearingdyn.types import Array, Index

Points = ArrayLike | Mapping[int, ArrayLike]
DIRECTIONS = ("x", "y", "z", "θx", "θy", "θz")


@dataclass(frozen=True, eq=False, kw_only=True)
class FEMatrices:
    """Finite element (FE) matrices read from elsewhere, in SI units.

    Parameters
    ----------
    M, K
        (n, n) sparse mass, kg, and stiffness, N/m, made exactly symmetric.
    points
        (k, 3) positions of the nodes, m, when known.
    nodes
        (k,) numbers of the nodes, when the file names them; otherwise a node is known by its row in points.
    dofs
        (n, 2) row of the node and direction 0...5 (x, y, z, θx, θy, θz) of each coordinate. The row is -1 for
        a coordinate that belongs to no node, such as a modal one. None: coordinate 3 i + a is node i along
        axis a.
    """

    M: scipy.sparse.csr_matrix
    K: scipy.sparse.csr_matrix
    points: Array | None = None
    nodes: Index | None = None
    dofs: Index | None = None

    def __repr__(self) -> str:
        """One line instead of the matrices."""
        nodes = "" if self.points is None else f", {len(self.points)} nodes"
        return f"<FEMatrices of {self.n} coordinates{nodes}>"

    @property
    def n(self) -> int:
        """Number of coordinates."""
        return int(self.K.shape[0])

    @property
    def places(self) -> Index:
        """Row of its node and direction of each coordinate, (n, 2)."""
        if self.dofs is not None:
            return self.dofs
        return np.stack(np.divmod(np.arange(self.n), 3), axis=1).astype(np.intp)

    def name(self, coordinate: int) -> str:
        """What a coordinate is, for a message: "node 12, x"."""
        row, direction = self.places[coordinate].tolist()
        if row < 0:
            return f"coordinate {coordinate}"
        return f"node {row if self.nodes is None else int(self.nodes[row])}, {DIRECTIONS[direction]}"

    def rigid_motion(self, reference: ArrayLike) -> Array:
        """Motion (n, 6) of all coordinates as one rigid body about a reference point, m.

        Raises
        ------
        ValueError
            Where the positions of the nodes are not known.
        """
        if self.points is None:
            raise ValueError("points is not known; pass the nodes' positions when the matrices are read")
        row, direction = self.places.T
        R = rigid_transfer(self.points, reference)[6 * np.maximum(row, 0) + direction]
        R[row < 0] = 0.0
        return np.asarray(R)
