"""Drawings of a body of revolution: its section in a plane, and its surface with the motion of its shapes."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from bearingdyn.fem import RevolutionMesh
from bearingdyn.material import Elastic
from bearingdyn.parts.outline import Outline, azimuths, revolved
from bearingdyn.parts.profile import Matter, Profile, loops, mirrored
from bearingdyn.parts.regions import Patch, Region
from bearingdyn.parts.revolved_strain import Placed


def section_profile(mesh: RevolutionMesh, regions: Sequence[Region | Patch], origin: float) -> list[Profile]:
    """Drawing of a revolved body: the section of each region above the axis and below, z from `origin`."""
    shown = []
    for k, region in enumerate(regions):
        own = replace(mesh, elements=mesh.elements[mesh.region == k], region=mesh.region[mesh.region == k])
        sides = own.outline_sides
        matter: Matter = "metal" if isinstance(region.material, Elastic) else "rubber"
        for loop in loops(np.vstack([sides[:, :2], sides[:, 1:]])):
            shown += mirrored(np.stack([mesh.z[loop] - origin, mesh.r[loop]], axis=-1), matter)
    return shown


def surface_outline(mesh: RevolutionMesh, placed: Placed, n: int) -> Outline:
    """Drawing of a revolved body: its surface, and the motion of it by n coordinates."""
    sides = mesh.outline_sides
    halves = np.vstack([sides[:, :2], sides[:, 1:]])
    points, faces, nodes = revolved(mesh.r, mesh.z, halves)
    rows = np.zeros((nodes.size, len(azimuths()), 3, n))
    for h, Psi, places in placed:
        shapes = np.zeros((nodes.size, 3, Psi.shape[1]))
        shapes[:, list(h.components)] = h.complete(Psi.copy()).reshape(mesh.r.size, len(h.components), -1)[
            nodes
        ]
        for copy, (index, sign) in enumerate(places):
            turned = h.turned(azimuths(), sine=copy == 1)
            rows[..., index] += sign * (turned @ shapes[:, None])
    return Outline(points, faces, rows.reshape(-1, n))
