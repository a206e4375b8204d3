"""Second-order solid elements: node order, edges, faces, shape functions and integration points.

Nodes of an element are numbered as VTK and Abaqus number them: corners, middles of edges, then for the
27-node brick the middles of faces and the centre. The shape functions of bricks and tetrahedra are
scikit-fem's; those of wedges and pyramids follow from the functions they span.
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
WEDGE = ((0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (0, 1, 1))
WEDGE_EDGES = ((0, 1), (1, 2), (2, 0), (3, 4), (4, 5), (5, 3), (0, 3), (1, 4), (2, 5))
WEDGE_FACES = ((0, 2, 1), (3, 4, 5), (0, 1, 4, 3), (1, 2, 5, 4), (2, 0, 3, 5))
PYRAMID = ((0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0.5, 0.5, 1))
PYRAMID_EDGES = ((0, 1), (1, 2), (2, 3), (3, 0), (0, 4), (1, 4), (2, 4), (3, 4))
PYRAMID_FACES = ((0, 3, 2, 1), (0, 1, 4), (1, 2, 4), (2, 3, 4), (3, 0, 4))

# What wedges and pyramids span, by exponents a, b, c, d of x^a y^b z^c (1 − z)^−d; x and y of a pyramid from
# its axis to ±1. Wedge: quadratic in the triangle times linear in z, and linear times z². Pyramid: all
# quadratics and three rational functions, which are quadratic on its faces (Bedrosian, Int. J. Numer. Meth.
# Eng. 35 (1992) 95): neighbours of any kind fit.
WEDGE_SPAN = (
    *((a, b, c, 0) for c in (0, 1) for a in range(3) for b in range(3 - a)),
    *((a, b, 2, 0) for a in range(2) for b in range(2 - a)),
)
PYRAMID_SPAN = (
    *((a, b, c, 0) for a in range(3) for b in range(3 - a) for c in range(3 - a - b)),
    *((1, 1, 0, 1), (2, 1, 0, 1), (1, 2, 0, 1)),
)


@dataclass(frozen=True)
class SolidElement:
    """A kind of second-order solid element: its nodes, edges and faces.

    Parameters
    ----------
    corners
        (c, 3) on the unit brick, simplex, wedge or pyramid.
    edges
        Pairs of corners; their middles follow the corners.
    faces
        Corners of each face, seen from outside anticlockwise.
    centres
        Middles of faces and of the element follow.
    interpolation
        Name of scikit-fem's element, or the functions spanned.
    """

    name: str
    corners: tuple[tuple[float, float, float], ...]
    edges: tuple[tuple[int, int], ...]
    faces: tuple[tuple[int, ...], ...]
    centres: bool
    interpolation: str | tuple[tuple[int, int, int, int], ...]

    @property
    def nodes(self) -> int:
        """Nodes of an element."""
        return len(self.corners) + len(self.edges) + (len(self.faces) + 1 if self.centres else 0)

    @property
    def places(self) -> Array:
        """Nodes on the unit element, (nodes, 3)."""
        c = np.array(self.corners, dtype=np.float64)
        middles = [c[list(group)].mean(axis=0) for group in self.edges]
        if self.centres:
            middles += [c[list(group)].mean(axis=0) for group in (*self.faces, range(len(c)))]
        return np.vstack([c, *middles])

    @property
    def face_nodes(self) -> Index:
        """Nodes of each face, (faces, nodes of a face): corners, middles of edges, centre if there is one.

        A triangle among quadrilaterals repeats its last node; `by_size` tells them apart.
        """
        edge = {frozenset(pair): len(self.corners) + k for k, pair in enumerate(self.edges)}
        first = len(self.corners) + len(self.edges)
        found = []
        for k, face in enumerate(self.faces):
            around = zip(face, face[1:] + face[:1], strict=True)
            centre = [first + k] if self.centres else []
            found.append([*face, *(edge[frozenset(pair)] for pair in around), *centre])
        width = max(map(len, found))
        return np.array([row + row[-1:] * (width - len(row)) for row in found], dtype=np.intp)

    @property
    def face_corners(self) -> Index:
        """Corners of each face, (faces, 4); −1 is the fourth of a triangle."""
        return np.array([[*face, -1][:4] for face in self.faces], dtype=np.intp)


HEX20 = SolidElement("hex20", BRICK, BRICK_EDGES, BRICK_FACES, False, "ElementHexS2")
HEX27 = SolidElement("hex27", BRICK, BRICK_EDGES, BRICK_FACES, True, "ElementHex2")
TET10 = SolidElement("tet10", TET, TET_EDGES, TET_FACES, False, "ElementTetP2")
WEDGE15 = SolidElement("wedge15", WEDGE, WEDGE_EDGES, WEDGE_FACES, False, WEDGE_SPAN)
PYRAMID13 = SolidElement("pyramid13", PYRAMID, PYRAMID_EDGES, PYRAMID_FACES, False, PYRAMID_SPAN)

KINDS = {kind.nodes: kind for kind in (HEX20, HEX27, TET10, WEDGE15, PYRAMID13)}
OF_CORNERS = {len(kind.corners): kind for kind in (HEX20, TET10, WEDGE15, PYRAMID13)}
NAMES = {"hex": "brick", "tet": "tetrahedron", "wed": "wedge", "pyr": "pyramid"}
FACE_INTERPOLATION = {6: "ElementTriP2", 8: "ElementQuadS2", 9: "ElementQuad2"}


def by_size(faces: Index) -> list[tuple[Index, int]]:
    """Solid elements' faces parted into triangles and quadrilaterals.

    Parameters
    ----------
    faces
        Nodes (f, w) of the faces; a triangle among quadrilaterals repeats its last node.

    Returns
    -------
    list of (Array, int)
        Rows of each kind that there is, and how many nodes such a face has: 6, 8 or 9.
    """
    width = faces.shape[1]
    if width == 6:
        return [(np.arange(len(faces)), 6)]
    three = faces[:, -1] == faces[:, 5]
    return [(at, n) for at, n in ((np.flatnonzero(three), 6), (np.flatnonzero(~three), width)) if at.size]


def _shapes(interpolation: str, places: Array, X: Array) -> tuple[Array, Array]:
    """Functions (points, nodes) and their gradients (points, nodes, dimensions) at X (points, dimensions)."""
    import skfem

    element: Any = getattr(skfem, interpolation)()
    distance = np.linalg.norm(places[:, None] - element.doflocs[None], axis=2)
    order = np.argmin(distance, axis=1)
    pairs = [element.lbasis(X.T.copy(), int(i)) for i in order]
    N = np.stack([np.broadcast_to(value, len(X)) for value, _ in pairs], axis=1)
    return N, np.stack([gradient.T for _, gradient in pairs], axis=1)


def _spanned(kind: SolidElement, X: Array) -> tuple[Array, Array]:
    """The functions of WEDGE_SPAN or PYRAMID_SPAN, and their gradients, at X (q, 3)."""
    e = np.array(kind.interpolation, dtype=np.float64)
    stretch = 2.0 if kind is PYRAMID13 else 1.0
    x, y = (stretch * X[:, i, None] - (stretch - 1.0) for i in (0, 1))
    z = X[:, 2, None]
    below = np.maximum(1.0 - z, 1e-30)  # at the tip x and y are 0, and so are the rational functions

    def power(base: Array, n: Array) -> Array:
        return np.where(n > 0, base ** np.maximum(n, 0.0), np.where(n == 0, 1.0, 0.0))

    a, b, c, d = e.T
    px, py, pz, pd = power(x, a), power(y, b), power(z, c), below**-d
    gradient = [
        stretch * a * power(x, a - 1) * py * pz * pd,
        stretch * b * px * power(y, b - 1) * pz * pd,
        px * py * (c * power(z, c - 1) * pd + d * pz * pd / below),
    ]
    return px * py * pz * pd, np.stack(gradient, axis=2)


def shapes(kind: SolidElement, X: Array) -> tuple[Array, Array]:
    """Shape functions (q, k) of a solid element and gradients (q, k, 3) at points X (q, 3)."""
    if isinstance(kind.interpolation, str):
        return _shapes(kind.interpolation, kind.places, X)
    nodal = np.linalg.inv(_spanned(kind, kind.places)[0])
    value, gradient = _spanned(kind, X)
    return value @ nodal, np.einsum("qfd,fk->qkd", gradient, nodal)


def face_shapes(nodes: int, X: Array) -> tuple[Array, Array]:
    """Shape functions and gradients of a solid element's face.

    Parameters
    ----------
    nodes
        Of the face: 6 of a triangle, 8 or 9 of a quadrilateral.
    X
        Points (q, 2) of the unit triangle or square.

    Returns
    -------
    N : Array
        (q, nodes).
    gradient : Array
        (q, nodes, 2).
    """
    return _shapes(FACE_INTERPOLATION[nodes], face_places(nodes), X)


def face_places(nodes: int) -> Array:
    """Places (nodes, 2) on the unit triangle or square of a solid element's face of 6, 8 or 9 nodes."""
    c = np.array([(0, 0), (1, 0), (0, 1)] if nodes == 6 else [(0, 0), (1, 0), (1, 1), (0, 1)], dtype=float)
    middles = 0.5 * (c + np.roll(c, -1, axis=0))
    return np.vstack([c, middles, c.mean(axis=0)[None]])[:nodes]


