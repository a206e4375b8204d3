"""Run-up and coast-down: the speed a function of time, and everything that turns with it."""

from __future__ import annotations

import dataclasses
from functools import cache
from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from bearingdyn import core
from bearingdyn.analysis import transient
from bearingdyn.application import Application
from bearingdyn.bearing import BallBearing
from bearingdyn.bearing.imperfections import Pit, Waviness
from bearingdyn.fem import Section
from bearingdyn.material import Elastic
from bearingdyn.parts import Disc, Shaft
from bearingdyn.system import System, assemble
from core_models import stepping

NO_TABLE = np.zeros(0)

# ---------------------------------------------------------------- rotor of Friswell et al. (theory.md §3.11)

STEEL = Elastic(211e9, 211 / (2 * 81.2) - 1, 7810.0)
ECCENTRICITY = 1e-3  # kg m on disc 1


@cache
def friswell(damping: float = 300.0) -> System:
    """Shaft 1.5 m on 1 MN/m at both ends, damped there (N s/m): criticals near 86 and 270 rad/s."""
    discs = [Disc.cylinder(0.5, 0.28, 0.07, 0.0, STEEL), Disc.cylinder(1.0, 0.35, 0.07, 0.0, STEEL)]
    app = Application()
    shaft = Shaft(
        [Section(1.5, 0.05)],
        seats={"a": 0.0, "b": 1.5},
        points={"d1": 0.5, "d2": 1.0},
        discs=discs,
        material=STEEL,
        damping=0.0,
        f_max=300.0,
        element_length=0.25,
    )
    app.add("shaft", shaft)
    for seat in ("a", "b"):
        app.ground(f"shaft.{seat}", (1e6, 1e6, 1e6, 0, 0, 1e3), (damping,) * 3 + (0, 0, 1))
    app.unbalance("shaft.d1", ECCENTRICITY)
    return assemble(app)


def integrated(s: System, row: np.ndarray, start: float, slope: float, at: np.ndarray) -> np.ndarray:
    """row·x (times,) from rest, Ω = start + slope·t, by SciPy's DOP853.

    M ẍ + (C + ΩG) ẋ + (K + ΩN + Ω̇G) x = unbalance
    """
    n, inverse, (load,) = s.n, np.linalg.inv(s.M), s.loads
    C, K = s.viscous(), s.stiffness()

    def derivative(t: float, y: np.ndarray) -> np.ndarray:
        speed, angle = start + slope * t, start * t + slope * t * t / 2
        c, sn = np.cos(angle), np.sin(angle)
        f = load.p_cos * (speed**2 * c + slope * sn) + load.p_sin * (speed**2 * sn - slope * c)
        x, v = y[:n], y[n:]
        acceleration = inverse @ (f - (C + speed * s.G) @ v - (K + speed * s.N + slope * s.G) @ x)
        return np.concatenate([v, acceleration])

    # 1e-8: four digits beyond what is asked of the march
    solution = solve_ivp(
        derivative, (0.0, at[-1]), np.zeros(2 * n), method="DOP853", t_eval=at, rtol=1e-8, atol=1e-12
    )
    return np.asarray(row @ solution.y[:n])


def test_run_up_through_two_criticals_is_the_integrated_one() -> None:
    s = friswell()
    start, slope, end = 20.0, 200.0, 1.8
    names = ["shaft.d1.x", "shaft.d2.y"]
    at = np.arange(5e-4, end, 5e-4)
    expected = np.array([integrated(s, s.row(name), start, slope, at) for name in names])
    peak = np.abs(expected).max(axis=1)
    # two criticals are passed: the motion swells above what it was before
    speed = start + slope * at
    for before, inside in (((40, 60), (60, 150)), ((150, 230), (230, 380))):
        quiet, loud = (
            np.abs(expected[:, (speed > low) & (speed < high)]).max(axis=1) for low, high in (before, inside)
        )
        assert (loud > 1.5 * quiet).all()
    errors = []
    for dt in (1e-4, 5e-5, 2.5e-5):
        found = transient(
            s,
            speed=([0.0, end], [start, start + slope * end]),
            dt=dt,
            steps=round(end / dt),
            decimate=round(5e-4 / dt),
            filter=False,
            record=names,
        )
        got = found.record.values[: len(at)].T
        np.testing.assert_allclose(found.time.values[: len(at)], at, rtol=1e-12)
        errors.append((np.abs(got - expected).max(axis=1) / peak).max())
    # the scheme's frequencies are short by (ωΔt)²/12: free swings of 270 rad/s over the 0.5 s since the
    # second critical, at 5e-5 s: 270·0.5·(270·5e-5)²/12 = 2e-3 rad of the e^-3.5 that is left of them
    assert errors[1] < 1e-3
    assert errors[2] < 1e-3
    # of second order; 1 % of the ratio for the integration's own error of some 1e-8 and higher orders
    assert errors[0] / errors[1] == pytest.approx(4.0, abs=0.2)
    assert errors[1] / errors[2] == pytest.approx(4.0, abs=0.2)


