"""Meshes of solids made by hand and by the built-in meshers, and what is wrong with some of them."""

from __future__ import annotations

import math

import numpy as np
import pytest

from bearingdyn.fem import (
    SolidMesh,
    assemble_solid,
    block_with_bore,
    box_mesh,
    crowded,
    o_ring_mesh,
    ring_mesh,
)
from bearingdyn.fem.meshes.solid_element import KINDS
from bearingdyn.material import STEEL

pytest.importorskip("skfem")


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"points": np.zeros((20, 2))}, r"points has shape \(20, 2\)"),
        ({"elements": [[0] * 12]}, r"elements has shape \(1, 12\); a row holds 20 or 27"),
        ({"elements": [list(range(1, 21))]}, "element 0 names a node outside 0...19"),
        ({"regions": {"a": []}}, r"regions\['a'\] is empty"),
        ({"regions": {"a": [1]}}, r"regions\['a'\] names an element outside 0...0"),
        ({"regions": {"a": [0], "b": [0]}}, r"element 0 is in the regions \['a', 'b'\]"),
        ({"surfaces": {"s": []}}, r"surfaces\['s'\] is empty; it must name nodes"),
        ({"surfaces": {"s": [20]}}, r"surfaces\['s'\] names a node outside 0...19"),
        ({"numbers": [1, 2]}, r"numbers has shape \(2,\); it must be \(1,\)"),
    ],
)
def test_mesh_refuses(change, message):
    box = box_mesh([0, 1], [0, 1], [0, 1])
    with pytest.raises(ValueError, match=message):
        SolidMesh(**({"points": box.points, "elements": box.elements} | change))


def test_surfaces_and_regions_can_be_added_by_place_and_not_by_mistake():
    mesh = box_mesh([0, 1, 2], [0, 1], [0, 1]).with_surface("low", lambda p: p[:, 2] < 0.1)
    assert mesh.samples("low").area == pytest.approx(2.0)
    assert mesh.with_region("left", lambda p: p[:, 0] < 1).volume("left") == pytest.approx(1.0)
    for call, message in (
        (lambda: mesh.with_surface("low", lambda p: p[:, 2] < 1), "has a surface 'low' already"),
        (lambda: mesh.with_surface("none", lambda p: p[:, 2] < -1), "surface 'none' is empty"),
        (lambda: mesh.with_region("body", lambda p: p[:, 2] < 1), "has a region 'body' already"),
        (lambda: mesh.with_region("none", lambda p: p[:, 2] < 0), "region 'none' is empty"),
        (lambda: mesh.surface("lid"), r"no surface 'lid'; there are \['low', 'x\+'"),
        (lambda: mesh.with_surface("dot", lambda p: p.sum(axis=1) == 0).faces("dot"), "holds no whole face"),
    ):
        with pytest.raises(ValueError, match=message):
            call()


def test_faces_of_a_brick_in_another_order_are_refused():
    box = box_mesh([0, 1], [0, 1], [0, 2], "hex27")
    order = [*range(20), 22, 23, 21, 20, 24, 25, 26]
    with pytest.raises(ValueError, match="element 0 has the middle of a face or its centre out of place"):
        SolidMesh(box.points, box.elements[:, order])


@pytest.mark.parametrize("element", ["hex20", "hex27"])
def test_ring_mesh_has_the_volume_and_faces_of_its_layers(element):
    a, b, c, width = 20.0, 22.0, 25.0, 8.0
    for angle, share in ((None, 1.0), ((0.3, 1.3), 1 / (2 * math.pi))):
        mesh = ring_mesh(
            (a, b, c), width, angle, across=(1, 2), along=3, around=16, regions=("in", "out"), element=element
        )
        # quadratic arcs of 22.5° or less are round to 2e-5
        assert mesh.volume("in") == pytest.approx(share * math.pi * (b**2 - a**2) * width, rel=1e-4)
        assert mesh.volume("out") == pytest.approx(share * math.pi * (c**2 - b**2) * width, rel=1e-4)
        assert mesh.samples("outer").area == pytest.approx(share * 2 * math.pi * c * width, rel=1e-4)
        assert mesh.samples("z+").area == pytest.approx(share * math.pi * (c**2 - a**2), rel=1e-4)
        assert ("start" in mesh.surfaces) == (angle is not None)
        if angle:
            assert mesh.samples("end").area == pytest.approx((c - a) * width, rel=1e-12)


def test_centres_added_to_bricks_leave_the_body_as_it_is():
    mesh = block_with_bore(60, 90, 12, 30, 50, 15, flange=(12, 8))
    full = mesh.with_centres()
    assert full.kind is KINDS[27]
    assert full.volume() == pytest.approx(mesh.volume(), rel=1e-13)
    for name in mesh.surfaces:
        assert full.samples(name).area == pytest.approx(mesh.samples(name).area, rel=1e-13)
    # a field the 20-node brick holds has the same energy in both
    at = np.arange(len(full.points))
    old = assemble_solid(mesh).stiffness(STEEL)
    u = (mesh.points @ np.array([[1.0, 0.3, 0.0], [0.0, 1.0, 0.2], [0.1, 0.0, 1.0]])).ravel()
    v = (full.points @ np.array([[1.0, 0.3, 0.0], [0.0, 1.0, 0.2], [0.1, 0.0, 1.0]])).ravel()
    assert at.size == len(full.points)
    assert v @ assemble_solid(full).stiffness(STEEL) @ v == pytest.approx(u @ old @ u, rel=1e-12)


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: box_mesh([0, 0], [0, 1], [0, 1]), r"x is \[0.0, 0.0\]; it must be two grid lines"),
        (lambda: box_mesh([0, 1], [0, 1], [0, 1], "hex8"), "element is 'hex8'"),
        (lambda: ring_mesh((2.0, 1.0), 1.0), r"radii is \(2.0, 1.0\)"),
        (lambda: ring_mesh((1.0, 2.0), math.nan), "width is nan"),
        (lambda: ring_mesh((1.0, 2.0), 1.0, (0.0, 7.0)), r"angle is \(0.0, 7.0\)"),
        (lambda: ring_mesh((1.0, 2.0), 1.0, around=4), "around is 4"),
        (lambda: ring_mesh((1.0, 2.0), 1.0, regions=("a", "b")), "1 layers need a name of its own"),
        (lambda: o_ring_mesh(1.0, 3.0, 1.0), "cord is 3.0 and radius 1.0"),
        (lambda: o_ring_mesh(5.0, 1.0, 0.1), "band is 0.1; it must lie in 0.2 to 0.95 of the cord"),
        (lambda: o_ring_mesh(5.0, 1.0, 0.5, across=1), "across is 1"),
        (lambda: o_ring_mesh(5.0, 1.0, 0.5, (1.0, 0.0)), r"angle is \(1.0, 0.0\)"),
        (lambda: crowded(1.0, 0.0, 2), "lines from 1.0 to 0.0"),
    ],
)
def test_meshers_refuse(call, message):
    with pytest.raises(ValueError, match=message):
        call()
