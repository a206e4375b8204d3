"""Meshes of a section that the engineer brings: quadrilaterals of 4, 8 or 9 nodes in (r, z)."""

from __future__ import annotations

from typing import Any

import numpy as np
import scipy
from numpy.typing import ArrayLike

from bearingdyn.checks import reals
from bearingdyn.fem.meshes.quadrilateral_element import shape_functions
from bearingdyn.fem.meshes.revolution_mesh import SAME, RevolutionMesh
from bearingdyn.types import Array, Index

# Place of the corners, the middles of the sides 01, 12, 23, 30 and the centre in RevolutionMesh.elements.
ORDER = np.array([0, 6, 8, 2, 3, 7, 5, 1, 4])
TURNED = np.array([0, 3, 2, 1, 7, 6, 5, 4, 8])  # the same element numbered the other way round


def quadrilaterals(points: ArrayLike, cells: ArrayLike, region: ArrayLike | None = None) -> RevolutionMesh:
    """Mesh of a section from arrays of quadrilaterals, such as meshio's ``mesh.cells_dict["quad9"]``.

    Parameters
    ----------
    points
        (n, 2) r and z, m, or (n, 3) with a third column of zeros (gmsh's x and y are r and z).
    cells
        (m, 4), (m, 8) or (m, 9) nodes of each element: corners in turn, then the middles of the sides from
        the first corner on, then the centre, as gmsh, VTK and Abaqus number them; middles and centre that are
        missing are added, sides then straight. All may run clockwise.
    region
        (m,) integers 0, 1, ... naming the region of each element; None: one region.

    Raises
    ------
    ValueError
        For shapes that do not fit, an r below zero, an element that is inverted or of no area (named, with
        its place), points that belong to no element, and pieces that are not joined.
    """
    xy = reals("points", points, "give finite (n, 2) coordinates r and z, m")
    if xy.ndim != 2 or xy.shape[1] not in (2, 3) or not np.isfinite(xy).all():
        raise ValueError(f"points has shape {xy.shape}; give finite (n, 2) coordinates r and z, m")
    if xy.shape[1] == 3 and xy[:, 2].any():
        worst = int(np.argmax(np.abs(xy[:, 2])))
        raise ValueError(
            f"points[{worst}] is {xy[worst].tolist()}; a section lies in the plane of the first two "
            "coordinates, r and z, and the third must be zero"
        )
    quads = np.array(cells)
    if quads.ndim != 2 or quads.shape[1] not in (4, 8, 9) or not np.issubdtype(quads.dtype, np.integer):
        raise ValueError(f"cells has shape {quads.shape}; give (m, 4), (m, 8) or (m, 9) integer nodes")
    if quads.size == 0 or quads.min() < 0 or quads.max() >= len(xy):
        raise ValueError(f"cells names nodes outside 0...{len(xy) - 1}, or there are none")
    tags = np.zeros(len(quads), dtype=np.intp) if region is None else np.array(region)
    if tags.shape != (len(quads),) or not np.issubdtype(tags.dtype, np.integer) or tags.min() < 0:
        raise ValueError(f"region has shape {tags.shape}; give an integer of 0 or more for each cell")
    r, z = xy[:, 0], xy[:, 1]
    size = float(max(np.ptp(r), np.ptp(z)))
    if not r.min() >= -SAME * size:
        raise ValueError(f"points[{int(np.argmin(r))}] has r = {r.min():g} m; a radius cannot be negative")

    unused = np.setdiff1d(np.arange(len(r)), quads)
    if unused.size:
        raise ValueError(
            f"points[{unused[0]}] at r = {r[unused[0]]:g}, z = {z[unused[0]]:g} m belongs to no element "
            f"({unused.size} such points); leave them out and renumber cells"
        )
    r, z, nine = _completed(np.maximum(r, 0.0), z, quads.astype(np.intp))
    area = _smallest_jacobian(r, z, nine)
    if (area < 0).all():
        nine = nine[:, TURNED]
        area = _smallest_jacobian(r, z, nine)
    if not (area > 0).all():
        worst = int(np.argmin(area))
        at = f"r = {r[nine[worst]].mean():g}, z = {z[nine[worst]].mean():g} m"
        raise ValueError(
            f"cells[{worst}], around {at}, is inverted, folded or has no area ({int((area <= 0).sum())} such "
            "elements); number its corners in turn, in the same sense as the others"
        )
    _check_joined(r, z, nine, size)
    elements = np.empty_like(nine)
    elements[:, ORDER] = nine
    return RevolutionMesh(r=r, z=z, elements=elements, region=tags.astype(np.intp))


