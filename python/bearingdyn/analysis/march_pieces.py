"""A march on its way: piece by piece, low-passed, to a run file, and what is raised at its end."""

from __future__ import annotations

import os
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from bearingdyn import core, run_file
from bearingdyn.analysis.decimation import Decimator, half_length
from bearingdyn.analysis.march import March
from bearingdyn.analysis.march_state import check_state
from bearingdyn.bearing import OPEN_SIDE_REMEDY
from bearingdyn.notice import OpenSideWarning, warn
from bearingdyn.progress import part_of
from bearingdyn.types import Array

if TYPE_CHECKING:
    import xarray

# words of a state: steps since its clock began, and their size (csrc/state.c)
STEPS, STEP = 1, 2
NEVER = 2**62  # a decimation that keeps nothing
# steps between two chunks on the disk: a tenth of a second or so, which a kill may cost
CHUNK_STEPS = 50_000


def pieces(
    march: March,
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
    while status == 0 and (done < march.total or start):
        settling = done < march.settle
        left = (march.settle if settling else march.total) - done
        before = (march.settle or NEVER) if keep_settled else NEVER
        rows, state, report = march.core_march(
            model,
            state,
            left if size is None else min(left, size),
            before if settling else march.decimate,
            start=start,
            progress=part_of(progress, done, march.total),
        )
        start, status, done = False, report.status, done + report.steps
        if report.open_steps and not told:
            told = True
            _tell_open_side(march, report)
        yield rows, state, report


def _tell_open_side(march: March, report: core.Report) -> None:
    """Warn of the first step in which a bearing did not hold together on its shoulder."""
    name = march.system.bearings[report.open_bearing].name
    warn(
        f"bearing {name!r}: from t = {report.open_t:.6g} s on, in {report.open_steps} of the "
        f"{report.steps} steps marched, balls are pressed onto its open side, where no shoulder holds "
        f"them, or none of them onto its shoulder; {OPEN_SIDE_REMEDY}",
        OpenSideWarning,
    )


def filtered(
    march: March,
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
    blind = max(march.settle - sieve.half, 0)  # so many steps leave no trace in the record
    told = False
    while status == 0 and (done < march.total or start):
        goal = next((g for g in (blind, march.settle) if done < g), march.total)
        every = NEVER if goal == blind and done < blind else 1
        rows, state, report = march.core_march(
            model,
            state,
            min(goal - done, size),
            every,
            start=start,
            progress=part_of(progress, done, march.total),
        )
        start, status, done = False, report.status, done + report.steps
        if every == NEVER:
            sieve.skip(report.steps)
        else:
            sieve.add(rows)
        if done <= march.settle:
            sieve.drop()
        if report.open_steps and not told:
            told = True
            _tell_open_side(march, report)
        ahead, after = rows[:0], status
        if done > march.settle and status in (0, core.INTERRUPTED):
            ahead, _, looked = march.core_march(model, state, sieve.half, 1)
            after = core.INTERRUPTED if looked.status == core.INTERRUPTED else status
        report, status = replace(report, status=after), after
        yield sieve.take(ahead), state, report


def sieve_of(
    march: March,
    model: core.Model,
    state: Array,
    *,
    start: bool,
    plain: Array,
    past: Array | None,
    chunks: Sequence[run_file.Chunk],
) -> Decimator:
    """What filters this march from the end of its chunks; the rows before that end are marched again."""
    own = not start and state[STEP] == march.stepping.dt
    begun = int(state[STEPS]) if own else 0
    done, half = sum(chunk.report.steps for chunk in chunks), half_length(march.decimate)
    if done == 0:
        return Decimator(march.decimate, plain, begun, past)
    at, rows = 0, None
    for chunk in chunks:
        if at + chunk.report.steps > max(done - half, 0):
            break
        at, state, start = at + chunk.report.steps, chunk.state, False
    if done > march.settle - half:
        again, _, _ = march.core_march(model, state, done - at, 1, start=start)
        before = np.repeat(again[:1], half, axis=0) if past is None or at > 0 else past
        rows = np.concatenate([before, again])[-half:]
    return Decimator(march.decimate, plain, begun + done, rows)


def run(
    march: March,
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
        if march.filters and plain is not None:
            known = [] if writer is None else writer.chunks
            sieve = sieve_of(march, model, state, start=start, plain=plain, past=past, chunks=known)
        if writer is not None and writer.chunks:
            state, start = writer.chunks[-1].state.copy(), False
            check_state(f"stream {writer.path}", state)
            report = run_file.report_of(writer.chunks)
        size = None if writer is None else CHUNK_STEPS
        go: dict[str, Any] = {"start": start, "size": size, "done": report.steps, "progress": progress}
        for rows, after, part in (
            pieces(march, model, state, **go) if sieve is None else filtered(march, model, state, sieve, **go)
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


def energies_of(model: core.Model, state: Array) -> dict[str, float]:
    """What the audit integrated, J, by the names of core.ENERGIES; NaN where they have overflowed."""
    if not np.isfinite(state).all():
        return dict.fromkeys(core.ENERGIES, float("nan"))
    return core.energies(model, state)


def ended(march: March, result: xarray.Dataset, report: core.Report) -> xarray.Dataset:
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
            f", worst in bearing {march.system.bearings[report.bearing].name!r}"
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
