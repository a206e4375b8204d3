"""Steady motions over speed, or over any other number an application is made from."""

from __future__ import annotations

import math
import os
from collections.abc import Callable, Iterable, Iterator, Sequence
from concurrent.futures import Executor
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np

from bearingdyn.analysis.equilibrium import Equilibrium, state_of
from bearingdyn.analysis.march_state import system_hash
from bearingdyn.analysis.recordable_channels import channel_of
from bearingdyn.analysis.softening import layer_names, warn_of_strain
from bearingdyn.analysis.steady.borne import PUSH, Borne, pushed, warn_of_motions
from bearingdyn.analysis.steady.branch_files import BranchFiles
from bearingdyn.analysis.steady.branches import Branch, Family, Made, Mark, Speeds, Task, divided, known
from bearingdyn.analysis.steady.cut_harmonics import CUT, cut_off, share_cut, warn_of_cut
from bearingdyn.analysis.steady.event_accuracy import within
from bearingdyn.analysis.steady.motion import MOTIONS
from bearingdyn.analysis.steady.problem import Problem
from bearingdyn.analysis.steady.searches import Job, done, joined, onward, states, sweeps
from bearingdyn.application import Application
from bearingdyn.checks import name_list, number, one_speed, require, vector, whole
from bearingdyn.material import band_told_once
from bearingdyn.progress import Progress, told
from bearingdyn.system import System
from bearingdyn.types import Array
from bearingdyn.units import takes

if TYPE_CHECKING:
    import xarray

Search: TypeAlias = tuple[Job, tuple[int, Mark] | None]
"""A job, and what it begins at if it begins at a mark: passages of its branch, and the mark."""

# harmonics of a passage in a map, samples for each, points of a branch at most; what may be asked
HARMONICS, PER, MOST = 24, 16, 5000
MOST_HARMONICS = 500
# of the range, to which events are located
LOCATED = 1e-6
# of a made application's number, over which slopes are taken: its parts are meshed and reduced anew
MADE_SLOPE = 1e-4


@takes(speeds="rad/s")
def speed_map(
    source: Equilibrium | Application | System,
    *,
    speeds: tuple[float, float] | None = None,
    record: Sequence[str],
    harmonics: int = HARMONICS,
    points: int = 100,
    doublings: int = 1,
    several: bool = True,
    store: str | os.PathLike[str] | None = None,
    executor: Executor | None = None,
    progress: Progress | bool | None = None,
    rpm: tuple[float, float] | None = None,
) -> xarray.Dataset:
    """Follow all steady motions over a range of speeds, with their stability.

    Branches are followed by the length of their arc, round folds, from both ends of the range to its
    geometric middle, and on from there where they do not meet: as a coast-down and a run-up would meet them;
    and from several states between, for branches that hang together with none of these. Folds, flips (period
    doublings) and Neimark–Sacker points are located; at flips the branch of twice the period is followed as
    well. Where a branch can be followed no further a point is marked "failed", and the search goes on beyond
    it.

    Parameters
    ----------
    source
        Equilibrium, application or system whose motion has one base frequency, the passage of the balls.
    speeds
        Lowest and highest speed of the shaft, rad/s, both positive.
    record
        Motions: "shaft.left.y", "shaft.left.y.velocity", "….acceleration".
    harmonics
        Of a passage.
    points
        About how many of a branch that hardly bends; more where it does.
    doublings
        How often the period may double.
    several
        Whether motions are looked for from several states between the ends.
    store
        Folder that keeps every finished search: the same call continues from there.
    executor
        Searches run in it, as in a process pool or Dask's; what two of them both found is kept once.
    progress
        True for a bar, False for none, or a function called with (searches done, in all).
    rpm
        The speeds in revolutions a minute, instead of `speeds`.

    Returns
    -------
    xarray.Dataset
        Over "point", branch by branch and along each: speed, rad/s; branch, its number; passages, after which
        the motion repeats; stable (1, 0, or −1 where it was not computed); multiplier, the largest by size of
        what bearings feel; growth, 1/s; event ("", "fold", "flip", "neimark-sacker" or "failed");
        located_within, how closely, in the unit of the speed: of folds that crowd at the tip of a branch,
        which are kinks of contacts between samples, it is what they span; strain (point, layer), of layers
        that soften (`Maxwell.payne`), whose amplitude stands still while a departure is followed;
        peak_to_peak and rms (point, channel); cut (point, channel), the amplitude of the lines next above the
        last; amplitude (point, order, channel), complex, at multiples of the passage, and of its half where
        periods doubled.

    Raises
    ------
    ValueError
        For a range that is none, a channel that is no motion, a motion of several base frequencies, and where
        nothing pushes at an end of the range.

    Warns
    -----
    BearingWarning
        Where the contact pressure of a ball exceeds 4.2 GPa (ISO 76) in a motion; the worst of each bearing.
    OpenSideWarning
        Where balls of an angular contact bearing are pressed where it has no shoulder, or none onto it.
    BeyondSweep
        Where a layer's strain leaves the sweep its law of softening comes from.
    CutHarmonics
        Where the harmonics next above the last would add more than 2 % of a channel's largest line; of the
        point where they would add most.

    References
    ----------
    E. L. Allgower and K. Georg, Introduction to Numerical Continuation Methods, SIAM 2003.
    """
    speeds = one_speed(speeds, rpm, what="speeds")
    low, high = _range("speeds", speeds, "two speeds in rad/s, the lower one first")
    require(low > 0.0, "speeds", (low, high), "the lowest must be positive, in rad/s: at rest nothing passes")
    problem = Problem.of(source)
    problem.system.check_speed(high)
    family = Speeds(problem)
    task = _task(family, record, (low, math.sqrt(low * high), high), harmonics, points, 1e-6)
    with band_told_once(*_asked(task)):
        branches = _branches(task, doublings, several, store, executor, progress)
    cut = _cut_of_told(task, branches, "at {:.6g} rad/s")
    return _dataset(task, branches, cut, "speed", "rad/s", {**state_of(problem.source)})


