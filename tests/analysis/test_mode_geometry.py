"""Parts know their surface, and modes move it as they move the part."""

from __future__ import annotations

import itertools
import math
import sys
from dataclasses import replace

import matplotlib as mpl
import numpy as np
import pytest
import scipy

mpl.use("Agg")

from bearingdyn import plot
from bearingdyn.analysis import equilibrium, mode_shapes, mode_surfaces, modes
from bearingdyn.application import Application
from bearingdyn.application.free_motions import rigid_shapes
from bearingdyn.fem import Section, SolidMesh, rigid_motion
from bearingdyn.fem.meshes.solid_mesh import second_order
from bearingdyn.material import STEEL
from bearingdyn.parts import (
    Disc,
    EndFace,
    FlexibleRing,
    Housing,
    Layer,
    Region,
    Revolved,
    RigidBody,
    Ring,
    Shaft,
    Solid,
)
from rotors import BEARING, RUBBER, motor, oscillator


def tetrahedra() -> SolidMesh:
    """A cube cut into six along its diagonal."""
    corners = np.array(list(itertools.product((0, 1), repeat=3)))
    number = np.array([4, 2, 1])
    found = []
    for axes in itertools.permutations(range(3)):
        path = [0, *itertools.accumulate(int(number[a]) for a in axes)]
        turn = np.linalg.det(np.eye(3)[list(axes)])
        found.append(path if turn > 0 else [path[1], path[0], *path[2:]])
    return SolidMesh(*second_order(0.03 * corners, found)[:2]).with_surface("base", lambda p: p[:, 2] == 0.0)


HOUSING = Housing(0.08, 0.1, 0.02, 0.04, bore_height=0.06, f_max=8e3, element_size=0.02)
LAYER = Layer(0.026, 0.03, 0.016, RUBBER, refinement=0.5)
GROOVED = FlexibleRing(
    0.0305, 0.036, 0.019, BEARING.arm, order=4, groove_radius=0.0064, groove=0.008, refinement=0.5
)
# each with the reference of its first interface
PARTS = {
    "stepped shaft": (
        Shaft(
            [Section(0.1, 0.03, 0.01), Section(0.1, 0.02)],
            {"left": 0.02, "right": 0.15},
            discs=[Disc.cylinder(0.1, 0.08, 0.01, 0.03)],
        ),
        (0.0, 0.0, 0.02),
    ),
    "housing": (HOUSING, (0.0, 0.0, 0.0)),
    "tetrahedra": (Solid(tetrahedra(), STEEL, {"base": "base"}, 0.0), (0.015, 0.015, 0.0)),
    "layer": (LAYER, (0.0, 0.0, 0.0)),
    "ring": (Ring(0.02, 0.026, 0.016, f_max=20e3), (0.0, 0.0, 0.0)),
    "disc to the axis": (
        Revolved((Region((0.0, 0.03), (0.0, 0.01), STEEL),), {"face": EndFace(0.0)}, f_max=20e3),
        (0.0, 0.0, 0.0),
    ),
    "flexible ring": (GROOVED, (0.0, 0.0, 0.0)),
    "rigid ring": (RigidBody.ring(0.02, 0.026, 0.016), (0.0, 0.0, 0.0)),
    "rigid box": (RigidBody(2.0, (1e-3, 2e-3, 2.5e-3)), (0.0, 0.0, 0.0)),
}


@pytest.mark.parametrize("name", PARTS)
def test_a_rigid_motion_of_the_part_moves_its_surface_rigidly(name):
    """u = t + θ × (p − reference) at every point, for a unit of each of the six motions."""
    part, reference = PARTS[name]
    element, outline = part.superelement(), part.outline()
    assert outline.rows.shape == (outline.points.size, element.n)
    assert set(outline.faces.ravel()) == set(range(len(outline.points)))
    shapes = rigid_shapes(element)
    # the rigid motion of inner coordinates is solved for: 1e-9 of a metre per metre
    np.testing.assert_allclose(outline.rows @ shapes, rigid_motion(outline.points, reference), atol=1e-9)


