"""One-line descriptions of objects that hold arrays."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import MISSING, fields
from typing import Any

import numpy as np

FEW = 6  # numbers that are written out
LONG = 60  # letters of anything else
LINE = 160  # letters of a mapping or a list of names that is written out


def short(self: Any) -> str:
    """The `__repr__` of a dataclass in one line: arrays by shape and range, no field at its default."""
    return f"{type(self).__name__}({', '.join(f'{name}={told(value)}' for name, value in stated(self))})"


def stated(self: Any) -> list[tuple[str, Any]]:
    """Fields of a dataclass that a short description names, with their values: none at its default."""
    both = [(field, getattr(self, field.name)) for field in fields(self) if field.repr]
    return [
        (field.name, value)
        for field, value in both
        if field.default is MISSING or not _same(value, field.default)
    ]


def _same(value: Any, default: Any) -> bool:
    return value is default or (isinstance(value, int | float | str | tuple) and value == default)


def told(value: Any) -> str:
    """A value of a short description in a few words."""
    if isinstance(value, np.ndarray):
        return _array(value)
    if isinstance(value, float):
        return f"{value:.6g}"
    if isinstance(value, Mapping):
        whole = "{" + ", ".join(f"{key}: {told(one)}" for key, one in value.items()) + "}"
        return whole if len(whole) <= LINE else f"<{len(value)}: {_cut(', '.join(map(str, value)))}>"
    if type(value) in (tuple, list):  # a tuple with names tells itself
        return _row(value)
    return _cut(repr(value))


def _row(values: tuple[Any, ...] | list[Any]) -> str:
    """A tuple or list: written out where it is short, or its names make a line."""
    ends = ("(", ",)" if len(values) == 1 else ")") if isinstance(values, tuple) else ("[", "]")
    named = all(isinstance(one, str) for one in values)
    if len(values) <= FEW or named:
        whole = ends[0] + ", ".join(map(told, values)) + ends[1]
        if len(whole) <= LINE:
            return whole
    return f"<{len(values)} of {type(values[0]).__name__}>"


def _array(x: np.ndarray) -> str:
    if 0 < x.size <= FEW and x.ndim == 1 and x.dtype.kind in "iuf":
        return "[" + ", ".join(f"{v:.5g}" for v in x) + "]"
    shape = "×".join(map(str, x.shape)) or "1"
    if x.size and x.dtype.kind in "iuf":
        return f"<{shape}: {np.nanmin(x):.5g} … {np.nanmax(x):.5g}>"
    return f"<{shape} {x.dtype}>"


def _cut(text: str) -> str:
    return text if len(text) <= LONG else text[: LONG - 1] + "…"
