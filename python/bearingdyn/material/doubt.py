"""One doubt about a rubber: a thing that is not known, its nominal value and how far it may be off."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np
import scipy
from numpy.typing import ArrayLike

from bearingdyn.checks import number, one_of, real, require
from bearingdyn.types import Array

SIGMA = 2.0
"""Standard deviations from the nominal value to the ends of a normal source."""


@dataclass(frozen=True)
class Doubt:
    """One of the doubts about a rubber: a thing that is not known, and how far it may be off.

    Parameters
    ----------
    name
        "level", "specimen", "K", "temperature", "relaxed", "fit" or "loss".
    nominal
        Its value in the material as it is.
    low, high
        Ends of the interval: of kind "interval" the value lies anywhere between; of kind "normal" they are
        two standard deviations away.
    source
        Where the interval comes from, in words.
    kind
        "interval" or "normal".
    unit
        "1" for factors.
    """

    name: str
    nominal: float
    low: float
    high: float
    source: str
    kind: Literal["interval", "normal"] = "interval"
    unit: str = "1"

    def __post_init__(self) -> None:
        one_of("Doubt.kind", self.kind, ("interval", "normal"))
        for name in ("nominal", "low", "high"):
            number(f"Doubt.{name}", getattr(self, name))
        remedy = f"low ≤ nominal ≤ high must hold, and low < high; nominal is {self.nominal:g}"
        require(
            self.low <= self.nominal <= self.high and self.low < self.high,
            f"doubt {self.name!r}",
            (self.low, self.high),
            remedy,
        )

    def quantile(self, u: ArrayLike) -> Array:
        """Value below which it lies with probability u, 0 < u < 1, any shape."""
        p = real(u)
        require(bool(np.all((p > 0) & (p < 1))), "u", u, "it must lie between 0 and 1")
        if self.kind == "interval":
            return np.asarray(self.low + (self.high - self.low) * p)
        z = scipy.special.ndtri(p) / SIGMA
        return np.asarray(
            self.nominal + np.where(z < 0, self.nominal - self.low, self.high - self.nominal) * z
        )
