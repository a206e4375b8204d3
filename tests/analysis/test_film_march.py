"""Bearings on oil in time, contacts="film": the films' answer over frequency, resumed and audited."""

from __future__ import annotations

import math
import warnings
from pathlib import Path

import numpy as np
import pytest

import bearingdyn as bd
from bearingdyn.analysis import equilibrium, frequency_response, transient
from bearingdyn.analysis.equilibrium import Equilibrium
from bearingdyn.application import Application
from bearingdyn.bearing import BallBearing, FilmDamping, Lubricant, Walther
from bearingdyn.notice import CutHarmonics
from bearingdyn.parts import RigidBody

OIL, TEMPERATURE, OMEGA, LOAD = Lubricant(Walther.iso_vg(32)), 60.0, 523.6, 300.0
PLACES = ["mass.centre.z", "ball.force.z"]


def oiled(
    frequency: float = 0.0, radial: float = 0.0, oil: Lubricant = OIL, load: float = LOAD
) -> Equilibrium:
    """A mass on one oiled bearing, held by a damper besides, lest its start ring on."""
    supply = bd.OilSupply(oil, TEMPERATURE, OMEGA)
    ball = BallBearing(8, 5.953e-3, 25e-3, 0.52, 0.53, clearance=10e-6, lubrication=supply)
    app = Application()
    app.add("mass", RigidBody(0.05, (1e-5, 1e-5, 1e-5)))
    app.ground("mass.centre", stiffness=(1e3, 1e3, 0, 1e3, 1e3, 1e3), damping=(50, 50, 2000, 0, 0, 0))
    app.bearing("ball", ball, inner="mass.centre", outer="ground")
    app.load("mass.centre", (radial, 0, load, 0, 0, 0))
    if frequency:
        app.load("mass.centre", (0, 0, 0.5, 0, 0, 0), frequency=frequency)
    return equilibrium(app)


def passage(eq: Equilibrium) -> float:
    """a/um of the slower contact, s."""
    law = eq.system.bearings[0].bearing.damping
    assert isinstance(law, FilmDamping)
    assert law.answer is not None
    assert law.load is not None
    return max(law.answer.passages(law.load))


def stiffness(frequency: float, dt: float, contacts: str, method: str = "newmark") -> complex:
    """Force of the bearing over motion, from a march under a harmonic load."""
    per = round(1 / frequency / dt)
    settled = math.ceil(2e-3 / per / dt)
    run = transient(
        oiled(frequency),
        speed=OMEGA,
        dt=1 / frequency / per,
        steps=2 * per,
        settle=settled * per,
        record=PLACES,
        contacts=contacts,  # type: ignore[arg-type]
        method=method,
        filter=False,
    )
    angle = 2 * math.pi * frequency * run["time"].values
    shapes = np.column_stack([np.cos(angle), np.sin(angle), np.ones_like(angle)])
    cos, sin, _ = np.linalg.lstsq(shapes, run["record"].values, rcond=None)[0]
    z, force = cos - 1j * sin
    return complex(force / z)


@pytest.mark.parametrize("method", ["newmark", "exact"])
@pytest.mark.parametrize("Omega", [0.1, 0.5, 1.0, 2.0, 3.0])
def test_a_march_answers_as_the_films_do(Omega: float, method: str) -> None:
    eq = oiled()
    f = Omega / passage(eq) / (2 * math.pi)
    H = frequency_response(eq, [f], ["mass.centre.z"], PLACES)["response"].values[0, :, 0]
    wanted = H[1] / H[0]
    # 40 steps a period, or 6 µs: a mode of 8 kHz, which the step must see, is damped
    found = stiffness(f, min(6e-6, 1 / f / 40), "film", method)
    # the law is for the dry bearing's loads, 1.4 % off: .009/3 of that in K, a third of it in the passage
    assert abs(found / wanted - 1) < 1.5e-3  # and the fit's own, FilmMemory.error
    # c(ω), which falls to a sixth at Ω = 2
    assert found.imag == pytest.approx(wanted.imag, rel=0.04)
    if Omega >= 2:
        assert stiffness(f, 1 / f / 40, "viscous").imag > 3 * wanted.imag


