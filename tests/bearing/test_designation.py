"""Designations as people write them, and the clearances of ISO 5753."""

from __future__ import annotations

import math

import pytest

from bearingdyn.bearing.catalogue import CATALOGUE, bearing, entry
from bearingdyn.bearing.designation import CLEARANCE_CLASSES, clearance_range, read_designation
from bearingdyn.notice import PassedOver


@pytest.mark.parametrize(
    ("text", "number", "degrees", "group", "ignored"),
    [
        ("6205", "6205", None, "", ()),
        (6205, "6205", None, "", ()),
        ("6203-2RS/C3", "6203", None, "C3", ("2RS",)),
        ("62032RSC3", "6203", None, "C3", ("2RS",)),
        ("SKF 6203", "6203", None, "", ("SKF",)),
        ("6205 C4", "6205", None, "C4", ()),
        ("6305-2Z/C3WT", "6305", None, "C3", ("2Z", "WT")),
        ("6208/P63", "6208", None, "C3", ("P6",)),
        ("6205 P54", "6205", None, "C4", ("P5",)),
        ("fag 6310-c3", "6310", None, "C3", ("FAG",)),
        ("6805", "61805", None, "", ()),
        ("16008 CN", "16008", None, "CN", ()),
        ("61908-2RS1", "61908", None, "", ("2RS1",)),
        ("7014 ACD", "7014", 25, "", ()),
        ("7014 CD/P4A", "7014", 15, "", ("P4A",)),
        ("7014A5TRSULP4", "7014", 25, "", ("TRSULP4",)),
        ("B7014-E-T-P4S", "7014", 25, "", ("B", "T", "P4S")),
        ("7205 BEP", "7205", 40, "", ("P",)),
        ("7205A", "7205", 30, "", ()),
        ("7205 C3", "7205", None, "C3", ()),  # a class, not the letter of 15°
    ],
)
def test_every_sign_is_read_or_passed_over(text, number, degrees, group, ignored):
    read = read_designation(text)
    assert read.number == number
    assert read.clearance_class == group
    assert read.ignored == ignored
    if degrees is None:
        assert read.contact_angle is None
    else:
        assert math.degrees(read.contact_angle) == pytest.approx(degrees, abs=1e-9)


# SKF's and NSK's tables of radial internal clearance of deep groove bearings, µm
@pytest.mark.parametrize(
    ("bore", "group", "least", "most"),
    [
        (10, "CN", 2, 13),
        (17, "C3", 11, 25),
        (20, "CN", 5, 20),
        (25, "C3", 13, 28),
        (30, "C4", 23, 41),
        (40, "C2", 1, 11),
        (50, "C5", 45, 73),
        (60, "CN", 8, 28),
        (80, "C3", 25, 51),
        (100, "C4", 53, 84),
    ],
)
def test_clearances_are_those_of_iso_5753(bore, group, least, most):
    assert clearance_range(bore * 1e-3, group) == pytest.approx((least * 1e-6, most * 1e-6), rel=1e-12)


def test_clearance_grows_from_class_to_class_and_with_the_bore():
    for bore in (10, 15, 20, 30, 40, 50, 60, 80, 100, 120):
        ranges = [clearance_range(bore * 1e-3, group) for group in CLEARANCE_CLASSES]
        assert ranges == sorted(ranges)
        assert all(low < high for low, high in ranges)


def test_the_class_gives_the_mid_clearance():
    assert bearing("6205").clearance == pytest.approx(12.5e-6, rel=1e-12)
    assert bearing("6205 C4").clearance == pytest.approx(32e-6, rel=1e-12)
    with pytest.warns(PassedOver, match="C3, as clearance is given"):
        assert bearing("6205 C3", clearance=4e-6).clearance == 4e-6
    with pytest.warns(PassedOver, match="as the contact angle fixes the clearance"):
        bearing("7205 C3")


def test_what_is_passed_over_is_said_and_a_plain_number_is_silent(recwarn):
    bearing("6203")
    bearing("7014C")
    assert not recwarn.list
    with pytest.warns(PassedOver, match="'SKF 6203-2RS/C3' is read as 6203 with clearance C3; .*: SKF, 2RS$"):
        bearing("SKF 6203-2RS/C3")


def test_25_degrees_have_the_balls_of_15():
    inner, usual = entry("7014 ACD"), entry("7014C")
    assert (inner.Z, inner.Dw, inner.Dpw) == (usual.Z, usual.Dw, usual.Dpw)
    assert math.degrees(inner.contact_angle) == pytest.approx(25)
    assert "7014C" in inner.source
    assert inner.printed is None


def test_a_bare_number_has_the_usual_angle():
    assert CATALOGUE["7005"] == CATALOGUE["7005C"]
    assert CATALOGUE["7205"] == CATALOGUE["7205B"]
    assert CATALOGUE["7305"] == CATALOGUE["7305B"]


@pytest.mark.parametrize("unknown", ["6299", "6421", "7099C"])
def test_an_unknown_bearing_is_named_with_the_nearest(unknown):
    with pytest.raises(ValueError, match=rf"^designation is '{unknown}'; the nearest are \w+, \w+, \w+; "):
        bearing(unknown)


@pytest.mark.parametrize("unknown", ["NU205", "QJ 206", "63214-2RS", "22205"])
def test_a_bearing_of_another_series_is_named_with_the_nearest(unknown):
    with pytest.raises(ValueError, match=f"^designation is '{unknown}'; it must hold .*the nearest are [67]"):
        bearing(unknown)


@pytest.mark.parametrize("nonsense", ["", "ball", "62/22", "-2RS", None])
def test_what_holds_no_number_is_refused(nonsense):
    with pytest.raises(ValueError, match=r"^designation is .*must hold a number of the series"):
        read_designation(nonsense)


@pytest.mark.parametrize(("bore", "group"), [(0.0, "CN"), (math.nan, "CN"), (0.2, "CN"), (0.03, "C6")])
def test_no_clearance_outside_the_table(bore, group):
    with pytest.raises(ValueError, match=r"^(bore|group) is "):
        clearance_range(bore, group)


def test_a_designation_leads_to_its_lines():
    assert bearing("6205").lines(1797 * math.pi / 30)["BPFO"] == pytest.approx(107.36, abs=5e-3)


@pytest.mark.parametrize(
    "text", ["6205/HC5", "HC6205", "6205-2RSLTN9/HC5C3WT", "7014 CD/HCP4A", "6205 hybrid"]
)
def test_ceramic_balls_are_not_read_as_steel_nor_as_a_clearance(text):
    with pytest.raises(ValueError, match=r"means ceramic balls.*give ball_material"):
        read_designation(text)
