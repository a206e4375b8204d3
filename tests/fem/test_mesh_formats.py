"""gmsh's formats as its manual has them, Abaqus assemblies, and kinds of elements side by side."""

from __future__ import annotations

import math
import struct

import numpy as np
import pytest

from bearingdyn.fem import SolidMesh, assemble_solid, read_mesh, rigid_body_residual, rigid_motion
from bearingdyn.fem.meshes.solid_element import HEX27
from bearingdyn.fem.meshes.solid_mesh import second_order
from bearingdyn.material import STEEL

pytest.importorskip("skfem")

# A brick 2 × 3 × 5, a wedge on its side x = 2, and a pyramid on top: corners, in gmsh's order of nodes
FLOOR = np.array([(0, 0, 0), (2, 0, 0), (2, 3, 0), (0, 3, 0)], float)
BRICK = np.vstack([FLOOR, FLOOR + [0, 0, 5]])
WEDGE = np.array([(2, 0, 0), (4, 0, 0), (2, 3, 0), (2, 0, 5), (4, 0, 5), (2, 3, 5)], float)
PYRAMID = np.array([(0, 0, 5), (2, 0, 5), (2, 3, 5), (0, 3, 5), (1, 1.5, 7)], float)
VOLUMES = {"brick": 30.0, "wedge": 15.0, "pyramid": 4.0}
# gmsh's manual, section 9.2: whose middles the further nodes are
EDGES = {
    17: ((0, 1), (0, 3), (0, 4), (1, 2), (1, 5), (2, 3), (2, 6), (3, 7), (4, 5), (4, 7), (5, 6), (6, 7)),
    18: ((0, 1), (0, 2), (0, 3), (1, 2), (1, 4), (2, 5), (3, 4), (3, 5), (4, 5)),
    19: ((0, 1), (0, 3), (0, 4), (1, 2), (1, 4), (2, 3), (2, 4), (3, 4)),
    16: ((0, 1), (1, 2), (2, 3), (3, 0)),
}


def model():
    """Nodes, and (dimension, entity, physical groups, type, nodes) of each element."""
    points, number, elements = [], {}, []
    for dimension, entity, groups, code, corners in (
        (3, 1, (7, 9), 17, BRICK),
        (3, 2, (8, 9), 18, WEDGE),
        (3, 3, (9, 10), 19, PYRAMID),
        (2, 5, (11,), 16, FLOOR),
        (2, 6, (), 16, BRICK[[4, 5, 6, 7]]),  # SaveAll writes it, in no group
    ):
        every = [*corners, *(corners[list(pair)].mean(axis=0) for pair in EDGES[code])]
        for place in every:
            if tuple(place) not in number:
                number[tuple(place)] = 3 * len(points) + 2  # with gaps
                points.append(place)
        elements.append((dimension, entity, groups, code, [number[tuple(place)] for place in every]))
    return np.array(points), 3 * np.arange(len(points)) + 2, elements


NAMES = {7: "brick", 8: "wedge", 9: "everything", 10: "pyramid"}


