"""Undamped modes of a body of revolution, one Fourier order at a time."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from bearingdyn.fem import ALL_COMPONENTS, AXIAL, TORSION, Harmonic, lowest_modes
from bearingdyn.short_repr import short
from bearingdyn.types import Array, Index


@dataclass(frozen=True, eq=False)
class RevolvedModes:
    """Undamped modes of a `Revolved` part, of one Fourier order.

    Parameters
    ----------
    order
        n.
    frequency
        (m,), Hz, rising.
    shapes
        (m, nodes, 3), the amplitudes U, V, W of unit modal mass at the mesh's nodes: u_r = U cos nφ, u_θ = V
        sin nφ (V itself for n = 0), u_z = W cos nφ. For n >= 1 each mode is double.
    """

    order: int
    frequency: Array
    shapes: Array

    __repr__ = short


def modes_of_order(
    harmonic: Callable[[int, tuple[int, ...]], Harmonic],
    order: int,
    count: int,
    fixed: Sequence[Index],
    moduli: tuple[Sequence[float], Sequence[float], Sequence[float]],
    rate: float,
) -> RevolvedModes:
    """Lowest modes of a revolved body of one Fourier order, rigid motions (0 Hz) included.

    Parameters
    ----------
    harmonic
        Matrices by order and components.
    fixed
        Nodes held still, face by face.
    moduli
        Bulk and shear modulus, Pa, and density, kg/m³, of each region.
    rate
        1/s, of the shift that holds a free body while its modes are sought.
    """
    bulk, shear, density = moduli
    found: list[tuple[float, Array]] = []
    for components in (AXIAL, TORSION) if order == 0 else (ALL_COMPONENTS,):
        h = harmonic(order, components)
        held = [h.coordinates(nodes) for nodes in fixed]
        free = np.setdiff1d(h.free, np.concatenate(held)) if held else h.free
        K, M = h.stiffness(bulk, shear)[free][:, free], h.mass_matrix(density)[free][:, free]
        frequency, phi = lowest_modes(K + rate**2 * M, M, n_modes=count)
        u = np.zeros((h.n, frequency.size))
        u[free] = phi
        shapes = np.zeros((frequency.size, h.mesh.r.size, 3))
        shapes[:, :, list(components)] = (
            h.complete(u).reshape(-1, len(components), frequency.size).transpose(2, 0, 1)
        )
        omega = np.sqrt(np.maximum((2 * np.pi * frequency) ** 2 - rate**2, 0.0))
        found += zip((omega / (2 * np.pi)).tolist(), shapes, strict=True)
    found = sorted(found, key=lambda mode: mode[0])[:count]
    return RevolvedModes(order, np.array([f for f, _ in found]), np.stack([u for _, u in found]))
