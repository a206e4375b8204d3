"""Viscosity and film thickness against published constants and hand-made references."""

from __future__ import annotations

import math

import pytest

from bearingdyn.bearing.film_thickness import dimensionless_film, hamrock_dowson, nijenbanning_venner_moes
from bearingdyn.bearing.hertz import PointContact
from bearingdyn.bearing.lubricant import Lubricant, Walther
from bearingdyn.bearing.pressure_viscosity import barus, roelands, roelands_exponent, wooster

CONTACT = PointContact(Rx=4e-3, Ry=80e-3, modulus=115e9)


def test_vg32_constants_and_viscosity():
    # theory.md §2, printed digits
    oil = Walther.from_two_points(40.0, 32e-6, 100.0, 5.4e-6)
    assert oil.A == pytest.approx(9.53082, abs=5e-6)
    assert oil.B == pytest.approx(3.74658, abs=5e-6)
    assert oil.viscosity(70.0) == pytest.approx(11.186e-6, abs=5e-10)
    assert Walther.iso_vg(32) == oil


@pytest.mark.parametrize("grade", [10, 32, 100, 220])
def test_grade_is_the_viscosity_at_forty_degrees(grade):
    # ISO 3448 defines it so; two logarithms and back
    assert Walther.iso_vg(grade).viscosity(40.0) == pytest.approx(grade * 1e-6, rel=1e-12)


@pytest.mark.parametrize(
    ("M", "L", "H"), [(10, 1, 2.042), (100, 5, 3.055), (100, 10, 4.497), (1000, 10, 4.035)]
)
def test_circular_film_of_nijenbanning_venner_and_moes(M, L, H):
    # theory.md §2, four printed digits
    assert dimensionless_film(M, L, 1.0) == pytest.approx(H, abs=5e-4)


@pytest.mark.parametrize("Ry", [4e-3, 12e-3, 80e-3])
def test_film_formulas_agree_in_the_elastic_piezoviscous_regime(Ry):
    # fits to different computed films: they differ by up to a quarter, while mistaking the mean speed for the
    # sum would change the ratio by 2^.67 = 1.59
    contact, (F, eta0, alpha, u) = PointContact(4e-3, Ry, 115e9), (100.0, 0.03, 2e-8, 2.0)
    ratio = (
        nijenbanning_venner_moes(contact, F, 2 * u, eta0, alpha)
        / hamrock_dowson(contact, F, u, eta0, alpha).central
    )
    assert 0.75 < ratio < 1.25


def test_hamrock_dowson_by_hand():
    # circular contact, E' = 2e11, U = 1e-11, G = 5000, W = 1e-6 put into the printed formula:
    # 2.69·1e-11^.67·5000^.53·1e-6^−.067·(1 − .61e^−.73) by logarithms
    contact = PointContact(0.01, 0.01, 1e11)
    film = hamrock_dowson(contact, F=1e-6 * 2e11 * 1e-4, u=1.0, eta0=1e-11 * 2e11 * 0.01, alpha=5000 / 2e11)
    central = 10 ** (
        math.log10(2.69) - 11 * 0.67 + 0.53 * math.log10(5000) + 6 * 0.067 + math.log10(1 - 0.61 * 0.4819090)
    )
    least = 10 ** (
        math.log10(3.63) - 11 * 0.68 + 0.49 * math.log10(5000) + 6 * 0.073 + math.log10(1 - 0.5066170)
    )
    # e^−.73 and e^−.68 above carry seven digits
    assert film.central == pytest.approx(0.01 * central, rel=1e-6)
    assert film.minimum == pytest.approx(0.01 * least, rel=1e-6)


def test_film_scales_with_speed_as_the_exponent_says():
    one, two = (hamrock_dowson(CONTACT, 100.0, u, 0.03, 2e-8) for u in (1.0, 2.0))
    assert two.central / one.central == pytest.approx(2**0.67, rel=1e-13)
    assert two.minimum / one.minimum == pytest.approx(2**0.68, rel=1e-13)


@pytest.mark.parametrize(("M", "D"), [(0.3, 1.0), (0.5, 0.3)])
def test_lightly_loaded_film_is_rigid_and_isoviscous(M, D):
    # L → 0, M small: H → H_RI, into which the elastic film, below H_00 = 1.8/D, blends as (H_00/H_RI)^{3/2}
    rigid = 145 * (1 + 0.796 * D ** (14 / 15)) ** (-15 / 7) / (D * M**2)
    assert dimensionless_film(M, 1e-9, D) == pytest.approx(rigid, rel=(1.8 / D / rigid) ** 1.5)


