"""Meshes of solids from files: gmsh, Abaqus, CalculiX and VTK."""

from __future__ import annotations

import os
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from bearingdyn.fem.abaqus_mesh import read_inp
from bearingdyn.fem.raw_mesh import RawMesh, finished
from bearingdyn.fem.solid_mesh import SolidMesh
from bearingdyn.magnitude import LARGEST_BODY
from bearingdyn.types import Index

SOLID = {"hexahedron": 8, "hexahedron20": 20, "hexahedron27": 27, "tetra": 4, "tetra10": 10}
FACE = ("triangle", "triangle6", "quad", "quad8", "quad9")
IGNORED = ("vertex", "line", "line3")
TAGS = ("gmsh:physical", "CellEntityIds", "region")  # arrays of numbers of groups, when none is asked for


def read_mesh(
    path: str | os.PathLike[str],
    *,
    scale: float = 1.0,
    regions: Sequence[str] | None = None,
    region_data: str | None = None,
    upgrade: bool = False,
    merge: float | None = None,
    drop_unconnected: bool = False,
    largest: float = LARGEST_BODY,
) -> SolidMesh:
    """A mesh of 20- or 27-node bricks or 10-node tetrahedra from a file, by its suffix.

    .msh: gmsh 2.2 and 4.1; physical volumes are regions, physical surfaces are surfaces.
    .inp: Abaqus and CalculiX; regions are the sets of *SOLID SECTION, or those that divide the body;
        surfaces are node sets, *SURFACE, and sets of shell or plane elements.
    .vtk, .vtu: a cell array of numbers (region_data; by default one named "gmsh:physical",
        "CellEntityIds" or "region") makes regions of solid cells and surfaces of face cells, named by the
        number; a point array of 0 and 1 makes a surface of that name.
    .msh, .vtk and .vtu need meshio (pip install bearingdyn[mesh]).

    scale: length of the file's unit, m; 1e-3 for a file in mm.
    regions: names of the sets that are regions, for files whose sets overlap; (): one region.
    upgrade: accept 8-node bricks and 4-node tetrahedra, and give them middle nodes on straight edges.
    merge: make nodes closer than this, m, one. drop_unconnected: leave out nodes that no element has.
    largest: a body longer than this, m, is taken to be in the wrong unit.

    Raises ValueError, naming the file and the element or node, for what SolidMesh refuses, elements of
    another kind, a body longer than `largest`, and a file that cannot be read.
    """
    file = Path(path)
    if not file.is_file():
        raise ValueError(f"{file} is not a file; give the path of a mesh (.msh, .inp, .vtk, .vtu)")
    suffix = file.suffix.lower()
    if suffix not in (".msh", ".inp", ".vtk", ".vtu"):
        raise ValueError(f"{file.name} has the suffix {suffix!r}; meshes are .msh, .inp, .vtk or .vtu files")
    try:
        raw = read_inp(file) if suffix == ".inp" else _converted(_read_meshio(file, suffix), region_data)
        return finished(
            raw,
            scale=scale,
            regions=regions,
            upgrade=upgrade,
            merge=merge,
            drop_unconnected=drop_unconnected,
            largest=largest,
        )
    except ValueError as error:
        raise ValueError(f"{file.name}: {error}") from error


def _read_meshio(file: Path, suffix: str) -> Any:
    try:
        from meshio import gmsh, vtk, vtu
    except ImportError as error:
        raise ImportError(f"{file.name} needs meshio to be read: pip install bearingdyn[mesh]") from error
    readers: dict[str, Any] = {".msh": gmsh.read, ".vtk": vtk.read, ".vtu": vtu.read}
    try:
        return readers[suffix](str(file))
    except Exception as error:  # meshio's readers raise whatever the fault in the file leads to
        raise ValueError(f"it cannot be read ({type(error).__name__}: {error})") from error


def _converted(mesh: Any, region_data: str | None) -> RawMesh:
    others = {b.type for b in mesh.cells} - {*SOLID, *FACE, *IGNORED}
    if others:
        raise ValueError(
            f"it has cells of type {sorted(others)}; solids are bricks or tetrahedra of one kind"
        )
    regions: dict[str, list[Index]] = {}
    surfaces: dict[str, list[Index]] = {}
    cells: list[Index] = []
    count = 0
    for k, block in enumerate(mesh.cells):
        data = np.asarray(block.data, dtype=np.intp)
        for name, at in _groups(mesh, k, region_data):
            if block.type in SOLID:
                regions.setdefault(name, []).append(count + at)
            elif block.type in FACE:
                surfaces.setdefault(name, []).append(data[at].ravel())
        if block.type in SOLID:
            cells.append(data)
            count += len(data)
    for name, values in mesh.point_data.items():
        values = np.asarray(values)
        if values.ndim == 1 and np.issubdtype(values.dtype, np.integer) and set(np.unique(values)) <= {0, 1}:
            surfaces.setdefault(name, []).append(np.flatnonzero(values))
    points = np.asarray(mesh.points, dtype=np.float64)
    return RawMesh(
        points=np.hstack([points, np.zeros((len(points), 3 - points.shape[1]))]),
        cells=tuple(cells),
        numbers=np.arange(count),
        regions={name: np.concatenate(at) for name, at in regions.items()},
        surfaces={name: np.unique(np.concatenate(at)) for name, at in surfaces.items() if len(at)},
    )


def _groups(mesh: Any, k: int, region_data: str | None) -> list[tuple[str, Index]]:
    """Groups (name, cells) of the k-th block: by name where there are names, else by number."""
    found = []
    for name, blocks in mesh.cell_sets.items():
        if not name.startswith("gmsh:") and blocks[k] is not None and len(blocks[k]):
            found.append((name, np.asarray(blocks[k], dtype=np.intp)))
    known = {name: data for name, data in mesh.cell_data.items() if data}
    if region_data is not None and region_data not in known:
        raise ValueError(f"region_data is {region_data!r}; its arrays of cells are {sorted(known)}")
    arrays = [region_data] if region_data is not None else [name for name in TAGS if name in known][:1]
    dimension = 3 if mesh.cells[k].type in SOLID else 2
    names = {int(tag): name for name, (tag, d) in mesh.field_data.items() if int(d) == dimension}
    have = {name for name, _ in found}
    for array in arrays:
        values = np.asarray(known[array][k])
        if values.ndim != 1 or not np.all(values == np.round(values)):
            raise ValueError(f"the array of cells {array!r} does not hold numbers of groups, one a cell")
        for tag in np.unique(values).astype(int).tolist():
            name = names.get(tag, str(tag))
            if name not in have and not (tag == 0 and array == "gmsh:physical"):
                found.append((name, np.flatnonzero(values == tag)))
    return found
