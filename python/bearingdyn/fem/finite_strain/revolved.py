"""Bodies of revolution in a deformed state: axisymmetric statics, and harmonics of a small motion about it.

The frame is (r, θ, z). Order n moves by u_r = U cos nφ, u_θ = V sin nφ, u_z = W cos nφ as in
fem.revolution; the harmonics of one order see a state that does not depend on φ and is not twisted, so they
stay apart.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np
import scipy

from bearingdyn.fem.finite_strain.deformed import CURRENT, Deformed
from bearingdyn.fem.meshes.quadrilateral_element import shape_functions
from bearingdyn.fem.meshes.revolution_mesh import RevolutionMesh
from bearingdyn.fem.revolution_harmonics import AXIAL, Harmonic, Pattern, gathered_harmonic, pattern
from bearingdyn.material import Hyperelastic
from bearingdyn.types import Array, Index


@dataclass(frozen=True, eq=False)
class RevolvedElements:
    """Elements of a revolved body at finite strain, before its deformation.

    Parameters
    ----------
    mesh
        Undeformed.
    laws
        Of each region, for a shear modulus of one.
    shear, bulk
        Of each region, Pa.
    """

    mesh: RevolutionMesh
    laws: Sequence[Hyperelastic]
    shear: Sequence[float]
    bulk: Sequence[float]

    @cached_property
    def _shapes(self) -> tuple[Array, Array, Array, Array]:
        """N and its derivatives at the points of an element (9, 9), and the weights (9,)."""
        x, w = np.polynomial.legendre.leggauss(3)
        return (*shape_functions(np.repeat(x, 3), np.tile(x, 3)), np.outer(w, w).ravel())

    def _at_points(self, r: Array, z: Array) -> tuple[Array, Array, Array]:
        """Radius (m, q), and Jacobians (m, q, 2, 2) of (r, z) by (ξ, η) with their determinants."""
        N, N_xi, N_eta, _ = self._shapes
        nodes = np.stack([r[self.mesh.elements], z[self.mesh.elements]])
        jacobian = np.stack([nodes @ N_xi.T, nodes @ N_eta.T], axis=-1)  # (2, m, q, 2)
        jacobian = jacobian.transpose(1, 2, 0, 3)
        return nodes[0] @ N.T, jacobian, np.linalg.det(jacobian)

    @cached_property
    def _reference(self) -> tuple[Array, Array, Array]:
        return self._at_points(self.mesh.r, self.mesh.z)

    @cached_property
    def weights(self) -> Array:
        """Reference volume of each point (m, q), m³."""
        r, _, det = self._reference
        return np.asarray(2.0 * np.pi * det * self._shapes[3] * r)

    @cached_property
    def modes(self) -> Array:
        """1, r and z at the points, as fem.revolution takes the pressure, (m, q, 3)."""
        r, _, det = self._reference
        z = self.mesh.z[self.mesh.elements] @ self._shapes[0].T
        size = np.sqrt(det.sum(axis=1, keepdims=True))
        middle = [c.mean(axis=1, keepdims=True) for c in (r, z)]
        return np.stack([np.ones_like(r), (r - middle[0]) / size, (z - middle[1]) / size], axis=-1)

    @cached_property
    def _groups(self) -> list[tuple[Index, Hyperelastic]]:
        distinct = list(dict.fromkeys(self.laws))
        owner = np.array([distinct.index(law) for law in self.laws])[self.mesh.region]
        return [(np.flatnonzero(owner == i), law) for i, law in enumerate(distinct)]

    @cached_property
    def axial(self) -> tuple[Pattern, Index]:
        """Pattern of the coordinates (U, W) of all nodes, and those not on the axis."""
        on_axis = self.mesh.r <= 1e-9 * self.mesh.size
        kept = np.stack([~on_axis, np.ones_like(on_axis)], axis=1)
        return pattern(self.mesh, 2), np.flatnonzero(kept.ravel())

    def state(self, u: Array) -> RevolvedState:
        """The body displaced by u (2 nodes,): U and W of each node in turn."""
        return RevolvedState(self, u.reshape(-1, 2))

    def deformed(self, u: Array) -> tuple[Deformed, Array, Array]:
        """Elements whose nodes moved by u (nodes, 2); ∂N/∂(r, z) (m, q, 9, 2) and the radius (m, q) then."""
        R, J0, _ = self._reference
        shift, J_u, _ = self._at_points(u[:, 0], u[:, 1])
        F = np.zeros((*R.shape, 3, 3))
        # from displacements, not places: the bulk modulus multiplies what places lose to round-off
        F[..., ::2, ::2] = J_u @ np.linalg.inv(J0)
        F[..., 1, 1] = shift / R
        F += np.eye(3)
        now, J = R + shift, J0 + J_u
        _, N_xi, N_eta, _ = self._shapes
        with np.errstate(all="ignore"):
            gradient = np.stack([N_xi, N_eta], axis=-1) @ _inverse(J)
        state = Deformed(
            F=F,
            weights=self.weights,
            modes=self.modes,
            laws=self._groups,
            shear=np.asarray(self.shear, dtype=np.float64)[self.mesh.region],
            bulk=np.asarray(self.bulk, dtype=np.float64)[self.mesh.region],
        )
        return state, gradient, now


def _inverse(J: Array) -> Array:
    """Inverses of 2×2 matrices; no error for singular ones, which a trial step may make."""
    det = J[..., 0, 0] * J[..., 1, 1] - J[..., 0, 1] * J[..., 1, 0]
    adjugate = np.stack([J[..., 1, 1], -J[..., 0, 1], -J[..., 1, 0], J[..., 0, 0]], axis=-1)
    return np.asarray((adjugate / det[..., None]).reshape(J.shape))


@dataclass(frozen=True, eq=False)
class RevolvedState:
    """State of a revolved body at finite strain.

    Parameters
    ----------
    body
        The elements before deformation.
    u
        (nodes, 2) displacement of the nodes along r and z, m.
    """

    body: RevolvedElements
    u: Array

    @property
    def r(self) -> Array:
        """Where the nodes are now, (nodes,), m."""
        return self.body.mesh.r + self.u[:, 0]

    @property
    def z(self) -> Array:
        """Where the nodes are now, (nodes,), m."""
        return self.body.mesh.z + self.u[:, 1]

    @cached_property
    def _deformed(self) -> tuple[Deformed, Array, Array]:
        return self.body.deformed(self.u)

    @property
    def elements(self) -> Deformed:
        """Stress, stretch, pressure at the points."""
        return self._deformed[0]

    @property
    def volume_ratio(self) -> float:
        """The least of J at the points, of the section's own ratio, and of r."""
        J = self.elements.F
        plane = J[..., 0, 0] * J[..., 2, 2] - J[..., 0, 2] * J[..., 2, 0]
        return float(min(plane.min(), J[..., 1, 1].min()))

    def rows(self, order: int, components: tuple[int, ...]) -> Array:
        """B (m, q, 9, 9c): amplitudes of the spatial gradient l_rr, l_rθ, ..., l_zz of the nodal U, V, W."""
        _, gradient, r = self._deformed
        by_r = self.body._shapes[0] / r[:, :, None]
        d_r, d_z = gradient[..., 0], gradient[..., 1]
        B = np.zeros((*r.shape, 9, 9, 3))
        B[..., 0, :, 0], B[..., 2, :, 0] = d_r, d_z
        B[..., 1, :, 0], B[..., 1, :, 1] = -order * by_r, -by_r
        B[..., 3, :, 1], B[..., 5, :, 1] = d_r, d_z
        B[..., 4, :, 0], B[..., 4, :, 1] = by_r, order * by_r
        B[..., 6, :, 2], B[..., 8, :, 2] = d_r, d_z
        B[..., 7, :, 2] = -order * by_r
        return B[..., list(components)].reshape(*r.shape, 9, -1)

    @cached_property
    def _axial_rows(self) -> Array:
        return self.rows(0, AXIAL)

    @cached_property
    def force(self) -> Array:
        """Forces (2 nodes,) that hold the nodes where they are, on U and W, N."""
        f = self.elements.force(self._axial_rows).reshape(-1, 9, 2)
        total = [
            np.bincount(self.body.mesh.elements.ravel(), f[..., i].ravel(), len(self.u)) for i in range(2)
        ]
        return np.asarray(np.stack(total, axis=1).ravel(), dtype=np.float64)

    @property
    def pressures(self) -> Array:
        """Coefficients of the pressure in each element, Pa."""
        return self.elements.pressures

    def pressures_after(self, du: Array) -> Array:
        """Those that a further displacement (2 nodes,) leads to, linearised, Pa."""
        own = du.reshape(-1, 2)[self.body.mesh.elements].reshape(-1, 18)
        return self.elements.pressures_after(self._axial_rows, own)

    def tangent(self, pressures: Array | None = None) -> Any:
        """∂force/∂u, sparse (2 nodes, 2 nodes), N/m; its geometric part at given pressures, if any."""
        where, _ = self.body.axial
        K = self.elements.stiffness(self._axial_rows, pressures)
        data = where.add(K, self.body.mesh.region).sum(axis=0)
        n = self.u.size
        return scipy.sparse.csc_matrix((data, where.indices, where.indptr), shape=(n, n))

    @cached_property
    def mesh(self) -> RevolutionMesh:
        """The mesh in its deformed place."""
        return replace(self.body.mesh, r=self.r, z=self.z)

    def place(self, r: float, z: float) -> tuple[float, float]:
        """Where a point of the undeformed section is now, m; ValueError for one outside it."""
        mesh = self.body.mesh
        e, xi, eta = mesh.locate(r, z)
        N = shape_functions(np.array([xi]), np.array([eta]))[0][0]
        shift = N @ self.u[mesh.elements[e]]
        return r + float(shift[0]), z + float(shift[1])

    def harmonic(self, order: int, components: tuple[int, ...], branches: str = CURRENT) -> Harmonic:
        """Matrices of a small motion of one Fourier order about this state.

        K·volumetric + 2G·deviatoric, summed over the regions, is the static tangent at each region's own
        moduli: "deviatoric" is what the frequency changes and "volumetric" all the rest, over K.
        """
        mesh, region = self.mesh, self.body.mesh.region
        share = 1.0 if order == 0 else 0.5  # of ∫dφ over 2π
        B = self.rows(order, components)
        H = share * self.elements.deviatoric(B, branches)
        shear, bulk = (np.asarray(v, dtype=np.float64)[region] for v in (self.body.shear, self.body.bulk))
        rest = share * self.elements.stiffness(B) - 2.0 * shear[:, None, None] * H
        N = self.body._shapes[0]
        mass = np.einsum("eq,qa,qb->eab", share * self.body.weights, N, N, optimize=True)
        return gathered_harmonic(mesh, order, components, mass, rest / bulk[:, None, None], H)
