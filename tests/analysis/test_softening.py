"""Layers that soften with their own amplitude, in the frequency domain."""

from dataclasses import replace

import numpy as np
import pytest

import bearingdyn as bd
from bearingdyn.notice import BeyondSweep

LAW = bd.Payne(D=2.0344e6, gamma_c=3.588e-3, m=0.4817, Lm=0.1663e6, gamma_l=3.132e-3)
RUBBER = bd.Maxwell(4e6, [6e5, 6e5, 7e5, 8e5], [1e-2, 2e-3, 4e-4, 7e-5], K=2e9, density=1150.0, payne=LAW)
LAYER = bd.Layer(0.020, 0.024, 0.012, RUBBER)
NO_MASS = 1e-4  # kg/m³
FORCE = ["layer.inner.force.z"]


class At:
    """The rubber at a given strain, as a linear material."""

    K, density = 2e9, 1150.0

    def __init__(self, gamma):
        self.gamma = gamma

    def complex_modulus(self, omega):
        there = LAW.modulus(LAW.gamma_r)
        return RUBBER.complex_modulus(omega) - there + LAW.modulus(self.gamma)


def mass_on_layer(material=RUBBER, layer=LAYER, mass=0.6):
    app = bd.Application()
    app.add("mass", bd.RigidBody(mass=mass, inertia=(1e-3, 1e-3, 1e-3)))
    element = layer.superelement()
    rubber = tuple(replace(term, material=material) for term in element.viscoelastic)
    app.add("layer", replace(element, viscoelastic=rubber))
    app.connect("mass.centre", "layer.inner")
    app.ground("layer.outer")
    return app


def test_the_response_is_that_of_a_linear_layer_at_the_strain_reached():
    f = [150.0, 260.0, 275.0, 400.0]
    names = ["mass.centre.z", *FORCE]
    soft = bd.frequency_response(mass_on_layer(), f, ["mass.centre.z"], names, amplitude=20.0)
    for k, hz in enumerate(f):
        gamma = float(soft.strain[k, 0, 0])
        linear = bd.frequency_response(mass_on_layer(At(gamma)), [hz], ["mass.centre.z"], names)
        assert soft.response.values[k] == pytest.approx(linear.response.values[0], rel=1e-9)
        # and that strain is the layer's own under the motion it makes
        z = 20.0 * linear.response.values[0, 0, 0]
        assert gamma == pytest.approx(LAYER.strain([0, 0, z, 0, 0, 0], 4e6).logarithmic, rel=2e-3)  # inertia


def test_without_amplitude_the_law_changes_nothing_and_a_small_one_stiffens():
    f, names = np.linspace(200.0, 400.0, 9), ["mass.centre.z"]
    law = bd.frequency_response(mass_on_layer(), f, names, names)
    off = bd.frequency_response(mass_on_layer(RUBBER.with_payne(None)), f, names, names)
    assert law.response.values == pytest.approx(off.response.values, rel=1e-9)
    small = bd.frequency_response(mass_on_layer(), f, names, names, amplitude=1e-7)
    least = bd.frequency_response(mass_on_layer(At(0.0)), f, names, names)
    assert small.response.values == pytest.approx(least.response.values, rel=1e-9)


def test_levels_are_each_as_if_alone_and_soften():
    f, names = np.linspace(220.0, 320.0, 201), ["mass.centre.z"]
    levels = [0.1, 5.0, 40.0]
    many = bd.frequency_response(mass_on_layer(), f, names, names, amplitude=levels)
    assert many.response.dims == ("amplitude", "frequency", "output", "input")
    peaks = []
    for k, level in enumerate(levels):
        one = bd.frequency_response(mass_on_layer(), f, names, names, amplitude=level)
        assert many.response.values[k] == pytest.approx(one.response.values, rel=1e-10)
        peaks.append(f[np.abs(one.response.values[:, 0, 0]).argmax()])
    assert peaks[0] > peaks[1] > peaks[2]


def test_two_layers_each_have_a_strain_of_their_own():
    def app(near, far):
        made = bd.Application()
        made.add("b", bd.RigidBody(mass=0.3, inertia=(1e-3, 1e-3, 1e-3)))
        short = bd.Layer(0.020, 0.024, 0.004, RUBBER)
        for name, layer, material in (("near", LAYER, near), ("far", short, far)):
            element = layer.superelement()
            rubber = tuple(replace(term, material=material) for term in element.viscoelastic)
            made.add(name, replace(element, viscoelastic=rubber))
        made.ground("near.outer")
        made.connect("near.inner", "far.outer", fits=False)
        made.connect("b.centre", "far.inner")
        return made

    # close to the resonance each layer's strain hangs on the other's: there the last step must be Newton's
    f, names = np.linspace(100.0, 400.0, 61), ["b.centre.z"]
    soft = bd.frequency_response(app(RUBBER, RUBBER), f, names, names, amplitude=15.0)
    assert soft.layer.values.tolist() == ["near", "far"]
    for k, hz in enumerate(f):
        near, far = (At(float(g)) for g in soft.strain.values[k, :, 0])
        linear = bd.frequency_response(app(near, far), [hz], names, names)
        assert soft.response.values[k] == pytest.approx(linear.response.values[0], rel=1e-9)


