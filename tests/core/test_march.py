"""The C march and harmonic response against their NumPy twins."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest

from bearingdyn import core
from bearingdyn.bearing import BallBearing, BearingKernel, LoadDamping, TabulatedDamping
from bearingdyn.bearing.imperfections import Pit, Waviness
from core_models import stepping
from twins import march_twin as twin

SIZE = dict(Z=7, Dw=11.5e-3, Dpw=43.5e-3, fi=0.52, fo=0.53)
TABLE = TabulatedDamping([-1e-6, 3e-6, 2e-5], [0.0, 50.0, 20.0])


def constant() -> BearingKernel:
    return BallBearing(**SIZE, clearance=5e-6, damping=30.0).kernel()


def table() -> BearingKernel:
    return BallBearing(**SIZE, clearance=0.0, film=0.3e-6, damping=TABLE).kernel()


def load() -> BearingKernel:
    return BallBearing(**SIZE, contact_angle=0.35, film=0.2e-6, damping=LoadDamping(1e-5)).kernel()


def flexible() -> BearingKernel:
    """Races with orders up to 3."""
    orders = [
        (0, 0, 0),
        (0, 1, 0),
        (0, 1, 1),
        (0, 2, 0),
        (0, 2, 1),
        (0, 3, 1),
        (1, 0, 0),
        (1, 1, 0),
        (1, 1, 1),
    ]
    axial, order, sine = (np.array(column, np.intc) for column in zip(*orders, strict=True))
    return dataclasses.replace(load(), axial=axial, order=order, sine=sine)


def flawed() -> BearingKernel:
    """Waves of every kind, a pit on every body, a large ball."""
    waves = [
        Waviness("inner", 8, 0.4e-6, 0.3),
        Waviness("inner", 7, 0.3e-6, 1.0, "axial"),
        Waviness("outer", 6, 0.3e-6, 2.0),
        Waviness("outer", 14, 0.2e-6, 0.0, "axial"),
        Waviness("ball", 2, 0.3e-6, 0.5),
        Waviness("ball", 4, 0.2e-6, 0.5, ball=3),
    ]
    pits = [
        Pit("inner", 0.1, 1.5e-3, 2e-6),
        Pit("outer", 0.5, 2e-3, 3e-6),
        Pit("ball", 0.2, 1e-3, 2e-6, ball=2),
    ]
    sizes = (0.0, 1e-6, 0.0, -0.5e-6, 0.0, 0.0, 0.3e-6)
    return BallBearing(
        **SIZE, clearance=5e-6, damping=LoadDamping(1e-5), waviness=waves, defects=pits, oversize=sizes
    ).kernel()


# sizes of the blocks; layers (block, rank, branches); bearings (kernel, inner block, outer block, −1: ground)
CASES = {
    "one block": ([5], [], []),
    "a layer": ([6], [(0, 2, 4)], []),
    "two layers on one block": ([9], [(0, 3, 2), (0, 1, 5)], [(load, 0, -1)]),
    "a bearing to ground": ([7], [], [(constant, 0, -1)]),
    "two blocks": ([6, 5], [(1, 3, 3)], [(table, 0, 1)]),
    "motor": ([7, 5, 6], [(1, 3, 5), (2, 12, 2)], [(load, 0, 1), (load, 0, 2)]),
    "motor, constant damping": ([4, 1, 3], [(2, 2, 1)], [(constant, 0, 1), (constant, 0, 2)]),
    "flexible rings": ([8, 9], [(1, 4, 3)], [(flexible, 0, 1)]),
    "an imperfect bearing": ([6, 4], [(1, 2, 2)], [(flawed, 0, 1)]),
    "a layer without branches": ([3, 2], [(0, 1, 0), (1, 1, 2)], [(load, 0, 1)]),
}


def c_model(system: twin.System) -> core.Model:
    return core.Model(
        system.M,
        system.C,
        system.G,
        system.K,
        system.N,
        system.layers,
        [(spec.packed(), B) for spec, B in system.bearings],
        [(core.LOAD_KINDS[kind], *rest) for kind, *rest in system.loads],
        [(core.CHANNEL_KINDS[kind], *rest) for kind, *rest in system.channels],
    )


def make(name: str, seed: int) -> tuple[twin.System, core.Model, np.random.Generator]:
    sizes, layers, bearings = CASES[name]
    rng = np.random.default_rng(seed)
    system = twin.random_system(rng, sizes, layers, bearings)
    model = c_model(system)
    assert model.blocks == len(sizes)
    return system, model, rng


def assert_same(got: np.ndarray, expected: np.ndarray) -> None:
    """Column by column against the column's largest value.

    Newton ends at 1e-11 of the largest bearing force in the C, at round-off in the twin. A hundred steps add
    that up, and the factorised structure (condition up to 1e4) and the contacts (stiffness times displacement
    over force: some 1e2) magnify round-off. 1e-9 leaves a decade or two; a wrong term shows above 1e-3.
    """
    assert got.shape == expected.shape
    scale = np.abs(expected).max(axis=0)
    worst = (np.abs(got - expected).max(axis=0) / np.where(scale > 0, scale, 1.0)).max(initial=0.0)
    assert worst < 1e-9


# rad/s; a constant one, and one that rises and falls by some 1e7 rad/s², its knots between two steps
SPEEDS = {
    "constant": 800.0,
    "varying": ([4.05e-5, 1.511e-4, 2.213e-4, 3.201e-4], [600.0, 1900.0, -300.0, 500.0]),
}


@pytest.mark.parametrize("speed", SPEEDS.values(), ids=SPEEDS.keys())
@pytest.mark.parametrize(("beta", "gamma"), [(0.25, 0.5), (0.3, 0.6)])
@pytest.mark.parametrize("name", CASES)
def test_march_is_the_twins(name: str, beta: float, gamma: float, speed: twin.Speed) -> None:
    system, model, rng = make(name, seed=len(name))
    n = len(system.M)
    t, dt = 3e-5, 4e-6
    x, v = 2e-6 * rng.standard_normal(n), 1e-2 * rng.standard_normal(n)
    scheme = stepping(dt=dt, beta=beta, gamma=gamma, speed=speed, tolerance=1e-11)
    record, state, report = core.march(model, model.state(t, x, v), scheme, 80, 3, start=True)
    assert report.status == 0, report.text
    expected, s = twin.march(
        system, twin.start(system, speed, t, x, v, dt), dt, 80, 3, beta=beta, gamma=gamma, speed=speed
    )
    assert_same(record, expected)
    got = model.unpack(state)
    assert got[0] == pytest.approx(s.t, rel=1e-14)
    assert_same(np.array(got[1:4]).T, np.array([s.x, s.v, s.a]).T)

    # another step size starts another count; the branch stresses stay exact
    scheme = dataclasses.replace(scheme, dt=1.5 * dt)
    record, state, report = core.march(model, state, scheme, 20, 4)
    expected, s = twin.march(system, s, 1.5 * dt, 20, 4, beta=beta, gamma=gamma, speed=speed)
    assert_same(record, expected)
    assert_same(np.array(model.unpack(state)[1:4]).T, np.array([s.x, s.v, s.a]).T)


def test_the_cases_lose_and_regain_contact() -> None:
    """The comparison above sees loaded and unloaded balls."""
    counts = set()
    for name, (_, _, bearings) in CASES.items():
        if bearings:
            system, model, rng = make(name, seed=len(name))
            n = len(system.M)
            x, v = 2e-6 * rng.standard_normal(n), 1e-2 * rng.standard_normal(n)
            scheme = stepping(dt=4e-6, speed=800.0)
            record, *_ = core.march(model, model.state(3e-5, x, v), scheme, 80, start=True)
            counts |= set(record[:, [c[0] == "loaded" for c in system.channels]].ravel())
    assert {0, 1, 7} <= counts


@pytest.mark.parametrize(("steps", "decimate"), [(0, 1), (1, 5), (10, 1), (10, 3), (11, 11), (12, 100)])
def test_record_has_a_row_each_time_the_count_is_a_multiple(steps: int, decimate: int) -> None:
    _, model, _ = make("motor", seed=1)
    state = model.state(0.0, np.zeros(18), np.zeros(18))
    scheme = stepping(dt=2e-6, speed=300.0)
    record, state, report = core.march(model, state, scheme, steps, decimate, start=True)
    assert record.shape == (steps // decimate, 10)
    more, _, _ = core.march(model, state, scheme, 7, decimate)
    assert len(more) == (steps + 7) // decimate - steps // decimate
    assert report.steps == steps


@pytest.mark.parametrize("name", CASES)
def test_harmonic_is_the_twins(name: str) -> None:
    system, model, rng = make(name, seed=2)
    n, coefs = len(system.M), sum(len(B) for _, B in system.bearings)
    omega = np.concatenate([[0.0], 2 * np.pi * np.geomspace(5.0, 2e4, 23)])
    shape = (len(omega), len(system.layers))
    modulus = 10 ** rng.uniform(4, 6, shape) * (1 + 1j * rng.uniform(0, 1, shape))
    A = rng.standard_normal((coefs, coefs))
    Kb, Cb = 1e7 * (A @ A.T + np.eye(coefs)), 30.0 * np.eye(coefs)
    Kb[: coefs // 2, coefs // 2 :] *= 1.3  # the tangent of a turning, damped bearing is not symmetric
    forces, rows = rng.standard_normal((3, n)), rng.standard_normal((2, n))
    got = core.harmonic(model, omega, modulus, Kb, Cb, forces, rows, speed=500.0)
    expected = twin.harmonic(system, omega, modulus, Kb, Cb, forces, rows, 500.0)
    assert got.shape == (len(omega), 2, 3)
    scale = np.abs(expected).max(axis=(1, 2), keepdims=True)
    # blocks are held by their bearings' stiffness where they are joined: only their condition costs digits
    assert (np.abs(got - expected) / scale).max() < 1e-12


def test_harmonic_of_a_block_that_floats_is_the_twins() -> None:
    """A rotor held by its bearings alone: at low frequency it is next to singular by itself.

    Stiffnesses of 1e8 N/m against ω²M: joining the blocks alone would lose 11 digits at 1 mHz.
    """
    system, _, rng = make("motor", seed=2)
    floating = np.flatnonzero(system.bearings[0][1][0] * system.bearings[1][1][0])
    assert len(floating) == 7
    for matrix in (system.K, system.C, system.G, system.N):
        matrix[np.ix_(floating, floating)] = 0.0
    model = c_model(system)
    assert model.blocks == 3
    A = rng.standard_normal((10, 10))
    Kb, Cb = 1e8 * (A @ A.T + np.eye(10)), 30.0 * np.eye(10)
    forces, rows = rng.standard_normal((2, 18)), rng.standard_normal((2, 18))
    omega = 2 * np.pi * np.geomspace(1e-3, 1e3, 25)
    modulus = np.full((25, 2), 1e6 + 2e5j)
    got = core.harmonic(model, omega, modulus, Kb, Cb, forces, rows)
    expected = twin.harmonic(system, omega, modulus, Kb, Cb, forces, rows, 0.0)
    scale = np.abs(expected).max(axis=(1, 2), keepdims=True)
    # springs of the bearings' size hold it where blocks are joined; at resonance the twin, too, loses some
    assert (np.abs(got - expected) / scale).max() < 1e-11
