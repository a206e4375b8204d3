"""What a march can record: channels by name, as the core takes them."""

from __future__ import annotations

import re
from typing import TypeAlias

from bearingdyn import core
from bearingdyn.bearing.series import NET
from bearingdyn.system import QUANTITIES, RATES, System, is_rotation
from bearingdyn.types import Array

Channel: TypeAlias = tuple[int, Array | None, int, int]
"""kind, row (n,), bearing, index"""


def channel_of(system: System, name: str) -> tuple[Channel, str]:
    """Kind, row, bearing and index of a channel by name, as core.Model takes it, and its unit.

    Raises
    ------
    ValueError
        For a name that is no channel of this system; says what there is.
    """
    bearings = [b.name for b in system.bearings]
    head, _, rest = name.partition(".")
    if head in bearings:
        which = bearings.index(head)
        ball = re.fullmatch(r"ball(\d+)", rest)
        if rest == "loss":
            return (core.CHANNEL_KINDS["contact_loss"], None, which, 0), "W"
        if rest == "loaded":
            return (core.CHANNEL_KINDS["loaded"], None, which, 0), "1"
        if ball and 1 <= int(ball[1]) <= system.bearings[which].bearing.Z:
            return (core.CHANNEL_KINDS["ball"], None, which, int(ball[1]) - 1), "N"
        series = system.bearings[which].series
        term = NET["xyz".index(rest[-1])] if rest in ("force.x", "force.y", "force.z") else None
        if term in series.terms:
            return (core.CHANNEL_KINDS["force"], None, which, series.index(*term)), "N"
        raise ValueError(
            f"channel {name!r}: bearing {head!r} offers loaded, loss, ball1 … "
            f"ball{system.bearings[which].bearing.Z}, force.x, force.y and force.z"
        )
    if rest.startswith(("ball", "force.")) or rest in ("loaded", "loss"):
        raise ValueError(f"channel {name!r}: {head!r} is no bearing; there are {bearings}")
    place, _, quantity = name.rpartition(".")
    if quantity not in QUANTITIES:
        place, quantity = name, "displacement"
    unit = ("rad" if is_rotation(place) else "m") + RATES[quantity]
    return (core.CHANNEL_KINDS[quantity], system.row(place), 0, 0), unit
