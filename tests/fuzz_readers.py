"""Every reader against damaged files: seeded mutants of sound ones, read in a process of their own.

The rule: a mutant is read, or refused by a ValueError or OSError that names the file, within 5 s of processor
time and 1 GB of memory beyond what the process had; and the interpreter lives.

    python tests/fuzz_readers.py            # all readers, 200 mutants each
    python tests/fuzz_readers.py npz 10000  # one reader, more mutants

A reader is added by one function that writes sound files into a folder and returns how they are read; see
READERS. `python tests/fuzz_readers.py npz 1 4711` repeats mutant 4711 and shows the traceback.
"""

from __future__ import annotations

import functools
import io
import json
import resource
import signal
import struct
import subprocess
import sys
import tempfile
import traceback
import warnings
import zipfile
import zlib
from collections.abc import Callable
from contextlib import closing
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from measured import DATA

XLS = DATA / "formats" / "eplexor.xls"
SECONDS, BYTES = 5.0, 1 << 30
# a refused request would come out as an OSError and pass: a reader gets more, and what it takes is counted
LIMIT = 3 << 30
SEED = 20261129
# what people and broken programs write for a number
NUMBERS = [
    b"1e400", b"-1", b"0", b"nan", b"inf", b"99999999999999999999", b"9" * 400, b"2,5", b"2.0D+08", b"",
    b"\0", b"1e-400", b"0x10", b"1.5", b"1_0", b"-0", b"1e", b"2147483648", b"9223372036854775807", b"true",
    b'"a"', b"[1]", b"{}", b"null", b"\xef\xbc\x91", b"1.0-100", b"1 2", b"1;2",
]  # fmt: skip

Mutate = Callable[[bytes], bytes]


@dataclass(frozen=True)
class Reader:
    """How a damaged file is read.

    Parameters
    ----------
    write
        Writes sound files into a folder.
    read
        Reads them from there.
    inside
        Mutates what is behind a checksum or a packing: (sound file, mutation) -> file; by turns with the
        plain mutation of the bytes.
    names_file
        Whether the reader knows a file, and must name it.
    """

    write: Callable[[Path], None]
    read: Callable[[Path], Any]
    inside: Callable[[bytes, Mutate], bytes] | None = None
    names_file: bool = True


# ---------------------------------------------------------------- mutations


def mutated(data: bytes, rng: np.random.Generator) -> bytes:
    """One to three random damages."""
    for _ in range(int(rng.integers(1, 4))):
        data = _damaged(data, rng)
    return data


def _damaged(data: bytes, rng: np.random.Generator) -> bytes:
    n = len(data)
    if n == 0:
        return bytes(rng.integers(0, 256, int(rng.integers(0, 50)), dtype=np.uint8))
    a, b = sorted(int(i) for i in rng.integers(0, n + 1, 2))
    b = min(b, a + int(rng.integers(1, 200)))
    kind = int(rng.integers(0, 14))
    if kind == 0:
        flipped = bytearray(data)
        flipped[min(a, n - 1)] ^= 1 << int(rng.integers(0, 8))
        return bytes(flipped)
    if kind == 1:
        return data[:a] + bytes(rng.integers(0, 256, b - a, dtype=np.uint8)) + data[b:]
    if kind == 2:
        return data[:a] + data[b:]
    if kind == 3:
        return data[:b] + data[a:b] * int(rng.integers(1, 5)) + data[b:]
    if kind == 4:
        return data[:a]
    if kind == 5:
        return data[:a] + bytes(n - a)
    if kind == 6:
        return data[:a] + bytes(int(rng.integers(1, 9))) + data[b:]
    if kind in (7, 8, 9):
        return _number_changed(data, rng)
    lines = data.split(b"\n")
    i, j = (int(k) for k in rng.integers(0, len(lines), 2))
    if kind == 10:
        lines[i], lines[j] = lines[j], lines[i]
    elif kind == 11:
        del lines[i]
    elif kind == 12:
        lines.insert(j, lines[i])
    else:
        whole = int(rng.integers(0, 5))
        text = data.decode("latin-1")
        return [data.replace(b"\n", b"\r\n"), b"\xef\xbb\xbf" + data, text.encode("utf-16"), data.upper(),
                data.replace(b".", b",")][whole]  # fmt: skip
    return b"\n".join(lines)


