"""Mode shapes where they can be seen: at the interfaces and outputs of the parts, and on their surfaces."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from bearingdyn.analysis.equilibrium import Equilibrium, state_of
from bearingdyn.application import COMPONENTS, Application, arm
from bearingdyn.checks import name_list, whole
from bearingdyn.parts import Outlined
from bearingdyn.results import check_dataset, dataset, inputs_of
from bearingdyn.short_repr import short
from bearingdyn.system import System, system_of
from bearingdyn.types import Array, Complex, Index

if TYPE_CHECKING:
    import xarray


@dataclass(frozen=True, eq=False)
class MovedSurface:
    """One part's surface in a mode shape: its points, faces and motion.

    Parameters
    ----------
    part
        Its name.
    points
        (p, 3), m, from the first interface of the first part.
    faces
        (f, 3 or 4), the corners of each face among the points.
    motion
        (p, 3), complex, m, of the size that the mode has.
    """

    part: str
    points: Array
    faces: Index
    motion: Complex

    __repr__ = short


def mode_shapes(source: Equilibrium | Application | System, found: xarray.Dataset) -> xarray.Dataset:
    """Motion of every interface and output in the modes that `modes` found, and where each stands.

    Parameters
    ----------
    source
        What the modes were found of.
    found
        As `modes` returns it.

    Returns
    -------
    xarray.Dataset
        motion (mode, place, component), complex, m and rad, of the size that the modes have, NaN for the
        rotations of outputs without any; position (place, axis), m, from the first interface of the first
        part; and frequency (mode). Places that nothing joins to the first part are left out.

    Raises
    ------
    ValueError
        For modes of another system, and for a system that does not know its parts.
    """
    system, shape = _of_one_system(source, found)
    places = [name for name in system.outputs if name in system.positions]
    if not places:
        raise ValueError("the system does not know where its parts stand; pass an application")
    motion = np.full((len(shape), len(places), 6), np.nan, dtype=np.complex128)
    for k, name in enumerate(places):
        rows = system.rows(name)
        motion[:, k, : len(rows)] = shape @ rows.T

    return dataset(
        {
            "motion": (
                ("mode", "place", "component"),
                motion,
                "m, rad",
                "mode shape at interfaces and outputs",
            ),
            "position": (
                ("place", "axis"),
                np.array([system.positions[name] for name in places]),
                "m",
                "from the first interface of the first part",
            ),
            "frequency": ("mode", found["frequency"].values, "Hz", "undamped natural frequency |λ|/2π"),
        },
        {"analysis": "mode shapes", **state_of(source), **inputs_of(system.inputs)},
        {"place": (places, ""), "component": (list(COMPONENTS), ""), "axis": (["x", "y", "z"], "")},
    )


def mode_surfaces(
    source: Equilibrium | Application | System,
    found: xarray.Dataset,
    mode: int,
    parts: Sequence[str] | None = None,
) -> list[MovedSurface]:
    """Mode shapes of the parts' surfaces, for one of the modes that `modes` found.

    Parameters
    ----------
    source
        What the modes were found of.
    found
        As `modes` returns it.
    mode
        Which of them, counted from 0.
    parts
        Names of the parts wanted; None for all that have a surface and are joined to the first part. Bare
        superelements and imported matrices have no surface.

    Returns
    -------
    list of MovedSurface

    Raises
    ------
    ValueError
        For modes of another system, a mode that does not exist, a part without a surface or a known place,
        and where no part has a surface.
    """
    system, shape = _of_one_system(source, found)
    parts = None if parts is None else name_list("parts", parts, "parts")
    mode = whole("mode", mode, 0, len(shape) - 1, f"there are modes 0 to {len(shape) - 1}")
    moved = []
    for term in system.parts:
        place = system.positions.get(f"{term.name}.{next(iter(term.element.interfaces), None)}")
        if place is None or (parts is not None and term.name not in parts):
            continue
        if isinstance(term.source, Outlined):
            outline = term.source.outline()
            # the mean of the points, from the first interface and in the part's own frame
            mean = outline.rows.reshape(-1, 3, outline.rows.shape[1]).mean(axis=0)
            shift = place + arm(mean, term.rigid) - outline.points.mean(axis=0)
            motion = (outline.rows @ (term.place @ shape[mode])).reshape(-1, 3)
            moved.append(MovedSurface(term.name, outline.points + shift, outline.faces, motion))
    drawn = [surface.part for surface in moved]
    lacking = sorted(set(parts or ()) - set(drawn))
    if lacking or not moved:
        raise ValueError(
            f"{lacking[0]!r} names no part that can be drawn" if lacking else "no part has a surface to draw"
        )
    return moved


def _of_one_system(
    source: Equilibrium | Application | System, found: xarray.Dataset
) -> tuple[System, Complex]:
    """The system, and the shapes (mode, coordinate) of its modes."""
    check_dataset("found", found, ["shape"], "modes")
    system = source.system if isinstance(source, Equilibrium) else system_of("source", source)
    shape = found["shape"].values
    if shape.shape[1] != system.n:
        raise ValueError(
            f"the modes have {shape.shape[1]} coordinates and the system {system.n}; give modes of this one"
        )
    return system, shape
