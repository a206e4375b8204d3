"""Bearings on oil in the harmonic domain: each film has its own stiffness and damping at a frequency."""

from __future__ import annotations

import math
import warnings
from dataclasses import replace

import numpy as np
import pytest
import scipy

import bearingdyn as bd
from bearingdyn.analysis import equilibrium, frequency_response, modes
from bearingdyn.analysis.energy_shares import energy_shares
from bearingdyn.analysis.equilibrium import Equilibrium
from bearingdyn.analysis.film_modes import film_modes
from bearingdyn.analysis.modes import _damped_modal
from bearingdyn.application import Application
from bearingdyn.bearing import BallBearing, FilmDamping, Lubricant, Walther, ehl
from bearingdyn.demo import SPEED, motor
from bearingdyn.notice import OilAtOtherSpeed
from bearingdyn.parts import RigidBody
from bearingdyn.system import assemble
from core_models import harmonic, model
from rotors import RUBBER

OIL, TEMPERATURE = Lubricant(Walther.iso_vg(32)), 60.0
MASS, LOAD, OMEGA = 0.05, 300.0, 523.6


def loaded_axially() -> Equilibrium:
    """A mass on one oiled bearing under an axial load: all balls carry alike."""
    ball = BallBearing(
        8,
        5.953e-3,
        25e-3,
        0.52,
        0.53,
        clearance=10e-6,
        lubrication=bd.OilSupply(OIL, TEMPERATURE, OMEGA),
    )
    app = Application()
    app.add("mass", RigidBody(MASS, (1e-5, 1e-5, 1e-5)))
    app.ground("mass.centre", stiffness=(1e3, 1e3, 0, 1e3, 1e3, 1e3))
    app.bearing("ball", ball, inner="mass.centre", outer="ground")
    app.load("mass.centre", (0, 0, LOAD, 0, 0, 0))
    return equilibrium(app)


@pytest.fixture(scope="module")
def axial() -> Equilibrium:
    return loaded_axially()


def by_hand(eq: Equilibrium, f: np.ndarray) -> np.ndarray:
    """Z (sin²α k(ω) + cos²α Q/Λ) of the loaded bearing, k of both contacts of a ball in series."""
    ball = eq.system.bearings[0].bearing
    Q = float(eq.bearings["ball"].loads.mean())
    sine = LOAD / (ball.Z * Q)
    distance = ball.geometry.A + (Q / ball.kappa) ** (2 / 3) - ball.film
    gamma = ball.Dw / ball.Dpw * math.sqrt(1 - sine**2)
    us = ball.Dpw / 2 * OMEGA * (1 - gamma**2)
    k = 1 / sum(
        1 / ehl.look_up(contact, OIL, Q, us, TEMPERATURE).stiffness(f)
        for contact in (ball.inner_contact, ball.outer_contact)
    )
    return ball.Z * (sine**2 * k + (1 - sine**2) * Q / distance)


def test_a_mass_on_oiled_balls_answers_as_its_contacts_do(axial: Equilibrium) -> None:
    f = np.geomspace(10, 30e3, 40)
    found = frequency_response(axial, f, ["mass.centre.z"], ["mass.centre.z", "ball.force.z"])
    H, passed = found["response"].values[:, :, 0].T
    k = by_hand(axial, f)
    # films are those of the dry bearing's loads and angle, 1e-3 from those of the balance
    np.testing.assert_allclose(H, 1 / (k - (2 * np.pi * f) ** 2 * MASS), rtol=5e-3)
    np.testing.assert_allclose(passed, k * H, rtol=5e-3)
    still = frequency_response(axial, [0.0], ["mass.centre.z"], ["mass.centre.z"])["response"].values
    # Re k at 1 mHz is the static stiffness
    assert 1 / complex(still.item()) == pytest.approx(by_hand(axial, np.array([1e-3]))[0].real, rel=2e-3)


