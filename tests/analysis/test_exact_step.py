"""The exact step: against closed forms, its own limit and Newmark's; and that it behaves as a march must."""

from __future__ import annotations

import math
import warnings
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from bearingdyn import core
from bearingdyn.analysis import equilibrium, frequency_response, transient, transients
from bearingdyn.analysis.equilibrium import Equilibrium
from bearingdyn.analysis.exact_step import ExactModes
from bearingdyn.analysis.held_forces import held_growth, phi
from bearingdyn.analysis.march import March
from bearingdyn.analysis.recordable_channels import channel_of
from bearingdyn.application import Application
from bearingdyn.material import Payne
from bearingdyn.notice import GrowingStep
from bearingdyn.parts import RigidBody
from bearingdyn.results import open_result
from bearingdyn.system import LoadTerm, System, assemble
from rotors import BEARING, RUBBER, friswell, held_jis_rotor, motor, oscillator

SPEED = 500.0  # rad/s
RECORD = ["shaft.end.y", "shaft.end.y.velocity", "ring.centre.x.velocity", "left.force.y"]
NONE = np.zeros(0)
PUSHED = {"block.centre": [2e-6, 1e-6, 0, 0, 0, 0]}  # out of its equilibrium


@pytest.fixture(scope="module")
def state() -> Equilibrium:
    return equilibrium(motor())


def exact(state: Equilibrium | System | Application, **changed: Any) -> Any:
    asked: dict[str, Any] = {"speed": SPEED, "dt": 1e-5, "steps": 400, "record": RECORD, "progress": False}
    return transient(state, **asked | changed, method="exact")


def loaded(system: System, kind: str, channel: str, sine: str | None = None, **other: Any) -> System:
    """The system under one load of 1 N at a channel."""
    row = system.row(channel)
    term = LoadTerm(
        kind,
        other.get("omega", 0.0),
        row,
        0 * row if sine is None else system.row(sine),
        other.get("time", NONE),
        other.get("value", NONE),
    )
    return replace(system, loads=(*system.loads, term))


def free_body() -> Application:
    """2 kg, 1 kg m², held by nothing."""
    app = Application()
    app.add("body", RigidBody(2.0, (1.0, 1.0, 1.0)))
    app.free("body.centre")
    return app


def test_phi_functions_are_their_integrals():
    """∫₀¹ exp(z(1 − s)) s^(k−1)/(k−1)! ds by Gauss's rule, on both sides of the series' circle."""
    nodes, share = np.polynomial.legendre.leggauss(60)
    s = 0.5 * (nodes + 1)
    z = np.array([0, 1e-9, 1e-3j, -0.3, 0.999j, 1.001j, -2 + 3j, -40, 30j])
    for k in range(1, 6):
        each = np.exp(z[:, None] * (1 - s)) * s ** (k - 1) / math.factorial(k - 1)
        assert np.abs(phi(z, 5)[k] / (each @ (0.5 * share)) - 1).max() < 1e-12


def test_newtons_matrix_is_of_the_steps_own_order(state: Equilibrium) -> None:
    """A force counts otherwise on a line, a parabola and a cubic: the matrix is made anew with each of them.

    One of the first step alone would serve too, with an evaluation more in every step.
    """
    march = March.of(state, speed=SPEED, dt=1e-5, steps=3, method="exact")
    model, modes = march.model([]), ExactModes.of(march.modal, SPEED).step(1e-5, 3)
    _, after, first = core.march(model, march.start(model), march.stepping, 3, 1, start=True, modes=modes)
    _, _, later = core.march(model, after, march.stepping, 100, 1, modes=modes)
    assert (first.refreshes, later.refreshes) == (3, 0)
    assert later.iterations <= 2.1 * later.steps


def test_an_evaluation_that_would_only_confirm_is_spared_and_the_tolerance_kept() -> None:
    march = March.of(equilibrium(held_jis_rotor()), speed=300.0, dt=2e-5, steps=3, method="exact")
    model = march.model([channel_of(march.modal, "rotor.centre.y")[0]])
    modes = ExactModes.of(march.modal, 300.0).step(2e-5, 3)
    evaluations, record = {}, {}
    for tolerance in (1e-11, 1e-15):
        stepping = replace(march.stepping, scheme=replace(march.stepping.scheme, tolerance=tolerance))
        found, _, report = core.march(model, march.start(model), stepping, 2000, 1, start=True, modes=modes)
        evaluations[tolerance], record[tolerance] = report.iterations / report.steps, found[:, 0]
    # the third of most steps sees what the first two told: 2.94 with it
    assert evaluations[1e-11] < 2.1
    assert evaluations[1e-15] > 2.5
    # a tenth of the tolerance may be left in a step's force, and 2000 steps add what they leave
    apart = np.abs(record[1e-11] - record[1e-15]).max() / np.ptp(record[1e-15])
    assert apart < 2000 * 0.1 * 1e-11


