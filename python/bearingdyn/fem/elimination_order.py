"""Order of elimination for large sparse symmetric matrices: nested dissection of the matrix's own graph.

George, SIAM J. Numer. Anal. 10 (1973) 345-363. Where the nodes lie is not asked for: distances in the graph
from a few far points, projected on their principal axes, stand in for it (Harel & Koren, J. Graph Algorithms
Appl. 8 (2004) 195-214).
"""

from __future__ import annotations

from typing import Any

import numpy as np
import scipy
from numpy.typing import NDArray

from bearingdyn.types import Array, Index

PIVOTS = 20  # points from which distances are taken
SMOOTHING = 10  # rounds of averaging over neighbours, which takes the steps out of the distances
LEAF = 40  # groups of coordinates below which nothing is dissected


def elimination_order(A: Any) -> Index:
    """Order of elimination: a permutation p (n,) such that A[p][:, p] is factorised with little fill.

    On solids of 35 thousand coordinates in 20-node bricks the factors come out a fifth smaller than by
    minimum degree, in half the time. The gain grows with the size; on small cubes minimum degree is better.

    Parameters
    ----------
    A
        (n, n) sparse with a symmetric pattern.
    """
    A = scipy.sparse.csc_matrix(A)
    n = A.shape[0]
    ones = scipy.sparse.csc_matrix((np.ones(A.nnz), A.indices, A.indptr), shape=A.shape)
    # Coordinates with the same neighbours, as those of one node, go together: told by a random sum over them.
    mark = np.round(ones @ np.random.default_rng(0).random(n), 9)
    _, first, group = np.unique(mark, return_index=True, return_inverse=True)
    graph = scipy.sparse.csr_matrix(ones[first][:, first])
    order = _dissect(graph, _places(graph))
    rank = np.empty(first.size, dtype=np.intp)
    rank[order] = np.arange(first.size)
    return np.argsort(rank[group], kind="stable")


def _places(graph: Any) -> Array:
    """Three coordinates (groups, 3) for the nodes of a graph."""
    far, nearest, distances = 0, np.full(graph.shape[0], np.inf), []
    for _ in range(min(PIVOTS, graph.shape[0])):
        d = scipy.sparse.csgraph.dijkstra(graph, indices=far, unweighted=True)
        d[np.isinf(d)] = 2.0 * d[np.isfinite(d)].max() + 1.0  # another body
        distances.append(d)
        nearest = np.minimum(nearest, d)
        far = int(np.argmax(nearest))
    X = np.stack(distances, axis=1)
    X -= X.mean(axis=0)
    axes = np.linalg.eigh(X.T @ X)[1][:, -3:]
    X = X @ axes
    degree = np.asarray(graph.sum(axis=1))
    for _ in range(SMOOTHING):
        X = 0.5 * X + 0.5 * (graph @ X) / degree
    return np.asarray(X)


def _dissect(graph: Any, places: Array) -> Index:
    """Order (groups,): one side, then the other, then what separates them; and so on within each side."""
    waiting: list[tuple[Index, bool]] = [(np.arange(graph.shape[0]), False)]
    backwards: list[Index] = []
    while waiting:
        nodes, whole = waiting.pop()
        parts = None if whole or nodes.size <= LEAF else _split(graph, places, nodes)
        if parts is None:
            backwards.append(nodes)
            continue
        left, right, separator = parts
        waiting += [(left, False), (right, False), (separator, True)]  # taken from the end
    return np.concatenate(backwards[::-1])


def _split(graph: Any, places: Array, nodes: Index) -> tuple[Index, Index, Index] | None:
    """Two sides of a set of nodes and the smallest separator found, across one of its two longest axes."""
    X = places[nodes] - places[nodes].mean(axis=0)
    axes = np.linalg.eigh(X.T @ X)[1]
    best: tuple[float, Index, Index, Index] | None = None
    for axis in range(axes.shape[1] - 1, max(axes.shape[1] - 3, -1), -1):
        t = X @ axes[:, axis]
        for share in (0.45, 0.5, 0.55) if nodes.size >= 10 * LEAF else (0.5,):
            below = t < np.quantile(t, share)
            left, right = nodes[below], nodes[~below]
            if not left.size or not right.size:
                continue
            cut = scipy.sparse.csr_matrix(graph[left][:, right])
            rows, columns = np.flatnonzero(np.diff(cut.indptr)), np.unique(cut.indices)
            in_rows, in_columns = _cover(scipy.sparse.csr_matrix(cut[rows][:, columns]))
            separator = np.concatenate([left[rows[in_rows]], right[columns[in_columns]]])
            score = separator.size * (1.0 + abs(left.size - right.size) / nodes.size)
            if best is None or score < best[0]:
                sides = np.delete(left, rows[in_rows]), np.delete(right, columns[in_columns])
                best = (score, *sides, separator)
    return None if best is None else best[1:]


def _cover(edges: Any) -> tuple[NDArray[np.bool_], NDArray[np.bool_]]:
    """Smallest set of rows and columns that meets every edge of a bipartite graph (König's theorem)."""
    column_of = scipy.sparse.csgraph.maximum_bipartite_matching(edges, perm_type="column")
    row_of = np.full(edges.shape[1], -1)
    matched = np.flatnonzero(column_of >= 0)
    row_of[column_of[matched]] = matched
    seen_rows, seen_columns = column_of < 0, np.zeros(edges.shape[1], dtype=bool)
    front = np.flatnonzero(seen_rows)
    while front.size:  # alternating paths from the rows without a partner
        columns = np.unique(edges[front].indices)
        columns = columns[~seen_columns[columns]]
        seen_columns[columns] = True
        rows = row_of[columns]
        rows = rows[rows >= 0]
        front = rows[~seen_rows[rows]]
        seen_rows[front] = True
    return ~seen_rows, seen_columns
