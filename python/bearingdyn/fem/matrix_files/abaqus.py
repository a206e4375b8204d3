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
from bearingdyn.fem.matrix_files.fe_matrices import FEMatrices, Points
from bearingdyn.fem.matrix_files.free_body_checks import checked_files
from bearingdyn.fem.matrix_files.text_tables import (
    Form,
    first_line,
    rows_fit,
    symmetric_from,
    table,
    triples,
    whole,
)
from bearingdyn.types import Array, Index

COORDINATE = "an Abaqus matrix has lines of row, column (they count from 1) and value, or of five columns"
MATRIX_INPUT = (
    "an Abaqus matrix has lines of node, direction, node, direction, all whole numbers, and value, numbers "
    "with a point"
)
# keywords that read_nodes cannot follow
GEOMETRY = ("SYSTEM", "NGEN", "NFILL", "NCOPY", "NMAP", "IMPERFECTION")


def read_abaqus(
    stiffness: str | Path, mass: str | Path, points: Points | None = None, **check: Any
) -> FEMatrices:
    """Read Abaqus' matrices: the two files (.mtx) of *MATRIX OUTPUT, STIFFNESS, MASS, either text format.

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
    FileNotFoundError
        If there is no such file.
    ValueError
        For a file that is not of that format, for an internal variable of Abaqus (a node
        number below 1), or where check_matrices does.
    """
    files = [existing(stiffness), existing(mass)]
    K, M = (_entries(path) for path in files)
    if (K[0] is None) != (M[0] is None):
        raise ValueError(f"{files[0]} and {files[1]} are of different formats; write both in the same")
    if K[0] is None or M[0] is None:
        n = 1 + max(int(A[1].max()) for A in (K, M))
        for path, A in zip(files, (K, M), strict=True):
            rows_fit(path, int(A[1].max()) + 1, len(A[2]))
        both = [symmetric_from(index[:, 0], index[:, 1], value, n) for _, index, value in (K, M)]
        return checked_files(files, both[0], both[1], points, **check)
    labels, place = np.unique(np.vstack([K[0], M[0]]), axis=0, return_inverse=True)
    place = place.ravel()
    matrices: list[scipy.sparse.csr_matrix] = []
    begin = 0
    for label, index, value in (K, M):
        assert label is not None
        own = place[begin : begin + len(label)]
        begin += len(label)
        matrices.append(symmetric_from(own[index[:, 0]], own[index[:, 1]], value, len(labels)))
    return checked_files(files, matrices[0], matrices[1], points, labels=labels, **check)


def _entries(path: Path) -> tuple[Index | None, Index, Array]:
    """Labels (l, 2) of node and direction, or None; row and column (e, 2) of each entry; values (e,)."""
    first = first_line(path, "*")
    separator = "," if "," in first else ""
    width = len(first.replace(",", " ").split())
    if width == 3:
        form = Form(("count", "count", "number"), separator, "*", COORDINATE)
        with path.open("rb") as stream:
            row, column, value = triples(path, stream, form)
        return None, np.stack([row, column], axis=1), value
    if width != 5:
        raise ValueError(f"{path} has {width} columns of numbers; an Abaqus matrix has 3 or 5")
    with path.open("rb") as stream:
        numbers = table(path, stream, Form(("whole",) * 4 + ("number",), separator, "*", MATRIX_INPUT))
    at = whole(path, numbers[:, :4])
    if at[:, [0, 2]].min() < 1:
        raise ValueError(
            f"{path} names node {at[:, [0, 2]].min()}, an internal variable of Abaqus (contact, a coupling, "
            "an incompressible element); export a model without"
        )
    labels, place = np.unique(at.reshape(-1, 2), axis=0, return_inverse=True)
    return labels, place.reshape(-1, 2), numbers[:, -1]


def read_nodes(path: str | Path) -> dict[int, tuple[float, float, float]]:
    """Matrix files of Abaqus or CalculiX: the positions in all *NODE blocks of their input file (.inp).

    *INCLUDE is followed.

    Parameters
    ----------
    path
        Of the file.

    Returns
    -------
    dict
        Number of the node -> position (x, y, z), in the unit of the file.

    Raises
    ------
    FileNotFoundError
        If there is no such file.
    ValueError
        For a file without nodes, or with a line that cannot be a node.
    """
    p = existing(path)
    nodes: dict[int, tuple[float, float, float]] = {}
    try:
        for block in blocks(p):
            moved = block.keyword == "INSTANCE" and block.lines
            turned = block.keyword == "NODE" and block.options.get("SYSTEM", "R").upper() != "R"
            if block.keyword in GEOMETRY or moved or turned:
                raise block.fault("it moves or makes nodes, which is not followed here; write the nodes out")
            for k, line in enumerate(block.lines if block.keyword == "NODE" else ()):
                try:
                    nodes.update([node(line)])
                except ValueError as error:
                    raise block.fault(error, k) from error
    except ValueError as error:
        if str(error).startswith(f"{p.name}, line"):
            raise
        raise ValueError(f"{p}: {error}") from error
    if not nodes:
        raise ValueError(f"{p} has no *NODE block; give the input file that holds the nodes")
    return nodes
