"""A study as a table."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np

from bearingdyn.checks import instance, items, named
from bearingdyn.results import dataset
from bearingdyn.study.cases import Case, label

if TYPE_CHECKING:
    import xarray


def table(cases: Sequence[Case], units: Mapping[str, str] | None = None) -> xarray.Dataset:
    """The table of a study over "case": parameters as coordinates, values and "error" as variables.

    The error of a case that did not fail is "". Values of failed cases are NaN. A parameter that is an object
    is shown as its class and a hash. ``.to_dataframe()`` makes it a table of pandas.

    Parameters
    ----------
    cases
        Result of `sweep`.
    units
        Units of parameters and values, by name; they stand beside the axes of `bearingdyn.plot.trade_off`.

    Returns
    -------
    xarray.Dataset
        Parameters as coordinates, values and "error" as variables.

    Raises
    ------
    ValueError
        Where there are no cases, a value has the name of a parameter, or a unit none of either.
    """
    remedy = "it must be the result of `sweep`, a list of cases"
    cases = items("cases", cases, remedy)
    for case in cases:
        instance("cases", case, Case, remedy)
    units = named("units", {} if units is None else units, "it must be a mapping, column -> unit, or None")
    if not cases:
        raise ValueError("a table needs at least one case")
    parameters = list(cases[0].parameters)
    names = list(dict.fromkeys(name for case in cases for name in case.values))
    for name in names:
        if name in (*parameters, "case", "error"):
            raise ValueError(f"value {name!r} has the name of a parameter or of another column; rename it")
    for name in units:
        if name not in (*parameters, *names):
            raise ValueError(
                f"units names {name!r}, which is not a column; there are {[*parameters, *names]}"
            )
    columns = {n: ("case", [c.values.get(n, math.nan) for c in cases], units.get(n, ""), n) for n in names}
    errors = np.array([case.error or "" for case in cases], dtype=np.str_)
    made = dataset(
        {**columns, "error": ("case", errors, "", "what kept the case from its values")},
        {"analysis": "study"},
        {"case": (np.arange(len(cases)), "")},
    )
    for n in parameters:
        unit = {"units": units.get(n, "")}
        made = made.assign_coords({n: ("case", [label(case.parameters[n]) for case in cases], unit)})
    return made
