"""Meshes in universal files (.unv) of I-deas, as Salome, gmsh and others write them.

Format: universal datasets 2411 (nodes), 2412 (elements), 2435, 2452, 2467 and 2477 (groups).
"""

from __future__ import annotations

from collections.abc import Iterator
from itertools import islice
from pathlib import Path

from bearingdyn.fem.abaqus_input import real, whole
from bearingdyn.fem.mesh_files.numbered_elements import Numbered
from bearingdyn.fem.mesh_files.raw_mesh import RawMesh

# I-deas goes round a face, corner and middle in turn; which of its nodes is each of ours
TET = [0, 2, 4, 9, 1, 3, 5, 6, 7, 8]
WEDGE = [0, 2, 4, 9, 11, 13, 1, 3, 5, 10, 12, 14, 6, 7, 8]
BRICK = [0, 2, 4, 6, 12, 14, 16, 18, 1, 3, 5, 7, 13, 15, 17, 19, 8, 9, 10, 11]
SOLIDS = {111: range(4), 118: TET, 112: range(6), 113: WEDGE, 115: range(8), 116: BRICK, 312: range(5)}
BEAMS = (11, 21, 22, 23, 24)  # they have one line more
FACES = {*range(41, 49), *range(51, 59), *range(61, 69), *range(81, 87), *range(91, 97)}
GROUPS = (2435, 2452, 2467, 2477)
OLD = {15: 2411, 781: 2411, 71: 2412, 780: 2412, 2429: 2477, 2430: 2477, 2432: 2477}


def read_unv(path: Path) -> RawMesh:
    """The mesh of a universal file of I-DEAS (.unv); groups or properties are regions and surfaces.

    Raises
    ------
    ValueError
        With the line, for a dataset of an older kind, other solid elements, and a line that cannot be read.
    """
    found = Numbered()
    with path.open(encoding="utf-8-sig", errors="replace") as file:
        lines = enumerate(file, 1)
        for number, raw in lines:
            if raw.strip() != "-1":
                continue
            number, raw = next(lines, (number, "-1"))
            kind = raw.strip()
            own = _dataset(lines)
            place = number
            try:
                if kind == "2411":
                    for row, line in own:
                        place, head = row, _ints(line)
                        place, line = next(own, (place, ""))
                        x, y, z = (real(v) for v in line.split())
                        if head[1] not in (0, 1):
                            raise ValueError(
                                f"node {head[0]} is in the system {head[1]}; export global coordinates"
                            )
                        found.add_node(head[0], (x, y, z))
                elif kind == "2412":
                    for row, line in own:
                        place = row
                        label, code, prop, _, _, n = _ints(line)[:6]
                        if code in BEAMS:
                            next(own, None)
                        nodes: list[int] = []
                        while len(nodes) < n:
                            place, line = next(own, (place, "x"))
                            nodes += _ints(line)
                        if code in SOLIDS:
                            order = SOLIDS[code]
                            if len(nodes) != len(order):
                                raise ValueError(
                                    f"an element of type {code} has {len(nodes)} nodes, not {len(order)}"
                                )
                            found.add_element(label, [nodes[k] for k in order], prop, True)
                        elif code in FACES:
                            found.add_element(label, nodes, prop, False)
                        elif 100 < code < 120 or code > 300:
                            raise ValueError(
                                f"elements of type {code}; bricks, wedges, tetrahedra and 5-node pyramids "
                                "are read"
                            )
                elif kind.isdigit() and int(kind[:9]) in GROUPS:
                    for row, line in own:
                        place, n = row, _ints(line)[7]
                        place, line = next(own, (place, ""))
                        name, words = line.strip(), []
                        for row, line in islice(own, (n + 1) // 2):
                            place = row
                            words += _ints(line)
                        for what, tag in zip(words[0::4], words[1::4], strict=False):
                            if what in (7, 8):
                                groups = found.node_groups if what == 7 else found.element_groups
                                groups.setdefault(name, set()).add(tag)
                elif kind.isdigit() and int(kind[:9]) in OLD:
                    raise ValueError(f"dataset {kind} is of an older kind; export {OLD[int(kind)]}")
                else:
                    place = max((k for k, _ in own), default=number)
            except (ValueError, IndexError) as error:
                raise ValueError(f"{path.name}, line {place}: dataset {kind[:20]}: {error}") from error
    return found.mesh()


def _dataset(lines: Iterator[tuple[int, str]]) -> Iterator[tuple[int, str]]:
    """The lines up to the next -1."""
    for number, line in lines:
        if line.strip() == "-1":
            return
        yield number, line


def _ints(line: str) -> list[int]:
    words = line.split()
    if not words:
        raise ValueError("the line is blank, where whole numbers should stand")
    return [-1 if w == "-1" else whole(w) for w in words]
