"""Rigid motions: of one part, and of all parts against each other."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

import numpy as np
import scipy.linalg

from bearingdyn.application.channel import COMPONENTS
from bearingdyn.cms import Superelement
from bearingdyn.kept_by_object import kept_by_object
from bearingdyn.types import Array

# energy of a rigid motion, of what the same entries would give without cancelling: round-off of a reduction
FREE = 1e-10
# of a constraint on unit rigid motions, the largest being 1: below is round-off
HELD = 1e-9


@kept_by_object
def rigid_shapes(element: Superelement) -> Array | None:
    """Rigid motions (n, 6) of a part in its coordinates, from which free motions are found.

    The columns are unit x, y, z, θx, θy, θz of that interface. The other coordinates, internal ones included,
    follow from the stiffness alone, because a rigid motion strains nothing: K_oo x_o = −K_oi x_i.

    The result is None for a part without interfaces, or one whose own stiffness resists a rigid motion.
    """
    if not element.interfaces:
        return None
    K = np.array(element.K)
    for term in element.viscoelastic:  # any modulus serves at which K is positive, stressed parts' too
        firm, shear = np.abs(K).max(), np.abs(term.H).max()
        K += (firm / shear if firm > 0 and shear > 0 else 1.0) * term.H
    first = next(iter(element.interfaces.values()))
    others = np.setdiff1d(np.arange(element.n), first)
    R = np.zeros((element.n, 6))
    R[first] = np.eye(6)
    if others.size:
        K_oo, K_oi = K[np.ix_(others, others)], K[np.ix_(others, first)]
        scale = np.sqrt(np.maximum(np.diag(K_oo), np.finfo(float).tiny))
        scaled = K_oo / np.outer(scale, scale)
        R[others] = -np.linalg.lstsq(scaled, K_oi / scale[:, None], rcond=None)[0] / scale[:, None]
    stored, size = np.sum(R * (K @ R), axis=0), np.sum(np.abs(R) * (np.abs(K) @ np.abs(R)), axis=0)
    if (np.abs(stored) > FREE * size).any():
        return None
    return R


def arm(rows: Array, shapes: Array) -> Array:
    """For free motions of a part, a place's arm (3,), m, from its first interface: θ moves it by θ × arm.

    Parameters
    ----------
    rows
        (3 or 6, n) motion of the place by the part's coordinates.
    shapes
        (n, 6) as by `rigid_shapes`.
    """
    turned = rows[:3] @ shapes[:, 3:]
    return (
        np.array([turned[1, 2] - turned[2, 1], turned[2, 0] - turned[0, 2], turned[0, 1] - turned[1, 0]]) / 2
    )


def free_motions(
    shapes: Mapping[str, Array | None], held: Iterable[Mapping[str, Array]]
) -> list[list[tuple[str, str]]]:
    """Motions that no constraint holds, where each part is taken as rigid.

    Parameters
    ----------
    shapes
        (n, 6) of each part as by `rigid_shapes`; a part with None is taken as held.
    held
        Constraints: each holds the sum of rows (k, n) @ coordinates over the parts it names.

    Returns
    -------
    list of list of (part, component)
        One list for each free motion: what moves in it, by the components of each part's first interface.
    """
    parts = {name: R for name, R in shapes.items() if R is not None}
    at = {name: 6 * i for i, name in enumerate(parts)}
    rows = []
    for constraint in held:
        known = {p: A for p, A in constraint.items() if p in parts}
        if known:
            block = np.zeros((len(next(iter(known.values()))), 6 * len(parts)))
            for p, A in known.items():
                block[:, at[p] : at[p] + 6] += A @ parts[p]
            rows.append(block)
    null = np.eye(6 * len(parts))
    if rows:
        C = np.vstack(rows)
        C = C / np.maximum(np.linalg.norm(C, axis=1, keepdims=True), np.finfo(float).tiny)
        null = scipy.linalg.null_space(C, rcond=HELD)
    if null.shape[1] == 0:
        return []
    # one named coordinate moves in each motion and in no other
    pivots = scipy.linalg.qr(null.T, pivoting=True, mode="economic")[2][: null.shape[1]]
    null = null @ np.linalg.inv(null[np.sort(pivots)])
    names = [(p, c) for p in parts for c in COMPONENTS]
    found = []
    for column in null.T:
        large = np.flatnonzero(np.abs(column) > 1e-6 * np.abs(column).max())
        found.append([names[i] for i in large])
    return found
