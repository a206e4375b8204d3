"""The hints of a refusal: the unit that was meant, of the number given, and what to write instead."""

from __future__ import annotations

import math

import pytest

import bearingdyn as bd
from bearingdyn.notice import StrainedLayer, UnusualMagnitude
from bearingdyn.plausible_ranges import check_gyration, check_speed_value


def test_an_unbalance_in_g_mm_is_given_back_in_kg_m() -> None:
    """The eccentricity follows from it, and is nothing that anybody gives."""
    app = bd.Application()
    app.add("rotor", bd.RigidBody(12.4, (0.1, 0.1, 0.05), rotating=True))
    app.ground("rotor.centre", [1e6] * 6)
    app.unbalance("rotor.centre", 50.0)
    with pytest.raises(ValueError, match=r"is the unbalance in g mm\? give 5e-05 kg m$"):
        bd.modes(app, count=1)


def test_an_inertia_in_kg_mm2_is_given_back_in_kg_m2() -> None:
    """0.02 kg m² of 4 kg, given as 20000."""
    with pytest.raises(ValueError, match=r"is the inertia in kg mm²\? give 0\.02 kg m²$"):
        check_gyration("inertia", 2e4, 4.0)


def test_a_speed_in_rpm_is_given_back_in_rad_per_s() -> None:
    """9000 rpm on a pitch diameter of 46 mm, given as rad/s, are 4e6 mm/min."""
    with pytest.warns(
        UnusualMagnitude, match=r"9000 rad/s, 85943\.7 rpm; n·dm.*give 942\.478 rad/s, or rpm=9000$"
    ):
        check_speed_value("speed", 9000.0, 0.046)


@pytest.mark.parametrize(("rpm", "pitch"), [(24000.0, 0.054), (60000.0, 0.022), (13000.0, 0.046)])
def test_speeds_that_bearings_run_at_are_silent(
    rpm: float, pitch: float, recwarn: pytest.WarningsRecorder
) -> None:
    """Spindles of 54 and 22 mm pitch diameter, and a 6206 at its limit in grease."""
    check_speed_value("speed", rpm * math.pi / 30, pitch)
    assert not recwarn.list


@pytest.mark.parametrize(
    ("rpm", "pitch"), [(26000.0, 0.0285), (16000.0, 0.0445), (36000.0, 0.018), (8500.0, 0.070)]
)
def test_deep_groove_bearings_at_their_makers_limits_in_oil_are_silent(
    rpm: float, pitch: float, recwarn: pytest.WarningsRecorder
) -> None:
    """NSK's catalogue of open bearings: 6203, 6305, 6000, 6210."""
    check_speed_value("speed", rpm * math.pi / 30, pitch, groove=True)
    assert not recwarn.list


def test_a_deep_groove_bearing_beyond_its_makers_limit_is_doubted() -> None:
    """3000 rad/s on a 6203, meant as 3000 rpm; its maker allows 26 000 rpm."""
    app = bd.Application()
    app.add("shaft", bd.Shaft([bd.Section(0.2, 0.017)], {"a": 0.02, "b": 0.18}))
    for place in ("a", "b"):
        app.bearing(
            place, bd.catalogue.bearing("6203", clearance=8e-6), inner=f"shaft.{place}", outer="ground"
        )
    app.load("shaft.a", (0, -100.0, 50.0, 0, 0, 0))
    state = bd.equilibrium(app)
    with pytest.warns(
        UnusualMagnitude, match=r"bearing 'a': speed is 3000 rad/s, 28647\.9 rpm; n·dm.*or rpm=3000$"
    ):
        bd.modes(state, speed=3000.0, count=1)


def test_places_in_mm_are_named() -> None:
    """Of a seat, and of a disc that is on no shaft yet."""
    with pytest.raises(ValueError, match=r"is it in mm\? give 0\.03 m$"):
        bd.Shaft([bd.Section(0.2, 0.03)], {"a": 30.0})
    with pytest.raises(ValueError, match=r"Disc z is 250 m; .*is it in mm\? give 0\.25 m"):
        bd.Disc(250.0, 1.0, 1e-3, 2e-3)


def test_a_designation_is_sent_to_the_catalogue() -> None:
    """Instead of four arguments that are missing."""
    with pytest.raises(ValueError, match=r"bd\.catalogue\.bearing\('6206'\)"):
        bd.BallBearing("6206")  # type: ignore[call-arg, arg-type]


def test_an_overlap_of_the_whole_radius_is_written_out() -> None:
    """As 100 %, not as 1e+02 %."""
    app = bd.Application()
    rubber = bd.Maxwell(G0=1e6, G=[1e6], tau=[1e-3], K=2e9, density=1150.0)
    app.add("inside", bd.Layer(0.02, 0.04, 0.02, rubber))
    app.add("around", bd.Layer(0.02, 0.03, 0.02, rubber))
    with pytest.raises(ValueError, match=r"overlap of 20 mm, 100 % of the radius"):
        app.connect("inside.outer", "around.inner")


def test_a_layer_squeezed_through_is_told_no_share() -> None:
    """Beyond half its thickness a correction of the linear stiffness says nothing."""
    app = bd.Application()
    rubber = bd.Maxwell(G0=1e4, G=[1e4], tau=[1e-3], K=2e9, density=1150.0)
    app.add("rotor", bd.RigidBody(40.0, (0.1, 0.1, 0.05)))
    app.add("layer", bd.Layer(0.02, 0.024, 0.01, rubber))
    app.connect("rotor.centre", "layer.inner", fits=False)
    app.ground("layer.outer")
    app.gravity((0, -9.81, 0))
    with pytest.warns(StrainedLayer, match=r"says nothing of such a state") as caught:
        bd.equilibrium(app)
    assert not any("% low" in str(one.message) for one in caught)
