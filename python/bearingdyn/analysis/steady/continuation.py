"""Following a steady motion through a parameter by the length of its arc, round folds.

Predictor along the tangent, corrector on the plane across it (E. L. Allgower and K. Georg, Introduction to
Numerical Continuation Methods, SIAM 2003, chapters 2 and 4); what happens on the way is located by secants on
the arc.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace

import numpy as np

from bearingdyn.analysis.steady.balance import Balance, Found, Pressed, flat, measure
from bearingdyn.analysis.steady.krylov import gmres
from bearingdyn.types import Array, Complex

# of the parameter, relative, over which the residual's slope is taken: half the digits
SLOPE = 1e-6
# corrections of a point, and how many are wanted: more shorten the next step, fewer lengthen it
CORRECTIONS, WANTED = 10, 4
# largest turn of the tangent in a step, rad: beyond it the step is taken anew at half the length
LARGEST_TURN = 0.5
# steps shorter than this share of the longest end a branch
SHORTEST = 1e-6


@dataclass(frozen=True, eq=False)
class Point:
    """A point of a continuation: a converged motion z (L, m) at a parameter, and the tangent there."""

    z: Complex
    parameter: float
    pressed: Pressed
    residual: float
    iterations: int
    tangent: Array
    slope: float


@dataclass(frozen=True, eq=False)
class Curve:
    """The curve that a continuation follows.

    Parameters
    ----------
    at
        The balance at a value of the parameter.
    scale
        Change of the parameter that counts as much as a change of the motion by its own size.
    size
        Size of a motion, m (the norm of its amplitudes).
    tolerance
        Of the residual.
    slope_step
        Of the parameter, relative, over which the residual's slope is taken.
    """

    at: Callable[[float], Balance]
    scale: float
    size: float
    tolerance: float = 1e-10
    slope_step: float = SLOPE

    def solve(
        self,
        balance: Balance,
        pressed: Pressed,
        column: Complex,
        border: tuple[Array, float],
        right: Complex | None,
        across: float,
        tolerance: float,
    ) -> tuple[Array, float]:
        """(dz flat, dp) with J dz + F_p dp = right, and border · (dz, dp) = across, in its measure."""
        linear = balance.linearised(pressed)
        q = linear.prepared(column) * self.scale
        tz, tp = border

        def product(v: Array) -> Array:
            out = np.empty_like(v)
            out[:-1] = (linear.product(v[:-1] * self.size) + v[-1] * q) / self.size
            out[-1] = tz @ v[:-1] + tp * v[-1]
            return out

        rhs = np.zeros(len(q) + 1)
        if right is not None:
            rhs[:-1] = linear.prepared(right) / self.size
        rhs[-1] = across
        x, _ = gmres(product, rhs, tolerance)
        return x[:-1], float(x[-1])

    def column(self, z: Complex, parameter: float, residual: Complex) -> Complex:
        """dF/dp (L, m)."""
        step = self.slope_step * max(abs(parameter), self.scale)
        other = self.at(parameter + step)
        return (other.residual(z, other.press(z, tangents=False)) - residual) / step

    def begin(self, found: Found, parameter: float, direction: float) -> Point:
        """A converged motion as the first point, its tangent along rising (+1) or falling parameter."""
        point = Point(
            found.z, parameter, found.pressed, found.residual, found.iterations, np.zeros(0), direction
        )
        return self.with_tangent(point, np.zeros(2 * found.z.size), direction)

    def with_tangent(self, point: Point, border: Array, slope: float, column: Complex | None = None) -> Point:
        """The point with its own tangent, along the border given; the column dF/dp may be a neighbour's."""
        balance = self.at(point.parameter)
        if column is None:
            r = balance.residual(point.z, point.pressed)
            column = self.column(point.z, point.parameter, r)
        dz, dp = self.solve(balance, point.pressed, column, (border, slope), None, 1.0, 1e-8)
        length = math.sqrt(float(dz @ dz) + dp * dp)
        return replace(point, tangent=dz / length, slope=dp / length)

    def step(self, point: Point, length: float, exact: bool = False) -> Point | None:
        """The point at a length of arc further on, or None where the corrector fails.

        With `exact`, its tangent is made from the slope at the point itself, not at a neighbour of the last
        correction.
        """
        z = point.z + self.size * length * unflat_like(point.tangent, point.z)
        p = point.parameter + self.scale * length * point.slope
        return self.correct(z, p, (point.tangent, point.slope), exact)

    def correct(self, z: Complex, p: float, border: tuple[Array, float], exact: bool = False) -> Point | None:
        """Onto the curve, across the border from (z, p)."""
        column: Complex | None = None
        last = math.inf
        for iteration in range(CORRECTIONS):
            balance = self.at(p)
            pressed = balance.press(z)
            r = balance.residual(z, pressed)
            size, _ = measure(r, z)
            if not math.isfinite(size) or (iteration > 2 and size > 4.0 * last):
                return None
            if size <= self.tolerance:
                point = Point(z, p, pressed, size, iteration, *border)
                return self.with_tangent(point, *border, None if exact else column)
            if column is None or iteration % 3 == 0:
                column = self.column(z, p, r)
            forcing = min(1e-2, max(0.03 * size, 0.1 * self.tolerance / size))
            dz, dp = self.solve(balance, pressed, column, border, -r, 0.0, forcing)
            z = z + self.size * unflat_like(dz, z)
            p = p + self.scale * dp
            last = size
        return None

    def turn(self, a: Point, b: Point) -> float:
        """Angle between the tangents of two points, rad."""
        cosine = float(a.tangent @ b.tangent) + a.slope * b.slope
        return math.acos(min(1.0, max(-1.0, cosine)))


