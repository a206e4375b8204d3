"""A model is a file: read, written, run; what is wrong in it is told with file, line and key."""

from __future__ import annotations

import random
import re
import time
import tomllib
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import bearingdyn as bd
import make_example_models
from bearingdyn import examples
from bearingdyn.bearing import Pair
from bearingdyn.cli import main
from bearingdyn.core import SolverError
from bearingdyn.model.key_lines import key_lines
from bearingdyn.model.notation import evaluate, grid, quantity
from bearingdyn.notice import Notice

MACHINES = ("motor", "fan", "spindle", "pump")
BENCH = """\
format = 1
title = "a rotor on a layer"

[parameters]
gap = "3 mm"          # thickness of the rubber
thickness = "= 0.003"
weight = 4.0

[materials.rubber]
type = "Maxwell"
G0 = "1 MPa"
G = ["1 MPa", 2e6]
tau = [1e-3, 1e-4]
K = "2 GPa"
density = 1150.0

[parts.rotor]
type = "RigidBody"
mass = "= weight"
inertia = [0.02, 0.02, 0.004]
rotating = true

[parts.layer]
type = "Layer"
r_inner = "26 mm"
r_outer = "= 26 * mm + thickness"
width = "16 mm"
material = "rubber"

[bearings.ball]
designation = "6205"
clearance = "10 µm"
damping = 30.0
inner = "rotor.centre"
outer = "layer.inner"

[[joints]]
ground = "layer.outer"

[[loads]]
at = "rotor.centre"
force = [0.0, "-0.4 kN", 100.0, 0.0, 0.0, 0.0]

[[analyses]]
type = "modes"
count = 3

[[analyses]]
name = "response"
type = "frequency_response"
frequency = { from = 10, to = 1000, count = 3, spacing = "log" }
inputs = ["rotor.centre.y"]
outputs = ["rotor.centre.y"]
"""


@pytest.fixture
def bench(tmp_path: Path) -> Path:
    path = tmp_path / "bench.toml"
    path.write_text(BENCH.replace('gap = "3 mm"          # thickness of the rubber\n', ""), encoding="utf-8")
    return path


def by_hand() -> bd.Application:
    rubber = bd.Maxwell(G0=1e6, G=[1e6, 2e6], tau=[1e-3, 1e-4], K=2e9, density=1150.0)
    app = bd.Application()
    app.add("rotor", bd.RigidBody(4.0, (0.02, 0.02, 0.004), rotating=True))
    app.add("layer", bd.Layer(26 * 1e-3, 26 * 1e-3 + 0.003, 16 * 1e-3, rubber))
    ball = bd.catalogue.bearing("6205", clearance=10 * 1e-6, damping=30.0)
    app.bearing("ball", ball, inner="rotor.centre", outer="layer.inner")
    app.ground("layer.outer")
    app.load("rotor.centre", (0, -0.4 * 1e3, 100.0, 0, 0, 0))
    return app


def same(a: Any, b: Any) -> None:
    assert a.keys() == b.keys()
    for name in a:
        for variable in a[name].variables:
            one, other = (x[name][variable].values for x in (a, b))
            numbers = one.dtype.kind in "iufc"
            assert np.array_equal(one, other, equal_nan=numbers), (name, variable)


# ------------------------------------------------------------------------------------------------- reading


def test_a_file_gives_bit_for_bit_what_the_script_gives(bench: Path) -> None:
    model = bd.read_model(bench)
    found = model.run()
    eq = bd.equilibrium(by_hand())
    assert np.array_equal(model.equilibrium().x, eq.x)
    frequency = np.geomspace(10, 1000, 3)
    place = ["rotor.centre.y"]
    same(
        found,
        {"modes": bd.modes(eq, 3), "response": bd.frequency_response(eq, frequency, place, place)},
    )


def test_parameters_are_set_for_a_sweep(bench: Path) -> None:
    model = bd.read_model(bench, thickness=0.006, weight=5.0)
    assert model.application.plan.sources["layer"].r_outer == 26e-3 + 0.006  # type: ignore[attr-defined]
    assert model.application.mass("rotor") == 5.0
    with pytest.raises(ValueError, match=r"thicknes is no parameter of this model; did you mean 'thickness'"):
        bd.read_model(bench, thicknes=0.006)


