"""Natural modes: published rotors, closed forms, and the exact eigenproblem of layered systems."""

from __future__ import annotations

import math

import numpy as np
import pytest

from bearingdyn.analysis import equilibrium, modes
from bearingdyn.application import Application
from bearingdyn.bearing import BallBearing
from bearingdyn.material import Elastic, Maxwell
from bearingdyn.parts import Layer, RigidBody, damping_sample
from bearingdyn.system import assemble
from rotors import RUBBER, friswell, motor
from twins.linear_twin import dynamic_stiffness

# ------------------------------------------------------------------- rotors


@pytest.mark.parametrize(
    ("rpm", "published"),
    [
        (0.0, [86.66, 86.66, 274.31, 274.31, 650.41, 716.78]),
        (4000.0, [85.39, 87.80, 251.78, 294.71, 600.18, 650.41]),
    ],
)
def test_two_disc_rotor_whirls_as_published(rpm, published):
    found = modes(friswell(), speed=rpm * math.pi / 30)
    omega = 2 * math.pi * found.frequency.values
    elastic = omega[omega > 1.0][:6]  # its axial motion and its spin are free
    # the book prints five figures; its beam has another shear coefficient: reference page, 0.1 %
    np.testing.assert_allclose(elastic, published, rtol=1e-3)


def test_rigid_rotor_on_springs_has_the_closed_form():
    """ω = [±Ip Ω + √(Ip² Ω² + 8 It k a²)]/2 It (reference page §3.10), springs k at ±a."""
    m, It, Ip, k, a, speed = 5.0, 0.02, 0.03, 1e6, 0.1, 700.0
    app = Application()
    app.add("rotor", RigidBody(m, (It, It, Ip), rotating=True))
    tilt = 2 * k * a * a  # two springs at ±a seen at the centre
    app.ground("rotor.centre", stiffness=(2 * k, 2 * k, 3 * k, tilt, tilt, 0))
    found = modes(app, speed=speed)
    root = math.sqrt((Ip * speed) ** 2 + 8 * It * k * a * a)
    wanted = sorted(
        [(root - Ip * speed) / (2 * It), (root + Ip * speed) / (2 * It), math.sqrt(3 * k / m)]
        + [math.sqrt(2 * k / m)] * 2
    )
    swinging = [w for w in 2 * math.pi * found.frequency.values if w > 1.0]
    # two digits of sixteen may be lost in the eigenvalue solver
    np.testing.assert_allclose(swinging, wanted, rtol=1e-12)


def test_backward_whirl_is_the_slower_and_turns_against_the_shaft():
    found = modes(friswell(), speed=4000 * math.pi / 30)
    system = assemble(friswell())
    keep = np.flatnonzero(found.frequency.values > 1.0)[:2]
    turning = []
    for i in keep:
        x, y = (system.row(f"rotor.left.{c}") @ found["shape"].values[i] for c in "xy")
        turning.append(np.sign((np.conj(x) * y).imag))  # x = 1, y = −i for a motion from x to y
    assert turning == [1.0, -1.0]


# ------------------------------------------------------------------- layers


def test_damping_sample_has_its_reference_modes():
    """Reference page §3.8, computed independently: axial, torsion, tilt (twice), radial (twice), to 0.5 %."""
    rubber = Maxwell(G0=1e6, G=[], tau=[], K=2e6 * 1.49 / (3 * 0.02), density=1200.0)
    app = Application()
    app.add("sample", damping_sample(rubber, f_max=12e3))
    for face in ("inner", "outer"):
        app.free(f"sample.{face}")
    frequency = modes(app).frequency.values
    elastic = frequency[frequency > 1.0][:6]
    np.testing.assert_allclose(elastic, [839.6, 924.6, 973.1, 973.1, 2371.8, 2371.8], rtol=5e-3)


def layered() -> Application:
    app = Application()
    app.add("ring", RigidBody(1.0, (1e-3, 1e-3, 2e-3)))
    app.add("layer", Layer(0.036, 0.039, 0.019, RUBBER, moduli=(1e6, 6e6), refinement=0.5))
    app.add("block", RigidBody(3.0, (0.01, 0.012, 0.013)))
    app.connect("ring.centre", "layer.inner")
    app.connect("layer.outer", "block.centre")
    app.ground("block.centre", stiffness=(1e8,) * 3 + (1e5,) * 3, damping=(50.0,) * 3 + (0.1,) * 3)
    return app