def test_a_mode_has_the_damping_of_its_own_frequency(axial: Equilibrium) -> None:
    """m λ² + Re k + λ Im k/ω = 0 with k at ω = |Im λ|."""

    def excess(omega: float) -> complex:
        k = complex(by_hand(axial, np.array([omega / 2 / np.pi]))[0])
        c = k.imag / omega
        return complex(-c / 2 / MASS, math.sqrt(k.real / MASS - (c / 2 / MASS) ** 2))

    omega = scipy.optimize.brentq(lambda w: excess(w).imag - w, 1e3, 1e6)
    along = modes(axial, damped=True)
    row = axial.system.row("mass.centre.z")
    pick = int(np.argmax(np.abs(along["shape"].values @ row)))
    value = complex(along["eigenvalue"].values[pick])
    assert value.imag == pytest.approx(omega, rel=2e-3)
    assert value.real == pytest.approx(excess(omega).real, rel=1e-2)
    # the resonance itself: half-power width over frequency is 2ζ
    f0, zeta = value.imag / 2 / np.pi, -value.real / abs(value)
    f = f0 * np.linspace(1 - 6 * zeta, 1 + 6 * zeta, 4001)
    peak = np.abs(
        frequency_response(axial, f, ["mass.centre.z"], ["mass.centre.z"])["response"].values[:, 0, 0]
    )
    wide = f[peak > peak.max() / math.sqrt(2)]
    assert (wide[-1] - wide[0]) / f0 == pytest.approx(2 * zeta, rel=0.03)
    shares = energy_shares(axial, along)
    assert float(shares["damping"].values[pick].sum()) == pytest.approx(zeta, rel=1e-6)


def test_low_frequency_is_the_viscous_law(axial: Equilibrium) -> None:
    """Below Ω = .02 damping is c0; the stiffness of a slow motion is K0, a per cent below the dry one."""
    omega = np.array([2 * np.pi])
    balls = axial.bearings["ball"].balls
    assert balls is not None
    k = balls.stiffness(omega)[0]
    s = (balls.loads / balls.kappa) ** (2 / 3)
    c, dry = balls.law.at(s), 1.5 * balls.kappa * np.sqrt(s)
    assert (np.abs(k.imag) < 1e-3 * omega * c).all()
    assert ((-0.03 * dry < k.real) & (k.real < 0)).all()
    # Σ c v vᵀ is the tangent that the kernel forms
    C = (balls.across.T * c) @ balls.across
    np.testing.assert_allclose(C, axial.bearings["ball"].C, rtol=1e-12, atol=1e-12 * np.abs(C).max())


def test_the_rings_give_lies_in_series_with_the_contacts(axial: Equilibrium) -> None:
    """1/k = 1/k̂(ω) + give of every ball, and of the kernel's tangents the damper's share in it."""
    ball = axial.bearings["ball"].balls
    assert ball is not None
    dry = 1.5 * ball.kappa * np.sqrt((ball.loads / ball.kappa) ** (2 / 3))
    give = 0.3 / float(dry.mean())  # of a soft ring: three tenths of the contact's own
    system = replace(axial.system, bearings=(replace(axial.system.bearings[0], give=give),))
    soft = equilibrium(system)
    balls, state = soft.bearings["ball"].balls, soft.bearings["ball"]
    assert balls is not None
    # at low frequency the kernel's law, and the stiffness K0 of a slow motion
    slow = np.array([2 * np.pi])
    k = balls.stiffness(slow)[0]
    own = 1.5 * balls.kappa * np.sqrt((balls.loads / balls.kappa) ** (2 / 3))
    c = balls.law.at((balls.loads / balls.kappa) ** (2 / 3)) / (1 + give * own) ** 2
    C = (balls.across.T * c) @ balls.across
    # nodes of the damping are 1/64 apart
    np.testing.assert_allclose(C, state.C, rtol=5e-3, atol=1e-6 * np.abs(C).max())
    assert (
        np.abs(k.imag) < 0.04 * slow * c
    ).all()  # K0 is softer than dry, and the damper's share rises with it
    # and at any frequency the series of both
    f = np.geomspace(10, 30e3, 20)
    omega = 2 * np.pi * f
    free = replace(balls, give=0.0)
    contact = (
        free.stiffness(omega)
        + own
        + 1j * omega[:, None] * balls.law.at((balls.loads / balls.kappa) ** (2 / 3))
    )
    whole = balls.stiffness(omega) + own / (1 + give * own) + 1j * omega[:, None] * c
    np.testing.assert_allclose(whole, 1 / (1 / contact + give), rtol=1e-12)


