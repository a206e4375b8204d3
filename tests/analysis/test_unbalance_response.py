"""Response to unbalance at every speed, and power radiated by surfaces."""

from __future__ import annotations

import math
import warnings
from dataclasses import dataclass, replace

import numpy as np
import pytest

from bearingdyn import examples
from bearingdyn.analysis import equilibrium, modes, radiated_power, transient, unbalance_response
from bearingdyn.application import Application
from bearingdyn.cms import Superelement, Surface
from bearingdyn.fem import Section
from bearingdyn.parts import Disc, Feet, Housing, RigidBody, Shaft
from rotors import motor

# ------------------------------------------------------------------- unbalance


def jeffcott(m: float = 4.0, k: float = 2e6, c: float = 120.0) -> Application:
    app = Application()
    app.add("rotor", RigidBody(m, (0.02, 0.02, 0.03), rotating=True))
    app.ground("rotor.centre", stiffness=(k, k, k, 1e4, 1e4, 0), damping=(c, c, c, 0.1, 0.1, 0.1))
    app.unbalance("rotor.centre", 3e-4, phase=0.4)
    return app


def test_jeffcott_rotor_has_the_closed_form():
    """x = u Ω² e^{iφ}/(k − mΩ² + iΩc), and y a quarter turn behind; the force on the ground (k + iΩc) x."""
    m, k, c, u = 4.0, 2e6, 120.0, 3e-4
    speeds = np.array([0.0, 300.0, 707.1, 1500.0])
    outputs = ["rotor.centre.x", "rotor.centre.y", "rotor.centre.force.x", "rotor.centre.θx"]
    found = unbalance_response(jeffcott(m, k, c), speeds, outputs).response.values
    x = u * speeds**2 * np.exp(0.4j) / (k - m * speeds**2 + 1j * speeds * c)
    np.testing.assert_allclose(found[:, 0], x, rtol=1e-11)
    np.testing.assert_allclose(found[:, 1], -1j * x, rtol=1e-11)
    np.testing.assert_allclose(found[:, 2], (k + 1j * speeds * c) * x, rtol=1e-11)
    assert not found[:, 3].any()
    fast = unbalance_response(jeffcott(m, k, c), speeds, outputs[:1], quantity="acceleration").response.values
    np.testing.assert_allclose(fast[:, 0], -(speeds**2) * x, rtol=1e-11)


def test_a_tilting_disc_swings_as_the_march_says():
    """An overhung disc: gyroscopic forces shift the response by more than half at this speed."""
    shaft = Shaft(
        [Section(0.3, 0.02)],
        seats={"left": 0.05, "right": 0.15},
        points={"end": 0.3},
        discs=[Disc.cylinder(0.3, 0.2, 0.02, 0.02)],
        f_max=3e3,
    )
    app = Application()
    app.add("rotor", shaft)
    for end in ("left", "right"):
        app.ground(f"rotor.{end}", stiffness=(1e7, 1e7, 1e7, 0, 0, 1e3), damping=(2e3,) * 3 + (1.0,) * 3)
    app.unbalance("rotor.end", 1e-4)
    state = equilibrium(app)
    speed, per = 300.0, 2000
    outputs = ["rotor.end.x", "rotor.end.y", "rotor.left.x"]
    found = unbalance_response(state, [speed], outputs).response.values[0]
    dt = 2 * math.pi / speed / per
    lateral = modes(state, speed=speed, damped=True)
    moves = [abs(state.system.row("rotor.end.x") @ s) > 1e-6 for s in lateral["shape"].values]
    slowest = -lateral.eigenvalue.values.real[np.array(moves)].max()
    settle = per * math.ceil(12.0 / slowest / (per * dt))  # e^{-12}
    run = transient(state, speed=speed, dt=dt, steps=2 * per, settle=settle, record=outputs)
    n = np.arange(1, 2 * per + 1)
    marched = 2 * np.mean(run.record.values * np.exp(-2j * math.pi * n / per)[:, None], axis=0)
    # (ωΔt)²/12 = 1e-6, magnified near resonance; e^{-12} = 6e-6
    np.testing.assert_allclose(found, marched, rtol=1e-4)
    # without gyroscopic forces it would be another response
    still = replace(state.system, G=np.zeros_like(state.system.G))
    assert abs(unbalance_response(still, [speed], outputs).response.values[0, 0] / found[0] - 1) > 0.05


