"""Every row of the table of magnitudes, both sides; where the rows are applied; and inputs at random."""

from __future__ import annotations

import math
import re
import tempfile
import warnings

import numpy as np
import pytest

import bearingdyn as bd
from bearingdyn.bearing import (
    Lubricant,
    Mounting,
    Pair,
    Running,
    Seat,
    Walther,
    friction,
    load_cases,
    lubricate,
    rating_life,
)
from bearingdyn.notice import BearingWarning, Notice, UnloadedBearing, UnusualMagnitude
from bearingdyn.plausible_ranges import MAGNITUDES, plausible

ROWS = sorted(MAGNITUDES)
BALLS = {"Z": 9, "Dw": 7.94e-3, "Dpw": 39.04e-3, "fi": 0.52, "fo": 0.53}


def beyond(limits: tuple[float, float], by_size: bool) -> list[float]:
    """A number outside each side of limits that has an outside: 1 % of the limit, or of 1."""
    low, high = limits
    found = [] if math.isinf(high) else [high + 0.01 * abs(high)]
    if low != 0 or not by_size:
        found.append(low - 0.01 * abs(low))
    return found


@pytest.mark.parametrize("kind", ROWS)
def test_outside_the_possible_is_refused_and_the_limits_pass(kind):
    row = MAGNITUDES[kind]
    for x in beyond(row.possible, row.by_size):
        with pytest.raises(ValueError, match=r"^thing is .*; it must be at (most|least)"):
            plausible(kind, "thing", x)
    for x in (math.nan, math.inf, -math.inf, None, "1", True, [1.0]):
        with pytest.raises(ValueError, match="thing is"):
            plausible(kind, "thing", x)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UnusualMagnitude)
        for x in row.possible:
            if math.isfinite(x):
                assert plausible(kind, "thing", x) == x


@pytest.mark.parametrize("kind", ROWS)
def test_outside_the_usual_is_warned_of_and_the_limits_are_not(kind):
    row = MAGNITUDES[kind]
    assert row.possible[0] <= row.usual[0] < row.usual[1] <= row.possible[1]
    for x in beyond(row.usual, row.by_size):
        if row.within(x, row.possible):
            with pytest.warns(UnusualMagnitude, match=r"^thing is .*; usual is at (most|least)"):
                assert plausible(kind, "thing", x) == x
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        for x in row.usual:
            if math.isfinite(x):
                assert plausible(kind, "thing", x) == x


@pytest.mark.parametrize("kind", ROWS)
def test_the_unit_probably_meant_is_named(kind):
    """A usual number in another unit, where that makes it unusual: unit and SI number are in the message."""
    row = MAGNITUDES[kind]
    low = row.usual[0] if row.usual[0] > 0 or not row.by_size else row.usual[1] * 1e-3
    middle = math.sqrt(low * row.usual[1]) if low > 0 else 0.5 * (low + row.usual[1])
    for unit, scale, shift in row.slips:
        given = (middle - shift) / scale
        if not row.within(given, row.usual):
            told = row.guess(given)
            assert "is it in" in told
            assert f"{row.slips[0].unit}" in told or unit in told


@pytest.mark.parametrize(
    ("kind", "given", "said"),
    [
        ("film", 5e-5, "is it in mm? give 5e-08 m"),  # not in µm: 5e-11 m is less than an atom
        ("film", 0.3, "is it in µm? give 3e-07 m"),
        ("film", 300.0, "is it in nm? give 3e-07 m"),
        ("expansion", 5e-4, ""),
        ("expansion", 12.0, "is it in 1e-6/K? give 1.2e-05 1/K"),
        ("mount clearance", 3e-3, "is it in mm? give 3e-06 m"),
        ("offset", 2.0, "is it in µm? give 2e-06 m"),
        ("mount clearance", 20.0, "is it in µm? give 2e-05 m"),
        ("Young's modulus", 0.003, "is it in GPa? give 3e+06 Pa"),
        ("contact angle", 1.4, "is it in degrees"),
    ],
)
def test_no_unit_is_offered_in_which_nobody_would_have_given_the_number(kind, given, said):
    told = MAGNITUDES[kind].guess(given)
    assert said in told if said else told == ""