def test_a_mirrored_bearing_carries_the_other_way(tmp_path: Path) -> None:
    """A 7205 whose open side is turned takes the thrust that it refused, with the mirrored displacement."""
    text = BENCH.replace('gap = "3 mm"          # thickness of the rubber\n', "").replace('"6205"', '"7205B"')
    text = text.replace('clearance = "10 µm"\n', "")
    found = {}
    for sign, extra in ((1.0, ""), (-1.0, "mirrored = true\n")):
        path = tmp_path / f"open{sign}.toml"
        shown = text.replace("damping = 30.0\n", f"damping = 30.0\n{extra}").replace(
            "100.0, 0.0", f"{900 * sign}, 0.0"
        )
        path.write_text(shown.replace("-0.4 kN", "-0.1 kN"), encoding="utf-8")
        found[sign] = bd.equilibrium(bd.read_model(path).application).displacement("rotor.centre")
    np.testing.assert_allclose(found[-1.0][2], -found[1.0][2], rtol=1e-8)
    assert abs(found[1.0][2]) > 1e-6


def test_includes_bring_materials_and_parts(tmp_path: Path) -> None:
    text = BENCH.replace("gap", "unused")
    rubber = text[text.index("[materials.rubber]") : text.index("[parts.rotor]")]
    (tmp_path / "sub").mkdir()
    (tmp_path / "sub" / "rubber.toml").write_text(rubber, encoding="utf-8")
    whole = text.replace(rubber, "").replace('title = "a', 'include = ["sub/rubber.toml"]\ntitle = "a')
    (tmp_path / "whole.toml").write_text(whole, encoding="utf-8")
    model = bd.read_model(tmp_path / "whole.toml")
    assert np.array_equal(model.equilibrium().x, bd.equilibrium(by_hand()).x)
    (tmp_path / "sub" / "rubber.toml").write_text(rubber.replace("2e6", "-2e6"), encoding="utf-8")
    with pytest.raises(
        ValueError, match=r"rubber\.toml, line 4, materials\.rubber\.G: Maxwell\.G\[1\] is -2000000"
    ):
        bd.read_model(tmp_path / "whole.toml")


def test_a_material_comes_from_a_file_or_from_measurements(tmp_path: Path) -> None:
    rubber = bd.Maxwell(G0=1e6, G=[1e6], tau=[1e-3], K=2e9, density=1150.0)
    (tmp_path / "rubber.json").write_text(rubber.to_json(), encoding="utf-8")
    head = BENCH[: BENCH.index("[materials.rubber]")].replace("gap", "unused")
    tail = BENCH[BENCH.index("[parts.rotor]") :]
    path = tmp_path / "m.toml"
    path.write_text(head + '[materials.rubber]\nfile = "rubber.json"\n' + tail, encoding="utf-8")
    assert bd.read_model(path).materials["rubber"] == rubber
    fitted = (
        '[materials.rubber]\ndma = "sample"\ncurve = { T_ref = 20.0 }\n'
        'fit = { n = 3, band = [10.0, 5e3], K = "= 2 * GPa", density = 1150.0 }\n'
    )
    path.write_text(head + fitted + tail, encoding="utf-8")
    curve = bd.master_curve(bd.read_dma(bd.sample_dma_path()), T_ref=20.0)
    assert bd.read_model(path).materials["rubber"] == bd.fit_maxwell(
        curve, n=3, band=(10.0, 5e3), K=2e9, density=1150.0
    )


# ------------------------------------------------------------------------------------------------- writing


@pytest.mark.parametrize("name", MACHINES)
def test_the_shipped_file_is_what_the_machine_is_written_as(name: str, tmp_path: Path) -> None:
    model = make_example_models.models(name)[name]
    bd.write_model(model, tmp_path / "new.toml")
    shipped = examples.model_path(name).read_text(encoding="utf-8")
    assert (tmp_path / "new.toml").read_text(encoding="utf-8") == shipped, "run tests/make_example_models.py"
    assert tomllib.loads(shipped)["format"] == 1


