"""Meshes in the input files of Abaqus and CalculiX (.inp)."""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from bearingdyn.fem.abaqus_input import blocks, fields, node
from bearingdyn.fem.mesh_files.raw_mesh import RawMesh
from bearingdyn.fem.meshes.solid_element import HEX20, TET10

SOLID = re.compile(r"C3D(\d+)")
NODES = {20: 20, 10: 10, 8: 8, 4: 4}

# Abaqus' and CalculiX' faces S1, S2, ... in the order of SolidElement.faces
BRICK_SIDES = (4, 5, 2, 1, 3, 0)
TET_SIDES = (0, 1, 2, 3)


@dataclass
class _Model:
    """What has been read so far; names in capitals, for the format does not tell cases apart."""

    nodes: dict[int, tuple[float, ...]] = field(default_factory=dict)
    elements: dict[int, list[int]] = field(default_factory=dict)  # solid ones
    skins: dict[int, list[int]] = field(default_factory=dict)  # shells and plane elements
    elsets: dict[str, list[int]] = field(default_factory=dict)
    nsets: dict[str, list[int]] = field(default_factory=dict)
    surfaces: dict[str, list[tuple[str, str]]] = field(default_factory=dict)
    of_nodes: set[str] = field(default_factory=set)
    sections: list[str] = field(default_factory=list)
    spelling: dict[str, str] = field(default_factory=dict)

    def key(self, name: str) -> str:
        name = name.strip().strip('"')
        self.spelling.setdefault(name.upper(), name)
        return name.upper()


def read_inp(path: Path) -> RawMesh:
    """The mesh of an input file: *NODE, *ELEMENT, *NSET, *ELSET, *SURFACE, *SOLID SECTION, *INCLUDE.

    Regions are the element sets of *SOLID SECTION, or the sets that divide the body. Surfaces are node sets,
    *SURFACE definitions by faces or nodes, and sets of shell or plane elements.

    Raises
    ------
    ValueError
        For other solid elements, a node numbered twice, parts moved into an assembly, a set that names
        something undefined, and a line that cannot be read.
    """
    model = _Model()
    for keyword, options, lines in blocks(path):
        try:
            _take(model, keyword, options, lines)
        except (ValueError, IndexError) as error:
            raise ValueError(f"*{keyword}: {error}") from error
    order = {number: k for k, number in enumerate(model.nodes)}
    position = {number: k for k, number in enumerate(model.elements)}
    by_size: dict[int, list[list[int]]] = {}
    for number, nodes in model.elements.items():
        missing = [n for n in nodes if n not in order]
        if missing:
            raise ValueError(f"element {number} names node {missing[0]}, which the file does not have")
        by_size.setdefault(len(nodes), []).append([order[n] for n in nodes])

    surfaces = {}
    for name, members in model.nsets.items():
        surfaces[model.spelling[name]] = np.array([order[n] for n in members if n in order], dtype=np.intp)
    regions = {}
    for name, members in model.elsets.items():
        inside = [position[n] for n in members if n in position]
        if inside:
            regions[model.spelling[name]] = np.array(inside, dtype=np.intp)
        skin = {order[n] for number in members for n in model.skins.get(number, ()) if n in order}
        if skin and not inside:
            surfaces.setdefault(model.spelling[name], np.array(sorted(skin), dtype=np.intp))
    for name in model.surfaces:
        held = _surface_nodes(model, name)
        surfaces[model.spelling[name]] = np.array(sorted(order[n] for n in held if n in order), dtype=np.intp)
    return RawMesh(
        points=np.array([model.nodes[n] for n in order], dtype=np.float64).reshape(-1, 3),
        cells=tuple(np.array(cell, dtype=np.intp) for cell in by_size.values()),
        numbers=np.array(list(model.elements), dtype=np.intp),
        regions=regions,
        surfaces={name: at for name, at in surfaces.items() if at.size},
        preferred=tuple(dict.fromkeys(model.spelling[name] for name in model.sections)),
    )


