"""All branches of steady motions over a parameter: followed, their events located, switched at flips."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field, replace
from itertools import pairwise
from typing import Protocol, TypeAlias

import numpy as np

from bearingdyn.analysis.recordable_channels import channel_of
from bearingdyn.analysis.steady.balance import Balance, Found, Pressed, flat, newton
from bearingdyn.analysis.steady.continuation import SLOPE, Curve, Point, distance, follow, locate
from bearingdyn.analysis.steady.event_accuracy import half_turn, once
from bearingdyn.analysis.steady.layer_lines import Softened, frozen
from bearingdyn.analysis.steady.problem import Problem
from bearingdyn.analysis.steady.stability import (
    FirstOrder,
    Floquet,
    Stability,
    band_of,
    floquet,
    kind,
    pooled,
)
from bearingdyn.analysis.steady.torus import Bases, Lines
from bearingdyn.application import Application
from bearingdyn.kept_by_object import kept_by_object
from bearingdyn.system import System
from bearingdyn.types import Array, Complex

# of a motion, by which another at the same parameter must differ to be another
DIFFERENT = 1e-3
# amplitude of the doubled motion with which a branch begins at a flip, as a share of the motion there
BEGIN = 0.02
# of the last step of a doubled branch, with which its rest is followed to the flip where it ends
REST = 0.125
# of a multiplier's size, within which an event lies on the unit circle
ON_CIRCLE = 2e-3
# of a multiplier's size, within which it may be beyond the circle by finer samples
NEAR_FLIP = 0.02
# times as many samples for the multipliers of a located point
FINER = 12
# what crosses the circle beside a fold, which the arc tells
CROSSINGS = ("flip", "neimark-sacker")


Tell: TypeAlias = Callable[[float], object] | None
"""Told of the parameter reached."""


class Family(Protocol):
    """What branches of steady motions run over: of each value of a parameter its problem and shaft speed."""

    def at(self, parameter: float) -> tuple[Problem, float]:
        """The problem, and the speed, rad/s."""


@dataclass(frozen=True, eq=False)
class Speeds:
    """Branches over speed: the family whose parameter is the speed of one system."""

    problem: Problem

    def at(self, parameter: float) -> tuple[Problem, float]:
        """The problem, and the parameter as its speed."""
        return self.problem, parameter


@dataclass(frozen=True, eq=False)
class Made:
    """Branches of steady motions over another number: applications made from it; the last few are kept."""

    make: Callable[[float], Application]
    speed: float
    recent: dict[float, Problem] = field(default_factory=dict)

    def at(self, parameter: float) -> tuple[Problem, float]:
        """The problem of what is made from the parameter, and the speed."""
        if parameter not in self.recent:
            while len(self.recent) > 6:
                del self.recent[next(iter(self.recent))]
            self.recent[parameter] = Problem.of(self.make(parameter))
        return self.recent[parameter], self.speed


@dataclass(frozen=True, eq=False)
class Task:
    """A task for following branches of steady motions: what, and where.

    Parameters
    ----------
    family
        Systems over the parameter.
    places
        Channels of motion whose rows are asked for.
    low, high, longest
        Range of the parameter and longest step in it.
    middle
        Where sweeps from both ends meet.
    harmonics, per
        Of a passage, and samples for each.
    most
        Points of a branch.
    tolerance
        Of the location of events, in the parameter.
    slope_step
        Of the parameter, relative, over which slopes are taken.
    """

    family: Family
    places: tuple[str, ...]
    low: float
    high: float
    middle: float
    longest: float
    harmonics: int
    per: int
    most: int
    tolerance: float
    slope_step: float = SLOPE
    models: dict[tuple[int, int], FirstOrder] = field(default_factory=dict)

    def at(self, parameter: float, lines: Lines) -> Balance:
        """The balance at a parameter, on lines."""
        problem, speed = self.family.at(parameter)
        known = _rows(problem.system)
        if self.places not in known:
            own = [channel_of(problem.system, name)[0][1] for name in self.places]
            known[self.places] = np.array(own).reshape(-1, problem.system.n)
        return problem.balance(lines, speed, known[self.places])

    def standing(self, parameter: float, lines: Lines) -> Complex:
        """The motion that stands still."""
        return self.family.at(parameter)[0].standing(lines)

    def lines(self, passages: int) -> Lines:
        """Of a motion that repeats after so many passages."""
        return Lines.harmonics(self.harmonics * passages, self.per)

    def stability(self, balance: Balance, z: Complex, passages: int, fine: int = 1) -> Floquet:
        """Multipliers of a motion that repeats after so many passages."""
        base = abs(float(balance.bases.frequencies(balance.speed)[0]))
        lines = balance.lines
        count = max(SAMPLES * passages, PER_LINE * lines.count) * fine
        pressed = balance.press(z, lines=Lines(lines.index, lines.steps, count))
        m = len(balance.system.B)
        K = pooled([a.K for a in pressed.bearings], m)
        C = pooled([a.C for a in pressed.bearings], m)
        model = self.model(balance, pressed.softened, base)
        return floquet(model, balance.speed, 2 * np.pi / base, K, C)

    def model(self, balance: Balance, softened: Softened, base: float) -> FirstOrder:
        """The structure in first order, for stability; kept where no layer softens, else at its amplitude."""
        band = band_of(float(np.abs(balance.omega).max()))
        fastest = 2.0 ** (band / 2)
        hertz = (base / 60, fastest / 6)
        if softened.strain.size:
            return FirstOrder.of(frozen(balance.system, softened, hertz), fastest, hertz)
        key = (id(balance.system), band)
        if key not in self.models:
            if len(self.models) > MODELS:
                self.models.clear()
            self.models[key] = FirstOrder.of(balance.system, fastest, hertz)
        return self.models[key]


@kept_by_object
def _rows(system: System) -> dict[tuple[str, ...], Array]:
    """Branches' rows of motions (k, n), by the names of their channels: filled as they are asked for."""
    return {}


