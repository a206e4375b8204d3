"""Rings loose in a bore that bends with them, and inner rings loose on a shaft."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

import bearingdyn as bd
from bearingdyn.bearing import LooseFit
from bearingdyn.material import STEEL, Elastic
from bearingdyn.parts import Cylinder, FlexibleRing, Groove, Line, Region, Revolved, RigidBody
from bearingdyn.system import assemble
from flexible_rings import B6305, LOOSE, MM, SIZE, STIFF, loose

BELOW = -0.5 * math.pi
LOAD = (0.0, -3000.0, 0.0, 0.0, 0.0, 0.0)


def housing(
    material: Elastic = STEEL, *, bore: float = 31 * MM, order: int | None = None, thick: float = 9 * MM
) -> Revolved:
    """A steel bush, held at its outside, whose bore moves by the ring's orders."""
    half = 8.5 * MM
    face = Groove(Line((bore, -half), (bore, half)), bore, LOOSE.order if order is None else order, z=0.0)
    region = Region((bore, bore + thick), (-half, half), material)
    return Revolved(
        (region,),
        {"foot": Cylinder(bore + thick)},
        {"below": (bore, 0.0, BELOW)},
        grooves={"bore": face},
        f_max=0.0,
    )


def in_housing(body: Revolved, clearance: float, **fit: float) -> bd.Application:
    """As `loose`, the bore that of a housing on the ground."""
    app = loose(clearance, **fit)
    app.plan.fits.clear()
    app.add("housing", body)
    app.ground("housing.foot")
    app.fit("seat", LooseFit(clearance, **fit), ring="ring.outside", bore="housing.bore")
    return app


def test_ring_and_housing_are_in_series_order_by_order() -> None:
    """Condensed by hand from each body's own compliances, which tests of theirs hold to plane elasticity."""
    body = housing()
    ring = FlexibleRing(*SIZE, arm=B6305.arm, order=LOOSE.order, outside="flexible", f_max=0.0)
    app = bd.Application()
    app.add("ring", ring)
    app.add("housing", body)
    app.ground("housing.foot")
    app.free("ring.raceway")
    app.fit("seat", LooseFit(0.0), ring="ring.outside", bore="housing.bore")
    system = assemble(app)
    seat = system.bearings[0]
    raceway = app.plan.parts["ring"].raceways["raceway"]
    rows = np.zeros((len(raceway.series), len(system.K)))
    rows[:, : raceway.rows.shape[1]] = raceway.rows  # the ring's coordinates come first
    radial = np.array([1.0, 0.0])
    k = 1e11  # N/m, a spring on each coefficient between ring and housing
    K = system.K + k * seat.B.T @ seat.B
    for n in (2, 3, 5, 7):
        C, bore = ring.body.groove_compliances(n), body.groove_compliance(n, "bore", radial)
        row = rows[raceway.series.index(0, n, 0)]
        # round-off of a matrix from hold to steel
        assert row @ np.linalg.lstsq(K, row, rcond=1e-15)[0] == pytest.approx(
            C[0, 0] - C[0, 2] ** 2 / (C[2, 2] + bore + 1 / k), rel=1e-6
        )
        assert bore > 0.3 / k  # and it counts


def test_a_stiff_housing_is_the_rigid_bore() -> None:
    stiff, rigid = bd.equilibrium(in_housing(housing(STIFF), 20e-6)), bd.equilibrium(loose(20e-6))
    soft = bd.equilibrium(in_housing(housing(thick=4 * MM), 20e-6))
    drops = [-eq.displacement("rotor.centre")[1] for eq in (stiff, rigid, soft)]
    loads = [eq.bearings["b"].loads for eq in (stiff, rigid, soft)]
    assert drops[0] == pytest.approx(drops[1], rel=1e-5)
    np.testing.assert_allclose(loads[0], loads[1], rtol=1e-4, atol=0.05)
    # a bush of 4 mm gives way under the load, and the ring with it: downwards
    assert drops[2] > drops[1]
    below = [float(eq.system.outputs["housing.below"][1] @ eq.x) for eq in (stiff, soft)]
    assert below[1] < -1e-8
    assert abs(below[0]) < 1e-12
    for eq in (stiff, soft):
        np.testing.assert_allclose(eq.bearings["seat"].force, eq.bearings["b"].force, rtol=1e-6, atol=1e-3)


