"""What an interface offers to its neighbour: cylinders that face outwards (shaft) or inwards (bore)."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Literal, Protocol, runtime_checkable

import numpy as np

from bearingdyn.types import Array

# of the largest radius: a mesh of few sides is still a cylinder, a cone is none
_ROUND = 1e-3


@dataclass(frozen=True)
class RoundFace:
    """A round face at an interface: a cylinder about z that a neighbour must fit.

    Parameters
    ----------
    kind
        "shaft" faces outwards, "bore" inwards.
    radius
        m.
    z
        (from, to), m, along the axis from the interface's reference point.
    room
        (from, to), m, in which a neighbour may lie: beyond stands something thicker (shaft) or narrower
        (bore) of the same part. None: everywhere.
    bonded
        The whole face is glued, as that of a rubber layer.
    beside
        The part may also stand beside its neighbour, as a disc or another shaft end to end.
    at
        z of the interface's reference point along the part, m, where what sits on two seats is compared;
        None: it is not.
    """

    kind: Literal["shaft", "bore"]
    radius: float
    z: tuple[float, float]
    room: tuple[float, float] | None = None
    bonded: bool = False
    beside: bool = False
    at: float | None = None


@runtime_checkable
class HasRoundFaces(Protocol):
    """A part that knows its round faces."""

    def round_faces(self) -> Mapping[str, tuple[RoundFace, ...]]:
        """Cylinders at each interface, by its name; an interface without one may be left out."""


def face_of_nodes(
    radius: Array, z: Array, around: Array, reference: float, *, bonded: bool = False
) -> tuple[RoundFace, ...]:
    """The round face that nodes of a mesh lie on; nothing where they lie on none.

    Parameters
    ----------
    radius, z
        (k,) of the nodes of the face, from the axis and along it, m.
    around
        Radii, m, of all nodes of the elements at the face: the body lies where they are.
    reference
        z of the interface's reference point, m.
    bonded
        As in RoundFace.
    """
    r, body = float(radius.mean()), float(around.mean())
    if not (r > 0 and float(np.ptp(radius)) <= _ROUND * r and float(np.ptp(z)) > 0):
        return ()
    kind: Literal["shaft", "bore"] = "bore" if body > r else "shaft"
    span = (float(z.min()) - reference, float(z.max()) - reference)
    return (RoundFace(kind, r, span, bonded=bonded),)
