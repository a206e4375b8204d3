"""Hertz's point contact against published tables, limits and the defining equations in high precision."""

from __future__ import annotations

import math

import mpmath
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from bearingdyn.bearing.contact_damping import resultant_damping
from bearingdyn.bearing.geometry import Geometry
from bearingdyn.bearing.hertz import (
    PointContact,
    contact_modulus,
    ellipticity,
    race_contact,
    resultant_deflection_coefficient,
)
from bearingdyn.material import STEEL, Elastic

# T. A. Harris, Rolling Bearing Analysis: F(ρ), a*, b*, δ*
HARRIS = [
    (0.4795, 1.4556, 0.7278, 0.9429),
    (0.7948, 2.265, 0.5480, 0.7961),
    (0.90999, 3.233, 0.4499, 0.6636),
    (0.95738, 4.395, 0.3830, 0.5551),
    (0.983797, 6.448, 0.3150, 0.4352),
    (0.9989156, 17.974, 0.18822, 0.2106),
    (0.9998527, 37.38, 0.13050, 0.11995),
]


def contact_with(F: float, modulus: float = 1.0) -> PointContact:
    return PointContact(Rx=1.0, Ry=(1 + F) / (1 - F), modulus=modulus)


@pytest.mark.parametrize(("F", "a", "b", "delta"), HARRIS)
def test_harris_table(F, a, b, delta):
    contact = contact_with(F)
    assert contact.F_rho == pytest.approx(F, rel=1e-12)
    # the table's last printed digits, and those of its F, allow 4e-4
    assert contact.a_star == pytest.approx(a, rel=4e-4)
    assert contact.b_star == pytest.approx(b, rel=4e-4)
    assert contact.delta_star == pytest.approx(delta, rel=4e-4)


@given(st.floats(1e-9, 6.0))
def test_ellipticity_solves_harris_equation_in_forty_digits(log_chi):
    # F(ρ) = [(χ²+1)E − 2K]/[(χ²−1)E] is 0/0 at χ = 1: forty digits leave enough of it
    with mpmath.workdps(40):
        chi = mpmath.exp(mpmath.mpf(log_chi))
        K, E = mpmath.ellipk(1 - chi**-2), mpmath.ellipe(1 - chi**-2)
        F = ((chi**2 + 1) * E - 2 * K) / ((chi**2 - 1) * E)
        F_double, complement = float(F), float(1 - F)
    # a rounding of F by 1e-16 moves ln χ by 1e-16/(dF/d ln χ): ≈ 2(1 − F) when long, ¾ at the circle
    assert ellipticity(F_double) == pytest.approx(float(chi), rel=1e-14 + 4e-16 / complement)


def test_circular_contact_is_the_textbook_sphere_on_plane():
    R, E = 5e-3, 115e9
    contact = PointContact(R, R, E)
    assert contact.chi == 1.0
    # K. L. Johnson, Contact Mechanics (4.22)-(4.24) with R' = R: exact forms, so round-off only
    assert contact.kappa == pytest.approx(4 / 3 * E * math.sqrt(R), rel=1e-13)
    a, b = contact.semi_axes(10.0)
    assert a == pytest.approx((3 * 10.0 * R / (4 * E)) ** (1 / 3), rel=1e-13)
    assert a == pytest.approx(b, rel=1e-13)
    assert contact.pressure(10.0) == pytest.approx(
        (6 * 10.0 * E**2 / (math.pi**3 * R**2)) ** (1 / 3), rel=1e-13
    )
    assert contact.approach(10.0) == pytest.approx(a * a / R, rel=1e-13)


def test_stiffness_is_smooth_through_the_circle():
    # κ depends on the two radii symmetrically, so to second order in their ratio: no step at 0/0
    values = [
        PointContact(1.0, 1.0 + h, 1.0).kappa / (1 + h) ** 0.25 for h in (-1e-7, -1e-9, 0.0, 1e-9, 1e-7)
    ]
    assert np.ptp(values) < 1e-13


def test_swapping_the_radii_changes_nothing():
    one, other = PointContact(3e-3, 0.1, 1e11), PointContact(0.1, 3e-3, 1e11)
    assert one.kappa == other.kappa
    assert one.semi_axes(5.0) == other.semi_axes(5.0)


def test_pressure_integrates_to_the_load_and_inverts():
    contact = PointContact(3e-3, 0.1, 1.15e11)
    a, b = contact.semi_axes(500.0)
    # ∬ p√(1−x²/a²−y²/b²) = (2/3)πab p
    assert 2 / 3 * math.pi * a * b * contact.pressure(500.0) == pytest.approx(500.0, rel=1e-13)
    assert contact.load_at_pressure(contact.pressure(500.0)) == pytest.approx(500.0, rel=1e-12)
    assert contact.pressure(0.0) == 0.0


