"""The contact kernels in plain NumPy: the specification of csrc/ehl.c, csrc/balls.c and csrc/imperfection.c.

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
        root, give = solid_root(spec, s), spec.give
        firm = 1.5 * spec.kappa * root / (1 + 1.5 * give * spec.kappa * root)
        # d²F/ds² of s = u² + give κ u³, F = κ u³
        bend = 0.75 * spec.kappa / root / (1 + 1.5 * give * spec.kappa * root) ** 3
        return spec.damping_c * firm, spec.damping_c * bend
    if spec.damping_law == "film":
        root = solid_root(spec, s)
        c, by_root = film_curve(spec, root)
        return c, by_root / (2 * root + 3 * spec.give * spec.kappa * root**2)
    table = np.asarray(spec.damping_table)
    x, c = table[:, 0], table[:, 1]
    i = int(np.searchsorted(x, np.real(delta), side="left")) - 1
    if i < 0:
        return c[0], 0.0
    if i >= len(x) - 1:
        return c[-1], 0.0
    slope = (c[i + 1] - c[i]) / (x[i + 1] - x[i])
    return c[i] + slope * (delta - x[i]), slope


def film_curve(spec: Any, root: Any) -> tuple[Any, Any]:
    """The table over w = root/(root + √scale), by Hermite's basis, and its derivative by the root."""
    half = np.sqrt(spec.damping_c)
    at, rise = np.asarray(spec.damping_table).T
    cells = len(at) - 1
    x = cells * root / (root + half)
    i = min(int(np.real(x)), cells - 1)
    u = x - i
    value = (
        at[i] * (1 + 2 * u) * (1 - u) ** 2
        + at[i + 1] * u**2 * (3 - 2 * u)
        + rise[i] * u * (1 - u) ** 2
        - rise[i + 1] * u**2 * (1 - u)
    )
    by_u = 6 * u * (1 - u) * (at[i + 1] - at[i])
    by_u += rise[i] * (1 - u) * (1 - 3 * u) + rise[i + 1] * u * (3 * u - 2)
    return value, by_u * cells * half / (root + half) ** 2


def film_value(spec: Any, s: Any) -> Any:
    """b of a film that is carried, s, at s = δ + h0 > 0."""
    return film_curve(spec, np.sqrt(s))[0]


def carried_force(spec: Any, s: Any, rate: Any) -> tuple[Any, Any, Any]:
    """F = κ u³, u² + give κ u³ = s + b δ̇, of rates that have been so for long, and its derivatives."""
    b, by_root = film_curve(spec, np.sqrt(s)) if np.real(s) > 0 else (0.0, 0.0)
    both = s + b * rate
    if not np.real(both) > 0:
        return 0.0, 0.0, 0.0
    u = solid_root(spec, both)
    firm = 1.5 * spec.kappa * u / (1 + 1.5 * spec.give * spec.kappa * u)
    bend = by_root / (2 * np.sqrt(s)) if np.real(s) > 0 else 0.0
    return spec.kappa * u**3, firm * (1 + bend * rate), firm * b


def solid_root(spec: Any, s: Any) -> Any:
    """Root u of what film and solids are compressed by: u² + give κ u³ = s."""
    u = np.sqrt(s)
    for _ in range(8 if spec.give else 0):
        u = u - (u**2 + spec.give * spec.kappa * u**3 - s) / (2 * u + 3 * spec.give * spec.kappa * u**2)
    return u


def contact_force(spec: Any, delta: Any, rate: Any) -> tuple[Any, Any, Any]:
    """F = κ(δ+h0−give F_e)^1.5 + c(δ) δ̇, never tensile, with dF/dδ and dF/dδ̇ (paper eq. 1, clipped)."""
    s = delta + spec.h0
    if spec.damping_law == "carried":
        return carried_force(spec, s, rate)
    if not np.real(s) > 0:
        return 0.0, 0.0, 0.0
    c, slope = contact_damping(spec, delta, s)
    root = solid_root(spec, s)
    F = spec.kappa * root**3 + c * rate
    if not np.real(F) > 0:
        return 0.0, 0.0, 0.0
    return F, 1.5 * spec.kappa * root / (1 + 1.5 * spec.give * spec.kappa * root) + slope * rate, c


def drop(D: float, width: float, depth: float, s: Any) -> Any:
    """How far a ball sinks at arc s from a pit's centre: min(h, D/2 − √(D²/4 − (w/2 − |s|)²))."""
    reach = width / 2 - abs(s)
    if reach <= 0:
        return 0.0
    if reach >= D / 2:
        return min(depth, D / 2)
    # the same as D/2 − √(D²/4 − reach²), which cancels
    return min(depth, reach**2 / (D / 2 + np.sqrt(D**2 / 4 - reach**2)))


