"""MatrixMarket files (.mtx)."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import scipy

from bearingdyn.checks import existing
from bearingdyn.fem.matrix_files.fe_matrices import FEMatrices, Points, check_matrices


def is_matrix_market(path: Path) -> bool:
    """Whether a file begins as MatrixMarket does."""
    with path.open("rb") as stream:
        return stream.read(14).lower() == b"%%matrixmarket"


def read_matrix_market(
    stiffness: str | Path, mass: str | Path, points: Points | None = None, **check: Any
) -> FEMatrices:
    """Read a stiffness and a mass matrix from two MatrixMarket files (.mtx).

    Parameters
    ----------
    stiffness, mass
        Paths of the files.
    points
        Positions of the nodes, as in check_matrices.
    check
        Further arguments of check_matrices.

    Raises
    ------
    ValueError
        For a file that does not exist or is not MatrixMarket, or where check_matrices does.
    """
    files = [existing(stiffness), existing(mass)]
    return check_matrices(_read(files[0]), _read(files[1]), points, **check)


def _read(path: Path) -> Any:
    try:
        return scipy.io.mmread(path)
    except (ValueError, OSError, StopIteration, OverflowError) as error:
        raise ValueError(f"{path} cannot be read as a MatrixMarket file: {error}") from error