@pytest.mark.parametrize("name", MACHINES)
def test_a_shipped_file_run_gives_bit_for_bit_the_machines_own_results(name: str, tmp_path: Path) -> None:
    own = make_example_models.models(name)[name]
    read = bd.read_model(examples.model_path(name))
    same(read.run(), own.run())
    bd.write_model(read, tmp_path / "again.toml")
    assert (tmp_path / "again.toml").read_bytes() == examples.model_path(name).read_bytes()


def test_every_kind_of_joint_and_load_comes_back(tmp_path: Path) -> None:
    rubber = bd.Maxwell(G0=1e6, G=[2e6], tau=[1e-4], K=2e9, density=1150.0)
    ball = bd.BallBearing(
        9, 7.94e-3, 39.04e-3, 0.52, 0.53, clearance=1e-5, kappa=1.1e10, arm=0.0197, angle0=0.3,
        waviness=[bd.Waviness("inner", 3, 1e-7)], damping=bd.LoadDamping(1e-5),
    )  # fmt: skip
    ring = bd.FlexibleRing(
        r_inner=0.0235, r_outer=0.026, width=0.015, arm=ball.arm, layer=bd.Layer(0.026, 0.030, 0.012, rubber)
    )
    app = bd.Application()
    app.add("rotor", bd.RigidBody(4.0, (0.02, 0.02, 0.004), rotating=True))
    app.add("plate", bd.RigidBody(2.0, (0.01, 0.01, 0.01)))
    app.add("ring", ring)
    app.add(
        "shelf", bd.Shaft([bd.Section(0.1, 0.01)], {"a": 0.0, "b": 0.1}, material=bd.Elastic(7e10, 0.3, 2700))
    )
    app.connect("ring.outer", "plate.centre", fits=False)
    app.ground("plate.centre", stiffness=[1e7] * 6, damping=[1.0] * 6, offset=[1e-6, 0, 0, 0, 0, 0])
    app.bearing("ball", ball, inner="rotor.centre", outer="ring.raceway", offset=1e-6)
    app.spring("shelf.a", "ground", [1e6] * 6)
    app.free("shelf.b")
    app.load("rotor.centre", (1 / 3, -400, 100, 0, 0, 0))
    app.load("rotor.centre", (0, 1, 0, 0, 0, 0), frequency=30.0, phase=0.1)
    app.load("rotor.centre", (0, 1, 0, 0, 0, 0), time=[0.0, 0.1], value=[0.0, 1.0])
    app.unbalance("rotor.centre", 1e-5, 0.2)
    app.gravity((0, -9.81, 0))
    app.base_motion((0, 1.0, 0), frequency=20.0)
    bd.write_model(app, tmp_path / "all.toml")
    back = bd.read_model(tmp_path / "all.toml").application
    assert back.summary() == app.summary()
    assert {str(c) for c in back.plan.unjudged} == {str(c) for c in app.plan.unjudged}
    assert len(back.plan.unjudged) == 1
    march: dict[str, Any] = {
        "speed": 100.0,
        "dt": 1e-5,
        "steps": 50,
        "record": ["rotor.centre.y", "shelf.b.x"],
    }
    one, other = (bd.transient(bd.equilibrium(a), **march) for a in (app, back))
    assert np.array_equal(one["record"].values, other["record"].values)


def test_who_edits_a_diameter_of_a_written_file_is_told_that_it_fits_no_more(tmp_path: Path) -> None:
    """The check of fits is left out where it was waived, and nowhere else."""
    text = (Path(bd.examples.__file__).parent / "motor.toml").read_text(encoding="utf-8")
    assert "fits" not in text
    (tmp_path / "edited.toml").write_text(text.replace("[0.017, 0.04, 0.012]", "[0.020, 0.04, 0.012]", 1))
    with pytest.raises(ValueError, match=r"edited\.toml, line \d+, .*17 mm.*20 mm|.*20 mm.*17 mm"):
        bd.read_model(tmp_path / "edited.toml")


