"""The outline of a solid: the faces of its elements on the boundary, as triangles."""

from __future__ import annotations

import numpy as np
import scipy

from bearingdyn.fem import SolidMesh, by_size, face_shapes
from bearingdyn.parts.outline import Outline
from bearingdyn.types import Array


def solid_outline(mesh: SolidMesh, shapes: Array) -> Outline:
    """The outline of a solid, each face of the boundary as triangles around its middle.

    Parameters
    ----------
    mesh
        The solid's mesh.
    shapes
        (3 nodes, m) motions of the nodes by the coordinates of the superelement.
    """
    p, boundary = mesh.points, mesh.boundary
    used, index = np.unique(boundary, return_inverse=True)
    index = index.reshape(boundary.shape)
    # weight of every node in every point: the nodes themselves, and the shape functions at the middles
    parts, faces, count = [scipy.sparse.eye(len(p), format="csr")[used]], [], used.size
    for rows, n in by_size(boundary):
        f, corners = rows.size, 3 if n == 6 else 4
        around = np.arange(2 * corners).reshape(2, -1).T.ravel()  # corner, middle of the side, corner, ...
        ring = index[rows][:, around]
        middle = np.broadcast_to(count + np.arange(f)[:, None], ring.shape)
        N = face_shapes(n, np.full((1, 2), 0.5 if corners == 4 else 1.0 / 3.0))[0]
        at = (np.repeat(np.arange(f), n), boundary[rows, :n].ravel())
        parts.append(scipy.sparse.csr_matrix((np.tile(N[0], f), at), shape=(f, len(p))))
        faces.append(np.stack([ring, np.roll(ring, -1, axis=1), middle], axis=-1).reshape(-1, 3))
        count += f
    W = scipy.sparse.vstack(parts)
    return Outline(W @ p, np.vstack(faces), scipy.sparse.kron(W, scipy.sparse.eye(3)) @ shapes)
