"""Raceways of any order: the force is the gradient of the balls' energy, the tangent its derivative."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest

from bearingdyn import core
from bearingdyn.bearing import BallBearing, BearingKernel
from core_models import stepping

SIZE = dict(Z=11, Dw=11.5e-3, Dpw=60e-3, fi=0.52, fo=0.53)
BEARINGS = {
    "clearance": BallBearing(**SIZE, clearance=6e-6, film=0.3e-6),
    "contact angle": BallBearing(**SIZE, contact_angle=0.35),
}
HIGHEST = 8


def columns(highest: int) -> list[tuple[int, int, int]]:
    """(axial, order, sine): radial and axial, orders 0 … highest, cosine and sine."""
    radial = [(0, n, sine) for n in range(highest + 1) for sine in (0, 1) if n > 0 or sine == 0]
    return radial + [(1, n, sine) for _, n, sine in radial]


def flexible(name: str, orders: list[tuple[int, int, int]]) -> BearingKernel:
    axial, order, sine = (np.array(column, np.intc) for column in zip(*orders, strict=True))
    return dataclasses.replace(BEARINGS[name].kernel(), axial=axial, order=order, sine=sine)


def energy(spec: BearingKernel, z: np.ndarray, angle: float) -> np.longdouble:
    """Σ (2/5) κ s^{5/2}, s = Λ − A + film, in long double."""
    psi = angle + 2 * np.longdouble(np.pi) * np.arange(spec.Z)[:, None] / spec.Z
    wave = spec.order * psi
    shape = np.where(spec.sine, np.sin(wave), np.cos(wave)) * z.astype(np.longdouble)
    axial = np.asarray(spec.axial, bool)
    distance = np.hypot(spec.x0 + shape[:, axial].sum(axis=1), spec.y0 + shape[:, ~axial].sum(axis=1))
    s = np.maximum(distance - spec.A + spec.h0, 0)
    return np.longdouble(0.4) * spec.kappa * (s**2.5).sum()


def deformed(spec: BearingKernel, seed: int) -> np.ndarray:
    """Coefficients of some 10 µm that press the rings together, falling with the order; balls come and go."""
    rng = np.random.default_rng(seed)
    z = 12e-6 * rng.standard_normal(len(spec.order)) / (1.0 + spec.order)
    z[(spec.axial == 0) & (spec.order == 0)] += 8e-6
    return z


@pytest.mark.parametrize("name", BEARINGS)
@pytest.mark.parametrize("seed", range(5))
def test_force_is_the_gradient_of_the_energy_of_the_balls(name: str, seed: int) -> None:
    spec = flexible(name, columns(HIGHEST))
    z, angle, h = deformed(spec, seed), 0.3 + seed, 1e-9
    g, _, _, loads = core.bearing_force(spec, z, 0 * z, angle, 0.0)
    assert 3 <= np.count_nonzero(loads) <= spec.Z
    for k, unit in enumerate(np.eye(len(z))):
        slope = (energy(spec, z + h * unit, angle) - energy(spec, z - h * unit, angle)) / (2 * h)
        # truncation (h/s)²·5/32 with s of 1 µm and more, 1e-7 of a load where a ball just touches
        assert float(slope) == pytest.approx(g[k], abs=1e-6 * loads.max())
    # every order carries
    for n in range(HIGHEST + 1):
        for axial in (0, 1):
            assert np.abs(g[(spec.order == n) & (spec.axial == axial)]).max() > 1e-3 * loads.max()


@pytest.mark.parametrize("name", BEARINGS)
@pytest.mark.parametrize("cage_speed", [0.0, 150.0])
@pytest.mark.parametrize("damping", [0.0, 30.0])
def test_tangents_are_the_derivatives_of_the_force(name: str, cage_speed: float, damping: float) -> None:
    spec = dataclasses.replace(flexible(name, columns(HIGHEST)), damping_c=damping)
    z, angle, h, hdot = deformed(spec, 3), 0.7, 1e-10, 1e-5
    zdot = 1e-3 * np.random.default_rng(4).standard_normal(len(z))
    _, K, C, loads = core.bearing_force(spec, z, zdot, angle, cage_speed)
    assert (loads[loads > 0] > 1.0).all()  # no ball so near its edge that a difference straddles it
    for k, unit in enumerate(np.eye(len(z))):
        up, down = (core.bearing_force(spec, z + s * h * unit, zdot, angle, cage_speed)[0] for s in (1, -1))
        # truncation (h/s)²/24 ≈ 1e-9; round-off 1e-16·1 kN/1e-10 m = 1e-3 N/m of 1e8
        np.testing.assert_allclose((up - down) / (2 * h), K[:, k], rtol=0, atol=1e-7 * np.abs(K).max())
        up, down = (
            core.bearing_force(spec, z, zdot + s * hdot * unit, angle, cage_speed)[0] for s in (1, -1)
        )
        # linear in the rate; round-off 1e-16·1 kN/1e-5 m/s = 1e-8 of 1e2
        bound = 1e-9 * np.abs(C).max() + 1e-15 * loads.max() / hdot
        np.testing.assert_allclose((up - down) / (2 * hdot), C[:, k], rtol=0, atol=bound)
    if damping == 0.0:
        np.testing.assert_allclose(K, K.T, rtol=0, atol=1e-14 * np.abs(K).max())  # conservative


@pytest.mark.parametrize("name", BEARINGS)
@pytest.mark.parametrize("highest", [2, 3, 5, HIGHEST])
def test_a_flexible_ring_that_stays_round_is_the_rigid_ring_bit_for_bit(name: str, highest: int) -> None:
    rigid = [(0, 1, 0), (0, 1, 1), (1, 0, 0), (1, 1, 0), (1, 1, 1)]
    orders = [c for c in columns(highest) if c != (0, 0, 0)]
    spec, plain = flexible(name, orders), BEARINGS[name].kernel()
    place = [orders.index(c) for c in rigid]
    rng = np.random.default_rng(highest)
    for _ in range(20):
        z = np.array([1.0, 1.0, 1.0, 0.5, 0.5]) * 15e-6 * rng.standard_normal(5)
        zdot, turn = 1e-2 * rng.standard_normal(5), (rng.uniform(-5, 5), rng.uniform(-200, 200))
        many, many_rate = np.zeros(len(orders)), np.zeros(len(orders))
        many[place], many_rate[place] = z, zdot
        g, K, C, loads = core.bearing_force(spec, many, many_rate, *turn)
        expected = core.bearing_force(plain, z, zdot, *turn)
        square = np.ix_(place, place)
        for got, one in zip((g[place], K[square], C[square], loads), expected, strict=True):
            np.testing.assert_array_equal(got, one)


def test_order_of_the_number_of_balls_is_seen_by_all_balls_alike() -> None:
    """cos Zψ is the same at every ball: a ring of Z lobes presses like one that breathes by cos Zψ."""
    orders = [(0, 0, 0), (0, 11, 0), (0, 11, 1), (1, 0, 0)]
    spec, angle = flexible("contact angle", orders), 0.123
    lobed = core.bearing_force(spec, np.array([0.0, 9e-6, 4e-6, 10e-6]), np.zeros(4), angle, 0.0)[3]
    swell = 9e-6 * np.cos(11 * angle) + 4e-6 * np.sin(11 * angle)
    round_ = core.bearing_force(spec, np.array([swell, 0.0, 0.0, 10e-6]), np.zeros(4), angle, 0.0)[3]
    np.testing.assert_allclose(lobed, round_, rtol=1e-12)  # cos of 11·8 rad: some 1e-14
    assert np.ptp(lobed) < 1e-12 * lobed.max()


def lobed_model(orders: list[tuple[int, int, int]]) -> core.Model:
    """A ring whose lobes are coordinates with springs, pressed by a load, against a turning cage."""
    spec = flexible("clearance", orders)
    n = len(orders)
    M, K = np.eye(n), np.diag((2 * np.pi * np.geomspace(200.0, 4e3, n)) ** 2)
    C, zero = np.diag(0.05 * np.sqrt(np.diag(K))), np.zeros((n, n))
    p = np.zeros(n)
    p[:3] = 300.0
    load = (0, 0.0, p, 0 * p, np.zeros(0), np.zeros(0))
    channels = [(0, row, 0, 0) for row in np.eye(n)] + [(3, None, 0, k) for k in range(n)]
    return core.Model(M, C, zero, K, zero, [], [(spec.packed(), np.eye(n))], [load], channels)


def test_march_of_a_ring_of_eight_orders_balances_at_every_step() -> None:
    """M a + C v + K x + g(x, v, t) = f with g evaluated anew at the state the march ends in."""
    orders = columns(HIGHEST)
    n, dt, speed = len(orders), 5e-6, 400.0
    model, spec = lobed_model(orders), flexible("clearance", orders)
    state = model.state(0.0, np.zeros(n), np.zeros(n))
    for steps in (1, 7, 400, 1000):
        record, state, report = core.march(
            model, state, stepping(dt, speed=speed, tolerance=1e-11), steps, start=steps == 1
        )
        assert report.status == 0, report.text
        t, x, v, a = model.unpack(state)[:4]
        cage = spec.cage_ratio * speed
        g = core.bearing_force(spec, x, v, spec.angle0 + cage * t, cage, speed * t, speed)[0]
        K = (2 * np.pi * np.geomspace(200.0, 4e3, n)) ** 2
        f = np.where(np.arange(n) < 3, 300.0, 0.0)
        residual = a + 0.05 * np.sqrt(K) * v + K * x + g - f
        # the tolerance of the forces, stiffened by S: 1e-11, and round-off of a hundred additions
        assert np.abs(residual).max() < 1e-8 * np.abs(np.concatenate([f, g])).max()
        np.testing.assert_allclose(record[-1, n:], g, rtol=0, atol=1e-9 * np.abs(g).max())
    assert np.abs(g[spec.order == HIGHEST]).max() > 1e-3 * np.abs(g).max()
