"""Loads: what each says to the core is the force that its docstring writes."""

from __future__ import annotations

import math

import numpy as np
import pytest

from bearingdyn import core
from bearingdyn.application import (
    GRAVITY,
    GROUND,
    ConstantLoad,
    CoreLoad,
    HarmonicLoad,
    Place,
    SampledLoad,
    Unbalance,
)

AT = Place("shaft", "left")
VECTOR = np.array([1.0, -2.0, 3.0, 0.4, -0.5, 0.6])
ROWS = np.random.default_rng(3).normal(size=(6, 9))
TIMES = np.linspace(-0.01, 0.05, 23)


def force(load: CoreLoad, t: float, speed: float) -> np.ndarray:
    """The force (n,) that csrc/bearingdyn.h says bd_load_data is; the shaft turns steadily, at angle Ωt."""
    if load["kind"] == "constant":
        return load["p_cos"]
    if load["kind"] == "harmonic":
        return load["p_cos"] * math.cos(load["omega"] * t) + load["p_sin"] * math.sin(load["omega"] * t)
    if load["kind"] == "rotating":
        turned = load["p_cos"] * math.cos(speed * t) + load["p_sin"] * math.sin(speed * t)
        return speed**2 * turned
    return load["p_cos"] * np.interp(t, load["time"], load["value"])


def rotating(t: float, speed: float) -> np.ndarray:
    at = speed * t + 0.7
    return 2e-4 * speed**2 * np.array([math.cos(at), math.sin(at), 0, 0, 0, 0])


@pytest.mark.parametrize(
    ("load", "wanted"),
    [
        (ConstantLoad(AT, VECTOR), lambda t, speed: VECTOR),
        (HarmonicLoad(AT, VECTOR, 40.0, 0.3), lambda t, speed: VECTOR * math.cos(80 * math.pi * t + 0.3)),
        (Unbalance(AT, 2e-4, 0.7), rotating),
        (
            SampledLoad(AT, VECTOR, [0.0, 0.02, 0.03], [1.0, 5.0, -1.0]),
            lambda t, speed: VECTOR * np.interp(t, [0.0, 0.02, 0.03], [1.0, 5.0, -1.0]),
        ),
    ],
)
def test_the_core_is_told_the_force_on_the_coordinates(load, wanted):
    told = load.core(ROWS)
    assert told["kind"] in core.LOAD_KINDS
    for t in TIMES:
        # round-off of cos(a + b) by its parts
        np.testing.assert_allclose(force(told, t, 300.0), wanted(t, 300.0) @ ROWS, atol=1e-12 * 2e-4 * 300**2)


def test_a_point_without_rotation_takes_the_force_alone():
    np.testing.assert_array_equal(ConstantLoad(AT, VECTOR).core(ROWS[:3])["p_cos"], VECTOR[:3] @ ROWS[:3])


@pytest.mark.parametrize("where", [GROUND, GRAVITY])
def test_what_moves_all_parts_has_three_components(where):
    assert ConstantLoad(where, np.array([0.0, -9.81, 0.0])).size == "[0.0, -9.81, 0.0]"
    with pytest.raises(ValueError, match=r"three finite numbers \(x, y, z\) in m/s²"):
        ConstantLoad(where, VECTOR)


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: ConstantLoad(AT, VECTOR[:3]), r"load at shaft\.left is .*shape is \(3,\)"),
        (lambda: ConstantLoad(AT, "much"), r"load at shaft\.left is 'much'; it must be real numbers"),
        (lambda: HarmonicLoad(AT, VECTOR, -1.0), r"frequency is -1\.0; it must be positive, in Hz"),
        (lambda: HarmonicLoad(AT, VECTOR, 10.0, math.nan), "phase is nan; it must be finite, in rad"),
        (lambda: SampledLoad(AT, VECTOR, [0.0], [1.0]), "time has 1 samples and value 1; give two or more"),
        (lambda: SampledLoad(AT, VECTOR, [0, 1, 1], [0, 1, 2]), "time must increase"),
        (lambda: SampledLoad(AT, VECTOR, ["a", "b"], [0, 1]), "time is .*; it must be real numbers"),
        (lambda: Unbalance(AT, -1e-4), r"unbalance at shaft\.left is -0\.0001; it must be finite"),
        (lambda: Unbalance(AT, 1e-4, math.inf), "phase is inf; it must be finite, in rad"),
    ],
)
def test_a_load_checks_itself(make, message):
    with pytest.raises(ValueError, match=message):
        make()


def test_a_load_keeps_its_own_numbers():
    vector, value = VECTOR.copy(), np.array([0.0, 1.0])
    load = SampledLoad(AT, vector, [0.0, 1.0], value)
    vector[:] = value[:] = 7.0
    assert load.vector[0] == 1.0
    assert load.value[0] == 0.0
