"""Meshes from gmsh, Abaqus, CalculiX and VTK files, and what is wrong with some of them."""

from __future__ import annotations

import math

import numpy as np
import pytest

from bearingdyn.fem import SolidMesh, block_with_bore, box_mesh, read_mesh, ring_mesh
from bearingdyn.fem.meshes.solid_mesh import second_order
from bearingdyn.material import STEEL
from bearingdyn.parts import Housing, RigidSurface, Solid

meshio = pytest.importorskip("meshio")
pytest.importorskip("skfem")

MM = 1e-3
CELL = {
    "hex20": ("hexahedron20", "quad8"),
    "hex27": ("hexahedron27", "quad9"),
    "tet10": ("tetra10", "triangle6"),
}

# One brick by hand, in gmsh's order of nodes (its manual, section 9.2): middles of the edges
# 01 03 04 12 15 23 26 37 45 47 56 67, for 27 nodes of the faces z− y− x− x+ y+ z+, and the centre.
CORNERS = np.array([(0, 0, 0), (2, 0, 0), (2, 3, 0), (0, 3, 0), (0, 0, 5), (2, 0, 5), (2, 3, 5), (0, 3, 5)])
GMSH_EDGES = ((0, 1), (0, 3), (0, 4), (1, 2), (1, 5), (2, 3), (2, 6), (3, 7), (4, 5), (4, 7), (5, 6), (6, 7))
GMSH_FACES = (
    (0, 1, 2, 3),
    (0, 1, 4, 5),
    (0, 3, 4, 7),
    (1, 2, 5, 6),
    (2, 3, 6, 7),
    (4, 5, 6, 7),
    tuple(range(8)),
)
# 10 nodes: middles of 01 12 20 30 32 31
GMSH_TET = ((0, 1), (1, 2), (2, 0), (3, 0), (3, 2), (3, 1))


def gmsh_brick(n):
    groups = GMSH_EDGES + (GMSH_FACES if n == 27 else ())
    return np.vstack([CORNERS, [CORNERS[list(g)].mean(axis=0) for g in groups]]), {20: 17, 27: 12}[n]


def gmsh_tet():
    c = CORNERS[[0, 1, 3, 4]]
    return np.vstack([c, [c[list(g)].mean(axis=0) for g in GMSH_TET]]), 11


def msh22(points, kind):
    nodes = "\n".join(f"{k + 1} {x} {y} {z}" for k, (x, y, z) in enumerate(points))
    element = " ".join(str(k + 1) for k in range(len(points)))
    return (
        '$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n1\n3 7 "block"\n$EndPhysicalNames\n'
        f"$Nodes\n{len(points)}\n{nodes}\n$EndNodes\n$Elements\n1\n1 {kind} 2 7 1 {element}\n$EndElements\n"
    )


def msh41(points, kind):
    n = len(points)
    tags = "\n".join(str(k + 1) for k in range(n))
    nodes = "\n".join(f"{x} {y} {z}" for x, y, z in points)
    element = " ".join(str(k + 1) for k in range(n))
    return (
        '$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$PhysicalNames\n1\n3 7 "block"\n$EndPhysicalNames\n'
        "$Entities\n0 0 0 1\n1 0 0 0 2 3 5 1 7 0\n$EndEntities\n"
        f"$Nodes\n1 {n} 1 {n}\n3 1 0 {n}\n{tags}\n{nodes}\n$EndNodes\n"
        f"$Elements\n1 1 1 1\n3 1 {kind} 1\n1 {element}\n$EndElements\n"
    )


