"""Bounds of the parameters of a Maxwell model, by the names a user gives them."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from bearingdyn.checks import number, two
from bearingdyn.types import Array


@dataclass(frozen=True)
class Limits:
    """Bounds of a fit: strengths (spring, branches, dashpot; n + 2) and ln τ (n); equal where fixed."""

    lower: Array
    upper: Array
    log_lower: Array
    log_upper: Array

    @property
    def plain(self) -> bool:
        """Whether no branch has bounds of its own."""
        return bool(
            not self.lower[1:-1].any()
            and np.isinf(self.upper[1:-1]).all()
            and np.all(self.log_lower == self.log_lower[0])
            and np.all(self.log_upper == self.log_upper[0])
        )

    def alike(self, n: int) -> Limits:
        """Limits of n branches without bounds of their own, the ends as here; these limits if n is theirs."""
        if n == self.log_lower.size:
            return self
        return Limits(
            np.concatenate([self.lower[:1], np.zeros(n), self.lower[-1:]]),
            np.concatenate([self.upper[:1], np.full(n, np.inf), self.upper[-1:]]),
            np.full(n, self.log_lower.min()),
            np.full(n, self.log_upper.max()),
        )

    @classmethod
    def of(
        cls,
        n: int,
        span: tuple[float, float],
        bounds: Mapping[str, tuple[float, float]],
        fixed: Mapping[str, float],
    ) -> Limits:
        """From bounds and fixed values by name: G0, G1 …, tau1 …, eta0; SI units.

        ValueError naming a parameter that does not exist, an empty range, or a value out of range.
        """
        strengths = ["G0", *(f"G{i + 1}" for i in range(n)), "eta0"]
        times = [f"tau{i + 1}" for i in range(n)]
        lower, upper = np.zeros(n + 2), np.full(n + 2, np.inf)
        log_lower, log_upper = np.full(n, span[0]), np.full(n, span[1])
        both = set(bounds) & set(fixed)
        if both:
            raise ValueError(f"{sorted(both)}: both in bounds and in fixed: give one")
        remedy = "it must be a lower and an upper value, both >= 0"
        wanted = {name: two(f"bounds[{name!r}]", pair, remedy) for name, pair in bounds.items()}
        held = {name: number(f"fixed[{name!r}]", value) for name, value in fixed.items()}
        wanted |= {name: (value, value) for name, value in held.items()}
        for name, pair in wanted.items():
            what = "fixed" if name in fixed else "bounds"
            if name not in strengths and name not in times:
                raise ValueError(
                    f"{what}: {name!r} is no parameter: there are {', '.join(strengths + times)}"
                )
            if len(pair) != 2 or not 0 <= pair[0] <= pair[1] or math.isnan(pair[1]) or math.isinf(pair[0]):
                raise ValueError(
                    f"{what}[{name!r}] is {pair!r}; it must be a lower and an upper value, both >= 0"
                )
            if name in strengths:
                lower[strengths.index(name)], upper[strengths.index(name)] = pair
            else:
                if not pair[1] > 0 or (name in fixed and not pair[0] > 0):
                    raise ValueError(f"{what}[{name!r}] is {pair!r} s; a relaxation time must be positive")
                i = times.index(name)
                log_lower[i] = math.log(pair[0]) if pair[0] > 0 else min(span[0], math.log(pair[1]) - 1)
                log_upper[i] = math.log(pair[1]) if math.isfinite(pair[1]) else max(span[1], log_lower[i])
        return cls(lower, upper, log_lower, log_upper)
