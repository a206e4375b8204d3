"""The bearing engineer's sheet: what it carries, how long, how warm, how stiff, its lines in a spectrum."""

from __future__ import annotations

import math
import warnings
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

import numpy as np

from bearingdyn.analysis.equilibrium import PARTED, Equilibrium, equilibrium
from bearingdyn.analysis.sheet_quantities import MEANING
from bearingdyn.application import Application
from bearingdyn.bearing import (
    STATIC_PRESSURE,
    BallBearing,
    BearingKernel,
    FrictionModel,
    Lubricant,
    Phase,
    Ratings,
    Supply,
    check_given,
    contamination_factor,
    equivalent_life,
    equivalent_load,
    equivalent_static_load,
    fault_lines,
    film_by_formula,
    friction,
    in_hours,
    modified_life,
    ratings_of,
    reliability_factor,
)
from bearingdyn.bearing import catalogue as listed
from bearingdyn.bearing import lives as lives_of
from bearingdyn.checks import instance, items, meant, named, nonnegative, one_speed, positive, require
from bearingdyn.notice import BearingWarning, warn
from bearingdyn.parts import RigidBody
from bearingdyn.plausible_ranges import plausible
from bearingdyn.types import Array
from bearingdyn.units import takes

if TYPE_CHECKING:
    import xarray