@pytest.mark.parametrize("speed", [0.0, 400.0])
def test_undamped_energy_stays_over_1e5_steps(speed: float):
    """A rotor with discs, elastic and gyroscopic, without damping: only round-off may change its energy."""
    first = {"rotor.left": [1e-4, -2e-4, 0, 0, 0, 0]}
    more: dict[str, Any] = {"speed": speed, "dt": 2e-5, "record": [], "initial": first, "audit": True}
    begun, ended = (exact(assemble(friswell()), steps=n, **more).attrs for n in (1, 100_000))
    energies = [a["energy_kinetic"] + a["energy_elastic"] for a in (begun, ended)]
    assert energies[0] > 0
    assert abs(energies[1] / energies[0] - 1) < 1e-10


def test_a_free_body_moves_as_newton_says():
    """Nothing holds it: x is the integral of its velocity, under three kinds of force."""
    system, t = assemble(free_body()), 1e-3 * np.arange(1, 201)
    more: dict[str, Any] = {"speed": 0.0, "dt": 1e-3, "steps": 200, "record": ["body.centre.y"]}
    found = exact(loaded(system, "constant", "body.centre.y"), **more)["record"].values[:, 0]
    np.testing.assert_allclose(found, t**2 / 4, rtol=1e-12)
    w = 900.0  # 0.9 rad a step
    found = exact(loaded(system, "harmonic", "body.centre.y", omega=w), **more)["record"].values[:, 0]
    np.testing.assert_allclose(found, (1 - np.cos(w * t)) / (2 * w**2), atol=1e-12 / w**2)
    ramp = loaded(system, "sampled", "body.centre.y", time=np.array([0.0, 0.2]), value=np.array([0.0, 1.0]))
    found = exact(ramp, **more)["record"].values[:, 0]
    np.testing.assert_allclose(found, t**3 / 12 / 0.2, rtol=1e-12)


@pytest.mark.parametrize("kind", ["harmonic", "rotating"])
def test_a_forced_oscillator_has_its_closed_form(kind: str):
    """From rest: the forced motion and the free one that starts it, to 1e-12 whatever the step."""
    m, c, k, w = 2.0, 40.0, 5e5, 300.0
    system = loaded(assemble(oscillator(m, c, k)), kind, "body.centre.x", "body.centre.y", omega=w)
    dt = 2e-3  # 0.6 rad of the load, 1 rad of the body
    found = exact(system, speed=w, dt=dt, steps=100, record=["body.centre.x", "body.centre.y"])[
        "record"
    ].values
    t = dt * np.arange(1, 101)
    size = w**2 if kind == "rotating" else 1.0
    s = np.roots([m, c, k])
    for column, phase in enumerate((1.0, -1j)):  # cos along x, sin along y
        forced = phase * size / (k - m * w**2 + 1j * w * c)
        free = np.linalg.solve([[1, 1], s], [-forced.real, -(1j * w * forced).real])
        x = (forced * np.exp(1j * w * t)).real + (np.exp(t[:, None] * s) @ free).real
        assert np.abs(found[:, column] - x).max() < 1e-12 * np.abs(x).max()


def test_a_layered_system_settles_to_its_frequency_response(state: Equilibrium):
    """Branches, dashpots and gyroscopic forces, at steps a tenth of the load's period."""
    w, dt = 2 * math.pi * 2000.0, 5e-5
    linear = loaded(state.linearised(), "harmonic", "shaft.end.y", omega=w)
    linear = replace(linear, loads=linear.loads[-1:])
    places = ["shaft.end.y", "ring.centre.x", "block.centre.y"]
    found = exact(linear, speed=300.0, dt=dt, steps=10, settle=200_000, record=places)["record"]
    amplitude = 2 * (found.values * np.exp(-1j * w * found["time"].values)[:, None]).mean(axis=0)
    steady = frequency_response(linear, [2000.0], ["shaft.end.y"], places, speed=300.0)["response"].values[
        0, :, 0
    ]
    # what is left of the ring-down after 10 s, and a period of ten samples
    assert np.abs(amplitude - steady).max() < 1e-9 * np.abs(steady).max()


