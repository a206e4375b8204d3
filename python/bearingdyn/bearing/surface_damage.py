"""Named kinds of damage to a surface, a spall and a dent, as objects of `imperfections`."""

from __future__ import annotations

import math

from bearingdyn.bearing.imperfections import Body, Pit
from bearingdyn.checks import positive, require
from bearingdyn.plausible_ranges import plausible


def spall(body: Body, angle: float, length: float, depth: float, *, ball: int = 1) -> Pit:
    """Damage by flaking: a spall with a flat bottom, `length` along the rolling direction, `depth` deep.

    A ball drops to the bottom if the spall is long enough, 2√(Dw depth) or more.

    Parameters
    ----------
    body
        "inner", "outer" or "ball".
    angle
        Of its centre on the body, rad, as in `Pit`.
    length
        Along the rolling direction, m.
    depth
        Into the surface, m.
    ball
        Which ball carries it, from 1.
    """
    return Pit(body, angle, length, depth, ball)


def dent(body: Body, angle: float, width: float, particle: float, *, ball: int = 1) -> Pit:
    """Damage by a hard round particle of the diameter `particle`: a dent, `width` across.

    As deep as the cap of that sphere, (particle − √(particle² − width²))/2. The rim around it is left out.

    Parameters
    ----------
    body
        "inner", "outer" or "ball".
    angle
        Of its centre on the body, rad, as in `Pit`.
    width
        Across, m.
    particle
        Diameter of the particle, m.
    ball
        Which ball carries it, from 1.

    Raises
    ------
    ValueError
        If the dent is wider than the particle.
    """
    width = positive("width", width, "it must be positive and finite, in m")
    particle = plausible("pit width", "particle", positive("particle", particle))
    require(
        width <= particle,
        "width",
        width,
        f"it must not exceed the particle, {particle!r} m",
    )
    # without the difference of nearly equal numbers
    depth = width**2 / (2 * (particle + math.sqrt(particle**2 - width**2)))
    return Pit(body, angle, width, depth, ball)
