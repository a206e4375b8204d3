"""Files that wish a mesh reader ill: ValueError or OSError, soon, naming the file and the line."""

from __future__ import annotations

import random
import time
import warnings

import pytest

from bearingdyn.fem import box_mesh, read_mesh, read_nodes
from bearingdyn.notice import LeftOut
from fem.test_mesh_files import TET_INP, inp_of, meshio_of, msh41_of
from fem.test_mesh_formats import BLOCK, ENDS, bdf, msh, unv, vtk_of_gmsh

pytest.importorskip("skfem")

SOON = (
    60.0  # s of the processor, on a machine however busy: a file that hangs; those below need half a second
)


def doubling(count, line):
    """Files that include the next one twice."""
    files = {f"d{k}.inp": line.format(k + 1) * 2 for k in range(count)}
    return {**files, f"d{count}.inp": "** the end\n"}


SETS = "*NSET, NSET=s0, GENERATE\n1, 10\n"
MANY = "".join(f"*NSET, NSET=s{k}\n" + ", ".join(f"s{j}" for j in range(k)) + "\n" for k in range(1, 100))
HEAD = "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n"
BINARY = b"$MeshFormat\n4.1 1 8\n\1\0\0\0\n$EndMeshFormat\n"

REFUSED = {
    "includes itself": (
        {"a.inp": "*INCLUDE, INPUT=a.inp\n"},
        r"a.inp, line 1: \*INCLUDE: a.inp includes itself",
    ),
    "includes in a ring": (
        {"a.inp": "*INCLUDE, INPUT=b.inp\n", "b.inp": "** b\n*INCLUDE, INPUT=a.inp\n"},
        r"b.inp, line 2: \*INCLUDE: a.inp includes itself",
    ),
    "22 files that include twice": (
        doubling(22, "*INCLUDE, INPUT=d{}.inp\n"),
        r"line \d: \*INCLUDE: more than 1000 files are included",
    ),
    "nodes from a file twice": (
        {**doubling(22, "*NODE, INPUT=n.txt\n*INCLUDE, INPUT=d{}.inp\n"), "n.txt": "**" + "x" * 2**21 + "\n"},
        r"line \d: \*(NODE|INCLUDE): more than 1000 files are included, or 32 MB a second time",
    ),
    "include without a name": ({"a.inp": "*INCLUDE\n"}, r"a.inp, line 1: \*INCLUDE: it has no INPUT="),
    "set without a name": ({"a.inp": TET_INP + "*NSET\n1, 2\n"}, r"a.inp, line 22: \*NSET: it has no NSET="),
    "set of sets": ({"a.inp": BLOCK + SETS + MANY}, None),
    "set of 1e11 numbers": (
        {"a.inp": TET_INP + "*NSET, NSET=n, GENERATE\n1, 100000000000\n"},
        r"a.inp, line 23: \*NSET: '100000000000' is not the number of a node",
    ),
    "instances of a part": (
        {
            "a.inp": f"*PART, NAME=p\n{BLOCK}{SETS}*END PART\n"
            + "".join(f"*INSTANCE, NAME=i{k}, PART=p\n*END INSTANCE\n" for k in range(40_000))
        },
        r"a.inp, line \d+: \*INSTANCE: \d+ instances have \d+ nodes and elements",
    ),
    "number of 5000 digits": (
        {"a.inp": BLOCK.replace("\n3, ", "\n" + "9" * 5000 + ", ")},
        "line 4: .*is not a node",
    ),
    "number with underscores": (
        {"a.inp": BLOCK.replace("\n3, ", "\n3_3, ")},
        "line 4: .*'3_3' is not the number",
    ),
    "node that is infinite": (
        {"a.inp": BLOCK.replace("\n3, 2.0", "\n3, inf")},
        "'inf' is not a finite number",
    ),
    "element without a type": ({"a.inp": "*ELEMENT\n1, 2\n"}, r"a.inp, line 1: \*ELEMENT: it has no TYPE="),
    "1e11 nodes": (
        {"a.msh": HEAD + "$Nodes\n1 99999999999 1 1\n3 1 0 99999999999\n"},
        "line 6: 99999999999 nodes",
    ),
    "1e23 blocks": (
        {"a.msh": HEAD + "$Nodes\n" + "9" * 23 + " 1 1 1\n"},
        "line 5: 9+ blocks of nodes",
    ),
    "a million empty blocks": (
        {"a.msh": HEAD + "$Nodes\n1000000 1 1 1\n" + "3 1 0 0\n" * 1_000_000},
        "line 5: 1000000 blocks of nodes should follow; up to 100000 are read",
    ),
    "negative counts": ({"a.msh": BINARY + b"$Nodes\n" + b"\xff" * 100}, r"byte \d+: -1 blocks of nodes"),
    "number of names of 5000 digits": (
        {"a.msh": HEAD + "$PhysicalNames\n" + "9" * 5000 + "\n"},
        "line 5: .* stands where a physical name",
    ),
    "points of terabytes": (
        {"a.vtk": "# vtk DataFile Version 2.0\n\nBINARY\nDATASET UNSTRUCTURED_GRID\nPOINTS 9999999999 int\n"},
        "a.vtk: it cannot be read",
    ),
}


