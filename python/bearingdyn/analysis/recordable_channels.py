"""What a march can record: channels by name, as the core takes them."""

from __future__ import annotations

import re
from typing import TypeAlias

from bearingdyn import core
from bearingdyn.analysis.softening import layer_names, softening_layers
from bearingdyn.application import COMPONENTS, QUANTITIES, Channel
from bearingdyn.bearing import NET
from bearingdyn.system import System
from bearingdyn.types import Array

CoreChannel: TypeAlias = tuple[int, Array | None, int, int]
"""kind, row (n,), bearing, index"""


def channel_of(system: System, name: str) -> tuple[CoreChannel, str]:
    """A recordable channel by its name, as the core numbers them: kind, row, bearing, index; and its unit.

    Raises
    ------
    ValueError
        For an unknown channel of this system; says what there is.
    """
    bearings = [b.name for b in system.bearings]
    channel = Channel.parse(name)
    head = next((b for b in bearings if f"{name}.".startswith(f"{b}.")), None)
    if head is not None:
        which = bearings.index(head)
        series, Z = system.bearings[which].series, system.bearings[which].bearing.Z
        if channel.at == head and channel.quantity == "force" and channel.component in COMPONENTS[:3]:
            term = NET[COMPONENTS.index(channel.component)]
            if term in series.terms:
                return (core.CHANNEL_KINDS["force"], None, which, series.index(*term)), "N"
        elif channel.at == head and not channel.quantity:
            ball = re.fullmatch(r"ball(\d+)", channel.component)
            if channel.component == "loss":
                return (core.CHANNEL_KINDS["contact_loss"], None, which, 0), "W"
            if channel.component == "loaded":
                return (core.CHANNEL_KINDS["loaded"], None, which, 0), "1"
            if ball and 1 <= int(ball[1]) <= Z:
                return (core.CHANNEL_KINDS["ball"], None, which, int(ball[1]) - 1), "N"
        raise ValueError(
            f"channel {name!r}: bearing {head!r} offers loaded, loss, ball1 … ball{Z}, force.x, force.y and "
            f"force.z"
        )
    if channel.quantity == "force" or re.fullmatch(r"loaded|loss|ball\d*", channel.component):
        raise ValueError(f"channel {name!r}: {channel.at!r} is not a bearing; there are {bearings}")
    if channel.component == "strain" and not channel.quantity:
        soft = {name: k for name, k in zip(layer_names(system), softening_layers(system), strict=True)}
        if channel.at not in soft:
            raise ValueError(
                f"channel {name!r}: {channel.at!r} has no law of softening; those that have: {sorted(soft)}"
            )
        return (core.CHANNEL_KINDS["strain"], None, 0, soft[channel.at]), "1"
    kind = core.CHANNEL_KINDS[channel.quantity or QUANTITIES[0]]
    return (kind, system.row(channel), 0, 0), channel.motion_unit()
