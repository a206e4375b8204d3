"""Panels that radiate for the skin of a part: a coarser surface of triangles made from its faces."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.sparse.linalg
import scipy.spatial

from bearingdyn.cms import Skin
from bearingdyn.fem import by_size, face_points, face_shapes
from bearingdyn.short_repr import short
from bearingdyn.sound.remeshing import remeshed
from bearingdyn.types import Array, Index

CELLS = 1.5  # of integration, along an element's face in one wanted side of a panel
NEAREST = 12  # panels by their middles, among which a point's own is sought
FACING = 0.3  # least cosine between the normals of a point and of its panel
STIFF = 1e-3  # of what holds a corner to the skin, against sliding in it
FITS = 2


@dataclass(frozen=True, eq=False)
class SkinPanels:
    """Flat triangles near a part's skin and their normal velocity.

    Parameters
    ----------
    points
        Corners (n, 3), m, in the part's own frame.
    faces
        (m, 3), anticlockwise seen from outside.
    rows
        (m, c): outward normal displacement of each panel from the coordinates of the part's superelement.
    shares
        name -> (m,): the share of each panel that lies on a named surface.
    unnamed
        (m,): the share of each panel that lies on none of them; surfaces may overlap.
    """

    points: Array
    faces: Index
    rows: Array
    shares: dict[str, Array]
    unnamed: Array

    __repr__ = short


def panelled(skin: Skin, size: float) -> SkinPanels:
    """Panels with sides near `size`, m, for a part's skin.

    The corners are fitted to the skin by least squares, so that curved parts keep their volume. A panel moves
    as the part of the skin nearest to it does on average, but for a small quadratic of the place; so the
    flux through all panels and its first and second moments become those of the skin: by these, as sources of
    order 0, 1 and 2, small bodies radiate.

    Parameters
    ----------
    skin
        The boundary of a part.
    size
        Wanted length of the sides, m.

    Returns
    -------
    SkinPanels
        The panels in the part's own frame.
    """
    points, faces = remeshed(*_triangles(skin), size)
    samples = _samples(skin, size)
    for _ in range(FITS):
        points = _fitted(points, faces, samples)
    panel, _ = _nearest(points, faces, samples)
    weight = samples.weights
    m = len(faces)
    held = np.bincount(panel, weight, minlength=m)
    for empty in np.flatnonzero(held == 0.0):
        # a needle without a point of its own moves as the nearest point that faces the same way
        normal = _normals(points, faces)[0][empty]
        off = np.linalg.norm(samples.positions - points[faces[empty]].mean(axis=0), axis=1)
        off[samples.normals @ normal < FACING] = np.inf
        panel[np.argmin(off)] = empty
        held = np.bincount(panel, weight, minlength=m)
    mean = scipy.sparse.csr_matrix((weight / held[panel], (panel, np.arange(panel.size))))
    q = np.arange(panel.size)
    turn = scipy.sparse.csr_matrix(
        (samples.normals.ravel(), (np.repeat(q, 3), np.arange(3 * q.size))), (q.size, 3 * q.size)
    )
    normal_rows = turn @ scipy.sparse.kron(samples.interpolation, scipy.sparse.eye(3)).tocsr()
    rows = (mean @ normal_rows) @ skin.rows
    centre, extent = skin.points.mean(axis=0), float(np.ptp(skin.points, axis=0).max())
    corners = (points[faces] - centre) / extent
    middles = 0.5 * (corners + np.roll(corners, 1, axis=1))  # three of them integrate quadratics
    moments = _quadratics(middles).mean(axis=1)
    wanted = (_quadratics((samples.positions - centre) / extent).T * weight) @ normal_rows @ skin.rows
    areas = _normals(points, faces)[1][:, None]
    lacking = wanted - moments.T @ (areas * rows)
    rows = rows + moments @ np.linalg.lstsq(moments.T @ (areas * moments), lacking, rcond=1e-9)[0]
    shares = {}
    for name, at in skin.surfaces.items():
        on = np.isin(samples.face, at)
        shares[name] = np.bincount(panel, weight * on, minlength=m) / held
    named = np.concatenate([np.zeros(0, dtype=np.intp), *skin.surfaces.values()])
    unnamed = np.bincount(panel, weight * ~np.isin(samples.face, named), minlength=m) / held
    return SkinPanels(points, faces, np.asarray(rows), shares, unnamed)


@dataclass(frozen=True, eq=False)
class _Samples:
    positions: Array
    normals: Array
    weights: Array
    interpolation: scipy.sparse.csr_matrix
    face: Index


def _triangles(skin: Skin) -> tuple[Array, Index]:
    """The faces' corners and middles of sides as triangles: four of a triangle, eight of a quadrilateral."""
    points, found = [skin.points], []
    count = len(skin.points)
    for at, n in by_size(skin.faces):
        f = skin.faces[at]
        if n == 6:
            for a, b, c in ((0, 3, 5), (3, 1, 4), (5, 4, 2), (3, 4, 5)):
                found.append(f[:, [a, b, c]])
            continue
        N = face_shapes(n, np.array([[0.5, 0.5]]))[0][0]
        points.append(np.einsum("k,fki->fi", N, skin.points[f[:, :n]]))
        middle = count + np.arange(len(f))
        count += len(f)
        ring = f[:, [0, 4, 1, 5, 2, 6, 3, 7]]
        for k in range(8):
            found.append(np.stack([ring[:, k], ring[:, (k + 1) % 8], middle], axis=1))
    return np.vstack(points), np.vstack(found)


