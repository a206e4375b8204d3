"""The march in time against closed forms, its own discrete transfer function, and the harmonic response."""

from __future__ import annotations

import itertools
import math
from dataclasses import replace

import numpy as np
import pytest

from bearingdyn import core
from bearingdyn.analysis import Equilibrium, equilibrium, frequency_response, transient
from bearingdyn.application import Application
from bearingdyn.parts import RigidBody
from bearingdyn.system import LoadTerm, System, assemble
from rotors import motor, oscillator


@pytest.fixture(scope="module")
def state() -> Equilibrium:
    return equilibrium(motor())


def at(system: System, channel: str, *, frequency: float, amplitude: float = 1.0) -> System:
    """The system under one more cosine force at a channel."""
    none = np.zeros(0)
    row = amplitude * system.row(channel)
    term = LoadTerm("harmonic", 2 * math.pi * frequency, row, 0 * row, none, none)
    return replace(system, loads=(*system.loads, term))


def phasor(found, channel: str, frequency: float) -> complex:
    """Complex amplitude of a channel at one frequency, by least squares over the record."""
    w = 2 * math.pi * frequency * found.time.values
    basis = np.stack([np.cos(w), -np.sin(w), np.ones_like(w)], axis=1)
    a, b, _ = np.linalg.lstsq(basis, found.record.sel(channel=channel).values, rcond=None)[0]
    return complex(a, b)


# ------------------------------------------------------------------- closed forms


def free_decay(dt: float, end: float = 0.02) -> float:
    """Largest error of a released oscillator against its closed form, relative to the release."""
    m, c, k, x0 = 2.0, 40.0, 5e5, 1e-3
    found = transient(
        equilibrium(oscillator(m, c, k)),
        speed=0.0,
        dt=dt,
        steps=round(end / dt),
        record=["body.centre.y"],
        initial={"body.centre": (0, x0, 0, 0, 0, 0)},
    )
    w0, zeta = math.sqrt(k / m), c / (2 * math.sqrt(k * m))
    wd = w0 * math.sqrt(1 - zeta**2)
    t = found.time.values
    exact = x0 * np.exp(-zeta * w0 * t) * (np.cos(wd * t) + zeta * w0 / wd * np.sin(wd * t))
    return float(np.abs(found.record.values[:, 0] - exact).max() / x0)


def test_free_decay_has_the_closed_form_to_second_order():
    errors = [free_decay(dt) for dt in (4e-5, 2e-5, 1e-5)]
    # phase error ω t (ωΔt)²/12 of the average acceleration, 10 rad × (0.005)²/12, of what has not decayed
    assert 0.5 < errors[2] / (10.0 * (500 * 1e-5) ** 2 / 12) < 1.0
    orders = np.log2(np.array(errors[:-1]) / errors[1:])
    np.testing.assert_allclose(orders, 2.0, atol=0.05)


def test_sampled_load_is_followed_between_its_samples():
    """A ramp held at its end: on springs, quasi-static motion plus the ringing of a ramp's corners."""
    m, k, F, T = 2.0, 5e5, 100.0, 0.05
    app = oscillator(m, 0.0, k)
    app.load("body.centre", (0, F, 0, 0, 0, 0), time=[0.0, T], value=[0.0, 1.0])
    found = transient(equilibrium(app), speed=0.0, dt=1e-5, steps=8000, record=["body.centre.y"])
    t, w = found.time.values, math.sqrt(k / m)

    def ramp(t: np.ndarray) -> np.ndarray:
        return np.where(t > 0, t - np.sin(w * t) / w, 0.0)

    exact = F / (k * T) * (ramp(t) - ramp(t - T))
    # phase error 40 rad × (0.005)²/12 on the ringing F/(k T w)
    assert np.abs(found.record.values[:, 0] - exact).max() < 2 * 8.4e-5 * F / (k * T * w) + 1e-9 * F / k