@takes(speed="rad/s")
def parameter_map(
    make: Callable[[float], Application],
    *,
    values: tuple[float, float],
    speed: float | None = None,
    record: Sequence[str],
    harmonics: int = HARMONICS,
    points: int = 40,
    doublings: int = 1,
    several: bool = False,
    store: str | os.PathLike[str] | None = None,
    executor: Executor | None = None,
    progress: Progress | bool | None = None,
    rpm: float | None = None,
) -> xarray.Dataset:
    """As `speed_map`, at one speed: all steady motions over a number that the application is made from.

    Parameters
    ----------
    make
        Application of a value: of a load, a clearance, a preload, the thickness of a layer.
    values
        Lowest and highest value.
    speed
        Of the shaft, rad/s.
    record, harmonics, points, doublings, several, store, executor, progress
        As in `speed_map`; `make` must then be a function that can be pickled.
    rpm
        The speed in revolutions a minute, instead of `speed`.

    Returns
    -------
    xarray.Dataset
        As `speed_map`, with `parameter` in place of speed.

    Raises
    ------
    ValueError
        As `speed_map`, and for a speed of zero.

    Warns
    -----
    BearingWarning, OpenSideWarning, BeyondSweep, CutHarmonics
        As `speed_map`.
    """
    require(callable(make), "make", make, "it must be a function of one number that returns an Application")
    low, high = _range("values", values, "two values, the lower one first")
    speed = number("speed", one_speed(speed, rpm), "it must be one finite speed in rad/s")
    require(speed != 0.0, "speed", speed, "at rest nothing passes; give the speed of the shaft in rad/s")
    family = Made(make, speed)
    task = _task(family, record, (low, 0.5 * (low + high), high), harmonics, points, MADE_SLOPE)
    with band_told_once(*_asked(task)):
        branches = _branches(task, doublings, several, store, executor, progress)
    cut = _cut_of_told(task, branches, "at the value {:.6g}")
    return _dataset(task, branches, cut, "parameter", "", {"speed": speed})


def _range(field: str, value: object, meaning: str) -> tuple[float, float]:
    low, high = vector(field, value, (2,), meaning).tolist()  # type: ignore[arg-type]
    require(low < high, field, value, f"the first must be below the second: {meaning}")
    return low, high


