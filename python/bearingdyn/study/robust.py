"""Robust objectives: what a design is at worst over draws of what is not exactly known."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from bearingdyn.checks import named, nonnegative, number, one_of, require
from bearingdyn.pictures import page
from bearingdyn.study.chunks import Study
from bearingdyn.study.distributions import IMPOSSIBLE, draw, said_of


@dataclass(frozen=True)
class Robust:
    """A robust objective over draws: mean ± k standard deviations of each value, or a quantile.

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

    _repr_html_ = page

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
                raise ValueError(f"draw {k} is {said_of(case)}; {IMPOSSIBLE}; {error}") from error
            for name, value in rows[-1].items():
                bad = f"it is NaN or infinite; {IMPOSSIBLE}; it has {said_of(case)}"
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
