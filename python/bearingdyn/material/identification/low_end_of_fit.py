"""What the points of a fit say of the modulus at long times: plateau, and an interval for G0."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from bearingdyn.material.identification.points_in_band import Points
from bearingdyn.material.low_end import FALL, LowEnd
from bearingdyn.material.relaxation_spectrum import solve_strengths
from bearingdyn.types import Array

_ADMISSIBLE = 1.2  # times the best rms deviation, as n="auto" takes it
_PER_DECADE = 6  # times of the spectra tried: twice as many move the interval by a tenth of its width
_HALVINGS = 10  # of the search for an end of the interval


def low_end(points: Points, G0: float, deviation: Array, measured: float) -> LowEnd:
    """Low end of a fit from its points: G0, Pa, deviation of ln G′ (p,), the lowest frequency, Hz."""
    scatter = float(np.sqrt(np.mean(deviation**2)))
    lowest = float(points.omega.min())
    near = points.omega <= 10 * lowest
    x, y = np.log(points.omega[near] / lowest), np.log(points.storage[near])
    slope, error, level = math.nan, math.nan, float(y[np.argmin(x)])
    if x.size >= 3 and np.ptp(x) > 0:
        A = np.column_stack([np.ones_like(x), x])
        (level, slope), *_ = np.linalg.lstsq(A, y, rcond=None)
        left = y - A @ [level, slope]
        error = math.sqrt(float(left @ left) / (x.size - 2) / float(((x - x.mean()) ** 2).sum()))
    if x.size >= 5:  # a chord would lie below the end of a curve that flattens
        level = float(np.polyfit(x, y, 2)[-1])
    tan_delta = float(np.mean(points.loss[near] / points.storage[near]))
    high = math.exp(level + 2 * scatter)
    end = LowEnd(
        lowest / (2 * math.pi),
        measured,
        math.exp(level),
        float(slope),
        error,
        tan_delta,
        scatter,
        False,
        (0.0, max(high, G0)),
        points.pin,
    )
    if not end.fall < FALL:  # NaN is no plateau
        return end
    low, high = _admissible(points)
    values = {**vars(end), "plateau": True, "interval": (min(low, G0), max(high, G0))}
    return LowEnd(**values)


def _admissible(points: Points) -> tuple[float, float]:
    """Lowest and highest G0, Pa, at which a dense spectrum is within _ADMISSIBLE of the best."""
    _, A, target = points.dense_problem(_PER_DECADE)
    best = solve_strengths(A, target)
    limit = (_ADMISSIBLE * float(np.linalg.norm(best.residual))) ** 2
    G0, top = float(best.x[0]), 2 * float(points.storage.min())

    def allowed(value: float) -> bool:
        left = solve_strengths(A[:, 1:], target - A[:, 0] * value).residual
        return float(left @ left) <= limit

    return _edge(allowed, G0, 0.0), _edge(allowed, G0, top)


def _edge(allowed: Callable[[float], bool], inside: float, outside: float) -> float:
    """The end of the interval between a value inside and one outside; it is convex."""
    if allowed(outside):
        return outside
    for _ in range(_HALVINGS):
        middle = (inside + outside) / 2
        inside, outside = (middle, outside) if allowed(middle) else (inside, middle)
    return outside
