"""Contact pressures that no bearing bears: above the static rating a warning, far above it a refusal."""

from __future__ import annotations

from typing import Protocol

import numpy as np

from bearingdyn.bearing.hertz import PointContact
from bearingdyn.notice import BearingWarning, warn
from bearingdyn.plausible_ranges import MAGNITUDES, plausible
from bearingdyn.types import Array

STATIC_PRESSURE = MAGNITUDES["pressure"].usual[1]
"""Contact pressure that defines the static rating of a ball bearing (ISO 76), Pa."""


class Contacts(Protocol):
    """What a bearing must tell for its contact pressure to be checked."""

    @property
    def inner_contact(self) -> PointContact:
        """Of a ball with the inner race."""

    @property
    def outer_contact(self) -> PointContact:
        """Of a ball with the outer race."""

    @property
    def static_rating(self) -> float:
        """Radial static rating, N."""


def check_pressure(race: str, p: Array, who: str = "", rating: float | None = None) -> None:
    """Check the contact pressure of the balls on one race, largest (Z,), Pa.

    Warns
    -----
    BearingWarning
        Above 4.2 GPa (ISO 76); the ball is named, counted from 1.

    Raises
    ------
    ValueError
        Above five times that, and where a pressure has overflowed.
    """
    limit, static = MAGNITUDES["pressure"].possible[1], STATIC_PRESSURE
    if (p <= static).all():
        return
    j = int(np.argmax(np.nan_to_num(p, nan=np.inf)))
    text = f"{who}ball {j + 1}: {p[j] / 1e9:.3g} GPa on the {race} race"
    known = "" if rating is None else f"; the bearing's static radial rating is {rating:.3g} N"
    if not p[j] <= limit:
        raise ValueError(
            f"{text}; it must be at most {limit / 1e9:g} GPa (five times what the static rating allows, "
            f"harder than any ball){known}; are the loads in N and the lengths in m?"
        )
    over = int(np.count_nonzero(p > static))
    others = f", and {over - 1} more above it" if over > 1 else ""
    warn(f"{text}, over 4.2 GPa (ISO 76){others}{known}", BearingWarning)


def check_bearing_pressure(bearing: Contacts, loads: Array, who: str = "") -> None:
    """Check the contact pressures of a bearing by the heavier contact of its balls.

    Parameters
    ----------
    bearing
        With its contacts and static rating.
    loads
        Of the balls (Z,), N.
    who
        What the message begins with.
    """
    peaks = {"inner": bearing.inner_contact.pressure(1.0), "outer": bearing.outer_contact.pressure(1.0)}
    race = max(peaks, key=peaks.__getitem__)
    p = peaks[race] * np.cbrt(loads)
    if not (p <= STATIC_PRESSURE).all():
        check_pressure(race, p, who, bearing.static_rating)


def check_light(bearing: Contacts, loads: Array, what: str = "load") -> None:
    """Check that loads of the balls, any shape, N, are no bearing's in kN.

    Parameters
    ----------
    bearing
        With its contacts and static rating.
    loads
        Of the balls, N.
    what
        What the message begins with.

    Warns
    -----
    UnusualMagnitude
        Where the most loaded ball bears less than 5e-4 of what the static rating allows.
    """
    Q = float(loads.max(initial=0.0))
    if not Q > 0:
        return
    highest = max(bearing.inner_contact.pressure(Q), bearing.outer_contact.pressure(Q))
    share = (highest / STATIC_PRESSURE) ** 3
    text = f"{what}: the heaviest ball bears {Q:.3g} N; over what the static rating allows, that"
    plausible("share of the static rating", text, share, hint="; is the load in kN?")
