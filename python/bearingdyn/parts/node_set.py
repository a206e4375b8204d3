"""Sets of nodes of an imported body that move as one rigid body."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

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

    def choose(p: Array) -> NDArray[np.bool_]:
        near = np.abs(np.hypot(p[:, 0], p[:, 1]) - radius) <= tolerance
        return np.asarray(near & (p[:, 2] >= axial[0] - tolerance) & (p[:, 2] <= axial[1] + tolerance))

    return choose
