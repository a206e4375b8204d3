"""Boxes of bricks between grid lines."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike

from bearingdyn.checks import reals
from bearingdyn.fem.meshes.patches import with_kind
from bearingdyn.fem.meshes.solid_element import HEX20
from bearingdyn.fem.meshes.solid_mesh import SolidMesh, second_order
from bearingdyn.plausible_ranges import plausible
from bearingdyn.types import Array

SIDES = ("x-", "x+", "y-", "y+", "z-", "z+")


def box_mesh(x: ArrayLike, y: ArrayLike, z: ArrayLike, element: str = "hex20") -> SolidMesh:
    """A box of bricks between grid lines x, y, z; surfaces "x-", "x+", "y-", "y+", "z-", "z+".

    Parameters
    ----------
    x, y, z
        Grid lines, m, each rising.
    element
        "hex20" or "hex27".

    Raises
    ------
    ValueError
        For lines that do not rise, or an unknown element.
    """
    remedy = "it must be two grid lines or more, rising, m"
    lines = [reals(name, v, remedy) for name, v in (("x", x), ("y", y), ("z", z))]
    for name, v in zip("xyz", lines, strict=True):
        if v.ndim != 1 or v.size < 2 or not np.all(np.diff(v) > 0):
            raise ValueError(f"{name} is {v.tolist()}; {remedy}")
        for x_k in (v[0], v[-1]):
            plausible("length", name, x_k)
    return bricks(lines, element)


def bricks(lines: Sequence[Array], element: str = "hex20") -> SolidMesh:
    """The box of `box_mesh` between three sets of rising lines of any unit.

    Parameters
    ----------
    lines
        Three of (n,), each rising.
    element
        As in `box_mesh`.
    """
    shape = tuple(v.size for v in lines)
    p = np.stack(np.meshgrid(*lines, indexing="ij"), axis=-1).reshape(-1, 3)
    i = np.arange(len(p)).reshape(shape)
    ends = (slice(None, -1), slice(1, None))
    corners = [i[tuple(ends[int(side)] for side in corner)].ravel() for corner in HEX20.corners]
    p, elements, _ = second_order(p, np.stack(corners, axis=1))
    surfaces = {
        f"{'xyz'[a]}{sign}": np.flatnonzero(p[:, a] == lines[a][end])
        for a in range(3)
        for sign, end in (("-", 0), ("+", -1))
    }
    return with_kind(SolidMesh(p, elements, surfaces=surfaces), element)
