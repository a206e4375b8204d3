"""Reaching a motion that does not come at once: from a speed where it does, along the branch."""

from __future__ import annotations

import numpy as np

from bearingdyn.analysis.steady.balance import Balance, Found, newton
from bearingdyn.analysis.steady.continuation import Curve, Point, follow
from bearingdyn.analysis.steady.problem import Problem
from bearingdyn.analysis.steady.torus import Lines

# shares of the speed from which a branch is followed, in turn
ELSEWHERE = (1.15, 0.87, 1.4, 1.8, 0.7, 2.5)
# points of a branch on the way
STEPS = 60


def reached(problem: Problem, lines: Lines, speed: float, tolerance: float) -> Found | None:
    """Reach the steady motion at a speed by way of other speeds; None where no branch leads there."""

    def at(own: float) -> Balance:
        return problem.balance(lines, own)

    for share in ELSEWHERE:
        found = newton(at(share * speed), problem.standing(lines), tolerance=tolerance)
        if not found.converged:
            continue
        curve = curve_of(at, found, abs(speed))
        point: Point = curve.begin(found, share * speed, 1.0 if share < 1.0 else -1.0)
        low, high = sorted((speed, 3.0 * speed if share > 1.0 else 0.3 * speed))
        for new in follow(curve, point, low, high, 0.05 * abs(speed), STEPS):
            if (new.parameter - speed) * (point.parameter - speed) <= 0.0:
                share_of = (speed - point.parameter) / (new.parameter - point.parameter)
                last = newton(at(speed), point.z + share_of * (new.z - point.z), tolerance=tolerance)
                if last.converged:
                    return last
            point = new
    return None


def curve_of(at: object, found: Found, scale: float) -> Curve:
    """The curve by which a steady motion is reached, in its own measure of a motion's size."""
    moving = float(np.linalg.norm(found.z[1:]))
    size = max(5.0 * moving, 0.05 * float(np.linalg.norm(found.z[0])))
    return Curve(at, scale=0.2 * scale, size=size)  # type: ignore[arg-type]
