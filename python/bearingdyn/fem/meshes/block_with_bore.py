"""Blocks of bricks with a round bore, and feet."""

from __future__ import annotations

import math

import numpy as np

from bearingdyn.checks import nonnegative, positive, require, vector
from bearingdyn.fem.meshes.grid_lines import lines_through
from bearingdyn.fem.meshes.patches import MOST, extruded, joined, patch, with_kind
from bearingdyn.fem.meshes.solid_mesh import SolidMesh, second_order

LENGTHS = ("width", "height", "length", "bore_diameter", "bore_height", "element_size")


def block_with_bore(
    width: float,
    height: float,
    length: float,
    bore_diameter: float,
    bore_height: float,
    element_size: float,
    flange: tuple[float, float] | None = None,
    strip: float | None = None,
    element: str = "hex20",
) -> SolidMesh:
    """Structured mesh of bricks of a block with a round bore through it along z.

    The origin is on the bore's axis at mid-length. The nodes of the bore lie on its circle, and its edges are
    quadratic. Surfaces: "bore", "base", "top", "front" (at +z), "back"; "feet": the undersides of the
    flanges, the strips, or the base; "outside": all but the bore and the base. The measures must be
    consistent; parts.Housing checks them.

    Parameters
    ----------
    width, height, length
        Extent along x, y and z, m.
    bore_diameter
        Diameter of the bore, m.
    bore_height
        Height of the bore's axis above the base, m.
    element_size
        Longest wanted side of an element, m.
    flange
        (width, height), m, of two flanges on the sides at the base; None: none.
    strip
        Width, m, of two strips along the base at either side, which grid lines bound; None: none.
    element
        "hex20" or "hex27".

    Raises
    ------
    ValueError
        For a length that is not positive, or elements without number.
    """
    given = (width, height, length, bore_diameter, bore_height, element_size)
    width, height, length, bore_diameter, bore_height, element_size = (
        positive(name, value, "it must be a positive length in m")
        for name, value in zip(LENGTHS, given, strict=True)
    )
    most = MOST * element_size
    longest = max(width, height, length, bore_diameter, bore_height)
    require(longest <= most, "element_size", element_size, f"{longest} m would have too many elements")
    if flange is not None:
        out, up = vector("flange", flange, (2,), "width and height in m").tolist()
        flange = (positive("flange[0]", out), positive("flange[1]", up))
        require(max(flange) <= most, "flange", flange, "it would have too many elements")
    if strip is not None:
        strip = nonnegative("strip", strip, "it must be a length in m, or None")
        require(strip <= 0.5 * width, "strip", strip, "it must be at most half of the width")
    r, half, base, top = 0.5 * bore_diameter, 0.5 * width, -bore_height, height - bore_height
    low = base if bore_height - top < element_size else -top  # a box about the bore, the pedestal below it
    x = lines_through([-half, 0.0, half] + ([strip - half, half - strip] if strip else []), element_size, 2)
    shelf = [base + flange[1]] if flange else []
    y = lines_through([low, 0.0, top, *(s for s in shelf if low < s < top)], element_size, 2)
    layers = max(2, round((math.sqrt(width * (top - low) / math.pi) - r) / element_size))
    patches = []
    t = np.linspace(1.0, 0.0, layers + 1)[:, None]  # inward, so that all patches turn the same way
    for px, py in (
        (x, np.full_like(x, low)),
        (np.full_like(y, half), y),
        (x[::-1], np.full_like(x, top)),
        (np.full_like(y, -half), y[::-1]),
    ):
        rho = np.hypot(px, py)
        patches.append(patch(px * (t + (1.0 - t) * r / rho), py * (t + (1.0 - t) * r / rho)))
    side = y
    if low > base:
        below = lines_through([base, low, *(s for s in shelf if base < s < low)], element_size)
        patches.append(patch(*np.meshgrid(x, below)))
        side = np.concatenate([below[:-1], y])
    if flange:
        out = lines_through([half, half + flange[0]], element_size)
        foot = side[side <= shelf[0] + 1e-9 * height]
        patches += [patch(*np.meshgrid(out, foot)), patch(*np.meshgrid(-out[::-1], foot))]
    plane, quads = joined(patches, 1e-6 * element_size)
    z = lines_through([-0.5 * length, 0.5 * length], element_size, 2)

    p, elements, _ = second_order(*extruded(plane, quads, z))
    rho = np.hypot(p[:, 0], p[:, 1])
    bore = rho < r * (1.0 + 1e-9)  # nodes on the bore, and the middles of its chords
    p[bore, :2] *= (r / rho[bore])[:, None]
    near = 1e-6 * element_size
    on_base = np.abs(p[:, 1] - base) < near
    foot_from = half if flange else half - strip if strip else 0.0
    surfaces = {
        "bore": np.flatnonzero(bore),
        "base": np.flatnonzero(on_base),
        "feet": np.flatnonzero(on_base & (np.abs(p[:, 0]) > foot_from - near)),
        "top": np.flatnonzero(np.abs(p[:, 1] - top) < near),
        "front": np.flatnonzero(np.abs(p[:, 2] - 0.5 * length) < near),
        "back": np.flatnonzero(np.abs(p[:, 2] + 0.5 * length) < near),
    }
    mesh = SolidMesh(p, elements, surfaces=surfaces)
    skin = mesh.boundary
    other = ~(bore[skin].all(axis=1) | on_base[skin].all(axis=1))
    return with_kind(mesh.naming("outside", np.unique(skin[other])), element)