def _take(model: _Model, keyword: str, options: dict[str, str], lines: list[str]) -> None:
    if keyword == "NODE":
        for line in lines:
            number, place = node(line)
            if number in model.nodes:
                raise ValueError(
                    f"node {number} is given twice; write a flat file of one part, without an assembly"
                )
            model.nodes[number] = place
            if "NSET" in options:
                model.nsets.setdefault(model.key(options["NSET"]), []).append(number)
    elif keyword == "ELEMENT":
        _take_elements(model, options, lines)
    elif keyword in ("NSET", "ELSET"):
        sets = model.nsets if keyword == "NSET" else model.elsets
        members = sets.setdefault(model.key(options[keyword]), [])
        for line in lines:
            entries = fields(line)
            if "GENERATE" in options:
                first, last, step = (*map(int, entries), 1)[:3]
                members.extend(range(first, last + 1, step))
                continue
            for one in entries:
                if one.isdigit():
                    members.append(int(one))
                elif model.key(one) in sets:
                    members.extend(sets[model.key(one)])
                else:
                    raise ValueError(
                        f"{options[keyword]} names the set {one}, which is not defined before it"
                    )
    elif keyword == "SURFACE":
        name = model.key(options["NAME"])
        if options.get("TYPE", "ELEMENT").upper() == "NODE":
            model.of_nodes.add(name)
        pairs = [fields(line) for line in lines]
        model.surfaces.setdefault(name, []).extend((p[0], p[1] if len(p) > 1 else "") for p in pairs)
    elif keyword == "SOLID SECTION":
        model.sections.append(model.key(options["ELSET"]))
    elif keyword == "INSTANCE" and lines:
        raise ValueError("an instance is moved into the assembly; write a flat file of one part")


def _take_elements(model: _Model, options: dict[str, str], lines: list[str]) -> None:
    kind = options.get("TYPE", "").upper()
    solid = SOLID.match(kind)
    if solid and int(solid[1]) not in NODES:
        raise ValueError(f"elements of type {kind}; bricks C3D20 or tetrahedra C3D10 are read")
    rows: list[list[int]] = []
    if solid:
        flat = [int(f) for line in lines for f in fields(line)]
        width = int(solid[1]) + 1
        if len(flat) % width:
            raise ValueError(f"type {kind} has {width - 1} nodes; the lines do not hold whole elements")
        rows = [flat[k : k + width] for k in range(0, len(flat), width)]
    else:
        open_row = False
        for line in lines:
            numbers = [int(f) for f in fields(line)]
            if open_row:
                rows[-1].extend(numbers)
            else:
                rows.append(numbers)
            open_row = line.endswith(",")
    for number, *nodes in rows:
        if number in model.elements or number in model.skins:
            raise ValueError(
                f"element {number} is given twice; write a flat file of one part, without an assembly"
            )
        (model.elements if solid else model.skins)[number] = nodes
    if "ELSET" in options:
        model.elsets.setdefault(model.key(options["ELSET"]), []).extend(row[0] for row in rows)


def _surface_nodes(model: _Model, name: str) -> set[int]:
    found: set[int] = set()
    for target, side in model.surfaces[name]:
        if name in model.of_nodes:
            members = [int(target)] if target.isdigit() else model.nsets.get(target.strip('"').upper())
            if members is None:
                raise ValueError(f"*SURFACE {model.spelling[name]} names the node set {target}, not defined")
            found.update(members)
            continue
        numbers = [int(target)] if target.isdigit() else model.elsets.get(target.strip('"').upper())
        if numbers is None:
            raise ValueError(f"*SURFACE {model.spelling[name]} names the element set {target}, not defined")
        for number in numbers:
            if number in model.skins:
                found.update(model.skins[number])
                continue
            if number not in model.elements:
                raise ValueError(
                    f"*SURFACE {model.spelling[name]} names element {number}, which is not there"
                )
            found.update(_side(model.elements[number], side, model.spelling[name]))
    return found


def _side(nodes: list[int], side: str, name: str) -> list[int]:
    kind, sides = (HEX20, BRICK_SIDES) if len(nodes) in (8, 20) else (TET10, TET_SIDES)
    if not re.fullmatch(rf"S[1-{len(sides)}]", side.upper()):
        raise ValueError(f"*SURFACE {name} has the face {side!r}; it must be S1 to S{len(sides)}")
    face = kind.face_nodes[sides[int(side[1:]) - 1]]
    return [nodes[k] for k in face.tolist() if k < len(nodes)]
