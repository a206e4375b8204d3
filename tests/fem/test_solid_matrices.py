"""Solid elements, the block with a bore, the housing, and matrices from elsewhere."""

from __future__ import annotations

import math
import warnings

import numpy as np
import pytest
import scipy.io
import scipy.linalg
import scipy.sparse
import scipy.sparse.linalg
from scipy.optimize import brentq

from bearingdyn.fem import (
    FEMatrices,
    SolidMesh,
    assemble_elastic,
    assemble_solid,
    block_with_bore,
    box_mesh,
    check_matrices,
    factorise,
    lowest_modes,
    read_matrix_market,
    read_npz,
    rigid_body_inertia,
    rigid_body_residual,
    rigid_motion,
    rigid_transfer,
    write_npz,
)
from bearingdyn.fem.meshes.solid_element import BUBBLES, TET10, WEDGE15, points, shapes
from bearingdyn.fem.meshes.solid_mesh import second_order
from bearingdyn.fem.node_pairs import NodePairs
from bearingdyn.fem.solid_matrices import _with_bubble
from bearingdyn.material import STEEL, Elastic
from bearingdyn.notice import FoldedMesh
from bearingdyn.parts import Feet, Housing

pytest.importorskip("skfem")


SIZE = np.array([0.1, 0.2, 0.3])


def crooked(mesh):
    """The box with its inner corners shifted, so that no element is a box; edges stay straight."""
    corners = mesh.points[: mesh.elements[:, : len(mesh.kind.corners)].max() + 1].copy()
    inner = np.all((corners > 1e-9) & (corners < SIZE - 1e-9), axis=1)
    corners[inner] += 0.012 * np.sin(40.0 * corners[inner][:, [1, 2, 0]] + 1.0)
    p, elements, _ = second_order(corners, mesh.elements[:, : len(mesh.kind.corners)])
    moved = SolidMesh(p, elements, mesh.regions)
    return moved.with_centres() if mesh.kind.centres else moved


def crooked_bricks(element="hex20"):
    return crooked(box_mesh(*[np.linspace(0.0, s, 4) for s in SIZE], element))


def tetrahedra():
    """Each cell of a box in six tetrahedra about the diagonal."""
    box = box_mesh(*[np.linspace(0.0, s, 4) for s in SIZE])
    six = [(0, 1, 2, 6), (0, 2, 3, 6), (0, 3, 7, 6), (0, 7, 4, 6), (0, 4, 5, 6), (0, 5, 1, 6)]
    corners = np.vstack([box.elements[:, list(t)] for t in six])
    p, elements, _ = second_order(box.points[: corners.max() + 1], corners)
    return crooked(SolidMesh(p, elements))


WEDGES = [(0, 1, 2, 4, 5, 6), (0, 2, 3, 4, 6, 7)]  # each half of a brick
PYRAMIDS = [
    (0, 3, 2, 1),
    (4, 5, 6, 7),
    (0, 1, 5, 4),
    (1, 2, 6, 5),
    (2, 3, 7, 6),
    (3, 0, 4, 7),
]  # to its middle


def wedges():
    box = box_mesh(*[np.linspace(0.0, s, 4) for s in SIZE])
    corners = np.vstack([box.elements[:, list(t)] for t in WEDGES])
    p, elements, _ = second_order(box.points[: corners.max() + 1], corners)
    return crooked(SolidMesh(p, elements))


