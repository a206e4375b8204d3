"""Gmsh's types of elements, and which of its nodes is each of ours."""

from __future__ import annotations

import numpy as np

from bearingdyn.fem.meshes.solid_element import HEX20, HEX27, PYRAMID13, TET10, WEDGE15, SolidElement
from bearingdyn.types import Index

# gmsh's types: dimension, nodes, and what they are called where they are refused
TYPES = {
    **{1: (1, 2, ""), 8: (1, 3, ""), 26: (1, 4, ""), 27: (1, 5, ""), 28: (1, 6, ""), 15: (0, 1, "")},
    **{2: (2, 3, ""), 9: (2, 6, ""), 3: (2, 4, ""), 16: (2, 8, ""), 10: (2, 9, "")},
    **{4: (3, 4, ""), 11: (3, 10, ""), 5: (3, 8, ""), 17: (3, 20, ""), 12: (3, 27, "")},
    **{6: (3, 6, ""), 18: (3, 15, ""), 13: (3, 18, ""), 7: (3, 5, ""), 19: (3, 13, ""), 14: (3, 14, "")},
    **{n: (2, k, "triangles of third order or more") for n, k in ((20, 9), (21, 10), (22, 12), (23, 15))},
    **{n: (2, k, "triangles of third order or more") for n, k in ((24, 15), (25, 21))},
    **{36: (2, 16, "quadrilaterals of third order"), 37: (2, 25, "quadrilaterals of fourth order")},
    **{29: (3, 20, "tetrahedra of third order"), 30: (3, 35, "tetrahedra of fourth order")},
    **{31: (3, 56, "tetrahedra of fifth order"), 90: (3, 40, "wedges of third order")},
    **{92: (3, 64, "bricks of third order"), 93: (3, 125, "bricks of fourth order")},
}
# Whose middle the nodes after the corners are, in gmsh's order: two corners an edge, four a face
BRICK_EDGES = ((0, 1), (0, 3), (0, 4), (1, 2), (1, 5), (2, 3), (2, 6), (3, 7), (4, 5), (4, 7), (5, 6), (6, 7))
BRICK_FACES = ((0, 1, 2, 3), (0, 1, 4, 5), (0, 3, 4, 7), (1, 2, 5, 6), (2, 3, 6, 7), (4, 5, 6, 7))
TET_EDGES = ((0, 1), (1, 2), (2, 0), (3, 0), (3, 2), (3, 1))
WEDGE_EDGES = ((0, 1), (0, 2), (0, 3), (1, 2), (1, 4), (2, 5), (3, 4), (3, 5), (4, 5))
PYRAMID_EDGES = ((0, 1), (0, 3), (0, 4), (1, 2), (1, 4), (2, 3), (2, 4), (3, 4))


def _order(kind: SolidElement, middles: tuple[tuple[int, ...], ...]) -> Index:
    """Which of gmsh's nodes is each of ours."""
    place = {frozenset(group): len(kind.corners) + k for k, group in enumerate(middles)}
    groups = [*kind.edges, *(kind.faces if kind.centres else ())]
    found = [*range(len(kind.corners)), *(place[frozenset(group)] for group in groups)]
    return np.array([*found, *([26] if kind.centres else [])], dtype=np.intp)


ORDERS = {
    17: _order(HEX20, BRICK_EDGES),
    12: _order(HEX27, BRICK_EDGES + BRICK_FACES),
    11: _order(TET10, TET_EDGES),
    18: _order(WEDGE15, WEDGE_EDGES),
    13: np.append(_order(WEDGE15, WEDGE_EDGES), [15, 16, 17]),
    19: _order(PYRAMID13, PYRAMID_EDGES),
    14: np.append(_order(PYRAMID13, PYRAMID_EDGES), 13),
}
