"""One door to the files of other programs."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from bearingdyn.checks import existing
from bearingdyn.fem.matrix_files.abaqus import read_abaqus, read_nodes
from bearingdyn.fem.matrix_files.calculix import read_calculix
from bearingdyn.fem.matrix_files.fe_matrices import FEMatrices, Points
from bearingdyn.fem.matrix_files.matrix_market import is_matrix_market, read_matrix_market
from bearingdyn.fem.matrix_files.nastran import read_op4
from bearingdyn.fem.matrix_files.npz import read_npz


def read_matrices(
    stiffness: str | Path,
    mass: str | Path | None = None,
    points: Points | str | Path | None = None,
    **check: Any,
) -> FEMatrices:
    """Read and check the matrices of another program; the suffix of the file says which.

    .npz: NumPy archive, one file. .op4: Nastran, one file or two. .sti: CalculiX, with its .mas and .dof
    beside it. .mtx: MatrixMarket or Abaqus, as its first line says, two files.

    Parameters
    ----------
    stiffness, mass
        Paths of the files.
    points
        Positions of the nodes, as in check_matrices, or the path of an .inp with *NODE blocks.
    **check
        expected_mass, kg, units, internal, labels and sound, as in check_matrices; for .op4 also the
        matrices' names, as in read_op4.

    Returns
    -------
    FEMatrices

    Raises
    ------
    ValueError
        For an unknown suffix or a second file that is missing, and where the reader of the format does.
    """
    path = existing(stiffness)
    if isinstance(points, str | Path):
        points = read_nodes(points)
    kind = path.suffix.lower()
    if kind == ".op4":
        return read_op4(path, mass, points, **check)
    if kind == ".npz":
        if mass is not None:
            raise ValueError(f"{path} holds both matrices; leave mass={str(mass)!r} out")
        return read_npz(path, points, **check)
    if kind == ".sti":
        return read_calculix(path, mass, points, **check)
    if kind != ".mtx":
        raise ValueError(f"{path} ends in {kind!r}; known are .npz, .op4, .sti and .mtx")
    if mass is None:
        raise ValueError(f"{path} holds the stiffness alone; name the file of the mass matrix too")
    if is_matrix_market(path):
        return read_matrix_market(path, mass, points, **check)
    return read_abaqus(path, mass, points, **check)
