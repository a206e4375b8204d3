"""A part whose stiffness and mass come from another finite element program."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace

import numpy as np
import scipy.sparse
from scipy.sparse.csgraph import connected_components

from bearingdyn.checks import instance, named
from bearingdyn.cms import (
    F_MAX,
    FullModel,
    RigidInterface,
    RoundFace,
    Superelement,
    check_damping,
    check_f_max,
    check_held,
    face_of_nodes,
    reduce,
)
from bearingdyn.fem import FEMatrices
from bearingdyn.parts.node_set import NodeSet
from bearingdyn.pictures import page
from bearingdyn.plausible_ranges import check_reference
from bearingdyn.short_repr import short
from bearingdyn.types import Array


@dataclass(frozen=True, eq=False)
class Imported:
    """An imported body: another program's matrices, reduced like any other part.

    Parameters
    ----------
    matrices
        From fem.read_matrices, with points. Matrices reduced already (Craig-Bampton: nodes of six
        coordinates, then modal ones, `internal` of them) are taken too: each such node is an interface.
    interfaces
        name -> the nodes that move as one rigid body.
    outputs
        name -> number of a node, or a position (x, y, z), m, whose nearest node is meant; rows (3, n), or (6,
        n) at a node of six coordinates.
    damping
        Ratio ζ of every elastic mode, of the free body or of the body held at the interface `held`.
    f_max
        Modes with the interfaces held are kept up to this frequency, Hz; 0: none; by default 20 kHz;
        math.inf: all, for matrices that are reduced already.

    Raises
    ------
    ValueError
        For an interface without nodes, with nodes on one line, or with nodes the matrices do not have; for a
        part of the mesh that no interface holds; and for values outside their range.
    """

    matrices: FEMatrices
    interfaces: Mapping[str, NodeSet]
    outputs: Mapping[str, int | tuple[float, float, float]] = field(default_factory=dict)
    damping: float = 0.0
    held: str | None = None
    f_max: float = F_MAX

    __repr__ = short
    _repr_html_ = page

    def __post_init__(self) -> None:
        instance("matrices", self.matrices, FEMatrices, "it must be of bd.read_matrices(…)")
        remedy = "it must be a mapping, name -> NodeSet"
        for name, face in named("interfaces", self.interfaces, remedy).items():
            instance(f"interfaces[{name!r}]", face, NodeSet, "it must be a bd.NodeSet(…)")
        named("outputs", self.outputs, "it must be a mapping, name -> node or (x, y, z)")
        if self.matrices.points is None:
            raise ValueError("matrices has no points; pass the nodes' positions when they are read")
        check_damping(self.damping)
        check_f_max(self.f_max, may_be_infinite=True)
        check_held(self.held, self.interfaces)
        if not self.interfaces:
            raise ValueError("interfaces is empty; a part needs at least one to be joined by")
        faces = self._faces()
        for name in self.outputs:
            if name in self.interfaces:
                raise ValueError(f"outputs has {name!r}, the name of an interface; choose another")
            self._rows(name)
        self._check_held_together(faces)

    @property
    def mass(self) -> float:
        """Mass, kg."""
        x = self.matrices.rigid_motion((0.0, 0.0, 0.0))[:, 0]
        return float(x @ (self.matrices.M @ x))

    def full_model(self) -> FullModel:
        """The unreduced equations: sparse matrices, rigid interfaces, output rows."""
        rows = {name: self._rows(name) for name in self.outputs}
        return FullModel(M=self.matrices.M, K=self.matrices.K, interfaces=self._faces(), outputs=rows)

    def superelement(self) -> Superelement:
        """The body reduced onto its interfaces and the fixed-interface modes up to f_max."""
        element = reduce(self.full_model(), f_max=self.f_max, damping=self.damping, held=self.held)
        return replace(element, faces=self.round_faces())

    def round_faces(self) -> Mapping[str, tuple[RoundFace, ...]]:
        """Cylinders at its interfaces, where the nodes of one lie on one about z.

        The body lies where the nodes are that the stiffness joins to them.
        """
        p, at = self._points(), self.matrices.places[:, 0]
        K, found = scipy.sparse.csr_matrix(self.matrices.K), {}
        for name, face in self._faces().items():
            joined = at[np.unique(K[face.dofs].indices)]
            nodes, around = np.unique(at[face.dofs]), np.unique(joined[joined >= 0])
            x, y, z = face.position
            radius = np.hypot(p[:, 0] - x, p[:, 1] - y)
            found[name] = face_of_nodes(radius[nodes], p[nodes, 2], radius[around], float(z))
        return found

    def _points(self) -> Array:
        assert self.matrices.points is not None
        return self.matrices.points

    def _row_of(self, where: str, number: int) -> int:
        """Row in points of a node's number."""
        nodes, count = self.matrices.nodes, len(self._points())
        found = np.flatnonzero((np.arange(count) if nodes is None else nodes) == number)
        if not found.size:
            raise ValueError(f"{where} names node {number}, which the matrices do not have")
        return int(found[0])

    def _faces(self) -> dict[str, RigidInterface]:
        p, place = self._points(), self.matrices.places
        faces = {}
        for name, chosen in self.interfaces.items():
            where = f"interfaces[{name!r}]"
            if callable(chosen.nodes):
                mask = np.asarray(chosen.nodes(p))
                if mask.shape != (len(p),) or mask.dtype != np.bool_:
                    raise ValueError(
                        f"{where}: its function gave {mask.dtype} of shape {mask.shape}; it must give a "
                        f"truth value for each of {len(p)} positions"
                    )
                rows = np.flatnonzero(mask)
            else:
                rows = np.array([self._row_of(where, int(i)) for i in chosen.nodes], dtype=np.intp)
            if not rows.size:
                raise ValueError(f"{where} has no nodes; the positions run from {p.min(0)} to {p.max(0)} m")
            given = p[rows].mean(axis=0) if chosen.reference is None else chosen.reference
            reference = np.asarray(given, dtype=np.float64)
            check_reference(f"the reference of {where}", reference, p)
            dofs = np.flatnonzero(np.isin(place[:, 0], rows))
            T = self.matrices.rigid_motion(reference)[dofs]
            size = float(np.linalg.norm(T[:, 3:], axis=0).max())
            scaled = T / np.array([1.0] * 3 + [size or 1.0] * 3)
            if np.linalg.matrix_rank(scaled, tol=1e-6 * np.linalg.norm(scaled)) < 6:
                raise ValueError(
                    f"{where} has {rows.size} nodes, on a point or a line; a rigid interface needs three "
                    "that are not, or one of six coordinates"
                )
            faces[name] = RigidInterface(dofs, T, reference)
        return faces

    def _rows(self, name: str) -> scipy.sparse.csr_matrix:
        p, place, target = self._points(), self.matrices.places, self.outputs[name]
        where = f"outputs[{name!r}]"
        if isinstance(target, int | np.integer):
            row = self._row_of(where, int(target))
        else:
            position = np.asarray(target, dtype=np.float64)
            if position.shape != (3,) or not np.isfinite(position).all():
                raise ValueError(f"{where} is {target!r}; it must be a node's number or (x, y, z), m")
            row = int(np.argmin(np.linalg.norm(p - position, axis=1)))
        at = np.flatnonzero(place[:, 0] == row)
        direction = place[at, 1]
        count = 6 if direction.size == 6 else 3
        at, direction = at[direction < count], direction[direction < count]
        if direction.size < count:
            raise ValueError(f"{where} is a node without a coordinate for each of x, y, z; choose another")
        shape = (count, self.matrices.n)
        return scipy.sparse.csr_matrix((np.ones(count), (direction, at)), shape=shape)

    def _check_held_together(self, faces: Mapping[str, RigidInterface]) -> None:
        """Every piece of the mesh hangs on an interface."""
        model = self.matrices
        count, label = connected_components(model.K, directed=False)
        held = {int(i) for face in faces.values() for i in label[face.dofs]}
        at_nodes = model.places[:, 0] >= 0
        for piece in set(range(count)) - held:
            inside = np.flatnonzero((label == piece) & at_nodes)
            if inside.size:
                raise ValueError(
                    f"matrices hold a piece of {inside.size} coordinates, {model.name(int(inside[0]))} among "
                    "them, that is joined to no interface; tie it in the export, or give it an interface"
                )
