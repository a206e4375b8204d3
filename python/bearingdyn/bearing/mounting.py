"""What press fits and temperatures leave of a bearing's clearance.

Rings, shaft and housing as thick cylinders in plane stress (Lamé), the rings smooth at the bottom of their
grooves: T. A. Harris, Rolling Bearing Analysis, chapter on interference fits and clearance.
"""

from __future__ import annotations

import dataclasses
import math
from dataclasses import dataclass

from bearingdyn.bearing.ball_bearing import BallBearing
from bearingdyn.bearing.geometry import CLAMPED
from bearingdyn.checks import nonnegative, positive, require
from bearingdyn.material import STEEL, Elastic
from bearingdyn.notice import ClampedBalls, warn
from bearingdyn.pictures import page
from bearingdyn.plausible_ranges import plausible

_STEEL_EXPANSION = 11.5e-6
"""Thermal expansion of bearing steel, 1/K; handbooks give 11 to 12.5e-6."""


@dataclass(frozen=True)
class Seat:
    """A seat of a mounting: the shaft under the inner ring, or the housing around the outer one.

    Parameters
    ----------
    interference
        Diametral, before mounting, m; zero or positive.
    other
        Diameter of the seat's other surface, m: bore of a hollow shaft (0: solid), outside of a housing (inf:
        very thick).
    material
        Elastic material of shaft or housing.
    expansion
        Its thermal expansion, 1/K.
    warming
        Its temperature over that of assembly, K.

    Raises
    ------
    ValueError
        Naming the field, its value and what would be right.
    """

    interference: float = 0.0
    other: float | None = None
    material: Elastic = STEEL
    expansion: float = _STEEL_EXPANSION
    warming: float = 0.0

    def __post_init__(self) -> None:
        squeeze = nonnegative(
            "interference", self.interference, "it must be zero or positive, in m (diametral)"
        )
        plausible("interference", "interference", squeeze)
        require(isinstance(self.material, Elastic), "material", self.material, "give a material.Elastic")
        growth = nonnegative(
            "expansion", self.expansion, "the thermal expansion in 1/K must be zero or positive"
        )
        plausible("expansion", "expansion", growth)
        plausible("warming", "warming", self.warming, "it must be a finite temperature difference in K")
        if self.other is not None and self.other != math.inf:  # of a housing without end
            other = nonnegative("other", self.other, "a diameter in m must be zero or positive")
            plausible("length", "other", other)


