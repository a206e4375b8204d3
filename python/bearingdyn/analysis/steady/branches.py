"""All branches of steady motions over a parameter: followed, their events located, switched at flips."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from bearingdyn.analysis.steady.balance import Balance, Found, newton
from bearingdyn.analysis.steady.continuation import Curve, Point, follow, locate
from bearingdyn.analysis.steady.stability import (
    FirstOrder,
    Floquet,
    Stability,
    band_of,
    floquet,
    pooled,
)
from bearingdyn.analysis.steady.torus import Lines
from bearingdyn.types import Array, Complex

# of a motion, by which another at the same parameter must differ to be another
DIFFERENT = 1e-3
# amplitude of the doubled motion with which a branch begins at a flip, as a share of the motion there
BEGIN = 0.02
# places of the range where motions are looked for beside those of the two ends, and amplitudes, as shares of the
# mean deflection, with which they begin
PLACES, PUSHES = 5, (0.5, 1.5)
# of the range, by which a sweep that can go no further leaps on; and its most leaps
LEAP, LEAPS = 0.01, 40
# multipliers within this of the unit circle are computed with finer samples
NEAR, FINER = 0.1, 4


@dataclass(frozen=True, eq=False)
class Task:
    """What is followed: the balance at a parameter on given lines, and where.

    Parameters
    ----------
    at
        The balance at a value of the parameter on lines.
    standing
        The motion that stands still, at a value of the parameter, on lines.
    low, high, longest
        Range of the parameter and longest step in it.
    harmonics
        Of a passage.
    most
        Points of a branch.
    tolerance
        Of the location of events, in the parameter.
    """

    at: Callable[[float, Lines], Balance]
    standing: Callable[[float, Lines], Complex]
    low: float
    high: float
    longest: float
    harmonics: int
    per: int
    most: int
    tolerance: float
    models: dict[tuple[int, int], FirstOrder] = field(default_factory=dict)

    def lines(self, passages: int) -> Lines:
        """Of a motion that repeats after so many passages."""
        return Lines.harmonics(self.harmonics * passages, self.per)

    def stability(self, balance: Balance, z: Complex, passages: int, fine: int = 1, warm: Array | None = None) -> Floquet:
        """Multipliers of a motion of so many passages."""
        base = abs(float(balance.bases.frequencies(balance.speed)[0])) / passages
        band = band_of(self.harmonics * passages * base)
        key = (id(balance.system), band)
        if key not in self.models:
            if len(self.models) > 40:
                self.models.clear()
            fastest = 2.0 ** (band / 2)
            self.models[key] = FirstOrder.of(balance.system, fastest, (base / 10, fastest / 6))
        lines = balance.lines
        count = max(SAMPLES * passages, 2 * (lines.samples // 2)) * fine
        pressed = balance.press(z, lines=Lines(lines.index, lines.steps, count))
        m = z.shape[1]
        K = pooled([a.K for a in pressed.bearings], m)
        C = pooled([a.C for a in pressed.bearings], m)
        return floquet(self.models[key], balance.speed, 2 * np.pi / base, K, C, warm=warm)


# samples of a passage for its stability
SAMPLES = 256


@dataclass(frozen=True, eq=False)
class Mark:
    """One point of a branch, as it is kept."""

    point: Point
    stability: Stability | None
    moved: Complex
    event: str = ""


@dataclass(frozen=True, eq=False)
class Branch:
    """Points of one branch in their order along it; passages after which its motions repeat."""

    passages: int
    marks: tuple[Mark, ...]
    origin: str

    @property
    def span(self) -> tuple[float, float]:
        """Lowest and highest parameter."""
        values = [m.point.parameter for m in self.marks if m.event != "failed"]
        return min(values, default=math.nan), max(values, default=math.nan)


def curve_of(task: Task, lines: Lines, found: Found, passages: int) -> Curve:
    """A curve in the measure of what moves: a motion's size, and a tenth of the range."""

    def at(parameter: float) -> Balance:
        return _subharmonic(task, parameter, lines, passages)

    moving = float(np.linalg.norm(found.z[1:]))
    size = max(5.0 * moving, 0.1 * float(np.linalg.norm(found.z[0])))
    return Curve(at, scale=0.1 * (task.high - task.low), size=size)


def _subharmonic(task: Task, parameter: float, lines: Lines, passages: int) -> Balance:
    balance = task.at(parameter, lines)
    if passages == 1:
        return balance
    base = balance.bases.bases[0]
    bases = replace(
        balance.bases,
        bases=(replace(base, ratio=base.ratio / passages, omega=base.omega / passages),),
        bearings=tuple(
            replace(t, multiple=tuple(passages * k for k in t.multiple)) for t in balance.bases.bearings
        ),
    )
    return replace(balance, bases=bases)


