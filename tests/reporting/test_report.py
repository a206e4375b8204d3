"""The report's text: what was computed, what is doubted, where it comes from; and what is refused."""

from __future__ import annotations

import base64
import json
import re
import warnings
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import bearingdyn as bd
from bearingdyn.cli import main
from bearingdyn.notice import Notice
from bearingdyn.reporting.chart import Chart, Curve
from bearingdyn.reporting.of_results import everything
from bearingdyn.reporting.shapes import first_elastic
from report_page import curves, text_of


def test_a_small_motion_about_a_large_level_keeps_its_digits() -> None:
    """32-bit floats have seven digits; a shaft that sags 137 µm and moves by picometres needs nine."""
    x = np.linspace(0.0, 1.0, 50)
    y = -137.24 + 1e-6 * np.sin(20 * x)
    held = Chart("y", "s", "µm", [Curve("y", x, y), Curve("wide", x, 1e3 * x)]).held()["curves"]
    kept = np.frombuffer(base64.b64decode(held[0]["y"]), "<f4").astype(float) + held[0]["base"]
    np.testing.assert_allclose(kept, y, rtol=0, atol=1e-12)
    assert "base" not in held[1]


def test_an_equilibrium_gets_a_page(tmp_path: Path) -> None:
    """It is what an engineer has first; ratings are told as computed and as printed."""
    ball = bd.catalogue.bearing("6206")
    eq = bd.analysis.single_bearing(ball, radial=1000.0, name="front")
    told = text_of(bd.report(eq, tmp_path / "rest.html", title="A 6206 under 1 kN"))
    for said in ("At rest", "front", "Rating and life", "C computed by ISO 281 (NSK prints 19500 N)"):
        assert said in told, said


def test_a_page_without_a_title_has_the_name_of_its_file(mass: bd.Application, tmp_path: Path) -> None:
    assert "<h1>my rotor</h1>" in bd.report(mass, tmp_path / "my rotor.html").read_text(encoding="utf-8")


def test_a_material_with_a_dashpot_shows_it() -> None:
    """It raises G″ at high frequency, which no other row explains."""
    with_it = bd.Maxwell(G0=1e6, G=[1e6], tau=[1e-3], eta0=12.0, K=2e9, density=1150.0)
    without = bd.Maxwell(G0=1e6, G=[1e6], tau=[1e-3], K=2e9, density=1150.0)
    assert "12 Pa s" in with_it._repr_html_()
    assert "dashpot" not in without._repr_html_()


def test_the_shapes_open_with_the_first_elastic_mode() -> None:
    """The spin of the rotor, near 0 Hz, is the first of the list and nothing to look at."""
    xarray = pytest.importorskip("xarray")
    for frequency, first in (
        ([1e-4, 145.0, 437.0, 700.0], 1),
        ([0.0, 1e-3, 90.0, 99.0, 120.0], 2),
        ([9.0], 0),
    ):
        found = xarray.Dataset({"frequency": ("mode", frequency)})
        assert first_elastic(found, len(frequency)) == first


def test_a_range_of_one_number_is_that_number() -> None:
    """Layers that rested equally long say 60 s, not 60 to 60 s."""
    xarray = pytest.importorskip("xarray")
    data = xarray.Dataset({"time": ("layer", [60.0, 60.0], {"units": "s"})})
    assert "60 s" in everything(data)
    assert "60 to 60" not in everything(data)


def test_the_page_shows_the_resonance_of_a_mass_on_a_spring(mass: bd.Application, tmp_path: Path) -> None:
    f = np.linspace(50.0, 200.0, 601)
    found = bd.frequency_response(mass, f, ["mass.centre.y"], ["mass.centre.y"])
    page = bd.report(
        {"push": found, "modes": bd.modes(mass)}, tmp_path / "mass.html", model=mass, title="A mass"
    )
    ((name, x, y),) = curves(page, "mass.centre.y, by mass.centre.y")
    assert name == "push"
    # |1/(k − ω²m + iωc)| in µm/N, to the single precision of the page
    omega = 2 * np.pi * x.astype(float)
    exact = 1e6 / np.abs(1e6 - 2.0 * omega**2 + 10j * omega)
    assert y == pytest.approx(exact, rel=1e-4)  # x too is rounded, where the resonance is steep
    told = text_of(page)
    assert "112.5 Hz" in told  # √(k/m)/2π
    assert "displacement, zero-to-peak, µm/N" in page.read_text("utf-8")
    assert "A mass" in told
    assert found.attrs["inputs_hash"] in told


