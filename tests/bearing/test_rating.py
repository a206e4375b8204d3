"""Ratings and lives against the standards' tables, a commercial code, and figures that makers print."""

from __future__ import annotations

import math
import warnings
from dataclasses import replace

import numpy as np
import pytest

from bearingdyn.bearing import BallBearing, load_cases, load_distribution, rating_life
from bearingdyn.bearing.catalogue import bearing, entry
from bearingdyn.bearing.rating import (
    CONTAMINATION,
    Phase,
    contamination_factor,
    dynamic_factor,
    dynamic_factors,
    equivalent_ball_loads,
    equivalent_life,
    equivalent_load,
    equivalent_static_load,
    fatigue_limit,
    friction,
    in_hours,
    iso_ratings,
    life_factor,
    life_of_loads,
    modified_life,
    ratings_of,
    reference_viscosity,
    reliability_factor,
    static_factor,
)
from bearingdyn.material import Elastic
from bearingdyn.notice import BearingWarning, Notice

ISO = BallBearing(7, 11.5e-3, 43.5e-3, 0.52, 0.53, clearance=0.0)
LOOSE = replace(ISO, clearance=10e-6)
RPM = math.pi / 30


class TestRatings:
    # ISO 281, table of fc for radial contact; the formula's constant is one of three digits
    @pytest.mark.parametrize(
        ("gamma", "fc"),
        [(0.05, 46.7), (0.10, 55.5), (0.12, 57.5), (0.16, 59.6), (0.20, 59.9), (0.24, 59.0), (0.30, 56.0)],
    )
    def test_fc_is_that_of_iso_281(self, gamma, fc):
        assert 1.3 * dynamic_factor(gamma) / 1.3 == pytest.approx(fc, rel=2.5e-3)

    # ISO 76, table of f0
    @pytest.mark.parametrize(
        ("gamma", "f0"), [(0.02, 15.1), (0.05, 15.7), (0.08, 16.3), (0.10, 16.4), (0.20, 13.9), (0.30, 11.6)]
    )
    def test_f0_is_that_of_iso_76(self, gamma, f0):
        # a table of three digits
        assert static_factor(gamma) == pytest.approx(f0, abs=0.06)

    def test_ratings_of_a_6205(self):
        C, C0, f0 = ratings_of(bearing("6205"))
        # printed: 14.0 kN, 7.85 kN, 13.9
        assert C == pytest.approx(14.0e3, rel=5e-3)
        assert C0 == pytest.approx(7.85e3, rel=5e-3)
        assert f0 == pytest.approx(13.9, abs=0.05)

    def test_static_rating_is_the_load_of_a_maximal_pressure(self):
        """C0 is 5 times below the sum of ball loads at 4.2 GPa; E = 207 GPa, with 210 it is 2.8 % less."""
        steel = Elastic(207e9, 0.3, 7850.0)
        own = replace(ISO, material=steel, ball_material=steel)
        assert own.static_rating == pytest.approx(ratings_of(own).C0, rel=1e-9)
        assert ISO.static_rating / own.static_rating == pytest.approx((207 / 210) ** 2, rel=1e-9)

    def test_large_balls_are_rated_by_the_lower_power(self):
        """ISO 281 above 25.4 mm: 3.647 Dw^1.4 meets Dw^1.8 there."""
        small, large = ratings_of(entry_bearing("6314")), ratings_of(entry_bearing("6316"))
        assert 3.647 * 25.4**1.4 == pytest.approx(25.4**1.8, rel=1e-3)
        assert large.C / small.C == pytest.approx(123 / 104, rel=5e-3)  # NSK's


def entry_bearing(name: str) -> BallBearing:
    return bearing(name, clearance=10e-6)