@pytest.mark.parametrize("version", [msh22, msh41])
@pytest.mark.parametrize(
    ("make", "volume"), [(lambda: gmsh_brick(20), 30), (lambda: gmsh_brick(27), 30), (gmsh_tet, 5)]
)
def test_gmsh_element_written_by_hand_has_its_volume_and_nodes_in_place(tmp_path, version, make, volume):
    file = tmp_path / "one.msh"
    file.write_text(version(*make()))
    mesh = read_mesh(file)
    assert mesh.volume() == pytest.approx(volume, rel=1e-14)
    assert list(mesh.regions) == ["block"]
    # straight edges: every node is where the element's own map of its corners puts it
    corners = mesh.points[mesh.elements[0, : len(mesh.kind.corners)]]
    straight = second_order(corners, [np.arange(len(corners))])[0]
    edges = len(mesh.kind.corners) + len(mesh.kind.edges)
    np.testing.assert_allclose(
        sorted(mesh.points[mesh.elements[0, :edges]].tolist()), sorted(straight.tolist())
    )
    places = mesh.kind.places * [2, 3, 5]
    np.testing.assert_allclose(mesh.points[mesh.elements[0]], places, atol=1e-14)


def drawings():
    yield "block", block_with_bore(60, 90, 12, 30, 50, 15, flange=(12, 8))
    two = ring_mesh((20, 22, 25), 8, across=1, along=2, around=8, regions=("rubber", "steel"))
    yield "ring of two", two


SHARED = {"base", "outside"}  # they overlap others, and meshio has one number for a face


def meshio_of(mesh):
    """Volume cells by region, faces by surface, tagged as gmsh does."""
    volume, face = CELL[mesh.kind.name]
    cells, tags, names = [], [], {}
    for k, (name, at) in enumerate(mesh.regions.items()):
        cells.append((volume, mesh.elements[at]))
        tags.append(np.full(len(at), k + 1))
        names[name] = np.array([k + 1, 3])
    for k, name in enumerate(n for n in mesh.surfaces if n not in SHARED):
        faces = mesh.faces(name)
        cells.append((face, faces))
        tags.append(np.full(len(faces), k + 11))
        names[name] = np.array([k + 11, 2])
    data = {"gmsh:physical": tags, "gmsh:geometrical": tags}
    return meshio.Mesh(mesh.points, cells, cell_data=data, field_data=names)


def same(read, mesh, names):
    """The same body: volumes of regions, and area and centre of surfaces, m for mm."""
    for name in mesh.regions:
        assert read.volume(names.get(name, name)) == pytest.approx(1e-9 * mesh.volume(name), rel=1e-12)
    for name in mesh.surfaces:
        if names.get(name, name) in read.surfaces:
            a, b = read.samples(names.get(name, name)), mesh.samples(name)
            assert a.area == pytest.approx(1e-6 * b.area, rel=1e-12)
            np.testing.assert_allclose(a.centroid, 1e-3 * b.centroid, atol=1e-12)


def gmsh_order(kind):
    """Which of our nodes is gmsh's first, second, ... in a brick."""
    groups = [*((k,) for k in range(8)), *GMSH_EDGES, *GMSH_FACES][: kind.nodes]
    places = np.array([kind.places[list(g)].mean(axis=0) for g in groups])
    return [int(np.argmin(np.linalg.norm(kind.places - at, axis=1))) for at in places]


def msh41_of(mesh):
    """gmsh 4.1, as gmsh writes it: an entity for each group, nodes numbered with gaps."""
    n, order = len(mesh.points), gmsh_order(mesh.kind)
    blocks = [(3, name, mesh.elements[at][:, order]) for name, at in mesh.regions.items()]
    blocks += [(2, name, mesh.faces(name)) for name in mesh.surfaces]
    code = {20: 17, 27: 12, 8: 16, 9: 10}
    text = ["$MeshFormat", "4.1 0 8", "$EndMeshFormat", "$PhysicalNames", str(len(blocks))]
    text += [f'{dim} {k + 1} "{name}"' for k, (dim, name, _) in enumerate(blocks)]
    solids = sum(dim == 3 for dim, _, _ in blocks)
    text += ["$EndPhysicalNames", "$Entities", f"0 0 {len(blocks) - solids} {solids}"]
    for wanted in (2, 3):
        text += [f"{k + 1} 0 0 0 1 1 1 1 {k + 1} 0" for k, (dim, _, _) in enumerate(blocks) if dim == wanted]
    text += ["$EndEntities", "$Nodes", f"1 {n} 1 {3 * n}", f"3 1 0 {n}"]
    text += [str(3 * k + 1) for k in range(n)]
    text += [f"{x!r} {y!r} {z!r}" for x, y, z in mesh.points.tolist()]
    total = sum(len(rows) for _, _, rows in blocks)
    text += ["$EndNodes", "$Elements", f"{len(blocks)} {total} 1 {total}"]
    number = 0
    for k, (dim, _, rows) in enumerate(blocks):
        text.append(f"{dim} {k + 1} {code[rows.shape[1]]} {len(rows)}")
        for row in rows.tolist():
            number += 1
            text.append(" ".join(str(i) for i in (number, *(3 * j + 1 for j in row))))
    return "\n".join([*text, "$EndElements", ""])