def test_a_slow_run_up_approaches_the_steady_response() -> None:
    """Complex amplitude of the whirl against (K + ΩN − Ω²M + iΩ(C + ΩG)) X = Ω² (p_cos − i p_sin).

    What is left is the lag of the response, ∝ Ω̇: half of it at half the rate.
    """
    s = friswell(3000.0)
    (load,) = s.loads
    row = s.row("shaft.d1.x")
    centre, dt = 150.0, 1e-4
    errors = []
    for slope in (8.0, 4.0):
        settled = 3.0  # s; the slowest free motion, bending at 5 % of critical damping, is gone like e^-13
        times, speeds = ([0.0, 2 * settled], [centre - slope * settled, centre + slope * settled])
        found = transient(
            s, speed=(times, speeds), dt=dt, steps=round(1.05 * settled / dt), record=["shaft.d1.x"]
        )
        t, x = found.time.values, found.record.values[:, 0]
        speed = speeds[0] + slope * t
        angle = speeds[0] * t + slope * t**2 / 2
        kept = slice(round(0.95 * settled / dt), None)
        # amplitude constant over the window but for its slope, which is fitted too
        w = (t[kept] - settled) / settled
        c, sn = np.cos(angle[kept]), np.sin(angle[kept])
        fit, *_ = np.linalg.lstsq(np.column_stack([c, sn, w * c, w * sn]), x[kept], rcond=None)
        at = speeds[0] + slope * settled
        assert at == pytest.approx(centre)
        D = s.stiffness() + at * s.N - at**2 * s.M + 1j * at * (s.viscous() + at * s.G)
        steady = row @ np.linalg.solve(D, at**2 * (load.p_cos - 1j * load.p_sin))
        errors.append(abs(fit[0] - 1j * fit[1] - steady) / abs(steady))
        assert speed[kept].min() < centre < speed[kept].max()
    assert errors[1] < 1e-3
    assert errors[0] / errors[1] == pytest.approx(2.0, abs=0.3)


# ---------------------------------------------------------------- a disc that tilts: strongly gyroscopic

BALLS = BallBearing(
    8,
    11.5e-3,
    43.5e-3,
    0.52,
    0.53,
    clearance=10e-6,
    damping=30.0,
    waviness=[Waviness("inner", 3, 1e-6), Waviness("ball", 2, 0.5e-6)],
    defects=[Pit("outer", 0.3, 1e-3, 3e-6)],
)


def overhung(bearing: BallBearing | None = None) -> core.Model:
    """x, y, θx, θy of a disc with Ip = 1.6 It beside its springs; unbalance, weight, turning damping."""
    M, K = np.diag([5.0, 5.0, 0.05, 0.05]), np.diag([5e6, 5e6, 5e4, 5e4])
    C, G, N = np.diag([50.0, 50.0, 0.5, 0.5]), np.zeros((4, 4)), np.zeros((4, 4))
    K[0, 3] = K[3, 0] = 1e5
    K[1, 2] = K[2, 1] = -1e5
    G[2, 3], G[3, 2] = 0.08, -0.08
    N[0, 1], N[1, 0] = 20.0, -20.0
    p = np.zeros((2, 4))
    p[0, 0] = p[1, 1] = 1e-3
    p[0, 3], p[1, 2] = 1e-5, -1e-5
    weight = np.array([0.0, -300.0, 0.0, 0.0])
    loads = [(2, 0.0, p[0], p[1], NO_TABLE, NO_TABLE), (0, 0.0, weight, 0 * weight, NO_TABLE, NO_TABLE)]
    bearings = []
    if bearing is not None:
        B = np.zeros((5, 4))
        B[0, 0] = B[1, 1] = 1.0
        B[3, 3], B[4, 2] = -0.02, 0.02
        bearings = [(bearing.kernel().packed(), B)]
    return core.Model(M, C, G, K, N, [], bearings, loads, [(0, row, 0, 0) for row in np.eye(4)])