def msh(version, binary=False, parametric=False, partitioned=False, endian="<"):
    """A .msh file as gmsh's manual describes the format."""
    points, tags, elements = model()
    out = bytearray()

    def put(form, *values):
        if binary:
            out.extend(struct.pack(endian + form, *values))
        else:
            out.extend((" ".join(repr(v) for v in values) + " ").encode())

    def line(text=""):
        if not binary or text:
            out.extend(text.encode() + b"\n")

    line(f"$MeshFormat\n{version} {int(binary)} 8")
    if binary:
        out.extend(struct.pack(endian + "i", 1))
        out.extend(b"\n")
    line("$EndMeshFormat\n$PhysicalNames\n5")
    for g, name in NAMES.items():
        line(f'3 {g} "{name}"')
    line('2 11 "the floor"\n$EndPhysicalNames\n$Comments\n$Nodes are not here\n$EndComments')
    if version == 2.2:
        section = "ParametricNodes" if parametric else "Nodes"
        line(f"${section}\n{len(points)}")
        for k, (tag, place) in enumerate(zip(tags.tolist(), points.tolist(), strict=True)):
            put("i3d", tag, *place)
            if parametric:  # dimension and number of the entity, then as many coordinates as it has
                put("2i", *((2, 6) if k % 2 else (1, 4)))
                put("2d" if k % 2 else "d", *((0.5, 0.25) if k % 2 else (0.5,)))
            line()
        line(f"\n$End{section}\n$Elements")
        rows = [(d, e, g, c, n) for d, e, groups, c, n in elements for g in groups or (0,)]
        line(f"{len(rows)}")
        for k, (_, entity, group, code, nodes) in enumerate(rows, 1):
            tagged = (group, entity, 1, 1) if partitioned else (group, entity)
            if binary:
                put(f"3i{1 + len(tagged) + len(nodes)}i", code, 1, len(tagged), k, *tagged, *nodes)
            else:
                line(" ".join(map(str, (k, code, len(tagged), *tagged, *nodes))))
        line("\n$EndElements")
        return bytes(out)
    box = (0.0,) * 6
    line("$Entities")
    put("4q", 1, 0, 2, 3)
    line()
    put("i3d" if version == 4.1 else "i6d", 1, *(box[:3] if version == 4.1 else box))
    put("q", 0)
    line()
    for dimension in (2, 3):
        for d, entity, groups, *_ in elements:
            if d == dimension:
                put("i6d", entity, *box)
                put(f"q{len(groups)}i", len(groups), *groups)
                put("q2i", 2, 1, -1)
                line()
    line("\n$EndEntities")
    shift = 100 if partitioned else 0
    if partitioned:
        line("$PartitionedEntities")
        put("2q", 2, 1)
        put("2i", 900, 1)
        put("4q", 0, 0, 2, 3)
        line()
        for dimension in (2, 3):
            for d, entity, groups, *_ in elements:
                if d == dimension:
                    put("3i", entity + shift, d, entity)
                    put("q2i", 2, 1, 2)
                    put("6d", *box)
                    put(f"q{len(groups)}i", len(groups), *groups)
                    put("q", 0)
                    line()
        line("\n$EndPartitionedEntities")
    line("$Nodes")
    n = len(points)
    put(*(("2q", 1, n) if version == 4.0 else ("4q", 1, n, 2, int(tags[-1]))))
    line()
    put("3iq", *((6, 2) if version == 4.0 else (2, 6)), int(parametric), n)
    line()
    more = (0.5, 0.25) if parametric else ()
    form = "5d" if parametric else "3d"
    if version == 4.0:
        for tag, place in zip(tags.tolist(), points.tolist(), strict=True):
            put("i" + form, tag, *place, *more)
            line()
    else:
        for tag in tags.tolist():
            put("q", tag)
            line()
        for place in points.tolist():
            put(form, *place, *more)
            line()
    line("\n$EndNodes\n$Elements")
    put(*(("2q", 5, 5) if version == 4.0 else ("4q", 5, 5, 1, 5)))
    line()
    for k, (dimension, entity, _, code, nodes) in enumerate(elements, 1):
        entity += shift
        put("3iq", *((entity, dimension) if version == 4.0 else (dimension, entity)), code, 1)
        line()
        put(f"{1 + len(nodes)}{'i' if version == 4.0 else 'q'}", k, *nodes)
        line()
    line("\n$EndElements")
    return bytes(out)


