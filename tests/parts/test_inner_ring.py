"""The flexible inner ring: against plane elasticity, against the outer one by symmetry, and on a shaft."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

import bearingdyn as bd
from bearingdyn.material import STEEL
from bearingdyn.parts import FlexibleBearing, FlexibleRing, Layer, RigidBody, RingBed
from flexible_rings import B6305, LAYER, LOAD, MM, RING, RUBBER, STIFF
from verified.ring_theory import annulus_on_bed

INNER = FlexibleRing.of(B6305, race="inner")


@pytest.mark.parametrize("bed", [1e11, 1e13, 1e15])
def test_every_order_of_a_ring_on_a_bed_is_that_of_plane_elasticity(bed: float) -> None:
    a, b, width = 40 * MM, 60 * MM, 1 * MM
    stands = RingBed(bed, axial=0.0)
    ring = FlexibleRing(a, b, width, arm=50 * MM, groove=width, outside=stands, refinement=2.0, race="inner")
    element = ring.superelement()
    raceway = element.raceways["raceway"]
    rest = np.setdiff1d(np.arange(element.n), element.interfaces["inner"])
    flexible = np.linalg.pinv(element.K[np.ix_(rest, rest)], rcond=1e-13)
    for n in (2, 3, 4, 6, 8):
        row = raceway.rows[raceway.series.index(0, n, 0), rest]
        traction = 1.0 / (width * b * math.pi)  # of a unit load on the coefficient
        exact = traction * annulus_on_bed(n, STEEL.E, STEEL.nu, a, b, bed)
        # plane stress but for (n·width/a)⁴; the bed holds the mean across the width
        assert row @ flexible @ row == pytest.approx(exact, rel=1e-4)


def test_section_mass_and_spin_are_those_of_the_turned_ring() -> None:
    """Grooved as the catalogue has it, in rubber: steel less the groove by ∫π(r₂² − r₁²)dz, rubber a tube."""
    layer = Layer(8 * MM, INNER.r_inner, INNER.width, RUBBER)
    R, half, b = INNER.groove_radius, 0.5 * INNER.track, INNER.r_outer
    assert R is not None
    z, weight = np.polynomial.legendre.leggauss(40)
    s = np.sqrt(R**2 - (half * z) ** 2) - math.sqrt(R**2 - half**2)
    cut = [half * weight @ (math.pi * (b**p - (b - s) ** p)) for p in (2, 4)]
    tube = [math.pi * (b**p - INNER.r_inner**p) * INNER.width for p in (2, 4)]
    # parabolas for arcs: fourth order
    assert INNER.body.mass == pytest.approx(STEEL.density * (tube[0] - cut[0]), rel=1e-5)
    assert INNER.body.polar_inertia == pytest.approx(0.5 * STEEL.density * (tube[1] - cut[1]), rel=1e-5)
    rubber = math.pi * (INNER.r_inner**2 - layer.r_inner**2) * layer.width * RUBBER.density
    cushioned = replace(INNER, layer=layer)
    assert cushioned.body.mass == pytest.approx(STEEL.density * (tube[0] - cut[0]) + rubber, rel=1e-5)


def test_the_groove_meets_the_balls() -> None:
    """Its bottom touches a ball of the centred bearing but for its share of the radial play."""
    bottom = INNER.r_outer - INNER.depth
    ball = 0.5 * (B6305.Dpw - B6305.Dw)
    # groove centres stand at (f − ½)Dw cos α0, and 1 − cos α0 = Pd/2A, A = (fi + fo − 1)Dw
    share = (B6305.fi - 0.5) / (B6305.fi + B6305.fo - 1)
    assert bottom == pytest.approx(ball - 0.5 * share * 10e-6, abs=1e-9)
    assert INNER.r_inner == 12.5 * MM


@pytest.mark.parametrize("designation", ["6305", "7205B"])
def test_the_footprints_are_where_a_ball_touches(designation: str) -> None:
    """A ball lies between those of both rings, as long as Hertz's ellipses are under one load."""
    brg = bd.catalogue.bearing(designation, **({"clearance": 10e-6} if designation[0] == "6" else {}))
    inner, outer = (FlexibleRing.of(brg, race=race, load=800.0).footprint for race in ("inner", "outer"))
    assert inner is not None
    assert outer is not None
    # from each ring's groove centre to the plane of the balls
    up = brg.Dw * math.sin(brg.contact_angle or 0.0)
    ends = np.array([inner.point, outer.point]) + [[0.0, (brg.fi - 0.5) * up], [0.0, -(brg.fo - 0.5) * up]]
    line = ends[1] - ends[0]
    # the play of 10 µm stands between them too
    assert np.hypot(*line) == pytest.approx(brg.Dw, abs=6e-6)
    np.testing.assert_allclose(ends.mean(axis=0), [0.5 * brg.Dpw, 0.0], atol=3e-6)
    np.testing.assert_allclose(line / np.hypot(*line), inner.normal, atol=1e-3)
    lengths = [c.semi_axes(800.0)[0] for c in (brg.inner_contact, brg.outer_contact)]
    assert [inner.half_length, outer.half_length] == lengths
    assert lengths[0] != lengths[1]


