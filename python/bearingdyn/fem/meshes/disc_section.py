"""Quadrilaterals over a disc, the section of an O-ring."""

from __future__ import annotations

import math

import numpy as np

from bearingdyn.fem.meshes.patches import joined, patch
from bearingdyn.types import Array, Index


def disc_section(radius: float, half: float, share: Array, layers: int) -> tuple[Array, Index]:
    """Section of a disc: points (k, 2), quadrilaterals (m, 4), clockwise, a rectangle and four patches.

    Parameters
    ----------
    radius
        m.
    half
        Half the angle of the two patches at either end of the first axis, rad.
    share
        Grid lines over the arc of each patch, from 0 to 1.
    layers
        Elements from the rectangle to the circle.
    """
    core = 0.45
    sides = [-half + 2.0 * half * share, half + (math.pi - 2.0 * half) * share]
    sides += [arc + math.pi for arc in sides]
    corner = core * radius * np.exp(1j * np.array([-half, half, math.pi - half, math.pi + half, -half]))
    t = np.linspace(0.0, 1.0, layers + 1)[:, None]
    patches = []
    for k, arc in enumerate(sides):
        inside = corner[k] + share * (corner[k + 1] - corner[k])
        place = inside + t * (radius * np.exp(1j * arc) - inside)
        patches.append(patch(place.real, place.imag))
    x, y = np.meshgrid((2 * share[::-1] - 1) * corner[1].real, (2 * share - 1) * corner[1].imag)
    patches.append(patch(x, y))  # all clockwise, for (r, φ, z) is right-handed
    return joined(patches, 1e-9 * 2.0 * radius)
