"""Where a running application loses its energy: part by part, and all of it together."""

from __future__ import annotations

import math

import numpy as np
import pytest

from bearingdyn.analysis import dissipation, equilibrium, frequency_response, modes, transient
from bearingdyn.application import Application
from bearingdyn.material import Maxwell
from bearingdyn.parts import Layer, RigidBody
from rotors import motor, oscillator


def test_a_damper_under_steady_force_loses_half_c_v_squared():
    m, c, k, f0 = 2.0, 40.0, 5e5, 60.0
    app = oscillator(m, c, k)
    app.load("body.centre", (0, 3.0, 0, 0, 0, 0), frequency=f0)
    per, dt = 2000, 1 / (60.0 * 2000)
    # c/2m = 10/s: two seconds leave e^{-20}
    found = dissipation(equilibrium(app), speed=0.0, dt=dt, steps=6 * per, settle=120 * per)
    w = 2 * math.pi * f0
    v = 3.0 * w / abs(k - m * w**2 + 1j * w * c)
    assert list(found.part.values) == ["body.centre–ground"]
    # (ωΔt)²/12 = 1e-6
    assert found.power.values[0] == pytest.approx(0.5 * c * v**2, rel=1e-5)
    assert found.energy.values[0] == pytest.approx(found.power.values[0] * 6 * per * dt, rel=1e-12)


def test_a_layer_under_steady_force_loses_by_its_loss_modulus():
    """½ ω Im(k*) |x|² of the ring on its layer, branches and η0 together."""
    rubber = Maxwell(G0=1e6, G=[2e6], tau=[1e-3], eta0=30.0, K=2e9, density=1e-3)
    app = Application()
    app.add("ring", RigidBody(1.0, (1e-3, 1e-3, 2e-3)))
    app.add("layer", Layer(0.036, 0.039, 0.019, rubber, moduli=(1e6, 3e6), refinement=0.5))
    app.connect("ring.centre", "layer.inner")
    app.ground("layer.outer")
    f0, per = 200.0, 2000
    app.load("ring.centre", (0, 0, 5.0, 0, 0, 0), frequency=f0)
    state = equilibrium(app)
    slowest = -modes(state, damped=True).eigenvalue.values.real.max()
    dt = 1 / (f0 * per)
    settle = per * math.ceil(14.0 / slowest / (per * dt))
    found = dissipation(state, speed=0.0, dt=dt, steps=2 * per, settle=settle)
    x = frequency_response(state, [f0], ["ring.centre.z"], ["ring.centre.z"]).response.values.item()
    # what the force does: ½ Re(F v*), all of it lost in the layer
    power = 0.5 * 5.0**2 * (2j * math.pi * f0 * x).real
    assert set(found.part.values) == {"layer (shear)", "layer (shear, η0)"}
    assert found.power.values.sum() == pytest.approx(power, rel=1e-4)
    # and between the two by the parts of G″: η0 ω and G ωτ/(1 + ω²τ²)
    w = 2 * math.pi * f0
    dashpot, branch = 30.0 * w, 2e6 * w * 1e-3 / (1 + (w * 1e-3) ** 2)
    share = found.power.sel(part="layer (shear, η0)").item() / found.power.values.sum()
    assert share == pytest.approx(dashpot / (dashpot + branch), rel=1e-4)


@pytest.mark.parametrize("settle", [0, 700])
def test_losses_of_the_parts_are_those_of_the_audit(settle):
    state = equilibrium(motor())
    arguments = {"speed": 400.0, "dt": 5e-6}
    found = dissipation(state, steps=5000, settle=settle, **arguments)
    before, after = (
        transient(state, steps=n, record=[], audit=True, **arguments).attrs for n in (settle, settle + 5000)
    )
    kinds = ("linear", "branch", "contact")
    lost = [after[f"energy_{k}"] - before[f"energy_{k}"] for k in kinds]
    branches = found.energy.sel(part="layer (shear)").item()
    contacts = found.energy.sel(part=["left", "right"]).values.sum()
    # one rule and one march; without settling the first step's own trapezium is left out
    tolerance = 1e-9 if settle else 2e-3
    assert branches == pytest.approx(lost[1], rel=tolerance)
    assert contacts == pytest.approx(lost[2], rel=tolerance)
    assert found.energy.values.sum() == pytest.approx(sum(lost), rel=tolerance)
    # more than one piece of the march gives the same as the march's own channel
    run = transient(state, steps=5000, settle=settle, record=["left.loss"], **arguments)
    p = run.record.values[:, 0]
    whole = 5e-6 * (p.sum() - 0.5 * (p[0] + p[-1]))
    assert found.energy.sel(part="left").item() == pytest.approx(whole, rel=2e-3)
    assert run.unit.values[0] == "W"


def test_bad_requests_are_named():
    state = equilibrium(motor())
    for change, message in (
        ({"dt": 0.0}, "dt is 0"),
        ({"steps": 0}, "steps is 0"),
        ({"settle": -1}, "settle is -1"),
        ({"speed": (1.0, 2.0, 3.0)}, "speed has 3 parts"),
    ):
        with pytest.raises(ValueError, match=message):
            dissipation(state, **({"speed": 0.0, "dt": 1e-5, "steps": 10} | change))
    with pytest.raises(ValueError, match="layers at their instantaneous modulus"):
        dissipation(equilibrium(motor(), modulus="instantaneous"), speed=0.0, dt=1e-5, steps=1)


def test_progress_counts_the_whole():
    seen: list[tuple[int, int]] = []
    state = equilibrium(motor())
    dissipation(state, speed=0.0, dt=1e-5, steps=4500, settle=100, progress=lambda a, b: seen.append((a, b)))
    assert seen[-1] == (4600, 4600)
    assert np.all(np.diff([a for a, _ in seen]) >= 0)
