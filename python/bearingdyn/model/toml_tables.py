"""The nouns that a model file may hold, by name: dataclasses, read from tables and written as tables."""

from __future__ import annotations

import dataclasses
import inspect
import sys
import typing
from collections.abc import Callable, Mapping
from functools import lru_cache
from typing import Any

import numpy as np

from bearingdyn import bearing, fem, material, parts
from bearingdyn.checks import meant, require
from bearingdyn.model.key_lines import Key
from bearingdyn.model.notation import evaluate, quantity
from bearingdyn.model.trouble import Origin, at

ROOMS = (material, bearing, fem, parts)
# what stands behind `material` and the like: a name among the model's materials
MATERIALS = ("Elastic", "FractionalZener", "Maxwell", "PowerLaw", "TabulatedModulus")
# reports that a result does not depend on, and what cannot be written as text
LEFT_OUT = {("Maxwell", "fit"), ("Payne", "fit")}


@lru_cache(maxsize=1)
def kinds() -> dict[str, type]:
    """Kinds of tables in a model file's TOML, by name: the dataclasses made public."""
    found = {}
    for room in ROOMS:
        for name in room.__all__:
            made = getattr(room, name)
            if isinstance(made, type) and dataclasses.is_dataclass(made):
                found[name] = made
    return found


@lru_cache(maxsize=200)
def _signature(kind: Any) -> dict[str, inspect.Parameter]:
    known = inspect.signature(kind).parameters
    return {name: p for name, p in known.items() if name not in ("self", "overrides")}


@lru_cache(maxsize=200)
def _nested(kind: Any) -> dict[str, str]:
    """The one noun that a field can hold, where its annotation names one: its `type` may be left out."""
    names = kinds()
    scope = {**vars(sys.modules[kind.__module__]), **{n: k for n, k in names.items()}}
    found = {}
    for name, parameter in _signature(kind).items():
        text = parameter.annotation
        try:
            hint = eval(text, scope) if isinstance(text, str) else text  # the package's own annotations
        except (NameError, TypeError):
            continue
        held = {k.__name__ for k in _classes(hint) if names.get(k.__name__) is k}
        if len(held) == 1 and not held & set(MATERIALS):
            found[name] = held.pop()
    return found


def _classes(hint: Any) -> set[type]:
    if isinstance(hint, type) and not typing.get_args(hint):
        return {hint}
    return {k for part in typing.get_args(hint) for k in _classes(part)}


@dataclasses.dataclass
class Shelf:
    """What tables of all kinds in a model refer to: its parameters and materials, where its keys stand."""

    origin: Origin
    parameters: Mapping[str, Any]
    materials: dict[str, Any]

    def plain(self, value: Any, unit: Any = None) -> Any:
        """A value without nouns: expressions and quantities become numbers."""
        if isinstance(value, str):
            if value.lstrip().startswith("="):
                return evaluate(value.lstrip()[1:], self.parameters)
            found = quantity(value, unit) if isinstance(unit, str) else None
            return value if found is None else found
        if isinstance(value, list):
            own = unit if isinstance(unit, tuple) and len(unit) == len(value) else [unit] * len(value)
            return [self.plain(x, u) for x, u in zip(value, own, strict=True)]
        if isinstance(value, dict):
            return {k: self.plain(x, unit) for k, x in value.items()}
        return value

    def noun(self, table: Any, key: Key, expected: str | None = None, only: tuple[str, ...] = ()) -> Any:
        """The object that a table describes."""
        with at(self.origin, key):
            require(
                isinstance(table, dict), dotted_last(key), table, "it must be a table, such as {type = …}"
            )
        with at(self.origin, (*key, "type")):
            name = table.get("type", expected)
            require(
                name is not None, "type", None, f"it must say what this is: {', '.join(only) or 'a noun'}"
            )
            known = {n: k for n, k in kinds().items() if not only or n in only}
            if not isinstance(name, str) or name not in known:
                raise ValueError(f"type is {name!r}; {meant(str(name), known)}")
        kind = known[name]
        with at(self.origin, key):
            wanted = _signature(kind)
            for field in table:
                with at(self.origin, (*key, field)):
                    if field != "type" and field not in wanted:
                        raise ValueError(f"{field} is no field of {name}; {meant(field, wanted)}")
            for field, parameter in wanted.items():
                plain = parameter.kind not in (parameter.VAR_KEYWORD, parameter.VAR_POSITIONAL)
                if plain and parameter.default is parameter.empty and field not in table:
                    raise ValueError(f"{name} lacks {field}; it must be given")
        units, nested = getattr(kind, "__units__", {}), _nested(kind)
        given = {}
        for field, value in table.items():
            if field != "type":
                with at(self.origin, (*key, field)):
                    given[field] = self.value(value, (*key, field), units.get(field), nested.get(field))
        with at(self.origin, key, given):
            return kind(**given)

    def value(self, value: Any, key: Key, unit: Any = None, expected: str | None = None) -> Any:
        """A field's value: a number, an object, a material by its name, or lists and tables of these."""
        last = key[-1]
        if isinstance(value, str) and isinstance(last, str) and last.endswith(("material", "metal")):
            return self.material(value)
        if isinstance(value, dict) and (expected or "type" in value):
            return self.noun(value, key, expected)
        if isinstance(value, list) and any(isinstance(x, dict) for x in value):
            return tuple(self.value(x, (*key, k), unit, expected) for k, x in enumerate(value))
        return _tupled(self.plain(value, unit))

    def material(self, name: str) -> Any:
        """A material by its name; "steel" is always there."""
        if name in self.materials:
            return self.materials[name]
        if name == "steel":
            return material.STEEL
        raise ValueError(f"{name!r} names no material; {meant(name, [*self.materials, 'steel'])}")


