"""What joins parts: rigid connections, supports, springs, bearings and loose fits."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from bearingdyn.application.place import Place
from bearingdyn.bearing import RIGID, BallBearing, LooseFit, RacewaySeries, at_distance, catalogue
from bearingdyn.checks import require, vector
from bearingdyn.plausible_ranges import plausible
from bearingdyn.short_repr import short
from bearingdyn.types import Array


@dataclass(frozen=True)
class Connection:
    """A rigid joint: two interfaces that move as one.

    Raises
    ------
    ValueError
        If both are one, or of one part.
    """

    a: Place
    b: Place

    def __post_init__(self) -> None:
        if self.a == self.b:
            raise ValueError(f"{self.a} cannot be connected to itself; name two interfaces")
        if self.a.part == self.b.part:
            raise ValueError(f"{self.a} and {self.b} are of one part; connect interfaces of two parts")


@dataclass(frozen=True, eq=False)
class Support:
    """A joint to the ground: rigid, or six springs and six dampers.

    Parameters
    ----------
    interface
        What is held.
    stiffness, damping
        (6,) N/m, N m/rad and N s/m, N m s/rad; both None where the support is rigid.
    offset
        (6,) m and rad, where the springs are free of force.

    Raises
    ------
    ValueError
        If an array has another shape or is not finite, a stiffness or damping is negative, or an offset has
        no spring to act through.
    """

    interface: Place
    stiffness: Array | None
    damping: Array | None
    offset: Array | None = None

    __repr__ = short

    def __post_init__(self) -> None:
        _check_springs(self, str(self.interface))

    @property
    def rigid(self) -> bool:
        """Whether nothing moves here."""
        return self.stiffness is None and self.damping is None


@dataclass(frozen=True, eq=False)
class Bush:
    """A springy joint: six springs and six dampers between two interfaces, on x_a − x_b − offset.

    Parameters
    ----------
    a, b
        The interfaces; b may be GROUND.
    stiffness, damping, offset
        (6,) as in `Support`.

    Raises
    ------
    ValueError
        If both ends are one, and as `Support`.
    """

    a: Place
    b: Place
    stiffness: Array
    damping: Array
    offset: Array

    __repr__ = short

    def __post_init__(self) -> None:
        if self.a == self.b:
            raise ValueError(f"a spring has both ends at {self.a}; name two interfaces")
        _check_springs(self, f"the spring between {self.a} and {self.b}")


@dataclass(frozen=True)
class BearingJoint:
    """A joint by a bearing between two interfaces.

    Parameters
    ----------
    name
        Name of the bearing in the application.
    bearing
        What is mounted.
    inner, outer
        Interfaces of the two rings; outer may be the raceway of a flexible ring, or GROUND.
    offset
        How far along z the seat of the inner ring was put beyond where it was drawn, m.
    place
        Of the balls along z, from the references of both interfaces, m.

    Raises
    ------
    ValueError
        If this is not a bearing, both rings are at one place, or the offset is not finite.
    """

    name: str
    bearing: BallBearing
    inner: Place
    outer: Place
    offset: float = 0.0
    place: float = 0.0

    def __post_init__(self) -> None:
        field = f"bearing {self.name!r}"
        _check_bearing(field, self.bearing)
        if self.inner == self.outer:
            raise ValueError(f"{field} has both rings at {self.inner}; name two interfaces")
        offset = plausible("offset", f"{field}: offset", self.offset, "it must be a finite length in m")
        object.__setattr__(self, "offset", offset)

    def coefficients(self, series: RacewaySeries = RIGID) -> Array:
        """(n, 6) from the motion of an interface to the raceway coefficients of its ring."""
        rows = self.bearing.coefficients(series)
        return rows @ at_distance(self.place) if self.place else rows


@dataclass(frozen=True)
class LooseJoint:
    """A loose joint: a flexible ring that sits with clearance in a bore.

    Parameters
    ----------
    name
        Name of the fit in the application.
    fit
        Its clearance and contact.
    ring
        Outside of the ring, a raceway.
    bore
        Interface of the bore, or GROUND.

    Raises
    ------
    ValueError
        If this is no loose fit.
    """

    name: str
    fit: LooseFit
    ring: Place
    bore: Place

    def __post_init__(self) -> None:
        require(isinstance(self.fit, LooseFit), f"fit {self.name!r}", self.fit, "it must be a bd.LooseFit(…)")


def _check_springs(joint: Support | Bush, what: str) -> None:
    """Six stiffnesses and dampings that are not negative, and an offset where there are springs."""

    def six(field: str, value: ArrayLike | None, positive: bool = True) -> Array | None:
        if value is None:
            return None
        name = f"{field} of {what}"
        array = vector(name, value, (6,), "six numbers (x, y, z, θx, θy, θz) in SI units")
        ok = not positive or bool((array >= 0).all())
        require(ok, name, array.tolist(), "stiffness and damping cannot be negative")
        for k, x in enumerate(array.tolist()):
            plausible(field if positive else "offset" if k < 3 else "tilt", f"{name}, entry {k},", x)
        object.__setattr__(joint, field, array)
        return array

    stiffness = six("stiffness", joint.stiffness)
    six("damping", joint.damping)
    offset = six("offset", joint.offset, positive=False)
    if offset is not None:
        held = np.zeros(6, dtype=bool) if stiffness is None else stiffness > 0.0
        remedy = "it acts through springs: give a stiffness there"
        require(not offset[~held].any(), f"offset of {what}", offset.tolist(), remedy)


def _check_bearing(field: str, bearing: object) -> None:
    """Refuse anything but a bearing, and say what to give instead."""
    if isinstance(bearing, BallBearing):
        return
    if isinstance(bearing, type):
        raise ValueError(f"{field} is the class {bearing.__name__}; make a bearing of it first")
    if isinstance(bearing, str | int) and str(bearing) in catalogue.CATALOGUE:
        remedy = f"that is a designation: give bd.catalogue.bearing({str(bearing)!r})"
    else:
        remedy = 'it must be a bd.BallBearing(…), or one of the catalogue: bd.catalogue.bearing("6205")'
    require(False, field, bearing, remedy)
