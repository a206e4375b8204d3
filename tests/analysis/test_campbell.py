"""The Campbell diagram, and where modes keep and lose their energy."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from bearingdyn.analysis import campbell, energy_shares, equilibrium, modes
from bearingdyn.application import Application
from bearingdyn.material import Maxwell
from bearingdyn.parts import Layer, RigidBody, Section, Shaft
from rotors import RUBBER, friswell, motor, oscillator

RPM = math.pi / 30


def test_modes_of_the_two_disc_rotor_are_followed_through_their_crossing():
    """Friswell et al., example 5.9.1: at 4000 rpm the backward mode of 716.78 rad/s is below torsion."""
    found = campbell(friswell(), np.linspace(0.0, 4000.0, 21) * RPM, count=8, damped=False)
    omega = 2 * math.pi * found.frequency.values
    elastic = omega[0] > 1.0
    start, end = omega[0, elastic][:6], omega[-1, elastic][:6]
    # published; the book's beam has another shear coefficient: 0.1 %
    np.testing.assert_allclose(start, [86.66, 86.66, 274.31, 274.31, 650.41, 716.78], rtol=1e-3)
    pairs = np.sort(end[:4].reshape(2, 2), axis=1)
    np.testing.assert_allclose(pairs, [[85.39, 87.80], [251.78, 294.71]], rtol=1e-3)
    np.testing.assert_allclose(end[4:], [650.41, 600.18], rtol=1e-3)
    # followed without a jump
    assert (found.mac.values[1:, elastic][:, :6] > 0.9).all()
    whirl = found.whirl.values[-1, elastic][:6]
    backward = end[:4] < start[:4]
    # isotropic supports: circles
    np.testing.assert_allclose(whirl[:4], np.where(backward, -1.0, 1.0), atol=1e-6)
    assert whirl[4] == 0.0  # torsion
    assert whirl[5] == pytest.approx(-1.0, abs=1e-6)


@pytest.mark.parametrize("order", [1, -1])
def test_speeds_may_come_in_any_order(order):
    speeds = np.array([0.0, 100.0, 250.0, 400.0])
    wanted = campbell(friswell(), speeds, count=6, damped=False)
    found = campbell(friswell(), speeds[::order], count=6, damped=False)
    np.testing.assert_allclose(found.frequency.values[::order], wanted.frequency.values, rtol=1e-9, atol=1e-5)


def test_rigid_rotor_whirls_forward_and_backward_by_the_closed_form():
    """ω = [±IpΩ + √((IpΩ)² + 8 It k a²)]/2It (reference page §3.10)."""
    m, It, Ip, k, a = 5.0, 0.02, 0.03, 1e6, 0.1
    tilt = 2 * k * a * a
    app = Application()
    app.add("rotor", RigidBody(m, (It, It, Ip), rotating=True))
    app.ground("rotor.centre", stiffness=(2 * k, 2 * k, 3 * k, tilt, tilt, 0))
    speeds = np.linspace(10.0, 700.0, 8)
    found = campbell(app, speeds, count=6, damped=False)
    omega = 2 * math.pi * found.frequency.values

    def closed(speed: float, sign: int) -> float:
        root = math.sqrt((Ip * speed) ** 2 + 8 * It * k * a * a)
        return (root + sign * Ip * speed) / (2 * It)

    for sign in (1, -1):
        at = np.argmin(np.abs(omega[0] - closed(speeds[0], sign)))
        wanted = [closed(speed, sign) for speed in speeds]
        np.testing.assert_allclose(omega[:, at], wanted, rtol=1e-9)
        # a body that tilts about its centre: circles with the shaft and against it
        np.testing.assert_allclose(found.whirl.values[:, at], sign, atol=1e-6)


def test_layered_rotor_follows_damped_modes():
    state = equilibrium(motor())
    found = campbell(state, [0.0, 200.0, 400.0, 600.0], count=10)
    assert found.damping_ratio.values[:, 1:].min() > 0.0
    for i, speed in enumerate((0.0, 600.0)):
        direct = modes(state, speed=speed, damped=True).eigenvalue.values
        for value in found.eigenvalue.values[[0, -1][i]]:
            # the same eigenvalues, followed
            assert np.abs(direct - value).min() < 1e-9 * abs(value)


@pytest.mark.parametrize(
    ("change", "message"),
    [({"speeds": []}, "speeds must be"), ({"speeds": [np.nan]}, "finite"), ({"count": 0}, "count is 0")],
)
def test_bad_requests_are_named(change, message):
    with pytest.raises(ValueError, match=message):
        campbell(oscillator(), **({"speeds": [0.0, 1.0], "count": 3} | change))


# ------------------------------------------------------------------- energy


@pytest.mark.parametrize("speed", [0.0, 500.0])
def test_what_the_parts_lose_is_the_damping_of_the_mode(speed):
    state = equilibrium(motor())
    found = modes(state, speed=speed, damped=True)
    shares = energy_shares(state, found)
    keep = (found.frequency.values > 1.0) & (found.frequency.values < 5e4)
    # an exact balance of power: what the eigenproblem's own residual leaves
    total = shares.damping.values.sum(axis=1)
    np.testing.assert_allclose(total[keep], found.damping_ratio.values[keep], rtol=1e-6, atol=1e-9)
    for kind in ("kinetic", "strain", "dissipation"):
        np.testing.assert_allclose(shares[kind].values[keep].sum(axis=1), 1.0, rtol=1e-12)


def test_undamped_modes_hold_as_much_strain_as_motion():
    state = equilibrium(motor())
    for modulus in ("relaxed", "instantaneous"):
        found = modes(state, 12, modulus=modulus)
        shares = energy_shares(state, found)
        assert not shares.dissipation.values.any()
        keep = found.frequency.values > 1.0
        np.testing.assert_allclose(shares.strain.values[keep].sum(axis=1), 1.0, rtol=1e-9)
    assert "layer (shear)" in shares.part.values
    assert {"shaft", "left", "block.centre–ground"} <= set(shares.part.values)


def test_two_springs_in_series_share_by_their_compliance():
    """Masses 1 and 3 kg on springs k1 (ground) and k2 (between): strain kᵢ δᵢ², kinetic mᵢ xᵢ²."""
    k1, k2, m1, m2 = 2e6, 1e6, 1.0, 3.0
    app = Application()
    app.add("a", RigidBody(m1, (1e-3,) * 3))
    app.add("b", RigidBody(m2, (1e-3,) * 3))
    app.ground("a.centre", stiffness=(k1,) * 6, damping=(10.0,) * 6)
    app.spring("a.centre", "b.centre", (k2,) * 6, (4.0,) * 6)
    found = modes(app, damped=True)
    shares = energy_shares(app, found)
    K, M = np.array([[k1 + k2, -k2], [-k2, k2]]), np.diag([m1, m2])
    squares, phi = np.linalg.eig(np.linalg.solve(M, K))
    for square, x in zip(squares, phi.T, strict=True):
        at = np.argmin(np.abs(2 * math.pi * found.frequency.values - math.sqrt(square)))
        strain = np.array([k1 * x[0] ** 2, k2 * (x[0] - x[1]) ** 2])
        motion = np.array([m1, m2]) * x**2
        loss = np.array([10.0 * x[0] ** 2, 4.0 * (x[0] - x[1]) ** 2])
        names = ["a.centre–ground", "a.centre–b.centre"]
        # dampers of ζ = 0.2 % couple the shapes to second order
        np.testing.assert_allclose(shares.strain[at].sel(part=names), strain / strain.sum(), rtol=1e-4)
        np.testing.assert_allclose(shares.kinetic[at].sel(part=["a", "b"]), motion / motion.sum(), rtol=1e-4)
        np.testing.assert_allclose(shares.dissipation[at].sel(part=names), loss / loss.sum(), rtol=1e-3)
        # ζ = φᵀCφ/2ω φᵀMφ
        zeta = loss / (2 * math.sqrt(square) * motion.sum())
        np.testing.assert_allclose(shares.damping[at].sel(part=names), zeta, rtol=1e-3)


def test_a_lightly_damped_layer_gives_the_modal_strain_energy_loss_factor():
    """ζ = ½ tan δ × the rubber's share of the strain energy (Johnson & Kienholz 1982), tan δ small."""
    rubber = Maxwell(G0=1e6, G=[2e4], tau=[2e-4], K=2e9, density=1e-3)
    app = Application()
    app.add("ring", RigidBody(1.0, (1e-3, 1e-3, 2e-3)))
    app.add("layer", Layer(0.036, 0.039, 0.019, rubber, moduli=(1.01e6,), refinement=0.5))
    app.connect("ring.centre", "layer.inner")
    app.ground("layer.outer", stiffness=(5e5,) * 3 + (5e2,) * 3)
    found = modes(app, 6, damped=True)
    shares = energy_shares(app, found)
    omega = 2 * math.pi * found.frequency.values
    tan_delta = rubber.loss_factor(omega)
    share = shares.strain.sel(part="layer (shear)").values
    # in a mode the modulus is between 1.00 and 1.02 MPa: 1 % of the layer's share at most, either way
    np.testing.assert_allclose(np.sort(share), np.sort(shear_shares(5e5, 5e2)), rtol=1e-2)
    # second order in tan δ ≈ 0.01
    np.testing.assert_allclose(found.damping_ratio.values, 0.5 * tan_delta * share, rtol=5e-3)


