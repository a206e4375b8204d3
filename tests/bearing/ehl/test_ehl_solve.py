"""The contact in SI units."""

from __future__ import annotations

import dataclasses
import math

import numpy as np
import pytest

from bearingdyn.bearing import Lubricant, PointContact, Walther, ehl
from bearingdyn.bearing.ehl.dimensionless_groups import scales

OIL = Lubricant(Walther.iso_vg(32), alpha=2.2e-8)
CONTACT = PointContact(Rx=2.5e-3, Ry=0.03, modulus=1.1e11)


@pytest.fixture(scope="module")
def solved() -> ehl.LubricatedContact:
    return ehl.solve(CONTACT, OIL, 10.0, 3.0, 60.0, accuracy=0.05)


def test_one_m_and_l_from_other_contacts_is_one_answer(solved: ehl.LubricatedContact) -> None:
    # twice as large in every direction, four times the load at the same pressure, the same η0us/(E′Rx)
    larger = PointContact(Rx=2 * CONTACT.Rx, Ry=2 * CONTACT.Ry, modulus=CONTACT.modulus)
    other = ehl.solve(larger, OIL, 40.0, -6.0, 60.0, accuracy=0.05)
    assert (other.M, other.L, other.D) == pytest.approx((solved.M, solved.L, solved.D), rel=1e-14)
    # round-off of M and L, times the condition of the figures
    assert tuple(other.steady.figures) == pytest.approx(tuple(solved.steady.figures), rel=1e-9)
    assert other.hc == pytest.approx(2 * solved.hc, rel=1e-9)
    assert other.h0 == pytest.approx(2 * solved.h0, rel=1e-9)
    # c ~ F/δ · a/us: 4/2 · 2/2
    assert other.c0 == pytest.approx(2 * solved.c0, rel=1e-9)


def test_force_law_gives_the_load_back(solved: ehl.LubricatedContact) -> None:
    assert CONTACT.kappa * (solved.delta + solved.h0) ** 1.5 == pytest.approx(10.0, rel=1e-12)
    assert 0 < solved.hmin < solved.hc < 2 * solved.h0
    assert solved.film.min() == pytest.approx(solved.hmin, rel=0.1)
    # the pressure carries the load
    dx, dy = np.diff(solved.x)[0], np.diff(solved.y)[0]
    assert solved.pressure.sum() * dx * dy == pytest.approx(10.0, rel=1e-9)


def test_stiffness_in_si_at_low_frequency_is_k0_and_c0(solved: ehl.LubricatedContact) -> None:
    f = 1.0
    k = complex(solved.stiffness(f))
    assert k.real == pytest.approx(solved.k0, rel=1e-5)
    assert k.imag / (2 * math.pi * f) == pytest.approx(solved.c0, rel=1e-4)
    # dF/dδ of the force law, which takes the film as given: above k0 by the film's own give
    law = 1.5 * CONTACT.kappa * (solved.delta + solved.h0) ** 0.5
    assert 0.9 * law < solved.k0 < law


def test_viscous_limit_is_where_the_damping_has_changed_by_a_tenth(solved: ehl.LubricatedContact) -> None:
    limit = solved.viscous_limit
    assert 1e3 < limit < 1e5
    k = complex(solved.stiffness(limit))
    assert k.imag / (2 * math.pi * limit) == pytest.approx(
        0.9 * solved.c0, rel=0.01
    )  # one grid, not extrapolated


def test_damping_hardly_depends_on_load(solved: ehl.LubricatedContact) -> None:
    heavier = ehl.solve(CONTACT, OIL, 20.0, 3.0, 60.0, accuracy=0.05)
    assert heavier.c0 == pytest.approx(solved.c0, rel=0.03)  # M^−.01


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"us": 0.0}, "us is 0.0; without speed there is no film"),
        ({"us": math.nan}, "us is nan"),
        ({"us": "3"}, "us is '3'; it must be a finite speed"),
        ({"grid": 17, "F": 200.0}, r"grid is 17; too coarse .*; give \d+ or more"),
        ({"F": 0.0}, "F is 0.0"),
        ({"temperature": 400.0}, "T is 400.0; outside the viscosity law"),
        ({"contact": 3.0}, "contact is 3.0"),
        ({"contact": PointContact(1e-2, 1e-3, 1e11)}, r"contact.Rx is 0.01; it must not exceed Ry"),
        ({"lubricant": "oil"}, "lubricant is 'oil'"),
        ({"F": 1e7}, r"M is .* must lie in"),
        ({"lubricant": dataclasses.replace(OIL, alpha=2e-7)}, r"L is .* must lie in 0\.\.30"),
    ],
)
def test_bad_input_is_named(change: dict[str, object], message: str) -> None:
    given = {"contact": CONTACT, "lubricant": OIL, "F": 10.0, "us": 3.0, "temperature": 60.0}
    with pytest.raises(ValueError, match=message):
        ehl.solve(**{**given, **change})


def test_scales_are_those_of_the_film_formulas() -> None:
    M, L, D = scales(CONTACT, 10.0, 3.0, 0.02, 2e-8)
    speed = 0.02 * 3.0 / (2.2e11 * 2.5e-3)
    assert pytest.approx(10.0 / (2.2e11 * 2.5e-3**2) / speed**0.75) == M
    assert pytest.approx(2e-8 * 2.2e11 * speed**0.25) == L
    assert pytest.approx(1 / 12) == D
