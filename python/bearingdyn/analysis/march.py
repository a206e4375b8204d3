"""A march, prepared once: checks, modes, start state, fingerprint, pieces and what is raised at its end."""

from __future__ import annotations

import os
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from bearingdyn import core, fingerprint, run_file
from bearingdyn.analysis.abreast import GATHERING
from bearingdyn.analysis.decimation import Decimator, half_length
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
from bearingdyn.bearing import OPEN_SIDE_REMEDY
from bearingdyn.checks import instance, one_of, positive, require, whole
from bearingdyn.notice import NothingPushes, OpenSideWarning, warn
from bearingdyn.plausible_ranges import plausible
from bearingdyn.progress import part_of
from bearingdyn.results import inputs_of
from bearingdyn.system import Contacts, System, system_of
from bearingdyn.types import Array

if TYPE_CHECKING:
    import xarray


# words of a state: steps since its clock began, and their size (csrc/state.c)
STEPS, STEP = 1, 2
METHODS = ("newmark", "exact")
CoreMarch = tuple[Array, Array, core.Report]
NEVER = 2**62  # a decimation that keeps nothing
# steps between two chunks on the disk: a tenth of a second or so, which a kill may cost
CHUNK_STEPS = 50_000


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

    def _core_march(self, model: core.Model, state: Array, steps: int, every: int, **how: Any) -> CoreMarch:
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

    def pieces(
        self,
        model: core.Model,
        state: Array,
        *,
        start: bool,
        size: int | None = None,
        done: int = 0,
        keep_settled: bool = False,
        progress: core.Progress | None = None,
    ) -> Iterator[tuple[Array, Array, core.Report]]:
        """March piece by piece, and say of each its rows (n, channels), the state after it, and its report.

        Ends behind the piece whose report says that it could not go on.

        Parameters
        ----------
        model, state
            In modal coordinates.
        start
            Whether the acceleration is first made to satisfy the equation of motion.
        size
            Most steps of a piece; None for no limit.
        done
            Steps already behind the state, those before the record included.
        keep_settled
            Whether the last state before the record is its first row.
        progress
            Told of the steps done and of all there are.
        """
        status, told = 0, False
        while status == 0 and (done < self.total or start):
            settling = done < self.settle
            left = (self.settle if settling else self.total) - done
            before = (self.settle or NEVER) if keep_settled else NEVER
            rows, state, report = self._core_march(
                model,
                state,
                left if size is None else min(left, size),
                before if settling else self.decimate,
                start=start,
                progress=part_of(progress, done, self.total),
            )
            start, status, done = False, report.status, done + report.steps
            if report.open_steps and not told:
                told = True
                self._tell_open_side(report)
            yield rows, state, report

    def _tell_open_side(self, report: core.Report) -> None:
        """Warn of the first step in which a bearing did not hold together on its shoulder."""
        name = self.system.bearings[report.open_bearing].name
        warn(
            f"bearing {name!r}: from t = {report.open_t:.6g} s on, in {report.open_steps} of the "
            f"{report.steps} steps marched, balls are pressed onto its open side, where no shoulder holds "
            f"them, or none of them onto its shoulder; {OPEN_SIDE_REMEDY}",
            OpenSideWarning,
        )

    def filtered(
        self,
        model: core.Model,
        state: Array,
        sieve: Decimator,
        *,
        start: bool,
        size: int | None = None,
        done: int = 0,
        progress: core.Progress | None = None,
    ) -> Iterator[tuple[Array, Array, core.Report]]:
        """As `pieces`, with the rows low-passed; what is marched ahead of a piece for that is thrown away."""
        status, size = 0, max(size or CHUNK_STEPS, 4 * sieve.half)
        blind = max(self.settle - sieve.half, 0)  # so many steps leave no trace in the record
        told = False
        while status == 0 and (done < self.total or start):
            goal = next((g for g in (blind, self.settle) if done < g), self.total)
            every = NEVER if goal == blind and done < blind else 1
            rows, state, report = self._core_march(
                model,
                state,
                min(goal - done, size),
                every,
                start=start,
                progress=part_of(progress, done, self.total),
            )
            start, status, done = False, report.status, done + report.steps
            if every == NEVER:
                sieve.skip(report.steps)
            else:
                sieve.add(rows)
            if done <= self.settle:
                sieve.drop()
            if report.open_steps and not told:
                told = True
                self._tell_open_side(report)
            ahead, after = rows[:0], status
            if done > self.settle and status in (0, core.INTERRUPTED):
                ahead, _, looked = self._core_march(model, state, sieve.half, 1)
                after = core.INTERRUPTED if looked.status == core.INTERRUPTED else status
            report, status = replace(report, status=after), after
            yield sieve.take(ahead), state, report

    def sieve(
        self,
        model: core.Model,
        state: Array,
        *,
        start: bool,
        plain: Array,
        past: Array | None,
        chunks: Sequence[run_file.Chunk],
    ) -> Decimator:
        """What filters this march from the end of its chunks; the rows before that end are marched again."""
        own = not start and state[STEP] == self.stepping.dt
        begun = int(state[STEPS]) if own else 0
        done, half = sum(chunk.report.steps for chunk in chunks), half_length(self.decimate)
        if done == 0:
            return Decimator(self.decimate, plain, begun, past)
        at, rows = 0, None
        for chunk in chunks:
            if at + chunk.report.steps > max(done - half, 0):
                break
            at, state, start = at + chunk.report.steps, chunk.state, False
        if done > self.settle - half:
            again, _, _ = self._core_march(model, state, done - at, 1, start=start)
            before = np.repeat(again[:1], half, axis=0) if past is None or at > 0 else past
            rows = np.concatenate([before, again])[-half:]
        return Decimator(self.decimate, plain, begun + done, rows)

    def run(
        self,
        model: core.Model,
        state: Array,
        *,
        start: bool,
        progress: core.Progress | None = None,
        stream: str | os.PathLike[str] | None = None,
        header: Mapping[str, Any] | None = None,
        plain: Array | None = None,
        past: Array | None = None,
    ) -> tuple[Array, Array, core.Report, Array | None]:
        """March to the end: rows (n, channels), state, report, and the last steps if there is a filter.

        `plain` (channels,) says which channels are not filtered; `past` are the steps before the start.

        With `stream`, every CHUNK_STEPS steps are on the disk before the next begin; a run file that holds
        the beginning of this very march is continued, bit for bit. The report counts what this call and, from
        a file, earlier ones did.

        Raises
        ------
        ValueError
            For a file that holds something else, or ends in a state that is not finite.
        OSError
            Where the file cannot be written.
        """
        writer = None if stream is None else run_file.Writer(stream, header or {})
        try:
            kept = [] if writer is None else [c.rows for c in writer.chunks]
            report = core.Report(t=core.time_of(model, state))
            sieve = None
            if self.filters and plain is not None:
                known = [] if writer is None else writer.chunks
                sieve = self.sieve(model, state, start=start, plain=plain, past=past, chunks=known)
            if writer is not None and writer.chunks:
                state, start = writer.chunks[-1].state.copy(), False
                check_state(f"stream {writer.path}", state)
                report = run_file.report_of(writer.chunks)
            size = None if writer is None else CHUNK_STEPS
            go: dict[str, Any] = {"start": start, "size": size, "done": report.steps, "progress": progress}
            for rows, after, part in (
                self.pieces(model, state, **go) if sieve is None else self.filtered(model, state, sieve, **go)
            ):
                state = after
                kept.append(rows)
                if writer is not None and part.steps > 0:
                    writer.append(run_file.Chunk(rows, state, part))
                report = report + part
        finally:
            if writer is not None:
                writer.close()
        tail = None if sieve is None else sieve.rows
        return np.concatenate([np.zeros((0, model.channels)), *kept]), state, report, tail

    def energies(self, model: core.Model, state: Array) -> dict[str, float]:
        """What the audit integrated, J, by the names of core.ENERGIES; NaN where they have overflowed."""
        if not np.isfinite(state).all():
            return dict.fromkeys(core.ENERGIES, float("nan"))
        return core.energies(model, state)

    def ended(self, result: xarray.Dataset, report: core.Report) -> xarray.Dataset:
        """The result of a march that reached its end.

        Raises
        ------
        Interrupted
            Where the user ended it; the result is its `partial`.
        SolverError
            Where it could not go on, likewise; says where, and what helps.
        """
        if report.status == core.INTERRUPTED:
            raise core.Interrupted(
                f"interrupted at t = {report.t:.6g} s; what was marched is in `partial`", result
            )
        if report.status != 0:
            worst = (
                f", worst in bearing {self.system.bearings[report.bearing].name!r}"
                if report.bearing >= 0
                else ""
            )
            raise core.SolverError(
                f"{report.text} in step {report.steps + 1} at t = {report.t:.6g} s (residual "
                f"{report.residual:.3g} of the largest bearing force{worst}); try a smaller dt",
                report,
                result,
            )
        return result


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