@pytest.mark.parametrize("partitioned", [False, True])
@pytest.mark.parametrize("parametric", [False, True])
@pytest.mark.parametrize(
    ("version", "binary", "endian"),
    [(2.2, False, "<"), (2.2, True, "<"), (2.2, True, ">"), (4.0, False, "<"), (4.0, True, "<")]
    + [(4.1, False, "<"), (4.1, True, "<"), (4.1, True, ">")],
)
def test_gmsh_file_of_any_format_is_the_same_body(tmp_path, version, binary, endian, parametric, partitioned):
    (tmp_path / "a.msh").write_bytes(msh(version, binary, parametric, partitioned, endian))
    mesh = read_mesh(tmp_path / "a.msh", regions=("brick", "wedge", "pyramid"))
    assert {kind.nodes for kind, _ in mesh.groups} == {20, 15, 13}
    for name, volume in VOLUMES.items():
        assert mesh.volume(name) == pytest.approx(volume, rel=1e-13)
    assert list(mesh.surfaces) == ["the floor"]
    assert mesh.samples("the floor").area == pytest.approx(6.0, rel=1e-13)
    # the group that overlaps them holds each element once
    whole = read_mesh(tmp_path / "a.msh", regions=("everything",))
    assert len(whole.regions["everything"]) == 3
    assert whole.volume("everything") == pytest.approx(49.0, rel=1e-13)


def test_groups_that_overlap_are_regions_only_as_far_as_they_divide_the_body(tmp_path):
    (tmp_path / "a.msh").write_bytes(msh(4.1))
    assert set(read_mesh(tmp_path / "a.msh").regions) == {"brick", "wedge", "pyramid"}
    with pytest.raises(ValueError, match=r"element 1 is in the regions \['brick', 'everything'\]"):
        read_mesh(tmp_path / "a.msh", regions=("brick", "everything"))


def test_entities_of_the_drawing_stand_for_groups_on_request(tmp_path):
    head, _, body = msh(2.2).decode().partition("$Elements\n")
    rows = [row.split() for row in body.split("\n")[1:] if len(row.split()) > 5]
    once = {tuple(row[4:]): row for row in rows}  # as Mesh.SaveAll = 1 writes format 2.2: once, in no group
    lines = [" ".join([*row[:3], "0", *row[4:]]) for row in once.values()]
    (tmp_path / "a.msh").write_text(
        f"{head}$Elements\n{len(lines)}\n" + "\n".join(lines) + "\n$EndElements\n"
    )
    with pytest.raises(ValueError, match=r"no element is in one, .*SaveAll = 1.*save it without SaveAll"):
        read_mesh(tmp_path / "a.msh")
    mesh = read_mesh(tmp_path / "a.msh", region_data="gmsh:geometrical")
    assert {name: mesh.volume(name) for name in mesh.regions} == pytest.approx(
        {"1": 30.0, "2": 15.0, "3": 4.0}
    )


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (lambda t: t.replace(b"4.1 0 8", b"1.0 0 8"), "line 2: format '1.0 0 8'; 2.2, 4.0 and 4.1 are read"),
        (lambda t: t.replace(b"$MeshFormat", b"(0 Fluent", 1), "line 1: .*Fluent"),
        (lambda t: t.replace(b"$EndElements", b"$EndElem"), r"\$Elements has no \$EndElements"),
        (lambda t: t.replace(b" 17 1 \n", b" 92 1 \n"), r"line \d+: bricks of third order \(type 92\)"),
        (lambda t: t.replace(b" 17 1 \n", b" 777 1 \n"), r"line \d+: elements of type 777"),
        (lambda t: t[: len(t) // 2], r"line \d+: .*(cut off|stands where)"),
        (lambda t: t.replace(b"\n2 \n", b"\n5 \n", 1), "node 5 is given twice"),
        (lambda t: t.replace(b"\n1 2 5", b"\n1 3 5"), "element 1 names node 3, which the file does not have"),
        (lambda t: t.replace(b"\n2 \n", b"\n2x \n", 1), r"line \d+: '2x' stands where a whole number should"),
    ],
)
def test_faults_of_a_gmsh_file_are_named_with_the_line(tmp_path, change, message):
    (tmp_path / "bad.msh").write_bytes(change(msh(4.1)))
    with pytest.raises(ValueError, match="bad.msh: .*" + message):
        read_mesh(tmp_path / "bad.msh")


