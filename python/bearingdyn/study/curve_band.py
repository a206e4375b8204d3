"""The band of a curve over draws of what goes into it."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from bearingdyn.analysis import Band, band_of
from bearingdyn.checks import require, whole
from bearingdyn.study.distributions import IMPOSSIBLE, draw, said_of


def band(
    function: Callable[[dict[str, Any]], ArrayLike],
    parameters: Mapping[str, Any],
    n: int = 200,
    coverage: float = 0.9,
    *,
    seed: int = 0,
) -> Band:
    """Band of a curve over draws of anything that goes into it: radii, clearance, preload, material.

    `bd.frequency_response(…, uncertainty=n)` does it for the layers' materials alone, without building the
    machine anew.

    Parameters
    ----------
    function
        Maps the parameters of a draw, a dict, to an array; of a complex one the magnitude counts.
    parameters
        As for `draw`.
    n
        Number of draws.
    coverage
        Share of further draws that the band covers at each place.
    seed
        Of the scrambling.

    Returns
    -------
    Band
        lower, median and upper, each of the curve's shape.

    Raises
    ------
    ValueError
        For too few draws for the coverage; naming the draw, where one is impossible or gives NaN.
    """
    require(callable(function), "function", function, "it must be a function of a draw's parameters, a dict")
    n = whole("n", n, 1, 10**7)
    band_of(np.zeros((n, 1)), coverage)
    curves = []
    for k, case in enumerate(draw(n, parameters, seed=seed)):
        try:
            y = np.asarray(function(dict(case)))
            require(y.dtype.kind in "iufc", "function", y.tolist(), "it must give numbers, the curve")
        except (ValueError, ArithmeticError) as error:
            raise ValueError(f"draw {k} is {said_of(case)}; {IMPOSSIBLE}; {error}") from error
        y = np.abs(y) if np.iscomplexobj(y) else y
        require(
            bool(np.isfinite(y).all()), f"draw {k}", said_of(case), f"its curve is not finite; {IMPOSSIBLE}"
        )
        curves.append(y)
    return band_of(np.array(curves), coverage)
