"""Reynolds' equation on the grid: residual and the sparse parts of its Jacobian.

−∂X(ε ∂X P) − k² ∂Y(ε ∂Y P) + ∂X(ρ̄H) + ∂T(ρ̄H) = 0 with ε = ρ̄H³/(η̄λ), by balances over cells: the fluidity
of a face is the logarithmic mean of its nodes (exact for ε exponential in P), the wedge third-order upwind.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
import scipy

from bearingdyn.bearing.ehl.deflection import Deflection
from bearingdyn.bearing.ehl.dimensionless_groups import Groups
from bearingdyn.bearing.ehl.grid import Grid
from bearingdyn.bearing.ehl.oil import Oil
from bearingdyn.types import Array


def log_mean(a: Array, b: Array) -> tuple[Array, Array, Array]:
    """(a − b)/ln(a/b) of logarithms ln a, ln b, for Reynolds' equation between two nodes; and derivatives."""
    t = a - b
    small = np.abs(t) < 1e-3
    safe = np.where(small, 1.0, t)
    ea, eb = np.exp(a), np.exp(b)
    mean = np.where(small, np.exp((a + b) / 2) * (1 + t * t / 24), (ea - eb) / safe)
    by_a = np.where(small, mean * (0.5 + t / 12), (ea - mean) / safe)
    by_b = np.where(small, mean * (0.5 - t / 12), (mean - eb) / safe)
    return mean, by_a, by_b


@dataclass(frozen=True)
class Reynolds:
    """Reynolds' equation of one contact on one grid."""

    grid: Grid
    groups: Groups
    oil: Oil

    @cached_property
    def deflection(self) -> Deflection:
        """Its elastic deflection."""
        return Deflection(self.grid, self.groups)

    @cached_property
    def shape(self) -> Array:
        """Undeformed gap with its vertex at zero, (ny, nx)."""
        return self.grid.X[None, :] ** 2 / 2 + self.groups.curvature * self.grid.Y[:, None] ** 2 / 2

    def film(self, P: Array, H0: float) -> Array:
        """H (ny, nx)."""
        return np.asarray(H0 + self.shape + self.deflection(P))

    def carried(self, P: Array, H: Array) -> Array:
        """ρ̄H (ny, nx)."""
        return self.oil.relative_density(P)[0] * H

    def fluxes(self, P: Array, H: Array) -> tuple[Array, Array]:
        """Flux through the right faces (ny, nx−1) and the upper faces (ny−1, nx), over um a²/Rx."""
        log_eps, q = self._fluidity(P, H), self.carried(P, H)
        g = self.grid
        along = -log_mean(log_eps[:, 1:], log_eps[:, :-1])[0] * np.diff(P, axis=1) / g.dx
        along[:, 1:] += (2 * q[:, 2:] + 5 * q[:, 1:-1] - q[:, :-2]) / 6
        along[:, 0] += (q[:, 0] + q[:, 1]) / 2
        across = -log_mean(log_eps[1:], log_eps[:-1])[0] * np.diff(P, axis=0) * self.groups.k**2 / g.dy
        return along, across

    def residual(self, P: Array, H: Array) -> Array:
        """Net outflow of each cell per area, (ny, nx), zero outside of the inner nodes."""
        along, across = self.fluxes(P, H)
        f = np.zeros_like(P)
        f[:, 1:-1] = np.diff(along, axis=1) / self.grid.dx
        f[1:-1] += np.diff(across, axis=0) / self.grid.dy
        f[0] += 2 * across[0] / self.grid.dy  # half a cell, nothing crosses the plane of symmetry
        return np.where(self.grid.inner, f, 0.0)

    def _fluidity(self, P: Array, H: Array) -> Array:
        rho, _ = self.oil.relative_density(P)
        log_eta, _ = self.oil.log_viscosity(P)
        return np.asarray(np.log(rho) + 3 * np.log(H) - log_eta - np.log(self.groups.speed))

    def jacobian(self, P: Array, H: Array, rate: complex = 0.0) -> tuple[Any, Any]:
        """Sparse ∂f/∂P and ∂f/∂H of f + rate·ρ̄H, the other fixed, (n, n); rows of inner nodes hold."""
        rho, rho_P = self.oil.relative_density(P)
        eps, eps_P = self._fluidity(P, H), rho_P / rho - self.oil.log_viscosity(P)[1]
        dx, dy, k2 = self.grid.dx, self.grid.dy, self.groups.k**2
        by_P: dict[int, Any] = {}
        by_H: dict[int, Any] = {}
        size, n = P.shape, P.size

        def add(of: dict[int, Any], offset: int, where: Any, values: Any) -> None:
            if offset not in of:
                of[offset] = np.zeros(size, dtype=type(rate))
            of[offset][where] += values

        everywhere, nx = np.s_[:, :], size[1]
        for axis, pitch, factor, step in ((1, dx, 1.0, 1), (0, dy, k2, nx)):
            low = np.s_[:, :-1] if axis else np.s_[:-1]
            high = np.s_[:, 1:] if axis else np.s_[1:]
            mean, by_high, by_low = log_mean(eps[high], eps[low])
            slope = -factor * np.diff(P, axis=axis) / pitch**2
            flow = factor * mean / pitch**2
            # flux/pitch by pressure and film of the node below and above the face
            P_low, P_high = flow + slope * by_low * eps_P[low], -flow + slope * by_high * eps_P[high]
            H_low, H_high = 3 * slope * by_low / H[low], 3 * slope * by_high / H[high]
            # outflow of the node below, inflow of the node above
            twice = np.ones(P_low.shape)
            if axis == 0:
                twice[0] = 2  # half a cell at the plane of symmetry
            for of, at_low, at_high in ((by_P, P_low, P_high), (by_H, H_low, H_high)):
                add(of, 0, low, twice * at_low)
                add(of, step, low, twice * at_high)
                add(of, 0, high, -at_high)
                add(of, -step, high, -at_low)
        for of, q in ((by_P, rho_P * H), (by_H, rho)):
            # (2q₊ + 3q − 6q₋ + q₋₋)/6
            add(of, 0, everywhere, q / (2 * dx) + rate * q)
            add(of, 1, np.s_[:, :-1], q[:, 1:] / (3 * dx))
            add(of, -1, np.s_[:, 1:], -q[:, :-1] / dx)
            add(of, -2, np.s_[:, 2:], q[:, :-2] / (6 * dx))

        def matrix(of: dict[int, Any]) -> Any:
            data = []
            for offset, values in of.items():
                data.append(np.roll(values.ravel(), offset))
            return scipy.sparse.csr_array(scipy.sparse.dia_array((np.array(data), list(of)), shape=(n, n)))

        return matrix(by_P), matrix(by_H)
