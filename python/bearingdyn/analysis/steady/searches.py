"""Searches for branches of steady motions: from both ends, states between, at flips; their joining."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import combinations

import numpy as np

from bearingdyn.analysis.steady.balance import newton
from bearingdyn.analysis.steady.branches import DIFFERENT, Branch, Mark, Task, Tell, Tracer, known
from bearingdyn.notice import OutsideBand, untold

# places of the range where motions are looked for beside those of the two ends, and amplitudes, as shares of
# the mean deflection, with which they begin: a motion that does not part from its balls is smaller than it
PLACES, PUSHES = 5, (-0.3, 0.3)
# of the range, by which a sweep that can go no further leaps on; and its most leaps
LEAP, LEAPS = 0.01, 40


@dataclass(frozen=True)
class Job:
    """One search for branches: "sweep" from a place in a direction, "state" begun by a push, or "flip".

    "onward" goes on where a sweep stopped `until` the middle of the range.
    """

    kind: str
    place: float
    direction: float = 0.0
    push: float = 0.0
    origin: str = ""
    until: float = math.nan


def sweeps(task: Task) -> list[Job]:
    """Branches from both ends of the range to its middle: the jobs that search for them."""
    return [
        Job("sweep", task.high, -1.0, origin="coasting down", until=task.middle),
        Job("sweep", task.low, 1.0, origin="running up", until=task.middle),
    ]


def onward(task: Task, branches: Sequence[Branch]) -> list[tuple[Job, tuple[int, Mark]]]:
    """Branches that the middle of the range cut off, and no other goes on from: the jobs that follow them."""
    jobs = []
    for branch in branches:
        end = branch.marks[-1]
        if not _stands(end, task.middle):
            continue
        if any(
            b is not branch and _stands(b.marks[-1], task.middle) and _same(b.marks[-1], end)
            for b in branches
        ):
            continue
        direction = -1.0 if branch.span[1] > task.middle else 1.0
        jobs.append((Job("onward", task.middle, direction, origin=branch.origin), (branch.passages, end)))
    return jobs


def joined(task: Task, branches: Sequence[Branch]) -> list[Branch]:
    """Branches, those made one that end in the same motion at the middle of the range."""
    made = list(branches)
    for a, b in combinations(range(len(made)), 2):
        if made[a].marks and made[b].marks:
            marks = _chained(made[a].marks, made[b].marks, task.middle)
            if marks:
                made[a], made[b] = replace(made[a], marks=marks), replace(made[b], marks=())
    return [b for b in made if b.marks]


def _chained(first: tuple[Mark, ...], second: tuple[Mark, ...], place: float) -> tuple[Mark, ...]:
    """Both in the first one's order, if one of its ends at a place is one of the other's; else none."""
    for other in (second, second[::-1]):
        for a, b in ((first, other), (other, first)):
            if _stands(a[-1], place) and _stands(b[0], place) and _same(a[-1], b[0]):
                return (*a, *b[1:])
    return ()


def _stands(mark: Mark, place: float) -> bool:
    return mark.event != "failed" and mark.point.parameter == place


def _same(a: Mark, b: Mark) -> bool:
    """Whether two marks at one parameter are the same motion."""
    size = float(np.linalg.norm(a.point.z[1:])) + 1e-4 * float(np.linalg.norm(a.point.z[0]))
    return float(np.linalg.norm(a.point.z - b.point.z)) <= DIFFERENT * size


def from_both_ends(task: Task) -> list[Branch]:
    """Branches that searches from both ends of the range find, one after the other."""
    found: list[Branch] = []
    for job in sweeps(task):
        found += done(task, job, found)
    for job, mark in onward(task, found):
        found += done(task, job, found, mark)
    return joined(task, found)


def states(task: Task) -> list[Job]:
    """Branches from several states within the range: the jobs that search for them."""
    places = np.linspace(task.low, task.high, PLACES + 2)[1:-1].tolist()
    return [Job("state", p, push=push, origin="another state") for p in places for push in (0.0, *PUSHES)]


def done(
    task: Task, job: Job, others: Sequence[Branch], flip: tuple[int, Mark] | None = None, tell: Tell = None
) -> list[Branch]:
    """Branches that one job finds and that are not known from others."""
    # what laws are asked beyond their bands the map has told, and a worker's own thread knows nothing of that
    with untold(OutsideBand):
        if job.kind == "sweep":
            return _sweep(task, others, job, tell)
        if job.kind == "state":
            return _state(task, others, job, tell)
        assert flip is not None
        if job.kind == "onward":
            return _onward(task, others, job, flip[1], tell)
        made = Tracer(task, flip[0], others, tell).doubled(flip[1])
        return [] if made is None or _met(made, others, task.tolerance) else [made]


def _state(task: Task, others: Sequence[Branch], job: Job, tell: Tell) -> list[Branch]:
    lines = task.lines(1)
    rest = task.standing(job.place, lines)
    z = rest.copy()
    # a swing of its own size across the load, in the sense of rotation
    size = job.push * float(np.abs(rest[0]).max(initial=0.0))
    z[1] += size * np.where(np.arange(z.shape[1]) % 2 == 0, 1.0, -1j)
    found = newton(task.at(job.place, lines), z, tolerance=1e-10, most=25)
    if not found.converged or known(others, 1, job.place, found.z):
        return []
    made: list[Branch] = []
    for direction in (-1.0, 1.0):
        tracer = Tracer(task, 1, [*others, *made], tell)
        made.append(tracer.trace(found, job.place, direction, job.origin))
    return made


def _onward(task: Task, others: Sequence[Branch], job: Job, mark: Mark, tell: Tell) -> list[Branch]:
    """What goes on from the end of a sweep."""
    motion = newton(task.at(job.place, task.lines(1)), mark.point.z, tolerance=1e-10)
    return [Tracer(task, 1, others, tell).trace(motion, job.place, job.direction, job.origin)]


def _met(branch: Branch, others: Sequence[Branch], tolerance: float) -> bool:
    """Whether a branch is known already, begun at its other end, but for what is near its flip."""
    begin = branch.marks[0].point.parameter
    away = [m.point for m in branch.marks if abs(m.point.parameter - begin) > tolerance]
    return bool(away) and all(known(others, branch.passages, p.parameter, p.z) for p in away)


def _sweep(task: Task, others: Sequence[Branch], job: Job, tell: Tell) -> list[Branch]:
    """Branches met from one end to the middle, leaping on where one can be followed no further."""
    lines = task.lines(1)
    found: list[Branch] = []
    place = job.place
    span = min(place, job.until), max(place, job.until)
    z = task.standing(place, lines)
    for _ in range(LEAPS):
        if not span[0] <= place <= span[1]:
            break
        motion = newton(task.at(place, lines), z, tolerance=1e-10)
        if not motion.converged:
            motion = newton(task.at(place, lines), task.standing(place, lines), tolerance=1e-10)
        if motion.converged:
            have = [*others, *found]
            if known(have, 1, place, motion.z):
                break
            tracer = Tracer(task, 1, have, tell, span)
            found.append(tracer.trace(motion, place, job.direction, job.origin))
            last = found[-1].marks[-1]
            if last.event != "failed":
                break
            place, z = last.point.parameter, last.point.z
        place += job.direction * LEAP * (task.high - task.low)
    return found
