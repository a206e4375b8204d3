"""The harmonic response against closed forms and a plain dense solve of the paper's equation (20)."""

from __future__ import annotations

import math

import numpy as np
import pytest

from bearingdyn.analysis import equilibrium, frequency_response, modes
from bearingdyn.analysis.equilibrium import Equilibrium
from bearingdyn.analysis.linearised import linear
from bearingdyn.analysis.softening import softened
from bearingdyn.application import Application
from bearingdyn.material import Maxwell, Payne
from bearingdyn.parts import Layer, RigidBody
from bearingdyn.system import System, assemble
from rotors import RUBBER, motor, oscillator


@pytest.fixture(scope="module")
def state() -> Equilibrium:
    return equilibrium(motor())


INPUTS = ["shaft.end.y", "block.centre.z"]
OUTPUTS = ["shaft.end.y", "shaft.right.θx", "ring.centre.x", "block.centre.z"]


def dense(
    system: System,
    K_b: np.ndarray,
    C_b: np.ndarray,
    f: float,
    inputs: list[str],
    outputs: list[str],
    speed: float,
    softer: complex = 0.0,
) -> np.ndarray:
    """Paper (20), term by term: −ω²M + iω(C + ΩG) + K + ΩN + Σ 2 G*(ω) H, bearings as K_b + iω C_b.

    softer: what layers have beside their G*(ω), Pa.
    """
    w = 2 * math.pi * f
    D = -(w**2) * system.M + 1j * w * (system.C + speed * system.G) + system.K + speed * system.N
    for term in system.layers:
        m = term.material
        G = (
            m.G0
            + 1j * w * m.eta0
            + sum(g * 1j * w * t / (1 + 1j * w * t) for g, t in zip(m.G, m.tau, strict=True))
        )
        D = D + 2 * (G + softer) * term.L @ term.L.T
    D = D + system.B.T @ (K_b + 1j * w * C_b) @ system.B
    force = np.array([system.row(i) for i in inputs]).T
    x = np.linalg.solve(D, force)
    for _ in range(2):  # refined in long double: D reaches from a free spin to inner modes of 1 MHz
        residual = force - D.astype(np.clongdouble) @ x.astype(np.clongdouble)
        x = x + np.linalg.solve(D, residual.astype(complex))
    return np.array([system.row(o) for o in outputs]) @ x


def test_single_mass_has_the_closed_form():
    m, c, k = 2.0, 40.0, 5e5
    f = np.array([0.0, 1.0, 50.0, 79.5774715, 200.0, 6000.0])
    w = 2 * math.pi * f
    found = frequency_response(oscillator(m, c, k), f, ["body.centre.y"], ["body.centre.y"]).response
    np.testing.assert_allclose(found.values[:, 0, 0], 1 / (k - m * w**2 + 1j * w * c), rtol=1e-12)


@pytest.mark.parametrize(("quantity", "power"), [("velocity", 1), ("acceleration", 2)])
def test_velocity_and_acceleration_are_powers_of_i_omega(quantity, power):
    f = np.array([0.0, 10.0, 300.0])
    ask = (oscillator(), f, ["body.centre.y"], ["body.centre.y"])
    x = frequency_response(*ask).response.values
    d = frequency_response(*ask, quantity=quantity).response.values
    np.testing.assert_allclose(d, (2j * math.pi * f[:, None, None]) ** power * x, rtol=1e-14)


@pytest.mark.parametrize("speed", [0.0, 500.0])
def test_motor_equals_a_dense_solve(state, speed):
    f = np.array([1.0, 10.0, 382.0, 1885.0, 2027.0, 6000.0])
    found = frequency_response(state, f, INPUTS, OUTPUTS, speed=speed).response.values
    for k, frequency in enumerate(f):
        wanted = dense(state.system, state.bearing_K, state.bearing_C, frequency, INPUTS, OUTPUTS, speed)
        assert np.abs(found[k] - wanted).max() < 1e-12 * np.abs(wanted).max()


