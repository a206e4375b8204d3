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

from bearingdyn.fem.meshes.solid_element import (
    BUBBLES,
    HEX20,
    HEX27,
    SolidElement,
    bubble_gradient,
    points,
    shapes,
)
from bearingdyn.fem.meshes.solid_mesh import SolidMesh
from bearingdyn.fem.node_pairs import NodePairs
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
        K, G = self.volumetric, self.deviatoric
        data = material.K * K.data + 2.0 * material.G * G.data  # both have the pattern of the node pairs
        return scipy.sparse.csr_matrix((data, K.indices.copy(), K.indptr.copy()), shape=K.shape)


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
        bricks its values at 2×2×2 points (selective integration). In 10-node tetrahedra, 15-node wedges and
        13-node pyramids an inner bubble takes the linear part away and the mean is kept (P2 with bubbles/P1,
        Crouzeix & Raviart, R.A.I.R.O. R3 (1973) 33, the bubble eliminated as if K were infinite, which at
        ν = 0.45 costs .1 % of a strip). A bonded ring of ν = 0.499 with 4×8×24 elements is within 0.2 % with
        27-node bricks and 3 % with 20-node ones; a bonded strip with two through its thickness within .5 %
        with wedges and 2 % with tetrahedra, with four within .3 %.

    Returns
    -------
    SolidMatrices
    """
    mass, (volumetric, deviatoric) = _gathered(mesh, elements, incompressible, None)
    return SolidMatrices(points=mesh.points, mass=mass, volumetric=volumetric, deviatoric=deviatoric)


def assemble_elastic(
    mesh: SolidMesh, elements: ArrayLike | None, material: Elastic, *, incompressible: bool = False
) -> tuple[scipy.sparse.csr_matrix, scipy.sparse.csr_matrix]:
    """Mass and stiffness of an elastic solid: what `assemble_solid` and its `stiffness` say, sooner.

    Parameters
    ----------
    mesh, elements
        As for `assemble_solid`.
    material
        Of these elements.
    incompressible
        As for `assemble_solid`.

    Returns
    -------
    tuple of scipy.sparse.csr_matrix
        (3n, 3n) mass, kg, and stiffness, N/m.
    """
    mass, (stiffness,) = _gathered(mesh, elements, incompressible, material)
    return material.density * mass, stiffness


def _gathered(
    mesh: SolidMesh, elements: ArrayLike | None, incompressible: bool, material: Elastic | None
) -> tuple[scipy.sparse.csr_matrix, list[scipy.sparse.csr_matrix]]:
    """Mass of unit density, and the two stiffnesses of unit moduli or, of a material, their sum."""
    chosen = np.arange(len(mesh.elements)) if elements is None else np.asarray(elements, dtype=np.intp)
    groups = []
    for kind, of_kind in mesh.groups:
        at = chosen[np.isin(chosen, of_kind)]
        groups += [(kind, mesh.elements[at[s : s + CHUNK], : kind.nodes]) for s in range(0, len(at), CHUNK)]
    pairs = NodePairs.of([nodes for _, nodes in groups], len(mesh.points))
    mass = np.zeros(pairs.size)
    stiffnesses = [pairs.zeros() for _ in range(2 if material is None else 1)]
    for place, (kind, nodes) in enumerate(groups):
        m, *stiff = _element_matrices(kind, mesh.points[nodes], incompressible, material)
        mass += np.bincount(pairs.where[place], m.ravel(), pairs.size)
        for sums, A in zip(stiffnesses, stiff, strict=True):
            pairs.add(sums, place, A)
    return pairs.alike(mass), [pairs.matrix(sums) for sums in stiffnesses]


def _element_matrices(
    kind: SolidElement, p: Array, incompressible: bool, material: Elastic | None
) -> tuple[Array, ...]:
    """Mass (m, k, k) of a component, volumetric and deviatoric stiffness (m, 3k, 3k); p: (m, k, 3) nodes.

    Of a material the stiffness takes the place of the two.
    """
    X, w = points(kind)
    N = shapes(kind, X)[0]
    D, dV = gradients(kind, p, X, w)
    mass = np.einsum("mq,qi,qj->mij", dV, N, N, optimize=True)
    bubbled = incompressible and kind in BUBBLES
    if bubbled:
        D, dV, follow = _with_bubble(kind, p)
    count, k = len(p), D.shape[1] // 3
    full = ((D * dV[:, None, :]) @ D.transpose(0, 2, 1)).reshape(count, k, 3, k, 3)  # ∫∂aNi ∂bNj
    # e:e = ½ ∂aui ∂aui + ½ ∂aui ∂iua − ⅓ (div u)²
    if material is not None and not incompressible:
        stiffness = material.G * full.transpose(0, 1, 4, 3, 2)
        laplace = material.G * np.einsum("micjc->mij", full)
        for a in range(3):
            stiffness[:, :, a, :, a] += laplace
        full *= material.K - 2.0 / 3.0 * material.G
        stiffness += full
        return mass, stiffness.reshape(count, 3 * k, 3 * k)
    deviatoric = 0.5 * full.transpose(0, 1, 4, 3, 2) - full / 3.0
    laplace = 0.5 * np.einsum("micjc->mij", full)
    for a in range(3):
        deviatoric[:, :, a, :, a] += laplace
    deviatoric = deviatoric.reshape(count, 3 * k, 3 * k)
    volumetric = full.reshape(count, 3 * k, 3 * k)
    if incompressible and kind is HEX20:
        D, dV = gradients(kind, p, *points(kind, reduced=True))
        volumetric = (D * dV[:, None, :]) @ D.transpose(0, 2, 1)
    elif incompressible:
        basis = pressure_modes(kind, p, X, N, dV)  # (m, q, modes)
        d = (D * dV[:, None, :]) @ basis  # ∫ div N_i p_j
        gram = basis.transpose(0, 2, 1) @ (dV[:, :, None] * basis)
        volumetric = d @ np.linalg.solve(gram, d.transpose(0, 2, 1))
        volumetric = 0.5 * (volumetric + volumetric.transpose(0, 2, 1))
    if bubbled:
        back = follow.transpose(0, 2, 1)
        volumetric, deviatoric = back @ volumetric @ follow, back @ deviatoric @ follow
    if material is not None:
        return mass, material.K * volumetric + 2.0 * material.G * deviatoric
    return mass, volumetric, deviatoric


def _with_bubble(kind: SolidElement, p: Array) -> tuple[Array, Array, Array]:
    """An element with one node more, whose bubble moves so that div u keeps no linear part.

    The bubble b(x) vanishes on the faces, so that no neighbour feels it. Of div u the moments about the
    middle of the element, d (3 k, 3) by the nodes' motions, are undone by those of the bubble's, d_b (3, 3),
    which are −∫b times unity.

    Returns
    -------
    D, dV
        As `gradients`, the bubble behind the nodes; (m, 3 k + 3, q) and (m, q).
    follow
        (m, 3 k + 3, 3 k) motions of nodes and bubble by those of the nodes.
    """
    D, dV, b, x = bubble_gradients(kind, p)
    b, x = b.transpose(0, 2, 1), x * dV[:, :, None]
    d, d_b = D @ x, b @ x
    carried = -np.linalg.solve(d_b.transpose(0, 2, 1), d.transpose(0, 2, 1))
    unity = np.broadcast_to(np.eye(D.shape[1]), (len(p), D.shape[1], D.shape[1]))
    return np.concatenate([D, b], axis=1), dV, np.concatenate([unity, carried], axis=1)


def bubble_gradients(kind: SolidElement, p: Array) -> tuple[Array, Array, Array, Array]:
    """What an inner bubble of elements with nodes p (m, k, 3) needs, at the finer points of integration.

    Returns
    -------
    D, dV
        As `gradients`; (m, 3 k, q) and (m, q).
    b
        (m, q, 3) gradient of the bubble.
    x
        (m, q, 3) the points from the middle of their element, in which a linear part is linear.
    """
    X, w = points(kind, fine=True)
    D, dV = gradients(kind, p, X, w)
    N, reference = shapes(kind, X)
    J = np.einsum("mka,qkb->mqab", p, reference, optimize=True)
    b = np.einsum("qb,mqba->mqa", bubble_gradient(kind, X), np.linalg.inv(J), optimize=True)
    x = N @ p
    return D, dV, b, x - (dV[:, None, :] @ x) / dV.sum(axis=1)[:, None, None]


def gradients(kind: SolidElement, p: Array, X: Array, w: Array) -> tuple[Array, Array]:
    """∂N_i/∂x_a at points X (q, 3), (m, 3 k, q) with 3 i + a the row, and weights times volume (m, q)."""
    reference = shapes(kind, X)[1]  # (q, k, 3)
    J = np.einsum("mka,qkb->mqab", p, reference, optimize=True)
    det, inverse = _inverted(J)
    D = reference[None] @ inverse  # (m, q, k, 3): ∂N/∂ξ_b ∂ξ_b/∂x_a
    return D.reshape(len(p), len(w), -1).transpose(0, 2, 1), det * w


def _inverted(J: Array) -> tuple[Array, Array]:
    """Determinants (…,) and inverses (…, 3, 3) of many 3×3 matrices: a tenth of LAPACK's time for each."""
    a, b, c = (J[..., i, :] for i in range(3))
    adjugate = np.stack([np.cross(b, c), np.cross(c, a), np.cross(a, b)], axis=-1)
    det = np.einsum("...a,...a->...", a, adjugate[..., 0])
    return det, adjugate / det[..., None, None]


def pressure_modes(kind: SolidElement, p: Array, X: Array, N: Array, dV: Array) -> Array:
    """Functions that keep the pressure of nearly incompressible elements, (m, q, modes).

    1 in 27-node bricks and x, y, z, in the place itself, not on the unit element: there a skewed one would
    lose an order (Arnold, Boffi & Falk, SIAM J. Numer. Anal. 42 (2005) 2429). Scaled by the edges. 1 alone
    where a bubble has taken x, y and z.
    """
    one = np.ones((*dV.shape, 1))
    if kind is not HEX27:
        return one
    centre = kind.places[: len(kind.corners)].mean(axis=0)[None]
    J = np.einsum("mka,qkb->mab", p, shapes(kind, centre)[1])
    x = N @ p - (shapes(kind, centre)[0] @ p)
    return np.concatenate([one, np.linalg.solve(J, x.transpose(0, 2, 1)).transpose(0, 2, 1)], axis=2)
