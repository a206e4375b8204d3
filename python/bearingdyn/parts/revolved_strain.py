"""Shear strain of the rubber of a body of revolution: of each shape, and of a motion of the interfaces."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np

from bearingdyn.fem import Harmonic, RevolutionMesh, deviatoric_strains
from bearingdyn.parts.strain import Strain
from bearingdyn.types import Array, Complex, Index

# a family's matrices and shapes (n, columns), and the coordinates and signs of these in each of its copies
Placed = Iterable[tuple[Harmonic, Array, Sequence[tuple[Index, Array]]]]

_AZIMUTHS = 16  # of a quarter turn: ln γ averages to 1e-4 over them


def concentrations(mesh: RevolutionMesh, elements: Index, placed: Placed, n: int) -> tuple[float, Array]:
    """Strain of a revolved body's shapes: volume, m³, and χ of each, logarithmic over rms strain."""
    scale, volume = np.ones(n), np.zeros(0)
    for h, Psi, places in placed:
        e, volume = deviatoric_strains(mesh, h.order, h.components, h.complete(Psi.copy()))
        e, volume = e[elements], volume[elements].ravel()
        even, odd = (
            2 * (part**2).sum(axis=2).reshape(volume.size, -1) for part in (e[:, :, :4], e[:, :, 4:])
        )
        phi = np.zeros(1) if h.order == 0 else (np.arange(_AZIMUTHS) + 0.5) * np.pi / _AZIMUTHS / h.order
        cos2, sin2 = np.cos(h.order * phi) ** 2, np.sin(h.order * phi) ** 2
        if h.order == 0:
            sin2 = np.ones(1)
        floor = 1e-9 * max(float((volume @ (even + odd)).max()), 1e-300)
        for k in range(even.shape[1]):
            if not volume @ (even[:, k] + odd[:, k]) > floor:
                continue
            squares = np.outer(even[:, k], cos2) + np.outer(odd[:, k], sin2)
            chi = Strain.of_field(np.sqrt(squares).ravel(), np.repeat(volume, phi.size)).concentration
            for index, _ in places:
                scale[index[k]] = chi
    return 2 * np.pi * float(volume.sum()), scale


def strain_of_motion(
    mesh: RevolutionMesh, elements: Index, placed: Placed, motion: Array | Complex
) -> tuple[Array, Array]:
    """Strain γ = √(2 e:e) (azimuths, points) of a revolved body under a motion, and points' volumes, m³."""
    phi = np.arange(4 * _AZIMUTHS) * 2 * np.pi / (4 * _AZIMUTHS)
    total: Any = 0.0
    volume = np.zeros(0)
    for h, shapes, places in placed:
        e, volume = deviatoric_strains(mesh, h.order, h.components, h.complete(shapes.copy()))
        e, volume = e[elements], volume[elements].ravel()
        cos, sin = np.cos(h.order * phi), np.sin(h.order * phi)
        for copy, (index, sign) in enumerate(places):
            own = e @ (sign * motion[index])
            even, odd = (sin, -cos) if copy else (cos, sin if h.order else np.ones_like(phi))
            turn = np.stack([even] * 4 + [odd] * 2, axis=-1)
            total = total + turn[:, None, :] * own.reshape(volume.size, 6)
    return np.sqrt(2.0 * (np.abs(total) ** 2).sum(axis=-1)), 2 * np.pi * volume
