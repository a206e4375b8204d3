"""What a squeezed part tells: forces, pressures, stretch, bulge, contact, and the stiffness it then has."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from bearingdyn.cms import RoundFace, Superelement
from bearingdyn.fem import NoBalance
from bearingdyn.notice import MeshDependent, warn
from bearingdyn.parts.outline import Outline
from bearingdyn.parts.profile import HasProfile, Profile
from bearingdyn.pictures import page
from bearingdyn.short_repr import short
from bearingdyn.types import Complex

COARSER = 0.7  # refinement of the second mesh over that of the first
SAME_ANSWER = 0.01  # change between the two above which an answer is in doubt


class _Part(Protocol):
    """A part whose matrices are those of a small motion about its static state."""

    def stiffness(self, omega: float = 0.0, after: float | None = None) -> Complex: ...

    def superelement(self) -> Superelement: ...

    def outline(self) -> Outline: ...

    def round_faces(self) -> Mapping[str, tuple[RoundFace, ...]]: ...


@dataclass(frozen=True, eq=False, kw_only=True)
class Squeezed:
    """A part as it is squeezed in its machine; it takes the place of the part in an Application.

    Its matrices are those of a small motion about the static state. That state pushes on its neighbours, and
    they are taken to bear it: a ring pressed into a bore is balanced by itself, a pad between two plates by
    whatever clamps them.

    Parameters
    ----------
    part
        The deformed part, all its surfaces stuck to their rigid bodies.
    squeezed
        The face that was pressed, to which `pressure`, `force` and `width` belong.
    force
        With which the pressed face squeezes the part, along its normal and summed around the axis, N.
    forces
        name -> radial and axial force of each face on the part, summed around the axis, N; of a solid its
        three components and their moments about the face's reference, N m.
    pressures
        name -> mean pressure on each face, Pa.
    widths
        name -> length along the section over which each face touches, m; of a solid the area, m².
    lost
        name -> length, m, over which the part has parted from a face that it slipped on.
    bulge
        Largest outward motion of the free surface, m.
    stretch
        Largest principal stretch at a point of integration. At the edge of a bond it is singular and grows as
        the mesh is refined.
    strain
        Largest |λ − 1| of the principal stretches λ, singular likewise.
    energy
        Stored, J.
    stability
        Least modulus of a further change of shape anywhere, over that of the undeformed material; 1 at rest.
    """

    part: _Part
    squeezed: str
    force: float
    forces: Mapping[str, tuple[float, ...]]
    pressures: Mapping[str, float]
    widths: Mapping[str, float]
    lost: Mapping[str, float]
    bulge: float
    stretch: float
    strain: float
    energy: float
    stability: float

    __repr__ = short
    _repr_html_ = page

    @property
    def pressure(self) -> float:
        """Mean pressure on the pressed face, Pa."""
        return self.pressures[self.squeezed]

    def stiffness(self, omega: float = 0.0, after: float | None = None) -> Complex:
        """Quasi-static stiffness (6 i, 6 i) of its i interfaces about the static state, N/m, N, N m.

        Parameters
        ----------
        omega
            rad/s.
        after
            Take G(t) after this time at rest, s, instead of the relaxed modulus that ω = 0 has.
        """
        return self.part.stiffness(omega, after)

    def superelement(self) -> Superelement:
        """Reduced matrices about the static state, as those of the part before."""
        return self.part.superelement()

    def outline(self) -> Outline:
        """Its deformed surface."""
        return self.part.outline()

    def profile(self) -> list[Profile]:
        """What the plane x = 0 shows of it, deformed; of a solid nothing: its outline tells."""
        return list(self.part.profile()) if isinstance(self.part, HasProfile) else []

    def round_faces(self) -> Mapping[str, tuple[RoundFace, ...]]:
        """Cylinders at its interfaces, where they are now."""
        return self.part.round_faces()


def buckles(found: Squeezed) -> str | None:
    """Why a squeezed ring cannot hold what is in it: a direction in which the tangent is not positive.

    Of the last interface against the others, which are held, about the static state.
    """
    K = found.stiffness().real[-6:, -6:]
    size = np.sqrt(np.abs(np.diag(K)))
    values, shapes = np.linalg.eigh(K / np.outer(size, size))
    if values[0] > 0.0:
        return None
    names = ("radial", "radial", "axial", "tilting", "tilting", "torsional")
    worst = int(np.argmax(np.abs(shapes[:, 0])))
    unit = "N/m" if worst < 3 else "N m/rad"
    return (
        f"it buckles there: its {names[worst]} stiffness is {values[0] * size[worst] ** 2:.4g} {unit}; "
        f"squeeze less, or take a wider or thinner ring"
    )


def compare_meshes(fine: Squeezed, coarser: Callable[[], Squeezed]) -> None:
    """Warn (MeshDependent) where a squeezed part's force or stiffness differ by 1 % on a coarser mesh.

    Where the coarser mesh finds no balance there is nothing to compare.
    """
    try:
        coarse = coarser()
    except NoBalance:
        return
    pairs = [("force", fine.force, coarse.force)]
    own, other = (np.diag(one.stiffness().real)[-6:] for one in (fine, coarse))
    names = ("radial", "axial", "tilting", "torsional")
    pairs += [(f"{name} stiffness", own[i], other[i]) for name, i in zip(names, (0, 2, 3, 5), strict=True)]
    name, a, b = max(pairs, key=lambda pair: abs(pair[2] - pair[1]) / max(abs(pair[1]), 1e-300))
    if abs(b - a) > SAME_ANSWER * abs(a):
        warn(
            f"the {name} of the squeezed part is {a:.4g} on its mesh and {b:.4g} on one of {COARSER:g} times "
            f"its refinement, {abs(b / a - 1):.1%} apart; raise refinement, or recess the ends",
            MeshDependent,
        )