def dotted_last(key: Key) -> str:
    """Last word of a TOML table's dotted key, for a message."""
    return next((str(k) for k in reversed(key) if isinstance(k, str)), "it")


def _tupled(value: Any) -> Any:
    return tuple(_tupled(x) for x in value) if isinstance(value, list) else value


def written(value: Any, name_of: Callable[[Any], str], field: str = "value") -> Any:
    """TOML tables' value of an object; a material becomes its name.

    Parameters
    ----------
    value
        A number, text, array, mapping, sequence or noun.
    name_of
        Gives a material its name among the model's.
    field
        What is written, for a message.

    Raises
    ------
    ValueError
        For what no text can hold.
    """
    if isinstance(value, np.generic):
        value = value.item()
    if isinstance(value, bool | int | float | str):
        return value
    if isinstance(value, np.ndarray):
        require(value.dtype.kind in "iufb", field, value, "it must be real numbers to stand in a file")
        return value.tolist()
    if type(value).__name__ in MATERIALS and type(value) is kinds().get(type(value).__name__):
        return name_of(value)
    if dataclasses.is_dataclass(value) and not isinstance(value, type):
        return table_of(value, name_of, field)
    if isinstance(value, Mapping):
        return {str(k): written(v, name_of, f"{field}[{k!r}]") for k, v in value.items()}
    if isinstance(value, tuple | list):
        return [written(v, name_of, f"{field}[{k}]") for k, v in enumerate(value)]
    raise ValueError(
        f"{field} is {value!r}; it must be numbers, texts or a noun of the package to be written"
    )


def table_of(
    value: Any, name_of: Callable[[Any], str], field: str, expected: str | None = None
) -> dict[str, Any]:
    """TOML table made of an object: its type, and fields not at their default."""
    name = type(value).__name__
    if kinds().get(name) is not type(value):
        raise ValueError(
            f"{field} is a {name}, which no text can hold; it must be made of what it was made of, such as a "
            f"bd.Housing instead of its superelement"
        )
    kind: Any = type(value)
    nested = _nested(kind)
    table: dict[str, Any] = {} if name == expected else {"type": name}
    held = {p: getattr(value, p) for p in _signature(kind) if p not in ("kappa", "cage_ratio", "arm")}
    overrides = getattr(value, "overrides", None)
    if overrides is not None:
        held |= overrides._asdict()
    else:
        own = {"kappa", "cage_ratio", "arm"} & _signature(kind).keys()
        held |= {p: getattr(value, p) for p in own}
    for key, parameter in _signature(kind).items():
        one = held[key]
        if (name, key) in LEFT_OUT or one is None or _same(one, parameter.default):
            continue
        what = nested.get(key)
        if what and type(one).__name__ == what:
            table[key] = table_of(one, name_of, f"{field}.{key}", what)
        elif what and isinstance(one, tuple | list) and all(type(x).__name__ == what for x in one):
            table[key] = [table_of(x, name_of, f"{field}.{key}[{k}]", what) for k, x in enumerate(one)]
        else:
            table[key] = written(one, name_of, f"{field}.{key}")
    return table


def _same(value: Any, default: Any) -> bool:
    if value is default:
        return True
    if isinstance(value, Mapping):
        return not value
    return type(value) is type(default) and not isinstance(value, np.ndarray) and bool(value == default)