def test_forces_through_bearings_turn_with_the_unbalance():
    app = motor()
    app.unbalance("shaft.end", 1e-6)
    app.unbalance("ring.centre", 0.0)
    state = equilibrium(app)
    outputs = ["right.force.y", "shaft.right.force.y", "ground.cap.centre.y", "cap.centre.y"]
    found = unbalance_response(state, [200.0, 900.0], outputs)
    right, seat, ground, cap = found.response.values.T
    assert list(found.unit.values) == ["N", "N", "N", "m"]
    # what leaves the shaft goes through the balls; the cap's inertia is what the ground does not get
    np.testing.assert_allclose(seat, right, rtol=1e-7)
    np.testing.assert_allclose(ground, right + 1.0 * np.array([200.0, 900.0]) ** 2 * cap, rtol=1e-7)


def test_an_application_without_unbalance_says_so():
    with pytest.raises(ValueError, match="there is no unbalance"):
        unbalance_response(equilibrium(motor()), [100.0], ["ring.centre.y"])
    with pytest.raises(ValueError, match="speeds must be"):
        unbalance_response(jeffcott(), [-1.0], ["rotor.centre.x"])


# ------------------------------------------------------------------- radiated power


@dataclass(frozen=True)
class Box:
    """A rigid box: surfaces "sides" (normal x), "lids" (normal y), "front" (+z)."""

    size: tuple[float, float, float] = (0.3, 0.2, 0.1)

    def superelement(self) -> Superelement:
        a, b, c = self.size
        body = RigidBody(2.0, (1.0, 1.0, 1.0)).superelement()

        def pair(axis: int, area: float) -> Surface:
            # ∫ v_n² over two opposite faces, turning left out
            W = np.zeros((6, 6))
            W[axis, axis] = 2 * area
            return Surface(2 * area, W)

        front = np.zeros((6, 6))
        # v_n = z + θx y − θy x over a × b: second moments a b³/12 and a³ b/12
        front[[2, 3, 4], [2, 3, 4]] = a * b, a * b**3 / 12, a**3 * b / 12
        return replace(
            body, surfaces={"sides": pair(0, b * c), "lids": pair(1, a * c), "front": Surface(a * b, front)}
        )


def boxed(k: float = 5e5, c: float = 40.0) -> Application:
    app = Application()
    app.add("box", Box())
    app.ground("box.centre", stiffness=(k,) * 6, damping=(c,) * 6)
    return app


def test_a_rigid_box_radiates_from_the_faces_it_pushes():
    """Piston: ½ρc A |v|² of each face."""
    f = np.array([0.0, 50.0, 300.0])
    w = 2 * math.pi * f
    v = 1j * w / (5e5 - 2.0 * w**2 + 1j * w * 40.0)
    found = radiated_power(
        boxed(), f, ["box.centre.y"], ["box.lids", "box.sides"], density=1.2, sound_speed=340.0
    )
    np.testing.assert_allclose(
        found.power.values[:, 0, 0], 0.5 * 1.2 * 340.0 * 0.06 * np.abs(v) ** 2, rtol=1e-11
    )
    np.testing.assert_allclose(found.mean_square.values[:, 0, 0], np.abs(v) ** 2, rtol=1e-11)
    assert not found.power.values[:, 1].any()
    np.testing.assert_allclose(found.area.values, [0.06, 0.04])


def test_a_rocking_face_radiates_by_its_second_moment():
    f = np.array([120.0])
    w = 2 * math.pi * f
    turn = 1j * w / (5e5 - 1.0 * w**2 + 1j * w * 40.0)
    found = radiated_power(boxed(), f, ["box.centre.θx"], ["box.front"])
    # mean of (θ̇ y)² over y = ±b/2 is θ̇² b²/12
    np.testing.assert_allclose(found.mean_square.values[:, 0, 0], np.abs(turn) ** 2 * 0.2**2 / 12, rtol=1e-11)


def test_on_a_moving_ground_the_surface_moves_by_the_transmissibility():
    """Unit velocity of the ground: mean square |T|², T = (k + iωc)/(k − mω² + iωc)."""
    m, k, c = 2.0, 5e5, 40.0
    f = np.array([5.0, 70.0, 300.0])
    w = 2 * math.pi * f
    T = (k + 1j * w * c) / (k - m * w**2 + 1j * w * c)
    found = radiated_power(boxed(k, c), f, ["ground.y"], ["box.lids"])
    np.testing.assert_allclose(found.mean_square.values[:, 0, 0], np.abs(T) ** 2, rtol=1e-10)