class Tracer:
    """Follows one branch and marks what happens on it."""

    def __init__(self, task: Task, passages: int, tell: Callable[[float], object] | None = None) -> None:
        self.task, self.passages, self.tell = task, passages, tell
        self.lines = task.lines(passages)
        self.warm: Array | None = None

    def mark(self, curve: Curve, point: Point, event: str = "", fine: int = 1) -> Mark:
        """A point with its stability and what moves."""
        balance = curve.at(point.parameter)
        state = self.stability(balance, point.z, fine)
        if fine == 1 and state is not None and abs(abs(state.largest) - 1.0) < NEAR:
            state = self.stability(balance, point.z, FINER)
        return Mark(point, state, balance.moved(point.z, point.pressed.g), event)

    def stability(self, balance: Balance, z: Complex, fine: int = 1) -> Stability | None:
        """Multipliers, begun from the directions of the last point."""
        if not balance.system.bearings:
            return None
        base = replace(balance, bases=_whole(balance.bases, self.passages)) if self.passages > 1 else balance
        found = self.task.stability(base, z, self.passages, fine, self.warm)
        self.warm = found.directions
        return found.stability

    def trace(self, found: Found, parameter: float, direction: float, origin: str) -> Branch:
        """The branch through a motion, towards rising (+1) or falling parameter."""
        curve = curve_of(self.task, self.lines, found, self.passages)
        begin = curve.begin(found, parameter, direction)
        return Branch(self.passages, tuple(self._marks(curve, begin)), origin)

    def _marks(self, curve: Curve, begin: Point) -> Iterator[Mark]:
        task = self.task
        last = self.mark(curve, begin)
        yield last
        ended = begin
        for point in follow(curve, begin, task.low, task.high, task.longest, task.most):
            new = self.mark(curve, point)
            events = [e for e in self._events(curve, last, new) if task.low <= e.point.parameter <= task.high]
            ahead = 1.0 if point.parameter >= last.point.parameter else -1.0
            yield from sorted(events, key=lambda e: ahead * e.point.parameter)
            yield new
            if self.tell is not None:
                self.tell(point.parameter)
            last, ended = new, point
        inside = task.low < ended.parameter < task.high
        if inside:
            yield Mark(ended, None, np.full_like(last.moved, np.nan), "failed")

    def _events(self, curve: Curve, before: Mark, after: Mark) -> list[Mark]:
        found = []
        if before.point.slope * after.point.slope < 0.0:
            found.append(self._at(curve, before, after, "fold", lambda p: p.slope))
        a, b = before.stability, after.stability
        if a is not None and b is not None:
            for name in ("flip", "neimark-sacker"):
                if (_beyond(a, name) > 0.0) != (_beyond(b, name) > 0.0):

                    def test(p: Point, name: str = name) -> float:
                        state = self.stability(curve.at(p.parameter), p.z, FINER)
                        return 0.0 if state is None else _beyond(state, name)

                    found.append(self._at(curve, before, after, name, test))
        return [f for f in found if f is not None]

    def _at(self, curve: Curve, before: Mark, after: Mark, name: str, test: Callable[[Point], float]) -> Mark | None:
        point = locate(curve, before.point, after.point, test, self.task.tolerance)
        return None if point is None else self.mark(curve, point, name, FINER)

    def doubled(self, flip: Mark) -> Branch | None:
        """The branch of twice the period that begins at a flip, or None where it is not found."""
        task, twice = self.task, 2 * self.passages
        tracer = Tracer(task, twice, self.tell)
        curve = curve_of(task, self.lines, _found(flip.point), self.passages)
        balance = curve.at(flip.point.parameter)
        base = replace(balance, bases=_whole(balance.bases, self.passages)) if self.passages > 1 else balance
        direction = task.stability(base, flip.point.z, self.passages, FINER).antiperiodic(tracer.lines)
        if direction is None:
            return None
        z = self.lines.moved(flip.point.z, tracer.lines, 2)
        size = BEGIN * float(np.linalg.norm(flip.point.z[1:])) / max(float(np.linalg.norm(direction)), 1e-300)
        grown = curve_of(task, tracer.lines, replace(_found(flip.point), z=z), twice)
        from bearingdyn.analysis.steady.balance import flat

        border = flat(direction / grown.size)
        border /= np.linalg.norm(border)
        point = grown.correct(z + size * direction, flip.point.parameter, (border, 0.0))
        if point is None:
            return None
        if float(point.tangent @ border) < 0.0:  # away from the flip
            point = replace(point, tangent=-point.tangent, slope=-point.slope)
        marks = tuple(tracer._marks(grown, point))
        return Branch(twice, marks, f"flip at {flip.point.parameter:.6g}")


