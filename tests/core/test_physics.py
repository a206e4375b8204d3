"""Physics of the march: its own transfer function, its branch modulus, its energy, its order in Δt."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest

from bearingdyn import core
from bearingdyn.bearing import BallBearing
from core_models import stepping
from twins.march_twin import System
from twins.maxwell_twin import branch_weights

NO_TABLE = np.zeros(0)

# ---------------------------------------------------------------- steady state under a sine


def transfer(
    system: System, z: complex, dt: float, beta: float, gamma: float, speed: float, p: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Complex X, V, A (n,) of Newmark's scheme under p zᵏ at step k, z = e^{iωΔt}.

    With x_k = X zᵏ and so on, the two formulas of the scheme become
        (z − 1) V = Δt [(1−γ) + γz] A,   (z − 1) X = Δt V + Δt² [(½−β) + βz] A,
    and the recursion of a branch S z = E S + 2Gτ (old + now z) Ẏ gives S = 2Gτ (old + now z)/(z − E) LᵀV.
    """
    to_v = dt * ((1 - gamma) + gamma * z) / (z - 1)
    to_x = (dt * to_v + dt**2 * ((0.5 - beta) + beta * z)) / (z - 1)
    D = system.M + to_v * (system.C + speed * system.G) + to_x * (system.K + speed * system.N)
    for L, modulus, tau in system.layers:
        E, old, now = branch_weights(dt / tau)
        D = D + to_v * (2 * modulus * tau * (old + now * z) / (z - E)).sum() * L @ L.T
    A = np.linalg.solve(D, p)
    return to_x * A, to_v * A, A


@pytest.mark.parametrize(("beta", "gamma"), [(0.25, 0.5), (1 / 6, 0.5), (0.3, 0.6)])
@pytest.mark.parametrize("periods_per_step", [1 / 12, 1 / 50, 1 / 400])
def test_steady_state_is_the_transfer_function_of_the_scheme(
    periods_per_step: float, beta: float, gamma: float
) -> None:
    rng = np.random.default_rng(3)
    n, dt, speed = 8, 5e-6, 500.0
    # stable for the linear-acceleration scheme too: ωΔt < 3.46
    w = 2 * np.pi * np.geomspace(500.0, 3e4, n)
    Q, _ = np.linalg.qr(rng.standard_normal((n, n)))
    skew = rng.standard_normal((n, n))
    skew -= skew.T
    A = 0.02 * rng.standard_normal((n, n))
    K, C = Q.T * w**2 @ Q, Q.T * (0.3 * w) @ Q
    system = System(np.eye(n) + A @ A.T, C, 0.5 * skew, K, 20.0 * skew)
    L = 3.0 * rng.standard_normal((n, 3))
    system.layers = [(L, np.array([1e5, 1e6, 4e6]), np.array([3e-4, 4e-5, 1e-6]))]
    omega = 2 * np.pi * periods_per_step / dt
    p = rng.standard_normal((2, n))
    rows = [(kind, row, 0, 0) for kind in (0, 1, 2) for row in np.eye(n)]
    loads = [(1, omega, p[0], p[1], NO_TABLE, NO_TABLE)]
    model = core.Model(system.M, C, system.G, K, system.N, system.layers, [], loads, rows)
    scheme = stepping(dt=dt, beta=beta, gamma=gamma, speed=speed)

    # the slowest transient, 500 Hz at 15 % of critical damping, dies like e^{−470 t}: 5e-17 of it after 80 ms
    settle, period = 16000, round(1 / periods_per_step)
    state = model.state(0.0, np.zeros(n), np.zeros(n))
    _, state, _ = core.march(model, state, scheme, settle, settle, start=True)
    record, _, report = core.march(model, state, scheme, period)
    assert report.status == 0

    # p_cos cos ωt + p_sin sin ωt = Re (p_cos − i p_sin) e^{iωt}
    z = np.exp(1j * omega * dt)
    k = settle + 1 + np.arange(period)
    amplitude = 2 / period * (record * np.exp(-1j * omega * dt * k)[:, None]).sum(axis=0)
    X, V, A = transfer(system, z, dt, beta, gamma, speed, p[0] - 1j * p[1])
    for got, expected in zip(np.split(amplitude, 3), (X, V, A), strict=True):
        assert np.linalg.norm(got - expected) <= 1e-8 * np.linalg.norm(expected)


# ---------------------------------------------------------------- one branch