def test_a_stiff_ring_is_the_rigid_one() -> None:
    stiff = FlexibleBearing(B6305, replace(INNER, material=STIFF))
    for load in (LOAD, (500.0, -3000.0, 900.0, 2.0, 1.0, 0.0)):
        # a millionth of what the ring's wall does, some 3 %
        np.testing.assert_allclose(stiff.displacement(load), B6305.displacement(load), rtol=1e-6, atol=1e-13)


def test_a_rigid_shaft_stiffens_and_a_bed_yields() -> None:
    load = (0.0, -3000.0, 0.0, 0.0, 0.0, 0.0)
    rigid = -B6305.displacement(load)[1]
    on_shaft = FlexibleBearing(B6305, INNER)
    on_bed = FlexibleBearing(B6305, replace(INNER, outside=RingBed(1e12)))
    depth = -on_shaft.displacement(load)[1]
    # a wall near the contact stiffens it, as the rigid bore does an outer ring: 36.65 of 37.85 µm there
    assert 0.96 * rigid < depth < 0.985 * rigid
    # a rigid ring sinks by F/(kπrb) on the bed; this one bends, and has no wall that stiffens it
    sink = 3000.0 / (1e12 * math.pi * INNER.r_inner * INNER.width)
    assert sink < -on_bed.displacement(load)[1] - depth < 2.0 * sink


def test_the_force_is_the_gradient_of_the_energy() -> None:
    bearing = FlexibleBearing(B6305, replace(INNER, outside=RingBed(1e12)))
    q = np.array([3e-6, -20e-6, 15e-6, 1e-4, -2e-4, 0.0])
    for k, h in enumerate((1e-8, 1e-8, 1e-8, 1e-6, 1e-6)):
        step = h * np.eye(6)[k]
        slope = (bearing.energy(q + step) - bearing.energy(q - step)) / (2 * h)
        assert slope == pytest.approx(bearing.force(q)[k], rel=1e-6, abs=1e-3)
        column = (bearing.force(q + step) - bearing.force(q - step)) / (2 * h)
        np.testing.assert_allclose(
            column, bearing.stiffness(q)[:, k], rtol=1e-4, atol=1e-4 * abs(column).max()
        )


def hung(ring: FlexibleRing, as_inner: bool, standing: bool = True) -> bd.Application:
    """A rotor and one ring of a bearing; the ring's far side held. The bearing's rings change places."""
    app = bd.Application()
    app.add("rotor", RigidBody(2.0, (0.01, 0.01, 0.005)))
    app.ground("rotor.centre", stiffness=(0, 0, 0, 1e4, 1e4, 1.0), damping=(50, 50, 50, 1, 1, 0.1))
    element = ring.superelement()
    app.add("ring", element)
    app.ground("ring.outer")
    # the cage turns as before: the ring that is hung on the rotor turns
    turning = "outer" if as_inner else "inner"
    ends = ("ring.raceway", "rotor.centre") if as_inner else ("rotor.centre", "ring.raceway")
    own = replace(B6305, turning=turning, overrides=B6305.overrides._replace(cage_ratio=0.5))
    app.bearing("b", own, inner=ends[0], outer=ends[1], fits=False)
    sign = -1.0 if as_inner else 1.0
    app.load("rotor.centre", [sign * f for f in LOAD])
    return app


@pytest.mark.parametrize("ring", [RING, replace(RING, outside=RingBed(1e11))], ids=["seat", "bed"])
def test_by_symmetry_an_inner_ring_is_an_outer_one(ring: FlexibleRing) -> None:
    """One ring, hung as outer and as inner one, loads turned round: every motion turns round, at rest and in
    a march."""
    motions = [*(f"rotor.centre.{c}" for c in "xyz"), "ring.raceway.radial@-60"]
    found = {}
    for as_inner in (False, True):
        eq = bd.equilibrium(hung(ring, as_inner))
        run = bd.transient(
            eq, speed=300.0, dt=5e-6, steps=2000, record=[*motions, "b.ball3", "b.force.y"]
        )["record"].values  # fmt: skip
        found[as_inner] = eq.displacement("rotor.centre"), eq.bearings["b"].loads, run
    np.testing.assert_allclose(found[True][0], -found[False][0], rtol=1e-9, atol=1e-15)
    np.testing.assert_allclose(found[True][1], found[False][1], rtol=1e-9, atol=1e-6)
    size = np.abs(found[False][2]).max(axis=0)
    # round-off of a march of 2000 steps, and Newton's tolerance
    np.testing.assert_allclose(
        found[True][2] * [-1, -1, -1, -1, 1, 1] / size, found[False][2] / size, rtol=0, atol=1e-7
    )


