"""Meshes in the files of VTK (.vtk, .vtu), read with meshio."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from bearingdyn.fem.mesh_files.raw_mesh import RawMesh
from bearingdyn.types import Array, Index

SOLID = {
    **{"hexahedron": 8, "hexahedron20": 20, "hexahedron27": 27, "tetra": 4, "tetra10": 10},
    **{"wedge": 6, "wedge15": 15, "wedge18": 18, "pyramid": 5, "pyramid13": 13, "pyramid14": 14},
}
FACE = ("triangle", "triangle6", "quad", "quad8", "quad9")
IGNORED = ("vertex", "line", "line3")
MIRRORED = {6: [0, 2, 1, 3, 5, 4], 15: [0, 2, 1, 3, 5, 4, 8, 7, 6, 11, 10, 9, 12, 14, 13]}  # wedges
MIRRORED[18] = [*MIRRORED[15], 17, 16, 15]
TAGS = ("gmsh:physical", "CellEntityIds", "region")  # arrays of numbers of groups, when none is asked for


def read_with_meshio(file: Path, region_data: str | None) -> RawMesh:
    """The mesh of a .vtk or .vtu file; region_data as in `read_mesh`.

    Raises
    ------
    ImportError
        Without meshio, and ValueError for a file that it cannot read.
    """
    try:
        from meshio import vtk, vtu
        from meshio._mesh import topological_dimension
    except ImportError as error:
        raise ImportError(f"{file.name} needs meshio to be read: pip install bearingdyn[mesh]") from error
    for kind in ("wedge15", "wedge18", "pyramid13", "pyramid14"):
        topological_dimension.setdefault(kind, 3)  # a table of meshio's, which lacks some of them
    readers: dict[str, Any] = {".vtk": vtk.read, ".vtu": vtu.read}
    try:
        mesh = readers[file.suffix.lower()](str(file))
    except Exception as error:  # meshio's readers raise whatever the fault in the file leads to
        raise ValueError(f"it cannot be read ({type(error).__name__}: {error})") from error
    return _converted(mesh, region_data)


def _converted(mesh: Any, region_data: str | None) -> RawMesh:
    others = {b.type for b in mesh.cells} - {*SOLID, *FACE, *IGNORED}
    if others:
        raise ValueError(
            f"it has cells of type {sorted(others)}; bricks, wedges, pyramids and tetrahedra of first and "
            "second order are read"
        )
    regions: dict[str, list[Index]] = {}
    surfaces: dict[str, list[Index]] = {}
    cells: list[Index] = []
    count = 0
    for k, block in enumerate(mesh.cells):
        data = np.asarray(block.data, dtype=np.intp)
        if data.size and not (data.min() >= 0 and data.max() < len(mesh.points)):
            raise ValueError(f"a cell of type {block.type} names a point outside 0...{len(mesh.points) - 1}")
        for name, at in _groups(mesh, k, region_data):
            if block.type in SOLID:
                regions.setdefault(name, []).append(count + at)
            elif block.type in FACE:
                surfaces.setdefault(name, []).append(data[at].ravel())
        if block.type in SOLID:
            cells.append(_upright(data, np.asarray(mesh.points, dtype=np.float64)))
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


def _upright(cells: Index, points: Array) -> Index:
    """Wedges with their first triangle below; some programs write the mirror image, as VTK's manual does."""
    if cells.shape[1] not in MIRRORED or points.shape[1] != 3:
        return cells
    a, b, c, top = (points[cells[:, k]] for k in (0, 1, 2, 3))
    below = np.einsum("ma,ma->m", np.cross(b - a, c - a), top - a) < 0
    cells = cells.copy()
    cells[below] = cells[below][:, MIRRORED[cells.shape[1]]]
    return cells


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
        values = values[:, 0] if values.ndim == 2 and values.shape[1] == 1 else values
        if values.ndim != 1 or not np.all(values == np.round(values)):
            raise ValueError(f"the array of cells {array!r} does not hold numbers of groups, one a cell")
        for tag in np.unique(values).astype(int).tolist():
            name = names.get(tag, str(tag))
            if name not in have and not (tag == 0 and array == "gmsh:physical"):
                found.append((name, np.flatnonzero(values == tag)))
    return found
