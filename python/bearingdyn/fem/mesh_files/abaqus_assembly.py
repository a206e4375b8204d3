"""An assembly of an input file of Abaqus or CalculiX: its instances in one numbering, with their sets."""

from __future__ import annotations

import re
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from bearingdyn.fem.abaqus_input import Block, whole
from bearingdyn.fem.mesh_files.raw_mesh import RawMesh
from bearingdyn.fem.meshes.solid_element import HEX20, HEX27, PYRAMID13, TET10, WEDGE15, shapes
from bearingdyn.types import Array, Index

# How many members all sets may have, and how many nodes and elements all instances: so many times what the
# file defines, and so many beyond. Sets of sets and instances multiply; a mesh of a body needs a tenth.
MULTIPLE, BEYOND = 20, 300_000
KINDS = {20: HEX20, 8: HEX20, 27: HEX20, 10: TET10, 4: TET10, 15: WEDGE15, 6: WEDGE15, 5: PYRAMID13}
# Abaqus' and CalculiX' faces S1, S2, ... in the order of SolidElement.faces
SIDES = {
    HEX20: (4, 5, 2, 1, 3, 0),
    TET10: (0, 1, 2, 3),
    WEDGE15: (0, 1, 2, 3, 4),
    PYRAMID13: (0, 1, 2, 3, 4),
}


@dataclass
class NumberSet:
    """Abaqus assembly's set of numbers, alone and from first to last; other sets as (instance, name)."""

    numbers: list[int] = field(default_factory=list)
    ranges: dict[range, None] = field(default_factory=dict)
    others: dict[tuple[str | None, str], None] = field(default_factory=dict)
    block: Block | None = None  # one that defined it, for messages

    def copy(self) -> NumberSet:
        return NumberSet(list(self.numbers), dict(self.ranges), dict(self.others), self.block)


@dataclass
class Scope:
    """A scope of an Abaqus assembly: a part, an instance or the file itself; names in capitals."""

    nodes: dict[int, tuple[float, float, float]] = field(default_factory=dict)
    elements: dict[int, list[int]] = field(default_factory=dict)  # solid ones
    skins: dict[int, list[int]] = field(default_factory=dict)  # shells and plane elements
    elsets: dict[str, NumberSet] = field(default_factory=dict)
    nsets: dict[str, NumberSet] = field(default_factory=dict)
    surfaces: dict[str, dict[tuple[str, str], Block]] = field(default_factory=dict)
    of_nodes: set[str] = field(default_factory=set)
    sections: list[str] = field(default_factory=list)
    place: tuple[Array, Array] | None = None  # of an instance: matrix and shift

    @property
    def size(self) -> int:
        """Nodes and elements."""
        return len(self.nodes) + len(self.elements) + len(self.skins)

    def copy(self) -> Scope:
        """One whose sets can be added to; nodes and elements stay shared."""
        return replace(
            self,
            elsets={name: of.copy() for name, of in self.elsets.items()},
            nsets={name: of.copy() for name, of in self.nsets.items()},
            surfaces={name: dict(of) for name, of in self.surfaces.items()},
            of_nodes=set(self.of_nodes),
            sections=list(self.sections),
        )


class Assembled:
    """An Abaqus assembly, its instances in one numbering; the file itself is the scope ""."""

    def __init__(
        self, spelling: dict[str, str], root: Scope, instances: dict[str, Scope], limit: int
    ) -> None:
        self.spelling = spelling
        self.scopes = {"": root, **instances}
        self.single = len(instances) <= 1
        self.left = limit
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

    def _check_left(self, held: NumberSet) -> None:
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
