"""What a bearing's surfaces excite: waviness, localised defects, balls of unequal size.

Waves and pits ride on the body that carries them: a race turns with its ring (which one turns is said by the
bearing's `turning`), a ball spins about its own axis. Each shifts the contact, and its rate enters the
contact's damping.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, fields
from typing import Literal

import numpy as np

from bearingdyn import core
from bearingdyn.checks import items, one_of, positive, require, whole
from bearingdyn.plausible_ranges import plausible
from bearingdyn.short_repr import short
from bearingdyn.types import Array

Body = Literal["inner", "outer", "ball"]
BODIES = tuple(core.PIT_KINDS)


@dataclass(frozen=True)
class Waviness:
    """An imperfection of a race or ball: one wave, amplitude·cos(order·angle + phase), around it.

    Parameters
    ----------
    body
        "inner" or "outer", which turn with their ring, or "ball".
    order
        Waves per turn, ≥ 0. Of a ball, odd orders keep its diameter and excite nothing.
    amplitude
        m, displacement of the surface: of a race along +r or +z, of a ball outwards.
    phase
        rad, at the angle 0 of the body.
    direction
        "radial" or "axial", of a race.
    ball
        Which ball carries it, from 1; None: every ball, in phase.

    Raises
    ------
    ValueError
        Naming the field, its value and what would be right.

    References
    ----------
    J. A. Wensing, On the Dynamics of Ball Bearings, University of Twente, 1998.
    """

    body: Body
    order: int
    amplitude: float
    phase: float = 0.0
    direction: Literal["radial", "axial"] = "radial"
    ball: int | None = None

    def __post_init__(self) -> None:
        one_of("waviness.body", self.body, BODIES)
        waves = isinstance(self.order, int) and not isinstance(self.order, bool) and self.order >= 0
        require(waves, "waviness.order", self.order, "it must be a whole number of waves, zero or more")
        plausible("wave order", "waviness.order", self.order)
        plausible("waviness", "waviness.amplitude", self.amplitude, "it must be a finite length in m")
        plausible("angle", "waviness.phase", self.phase, "it must be a finite angle in rad")
        one_of("waviness.direction", self.direction, ("radial", "axial"))
        if self.ball is not None:
            remedy = 'it names a ball from 1, with body "ball"'
            whole("waviness.ball", self.ball, 1, remedy=remedy)
            require(self.body == "ball", "waviness.ball", self.ball, remedy)

    def rows(self, Z: int) -> list[tuple[float, ...]]:
        """(kind, order, ball, amplitude, phase) as the core takes them."""
        if self.body == "ball":
            kind = float(core.WAVE_KINDS["ball"])
            if self.ball is not None:
                require(self.ball <= Z, "waviness.ball", self.ball, f"the bearing has {Z} balls")
            balls = range(Z) if self.ball is None else [self.ball - 1]
            return [(kind, float(self.order), float(j), self.amplitude, self.phase) for j in balls]
        kind = float(core.WAVE_KINDS[f"{self.body}_{self.direction}"])
        return [(kind, float(self.order), 0.0, self.amplitude, self.phase)]


@dataclass(frozen=True)
class Pit:
    """Imperfection of a race, a pit: a ball drops into it by min(depth, D/2 − √(D²/4 − (width/2 − |s|)²)).

    s is the arc from its centre. The drop is continuous, and a ball cannot reach the bottom of a narrow pit.

    Parameters
    ----------
    body
        "inner", "outer" or "ball"; a pit on a ball meets each race once per spin.
    angle
        rad, of its centre on the body, from x towards y at time 0.
    width, depth
        m, along the rolling direction, and into the surface.
    ball
        Which ball carries it, from 1, with body "ball".

    Raises
    ------
    ValueError
        Naming the field, its value and what would be right.
    """

    body: Body
    angle: float
    width: float
    depth: float
    ball: int = 1

    def __post_init__(self) -> None:
        one_of("defects.body", self.body, BODIES)
        plausible("angle", "defects.angle", self.angle, "it must be a finite angle in rad")
        for name in ("width", "depth"):
            field, value = f"defects.{name}", getattr(self, name)
            plausible(f"pit {name}", field, positive(field, value, "it must be a positive length in m"))
        whole("defects.ball", self.ball, 1, remedy="balls are counted from 1")

    def row(self, Z: int) -> tuple[float, ...]:
        """(kind, ball, angle, width, depth) as the core takes it."""
        require(self.ball <= Z, "defects.ball", self.ball, f"the bearing has {Z} balls")
        return (float(core.PIT_KINDS[self.body]), self.ball - 1.0, self.angle, self.width, self.depth)


@dataclass(frozen=True, eq=False)
class Imperfections:
    """All of a bearing's imperfections as the core takes them, with the kinematics they need.

    Parameters
    ----------
    spin_ratio
        Ball spin over shaft speed, negative where the outer ring is faster.
    ball_diameter
        m.
    inner_radius, outer_radius
        Of the races where the balls run, m.
    waves
        (n, 5), rows as by `Waviness.rows`.
    pits
        (n, 5), rows as by `Pit.row`.
    oversize
        (Z,) diameter of each ball beyond the nominal one, m, or empty.
    """

    spin_ratio: float = 0.0
    ball_diameter: float = 0.0
    inner_radius: float = 0.0
    outer_radius: float = 0.0
    waves: Array = field(default_factory=lambda: np.zeros((0, 5)))
    pits: Array = field(default_factory=lambda: np.zeros((0, 5)))
    oversize: Array = field(default_factory=lambda: np.zeros(0))

    __repr__ = short

    @property
    def none(self) -> bool:
        """Whether the bearing is perfect."""
        return not (len(self.waves) or len(self.pits) or len(self.oversize))

    def packed(self) -> dict[str, object]:
        """The fields by name, as the core parses them."""
        return {own.name: getattr(self, own.name) for own in fields(self)}


def checked(
    Z: int, waviness: Sequence[Waviness], defects: Sequence[Pit], oversize: Sequence[float]
) -> tuple[tuple[Waviness, ...], tuple[Pit, ...], tuple[float, ...]]:
    """Imperfections as tuples; ValueError for one of the wrong kind, or on a ball that is not there."""
    for wave in items("waviness", waviness, "give a list of Waviness objects"):
        require(isinstance(wave, Waviness), "waviness", wave, "give Waviness objects")
        wave.rows(Z)
    for pit in items("defects", defects, "give a list of Pit objects"):
        require(isinstance(pit, Pit), "defects", pit, "give Pit objects")
        pit.row(Z)
    remedy = f"give one finite diameter deviation in m for each of {Z} balls"
    sizes = tuple(items("oversize", oversize, remedy))
    require(len(sizes) in (0, Z), "oversize", oversize, remedy)
    sizes = tuple(plausible("oversize", f"oversize[{i}]", d, remedy) for i, d in enumerate(sizes))
    return tuple(waviness), tuple(defects), sizes