def mixed():
    """Bricks and wedges below, in the middle pyramids whose upper ones are tetrahedra, tetrahedra above."""
    x, y, z = (np.linspace(0.0, s, 4) for s in SIZE)
    box = box_mesh(x, y, z)
    n = 64
    points, rows = list(box.points[:n]), []
    for e in box.elements[:, :8].tolist():
        level = round(float(box.points[e].mean(axis=0)[2] / SIZE[2] * 3 - 0.5))
        if level == 0 and box.points[e].mean(axis=0)[0] < SIZE[0] / 3:
            rows.append(e)
        elif level == 0:  # their quadrilaterals above, under the pyramids
            rows += [[e[i] for i in t] for t in ((0, 5, 1, 3, 6, 2), (0, 4, 5, 3, 7, 6))]
        else:
            middle = len(points)
            points.append(box.points[e].mean(axis=0) + [0.002, -0.003, 0.004])
            for side, face in enumerate(PYRAMIDS):
                quad = [e[i] for i in face][::-1]
                if level == 1 and side != 1:
                    rows.append([*quad, middle])
                else:  # two tetrahedra, split at the lowest node, as the neighbour splits it
                    at = quad.index(min(quad))
                    a, b, c, d = quad[at:] + quad[:at]
                    rows += [[a, b, c, middle], [a, c, d, middle]]
    corners = np.full((len(rows), 8), -1)
    for i, row in enumerate(rows):
        corners[i, : len(row)] = row
    p, elements, _ = second_order(np.array(points), corners)
    return SolidMesh(p, elements)


MESHES = {
    "15-node wedges": (wedges, False),
    "15-node wedges with a bubble": (wedges, True),
    "bricks, wedges, pyramids and tetrahedra": (mixed, False),
    "bricks, wedges, pyramids and tetrahedra, cured": (mixed, True),
    "20-node bricks": (crooked_bricks, False),
    "20-node bricks, selective": (crooked_bricks, True),
    "27-node bricks": (lambda: crooked_bricks("hex27"), False),
    "27-node bricks with linear pressure": (lambda: crooked_bricks("hex27"), True),
    "10-node tetrahedra": (tetrahedra, False),
    "10-node tetrahedra with a bubble": (tetrahedra, True),
}


@pytest.mark.parametrize("name", MESHES)
def test_patch_of_solid_elements_carries_constant_stress(name):
    make, incompressible = MESHES[name]
    solid = assemble_solid(make(), incompressible=incompressible)
    p, K = solid.points, solid.stiffness(STEEL)
    grad = np.array([[1.0, 2.0, -1.0], [0.5, -1.0, 3.0], [2.0, 0.2, 0.7]]) * 1e-3
    u = (p @ grad.T).ravel()
    boundary = np.any((np.abs(p) < 1e-9) | (np.abs(p - SIZE) < 1e-9), axis=1)
    inner = np.repeat(~boundary, 3)
    # inner nodes are in balance; the rule integrates these elements exactly, so round-off only
    worst = np.abs((K @ u)[inner]).max() / np.abs(K @ u).max()
    strain = 0.5 * (grad + grad.T)
    lam = STEEL.K - 2 / 3 * STEEL.G
    energy = (0.5 * lam * np.trace(strain) ** 2 + STEEL.G * np.sum(strain**2)) * np.prod(SIZE)
    rigid = rigid_body_residual(K, rigid_motion(p))
    print(f"{name}: patch {worst:.1e}, energy {0.5 * u @ K @ u / energy - 1:.1e}, rigid motion {rigid:.1e}")
    assert worst < 1e-11
    assert 0.5 * u @ K @ u == pytest.approx(energy, rel=1e-11)
    assert rigid < 1e-13


@pytest.mark.parametrize("name", MESHES)
def test_volume_and_shape_change_are_kept_apart(name):
    make, incompressible = MESHES[name]
    solid = assemble_solid(make(), incompressible=incompressible)
    p, volume = solid.points, np.prod(SIZE)
    swelling, shear = p.ravel(), np.column_stack([p[:, 1], p[:, 0], 0 * p[:, 0]]).ravel()
    # div = 3 and e = 0; div = 0 and e:e = 2 (theory.md section 1: T1, T2)
    assert swelling @ solid.volumetric @ swelling == pytest.approx(9 * volume, rel=1e-11)
    assert abs(swelling @ solid.deviatoric @ swelling) < 1e-11 * volume
    assert abs(shear @ solid.volumetric @ shear) < 1e-11 * volume
    assert shear @ solid.deviatoric @ shear == pytest.approx(2 * volume, rel=1e-11)


