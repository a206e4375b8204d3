"""Meshes of solids from files: gmsh, Abaqus, CalculiX and VTK."""

from __future__ import annotations

import os
from collections.abc import Sequence

from bearingdyn.checks import existing
from bearingdyn.fem.mesh_files.abaqus import read_inp
from bearingdyn.fem.mesh_files.gmsh import read_msh
from bearingdyn.fem.mesh_files.ideas import read_unv
from bearingdyn.fem.mesh_files.nastran import read_bdf
from bearingdyn.fem.mesh_files.raw_mesh import finished
from bearingdyn.fem.mesh_files.vtk import read_with_meshio
from bearingdyn.fem.meshes.solid_mesh import SolidMesh
from bearingdyn.plausible_ranges import LARGEST_BODY

READERS = {".inp": read_inp, ".bdf": read_bdf, ".nas": read_bdf, ".unv": read_unv}
OTHERS = {".dat": "Nastran or Ansys", ".fem": "OptiStruct", ".med": "Salome", ".cdb": "Ansys"}


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
    """Read a mesh of solids from a file, of second-order elements; the suffix says the kind of file.

    .msh: gmsh 2.2, 4.0 and 4.1, text and binary; physical volumes are regions, physical surfaces are surfaces
    (with region_data="gmsh:geometrical" the entities of the drawing, by number).
    .inp: Abaqus and CalculiX, flat or an assembly of parts; regions are the sets of *SOLID SECTION, or those
    that divide the body; surfaces are node sets, *SURFACE, and sets of shell or plane elements.
    .bdf, .nas: Nastran; the numbers of properties name regions of solids and surfaces of shells.
    .unv: I-deas; its groups, or else the numbers of properties.
    .vtk, .vtu: the numbers in region_data make regions of solid cells and surfaces of face cells, named by
    the number; a point array of 0 and 1 makes a surface of its name.
    .vtk and .vtu need meshio (pip install bearingdyn[mesh]).

    Parameters
    ----------
    path
        Path of the file.
    scale
        Length of the file's unit, m; 1e-3 for a file in mm.
    regions
        Names of the sets that are regions, for files whose sets overlap; (): one region.
    region_data
        Name of the array of cell numbers; None: "gmsh:physical", "CellEntityIds" or "region".
    upgrade
        Accept linear elements, and give them middle nodes on straight edges.
    merge
        Distance, m, below which two nodes become one; None: none do.
    drop_unconnected
        Leave out nodes that no element has.
    largest
        Length, m, above which the body is taken to be in the wrong unit.

    Raises
    ------
    ValueError
        For what SolidMesh refuses, elements of another kind, a body longer than `largest`, and a file that
        cannot be read. The message names the file and the element or node.
    """
    file = existing(path, "mesh (.msh, .inp, .vtk, .vtu)")
    suffix = file.suffix.lower()
    if suffix in OTHERS:
        raise ValueError(
            f"{file.name} has the suffix {suffix!r}, a mesh of {OTHERS[suffix]}, which is not read; "
            "export .inp, .bdf or .msh"
        )
    if suffix not in (*READERS, ".msh", ".vtk", ".vtu"):
        raise ValueError(
            f"{file.name} has the suffix {suffix!r}; meshes are .msh, .inp, .bdf, .unv, .vtk or .vtu"
        )
    try:
        if suffix in READERS:
            raw = READERS[suffix](file)
        elif suffix == ".msh":
            raw = read_msh(file, region_data)
        else:
            raw = read_with_meshio(file, region_data)
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
        if str(error).startswith(f"{file.name}, line"):
            raise
        raise ValueError(f"{file.name}: {error}") from error
