"""Surfaces of a part that radiate sound, and its whole skin."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from bearingdyn.checks import positive
from bearingdyn.cms.frozen_matrices import check_symmetry, frozen
from bearingdyn.short_repr import short
from bearingdyn.types import Array, Index


@dataclass(frozen=True, eq=False)
class Surface:
    """A surface of a part that radiates sound: ∫ v_n² dA = q̇ᵀ W q̇ of its normal velocity v_n.

    Parameters
    ----------
    area
        m².
    W
        (n, n) symmetric, m².
    """

    area: float
    W: Array

    __repr__ = short

    def __post_init__(self) -> None:
        positive("area", self.area, "it must be a positive area in m²")
        n = np.shape(self.W)[0] if np.ndim(self.W) else 0
        W = frozen("W", self.W, (n, n))
        check_symmetry("W", W, 1)
        object.__setattr__(self, "W", W)


@dataclass(frozen=True, eq=False)
class Skin:
    """Radiating surface, whole, of a part in its own frame, and how its coordinates move it.

    Parameters
    ----------
    points
        Nodes (b, 3) of the boundary, m.
    faces
        (f, 6, 8 or 9): faces of second-order elements, corners anticlockwise seen from outside, then the
        middles of sides, then their own middle. A triangle among quadrilaterals repeats its last node.
    rows
        (3 b, n): x, y, z of every node from the coordinates of the part's superelement.
    surfaces
        name -> faces of each named surface.
    f_max
        Frequency, Hz, up to which the part was reduced.

    Raises
    ------
    ValueError
        For arrays that do not fit one another.
    """

    points: Array
    faces: Index
    rows: Array
    surfaces: Mapping[str, Index] = field(default_factory=dict)
    f_max: float = math.inf

    __repr__ = short

    def __post_init__(self) -> None:
        b = np.shape(self.points)[0] if np.ndim(self.points) else 0
        points = frozen("points", self.points, (b, 3))
        n = np.shape(self.rows)[1] if np.ndim(self.rows) == 2 else 0
        rows = frozen("rows", self.rows, (3 * b, n))
        faces = np.array(self.faces, dtype=np.intp)
        if faces.ndim != 2 or faces.shape[1] not in (6, 8, 9):
            raise ValueError(f"faces has shape {faces.shape}; it must be (f, 6, 8 or 9)")
        if faces.min(initial=0) < 0 or faces.max(initial=0) >= b:
            raise ValueError(f"faces names a node outside 0...{b - 1}")
        object.__setattr__(self, "points", points)
        object.__setattr__(self, "faces", faces)
        object.__setattr__(self, "rows", rows)
        object.__setattr__(self, "surfaces", dict(self.surfaces))
