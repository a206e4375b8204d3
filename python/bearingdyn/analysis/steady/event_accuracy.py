"""Events of a branch of steady motions: each kept once, and how closely each is located."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence
from typing import Protocol, TypeVar

import numpy as np

# of the parameter: folds nearer to one another, one behind the other on a branch, are one tip and its kinks.
# Contacts open and close between samples of a passage; where a branch is nearly flat in the parameter, that
# makes many folds of one, whose number and places change with the samples and the steps.
TIP = 1e-3
# of a motion's size: what an event may be off and be the same
SAME = 1e-3


class _Placed(Protocol):
    @property
    def parameter(self) -> float: ...
    @property
    def z(self) -> np.ndarray: ...


class _Marked(Protocol):
    @property
    def point(self) -> _Placed: ...
    @property
    def event(self) -> str: ...


# size of multipliers of what rings on: what dies away sooner loses no stability in a narrow range
RINGS = 0.9
# sizes of a pair on either side of −1 differ less, and its phase is where the last turn leads, within rad
ALIKE, TURNED = 0.01, 0.1

_Mark = TypeVar("_Mark", bound=_Marked)


def once(marks: Iterable[_Mark], tolerance: float) -> Iterator[_Mark]:
    """Events by accuracy, each once: without repeats of the last one, found before a point and behind it.

    Parameters
    ----------
    marks
        In order along the branch.
    tolerance
        Of the location, in the parameter.
    """
    last: _Mark | None = None
    for mark in marks:
        if mark.event and last is not None and mark.event == last.event:
            near = abs(mark.point.parameter - last.point.parameter) <= 2 * tolerance
            apart = float(np.linalg.norm(mark.point.z - last.point.z))
            if near and apart <= SAME * float(np.linalg.norm(last.point.z[1:])):
                continue
        last = mark if mark.event else last
        yield mark


def within(events: Sequence[str], parameters: Sequence[float], tolerance: float) -> list[float]:
    """How closely each event of a branch is located, in the parameter; NaN where there is none.

    Parameters
    ----------
    events, parameters
        Of the points of a branch, in order.
    tolerance
        Of an event by itself.

    Returns
    -------
    list of float
        `tolerance`; of folds that follow one another within `TIP` of the parameter, what they span together.
    """
    found = [tolerance if event not in ("", "failed") else math.nan for event in events]
    folds = [k for k, event in enumerate(events) if event == "fold"]
    tip: list[int] = []
    for k in folds:
        if tip and abs(parameters[k] - parameters[tip[-1]]) > TIP * abs(parameters[k]):
            tip = []
        tip.append(k)
        places = [parameters[i] for i in tip]
        for i in tip:
            found[i] = max(tolerance, max(places) - min(places))
    return found


def half_turn(multipliers: Sequence[Iterable[complex]], places: Sequence[float]) -> float | None:
    """Of three points, for events' accuracy: where a pair of multipliers turns through −1 behind the second.

    A mode that rings half as often as its balls pass may lose its stability there, in a range of the
    parameter narrower than a step, and have it again at the next point: a pair on either side, which met at
    −1 between them.

    Parameters
    ----------
    multipliers
        Of the three points.
    places
        Their places along the branch, in order.

    Returns
    -------
    float or None
        The share of the way from the second to the third; None where no pair does.
    """
    before, last, new = ([m for m in each if m.imag > 0.0 and abs(m) > RINGS] for each in multipliers)
    way = places[2] - places[1]
    for m in last:
        first = min(before, key=lambda other: abs(other - m), default=None)
        if first is None or places[1] == places[0]:
            continue
        left, was = np.pi - np.angle(m), np.pi - np.angle(first)
        expected = left + (left - was) / (places[1] - places[0]) * way
        for end in new:
            past = np.pi - np.angle(end)
            turned = abs(expected + past) < abs(expected - past) and abs(expected + past) < TURNED
            if turned and abs(abs(end) - abs(m)) < ALIKE:
                return float(left / (left + past))
    return None