def test_bad_requests_are_named():
    ask = (boxed(), [10.0], ["box.centre.y"])
    with pytest.raises(ValueError, match=r"'box' has no surface 'top'.*front.*lids"):
        radiated_power(*ask, ["box.top"])
    with pytest.raises(ValueError, match="'top' is no surface"):
        radiated_power(*ask, ["top"])
    with pytest.raises(ValueError, match="density is 0"):
        radiated_power(*ask, ["box.lids"], density=0.0)
    with pytest.raises(ValueError, match=r"surfaces\['a'\]\.W has shape"):
        replace(Box().superelement(), surfaces={"a": Surface(1.0, np.eye(3))})
    with pytest.raises(ValueError, match="area is 0"):
        Surface(0.0, np.eye(6))


# ------------------------------------------------------------------- surfaces of a housing


@pytest.mark.parametrize("feet", [None, Feet(0.02), Feet(0.02, 0.02)])
def test_a_housing_moved_as_a_body_pushes_with_its_projected_faces(feet):
    w, h, length, d = 0.10, 0.12, 0.03, 0.05
    app = Application()
    app.add("housing", Housing(w, h, length, d, feet=feet, f_max=8e3, element_size=0.02))
    element, R = app.plan.parts["housing"], app.plan.rigid_shapes("housing")
    assert R is not None
    flange = 2 * 0.02 * 0.02 if feet is not None and feet.height else 0.0
    face = w * h - math.pi * d**2 / 4 + flange
    sides = 2 * h * length
    shelf = 2 * 0.02 * length if flange else 0.0
    wanted = {
        "top": (0.0, w * length, 0.0),
        "front": (0.0, 0.0, face),
        "back": (0.0, 0.0, face),
        "outside": (sides, w * length + shelf, 2 * face),
    }
    assert set(element.surfaces) == set(wanted)
    for name, areas in wanted.items():
        surface = element.surfaces[name]
        found = np.diag(R[:, :3].T @ surface.W @ R[:, :3])
        # quadratic edges follow the bore's circle to 1e-5
        np.testing.assert_allclose(found, areas, rtol=1e-4, atol=1e-12)
        assert surface.area == pytest.approx(sum(areas), rel=1e-4)
        assert np.linalg.eigvalsh(surface.W).min() > -1e-12 * np.abs(surface.W).max()
    # turned about x, the front moves by y θ: its second moment about the bore's axis, at mid-height here
    second = (w * h**3 / 12 - math.pi * d**4 / 64) if not flange else None
    if second:
        turned = R[:, 3] @ element.surfaces["front"].W @ R[:, 3]
        assert turned == pytest.approx(second, rel=1e-3)


def test_power_of_a_housing_does_not_depend_on_its_mesh():
    housing = Housing(0.10, 0.12, 0.03, 0.05, f_max=2e4, element_size=0.01)
    app = Application()
    app.add("housing", housing)
    app.ground("housing.feet")
    app.free("housing.bore")
    f = np.array([500.0, 3000.0])
    fine = radiated_power(app, f, ["housing.bore.z"], ["housing.front", "housing.outside"]).power.values
    other = Application()
    other.add("housing", replace(housing, element_size=0.02))
    other.ground("housing.feet")
    other.free("housing.bore")
    coarse = radiated_power(other, f, ["housing.bore.z"], ["housing.front", "housing.outside"]).power.values
    # the same plate with elements twice as long: second-order elements bend to some percent
    np.testing.assert_allclose(coarse, fine, rtol=0.05)
    # pushed along z, the front makes nearly half of what the outside does
    assert 0.4 < fine[0, 0, 0] / fine[0, 1, 0] < 0.5


def test_speeds_beyond_the_band_of_the_layers_are_told_in_one_warning() -> None:
    state = equilibrium(examples.motor())
    with warnings.catch_warnings(record=True) as told:
        warnings.simplefilter("always")
        unbalance_response(state, 2 * np.pi * np.array([2.0, 5.0, 50.0]), ["shaft.middle.y"])
    assert [str(w.message).partition(" lies")[0] for w in told] == ["2 to 5 Hz"]  # the band begins at 10 Hz
