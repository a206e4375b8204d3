"""Axes of a phase: where it is unwrapped to, its ticks and its label."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from bearingdyn.plot.frame import (
    finish,
)
from bearingdyn.types import Array, Complex

if TYPE_CHECKING:
    from matplotlib.axes import Axes


# °; a phase begins in the turn below it
PHASE_END = 135.0
SMALL_PHASE = 15.0  # °; the axes of a phase show at least that much


def continuous_phase(response: Complex) -> Array:
    """Unwrapped phase, °, for its axis: the first value is in the turn below PHASE_END."""
    degrees = np.degrees(np.unwrap(np.angle(response)))
    return np.asarray(degrees - 360.0 * np.ceil((degrees[0] - PHASE_END) / 360.0))


def finish_phase(ax: Axes) -> None:
    """Finish the axis of a phase, °: label, frame, ticks at right angles where it turns that far."""
    from matplotlib.ticker import MultipleLocator

    ax.set_ylabel("phase, °")
    low, high = ax.get_ylim()
    if high - low < SMALL_PHASE:
        low, high = ((low + high + side * SMALL_PHASE) / 2 for side in (-1, 1))
        ax.set_ylim(low, high)
    step = next((s for s in (5, 10, 15, 30, 45) if high - low <= 4 * s), 90)
    ax.yaxis.set_major_locator(MultipleLocator(step * max(1, math.ceil((high - low) / 540))))
    finish(ax)