def test_the_rows_of_a_set_come_back_to_their_places(tmp_path: Path) -> None:
    app = bd.Application()
    app.add("shaft", bd.Shaft([bd.Section(0.2, 0.03)], {"a": 0.03, "b": 0.17}))
    app.ground("shaft.b", stiffness=[1e6] * 6)
    pair = Pair(bd.catalogue.bearing("7206C"), "DB", distance=0.016, preload_force=100.0)
    app.bearing("set", pair, inner="shaft.a", outer="ground")
    app.load("shaft.b", (0.0, -50.0, 0.0, 0.0, 0.0, 0.0))
    bd.write_model(app, tmp_path / "pair.toml")
    back = bd.read_model(tmp_path / "pair.toml").application
    assert [b.place for b in back.plan.bearings.values()] == [b.place for b in app.plan.bearings.values()]
    assert np.array_equal(bd.equilibrium(back).x, bd.equilibrium(app).x)


def test_what_no_text_can_hold_is_named(tmp_path: Path) -> None:
    app = bd.Application()
    app.add("box", bd.RigidBody(2.0, (1e-3, 1e-3, 1e-3)).superelement())
    app.ground("box.centre")
    with pytest.raises(ValueError, match=r"part 'box' is a Superelement, which no text can hold"):
        bd.write_model(app, tmp_path / "box.toml")
    assert not (tmp_path / "box.toml").exists()


# ----------------------------------------------------------------------------------------------- bad input

BAD = [
    ('[parts.rotor]\ntype = "RigidBody"', '[parts.rotor]\ntype = "RigidBdy"', 17, "parts.rotor", "RigidBody"),
    ('mass = "= weight"\n', "", 16, "parts.rotor", "RigidBody lacks mass"),
    ("width = ", "widht = ", 26, "parts.layer", "did you mean 'width'"),
    ('"16 mm"', '"16 mm mm"', 26, "parts.layer.width", "has the unit mm twice; write it once"),
    ('"16 mm"', '"16 mm m⁻¹ mm"', 26, "parts.layer.width", "has the unit mm twice"),
    ('"16 mm"', '"16 mm/m * mm"', 26, "parts.layer.width", "has the unit mm twice"),
    ('"1 MPa"', '"1 N/(mm mm)"', 10, "materials.rubber.G0", "has the unit mm twice"),
    ('"16 mm"', '"16mm mm"', 26, "parts.layer.width", "lacks the space before its unit"),
    ('"16 mm"', '"16*mm"', 26, "parts.layer.width", "write '= 16*mm'"),
    ('"16 mm"', '"= 16 mm"', 26, "parts.layer.width", "such as 14 * mm"),
    ('width = "16 mm"', 'width = "16 mm"\nwidth = "16 mm"', 27, "width", "leave one of the two out"),
    ("[bearings.ball]", "[parts.layer]", 29, "parts.layer", "leave one of the two out"),
    ('"16 mm"', '"= 16 * mm * mm"', 34, "bearings.ball.outer", "of it lie on layer.inner"),
    ('"16 mm"', '"16 MPa"', 26, "parts.layer.width", "it must be in m"),
    ('"16 mm"', "16", 26, "parts.layer.width", "in mm"),
    ('"16 mm"', '"= 16 * mmm"', 26, "parts.layer.width", "did you mean 'mm'"),
    ('"16 mm"', "\"= __import__('os')\"", 26, "parts.layer.width", "no arithmetic"),
    ('"16 mm"', '"= 1 / 0"', 26, "parts.layer.width", "has no value"),
    ('material = "rubber"', 'material = "ruber"', 27, "parts.layer.material", "did you mean 'rubber'"),
    ("[parts.layer]", "[parts.lager]", 34, "bearings.ball", "names no part"),
    ('designation = "6205"', 'desgnation = "6205"', 30, "bearings.ball.desgnation", "mean 'designation'"),
    ("damping = 30.0", "dampin = 30.0", 32, "bearings.ball.dampin", "did you mean 'damping'"),
    ('designation = "6205"', 'designation = "6299"', 30, "bearings.ball.designation", "6299"),
    ('outer = "layer.inner"\n', "", 29, "bearings.ball", "lacks outer"),
    ('ground = "layer.outer"', 'grund = "layer.outer"', 36, "joints[1]", "it must have one of"),
    ('[[joints]]\nground = "layer.outer"\n', "", 22, "parts.layer", "layer.outer is not connected"),
    ('at = "rotor.centre"\n', "", 39, "loads[1]", "lacks at"),
    ('"-0.4 kN"', '"-0.4 m"', 41, "loads[1].force", "is in m"),
    ("count = 3\n", "coutn = 3\n", 45, "analyses[1]", "did you mean 'count'"),
    ('type = "modes"', 'type = "mods"', 44, "analyses[1].type", "did you mean 'modes'"),
    ("count = 3, spacing", "count = 0, spacing", 50, "analyses[2].frequency", "count is 0"),
    ('["rotor.centre.y"]', '["rotor.mid.y"]', 51, "analyses[2].inputs", "there are ['layer.inner'"),
    ('outputs = ["rotor.centre.y"]', 'outputs = ["rotor.y"]', 52, "analyses[2].outputs", "'rotor.centre.y'"),
    ('outputs = ["rotor.centre.y"]', 'outputs = ["rotor.centre.r"]', 52, "analyses[2].outputs", "not 'r'"),
    (
        '{ from = 10, to = 1000, count = 3, spacing = "log" }',
        '"geomspace(10, 2000, 200)"',
        50,
        "analyses[2].frequency",
        "numbers in Hz, or a grid: {from = 10",
    ),
    ("count = 3\n", 'count = "three"\n', 45, "analyses[1].count", "it must be a number"),
    ('"16 mm"', '"16mm"', 26, "parts.layer.width", "write '16 mm'"),
    ("format = 1", "format = 2", 1, "format", "another version"),
    ("[[analyses]]\n", "[[analysis]]\n", 43, "analysis", "did you mean 'analyses'"),
    ('title = "a rotor on a layer"', 'title = "a rotor', 2, "title", "line 2"),
]


