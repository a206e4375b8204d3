"""Reduced matrices of a body of revolution: its regions joined, projected on the shapes of every family."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

import numpy as np

from bearingdyn.cms import Raceway, RoundFace, Superelement, Viscoelastic, modal_damping
from bearingdyn.fem import Harmonic, RevolutionMesh
from bearingdyn.material import Elastic, constant_bulk, volume_of
from bearingdyn.parts.regions import Patch, Region, rubbers_of, soft_elements
from bearingdyn.parts.revolved_joints import Boundaries
from bearingdyn.parts.revolved_strain import concentrations
from bearingdyn.types import Array, Index


def reduced(
    placed: Sequence[tuple[Harmonic, Array, list[tuple[Index, Array]]]],
    mesh: RevolutionMesh,
    regions: Sequence[Region | Patch],
    boundaries: Boundaries,
    *,
    outputs: Mapping[str, tuple[float, float, float]],
    load_terms: Array,
    still: Array,
    damping: float,
    faces: Mapping[str, tuple[RoundFace, ...]],
) -> Superelement:
    """Project the matrices of a body of revolution (paper (21)-(23)); see Revolved.superelement.

    Parameters
    ----------
    placed
        Each family with its shapes, and the coordinates and signs of these in each of its copies.
    mesh, regions, boundaries
        Section, materials, and what is held or carries balls.
    outputs
        Points (r, z, φ) whose motion is wanted, by name.
    load_terms
        (6 i,) what the forces of a prestress add to the stiffness of the faces' coordinates.
    still
        (n, n), projector that takes rigid motion out of the stiffness.
    damping
        Ratio ζ of the free elastic modes.
    faces
        Cylinders at the interfaces.
    """
    n = len(still)
    rubbers, owner = rubbers_of(regions)
    density = [q.material.density for q in regions]
    bulk = np.array([constant_bulk(q.material) for q in regions])
    shear = np.array([q.material.G if isinstance(q.material, Elastic) else 0.0 for q in regions])
    volumes = {j: v for j, m in enumerate(rubbers) if (v := volume_of(m)) is not None}

    M, K, E = np.zeros((n, n)), np.zeros((n, n)), np.zeros((n, n))
    H = [np.zeros((n, n)) for _ in rubbers]
    swelling = {j: np.zeros((n, n)) for j in volumes}
    rows = {name: np.zeros((3, n)) for name in outputs}
    for h, Psi, places in placed:
        parts = [(M, h.mass_matrix(density)), (K, h.stiffness(bulk, shear))]
        if np.any(owner < 0):
            parts += [(E, h.stiffness(np.where(owner < 0, bulk, 0.0), shear))]
        parts += [(H[j], h.matrix((owner == j).astype(float) @ h.deviatoric)) for j in range(len(rubbers))]
        parts += [(S, h.matrix(0.5 * (owner == j) @ h.volumetric)) for j, S in swelling.items()]
        small = [(full, Psi.T @ (A @ Psi)) for full, A in parts]
        whole = h.complete(Psi.copy())
        for copy, (index, sign) in enumerate(places):
            for full, a in small:
                full[np.ix_(index, index)] += np.outer(sign, sign) * 0.5 * (a + a.T)
            for name, (r, z, phi) in outputs.items():
                rows[name][:, index] += sign * h.point_rows(r, z, phi, whole, sine=copy == 1)
    raceways = {name: np.zeros((len(t.series), n)) for name, t in boundaries.tracks.items()}
    for h, Psi, places in placed:
        felt = boundaries.averages(h) @ Psi
        for copy, (index, sign) in enumerate(places):
            for k, (name, at) in enumerate(boundaries.coefficients(h, copy)):
                raceways[name][np.ix_(at, index)] = sign * felt[2 * k : 2 * k + 2]
    loaded = np.arange(len(load_terms))
    K[loaded, loaded] += load_terms
    P = still
    return Superelement(
        M=M,
        C=modal_damping(M, P @ E @ P, damping),
        G=np.zeros((n, n)),
        K=P @ K @ P,
        interfaces={name: np.arange(6 * i, 6 * i + 6) for i, name in enumerate(boundaries.faces)},
        outputs=rows,
        viscoelastic=(
            *(
                Viscoelastic(m, P @ h @ P, *_strained(m, mesh, soft_elements(mesh, regions, j), placed, n))
                for j, (m, h) in enumerate(zip(rubbers, H, strict=True))
            ),
            *(Viscoelastic(volumes[j], P @ S @ P) for j, S in swelling.items()),
        ),
        faces=faces,
        raceways={name: Raceway(t.series, t.arm, raceways[name]) for name, t in boundaries.tracks.items()},
    )


def _strained(
    material: object,
    mesh: RevolutionMesh,
    elements: Index,
    placed: Sequence[tuple[Harmonic, Array, list[tuple[Index, Array]]]],
    n: int,
) -> tuple[float, Array | None]:
    """Volume of rubber, m³, and how its shapes strain it, which a law of softening alone asks for."""
    if getattr(material, "payne", None) is None:
        return 2 * math.pi * float(mesh.integrals.mass[elements].sum()), None
    return concentrations(mesh, elements, placed, n)
