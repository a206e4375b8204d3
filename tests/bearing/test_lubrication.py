"""Films at an operating point, put together here from the published formula and the races' own numbers."""

from __future__ import annotations

import contextlib
import dataclasses
import math
import re

import numpy as np
import pytest

from bearingdyn.bearing import (
    BallBearing,
    Lubricant,
    Walther,
    ehl,
    film_by_formula,
    lubricate,
    nijenbanning_venner_moes,
)
from bearingdyn.bearing.catalogue import bearing
from bearingdyn.bearing.contact_damping import wijnant_damping

OIL = Lubricant(Walther.iso_vg(32), density=870.0, alpha=2e-8)
BRG = bearing("6305", balls=7, clearance=10e-6)
AXIAL = (0, 0, 300.0, 0, 0, 0)
SPEED = 150.0


def test_hamrock_dowson_film_of_each_race():
    found = lubricate(BRG, OIL, 70.0, SPEED, AXIAL, law="hamrock-dowson")
    # theory.md §2: ν(70 °C) = 11.186 mm²/s, five digits
    eta0 = 11.186e-6 * 870
    assert found.viscosity == pytest.approx(eta0, rel=5e-5)
    state = BRG.ball_loads(BRG.displacement(AXIAL))
    assert found.Q == pytest.approx(state.mean(), rel=1e-12)
    alpha = math.asin(300.0 / state.sum())
    gamma = 11.5 / 43.5 * math.cos(alpha)
    us = 43.5e-3 / 2 * SPEED * (1 - gamma**2)
    E = 210e9 / (1 - 0.3**2)
    for race, f, film in (("inner", 0.52, found.film_inner), ("outer", 0.53, found.film_outer)):
        # Rx = D/2 (1 ∓ D/dm), nominal angle 0
        Rx = 11.5e-3 / 2 * (1 - 11.5 / 43.5 if race == "inner" else 1 + 11.5 / 43.5)
        chi = getattr(BRG, f"{race}_contact").chi
        U, G, W = eta0 * us / 2 / (E * Rx), 2e-8 * E, found.Q / (E * Rx**2)
        p = getattr(BRG, f"{race}_contact").pressure(found.Q)
        expected = 2.69 * Rx * U**0.67 * G**0.53 * W**-0.067 * (1 - 0.61 * math.exp(-0.73 * chi))
        # the digits of the viscosity
        assert film == pytest.approx(expected * (5.9e8 + p) / (5.9e8 + 1.34 * p), rel=5e-5)
        assert f in (BRG.fi, BRG.fo)


def test_both_films_act_on_one_spring():
    found = lubricate(BRG, OIL, 40.0, SPEED, AXIAL)
    wet = found.applied(BRG)
    assert wet.film == found.h0_inner + found.h0_outer
    # F = κ(δ + h_i + h_o)^{3/2} is what two films and two springs in series give: solve the pair by hand
    h, k = (found.h0_inner, found.h0_outer), (BRG.inner_contact.kappa, BRG.outer_contact.kappa)
    F = 200.0
    apart = sum((F / kappa) ** (2 / 3) - film for kappa, film in zip(k, h, strict=True))
    assert wet.kappa * (apart + wet.film) ** 1.5 == pytest.approx(F, rel=1e-12)
    # the balls are pressed harder by what the films take from the clearance
    assert wet.ball_loads(wet.displacement(AXIAL)).sum() != BRG.ball_loads(BRG.displacement(AXIAL)).sum()


def test_starvation_and_roughness():
    full = lubricate(BRG, OIL, 40.0, SPEED, AXIAL)
    half = lubricate(BRG, OIL, 40.0, SPEED, AXIAL, starvation=0.5, roughness=(40e-9, 30e-9))
    assert half.film == pytest.approx(0.5 * full.film, rel=1e-14)
    # composite of 40 and 30 nm is 50 nm
    assert half.lambda_inner == pytest.approx(half.film_inner / 50e-9, rel=1e-14)
    assert half.lambda_outer == pytest.approx(half.film_outer / 50e-9, rel=1e-14)
    assert full.lambda_inner == math.inf


def test_film_grows_with_speed_and_cold():
    films = [lubricate(BRG, OIL, T, s, AXIAL).film for T, s in ((70, 150.0), (70, 300.0), (40, 300.0))]
    assert films[0] < films[1] < films[2]
    assert lubricate(BRG, OIL, 70, -150.0, AXIAL).film == films[0]