def on_shaft(clearance: float, ring: FlexibleRing, **fit: float) -> bd.Application:
    """A rotor under 3 kN on which an inner ring sits with clearance, a ball straight below."""
    app = bd.Application()
    app.add("rotor", RigidBody(2.0, (0.01, 0.01, 0.005)))
    app.ground("rotor.centre", stiffness=(0, 0, 0, 1e6, 1e6, 1.0), damping=(50, 50, 50, 1, 1, 0.1))
    app.add("ring", ring)
    app.bearing("b", replace(B6305, angle0=BELOW), inner="ring.raceway", outer="ground")
    app.fit("seat", LooseFit(clearance, **fit), ring="ring.inside", bore="rotor.centre")
    app.load("rotor.centre", LOAD)
    return app


def test_a_shaft_drops_through_the_clearance_of_a_stiff_inner_ring() -> None:
    ring = FlexibleRing.of(B6305, race="inner", outside="flexible", material=STIFF, f_max=0.0)
    depth = -B6305.displacement(LOAD, BELOW)[1]
    for clearance in (0.0, 20e-6):
        eq = bd.equilibrium(on_shaft(clearance, ring, kappa=3e15))
        # the seat itself gives (3 kN/3e15)^⅔ = 0.01 µm
        assert -eq.displacement("rotor.centre")[1] == pytest.approx(depth + clearance / 2, abs=2e-8)
        # the shaft lies in the bottom of the bore, station 45 of 60
        assert np.argmax(eq.bearings["seat"].loads) == 45
        np.testing.assert_allclose(
            eq.bearings["b"].loads,
            B6305.ball_loads(B6305.displacement(LOAD, BELOW), BELOW),
            rtol=1e-5,
            atol=0.01,
        )


def test_a_loose_inner_ring_turns_with_the_shaft() -> None:
    """It is known to turn, and leans on fewer stations the looser it is; a march of it loses no energy."""
    ring = FlexibleRing.of(B6305, race="inner", outside="flexible", damping=0.0)
    app = on_shaft(20e-6, ring)
    assert "ring" in app.plan.turning_parts()
    held = FlexibleRing.of(B6305, race="inner")
    # the same disc by other coordinates: the moment of a tilt that turns
    # bounded by the lowest free frequency, some kHz of a small ring, and no rigid motion
    assert 1e-7 < ring.turning_error(300.0) < (ring.order * 300.0 / (2 * math.pi * 2e3)) ** 2
    G, own = held.superelement().G, ring.superelement()
    rigid = own.raceways["inside"]
    tilts = np.linalg.lstsq(rigid.rows, rigid.series.rigid(rigid.arm)[:, 3:5], rcond=None)[0]
    spin = tilts.T @ own.G @ tilts
    assert spin[0, 1] == pytest.approx(np.abs(G).max(), rel=1e-6)
    assert spin[1, 0] == pytest.approx(-spin[0, 1])
    count = [
        np.count_nonzero(bd.equilibrium(on_shaft(c, ring)).bearings["seat"].loads)
        for c in (0.0, 20e-6, 50e-6)
    ]
    assert count[0] > count[1] >= count[2] > 0


def test_what_does_not_fit_is_named() -> None:
    with pytest.raises(
        ValueError, match=r"ring\.outside moves by orders to 8 and housing\.bore to 6; make the bore"
    ):
        in_housing(housing(order=6), 20e-6)
    with pytest.raises(ValueError, match=r"radius of 0\.031 m and housing\.bore of 0\.033"):
        in_housing(housing(bore=33 * MM), 20e-6)
    app = in_housing(housing(), 20e-6)
    with pytest.raises(ValueError, match="in use already"):
        app.fit("again", LooseFit(1e-5), ring="ring.outside", bore="housing.bore")
