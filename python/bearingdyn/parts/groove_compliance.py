"""Static compliance of the grooves of a body of revolution, order by order, whole or from its shapes."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from bearingdyn.fem import ALL_COMPONENTS, AXIAL, RevolutionMesh, assemble_harmonic, factorise
from bearingdyn.parts.raceway_shapes import Order, PortShapes
from bearingdyn.parts.revolved_joints import Boundaries
from bearingdyn.types import Array


def groove_compliances(
    mesh: RevolutionMesh, boundaries: Boundaries, bulk: Sequence[float], shear: Sequence[float], n: int
) -> Array:
    """Compliance (2 grooves, 2 grooves) of order n of the whole model, m/N; see Revolved.groove_compliances.

    Parameters
    ----------
    mesh, boundaries
        Of the section, and what is held or carries balls.
    bulk, shear
        Of each region, Pa.
    n
        Order.

    Raises
    ------
    ValueError
        In an order in which nothing holds the body.
    """
    h = assemble_harmonic(mesh, n, AXIAL if n == 0 else ALL_COMPONENTS)
    held = boundaries.held(h)[0]
    rows = boundaries.averages(h, beyond=True)
    if not held.size and n == 1:
        raise ValueError("order 1 of a body that nothing holds has no static compliance")
    if not held.size and n == 0:
        # it breathes where it is; along the axis it would fly away
        rows[1::2], held = 0.0, np.array([1], dtype=np.intp)
    inner = np.setdiff1d(h.free, held)
    K = h.stiffness(bulk, shear)[inner][:, inner]
    return np.asarray(rows[:, inner] @ factorise(K).solve(np.asarray(rows[:, inner].T, order="F")))


def carried_compliance(
    order: Order, shapes: PortShapes, shear: Sequence[float], at: int, direction: Array
) -> float:
    """Compliance of a groove along a direction (r, z) in an order that is carried, m/N: its shapes have it.

    Parameters
    ----------
    order, shapes
        The whole model of the order and its shapes.
    shear
        Of each region, Pa.
    at
        First of the groove's two ports.
    direction
        (2,), radial and axial.
    """
    Psi = shapes.Psi[:, shapes.faces :]
    row = direction @ order.ports[at : at + 2] @ Psi
    return float(row @ np.linalg.solve(Psi.T @ (order.h.stiffness(order.bulk, shear) @ Psi), row))
