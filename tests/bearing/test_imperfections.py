"""Waviness, pits and unequal balls in the contact kernel: C against twin, rates against differences."""

from __future__ import annotations

import dataclasses
from typing import Any

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from bearingdyn import _core, core
from bearingdyn.bearing import BallBearing, BearingKernel
from bearingdyn.bearing.imperfections import Pit, Waviness
from core_models import KERNEL, replaced
from twins import bearing_twin

Z = 7
SIZE = dict(Z=Z, Dw=11.5e-3, Dpw=43.5e-3, fi=0.52, fo=0.53)
BODIES = ("inner", "outer", "ball")
# m, all balls well pressed together, so that no imperfection loses a contact
PRESSED = np.array([5e-6, -4e-6, 60e-6, 2e-6, 1e-6])


def bearing(**flaws: Any) -> BearingKernel:
    return BallBearing(**SIZE, contact_angle=0.4, damping=20.0, **flaws).kernel()


@st.composite
def waves(draw: Any) -> Waviness:
    body = draw(st.sampled_from(BODIES))
    axial = body != "ball" and draw(st.booleans())
    return Waviness(
        body,
        draw(st.integers(0, 60)),
        draw(st.floats(-2e-6, 2e-6)),
        draw(st.floats(-4, 4)),
        "axial" if axial else "radial",
        draw(st.sampled_from([None, 1, Z])) if body == "ball" else None,
    )


@st.composite
def pits(draw: Any) -> Pit:
    body = draw(st.sampled_from(BODIES))
    ball = draw(st.integers(1, Z)) if body == "ball" else 1
    width = draw(st.sampled_from([2e-4, 3e-3, 14e-3]))  # the last is wider than a ball
    angle = draw(st.one_of(st.floats(-4, 4), st.floats(-1.0, 1.0).map(lambda share: 0.02 * share)))
    return Pit(body, angle, width, draw(st.floats(1e-7, 1e-5)), ball)


flaws = st.fixed_dictionaries(
    {
        "waviness": st.lists(waves(), max_size=4),
        "defects": st.lists(pits(), max_size=3),
        "oversize": st.one_of(
            st.just(()), st.lists(st.floats(-3e-6, 3e-6), min_size=Z, max_size=Z).map(tuple)
        ),
    }
)
# cage angle, cage speed, shaft angle, shaft speed; angle 0 puts ball 1 where many of the pits are
turns = st.tuples(
    st.one_of(st.just(0.0), st.floats(-7, 7)),
    st.sampled_from([0.0, 120.0, -90.0]),
    st.one_of(st.just(0.0), st.floats(-20, 20)),
    st.floats(-400, 400),
)


def ball_loads_are_clear(loads: np.ndarray) -> None:
    """Pits may unload a ball: stay away from the edge of contact, where one bit decides."""
    assume(loads.min() > 1.0)


def at_pit_edges(spec: BearingKernel, angle: float, shaft_angle: float) -> bool:
    """Whether a ball stands within 1e-6 rad of a corner of a pit: there the slope jumps."""
    flaws, spin = spec.imperfections, spec.imperfections.spin_ratio * shaft_angle
    for kind, owner, centre, width, depth in flaws.pits:
        D = flaws.ball_diameter
        for j in range(spec.Z):
            psi = angle + 2 * np.pi * j / spec.Z
            if kind == 2 and owner != j:
                continue
            radius, places = {
                0.0: (flaws.inner_radius, [psi - shaft_angle]),
                1.0: (flaws.outer_radius, [psi]),
                2.0: (D / 2, [spin, spin + np.pi]),
            }[kind]
            for place in places:
                arc = radius * abs(bearing_twin.wrapped(place - centre))
                floor = np.sqrt(D**2 / 4 - (D / 2 - min(depth, D / 2)) ** 2)
                corners = [0.0, width / 2, width / 2 - floor, np.pi * radius]
                if min(abs(arc - corner) for corner in corners) < 1e-6 * radius:
                    return True
    return False


@settings(deadline=None, max_examples=200)
@given(flaws, turns, st.lists(st.floats(-0.01, 0.01), min_size=5, max_size=5))
def test_c_equals_its_twin(flaws: Any, turn: Any, rate: list[float]) -> None:
    spec = bearing(**flaws)
    angle, cage_speed, shaft_angle, shaft_speed = turn
    assume(not at_pit_edges(spec, angle, shaft_angle))
    case = (spec, PRESSED, np.array(rate), angle, cage_speed, shaft_angle, shaft_speed)
    expected = bearing_twin.bearing_force(*case)
    ball_loads_are_clear(expected[3])
    for got, twin in zip(core.bearing_force(*case), expected, strict=True):
        # round-off of angles up to 60·20 rad (1e-13) times waves of 2 µm beside indentations of 20 µm, and of
        # their rates beside 10 mm/s
        np.testing.assert_allclose(got, twin, rtol=0, atol=2e-13 * np.abs(twin).max())


