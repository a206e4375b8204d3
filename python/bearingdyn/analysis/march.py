"""A march, prepared once: checks, modes, start state, fingerprint, pieces and what is raised at its end."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from bearingdyn import core, inputs, runfile
from bearingdyn.analysis.channels import channel_of
from bearingdyn.analysis.equilibrium import Equilibrium, equilibrium
from bearingdyn.application import Application
from bearingdyn.bearing import OPEN_SIDE_REMEDY, ConstantDamping
from bearingdyn.checks import number, numbers, positive, require, whole
from bearingdyn.notice import OpenSideWarning, warn
from bearingdyn.results import inputs_of
from bearingdyn.system import System
from bearingdyn.types import Array

if TYPE_CHECKING:
    import xarray

NEVER = 2**62  # a decimation that keeps nothing
# steps between two chunks on the disk: a tenth of a second or so, which a kill may cost
CHUNK_STEPS = 50_000
# a number of a state beyond this belongs to no machine in SI units, and its cube would still be finite
ABSURD = 1e100


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
    """

    system: System
    modal: System
    T: Array
    x: Array
    stepping: core.Stepping
    settle: int
    steps: int
    decimate: int

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
        audit: bool = False,
        scheme: core.Scheme | None = None,
        least_steps: int = 0,
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
        counts = {
            "steps": whole("steps", steps, least_steps),
            "settle": whole("settle", settle, 0),
            "decimate": whole("decimate", decimate, 1),
        }
        drive = drive_of(speed)
        if isinstance(source, Application):
            source = equilibrium(source)
        if isinstance(source, Equilibrium) and source.modulus != "relaxed":
            raise ValueError(
                f"the equilibrium has its layers at their {source.modulus} modulus; a march starts with "
                f'relaxed layers: take equilibrium(app, modulus="relaxed")'
            )
        system, x = (
            (source.system, source.x.copy())
            if isinstance(source, Equilibrium)
            else (source, np.zeros(source.n))
        )
        system.check_speed(float(np.abs(drive[1]).max()) if isinstance(drive, tuple) else drive)
        modal, T = system.modal()
        stepping = core.Stepping(dt, speed=drive, audit=bool(audit), scheme=scheme or core.Scheme())
        return cls(system=system, modal=modal, T=T, x=x, stepping=stepping, **counts)

    @property
    def total(self) -> int:
        """Steps of the whole march, those before the record included."""
        return self.settle + self.steps

    def start(self, model: core.Model, initial: Mapping[str, ArrayLike] | None = None) -> Array:
        """State at rest in the start displacement, with the places of `initial` put where they are wanted.

        Raises
        ------
        ValueError
            For a place that does not exist, a displacement that is not finite, or places that cannot make
            these motions together.
        """
        x = moved(self.system, self.x, initial) if initial else self.x
        return model.state(0.0, self.T.T @ self.system.M @ x, np.zeros(self.system.n))

    def resumed(self, model: core.Model, result: xarray.Dataset) -> Array:
        """State at the end of an earlier march of this system.

        Raises
        ------
        ValueError
            For a result without a state, for the state of another application, and for a state that holds a
            number no march could have reached.
        """
        if "state" not in result:
            raise ValueError(
                f"resume holds {sorted(map(str, result))} and no state; give the result of `transient`"
            )
        state = np.asarray(result["state"].values, dtype=np.float64)
        self._check_origin(result, state.size, self.start(model).size)
        check_state("resume", state)
        return state

    def _check_origin(self, result: xarray.Dataset, size: int, own_size: int) -> None:
        """Refuse a result that was not marched with this very system: ValueError."""
        another = "resume is the state of another application"
        remedy = "resume a result of this application, or start anew with `initial`"
        if size != own_size:
            raise ValueError(f"{another}: it has {size} numbers, and this one has {own_size}; {remedy}")
        theirs, own = result.attrs.get("system_hash"), system_hash(self.modal)
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
            "settle": self.settle,
            "steps": self.steps,
            "inputs": self.system.inputs,
            "system_hash": system_hash(self.modal),
        }

    def digest(self, state: Array) -> str:
        """Fingerprint of everything the march depends on: two marches alike in it are alike to the last bit.

        Every field of the stepping and of its scheme is in it.
        """
        return inputs.fingerprint(
            {"system": system_hash(self.modal), "stepping": self.stepping, "state": state}
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
            rows, state, report = core.march(
                model,
                state,
                self.stepping,
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
        """Warn of the first step with a ball on the open side of a bearing."""
        name = self.system.bearings[report.open_bearing].name
        warn(
            f"bearing {name!r}: from t = {report.open_t:.6g} s on, in {report.open_steps} of the "
            f"{report.steps} steps marched, balls are pressed onto its open side, where no shoulder holds "
            f"them; {OPEN_SIDE_REMEDY}",
            OpenSideWarning,
        )

    def run(
        self,
        model: core.Model,
        state: Array,
        *,
        start: bool,
        progress: core.Progress | None = None,
        stream: str | os.PathLike[str] | None = None,
        header: Mapping[str, Any] | None = None,
    ) -> tuple[Array, Array, core.Report]:
        """March to the end: rows (n, channels), state and report.

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
        writer = None if stream is None else runfile.Writer(stream, header or {})
        try:
            kept = [] if writer is None else [c.rows for c in writer.chunks]
            report = core.Report(t=core.time_of(model, state))
            if writer is not None and writer.chunks:
                state, start = writer.chunks[-1].state.copy(), False
                check_state(f"stream {writer.path}", state)
                report = runfile.report_of(writer.chunks)
            for rows, after, part in self.pieces(
                model,
                state,
                start=start,
                size=None if writer is None else CHUNK_STEPS,
                done=report.steps,
                progress=progress,
            ):
                state = after
                kept.append(rows)
                if writer is not None and part.steps > 0:
                    writer.append(runfile.Chunk(rows, state, part))
                report = report + part
        finally:
            if writer is not None:
                writer.close()
        return np.concatenate([np.zeros((0, model.channels)), *kept]), state, report

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
                f"{report.residual:.3g} of the largest bearing force{worst}); {self._remedy()}",
                report,
                result,
            )
        return result

    def _remedy(self) -> str:
        """What helps where a march cannot go on."""
        dampings = [getattr(term.bearing, "damping", None) for term in self.system.bearings]
        if any(isinstance(d, ConstantDamping) and d.c > 0 for d in dampings):
            return (
                "a constant contact damping makes the force jump where a ball loses contact: give "
                "damping=bd.LoadDamping(...) or bd.TabulatedDamping(...), or try a smaller dt"
            )
        return "try a smaller dt"


def system_hash(system: System) -> str:
    """Fingerprint (32 hexadecimal digits) of what a state's numbers mean: matrices and all terms."""
    return inputs.fingerprint(
        {
            "matrices": [system.M, system.C, system.G, system.K, system.N],
            "layers": [
                (t.L, t.material.G0, t.material.G, t.material.tau, t.material.eta0) for t in system.layers
            ],
            "bearings": [(t.kernel().packed(), t.B) for t in system.bearings],
            "loads": system.loads,
        }
    )


def drive_of(speed: float | tuple[ArrayLike, ArrayLike]) -> float | tuple[Array, Array]:
    """The speed of the shaft as one number, rad/s, or as times in s and speeds in rad/s, (n,) each.

    Raises
    ------
    ValueError
        For anything else, and for times that do not increase.
    """
    either = "give one finite number in rad/s, or (times in s, speeds in rad/s)"
    if not isinstance(speed, tuple):
        return number("speed", speed, either)
    if len(speed) != 2:
        raise ValueError(f"speed has {len(speed)} parts; {either}")
    try:
        times, speeds = (np.atleast_1d(np.array(part, dtype=np.float64)) for part in speed)
    except (TypeError, ValueError):
        raise ValueError(f"speed is {speed!r}; {either}") from None
    if times.shape != speeds.shape or times.ndim != 1 or times.size < 2:
        raise ValueError(
            f"speed has {times.size} times and {speeds.size} speeds; give two or more of each, or one number"
        )
    if not (np.isfinite(times).all() and np.isfinite(speeds).all() and (np.diff(times) > 0).all()):
        raise ValueError("speed: times must increase and all numbers be finite, in s and rad/s")
    return times, speeds


def check_state(field: str, state: Array) -> None:
    """Refuse a state with a number that is not finite, or that no march in SI units reaches: ValueError."""
    beyond = np.flatnonzero(~(np.abs(state) < ABSURD))
    if beyond.size:
        raise ValueError(
            f"{field} holds a state whose number {beyond[0]} is {state[beyond[0]]:g}; every number must be "
            f"finite and below {ABSURD:g}: the march had diverged, start anew with a smaller dt"
        )


def moved(system: System, x: Array, initial: Mapping[str, ArrayLike]) -> Array:
    """Coordinates nearest to x (n,) that put every place where it is wanted.

    Raises
    ------
    ValueError
        For a place that does not exist, a displacement that is not finite, or places that cannot make these
        motions together.
    """
    given = {}
    for name, target in initial.items():
        count = len(system.rows(name))
        field, remedy = f"initial[{name!r}]", f"it must be {count} finite numbers, m and rad"
        given[name] = numbers(field, target, remedy)
        require(given[name].shape == (count,), field, target, remedy)
    rows = np.vstack([system.rows(name) for name in given])
    wanted = np.concatenate(list(given.values()))
    x = x + np.linalg.pinv(rows) @ (wanted - rows @ x)
    if np.abs(rows @ x - wanted).max() > 1e-9 * np.abs(wanted).max(initial=1e-9):
        raise ValueError(
            f"initial gives {sorted(initial)} motions that they cannot make together; leave one of them out"
        )
    return x


def part_of(progress: core.Progress | None, done: int, total: int) -> Callable[[int, int], object] | None:
    """Progress of one piece as progress of the whole."""
    if progress is None:
        return None
    return lambda piece, _: progress(done + piece, total)