def rotor(load=None, **bearing):
    app = bd.Application()
    app.add("r", bd.RigidBody(4.0, (0.02, 0.02, 0.004), rotating=True))
    given = {"clearance": 10e-6, **bearing}
    app.bearing("b", bd.BallBearing(**BALLS, **given), inner="r.centre", outer="ground")
    if load is not None:
        app.load("r.centre", load)
    return app


def held():
    app = bd.Application()
    app.add("r", bd.RigidBody(4.0, (0.02, 0.02, 0.004), rotating=True))
    app.ground("r.centre", stiffness=[1e6] * 6, damping=[10.0] * 6)
    return app


def ball(**given):
    return bd.BallBearing(**BALLS, **{"clearance": 10e-6, **given})


def sagging(stiffness):
    app = bd.Application()
    app.add("r", bd.RigidBody(4.0, (0.02, 0.02, 0.004)))
    app.ground("r.centre", stiffness=[stiffness] * 6)
    app.load("r.centre", (0, -400.0, 0, 0, 0, 0))
    return bd.equilibrium(app)


def unbalanced(moment):
    app = held()
    app.unbalance("r.centre", moment)
    return bd.unbalance_response(app, [300.0], ["r.centre.x"])


def turning(speed):
    return bd.modes(bd.equilibrium(rotor((0, -400.0, 100.0, 0, 0, 0))), count=2, speed=speed)


def marched(**given):
    asked = {"speed": 100.0, "dt": 1e-5, "steps": 2, "record": ["r.centre.y"], **given}
    return bd.transient(held(), **asked)


