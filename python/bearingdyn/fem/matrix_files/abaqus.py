"""Abaqus: text of *MATRIX GENERATE and *MATRIX OUTPUT (.mtx), and the nodes of an input file (.inp).

Formats: Abaqus Keywords Reference Guide, *MATRIX INPUT (node, direction, node, direction, value on a line,
of one triangle or both) and *MATRIX OUTPUT, FORMAT=COORDINATE (row, column, value).
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import scipy.sparse

from bearingdyn.checks import existing
from bearingdyn.fem.abaqus_input import blocks, node
from bearingdyn.fem.matrix_files.fe_matrices import FEMatrices, Points, check_matrices
from bearingdyn.fem.matrix_files.text_tables import columns, symmetric_from, whole
from bearingdyn.types import Array, Index


def read_abaqus(
    stiffness: str | Path, mass: str | Path, points: Points | None = None, **check: Any
) -> FEMatrices:
    """Read the two files (.mtx) that *MATRIX OUTPUT, STIFFNESS, MASS writes, in either of its text formats.

    Abaqus has no units: pass units=MM_TONNE for mm, t, s.

    Parameters
    ----------
    stiffness, mass
        Paths of the files.
    points
        Positions of the nodes as in check_matrices, such as read_nodes gives; there may be more nodes than
        the matrices have. Files in COORDINATE format name no nodes: points are then in the order of the rows.
    check
        Further arguments of check_matrices.

    Raises
    ------
    ValueError
        For a file that does not exist or is not of that format, for an internal variable of Abaqus (a node
        number below 1), or where check_matrices does.
    """
    files = [existing(stiffness), existing(mass)]
    K, M = (_entries(path) for path in files)
    if (K[0] is None) != (M[0] is None):
        raise ValueError(f"{files[0]} and {files[1]} are of different formats; write both in the same")
    if K[0] is None or M[0] is None:
        n = 1 + max(int(A[1].max()) for A in (K, M))
        both = [symmetric_from(index[:, 0], index[:, 1], value, n) for _, index, value in (K, M)]
        return check_matrices(both[0], both[1], points, **check)
    labels, place = np.unique(np.vstack([K[0], M[0]]), axis=0, return_inverse=True)
    place = place.ravel()
    matrices: list[scipy.sparse.csr_matrix] = []
    begin = 0
    for label, index, value in (K, M):
        assert label is not None
        own = place[begin : begin + len(label)]
        begin += len(label)
        matrices.append(symmetric_from(own[index[:, 0]], own[index[:, 1]], value, len(labels)))
    return check_matrices(matrices[0], matrices[1], points, labels=labels, **check)


def _entries(path: Path) -> tuple[Index | None, Index, Array]:
    """Labels (l, 2) of node and direction, or None; row and column (e, 2) of each entry; values (e,)."""
    with path.open(encoding="ascii", errors="replace") as stream:
        first = next((line for line in stream if line.strip() and not line.lstrip().startswith("*")), "")
    table = columns(path, "," if "," in first else None, (3, 5), "an Abaqus matrix")
    value = table[:, -1]
    if table.shape[1] == 3:
        index = whole(path, table[:, :2]) - 1
        if index.min() < 0:
            raise ValueError(f"{path} has row or column {index.min() + 1}; they count from 1")
        return None, index, value
    at = whole(path, table[:, :4])
    if at[:, [0, 2]].min() < 1:
        raise ValueError(
            f"{path} names node {at[:, [0, 2]].min()}, an internal variable of Abaqus (contact, a coupling, "
            "an incompressible element); export a model without"
        )
    labels, place = np.unique(at.reshape(-1, 2), axis=0, return_inverse=True)
    return labels, place.reshape(-1, 2), value


def read_nodes(path: str | Path) -> dict[int, tuple[float, float, float]]:
    """Node number -> position of all *NODE blocks of an input file of Abaqus or CalculiX (.inp), in its unit.

    *INCLUDE is followed.

    Raises
    ------
    ValueError
        For a file that is not there, without nodes, or with a line that is no node.
    """
    p = existing(path)
    try:
        nodes = dict(node(line) for keyword, _, lines in blocks(p) if keyword == "NODE" for line in lines)
    except ValueError as error:
        raise ValueError(f"{p}: {error}") from error
    if not nodes:
        raise ValueError(f"{p} has no *NODE block; give the input file that holds the nodes")
    return nodes
