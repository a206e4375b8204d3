"""Rings of bricks about z, and segments of them."""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from bearingdyn.checks import items, name_list, numbers, positive, whole
from bearingdyn.fem.meshes.box_mesh import bricks
from bearingdyn.fem.meshes.grid_lines import crowded
from bearingdyn.fem.meshes.patches import MOST, angles_of, revolved, with_kind
from bearingdyn.fem.meshes.solid_mesh import SolidMesh


def ring_mesh(
    radii: Sequence[float],
    width: float,
    angle: tuple[float, float] | None = None,
    *,
    across: Sequence[int] | int = 4,
    along: int = 8,
    around: int = 24,
    regions: Sequence[str] = (),
    element: str = "hex27",
) -> SolidMesh:
    """Mesh of a ring about z, or a segment of it, of concentric layers, each layer a region.

    Lines crowd towards the ends of the width, and towards both faces of each layer. Surfaces: "inner",
    "outer", "z-", "z+"; of a segment also "start" and "end".

    Parameters
    ----------
    radii
        Radii of the bore, the bonds and the outside, m, rising.
    width
        Extent along z, m, with its middle at z = 0.
    angle
        (from, to), rad; None: the whole ring.
    across, along, around
        Number of elements through each layer, over the width and over the angle.
    regions
        Names of the layers (default "layer 1", ...).
    element
        "hex20" or "hex27".

    Raises
    ------
    ValueError
        For measures out of order, fewer than 6 elements around a whole ring, or a segment of a turn or more.
    """
    remedy = "it must be two radii or more, rising from above 0, m"
    radii = numbers("radii", radii, remedy).tolist()
    count = len(radii) - 1
    if not (count >= 1 and radii[0] > 0 and all(b > a for a, b in itertools.pairwise(radii))):
        raise ValueError(f"radii is {tuple(radii)}; {remedy}")
    width = positive("width", width, "it must be a positive length in m")
    names = tuple(name_list("regions", regions, "names")) or tuple(f"layer {k + 1}" for k in range(count))
    given = [across] * count if np.ndim(across) == 0 else items("across", across, "give one number a layer")
    steps = tuple(whole(f"across[{k}]", n, 1, MOST) for k, n in enumerate(given))
    along = whole("along", along, 1, MOST)
    if len(names) != count or len(steps) != count or len(set(names)) != count:
        raise ValueError(
            f"regions is {names} and across {steps}; {count} layers need a name of its own and a number each"
        )
    start, end = angles_of(angle, around)
    r = np.concatenate(
        [crowded(a, b, n)[:-1] for (a, b), n in zip(itertools.pairwise(radii), steps, strict=True)]
        + [np.array([radii[-1]])]
    )
    flat = bricks([r, np.linspace(start, end, around + 1), crowded(-0.5 * width, 0.5 * width, along)])
    flat = with_kind(flat, element)
    middle = flat.points[flat.elements[:, :8], 0].mean(axis=1)
    layer = np.searchsorted(radii, middle) - 1
    kept = {"x-": "inner", "x+": "outer", "z-": "z-", "z+": "z+", "y-": "start", "y+": "end"}
    surfaces = {kept[name]: at for name, at in flat.surfaces.items()}
    layers = {name: np.flatnonzero(layer == k) for k, name in enumerate(names)}
    return revolved(replace(flat, regions=layers, surfaces=surfaces), closed=angle is None)
