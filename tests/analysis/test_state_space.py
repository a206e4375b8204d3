"""State space against the frequency response, and stiffness tables against what other programs read."""

from __future__ import annotations

import csv
import math

import numpy as np
import pytest
import scipy.signal

import bearingdyn as bd
from bearingdyn.bearing import Running
from bearingdyn.demo import motor
from verified import peers

RUBBER = bd.Maxwell(G0=1e6, G=[2e6, 5e5], tau=[1e-4, 3e-3], eta0=20.0, K=2e9, density=1150.0)
FREQUENCY = [1.0, 30.0, 170.0, 600.0, 1500.0, 4000.0]
INPUTS = ["shaft.middle.y", "shaft.left.x"]
OUTPUTS = ["shaft.middle.y", "left_housing.top.y", "left_ring.centre.z", "shaft.right.θx", "left.force.y"]


@pytest.fixture(scope="module")
def state() -> bd.Equilibrium:
    return bd.equilibrium(motor(RUBBER))


@pytest.mark.parametrize("quantity", ["displacement", "velocity", "acceleration"])
@pytest.mark.parametrize("speed", [0.0, 300.0])
def test_transfer_function_is_the_frequency_response(state, quantity, speed):
    model = bd.state_space(state, INPUTS, OUTPUTS, speed=speed, quantity=quantity)
    own = bd.frequency_response(state, FREQUENCY, INPUTS, OUTPUTS, speed=speed, quantity=quantity)
    found, expected = model.response(FREQUENCY), own["response"].values
    # of the largest of each row: an entry that symmetry makes zero has no digits
    scale = np.abs(expected).max(axis=(0, 2), keepdims=True)
    np.testing.assert_allclose(found / scale, expected / scale, rtol=0, atol=1e-9)


def test_one_mass_by_hand():
    app = bd.Application()
    app.add("mass", bd.RigidBody(mass=2.0, inertia=(1e-3, 1e-3, 1e-3)))
    app.ground("mass.centre", stiffness=[1e6] * 6, damping=[30.0] * 6)
    omega = 2 * math.pi * 100.0
    found = bd.state_space(app, ["mass.centre.y"], ["mass.centre.y"]).response(100.0)[0, 0, 0]
    assert found == pytest.approx(1 / (1e6 - 2 * omega**2 + 30j * omega), rel=1e-12)


def test_states_are_stable_and_count_the_branches(state):
    model = bd.state_space(state, INPUTS, OUTPUTS)
    layers = sum(t.L.shape[1] * 2 for t in state.system.layers)
    assert len(model.A) == 2 * state.system.n + layers
    assert model.response(10.0).shape == (1, len(OUTPUTS), len(INPUTS))
    # all but the shaft's free spin decay
    assert np.linalg.eigvals(model.A).real.max() < 1e-3


def spring(material: object) -> bd.Application:
    app = bd.Application()
    app.add("layer", bd.Layer(0.02, 0.024, 0.014, material))
    app.add("mass", bd.RigidBody(mass=2.0, inertia=(1e-3, 1e-3, 1e-3)))
    app.connect("layer.inner", "mass.centre")
    app.ground("layer.outer")
    return app


def test_scipy_takes_it():
    """SciPy's own response goes by polynomials, which bear few states: one mass on one layer, its own few."""
    model = bd.state_space(spring(RUBBER), ["mass.centre.y"], ["mass.centre.y"])
    step = model.scipy()
    np.testing.assert_array_equal(step.A, model.A)
    t = np.linspace(0.0, 0.2, 2000)
    _, y, _ = scipy.signal.lsim(step, np.ones_like(t), t)
    # it comes to rest where the relaxed layer holds it
    assert y[-1] == pytest.approx(model.response(0.0)[0, 0, 0].real, rel=1e-3)


def test_python_control_takes_it(state):
    pytest.importorskip("control")
    model = bd.state_space(state, INPUTS, OUTPUTS)
    found = model.control()(2j * math.pi * 170.0)
    np.testing.assert_allclose(found, model.response(170.0)[0], rtol=1e-6)