def test_without_frequency_the_response_is_the_static_one(state):
    found = frequency_response(state, [0.0], INPUTS, OUTPUTS).response.values[0]
    assert not found.imag.any()
    # small loads on the nonlinear application itself: the secant of ±1 N about 180 N
    for column, (place, axis) in enumerate((("shaft.end", 1), ("block.centre", 2))):
        ends = []
        for sign in (1.0, -1.0):
            app, load = motor(), np.zeros(6)
            load[axis] = sign
            app.load(place, load)
            ends.append(equilibrium(app))
        for row, name in enumerate(OUTPUTS):
            secant = state.system.row(name) @ (ends[0].x - ends[1].x) / 2
            # ±1 N of 180: the cube of 1/180 and cancelling digits, measured on the largest
            assert found[row, column].real == pytest.approx(secant, rel=2e-4, abs=2e-4 * np.abs(found).max())


def test_blocks_and_whole_are_one_response(state):
    """Coordinates mixed by a random congruence fall into one block; the answer may not change."""
    rng = np.random.default_rng(5)
    n = state.system.n
    T = np.linalg.qr(rng.standard_normal((n, n)))[0]
    linear = state.linearised()
    mixed = linear.transformed(T)
    assert len(linear.blocks()) > 1 or len(state.system.blocks()) > 1
    assert len(mixed.blocks()) == 1
    f = np.array([20.0, 400.0, 3000.0])
    by_blocks = frequency_response(state, f, INPUTS, OUTPUTS).response.values
    whole = frequency_response(mixed, f, INPUTS, OUTPUTS).response.values
    # the mixture brings the inner modes' 1e13 into every entry
    np.testing.assert_allclose(whole, by_blocks, rtol=1e-7, atol=1e-7 * np.abs(by_blocks).max())


def test_linearised_system_has_the_same_response(state):
    f = np.geomspace(10, 6000, 7)
    a = frequency_response(state, f, INPUTS, OUTPUTS).response.values
    b = frequency_response(state.linearised(), f, INPUTS, OUTPUTS).response.values
    np.testing.assert_allclose(a, b, rtol=1e-9, atol=1e-10 * np.abs(a).max())


def test_response_is_reciprocal_at_rest(state):
    places = ["shaft.end.y", "shaft.end.x", "block.centre.z", "ring.centre.θx"]
    H = frequency_response(state, [15.0, 950.0], places, places).response.values
    np.testing.assert_allclose(H, np.swapaxes(H, 1, 2), rtol=1e-9, atol=1e-11 * np.abs(H).max())


def test_passive_structure_dissipates(state):
    places = ["shaft.end.y", "block.centre.z", "ring.centre.x"]
    H = frequency_response(
        state, np.geomspace(5, 6000, 60), places, places, quantity="velocity"
    ).response.values
    power = 0.5 * (H + np.conj(np.swapaxes(H, 1, 2)))  # ½ Re fᴴ v ≥ 0 for every f
    lowest = np.linalg.eigvalsh(power)[:, 0]
    assert (lowest > -1e-12 * np.abs(H).max(axis=(1, 2))).all()


def test_loss_factor_of_a_layer_shows_in_its_dynamic_stiffness():
    """A massless ring on a layer: 1/H = K*(ω), whose loss factor in torsion is that of the rubber itself."""
    app = Application()
    app.add("ring", RigidBody(1e-9, (1e-13,) * 3))
    rubber = Maxwell(G0=1e6, G=[2e6, 3e6], tau=[1e-3, 1e-4], eta0=3.0, K=2e9, density=1e-3)
    layer = Layer(0.0175, 0.020, 0.011, rubber, moduli=(1e6, 6e6))
    app.add("layer", layer)
    app.connect("ring.centre", "layer.inner")
    app.ground("layer.outer")
    f = np.array([10.0, 100.0, 1000.0])
    H = frequency_response(app, f, ["ring.centre.θz"], ["ring.centre.θz"]).response.values[:, 0, 0]
    # exact torsion of a bonded ring: 4πGL/(a⁻² − b⁻²) (reference page §2)
    exact = 4 * math.pi * 0.011 / (0.0175**-2 - 0.020**-2)
    w = 2 * math.pi * f
    G = 1e6 + 3j * w + 2e6 * 1e-3j * w / (1 + 1e-3j * w) + 3e6 * 1e-4j * w / (1 + 1e-4j * w)
    # the mesh is within 0.02 %, and its error cancels from the loss factor
    np.testing.assert_allclose(1 / H, exact * G, rtol=5e-4)
    np.testing.assert_allclose((1 / H).imag / (1 / H).real, G.imag / G.real, rtol=1e-6)


