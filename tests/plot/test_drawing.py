"""The drawing of a machine: to scale, with bearings, supports, loads and names; and what notebooks show."""

from __future__ import annotations

import math
import re
import xml.etree.ElementTree as ElementTree
from pathlib import Path
from typing import Any

import matplotlib
import numpy as np
import pytest

import bearingdyn as bd
from bearingdyn.bearing import Pair
from bearingdyn.demo import motor
from bearingdyn.parts.profile import cut
from bearingdyn.plot.drawing.labels import spread
from bearingdyn.plot.drawing.loads import value
from bearingdyn.plot.drawing.shown_machine import machine
from bearingdyn.plot.drawing.words import designation

matplotlib.use("Agg")
RUBBER = bd.Maxwell(G0=1e6, G=[1e6, 2e6], tau=[1e-3, 1e-4], K=2e9, density=1150.0)


@pytest.fixture(scope="module")
def layered() -> bd.Application:
    return motor(RUBBER)


@pytest.fixture(autouse=True)
def _closed() -> Any:
    yield
    import matplotlib.pyplot as plt

    plt.close("all")


def texts(ax: Any) -> list[str]:
    return [t.get_text() for t in (*ax.texts, *ax.figure.texts)]


def test_every_part_stands_where_it_is_and_is_as_large_as_it_is(layered: bd.Application) -> None:
    shown = {p.name: np.concatenate([q.corners for q in p.profiles]) for p in machine(layered.plan).parts}
    # mm from shaft.left: the demo's dimensions, by hand; 1e-9 is round-off of the positions
    expected = {
        "shaft": ((-10, 190), (-15, 15)),
        "left_ring": ((-7, 7), (-20, 20)),
        "left_layer": ((-7, 7), (-24, 24)),
        "left_housing": ((-10, 10), (-70, 50)),
        "right_layer": ((173, 187), (-24, 24)),
        "right_housing": ((170, 190), (-70, 50)),
    }
    for name, (z, y) in expected.items():
        low, high = shown[name].min(axis=0), shown[name].max(axis=0)
        assert (low[0], high[0]) == pytest.approx(z, abs=1e-9), name
        assert (low[1], high[1]) == pytest.approx(y, abs=1e-9), name


def test_the_section_is_to_scale(layered: bd.Application) -> None:
    ax = layered.draw()
    ax.figure.canvas.draw()
    (x0, y0), (x1, y1) = ax.transData.transform([(0.0, 0.0), (100.0, 100.0)])
    assert x1 - x0 == pytest.approx(y1 - y0, rel=1e-6)
    assert x1 - x0 > 300, "the machine fills the sheet"


def test_rubber_and_metal_are_told_apart(layered: bd.Application) -> None:
    ring = bd.FlexibleRing(
        r_inner=0.0225, r_outer=0.026, width=0.015, arm=0.018, layer=bd.Layer(0.026, 0.030, 0.012, RUBBER)
    )
    found = {(p.matter, round(float(np.abs(p.corners[:, 1]).max()), 6)) for p in ring.profile()}
    assert found == {("metal", 0.026), ("rubber", 0.030)}
    assert {p.matter for p in bd.Layer(0.02, 0.024, 0.014, RUBBER).profile()} == {"rubber"}


def test_a_recess_shows_in_the_section() -> None:
    layer = bd.Layer(0.02, 0.024, 0.012, RUBBER, recess=1e-3)
    z = layer.profile()[0].corners
    middle = z[np.abs(z[:, 1] - 0.022) < 1e-9][:, 0]
    assert np.abs(middle).max() == pytest.approx(0.005, rel=1e-6)  # half the width less the recess


def test_the_drawing_names_designations_loads_places_and_distances(layered: bd.Application) -> None:
    said = texts(layered.draw())
    assert said.count("6203") == 2
    for text in ("1 kN", "100 N", "unbalance 2 g mm, towards x", "shaft.middle", "180", "200"):
        assert text in said, text
    assert "rubber, G0 1 MPa" in " ".join(said)
    assert any("ball bearing 6203, 8 balls" in t for t in said)
    for k in range(1, 10):
        assert said.count(str(k)) == 2, "each number in its balloon and in the list"


def paired() -> bd.Application:
    """A shaft in a pair back to back, its rows 8 mm to either side of the seat, and a bearing."""
    ball = bd.catalogue.bearing("7206C")
    app = bd.Application()
    app.add("shaft", bd.Shaft([bd.Section(0.2, 0.03)], {"a": 0.03, "b": 0.17}))
    app.bearing("set", Pair(ball, "DB", distance=0.016, preload_force=100.0), inner="shaft.a", outer="ground")
    app.bearing("b", bd.catalogue.bearing("6206"), inner="shaft.b", outer="ground")
    return app


