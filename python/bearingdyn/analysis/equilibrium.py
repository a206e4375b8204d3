"""The static state from which everything else starts."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from bearingdyn.analysis.statics import BearingState, Statics, diagonal_blocks
from bearingdyn.application import Application
from bearingdyn.bearing import OPEN_SIDE_REMEDY, runs_off
from bearingdyn.checks import number, whole
from bearingdyn.system import BearingTerm, LoadTerm, System, assemble
from bearingdyn.types import Array


@dataclass(frozen=True, eq=False)
class Equilibrium:
    """A static state, from which every other analysis starts.

    The free spin of shafts about z is left at zero.

    Parameters
    ----------
    system
        The system that is in balance, its bearings at the angle asked for.
    x
        Displacement (n,), m and rad.
    bearings
        State of every bearing and loose fit, by name.
    modulus
        Modulus that the layers have: "relaxed" or "instantaneous".

    References
    ----------
    Paper section 4.1, whose linearisation starts from this state.
    """

    system: System
    x: Array
    bearings: Mapping[str, BearingState]
    modulus: str = "relaxed"

    def __repr__(self) -> str:
        """One line; the matrices are in `system`."""
        loaded = [
            f"{name} {b.loads[b.loads > 0].size} of {b.loads.size}" for name, b in self.bearings.items()
        ]
        balls = f", balls loaded: {', '.join(loaded)}" if loaded else ""
        return f"<Equilibrium of {self.system.n} coordinates, layers {self.modulus}{balls}>"

    def displacement(self, name: str) -> Array:
        """Static motion of an interface or point, (6,) or (3,), m and rad."""
        return self.system.rows(name) @ self.x

    @property
    def bearing_K(self) -> Array:
        """Tangent stiffness of all bearings on their coefficients, block-diagonal, N/m."""
        return diagonal_blocks([b.K for b in self.bearings.values()])

    @property
    def bearing_C(self) -> Array:
        """Tangent damping of all bearings on their coefficients, block-diagonal, N s/m."""
        return diagonal_blocks([b.C for b in self.bearings.values()])

    def linearised(self) -> System:
        """The system about this state: bearings replaced by their tangents, constant loads left out."""
        s = self.system
        B = s.B
        return replace(
            s,
            K=s.K + B.T @ self.bearing_K @ B,
            C=s.C + B.T @ self.bearing_C @ B,
            bearings=(),
            loads=tuple(load for load in s.loads if load.kind != "constant"),
        )


def equilibrium(
    app: Application | System,
    angle: float = 0.0,
    *,
    start: Equilibrium | None = None,
    modulus: str = "relaxed",
    average: int = 1,
) -> Equilibrium:
    """Find the nonlinear static state under the constant loads, with the cages at `angle`.

    The energy of the structure and of the balls is convex. Newton steps in a trust region find its one
    minimum from any start, whether clearances are open or closed.

    Parameters
    ----------
    app
        Application, or its system.
    angle
        Of the cages, rad. The shaft has then turned by angle/cage_ratio, and the waves and pits of a
        bearing with it. The phases of unbalance and signals stay.
    start
        A state of the same application to begin from; it saves time and does not change the result.
    modulus
        Of the layers: "relaxed", their G0, which the other analyses start from, or "instantaneous", as right
        after a sudden load.
    average
        Number of cage angles within one ball passage over which the tangents of the bearings are averaged,
        so that a harmonic response favours no angle. The state itself is that of `angle`.

    Returns
    -------
    Equilibrium

    Raises
    ------
    ValueError
        Where a body is free to move, or a load presses balls onto the open side of a bearing.
    ArithmeticError
        Where there is no balance; names the body that lost its support.

    References
    ----------
    J. J. Moré and D. C. Sorensen, SIAM J. Sci. Stat. Comput. 4 (1983) 553.
    """
    angle, average = number("angle", angle, "give one finite angle, in rad"), whole("average", average, 1)
    system = app if isinstance(app, System) else assemble(app)
    if start is not None and start.x.shape != (system.n,):
        raise ValueError(
            f"start has {start.x.size} coordinates and the system {system.n}; start from a state of the same "
            f"application"
        )
    rest = Statics.of(system, modulus)
    q = None if start is None else rest.T.T @ (system.M @ start.x)
    passage: list[dict[str, BearingState]] = []
    first, x = system, np.zeros(system.n)
    for i in range(average):
        # the angle stays with the system, so that what starts from here finds the balls where they are
        bearings = tuple(
            replace(t, bearing=t.bearing.turned(angle + i / average * 2 * math.pi / t.bearing.Z))
            for t in system.bearings
        )
        q, states = rest.balance(bearings, q)
        _check_open_sides(bearings, states)
        passage.append(states)
        if i == 0:
            first, x = replace(system, bearings=bearings), rest.T @ q
    mean = {
        name: replace(
            state,
            K=np.mean([s[name].K for s in passage], axis=0),
            C=np.mean([s[name].C for s in passage], axis=0),
        )
        for name, state in passage[0].items()
    }
    return Equilibrium(first, x, mean, modulus)


def _check_open_sides(bearings: Sequence[BearingTerm], states: Mapping[str, BearingState]) -> None:
    """Refuse a state in which balls carry where their bearing has no shoulder: ValueError."""
    for term in bearings:
        kernel, state = term.kernel(), states[term.name]
        astray = runs_off(kernel, state.z, state.loads, kernel.angle0)
        if astray:
            force = ", ".join(f"{f:.4g}" for f in state.force)
            raise ValueError(f"bearing {term.name!r} is loaded by ({force}) N; {astray}; {OPEN_SIDE_REMEDY}")


def with_loads(system: System, loads: tuple[LoadTerm, ...]) -> System:
    """The system under other loads."""
    return replace(system, loads=loads)