def test_what_has_no_state_is_named():
    zener = bd.FractionalZener(G0=1e6, G_inf=1e8, tau=1e-5, alpha=0.5, K=2e9, density=1100.0)
    with pytest.raises(ValueError, match=r"^source is 'FractionalZener'.*'layer'.*fit_maxwell"):
        bd.state_space(spring(zener), ["mass.centre.y"], ["mass.centre.y"])


def test_reactions_and_unknown_channels_are_named(state):
    with pytest.raises(ValueError, match=r"^outputs is 'ground\.left_housing\.feet\.y'"):
        bd.state_space(state, INPUTS, ["ground.left_housing.feet.y"])
    with pytest.raises(ValueError, match=r"shaft\.nowhere"):
        bd.state_space(state, ["shaft.nowhere.y"], OUTPUTS)


BALL = bd.catalogue.bearing("7205")
LOADS = np.array([[0, -300.0, 800.0, 0, 0, 0], [100.0, -100.0, 1500.0, 1.0, -0.5, 0]])


@pytest.fixture(scope="module")
def table():
    return bd.stiffness_table(BALL, LOADS, [0.0, 800.0], damping_time=2e-6)


def test_table_holds_the_tangents(table):
    for i, speed in enumerate((0.0, 800.0)):
        state = Running(BALL, speed) if speed else BALL
        for j, load in enumerate(LOADS):
            q = state.displacement(load)
            np.testing.assert_array_equal(table["stiffness"].values[i, j], state.stiffness(q))
            np.testing.assert_array_equal(table["displacement"].values[i, j], q)
    np.testing.assert_array_equal(table["damping"].values, 2e-6 * table["stiffness"].values)


def test_csv_repeats_every_digit(table, tmp_path):
    path = bd.export_stiffness(table, tmp_path / "k.csv")
    rows = list(csv.reader(line for line in path.read_text().splitlines() if line[0] != "#"))
    assert len(rows) == 1 + 4
    assert rows[0][-36:][1] == "k_x_y"
    np.testing.assert_array_equal(
        np.array(rows[4][-36:], dtype=float).reshape(6, 6), table["stiffness"].values[1, 1]
    )


def test_nastran_cards_are_the_matrix_of_both_rings(table, tmp_path):
    text = bd.export_stiffness(table, tmp_path / "k.bdf", "nastran", nodes=(7, 9)).read_text()
    K, column = np.zeros((12, 12)), None
    place = {(g, c): 6 * i + c - 1 for i, g in enumerate((7, 9)) for c in range(1, 7)}
    for line in text.splitlines():
        if line.startswith("DMIG*"):
            column = place[int(line[24:40]), int(line[40:56])]
        elif line.startswith("*"):
            row = place[int(line[8:24]), int(line[24:40])]
            K[row, column] = K[column, row] = float(line[40:56])
    own = table["stiffness"].values[0, 0]
    np.testing.assert_allclose(K, np.block([[own, -own], [-own, own]]), rtol=0, atol=1e-8 * own.max())


def test_abaqus_connector_has_21_constants(table, tmp_path):
    text = bd.export_stiffness(table, tmp_path / "k.inp", "abaqus", case=(1, 1)).read_text()
    data = text.split("*CONNECTOR ELASTICITY\n")[1].replace("\n", ",").split(",")
    values = [float(x) for x in data if x.strip()]
    own = table["stiffness"].values[1, 1]
    assert values == pytest.approx(
        [(own[i, j] + own[j, i]) / 2 for j in range(6) for i in range(j + 1)], rel=1e-8, abs=1e-3
    )


def test_calculix_springs_say_what_they_leave_out(table, tmp_path):
    text = bd.export_stiffness(table, tmp_path / "k.inp", "calculix", nodes=(3, 4), element=50).read_text()
    assert "couplings" in text
    assert text.count("*SPRING") == 5  # the spin is free
    assert "50, 4, 3" in text
    assert f"{table['stiffness'].values[0, 0, 0, 0]:.9e}" in text