def indentation(spec: BearingKernel, z: np.ndarray, angle: float, shaft_angle: float) -> np.ndarray:
    """δ (Z,) of the twin at rest, m: all balls carry, without damping."""
    elastic = dataclasses.replace(spec, damping_c=0.0)
    loads = bearing_twin.bearing_force(elastic, z, 0 * z, angle, 0.0, shaft_angle, 0.0)[3]
    assume(loads.min() > 1.0)
    return (loads / spec.kappa) ** (2 / 3)


@settings(deadline=None, max_examples=100)
@given(flaws, turns, st.lists(st.floats(-0.01, 0.01), min_size=5, max_size=5))
def test_rate_is_the_derivative_of_the_indentation_along_the_motion(
    flaws: Any, turn: Any, rate: list[float]
) -> None:
    """c δ̇ is read from the C as what damping adds to the ball loads; δ̇ from central differences in time."""
    spec = bearing(**flaws)
    angle, cage_speed, shaft_angle, shaft_speed = turn
    zdot = np.array(rate)
    h = 2e-9  # s
    speeds = np.array([cage_speed, shaft_speed])
    for t in (-h, 0.0, h):
        assume(not at_pit_edges(spec, angle + t * cage_speed, shaft_angle + t * shaft_speed))
    ahead, behind = (
        indentation(spec, PRESSED + t * zdot, *(np.array([angle, shaft_angle]) + t * speeds)) for t in (h, -h)
    )
    case = (PRESSED, zdot, angle, cage_speed, shaft_angle, shaft_speed)
    loads = core.bearing_force(spec, *case)[3]
    elastic = core.bearing_force(dataclasses.replace(spec, damping_c=0.0), *case)[3]
    assume(loads.min() > 1.0)
    got = (loads - elastic) / spec.damping_c
    # round-off of δ: 1e-16·0.5 mm of distances, and 60·20 rad·1e-16·2 µm of waves, over 4 ns: some 1e-11 m/s.
    # Truncation: (60·400 rad/s·2 ns)²/6 of rates up to 60·400·2 µm = 0.05 m/s: 2e-11
    np.testing.assert_allclose(got, (ahead - behind) / (2 * h), rtol=1e-7, atol=1e-9)


@settings(deadline=None, max_examples=60)
@given(flaws, turns, st.lists(st.floats(-0.01, 0.01), min_size=5, max_size=5))
def test_tangents_are_the_derivatives_of_the_force(flaws: Any, turn: Any, rate: list[float]) -> None:
    spec, zdot, h, hdot = bearing(**flaws), np.array(rate), 2e-9, 1e-4
    loads, K, C = (core.bearing_force(spec, PRESSED, zdot, *turn)[i] for i in (3, 1, 2))
    ball_loads_are_clear(loads)
    for k, unit in enumerate(np.eye(5)):
        up, down = (core.bearing_force(spec, PRESSED + s * h * unit, zdot, *turn)[0] for s in (1, -1))
        # truncation (h/δ)²/24, δ of 1 µm and more
        np.testing.assert_allclose((up - down) / (2 * h), K[:, k], rtol=0, atol=1e-6 * np.abs(K).max())
        up, down = (core.bearing_force(spec, PRESSED, zdot + s * hdot * unit, *turn)[0] for s in (1, -1))
        # linear; round-off of 1 kN·1e-16 over 1e-4 m/s
        np.testing.assert_allclose((up - down) / (2 * hdot), C[:, k], rtol=0, atol=1e-9 * np.abs(C).max())


# ---------------------------------------------------------------- by hand


def gained(spec: BearingKernel, angle: float = 0.0, shaft_angle: float = 0.0) -> np.ndarray:
    """Indentation (Z,) beyond the perfect bearing's, ring pressed in z alone."""
    z = np.array([0.0, 0.0, 60e-6, 0.0, 0.0])
    with_flaws, without = (
        (core.bearing_force(s, z, 0 * z, angle, 0.0, shaft_angle, 0.0)[3] / s.kappa) ** (2 / 3)
        for s in (spec, bearing())
    )
    return np.asarray(with_flaws - without)


