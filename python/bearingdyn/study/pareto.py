"""The cases of a study that no other one beats."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from bearingdyn.checks import name_list

if TYPE_CHECKING:
    import xarray


def pareto(
    study: xarray.Dataset, minimise: Sequence[str] = (), maximise: Sequence[str] = ()
) -> xarray.Dataset:
    """Pareto front of a finished study: its table with "front", true for cases that no other one beats.

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
    if not (hasattr(study, "variables") and hasattr(study, "assign")):
        raise ValueError(f"study is {study!r}; it must be the result of bd.study.table(…)")
    minimise = name_list("minimise", minimise, "values")
    maximise = name_list("maximise", maximise, "values")
    aims = [*minimise, *maximise]
    if not aims:
        raise ValueError("pareto needs at least one name in minimise or maximise")
    for name in aims:
        if name not in study.variables or study[name].dtype.kind not in "biuf" or name == "case":
            numbers = [str(n) for n in study.variables if study[n].dtype.kind in "biuf" and n != "case"]
            raise ValueError(f"aim {name!r} is not a number of the table; there are {numbers}")
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
