"""A machine that the tests of reports share."""

from __future__ import annotations

import pytest

import bearingdyn as bd


@pytest.fixture(scope="module")
def mass() -> bd.Application:
    app = bd.Application()
    app.add("mass", bd.RigidBody(mass=2.0, inertia=(1e-3, 1e-3, 1e-3)))
    app.ground("mass.centre", stiffness=[1e6] * 6, damping=[10.0] * 6)
    return app
