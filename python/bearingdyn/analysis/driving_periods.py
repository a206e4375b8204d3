"""What drives a march, and how long one period of it lasts.

The shaft, loads, balls over waves and pits, and what they meet."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from bearingdyn import core
from bearingdyn.bearing import BearingKernel
from bearingdyn.system import System
from bearingdyn.types import Array


@dataclass(frozen=True, order=True)
class Rhythm:
    """A driving period: how long it lasts, s, and what drives the march with it."""

    period: float
    what: str


def rhythms(system: System, speed: float) -> list[Rhythm]:
    """All driving periods of a march of this system at a shaft speed, rad/s; the fastest first."""
    found: list[tuple[float, str]] = []
    for term in system.bearings:
        kernel = term.kernel()
        found += [
            (rate, f"{what} in bearing {term.name!r}") for rate, what in _of_bearing(kernel, abs(speed))
        ]
    for number, load in enumerate(system.loads, start=1):
        if not (np.any(load.p_cos) or np.any(load.p_sin)):
            continue
        of = f" of {load.part!r}" if load.part else ""
        if load.kind == "harmonic":
            found.append((abs(load.omega), f"load {number}{of}, {abs(load.omega) / (2 * math.pi):.6g} Hz"))
        elif load.kind == "rotating":
            found.append((abs(speed), f"unbalance, load {number}{of}"))
        elif load.kind == "sampled":
            found.append((_quickness(load.time, load.value), f"sampled load {number}{of}"))
    return sorted({Rhythm(2 * math.pi / float(rate), what) for rate, what in found if 0 < rate < math.inf})


def _of_bearing(kernel: BearingKernel, speed: float) -> list[tuple[float, str]]:
    """(angular frequency, name) of what passes in one bearing."""
    flaws = kernel.imperfections
    found = [(kernel.Z * _met(kernel, "outer", speed)[0], f"the passage of the {kernel.Z} balls")]
    kinds = {number: name for name, number in core.WAVE_KINDS.items()}
    for kind, order, _, amplitude, _ in flaws.waves:
        body, _, direction = kinds[int(kind)].partition("_")
        if amplitude == 0 or (body == "ball" and order % 2):
            continue
        of = "of the balls," if body == "ball" else f"of the {body} race, {direction},"
        found.append((order * _met(kernel, body, speed)[0], f"wave {of} order {int(order)}"))
    pits = {number: name for name, number in core.PIT_KINDS.items()}
    for kind, _, _, width, depth in flaws.pits:
        body = pits[int(kind)]
        # a ball drops in over this arc, and comes out over another; 'drop' in csrc/imperfection.c
        sunk = min(depth, flaws.ball_diameter / 2)
        ramp = min(width / 2, math.sqrt(sunk * (flaws.ball_diameter - sunk)))
        turning, radius = _met(kernel, body, speed)
        found.append((math.pi * radius * turning / ramp, f"pit of the {body}, {width:.3g} m wide,"))
    return found


def _met(kernel: BearingKernel, body: str, speed: float) -> tuple[float, float]:
    """Angular speed at which contacts run over the surface of a body, and its radius there."""
    flaws, cage = kernel.imperfections, kernel.cage_ratio * speed
    if body == "inner":
        return abs(kernel.inner_ratio * speed - cage), flaws.inner_radius
    if body == "outer":
        return abs(kernel.outer_ratio * speed - cage), flaws.outer_radius
    return abs(flaws.spin_ratio * speed), flaws.ball_diameter / 2


def _quickness(time: Array, value: Array) -> float:
    """Rms slope over rms value of a table linear between its points: of a sine its angular frequency."""
    if len(time) < 2:
        return 0.0
    dt, low, high = np.diff(time), value[:-1], value[1:]
    whole = dt.sum()
    mean = (dt * (low + high)).sum() / 2 / whole
    low, high = low - mean, high - mean
    square = (dt * (low**2 + low * high + high**2)).sum() / 3
    slope = ((high - low) ** 2 / dt).sum()
    return float(math.sqrt(slope / square)) if square > 0 else 0.0
