"""Open sides in an application: refused in statics, warned of in a march."""

from __future__ import annotations

import warnings

import pytest

import bearingdyn as bd
from bearingdyn.bearing.catalogue import bearing

REVERSAL = 2e-3  # s


def spindle(second: bd.BallBearing | None, thrust: float = -300.0) -> bd.Application:
    app = bd.Application()
    seats = {"left": 0.02, "right": 0.08}
    app.add("shaft", bd.Shaft([bd.Section(0.1, 0.025)], seats, f_max=3e3))
    app.bearing("left", bearing("7205"), inner="shaft.left", outer="ground", offset=5e-6)
    right = bearing("7205") if second is None else second
    app.bearing("right", right, inner="shaft.right", outer="ground", offset=-5e-6)
    app.load("shaft.left", (0, -50.0, thrust, 0, 0, 0))
    return app


def test_equilibrium_names_the_bearing_that_is_pressed_on_its_open_side():
    with pytest.raises(ValueError, match=r"bearing 'left' is loaded by .*open side.*bearing.mirrored\(\)"):
        bd.equilibrium(spindle(None))


@pytest.mark.parametrize("thrust", [-300.0, 300.0])
def test_two_bearings_set_against_each_other_bear_thrust_both_ways(thrust):
    state = bd.equilibrium(spindle(bearing("7205").mirrored(), thrust))
    carried = sum(b.force[2] for b in state.bearings.values())
    assert carried == pytest.approx(thrust, rel=1e-6)
    signs = {name: b.force[2] for name, b in state.bearings.items()}
    assert signs["left"] > 0 > signs["right"]


def reversing(ball: bd.BallBearing, thrust_after: float) -> bd.Application:
    app = bd.Application()
    app.add("rotor", bd.RigidBody(0.5, (1e-3, 1e-3, 1e-3), rotating=True))
    app.bearing("front", ball, inner="rotor.centre", outer="ground")
    app.ground("rotor.centre", stiffness=[1e4, 1e4, 0, 100, 100, 0], damping=[50] * 3 + [0.1] * 3)
    app.load("rotor.centre", (0, 0, 200.0, 0, 0, 0))
    app.load(
        "rotor.centre", (0, 0, 1.0, 0, 0, 0), time=[0, REVERSAL, REVERSAL + 1e-4], value=[0, 0, thrust_after]
    )
    return app


def march(ball: bd.BallBearing, thrust_after: float):
    return bd.transient(
        reversing(ball, thrust_after), speed=100.0, dt=1e-5, steps=800, record=["rotor.centre.z"]
    )


def test_a_thrust_reversal_in_a_march_warns_with_bearing_and_time():
    """The rotor flies through the play, 0.5 mm at 200 N / 0.5 kg: ½at² takes 1.6 ms from the reversal on."""
    with pytest.warns(bd.notice.OpenSideWarning, match="bearing 'front': from t = 0.003") as told:
        result = march(bearing("7205", damping=100.0), -400.0)
    assert len(told) == 1
    z = result.record.values[:, 0]
    assert z.max() - z.min() > 0.4e-3  # the 0.46 mm: it has jumped through the play


@pytest.mark.parametrize("held", [False, True])
def test_a_radial_load_alone_is_refused_in_an_application(held):
    """Free along z, or held there by a soft spring, which takes none of the radial load."""
    app = bd.Application()
    app.add("rotor", bd.RigidBody(0.5, (1e-3, 1e-3, 1e-3), rotating=True))
    app.bearing("front", bearing("7205"), inner="rotor.centre", outer="ground")
    app.ground("rotor.centre", stiffness=[0, 0, 1e3 if held else 0, 100, 100, 0])
    app.load("rotor.centre", (0, -50.0, 0, 0, 0, 0))
    with pytest.raises(ValueError, match=r"bearing 'front' .*leans on the shoulder"):
        bd.equilibrium(app)
    with pytest.raises(ValueError, match="leans on the shoulder"):
        bd.transient(app, speed=10.0, dt=1e-5, steps=1, record=["rotor.centre.y"])


def test_a_thrust_that_fades_in_a_march_warns():
    """200 N fall to nothing while 300 N press radially: the balls slide down to the bottom."""
    app = reversing(bearing("7205", damping=100.0), -200.0)
    app.load("rotor.centre", (0, -300.0, 0, 0, 0, 0))
    with pytest.warns(bd.notice.OpenSideWarning, match="or none of them onto its shoulder"):
        bd.transient(app, speed=100.0, dt=1e-5, steps=3000, record=["rotor.centre.z"])


@pytest.mark.parametrize(
    ("ball", "after"),
    [
        (bearing("7205", damping=100.0), 100.0),
        (bearing("7205", damping=100.0, open_side=None), -400.0),
        (bearing("6205", clearance=1e-5, damping=100.0), -400.0),
    ],
)
def test_no_march_warns_without_cause(ball, after):
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        march(ball, after)