def marched(
    model: core.Model, scheme: core.Stepping, end: float
) -> tuple[np.ndarray, np.ndarray, core.Report]:
    state = model.state(0.0, np.zeros(4), np.zeros(4))
    record, state, report = core.march(model, state, scheme, round(end / scheme.dt), start=True)
    assert report.status == 0, report.text
    return record, state, report


END = 0.05
SCREAM = ([0.0, END], [0.0, 20e3])
"""rad/s: so fast a rise that the gyroscopic terms leave the factorised speed behind"""


def test_a_gyroscopic_rotor_is_factored_anew_and_agrees_with_a_finer_march() -> None:
    fine, _, report = marched(overhung(), stepping(2.5e-7, speed=SCREAM), END)
    assert report.refactors == 0
    errors = []
    for dt in (2e-5, 1e-5):
        record, _, report = marched(overhung(), stepping(dt, speed=SCREAM), END)
        # the sweeps contract by Ip/It·(Ω − Ω_ref)·Δt/2: a tenth every 6,000 rad/s at 2e-5 s, 12,500 at 1e-5
        assert report.refactors == (3 if dt == 2e-5 else 1)
        every = round(dt / 2.5e-7)
        # tilts whirl at up to Ip/It·Ω = 32,000 rad/s, faster than these steps follow; translations do not
        same = fine[every - 1 :: every, :2]
        errors.append(np.abs(record[:, :2] - same).max(axis=0) / np.abs(same).max(axis=0))
    assert (errors[1] < 2e-3).all()
    # of second order
    np.testing.assert_allclose(errors[0] / errors[1], 4.0, atol=0.5)


def test_factoring_anew_changes_nothing() -> None:
    """The same march from a model that is factored at every step, by marching one step per call from anew."""
    model, scheme = overhung(BALLS), stepping(2e-5, speed=SCREAM, tolerance=1e-12)
    whole, _, report = marched(model, scheme, 0.02)
    assert report.refactors > 0
    state, rows = model.state(0.0, np.zeros(4), np.zeros(4)), []
    for k in range(1000):
        if k > 0:
            state = np.array(state)
            state[5] = 0.0  # forgets the speed it is factored at
        row, state, one = core.march(model, state, scheme, 1, start=k == 0)
        assert one.refactors == 0
        rows.append(row[0])
    # drift is iterated to 1e-12·1e-3 of itself, Newton to 1e-12 of the forces; 1000 steps of magnification
    np.testing.assert_allclose(whole, rows, rtol=0, atol=1e-8 * np.abs(whole).max())


@pytest.mark.parametrize("bearing", [None, BALLS], ids=["structure", "bearing"])
def test_a_resumed_run_up_is_the_uninterrupted_one_bit_for_bit(bearing: BallBearing | None) -> None:
    model, scheme = overhung(bearing), stepping(2e-5, speed=SCREAM, audit=True)
    whole, end, report = marched(model, scheme, 0.04)
    assert report.refactors > 1
    for cut in (1, 400, 1234):
        state = model.state(0.0, np.zeros(4), np.zeros(4))
        first, state, before = core.march(model, state, scheme, cut, start=True)
        second, state, after = core.march(model, state, scheme, 2000 - cut)
        np.testing.assert_array_equal(np.vstack([first, second]), whole)
        np.testing.assert_array_equal(state, end)
        assert before.refactors + after.refactors == report.refactors


def test_every_instruction_set_gives_the_same_bits_in_a_run_up() -> None:
    model, scheme = overhung(BALLS), stepping(2e-5, speed=SCREAM, isa="base")
    base, state, report = marched(model, scheme, 0.04)
    assert report.refactors > 1
    tried = 0
    for name in ("avx2", "avx512", "best"):
        try:
            record, other, _ = marched(model, dataclasses.replace(scheme, scheme=core.Scheme(isa=name)), 0.04)
        except ValueError:
            continue  # not on this machine
        tried += 1
        np.testing.assert_array_equal(record, base)
        np.testing.assert_array_equal(other, state)
    assert tried > 0


