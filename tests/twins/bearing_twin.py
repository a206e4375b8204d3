"""The contact kernels in plain NumPy: the specification of csrc/ehl.c and csrc/bearing.c.

Slow and literal, and complex-safe: coefficients may be complex, so that a complex step differentiates the
force. Every branch looks at real parts only.
"""

from __future__ import annotations

from typing import Any

import numpy as np


def contact_damping(spec: Any, delta: Any, s: Any) -> tuple[Any, Any]:
    """c and dc/dδ of one contact in touch (s = δ + h0 > 0)."""
    if spec.damping_law == "constant":
        return spec.damping_c, 0.0
    if spec.damping_law == "load":
        root = np.sqrt(s)
        return spec.damping_c * 1.5 * spec.kappa * root, spec.damping_c * 0.75 * spec.kappa / root
    table = np.asarray(spec.damping_table)
    x, c = table[:, 0], table[:, 1]
    i = int(np.searchsorted(x, np.real(delta), side="left")) - 1
    if i < 0:
        return c[0], 0.0
    if i >= len(x) - 1:
        return c[-1], 0.0
    slope = (c[i + 1] - c[i]) / (x[i + 1] - x[i])
    return c[i] + slope * (delta - x[i]), slope


def contact_force(spec: Any, delta: Any, rate: Any) -> tuple[Any, Any, Any]:
    """F = κ(δ+h0)^1.5 + c(δ) δ̇, never tensile, with dF/dδ and dF/dδ̇ (paper eq. 1, clipped)."""
    s = delta + spec.h0
    if not np.real(s) > 0:
        return 0.0, 0.0, 0.0
    c, slope = contact_damping(spec, delta, s)
    F = spec.kappa * s * np.sqrt(s) + c * rate
    if not np.real(F) > 0:
        return 0.0, 0.0, 0.0
    return F, 1.5 * spec.kappa * np.sqrt(s) + slope * rate, c


def bearing_force(
    spec: Any, z: Any, zdot: Any, angle: float, cage_speed: float
) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """g (n,), K = ∂g/∂z (n, n), C = ∂g/∂ż (n, n) and ball loads (Z,); paper eqs. (1), (3)."""
    z, zdot = np.asarray(z), np.asarray(zdot)
    kind = np.result_type(z, zdot, np.float64)
    n = len(spec.order)
    g, K, C = np.zeros(n, kind), np.zeros((n, n), kind), np.zeros((n, n), kind)
    loads = np.zeros(spec.Z, kind)
    axial = np.asarray(spec.axial, bool)
    for j in range(spec.Z):
        psi = angle + 2 * np.pi * j / spec.Z
        m = np.asarray(spec.order)
        phi = np.where(spec.sine, np.sin(m * psi), np.cos(m * psi))
        dphi = np.where(spec.sine, m * np.cos(m * psi), -m * np.sin(m * psi))
        rate = phi * zdot + cage_speed * dphi * z
        dX, dY = (phi * z)[axial].sum(), (phi * z)[~axial].sum()
        Xdot, Ydot = rate[axial].sum(), rate[~axial].sum()
        X, Y = spec.x0 + dX, spec.y0 + dY
        L = np.sqrt(X * X + Y * Y)
        # Λ − A without cancellation
        delta = (dX * (2 * spec.x0 + dX) + dY * (2 * spec.y0 + dY) + spec.e0) / (L + spec.A)
        if not np.real(delta + spec.h0) > 0:
            continue
        sin, cos = X / L, Y / L
        F, dF, c = contact_force(spec, delta, sin * Xdot + cos * Ydot)
        v, dv = np.where(axial, sin, cos) * phi, np.where(axial, sin, cos) * dphi
        w = np.where(axial, cos, -sin) * phi
        p = w * (cos * Xdot - sin * Ydot) / L + cage_speed * dv
        loads[j] = F
        g += F * v
        K += dF * np.outer(v, v) + F / L * np.outer(w, w) + c * np.outer(v, p)
        C += c * np.outer(v, v)
    return g, K, C, loads
