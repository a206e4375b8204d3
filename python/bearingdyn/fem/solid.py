"""Three-dimensional solids: second-order bricks of scikit-fem, assembled with volume and shape change apart.

An isotropic stiffness is K ∫(div u)(div v) + 2G ∫ e(u):e(v), with K the bulk and G the shear modulus and e
the deviatoric strain. Both integrals are assembled once, at unit modulus; a viscoelastic region needs them
apart (paper (13), (16)).
"""

from __future__ import annotations

import itertools
import math
from dataclasses import dataclass
from typing import Any

import numpy as np
import scipy.sparse
from numpy.typing import ArrayLike, NDArray
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree

from bearingdyn.material import Elastic

Float = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class SolidMatrices:
    """Unit matrices of a solid; coordinate 3 i + a is the displacement of node i along axis a.

    points: (n, 3) node positions, m. mass: (3n, 3n) ∫NᵀN dV, m³, to be multiplied by the density.
    volumetric: (3n, 3n) ∫BᵀmmᵀB dV, m, by the bulk modulus. deviatoric: (3n, 3n) ∫BᵀT2B dV, m, by 2G.
    """

    points: Float
    mass: scipy.sparse.csr_matrix
    volumetric: scipy.sparse.csr_matrix
    deviatoric: scipy.sparse.csr_matrix

    def stiffness(self, material: Elastic) -> scipy.sparse.csr_matrix:
        """Stiffness of an elastic material, (3n, 3n), N/m."""
        return scipy.sparse.csr_matrix(material.K * self.volumetric + 2.0 * material.G * self.deviatoric)


def assemble_solid(mesh: Any, elements: ArrayLike | None = None) -> SolidMatrices:
    """Matrices of a scikit-fem mesh of bricks (20-node serendipity) or tetrahedra (10-node).

    mesh: skfem MeshHex, MeshHex2, MeshTet or MeshTet2; the second-order ones carry curved faces.
    elements: indices of the region to assemble (default all); the nodes are numbered as for the whole mesh.

    Raises ValueError for another kind of mesh, or a mesh with an element turned inside out.
    """
    import skfem

    if isinstance(mesh, skfem.MeshHex):
        element: Any = skfem.ElementHexS2()
        if isinstance(mesh, skfem.MeshHex2):
            mesh = _isoparametric(mesh)
    elif isinstance(mesh, skfem.MeshTet):
        element = skfem.ElementTetP2()
    else:
        raise ValueError(f"mesh is a {type(mesh).__name__}; it must be a MeshHex or MeshTet of scikit-fem")
    # order 4 is 3 x 3 x 3 points in a brick: exact for a straight-sided one
    basis = skfem.Basis(mesh, element, intorder=4, elements=elements)
    nodes = basis.element_dofs.T  # (elements, nodes of an element)
    count, per = nodes.shape
    det = np.asarray(basis.mapping.detDF(basis.X, basis.tind)).reshape(count, -1)
    bad = np.flatnonzero(~(np.all(det > 0, axis=1) | np.all(det < 0, axis=1)))
    if bad.size:
        raise ValueError(f"mesh element {bad[0]} is turned inside out; check its nodes or refine the mesh")
    value = np.stack([np.asarray(b[0]) for b in basis.basis])  # (per, elements, points)
    grad = np.stack([np.asarray(b[0].grad) for b in basis.basis])  # (per, 3, elements, points)

    N = value.transpose(1, 0, 2)
    m = (N * basis.dx[:, None, :]) @ N.transpose(0, 2, 1)
    D = grad.transpose(2, 0, 1, 3).reshape(count, 3 * per, -1)
    vol = ((D * basis.dx[:, None, :]) @ D.transpose(0, 2, 1)).reshape(count, per, 3, per, 3)  # ∂aNi ∂bNj
    laplace = np.einsum("eicjc->eij", vol)
    dev = 0.5 * vol.transpose(0, 1, 4, 3, 2) - vol / 3.0
    for a in range(3):
        dev[:, :, a, :, a] += 0.5 * laplace

    n = int(basis.N)
    at = (3 * nodes[:, :, None] + np.arange(3)).reshape(count, 3 * per)

    def assembled(blocks: Float, index: NDArray[Any], size: int) -> scipy.sparse.csr_matrix:
        k = index.shape[1]
        rows, columns = np.repeat(index, k, axis=1).ravel(), np.tile(index, (1, k)).ravel()
        A = scipy.sparse.csr_matrix((blocks.ravel(), (rows, columns)), shape=(size, size))
        return scipy.sparse.csr_matrix(0.5 * (A + A.T))

    return SolidMatrices(
        points=np.ascontiguousarray(basis.doflocs.T),
        mass=scipy.sparse.csr_matrix(scipy.sparse.kron(assembled(m, nodes, n), scipy.sparse.eye(3))),
        volumetric=assembled(vol, at, 3 * n),
        deviatoric=assembled(dev, at, 3 * n),
    )