def test_designs_under_one_name_stand_in_one_chart(mass: bd.Application, tmp_path: Path) -> None:
    f = np.linspace(50.0, 200.0, 50)
    found = bd.frequency_response(mass, f, ["mass.centre.y"], ["mass.centre.y"])
    twice = found.assign(response=2 * found["response"].assign_attrs(found["response"].attrs))
    twice["response"].attrs.update(found["response"].attrs)
    page = bd.report({"r/soft": twice, "r/hard": found}, tmp_path / "two.html")
    (soft, _, y), (hard, _, z) = curves(page, "mass.centre.y, by mass.centre.y")
    assert (soft, hard) == ("soft", "hard")
    assert y == pytest.approx(2 * z, rel=1e-6)


def test_long_records_are_thinned_and_keep_their_extremes(mass: bd.Application, tmp_path: Path) -> None:
    run = bd.transient(bd.equilibrium(mass), speed=0.0, dt=1e-4, steps=50_000, record=["mass.centre.y"])
    y = np.zeros(50_000)
    y[31_415] = 7.0
    y[31_416] = -5.0
    run["record"].values[:, 0] = y
    ((_, x, drawn),) = curves(bd.report(run, tmp_path / "long.html"), "mass.centre.y")
    assert drawn.size <= 4002
    assert drawn.max() == 7.0
    assert drawn.min() == -5.0
    assert float(x[drawn.argmax()]) == pytest.approx(31_415 * 1e-4, rel=1e-6)


def test_warnings_stand_on_the_page_with_their_remedy_and_are_still_raised(tmp_path: Path) -> None:
    app = bd.examples.motor()
    app.load("shaft.middle", (0.0, -2000.0, 0.0, 0.0, 0.0, 0.0))
    with pytest.warns(Notice, match="layer") as caught:
        page = bd.report(app, tmp_path / "loaded.html")
    told = text_of(page)
    assert "What is doubted" in told
    assert " ".join(str(caught[0].message).split()) in told
    assert "Remedy: less load or a thicker layer" in told


def test_the_rubbers_doubt_and_the_sag_over_time_are_shown(tmp_path: Path) -> None:
    app = bd.examples.motor()
    page = bd.report(app, tmp_path / "motor.html")
    told = text_of(page)
    assert "show no plateau" in told
    assert "after an infinite time it may be from 0 to 2.65 MPa" in told
    found = {name: (x, y) for name, x, y in curves(page, "Sag of the layers over time")}
    x, y = found["left_layer"]
    state = bd.equilibrium(app, after=float(x[-1]))
    expected = 1e6 * float(bd.static_summary(state)["deflection"].sel(layer="left_layer"))
    assert float(y[-1]) == pytest.approx(expected, rel=1e-5)
    assert (np.diff(y) >= 0).all()  # rubber only relaxes
    assert (found["left_layer, at least"][1] <= y).all()
    assert (found["left_layer, at most"][1] >= y).all()


def test_results_of_another_machine_or_version_are_doubted(mass: bd.Application, tmp_path: Path) -> None:
    found = bd.modes(mass)
    other = bd.Application()
    other.add("mass", bd.RigidBody(mass=3.0, inertia=(1e-3, 1e-3, 1e-3)))
    other.ground("mass.centre", stiffness=[1e6] * 6)
    assert "other inputs" in text_of(bd.report(found, tmp_path / "a.html", model=other))
    assert "other inputs" not in text_of(bd.report(found, tmp_path / "b.html", model=mass))
    old = found.assign_attrs(made_by="bearingdyn 0.0.1, Python 3.11")
    said: list[str] = []
    assert "computed by version 0.0.1" in text_of(bd.report(old, tmp_path / "c.html", tell=said.append))
    assert any("computed by version 0.0.1" in line and "compute it anew" in line for line in said)
    del old.attrs["made_by"]
    assert "does not say what computed it" in text_of(bd.report({"x": old}, tmp_path / "d.html"))


def test_modes_that_nothing_holds_are_called_free_and_long_lists_end(
    mass: bd.Application, tmp_path: Path
) -> None:
    """A rotor's spin is found at a thousandth of a hertz of round-off; nobody reads a hundred modes."""
    found = bd.modes(mass)
    many = found.isel(mode=np.zeros(60, dtype=int))
    f = np.geomspace(100.0, 1e5, 60)
    f[0] = 9e-4
    many = (
        many.assign_coords(frequency=("mode", f))
        if "frequency" in many.coords
        else many.assign(frequency=("mode", f, many["frequency"].attrs))
    )
    text = text_of(bd.report(many, tmp_path / "many.html"))
    assert "free, nothing holds it" in text
    assert "20 more, up to 100 kHz, are in the result." in text
    held = text_of(bd.report(found, tmp_path / "held.html"))
    assert "free" not in held
    assert "more, up to" not in held


