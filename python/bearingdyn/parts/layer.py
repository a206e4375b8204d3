"""The viscoelastic ring layer bonded between two rigid surfaces."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike

from bearingdyn.checks import positive
from bearingdyn.cms import Superelement, check_moduli
from bearingdyn.magnitude import plausible
from bearingdyn.material import Elastic
from bearingdyn.parts.outline import Outline
from bearingdyn.parts.regions import Region, ViscoelasticSolid
from bearingdyn.parts.revolved import Revolved
from bearingdyn.parts.revolved_faces import Cylinder
from bearingdyn.parts.round_face import RoundFace
from bearingdyn.types import Array, Complex


@dataclass(frozen=True)
class Layer:
    """A layer: a rubber ring bonded to a rigid body inside ("inner") and outside ("outer"), its ends free.

    Parameters
    ----------
    r_inner, r_outer, width
        m. The reference point of both interfaces lies on the axis at mid-width.
    material
        Maxwell, or another viscoelastic or elastic one.
    moduli
        Real shear moduli, Pa, at which `superelement` takes its shapes. None chooses two: the relaxed
        modulus, which the static state has, and |G*| at the fastest relaxation time, the top of the band that
        the material describes; and their geometric mean if they are more than a hundredfold apart. The radial
        shape depends on G/K, and one modulus is not enough: for a 26/28×16 mm layer with K = 2 GPa, shapes at
        1 MPa are 26 % too stiff at 10 MPa.
    refinement
        Mesh density; the default gives stiffnesses within some 0.02 % for ratios G/K down to 1e-4.

    Raises
    ------
    ValueError
        For dimensions that are not positive and finite, r_outer not above r_inner, or more than 10 m: they
        are then in mm.

    References
    ----------
    Paper section 3.3.

    Examples
    --------
    >>> import bearingdyn as bd
    >>> rubber = bd.Maxwell(G0=1e6, G=[2e6], tau=[1e-4], K=2e9, density=1150.0)
    >>> layer = bd.Layer(r_inner=0.026, r_outer=0.030, width=0.016, material=rubber)
    >>> k = layer.stiffness()  # N/m, N, N m
    >>> k.shape, f"{k[0, 0].real / 1e6:.2f} radially, {k[2, 2].real / 1e6:.2f} along the axis, N/µm"
    ((12, 12), '6.91 radially, 0.66 along the axis, N/µm')
    """

    r_inner: float
    r_outer: float
    width: float
    material: Elastic | ViscoelasticSolid
    moduli: tuple[float, ...] | None = None
    refinement: float = 1.0

    def __post_init__(self) -> None:
        positive("r_inner", self.r_inner, "it must be a positive radius in m")
        positive("r_outer", self.r_outer, "it must be a positive radius in m")
        if not self.r_inner < self.r_outer < math.inf:
            raise ValueError(f"r_outer is {self.r_outer}; it must exceed r_inner = {self.r_inner} m")
        positive("width", self.width, "it must be a positive length in m")
        positive("refinement", self.refinement, "it must be a positive mesh density, 1 by default")
        for name in ("r_outer", "width"):
            plausible("length", name, getattr(self, name))
        if self.moduli is not None:
            object.__setattr__(self, "moduli", check_moduli(self.moduli))
        _ = self.body

    @property
    def thickness(self) -> float:
        """r_outer − r_inner, m."""
        return self.r_outer - self.r_inner

    @cached_property
    def body(self) -> Revolved:
        """The layer as a body of revolution."""
        half = (-0.5 * self.width, 0.5 * self.width)
        return Revolved(
            (Region((self.r_inner, self.r_outer), half, self.material, graded=True),),
            {"inner": Cylinder(self.r_inner), "outer": Cylinder(self.r_outer)},
            moduli=self.moduli,
            refinement=self.refinement,
        )

    def stiffness(self, omega: float = 0.0, after: float | None = None) -> Complex:
        """Quasi-static stiffness (12, 12), inner interface then outer, N/m, N, N m: solved anew at G*(ω).

        Parameters
        ----------
        omega
            rad/s.
        after
            Take G(t) after this time at rest, s, instead of the relaxed modulus that ω = 0 has.

        Raises
        ------
        ValueError
            Where the material has no shear stiffness, as G0 = 0 at ω = 0; for `after` together with ω.

        Warns
        -----
        BeyondData
            At rest, where the data of the material do not speak of the time.
        """
        return self.body.stiffness(omega, after)

    def superelement(self) -> Superelement:
        """Reduced matrices: 12 interface coordinates, and up to 5 internal ones for each further modulus."""
        return self.body.superelement()

    def outline(self) -> Outline:
        """Its surface; see Revolved.outline."""
        return self.body.outline()

    def round_faces(self) -> Mapping[str, tuple[RoundFace, ...]]:
        """Cylinders at its interfaces, against which an application checks the neighbours."""
        return {k: tuple(replace(f, bonded=True) for f in v) for k, v in self.body.round_faces().items()}

    def nominal_strain(self, relative: ArrayLike) -> Array:
        """Nominal strain max |t + θ × ρ| / (r_outer − r_inner) under a relative motion of the interfaces.

        Parameters
        ----------
        relative
            (..., 6) motion (t, θ) of one interface against the other, m and rad. ρ runs over both edges of
            the layer's middle surface (within 0.1 % in azimuth). Returns (...,). The strain at the bonded
            corners is higher.
        """
        q = np.asarray(relative, dtype=np.float64)
        if q.shape[-1:] != (6,):
            raise ValueError(f"relative has shape {q.shape}; it must be (..., 6): x, y, z, θx, θy, θz")
        phi = np.linspace(0.0, 2.0 * np.pi, 72, endpoint=False)
        r = 0.5 * (self.r_inner + self.r_outer)
        edges = [
            np.stack([r * np.cos(phi), r * np.sin(phi), np.full_like(phi, s * self.width / 2)], -1)
            for s in (-1, 1)
        ]
        rho = np.concatenate(edges)
        u = q[..., None, :3] + np.cross(q[..., None, 3:], rho)
        return np.asarray(np.linalg.norm(u, axis=-1).max(axis=-1) / self.thickness)
