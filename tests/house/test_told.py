"""What a user is told: of files that are missing, of names nearly right, of progress, units and sizes."""

from __future__ import annotations

import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import bearingdyn as bd
from bearingdyn import progress
from bearingdyn.bearing.catalogue import bearing, entry

READERS: dict[str, Callable[[Path], object]] = {
    ".csv": bd.read_dma,
    ".xlsx": bd.read_dma,
    ".msh": bd.read_mesh,
    ".inp": bd.read_mesh,
    ".vtu": bd.read_mesh,
    ".npz": bd.read_matrices,
    ".op4": bd.read_matrices,
    ".sti": bd.read_matrices,
    ".mtx": lambda path: bd.read_matrices(path, path),
    ".nodes": bd.read_nodes,
    ".nc": bd.open_result,
    ".run": bd.open_result,
}


def mass() -> bd.Application:
    app = bd.Application()
    app.add("mass", bd.RigidBody(mass=2.0, inertia=(1e-3, 1e-3, 1e-3)))
    app.ground("mass.centre", stiffness=[1e6] * 6, damping=[20.0] * 6)
    return app


@pytest.mark.parametrize("suffix", READERS)
def test_a_missing_file_is_one_exception_that_names_it(suffix: str, tmp_path: Path) -> None:
    with pytest.raises(FileNotFoundError, match=rf"there{suffix}: no such file; give the path of a "):
        READERS[suffix](tmp_path / f"there{suffix}")
    with pytest.raises(IsADirectoryError, match="is a folder; give the path of a "):
        READERS[suffix](tmp_path)


@pytest.mark.parametrize(
    "given", ["6203-2RS", "SKF 6203", "6203 C3", "FAG 6203-2Z-C3", "6203ZZ", "6203.2RSR", " 6203 "]
)
def test_a_designation_is_read_as_people_write_it(given: str) -> None:
    assert entry(given) == entry("6203")


@pytest.mark.parametrize("given", ["620 3", "62O3"])
def test_a_designation_nearly_right_is_answered_with_the_one_meant(given: str) -> None:
    with pytest.raises(ValueError, match="did you mean '6203'"):
        entry(given)


def test_a_group_nearly_right_is_answered_with_the_one_meant(tmp_path: Path) -> None:
    pytest.importorskip("h5netcdf")
    found = bd.modes(mass())
    bd.save({"no layer": found, "layer": found}, tmp_path / "r.nc")
    with pytest.raises(ValueError, match=r"has no result 'no_layer'; did you mean 'no layer'\? there are"):
        bd.open_result(tmp_path / "r.nc", "no_layer")
    mesh = bd.box_mesh([0.0, 0.1], [0.0, 0.1], [0.0, 0.1])
    with pytest.raises(ValueError, match="did you mean 'face'"):
        mesh.with_surface("face", lambda p: p[:, 0] < 1e-9).surface("fcae")


class Terminal:
    """Standard error as a person sees it, or as a file does."""

    def __init__(self, person: bool) -> None:
        self.person, self.text = person, ""

    def isatty(self) -> bool:
        return self.person

    def write(self, text: str) -> int:
        self.text += text
        return len(text)

    def flush(self) -> None: ...


CALLS: dict[str, Callable[..., object]] = {
    "transient": lambda **k: bd.transient(
        mass(), speed=0.0, dt=1e-5, steps=2000, record=["mass.centre.y"], **k
    ),
    "dissipation": lambda **k: bd.dissipation(mass(), speed=0.0, dt=1e-5, steps=2000, **k),
    "frequency_response": lambda **k: bd.frequency_response(
        mass(), np.linspace(0, 100, 200), ["mass.centre.y"], ["mass.centre.y"], **k
    ),
    "sweep": lambda **k: bd.study.sweep(_square, [{"a": 1.0}, {"a": 2.0}], executor=_here(), **k),
}


UNITS = {
    "transient": "step", "dissipation": "step", "frequency_response": "frequency", "sweep": "case",
}  # fmt: skip


def _square(case: dict[str, Any]) -> dict[str, float]:
    return {"b": case["a"] ** 2}


def _here() -> Any:
    from concurrent.futures import ThreadPoolExecutor

    return ThreadPoolExecutor(1)