def test_an_unbalance_makes_its_own_amplitude():
    """An axially uncoupled rotor: the unbalance m e Ω² is a force of that size."""
    app = mass_on_layer()
    app.unbalance("mass.centre", 2e-5)
    speed = 2 * np.pi * 300.0
    run = bd.unbalance_response(app, [speed], ["mass.centre.x", "layer.inner.force.x"])
    gamma = float(run.strain[0, 0])
    linear = mass_on_layer(At(gamma))
    linear.unbalance("mass.centre", 2e-5)
    again = bd.unbalance_response(linear, [speed], ["mass.centre.x", "layer.inner.force.x"])
    assert run.response.values == pytest.approx(again.response.values, rel=1e-9)
    x, y = (complex(v) for v in (run.response.values[0, 0], -1j * run.response.values[0, 0]))
    # a whirl strains all azimuths alike, and the layer's weights are those of motions to and fro: 10 % more
    assert gamma == pytest.approx(LAYER.strain([x, y, 0, 0, 0, 0], 4e6).logarithmic, rel=0.12)


def test_the_ground_excites_by_its_own_amplitude():
    """Transmissibility at 9.81 m/s² of the base: the strain is that of the motion against it."""
    app, f = mass_on_layer(), [200.0, 280.0]
    H = bd.frequency_response(
        app, f, ["ground.z"], ["mass.centre.z"], quantity="acceleration", amplitude=9.81
    )
    for k, hz in enumerate(f):
        gamma = float(H.strain[k, 0, 0])
        h = complex(H.response.values[k, 0, 0])
        relative = (h - 1) * 9.81 / (2 * np.pi * hz) ** 2
        assert gamma == pytest.approx(LAYER.strain([0, 0, relative, 0, 0, 0], 4e6).logarithmic, rel=5e-3)
        linear = bd.frequency_response(
            mass_on_layer(At(gamma)), [hz], ["ground.z"], ["mass.centre.z"], quantity="acceleration"
        )
        assert h == pytest.approx(complex(linear.response.values[0, 0, 0]), rel=1e-9)


def test_a_strain_beyond_the_sweep_is_said():
    law = replace(LAW, strains=(1.5e-3, 1e-2))
    app = mass_on_layer(RUBBER.with_payne(law))
    with pytest.warns(BeyondSweep, match=r"layer 'layer' vibrates with up to .* beyond the 1 %"):
        bd.frequency_response(app, [270.0], ["mass.centre.z"], ["mass.centre.z"], amplitude=50.0)


@pytest.mark.parametrize(
    ("amplitude", "message"),
    [
        (0.0, r"amplitude is 0\.0; it must be positive"),
        (float("nan"), r"amplitude is nan"),
        ({"mass.centre.x": 1.0}, r"a size for each input"),
        ("loud", r"amplitude is 'loud'"),
    ],
)
def test_amplitudes_that_are_none_are_refused(amplitude, message):
    with pytest.raises(ValueError, match=message):
        bd.frequency_response(
            mass_on_layer(), [100.0], ["mass.centre.z"], ["mass.centre.z"], amplitude=amplitude
        )


def test_an_amplitude_without_a_law_is_refused():
    with pytest.raises(ValueError, match=r"no layer has a law of softening.*with_payne"):
        bd.frequency_response(
            mass_on_layer(RUBBER.with_payne(None)),
            [100.0],
            ["mass.centre.z"],
            ["mass.centre.z"],
            amplitude=1.0,
        )


def test_rubber_of_unknown_volume_cannot_soften():
    element = LAYER.superelement()
    bare = tuple(replace(term, volume=None) for term in element.viscoelastic)
    app = bd.Application()
    app.add("layer", replace(element, viscoelastic=bare))
    app.ground("layer.outer")
    app.free("layer.inner")
    with pytest.raises(ValueError, match=r"volume of its rubber is not known"):
        bd.frequency_response(app, [100.0], ["layer.inner.z"], ["layer.inner.z"], amplitude=1.0)