OIL = Lubricant(Walther.iso_vg(32))
SLIPS = {
    "E in MPa": lambda: bd.Elastic(210e3, 0.3, 7850.0),
    "E in GPa": lambda: bd.Elastic(210.0, 0.3, 7850.0),
    "rubber in MPa": lambda: bd.Maxwell(1.0, [1.0], [1e-3], K=2000.0, density=1100.0),
    "G0 in MPa, K in Pa": lambda: bd.Maxwell(1.0, [1.0], [1e-3], K=2e9, density=1100.0),
    "K in MPa, foam": lambda: bd.Maxwell(1e4, [1.0], [1e-3], K=2e4, density=1100.0),
    "power law in MPa": lambda: bd.PowerLaw(1.0, 0.2, 100.0, K=2000.0, density=1100.0),
    "temperature in kelvin": lambda: bd.Maxwell(1e6, [], [], K=2e9, density=1100.0, temperature=293.0),
    "film in µm": lambda: ball(film=0.3),
    "film in mm": lambda: ball(film=3e-4),
    "waviness in µm": lambda: bd.Waviness("inner", 10, 1.0),
    "waviness in mm": lambda: bd.Waviness("inner", 10, 1e-3),
    "wave's phase in degrees": lambda: bd.Waviness("inner", 10, 1e-6, phase=90.0),
    "pit in mm": lambda: bd.Pit("outer", 0.0, 1.0, 0.1),
    "pit's depth in µm": lambda: bd.Pit("outer", 0.0, 1e-3, 5.0),
    "pit's angle in degrees": lambda: bd.Pit("outer", 270.0, 1e-3, 1e-4),
    "oversize in µm": lambda: ball(oversize=[1.0] * 9),
    "angle0 in degrees": lambda: ball(angle0=90.0),
    "contact angle of 86°": lambda: ball(clearance=None, contact_angle=1.5),
    "contact angle in degrees": lambda: ball(clearance=None, contact_angle=25.0),
    "clearance in mm": lambda: ball(clearance=0.4e-3),
    "kappa in N/mm^1.5": lambda: ball(kappa=3e5),
    "contact damping time in µs": lambda: bd.LoadDamping(2.5),
    "pair's distance in mm": lambda: Pair(ball(clearance=None, contact_angle=0.3), "DB", distance=15.0),
    "pair's preload in µm": lambda: Pair(
        ball(clearance=None, contact_angle=0.3), "DB", distance=0.015, preload=3.0
    ),
    "interference in µm": lambda: Seat(interference=10.0),
    "warming as temperature in kelvin": lambda: Mounting(0.025, 0.052, inner=343.0),
    "expansion in 1e-6/K": lambda: Seat(expansion=12.0),
    "nu in mm²/s": lambda: Walther.from_two_points(40.0, 32.0, 100.0, 5.4),
    "alpha in 1/GPa": lambda: Lubricant(Walther.iso_vg(32), alpha=20.0),
    "oil's density in g/cm³": lambda: Lubricant(Walther.iso_vg(32), density=0.87),
    "oil in kelvin": lambda: Walther.iso_vg(32).viscosity(343.0),
    "roughness in µm": lambda: lubricate(
        ball(), OIL, 60.0, 100.0, (0, -400.0, 100.0, 0, 0, 0), roughness=(0.1, 0.02)
    ),
    "inertia in kg mm²": lambda: bd.RigidBody(4.0, (20000.0, 20000.0, 4000.0)),
    "inertia of a small body in kg mm²": lambda: bd.RigidBody(0.01, (0.5, 0.5, 0.5)),
    "disc's inertia in kg mm²": lambda: bd.Disc(0.1, 4.0, 20000.0, 4000.0),
    "unbalance in g mm": lambda: unbalanced(40.0),
    "unbalance in kg mm": lambda: unbalanced(0.08),
    "phase in degrees": lambda: held().unbalance("r.centre", 1e-5, phase=90.0),
    "load's phase in degrees": lambda: held().load(
        "r.centre", (0, 1.0, 0, 0, 0, 0), frequency=10.0, phase=90.0
    ),
    "gravity in mm/s²": lambda: held().gravity((0, -9810.0, 0)),
    "base motion in mm/s²": lambda: held().base_motion((0, 9810.0, 0), frequency=10.0),
    "force of 1e200 N": lambda: held().load("r.centre", (0, 1e200, 0, 0, 0, 0)),
    "offset in µm": lambda: rotor().bearing("c", ball(), inner="r.centre", outer="ground", offset=10.0),
    "stiffness of 1e20": lambda: bd.Application.ground(held(), "r.centre", stiffness=[1e20] * 6),
    "speed in rpm": lambda: turning(18000.0 * 4),
    "kinematics in rpm": lambda: ball().frequencies(1e5),
    "Running in rpm": lambda: Running(ball(), 1e5),
    "step in µs": lambda: marched(dt=2.5),
    "speed of a march in rpm": lambda: marched(speed=1e5),
    "initial in µm": lambda: marched(initial={"r.centre": [0, 10.0, 0, 0, 0, 0]}),
    "equilibrium's angle in degrees": lambda: bd.equilibrium(rotor((0, -9.0, 9.0, 0, 0, 0)), 90.0),
    "400 kN on a 6205": lambda: bd.equilibrium(rotor((0, -4e5, 0, 0, 0, 0))),
    "1e6 N": lambda: ball().displacement([0, -1e6, 0, 0, 0, 0]),
    "30 kN": lambda: ball().displacement([0, -3e4, 0, 0, 0, 0]),
    "table of moduli in MPa": lambda: bd.TabulatedModulus(
        [1.0, 10.0, 100.0], [1.0, 2.0, 3.0], [0.1, 0.2, 0.3], K=2e9, density=1100.0
    ),
    "after in years as 1e30 s": lambda: bd.equilibrium(held(), after=1e30),
    "load's course of 1e300": lambda: held().load(
        "r.centre", (0, 1.0, 0, 0, 0, 0), time=[0, 1], value=[0, 1e300]
    ),
    "base motion's course in mm/s²": lambda: held().base_motion((0, 1.0, 0), time=[0, 1], value=[0, 5e4]),
    "run-up in ns": lambda: marched(speed=([0, 1e-9], [0, 1e2])),
    "order of 1e9": lambda: bd.Waviness("inner", 10**9, 1e-9),
    "element length in mm": lambda: bd.Shaft([bd.Section(0.3, 0.03)], {"a": 0.05}, element_length=5.0),
    "box in mm": lambda: bd.box_mesh([0, 100.0], [0, 20.0], [0, 30.0]),
    "arm as a diameter": lambda: bd.FlexibleRing(0.0228, 0.026, 0.015, 2 * ball().arm),
    "overflow": lambda: ball().displacement([0, 1e200, 0, 0, 0, 0]),
    "fractional law in MPa": lambda: bd.FractionalZener(1.0, 5.0, 1e-4, 0.5, K=2e9, density=1100.0),
    "power law's modulus in MPa": lambda: bd.PowerLaw(5.0, 0.2, 100.0, K=2e9, density=1100.0),
    "loss in volume in per cent": lambda: bd.BulkRelaxation((20.0,), (1e-3,)),
    "spread in per cent": lambda: bd.Maxwell(1e6, [], [], K=2e9, density=1100.0).with_spread(level=8.0),
    "strain sweep in MPa": lambda: bd.StrainSweep([1e-3, 0.01, 0.1], [5.0, 4.0, 3.0], [0.5, 0.6, 0.5], 1.0),
    "specimen in mm": lambda: bd.specimen_factor(2.0, diameter=20.0),
    "bore's waves in µm": lambda: bd.BoreShape({3: (5.0, 0.0)}),
    "bore's interference in µm": lambda: bd.BoreShape({}, interference=10.0),
    "bed in N/mm³": lambda: bd.RingBed(1e30),
    "feet in degrees": lambda: bd.RingPoints([0.0, 120.0, 240.0], 1e7),
    "conductance in W/K": lambda: bd.ThermalNetwork().link("a", "b", 1e12),
    "sound at 48 kHz": lambda: bd.write_wav(f"{tempfile.gettempdir()}/slip.wav", np.zeros(8), 48.0),
    "ratings in kN": lambda: bd.bearing_sheet(
        bd.equilibrium(rotor((0, -400.0, 100.0, 0, 0, 0))), C={"b": 14.0}, C0={"b": 7.85}
    ),
    "shoulder in mm": lambda: bd.bearing_sheet(
        bd.equilibrium(rotor((0, -400.0, 100.0, 0, 0, 0))), shoulder={"b": 1.5}
    ),
    "table of a load of nothing": lambda: bd.stiffness_table(ball(), [[0.0] * 6]),
    "pressed by 1 mm": lambda: ball().force([0, -1e-3, 0, 0, 0, 0]),
    "pressed by 10 in µm": lambda: ball().force([0, -10.0, 0, 0, 0, 0]),
    "life under kN": lambda: rating_life(ball(), (0, -0.4, 0.1, 0, 0, 0)),
    "load cases in kN": lambda: load_cases(ball(), [[0, -0.4, 0.1, 0, 0, 0]]),
    "oil under kN": lambda: lubricate(ball(), OIL, 60.0, 100.0, (0, -0.4, 0.1, 0, 0, 0)),
    "equilibrium under kN": lambda: bd.equilibrium(rotor((0, -0.4, 0.1, 0, 0, 0))),
    "stiffness in N/µm": lambda: sagging(100.0),
    "gravity in g": lambda: held().gravity((0, -1.0, 0)),
    "cage at 90 degrees": lambda: ball().stiffness([0, -1e-5, 0, 0, 0, 0], angle=90.0),
    "displacement with its cage in degrees": lambda: ball().displacement((0, -400.0, 0, 0, 0, 0), 90.0),
    "shapes at moduli in MPa": lambda: bd.Layer(
        0.026, 0.028, 0.016, bd.Maxwell(1e6, [2e6], [1e-3], K=2e9, density=1200.0), moduli=(1.0, 4.0)
    ),
    "one branch in MPa": lambda: bd.Maxwell(1e6, [2.0], [1e-3], K=2e9, density=1200.0),
    "WLF in kelvin": lambda: bd.material.WLF(8.86, 101.6, 293.0),
    "shift table in kelvin": lambda: bd.material.ShiftTable((273.0, 293.0, 313.0), (1.0, 0.0, -1.0), 293.0),
    "activation energy in kJ/mol": lambda: bd.material.Arrhenius(120.0, 20.0),
    "vertical shift in kelvin": lambda: bd.material.RhoT(293.0),
    "seals in N mm": lambda: friction(
        radial=400.0,
        axial=100.0,
        speed=100.0,
        viscosity=2e-5,
        bore=0.025,
        outside=0.052,
        C0=7800.0,
        seals=30.0,
    ),
    "reference in mm": lambda: bd.RigidSurface("x-", (5.0, 5.0, 5.0)).place(
        bd.box_mesh([0, 0.02], [0, 0.02], [0, 0.02])
    ),
    "cylinder in mm": lambda: bd.Cylinder(26.0),
    "groove's arm in mm": lambda: bd.Groove(bd.Cylinder(0.02), 20.5),
    "microphones in mm": lambda: bd.sound.hemisphere_positions(1000.0),
    "machine in mm": lambda: bd.sound.box_positions((0, 0, 0), (100.0, 100.0, 100.0)),
    "velocity in mm/s": lambda: bd.sound.vibration_severity(4.5 * np.sin(0.1 * np.arange(20000)), 10000.0),
    "signal at 48 kHz": lambda: bd.sound.mean_squares(np.ones(1000), 48.0),
    "fit's tolerance in per cent": lambda: bd.fit_maxwell(
        bd.master_curve(bd.read_dma(bd.sample_dma_path())), "auto", K=2e9, density=1150.0, tolerance=2.0
    ),
}


