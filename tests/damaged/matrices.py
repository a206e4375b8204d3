"""Readers of matrices of other programs."""

from __future__ import annotations

import io
import zipfile
import zlib
from pathlib import Path
from typing import Any

import numpy as np

from damaged.mutations import Mutate, Reader


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


def matrix_market() -> Reader:
    import bearingdyn as bd

    mesh, K, M = _model()

    def write(folder: Path) -> None:
        for name, A in (("k.mtx", K), ("m.mtx", M)):
            first = "%%MatrixMarket matrix coordinate real symmetric\n% by hand\n"
            (folder / name).write_bytes(_coordinate(A, first, ".9e"))

    return Reader(write, lambda f: bd.read_matrices(f / "k.mtx", f / "m.mtx", mesh.points))


def matrix_market_array() -> Reader:
    import bearingdyn as bd

    mesh, K, M = _model()

    def write(folder: Path) -> None:
        for name, A in (("k.mtx", K), ("m.mtx", M)):
            n = A.shape[0]
            values = "".join(f"{v:.9e}\n" for v in A.toarray().T.ravel())
            (folder / name).write_text(f"%%MatrixMarket matrix array real general\n{n} {n}\n{values}")

    return Reader(write, lambda f: bd.read_matrices(f / "k.mtx", f / "m.mtx", mesh.points))


def abaqus() -> Reader:
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


def abaqus_coordinate() -> Reader:
    import bearingdyn as bd

    mesh, K, M = _model()

    def write(folder: Path) -> None:
        for name, A in (("k.mtx", K), ("m.mtx", M)):
            (folder / name).write_bytes(_coordinate(A, "", ".9e"))

    return Reader(write, lambda f: bd.read_matrices(f / "k.mtx", f / "m.mtx", mesh.points))


def calculix() -> Reader:
    import bearingdyn as bd

    mesh, K, M = _model()

    def write(folder: Path) -> None:
        for name, A in (("k.sti", K), ("k.mas", M)):
            (folder / name).write_bytes(_coordinate(A, "", ".9e"))
        (folder / "k.dof").write_text("".join(f"{i // 3 + 1}.{i % 3 + 1}\n" for i in range(K.shape[0])))

    return Reader(write, lambda f: bd.read_matrices(f / "k.sti", points=mesh.points))


def npz() -> Reader:
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


def op4() -> Reader:
    from pyyeti.nastran import op4

    import bearingdyn as bd

    mesh, K, M = _model()

    def write(folder: Path) -> None:
        op4.write(str(folder / "m.op4"), {"KGG": K.toarray(), "MGG": M.toarray()}, binary=False)

    return Reader(write, lambda f: bd.read_matrices(f / "m.op4", points=mesh.points))


def nodes() -> Reader:
    from bearingdyn.fem import read_nodes

    def write(folder: Path) -> None:
        (folder / "n.inp").write_text(
            "*HEADING\nx\n*NODE, NSET=all\n1, 0., 0., 1.\n2, 1., , 3.\n*NODE\n3, 1.5E-3, 2., 4.,\n"
        )

    return Reader(write, lambda f: read_nodes(f / "n.inp"))
