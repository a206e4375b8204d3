"""Neighbours at one interface fit each other, or are refused by name."""

from __future__ import annotations

import warnings

import pytest

import bearingdyn as bd
from bearingdyn.bearing.catalogue import CATALOGUE, bearing, entry
from bearingdyn.notice import FitWarning

RUBBER = bd.Maxwell(G0=1e6, G=[2e6], tau=[1e-4], K=2e9, density=1150.0)
BALL = bearing("6205", clearance=1e-5)  # 25 × 52 × 15 mm
OWN = bd.BallBearing(Z=9, Dw=7.94e-3, Dpw=39.04e-3, fi=0.52, fo=0.53, clearance=10e-6)


def layer(inner: float, outer: float, width: float = 0.015) -> bd.Layer:
    return bd.Layer(inner, outer, width, RUBBER)


def housing(bore: float, length: float = 0.02) -> bd.Housing:
    return bd.Housing(0.12, 0.14, length, bore, f_max=0.0, element_size=0.03)


def ring(*measures: float) -> bd.RigidBody:
    return bd.RigidBody.ring(*measures)


def shaft(*sections: tuple[float, float], seat: float = 0.02) -> bd.Shaft:
    return bd.Shaft([bd.Section(*s) for s in sections], {"seat": seat}, f_max=1e3)


def tube(inner: float, outer: float) -> bd.Ring:
    return bd.Ring(inner, outer, 0.015, refinement=0.5)


def join(a, at_a, b, at_b, **options):
    app = bd.Application()
    app.add("a", a)
    app.add("b", b)
    app.connect(f"a.{at_a}", f"b.{at_b}", **options)


def hang(ball, inner, outer=None, **options):
    app = bd.Application()
    app.add("a", inner)
    at = "seat" if isinstance(inner, bd.Shaft) else "centre"
    if outer is not None:
        app.add("b", outer)
    where = {bd.Housing: "b.bore", bd.RigidBody: "b.centre", type(None): "ground"}[type(outer)]
    app.bearing("x", ball, inner=f"a.{at}", outer=where, **options)


REFUSED = [
    ("layer 48 in 60", (layer(0.02, 0.024), "outer", housing(0.06), "bore"), "Ø48 mm.*Ø60 mm: gap of 6 mm"),
    ("diameters", (layer(0.052, 0.06), "outer", housing(0.06), "bore"), "is one of them a diameter"),
    ("bore smaller", (ring(0.02, 0.026, 0.015), "centre", housing(0.048), "bore"), "overlap of 2 mm"),
    ("layer on ring", (ring(0.02, 0.026, 0.015), "centre", layer(0.029, 0.033), "inner"), "gap of 3 mm"),
    ("tube in tube", (tube(0.02, 0.025), "outer", tube(0.028, 0.033), "inner"), "Ø50 mm.*Ø56 mm"),
    ("tube on shaft", (tube(0.02, 0.025), "inner", shaft((0.1, 0.02)), "seat"), "Ø20 mm.*Ø40 mm"),
    ("hub on shaft", (ring(0.02, 0.05, 0.02), "centre", shaft((0.1, 0.03)), "seat"), "gap of 5 mm"),
]
HUNG = [
    ("thick shaft", (BALL, shaft((0.1, 0.03))), "Ø30 mm.*inner ring of bearing 'x'.*Ø25 mm: overlap"),
    ("next bore", (BALL, shaft((0.1, 0.020))), "gap of 2.5 mm"),
    ("radius for diameter", (BALL, shaft((0.1, 0.0125))), "is one of them a diameter"),
    ("narrow bore", (BALL, shaft((0.1, 0.025)), housing(0.05)), "Ø52 mm.*Ø50 mm: overlap"),
    ("wide bore", (BALL, shaft((0.1, 0.025)), housing(0.062)), "gap of 5 mm"),
    ("shoulder", (BALL, shaft((0.008, 0.025), (0.1, 0.03), seat=0.004)), "3.5 mm into the shoulder"),
    ("thin plate", (BALL, shaft((0.1, 0.025)), housing(0.052, 0.005)), "5 mm of it lie on b.bore"),
    ("ring of another", (BALL, shaft((0.1, 0.025)), ring(0.03, 0.04, 0.015)), "outer ring of bearing 'x'"),
    ("no room inside", (OWN, shaft((0.1, 0.05))), "Ø50 mm.*Ø31.1 mm: there is no room for a ring"),
    ("no room outside", (OWN, shaft((0.1, 0.025)), housing(0.04)), "no room for a ring; the bore must be"),
]


