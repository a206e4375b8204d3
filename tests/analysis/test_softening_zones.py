"""Layers that soften, in zones: against the field of strain point by point, and against one number."""

from dataclasses import replace

import numpy as np
import pytest
from tests.analysis.test_softening import LAW, RUBBER, mass_on_layer

import bearingdyn as bd
import softened_field
from bearingdyn.notice import BeyondSweep

MASS = 0.6
# thin layers, meant so
pytestmark = pytest.mark.filterwarnings("ignore::bearingdyn.notice.VolumeCounts")


def annulus(thickness):
    return bd.Layer(0.026, 0.026 + thickness, 0.017, RUBBER)


def carried(layer):
    app = bd.Application()
    app.add("mass", bd.RigidBody(mass=MASS, inertia=(1e-3, 1e-3, 1e-3)))
    app.add("layer", layer)
    app.connect("mass.centre", "layer.inner", fits=False)
    app.ground("layer.outer")
    return app


class Constant:
    """Rubber of one complex modulus at every frequency."""

    K, density = 2e9, 1150.0

    def __init__(self, modulus):
        self.modulus = modulus

    def complex_modulus(self, omega):
        return self.modulus + 0 * np.asarray(omega, dtype=complex)


def layer_stiffness(app, hz, place, force, **how):
    """Complex stiffness that a mass on a layer meets at this force, N/m."""
    run = bd.frequency_response(app, [hz], [place], [place], amplitude=force, **how)
    h = complex(run.response.values[0, 0, 0])
    return 1 / h + MASS * (2 * np.pi * hz) ** 2, run


def moved_by(app, hz, place, motion, **how):
    """The same at this amplitude of motion, m."""
    force = 100.0
    for _ in range(5):
        k, run = layer_stiffness(app, hz, place, force, **how)
        h = complex(run.response.values[0, 0, 0])
        force *= motion / abs(force * h)
    return k, run


@pytest.mark.parametrize(("thickness", "hz"), [(2e-3, 1000.0), (4e-3, 500.0)])
def test_zones_resolve_what_one_number_stands_for(thickness, hz):
    """Annuli of 2×17 and 4×17 mm moved radially by 1 % of rms strain, against each point's own modulus."""
    layer = annulus(thickness)
    gamma, volume = layer.body.strain_field(np.array([0] * 6 + [1e-6] + [0] * 5))
    w = np.broadcast_to(volume, gamma.shape) / len(gamma)
    energy = (w * gamma**2).sum()
    rms = float(np.sqrt(energy / w.sum()))
    motion = 0.01 / rms * 1e-6
    omega = 2 * np.pi * hz

    def modulus(strain):
        return RUBBER.modulus_at(omega, strain)

    # at given shape the energy is Σ G*(γ) γ² dV
    at_points = complex((w * gamma**2 * modulus(gamma * motion / 1e-6)).sum() / energy)

    def linear(G):
        element = layer.superelement()
        rubber = tuple(replace(term, material=Constant(G)) for term in element.viscoelastic)
        app = carried(replace(element, viscoelastic=rubber))
        run = bd.frequency_response(app, [hz], ["mass.centre.x"], ["mass.centre.x"])
        return 1 / complex(run.response.values[0, 0, 0]) + MASS * omega**2

    exact = linear(at_points)
    app = carried(layer)
    one, _ = moved_by(app, hz, "mass.centre.x", motion)
    four, run = moved_by(app, hz, "mass.centre.x", motion, zones=4)
    by_rms = linear(complex(modulus(0.01)))

    def off(k):
        return abs(k.real / exact.real - 1), abs((k.imag / k.real) / (exact.imag / exact.real) - 1)

    assert off(by_rms)[0] > 0.02
    # the reference page's .7 %, which is meant of a field that gives way (the next test); the sum over points
    # at given shape is itself up to .7 % off in the loss factor
    assert off(one)[0] < 7e-3
    assert off(one)[1] < 1.6e-2
    # what is left: shapes give way where the rubber is soft, which the sum over points does not
    assert off(four)[0] < 3e-3
    assert off(four)[1] < min(4e-3, 0.5 * off(one)[1])
    assert run.zone_strain.dims == ("frequency", "zone", "input")
    assert run.sizes["zone"] == 32
    least, most = run.zone_strain.values.min(), run.zone_strain.values.max()
    assert least < 0.5 * float(run.strain[0, 0, 0]) < 0.5 * most


@pytest.mark.parametrize(("thickness", "rms"), [(2e-3, (0.055, -0.079)), (4e-3, (0.041, -0.048))])
def test_one_number_against_a_field_that_gives_way(thickness, rms):
    """The reference page: the rms strain errs by so much in stiffness and loss factor; other means by .7 %.

    Its modulus is not given: at 4.2 MPa both rings show its errors. The energy-weighted modulus has the .7 %
    in both; the logarithmic mean .4 % in stiffness, and 1 % in the loss factor, which bends over ln γ.
    """
    found = softened_field.stiffnesses(thickness)
    told = {name: softened_field.errors(k, found["field"]) for name, k in found.items()}
    print({name: [f"{100 * e:+.2f} %" for e in two] for name, two in told.items()})
    assert told["rms"] == pytest.approx(rms, abs=6e-3)  # half a point: the modulus
    assert np.abs(told["energy"]).max() < 7.5e-3
    assert abs(told["logarithmic"][0]) < 7e-3
    assert abs(told["logarithmic"][1]) < 1e-2


