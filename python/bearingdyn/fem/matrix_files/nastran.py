"""Nastran: output4 files (.op4), read with pyyeti."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from bearingdyn.checks import existing
from bearingdyn.fem.matrix_files.fe_matrices import FEMatrices, Points
from bearingdyn.fem.matrix_files.free_body_checks import checked_files


def read_op4(
    path: str | Path,
    mass_path: str | Path | None = None,
    points: Points | None = None,
    *,
    names: tuple[str, str] = ("KGG", "MGG"),
    coordinates: str | None = None,
    **check: Any,
) -> FEMatrices:
    """Read Nastran's stiffness and mass matrix from one output4 file, or from two.

    KGG and MGG have six coordinates a grid, in the basic system when no grid has another.

    Parameters
    ----------
    path, mass_path
        Paths of the stiffness and of the mass; None: both are in one file.
    points
        (k, 3) positions in the order of the matrices' grids.
    names
        Names of stiffness and mass in the file.
    coordinates
        Name of a (k, 3) matrix of the grids' positions in the file, in place of points.
    check
        Further arguments of check_matrices.

    Raises
    ------
    FileNotFoundError
        If there is no such file.
    ValueError
        For a file that is not output4 or lacks a named matrix, and where check_matrices does.
    ImportError
        Without pyyeti.
    """
    try:
        from pyyeti.nastran import op4
    except ImportError as error:
        raise ImportError("reading .op4 needs pyyeti: pip install bearingdyn[op4]") from error

    def content(given: str | Path) -> dict[str, Any]:
        file = existing(given)
        try:
            return {key.upper(): value for key, value in op4.read(str(file), sparse=None).items()}
        except Exception as error:  # pyyeti raises whatever a misread header leads to
            raise ValueError(f"{file} cannot be read as a Nastran output4 file: {error}") from error

    def named(matrices: dict[str, Any], name: str, where: str | Path) -> Any:
        if name.upper() not in matrices:
            raise ValueError(f"{where} has no matrix {name!r}; it has {sorted(matrices)}")
        return matrices[name.upper()]

    first = content(path)
    other = first if mass_path is None else content(mass_path)
    K, M = named(first, names[0], path), named(other, names[1], path if mass_path is None else mass_path)
    if points is None and coordinates is not None:
        points = np.asarray(named(first, coordinates, path), dtype=np.float64)
    return checked_files([path, path if mass_path is None else mass_path], K, M, points, **check)
