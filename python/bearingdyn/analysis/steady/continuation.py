"""Following a steady motion through a parameter by the length of its arc, round folds.

Predictor along the tangent, corrector on the plane across it (E. L. Allgower and K. Georg, Introduction to
Numerical Continuation Methods, SIAM 2003, chapters 2 and 4); what happens on the way is located on the arc.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from contextlib import suppress
from dataclasses import dataclass, replace
from typing import Protocol

import numpy as np
import scipy

from bearingdyn.analysis.steady.balance import Balance, Found, Linearised, Pressed, flat, measure
from bearingdyn.analysis.steady.factored import Factored, few, jacobian
from bearingdyn.analysis.steady.krylov import gmres
from bearingdyn.types import Array, Complex

# of the parameter, relative, over which the residual's slope is taken: half the digits
SLOPE = 1e-6
# corrections of a point, and how many are wanted: more shorten the next step, fewer lengthen it
CORRECTIONS, WANTED = 16, 9
# largest turn of the tangent in a step, rad: beyond it the step is taken anew at half the length
LARGEST_TURN = 0.7
# of a motion, or of the size of the first, by which a step may change it where the parameter hardly moves
LONGEST_MOVE = 0.2
# of a step, by which the corrector may move its point: beyond it another branch was met
LARGEST_CORRECTION = 0.3
# turns below which the next step may be longer, and above which it is shorter
EASY_TURN, HARD_TURN = 0.25, 0.45
# of the speed, within which receptances go straight on from one to the next correction
NEAR = 1e-4
# of the residual that a correction with an earlier derivative may leave, before the derivative is made anew
SLOW = 0.3
# where the tangent's rise keeps this share of itself over a step, and is above the level, the parameter is
# held while a point is corrected: its receptances are then asked once
STEADY, LEVEL = 0.5, 0.02
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

    def solver(
        self,
        balance: Balance,
        pressed: Pressed,
        column: Complex,
        border: tuple[Array, float],
        single: bool = True,
    ) -> Solver:
        """What solves J dz + F_p dp = right, border · (dz, dp) = across, in the curve's measure.

        With `single`, in single precision.
        """
        if few(column):
            return Triangles.of(self, balance, pressed, column, border, single)
        linear = balance.linearised(pressed)
        return Products(self, linear, linear.prepared(column) * self.scale, border)

    def column(self, z: Complex, parameter: float, residual: Complex) -> Complex:
        """dF/dp (L, m)."""
        other = self.beyond(parameter)
        step = self.slope_step * max(abs(parameter), self.scale)
        return (other.residual(z, other.press(z, tangents=False)) - residual) / step

    def beyond(self, parameter: float) -> Balance:
        """The balance a little beyond a parameter, for slopes."""
        return self.at(parameter + self.slope_step * max(abs(parameter), self.scale))

    def begin(self, found: Found, parameter: float, direction: float) -> Point:
        """A converged motion as the first point, its tangent along rising (+1) or falling parameter."""
        point = Point(
            found.z, parameter, found.pressed, found.residual, found.iterations, np.zeros(0), direction
        )
        return self.with_tangent(point, np.zeros(2 * found.z.size), direction)

    def with_tangent(self, point: Point, border: Array, slope: float, solver: Solver | None = None) -> Point:
        """The point with its own tangent, along the border given; the solver may be a neighbour's."""
        if solver is None:
            balance = self.at(point.parameter)
            r = balance.residual(point.z, point.pressed)
            column = self.column(point.z, point.parameter, r)
            pressed = point.pressed if point.pressed.has_tangents else balance.press(point.z)
            solver = self.solver(balance, pressed, column, (border, slope), single=False)
        dz, dp = solver.solve(None, 1.0, 1e-8)
        length = math.sqrt(float(dz @ dz) + dp * dp)
        return replace(point, tangent=dz / length, slope=dp / length)

    def step(
        self, point: Point, length: float, exact: bool = False, bend: Array | None = None
    ) -> Point | None:
        """The point at a length of arc further on, or None where the corrector fails.

        With `exact`, its tangent is made from the slope at the point itself, not at a neighbour of the last
        correction; `bend` is how the tangent turns with the arc, its parameter's part last.
        """
        along, rise = point.tangent, point.slope
        if bend is not None:
            along, rise = along + 0.5 * length * bend[:-1], rise + 0.5 * length * float(bend[-1])
        z = point.z + self.size * length * unflat_like(along, point.z)
        p = point.parameter + self.scale * length * rise
        border = point.tangent, point.slope
        if not exact and bend is not None and straight(point.slope, point.slope + length * float(bend[-1])):
            border = (np.zeros_like(point.tangent), math.copysign(1.0, point.slope))
        new = self.correct(z, p, border, exact)
        if new is None or exact or self.apart(new, z, p) <= LARGEST_CORRECTION * abs(length):
            return new
        return None

    def apart(self, point: Point, z: Complex, p: float) -> float:
        """How far a point lies from a motion at a parameter, in the curve's measure."""
        away = float(np.linalg.norm(point.z - z))
        # without bearings there is no motion to measure
        return math.hypot(away / self.size if away else 0.0, (point.parameter - p) / self.scale)

    def correct(self, z: Complex, p: float, border: tuple[Array, float], exact: bool = False) -> Point | None:
        """Onto the curve, across the border from (z, p)."""
        solver: Solver | None = None
        column: Complex | None = None
        anchor = balance = self.at(p)
        pair = anchor, anchor
        made = 0
        last = math.inf
        for iteration in range(CORRECTIONS):
            lasting = solver is not None and solver.lasting
            pressed = balance.press(z, tangents=not lasting)
            r = balance.residual(z, pressed)
            size, _ = measure(r, z)
            if size <= self.tolerance and balance is not anchor:
                anchor = balance = self.at(p)
                r = balance.residual(z, pressed)
                size, _ = measure(r, z)
                last = math.inf
            if not math.isfinite(size) or (iteration > 2 and size > 4.0 * last):
                return None
            if size <= self.tolerance:
                point = Point(z, p, pressed, size, iteration, *border)
                return self.with_tangent(point, *border, None if exact else solver)
            if solver is None or not solver.lasting or size > SLOW * last:
                if lasting:
                    pressed = balance.press(z)
                anchor = balance = self.at(p)
                if column is None or iteration - made >= 3:
                    r = balance.residual(z, pressed)
                    column, made = self.column(z, p, r), iteration
                    pair = balance, self.beyond(p)
                solver = self.solver(balance, pressed, column, border)
            forcing = min(1e-2, max(0.03 * size, 0.1 * self.tolerance / size))
            dz, dp = solver.solve(-r, 0.0, forcing)
            z = z + self.size * unflat_like(dz, z)
            p = p + self.scale * dp
            balance = self.beside(anchor, pair, p)
            last = size
        return None

    def beside(self, anchor: Balance, pair: tuple[Balance, Balance], p: float) -> Balance:
        """The balance at a parameter: near an anchor straight on from it, by the slope between two others."""
        a, b = pair
        if a.speed == b.speed or not abs(p - anchor.speed) <= NEAR * abs(p):
            return self.at(p)
        return anchor.towards(p, a, b)

    def turn(self, a: Point, b: Point) -> float:
        """Angle between the tangents of two points, rad."""
        cosine = float(a.tangent @ b.tangent) + a.slope * b.slope
        return math.acos(min(1.0, max(-1.0, cosine)))