@pytest.mark.parametrize("name", REFUSED)
def test_hostile_file_is_refused_soon_with_file_and_line(tmp_path, name):
    files, message = REFUSED[name]
    for file, text in files.items():
        (tmp_path / file).write_bytes(text if isinstance(text, bytes) else text.encode())
    start = time.process_time()
    if message is None:  # odd, and nothing wrong with it
        assert "s99" in read_mesh(tmp_path / next(iter(files)), upgrade=True, largest=1e3).surfaces
    else:
        with pytest.raises(ValueError, match=message):
            read_mesh(tmp_path / next(iter(files)), upgrade=True, largest=1e3)
    assert time.process_time() - start < SOON


def test_nodes_for_matrices_are_not_read_from_files_that_include_themselves_or_move_them(tmp_path):
    (tmp_path / "a.inp").write_text("*INCLUDE, INPUT=a.inp\n")
    with pytest.raises(ValueError, match=r"a.inp, line 1: \*INCLUDE: a.inp includes itself"):
        read_nodes(tmp_path / "a.inp")
    for text in ("*NODE, SYSTEM=C\n1, 2, 3, 4\n", "*SYSTEM\n1, 2, 3\n", "*NGEN\n1, 2\n"):
        (tmp_path / "a.inp").write_text(text)
        with pytest.raises(ValueError, match=r"a.inp, line 1: \*.*moves or makes nodes"):
            read_nodes(tmp_path / "a.inp")


def seeds(tmp_path):
    """Sound files of each format."""
    part = f"*PART, NAME=P\n{BLOCK}{ENDS}*END PART\n*ASSEMBLY\n*INSTANCE, NAME=I, PART=P\n1, 0, 0\n"
    part += "*END INSTANCE\n"
    yield ".inp", (TET_INP + SETS).encode()
    yield ".inp", (part + "*NSET, NSET=x, INSTANCE=I\n1, 2\n*END ASSEMBLY\n").encode()
    yield ".inp", inp_of(box_mesh([0, 1, 2], [0, 1], [0, 1])).encode()
    for version, binary in ((2.2, False), (2.2, True), (4.0, False), (4.0, True), (4.1, False), (4.1, True)):
        yield ".msh", msh(version, binary, parametric=binary, partitioned=True)
    yield ".msh", msh41_of(box_mesh([0, 1, 2], [0, 1], [0, 1])).encode()
    yield ".bdf", bdf("small").encode()
    yield ".bdf", bdf("free").encode()
    yield ".unv", unv().encode()
    try:
        import meshio  # noqa: F401
    except ImportError:
        return
    yield ".vtk", vtk_of_gmsh().encode()
    given = meshio_of(box_mesh([0, 1], [0, 1], [0, 1]))
    for suffix in (".vtk", ".vtu"):
        given.write(tmp_path / f"seed{suffix}")
        yield suffix, (tmp_path / f"seed{suffix}").read_bytes()


WORDS = (b"-1", b"0", b"nan", b"99999999999", b"1e400", b"*", b"$", b",", b"\n", b"\0", b"\xff\xfe", b"=")


def mutant(data, chance):
    """The file with up to four bytes, words or lines changed, doubled or lost."""
    data = bytearray(data)
    for _ in range(chance.randint(1, 4)):
        at = chance.randrange(len(data) + 1)
        end = min(len(data), at + chance.choice((1, 1, 4, 30, 200)))
        what = chance.randrange(6)
        if what == 0:
            data[at:end] = b""
        elif what == 1:
            data[at:at] = chance.choice(WORDS)
        elif what == 2 and at < len(data):
            data[at] = chance.randrange(256)
        elif what == 3:
            data[at:at] = data[at:end]
        elif what == 4:
            data = data[:at] or bytearray(b" ")
        else:
            lines = bytes(data).split(b"\n")
            k = chance.randrange(len(lines))
            words = lines[k].split()
            if words:
                words[chance.randrange(len(words))] = chance.choice(WORDS)
                lines[k] = b" ".join(words)
            data = bytearray(b"\n".join(lines))
    return bytes(data)


