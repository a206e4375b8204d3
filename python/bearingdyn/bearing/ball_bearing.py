"""A ball bearing as it is described: balls, grooves, material, film, damping, imperfections; and its kernel.

What it answers to a motion of its rings stands in `rigid_ring_law`.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, fields, replace
from functools import cached_property, wraps
from typing import Any, NamedTuple, TypeVar, cast

import numpy as np

from bearingdyn.bearing.characteristic_frequencies import Frequencies
from bearingdyn.bearing.contact_damping import Damping, as_damping
from bearingdyn.bearing.contact_pressure import STATIC_PRESSURE
from bearingdyn.bearing.geometry import Geometry
from bearingdyn.bearing.hertz import PointContact, race_contact, resultant_deflection_coefficient
from bearingdyn.bearing.imperfections import Body, Imperfections, Pit, Waviness, checked
from bearingdyn.bearing.kernel import BearingKernel
from bearingdyn.bearing.oil_supply import OilSupply
from bearingdyn.bearing.open_side import OpenSide, open_sine, shoulder
from bearingdyn.bearing.raceway_series import RIGID, RacewaySeries
from bearingdyn.bearing.rigid_ring_law import RigidRingLaw
from bearingdyn.bearing.ring_speeds import Turning, ring_speeds
from bearingdyn.checks import instance, nonnegative, number, one_speed, positive, require, vector, whole
from bearingdyn.material import STEEL, Elastic
from bearingdyn.pictures import picture
from bearingdyn.plausible_ranges import check_speed_value, plausible
from bearingdyn.units import takes


class Overrides(NamedTuple):
    """Overrides of a ball bearing: values given instead of those its geometry has; None for none."""

    kappa: float | None = None
    cage_ratio: float | None = None
    arm: float | None = None


_Frozen = TypeVar("_Frozen", "BallBearing", Waviness, Pit)


def _changed(given: _Frozen, **values: object) -> _Frozen:
    """A copy with other values, which are not checked again."""
    made = object.__new__(type(given))
    for own in fields(given):
        object.__setattr__(made, own.name, values.get(own.name, getattr(given, own.name)))
    return made


_Init = TypeVar("_Init", bound=Callable[..., None])


def _by_measures(init: _Init) -> _Init:
    """Making a bearing by its measures, which says where those of a designation are found."""

    @wraps(init)
    def checked(self: BallBearing, *args: Any, **kwargs: Any) -> None:
        Z = args[0] if args else kwargs.get("Z")
        if isinstance(Z, str):
            raise ValueError(
                f"Z is {Z!r}; it must be the number of balls, before Dw, Dpw, fi and fo; a bearing by its "
                f"designation is bd.catalogue.bearing({Z!r})"
            )
        init(self, *args, **kwargs)

    return cast(_Init, checked)


@takes(
    Dw="m",
    Dpw="m",
    clearance="m",
    contact_angle="rad",
    film="m",
    damping="N s/m",
    kappa="N/m^1.5",
    angle0="rad",
    oversize="m",
    arm="m",
    boundary="m",
)
@dataclass(frozen=True, init=False)
class BallBearing(RigidRingLaw):
    """Single-row ball bearing with rigid rings.

    q = 0 is the centred position when a clearance is given, and the position in which all balls just touch
    when a contact angle is given (A sinα0 further along z than centred).

    Parameters
    ----------
    Z
        Number of balls, ≥ 3.
    Dw, Dpw
        Ball and pitch diameter, m.
    fi, fo
        Groove radius over ball diameter, inner and outer race, above ½.
    clearance
        Diametral clearance Pd, m; negative where the rings clamp the balls. Exactly one of clearance and
        contact_angle.
    contact_angle
        Free contact angle α0, rad; the inner ring then carries axial load towards +z, see `open_side`.
    material, ball_material
        Elastic material of the rings and of the balls.
    film
        Central film thickness of both contacts of a ball together, h_i + h_o, m: F = κ (δ + film)^{3/2}.
    damping
        Damping of one ball, both contacts in series: a number in N s/m, or ConstantDamping, TabulatedDamping,
        LoadDamping, FilmDamping.
    kappa
        Deflection coefficient of one ball, both contacts in series, instead of Hertz's, N/m^1.5.
    cage_ratio
        Cage speed over inner-ring speed with the outer ring at rest, instead of ½(1 − γ).
    angle0
        Azimuth of the first ball at cage angle 0, rad, from x towards y.
    waviness, defects
        Waviness and Pit objects of bearingdyn.bearing.
    oversize
        (Z,) diameter of each ball beyond Dw, m; empty: all equal.
    arm
        Arm of tilts and moments instead of the radius R_i of the inner groove centres, m.
    turning
        Which ring turns with the shaft, "inner", "outer" or "both", or the speeds of inner and outer ring
        over that of the shaft, such as (1.0, -0.5). None: an application sees it from what the rings are hung
        on, and elsewhere the inner ring turns.
    open_side
        Where there is no shoulder: "-z", and axial load on the inner ring is borne towards +z alone, or "+z",
        the same bearing hung the other way round. None: both ways. "auto": "-z" with a contact angle, else
        None. A load that presses balls onto the open side is refused.
    boundary
        (bore, outside, width), m, against which an application checks shaft and housing; None: not known.
    lubrication
        OilSupply: `bd.equilibrium` then puts film and damping of the loads that it finds in place of `film`
        and `damping`. None: film and damping as given.
    overrides
        For `dataclasses.replace` only: carries kappa, cage_ratio and arm as given, so that a changed geometry
        changes what was not given.

    Raises
    ------
    ValueError
        Naming the field, its value and what would be right.

    Examples
    --------
    >>> import bearingdyn as bd
    >>> hard = {"material": bd.Elastic(207e9, 0.3, 7850.0), "ball_material": bd.Elastic(207e9, 0.3, 7850.0)}
    >>> ball = bd.BallBearing(Z=8, Dw=5.953e-3, Dpw=25e-3, fi=0.52, fo=0.53, clearance=10e-6, **hard)
    >>> q = ball.displacement([0, 0, 180.0, 0, 0, 0])  # 180 N along the axis
    >>> print(f"{q[2] * 1e6:.2f} µm from centred, {ball.stiffness(q)[0, 0] / 1e6:.2f} N/µm radially")
    77.76 µm from centred, 95.33 N/µm radially
    """

    Z: int
    Dw: float
    Dpw: float
    fi: float
    fo: float
    clearance: float | None
    contact_angle: float | None
    material: Elastic
    ball_material: Elastic
    film: float
    damping: Damping
    angle0: float
    waviness: tuple[Waviness, ...]
    defects: tuple[Pit, ...]
    oversize: tuple[float, ...]
    turning: Turning | None
    open_side: OpenSide
    boundary: tuple[float, float, float] | None
    lubrication: OilSupply | None
    overrides: Overrides

    def _repr_html_(self) -> str:
        return str(picture("as_html", self))

    def __repr__(self) -> str:
        """One line: the geometry, and what is not usual."""
        play = (
            f"clearance {1e6 * self.clearance:.4g} µm"
            if self.clearance is not None
            else f"contact angle {math.degrees(self.contact_angle or 0.0):.4g}°"
        )
        film = f", film {1e6 * self.film:.4g} µm" if self.film else ""
        return (
            f"<BallBearing: {self.Z} balls of Ø{1e3 * self.Dw:.5g} mm on Ø{1e3 * self.Dpw:.5g} mm, grooves "
            f"{self.fi:g} and {self.fo:g}, {play}{film}>"
        )

    @_by_measures
    def __init__(
        self,
        Z: int,
        Dw: float,
        Dpw: float,
        fi: float,
        fo: float,
        *,
        clearance: float | None = None,
        contact_angle: float | None = None,
        material: Elastic = STEEL,
        ball_material: Elastic = STEEL,
        film: float = 0.0,
        damping: float | Damping = 0.0,
        kappa: float | None = None,
        cage_ratio: float | None = None,
        angle0: float = 0.0,
        waviness: Sequence[Waviness] = (),
        defects: Sequence[Pit] = (),
        oversize: Sequence[float] = (),
        arm: float | None = None,
        turning: Turning | None = None,
        open_side: OpenSide = "auto",
        boundary: tuple[float, float, float] | None = None,
        lubrication: OilSupply | None = None,
        overrides: Overrides = Overrides(),  # noqa: B008 (immutable)
    ) -> None:
        Geometry(Z, Dw, Dpw, fi, fo, clearance, contact_angle)
        for name, body in (("material", material), ("ball_material", ball_material)):
            require(isinstance(body, Elastic), name, body, "give a material.Elastic, such as STEEL")
        instance("overrides", overrides, Overrides, "leave it out: kappa=, cage_ratio= and arm= are meant")
        given = Overrides(
            overrides.kappa if kappa is None else kappa,
            overrides.cage_ratio if cage_ratio is None else cage_ratio,
            overrides.arm if arm is None else arm,
        )
        if given.kappa is not None:
            kappa = positive("kappa", given.kappa, "it must be positive and finite, in N/m^1.5")
            plausible("deflection coefficient", "kappa", kappa)
        if given.cage_ratio is not None:
            ratio = number("cage_ratio", given.cage_ratio)
            require(0 <= ratio <= 1, "cage_ratio", ratio, "it must lie in 0..1 (½(1 − γ), near 0.4)")
        if given.arm is not None:
            plausible("length", "arm", positive("arm", given.arm, "it must be positive and finite, in m"))
        if turning is not None and not isinstance(turning, str):
            turning = ring_speeds(turning)
        ring_speeds(turning)
        shoulder(open_side, contact_angle)
        if boundary is not None:
            boundary = _measures(boundary, Dpw, Dw)
        remedy = "give an OilSupply(lubricant, temperature, speed), or None"
        require(isinstance(lubrication, OilSupply | None), "lubrication", lubrication, remedy)
        waves, pits, sizes = checked(int(Z), waviness, defects, oversize)
        values = {
            "Z": int(Z),
            "Dw": Dw,
            "Dpw": Dpw,
            "fi": fi,
            "fo": fo,
            "clearance": clearance,
            "contact_angle": contact_angle,
            "material": material,
            "ball_material": ball_material,
            "film": plausible(
                "film", "film", nonnegative("film", film, "it must be zero or positive, in m (h_i + h_o)")
            ),
            "damping": as_damping(damping),
            "angle0": plausible("angle", "angle0", angle0, "it must be a finite angle in rad"),
            "waviness": waves,
            "defects": pits,
            "oversize": sizes,
            "turning": turning,
            "open_side": open_side,
            "boundary": boundary,
            "lubrication": lubrication,
            "overrides": given,
        }
        for name, value in values.items():
            object.__setattr__(self, name, value)

    @cached_property
    def geometry(self) -> Geometry:
        """Balls and grooves: A, α0, play, R_i, R_o, γ, osculation, kinematics."""
        return Geometry(self.Z, self.Dw, self.Dpw, self.fi, self.fo, self.clearance, self.contact_angle)

    @cached_property
    def inner_contact(self) -> PointContact:
        """Hertz contact of a ball with the inner race."""
        return race_contact(self.geometry, "inner", self.material, self.ball_material)

    @cached_property
    def outer_contact(self) -> PointContact:
        """Hertz contact of a ball with the outer race."""
        return race_contact(self.geometry, "outer", self.material, self.ball_material)

    @cached_property
    def kappa(self) -> float:
        """Deflection coefficient κ of one ball, both contacts in series (paper eq. 2), N/m^1.5."""
        if self.overrides.kappa is not None:
            return float(self.overrides.kappa)
        return resultant_deflection_coefficient(self.inner_contact.kappa, self.outer_contact.kappa)

    @property
    def ring_speeds(self) -> tuple[float, float]:
        """Speeds of inner and outer ring over that of the shaft."""
        return ring_speeds(self.turning)

    @property
    def cage_ratio(self) -> float:
        """Cage speed over shaft speed: ½(1 − γ) where the inner ring turns, ½(1 + γ) where the outer does."""
        given, (inner, outer) = self.overrides.cage_ratio, self.ring_speeds
        against_outer = self.geometry.cage_ratio if given is None else float(given)
        return outer + against_outer * (inner - outer)

    @property
    def spin_ratio(self) -> float:
        """Spin of a ball about its own axis over shaft speed; negative where the outer ring is faster."""
        inner, outer = self.ring_speeds
        return self.geometry.ball_spin(1.0) * (inner - outer)

    def mirrored(self) -> BallBearing:
        """The bearing hung the other way round: its shoulder and its open side change places.

        Waves and pits stay as they are described in space.

        Raises
        ------
        ValueError
            For a bearing given by its contact angle that is said to have two shoulders.
        """
        side = shoulder(self.open_side, self.contact_angle)
        if side == 0:
            require(not self.contact_angle, "open_side", self.open_side, 'to be mirrored, give "+z" or "-z"')
            return self
        return replace(self, open_side="+z" if side > 0 else "-z")

    def misaligned(
        self, inner: tuple[float, float] = (0.0, 0.0), outer: tuple[float, float] = (0.0, 0.0)
    ) -> BallBearing:
        """The bearing with rings that sit askew on shaft or in housing; each tilt turns with its ring.

        A race that is tilted runs out along the axis once a turn: an axial wave of order 1.

        Parameters
        ----------
        inner, outer
            (θx, θy) of the ring against its seat, rad, when the shaft stands at zero.

        Raises
        ------
        ValueError
            For anything else than two finite small angles.
        """
        waves = list(self.waviness)
        rings: tuple[tuple[Body, tuple[float, float]], ...] = (("inner", inner), ("outer", outer))
        for body, tilt in rings:
            field = f"tilt of the {body} ring"
            x, y = vector(field, tilt, (2,), "(θx, θy) in rad").tolist()
            for angle in (x, y):
                plausible("tilt", field, angle)
            if x or y:
                # R (θx sin ψ − θy cos ψ) = a cos(ψ + φ), the inner groove being the outer's arm away too
                waves.append(Waviness(body, 1, self.arm * math.hypot(x, y), math.atan2(-x, -y), "axial"))
        return replace(self, waviness=tuple(waves))

    @property
    def arm(self) -> float:
        """Arm R of tilts and moments, m."""
        return self.geometry.R_i if self.overrides.arm is None else float(self.overrides.arm)

    def pressure(self, load: float) -> float:
        """Largest contact pressure of a ball under a load, N, in the heavier of its two contacts, Pa."""
        return max(c.pressure(load) for c in (self.inner_contact, self.outer_contact))

    @cached_property
    def static_rating(self) -> float:
        """Radial load ZQcosα/5 with 4.2 GPa in the heavier contact (ISO 76), N; axial play neglected."""
        return self.Z * self.static_ball_load * math.cos(self.contact_angle or 0.0) / 5

    @cached_property
    def static_ball_load(self) -> float:
        """Load of one ball with 4.2 GPa in its heavier contact (ISO 76), N."""
        return min(c.load_at_pressure(STATIC_PRESSURE) for c in (self.inner_contact, self.outer_contact))

    @takes(speed="rad/s", contact_angle="rad")
    def frequencies(
        self, speed: float | None = None, contact_angle: float | None = None, *, rpm: float | None = None
    ) -> Frequencies:
        """Cage, ball-pass and ball-spin frequencies, Hz, at a speed of the shaft, in pure rolling.

        Which ring turns with the shaft is said by `turning`.

        Parameters
        ----------
        speed
            rad/s.
        contact_angle
            Of the loaded state, rad; None: the nominal one, 0 if a clearance is given.
        rpm
            The speed in revolutions a minute, instead of `speed`.
        """
        speed = plausible("speed", "speed", one_speed(speed, rpm), "it must be a finite speed in rad/s")
        check_speed_value("speed", speed, self.Dpw)
        rings = [ratio * speed for ratio in self.ring_speeds]
        if contact_angle is None:
            return self.geometry.frequencies(*rings)
        loaded = abs(number("contact_angle", contact_angle, "it must be a finite angle in rad"))
        return Geometry(self.Z, self.Dw, self.Dpw, self.fi, self.fo, contact_angle=loaded).frequencies(*rings)

    def lines(
        self, speed: float, *, harmonics: int = 1, contact_angle: float | None = None
    ) -> dict[str, float]:
        """Name -> frequency, Hz, of localised defects and the cage, as `fault_lines` gives them.

        Parameters
        ----------
        speed
            Of the shaft, rad/s.
        harmonics
            How many multiples of the ball passes and of 2 BSF.
        contact_angle
            Of the loaded state, rad; None: nominal.
        """
        harmonics, speed = whole("harmonics", harmonics, 1, 10_000), number("speed", speed)
        f = self.frequencies(speed, contact_angle)
        found = {"shaft": abs(speed) / (2 * math.pi), "FTF": f.FTF}
        for k in range(1, harmonics + 1):
            found |= {
                f"{k} BPFO" if k > 1 else "BPFO": k * f.BPFO,
                f"{k} BPFI" if k > 1 else "BPFI": k * f.BPFI,
                f"{2 * k} BSF": 2 * k * f.BSF,
            }
        return found

    def turned(self, angle: float) -> BallBearing:
        """The bearing as it stands with its cage at `angle`, rad, from now on called zero.

        The shaft has turned by angle/cage_ratio and the balls have spun: waves and pits stand accordingly.
        """
        angle = number("angle", angle, "it must be a finite angle in rad")
        shaft = angle / self.cage_ratio if self.cage_ratio else 0.0
        inner, outer = self.ring_speeds
        # a wave's argument is order·(azimuth − turn of its ring) on a race and order·spin on a ball
        carried = {"inner": inner * shaft, "outer": outer * shaft, "ball": -self.spin_ratio * shaft}
        # as they were given, they have been checked, and warned of where that was due
        return _changed(
            self,
            angle0=self.angle0 + angle,
            waviness=tuple(_changed(w, phase=w.phase - w.order * carried[w.body]) for w in self.waviness),
            defects=tuple(_changed(p, angle=p.angle + carried[p.body]) for p in self.defects),
        )

    def kernel(self, series: RacewaySeries = RIGID) -> BearingKernel:
        """The bearing as the contact kernel takes it, with the relative raceway coefficients of `series`."""
        if series == RIGID:
            return self._kernel
        axial, order, sine = series.columns
        return replace(self._kernel, axial=axial, order=order, sine=sine)

    @cached_property
    def _kernel(self) -> BearingKernel:
        geometry, A = self.geometry, self.geometry.A
        law, c, table = self.damping.kernel_fields()
        if self.clearance is not None:
            half = self.clearance / 2
            x0, y0, e0 = 0.0, A - half, -half * (2 * A - half)
        else:
            x0, y0, e0 = A * math.sin(geometry.alpha0), A * math.cos(geometry.alpha0), 0.0
        side = shoulder(self.open_side, self.contact_angle)
        inner, outer = self.ring_speeds
        axial, order, sine = RIGID.columns
        return BearingKernel(
            Z=self.Z,
            axial=axial,
            order=order,
            sine=sine,
            x0=-x0 if side < 0 else x0,
            y0=y0,
            A=A,
            e0=e0,
            kappa=self.kappa,
            h0=self.film,
            damping_law=law,
            damping_c=c,
            damping_table=table,
            cage_ratio=self.cage_ratio,
            angle0=self.angle0,
            inner_ratio=inner,
            outer_ratio=outer,
            shoulder=side,
            open_sine=open_sine(geometry.alpha0),
            imperfections=self._imperfections(),
        )

    def _imperfections(self) -> Imperfections:
        """Waves, pits and sizes, with the spin and the radii of the races where the balls run."""
        reach = self.Dw * math.cos(self.contact_angle or 0.0)
        waves = [row for wave in self.waviness for row in wave.rows(self.Z)]
        pits = [pit.row(self.Z) for pit in self.defects]
        return Imperfections(
            spin_ratio=self.spin_ratio,
            ball_diameter=self.Dw,
            inner_radius=(self.Dpw - reach) / 2,
            outer_radius=(self.Dpw + reach) / 2,
            waves=np.array(waves).reshape(-1, 5),
            pits=np.array(pits).reshape(-1, 5),
            oversize=np.array(self.oversize),
        )


def _measures(boundary: object, Dpw: float, Dw: float) -> tuple[float, float, float]:
    """(bore, outside, width) as numbers; ValueError unless the balls fit between bore and outside."""
    meaning = "(bore, outside, width) in m"
    bore, outside, width = (float(v) for v in vector("boundary", boundary, (3,), meaning))  # type: ignore[arg-type]
    positive("boundary width", width, "it must be a positive width in m")
    fits = 0 < bore < Dpw - Dw and outside > Dpw + Dw
    races = f"the races, Ø{Dpw - Dw:.6g} and Ø{Dpw + Dw:.6g} m, between bore and outside"
    remedy = f"it must be {meaning}, {races}"
    require(fits, "boundary", boundary, remedy)
    return bore, outside, width
