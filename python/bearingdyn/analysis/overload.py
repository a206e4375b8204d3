"""Overload: whether the bearings of a motion bore what they were asked to, at every one of its moments."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from bearingdyn import core
from bearingdyn.analysis.equilibrium import Equilibrium
from bearingdyn.analysis.march import March
from bearingdyn.bearing import STATIC_PRESSURE, BallBearing, BearingKernel
from bearingdyn.notice import BearingWarning, warn
from bearingdyn.system import BearingTerm
from bearingdyn.types import Array, Complex

SAMPLES = 24
"""Moments of a cycle at which the balls of a linear response are looked at."""
TOGETHER = 64
"""Swings whose moments are computed at once, the widest first."""


def warn_of_overload(march: March, report: core.Report) -> None:
    """Warn of every bearing that a march overloaded: contacts over 4.2 GPa (ISO 76) in a step.

    Parameters
    ----------
    march, report
        As they ended. The report keeps the largest load of one ball of each bearing.

    Warns
    -----
    BearingWarning
        Naming the bearing, its pressure and its static rating.
    """
    for term, peak in zip(march.modal.bearings, report.peaks, strict=False):
        warn_of_peak(term, peak, "in this march")


def warn_of_swings(eq: Equilibrium, swings: Complex, place: Callable[[int], str]) -> None:
    """Warn of an overload: bearings whose balls a linear response about an equilibrium presses too hard.

    The rings' motion is the linear one, the balls' loads in it are those of Hertz.

    Parameters
    ----------
    eq
        About which the rings move.
    swings
        (k, m), m, zero-to-peak, of the coefficients of all bearings.
    place
        Tells of each which response it is, such as "in the response at 100 rad/s".

    Warns
    -----
    BearingWarning
        As `warn_of_overload`; the heaviest ball of each bearing.
    """
    at = 0
    for term in eq.system.bearings:
        rest, bearing = eq.bearings[term.name].z, term.bearing
        own = swings[:, at : at + len(rest)]
        at += len(rest)
        if isinstance(bearing, BallBearing) and len(own):
            peak, worst = _worst(term.kernel(), bearing.static_ball_load, rest, own)
            warn_of_peak(term, peak, place(worst))


def _worst(kernel: BearingKernel, limit: float, rest: Array, swings: Complex) -> tuple[float, int]:
    """Largest load of a ball, N, and which swing (k, n) about `rest` brings it; any below the limit.

    A ball comes nearer by no more than its raceways move, so that most swings need no look at their moments.
    """
    approach = _approach(kernel, float(_loads(kernel, rest[None]).max(initial=0.0)))
    radial, axial = (np.abs(swings[:, kernel.axial == way]).sum(axis=1) for way in (0, 1))
    reach = approach + np.hypot(radial, axial)
    peak, worst = 0.0, 0
    turns = np.exp(2j * math.pi * np.arange(SAMPLES) / SAMPLES)[:, None]
    order = np.argsort(-reach, kind="stable")
    for some in np.split(order, range(TOGETHER, len(order), TOGETHER)):
        some = some[reach[some] >= _approach(kernel, max(limit, peak))]
        if not some.size:
            break
        z = rest + (swings[some][:, None] * turns).real
        peaks = _loads(kernel, z.reshape(-1, len(rest))).reshape(len(some), -1).max(axis=1)
        if peaks.max() > peak:
            peak, worst = float(peaks.max()), int(some[np.argmax(peaks)])
    return peak, worst


def _loads(kernel: BearingKernel, z: Array) -> Array:
    """Loads of the balls (s, Z), N, at coefficients z (s, n) of the raceways that do not move."""
    angle = np.zeros((len(z), 4))
    angle[:, 0] = kernel.angle0
    still = np.zeros_like(z)
    return core.bearing_along(kernel, z, still, angle, np.zeros(4), tangents=False).loads


def _approach(kernel: BearingKernel, load: float) -> float:
    """How far the raceways press into a ball that bears a load, N, with its film, m."""
    return float((load / kernel.kappa) ** (2 / 3) + kernel.give * load)


def warn_of_peak(term: BearingTerm, peak: float, where: str) -> None:
    """Warn of a bearing that a motion overloaded.

    Parameters
    ----------
    term, peak
        The bearing, and the largest load of one of its balls, N.
    where
        Which motion it was, such as "in the steady motion at 100 rad/s".

    Warns
    -----
    BearingWarning
        As `warn_of_overload`.
    """
    bearing = term.bearing
    if not isinstance(bearing, BallBearing):
        return
    pressure = bearing.pressure(peak)
    if pressure <= STATIC_PRESSURE:
        return
    warn(
        f"bearing {term.name!r}: a ball bore {peak:.4g} N {where}, {pressure / 1e9:.3g} GPa, "
        f"over {STATIC_PRESSURE / 1e9:g} GPa (ISO 76); its static radial rating is "
        f"{bearing.static_rating:.3g} N: are the loads, the unbalance and the speed in SI units?",
        BearingWarning,
    )