def test_unbalance_drives_the_forward_whirl():
    """A gyroscopic rotor on springs under u Ω²: a circle of radius u Ω²/|k − mΩ² + iΩc| in the plane."""
    m, c, k, u, speed = 5.0, 400.0, 2e6, 1e-4, 500.0
    app = Application()
    app.add("rotor", RigidBody(m, (0.02, 0.02, 0.03), rotating=True))
    app.ground("rotor.centre", stiffness=(k,) * 6, damping=(c,) * 6)
    app.unbalance("rotor.centre", u, phase=0.3)
    names = ["rotor.centre.x", "rotor.centre.y"]
    found = transient(equilibrium(app), speed=speed, dt=2e-5, steps=5000, settle=60_000, record=names)
    f = speed / (2 * math.pi)
    x, y = (phasor(found, name, f) for name in names)
    exact = u * speed**2 * np.exp(0.3j) / (k - m * speed**2 + 1j * speed * c)
    # (ΩΔt)²/12 = 8e-6 of mΩ²/(k − mΩ²) = 1.7; start-up: e^{−40·1.2}
    assert x == pytest.approx(exact, rel=5e-5)
    assert y == pytest.approx(-1j * exact, rel=5e-5)
    # and the harmonic response to (1, −i) says the same
    H = frequency_response(app, [f], names, names, speed=speed).response.values[0]
    np.testing.assert_allclose([x, y], H @ [u * speed**2 * np.exp(0.3j) * q for q in (1, -1j)], rtol=5e-5)


# ------------------------------------------------------------------- layered systems


FREQUENCY, PER_PERIOD = 125.0, 800  # Δt = 10 µs
PLACES = ["shaft.end.y", "shaft.right.y", "ring.centre.y", "block.centre.y", "shaft.left.θx"]


@pytest.fixture(scope="module")
def steady(state):
    """The layered motor with linearised bearings, under a cosine at the shaft's end, its ring-down over."""
    linear = at(state.linearised(), "shaft.end.y", frequency=FREQUENCY)
    return transient(linear, speed=300.0, dt=1e-5, steps=10 * PER_PERIOD, settle=300_000, record=PLACES)


def test_march_has_the_transfer_function_of_its_own_scheme(state, steady):
    """z = e^{iωΔt}: s = (2/Δt)(z−1)/(z+1), and the exact branch history 2Gτ[(1−E−q) + qz]/(z−E) s."""
    linear, dt = state.linearised(), 1e-5
    z = np.exp(2j * math.pi * FREQUENCY * dt)
    s = 2 / dt * (z - 1) / (z + 1)
    D = s**2 * linear.M + s * (linear.C + 300.0 * linear.G) + linear.K + 300.0 * linear.N
    for term in linear.layers:
        G = term.material.G0 + term.material.eta0 * s
        for Gi, tau in zip(term.material.G, term.material.tau, strict=True):
            E = math.exp(-dt / tau)
            q = (dt - tau * (1 - E)) / dt
            G = G + Gi * tau * ((1 - E - q) + q * z) / (z - E) * s
        D = D + 2 * G * term.L @ term.L.T
    exact = np.linalg.solve(D, linear.row("shaft.end.y"))
    found = np.array([phasor(steady, name, FREQUENCY) for name in PLACES])
    wanted = np.array([linear.row(name) @ exact for name in PLACES])
    assert np.linalg.norm(found - wanted) < 1e-8 * np.linalg.norm(wanted)


def test_march_agrees_with_the_continuous_harmonic_response(state, steady):
    H = frequency_response(state, [FREQUENCY], ["shaft.end.y"], PLACES, speed=300.0).response.values[0, :, 0]
    found = np.array([phasor(steady, name, FREQUENCY) for name in PLACES])
    # (ωΔt)²/12 = 5e-6, far off resonance: well inside the per cent asked for
    assert np.linalg.norm(found - H) < 1e-4 * np.linalg.norm(H)


