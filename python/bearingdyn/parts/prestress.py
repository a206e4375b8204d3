"""A body of revolution squeezed between its rigid faces: what they do, and the static state they leave."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from bearingdyn.checks import meant, name_list, number, one_of, require
from bearingdyn.fem import (
    CURRENT,
    SAME,
    SEPARABLE,
    NoBalance,
    RevolutionMesh,
    RevolvedElements,
    RevolvedState,
    Wall,
    balance,
)
from bearingdyn.material import NEO_HOOKE, Hyperelastic
from bearingdyn.parts.revolved_faces import MeshFace
from bearingdyn.parts.squeezed import Squeezed
from bearingdyn.short_repr import short
from bearingdyn.types import Array, Index

Travel = float | tuple[float, float]
STABLE = 1e-3  # least modulus of a further change of shape, over the first, that counts as stable
DOUBTFUL = 0.1  # below which the law is to blame where a search for balance ends
FARTHEST = 10.0  # motion of a plate, over the size of the body, beyond which a length is taken to be in mm
FOLDED = 1e-6  # how far past a rigid face, over the section's size, a free surface is folded over it

FOLD = "the free surface folds over the edge of {name!r}, where it is bonded; {remedy}"
RECESS = (
    "recess the free ends (Layer(..., recess=...)), or let the surface slip while it is squeezed "
    "(outside='slip', inside='slip')"
)
UNSTABLE = (
    "the law is not stable there (its least modulus is {least:.2g} of that at rest, at a stretch of "
    "{stretch:.3g}); take coefficients that suit such strains, or squeeze less"
)


def check_reach(field: str, given: object, length: float, size: float, along: float | None = None) -> None:
    """Check how far a rigid face moves; ValueError for what is in mm, m.

    size is that of the body; along, its depth where the face moves straight into it.
    """
    most, what = (
        (FARTHEST * size, f"the body is {size:.3g} m large")
        if along is None or length < 0.0
        else (along, f"the body is {along:.3g} m deep there")
    )
    require(abs(length) < most, field, given, f"{what}; is it in mm? It must be in m")


def check_law(law: object) -> Hyperelastic:
    """Check the law of a prestress: neo-Hookean for None; ValueError for what has no derivatives."""
    if law is None:
        return NEO_HOOKE
    require(
        isinstance(law, Hyperelastic) and not isinstance(law, type),
        "law",
        law,
        "it must be NeoHooke(), MooneyRivlin(C10, C01) or Yeoh(C10, C20, C30)",
    )
    return law  # type: ignore[return-value]


def check_branches(branches: object) -> None:
    """Check which share of a prestress the Maxwell branches see; ValueError for another word."""
    one_of("branches", branches, (CURRENT, SEPARABLE))


def constant_volume(materials: Iterable[Any]) -> None:
    """Check that no material of a body to be prestressed has a bulk modulus that relaxes."""
    for material in materials:
        bulk = getattr(material, "bulk", None)
        remedy = "of a squeezed body the bulk modulus must be constant: give the material without, bulk=None"
        require(bulk is None, "bulk", bulk, remedy)


def unstable(least: float, stretch: float) -> str | None:
    """Why a prestress is refused whose law is not stable at its largest stretch; None for one that is."""
    return None if least > STABLE else UNSTABLE.format(least=least, stretch=stretch)


def blame_the_law(failure: NoBalance, least: float, stretch: float) -> None:
    """Say that a search for a prestress ended because of its law, where that has become doubtful."""
    if least < DOUBTFUL:
        failure.reason = UNSTABLE.format(least=least, stretch=stretch)


@dataclass(frozen=True, eq=False)
class Prestress:
    """The prestress of a squeezed body of revolution: its static state.

    Parameters
    ----------
    state
        Deformed elements.
    faces
        Rigid faces, with the sides that touch them, and their reference points where they are now.
    sliding
        Faces that slipped while they were pressed on, with the sides they had before.
    branches
        "current" or "separable"; see Deformed.deviatoric.
    """

    state: RevolvedState
    faces: Mapping[str, MeshFace]
    sliding: Mapping[str, MeshFace]
    branches: str

    __repr__ = short

    @cached_property
    def _force(self) -> Array:
        return self.state.force.reshape(-1, 2)

    def force(self, name: str) -> tuple[float, float]:
        """Radial and axial force of a face on the body, summed around the axis, N."""
        f = self._force[self.faces[name].nodes].sum(axis=0)
        return float(f[0]), float(f[1])

    @cached_property
    def load_terms(self) -> dict[str, tuple[float, float]]:
        """What the forces on each face add to its tilt and torsional stiffness, N m.

        A face that turns by θ carries its nodes by θ × x + ½ θ × (θ × x); the forces on them work along the
        second part too.
        """
        found = {}
        for name, face in self.faces.items():
            f = self._force[face.nodes]
            radial = float(f[:, 0] @ self.state.r[face.nodes])
            axial = float(f[:, 1] @ (self.state.z[face.nodes] - face.reference))
            found[name] = (-0.5 * radial - axial, -radial)
        return found

    @property
    def self_balanced(self) -> bool:
        """Whether no face is pushed along the axis: then a rigid motion of the body costs nothing."""
        axial = [abs(self.force(name)[1]) for name in self.faces]
        return max(axial) <= 1e-9 * float(np.abs(self._force).sum())

    def width(self, name: str) -> float:
        """Length along the section, m, over which the body touches a face."""
        return float(_lengths(self.state, self.faces[name].sides).sum())

    def lost(self, name: str) -> float:
        """Length along the section, m, over which the body has parted from a face it slipped on."""
        before = self.sliding.get(name)
        if before is None:
            return 0.0
        parted = ~np.isin(before.sides[:, 1], self.faces[name].sides[:, 1])
        return float(_lengths(self.state, before.sides[parted]).sum())

    def told(self, part: Any, pressed: str) -> Squeezed:
        """What the state tells of a part, of which a face was pressed."""
        push, pressure = {}, {}
        for name in self.faces:
            _, normal, area = self._seat(name)
            push[name] = -float(np.sum(self._force[self.faces[name].nodes] * normal))
            pressure[name] = push[name] / float(area.sum())
        elements = self.state.elements
        stretches = elements.stretches
        return Squeezed(
            part=part,
            squeezed=pressed,
            force=push[pressed],
            forces={name: self.force(name) for name in self.faces},
            pressures=pressure,
            widths={name: self.width(name) for name in self.faces},
            lost={name: self.lost(name) for name in self.faces},
            bulge=self.bulge,
            stretch=float(stretches.max()),
            strain=float(np.abs(stretches - 1.0).max()),
            energy=elements.energy,
            stability=float(elements.stability.min()),
        )

    def pressures(self, name: str) -> tuple[Index, Array]:
        """Nodes of a face and the pressure at each, Pa: its force over the area it stands for."""
        nodes, normal, area = self._seat(name)
        push = -np.sum(self._force[nodes] * normal, axis=1)
        return nodes[area > 0.0], push[area > 0.0] / area[area > 0.0]

    def _seat(self, name: str) -> tuple[Index, Array, Array]:
        """Nodes of a face, their outward normals (k, 2), and the area each stands for, m²."""
        face = self.faces[name]
        normal, share = np.zeros((len(self.state.u), 2)), np.zeros(len(self.state.u))
        r, z = self.state.r[face.sides], self.state.z[face.sides]
        along = np.stack([r[:, 2] - r[:, 0], z[:, 2] - z[:, 0]], axis=1)
        # ∫N r ds of a straight side, by Simpson's rule for each node
        part = 2.0 * np.pi * r * np.array([1.0, 4.0, 1.0]) / 6.0
        np.add.at(share, face.sides, part * np.linalg.norm(along, axis=1)[:, None])
        outward = _outward(self.state.mesh, face.sides, along)
        for k in range(3):
            np.add.at(normal, face.sides[:, k], outward)
        length = np.linalg.norm(normal[face.nodes], axis=1)[:, None]
        # a node that touches beside the last whole side: as the face is on the mean
        whole = np.where(length > 0.0, normal[face.nodes], outward.sum(axis=0))
        return face.nodes, whole / np.linalg.norm(whole, axis=1)[:, None], share[face.nodes]

    @property
    def bulge(self) -> float:
        """Largest outward motion of the free surface, m."""
        mesh = self.state.body.mesh
        sides = free_sides(mesh, self.faces)
        if not len(sides):
            return 0.0
        along = np.stack([np.diff(mesh.r[sides[:, ::2]]), np.diff(mesh.z[sides[:, ::2]])], axis=-1)[:, 0]
        normal = _outward(mesh, sides, along)
        normal /= np.linalg.norm(normal, axis=1)[:, None]
        return float(max(0.0, np.einsum("ska,sa->sk", self.state.u[sides], normal).max()))

    def moved(self, point: tuple[float, float, float]) -> tuple[float, float, float]:
        """Where a point (r, z, φ) of the undeformed body is now."""
        r, z = self.state.place(point[0], point[1])
        return r, z, point[2]


def _lengths(state: RevolvedState, sides: Index) -> Array:
    r, z = state.r[sides], state.z[sides]
    return np.asarray(np.hypot(np.diff(r, axis=1), np.diff(z, axis=1)).sum(axis=1))


def _outward(mesh: RevolutionMesh, sides: Index, along: Array) -> Array:
    """Normals (s, 2) of sides of the surface, away from their elements, as long as `along` (s, 2)."""
    middle = {int(k): e for e, nodes in enumerate(mesh.elements) for k in nodes[[1, 3, 5, 7]]}
    own = mesh.elements[[middle[int(k)] for k in sides[:, 1]], 4]
    normal = np.stack([along[:, 1], -along[:, 0]], axis=1)
    away = np.stack([mesh.r[sides[:, 1]] - mesh.r[own], mesh.z[sides[:, 1]] - mesh.z[own]], axis=1)
    return np.asarray(normal * np.sign(np.sum(normal * away, axis=1))[:, None])


def free_sides(mesh: RevolutionMesh, faces: Mapping[str, MeshFace]) -> Index:
    """Free sides of a prestressed body: those of the surface that lie on no face, nor on the axis."""
    sides = mesh.outline_sides
    taken = np.concatenate([face.sides[:, 1] for face in faces.values()])
    on_axis = (mesh.r[sides] <= SAME * mesh.size).all(axis=1)
    return np.asarray(sides[~np.isin(sides[:, 1], taken) & ~on_axis])


@dataclass(frozen=True)
class _Side:
    """How a face looks: the axis of its normal (0: r, 1: z), the sign of that, the place of the flat part."""

    axis: int
    sign: float
    place: float
    flat: bool


def _side(mesh: RevolutionMesh, name: str, face: MeshFace) -> _Side:
    along = np.stack([np.diff(mesh.r[face.sides[:, ::2]]), np.diff(mesh.z[face.sides[:, ::2]])], axis=-1)[
        :, 0
    ]
    on_surface = np.isin(face.sides[:, 1], mesh.outline_sides[:, 1])
    if not on_surface.all():
        raise ValueError(
            f"press[{name!r}] names a face inside the body; give its motion as a pair (dr, dz), m"
        )
    normal = _outward(mesh, face.sides, along).sum(axis=0)
    axis = int(np.argmax(np.abs(normal)))
    sign = float(np.sign(normal[axis]))
    x = (mesh.r, mesh.z)[axis][face.nodes]
    place = float(sign * (sign * x).max())
    return _Side(axis, sign, place, bool(np.ptp(x) <= SAME * mesh.size))


def squeeze(
    mesh: RevolutionMesh,
    faces: Mapping[str, MeshFace],
    press: Mapping[str, Travel],
    slip: Iterable[str],
    laws: Sequence[Hyperelastic],
    shear: Sequence[float],
    bulk: Sequence[float],
    branches: str = CURRENT,
) -> Prestress:
    """Prestress of a body of revolution after rigid faces have squeezed it.

    Parameters
    ----------
    press
        name -> how far the face moves into the body along its normal, r or z, m; or its motion (dr, dz).
    slip
        Faces without friction, from which the body may part; all others are bonded from the start.
    laws, shear, bulk
        Of each region.

    Raises
    ------
    ValueError
        For unknown names of faces, a face that slips and is pulled, one that is left without contact.
    NoBalance
        Where no balance is found: it has the share of the squeeze that was reached, and what stopped it.
    """
    slip = name_list("slip", slip, "interfaces")
    for field, names in (("press", press), ("slip", slip)):
        for name in names:
            require(name in faces, field, name, meant(str(name), list(faces)))
    slip = [name for name in faces if name in slip]
    travel, sides = {}, {}
    for name, face in faces.items():
        given = press.get(name, 0.0)
        if isinstance(given, tuple):
            require(len(given) == 2, f"press[{name!r}]", given, "it must be (dr, dz), m")
            move = np.array([number(f"press[{name!r}]", v, "it must be (dr, dz), m") for v in given])
            if name in slip:
                raise ValueError(
                    f"press[{name!r}] is {given}; a face that slips moves along its normal: give a length, m"
                )
        else:
            depth = number(f"press[{name!r}]", given, "it must be a length into the body, m, or (dr, dz)")
            move = np.zeros(2)
            if depth or name in slip:
                sides[name] = _side(mesh, name, face)
                move[sides[name].axis] = -sides[name].sign * depth
            if name in slip and not depth >= 0:
                raise ValueError(
                    f"press[{name!r}] is {given}; a face that slips cannot be pulled: 0 or more, m"
                )
            if name in sides:
                along = float(np.ptp((mesh.r, mesh.z)[sides[name].axis]))
                check_reach(f"press[{name!r}]", given, depth, mesh.size, along)
        check_reach(f"press[{name!r}]", given, float(np.linalg.norm(move)), mesh.size)
        travel[name] = move
        if (
            name not in slip
            and name not in sides
            and np.isin(face.sides[:, 1], mesh.outline_sides[:, 1]).all()
        ):
            sides[name] = _side(mesh, name, face)

    body = RevolvedElements(mesh, laws, shear, bulk)
    free = body.axial[1]
    held, moves, walls = [], [], []
    others = free_sides(mesh, faces)
    for name, face in faces.items():
        if name not in slip:
            held += [2 * face.nodes, 2 * face.nodes + 1]
            moves += [np.full(face.nodes.size, v) for v in travel[name]]
            continue
        side = sides[name]
        candidates = np.union1d(face.nodes, others)
        taken = [f.nodes for other, f in faces.items() if other != name]
        candidates = np.setdiff1d(candidates, np.concatenate([np.zeros(0, np.intp), *taken]))
        gap = side.sign * (side.place - (mesh.r, mesh.z)[side.axis][candidates])
        at = 2 * candidates + side.axis
        kept = (gap >= -SAME * mesh.size) & np.isin(at, free)
        walls.append(Wall(at[kept], side.sign, np.maximum(gap[kept], 0.0), float(travel[name][side.axis])))
    sliding_on = [sides[name].axis for name in slip]
    if not held and 1 not in sliding_on:
        middle = int(np.argmin(np.abs(mesh.z - 0.5 * (mesh.z.min() + mesh.z.max()))))
        held.append(np.array([2 * middle + 1]))  # nothing else holds it along the axis, and nothing pushes
        moves.append(np.zeros(1))
    at = np.concatenate(held) if held else np.zeros(0, dtype=np.intp)
    move = np.concatenate(moves) if moves else np.zeros(0)
    inside = np.isin(at, free)

    def refused(state: RevolvedState) -> str | None:
        elements = state.elements
        if (reason := unstable(float(elements.stability.min()), float(elements.stretches.max()))) is not None:
            return reason
        for name, side in sides.items():
            if name in slip or not side.flat:
                continue
            before, now = ((mesh.r, mesh.z)[side.axis], (state.r, state.z)[side.axis])
            free_nodes = np.setdiff1d(others, faces[name].nodes)
            short_of = side.sign * (side.place - before[free_nodes]) >= -SAME * mesh.size
            past = side.sign * (now[free_nodes] - now[faces[name].nodes[0]]) > FOLDED * mesh.size
            if (short_of & past).any():
                return FOLD.format(name=name, remedy=RECESS)
        return None

    try:
        found = balance(body.state, 2 * mesh.r.size, free, at[inside], move[inside], walls, refused)
    except NoBalance as failure:
        elements = failure.state.elements
        blame_the_law(failure, float(elements.stability.min()), float(elements.stretches.max()))
        raise
    state: RevolvedState = found.state
    touched = {}
    for name, touch, wall in zip(slip, found.touching, walls, strict=True):
        nodes = np.unique(wall.at[touch] // 2)
        touched[name] = nodes, mesh.outline_sides[np.isin(mesh.outline_sides, nodes).all(axis=1)]
    now = {}
    for name, face in faces.items():
        reference = face.reference + float(travel[name][1])
        nodes, touching = touched.get(name, (face.nodes, face.sides))
        if not len(touching):
            raise ValueError(f"press leaves {name!r} with less than one side of contact; press it further")
        now[name] = MeshFace(nodes, touching, reference)
    return Prestress(state, now, {name: faces[name] for name in slip}, branches)
