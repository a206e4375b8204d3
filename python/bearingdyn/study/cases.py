"""The cases of a study: lists of parameters by name, and what came of each."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from itertools import product
from typing import Any, TypeAlias

import numpy as np

from bearingdyn import fingerprint
from bearingdyn.checks import items, named
from bearingdyn.short_repr import short

Parameters: TypeAlias = Mapping[str, Any]


@dataclass(frozen=True)
class Case:
    """A case, one of many: its parameters, and its values or the error that kept it from them.

    values is empty where error is set; error is the exception's kind and message.
    """

    parameters: Parameters
    values: Mapping[str, float]
    error: str | None = None

    __repr__ = short


def grid(**axes: Iterable[Any]) -> list[dict[str, Any]]:
    """Cases for every combination of the values of the axes, the last axis running fastest.

    Parameters
    ----------
    **axes
        Values of each parameter by its name.

    Returns
    -------
    list[dict[str, Any]]
        Parameters of each case by name.

    Raises
    ------
    ValueError
        For an axis without values, or no axis at all.

    Examples
    --------
    >>> from bearingdyn import study
    >>> study.grid(width=[0.012, 0.016], rubber=["soft", "hard"])[1]
    {'width': 0.012, 'rubber': 'hard'}
    """
    if not axes:
        raise ValueError("grid needs at least one axis, such as grid(width=[0.012, 0.016])")
    columns = {name: list(values) for name, values in axes.items()}
    for name, values in columns.items():
        if not values:
            raise ValueError(f"axis {name!r} is empty; give at least one value")
    return [dict(zip(columns, values, strict=True)) for values in product(*columns.values())]


def sobol(n: int, seed: int = 0, /, **ranges: Sequence[Any]) -> list[dict[str, float]]:
    """n cases that fill the box of the ranges evenly: a scrambled Sobol sequence, the same for one seed.

    Powers of two fill the box best. A longer study with the same seed begins with the cases of a shorter one.

    Parameters
    ----------
    n
        Number of cases, at least 1.
    seed
        Seed of the scrambling.
    **ranges
        (low, high) of each parameter by its name, or (low, high, "log") for one filled evenly in its
        logarithm.

    Returns
    -------
    list[dict[str, Any]]
        Parameters of each case by name.

    Raises
    ------
    ValueError
        For n below 1, no range, or a range that is not valid.

    References
    ----------
    S. Joe and F. Y. Kuo, SIAM J. Sci. Comput. 30 (2008) 2635; scipy.stats.qmc.
    """
    import warnings

    from scipy.stats import qmc

    if n != int(n) or not n >= 1:
        raise ValueError(f"n is {n}; it must be one case or more")
    if not ranges:
        raise ValueError("sobol needs at least one range, such as sobol(64, width=(0.012, 0.020))")
    for name, given in ranges.items():
        log = len(given) == 3 and given[2] == "log"
        if not (len(given) == 2 or log):
            raise ValueError(f'range {name!r} is {given!r}; give (low, high) or (low, high, "log")')
        low, high = given[:2]
        if not (low < high and math.isfinite(low) and math.isfinite(high) and (low > 0 or not log)):
            raise ValueError(
                f"range {name!r} is {given!r}; low must be below high, both finite, and above 0 with log"
            )
    with warnings.catch_warnings():  # of a number of cases that is not a power of two
        warnings.simplefilter("ignore", UserWarning)
        unit = qmc.Sobol(len(ranges), scramble=True, rng=seed).random(int(n))
    columns: dict[str, list[float]] = {}
    for (name, given), x in zip(ranges.items(), unit.T, strict=True):
        low, high = float(given[0]), float(given[1])
        between = low * (high / low) ** x if len(given) == 3 else low + (high - low) * x
        columns[name] = between.tolist()
    return [dict(zip(columns, values, strict=True)) for values in zip(*columns.values(), strict=True)]


def checked(cases: Iterable[Parameters]) -> list[dict[str, Any]]:
    """The cases of a study as dicts in one order of names.

    Raises
    ------
    ValueError
        For no cases, unequal names, a parameter that is not a number, a text or something told by its
        content, or of another kind than in the first case.
    """
    remedy = "it must be a list of cases, each a mapping, parameter -> value"
    given = [named(f"cases[{i}]", case, remedy) for i, case in enumerate(items("cases", cases, remedy))]
    found = [{name: _plain(i, name, v) for name, v in case.items()} for i, case in enumerate(given)]
    if not found:
        raise ValueError("a study needs at least one case")
    first = found[0]
    for i, case in enumerate(found):
        if case.keys() != first.keys():
            raise ValueError(
                f"case {i} has the parameters {sorted(case)}, case 0 has {sorted(first)}; give each the same"
            )
        for name, value in case.items():
            if _kind(value) != _kind(first[name]):
                raise ValueError(
                    f"case {i}: parameter {name!r} is {value!r}, in case 0 {first[name]!r}; let it be "
                    f"a number throughout, a text throughout, or an object throughout"
                )
    return [{name: case[name] for name in first} for case in found]


def label(value: Any) -> float | int | bool | str:
    """Cases' label of a parameter: a number or text itself, else its class and a hash."""
    if _kind(value) != "object":
        return value  # type: ignore[no-any-return]
    return f"{type(value).__name__} {fingerprint.fingerprint(value)[:8]}"


def _kind(value: Any) -> str:
    return (
        "text" if isinstance(value, str) else "number" if isinstance(value, bool | int | float) else "object"
    )


def _plain(index: int, name: str, value: Any) -> Any:
    if isinstance(value, np.generic | np.ndarray) and value.ndim == 0:
        value = value.item()
    if value is None or (isinstance(value, float) and math.isnan(value)):
        raise ValueError(f"case {index}: parameter {name!r} is {value!r}; it must have a value")
    if _kind(value) == "object":
        try:
            fingerprint.describe(value)
        except ValueError as error:
            raise ValueError(f"case {index}: parameter {name!r}: {error}") from None
    return value
