"""The best design within limits, found by its gradients, and what each limit costs."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import combinations
from typing import Any, TypeAlias

import numpy as np
import scipy.optimize

from bearingdyn.checks import meant, name_list, named, number, positive, require, whole
from bearingdyn.notice import UnprovenOptimum, warn
from bearingdyn.pictures import page
from bearingdyn.short_repr import short
from bearingdyn.study.cases import sobol
from bearingdyn.types import Array

Slopes: TypeAlias = Mapping[str, float]
Design: TypeAlias = Callable[[dict[str, float]], Mapping[str, Any]]

# of the range of a parameter: at its end
ACTIVE = 1e-6
# of a scaled limit: kept
KEPT = 1e-6
# of a limit: reached
NEAR = 1e-4
# of the steepest slope: left at an end that is no optimum; SLSQP's own tolerance of 1e-6 leaves 1e-3
UNPROVEN = 0.05
DIFFERENCE = 1e-6


@dataclass(frozen=True, eq=False)
class Optimum:
    """An optimum: the best design that was found, and how it is known to be one.

    Attributes
    ----------
    parameters
        The design, by name.
    values
        What the function returns of it.
    objective
        Name of what was minimised or maximised, and its value.
    prices
        Of each active limit: the change of the objective per unit by which the limit rises, as dB per m.
    at_range
        Of each parameter at an end of its range: the change of the objective per unit by which the end moves.
    kkt
        Residual of the Karush-Kuhn-Tucker conditions: what is left of the scaled objective's gradient after
        the active limits, over the steepest gradient on the way; 0 where nothing can be gained.
    evaluations
        Calls of the function, with or without derivatives, from all starts together.
    ends
        Objective at the end of each start that kept the limits, NaN of one that did not.
    failed
        What kept a start from its end: a design without a number, or that cannot be built.
    """

    parameters: Mapping[str, float]
    values: Mapping[str, float]
    objective: tuple[str, float]
    prices: Mapping[str, float]
    at_range: Mapping[str, float]
    kkt: float
    evaluations: int
    ends: tuple[float, ...]
    failed: tuple[str, ...] = ()

    __repr__ = short
    _repr_html_ = page

    @property
    def text(self) -> str:
        """The optimum in words, a line each."""
        name, value = self.objective
        lines = [f"{name} {value:.6g}, after {self.evaluations} designs from {len(self.ends)} starts"]
        lines += [f"  {k} = {v:.6g}" for k, v in self.parameters.items()]
        lines += [f"  limit on {k}: reached, at {v:+.4g} of {name} per unit" for k, v in self.prices.items()]
        lines += [
            f"  {k} at the end of its range: {v:+.4g} of {name} per unit" for k, v in self.at_range.items()
        ]
        lines += [f"  residual of the conditions of an optimum {self.kkt:.1e}"]
        lines += [f"  a start ended: {said}" for said in self.failed]
        return "\n".join(lines)


class _Impossible(Exception):
    """A design without a number ends the start that came to it."""


@dataclass(eq=False)
class _Problem:
    """A design problem in parameters scaled to 0…1, its evaluations counted and kept."""

    function: Design
    ranges: Mapping[str, tuple[float, float]]
    objective: str
    sign: float
    limits: tuple[tuple[str, float, float], ...]  # name, +1 for at most and −1 for at least, the limit
    count: int = 0
    known: dict[bytes, tuple[dict[str, float], dict[str, Array]]] = field(default_factory=dict)

    @property
    def low(self) -> Array:
        return np.array([a for a, _ in self.ranges.values()])

    @property
    def width(self) -> Array:
        return np.array([b - a for a, b in self.ranges.values()])

    def design(self, u: Array) -> dict[str, float]:
        """The parameters of a point of the unit box."""
        # to the last bit within the range
        x = np.clip(self.low + self.width * u, self.low, self.low + self.width)
        return dict(zip(self.ranges, x.tolist(), strict=True))

    def at(self, u: Array) -> tuple[dict[str, float], dict[str, Array]]:
        """Values, and their slopes over the unit box, at a point of it."""
        u = np.clip(u, 0.0, 1.0)
        key = u.tobytes()
        if key not in self.known:
            self.known[key] = self._evaluated(u)
        return self.known[key]

    def _called(self, u: Array) -> dict[str, Any]:
        design = self.design(u)
        said = ", ".join(f"{k} = {v:.6g}" for k, v in design.items())
        self.count += 1
        try:
            answer = self.function(design)
        except (ValueError, ArithmeticError) as error:
            raise _Impossible(f"the design {said} cannot be computed: {error}") from error
        given = named(
            "function", answer, "it must return {name: value, or (value, slopes)} for a design, a dict"
        )
        for name in self._names:
            require(name in given, "function", name, f"it is not returned; {meant(name, given)}")
            value = given[name][0] if isinstance(given[name], tuple) else given[name]
            if not math.isfinite(float(value)):
                raise _Impossible(f"{name} is {float(value)} for the design {said}")
        return given

    @property
    def _names(self) -> list[str]:
        return list(dict.fromkeys([self.objective, *(name for name, _, _ in self.limits)]))

    def _evaluated(self, u: Array) -> tuple[dict[str, float], dict[str, Array]]:
        given = self._called(u)
        values = {k: float(v[0] if isinstance(v, tuple) else v) for k, v in given.items()}
        slopes: dict[str, Array] = {}
        for name in self._names:
            if isinstance(given[name], tuple):
                by = given[name][1]
                missing = sorted(set(self.ranges) ^ set(by))
                remedy = f"give a slope for each parameter and no other: {missing}"
                require(not missing, f"slopes of {name}", sorted(by), remedy)
                slopes[name] = np.array([float(by[k]) for k in self.ranges]) * self.width
                if not np.isfinite(slopes[name]).all():
                    raise _Impossible(f"a slope of {name} is not finite for the design {self.design(u)}")
        bare = [name for name in self._names if name not in slopes]
        if bare:
            # by differences inwards
            rows = []
            for k in range(u.size):
                step = DIFFERENCE if u[k] < 0.5 else -DIFFERENCE
                moved = u.copy()
                moved[k] += step
                other = self._called(moved)
                rows.append([(float(other[n]) - values[n]) / step for n in bare])
            for j, name in enumerate(bare):
                slopes[name] = np.array([row[j] for row in rows])
        return values, slopes

    def scaled(self, limit: tuple[str, float, float], u: Array) -> tuple[float, Array]:
        """What is left up to a limit, over its size, and its slopes: negative where it is passed."""
        name, side, bound = limit
        values, slopes = self.at(u)
        size = abs(bound) or 1.0
        return side * (bound - values[name]) / size, -side * slopes[name] / size


def optimise(
    function: Design,
    ranges: Mapping[str, Sequence[float]],
    *,
    minimise: str | None = None,
    maximise: str | None = None,
    limits: Mapping[str, Sequence[float | None] | float] | None = None,
    starts: int = 10,
    seed: int = 0,
    tolerance: float = 1e-6,
) -> Optimum:
    """Find the optimum within limits, by sequential quadratic programming from several starts.

    Parameters
    ----------
    function
        Maps a design, a dict of parameters, to a mapping of values: a number, or a tuple of the number and
        its slopes by parameter, as `bd.gradient` gives them. Values without slopes are differenced, at the
        price of a call for each parameter.
    ranges
        (low, high) of each parameter.
    minimise, maximise
        Name of the value that is to be small, or large; give one of the two.
    limits
        What values must keep: name -> the most, or (least, most), None for no end.
    starts
        Number of starts, spread over the ranges by a Sobol sequence.
    seed
        Of the sequence's scrambling.
    tolerance
        Of the objective over its size, at which a start ends.

    Returns
    -------
    Optimum
        The best of all starts, with the active limits and their prices.

    Raises
    ------
    ValueError
        For a range, limit or name that is not valid; where limits exclude everything, naming the limit, or
        the pair, that no design keeps; where every start came to a design without a number, naming it.

    Warns
    -----
    UnprovenOptimum
        Where more than 5 % of the steepest slope is left at the best design.

    References
    ----------
    D. Kraft, DFVLR-FB 88-28 (1988), by scipy.optimize (SLSQP).

    Examples
    --------
    >>> from bearingdyn import study
    >>> def square(d):
    ...     x, y = d["x"], d["y"]
    ...     return {
    ...         "f": ((x - 2) ** 2 + (y - 1) ** 2, {"x": 2 * (x - 2), "y": 2 * (y - 1)}),
    ...         "g": (x + y, {"x": 1.0, "y": 1.0}),
    ...     }
    >>> best = study.optimise(square, {"x": (0, 3), "y": (0, 3)}, minimise="f", limits={"g": 2.0}, starts=2)
    >>> [f"{v:.3f}" for v in best.parameters.values()], f"{best.prices['g']:.2f}"
    (['1.500', '0.500'], '-1.00')
    """
    problem = _problem(function, ranges, minimise, maximise, limits)
    starts = whole("starts", starts, 1)
    tolerance = positive("tolerance", tolerance)
    first = [np.array(list(c.values())) for c in sobol(starts, seed, **dict.fromkeys(ranges, (0.0, 1.0)))]
    return _from_starts(problem, first, tolerance)


def _problem(
    function: Design,
    ranges: Mapping[str, Sequence[float]],
    minimise: str | None,
    maximise: str | None,
    limits: Mapping[str, Sequence[float | None] | float] | None,
) -> _Problem:
    require(callable(function), "function", function, "it must be a function of a design, a dict")
    one = f"with maximise={maximise!r}; give exactly one of the two"
    require((minimise is None) != (maximise is None), "minimise", minimise, one)
    boxes: dict[str, tuple[float, float]] = {}
    for name, given in named("ranges", ranges, "give (low, high) of each parameter by its name").items():
        require(np.shape(given) == (2,), f"ranges[{name!r}]", given, "it must be (low, high)")
        low, high = (number(f"ranges[{name!r}]", v) for v in given)
        require(low < high, f"ranges[{name!r}]", given, "low must be below high")
        boxes[name] = (low, high)
    require(bool(boxes), "ranges", ranges, "give one parameter at least")
    kept: list[tuple[str, float, float]] = []
    for name, given in named("limits", limits or {}, "give the most, or (least, most), by name").items():
        field_name, remedy = f"limits[{name!r}]", "it must be the most, or (least, most), None for no end"
        ends = (None, given) if np.ndim(given) == 0 else tuple(given)
        require(len(ends) == 2, field_name, given, remedy)
        least, most = (None if v is None else number(field_name, v, remedy) for v in ends)
        require(least is not None or most is not None, field_name, given, remedy)
        require(least is None or most is None or least < most, field_name, given, "least must be below most")
        kept += [(name, -1.0, least)] if least is not None else []
        kept += [(name, 1.0, most)] if most is not None else []
    objective, sign = (minimise, 1.0) if minimise is not None else (maximise, -1.0)
    assert objective is not None
    name_list("minimise" if sign > 0 else "maximise", [objective], "values")
    return _Problem(function, boxes, objective, sign, tuple(kept))


def _from_starts(problem: _Problem, first: Sequence[Array], tolerance: float) -> Optimum:
    """The best that is reached from these points (parameters,) of the unit box."""
    ends: list[tuple[float, Array]] = []
    objectives, failed = [], []
    for u in first:
        objectives.append(math.nan)
        try:
            end = _descend(problem, u, tolerance)
            values, _ = problem.at(end)
            kept = all(problem.scaled(limit, end)[0] >= -KEPT for limit in problem.limits)
        except _Impossible as bad:
            failed.append(str(bad))
            continue
        if kept:
            objectives[-1] = values[problem.objective]
            ends.append((problem.sign * values[problem.objective], end))
    if len(failed) == len(first):
        raise ValueError(f"objective: every start came to a design without a number; {failed[0]}")
    if not ends:
        raise ValueError(_excluded(problem, first))
    best = min(ends, key=lambda e: e[0])[1]
    return _told(problem, best, tuple(objectives), tuple(failed))


def _descend(problem: _Problem, u: Array, tolerance: float) -> Array:
    """The end of one start, by SLSQP."""
    values, slopes = problem.at(u)
    name = problem.objective
    # scaled so that the steepest parameter's whole range counts as one
    size = max(float(np.abs(slopes[name]).max()), 1e-3 * abs(values[name]), 1e-300)

    def objective(u: Array) -> tuple[float, Array]:
        values, slopes = problem.at(u)
        return problem.sign * values[name] / size, problem.sign * slopes[name] / size

    constraints = [
        {
            "type": "ineq",
            "fun": lambda u, limit=limit: problem.scaled(limit, u)[0],
            "jac": lambda u, limit=limit: problem.scaled(limit, u)[1],
        }
        for limit in problem.limits
    ]
    found = scipy.optimize.minimize(
        objective,
        u,
        jac=True,
        method="SLSQP",
        bounds=[(0.0, 1.0)] * u.size,
        constraints=constraints,
        options={"ftol": tolerance, "maxiter": 60},
    )
    return np.asarray(np.clip(found.x, 0.0, 1.0))


def _told(problem: _Problem, u: Array, ends: tuple[float, ...], failed: tuple[str, ...]) -> Optimum:
    """The optimum with the multipliers of what is active, by non-negative least squares."""
    values, slopes = problem.at(u)
    downhill = problem.sign * slopes[problem.objective]
    columns, owners = [], []
    for limit in problem.limits:
        left, slope = problem.scaled(limit, u)
        if left <= NEAR:
            columns.append(slope)
            owners.append(limit)
    edges = []
    for k, name in enumerate(problem.ranges):
        for at_end, side in ((u[k] <= ACTIVE, 1.0), (u[k] >= 1.0 - ACTIVE, -1.0)):
            if at_end:
                column = np.zeros(u.size)
                column[k] = side
                columns.append(column)
                edges.append((name, side))
    weights, residual = np.zeros(0), float(np.linalg.norm(downhill))
    if columns:
        A = np.array(columns).T
        scale = np.linalg.norm(A, axis=0)
        scale[scale == 0] = 1.0
        weights, residual = scipy.optimize.nnls(A / scale, downhill)
        weights = weights / scale
    # beside the steepest slope on the way: within the ranges no limit holds the objective's own
    size = max(float(np.linalg.norm(s[problem.objective])) for _, s in problem.known.values()) or 1.0
    kkt = float(residual) / size
    if kkt > UNPROVEN:
        said = ", ".join(f"{k} = {v:.6g}" for k, v in problem.design(u).items())
        warn(
            f"the best design, {said}, misses the conditions of an optimum: {kkt:.2g} of the steepest slope "
            f"of {problem.objective} is left; the function is noisy, jumps, or its slopes are wrong. Take "
            f"more starts, smoother values, or a study by study.sobol",
            UnprovenOptimum,
        )
    prices, at_range = {}, {}
    for (name, side, bound), weight in zip(owners, weights, strict=False):
        if weight > 0:
            # dF/d(bound): side·(bound − value)/|bound| grows by side/|bound|
            prices[name] = float(-problem.sign * weight * side / (abs(bound) or 1.0))
    width = dict(zip(problem.ranges, problem.width.tolist(), strict=True))
    for (name, side), weight in zip(edges, weights[len(owners) :], strict=True):
        if weight > 0:
            at_range[name] = float(problem.sign * weight * side / width[name])
    return Optimum(
        parameters=problem.design(u),
        values=values,
        objective=(problem.objective, values[problem.objective]),
        prices=prices,
        at_range=at_range,
        kkt=kkt,
        evaluations=problem.count,
        ends=ends,
        failed=failed,
    )


def _excluded(problem: _Problem, first: Sequence[Array]) -> str:
    """Which limit, or which pair, no design keeps, in words."""

    def words(limit: tuple[str, float, float]) -> str:
        name, side, bound = limit
        return f"{name} {'≤' if side > 0 else '≥'} {bound:.6g}"

    def missed(several: Sequence[tuple[str, float, float]]) -> tuple[float, Array]:
        """The least violation of several limits together, and where."""

        def square(u: Array) -> tuple[float, Array]:
            total, slope = 0.0, np.zeros(u.size)
            for limit in several:
                left, by = problem.scaled(limit, u)
                if left < 0:
                    total, slope = total + left * left, slope - 2 * -left * by
            return total, slope

        best = (math.inf, first[0])
        for u in first:
            try:
                found = scipy.optimize.minimize(
                    square, u, jac=True, method="L-BFGS-B", bounds=[(0, 1)] * u.size
                )
            except _Impossible:
                continue
            if found.fun < best[0]:
                best = (float(found.fun), np.clip(found.x, 0.0, 1.0))
            if best[0] <= KEPT**2:
                break
        return best

    for count in (1, 2):
        for several in combinations(problem.limits, count):
            miss, u = missed(several)
            if miss > KEPT**2:
                near = ", ".join(f"{name} = {problem.at(u)[0][name]:.6g}" for name, _, _ in several)
                whom = " and ".join(words(limit) for limit in several)
                kind = "the limit" if count == 1 else "the pair of limits"
                return (
                    f"limits: no design in the ranges keeps {kind} {whom}; the nearest has {near}; widen one"
                )
    every = ", ".join(words(limit) for limit in problem.limits)
    return f"limits: no start found a design that keeps all of {every}, though each pair of them can be kept"


def front(
    function: Design,
    ranges: Mapping[str, Sequence[float]],
    *,
    objectives: tuple[str, str],
    limits: Mapping[str, Sequence[float | None] | float] | None = None,
    points: int = 7,
    starts: int = 4,
    seed: int = 0,
    tolerance: float = 1e-6,
) -> list[Optimum]:
    """Several optima along a front of two values that should both be small, by the ε-constraint method.

    The two ends are the optima of each value; between them the first is minimised while the second keeps
    limits that are evenly spaced. Each point starts from its neighbour too.

    Parameters
    ----------
    function
        As for `optimise`. Of a value that should be large return its negative.
    ranges
        (low, high) of each parameter.
    objectives
        Names of the two values.
    limits
        As for `optimise`.
    points
        Number of points, at least 2, the ends included.
    starts, seed, tolerance
        As for `optimise`, for the ends; a point in between has one fresh start.

    Returns
    -------
    list of Optimum
        From the smallest second value to the smallest first one; `prices` of the second value is the slope of
        the front.

    Raises
    ------
    ValueError
        As `optimise`.

    References
    ----------
    Y. Y. Haimes, L. S. Lasdon and D. A. Wismer, IEEE Trans. Syst. Man Cybern. 1 (1971) 296.
    """
    first, second = name_list("objectives", objectives, "values", 2)
    points = whole("points", points, 2)
    settings = {"starts": starts, "seed": seed, "tolerance": tolerance}
    least = optimise(function, ranges, minimise=second, limits=limits, **settings)  # type: ignore[arg-type]
    end = optimise(function, ranges, minimise=first, limits=limits, **settings)  # type: ignore[arg-type]
    found = [least]
    low, high = least.values[second], end.values[second]
    given = named("limits", limits or {}, "give the most, or (least, most), by name")
    remedy = "it is an objective; its limit is moved along the front"
    require(second not in given, "limits", second, remedy)
    fresh = list(sobol(points, seed, **dict.fromkeys(ranges, (0.0, 1.0))))
    for k in range(1, points - 1):
        epsilon = low + (high - low) * k / (points - 1)
        problem = _problem(function, ranges, first, None, {**given, second: epsilon})
        before = (np.array(list(found[-1].parameters.values())) - problem.low) / problem.width
        begins = [before, np.array(list(fresh[k].values()))]
        found.append(_from_starts(problem, begins, positive("tolerance", tolerance)))
    return [*found, end]
