"""O-rings of bricks, and segments of them."""

from __future__ import annotations

import math

import numpy as np

from bearingdyn.checks import positive, whole
from bearingdyn.fem.meshes.disc_section import disc_section
from bearingdyn.fem.meshes.grid_lines import crowded
from bearingdyn.fem.meshes.patches import MOST, angles_of, extruded, revolved, with_kind
from bearingdyn.fem.meshes.solid_mesh import SolidMesh, second_order

LENGTH = "it must be a positive length in m"


def o_ring_mesh(
    radius: float,
    cord: float,
    band: float,
    angle: tuple[float, float] | None = None,
    *,
    across: int = 4,
    around: int = 24,
    element: str = "hex27",
) -> SolidMesh:
    """Mesh of an O-ring about z, or a segment of it, at rest between a shaft and a bore.

    Surfaces: "inner" and "outer", the bands; of a segment also "start" and "end".

    Parameters
    ----------
    radius
        Radius of the circle on which the cord's centre lies, m.
    cord
        Diameter of the cord, m.
    band
        Width along z, m, of the two strips by which the ring is held, the innermost and the outermost of its
        surface; 0.2 to 0.95 of the cord.
    angle
        (from, to), rad; None: the whole ring.
    across, around
        Number of elements across each band and over the angle.
    element
        "hex20" or "hex27".

    Raises
    ------
    ValueError
        For measures out of range.
    """
    cord, radius = positive("cord", cord, LENGTH), positive("radius", radius, LENGTH)
    band = positive("band", band, LENGTH)
    if not (cord > 0 and 0.5 * cord < radius < math.inf):
        raise ValueError(f"cord is {cord} and radius {radius}; they must be positive, radius above cord/2, m")
    if not 0.2 * cord <= band <= 0.95 * cord:
        raise ValueError(
            f"band is {band}; it must lie in 0.2 to 0.95 of the cord, {0.2 * cord} to {0.95 * cord} m"
        )
    across = whole("across", across, 2, MOST)
    start, end = angles_of(angle, around)
    a, half = 0.5 * cord, math.asin(band / cord)  # lines crowd to the ends of the bands
    plane, quads = disc_section(a, half, crowded(0.0, 1.0, across), max(2, across // 2))
    p, elements, ends = second_order(*extruded(plane, quads, np.linspace(start, end, around + 1)))
    skin = np.hypot(p[:, 0], p[:, 1]) > a * (1 - 1e-9)
    middle = len(p) - len(ends) + np.flatnonzero(skin[ends].all(axis=1))
    p[middle, :2] *= (a / np.hypot(*p[middle, :2].T))[:, None]
    skin[middle] = True
    held = skin & (np.abs(p[:, 1]) < 0.5 * band * (1 + 1e-9))
    surfaces = {
        "inner": np.flatnonzero(held & (p[:, 0] < 0)),
        "outer": np.flatnonzero(held & (p[:, 0] > 0)),
        "start": np.flatnonzero(p[:, 2] == start),
        "end": np.flatnonzero(p[:, 2] == end),
    }
    flat = SolidMesh(np.stack([radius + p[:, 0], p[:, 2], p[:, 1]], axis=1), elements, {}, surfaces)
    return revolved(with_kind(flat, element), closed=angle is None)