@takes(speed="rad/s", temperature="°C")
def bearing_sheet(
    eq: Equilibrium,
    *,
    speed: float | None = None,
    oil: Lubricant | None = None,
    temperature: float | Mapping[str, float] = 40.0,
    contamination: float | str = "normal cleanliness",
    reliability: float = 90.0,
    roughness: float = 0.0,
    C: Mapping[str, float] | None = None,
    C0: Mapping[str, float] | None = None,
    shoulder: Mapping[str, float] | None = None,
    friction_model: FrictionModel = "palmgren",
    supply: Supply = "oil bath",
    duty: Sequence[tuple[Equilibrium, float, float, float]] = (),
    rpm: float | None = None,
) -> xarray.Dataset:
    """The bearing sheet: what is asked of the bearings of an equilibrium, all of them at once.

    Parameters
    ----------
    eq
        The static state; balls between flexible rings count as well.
    speed
        Of the shaft, rad/s; 0, the default: what needs a speed is NaN.
    oil
        Of all bearings; None: what needs an oil is NaN.
    temperature
        Of the oil, °C, of all bearings or by bearing.
    contamination, reliability
        Of `modified_life`.
    roughness
        Composite rms roughness of race and ball, m; 0: λ is NaN.
    C, C0
        Ratings by bearing, N, as a maker prints them; the others are by ISO 281 and ISO 76.
    shoulder
        Heights of the shoulders over the bottom of their grooves by bearing, m; the others are not checked.
    friction_model, supply
        Of `friction`.
    duty
        Phases (equilibrium, speed, temperature, share of the time) of a duty cycle, each of the same
        bearings; their life is by Palmgren and Miner, modified where there is an oil. Where one phase is
        doubted, the warning says which; NaN where its film is too thin for ISO 281.
    rpm
        The speed in revolutions a minute, instead of `speed`.

    Returns
    -------
    xarray.Dataset
        Over "bearing"; units in attrs. `sheet_text` and `sheet_html` print it.

    Raises
    ------
    ValueError
        Naming what is out of range, or what is unknown.

    Warns
    -----
    BearingWarning
        Where a bearing carries nothing, or more than its static rating, its film is too thin for ISO 281 (κ
        below .1), or a shoulder cuts an ellipse; also in the variable `warnings`.

    Examples
    --------
    >>> import bearingdyn as bd
    >>> from bearingdyn.demo import motor
    >>> sheet = bd.bearing_sheet(bd.equilibrium(motor(None)), speed=314.0)
    >>> [f"{name} {float(sheet['L10r'].sel(bearing=name)):.0f}" for name in sheet["bearing"].values]
    ['left 6661', 'right 6124']
    """
    instance("eq", eq, Equilibrium, "it must be an equilibrium: bd.equilibrium(app)")
    hung = _hung(eq)
    omega = plausible("speed", "speed", one_speed(speed, rpm, 0.0), "it must be a finite speed in rad/s")
    if oil is not None:
        instance("oil", oil, Lubricant, "give a bd.bearing.Lubricant")
    sigma = plausible("roughness", "roughness", nonnegative("roughness", roughness))
    # what cannot be meant is refused, even where no oil asks for it
    reliability_factor(reliability)
    contamination_factor(contamination, 0.0)
    own = {"C": C, "C0": C0, "shoulder": shoulder}
    given = {
        key: named(key, value or {}, "give values by the names of bearings") for key, value in own.items()
    }
    if isinstance(temperature, Mapping):
        given["temperature"] = named("temperature", temperature, "give °C by the names of bearings")
    for value in given.get("temperature", {"": temperature}).values():
        plausible("oil temperature", "temperature", value, "it must be one finite temperature in °C")
    for key, values in given.items():
        for name, value in values.items():
            require(name in hung, key, name, meant(name, hung))
            if key != "temperature":
                positive(f"{key} of bearing {name!r}", value)
            if key == "shoulder":
                Dw = hung[name].Dw
                remedy = f"a shoulder is lower than half a ball, {Dw / 2:.3g} m"
                require(value < Dw / 2, f"shoulder of bearing {name!r}", value, remedy)
    _check_ratings(hung, given["C"], given["C0"])
    phases = items("duty", duty, "it must be a list of (equilibrium, speed, temperature, share)")
    for k, phase in enumerate(phases):
        good = isinstance(phase, tuple) and len(phase) == 4 and isinstance(phase[0], Equilibrium)
        require(good, f"duty[{k}]", phase, "it must be (equilibrium, speed, temperature, share)")
        require(_hung(phase[0]).keys() == hung.keys(), f"duty[{k}]", phase[0], "its bearings are others")

    columns: dict[str, list[float]] = {name: [] for name in MEANING}
    told: list[str] = []
    sources: list[str] = []
    ratings: list[str] = []
    for name, bearing in hung.items():
        T = given["temperature"].get(name, 40.0) if isinstance(temperature, Mapping) else temperature
        with _rating_told_once():
            row, doubts = _row(
                eq, name, bearing, omega, oil, float(T), contamination, reliability, sigma,
                given["C"].get(name), given["C0"].get(name), given["shoulder"].get(name), friction_model,
                supply,
            )  # fmt: skip
        row["duty_life"] = math.nan
        if phases:
            lives = []
            for k, phase in enumerate(phases):
                with _rating_told_once():
                    life, doubted = _life_of_phase(
                        phase,
                        name,
                        oil,
                        contamination,
                        reliability,
                        given["C"].get(name),
                        given["C0"].get(name),
                    )
                lives.append(life)
                doubts += [f"duty[{k}]: {doubt}" for doubt in doubted]
            known = all(life is not None for life in lives)
            row["duty_life"] = equivalent_life([x for x in lives if x])[1] if known else math.nan
        for key, values_ in columns.items():
            values_.append(row.get(key, math.nan))
        for doubt in doubts:
            warn(f"bearing {name!r}: {doubt}", BearingWarning)
        told.append("; ".join(doubts))
        source, printed = _source(bearing)
        sources.append(source)
        ratings.append(_rated(bearing, {k: given[k].get(name) for k in ("C", "C0")}, printed))

    from bearingdyn.results import dataset, inputs_of

    variables: dict[str, Any] = {
        name: ("bearing", np.array(values), MEANING[name][0], MEANING[name][1])
        for name, values in columns.items()
    }
    variables["source"] = ("bearing", sources, "", "where the geometry comes from")
    variables["rating_source"] = ("bearing", ratings, "", "where C and C0 come from")
    variables["warnings"] = ("bearing", told, "", "what is doubted")
    return dataset(
        variables,
        {
            "analysis": "bearing sheet",
            "speed": omega,
            "contamination": str(contamination),
            "reliability": float(reliability),
            "friction_model": friction_model,
            **inputs_of(eq.system.inputs),
        },
        {"bearing": (list(hung), "")},
    )