@pytest.mark.parametrize("D", [1.0, 0.3, 0.01])
def test_film_asymptotes_of_the_elastic_regimes(D):
    # Nijenbanning, Venner & Moes (1994), printed in theory.md §2; far out the other regimes add below 0.5 %
    phi = 1 + 0.006 * math.log(D) + 0.63 * math.pow(D, 4 / 7)
    isoviscous = 3.18 / (phi ** (14 / 25) * D ** (1 / 15) * 1e6 ** (2 / 15))
    piezoviscous = 1.48 * 100**0.75 / (phi ** (7 / 20) * D ** (1 / 24) * 1e9 ** (1 / 12))
    assert dimensionless_film(1e6, 1e-9, D) == pytest.approx(isoviscous, rel=5e-3)
    assert dimensionless_film(1e9, 100.0, D) == pytest.approx(piezoviscous, rel=5e-3)


def test_barus_and_roelands_share_their_slope_at_ambient_pressure():
    eta0, alpha = 0.03, 2.2e-8
    z = roelands_exponent(eta0, alpha)
    p = 1.0  # Pa: second order in αp is below 1e-15
    assert math.log(barus(eta0, alpha, p) / eta0) == pytest.approx(alpha * p, rel=1e-7)
    assert math.log(roelands(eta0, z, p) / eta0) == pytest.approx(alpha * p, rel=1e-7)


def test_alpha_of_a_mineral_oil_follows_its_viscosity():
    oil, known = Lubricant(Walther.iso_vg(32)), Lubricant(Walther.iso_vg(32), alpha=2.2e-8)
    # by hand: .6 + .965 lg 27.2, ν of 32 mm²/s and 850 kg/m³
    assert oil.pressure_coefficient(40.0) == pytest.approx(1.9842e-8, rel=1e-4)
    assert oil.pressure_coefficient(100.0) < oil.pressure_coefficient(70.0) < 1.6e-8
    assert known.pressure_coefficient(70.0) == 2.2e-8
    p = 1e4
    rise = math.log(oil.viscosity(70.0, p) / oil.viscosity(70.0)) / p
    assert rise == pytest.approx(oil.pressure_coefficient(70.0), rel=1e-4)
    with pytest.raises(ValueError, match=r"eta0 is 0.0002.*give alpha"):
        wooster(2e-4)


def test_roelands_stays_far_below_barus_at_contact_pressure():
    oil = Lubricant(Walther.iso_vg(32), density=870.0, alpha=2e-8)
    assert oil.viscosity(40.0) == pytest.approx(32e-6 * 870.0, rel=1e-12)
    # published by hand: ln η = −9.67 + (ln η0 + 9.67)(1 + 1e9/1.96e8)^z, z = 2e-8·1.96e8/(ln .02784 + 9.67)
    span = math.log(32e-6 * 870.0) + 9.67
    expected = math.exp(-9.67 + span * (1 + 1e9 / 1.96e8) ** (2e-8 * 1.96e8 / span))
    assert oil.viscosity(40.0, 1e9) == pytest.approx(expected, rel=1e-12)
    assert oil.viscosity(40.0, 1e9) < 1e-2 * oil.viscosity(40.0, 1e9, "barus")


@pytest.mark.parametrize(
    ("call", "field"),
    [
        (lambda: Walther.from_two_points(100.0, 32e-6, 40.0, 5e-6), "T1, T2"),
        (lambda: Walther.from_two_points(40.0, 5e-6, 100.0, 32e-6), "nu1, nu2"),
        (lambda: Walther.from_two_points(40.0, math.nan, 100.0, 5e-6), "nu1"),
        (lambda: Walther.from_two_points(-300.0, 32e-6, 100.0, 5e-6), "T1"),
        (lambda: Walther.iso_vg(33), "grade"),
        (lambda: Walther(9.5, -1.0), "B"),
        (lambda: Lubricant(Walther.iso_vg(32), density=0.0), "density"),
        (lambda: Lubricant(Walther.iso_vg(32), alpha=math.nan), "alpha"),
        (lambda: Lubricant(Walther.iso_vg(32)).viscosity(40.0, -1.0), "p"),
        (lambda: Lubricant(Walther.iso_vg(32)).viscosity(40.0, 0.0, "reynolds"), "law"),
        (lambda: hamrock_dowson(CONTACT, 0.0, 1.0, 0.03, 2e-8), "F"),
        (lambda: hamrock_dowson(CONTACT, 1.0, -1.0, 0.03, 2e-8), "u"),
        (lambda: nijenbanning_venner_moes(CONTACT, 1.0, math.nan, 0.03, 2e-8), "us"),
        (lambda: nijenbanning_venner_moes(PointContact(0.1, 0.01, 1e11), 1.0, 1.0, 0.03, 2e-8), "Rx"),
        (lambda: dimensionless_film(10.0, 1.0, 1.5), "D"),
    ],
)
def test_bad_input_names_its_field(call, field):
    with pytest.raises(ValueError, match=rf"^(.*\.)?{field} is "):
        call()