@pytest.mark.parametrize("form", ["2.2 text", "2.2 binary", "4.1"])
def test_gmsh_file_keeps_regions_and_surfaces(tmp_path, form):
    for _, mesh in drawings():
        file = tmp_path / "a.msh"
        if form == "4.1":
            file.write_text(msh41_of(mesh))
        else:
            meshio_of(mesh).write(file, file_format="gmsh22", binary=form == "2.2 binary")
        read = read_mesh(file, scale=1e-3)
        assert set(read.regions) == set(mesh.regions)
        assert set(read.surfaces) == set(mesh.surfaces) - (set() if form == "4.1" else SHARED)
        same(read, mesh, {})


@pytest.mark.parametrize("suffix", [".vtk", ".vtu"])
def test_vtk_file_keeps_regions_by_number_and_surfaces_by_cells_or_marks(tmp_path, suffix):
    for _, mesh in drawings():
        given = meshio_of(mesh)
        tags = given.cell_data.pop("gmsh:physical")
        given.cell_data = {"group": tags}
        mark = np.zeros(len(mesh.points), dtype=int)
        mark[next(iter(mesh.surfaces.values()))] = 1
        given.point_data["marked"] = mark
        given.write(tmp_path / f"a{suffix}")
        read = read_mesh(tmp_path / f"a{suffix}", scale=1e-3, region_data="group")
        names = {name: str(tag) for name, (tag, _) in given.field_data.items()}
        assert set(read.regions) == {names[n] for n in mesh.regions}
        same(read, mesh, names)
        same(read, mesh, names | {next(iter(mesh.surfaces)): "marked"})
        with pytest.raises(ValueError, match="region_data is 'colour'; its arrays of cells are"):
            read_mesh(tmp_path / f"a{suffix}", region_data="colour")


SIDES = ((0, 3, 2, 1), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7))  # S1 to S6


def inp_of(mesh, **change):
    """An input file with a set for each region, node sets, and one surface by faces."""
    k = mesh.elements.shape[1]
    lines = ["** a comment", "*HEADING", "drawing", "*Node, NSET=Nall"]
    lines += [f"{10 * i + 5}, {x!r}, {y!r}, {z!r}" for i, (x, y, z) in enumerate(mesh.points.tolist())]
    for name, at in mesh.regions.items():
        lines.append(f"*ELEMENT, TYPE=C3D{k}, ELSET={name}")
        for e in at.tolist():
            numbers = [100 + e, *(10 * mesh.elements[e] + 5).tolist()]
            lines += [", ".join(map(str, numbers[:12])) + ",", ", ".join(map(str, numbers[12:]))][
                : 1 + (k > 11)
            ]
    for name, at in mesh.surfaces.items():
        lines.append(f"*NSET, NSET={name}")
        lines += [", ".join(str(10 * i + 5) for i in at[s : s + 8].tolist()) for s in range(0, len(at), 8)]
    return "\n".join(lines) + "\n"


