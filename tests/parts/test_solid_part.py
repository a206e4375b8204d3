"""The solid part: its full and reduced matrices, surfaces and outputs, and what it refuses."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np
import pytest

from bearingdyn.cms import basis_of, reduce, reduction_error
from bearingdyn.fem import (
    SolidMesh,
    assemble_solid,
    block_with_bore,
    box_mesh,
    crowded,
    rigid_motion,
    rigid_transfer,
    ring_mesh,
)
from bearingdyn.material import STEEL, Maxwell
from bearingdyn.parts import Housing, RigidSurface, Solid

pytest.importorskip("skfem")

MM = 1e-3
RUBBER = Maxwell(1e6, [3e6], [1e-4], K=2e9, density=1200.0)
AXES = {"inner": RigidSurface("inner", "axis"), "outer": RigidSurface("outer", "axis")}


def strip_of_rubber(**change):
    """A pad of rubber between two metal plates, bonded; outer faces rigid."""
    mesh = box_mesh(
        crowded(0, 20 * MM, 6), np.array([0.0, 2.0, 3.0, 4.0, 5.0, 7.0]) * MM, crowded(0, 10 * MM, 4), "hex27"
    ).with_region("rubber", lambda p: (p[:, 1] > 2 * MM) & (p[:, 1] < 5 * MM))
    given = {
        "mesh": mesh,
        "materials": {"body": STEEL, "rubber": RUBBER},
        "interfaces": {"below": "y-", "above": "y+"},
        "f_max": 0.0,
        "outputs": {"side": "x+", "corner": (0.02, 0.0035, 0.01)},
    }
    return Solid(**(given | change))


def condensed(s, omega):
    K = s.stiffness(omega)
    b = np.concatenate(list(s.interfaces.values()))
    i = np.setdiff1d(np.arange(s.n), b)
    return K[np.ix_(b, b)] - K[np.ix_(b, i)] @ np.linalg.solve(K[np.ix_(i, i)], K[np.ix_(i, b)])


def test_reduced_rubber_pad_is_exact_at_its_moduli_and_close_between_them():
    solid = strip_of_rubber()
    s, paper = solid.superelement(), strip_of_rubber(moduli=(1e6,), inertia=0).superelement()
    assert s.n > paper.n == 12  # shapes of a second modulus
    for omega, tolerance in (
        (0.0, 1e-8),  # the first modulus: a congruence of the sparse solution, to its round-off
        (2e3, 1e-4),  # between two moduli 1 : 4, as for bodies of revolution
        (1e4, 1e-4),
    ):
        exact, reduced = solid.stiffness(omega), condensed(s, omega)
        error = np.linalg.norm(reduced - exact) / np.linalg.norm(exact)
        one = np.linalg.norm(condensed(paper, omega) - exact) / np.linalg.norm(exact)
        print(f"reduced against full at {omega} rad/s: {error:.1e}; shapes at one modulus: {one:.1e}")
        assert error < tolerance
        assert omega == 0.0 or error < 1e-2 * one


def test_dynamic_stiffness_of_a_reduced_pad_is_that_of_the_full_one():
    f = np.array([1000.0, 5000.0])
    errors = {}
    for inertia in (0, 1):
        solid = strip_of_rubber(inertia=inertia)
        errors[inertia] = reduction_error(solid.full_model(), solid.basis(), f, exact=True).worst
    print("reduced pad to 5 kHz, without and with shapes of inertia:", errors)
    # one round of inertia at each modulus; asked of a reduction: 1 % up to 5 kHz
    assert errors[1] < 1e-3 < 0.01 < errors[0]


def test_pad_keeps_mass_and_moves_rigidly_without_force():
    solid = strip_of_rubber(f_max=3e3, damping=0.01)
    s = solid.superelement()
    at = [rigid.position for rigid in solid.full_model().interfaces.values()]
    R = np.zeros((s.n, 6))
    R[:12] = rigid_transfer(at)
    mass = 20 * 10 * (4 * 7850 + 3 * 1200) * 1e-9
    assert solid.mass == pytest.approx(mass, rel=1e-12)
    np.testing.assert_allclose(np.diag(R.T @ s.M @ R)[:3], mass, rtol=1e-9)
    for A in (s.K, s.C, s.viscoelastic[0].H):
        assert np.abs(A @ R).max() < 1e-9 * np.abs(A).max()
    # rows follow rigid motion: of the node, and of the middle of the face on average
    np.testing.assert_allclose(s.outputs["corner"] @ R, rigid_motion([[0.02, 0.0035, 0.01]]), atol=1e-8)
    np.testing.assert_allclose(s.outputs["side"] @ R, rigid_motion([[0.02, 0.0035, 0.005]]), atol=1e-8)
    # the damping ratio is of the metal's stiffness alone
    metal = assemble_solid(solid.mesh, solid.mesh.regions["body"]).stiffness(STEEL)
    assert abs(solid.full_model().E - metal).max() < 1e-12 * abs(metal).max()


def test_each_viscoelastic_material_has_one_matrix_of_all_its_regions():
    mesh = ring_mesh((20.0, 21.0, 22.0, 23.0), 8.0, across=1, along=2, around=8, regions=("a", "b", "c"))
    other = Maxwell(2e6, [], [], K=2e9, density=1000.0)
    model = Solid(mesh, {"a": RUBBER, "b": other, "c": RUBBER}, AXES, 0.0).full_model()
    assert [part.material for part in model.viscoelastic] == [RUBBER, other]
    H = {n: assemble_solid(mesh, at, incompressible=True).deviatoric for n, at in mesh.regions.items()}
    for part, expected in zip(model.viscoelastic, (H["a"] + H["c"], H["b"]), strict=True):
        assert abs(part.H - expected).max() < 1e-12 * abs(expected).max()


def test_full_model_and_its_reduction_are_the_part():
    solid = strip_of_rubber(f_max=3e3)
    s, r = solid.superelement(), reduce(solid.full_model(), f_max=3e3)
    for a, b in ((s.M, r.M), (s.K, r.K), (s.viscoelastic[0].H, r.viscoelastic[0].H)):
        np.testing.assert_allclose(a, b, atol=1e-12 * np.abs(a).max())


def test_surface_samples_measure_area_normals_and_velocity():
    mesh = block_with_bore(0.12, 0.2, 0.03, 0.062, 0.13, 0.02)
    bore = mesh.samples("bore")
    # quadratic arcs on a circle: in area to the fourth order
    assert bore.area == pytest.approx(math.pi * 0.062 * 0.03, rel=1e-4)
    np.testing.assert_allclose(bore.centroid, 0.0, atol=1e-12)
    inward = -bore.positions * [1, 1, 0] / np.hypot(*bore.positions[:, :2].T)[:, None]
    np.testing.assert_allclose(bore.normals, inward, atol=0.02)  # out of the material, to the arc's slope
    assert (bore.weights > 0).all()
    # divergence theorem over the whole boundary: ∮ n dA = 0 and ∮ x·n dA = 3 V
    skin = mesh.with_surface("skin", lambda p: np.ones(len(p), dtype=bool)).samples("skin")
    np.testing.assert_allclose(skin.weights @ skin.normals, 0.0, atol=1e-15)
    flux = skin.weights @ np.sum(skin.positions * skin.normals, axis=1)
    assert flux == pytest.approx(3 * mesh.volume(), rel=1e-12)
    # the mean over the side about the bore, its elements large and small, is that of its centroid
    side = mesh.samples("front")
    np.testing.assert_allclose(
        side.mean_rows @ rigid_motion(mesh.points), rigid_motion(side.centroid), atol=1e-14
    )
    # a turn about z sweeps no volume, and moves the side faces by n·(θ × x)
    turn = rigid_motion(mesh.points)[:, 5]
    assert skin.weights @ (skin.normal_rows @ turn) == pytest.approx(0.0, abs=1e-15)


def test_normal_motion_of_a_surface_follows_the_interfaces():
    solid = strip_of_rubber()
    samples, rows = solid.surface("x+")
    R = np.zeros((rows.shape[1], 6))
    R[:12] = rigid_transfer([rigid.position for rigid in solid.full_model().interfaces.values()])
    np.testing.assert_allclose(rows @ R[:, 0], 1.0, rtol=1e-9)
    np.testing.assert_allclose(rows @ R[:, 2], 0.0, atol=1e-9)
    np.testing.assert_allclose(rows @ R[:, 5], -samples.positions[:, 1], atol=1e-9)
    assert samples.area == pytest.approx(10 * 7 * 1e-6)


def test_reference_point_is_where_it_is_asked_for():
    mesh = ring_mesh((20 * MM, 22 * MM), 10 * MM, (0.0, math.pi / 2), across=1, along=2, around=6)
    place = {
        "centroid": np.array([40 / math.pi, 40 / math.pi, 0.0]) * MM,  # of a quarter arc: 2 r/π
        "axis": np.zeros(3),
        (0.01, 0.0, 0.0): np.array([0.01, 0.0, 0.0]),
    }
    for reference, where in place.items():
        solid = Solid(mesh, STEEL, {"inner": RigidSurface("inner", reference)}, 0.0)
        np.testing.assert_allclose(solid.full_model().interfaces["inner"].position, where, atol=1e-7)
    both = Solid(mesh, STEEL, {"ends": RigidSurface(("start", "end"))}, 0.0).full_model().interfaces["ends"]
    np.testing.assert_allclose(both.position, [10.5 * MM, 10.5 * MM, 0.0], atol=1e-9)


@dataclass(frozen=True)
class Lossy:
    """A material without relaxation times."""

    G: float
    K: float = 2e9
    density: float = 1000.0

    def complex_modulus(self, omega):
        return self.G * (1 + 0.1j) + 0 * np.asarray(omega)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"f_max": -1.0}, "f_max is -1.0"),
        ({"f_max": math.nan}, "f_max is nan"),
        ({"damping": 1.0}, "damping is 1.0"),
        ({"inertia": -1}, "inertia is -1"),
        ({"moduli": (0.0,)}, r"moduli is \(0.0,\)"),
        ({"materials": {"body": STEEL}}, r"materials are of \['body'\]; the mesh has .*'rubber'"),
        ({"materials": {"body": STEEL, "rubber": 3.0}}, r"materials\['rubber'\] is 3.0"),
        ({"interfaces": {}}, "interfaces is empty"),
        ({"interfaces": {"below": "bottom"}}, r"interfaces\['below'\].*no surface 'bottom'; there are"),
        ({"interfaces": {"below": "y-", "side": "x-"}}, r"'below' and 'side' share the node at \(0, 0"),
        ({"held": "feet"}, r"held is 'feet'; the interfaces are \['above', 'below'\]"),
        ({"outputs": {"below": (0.0, 0.0, 0.0)}}, "outputs has 'below', the name of an interface"),
        ({"outputs": {"p": (0.1, 0.0, 0.0)}}, r"outputs\['p'\].*0.08 m away from the nearest node"),
        ({"outputs": {"p": (math.nan, 0.0, 0.0)}}, r"outputs\['p'\].*must be \(x, y, z\)"),
        ({"outputs": {"p": "lid"}}, r"outputs\['p'\]: the mesh has no surface 'lid'"),
        ({"attach": ("tip",)}, "attach has 'tip'"),
    ],
)
def test_solid_refuses(change, message):
    with pytest.raises(ValueError, match=message):
        strip_of_rubber(**change)


def test_solid_refuses_what_is_found_later():
    mesh = box_mesh([0.0, 0.1], [0.0, 0.1], [0.0, 0.1])
    edge = SolidMesh(
        mesh.points, mesh.elements, {}, {"edge": np.flatnonzero(mesh.points[:, :2].max(axis=1) == 0)}
    )
    with pytest.raises(ValueError, match=r"interfaces\['a'\] is a point or a line"):
        Solid(edge, STEEL, {"a": "edge"}, 0.0)
    with pytest.raises(ValueError, match="reference is 'middle'"):
        RigidSurface("x-", "middle")
    fluid = Maxwell(0.0, [1e6], [1e-3], K=2e9, density=1000.0)
    with pytest.raises(ValueError, match="no stiffness in shear"):
        strip_of_rubber(materials={"body": STEEL, "rubber": fluid}).stiffness(0.0)
    with pytest.raises(ValueError, match="moduli must be given"):
        strip_of_rubber(materials={"body": STEEL, "rubber": Lossy(0.0)}).superelement()
    assert strip_of_rubber(materials={"body": STEEL, "rubber": Lossy(1e6)}).superelement().n >= 12


def test_the_default_elements_of_a_housing_give_the_bore_its_stiffness() -> None:
    """Radially, against twice as many elements: 0.14 % were measured, 0.5 % with half as many."""
    housing = Housing(0.1, 0.1, 0.06, 0.05)
    volume = (0.1 * 0.1 - 0.25 * math.pi * 0.05**2) * 0.06
    finer = replace(housing, element_size=(volume / 800) ** (1 / 3))
    default, fine = (basis_of(h.body.full_model(), n_modes=0, inertia=0).K[0, 0] for h in (housing, finer))
    assert default == pytest.approx(fine, rel=3e-3)