def single_bearing(
    bearing: BallBearing, *, radial: float = 0.0, axial: float = 0.0, name: str = "bearing"
) -> Equilibrium:
    """Equilibrium for the sheet of one bearing: its outer ring stands, its inner ring is loaded and upright.

    Parameters
    ----------
    bearing
        Ball bearing.
    radial, axial
        N: along −y and +z.
    name
        Of the bearing.
    """
    instance("bearing", bearing, BallBearing, "give a BallBearing")
    Fr, Fa = nonnegative("radial", radial), plausible("force", "axial", axial)
    app = Application()
    app.add("ring", RigidBody(mass=0.1, inertia=(1e-4, 1e-4, 1e-4)))
    # the shaft holds the ring upright
    app.ground("ring.centre", stiffness=(0.0, 0.0, 0.0, 1e9, 1e9, 1e9))
    app.bearing(name, bearing, inner="ring.centre", outer="ground")
    app.load("ring.centre", (0.0, -Fr, Fa, 0.0, 0.0, 0.0))
    return equilibrium(app)


def _hung(eq: Equilibrium) -> dict[str, BallBearing]:
    found = {t.name: t.bearing for t in eq.system.bearings if isinstance(t.bearing, BallBearing)}
    require(bool(found), "eq", eq, "it has no ball bearing")
    return found


def _source(bearing: BallBearing) -> tuple[str, Ratings | None]:
    """What the geometry rests on, and ratings as its maker prints them, if it is one of the catalogue's."""
    for name, one in listed.CATALOGUE.items():
        same = (one.Z, one.Dw, one.Dpw, one.fi, one.fo, (one.bore, one.outside, one.width)) == (
            bearing.Z, bearing.Dw, bearing.Dpw, bearing.fi, bearing.fo, bearing.boundary,
        )  # fmt: skip
        if same and (one.contact_angle is None) == (bearing.contact_angle is None):
            return f"{name}: {one.support}", one.printed
    return "geometry as given", None


def _rated(bearing: BallBearing, given: Mapping[str, float | None], printed: Ratings | None) -> str:
    """Where the ratings on the sheet come from, and what the others are."""
    iso, told = ratings_of(bearing), []
    for key, value in given.items():
        by_iso, made = getattr(iso, key), getattr(printed, key, None)
        if value is None:
            other = f" (NSK prints {made:.0f} N)" if made else ""
            told.append(f"{key} computed by {'ISO 281' if key == 'C' else 'ISO 76'}{other}")
        else:
            who = "as NSK prints it" if made == value else "as given"
            told.append(f"{key} {who} (computed {by_iso:.0f} N)")
    return "; ".join(told)


def _angles(kernel: BearingKernel, z: Array, psi: Array) -> Array:
    """Contact angles (Z,), rad, of the balls at azimuths psi in a state z of the raceways."""
    phase = psi[:, None] * np.asarray(kernel.order)
    basis = np.where(np.asarray(kernel.sine) == 1, np.sin(phase), np.cos(phase))
    axial = np.asarray(kernel.axial) == 1
    X = kernel.x0 + basis[:, axial] @ z[axial]
    Y = kernel.y0 + basis[:, ~axial] @ z[~axial]
    return np.asarray(np.arctan2(X, Y))


def _check_ratings(hung: Mapping[str, BallBearing], C: Mapping[str, float], C0: Mapping[str, float]) -> None:
    """Warn (UnusualMagnitude) of ratings given that are far from what ISO gives to the bearing's balls."""
    for what, given in (("C", C), ("C0", C0)):
        for name, value in given.items():
            check_given(what, value, getattr(ratings_of(hung[name]), what), f" of bearing {name!r}")