@pytest.mark.parametrize("body", BODIES)
def test_a_ball_at_a_pit_sinks_by_the_chord_of_its_own_sphere(body: str) -> None:
    """Half a chord of 0.4 mm under a ball of 11.5 mm: R − √(R² − 0.2²) mm = 3.479 µm; or to the depth."""
    R, width = 5.75e-3, 0.4e-3
    sink = R - np.sqrt(R**2 - (width / 2) ** 2)
    for depth, expected in ((1e-3, sink), (2e-6, 2e-6)):
        spec = bearing(defects=[Pit(body, 0.0, width, depth)])
        drops = gained(spec)
        # ball 1 stands at azimuth 0 and has not spun; the others meet nothing
        assert drops[0] == pytest.approx(-expected, rel=1e-9)
        np.testing.assert_allclose(drops[1:], 0.0, atol=1e-16)
    # a quarter of the width further: on the race's own radius
    reach = 11.5e-3 * np.cos(0.4)
    radius = {"inner": (43.5e-3 - reach) / 2, "outer": (43.5e-3 + reach) / 2, "ball": R}[body]
    aside = width / 4 / radius
    spec = bearing(defects=[Pit(body, -aside if body != "ball" else aside, width, 1e-3)])
    assert gained(spec)[0] == pytest.approx(-(R - np.sqrt(R**2 - (width / 4) ** 2)), rel=1e-9)


def test_a_pit_travels_with_its_body() -> None:
    turn = 1.3
    spec = bearing(defects=[Pit("inner", 0.2, 0.4e-3, 2e-6)])
    # the inner race has turned by 1.3: its pit stands at 1.5, where ball 1 is at cage angle 1.5
    assert gained(spec, angle=1.5, shaft_angle=turn)[0] == pytest.approx(-2e-6, rel=1e-9)
    spec = bearing(defects=[Pit("outer", 0.2, 0.4e-3, 2e-6)])
    assert gained(spec, angle=0.2, shaft_angle=turn)[0] == pytest.approx(-2e-6, rel=1e-9)
    # γ = D cos α/dm; a ball spins (dm/2D)(1 − γ²) times as fast as the shaft, showing its pit twice
    gamma = 11.5 * np.cos(0.4) / 43.5
    spin = 43.5 / 23.0 * (1 - gamma**2)
    spec = bearing(defects=[Pit("ball", 0.2, 0.4e-3, 2e-6, ball=3)])
    for half_turns in (0, 1, 2):
        drops = gained(spec, angle=0.4, shaft_angle=(0.2 + half_turns * np.pi) / spin)
        assert drops[2] == pytest.approx(-2e-6, rel=1e-9)
        np.testing.assert_allclose(np.delete(drops, 2), 0.0, atol=1e-16)


@pytest.mark.parametrize("body", BODIES)
def test_rate_over_the_edge_of_a_pit_is_the_slope_times_the_speed_of_the_arc(body: str) -> None:
    """A ball falls by reach/√(R² − reach²) per length, later rises; reach = w/2 − |s|."""
    R, width, cage, shaft = 5.75e-3, 1e-3, 60.0, 150.0
    spin = 43.5 / 23.0 * (1 - (11.5 * np.cos(0.4) / 43.5) ** 2)
    spec = bearing(defects=[Pit(body, 0.0, width, 1e-3)])
    flaws = spec.imperfections
    radius, speed = {
        "inner": (flaws.inner_radius, cage - shaft),
        "outer": (flaws.outer_radius, cage),
        "ball": (R, spin * shaft),
    }[body]
    z = np.array([0.0, 0.0, 60e-6, 0.0, 0.0])
    for s in (-0.45e-3, -0.3e-3, 0.3e-3, 0.45e-3):
        reach = width / 2 - abs(s)
        expected = np.sign(s) * reach / np.sqrt(R**2 - reach**2) * radius * speed
        angle, shaft_angle = (s / radius, 0.0) if body != "ball" else (0.0, s / R / spin)
        case = (z, 0 * z, angle, cage, shaft_angle, shaft)
        loads = core.bearing_force(spec, *case)[3]
        elastic = core.bearing_force(dataclasses.replace(spec, damping_c=0.0), *case)[3]
        # round-off of loads of 1 kN over 20 N s/m: 1e-14 m/s·…, of rates of some 0.1 m/s
        assert (loads - elastic)[0] / spec.damping_c == pytest.approx(expected, rel=1e-9)


def test_a_large_ball_is_pressed_by_what_it_is_larger() -> None:
    sizes = (0.0, 2e-6, 0.0, -1e-6, 0.0, 0.0, 0.5e-6)
    np.testing.assert_allclose(gained(bearing(oversize=sizes), 0.7, 3.0), sizes, atol=1e-16)