def test_several_sines_march_as_their_responses_add(state):
    frequencies = (60.0, 420.0, 1100.0)
    linear = state.linearised()
    for f in frequencies:
        linear = at(linear, "shaft.end.y", frequency=f)
    found = transient(linear, speed=0.0, dt=5e-6, steps=40_000, settle=400_000, decimate=4, record=PLACES)
    t = found.time.values  # 0.2 s: whole periods of all three
    for f in frequencies:
        w = 2 * math.pi * f
        marched = 2 * np.mean(found.record.values * np.exp(-1j * w * t)[:, None], axis=0)
        H = frequency_response(state, [f], ["shaft.end.y"], PLACES).response.values[0, :, 0]
        # (ωΔt)²/12 is 1e-4 at 1.1 kHz, magnified near resonances by 1/2ζ
        assert np.linalg.norm(marched - H) < 1e-2 * np.linalg.norm(H)


def test_small_motion_about_equilibrium_is_that_of_the_linearised_bearings(state):
    """The nonlinear march under 0.1 N against the linear response, at standstill."""
    app = motor()
    app.load("shaft.end", (0, 0.1, 0, 0, 0, 0), frequency=FREQUENCY)
    found = transient(equilibrium(app), speed=0.0, dt=2e-5, steps=8000, settle=60_000, record=PLACES)
    moved = np.array([phasor(found, name, FREQUENCY) for name in PLACES])
    H = 0.1 * frequency_response(state, [FREQUENCY], ["shaft.end.y"], PLACES).response.values[0, :, 0]
    # 0.1 N of 180 N: curvature of the 3/2 law (1/2000)², least squares of a decayed start: 1e-3 is ample
    assert np.linalg.norm(moved - H) < 1e-3 * np.linalg.norm(H)


def test_equilibrium_stays_where_it_is(state):
    found = transient(state, speed=0.0, dt=1e-5, steps=2000, record=["shaft.end.y", "left.loaded"])
    y = found.record.sel(channel="shaft.end.y").values
    start = state.displacement("shaft.end")[1]
    # forces balance to 1e-12 of all ball loads (some 2 kN) on 1e6 N/m: 1e-15 m
    assert np.abs(y - start).max() < 1e-13
    assert (
        found.record.sel(channel="left.loaded").values == np.count_nonzero(state.bearings["left"].loads)
    ).all()


def test_equilibrium_at_a_cage_angle_is_where_the_march_finds_its_balls():
    turned = equilibrium(motor(), angle=0.3)
    found = transient(turned, speed=0.0, dt=1e-5, steps=500, record=["shaft.end.y"])
    assert np.abs(found.record.values[:, 0] - turned.displacement("shaft.end")[1]).max() < 1e-13


def test_smooth_motion_converges_to_second_order_while_no_contact_is_lost():
    """A burst sin⁴ of 500 N on a preload of 180 N: the 3/2 law bends, all sixteen balls stay loaded."""
    t = np.linspace(0.0, 0.02, 8_001)  # every 2.5 µs: all steps fall on samples
    app = motor()
    app.load("shaft.end", (0, 500.0, 0, 0, 0, 0), time=t, value=np.sin(np.pi * t / 0.02) ** 4)
    eq = equilibrium(app)
    marches = []
    for halvings in range(4):
        n = 2**halvings
        found = transient(
            eq,
            speed=0.0,
            dt=2e-5 / n,
            steps=1500 * n,
            decimate=n,
            filter=False,
            record=["shaft.end.y", "ring.centre.y", "left.loaded", "right.loaded"],
        )
        assert (found.record.values[:, 2:] == 8).all()
        marches.append(found.record.values[:, :2])
    steps = [np.abs(a - b).max() for a, b in itertools.pairwise(marches)]
    # the last difference is 5e-13 m, well above the Newton tolerance: 1e-9 of 500 N on 1e7 N/m
    np.testing.assert_allclose(np.log2(np.array(steps[:-1]) / steps[1:]), 2.0, atol=0.1)


