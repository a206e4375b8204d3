"""MatrixMarket files (.mtx)."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import scipy

from bearingdyn.fem.exchange.matrices import FEMatrices, Points, check_matrices
from bearingdyn.fem.exchange.text import existing


def is_matrix_market(path: Path) -> bool:
    """Whether a file begins as MatrixMarket does."""
    with path.open("rb") as stream:
        return stream.read(14).lower() == b"%%matrixmarket"


def read_matrix_market(
    stiffness: str | Path, mass: str | Path, points: Points | None = None, **check: Any
) -> FEMatrices:
    """Read a stiffness and a mass matrix from two MatrixMarket files (.mtx).

    points and the rest: as in check_matrices.
    Raises ValueError for a file that is not there, not MatrixMarket, or fails check_matrices.
    """
    files = [existing(stiffness), existing(mass)]
    return check_matrices(_read(files[0]), _read(files[1]), points, **check)


def _read(path: Path) -> Any:
    try:
        return scipy.io.mmread(path)
    except (ValueError, OSError, StopIteration, OverflowError) as error:
        raise ValueError(f"{path} cannot be read as a MatrixMarket file: {error}") from error