def vtk_of_gmsh():
    """As gmsh writes it: one number a cell in CellEntityIds, of faces and bodies alike."""
    points, tags, elements = model()
    row = {int(tag): k for k, tag in enumerate(tags)}
    order = {  # VTK's order of nodes by gmsh's; edges of VTK's manual
        17: [*range(8), 8, 11, 13, 9, 16, 18, 19, 17, 10, 12, 14, 15],
        18: [*range(6), 6, 9, 7, 12, 14, 13, 8, 10, 11],
        19: [*range(5), 5, 8, 10, 6, 7, 9, 11, 12],
        16: [*range(8)],
    }
    cells = [(code, [row[nodes[k]] for k in order[code]]) for *_, code, nodes in elements]
    size = sum(1 + len(nodes) for _, nodes in cells)
    text = ["# vtk DataFile Version 2.0", "x, Created by Gmsh", "ASCII", "DATASET UNSTRUCTURED_GRID"]
    text += [f"POINTS {len(points)} double", *(f"{x} {y} {z}" for x, y, z in points.tolist()), ""]
    text += [f"CELLS {len(cells)} {size}", *(" ".join(map(str, (len(n), *n))) for _, n in cells), ""]
    kinds = {17: 25, 18: 26, 19: 27, 16: 23}
    text += [f"CELL_TYPES {len(cells)}", *(str(kinds[code]) for code, _ in cells), ""]
    text += [f"CELL_DATA {len(cells)}", "SCALARS CellEntityIds int 1", "LOOKUP_TABLE default"]
    return "\n".join([*text, *(str(entity) for _, entity, *_ in elements), ""])


def test_vtk_of_gmsh_keeps_entities_as_regions_and_surfaces(tmp_path):
    pytest.importorskip("meshio")
    (tmp_path / "a.vtk").write_text(vtk_of_gmsh())
    mesh = read_mesh(tmp_path / "a.vtk")
    assert {name: mesh.volume(name) for name in mesh.regions} == pytest.approx(
        {"1": 30.0, "2": 15.0, "3": 4.0}
    )
    assert mesh.samples("5").area == pytest.approx(6.0)


def test_triangles_on_a_quadrilateral_are_refused_and_pyramids_are_not(tmp_path):
    (tmp_path / "a.msh").write_bytes(msh(4.1))
    good = read_mesh(tmp_path / "a.msh", regions=())
    # the pyramid in two tetrahedra: their middle nodes on the diagonal do not fit the brick
    solid = assemble_solid(good)
    assert rigid_body_residual(solid.stiffness(STEEL), rigid_motion(good.points)) < 1e-13
    corners = np.array([[*range(8)], [4, 5, 6, 8, *[-1] * 4], [4, 6, 7, 8, *[-1] * 4]])
    p, elements, _ = second_order(np.vstack([BRICK, PYRAMID[4:]]), corners)
    with pytest.raises(ValueError, match=r"triangles lie on a quadrilateral near .*put pyramids between"):
        SolidMesh(p, elements)


# --- Abaqus

BLOCK = "*NODE\n" + "\n".join(f"{k + 1}, {x}, {y}, {z}" for k, (x, y, z) in enumerate(BRICK.tolist()))
BLOCK += "\n*ELEMENT, TYPE=C3D8, ELSET=Solid\n1, 1, 2, 3, 4, 5, 6, 7, 8\n"
ENDS = "*NSET, NSET=low\n1, 2, 3, 4\n*ELSET, ELSET=all\nSolid\n*SURFACE, NAME=top\nall, S2\n"


def read(tmp_path, text, **options):
    (tmp_path / "a.inp").write_bytes(text if isinstance(text, bytes) else text.encode())
    return read_mesh(tmp_path / "a.inp", upgrade=True, largest=1e3, **options)


