"""The builder: names, joints, loads, and what it refuses before any work."""

from __future__ import annotations

import numpy as np
import pytest

from bearingdyn.application import Application
from bearingdyn.bearing import BallBearing
from bearingdyn.fem import Section
from bearingdyn.material import STEEL, WLF, Maxwell
from bearingdyn.parts import FlexibleRing, Layer, RigidBody, Shaft

BODY = RigidBody(2.0, (0.01, 0.01, 0.015))
SHAFT = Shaft([Section(0.2, 0.02)], seats={"left": 0.02, "right": 0.18}, points={"end": 0.0}, f_max=3e3)
BEARING = BallBearing(8, 12.303e-3, 52e-3, 0.52, 0.53, clearance=10e-6)


def pair() -> Application:
    app = Application()
    app.add("shaft", SHAFT)
    app.add("block", BODY)
    return app


def test_one_part_under_two_names_is_reduced_once():
    app = Application()
    app.add("left", BODY)
    app.add("right", BODY)
    app.add("other", RigidBody(2.0, (0.01, 0.01, 0.015)))
    assert app.plan.parts["left"] is app.plan.parts["right"]
    assert app.plan.parts["other"] is not app.plan.parts["left"]


def test_a_twin_added_later_is_at_its_own_temperature():
    rubber = Maxwell(
        G0=1e6, G=[2e6], tau=[1e-3], K=2e9, density=1200.0, law=WLF(8.0, 120.0, 20.0), temperature=20.0
    )
    layer = Layer(0.036, 0.039, 0.019, rubber, refinement=0.5)
    app = Application()
    app.add("warm", layer)
    app.temperature("warm", 60.0)
    app.add("cool", layer)
    materials = [app.plan.parts[name].viscoelastic[0].material for name in ("warm", "cool")]
    # WLF: log10 a_T = −8·40/160 = −2
    assert [m.tau[0] for m in materials] == pytest.approx([1e-5, 1e-3], rel=1e-12)


def test_a_flexible_ring_weighs_what_it_is_made_of():
    app = Application()
    app.add("ring", FlexibleRing(0.030, 0.036, 0.019, arm=0.026, order=3, refinement=0.5))
    mass = STEEL.density * np.pi * (0.036**2 - 0.030**2) * 0.019
    # its raceway's coordinates move along
    assert app.mass("ring") == pytest.approx(mass, rel=1e-9)


def test_names_are_part_and_interface():
    assert pair().names() == ["shaft.left", "shaft.right", "shaft.end", "block.centre"]


def test_summary_tells_parts_masses_joints_bearings_and_loads():
    app = pair()
    app.connect("shaft.right", "block.centre")
    app.bearing("front", BEARING, inner="shaft.left", outer="ground")
    app.load("shaft.end", (0, -5.0, 0, 0, 0, 0))
    app.unbalance("shaft.end", 1e-4)
    text = app.summary()
    for piece in ("shaft.right = block.centre", "front: shaft.left in ground, 8 balls", "-5.0", "rotating"):
        assert piece in text
    # 7850 kg/m³ of Ø20×200, and the 2 kg given
    assert f"{7850 * np.pi * 0.01**2 * 0.2:.4f} kg" in text
    assert "2.0000 kg" in text


@pytest.mark.parametrize("name", ["", "a.b", "ground"])
def test_part_names_without_dots(name):
    with pytest.raises(ValueError, match="without dots"):
        Application().add(name, BODY)


def test_a_name_is_given_once():
    app = pair()
    with pytest.raises(ValueError, match=r"'shaft'.*taken"):
        app.add("shaft", BODY)
    with pytest.raises(ValueError, match=r"'shaft'.*taken"):
        app.bearing("shaft", BEARING, inner="shaft.left", outer="ground")
    app.bearing("front", BEARING, inner="shaft.left", outer="ground")
    with pytest.raises(ValueError, match=r"'front'.*taken"):
        app.bearing("front", BEARING, inner="shaft.right", outer="ground")
    with pytest.raises(ValueError, match=r"'front'.*taken"):
        app.add("front", BODY)


