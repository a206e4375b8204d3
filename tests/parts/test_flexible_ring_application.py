"""Flexible rings in applications: loose in a bore, at rest, over frequency and in time."""

from __future__ import annotations

import math
import warnings
from dataclasses import replace

import numpy as np
import pytest

import bearingdyn as bd
from bearingdyn.bearing import LooseFit
from bearingdyn.bearing.raceway_series import RacewaySeries
from bearingdyn.notice import FewOrders
from bearingdyn.parts import FlexibleBearing, FlexibleRing, Layer, Revolved, RigidBody, RingBed
from flexible_rings import (
    B6305,
    CUSHIONED,
    LAYER,
    LOAD,
    LOOSE,
    MM,
    RING,
    RUBBER,
    STIFF,
    audited,
    hung,
    loose,
)

WAYS = ("radial", "axial")


def test_a_stiff_ring_drops_through_the_clearance_of_its_bore() -> None:
    load, angle = (0.0, -3000.0, 0.0, 0.0, 0.0, 0.0), -0.5 * math.pi
    for clearance in (0.0, 20e-6, 50e-6):
        stiff = replace(LOOSE, material=STIFF)
        eq = bd.equilibrium(loose(clearance, stiff, kappa=3e15))
        drop = -eq.displacement("rotor.centre")[1]
        # the seat itself gives (3 kN/3e15)^⅔ = 0.01 µm
        assert drop == pytest.approx(clearance / 2 - B6305.displacement(load, angle)[1], abs=2e-8)
        expected = B6305.ball_loads(B6305.displacement(load, angle), angle)
        np.testing.assert_allclose(eq.bearings["b"].loads, expected, rtol=1e-5, atol=0.01)


def test_a_loose_flexible_ring_lets_one_ball_carry_more(capsys: pytest.CaptureFixture[str]) -> None:
    """Direction of change.

    In a bore larger than itself the ring rests on the line under the load and is pressed towards the bore's
    flatter curve: beside the lowest ball the race recedes, the neighbours are relieved, the lowest ball
    carries more, and the more the larger the bore. The shaft drops by more than half of the clearance.
    """
    load, angle = (0.0, -3000.0, 0.0, 0.0, 0.0, 0.0), -0.5 * math.pi
    rigid = B6305.displacement(load, angle)
    peak = B6305.ball_loads(rigid, angle).max()
    lines, sag, peaks = [f"rigid rings: {-rigid[1] * 1e6:.2f} µm, peak {peak:.1f} N"], [], []
    clearances = np.array([0.0, 5e-6, 20e-6, 50e-6])
    for clearance in clearances:
        eq = bd.equilibrium(loose(clearance))
        drop, Q = -eq.displacement("rotor.centre")[1], eq.bearings["b"].loads
        lines.append(
            f"{clearance * 1e6:4.0f} µm loose: {drop * 1e6:.2f} µm, peak {Q.max():.1f} N, "
            f"{np.count_nonzero(eq.bearings['seat'].loads)} of 60 stations in contact"
        )
        sag.append(drop + rigid[1] - clearance / 2)
        peaks.append(Q.max())
        # the bore carries what the balls bring
        np.testing.assert_allclose(eq.bearings["seat"].force, eq.bearings["b"].force, rtol=1e-6, atol=1e-3)
    with capsys.disabled():
        print("", *lines, sep="\n  ")
    assert peaks[0] < peak
    assert (np.diff(peaks) > 0).all()
    assert peaks[2] > 1.05 * peak
    assert (np.diff(sag) > 0).all()
    assert sag[0] > 0