def test_the_defaults_of_every_joint_are_usual():
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        bd.LooseFit(20e-6)
        bd.Housing(0.12, 0.14, 0.02, 0.052)
        bd.ThermalNetwork()


@pytest.mark.parametrize("slip", SLIPS)
def test_a_slip_of_units_is_refused_or_warned_of(slip):
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        try:
            SLIPS[slip]()
        except ValueError as error:
            told = str(error)
        else:
            told = ""
    if told:
        assert "; " in told, "the message names value and remedy"
        return
    assert any(issubclass(w.category, Notice) for w in caught)


def test_pressures_over_the_static_rating_are_warned_of_by_every_analysis():
    # the static rating of this bearing, 4.2 GPa in the heaviest contact
    rating = ball().static_rating
    load = (0, -2.0 * rating, 0.1 * rating, 0, 0, 0)
    with pytest.warns(BearingWarning, match=r"bearing 'b', ball \d: .* GPa .*over 4.2 GPa \(ISO 76\)"):
        state = bd.equilibrium(rotor(load))
    with pytest.warns(BearingWarning, match=r"a ball bore .* in this march"):
        bd.transient(state, speed=10.0, dt=1e-6, steps=2, record=["b.ball1", "b.force.y"])
    with pytest.warns(BearingWarning, match="over 4.2 GPa"):
        q = ball().displacement(load)
    with pytest.warns(BearingWarning, match="over 4.2 GPa"):
        ball().force(q)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        bd.equilibrium(rotor((0, -0.8 * rating, 0.1 * rating, 0, 0, 0)))


