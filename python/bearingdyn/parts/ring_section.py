"""The section of a flexible ring meshed: finer under the balls, and bent to its groove."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from bearingdyn.fem import Rectangle, RevolutionMesh, revolution_mesh
from bearingdyn.parts.revolved_faces import Footprint

UNDER = (0.15, 0.45)  # of the ring's height: lines of the mesh under the balls


def ring_section(
    rectangles: Sequence[Rectangle],
    refinement: float,
    half_track: float,
    footprint: Footprint | None,
    groove_radius: float | None,
    inner: bool = False,
) -> RevolutionMesh:
    """Section of a ring as a mesh, with the rubber around it, lines near the edges of its track.

    Parameters
    ----------
    rectangles
        The ring's own first.
    half_track
        Half the axial width of the face that carries the balls, m.
    footprint
        Where the balls touch; None: not known.
    groove_radius
        Of the groove's section, m; None: a plain rectangle.
    inner
        Whether it is an inner ring, whose groove is in its outside.
    """
    mesh = _lines(rectangles, refinement, half_track, footprint, groove_radius is not None, inner)
    if groove_radius is None:
        return mesh
    # the ring's lines, bent so that the one at the balls follows the groove
    race, seat = _race_and_seat(rectangles[0], inner)
    z = np.clip(mesh.z, -half_track, half_track)
    bottom = np.sqrt(groove_radius**2 - z**2) - math.sqrt(groove_radius**2 - half_track**2)
    share = (seat - mesh.r) / (seat - race)
    return replace(mesh, r=mesh.r + math.copysign(1.0, seat - race) * np.maximum(share, 0.0) * bottom)


def _race_and_seat(ring: Rectangle, inner: bool) -> tuple[float, float]:
    """Radii of the ring's side with the groove, at the shoulders, and of the other one, m."""
    return (ring.r[1], ring.r[0]) if inner else (ring.r[0], ring.r[1])


def _lines(
    rectangles: Sequence[Rectangle],
    refinement: float,
    half: float,
    footprint: Footprint | None,
    grooved: bool,
    inner: bool,
) -> RevolutionMesh:
    near = np.linspace(-half, half, 9)
    if footprint is None:
        return revolution_mesh(rectangles, refinement, z_near=near)
    race, seat = _race_and_seat(rectangles[0], inner)
    r_cuts = sorted(race + share * (seat - race) for share in UNDER)
    lines, edges = footprint.lines(), near[[0, -1]]
    if grooved:  # the flanks of the groove, whose arcs are drawn by parabolas
        flanks = []
        for end, line in zip(edges, (lines[0], lines[-1]), strict=True):
            count = max(1, math.ceil(4.0 * abs(end - line) / half))
            flanks.append(np.linspace(end, line, count + 1)[:-1])
        edges = np.concatenate(flanks)
    if len(rectangles) > 1:  # cuts would be graded towards, as the rubber's edges are
        return revolution_mesh(rectangles, refinement, r_cuts, z_near=[*edges, *lines])
    return revolution_mesh(rectangles, refinement, r_cuts, lines, edges)
