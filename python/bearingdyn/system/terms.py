"""The terms of a system: layers, bearings, parts, springs and loads in its coordinates."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Any, Literal, TypeAlias

from bearingdyn.application import Part
from bearingdyn.bearing import (
    RIGID,
    BallBearing,
    BearingKernel,
    FilmDamping,
    LooseFit,
    RacewaySeries,
    carried,
)
from bearingdyn.cms import Superelement
from bearingdyn.short_repr import short
from bearingdyn.types import Array

Contacts: TypeAlias = Literal["film", "viscous"]
"""How contacts of a system answer motion: lubricated ones by frequency, or as dampers at any."""


@dataclass(frozen=True, eq=False)
class LayerTerm:
    """A layer's term in the system: its deviatoric stiffness is 2 G*(ω) L Lᵀ, L (n, rank).

    strain: (rank,), γ² = Σ strain |Lᵀx|² is the square of the shear strain amplitude that counts for a law of
    softening; None where the material has none.
    """

    part: str
    material: Any
    L: Array
    strain: Array | None = None

    __repr__ = short


@dataclass(frozen=True, eq=False)
class BearingTerm:
    """A term of the system: one bearing or loose fit.

    Parameters
    ----------
    name, bearing
        Its name and what it is.
    B
        (n_coefs, n); B x are its relative raceway coefficients, inner minus outer, m.
    series
        Which coefficients they are.
    offset
        Distance along z, m, of the inner ring from where B x puts it.
    ends
        Rows (n_coefs, 6) of the interface at each end, by the interface's name.
    give
        What flexible rings add to Hertz at each ball by itself, m/N.
    """

    name: str
    bearing: BallBearing | LooseFit
    B: Array
    series: RacewaySeries = RIGID
    offset: float = 0.0
    ends: Mapping[str, Array] = field(default_factory=dict)
    give: float = 0.0

    __repr__ = short

    @property
    def has_films(self) -> bool:
        """Whether it is known how its films answer by frequency."""
        law = getattr(self.bearing, "damping", None)
        return isinstance(law, FilmDamping) and law.answer is not None

    def kernel(self, contacts: Contacts = "viscous") -> BearingKernel:
        """The bearing as the contact kernel takes it, its offset in the axial distance of the grooves.

        Parameters
        ----------
        contacts
            Whether films answer as viscous dampers, or remember; those of other bearings have no memory.

        Raises
        ------
        ValueError
            As `FilmMemory.of`, by the bearing's name.
        """
        kernel = self.bearing.kernel(self.series)
        law = getattr(self.bearing, "damping", None)
        if contacts == "film" and isinstance(law, FilmDamping) and self.has_films:
            try:
                kernel = carried(replace(kernel, give=self.give), law)
            except (ValueError, ArithmeticError) as failure:
                raise type(failure)(f"bearing {self.name!r}: {failure}") from None
        elif self.give != 0.0:
            kernel = replace(kernel, give=self.give)
            if isinstance(law, FilmDamping):
                _, scale, table = law.behind(self.give, kernel.kappa).kernel_fields()
                kernel = replace(kernel, damping_c=scale, damping_table=table)
        if self.offset == 0.0:
            return kernel
        # e0 = x0² + y0² − A² moves by offset (2 x0 + offset), without cancellation
        shift = self.offset * (2.0 * kernel.x0 + self.offset)
        return replace(kernel, x0=kernel.x0 + self.offset, e0=kernel.e0 + shift)


@dataclass(frozen=True, eq=False)
class PartTerm:
    """A term of the system: one part.

    Parameters
    ----------
    name, element
        Its name and its matrices.
    place
        (m, n); place @ x are the coordinates of the part.
    rigid
        (m, 6), its coordinates in unit rigid motions x, y, z, θx, θy, θz of its first interface; NaN for a
        part that holds itself.
    source
        What it was reduced from.
    """

    name: str
    element: Superelement
    place: Array
    rigid: Array
    source: Part

    __repr__ = short


@dataclass(frozen=True, eq=False)
class SpringTerm:
    """A term of the system: springs and dampers of one joint.

    Parameters
    ----------
    name
        Of the joint.
    across
        (k, n); across @ x are the motions that they resist.
    stiffness, damping
        (k,), N/m and N s/m (N m/rad and N m s/rad of rotations).
    ends
        Rows (k, 6) of the interface at each end, by the interface's name.
    """

    name: str
    across: Array
    stiffness: Array
    damping: Array
    ends: Mapping[str, Array] = field(default_factory=dict)

    __repr__ = short


@dataclass(frozen=True, eq=False)
class LoadTerm:
    """A term of the system: one load, kind one of bearingdyn.core.LOAD_KINDS, columns (n,), table if sampled.

    part: the part it acts on, if one; own_cos, own_sin: the columns in the part's coordinates.
    """

    kind: str
    omega: float
    p_cos: Array
    p_sin: Array
    time: Array
    value: Array
    part: str = ""
    own_cos: Array | None = None
    own_sin: Array | None = None

    __repr__ = short
