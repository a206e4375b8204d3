"""Sliders of a machine: what they turn is what a machine built with those values answers."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import bearingdyn as bd

F = np.array([50.0, 200.0, 800.0, 2500.0])
Y = "shaft.middle.y"
# layers are meshed half as finely: 2e-4 of their stiffness, several times that beside a resonance
CLOSE = 2e-3


@pytest.fixture(scope="module")
def explorer() -> bd.Explorer:
    return bd.Explorer(bd.examples.motor(), frequency=F)


def built(change: Any = None, loads: tuple[float, float] = (-1000.0, 100.0), clearance: float = 8e-6):
    """The ready motor built anew with another layer, other loads and clearance; its bores stay."""
    app = bd.Application()
    old = bd.examples.motor().plan
    for name, part in old.sources.items():
        app.add(name, change(name, part) if change else part)
    app.free("shaft.middle")
    for side in ("left", "right"):
        app.ground(f"{side}_housing.feet")
        app.connect(f"{side}_ring.centre", f"{side}_layer.inner", fits=False)
        app.connect(f"{side}_layer.outer", f"{side}_housing.bore")
        ball = bd.catalogue.bearing("6203", clearance=clearance, damping=30.0)
        app.bearing(side, ball, inner=f"shaft.{side}", outer=f"{side}_ring.centre", fits=False)
    app.load("shaft.middle", (0.0, loads[0], loads[1], 0.0, 0.0, 0.0))
    return app


def level(app: bd.Application) -> np.ndarray:
    found = bd.frequency_response(bd.equilibrium(app), F, [Y], [Y])
    return np.abs(found["response"].values[:, 0, 0])


def test_it_begins_with_the_machine_as_given(explorer: bd.Explorer) -> None:
    view = explorer.at({})
    assert view.trouble == ""
    assert view.levels[Y] == pytest.approx(level(bd.examples.motor()), rel=CLOSE)
    still = bd.static_summary(bd.equilibrium(bd.examples.motor()))
    sag = 1e6 * float(still["deflection"].sel(layer="left_layer"))
    told = dict(view.facts)["left_layer, sag after 60 s"]
    assert told.startswith(f"{sag:.1f} µm, strain")


def test_a_thinner_layer_has_a_sleeve_of_steel_on_its_ring(explorer: bd.Explorer) -> None:
    """2.5 mm instead of 4: the ring reaches to 21.5 mm, as one ring of steel weighs it."""

    def change(name: str, part: Any) -> Any:
        if name.endswith("layer"):
            return replace(part, r_inner=0.0215)
        if name.endswith("ring"):
            # 17 to 21.5 mm in one piece
            return bd.RigidBody.ring(0.0170, 0.0215, 0.014)
        return part

    view = explorer.at({"layer thickness": 2.5})
    assert view.levels[Y] == pytest.approx(level(built(change)), rel=CLOSE)


def test_rubber_loads_and_clearance_turn_what_they_name(explorer: bd.Explorer) -> None:
    def change(name: str, part: Any) -> Any:
        if not name.endswith("layer"):
            return part
        omega = 2 * math.pi * 1e3
        soft = part.material.with_modulus(0.5 * abs(complex(part.material.complex_modulus(omega))), omega)
        return replace(part, width=0.010, material=soft)

    view = explorer.at(
        {
            "rubber stiffness": 0.5,
            "layer width": 10.0,
            "radial load": 700.0,
            "axial load": 250.0,
            "clearance": 15.0,
        }
    )
    assert view.levels[Y] == pytest.approx(level(built(change, (-700.0, 250.0), 15e-6)), rel=CLOSE)


@pytest.mark.parametrize("loss", [0.1, 0.6])
def test_loss_keeps_the_modulus_at_1_khz(explorer: bd.Explorer, loss: float) -> None:
    from bearingdyn.explorer.sliders import ONE_KHZ, turned

    app = turned(explorer.application, explorer.sliders, {"rubber loss": loss})
    old, new = (a.plan.sources["left_layer"].material for a in (explorer.application, app))
    assert float(new.loss_factor(ONE_KHZ)) == pytest.approx(loss, rel=1e-9)
    assert abs(complex(new.complex_modulus(ONE_KHZ))) == pytest.approx(
        abs(complex(old.complex_modulus(ONE_KHZ))), rel=1e-9
    )


def test_the_machine_itself_stays_as_it_was(explorer: bd.Explorer) -> None:
    before = explorer.at({}).levels[Y]
    explorer.at({"layer thickness": 1.5, "axial load": 20.0, "clearance": 2.0})
    assert explorer.at({}).levels[Y].tolist() == before.tolist()


def test_parameters_of_a_file_are_sliders(tmp_path: Path) -> None:
    """A mass of 2 kg on 1 MN/m, at 1 Hz nearly 1/k."""
    file = tmp_path / "mass.toml"
    file.write_text(
        "format = 1\n[parameters]\nstiffness = 1e6\n"
        '[parts.mass]\ntype = "RigidBody"\nmass = 2.0\ninertia = [1e-3, 1e-3, 1e-3]\n'
        '[[joints]]\nground = "mass.centre"\nstiffness = ["= stiffness", "= stiffness", 1e6, 1e3, 1e3, 1e3]\n'
        '[[loads]]\nat = "mass.centre"\nforce = [0.0, -10.0, 0.0, 0.0, 0.0, 0.0]\n'
    )
    explorer = bd.Explorer(file, frequency=[1.0, 2.0])
    assert sorted(explorer.sliders) == ["radial load", "stiffness"]
    found = explorer.at({"stiffness": 2e6}).levels["mass.centre.y"][0]
    omega = 2 * math.pi
    assert found == pytest.approx(1 / (2e6 - 2.0 * omega**2), rel=1e-9)


def test_where_there_is_no_state_it_says_why(explorer: bd.Explorer, monkeypatch: pytest.MonkeyPatch) -> None:
    def lost(*_: object, **__: object) -> None:
        raise ValueError("the shaft has left its bearings")

    monkeypatch.setattr("bearingdyn.explorer.exploration.equilibrium", lost)
    view = explorer.at({"axial load": 0.0})
    assert view.trouble == "the shaft has left its bearings"
    assert view.levels == {}


@pytest.mark.parametrize(
    ("values", "text"),
    [
        ({"thickness": 1.0}, r"'thickness' is no slider; did you mean 'layer thickness'"),
        ({"layer thickness": 40.0}, r"it must lie between 1 and 4 mm"),
        ({"layer thickness": math.nan}, r"values\['layer thickness'\] is nan"),
    ],
)
def test_bad_values_are_named(explorer: bd.Explorer, values: dict[str, float], text: str) -> None:
    with pytest.raises(ValueError, match=text):
        explorer.at(values)


def test_bad_sources_are_named() -> None:
    with pytest.raises(ValueError, match=r"source is 3; it must be a bd.Model, an Application"):
        bd.Explorer(3)  # type: ignore[arg-type]
    app = bd.Application()
    app.add("mass", bd.RigidBody(mass=2.0, inertia=(1e-3, 1e-3, 1e-3)))
    app.ground("mass.centre", stiffness=[1e6] * 6)
    with pytest.raises(ValueError, match=r"nothing is loaded; give a channel, such as 'mass.centre.y'"):
        bd.Explorer(app)
    with pytest.raises(ValueError, match="to turn; give it one"):
        bd.Explorer(app, input="mass.centre.y")


def test_the_notebooks_sliders_move_the_picture(explorer: bd.Explorer) -> None:
    ipywidgets = pytest.importorskip("ipywidgets")
    box = explorer.widget()
    sliders, right = box.children
    image, facts = right.children
    names = [s.description for s in sliders.children]
    assert names[0] == "layer thickness, mm"
    before = image.value, facts.value
    sliders.children[0].value = 1.5
    assert image.value[:8] == b"\x89PNG\r\n\x1a\n"
    assert image.value != before[0]
    assert facts.value != before[1]
    assert isinstance(box, ipywidgets.HBox)
    # so that a notebook shows an explorer by itself
    assert "application/vnd.jupyter.widget-view+json" in explorer._repr_mimebundle_()
