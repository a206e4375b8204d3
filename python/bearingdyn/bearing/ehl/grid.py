"""The grid on which the contact is solved, and values taken from one grid to a finer one."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from bearingdyn.types import Array


@dataclass(frozen=True)
class Grid:
    """The grid: nodes of one half of the contact, Y ≥ 0 (it is symmetric); arrays (ny, nx), rows across it.

    The pressure is held at zero on the two first columns, the last column and the last row.
    """

    nx: int
    ny: int
    origin: int
    """Column of X = 0."""
    dx: float
    dy: float

    @property
    def shape(self) -> tuple[int, int]:
        """(ny, nx)."""
        return self.ny, self.nx

    @cached_property
    def X(self) -> Array:
        """(nx,)."""
        return np.asarray((np.arange(self.nx) - self.origin) * self.dx)

    @cached_property
    def Y(self) -> Array:
        """(ny,)."""
        return np.asarray(np.arange(self.ny) * self.dy)

    @cached_property
    def weights(self) -> Array:
        """Area of each node in the whole contact, (ny, nx)."""
        weights = np.full(self.shape, 2 * self.dx * self.dy)
        weights[0] /= 2
        return weights

    def refined(self) -> Grid:
        """The grid of half the pitch that holds every node of this one."""
        return Grid(2 * self.nx - 1, 2 * self.ny - 1, 2 * self.origin, self.dx / 2, self.dy / 2)

    @cached_property
    def inner(self) -> NDArray[np.bool_]:
        """Nodes whose pressure is unknown, (ny, nx)."""
        inner = np.zeros(self.shape, dtype=bool)
        inner[:-1, 2:-1] = True
        return inner


def prolonged(P: Array) -> Array:
    """Values on the grid of half the pitch, linear between those of a coarser grid."""
    ny, nx = P.shape
    fine = np.empty((2 * ny - 1, 2 * nx - 1))
    fine[::2, ::2] = P
    fine[::2, 1::2] = (P[:, 1:] + P[:, :-1]) / 2
    fine[1::2] = (fine[2::2] + fine[:-1:2]) / 2
    return fine