class TestEquivalentLoads:
    def test_a_6309_of_a_makers_program(self):
        """SKF's calculator, C = 55.3 kN: 4 kN radial, .5 kN axial are P = 4 kN, 24 500 h at 1800 rpm."""
        P = equivalent_load(4000.0, 500.0, 31500.0, f0=13.0)
        assert P == 4000.0
        assert in_hours((55300.0 / P) ** 3, 1800 * RPM) == pytest.approx(24500, rel=2e-3)

    def test_a_6309_of_a_makers_catalogue(self):
        """SKF general catalogue, example 1: 10 kN on a 6309 of 55.3 kN, 3000 rpm: 169 Mrev, 940 h."""
        life = (55300.0 / equivalent_load(10e3, 0.0, 31500.0, f0=13.0)) ** 3
        assert life == pytest.approx(169, abs=0.5)
        assert in_hours(life, 3000 * RPM) == pytest.approx(940, abs=1)

    # NSK's tables: f0 Fa/C0, e and Y
    @pytest.mark.parametrize(
        ("ratio", "angle", "X", "Y", "e"),
        [
            (0.172, 0, 0.56, 2.30, 0.19),
            (1.38, 0, 0.56, 1.45, 0.30),
            (6.89, 0, 0.56, 1.00, 0.44),
            (0.178, 15, 0.44, 1.47, 0.38),
            (3.57, 15, 0.44, 1.02, 0.55),
            (1.0, 25, 0.41, 0.87, 0.68),
            (1.0, 30, 0.39, 0.76, 0.80),
            (1.0, 40, 0.35, 0.57, 1.14),
        ],
    )
    def test_factors_are_the_tables(self, ratio, angle, X, Y, e):
        assert dynamic_factors(ratio, math.radians(angle)) == pytest.approx((X, Y, e), abs=1e-12)

    def test_static_equivalent_loads(self):
        assert equivalent_static_load(1000.0, 2000.0) == 1600.0
        assert equivalent_static_load(1000.0, 100.0) == 1000.0
        assert equivalent_static_load(1000.0, 3000.0, math.radians(40)) == pytest.approx(500 + 0.26 * 3000)
        assert equivalent_static_load(1000.0, 3000.0, math.radians(15)) == pytest.approx(500 + 0.46 * 3000)

    def test_equivalent_load_renders_the_reference_life(self):
        """P of ISO 281 is made from such lives: for a 6205 with usual clearance within a fifth."""
        ball = bearing("6205")
        C, C0, f0 = ratings_of(ball)
        for Fr, Fa in ((1500.0, 0.0), (1000.0, 1000.0), (500.0, 1500.0)):
            P = equivalent_load(Fr, Fa, C0, f0=f0)
            assert (C / P) ** 3 == pytest.approx(rating_life(ball, (Fr, 0, Fa, 0, 0, 0)), rel=0.5)


class TestReferenceLife:
    # a commercial code, C = 23.4 kN (theory.md §4.5); 3e-4 is what its own digits of the deflections allow
    @pytest.mark.parametrize(
        ("ball", "load", "life"),
        [
            (ISO, (1000.0, 0, 0, 0, 0, 0), 13163.019),
            (ISO, (0, 0, 1000.0, 0, 0, 0), 2222.7318),
            (LOOSE, (1000.0, 0, 1000.0, 0, 0, 0), 1630.5367),
            (ISO, (0, 0, 0, 1.0, 0, 0), 785144.75),
        ],
    )
    def test_cases_of_iso_16281(self, ball, load, life):
        assert rating_life(ball, load, C=23400.0) == pytest.approx(life, rel=3e-4)

    def test_deflections_of_the_combined_case(self):
        q = replace(LOOSE, arm=43.5e-3 / 2).displacement((1000.0, 0, 1000.0, 0, 0, 0))
        assert q[[0, 2, 4]] * [1e6, 1e6, 1e3] == pytest.approx([19.5923, 146.4603, 2.6872], rel=1e-4)

    def test_the_arm_matters_under_a_moment_only(self):
        moment = (0, 0, 0, 1.0, 0, 0)
        assert rating_life(ISO, moment, arm="groove") != pytest.approx(rating_life(ISO, moment), rel=1e-3)
        radial = (1e3, 0, 0, 0, 0, 0)
        assert rating_life(ISO, radial, arm="groove") == pytest.approx(rating_life(ISO, radial), rel=1e-9)

    def test_life_of_a_uniform_load_is_that_of_its_thrust(self):
        """ISO 281's axial rating: with all balls alike both means are the load itself."""
        Q = np.full(7, 300.0)
        assert equivalent_ball_loads(ISO, Q, Q) == pytest.approx((300.0, 300.0), rel=1e-14)
        # life falls with the third power of the load
        assert life_of_loads(ISO, 2 * Q, C=23400.0) == pytest.approx(
            life_of_loads(ISO, Q, C=23400.0) / 8, rel=1e-12
        )

    def test_the_ring_that_turns_is_worn_alike_all_round(self):
        uneven = np.array([0, 100.0, 500.0, 900.0, 500.0, 100.0, 0])
        inner, outer = equivalent_ball_loads(ISO, uneven, uneven)
        assert outer > inner  # the mean of the higher power
        turned = equivalent_ball_loads(replace(ISO, turning="outer"), uneven, uneven)
        assert turned == pytest.approx((outer, inner), rel=1e-14)

    def test_no_load_lives_for_ever(self):
        assert life_of_loads(ISO, np.zeros(7)) == math.inf

    def test_thrust_example_of_harris(self):
        """T. A. Harris, 218 under 17.8 kN: 41.6° and 1676 N a ball; he reads his stiffness off a chart."""
        steel = Elastic(206.843e9, 0.3, 7850.0)
        ball = BallBearing(
            16, 22.23e-3, 125.26e-3, 0.5232, 0.5232, contact_angle=math.radians(40), material=steel,
            ball_material=steel,
        )  # fmt: skip
        found = load_distribution(ball, ball.displacement((0, 0, 17800.0, 0, 0, 0)))
        assert math.degrees(found.angle_inner[0]) == pytest.approx(41.6, rel=3e-3)
        assert found.load_inner == pytest.approx(1676, rel=3e-3)