# balances of a curve that are kept: what they have answered is asked again
RECENT = 4
# first-order models that are kept
MODELS = 40
# samples of a passage for its stability, at least, and of a line: the demo's multipliers come out to 2e-5
SAMPLES, PER_LINE = 96, 4


@dataclass(frozen=True, eq=False)
class Mark:
    """Branches' marks: one point on one of them, its speed, motion and stability."""

    point: Point
    stability: Stability | None
    moved: Complex
    event: str = ""


@dataclass(frozen=True, eq=False)
class Branch:
    """One of the branches of steady motions: its points in order, passages after which motions repeat."""

    passages: int
    marks: tuple[Mark, ...]
    origin: str

    @property
    def span(self) -> tuple[float, float]:
        """Lowest and highest parameter."""
        values = [m.point.parameter for m in self.marks if m.event != "failed"]
        return min(values, default=math.nan), max(values, default=math.nan)

    def motions_alone(self) -> Branch:
        """The same as far as other searches ask, whether they have met it: what is sent to them."""
        none, unknown = np.zeros(0), Pressed.unknown()

        def alone(mark: Mark) -> Mark:
            point = replace(mark.point, pressed=unknown, tangent=none)
            return replace(mark, point=point, stability=None, moved=mark.moved[:0])

        return replace(self, marks=tuple(alone(m) for m in self.marks))


def curve_of(task: Task, lines: Lines, found: Found, passages: int) -> Curve:
    """The curve of a branch, in the measure of what moves: a motion's size, and a tenth of the range."""

    recent: dict[float, Balance] = {}

    def at(parameter: float) -> Balance:
        if parameter not in recent:
            while len(recent) >= RECENT:
                del recent[next(iter(recent))]
            recent[parameter] = divided(task.at(parameter, lines), passages)
        return recent[parameter]

    moving = float(np.linalg.norm(found.z[1:]))
    size = max(5.0 * moving, 0.1 * float(np.linalg.norm(found.z[0])))
    return Curve(at, scale=0.1 * (task.high - task.low), size=size, slope_step=task.slope_step)