@pytest.mark.parametrize(
    "split",
    [
        [(0, 3, 7, 1, 2, 6), (0, 7, 4, 1, 6, 5)],
        [(0, 5, 1, 3, 6, 2), (0, 4, 5, 3, 7, 6)],
        [(0, 1, 2, 4, 5, 6), (0, 2, 3, 4, 6, 7)],
    ],
    ids=["axis along the beam", "across", "upright"],
)
def test_wedges_of_steel_bend_as_a_beam(split):
    """F L³/3EI + 1.2 F L/GA (Timoshenko, ν = 0), two wedges through each side: 1 ‰, from below."""
    length, side, metal = 0.1, 0.01, Elastic(2.1e11, 0.0, 7850.0)
    box = box_mesh(*(np.linspace(0, s, n) for s, n in ((length, 11), (side, 3), (side, 3))))
    corners = np.vstack([box.elements[:, list(t)] for t in split])
    p, elements, _ = second_order(box.points[: corners.max() + 1], corners)
    mesh = SolidMesh(p, elements).with_surface("tip", lambda q: q[:, 0] > length - 1e-9)
    K = assemble_solid(mesh).stiffness(metal)
    f = np.asarray(mesh.samples("tip").mean_rows[1].todense()).ravel()
    free = np.flatnonzero(~np.repeat(p[:, 0] < 1e-9, 3))
    u = np.zeros(p.size)
    u[free] = factorise(K[free][:, free]).solve(f[free])
    theory = 4 * length**3 / (metal.E * side**4) + 1.2 * length / (metal.G * side**2)
    assert 0.999 < f @ u / theory < 1.0


def test_a_bubble_undoes_the_linear_part_of_the_change_of_volume():
    """Of a crooked element, and vanishes on its faces; broken, the nodes would carry div u by themselves."""
    for kind, mesh in ((WEDGE15, wedges()), (TET10, tetrahedra())):
        faces = np.vstack([kind.places[list(face)].mean(axis=0) for face in kind.faces])
        planes = np.array(BUBBLES[kind])
        value = np.prod(planes[:, 0] + np.vstack([faces, kind.places]) @ planes[:, 1:].T, axis=1)
        np.testing.assert_array_less(np.abs(value), 1e-15)
        p = mesh.points[mesh.elements[:5, : kind.nodes]]
        D, dV, follow = _with_bubble(kind, p)
        x = shapes(kind, points(kind, fine=True)[0])[0] @ p
        x -= (dV[:, None, :] @ x) / dV.sum(axis=1)[:, None, None]
        moments = np.einsum("miq,mqc,mq,mij->mjc", D, x, dV, follow)
        plain = np.einsum("miq,mqc,mq->mic", D[:, :-3], x, dV)
        assert np.abs(moments).max() < 1e-12 * np.abs(plain).max()


@pytest.mark.parametrize("missing", [False, True])
def test_pyramids_that_a_file_leaves_out_are_missed(missing):
    """As gmsh's .unv does: what is left meets in edges only, and would be too small without a word."""
    square = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)]
    cube = [(x, y, z) for z in (0.0, 1.0) for x, y in square]
    tip, above = [(0.5, 0.5, 1.5)], [(0.5, -0.5, 1.6), (1.5, 0.5, 1.6), (0.5, 1.5, 1.6), (-0.5, 0.5, 1.6)]
    sides = [(4, 5), (5, 6), (6, 7), (7, 4)]
    rows = [range(8), *[(a, b, 8, 9 + k) for k, (a, b) in enumerate(sides)]]
    rows += [] if missing else [(4, 5, 6, 7, 8)]
    corners = np.full((len(rows), 8), -1)
    for i, row in enumerate(rows):
        corners[i, : len(row)] = row
    p, elements, _ = second_order(np.vstack([cube, tip, above]), corners)
    if not missing:
        assert SolidMesh(p, elements).volume() > 1.0
        return
    with pytest.raises(ValueError, match=r"meet in 4 edges without a common face.*the pyramids .*missing"):
        SolidMesh(p, elements)