def gauss(n: int, dimensions: int) -> tuple[Array, Array]:
    """Gauss points (n^d, d) and weights of a solid element's unit square or cube, n a direction."""
    x, w = np.polynomial.legendre.leggauss(n)
    grid = np.meshgrid(*[0.5 * (x + 1.0)] * dimensions, indexing="ij")
    weights = np.meshgrid(*[0.5 * w] * dimensions, indexing="ij")
    return np.stack([g.ravel() for g in grid], axis=1), np.prod([g.ravel() for g in weights], axis=0)


def simplex_points(dimensions: int, order: int = 4) -> tuple[Array, Array]:
    """Points (q, d), weights of a solid element's unit triangle or tetrahedron, exact to an order."""
    import skfem
    from skfem.quadrature import get_quadrature

    X, w = get_quadrature(skfem.refdom.RefTri if dimensions == 2 else skfem.refdom.RefTet, order)
    return np.ascontiguousarray(X.T), w


def points(kind: SolidElement, reduced: bool = False, fine: bool = False) -> tuple[Array, Array]:
    """Integration points (q, 3) of a solid element and weights, exact for straight edges.

    Bricks 3×3×3, reduced 2×2×2; tetrahedra to order 4; wedges those of the triangle times 3; pyramids
    3×3×4 of a brick whose top shrinks to the tip, where their rational functions are polynomials. Fine: for
    the products of the gradients of a bubble too, to order 6 in triangles and tetrahedra.
    """
    order = 6 if fine else 4
    if kind is TET10:
        return simplex_points(3, order)
    if kind is WEDGE15:
        (X, w), (z, v) = simplex_points(2, order), gauss(3, 1)
        return np.hstack([np.repeat(X, 3, axis=0), np.tile(z, (len(X), 1))]), np.outer(w, v).ravel()
    if kind is PYRAMID13:
        (X, w), (z, v) = gauss(5 if fine else 3, 2), gauss(6 if fine else 4, 1)
        X, height = np.repeat(X, len(z), axis=0), np.tile(z, (len(X), 1))
        return np.hstack([0.5 + (X - 0.5) * (1 - height), height]), np.outer(
            w, v * (1 - z[:, 0]) ** 2
        ).ravel()
    return gauss(2 if reduced else 3, 3)