class Tracer:
    """Traces branches, one at a time, and marks what happens on it."""

    def __init__(
        self,
        task: Task,
        passages: int,
        others: Sequence[Branch] = (),
        tell: Callable[[float], object] | None = None,
        span: tuple[float, float] | None = None,
    ) -> None:
        self.task, self.passages, self.others, self.tell = task, passages, others, tell
        self.low, self.high = span or (task.low, task.high)
        self.lines = task.lines(passages)

    def mark(self, curve: Curve, point: Point, event: str = "", fine: int = 1) -> Mark:
        """A point with its stability and what moves."""
        balance = curve.at(point.parameter)
        state = self.stability(balance, point.z, fine)
        moved = balance.moved(point.z, point.pressed.g)
        return Mark(replace(point, pressed=point.pressed.without_tangents()), state, moved, event)

    def stability(self, balance: Balance, z: Complex, fine: int = 1) -> Stability | None:
        """Multipliers, or None without bearings."""
        if not balance.system.bearings:
            return None
        return self.task.stability(balance, z, self.passages, fine).stability

    def trace(self, found: Found, parameter: float, direction: float, origin: str) -> Branch:
        """The branch through a motion, towards rising (+1) or falling parameter."""
        curve = curve_of(self.task, self.lines, found, self.passages)
        begin = curve.begin(found, parameter, direction)
        return Branch(self.passages, tuple(once(self._marks(curve, begin), self.task.tolerance)), origin)

    def _marks(self, curve: Curve, begin: Point) -> Iterator[Mark]:
        task = self.task
        prior: Mark | None = None
        last = self.mark(curve, begin)
        met, ended, over = 0, begin, False
        points, near_end = follow(curve, begin, self.low, self.high, task.longest, task.most), False
        while (point := next(points, None)) is not None:
            if self.passages > 1 and _mirrored(ended.z, point.z):
                # through the flip where the branch ends: what follows is the same, a passage later
                over = near_end
                if over:
                    break
                # folds hide in the last step, as the slope turns at the flip too
                near_end, rest = True, REST * curve.scale * distance(curve, ended, point)
                points = follow(curve, ended, self.low, self.high, rest, task.most)
                continue
            new = self._cut(curve, last, self.mark(curve, point))
            if _crosses(last, new):
                # of a few samples a multiplier may cross a point too late, or too early
                last, new = self._finer(curve, last), self._finer(curve, new)
                if prior is not None:
                    yield from self._events(curve, prior, last, folds=False)
            yield last
            between = None if prior is None else self._half_turn(curve, prior, last, new)
            if between is not None:
                yield from self._events(curve, last, between)
                yield between
                last = between
            yield from self._events(curve, last, new)
            if self.tell is not None:
                self.tell(new.point.parameter)
            prior, last, ended = last, new, point
            met = met + 1 if known(self.others, self.passages, point.parameter, point.z) else 0
            over = met > 1 or not self.low < point.parameter < self.high
            if over:
                break
        yield last
        if not over:
            yield Mark(ended, None, np.full_like(last.moved, np.nan), "failed")

    def _half_turn(self, curve: Curve, prior: Mark, last: Mark, new: Mark) -> Mark | None:
        """A mark where a pair of multipliers turned through −1 between two others."""
        states = [mark.stability for mark in (prior, last, new)]
        known = [state.multipliers for state in states if state is not None]
        share = half_turn(known, [m.point.parameter for m in (prior, last, new)]) if len(known) == 3 else None
        if share is None:
            return None
        point = curve.step(last.point, share * distance(curve, last.point, new.point))
        if point is None:
            return None
        mark = self.mark(curve, point)
        near = mark.stability is not None and _beyond(mark.stability, "flip") > -NEAR_FLIP
        return self._finer(curve, mark) if near else mark

    def _finer(self, curve: Curve, mark: Mark) -> Mark:
        """A mark with its multipliers as an event is located with."""
        return replace(mark, stability=self.stability(curve.at(mark.point.parameter), mark.point.z, FINER))

    def _cut(self, curve: Curve, last: Mark, new: Mark) -> Mark:
        """The point itself, or of one beyond the range the motion at its end."""
        p = new.point.parameter
        if self.low <= p <= self.high:
            return new
        end = self.low if p < self.low else self.high
        a, b = last.point, new.point
        share = (end - a.parameter) / (b.parameter - a.parameter)
        found = newton(curve.at(end), a.z + share * (b.z - a.z), tolerance=curve.tolerance)
        if not found.converged:
            return new
        point = replace(b, z=found.z, parameter=end, pressed=found.pressed, residual=found.residual)
        return self.mark(curve, point)

    def _events(self, curve: Curve, before: Mark, after: Mark, folds: bool = True) -> list[Mark]:
        found = []
        if folds and before.point.slope * after.point.slope < 0.0:
            found.append(self._at(curve, before, after, "fold", lambda p: p.slope))
        a, b = before.stability, after.stability
        if a is not None and b is not None:
            for name in CROSSINGS:
                if (_beyond(a, name) > 0.0) != (_beyond(b, name) > 0.0):

                    def test(p: Point, name: str = name) -> float:
                        state = self.stability(curve.at(p.parameter), p.z, FINER)
                        return 0.0 if state is None else _beyond(state, name)

                    found.append(self._at(curve, before, after, name, test))
        ahead = 1.0 if after.point.parameter >= before.point.parameter else -1.0
        # a pair that meets on the real axis changes its name without a crossing
        real = [f for f in found if f is not None and (f.event == "fold" or _crossing(f) <= ON_CIRCLE)]
        return sorted(real, key=lambda f: ahead * f.point.parameter)

    def _at(
        self, curve: Curve, before: Mark, after: Mark, name: str, test: Callable[[Point], float]
    ) -> Mark | None:
        point = locate(curve, before.point, after.point, test, self.task.tolerance)
        return None if point is None else self.mark(curve, point, name, FINER)

    def doubled(self, flip: Mark) -> Branch | None:
        """The branch of twice the period that begins at a flip, or None where it is not found."""
        task, twice = self.task, 2 * self.passages
        tracer = Tracer(task, twice, self.others, self.tell)
        curve = curve_of(task, self.lines, found_at(flip.point), self.passages)
        balance = curve.at(flip.point.parameter)
        direction = task.stability(balance, flip.point.z, self.passages, FINER).antiperiodic(tracer.lines)
        if direction is None:
            return None
        # of layers that soften it is left to the corrector
        direction = np.pad(direction, ((0, 0), (0, flip.point.z.shape[1] - direction.shape[1])))
        z = self.lines.moved(flip.point.z, tracer.lines, 2)
        size = BEGIN * float(np.linalg.norm(flip.point.z[1:])) / max(float(np.linalg.norm(direction)), 1e-300)
        grown = curve_of(task, tracer.lines, replace(found_at(flip.point), z=z), twice)
        border = flat(direction / grown.size)
        border /= np.linalg.norm(border)
        # near the flip the derivative is nearly singular: the tangent needs the point's own
        point = grown.correct(z + size * direction, flip.point.parameter, (border, 0.0), exact=True)
        if point is None:
            return None
        if float(point.tangent @ border) < 0.0:  # away from the flip
            point = replace(point, tangent=-point.tangent, slope=-point.slope)
        marks = tuple(once(tracer._marks(grown, point), task.tolerance))
        # at the flips where it begins and ends its slope is none, and round-off may turn it
        ends = [m.point.parameter for m in (marks[0], marks[-1])]
        real = [m for m in marks if m.event != "fold" or not _near(m.point.parameter, ends, task.tolerance)]
        return Branch(twice, tuple(real), f"flip at {flip.point.parameter:.6g}")


