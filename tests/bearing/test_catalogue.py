"""The catalogue: what each bearing must fit, and that it carries its load."""

from __future__ import annotations

import math

import numpy as np
import pytest

from bearingdyn.bearing.catalogue import CATALOGUE, ESTIMATE, bearing, entry, estimate, from_entry

SOURCED = [name for name, e in CATALOGUE.items() if e.source != ESTIMATE]


def made(name: str):
    return bearing(name, clearance=None if CATALOGUE[name].contact_angle else 10e-6)


def test_lists_five_series():
    assert len(CATALOGUE) >= 40
    assert {name[:2] for name in CATALOGUE} == {"60", "62", "63", "70", "72"}
    # ISO 15: the last two digits are a fifth of the bore from 20 mm on
    for name, e in CATALOGUE.items():
        if int(name[2:]) >= 4:
            assert e.bore == pytest.approx(5e-3 * int(name[2:]), rel=1e-12)


@pytest.mark.parametrize("name", CATALOGUE)
def test_fits_inside_its_boundary(name):
    e = entry(name)
    assert e.source
    # a ring keeps at least a tenth of the section under the groove, and the ball stays inside the width
    section = (e.outside - e.bore) / 2
    assert (e.Dpw - e.Dw - e.bore) / 2 >= 0.1 * section
    assert (e.outside - e.Dpw - e.Dw) / 2 >= 0.1 * section
    assert e.Dw < e.width
    # neighbours stand apart by their chord less a ball
    assert e.Dpw * math.sin(math.pi / e.Z) > 1.02 * e.Dw


@pytest.mark.parametrize("name", CATALOGUE)
def test_finds_its_equilibrium_from_a_thousandth_to_all_of_its_rating(name):
    brg = made(name)
    C0 = brg.static_rating
    radial, axial = np.array([1.0, 0, 0, 0, 0, 0]), np.array([0, 0, 1.0, 0, 0, 0])
    scale = np.array([1, 1, 1, brg.arm, brg.arm, 1])
    for direction in (radial, axial, 0.8 * radial + 0.6 * axial):
        for share in (1e-3, 0.03, 0.3, 1.0):
            f = share * C0 * direction
            q = brg.displacement(f, 0.1)
            # 1e-12 of the load, or round-off of distances at the lightest
            np.testing.assert_allclose(brg.force(q, 0.1) / scale, f / scale, rtol=0, atol=1e-8 * share * C0)


@pytest.mark.parametrize("name", SOURCED)
def test_rule_gives_what_the_sources_have(name):
    e = CATALOGUE[name]
    rule = estimate(e.bore, e.outside, e.width)
    # the filling arc is made from the sources' own diameters; a ball a little smaller may add one
    assert 1 + math.floor(math.radians(196) / (2 * math.asin(e.Dw / e.Dpw))) == e.Z
    assert abs(rule.Z - e.Z) <= 1
    # the largest difference is that of the 209 of Harris, 12.7 mm
    assert rule.Dw == pytest.approx(e.Dw, rel=0.07)
    assert rule.Dpw == pytest.approx(e.Dpw, rel=0.02)
    assert rule.source == ESTIMATE


def test_estimate_becomes_a_bearing():
    brg = from_entry(estimate(60e-3, 110e-3, 22e-3), clearance=12e-6)
    assert brg.clearance == 12e-6
    angled = from_entry(estimate(60e-3, 95e-3, 18e-3, kind="angular contact", contact_angle=0.44))
    assert angled.contact_angle == 0.44
    # no filling slot: more balls than a deep groove bearing of the same size
    assert angled.Z > estimate(60e-3, 95e-3, 18e-3).Z


@pytest.mark.parametrize(
    ("call", "field"),
    [
        (lambda: estimate(0.0, 0.03, 0.01), "bore"),
        (lambda: estimate(0.03, 0.03, 0.01), "outside"),
        (lambda: estimate(0.03, 0.0305, 0.01), "outside"),
        (lambda: estimate(0.03, 0.06, math.nan), "width"),
        (lambda: estimate(0.03, 0.06, 0.01, kind="roller"), "kind"),
        (lambda: estimate(0.03, 0.06, 0.01, contact_angle=0.3), "contact_angle"),
        (lambda: estimate(0.03, 0.06, 0.01, kind="angular contact"), "contact_angle"),
        (lambda: bearing("6205"), "clearance"),
        (lambda: bearing("7205", clearance=1e-5), "clearance"),
        (lambda: bearing("6999", clearance=1e-5), "designation"),
    ],
)
def test_bad_input_is_named(call, field):
    with pytest.raises(ValueError, match=f"^{field} is "):
        call()
