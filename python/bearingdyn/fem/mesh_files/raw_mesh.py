"""A mesh as a file gives it, and how it becomes a SolidMesh."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from bearingdyn.checks import meant, positive
from bearingdyn.fem.meshes.solid_element import KINDS, OF_CORNERS
from bearingdyn.fem.meshes.solid_mesh import SolidMesh, merged, second_order
from bearingdyn.notice import LeftOut, warn
from bearingdyn.types import Array, Index

LESS = {27: 20, 18: 15, 14: 13}  # nodes of an element, and of the one without middles of faces


@dataclass(frozen=True, eq=False, kw_only=True)
class RawMesh:
    """A raw mesh, as a file gives it: nodes, solid elements of one kind or more, and sets, unchecked.

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


def warn_of_lean(path: Path, lean: Mapping[str, int]) -> None:
    """Warn of a raw mesh's elements without volume, numbers of them by kind, which are left out (LeftOut)."""
    if lean:
        told = ", ".join(f"{count} of type {kind}" for kind, count in sorted(lean.items()))
        warn(
            f"{path.name}: elements without volume are left out, and with them their mass and stiffness: "
            f"{told}; add them to the application (bd.RigidBody, Application.spring), or delete them",
            LeftOut,
        )


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
    """A raw mesh made into a SolidMesh: in m, second-order and checked."""
    positive("scale", scale, "it must be the length of the file's unit in m, as 1e-3 for mm")
    points = scale * raw.points
    if not raw.cells:
        raise ValueError("the file holds no brick, wedge, pyramid or tetrahedron")
    elements, left = _side_by_side(raw.cells)
    if not np.all(np.isfinite(points)):
        raise ValueError(f"node {int(np.flatnonzero(~np.isfinite(points).all(axis=1))[0])} is not finite")
    nodes = np.unique(elements[elements >= 0])
    if elements.min() < -1 or nodes[-1] >= len(points):
        raise ValueError("an element names a node that the file does not have")
    extent = float(np.ptp(points[nodes], axis=0).max())
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
        elements, left = np.where(elements >= 0, label[elements], -1), label[left]
        surfaces = {name: np.unique(label[at]) for name, at in surfaces.items()}
    if drop_unconnected or left.size:
        used = np.zeros(len(points), dtype=bool)
        if not drop_unconnected:
            used[:] = True
            used[left] = False
        used[elements[elements >= 0]] = True
        number = np.cumsum(used) - 1
        surfaces = {name: number[at[used[at]]] for name, at in surfaces.items()}
        surfaces = {name: at for name, at in surfaces.items() if at.size}
        points, elements = points[used], np.where(elements >= 0, number[elements], -1)
    if elements.shape[1] in OF_CORNERS:
        if not upgrade:
            raise ValueError(
                f"the file has {elements.shape[1]}-node elements, which lock in bending; export "
                f"{OF_CORNERS[elements.shape[1]].nodes}-node ones, or pass upgrade=True to give them middle "
                "nodes (on straight edges)"
            )
        return _upgraded(points, elements, named, surfaces, raw.numbers)
    return SolidMesh(points, elements, named, surfaces, raw.numbers)


def _side_by_side(cells: Sequence[Index]) -> tuple[Index, Index]:
    """Elements of several sizes in one array, rows of smaller ones ended with −1; and nodes left out.

    Wedges of 18 and pyramids of 14 nodes lose the middles of their faces, and bricks of 27 beside other
    kinds, for the faces of the neighbours have none.

    Raises
    ------
    ValueError
        For elements of another size, and linear elements among quadratic ones.
    """
    sizes = sorted({c.shape[1] for c in cells})
    strange = [n for n in sizes if n not in KINDS and n not in OF_CORNERS and n not in LESS]
    if strange:
        raise ValueError(
            f"the file has {strange[0]}-node elements; bricks of 20 or 27, wedges of 15 or 18, pyramids of "
            "13 or 14 and tetrahedra of 10 are read"
        )
    linear = [n for n in sizes if n in OF_CORNERS]
    if linear and linear != sizes:
        raise ValueError(
            f"the file mixes elements of {' and '.join(map(str, sizes))} nodes; mesh the body with elements "
            "of one order"
        )
    fewer = {n: LESS[n] for n in sizes if n in LESS and (n != 27 or len(sizes) > 1)}
    kept = [c[:, : fewer.get(c.shape[1], c.shape[1])] for c in cells]
    left = [c[:, fewer[c.shape[1]] :].ravel() for c in cells if c.shape[1] in fewer]
    width = max(c.shape[1] for c in kept)
    padded = [np.pad(c, ((0, 0), (0, width - c.shape[1])), constant_values=-1) for c in kept]
    return np.vstack(padded), np.unique(np.concatenate([*left, np.zeros(0, dtype=np.intp)]))


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
    before = len(points) - len(ends)
    skin = mesh.boundary
    corner = skin < before
    complete = {}
    for name, at in surfaces.items():
        faces = skin[(np.isin(skin, at) | ~corner).all(axis=1)]
        between = before + np.flatnonzero(np.isin(ends, at).all(axis=1))  # of a surface inside the body
        complete[name] = np.concatenate([at, faces.ravel() if len(faces) else between])
    return replace(mesh, surfaces=complete)
