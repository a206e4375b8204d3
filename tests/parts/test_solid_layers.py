"""Layers of solid elements: rings against bodies of revolution; strips, pads and O-rings against formulae."""

from __future__ import annotations

import math
import warnings

import numpy as np
import pytest
from scipy.special import ellipk

from bearingdyn.analysis import modes
from bearingdyn.application import Application
from bearingdyn.fem import (
    SolidMesh,
    assemble_solid,
    box_mesh,
    factorise,
    lowest_modes,
    o_ring_mesh,
    ring_mesh,
)
from bearingdyn.fem.meshes.solid_mesh import second_order
from bearingdyn.material import STEEL, Elastic, Maxwell
from bearingdyn.parts import Layer, RigidBody, RigidSurface, Solid, damping_sample
from verified.row import as_printed, unit_rubber

pytest.importorskip("skfem")

MM = 1e-3
RUBBER = Maxwell(1e6, [3e6], [1e-4], K=2e9, density=1200.0)
AXES = {"inner": RigidSurface("inner", "axis"), "outer": RigidSurface("outer", "axis")}


def strip_over_theory(mesh, incompressible):
    """A bonded strip, ν = 0.49995, 20 wide and 1 thick, pressed in plane strain, over the formula.

    Pressure p'' = 12 G/t² (p/K − ε): E = K (1 − tanh λb/λb), λ² = 12 G/K t², and 4/3 G of the stretch itself.
    """
    material, half = unit_rubber(0.49995), 10.0
    p, K = mesh.points, assemble_solid(mesh, incompressible=incompressible).stiffness(material)
    above, below = p[:, 1] > 1 - 1e-9, p[:, 1] < 1e-9
    u, held = np.zeros_like(p), np.zeros(p.shape, dtype=bool)
    u[above, 1] = 1.0
    held[:, 2] = held[above] = held[below] = True
    u, free = u.ravel(), np.flatnonzero(~held.ravel())
    u[free] = -factorise(K[free][:, free]).solve(K[free] @ u)
    slope = math.sqrt(12 * material.G / material.K) * half
    theory = 2 * half * (material.K * (1 - math.tanh(slope) / slope) + 4 / 3 * material.G)
    return u @ (K @ u) / theory / np.ptp(p[:, 2])


@pytest.mark.parametrize(
    ("element", "incompressible", "published"),
    [
        ("hex20", False, 1.15),
        ("hex20", True, 1.012),
        ("hex27", True, 0.995),
    ],
)
def test_bonded_strip_does_not_lock_with_the_cure_and_does_without(element, incompressible, published):
    mesh = box_mesh(np.linspace(-10, 10, 21), np.linspace(0, 1, 3), [0.0, 1.0], element)
    ratio = strip_over_theory(mesh, incompressible)
    print(f"bonded strip, {element}, cure {incompressible}: {ratio:.4f} of theory")
    # the ratios of design.md section 4, whose mesh and strip are not given: half a per cent of them
    assert ratio == pytest.approx(published, abs=0.005)


def test_tetrahedra_with_a_bubble_do_not_lock_either():
    six = [(0, 1, 2, 6), (0, 2, 3, 6), (0, 3, 7, 6), (0, 7, 4, 6), (0, 4, 5, 6), (0, 5, 1, 6)]
    found = {}
    for n in (2, 4):
        box = box_mesh(np.linspace(-10, 10, 10 * n + 1), np.linspace(0, 1, n + 1), [0.0, 0.5])
        corners = np.vstack([box.elements[:, list(t)] for t in six])
        p, elements, _ = second_order(box.points[: corners.max() + 1], corners)
        for cure in (False, True):
            found[n, cure] = strip_over_theory(SolidMesh(p, elements), cure)
    print("bonded strip, tetrahedra:", {k: round(v, 4) for k, v in found.items()})
    assert found[2, False] > 1.15  # locked
    # linear pressure: second order, 2 % with two through the thickness (7 % too soft without the bubble)
    assert abs(1 - found[2, True]) < 0.03
    assert abs(1 - found[4, True]) < 0.25 * abs(1 - found[2, True])


