"""What holds a system: bodies free to move, and layers that creep under a constant load."""

from __future__ import annotations

import numpy as np

from bearingdyn.application import COMPONENTS, Place
from bearingdyn.system.layer_static_modulus import static_modulus
from bearingdyn.system.natural_modes import natural
from bearingdyn.system.system import TEST_SPRING, System
from bearingdyn.types import Array


def check_held(system: System, firm: Array) -> None:
    """Refuse a system that is not held: only the spin of a shaft in its bearings may be free.

    Parameters
    ----------
    system
        The system.
    firm
        Stiffness (n, n) without the parts that creep (G0 = 0); under a constant load only this part holds.

    Raises
    ------
    ValueError
        For coordinates without mass, a body that is free (named, with its direction), a load that turns a
        free shaft, and a constant load that rests on a layer without a relaxed modulus.
    """
    unsupported = np.flatnonzero(np.diag(system.M) <= 0.0)
    if unsupported.size:
        raise ValueError(
            f"{unsupported.size} coordinates have no mass (first: {_describe(system, int(unsupported[0]))}); "
            f"give every body a mass and moments of inertia"
        )
    load = system.static_load()
    if not system.bearings and not load.any():
        return  # a free body may be analysed as such: its rigid modes are its answer
    free = system.free_motions("instantaneous")
    if free.shape[1] == 0:
        _check_creep(system, firm, free)
        return
    sites = [(name, rows) for name, rows in system.outputs.items() if rows.shape[0] == 6]
    moving = np.vstack([rows[:5] @ free for _, rows in sites])
    spin = np.vstack([rows[5] @ free for _, rows in sites])
    _, strengths, directions = np.linalg.svd(moving, full_matrices=False)
    if strengths[0] > 1e-6 * max(float(np.abs(spin).max()), strengths[0] * 1e-3):
        motion = free @ directions[0]
        name, component = max(
            ((name, k) for name, rows in sites for k in range(5)),
            key=lambda site: abs(float(dict(sites)[site[0]][site[1]] @ motion)),
        )
        raise ValueError(
            f"{Place.parse(name).part!r} is free to move in {COMPONENTS[component]} (seen at {name}); "
            f"connect it, ground it or carry it by a bearing"
        )
    torque = free.T @ load
    if np.abs(torque).max() > 1e-9 * max(1.0, float(np.abs(load).max())):
        raise ValueError(
            "a constant load turns a shaft about z, and bearings do not resist that rotation; "
            "ground it or leave the torque out"
        )
    _check_creep(system, firm, free)


def _check_creep(system: System, firm: Array, free: Array) -> None:
    """Refuse a constant load that rests on a layer without a relaxed modulus: ValueError.

    The reduced shapes of such a layer still resist a change of volume, but the rubber itself would flow.
    """
    soft = [t.part for t in system.layers if static_modulus(t, "relaxed") == 0.0]
    load = system.static_load()
    if not soft or not load.any():
        return
    squares, shapes = natural(firm + TEST_SPRING * (system.B.T @ system.B), system.M)
    creeping = shapes[:, squares <= 0.0]
    creeping = creeping - free @ (free.T @ (system.M @ creeping))
    if np.abs(creeping.T @ load).max(initial=0.0) > 1e-9 * float(np.abs(shapes.T @ load).max()):
        raise ValueError(
            f"layer {soft[0]!r} has G0 = 0; under a constant load it creeps without end, and there is no "
            f"equilibrium; fit the material with a relaxed modulus G0 > 0"
        )


def _describe(system: System, coordinate: int) -> str:
    for name, rows in system.outputs.items():
        for k, row in enumerate(rows):
            if row[coordinate] != 0.0:
                return f"{name}.{COMPONENTS[k]}"
    return f"coordinate {coordinate}"