def test_the_rows_of_a_set_stand_side_by_side() -> None:
    app = paired()
    places = [app.plan.bearings[f"set-{k}"].place for k in (1, 2)]
    assert places[0] == -places[1] != 0.0
    ax = app.draw()
    from matplotlib.patches import Circle

    centres = {round(float(p.center[0]), 6) for p in ax.patches if isinstance(p, Circle)}
    assert centres == {round(1e3 * z, 6) for z in (*places, 0.14)}


def test_notes_lie_clear_of_other_words_where_there_is_no_list() -> None:
    ax = bd.examples.fan().draw(table=False)
    ax.figure.canvas.draw()
    note = next(t for t in ax.texts if t.get_text().startswith("gravity")).get_window_extent()
    others = [t.get_window_extent() for t in ax.texts if t.get_text() and "gravity" not in t.get_text()]
    assert len(others) > 8
    assert not any(note.overlaps(each) for each in others)
    assert ax.figure.bbox.containsx(note.x0)
    assert ax.figure.bbox.containsy(note.y0), "within the sheet"


def test_balloons_stand_above_places_whose_part_is_not_drawn() -> None:
    app = bd.Application()
    app.add("shaft", bd.Shaft([bd.Section(0.2, 0.02)], {"a": 0.01, "b": 0.19}))
    box = bd.Housing(0.09, 0.12, 0.02, 0.04, 0.07, f_max=5e3, element_size=0.02).superelement()
    app.add("box", box)
    app.connect("shaft.a", "box.bore", fits=False)
    app.ground("box.feet")
    ax = app.draw()
    number = next(t for t in ax.texts if t.get_text() == "1")
    assert machine(app.plan).missing == ["box"]
    assert number.get_position()[1] > 1e3 * app.plan.positions()["box.top"][1]


def test_an_arrow_stands_on_the_surface_that_it_presses(layered: bd.Application) -> None:
    ax = layered.draw()
    arrows = [t for t in ax.texts if getattr(t, "arrow_patch", None) is not None and t.get_text() == ""]
    tips = [tuple(np.round(t.xy, 6)) for t in arrows]
    assert (90.0, 15.0) in tips, "1 kN downwards on the shaft of Ø30 mm, 90 mm from the left bearing"


@pytest.mark.parametrize(
    ("x", "told"), [(1000.0, "1 kN"), (-1500.0, "−1.5 kN"), (0.03, "30 mN"), (0.0, "0 N"), (999.9, "999.9 N")]
)
def test_a_value_is_told_in_the_prefix_that_suits_it(x: float, told: str) -> None:
    assert value(x, "N") == told


def test_labels_keep_their_order_and_their_distance() -> None:
    wanted = np.array([0.0, 0.1, 0.2, 5.0, 5.0, 9.0])
    found = spread(wanted, 1.0)
    assert (np.diff(found) >= 1.0 - 1e-12).all()
    assert found[:3].mean() == pytest.approx(wanted[:3].mean()), "pushed apart about where they were"
    assert found[5] == 9.0


def test_a_designation_is_found_from_the_geometry() -> None:
    assert designation(bd.catalogue.bearing("6205")) == ("6205", True)
    name, exact = designation(bd.catalogue.bearing("6305", balls=7, clearance=1e-5))
    assert (name, exact) == ("6305", False)
    assert designation(bd.BallBearing(8, 6e-3, 25e-3, 0.52, 0.53, clearance=1e-5)) == ("", False)


def test_the_line_of_contact_leans_to_the_shoulder_and_turns_with_the_bearing() -> None:
    import matplotlib.pyplot as plt

    from bearingdyn.plot.drawing.bearing_section import draw_bearing

    slopes = []
    for ball in (bd.catalogue.bearing("7206C"), bd.catalogue.bearing("7206C").mirrored()):
        _, ax = plt.subplots()
        draw_bearing(ax, ball, np.zeros(2))
        upper = next(line for line in ax.lines if line.get_ydata().mean() > 0)
        z, r = np.asarray(upper.get_xdata()), np.asarray(upper.get_ydata())
        slopes.append(math.degrees(math.atan2(z[1] - z[0], r[1] - r[0])))
    # its inner ring carries load towards +z: the outer race is touched at +z
    assert slopes == pytest.approx([15.0, -15.0])


def test_a_plane_cuts_a_tube_into_two_rectangles() -> None:
    tube = bd.RigidBody.ring(0.02, 0.03, 0.01).outline()
    found = [loop for loop in cut(tube.points, tube.faces) if np.ptp(loop[:, 1]) > 1e-6]
    assert len(found) == 2
    area = sum(0.5 * abs(np.cross(a, np.roll(a, -1, axis=0)).sum()) for a in (_flat(f) for f in found))
    assert area == pytest.approx(2 * 0.01 * 0.01, rel=1e-4)  # the plane lies 1e-7 beside the axis