def drop_slope(D: float, width: float, depth: float, s: Any) -> Any:
    """∂(drop)/∂s; zero at the bottom and outside."""
    reach = width / 2 - abs(s)
    if not 0 < reach < D / 2 or drop(D, width, depth, s) == depth:
        return 0.0
    return -np.sign(s) * reach / np.sqrt(D**2 / 4 - reach**2)


def wrapped(angle: Any) -> Any:
    """The same angle within ±π."""
    return angle - 2 * np.pi * np.round(angle / (2 * np.pi))


def imperfections(
    spec: Any, psi: Any, ball: int, cage_speed: float, shaft_angle: float, shaft_speed: float
) -> tuple[Any, Any, Any, Any, Any, Any]:
    """Shifts of groove centres X, Y and of the indentation of a ball at ψ, and the rates of the three.

    theory.md §2, Waviness and Defect. A race's wave moves its surface along +r or +z, so the relative motion
    inner minus outer takes the outer's with a minus; a ball's wave stands on both of its sides.
    """
    flaws = spec.imperfections
    dX = dY = d = X_rate = Y_rate = rate = 0.0
    spin, spin_speed = flaws.spin_ratio * shaft_angle, flaws.spin_ratio * shaft_speed
    # each race stands at its own angle and turns at its own speed
    turned = {True: spec.inner_ratio * shaft_angle, False: spec.outer_ratio * shaft_angle}
    past = {
        True: cage_speed - spec.inner_ratio * shaft_speed,
        False: cage_speed - spec.outer_ratio * shaft_speed,
    }
    for kind, order, owner, amplitude, phase in flaws.waves:
        if kind == 4:
            if owner == ball:
                for side in (0.0, np.pi):  # where the inner, and where the outer race touches
                    d += amplitude * np.cos(order * (spin + side) + phase)
                    rate -= amplitude * order * spin_speed * np.sin(order * (spin + side) + phase)
            continue
        inner = kind < 2
        argument = order * (psi - turned[inner]) + phase
        sign = 1.0 if inner else -1.0
        value = sign * amplitude * np.cos(argument)
        slope = -sign * amplitude * order * np.sin(argument)
        speed = past[inner]
        if kind % 2:
            dX, X_rate = dX + value, X_rate + slope * speed
        else:
            dY, Y_rate = dY + value, Y_rate + slope * speed
    for kind, owner, angle, width, depth in flaws.pits:
        D = flaws.ball_diameter
        if kind == 2:
            meetings = [(D / 2, spin - angle + side, spin_speed) for side in (0.0, np.pi) if owner == ball]
        elif kind == 0:
            meetings = [(flaws.inner_radius, psi - turned[True] - angle, past[True])]
        else:
            meetings = [(flaws.outer_radius, psi - turned[False] - angle, past[False])]
        for radius, at, speed in meetings:
            s = radius * wrapped(at)
            d -= drop(D, width, depth, s)
            rate -= drop_slope(D, width, depth, s) * radius * speed
    if len(flaws.oversize):
        d += flaws.oversize[ball]
    return dX, dY, d, X_rate, Y_rate, rate


def bearing_force(
    spec: Any,
    z: Any,
    zdot: Any,
    angle: float,
    cage_speed: float,
    shaft_angle: float = 0.0,
    shaft_speed: float = 0.0,
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
        shift = imperfections(spec, psi, j, cage_speed, shaft_angle, shaft_speed)
        dX, dY = (phi * z)[axial].sum() + shift[0], (phi * z)[~axial].sum() + shift[1]
        Xdot, Ydot = rate[axial].sum() + shift[3], rate[~axial].sum() + shift[4]
        X, Y = spec.x0 + dX, spec.y0 + dY
        L = np.sqrt(X * X + Y * Y)
        # Λ − A without cancellation
        delta = (dX * (2 * spec.x0 + dX) + dY * (2 * spec.y0 + dY) + spec.e0) / (L + spec.A) + shift[2]
        if not np.real(delta + spec.h0) > 0:
            continue
        sin, cos = X / L, Y / L
        F, dF, c = contact_force(spec, delta, sin * Xdot + cos * Ydot + shift[5])
        v, dv = np.where(axial, sin, cos) * phi, np.where(axial, sin, cos) * dphi
        w = np.where(axial, cos, -sin) * phi
        p = w * (cos * Xdot - sin * Ydot) / L + cage_speed * dv
        loads[j] = F
        g += F * v
        K += dF * np.outer(v, v) + F / L * np.outer(w, w) + c * np.outer(v, p)
        C += c * np.outer(v, v)
    return g, K, C, loads
