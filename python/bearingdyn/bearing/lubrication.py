"""Film and damping of a bearing from its operating point: oil, temperature, speed and load."""

from __future__ import annotations

import dataclasses
import math
from dataclasses import dataclass
from typing import Literal

from numpy.typing import ArrayLike

from bearingdyn.bearing.ball_bearing import BallBearing
from bearingdyn.bearing.contact_damping import ConstantDamping, resultant_damping, wijnant_damping
from bearingdyn.bearing.film_thickness import hamrock_dowson, nijenbanning_venner_moes
from bearingdyn.bearing.load_distribution import load_distribution
from bearingdyn.bearing.lubricant import Lubricant
from bearingdyn.checks import positive, require, vector
from bearingdyn.magnitude import check_speed_value, plausible

FilmLaw = Literal["nijenbanning-venner-moes", "hamrock-dowson"]


@dataclass(frozen=True)
class Lubrication:
    """The lubrication of a bearing at one operating point: its films, λ ratios and damping; lengths in m."""

    Q: float
    """Contact load at which the films are taken: the mean of the loaded balls, N."""
    us: float
    """Sum of the surface speeds in each contact, m/s."""
    viscosity: float
    """Dynamic viscosity at ambient pressure, Pa s."""
    film_inner: float
    """Central film of the inner contact."""
    film_outer: float
    """Central film of the outer contact."""
    lambda_inner: float
    """Central film over composite roughness, inner contact; inf without roughness. Below 1 surfaces touch."""
    lambda_outer: float
    """The same of the outer contact."""
    damping: float
    """Damping of one ball, both contacts in series, by `wijnant_damping`, N s/m. UNVERIFIED."""

    @property
    def film(self) -> float:
        """Both films of a ball together, h_i + h_o: the `film` of BallBearing (both act on one spring)."""
        return self.film_inner + self.film_outer

    def applied(self, bearing: BallBearing, *, damping: bool = False) -> BallBearing:
        """The bearing with this film, and with this damping too if asked for (it is unverified)."""
        if damping:
            return dataclasses.replace(bearing, film=self.film, damping=ConstantDamping(self.damping))
        return dataclasses.replace(bearing, film=self.film)


def lubricate(
    bearing: BallBearing,
    lubricant: Lubricant,
    temperature: float,
    speed: float,
    load: ArrayLike,
    *,
    law: FilmLaw = "nijenbanning-venner-moes",
    starvation: float = 1.0,
    roughness: tuple[float, float] | None = None,
) -> Lubrication:
    """The lubrication of a bearing at an operating point: films of both contacts, λ ratios, damping.

    Taken at the mean load of the loaded balls of the dry bearing (h ∝ Q^−.07), in pure rolling at the contact
    angle of the most loaded ball; thermal thinning at the inlet is left out.

    Parameters
    ----------
    bearing
        Its film and damping are not used.
    lubricant, temperature
        Oil, or base oil of a grease, and its temperature at the inlet of the contacts, °C.
    speed
        Of the shaft, rad/s, not zero; the rings turn as the bearing's `turning` says.
    load
        (6,) on the inner ring, N and N m.
    law
        Film formula.
    starvation
        Film over fully flooded film, in 0..1. Grease soon runs starved, at about half the flooded film: a
        rule of thumb, unverified; the factor is approximate by nature.
    roughness
        Rms roughness of race and ball, m.

    Raises
    ------
    ValueError
        Naming the field: a value out of range, a temperature outside the oil's viscosity law, no loaded ball.
    ArithmeticError
        If the bearing finds no equilibrium.
    """
    require(isinstance(bearing, BallBearing), "bearing", bearing, "give a BallBearing")
    require(isinstance(lubricant, Lubricant), "lubricant", lubricant, "give a Lubricant")
    require(
        law in ("nijenbanning-venner-moes", "hamrock-dowson"),
        "law",
        law,
        'it must be "nijenbanning-venner-moes" or "hamrock-dowson"',
    )
    omega = plausible("speed", "speed", speed, "it must be a finite speed in rad/s")
    check_speed_value("speed", omega, bearing.Dpw)
    require(omega != 0, "speed", speed, "it must not be zero: without speed there is no film")
    turns = bearing.ring_speeds
    rolling = turns[0] != turns[1]
    require(rolling, "bearing.turning", bearing.turning, "both rings turn alike: without rolling no film")
    share = positive("starvation", starvation)
    require(share <= 1, "starvation", starvation, "it must be at most 1, fully flooded")
    sigma = 0.0
    if roughness is not None:
        given = vector("roughness", roughness, (2,), "rms roughness of race and ball, in m")
        race, ball = (plausible("roughness", "roughness", positive("roughness", r)) for r in given.tolist())
        sigma = math.hypot(race, ball)
    eta0, alpha = lubricant.viscosity(temperature), lubricant.alpha
    dry = dataclasses.replace(bearing, film=0.0)
    state = load_distribution(dry, dry.displacement(load))
    require(state.loaded > 0, "load", load, "no ball is loaded: there is no contact to lubricate")
    Q = float(state.load_inner.sum() / state.loaded)
    gamma = bearing.Dw / bearing.Dpw * math.cos(float(state.angle_inner[int(state.load_inner.argmax())]))
    us = bearing.Dpw / 2 * abs(omega * (turns[0] - turns[1])) * (1 - gamma**2)
    contacts = (bearing.inner_contact, bearing.outer_contact)
    if law == "hamrock-dowson":
        flooded = [hamrock_dowson(c, Q, us / 2, eta0, alpha).central for c in contacts]
    else:
        flooded = [nijenbanning_venner_moes(c, Q, us, eta0, alpha) for c in contacts]
    inner, outer = (share * h for h in flooded)
    kappas = [c.kappa for c in contacts]
    c_i, c_o = (wijnant_damping(c, Q, us, eta0, alpha) for c in contacts)
    return Lubrication(
        Q=Q,
        us=us,
        viscosity=eta0,
        film_inner=inner,
        film_outer=outer,
        lambda_inner=inner / sigma if sigma else math.inf,
        lambda_outer=outer / sigma if sigma else math.inf,
        damping=resultant_damping((kappas[0], c_i), (kappas[1], c_o)),
    )
