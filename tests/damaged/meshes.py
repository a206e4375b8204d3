"""Readers of meshes."""

from __future__ import annotations

import tempfile
from pathlib import Path

from damaged.mutations import Reader


def abaqus_mesh() -> Reader:
    import bearingdyn as bd

    def write(folder: Path) -> None:
        (folder / "m.inp").write_text(
            "*HEADING\nblock\n*NODE\n1,0,0,0\n2,1,0,0\n3,1,1,0\n4,0,1,0\n5,0,0,1\n6,1,0,1\n7,1,1,1\n8,0,1,1\n"
            "*ELEMENT, TYPE=C3D8, ELSET=all\n1,1,2,3,4,5,6,7,8\n*NSET, NSET=low, GENERATE\n1,4,1\n"
            "*NSET, NSET=top\n5,6,\n7,8\n*ELSET, ELSET=e\n1\n*SURFACE, NAME=s\ne, S1\n"
        )

    return Reader(write, lambda f: bd.read_mesh(f / "m.inp", upgrade=True))


def gmsh() -> Reader:
    import bearingdyn as bd

    def write(folder: Path) -> None:
        (folder / "m.msh").write_text(
            "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n"
            '$PhysicalNames\n2\n3 1 "body"\n2 2 "low"\n$EndPhysicalNames\n'
            "$Nodes\n4\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n$EndNodes\n$Elements\n2\n1 2 2 2 1 1 2 3\n"
            "2 4 2 1 1 1 2 3 4\n$EndElements\n"
        )

    return Reader(write, lambda f: bd.read_mesh(f / "m.msh", upgrade=True))


def mesh(*endings: str) -> Reader:
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
