"""A study as a table, and the cases of it that no other one beats."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np

from bearingdyn.results import dataset
from bearingdyn.study.cases import Case, label

if TYPE_CHECKING:
    import xarray


def table(cases: Sequence[Case], units: Mapping[str, str] | None = None) -> xarray.Dataset:
    """A study as a Dataset over "case": parameters as coordinates, values and "error" as variables.

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
    if not cases:
        raise ValueError("a table needs at least one case")
    parameters = list(cases[0].parameters)
    names = list(dict.fromkeys(name for case in cases for name in case.values))
    for name in names:
        if name in (*parameters, "case", "error"):
            raise ValueError(f"value {name!r} has the name of a parameter or of another column; rename it")
    units = units or {}
    for name in units:
        if name not in (*parameters, *names):
            raise ValueError(f"units names {name!r}, which is no column; there are {[*parameters, *names]}")
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


def pareto(
    study: xarray.Dataset, minimise: Sequence[str] = (), maximise: Sequence[str] = ()
) -> xarray.Dataset:
    """The table with a variable "front", true for the cases that no other one beats.

    A case is beaten by one that is as good in every aim and better in one. Cases with NaN in an aim are not
    on the front. Aims may be values or numeric parameters.

    Parameters
    ----------
    study
        Result of `table`.
    minimise
        Names of the values, or numeric parameters, that should be small.
    maximise
        Names of those that should be large.

    Returns
    -------
    xarray.Dataset
        The table with the variable "front".

    Raises
    ------
    ValueError
        For no aims, an aim that is not in the table or not a number, or one named twice.
    """
    aims = [*minimise, *maximise]
    if not aims:
        raise ValueError("pareto needs at least one name in minimise or maximise")
    for name in aims:
        if name not in study.variables or study[name].dtype.kind not in "biuf" or name == "case":
            numbers = [str(n) for n in study.variables if study[n].dtype.kind in "biuf" and n != "case"]
            raise ValueError(f"aim {name!r} is no number of the table; there are {numbers}")
        if aims.count(name) > 1:
            raise ValueError(f"aim {name!r} is named twice; it must be minimised or maximised, and only once")
    sign = np.array([1.0] * len(minimise) + [-1.0] * len(maximise))
    cost = np.stack([np.asarray(study[name].values, dtype=np.float64) for name in aims], axis=1) * sign
    valid = np.isfinite(cost).all(axis=1)
    front = valid.copy()
    for i in np.flatnonzero(valid):
        beats = (cost[valid] <= cost[i]).all(axis=1) & (cost[valid] < cost[i]).any(axis=1)
        front[i] = not beats.any()
    meaning = f"not beaten in {', '.join(aims)}"
    return study.assign(front=("case", front, {"units": "", "long_name": meaning, "aims": ", ".join(aims)}))
