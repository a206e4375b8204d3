"""A solid deformed between rigid plates: what they do to it, and the static state they leave."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
import scipy

from bearingdyn.checks import meant, name_list, require, vector
from bearingdyn.cms import RigidInterface
from bearingdyn.fem import SAME, NoBalance, SolidElements, SolidMesh, SolidState, Wall, balance, rigid_motion
from bearingdyn.parts.prestress import FOLD, FOLDED, blame_the_law, check_reach, unstable
from bearingdyn.parts.squeezed import Squeezed
from bearingdyn.short_repr import short
from bearingdyn.types import Array, Index

Move = float | Sequence[float]
"""A depth along the inward normal, m; (x, y, z), m; or (x, y, z, θx, θy, θz) of the reference, m and rad."""
MOVE = "it must be a depth into the body, m, or its motion (x, y, z) or (x, y, z, θx, θy, θz), m and rad"
BALANCED = 1e-8  # resultant on a face, over the sum of its nodal forces, that counts as none
PUSHED = 1e-6  # reaction, over the largest nodal force, with which nothing may be pushed aside
ROUND_EDGE = "round off or recess the free surface there, or let the plate slip (slip=...)"


@dataclass(frozen=True, eq=False)
class Plate:
    """A rigid plate on a solid: the nodes it holds, and the reference (3,), m, of its six coordinates."""

    nodes: Index
    reference: Array


@dataclass(frozen=True, eq=False)
class SolidPrestress:
    """The static state of a deformed solid.

    Parameters
    ----------
    state
        Deformed elements.
    mesh
        The mesh where it is now.
    plates
        name -> Plate, with the nodes that touch it, and its reference where it is now.
    sliding
        Those that slipped while they were pressed on, with the nodes they had before.
    branches
        "current" or "separable"; see Revolved.assembled.
    """

    state: SolidState
    mesh: SolidMesh
    plates: Mapping[str, Plate]
    sliding: Mapping[str, Plate]
    branches: str

    __repr__ = short

    @cached_property
    def _force(self) -> Array:
        return self.state.force.reshape(-1, 3)

    def _arms(self, name: str) -> tuple[Array, Array]:
        """Forces (k, 3) of a plate on its nodes, and these from its reference, m."""
        plate = self.plates[name]
        return self._force[plate.nodes], self.mesh.points[plate.nodes] - plate.reference

    def force(self, name: str) -> tuple[float, ...]:
        """Force of a plate on the body, N, and its moment about the reference, N m: (6,)."""
        f, x = self._arms(name)
        return tuple(float(v) for v in (*f.sum(axis=0), *np.cross(x, f).sum(axis=0)))

    def load_terms(self, name: str) -> Array:
        """What the forces on a plate add to the stiffness (3, 3) of its rotation, N m.

        A plate that turns by θ carries its nodes by θ × x + ½ θ × (θ × x); the forces on them work along the
        second part too.
        """
        f, x = self._arms(name)
        turned = f.T @ x
        return np.asarray(0.5 * (turned + turned.T) - np.trace(turned) * np.eye(3))

    @property
    def self_balanced(self) -> bool:
        """Whether each plate bears no resultant: then a rigid rotation of the body costs nothing."""
        for name in self.plates:
            f, x = self._arms(name)
            scale = float(np.abs(f).sum())
            pull, turn = np.array(self.force(name)).reshape(2, 3)
            if np.abs(pull).max() > BALANCED * scale:
                return False
            if np.abs(turn).max() > BALANCED * scale * max(float(np.abs(x).max()), 1e-300):
                return False
        return True

    def area(self, name: str) -> float:
        """Area, m², over which the body touches a plate now."""
        faces = _faces_of(self.mesh, self.plates[name].nodes)
        return self.mesh.samples_of(faces).area if len(faces) else 0.0

    def lost(self, name: str) -> float:
        """Area, m², over which the body has parted from a plate it slipped on."""
        before = self.sliding.get(name)
        if before is None:
            return 0.0
        faces = _faces_of(self.mesh, before.nodes)
        parted = faces[~np.isin(faces, self.plates[name].nodes).all(axis=1)]
        return self.mesh.samples_of(parted).area if len(parted) else 0.0

    @property
    def bulge(self) -> float:
        """Largest outward motion of the free surface, m."""
        before = self.state.body.mesh
        free = free_nodes(before, self.plates)
        if not free.size:
            return 0.0
        normal = node_normals(before, before.boundary)[free]
        return float(max(0.0, np.sum(self.state.u[free] * normal, axis=1).max()))

    @cached_property
    def stretch(self) -> Array:
        """Largest principal stretch at each node, the mean of the elements there, (nodes,)."""
        total, count = (np.zeros(len(self.mesh.points)) for _ in range(2))
        for nodes, deformed in self.state.elements:
            k = nodes.shape[1]
            mean = np.average(deformed.stretches[..., -1], axis=1, weights=deformed.weights)
            total += np.bincount(nodes.ravel(), np.repeat(mean, k), len(total))
            count += np.bincount(nodes.ravel(), minlength=len(total))
        return np.asarray(total / count)

    def tangents(self, region: int) -> tuple[Any, Any]:
        """Of a region, sparse: the static tangent, N/m, without what the frequency changes; and H of that, m.

        The tangent is 2 G H more than the first, with the static shear modulus G.
        """
        H = self.state.deviatoric([region], self.branches)
        return self.state.stiffness([region]) - 2.0 * self.state.body.shear[region] * H, H

    def loads(self, interfaces: Mapping[str, RigidInterface]) -> Any:
        """`load_terms` of all plates in the coordinates of the nodes, sparse."""
        n = self.mesh.points.size
        total = scipy.sparse.csr_matrix((n, n))
        for name, face in interfaces.items():
            # the rotation is read off three nodes, for a plate is rigid: the matrix stays sparse
            x = face.T.reshape(-1, 3, 6)
            three = _spread(self.mesh.points[self.plates[name].nodes])
            turn = np.linalg.pinv(x[three].reshape(9, 6))[3:]
            at = face.dofs.reshape(-1, 3)[three].ravel()
            rows = scipy.sparse.csr_matrix(
                (turn.ravel(), (np.repeat(np.arange(3), 9), np.tile(at, 3))), (3, n)
            )
            total = total + rows.T @ scipy.sparse.csr_matrix(self.load_terms(name)) @ rows
        return total

    def told(self, part: Any, pressed: str) -> Squeezed:
        """What the state tells of a part, of which a plate was moved."""
        push, pressure, areas = {}, {}, {}
        for name, plate in self.plates.items():
            normal = node_normals(self.mesh, _faces_of(self.mesh, plate.nodes))[plate.nodes]
            push[name] = -float(np.sum(self._force[plate.nodes] * normal))
            areas[name] = self.area(name)
            pressure[name] = push[name] / areas[name] if areas[name] > 0 else 0.0
        stretches = [deformed.stretches for _, deformed in self.state.elements]
        return Squeezed(
            part=part,
            squeezed=pressed,
            force=push[pressed],
            forces={name: self.force(name) for name in self.plates},
            pressures=pressure,
            widths=areas,
            lost={name: self.lost(name) for name in self.plates},
            bulge=self.bulge,
            stretch=max(float(s.max()) for s in stretches),
            strain=max(float(np.abs(s - 1.0).max()) for s in stretches),
            energy=self.state.energy,
            stability=_stability(self.state),
        )


def _stability(state: SolidState) -> float:
    return min(float(deformed.stability.min()) for _, deformed in state.elements)


def _faces_of(mesh: SolidMesh, nodes: Index) -> Index:
    """Boundary faces with all their nodes among some."""
    return np.asarray(mesh.boundary[np.isin(mesh.boundary, nodes).all(axis=1)])


def free_nodes(mesh: SolidMesh, plates: Mapping[str, Plate]) -> Index:
    """Nodes of a solid's boundary that no plate holds while it is prestressed."""
    return np.setdiff1d(mesh.boundary, np.concatenate([plate.nodes for plate in plates.values()]))


