"""Sections that are brought as meshes of quadrilaterals: exact fields, convergence, faces, bad meshes."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest

from bearingdyn.fem import Rectangle, RevolutionMesh, assemble_harmonic, revolution_mesh
from bearingdyn.material import STEEL, Elastic
from bearingdyn.parts import (
    Cylinder,
    EndFace,
    Layer,
    Line,
    MeshNodes,
    Patch,
    Region,
    Revolved,
    Where,
    quadrilaterals,
)
from verified.row import as_printed, unit_rubber

MM = 1e-3
Arrays = tuple[np.ndarray, np.ndarray]
CORNERS = [0, 6, 8, 2]  # of an element of RevolutionMesh, in turn
NINE = [0, 6, 8, 2, 3, 7, 5, 1, 4]


def grid(r: np.ndarray, z: np.ndarray) -> Arrays:
    """Points and 4-node cells of a grid."""
    points = np.stack(np.meshgrid(r, z, indexing="ij"), axis=-1).reshape(-1, 2)
    i, j = np.meshgrid(np.arange(r.size - 1), np.arange(z.size - 1), indexing="ij")
    first = (i * z.size + j).ravel()
    return points, np.stack([first, first + z.size, first + z.size + 1, first + 1], axis=-1)


def shaken(points: np.ndarray, step: float, seed: int = 0) -> np.ndarray:
    """Inner points of a rectangle moved about at random, up to `step` in each direction."""
    low, high = points.min(axis=0), points.max(axis=0)
    inside = ((points > low + 1e-9) & (points < high - 1e-9)).all(axis=1)
    moves = np.random.default_rng(seed).uniform(-step, step, points.shape)
    return points + inside[:, None] * moves


def curved(mesh: RevolutionMesh, seed: int = 0) -> RevolutionMesh:
    """The same elements with inner nodes moved, middles of sides too: sides become parabolas."""
    points = shaken(np.stack([mesh.r, mesh.z], axis=-1), 0.015, seed)
    return quadrilaterals(points, mesh.elements[:, NINE], mesh.region)


POINTS, CELLS = grid(np.linspace(0.5, 2, 5), np.linspace(0, 1, 5))
DISTORTED = quadrilaterals(shaken(POINTS, 0.06), CELLS)


@pytest.mark.parametrize("mesh", [DISTORTED, curved(DISTORTED)], ids=["straight", "curved"])
@pytest.mark.parametrize("bulk", [1.0, 1e4])
def test_patch_of_uniform_strain_is_in_equilibrium_on_distorted_elements(
    mesh: RevolutionMesh, bulk: float
) -> None:
    r, z = mesh.r, mesh.z
    edge = np.isin(np.arange(r.size), mesh.outline)
    volume = math.pi * (4 - 0.25)
    zero = np.zeros_like(r)
    # Uniform Cartesian strains of order n: (n, U, V, W, trace, e:e).
    cases = [
        (0, r, zero, zero, 2.0, 2 - 4 / 3),
        (0, zero, zero, z, 1.0, 2 / 3),
        (1, z, -z, r, 0.0, 2.0),
        (2, r, -r, zero, 0.0, 2.0),
    ]
    for n, U, V, W, trace, ee in cases:
        K = assemble_harmonic(mesh, n).stiffness([bulk], [1.0])
        u = np.stack([U, V, W], axis=1).ravel()
        force = (K @ u).reshape(-1, 3)
        # 1e-11: round-off; the 3×3 rule integrates these fields exactly, on parabolic sides too
        assert np.abs(force[~edge]).max() < 1e-11 * (abs(K) @ np.abs(u)).max()
        # 1e-10: at bulk 1e4 the energy of a shear is the rest of a cancellation
        assert u @ (K @ u) == pytest.approx(volume * (bulk * trace**2 + 2 * ee), rel=1e-10)


def test_dilatation_linear_in_r_and_z_is_kept_whole_by_the_pressure_of_distorted_elements() -> None:
    """U = r z, ε_kk = 2 z and U = 0, W = r z, ε_kk = r: biquadratic in ξ, η, for sides are straight.

    Pressures linear in ξ and η would lose part of it, and their convergence.
    """
    h = assemble_harmonic(DISTORTED, 0, (0, 2))
    K = h.stiffness([1.0], [0.0])
    r, z = DISTORTED.r, DISTORTED.z
    for U, W, exact in (
        (r * z, 0 * r, 4 * math.pi * (4 - 0.25) / 3),  # ∫(2z)² dV
        (0 * r, r * z, 2 * math.pi * (16 - 0.5**4) / 4),  # ∫r² dV
    ):
        u = np.stack([U, W], axis=1).ravel()
        assert u @ (K @ u) == pytest.approx(exact, rel=1e-12)  # Gauss's rule is exact, round-off


@pytest.mark.parametrize("mesh", [DISTORTED, curved(DISTORTED)], ids=["straight", "curved"])
def test_rigid_motion_costs_nothing_on_distorted_elements(mesh: RevolutionMesh) -> None:
    for n, components in ((0, (0, 2)), (0, (1,)), (1, (0, 1, 2))):
        h = assemble_harmonic(mesh, n, components)
        R = h.rigid_shapes(np.arange(mesh.r.size), 0.7)
        K, M = h.stiffness([3.0], [1.0]), h.mass_matrix([2.0])
        # 1e-12: round-off of a sum over 1e3 entries
        assert np.abs(K @ R).max() <= 1e-12 * (abs(K) @ np.abs(R)).max()
        if components != (1,):
            translation = R[:, 0]
            # ∫dV is exact on straight and parabolic sides
            assert translation @ (M @ translation) == pytest.approx(2 * math.pi * (4 - 0.25), rel=1e-12)


def section(count: int, shake: float, nodes: int) -> RevolutionMesh:
    """The 17.5/20×11 layer of theory.md §3.7, lines crowded to the free edges, inner points shaken."""
    t = np.linspace(-1, 1, 3 * count + 1)
    z = 5.5 * np.sin(0.5 * np.pi * np.sin(0.5 * np.pi * t))
    r = 18.75 + 1.25 * np.sin(0.5 * np.pi * np.linspace(-1, 1, count + 1))
    points, cells = grid(r, z)
    # inner points move by a share of the nearest spacing in r and in z
    spacing = np.zeros((r.size, z.size, 2))
    spacing[1:-1, :, 0] = np.minimum(np.diff(r)[1:], np.diff(r)[:-1])[:, None]
    spacing[:, 1:-1, 1] = np.minimum(np.diff(z)[1:], np.diff(z)[:-1])
    spacing[[0, -1]] = spacing[:, [0, -1]] = 0.0
    moved = points + shake * spacing.reshape(-1, 2) * np.random.default_rng(1).uniform(-1, 1, points.shape)
    mesh = quadrilaterals(moved * MM, cells)
    if nodes == 4:
        return mesh
    order = NINE[:nodes]
    keep, index = np.unique(mesh.elements[:, order], return_inverse=True)
    return quadrilaterals(np.stack([mesh.r, mesh.z], -1)[keep], index.reshape(-1, nodes), mesh.region)


@pytest.mark.parametrize("nodes", [4, 8, 9])
def test_a_distorted_mesh_gives_the_bonded_layer_its_stiffness(nodes: int) -> None:
    rubber = unit_rubber(0.499)
    faces = {"inner": Cylinder(17.5 * MM), "outer": Cylinder(20.0 * MM)}
    # theory.md §3.7, axial, radial, tilt
    expected = np.array([490.43, 5708.0, 109280.0])
    errors = []
    for count in (6, 12):
        body = Revolved((Patch(rubber),), faces, section=section(count, 0.2, nodes))
        K = np.diag(as_printed(body.stiffness()))[[2, 0, 3]]
        errors.append(np.abs(K / expected - 1).max())
    # the 0.1 %; and finer is better
    assert errors[1] < 1e-3
    assert errors[1] < 0.5 * errors[0]


def test_the_same_elements_give_the_same_numbers_by_either_way() -> None:
    metal = Elastic(1e9, 0.3, 2000.0)
    rectangles = Revolved(
        (Region((1.0, 2.0), (0.0, 1.0), STEEL), Region((2.0, 2.5), (0.0, 1.0), metal)),
        {"bore": Cylinder(1.0)},
        outputs={"p": (2.25, 0.4, 0.3)},
    )
    mesh = rectangles.mesh
    for turn in (NINE, [0, 2, 8, 6, 1, 5, 7, 3, 4]):  # counter-clockwise and clockwise
        brought = quadrilaterals(np.stack([mesh.r, mesh.z], -1), mesh.elements[:, turn], mesh.region)
        body = Revolved(
            (Patch(STEEL), Patch(metal)),
            {"bore": Where(lambda r, z: r < 1.0 + 1e-9)},
            outputs={"p": (2.25, 0.4, 0.3)},
            section=brought,
        )
        one, other = rectangles.superelement(), body.superelement()
        np.testing.assert_allclose(other.M, one.M, rtol=0, atol=1e-12 * np.abs(one.M).max())
        np.testing.assert_allclose(other.outputs["p"], one.outputs["p"], rtol=0, atol=1e-9)
        assert body.mass == pytest.approx(rectangles.mass, rel=1e-12)
        np.testing.assert_allclose(body.modes(2, 2).frequency, rectangles.modes(2, 2).frequency, rtol=1e-9)


@pytest.mark.parametrize("kind", ["quad", "quad8", "quad9"])
def test_a_mesh_file_becomes_a_section(kind: str, tmp_path: Path) -> None:
    meshio = pytest.importorskip("meshio")
    count = {"quad": 4, "quad8": 8, "quad9": 9}[kind]
    order = NINE[:count]
    used, index = np.unique(DISTORTED.elements[:, order], return_inverse=True)
    flat = np.stack([DISTORTED.r, DISTORTED.z, 0 * DISTORTED.r], axis=-1)[used]
    cells = index.reshape(-1, count)
    region = (np.arange(len(cells)) % 2).astype(np.int32)
    path = tmp_path / "section.vtu"
    meshio.Mesh(flat, [(kind, cells)], cell_data={"region": [region]}).write(path)
    read = meshio.read(path)
    mesh = quadrilaterals(read.points, read.cells_dict[kind], read.cell_data["region"][0])
    body = Revolved((Patch(STEEL), Patch(STEEL)), section=mesh)
    assert body.mass == pytest.approx(STEEL.density * math.pi * (4 - 0.25), rel=1e-12)


def test_a_cone_and_a_set_of_nodes_are_faces() -> None:
    """A hollow frustum: mass, and the face found by a line, by a rule and by numbers is one face."""
    points, cells = grid(np.linspace(0, 1, 4), np.linspace(0, 30 * MM, 7))
    z = points[:, 1]
    inner, outer = 10 * MM + 0.2 * z, 16 * MM + 0.1 * z
    points[:, 0] = inner + points[:, 0] * (outer - inner)
    mesh = quadrilaterals(points, cells)
    a = 30 * MM
    volume = math.pi * (
        (16 * MM) ** 2 * a
        + 16 * MM * 0.1 * a**2
        + 0.01 * a**3 / 3
        - ((10 * MM) ** 2 * a + 10 * MM * 0.2 * a**2 + 0.04 * a**3 / 3)
    )
    along = np.flatnonzero(np.abs(points[:, 0] - inner) < 1e-12)
    faces = {
        "line": Line((10 * MM, 0.0), (16 * MM, 30 * MM)),
        "rule": Where(lambda r, z: np.abs(r - 10 * MM - 0.2 * z) < 1e-9),
        "numbers": MeshNodes(tuple(along)),
    }
    elements = []
    for face in faces.values():
        body = Revolved((Patch(STEEL),), {"bore": face}, section=mesh)
        assert body.mass == pytest.approx(STEEL.density * volume, rel=1e-12)  # straight sides: exact
        elements.append(body.superelement())
        assert body._boundaries.faces["bore"].reference == pytest.approx(15 * MM)
    for element in elements[1:]:
        np.testing.assert_array_equal(element.M, elements[0].M)
    assert elements[0].M[1, 1] == pytest.approx(STEEL.density * volume, rel=1e-9)


def test_a_point_is_found_in_a_curved_element() -> None:
    mesh = curved(DISTORTED, 3)
    rng = np.random.default_rng(0)
    for _ in range(20):
        r, z = rng.uniform(0.5, 2.0), rng.uniform(0.0, 1.0)
        h = assemble_harmonic(mesh, 0, (0, 2))
        u = np.stack([mesh.r, mesh.z], axis=1).reshape(-1, 1)  # each node's own place
        rows = h.point_rows(r, z, 0.0, u)
        # to Newton's last step
        np.testing.assert_allclose(rows[[0, 2], 0], [r, z], atol=1e-9)
    with pytest.raises(ValueError, match="outside"):
        mesh.locate(2.2, 0.5)


def test_a_bad_mesh_is_named() -> None:
    points, cells = grid(np.linspace(1, 2, 3), np.linspace(0, 1, 3))
    assert quadrilaterals(points, cells).r.size == 25
    assert quadrilaterals(np.c_[points, np.zeros(9)], cells).r.size == 25
    inverted = cells.copy()
    inverted[2] = inverted[2][[0, 3, 2, 1]]
    with pytest.raises(ValueError, match=r"cells\[2\].*inverted"):
        quadrilaterals(points, inverted)
    folded = points.copy()
    folded[4] = [2.2, 1.2]
    with pytest.raises(ValueError, match="inverted"):
        quadrilaterals(folded, cells)
    with pytest.raises(ValueError, match=r"points\[9\].*no element"):
        quadrilaterals(np.vstack([points, [[1.5, 0.5]]]), cells)
    apart = np.vstack([points, points + [1.0, 0.0]])
    with pytest.raises(ValueError, match="2 pieces"):
        quadrilaterals(apart, np.vstack([cells, cells + 9]))
    slit = cells.copy()
    slit[1][slit[1] == 4] = 9
    with pytest.raises(ValueError, match="coincide"):
        quadrilaterals(np.vstack([points, points[4:5]]), slit)
    with pytest.raises(ValueError, match="negative"):
        quadrilaterals(points - [1.5, 0.0], cells)
    with pytest.raises(ValueError, match="third"):
        quadrilaterals(np.c_[points, np.ones(9)], cells)
    for bad, name in (
        (cells[:, :3], "cells"),
        (cells + 7, "cells"),
        (cells[:0], "cells"),
        (cells * 1.0, "cells"),
    ):
        with pytest.raises(ValueError, match=name):
            quadrilaterals(points, bad)
    with pytest.raises(ValueError, match="region"):
        quadrilaterals(points, cells, [0, 1])
    with pytest.raises(ValueError, match="points"):
        quadrilaterals(np.where(points == 1.5, np.nan, points), cells)
    mesh = quadrilaterals(points, cells, [0, 0, 1, 1])
    with pytest.raises(ValueError, match="2 regions"):
        Revolved((Patch(STEEL),), section=mesh)
    with pytest.raises(ValueError, match=r"regions\[0\].*Patch"):
        Revolved((Region((1.0, 2.0), (0.0, 1.0), STEEL),) * 2, section=mesh)
    with pytest.raises(ValueError, match=r"regions\[0\].*Region"):
        Revolved((Patch(STEEL),))
    body = (Patch(STEEL), Patch(STEEL))
    for face in (
        Cylinder(3.0),
        EndFace(0.0, (0.5, 2.0)),
        Line((1.0, 0.0), (2.0, 1.0)),
        Where(lambda r, z: r > 5.0),
        MeshNodes(()),
        MeshNodes((0, 8)),
        MeshNodes((77,)),
    ):
        with pytest.raises(ValueError, match="bore"):
            Revolved(body, {"bore": face}, section=mesh)
    with pytest.raises(ValueError, match="two points"):
        Line((1.0, 0.0), (1.0, 0.0))


def test_rectangles_are_the_mesher_s_own_quadrilaterals() -> None:
    """The mesher's output passes the checks for brought meshes."""
    layer = Layer(17.5 * MM, 20.0 * MM, 11.0 * MM, unit_rubber(0.45)).body.mesh
    for mesh in (layer, revolution_mesh([Rectangle((0.0, 1.0), (0, 1)), Rectangle((1.0, 2.0), (0, 3))])):
        again = quadrilaterals(np.stack([mesh.r, mesh.z], -1), mesh.elements[:, NINE], mesh.region)
        np.testing.assert_array_equal(again.elements, mesh.elements)


def test_the_centre_of_a_curved_cell_is_where_its_eight_nodes_put_it() -> None:
    """The serendipity map at ξ = η = 0, by scikit-fem's functions."""
    skfem = pytest.importorskip("skfem")
    corners = np.array([[1.0, 0.0], [2.0, 0.1], [2.1, 1.0], [0.9, 1.1]])
    middles = 0.5 * (corners + np.roll(corners, -1, axis=0))
    middles += np.array([[0.02, -0.06], [0.09, 0.01], [0.03, 0.08], [0.05, -0.02]])
    eight = np.vstack([corners, middles])
    unit = np.array([[0, 0], [1, 0], [1, 1], [0, 1], [0.5, 0], [1, 0.5], [0.5, 1], [0, 0.5]])
    element = skfem.ElementQuadS2()
    order = [int(np.argmin(np.abs(element.doflocs - place).sum(axis=1))) for place in unit]
    N = np.array([element.lbasis(np.array([[0.5], [0.5]]), i)[0][0] for i in order])
    mesh = quadrilaterals(eight, [np.arange(8)])
    centre = mesh.elements[0, 4]
    np.testing.assert_allclose([mesh.r[centre], mesh.z[centre]], N @ eight, rtol=1e-14)
