"""Varying compliance: turned slowly, a loaded bearing passes through its static states."""

from __future__ import annotations

from functools import cache

import numpy as np

from bearingdyn.analysis import equilibrium, transient
from bearingdyn.application import Application
from bearingdyn.bearing import BallBearing
from bearingdyn.parts import RigidBody

BEARING = BallBearing(8, 11.9e-3, 52e-3, 0.52, 0.53, clearance=20e-6, damping=200.0)


@cache
def rotor() -> Application:
    """20 kg on one bearing with clearance, radially and axially loaded, damped against the ground."""
    app = Application()
    app.add("rotor", RigidBody(20.0, (0.1, 0.1, 0.1)))
    app.ground("rotor.centre", (0, 0, 1e6, 1e5, 1e5, 1e5), (3e3, 3e3, 1e3, 50, 50, 50))
    app.bearing("b", BEARING, inner="rotor.centre", outer="ground")
    app.load("rotor.centre", (0.0, -196.0, 30.0, 0, 0, 0))
    return app


def test_at_low_speed_the_march_is_the_static_solution_at_every_cage_angle() -> None:
    app = rotor()
    pitch = 2 * np.pi / 8
    # three pitches in 24 s: inertia does not see it (some 100 Hz); the dampers lag by c/k of some 0.2 ms, and
    # 1 ms sideways, where few balls hold: 1e-4 of a pitch
    turned, end, dt = 3 * pitch, 24.0, 4e-4
    speed = turned / end / BEARING.cage_ratio
    steps = round(end / dt)
    record = ["rotor.centre.x", "rotor.centre.y", "rotor.centre.z", "b.ball6", "b.loaded"]
    found = transient(
        equilibrium(app), speed=speed, dt=dt, steps=steps, decimate=steps // 64, filter=False, record=record
    )
    angles = BEARING.cage_ratio * speed * found.time.values
    expected = []
    for angle in angles:
        static = equilibrium(app, angle=float(angle))
        loads = static.bearings["b"].loads
        x, y, z = static.displacement("rotor.centre")[:3]
        expected.append([x, y, z, loads[5], np.count_nonzero(loads)])
    got, static_values = found.record.values, np.array(expected)
    # 0.1 % of the largest, and of the swing that varying compliance makes
    for k in range(4):
        swing = np.ptp(static_values[:, k])
        assert np.abs(got[:, k] - static_values[:, k]).max() < 1e-3 * np.abs(static_values[:, k]).max()
        assert np.abs(got[:, k] - static_values[:, k]).max() < 1e-2 * swing
    # ball 6 comes from the side, passes below and leaves: the load passes from ball to ball
    assert static_values[:, 3].min() == 0.0
    assert set(static_values[:, 4]) >= {2.0, 3.0}
    assert np.mean(got[:, 4] == static_values[:, 4]) > 0.9


def test_displacement_repeats_with_the_ball_passage_and_swings_sideways() -> None:
    """Statics: period one pitch; x is odd and y even about a ball below the load (mirror symmetry)."""
    app, pitch = rotor(), 2 * np.pi / 8
    below = -np.pi / 2  # the load points to −y; ball 1 stands there
    for offset in (0.05, 0.2):
        a, b, c = (
            equilibrium(app, angle=below + s).displacement("rotor.centre")[:3]
            for s in (offset, -offset, offset + pitch)
        )
        # the minimum is found to some 1e-10 of the displacement
        scale = np.abs(a).max()
        np.testing.assert_allclose(a, [-b[0], b[1], b[2]], rtol=0, atol=1e-7 * scale)
        np.testing.assert_allclose(a, c, rtol=0, atol=1e-7 * scale)
        assert abs(a[0]) > 1e-4 * scale