@pytest.mark.parametrize("name", PARTS)
def test_a_surface_is_closed(name):
    """Every edge has two faces, but where circles shrink to a point: the faces' vector areas cancel."""
    outline = PARTS[name][0].outline()
    sides = np.stack([outline.faces, np.roll(outline.faces, -1, axis=1)], axis=-1).reshape(-1, 2)
    long = np.linalg.norm(np.diff(outline.points[sides], axis=1)[:, 0], axis=1) > 1e-9
    _, count = np.unique(np.sort(sides[long], axis=1), axis=0, return_counts=True)
    assert (count == 2).all()


def test_top_of_a_housing_moves_as_its_output():
    outline = HOUSING.outline()
    at = np.flatnonzero(np.linalg.norm(outline.points - [0.0, 0.04, 0.0], axis=1) < 1e-9)
    assert at.size == 1
    rows = outline.rows.reshape(-1, 3, outline.rows.shape[1])[at[0]]
    expected = HOUSING.superelement().outputs["top"]
    # the same node: round-off
    np.testing.assert_allclose(rows, expected, atol=1e-12 * np.abs(expected).max())


def test_surface_of_a_flexible_ring_moves_as_its_outputs():
    """All orders, 0 to 4, at three points of the surface, one of them in the groove."""
    outline = GROOVED.outline()
    rows = outline.rows.reshape(-1, 3, outline.rows.shape[1])
    bottom = int(np.argmin(np.abs(outline.points[:, 2]) - 1e-3 * outline.points[:, 0]))
    for k in (5, 1000, bottom):
        x, y, z = outline.points[k]
        place = (math.hypot(x, y), z, math.atan2(y, x))
        expected = replace(GROOVED.body, outputs={"p": place}).superelement().outputs["p"]
        # the point is found again in its element by Newton's method
        np.testing.assert_allclose(rows[k], expected, atol=1e-9 * np.abs(expected).max())


def test_inner_face_of_a_layer_moves_with_its_inner_interface_alone():
    outline, element = LAYER.outline(), LAYER.superelement()
    inside = np.abs(np.hypot(*outline.points[:, :2].T) - LAYER.r_inner) < 1e-9
    assert inside.sum() > 48
    expected = np.zeros((3 * int(inside.sum()), element.n))
    expected[:, element.interfaces["inner"]] = rigid_motion(outline.points[inside])
    rows = outline.rows.reshape(-1, 3, element.n)[inside].reshape(-1, element.n)
    # prescribed there: round-off
    np.testing.assert_allclose(rows, expected, atol=1e-12)


def test_first_bending_of_a_free_shaft_has_its_ends_against_its_middle():
    """cosh λ cos λ = 1: the ends move −1.645 times as far as the middle (Euler and Bernoulli)."""
    L = 0.8
    shaft = Shaft([Section(L, 0.01)], {"a": 0.2, "b": 0.5}, points={"middle": 0.5 * L}, f_max=3e3)
    element, outline = shaft.superelement(), shaft.outline()
    squares, shapes = scipy.linalg.eigh(element.K, element.M)
    first = shapes[:, int(np.flatnonzero(squares > 1.0)[0])]
    motion = (outline.rows @ first).reshape(-1, 3)

    def axis(z):
        circle = np.abs(outline.points[:, 2] - z) < 1e-9
        return motion[circle].mean(axis=0)

    left, middle, right = axis(0.0), axis(0.5 * L), axis(L)
    x = scipy.optimize.brentq(lambda x: math.cosh(x) * math.cos(x) - 1.0, 4.0, 5.0)
    sigma = (math.cosh(x) - math.cos(x)) / (math.sinh(x) - math.sin(x))
    half = x / 2
    at_middle = math.cosh(half) + math.cos(half) - sigma * (math.sinh(half) + math.sin(half))
    # (λ d/4L)² = 2e-4 for shear and rotatory inertia
    for end in (left, right):
        assert end @ middle / (middle @ middle) == pytest.approx(2.0 / at_middle, rel=1e-3)


def test_a_box_of_even_mass_has_the_moments_of_the_body():
    body = RigidBody(2.0, (1e-3, 2e-3, 2.5e-3))
    a, b, c = np.ptp(body.outline().points, axis=0)
    expected = [m * 2.0 / 12.0 for m in (b * b + c * c, a * a + c * c, a * a + b * b)]
    np.testing.assert_allclose(body.inertia, expected, rtol=1e-12)  # round-off


