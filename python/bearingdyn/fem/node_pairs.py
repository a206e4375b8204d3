"""Matrices of solids, gathered from those of their elements over pairs of nodes."""

from __future__ import annotations

import hashlib
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import scipy

from bearingdyn.types import Array, Index

KEPT, LARGEST_KEPT = 4, 1_000_000  # patterns that are kept, and their pairs of all elements at most


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
        """The pairs of groups of elements (m, k) of nodes; designs that differ in dimensions share them."""
        told = hashlib.blake2b(str([nodes, *(own.shape for own in groups)]).encode())
        for own in groups:
            told.update(np.ascontiguousarray(own, dtype=np.int64).tobytes())
        key = told.digest()
        found = _known.get(key)
        if found is None:
            found = cls._found(groups, nodes)
            if sum(at.size for at in found.where) <= LARGEST_KEPT:
                _known[key] = found
                while len(_known) > KEPT:
                    _known.pop(next(iter(_known)), None)
        return found

    @classmethod
    def _found(cls, groups: Sequence[Index], nodes: int) -> NodePairs:
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
        indices, indptr, place = self._rows
        # of its own: else `eliminate_zeros` of one matrix moves the entries of every other of the pattern
        own = (sums.ravel()[place], indices.copy(), indptr.copy())
        return scipy.sparse.csr_matrix(own, shape=(3 * self.nodes,) * 2)

    def alike(self, sums: Array) -> scipy.sparse.csr_matrix:
        """The matrix (3n, 3n) of sums (size,) that are alike along all axes, without what is zero."""
        row, column = self.pairs // self.nodes, self.pairs % self.nodes
        axes = np.arange(3)
        full = scipy.sparse.csr_matrix((sums, column, self._starts(row)), shape=(self.nodes,) * 2)
        full.eliminate_zeros()
        counts = np.diff(full.indptr)
        indptr = np.concatenate([[0], np.cumsum(np.repeat(counts, 3))])
        # a row of a node thrice, once for each axis
        at = np.arange(indptr[-1]) - np.repeat(
            indptr[:-1] - np.repeat(full.indptr[:-1], 3), np.repeat(counts, 3)
        )
        axis = np.repeat(np.tile(axes, self.nodes), np.repeat(counts, 3))
        shape = (3 * self.nodes,) * 2
        return scipy.sparse.csr_matrix((full.data[at], 3 * full.indices[at] + axis, indptr), shape=shape)

    def _starts(self, row: Index) -> Index:
        return np.concatenate([[0], np.cumsum(np.bincount(row, minlength=self.nodes))])

    @cached_property
    def _rows(self) -> tuple[Index, Index, Index]:
        """Column numbers and starts of the rows of the matrix, and of its entries the places in the sums."""
        row, column = self.pairs // self.nodes, self.pairs % self.nodes
        number = np.arange(9 * self.size, dtype=np.int64).reshape(3, 3, self.size).transpose(2, 0, 1)
        blocks = scipy.sparse.bsr_matrix(
            (np.ascontiguousarray(number), column, self._starts(row)), shape=(3 * self.nodes,) * 2
        )
        full = blocks.tocsr()
        return full.indices, full.indptr, full.data


_known: dict[bytes, NodePairs] = {}