def test_energy_of_a_layered_rotor_on_turning_bearings_adds_up():
    """Work of loads and turning = stored + dissipated, to 1e-4 of ∫|P|dt; order two in Δt."""
    app = motor()
    app.unbalance("shaft.end", 2e-5)
    eq = equilibrium(app)
    at_start = 0.5 * eq.x @ eq.system.stiffness() @ eq.x
    for state, term in zip(eq.bearings.values(), eq.system.bearings, strict=True):
        at_start += 0.4 * (state.loads * (state.loads / term.bearing.kappa) ** (2 / 3)).sum()
    residuals = []
    for dt in (2e-5, 1e-5, 5e-6):
        attrs = transient(eq, speed=523.6, dt=dt, steps=round(0.1 / dt), record=[], audit=True).attrs
        e = {name: attrs[f"energy_{name}"] for name in core.ENERGIES}
        stored = e["kinetic"] + e["elastic"] + e["stored"] + e["indentation"] - at_start
        spent = e["linear"] + e["branch"] + e["contact"]
        assert min(e["kinetic"], e["linear"], e["branch"], e["contact"]) > 0
        residuals.append(abs(e["load"] + e["turning"] - spent - stored) / e["throughput"])
    assert residuals[0] < 1e-4
    # works are integrated by the trapezoidal rule
    np.testing.assert_allclose(np.log2(np.array(residuals[:-1]) / residuals[1:]), 2.0, atol=0.1)


# ------------------------------------------------------------------- the record


def march(state: Equilibrium, **change):
    arguments = {"speed": 300.0, "dt": 1e-5, "steps": 1000, "record": ["shaft.end.y", "left.ball3"]}
    return transient(state, **(arguments | change))


def test_settling_is_the_same_march_with_its_beginning_left_out(state):
    whole, late = march(state, steps=1500), march(state, steps=1000, settle=500)
    assert np.array_equal(late.record.values, whole.record.values[500:])
    assert np.array_equal(late.time.values, whole.time.values[500:])


def test_decimation_keeps_every_nth_sample(state):
    whole, thin = march(state), march(state, decimate=7, filter=False)
    assert np.array_equal(thin.record.values, whole.record.values[6::7])
    assert np.array_equal(thin.time.values, whole.time.values[6::7])
    np.testing.assert_allclose(whole.time.values, 1e-5 * np.arange(1, 1001), rtol=1e-14)


@pytest.mark.parametrize("decimate", [1, 7])
def test_resuming_goes_on_bit_for_bit(state, decimate):
    whole = march(state, steps=1000, decimate=decimate)
    first = march(state, steps=430, decimate=decimate)
    second = march(state, steps=570, decimate=decimate, resume=first)
    assert np.array_equal(np.vstack([first.record, second.record]), whole.record)
    assert np.array_equal(np.concatenate([first.time, second.time]), whole.time)
    assert np.array_equal(second.state, whole.state)


def test_resuming_from_a_file(state, tmp_path):
    from bearingdyn.results import open_result, save

    first = march(state, steps=430)
    save(first, tmp_path / "first.nc")
    again = march(state, steps=570, resume=open_result(tmp_path / "first.nc"))
    assert np.array_equal(again.record, march(state, steps=570, resume=first).record)


def test_a_march_goes_on_with_another_step(state):
    first = march(state, steps=100)
    second = march(state, steps=100, dt=5e-6, resume=first)
    np.testing.assert_allclose(second.time.values, 1e-3 + 5e-6 * np.arange(1, 101), rtol=1e-13)


def test_resume_refuses_the_state_of_another_application(state):
    other = transient(equilibrium(oscillator()), speed=0.0, dt=1e-4, steps=1, record=[])
    with pytest.raises(ValueError, match="state"):
        march(state, resume=other)
    with pytest.raises(ValueError, match=r"resume.*initial"):
        march(state, resume=march(state, steps=1), initial={"shaft.end": np.zeros(6)})


def test_initial_places_are_taken(state):
    wanted = np.array([1e-6, -2e-6, 3e-6, 1e-5, -2e-5, 0.0])
    found = march(
        state, steps=1, dt=1e-12, initial={"block.centre": wanted}, record=["block.centre.x", "cap.centre.z"]
    )
    # one step of a picosecond: nothing has moved yet
    assert found.record.values[0, 0] == pytest.approx(1e-6, abs=1e-15)
    assert found.record.values[0, 1] == pytest.approx(state.displacement("cap.centre")[2], abs=1e-15)