@pytest.mark.parametrize(
    ("act", "message"),
    [
        (lambda a: a.connect("shaft.left", "block.middle"), r"'block' has no interface 'middle'.*centre"),
        (lambda a: a.connect("axle.left", "block.centre"), r"'axle.left' names no part.*block.*shaft"),
        (lambda a: a.connect("shaft", "block.centre"), "'shaft' names no place"),
        (lambda a: a.connect("shaft.end", "block.centre"), "no interface 'end'"),
        (lambda a: a.connect("shaft.left", "shaft.left"), "to itself"),
        (lambda a: a.connect("shaft.left", "shaft.right"), "one part"),
        (lambda a: a.ground("shaft.foot"), "no interface 'foot'"),
        (
            lambda a: a.ground("shaft.left", stiffness=(1e6, 1e6)),
            r"shape is \(2,\), it must be \(6,\): six numbers",
        ),
        (lambda a: a.ground("shaft.left", stiffness=1e6), r"shape is \(\), it must be \(6,\): six numbers"),
        (lambda a: a.ground("shaft.left", damping=(-1, 0, 0, 0, 0, 0)), "cannot be negative"),
        (lambda a: a.ground("shaft.left", stiffness=(np.nan,) * 6), "finite"),
        (lambda a: a.free("shaft.foot"), "no interface 'foot'"),
        (lambda a: a.bearing("b.1", BEARING, inner="shaft.left", outer="ground"), "without dots"),
        (lambda a: a.bearing("b", BEARING, inner="shaft.left", outer="shaft.left"), "both rings"),
        (lambda a: a.bearing("b", BEARING, inner="ground", outer="shaft.left"), "'ground' names no place"),
        (lambda a: a.load("shaft.foot", (0,) * 6), "no interface or output 'foot'"),
        (lambda a: a.load("shaft.left", (0, 1, 0)), r"shape is \(3,\), it must be \(6,\): six numbers"),
        (lambda a: a.load("shaft.left", (0, np.inf, 0, 0, 0, 0)), "finite"),
        (lambda a: a.load("shaft.left", (1,) * 6, frequency=0.0), "frequency is 0.0; it must be positive"),
        (lambda a: a.load("shaft.left", (1,) * 6, frequency=np.nan), "frequency is nan"),
        (lambda a: a.load("shaft.left", (1,) * 6, phase=0.3), "phase is 0.3.*frequency"),
        (lambda a: a.load("shaft.left", (1,) * 6, frequency=9.0, time=[0, 1], value=[0, 1]), "not both"),
        (lambda a: a.load("shaft.left", (1,) * 6, time=[0, 1]), "2 samples and value 0"),
        (lambda a: a.load("shaft.left", (1,) * 6, time=[0, 1], value=[1.0]), "2 samples and value 1"),
        (lambda a: a.load("shaft.left", (1,) * 6, time=[0, 2, 1], value=[0, 1, 2]), "time must increase"),
        (lambda a: a.load("shaft.left", (1,) * 6, time=[0, 1], value=[0, np.nan]), "finite"),
        (lambda a: a.unbalance("shaft.end", -1e-4), "finite and not negative"),
        (lambda a: a.unbalance("shaft.end", np.nan), "finite and not negative"),
    ],
)
def test_bad_input_is_named(act, message):
    app = pair()
    with pytest.raises(ValueError, match=message):
        act(app)
    # nothing half-made stays behind
    assert (app.plan.connections, app.plan.supports, app.plan.bearings, app.plan.loads) == ([], {}, {}, [])


def test_an_interface_is_connected_once():
    app = pair()
    app.add("cap", BODY)
    app.connect("shaft.left", "block.centre")
    for a, b in (("shaft.left", "cap.centre"), ("cap.centre", "block.centre")):
        with pytest.raises(ValueError, match="is connected already"):
            app.connect(a, b)


def test_an_interface_is_grounded_once():
    app = pair()
    app.ground("block.centre", stiffness=(1e6,) * 6)
    with pytest.raises(ValueError, match=r"block\.centre is grounded already"):
        app.ground("block.centre")


def test_a_loose_interface_is_named():
    app = pair()
    app.connect("shaft.left", "block.centre")
    with pytest.raises(ValueError, match=r"shaft\.right is not connected.*app\.free\(\"shaft\.right\"\)"):
        app.plan.check_joints()
    app.free("shaft.right")
    app.plan.check_joints()


def test_an_empty_application_says_so():
    with pytest.raises(ValueError, match="no parts"):
        Application().plan.check_joints()


def test_a_point_without_rotation_takes_no_moment():
    from bearingdyn.cms import Superelement

    class Block:
        def superelement(self) -> Superelement:
            zero = np.zeros((6, 6))
            point = np.hstack([np.eye(3), np.zeros((3, 3))])
            return Superelement(
                M=np.eye(6),
                C=zero,
                G=zero,
                K=zero,
                interfaces={"centre": np.arange(6)},
                outputs={"top": point},
            )

    app = Application()
    app.add("block", Block())
    app.load("block.top", (0, 1, 0, 0, 0, 0))
    with pytest.raises(ValueError, match="no rotation"):
        app.load("block.top", (0, 1, 0, 0, 0, 2.0))


def test_inputs_are_copied():
    vector, value = np.zeros(6), np.array([0.0, 1.0])
    app = pair()
    app.load("shaft.left", vector, time=[0.0, 1.0], value=value)
    vector[0], value[0] = 7.0, 7.0
    assert app.plan.loads[0].vector[0] == 0.0
    assert app.plan.loads[0].value[0] == 0.0


def test_what_is_reduced_already_is_a_part():
    app = Application()
    element = SHAFT.superelement()
    app.add("shaft", element)
    assert app.plan.parts["shaft"] is element