def test_an_element_folded_into_its_neighbour_is_warned_of():
    """Two tetrahedra on one side of the triangle they share; with one on each side, none."""
    corners = [[0, 1, 2, 3], [0, 1, 2, 4]]
    for height, folded in ((0.5, True), (-0.5, False)):
        p = np.array([(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1), (0.3, 0.3, height)], float)
        rows = corners if folded else [corners[0], [0, 2, 1, 4]]
        points, elements, _ = second_order(p, rows)
        with warnings.catch_warnings(record=True) as told:
            warnings.simplefilter("always")
            SolidMesh(points, elements)
        assert [w.category for w in told] == [FoldedMesh] * folded
        assert all("element 0 and its neighbours" in str(w.message) for w in told)


def test_regions_of_a_mesh_add_up():
    mesh = crooked_bricks()
    whole = assemble_solid(mesh)
    parts = [assemble_solid(mesh, e) for e in (np.arange(9), np.arange(9, len(mesh.elements)))]
    for name in ("mass", "volumetric", "deviatoric"):
        total = sum(getattr(part, name) for part in parts)
        assert abs(total - getattr(whole, name)).max() < 1e-12 * abs(getattr(whole, name)).max()


def block():
    return block_with_bore(0.12, 0.2, 0.03, 0.062, 0.13, 0.012)


def test_curved_brick_moves_rigidly_without_force_and_has_the_mass_of_the_block():
    solid = assemble_solid(block())
    R = rigid_motion(solid.points)
    assert rigid_body_residual(solid.stiffness(STEEL), R) < 1e-12
    m, hole = 0.12 * 0.2 * 0.03, math.pi * 0.031**2 * 0.03
    J = rigid_body_inertia(solid.mass, R)
    # block with its centre 0.03 below the axis, less the bore; 32 quadratic arcs are round to 1e-6
    np.testing.assert_allclose(np.diag(J)[:3], m - hole, rtol=1e-5)
    Iz = m * ((0.12**2 + 0.2**2) / 12 + 0.03**2) - hole * 0.031**2 / 2
    assert J[5, 5] == pytest.approx(Iz, rel=1e-5)
    assert J[0, 5] == pytest.approx(0.03 * m, rel=1e-5)  # ∫ -y dV


@pytest.mark.parametrize(
    ("flange", "strip", "extra"),
    [
        (None, None, 0.0),
        (None, 0.025, 0.0),
        ((0.03, 0.015), None, 2 * 0.03 * 0.015),
        ((0.03, 0.1), None, 2 * 0.003),
    ],
)
@pytest.mark.parametrize("bore_height", [0.1, 0.105, 0.13, 0.16])
def test_mesher_fills_the_drawing(flange, strip, extra, bore_height):
    mesh = block_with_bore(0.12, 0.2, 0.02, 0.06, bore_height, 0.013, flange, strip)
    solid = assemble_solid(mesh)
    volume = (0.12 * 0.2 - math.pi * 0.03**2 + extra) * 0.02
    one = np.tile([1.0, 0.0, 0.0], len(solid.points))
    assert one @ solid.mass @ one == pytest.approx(volume, rel=1e-5)  # the arcs, as above
    rho = np.hypot(*solid.points[:, :2].T)
    assert rho.min() > 0.03 * (1 - 1e-12)
    # the boundary, each face once: bore, base and outside; front and back are as large as the section
    areas = {name: mesh.samples(name).area for name in mesh.surfaces}
    whole = mesh.with_surface("all", lambda p: np.ones(len(p), dtype=bool)).samples("all").area
    assert areas["bore"] + areas["base"] + areas["outside"] == pytest.approx(whole, rel=1e-12)
    assert areas["front"] == pytest.approx(areas["back"], rel=1e-12)
    assert areas["front"] == pytest.approx(volume / 0.02, rel=1e-5)
    wide = flange[0] * 2 if flange else 0.0
    assert areas["base"] == pytest.approx((0.12 + wide) * 0.02)
    feet = wide if flange else 2 * strip if strip else 0.12
    assert areas["feet"] == pytest.approx(feet * 0.02)


