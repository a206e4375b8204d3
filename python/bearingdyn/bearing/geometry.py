"""Internal geometry of a ball bearing and its kinematics.

The groove centres of inner and outer race stand A apart, at the free contact angle α0, when ball and races
just touch. Formulas: T. A. Harris, Rolling Bearing Analysis (contact angle, end play, ball-pass frequencies).
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

from bearingdyn.bearing.characteristic_frequencies import Frequencies
from bearingdyn.checks import nonnegative, number, positive, require
from bearingdyn.plausible_ranges import MAGNITUDES, plausible

CLAMPED = 0.02
"""Of Dw: rings that clamp their balls by so much press them with 4.6 to 4.9 GPa, above ISO 76's 4.2 GPa."""


@dataclass(frozen=True)
class Geometry:
    """Internal geometry: balls and grooves of a single-row ball bearing.

    Parameters
    ----------
    Z
        Number of balls, ≥ 3.
    Dw
        Ball diameter, m.
    Dpw
        Pitch diameter, m.
    fi, fo
        Groove radius over ball diameter, inner and outer race; both above ½ (closer to ½ is tighter).
    clearance
        Diametral clearance Pd, m, below 2A; the nominal contact angle is then 0 (deep groove). Negative: the
        rings clamp their balls, as fits and warmth leave them; centred, each ball is indented by −Pd/2.
    contact_angle
        Contact angle, rad, 0 ≤ α0 < π/2, nominal and free at once. Exactly one of the two is given.

    Raises
    ------
    ValueError
        If a value is out of range (Dw above 0.5 m and Dpw above 10 m are in mm, a clearance above Dw/10 is in
        µm), the balls do not fit side by side, or not exactly one of clearance and
        contact_angle is given.
    """

    Z: int
    Dw: float
    Dpw: float
    fi: float
    fo: float
    clearance: float | None = None
    contact_angle: float | None = None

    def __post_init__(self) -> None:
        n = number("Z", self.Z, "it must be a whole number of balls, at least 3")
        require(n >= 3 and n == int(n), "Z", self.Z, "it must be a whole number of balls, at least 3")
        for name in ("Dw", "Dpw"):
            size = positive(name, getattr(self, name), "it must be positive and finite, in m")
            object.__setattr__(self, name, size)
        plausible("ball diameter", "Dw", self.Dw)
        plausible("pitch diameter", "Dpw", self.Dpw)
        require(
            self.Dpw * math.sin(math.pi / n) >= self.Dw,
            "Dpw",
            self.Dpw,
            f"{int(n)} balls of diameter {self.Dw!r} m do not fit: "
            f"the pitch diameter must be at least {self.Dw / math.sin(math.pi / n):.6g} m",
        )
        for name, f in (("fi", self.fi), ("fo", self.fo)):
            remedy = (
                "it must exceed 0.5: give groove radius / ball diameter, above 0.5 (commonly 0.515 to 0.53)"
            )
            require(number(name, f, remedy) > 0.5, name, f, remedy)
            plausible("groove", name, f)
        require(
            (self.clearance is None) != (self.contact_angle is None),
            "clearance, contact_angle",
            (self.clearance, self.contact_angle),
            "give exactly one: clearance (diametral, m; deep groove) or contact_angle (rad; angular contact)",
        )
        if self.clearance is not None:
            Pd = number("clearance", self.clearance, "it must be finite, in m")
            row = MAGNITUDES["clearance"]
            meant = [
                f"; is it in {unit}? give {Pd * scale:.4g} m"
                for unit, scale in (("mm", 1e-3), ("µm", 1e-6))
                if row.within(Pd * scale / self.Dw, row.usual)
            ]
            hint = meant[0] if meant else ""
            least = (
                f"it must be at least -Dw/50, {-CLAMPED * self.Dw:.6g} m, for rings that clamp their balls "
                f"harder make them yield{hint}"
            )
            require(Pd >= -CLAMPED * self.Dw, "clearance", self.clearance, least)
            most = f"it must be at most Dw/10, {0.1 * self.Dw:.6g} m{hint}"
            require(Pd <= 0.1 * self.Dw, "clearance", self.clearance, most)
            plausible("clearance", "clearance", Pd / self.Dw)
            require(
                Pd < 2 * self.A,
                "clearance",
                self.clearance,
                f"it must be less than 2A = {2 * self.A:.6g} m, A the groove centres' distance",
            )
        else:
            remedy = "it must be in radians, 0 <= angle < pi/2"
            angle = nonnegative("contact_angle", self.contact_angle, remedy)
            require(
                angle < math.pi / 2,
                "contact_angle",
                self.contact_angle,
                f"{remedy}; is it in degrees? give {math.radians(angle):.4g}" if angle < 90 else remedy,
            )
            plausible("contact angle", "contact_angle", angle)

    @cached_property
    def A(self) -> float:
        """Distance of the groove centres when ball and races touch, (fi + fo − 1) Dw, m."""
        return ((self.fi - 0.5) + (self.fo - 0.5)) * self.Dw

    @property
    def osculation(self) -> tuple[float, float]:
        """Ball radius over groove radius, 1/(2f), inner and outer; 1 is full conformity."""
        return 0.5 / self.fi, 0.5 / self.fo

    @cached_property
    def alpha0(self) -> float:
        """Free contact angle, rad: the one given, or cosα0 = 1 − Pd/2A."""
        if self.clearance is None:
            return self.contact_angle or 0.0
        # acos(1 − Pd/2A) itself loses half the digits of a small clearance; clamped balls stand on the bottom
        return 2 * math.asin(math.sqrt(max(self.clearance, 0.0) / (4 * self.A)))

    @property
    def Pd(self) -> float:
        """Diametral clearance: the one given, or 2A(1 − cosα0), m."""
        return 4 * self.A * math.sin(self.alpha0 / 2) ** 2 if self.clearance is None else self.clearance

    @property
    def Pe(self) -> float:
        """Axial play from end to end, 2A sinα0, m."""
        return 2 * self.A * math.sin(self.alpha0)

    @property
    def gamma(self) -> float:
        """γ = Dw cosα / Dpw at the nominal contact angle α (0 for a bearing given by its clearance)."""
        return self.Dw * math.cos(self.contact_angle or 0.0) / self.Dpw

    @property
    def R_i(self) -> float:
        """Radius of the locus of inner groove centres, Dpw/2 + (fi − ½) Dw cosα0, m."""
        return self.Dpw / 2 + (self.fi - 0.5) * self.Dw * math.cos(self.alpha0)

    @property
    def R_o(self) -> float:
        """Radius of the locus of outer groove centres, R_i − A cosα0, m."""
        return self.R_i - self.A * math.cos(self.alpha0)

    @property
    def cage_ratio(self) -> float:
        """Cage speed over inner-ring speed with the outer ring at rest, ½(1 − γ)."""
        return 0.5 * (1 - self.gamma)

    def cage_speed(self, inner: float, outer: float = 0.0) -> float:
        """Cage speed ½[ω_i(1 − γ) + ω_o(1 + γ)], rad/s, from the ring speeds in rad/s."""
        return 0.5 * (inner * (1 - self.gamma) + outer * (1 + self.gamma))

    def ball_spin(self, inner: float, outer: float = 0.0) -> float:
        """Spin of a ball about its own axis, (Dpw/2Dw)|ω_i − ω_o|(1 − γ²), rad/s."""
        return self.Dpw / (2 * self.Dw) * abs(inner - outer) * (1 - self.gamma**2)

    def rolling_speed(self, inner: float, outer: float = 0.0) -> float:
        """Sum of the two surface speeds in a contact, u_s = (Dpw/2)|ω_i − ω_o|(1 − γ²), m/s."""
        return self.Dpw / 2 * abs(inner - outer) * (1 - self.gamma**2)

    def frequencies(self, inner: float, outer: float = 0.0) -> Frequencies:
        """Characteristic frequencies, Hz, from the ring speeds in rad/s, in pure rolling."""
        cage = self.cage_speed(inner, outer)
        turn = 2 * math.pi
        return Frequencies(
            FTF=abs(cage) / turn,
            BPFO=self.Z * abs(cage - outer) / turn,
            BPFI=self.Z * abs(inner - cage) / turn,
            BSF=self.ball_spin(inner, outer) / turn,
        )
