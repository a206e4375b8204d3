"""Results as xarray Datasets: named dimensions, units, and what they were made from and by."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np

from bearingdyn.checks import require
from bearingdyn.results.provenance import stamp, versions

if TYPE_CHECKING:
    import xarray


Variable: TypeAlias = tuple[str | tuple[str, ...], Any, str, str]
"""dims, values, unit, meaning"""


def dataset(
    variables: Mapping[str, Variable],
    attrs: Mapping[str, Any],
    coords: Mapping[str, tuple[Any, str] | Variable] | None = None,
) -> xarray.Dataset:
    """A result as a Dataset whose variables carry units and meaning, and what made it, and when (UTC).

    Parameters
    ----------
    variables
        Name -> (dimensions, values, unit, meaning).
    attrs
        Attributes of the whole.
    coords
        Name -> (values, unit) of a dimension; or, beside one, as a variable.
    """
    import xarray

    def whole(name: str, coord: tuple[Any, str] | Variable) -> tuple[Any, ...]:
        if len(coord) == 2:
            return name, np.asarray(coord[0]), {"units": coord[1]}
        dims, values, unit, meaning = coord
        return dims, values, {"units": unit, "long_name": meaning}

    made_by = ", ".join(f"{name} {number}" for name, number in versions().items())
    # all at once: each assignment to a Dataset aligns and copies all that it holds
    return xarray.Dataset(
        {
            name: (dims, values, {"units": unit, "long_name": meaning})
            for name, (dims, values, unit, meaning) in variables.items()
        },
        {name: whole(name, coord) for name, coord in (coords or {}).items()},
        {"made_by": made_by, "made_at": stamp(), **attrs},
    )


def check_dataset(field: str, value: object, holding: Sequence[str], maker: str) -> None:
    """Check that an argument is a Dataset of results with these variables, made by `maker`.

    Parameters
    ----------
    field, value
        The argument's name and what was given for it.
    holding
        Variables it must have.
    maker
        The function whose result it should be, for the message.

    Raises
    ------
    ValueError
        For anything else.
    """
    good = hasattr(value, "data_vars") and all(name in value for name in holding)  # type: ignore[operator]
    told = value if not hasattr(value, "data_vars") else f"a Dataset of {sorted(map(str, value))}"  # type: ignore[call-overload]
    require(good, field, told, f"it must be the result of `{maker}`, with {', '.join(holding)}")