def test_abaqus_file_keeps_regions_node_sets_and_faces(tmp_path):
    for _, mesh in drawings():
        if mesh.kind.name == "hex27":
            keep = 20
            used = np.unique(mesh.elements[:, :keep])
            number = np.full(len(mesh.points), -1)
            number[used] = np.arange(used.size)
            surfaces = {n: number[at][number[at] >= 0] for n, at in mesh.surfaces.items()}
            mesh = SolidMesh(mesh.points[used], number[mesh.elements[:, :keep]], mesh.regions, surfaces)
        text = inp_of(mesh)
        lid = "front" if "front" in mesh.surfaces else "z+"
        on = set(mesh.surfaces[lid].tolist())
        faces = ["*SURFACE, NAME=Lid, TYPE=ELEMENT"]
        for e, nodes in enumerate(mesh.elements.tolist()):
            faces += [
                f"{100 + e}, S{s + 1}" for s, side in enumerate(SIDES) if {nodes[i] for i in side} <= on
            ]
        (tmp_path / "a.inp").write_text(text + "\n".join(faces) + "\n*STEP\n*END STEP\n")
        read = read_mesh(tmp_path / "a.inp", scale=1e-3)
        assert set(read.regions) == set(mesh.regions)
        assert {*mesh.surfaces, "Nall", "Lid"} == set(read.surfaces)
        same(read, mesh, {})
        assert read.samples("Lid").area == pytest.approx(1e-6 * mesh.samples(lid).area, rel=1e-12)
        np.testing.assert_array_equal(read.surface("Lid"), read.surface(lid))


TET_INP = """*NODE
1, 0, 0, 0
2, 1, 0, 0
3, 0, 1, 0
4, 0, 0, 1
5, .5, 0, 0
6, .5, .5, 0
7, 0, .5, 0
8, 0, 0, .5
9, .5, 0, .5
10, 0, .5, .5
*ELEMENT, TYPE=C3D10, ELSET=Eall
7, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10
*ELSET, ELSET=few, GENERATE
7, 7, 1
*SURFACE, NAME=floor
few, S1
*SURFACE, NAME=slope
7, S3
*SURFACE, NAME=tip, TYPE=NODE
4
"""


def test_tetrahedron_of_calculix_has_its_faces(tmp_path):
    (tmp_path / "t.inp").write_text(TET_INP)
    mesh = read_mesh(tmp_path / "t.inp")
    assert mesh.volume() == pytest.approx(1 / 6, rel=1e-14)
    assert mesh.samples("floor").area == pytest.approx(0.5)
    np.testing.assert_allclose(mesh.samples("floor").normals, [[0, 0, -1]] * 6, atol=1e-15)
    assert mesh.samples("slope").area == pytest.approx(math.sqrt(3) / 2)
    assert mesh.surface("tip").tolist() == [3]
    assert list(mesh.regions) == ["Eall"]


def test_solid_sections_say_which_sets_are_regions(tmp_path):
    mesh = box_mesh([0, 1, 2], [0, 1], [0, 1])
    text = inp_of(SolidMesh(mesh.points, mesh.elements, {"a": [0], "b": [1]}))
    overlapping = "*ELSET, ELSET=both\na, b\n*ELSET, ELSET=other\n101\n"
    sections = "*SOLID SECTION, ELSET=A, MATERIAL=X\n1.\n*SOLID SECTION, ELSET=b, MATERIAL=Y\n"
    (tmp_path / "a.inp").write_text(text + overlapping)
    with pytest.raises(ValueError, match=r"a.inp: the sets of elements \['a', 'b', 'other'\] overlap"):
        read_mesh(tmp_path / "a.inp")
    assert set(read_mesh(tmp_path / "a.inp", regions=("a", "b")).regions) == {"a", "b"}
    assert set(read_mesh(tmp_path / "a.inp", regions=()).regions) == {"body"}
    with pytest.raises(ValueError, match=r"regions has 'c'; there are \['a', 'b'"):
        read_mesh(tmp_path / "a.inp", regions=("c",))
    (tmp_path / "b.inp").write_text("*INCLUDE, INPUT=a.inp\n" + sections)
    assert set(read_mesh(tmp_path / "b.inp").regions) == {"a", "b"}


def test_housing_from_a_file_is_the_housing(tmp_path):
    drawing = Housing(0.12, 0.2, 0.02, 0.062, 0.13, element_size=0.02, f_max=5e3)
    (tmp_path / "h.inp").write_text(inp_of(drawing.body.mesh))
    read = Solid(
        read_mesh(tmp_path / "h.inp"),
        STEEL,
        {"bore": RigidSurface("bore", "axis"), "feet": RigidSurface("feet", (0.0, -0.13, 0.0))},
        5e3,
    ).superelement()
    np.testing.assert_allclose(read.K[:12, :12], drawing.superelement().K[:12, :12], rtol=1e-9, atol=1e-3)