def _number_changed(data: bytes, rng: np.random.Generator) -> bytes:
    digits = np.flatnonzero(np.isin(np.frombuffer(data, np.uint8), np.frombuffer(b"0123456789", np.uint8)))
    if not digits.size:
        return data
    a = b = int(rng.choice(digits))
    part = b"0123456789.+-eEdD"
    while a > 0 and data[a - 1] in part:
        a -= 1
    while b < len(data) and data[b] in part:
        b += 1
    return data[:a] + NUMBERS[int(rng.integers(0, len(NUMBERS)))] + data[b:]


# ---------------------------------------------------------------- readers


def _model() -> Any:
    import bearingdyn as bd

    mesh = bd.box_mesh([0.0, 0.05, 0.1], [0.0, 0.02], [0.0, 0.03])
    full = bd.Solid(mesh, bd.STEEL, {"a": "x-"}, f_max=0).full_model()
    return mesh, full.K.tocoo(), full.M.tocoo()


def _coordinate(A: Any, first: str, name: str) -> bytes:
    n = A.shape[0]
    lower = A.row >= A.col
    rows = zip(A.row[lower], A.col[lower], A.data[lower], strict=True)
    text = f"{first}{n} {n} {int(lower.sum())}\n" if first else ""
    return (text + "".join(f"{i + 1} {j + 1} {v:{name}}\n" for i, j, v in rows)).encode()


def _matrix_market() -> Reader:
    import bearingdyn as bd

    mesh, K, M = _model()

    def write(folder: Path) -> None:
        for name, A in (("k.mtx", K), ("m.mtx", M)):
            first = "%%MatrixMarket matrix coordinate real symmetric\n% by hand\n"
            (folder / name).write_bytes(_coordinate(A, first, ".9e"))

    return Reader(write, lambda f: bd.read_matrices(f / "k.mtx", f / "m.mtx", mesh.points))


def _matrix_market_array() -> Reader:
    import bearingdyn as bd

    mesh, K, M = _model()

    def write(folder: Path) -> None:
        for name, A in (("k.mtx", K), ("m.mtx", M)):
            n = A.shape[0]
            values = "".join(f"{v:.9e}\n" for v in A.toarray().T.ravel())
            (folder / name).write_text(f"%%MatrixMarket matrix array real general\n{n} {n}\n{values}")

    return Reader(write, lambda f: bd.read_matrices(f / "k.mtx", f / "m.mtx", mesh.points))


def _abaqus() -> Reader:
    import bearingdyn as bd

    mesh, K, M = _model()

    def write(folder: Path) -> None:
        for name, A in (("k.mtx", K), ("m.mtx", M)):
            lower = A.row >= A.col
            rows = zip(A.row[lower], A.col[lower], A.data[lower], strict=True)
            (folder / name).write_text(
                "".join(f"{i // 3 + 1},{i % 3 + 1}, {j // 3 + 1},{j % 3 + 1}, {v:.9e}\n" for i, j, v in rows)
            )

    return Reader(write, lambda f: bd.read_matrices(f / "k.mtx", f / "m.mtx", mesh.points))


def _abaqus_coordinate() -> Reader:
    import bearingdyn as bd

    mesh, K, M = _model()

    def write(folder: Path) -> None:
        for name, A in (("k.mtx", K), ("m.mtx", M)):
            (folder / name).write_bytes(_coordinate(A, "", ".9e"))

    return Reader(write, lambda f: bd.read_matrices(f / "k.mtx", f / "m.mtx", mesh.points))


