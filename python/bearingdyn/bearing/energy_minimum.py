"""The position in which a set of contacts carries a load: the minimum of a convex energy.

Each indentation is the distance of two points less a constant, a convex function of the coefficients, and the
stored energy (2/5)κs^{5/2} is convex and increasing in it: the energy less the work of a dead load has one
minimum, and Newton steps within a trust region reach it from anywhere, contacts open or closed, without load
stepping.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import TypeAlias

import numpy as np
import scipy

from bearingdyn.types import Array

Law: TypeAlias = Callable[[Array], tuple[float, Array, Array, float]]
"""z (n,) -> energy J, its gradient (n,), its Hessian (n, n), and the sum of the contact loads N."""

# bearings take 5 to 25 steps; a force known to 1e-12 of the load leaves displacements near round-off
_STEPS = 400
_TOLERANCE = 1e-12
# N: contacts that carry nothing but are touched (waves, pits, no load) part ever more slowly, s → s/3 a step;
# below this force they have
_PARTED = 1e-20


class NoBalance(ArithmeticError):
    """No minimum of the energy was found; z (n,) is where the search ended."""

    def __init__(self, message: str, z: Array) -> None:
        super().__init__(message)
        self.z = z


def minimum(law: Law, load: Array, radius: float, start: Array | None = None) -> Array:
    """Minimum of the energy less load·z over coefficients z (n,): its gradient balances `load` (n,).

    Where the energy is flat (a ring that rests on one or two balls) the coordinate stays where it is.

    Parameters
    ----------
    law
        Stored energy, gradient, positive semi-definite Hessian, sum of contact loads.
    load
        (n,) generalised load, N.
    radius
        First size of the trust region, of the order of the expected displacement, m.
    start
        (n,) where the search begins; zero by default.

    Raises
    ------
    NoBalance
        An ArithmeticError: if no balance is found; the message gives the residual.
    """
    z = np.zeros_like(load) if start is None else start.copy()
    energy, g, H, held = law(z)
    r = g - load
    for _ in range(_STEPS):
        scale = float(np.linalg.norm(load)) + held
        residual = float(np.linalg.norm(r))
        if residual <= max(_TOLERANCE * scale, _PARTED):
            return z
        step = _step(r, H, radius, _TOLERANCE / 10 * scale)
        size = float(np.linalg.norm(step))
        trial = law(z + step)
        r_trial = trial[1] - load
        gain = energy - trial[0] + float(load @ step)
        promised = -float(step @ r) - 0.5 * float(step @ H @ step)
        better = float(np.linalg.norm(r_trial)) < residual
        # energies agree to round-off near the minimum; there the residual decides
        if not better and size <= 8 * np.finfo(float).eps * float(np.linalg.norm(z)):
            return z
        if gain > 0.75 * promised:
            radius = max(radius, 3 * size)
        elif gain < 0.1 * promised and not better:
            radius = size / 4
        if gain > 1e-4 * promised or better:
            z, r = z + step, r_trial
            energy, g, H, held = trial
    raise NoBalance(
        f"no equilibrium within {_STEPS} Newton steps under the load {load.tolist()}: "
        f"residual {residual:.3g} N; is the load within what the bearing can carry?",
        z,
    )


def _step(r: Array, H: Array, radius: float, negligible: float) -> Array:
    """Minimiser of r·d + ½ d·H d over |d| ≤ radius (Moré & Sorensen 1983); zero where all is flat."""
    stiffness, modes = np.linalg.eigh(H)
    stiffness = np.maximum(stiffness, 0.0)
    force = modes.T @ r
    force[np.abs(force) <= negligible] = 0.0

    def along(mu: float) -> Array:
        with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
            return np.where(force == 0, 0.0, -force / (stiffness + mu))

    def shortfall(mu: float) -> float:
        reach = float(np.linalg.norm(along(mu)))
        return 1 / reach - 1 / radius if reach > 0 else math.inf

    if shortfall(0.0) >= 0:
        return modes @ along(0.0)
    limit = float(np.linalg.norm(force)) / radius
    if shortfall(limit) <= 0:
        return modes @ along(limit)
    return modes @ along(float(scipy.optimize.brentq(shortfall, 0.0, limit, rtol=1e-8)))