@pytest.mark.parametrize(("case", "found"), [c[1:] for c in REFUSED], ids=[c[0] for c in REFUSED])
def test_parts_that_cannot_be_joined_are_refused_with_both_numbers(case, found):
    with pytest.raises(ValueError, match=f"(?s){found}.*fits=False"):
        join(*case)
    join(*case, fits=False)


@pytest.mark.parametrize(("case", "found"), [c[1:] for c in HUNG], ids=[c[0] for c in HUNG])
def test_bearings_that_do_not_fit_their_seats_are_refused(case, found):
    with pytest.raises(ValueError, match=f"(?s){found}.*fits=False"):
        hang(*case)
    hang(*case, fits=False)


@pytest.mark.parametrize(
    ("make", "found"),
    [
        (lambda: join(layer(0.026, 0.0294), "outer", housing(0.06), "bore"), "2 % of the radius"),
        (lambda: join(layer(0.026, 0.03), "inner", housing(0.06), "bore"), "both face inwards"),
        (lambda: join(ring(0.02, 0.026, 0.01), "centre", layer(0.026, 0.03, 0.02), "inner"), "10 mm of it"),
        (lambda: hang(BALL, shaft((0.1, 0.025), seat=0.0)), "7.5 mm of it lie on a.seat"),
        (lambda: hang(BALL, shaft((0.1, 0.0242))), "3.2 % of the radius"),
    ],
)
def test_what_hardly_fits_is_warned_of(make, found):
    with pytest.warns(FitWarning, match=found):
        make()


@pytest.mark.parametrize(
    "make",
    [
        lambda: join(layer(0.026, 0.03), "outer", housing(0.06), "bore"),
        lambda: join(ring(0.0228, 0.026, 0.015), "centre", layer(0.026, 0.03), "inner"),
        lambda: join(ring(0.0, 0.1, 0.02), "centre", shaft((0.1, 0.03)), "seat"),  # a disc
        lambda: join(shaft((0.1, 0.03)), "seat", shaft((0.1, 0.05)), "seat"),  # end to end
        lambda: join(bd.RigidBody(1.0, (1e-3,) * 3), "centre", housing(0.06), "bore"),  # nothing is known
        lambda: hang(BALL, shaft((0.1, 0.025)), housing(0.052)),
        lambda: hang(BALL, ring(0.0125, 0.0155, 0.015), ring(0.0228, 0.026, 0.015)),  # the rings themselves
        lambda: hang(BALL, ring(0.0, 0.1, 0.02)),  # a rotor whose journals are not drawn
        lambda: hang(BALL, bd.RigidBody(1.0, (1e-3,) * 3)),
        lambda: hang(OWN, shaft((0.1, 0.025)), housing(0.052)),
    ],
)
def test_what_fits_or_is_not_known_is_silent(make):
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        make()


def test_every_bearing_of_the_catalogue_fits_its_own_seats():
    """Bore, outside and width of ISO 15, a step of the shaft right beside the ring; press fits of ½ ‰."""
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        for name in CATALOGUE:
            e = entry(name)
            ball = bearing(name, clearance=None if e.contact_angle else 1e-5)
            seat = shaft((e.width, e.bore * 1.0005), (0.1, e.bore * 1.3), seat=e.width / 2)
            outer = ring(e.outside / 2 * 0.9, e.outside / 2, e.width)
            hang(ball, seat, outer)


def test_a_mesh_knows_its_bore():
    """A block of finite elements, and one of revolution with a mesh of its own: the face is measured."""
    faces = housing(0.06).body.round_faces()["bore"]
    assert [(f.kind, round(f.radius, 9)) for f in faces] == [("bore", 0.03)]
    assert faces[0].z == pytest.approx((-0.01, 0.01))
    assert housing(0.06).body.round_faces()["feet"] == ()
    found = tube(0.02, 0.025).round_faces()
    assert {k: (f[0].kind, f[0].radius) for k, f in found.items()} == {
        "inner": ("bore", pytest.approx(0.02)),
        "outer": ("shaft", pytest.approx(0.025)),
    }