@pytest.mark.parametrize("form", ["utf-8-sig", "utf-16", "latin-1"])
@pytest.mark.parametrize("end", ["\n", "\r\n"])
def test_windows_text_is_read(tmp_path, form, end):
    text = "** Gehäuse\n" if form == "latin-1" else ""
    mesh = read(tmp_path, (text + BLOCK + ENDS).replace("\n", end).encode(form))
    assert mesh.volume() == pytest.approx(30.0)
    assert mesh.samples("low").area == mesh.samples("top").area == pytest.approx(6.0)


def test_instances_are_shifted_then_turned_and_keep_their_own_numbers(tmp_path):
    text = (
        f"*HEADING\n*PART, NAME=P\n{BLOCK}{ENDS}*SOLID SECTION, ELSET=Solid, MATERIAL=m\n,\n*END PART\n"
        "*ASSEMBLY, NAME=A\n*INSTANCE, NAME=one, PART=P\n*END INSTANCE\n"
        # moved to x = 2...4, then half a turn about the line x = 3, y = 1.5: the same place again
        "*INSTANCE, NAME=two, PART=P\n2., 0., 0.\n3., 1.5, 0., 3., 1.5, 1., 180.\n*END INSTANCE\n"
        # moved along z, then a quarter turn about the x axis: y, z -> −z, y
        "*NODE\n1, 9., 9., 9.\n*NSET, NSET=RP\n1,\n"
        "*NSET, NSET=ends, INSTANCE=one\n5, 6\n*NSET, NSET=ends, INSTANCE=one\n7, 8\n"
        "*ELSET, ELSET=both\none.Solid, two.Solid\n*SURFACE, NAME=far\ntwo.all, S6\n*END ASSEMBLY\n"
    )
    mesh = read(tmp_path, text, drop_unconnected=True, merge=1e-9)
    assert set(mesh.regions) == {"one.Solid", "two.Solid"}
    assert mesh.volume() == pytest.approx(60.0)
    assert np.ptp(mesh.points, axis=0) == pytest.approx([4.0, 3.0, 5.0])
    assert mesh.samples("ends").area == pytest.approx(6.0)
    np.testing.assert_allclose(mesh.samples("ends").centroid, [1.0, 1.5, 5.0])
    # S6 is x−; half a turn puts it at x+ of the second block
    np.testing.assert_allclose(mesh.samples("far").centroid, [4.0, 1.5, 2.5])
    assert "two.low" in mesh.surfaces
    assert "RP" not in mesh.surfaces
    quarter = text.replace("3., 1.5, 0., 3., 1.5, 1., 180.", "0., 0., 0., 7., 0., 0., 90.")
    turned = read(
        tmp_path,
        quarter.replace("*INSTANCE, NAME=one, PART=P\n*END INSTANCE\n", "").split("*NODE\n1, 9.")[0]
        + "*END ASSEMBLY\n",
    )
    np.testing.assert_allclose(turned.points.min(axis=0), [2.0, -5.0, 0.0], atol=1e-12)
    np.testing.assert_allclose(turned.points.max(axis=0), [4.0, 0.0, 3.0], atol=1e-12)
    assert set(turned.regions) == {"Solid"}


def sector(system, place):
    """A sector of 60°, r 10...14, 8 high, of 6 × 1 × 1 bricks."""
    lines = [system]
    for k in range(7):
        for j, (r, z) in enumerate(((10, 0), (14, 0), (10, 8), (14, 8))):
            lines.append(f"{4 * k + j}, {place(r, 10.0 * k, z)}")
    lines.append("*ELEMENT, TYPE=C3D8R")
    for k in range(6):
        a, b = 4 * k, 4 * k + 4
        lines.append(", ".join(map(str, (k, a, a + 1, b + 1, b, a + 2, a + 3, b + 3, b + 2))))
    return "\n".join(lines)