def straight(before: float, after: float) -> bool:
    """Whether no fold is near a step of a continuation, by how its tangents rise in the parameter."""
    return before * after > 0.0 and min(abs(before), abs(after)) > max(STEADY * abs(before), LEVEL)


def backwards(before: Point, after: Point) -> bool:
    """Whether a continuation's parameter went against both tangents: the step leapt over folds, or off."""
    moved = after.parameter - before.parameter
    return moved * before.slope < 0.0 and moved * after.slope < 0.0


class Solver(Protocol):
    """Solver of a continuation: for a correction (dz flat, dp) in a curve's measure."""

    @property
    def lasting(self) -> bool:
        """Whether it is worth keeping for the next correction."""

    def solve(self, right: Complex | None, across: float, tolerance: float) -> tuple[Array, float]:
        """Of a residual (L, m), none for zero, and a step across the border."""


@dataclass(frozen=True, eq=False)
class Products:
    """Continuation, its solver for many lines: by products with the derivative."""

    curve: Curve
    linear: Linearised
    column: Array
    border: tuple[Array, float]
    lasting: bool = False

    def solve(self, right: Complex | None, across: float, tolerance: float) -> tuple[Array, float]:
        """To a tolerance, relative."""
        size, (tz, tp) = self.curve.size, self.border

        def product(v: Array) -> Array:
            out = np.empty_like(v)
            out[:-1] = (self.linear.product(v[:-1] * size) + v[-1] * self.column) / size
            out[-1] = tz @ v[:-1] + tp * v[-1]
            return out

        rhs = np.zeros(len(self.column) + 1)
        if right is not None:
            rhs[:-1] = self.linear.prepared(right) / size
        rhs[-1] = across
        x, _ = gmres(product, rhs, tolerance)
        return x[:-1], float(x[-1])