# each half of a brick, the axis of the wedge along z, y or x of the strip
WEDGES = {
    "along the strip": [(0, 1, 2, 4, 5, 6), (0, 2, 3, 4, 6, 7)],
    "through its thickness": [(0, 5, 1, 3, 6, 2), (0, 4, 5, 3, 7, 6)],
    "across": [(0, 3, 7, 1, 2, 6), (0, 7, 4, 1, 6, 5)],
}


@pytest.mark.parametrize("axis", WEDGES)
def test_wedges_with_a_bubble_do_not_lock_either(axis):
    found = {}
    for n in (2, 4):
        box = box_mesh(np.linspace(-10, 10, 10 * n + 1), np.linspace(0, 1, n + 1), [0.0, 0.5])
        corners = np.vstack([box.elements[:, list(t)] for t in WEDGES[axis]])
        p, elements, _ = second_order(box.points[: corners.max() + 1], corners)
        for cure in (False, True):
            found[n, cure] = strip_over_theory(SolidMesh(p, elements), cure)
    print(f"bonded strip, wedges {axis}:", {k: round(v, 4) for k, v in found.items()})
    assert found[2, False] > 1.1  # locked
    # as they lie; without the bubble, whose pressure was constant in the triangles, .78, .91 and 1.00.
    # The formula is of a thin strip, good to half a per cent here (27-node bricks: .9915 and .9928)
    assert abs(1 - found[2, True]) < 0.01
    assert abs(1 - found[4, True]) < 0.005


def test_bonded_ring_of_bricks_is_as_stiff_as_the_body_of_revolution():
    material = unit_rubber(0.499)
    exact = np.diag(Layer(26 * MM, 28 * MM, 16 * MM, material).stiffness().real)[:6]
    mesh = ring_mesh((26 * MM, 28 * MM), 16 * MM, across=3, along=9, around=24)
    found = np.diag(Solid(mesh, material, AXES, 0.0).stiffness().real)[:6]
    print("ring of bricks over revolution, ν = 0.499, x y z θx θy θz:", np.round(found / exact, 5))
    # asked for to 0.5 %
    np.testing.assert_allclose(found, exact, rtol=5e-3)


@pytest.mark.parametrize(("element", "tolerance"), [("hex27", 0.01), ("hex20", 0.07)])
def test_viscoelastic_ring_of_bricks_follows_the_layer_at_any_frequency(element, tolerance):
    # 2×6×16 bricks: 1 %; the selective 20-node brick converges more slowly. G/K = 5e-4 to 2e-3: locked
    # elements would be out by tens of per cent
    exact = Layer(26 * MM, 28 * MM, 16 * MM, RUBBER)
    mesh = ring_mesh((26 * MM, 28 * MM), 16 * MM, across=2, along=6, around=16, element=element)
    solid = Solid(mesh, RUBBER, AXES, 0.0)
    for omega in (0.0, 1e4):
        ratio = np.diag(solid.stiffness(omega))[:6] / np.diag(exact.stiffness(omega))[:6]
        print(f"viscoelastic ring of {element} over the layer at {omega:g} rad/s:", np.round(ratio, 4))
        np.testing.assert_allclose(ratio, 1.0, atol=tolerance)


