"""Channels that a model's analyses ask for, and their other arguments, checked before anything is solved."""

from __future__ import annotations

import inspect
from typing import Any

from bearingdyn.application import COMPONENTS, Channel, Place, Plan
from bearingdyn.checks import meant, name_list

CHANNELS = ("inputs", "outputs", "record")
GRID = '{from = 10, to = 2000, count = 200, spacing = "log"}'


def check_channels(plan: Plan, field: str, value: object) -> None:
    """Check that the places of channels are on the plan; what only a system knows is left to the analysis.

    Raises
    ------
    ValueError
        For a place or component that there is not; says what there is.
    """
    for name in name_list(field, value):
        channel = Channel.parse(name)
        races = [f"{part}.{race}" for part, element in plan.parts.items() for race in element.raceways]
        offered = any(f"{channel.at}.".startswith(f"{own}.") for own in (*plan.bearings, *races))
        if offered or channel.of_ground or channel.component == "strain":
            continue
        if channel.is_force:
            plan.interface(channel.at)
            continue
        known = plan.names()
        if "." not in channel.at:
            remedy = f"it must be a place and what of it is meant, such as {known[0] + '.y'!r}"
            raise ValueError(f"{field} names {name!r}; {remedy}")
        if channel.at not in known:
            raise ValueError(f"{field} names the place {channel.at!r}; {meant(channel.at, known)}")
        own = list(COMPONENTS[: len(plan.rows(Place.parse(channel.at)))])
        if channel.component not in own:
            raise ValueError(f"{field} names {name!r}; {channel.at} has {own}, not {channel.component!r}")


def check_argument(kind: Any, field: str, value: object, unit: str | None) -> None:
    """Check that an analysis' argument that takes no text is given none.

    Raises
    ------
    ValueError
        For a text where a number or several are asked; says how a grid is written.
    """
    takes = inspect.signature(kind).parameters.get(field) if kind else None
    if takes is None or "str" in str(takes.annotation) or takes.annotation is takes.empty:
        return
    members = value if isinstance(value, list | tuple) else [value]
    wrong = next((one for one in members if isinstance(one, str)), None)
    if wrong is not None:
        several = "ArrayLike" in str(takes.annotation)
        grid = f", or a grid: {GRID}" if several else ""
        word = "numbers" if several else "a number"
        raise ValueError(f"{field} is {wrong!r}; it must be {word}{f' in {unit}' if unit else ''}{grid}")
