"""Whether the bearings of a march bore what they were asked to, in every one of its steps."""

from __future__ import annotations

from bearingdyn import core
from bearingdyn.analysis.march import March
from bearingdyn.bearing import STATIC_PRESSURE, BallBearing
from bearingdyn.notice import BearingWarning, warn


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
        bearing = term.bearing
        if not isinstance(bearing, BallBearing):
            continue
        pressure = bearing.pressure(peak)
        if pressure > STATIC_PRESSURE:
            warn(
                f"bearing {term.name!r}: a ball bore {peak:.4g} N in this march, {pressure / 1e9:.3g} GPa, "
                f"over {STATIC_PRESSURE / 1e9:g} GPa (ISO 76); its static radial rating is "
                f"{bearing.static_rating:.3g} N: are the loads, the unbalance and the speed in SI units?",
                BearingWarning,
            )