@pytest.mark.slow
def test_sample_of_bricks_vibrates_as_the_body_of_revolution():
    rubber = Elastic(2 * 1e6 * 1.499, 0.499, 1200.0)
    body = damping_sample(rubber)
    exact = np.concatenate([body.modes(0, 4).frequency[2:], np.repeat(body.modes(1, 4).frequency[2:], 2)])
    radii = np.array((15.0, 17.5, 20.0, 26.0)) * MM
    mesh = ring_mesh(
        radii, 11 * MM, across=(1, 3, 1), along=6, around=24, regions=("inside", "rubber", "outside")
    )
    solid = Solid(mesh, {"inside": STEEL, "rubber": rubber, "outside": STEEL}, {"bore": "inner"}, 0.0)
    model, shift = solid.full_model(), (2 * math.pi * 100.0) ** 2
    f = lowest_modes(model.stiffness() + shift * model.M, model.M, n_modes=12)[0]
    f = np.sqrt((2 * math.pi * f[6:]) ** 2 - shift) / (2 * math.pi)
    print("sample of bricks over revolution, ν = 0.499:", np.round(f / np.sort(exact), 5))
    np.testing.assert_allclose(f, np.sort(exact), rtol=5e-3)  # asked for to 0.5 %


def pad(thickness, around):
    radii = (20.0 * MM, (20.0 + thickness) * MM)
    mesh = ring_mesh(radii, 20.0 * MM, (-math.pi / 4, math.pi / 4), across=2, around=around)
    return np.diag(as_printed(Solid(mesh, unit_rubber(0.3), AXES, 0.0).stiffness()))[:6]


def test_thin_pads_carry_shear_and_pressure_by_their_area():
    # a quarter of a ring about the x axis: G/t an area in shear and (K + 4/3 G)/t in pressure
    material, r, width = unit_rubber(0.3), 20.0, 20.0
    errors = []
    for t in (1.0, 0.25):
        shear, pressure, radius = 1 / t, (material.K / material.G + 4 / 3) / t, r + t / 2
        found, area = pad(t, 8), radius * width
        wide, slim = math.pi / 4 + 0.5, math.pi / 4 - 0.5  # ∫cos² and ∫sin² over the quarter
        theory = np.array(
            [
                area * (pressure * wide + shear * slim),
                area * (pressure * slim + shear * wide),
                area * math.pi / 2 * shear,
                area * radius**2 * math.pi / 2 * shear,
            ]
        )
        error = found[[0, 1, 2, 5]] / theory - 1
        print(f"pad of thickness {t}: x, y, z, θz over the formula − 1:", np.round(error, 4))
        errors.append(np.abs(error).max())
        # edges relax over a depth of the thickness: of the order t/width, both sides
        assert errors[-1] < t / width
    assert errors[1] < errors[0] / 3  # and vanish with the thickness


def test_four_pads_make_a_ring_but_for_their_edges():
    ring = np.diag(as_printed(Layer(20.0 * MM, 20.25 * MM, 20.0 * MM, unit_rubber(0.3)).stiffness()))
    one = pad(0.25, 8)
    for name, four, whole in (
        ("radial", 2 * (one[0] + one[1]), ring[0]),
        ("axial", 4 * one[2], ring[2]),
        ("torsion", 4 * one[5], ring[5]),
    ):
        print(f"four pads over the ring, {name}: {four / whole:.5f}")
        # four cuts relax the rubber over the depth t of 31 mm; the pads' coarse mesh adds 0.2 %
        assert four == pytest.approx(whole, rel=4 * 0.25 / 31 + 2e-3)


def test_cord_of_an_o_ring_shears_as_a_disc_between_two_arcs():
    # A long cord sheared along itself by two bands of half-angle β: conduction through a disc between two
    # arcs, mapped on a rectangle of 2K(k) by K'(k), k = tan²(β/2). Here a piece one element long, of a ring
    # so large that it is straight, moving along itself only.
    radius = 2000.0
    for half, across, tolerance in ((45, 4, 0.03), (45, 8, 0.012), (30, 8, 0.012)):
        beta = math.radians(half)
        length = (-0.5 / radius, 0.5 / radius)
        mesh = o_ring_mesh(radius, 2.0, 2.0 * math.sin(beta), length, across=across, around=1)
        material = unit_rubber(0.3)
        K = assemble_solid(mesh).stiffness(material) / material.G
        u, held = np.zeros(mesh.points.shape), np.ones(mesh.points.shape, dtype=bool)
        held[:, 1] = False
        held[mesh.surface("inner"), 1] = held[mesh.surface("outer"), 1] = True
        u[mesh.surface("outer"), 1] = 1.0
        x, free = u.ravel(), np.flatnonzero(~held.ravel())
        x[free] = -factorise(K[free][:, free]).solve(K[free] @ x)
        m = math.tan(beta / 2) ** 4
        error = x @ (K @ x) / (2 * ellipk(m) / ellipk(1 - m)) - 1
        print(f"cord of an O-ring, bands of ±{half}°, {across} elements across: {error:.2e} over the formula")
        # the ends of the bands are singular: too stiff, by the first power of the element there
        assert 0 < error < tolerance


