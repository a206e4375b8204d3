"""First stage of a fit: relaxation times by variable projection, the strengths solved for inside."""

from __future__ import annotations

import numpy as np
import scipy

from bearingdyn.material.identification.bounds import Limits
from bearingdyn.material.identification.points_in_band import MARGIN, PIN_WEIGHT, Points
from bearingdyn.material.relaxation_spectrum import Strengths, branch_slopes, solve_strengths, unit_columns
from bearingdyn.types import Array


class Projection:
    """Variable projection: relaxation times; strengths in the order spring, branches, dashpot."""

    def __init__(self, points: Points, limits: Limits) -> None:
        self.points, self.limits = points, limits
        self.free = limits.log_upper > limits.log_lower
        self._last: tuple[bytes, Strengths] | None = None

    def _times(self, theta: Array) -> Array:
        log_tau = self.limits.log_lower.copy()
        log_tau[self.free] = theta
        return np.asarray(np.exp(log_tau))

    def _solve(self, theta: Array) -> Strengths:
        key = theta.tobytes()
        if self._last is None or self._last[0] != key:
            omega = self.points.omega
            A = self.points.stack(*unit_columns(omega, self._times(theta)))
            A = np.vstack([A, PIN_WEIGHT * self.points.pin_row(self._times(theta))])
            target = np.ones(A.shape[0])
            target[2 * omega.size :] = PIN_WEIGHT
            found = solve_strengths(A, target, self.limits.lower, self.limits.upper)
            self._last = key, found
        return self._last[1]

    def _jacobian(self, theta: Array) -> Array:
        solution = self._solve(theta)
        storage, loss = branch_slopes(self.points.omega, self._times(theta))
        G = solution.x[1:-1]
        pinned = PIN_WEIGHT * self.points.pin_slope(self._times(theta)) * G
        slopes = np.vstack([self.points.stack(storage * G, loss * G), pinned])
        return solution.project_out(slopes)[:, self.free]

    def run(self, spread: float) -> tuple[Array, Array]:
        """Times and strengths from a start equispaced over the band, widened by `spread` decades on both
        sides."""
        low, high = self.points.limits
        margin = MARGIN * (1 - spread)
        edges = np.linspace(low + margin, high - margin, self.free.size + 1)
        lower, upper = self.limits.log_lower[self.free], self.limits.log_upper[self.free]
        start = np.clip(((edges[:-1] + edges[1:]) / 2)[self.free], lower, upper)
        if start.size:
            start = scipy.optimize.least_squares(
                lambda theta: self._solve(theta).residual,
                start,
                jac=self._jacobian,
                bounds=(lower, upper),
                xtol=1e-8,
                ftol=1e-10,
                max_nfev=150,
            ).x
        return self._times(start), self._solve(start).x