@pytest.mark.parametrize("hold", [1, 2, 3])
def test_order_of_the_step(state: Equilibrium, hold: int, capsys: pytest.CaptureFixture[str]):
    """Bearing forces are held as a polynomial: one order more; against 1/32 of the step, from rest."""
    scheme = core.Scheme(hold=hold)

    def march(k: int) -> np.ndarray:
        return exact(state, dt=8e-6 / k, steps=500 * k, decimate=k, filter=False, scheme=scheme)[
            "record"
        ].values

    fine = march(32)
    steps = [1, 2, 4]
    error = [np.sqrt(np.mean((march(k) - fine) ** 2, axis=0)) / np.std(fine, axis=0) for k in steps]
    orders = np.log2(np.array(error[:-1]) / np.array(error[1:]))
    with capsys.disabled():
        print(f"\norder of the exact step: {np.round(orders, 2).tolist()}; error {np.max(error, axis=1)}")
    # a cubic begins as a line, whose one step is of the third order
    assert orders.min() > min(hold, 2) + 0.7


def test_order_where_balls_close_on_their_dampers():
    """A damper's force jumps as it closes: seen at the steps' ends alone, it would leave the first order."""
    app = motor()
    app.load("shaft.end", (0, -600.0, 0, 0, 0, 0))
    state = equilibrium(app)

    def march(k: int) -> np.ndarray:
        record = ["shaft.end.y", "shaft.end.y.velocity", "left.loaded"]
        return exact(state, dt=8e-6 / k, steps=3200 * k, decimate=k, filter=False, record=record)[
            "record"
        ].values

    fine = march(32)
    assert np.count_nonzero(np.diff(fine[:, 2]) > 0) >= 5
    fine = fine[:, :2]
    error = [
        np.sqrt(np.mean((march(k)[:, :2] - fine) ** 2, axis=0)) / np.std(fine, axis=0) for k in (1, 2, 4)
    ]
    orders = np.log2(np.array(error[:-1]) / np.array(error[1:]))
    print(np.round(orders, 2).tolist(), np.max(error, axis=1))
    # the first step is a line's, of third order
    assert orders[:, 0].min() > 2.7
    # velocities near a closing are those of a force that is spread over two steps: a jump's share of the time
    assert orders[:, 1].min() > 1.2
    assert np.max(error[-1]) < 5e-5


def ball_held() -> tuple[Equilibrium, float]:
    """A mass that balls alone hold across the axis, without damping; and ω across it, rad/s."""
    app = Application()
    app.add("body", RigidBody(0.1, (0.01,) * 3))
    app.ground("body.centre", stiffness=(1e2, 1e2, 1e2, 1e4, 1e4, 1e4))
    app.bearing("left", replace(BEARING, damping=0.0, clearance=-20e-6), inner="body.centre", outer="ground")
    still = equilibrium(app)
    return still, math.sqrt(still.bearings["left"].K[0, 0] / 0.1)


def growth(still: Equilibrium, w: float, turn: float, hold: int, steps: int = 400) -> float:
    """ln of what a swing of 1e-9 m grows by in a step, marched."""
    found = exact(
        still,
        speed=0.0,
        dt=turn / w,
        steps=steps,
        record=["body.centre.x"],
        initial={"body.centre": [1e-9, 0, 0, 0, 0, 0]},
        scheme=core.Scheme(hold=hold),
    )
    x = found["record"].values[:, 0]
    x = x - still.x @ still.system.row("body.centre.x")
    cosine = (x[:-2] + x[2:]) @ x[1:-1] / (2 * x[1:-1] @ x[1:-1])
    square = x[:-1] ** 2 + x[1:] ** 2 - 2 * cosine * x[:-1] * x[1:]  # amplitude² sin², alike in each step
    part = steps // 4
    return 0.5 * math.log(square[-part:].mean() / square[:part].mean()) / (steps - part)


@pytest.mark.parametrize("hold", [1, 2, 3])
def test_what_balls_alone_hold_grows_as_the_step_s_recurrence_says(hold: int):
    """By a march, and of a line never, of a parabola as (ωΔt)⁴/48, its error's lag."""
    still, w = ball_held()
    for turn in (0.4, 0.8):  # rad a step
        said = held_growth(np.array([turn]), np.ones(1), hold)[0]
        # a force of s^1.5 that swings by 1e-4 of its mean
        assert growth(still, w, turn, hold) == pytest.approx(said, rel=0.02, abs=1e-7)
    assert held_growth(np.array([0.2]), np.ones(1), 2)[0] == pytest.approx(0.2**4 / 48, rel=0.05)
    assert abs(held_growth(np.array([0.2]), np.ones(1), 1)[0]) < 1e-12


