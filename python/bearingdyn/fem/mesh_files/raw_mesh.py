"""A mesh as a file gives it, and how it becomes a SolidMesh."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from bearingdyn.checks import meant, positive
from bearingdyn.fem.meshes.solid_element import KINDS
from bearingdyn.fem.meshes.solid_mesh import SolidMesh, merged, second_order
from bearingdyn.types import Array, Index

CORNERS = {8: 20, 4: 10}  # nodes of a linear element, and of the quadratic one made of it


@dataclass(frozen=True, eq=False, kw_only=True)
class RawMesh:
    """Nodes, solid elements of one kind or more, and sets, unchecked.

    Parameters
    ----------
    points
        (n, 3) in the unit of the file.
    cells
        Arrays (m, k) of nodes, in VTK's order.
    numbers
        What the file calls the elements of all cells in turn.
    regions
        name -> elements, counted through the cells in turn.
    preferred
        Those that carry a material.
    surfaces
        name -> nodes.
    """

    points: Array
    cells: tuple[Index, ...]
    numbers: Index
    regions: Mapping[str, Index]
    surfaces: Mapping[str, Index]
    preferred: tuple[str, ...] = ()


def finished(
    raw: RawMesh,
    *,
    scale: float,
    regions: Sequence[str] | None,
    upgrade: bool,
    merge: float | None,
    drop_unconnected: bool,
    largest: float,
) -> SolidMesh:
    """The mesh in m, second-order and checked; the arguments are those of `read_mesh`."""
    positive("scale", scale, "it must be the length of the file's unit in m, as 1e-3 for mm")
    points = scale * raw.points
    if not raw.cells:
        raise ValueError("the file holds no brick or tetrahedron")
    sizes = sorted({c.shape[1] for c in raw.cells})
    if len(sizes) > 1:
        raise ValueError(
            f"the file mixes elements of {' and '.join(map(str, sizes))} nodes; mesh the body with one kind"
        )
    elements = np.vstack(raw.cells)
    if not np.all(np.isfinite(points)):
        raise ValueError(f"node {int(np.flatnonzero(~np.isfinite(points).all(axis=1))[0])} is not finite")
    if elements.min() < 0 or elements.max() >= len(points):
        raise ValueError("an element names a node that the file does not have")
    extent = float(np.ptp(points[np.unique(elements)], axis=0).max())
    if not 0 < extent <= largest:
        raise ValueError(
            f"the body is {extent:.4g} m long; is the file in mm? Then pass scale=1e-3 "
            f"(or largest={10 * largest:g} for a body of that size)"
        )
    named = _regions(raw, regions)
    surfaces = dict(raw.surfaces)
    if merge is not None:
        positive("merge", merge, "it must be a distance in m below which nodes are one")
        points, label = merged(points, merge)
        elements = label[elements]
        surfaces = {name: np.unique(label[at]) for name, at in surfaces.items()}
    if drop_unconnected:
        used = np.zeros(len(points), dtype=bool)
        used[elements] = True
        number = np.cumsum(used) - 1
        surfaces = {name: number[at[used[at]]] for name, at in surfaces.items()}
        surfaces = {name: at for name, at in surfaces.items() if at.size}
        points, elements = points[used], number[elements]
    if elements.shape[1] in CORNERS:
        if not upgrade:
            raise ValueError(
                f"the file has {elements.shape[1]}-node elements, which lock in bending; export "
                f"{CORNERS[elements.shape[1]]}-node ones, or pass upgrade=True to give them middle nodes "
                "(on straight edges)"
            )
        return _upgraded(points, elements, named, surfaces, raw.numbers)
    if elements.shape[1] not in KINDS:
        raise ValueError(
            f"the file has {elements.shape[1]}-node elements; bricks of 20 or 27, tetrahedra of 10"
        )
    return SolidMesh(points, elements, named, surfaces, raw.numbers)


def _regions(raw: RawMesh, chosen: Sequence[str] | None) -> dict[str, Index]:
    """The sets of elements that are regions: those asked for, those with a material, or all that fit."""
    known = {name: np.unique(at) for name, at in raw.regions.items() if len(at)}
    if chosen is not None:
        for name in chosen:
            if name not in known:
                raise ValueError(f"regions has {name!r}; {meant(name, known)}, the file's sets of elements")
        return {name: known[name] for name in chosen}
    if raw.preferred:
        return {name: known[name] for name in raw.preferred if name in known}
    total = len(raw.numbers)
    parts = {name: at for name, at in known.items() if at.size < total}
    uses = np.bincount(np.concatenate([*parts.values(), np.zeros(0, dtype=np.intp)]), minlength=total)
    if parts and np.all(uses == 1):
        return parts
    whole = [name for name, at in known.items() if at.size == total]
    overlap = bool(np.any(uses > 1))
    if not parts or (whole and not overlap):
        return {whole[0]: known[whole[0]]} if whole else {}
    fault = "overlap" if overlap else "leave elements out"
    raise ValueError(
        f"the sets of elements {sorted(parts)} {fault}; name those that are regions with regions=(...), "
        "or pass regions=() for a single region"
    )


def _upgraded(
    points: Array, corners: Index, regions: Mapping[str, Index], surfaces: Mapping[str, Index], numbers: Index
) -> SolidMesh:
    """Linear elements made second-order; middle nodes join the surfaces on whose faces they lie."""
    points, elements, ends = second_order(points, corners)
    mesh = SolidMesh(points, elements, regions, {}, numbers)
    before, sides = len(points) - len(ends), len(mesh.kind.faces[0])
    complete = {}
    for name, at in surfaces.items():
        faces = mesh.boundary[np.isin(mesh.boundary[:, :sides], at).all(axis=1)]
        between = before + np.flatnonzero(np.isin(ends, at).all(axis=1))  # of a surface inside the body
        complete[name] = np.concatenate([at, faces.ravel() if len(faces) else between])
    return replace(mesh, surfaces=complete)