def test_surfaces_stand_where_the_parts_stand_and_move_as_they_do():
    app = motor()
    app.add("house", HOUSING)
    app.connect("house.bore", "cap.centre")
    app.free("house.feet")
    state = equilibrium(app)
    found = modes(state, 12)
    shapes = mode_shapes(state, found)
    surfaces = {s.part: s for s in mode_surfaces(state, found, 8)}
    assert set(surfaces) == set(app.plan.parts)
    z = {name: (s.points[:, 2].min(), s.points[:, 2].max()) for name, s in surfaces.items()}
    # from the shaft's left seat at z = 60 mm; arms come out of the reduced rigid motions
    assert z["shaft"] == pytest.approx((-0.06, 0.24), abs=1e-9)
    assert z["layer"] == pytest.approx((-0.0095, 0.0095), abs=1e-9)
    assert z["house"] == pytest.approx((0.17, 0.19), abs=1e-9)
    house = surfaces["house"]
    at = int(np.argmin(np.linalg.norm(house.points - [0.0, 0.04, 0.18], axis=1)))
    expected = shapes.motion.sel(place="house.top").values[8, :3]
    np.testing.assert_allclose(house.motion[at], expected, atol=1e-12 * np.abs(expected).max())


def test_what_a_raceway_carries_stands_around_the_balls():
    """A housing that only the balls join to the shaft."""
    app = Application()
    app.add("shaft", Shaft([Section(0.3, 0.03)], {"left": 0.06, "right": 0.24}, f_max=5e3))
    app.add("ring", GROOVED)
    app.add("house", RigidBody(2.0, (1e-3,) * 3))
    app.connect("ring.outer", "house.centre")
    app.bearing("right", BEARING, inner="shaft.right", outer="ring.raceway")
    app.free("shaft.left")
    at = app.plan.positions()
    for name in ("ring.raceway", "ring.outer", "house.centre"):
        np.testing.assert_allclose(at[name], (0.0, 0.0, 0.18), atol=1e-9)


def test_modes_are_drawn_on_the_parts():
    app = motor()
    state = equilibrium(app)
    found = modes(state, 10, damped=True)
    ax = plot.mode_geometry(state, found, 6, parts=["shaft", "block"])
    assert ax.get_title(loc="left").startswith("Mode 7 at ")
    assert "ζ" in ax.get_title(loc="left")
    assert (ax.get_xlabel(), ax.get_ylabel(), ax.get_zlabel()) == ("z, mm", "x, mm", "y, mm")
    with pytest.raises(ValueError, match="mode is 99"):
        plot.mode_geometry(state, found, 99)
    with pytest.raises(ValueError, match="'axle' names no part"):
        mode_surfaces(state, found, 0, parts=["axle"])
    with pytest.raises(ValueError, match="scale is nan"):
        plot.mode_geometry(state, found, 0, scale=math.nan)


def test_bare_matrices_have_no_surface():
    app = oscillator()
    app.add("bare", RigidBody(1.0, (1.0,) * 3).superelement())
    app.connect("bare.centre", "body.centre")
    found = modes(app)
    assert [s.part for s in mode_surfaces(app, found, 0)] == ["body"]
    with pytest.raises(ValueError, match="'bare' names no part that can be drawn"):
        mode_surfaces(app, found, 0, parts=["bare"])


def test_a_scene_holds_the_moved_surface_of_each_part():
    pytest.importorskip("pyvista", reason="pyvista is not installed")
    app = oscillator()
    found = modes(app)
    scene = plot.mode_scene(app, found, 0, scale=2.0)
    block = scene["body"]
    surface = mode_surfaces(app, found, 0)[0]
    assert block.n_cells == len(surface.faces)
    assert float(block["amplitude"].max()) == pytest.approx(1.0)
    # VTK keeps what it is given
    moved = np.linalg.norm(block.points - surface.points, axis=1)
    np.testing.assert_allclose(moved, 2.0 * np.linalg.norm(surface.motion, axis=1), rtol=1e-6, atol=1e-9)


def test_a_scene_without_pyvista_says_how_to_get_it(monkeypatch):
    monkeypatch.setitem(sys.modules, "pyvista", None)
    with pytest.raises(ImportError, match=r"pip install bearingdyn\[scene\]"):
        plot.mode_scene(oscillator(), modes(oscillator()), 0)