def test_nodes_in_cylindrical_spherical_and_turned_systems_are_in_their_place(tmp_path):
    exact = 6 * 0.5 * math.sin(math.radians(10)) * (14**2 - 10**2) * 8  # of straight edges
    cylinder = sector("*NODE, SYSTEM=C", lambda r, t, z: f"{r}, {t}, {z}")
    assert read(tmp_path, cylinder).volume() == pytest.approx(exact, rel=1e-12)
    # the same points in spherical coordinates: distance, angle about z, angle above the xy plane
    sphere = sector(
        "*NODE, SYSTEM=S", lambda r, t, z: f"{math.hypot(r, z)!r}, {t}, {math.degrees(math.atan2(z, r))!r}"
    )
    np.testing.assert_allclose(read(tmp_path, sphere).points, read(tmp_path, cylinder).points, atol=1e-12)
    # axes x', y', z' = y, z, x, from (100, 0, 0)
    turned = read(tmp_path, "*SYSTEM\n100, 0, 0, 100, 1, 0\n100, 0, 1\n" + cylinder)
    straight = read(tmp_path, cylinder).points
    np.testing.assert_allclose(turned.points, straight[:, [2, 0, 1]] + [100, 0, 0], atol=1e-11)
    # and without data the system ends
    ended = read(tmp_path, "*SYSTEM\n5, 0, 0\n*SYSTEM\n" + cylinder)
    np.testing.assert_allclose(ended.points, straight, atol=1e-12)
    shifted = read(tmp_path, "*SYSTEM\n5, 0, 0\n*TRANSFORM, NSET=x, TYPE=C\n0, 0, 0, 0, 0, 1\n" + cylinder)
    np.testing.assert_allclose(shifted.points, straight + [5, 0, 0], atol=1e-12)


def test_brick_of_27_nodes_is_read_in_either_order_of_its_middles(tmp_path):
    p = HEX27.places * [2.0, 3.0, 5.0]
    # the centre, then S1 to S6: z−, z+, y−, x+, y+, x−; and VTK's own
    for order in ([*range(20), 26, 24, 25, 22, 21, 23, 20], list(range(27))):
        rows = [f"{k + 1}, {x!r}, {y!r}, {z!r}" for k, (x, y, z) in enumerate(p.tolist())]
        numbers = ", ".join(str(k + 1) for k in order)
        mesh = read(tmp_path, "*NODE\n" + "\n".join(rows) + f"\n*ELEMENT, TYPE=C3D27\n1, {numbers}\n")
        assert mesh.volume() == pytest.approx(30.0)
        np.testing.assert_allclose(mesh.points[mesh.elements[0]], p, atol=1e-14)


def test_wedge_of_abaqus_has_its_sides(tmp_path):
    rows = [f"{k + 1}, {x}, {y}, {z}" for k, (x, y, z) in enumerate(WEDGE.tolist())]
    text = "*NODE\n" + "\n".join(rows) + "\n*ELEMENT, TYPE=C3D6, ELSET=w\n1, 1, 2, 3, 4, 5, 6\n"
    text += "".join(f"*SURFACE, NAME=s{k}\nw, S{k}\n" for k in range(1, 6))
    mesh = read(tmp_path, text)
    assert mesh.volume() == pytest.approx(15.0)
    # Abaqus' manual: 1-2-3, 4-6-5, 1-4-5-2, 2-5-6-3, 3-6-4-1
    normals = {f"s{k}": mesh.samples(f"s{k}").normals[0] for k in range(1, 6)}
    for name, normal in (("s1", (0, 0, -1)), ("s2", (0, 0, 1)), ("s3", (0, -1, 0)), ("s5", (-1, 0, 0))):
        np.testing.assert_allclose(normals[name], normal, atol=1e-14)
    areas = [mesh.samples(f"s{k}").area for k in range(1, 6)]
    assert areas == pytest.approx([3.0, 3.0, 10.0, 5 * math.sqrt(13), 15.0])


