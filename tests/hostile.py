"""What no argument can mean, and the check that a function refuses it by a ValueError from its door."""

from __future__ import annotations

import inspect
import math
from collections.abc import Callable, Collection, Mapping
from decimal import Decimal
from fractions import Fraction
from typing import Any

import numpy as np
import pytest

import bearingdyn as bd

NONE = [
    math.nan,
    [math.nan],
    [math.inf] * 3,
    "1",
    "1,5",
    "",
    1 + 2j,
    b"x",
    np.array(["a"]),
    np.array([1 + 1j]),
]
"""What no number, list, text or truth is; most of all not silently."""
HOSTILE = [
    *NONE, math.inf, -math.inf, -1, 0, 1e300, 1e-300, 10**400, True, None, [], [1, 2], [[1, 2], [3]], {},
    {"a": 1}, {1: 2}, {"a": None}, object(), print, type, bd, [None], ["a"], [True] * 3, np.array(3.0),
    np.zeros((2, 0)), np.float32(1), np.int8(3), Fraction(1, 3), Decimal("0.1"), range(3), set(),
    iter([1, 2]), "ground", ".",
]  # fmt: skip


def refuses(
    call: Callable[..., Any],
    good: Mapping[str, Any],
    texts: Collection[str] = (),
    anything: Collection[str] = (),
) -> None:
    """Assert that each argument of a call refuses what cannot be meant, and takes no text for a number.

    Parameters
    ----------
    call, good
        The function, and arguments that it takes.
    texts
        Arguments that any text may be given.
    anything
        Arguments that nothing is judged of.
    """
    call(**good)
    kinds = (inspect.Parameter.POSITIONAL_OR_KEYWORD, inspect.Parameter.KEYWORD_ONLY)
    for key in [p.name for p in inspect.signature(call).parameters.values() if p.kind in kinds]:
        for value in HOSTILE:
            try:
                call(**{**good, key: value})
            except ArithmeticError as error:
                assert not isinstance(error, ZeroDivisionError | OverflowError), (key, value, error)  # noqa: PT017
            except (ValueError, OSError) as error:
                assert not isinstance(error, np.linalg.LinAlgError), (key, value, error)  # noqa: PT017
            else:
                odd = any(value is each for each in NONE) and key not in anything
                text = key in texts and (
                    isinstance(value, str) or getattr(value, "dtype", np.dtype(float)).kind == "U"
                )
                assert text or not odd, f"{key}={value!r} passes"


@pytest.fixture(autouse=True)
def nowhere(tmp_path: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    """Where a module imports it, its tests run in an empty folder: a hostile path may be written to."""
    monkeypatch.chdir(tmp_path)


def doors(
    cases: Mapping[str, tuple[Callable[..., Any], Mapping[str, Any]]],
    texts: Collection[str],
    takes_any: Collection[tuple[str, str]],
) -> Callable[[str], None]:
    """The test of a table of calls, a case for each of its names.

    Parameters
    ----------
    cases
        name -> function, and arguments that it takes.
    texts
        Arguments that any text may be given.
    takes_any
        Names and arguments that nothing is judged of.
    """

    @pytest.mark.filterwarnings("ignore")
    @pytest.mark.parametrize("name", cases)
    def test(name: str) -> None:
        """No AttributeError, KeyError and their like from within, and no NaN or text for a number."""
        call, good = cases[name]
        refuses(call, good, texts=texts, anything={key for case, key in takes_any if case == name})

    return test