def _task(
    family: Family,
    record: Sequence[str],
    span: tuple[float, float, float],
    harmonics: int,
    points: int,
    slope: float,
) -> Task:
    low, middle, high = span
    record = name_list("record", record)
    problem, _ = family.at(high)
    for name in record:
        kind = channel_of(problem.system, name)[0][0]
        require(
            kind in MOTIONS, "record", name, "a map records motions: displacement, velocity, acceleration"
        )
    bases = [b.name for b in problem.bases.bases]
    require(
        len(bases) == 1,
        "source",
        problem.system,
        f"its motion has the base frequencies {bases}, and a map follows motions of one; leave unbalance, "
        f"waviness and harmonic loads out, or call steady_state speed by speed",
    )
    task = Task(
        family,
        tuple(record),
        low,
        high,
        middle,
        (high - low) / whole("points", points, 2, 100_000),
        whole("harmonics", harmonics, 1, MOST_HARMONICS),
        PER,
        MOST,
        LOCATED * (high - low),
        slope,
    )
    for end in (low, high):
        lines = task.lines(1)
        balance = task.at(end, lines)
        if not pushed(balance, balance.press(task.standing(end, lines), tangents=False)):
            raise ValueError(
                f"nothing pushes at {end:g}, an end of the range: no ball is pressed at rest, and no load "
                f"acts, so that there is no motion to follow. {PUSH}"
            )
    return task


def _asked(task: Task) -> tuple[list[Any], Array]:
    """Laws of the layers, and the ends of the range of ω, rad/s, at which a map asks them."""
    ends = []
    for parameter in (task.low, task.high):
        problem, speed = task.family.at(parameter)
        base = np.abs(problem.bases.frequencies(speed))
        ends += [float(base.min()), task.harmonics * float(base.max())]
    return [t.material for t in problem.system.layers], np.array([min(ends), max(ends)])


def _branches(
    task: Task,
    doublings: int,
    several: bool,
    store: str | os.PathLike[str] | None,
    executor: Executor | None,
    progress: Progress | bool | None,
) -> list[Branch]:
    """All branches: sweeps, what goes on from them, states between, then what begins at flips."""
    doublings = whole("doublings", doublings, 0)
    files = None if store is None else BranchFiles.of(store, _about(task))
    branches: list[Branch] = []
    with told(progress, "search") as tell:
        seen = 0

        def search(jobs: Sequence[Search]) -> None:
            nonlocal seen
            total = seen + len(jobs)
            for made in _run(task, jobs, branches, files, executor):
                branches.extend(b for b in made if not _known(b, branches))
                seen += 1
                if tell is not None:
                    tell(seen, total)

        search([(job, None) for job in sweeps(task)])
        search(onward(task, branches))
        branches[:] = joined(task, branches)
        if several:
            search([(job, None) for job in states(task)])
        for level in range(doublings):
            flips: tuple[list[Search], list[Search]] = ([], [])
            for k, b in enumerate(branches):
                own = [i for i, m in enumerate(b.marks) if m.event == "flip" and b.passages == 2**level]
                for n, i in enumerate(own):
                    job = Job("flip", b.marks[i].point.parameter, origin=f"{k}.{i}")
                    flips[n % 2].append((job, (b.passages, b.marks[i])))
            # what begins at a flip often ends at the next one, which is then known
            search(flips[0])
            search(flips[1])
    return branches


def _run(
    task: Task,
    jobs: Sequence[Search],
    branches: list[Branch],
    files: BranchFiles | None,
    executor: Executor | None,
) -> Iterable[list[Branch]]:
    """What each job finds, in their order; those that a folder holds are read."""
    if executor is None:
        return (_kept(task, job, list(branches), flip, files) for job, flip in jobs)
    known = tuple(b.motions_alone() for b in branches)
    running = [
        (files.read(job) if files else None) or executor.submit(done, task, job, known, flip)
        for job, flip in jobs
    ]

    def ended() -> Iterator[list[Branch]]:
        for (job, _), future in zip(jobs, running, strict=True):
            if isinstance(future, list):
                yield future
                continue
            found = future.result()
            if files is not None:
                files.write(job, found)
            yield found

    return ended()