@pytest.mark.parametrize("speed", [0.0, 800.0])
def test_damped_modes_solve_the_frequency_dependent_eigenproblem(speed):
    state = equilibrium(motor())
    system = state.linearised()
    found = modes(state, speed=speed, damped=True)
    below = found.frequency.values < 5e4
    assert np.count_nonzero(below) >= 20
    for value, shape in zip(found.eigenvalue.values[below], found["shape"].values[below], strict=True):
        terms = dynamic_stiffness(system, value, speed)
        # against the same terms without their cancellation
        size = sum(np.abs(term @ shape).max() for term in terms)
        assert np.abs(sum(terms) @ shape).max() < 1e-8 * size
    assert (found.damping_ratio.values > 0).all()


def test_lightly_damped_layer_has_the_modal_strain_energy_loss_factor():
    """ζ = ½ tan δ · (strain energy share) for a single spring of rubber, tan δ small."""
    rubber = Maxwell(G0=1e6, G=[2e4], tau=[2e-4], K=2e9, density=1e-3)
    layer = Layer(0.036, 0.039, 0.019, rubber, moduli=(1.01e6,), refinement=0.5)
    app = Application()
    app.add("ring", RigidBody(1.0, (1e-3, 1e-3, 2e-3)))
    app.add("layer", layer)
    app.connect("ring.centre", "layer.inner")
    app.ground("layer.outer")
    found = modes(app, damped=True)
    k = layer.stiffness(0.0)[5, 5].real
    torsion = int(np.argmin(np.abs(found.frequency.values - math.sqrt(k / 2e-3) / (2 * math.pi))))
    omega = 2 * math.pi * found.frequency.values[torsion]
    G = complex(rubber.complex_modulus(omega))
    # second order in tan δ ≈ 0.01
    assert found.damping_ratio.values[torsion] == pytest.approx(0.5 * G.imag / G.real, rel=2e-3)
    assert omega == pytest.approx(math.sqrt(k * G.real / 1e6 / 2e-3), rel=1e-4)


def test_relaxed_and_instantaneous_modulus_bracket_the_damped_frequency():
    low, high = (modes(layered(), modulus=m).frequency.values[0] for m in ("relaxed", "instantaneous"))
    damped = modes(layered(), damped=True).frequency.values[0]
    assert low < damped < high


# ------------------------------------------------------------------- bearings


def test_modes_about_a_preloaded_bearing():
    """A rotor on one bearing, axially loaded: ω_z = √(k_zz/m), with the printed 6202 stiffness (§3.5)."""
    steel = Elastic(207e9, 0.3, 7850.0)
    brg = BallBearing(8, 5.953e-3, 25e-3, 0.52, 0.53, clearance=10e-6, material=steel, ball_material=steel)
    app = Application()
    app.add("rotor", RigidBody(0.5, (1e-3,) * 3))
    app.bearing("b", brg, inner="rotor.centre", outer="ground")
    app.load("rotor.centre", (0, 0, 180.0, 0, 0, 0))
    with pytest.raises(ValueError, match="equilibrium"):
        modes(app)
    state = equilibrium(app)
    omega = 2 * math.pi * modes(state).frequency.values
    kxx, kzz, ktt, kxt = 9.533296e7, 1.561296e7, 1242.715, 3.157244e5
    lateral = np.linalg.eigvals(np.array([[kxx / 0.5, kxt / 0.5], [kxt / 1e-3, ktt / 1e-3]]))
    wanted = np.sort(np.sqrt([0.0, kzz / 0.5, *lateral.real, *lateral.real]))
    # seven printed digits, of which the small lateral one loses two by cancellation
    np.testing.assert_allclose(omega[1:], wanted[1:], rtol=1e-5)
    assert omega[0] < 1e-3


def test_shapes_are_mass_normalised_and_ordered():
    app = layered()
    system = assemble(app)
    found = modes(app, count=8)
    assert found.sizes["mode"] == 8
    shapes = found["shape"].values.real
    np.testing.assert_allclose(shapes @ system.M @ shapes.T, np.eye(8), atol=1e-9)
    assert (np.diff(found.frequency.values) >= 0).all()


def test_result_says_what_it_is():
    found = modes(friswell(), count=3, speed=100.0)
    assert found.frequency.attrs["units"] == "Hz"
    assert found.attrs["speed"] == 100.0
