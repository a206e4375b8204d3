"""Meshes in gmsh's files (.msh), formats 2.2, 4.0 and 4.1, text and binary.

Format: gmsh's manual, "MSH file format". An element that two physical groups hold is one element of both:
2.2 lists it once for each, 4.x gives its entity both. Partitions and parametric coordinates are passed over.
"""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from bearingdyn.fem.mesh_files.gmsh_elements import ORDERS, TYPES
from bearingdyn.fem.mesh_files.gmsh_stream import Source, shown
from bearingdyn.fem.mesh_files.raw_mesh import RawMesh
from bearingdyn.types import Array, Index

PARTITION = "_part{"  # gmsh's own groups of partitions begin so


@dataclass(frozen=True, eq=False)
class _Block:
    """Elements of one type, in the same entity or groups."""

    type: int
    numbers: Index  # (m,)
    nodes: Index  # (m, k) numbers of nodes
    groups: tuple[int, ...]  # physical ones
    entity: int


@dataclass
class _Contents:
    names: dict[tuple[int, int], str] = field(default_factory=dict)  # (dimension, number) of physical groups
    groups: dict[tuple[int, int], tuple[int, ...]] = field(default_factory=dict)  # by (dimension, entity)
    tags: list[Index] = field(default_factory=list)
    points: list[Array] = field(default_factory=list)
    blocks: list[_Block] = field(default_factory=list)


def read_msh(path: Path, region_data: str | None = None) -> RawMesh:
    """The mesh of gmsh's .msh file: solids, physical volumes as regions, physical surfaces as surfaces.

    region_data="gmsh:geometrical" takes the entities of the drawing, by number, for the groups.

    Raises
    ------
    ValueError
        With line or byte, for a format or a type of element that is not read, and a file that is damaged.
    """
    if region_data not in (None, "gmsh:physical", "gmsh:geometrical"):
        raise ValueError(
            f"region_data is {region_data!r}; its arrays of cells are ['gmsh:geometrical', 'gmsh:physical']"
        )
    found = _Contents()
    with path.open("rb") as file:
        source = Source(file, path.stat().st_size)
        version = _format(source)
        while line := source.text():
            section = line[1:].decode("utf-8", "replace")
            if not re.fullmatch(r"\$[A-Za-z]\w*", line.decode("utf-8", "replace")):
                raise source.fault(f"{shown(line)} stands where a section ($Nodes, ...) should begin")
            if section == "PhysicalNames":
                _names(source, found)
            elif section == "Entities" and version > 4.0 - 1e-9:
                _entities(source, found, version, partitioned=False)
            elif section == "PartitionedEntities":
                _entities(source, found, version, partitioned=True)
            elif section in ("Nodes", "ParametricNodes"):
                if version < 4.0:
                    _nodes2(source, found, section == "ParametricNodes")
                else:
                    _nodes4(source, found, version)
            elif section == "Elements":
                if version < 4.0:
                    _elements2(source, found)
                else:
                    _elements4(source, found, version)
            source.end(section)
    by_entity = region_data == "gmsh:geometrical"
    if not by_entity and found.names and not any(block.groups for block in found.blocks) and found.blocks:
        raise ValueError(
            f"it names the groups {sorted(set(found.names.values()))} and no element is in one, as format "
            "2.2 with Mesh.SaveAll = 1 has it; save it without SaveAll or as 4.1, or pass "
            'region_data="gmsh:geometrical"'
        )
    return _mesh(found, by_entity)


def _format(source: Source) -> float:
    first = source.text().removeprefix(b"\xef\xbb\xbf")
    if first != b"$MeshFormat":
        other = " (this looks like Fluent's)" if first.startswith(b"(") else ""
        old = first.startswith(b"$NOD")
        remedy = "gmsh's format 1 is not read; save it as 4.1" if old else f"it must be a file of gmsh{other}"
        raise source.fault(f"{shown(first)} stands where $MeshFormat should; {remedy}")
    words = source.text().split()
    version, kind, word = (words + [b""] * 3)[:3]
    if version not in (b"2", b"2.0", b"2.1", b"2.2", b"4", b"4.0", b"4.1") or kind not in (b"0", b"1"):
        raise source.fault(
            f"format {shown(b' '.join(words))}; 2.2, 4.0 and 4.1 are read: save it as one of them"
        )
    if word not in (b"4", b"8"):
        raise source.fault(f"{shown(word)} bytes a number; files of 8 bytes are read")
    source.word = int(word)
    if kind == b"1":
        one = source.file.read(4)
        if one not in (b"\x01\0\0\0", b"\0\0\0\x01"):
            raise source.fault("the number 1 should follow, to tell the order of bytes; the file is damaged")
        source.endian = "<" if one[0] else ">"
    source.end("MeshFormat")
    source.binary = kind == b"1"
    return float(version)


def _names(source: Source, found: _Contents) -> None:
    line = source.text()
    try:
        for _ in range(source.count("names", int(line), 5)):
            line = source.text()
            match = re.fullmatch(rb'(\d)\s+(-?\d{1,18})\s+"(.*)"', line)
            if not match:
                raise ValueError
            name = match[3].decode("utf-8", "replace")
            found.names[int(match[1]), int(match[2])] = name
    except ValueError:
        raise source.fault(f'{shown(line)} stands where a physical name (2 1 "name") should') from None