def march_modulus(x: float) -> complex:
    """S/(2G e) of a branch with Δt/τ = ωΔt = x, from a coordinate on one branch (L = 1) under a sine.

    The branch carries what mass, damping and spring leave of the load; all of them are recorded.
    """
    dt, tau = 1e-4, 1e-4 / x
    omega, G, one = x / dt, 50.0, np.ones((1, 1))
    loads = [(1, omega, np.array([1.0]), np.zeros(1), NO_TABLE, NO_TABLE)]
    channels = [(1, np.ones(1), 0, 0), (0, np.ones(1), 0, 0), (2, np.ones(1), 0, 0)]
    M, C, K = 1e-4 * one, 1e-2 * one, 100.0 * one
    layers = [(one, np.array([G]), np.array([tau]))]
    model = core.Model(M, C, 0 * one, K, 0 * one, layers, [], loads, channels)
    # a whole number of steps does not fill a period: fit the sine by least squares instead
    settle, kept = 60_000, 4000
    _, state, _ = core.march(
        model, model.state(0.0, np.zeros(1), np.zeros(1)), stepping(dt), settle, settle, start=True
    )
    record, _, _ = core.march(model, state, stepping(dt), kept)
    angle = omega * dt * (settle + 1 + np.arange(kept))
    fit, *_ = np.linalg.lstsq(np.column_stack([np.cos(angle), np.sin(angle)]), record, rcond=None)
    V, X, A = fit[0] - 1j * fit[1]
    return complex((1.0 - M[0, 0] * A - C[0, 0] * V - K[0, 0] * X) / (2 * G * X))


@pytest.mark.parametrize(("x", "figure"), [(0.1, 5.7e-7), (0.5, 3.7e-4)])
def test_discrete_branch_modulus(x: float, figure: float) -> None:
    """theory.md §1 gives the error against iωτ/(1 + iωτ), at ωτ = 1, to two digits."""
    error = abs(march_modulus(x) / (1j / (1 + 1j)) - 1)
    assert error == pytest.approx(figure, rel=0.02)


# ---------------------------------------------------------------- a motor in small, from real bearings

CENTRE, HOUSING = 5, 5


def rotor(loads: list[tuple[object, ...]], damping: float, extra: float = 0.0) -> tuple[core.Model, int]:
    """A rigid rotor (x, y, z, θx, θy) on two bearings in two housings on springs and layers; 15 coordinates.

    The left bearing pushes against the right one under an axial load, so that every ball carries.
    """
    bearing = BallBearing(
        Z=8, Dw=11.5e-3, Dpw=43.5e-3, fi=0.52, fo=0.53, contact_angle=0.3, damping=damping
    ).kernel()
    n, arm = CENTRE + 2 * HOUSING, 22e-3  # arm of the races' tilt, m
    M = np.diag([3.0, 3.0, 3.0, 0.01, 0.01] + 2 * [1.5, 1.5, 1.5, 2e-3, 2e-3])
    K, C, G, N = (np.zeros((n, n)) for _ in range(4))
    K[5:, 5:] = np.diag(2 * [8e6, 8e6, 8e6, 4e3, 4e3])
    C += np.diag([20.0, 20.0, 20.0, 0.02, 0.02] + 2 * [400.0, 400.0, 400.0, 0.2, 0.2])
    C += extra * M
    G[3, 4], G[4, 3] = 0.008, -0.008  # Ip
    # damping of 3 kN s/m that turns with the shaft: c ẋ in its frame is c (ẋ + Ω y, ẏ − Ω x) outside
    C[0, 0] += 3e3
    C[1, 1] += 3e3
    N[0, 1], N[1, 0] = 3e3, -3e3
    layers, bearings = [], []
    for b, place in enumerate((-0.1, 0.1)):
        L = np.zeros((n, 5))
        first = CENTRE + HOUSING * b
        L[first : first + 5] = np.diag([1.5, 1.5, 1.0, 0.03, 0.03])
        layers.append((L, np.array([1e6, 3e6]), np.array([1e-3, 5e-5])))
        # radial cos 1, sin 1; axial cos 0, cos 1, sin 1: X = z + R (θx sin ψ − θy cos ψ); facing each other
        B = np.zeros((5, n))
        side = 1.0 if b == 0 else -1.0
        for at, sign, lever in ((0, 1.0, place), (first, -1.0, 0.0)):
            B[0, at], B[0, at + 4] = sign, sign * lever
            B[1, at + 1], B[1, at + 3] = sign, -sign * lever
            B[2, at + 2] = side * sign
            B[3, at + 4] = -side * sign * arm
            B[4, at + 3] = side * sign * arm
        bearings.append((bearing.packed(), B))
    channels = [(0, row, 0, 0) for row in np.eye(n)] + [(5, None, 0, 0), (5, None, 1, 0)]
    return core.Model(M, C, G, K, N, layers, bearings, loads, channels), n


def preload(n: int) -> tuple[object, ...]:
    """The housings pushed towards each other: 1 kN of axial load in each bearing."""
    p = np.zeros(n)
    p[CENTRE + 2], p[CENTRE + HOUSING + 2] = -1e3, 1e3
    p[1] = -400.0
    return (0, 0.0, p, np.zeros(n), NO_TABLE, NO_TABLE)


def settled(damping: float) -> np.ndarray:
    """Displacement at which the preloaded rotor rests, by a heavily damped march."""
    model, n = rotor([preload(15)], damping, extra=3e3)
    scheme = stepping(dt=2e-5)
    state = model.state(0.0, np.zeros(n), np.zeros(n))
    _, state, report = core.march(model, state, scheme, 20_000, 20_000, start=True)
    assert report.status == 0, report.text
    return model.unpack(state)[1]


