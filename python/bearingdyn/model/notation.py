"""Values as they are written in a model: numbers, "30 mm", "= 2 * gap + 3 * mm", and grids."""

from __future__ import annotations

import ast
import math
import operator
import re
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

from bearingdyn import units
from bearingdyn.checks import meant, require, whole
from bearingdyn.types import Array

_TWO: dict[type, Callable[[Any, Any], Any]] = {
    ast.Add: operator.add,
    ast.Sub: operator.sub,
    ast.Mult: operator.mul,
    ast.Div: operator.truediv,
    ast.Pow: operator.pow,
}
_QUANTITY = re.compile(r"^\s*([-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?)\s+(\S.*?)\s*$")


# "50mm": what comes behind the number begins with a letter, and is no exponent
_CLOSE = re.compile(r"^\s*([-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?)([^\W\d_eE].*?|[°%].*?)\s*$")
# "50*mm"
_PRODUCT = re.compile(r"^\s*[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?\s*[*/]")
# of a compound unit: a stroke, or "mm" and its power; a stroke divides the next factor, or all in parentheses
_FACTOR = re.compile(r"(/\s*\(?|\))|([^\W\d]+|°|%)((?:\^|\*\*)?-?\d+|[⁻⁰¹²³⁴⁵⁶⁷⁸⁹]+)?")
_NO_ARITHMETIC = "is no arithmetic; write numbers, parameters, units and + - * / **, such as 14 * mm"


def evaluate(text: str, names: Mapping[str, Any]) -> Any:
    """Value of a model file's notation: an expression of numbers, parameters, units and + - * / **.

    Raises
    ------
    ValueError
        For a name that is no parameter and no unit, and for anything else than arithmetic.
    """
    factors = {name: value for name, value in vars(units).items() if isinstance(value, float)}
    known = {**factors, "pi": math.pi, **names}

    def of(node: ast.AST) -> Any:
        if isinstance(node, ast.Expression):
            return of(node.body)
        if isinstance(node, ast.Constant) and isinstance(node.value, int | float):
            return node.value
        if isinstance(node, ast.Name):
            if node.id not in known:
                raise ValueError(f"{text!r} names {node.id!r}; {meant(node.id, [*names, 'mm', 'rpm', 'pi'])}")
            return known[node.id]
        if isinstance(node, ast.BinOp) and type(node.op) in _TWO:
            left, right = of(node.left), of(node.right)
            numbers = all(isinstance(x, int | float) and not isinstance(x, bool) for x in (left, right))
            require(numbers, "expression", text, "it may hold numbers, parameters and units only")
            try:
                found = _TWO[type(node.op)](float(left), float(right))
            except (ArithmeticError, ValueError):
                raise ValueError(f"{text!r} has no value; one of its steps is no number") from None
            require(isinstance(found, float), "expression", text, "it must be a real number")
            return found
        if isinstance(node, ast.UnaryOp) and isinstance(node.op, ast.USub | ast.UAdd):
            inner = of(node.operand)
            return -inner if isinstance(node.op, ast.USub) else inner
        raise ValueError(f"{text.strip()!r} {_NO_ARITHMETIC}")

    try:
        return of(ast.parse(text.strip(), mode="eval"))
    except (SyntaxError, RecursionError, MemoryError):
        raise ValueError(f"{text.strip()!r} {_NO_ARITHMETIC}") from None


def quantity(text: str, unit: str) -> float | None:
    """Value in SI of a model file's notation such as "30 mm", where this unit is wanted; None if it is none.

    Raises
    ------
    ValueError
        For a unit of something else, or one typed twice.
    """
    found = _QUANTITY.match(text)
    if found is None:
        close = _CLOSE.match(text)
        if close is not None:
            raise ValueError(f"{text!r} lacks the space before its unit; write '{close[1]} {close[2]}'")
        if _PRODUCT.match(text):
            raise ValueError(f"{text!r} is arithmetic without its sign; write '= {text.strip()}'")
        return None
    number, given = float(found[1]), found[2]
    if unit == units.CELSIUS:
        require(given in ("°C", "K"), "unit", given, "it must be °C or K")
        return number - units.KELVIN if given == "K" else number
    own = units.read(given)
    twice = _twice(given)
    if twice:
        raise ValueError(f"{text!r} has the unit {twice} twice; write it once, and its square as {twice}²")
    if unit == "rad/s" and given in ("1/min", "/min", "min⁻¹", "min^-1", "min-1", "U/min", "rev/min"):
        raise ValueError(f"{text!r} is in {given}; write '{found[1]} rpm'")
    if not own.alike(units.read(unit)):
        raise ValueError(
            f"{text!r} is in {given}; it must be in {unit or 'no unit'}, or one that measures the same"
        )
    return number * own.factor


def _twice(unit: str) -> str:
    """What a compound unit names twice above its stroke, or below; "" for nothing."""
    seen, stroke = set(), ""
    for sign, name, power in _FACTOR.findall(unit):
        if not name:
            stroke = "" if sign == ")" else sign
            continue
        below = bool(stroke) != power.lstrip("^*").startswith(("-", "⁻"))
        if (name, below) in seen:
            return str(name)
        seen.add((name, below))
        stroke = stroke if stroke.endswith("(") else ""
    return ""


def grid(value: Mapping[str, Any]) -> Array:
    """Grid in a model file's notation: {from = 10, to = 3000, count = 600, spacing = "log"}.

    Raises
    ------
    ValueError
        For ends or a count that make none.
    """
    unknown = set(value) - {"from", "to", "count", "spacing"}
    if unknown:
        raise ValueError(f"{min(unknown)!r} is unknown; a grid has from, to, count and spacing")
    for name in ("from", "to", "count"):
        if name not in value:
            raise ValueError(f"{name} is missing; a grid has from, to, count and spacing")
    count = whole("count", value["count"], 1, 10_000_000)
    low, high = (float(value[k]) for k in ("from", "to"))
    spacing = value.get("spacing", "linear")
    require(spacing in ("linear", "log"), "spacing", spacing, 'it must be "linear" or "log"')
    require(math.isfinite(low) and math.isfinite(high), "from", low, "both ends must be finite")
    if spacing == "log":
        require(min(low, high) > 0, "from", low, "the ends of a log grid must be positive")
        return np.geomspace(low, high, count)
    return np.linspace(low, high, count)