def test_slender_block_of_bricks_vibrates_as_a_beam():
    # free bar 20 x 20 x 400 mm; Timoshenko, k = 5(1+ν)/(6+5ν) for a square: its own error is some 0.05 %
    lines = np.linspace(0, 0.02, 3)
    solid = assemble_solid(box_mesh(lines, lines, np.linspace(0, 0.4, 21)))
    M, K = STEEL.density * solid.mass, solid.stiffness(STEEL)
    f = lowest_modes(K + 1e3 * solid.mass * STEEL.density, M, n_modes=10)[0]
    f = np.sqrt(np.maximum((2 * math.pi * f) ** 2 - 1e3, 0.0)) / (2 * math.pi)
    EI, A = STEEL.E * 0.02**4 / 12, 0.02**2
    k = 5 * 1.3 / (6 + 1.5)

    def determinant(omega):  # zero at a frequency of the free Timoshenko beam
        a = STEEL.density * omega**2 / STEEL.E
        b = STEEL.density * omega**2 / (k * STEEL.G)
        c = STEEL.density * A * omega**2 / EI
        half = 0.5 * (a + b)
        root = math.sqrt(0.25 * (a - b) ** 2 + c)
        p, q = math.sqrt(root - half), math.sqrt(root + half)
        L = 0.4
        s, t = (p * p + b) / p, (q * q - b) / q
        # w = Σ of cosh pz, sinh pz, cos qz, sin qz; θ' = 0 and w' = θ at both ends
        rows = []
        for z in (0.0, L):
            ch, sh, co, si = math.cosh(p * z), math.sinh(p * z), math.cos(q * z), math.sin(q * z)
            rows.append([s * p * ch, s * p * sh, -t * q * co, -t * q * si])
            rows.append([(p - s) * sh, (p - s) * ch, (t - q) * si, (q - t) * co])
        return np.linalg.det(np.array(rows))

    euler = [22.3733, 61.6728]  # (βL)² of a free beam
    for i, beta in enumerate(euler):
        omega = beta / 0.4**2 * math.sqrt(EI / (STEEL.density * A))
        exact = brentq(determinant, 0.8 * omega, omega) / (2 * math.pi)
        found = f[6 + 2 * i : 8 + 2 * i] if i == 0 else f[f > 1.5 * f[6]][:2]
        np.testing.assert_allclose(found, exact, rtol=1e-3)


def housing(**change):
    given = {"width": 0.12, "height": 0.2, "length": 0.02, "bore_diameter": 0.062, "bore_height": 0.13}
    return Housing(**(given | change))


def grounded(s, name="feet"):
    free = [i for i in range(s.n) if i not in s.interfaces[name]]
    return s.K[np.ix_(free, free)], s.M[np.ix_(free, free)], free


def frequencies(K, M):
    return np.sqrt(np.abs(scipy.linalg.eigh(K, M, eigvals_only=True))) / (2.0 * math.pi)


def test_pedestal_has_its_own_modes_in_the_working_band_and_they_converge():
    coarse, fine = (housing(element_size=size, f_max=8e3).superelement() for size in (0.02, None))
    f, g = (frequencies(*grounded(s)[:2])[:4] for s in (coarse, fine))
    assert np.count_nonzero((g > 400) & (g < 6000)) >= 3
    # displacement elements are too stiff, by 1 % at 20 mm, rigid faces ending in singular corners
    np.testing.assert_allclose(f, g, rtol=1e-2)
    assert np.all(f > g)


