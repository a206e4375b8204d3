"""A march, prepared once: checks, modes, start state, the core's step and fingerprints."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from bearingdyn import core, fingerprint
from bearingdyn.analysis.abreast import GATHERING
from bearingdyn.analysis.displaced_start import warn_if_start_is_coarse
from bearingdyn.analysis.equilibrium import Equilibrium, equilibrium
from bearingdyn.analysis.exact_step import ExactModes
from bearingdyn.analysis.march_state import Beginning, check_state, moved, system_hash
from bearingdyn.analysis.recordable_channels import CoreChannel, channel_of
from bearingdyn.analysis.softening import memory_of, softening_layers
from bearingdyn.analysis.speed_profile import drive_of
from bearingdyn.analysis.static_balance import Statics
from bearingdyn.analysis.step_size import step_error, warn_if_coarse, warn_if_growing
from bearingdyn.application import Application
from bearingdyn.checks import instance, one_of, positive, require, whole
from bearingdyn.notice import NothingPushes, warn
from bearingdyn.plausible_ranges import plausible
from bearingdyn.results import inputs_of
from bearingdyn.system import Contacts, System, system_of
from bearingdyn.types import Array

if TYPE_CHECKING:
    import xarray


METHODS = ("newmark", "exact")
CoreMarch = tuple[Array, Array, core.Report]


@dataclass(frozen=True, eq=False, kw_only=True)
class March:
    """A march ready to run: what it moves, from where, how and how far.

    Parameters
    ----------
    system
        In its own coordinates.
    modal, T
        The system in modal coordinates q, and x = T q; T (n, n).
    x
        Displacement (n,) at the start, m and rad.
    stepping
        Step, speed, audit and scheme.
    settle, steps, decimate
        Steps before the record, steps of the record, and every how many a sample is kept.
    filter
        Whether what is kept is low-passed.
    memory
        Time, s, over which layers that soften remember their amplitude; None where none does.
    method
        One of METHODS.
    pressed
        Whether a ball is pressed where the march starts, or that is not known.
    contacts
        How lubricated contacts answer.
    """

    system: System
    modal: System
    T: Array
    x: Array
    stepping: core.Stepping
    settle: int
    steps: int
    decimate: int
    filter: bool = False
    memory: float | None = None
    method: str = "newmark"
    pressed: bool = True
    contacts: Contacts = "viscous"

    @classmethod
    def of(
        cls,
        source: Equilibrium | Application | System,
        *,
        speed: float | tuple[ArrayLike, ArrayLike],
        dt: float,
        steps: int,
        settle: int = 0,
        decimate: int = 1,
        filter: bool = False,
        audit: bool = False,
        scheme: core.Scheme | None = None,
        memory: float | None = None,
        method: str = "newmark",
        least_steps: int = 0,
        contacts: Contacts = "viscous",
    ) -> March:
        """Prepare a march from an equilibrium, an application (its equilibrium is found) or a system at zero.

        The arguments are those of `transient`.

        Raises
        ------
        ValueError
            For a step, a count or a speed that makes no march, for layers that do not start relaxed, and for
            a part that would turn although its damping is known at rest only.
        """
        dt = positive("dt", dt, "the time step must be positive and finite, in s")
        plausible("time step", "dt", dt)
        counts = {
            "steps": whole("steps", steps, least_steps),
            "settle": whole("settle", settle, 0),
            "decimate": whole("decimate", decimate, 1),
        }
        if 0 < counts["steps"] < counts["decimate"]:
            raise ValueError(
                f"decimate is {decimate}; of {steps} steps no sample would be kept; it must be at most steps"
            )
        drive = drive_of(speed)
        one_of("method", method, METHODS)
        one_of("contacts", contacts, ("film", "viscous"))
        if scheme is not None:
            instance("scheme", scheme, core.Scheme, "it must be a bd.Scheme(...)")
        if isinstance(source, Application):
            source = equilibrium(source)
        elif not isinstance(source, Equilibrium):
            source = system_of("source", source)
        if isinstance(source, Equilibrium) and source.modulus != "relaxed":
            state = f"state {source.layers}" if source.after is not None else f"{source.modulus} modulus"
            without = "" if source.after is None else ", without after="
            raise ValueError(
                f"the equilibrium has its layers at their {state}; a march starts with relaxed layers: take "
                f'equilibrium(app, modulus="relaxed"){without}'
            )
        system, x = (
            (source.system, source.x.copy())
            if isinstance(source, Equilibrium)
            else (source, np.zeros(source.n))
        )
        fastest = float(np.abs(drive[1]).max()) if isinstance(drive, tuple) else drive
        system.check_speed(fastest)
        if contacts == "film" and not any(term.has_films for term in system.bearings):
            raise ValueError(
                "contacts is 'film', and no bearing runs on films; give one BallBearing(..., "
                "lubrication=OilSupply(...)), or contacts='viscous'"
            )
        elif contacts == "film" and isinstance(source, Equilibrium):
            rest = Statics.of(system, "relaxed")
            x = rest.T @ rest.balance(system.bearings, rest.T.T @ (system.M @ x), contacts)[0]
        if method == "exact":
            drive = _exact_speed(system, drive)
        warn_if_coarse(system, fastest, dt)
        if method == "exact" and isinstance(source, Equilibrium):
            hold = (scheme or core.Scheme()).hold
            warn_if_growing(source, dt, counts["settle"] + counts["steps"], hold)
        modal, T = system.modal()
        stepping = core.Stepping(dt, speed=drive, audit=bool(audit), scheme=scheme or core.Scheme())
        return cls(
            system=system,
            modal=modal,
            T=T,
            x=x,
            stepping=stepping,
            filter=bool(filter),
            memory=memory_of(system, drive, memory),
            method=method,
            pressed=not isinstance(source, Equilibrium) or source.presses,
            contacts=contacts,
            **counts,
        )

    def model(self, channels: list[CoreChannel]) -> core.Model:
        """The core's model, with these channels."""
        return self.modal.model(channels, memory=self.memory, contacts=self.contacts)

    @property
    def total(self) -> int:
        """Steps of the whole march, those before the record included."""
        return self.settle + self.steps

    def warn_if_still(self) -> None:
        """Warn that nothing pushes, for a march that starts at rest in its equilibrium."""
        if self.pressed or any(term.p_cos.any() or term.p_sin.any() for term in self.system.loads):
            return
        warn(
            "nothing pushes: the march starts at rest in an equilibrium in which no ball is pressed, and no "
            "load acts; every record stays as it begins. Add what pushes (app.gravity, app.load, "
            "app.unbalance), or start displaced with initial=",
            NothingPushes,
        )

    @property
    def filters(self) -> bool:
        """Whether there is anything to filter."""
        return self.filter and self.decimate > 1

    def start(self, model: core.Model, initial: Mapping[str, ArrayLike] | None = None) -> Array:
        """State at rest in the start displacement, with the places of `initial` put where they are wanted.

        Raises
        ------
        ValueError
            For a place that does not exist, a displacement that is not finite, or places that cannot make
            these motions together.
        """
        x = moved(self.system, self.x, initial) if initial else self.x
        return self.begun(model, Beginning(x, np.zeros_like(x), None))

    def warn_if_start_is_coarse(
        self, source: Equilibrium | System, initial: Mapping[str, ArrayLike], record: Sequence[str]
    ) -> None:
        """Warn where Newmark's step does not follow what a displaced start lets go, in a recorded motion."""
        if self.method != "newmark":
            return
        found = {name: channel_of(self.system, name)[0] for name in record}
        rows = {name: row for name, (_, row, _, _) in found.items() if row is not None}
        displaced = moved(self.system, self.x, initial) - self.x
        warn_if_start_is_coarse(source, self.stepping.dt, displaced, rows, self.settle * self.stepping.dt)

    def begun(self, model: core.Model, beginning: Beginning) -> Array:
        """State that moves as the beginning says."""
        x, v = (self.T.T @ self.system.M @ each for each in (beginning.x, beginning.v))
        stress = beginning.stress
        films = None
        if self.contacts == "film" and beginning.films is not None:
            films = np.concatenate([each.ravel() for each in beginning.films])
        state = model.state(0.0, x, v, stress, films)
        if self.method == "newmark":
            return state
        if stress is None:
            stress = np.zeros(sum(t.L.shape[1] * len(t.material.G) for t in self.modal.layers))
        return np.concatenate([state, self._modes.start(x, v, stress)])

    @cached_property
    def _modes(self) -> ExactModes:
        """The linear part's own modes, for exact steps."""
        return ExactModes.of(self.modal, float(self.stepping.profile[1][0]))

    @cached_property
    def _step(self) -> dict[str, Array]:
        """What the core needs of them for the step."""
        return self._modes.step(self.stepping.dt, self.stepping.scheme.hold)

    def core_march(self, model: core.Model, state: Array, steps: int, every: int, **how: Any) -> CoreMarch:
        """The core's march by this method, side by side with others where a gathering says so."""
        modes = None if self.method == "newmark" else self._step
        gathering = GATHERING.get()
        if gathering is None:
            return core.march(model, state, self.stepping, steps, every, modes=modes, **how)
        call = core.MarchCall(model, state, self.stepping, steps, every, modes=modes, **how)
        return gathering.march(call, self._structure)

    @cached_property
    def _structure(self) -> str | None:
        """Fingerprint of what marches that go side by side share; None for one that goes by itself."""
        system = self.modal
        turns = np.ptp(self.stepping.profile[1]) > 0 or len(self.stepping.profile[1]) > 1
        if self.method != "newmark" or self.memory is not None or self.stepping.audit or turns:
            return None
        return fingerprint.fingerprint(
            {
                "matrices": (system.M, system.C, system.G, system.K, system.N),
                "layers": [(term.L, term.material.G, term.material.tau) for term in system.layers],
                "bearings": [bearing.B.shape for bearing in system.bearings],
                "loads": len(system.loads),
                "stepping": self.stepping,
            }
        )

    def step_error(self, model: core.Model, state: Array) -> Array:
        """Error of each channel that the step size leaves behind a state, (channels,): `step_error`."""
        if self.method == "newmark":
            return step_error(model, state, self.stepping)
        half = self._modes.step(self.stepping.dt / 2, self.stepping.scheme.hold)
        return step_error(model, state, self.stepping, (self._step, half))

    def resumed(self, model: core.Model, result: xarray.Dataset) -> Array:
        """State at the end of an earlier march of this system.

        Raises
        ------
        ValueError
            For a result without a state, for the state of another application, and for a state that holds a
            number no march could have reached.
        """
        remedy = "give the result of `transient`"
        require(hasattr(result, "data_vars"), "resume", result, remedy)
        if "state" not in result:
            raise ValueError(
                f"resume holds {sorted(map(str, result))} and no state; give the result of `transient`"
            )
        state = np.asarray(result["state"].values, dtype=np.float64)
        self._check_origin(result, state.size, self.start(model).size)
        check_state("resume", state)
        return state

    def past(self, result: xarray.Dataset, channels: Sequence[str]) -> Array | None:
        """The steps before the end of an earlier march, as its filter and this one's need them; or None."""
        same = (
            self.filters
            and "tail" in result
            and list(map(str, result["channel"].values)) == list(channels)
            and (result.attrs["dt"], result.attrs["decimate"]) == (self.stepping.dt, self.decimate)
        )
        return np.asarray(result["tail"].values, dtype=np.float64) if same else None

    def _check_origin(self, result: xarray.Dataset, size: int, own_size: int) -> None:
        """Refuse a result that was not marched with this very system: ValueError."""
        method = result.attrs.get("method", "newmark")
        if method != self.method:
            raise ValueError(
                f"resume was marched with method={method!r}, and method is {self.method!r}; go on with the "
                f"same, or start anew with `initial`"
            )
        another = "resume is the state of another application"
        remedy = "resume a result of this application, or start anew with `initial`"
        if size != own_size:
            raise ValueError(f"{another}: it has {size} numbers, and this one has {own_size}; {remedy}")
        theirs, own = result.attrs.get("system_hash"), system_hash(self.modal, self.contacts)
        if theirs is None:  # written before results said it: its channels must at least exist here
            for name in result["channel"].values:
                try:
                    channel_of(self.modal, str(name))
                except ValueError as error:
                    raise ValueError(f"{another}: {error}; {remedy}") from None
        elif theirs != own:
            origin = inputs_of(self.system.inputs).get("inputs_hash")
            if origin is not None and origin == result.attrs.get("inputs_hash"):
                raise ValueError(
                    f"resume was marched with another system of this application (system_hash {theirs}, not "
                    f"{own}): linearised, with its balls at another angle, or computed by another machine "
                    f"or NumPy; march on as it was begun, or start anew with `initial`"
                )
            raise ValueError(f"{another}: its system_hash is {theirs}, and this one's is {own}; {remedy}")

    def facts(self, channels: Sequence[str], units: Sequence[str]) -> dict[str, Any]:
        """What a result and the header of a run file say of the march, as JSON's own types."""
        return {
            "channels": list(channels),
            "units": list(units),
            "dt": self.stepping.dt,
            "speed": [part.tolist() for part in self.stepping.profile],
            "decimate": self.decimate,
            "filter": self.filters,
            "settle": self.settle,
            "steps": self.steps,
            "inputs": self.system.inputs,
            "system_hash": system_hash(self.modal, self.contacts),
            **({} if self.method == "newmark" else {"method": self.method}),
            **({} if self.contacts == "viscous" else {"contacts": self.contacts}),
        }

    def digest(self, state: Array) -> str:
        """Fingerprint of everything the march depends on: two marches alike in it are alike to the last bit.

        Every field of the stepping and of its scheme is in it.
        """
        return fingerprint.fingerprint(
            {
                "system": system_hash(self.modal, self.contacts),
                "stepping": self.stepping,
                "state": state,
                **({} if self.memory is None else {"memory": self.memory}),
                **({} if self.method == "newmark" else {"method": self.method}),
            }
        )


def _exact_speed(system: System, drive: float | tuple[Array, Array]) -> float:
    """The one speed of exact steps; ValueError for what they cannot be taken through."""
    remedy = "take method='newmark'"
    if isinstance(drive, tuple) and np.ptp(drive[1]) > 0:
        raise ValueError(
            f"method is 'exact', and the speed runs from {float(np.min(drive[1])):g} to "
            f"{float(np.max(drive[1])):g} rad/s; an exact step is that of one constant speed: "
            f"{remedy} through a run-up"
        )
    soft = [system.layers[k].part for k in softening_layers(system)]
    if soft:
        raise ValueError(
            f"method is 'exact', and layer {soft[0]!r} softens with its amplitude (`Maxwell.payne`), so that "
            f"no step is linear; {remedy}, or leave its law of softening out"
        )
    return float(drive[1][0]) if isinstance(drive, tuple) else drive