class TestManyCases:
    @pytest.mark.parametrize("name", ["6205", "6312", "61908", "7205", "7014C"])
    def test_c_and_python_find_the_same_rest(self, name):
        """The twin is `minimum`, in NumPy; both stop at 1e-12 of the load."""
        ball = bearing(name)
        held = replace(ball, arm=ball.Dpw / 2)
        rng = np.random.default_rng(7)
        f = np.zeros((40, 6))
        C0 = ball.static_rating
        f[:, :2] = rng.normal(0, 0.1 * C0, (40, 2))
        thrust = 0.1 * C0 + 1.2 * np.hypot(f[:, 0], f[:, 1])
        f[:, 2] = thrust if ball.contact_angle else rng.normal(0, 0.05 * C0, 40)
        f[:, 3:5] = rng.normal(0, 0.001 * C0 * ball.Dpw, (40, 2))
        found = load_cases(ball, f)
        for case, q, Q, life in zip(f, found.q, found.ball_loads, found.life, strict=True):
            expected = held.displacement(case)
            # displacements are known to 1e-9 of the largest, where the ring is hardly held
            np.testing.assert_allclose(q, expected, rtol=0, atol=1e-8 * np.abs(expected).max())
            np.testing.assert_allclose(Q, held.ball_loads(expected), rtol=0, atol=1e-8 * Q.max())
            np.testing.assert_allclose(held.force(q), [*case[:5], 0], atol=1e-8 * np.abs(case).max())
            assert life == pytest.approx(rating_life(ball, case), rel=1e-7)

    def test_no_load_and_a_ball_on_the_load_line(self):
        found = load_cases(LOOSE, np.array([[0.0] * 6, [1e3, 0, 0, 0, 0, 0]]), C=23400.0)
        assert found.life[0] == math.inf
        assert not found.ball_loads[0].any()
        assert found.pressure[1] == pytest.approx(LOOSE.pressure(found.ball_loads[1].max()), rel=1e-12)

    def test_thrust_on_the_open_side_is_named(self):
        loads = np.array([[0, 0, 500.0, 0, 0, 0], [0, 0, -500.0, 0, 0, 0]])
        with pytest.raises(ValueError, match=r"^loads\[1\] is .*open side"):
            load_cases(bearing("7205"), loads)

    def test_loads_above_the_static_rating_are_named_once(self):
        """A 6205's rating is where its heaviest contact has 4.2 GPa; pressure grows with the cube root."""
        ball, loads = bearing("6205", clearance=0.0), np.zeros((3, 6))
        loads[:, 0] = np.array([0.5, 3.0, 2.0]) * ball.static_rating
        with pytest.warns(BearingWarning, match=r"^loads\[1\] is .*and 1 more cases above it") as caught:
            found = load_cases(ball, loads)
        assert len(caught) == 1
        # the rating takes 5/Z of the load for the heaviest ball, of 9 it has 4.37/Z
        assert found.pressure[1] / 4.2e9 == pytest.approx(3 ** (1 / 3), rel=0.06)

    @pytest.mark.parametrize("bad", [np.zeros(6), np.zeros((2, 5)), [[math.nan] * 6], "load"])
    def test_loads_of_another_shape_are_refused(self, bad):
        with pytest.raises(ValueError, match=r"^loads has the shape .*\(m, 6\)"):
            load_cases(ISO, bad)


