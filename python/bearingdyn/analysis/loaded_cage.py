"""Cages at the speed that contact angles and inertia give the loaded balls, instead of the nominal one."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from bearingdyn.analysis.bearing_state import BearingState
from bearingdyn.analysis.equilibrium import Equilibrium
from bearingdyn.bearing import RIGID, BallBearing, Running
from bearingdyn.checks import instance, require
from bearingdyn.plausible_ranges import plausible
from bearingdyn.system import BearingTerm
from bearingdyn.types import Array


def cage_ratios(eq: Equilibrium, speed: float) -> dict[str, float]:
    """Cage speed over shaft speed of every ball bearing, from contact angles and inertia of its loaded balls.

    Each bearing carries the force that it has in the equilibrium, with the centrifugal force and the
    gyroscopic moment of its balls (`Running`). Balls that are pressed drive the cage, by what both rings
    press on them; it has their mean speed. Where nothing presses, the nominal ratio stays.

    Parameters
    ----------
    eq
        The static state.
    speed
        Of the shaft, rad/s, not zero.

    Returns
    -------
    dict
        Name -> ratio.

    Raises
    ------
    ValueError
        For a speed that is zero or not finite.
    ArithmeticError
        Where the balls of a bearing find no balance at that speed.

    Warns
    -----
    UnloadedBearing
        Where a bearing carries nothing: no ball drives its cage.

    Examples
    --------
    >>> import bearingdyn as bd
    >>> app = bd.Application()
    >>> app.add("rotor", bd.RigidBody(0.5, (1e-4, 1e-4, 1e-4), rotating=True))
    >>> app.ground("rotor.centre", stiffness=[0, 0, 0, 100, 100, 0])
    >>> app.bearing("b", bd.catalogue.bearing("6202", clearance=10e-6), inner="rotor.centre", outer="ground")
    >>> app.load("rotor.centre", (0, 0, 180.0, 0, 0, 0))
    >>> state = bd.equilibrium(app)
    >>> print(f"{state.system.bearings[0].bearing.cage_ratio:.4f}, {bd.cage_ratios(state, 523.6)['b']:.4f}")
    0.3809, 0.3849
    """
    instance("eq", eq, Equilibrium, "give what bd.equilibrium returns")
    speed = plausible("speed", "speed", speed, "it must be a finite speed in rad/s")
    require(speed != 0, "speed", speed, "at rest no cage turns: give the speed of the shaft in rad/s")
    eq.warn_of_unloaded("its cage is taken to have the nominal speed")
    return {
        term.name: _ratio(term, term.bearing, eq.bearings[term.name], speed)
        for term in eq.system.bearings
        if isinstance(term.bearing, BallBearing)
    }


def with_loaded_cages(eq: Equilibrium, speed: float) -> Equilibrium:
    """The same static state with its cages at the speeds of `cage_ratios`: a march from it has those lines.

    Parameters
    ----------
    eq
        The static state.
    speed
        Of the shaft, rad/s, not zero; the ratios are those of this one speed.

    Returns
    -------
    Equilibrium

    Raises
    ------
    ValueError, ArithmeticError
        As `cage_ratios`.
    """
    ratios = cage_ratios(eq, speed)
    terms = []
    for term in eq.system.bearings:
        bearing = term.bearing
        if isinstance(bearing, BallBearing):
            inner, outer = bearing.ring_speeds
            if inner != outer:
                against = (ratios[term.name] - outer) / (inner - outer)
                own = bearing.overrides._replace(cage_ratio=against)
                term = replace(term, bearing=replace(bearing, overrides=own))
        terms.append(term)
    return replace(eq, system=replace(eq.system, bearings=tuple(terms)))


def _ratio(term: BearingTerm, bearing: BallBearing, state: BearingState, speed: float) -> float:
    """Cage speed over shaft speed of one bearing."""
    smooth = replace(bearing, waviness=(), defects=(), oversize=())
    running = Running(smooth, speed)
    if not (state.loads > 0).any():
        return bearing.cage_ratio
    balls = running.balls(running.displacement(_load(smooth, state)))
    pressed = np.minimum(balls.Q_i, balls.Q_o)
    # clamped balls that nothing else loads may be thrown off the inner race
    if not pressed.sum() > 0:
        return bearing.cage_ratio
    return float((pressed @ balls.orbit) / pressed.sum() / speed)


def _load(bearing: BallBearing, state: BearingState) -> Array:
    """(6,) on the inner ring as a rigid one, N and N m."""
    g = np.array([state.g[state.series.index(*t)] for t in RIGID.terms])
    return np.asarray(bearing.coefficients().T @ g)