def test_damping_is_that_of_both_contacts_in_series_and_vanishes_with_the_load():
    found = lubricate(BRG, OIL, 70.0, SPEED, AXIAL)
    # each race from the contact itself, the series by hand: compliance and its loss add under one force
    parts = [
        ehl.look_up(contact, OIL, found.Q, found.us, 70.0)
        for contact in (BRG.inner_contact, BRG.outer_contact)
    ]
    assert [c.c0 for c in parts] == [found.damping_inner, found.damping_outer]
    assert [c.h0 for c in parts] == [found.h0_inner, found.h0_outer]
    omega = 1e-3  # far below k/c
    joined = 1 / sum(1 / (c.k0 + 1j * omega * c.c0) for c in parts)
    # c to (ω c/k)², nothing; round-off of the difference of 1e-10 of k
    assert joined.imag / omega == pytest.approx(found.damping, rel=1e-5)
    wet = found.applied(BRG)
    assert found.applied(BRG, damping=False).damping == BRG.damping
    law, kappa = wet.damping, wet.kappa
    # monotone cubics between nodes of w apart by 1/64 of what the table has: .5 %
    assert law.at((found.Q / kappa) ** (2 / 3)) == pytest.approx(found.damping, rel=5e-3)
    for Q in (0.3 * found.Q, 1.2 * found.Q):
        pair = [ehl.look_up(c, OIL, Q, found.us, 70.0) for c in (BRG.inner_contact, BRG.outer_contact)]
        c = (1 / sum(1 / (p.k0 + 1j * omega * p.c0) for p in pair)).imag / omega
        assert law.at((Q / kappa) ** (2 / 3)) == pytest.approx(c, rel=5e-3)
    assert law.at(0.0) == 0
    assert law.at((1e-4 / kappa) ** (2 / 3)) < 1e-3 * found.damping


def test_formula_is_divided_by_the_density_under_pressure():
    found = lubricate(BRG, OIL, 70.0, SPEED, AXIAL, law="nijenbanning-venner-moes")
    for contact, film in ((BRG.inner_contact, found.film_inner), (BRG.outer_contact, found.film_outer)):
        p = contact.pressure(found.Q)
        rho = (5.9e8 + 1.34 * p) / (5.9e8 + p)
        plain = nijenbanning_venner_moes(contact, found.Q, found.us, found.viscosity, OIL.alpha)
        assert film == pytest.approx(plain / rho / 1.009, rel=1e-12)  # the middle of its errors
        assert film == film_by_formula(contact, found.Q, found.us, found.viscosity, OIL.alpha)
    equations = lubricate(BRG, OIL, 70.0, SPEED, AXIAL)
    # theory.md §4.3: the divided formula is 3 to 5 % high for narrow contacts
    assert found.film_inner == pytest.approx(equations.film_inner, rel=0.05)
    assert found.film_outer == pytest.approx(equations.film_outer, rel=0.05)


@pytest.mark.slow
def test_solving_gives_what_the_table_gives():
    table, solved = (lubricate(BRG, OIL, 70.0, SPEED, AXIAL, method=m) for m in ("table", "solve"))
    # 2 % asked of the table; its oil has 0.04 Pa s, which moves the film of this one by another 2 %
    assert table.film == pytest.approx(solved.film, rel=0.04)
    assert table.damping == pytest.approx(solved.damping, rel=0.04)


def test_unverified_formula_of_wijnant():
    # the form by hand, E' = 2 E*
    c, F, us, eta0 = BRG.inner_contact, 50.0, 4.0, 0.02
    E = 210e9 / (1 - 0.3**2)
    group = eta0 * us / (E * c.Rx)
    M, L = F / (E * c.Rx**2) * group**-0.75, 2e-8 * E * group**0.25
    C = (0.98 - L / 60) * M ** -(0.83 - 0.008 * L)
    expected = C * F / (F / c.kappa) ** (2 / 3) * 2 * c.semi_axes(F)[1] / us
    assert wijnant_damping(c, F, us, eta0, 2e-8) == pytest.approx(expected, rel=1e-12)
    assert "UNVERIFIED" in wijnant_damping.__doc__


def test_a_contact_outside_of_the_table_is_named_with_what_helps():
    with pytest.raises(ValueError, match=r"^inner race under .* N: M is .*the table holds .*method='solve'"):
        lubricate(BRG, OIL, 70.0, 1.0, AXIAL)
    formula = lubricate(BRG, OIL, 70.0, 1.0, AXIAL, law="hamrock-dowson")
    assert formula.law is None
    assert math.isnan(formula.damping)
    with pytest.raises(ValueError, match="damping is True; the table"):
        formula.applied(BRG)


def test_the_speeds_that_the_table_holds_are_told_and_true():
    with pytest.raises(ValueError, match="it holds") as told:
        lubricate(BRG, OIL, 70.0, 1.0, AXIAL)
    held = re.search(r"it holds (\S+) to (\S+) rad/s$", str(told.value))
    assert held is not None
    low, high = map(float, held.groups())
    # three digits are told
    for race_speed in (low * 1.01, high * 0.99):
        with contextlib.suppress(ValueError):  # the outer race may end before
            assert lubricate(BRG, OIL, 70.0, race_speed, AXIAL).damping_inner > 0
    for race_speed in (low * 0.99, high * 1.01):
        with pytest.raises(ValueError, match="inner race"):
            lubricate(BRG, OIL, 70.0, race_speed, AXIAL)