def test_slow_motions_find_the_viscous_damping() -> None:
    eq = oiled()
    f = 0.02 / passage(eq) / (2 * math.pi)
    film, viscous = (stiffness(f, 1 / f / 400, contacts) for contacts in ("film", "viscous"))
    assert film.imag == pytest.approx(viscous.imag, rel=2e-3)  # bends as Ω²
    # films become thinner under load: K0 is below the stiffness of the dry contacts
    assert 0.985 < film.real / viscous.real < 0.995


def test_a_march_on_films_resumes_and_streams_bit_for_bit(tmp_path: Path) -> None:
    how = dict(speed=OMEGA, dt=5e-6, record=PLACES, contacts="film", filter=False)
    eq = oiled(2000.0, radial=100.0)
    whole = transient(eq, steps=700, **how)
    half = transient(eq, steps=300, **how)
    rest = transient(eq, steps=400, resume=half, **how)
    np.testing.assert_array_equal(whole["state"].values, rest["state"].values)
    np.testing.assert_array_equal(whole["record"].values[300:], rest["record"].values)
    streamed = transient(eq, steps=700, stream=tmp_path / "run", **how)
    np.testing.assert_array_equal(whole["record"].values, streamed["record"].values)
    with pytest.raises(ValueError, match="resume is the state of another application"):
        transient(eq, steps=10, resume=half, **(how | {"contacts": "viscous"}))


def test_marches_on_films_go_side_by_side_bit_for_bit() -> None:
    cases = [
        dict(source=oiled(2000.0, radial), speed=OMEGA, dt=5e-6, steps=400, record=PLACES, contacts="film")
        for radial in (0.0, 50.0, 100.0)
    ]
    for case, found in zip(cases, bd.transients(cases, threads=1), strict=True):
        alone = transient(**case)
        np.testing.assert_array_equal(found["record"].values, alone["record"].values)
        np.testing.assert_array_equal(found["state"].values, alone["state"].values)


def test_energies_balance_on_films() -> None:
    """What contacts take stands among the energies; films also hold some, and give it back."""
    run = transient(
        oiled(3000.0, radial=100.0),
        speed=OMEGA,
        dt=2e-6,
        steps=8000,
        record=PLACES,
        contacts="film",
        audit=True,
    )
    e = {name: run.attrs[f"energy_{name}"] for name in ("load", "turning", "linear", "branch", "contact")}
    held = {name: run.attrs[f"energy_{name}"] for name in ("kinetic", "elastic", "stored", "indentation")}
    start = transient(
        oiled(3000.0, radial=100.0), speed=OMEGA, dt=2e-6, steps=0, record=PLACES, contacts="film", audit=True
    )
    before = sum(start.attrs[f"energy_{name}"] for name in held)
    gained = e["load"] + e["turning"] - e["linear"] - e["branch"] - e["contact"]
    # trapezoidal sums of powers that vary over some 60 steps: (2π/60)²/12
    assert abs(gained - (sum(held.values()) - before)) < 2e-3 * run.attrs["energy_throughput"]
    assert e["contact"] > 0


def test_balls_in_and_out_of_the_load_zone_forget() -> None:
    """Radial load and clearance: balls lose contact at each turn, and nothing is thrown or lost there."""
    how = dict(speed=OMEGA, dt=5e-6, steps=6000, record=["ball.loaded", "ball.force.x", "ball.ball1"])
    eq = oiled(radial=400.0, load=20.0)
    film, viscous = (
        transient(eq, contacts=contacts, **how)["record"].values for contacts in ("film", "viscous")
    )
    assert film[:, 2].min() == 0
    assert film[:, 2].max() > 50
    # the same loads go round: films differ by the thinning under load, a part in a hundred
    np.testing.assert_allclose(film[3000:, 1].mean(), viscous[3000:, 1].mean(), rtol=2e-3)
    np.testing.assert_allclose(film[3000:, 2].max(), viscous[3000:, 2].max(), rtol=0.03)


@pytest.mark.parametrize("contacts", ["films", None, 1, ""])
def test_contacts_are_named(contacts: object) -> None:
    with pytest.raises((ValueError, TypeError), match="contacts"):
        transient(oiled(), speed=OMEGA, dt=5e-6, steps=1, record=PLACES, contacts=contacts)  # type: ignore[arg-type]