def test_what_balls_hold_does_not_grow_by_a_step_of_the_cubic_below_1_3_rad():
    turns, shares = (a.ravel() for a in np.meshgrid(np.linspace(0.05, 1.3, 40), np.linspace(0.001, 1.0, 30)))
    assert held_growth(turns, shares, 3).max() < 1e-9
    alone = np.linspace(0.05, 2.25, 40)
    assert held_growth(alone, np.ones(40), 3).max() < 1e-9


@pytest.mark.parametrize(("times", "grows"), [(0.85, False), (1.2, True)])
def test_a_step_that_makes_a_motion_grow_is_warned_of_and_one_that_does_not_is_not(times, grows):
    """At Δt³ = 48 δ/ω⁴ damping and a parabola's gain balance: as the warning and the march itself have it."""
    mass, damping = 0.1, 1.5
    app = Application()
    app.add("body", RigidBody(mass, (0.01,) * 3))
    still_axes = (1e2, 1e2, 1e2, 1e4, 1e4, 1e4)
    app.ground("body.centre", stiffness=still_axes, damping=(10.0, 1e2, 1e3, 1e2, 1e2, 1e2))
    ball = replace(BEARING, damping=damping, clearance=-20e-6)
    app.bearing("left", ball, inner="body.centre", outer="ground")
    still = equilibrium(app)
    w = math.sqrt(still.bearings["left"].K[0, 0] / mass)
    decay = 0.5 * (still.bearings["left"].C[0, 0] + 10.0) / mass
    dt = times * (48 * decay / w**4) ** (1 / 3)
    assert w * dt < 0.7  # where the next power of the step is small
    swing = {
        "dt": dt,
        "speed": 0.0,
        "record": ["body.centre.x"],
        "initial": {"body.centre": [1e-9] + 5 * [0]},
        "scheme": core.Scheme(hold=2),
    }
    with warnings.catch_warnings(record=True) as told:
        warnings.simplefilter("always", GrowingStep)
        x = exact(still, steps=4000, **swing)["record"].values[:, 0]
    x = x - still.x @ still.system.row("body.centre.x")
    assert (np.abs(x[-500:]).max() > np.abs(x[:500]).max()) == grows
    found = [str(w.message) for w in told if w.category is GrowingStep]
    assert len(found) == grows
    if grows:
        assert f"{w / (2 * math.pi):.4g}"[:3] in found[0]
        named = float(found[0].split("march with dt=")[1].split()[0])
        assert named == pytest.approx(dt / times, rel=0.1)
    with warnings.catch_warnings():  # a march of a few steps does not grow by 1 %
        warnings.simplefilter("error", GrowingStep)
        exact(still, steps=1, **swing)


def test_newmark_tends_to_the_exact_march(state: Equilibrium):
    """Two schemes without a line in common: Newmark's, extrapolated in its step, is the other."""

    def newmark(k: int) -> np.ndarray:
        found = transient(
            state,
            speed=SPEED,
            dt=1.6e-6 / k,
            steps=1000 * k,
            record=RECORD,
            decimate=10 * k,
            filter=False,
            progress=False,
            initial=PUSHED,
        )
        return found["record"].values

    coarse, fine = newmark(8), newmark(16)
    limit = fine + (fine - coarse) / 3
    found = exact(state, dt=1.6e-6, steps=1000, decimate=10, filter=False, initial=PUSHED)["record"].values
    size = np.std(limit, axis=0)
    assert (np.sqrt(np.mean((coarse - limit) ** 2, axis=0)) / size).max() > 1e-4
    assert (np.sqrt(np.mean((found - limit) ** 2, axis=0)) / size).max() < 5e-5


def test_channels_say_what_the_state_holds(state: Equilibrium):
    """Rows are read off the modes during a march; x, v and a are made of them at its end."""
    names = [
        f"{place}{rate}"
        for place in ("shaft.end.y", "ring.centre.x", "block.centre.z")
        for rate in ("", ".velocity", ".acceleration")
    ]
    found = exact(state, record=names, steps=50)
    march = March.of(state, speed=SPEED, dt=1e-5, steps=1, method="exact")
    model = march.model([])
    _, x, v, a, _ = model.unpack(found["state"].values, True)
    rows = np.array([march.modal.row(n) for n in ("shaft.end.y", "ring.centre.x", "block.centre.z")])
    expected = np.array([rows @ x, rows @ v, rows @ a]).T.ravel()
    np.testing.assert_allclose(
        found["record"].values[-1], expected, rtol=1e-9, atol=1e-11 * np.abs(expected).max()
    )
    # and a is the rate of v
    both = exact(state, record=names, steps=50, dt=1e-7, resume=found)["record"].values
    rate = np.gradient(both[:, 1::3], 1e-7, axis=0)
    np.testing.assert_allclose(both[5:-5, 2::3], rate[5:-5], rtol=1e-3, atol=1e-4 * np.abs(rate).max())


