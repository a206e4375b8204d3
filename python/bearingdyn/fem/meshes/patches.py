"""Patches of quadrilaterals in a plane, joined, extruded to bricks; and what the built-in meshes share."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from bearingdyn.checks import two, whole
from bearingdyn.fem.meshes.solid_element import HEX20, HEX27
from bearingdyn.fem.meshes.solid_mesh import SolidMesh, merged
from bearingdyn.types import Array, Index

MOST = 10_000  # elements along one direction of a built-in mesh
BRICKS = (HEX20.name, HEX27.name)


def with_kind(mesh: SolidMesh, element: str) -> SolidMesh:
    """A mesh of patches with the wanted kind of bricks, "hex20" or "hex27"; ValueError for another."""
    if element not in BRICKS:
        raise ValueError(f"element is {element!r}; the built-in meshes have {' or '.join(BRICKS)}")
    return mesh.with_centres() if element == HEX27.name else mesh


def revolved(flat: SolidMesh, closed: bool) -> SolidMesh:
    """A mesh of extruded patches, its points (r, φ, z), laid out in space; closed: its ends become one."""
    r, phi, z = flat.points.T
    p, elements, surfaces = (
        np.stack([r * np.cos(phi), r * np.sin(phi), z], axis=1),
        flat.elements,
        flat.surfaces,
    )
    if closed:
        p, label = merged(p, 1e-9 * float(r.max()))
        elements = label[elements]
        surfaces = {n: label[at] for n, at in surfaces.items() if n not in ("start", "end")}
    return SolidMesh(p, elements, flat.regions, surfaces)


def angles_of(angle: tuple[float, float] | None, around: int) -> tuple[float, float]:
    """Angles at which revolved patches begin and end, rad; ValueError for an empty or too wide one."""
    remedy = "it must be (from, to) in rad, less than a turn; None: the whole"
    start, end = (0.0, 2.0 * math.pi) if angle is None else two("angle", angle, remedy)
    if not (start < end and (angle is None or end - start < 2.0 * math.pi - 1e-6)):
        raise ValueError(f"angle is {angle}; {remedy}")
    least = 6 if angle is None else 1
    whole("around", around, least, MOST)
    return start, end


def patch(x: Array, y: Array) -> tuple[Array, Index]:
    """A patch: points (k, 2), quadrilaterals (m, 4) of a structured grid; x and y are (rows, columns)."""
    i = np.arange(x.size).reshape(x.shape)
    quads = np.stack([i[:-1, :-1], i[:-1, 1:], i[1:, 1:], i[1:, :-1]], axis=-1).reshape(-1, 4)
    return np.stack([x.ravel(), y.ravel()], axis=-1), quads


def joined(patches: Sequence[tuple[Array, Index]], tolerance: float) -> tuple[Array, Index]:
    """Patches as one; points within the tolerance become one."""
    offsets = np.cumsum([0] + [len(p) for p, _ in patches])
    plane, label = merged(np.vstack([p for p, _ in patches]), tolerance)
    return plane, label[np.vstack([q + o for (_, q), o in zip(patches, offsets[:-1], strict=True)])]


def extruded(plane: Array, quads: Index, z: Array) -> tuple[Array, Index]:
    """Plane patches extruded to bricks: points (k, 3) and bricks (m, 8) at heights z."""
    points = np.hstack([np.tile(plane, (len(z), 1)), np.repeat(z, len(plane))[:, None]])
    lower = (quads[None] + len(plane) * np.arange(len(z) - 1)[:, None, None]).reshape(-1, 4)
    return points, np.hstack([lower, lower + len(plane)])