def test_o_ring_has_the_volume_of_a_torus():
    mesh = o_ring_mesh(0.02, 0.003, 0.001)
    # the cord's quadratic arcs and those around are round to the fourth order
    assert mesh.volume() == pytest.approx(2 * math.pi**2 * 0.02 * 0.0015**2, rel=2e-3)
    beta = math.asin(1 / 3)
    for name, turn in (
        ("inner", 0.02 - 0.0015 * math.sin(beta) / beta),
        ("outer", 0.02 + 0.0015 * math.sin(beta) / beta),
    ):
        assert mesh.samples(name).area == pytest.approx(2 * math.pi * turn * 0.003 * beta, rel=1e-3)
    assert Solid(mesh, RUBBER, AXES, 0.0).mass == pytest.approx(1200.0 * mesh.volume(), rel=1e-12)


def test_block_on_a_shear_pad_slides_and_twists_at_its_formulae():
    # a = 40 mm, t = 1 mm, G = 1 MPa under 10 kg: sliding k = G a²/t, twisting k = G/t ∫r² dA = G a⁴/6t
    mesh = box_mesh(
        np.linspace(0, 40 * MM, 9), np.linspace(0, 1 * MM, 3), np.linspace(0, 40 * MM, 9), "hex27"
    )
    rubber = Maxwell(1e6, [], [], K=2e9, density=1200.0)
    app = Application()
    app.add("pad", Solid(mesh, rubber, {"floor": "y-", "mass": "y+"}, 0.0))
    app.add("mass", RigidBody(10.0, (0.01, 0.01, 0.01)))
    app.connect("mass.centre", "pad.mass")
    app.ground("pad.floor")
    slide = math.sqrt(1e9 * 0.04**2 / (10.0 + 1600e-9 * 1200 / 3))  # a third of the pad's mass goes along
    twist = math.sqrt(1e9 * 0.04**4 / 6 / 0.01)
    exact = np.array([twist, slide, slide]) / (2 * math.pi)
    found = modes(app).frequency.values[:3]
    print("block on a shear pad, Hz:", np.round(found, 3), "by the formulae", np.round(exact, 3))
    np.testing.assert_allclose(
        found, exact, rtol=0.01
    )  # free edges: of the order t/a = 1/40, half of it in ω


def test_a_layered_foot_held_at_one_face_is_reduced_without_a_warning():
    """Rigid motion of one interface costs nothing, and a load on it needs no shape of its own."""
    mesh = box_mesh([0, 0.03, 0.06], [0, 0.01, 0.015, 0.025], [0, 0.02, 0.04])
    mesh = mesh.with_region("rubber", lambda p: (p[:, 1] > 0.01) & (p[:, 1] < 0.015))
    materials = {"body": STEEL, "rubber": RUBBER}
    outputs = {"sole": "y-", "top": "y+"}
    foot = Solid(mesh, materials, {"base": "y-"}, f_max=1e3, outputs=outputs, attach=("sole", "top"))
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        element = foot.superelement()
    x = np.zeros((element.n, 3))
    x[:3] = np.eye(3)
    # steel on rubber, 1:1e5: the static solution leaves 1e-11
    np.testing.assert_allclose(x.T @ element.M @ x / foot.mass, np.eye(3), atol=1e-9)