@pytest.mark.parametrize(("old", "new", "line", "key", "said"), BAD, ids=lambda x: str(x)[:24])
def test_what_is_wrong_is_told_with_file_line_and_key(
    bench: Path, old: str, new: str, line: int, key: str, said: str
) -> None:
    text = bench.read_text(encoding="utf-8")
    assert old in text
    bench.write_text(text.replace(old, new, 1), encoding="utf-8")
    with pytest.raises(ValueError) as caught:
        bd.read_model(bench)
    told = str(caught.value)
    assert said in told
    assert f"line {line}, {key}" in told, told
    assert str(bench) in told


def test_a_circular_include_is_named_with_its_chain(tmp_path: Path) -> None:
    (tmp_path / "a.toml").write_text('format = 1\ninclude = ["b.toml"]\n')
    (tmp_path / "b.toml").write_text('include = "a.toml"\n')
    with pytest.raises(
        ValueError, match=r"b\.toml, line 1, include.*a\.toml includes b\.toml includes a\.toml"
    ):
        bd.read_model(tmp_path / "a.toml")


def test_a_circular_include_through_three_folders_or_a_link_is_named(tmp_path: Path) -> None:
    (tmp_path / "sub").mkdir()
    (tmp_path / "a.toml").write_text('format = 1\ninclude = ["sub/b.toml"]\n')
    (tmp_path / "sub" / "b.toml").write_text('include = ["../c.toml"]\n')
    (tmp_path / "c.toml").write_text('\ninclude = ["sub/../a.toml"]\n')
    told = r"c\.toml, line 2, include.*a\.toml includes b\.toml includes c\.toml includes a\.toml; leave one"
    with pytest.raises(ValueError, match=told):
        bd.read_model(tmp_path / "a.toml")
    (tmp_path / "c.toml").write_text('include = ["link.toml"]\n')
    try:
        (tmp_path / "link.toml").symlink_to("a.toml")
    except OSError:
        pytest.skip("this system makes no links")
    with pytest.raises(
        ValueError, match=r"line 1, include.*includes link\.toml \(a link to a\.toml\); leave"
    ):
        bd.read_model(tmp_path / "a.toml")


