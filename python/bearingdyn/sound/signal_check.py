"""Signals of numbers evenly in time: the check that all measures of them share."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from bearingdyn.checks import positive, real
from bearingdyn.plausible_ranges import plausible
from bearingdyn.types import Array


def signal(field: str, given: ArrayLike) -> Array:
    """A signal (n,) of two finite samples or more, else ValueError."""
    remedy = "it must be samples (n,), two or more, finite"
    try:
        x = real(given)
    except (TypeError, ValueError):
        raise ValueError(f"{field} is no signal of numbers; {remedy}") from None
    if x.ndim != 1 or x.size < 2 or not bool(np.isfinite(x).all()):
        what = f"has shape {x.shape}" if x.ndim != 1 or x.size < 2 else "has a sample that is not finite"
        raise ValueError(f"{field} {what}; {remedy}")
    return x


def sample_rate(rate: float) -> float:
    """Check the rate of a signal: the value as a positive float; warns of what no sound is sampled at."""
    return plausible("sample rate", "rate", positive("rate", rate, "it must be samples a second"))