@dataclass(frozen=True)
class Mounting:
    """How a bearing is mounted: seats of both rings, and temperatures.

    Parameters
    ----------
    bore, outside
        Of the bearing, m.
    shaft, housing
        Seats; by default without interference.
    inner, outer, balls
        Temperatures of rings and balls over that of assembly, K.
    expansion, ball_expansion
        Thermal expansion of rings and of balls, 1/K (silicon nitride: about 3e-6).

    Raises
    ------
    ValueError
        Naming the field, its value and what would be right.
    """

    bore: float
    outside: float
    shaft: Seat = Seat()
    housing: Seat = Seat()
    inner: float = 0.0
    outer: float = 0.0
    balls: float = 0.0
    expansion: float = _STEEL_EXPANSION
    ball_expansion: float = _STEEL_EXPANSION

    _repr_html_ = page

    def __post_init__(self) -> None:
        positive("bore", self.bore, "it must be positive and finite, in m")
        for name in ("shaft", "housing"):
            require(isinstance(getattr(self, name), Seat), name, getattr(self, name), "give a Seat")
        require(
            positive("outside", self.outside) > self.bore, "outside", self.outside, "it must exceed the bore"
        )
        plausible("length", "outside", self.outside)
        plausible("length", "bore", self.bore)
        for name in ("inner", "outer", "balls"):
            plausible("warming", name, getattr(self, name), "it must be a finite temperature difference in K")
        for name in ("expansion", "ball_expansion"):
            plausible("expansion", name, nonnegative(name, getattr(self, name)))
        hollow = 0.0 if self.shaft.other is None else self.shaft.other
        require(
            hollow < self.bore, "shaft.other", hollow, f"it must be less than the bore of {self.bore!r} m"
        )
        around = math.inf if self.housing.other is None else self.housing.other
        wide = f"it must exceed the bearing's outside diameter of {self.outside!r} m"
        require(around > self.outside, "housing.other", around, wide)

    def clearance_change(self, bearing: BallBearing) -> float:
        """Change of the diametral clearance, m; negative where fits and temperatures take from it.

        Raises
        ------
        ValueError
            If the races do not lie between bore and outside diameter.
        """
        require(isinstance(bearing, BallBearing), "bearing", bearing, "give a BallBearing")
        race_i, race_o = bearing.Dpw - bearing.Dw, bearing.Dpw + bearing.Dw
        inside = self.bore < race_i and race_o < self.outside
        remedy = f"the races, {race_i:.6g} and {race_o:.6g} m, must lie between it and the other diameter"
        require(inside, "bore, outside", (self.bore, self.outside), remedy)
        shaft, housing, ring = self.shaft, self.housing, bearing.material
        warm_i, warm_o = self.expansion * self.inner, self.expansion * self.outer
        fit_i = shaft.interference + self.bore * (shaft.expansion * shaft.warming - warm_i)
        fit_o = housing.interference + self.outside * (warm_o - housing.expansion * housing.warming)
        grown = _race_strain(self.bore, race_i, shaft.other or 0.0, ring, shaft.material) * max(fit_i, 0.0)
        far = math.inf if housing.other is None else housing.other
        shrunk = _race_strain(self.outside, race_o, far, ring, housing.material) * max(fit_o, 0.0)
        thermal = warm_o * race_o - warm_i * race_i - 2 * self.ball_expansion * self.balls * bearing.Dw
        return thermal - grown - shrunk

    def _check_boundary(self, bearing: BallBearing) -> None:
        """Raise ValueError for fits of another bearing, by its boundary dimensions where they are known."""
        known = bearing.boundary or (self.bore, self.outside)
        for name, own, its in zip(("bore", "outside"), (self.bore, self.outside), known, strict=False):
            remedy = f"the bearing's is {its:.6g} m: give the bearing's own bore and outside"
            require(math.isclose(own, its, rel_tol=0.01), name, own, remedy)

    def mounted(self, bearing: BallBearing) -> BallBearing:
        """The bearing with the clearance, or the free contact angle, that is left.

        Raises
        ------
        ValueError
            If the clearance left is so negative that the balls yield, or no contact angle is left.

        Warns
        -----
        ClampedBalls
            Where the clearance left is negative.
        """
        require(isinstance(bearing, BallBearing), "bearing", bearing, "give a BallBearing")
        self._check_boundary(bearing)
        left = bearing.geometry.Pd + self.clearance_change(bearing)
        why = "fits and temperatures leave less than none; choose looser fits or a larger clearance"
        if bearing.clearance is not None:
            require(left >= -CLAMPED * bearing.Dw, "clearance", left, f"{why}: the balls yield")
            mounted = dataclasses.replace(bearing, clearance=left)
            if left < 0:
                load = float(mounted.ball_loads([0.0] * 6).max())
                warn(
                    f"fits and temperatures take {1e6 * (bearing.clearance - left):.3g} µm of a clearance of "
                    f"{1e6 * bearing.clearance:.3g} µm: the rings clamp each ball with {load:.3g} N "
                    f"({mounted.pressure(load) / 1e9:.2f} GPa) before any load; choose looser fits or a "
                    f"larger clearance, unless that is meant",
                    ClampedBalls,
                )
            return mounted
        require(left >= 0, "clearance", left, why)
        A = bearing.geometry.A
        require(left < 2 * A, "clearance", left, f"it must stay below 2A = {2 * A:.6g} m")
        return dataclasses.replace(bearing, contact_angle=2 * math.asin(math.sqrt(left / (4 * A))))


def _race_strain(seat: float, race: float, other: float, ring: Elastic, mate: Elastic) -> float:
    """Change of the race's diameter over the interference at the seat, by Lamé; both ≥ 0.

    The ring lies between seat and race, its mate between seat and `other` (0 or inf: full).
    """
    ring_ratio = (race / seat) ** 2 if race > seat else (seat / race) ** 2
    mate_ratio = (
        0.0 if other in (0.0, math.inf) else (other / seat) ** 2 if other < seat else (seat / other) ** 2
    )
    outwards = 1.0 if race > seat else -1.0  # the ring is pressed from inside
    # hoop and radial strain at the seat under unit pressure, ring and mate
    of_ring = ((ring_ratio + 1) / (ring_ratio - 1) + outwards * ring.nu) / ring.E
    of_mate = ((1 + mate_ratio) / (1 - mate_ratio) - outwards * mate.nu) / mate.E
    pressure = 1 / (seat * (of_ring + of_mate))
    if race > seat:
        return 2 * pressure * race / (ring.E * (ring_ratio - 1))
    return 2 * pressure * race * ring_ratio / (ring.E * (ring_ratio - 1))