def _row(
    eq: Equilibrium,
    name: str,
    bearing: BallBearing,
    omega: float,
    oil: Lubricant | None,
    T: float,
    contamination: float | str,
    reliability: float,
    sigma: float,
    C: float | None,
    C0: float | None,
    shoulder: float | None,
    model: FrictionModel,
    supply: Supply,
) -> tuple[dict[str, float], list[str]]:
    """The numbers of one bearing, and what is doubted of them."""
    term = next(t for t in eq.system.bearings if t.name == name)
    state, doubts = eq.bearings[name], list[str]()
    angle = bearing.contact_angle or 0.0
    iso = ratings_of(bearing)
    C, C0 = iso.C if C is None else C, iso.C0 if C0 is None else C0
    force, Q = state.force, state.loads
    Fr, Fa = float(np.hypot(force[0], force[1])), abs(float(force[2]))
    if not (Q > PARTED).any():
        doubts.append("it carries no load, so that life, pressures and stiffness say nothing of it")
    kernel = term.kernel()
    psi = bearing.angle0 + 2 * math.pi * np.arange(bearing.Z) / bearing.Z
    heaviest = int(np.argmax(Q))
    alpha = float(_angles(kernel, state.z, psi)[heaviest])
    contacts = {"inner": bearing.inner_contact, "outer": bearing.outer_contact}
    axes = {race: contact.semi_axes(float(Q[heaviest])) for race, contact in contacts.items()}
    P = equivalent_load(Fr, Fa, C0, contact_angle=angle, f0=iso.f0)
    P0 = equivalent_static_load(Fr, Fa, angle)
    x, y, along = (state.series.terms.index(t) if t in state.series.terms else None
                   for t in ((0, 1, 0), (0, 1, 1), (1, 0, 0)))  # fmt: skip
    row = {
        "balls": float(bearing.Z),
        "ball_diameter": bearing.Dw,
        "pitch_diameter": bearing.Dpw,
        "groove_inner": bearing.fi,
        "groove_outer": bearing.fo,
        "clearance": bearing.geometry.Pd,
        "free_angle": bearing.geometry.alpha0,
        "radial_load": Fr,
        "axial_load": Fa,
        "ball_load": float(Q[heaviest]),
        "loaded_balls": float(np.count_nonzero(Q > 0)),
        "contact_angle": alpha,
        "C": C,
        "C0": C0,
        "P": P,
        "P0": P0,
        "static_safety": C0 / P0 if P0 > 0 else math.inf,
        "L10": (C / P) ** 3 if P > 0 else math.inf,
        "L10r": float(lives_of(bearing, Q[None], Q[None], C)[0]),
    }
    for key, index in (("stiffness_x", x), ("stiffness_y", y), ("stiffness_z", along)):
        row[key] = math.nan if index is None else float(state.K[index, index])
    for race, contact in contacts.items():
        row[f"pressure_{race}"] = contact.pressure(float(Q[heaviest]))
        row[f"ellipse_{race}"] = 2 * axes[race][0]
    peak = max(row["pressure_inner"], row["pressure_outer"])
    row["pressure_safety"] = (STATIC_PRESSURE / peak) ** 3 if peak > 0 else math.inf
    doubts += _overloaded(P0, C0)
    if shoulder is not None:
        for race, f in (("inner", bearing.fi), ("outer", bearing.fo)):
            cut = _cut(f * bearing.Dw, 2 * f * bearing.Dw / (2 * f + 1), axes[race][0], abs(alpha), shoulder)
            row[f"cut_{race}"] = cut
            if cut > 0:
                doubts.append(f"the shoulder cuts {100 * cut:.3g} % of the ellipse on the {race} race")
    inner, outer = bearing.ring_speeds
    relative = omega * (inner - outer)
    if relative == 0:
        return row, doubts
    row["L10rh"] = in_hours(row["L10r"], relative)
    row |= fault_lines(bearing, omega, contact_angle=abs(alpha))
    if oil is None:
        return row, doubts
    nu = oil.kinematic.viscosity(T)
    row |= {"temperature": T, "viscosity": nu}
    found, doubt = _modified(row["L10r"], C, C0, bearing, relative, nu, contamination, reliability)
    row |= found
    if doubt:
        doubts.append(doubt)
    if Q[heaviest] > 0:
        gamma = bearing.Dw / bearing.Dpw * math.cos(alpha)
        us = bearing.Dpw / 2 * abs(relative) * (1 - gamma**2)
        row["alpha"] = oil.pressure_coefficient(T)
        for race, contact in contacts.items():
            film = film_by_formula(contact, float(Q[heaviest]), us, oil.viscosity(T), row["alpha"])
            row[f"film_{race}"] = film
            if sigma > 0:
                row[f"lambda_{race}"] = film / sigma
    if bearing.boundary is not None:
        rubbed = friction(
            model, radial=Fr, axial=Fa, speed=relative, viscosity=nu, bore=bearing.boundary[0],
            outside=bearing.boundary[1], C0=C0, contact_angle=angle,
            series=listed.series_of(bearing) or "62", supply=supply,
        )  # fmt: skip
        row |= {"friction_moment": rubbed.moment, "friction_power": rubbed.power}
    return row, doubts


