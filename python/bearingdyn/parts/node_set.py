"""Sets of nodes of an imported body that move as one rigid body."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from bearingdyn.checks import indices, nonnegative, positive, require, two, vector
from bearingdyn.plausible_ranges import plausible
from bearingdyn.short_repr import short
from bearingdyn.types import Array


@dataclass(frozen=True, eq=False)
class NodeSet:
    """A set of nodes of an imported body that move as one rigid body.

    Parameters
    ----------
    nodes
        Their numbers in the file (rows of its points, from 0, where it names none), or a function of all
        positions (k, 3), m, that says which (k,) belong to it.
    reference
        (x, y, z), m, of the six coordinates; default: the mean of the nodes' positions.
    """

    nodes: Sequence[int] | Callable[[Array], NDArray[np.bool_]]
    reference: tuple[float, float, float] | None = None

    __repr__ = short

    def __post_init__(self) -> None:
        if not callable(self.nodes):
            given = indices("nodes", self.nodes, "it must be numbers of nodes, or a function of positions")
            require(given.ndim == 1, "nodes", self.nodes, "it must be a list of numbers of nodes")
        if self.reference is not None:
            vector("reference", self.reference, (3,), "(x, y, z) in m")


def at_radius(
    radius: float, axial: tuple[float, float] = (-math.inf, math.inf), tolerance: float = 1e-6
) -> Callable[[Array], NDArray[np.bool_]]:
    """A choice of nodes for a NodeSet: those on a cylinder about z.

    Parameters
    ----------
    radius
        m.
    axial
        z from, to, m.
    tolerance
        m, as fine as the file's digits.
    """
    plausible("length", "radius", positive("radius", radius, "it must be a positive radius in m"))
    low, high = two("axial", axial, "it must be (from, to) along z, m")
    require(low < high, "axial", axial, "it must be (from, to) along z, rising, m")
    nonnegative("tolerance", tolerance, "it must be a length in m, zero or more")

    def choose(p: Array) -> NDArray[np.bool_]:
        near = np.abs(np.hypot(p[:, 0], p[:, 1]) - radius) <= tolerance
        return np.asarray(near & (p[:, 2] >= low - tolerance) & (p[:, 2] <= high + tolerance))

    return choose
