"""Integrals over the elements of a section (r, z), from which the matrices of every Fourier order combine.

The strains of order n are sums of three fields of U, V and W, a = ∂N/∂r, b = ∂N/∂z and c = N/r:

    ε_rr = aU,  ε_θθ = cU + n cV,  ε_zz = bW,  γ_rz = bU + aW,  γ_rθ = −n cU + (a − c)V,  γ_θz = bV − n cW

(amplitudes in cos nφ, the last two in sin nφ), so that the integrals of their products, taken once, serve all
orders.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from bearingdyn.fem.meshes.quadrilateral_element import shape_functions

_LINE = np.array([-math.sqrt(0.6), 0.0, math.sqrt(0.6)])  # Gauss's three points, and weights
_WEIGHT = np.array([5.0, 8.0, 5.0]) / 9.0


@dataclass(frozen=True, eq=False)
class SectionIntegrals:
    """Integrals over elements of 9 nodes, per radian; complex where nodes are.

    Parameters
    ----------
    mass
        (m, 9, 9) ∫ N N r dr dz, m³.
    shape
        (m, 27, 27) ∫ F F r dr dz of F = (a, b, c), nine each, m.
    volume, pressure
        (m, 3, 27) ∫ p F r dr dz of the pressures p, linear in each element, and the pressures of F: the
        volumetric stiffness is a product of the two. Taken apart, traces cancel before they are squared.
    """

    mass: Any
    shape: Any
    volume: Any
    pressure: Any

    @classmethod
    def of(cls, r: Any, z: Any) -> SectionIntegrals:
        """Integrals of elements with nodes at r, z (m, 9), m."""
        N, N_xi, N_eta = shape_functions(np.repeat(_LINE, 3), np.tile(_LINE, 3))
        at_r, at_z = r @ N.T, z @ N.T
        r_xi, z_xi, r_eta, z_eta = r @ N_xi.T, z @ N_xi.T, r @ N_eta.T, z @ N_eta.T
        det = r_xi * z_eta - r_eta * z_xi
        dV = det * np.outer(_WEIGHT, _WEIGHT).ravel() * at_r
        F = np.empty((*det.shape, 3, 9), dtype=det.dtype)
        F[:, :, 0] = (z_eta / det)[:, :, None] * N_xi - (z_xi / det)[:, :, None] * N_eta
        F[:, :, 1] = (r_xi / det)[:, :, None] * N_eta - (r_eta / det)[:, :, None] * N_xi
        F[:, :, 2] = N / at_r[:, :, None]
        F = F.reshape(*det.shape, 27)
        # Pressures are linear in r and z themselves: linear in ξ and η they lose an order where elements are
        # distorted (Boffi & Gastaldi, Computing 69 (2002) 145-151).
        size = np.sqrt(det.sum(axis=1, keepdims=True))
        middle = [c.mean(axis=1, keepdims=True) for c in (at_r, at_z)]
        p = np.stack([np.ones_like(at_r), (at_r - middle[0]) / size, (at_z - middle[1]) / size], axis=-1)
        weighted = (p * dV[:, :, None]).transpose(0, 2, 1)
        volume = weighted @ F
        pressure = np.linalg.solve(weighted @ p, volume)
        F *= np.sqrt(dV)[:, :, None]
        mass = (dV @ (N[:, :, None] * N[:, None, :]).reshape(9, 81)).reshape(-1, 9, 9)
        return cls(mass, F.transpose(0, 2, 1) @ F, volume, pressure)

    def matrices(self, n: int, components: tuple[int, ...]) -> tuple[Any, Any, Any]:
        """Mass (m, 9, 9) of one component, volumetric and deviatoric stiffness (m, 9c, 9c), of order n.

        e:e = Σ ε_ii² − (Σ ε_ii)²/3 + ½ Σ γ².
        """
        around = 2 * math.pi if n == 0 else math.pi  # ∫cos² nφ dφ
        left, right = (self._traces(A, n, components) for A in (self.volume, self.pressure))
        volumetric = (around * left).transpose(0, 2, 1) @ right

        S = [[self.shape[:, 9 * i : 9 * i + 9, 9 * j : 9 * j + 9] for j in range(3)] for i in range(3)]
        (aa, ab, ac), (ba, bb, bc), (ca, cb, cc) = S
        n2, third = n * n, 1.0 / 3.0
        blocks = {
            (0, 0): lambda: aa + cc + 0.5 * bb + (0.5 * n2) * cc - third * (aa + ac + ca + cc),
            (0, 1): lambda: n * (cc - 0.5 * (ca - cc) - third * (ac + cc)),
            (0, 2): lambda: 0.5 * ba - third * (ab + cb),
            (1, 1): lambda: (2.0 * third * n2) * cc + 0.5 * (aa - ac - ca + cc + bb),
            (1, 2): lambda: -n * (0.5 * bc + third * cb),
            (2, 2): lambda: (2.0 * third) * bb + 0.5 * aa + (0.5 * n2) * cc,
        }
        count = len(components)
        deviatoric = np.empty((len(self.mass), 9, count, 9, count), dtype=self.shape.dtype)
        for i, of in enumerate(components):
            for j, by in enumerate(components[i:], i):
                deviatoric[:, :, i, :, j] = block = around * blocks[of, by]()
                if j > i:
                    deviatoric[:, :, j, :, i] = block.transpose(0, 2, 1)
        return around * self.mass, volumetric, deviatoric.reshape(volumetric.shape)

    @staticmethod
    def _traces(A: Any, n: int, components: tuple[int, ...]) -> Any:
        """Of integrals with a, b, c (m, 3, 27) those with the trace (a + c)U + n cV + bW, (m, 3, 9c)."""
        a, b, c = A[:, :, :9], A[:, :, 9:18], A[:, :, 18:]
        found = np.stack([(a + c, n * c, b)[i] for i in components], axis=-1)
        return found.reshape(len(A), 3, -1)
