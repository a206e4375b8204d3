"""Meshes in the input files of Abaqus and CalculiX (.inp)."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np

from bearingdyn.fem.abaqus_input import Block, blocks, fields, node, whole
from bearingdyn.fem.mesh_files.abaqus_assembly import BEYOND, KINDS, MULTIPLE, Assembled, NumberSet, Scope
from bearingdyn.fem.mesh_files.abaqus_coordinates import System, from_polar, moved, system
from bearingdyn.fem.mesh_files.raw_mesh import RawMesh, warn_of_lean

SOLID = re.compile(r"C3D(\d+)(V?)")
# solids of other formulations: a body without them would lack a piece
OTHER_SOLIDS = re.compile(
    r"(C3D|SC[68]|CSS8|COH3D|D?C?DC3D|AC3D|CIN3D|GK3D|Q3D|EMC3D|EC3D|FC3D|PC3D|CCL|UC3D|U\d|F3D)"
)
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
# Elements of mass, stiffness or damping without a volume of their own
LEAN = re.compile(r"(MASS|ROTARYI|HEATCAP|B[23]\d|PIPE|T[23]D|SPRING|DASHPOT|CONN|JOINTC|GAP|ELBOW|FRAME)")


def read_inp(path: Path) -> RawMesh:
    """The mesh of an input file of Abaqus or CalculiX (.inp), flat or an assembly of parts.

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

    Warns
    -----
    LeftOut
        For beams, masses, springs and other elements without volume.
    """
    return _Model().read(path)


class _Model:
    def __init__(self) -> None:
        self.root = Scope()
        self.parts: dict[str, Scope] = {}
        self.instances: dict[str, Scope] = {}
        self.spelling: dict[str, str] = {}
        self.open = self.root  # what definitions go to
        self.system: System | None = None
        self.lean: dict[str, int] = {}  # elements without volume, by kind
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
        warn_of_lean(path, self.lean)
        return Assembled(self.spelling, self.root, self.instances, self.limit()).mesh()

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
        if keyword == "MODEL CHANGE" and "REMOVE" in block.options and "TYPE" not in block.options:
            raise block.fault("it removes elements, which is not followed; delete them from the file")
        if keyword == "PART":
            self.open = self.parts.setdefault(self.key(block.named("NAME")), Scope())
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

    def _instance(self, block: Block) -> Scope:
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
            held = self.open.nsets.setdefault(self.key(block.named("NSET")), NumberSet(block=block))
            held.numbers.extend(own)

    def _elements(self, block: Block) -> None:
        kind = block.named("TYPE").upper()
        solid = SOLID.match(kind)
        if (solid and (int(solid[1]) not in KINDS or solid[2])) or (not solid and OTHER_SOLIDS.match(kind)):
            raise block.fault(
                f"elements of type {kind}; bricks C3D20 and C3D27, wedges C3D15 and tetrahedra C3D10 are read"
            )
        rows = list(_rows(block, int(solid[1]) + 1 if solid else None))
        if LEAN.match(kind):
            self.lean[kind] = self.lean.get(kind, 0) + len(block.lines)
        target = self.open.elements if solid else self.open.skins
        for k, (number, *nodes) in rows:
            if number in self.open.elements or number in self.open.skins:
                raise block.fault(f"element {number} is given twice; number the elements of a part once", k)
            target[number] = nodes
        if "ELSET" in block.options:
            held = self.open.elsets.setdefault(self.key(block.named("ELSET")), NumberSet(block=block))
            held.numbers.extend(row[0] for _, row in rows)

    def _set(self, block: Block, sets: dict[str, NumberSet]) -> None:
        name = self.key(block.named(block.keyword))
        held = sets.setdefault(name, NumberSet(block=block))
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

    def _within(self, held: NumberSet, name: str, instance: str, block: Block) -> NumberSet:
        """What of a set of the assembly lies in an instance: a set of the instance without a name."""
        scope = self.instances[instance]
        sets = scope.nsets if block.keyword == "NSET" else scope.elsets
        held.others[instance, f" {name}"] = None
        return sets.setdefault(f" {name}", NumberSet(block=block))

    def _refer(self, held: NumberSet, name: str, entry: str, instance: str | None, block: Block) -> None:
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
