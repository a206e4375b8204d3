"""The viscoelastic ring layer bonded between two rigid surfaces."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike

from bearingdyn.checks import nonnegative, one_of, positive, reals, require, vector
from bearingdyn.cms import RoundFace, Superelement, check_moduli
from bearingdyn.fem import (
    NoBalance,
    revolution_mesh,
)
from bearingdyn.material import Elastic, Hyperelastic, is_volume
from bearingdyn.notice import VolumeCounts, warn
from bearingdyn.parts.outline import Outline
from bearingdyn.parts.profile import Profile
from bearingdyn.parts.regions import Patch, Region, ViscoelasticSolid
from bearingdyn.parts.revolved import Revolved
from bearingdyn.parts.revolved_faces import Cylinder
from bearingdyn.parts.rubber_zones import RubberZone
from bearingdyn.parts.shape_moduli import shape_moduli
from bearingdyn.parts.squeezed import COARSER, Squeezed, buckles, compare_meshes
from bearingdyn.parts.strain import Strain
from bearingdyn.pictures import page
from bearingdyn.plausible_ranges import plausible
from bearingdyn.types import Array, Complex
from bearingdyn.units import takes

VOLUME_COUNTS = 0.1  # share of volume in the radial stiffness, from which the doubt in K is told


@takes(r_inner="m", r_outer="m", width="m", moduli="Pa", recess="m")
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
    recess
        Depth, m, to which both ends are hollowed out as a parabola from bond to bond; 0: flat. A ring that is
        bonded before it is squeezed needs it, or its ends fold over the edges of the bonds.
    meshed_as
        (r_inner, r_outer, width), m, of the layer whose mesh is moved to these dimensions; None: it is meshed
        anew, and where the number of elements changes stiffnesses jump by some 1e-4. A search for the best
        dimensions wants one mesh for all of them.

    Raises
    ------
    ValueError
        For dimensions that are not positive and finite, r_outer not above r_inner, or more than 10 m: they
        are then in mm; for a recess of half the width or more.

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
    recess: float = 0.0
    meshed_as: tuple[float, float, float] | None = None

    _repr_html_ = page

    def __post_init__(self) -> None:
        positive("r_inner", self.r_inner, "it must be a positive radius in m")
        positive("r_outer", self.r_outer, "it must be a positive radius in m")
        if not self.r_inner < self.r_outer < math.inf:
            raise ValueError(f"r_outer is {self.r_outer}; it must exceed r_inner = {self.r_inner} m")
        positive("width", self.width, "it must be a positive length in m")
        positive("refinement", self.refinement, "it must be a positive mesh density, 1 by default")
        for name in ("r_outer", "width"):
            plausible("length", name, getattr(self, name))
        remedy = f"it must be a depth in m, 0 or more and less than half the width, {0.5 * self.width:g} m"
        require(nonnegative("recess", self.recess, remedy) < 0.5 * self.width, "recess", self.recess, remedy)
        if self.moduli is not None:
            object.__setattr__(self, "moduli", check_moduli(self.moduli))
        if self.meshed_as is not None:
            meaning = "r_inner, r_outer and width in m"
            r, R, width = vector("meshed_as", self.meshed_as, (3,), meaning).tolist()
            good = 0 < r < R and width > 0
            require(good, "meshed_as", self.meshed_as, f"it must be the dimensions of a layer: {meaning}")
            object.__setattr__(self, "meshed_as", (r, R, width))
        _ = self.body

    @property
    def thickness(self) -> float:
        """r_outer − r_inner, m."""
        return self.r_outer - self.r_inner

    @cached_property
    def body(self) -> Revolved:
        """The layer as a body of revolution."""
        r, R, width = self.meshed_as or (self.r_inner, self.r_outer, self.width)
        region = Region((r, R), (-0.5 * width, 0.5 * width), self.material, graded=True)
        section = None
        if self.recess > 0.0 or self.meshed_as is not None:
            section = revolution_mesh([region.rectangle], self.refinement)
            moved = self.r_inner + self.thickness * (section.r - r) / (R - r)
            section = replace(section, r=moved, z=self.width / width * section.z)
        if self.recess > 0.0 and section is not None:
            across = (2.0 * section.r - self.r_inner - self.r_outer) / self.thickness
            hollow = 1.0 - 2.0 * self.recess / self.width * (1.0 - across**2)
            section = replace(section, z=section.z * hollow)
        return Revolved(
            (region if section is None else Patch(self.material),),
            {"inner": Cylinder(self.r_inner), "outer": Cylinder(self.r_outer)},
            moduli=self.moduli,
            refinement=self.refinement,
            section=section,
        )

    def assembled(
        self,
        *,
        squeeze: float | None = None,
        interference: float | None = None,
        inside: str = "bonded",
        outside: str = "bonded",
        law: Hyperelastic | None = None,
        branches: str = "current",
        after: float | None = None,
        compare: bool = True,
    ) -> Squeezed:
        """The layer as it is squeezed between shaft and bore, at finite strain; it takes the layer's place.

        The outer surface moves inwards, the inner one stays. Both then stick, and what the result is asked is
        of a small motion about this state.

        Parameters
        ----------
        squeeze
            Share of the thickness by which it is squeezed; or
        interference
            by how much its outer diameter exceeds the bore, m. Give one of the two.
        inside, outside
            "bonded" from the start, or "slip" without friction while it is pressed in. Flat ends bonded from
            the start fold over the edge of the bond beyond some 3 % of squeeze: give them a recess, or
            let both surfaces slip.
        law
            Strain energy: NeoHooke(), the default, MooneyRivlin or Yeoh, scaled to the static modulus.
        branches
            "current" or "separable": what of the stiffness depends on the frequency; see Revolved.assembled.
        after
            Take the static modulus G(t) after this time, s, instead of the relaxed one.
        compare
            Solve on a coarser mesh too, and warn where the two differ by more than 1 %.

        Raises
        ------
        ValueError
            For a squeeze outside 0 to 1, both or neither measure; and naming the squeeze that was reached,
            where the layer folds over the edge of a bond, elements turn inside out, the law is not stable, or
            the stiffness about the squeezed state is not positive.

        Warns
        -----
        BeyondData
            Where the data of the material do not speak of the time at which it stands.
        MeshDependent
            Where force or static stiffness change by more than 1 % on a coarser mesh.

        Examples
        --------
        >>> import bearingdyn as bd
        >>> rubber = bd.Maxwell(G0=1e6, G=[2e6], tau=[1e-4], K=2e9, density=1150.0)
        >>> layer = bd.Layer(r_inner=0.020, r_outer=0.024, width=0.012, material=rubber)
        >>> fitted = layer.assembled(squeeze=0.10, inside="slip", outside="slip")
        >>> k, rest = fitted.stiffness()[0, 0].real, layer.stiffness()[0, 0].real
        >>> f"{fitted.pressure / 1e6:.2f} MPa, radially {k / rest - 1:.0%} stiffer"
        '0.43 MPa, radially 42% stiffer'
        """
        require(
            (squeeze is None) != (interference is None),
            "squeeze",
            squeeze,
            f"with interference={interference!r}; give exactly one of the two",
        )
        remedy = "it must be a share of the thickness, 0 or more and less than 1"
        if squeeze is None:
            share = nonnegative("interference", interference, "it must be a length in m, 0 or more")
            remedy = f"it must be less than twice the thickness, {2.0 * self.thickness:g} m"
            share *= 0.5 / self.thickness
        else:
            share = nonnegative("squeeze", squeeze, remedy)
        asked = ("interference", interference) if squeeze is None else ("squeeze", squeeze)
        require(share < 1.0, *asked, remedy)
        slip = []
        for side, name, how in (("inside", "inner", inside), ("outside", "outer", outside)):
            one_of(side, how, ("bonded", "slip"))
            slip += [name] if how == "slip" else []
        press = {"outer": share * self.thickness}

        def on(ring: Layer) -> Squeezed:
            return ring.body.squeezed(press, slip=slip, law=law, branches=branches, after=after)

        try:
            found = on(self)
        except NoBalance as failure:
            raise ValueError(
                f"{asked[0]} is {asked[1]}; {failure.share * share:.3g} of the thickness is reached: "
                f"{failure.reason}"
            ) from None
        lost = buckles(found)
        if lost:
            raise ValueError(f"{asked[0]} is {asked[1]}; {share:.3g} of the thickness is reached, and {lost}")
        if compare and share > 0.0 and COARSER * self.refinement >= 0.25:
            compare_meshes(found, lambda: on(replace(self, refinement=COARSER * self.refinement)))
        return found

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
        """Reduced matrices: 12 interface coordinates, and up to 5 internal ones for each further modulus.

        Warns
        -----
        VolumeCounts
            Where the radial stiffness hangs on the bulk modulus.
        """
        element = self.body.superelement()
        self._warn_of_volume(element)
        return replace(element, faces=self.round_faces())

    def _warn_of_volume(self, element: Superelement) -> None:
        """Warn where volume has a share in the radial stiffness: it is d ln k/d ln K, at constant shapes."""
        if not element.viscoelastic:
            return
        G = shape_moduli(self.body.regions, self.moduli)[0][0]
        volume = element.K[0, 0] + sum(
            2.0 * self.material.K * t.H[0, 0] for t in element.viscoelastic if is_volume(t.material)
        )
        share = volume / (volume + 2.0 * G * element.viscoelastic[0].H[0, 0])
        if share < VOLUME_COUNTS:
            return
        warn(
            f"layer of {1e3 * self.thickness:.3g} mm: {share:.0%} of its radial stiffness is volume, so that "
            f"a bulk modulus of 1 or 3 GPa instead of {self.material.K / 1e9:.3g} makes it "
            f"{(1e9 / self.material.K) ** share - 1:+.0%} or {(3e9 / self.material.K) ** share - 1:+.0%} "
            f"stiffer; DMA does not measure it",
            VolumeCounts,
        )

    def outline(self) -> Outline:
        """Its surface; see Revolved.outline."""
        return self.body.outline()

    def profile(self) -> list[Profile]:
        """What the plane x = 0 shows of it; see Revolved.profile."""
        return self.body.profile()

    def round_faces(self) -> Mapping[str, tuple[RoundFace, ...]]:
        """Cylinders at its interfaces, against which an application checks the neighbours."""
        return {k: tuple(replace(f, bonded=True) for f in v) for k, v in self.body.round_faces().items()}

    def eccentricity(self, relative: ArrayLike) -> Array:
        """Largest displacement across the axis at either end of the layer, over the thickness.

        Parameters
        ----------
        relative
            (..., 6) motion of one interface against the other, m and rad. Returns (...,).
        """
        q = _motion(relative)
        ends = [
            np.hypot(q[..., 0] + s * q[..., 4], q[..., 1] - s * q[..., 3])
            for s in (-0.5 * self.width, 0.5 * self.width)
        ]
        return np.asarray(np.maximum(*ends) / self.thickness)

    def strain(self, relative: ArrayLike, modulus: float | None = None) -> Strain:
        """Shear strain of the rubber under a relative motion of the interfaces, by the strain at each place.

        Parameters
        ----------
        relative
            (6,) motion x, y, z, θx, θy, θz of the outer interface against the inner one, m and rad, real or
            complex, zero-to-peak.
        modulus
            Shear modulus, Pa, on which the shape depends; None: the lowest of `moduli`.

        Returns
        -------
        Strain
            Over the volume `rms`; `logarithmic`, the one that a law of softening is asked at; `largest`.

        Raises
        ------
        ValueError
            For a motion of another shape, or an elastic material.

        Examples
        --------
        >>> import bearingdyn as bd
        >>> rubber = bd.Maxwell(G0=1e6, G=[2e6], tau=[1e-4], K=2e9, density=1150.0)
        >>> layer = bd.Layer(r_inner=0.020, r_outer=0.022, width=0.017, material=rubber)
        >>> g = layer.strain([10e-6, 0, 0, 0, 0, 0])  # 10 µm across 2 mm of rubber, radially
        >>> f"{100 * g.rms:.2f} % rms, {100 * g.logarithmic:.2f} % where the energy is"
        '2.87 % rms, 4.36 % where the energy is'
        """
        q = np.asarray(relative)
        require(
            not isinstance(self.material, Elastic), "material", self.material, "a strain is asked of rubber"
        )
        require(q.shape == (6,), "relative", relative, "it must be (6,): x, y, z, θx, θy, θz")
        return self.body.strain(np.concatenate([np.zeros(6), q]), modulus)

    def zones(self, count: int, rubber: int = 0) -> list[RubberZone]:
        """Zones of the rubber, in the coordinates of the superelement; see Revolved.zones."""
        return self.body.zones(count, rubber)

    def nominal_strain(self, relative: ArrayLike) -> Array:
        """Nominal strain max |t + θ × ρ| / (r_outer − r_inner) under a relative motion of the interfaces.

        Parameters
        ----------
        relative
            (..., 6) motion (t, θ) of one interface against the other, m and rad. ρ runs over both edges of
            the layer's middle surface (within 0.1 % in azimuth). Returns (...,). The strain at the bonded
            corners is higher.
        """
        q = _motion(relative)
        phi = np.linspace(0.0, 2.0 * np.pi, 72, endpoint=False)
        r = 0.5 * (self.r_inner + self.r_outer)
        edges = [
            np.stack([r * np.cos(phi), r * np.sin(phi), np.full_like(phi, s * self.width / 2)], -1)
            for s in (-1, 1)
        ]
        rho = np.concatenate(edges)
        u = q[..., None, :3] + np.cross(q[..., None, 3:], rho)
        return np.asarray(np.linalg.norm(u, axis=-1).max(axis=-1) / self.thickness)


def _motion(relative: ArrayLike) -> Array:
    """(..., 6) motion of one interface against the other, m and rad."""
    q = reals("relative", relative, "it must be real numbers, (..., 6): x, y, z, θx, θy, θz")
    if q.shape[-1:] != (6,):
        raise ValueError(f"relative has shape {q.shape}; it must be (..., 6): x, y, z, θx, θy, θz")
    return q