def shaken(n: int) -> list[tuple[object, ...]]:
    """Preload, a force of 400 Hz that rises from zero, an unbalance, a sampled push."""
    unbalance, force, push = np.zeros((2, n)), np.zeros((2, n)), np.zeros(n)
    unbalance[0, 0] = unbalance[1, 1] = 2e-3  # kg m
    force[1, :3] = 60.0, 80.0, 40.0
    push[2] = 1.0
    time = np.arange(9) * 5e-4
    value = 50.0 * np.sin(2 * np.pi * 100.0 * time)
    return [
        preload(n),
        (1, 2 * np.pi * 400.0, force[0], force[1], NO_TABLE, NO_TABLE),
        (2, 0.0, unbalance[0], unbalance[1], NO_TABLE, NO_TABLE),
        (3, 0.0, push, np.zeros(n), time, value),
    ]


SPEED = 523.6


def audit(dt: float, steps: int, damping: float, x: np.ndarray) -> tuple[float, dict[str, float], np.ndarray]:
    """|imbalance|/throughput, the energies, and the record of a shaken march of steps·dt."""
    model, n = rotor(shaken(15), damping)
    scheme = stepping(dt=dt, speed=SPEED, audit=True, tolerance=1e-11)
    _, state, _ = core.march(model, model.state(0.0, x, np.zeros(n)), scheme, 0, start=True)
    before = core.energies(model, state)
    record, state, report = core.march(model, state, scheme, steps)
    assert report.status == 0, report.text
    after = core.energies(model, state)
    change = sum(after[k] - before[k] for k in ("kinetic", "elastic", "stored", "indentation"))
    work = after["load"] + after["turning"] - after["linear"] - after["branch"] - after["contact"]
    return abs(work - change) / after["throughput"], after, record


def test_energy_audit_closes_on_a_turning_nonlinear_motor() -> None:
    """Work of the loads and of the turning = stored + dissipated, each written from its own physics.

    The rotor of 3 kg under the loads of `shaken`, all balls loaded, layers, turning damping. Powers are
    integrated by the trapezoidal rule and the scheme is of second order: the residual falls as Δt².
    """
    x = settled(30.0)
    residual, energy, _ = audit(2.5e-6, 4000, 30.0, x)
    assert residual <= 1e-4
    # a wrong work could not hide: each is worth more than 100 residuals
    for kind in ("load", "turning", "linear", "branch", "contact"):
        assert abs(energy[kind]) > 100 * residual * energy["throughput"], kind
    coarse, _, _ = audit(1e-5, 1000, 30.0, x)
    assert np.log2(coarse / residual) / 2 == pytest.approx(2.0, abs=0.2)


def test_energy_audit_closes_where_contact_is_lost() -> None:
    """Balls of a bearing with clearance come and go: 1e-4 still holds at the demo's step."""
    rng = np.random.default_rng(5)
    n = 6
    w = 2 * np.pi * np.geomspace(40.0, 5e3, n)
    bearing = BallBearing(Z=8, Dw=11.5e-3, Dpw=43.5e-3, fi=0.52, fo=0.53, clearance=10e-6, damping=30.0)
    B = 0.8 * rng.standard_normal((5, n))
    p = 300.0 * rng.standard_normal((2, n))
    loads = [
        (0, 0.0, p[0], p[1], NO_TABLE, NO_TABLE),
        (1, 2 * np.pi * 300.0, p[1], p[0], NO_TABLE, NO_TABLE),
    ]
    channels = [(5, None, 0, 0)]
    zero = np.zeros((n, n))
    kernel = bearing.kernel().packed()
    model = core.Model(
        np.eye(n), np.diag(0.04 * w), zero, np.diag(w**2), zero, [], [(kernel, B)], loads, channels
    )
    scheme = stepping(dt=2.5e-6, speed=SPEED, audit=True, tolerance=1e-11)
    _, state, _ = core.march(model, model.state(0.0, np.zeros(n), np.zeros(n)), scheme, 0, start=True)
    before = core.energies(model, state)
    record, state, report = core.march(model, state, scheme, 8000)
    after = core.energies(model, state)
    assert report.status == 0
    assert np.unique(record).size > 2  # balls come and go
    change = sum(after[k] - before[k] for k in ("kinetic", "elastic", "stored", "indentation"))
    work = after["load"] + after["turning"] - after["linear"] - after["branch"] - after["contact"]
    assert abs(work - change) <= 1e-4 * after["throughput"]


def test_order_is_two_while_no_contact_is_lost() -> None:
    model, n = rotor(shaken(15), 30.0)
    x = settled(30.0)
    ends = []
    for steps in (500, 1000, 2000, 4000):
        scheme = stepping(dt=2e-3 / steps, speed=SPEED, tolerance=1e-12)
        record, _, report = core.march(model, model.state(0.0, x, np.zeros(n)), scheme, steps, start=True)
        assert report.status == 0
        assert (record[:, n:] == 8).all()  # every ball of both bearings
        ends.append(record[-1, :n])
    changes = [np.linalg.norm(b - a) for a, b in pairwise(ends)]
    for coarse, fine in pairwise(changes):
        assert np.log2(coarse / fine) >= 1.9