def test_the_hold_of_a_loose_seat_stores_its_share() -> None:
    """Strain shares of an undamped mode, of unit modal mass: k |u|²/ω² of each spring."""
    eq = bd.equilibrium(loose(20e-6))
    found = bd.modes(eq, 8)
    shares = bd.energy_shares(eq, found).strain
    x, omega = found["shape"].values, 2 * math.pi * found.frequency.values
    spring = next(s for s in eq.system.springs if s.name.startswith("rotor"))
    stored = spring.stiffness @ np.abs(spring.across @ x.T) ** 2
    # round-off of the slow modes' frequencies
    np.testing.assert_allclose(
        shares.sel(part=spring.name).values[2:], (stored / omega**2)[2:], rtol=1e-6, atol=1e-12
    )
    assert shares.sel(part="seat (hold)").max() > 1e-3
    with pytest.raises(ValueError, match=r"bearing 'seat' offers force.x, force.y"):
        bd.frequency_response(eq, [10.0], ["rotor.centre.z"], ["seat.force.z"])


def test_the_loose_seat_does_not_depend_on_its_springs() -> None:
    one = bd.equilibrium(loose(20e-6))
    for fit in ({"kappa": 3e14}, {"stations": 120}, {"hold": 1e9}):
        other = bd.equilibrium(loose(20e-6, **fit))
        y, wanted = (e.displacement("rotor.centre")[1] for e in (other, one))
        # a tenth of a micrometre is the seat's own give
        assert y == pytest.approx(wanted, abs=1.5e-7)
        np.testing.assert_allclose(other.bearings["b"].loads, one.bearings["b"].loads, rtol=2e-3, atol=1.0)


def test_energy_of_a_run_in_a_loose_seat_is_accounted_for() -> None:
    ring = replace(LOOSE, damping=0.02, order=8)
    missing, after, run = audited(bd.equilibrium(loose(20e-6, ring)), 1.25e-6, "seat.loaded")
    assert abs(missing) < 1e-4 * after["energy_throughput"]
    touching = run["record"].sel(channel="seat.loaded").values
    assert touching.max() > touching.min() > 0  # the contact rolls with the balls


def test_the_application_is_the_bearing_by_itself() -> None:
    free = hung(RING)
    free.plan.supports.clear()
    free.ground("ring.outer")
    eq = bd.equilibrium(free)
    brg = FlexibleBearing(B6305, RING)
    # two minimisations of one energy, each to 1e-12 of the load
    np.testing.assert_allclose(eq.displacement("rotor.centre"), brg.displacement(LOAD), rtol=1e-7, atol=1e-12)
    state = eq.bearings["b"]
    np.testing.assert_allclose(state.loads, brg.ball_loads(brg.displacement(LOAD)), rtol=1e-6)
    np.testing.assert_allclose(state.force, LOAD[:3], rtol=1e-9, atol=1e-6)
    x = state.series.index(0, 1, 0)
    assert state.radial_stiffness == pytest.approx(0.5 * (state.K[x, x] + state.K[x + 1, x + 1]))


def test_the_response_at_0_hz_is_the_tangent_and_a_rigid_bore_stiffens() -> None:
    eq = bd.equilibrium(hung(RING))
    K = FlexibleBearing(B6305, RING).stiffness(eq.displacement("rotor.centre"))
    K = K + np.diag([0, 0, 0, 1e4, 1e4, 1.0])
    names = [f"rotor.centre.{c}" for c in ("x", "y", "z")]
    response = bd.frequency_response(eq, [0.0, 500.0], names, names)["response"].values
    np.testing.assert_allclose(response[0].real, np.linalg.inv(K)[:3, :3], rtol=1e-6, atol=1e-13)
    assert np.isfinite(response).all()
    bore, rigid = (bd.modes(bd.equilibrium(hung(ring)))["frequency"].values[:6] for ring in (RING, None))
    # the stiffest, which feels the ring most: the wall takes 0.527 µm/kN from what some 1 kN on a ball gives,
    # 12 µm/kN, which is 4.4 %, and half of it in the frequency
    assert bore[5] == pytest.approx(1.022 * rigid[5], rel=0.004)
    # the other radial one, whose softer balls the wall helps by less; spin, tilts and axial motion are held
    # by springs and shallow contacts, and change by 2e-4
    assert 1.01 < bore[4] / rigid[4] < bore[5] / rigid[5]
    np.testing.assert_allclose(bore[:4], rigid[:4], rtol=5e-4)


