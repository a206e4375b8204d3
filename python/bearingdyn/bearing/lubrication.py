"""Film and damping of a bearing from its operating point: oil, temperature, speed and load."""

from __future__ import annotations

import dataclasses
import math
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from bearingdyn.bearing import ehl
from bearingdyn.bearing.ball_bearing import BallBearing
from bearingdyn.bearing.contact_damping import FILM_NODES, FilmDamping
from bearingdyn.bearing.contact_pressure import check_light
from bearingdyn.bearing.film_answer import FilmAnswer, in_series
from bearingdyn.bearing.film_thickness import YIELDING, hamrock_dowson, nijenbanning_venner_moes
from bearingdyn.bearing.hertz import PointContact
from bearingdyn.bearing.load_distribution import load_distribution
from bearingdyn.bearing.lubricant import Lubricant
from bearingdyn.bearing.oil_supply import OilSupply
from bearingdyn.checks import instance, nonnegative, number, one_of, positive, require, vector
from bearingdyn.plausible_ranges import check_speed_value, plausible

FilmLaw = Literal["ehl", "nijenbanning-venner-moes", "hamrock-dowson"]
Method = Literal["table", "solve"]
_RACES = ("inner", "outer")
# load at w = ½ of FilmDamping over that at which a ball turns from a rigid one to a Hertz contact
_WIDE = 10.0
_ALPHA_STEP = 1.1  # of α, for its exponents: wider than the table's kinks
_RIGID = 3  # c of rigid bodies on a film is as Q³: film as Q^−2, damping as film^−3/2


@dataclass(frozen=True, repr=False)
class Lubrication:
    """The lubrication of a bearing at one operating point: its films, λ ratios and damping; lengths in m."""

    Q: float
    """Contact load at which the films are taken: the mean of the loaded balls, N."""
    us: float
    """Sum of the surface speeds in each contact, m/s."""
    viscosity: float
    """Dynamic viscosity at ambient pressure, Pa s."""
    alpha: float
    """Pressure–viscosity coefficient that films and damping are taken with, 1/Pa."""
    alpha_by_rule: bool
    """Whether that is Wooster's of mineral oils, since the oil has none."""
    film_inner: float
    """Central film of the inner contact."""
    film_outer: float
    """Central film of the outer contact."""
    h0_inner: float
    """Film h0 of the inner contact's law Q = κ(δ + h0)^{3/2}; the central film where a formula gives it."""
    h0_outer: float
    """The same of the outer contact."""
    lambda_inner: float
    """Central film over composite roughness, inner contact; inf without roughness. Below 1 surfaces touch."""
    lambda_outer: float
    """The same of the outer contact."""
    damping_inner: float
    """Damping of the inner contact at low frequency under Q, N s/m; NaN outside of the table."""
    damping_outer: float
    """The same of the outer contact."""
    damping: float
    """Damping of one ball, both contacts in series, N s/m."""
    alpha_film: float
    """Exponent of the oil's α in the inner film, d ln h/d ln α; NaN outside of the table."""
    alpha_damping: float
    """The same in `damping`: where α is not known, c is not by so much."""
    law: FilmDamping | None
    """That damping over the load; None outside of the table."""

    def __repr__(self) -> str:
        """One line: films, damping, α and where it comes from, and how both hang on it."""
        known = f"; α {self.alpha:.3g} 1/Pa" + (" by Wooster's rule, not known" if self.alpha_by_rule else "")
        if math.isfinite(self.alpha_damping):
            film, c = self.alpha_film, self.alpha_damping
            known += f": the film goes as α^{film:.2f}, c as α^{c:.2f}"
        return (
            f"<Lubrication under {self.Q:.4g} N: films {1e6 * self.film_inner:.3f} and "
            f"{1e6 * self.film_outer:.3f} µm, c {self.damping:.1f} N s/m of a ball{known}>"
        )

    @property
    def film(self) -> float:
        """Both films of a ball together, h0_i + h0_o: the `film` of BallBearing (both act on one spring)."""
        return self.h0_inner + self.h0_outer

    def applied(self, bearing: BallBearing, *, damping: bool = True) -> BallBearing:
        """The bearing with this film and this damping over the load; its own damping for `damping=False`."""
        wet = dataclasses.replace(bearing, film=self.film, lubrication=None)
        if not damping:
            return wet
        if self.law is None:
            raise ValueError(
                f"damping is {damping!r}; the table of contacts ends before this point: pass damping=False"
            )
        return dataclasses.replace(wet, damping=self.law)