def _completed(r: Array, z: Array, quads: Index) -> tuple[Array, Array, Index]:
    """Nodes and (m, 9) cells with the middles of the sides and the centres there."""
    p = np.stack([r, z], axis=-1)
    count = quads.shape[1]
    if count == 4:
        ends = np.stack([quads, np.roll(quads, -1, axis=1)], axis=-1).reshape(-1, 2)
        sides, which = np.unique(np.sort(ends, axis=1), axis=0, return_inverse=True)
        quads = np.hstack([quads, len(p) + which.reshape(-1, 4)])
        p = np.vstack([p, 0.5 * (p[sides[:, 0]] + p[sides[:, 1]])])
    if count < 9:
        corners, middles = p[quads[:, :4]], p[quads[:, 4:8]]
        centre = 0.5 * middles.sum(axis=1) - 0.25 * corners.sum(axis=1)  # where 8 nodes put ξ = η = 0
        quads = np.hstack([quads, len(p) + np.arange(len(quads))[:, None]])
        p = np.vstack([p, centre])
    return p[:, 0], p[:, 1], quads


def _smallest_jacobian(r: Array, z: Array, nine: Index) -> Array:
    """Determinant nearest to a change of sign over each element's nodes and Gauss points, m²; (m,).

    Its sign is that of the element where it is the same everywhere; else it is zero.
    """
    grid: Array = np.array([-1.0, -np.sqrt(0.6), 0.0, np.sqrt(0.6), 1.0])
    _, N_xi, N_eta = shape_functions(np.repeat(grid, 5), np.tile(grid, 5))
    ordered = np.empty_like(nine)
    ordered[:, ORDER] = nine
    R, Z = r[ordered], z[ordered]
    det = (R @ N_xi.T) * (Z @ N_eta.T) - (R @ N_eta.T) * (Z @ N_xi.T)
    low, high = det.min(axis=1), det.max(axis=1)
    tiny = 1e-12 * np.abs(det).max()
    return np.where(low > tiny, low, np.where(high < -tiny, high, 0.0))


def _check_joined(r: Array, z: Array, nine: Index, size: float) -> None:
    from scipy.sparse.csgraph import connected_components  # late: both load much, and few bring meshes
    from scipy.spatial import cKDTree

    n = r.size
    ones = np.ones(nine.size)
    belongs: Any = scipy.sparse.csr_matrix((ones, (np.repeat(np.arange(len(nine)), 9), nine.ravel())))
    pieces, label = connected_components(belongs.T @ belongs, directed=False)
    if pieces > 1:
        other = int(np.flatnonzero(label != label[0])[0])
        raise ValueError(
            f"cells falls into {pieces} pieces that share no node, one at r = {r[other]:g}, z = {z[other]:g} "
            "m; merge nodes that coincide, or make a part of each piece"
        )
    twins = cKDTree(np.stack([r, z], axis=-1)).query_pairs(SAME * size, output_type="ndarray")
    if len(twins):
        a, b = (int(k) for k in twins[0])
        where = f"at r = {r[a]:g}, z = {z[a]:g} m"
        raise ValueError(f"two of the {n} nodes, {a} and {b}, coincide {where}; merge them")