def test_a_part_in_two_files_and_a_file_that_is_not_there_are_named(tmp_path: Path) -> None:
    (tmp_path / "b.toml").write_text('[parts.x]\ntype = "RigidBody"\n')
    (tmp_path / "a.toml").write_text('format = 1\ninclude = ["b.toml"]\n[parts.x]\ntype = "RigidBody"\n')
    with pytest.raises(ValueError, match=r"a\.toml, line 3, parts\.x: x is in an included file already"):
        bd.read_model(tmp_path / "a.toml")
    (tmp_path / "a.toml").write_text('format = 1\ninclude = ["c.toml"]\n')
    with pytest.raises(ValueError, match=r"a\.toml, line 2, include.*c\.toml: no such file"):
        bd.read_model(tmp_path / "a.toml")


def test_what_an_analysis_refuses_is_told_with_its_line(bench: Path) -> None:
    bench.write_text(
        bench.read_text("utf-8").replace('outputs = ["rotor.centre.y"]', 'outputs = ["rotor.centr.y"]')
    )
    with pytest.raises(ValueError, match=r"analyses\[2\]\.outputs: .*rotor\.centr.*mean 'rotor\.centre'"):
        bd.read_model(bench)


def test_what_an_analysis_alone_knows_is_told_with_its_line(bench: Path) -> None:
    """A force on a bearing along no axis passes the reader, and not the analysis."""
    bench.write_text(
        bench.read_text("utf-8").replace('outputs = ["rotor.centre.y"]', 'outputs = ["ball.force.q"]')
    )
    with pytest.raises(ValueError, match=r"line 47, analyses\[2\]: .*ball\.force\.q"):
        bd.read_model(bench).run()


def test_a_file_without_its_format_is_told_the_line_to_add(bench: Path) -> None:
    """It is no file of another version."""
    bench.write_text(bench.read_text("utf-8").replace("format = 1", ""))
    with pytest.raises(
        ValueError, match=r"line 1, format: format is missing; the file must begin with a line format = 1"
    ):
        bd.read_model(bench)


def test_a_file_without_parts_is_told_where_to_add_them(tmp_path: Path) -> None:
    path = tmp_path / "m.toml"
    path.write_text('format = 1\ntitle = "nothing yet"\n', encoding="utf-8")
    with pytest.raises(ValueError, match=r"m\.toml, line 2, parts: .*at least one part: \[parts\.name\]"):
        bd.read_model(path)


def test_an_unbalance_in_the_wrong_unit_is_told_with_its_line(tmp_path: Path) -> None:
    """It is found with the equilibrium, which knows what turns with it."""
    text = examples.model_path("spindle").read_text(encoding="utf-8")
    line = next(k for k, row in enumerate(text.splitlines(), 1) if row.startswith("unbalance"))
    path = tmp_path / "m.toml"
    path.write_text(re.sub(r"(?m)^unbalance = .*$", "unbalance = 2.0", text), encoding="utf-8")
    with pytest.raises(
        ValueError, match=rf"m\.toml, line {line}, loads\[\d\]\.unbalance: unbalance at shaft"
    ):
        bd.read_model(path).run()


