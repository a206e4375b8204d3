"""A march in pieces: with progress, and where asked onto a run file from which it can go on."""

from __future__ import annotations

import hashlib
import os
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

from bearingdyn import core, runfile
from bearingdyn.system import System
from bearingdyn.types import Array

NEVER = 2**62  # a decimation that keeps nothing
# steps between two chunks on the disk: a tenth of a second or so, which a kill may cost
CHUNK_STEPS = 50_000


def run(
    model: core.Model,
    state: Array,
    scheme: core.Scheme,
    settle: int,
    steps: int,
    decimate: int,
    *,
    start: bool,
    progress: core.Progress | None = None,
    stream: str | os.PathLike[str] | None = None,
    header: Mapping[str, Any] | None = None,
) -> tuple[Array, Array, core.Report]:
    """March `settle` steps unrecorded and `steps` recorded ones; rows (n, channels), state and report.

    With `stream`, every CHUNK_STEPS steps are on the disk before the next begin; a run file that holds the
    beginning of this very run is gone on from, bit for bit. The report counts what this call and, from a
    file, earlier ones did.

    Raises ValueError for a file that holds something else, OSError where it cannot be written.
    """
    total = settle + steps
    writer = None if stream is None else runfile.Writer(stream, header or {})
    try:
        kept = [] if writer is None else [c.rows for c in writer.chunks]
        report = core.Report(t=core.time_of(model, state))
        if writer is not None and writer.chunks:
            report = runfile.report_of(writer.chunks)
            state, start = writer.chunks[-1].state.copy(), False
        while report.status == 0 and (report.steps < total or start):
            settling = report.steps < settle
            left = (settle if settling else total) - report.steps
            rows, state, part = core.march(
                model,
                state,
                scheme,
                left if writer is None else min(left, CHUNK_STEPS),
                NEVER if settling else decimate,
                start=start,
                progress=part_of(progress, report.steps, total),
            )
            start = False
            kept.append(rows)
            if writer is not None and part.steps > 0:
                writer.append(runfile.Chunk(rows, state, part))
            report = report + part
    finally:
        if writer is not None:
            writer.close()
    return np.concatenate([np.zeros((0, model.channels)), *kept]), state, report


def part_of(progress: core.Progress | None, done: int, total: int) -> Callable[[int, int], object] | None:
    """Progress of one piece as progress of the whole."""
    if progress is None:
        return None
    return lambda piece, _: progress(done + piece, total)


def digest(system: System, scheme: core.Scheme, state: Array) -> str:
    """Fingerprint of everything a march depends on: two runs alike in it are alike to the last bit."""
    seen = hashlib.sha256()

    def take(*values: object) -> None:
        for value in values:
            if isinstance(value, tuple | list):
                take(*value)
            elif isinstance(value, dict):
                take(*value.items())
            elif isinstance(value, np.ndarray):
                seen.update(np.ascontiguousarray(value).tobytes())
            else:
                seen.update(repr(value).encode())
            seen.update(b"|")

    take(system.M, system.C, system.K, system.G, system.N, state)
    take([(t.L, t.material.G0, t.material.G, t.material.tau, t.material.eta0) for t in system.layers])
    take([(t.kernel().packed(), t.B) for t in system.bearings])
    take([(t.kind, t.omega, t.p_cos, t.p_sin, t.time, t.value) for t in system.loads])
    take(scheme.dt, scheme.beta, scheme.gamma, scheme.tolerance, scheme.max_iterations, scheme.audit)
    take(*scheme.profile)
    return seen.hexdigest()