def test_a_loose_ring_that_is_too_large_for_its_bore_is_refused():
    loose = bd.FlexibleRing(0.0228, 0.026, 0.015, OWN.arm, order=2, outside="flexible", refinement=0.5)
    app = bd.Application()
    app.add("ring", loose)
    app.add("house", housing(0.048))
    with pytest.raises(ValueError, match=r"Ø52 mm.*Ø48 mm: overlap"):
        app.fit("play", bd.bearing.LooseFit(20e-6, 1e9), ring="ring.outside", bore="house.bore")


def test_numbers_that_make_no_bearing_are_refused():
    with pytest.raises(ValueError, match=r"boundary is .*the races"):
        bearing("6205", clearance=1e-5, boundary=(0.035, 0.052, 0.015))


@pytest.mark.parametrize("apart", [0.0, 0.008, 0.014])
def test_two_bearings_in_one_place_of_a_shaft_are_refused(apart):
    """15 mm each: at one seat, and at two nearer than a width; at 15 mm they stand beside each other."""
    seats = {"a": 0.03, "b": 0.03 + apart, "c": 0.045} if apart else {"a": 0.03, "c": 0.045}
    app = bd.Application()
    app.add("s", bd.Shaft([bd.Section(0.1, 0.025)], seats, f_max=1e3))
    app.bearing("one", BALL, inner="s.a", outer="ground")
    second = {"inner": "s.b" if apart else "s.a", "outer": "ground"}
    with pytest.raises(ValueError, match=f"'two' and 'one' sit {1e3 * apart:.4g} mm apart .* need 15 mm"):
        app.bearing("two", BALL, **second)
    app.bearing("beside", BALL, inner="s.c", outer="ground")
    app.bearing("meant", BALL, **second, fits=False)


def test_rows_of_a_set_do_not_overlap():
    """Rows of 15 mm, 10 mm apart; nothing of the set is hung where one row does not fit."""
    row = bearing("7205")
    app = bd.Application()
    app.add("s", bd.Shaft([bd.Section(0.1, 0.025)], {"a": 0.05}, f_max=1e3))
    with pytest.raises(ValueError, match=r"'p-2' and 'p-1' sit 10 mm apart .* need 15 mm"):
        app.bearing("p", bd.bearing.Pair(row, "DB", distance=0.010), inner="s.a", outer="ground")
    assert not app.plan.bearings
    app.bearing("p", bd.bearing.Pair(row, "DB", distance=0.015), inner="s.a", outer="ground")
    assert list(app.plan.bearings) == ["p-1", "p-2"]


@pytest.mark.parametrize(("case", "found"), [c[1:] for c in REFUSED], ids=[c[0] for c in REFUSED])
def test_reduced_parts_know_their_faces(case, found):
    """What a part knew of radius and width its superelement knows, and refuses alike."""
    a, at_a, b, at_b = case
    with pytest.raises(ValueError, match=f"(?s){found}.*fits=False"):
        join(a.superelement(), at_a, b.superelement(), at_b)
    join(a.superelement(), at_a, b.superelement(), at_b, fits=False)


def test_reduced_parts_that_fit_are_silent():
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        join(layer(0.026, 0.03).superelement(), "outer", housing(0.06).superelement(), "bore")
        hang(BALL, shaft((0.1, 0.025)), housing(0.052))


def test_an_imported_body_knows_its_bore():
    """Of another program's matrices: the nodes of an interface lie on a cylinder, the rest outside it."""
    mesh = bd.block_with_bore(0.12, 0.14, 0.02, 0.06, 0.07, 0.03)
    model = bd.Solid(mesh, bd.STEEL, {"bore": "bore"}, f_max=0.0).full_model()
    matrices = bd.fem.FEMatrices(K=model.K, M=model.M, points=mesh.points)
    bore = bd.Imported(matrices, {"bore": bd.NodeSet(bd.at_radius(0.03))}, f_max=0.0)
    assert [(f.kind, round(f.radius, 9)) for f in bore.round_faces()["bore"]] == [("bore", 0.03)]
    with pytest.raises(ValueError, match=r"Ø48 mm.*Ø60 mm: gap of 6 mm"):
        join(layer(0.02, 0.024), "outer", bore, "bore")
    join(layer(0.026, 0.03), "outer", bore, "bore")