def _calculix() -> Reader:
    import bearingdyn as bd

    mesh, K, M = _model()

    def write(folder: Path) -> None:
        for name, A in (("k.sti", K), ("k.mas", M)):
            (folder / name).write_bytes(_coordinate(A, "", ".9e"))
        (folder / "k.dof").write_text("".join(f"{i // 3 + 1}.{i % 3 + 1}\n" for i in range(K.shape[0])))

    return Reader(write, lambda f: bd.read_matrices(f / "k.sti", points=mesh.points))


def _npz() -> Reader:
    import bearingdyn as bd

    mesh, K, M = _model()

    def write(folder: Path) -> None:
        labels = [(i // 3 + 1, i % 3 + 1) for i in range(K.shape[0])]
        parts = {f"K_{part}": getattr(K.tocsr(), part) for part in ("data", "indices", "indptr", "shape")}
        np.savez_compressed(
            folder / "m.npz", **parts, M=M.toarray(), points=mesh.points, labels=labels, internal=0
        )

    def inside(data: bytes, mutate: Mutate) -> bytes:
        with zipfile.ZipFile(io.BytesIO(data)) as archive:
            held = {name: archive.read(name) for name in archive.namelist()}
        name = sorted(held)[zlib.crc32(mutate(b"which")) % len(held)]
        whole = held[name]
        # the header of an array is where sizes and kinds stand
        held[name] = mutate(whole[:128]) + whole[128:] if len(whole) % 2 else mutate(whole)
        made = io.BytesIO()
        with zipfile.ZipFile(made, "w") as archive:
            for entry, content in held.items():
                archive.writestr(entry, content)
        return made.getvalue()

    return Reader(write, lambda f: bd.read_matrices(f / "m.npz"), inside)


def _op4() -> Reader:
    from pyyeti.nastran import op4

    import bearingdyn as bd

    mesh, K, M = _model()

    def write(folder: Path) -> None:
        op4.write(str(folder / "m.op4"), {"KGG": K.toarray(), "MGG": M.toarray()}, binary=False)

    return Reader(write, lambda f: bd.read_matrices(f / "m.op4", points=mesh.points))


def _nodes() -> Reader:
    from bearingdyn.fem import read_nodes

    def write(folder: Path) -> None:
        (folder / "n.inp").write_text(
            "*HEADING\nx\n*NODE, NSET=all\n1, 0., 0., 1.\n2, 1., , 3.\n*NODE\n3, 1.5E-3, 2., 4.,\n"
        )

    return Reader(write, lambda f: read_nodes(f / "n.inp"))


def _result(folder: Path) -> None:
    import xarray

    import bearingdyn as bd

    t = np.linspace(0.0, 1.0, 50)
    data = xarray.Dataset(
        {"x": ("t", t, {"units": "m"}), "z": ("t", np.exp(1j * t))},
        {"t": t, "name": ("t", [f"p{i}" for i in range(50)])},
        {"inputs": "{}"},
    )
    bd.save({"a": data, "b": data.isel(t=slice(5))}, folder / "r.nc")


def _sealed(data: bytes, mutate: Mutate) -> bytes:
    """A result file damaged before it was sealed."""
    from bearingdyn.results import file_seal

    content = mutate(data[: -file_seal.LENGTH])
    return content + file_seal.seal(content)


def _netcdf() -> Reader:
    from bearingdyn.results import groups, open_result

    def read(folder: Path) -> None:
        for name in groups(folder / "r.nc") or [""]:
            open_result(folder / "r.nc", name)

    return Reader(_result, read, _sealed)


def _hdf5_of_old() -> Reader:
    """A file of another program: no seal, and headers of HDF5's first kind, which carry no checksum."""
    import h5py

    from bearingdyn.results import open_result

    def write(folder: Path) -> None:
        with h5py.File(folder / "o.nc", "w", libver="earliest") as file:
            t = file.create_dataset("t", data=np.linspace(0.0, 1.0, 50))
            t.make_scale("t")
            for name, values in (("x", np.arange(50.0)), ("n", [f"p{i}" for i in range(50)])):
                made = file.create_dataset(name, data=values)
                made.dims[0].attach_scale(t)
                made.attrs["units"] = "m"
            packed = file.create_dataset("c", data=np.arange(50.0), chunks=(20,), compression="gzip")
            packed.dims[0].attach_scale(t)
            file.attrs["made_by"] = "another program"

    def of_its_length(data: bytes, mutate: Mutate) -> bytes:
        # another length is refused before HDF5 looks
        return mutate(data).ljust(len(data), b"\0")[: len(data)]

    return Reader(write, lambda f: open_result(f / "o.nc"), of_its_length)


def _show() -> Reader:
    """The command says in one line what is wrong, and names the file, whatever is in it."""
    import contextlib

    from bearingdyn.cli import main

    def read(folder: Path) -> None:
        said = io.StringIO()
        with contextlib.redirect_stderr(said), contextlib.redirect_stdout(io.StringIO()):
            code = main(["show", str(folder / "r.nc")])
        if code:
            raise ValueError(said.getvalue())

    return Reader(_result, read, _sealed)


def _run() -> Reader:
    import bearingdyn as bd
    from bearingdyn import run_file
    from bearingdyn.results import open_result

    def write(folder: Path) -> None:
        app = bd.Application()
        app.add("m", bd.RigidBody(1.0, (1e-3, 1e-3, 1e-3)))
        app.ground("m.centre", stiffness=[1e6] * 6)
        (folder / "x.run").unlink(missing_ok=True)
        bd.transient(app, speed=0.0, dt=1e-5, steps=60, record=["m.centre.y"], stream=folder / "x.run")

    def inside(data: bytes, mutate: Mutate) -> bytes:
        at, blocks = len(run_file.MAGIC), []
        while at < len(data):
            length = struct.unpack_from("<QI", data, at)[0]
            blocks.append(data[at + 12 : at + 12 + length])
            at += 12 + length
        k = zlib.crc32(mutate(b"which")) % len(blocks)
        front = mutate(blocks[k][:200])  # where sizes and counts stand
        blocks[k] = front + blocks[k][200:]
        made = run_file.MAGIC
        for block in blocks:
            place = struct.pack("<QQ", len(made), len(block))
            made += struct.pack("<QI", len(block), zlib.crc32(place + block)) + block
        return made

    return Reader(write, lambda f: open_result(f / "x.run"), inside)


def _store() -> Reader:
    from bearingdyn.study.cases import Case
    from bearingdyn.study.store import Store

    case = Case({"x": 1.0, "name": "a"}, {"y": 2.0})

    # closed, since a file that is cut while SQLite has it mapped ends the process
    def write(folder: Path) -> None:
        with closing(Store(folder, json.dumps)) as store:
            store.write(case)

    def read(folder: Path) -> None:
        with closing(Store(folder, json.dumps)) as store:
            store.read([case.parameters])

    return Reader(write, read)


def _material() -> Reader:
    import bearingdyn as bd

    rubber = bd.Maxwell(1e6, [2e6, 1e6], [1e-3, 1e-2], K=2e9, density=1200.0)

    def write(folder: Path) -> None:
        (folder / "m.json").write_text(rubber.to_json())

    def read(folder: Path) -> None:
        bd.Maxwell.from_json((folder / "m.json").read_text(encoding="utf-8"))

    return Reader(write, read, names_file=False)


def _dma() -> Reader:
    import bearingdyn as bd

    rows = "".join(
        f"{T},{f},{2e6 * (1 + f / 50 - T / 200):.4e},{3e5 * (1 + f / 100):.4e}\n"
        for T in (-10, 0, 10, 20)
        for f in (1.0, 3.0, 10.0, 30.0)
    )

    def write(folder: Path) -> None:
        head = "temperature_C,frequency_Hz,G_storage_Pa,G_loss_Pa\n"
        (folder / "d.csv").write_text(head + rows)

    return Reader(write, lambda f: bd.read_dma(f / "d.csv"))


def _abaqus_mesh() -> Reader:
    import bearingdyn as bd

    def write(folder: Path) -> None:
        (folder / "m.inp").write_text(
            "*HEADING\nblock\n*NODE\n1,0,0,0\n2,1,0,0\n3,1,1,0\n4,0,1,0\n5,0,0,1\n6,1,0,1\n7,1,1,1\n8,0,1,1\n"
            "*ELEMENT, TYPE=C3D8, ELSET=all\n1,1,2,3,4,5,6,7,8\n*NSET, NSET=low, GENERATE\n1,4,1\n"
            "*NSET, NSET=top\n5,6,\n7,8\n*ELSET, ELSET=e\n1\n*SURFACE, NAME=s\ne, S1\n"
        )

    return Reader(write, lambda f: bd.read_mesh(f / "m.inp", upgrade=True))


def _gmsh() -> Reader:
    import bearingdyn as bd

    def write(folder: Path) -> None:
        (folder / "m.msh").write_text(
            "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n"
            '$PhysicalNames\n2\n3 1 "body"\n2 2 "low"\n$EndPhysicalNames\n'
            "$Nodes\n4\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n$EndNodes\n$Elements\n2\n1 2 2 2 1 1 2 3\n"
            "2 4 2 1 1 1 2 3 4\n$EndElements\n"
        )

    return Reader(write, lambda f: bd.read_mesh(f / "m.msh", upgrade=True))


def _dma_kinds() -> Reader:
    """Every kind of file that tests/fuzz_dma.py has a sound one of, each read as that file asks for."""
    import bearingdyn as bd
    from fuzz_dma import seeds

    files = [(f"seed{k}{ending}", content) for k, (ending, content) in enumerate(seeds())]

    def write(folder: Path) -> None:
        for name, content in files:
            (folder / name).write_bytes(content)

    def read(folder: Path) -> None:
        for name, content in files:
            bd.read_dma(folder / name, mode="shear" if b"tan" not in content else None)

    return Reader(write, read)


def _zip_changed(data: bytes, mutate: Mutate) -> bytes:
    """A packed file one of whose members was damaged before it was packed."""
    made = io.BytesIO()
    with zipfile.ZipFile(io.BytesIO(data)) as old, zipfile.ZipFile(made, "w") as new:
        members = old.infolist()
        k = zlib.crc32(mutate(b"which")) % len(members)
        for i, member in enumerate(members):
            content = old.read(member.filename)
            new.writestr(member.filename, mutate(content) if i == k else content, member.compress_type)
    return made.getvalue()


def _xlsx() -> Reader:
    import openpyxl

    import bearingdyn as bd

    def write(folder: Path) -> None:
        book = openpyxl.Workbook()
        book.active.append(["frequency_Hz", "temperature_C", "G_storage_Pa", "G_loss_Pa"])
        for T in (20.0, 40.0):
            for f in (0.1, 0.3, 1.0, 3.0, 10.0):
                book.active.append([f, T, 5e6 * f**0.1 - 1e4 * T, 1e6 * f**0.1])
        book.save(folder / "d.xlsx")

    return Reader(write, lambda f: bd.read_dma(f / "d.xlsx"), _zip_changed)


def _xls() -> Reader:
    import bearingdyn as bd

    def write(folder: Path) -> None:
        (folder / "d.xls").write_bytes(XLS.read_bytes())

    return Reader(write, lambda f: bd.read_dma(f / "d.xls"))


def _mesh(*endings: str) -> Reader:
    """Sound meshes of these endings, those of tests/fem/test_mesh_hostile.py."""
    import bearingdyn as bd
    from fem.test_mesh_hostile import seeds

    with tempfile.TemporaryDirectory() as place:
        files = [(f"m{k}{ending}", data) for k, (ending, data) in enumerate(seeds(Path(place)))]
    files = [(name, data) for name, data in files if Path(name).suffix in endings]

    def write(folder: Path) -> None:
        for name, data in files:
            (folder / name).write_bytes(data)

    def read(folder: Path) -> None:
        for name, _ in files:
            bd.read_mesh(folder / name, upgrade=True, drop_unconnected=True, largest=1e3)

    return Reader(write, read)


@dataclass(frozen=True)
class Reduced:
    """A part that has been reduced: what costs the time of a mutant is then its reading."""

    layer: Any

    def superelement(self) -> Any:
        return _superelement(self.layer)


@functools.cache
def _superelement(layer: Any) -> Any:
    return layer.superelement()


def _kept_part() -> Reader:
    """A reduced part kept in a folder: one that is damaged is reduced anew, or named."""
    import bearingdyn as bd
    from bearingdyn.cms import kept_superelement
    from bearingdyn.kept_arrays import START, kept

    rubber = bd.Maxwell(1e6, [1e6, 2e6], [1e-2, 1e-4], K=2e9, density=1150.0)
    part = Reduced(bd.Layer(0.026, 0.030, 0.015, rubber))

    def read(folder: Path) -> None:
        kept_superelement(part, folder)

    return Reader(read, read, lambda data, mutate: kept(_zip_changed(data[START:], mutate)))


def _strain_sweep() -> Reader:
    import bearingdyn as bd

    rows = "".join(
        f"{g:g},{4e6 / (1 + g / 5):.4e},{6e5 / (1 + g / 9):.4e},10\n" for g in (0.1, 0.3, 1.0, 3.0, 10.0)
    )

    def write(folder: Path) -> None:
        head = "strain (%),storage modulus (Pa),loss modulus (Pa),frequency (Hz)\n"
        (folder / "s.csv").write_text(head + rows)

    return Reader(write, lambda f: bd.read_strain_sweep(f / "s.csv", mode="shear", temperature=20.0))


def _model_file() -> Reader:
    """A small machine as a model, read and its equilibrium found, with the table of its rubber."""
    import bearingdyn as bd

    text = """format = 1
title = "a rotor"
[parameters]
load = 100.0
[materials.rubber]
type = "Maxwell"
G0 = 1e6
G = [2e6]
tau = [1e-3]
K = 2e9
density = 1100.0
[parts.rotor]
type = "RigidBody"
mass = 4.0
inertia = [0.02, 0.02, 0.004]
rotating = true
[bearings.b]
designation = "6205"
clearance = "10 µm"
inner = "rotor.centre"
outer = "ground"
[[loads]]
at = "rotor.centre"
force = [0, -100.0, 20.0, 0, 0, 0]
"""

    def write(folder: Path) -> None:
        (folder / "m.toml").write_text(text, encoding="utf-8")

    return Reader(write, lambda f: bd.read_model(f / "m.toml"))


def _ross() -> Reader:
    import bearingdyn as bd

    steel = {"name": "steel", "rho": 7810, "E": 211e9, "G_s": 81.2e9}
    shaft = {
        f"ShaftElement_{k}": {
            "L": 0.25, "idl": 0.0, "odl": 0.05, "idr": 0.0, "odr": 0.05, "n": k, "axial_force": 0,
            "torque": 0,
            "shear_effects": True, "rotary_inertia": True, "gyroscopic": True, "alpha": 0, "beta": 0,
            "material": steel,
        }
        for k in range(3)
    }  # fmt: skip
    more = {
        "DiskElement_a": {"n": 1, "m": 32.6, "Id": 0.178, "Ip": 0.329},
        **{
            f"BearingElement_{n}": {"n": n, "kxx": [1e6], "kyy": [1e6], "cxx": [10.0], "cyy": [10.0]}
            for n in (0, 3)
        },
    }

    def write(folder: Path) -> None:
        (folder / "r.json").write_text(json.dumps({"parameters": {}, **shaft, **more}, indent=1))

    return Reader(write, lambda f: bd.read_ross(f / "r.json", f_max=1e3))


def _wav() -> Reader:
    from bearingdyn import sound

    def write(folder: Path) -> None:
        for bits in (16, 32):
            sound.write_wav(folder / f"{bits}.wav", np.sin(np.arange(400.0)), 8000, bits=bits, full_scale=2.0)

    def read(folder: Path) -> None:
        for bits in (16, 32):
            sound.read_wav(folder / f"{bits}.wav")

    return Reader(write, read)


def _map_store() -> Reader:
    """The finished searches of a speed map: one that is damaged is searched anew, or named."""
    import bearingdyn as bd
    from bearingdyn.kept_arrays import START, kept

    app = bd.Application()
    app.add("r", bd.RigidBody(4.0, (0.02, 0.02, 0.004), rotating=True))
    app.ground("r.centre", stiffness=(0, 0, 1e6, 1e3, 1e3, 0), damping=(10, 10, 10, 1, 1, 0))
    ball = bd.catalogue.bearing("6205", clearance=0.0, damping=200.0)
    app.bearing("b", ball, inner="r.centre", outer="ground")
    app.load("r.centre", (0, -200.0, 0, 0, 0, 0))
    eq = bd.equilibrium(app)
    asked = {"speeds": (200.0, 210.0), "record": ["r.centre.y"], "harmonics": 4, "points": 3}

    def read(folder: Path) -> None:
        bd.speed_map(eq, **asked, several=False, doublings=0, store=folder, progress=False)

    def inside(data: bytes, mutate: Mutate) -> bytes:
        return kept(mutate(data[START:]))

    return Reader(read, read, inside)


READERS: dict[str, Callable[[], Reader]] = {
    "matrix_market": _matrix_market,
    "matrix_market_array": _matrix_market_array,
    "abaqus_matrices": _abaqus,
    "abaqus_coordinate": _abaqus_coordinate,
    "calculix": _calculix,
    "npz": _npz,
    "op4": _op4,
    "nodes": _nodes,
    "netcdf": _netcdf,
    "hdf5_of_old": _hdf5_of_old,
    "show": _show,
    "run": _run,
    "store": _store,
    "material": _material,
    "dma": _dma,
    "dma_kinds": _dma_kinds,
    "abaqus_mesh": _abaqus_mesh,
    "gmsh": _gmsh,
    "mesh_inp": functools.partial(_mesh, ".inp"),
    "mesh_msh": functools.partial(_mesh, ".msh"),
    "mesh_bdf": functools.partial(_mesh, ".bdf"),
    "mesh_unv": functools.partial(_mesh, ".unv"),
    "mesh_vtk": functools.partial(_mesh, ".vtk"),
    "mesh_vtu": functools.partial(_mesh, ".vtu"),
    "xlsx": _xlsx,
    "xls": _xls,
    "kept_part": _kept_part,
    "strain_sweep": _strain_sweep,
    "model": _model_file,
    "ross": _ross,
    "wav": _wav,
    "map_store": _map_store,
}


# ---------------------------------------------------------------- the run


class TooLongError(BaseException):
    """Beyond SECONDS; no reader may catch it."""


def _alarm(*_: object) -> None:
    raise TooLongError


def sound_files(reader: Reader, folder: Path) -> dict[str, bytes]:
    reader.write(folder)
    return {path.name: path.read_bytes() for path in sorted(folder.iterdir())}


def mutant(reader: Reader, files: dict[str, bytes], number: int) -> tuple[str, bytes]:
    """Name and content of the damaged file of mutant `number`."""
    rng = np.random.default_rng([SEED, number])
    name = sorted(files)[int(rng.integers(0, len(files)))]
    if reader.inside is not None and number % 2:
        return name, reader.inside(files[name], lambda data: mutated(data, rng))
    return name, mutated(files[name], rng)


def trial(reader: Reader, folder: Path, files: dict[str, bytes], number: int) -> str:
    """What mutant `number` did against the rule; empty where it did nothing."""
    name, content = mutant(reader, files, number)
    (folder / name).write_bytes(content)
    before = _most_memory()
    signal.setitimer(signal.ITIMER_PROF, SECONDS)
    try:
        reader.read(folder)
        if (taken := _most_memory(False) - before) > BYTES:
            return f"{taken / 1e6:.0f} MB"
    except (ValueError, OSError) as error:
        if (taken := _most_memory(False) - before) > BYTES:
            return f"{taken / 1e6:.0f} MB for {error!s:.200}"
        if reader.names_file and not any(known in str(error) for known in files):
            return f"{type(error).__name__} names no file: {error!s:.200}"
    except TooLongError:
        return f"more than {SECONDS} s\n{traceback.format_exc(limit=-4)}"
    except BaseException as error:
        return f"{type(error).__name__}: {error!s:.200}\n{traceback.format_exc(limit=-3)}"
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0.0)
        (folder / name).write_bytes(files[name])
        for path in folder.iterdir():
            if path.name not in files:
                path.unlink()
    return ""


def _most_memory(anew: bool = True) -> int:
    """Most memory this process has held, bytes; `anew`: what it holds now, from where the most is counted."""
    if anew:
        Path("/proc/self/clear_refs").write_text("5")
    status = Path("/proc/self/status").read_text()
    return 1024 * int(status.split("VmHWM:")[1].split()[0])


def _end_soon() -> None:
    """Have the process ended after 4 SECONDS more of processor time: no alarm reaches what is not Python."""
    used = resource.getrusage(resource.RUSAGE_SELF)
    _, hard = resource.getrlimit(resource.RLIMIT_CPU)
    resource.setrlimit(resource.RLIMIT_CPU, (int(used.ru_utime + used.ru_stime + 4 * SECONDS), hard))


def child(name: str, first: int, last: int) -> None:
    """Trials of a reader; a line with the number of each, and JSON after one that breaks the rule."""
    warnings.simplefilter("ignore")
    reader = READERS[name]()
    signal.signal(signal.SIGPROF, _alarm)
    with tempfile.TemporaryDirectory() as place:
        folder = Path(place)
        files = sound_files(reader, folder)
        reader.read(folder)  # the sound one must pass, and loads what is loaded late
        used = int(Path("/proc/self/statm").read_text().split()[0]) * resource.getpagesize()
        resource.setrlimit(resource.RLIMIT_AS, (used + LIMIT, resource.RLIM_INFINITY))
        for number in range(first, last):
            print(number, flush=True)
            _end_soon()
            wrong = trial(reader, folder, files, number)
            if wrong:
                print(json.dumps([number, wrong]), flush=True)


def fuzz(name: str, count: int, first: int = 0) -> list[tuple[int, str]]:
    """Number and fault of each mutant of a reader that breaks the rule."""
    faults: list[tuple[int, str]] = []
    last = first + count
    while first < last:
        run = subprocess.run(
            [sys.executable, __file__, "--child", name, str(first), str(last)],
            capture_output=True, text=True, check=False,
        )  # fmt: skip
        lines = run.stdout.splitlines()
        faults += [tuple(json.loads(line)) for line in lines if line.startswith("[")]
        begun = [int(line) for line in lines if line.isdigit()]
        if run.returncode == 0:
            return faults
        if not begun:
            raise RuntimeError(f"reader {name} does not read its sound files:\n{run.stderr}")
        faults.append((begun[-1], f"the process died ({run.returncode}): {run.stderr[-500:]}"))
        first = begun[-1] + 1
    return faults


def main(argv: list[str]) -> int:
    if argv[:1] == ["--child"]:
        child(argv[1], int(argv[2]), int(argv[3]))
        return 0
    names = argv[:1] or list(READERS)
    count = int(argv[1]) if len(argv) > 1 else 200
    first = int(argv[2]) if len(argv) > 2 else 0
    broken = 0
    for name in names:
        faults = fuzz(name, count, first)
        broken += len(faults)
        print(f"{name}: {count} mutants, {len(faults)} outside the rule", flush=True)
        for number, fault in faults[:8]:
            print(f"  {number}: {fault}")
    return int(broken > 0)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