def _flat(loop: np.ndarray) -> np.ndarray:
    return np.column_stack([loop, np.zeros(len(loop))])


def test_springs_ground_moments_and_harmonic_loads_are_drawn() -> None:
    app = bd.Application()
    app.add("mass", bd.RigidBody(mass=2.0, inertia=(1e-3, 1e-3, 1e-3)))
    app.ground("mass.centre", stiffness=[1e6] * 6, damping=[10.0] * 6)
    app.load("mass.centre", (5.0, 0, 0, 2.0, 0, 0.5))
    app.load("mass.centre", (0, 3.0, 0, 0, 0, 0), frequency=50.0)
    app.gravity((0, -9.81, 0))
    said = " ".join(texts(app.draw()))
    for text in (
        "2 N m about x",
        "500 mN m about z",
        "5 N along x",
        "3 N cos at 50 Hz",
        "gravity: y −9.81 m/s²",
    ):
        assert text in said, text
    app.draw(app.draw().figure.add_axes((0.5, 0.5, 0.4, 0.4)))


def test_a_part_of_matrices_alone_is_named_as_not_drawn() -> None:
    app = bd.Application()
    app.add("shaft", bd.Shaft([bd.Section(0.2, 0.02)], {"a": 0.01, "b": 0.19}))
    app.add("box", bd.RigidBody(2.0, (1e-3, 1e-3, 1e-3)).superelement())
    app.connect("shaft.a", "box.centre")
    app.ground("shaft.b")
    assert any("look like: box" in t for t in texts(app.draw()))


def test_an_application_without_parts_is_refused() -> None:
    with pytest.raises(ValueError, match="the application has no parts"):
        bd.Application().draw()
    assert "without parts" in bd.Application()._repr_html_()


def test_the_scene_has_every_part_and_every_ball(layered: bd.Application) -> None:
    pytest.importorskip("pyvista")
    scene = layered.scene()
    assert set(scene.keys()) == {*layered.plan.parts, "left", "right"}
    assert np.array(scene.bounds) == pytest.approx([-0.045, 0.045, -0.07, 0.05, -0.01, 0.19], abs=1e-6)
    balls = scene["left"]
    r = np.hypot(balls.points[:, 0], balls.points[:, 1])
    # pyvista's sphere of 30 × 30 is within 1 % of round
    assert r.max() == pytest.approx((0.0285 + 0.006746) / 2, rel=1e-2)


# ------------------------------------------------------------------------------------------- notebooks


@pytest.mark.parametrize("name", ["application", "material", "fitted", "bearing", "equilibrium"])
def test_objects_show_themselves_as_html_without_scripts(name: str, layered: bd.Application) -> None:
    fitted = bd.fit_maxwell(
        bd.master_curve(bd.read_dma(bd.sample_dma_path()), T_ref=20.0),
        n=3,
        band=(10.0, 5e3),
        K=2e9,
        density=1150.0,
    )
    shown = {
        "application": layered,
        "material": RUBBER,
        "fitted": fitted,
        "bearing": bd.catalogue.bearing("7206C"),
        "equilibrium": bd.equilibrium(layered),
    }[name]
    page = shown._repr_html_()  # type: ignore[attr-defined]
    assert "<script" not in page
    assert "http://www.w3.org" in page or name == "equilibrium"
    assert not re.search(r"""(src|href)=["'](?!#)""", page), "nothing is fetched"
    assert page == shown._repr_html_(), "the same object shows the same page"  # type: ignore[attr-defined]
    body = re.sub(r"<!--.*?-->", "", page, flags=re.DOTALL)
    ElementTree.fromstring(body.replace("&nbsp;", " "))
    wanted = {
        "application": ["ball bearing 6203", "shaft.middle", "free to turn about z: shaft", "<svg"],
        "material": ["relaxed modulus G0", "1 MPa", "<svg"],
        "fitted": ["points, storage within", "at 20 °C"],
        "bearing": ["free contact angle", "15.00°", "7206C"],
        "equilibrium": ["balls pressed", "shaft.middle", "deflection, µm"],
    }[name]
    for text in wanted:
        assert text in page, text


def test_drawing_leaves_no_figure_open_and_no_setting_changed(
    layered: bd.Application, tmp_path: Path
) -> None:
    import matplotlib.pyplot as plt

    before, open_ = dict(matplotlib.rcParams), plt.get_fignums()
    layered._repr_html_()
    assert plt.get_fignums() == open_
    assert dict(matplotlib.rcParams) == before
    layered.draw().figure.savefig(tmp_path / "sheet.pdf")
    assert (tmp_path / "sheet.pdf").stat().st_size > 5000