def _samples(skin: Skin, size: float) -> _Samples:
    """Points of integration on the curved faces, close enough together for panels of that size."""
    positions, normals, weights, parts, owner = [], [], [], [], []
    for at, n in by_size(skin.faces):
        f = skin.faces[at, :n]
        p = skin.points[f]
        corners = p[:, : 3 if n == 6 else 4]
        longest = float(np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2).max())
        cells = max(1, int(np.ceil(CELLS * longest / size)))
        X, w = _cells(*face_points(n), cells, triangle=n == 6)
        N, gradient = face_shapes(n, X)
        tangents = np.einsum("fka,qkb->fqba", p, gradient, optimize=True)
        normal = np.cross(tangents[:, :, 0], tangents[:, :, 1]).reshape(-1, 3)
        area = np.linalg.norm(normal, axis=1)
        q = len(w)
        rows = np.repeat(np.arange(len(f) * q), n)
        columns = np.repeat(f, q, axis=0).ravel()
        positions.append(np.einsum("qk,fki->fqi", N, p).reshape(-1, 3))
        normals.append(normal / area[:, None])
        weights.append(area * np.tile(w, len(f)))
        parts.append(
            scipy.sparse.csr_matrix(
                (np.tile(N, (len(f), 1)).ravel(), (rows, columns)), (len(f) * q, len(skin.points))
            )
        )
        owner.append(np.repeat(at, q))
    return _Samples(
        np.vstack(positions),
        np.vstack(normals),
        np.concatenate(weights),
        scipy.sparse.vstack(parts).tocsr(),
        np.concatenate(owner),
    )


def _cells(X: Array, w: Array, cells: int, triangle: bool) -> tuple[Array, Array]:
    """A rule of the unit triangle or square repeated in each of cells² parts of it."""
    i, j = (g.ravel() for g in np.meshgrid(np.arange(cells), np.arange(cells), indexing="ij"))
    if not triangle:
        square = np.stack([i, j], axis=1)[:, None] + X[None]
        return square.reshape(-1, 2) / cells, np.tile(w, cells**2) / cells**2
    up, down = i + j < cells, i + j < cells - 1
    places = [
        (np.stack([i, j], axis=1)[up][:, None] + X[None]).reshape(-1, 2),
        (np.stack([i + 1, j + 1], axis=1)[down][:, None] - X[None]).reshape(-1, 2),
    ]
    return np.vstack(places) / cells, np.tile(w, cells**2) / cells**2


def _quadratics(x: Array) -> Array:
    """1, the coordinates and their products, (..., 10)."""
    a, b = np.triu_indices(3)
    return np.concatenate([np.ones((*x.shape[:-1], 1)), x, x[..., a] * x[..., b]], axis=-1)


def _normals(points: Array, faces: Index) -> tuple[Array, Array]:
    """Unit normals (m, 3) and areas (m,)."""
    p = points[faces]
    cross = np.cross(p[:, 1] - p[:, 0], p[:, 2] - p[:, 0])
    twice = np.linalg.norm(cross, axis=1)
    return cross / twice[:, None], 0.5 * twice


def _nearest(points: Array, faces: Index, samples: _Samples) -> tuple[Index, Array]:
    """The panel nearest to each sample among those that face its way, and its place there (q, 3)."""
    normals, areas = _normals(points, faces)
    corners = points[faces]
    k = min(NEAREST, len(faces))
    _, near = scipy.spatial.cKDTree(corners.mean(axis=1)).query(samples.positions, k=k)
    near = near.reshape(len(samples.positions), k)
    best = np.full(len(near), np.inf)
    panel = near[:, 0].copy()
    place = np.zeros((len(near), 3))
    for column in near.T:
        n, c = normals[column], corners[column]
        x = samples.positions - c[:, 0]
        off = np.einsum("qi,qi->q", x, n)
        # barycentric coordinates of the foot, and those of the nearest point of the panel, roughly
        phi = np.stack(
            [
                np.einsum(
                    "qi,qi->q",
                    np.cross(c[:, (a + 2) % 3] - c[:, (a + 1) % 3], samples.positions - c[:, (a + 1) % 3]),
                    n,
                )
                for a in range(3)
            ],
            axis=1,
        ) / (2.0 * areas[column][:, None])
        inside = np.clip(phi, 0.0, None)
        inside /= inside.sum(axis=1, keepdims=True)
        gap = np.linalg.norm(np.einsum("qa,qai->qi", inside, c) - samples.positions, axis=1)
        gap = np.maximum(gap, np.abs(off))
        gap[np.einsum("qi,qi->q", n, samples.normals) < FACING] = np.inf
        better = gap < best
        best[better], panel[better], place[better] = gap[better], column[better], inside[better]
    return panel, place


def _fitted(points: Array, faces: Index, samples: _Samples) -> Array:
    """Corners moved so that the panels lie nearest to the skin, in the mean of squares along the normals."""
    panel, place = _nearest(points, faces, samples)
    normals, areas = _normals(points, faces)
    n = normals[panel]
    foot = np.einsum("qa,qai->qi", place, points[faces[panel]])
    off = np.einsum("qi,qi->q", samples.positions - foot, n)
    root = np.sqrt(samples.weights)
    value = root[:, None, None] * place[:, :, None] * n[:, None]
    columns = 3 * faces[panel][:, :, None] + np.arange(3)
    A = scipy.sparse.csr_matrix(
        (value.ravel(), (np.repeat(np.arange(off.size), 9), columns.ravel())), (off.size, points.size)
    )
    held = np.repeat(np.bincount(faces.ravel(), np.repeat(areas / 3.0, 3), minlength=len(points)), 3)
    normal = (A.T @ A + scipy.sparse.diags(STIFF * held)).tocsc()
    moved = scipy.sparse.linalg.spsolve(normal, A.T @ (root * off))
    return np.asarray(points + moved.reshape(-1, 3))
