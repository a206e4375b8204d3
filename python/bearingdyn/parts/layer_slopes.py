"""Derivatives of a layer's reduced matrices with respect to its dimensions, bulk modulus and density.

The mesh moves linearly with the radii and the width. The shapes move along: with the inner nodes in balance,

    K_ii u_i' = −(K' u)_i − K_ib R'

and a reduced matrix ΨᵀAΨ changes by Ψ'ᵀAΨ + ΨᵀA'Ψ + ΨᵀAΨ'. The internal shapes are taken as the same
combinations of differences between moduli, which leaves what they span, and so every response, as it is.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from bearingdyn.checks import require
from bearingdyn.fem import Harmonic, harmonic_slopes, held_factors, moved_sections
from bearingdyn.parts.layer import Layer
from bearingdyn.parts.revolved_joints import Boundaries
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


def layer_slopes(layer: Layer, names: Sequence[str]) -> dict[str, LayerSlopes]:
    """Derivatives of the matrices that `layer.superelement()` has, the moduli of its shapes held.

    Parameters
    ----------
    layer
        With flat ends.
    names
        Of "r_inner", "r_outer", "width", "K" and "density"; together they share the shapes' factors.

    Returns
    -------
    dict of str to LayerSlopes
        By name, per m, Pa or kg/m³, in the coordinates of the superelement.

    Raises
    ------
    ValueError
        For a layer with recessed ends.
    """
    require(layer.recess == 0, "Layer.recess", layer.recess, "it must be 0 for a derivative: flat ends")
    body = layer.body
    mesh = body.mesh
    across, still = (mesh.r - layer.r_inner) / layer.thickness, np.zeros_like(mesh.r)
    rates = {
        "r_inner": (1.0 - across, still),
        "r_outer": (across, still),
        "width": (still, mesh.z / layer.width),
    }
    moving = [name for name in names if name in DIMENSIONS]
    bending = [name for name in names if name != "density"]
    # the moduli of the shapes, of the one region, at every level
    levels = [level[0] for level in shape_moduli(body.regions, body.moduli)]
    bulk, density = layer.material.K, layer.material.density
    n = body._size
    found = {name: LayerSlopes(*(np.zeros((n, n)) for _ in range(3))) for name in names}
    sections = moved_sections(mesh, [rates[name] for name in moving])
    for h, Psi, places in body._placed():
        slopes = dict(zip(moving, harmonic_slopes(h, sections), strict=True))
        whole = _Matrices.of(h)
        loads = {
            name: _Motion(slopes[name], *rates[name]) if name in slopes else _Motion(None, still, still)
            for name in bending
        }
        shapes = _shape_slopes(h, Psi, body._boundaries, bulk, levels, loads)
        sides = whole.deviatoric @ Psi, bulk * (whole.volumetric @ Psi), density * (whole.mass @ Psi)
        for name, to in found.items():
            reduced = [np.zeros((Psi.shape[1],) * 2) for _ in range(3)]
            if name in shapes:
                reduced = [half + half.T for half in (shapes[name].T @ side for side in sides)]
            if name in slopes:
                own = _Matrices.of(slopes[name])
                reduced[0] += Psi.T @ (own.deviatoric @ Psi)
                reduced[1] += bulk * (Psi.T @ (own.volumetric @ Psi))
                reduced[2] += density * (Psi.T @ (own.mass @ Psi))
            elif name == "K":
                reduced[1] += Psi.T @ sides[1] / bulk
            elif name == "density":
                reduced[2] += Psi.T @ sides[2] / density
            for index, sign in places:
                for full, a in zip((to.H, to.K, to.M), reduced, strict=True):
                    full[np.ix_(index, index)] += np.outer(sign, sign) * 0.5 * (a + a.T)
    P = body._free_of_rigid_motion(n)
    return {name: LayerSlopes(to.M, P @ to.K @ P, P @ to.H @ P) for name, to in found.items()}


@dataclass(frozen=True, eq=False)
class _Matrices:
    """Sparse matrices of all regions of a harmonic, per unit of modulus and density."""

    deviatoric: Any
    volumetric: Any
    mass: Any

    @classmethod
    def of(cls, h: Harmonic) -> _Matrices:
        return cls(*(h.matrix(A.sum(axis=0)) for A in (h.deviatoric, h.volumetric, h.mass)))


@dataclass(frozen=True, eq=False)
class _Motion:
    """How a parameter moves the shapes: by slopes of matrices, None for the bulk modulus, and nodes."""

    slope: Harmonic | None
    dr: Array
    dz: Array


def _shape_slopes(
    h: Harmonic,
    Psi: Array,
    boundaries: Boundaries,
    bulk: float,
    levels: Sequence[float],
    motions: Mapping[str, _Motion],
) -> dict[str, Array]:
    """Derivatives of the shapes Psi (n, columns) of one family, by each motion."""
    at, R = boundaries.held(h)
    inner = np.setdiff1d(h.free, at)
    dR = {name: _rigid_slope(h, boundaries, at, (m.dr, m.dz)) for name, m in motions.items()}
    fixed = R.shape[1]

    def solved(G: float) -> tuple[Array, dict[str, Array]]:
        """Constraint shapes at a modulus, and their derivatives."""
        K = h.stiffness([bulk], [G])
        lu = held_factors(h, K, inner)
        edge = K[inner][:, at]
        u = np.zeros((h.n, fixed))
        u[at] = R
        u[inner] = -lu.solve(np.asarray(edge @ R))
        loads = []
        for name, m in motions.items():
            A = h.matrix(h.volumetric.sum(axis=0)) if m.slope is None else m.slope.stiffness([bulk], [G])
            loads.append(edge @ dR[name] + (A @ u)[inner])
        within = -lu.solve(np.hstack(loads))
        found = {}
        for k, name in enumerate(motions):
            du = np.zeros_like(u)
            du[at], du[inner] = dR[name], within[:, k * fixed : (k + 1) * fixed]
            found[name] = du
        return u, found

    if not motions:
        return {}
    static, d_static = solved(levels[0])
    bent = {name: np.zeros_like(Psi) for name in motions}
    for name, to in bent.items():
        to[:, :fixed] = d_static[name]
    if Psi.shape[1] == fixed:
        return bent
    K = h.stiffness([bulk], [levels[0]])
    k = static.T @ (K @ static)
    scale = np.sum(np.abs(static) * (abs(K) @ np.abs(static)), axis=0)
    moving = np.diag(k) > ROUND_OFF * scale
    moving[: fixed // 2] = False  # as the basis does: of the first face nothing
    unit = 1.0 / np.sqrt(np.diag(k)[moving])
    others = [solved(G) for G in levels[1:]]
    raw = np.hstack([(u - static)[:, moving] * unit for u, _ in others])
    mix = np.linalg.lstsq(raw, Psi[:, fixed:], rcond=None)[0]
    for name, to in bent.items():
        turned = np.hstack([(du[name] - d_static[name])[:, moving] * unit for _, du in others])
        to[:, fixed:] = turned @ mix
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
