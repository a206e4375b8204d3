"""A body of revolution as one unreduced model: its Fourier families side by side, every copy in full."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import scipy

from bearingdyn.cms import Basis, FullModel, RigidInterface, Viscoelastic
from bearingdyn.fem import Harmonic
from bearingdyn.material import Elastic, constant_bulk, volume_of
from bearingdyn.parts.regions import Patch, Region
from bearingdyn.parts.revolved_faces import MeshFace
from bearingdyn.types import Array

Copies = Sequence[tuple[Sequence[int], Sequence[float]]]  # coordinates and signs of each copy of a family


def full_model(
    families: Sequence[tuple[Harmonic, Copies]],
    regions: Sequence[Region | Patch],
    faces: Mapping[str, MeshFace],
    outputs: Mapping[str, tuple[float, float, float]],
) -> FullModel:
    """Full model of a body of revolution: all copies of all families, no coordinate removed on the axis.

    Parameters
    ----------
    outputs
        name -> (r, z, φ).
    """
    rubbers: list[Any] = []
    for q in regions:
        if not isinstance(q.material, Elastic) and not any(q.material is m for m in rubbers):
            rubbers.append(q.material)
    owner = np.array([next((i for i, m in enumerate(rubbers) if q.material is m), -1) for q in regions])
    bulk = np.array([constant_bulk(q.material) for q in regions])
    volumes = {i: v for i, m in enumerate(rubbers) if (v := volume_of(m)) is not None}
    shear = np.array([q.material.G if isinstance(q.material, Elastic) else 0.0 for q in regions])
    density = np.array([q.material.density for q in regions])

    M: list[Any] = []
    K: list[Any] = []
    E: list[Any] = []
    H: list[list[Any]] = [[] for _ in rubbers]
    swelling: list[list[Any]] = [[] for _ in volumes]
    dofs: dict[str, list[Array]] = {name: [] for name in faces}
    T: dict[str, list[Array]] = {name: [] for name in faces}
    rows: dict[str, list[Any]] = {name: [] for name in outputs}
    start = 0
    for h, copies in families:
        own = [
            h.mass_matrix(density),
            h.stiffness(bulk, shear),
            h.stiffness(np.where(owner < 0, bulk, 0.0), shear),
            *(h.matrix((owner == i).astype(float) @ h.deviatoric) for i in range(len(rubbers))),
            *(h.matrix(0.5 * (owner == i) @ h.volumetric) for i in volumes),
        ]
        own = [A[h.free][:, h.free] for A in own]
        place = np.full(h.n, -1)
        place[h.free] = np.arange(h.free.size)
        for copy, (coordinates, signs) in enumerate(copies):
            for store, A in zip([M, K, E, *H, *swelling], own, strict=True):
                store.append(A)
            for name, face in faces.items():
                at = place[h.coordinates(face.nodes)]
                shape = np.zeros((at.size, 6))
                shape[:, list(coordinates)] = h.rigid_shapes(face.nodes, face.reference) * np.array(signs)
                dofs[name].append(start + at[at >= 0])
                T[name].append(shape[at >= 0])
            for name, (r, z, phi) in outputs.items():
                rows[name].append(_point_rows(h, r, z, phi, sine=copy == 1))
            start += h.free.size
    stack = scipy.sparse.block_diag
    return FullModel(
        M=stack(M),
        K=stack(K),
        E=stack(E),
        interfaces={
            name: RigidInterface(
                np.concatenate(dofs[name]), np.vstack(T[name]), np.array([0.0, 0.0, face.reference])
            )
            for name, face in faces.items()
        },
        outputs={name: scipy.sparse.hstack(parts) for name, parts in rows.items()},
        viscoelastic=tuple(
            Viscoelastic(m, stack(parts))
            for m, parts in zip([*rubbers, *volumes.values()], [*H, *swelling], strict=True)
        ),
    )


def full_basis(
    model: FullModel,
    families: Sequence[tuple[Harmonic, Array, int, Copies]],
    level: Sequence[float],
) -> Basis:
    """Full basis of a body of revolution: in the coordinates of its `full_model`.

    Parameters
    ----------
    families
        Each with its shapes (n, columns) and the number of them that are constraint shapes.
    level
        Shear modulus of each viscoelastic material, Pa, of the reference state.
    """
    count = len(model.interfaces)
    constraint = np.zeros((model.n, 6 * count))
    internal = []
    start = 0
    for h, Psi, fixed, copies in families:
        for coordinates, signs in copies:
            at = slice(start, start + h.free.size)
            index = (6 * np.arange(count)[:, None] + np.array(coordinates)).ravel()
            constraint[at, index] = Psi[h.free, :fixed] * np.tile(signs, count)
            shapes = np.zeros((model.n, Psi.shape[1] - fixed))
            shapes[at] = Psi[h.free, fixed:]
            internal.append(shapes)
            start += h.free.size
    K = model.stiffness(level)
    inside = np.hstack(internal)
    squares = np.sum(inside * (K @ inside), axis=0)
    return Basis(
        np.hstack([constraint, inside]), constraint.T @ (K @ constraint), np.sqrt(squares) / (2 * np.pi)
    )


def _point_rows(h: Harmonic, r: float, z: float, phi: float, sine: bool) -> Any:
    """Rows (3, free) of a point, from the nodes of the element it lies in."""
    nodes = h.mesh.elements[h.mesh.locate(r, z)[0]]
    at = h.coordinates(nodes)
    u = np.zeros((h.n, at.size))
    u[at, np.arange(at.size)] = 1.0
    removed = np.setdiff1d(at, h.free)
    u[removed] = 0.0
    values = h.point_rows(r, z, phi, h.complete(u), sine=sine)
    rows = scipy.sparse.lil_matrix((3, h.n))
    rows[:, at] = values
    return rows.tocsc()[:, h.free]