def test_reduced_housing_matches_the_full_model():
    drawing = housing(element_size=0.016)
    s = drawing.superelement()
    solid = assemble_solid(block_with_bore(0.12, 0.2, 0.02, 0.062, 0.13, 0.016))
    p = solid.points
    K, M = solid.stiffness(STEEL), STEEL.density * solid.mass
    bore = np.abs(np.hypot(p[:, 0], p[:, 1]) - 0.031) < 1e-9
    feet = np.abs(p[:, 1] + 0.13) < 1e-9
    # the rigid bore as a constraint on the full model: u = T q on its nodes, the base held, the rest free
    other = np.flatnonzero(np.repeat(~bore & ~feet, 3))
    T = scipy.sparse.lil_matrix((3 * len(p), 6 + other.size))
    T[np.flatnonzero(np.repeat(bore, 3)), :6] = rigid_motion(p[bore])
    T[other, 6 + np.arange(other.size)] = 1.0
    T = T.tocsc()
    exact = lowest_modes(T.T @ K @ T, T.T @ M @ T, n_modes=5)[0]
    k, m, free = grounded(s)
    f = frequencies(k, m)[:5]
    below = exact < 5e3  # a quarter of f_max
    np.testing.assert_allclose(f[below], exact[below], rtol=1e-3)
    # static flexibility at the bore is exact: constraint modes; 1e-8 is a sparse solve's round-off
    unit = np.zeros(T.shape[1])
    unit[1] = 1.0
    exact_flexibility = scipy.sparse.linalg.spsolve((T.T @ K @ T).tocsc(), unit)[1]
    assert np.linalg.inv(k)[free.index(1), free.index(1)] == pytest.approx(exact_flexibility, rel=1e-8)


def test_reduced_housing_keeps_mass_and_moves_rigidly():
    s = housing(points={"side": (0.06, 0.0, 0.01)}, damping=0.01).superelement()
    R = np.zeros((s.n, 6))
    R[:12] = rigid_transfer([[0, 0, 0], [0, -0.13, 0]])
    m = 7850 * (0.12 * 0.2 - math.pi * 0.031**2) * 0.02
    np.testing.assert_allclose(np.diag(R.T @ s.M @ R)[:3], m, rtol=1e-5)  # the arcs of the bore
    assert np.abs(s.K @ R).max() < 1e-11 * np.abs(s.K).max()
    # rows follow a rigid motion of the named point: round-off of the static solve
    np.testing.assert_allclose(s.outputs["top"] @ R, rigid_motion([[0, 0.07, 0]]), atol=1e-8)
    np.testing.assert_allclose(s.outputs["side"] @ R, rigid_motion([[0.06, 0.0, 0.01]]), atol=1e-8)
    assert s.interfaces["bore"].tolist() == list(range(6))
    assert np.abs(s.G).max() == 0.0
    # and damping resists no rigid motion, though ζ is that of the housing held at its feet
    assert np.abs(s.C @ R).max() < 1e-9 * np.abs(s.C).max()


def test_tall_pedestal_sways_as_a_cantilever_with_a_hole_high_up():
    # a slim tall plate held at the base, with a small bore near its top: axial (z) sway of a cantilever
    s = housing(
        width=0.03, height=0.4, length=0.01, bore_diameter=0.01, bore_height=0.39, f_max=5e3
    ).superelement()
    f = frequencies(*grounded(s)[:2])[0]
    euler = 1.8751**2 / (2 * math.pi * 0.4**2) * math.sqrt(210e9 / 7850 * 0.01**2 / 12)
    # the bore takes .65 % of the mass at the tip, felt four-fold by a beam: f up 1.3 %; plate action < 1 %
    assert f == pytest.approx(euler, rel=0.03)