def _modified(
    L10r: float,
    C: float,
    C0: float,
    bearing: BallBearing,
    relative: float,
    nu: float,
    contamination: float | str,
    reliability: float,
) -> tuple[dict[str, float], str]:
    """κ, a_ISO and modified life; and a doubt where κ is too low for the standard."""
    P = C / L10r ** (1 / 3) if math.isfinite(L10r) else 0.0
    try:
        found = modified_life(
            L10r, P, C0=C0, Dpw=bearing.Dpw, speed=relative, viscosity=nu, contamination=contamination,
            reliability=reliability,
        )  # fmt: skip
    except ValueError as error:
        if not str(error).startswith("kappa "):
            raise
        return {"L10mh": math.nan}, str(error)
    return {"kappa": found.kappa, "a_iso": found.factor, "L10mh": found.hours}, ""


def _life_of_phase(
    phase: tuple[Equilibrium, float, float, float],
    name: str,
    oil: Lubricant | None,
    contamination: float | str,
    reliability: float,
    C: float | None,
    C0: float | None,
) -> tuple[Phase | None, list[str]]:
    """One phase of a duty cycle as its life, None where that is not known; and what is doubted of it."""
    state, speed, T, share = phase
    bearing = _hung(state)[name]
    iso = ratings_of(bearing)
    C, C0 = iso.C if C is None else C, iso.C0 if C0 is None else C0
    inner, outer = bearing.ring_speeds
    relative = plausible("speed", "speed of a phase", speed) * (inner - outer)
    force = state.bearings[name].force
    P0 = equivalent_static_load(
        float(np.hypot(force[0], force[1])), abs(float(force[2])), bearing.contact_angle or 0.0
    )
    doubts = _overloaded(P0, C0)
    Q = state.bearings[name].loads[None]
    life = float(lives_of(bearing, Q, Q, C)[0])
    if oil is not None and relative != 0 and math.isfinite(life):
        nu = oil.kinematic.viscosity(T)
        found, doubt = _modified(life, C, C0, bearing, relative, nu, contamination, reliability)
        if doubt:
            return None, [*doubts, doubt]
        life *= found["a_iso"]
    return Phase(share, relative, life), doubts


@contextmanager
def _rating_told_once() -> Iterator[None]:
    """Keep loads, life and friction silent of a load above the static rating: the sheet tells of it."""
    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", "the static equivalent load is", BearingWarning)
        yield


def _overloaded(P0: float, C0: float) -> list[str]:
    """The doubt about a load above the static rating, or none."""
    return [f"loaded above its static rating: P0 is {P0:.0f} N, C0 {C0:.0f} N"] if P0 > C0 else []


def _cut(groove: float, surface: float, half: float, alpha: float, shoulder: float) -> float:
    """Share of the ellipse's length beyond the shoulder; 0 where all of it lies inside."""
    edge = math.acos(max(1 - shoulder / groove, 0.0))
    reach = math.asin(min(half / surface, 1.0))
    if reach <= 0:
        return 0.0
    return min(max((alpha + reach - edge) / (2 * reach), 0.0), 1.0)