class TestModifiedLife:
    # theory.md §4.5: continuous where the ranges of κ meet
    @pytest.mark.parametrize("kappa", [0.4, 1.0])
    def test_ranges_of_kappa_meet(self, kappa):
        below, above = (life_factor(k, 0.5, 1000.0, 5000.0) for k in (kappa * (1 - 1e-9), kappa))
        assert below == pytest.approx(above, rel=3e-3)

    def test_the_formula_by_hand(self):
        """ISO 281:2007, eq 32 at κ = 1; without a clean oil it ends at a tenth."""
        assert life_factor(1.0, 0.1, 1000.0, 1000.0) == pytest.approx(
            0.1 * (1 - 0.5684**0.83 * 0.1 ** (1 / 3)) ** -9.3, rel=1e-12
        )
        assert life_factor(0.1, 0.0, 1000.0, 1000.0) == pytest.approx(0.1, rel=1e-12)

    def test_more_film_less_dirt_and_less_load_live_longer(self):
        base = life_factor(1.0, 0.5, 500.0, 3000.0)
        assert life_factor(2.0, 0.5, 500.0, 3000.0) > base
        assert life_factor(1.0, 0.8, 500.0, 3000.0) > base
        assert life_factor(1.0, 0.5, 500.0, 2000.0) > base
        assert life_factor(1.0, 0.5, 500.0, 1.0) == 50.0
        assert life_factor(9.0, 0.5, 500.0, 3000.0) == life_factor(4.0, 0.5, 500.0, 3000.0)

    def test_reference_viscosity_of_iso_281(self):
        # 45000 n^-.83 Dpw^-.5 and 4500 n^-.5 Dpw^-.5, which meet at 1000 rpm within 3 %
        assert reference_viscosity(3000 * RPM, 0.0725) == pytest.approx(9.649e-6, rel=1e-3)
        assert reference_viscosity(500 * RPM, 0.1) == pytest.approx(25.88e-6, rel=1e-3)

    def test_reliability_and_fatigue_limit(self):
        assert [reliability_factor(r) for r in (90, 95, 99)] == [1.0, 0.64, 0.25]
        assert 0.64 < reliability_factor(93) < 1
        # SKF prints Pu = 1.34 kN for the 6309 with C0 = 31.5 kN; the standard's rule is simple
        assert fatigue_limit(31500.0, 0.0725) == pytest.approx(1340, rel=0.08)
        assert fatigue_limit(1e5, 0.4) == pytest.approx(1e5 / 22 / 2, rel=1e-12)

    def test_contamination_by_word_and_by_number(self):
        assert [contamination_factor(w, 0.05) for w in CONTAMINATION] == sorted(
            (low for low, _ in CONTAMINATION.values()), reverse=True
        )
        assert contamination_factor(0.3, 0.05) == 0.3

    def test_life_in_an_oil(self):
        ball = entry("6309")
        found = modified_life(
            169.0, 10e3, C0=31500.0, Dpw=ball.Dpw, speed=3000 * RPM, viscosity=20e-6, contamination=0.8
        )
        assert found.kappa == pytest.approx(20 / 9.65, rel=0.01)
        assert found.revolutions == pytest.approx(169 * found.factor, rel=1e-12)
        assert found.hours == pytest.approx(found.revolutions * 1e6 / 3000 / 60, rel=1e-12)

    @pytest.mark.parametrize(
        ("change", "message"),
        [
            ({"viscosity": 0.5e-6}, r"^kappa is 0\.05.*ISO 281 has no a_ISO below 0\.1"),
            ({"contamination": 1.2}, r"^contamination is 1\.2; e_C must lie in 0\.\.1"),
            ({"contamination": -0.1}, "^contamination is "),
            ({"contamination": "normal clean"}, "^contamination is .*did you mean 'normal cleanliness'"),
            ({"speed": 0.0}, "^speed is 0.0; it must not be zero"),
            ({"reliability": 99.9}, r"^reliability is 99\.9; it must lie in 90\.\.\.99 %"),
            ({"viscosity": math.nan}, "^viscosity is nan"),
        ],
    )
    def test_bad_input_is_named(self, change, message):
        given = {"C0": 31500.0, "Dpw": 0.0725, "speed": 3000 * RPM, "viscosity": 20e-6, **change}
        with pytest.raises(ValueError, match=message):
            modified_life(169.0, 10e3, **given)


