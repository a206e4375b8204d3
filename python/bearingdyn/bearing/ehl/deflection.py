"""The elastic deflection of the half-space on the grid."""

from __future__ import annotations

from typing import Any

import numpy as np
import scipy
from numpy.typing import NDArray

from bearingdyn.bearing.ehl.dimensionless_groups import Groups
from bearingdyn.bearing.ehl.grid import Grid
from bearingdyn.types import Array


class Deflection:
    """Elastic deflection H = Σ K P, P constant on each cell (A. E. H. Love 1929), a convolution by FFT.

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
