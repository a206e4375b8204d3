"""Bands of curves, and objectives that hold over draws."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from bearingdyn.analysis import Band, band_of
from bearingdyn.checks import named, nonnegative, number, one_of, require
from bearingdyn.study.cases import label
from bearingdyn.study.distributions import draw
from bearingdyn.study.sweep import Study


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
    band_of(np.zeros((max(int(n), 0), 1)), coverage)
    curves = []
    for k, case in enumerate(draw(n, parameters, seed=seed)):
        try:
            y = np.asarray(function(dict(case)))
        except (ValueError, ArithmeticError) as error:
            raise ValueError(f"draw {k} is {_said(case)}; {_IMPOSSIBLE}; {error}") from error
        y = np.abs(y) if np.iscomplexobj(y) else y
        require(
            bool(np.isfinite(y).all()), f"draw {k}", _said(case), f"its curve is not finite; {_IMPOSSIBLE}"
        )
        curves.append(y)
    return band_of(np.array(curves), coverage)


@dataclass(frozen=True)
class Robust:
    """An objective over a band of draws: mean ± k standard deviations of each value, or a quantile.

    Called with a design, it returns what each value of `function` is at worst: high, unless `worst` says
    "low" of it. The draws are the same for every design, so that the result is as smooth as the function.

    Parameters
    ----------
    function
        Maps design and draw together, a dict, to a mapping of real numbers, as for `sweep`.
    parameters
        What is drawn, as for `draw`. A parameter of the same name as one of the design is an offset from it.
    n
        Number of draws.
    k
        Number of standard deviations; or
    quantile
        the share of draws that are no worse, between 0 and 1. Give one of the two.
    worst
        "high" or "low" by value; "high" unless given.
    seed
        Of the scrambling.

    Raises
    ------
    ValueError
        For both of k and quantile, or none; when called, naming the draw that is impossible.
    """

    function: Study
    parameters: Mapping[str, Any]
    n: int = 64
    k: float | None = None
    quantile: float | None = None
    worst: Mapping[str, str] = field(default_factory=dict)
    seed: int = 0

    def __post_init__(self) -> None:
        remedy = f"with quantile={self.quantile!r}; give exactly one of the two"
        require((self.k is None) != (self.quantile is None), "k", self.k, remedy)
        if self.k is not None:
            nonnegative("k", self.k, "it must be a number of standard deviations, zero or positive")
        else:
            share = number("quantile", self.quantile)
            require(0 < share < 1, "quantile", share, "it must be a share between 0 and 1, as 0.95")
        for name, side in named("worst", self.worst, "give 'high' or 'low' by value").items():
            one_of(f"worst[{name!r}]", side, ("high", "low"))
        draw(1, self.parameters, seed=self.seed)

    def __call__(self, design: Mapping[str, Any]) -> dict[str, float]:
        """What each value is at worst, for this design."""
        rows = []
        for k, drawn in enumerate(draw(self.n, self.parameters, seed=self.seed)):
            offsets = {name: design[name] + x if name in design else x for name, x in drawn.items()}
            case = {**design, **offsets}
            try:
                rows.append(dict(self.function(case)))
            except (ValueError, ArithmeticError) as error:
                raise ValueError(f"draw {k} is {_said(case)}; {_IMPOSSIBLE}; {error}") from error
            for name, value in rows[-1].items():
                bad = f"it is NaN or infinite; {_IMPOSSIBLE}; it has {_said(case)}"
                require(bool(np.isfinite(value)), f"{name} of draw {k}", value, bad)
        worst = {}
        for name in rows[0]:
            y = np.array([row[name] for row in rows])
            sign = -1.0 if self.worst.get(name, "high") == "low" else 1.0
            if self.k is not None:
                worst[name] = float(y.mean() + sign * self.k * y.std(ddof=1))
            else:
                share = float(self.quantile or 0.0)
                worst[name] = float(np.quantile(y, share if sign > 0 else 1 - share))
        return worst


_IMPOSSIBLE = "the draw is impossible: narrow the distribution, or cut it with low= and high="


def _said(case: Mapping[str, Any]) -> str:
    return ", ".join(f"{name} = {label(value)}" for name, value in case.items())