def _kept(
    task: Task, job: Job, branches: list[Branch], flip: tuple[int, Mark] | None, files: BranchFiles | None
) -> list[Branch]:
    found = None if files is None else files.read(job)
    if found is None:
        found = done(task, job, branches, flip)
        if files is not None:
            files.write(job, found)
    return found


def _known(branch: Branch, others: Sequence[Branch]) -> bool:
    """Whether nearly all of a branch is known: two searches at once may find the same."""
    points = [m.point for m in branch.marks if m.event != "failed"]
    hits = sum(known(others, branch.passages, p.parameter, p.z) for p in points)
    return bool(points) and hits > 0.9 * len(points)


def _motions(task: Task, branches: Sequence[Branch], where: str) -> Iterator[Borne]:
    """Every motion found, with its balance and the words for its place."""
    for branch in branches:
        lines = task.lines(branch.passages)
        for mark in branch.marks:
            if mark.event != "failed":
                balance = divided(task.at(mark.point.parameter, lines), branch.passages)
                # of what a store holds only the motion is known
                pressed = mark.point.pressed if mark.point.pressed.bearings else None
                yield balance, mark.point.z, where.format(mark.point.parameter), pressed


def _cut_of_told(task: Task, branches: Sequence[Branch], where: str) -> Array:
    """Amplitudes (motions found, channels) above the last harmonics; warnings of all motions are given."""
    cut: list[Array] = []

    def measured() -> Iterator[Borne]:
        for balance, z, place, pressed in _motions(task, branches, where):
            pressed = pressed or balance.press(z, tangents=False)
            cut.append(cut_off(balance, z, [channel_of(balance.system, c)[0] for c in task.places], pressed))
            yield balance, z, place, pressed

    warn_of_motions(measured())
    return np.array(cut).reshape(-1, len(task.places))


def _warn_of_cut(made: xarray.Dataset, name: str, unit: str, harmonics: int) -> None:
    """Warn (CutHarmonics) of the point of a map that misses most."""
    cut = made["cut"].values
    share = share_cut(made["amplitude"].values, cut)
    wants = int((share > CUT).any(axis=1).sum())
    if not wants:
        return
    i, c = np.unravel_index(int(share.argmax()), share.shape)
    place = f"{made[name].values[i]:.6g} {unit}".rstrip()
    what = f"the motion at {place}, one of {wants} points of {len(share)},"
    channel = made.isel(channel=int(c))
    warn_of_cut(
        what, harmonics, str(channel["channel"].values), share[i, c], cut[i, c], str(channel["unit"].values)
    )


def _about(task: Task) -> dict[str, object]:
    """What tells one map from another."""
    ends = [task.family.at(p) for p in (task.low, task.high)]
    return {
        "systems": [system_hash(problem.system) for problem, _ in ends],
        "speeds": [speed for _, speed in ends],
        "task": [task.places, task.low, task.high, task.longest, task.harmonics, task.per, task.most],
    }


def _within(branch: Branch, tolerance: float) -> list[float]:
    """How closely each event of a branch is located."""
    marks = branch.marks
    return within([m.event for m in marks], [m.point.parameter for m in marks], tolerance)