def test_initial_places_that_share_coordinates_are_all_met(state):
    bent = np.random.default_rng(0).standard_normal(state.system.n) * 1e-7
    places = {name: state.system.rows(name) @ bent for name in ("shaft.left", "shaft.end")}
    record = [f"{name}.{axis}" for name in places for axis in ("x", "y", "z", "θx", "θy", "θz")]
    for order in (1, -1):
        initial = dict(list(places.items())[::order])
        found = march(state, steps=1, dt=1e-12, initial=initial, record=record)
        # one step of a picosecond: nothing has moved yet but by its acceleration, 1e-24 of it
        np.testing.assert_allclose(found.record.values[0], np.concatenate(list(places.values())), atol=1e-13)


def test_initial_places_that_contradict_each_other_are_refused(state):
    apart = {"ring.centre": np.zeros(6), "layer.inner": np.full(6, 1e-6)}
    with pytest.raises(ValueError, match="cannot make together"):
        march(state, steps=1, initial=apart)


def test_channels_carry_names_and_units(state):
    names = {
        "shaft.end.y": "m",
        "shaft.end.y.velocity": "m/s",
        "shaft.end.y.acceleration": "m/s²",
        "shaft.left.θx": "rad",
        "shaft.left.rx.velocity": "rad/s",
        "shaft.left.ry.acceleration": "rad/s²",
        "left.loaded": "1",
        "left.ball3": "N",
        "right.force.z": "N",
    }
    found = march(state, steps=200, record=list(names))
    assert list(found.channel.values) == list(names)
    assert list(found.unit.values) == list(names.values())
    assert found.time.attrs["units"] == "s"
    y = found.record.sel(channel="shaft.end.y").values
    v = found.record.sel(channel="shaft.end.y.velocity").values
    a = found.record.sel(channel="shaft.end.y.acceleration").values
    # average acceleration: Δx = Δt (v + v')/2 and Δv = Δt (a + a')/2, exactly but for round-off of x
    np.testing.assert_allclose(np.diff(y), 1e-5 * (v[1:] + v[:-1]) / 2, atol=1e-9 * np.abs(y).max())
    np.testing.assert_allclose(np.diff(v), 1e-5 * (a[1:] + a[:-1]) / 2, atol=1e-9 * np.abs(v).max())


def test_bearing_channels_are_balls_and_their_sum(state):
    names = [f"left.ball{j}" for j in range(1, 9)] + [
        "left.force.x",
        "left.force.y",
        "left.force.z",
        "left.loaded",
    ]
    found = march(state, speed=0.0, steps=1, record=names).record.values[0]
    bearing = state.bearings["left"]
    # equilibrium holds: 1e-12 of the loads, through one step
    np.testing.assert_allclose(found[:8], bearing.loads, rtol=1e-6, atol=1e-6)
    np.testing.assert_allclose(found[8:11], bearing.g[:3], atol=1e-5)
    assert found[11] == np.count_nonzero(bearing.loads > 0)


def test_attributes_tell_how_it_was_made(state):
    found = march(state, decimate=10, settle=20)
    for name, value in {
        "speed": 300.0,
        "dt": 1e-5,
        "decimate": 10,
        "settle": 20,
        "steps": 1000,
        "complete": 1,
    }.items():
        assert found.attrs[name] == value


def test_progress_is_told_with_the_settling_counted(state):
    seen = []
    march(state, steps=600, settle=600, progress=lambda done, total: seen.append((done, total)))
    assert seen[-1] == (1200, 1200)
    assert all(total == 1200 for _, total in seen)
    assert sorted(seen) == seen


