"""Units of an instrument's columns: read, assumed where that is safe, and said."""

from __future__ import annotations

from collections.abc import Mapping

from bearingdyn.material.reading.columns import UNITS, Column, is_number, number_of
from bearingdyn.material.reading.errors import ReadingError
from bearingdyn.notice import AssumedMeaning, warn

_HOT = 150.0  # °C; temperatures above it, without a unit, may be in K


class ColumnUnits:
    """Units of the columns below one header.

    Parameters
    ----------
    given
        Units by quantity; they take precedence over those in the table.

    Attributes
    ----------
    factors
        Factors to SI by quantity (temperature: the sum to °C).
    assumed
        What was assumed where no unit is given; warned of as well.
    frequency_read
        Where the unit of the frequency stands, and that unit; None before it is read.
    faults
        What is wrong with the units.
    """

    def __init__(self, given: Mapping[str, str]) -> None:
        self.given = given
        self.factors: dict[str, float] = {}
        self.assumed: list[str] = []
        self.frequency_read: tuple[str, str] | None = None
        self.faults: list[ReadingError] = []

    def read(self, quantity: str, column: Column, where: str, first: str) -> None:
        """Take in the unit of a column that stands at `where`; `first` is its first number, as text."""
        given = self.given.get(quantity, self.given.get("frequency") if quantity == "angular" else None)
        unit = column.unit if given is None else given
        if given is None and quantity in ("frequency", "angular"):
            unit = self._of_frequency(quantity, column, where)
            self.frequency_read = where, unit.strip("[] ")
        bare_temperature = given is None and quantity == "temperature" and not _bare(unit)
        if bare_temperature and is_number(first) and number_of(first) <= _HOT:
            unit = "°C"
            self._assume(f"{where}, column {column.title!r}: no unit for the temperature", unit, quantity)
        if given is None and quantity == "time" and not _bare(unit):
            unit = "s"
            self._assume(f"{where}, column {column.title!r}: no unit for the time", unit, quantity)
        self._convert(quantity, unit, column, where)

    def _of_frequency(self, quantity: str, column: Column, where: str) -> str:
        """The unit a frequency comes in."""
        place, bare = f"{where}, column {column.title!r}", _bare(column.unit)
        if not bare:
            unit = "Hz" if quantity == "frequency" else "rad/s"
            what = "frequency" if quantity == "frequency" else "angular frequency"
            self._assume(f"{place}: no unit for the {what}", unit, "frequency")
            return unit
        if quantity == "angular" and bare != "rad/s" and "ang" in column.title.lower():
            warn(
                f"{place}: an angular frequency in {column.unit}: taken as {column.unit}, not rad/s",
                AssumedMeaning,
            )
        return column.unit

    def _assume(self, what: str, unit: str, quantity: str) -> None:
        text = f"{what}: taken as {unit}; units={{{quantity!r}: ...}} says otherwise"
        self.assumed.append(text)
        warn(text, AssumedMeaning)

    def _convert(self, quantity: str, unit: str, column: Column, where: str) -> None:
        known, key = UNITS[quantity], _bare(unit)
        if key in known:
            self.factors[quantity] = known[key]
            return
        stated = f"unit {unit.strip()!r}" if key else "no unit"
        self.faults.append(
            ReadingError(
                f"{where}, column {column.title!r}: {stated} for the {quantity}: known are "
                f"{', '.join(known)}; give units={{{quantity!r}: ...}}",
                "units",
            )
        )


def _bare(unit: str) -> str:
    """A unit in small letters, without brackets."""
    return unit.strip().strip("[]()").strip().lower()