@pytest.mark.parametrize(
    "flaw",
    [
        {},
        {"film": 1e-6, "clearance": 20e-6},
        {"waviness": [bd.Waviness("inner", 10, 1e-6)], "clearance": 0.0},
        {"defects": [bd.Pit("outer", 0.0, 1e-3, 1e-4)], "clearance": 0.0},
        {"waviness": [bd.Waviness("outer", 9, 1e-6)], "clearance": None, "contact_angle": 0.3},
    ],
)
def test_a_bearing_that_nothing_presses_is_named(flaw):
    state = bd.equilibrium(rotor(**flaw))
    assert "b 0 of 9" in repr(state)
    for analyse in (
        lambda: bd.modes(state, count=3),
        lambda: bd.frequency_response(state, [100.0], ["r.centre.y"], ["r.centre.y"]),
        lambda: bd.campbell(state, [0.0, 100.0], 3),
    ):
        with pytest.warns(UnloadedBearing, match="bearing 'b' carries no load in this equilibrium"):
            analyse()


def test_a_free_spin_at_zero_frequency_is_named():
    state = bd.equilibrium(rotor((0, -400.0, 100.0, 0, 0, 0), clearance=None, contact_angle=0.2))
    ask = [0.0, 10.0]
    held = bd.frequency_response(state, ask, ["r.centre.y"], ["r.centre.y"])["response"].values
    assert np.isfinite(held).all()
    with pytest.raises(ArithmeticError, match=r"0 Hz.* r.centre.θz, where the shaft is free to spin about z"):
        bd.frequency_response(state, ask, ["r.centre.θz"], ["r.centre.y"])


