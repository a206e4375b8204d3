"""The static state from which everything else starts."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from bearingdyn.analysis.bearing_state import BearingState
from bearingdyn.analysis.lubricated_balls import averaged, contact_angles, lubricated_balls
from bearingdyn.analysis.static_balance import Statics, diagonal_blocks
from bearingdyn.analysis.strained_rubber import warn_of_strained_rubber
from bearingdyn.application import Application
from bearingdyn.bearing import (
    OPEN_SIDE_REMEDY,
    RIGID,
    BallBearing,
    check_bearing_pressure,
    check_light,
    lubricated,
    runs_off,
    warn_of_lean,
)
from bearingdyn.checks import one_of, positive, require, whole
from bearingdyn.material import is_volume
from bearingdyn.notice import UnloadedBearing, warn
from bearingdyn.pictures import picture
from bearingdyn.plausible_ranges import plausible
from bearingdyn.system import BearingTerm, LoadTerm, System, system_of, warn_at_rest
from bearingdyn.types import Array, Complex
from bearingdyn.units import takes

PARTED = 1e-9
"""Load, N, below which a ball is not pressed: what a search leaves where nothing pushes, and no weight is."""


@dataclass(frozen=True, eq=False)
class Equilibrium:
    """The static equilibrium, from which every other analysis starts.

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
        Modulus that the layers have: "relaxed", "instantaneous" or "after" a time.
    after
        That time, s, for which the load has rested on them; None otherwise.
    average
        Number of cage angles over which the tangents are averaged.

    References
    ----------
    Paper section 4.1, whose linearisation starts from this state.
    """

    system: System
    x: Array
    bearings: Mapping[str, BearingState]
    modulus: str = "relaxed"
    after: float | None = None
    average: int = 1

    @property
    def layers(self) -> str:
        """State of the layers in words: "relaxed", "instantaneous" or "after 3600 s"."""
        return self.modulus if self.after is None else f"after {self.after:g} s"

    @property
    def moduli(self) -> dict[str, float]:
        """Shear modulus of each layer in this state, Pa, by part."""
        G = self.system.static_moduli(self.modulus if self.after is None else self.after)
        return {
            t.part: value for t, value in zip(self.system.layers, G, strict=True) if not is_volume(t.material)
        }

    def _repr_html_(self) -> str:
        return str(picture("as_html", self))

    def __repr__(self) -> str:
        """One line; the matrices are in `system`."""
        loaded = [
            f"{name} {np.count_nonzero(b.loads > PARTED)} of {b.loads.size}"
            for name, b in self.bearings.items()
        ]
        balls = f", balls loaded: {', '.join(loaded)}" if loaded else ""
        return f"<Equilibrium of {self.system.n} coordinates, layers {self.layers}{balls}>"

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

    @property
    def filmed(self) -> bool:
        """Whether a bearing runs on films, which answer by frequency."""
        return any(b.balls is not None for b in self.bearings.values())

    def balls(self, omega: Array) -> tuple[Complex, Array] | None:
        """What lubricated balls add to that by frequency, of all bearings; None where none runs on films.

        Their stiffness beside the tangents (f, b), N/m, at omega (f,), rad/s, and the v (b, coefs) of each,
        whose v vᵀ it multiplies.
        """
        ends = np.cumsum([0, *(len(b.K) for b in self.bearings.values())])
        added, across = [], []
        for first, state in zip(ends, self.bearings.values(), strict=False):
            if state.balls is not None:
                added.append(state.balls.stiffness(omega))
                wide = np.zeros((len(state.balls.across), ends[-1]))
                wide[:, first : first + len(state.K)] = state.balls.across
                across.append(wide)
        return (np.hstack(added), np.vstack(across)) if added else None

    @property
    def presses(self) -> bool:
        """Whether any ball is pressed."""
        return any((state.loads > PARTED).any() for state in self.bearings.values())

    def warn_of_unloaded(self, so: str = "in a linear analysis it has no stiffness") -> None:
        """Warn of every bearing without a pressed ball, and say what follows from it."""
        for name, state in self.bearings.items():
            if isinstance(self._bearing(name), BallBearing) and not (state.loads > PARTED).any():
                warn(
                    f"bearing {name!r} carries no load in this equilibrium: none of its {state.loads.size} "
                    f"balls is pressed, and {so}; load it (app.gravity, app.load, an "
                    f"axial preload by offset=), or give it no clearance",
                    UnloadedBearing,
                )

    def _bearing(self, name: str) -> object:
        return next((t.bearing for t in self.system.bearings if t.name == name), None)

    def linearised(self) -> System:
        """The system about this state: bearings replaced by their tangents, constant loads left out.

        Warns
        -----
        UnloadedBearing
            Where a bearing carries nothing.
        """
        self.warn_of_unloaded()
        s = self.system
        B = s.B
        return replace(
            s,
            K=s.K + B.T @ self.bearing_K @ B,
            C=s.C + B.T @ self.bearing_C @ B,
            bearings=(),
            loads=tuple(load for load in s.loads if load.kind != "constant"),
        )


@takes(angle="rad", after="s")
def equilibrium(
    app: Application | System,
    angle: float = 0.0,
    *,
    start: Equilibrium | None = None,
    modulus: str | None = None,
    after: float | None = None,
    average: int = 1,
) -> Equilibrium:
    """Find the static equilibrium under the constant loads, with the cages at `angle`.

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
        Of the layers: "relaxed", their G0, which marches start from and which is the default, or
        "instantaneous", as right after a sudden load.
    after
        Instead: the layers at G(t) after this time, s, at the temperature that they have. Where data still
        fall at their low end, G0 is an extrapolation, and the choice of a fit decides it; a sag is G(t) at a
        stated time.
    average
        Number of cage angles within one ball passage over which the tangents of the bearings are averaged,
        so that a harmonic response favours no angle. The state itself is that of `angle`.

    Returns
    -------
    Equilibrium
        Of the application as it is now: what is added afterwards is not in it, nor in what starts from it.

    Raises
    ------
    ValueError
        Where a body is free to move, where a load presses balls onto the open side of a bearing, where a
        contact pressure is above 21 GPa; for `after` that is not positive, or together with `modulus`.
    ArithmeticError
        Where there is no balance; names the body that lost its support.

    Warns
    -----
    BearingWarning
        Where a contact pressure exceeds 4.2 GPa (ISO 76); the bearing and the ball are named.
    UnusualMagnitude
        Where a place goes farther than 0.05 m, or the most loaded ball bears less than 5e-4 of what its
        static rating allows: a stiffness in N/µm, a load in kN.
    BeyondData
        Where the data of a layer's material do not speak of the time asked for, and show no plateau.
    StrainedLayer
        Where a layer is displaced so far across the axis, or a solid's rubber strained so far, that its
        linear stiffness is 1 % wrong or more.

    References
    ----------
    J. J. Moré and D. C. Sorensen, SIAM J. Sci. Stat. Comput. 4 (1983) 553.
    """
    angle = plausible("turned angle", "angle", angle, "give one finite angle, in rad")
    average = whole("average", average, 1)
    if after is not None:
        require(modulus is None, "modulus", modulus, f"with after={after!r}, leave it out: give one of them")
        after = positive("after", after, "it must be a positive and finite time, s")
        plausible("time at rest", "after", after)
    if modulus is not None:
        one_of("modulus", modulus, ("relaxed", "instantaneous"))
    system = system_of("app", app)
    if start is not None:
        require(isinstance(start, Equilibrium), "start", start, "it must be an Equilibrium")
    if start is not None and start.x.shape != (system.n,):
        raise ValueError(
            f"start has {start.x.size} coordinates and the system {system.n}; start from a state of the same "
            f"application"
        )
    state = modulus or "relaxed"
    rest = Statics.of(system, state if after is None else after)
    if state == "relaxed":
        warn_at_rest(system.layers, math.inf if after is None else after)
    q = None if start is None else rest.T.T @ (system.M @ start.x)
    if any(isinstance(t.bearing, BallBearing) and t.bearing.lubrication for t in system.bearings):
        system, q = _lubricated(system, rest, angle, q)
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
        for term in bearings:
            if isinstance(term.bearing, BallBearing):
                check_bearing_pressure(term.bearing, states[term.name].loads, f"bearing {term.name!r}, ")
                _doubt_lean(term, states[term.name])
        _doubt_light(bearings, states)
        passage.append(
            {
                term.name: replace(
                    states[term.name],
                    balls=lubricated_balls(term, states[term.name].z, states[term.name].loads),
                )
                for term in bearings
            }
        )
        if i == 0:
            first, x = replace(system, bearings=bearings), rest.T @ q
    mean = {
        name: replace(
            state,
            K=np.mean([s[name].K for s in passage], axis=0),
            C=np.mean([s[name].C for s in passage], axis=0),
            balls=averaged([s[name].balls for s in passage]),
        )
        for name, state in passage[0].items()
    }
    found = Equilibrium(first, x, mean, state if after is None else "after", after, average)
    if isinstance(app, Application):
        warn_of_strained_rubber(app, found.displacement, after)
        _doubt_way(app, found)
    return found


def _lubricated(system: System, rest: Statics, angle: float, q: Array | None) -> tuple[System, Array]:
    """The system with the films and damping of the loads that its dry bearings carry, and that state.

    Films move the balance little and depend on the load little (h0 ∝ Q^−.07): one pass is enough. A bearing
    without a loaded ball stays as it was given.
    """
    q, states = rest.balance(_turned(system, angle), q)
    terms = []
    for term in system.bearings:
        bearing, loads = term.bearing, states[term.name].loads
        if isinstance(bearing, BallBearing) and bearing.lubrication and (loads > PARTED).any():
            heaviest = contact_angles(term.kernel(), states[term.name].z, bearing.angle0 + angle)
            Q = float(loads[loads > PARTED].mean())
            try:
                found = lubricated(bearing, bearing.lubrication, Q, float(heaviest[int(loads.argmax())]))
            except ValueError as error:
                raise ValueError(f"bearing {term.name!r}: {error}") from None
            term = replace(term, bearing=found.applied(bearing))
        terms.append(term)
    return replace(system, bearings=tuple(terms)), q


def _turned(system: System, angle: float) -> tuple[BearingTerm, ...]:
    """Its bearings with their cages at the angle, rad."""
    return tuple(replace(t, bearing=t.bearing.turned(angle)) for t in system.bearings)


def state_of(source: object) -> dict[str, str]:
    """The equilibrium behind a result: with which modulus of the layers it was found, as an attribute.

    Parameters
    ----------
    source
        What the result was computed from.
    """
    layered = isinstance(source, Equilibrium) and source.system.layers
    return {"layers": source.layers} if isinstance(source, Equilibrium) and layered else {}


def _doubt_way(app: Application, found: Equilibrium) -> None:
    """Warn (UnusualMagnitude) of the place that goes farthest in the equilibrium, where that is far."""
    places = [f"{part}.{name}" for part, element in app.plan.parts.items() for name in element.interfaces]
    ways = {place: float(np.linalg.norm(found.displacement(place)[:3])) for place in places}
    place = max(ways, key=ways.__getitem__)
    hint = "; is a stiffness in N/µm or kN/mm, or a load in mN?"
    plausible("static displacement", f"{place}: its way from the unloaded state", ways[place], hint=hint)


def _doubt_light(terms: Sequence[BearingTerm], states: Mapping[str, BearingState]) -> None:
    """Warn (UnusualMagnitude) where all bearings carry as little as of a load in kN."""
    found: list[tuple[float, BallBearing, str, Array]] = []
    for term in terms:
        bearing, loads = term.bearing, states[term.name].loads
        if isinstance(bearing, BallBearing) and (loads > PARTED).any():
            found.append((bearing.pressure(float(loads.max())), bearing, term.name, loads))
    if found:
        _, bearing, name, loads = max(found, key=lambda one: one[0])
        check_light(bearing, loads, f"bearing {name!r}, the most loaded one")


def _doubt_lean(term: BearingTerm, state: BearingState) -> None:
    """Warn (BearingWarning) of rings that lean far against each other in the equilibrium."""
    if not isinstance(term.bearing, BallBearing):
        return
    tilts = [state.z[state.series.index(*t)] for t in RIGID.terms[3:]]
    warn_of_lean(math.hypot(*tilts) / term.bearing.arm, f"bearing {term.name!r}: ")


def _check_open_sides(bearings: Sequence[BearingTerm], states: Mapping[str, BearingState]) -> None:
    """Refuse a state in which balls carry where their bearing has no shoulder: ValueError."""
    for term in bearings:
        kernel, state = term.kernel(), states[term.name]
        astray = runs_off(kernel, state.z, state.loads, kernel.angle0)
        if astray:
            force = ", ".join(f"{f:.4g}" for f in state.force)
            raise ValueError(f"bearing {term.name!r} is loaded by ({force}) N; {astray}; {OPEN_SIDE_REMEDY}")


def with_loads(system: System, loads: tuple[LoadTerm, ...]) -> System:
    """The system for an equilibrium under other loads."""
    return replace(system, loads=loads)