@pytest.mark.slow
def test_solving_knows_no_limits_of_the_table():
    """An oil too thick for the table: a film, a damping, and its law, which is the damping under the load."""
    with pytest.raises(ValueError, match=r"L is .*the table holds"):
        lubricate(BRG, OIL, 20.0, 700.0, AXIAL)
    thick = lubricate(BRG, OIL, 20.0, 700.0, AXIAL, method="solve")
    assert 0 < thick.film_inner < thick.film_outer
    assert thick.law is not None
    s = (thick.Q / BRG.kappa) ** (2 / 3)
    assert float(thick.law.at(s)) == pytest.approx(thick.damping, rel=1e-2)  # cubics between 65 nodes


def test_kinematics_at_the_loaded_angle():
    brg = BallBearing(9, 7.94e-3, 39.04e-3, 0.52, 0.53, clearance=10e-6)
    f = brg.frequencies(100.0, math.radians(20))
    # Harris: BPFO = Z/2 n (1 − D cosα/dm)
    expected = 9 / 2 * 100 / (2 * math.pi) * (1 - 7.94 / 39.04 * math.cos(math.radians(20)))
    assert f.BPFO == pytest.approx(expected, rel=1e-12)
    assert brg.frequencies(100.0, 0.0) == brg.frequencies(100.0)
    with pytest.raises(ValueError, match="contact_angle is "):
        brg.frequencies(100.0, math.nan)


@pytest.mark.parametrize("T", [-120.0, 400.0])
def test_temperature_outside_the_viscosity_law_is_named(T):
    with pytest.raises(ValueError, match=r"^T is .*outside the viscosity law.* °C"):
        lubricate(BRG, OIL, T, SPEED, AXIAL)


def test_viscosity_law_holds_up_to_its_ends():
    # VG 32 reaches 2 mm²/s where lg lg 2.7 = A − B lg T, with theory.md's constants: 165 °C
    end = 10 ** ((9.53082 - math.log10(math.log10(2.7))) / 3.74658) - 273.15
    # constants of six digits, times ln 10 · 450 K
    assert OIL.kinematic.viscosity(end - 0.01) == pytest.approx(2e-6, rel=1e-3)
    with pytest.raises(ValueError, match=f"in -[0-9]+, {end:.0f} °C"):
        OIL.kinematic.viscosity(end + 0.01)


@pytest.mark.parametrize(
    ("field", "change"),
    [
        ("lubricant", dict(lubricant="oil")),
        ("law", dict(law="grubin")),
        ("method", dict(method="guess")),
        ("speed", dict(speed=0.0)),
        ("speed", dict(speed=math.nan)),
        ("starvation", dict(starvation=0.0)),
        ("starvation", dict(starvation=1.1)),
        ("roughness", dict(roughness=(1e-8, math.nan))),
        ("T", dict(temperature=math.nan)),
        ("load", dict(load=np.zeros(6))),
    ],
)
def test_bad_input_is_named(field, change):
    call = dict(bearing=BRG, lubricant=OIL, temperature=40.0, speed=SPEED, load=AXIAL)
    with pytest.raises(ValueError, match=f"^{field} is "):
        lubricate(**{**call, **change})


def test_operating_point_leaves_the_bearing_alone():
    wet = dataclasses.replace(BRG, film=1e-6)
    first, second = (dataclasses.astuple(lubricate(b, OIL, 40.0, SPEED, AXIAL))[:-1] for b in (wet, BRG))
    assert first == second


def test_how_damping_and_film_hang_on_alpha_is_told_and_true():
    def at(alpha):
        oil = Lubricant(Walther.iso_vg(32), alpha=alpha)
        ball = bearing("6205", clearance=10e-6)
        return lubricate(ball, oil, 60.0, 100 * math.pi, (0, -1000, 200, 0, 0, 0))

    middle, low, high = at(1.7e-8), at(1.2e-8), at(2.4e-8)
    # the mean slope over a doubling; locally it differs by a tenth, as the table's own cells do
    for name, told in (("damping", middle.alpha_damping), ("film_inner", middle.alpha_film)):
        mean = math.log(getattr(high, name) / getattr(low, name)) / math.log(2)
        assert told == pytest.approx(mean, rel=0.1)
    assert f"c as α^{middle.alpha_damping:.2f}" in repr(middle)
    # Hamrock and Dowson's film has the exponent .53; that of Nijenbanning, Venner and Moes more at large L
    assert 0.5 < middle.alpha_film < 0.65