# ------------------------------------------------------------------- what goes wrong


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"dt": 0.0}, "dt is 0.0"),
        ({"dt": -1e-6}, "dt is -1e-06"),
        ({"dt": math.nan}, "dt is nan"),
        ({"steps": -1}, "steps is -1"),
        ({"steps": 1.5}, "steps is 1.5"),
        ({"steps": math.nan}, "steps is nan"),
        ({"steps": math.inf}, "steps is inf"),
        ({"settle": -5}, "settle is -5"),
        ({"decimate": 0}, "decimate is 0"),
        ({"speed": math.inf}, "speed is inf"),
        ({"record": ["shaft.end"]}, "'shaft.end' is a place; add"),
        ({"record": ["shaft.end.w"]}, "not 'w'"),
        ({"record": ["left.ball9"]}, "ball1 … ball8"),
        ({"record": ["left.ball0"]}, "ball1 … ball8"),
        ({"record": ["left.x"]}, "bearing 'left' offers"),
        ({"initial": {"shaft.end": (0, 0, 0)}}, r"initial\['shaft.end'\] is .*must be 6 finite"),
        ({"initial": {"shaft.end": (0, 0, 0, 0, 0, math.nan)}}, "6 finite"),
        ({"initial": {"shaft.tip": np.zeros(6)}}, "no interface"),
    ],
)
def test_bad_requests_are_named(state, change, message):
    with pytest.raises(ValueError, match=message):
        march(state, **change)


@pytest.mark.parametrize("change", [{"beta": -1.0}, {"tolerance": math.nan}])
def test_a_bad_scheme_is_named(state, change):
    with pytest.raises(ValueError, match=next(iter(change))):
        march(state, scheme=core.Scheme(**change))


def test_divergence_keeps_what_was_computed(state):
    """A step far too long for β = 0: the scheme is unstable, grows, and says where it stopped."""
    app = oscillator(c=0.0)
    app.load("body.centre", (0, 1.0, 0, 0, 0, 0), frequency=10.0)
    explicit = core.Scheme(beta=0.0)
    with pytest.raises(core.SolverError, match=r"in step \d+ at t = ") as caught:
        transient(equilibrium(app), speed=0.0, dt=1.0, steps=1000, record=["body.centre.y"], scheme=explicit)
    partial, report = caught.value.partial, caught.value.report
    assert partial.attrs["complete"] == 0
    assert 0 < report.steps < 1000
    assert partial.sizes["time"] == report.steps
    assert np.isfinite(partial.record.values).all()
    assert report.t == pytest.approx(partial.time.values[-1])


def test_newton_without_convergence_names_its_bearing(state):
    with pytest.raises(core.SolverError, match=r"worst in bearing '(left|right)'.*smaller dt") as caught:
        march(state, dt=1e-4, steps=100, scheme=core.Scheme(max_iterations=1), speed=3000.0)
    assert caught.value.partial.attrs["complete"] == 0
    assert caught.value.report.bearing in (0, 1)


@pytest.mark.parametrize("settle", [0, 10**9])
def test_interrupt_keeps_what_was_computed(state, settle):
    def stop(done: int, _: int) -> None:
        if done >= 256:
            raise KeyboardInterrupt

    with pytest.raises(core.Interrupted) as caught:
        march(state, steps=10**7 if settle == 0 else 10, settle=settle, decimate=5, progress=stop)
    partial = caught.value.partial
    assert partial.attrs["complete"] == 0
    assert partial.sizes["time"] == (partial.attrs["steps"] // 5 if settle == 0 else 0)
    if settle == 0:
        n = int(partial.attrs["steps"])
        again = march(state, steps=n + 50, decimate=5)
        rest = march(state, steps=50, decimate=5, resume=partial)
        assert np.array_equal(np.vstack([partial.record, rest.record]), again.record)


def test_an_error_in_progress_is_not_swallowed(state):
    def fail(*_: int) -> None:
        raise RuntimeError("mine")

    with pytest.raises(RuntimeError, match="mine"):
        march(state, progress=fail)


def test_a_layer_needs_a_maxwell_model_in_time():
    app = motor()
    system = assemble(app)

    class Table:
        K, density = 2e9, 1200.0

        def complex_modulus(self, omega):
            return 1e6 * (1 + 0.3j) + 0 * omega

    layers = tuple(replace(t, material=Table()) for t in system.layers)
    with pytest.raises(ValueError, match=r"Table.*Maxwell"):
        transient(replace(system, layers=layers), speed=0.0, dt=1e-5, steps=1, record=[])
