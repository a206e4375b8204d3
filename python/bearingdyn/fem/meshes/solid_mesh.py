"""Meshes of solids: nodes, second-order elements, regions and surfaces with names."""

from __future__ import annotations

import copy
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any

import numpy as np
import scipy.sparse
from numpy.typing import ArrayLike
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree

from bearingdyn.checks import indices, instance, meant, named, reals
from bearingdyn.fem.meshes.solid_element import (
    HEX20,
    HEX27,
    KINDS,
    NAMES,
    OF_CORNERS,
    SolidElement,
    by_size,
    face_places,
    face_points,
    face_shapes,
    points,
    shapes,
)
from bearingdyn.notice import FoldedMesh, warn
from bearingdyn.types import Array, Index

MIDDLE = 0.3  # a middle node may lie this far from the middle of its edge, in lengths of the edge


@dataclass(frozen=True, eq=False, kw_only=True)
class SurfaceSamples:
    """Solid mesh, one surface of it by integration points: Σ weights·f is ∫ f dA.

    Parameters
    ----------
    positions
        (q, 3), m.
    normals
        (q, 3), outward, of unit length.
    weights
        (q,), all positive, m².
    interpolation
        (q, n) sparse, a nodal field's values at the points.
    """

    positions: Array
    normals: Array
    weights: Array
    interpolation: Any

    @property
    def area(self) -> float:
        """Area, m²."""
        return float(self.weights.sum())

    @property
    def centroid(self) -> Array:
        """Centre of the area, (3,), m."""
        return np.asarray(self.weights @ self.positions / self.weights.sum())

    @property
    def rows(self) -> Any:
        """(3 q, 3 n) sparse: x, y, z of every sample from the displacements of the nodes."""
        return scipy.sparse.kron(self.interpolation, scipy.sparse.eye(3)).tocsr()

    @property
    def normal_rows(self) -> Any:
        """(q, 3 n) sparse: outward normal displacement of every sample from those of the nodes."""
        q = np.arange(len(self.weights))
        turn = scipy.sparse.csr_matrix(
            (self.normals.ravel(), (np.repeat(q, 3), np.arange(3 * len(q)))), shape=(len(q), 3 * len(q))
        )
        return turn @ self.rows

    def normal_of(self, shapes: Array) -> Array:
        """(q, m) outward normal displacement of every sample in shapes (3 n, m) of the nodes."""
        at = self.interpolation @ shapes.reshape(self.interpolation.shape[1], -1)
        moved = np.asarray(at).reshape(len(self.weights), 3, shapes.shape[1])
        return np.asarray((self.normals[:, None] @ moved)[:, 0])

    @property
    def mean_rows(self) -> Any:
        """(3, 3 n) sparse: displacement averaged over the area."""
        mean = scipy.sparse.csr_matrix(self.weights[None] / self.area) @ self.interpolation
        return scipy.sparse.kron(mean, scipy.sparse.eye(3)).tocsr()


