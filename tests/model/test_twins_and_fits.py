"""Of a model file: parts and bearings like others, temperatures, loose fits; and what is wrong there."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import bearingdyn as bd


def machine() -> bd.Application:
    """Two like rings on like layers, one warm, like bearings, and a bearing loose in a bore."""
    rubber = bd.examples.rubber()
    ball = bd.catalogue.bearing("6205", clearance=10e-6)
    _, outside, width = ball.boundary
    app = bd.Application()
    app.add("shaft", bd.Shaft([bd.Section(0.3, 0.025)], {"left": 0.03, "right": 0.27}))
    ring = bd.RigidBody.ring((ball.Dpw + ball.Dw) / 2, outside / 2, width)
    layer = bd.Layer(outside / 2, outside / 2 + 4e-3, width, rubber)
    for side in ("left", "right"):
        app.add(f"{side}_ring", ring)
        app.add(f"{side}_layer", layer)
        app.bearing(side, ball, inner=f"shaft.{side}", outer=f"{side}_ring.centre")
        app.connect(f"{side}_ring.centre", f"{side}_layer.inner")
        app.ground(f"{side}_layer.outer")
    app.temperature("left_layer", 40.0)
    app.load("shaft.left", (0.0, -300.0, 50.0, 0.0, 0.0, 0.0))
    return app


def test_twins_and_temperatures_come_back(tmp_path: Path) -> None:
    app = machine()
    path = tmp_path / "twins.toml"
    bd.write_model(app, path)
    text = path.read_text(encoding="utf-8")
    assert text.count('like = "') == 3  # a ring, a layer and a bearing
    assert "left_layer = 40.0" in text
    back = bd.read_model(path).application
    assert back.plan.temperatures == app.plan.temperatures
    assert np.array_equal(bd.equilibrium(back).x, bd.equilibrium(app).x)
    assert "7 parts" not in repr(bd.read_model(path))
    assert "5 parts, 2 bearings; asked for nothing" in repr(bd.read_model(path))
    assert "<svg" in bd.read_model(path)._repr_html_()


HUNG = 'outer = "left_ring.centre"\n'
WRONG = [
    ('like = "left_ring"', 'like = "left_rng"', r"parts\.right_ring: like is 'left_rng'.*mean 'left_ring'"),
    ('like = "left"\n', 'like = "middle"\n', r"bearings\.right\.like: like is 'middle'; it must name"),
    ('like = "left"\n', 'like = "left"\nclearance = 1e-5\n', r"bearings\.right\.\w+: clearance is unknown"),
    ("left_layer = 40.0", "left_layer = 4000.0", r"temperatures\.left_layer: .*4000"),
    ("left_layer = 40.0", "lft_layer = 40.0", r"temperatures\.lft_layer: .*lft_layer"),
    (HUNG, HUNG + "place = 0.1\n", r"bearings\.left\.place: fits is True"),
    (HUNG, HUNG + "mirrored = 1\n", r"bearings\.left\.mirrored: mirrored is 1"),
    (HUNG, HUNG + 'fits = "no"\n', r"bearings\.left\.fits: fits is 'no'"),
]


@pytest.mark.parametrize(("old", "new", "said"), WRONG, ids=lambda x: x[:20])
def test_what_is_wrong_among_twins_has_its_line(tmp_path: Path, old: str, new: str, said: str) -> None:
    path = tmp_path / "twins.toml"
    bd.write_model(machine(), path)
    text = path.read_text(encoding="utf-8")
    assert old in text
    path.write_text(text.replace(old, new, 1), encoding="utf-8")
    with pytest.raises(ValueError, match=rf"twins\.toml, line \d+, {said}"):
        bd.read_model(path)


def test_a_loose_fit_comes_back(tmp_path: Path) -> None:
    """A flexible ring that has play in its bore."""
    ball = bd.catalogue.bearing("6205", clearance=10e-6)
    app = bd.Application()
    app.add("rotor", bd.RigidBody(4.0, (0.02, 0.02, 0.004), rotating=True))
    app.add("ring", bd.FlexibleRing.of(ball, outside="flexible"))
    app.bearing("ball", ball, inner="rotor.centre", outer="ring.raceway")
    app.fit("seat", bd.LooseFit(5e-6, stations=48), ring="ring.outside", bore="ground")
    app.load("rotor.centre", (0.0, -300.0, 0.0, 0.0, 0.0, 0.0))
    path = tmp_path / "loose.toml"
    bd.write_model(app, path)
    back = bd.read_model(path).application
    assert back.plan.fits.keys() == {"seat"}
    assert back.plan.fits["seat"].fit == app.plan.fits["seat"].fit
    bd.write_model(back, tmp_path / "again.toml")
    assert (tmp_path / "again.toml").read_bytes() == path.read_bytes()
    text = path.read_text(encoding="utf-8")
    path.write_text(text.replace('bore = "ground"\n', ""), encoding="utf-8")
    with pytest.raises(ValueError, match=r"loose\.toml, line \d+, fits\.seat: bore"):
        bd.read_model(path)
