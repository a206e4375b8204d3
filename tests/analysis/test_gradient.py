"""Derivatives of responses, modes and static states against differences of machines built anew."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

import bearingdyn as bd
from bearingdyn.fem import revolution_mesh
from bearingdyn.parts import Cylinder, Patch, Region

RUBBER = bd.Maxwell(1.2e6, [1e6, 2.5e6], [2e-3, 1e-4], 30.0, K=1.5e9, density=1150.0)
MODULI = (1.2e6, 5e6)  # of the layer's shapes: held, as a derivative holds them
FREQUENCY = np.array([20.0, 90.0, 210.0, 480.0, 1300.0])
INPUTS, OUTPUTS = ["rotor.centre.y", "ground.x"], ["rotor.centre.y", "ring.centre.x"]
BASE = {
    "layer.r_inner": 0.026,
    "layer.r_outer": 0.031,
    "layer.width": 0.016,
    "layer.G0": RUBBER.G0,
    "layer.G1": RUBBER.G[0],
    "layer.G2": RUBBER.G[1],
    "layer.tau1": RUBBER.tau[0],
    "layer.tau2": RUBBER.tau[1],
    "layer.eta0": RUBBER.eta0,
    "layer.K": RUBBER.K,
    "layer.density": RUBBER.density,
    "b.clearance": 8e-6,
    "load.rotor.centre.y": -240.0,
    "load.rotor.centre.z": 150.0,
    "rotor.mass": 3.0,
    "ring.inertia.x": 2e-4,
    "rotor.centre.stiffness.y": 2e5,
    "rotor.centre.damping.y": 40.0,
}
DIMENSIONS = ["layer.r_inner", "layer.r_outer", "layer.width"]
# of a rebuilt machine's own round-off, through differences of a step of some 1e-3
EXACT = {name: 1e-5 if name in DIMENSIONS else 1e-6 for name in BASE}
STEPS = dict.fromkeys(DIMENSIONS, 1e-3) | {"rotor.mass": 4e-3}
AFTER = 1e-3
QUICK = ("layer.width", "layer.G1", "b.clearance", "load.rotor.centre.z")


def layer_of(v):
    """The layer; where its dimensions are not the base's, by the base's mesh moved linearly."""
    material = replace(
        RUBBER,
        G0=v["layer.G0"],
        G=[v["layer.G1"], v["layer.G2"]],
        tau=[v["layer.tau1"], v["layer.tau2"]],
        eta0=v["layer.eta0"],
        K=v["layer.K"],
        density=v["layer.density"],
    )
    r, R, b = (v[name] for name in DIMENSIONS)
    if all(v[name] == BASE[name] for name in DIMENSIONS):
        return bd.Layer(r, R, b, material, moduli=MODULI)
    r0, R0, b0 = (BASE[name] for name in DIMENSIONS)
    mesh = revolution_mesh([Region((r0, R0), (-b0 / 2, b0 / 2), material).rectangle])
    mesh = replace(mesh, r=r + (mesh.r - r0) * (R - r) / (R0 - r0), z=mesh.z * b / b0)
    faces = {"inner": Cylinder(r), "outer": Cylinder(R)}
    return bd.Revolved((Patch(material),), faces, moduli=MODULI, section=mesh)


def machine(v):
    """A rotor in a bearing in a ring in a layer, preloaded, gravity on."""
    app = bd.Application()
    inertia = (4e-3, 4e-3, 5e-3)
    app.add("rotor", bd.RigidBody(mass=v["rotor.mass"], inertia=inertia, rotating=True))
    app.add("ring", bd.RigidBody(mass=0.1, inertia=(v["ring.inertia.x"], 2e-4, 3e-4)))
    app.add("layer", layer_of(v))
    app.connect("ring.centre", "layer.inner")
    app.ground("layer.outer")
    c = v["rotor.centre.damping.y"]
    app.ground(
        "rotor.centre",
        stiffness=[1e5, v["rotor.centre.stiffness.y"], 1e3, 2e3, 2e3, 0],
        damping=[10, c, 5, 1, 1, 0.1],
    )
    ball = bd.catalogue.bearing("6205", clearance=v["b.clearance"], damping=20.0).turned(0.1)
    app.bearing("b", ball, inner="rotor.centre", outer="ring.centre")
    app.gravity((0, -9.81, 0))
    force = (25.0, v["load.rotor.centre.y"], v["load.rotor.centre.z"], 0, 0, 0)
    app.load("rotor.centre", force)
    return bd.equilibrium(app, after=AFTER)


def answers(v, speed):
    eq = machine(v)
    modes = bd.modes(eq, 4, damped=True, speed=speed)
    return {
        "response": bd.frequency_response(eq, FREQUENCY, INPUTS, OUTPUTS, speed=speed)["response"].values,
        "frequency": modes["frequency"].values,
        "damping": modes["damping_ratio"].values,
        "undamped": bd.modes(eq, 6)["frequency"].values[1:],
        "sag": eq.displacement("rotor.centre")[1],
        "strain": float(
            bd.Layer(*(v[n] for n in DIMENSIONS), RUBBER).nominal_strain(
                eq.displacement("layer.outer") - eq.displacement("layer.inner")
            )
        ),
    }


def by_richardson(v, name, speed, step):
    """Derivatives by central differences at h, 2h, 4h, extrapolated twice."""
    found = []
    for k in (1, 2, 4):
        h = k * step * v[name]
        high, low = (answers(v | {name: v[name] + s * h}, speed) for s in (1, -1))
        found.append({key: (high[key] - low[key]) / (2 * h) for key in high})
    one, two, four = found
    return {key: (64 * one[key] - 20 * two[key] + four[key]) / 45 for key in one}  # of h², then of h⁴


@pytest.fixture(scope="module")
def slope():
    return bd.gradient(machine(BASE), list(BASE))


@pytest.fixture(scope="module")
def told(slope):
    return {speed: slope_of(slope, speed) for speed in (0.0, 300.0)}


def slope_of(slope, speed):
    response = slope.response(FREQUENCY, INPUTS, OUTPUTS, speed=speed)
    damped = slope.modes(4, speed=speed)
    return {
        "response": response["derivative"].values,
        "frequency": damped["frequency_derivative"].values,
        "damping": damped["damping_ratio_derivative"].values,
        "sag": slope.displacement("rotor.centre.y")[1],
        "strain": slope.strain("layer")[1],
    }


@pytest.mark.parametrize(
    "name", [pytest.param(n, marks=[] if n in QUICK else pytest.mark.slow) for n in BASE]
)
def test_derivatives_are_those_of_machines_built_anew(told, name):
    p = list(BASE).index(name)
    speed = 300.0 if name in ("rotor.mass", "layer.tau1", "b.clearance") else 0.0
    found = {key: value[p] for key, value in told[speed].items()}
    # small enough for the terms of h⁶, large enough for the equilibrium's round-off
    expected = by_richardson(BASE, name, speed, STEPS.get(name, 1.6e-2))
    plain = answers(BASE, speed)
    for key, value in found.items():
        # of the derivative; where it is less, of 1e-3 of answer over parameter, as answers are good to 1e-11
        size = np.maximum(np.abs(expected[key]).max(), 1e-3 * np.abs(plain[key]).max() / abs(BASE[name]))
        error = np.abs(value - expected[key]).max() / size
        assert error < EXACT[name], (key, error)


def test_the_answers_beside_the_derivatives_are_those_of_the_other_analyses(slope):
    eq = slope.source
    frf = bd.frequency_response(eq, FREQUENCY, INPUTS, OUTPUTS, quantity="velocity")
    found = slope.response(FREQUENCY, INPUTS, OUTPUTS, quantity="velocity")
    assert found["response"].values == pytest.approx(frf["response"].values, rel=1e-12)
    turned = (np.conj(frf["response"].values) * found["derivative"].values).real
    assert found["magnitude_derivative"].values * np.abs(frf["response"].values) == pytest.approx(turned)
    assert slope.displacement("rotor.centre.y")[0] == eq.displacement("rotor.centre")[1]
    relative = eq.displacement("layer.outer") - eq.displacement("layer.inner")
    layer = bd.Layer(*(BASE[n] for n in DIMENSIONS), RUBBER)
    assert slope.strain("layer")[0] == pytest.approx(float(layer.nominal_strain(relative)), rel=1e-12)


def test_the_tangents_in_complex_arithmetic_are_the_core_s(slope):
    from bearingdyn.analysis.gradient.contact_tangent import tangent

    (term,) = slope.source.system.bearings
    state = slope.source.bearings["b"]
    found = tangent(term.kernel(), state.z)
    for mine, theirs in ((found.g, state.g), (found.K, state.K), (found.C, state.C)):
        # 1e-12: of the largest, both sums of nine balls
        assert np.abs(mine - theirs).max() < 1e-12 * np.abs(theirs).max()


def test_static_compliance_of_a_spring_and_mode_of_a_mass_in_closed_form():
    k, m, c = 1e6, 2.0, 20.0
    app = bd.Application()
    app.add("mass", bd.RigidBody(mass=m, inertia=(1e-3, 1e-3, 1e-3)))
    app.ground("mass.centre", stiffness=[1.7e6, k, 2.1e6, 1e4, 2e4, 3e4], damping=[0, c, 0, 0, 0, 0])
    names = ["mass.centre.stiffness.y", "mass.mass", "mass.centre.damping.y"]
    slope = bd.gradient(app, names)
    y = ["mass.centre.y"]
    at_rest = slope.response([0.0], y, y)["derivative"].values.ravel()
    assert at_rest == pytest.approx([-1 / k**2, 0.0, 0.0], rel=1e-12)
    modes = slope.modes(damped=False)
    j = int(np.argmin(np.abs(modes["frequency"].values - math.sqrt(k / m) / (2 * math.pi))))
    f = modes["frequency"].values[j]
    expected = [f / (2 * k), -f / (2 * m), 0.0]
    assert modes["frequency_derivative"].values[:, j] == pytest.approx(expected, rel=1e-10)
    # ζ = c / 2√(km)
    damped = slope.modes()
    j = int(np.argmin(np.abs(damped["frequency"].values - f)))
    zeta = c / (2 * math.sqrt(k * m))
    expected = [-zeta / (2 * k), -zeta / (2 * m), zeta / c]
    assert damped["damping_ratio_derivative"].values[:, j] == pytest.approx(expected, rel=1e-9)


def test_parameters_that_change_together_add_up(slope):
    together = bd.gradient(
        slope.source,
        {
            "thickness": {"layer.r_outer": 1.0},
            "level": {n: BASE[n] for n in ("layer.G0", "layer.G1", "layer.G2")},
        },
    )
    many = dict(zip(BASE, slope.displacement("rotor.centre.y")[1], strict=True))
    found = together.displacement("rotor.centre.y")[1]
    level = sum(many[n] * BASE[n] for n in ("layer.G0", "layer.G1", "layer.G2"))
    assert found == pytest.approx([many["layer.r_outer"], level], rel=1e-12)
    assert together.parameters == ["thickness", "level"]


def test_a_ball_that_just_touches_has_a_derivative_to_one_side_only():
    """No clearance, radial load: the balls at right angles to it touch and carry nothing."""

    def rotor(clearance):
        app = bd.Application()
        app.add("rotor", bd.RigidBody(mass=2.0, inertia=(1e-3, 1e-3, 1e-3)))
        app.ground("rotor.centre", stiffness=[0, 0, 1e7, 1e4, 1e4, 1e4])
        race = {"Z": 8, "Dw": 8e-3, "Dpw": 40e-3, "fi": 0.52, "fo": 0.53, "kappa": 8e9}
        ball = bd.BallBearing(**race, clearance=clearance)
        app.bearing("b", ball, inner="rotor.centre", outer="ground")
        app.load("rotor.centre", (500.0, 0, 0, 0, 0, 0))
        return bd.equilibrium(app)

    with pytest.raises(ValueError, match=r"ball 3 of bearing 'b' just touches.*side='parted'"):
        bd.gradient(rotor(0.0), ["b.clearance"])
    one_sided = bd.gradient(rotor(0.0), ["b.clearance"], side="parted")
    sag, slope = one_sided.displacement("rotor.centre.x")
    # towards more clearance the two balls part
    h = 1e-9
    moved = [rotor(k * h).displacement("rotor.centre")[0] for k in (1, 2)]
    assert slope[0] == pytest.approx((4 * (moved[0] - sag) - (moved[1] - sag)) / (2 * h), rel=1e-5)


def test_a_motion_that_nothing_resists_has_no_derivative():
    """One ball alone carries, and nothing holds the ring across it: a load there has no small answer."""
    app = bd.Application()
    app.add("rotor", bd.RigidBody(mass=2.0, inertia=(1e-3, 1e-3, 1e-3)))
    app.ground("rotor.centre", stiffness=[0, 0, 1e7, 1e4, 1e4, 1e4])
    ball = bd.BallBearing(Z=8, Dw=8e-3, Dpw=40e-3, fi=0.52, fo=0.53, kappa=8e9, clearance=1e-4)
    app.bearing("b", ball, inner="rotor.centre", outer="ground")
    app.load("rotor.centre", (0, -50.0, 0, 0, 0, 0))
    eq = bd.equilibrium(app)
    _, by = bd.gradient(eq, ["b.clearance"]).displacement("rotor.centre.y")
    # the clearance opens downwards: half of the diametral one, as the ball stands in the load's line
    assert by[0] == pytest.approx(-0.5, rel=1e-2)  # the contact angle of 4° changes a little
    with pytest.raises(ValueError, match=r"'load.rotor.centre.x' pushes rotor.centre along .* fold"):
        bd.gradient(eq, ["b.clearance", "load.rotor.centre.x"])


def test_modes_that_coincide_are_named_where_a_parameter_parts_them():
    app = bd.Application()
    app.add("mass", bd.RigidBody(mass=2.0, inertia=(1e-3, 1e-3, 1e-3)))
    app.ground("mass.centre", stiffness=[1e6, 1e6, 3e6, 1e4, 2e4, 3e4])
    slope = bd.gradient(app, ["mass.mass"])  # moves both alike
    f = math.sqrt(1e6 / 2.0) / (2 * math.pi)
    assert slope.modes(2, damped=False)["frequency_derivative"].values[0] == pytest.approx([-f / 4] * 2)
    parting = bd.gradient(app, ["mass.centre.stiffness.y"])
    with pytest.raises(ValueError, match=r"modes 1, 2 coincide at 112\.5.*one-sided.*side='up'"):
        parting.modes(2, damped=False)
    up = bd.gradient(app, ["mass.centre.stiffness.y"], side="up").modes(2, damped=False)
    down = bd.gradient(app, ["mass.centre.stiffness.y"], side="down").modes(2, damped=False)
    assert up["frequency_derivative"].values[0] == pytest.approx([0.0, f / 2e6], abs=1e-12)
    assert down["frequency_derivative"].values[0] == pytest.approx([f / 2e6, 0.0], abs=1e-12)


def test_what_has_no_derivative_is_named(slope):
    eq = slope.source
    for name, said in (
        ("layer.thickness", "r_inner, r_outer, width"),
        ("leyer.G0", r"did you mean 'layer'"),
        ("layer.G7", "G0, G1"),
        ("rotor.inertia.x", "inertia"),  # of a body that turns Ix and Iy go together
        ("rotor.centre.stiffness.w", "component"),
        ("nowhere.stiffness.y", "there are"),
    ):
        with pytest.raises(ValueError, match=said):
            bd.gradient(eq, [name])
    with pytest.raises(ValueError, match="parameters is"):
        bd.gradient(eq, "layer.G0")
    with pytest.raises(ValueError, match="side is 'left'"):
        bd.gradient(eq, ["layer.G0"], side="left")
    with pytest.raises(ValueError, match="must be a motion"):
        slope.response([10.0], ["rotor.centre.y"], ["b.force.y"])
    with pytest.raises(ValueError, match="must be a layer"):
        slope.strain("rotor")