@dataclass(frozen=True, eq=False)
class Triangles:
    """Continuation, its solver for few lines: the derivative with its border in triangles.

    Single precision is enough for corrections, whose residuals have all digits; tangents by which events are
    located need more.
    """

    curve: Curve
    factored: Factored
    lasting: bool = True

    @classmethod
    def of(
        cls,
        curve: Curve,
        balance: Balance,
        pressed: Pressed,
        column: Complex,
        border: tuple[Array, float],
        single: bool,
    ) -> Triangles:
        """At a motion."""
        n = 2 * column.size
        J = jacobian(balance, pressed, single=single)
        A = np.empty((n + 1, n + 1), dtype=J.dtype)
        A[:n, :n] = J
        A[:n, n] = flat(column) * (curve.scale / curve.size)
        A[n, :n], A[n, n] = border
        return cls(curve, Factored.of(A))

    def solve(self, right: Complex | None, across: float, tolerance: float) -> tuple[Array, float]:
        """To round-off of the triangles."""
        rhs = np.zeros(len(self.factored.pivots))
        if right is not None:
            rhs[:-1] = flat(right) / self.curve.size
        rhs[-1] = across
        x = self.factored.solve(rhs)
        return x[:-1], float(x[-1])


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
    bend: Array | None = None
    for _ in range(most):
        own = False
        while True:
            turning = 0.0 if bend is None else length * float(np.linalg.norm(bend))
            new = curve.step(point, length, bend=bend if turning <= HARD_TURN else None)
            if new is not None and curve.turn(point, new) <= LARGEST_TURN and not backwards(point, new):
                break
            if not own:
                # a tangent by a neighbour's slope may point past the curve, and no shorter step mends that
                point, bend, own = curve.with_tangent(point, point.tangent, point.slope), None, True
            length *= 0.5
            if length < SHORTEST * biggest:
                return
        yield new
        if not low <= new.parameter <= high:
            return
        turned = curve.turn(point, new)
        bend = np.append(new.tangent - point.tangent, new.slope - point.slope) / length
        point = new
        wish = 1.5 if new.iterations < WANTED and turned < EASY_TURN else 1.0
        if new.iterations > WANTED + 2 or turned > HARD_TURN:
            wish = 0.6
        moving = float(np.linalg.norm(point.z[1:]))
        # without bearings nothing moves, and size is 0
        share = max(1.0, moving / curve.size) if moving else 1.0
        most_moved = min(LONGEST_MOVE * share, biggest / max(abs(point.slope), 1e-12))
        length = min(max(biggest, most_moved), wish * length)


def locate(
    curve: Curve,
    before: Point,
    after: Point,
    test: Callable[[Point], float],
    tolerance: float,
    most: int = 60,
) -> Point | None:
    """The point of a continuation between two where a test is zero, on the arc; None where it has one sign.

    Between brackets (R. P. Brent, Algorithms for Minimization without Derivatives, 1973, chapter 4): a
    multiplier is none before it meets another on the real axis, so that a test may leap, and secants rest.
    """
    end = distance(curve, before, after)
    known = {0.0: test(before), end: test(after)}
    if not known[0.0] * known[end] < 0.0:
        return None
    tried = {end: after}

    def at(s: float) -> float:
        if s not in known:
            point = curve.step(before, s, True)
            if point is None:
                raise ArithmeticError
            tried[s], known[s] = point, test(point)
        return known[s]

    steepest = curve.scale * max(abs(before.slope), abs(after.slope), SHORTEST)
    # where the corrector fails the best so far is given
    with suppress(ArithmeticError):
        scipy.optimize.brentq(at, 0.0, end, xtol=tolerance / steepest, maxiter=most, disp=False)
    return tried[min(tried, key=lambda s: abs(known[s]))]


def distance(curve: Curve, a: Point, b: Point) -> float:
    """How far along the tangent of a continuation's point another lies."""
    dz = flat((b.z - a.z) / curve.size)
    return float(a.tangent @ dz) + a.slope * (b.parameter - a.parameter) / curve.scale