def linear(mesh):
    corners = mesh.elements[:, : len(mesh.kind.corners)]
    return mesh.points[: corners.max() + 1], corners


def test_linear_elements_are_refused_or_made_second_order(tmp_path):
    p, corners = linear(box_mesh([0, 1, 2], [0, 1, 2], [0, 1]))
    mark = (p[:, 2] < 1e-9).astype(int)
    meshio.Mesh(p, [("hexahedron", corners)], point_data={"base": mark}).write(tmp_path / "l.vtu")
    with pytest.raises(ValueError, match=r"l.vtu: the file has 8-node elements.*upgrade=True"):
        read_mesh(tmp_path / "l.vtu")
    mesh = read_mesh(tmp_path / "l.vtu", upgrade=True)
    assert mesh.elements.shape == (4, 20)
    assert mesh.volume() == pytest.approx(4.0)
    assert mesh.samples("base").area == pytest.approx(4.0)


def test_coincident_nodes_are_merged_on_request(tmp_path):
    a, b = box_mesh([0, 1], [0, 1], [0, 1]), box_mesh([1, 2], [0, 1], [0, 1])
    p = np.vstack([a.points, b.points, [[9.0, 9.0, 9.0]]])
    cells = [("hexahedron20", np.vstack([a.elements, b.elements + 20]))]
    meshio.Mesh(p, cells).write(tmp_path / "two.vtu")
    with pytest.raises(ValueError, match=r"1 nodes belong to no element, the first at \[9.0, 9.0, 9.0\] m"):
        read_mesh(tmp_path / "two.vtu")
    with pytest.raises(ValueError, match=r"2 bodies that share no node.*8 pairs of nodes coincide.*merge="):
        read_mesh(tmp_path / "two.vtu", drop_unconnected=True)
    mesh = read_mesh(tmp_path / "two.vtu", drop_unconnected=True, merge=1e-9)
    assert len(mesh.points) == 32
    assert mesh.volume() == pytest.approx(2.0)


def spoilt(what):
    mesh = box_mesh([0, 0.1, 0.2], [0, 0.1], [0, 0.1])
    p, e = mesh.points.copy(), mesh.elements.copy()
    if what == "inverted":
        p[e[1, 6]] -= 0.15
        p = second_order(p[: e[:, :8].max() + 1], e[:, :8])[0]
    if what == "mirrored":
        e[1] = e[1][[0, 3, 2, 1, 4, 7, 6, 5, 11, 10, 9, 8, 15, 14, 13, 12, 16, 19, 18, 17]]
    if what == "order":
        e[1, 8:] = e[1, 8:][::-1]
    if what == "twice":
        e = np.vstack([e, e[:1]])
    if what == "mm":
        p *= 1e3
    if what == "far":
        box = box_mesh([0, 0.1], [0, 0.1], [0, 0.1])
        p, e = np.vstack([box.points, box.points + 0.5]), np.vstack([box.elements, box.elements + 20])
    return p, e