def test_waves_of_balls_show_their_diameter() -> None:
    """Even orders count twice, odd ones not at all."""
    for order, expected in ((2, 2e-6), (3, 0.0)):
        spec = bearing(waviness=[Waviness("ball", order, 1e-6)])
        np.testing.assert_allclose(gained(spec, 0.3), expected, atol=1e-16)
    spec = bearing(waviness=[Waviness("ball", 4, 1e-6, ball=5)])
    np.testing.assert_allclose(gained(spec, 0.3), [0, 0, 0, 0, 2e-6, 0, 0], atol=1e-16)


def test_two_lobes_of_a_race_press_two_opposite_balls() -> None:
    """Radial order 2: the same as raceway coefficients of order 2 with the sign of the race."""
    angle, shaft_angle, A, phase = 0.6, 2.1, 1.5e-6, 0.8
    z = np.array([0.0, 0.0, 60e-6, 0.0, 0.0])
    for body, axial in (("inner", 0), ("outer", 0), ("inner", 1), ("outer", 1)):
        wave = Waviness(body, 2, A, phase, "axial" if axial else "radial")
        at = phase - 2 * (shaft_angle if body == "inner" else 0.0)
        size = A if body == "inner" else -A
        spec = bearing()
        kinds = np.array([0, 0, 0, 0, 1, 1, 1] if not axial else [0, 0, 1, 1, 1, 1, 1], np.intc)
        order = np.array([1, 1, 2, 2, 0, 1, 1] if not axial else [1, 1, 0, 1, 1, 2, 2], np.intc)
        sine = np.array([0, 1, 0, 1, 0, 0, 1] if not axial else [0, 1, 0, 0, 1, 0, 1], np.intc)
        ring = dataclasses.replace(spec, axial=kinds, order=order, sine=sine)
        # A cos(2 (ψ − turned) + phase) = A cos(at) cos 2ψ − A sin(at) sin 2ψ
        lobes = [size * np.cos(at), -size * np.sin(at)]
        of_ring = np.array([0, 0, *lobes, 60e-6, 0, 0] if not axial else [0, 0, 60e-6, 0, 0, *lobes])
        ours = core.bearing_force(bearing(waviness=[wave]), z, 0 * z, angle, 0.0, shaft_angle, 0.0)[3]
        theirs = core.bearing_force(ring, of_ring, 0 * of_ring, angle, 0.0)[3]
        np.testing.assert_allclose(ours, theirs, rtol=1e-12)
        assert np.ptp(ours) > 0.05 * ours.mean()


# ---------------------------------------------------------------- bad input


FLAWS = KERNEL["imperfections"]


def flawed(field: str, value: Any) -> dict[str, Any]:
    """The imperfections of KERNEL with one field replaced."""
    return FLAWS | {field: value}


# rows of kind, order, ball, amplitude, phase
BAD_WAVES = [
    None,
    np.zeros(5),
    np.zeros((1, 4)),
    *(
        replaced(np.array([[0.0, 8, 0, 1e-6, 0]]), (0, at), value)
        for at, values in enumerate(
            [
                (-1, 5, 0.5, np.nan),
                (-1, 0.5, 2.0**40, np.inf),
                (-1, 7, 1.5),
                (np.nan, np.inf),
                (np.nan, -np.inf),
            ]
        )
        for value in values
    ),
]
# rows of kind, ball, angle, width, depth
BAD_PITS = [
    None,
    np.zeros((1, 4)),
    *(
        replaced(np.array([[0.0, 0, 0, 1e-3, 1e-6]]), (0, at), value)
        for at, values in enumerate(
            [
                (-1, 3, 0.5, np.nan),
                (-1, 7, 0.5),
                (np.nan, np.inf),
                (0, -1e-3, np.nan, np.inf),
                (-1e-6, np.nan),
            ]
        )
        for value in values
    ),
]
BAD = [
    list(FLAWS.items()),
    {name: FLAWS[name] for name in list(FLAWS)[:-1]},
    *(flawed(name, value) for name in list(FLAWS)[:4] for value in (np.nan, np.inf, "x")),
    *(flawed("waves", wave) for wave in BAD_WAVES),
    *(flawed("pits", pit) for pit in BAD_PITS),
    flawed("oversize", np.zeros(6)),
    flawed("oversize", np.full(7, np.nan)),
    flawed("oversize", None),
    # a pit under balls of no size
    FLAWS | {"ball_diameter": 0.0, "pits": np.array([[0, 0, 0.0, 1e-3, 1e-6]])},
]


@pytest.mark.parametrize("bad", BAD)
def test_bad_imperfections_are_refused(bad: Any) -> None:
    with pytest.raises((ValueError, TypeError)):
        _core.bearing_force(KERNEL | {"imperfections": bad}, np.zeros(5), np.zeros(5), 0.0, 0.0, 0.0, 0.0)
