"""Second-order solid elements: node order, edges, faces, shape functions and integration points.

Nodes of an element are numbered as VTK and Abaqus number them: corners, middles of edges, then for the
27-node brick the middles of faces and the centre. The shape functions are scikit-fem's.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from bearingdyn.types import Array, Index

BRICK = ((0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1))
BRICK_EDGES = (
    *((0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 7), (7, 4)),
    *((0, 4), (1, 5), (2, 6), (3, 7)),
)
# x−, x+, y−, y+, z−, z+; corners anticlockwise seen from outside
BRICK_FACES = ((0, 4, 7, 3), (1, 2, 6, 5), (0, 1, 5, 4), (3, 7, 6, 2), (0, 3, 2, 1), (4, 5, 6, 7))
TET = ((0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1))
TET_EDGES = ((0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3))
TET_FACES = ((0, 2, 1), (0, 1, 3), (1, 2, 3), (0, 3, 2))


@dataclass(frozen=True)
class SolidElement:
    """A kind of element.

    Parameters
    ----------
    corners
        (c, 3) on the unit brick or simplex.
    edges
        Pairs of corners; their middles follow the corners.
    faces
        Corners of each face, seen from outside anticlockwise.
    centres
        Middles of faces and of the element follow.
    interpolation, face_interpolation
        Names of scikit-fem's elements.
    """

    name: str
    corners: tuple[tuple[int, int, int], ...]
    edges: tuple[tuple[int, int], ...]
    faces: tuple[tuple[int, ...], ...]
    centres: bool
    interpolation: str
    face_interpolation: str

    @property
    def nodes(self) -> int:
        """Nodes of an element."""
        return len(self.corners) + len(self.edges) + (len(self.faces) + 1 if self.centres else 0)

    @property
    def places(self) -> Array:
        """Nodes on the unit brick or simplex, (nodes, 3)."""
        c = np.array(self.corners, dtype=np.float64)
        middles = [c[list(group)].mean(axis=0) for group in self.edges]
        if self.centres:
            middles += [c[list(group)].mean(axis=0) for group in (*self.faces, range(len(c)))]
        return np.vstack([c, *middles])

    @property
    def face_nodes(self) -> Index:
        """Nodes of each face, (faces, nodes of a face): corners, middles of edges, centre if there is one."""
        edge = {frozenset(pair): len(self.corners) + k for k, pair in enumerate(self.edges)}
        first = len(self.corners) + len(self.edges)
        found = []
        for k, face in enumerate(self.faces):
            around = zip(face, face[1:] + face[:1], strict=True)
            centre = [first + k] if self.centres else []
            found.append([*face, *(edge[frozenset(pair)] for pair in around), *centre])
        return np.array(found, dtype=np.intp)


HEX20 = SolidElement("hex20", BRICK, BRICK_EDGES, BRICK_FACES, False, "ElementHexS2", "ElementQuadS2")
HEX27 = SolidElement("hex27", BRICK, BRICK_EDGES, BRICK_FACES, True, "ElementHex2", "ElementQuad2")
TET10 = SolidElement("tet10", TET, TET_EDGES, TET_FACES, False, "ElementTetP2", "ElementTriP2")

KINDS = {kind.nodes: kind for kind in (HEX20, HEX27, TET10)}


def _shapes(interpolation: str, places: Array, X: Array) -> tuple[Array, Array]:
    """Functions (points, nodes) and their gradients (points, nodes, dimensions) at X (points, dimensions)."""
    import skfem

    element: Any = getattr(skfem, interpolation)()
    distance = np.linalg.norm(places[:, None] - element.doflocs[None], axis=2)
    order = np.argmin(distance, axis=1)
    pairs = [element.lbasis(X.T.copy(), int(i)) for i in order]
    N = np.stack([np.broadcast_to(value, len(X)) for value, _ in pairs], axis=1)
    return N, np.stack([gradient.T for _, gradient in pairs], axis=1)


def shapes(kind: SolidElement, X: Array) -> tuple[Array, Array]:
    """Shape functions (q, k) and their gradients (q, k, 3) at points X (q, 3) of the unit element."""
    return _shapes(kind.interpolation, kind.places, X)


def face_shapes(kind: SolidElement, X: Array) -> tuple[Array, Array]:
    """Shape functions (q, f) and gradients (q, f, 2) of a face, nodes as in face_nodes, at X (q, 2)."""
    sides = len(kind.faces[0])
    c = np.array([(0, 0), (1, 0), (1, 1), (0, 1)] if sides == 4 else [(0, 0), (1, 0), (0, 1)], dtype=float)
    middles = 0.5 * (c + np.roll(c, -1, axis=0))
    places = np.vstack([c, middles, c.mean(axis=0)[None]] if kind.centres else [c, middles])
    return _shapes(kind.face_interpolation, places, X)


def gauss(n: int, dimensions: int) -> tuple[Array, Array]:
    """Gauss points (n^d, d) and weights of the unit square or cube, n a direction."""
    x, w = np.polynomial.legendre.leggauss(n)
    grid = np.meshgrid(*[0.5 * (x + 1.0)] * dimensions, indexing="ij")
    weights = np.meshgrid(*[0.5 * w] * dimensions, indexing="ij")
    return np.stack([g.ravel() for g in grid], axis=1), np.prod([g.ravel() for g in weights], axis=0)


def simplex_points(dimensions: int) -> tuple[Array, Array]:
    """Points (q, d) and weights of the unit triangle or tetrahedron, exact to order 4 (scikit-fem's)."""
    import skfem
    from skfem.quadrature import get_quadrature

    X, w = get_quadrature(skfem.refdom.RefTri if dimensions == 2 else skfem.refdom.RefTet, 4)
    return np.ascontiguousarray(X.T), w


def points(kind: SolidElement, reduced: bool = False) -> tuple[Array, Array]:
    """Integration points (q, 3) and weights: 3×3×3, reduced 2×2×2; of tetrahedra exact to order 4."""
    if kind is TET10:
        return simplex_points(3)
    return gauss(2 if reduced else 3, 3)


def face_points(kind: SolidElement) -> tuple[Array, Array]:
    """Integration points (q, 2) and weights of a face."""
    return simplex_points(2) if kind is TET10 else gauss(3, 2)
