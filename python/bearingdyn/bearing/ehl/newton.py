"""Pressure, film and approach by a damped Newton method with an active set for P ≥ 0."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from bearingdyn.bearing.ehl.dimensionless_groups import LOAD
from bearingdyn.bearing.ehl.linearised import Linearised
from bearingdyn.bearing.ehl.reynolds import Reynolds
from bearingdyn.types import Array

_LIMIT = 60  # Newton steps; 8 to 14 are usual
_THINNEST = 0.2  # share of its film that a node keeps in one step
_SHORTEST = 1e-4  # share of a Newton step
_TOLERANCE = 1e-11  # mass defect of a cell over the flow through it
_CLOSED = 1e-12  # what may be missing of the border


class NegativeFilm(ArithmeticError):
    """Newton's method finds no step that keeps the film positive: the grid is too coarse."""


@dataclass(frozen=True)
class State:
    """One solution of Newton's method: P and H (ny, nx), and H0, the centre's film less its deflection."""

    P: Array
    H: Array
    H0: float
    free: NDArray[np.bool_]
    """Nodes where Reynolds' equation holds; elsewhere the pressure is zero."""
    residual: Array
    """f (ny, nx): zero where free, not negative elsewhere on the inner nodes."""
    steps: int


@dataclass(frozen=True)
class Border:
    """The border of Newton's equations, for H0: a given load, a given motion, or a free body's."""

    load: float = LOAD
    mass: float = 0.0
    force: float = 1.0

    def missing(self, total: float, H0: float) -> float:
        """What is missing of the load with ∫∫ P = total."""
        return self.load - self.force * total - self.mass * H0

    def scale(self, H0: float) -> float:
        """Size of the largest term."""
        return max(abs(self.load), abs(self.force) * LOAD, abs(self.mass * H0))


def newton(
    equations: Reynolds,
    P: Array,
    H0: float,
    border: Border,
    *,
    rate: float = 0.0,
    history: Array | float = 0.0,
) -> State:
    """Newton's method for f + rate·ρ̄H + history = 0, P ≥ 0, and the border, from a positive film.

    Raises
    ------
    NegativeFilm
        If no step keeps the film positive: the grid is too coarse.
    ArithmeticError
        If the iteration does not converge.
    """
    grid = equations.grid
    weights = border.force * grid.weights
    H = equations.film(P, H0)
    if not (H > 0).all():
        raise NegativeFilm("the film to start from is not positive")

    def residual(P: Array, H: Array) -> Array:
        full = equations.residual(P, H) + rate * equations.carried(P, H) + history
        return np.where(grid.inner, full, 0.0)

    f = residual(P, H)
    defect = math.inf
    for k in range(_LIMIT):
        free = grid.inner & ((P > 0) | (f < 0))
        flow = max(float(H[0, grid.origin]) / grid.dx, rate * float(H[0, grid.origin]))
        defect = float(np.abs(f[free]).max(initial=0.0)) / flow
        missing = border.missing(float((grid.weights * P).sum()), H0)
        if k and defect <= _TOLERANCE and abs(missing) <= _CLOSED * border.scale(H0):
            return State(P, H, H0, free, f, k)
        change = np.zeros_like(P)
        if free.any():
            system = Linearised(equations, P, H, free, rate)
            # a quadratic method needs no more digits than the next step has
            tolerance = min(1e-2, max(1e-5, 0.1 * defect))
            change[free], lift = system.bordered(-f[free], weights[free], missing, border.mass, tolerance)
        elif border.mass:
            lift = missing / border.mass
        else:
            raise ArithmeticError("the contact is lost, and no mass holds the bodies")
        share = 1.0
        while True:
            tried = np.maximum(P + share * change, 0.0)
            film = equations.film(tried, H0 + share * lift)
            if (film > _THINNEST * H).all():
                break
            share /= 2
            if share < _SHORTEST:
                raise NegativeFilm("no step keeps the film positive")
        P, H, H0 = tried, film, H0 + share * lift
        f = residual(P, H)
    raise ArithmeticError(
        f"the film has not converged in {_LIMIT} steps: a cell misses {defect:.1e} of the flow through it"
    )
