"""The ring that bends between the balls, alone or with its rubber (the paper's special CMS)."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any, Literal

import numpy as np
import scipy

from bearingdyn.bearing import BallBearing, Waviness
from bearingdyn.checks import instance, one_of, positive, require, whole
from bearingdyn.cms import RoundFace, Superelement
from bearingdyn.material import STEEL, Elastic
from bearingdyn.notice import FitWarning, warn
from bearingdyn.parts.bore_shape import BoreShape
from bearingdyn.parts.layer import Layer
from bearingdyn.parts.outline import Outline
from bearingdyn.parts.profile import Profile
from bearingdyn.parts.regions import Patch, Region
from bearingdyn.parts.revolved import Revolved
from bearingdyn.parts.revolved_faces import HIGHEST, Cylinder, Face, Footprint, Groove, Line, Where
from bearingdyn.parts.ring_compliance import RingCompliance, ring_compliance
from bearingdyn.parts.ring_element import gyroscopic, upon_supports, with_folded
from bearingdyn.parts.ring_section import ring_section
from bearingdyn.parts.ring_support import RingBed, RingPoints
from bearingdyn.pictures import page
from bearingdyn.plausible_ranges import plausible
from bearingdyn.units import takes

F_HEARD = 6e3  # Hz, up to which a ring's receptances are right unless f_max says otherwise
# of the ball's diameter, the height of shoulders of deep groove bearings, and of angular contact ones
SHOULDER = 0.16
SHOULDER_ANGULAR = 0.3
REACH = 0.6  # of it, from the pitch circle to the bottom of a groove at most: .5, and room for play
NEGLIGIBLE = 1e-9  # of the largest folded compliance


@takes(r_inner="m", r_outer="m", width="m", arm="m", groove="m", groove_radius="m", f_max="Hz")
@dataclass(frozen=True)
class FlexibleRing:
    """A flexible ring whose "raceway" carries the balls of one bearing: the outer one, or the inner one.

    With `layer`, a rubber ring bonded around it, the outside of the rubber is the rigid interface "outer".
    Without a layer the ring's own outside is "outer", kept round by a rigid bore; or, with outside=RingBed(…)
    or RingPoints(…), "outer" is the rigid bore on which such springs stand; or, with outside="flexible", it
    is the raceway "outside", as flexible as the raceway inside, and the ring is held only by what carries
    that raceway.

    With race="inner" all this is turned over: the groove is in the outside, the rubber lies within, its
    r_outer equal to r_inner here, the rigid interface is "inner", that sits on a shaft and turns with it, and
    `outside` says what its bore stands on; flexible, the bore is the raceway "inside". Coordinates do not
    turn, and the ring's patterns of force pass through it: their inertia as they turn is left out, which is
    (nΩ/ω)² of order n, ω the ring's lowest free elastic frequency; `turning_error` tells it.

    Parameters
    ----------
    r_inner, r_outer, width
        m. The side of the balls at the shoulders, or at the bottom of the groove if no groove_radius is
        given. The plane of the balls is at mid-width.
    arm
        Radius, m, at which tilts become axial motion, of a ring by itself; with a bearing it is the
        bearing's.
    order
        Highest Fourier order in the azimuth; None: one more than the number of balls, or 10 without a
        bearing.
        What the orders beyond do at the balls, beyond Hertz, is folded onto those that are carried, so that
        loads and displacements at rest do not depend on it; see `compliance`, which tells how much that is.
    groove
        Axial width of the face that carries the balls, m; None: half of the ring's.
    groove_radius
        Radius of the groove's section, m (fo·Dw): the section then has the groove cut into it; None: a plain
        rectangle.
    layer
        Rubber, its r_inner equal to r_outer here; its material, moduli and refinement are taken.
    outside
        "rigid" or "flexible", where there is no layer; or what stands between the ring and the rigid
        interface "outer": a RingBed, RingPoints, or several of them.
    damping
        Ratio ζ of the ring's free elastic modes.
    refinement
        Mesh density.
    f_max
        Receptances of the raceway, and what the interfaces feel, are right to 1 % up to this frequency, Hz;
        0: at rest only. `error` is the estimate.
    bearing
        The bearing that runs in the ring. What Hertz's contact has already of the give of the race is then
        taken out of it; without it a ring serves by itself, and carries no balls.
    load
        Load of a ball, N, whose contact ellipse is the footprint on the race; None: of the heaviest ball
        under a quarter of the bearing's static rating. Eight times the load, twice the ellipse, change the
        give by a few per cent.
    outputs
        name -> point (r, z, φ), m, m, rad, whose motion (x, y, z) can be recorded, as "ring.name.x".
    race
        "outer", or "inner" for the ring on the shaft.

    Raises
    ------
    ValueError
        For dimensions out of order, a groove that does not fit, a layer that does not touch, an order below
        the number of balls, a ring thinner than the contact ellipse is long, or waves of f_max that the mesh
        does not hold.
    """

    r_inner: float
    r_outer: float
    width: float
    arm: float | None = None
    order: int | None = None
    groove: float | None = None
    groove_radius: float | None = None
    layer: Layer | None = None
    outside: Literal["rigid", "flexible"] | RingBed | RingPoints | tuple[RingBed | RingPoints, ...] = "rigid"
    material: Elastic = STEEL
    damping: float = 0.0
    f_max: float = F_HEARD
    refinement: float = 1.0
    bearing: BallBearing | None = None
    load: float | None = None
    outputs: Mapping[str, tuple[float, float, float]] = field(default_factory=dict)
    race: Literal["outer", "inner"] = "outer"

    _repr_html_ = page

    def __post_init__(self) -> None:
        one_of("race", self.race, ("outer", "inner"))
        positive("r_inner", self.r_inner, "it must be a positive radius in m")
        positive("r_outer", self.r_outer, "it must be a positive radius in m")
        if not self.r_inner < self.r_outer < math.inf:
            raise ValueError(f"r_outer is {self.r_outer}; it must exceed r_inner = {self.r_inner} m")
        positive("width", self.width, "it must be a positive length in m")
        positive("refinement", self.refinement, "it must be a positive mesh density, 1 by default")
        for name in ("r_outer", "width"):
            plausible("length", name, getattr(self, name))
        self._take_bearing()
        assert self.arm is not None
        if self.inner and not self.arm > self.r_inner:
            raise ValueError(
                f"arm is {self.arm} m; it must lie outside the bore, above r_inner = {self.r_inner} m: it is "
                "the radius on which the centres of the inner groove lie; take bearing.arm"
            )
        if not self.inner and not self.arm < self.r_outer:
            raise ValueError(
                f"arm is {self.arm} m; it must lie inside the ring, below r_outer = {self.r_outer} m: it is "
                "the radius on which the centres of the outer groove lie; take bearing.arm"
            )
        for name in ("groove", "groove_radius"):
            if getattr(self, name) is not None:
                length = positive(name, getattr(self, name), "it must be a positive length in m")
                plausible("length", name, length)
        if self.groove is not None and not 0 < self.groove <= self.width:
            raise ValueError(f"groove is {self.groove}; it must lie in 0...width = {self.width} m")
        if self.groove_radius is not None:
            half = 0.5 * self.track
            if not self.groove_radius > half or not self.track < self.width:
                raise ValueError(
                    f"groove_radius is {self.groove_radius}; it must exceed half the groove's width, "
                    f"{half} m, and the groove must be narrower than the ring"
                )
            if not self.depth < self.r_outer - self.r_inner:
                raise ValueError(f"the groove is {self.depth:g} m deep and cuts the ring; make it narrower")
        if not self._supports:
            one_of("outside", self.outside, ("rigid", "flexible"))
        if self.layer is not None:
            instance("layer", self.layer, Layer, "it must be a bd.Layer(…), or None")
            meets, seat = ("r_outer", "r_inner") if self.inner else ("r_inner", "r_outer")
            if not math.isclose(getattr(self.layer, meets), self.seat, rel_tol=1e-9):
                raise ValueError(
                    f"layer.{meets} is {getattr(self.layer, meets)}; a layer is bonded to the ring at "
                    f"{seat} = {self.seat} m"
                )
            if self.outside != "rigid":
                raise ValueError(
                    f"outside is {self.outside!r}; with a layer the ring's outside is the rubber's: "
                    "leave it out"
                )
        self._check_footprint()
        _ = self.body

    @property
    def inner(self) -> bool:
        """Whether it is the ring on the shaft."""
        return self.race == "inner"

    @property
    def seat(self) -> float:
        """Radius of the side away from the balls, m."""
        return self.r_inner if self.inner else self.r_outer

    @property
    def held(self) -> str:
        """Name of the rigid interface that holds the ring: "outer", or "inner"."""
        return self.race

    @property
    def back(self) -> str:
        """Name of the raceway by which the side away from the balls moves, where it does by orders."""
        return "inside" if self.inner else "outside"

    @property
    def _supports(self) -> tuple[RingBed | RingPoints, ...]:
        """Beds and feet of the outside."""
        given = self.outside if isinstance(self.outside, tuple) else (self.outside,)
        return tuple(q for q in given if isinstance(q, RingBed | RingPoints)) if given else ()

    def _take_bearing(self) -> None:
        """Arm and order from the bearing, where they are not given."""
        if self.bearing is None:
            require(self.load is None, "load", self.load, "it is of a ball: give the bearing too")
            arm, order = self.arm, 10 if self.order is None else self.order
            remedy = "it must be a positive radius in m, or give the bearing that runs in the ring"
            plausible("length", "arm", positive("arm", arm, remedy))
        else:
            instance("bearing", self.bearing, BallBearing, "it must be a bd.BallBearing(…), or None")
            arm, Z = self.bearing.arm, self.bearing.Z
            if self.arm is not None and not math.isclose(self.arm, arm, rel_tol=1e-9):
                raise ValueError(f"arm is {self.arm!r}; the bearing's is {arm:.9g} m: leave it out")
            order = Z + 1 if self.order is None else self.order
            whole("order", order, 1, HIGHEST)
            if not order >= Z:
                raise ValueError(
                    f"order is {order}; the bearing has {Z} balls, whose loads bend the ring by cos {Z}ψ: "
                    f"give {Z + 1}, or leave it out"
                )
            self._check_race(self.bearing)
            if self.load is not None:
                positive("load", self.load, "it must be the positive load of a ball in N")
        object.__setattr__(self, "arm", arm)
        object.__setattr__(self, "order", order)

    def _check_race(self, bearing: BallBearing) -> None:
        """Raise ValueError where the balls of a bearing cannot run on the race."""
        pitch, depth = 0.5 * bearing.Dpw, REACH * bearing.Dw
        name, radius = ("r_outer", self.r_outer) if self.inner else ("r_inner", self.r_inner)
        low, high = (pitch - depth, pitch) if self.inner else (pitch, pitch + depth)
        require(
            low <= radius <= high,
            name,
            radius,
            f"balls of {bearing.Dw:.4g} m on a pitch circle of {bearing.Dpw:.4g} m run on a race from "
            f"{low:.4g} to {high:.4g} m: give a radius in m there",
        )

    def _check_footprint(self) -> None:
        """Raise ValueError where the contact is as large as the ring."""
        if self.footprint is None:
            return
        length, wall = 2.0 * self.footprint.half_length, self.wall
        if not length < 2.0 * wall:
            if self.inner:
                most = _just_above(self.r_inner - 0.5 * length + wall, 1e-6) - 2e-6
                name, remedy = "r_inner", f"at most {most:.9g}"
            else:
                least = _just_above(self.r_outer + 0.5 * length - wall, 1e-6)
                name, remedy = "r_outer", f"at least {least:.9g}"
            raise ValueError(
                f"{name} is {self.seat}; the ring is {1e3 * wall:.3g} mm thick under a contact "
                f"{1e3 * length:.3g} mm long, and Hertz's law is of thick bodies: make {name} {remedy} m, "
                f"or state a smaller load"
            )
        if not length < self.track:
            raise ValueError(
                f"groove is {self.track:g} m wide; the contact is {length:.3g} m long: widen the groove, "
                f"or state a smaller load"
            )

    def check_bearing(self, name: str, bearing: BallBearing) -> None:
        """Check a bearing that is hung in a ring made by its arm alone, which knew no balls.

        Raises
        ------
        ValueError
            Where the balls cannot run on the race.

        Warns
        -----
        FitWarning
            Where the contact is as large as the ring, or longer than its groove.
        """
        if self.bearing is not None:
            return
        try:
            self._check_race(bearing)
        except ValueError as error:
            raise ValueError(f"bearing {name!r} in a FlexibleRing: {error}") from None
        length = 2.0 * self._footprint_of(bearing).half_length
        if not length < min(2.0 * self.wall, self.track):
            warn(
                f"bearing {name!r} in a FlexibleRing: its contact is {1e3 * length:.3g} mm long, the ring "
                f"{1e3 * self.wall:.3g} mm thick under it and the groove {1e3 * self.track:.3g} mm wide: "
                "Hertz's law is of thick bodies; make the ring thicker, or with bearing= and a load",
                FitWarning,
            )

    @classmethod
    def of(cls, bearing: BallBearing, **keywords: Any) -> FlexibleRing:
        """The outer ring of a bearing, or with race="inner" the inner one, with its groove, from its boundary
        dimensions; keywords as in FlexibleRing.

        The groove's bottom touches the balls of the centred bearing but for half the radial play; the
        shoulders stand 0.16 of the ball's diameter above it, 0.3 in an angular contact bearing, where both
        are drawn and the open side is too heavy.

        Raises
        ------
        ValueError
            For a bearing without boundary dimensions, or too thin a ring.

        Examples
        --------
        >>> import bearingdyn as bd
        >>> ring = bd.FlexibleRing.of(bd.catalogue.bearing("6305", clearance=10e-6), outside="flexible")
        >>> f"{1e3 * ring.r_inner:.2f} mm at the shoulders, {1e3 * ring.depth:.2f} mm deep"
        '25.54 mm at the shoulders, 1.65 mm deep'
        """
        instance("bearing", bearing, BallBearing, "it must be a bd.BallBearing(…)")
        if bearing.boundary is None:
            raise ValueError(
                "bearing.boundary is None; give it (bore, outside, width) in m, or make the ring by hand"
            )
        bore, outside, width = bearing.boundary
        angle = bearing.contact_angle or 0.0
        depth = (SHOULDER if angle == 0.0 else SHOULDER_ANGULAR) * bearing.Dw
        if keywords.get("race") == "inner":
            rho = bearing.fi * bearing.Dw
            radii = 0.5 * bore, bearing.geometry.R_i - rho + depth
        else:
            rho = bearing.fo * bearing.Dw
            radii = bearing.geometry.R_o + rho - depth, 0.5 * outside
        sizes = {
            "r_inner": radii[0],
            "r_outer": radii[1],
            "width": width,
            "groove": 2.0 * math.sqrt(rho**2 - (rho - depth) ** 2),
            "groove_radius": rho,
        }
        return cls(**{**sizes, "bearing": bearing, **keywords})

    @property
    def wall(self) -> float:
        """Thickness of the ring under the groove, m."""
        return self.r_outer - self.r_inner - self.depth

    @cached_property
    def footprint(self) -> Footprint | None:
        """Where the balls touch; None without a bearing."""
        return None if self.bearing is None else self._footprint_of(self.bearing)

    def _footprint_of(self, bearing: BallBearing) -> Footprint:
        angle = bearing.contact_angle or 0.0
        load = self.load
        if load is None:
            load = 1.25 * bearing.static_rating / (bearing.Z * math.cos(angle))
        # from the groove's centre towards the ring
        away = -1.0 if self.inner else 1.0
        race = self.r_outer if self.inner else self.r_inner
        if self.groove_radius is None:
            at = (race, 0.0)
        else:
            centre = race + away * (self.depth - self.groove_radius)
            reach = away * self.groove_radius
            at = (centre + reach * math.cos(angle), reach * math.sin(angle))
        side = -1.0 if bearing.open_side == "+z" else 1.0
        contact = bearing.inner_contact if self.inner else bearing.outer_contact
        return Footprint((at[0], side * at[1]), side * angle, contact.semi_axes(load)[0])

    @cached_property
    def compliance(self) -> RingCompliance:
        """What the ring gives beyond Hertz, order by order, rubber at its relaxed modulus.

        Raises
        ------
        ValueError
            For a ring without a bearing.
        """
        if self.bearing is None or self.footprint is None:
            raise ValueError(
                "bearing is None; what a ring gives beyond Hertz depends on its balls: give bearing="
            )
        assert self.order is not None
        normal, held = self.footprint.normal, self.body.interfaces
        low = [
            self.body.carried_compliance(n, "raceway", normal) if held or n > 1 else math.nan
            for n in range(self.order + 1)
        ]
        if not held:
            low[0] = self.body.groove_compliance(0, "raceway", normal)
        return ring_compliance(
            lambda n: self.body.groove_compliance(n, "raceway", normal),
            np.array(low),
            Z=self.bearing.Z,
            half_length=self.footprint.half_length,
            radius=self.footprint.point[0],
            depth=self.wall,
            material=self.material,
        )

    def race_waves(self, bore: BoreShape) -> tuple[Waviness, ...]:
        """Waves of the race of this ring, pressed into a bore that is not round, as the bearing takes them.

        The outside follows the bore all round, without friction along it; tilts of the section and the fit
        itself, which is the clearance's affair, are left out.

        Parameters
        ----------
        bore
            The shape and the interference that keeps the ring in touch with it.

        Returns
        -------
        tuple of Waviness
            For BallBearing(waviness=…).

        Raises
        ------
        ValueError
            For a ring in rubber, or an interference at which the ring parts from the bore.
        """
        instance("bore", bore, BoreShape, "it must be a bd.BoreShape(…)")
        require(not self.inner, "race", self.race, "an inner ring sits on a shaft, and no bore shapes it")
        if self.layer is not None:
            raise ValueError(
                "layer is given; a bore's shape is known to the ring only without rubber between"
            )
        free = self.body if "outside" in self.body.grooves else replace(self, outside="flexible").body
        C = {n: free.groove_compliances(n) for n in (0, *bore.waves)}
        least, psi = bore.parted({n: float(c[2, 2]) for n, c in C.items()})
        if not bore.interference >= least:
            raise ValueError(
                f"bore.interference is {bore.interference:g} m; the ring parts from the bore at "
                f"{math.degrees(psi):.3g} degrees: "
                f"make it at least {_just_above(least, 1e-9):.9g} m on the radius"
            )
        return tuple(
            Waviness("outer", n, math.hypot(a, b) * float(c[0, 2] / c[2, 2]), phase=math.atan2(-b, a))
            for n, c in C.items()
            if n
            for a, b in [bore.waves[n]]
        )

    @property
    def track(self) -> float:
        """Axial width of the face that carries the balls, m."""
        return 0.5 * self.width if self.groove is None else self.groove

    @property
    def depth(self) -> float:
        """Depth of the groove below the shoulders, m."""
        if self.groove_radius is None:
            return 0.0
        return self.groove_radius - math.sqrt(self.groove_radius**2 - (0.5 * self.track) ** 2)

    @cached_property
    def body(self) -> Revolved:
        """The ring, and its rubber, as a body of revolution."""
        half, track = 0.5 * self.width, 0.5 * self.track
        regions: list[Region] = [Region((self.r_inner, self.r_outer), (-half, half), self.material)]
        race, seat, end = self.r_inner, self.r_outer, self.seat
        if self.inner:
            race, seat = seat, race
        face: Face = Cylinder(race, (-track, track))
        if self.layer is not None:
            end = self.layer.r_inner if self.inner else self.layer.r_outer
            radii, reach = (min(seat, end), max(seat, end)), 0.5 * self.layer.width
            regions.append(Region(radii, (-reach, reach), self.layer.material, graded=True))
        section = None
        if self.groove_radius is not None or self.footprint is not None:
            section = ring_section(
                [q.rectangle for q in regions],
                self.refinement,
                track,
                self.footprint,
                self.groove_radius,
                self.inner,
            )
        if self.groove_radius is not None:
            face = Where(
                lambda r, z: (np.abs(z) <= track * (1 + 1e-9)) & (np.abs(r - race) <= 1.01 * self.depth)
            )
        assert self.arm is not None
        assert self.order is not None
        grooves = {"raceway": Groove(face, self.arm, self.order, z=0.0, footprint=self.footprint)}
        interfaces: dict[str, Face] = {}
        if self.layer is None and self.outside != "rigid":
            grooves[self.back] = Groove(Line((end, -half), (end, half)), end, self.order, z=0.0)
        else:
            interfaces[self.held] = Cylinder(end)
        return Revolved(
            tuple(regions) if section is None else tuple(Patch(q.material) for q in regions),
            interfaces,
            self.outputs,
            damping=self.damping,
            f_max=self.f_max,
            moduli=None if self.layer is None else self.layer.moduli,
            refinement=self.refinement,
            grooves=grooves,
            section=section,
        )

    def profile(self) -> list[Profile]:
        """What the plane x = 0 shows of it; see Revolved.profile."""
        return self.body.profile()

    def round_faces(self) -> Mapping[str, tuple[RoundFace, ...]]:
        """Cylinders at its interfaces, against which an application checks the neighbours."""
        bonded = self.layer is not None
        known = {k: tuple(replace(f, bonded=bonded) for f in v) for k, v in self.body.round_faces().items()}
        half = (-0.5 * self.width, 0.5 * self.width)
        if self.layer is None and self.outside == "flexible":
            known[self.back] = (RoundFace("bore" if self.inner else "shaft", self.seat, half),)
        elif self._supports:
            known[self.held] = (RoundFace("bore" if self.inner else "shaft", self.seat, half),)
        return known

    @property
    def error(self) -> dict[int, float]:
        """Estimate, by order, of the largest error of receptances over 0…f_max; see Revolved.error."""
        return self.body.error

    @cached_property
    def _folded(self) -> tuple[tuple[int, int, float], ...]:
        """(order, sine, compliance) of what the orders beyond add to those that are carried."""
        if self.bearing is None:
            return ()
        Z, folded = self.bearing.Z, self.compliance.folded
        return tuple(
            (p, sine, float(c))
            for p, c in enumerate(folded)
            for sine in ((0, 1) if p else (0,))
            if c > NEGLIGIBLE * float(np.abs(folded).max()) and not (sine and 2 * p == Z)
        )

    def superelement(self) -> Superelement:
        """Reduced matrices: interface and internal modes, and the raceways' coefficients; see
        Revolved.superelement.

        With a bearing, what orders beyond the carried ones add at its balls are coordinates of their own,
        springs with so little mass that they follow at once.
        """
        element = self.body.superelement()
        if self._supports:
            element = upon_supports(element, self._supports, self.seat, self.width, self.back, self.held)
        if self.footprint is not None:
            element = with_folded(
                element, self.compliance, self._folded, self.footprint.normal, self.f_max, self.damping
            )
        if self.inner:
            element = replace(element, G=gyroscopic(element, self.held, self.back, self.body.polar_inertia))
        return replace(element, faces=self.round_faces())

    def turning_error(self, speed: float) -> float:
        """What is left out of an inner ring's inertia as it turns, relative to its stiffness: (nΩ/ω)².

        Parameters
        ----------
        speed
            Of the shaft, rad/s.

        Returns
        -------
        float
            For the highest order n and the lowest elastic frequency ω of the ring, on its held seat unless it
            is loose, the rubber at its relaxed modulus: an upper bound.
        """
        omega = plausible("speed", "speed", speed, "it must be a finite speed in rad/s")
        element = self.body.superelement()
        if self._supports:
            element = upon_supports(element, self._supports, self.seat, self.width, self.back, self.held)
        held = element.interfaces.get(self.held, np.zeros(0, dtype=np.intp))
        rest = np.setdiff1d(np.arange(element.n), held)
        at = np.ix_(rest, rest)
        squares = scipy.linalg.eigh(element.stiffness().real[at], element.M[at], eigvals_only=True)
        # a ring that nothing holds has rigid motions too, at zero but for round-off
        lowest = squares[squares > 1e-10 * squares[-1]][0]
        assert self.order is not None
        return float((self.order * omega) ** 2 / lowest)

    def outline(self) -> Outline:
        """Its surface; see Revolved.outline."""
        outline = self.body.outline()
        none = np.zeros((len(outline.rows), len(self._folded) + (6 if self._supports else 0)))
        return replace(outline, rows=np.hstack([outline.rows, none]))


def _just_above(value: float, step: float) -> float:
    """The next whole number of steps, so that what a message names does."""
    return (math.floor(value / step) + 1) * step