def node_normals(mesh: SolidMesh, faces: Index) -> Array:
    """Outward unit normals (nodes, 3) of faces of a prestressed solid, the mean of the faces at each node.

    Zero at nodes of none.
    """
    normal = np.zeros((len(mesh.points), 3))
    for nodes, at_nodes in mesh.face_normals(faces):
        for k in range(nodes.shape[1]):
            np.add.at(normal, nodes[:, k], at_nodes[:, k])
    length = np.linalg.norm(normal, axis=1, keepdims=True)
    return np.asarray(normal / np.where(length > 0.0, length, 1.0))


@dataclass(frozen=True, eq=False)
class _Travel:
    """How a plate moves: rigidly by (6,) of its reference, or each node along its normal by a depth."""

    plate: Plate
    points: Array
    rigid: Array | None
    along: Array | None

    def displacement(self, share: float) -> Array:
        """Displacement (k, 3) of its nodes at a share of the whole, m."""
        if self.along is not None:
            return share * self.along
        assert self.rigid is not None
        arm = self.points - self.plate.reference
        turn = scipy.spatial.transform.Rotation.from_rotvec(share * self.rigid[3:])
        return np.asarray(share * self.rigid[:3] + turn.apply(arm) - arm)

    @property
    def reference(self) -> Array:
        """Its reference at the end, (3,)."""
        return self.plate.reference + (0.0 if self.rigid is None else self.rigid[:3])


