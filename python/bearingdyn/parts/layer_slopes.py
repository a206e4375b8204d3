"""Derivatives of a layer's reduced matrices with respect to its dimensions, bulk modulus and density.

The mesh moves linearly with the radii and the width. The shapes move along: with the inner nodes in balance,

    K_ii u_i' = −(K' u)_i − K_ib R'

and a reduced matrix ΨᵀAΨ changes by Ψ'ᵀAΨ + ΨᵀA'Ψ + ΨᵀAΨ'. The internal shapes are taken as the same
combinations of differences between moduli, which leaves what they span, and so every response, as it is.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from bearingdyn.checks import require
from bearingdyn.fem import Harmonic, factorise, harmonic_slope
from bearingdyn.parts.layer import Layer
from bearingdyn.parts.revolved_boundaries import Boundaries
from bearingdyn.parts.revolved_shapes import ROUND_OFF
from bearingdyn.parts.shape_moduli import shape_moduli
from bearingdyn.types import Array, Index

DIMENSIONS = ("r_inner", "r_outer", "width")
"""Dimensions of a layer that matrices are differentiated with respect to, m."""


@dataclass(frozen=True, eq=False)
class LayerSlopes:
    """Derivatives of a layer's reduced mass, volumetric stiffness and deviatoric matrix, (n, n) each."""

    M: Array
    K: Array
    H: Array


def layer_slopes(layer: Layer, name: str) -> LayerSlopes:
    """Derivative of the matrices that `layer.superelement()` has, the moduli of its shapes held.

    Parameters
    ----------
    layer
        With flat ends.
    name
        "r_inner", "r_outer", "width", "K" or "density".

    Returns
    -------
    LayerSlopes
        Per m, Pa or kg/m³, in the coordinates of the superelement.

    Raises
    ------
    ValueError
        For a layer with recessed ends.
    """
    require(layer.recess == 0, "Layer.recess", layer.recess, "it must be 0 for a derivative: flat ends")
    body = layer.body
    mesh = body.mesh
    across = (mesh.r - layer.r_inner) / layer.thickness
    dr, dz = np.zeros_like(mesh.r), np.zeros_like(mesh.z)
    if name == "r_inner":
        dr = 1.0 - across
    elif name == "r_outer":
        dr = across
    elif name == "width":
        dz = mesh.z / layer.width
    # the moduli of the shapes, of the one region, at every level
    levels = [level[0] for level in shape_moduli(body.regions, body.moduli)]
    bulk, density = layer.material.K, layer.material.density
    n = body._size
    M, K, H = (np.zeros((n, n)) for _ in range(3))
    for h, Psi, places in body._placed():
        slope = harmonic_slope(h, dr, dz) if name in DIMENSIONS else None
        bent = _shape_slope(h, Psi, body._boundaries, bulk, levels, slope, name == "K", (dr, dz))
        deviatoric, volumetric, mass = (h.matrix(A.sum(axis=0)) for A in _data(h))
        first, second, third = (
            (None, None, None) if slope is None else (h.matrix(A.sum(axis=0)) for A in _data(slope))
        )
        more = [(H, deviatoric, first), (K, bulk * volumetric, None if second is None else bulk * second)]
        more.append((M, density * mass, None if third is None else density * third))
        for full, A, dA in more:
            half = bent.T @ (A @ Psi)
            a = half + half.T
            if dA is not None:
                a = a + Psi.T @ (dA @ Psi)
            if name == "K" and full is K:
                a = a + Psi.T @ (volumetric @ Psi)
            if name == "density" and full is M:
                a = a + Psi.T @ (mass @ Psi)
            for index, sign in places:
                full[np.ix_(index, index)] += np.outer(sign, sign) * 0.5 * (a + a.T)
    P = body._free_of_rigid_motion(n)
    return LayerSlopes(M, P @ K @ P, P @ H @ P)


def _data(h: Harmonic) -> tuple[Array, Array, Array]:
    return h.deviatoric, h.volumetric, h.mass


def _shape_slope(
    h: Harmonic,
    Psi: Array,
    boundaries: Boundaries,
    bulk: float,
    levels: Sequence[float],
    slope: Harmonic | None,
    by_bulk: bool,
    rates: tuple[Array, Array],
) -> Array:
    """Derivative of the shapes Psi (n, columns) of one family."""
    at, R = boundaries.held(h)
    inner = np.setdiff1d(h.free, at)
    dR = _rigid_slope(h, boundaries, at, rates)

    def solved(G: float) -> tuple[Array, Array]:
        """Constraint shapes at a modulus, and their derivative."""
        K = h.stiffness([bulk], [G])
        lu: Any = factorise(K[inner][:, inner])
        u, du = np.zeros((h.n, R.shape[1])), np.zeros((h.n, R.shape[1]))
        u[at], du[at] = R, dR
        u[inner] = -lu.solve(np.asarray(K[inner][:, at] @ R))
        load = K[inner][:, at] @ dR
        if slope is not None:
            load = load + (slope.stiffness([bulk], [G]) @ u)[inner]
        if by_bulk:
            load = load + (h.matrix(h.volumetric.sum(axis=0)) @ u)[inner]
        du[inner] = -lu.solve(np.asarray(load))
        return u, du

    fixed = R.shape[1]
    bent = np.zeros_like(Psi)
    if slope is None and not by_bulk:
        return bent
    static, d_static = solved(levels[0])
    bent[:, :fixed] = d_static
    if Psi.shape[1] == fixed:
        return bent
    K = h.stiffness([bulk], [levels[0]])
    k = static.T @ (K @ static)
    scale = np.sum(np.abs(static) * (abs(K) @ np.abs(static)), axis=0)
    moving = np.diag(k) > ROUND_OFF * scale
    moving[: fixed // 2] = False  # as the basis does: of the first face nothing
    unit = 1.0 / np.sqrt(np.diag(k)[moving])
    raw, d_raw = [], []
    for G in levels[1:]:
        u, du = solved(G)
        raw.append((u - static)[:, moving] * unit)
        d_raw.append((du - d_static)[:, moving] * unit)
    mix = np.linalg.lstsq(np.hstack(raw), Psi[:, fixed:], rcond=None)[0]
    bent[:, fixed:] = np.hstack(d_raw) @ mix
    return bent


def _rigid_slope(h: Harmonic, boundaries: Boundaries, at: Index, rates: tuple[Array, Array]) -> Array:
    """Derivative of the rigid shapes on the faces (held, columns), whose nodes move."""
    import scipy.linalg

    blocks = []
    for face in boundaries.faces.values():
        dr, dz = rates[0][face.nodes], rates[1][face.nodes]
        zero = np.zeros_like(dr)
        if h.order == 1:
            block = np.stack([[zero, dz], [zero, -dz], [zero, -dr]]).transpose(2, 0, 1).reshape(-1, 2)
        elif h.components == (1,):
            block = dr[:, None]
        else:
            block = np.zeros((2 * dr.size, 1))
        blocks.append(block)
    kept = np.concatenate([h.coordinates(f.nodes) for f in boundaries.faces.values()])
    return np.asarray(scipy.linalg.block_diag(*blocks)[np.isin(kept, h.free)])
