"""Every kind of result has its picture or table on the page, with the result's own numbers."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray

import bearingdyn as bd
from bearingdyn.reporting.of_results import MOST_CHANNELS
from bearingdyn.units import rpm
from report_page import curves, text_of

Y = "mass.centre.y"


@pytest.fixture(scope="module")
def run(mass: bd.Application) -> Any:
    return bd.transient(bd.equilibrium(mass), speed=100.0, dt=1e-4, steps=4096, record=[Y])


def test_spectra_show_their_lines(run: Any, tmp_path: Path) -> None:
    t = run["time"].values
    run["record"].values[:, 0] = 3e-6 * (1 + 0.5 * np.sin(2 * np.pi * 20 * t)) * np.sin(2 * np.pi * 1000 * t)
    found = {
        "lines": bd.spectrum(run, Y),
        "envelope": bd.envelope_spectrum(run, Y, (800.0, 1200.0)),
    }
    page = bd.report(found, tmp_path / "lines.html")
    (_, f, size), *_ = curves(page, str(found["lines"].attrs["channel"]))
    assert f[size.argmax()] == pytest.approx(1000.0, abs=float(2 * (f[1] - f[0])))
    assert text_of(page).count("spectrum") >= 2
    for name, data in found.items():
        assert name.capitalize() in text_of(page)
        assert data.attrs["analysis"] in text_of(page)


def test_a_campbell_diagram_has_its_modes_over_rpm_and_the_speeds_line(tmp_path: Path) -> None:
    app = bd.examples.spindle()
    found = bd.campbell(bd.equilibrium(app), [0.0, 500.0], count=3)
    page = bd.report(found, tmp_path / "campbell.html")
    drawn = curves(page, "Campbell diagram")
    assert [name for name, *_ in drawn] == ["mode 1", "mode 2", "mode 3", "1 ×"]
    for k in range(3):
        np.testing.assert_allclose(drawn[k][2], found["frequency"].values[:, k], rtol=1e-6)
    np.testing.assert_allclose(drawn[3][1], [0.0, 500.0 / rpm], rtol=1e-6)
    np.testing.assert_allclose(drawn[3][2], [0.0, 500.0 / (2 * np.pi)], rtol=1e-6)


def test_a_steady_motion_has_a_period_and_its_lines(tmp_path: Path) -> None:
    app = bd.examples.spindle()
    found = bd.steady_state(bd.equilibrium(app), speed=500.0, harmonics=6, record=["shaft.nose.y"])
    page = bd.report(found, tmp_path / "steady.html")
    ((_, t, y),) = curves(page, "shaft.nose.y")
    record = found["record"].values[:, 0]
    np.testing.assert_allclose(y / y[0], record / record[0], rtol=1e-6)  # in a multiple of its unit
    assert t[-1] / found["time"].values[-1] == pytest.approx(1e3, rel=1e-6)  # ms
    ((_, f, size),) = curves(page, "shaft.nose.y, lines")
    k = int(np.argmax(np.abs(found["amplitude"].values[1:, 0]))) + 1
    assert f[size.argmax()] == pytest.approx(float(found["frequency"].values[k]), rel=1e-6)
    assert "speed 4774.6 rpm" in text_of(page)


def test_a_map_has_stable_and_unstable_branches_and_its_events(tmp_path: Path) -> None:
    """Of any machine: made by hand, as `speed_map` returns it."""
    speed = rpm * np.array([1000.0, 2000.0, 1500.0, 1200.0])
    data = xarray.Dataset(
        {
            "peak_to_peak": (("point", "channel"), 1e-6 * np.array([[1.0], [3.0], [5.0], [7.0]])),
            "stable": ("point", [True, True, False, False]),
            "branch": ("point", [0, 0, 0, 0]),
            "event": ("point", ["", "fold", "", ""]),
        },
        {"speed": ("point", speed), "channel": [Y], "unit": ("channel", ["m"])},
        attrs={"analysis": "speed map"},
    )
    page = bd.report(data, tmp_path / "map.html")
    (good, x, y), (bad, z, w) = curves(page, f"{Y}, steady motions")
    assert (good, bad) == ("branch 0, stable", "branch 0, unstable")
    np.testing.assert_allclose(x, [1000.0, 2000.0], rtol=1e-6)
    np.testing.assert_allclose(z, [1200.0, 1500.0], rtol=1e-6)
    np.testing.assert_allclose([*y, *w], [1.0, 3.0, 7.0, 5.0], rtol=1e-6)
    assert "fold 2000 rpm 0" in text_of(page)


def test_power_is_a_level_and_beside_it_a_planes(tmp_path: Path) -> None:
    """10 lg(P/1 pW): 1 nW is 30 dB; what radiates nothing has no level."""
    f = np.array([100.0, 200.0, 400.0])
    made = {"power": (("frequency", "input"), np.array([[1e-9], [0.0], [1e-12]]), {"units": "W"})}
    at = {"frequency": f, "input": [Y]}
    sound = xarray.Dataset(
        made | {"equivalent_radiated_power": (("frequency", "input"), np.full((3, 1), 1e-8))},
        at,
        {"analysis": "sound power"},
    )
    page = bd.report(sound, tmp_path / "power.html")
    (name, _, heard), (plane, _, flat) = curves(page, f"Power radiated, by {Y}")
    assert (name, plane) == ("sound power", "as a plane (equivalent)")
    np.testing.assert_allclose(heard, [30.0, np.nan, 0.0], atol=1e-5)
    np.testing.assert_allclose(flat, 40.0, rtol=1e-6)
    two = {"p/before": sound, "p/after": sound}
    drawn = curves(bd.report(two, tmp_path / "two.html"), f"Power radiated, by {Y}")
    assert [name for name, *_ in drawn] == ["before: sound power", "after: sound power"]
    parts = xarray.Dataset(
        {"power": (("frequency", "surface", "input"), np.full((3, 2, 1), 5e-10))},
        {**at, "surface": ["a", "b"]},
        {"analysis": "radiated power"},
    )
    ((_, _, whole),) = curves(bd.report(parts, tmp_path / "parts.html"), f"Power radiated, by {Y}")
    np.testing.assert_allclose(whole, 30.0, rtol=1e-6)  # the sum of both


def test_heat_stands_by_part_with_its_sum(tmp_path: Path) -> None:
    heat = {
        label: xarray.Dataset({"power": ("part", p)}, {"part": parts}, {"analysis": "dissipation"})
        for label, parts, p in (
            ("h/hard", ["shaft", "layer"], [1e-3, 3e-3]),
            ("h/soft", ["layer", "ball"], [2e-3, 5e-3]),
        )
    }
    told = text_of(bd.report(heat, tmp_path / "heat.html"))
    for said in ("shaft 1 mW", "layer 3 mW 2 mW", "in all 4 mW 7 mW"):
        assert said in told, told


def test_channels_beyond_the_first_are_named(run: xarray.Dataset, tmp_path: Path) -> None:
    names = [f"p{k}.y" for k in range(MOST_CHANNELS + 2)]
    many = run.isel(channel=np.zeros(len(names), dtype=int), time=slice(0, 8)).assign_coords(channel=names)
    told = text_of(bd.report(many, tmp_path / "many.html"))
    assert f"2 further channels are in the result: {names[-2]}, {names[-1]}" in told


def test_text_without_numbers_is_shown_as_it_is(tmp_path: Path) -> None:
    data = xarray.Dataset({"verdict": "good", "gap": ((), 3e-3, {"units": "m"}), "none": ("k", [np.nan])})
    told = text_of(bd.report(data, tmp_path / "text.html"))
    assert "verdict one number good" in told or "verdict  one number good" in told
    assert "3 mm" in told
    assert "none 1 k –" in told