def _travel(name: str, given: Any, mesh: SolidMesh, plate: Plate) -> _Travel:
    """A plate's motion as it is given."""
    points, field = mesh.points[plate.nodes], f"press[{name!r}]"
    size = float(np.ptp(mesh.points, axis=0).max())
    if np.ndim(given) == 0:
        depth = float(vector(field, [given], (1,), MOVE)[0])
        check_reach(field, given, depth, size)
        normal = node_normals(mesh, _faces_of(mesh, plate.nodes))[plate.nodes]
        require(
            bool(np.all(np.linalg.norm(normal, axis=1) > 0.5)),
            field,
            given,
            "its interface holds nodes beside its faces, without a normal: give its motion (x, y, z), m",
        )
        flat = float(np.abs(normal - normal[0]).max()) < 1e-9
        if flat:
            check_reach(field, given, depth, size, float(np.ptp(mesh.points @ normal[0])))
            return _Travel(plate, points, np.concatenate([-depth * normal[0], np.zeros(3)]), None)
        return _Travel(plate, points, None, -depth * normal)
    count = 6 if np.size(given) == 6 else 3
    move = vector(field, given, (count,), MOVE)
    check_reach(field, given, float(np.linalg.norm(move[:3])), size)
    turn = float(np.linalg.norm(move[3:]))
    require(turn <= np.pi, field, given, f"it turns by {turn:.3g} rad; is it in degrees? At most π, in rad")
    return _Travel(plate, points, np.concatenate([move, np.zeros(6 - count)]), None)


def _normal_axis(name: str, mesh: SolidMesh, plate: Plate) -> tuple[int, float]:
    """Axis and sign of the outward normal of a plate that slips; ValueError for one that is not plane."""
    normal = node_normals(mesh, _faces_of(mesh, plate.nodes))[plate.nodes]
    axis = int(np.argmax(np.abs(normal[0])))
    flat = np.abs(normal - np.sign(normal[0, axis]) * np.eye(3)[axis]).max() < 1e-6
    require(bool(flat), "slip", name, "a plate that slips must be plane, its normal along x, y or z")
    return axis, float(np.sign(normal[0, axis]))