def on_shaft(ring: FlexibleRing | None, **more: Any) -> bd.Application:
    app = bd.Application()
    shaft = bd.Shaft([bd.Section(0.2, 0.025)], {"left": 0.02, "right": 0.18}, f_max=5e3)
    app.add("shaft", shaft)
    app.ground("shaft.right", stiffness=[1e8, 1e8, 1e8, 1e3, 1e3, 1e2])
    if ring is None:
        app.bearing("b", B6305, inner="shaft.left", outer="ground", **more)
    else:
        app.add("ring", ring)
        app.connect("ring.inner", "shaft.left")
        app.bearing("b", B6305, inner="ring.raceway", outer="ground", **more)
    app.load("shaft.left", (0, -3000.0, 0, 0, 0, 0))
    return app


def test_on_a_turning_shaft() -> None:
    eq = bd.equilibrium(on_shaft(INNER))
    assert eq.system.bearings[0].bearing.ring_speeds == (1.0, 0.0)
    assert {"shaft", "ring"} <= set(eq.system.turning)
    rigid = bd.equilibrium(on_shaft(None))
    sag = [-s.displacement("shaft.left")[1] for s in (eq, rigid)]
    assert 0.95 < sag[0] / sag[1] < 0.99
    run = bd.transient(eq, speed=300.0, dt=5e-6, steps=400, record=["shaft.left.y", "b.ball1"])
    assert run.attrs["complete"] == 1
    # (nΩ/ω)²: the orders' inertia as they turn is nothing beside the stiffness of a ring on its seat
    assert INNER.turning_error(300.0) < 1e-5
    soft = replace(INNER, outside=RingBed(1e10))
    assert soft.turning_error(300.0) > 1e3 * INNER.turning_error(300.0)


def test_both_rings_bend() -> None:
    """What each gives adds up at the balls: depth with both, less with one, to second order in their give."""
    outer, load = FlexibleRing.of(B6305), (0.0, -3000.0, 0.0, 0.0, 0.0, 0.0)

    def depth(inner: bool, bends: bool) -> float:
        app = bd.Application()
        app.add("rotor", RigidBody(2.0, (0.01, 0.01, 0.005)))
        app.ground("rotor.centre", stiffness=(0, 0, 0, 1e6, 1e6, 1.0))
        ends = ["rotor.centre", "ground"]
        if inner:
            app.add("on", INNER)
            app.connect("on.inner", "rotor.centre")
            ends[0] = "on.raceway"
        if bends:
            app.add("in", outer)
            app.ground("in.outer")
            ends[1] = "in.raceway"
        app.bearing("b", replace(B6305, angle0=-math.pi / 2), inner=ends[0], outer=ends[1])
        app.load("rotor.centre", load)
        return -float(bd.equilibrium(app).displacement("rotor.centre")[1])

    none, one, other, both = depth(False, False), depth(True, False), depth(False, True), depth(True, True)
    assert both < min(one, other)
    assert (none - both) == pytest.approx((none - one) + (none - other), rel=0.03)


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"race": "both"}, r"^race is 'both'; "),
        ({"outside": "loose"}, r"^outside is 'loose'; "),
        ({"arm": 0.012, "bearing": None}, r"^arm is 0\.012 m; it must lie outside the bore"),
        ({"r_inner": 14.5 * MM}, r"^r_inner is 0\.0145; the ring is .* make r_inner at most 0\.0141"),
        (
            {"layer": LAYER},
            r"^layer\.r_outer is 0\.035; a layer is bonded to the ring at r_inner = 0\.0125 m",
        ),
    ],
)
def test_wrong_inner_rings_are_named(changes: dict[str, Any], message: str) -> None:
    with pytest.raises(ValueError, match=message):
        replace(INNER, **changes)


def test_wrong_joints_are_named() -> None:
    with pytest.raises(ValueError, match=r"^race is 'inner'; an inner ring sits on a shaft"):
        INNER.race_waves(bd.BoreShape({2: (1e-6, 0.0)}, interference=1e-5))
    app = on_shaft(INNER)
    with pytest.raises(ValueError, match=r"ring\.raceway carries a bearing already"):
        app.bearing("c", B6305, inner="ring.raceway", outer="ground")
    app = on_shaft(None)
    with pytest.raises(ValueError, match="'ground' names no place"):
        app.bearing("c", B6305, inner="ground", outer="shaft.right")
    app.add("on", INNER)
    app.add("in", FlexibleRing.of(B6305, order=9))
    with pytest.raises(ValueError, match=r"on\.raceway and in\.raceway move by other orders"):
        app.bearing("c", B6305, inner="on.raceway", outer="in.raceway")