@pytest.mark.parametrize(
    ("what", "message"),
    [
        ("inverted", "element 101 is turned inside out"),
        ("mirrored", "element 101 has the nodes of a mirror image"),
        ("order", "element 101 has a middle node far from the middle of its edge"),
        ("twice", "elements 100 and 102 have the same corners"),
        ("mm", r"the body is 200 m long; is the file in mm\? Then pass scale=1e-3"),
        ("far", "2 bodies that share no node, of 1, 1 elements; read each body by itself"),
    ],
)
def test_faults_of_a_mesh_are_named(tmp_path, what, message):
    p, e = spoilt(what)
    lines = ["*NODE", *(f"{k}, {x!r}, {y!r}, {z!r}" for k, (x, y, z) in enumerate(p.tolist()))]
    lines += [
        "*ELEMENT, TYPE=C3D20R",
        *(f"{100 + k}, " + ", ".join(map(str, row)) for k, row in enumerate(e.tolist())),
    ]
    (tmp_path / "bad.inp").write_text("\n".join(lines))
    with pytest.raises(ValueError, match="bad.inp[:,].*" + message):
        read_mesh(tmp_path / "bad.inp")


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "holds no brick, wedge, pyramid or tetrahedron"),
        (TET_INP.replace("C3D10", "C3D11"), r"line 12: \*ELEMENT: elements of type C3D11; bricks C3D20"),
        (TET_INP.replace("7, 1, 2, 3, 4, 5", "7, 1, 2, 3, 4"), "do not hold whole elements"),
        (TET_INP.replace("7, 1, 2,", "7, 77, 2,"), "element 7 names node 77, which the file does not have"),
        (TET_INP.replace("\n10, 0,", "\n9, 0,"), r"line 11: \*NODE: node 9 is given twice"),
        (
            TET_INP.replace("\n7, S3", "\n7, S5"),
            r"line 19: \*SURFACE: slope has the face 'S5'; it must be S1 to S4",
        ),
        (
            TET_INP.replace("few, S1", "many, S1"),
            r"line 17: \*SURFACE: floor names the element set many, not defined",
        ),
        (
            TET_INP.replace("\n3, 0, 1, 0", "\n3, 0, one, 0"),
            r"line 4: \*NODE: '3, 0, one, 0' is not a node: 'one' is not",
        ),
        (TET_INP + "*INSTANCE, NAME=i, PART=p\n0, 0, 1\n", "line 22: .*its part p is not defined"),
        (
            TET_INP + "*INCLUDE, INPUT=none.inp\n",
            r"line 22: \*INCLUDE: it names .*none.inp, which is not a file",
        ),
    ],
)
def test_faults_of_an_input_file_are_named(tmp_path, text, message):
    (tmp_path / "bad.inp").write_text(text)
    with pytest.raises(ValueError, match="bad.inp[:,].*" + message):
        read_mesh(tmp_path / "bad.inp")


def test_files_that_are_no_mesh_are_refused(tmp_path):
    with pytest.raises(FileNotFoundError, match=r"none.msh: no such file; give the path of a mesh"):
        read_mesh(tmp_path / "none.msh")
    (tmp_path / "a.stl").write_text("solid")
    with pytest.raises(ValueError, match=r"suffix '.stl'; meshes are .msh, .inp, .bdf, .unv, .vtk or .vtu"):
        read_mesh(tmp_path / "a.stl")
    for suffix, message in ((".msh", "line 1: .*MeshFormat"), (".vtk", "cannot be read"), (".vtu", "cannot")):
        (tmp_path / f"a{suffix}").write_text("not a mesh\n")
        with pytest.raises(ValueError, match=f"a{suffix}: .*{message}"):
            read_mesh(tmp_path / f"a{suffix}")
    p, e = spoilt("")
    numbers = " ".join(map(str, range(12)))
    (tmp_path / "w.vtk").write_text(
        "# vtk DataFile Version 2.0\nx\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 12 double\n"
        + "0 0 0\n" * 12
        + f"CELLS 1 13\n12 {numbers}\nCELL_TYPES 1\n31\n"
    )
    with pytest.raises(ValueError, match=r"w.vtk: .*wedge12"):
        read_mesh(tmp_path / "w.vtk")
    meshio.Mesh(p, [("hexahedron20", e), ("hexahedron", e[:, :8])]).write(tmp_path / "m.vtu")
    with pytest.raises(ValueError, match="mixes elements of 8 and 20 nodes"):
        read_mesh(tmp_path / "m.vtu")
    meshio.Mesh(p, [("hexahedron20", e)]).write(tmp_path / "g.vtu")
    for change, message in (
        ({"scale": 0.0}, "scale is 0.0"),
        ({"scale": math.nan}, "scale is nan"),
        ({"merge": -1.0}, "merge is -1.0"),
        ({"largest": 0.1}, "the body is 0.2 m long"),
    ):
        with pytest.raises(ValueError, match=message):
            read_mesh(tmp_path / "g.vtu", **change)
