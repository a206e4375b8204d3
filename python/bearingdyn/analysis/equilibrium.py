"""The static state from which everything else starts."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from bearingdyn.analysis.statics import BearingState, Statics, diagonal_blocks
from bearingdyn.application import Application
from bearingdyn.system import LoadTerm, System, assemble
from bearingdyn.types import Array


@dataclass(frozen=True, eq=False)
class Equilibrium:
    """A static state: x (n,) of the system, and every bearing and loose fit by name.

    Layers carry their relaxed modulus G0, or the instantaneous one if `modulus` says so. The free spin of
    shafts about z is left at zero.

    x: m and rad. Reference: paper section 4.1, whose linearisation starts from this state.
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
    """Nonlinear static state under the constant loads, the cages at `angle`, the shaft turned with them.

    The energy of the structure and of the balls is convex; its one minimum is found from anywhere by Newton
    steps in a trust region, clearances open or closed.

    Parameters
    ----------
    app
        Application, or its system.
    angle
        Of the cages, rad; waves and pits of a bearing stand where the shaft, at angle/cage_ratio, put
        them. The phases of unbalance and signals stay.
    start
        A state of the same application to begin from; it saves time, the result is the same.
    modulus
        Of the layers: "relaxed" G0, which all else starts from, or "instantaneous", right after a sudden
        load.
    average
        The bearings' tangents are averaged over this many cage angles of a ball passage, for a harmonic
        response that favours none. The state is that of `angle`.

    Raises ValueError where a body is free to move, ArithmeticError where no balance is found, which names the
    body that lost its support.

    Returns an Equilibrium. Reference: J. J. Moré and D. C. Sorensen, SIAM J. Sci. Stat. Comput. 4 (1983) 553.
    """
    system = app if isinstance(app, System) else assemble(app)
    if not math.isfinite(angle):
        raise ValueError(f"angle is {angle}; the cage angle must be finite, in rad")
    if not (average >= 1 and average % 1 == 0):
        raise ValueError(f"average is {average}; it must be a whole number of cage angles, at least 1")
    if start is not None and start.x.shape != (system.n,):
        raise ValueError(
            f"start has {start.x.size} coordinates and the system {system.n}; start from a state of the same "
            f"application"
        )
    rest = Statics.of(system, modulus)
    q = None if start is None else rest.T.T @ (system.M @ start.x)
    passage: list[dict[str, BearingState]] = []
    first, x = system, np.zeros(system.n)
    for i in range(int(average)):
        # the angle stays with the system, so that what starts from here finds the balls where they are
        bearings = tuple(
            replace(t, bearing=t.bearing.turned(angle + i / average * 2 * math.pi / t.bearing.Z))
            for t in system.bearings
        )
        q, states = rest.balance(bearings, q)
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


def with_loads(system: System, loads: tuple[LoadTerm, ...]) -> System:
    """The system under other loads."""
    return replace(system, loads=loads)