def shear_shares(k: float, tilt: float) -> list[float]:
    """Shear's share of the energy in each direction, of a layer (k_L) in series with a spring (k).

    k/(k + k_L) is the layer's; of it d ln k_L/d ln G is shear's and the rest compression's.
    """

    def stiffness(G: float) -> np.ndarray:
        rubber = Maxwell(G0=G, G=[1.0], tau=[1.0], K=2e9, density=1e-3)
        return np.diag(Layer(0.036, 0.039, 0.019, rubber, moduli=(G,), refinement=0.5).stiffness(0.0))[
            :6
        ].real

    layer = stiffness(1.01e6)
    shear = np.log(stiffness(1.01e6 * 1.01) / stiffness(1.01e6 / 1.01)) / (2 * math.log(1.01))
    spring = np.array([k] * 3 + [tilt] * 3)
    return (shear * spring / (spring + layer)).tolist()


def test_modes_of_another_system_are_refused():
    with pytest.raises(ValueError, match="give modes of this one"):
        energy_shares(equilibrium(motor()), modes(oscillator()))
    with pytest.raises(ValueError, match="equilibrium"):
        energy_shares(motor(), modes(oscillator()))
    with pytest.raises(ValueError, match="does not know its parts"):
        energy_shares(without_parts(), modes(oscillator()))