def mutated(text: str, draw: random.Random) -> str:
    """One slip of the kind that people make."""
    lines = text.splitlines()
    at = draw.randrange(len(lines))
    numbers = list(re.finditer(r"(?<![\w.])-?\d+\.?\d*(?:e-?\d+)?", text))
    words = list(re.finditer(r"[A-Za-z_]{3,}", text))
    kind = draw.randrange(8)
    if kind == 0:
        del lines[at]
    elif kind == 1:
        lines.insert(at, lines[draw.randrange(len(lines))])
    elif kind == 2:
        one = draw.choice(numbers)
        new = draw.choice(["-1", "0", "nan", "inf", "1e30", '"x"', "[]", "{}", "true", "1e-30", "1979-05-27"])
        return text[: one.start()] + new + text[one.end() :]
    elif kind == 3:
        one = draw.choice(words)
        k = draw.randrange(one.start(), one.end())
        return text[:k] + draw.choice("xyz_") + text[k + 1 :]
    elif kind == 4:
        k = draw.randrange(len(text))
        return text[:k] + text[k + 1 :]
    elif kind == 5:
        return text[: draw.randrange(len(text))]
    elif kind == 6:
        k = draw.randrange(len(text))
        return text[:k] + draw.choice('"[]{}=,#.') + text[k:]
    else:
        other = draw.randrange(len(lines))
        lines[at], lines[other] = lines[other], lines[at]
    return "\n".join(lines)


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore::UserWarning")
def test_200_mutated_files_are_refused_with_line_and_key_or_run(bench: Path) -> None:
    text, draw = bench.read_text(encoding="utf-8"), random.Random(21)
    refused, ran = [], 0
    for _ in range(200):
        bench.write_text(mutated(text, draw), encoding="utf-8")
        try:
            found = bd.read_model(bench).run()
        except ValueError as error:
            refused.append(str(error))
        except SolverError:  # a machine that is read, and has no equilibrium
            refused.append("bench.toml, line 0, x: no equilibrium")
        else:
            assert isinstance(found, dict)
            ran += 1
    unsaid = [e for e in refused if not re.search(r"bench\.toml, line \d+, [\w\[\].\-\"']+: ", e)]
    assert not unsaid
    assert len(refused) > 80
    assert ran > 10


# ------------------------------------------------------------------------------------------- small things


def test_what_is_no_model_at_all_is_told_with_its_file(tmp_path: Path) -> None:
    path = tmp_path / "x.toml"
    for data, said in (
        (b"\xff\xfe", "no UTF-8"),
        (b"a = " + b"[" * 20_000, "nested too deep"),
        # tomllib nests these in minutes
        (b"format = 1\n" + b"a." * 100_000 + b"a = 1", "thirty parts joined by dots"),
        (b"format = 1\n[" + b'"a" . ' * 100_000 + b"a]", "thirty parts joined by dots"),
        (b"format = 1\nx = {" + b"'a'." * 100_000 + b"a = 1}", "thirty parts joined by dots"),
    ):
        path.write_bytes(data)
        with pytest.raises(ValueError, match=said) as caught:
            bd.read_model(path)
        assert str(path) in str(caught.value)


def test_lines_of_many_numbers_are_found_in_one_pass() -> None:
    # a load sampled at 50 000 times; counting the lines anew at every key grows with the square
    def least(count: int) -> float:
        text = "a = [\n" + "".join(f"    {k}.5,\n" for k in range(count)) + "]\nb = 1\n"
        seconds = []
        for _ in range(3):
            start = time.process_time()
            found = key_lines(text)
            seconds.append(time.process_time() - start)
        assert found["a", count - 1] == count + 1
        assert found["b",] == count + 3
        return min(seconds)

    assert least(48_000) < 9.0 * least(12_000)  # 4 in one pass, 16 where each key counts anew


def test_lines_of_keys() -> None:
    text = '# c\na = 1\n[b.c]\n"d e" = """x\n]y"""\nf = [1, # [\n 2, {g = "}"}]\n'
    text += "[[h]]\ni.j = 2\n[[h]]\n[h.k]\nl = 'a\"b'\n"
    found = key_lines(text)
    wanted = {
        ("a",): 2,
        ("b", "c"): 3,
        ("b", "c", "d e"): 4,
        ("b", "c", "f", 1): 7,
        ("b", "c", "f", 2, "g"): 7,
    }
    wanted |= {("h", 0): 8, ("h", 0, "i", "j"): 9, ("h", 1): 10, ("h", 1, "k", "l"): 12}
    for key, line in wanted.items():
        assert found[key] == line, key