# knots on and between steps of 1e-4 s, within one step or many
JUMPS = {
    "within a step": ([0.0, 0.01002, 0.01008], [0.0, 0.0, 4000.0]),
    "over one step": ([0.0, 0.01, 0.0101], [0.0, 0.0, 4000.0]),
    "and back": ([0.0, 0.01003, 0.01012, 0.01602, 0.01605], [4000.0, 4000.0, -4000.0, -4000.0, 4000.0]),
}


@pytest.mark.parametrize("bearing", [None, BALLS], ids=["structure", "bearing"])
@pytest.mark.parametrize("jump", JUMPS.values(), ids=JUMPS.keys())
def test_a_speed_that_jumps_is_marched_through(jump: Any, bearing: BallBearing | None) -> None:
    """New factors are those of the step to come: a jump does not ask for them again and again."""
    _, _, report = marched(overhung(bearing), stepping(1e-4, speed=jump), 0.02)
    assert report.steps == 200
    assert 0 < report.refactors < 60


def test_many_refactorings_in_a_few_steps_come_to_an_end() -> None:
    """A hundred marches cut short by new factors, while the call grows the number of steps it asks for."""
    times = np.arange(0.0, 0.0301, 1e-4) + 5e-5
    speeds = np.where(np.arange(len(times)) % 2, 4000.0, -4000.0)
    _, _, report = marched(overhung(), stepping(1e-4, speed=(times, speeds)), 0.03)
    assert report.refactors > 100


@pytest.mark.parametrize("bearing", [None, BALLS], ids=["structure", "bearing"])
def test_a_profile_that_stays_is_a_constant_speed(bearing: BallBearing | None) -> None:
    model = overhung(bearing)
    constant, _, _ = marched(model, stepping(1e-5, speed=700.0), 0.01)
    profile, _, report = marched(model, stepping(1e-5, speed=([0.0, 1.0], [700.0, 700.0])), 0.01)
    assert report.refactors == 0
    # Newton's tolerance of 1e-9, in another order of corrections
    np.testing.assert_allclose(profile, constant, rtol=0, atol=1e-7 * np.abs(constant).max())


@pytest.mark.parametrize("pitted", [False, True])
def test_energy_audit_closes_in_a_run_up_with_an_imperfect_bearing(pitted: bool) -> None:
    """Work of loads and turning = stored + dissipated while the speed, waves and a pit drive the motion."""
    speed, end = ([0.0, 0.02], [300.0, 900.0]), 0.02
    # a thick film keeps every ball loaded
    bearing = BallBearing(
        8,
        11.5e-3,
        43.5e-3,
        0.52,
        0.53,
        clearance=0.0,
        film=5e-6,
        damping=30.0,
        waviness=BALLS.waviness,
        defects=[Pit("outer", 0.3, 2e-3, 1e-6)] if pitted else [],
    )
    model, residuals = overhung(bearing), []
    for dt in (4e-6, 2e-6):
        scheme = stepping(dt, speed=speed, audit=True, tolerance=1e-11)
        state = model.state(0.0, np.zeros(4), np.zeros(4))
        _, state, _ = core.march(model, state, scheme, 0, start=True)
        before = core.energies(model, state)
        _, state, report = core.march(model, state, scheme, round(end / dt))
        assert report.status == 0
        after = core.energies(model, state)
        change = sum(after[k] - before[k] for k in ("kinetic", "elastic", "stored", "indentation"))
        work = after["load"] + after["turning"] - after["linear"] - after["branch"] - after["contact"]
        residuals.append(abs(work - change) / after["throughput"])
        # what the waves and the cage feed in shows in the balance
        assert abs(after["turning"]) > 5 * residuals[-1] * after["throughput"]
    if pitted:
        # 6 m/s over an edge of 0.1 mm with a corner at each end: the power, 100 N·0.1 m/s, jumps within a
        # step some forty times, 5e-6 J each, of 0.05 J
        assert max(residuals) < 4e-3
    else:
        assert residuals[1] < 1e-6
        assert residuals[0] / residuals[1] == pytest.approx(4.0, abs=0.2)