def test_peaks_stand_at_the_damped_modes(state):
    found = modes(state, damped=True)
    light = (
        (found.frequency.values > 100) & (found.damping_ratio.values < 0.05) & (found.frequency.values < 4e3)
    )
    assert light.any()
    for f0, zeta in zip(found.frequency.values[light], found.damping_ratio.values[light], strict=True):
        grid = f0 * np.linspace(1 - 3 * zeta - 1e-3, 1 + 3 * zeta + 1e-3, 201)
        H = frequency_response(state, grid, ["shaft.end.x", "shaft.end.y"], ["shaft.end.x", "shaft.end.y"])
        size = np.abs(H.response.values).sum(axis=(1, 2))
        # the response over a resonance turns by half a circle: here at least that it is not flat
        assert size.max() > 1.02 * size.min()


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"frequency": [-1.0]}, "zero or more"),
        ({"frequency": [np.nan]}, "finite"),
        ({"frequency": []}, "frequency must be"),
        ({"inputs": ["body.centre"]}, "'body.centre' is a place"),
        ({"outputs": ["body.centre.w"]}, "not 'w'"),
        ({"quantity": "jerk"}, "quantity is 'jerk'"),
        ({"speed": np.nan}, "speed is nan"),
    ],
)
def test_bad_requests_are_named(change, message):
    request = {"frequency": [1.0], "inputs": ["body.centre.y"], "outputs": ["body.centre.y"]} | change
    with pytest.raises(ValueError, match=message):
        frequency_response(oscillator(), **request)


def test_bearings_need_an_equilibrium():
    with pytest.raises(ValueError, match="equilibrium"):
        frequency_response(motor(), [10.0], INPUTS, OUTPUTS)


def test_a_free_body_has_no_static_response():
    app = Application()
    app.add("body", RigidBody(2.0, (1.0, 1.0, 1.0)))
    app.free("body.centre")
    ask = (["body.centre.y"], ["body.centre.y"])
    with pytest.raises(ArithmeticError):
        frequency_response(app, [0.0], *ask)
    found = frequency_response(app, [10.0], *ask).response.values[0, 0, 0]
    assert found == pytest.approx(-1 / (2.0 * (20 * math.pi) ** 2), rel=1e-14)


def test_result_has_names_and_units(state):
    found = frequency_response(state, [10.0, 20.0], INPUTS, OUTPUTS, quantity="velocity", speed=3.0)
    assert found.response.dims == ("frequency", "output", "input")
    assert list(found.input.values) == INPUTS
    assert list(found.output.values) == OUTPUTS
    assert found.frequency.attrs["units"] == "Hz"
    assert (found.attrs["quantity"], found.attrs["speed"]) == ("velocity", 3.0)


def test_progress_is_told_and_may_stop(state):
    seen = []
    frequency_response(
        state, np.linspace(1, 100, 40), INPUTS, OUTPUTS, progress=lambda a, b: seen.append((a, b))
    )
    assert seen[-1] == (40, 40)


def test_layer_at_its_modulus_follows_the_full_model():
    """Reduced layer with shapes at two moduli against its own finite element model re-solved at G*(ω)."""
    layer = Layer(0.036, 0.039, 0.019, RUBBER)
    app = Application()
    app.add("ring", RigidBody(1e-9, (1e-13,) * 3))
    app.add(
        "layer", Layer(0.036, 0.039, 0.019, Maxwell(1e6, [2e6, 3e6], [1e-3, 1e-4], 3.0, K=2e9, density=1e-3))
    )
    app.connect("ring.centre", "layer.inner")
    app.ground("layer.outer")
    places = [f"ring.centre.{c}" for c in ("x", "z", "θy", "θz")]
    for f in (10.0, 300.0, 3000.0):
        H = frequency_response(app, [f], places, places).response.values[0]
        K = layer.stiffness(2 * math.pi * f)[np.ix_([0, 2, 4, 5], [0, 2, 4, 5])]
        # reference page: two moduli keep a layer's stiffness to some 0.1 %
        np.testing.assert_allclose(np.diag(np.linalg.inv(H)), np.diag(K), rtol=3e-3)


