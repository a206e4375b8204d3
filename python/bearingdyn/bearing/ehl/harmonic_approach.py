"""A small harmonic approach of the bodies about the steady state."""

from __future__ import annotations

import numpy as np

from bearingdyn.bearing.ehl.dimensionless_groups import LOAD
from bearingdyn.bearing.ehl.linearised import Linearised
from bearingdyn.bearing.ehl.newton import State
from bearingdyn.bearing.ehl.reynolds import Reynolds

_TOLERANCE = 1e-9


def quasi_static(equations: Reynolds, state: State) -> tuple[float, float]:
    """Answer to a slow harmonic approach: K0 over Hertz' stiffness, and C0 of c = C0 (F/δ_dry)(a/um)."""
    grid, oil, H = equations.grid, equations.oil, state.H
    system = Linearised(equations, state.P, H, state.free)
    weights = grid.weights[state.free]
    first = system.solve(-system.by_approach, _TOLERANCE)
    p = np.zeros(grid.shape)
    p[state.free] = first
    rho, rho_P = oil.relative_density(state.P)
    # ∂T of ρ̄H under the pressures of the static term and the approach itself
    squeeze = rho_P * H * p + rho * (equations.deflection(p) - 1)
    second = system.solve(-squeeze[state.free], _TOLERANCE)
    hertz = 1.5 * LOAD / equations.groups.approach
    return float(weights @ first) / hertz, 1.5 * float(weights @ second) / hertz


def stiffness(equations: Reynolds, state: State, Omega: complex) -> complex:
    """F̂/δ̂ over Hertz' stiffness of a harmonic approach δ̂ e^{iΩT}."""
    system = Linearised(equations, state.P, state.H, state.free, 1j * complex(Omega))
    p = system.solve(-system.by_approach, _TOLERANCE)
    hertz = 1.5 * LOAD / equations.groups.approach
    return complex(equations.grid.weights[state.free] @ p) / hertz
