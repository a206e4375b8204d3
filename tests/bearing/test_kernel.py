"""The contact kernel: its NumPy twin by complex step, and the C against the twin."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from bearingdyn.bearing import BallBearing, BearingKernel, FilmDamping, LoadDamping, TabulatedDamping
from twins import bearing_twin

SIZE = dict(Z=7, Dw=11.5e-3, Dpw=43.5e-3, fi=0.52, fo=0.53)
TABLE = TabulatedDamping([-2e-6, 1e-6, 5e-6, 2e-5], [0.0, 40.0, 55.0, 20.0])
NODES = np.linspace(0, 1, 65)
FADING = FilmDamping(2e-6, 40 * NODES**3 * (1.4 - 0.5 * NODES))
KERNELS = {
    "clearance": BallBearing(**SIZE, clearance=15e-6, damping=30.0),
    "no clearance": BallBearing(**SIZE, clearance=0.0),
    "contact angle": BallBearing(**SIZE, contact_angle=0.4, film=0.4e-6, damping=LoadDamping(1e-5)),
    "table": BallBearing(**SIZE, clearance=8e-6, film=0.3e-6, damping=TABLE),
    "film": BallBearing(**SIZE, clearance=8e-6, film=0.3e-6, damping=FADING),
}


# What a flexible ring adds to Hertz at each ball by itself, m/N: a wall that stiffens, a ring that gives
GIVES = {
    "wall": ("clearance", -0.5e-9),
    "ring": ("contact angle", 2e-9),
    "table on a ring": ("table", 2e-9),
    "film on a ring": ("film", 2e-9),
}


def kernel(name: str) -> BearingKernel:
    if name in GIVES:
        base, give = GIVES[name]
        return dataclasses.replace(KERNELS[base].kernel(), give=give)
    if name != "flexible":
        return KERNELS[name].kernel()
    # raceway orders up to 3, as a flexible ring has them
    orders = [
        (0, 0, 0),
        (0, 1, 0),
        (0, 1, 1),
        (0, 2, 0),
        (0, 3, 1),
        (1, 0, 0),
        (1, 1, 0),
        (1, 1, 1),
        (1, 2, 1),
    ]
    axial, order, sine = (np.array(column, np.intc) for column in zip(*orders, strict=True))
    return dataclasses.replace(KERNELS["clearance"].kernel(), axial=axial, order=order, sine=sine)


@st.composite
def cases(draw):
    spec = kernel(draw(st.sampled_from([*KERNELS, *GIVES, "flexible"])))
    n = len(spec.order)
    numbers = st.lists(st.floats(-1, 1), min_size=n, max_size=n)
    scale = 10 ** draw(st.floats(-6, -4))  # m: from a light touch to far beyond the static rating
    z = scale * np.array(draw(numbers))
    zdot = 10 ** draw(st.floats(-3, 0)) * np.array(draw(numbers))  # m/s: up to speeds that tear balls off
    angle = draw(st.floats(-7, 7))
    cage_speed = draw(st.sampled_from([0.0, 200.0, -90.0]))
    return spec, z, zdot, angle, cage_speed


def motion(spec, z, zdot, angle, cage_speed):
    """s = δ + h0 and its rate for every ball, from the distance of the groove centres in long double."""
    psi = angle + 2 * np.pi * np.arange(spec.Z)[:, None] / spec.Z
    wave = spec.order * psi
    phi = np.where(spec.sine, np.sin(wave), np.cos(wave)).astype(np.longdouble)
    slope = spec.order * np.where(spec.sine, np.cos(wave), -np.sin(wave)).astype(np.longdouble)
    rate = phi * zdot + cage_speed * slope * z
    axial = np.asarray(spec.axial, bool)
    X = np.longdouble(spec.x0) + (phi * z)[:, axial].sum(axis=1)
    Y = np.longdouble(spec.y0) + (phi * z)[:, ~axial].sum(axis=1)
    distance = np.hypot(X, Y)
    s_rate = (X * rate[:, axial].sum(axis=1) + Y * rate[:, ~axial].sum(axis=1)) / distance
    return np.asarray(distance - spec.A + spec.h0, float), np.asarray(s_rate, float)


def compression(spec, z, angle):
    return motion(spec, z, 0 * z, angle, 0.0)[0]


def away_from_kinks(spec, z, zdot, angle, cage_speed):
    """No ball within a thousandth of touching, being pulled off, or a point of the damping table."""
    s, rate = motion(spec, z, zdot, angle, cage_speed)
    size = np.abs(z).max()
    assume(size > 0)
    assume(np.abs(s).min() > 1e-3 * size)
    if spec.damping_law == "table":
        corners = spec.damping_table[:, 0]
        assume(np.abs((s - spec.h0)[:, None] - corners).min() > 1e-3 * size)
    for s_j, rate_j in zip(s[s > 0], rate[s > 0], strict=True):
        elastic = spec.kappa * s_j**1.5
        viscous = bearing_twin.contact_damping(spec, s_j - spec.h0, s_j)[0] * rate_j
        assume(abs(elastic + viscous) > 1e-3 * (elastic + abs(viscous)))


@settings(deadline=None, max_examples=60)
@given(cases())
def test_tangent_of_the_twin_is_the_derivative_of_its_force_by_complex_step(case):
    spec, z, zdot, angle, cage_speed = case
    away_from_kinks(*case)
    _, K, C, _ = bearing_twin.bearing_force(*case)
    h = 1e-30
    for k in range(len(z)):
        step = 1j * h * (np.arange(len(z)) == k)
        by_z = bearing_twin.bearing_force(spec, z + step, zdot, angle, cage_speed)[0].imag / h
        by_zdot = bearing_twin.bearing_force(spec, z, zdot + step, angle, cage_speed)[0].imag / h
        # complex steps have no truncation: round-off of sums over balls
        np.testing.assert_allclose(K[:, k], by_z, rtol=0, atol=1e-12 * np.abs(K).max(initial=1e-300))
        np.testing.assert_allclose(C[:, k], by_zdot, rtol=0, atol=1e-12 * np.abs(C).max(initial=1e-300))


@settings(deadline=None, max_examples=60)
@given(cases())
def test_indentation_of_the_twin_is_the_distance_of_the_groove_centres(case):
    spec, z, _, angle, _ = case
    loads = bearing_twin.bearing_force(spec, z, 0 * z, angle, 0.0)[3]
    s = np.maximum(compression(spec, z, angle), 0)
    # x0 and y0 are rounded, 1e-16·A, which the distance shows and the kernel's form does not
    compressed = (loads / spec.kappa) ** (2 / 3) + spec.give * loads
    np.testing.assert_allclose(compressed, s, rtol=1e-13, atol=4e-16 * spec.A)


@settings(deadline=None, max_examples=60)
@given(cases())
def test_no_ball_pulls(case):
    assert bearing_twin.bearing_force(*case)[3].min() >= 0


def test_damping_power_is_what_the_moving_balls_cost():
    # F δ̇ summed over balls = g·ż + ω_c Σ F ∂δ/∂ψ: the second term by central difference in the cage angle
    spec = KERNELS["clearance"].kernel()
    z, zdot = np.array([3e-6, 25e-6, 1e-6, 2e-6, -1e-6]), np.array([1e-3, 2e-3, -1e-3, 5e-4, 0.0])
    angle, cage, h = 0.3, 150.0, 1e-6
    g, _, _, loads = bearing_twin.bearing_force(spec, z, zdot, angle, cage)
    s, rate = motion(spec, z, zdot, angle, cage)
    turning = (compression(spec, z, angle + h) - compression(spec, z, angle - h)) / (2 * h)
    # differences over 1e-6 rad of distances of 5e-4 m: truncation and round-off stay below 1e-6
    assert loads @ rate == pytest.approx(g @ zdot + cage * loads @ turning, rel=1e-6)
    expected = np.where(s > 0, np.maximum(spec.kappa * np.maximum(s, 0) ** 1.5 + 30.0 * rate, 0), 0)
    # round-off of s, 1e-19 m, against indentations of some 10 µm
    np.testing.assert_allclose(loads, expected, rtol=1e-12, atol=1e-12 * loads.max())


@settings(deadline=None, max_examples=150)
@given(cases())
def test_c_equals_its_twin(case):
    from bearingdyn import core

    away_from_kinks(*case)
    spec, z, zdot, _, cage_speed = case
    size = np.abs(z).max()
    # round-off is that of one ball's force, the film's share included, also where the sum over balls cancels
    stiffness = 1.5 * spec.kappa * np.sqrt(size + spec.h0)
    c = np.abs(bearing_twin.bearing_force(*case)[2]).max()
    scales = (
        stiffness * (size + spec.h0) + c * (np.abs(zdot).max() + abs(cage_speed) * size),
        stiffness + c * abs(cage_speed),
        max(c, 1e-300),
        stiffness * (size + spec.h0) + c * (np.abs(zdot).max() + abs(cage_speed) * size),
    )
    for ours, twin, scale in zip(
        core.bearing_force(*case), bearing_twin.bearing_force(*case), scales, strict=True
    ):
        np.testing.assert_allclose(ours, twin, rtol=1e-13, atol=1e-13 * scale)


@settings(deadline=None, max_examples=60)
@given(cases())
def test_tangent_of_c_is_the_derivative_of_its_force(case):
    from bearingdyn import core

    away_from_kinks(*case)
    spec, z, zdot, angle, cage_speed = case
    _, K, C, _ = core.bearing_force(*case)
    size = np.abs(z).max()
    gap = np.abs(compression(spec, z, angle)).min()
    h, hdot = 3e-4 * gap, 1e-6

    def along(step, step_rate):
        ahead, behind = (
            core.bearing_force(spec, z + t * step, zdot + t * step_rate, angle, cage_speed)[0]
            for t in (1, -1)
        )
        return (ahead - behind) / 2

    for k in range(len(z)):
        unit = (np.arange(len(z)) == k).astype(float)
        by_z, by_zdot = along(h * unit, 0 * unit) / h, along(0 * unit, hdot * unit) / hdot
        # truncation (h/s)²/24·K ≈ 4e-9; round-off 1e-16·F/h, F at most the largest stiffness times size
        noise = 1e-15 * 1.5 * spec.kappa * np.sqrt(size + spec.h0) * (size + spec.h0)
        np.testing.assert_allclose(by_z, K[:, k], rtol=0, atol=1e-7 * np.abs(K).max() + noise / h)
        np.testing.assert_allclose(by_zdot, C[:, k], rtol=0, atol=1e-7 * np.abs(C).max() + noise / hdot)