def _entities(source: Source, found: _Contents, version: float, partitioned: bool) -> None:
    z = "z" if version > 4.0 else "i"  # of the counts within an entity; 4.0 has int there

    def several(what: str) -> list[int]:
        n = source.count(what, source.take(z if not wide else "z")[0], 2)
        return source.take("i" * n)

    wide = True  # size_t in 4.0 too
    if partitioned:
        source.take("z")
        ghosts = source.count("ghost entities", source.take("z")[0], 4)
        source.take("ii" * ghosts)
    counts = source.take("zzzz")
    for dimension, n in enumerate(counts):
        for _ in range(source.count("entities", n, 8)):
            tag = source.take("i")[0]
            parent = (0, 0)
            if partitioned:
                parent = (source.take("i")[0], source.take("i")[0])
                several("partitions")
            source.take("ddd" if dimension == 0 and version > 4.0 else "dddddd")
            groups = tuple(abs(g) for g in several("groups"))
            if dimension:
                several("bounding entities")
            if partitioned and not groups and parent[0] == dimension:
                groups = found.groups.get(parent, ())
            found.groups[dimension, tag] = groups


def _nodes2(source: Source, found: _Contents, parametric: bool) -> None:
    line = source.text()
    if not line.isdigit():
        raise source.fault(f"{shown(line)} stands where the number of nodes should")
    n = source.count("nodes", int(line[:18]), 8)
    if not (parametric and source.binary):
        tags, points = source.table(n, "i", 3, exact=not parametric)
        found.tags.append(tags[:, 0])
        found.points.append(points)
        return
    own, places = [], []
    for _ in range(n):
        tag, x, y, z, dimension, _ = source._unpack(source.endian + "idddii")
        source.read({1: 8, 2: 16}.get(int(dimension), 0))
        own.append(int(tag))
        places.append((x, y, z))
    found.tags.append(np.array(own, dtype=np.int64))
    found.points.append(np.array(places, dtype=np.float64).reshape(-1, 3))


def _nodes4(source: Source, found: _Contents, version: float) -> None:
    blocks = source.take("zz" if version < 4.1 else "zzzz")[0]
    for _ in range(source.count("blocks of nodes", blocks, 7)):
        if version < 4.1:
            _, dimension, parametric = source.take("iii")
        else:
            dimension, _, parametric = source.take("iii")
        n = source.count("nodes", source.take("z")[0], 6)
        extra = dimension if parametric and 0 < dimension < 4 else 0
        if version < 4.1:
            tags, points = source.table(n, "i", 3 + (extra if source.binary else 0), exact=not parametric)
        else:
            tags = source.table(n, "z", 0)[0]
            points = source.table(n, "", 3 + (extra if source.binary else 0), exact=not parametric)[1]
        found.tags.append(tags[:, 0])
        found.points.append(points[:, :3])


def _type(source: Source, code: int) -> tuple[int, int]:
    """Dimension and nodes of a type of element that is read."""
    if code not in TYPES:
        raise source.fault(f"elements of type {code}; those of first and second order are read")
    dimension, nodes, name = TYPES[code]
    if name:
        raise source.fault(f"{name} (type {code}); mesh with Mesh.ElementOrder = 2, or 1 with upgrade=True")
    return dimension, nodes


def _elements2(source: Source, found: _Contents) -> None:
    line = source.text()
    if not line.isdigit():
        raise source.fault(f"{shown(line)} stands where the number of elements should")
    n = source.count("elements", int(line[:18]), 8)
    gathered: dict[tuple[int, int], list[Index]] = {}  # by type and number of tags
    if source.binary:
        done = 0
        while done < n:
            code, m, tags = source.take("iii")
            nodes = _type(source, code)[1]
            if not (m > 0 and 0 <= tags < 10_000):
                raise source.fault(f"{m} elements with {tags} tags should follow; the file is damaged")
            source.count("elements", m, 4 * (1 + tags + nodes))
            gathered.setdefault((code, tags), []).append(source.table(m, "i" * (1 + tags + nodes), 0)[0])
            done += m
    else:
        for rows in source.rows(n):
            sorted_rows: dict[tuple[bytes, ...], list[list[bytes]]] = {}
            for at, row in enumerate(rows):
                if len(row) < 4 or not (row[1].isdigit() and row[2].isdigit() and len(row[1] + row[2]) < 9):
                    source.line += at + 1 - len(rows)
                    raise source.fault(f"{shown(b' '.join(row))} stands where an element should")
                if (row[1], row[2]) not in sorted_rows:
                    sorted_rows[row[1], row[2]] = []
                sorted_rows[row[1], row[2]].append(row)
                if len(row) != 3 + int(row[2]) + _type(source, int(row[1]))[1]:
                    source.line += at + 1 - len(rows)
                    raise source.fault(
                        f"an element of type {row[1].decode()} with {row[2].decode()} tags has "
                        f"{len(row)} numbers; it must have {3 + int(row[2]) + TYPES[int(row[1])][1]}"
                    )
            for (code_text, tags_text), own in sorted_rows.items():
                data = source.numbers(own, len(own[0]))[0]
                key = (int(code_text), int(tags_text))
                gathered.setdefault(key, []).append(np.delete(data, [1, 2], axis=1))
    for (code, tags), parts in gathered.items():
        data = np.vstack(parts)
        group = np.abs(data[:, 1]) if tags else np.zeros(len(data), dtype=np.int64)
        entity = data[:, 2] if tags > 1 else np.zeros(len(data), dtype=np.int64)
        for g, e in np.unique(np.stack([group, entity], axis=1), axis=0).tolist():
            some = data[(group == g) & (entity == e)]
            found.blocks.append(_Block(code, some[:, 0], some[:, 1 + tags :], (g,) if g else (), e))


