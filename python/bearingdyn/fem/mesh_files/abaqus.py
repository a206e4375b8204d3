"""Meshes in the input files of Abaqus and CalculiX (.inp)."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import numpy as np

from bearingdyn.fem.abaqus_input import Block, blocks, fields, node, whole
from bearingdyn.fem.mesh_files.abaqus_coordinates import System, from_polar, moved, system
from bearingdyn.fem.mesh_files.raw_mesh import RawMesh
from bearingdyn.fem.meshes.solid_element import HEX20, HEX27, PYRAMID13, TET10, WEDGE15, shapes
from bearingdyn.types import Array, Index

SOLID = re.compile(r"C3D(\d+)(V?)")
KINDS = {20: HEX20, 8: HEX20, 27: HEX20, 10: TET10, 4: TET10, 15: WEDGE15, 6: WEDGE15, 5: PYRAMID13}
# solids of other formulations: a body without them would lack a piece
OTHER_SOLIDS = re.compile(
    r"(C3D|SC[68]|CSS8|COH3D|D?C?DC3D|AC3D|CIN3D|GK3D|Q3D|EMC3D|EC3D|FC3D|PC3D|CCL|UC3D|U\d|F3D)"
)

# Abaqus' and CalculiX' faces S1, S2, ... in the order of SolidElement.faces
SIDES = {
    HEX20: (4, 5, 2, 1, 3, 0),
    TET10: (0, 1, 2, 3),
    WEDGE15: (0, 1, 2, 3, 4),
    PYRAMID13: (0, 1, 2, 3, 4),
}
# Keywords that make, move or repeat geometry and are not followed
REFUSED = {
    **dict.fromkeys(
        ("NGEN", "NFILL", "NCOPY", "NMAP", "MESH REFINEMENT", "REFINE MESH"), "it makes or moves nodes"
    ),
    **dict.fromkeys(("ELGEN", "ELCOPY", "SYMMETRIC MODEL GENERATION"), "it makes elements"),
    **dict.fromkeys(("CYCLIC SYMMETRY MODEL",), "a sector stands for the whole ring"),
    **dict.fromkeys(("IMPORT", "IMPORT NSET", "IMPORT ELSET"), "what it brings is not in the file"),
    "PARAMETER": "numbers of the file may depend on it",
    "IMPERFECTION": "it moves nodes",
}
# How many members all sets may have, and how many nodes and elements all instances: so many times what the
# file defines, and so many beyond. Sets of sets and instances multiply; a mesh of a body needs a tenth.
MULTIPLE, BEYOND = 20, 300_000


@dataclass
class _Set:
    """Numbers of nodes or elements, alone and from first to last; and other sets (instance or None, name)."""

    numbers: list[int] = field(default_factory=list)
    ranges: dict[range, None] = field(default_factory=dict)
    others: dict[tuple[str | None, str], None] = field(default_factory=dict)
    block: Block | None = None  # one that defined it, for messages

    def copy(self) -> _Set:
        return _Set(list(self.numbers), dict(self.ranges), dict(self.others), self.block)


@dataclass
class _Scope:
    """A part, an instance or the file itself; names in capitals, for the format does not tell cases apart."""

    nodes: dict[int, tuple[float, float, float]] = field(default_factory=dict)
    elements: dict[int, list[int]] = field(default_factory=dict)  # solid ones
    skins: dict[int, list[int]] = field(default_factory=dict)  # shells and plane elements
    elsets: dict[str, _Set] = field(default_factory=dict)
    nsets: dict[str, _Set] = field(default_factory=dict)
    surfaces: dict[str, dict[tuple[str, str], Block]] = field(default_factory=dict)
    of_nodes: set[str] = field(default_factory=set)
    sections: list[str] = field(default_factory=list)
    place: tuple[Array, Array] | None = None  # of an instance: matrix and shift

    @property
    def size(self) -> int:
        """Nodes and elements."""
        return len(self.nodes) + len(self.elements) + len(self.skins)

    def copy(self) -> _Scope:
        """One whose sets can be added to; nodes and elements stay shared."""
        return replace(
            self,
            elsets={name: of.copy() for name, of in self.elsets.items()},
            nsets={name: of.copy() for name, of in self.nsets.items()},
            surfaces={name: dict(of) for name, of in self.surfaces.items()},
            of_nodes=set(self.of_nodes),
            sections=list(self.sections),
        )


def read_inp(path: Path) -> RawMesh:
    """The mesh of an input file, flat or an assembly of parts.

    Followed: *NODE (SYSTEM= too), *SYSTEM, *ELEMENT, *NSET, *ELSET, *SURFACE, *SOLID SECTION, *INCLUDE, and
    *PART, *ASSEMBLY and *INSTANCE with their shift and turn. *TRANSFORM and *ORIENTATION turn directions
    only, and change no mesh. With one instance names stay as they are, with more those of parts become
    "instance.name". Regions are the element sets of *SOLID SECTION, or the sets that divide the body.
    Surfaces are node sets, *SURFACE by faces or nodes, and sets of shell or plane elements.

    Raises
    ------
    ValueError
        With file and line, for other solid elements, a keyword that makes or moves geometry in another way, a
        number given twice, a set that names something undefined, and a line that cannot be read.
    """
    return _Model().read(path)


class _Model:
    def __init__(self) -> None:
        self.root = _Scope()
        self.parts: dict[str, _Scope] = {}
        self.instances: dict[str, _Scope] = {}
        self.spelling: dict[str, str] = {}
        self.open = self.root  # what definitions go to
        self.system: System | None = None
        self.repeated = 0  # nodes and elements of all instances

    def limit(self) -> int:
        """How many nodes and elements instances and sets may have in all."""
        defined = sum(scope.size for scope in (self.root, *self.parts.values()))
        return MULTIPLE * defined + BEYOND

    def read(self, path: Path) -> RawMesh:
        for block in blocks(path):
            try:
                self.take(block)
            except (ValueError, IndexError) as error:
                text = str(error)
                raise (error if text.startswith(block.file) else block.fault(text)) from error
        if self.parts and not self.instances:
            if len(self.parts) > 1 or self.root.nodes:
                raise ValueError(
                    f"it has the parts {sorted(self.parts)} and no *INSTANCE of them; write the assembly"
                )
            self.instances = dict(self.parts)
        return _Assembled(self).mesh()

    def key(self, name: str) -> str:
        name = name.strip().strip('"')
        self.spelling.setdefault(name.upper(), name)
        return name.upper()

    def take(self, block: Block) -> None:
        keyword = block.keyword
        if keyword in REFUSED:
            raise block.fault(
                f"{REFUSED[keyword]}, which is not followed; write the mesh out with all its nodes"
            )
        if keyword == "PART":
            self.open = self.parts.setdefault(self.key(block.named("NAME")), _Scope())
            self.system = None
        elif keyword == "INSTANCE":
            self.open = self._instance(block)
            self.system = None
        elif keyword in ("END PART", "END INSTANCE", "ASSEMBLY", "END ASSEMBLY"):
            self.open, self.system = self.root, None
        elif keyword == "SYSTEM":
            self.system = system(block)
        elif keyword in ("NODE", "ELEMENT"):
            if self.open.place is not None:
                raise block.fault(
                    "an instance adds to the mesh of its part, which is not read; add it to the part"
                )
            (self._nodes if keyword == "NODE" else self._elements)(block)
        elif keyword in ("NSET", "ELSET"):
            self._set(block, self.open.nsets if keyword == "NSET" else self.open.elsets)
        elif keyword == "SURFACE":
            self._surface(block)
        elif keyword == "SOLID SECTION":
            self.open.sections.append(self.key(block.named("ELSET")))

    def _instance(self, block: Block) -> _Scope:
        name = self.key(block.named("NAME"))
        if name in self.instances:
            raise block.fault(f"the instance {name} is given twice")
        if "PART" not in block.options:
            raise block.fault(
                "it imports an earlier analysis, whose mesh is not in the file; write the mesh out"
            )
        part = self.parts.get(self.key(block.options["PART"]))
        if part is None:
            raise block.fault(f"its part {block.options['PART']} is not defined before it")
        self.repeated += part.size
        if self.repeated > self.limit():
            raise block.fault(
                f"{len(self.instances) + 1} instances have {self.repeated} nodes and elements, more than "
                f"{MULTIPLE} times those of the parts; write a file with fewer"
            )
        self.instances[name] = replace(part.copy(), place=moved(block))
        return self.instances[name]

    def _nodes(self, block: Block) -> None:
        own: dict[int, tuple[float, float, float]] = {}
        for k, line in enumerate(block.lines):
            try:
                number, place = node(line)
            except ValueError as error:
                raise block.fault(error, k) from error
            if number in own or number in self.open.nodes:
                raise block.fault(f"node {number} is given twice; number the nodes of a part once", k)
            own[number] = place
        points = np.array(list(own.values()), dtype=np.float64).reshape(-1, 3)
        points = from_polar(points, block)
        if self.system is not None:
            points = points @ self.system.axes + self.system.origin
        self.open.nodes.update(zip(own, ((x, y, z) for x, y, z in points.tolist()), strict=True))
        if "NSET" in block.options:
            held = self.open.nsets.setdefault(self.key(block.named("NSET")), _Set(block=block))
            held.numbers.extend(own)

    def _elements(self, block: Block) -> None:
        kind = block.named("TYPE").upper()
        solid = SOLID.match(kind)
        if (solid and (int(solid[1]) not in KINDS or solid[2])) or (not solid and OTHER_SOLIDS.match(kind)):
            raise block.fault(
                f"elements of type {kind}; bricks C3D20 and C3D27, wedges C3D15 and tetrahedra C3D10 are read"
            )
        rows = list(_rows(block, int(solid[1]) + 1 if solid else None))
        target = self.open.elements if solid else self.open.skins
        for k, (number, *nodes) in rows:
            if number in self.open.elements or number in self.open.skins:
                raise block.fault(f"element {number} is given twice; number the elements of a part once", k)
            target[number] = nodes
        if "ELSET" in block.options:
            held = self.open.elsets.setdefault(self.key(block.named("ELSET")), _Set(block=block))
            held.numbers.extend(row[0] for _, row in rows)

    def _set(self, block: Block, sets: dict[str, _Set]) -> None:
        name = self.key(block.named(block.keyword))
        held = sets.setdefault(name, _Set(block=block))
        instance = self.key(block.options["INSTANCE"]) if "INSTANCE" in block.options else None
        if instance is not None and instance not in self.instances:
            raise block.fault(f"the instance {instance} is not defined before it")
        own = held if instance is None else self._within(held, name, instance, block)
        for k, line in enumerate(block.lines):
            entries = fields(line)
            try:
                if "GENERATE" in block.options:
                    if len(entries) not in (2, 3):
                        raise ValueError(f"{line[:60]!r} is not first, last, step")
                    first, last, step = (*map(whole, entries), 1)[:3]
                    if not step > 0:
                        raise ValueError(f"its step is {step}; it must be 1 or more")
                    own.ranges[range(first, last + 1, step)] = None
                    continue
                for one in entries:
                    if one.isdigit():
                        own.numbers.append(whole(one))
                    else:
                        self._refer(held, name, one, instance, block)
            except ValueError as error:
                raise block.fault(error, k) from error

    def _within(self, held: _Set, name: str, instance: str, block: Block) -> _Set:
        """What of a set of the assembly lies in an instance: a set of the instance without a name."""
        scope = self.instances[instance]
        sets = scope.nsets if block.keyword == "NSET" else scope.elsets
        held.others[instance, f" {name}"] = None
        return sets.setdefault(f" {name}", _Set(block=block))

    def _refer(self, held: _Set, name: str, entry: str, instance: str | None, block: Block) -> None:
        """Another set, or a node or element of an instance: name, instance.name or instance.number."""
        other = self.key(entry)
        owner, dot, rest = other.partition(".")
        if instance is None and dot and owner in self.instances:
            instance, other = owner, rest.strip('"')
        if instance is not None and other.isdigit():
            self._within(held, name, instance, block).numbers.append(whole(other))
            return
        scope = self.open if instance is None else self.instances[instance]
        if other not in (scope.nsets if block.keyword == "NSET" else scope.elsets):
            raise ValueError(f"it names the set {entry[:60]}, which is not defined before it")
        held.others[instance, other] = None

    def _surface(self, block: Block) -> None:
        kind = block.options.get("TYPE", "ELEMENT").upper()
        if kind not in ("ELEMENT", "NODE"):
            return  # an analytical one, of no element
        if "COMBINE" in block.options or "CROP" in block.options:
            raise block.fault("a surface made of surfaces is not read; list its faces")
        name = self.key(block.named("NAME"))
        held = self.open.surfaces.setdefault(name, {})
        if kind == "NODE":
            self.open.of_nodes.add(name)
        for k, line in enumerate(block.lines):
            pair = fields(line)
            if not pair or line.startswith(","):
                raise block.fault(
                    "it names no set; list the faces, or the sets of elements and their sides", k
                )
            one = replace(block, place=block.places[k], lines=[], places=[])
            held[pair[0], pair[1] if len(pair) > 1 else ""] = one


def _rows(block: Block, width: int | None) -> Iterator[tuple[int, list[int]]]:
    """Line and numbers of each element; width is that of solid elements, which may run over several lines.

    Others go on where a line ends in a comma; those with nodes of instances (springs) are left out.
    """
    row: list[str] = []
    begun = 0
    for k, line in enumerate(block.lines):
        begun = begun if row else k
        row += fields(line)
        ready = len(row) >= width if width else not line.endswith(",")
        if not ready:
            continue
        if width and len(row) > width:
            raise block.fault(f"{len(row)} numbers; its elements have a number and {width - 1} nodes", k)
        if width or all(one.isdigit() for one in row):
            try:
                yield begun, [whole(one) for one in row]
            except ValueError as error:
                raise block.fault(error, k) from error
        row = []
    if row and width:
        raise block.fault(
            f"its elements have {width - 1} nodes; the lines do not hold whole elements", len(block.lines) - 1
        )
    if row and all(one.isdigit() for one in row):
        yield begun, [whole(one) for one in row]


class _Assembled:
    """The instances, or the flat file, in one numbering; the file itself is the scope ""."""

    def __init__(self, model: _Model) -> None:
        self.spelling = model.spelling
        self.scopes = {"": model.root, **model.instances}
        self.single = len(model.instances) <= 1
        self.left = model.limit()
        orders = {id(s.nodes): {n: k for k, n in enumerate(s.nodes)} for s in self.scopes.values()}
        # first row of each scope's nodes in all nodes, and the row of each number in its scope
        self.order = {name: orders[id(scope.nodes)] for name, scope in self.scopes.items()}
        sizes = np.cumsum([0, *(len(at) for at in self.order.values())]).tolist()
        self.first = dict(zip(self.scopes, sizes, strict=False))
        self.sorted: dict[tuple[str, str], tuple[Index, Index]] = {}
        self.position: dict[tuple[str, int], int] = {}

    def mesh(self) -> RawMesh:
        points = []
        for scope in self.scopes.values():
            own = np.array(list(scope.nodes.values()), dtype=np.float64).reshape(-1, 3)
            points.append(own if scope.place is None else own @ scope.place[0].T + scope.place[1])
        every = np.vstack(points)
        cells, numbers = self._cells()
        cells = [_faces_in_order(c, every) if c.shape[1] == 27 else c for c in cells]
        regions, surfaces, preferred = {}, {}, []
        for s, scope in self.scopes.items():
            for name in scope.nsets:
                if not name.startswith(" "):
                    surfaces[self._shown(s, name)] = self.nodes_of(s, name)
            for name in scope.elsets:
                if name.startswith(" "):
                    continue
                inside, skin = self.elements_of(s, name)
                if inside.size:
                    regions[self._shown(s, name)] = inside
                elif skin.size:
                    surfaces.setdefault(self._shown(s, name), skin)
            for name in scope.surfaces:
                surfaces[self._shown(s, name)] = self._surface(s, name)
            preferred += [self._shown(s, name) for name in scope.sections]
        return RawMesh(
            points=every,
            cells=tuple(cells),
            numbers=numbers,
            regions=regions,
            surfaces={name: at for name, at in surfaces.items() if at.size},
            preferred=tuple(dict.fromkeys(preferred)),
        )

    def _shown(self, scope: str, name: str) -> str:
        spelt = self.spelling[name]
        if not scope or self.single:
            return spelt
        return f"{self.spelling[scope]}.{spelt}"

    def _cells(self) -> tuple[list[Index], Index]:
        by_size: dict[int, list[tuple[str, int, list[int]]]] = {}
        for s, scope in self.scopes.items():
            order, first = self.order[s], self.first[s]
            for number, nodes in scope.elements.items():
                rows = []
                for n in nodes:
                    if n not in order:
                        raise ValueError(f"element {number} names node {n}, which the file does not have")
                    rows.append(first + order[n])
                by_size.setdefault(len(nodes), []).append((s, number, rows))
        numbers: list[int] = []
        for of_size in by_size.values():
            for s, number, _ in of_size:
                self.position[s, number] = len(numbers)
                numbers.append(number)
        cells = [np.array([rows for *_, rows in of_size], dtype=np.intp) for of_size in by_size.values()]
        return cells, np.array(numbers, dtype=np.intp)

    def rows_of(self, s: str, name: str, what: str) -> list[tuple[str, Index]]:
        """What a set holds, by scope, as rows of `_known`, once each; what is n for nodes, e for elements."""
        found: dict[str, Any] = {}  # by scope, for each of its nodes or elements whether it is held
        seen, stack = {(s, name)}, [(s, name)]  # sets may hold sets to any depth, and each other
        while stack:
            t, one = stack.pop()
            held = (self.scopes[t].nsets if what == "n" else self.scopes[t].elsets)[one]
            known = self._known(t, what)[0]
            inside = found.setdefault(t, np.zeros(known.size, dtype=bool))
            if held.numbers:
                inside |= np.isin(known, held.numbers)
            self.left -= len(held.numbers) + len(held.others)
            for numbers in held.ranges:
                low, high = np.searchsorted(known, [numbers.start, numbers.stop])
                inside[low:high] |= (known[low:high] - numbers.start) % numbers.step == 0
                self.left -= int(high - low)
                self._check_left(held)
            for instance, other in held.others:
                at = (t if instance is None else instance, other)
                if at not in seen:
                    seen.add(at)
                    stack.append(at)
            self._check_left(held)
        return [(t, np.flatnonzero(inside)) for t, inside in found.items()]

    def _check_left(self, held: _Set) -> None:
        if self.left < 0 and held.block is not None:
            raise held.block.fault(
                f"the sets have more than {MULTIPLE} members for each node and element; name each set once"
            )

    def _known(self, s: str, what: str) -> tuple[Index, Index]:
        """Numbers of the nodes or elements of a scope in rising order, and the place of each in the scope."""
        if (s, what) not in self.sorted:
            scope = self.scopes[s]
            numbers = np.array(
                list(scope.nodes) if what == "n" else [*scope.elements, *scope.skins], dtype=np.int64
            )
            order = np.argsort(numbers)
            self.sorted[s, what] = numbers[order], order
        return self.sorted[s, what]

    def nodes_of(self, s: str, name: str) -> Index:
        """Nodes of a node set, in all nodes."""
        parts = [self.first[t] + self._known(t, "n")[1][rows] for t, rows in self.rows_of(s, name, "n")]
        return np.sort(np.concatenate([*parts, np.zeros(0, dtype=np.intp)])).astype(np.intp)

    def numbers_of(self, s: str, name: str) -> list[tuple[str, list[int]]]:
        """Numbers of the elements of an element set, by scope."""
        return [(t, self._known(t, "e")[0][rows].tolist()) for t, rows in self.rows_of(s, name, "e")]

    def elements_of(self, s: str, name: str) -> tuple[Index, Index]:
        """Solid elements of an element set, and nodes of its shells and plane elements."""
        inside: list[int] = []
        skin: set[int] = set()
        for t, numbers in self.numbers_of(s, name):
            scope, order, first = self.scopes[t], self.order[t], self.first[t]
            for n in numbers:
                if n in scope.elements:
                    inside.append(self.position[t, n])
                else:
                    skin.update(first + order[k] for k in scope.skins[n] if k in order)
        return np.unique(np.array(inside, dtype=np.intp)), np.array(sorted(skin), dtype=np.intp)

    def _surface(self, s: str, name: str) -> Index:
        scope, found = self.scopes[s], set()
        parts = [np.zeros(0, dtype=np.intp)]
        by_nodes = name in scope.of_nodes
        for (target, side), block in scope.surfaces[name].items():
            t, one = self._target(s, target)
            of, order, first = self.scopes[t], self.order[t], self.first[t]
            shown = block.options["NAME"]
            if one.isdigit():
                n = whole(one)
                if n not in (of.nodes if by_nodes else of.elements.keys() | of.skins.keys()):
                    kind = "node" if by_nodes else "element"
                    raise block.fault(f"{shown} names {kind} {n}, which is not there")
                numbers = [(t, [n])]
            elif one not in (of.nsets if by_nodes else of.elsets):
                kind = "node" if by_nodes else "element"
                raise block.fault(f"{shown} names the {kind} set {target[:60]}, not defined")
            elif by_nodes:
                parts.append(self.nodes_of(t, one))
                continue
            else:
                numbers = self.numbers_of(t, one)
            if by_nodes:
                found.add(first + order[n])
                continue
            for t, own in numbers:
                of, order, first = self.scopes[t], self.order[t], self.first[t]
                for n in own:
                    held = of.skins[n] if n in of.skins else _side(of.elements[n], side, block)
                    found.update(first + order[k] for k in held if k in order)
        return np.unique(np.concatenate([*parts, np.array(sorted(found), dtype=np.intp)]))

    def _target(self, s: str, target: str) -> tuple[str, str]:
        """Scope and name of what a line of *SURFACE names: a number or a set, of an instance or not."""
        name = target.strip('"').upper()
        owner, dot, rest = name.partition(".")
        return (owner, rest.strip('"')) if not s and dot and owner in self.scopes else (s, name)


def _side(nodes: list[int], side: str, block: Block) -> list[int]:
    kind = KINDS[len(nodes)]
    sides = SIDES[kind]
    if not re.fullmatch(rf"S[1-{len(sides)}]", side.upper()):
        raise block.fault(
            f"{block.options['NAME']} has the face {side[:20]!r}; it must be S1 to S{len(sides)}"
        )
    face = kind.face_nodes[sides[int(side[1:]) - 1]]
    held = [nodes[k] for k in dict.fromkeys(face.tolist()) if k < len(nodes)]
    if len(nodes) == 27:
        held.append(nodes[20 + int(side[1:])])  # after the centre, the middles of S1 to S6
    return held


def _faces_in_order(cells: Index, points: Array) -> Index:
    """27-node bricks in VTK's order: programs order the middles of faces and the centre differently."""
    expected = np.einsum("jk,mka->mja", shapes(HEX20, HEX27.places[20:])[0], points[cells[:, :20]])
    distance = np.linalg.norm(expected[:, :, None] - points[cells[:, None, 20:]], axis=3)
    which = np.argmin(distance, axis=2)
    return np.hstack([cells[:, :20], np.take_along_axis(cells[:, 20:], which, axis=1)])
