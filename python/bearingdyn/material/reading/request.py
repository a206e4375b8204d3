"""What the caller of the reader says about a table, where the table does not say it or says it wrong."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from bearingdyn.checks import require
from bearingdyn.material.dma import Mode
from bearingdyn.material.reading.columns import UNITS

_KNOWN = (*UNITS, "isotherm")


@dataclass(frozen=True)
class Request:
    """How a table is to be read; the arguments of :func:`read_dma` of the same names.

    Parameters
    ----------
    mode
        "shear" or "tension"; None if the header has to tell.
    columns, units
        Column names and units by quantity; they take precedence over those in the table.
    temperature
        Temperature of all points, °C, where the table has no such column.
    drop_invalid
        Whether points are left out, with a warning, if their frequency or a modulus is not positive.

    Raises
    ------
    ValueError
        If a quantity is unknown or the temperature is not one.
    """

    mode: Mode | None = None
    columns: Mapping[str, str] = field(default_factory=dict)
    units: Mapping[str, str] = field(default_factory=dict)
    temperature: float | None = None
    drop_invalid: bool = False

    def __post_init__(self) -> None:
        T = self.temperature
        known = T is None or -273.15 < T < 1e4
        require(known, "temperature", T, "it must be a temperature in °C")
        for name, mapping in (("columns", self.columns), ("units", self.units)):
            unknown = sorted(set(mapping) - set(_KNOWN))
            require(
                not unknown, name, dict(mapping), f"unknown quantities {unknown}; known are {list(_KNOWN)}"
            )