# ------------------------------------------------------------------- at random


# every message begins with, or holds, an input's own name
NAMES = re.compile(
    r"Elastic|Maxwell|mass|inertia|Section|Dw|Dpw|f[io]\b|clearance|film|angle0|waviness|defects|speed|\bq\b|load|ball"
)


def number(rng):
    """A size over forty decades, zero, a sign, or what is no size."""
    kind = rng.integers(0, 12)
    if kind == 0:
        return float(rng.choice([0.0, math.nan, math.inf, -math.inf, 1e200, -1e-200]))
    sign = -1.0 if kind == 1 else 1.0
    return sign * 10.0 ** rng.uniform(*((-8, 2) if kind < 9 else (-20, 20)))


def attempt(rng, kind):
    """One input of a model at random, of which some numbers are usual; what it computes, (n,)."""

    def one(usual):
        return usual if rng.random() < 0.8 else number(rng)

    if kind == 0:
        m = bd.Elastic(one(2.1e11), one(0.3), one(7850.0))
        return [m.G, m.K]
    if kind == 1:
        m = bd.Maxwell(
            one(1e6), [one(1e6), one(2e6)], [one(1e-3), one(1e-5)], one(0.0), K=one(2e9), density=one(1100.0)
        )
        return np.abs(m.complex_modulus(np.array([1.0, 1e4])))
    if kind == 2:
        m = bd.RigidBody(one(4.0), (one(0.02), one(0.02), one(0.01)))
        return np.diag(m.superelement().M)
    if kind == 3:
        s = bd.Section(one(0.3), one(0.03), one(0.0))
        return [s.area]
    b = bd.BallBearing(
        9,
        one(7.94e-3),
        one(39.04e-3),
        one(0.52),
        one(0.53),
        clearance=one(10e-6),
        film=one(0.0),
        angle0=one(0.1),
        waviness=[bd.Waviness("inner", 3, one(1e-6), phase=one(1.0))],
        defects=[bd.Pit("outer", one(1.0), one(1e-3), one(1e-5))],
    )
    if kind == 4:
        return [b.kappa, b.static_rating, *b.frequencies(one(100.0))]
    if kind == 5:
        return b.force([one(0.0), one(-1e-5), one(1e-5), one(0.0), one(0.0), 0.0])
    return b.displacement([one(0.0), one(-400.0), one(100.0), one(0.0), one(0.0), 0.0])


@pytest.mark.parametrize("count", [2000, pytest.param(100_000, marks=pytest.mark.slow)])
def test_random_inputs_give_something_finite_or_name_an_input(count):
    rng = np.random.default_rng(13)
    said = {"finite": 0, "warned": 0, "refused": 0}
    for _ in range(count):
        kind = int(rng.integers(0, 7))
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            try:
                result = np.asarray(attempt(rng, kind), dtype=float)
            except (ValueError, ArithmeticError) as error:
                told = str(error)
            else:
                told = ""
        if told:
            assert NAMES.search(told), told
            said["refused"] += 1
            continue
        assert all(issubclass(w.category, Notice) for w in caught), [str(w.message) for w in caught]
        assert np.isfinite(result).all()
        said["warned" if caught else "finite"] += 1
    print(f"{count} inputs: {said}")
    assert said["finite"] > count / 10
    assert said["refused"] > count / 10