class TestDutyCycles:
    def test_one_phase_is_its_own_life(self):
        assert equivalent_life([Phase(3.0, 100.0, 50.0)]) == pytest.approx((50.0, in_hours(50.0, 100.0)))

    def test_miners_rule_by_hand(self):
        """Half the time at 1000 rpm with 100 Mrev, half at 3000 rpm with 60 Mrev."""
        revolutions, hours = equivalent_life([Phase(1, 1000 * RPM, 100.0), Phase(1, 3000 * RPM, 60.0)])
        assert revolutions == pytest.approx(1 / (0.25 / 100 + 0.75 / 60), rel=1e-12)
        assert hours == pytest.approx(revolutions * 1e6 / 2000 / 60, rel=1e-12)

    def test_a_pause_wears_nothing(self):
        _, hours = equivalent_life([Phase(1, 100.0, 50.0), Phase(1, 0.0, 50.0)])
        assert hours == pytest.approx(2 * in_hours(50.0, 100.0), rel=1e-12)
        assert equivalent_life([Phase(1, 0.0, 5.0)]) == (math.inf, math.inf)

    @pytest.mark.parametrize("bad", [[], [Phase(0.0, 1.0, 1.0)], [Phase(1.0, 1.0, math.nan)]])
    def test_bad_phases_are_named(self, bad):
        with pytest.raises(ValueError, match=r"^phases"):
            equivalent_life(bad)


SIZE = {"bore": 0.025, "outside": 0.052, "C0": 7850.0}
USUAL = {"radial": 500.0, "axial": 0.0, "speed": 300.0, "viscosity": 32e-6, **SIZE}
LIFE = {"C0": 7850.0, "Dpw": 39e-3, "speed": 300.0, "viscosity": 20e-6}


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: friction(**{**USUAL, "C0": 7.85}), "is it in kN"),
        (lambda: friction(**{**USUAL, "bore": 25, "outside": 52}), "is it in mm"),
        (lambda: friction(**{**USUAL, "speed": 9e4}), "speed"),
        (lambda: friction(**{**USUAL, "contact_angle": 15.0}), "is it in degrees"),
        (lambda: friction(**{**USUAL, "radial": 40e3}), "above the static rating"),
        (lambda: modified_life(1e3, 500.0, **{**LIFE, "Dpw": 39}), "is it in mm"),
        (lambda: modified_life(1e3, 500.0, **{**LIFE, "C0": 7.85}), "is it in kN"),
        (lambda: modified_life(1e3, 500.0, **{**LIFE, "speed": 9e4}), "speed"),
        (lambda: modified_life(1e3, 15e3, **LIFE), "above the static rating"),
        (lambda: equivalent_load(500.0, 100.0, 7.85, f0=14.0), "is C0 in kN"),
        (lambda: equivalent_load(500.0, 100.0, 7850.0, contact_angle=15.0, f0=14.0), "is it in degrees"),
        (lambda: equivalent_static_load(500.0, 100.0, 15.0), "is it in degrees"),
        (lambda: iso_ratings(9, 7.94, 39.04), "is it in mm"),
        (lambda: iso_ratings(9, 7.94e-3, 39.04e-3, 25.0), "is it in degrees"),
        (lambda: in_hours(1e3, 9e4), "is it in rpm"),
        (lambda: life_of_loads(ISO, [0, 100.0, 500.0, 800.0, 500.0, 100.0, 0], C=23.4), "is it in kN"),
        (lambda: rating_life(ISO, [0, 1e3, 0, 0, 0, 0], C=23.4), "is it in kN"),
        (lambda: load_cases(ISO, [[0, 1e3, 0, 0, 0, 0]], C=23.4), "is it in kN"),
    ],
)
def test_what_a_rating_is_asked_with_in_another_unit_is_told_of(call, message):
    with warnings.catch_warnings():
        warnings.simplefilter("error", Notice)
        with pytest.raises((ValueError, Notice), match=message):
            call()


def test_what_is_usual_passes_without_a_word():
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        friction(**USUAL)
        friction(**{**USUAL, "radial": 0.0})
        modified_life(1e3, 500.0, **LIFE)
        equivalent_load(500.0, 100.0, 7850.0, f0=14.0)
        rating_life(ISO, [0, 1e3, 0, 0, 0, 0], C=20e3)
