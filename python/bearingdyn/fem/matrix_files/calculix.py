"""CalculiX: the files .sti, .mas and .dof of *FREQUENCY, SOLVER=MATRIXSTORAGE.

A line of .sti and .mas is row, column, value, of the upper triangle; a line of .dof is node.direction.
"""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import numpy as np

from bearingdyn.checks import existing
from bearingdyn.fem.matrix_files.fe_matrices import FEMatrices, Points
from bearingdyn.fem.matrix_files.free_body_checks import checked_files
from bearingdyn.fem.matrix_files.text_tables import Form, symmetric_from, triples

ENTRIES = Form(
    ("count", "count", "number"), "", "*",
    "a CalculiX matrix has lines of row, column (they count from 1) and value, numbers with a point",
)  # fmt: skip
LABEL = re.compile(rb"\d{1,18}\.[1-6]")


def read_calculix(
    stiffness: str | Path,
    mass: str | Path | None = None,
    points: Points | None = None,
    **check: Any,
) -> FEMatrices:
    """Read the matrices that CalculiX stores: name.sti, name.mas and name.dof.

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
        with path.open("rb") as stream:
            row, column, value = triples(path, stream, ENTRIES)
        if max(row.max(), column.max()) >= len(labels):
            raise ValueError(
                f"{path} has rows up to {max(row.max(), column.max()) + 1}, while {dof} names {len(labels)}"
            )
        matrices.append(symmetric_from(row, column, value, len(labels)))
    return checked_files([sti, mas], matrices[0], matrices[1], points, labels=labels, **check)


def _labels(path: Path) -> np.ndarray:
    """Node and direction of each row, (n, 2)."""
    with path.open("rb") as stream:
        text = stream.read()
    lines = text.split()
    wrong = next((k for k, line in enumerate(lines) if not LABEL.fullmatch(line)), None)
    if wrong is not None:
        shown = lines[wrong][:40].decode("ascii", "replace")
        raise ValueError(f"{path}, entry {wrong + 1} is {shown!r}, which is not node.direction, such as 12.3")
    labels = np.array([[int(part) for part in line.split(b".")] for line in lines], dtype=np.intp)
    if not labels.size:
        raise ValueError(f"{path} is empty; it must name node.direction of each row")
    return labels