def test_flanged_and_narrow_feet_soften_the_stand():
    stiff, strips, flanged = (
        np.linalg.inv(grounded(housing(feet=feet, f_max=5e3).superelement())[0])[2, 2]
        for feet in (None, Feet(0.03), Feet(0.03, 0.012))
    )
    assert stiff < strips < flanged


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"width": -0.1}, "width is -0.1"),
        ({"height": math.nan}, "height is nan"),
        ({"length": math.inf}, "length is inf"),
        ({"bore_diameter": 0.0}, "bore_diameter is 0.0"),
        ({"bore_diameter": 0.12}, "bore_diameter is 0.12 m; it must leave a wall"),
        ({"bore_height": 0.18}, r"bore_height is 0.18 m; .* 0.03224 to 0.16776 m"),
        ({"bore_height": math.nan}, "bore_height is nan"),
        ({"damping": 1.0}, "damping is 1.0"),
        ({"f_max": -1.0}, "f_max is -1.0"),
        ({"element_size": 0.0}, "element_size is 0.0"),
        ({"element_size": 1e-4}, "element_size is 0.0001"),
        ({"feet": Feet(0.07)}, "feet.width is 0.07"),
        ({"feet": Feet(0.02, 0.3)}, "feet.height is 0.3"),
        ({"points": {"top": (0, 0, 0)}}, "'top', a name the housing uses"),
        ({"points": {"p": (0.0, 0.5, 0.0)}}, r"points\['p'\].*in the block"),
        ({"points": {"p": (0.0, 0.0, 0.0)}}, r"points\['p'\].*in the bore"),
        ({"points": {"p": (0.0, 0.0)}}, r"points\['p'\].*x, y and z"),
    ],
)
def test_housing_refuses(change, message):
    with pytest.raises(ValueError, match=message):
        housing(**change)


@pytest.mark.parametrize(
    ("width", "height", "message"), [(0.0, 0.0, "width is 0.0"), (0.1, math.nan, "height is nan")]
)
def test_feet_refuse(width, height, message):
    with pytest.raises(ValueError, match=message):
        Feet(width, height)


@pytest.fixture(scope="module")
def model():
    solid = assemble_solid(box_mesh(*[np.linspace(0, 0.1, 3)] * 3))
    return FEMatrices(M=STEEL.density * solid.mass, K=solid.stiffness(STEEL), points=solid.points)


def test_matrices_survive_npz_and_matrix_market(model, tmp_path):
    write_npz(tmp_path / "m.npz", model)
    read = read_npz(tmp_path / "m.npz")
    np.savez(tmp_path / "dense.npz", K=model.K.toarray(), M=model.M.toarray())
    dense = read_npz(tmp_path / "dense.npz")
    scipy.io.mmwrite(tmp_path / "K.mtx", model.K, symmetry="symmetric", precision=17)
    scipy.io.mmwrite(tmp_path / "M.mtx", model.M, symmetry="symmetric", precision=17)
    text = read_matrix_market(tmp_path / "K.mtx", tmp_path / "M.mtx", model.points)
    for other in (read, dense, text):
        assert abs(other.K - model.K).max() <= 1e-15 * abs(model.K).max()  # 17 digits carry a double exactly
        assert abs(other.M - model.M).max() <= 1e-15 * abs(model.M).max()
    assert np.array_equal(read.points, model.points)
    assert dense.points is None


