"""Three-dimensional solids: second-order elements, assembled with volume and shape change apart.

An isotropic stiffness is K ∫(Π div u)(Π div v) + 2G ∫ e(u):e(v), with K the bulk and G the shear modulus and
e the deviatoric strain. Both integrals are assembled once, at unit modulus; a viscoelastic region needs them
apart (paper (13), (16)). Π is the identity for compressible materials. As ν → ½ an element with Π = 1 locks,
for its displacements cannot keep every point's volume, and Π takes part of div u only.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.sparse
from numpy.typing import ArrayLike

from bearingdyn.fem.meshes.solid_element import HEX20, HEX27, WEDGE15, SolidElement, points, shapes
from bearingdyn.fem.meshes.solid_mesh import SolidMesh
from bearingdyn.material import Elastic
from bearingdyn.short_repr import short
from bearingdyn.types import Array

CHUNK = 1024  # elements whose matrices are in memory at a time, 54 MB a matrix of 27-node bricks


@dataclass(frozen=True, eq=False, kw_only=True)
class SolidMatrices:
    """Matrices of a solid of unit moduli; coordinate 3 i + a is the displacement of node i along axis a.

    Parameters
    ----------
    points
        (n, 3) node positions, m.
    mass
        (3n, 3n) ∫NᵀN dV, m³, to be multiplied by the density.
    volumetric
        (3n, 3n) ∫BᵀmmᵀB dV, m, by the bulk modulus.
    deviatoric
        (3n, 3n) ∫BᵀT2B dV, m, by 2G.
    """

    points: Array
    mass: scipy.sparse.csr_matrix
    volumetric: scipy.sparse.csr_matrix
    deviatoric: scipy.sparse.csr_matrix

    __repr__ = short

    def stiffness(self, material: Elastic) -> scipy.sparse.csr_matrix:
        """Stiffness of an elastic material, (3n, 3n), N/m."""
        return scipy.sparse.csr_matrix(material.K * self.volumetric + 2.0 * material.G * self.deviatoric)


def assemble_solid(
    mesh: SolidMesh, elements: ArrayLike | None = None, *, incompressible: bool = False
) -> SolidMatrices:
    """Matrices of a solid mesh, or of some of its elements, isoparametric.

    Integration: 3×3×3 points in bricks, exact for straight-sided ones; order 4 in tetrahedra; in wedges and
    pyramids as `solid_element.points` says.

    Parameters
    ----------
    mesh
        The solid.
    elements
        Indices of the region to assemble; None: all. The nodes are numbered as for the whole mesh.
    incompressible
        Take from div u only what the element can keep as ν → ½: in 27-node bricks its part linear in each
        element (Q2/P1, the pressure condensed; Hughes, The Finite Element Method, 1987, ch. 4), in 20-node
        bricks its values at 2×2×2 points (selective integration), in 10-node tetrahedra and 13-node pyramids
        its mean (P2/P0: free of locking, but too soft, and of first order), in 15-node wedges its part
        linear along the axis, too soft as well. A bonded ring of ν = 0.499 with 4×8×24 elements is within
        0.2 % with 27-node bricks and 3 % with 20-node ones; a bonded strip with two tetrahedra through its
        thickness is 7 % too soft, with six 3 %; with two wedges 22 % or less, as they lie, with four 10 %.

    Returns
    -------
    SolidMatrices
    """
    chosen = np.arange(len(mesh.elements)) if elements is None else np.asarray(elements, dtype=np.intp)
    n = len(mesh.points)
    groups = []
    for kind, of_kind in mesh.groups:
        at = chosen[np.isin(chosen, of_kind)]
        groups += [(kind, mesh.elements[at[s : s + CHUNK], : kind.nodes]) for s in range(0, len(at), CHUNK)]
    keys = [(nodes[:, :, None] * n + nodes[:, None, :]).ravel() for _, nodes in groups]
    pairs, where = np.unique(np.concatenate(keys), return_inverse=True)
    where = where.ravel()
    size, start = pairs.size, 0
    mass = np.zeros(size)
    blocks = np.zeros((2, 3, 3, size))  # volumetric and deviatoric, by axes, over pairs of nodes
    for kind, nodes in groups:
        k = kind.nodes
        place = where[start : start + nodes.size * k]
        start += place.size
        m, *stiff = _element_matrices(kind, mesh.points[nodes], incompressible)
        mass += np.bincount(place, m.ravel(), size)
        for sums, A in zip(blocks, stiff, strict=True):
            by_axes = A.reshape(-1, k, 3, k, 3).transpose(2, 4, 0, 1, 3)
            for a in range(3):
                for b in range(3):
                    sums[a, b] += np.bincount(place, by_axes[a, b].ravel(), size)

    row, column = pairs // n, pairs % n
    indptr = np.concatenate([[0], np.cumsum(np.bincount(row, minlength=n))])

    def block_matrix(values: Array) -> scipy.sparse.csr_matrix:
        data = np.ascontiguousarray(values.transpose(2, 0, 1))
        return scipy.sparse.bsr_matrix((data, column, indptr), shape=(3 * n, 3 * n)).tocsr()

    masses = block_matrix(mass * np.eye(3)[:, :, None])
    masses.eliminate_zeros()
    return SolidMatrices(
        points=mesh.points,
        mass=masses,
        volumetric=block_matrix(blocks[0]),
        deviatoric=block_matrix(blocks[1]),
    )


def _element_matrices(kind: SolidElement, p: Array, incompressible: bool) -> tuple[Array, Array, Array]:
    """Mass (m, k, k) of a component, volumetric and deviatoric stiffness (m, 3k, 3k); p: (m, k, 3) nodes."""
    X, w = points(kind)
    N = shapes(kind, X)[0]
    D, dV = _gradients(kind, p, X, w)
    count, k = len(p), kind.nodes
    mass = np.einsum("mq,qi,qj->mij", dV, N, N, optimize=True)
    full = ((D * dV[:, None, :]) @ D.transpose(0, 2, 1)).reshape(count, k, 3, k, 3)  # ∫∂aNi ∂bNj
    # e:e = ½ ∂aui ∂aui + ½ ∂aui ∂iua − ⅓ (div u)²
    deviatoric = 0.5 * full.transpose(0, 1, 4, 3, 2) - full / 3.0
    laplace = 0.5 * np.einsum("micjc->mij", full)
    for a in range(3):
        deviatoric[:, :, a, :, a] += laplace
    volumetric = full.reshape(count, 3 * k, 3 * k)
    if incompressible and kind is HEX20:
        D, dV = _gradients(kind, p, *points(kind, reduced=True))
        volumetric = (D * dV[:, None, :]) @ D.transpose(0, 2, 1)
    elif incompressible:
        basis = _pressures(kind, p, X, N)  # (m, q, modes)
        d = (D * dV[:, None, :]) @ basis  # ∫ div N_i p_j
        gram = basis.transpose(0, 2, 1) @ (dV[:, :, None] * basis)
        volumetric = d @ np.linalg.solve(gram, d.transpose(0, 2, 1))
        volumetric = 0.5 * (volumetric + volumetric.transpose(0, 2, 1))
    return mass, volumetric, deviatoric.reshape(count, 3 * k, 3 * k)


def _gradients(kind: SolidElement, p: Array, X: Array, w: Array) -> tuple[Array, Array]:
    """∂N_i/∂x_a at points X (q, 3), (m, 3 k, q) with 3 i + a the row, and weights times volume (m, q)."""
    reference = shapes(kind, X)[1]  # (q, k, 3)
    J = np.einsum("mka,qkb->mqab", p, reference, optimize=True)
    D = reference[None] @ np.linalg.inv(J)  # (m, q, k, 3): ∂N/∂ξ_b ∂ξ_b/∂x_a
    return D.reshape(len(p), len(w), -1).transpose(0, 2, 1), np.linalg.det(J) * w


def _pressures(kind: SolidElement, p: Array, X: Array, N: Array) -> Array:
    """Functions that keep the pressure of nearly incompressible elements, (m, q, modes).

    1 in tetrahedra and pyramids, 1 and z in wedges, 1, x, y, z in bricks, in the place itself, not on the
    unit element: there a skewed one would lose an order (Arnold, Boffi & Falk, SIAM J. Numer. Anal. 42 (2005)
    2429). Scaled by the edges. In a wedge x and y would keep all of div u in its triangles, and lock.
    """
    one = np.ones((len(p), len(X), 1))
    if kind not in (HEX27, WEDGE15):
        return one
    centre = kind.places[: len(kind.corners)].mean(axis=0)[None]
    J = np.einsum("mka,qkb->mab", p, shapes(kind, centre)[1])
    x = N @ p - (shapes(kind, centre)[0] @ p)
    place = np.linalg.solve(J, x.transpose(0, 2, 1)).transpose(0, 2, 1)
    return np.concatenate([one, place if kind is HEX27 else place[..., 2:]], axis=2)
