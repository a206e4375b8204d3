"""What a figure is given: every argument is checked by its name before anything is drawn."""

from __future__ import annotations

import functools
import inspect
from collections.abc import Callable, Mapping
from typing import ParamSpec, TypeVar

import numpy as np

from bearingdyn.bearing import BallBearing, Lubricant
from bearingdyn.checks import (
    instance,
    name_list,
    named,
    nonnegative,
    number,
    numbers,
    positive,
    require,
    truth,
    two,
    vector,
    whole,
)
from bearingdyn.plot.frame import some
from bearingdyn.results import check_dataset

P = ParamSpec("P")
R = TypeVar("R")
Check = Callable[[str, object], object]


def figure(**given: Check) -> Callable[[Callable[P, R]], Callable[P, R]]:
    """Make a function a figure: its arguments are checked first.

    Parameters
    ----------
    given
        Check of each argument by its name; arguments of `COMMON` are checked as there.
    """

    def decorate(draw: Callable[P, R]) -> Callable[P, R]:
        signature = inspect.signature(draw)
        checks = {name: check for name, check in {**COMMON, **given}.items() if name in signature.parameters}

        @functools.wraps(draw)
        def drawn(*args: P.args, **kwargs: P.kwargs) -> R:
            bound = signature.bind(*args, **kwargs).arguments
            for name in bound:
                if name in checks:
                    checks[name](name, bound[name])
            return draw(*args, **kwargs)

        return drawn

    return decorate


def one(*kinds: type, maker: str) -> Check:
    """An argument that is of one of the kinds, as `maker` gives it."""
    return lambda name, value: instance(name, value, kinds, f"it must be {maker}")


def several(*kinds: type, maker: str) -> Check:
    """An argument that maps labels to objects of one of the kinds, as `maker` gives them."""

    def check(name: str, value: object) -> None:
        for label, each in _by_label(name, value, maker).items():
            instance(f"{name}[{label!r}]", each, kinds, f"it must be {maker}")

    return check


def result(maker: str, *holding: str) -> Check:
    """An argument that is a Dataset with these variables, the result of `maker`."""
    return lambda name, value: check_dataset(name, value, holding, maker)


def results(maker: str, *holding: str, alone: bool = False) -> Check:
    """An argument that maps labels to results of `maker`, with these variables; or is one, where `alone`."""

    def check(name: str, value: object) -> None:
        if alone and hasattr(value, "data_vars"):
            return check_dataset(name, value, holding, maker)
        for label, each in _by_label(name, value, f"the result of `{maker}`").items():
            check_dataset(f"{name}[{label!r}]", each, holding, maker)
        return None

    return check


def maybe(check: Check) -> Check:
    """An argument of a figure that may be None."""
    return lambda name, value: None if value is None else check(name, value)


def row(remedy: str, *, alone: bool = False, empty: bool = False) -> Check:
    """An argument that is a list of finite numbers; or one number, where `alone`, or none, where `empty`."""

    def check(name: str, value: object) -> None:
        if empty and isinstance(value, list | tuple | np.ndarray) and len(value) == 0:
            return
        numbers(name, value, remedy)  # type: ignore[arg-type]
        require(alone or np.ndim(value) > 0, name, value, remedy)  # type: ignore[arg-type]

    return check


def names(what: str) -> Check:
    """An argument that is a list of names; a mapping is none."""

    def check(name: str, value: object) -> None:
        require(not isinstance(value, Mapping), name, value, f"it must be a list of {what}, each a text")
        name_list(name, value, what)

    return check


def text(name: str, value: object) -> None:
    """An argument of a figure that is a name."""
    instance(name, value, str, "it must be a name, as a text")


def frequencies(name: str, value: object) -> None:
    """An argument that maps names of lines to their frequencies, Hz."""
    for line, f in named(name, value, "it must be a mapping, name -> frequency in Hz").items():
        number(f"{name}[{line!r}]", f, "it must be a frequency in Hz")


def _by_label(name: str, value: object, maker: str) -> Mapping[str, object]:
    remedy = f"it must be a mapping, label -> {maker}"
    require(isinstance(value, Mapping), name, value, remedy)
    labelled: Mapping[str, object] = value  # type: ignore[assignment]
    if not hasattr(value, "data_vars"):
        require(all(isinstance(label, str) for label in labelled), name, value, remedy)
    return some(labelled, name)


def _axes(name: str, value: object) -> None:
    known = value is None or hasattr(value, "get_subplotspec")
    require(known, name, value, "it must be axes of matplotlib, or None for those of a new figure")


COMMON: Mapping[str, Check] = {
    "about_mean": truth,
    "angle": number,
    "ax": _axes,
    "axis": text,
    "bearing": one(BallBearing, maker="a bd.BallBearing(…)"),
    "channels": maybe(names("channels")),
    "colour": maybe(text),
    "component": text,
    "contact_angle": maybe(number),
    "decibels": truth,
    "direction": lambda name, value: vector(name, value, (6,), "of force and moment"),  # type: ignore[arg-type]
    "f_max": maybe(lambda name, value: positive(name, value, "it must be positive, in Hz, or None")),
    "frequency": row("it must be frequencies in Hz"),
    "harmonics": lambda name, value: whole(name, value, 1),
    "input": text,
    "load": lambda name, value: vector(name, value, (6,), "of force and moment"),  # type: ignore[arg-type]
    "lubricant": one(Lubricant, maker="a bearing.Lubricant(…)"),
    "mode": lambda name, value: whole(name, value, 0),
    "orders": row("it must be orders of the speed", empty=True),
    "output": text,
    "parts": maybe(names("parts")),
    "phase": truth,
    "roughness": maybe(lambda name, value: two(name, value, "it must be those of race and ball, m")),
    "scale": maybe(positive),
    "span": maybe(lambda name, value: two(name, value, "it must be the first and last time, s")),
    "speed": number,
    "speeds": row("it must be speeds in rad/s"),
    "starvation": nonnegative,
    "temperatures": row("it must be temperatures in °C", alone=True),
    "wanted": maybe(row("it must be orders that were tracked, or None for all", alone=True)),
    "waviness": truth,
    "x": text,
    "y": text,
}
"""Arguments that mean the same in every figure."""
