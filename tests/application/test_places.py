"""Names of places and channels: what they say, and what is no name."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

import bearingdyn as bd
from bearingdyn.application import COMPONENTS, GROUND, QUANTITIES, Application, Channel, Place
from bearingdyn.bearing import Pair
from rotors import BEARING, motor, oscillator

WORD = st.text(st.characters(exclude_characters=".", exclude_categories=("Cs",)), min_size=1, max_size=8)


@given(WORD, WORD)
def test_a_place_gives_back_the_name_it_was_parsed_from(part, name):
    place = Place.parse(f"{part}.{name}")
    assert (place.part, place.name, str(place)) == (part, name, f"{part}.{name}")
    assert Place.parse(place) is place


def test_the_part_ends_at_the_first_dot():
    assert Place.parse("housing.bore.left") == Place("housing", "bore.left")


@pytest.mark.parametrize("text", ["", "shaft", ".", "shaft.", ".left", 5, None])
def test_what_names_no_place_is_refused_with_what_would_be_right(text):
    with pytest.raises(ValueError, match=r'names no place; it must be "part\.place".*"shaft\.left"'):
        Place.parse(text)


@given(
    WORD.filter(lambda w: w not in ("ground", "force", *QUANTITIES)),
    WORD.filter(lambda w: w not in ("force", *QUANTITIES)),
    st.sampled_from(COMPONENTS),
    st.sampled_from(["", "force", "reaction", *QUANTITIES]),
)
def test_a_channel_gives_back_its_name(part, name, component, quantity):
    channel = Channel(f"{part}.{name}", component, quantity)
    assert Channel.parse(str(channel)) == channel


@pytest.mark.parametrize(
    ("text", "site", "index", "unit"),
    [
        ("shaft.left.y", "shaft.left", 1, "m"),
        ("shaft.left.rx.velocity", "shaft.left", 3, "rad/s"),
        ("shaft.left.θz.acceleration", "shaft.left", 5, "rad/s²"),
        ("ground.z", "ground", 2, "m"),
        ("left.force.x", "left.force", 0, "N"),
        ("layer.inner.force.ry", "layer.inner.force", 4, "N m"),
        ("ground.block.feet.y", "ground.block.feet", 1, "N"),
        ("left.ball3", "left", None, None),
        ("left.loaded", "left", None, None),
    ],
)
def test_a_channel_knows_where_what_and_in_which_unit(text, site, index, unit):
    channel = Channel.parse(text)
    assert (channel.site, channel.index) == (site, index)
    if unit:
        assert (channel.force_unit if channel.is_force else channel.motion_unit()) == unit


def test_only_the_ground_moves_as_the_ground():
    assert Channel.parse("ground.y").of_ground
    assert not Channel.parse("ground.block.feet.y").of_ground  # a force
    assert str(GROUND) == "ground"


def test_names_are_taken_apart_by_the_two_classes_of_names_alone():
    package = Path(bd.__file__).parent
    # names of modules, of classes and of files are no names of places
    others = {"notice.py", "fingerprint.py", "results/provenance.py"}
    others |= {"fem/mesh_files/abaqus.py", "fem/mesh_files/abaqus_assembly.py"}
    apart = re.compile(r"""partition\(["']\.|split\(["']\.""")
    found = {
        path.relative_to(package).as_posix()
        for path in package.rglob("*.py")
        if apart.search(path.read_text(encoding="utf-8"))
    }
    assert found - others == {"application/place.py", "application/channel.py"}


# ------------------------------------------------------------------- wrong objects where names are meant


def test_a_set_needs_rigid_rings():
    pair = Pair(bd.catalogue.bearing("6205", clearance=1e-5), "DB", distance=0.015)
    app = Application()
    app.add("rotor", bd.RigidBody(1.0, (1e-3,) * 3))
    ring = bd.FlexibleRing(0.023, 0.026, 0.015, arm=pair.row.arm)
    app.add("ring", ring)
    with pytest.raises(
        ValueError, match=r"bearing 'p': ring\.raceway carries one row of balls, and a Pair has 2"
    ):
        app.bearing("p", pair, inner="rotor.centre", outer="ring.raceway")


@pytest.mark.parametrize(
    ("bearing", "message"),
    [
        ("6205", r"bearing 'p' is '6205'; .*bd\.catalogue\.bearing\('6205'\)"),
        (6205, r"bearing 'p' is 6205; .*bd\.catalogue\.bearing\('6205'\)"),
        ("skf", r"bearing 'p' is 'skf'; it must be a bd\.BallBearing"),
        (5, r"bearing 'p' is 5; it must be a bd\.BallBearing"),
        (None, r"bearing 'p' is None; it must be a bd\.BallBearing"),
        (bd.BallBearing, "bearing 'p' is the class BallBearing"),
        (Pair, "bearing 'p' is the class Pair"),
    ],
)
def test_what_is_no_bearing_is_refused_by_name(bearing, message):
    app = Application()
    app.add("rotor", bd.RigidBody(1.0, (1e-3,) * 3))
    with pytest.raises(ValueError, match=message):
        app.bearing("p", bearing, inner="rotor.centre", outer="ground")
    assert not app.plan.bearings


@pytest.mark.parametrize(
    ("part", "message"),
    [
        (5, r"part 'p' is 5; it must be a part, such as bd\.Shaft"),
        (None, "part 'p' is None"),
        (bd.Shaft, "part 'p' is <class"),
        (BEARING, r"part 'p' is a BallBearing; hang bearings between parts with app\.bearing"),
    ],
)
def test_what_is_no_part_is_refused_by_name(part, message):
    with pytest.raises(ValueError, match=message):
        Application().add("p", part)


def test_what_is_no_loose_fit_is_refused_by_name():
    app = motor()
    with pytest.raises(ValueError, match=r"fit 'f' is None; it must be a bd\.LooseFit"):
        app.fit("f", None, ring="ring.centre", bore="ground")


@pytest.mark.parametrize(
    ("ask", "field"),
    [
        (lambda s: bd.frequency_response(s, [1.0], "body.centre.y", ["body.centre.y"]), "inputs"),
        (lambda s: bd.frequency_response(s, [1.0], ["body.centre.y"], "body.centre.y"), "outputs"),
        (lambda s: bd.unbalance_response(s, [1.0], "body.centre.y"), "outputs"),
        (lambda s: bd.radiated_power(s, [1.0], "body.centre.y", ["body.outside"]), "inputs"),
        (lambda s: bd.transient(s, speed=0.0, dt=1e-4, steps=1, record="body.centre.y"), "record"),
    ],
)
def test_one_name_where_a_list_is_meant_is_answered_with_the_list(ask, field):
    with pytest.raises(
        ValueError, match=rf"{field} is 'body.centre.y'; give a list of channels, \['body.centre.y'\]"
    ):
        ask(oscillator(1.0, 1.0, 1e4))


@pytest.mark.parametrize("inputs", [5, None, [5], ["body.centre.y", None]])
def test_a_list_of_anything_else_is_refused(inputs):
    with pytest.raises(ValueError, match=r"inputs is .*; it must be a list of channels, each a text"):
        bd.frequency_response(oscillator(1.0, 1.0, 1e4), [1.0], inputs, ["body.centre.y"])


def test_a_quantity_in_the_name_is_refused_where_one_holds_for_all():
    with pytest.raises(ValueError, match=r"leave \.velocity out and give quantity='velocity'"):
        bd.frequency_response(oscillator(1.0, 1.0, 1e4), [1.0], ["body.centre.y"], ["body.centre.y.velocity"])
