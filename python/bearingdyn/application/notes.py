"""What the builder of an application writes down."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

from bearingdyn.bearing import BallBearing, LooseFit
from bearingdyn.cms import Superelement
from bearingdyn.types import Array

COMPONENTS = ("x", "y", "z", "θx", "θy", "θz")
GROUND = "ground"
GRAVITY = "gravity"


class Part(Protocol):
    """Anything that becomes a superelement."""

    def superelement(self) -> Superelement:
        """The part's reduced matrices."""


@dataclass(frozen=True)
class Connection:
    """Two interfaces that move as one."""

    a: str
    b: str


@dataclass(frozen=True, eq=False)
class Support:
    """An interface held by the ground: rigidly (both None) or by six springs and six dampers.

    offset (6,): where the springs are free of force, m and rad.
    """

    interface: str
    stiffness: Array | None
    damping: Array | None
    offset: Array | None = None

    @property
    def rigid(self) -> bool:
        """Whether nothing moves here."""
        return self.stiffness is None and self.damping is None


@dataclass(frozen=True, eq=False)
class Bush:
    """Six springs and six dampers between two interfaces, on x_a − x_b − offset; b may be "ground"."""

    a: str
    b: str
    stiffness: Array
    damping: Array
    offset: Array


@dataclass(frozen=True)
class HungBearing:
    """A bearing between two interfaces; outer may be a raceway of a flexible ring, or "ground".

    offset: how far along z the inner ring's seat was put beyond where it was drawn, m.
    """

    name: str
    bearing: BallBearing
    inner: str
    outer: str
    offset: float = 0.0


@dataclass(frozen=True)
class HungFit:
    """A flexible ring's outside, a raceway, loose in a bore: an interface or "ground"."""

    name: str
    fit: LooseFit
    ring: str
    bore: str


@dataclass(frozen=True, eq=False)
class Load:
    """A force and moment at an interface or point, in the manner its kind says.

    kind "constant": vector. "harmonic": vector·cos(ωt + phase). "rotating": an unbalance, force
    Ω²·unbalance·(cos(Ωt + phase), sin(Ωt + phase)) in (x, y). "sampled": vector × value(time).
    At "ground" the vector is the acceleration of the ground, at "gravity" that of a falling body, m/s².
    """

    where: str
    kind: str
    vector: Array
    omega: float = 0.0
    phase: float = 0.0
    unbalance: float = 0.0
    time: Array | None = None
    value: Array | None = None
