"""CalculiX: the files .sti, .mas and .dof of *FREQUENCY, SOLVER=MATRIXSTORAGE.

A line of .sti and .mas is row, column, value, of the upper triangle; a line of .dof is node.direction.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from bearingdyn.checks import existing
from bearingdyn.fem.matrix_files.fe_matrices import FEMatrices, Points, check_matrices
from bearingdyn.fem.matrix_files.text_tables import columns, symmetric_from, whole


def read_calculix(
    stiffness: str | Path,
    mass: str | Path | None = None,
    points: Points | None = None,
    **check: Any,
) -> FEMatrices:
    """Read what CalculiX stores: name.sti, name.mas and name.dof.

    CalculiX leaves out the coordinates that it removed (*BOUNDARY, dependent ones of *EQUATION and *RIGID
    BODY). A body with points must be free: store its model without these keywords.

    Parameters
    ----------
    stiffness
        Path of the .sti; the .dof must lie beside it.
    mass
        Path of the .mas; None: beside the .sti.
    points
        Positions of the nodes as in check_matrices; read_nodes reads them from the .inp.
    check
        Further arguments of check_matrices.

    Raises
    ------
    ValueError
        For files that do not exist or do not fit each other, or where check_matrices does.
    """
    sti = existing(stiffness)
    mas = existing(sti.with_suffix(".mas") if mass is None else mass)
    dof = existing(sti.with_suffix(".dof"))
    labels = _labels(dof)
    matrices: list[Any] = []
    for path in (sti, mas):
        table = columns(path, None, (3,), "a CalculiX matrix")
        index = whole(path, table[:, :2]) - 1
        if index.min() < 0 or index.max() >= len(labels):
            raise ValueError(f"{path} has rows up to {index.max() + 1}, while {dof} names {len(labels)}")
        matrices.append(symmetric_from(index[:, 0], index[:, 1], table[:, 2], len(labels)))
    return check_matrices(matrices[0], matrices[1], points, labels=labels, **check)


def _labels(path: Path) -> np.ndarray:
    """Node and direction of each row, (n, 2)."""
    try:
        pairs = [line.split(".") for line in path.read_text(encoding="ascii").split()]
        labels = np.array([(int(node), int(direction)) for node, direction in pairs], dtype=np.intp)
    except ValueError as error:
        raise ValueError(f"{path} has a line that is not node.direction: {error}") from error
    if not labels.size:
        raise ValueError(f"{path} is empty; it must name node.direction of each row")
    return labels
