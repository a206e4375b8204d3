"""Matrices of solids, gathered from those of their elements over pairs of nodes."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import scipy

from bearingdyn.types import Array, Index


@dataclass(frozen=True, eq=False, kw_only=True)
class NodePairs:
    """Pairs of nodes that share a solid element: the pattern of a matrix (3n, 3n) of blocks 3×3.

    Parameters
    ----------
    nodes
        How many, n.
    pairs
        (size,) rising, row · n + column.
    where
        Of each group of elements, the places of its pairs.
    """

    nodes: int
    pairs: Index
    where: list[Index]

    @classmethod
    def of(cls, groups: Sequence[Index], nodes: int) -> NodePairs:
        """The pairs of groups of elements (m, k) of nodes."""
        keys = [(own[:, :, None] * nodes + own[:, None, :]).ravel() for own in groups]
        pairs, where = np.unique(np.concatenate(keys), return_inverse=True)
        ends = np.cumsum([key.size for key in keys])[:-1]
        return cls(nodes=nodes, pairs=pairs, where=np.split(where.ravel(), ends))

    @property
    def size(self) -> int:
        """How many pairs."""
        return int(self.pairs.size)

    def zeros(self) -> Array:
        """Sums to add to, by axes, (3, 3, size)."""
        return np.zeros((3, 3, self.size))

    def add(self, sums: Array, group: int, A: Array) -> None:
        """Add matrices (m, 3 k, 3 k) of the elements of a group to sums (3, 3, size)."""
        m, k = len(A), A.shape[1] // 3
        by_axes = A.reshape(m, k, 3, k, 3).transpose(2, 4, 0, 1, 3)
        for a in range(3):
            for b in range(3):
                sums[a, b] += np.bincount(self.where[group], by_axes[a, b].ravel(), self.size)

    def matrix(self, sums: Array) -> scipy.sparse.csr_matrix:
        """The matrix (3n, 3n) of sums (3, 3, size); coordinate 3 i + a is node i along axis a."""
        row, column = self.pairs // self.nodes, self.pairs % self.nodes
        indptr = np.concatenate([[0], np.cumsum(np.bincount(row, minlength=self.nodes))])
        data = np.ascontiguousarray(sums.transpose(2, 0, 1))
        return scipy.sparse.bsr_matrix((data, column, indptr), shape=(3 * self.nodes,) * 2).tocsr()