def test_zones_add_up_to_the_rubber():
    for layer in (annulus(2e-3), annulus(6e-3)):
        (whole,) = layer.superelement().viscoelastic
        for count in (1, 3):
            zones = layer.zones(count)
            assert len(zones) == 8 * count
            H = sum(z.H for z in zones)
            assert np.abs(H - whole.H).max() < 1e-12 * np.abs(whole.H).max()
            assert sum(z.volume for z in zones) == pytest.approx(whole.volume, rel=1e-12)
            # equal energy of a radial motion in each
            energies = [sum(z.H[0, 0] for z in zones if z.name.startswith(f"zone {k}")) for k in (1, count)]
            assert energies[0] == pytest.approx(energies[1], rel=0.05)


def test_an_even_strain_needs_no_zones():
    """Sheared along its axis a layer is strained evenly; the issue's .5 %."""
    app = carried(bd.Layer(0.026, 0.030, 0.017, RUBBER))
    place = "mass.centre.z"
    one, first = layer_stiffness(app, 150.0, place, 60.0)
    many, second = layer_stiffness(app, 150.0, place, 60.0, zones=4)
    assert many == pytest.approx(one, rel=5e-3)
    assert float(second.strain[0, 0, 0]) == pytest.approx(float(first.strain[0, 0, 0]), rel=5e-3)
    assert float(first.strain[0, 0, 0]) > 2e-3


def test_a_small_motion_meets_the_same_modulus_in_all_zones():
    app = carried(annulus(4e-3))
    one, _ = layer_stiffness(app, 500.0, "mass.centre.x", 1e-6)
    many, _ = layer_stiffness(app, 500.0, "mass.centre.x", 1e-6, zones=3)
    assert many == pytest.approx(one, rel=1e-9)


def test_directions_a_quarter_turn_apart_soften_alike():
    app = carried(annulus(2e-3))
    x, _ = layer_stiffness(app, 900.0, "mass.centre.x", 300.0, zones=3)
    y, _ = layer_stiffness(app, 900.0, "mass.centre.y", 300.0, zones=3)
    assert x == pytest.approx(y, rel=1e-9)


def test_levels_and_inputs_are_each_as_if_alone():
    app = carried(annulus(4e-3))
    f, names = [100.0, 550.0, 700.0], ["mass.centre.x", "mass.centre.z"]
    many = bd.frequency_response(app, f, names, names, amplitude=[1.0, 80.0], zones=3)
    assert many.zone_strain.dims == ("amplitude", "frequency", "zone", "input")
    for k, level in enumerate((1.0, 80.0)):
        for i, name in enumerate(names):
            alone = bd.frequency_response(app, f, [name], names, amplitude=level, zones=3)
            wanted = alone.response.values[:, :, 0]
            assert many.response.values[k, :, :, i] == pytest.approx(wanted, rel=1e-8, abs=1e-18)


def test_a_zone_beyond_the_sweep_is_said():
    """The mean of the layer is within it, the most strained zone is not."""
    law = replace(LAW, strains=(1.5e-3, 1.1e-2))
    app = carried(bd.Layer(0.026, 0.028, 0.017, RUBBER.with_payne(law)))
    names = ["mass.centre.x"]
    how = {"amplitude": 400.0, "zones": 3}
    with pytest.warns(BeyondSweep, match=r"layer 'layer' vibrates with up to"):
        found = bd.frequency_response(app, [300.0], names, names, **how)
    assert float(found.strain.max()) < 1.1e-2 < float(found.zone_strain.max())


def test_what_knows_no_zones_is_refused_by_name():
    names = ["mass.centre.x"]
    with pytest.raises(ValueError, match=r"zones is 3.*amplitude"):
        bd.frequency_response(carried(annulus(4e-3)), [100.0], names, names, zones=3)
    with pytest.raises(ValueError, match=r"zones is 0"):
        bd.frequency_response(carried(annulus(4e-3)), [100.0], names, names, amplitude=1.0, zones=0)
    with pytest.raises(ValueError, match=r"zones is 3.*'layer' is a Superelement"):
        bd.frequency_response(mass_on_layer(), [100.0], names, names, amplitude=1.0, zones=3)
    with pytest.raises(ValueError, match=r"'layer\.inner\.force\.x'"):
        bd.frequency_response(
            carried(annulus(4e-3)), [100.0], names, ["layer.inner.force.x"], amplitude=1.0, zones=3
        )
    with pytest.raises(ValueError, match=r"count is 0"):
        annulus(4e-3).zones(0)
