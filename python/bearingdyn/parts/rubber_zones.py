"""The rubber of a body of revolution in zones: places where a radial motion strains it alike, in sectors.

One strain for a whole layer stands for a field: of a thin one moved radially, strain at the ends of the bond
and across the motion is far from the mean. Each zone has its share of the deviatoric stiffness, which add up
to the whole, and its own strain.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from bearingdyn.fem import Harmonic, RevolutionMesh, deviatoric_strains
from bearingdyn.parts.strain import Strain
from bearingdyn.short_repr import short
from bearingdyn.types import Array, Index

SECTORS = 8
"""Of the circle: over one of them ln γ of a radial motion varies little beside what zones leave."""
_AZIMUTHS = 4  # of a sector; all together they integrate squares of orders 0 and 1 exactly


@dataclass(frozen=True, eq=False)
class RubberZone:
    """One zone of the rubber of a part.

    Parameters
    ----------
    name
        Which it is, such as "zone 2, 67.5°": zones from the least strain of a radial motion to the largest,
        the azimuth that of the middle of the sector.
    H
        (n, n) its share of ∫BᵀT2B dV, m, in the coordinates of the superelement.
    volume
        m³.
    concentration
        (n,) strain that counts for a law of softening over the rms one, by coordinate.
    """

    name: str
    H: Array
    volume: float
    concentration: Array

    __repr__ = short


def rubber_zones(
    mesh: RevolutionMesh,
    elements: Index,
    placed: Sequence[tuple[Harmonic, Array, Sequence[tuple[Index, Array]]]],
    n: int,
    count: int,
) -> list[RubberZone]:
    """Zones of the rubber of a revolved body, `count` in the section, each in SECTORS around the axis.

    Parameters
    ----------
    mesh, elements
        Section, and which of its elements are the rubber.
    placed
        Each family with its shapes, and the coordinates and signs of these in each of its copies.
    n
        Number of coordinates.
    count
        Zones of the section, of equal energy in a radial motion of the first interface.
    """
    fields, volume = [], np.zeros(0)
    for h, Psi, places in placed:
        e, dV = deviatoric_strains(mesh, h.order, h.components, h.complete(Psi.copy()))
        volume = dV[elements].ravel()
        fields.append((h, e[elements].reshape(volume.size, 6, -1), places))
    zone = _zones(fields, volume, count)
    turns = SECTORS * _AZIMUTHS
    found = []
    for k in range(SECTORS):
        phi = (np.arange(_AZIMUTHS * k, _AZIMUTHS * (k + 1)) + 0.5) * 2 * np.pi / turns
        E = np.zeros((len(phi), volume.size, 6, n))
        for h, e, places in fields:
            cos, sin = np.cos(h.order * phi), np.sin(h.order * phi)
            for copy, (index, sign) in enumerate(places):
                even, odd = (sin, -cos) if copy else (cos, sin if h.order else np.ones_like(phi))
                turn = np.stack([even] * 4 + [odd] * 2, axis=-1)
                E[..., index] += turn[:, None, :, None] * (sign * e)
        for z in range(count):
            own = E[:, zone == z]
            weights = np.tile(volume[zone == z], len(phi)) * 2 * np.pi / turns
            flat = own.reshape(weights.size, 6, n)
            rows = (np.sqrt(weights)[:, None, None] * flat).reshape(-1, n)
            H = rows.T @ rows
            name = f"zone {z + 1}, {360 * (k + 0.5) / SECTORS:g}°"
            found.append(RubberZone(name, H, float(weights.sum()), _concentration(flat, weights, H)))
    return found


def _zones(fields: Sequence[tuple[Harmonic, Array, object]], volume: Array, count: int) -> Index:
    """Zone of every point of the section, of equal energy in a radial motion, the least strain first."""
    # of order 1 the first shape moves the first interface radially
    _, e, _ = next(f for f in fields if f[0].order == 1)
    squares = (e[:, :, 0] ** 2).sum(axis=1)
    order = np.argsort(squares, kind="stable")
    energy = np.cumsum((volume * squares)[order])
    zone = np.zeros(volume.size, dtype=np.intp)
    zone[order] = np.minimum((count * energy / energy[-1]).astype(np.intp), count - 1)
    return zone


def _concentration(strains: Array, weights: Array, H: Array) -> Array:
    """χ (n,) of a zone: logarithmic over rms strain of each coordinate by itself; 1 where there is none."""
    gamma = np.sqrt(2.0 * np.einsum("pia,pia->pa", strains, strains))
    strained = np.diag(H) > 1e-9 * float(np.diag(H).max())
    return np.array(
        [
            Strain.of_field(g, weights).concentration if counts else 1.0
            for g, counts in zip(gamma.T, strained, strict=True)
        ]
    )