def test_ross_gets_its_lists(table, tmp_path):
    found = bd.ross_table(table, 1)
    assert {"frequency", "kxx", "kxy", "kyx", "kyy", "kzz", "cxx", "cyy"} <= found.keys()
    assert found["kxy"] == table["stiffness"].values[:, 1, 0, 1].tolist()
    path = bd.export_stiffness(table, tmp_path / "ross.csv", "ross", case=(0, 1))
    rows = list(csv.DictReader(path.open()))
    assert [float(r["kyy"]) for r in rows] == found["kyy"]


def test_ross_finds_the_same_critical_speed():
    """A rigid rotor on two isotropic springs of the table: ω = √(2k/m), in both programs."""
    ross = pytest.importorskip("ross")
    table = bd.stiffness_table(BALL, [[0, 0, 1000.0, 0, 0, 0]])
    found = bd.ross_table(table)
    del found["frequency"]
    steel = ross.Material("stiff", rho=7810, E=211e13, G_s=81.2e13)
    shaft = [ross.ShaftElement(L=0.05, idl=0, odl=0.1, material=steel, n=k) for k in range(2)]
    bearings = [ross.BearingElement(n=n, **{k: v[0] for k, v in found.items()}) for n in (0, 2)]
    rotor = ross.Rotor(shaft, [], bearings)
    lowest = min(w for w in rotor.run_modal(0.0).wn if w > 1.0)
    assert lowest == pytest.approx(math.sqrt(2 * found["kxx"][0] / rotor.m), rel=1e-3)


@pytest.mark.parametrize(("thrust", "expected"), peers.ROSS.items())
def test_a_rotor_has_the_critical_speed_that_ross_finds_with_the_table(thrust, expected):
    """Within .1 %, the line of the work's list."""
    assert peers.forward_critical(peers.rotor_for_ross(thrust)[0]) == pytest.approx(expected, rel=1e-3)


@pytest.mark.parametrize(("thrust", "expected"), peers.ROSS.items())
def test_ross_still_finds_it(thrust, expected):
    ross = pytest.importorskip("ross")
    table = peers.rotor_for_ross(thrust)[1]
    steel = ross.Material("steel", rho=7850, E=210e9, Poisson=0.3)
    shaft = [ross.ShaftElement(L=0.025, idl=0, odl=0.025, material=steel, n=k) for k in range(16)]
    bearings = [ross.BearingElement(n=n, **table) for n in (0, 16)]
    rotor = ross.Rotor(shaft, [ross.DiskElement(n=6, m=5.0, Id=0.012, Ip=0.022)], bearings)
    found = rotor.run_modal(expected, num_modes=12)
    ways = zip(found.wn, found.whirl_direction(), strict=True)
    assert min(w for w, way in ways if way == "Forward" and w > 5) == pytest.approx(expected, rel=1e-5)


@pytest.mark.parametrize(
    ("act", "message"),
    [
        (lambda t, p: bd.stiffness_table(BALL, [1.0] * 6), r"^loads is .*\(m, 6\)"),
        (lambda t, p: bd.stiffness_table("7205", LOADS), "^bearing is '7205'"),
        (lambda t, p: bd.export_stiffness(t, p / "x", "ansys"), "^format is 'ansys'"),
        (lambda t, p: bd.export_stiffness(t, p / "x", case=(2, 0)), r"^case\[0\] is 2"),
        (lambda t, p: bd.export_stiffness(t, p / "x", nodes=(1, 1)), r"^nodes is \(1, 1\)"),
        (lambda t, p: bd.export_stiffness({}, p / "x"), "^table is None"),
    ],
)
def test_bad_input_is_named(table, tmp_path, act, message):
    with pytest.raises(ValueError, match=message):
        act(table, tmp_path)
