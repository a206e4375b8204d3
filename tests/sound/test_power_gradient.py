"""Derivatives of radiated power: those of machines built anew, by Richardson's extrapolation."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import bearingdyn as bd
from bearingdyn.sound import sound_power_gradient

FREQUENCY = np.array([220.0, 610.0, 900.0, 1400.0])
RUBBER = bd.Maxwell(1.2e6, [2e6, 5e6], [2e-3, 1e-4], K=2e9, density=1100.0)
BASE = {
    "layer.G0": RUBBER.G0,
    "layer.G2": RUBBER.G[1],
    "layer.tau2": RUBBER.tau[1],
    "layer.K": RUBBER.K,
    "rotor.mass": 1.5,
    "rotor.centre.damping.y": 30.0,
}
INPUTS = ["rotor.centre.y", "rotor.centre.z"]
HOUSING = bd.Housing(0.16, 0.20, 0.03, 0.078, bore_height=0.12, damping=0.01, f_max=2000.0).superelement()


def machine(v: dict[str, float]) -> bd.Application:
    """A turning body on springs in a ring, in a layer, in a housing that radiates."""
    rubber = replace(
        RUBBER,
        G0=v["layer.G0"],
        G=[RUBBER.G[0], v["layer.G2"]],
        tau=[RUBBER.tau[0], v["layer.tau2"]],
        K=v["layer.K"],
    )
    app = bd.Application()
    inertia = (1e-3, 1e-3, 1.5e-3)
    app.add("rotor", bd.RigidBody(mass=v["rotor.mass"], inertia=inertia, rotating=True))
    app.add("ring", bd.RigidBody(mass=0.2, inertia=(2e-4, 2e-4, 3e-4)))
    app.add("layer", bd.Layer(0.034, 0.039, 0.02, rubber, moduli=(1e6, 8e6)))
    app.add("housing", HOUSING)
    app.spring("rotor.centre", "ring.centre", [1e7, 1e7, 1e7, 1e4, 1e4, 0.0], [50.0] * 3 + [0.01] * 3)
    app.connect("ring.centre", "layer.inner")
    app.connect("layer.outer", "housing.bore", fits=False)
    app.ground("housing.feet")
    damping = [20.0, v["rotor.centre.damping.y"], 20.0, 0.0, 0.0, 0.01]
    app.ground("rotor.centre", stiffness=[1e5, 1e5, 1e5, 10.0, 10.0, 10.0], damping=damping)
    return app


def erp(app: bd.Application, speed: float, inputs: list[str]) -> np.ndarray:
    found = bd.radiated_power(app, FREQUENCY, inputs, ["housing.front", "housing.outside"], speed=speed)
    return found["power"].values.sum(axis=1)


def sound(app: bd.Application, speed: float, inputs: list[str]) -> np.ndarray:
    ask = {"speed": speed, "element_size": 0.05}
    return bd.sound_power(app, FREQUENCY, inputs, ["housing.outside"], **ask)["power"].values


def by_richardson(power, v: dict[str, float], name: str, speed: float, inputs: list[str]) -> np.ndarray:
    found = []
    for k in (1, 2, 4):
        h = k * 4e-3 * v[name]
        high, low = (power(machine(v | {name: v[name] + s * h}), speed, inputs) for s in (1, -1))
        found.append((high - low) / (2 * h))
    return (64 * found[0] - 20 * found[1] + found[2]) / 45


@pytest.mark.parametrize("speed", [0.0, pytest.param(300.0, marks=pytest.mark.slow)])
def test_derivatives_of_the_equivalent_radiated_power(speed):
    inputs = [*INPUTS, "ground.y"] if speed == 0.0 else INPUTS
    slope = bd.gradient(machine(BASE), list(BASE))
    surfaces = ["housing.front", "housing.outside"]
    found = slope.radiated_power(FREQUENCY, inputs, surfaces, speed=speed)
    plain = erp(machine(BASE), speed, inputs)
    np.testing.assert_allclose(found["power"].values, plain, rtol=1e-10)  # round-off of two ways to solve
    for p, name in enumerate(BASE):
        expected = by_richardson(erp, BASE, name, speed, inputs)
        # where a parameter hardly matters, of 1e-4 of the answer over the parameter
        size = np.maximum(np.abs(expected).max(axis=0), 1e-4 * plain.max(axis=0) / BASE[name])
        error = np.abs(found["derivative"].values[p] - expected).max(axis=0) / size
        assert error.max() < 1e-6, (name, error)


@pytest.mark.slow
def test_derivatives_of_the_sound_power():
    slope = bd.gradient(machine(BASE), list(BASE))
    found = sound_power_gradient(slope, FREQUENCY, INPUTS, ["housing.outside"], element_size=0.05)
    plain = sound(machine(BASE), 0.0, INPUTS)
    np.testing.assert_allclose(found["power"].values, plain, rtol=1e-10)
    for name in ("layer.G2", "rotor.mass"):
        expected = by_richardson(sound, BASE, name, 0.0, INPUTS)
        error = np.abs(found["derivative"].sel(parameter=name).values - expected).max(axis=0)
        assert (error < 1e-6 * np.abs(expected).max(axis=0)).all(), name


def test_what_is_no_gradient_is_named():
    with pytest.raises(ValueError, match=r"slope is 3; it must be what bearingdyn\.gradient gives"):
        sound_power_gradient(3, FREQUENCY, INPUTS, ["housing.outside"])
    with pytest.raises(ValueError, match="has no surface 'nothing'"):
        bd.gradient(machine(BASE), ["rotor.mass"]).radiated_power(FREQUENCY, INPUTS, ["housing.nothing"])