@dataclass(frozen=True, eq=False)
class SolidMesh:
    """A mesh of a solid: second-order elements that hang together, regions, surfaces.

    They are 27-node bricks, or 20-node bricks, 15-node wedges, 13-node pyramids and 10-node tetrahedra, of
    one kind or mixed.

    Parameters
    ----------
    points
        (n, 3) nodes, m.
    elements
        (m, 10 to 27) nodes of each element, numbered as VTK and Abaqus do: corners, middles of edges, and
        for 27 the middles of the faces x−, x+, y−, y+, z−, z+ and the centre. Among larger elements, the row
        of a smaller one ends in −1.
    regions
        name -> elements, each element in one; none given: one region "body".
    surfaces
        name -> nodes.
    numbers
        (m,) what to call the elements in messages (default: from 0).

    Raises
    ------
    ValueError
        Naming the element or node, for an element turned inside out, numbered in the order of a mirror image
        or with a middle node far from its edge, for nodes that no element has, bodies that do not hang
        together, kinds whose faces do not fit, pyramids that are missing between bricks and tetrahedra, an
        element in no region or in two, and an empty surface.

    Warns
    -----
    FoldedMesh
        For an element that lies within its neighbours.
    """

    points: Array
    elements: Index
    regions: Mapping[str, Index] = field(default_factory=dict)
    surfaces: Mapping[str, Index] = field(default_factory=dict)
    numbers: Index | None = None

    def __repr__(self) -> str:
        """One line instead of the nodes."""
        many = " and ".join(f"{len(at)} elements of {kind.nodes} nodes" for kind, at in self.groups)
        size = f"{many}, {len(self.points)} nodes"
        return f"<SolidMesh of {size}, regions {list(self.regions)}, surfaces {list(self.surfaces)}>"

    def __post_init__(self) -> None:
        p = reals("points", self.points, "it must be real numbers, (n, 3), in m")
        e = indices("elements", self.elements, "it must be numbers of nodes, a row for each element")
        if p.ndim != 2 or p.shape[1] != 3 or not np.all(np.isfinite(p)):
            raise ValueError(f"points has shape {p.shape}; it must be (n, 3), finite")
        if e.ndim != 2 or e.shape[1] not in KINDS or not len(e):
            raise ValueError(
                f"elements has shape {e.shape}; a row holds 20 or 27 nodes of a brick, 15 of a wedge, 13 of "
                "a pyramid or 10 of a tetrahedron (second_order makes them of corners)"
            )
        numbers = np.arange(len(e))
        if self.numbers is not None:
            numbers = indices("numbers", self.numbers, "it must be whole numbers, one for each element")
        object.__setattr__(self, "points", p)
        object.__setattr__(self, "elements", e)
        object.__setattr__(self, "numbers", numbers)
        if numbers.shape != (len(e),):
            raise ValueError(
                f"numbers has shape {numbers.shape}; it must be ({len(e)},), one for each element"
            )
        there = e >= 0
        count = there.sum(axis=1)
        wrong = ~np.isin(count, list(KINDS)) | (there != (np.arange(e.shape[1]) < count[:, None])).any(axis=1)
        for k in np.flatnonzero(wrong | (e < -1).any(axis=1) | (e >= len(p)).any(axis=1))[:1].tolist():
            raise ValueError(f"element {numbers[k]} names a node outside 0...{len(p) - 1}")
        if len(self.groups) > 1 and any(kind.centres for kind, _ in self.groups):
            raise ValueError(
                "elements mix 27-node bricks with another kind, whose faces have no middle node; "
                "use 20-node bricks"
            )
        self._check_connection()
        self._check_shapes()
        regions = _sets("regions", self.regions, "elements")
        regions = regions or {"body": np.arange(len(e))}
        uses = np.zeros(len(e), dtype=int)
        for name, at in regions.items():
            if not at.size:
                raise ValueError(f"regions[{name!r}] is empty; it must name elements")
            if at[0] < 0 or at[-1] >= len(e):
                raise ValueError(f"regions[{name!r}] names an element outside 0...{len(e) - 1}")
            uses[at] += 1
        for k in np.flatnonzero(uses != 1)[:1].tolist():
            owners = [name for name, at in regions.items() if k in at]
            where = f"in the regions {owners}" if owners else "in no region"
            raise ValueError(f"element {numbers[k]} is {where}; each must be in one of {sorted(regions)}")
        object.__setattr__(self, "regions", regions)
        surfaces = _sets("surfaces", self.surfaces, "nodes")
        for name, at in surfaces.items():
            if not at.size:
                raise ValueError(f"surfaces[{name!r}] is empty; it must name nodes")
            if at[0] < 0 or at[-1] >= len(p):
                raise ValueError(f"surfaces[{name!r}] names a node outside 0...{len(p) - 1}")
        object.__setattr__(self, "surfaces", surfaces)

    def _check_connection(self) -> None:
        p, e = self.points, self.elements
        used = np.zeros(len(p), dtype=bool)
        used[e[e >= 0]] = True
        loose = np.flatnonzero(~used)
        if loose.size:
            raise ValueError(
                f"{loose.size} nodes belong to no element, the first at {p[loose[0]].tolist()} m "
                f"(node {loose[0]}, from 0); remove them (read_mesh: drop_unconnected=True)"
            )
        linked = np.where(e >= 0, e, e[:, :1])
        first = np.repeat(e[:, 0], e.shape[1])
        graph = scipy.sparse.coo_matrix(
            (np.ones(first.size, dtype=bool), (first, linked.ravel())), (len(p),) * 2
        )
        count, label = connected_components(graph, directed=False)
        if count > 1:
            sizes = np.bincount(label[e[:, 0]], minlength=count)
            twins = len(cKDTree(p).query_pairs(1e-9 * float(np.ptp(p, axis=0).max()), output_type="ndarray"))
            remedy = (
                f"{twins} pairs of nodes coincide: join them (read_mesh: merge=1e-9, a distance in m)"
                if twins
                else "read each body by itself"
            )
            raise ValueError(
                f"the elements fall into {count} bodies that share no node, of "
                f"{', '.join(map(str, sizes[:6]))} elements; {remedy}"
            )

    def _check_shapes(self) -> None:
        for kind, at in self.groups:
            self._check_kind(kind, at)
        if len(self.groups) > 1:
            self._check_fit()
        self._check_sides()

    def _check_kind(self, kind: SolidElement, at: Index) -> None:
        """Shapes of the elements `at`, all of one kind."""
        assert self.numbers is not None
        p, e, numbers = self.points, self.elements[at, : kind.nodes], self.numbers[at]
        c = len(kind.corners)
        first, twin = np.unique(np.sort(e[:, :c], axis=1), axis=0, return_index=True, return_inverse=True)[1:]
        for k in np.flatnonzero(first[twin.ravel()] != np.arange(len(e)))[:1].tolist():
            other = numbers[first[twin.ravel()[k]]]
            raise ValueError(f"elements {other} and {numbers[k]} have the same corners; keep one of them")
        ends = p[e[:, np.array(kind.edges)]]  # (m, edges, 2, 3)
        off = np.linalg.norm(p[e[:, c : c + len(kind.edges)]] - ends.mean(axis=2), axis=2)
        length = np.linalg.norm(ends[:, :, 1] - ends[:, :, 0], axis=2)
        far = off > MIDDLE * length
        for k in np.flatnonzero(far.any(axis=1))[:1].tolist():
            raise ValueError(
                f"element {numbers[k]} has a middle node far from the middle of its edge (its "
                f"node {c + int(np.argmax(far[k]))}, from 0); nodes must be in VTK's order"
            )
        if kind.centres:
            expected = shapes(HEX20, HEX27.places[20:])[0] @ p[e[:, :20]]
            off = np.linalg.norm(p[e[:, 20:]] - expected, axis=2)
            for k in np.flatnonzero((off > MIDDLE * length.max(axis=1)[:, None]).any(axis=1))[:1].tolist():
                raise ValueError(
                    f"element {numbers[k]} has the middle of a face or its centre out of place "
                    f"(its node {20 + int(np.argmax(off[k]))}, from 0); nodes must be in VTK's order"
                )
        det = np.linalg.det(self._jacobians(kind, points(kind)[0], at))
        for k in np.flatnonzero(~np.all(det > 0, axis=1))[:1].tolist():
            if np.all(det[k] < 0):
                raise ValueError(
                    f"element {numbers[k]} has the nodes of a mirror image: corners 0, 1, 2 must turn "
                    "anticlockwise seen from the other end; renumber its nodes"
                )
            raise ValueError(
                f"element {numbers[k]} is turned inside out: its volume changes sign inside; "
                "check the order of its nodes, or refine the mesh"
            )

    def _check_fit(self) -> None:
        """No triangle of the boundary may have its corners in a quadrilateral: there the mesh is torn."""
        faces = {n: self.boundary[at] for at, n in by_size(self.boundary)}
        if len(faces) < 2:
            return
        corners4 = next(rows for n, rows in faces.items() if n != 6)[:, :4]
        quads = np.sort(corners4, axis=1)
        three = np.vstack([np.delete(quads, i, axis=1) for i in range(4)])
        both, count = np.unique(
            np.vstack([np.unique(three, axis=0), np.unique(np.sort(faces[6][:, :3], axis=1), axis=0)]),
            axis=0,
            return_counts=True,
        )
        for corners in both[count > 1][:1]:
            place = self.points[corners].mean(axis=0).tolist()
            raise ValueError(
                f"triangles lie on a quadrilateral near {place} m, where their middle nodes do not fit; "
                "put pyramids between bricks and tetrahedra"
            )
        self._check_edges(faces[6][:, :3], corners4)

    def _check_edges(self, triangles: Index, quads: Index) -> None:
        """Two faces of the outside meet in an edge; four do where pyramids between two kinds are missing."""
        edges, four = [], []
        for rows in (triangles, quads):
            edges.append(np.sort(np.stack([rows, np.roll(rows, -1, axis=1)], axis=2).reshape(-1, 2), axis=1))
            four.append(np.full(len(edges[-1]), rows.shape[1] == 4))
        key, which, count = np.unique(np.vstack(edges), axis=0, return_inverse=True, return_counts=True)
        of_quads = np.bincount(which.ravel(), np.concatenate(four), minlength=len(key))
        open_edges = np.flatnonzero((count > 2) & (of_quads > 0) & (of_quads < count))
        if open_edges.size:
            place = self.points[key[open_edges[0]]].mean(axis=0).tolist()
            raise ValueError(
                f"elements with quadrilaterals and with triangles meet in {open_edges.size} edges without a "
                f"common face, the first near {place} m: the pyramids between them are missing, as gmsh "
                "leaves them out of .unv files; export .msh, .inp or .vtk"
            )

    def _check_sides(self) -> None:
        """Warn of elements on the same side of a face they share: one is folded into its neighbours."""
        assert self.numbers is not None
        corners, owner = self._corner_faces
        _, first, which, count = np.unique(
            np.sort(corners, axis=1), axis=0, return_index=True, return_inverse=True, return_counts=True
        )
        which = which.ravel()
        # from the least node, one way round or the other
        many = (corners >= 0).sum(axis=1)
        start, row = (
            np.argmin(np.where(corners >= 0, corners, len(self.points)), axis=1),
            np.arange(len(many)),
        )
        turn = corners[row, (start + 1) % many] < corners[row, (start - 1) % many]
        twin = row != first[which]
        same = twin & (turn == turn[first[which]])
        doubled = np.unique(owner[same | (count[which] > 2)])
        if doubled.size:
            extra = np.unique(np.concatenate([owner[same], owner[first[which[same]]]]), return_counts=True)
            worst = extra[0][np.argmax(extra[1])] if extra[0].size else doubled[0]
            nodes = self.elements[worst]
            place = np.round(self.points[nodes[nodes >= 0]].mean(axis=0), 6).tolist()
            warn(
                f"element {self.numbers[worst]} and its neighbours, near {place} m, lie on the same side of "
                f"their common faces ({int(same.sum())} in all): an element there is "
                "folded, and what it covers counts twice; gmsh does that beside pyramids: mesh again with "
                "other sizes",
                FoldedMesh,
            )

    def _jacobians(self, kind: SolidElement, X: Array, elements: Index) -> Array:
        """∂x_a/∂ξ_b of elements of a kind at points X (q, 3): (m, q, 3, 3)."""
        gradient = shapes(kind, X)[1]
        nodes = self.elements[elements, : kind.nodes]
        return np.asarray(np.einsum("mka,qkb->mqab", self.points[nodes], gradient, optimize=True))

    @cached_property
    def groups(self) -> tuple[tuple[SolidElement, Index], ...]:
        """Its kinds of elements, and which elements are of each."""
        count = (self.elements >= 0).sum(axis=1)
        return tuple((KINDS[n], np.flatnonzero(count == n)) for n in np.unique(count).tolist())

    @property
    def kind(self) -> SolidElement:
        """The kind of its elements. Raises ValueError if they are of more than one."""
        if len(self.groups) > 1:
            names = " and ".join(f"{kind.nodes}-node {NAMES[kind.name[:3]]}s" for kind, _ in self.groups)
            raise ValueError(f"the mesh mixes {names}; `groups` tells which elements are of which kind")
        return self.groups[0][0]

    def volume(self, region: str | None = None) -> float:
        """Volume of a region, or of all, m³."""
        total = 0.0
        for kind, at in self.groups:
            some = at if region is None else np.intersect1d(at, self.regions[region])
            X, w = points(kind)
            total += float((np.linalg.det(self._jacobians(kind, X, some)) @ w).sum())
        return total

    def surface(self, name: str) -> Index:
        """Nodes of a surface. Raises ValueError, listing the known, for a name the mesh does not have."""
        instance("surface", name, str, f"it must be the name of one: {sorted(self.surfaces)}")
        if name not in self.surfaces:
            raise ValueError(f"the mesh has no surface {name!r}; {meant(name, self.surfaces)}")
        return self.surfaces[name]

    def with_surface(self, name: str, where: Callable[[Array], Any]) -> SolidMesh:
        """The mesh with one more surface: the nodes of the boundary for whose points (k, 3) `where` is true.

        Raises
        ------
        ValueError
            If there is none, or the name is taken.
        """
        if name in self.surfaces:
            raise ValueError(f"the mesh has a surface {name!r} already; choose another name")
        outside = np.unique(self.boundary)
        chosen = outside[np.asarray(where(self.points[outside]), dtype=bool)]
        if not chosen.size:
            raise ValueError(f"surface {name!r} is empty: no node of the boundary satisfies the condition")
        return self.naming(name, chosen)

    def with_region(self, name: str, where: Callable[[Array], Any]) -> SolidMesh:
        """The mesh with the elements for whose middles (m, 3) `where` is true made a region of that name.

        Raises
        ------
        ValueError
            If there is none, or the name is taken.
        """
        if name in self.regions:
            raise ValueError(f"the mesh has a region {name!r} already; choose another name")
        middle = np.zeros((len(self.elements), 3))
        for kind, at in self.groups:
            middle[at] = self.points[self.elements[at, : len(kind.corners)]].mean(axis=1)
        chosen = np.flatnonzero(np.asarray(where(middle), dtype=bool))
        if not chosen.size:
            raise ValueError(f"region {name!r} is empty: no element satisfies the condition")
        others = {n: np.setdiff1d(at, chosen) for n, at in self.regions.items()}
        return replace(self, regions={**{n: at for n, at in others.items() if at.size}, name: chosen})

    @cached_property
    def _corner_faces(self) -> tuple[Index, Index]:
        """Corners of the faces of every element, (f, 4), the fourth of a triangle −1; and whose they are."""
        corners, owner = [], []
        for kind, at in self.groups:
            of = np.where(kind.face_corners >= 0, self.elements[at][:, kind.face_corners], -1)
            corners.append(of.reshape(-1, 4))
            owner.append(np.repeat(at, of.shape[1]))
        return np.vstack(corners), np.concatenate(owner)

    @cached_property
    def boundary(self) -> Index:
        """Faces that one element alone has, (f, nodes of a face), seen from outside anticlockwise.

        A triangle among quadrilaterals repeats its last node.
        """
        width = max(kind.face_nodes.shape[1] for kind, _ in self.groups)
        faces = []
        for kind, at in self.groups:
            own = self.elements[at][:, kind.face_nodes]
            own = np.concatenate([own, np.repeat(own[..., -1:], width - own.shape[2], axis=2)], axis=2)
            faces.append(own.reshape(-1, width))
        every = np.sort(self._corner_faces[0], axis=1)
        _, first, count = np.unique(every, axis=0, return_index=True, return_counts=True)
        return np.asarray(np.vstack(faces)[np.sort(first[count == 1])])

    def faces(self, name: str) -> Index:
        """Boundary faces of a surface: those with all their nodes on it.

        Raises
        ------
        ValueError
            For an unknown name, or a surface that holds no face of the boundary.
        """
        on = np.isin(self.boundary, self.surface(name)).all(axis=1)
        if not on.any():
            raise ValueError(
                f"surface {name!r} holds no whole face of the boundary; give all the nodes of its faces"
            )
        return np.asarray(self.boundary[on])

    def samples(self, name: str) -> SurfaceSamples:
        """The integration points of a surface, 9 on each quadrilateral and 6 on each triangle.

        Raises
        ------
        ValueError
            As `faces` does.
        """
        return self.samples_of(self.faces(name))

    def samples_of(self, faces: Index) -> SurfaceSamples:
        """The integration points of some faces of the boundary, (f, nodes of a face), at least one."""
        positions, normals, weights, parts = [], [], [], []
        for at, n in by_size(faces):
            X, w = face_points(n)
            N, gradient = face_shapes(n, X)
            nodes = faces[at, :n]
            p = self.points[nodes]
            tangents = np.einsum("fka,qkb->fqba", p, gradient, optimize=True)
            normal = np.cross(tangents[:, :, 0], tangents[:, :, 1]).reshape(-1, 3)
            area = np.linalg.norm(normal, axis=1)
            f, q = nodes.shape[0], len(w)
            at_points = (np.repeat(np.arange(f * q), n), np.repeat(nodes, q, axis=0).ravel())
            value = np.tile(N, (f, 1)).ravel()
            positions.append((N @ p).reshape(-1, 3))
            normals.append(normal / area[:, None])
            weights.append(area * np.tile(w, f))
            parts.append(scipy.sparse.csr_matrix((value, at_points), shape=(f * q, len(self.points))))
        return SurfaceSamples(
            positions=np.vstack(positions),
            normals=np.vstack(normals),
            weights=np.concatenate(weights),
            interpolation=scipy.sparse.vstack(parts, format="csr"),
        )

    def face_normals(self, faces: Index) -> Iterator[tuple[Index, Array]]:
        """Nodes (f, n) of faces of the boundary by their size, and outward unit normals (f, n, 3) there."""
        for at, n in by_size(faces):
            nodes = faces[at, :n]
            gradient = face_shapes(n, face_places(n))[1]
            tangents = np.einsum("fka,qkb->fqba", self.points[nodes], gradient, optimize=True)
            normal = np.cross(tangents[:, :, 0], tangents[:, :, 1])
            yield nodes, normal / np.linalg.norm(normal, axis=2, keepdims=True)

    def moved(self, points: Array) -> SolidMesh:
        """The mesh with its nodes at other points (n, 3), unchecked: a deformation has kept it whole."""
        found = copy.copy(self)  # and what is known of how its elements hang together
        object.__setattr__(found, "points", points)
        return found

    def naming(self, name: str, nodes: Index) -> SolidMesh:
        """The mesh with one more surface, of some of its nodes, rising; unchecked."""
        found = copy.copy(self)
        object.__setattr__(found, "surfaces", {**self.surfaces, name: nodes})
        return found

    def with_centres(self) -> SolidMesh:
        """20-node bricks made 27-node ones, new nodes where the 20-node shapes put them; else unchanged."""
        if [kind for kind, _ in self.groups] != [HEX20]:
            return self
        e, n = self.elements, len(self.points)
        weight = shapes(HEX20, HEX27.places[20:])[0]  # (7, 20)
        faces = e[:, np.array(HEX27.faces)].reshape(-1, 4)
        _, first, which = np.unique(np.sort(faces, axis=1), axis=0, return_index=True, return_inverse=True)
        new = np.einsum("jk,mka->mja", weight, self.points[e], optimize=True)
        centres = np.hstack([n + which.reshape(-1, 6), n + first.size + np.arange(len(e))[:, None]])
        around = e[:, HEX20.face_nodes].reshape(-1, 8)[first]
        surfaces = {
            name: np.concatenate([at, n + np.flatnonzero(np.isin(around, at).all(axis=1))])
            for name, at in self.surfaces.items()
        }
        return replace(
            self,
            points=np.vstack([self.points, new[:, :6].reshape(-1, 3)[first], new[:, 6]]),
            elements=np.hstack([e, centres]),
            surfaces=surfaces,
        )


