"""Where places stand, and how modes move them."""

from __future__ import annotations

import math

import matplotlib as mpl
import numpy as np
import pytest

mpl.use("Agg")

from bearingdyn import plot
from bearingdyn.analysis import campbell, equilibrium, frequency_response, mode_shapes, modes
from bearingdyn.application import Application
from bearingdyn.fem import Section
from bearingdyn.parts import Feet, Housing, RigidBody, Shaft
from rotors import friswell, motor, oscillator


def test_places_stand_where_they_were_drawn():
    """The shaft's seats by their z, the ring at the left one, the housing's feet below its bore."""
    app = motor()
    app.add("house", Housing(0.08, 0.09, 0.02, 0.04, feet=Feet(0.02), f_max=8e3, element_size=0.02))
    app.connect("house.bore", "cap.centre")
    app.free("house.feet")
    at = app.plan.positions()
    wanted = {
        "shaft.left": (0.0, 0.0, 0.0),
        "shaft.right": (0.0, 0.0, 0.18),
        "shaft.end": (0.0, 0.0, -0.06),
        "ring.centre": (0.0, 0.0, 0.0),
        "layer.outer": (0.0, 0.0, 0.0),
        "block.centre": (0.0, 0.0, 0.0),
        "cap.centre": (0.0, 0.0, 0.18),
        "house.feet": (0.0, -0.045, 0.18),
        "house.top": (0.0, 0.045, 0.18),
    }
    assert set(wanted) < set(at)
    for name, place in wanted.items():
        # arms come out of the reduced rigid motions
        np.testing.assert_allclose(at[name], place, atol=1e-9, err_msg=name)


def test_a_part_that_nothing_joins_stands_nowhere():
    app = motor()
    app.add("stray", RigidBody(1.0, (1.0, 1.0, 1.0)))
    app.free("stray.centre")
    assert "stray.centre" not in app.plan.positions()


def test_first_bending_of_a_shaft_on_two_pins_is_half_a_sine():
    """sin(πz/L) at the points, of a slender shaft."""
    L = 0.8
    points = {f"p{k}": k * L / 8 for k in range(1, 8)}
    app = Application()
    app.add("shaft", Shaft([Section(L, 0.01)], seats={"left": 0.0, "right": L}, points=points, f_max=3e3))
    for end in ("left", "right"):
        app.ground(f"shaft.{end}", stiffness=(1e12, 1e10, 1e12, 0, 0, 1e6))
    found = modes(app)
    shapes = mode_shapes(app, found)
    vertical = np.abs(shapes.motion.sel(component="y", place="shaft.p4").values)
    first = int(np.flatnonzero((vertical > 0.1 * vertical.max()) & (found.frequency.values > 1.0))[0])
    places = [f"shaft.{name}" for name in points]
    y = shapes.motion.sel(component="y", place=places).values[first].real
    z = shapes.position.sel(axis="z", place=places).values
    # Timoshenko on springs: slender to 1e-4
    np.testing.assert_allclose(y / y[3], np.sin(math.pi * z / L), rtol=1e-3)
    ax = plot.mode_shape(shapes, first)
    frequency = float(found.frequency.values[first])
    # the first is mode 1
    title = ax.get_title(loc="left")
    assert title.startswith(f"Mode {first + 1} at {frequency:.4g} Hz")
    with pytest.raises(ValueError, match="mode is 999"):
        plot.mode_shape(shapes, 999)
    with pytest.raises(ValueError, match="axis is 'z'"):
        plot.mode_shape(shapes, 0, axis="z")


def test_points_without_rotation_have_none():
    app = Application()
    app.add("house", Housing(0.08, 0.09, 0.02, 0.04, f_max=8e3, element_size=0.02))
    app.ground("house.feet")
    app.free("house.bore")
    shapes = mode_shapes(app, modes(app, 3))
    assert np.isnan(shapes.motion.sel(place="house.top", component="θx").values).all()
    assert np.isfinite(shapes.motion.sel(place="house.bore").values).all()


def test_modes_of_another_system_are_refused():
    with pytest.raises(ValueError, match="give modes of this one"):
        mode_shapes(equilibrium(motor()), modes(oscillator()))


def test_campbell_diagram_is_drawn_in_rpm_with_forward_and_backward_apart():
    ax = plot.campbell(campbell(friswell(), np.linspace(0, 400, 5), count=6, damped=False), orders=(1.0, 2.0))
    labels = {line.get_label() for line in ax.get_lines()}
    assert {"forward", "backward"} <= labels
    assert ax.get_xlim()[1] == pytest.approx(400 * 30 / math.pi)


@pytest.mark.parametrize(
    ("output", "input", "unit"),
    [
        ("ground.body.centre.y", "body.centre.y", ", 1"),
        ("body.centre.force.y", "ground.y", "(N)/(m)"),
        ("body.centre.y", "ground.y", "(m)/(m)"),
    ],
)
def test_forces_and_transmissibilities_are_drawn_in_their_units(output, input, unit):
    found = frequency_response(oscillator(), [1.0, 10.0, 100.0], [input], [output])
    ax = plot.frequency_response({"a": found}, output, input)
    assert unit in ax.get_ylabel()
    assert ax.get_ylabel().startswith("displacement" if output == "body.centre.y" else "force")