@pytest.mark.parametrize(
    ("geometry", "E", "expected"),
    [
        # theory.md §3.1 and §3.5, seven printed digits
        (Geometry(7, 11.5e-3, 43.5e-3, 0.52, 0.53, clearance=0.0), 210e9, 1.054911e10),
        (Geometry(8, 5.953e-3, 25e-3, 0.52, 0.53, clearance=10e-6), 207e9, 7.486282e9),
    ],
)
def test_resultant_deflection_coefficient(geometry, E, expected):
    steel = Elastic(E, 0.3, 7850.0)
    kappa = [race_contact(geometry, race, steel, steel).kappa for race in ("inner", "outer")]
    assert resultant_deflection_coefficient(*kappa) == pytest.approx(expected, rel=5e-7)


def test_races_curve_as_theory_says():
    # theory.md §2: Rx = (D/2)(1 ∓ γ), Ry = f D/(2f − 1); the outer race conforms, so is pressed less
    geometry = Geometry(8, 10e-3, 40e-3, 0.515, 0.53, contact_angle=0.5)
    inner, outer = (race_contact(geometry, race, STEEL, STEEL) for race in ("inner", "outer"))
    gamma = 0.25 * math.cos(0.5)
    assert inner.Rx == pytest.approx(5e-3 * (1 - gamma), rel=1e-14)
    assert outer.Rx == pytest.approx(5e-3 * (1 + gamma), rel=1e-14)
    assert inner.Ry == pytest.approx(0.515 * 10e-3 / 0.03, rel=1e-13)
    assert outer.Ry == pytest.approx(0.53 * 10e-3 / 0.06, rel=1e-13)
    with pytest.raises(ValueError, match="race is 'middle'"):
        race_contact(geometry, "middle", STEEL, STEEL)


def test_deflection_coefficient_of_the_209():
    # theory.md §3.4 prints five digits in N/mm^1.5
    steel = Elastic(206.843e9, 0.3, 7850.0)
    geometry = Geometry(9, 12.7e-3, 65e-3, 0.52, 0.52, clearance=15e-6)
    kappa = [race_contact(geometry, race, steel, steel).kappa for race in ("inner", "outer")]
    assert resultant_deflection_coefficient(*kappa) / 1e9**0.5 == pytest.approx(3.7011e5, rel=1.4e-5)


@settings(max_examples=50)
@given(st.floats(1e8, 1e12), st.floats(1e8, 1e12), st.floats(1.0, 1e4))
def test_contacts_in_series_share_the_load_and_add_their_approach(k1, k2, Q):
    total = (Q / k1) ** (2 / 3) + (Q / k2) ** (2 / 3)
    # powers of a few numbers: some ulps
    assert resultant_deflection_coefficient(k1, k2) * total**1.5 == pytest.approx(Q, rel=1e-13)


def test_equal_dampers_in_series_halve():
    # alike contacts share the motion equally: half the rate in each
    assert resultant_damping((8e9, 40.0), (8e9, 40.0)) == pytest.approx(20.0, rel=1e-14)
    # a contact too stiff to move dissipates nothing
    assert resultant_damping((8e9, 40.0), (8e18, 40.0)) == pytest.approx(40.0, rel=1e-5)
    with pytest.raises(ValueError, match="c is -1"):
        resultant_damping((8e9, 40.0), (8e9, -1.0))


def test_two_materials_add_their_compliances():
    ceramic = Elastic(310e9, 0.26, 3200.0)
    expected = 1 / ((1 - 0.3**2) / 210e9 + (1 - 0.26**2) / 310e9)
    assert contact_modulus(STEEL, ceramic) == pytest.approx(expected, rel=1e-15)
    geometry = Geometry(7, 11.5e-3, 43.5e-3, 0.52, 0.53, clearance=0.0)
    steel, hybrid = (race_contact(geometry, "inner", STEEL, ball) for ball in (STEEL, ceramic))
    # κ is proportional to E*: the geometry drops out
    assert hybrid.kappa / steel.kappa == pytest.approx(hybrid.modulus / steel.modulus, rel=1e-14)


@pytest.mark.parametrize("field", ["Rx", "Ry", "modulus"])
@pytest.mark.parametrize("value", [0.0, -1.0, math.nan, math.inf, "wide", None])
def test_bad_contact_is_refused_by_name(field, value):
    with pytest.raises(ValueError, match=field):
        PointContact(**{"Rx": 1.0, "Ry": 2.0, "modulus": 1e11, field: value})


@pytest.mark.parametrize("F", [-0.1, 1.0, math.nan])
def test_curvature_difference_outside_its_range_is_refused(F):
    with pytest.raises(ValueError, match="F is "):
        ellipticity(F)


def test_negative_load_is_refused():
    contact = PointContact(1e-3, 2e-3, 1e11)
    for ask in (contact.semi_axes, contact.pressure, contact.approach):
        with pytest.raises(ValueError, match="Q is -1"):
            ask(-1.0)