@pytest.mark.parametrize(
    "keyword",
    ["NGEN", "NFILL", "NCOPY, CHANGE NUMBER=10, OLD SET=low, SHIFT", "NMAP, NSET=low", "ELGEN", "ELCOPY"]
    + ["IMPERFECTION", "IMPORT", "SYMMETRIC MODEL GENERATION", "CYCLIC SYMMETRY MODEL", "PARAMETER"],
)
def test_keywords_that_make_geometry_are_refused_by_name(tmp_path, keyword):
    with pytest.raises(ValueError, match=rf"a.inp, line 18: \*{keyword.split(',')[0]}: .*write the mesh out"):
        read(tmp_path, BLOCK + ENDS + f"*{keyword}\n1, 2, 3\n")


@pytest.mark.parametrize("kind", ["C3D15V", "SC8R", "COH3D8", "DC3D8", "C3D11", "U5"])
def test_solids_of_another_formulation_are_refused_by_name(tmp_path, kind):
    with pytest.raises(ValueError, match=rf"a.inp, line 10: \*ELEMENT: elements of type {kind}"):
        read(tmp_path, BLOCK.replace("C3D8", kind))


# --- Nastran and I-deas: the same brick and wedge; between which corners a node lies, in the file's order

NASTRAN = {
    "CHEXA": "0 1 2 3 4 5 6 7 01 12 23 30 04 15 26 37 45 56 67 74",
    "CPENTA": "0 1 2 3 4 5 01 12 20 03 14 25 34 45 53",
}
IDEAS = {  # round the faces, corner and middle in turn
    116: "0 01 1 12 2 23 3 30 04 15 26 37 4 45 5 56 6 67 7 74",
    113: "0 01 1 12 2 20 03 14 25 3 34 4 45 5 53",
}
FACE = "0 01 1 12 2 23 3 30"


def numbered(*pieces):
    """Places of all nodes, and the numbers of each element's, from (corners, words)."""
    places, number, elements = [], {}, []
    for corners, words in pieces:
        row = []
        for word in words.split():
            place = tuple(corners[[int(c) for c in word]].mean(axis=0).tolist())
            if place not in number:
                number[place] = 10 * len(places) + 7
                places.append(place)
            row.append(number[place])
        elements.append(row)
    return [(number[place], place) for place in places], elements


def bdf(form):
    """Bulk data in small, large or free fields."""
    nodes, (brick, wedge, face) = numbered(
        (BRICK, NASTRAN["CHEXA"]), (WEDGE, NASTRAN["CPENTA"]), (FLOOR, "0 1 2 3 01 12 23 30")
    )
    cards = [["GRID", n, "", *(f"{v:.1f}" for v in place)] for n, place in nodes]
    cards[3][4] = "30.0-1" if cards[3][4] == "3.0" else cards[3][4]  # Nastran's exponents need no E
    cards += [["CHEXA", 1, 5, *brick], ["CPENTA", 2, 6, *wedge], ["CQUAD8", 3, 9, *face]]
    lines = ["$ a comment", "SOL 103", "BEGIN BULK"]
    for name, *fields in cards:
        width, count = (16, 4) if form == "large" else (8, 8)
        for k in range(0, len(fields), count):
            some = [str(v) for v in fields[k : k + count]]
            first = name if k == 0 else ""
            if form == "free":
                lines.append(",".join([first or "+", *some]))
            else:
                star = "*" if form == "large" else ("+" if k else "")
                head = f"{first}{star}" if k == 0 else star
                lines.append(f"{head:8}" + "".join(f"{v:>{width}}" for v in some))
    return "\n".join([*lines, "ENDDATA", "nonsense"])