def serendipity_faces(mesh: Any) -> tuple[Float, Float, Float, Float, NDArray[np.intp], int]:
    """Integration points of the boundary faces of a mesh of bricks, face by face.

    Returns shape functions (m, 20, q), outward normals (m, q, 3), positions (m, q, 3), m, weights (m, q), m²,
    the nodes (m, 20) of the brick behind each face, and the number of nodes.
    """
    import skfem

    if isinstance(mesh, skfem.MeshHex2):
        mesh = _isoparametric(mesh)
    basis = skfem.FacetBasis(mesh, skfem.ElementHexS2(), intorder=4)
    return (
        np.stack([np.asarray(b[0]) for b in basis.basis], axis=1),
        np.asarray(basis.normals).transpose(1, 2, 0),
        np.asarray(basis.global_coordinates()).transpose(1, 2, 0),
        np.asarray(basis.dx),
        np.asarray(basis.element_dofs).T,
        int(basis.N),
    )


def _isoparametric(mesh: Any) -> Any:
    """The 27-node geometry of a MeshHex2 with face and body centres where the 20-node shapes put them.

    The displacement shapes then contain the geometry, without which a rotation would strain the element.
    """
    import skfem

    serendipity, full = skfem.ElementHexS2(), skfem.ElementHex2()
    weight = np.stack([serendipity.lbasis(full.doflocs.T, i)[0] for i in range(20)], axis=1)  # (27, 20)
    vertices = np.ascontiguousarray(mesh.doflocs[:, : mesh.nvertices])
    nodes = skfem.Dofs(skfem.MeshHex(vertices, mesh.t), full).element_dofs
    p = mesh.doflocs.copy()
    p[:, nodes[20:]] = np.einsum("ji,aie->aje", weight[20:], p[:, nodes[:20]])
    return skfem.MeshHex2(p, mesh.t)


def _lines(stops: list[float], size: float, least: int = 1) -> Float:
    """Grid lines through all stops, no step longer than size, at least ``least`` steps between two stops."""
    sorted_stops = np.unique(np.round(np.array(stops), 12))
    parts = [sorted_stops[:1]]
    for a, b in itertools.pairwise(sorted_stops):
        parts.append(np.linspace(a, b, max(least, math.ceil((b - a) / size - 1e-9)) + 1)[1:])
    return np.concatenate(parts)


def _patch(x: Float, y: Float) -> tuple[Float, NDArray[np.intp]]:
    """Points (k, 2) and quadrilaterals (m, 4) of a structured grid; x and y are (rows, columns)."""
    i = np.arange(x.size).reshape(x.shape)
    quads = np.stack([i[:-1, :-1], i[:-1, 1:], i[1:, 1:], i[1:, :-1]], axis=-1).reshape(-1, 4)
    return np.stack([x.ravel(), y.ravel()], axis=-1), quads


