"""What objects and results show of themselves in a notebook."""

from __future__ import annotations

import json
import re
from functools import cache
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest

import bearingdyn as bd
from bearingdyn.plot.object_tables import parameters_of

RUBBER = bd.Maxwell(G0=1e6, G=[1e6], tau=[1e-3], K=2e9, density=1150.0)


@cache
def shaft() -> bd.Superelement:
    return bd.Shaft([bd.Section(0.2, 0.02)], {"a": 0.02, "b": 0.18}, f_max=5e3).superelement()


@cache
def rested() -> bd.Equilibrium:
    app = bd.Application()
    app.add("<mass> & co", bd.RigidBody(mass=2.0, inertia=(1e-3, 1e-3, 1e-3)))
    app.ground("<mass> & co.centre", stiffness=[1e6] * 6, damping=[20.0] * 6)
    app.load("<mass> & co.centre", (0.0, -5.0, 0.0, 0.0, 0.0, 0.0))
    return bd.equilibrium(app)


def dma() -> bd.DMAData:
    return bd.read_dma(bd.sample_dma_path())


def warm() -> bd.OperatingPoint:
    app = bd.examples.spindle()
    oil = bd.bearing.Lubricant(bd.bearing.Walther.iso_vg(32))
    return bd.operating_point(app, speed=300.0, oil=oil)


PAGES = {
    "measurement": (dma, ["DMA measurement in", "isotherms", "MPa", "<svg"]),
    "layer": (lambda: bd.Layer(0.026, 0.028, 0.016, RUBBER), ["r_inner", "0.026", "Layer"]),
    "housing": (
        lambda: bd.Housing(0.1, 0.1, 0.03, 0.04, f_max=0.0),
        ["bore_diameter", "Diameter of the bore"],
    ),
    "solid": (
        lambda: bd.Solid(bd.box_mesh(*3 * [np.array([0.0, 0.1])], "hex20"), bd.STEEL, {"feet": "x-"}),
        ["mesh", "Solid"],
    ),
    "flexible ring": (
        lambda: bd.FlexibleRing.of(bd.catalogue.bearing("6203"), outside="flexible"),
        ["FlexibleRing", "r_inner"],
    ),
    "rigid body": (lambda: bd.RigidBody(2.0, (1e-3, 1e-3, 1e-3)), ["mass", "2"]),
    "pair": (
        lambda: bd.bearing.Pair(bd.catalogue.bearing("7205C"), "DB", 0.015, preload_force=100.0),
        ["Pair", "arrangement", "back to back"],
    ),
    "softening": (lambda: bd.Payne(1e6, 0.004, 0.6, 1e5, 0.01), ["Payne"]),
    "superelement": (shaft, ["coordinates", "a, b", "gyroscopic"]),
    "system": (lambda: rested().system, ["&lt;mass&gt; &amp; co", "System"]),
    "warm state": (warm, ["°C", "oil, cSt"]),
}


@pytest.mark.parametrize("name", PAGES)
def test_objects_show_a_short_page_that_needs_nothing_else(name: str) -> None:
    """Well formed, without scripts, fetched files or colours of its own but those of its figures."""
    make, wanted = PAGES[name]
    shown = make()
    page = shown._repr_html_()
    assert page == shown._repr_html_()
    text = re.sub(r"<svg.*?</svg>", "", page, flags=re.DOTALL)
    assert len(text) < 8000, "the page is short"
    for mark in ("<script", "src=", "href=", "background", "color:#0", "color:black", "color:white"):
        assert mark not in text, mark
    ElementTree.fromstring(re.sub(r"<!--.*?-->", "", page, flags=re.DOTALL))
    for one in wanted:
        assert one in page, one


def test_every_public_class_that_is_told_by_fields_shows_itself() -> None:
    """Of the parts and materials that the package names, none is left to its one line."""
    names = [*bd.PUBLIC["material"]["material"], *bd.PUBLIC["part"]["parts"]]
    plain = {
        name
        for name in names
        if isinstance(kind := getattr(bd, name), type) and not hasattr(kind, "_repr_html_")
    }
    # what only says where or how, inside another object's line
    assert plain == {
        "BoreShape", "Cylinder", "EndFace", "Feet", "FlexibleBore", "Groove", "Line", "MeshNodes", "NodeSet",
        "Patch", "Region", "RigidSurface", "RingBed", "RingPoints", "Section", "Where",
    }  # fmt: skip


def test_a_field_is_said_by_the_first_clause_of_its_docstring() -> None:
    said = parameters_of(bd.Housing)
    assert said["width"] == "Extent along x, y and z, m"
    assert said["bore_height"] == "Height of the bore's axis above the base, m"
    assert parameters_of(int) == {}


def test_what_does_not_show_itself_is_refused() -> None:
    with pytest.raises(ValueError, match="thing is 3; give an application, part, bearing"):
        bd.plot.as_html(3)


def test_a_result_tells_in_words_what_it_was_made_from(tmp_path: Path) -> None:
    """Before the JSON, on its page and in its file."""
    found = bd.modes(rested())
    page = found._repr_html_()
    assert "parts &lt;mass&gt; &amp; co (RigidBody); loads at &lt;mass&gt; &amp; co.centre" in page
    assert json.loads(found.attrs["inputs"])["sources"]["<mass> & co"]["mass"] == 2.0
    bd.save(found, tmp_path / "modes.nc")
    assert bd.open_result(tmp_path / "modes.nc").attrs == found.attrs


def test_what_is_long_is_told_by_its_hash_and_its_name() -> None:
    from bearingdyn.results.provenance import in_words

    assert in_words('{"sha256": "0"}') == ""
    assert in_words('{"sources": {"sha256": "0"}, "loads": {"sha256": "0"}}') == ""
    assert in_words("no JSON") == in_words("[1]") == ""
    assert in_words('{"bearings": {"left": {}, "right": {}}}') == "bearings left, right"
