"""The grid, and the elastic deflection of the half-space on it."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
import scipy
from numpy.typing import NDArray

from bearingdyn.bearing.ehl.groups import Groups
from bearingdyn.types import Array


@dataclass(frozen=True)
class Grid:
    """Nodes of one half of the contact, Y ≥ 0 (it is symmetric); arrays (ny, nx), rows across the rolling.

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


class Deflection:
    """H = Σ K P for pressures constant on each cell (A. E. H. Love 1929), as a convolution by FFT.

    Parameters
    ----------
    grid, groups
        Nodes, and the scales of the contact.
    """

    def __init__(self, grid: Grid, groups: Groups) -> None:
        self.grid = grid
        ny, nx = grid.shape
        # rows −(ny−1)…(ny−1) are loaded, rows 0…ny−1 wanted: offsets −(ny−1)…2(ny−1)
        self._rows = scipy.fft.next_fast_len(3 * ny - 2)
        self._columns = scipy.fft.next_fast_len(2 * nx - 1, real=True)
        rows = np.arange(self._rows)
        rows = np.where(rows <= 2 * (ny - 1), rows, self._rows - rows)
        columns = np.arange(self._columns)
        columns = np.minimum(columns, self._columns - columns)
        kernel = groups.compliance * _cell(columns * grid.dx, rows * grid.dy / groups.k, grid, groups)
        self._spectrum = scipy.fft.fft(scipy.fft.rfft(kernel, axis=1), axis=0)
        self.near = float(kernel[0, 0])
        """Deflection of a node under its own unit pressure."""

    def __call__(self, P: NDArray[Any]) -> NDArray[Any]:
        """Deflection (ny, nx) of the pressures (ny, nx), real or complex."""
        if np.iscomplexobj(P):
            return np.asarray(self(P.real) + 1j * self(P.imag))
        ny, nx = self.grid.shape
        along = scipy.fft.rfft(P, self._columns, axis=1)
        both = np.zeros((self._rows, along.shape[1]), dtype=complex)
        both[:ny] = along
        both[self._rows - ny + 1 :] = along[:0:-1]
        spectrum = scipy.fft.fft(both, axis=0, overwrite_x=True)
        spectrum *= self._spectrum
        back = scipy.fft.ifft(spectrum, axis=0, overwrite_x=True)[:ny]
        return np.asarray(scipy.fft.irfft(back, self._columns, axis=1)[:, :nx])


def _cell(x: Array, y: Array, grid: Grid, groups: Groups) -> Array:
    """∫∫ dx dy/r over the cell at the distance (x, y) from the origin, (len(y), len(x)); y = Y/k."""
    hx, hy = grid.dx / 2, grid.dy / (2 * groups.k)

    def corner(x: Array, y: Array) -> Array:
        # x asinh(y/|x|) + y asinh(x/|y|), antiderivative of 1/r by both
        with np.errstate(divide="ignore", invalid="ignore"):
            return np.where(x == 0, 0.0, x * np.arcsinh(y / np.abs(x))) + np.where(
                y == 0, 0.0, y * np.arcsinh(x / np.abs(y))
            )

    right, left = x[None, :] + hx, x[None, :] - hx
    upper, lower = y[:, None] + hy, y[:, None] - hy
    return corner(right, upper) - corner(left, upper) - corner(right, lower) + corner(left, lower)
