"""Meshes in Nastran's bulk data (.bdf, .nas): small, large and free fields.

Format: MSC Nastran Quick Reference Guide, "Bulk Data Entries". Regions and surfaces are the properties,
by number.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

from bearingdyn.fem.abaqus_input import real, whole
from bearingdyn.fem.mesh_files.numbered_elements import Numbered
from bearingdyn.fem.mesh_files.raw_mesh import RawMesh, warn_of_lean

BRICK = [
    *range(12),
    16,
    17,
    18,
    19,
    12,
    13,
    14,
    15,
]  # Nastran has the middles of upright edges before the top's
WEDGE = [*range(9), 12, 13, 14, 9, 10, 11]
# nodes of the linear and of the quadratic element, and the order of the latter
SOLIDS = {
    "CTETRA": (4, 10, list(range(10))),
    "CHEXA": (8, 20, BRICK),
    "CPENTA": (6, 15, WEDGE),
    "CPYRAM": (5, 13, list(range(13))),
}
FACES = {"CTRIA3": 3, "CTRIA6": 6, "CQUAD4": 4, "CQUAD8": 8, "CTRIAR": 3, "CQUADR": 4}
# cards of mass, stiffness or damping without a volume
LEAN = re.compile(
    r"CONM[12]|CMASS\d|CBAR|CBEAM3?|CBEND|CROD|CONROD|CTUBE|CELAS\d|CDAMP\d|CBUSH\w*|CGAP|CVISC|RBE[123]|RBAR\w*"
)
WITHOUT_E = re.compile(r"(?<=[\d.])([+-]\d+)$")  # 1.5-3 for 1.5e-3
CONTINUATIONS = 100  # of a card that is read; a brick has two


def read_bdf(path: Path) -> RawMesh:
    """The mesh of Nastran's bulk data: GRID, CTETRA, CHEXA, CPENTA, CPYRAM and shells.

    Raises
    ------
    ValueError
        With the line, for a card that cannot be read, INCLUDE, and nodes in a system of coordinates of their
        own.

    Warns
    -----
    LeftOut
        For beams, masses, springs and other elements without volume.
    """
    found, lean = Numbered(), dict[str, int]()
    for place, name, fields in _cards(path):
        try:
            if name == "GRID":
                fields += [""] * 5
                if fields[1] not in ("", "0"):
                    raise ValueError(
                        f"its system of coordinates is {fields[1]}; export nodes in the basic system"
                    )
                x, y, z = (_real(v) for v in fields[2:5])
                found.add_node(whole(fields[0]), (x, y, z))
            elif name in SOLIDS:
                fewer, most, order = SOLIDS[name]
                nodes = fields[2 : 2 + most]
                while nodes and not nodes[-1]:
                    nodes.pop()
                if len(nodes) not in (fewer, most) or "" in nodes:
                    raise ValueError(f"it has {len(nodes)} nodes; it must have {fewer} or {most}, none blank")
                numbers = [whole(n) for n in nodes]
                numbers = [numbers[k] for k in order] if len(numbers) == most else numbers
                found.add_element(whole(fields[0]), numbers, whole(fields[1] or fields[0]), True)
            elif name in FACES:
                numbers = [whole(n) for n in fields[2 : 2 + FACES[name]] if n]
                found.add_element(whole(fields[0]), numbers, whole(fields[1] or fields[0]), False)
            elif LEAN.fullmatch(name):
                lean[name] = lean.get(name, 0) + 1
            elif name.startswith("INCLUDE") or name == "GRDSET":
                raise ValueError("it is not followed; write one file with all nodes in the basic system")
        except (ValueError, IndexError) as error:
            raise ValueError(f"{path.name}, line {place}: {name}: {error}") from error
    warn_of_lean(path, lean)
    return found.mesh()


def _real(text: str) -> float:
    return real(WITHOUT_E.sub(r"e\1", text))


def _cards(path: Path) -> Iterator[tuple[int, str, list[str]]]:
    """Line, name and fields of each card of the bulk data, its continuations joined."""
    card: tuple[int, str, list[str]] | None = None
    with path.open(encoding="utf-8-sig", errors="replace") as file:
        for number, raw in enumerate(file, 1):
            line = raw.split("$")[0].rstrip().expandtabs(8)
            if not line:
                continue
            first, *rest = _fields(line)
            if first == "ENDDATA":
                break
            if first == "" or first[0] in "+*":
                if card is not None and len(card[2]) < 8 * CONTINUATIONS:
                    card[2].extend(rest)
                continue
            if card is not None:
                yield card
            card = (number, first, rest)
    if card is not None:
        yield card


def _fields(line: str) -> list[str]:
    """The name, and the fields of one line, 8 or in large fields 4."""
    if "," in line:
        words = [w.strip() for w in line.split(",")]
        large = "*" in words[0]
    else:
        large = "*" in line[:8]
        width = 16 if large else 8
        words = [
            line[:8].strip(),
            *(line[k : k + width].strip() for k in range(8, min(len(line), 72), width)),
        ]
    name = words[0].upper()
    name = name if name.startswith(("+", "*")) else name.rstrip("*")
    count = 4 if large else 8
    return [name, *(words[1 : 1 + count] + [""] * count)[:count]]