# Planes c0 + c·x that are zero on the faces of the unit element: their product is a bubble
BUBBLES = {
    TET10: ((0, 1, 0, 0), (0, 0, 1, 0), (0, 0, 0, 1), (1, -1, -1, -1)),
    WEDGE15: ((0, 1, 0, 0), (0, 0, 1, 0), (1, -1, -1, 0), (0, 0, 0, 1), (1, 0, 0, -1)),
    PYRAMID13: ((0, 0, 0, 1), (0, 1, 0, -0.5), (1, -1, 0, -0.5), (0, 0, 1, -0.5), (1, 0, -1, -0.5)),
}


def bubble_gradient(kind: SolidElement, X: Array) -> Array:
    """Gradient (q, 3) at points X (q, 3) of a function that is zero on all faces of the unit element."""
    planes = np.array(BUBBLES[kind], dtype=np.float64)
    value = planes[:, 0] + X @ planes[:, 1:].T
    others = [np.prod(np.delete(value, i, axis=1), axis=1) for i in range(len(planes))]
    return np.stack(others, axis=1) @ planes[:, 1:]


def face_points(nodes: int) -> tuple[Array, Array]:
    """Integration points (q, 2) of a solid element's face, and weights.

    Parameters
    ----------
    nodes
        Of the face: 6, 8 or 9.
    """
    return simplex_points(2) if nodes == 6 else gauss(3, 2)
