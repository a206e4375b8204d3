"""Where the table has its solutions.

A narrow contact turns from two rigid bodies on a film into a Hertz contact at a higher M than a round one,
M ≈ 3.5 D^−0.59, and there everything changes fast. The load axis x is the share of the way, in ln M, from
well below that turn (x = 0, K0 under a hundredth) to the heaviest load (x = 1): the turn is at x ≈ 0.2
for every D.
"""

from __future__ import annotations

import math

HIGHEST = 5000.0
"""M at x = 1."""
_LOWEST, _SLOPE = math.log(0.5), -0.68  # ln M at x = 0 over ln D

L = (2.5, 5.0, 10.0, 15.0, 20.0, 22.5, 25.0)
D = (0.02, 0.037, 0.07, 0.25, 1.0)
_TURN = (
    0.0,
    0.05,
    0.1,
    0.12,
    0.14,
    0.1575,
    0.175,
    0.1925,
    0.21,
    0.2275,
    0.245,
    0.2625,
    0.28,
    0.3,
    0.32,
    0.37,
    0.43,
)
_LOADED = (52.0, 100.0, 192.0, 370.0, 709.0, 1360.0, HIGHEST)


def loads(ratio: float) -> tuple[float, ...]:
    """Places of the table for one D: the loads M at which it has solutions, increasing."""
    low = lowest(math.log(ratio))
    turn = [float(f"{math.exp(low + x * (math.log(HIGHEST) - low)):.4g}") for x in _TURN]
    return (*turn, *(M for M in _LOADED if M > 1.2 * turn[-1]))


def turning_load(ratio: float) -> float:
    """Place of the table's turn: M where a contact of the ratio D turns from rigid bodies to Hertz."""
    return float(3.5 * ratio**-0.59)


def lowest(log_D: float) -> float:
    """Lowest place of the table: ln M at x = 0."""
    return _LOWEST + _SLOPE * log_D


def place(log_M: float, log_D: float) -> float:
    """Place x of a load in the table."""
    low = lowest(log_D)
    return (log_M - low) / (math.log(HIGHEST) - low)
