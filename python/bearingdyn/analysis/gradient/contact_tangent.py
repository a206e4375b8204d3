"""A bearing at rest in complex arithmetic, so that a complex step differentiates its tangents."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from bearingdyn.bearing import BearingKernel
from bearingdyn.types import Array, Complex, Index

STEP = 1e-30
# of the largest approach: below it the core's own round-off says whether a ball carries
GRAZING = 1e-7


@dataclass(frozen=True, eq=False)
class Tangent:
    """For gradients: contact force g (n,), N, and tangents K, C (n, n); approach u (Z,) of the balls, m."""

    g: Complex
    K: Complex
    C: Complex
    approach: Complex


def tangent(
    kernel: BearingKernel,
    z: Array | Complex,
    change: Mapping[str, complex] | None = None,
    carrying: Any = None,
) -> Tangent:
    """For gradients: contact force and tangents of a bearing at rest at coefficients z (n,), real or complex.

    Parameters
    ----------
    kernel
        The bearing, its first ball at `angle0`.
    z
        m.
    change
        Fields of the kernel that differ, complex: x0, y0, e0, kappa, h0.
    carrying
        (Z,) which balls carry; None: those that are pressed.

    References
    ----------
    csrc/balls.c, which does the same in real numbers.
    """
    given: dict[str, complex] = {name: getattr(kernel, name) for name in ("x0", "y0", "e0", "kappa", "h0")}
    given.update(change or {})
    x0, y0, e0, kappa, h0 = (given[name] for name in ("x0", "y0", "e0", "kappa", "h0"))
    psi = kernel.angle0 + 2 * np.pi * np.arange(kernel.Z) / kernel.Z
    turn = psi[:, None] * np.asarray(kernel.order)
    wave = np.where(np.asarray(kernel.sine) == 1, np.sin(turn), np.cos(turn))
    axial = np.asarray(kernel.axial) == 1
    # rows (Z, 2, n): radial and axial displacement of the grooves at each ball
    N = np.stack([np.where(axial, 0.0, wave), np.where(axial, wave, 0.0)], axis=1)
    d = N @ z
    Y, X = y0 + d[:, 0], x0 + d[:, 1]
    s = np.sqrt(X * X + Y * Y)
    u = (e0 + 2 * x0 * d[:, 1] + d[:, 1] ** 2 + 2 * y0 * d[:, 0] + d[:, 0] ** 2) / (s + kernel.A) + h0
    on = u.real > 0 if carrying is None else np.asarray(carrying, dtype=bool)
    N, Y, X, s, w = N[on], Y[on], X[on], s[on], u[on]
    root = np.sqrt(w)
    for _ in range(60 if kernel.give else 0):
        miss = root**2 + kernel.give * kappa * root**3 - w
        root = root - miss / (2 * root + 3 * kernel.give * kappa * root**2)
    F = kappa * root**3
    k = 1.5 * kappa * root / (1 + 1.5 * kernel.give * kappa * root)
    n = np.stack([Y / s, X / s], axis=1)
    along = np.einsum("za,zan->zn", n, N)
    across = np.einsum("zan,zam->znm", N, N) - along[:, :, None] * along[:, None, :]
    K = np.einsum("z,zn,zm->nm", k, along, along) + np.einsum("z,znm->nm", F / s, across)
    c = kernel.damping_c * (k if kernel.damping_law == "load" else np.ones_like(k))
    return Tangent(F @ along, K, np.einsum("z,zn,zm->nm", c, along, along), u)


def grazing(kernel: BearingKernel, z: Array) -> Index:
    """Balls (k,) in grazing contact: the tangent stiffness has two slopes there, one of them infinite."""
    u = tangent(kernel, z).approach.real
    return np.asarray(np.flatnonzero(np.abs(u) <= GRAZING * np.abs(u).max(initial=0.0)), dtype=np.intp)