def _merged(
    patches: list[tuple[Float, NDArray[np.intp]]], tolerance: float
) -> tuple[Float, NDArray[np.intp]]:
    """One list of points and quadrilaterals; points within the tolerance become one."""
    offsets = np.cumsum([0] + [len(p) for p, _ in patches])
    points = np.vstack([p for p, _ in patches])
    quads = np.vstack([q + o for (_, q), o in zip(patches, offsets[:-1], strict=True)])
    pairs = cKDTree(points).query_pairs(tolerance, output_type="ndarray")
    graph = scipy.sparse.coo_matrix(
        (np.ones(len(pairs)), (pairs[:, 0], pairs[:, 1])), shape=(len(points), len(points))
    )
    count, label = connected_components(graph, directed=False)
    unique = np.zeros((count, 2))
    unique[label] = points
    return unique, label[quads]


def block_with_bore(
    width: float,
    height: float,
    length: float,
    bore_diameter: float,
    bore_height: float,
    element_size: float,
    flange: tuple[float, float] | None = None,
    strip: float | None = None,
) -> Any:
    """Structured mesh of bricks of a block with a round bore through it along z, as a skfem MeshHex2.

    width along x, height along y, length along z, m; the origin is on the bore's axis at mid-length.
    bore_height: of the axis above the base. element_size: longest wanted side, m.
    flange: (width, height) of two flanges on the sides at the base. strip: a grid line runs this far in from
    either side, along the base. The bore is round: its nodes lie on the circle and its edges are quadratic.
    The measures are taken to be consistent (parts.Housing checks them).
    """
    import skfem

    r, half, base, top = 0.5 * bore_diameter, 0.5 * width, -bore_height, height - bore_height
    low = base if bore_height - top < element_size else -top  # a box about the bore, the pedestal below it
    x = _lines([-half, 0.0, half] + ([strip - half, half - strip] if strip else []), element_size, 2)
    shelf = [base + flange[1]] if flange else []
    y = _lines([low, 0.0, top, *(s for s in shelf if low < s < top)], element_size, 2)
    layers = max(2, round((math.sqrt(width * (top - low) / math.pi) - r) / element_size))
    patches = []
    t = np.linspace(1.0, 0.0, layers + 1)[:, None]  # inward, so that all patches turn the same way
    for px, py in (
        (x, np.full_like(x, low)),
        (np.full_like(y, half), y),
        (x[::-1], np.full_like(x, top)),
        (np.full_like(y, -half), y[::-1]),
    ):
        rho = np.hypot(px, py)
        patches.append(_patch(px * (t + (1.0 - t) * r / rho), py * (t + (1.0 - t) * r / rho)))
    side = y
    if low > base:
        below = _lines([base, low, *(s for s in shelf if base < s < low)], element_size)
        patches.append(_patch(*np.meshgrid(x, below)))
        side = np.concatenate([below[:-1], y])
    if flange:
        out = _lines([half, half + flange[0]], element_size)
        foot = side[side <= shelf[0] + 1e-9 * height]
        patches += [_patch(*np.meshgrid(out, foot)), _patch(*np.meshgrid(-out[::-1], foot))]
    plane, quads = _merged(patches, 1e-6 * element_size)
    z = _lines([-0.5 * length, 0.5 * length], element_size, 2)

    points = np.hstack([np.tile(plane, (len(z), 1)), np.repeat(z, len(plane))[:, None]])
    lower = (quads[None] + len(plane) * np.arange(len(z) - 1)[:, None, None]).reshape(-1, 4)
    upper = lower + len(plane)
    # skfem's brick: vertices at (1,1,1) (1,1,0) (1,0,1) (0,1,1) (1,0,0) (0,1,0) (0,0,1) (0,0,0)
    ends = ((1, 2), (0, 2), (1, 1), (1, 3), (0, 1), (0, 3), (1, 0), (0, 0))
    corner = np.array([(lower, upper)[end][:, i] for end, i in ends])
    mesh = skfem.MeshHex2.from_mesh(skfem.MeshHex(np.ascontiguousarray(points.T), corner))
    p = mesh.doflocs.copy()
    rho = np.hypot(p[0], p[1])
    inside = rho < r * (1.0 + 1e-9)  # nodes on the bore, and the middles of its chords
    p[:2, inside] *= r / rho[inside]
    return skfem.MeshHex2(p, mesh.t)