@pytest.mark.parametrize("ring", [replace(RING, damping=0.01), replace(CUSHIONED, damping=0.01)])
def test_energy_of_a_run_on_a_flexible_ring_is_accounted_for(ring: FlexibleRing) -> None:
    missing, after, run = audited(bd.equilibrium(hung(ring)), 2.5e-6, "b.force.z")
    # the bound of the motor's audit; powers are summed by the trapezoidal rule, second order in dt
    assert abs(missing) < 1e-4 * after["energy_throughput"]
    record = run["record"]
    assert record.sel(channel="b.loaded").values.min() >= 1
    # forces on the rotor: mean of what the balls carry is the load, less the springs
    assert record.sel(channel="b.force.y").values.mean() == pytest.approx(-2000.0, rel=0.02)


def test_a_run_starts_at_its_equilibrium() -> None:
    eq = bd.equilibrium(hung(CUSHIONED))
    run = bd.transient(eq, speed=0.0, dt=5e-6, steps=400, record=["rotor.centre.y", "b.force.z"])
    y, z = run["record"].values.T
    # nothing moves: the equilibrium is known to 1e-12 of the load, over the softest stiffness 1e6 N/m
    assert np.ptp(y) < 1e-13 + 1e-9 * abs(y[0])
    assert z == pytest.approx(200.0, rel=1e-6)


def test_bad_input_is_named() -> None:
    for change, name in (
        ({"r_inner": -1.0}, "r_inner"),
        ({"r_outer": 27 * MM}, "r_outer"),
        ({"width": math.nan}, "width"),
        ({"arm": 0.0}, "arm"),
        ({"order": 0}, "order"),
        ({"groove": 20 * MM}, "groove"),
        ({"groove_radius": 1 * MM}, "groove_radius"),
        ({"groove_radius": 4.3 * MM, "groove": 8.5 * MM}, "deep"),
        ({"outside": "loose"}, "outside"),
        ({"layer": Layer(32 * MM, 35 * MM, 17 * MM, RUBBER)}, "layer.r_inner"),
        ({"layer": LAYER, "outside": "flexible"}, "outside"),
    ):
        with pytest.raises(ValueError, match=name):
            replace(RING, **change)
    with pytest.raises(ValueError, match="arm"):
        FlexibleBearing(B6305, replace(RING, arm=20 * MM))
    with pytest.raises(ValueError, match="outside"):
        FlexibleBearing(B6305, LOOSE)
    app = hung(RING)
    with pytest.raises(ValueError, match="carries a bearing already"):
        app.bearing("c", B6305, inner="rotor.centre", outer="ring.raceway")
    with pytest.raises(ValueError, match="raceway"):
        app.connect("rotor.centre", "ring.raceway")
    app = bd.Application()
    app.add("rotor", RigidBody(1.0, (1e-3,) * 3))
    app.add("ring", RING)
    app.ground("ring.outer")
    app.free("rotor.centre")
    with pytest.raises(ValueError, match=r"arm at 0\.02"):
        app.bearing("b", replace(B6305, arm=0.02), inner="rotor.centre", outer="ring.raceway")
    with pytest.raises(ValueError, match=r"ring\.raceway carries no balls"):
        app.plan.check_joints()
    app.free("ring.raceway")
    app.plan.check_joints()
    app = loose(20e-6)
    with pytest.raises(ValueError, match="in use already"):
        app.fit("again", LooseFit(1e-5), ring="ring.outside", bore="ground")
    with pytest.raises(ValueError, match="no flexible face"):
        app.fit("again", LooseFit(1e-5), ring="rotor.centre", bore="ground")
    with pytest.raises(ValueError, match="taken"):
        app.fit("b", LooseFit(1e-5), ring="ring.outside", bore="ground")
    with pytest.raises(ValueError, match="stations"):
        bd.equilibrium(loose(20e-6, stations=12))
    for wrong in (
        {"clearance": -1e-6},
        {"kappa": 0.0},
        {"hold": math.nan},
        {"stations": 2},
        {"stations": 11},
    ):
        with pytest.raises(ValueError, match=next(iter(wrong))):
            LooseFit(**{"clearance": 1e-5, **wrong})
    with pytest.raises(ValueError, match="terms"):
        RacewaySeries(((1, 0, 0), (0, 1, 0)))
    with pytest.raises(ValueError, match="grooves"):
        Revolved(RING.body.regions, {"raceway": RING.body.interfaces["outer"]}, grooves=RING.body.grooves)


