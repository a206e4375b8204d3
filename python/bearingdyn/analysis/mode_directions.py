"""Which way the turning parts move in a mode: sideways, along the shaft, or about it."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from bearingdyn.application import Place
from bearingdyn.system import System
from bearingdyn.types import Complex

DIRECTIONS = ("lateral", "axial", "torsional")


def directions(system: System, shapes: Complex) -> NDArray[np.str_]:
    """Direction of each mode shape (m, n): the largest of DIRECTIONS over the places that turn.

    A turn θz counts with the radius of gyration of its part about its first interface, tilts θx, θy likewise,
    so that a rigid body that only tilts is lateral. All parts count if none turns.
    """
    turning = set(system.turning)
    size = np.zeros((len(DIRECTIONS), len(shapes)))
    for term in system.parts:
        if turning and term.name not in turning:
            continue
        # mass, and moments of inertia about x, y, z, of the part as a rigid body
        inertia = np.einsum("ik,ij,jk->k", term.rigid, term.element.M, term.rigid)
        known = np.isfinite(inertia).all() and inertia[2] > 0
        square = inertia[3:] / inertia[2] if known else np.zeros(3)
        for name, rows in system.outputs.items():
            if Place.parse(name).part != term.name:
                continue
            motion = np.abs(rows @ shapes.T) ** 2
            size[0] += motion[0] + motion[1]
            size[1] += motion[2]
            if len(rows) == 6:
                size[0] += square[0] * motion[3] + square[1] * motion[4]
                size[2] += square[2] * motion[5]
    return np.asarray(np.array(DIRECTIONS)[np.argmax(size, axis=0)])