def test_assembled_and_given_system_agree():
    app = oscillator()
    ask = ([7.0], ["body.centre.y"], ["body.centre.y"])
    a, b = frequency_response(app, *ask), frequency_response(assemble(app), *ask)
    assert np.array_equal(a.response.values, b.response.values)


@pytest.mark.parametrize("speed", [0.0, 500.0])
def test_many_frequencies_are_the_dense_solve_to_1e_12(state: Equilibrium, speed: float):
    """Blocks are eliminated several frequencies at a time, in a fixed order of pivots: no digit is lost.

    At 0.1 Hz the shaft floats, ω²m against bearings of 1e8 N/m, and to join it free costs nine digits.
    """
    f = np.geomspace(0.1, 1e4, 301)
    got = frequency_response(state, f, INPUTS, OUTPUTS, speed=speed)["response"].values
    system, K, C = state.system, state.bearing_K, state.bearing_C
    exact = np.array([dense(system, K, C, x, INPUTS, OUTPUTS, speed) for x in f])
    assert (np.abs(got - exact).max(axis=(1, 2)) / np.abs(exact).max(axis=(1, 2))).max() < 1e-12


def test_layers_that_soften_are_the_dense_solve_at_their_strain():
    """Solved once at the isotherms' moduli; what softening takes away is joined to that, no digit lost."""
    law = Payne(D=2.0344e6, gamma_c=3.588e-3, m=0.4817, Lm=0.1663e6, gamma_l=3.132e-3)
    soft = equilibrium(motor(RUBBER.with_payne(law)))
    f, force, speed = np.geomspace(20.0, 5e3, 41), 200.0, 500.0
    inputs, omega = INPUTS[:1], 2 * math.pi * f
    system = soft.system
    rows, drive = np.array([system.row(o) for o in OUTPUTS]), np.full((f.size, 1, 1), force)
    found = softened(linear(soft), omega, np.array([system.row(inputs[0])]), rows, speed, [drive])[0]
    change = found.modulus[:, 0, 0] - RUBBER.complex_modulus(omega)
    K, C = soft.bearing_K, soft.bearing_C
    plain, joined = (
        np.array(
            [dense(system, K, C, x, inputs, OUTPUTS, speed, c)[:, 0] for x, c in zip(f, by, strict=True)]
        )
        for by in (np.zeros(f.size), change)
    )
    size = np.abs(joined).max(axis=1)
    assert (np.abs(plain - joined).max(axis=1) > 1e-3 * size).any()
    off = np.abs(found.x[:, :, 0] / force - joined).max(axis=1) / size
    assert off.max() < 1e-12
    # the strain is iterated to 1e-9 of itself, and so the law's modulus at it is that of the answer
    got = frequency_response(soft, f, inputs, OUTPUTS, speed=speed, amplitude=force)
    strain = got["strain"].values.reshape(-1)
    at = np.array([law.change(omega[k : k + 1], strain[k : k + 1])[0] for k in range(f.size)])
    np.testing.assert_allclose(at, change, rtol=0, atol=1e-8 * np.abs(at).max())


def test_a_frequency_answers_alike_alone_and_among_others(state: Equilibrium):
    f = np.geomspace(10.0, 5e3, 11)
    together = frequency_response(state, f, INPUTS, OUTPUTS)["response"].values
    alone = [frequency_response(state, [x], INPUTS, OUTPUTS)["response"].values[0] for x in f]
    np.testing.assert_array_equal(together, alone)


@pytest.mark.parametrize("speed", [0.0, 400.0])
def test_motions_of_the_bearings_are_told_without_being_read(state: Equilibrium, speed: float):
    """Rows that are the bearings' own come of what joins the blocks; thrice them are read like any others."""
    system, held = state.system, linear(state)
    omega = 2 * np.pi * np.array([0.0, 80.0, 700.0, 3000.0])
    force = np.vstack([system.row("shaft.end.y"), system.B[0]])  # one is that of a force as well
    rows = np.vstack([system.row("ring.centre.x"), system.B])
    told = held.solve(omega, force, rows, speed)
    read = held.solve(omega, force, 3.0 * rows, speed) / 3.0
    size = np.abs(read).max(axis=(1, 2), keepdims=True)
    assert told / size == pytest.approx(read / size, abs=1e-11)
