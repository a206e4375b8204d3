"""Readers of results, of runs, and of what is kept for a second time."""

from __future__ import annotations

import functools
import io
import json
import struct
import zlib
from contextlib import closing
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from damaged.mutations import Mutate, Reader, zip_changed


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


def netcdf() -> Reader:
    from bearingdyn.results import groups, open_result

    def read(folder: Path) -> None:
        for name in groups(folder / "r.nc") or [""]:
            open_result(folder / "r.nc", name)

    return Reader(_result, read, _sealed)


def hdf5_of_old() -> Reader:
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


def show() -> Reader:
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


def run() -> Reader:
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


def store() -> Reader:
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


@dataclass(frozen=True)
class Reduced:
    """A part that has been reduced: what costs the time of a mutant is then its reading."""

    layer: Any

    def superelement(self) -> Any:
        return _superelement(self.layer)


@functools.cache
def _superelement(layer: Any) -> Any:
    return layer.superelement()


def kept_part() -> Reader:
    """A reduced part kept in a folder: one that is damaged is reduced anew, or named."""
    import bearingdyn as bd
    from bearingdyn.cms import kept_superelement
    from bearingdyn.kept_arrays import START, kept

    rubber = bd.Maxwell(1e6, [1e6, 2e6], [1e-2, 1e-4], K=2e9, density=1150.0)
    part = Reduced(bd.Layer(0.026, 0.030, 0.015, rubber))

    def read(folder: Path) -> None:
        kept_superelement(part, folder)

    return Reader(read, read, lambda data, mutate: kept(zip_changed(data[START:], mutate)))


def wav() -> Reader:
    from bearingdyn import sound

    def write(folder: Path) -> None:
        for bits in (16, 32):
            sound.write_wav(folder / f"{bits}.wav", np.sin(np.arange(400.0)), 8000, bits=bits, full_scale=2.0)

    def read(folder: Path) -> None:
        for bits in (16, 32):
            sound.read_wav(folder / f"{bits}.wav")

    return Reader(write, read)


def map_store() -> Reader:
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
