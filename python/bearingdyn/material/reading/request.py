"""What the caller of the reader says about a table, where the table does not say it or says it wrong."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

from bearingdyn.checks import instance, items, number, require
from bearingdyn.material.dma import Mode
from bearingdyn.material.reading.columns import LABELS, UNITS

_KNOWN = (*UNITS, *LABELS)

Step = str | int | Sequence[str | int]


@dataclass(frozen=True)
class Request:
    """What is requested of the reader: how to read a table; the arguments of :func:`read_dma`.

    Parameters
    ----------
    mode
        "shear" or "tension"; None if the header has to tell.
    columns, units
        Column names (or numbers, 1 the first) and units by quantity; they take precedence over those in the
        table.
    temperature
        Temperature of all points, °C, where the table has no such column.
    drop_invalid
        Whether points are left out, with a warning, if their frequency or a modulus is not positive.
    step
        Names or numbers of the steps of an instrument's file to be read; None for all.

    Raises
    ------
    ValueError
        If a quantity is unknown or the temperature is not one.
    """

    mode: Mode | None = None
    columns: Mapping[str, str | int] = field(default_factory=dict)
    units: Mapping[str, str] = field(default_factory=dict)
    temperature: float | None = None
    drop_invalid: bool = False
    step: Step | None = None

    def __post_init__(self) -> None:
        T = self.temperature
        known = T is None or -273.15 < number("temperature", T, "it must be a temperature in °C") < 1e4
        require(known, "temperature", T, "it must be a temperature in °C")
        for name, given in (("columns", self.columns), ("units", self.units)):
            instance(name, given, Mapping, "it must be a mapping, as {'storage': ...}")
        if self.step is not None and not isinstance(self.step, str | int):
            for part in items(
                "step", self.step, "it must be the name or number of a step, or a list of them"
            ):
                instance(
                    "step", part, (str, int), "it must be the name or number of a step, or a list of them"
                )
        for quantity, column in self.columns.items():
            titled = isinstance(column, str) or (type(column) is int and column >= 1)
            remedy = "it must be a title, or the number of a column, 1 the first"
            require(titled, f"columns[{quantity!r}]", column, remedy)
        for name, mapping in (("columns", self.columns), ("units", self.units)):
            unknown = sorted(set(mapping) - set(_KNOWN))
            require(
                not unknown, name, dict(mapping), f"unknown quantities {unknown}; known are {list(_KNOWN)}"
            )

    def wants(self, number: int, name: str) -> bool:
        """Whether the step of this number, 1 the first, and name is to be read; names by a part of them."""
        if self.step is None:
            return True
        wanted = [self.step] if isinstance(self.step, str | int) else list(self.step)
        return any(w == number if isinstance(w, int) else w.lower() in name.lower() for w in wanted)