def strangers(tmp_path, count):
    """What of `count` mutants raises something else than ValueError or OSError, or takes too long."""
    chance, found, sound = random.Random(13), [], list(seeds(tmp_path))
    for k in range(count):
        suffix, data = sound[k % len(sound)]
        file = tmp_path / f"m{suffix}"
        file.write_bytes(mutant(data, chance))
        start = time.process_time()
        try:
            read_mesh(file, upgrade=True, drop_unconnected=True, largest=1e3)
        except (ValueError, OSError) as error:
            if f"m{suffix}" not in str(error):
                found.append((k, suffix, f"does not name the file: {error}"))
        except BaseException as error:
            found.append((k, suffix, f"{type(error).__name__}: {error}"))
        if time.process_time() - start > SOON:
            found.append((k, suffix, "too slow"))
    return found


@pytest.mark.filterwarnings("ignore")  # meshio's, of files it cannot make sense of
def test_damaged_meshes_raise_value_errors_only(tmp_path):
    assert strangers(tmp_path, 500) == []


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore")
def test_ten_thousand_damaged_meshes_a_reader_raise_value_errors_only(tmp_path):
    assert strangers(tmp_path, 40_000) == []


HEX = (
    "*NODE\n1,0,0,0\n2,1,0,0\n3,1,1,0\n4,0,1,0\n5,0,0,1\n6,1,0,1\n7,1,1,1\n8,0,1,1\n"
    "*ELEMENT, TYPE=C3D8, ELSET=all\n1,1,2,3,4,5,6,7,8\n"
)


def test_a_step_that_removes_elements_is_refused_by_name(tmp_path):
    path = tmp_path / "m.inp"
    path.write_text(HEX + "*STEP\n*MODEL CHANGE, REMOVE\nall\n*END STEP\n")
    with pytest.raises(ValueError, match=r"m\.inp, line 13: \*MODEL CHANGE: it removes elements"):
        read_mesh(path, scale=0.01, upgrade=True)
    # contact pairs carry no geometry
    path.write_text(HEX + "*STEP\n*MODEL CHANGE, REMOVE, TYPE=CONTACT PAIR\na, b\n*END STEP\n")
    assert len(read_mesh(path, scale=0.01, upgrade=True).elements) == 1


@pytest.mark.parametrize("kind", ["MASS", "B31", "SPRINGA", "ROTARYI", "CONN3D2", "T3D2"])
def test_an_element_without_volume_is_told_of(kind, tmp_path):
    path = tmp_path / "m.inp"
    path.write_text(HEX + f"*ELEMENT, TYPE={kind}, ELSET=lean\n2, 1, 2\n3, 2, 3\n")
    with pytest.warns(LeftOut, match=f"m.inp: elements without volume are left out.* 2 of type {kind}"):
        read_mesh(path, scale=0.01, upgrade=True)


@pytest.mark.parametrize("card", ["CONM2,9,1,,5.0", "CBAR,9,1,1,2,0.,0.,1.", "CELAS2,9,1e6,1,1,2,1"])
def test_a_card_without_volume_is_told_of(card, tmp_path):
    nodes = "GRID,1,,0.,0.,0.\nGRID,2,,1.,0.,0.\nGRID,3,,0.,1.,0.\nGRID,4,,0.,0.,1.\n"
    path = tmp_path / "m.bdf"
    path.write_text(f"BEGIN BULK\n{nodes}CTETRA,1,1,1,2,3,4\n{card}\nENDDATA\n")
    with pytest.warns(LeftOut, match=f"m.bdf: .* 1 of type {card.split(',')[0]}"):
        read_mesh(path, scale=0.01, upgrade=True)


def test_skins_of_a_body_pass_without_a_word(tmp_path):
    path = tmp_path / "m.inp"
    path.write_text(HEX + "*ELEMENT, TYPE=S4, ELSET=skin\n2,1,2,3,4\n")
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        read_mesh(path, scale=0.01, upgrade=True)