def test_a_dry_bearing_has_no_films() -> None:
    app = Application()
    app.add("mass", RigidBody(0.05, (1e-5, 1e-5, 1e-5)))
    app.ground("mass.centre", stiffness=(1e3, 1e3, 0, 1e3, 1e3, 1e3))
    ball = BallBearing(8, 5.953e-3, 25e-3, 0.52, 0.53, clearance=10e-6, damping=30.0)
    app.bearing("ball", ball, inner="mass.centre", outer="ground")
    app.load("mass.centre", (0, 0, LOAD, 0, 0, 0))
    for damping in (30.0, FilmDamping(1e-6, np.linspace(0, 30, 65))):
        app = Application()
        app.add("mass", RigidBody(0.05, (1e-5, 1e-5, 1e-5)))
        app.ground("mass.centre", stiffness=(1e3, 1e3, 0, 1e3, 1e3, 1e3))
        ball = BallBearing(8, 5.953e-3, 25e-3, 0.52, 0.53, clearance=10e-6, damping=damping)
        app.bearing("ball", ball, inner="mass.centre", outer="ground")
        app.load("mass.centre", (0, 0, LOAD, 0, 0, 0))
        with pytest.raises(ValueError, match="contacts is 'film', and no bearing runs on films"):
            transient(app, speed=OMEGA, dt=5e-6, steps=1, record=PLACES, contacts="film")


@pytest.mark.parametrize(("grade", "load"), [(150, 2.0), (150, 5.0), (220, 10.0)])
def test_a_film_that_follows_the_load_is_refused(grade: int, load: float) -> None:
    thick = Lubricant(Walther.iso_vg(grade), density=870.0, alpha=2e-8)
    eq = oiled(oil=thick, load=load)
    with pytest.raises(ValueError, match=r"bearing 'ball': contacts is 'film'; under .* N the films leave"):
        transient(eq, speed=OMEGA, dt=5e-6, steps=1, record=PLACES, contacts="film")


def test_other_motions_are_not_sought_on_films() -> None:
    with pytest.raises(ValueError, match="check_unique looks for steady motions on viscous contacts"):
        transient(oiled(), speed=OMEGA, dt=5e-6, steps=1, record=PLACES, contacts="film", check_unique=True)


@pytest.mark.parametrize(("radial", "speed"), [(0.0, OMEGA), (150.0, 0.0)])
def test_a_mass_that_rests_stays(radial: float, speed: float) -> None:
    """The law is for the mean load of the dry bearing's balls; under others films hold a mass elsewhere."""
    eq = oiled(radial=radial)
    run = transient(eq, speed=speed, dt=2e-6, steps=400, record=PLACES, contacts="film", filter=False)
    z, force = run["record"].values.T
    assert np.ptp(z) < 1e-14  # Newton's tolerance; from where viscous films hold it, it fell by 1.7 nm
    np.testing.assert_allclose(force, LOAD, rtol=1e-8)
    # 1.4 % more than the dry bearing's load, on .009/K_Hertz of film, over sin α; more with a radial load
    assert 1e-10 < abs(z[0] - eq.displacement("mass.centre")[2]) < 1e-7


@pytest.mark.parametrize("Omega", [0.3, 2.0])
@pytest.mark.parametrize("found_with", ["film", "viscous"])
def test_a_march_begins_in_a_steady_motion_and_so_do_its_films(Omega: float, found_with: str) -> None:
    frequency = Omega / passage(oiled()) / (2 * math.pi)
    eq = oiled(frequency)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", CutHarmonics)  # of the ball passage, which moves nothing here
        motion = bd.steady_state(eq, speed=OMEGA, record=PLACES[:1], contacts=found_with)
    assert motion.attrs.get("contacts", "viscous") == found_with
    per = max(200, round(1 / frequency / 5e-7))
    run = transient(
        eq,
        speed=OMEGA,
        dt=1 / frequency / per,
        steps=12 * per,
        record=PLACES[:1],
        contacts="film",
        initial=motion,
        filter=False,
    )
    z = run["record"].values[:, 0].reshape(12, per)
    departs = np.abs(z[0] - z[-1]).max() / np.ptp(z[-1])
    if found_with == "film":
        # the step's error, (ωΔt)²/12 = 8e-5; films that know nothing of the motion leave 4e-4 and 9e-4
        assert departs < 1e-4
    else:
        assert departs > 2e-4  # it is another motion