def unflat_like(vector: Array, z: Complex) -> Complex:
    """Real numbers of a continuation as amplitudes of the shape of z."""
    return np.ascontiguousarray(vector).view(np.complex128).reshape(z.shape)


def follow(curve: Curve, start: Point, low: float, high: float, longest: float, most: int) -> Iterator[Point]:
    """Continuation by arc length: points from one of its own until the curve leaves low … high, or ends.

    Parameters
    ----------
    curve, start
        The curve and a point on it, whose tangent says which way.
    low, high
        Of the parameter.
    longest
        Step of the parameter where the motion hardly changes.
    most
        Points.
    """
    length = biggest = longest / curve.scale
    point = start
    for _ in range(most):
        while True:
            new = curve.step(point, length)
            if new is not None and curve.turn(point, new) <= LARGEST_TURN:
                break
            length *= 0.5
            if length < SHORTEST * biggest:
                return
        yield new
        if not low <= new.parameter <= high:
            return
        turned = curve.turn(point, new)
        point = new
        wish = 1.5 if new.iterations < WANTED and turned < 0.3 * LARGEST_TURN else 1.0
        if new.iterations > WANTED + 1 or turned > 0.6 * LARGEST_TURN:
            wish = 0.6
        length = min(biggest, wish * length)


def locate(
    curve: Curve,
    before: Point,
    after: Point,
    test: Callable[[Point], float],
    tolerance: float,
    most: int = 30,
) -> Point | None:
    """The point of a continuation between two where a test is zero, by secants on the arc (Illinois)."""
    a, b = 0.0, _distance(curve, before, after)
    fa, fb = test(before), test(after)
    if not fa * fb < 0.0:
        return None
    best, side = after, 0
    for _ in range(most):
        s = (a * fb - b * fa) / (fb - fa)
        new = curve.step(before, s, True)
        if new is None:
            s = 0.5 * (a + b)
            new = curve.step(before, s, True)
            if new is None:
                return best
        f = test(new)
        moved = abs(new.parameter - best.parameter)
        best = new
        if abs(f) == 0.0 or (moved <= tolerance and abs(b - a) < 1e6):
            if moved <= tolerance:
                break
        if f * fb < 0.0:
            a, fa = b, fb
            b, fb = s, f
            side = 0
        else:
            b, fb = s, f
            fa *= 0.5 if side else 1.0
            side = 1
    return best


def _distance(curve: Curve, a: Point, b: Point) -> float:
    """How far along the tangent of a point another lies."""
    dz = flat((b.z - a.z) / curve.size)
    return float(a.tangent @ dz) + a.slope * (b.parameter - a.parameter) / curve.scale
