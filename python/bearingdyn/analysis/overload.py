"""Overload: whether the bearings of a motion bore what they were asked to, at every one of its moments."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from bearingdyn import core
from bearingdyn.analysis.equilibrium import Equilibrium
from bearingdyn.analysis.march import March
from bearingdyn.bearing import STATIC_PRESSURE, BallBearing
from bearingdyn.notice import BearingWarning, warn
from bearingdyn.system import BearingTerm
from bearingdyn.types import Complex

SAMPLES = 24
"""Moments of a cycle at which the balls of a linear response are looked at."""


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


def warn_of_swings(eq: Equilibrium, swings: Complex, places: Sequence[str]) -> None:
    """Warn of an overload: bearings whose balls a linear response about an equilibrium presses too hard.

    The rings' motion is the linear one, the balls' loads in it are those of Hertz.

    Parameters
    ----------
    eq
        About which the rings move.
    swings
        (k, m), m, zero-to-peak, of the coefficients of all bearings.
    places
        Of each which response it is, such as "in the response at 100 rad/s".

    Warns
    -----
    BearingWarning
        As `warn_of_overload`; the heaviest ball of each bearing.
    """
    turns = np.exp(2j * math.pi * np.arange(SAMPLES) / SAMPLES)
    at = 0
    for term in eq.system.bearings:
        rest, kernel = eq.bearings[term.name].z, term.kernel()
        own = swings[:, at : at + len(rest)]
        at += len(rest)
        z = rest + (own[:, None, :] * turns[:, None]).real.reshape(-1, len(rest))
        angle = np.zeros((len(z), 4))
        angle[:, 0] = kernel.angle0
        along = core.bearing_along(kernel, z, np.zeros_like(z), angle, np.zeros(4), tangents=False)
        peaks = along.loads.reshape(len(swings), -1).max(axis=1, initial=0.0)
        if peaks.size:
            worst = int(np.argmax(peaks))
            warn_of_peak(term, float(peaks[worst]), places[worst])


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