def test_balls_below_the_table_keep_the_damping_of_their_law(axial: Equilibrium) -> None:
    """Loads fade and the law with them; the answer, held at the table's end, is brought down to the law."""
    balls = axial.bearings["ball"].balls
    assert balls is not None
    assert balls.law.answer is not None
    least = balls.law.answer.loads()[0]
    fading = replace(balls, loads=least * np.array([0.1, 0.3, 1.0]), across=balls.across[:3])
    c = balls.law.at((fading.loads / balls.kappa) ** (2 / 3))
    assert c[0] < 0.1 * c[2]
    assert (np.abs(fading.stiffness(np.array([2 * np.pi]))[0].imag) < 1e-3 * 2 * np.pi * c).all()


def test_many_balls_are_interpolated_to_the_answer_of_each(axial: Equilibrium) -> None:
    """Twenty loads over a decade by splines through twelve, against each looked up by itself."""
    balls = axial.bearings["ball"].balls
    assert balls is not None
    answer = balls.law.answer
    assert answer is not None
    loads, omega = np.geomspace(20.0, 200.0, 20), 2 * np.pi * np.array([50.0, 2e3, 1e4])
    many = answer.under(loads).stiffness(omega)
    each = np.concatenate([answer.under(loads[i : i + 1]).stiffness(omega) for i in range(20)], axis=1)
    np.testing.assert_allclose(many.real, each.real, rtol=1e-3)
    np.testing.assert_allclose(many.imag, each.imag, rtol=1e-2)
    assert np.ptp(each.imag, axis=1).min() > 0.1 * np.abs(each.imag).max(axis=1).min()


def test_modes_on_a_layer_and_of_a_rotor_are_followed_to_their_own_eigenvalues() -> None:
    """Without films the search must find what the linear problem has, from a per cent beside it."""
    speed = 300.0
    app = Application()
    app.add("mass", RigidBody(2.0, (1e-3, 1e-3, 1e-3)))
    app.add("layer", bd.Layer(0.026, 0.030, 0.016, RUBBER, refinement=0.5))
    app.connect("mass.centre", "layer.inner")
    app.ground("layer.outer", stiffness=[1e8] * 3 + [1e5] * 3)
    app.add("rotor", RigidBody(4.0, (0.02, 0.02, 0.03), rotating=True))
    app.ground("rotor.centre", stiffness=[1e6] * 3 + [1e3, 2e3, 1e3], damping=[10.0] * 3 + [0.1] * 3)
    modal, _ = assemble(app).modal()
    assert modal.layers
    assert np.abs(modal.G).max() > 0
    values, shapes = _damped_modal(modal, speed)
    swinging = (values.imag > 0) & (values.imag > 0.5 * np.abs(values))
    values, shapes = values[swinging], shapes[:, swinging]
    found, _ = film_modes(modal, speed, lambda omega: None, values, lambda held: (1.01 * values, shapes))
    assert found.size > 2
    np.testing.assert_allclose(np.sort_complex(found), np.sort_complex(values), rtol=1e-8)


def test_an_average_over_cage_angles_weighs_them_alike() -> None:
    eq = demo(average=3)
    for state in eq.bearings.values():
        balls = state.balls
        assert balls is not None
        c = balls.law.at((balls.loads / balls.kappa) ** (2 / 3))
        np.testing.assert_allclose(
            (balls.across.T * c) @ balls.across, state.C, rtol=0, atol=1e-12 * state.C.max()
        )


