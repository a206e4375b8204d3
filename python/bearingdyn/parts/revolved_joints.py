"""Where a body of revolution is joined: rigid faces and raceways, and the place of their coordinates."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import scipy

from bearingdyn.bearing import RacewaySeries
from bearingdyn.fem import ALL_COMPONENTS, AXIAL, TORSION, Harmonic, RevolutionMesh, rigid_transfer
from bearingdyn.parts.revolved_faces import Face, Groove, MeshFace, find_face, groove_weights
from bearingdyn.types import Array, Index

Components = tuple[int, ...]
# Coordinates (of x, y, z, θx, θy, θz) and signs of an interface's rigid shapes, for the cosine and the sine
# copy of a harmonic family. Order 1 turned a quarter wave carries y where it carried x, and −θx where it
# carried θy: u = t + θ × ρ.
RIGID_SHAPES: dict[tuple[int, Components], tuple[tuple[tuple[int, ...], tuple[float, ...]], ...]] = {
    (0, AXIAL): (((2,), (1.0,)),),
    (0, TORSION): (((5,), (1.0,)),),
    (1, ALL_COMPONENTS): (((0, 4), (1.0, 1.0)), ((1, 3), (1.0, -1.0))),
}


@dataclass(frozen=True, eq=False, kw_only=True)
class Track:
    """A grooved boundary on a mesh: nodes (k,), weights (2, k, 2) of U and W, series, arm and plane z, m."""

    nodes: Index
    weights: Array
    series: RacewaySeries
    order: int
    arm: float
    z: float


@dataclass(frozen=True, eq=False)
class Boundaries:
    """Boundaries of a revolved body, rigid faces and grooves, by name.

    The faces have six coordinates each, in their order; a groove has none: its coefficients are read off the
    shapes.
    """

    faces: Mapping[str, MeshFace]
    tracks: Mapping[str, Track]

    def nodes(self) -> Iterator[tuple[str, Index]]:
        """Names and nodes of all."""
        for name, face in self.faces.items():
            yield name, face.nodes
        for name, track in self.tracks.items():
            yield name, track.nodes

    @cached_property
    def starts(self) -> dict[str, int]:
        """First coordinate of every face."""
        return {name: 6 * i for i, name in enumerate(self.faces)}

    @property
    def n(self) -> int:
        """Number of boundary coordinates."""
        return 6 * len(self.faces)

    def families(self) -> list[tuple[int, Components, int]]:
        """Orders, components and copies that the boundaries excite.

        A body without faces may turn about its axis freely, and nothing asks for its twist.
        """
        highest = max([1, *(t.order for t in self.tracks.values())])
        twist = [(0, TORSION, 1)] if self.faces else []
        return [(0, AXIAL, 1), *twist, *((n, ALL_COMPONENTS, 2) for n in range(1, highest + 1))]

    def held(self, h: Harmonic) -> tuple[Index, Array]:
        """Coordinates on rigid faces, without those removed on the axis, and their shapes, a column each.

        In orders above 1 a rigid face does not move: there are no columns.
        """
        faces = self.faces.values()
        at = np.concatenate([np.zeros(0, np.intp), *(h.coordinates(f.nodes) for f in faces)])
        kept = np.isin(at, h.free)
        if (h.order, h.components) not in RIGID_SHAPES or not faces:
            return at[kept], np.zeros((int(kept.sum()), 0))
        R = scipy.linalg.block_diag(*[h.rigid_shapes(f.nodes, f.reference) for f in faces])
        return at[kept], R[kept]

    def averages(self, h: Harmonic, beyond: bool = False) -> Array:
        """Rows (2 t, n): radial and axial coefficient of this order of each groove that has it, or of all."""
        rows = [np.zeros((0, h.n))]
        for track in self.tracks.values() if beyond else self._with(h):
            row = np.zeros((2, h.n))
            c = len(h.components)
            row[:, c * track.nodes + h.components.index(0)] = track.weights[:, :, 0]
            row[:, c * track.nodes + h.components.index(2)] = track.weights[:, :, 1]
            rows.append(row)
        return np.vstack(rows)

    def _with(self, h: Harmonic) -> list[Track]:
        return [t for t in self.tracks.values() if h.order <= t.order and 0 in h.components]

    def place(self, h: Harmonic, copy: int) -> tuple[Index, Array]:
        """Coordinates and signs of the columns of `held`, in a copy."""
        index: list[int] = []
        sign: list[float] = []
        if (h.order, h.components) in RIGID_SHAPES:
            coordinates, signs = RIGID_SHAPES[h.order, h.components][copy]
            for name in self.faces:
                index += [self.starts[name] + k for k in coordinates]
                sign += signs
        return np.array(index, dtype=np.intp), np.array(sign)

    def coefficients(self, h: Harmonic, copy: int) -> list[tuple[str, Index]]:
        """Names of the grooves that have this order, and where a copy's rows of `averages` stand."""
        return [
            (name, np.array([t.series.index(axial, h.order, copy) for axial in (0, 1)], dtype=np.intp))
            for name, t in self.tracks.items()
            if t in self._with(h)
        ]

    def rigid_motion(self, n: int) -> Array:
        """Rigid motions (n, 6) of the body about the origin in n coordinates, internal ones at rest."""
        R = np.zeros((n, 6))
        for name, face in self.faces.items():
            R[self.starts[name] + np.arange(6)] = rigid_transfer([(0.0, 0.0, face.reference)])
        return R


def find_boundaries(
    mesh: RevolutionMesh, interfaces: Mapping[str, Face], grooves: Mapping[str, Groove]
) -> Boundaries:
    """Boundaries on a revolved mesh: faces and grooves. Raises ValueError, by name, for a missing face."""
    faces = {name: find_face(mesh, f"interfaces[{name!r}]", s) for name, s in interfaces.items()}
    tracks = {}
    for name, groove in grooves.items():
        face = find_face(mesh, f"grooves[{name!r}]", groove.surface)
        z = face.reference if groove.z is None else groove.z
        nodes, weights = groove_weights(mesh, face, groove.arm, z, groove.footprint)
        series = RacewaySeries.up_to(groove.order)
        tracks[name] = Track(
            nodes=nodes, weights=weights, series=series, order=groove.order, arm=groove.arm, z=z
        )
    return Boundaries(faces, tracks)