def second_order(points: ArrayLike, corners: ArrayLike) -> tuple[Array, Index, Index]:
    """A mesh of straight-edged solid elements made second-order, with middle nodes.

    Parameters
    ----------
    points
        (n, 3).
    corners
        (m, 8, 6, 5 or 4); among larger elements, the row of a smaller one ends in −1.

    Returns
    -------
    points : (n', 3) array
        The given points, then the new ones.
    elements : (m, 20, 15, 13 or 10) array
        Nodes of each element, rows of smaller ones ended in −1.
    ends : (n' − n, 2) array
        The two points between which each new one lies.
    """
    p, c = np.asarray(points, dtype=np.float64), np.asarray(corners, dtype=np.intp)
    count = (c >= 0).sum(axis=1)
    groups = [(OF_CORNERS[n], np.flatnonzero(count == n)) for n in np.unique(count).tolist()]
    edges = [np.sort(c[at][:, np.array(kind.edges)].reshape(-1, 2), axis=1) for kind, at in groups]
    every = np.vstack(edges)
    key, which = np.unique(every[:, 0] * len(p) + every[:, 1], return_inverse=True)
    ends = np.stack([key // len(p), key % len(p)], axis=1)
    elements = np.full((len(c), max(kind.nodes for kind, _ in groups)), -1, dtype=np.intp)
    start = 0
    for (kind, at), own in zip(groups, edges, strict=True):
        middles = len(p) + which.ravel()[start : start + len(own)].reshape(len(at), -1)
        elements[at, : kind.nodes] = np.hstack([c[at, : len(kind.corners)], middles])
        start += len(own)
    return np.vstack([p, p[ends].mean(axis=1)]), elements, ends


def merged(points: ArrayLike, tolerance: float) -> tuple[Array, Index]:
    """For a solid mesh: points closer than the tolerance made one; and each point's new number."""
    p = np.asarray(points, dtype=np.float64)
    pairs = cKDTree(p).query_pairs(tolerance, output_type="ndarray")
    graph = scipy.sparse.coo_matrix((np.ones(len(pairs)), (pairs[:, 0], pairs[:, 1])), shape=(len(p),) * 2)
    count, label = connected_components(graph, directed=False)
    unique = np.zeros((count, p.shape[1]))
    unique[label[::-1]] = p[::-1]
    return unique, np.asarray(label, dtype=np.intp)


def _sets(field: str, given: Mapping[str, ArrayLike], what: str) -> dict[str, Index]:
    """Sets of a mesh by name, each ascending; ValueError for what is no mapping of numbers."""
    found = named(field, given, f"it must be a mapping, name -> numbers of {what}")
    remedy = f"it must be numbers of {what}"
    return {name: np.unique(indices(f"{field}[{name!r}]", at, remedy)) for name, at in found.items()}