# OWN has races of Ø31.1 and Ø46.98 mm, balls of 7.94 mm, and no known bore, outside or width
UNKNOWN_RINGS = [
    ("rings exchanged", ring(0.0235, 0.026, 0.015), ring(0.0125, 0.0155, 0.015), "the inner ring.*no room"),
    ("inner beyond race", ring(0.025, 0.027, 0.015), None, "Ø50 mm.*the inner ring.*Ø31.1 mm.*no room"),
    ("outer within race", shaft((0.1, 0.025)), ring(0.005, 0.006, 0.015), "Ø12 mm.*the outer ring.*no room"),
    ("narrower than balls", shaft((0.1, 0.025)), ring(0.0245, 0.026, 0.002), "2 mm of it lie on b.centre"),
]


@pytest.mark.parametrize(
    ("inner", "outer", "found"), [c[1:] for c in UNKNOWN_RINGS], ids=[c[0] for c in UNKNOWN_RINGS]
)
def test_hollow_bodies_about_a_bearing_of_unknown_rings(inner, outer, found):
    """A hollow body may be the ring itself or carry it: either way it lies where the balls do not."""
    with pytest.raises(ValueError, match=f"(?s){found}.*fits=False"):
        hang(OWN, inner, outer)
    hang(OWN, inner, outer, fits=False)


def test_a_ring_many_balls_thick_is_doubted():
    """From a race of Ø46.98 mm to a bore of Ø200 mm: 9.6 balls. Rings, or what carries them, are silent."""
    with pytest.warns(FitWarning, match=r"76.5\d* mm thick, 9.6\d ball diameters"):
        hang(OWN, shaft((0.1, 0.025)), ring(0.1, 0.11, 0.015))
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        hang(OWN, shaft((0.1, 0.025)), ring(0.0245, 0.026, 0.015))
        hang(OWN, ring(0.0125, 0.0165, 0.015), ring(0.0228, 0.026, 0.015))
        hang(OWN, shaft((0.1, 0.008)), ring(0.026, 0.03, 0.015))


def hung(r_inner: float, r_outer: float, *, race: str = "outer", fits: bool = True) -> None:
    """A bearing in a ring that was made by its arm alone."""
    own = bd.FlexibleRing(r_inner, r_outer, 0.015, arm=OWN.arm, order=10, race=race, f_max=0.0)
    app = bd.Application()
    app.add("rotor", bd.RigidBody(4.0, (0.02, 0.02, 0.004), rotating=True))
    app.add("ring", own)
    app.bearing("b", OWN, inner="rotor.centre", outer="ring.raceway", fits=fits)


def test_a_ring_made_by_its_arm_alone_is_compared_with_the_balls_hung_in_it():
    """As one that is made with bearing=: where the balls run, and how thick it is under their contact."""
    with pytest.raises(
        ValueError, match=r"bearing 'b' in a FlexibleRing: r_inner is 0\.03; balls of 0\.0079"
    ):
        hung(0.030, 0.036)
    with pytest.warns(FitWarning, match=r"contact is 2\.2 mm long, the ring 0\.6 mm thick"):
        hung(0.0222, 0.0228)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        hung(0.0222, 0.026)
        hung(0.0222, 0.0228, fits=False)


def test_fits_of_another_bearing_are_refused():
    other = bd.bearing.Mounting(0.030, 0.062)
    with pytest.raises(ValueError, match=r"bore is 0\.03; the bearing's is 0\.025 m"):
        other.mounted(BALL)
    assert bd.bearing.Mounting(0.025, 0.052).mounted(BALL).clearance == pytest.approx(1e-5, rel=1e-12)
    other.mounted(OWN)  # whose rings are not known