def test_core_adds_the_balls_to_the_bearings() -> None:
    """k v vᵀ of two balls at one frequency is the K and C that they make there."""
    m = model()
    one = {"omega": np.array([700.0]), "modulus": np.full((1, 1), 1e6 + 2e5j)}
    K, C = 1e7 * np.eye(5), 30.0 * np.eye(5)
    v = np.random.default_rng(3).standard_normal((2, 5))
    k = np.array([[3e6 + 4e5j, -1e6 + 2e5j]])
    Z = (v.T * k[0]) @ v
    beside = harmonic(m, **one, balls=(k, v))
    within = harmonic(m, **one, bearing_K=K + Z.real, bearing_C=C + Z.imag / 700.0)
    # round-off of two ways to one sum, times the condition of the solve
    np.testing.assert_allclose(beside, within, rtol=0, atol=1e-10 * np.abs(within).max())
    without = harmonic(m, **one)
    assert np.abs(beside - without).max() > 1e-3 * np.abs(without).max()
    for name, balls in (("across", (k, v[:, 1:])), ("ball", (k[:, :1], v)), ("ball", (k * np.nan, v))):
        with pytest.raises(ValueError, match=name):
            harmonic(m, **one, balls=balls)


def demo(average: int) -> Equilibrium:
    """The demo's motor without its layer, its bearings on VG 32 at 60 °C."""
    system = assemble(motor(None))
    supply = bd.OilSupply(OIL, TEMPERATURE, SPEED)
    oiled = tuple(replace(t, bearing=replace(t.bearing, lubrication=supply)) for t in system.bearings)
    return equilibrium(replace(system, bearings=oiled), average=average)


def test_the_demo_motor_on_films_is_the_dense_solve_to_1e_12() -> None:
    """−ω²M + iω(C + ΩG) + K + ΩN + Bᵀ (K_b + iωC_b + Σ k(ω) v vᵀ) B, solved as one matrix and refined."""
    eq = demo(average=1)
    f = np.geomspace(10.0, 10e3, 41)
    inputs, outputs = ["shaft.middle.y"], ["left_housing.top.y", "shaft.middle.x"]
    got = frequency_response(eq, f, inputs, outputs, speed=SPEED)["response"].values[:, :, 0]
    s = eq.system
    k, v = eq.balls(2 * np.pi * f)
    force, rows = s.row(inputs[0]), np.array([s.row(name) for name in outputs])
    for i, w in enumerate(2 * np.pi * f):
        Z = eq.bearing_K + 1j * w * eq.bearing_C + (v.T * k[i]) @ v
        D = s.K + SPEED * s.N - w**2 * s.M + 1j * w * (s.C + SPEED * s.G) + s.B.T @ Z @ s.B
        x = np.linalg.solve(D, force.astype(complex))
        for _ in range(2):
            left = force - D.astype(np.clongdouble) @ x.astype(np.clongdouble)
            x = x + np.linalg.solve(D, left.astype(complex))
        wanted = rows @ x
        assert np.abs(got[i] - wanted).max() < 1e-12 * np.abs(wanted).max()


def test_the_demo_motor_is_overdamped_above_a_kilohertz_by_a_viscous_contact() -> None:
    """100 Hz to 10 kHz: c(ω) falls from c0 at 100 Hz to a fifth of it at 10 kHz, and modes with it."""
    eq = demo(average=1)
    film, viscous = (modes(eq, damped=True, speed=SPEED, contacts=c) for c in ("film", "viscous"))
    f, loss = viscous["frequency"].values, film["damping_ratio"].values / viscous["damping_ratio"].values
    np.testing.assert_allclose(film["frequency"].values, f, rtol=0.01)  # K changes by 1.3 %
    low, high = (f > 100) & (f < 2000), (f > 5000) & (f < 10e3)
    assert (loss[low] > 0.95).all()  # c(1 kHz) is .96 c0
    assert loss[high].min() < 0.6  # where balls make most of the damping, c(6 kHz) is .3 c0
    assert (loss < 1.01).all()
    grid = np.geomspace(100, 10e3, 500)
    a, b = (
        frequency_response(eq, grid, ["shaft.middle.y"], ["left_housing.top.y"], contacts=c)[
            "response"
        ].values
        for c in ("film", "viscous")
    )
    decibels = 20 * np.log10(np.abs(a / b)).ravel()
    # heights of the resonances above 3 kHz, which the films damp less, and nothing at 100 to 300 Hz
    assert decibels[grid > 3000].max() > 3
    assert np.abs(decibels[grid < 280]).max() < 0.3