def test_resume_stream_and_threads_repeat_every_bit(state: Equilibrium, tmp_path: Any):
    whole = exact(state, steps=500)
    first = exact(state, steps=123)
    second = exact(state, steps=377, resume=first)
    np.testing.assert_array_equal(whole["record"].values[123:], second["record"].values)
    np.testing.assert_array_equal(whole["state"].values, second["state"].values)
    path = tmp_path / "run.bd"
    streamed = exact(state, steps=500, stream=path)
    np.testing.assert_array_equal(whole["record"].values, streamed["record"].values)
    np.testing.assert_array_equal(whole["record"].values, open_result(path)["record"].values)
    case = {"source": state, "speed": SPEED, "dt": 1e-5, "steps": 500, "record": RECORD, "method": "exact"}
    for run in transients([case, case], threads=2):
        np.testing.assert_array_equal(whole["state"].values, run["state"].values)


def test_instruction_sets_give_the_same_bits(state: Equilibrium):
    runs = []
    for isa in ("base", "avx2", "avx512"):
        try:
            scheme = core.Scheme(isa=isa)
        except ValueError:  # not on this machine
            continue
        runs.append(exact(state, scheme=scheme)["state"].values)
    assert runs
    for run in runs[1:]:
        np.testing.assert_array_equal(runs[0], run)


def test_the_audit_closes(state: Equilibrium):
    """Work and energy of a march from rest, integrated by the trapezoid: second order in the step."""

    def open_share(dt: float) -> float:
        e = exact(state, dt=dt, steps=round(4e-3 / dt), record=[], audit=True).attrs
        work = (
            e["energy_load"]
            + e["energy_turning"]
            - sum(e[f"energy_{n}"] for n in ("linear", "branch", "contact", "softening"))
        )
        begun = exact(state, dt=dt, steps=0, record=[], audit=True).attrs
        held = [
            sum(a[f"energy_{n}"] for n in ("kinetic", "elastic", "stored", "indentation")) for a in (begun, e)
        ]
        return abs(work - (held[1] - held[0])) / e["energy_throughput"]

    coarse, fine = open_share(1e-5), open_share(2.5e-6)
    assert coarse < 0.02
    assert fine < coarse / 8


def test_what_it_cannot_do_is_named(state: Equilibrium):
    with pytest.raises(ValueError, match=r"method is 'exact'.*100 to 200 rad/s.*newmark.*run-up"):
        exact(state, speed=([0.0, 1.0], [100.0, 200.0]))
    level = exact(state, speed=([0.0, 1.0], [SPEED, SPEED]), steps=5)
    np.testing.assert_array_equal(level["record"].values, exact(state, steps=5)["record"].values)
    with pytest.raises(ValueError, match=r"method is 'Exact'.*newmark"):
        transient(state, speed=0.0, dt=1e-5, steps=1, record=[], method="Exact")
    law = Payne(D=2.0344e6, gamma_c=3.588e-3, m=0.4817, Lm=0.1663e6, gamma_l=3.132e-3)
    with pytest.raises(ValueError, match=r"method is 'exact'.*'layer' softens.*newmark"):
        exact(equilibrium(motor(RUBBER.with_payne(law))))
    other = transient(state, speed=SPEED, dt=1e-5, steps=1, record=RECORD)
    with pytest.raises(ValueError, match=r"resume.*method='newmark'.*'exact'"):
        exact(state, resume=other)
    with pytest.raises(ValueError, match=r"resume.*method='exact'.*'newmark'"):
        transient(state, speed=SPEED, dt=1e-5, steps=1, record=RECORD, resume=exact(state, steps=1))


@pytest.mark.parametrize("hold", [0, 4, 2.5, float("nan"), "3", None])
def test_an_order_that_no_step_has_is_named(hold: Any):
    with pytest.raises(ValueError, match=r"hold is .*give 1, 2 or 3"):
        core.Scheme(hold=hold)


def test_an_order_may_be_any_whole_number(state: Equilibrium):
    whole, other = (exact(state, steps=5, scheme=core.Scheme(hold=h))["record"].values for h in (2, 2.0))
    np.testing.assert_array_equal(whole, other)


def test_check_step_says_what_is_left(state: Equilibrium):
    found = exact(state, steps=100, check_step=True)
    assert "fourth order" in found.attrs["step_error_made"]
    newmark = transient(state, speed=SPEED, dt=1e-5, steps=100, record=RECORD, check_step=True)
    assert (found.attrs["step_error"] < newmark.attrs["step_error"] / 3).all()
