"""A bore of a solid that bends with the ring in it: its motion by Fourier orders in azimuth."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
import scipy.sparse

from bearingdyn.bearing import RacewaySeries
from bearingdyn.checks import instance, require, whole
from bearingdyn.cms import Raceway, RoundFace
from bearingdyn.fem import SolidMesh
from bearingdyn.types import Array

ROUND = 1e-3  # of the radius, by which nodes of a round bore may lie off it
NODES = 4.0  # around a wave: two elements of second order


@dataclass(frozen=True)
class FlexibleBore:
    """A round bore of a solid that moves by the orders of a ring in it, not as a rigid interface.

    A ring loose in it, `Application.fit`, bends it and is bent, order by order.

    Parameters
    ----------
    surface
        Name of the mesh's surface, a whole cylinder about a line along z.
    order
        Highest order, that of the ring (`FlexibleRing.order`).

    Raises
    ------
    ValueError
        For an order below 1.
    """

    surface: str
    order: int

    def __post_init__(self) -> None:
        instance("surface", self.surface, str, "it must be the name of a surface of the mesh")
        require(bool(self.surface), "surface", self.surface, "it must be the name of a surface of the mesh")
        whole("order", self.order, 1)

    @property
    def series(self) -> RacewaySeries:
        """The coefficients."""
        return RacewaySeries.up_to(self.order)

    def place(self, mesh: SolidMesh) -> tuple[Array, float]:
        """Middle (3,) of the bore and its radius, m.

        Raises
        ------
        ValueError
            If the surface is not on the boundary, not a whole cylinder about z, the outside of the body, or
            its mesh too coarse for the order.
        """
        samples = mesh.samples(self.surface)
        middle, p = samples.centroid, mesh.points[mesh.surface(self.surface)]
        away = p[:, :2] - middle[:2]
        radius = np.hypot(*away.T)
        r = float(radius.mean())
        off = float(np.abs(radius - r).max())
        if not off <= ROUND * r:
            raise ValueError(
                f"surface is {self.surface!r}, whose nodes are {off:.3g} m off a circle of {r:.6g} m on z; "
                "it must be a whole round bore"
            )
        if not float(np.sum(samples.normals[:, :2] * (samples.positions - middle)[:, :2])) < 0.0:
            raise ValueError(f"surface is {self.surface!r}, which faces outwards; it must be a bore")
        # nodes of one azimuth lie within round-off of one another
        around = np.unique(np.round(np.arctan2(away[:, 1], away[:, 0]) * 1e6)) * 1e-6
        gap = float(np.diff(np.append(around, around[0] + 2 * math.pi)).max())
        most = int(2 * math.pi / (NODES * gap) + 1e-3)
        if not self.order <= most:
            raise ValueError(
                f"order is {self.order}; {self.surface!r} has a node every {math.degrees(gap):.3g} degrees, "
                f"which holds waves to order {most}: give {max(most, 1)}, or a finer mesh around"
            )
        return middle, r

    def rows(self, mesh: SolidMesh) -> Any:
        """Coefficients (k, 3 n), sparse, of the bore from displacements of its mesh, means along z."""
        middle, _ = self.place(mesh)
        samples = mesh.samples(self.surface)
        psi = np.arctan2(*(samples.positions - middle).T[1::-1])
        radial = np.stack([np.cos(psi), np.sin(psi), np.zeros_like(psi)], axis=-1)
        share = samples.weights / samples.area
        field = samples.rows
        found = []
        for axial, n, sine in self.series.terms:
            wave = (1.0 if n == 0 else 2.0) * (np.sin(n * psi) if sine else np.cos(n * psi))
            way = np.broadcast_to([0.0, 0.0, 1.0], radial.shape) if axial else radial
            found.append(scipy.sparse.csr_matrix(((share * wave)[:, None] * way).reshape(1, -1)) @ field)
        return scipy.sparse.vstack(found).tocsr()

    def raceway(self, mesh: SolidMesh, rows: Array) -> Raceway:
        """The raceway, from its rows in the coordinates of a superelement."""
        return Raceway(self.series, self.place(mesh)[1], rows)

    def face(self, mesh: SolidMesh) -> RoundFace:
        """The cylinder, for a comparison with the ring."""
        middle, r = self.place(mesh)
        z = mesh.points[mesh.surface(self.surface), 2] - middle[2]
        return RoundFace("bore", r, (float(z.min()), float(z.max())))
