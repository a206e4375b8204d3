"""Which of the unknowns the scatter comes from: Sobol' indices."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from concurrent.futures import Executor
from typing import TYPE_CHECKING, Any

import numpy as np

from bearingdyn.checks import require, whole
from bearingdyn.material import uniforms
from bearingdyn.progress import Progress
from bearingdyn.study.cases import Case, label
from bearingdyn.study.chunks import Study
from bearingdyn.study.distributions import Box
from bearingdyn.study.sweep import sweep

if TYPE_CHECKING:
    import xarray


def possible(cases: Sequence[Case]) -> None:
    """Check that Sobol' indices are possible: ValueError, naming a draw that gave no number and its cause."""
    for k, case in enumerate(cases):
        said = ", ".join(f"{name} = {label(value)}" for name, value in case.parameters.items())
        remedy = "the draw is impossible: narrow the distribution, or cut it with low= and high="
        if case.error is not None:
            raise ValueError(f"draw {k} is {said}; {remedy}; {case.error}")
        for name, value in case.values.items():
            require(bool(np.isfinite(value)), f"{name} of draw {k}", value, f"{remedy}; it has {said}")


def sobol_indices(
    function: Study,
    n: int,
    parameters: Mapping[str, Any],
    executor: Executor | None = None,
    store: str | os.PathLike[str] | None = None,
    progress: Progress | bool | None = None,
    *,
    seed: int = 0,
) -> xarray.Dataset:
    """First-order and total Sobol' indices: the share of each value's variance that each parameter brings.

    The first-order index is what would be gone were the parameter known; the total one counts what it does
    together with others, too. A fitted material is one parameter.

    Parameters
    ----------
    function
        Maps the parameters of a case to a mapping of real numbers, as for `sweep`.
    n
        Number of points, a power of two; the function is called n (parameters + 2) times.
    parameters
        As for `draw`.
    executor, store, progress
        As for `sweep`.
    seed
        Of the scrambling.

    Returns
    -------
    xarray.Dataset
        first_order, total (value, parameter), and the ends of their 95 % intervals by bootstrap,
        first_order_low … total_high; mean and sd (value,).

    Raises
    ------
    ValueError
        For n that is no power of two; naming the draw, where one is impossible or gives NaN.

    References
    ----------
    A. Saltelli et al., Comput. Phys. Commun. 181 (2010) 259; scipy.stats.sobol_indices.
    """
    from scipy import stats

    n = whole("n", n, 2)
    require(n & (n - 1) == 0, "n", n, "it must be a power of two, such as 256")
    box = Box(parameters)
    names, size = list(box.columns), box.size
    unit = uniforms(n, 2 * size, seed)
    A, B = unit[:, :size], unit[:, size:]
    mixed = []
    for columns in box.columns.values():
        one = A.copy()
        one[:, columns] = B[:, columns]
        mixed.append(one)
    points = np.concatenate([A, B, *mixed])
    found = sweep(function, box.cases(points), executor, store, progress)
    possible(found)
    values = list(found[0].values)
    require(bool(values), "function", function, "it must return a value")
    y = np.array([[case.values[v] for v in values] for case in found]).T.reshape(len(values), -1, n)
    spread = np.concatenate([y[:, 0], y[:, 1]], axis=1)
    for name, level in zip(values, spread, strict=True):
        remedy = "it must change over the draws; leave it out"
        require(bool(np.ptp(level) > 0), f"value {name!r}", float(level[0]), remedy)
    given = {"f_A": y[:, 0], "f_B": y[:, 1], "f_AB": np.moveaxis(y[:, 2:], 0, 1)}
    result = stats.sobol_indices(func=given, n=n)
    around = result.bootstrap(confidence_level=0.95, n_resamples=200)

    from bearingdyn.results import dataset

    def of(data: Any, words: str) -> tuple[tuple[str, str], Any, str, str]:
        return ("value", "parameter"), np.asarray(data).reshape(len(values), len(names)), "1", words

    variables: dict[str, Any] = {}
    for kind, theirs in (("first_order", "first_order"), ("total", "total_order")):
        words = kind.replace("_", " ")
        variables[kind] = of(getattr(result, theirs), f"{words} Sobol' index")
        ends = getattr(around, theirs).confidence_interval
        variables[f"{kind}_low"] = of(ends.low, f"lower end of its 95 % interval: {words}")
        variables[f"{kind}_high"] = of(ends.high, f"upper end of its 95 % interval: {words}")
    variables["mean"] = ("value", spread.mean(axis=1), "", "mean over the draws")
    variables["sd"] = ("value", spread.std(axis=1), "", "standard deviation over the draws")
    coords = {"value": (values, ""), "parameter": (names, "")}
    return dataset(variables, {"analysis": "sobol indices", "points": n, "seed": seed}, coords)
