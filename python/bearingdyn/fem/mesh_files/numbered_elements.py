"""Nodes and elements by the numbers of a file, as formats of cards and records give them."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from bearingdyn.fem.mesh_files.raw_mesh import RawMesh
from bearingdyn.types import Index


@dataclass
class Numbered:
    """Nodes and elements by their numbers, as far as a mesh file has been read.

    Parameters
    ----------
    nodes
        number -> position.
    solids, faces
        number -> nodes in VTK's order, and the number of the property.
    element_groups, node_groups
        name -> numbers.
    """

    nodes: dict[int, tuple[float, ...]] = field(default_factory=dict)
    solids: dict[int, tuple[list[int], int]] = field(default_factory=dict)
    faces: dict[int, tuple[list[int], int]] = field(default_factory=dict)
    element_groups: dict[str, set[int]] = field(default_factory=dict)
    node_groups: dict[str, set[int]] = field(default_factory=dict)

    def add_node(self, number: int, place: tuple[float, ...]) -> None:
        """Raises ValueError for a number given before, or a place that is not finite."""
        if number in self.nodes:
            raise ValueError(f"node {number} is given twice")
        if not np.all(np.isfinite(place)):
            raise ValueError(f"node {number} is not finite")
        self.nodes[number] = place

    def add_element(self, number: int, nodes: list[int], prop: int, solid: bool) -> None:
        """Raises ValueError for a number given before."""
        if number in self.solids or number in self.faces:
            raise ValueError(f"element {number} is given twice")
        (self.solids if solid else self.faces)[number] = (nodes, prop)

    def mesh(self) -> RawMesh:
        """Groups of elements and properties as regions and surfaces; where there are groups, only those.

        Raises
        ------
        ValueError
            For an element that names a node the file does not have.
        """
        order = {n: k for k, n in enumerate(self.nodes)}
        by_size: dict[int, list[tuple[int, list[int]]]] = {}
        for number, (nodes, _) in self.solids.items():
            by_size.setdefault(len(nodes), []).append((number, self._rows(number, nodes, order)))
        position: dict[int, int] = {}
        for of_size in by_size.values():
            for number, _ in of_size:
                position[number] = len(position)
        groups = self.element_groups or self._properties()
        regions: dict[str, Index] = {}
        surfaces: dict[str, Index] = {}
        for name, members in self.node_groups.items():
            surfaces[name] = np.array(sorted(order[n] for n in members if n in order), dtype=np.intp)
        for name, members in groups.items():
            inside = sorted(position[n] for n in members if n in position)
            skin = {k for n in members if n in self.faces for k in self._rows(n, self.faces[n][0], order)}
            if inside:
                regions[name] = np.array(inside, dtype=np.intp)
            elif skin:
                surfaces[name] = np.array(sorted(skin), dtype=np.intp)
        return RawMesh(
            points=np.array(list(self.nodes.values()), dtype=np.float64).reshape(-1, 3),
            cells=tuple(np.array([rows for _, rows in own], dtype=np.intp) for own in by_size.values()),
            numbers=np.array(list(position), dtype=np.intp),
            regions=regions,
            surfaces={name: at for name, at in surfaces.items() if at.size},
        )

    def _properties(self) -> dict[str, set[int]]:
        found: dict[str, set[int]] = {}
        for elements in (self.solids, self.faces):
            for number, (_, prop) in elements.items():
                found.setdefault(str(prop), set()).add(number)
        return found

    @staticmethod
    def _rows(number: int, nodes: list[int], order: dict[int, int]) -> list[int]:
        for n in nodes:
            if n not in order:
                raise ValueError(f"element {number} names node {n}, which the file does not have")
        return [order[n] for n in nodes]