def _whole(bases: object, passages: int) -> object:
    """The bases of a subharmonic motion as those of one passage again."""
    b = bases
    base = b.bases[0]  # type: ignore[attr-defined]
    return replace(
        b,  # type: ignore[type-var]
        bases=(replace(base, ratio=base.ratio * passages, omega=base.omega * passages),),
        bearings=tuple(
            replace(t, multiple=tuple(k / passages for k in t.multiple))
            for t in b.bearings  # type: ignore[attr-defined]
        ),
    )


def _found(point: Point) -> Found:
    return Found(point.z, point.pressed, point.residual, 0, point.iterations, True)


def _beyond(state: Stability, name: str) -> float:
    """Size less one of the largest multiplier that would bring this; −1 where there is none."""
    from bearingdyn.analysis.steady.stability import kind

    return max((abs(m) - 1.0 for m in state.multipliers if kind(complex(m)) == name), default=-1.0)


def known(branches: Sequence[Branch], passages: int, parameter: float, z: Complex) -> bool:
    """Whether a motion lies on a branch, between two of its points."""
    size = float(np.linalg.norm(z[1:])) + 1e-4 * float(np.linalg.norm(z[0]))
    for branch in branches:
        if branch.passages != passages:
            continue
        points = [m.point for m in branch.marks if m.event != "failed"]
        for a, b in zip(points, points[1:], strict=False):
            if (a.parameter - parameter) * (b.parameter - parameter) > 0.0 or a.parameter == b.parameter:
                continue
            share = (parameter - a.parameter) / (b.parameter - a.parameter)
            near = a.z + share * (b.z - a.z)
            gap = float(np.linalg.norm(b.z - a.z))
            if float(np.linalg.norm(near - z)) <= DIFFERENT * size + 0.2 * gap:
                return True
    return False


def explored(task: Task, doublings: int, several: bool, tell: Callable[[float], object] | None = None) -> list[Branch]:
    """All branches that are found from both ends, from several states between, and at flips."""
    branches: list[Branch] = []
    for start, direction, origin in ((task.high, -1.0, "coasting down"), (task.low, 1.0, "running up")):
        branches += _sweep(task, branches, start, direction, origin, tell)
    if several:
        lines = task.lines(1)
        for place in np.linspace(task.low, task.high, PLACES + 2)[1:-1].tolist():
            rest = task.standing(place, lines)
            for push in (0.0, *PUSHES):
                z = rest.copy()
                z[1] = push * np.abs(rest[0]) * np.array([1.0, -1j] * len(rest[0]))[: len(rest[0])]
                found = newton(task.at(place, lines), z, tolerance=1e-10, most=25)
                if found.converged and not known(branches, 1, place, found.z):
                    for direction in (-1.0, 1.0):
                        branches.append(Tracer(task, 1, tell).trace(found, place, direction, "another state"))
    for _ in range(doublings):
        new = []
        for branch in branches:
            if branch.passages != max(b.passages for b in branches):
                continue
            for mark in branch.marks:
                if mark.event == "flip":
                    made = Tracer(task, branch.passages, tell).doubled(mark)
                    if made is not None and not _same_start(made, [*branches, *new]):
                        new.append(made)
        if not new:
            break
        branches += new
    return branches


def _same_start(branch: Branch, others: Sequence[Branch]) -> bool:
    """Whether a branch is one that is known already, begun at its other end."""
    middle = branch.marks[len(branch.marks) // 2].point
    if known(others, branch.passages, middle.parameter, middle.z):
        return True
    # half a period later it is the same motion
    odd = np.arange(len(middle.z)) % 2 == 1
    z = middle.z.copy()
    z[odd] *= -1.0
    return known(others, branch.passages, middle.parameter, z)


def _sweep(
    task: Task, others: Sequence[Branch], start: float, direction: float, origin: str, tell: Callable[[float], object] | None
) -> list[Branch]:
    """Branches met from one end, leaping on where one can be followed no further."""
    lines = task.lines(1)
    found: list[Branch] = []
    place = start
    z = task.standing(place, lines)
    for _ in range(LEAPS):
        if not task.low <= place <= task.high:
            break
        motion = newton(task.at(place, lines), z, tolerance=1e-10)
        if not motion.converged:
            motion = newton(task.at(place, lines), task.standing(place, lines), tolerance=1e-10)
        if motion.converged:
            if known([*others, *found], 1, place, motion.z):
                break
            found.append(Tracer(task, 1, tell).trace(motion, place, direction, origin))
            last = found[-1].marks[-1]
            if last.event != "failed":
                break
            place, z = last.point.parameter, last.point.z
        place += direction * LEAP * (task.high - task.low)
    return found