@pytest.mark.parametrize("name", CALLS)
def test_a_bar_is_drawn_when_asked_for_and_by_itself_only_at_a_terminal(
    name: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    pytest.importorskip("tqdm")
    monkeypatch.setattr(progress, "DELAY", 0.0)
    seen: dict[tuple[bool, object], str] = {}
    for person in (True, False):
        for wanted in (None, True, False):
            screen = Terminal(person)
            with monkeypatch.context() as patch:
                patch.setattr(sys, "stderr", screen)
                CALLS[name](**({} if wanted is None else {"progress": wanted}))
            seen[person, wanted] = screen.text
    assert seen[False, None] == seen[False, False] == seen[True, False] == ""
    assert "100%" in seen[False, True]
    assert "100%" in seen[True, True]
    assert f"{UNITS[name]}/s" in seen[True, None]


def test_a_progress_that_is_none_is_refused() -> None:
    with pytest.raises(TypeError, match="progress is 'yes'; it must be True, False or a function"):
        CALLS["transient"](progress="yes")


def test_a_record_that_no_memory_holds_is_refused_before_work() -> None:
    with pytest.raises(ValueError, match=r"the record would take .* GB: 1e\+1[0-9] samples of 1 channels"):
        bd.transient(mass(), speed=0.0, dt=1e-6, steps=10**14, record=["mass.centre.y"])


def test_every_variable_and_coordinate_of_every_result_carries_units() -> None:
    app = mass()
    state = bd.equilibrium(app)
    run = bd.transient(state, speed=100.0, dt=1e-5, steps=4096, record=["mass.centre.y", "mass.centre.x"])
    rotor = mass()
    rotor.unbalance("mass.centre", 1e-5)
    found = bd.modes(app)
    results = {
        "modes": found,
        "shapes": bd.mode_shapes(app, found),
        "shares": bd.energy_shares(app, found),
        "campbell": bd.campbell(app, [0.0, 10.0], 3),
        "response": bd.frequency_response(app, [1.0, 2.0], ["mass.centre.y"], ["mass.centre.y"]),
        "unbalance": bd.unbalance_response(rotor, [10.0, 20.0], ["mass.centre.y"]),
        "transient": run,
        "heat": bd.dissipation(state, speed=0.0, dt=1e-5, steps=10),
        "orbit": bd.orbit(run, "mass.centre.x", "mass.centre.y"),
        "spectrum": bd.spectrum(run, "mass.centre.y"),
        "table": bd.study.table(bd.study.sweep(_square, [{"a": 1.0}], executor=_here())),
    }
    for kind, data in results.items():
        for name, variable in data.variables.items():
            assert "units" in variable.attrs, f"{kind}: {name}"


def test_objects_print_in_a_line_with_the_numbers_that_matter() -> None:
    dma = bd.read_dma(bd.sample_dma_path())
    master = bd.master_curve(dma)
    rubber = bd.fit_maxwell(master, 5, K=2e9, density=1100.0)
    ring = bearing("6203", clearance=10e-6)
    loaded = bd.bearing.load_distribution(ring, [1e-5, 0, 0, 0, 0, 0])
    layer = bd.Layer(0.02, 0.025, 0.01, rubber)
    things: list[object] = [dma, master, rubber, rubber.fit, ring, loaded, layer, mass().plan]
    for thing in things:
        assert len(repr(thing)) < 400, type(thing)
        assert "array(" not in repr(thing), type(thing)
    assert "135 points: 9 isotherms from -20.01 to 59.99 °C" in repr(dma)
    assert "WLF law" in repr(master)
    assert "5 branches" in repr(rubber)
    assert "8 balls of Ø6.746 mm" in repr(ring)
    assert "clearance 10 µm" in repr(ring)
    assert f"{loaded.loaded} of 8 balls loaded" in repr(loaded)


def test_a_harmonic_load_says_its_frequency() -> None:
    app = mass()
    app.load("mass.centre", [0, 5.0, 0, 0, 0, 0], frequency=50.0)
    assert "[0.0, 5.0, 0.0, 0.0, 0.0, 0.0] at 50 Hz" in app.summary()


def test_one_response_is_drawn_without_a_label() -> None:
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    found = bd.frequency_response(mass(), [1.0, 2.0, 4.0], ["mass.centre.y"], ["mass.centre.y"])
    ax = bd.plot.frequency_response(found, "mass.centre.y", "mass.centre.y")
    assert ax.get_legend() is None
    np.testing.assert_array_equal(ax.get_lines()[0].get_ydata(), np.abs(found["response"].values[:, 0, 0]))
    plt.close("all")


def test_the_version_is_said(capsys: pytest.CaptureFixture[str]) -> None:
    from bearingdyn.cli import main

    assert main(["--version"]) == 0
    assert capsys.readouterr().out.strip() == f"bearingdyn {bd.__version__}"