def _dataset(
    task: Task,
    branches: Sequence[Branch],
    missing: Array,
    name: str,
    unit: str,
    attrs: dict[str, object],
) -> xarray.Dataset:
    from bearingdyn.results import dataset, inputs_of

    problem, _ = task.family.at(task.high)
    channels = [channel_of(problem.system, c) for c in task.places]
    rate = np.array([MOTIONS.index(channel[0]) for channel, _ in channels])
    rows = [(k, b.passages, m) for k, b in enumerate(branches) for m in b.marks]
    most = max((b.passages for b in branches), default=1)
    count = task.harmonics * most + 1
    passing = np.zeros(len(rows))
    amplitude = np.zeros((len(rows), count, len(channels)), dtype=np.complex128)
    soft = layer_names(problem.system)
    strain = np.zeros((len(rows), len(soft)))
    swing, rms = np.full((2, len(rows), len(channels)), np.nan)
    for i, (_, passages, mark) in enumerate(rows):
        lines = task.lines(passages)
        own, speed = task.family.at(mark.point.parameter)
        passing[i] = abs(float(own.bases.frequencies(speed)[0])) / (2 * np.pi)
        omega = lines.index[:, 0] * float(own.bases.frequencies(speed)[0]) / passages
        of = own.receptances.of_layers
        strain[i] = own.receptances.soft.along(mark.point.z[:, of], omega, own.rest[of]).strain
        moved = mark.moved * (1j * omega[:, None]) ** rate
        signal = lines.signals(moved) if np.isfinite(moved).all() else np.full((1, len(channels)), np.nan)
        swing[i], rms[i] = np.ptp(signal, axis=0), signal.std(axis=0)
        swing[i][np.isnan(signal).any(axis=0)] = np.nan
        amplitude[i, :: most // passages] = moved[:count]
    states = [m.stability for _, _, m in rows]
    cut = np.full((len(rows), len(channels)), np.nan)
    cut[[m.event != "failed" for _, _, m in rows]] = missing

    def each(value: Callable[[Mark], float]) -> Array:
        return np.array([value(m) for _, _, m in rows])

    strains = dict[str, Any]()
    if soft:
        warn_of_strain(problem.system, strain[..., None])
        of_layers = "shear strain amplitude of each layer that softens, of all lines"
        strains["strain"] = (("point", "layer"), strain, "1", of_layers)

    made = dataset(
        {
            name: ("point", each(lambda m: m.point.parameter), unit, name),
            "branch": (
                "point",
                np.array([k for k, _, _ in rows], dtype=np.intp),
                "1",
                "number of the branch",
            ),
            "passages": ("point", np.array([p for _, p, _ in rows], dtype=np.intp), "1", "of a period"),
            "stable": (
                "point",
                np.array([-1 if s is None else int(s.stable) for s in states], dtype=np.intp),
                "1",
                "1 stable, 0 not, −1 not computed",
            ),
            "multiplier": (
                "point",
                np.array([math.nan if s is None else abs(s.largest) for s in states]),
                "1",
                "largest Floquet multiplier by size",
            ),
            "growth": (
                "point",
                np.array([math.nan if s is None else s.growth for s in states]),
                "1/s",
                "rate of growth of the fastest departure",
            ),
            "event": (
                "point",
                np.array([m.event for _, _, m in rows], dtype=np.str_),
                "",
                "what is located there",
            ),
            "located_within": (
                "point",
                np.array([w for b in branches for w in _within(b, task.tolerance)]),
                unit,
                "how closely the event is located",
            ),
            "passage_frequency": ("point", passing, "Hz", "of the balls, or of the load that drives"),
            "residual": ("point", each(lambda m: m.point.residual), "1", "of the balance, relative"),
            "peak_to_peak": (("point", "channel"), swing, "", "swing of each channel; units in `unit`"),
            "rms": (("point", "channel"), rms, "", "about the mean; units in `unit`"),
            "cut": (("point", "channel"), cut, "", "amplitude of the lines next above the last; in `unit`"),
            "amplitude": (("point", "order", "channel"), amplitude, "", "complex amplitudes, zero-to-peak"),
            **strains,
        },
        {
            "analysis": "speed map" if name == "speed" else "parameter map",
            "harmonics": task.harmonics,
            "failed": sum(m.event == "failed" for _, _, m in rows),
            **attrs,
            **inputs_of(problem.system.inputs),
        },
        {
            "channel": (list(task.places), ""),
            "order": (np.arange(count) / most, "1"),
            **({"layer": (soft, "")} if soft else {}),
        },
    )
    meaning = {"units": "", "long_name": "unit of each channel"}
    origins = {"units": "", "long_name": "how each branch was found"}
    made = made.assign_coords(
        unit=("channel", [u for _, u in channels], meaning),
        origin=("point", [b.origin for b in branches for _ in b.marks], origins),
    )
    _warn_of_cut(made, name, unit, task.harmonics)
    return made