def unv():
    """A universal file with groups of elements and of nodes."""
    nodes, (brick, wedge, face) = numbered((BRICK, IDEAS[116]), (WEDGE, IDEAS[113]), (FLOOR, FACE))
    lines = ["    -1", "   164", "         1  SI: Meters (newton)", "    -1", "    -1", "  2411"]
    for n, place in nodes:
        lines += [f"{n:10}{1:10}{1:10}{11:10}", "".join(f"{v:25.16E}" for v in place).replace("E", "D")]
    lines += ["    -1", "    -1", "  2412"]
    for n, code, row in ((1, 116, brick), (2, 113, wedge), (3, 95, face)):
        lines.append("".join(f"{v:10}" for v in (n, code, 1, 1, 7, len(row))))
        lines += ["".join(f"{v:10}" for v in row[k : k + 8]) for k in range(0, len(row), 8)]
    lines += [f"{4:10}{21:10}{1:10}{1:10}{7:10}{2:10}", f"{0:10}{1:10}{1:10}", f"{7:10}{17:10}"]
    lines += ["    -1", "    -1", "  2467"]
    groups = (("housing", 8, [1]), ("rib", 8, [2]), ("floor", 8, [3]), ("base nodes", 7, face))
    for k, (name, what, members) in enumerate(groups, 1):
        lines += ["".join(f"{v:10}" for v in (k, 0, 0, 0, 0, 0, 0, len(members))), name]
        flat = [f"{what:10}{m:10}{0:10}{0:10}" for m in members]
        lines += ["".join(flat[j : j + 2]) for j in range(0, len(flat), 2)]
    return "\n".join([*lines, "    -1", ""])


@pytest.mark.parametrize("form", ["small", "large", "free"])
@pytest.mark.parametrize("end", ["\n", "\r\n"])
def test_bulk_data_of_nastran_is_the_same_body(tmp_path, form, end):
    (tmp_path / "a.bdf").write_bytes(bdf(form).replace("\n", end).encode("utf-8-sig"))
    mesh = read_mesh(tmp_path / "a.bdf")
    assert {n: mesh.volume(n) for n in mesh.regions} == pytest.approx({"5": 30.0, "6": 15.0})
    assert mesh.samples("9").area == pytest.approx(6.0)


@pytest.mark.parametrize("end", ["\n", "\r\n"])
def test_universal_file_keeps_groups(tmp_path, end):
    (tmp_path / "a.unv").write_bytes(unv().replace("\n", end).encode("utf-8-sig"))
    mesh = read_mesh(tmp_path / "a.unv")
    assert {n: mesh.volume(n) for n in mesh.regions} == pytest.approx({"housing": 30.0, "rib": 15.0})
    assert mesh.samples("floor").area == mesh.samples("base nodes").area == pytest.approx(6.0)


@pytest.mark.parametrize(
    ("name", "text", "message"),
    [
        (
            "a.bdf",
            bdf("free").replace("GRID,7,,", "GRID,7,3,"),
            "a.bdf, line 4: GRID: its system of coordinates is 3",
        ),
        ("a.bdf", "INCLUDE 'a.bdf'\n", "a.bdf, line 1: INCLUDE.*: it is not followed"),
        ("a.bdf", bdf("free").replace("CHEXA,1,5,7,", "CHEXA,1,5,,"), r"line \d+: CHEXA: it has 20 nodes"),
        (
            "a.unv",
            unv().replace("  2411", "    15"),
            "a.unv, line 6: dataset 15: dataset 15 is of an older kind",
        ),
        ("a.unv", unv().replace("       116", "       119"), r"line \d+: dataset 2412: elements of type 119"),
        ("a.unv", unv().replace("       116", "       322"), r"line \d+: dataset 2412: elements of type 322"),
        ("a.med", "x", "a.med has the suffix '.med', a mesh of Salome, which is not read; export"),
    ],
)
def test_faults_of_other_formats_are_named(tmp_path, name, text, message):
    (tmp_path / name).write_text(text)
    with pytest.raises(ValueError, match=message):
        read_mesh(tmp_path / name)
