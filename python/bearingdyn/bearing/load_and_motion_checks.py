"""Loads on a bearing and motions of its rings, checked against what machines have."""

from __future__ import annotations

import math

from bearingdyn.notice import BearingWarning, warn
from bearingdyn.plausible_ranges import plausible
from bearingdyn.types import Array


def check_load(field: str, load: Array) -> None:
    """Check each entry of a load (6,) on a bearing, N and N m, against what machines have."""
    for k, x in enumerate(load.tolist()):
        kind = "force" if k < 3 else "moment"
        plausible(kind, f"{field}[{k}], the {kind} along {'xyz'[k % 3]},", x)


LEAN = 0.01
"""Tilt of a bearing's rings against each other, rad, that is doubted: makers allow 2 to 10 minutes of arc,
0.0006 to 0.003 rad, and beyond some half a degree the balls climb to the shoulders."""


def warn_of_lean(tilt: float, who: str = "") -> None:
    """Check of a bearing's motion: warn of rings that lean against each other more than makers allow.

    Parameters
    ----------
    tilt
        Size of the tilt about an axis across the bearing's, rad.
    who
        What the message begins with.
    """
    if tilt > LEAN:
        warn(
            f"{who}its rings lean by {math.degrees(tilt):.2g}° against each other; deep groove bearings are "
            "allowed 2 to 10 minutes of arc, 0.17° at most, and angular contact bearings less: give the "
            "shaft a second bearing, or less moment; are moments in N m?",
            BearingWarning,
        )


def check_motion(field: str, q: Array) -> None:
    """Check each entry of a motion (3,) or (6,) of a ring, m and rad."""
    for k, x in enumerate(q.tolist()):
        plausible("displacement" if k < 3 else "tilt", f"{field}[{k}]", x)