def lubricate(
    bearing: BallBearing,
    lubricant: Lubricant,
    temperature: float,
    speed: float,
    load: ArrayLike,
    *,
    law: FilmLaw = "ehl",
    method: Method = "table",
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
        "ehl": the equations of the lubricated contact; or a formula of the film, divided by the oil's
        relative density at the Hertz pressure, because formulas are fits of an oil that does not yield.
        That of Nijenbanning, Venner and Moes, by 1.009 besides, is then within 5 % of the equations, from
        three times the load on at which a contact turns from rigid bodies to a Hertz contact; about that load
        up to 42 % off.
    method
        Where the figures of "ehl" come from: the "table", or "solve" the equations for both contacts, which
        takes some seconds and knows no limits of a table. The damping over other loads is the table's, at the
        nearest L and D that it holds, in proportion.
    starvation
        Film over fully flooded film, in 0..1. Grease soon runs starved, at about half the flooded film: a
        rule of thumb, unverified; the factor is approximate by nature. Damping is that of the flooded film.
    roughness
        Rms roughness of race and ball, m.

    Raises
    ------
    ValueError
        Naming the field: a value out of range, a temperature outside the oil's viscosity law, no loaded ball,
        a contact outside of the table.
    ArithmeticError
        If the bearing finds no equilibrium.
    """
    require(isinstance(bearing, BallBearing), "bearing", bearing, "give a BallBearing")
    supply = OilSupply(lubricant, temperature, speed, starvation)
    one_of("law", law, ("ehl", "nijenbanning-venner-moes", "hamrock-dowson"))
    one_of("method", method, ("table", "solve"))
    sigma = 0.0
    if roughness is not None:
        given = vector("roughness", roughness, (2,), "rms roughness of race and ball, in m")
        race, ball = (plausible("roughness", "roughness", positive("roughness", r)) for r in given.tolist())
        sigma = math.hypot(race, ball)
    _check_rolling(bearing, supply)
    dry = dataclasses.replace(bearing, film=0.0, lubrication=None)
    state = load_distribution(dry, dry.displacement(load))
    require(state.loaded > 0, "load", load, "no ball is loaded: there is no contact to lubricate")
    check_light(bearing, state.load_inner)
    Q = float(state.load_inner.sum() / state.loaded)
    angle = float(state.angle_inner[int(state.load_inner.argmax())])
    return lubricated(bearing, supply, Q, angle, law=law, method=method, roughness=sigma)


def lubricated(
    bearing: BallBearing,
    supply: OilSupply,
    Q: float,
    angle: float,
    *,
    law: FilmLaw = "ehl",
    method: Method = "table",
    roughness: float = 0.0,
) -> Lubrication:
    """The lubrication of a bearing whose loaded balls carry Q on average.

    Parameters
    ----------
    bearing
        Its film and damping are not used.
    supply
        Oil, temperature, speed of the shaft and starvation.
    Q
        Mean load of the loaded balls, N.
    angle
        Contact angle, rad.
    law, method
        As in `lubricate`.
    roughness
        Composite rms roughness of race and ball, m.

    Raises
    ------
    ValueError
        As `lubricate`.
    """
    instance("bearing", bearing, BallBearing, "give a BallBearing")
    instance("supply", supply, OilSupply, "give an OilSupply(lubricant, temperature, speed)")
    one_of("law", law, ("ehl", "nijenbanning-venner-moes", "hamrock-dowson"))
    one_of("method", method, ("table", "solve"))
    _check_rolling(bearing, supply)
    Q, angle = positive("Q", Q, "it must be a positive load of a ball, N"), number("angle", angle)
    plausible("force", "Q", Q)
    roughness = nonnegative("roughness", roughness)
    turns = bearing.ring_speeds
    gamma = bearing.Dw / bearing.Dpw * math.cos(angle)
    us = bearing.Dpw / 2 * abs(supply.speed * (turns[0] - turns[1])) * (1 - gamma**2)
    oil, T = supply.lubricant, supply.temperature
    eta0, alpha = oil.viscosity(T), oil.pressure_coefficient(T)
    contacts = (bearing.inner_contact, bearing.outer_contact)
    found: list[ehl.LubricatedContact | None] = []
    for race, contact in zip(_RACES, contacts, strict=True):
        if method == "solve" and law == "ehl":
            found.append(ehl.solve(contact, oil, Q, us, T))
            continue
        try:
            found.append(ehl.look_up(contact, oil, Q, us, T))
        except ValueError as outside:
            if law == "ehl":
                raise ValueError(
                    f"{race} race under {Q:.4g} N: {outside}, here method='solve', or a formula by law=…"
                    f"{_speeds_held(contact, supply, Q, us)}"
                ) from None
            found.append(None)
    if law == "ehl":
        centre = [c.hc for c in found if c is not None]
        h0 = [c.h0 for c in found if c is not None]
    else:
        h0 = centre = [film_by_formula(contact, Q, us, eta0, alpha, law) for contact in contacts]
    inner, outer = found
    single = [math.nan if c is None else c.c0 for c in found]
    together = math.nan if inner is None or outer is None else in_series(inner, outer)
    share = supply.starvation
    return Lubrication(
        Q=Q,
        us=us,
        viscosity=eta0,
        alpha=alpha,
        alpha_by_rule=oil.alpha is None,
        film_inner=share * centre[0],
        film_outer=share * centre[1],
        h0_inner=share * h0[0],
        h0_outer=share * h0[1],
        lambda_inner=share * centre[0] / roughness if roughness else math.inf,
        lambda_outer=share * centre[1] / roughness if roughness else math.inf,
        damping_inner=single[0],
        damping_outer=single[1],
        damping=together,
        law=_over_load(bearing, oil, us, T, Q, together),
        **_over_alpha(contacts, oil, Q, us, T),
    )


def film_by_formula(
    contact: PointContact,
    F: float,
    us: float,
    eta0: float,
    alpha: float,
    law: Literal["nijenbanning-venner-moes", "hamrock-dowson"] = "nijenbanning-venner-moes",
) -> float:
    """Central film of an oil that yields, m: a formula over ρ̄ at the Hertz pressure.

    That of Nijenbanning, Venner and Moes over 1.009 ρ̄ is within 5 % of `ehl.steady` from M = 10.5 D^−0.59
    on; the 1.009 is fitted to its solutions.

    Parameters
    ----------
    contact, F, us, eta0, alpha
        As in `nijenbanning_venner_moes`.
    law
        Whose formula.

    Raises
    ------
    ValueError
        If a value is not positive, or Rx > Ry.
    """
    instance("contact", contact, PointContact, "give a bearing's inner_contact or outer_contact")
    one_of("law", law, ("nijenbanning-venner-moes", "hamrock-dowson"))
    F = positive("F", F, "it must be positive, in N")
    if law == "hamrock-dowson":
        speed = positive("us", us, "it must be positive, in m/s (u1 + u2)")
        film = hamrock_dowson(contact, F, speed / 2, eta0, alpha).central
    else:
        film = nijenbanning_venner_moes(contact, F, us, eta0, alpha) / YIELDING
    return film / float(ehl.relative_density(contact.pressure(F)))


def _over_alpha(
    contacts: tuple[PointContact, PointContact], oil: Lubricant, Q: float, us: float, T: float
) -> dict[str, float]:
    """Exponents of α in the inner film and in the damping of a ball, by the table; none outside of it."""
    found = []
    for factor in (1 / _ALPHA_STEP, _ALPHA_STEP):
        other = dataclasses.replace(oil, alpha=factor * oil.pressure_coefficient(T))
        try:
            inner, outer = (ehl.look_up(contact, other, Q, us, T) for contact in contacts)
        except ValueError:
            return {"alpha_film": math.nan, "alpha_damping": math.nan}
        found.append(np.log([inner.hc, in_series(inner, outer)]))
    slopes = (found[1] - found[0]) / (2 * math.log(_ALPHA_STEP))
    return {"alpha_film": float(slopes[0]), "alpha_damping": float(slopes[1])}


def _over_load(
    bearing: BallBearing, oil: Lubricant, us: float, T: float, Q: float, c: float
) -> FilmDamping | None:
    """Damping of a ball over its load: the table's, in proportion so that it is c under Q; else None."""
    answer = FilmAnswer(bearing.inner_contact, bearing.outer_contact, oil, T, us)
    low, high = answer.loads()
    if math.isnan(c) or not low < high:
        return None

    def damping(F: float) -> float:
        return answer.damping(min(max(F, low), high)) * min(F / low, 1.0) ** _RIGID

    scale = (_WIDE * answer.turning_load() / bearing.kappa) ** (2 / 3)
    w = np.linspace(0, 1, FILM_NODES)
    loads = bearing.kappa * (scale * (w[1:-1] / (1 - w[1:-1])) ** 2) ** 1.5
    values = [0.0, *(damping(float(F)) for F in loads)]
    values.append(values[-1])
    return FilmDamping(scale, np.array(values) * (c / damping(Q)), answer, Q)


def _speeds_held(contact: PointContact, supply: OilSupply, Q: float, us: float) -> str:
    """What to say of the speeds at which the table holds a contact under Q; nothing where there is none."""
    oil, T = supply.lubricant, supply.temperature
    M, L, D = ehl.scales(contact, Q, us, oil.viscosity(T), oil.pressure_coefficient(T))
    if D != ehl.nearest_in_table(L, D)[1]:
        return ""
    (M_low, M_high), (L_low, L_high) = ehl.table_ends(D)
    # M falls with speed^¾, L rises with speed^¼
    slow = abs(supply.speed) * max((M / M_high) ** (4 / 3), (L_low / L) ** 4)
    fast = abs(supply.speed) * min((M / M_low) ** (4 / 3), (L_high / L) ** 4)
    return f"; under this load it holds {slow:.3g} to {fast:.3g} rad/s" if slow < fast else ""


def _check_rolling(bearing: BallBearing, supply: OilSupply) -> None:
    check_speed_value("speed", supply.speed, bearing.Dpw)
    turns = bearing.ring_speeds
    rolling = turns[0] != turns[1]
    require(rolling, "bearing.turning", bearing.turning, "both rings turn alike: without rolling no film")