def deform(
    body: SolidElements,
    faces: Mapping[str, tuple[Index, Array]],
    press: Mapping[str, Move],
    slip: Iterable[str],
    branches: str,
) -> SolidPrestress:
    """Prestress of a solid whose rigid plates have been moved.

    Parameters
    ----------
    body
        Its elements.
    faces
        name -> nodes and reference point of each plate.
    press
        name -> how a plate moves; all others stay.
    slip
        Plates without friction, from which the body may part; all others are bonded from the start.

    Raises
    ------
    ValueError
        For unknown names, motions of another shape, a plate that slips and is curved, or moves otherwise than
        into the body; for a body that nothing keeps from sliding out.
    NoBalance
        Where no balance is found, with the share of the motion that was reached.
    """
    mesh, slip = body.mesh, name_list("slip", slip, "interfaces")
    for field, names in (("press", press), ("slip", slip)):
        for name in names:
            require(name in faces, field, name, meant(str(name), list(faces)))
    plates = {name: Plate(*face) for name, face in faces.items()}
    travels = {name: _travel(name, press.get(name, (0.0, 0.0, 0.0)), mesh, p) for name, p in plates.items()}
    size = float(np.ptp(mesh.points, axis=0).max())
    free = free_nodes(mesh, plates)

    bonded = {name: plate for name, plate in plates.items() if name not in slip}
    held = [(3 * plate.nodes[:, None] + np.arange(3)).ravel() for plate in bonded.values()]
    walls, sliding = [], {}
    for name in (name for name in plates if name in slip):
        axis, sign = _normal_axis(name, mesh, plates[name])
        depth = press.get(name, 0.0)
        good = np.ndim(depth) == 0 and np.isfinite(depth) and float(depth) >= 0.0  # type: ignore[arg-type]
        remedy = "a plate that slips moves into the body along its normal: a depth of 0 or more, m"
        require(bool(good), f"press[{name!r}]", depth, remedy)
        candidates = np.concatenate([plates[name].nodes, free])
        gap = sign * (mesh.points[plates[name].nodes[0], axis] - mesh.points[candidates, axis])
        kept = gap >= -SAME * size
        travel = -sign * float(depth)  # type: ignore[arg-type]
        walls.append(Wall(3 * candidates[kept] + axis, sign, np.maximum(gap[kept], 0.0), travel))
        sliding[name] = plates[name]
    pins = _pins(mesh, np.concatenate([*held, *(w.at[w.gap <= SAME * size] for w in walls)]))
    at = np.concatenate([*held, pins]).astype(np.intp)

    def moved(share: float) -> Array:
        return np.concatenate(
            [*(travels[name].displacement(share).ravel() for name in bonded), np.zeros(pins.size)]
        )

    flat = _Flat.of(mesh, bonded, free)

    def refused(state: SolidState) -> str | None:
        least = _stability(state)
        stretch = max(float(d.stretches.max()) for _, d in state.elements)
        reasons = [unstable(least, stretch), *(f.fold(state, size) for f in flat)]
        return next((reason for reason in reasons if reason is not None), None)

    n = mesh.points.size
    try:
        found = balance(body.state, n, np.arange(n), at, moved, walls, refused)
    except NoBalance as failure:
        stretch = max(float(d.stretches.max()) for _, d in failure.state.elements)
        blame_the_law(failure, _stability(failure.state), stretch)
        raise
    state: SolidState = found.state
    if np.abs(state.force[pins]).max(initial=0.0) > PUSHED * np.abs(state.force).max(initial=0.0):
        raise ValueError(
            f"slip is {sorted(sliding)}; nothing keeps the body from sliding out between its plates: bond one"
        )
    now = {name: Plate(plate.nodes, travels[name].reference) for name, plate in plates.items()}
    for name, touch, wall in zip(sliding, found.touching, walls, strict=True):
        nodes = np.unique(wall.at[touch] // 3)
        if not len(_faces_of(mesh, nodes)):
            raise ValueError(f"press leaves {name!r} without a whole face in contact; press it further")
        now[name] = Plate(nodes, travels[name].reference)
    return SolidPrestress(state, mesh.moved(state.points), now, sliding, branches)


def _pins(mesh: SolidMesh, held: Index) -> Index:
    """Coordinates that keep the rigid motions still that held coordinates leave free."""
    R = rigid_motion(mesh.points, mesh.points.mean(axis=0))
    R[:, 3:] /= float(np.ptp(mesh.points, axis=0).max())
    _, value, mode = np.linalg.svd(R[held], full_matrices=True)
    value = np.concatenate([value, np.zeros(6 - value.size)])
    loose = mode[value <= 1e-9 * max(float(value[0]), 1e-300)].T
    if not loose.shape[1]:
        return np.zeros(0, dtype=np.intp)
    order = scipy.linalg.qr((R @ loose).T, mode="r", pivoting=True)[1]
    return np.sort(np.asarray(order[: loose.shape[1]], dtype=np.intp))


def _spread(p: Array) -> list[int]:
    """Three of some points (k, 3) that lie far from one line."""
    first = int(np.argmax(np.linalg.norm(p - p.mean(axis=0), axis=1)))
    second = int(np.argmax(np.linalg.norm(p - p[first], axis=1)))
    area = np.linalg.norm(np.cross(p - p[first], p[second] - p[first]), axis=1)
    return [first, second, int(np.argmax(area))]


@dataclass(frozen=True, eq=False)
class _Flat:
    """A plane bonded plate, and the free nodes near it that must stay on their side of its plane."""

    name: str
    three: Index
    near: Index

    @classmethod
    def of(cls, mesh: SolidMesh, bonded: Mapping[str, Plate], free: Index) -> list[_Flat]:
        found, size = [], float(np.ptp(mesh.points, axis=0).max())
        for name, plate in bonded.items():
            p = mesh.points[plate.nodes]
            normal = node_normals(mesh, _faces_of(mesh, plate.nodes))[plate.nodes]
            middle = p.mean(axis=0)
            if not np.abs(normal - normal[0]).max() < 1e-6:
                continue
            first, second, third = _spread(p)
            if np.dot(np.cross(p[second] - p[first], p[third] - p[first]), normal[0]) < 0.0:
                second, third = third, second
            around = mesh.elements[np.isin(mesh.elements, plate.nodes).any(axis=1)]
            near = np.intersect1d(around[around >= 0], free)
            inside = (mesh.points[near] - middle) @ normal[0] < -SAME * size
            found.append(cls(name, plate.nodes[[first, second, third]], near[inside]))
        return found

    def fold(self, state: SolidState, size: float) -> str | None:
        """Why a state is refused whose free surface has passed the plate's plane; None if it has not."""
        a, b, c = state.points[self.three]
        normal = np.cross(b - a, c - a)
        past = (state.points[self.near] - a) @ normal / np.linalg.norm(normal)
        return FOLD.format(name=self.name, remedy=ROUND_EDGE) if (past > FOLDED * size).any() else None
