"""Whether a step follows what drives a march, said before it runs; and how far off it was, afterwards."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from bearingdyn import core
from bearingdyn.bearing import BearingKernel
from bearingdyn.notice import CoarseStep, warn
from bearingdyn.system import System
from bearingdyn.types import Array

# most of a period that a step may be: the average acceleration's frequencies are short by (ωΔt)²/12, 0.8 % at
# this share, which grows with its square; measured forced amplitudes are 24 % off at 0.17
SHARE = 0.05
NAMED = 12  # lines of a warning; the fastest come first
CHECKED = 2000  # steps of the stretch that is repeated at half the step
STEP_ERROR_MADE = (
    f"{CHECKED} steps beyond the end, at dt and at dt/2 from the same state: 4/3 of the rms difference over "
    "the rms of the channel about its mean (the scheme is of second order)"
)


@dataclass(frozen=True, order=True)
class Rhythm:
    """Something that drives a march: how long one period lasts, s, and what it is."""

    period: float
    what: str


def rhythms(system: System, speed: float) -> list[Rhythm]:
    """Everything that drives a march of this system at a shaft speed, rad/s; the fastest first."""
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


def warn_if_coarse(system: System, speed: float, dt: float) -> None:
    """Warn of everything that a period of at most dt/SHARE drives, at a shaft speed, rad/s."""
    coarse = [r for r in rhythms(system, speed) if not dt <= SHARE * r.period]
    if not coarse:
        return
    enough = _rounded_down(SHARE * coarse[0].period)
    lines = [
        f"  {r.what}: period {r.period:.3g} s, {r.period / dt:.3g} steps a period; "
        f"dt={_rounded_down(SHARE * r.period):g} would do"
        for r in coarse[:NAMED]
    ]
    if len(coarse) > NAMED:
        lines.append(f"  and {len(coarse) - NAMED} more, slower ones")
    warn(
        f"dt = {dt:g} s is too coarse for what drives this march at {abs(speed):.6g} rad/s:\n"
        + "\n".join(lines)
        + f"\nmarch with dt={enough:g} or less; check_step=True says how far off the record is",
        CoarseStep,
    )


def _rounded_down(value: float) -> float:
    """Two digits, never more than the value."""
    unit = 10.0 ** (math.floor(math.log10(value)) - 1)
    return float(f"{math.floor(value / unit * (1 + 1e-12)) * unit:.2g}")


def step_error(model: core.Model, state: Array, stepping: core.Stepping) -> Array:
    """Error of each channel that the step leaves, (channels,), relative; NaN where a channel stands still.

    From the state at the end of a march CHECKED steps go on, once with the step and once with half of it. The
    scheme is of second order, so that 4/3 of the difference (rms) is the error of the coarser one
    (Richardson); it is put over the channel's own rms about its mean.
    """
    plain = replace(stepping, audit=False)
    half = replace(plain, dt=plain.dt / 2)
    # both start their own count, so that both begin without an old Newton matrix
    coarse, _, _ = core.march(model, state.copy(), plain, CHECKED)
    fine, _, report = core.march(model, state.copy(), half, 2 * CHECKED, 2)
    if len(coarse) != CHECKED or report.status != 0:
        return np.full(coarse.shape[1], np.nan)
    size = np.std(fine, axis=0)
    error = 4 / 3 * np.sqrt(np.mean((coarse - fine) ** 2, axis=0))
    return np.asarray(np.divide(error, size, out=np.full_like(size, np.nan), where=size > 0))