def without_parts():
    from dataclasses import replace

    from bearingdyn.system import assemble

    return replace(assemble(oscillator()), parts=())


def test_layers_of_the_motor_take_part():
    shares = energy_shares(equilibrium(motor(RUBBER)), modes(equilibrium(motor(RUBBER)), damped=True))
    assert shares.dissipation.sel(part="layer (shear)").values.max() > 0.3


def test_undamped_modes_of_a_damped_shaft_neither_grow_nor_decay():
    """Of damping that turns, C and its circulatory Ω N go together."""
    shaft = Shaft([Section(0.4, 0.02)], seats={"left": 0.0, "right": 0.4}, damping=0.02, f_max=3e3)
    frequency = {}
    for damping in (0.02, 0.0):
        app = Application()
        app.add("shaft", replace(shaft, damping=damping))
        for seat in ("left", "right"):
            app.ground(f"shaft.{seat}", stiffness=(1e7, 1e7, 1e7, 0, 0, 10.0))
        found = modes(app, 8, speed=3000.0)
        # round-off of eigenvalues up to 1e5 rad/s
        assert np.abs(found.damping_ratio.values).max() < 1e-9
        frequency[damping] = found.frequency.values
    np.testing.assert_allclose(frequency[0.02], frequency[0.0], rtol=1e-9)
