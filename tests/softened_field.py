"""Rubber that softens, place by place: a ring moved radially, each point of bricks at its own modulus.

An eighth of the ring, by its symmetries: about the plane of the motion, across it, and about its middle.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
import scipy

import bearingdyn as bd
from bearingdyn.fem import SolidMesh, assemble_solid, ring_mesh
from bearingdyn.fem.meshes.solid_element import HEX27, points
from bearingdyn.fem.node_pairs import NodePairs
from bearingdyn.fem.solid_matrices import gradients
from bearingdyn.types import Array, Complex

LAW = bd.Payne(D=2.0344e6, gamma_c=3.588e-3, m=0.4817, Lm=0.1663e6, gamma_l=3.132e-3)
LINEAR = 4.2e6 + 0.48e6j
"""Of an EPDM at the strain of its isotherms: the errors of the reference page come out at this modulus.

It is not given there. At that of its strain sweep, 4.96 + 0.58i MPa, one modulus of the rms strain errs by
+4.3 and -6.1 % (2 mm), +3.2 and -3.8 % (4 mm); by energy then by .2 and -.5 %, of the logarithmic strain by
-.4 and +.9 %: the two means lack about the same at every modulus.
"""


def modulus(strain: Array | float) -> Complex:
    """G*, Pa, at a shear strain amplitude."""
    return np.asarray(LINEAR - LAW.modulus(LAW.gamma_r) + LAW.modulus(strain))


@dataclass(frozen=True, eq=False)
class Ring:
    """A ring of 17 mm width between rigid cylinders, of quadratic bricks crowded to its ends."""

    r: float
    thickness: float
    bulk: float = 2e9

    @cached_property
    def mesh(self) -> SolidMesh:
        radii, half = (self.r, self.r + self.thickness), 8.5e-3
        whole = ring_mesh(radii, 2 * half, (0.0, 0.5 * np.pi), across=3, along=12, around=6)
        p = whole.points.copy()
        z = p[:, 2] - p[:, 2].mean()
        p[:, 2] = np.sign(z) * half * (1 - (1 - np.abs(z) / half) ** 2)
        upper = whole.elements[p[whole.elements[:, :8]].mean(axis=1)[:, 2] > 0]
        used, at = np.unique(upper, return_inverse=True)
        return SolidMesh(p[used], at.reshape(upper.shape)).with_centres()

    @cached_property
    def _gradients(self) -> tuple[Array, Array]:
        """∂N/∂x (m, q, k, 3) and volumes (m, q)."""
        D, dV = gradients(HEX27, self.mesh.points[self.mesh.elements], *points(HEX27))
        return D.transpose(0, 2, 1).reshape(*dV.shape, -1, 3), dV

    @property
    def volumes(self) -> Array:
        """(m, q), of an eighth, m³."""
        return self._gradients[1]

    @cached_property
    def _volumetric(self) -> scipy.sparse.csr_matrix:
        return self.bulk * assemble_solid(self.mesh, incompressible=True).volumetric

    def moved(self, G: Complex) -> tuple[complex, Array]:
        """Stiffness, N/m, at G* (m, q) of the points, and their strain for a motion of 1 m."""
        mesh, (D, dV) = self.mesh, self._gradients
        p, k = mesh.points, D.shape[2]
        w = 2 * G * dV
        full = np.einsum("mq,mqia,mqjb->miajb", w, D, D, optimize=True)  # ∫ 2G ∂aNi ∂bNj
        H = 0.5 * full.transpose(0, 1, 4, 3, 2) - full / 3.0  # e:e = ½ ∂aui ∂aui + ½ ∂aui ∂iua − ⅓ (div u)²
        trace = 0.5 * np.einsum("micjc->mij", full)
        for a in range(3):
            H[:, :, a, :, a] += trace
        pairs = NodePairs.of([mesh.elements], len(p))
        K = self._volumetric.astype(complex)
        for part, unit in ((H.real, 1.0), (H.imag, 1j)):
            sums = pairs.zeros()
            pairs.add(sums, 0, np.ascontiguousarray(part).reshape(-1, 3 * k, 3 * k))
            K = K + unit * pairs.matrix(sums)
        r = np.hypot(p[:, 0], p[:, 1])
        held = np.zeros((len(p), 3), dtype=bool)
        outside = np.abs(r - self.r - self.thickness) < 1e-7
        held[(np.abs(r - self.r) < 1e-7) | outside] = True
        held[np.abs(p[:, 1]) < 1e-9, 1] = held[np.abs(p[:, 2]) < 1e-9, 2] = True
        held[np.abs(p[:, 0]) < 1e-9, 1:] = True
        u = np.zeros((len(p), 3), dtype=complex)
        u[outside, 0] = 1.0
        u, free = u.ravel(), np.flatnonzero(~held.ravel())
        K = K.tocsr()
        inner = scipy.sparse.linalg.splu(K[free][:, free].tocsc(), permc_spec="MMD_AT_PLUS_A")
        u[free] = -inner.solve(K[free] @ u)
        l = np.einsum("mqka,mkb->mqab", D, u.reshape(-1, 3)[mesh.elements], optimize=True)
        e = 0.5 * (l + l.swapaxes(2, 3))
        e = e - np.trace(e, axis1=2, axis2=3)[..., None, None] / 3 * np.eye(3)
        return 8 * complex(u @ (K @ u)), np.sqrt(2 * (np.abs(e) ** 2).sum(axis=(2, 3)))


def stiffnesses(thickness: float, level: float = 0.01) -> dict[str, complex]:
    """Radial stiffness, N/m, of a ring at this rms strain.

    "field": each point at its own modulus, iterated; at one modulus for all: "rms", that of the rms strain;
    "logarithmic", that of bd.Layer.strain; "energy", the energy-weighted mean over an even layer's field.
    """
    ring = Ring(0.026, thickness)
    dV, even = ring.volumes, np.ones_like(ring.volumes)
    found = {}
    found["rms"], gamma = ring.moved(modulus(level) * even)
    energy = (dV * gamma**2).sum()
    motion = level / np.sqrt(energy / dV.sum())
    rubber = bd.Maxwell(LINEAR.real, [], [], K=ring.bulk, density=1150.0)
    layer = bd.Layer(ring.r, ring.r + thickness, 0.017, rubber)
    chi = layer.strain([motion, 0, 0, 0, 0, 0], abs(modulus(level))).concentration
    found["logarithmic"], _ = ring.moved(modulus(level * chi) * even)
    found["energy"], _ = ring.moved((dV * gamma**2 * modulus(gamma * motion)).sum() / energy * even)
    last = 0.0
    for _ in range(30):
        found["field"], gamma = ring.moved(modulus(gamma * motion))
        if abs(found["field"] - last) < 1e-6 * abs(found["field"]):
            return found
        last = found["field"]
    raise ArithmeticError("the field does not settle")


def errors(k: complex, exact: complex) -> tuple[float, float]:
    """Relative errors of a stiffness, and of its loss factor."""
    return k.real / exact.real - 1, (k.imag / k.real) / (exact.imag / exact.real) - 1
