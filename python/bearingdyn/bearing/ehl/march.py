"""The contact in time: a given approach, or a ball that is free, through lost contact."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from bearingdyn.bearing.ehl.dimensionless_groups import LOAD
from bearingdyn.bearing.ehl.newton import Border, newton
from bearingdyn.bearing.ehl.steady_film import Steady
from bearingdyn.checks import number, positive, require
from bearingdyn.types import Array


@dataclass(frozen=True, repr=False)
class March:
    """A march of the lubricated contact in time T = t um/a; arrays (steps + 1,), the start included."""

    T: Array
    approach: Array
    """Approach of the bodies over that of the dry contact under the steady load."""
    velocity: Array
    """Its rate by T."""
    force: Array
    """Force of the film over the steady load."""
    Hc: Array
    """Film at the centre, h/Rx √(E′Rx/(η0us))."""
    Hmin: Array
    """Least film, likewise."""
    newton_steps: NDArray[np.int64]
    """Newton steps of each time step."""


def march(
    start: Steady,
    *,
    dt: float,
    steps: int,
    approach: Callable[[float], float] | None = None,
    mass: float | None = None,
    load: Callable[[float], float] | float = 1.0,
    velocity: float = 0.0,
) -> March:
    """March the film in time from a steady state, on its finest grid.

    Both are of second order: the backward formula (BDF2) for the film, which forgets, and the average
    acceleration for the ball, which takes no energy from it.

    Parameters
    ----------
    start
        Steady state; `steady(M, L, D, grid=65)` is enough for most motions.
    dt
        Time step, in a/um; with T = t um/a.
    steps
        Number of steps.
    approach
        Given motion: what is added to the steady approach at T, over the dry approach; zero at T = 0.
    mass
        Or a free ball: m (um/a)²/K_Hertz with K_Hertz = 1.5 F/δ_dry.
    load
        Load on the free ball over the steady load F, a number or a function of T; it may be negative.
    velocity
        Rate of the free ball's approach by T at T = 0.

    Returns
    -------
    March

    Raises
    ------
    ValueError
        If a value is out of range, or neither or both of `approach` and `mass` are given.
    ArithmeticError
        If a step does not converge: take a smaller one.

    Notes
    -----
    Where the pressure is zero the gap counts as filled when it closes again: oil is at hand at all times.
    """
    require(isinstance(start, Steady), "start", start, "give the result of ehl.steady")
    h = positive("dt", dt, "the time step in a/um must be positive and finite")
    whole = isinstance(steps, int | np.integer) and steps >= 1
    require(whole, "steps", steps, "it must be a whole number of 1 or more")
    one = (approach is None) != (mass is None)
    require(
        one, "approach, mass", (approach, mass), "give the approach over time, or the mass of a free ball"
    )
    if approach is not None:
        zero = number("approach(0)", approach(0.0))
        require(zero == 0, "approach(0)", zero, "it must be zero: the motion starts from the steady state")
    v = number("velocity", velocity)
    level = start.levels[-1]
    equations, state = level.equations, level.state
    grid, groups = equations.grid, equations.groups
    dry = groups.approach

    # δ = −H0; the ball: inertia·δ″ = load − ∫∫P/LOAD
    remedy = "it must be positive, over K_Hertz (a/um)²"
    inertia = 0.0 if mass is None else 1.5 * positive("mass", mass, remedy) / dry
    q0 = q1 = equations.carried(state.P, state.H)
    P0 = P1 = state.P
    d0, v0 = -state.H0, v * dry
    d1, a0 = d0 - h * v0, 0.0
    if mass is not None:
        a0 = (number("load(0)", load(0.0) if callable(load) else load) - 1) / inertia
    rest = d0
    rows = [(d0 / dry, v, 1.0, float(state.H[0, grid.origin]), float(state.H.min()), 0)]
    for k in range(1, steps + 1):
        T = k * h
        if approach is not None:
            target = rest + dry * number(f"approach({T:g})", approach(T))
            border = Border(load=-target, mass=1.0, force=0.0)
        else:
            pushed = number(f"load({T:g})", load(T) if callable(load) else load)
            known = 4 / h**2 * (d0 + h * v0) + a0
            border = Border(load=LOAD * (pushed + inertia * known), mass=-LOAD * inertia * 4 / h**2)
        history = (q1 - 4 * q0) / (2 * h)
        guess = np.maximum(2 * P0 - P1, 0.0)
        H0 = state.H0 + (state.H0 + d1)
        if not (equations.film(guess, H0) > 0.2 * state.H).all():
            guess, H0 = P0, state.H0
        try:
            state = newton(equations, guess, H0, border, rate=1.5 / h, history=history)
        except ArithmeticError as failure:
            raise ArithmeticError(
                f"at T = {T:g}, step {k}: {failure}; take a smaller dt than {h:g}"
            ) from None
        q1, q0 = q0, equations.carried(state.P, state.H)
        P1, P0 = P0, state.P
        d2, d1, d0 = d1, d0, -state.H0
        if mass is None:
            v0 = (3 * d0 - 4 * d1 + d2) / (2 * h)
        else:
            a1 = a0
            a0 = 4 / h**2 * (d0 - d1 - h * v0) - a1
            v0 += h / 2 * (a1 + a0)
        force = float((grid.weights * state.P).sum()) / LOAD
        rows.append(
            (d0 / dry, v0 / dry, force, float(state.H[0, grid.origin]), float(state.H.min()), state.steps)
        )
    table = np.array(rows)
    return March(
        T=np.asarray(h * np.arange(steps + 1)),
        approach=table[:, 0],
        velocity=table[:, 1],
        force=table[:, 2],
        Hc=table[:, 3] * groups.moes,
        Hmin=table[:, 4] * groups.moes,
        newton_steps=table[:, 5].astype(np.int64),
    )
