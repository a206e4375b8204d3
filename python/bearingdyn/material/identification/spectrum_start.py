"""A fit's first guess from the dense spectrum, and the branch that would help a fit most.

The best non-negative dense spectrum is one of a convex problem, so it does not depend on a start or on the
last bits of the arithmetic, as a search for relaxation times does; and it is sparse: a few groups of
neighbouring times have strength. Each group is a branch; while there are too many of them, the two
neighbours, or the end, go that cost least.

References: C.L. Lawson, R.J. Hanson, Solving Least Squares Problems (1974), ch. 23 (the condition of
Kuhn and Tucker that `most_useful` looks at); N. Boyd, G. Schiebinger, B. Recht, SIAM J. Optim. 27 (2017) 616
(adding the element of steepest descent, then moving all).
"""

from __future__ import annotations

import math

import numpy as np

from bearingdyn.material.identification.bounds import Limits
from bearingdyn.material.identification.points_in_band import PIN_WEIGHT, Points
from bearingdyn.material.identification.polish import Polished
from bearingdyn.material.relaxation_spectrum import solve_strengths, unit_columns
from bearingdyn.types import Array

_PER_DECADE = 12
# A column that the fit's own parameters nearly span promises more to first order than it can give
_NEW_SHARE = 1e-3


def merged_spectrum(points: Points, limits: Limits) -> tuple[Array, Array]:
    """Start of a fit from the dense spectrum merged to n branches: times and strengths."""
    n = limits.log_lower.size

    def solve(log_tau: Array, within: Limits) -> tuple[float, Array]:
        tau = np.exp(log_tau)
        A, target = points.log_problem(tau)
        A = np.vstack([A, PIN_WEIGHT * points.pin_row(tau)])
        target = np.concatenate([target, np.full(A.shape[0] - target.size, PIN_WEIGHT)])
        found = solve_strengths(A, target, within.lower, within.upper)
        return float(found.residual @ found.residual), found.x

    low, high = points.limits
    grid = _grid(points)
    x = solve(grid, limits.alike(grid.size))[1][1:-1]
    log_tau, weight = _groups(grid, x)
    while log_tau.size > n:
        tried = [np.delete(log_tau, 0), np.delete(log_tau, -1)]
        for i in range(log_tau.size - 1):
            middle = np.average(log_tau[i : i + 2], weights=weight[i : i + 2])
            tried.append(np.concatenate([log_tau[:i], [middle], log_tau[i + 2 :]]))
        found = [solve(guess, limits.alike(guess.size)) for guess in tried]
        least = min(range(len(tried)), key=lambda k: found[k][0])
        log_tau, weight = tried[least], np.maximum(found[least][1][1:-1], np.finfo(np.float64).tiny)
    while log_tau.size < n:  # a branch to spare goes into the widest gap
        edges = np.concatenate([[low], log_tau, [high]])
        widest = int(np.argmax(np.diff(edges)))
        log_tau = np.insert(log_tau, widest, edges[widest : widest + 2].mean())
    log_tau = np.clip(log_tau, limits.log_lower, limits.log_upper)
    return np.exp(log_tau), solve(log_tau, limits)[1]


def most_useful(points: Points, fit: Polished, limits: Limits) -> tuple[float, Array, Array]:
    """Spectrum to start from, one term more: what a polished fit would gain by a branch, spring or dashpot.

    The gain is a share of the sum of squares, to first order, the fit's own parameters following; zero
    where no addition lowers it.
    """
    tau = np.exp(_grid(points))
    rows = 2 * points.omega.size  # the pin, which holds the sum of all, has no say in what is missing
    own_s, own_l = unit_columns(points.omega, fit.tau)
    storage, loss = unit_columns(points.omega, tau)
    storage = storage / (own_s @ fit.strengths)[:, None]
    loss = loss / (own_l @ fit.strengths)[:, None]
    J = np.vstack([storage, loss - storage])
    slope = J.T @ fit.residual[:rows]
    basis = np.linalg.qr(fit.jacobian[:rows])[0]
    rest = J - basis @ (basis.T @ J)
    curvature = np.maximum((rest**2).sum(axis=0), _NEW_SHARE * (J**2).sum(axis=0))
    gain = np.where(slope < 0, slope**2 / (2 * curvature), 0.0)
    for end in (0, -1):
        if fit.strengths[end] > 0 or not limits.upper[end] > 0:
            gain[end] = 0.0
    best = int(np.argmax(gain))
    strength = -slope[best] / curvature[best]
    share = float(gain[best] / fit.cost) if fit.cost > 0 else 0.0
    x, times = fit.strengths.copy(), fit.tau
    if 0 < best <= tau.size:
        place = int(np.searchsorted(times, tau[best - 1]))
        times, x = np.insert(times, place, tau[best - 1]), np.insert(x, 1 + place, strength)
    else:
        x[0 if best == 0 else -1] = strength
    return share, times, x


def _grid(points: Points) -> Array:
    """ln of relaxation times equispaced over what the band can tell."""
    low, high = points.limits
    return np.linspace(low, high, 1 + math.ceil((high - low) / math.log(10) * _PER_DECADE))


def _groups(grid: Array, x: Array) -> tuple[Array, Array]:
    """Mean ln τ and strength of each group of neighbours that have strength."""
    active = np.flatnonzero(x > 0)
    parts = np.split(active, np.flatnonzero(np.diff(active) > 1) + 1) if active.size else []
    mean = [float(np.average(grid[part], weights=x[part])) for part in parts]
    return np.array(mean), np.array([float(x[part].sum()) for part in parts])