def test_names_of_the_user_cannot_break_the_page(tmp_path: Path) -> None:
    evil = '</script><script>alert("1")</script>'
    app = bd.Application()
    app.add("mass", bd.RigidBody(mass=2.0, inertia=(1e-3, 1e-3, 1e-3)))
    app.ground("mass.centre", stiffness=[1e6] * 6)
    found = bd.frequency_response(app, [50.0, 60.0], ["mass.centre.y"], ["mass.centre.y"])
    page = bd.report({f"x/{evil[2:]}": found, evil: found}, tmp_path / "evil.html", title=evil)
    assert "<script>alert" not in page.read_text("utf-8")


@pytest.mark.parametrize("source", ["motor", "fan", "spindle", "pump"])
def test_the_command_writes_a_page_of_each_ready_machine(source: str, tmp_path: Path) -> None:
    out = tmp_path / "machine.html"
    assert main(["report", str(bd.examples.model_path(source)), "--out", str(out)]) == 0
    raw = out.read_text("utf-8")
    assert len(raw) < 8e6
    # nothing that a browser would fetch
    assert not re.findall(
        r"""(?:src|href)\s*=\s*["']?(?!data:|#)[^"'>]+""", re.sub(r"<svg.*?</svg>", "", raw, flags=re.S)
    )
    told = text_of(out)
    for heading in ("The machine", "Inputs", "At rest", "Where it comes from"):
        assert heading in told


def test_the_command_shows_stored_results_instead_of_running(tmp_path: Path, capsys: Any) -> None:
    toml = tmp_path / "fan.toml"
    model = bd.read_model(bd.examples.model_path("fan"))
    bd.write_model(bd.Model(model.application, [bd.Analysis("first", "modes", {"count": 2})]), toml)
    assert main(["run", str(toml), "--out", str(tmp_path / "fan.nc")]) == 0
    page = tmp_path / "fan.html"
    assert (
        main(["report", str(toml), "--results", str(tmp_path / "fan.nc"), "--out", str(page), "--json"]) == 0
    )
    told = json.loads("{" + capsys.readouterr().out.partition("{")[2])
    assert told["bytes"] == page.stat().st_size
    first = float(bd.open_result(tmp_path / "fan.nc", "first")["frequency"].values[1])
    assert f"{first:.4g} Hz" in text_of(page)
    assert main(["report", str(tmp_path / "fan.nc"), "--out", str(page)]) == 0
    assert f"{first:.4g} Hz" in text_of(page)
    assert main(["report", str(tmp_path / "fan.nc"), "--set", "a=1", "--out", str(page)]) == 2
    assert "is no model file" in capsys.readouterr().err


@pytest.mark.parametrize("what", [None, 3, "no such.nc", {}, {"a": 1}, [1], {1: 2}, object(), "", {"": 1}])
def test_what_cannot_be_reported_is_named(what: Any, tmp_path: Path) -> None:
    with pytest.raises((ValueError, OSError)):
        bd.report(what, tmp_path / "none.html")
    assert not list(tmp_path.iterdir())


def test_other_arguments_are_named_too(mass: bd.Application, tmp_path: Path) -> None:
    out = tmp_path / "page.html"
    (tmp_path / "no.wav").write_bytes(b"no sound")
    for wrong, said in (
        ({"title": 3}, "title is 3"),
        ({"sounds": 3}, "sounds is 3"),
        ({"sounds": {"a": tmp_path / "no.wav"}}, r"sounds\['a'\] is .*no.wav"),
        ({"model": 3}, "model is 3"),
        ({"model": "motor.nc"}, "model is 'motor.nc'"),
    ):
        with pytest.raises(ValueError, match=said):
            bd.report(bd.modes(mass), out, **wrong)  # type: ignore[arg-type]
    with pytest.raises(OSError, match="nowhere"):
        bd.report(bd.modes(mass), tmp_path / "nowhere" / "page.html")
    assert not out.exists()


def test_an_old_model_file_is_refused_with_line_and_remedy(tmp_path: Path) -> None:
    old = tmp_path / "old.toml"
    old.write_text('title = "x"\nformat = 0\n')
    with pytest.raises(ValueError, match=r"old.toml, line 2, format: .*another version"):
        bd.report(old, tmp_path / "page.html")


def test_nothing_is_warned_of_a_sound_machine(tmp_path: Path) -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error", Notice)
        bd.report(bd.examples.spindle(), tmp_path / "spindle.html")