def test_matrices_from_elsewhere_that_are_wrong_are_refused(model, tmp_path):
    K, M, p = model.K, model.M, model.points
    bad = K.copy().tolil()
    bad[0, 1] += K.max()
    nan = K.copy()
    nan.data = nan.data.copy()
    nan.data[3] = np.nan
    for args, message in (
        ((K[:6], M), r"K has shape \(6, 243\); it must be square"),
        ((K[:6, :6], M), r"K has shape \(6, 6\) and M \(243, 243\)"),
        ((bad, M), "K is not symmetric"),
        ((scipy.sparse.tril(K), M), "K is not symmetric .*triangle"),
        ((nan, M), "K has an entry that is not finite"),
        ((K, -M), "M has a negative diagonal"),
        ((K, 0 * M), "M is zero everywhere"),
        ((K * 1j, M), "K is complex"),
        ((K, M, p[:5]), r"points has shape \(5, 3\)"),
        ((K + 1e6 * scipy.sparse.eye(243), M, p), "K resists rigid motion"),
        ((K, M, p[::-1]), "K resists rigid motion"),
    ):
        with pytest.raises(ValueError, match=message):
            check_matrices(*args)
    (tmp_path / "text.npz").write_text("not an archive")
    (tmp_path / "text.mtx").write_text("1 2 3\n")
    np.savez(tmp_path / "half.npz", K=K.toarray())
    np.savez(tmp_path / "object.npz", K=np.array([{}], dtype=object), M=M.toarray())
    for read, message in (
        (lambda: read_npz(tmp_path / "text.npz"), "text.npz cannot be read"),
        (lambda: read_npz(tmp_path / "half.npz"), "half.npz has no M"),
        (lambda: read_npz(tmp_path / "object.npz"), "object.npz cannot be read"),
        (
            lambda: read_matrix_market(tmp_path / "text.mtx", tmp_path / "text.mtx"),
            "text.mtx, line 1 is '1 2 3'",
        ),
    ):
        with pytest.raises(ValueError, match=message):
            read()


@pytest.mark.parametrize(("element", "soft"), [("hex20", False), ("hex20", True), ("hex27", True)])
def test_stiffness_of_a_material_at_once_is_that_of_its_parts(element, soft):
    lines = [np.linspace(0, 1, 3), np.linspace(0, 0.7, 3), np.linspace(0, 0.4, 4)]
    mesh = box_mesh(*lines, element=element)
    parts = assemble_solid(mesh, incompressible=soft)
    mass, stiffness = assemble_elastic(mesh, None, STEEL, incompressible=soft)
    expected = parts.stiffness(STEEL)
    # round-off of sums of some ten terms
    assert abs(stiffness - expected).max() <= 1e-14 * abs(expected).max()
    assert abs(mass - STEEL.density * parts.mass).max() == 0.0


def test_meshes_of_one_topology_share_their_pattern_and_others_do_not():
    def pairs(elements):
        return NodePairs.of([elements], int(elements.max()) + 1)

    mesh = box_mesh(*[np.linspace(0, 1, 3)] * 3)
    longer = box_mesh(np.linspace(0, 1, 3), np.linspace(0, 1, 3), np.linspace(0, 2, 3))
    assert pairs(mesh.elements) is pairs(longer.elements)
    # as many elements and nodes, joined otherwise
    turned = mesh.elements[:, ::-1].copy()
    turned[0] = np.roll(turned[0], 1)
    other = (turned + 1) % (turned.max() + 1)
    fresh = pairs(other)
    assert fresh is not pairs(mesh.elements)
    K = assemble_solid(longer).stiffness(STEEL)
    K0 = assemble_solid(mesh).stiffness(STEEL)
    again = assemble_solid(longer).stiffness(STEEL)
    assert (K != again).nnz == 0  # what is kept is not written into
    assert abs(K - K0).max() > 0.1 * abs(K).max()


def test_a_matrix_that_is_changed_in_place_changes_no_other():
    """Patterns are kept: zeros eliminated from one matrix once moved the entries of all others."""
    mesh = box_mesh(*[np.linspace(0, 1, 3)] * 3)
    parts = assemble_solid(mesh)
    for made in (lambda: assemble_elastic(mesh, None, STEEL)[1], lambda: parts.stiffness(STEEL)):
        before, spoilt = parts.volumetric.copy(), made()
        spoilt.data[::3] = 0.0
        spoilt.eliminate_zeros()
        assert abs(parts.volumetric - before).max() == 0.0
        assert abs(assemble_solid(mesh).volumetric - before).max() == 0.0