def divided(balance: Balance, passages: int) -> Balance:
    """Branches of doubled period: the balance of what repeats after so many passages only."""
    if passages == 1:
        return balance
    bases = balance.bases
    base = bases.bases[0]
    repeated = Bases(
        (replace(base, ratio=base.ratio / passages, omega=base.omega / passages),),
        tuple(replace(t, multiple=tuple(passages * k for k in t.multiple)) for t in bases.bearings),
    )
    return replace(balance, bases=repeated)


def found_at(point: Point) -> Found:
    return Found(point.z, point.pressed, point.residual, 0, point.iterations, True)


def _near(parameter: float, places: Sequence[float], tolerance: float) -> bool:
    return any(abs(parameter - place) <= tolerance for place in places)


def _crossing(mark: Mark) -> float:
    """How far from the unit circle the multiplier of an event lies."""
    return math.inf if mark.stability is None else abs(_beyond(mark.stability, mark.event))


def _mirrored(before: Complex, after: Complex) -> bool:
    """Whether the lines of half the frequency have gone through zero."""
    return float(np.real(np.vdot(before[1::2], after[1::2]))) < 0.0


def _crosses(before: Mark, after: Mark) -> bool:
    """Whether a multiplier crosses the circle between two marks, as far as their own samples tell."""
    a, b = before.stability, after.stability
    if a is None or b is None:
        return False
    return any((_beyond(a, name) > 0.0) != (_beyond(b, name) > 0.0) for name in CROSSINGS)


def _beyond(state: Stability, name: str) -> float:
    """Size less one of the largest multiplier that would bring this; −1 where there is none."""
    return max((abs(m) - 1.0 for m in state.multipliers if kind(complex(m)) == name), default=-1.0)


def known(branches: Sequence[Branch], passages: int, parameter: float, z: Complex) -> bool:
    """Whether one of the branches already has a motion, between two of its points, or some passages later."""
    size = float(np.linalg.norm(z[1:])) + 1e-4 * float(np.linalg.norm(z[0]))
    turn = np.exp(2j * np.pi / passages * np.arange(len(z)))[:, None]
    shifted = [z * turn**later for later in range(passages)]
    for branch in branches:
        if branch.passages != passages:
            continue
        points = [m.point for m in branch.marks if m.event != "failed"]
        for a, b in pairwise(points):
            if (a.parameter - parameter) * (b.parameter - parameter) > 0.0 or a.parameter == b.parameter:
                continue
            share = (parameter - a.parameter) / (b.parameter - a.parameter)
            near = a.z + share * (b.z - a.z)
            gap = float(np.linalg.norm(b.z - a.z))
            if any(float(np.linalg.norm(near - s)) <= DIFFERENT * size + 0.2 * gap for s in shifted):
                return True
    return False