@pytest.mark.parametrize("name", MACHINES)
def test_every_key_of_the_shipped_files_has_a_line(name: str) -> None:
    text = examples.model_path(name).read_text(encoding="utf-8")
    found = key_lines(text)

    def keys(value: Any, at: tuple[Any, ...]) -> Any:
        if isinstance(value, dict):
            for k, v in value.items():
                yield (*at, k)
                yield from keys(v, (*at, k))
        elif isinstance(value, list):
            for k, v in enumerate(value):
                yield from keys(v, (*at, k))

    lines = text.splitlines()
    for key in keys(tomllib.loads(text), ()):
        assert str(key[-1]) in lines[found[key] - 1], key


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("2 * 3 + 1", 7.0),
        ("-gap ** 2", -9.0),
        ("30 * mm", 0.03),
        ("3000 * rpm", 3000 * np.pi / 30),
        ("pi", np.pi),
    ],
)
def test_expressions(text: str, value: float) -> None:
    assert evaluate(text, {"gap": 3.0}) == value


@pytest.mark.parametrize(
    "text", ["", "a.b", "(1).real", "lambda: 1", "1 if 1 else 2", "[1]", "'x'", "9**9**9**9", "1+"]
)
def test_what_is_no_arithmetic_is_refused(text: str) -> None:
    with pytest.raises(ValueError, match=r"arithmetic|value"):
        evaluate(text, {})


def test_quantities_and_grids() -> None:
    assert quantity("30 mm", "m") == 30 * 1e-3
    assert quantity("shaft.left", "m") is None
    assert quantity("293.15 K", "°C") == 20.0
    assert quantity("3 N mm/mm", "N") == quantity("3000 N/(m s) mm s", "N") == 3.0  # one each way
    assert grid({"from": 1, "to": 100, "count": 3, "spacing": "log"}).tolist() == pytest.approx([1, 10, 100])
    with pytest.raises(ValueError, match="count is missing"):
        grid({"from": 1, "to": 2})


# -------------------------------------------------------------------------------------------- command line


def test_the_command_line_runs_and_checks_a_file(
    bench: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["check", str(bench)]) == 0
    said = capsys.readouterr().out
    assert "a rotor on a layer" in said
    assert "ball: rotor.centre in layer.inner" in said
    out = tmp_path / "r.nc"
    assert main(["run", str(bench), "--out", str(out), "--set", "weight=5"]) == 0
    assert "written to" in capsys.readouterr().out
    kept = bd.open_result(out, "modes")
    assert np.array_equal(kept["frequency"], bd.read_model(bench, weight=5.0).run()["modes"]["frequency"])
    bench.write_text(BENCH.replace('"16 mm"', "16"), encoding="utf-8")
    assert main(["check", str(bench)]) == 2
    assert "line 27, parts.layer.width" in capsys.readouterr().err


def test_every_example_is_quiet_of_slips(recwarn: pytest.WarningsRecorder) -> None:
    for name in ("fan", "spindle"):
        getattr(examples, name)()
    assert not [w for w in recwarn if issubclass(w.category, Notice)]


@pytest.mark.slow
def test_the_rubber_of_the_examples_is_the_fit_it_says() -> None:
    curve = bd.master_curve(bd.read_dma(bd.sample_dma_path()), T_ref=20.0)
    fitted = bd.fit_maxwell(curve, n=5, band=(10.0, 5e3), pin=60.0, K=2e9, density=1150.0)
    omega = 2 * np.pi * np.geomspace(10.0, 5e3, 50)
    # an optimiser stops elsewhere on another machine
    assert examples.rubber().complex_modulus(omega) == pytest.approx(fitted.complex_modulus(omega), rel=1e-3)


@pytest.mark.parametrize("wrong", [["modes"], [5], "modes", [None]])
def test_what_a_model_is_asked_is_a_list_of_analyses(wrong):
    app = bd.Application()
    app.add("mass", bd.RigidBody(2.0, (1e-3, 1e-3, 1e-3)))
    with pytest.raises(ValueError, match=r"analyses(\[0\])? is .*; it must be a"):
        bd.Model(app, wrong)


def test_a_model_that_an_editor_saved_with_a_mark_of_its_encoding_is_read(tmp_path):
    """Windows writes EF BB BF, and ends lines with CR LF."""
    path = tmp_path / "m.toml"
    plain = examples.model_path("pump").read_text(encoding="utf-8")
    path.write_bytes(b"\xef\xbb\xbf" + plain.replace("\n", "\r\n").encode())
    assert set(bd.read_model(path).application.names()) == set(examples.pump().names())