def _elements4(source: Source, found: _Contents, version: float) -> None:
    blocks = source.take("zz" if version < 4.1 else "zzzz")[0]
    for _ in range(source.count("blocks of elements", blocks, 7)):
        if version < 4.1:
            entity, dimension, code = source.take("iii")
        else:
            dimension, entity, code = source.take("iii")
        own, nodes = _type(source, code)
        if own != dimension:
            raise source.fault(
                f"elements of type {code} in an entity of dimension {dimension}; it must be {own}"
            )
        z = "i" if version < 4.1 else "z"
        n = source.count("elements", source.take("z")[0], 4)
        data = source.table(n, z * (1 + nodes), 0)[0]
        groups = found.groups.get((dimension, entity), ())
        found.blocks.append(_Block(code, data[:, 0], data[:, 1:], groups, entity))


def _mesh(found: _Contents, by_entity: bool) -> RawMesh:
    tags = np.concatenate([*found.tags, np.zeros(0, dtype=np.int64)])
    points = np.vstack([*found.points, np.zeros((0, 3))])
    order = np.argsort(tags, kind="stable")
    ranked = tags[order]
    for twice in ranked[1:][ranked[1:] == ranked[:-1]][:1].tolist():
        raise ValueError(f"node {twice} is given twice")

    def place(block: _Block) -> Index:
        at = np.minimum(np.searchsorted(ranked, block.nodes), max(ranked.size - 1, 0))
        bad = ranked[at] != block.nodes if ranked.size else np.ones(block.nodes.shape, dtype=bool)
        for k, j in np.argwhere(bad)[:1].tolist():
            raise ValueError(
                f"element {block.numbers[k]} names node {block.nodes[k, j]}, which the file does not have"
            )
        return np.asarray(order[at], dtype=np.intp)

    def names(block: _Block, dimension: int) -> list[str]:
        if by_entity:
            return [str(block.entity)]
        return [found.names.get((dimension, g), str(g)) for g in block.groups]

    cells: list[Index] = []
    numbers: list[Index] = []
    regions: dict[str, list[Index]] = {}
    surfaces: dict[str, list[Index]] = {}
    count = 0
    for code in dict.fromkeys(block.type for block in found.blocks):
        own = [block for block in found.blocks if block.type == code]
        dimension = TYPES[code][0]
        if dimension == 2:
            for block in own:
                for name in names(block, 2):
                    surfaces.setdefault(name, []).append(place(block).ravel())
        if dimension != 3 or not any(len(block.nodes) for block in own):
            continue
        rows, which, kept = _once(own)
        start = 0
        for block in own:
            at = count + which[start : start + len(block.nodes)]
            start += len(block.nodes)
            for name in names(block, 3):
                regions.setdefault(name, []).append(at)
        nodes = place(_Block(code, kept, rows, (), 0))
        cells.append(nodes[:, ORDERS[code]] if code in ORDERS else nodes)
        numbers.append(kept)
        count += len(rows)
    return RawMesh(
        points=points,
        cells=tuple(cells),
        numbers=np.concatenate([*numbers, np.zeros(0, dtype=np.int64)]).astype(np.intp),
        regions={
            name: np.unique(np.concatenate(at)) for name, at in regions.items() if not _of_partition(name)
        },
        surfaces={
            name: np.unique(np.concatenate(at)) for name, at in surfaces.items() if not _of_partition(name)
        },
    )


def _of_partition(name: str) -> bool:
    return name.startswith(PARTITION)


def _once(blocks: list[_Block]) -> tuple[Index, Index, Index]:
    """Elements that several groups list made one: rows, the row of each given element, and their numbers.

    A group that lists an element twice is left as it is, and refused later.
    """
    rows = np.vstack([block.nodes for block in blocks])
    numbers = np.concatenate([block.numbers for block in blocks])
    group = np.concatenate([np.full(len(b.nodes), (b.groups or (0,))[0]) for b in blocks])
    every = np.unique(np.hstack([group[:, None], rows]), axis=0)
    if len(every) < len(rows):
        return rows, np.arange(len(rows)), numbers
    _, first, which = np.unique(rows, axis=0, return_index=True, return_inverse=True)
    rank = np.argsort(np.argsort(first))  # the order of the file
    return rows[np.sort(first)], rank[which.ravel()], numbers[np.sort(first)]