def test_a_constant_damping_answers_alike_either_way() -> None:
    eq = equilibrium(motor(None))
    f = [200.0, 2000.0]
    a, b = (
        frequency_response(eq, f, ["shaft.middle.y"], ["shaft.middle.y"], contacts=c)["response"].values
        for c in ("film", "viscous")
    )
    np.testing.assert_array_equal(a, b)
    assert not eq.filmed


@pytest.mark.parametrize("call", [frequency_response, modes])
def test_unknown_contacts_are_named(axial: Equilibrium, call: object) -> None:
    arguments = ([1.0], ["mass.centre.z"], ["mass.centre.z"]) if call is frequency_response else ()
    with pytest.raises(ValueError, match="contacts is 'oil'"):
        call(axial, *arguments, contacts="oil")  # type: ignore[operator]


def test_a_damping_by_hand_has_no_answer_by_frequency() -> None:
    with pytest.raises(ValueError, match=r"damping\.answer is 3"):
        FilmDamping(1e-6, np.linspace(0, 1, 65), 3)  # type: ignore[arg-type]
    assert FilmDamping(1e-6, np.linspace(0, 1, 65)).answer is None


@pytest.mark.parametrize("frequency", [2000.0, 9000.0])
def test_a_steady_motion_takes_films_by_the_frequency_of_each_line(frequency: float) -> None:
    """A small force along the axis, where all balls carry alike: the harmonic response, and its power."""
    ball = loaded_axially().system.bearings[0].bearing
    app = Application()
    app.add("mass", RigidBody(MASS, (1e-5, 1e-5, 1e-5)))
    app.ground("mass.centre", stiffness=(1e3, 1e3, 0, 1e3, 1e3, 1e3))
    app.bearing("ball", ball, inner="mass.centre", outer="ground")
    app.load("mass.centre", (0, 0, LOAD, 0, 0, 0))
    app.load("mass.centre", (0, 0, 0.1, 0, 0, 0), frequency=frequency)  # 3e-4 of the load: linear
    state, places = equilibrium(app), ["mass.centre.z", "ball.force.z"]
    for contacts in ("film", "viscous"):
        found = bd.steady_state(state, speed=OMEGA, record=places, contacts=contacts, harmonics=3)
        line = int(np.abs(np.abs(found["frequency"].values) - frequency).argmin())
        own = np.abs(found["amplitude"].values[line])
        wanted = frequency_response(state, [frequency], ["mass.centre.z"], places, contacts=contacts)
        # a ball under 3e-4 more or less of its load bends its law by a part in ten thousand
        np.testing.assert_allclose(own, 0.1 * np.abs(wanted["response"].values[0, :, 0]), rtol=2e-4)
        assert abs(found.attrs["energy_balance"]) < 1e-6
    with pytest.raises(ValueError, match="contacts"):
        bd.steady_state(state, speed=OMEGA, record=places, contacts="oil")  # type: ignore[arg-type]


@pytest.mark.parametrize("factor", [1 / 3, -0.7, 1.4])
def test_films_of_another_speed_are_told_of(axial: Equilibrium, factor: float) -> None:
    with pytest.warns(OilAtOtherSpeed, match=r"bearing 'ball' has the films and the damping of 52\d rad/s"):
        bd.transient(axial, speed=factor * OMEGA, dt=1e-6, steps=2, record=["mass.centre.z"])


def test_films_of_nearly_that_speed_pass_and_so_does_a_response_at_rest(axial: Equilibrium) -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error", OilAtOtherSpeed)
        for factor in (-1.0, 0.85, 1.2):
            bd.transient(axial, speed=factor * OMEGA, dt=1e-6, steps=2, record=["mass.centre.z"])
        frequency_response(axial, [100.0], ["mass.centre.z"], ["mass.centre.z"])
