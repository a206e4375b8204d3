"""Slips of a first day, each answered with its remedy; and what is printed when one looks."""

from __future__ import annotations

import pytest

from bearingdyn.analysis import equilibrium, transient
from bearingdyn.application import Application
from bearingdyn.parts import RigidBody


def suspended() -> Application:
    app = Application()
    app.add("mass", RigidBody(1.0, (1e-3, 1e-3, 1e-3)))
    app.ground("mass.centre", stiffness=[1e6] * 6)
    return app


def test_an_application_marches_from_its_own_equilibrium() -> None:
    app = suspended()
    app.load("mass.centre", (0, -10.0, 0, 0, 0, 0))
    run = transient(app, speed=0.0, dt=1e-5, steps=3, record=["mass.centre.y"])
    # F/k, at rest there; to the round-off of modes and back
    assert run["record"].values[:, 0] == pytest.approx(-1e-5, rel=1e-12)


@pytest.mark.parametrize(
    ("record", "message"),
    [
        ("mass.centre.y", r"give a list of channels, \['mass.centre.y'\]"),
        (["mass.center.y"], "did you mean 'mass.centre'"),
        (["mass.centre"], "is a place; add what of it is meant, as 'mass.centre.y'"),
        (["lft.loaded"], "'lft' is not a bearing"),
    ],
)
def test_a_slip_in_a_channel_is_answered_with_the_remedy(record, message) -> None:
    with pytest.raises(ValueError, match=message):
        transient(suspended(), speed=0.0, dt=1e-5, steps=3, record=record)


def test_what_is_printed_fits_on_the_screen() -> None:
    app = suspended()
    eq = equilibrium(app)
    assert "mass" in repr(app)
    assert max(len(repr(thing)) for thing in (eq, eq.system, app.plan.parts["mass"])) < 120