def test_a_ring_of_fewer_orders_than_balls_is_told() -> None:
    assert B6305.Z == 7
    with pytest.warns(FewOrders, match=r"has 7 balls.*ring\.raceway moves by orders to 6.*order=8"):
        hung(replace(RING, bearing=None, arm=B6305.arm, order=6))
    with warnings.catch_warnings():
        warnings.simplefilter("error", FewOrders)
        hung(replace(RING, bearing=None, arm=B6305.arm, order=7))


@pytest.mark.parametrize(
    "radii", [(20 * MM, 24 * MM), (40 * MM, 46 * MM), (17 * MM, 31 * MM), (55 * MM, 62 * MM)]
)
def test_a_ring_of_another_bearing_is_refused(radii: tuple[float, float]) -> None:
    """Inside the pitch circle, far outside the balls, as diameters."""
    with pytest.raises(ValueError, match=r"r_inner is .*run on a race from 0\.02"):
        FlexibleRing(*radii, 17 * MM, bearing=B6305)


def test_channels_of_a_raceway() -> None:
    """Against the bearing by itself at rest, and against each other in a march."""
    ring = replace(RING, outside=RingBed(1e11))
    eq, alone = bd.equilibrium(hung(ring)), FlexibleBearing(B6305, ring)
    q = eq.displacement("rotor.centre")
    degrees = [-90, 0, 45]
    names = [f"ring.raceway.{way}@{d}" for d in degrees for way in WAYS]
    orders = [
        f"ring.raceway.radial-{wave}{n}" for n in range(9) for wave in (("cos", "sin") if n else ("cos",))
    ]
    rate = "ring.raceway.radial@-90.velocity"
    run = bd.transient(eq, speed=300.0, dt=5e-6, steps=50, record=[*names, *orders, rate])["record"]
    got = [[float(eq.system.row(f"ring.raceway.{way}@{d}") @ eq.x) for way in WAYS] for d in degrees]
    wanted = alone.race(q, np.radians(degrees))
    # both are minima of one energy
    np.testing.assert_allclose(got, wanted, rtol=0, atol=1e-6 * np.abs(wanted).max())
    values = run.sel(channel=orders).values
    psi = math.radians(45)
    shares = [f(n * psi) for n in range(9) for f in ((math.cos, math.sin) if n else (math.cos,))]
    np.testing.assert_allclose(values @ shares, run.sel(channel="ring.raceway.radial@45").values, rtol=1e-9)
    assert run["unit"].sel(channel=rate) == "m/s"


@pytest.mark.parametrize("name", ["x", "radial", "radial-sin0", "radial-cos9", "axial@12.5", "radial@"])
def test_wrong_channels_of_a_raceway_are_named(name: str) -> None:
    eq = bd.equilibrium(hung(RING))
    with pytest.raises(ValueError, match=r"ring\.raceway is a raceway; it offers radial-cos0 to radial-sin8"):
        bd.transient(eq, speed=0.0, dt=5e-6, steps=1, record=[f"ring.raceway.{name}"])
