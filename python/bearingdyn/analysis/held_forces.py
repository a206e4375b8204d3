"""The bearing forces of an exact step: polynomials in time, integrated exactly, and how stable that is.

They are of order h through the new one, s = 1, and those at the last steps' ends, s = 0, −1 … 1 − h, on the
first steps of the order that these allow; with φ_(k+1)(z) k! = ∫₀¹ exp(z(1 − s)) sᵏ ds a mode's share of them
is exact. The cubic is tilted by −19/60 (½ − s) times its third difference, which leaves the impulse of a step
as it is: Adams and Moulton's formula of that order misses the impulse by 19/720 of the fourth difference, and
the tilt moves a free mass by as much as that sums up to, so that its displacement is of fifth order. What
balls alone hold then grows only from ωΔt = 2.3 on, and on the plain cubic at any ωΔt.
"""

from __future__ import annotations

import math

import numpy as np

from bearingdyn.types import Array, Complex

TERMS = 26  # of Taylor's series within the unit circle
TILT = -19 / 60  # of a cubic, in its third difference a step
SLOWEST = 1e-3  # rad a step of a mode's own, below which its growth is that of one that balls alone hold


def phi(z: Complex, last: int) -> list[Complex]:
    """φ functions of the exact step, φ_0 … φ_last of z: exp(z), and φ_(k+1) = (φ_k − 1/k!)/z."""
    z = np.asarray(z, dtype=np.complex128)
    small = np.abs(z) < 1
    inner, outer = np.where(small, z, 0), np.where(small, 1, z)
    found = [np.exp(z)]
    far = np.exp(outer)
    for k in range(last):
        far = (far - 1 / math.factorial(k)) / outer
        near = sum(inner**n / math.factorial(n + k + 1) for n in range(TERMS, -1, -1))
        found.append(np.where(small, near, far))
    return found


def rows_of(order: int) -> slice:
    """Rows of weights of the forces at s = 1, 0 … on a polynomial of an order."""
    first = order * (order + 1) // 2
    return slice(first, first + order + 1)


def weights_of(roots: Complex, dt: float, hold: int, ahead: int) -> Complex:
    """Factors (k, j) of q, then by order of the forces at s = 1, 0 …; integrated `ahead` times more."""
    p = phi(roots * dt, hold + 1 + ahead)
    # of sᵏ; k! from the φ function that is its integral
    powers = np.array([math.factorial(k) * p[k + 1 + ahead] for k in range(hold + 1)])
    rows = [p[ahead] * dt**ahead]
    for order in range(1, hold + 1):
        nodes = 1.0 - np.arange(order + 1)
        # column k of the inverse holds the powers of the polynomial that is 1 at node k and 0 at the others
        lagrange = np.linalg.inv(np.vander(nodes, increasing=True))
        if order == 3:
            lagrange[:2] += TILT * np.outer([0.5, -1.0], [1.0, -3.0, 3.0, -1.0])
        rows.extend(dt ** (1 + ahead) * (lagrange.T @ powers[: order + 1]))
    return np.array(rows)


def held_growth(turns: Array, shares: Array, hold: int) -> Array:
    """Growth of modes in a step, (n,), as ln of its factor, where balls hold a share and damping takes none.

    The largest root of the step's own recurrence, in displacement, velocity and the forces so far.

    Parameters
    ----------
    turns
        Frequency times step, ωΔt (n,), rad.
    shares
        Part of the stiffness, 0 … 1, that balls hold (n,).
    hold
        Order of the polynomial that their forces are held by.
    """
    n = len(turns)
    own = np.maximum(turns * np.sqrt(np.maximum(1.0 - shares, 0.0)), SLOWEST)
    moved = weights_of(1j * own, 1.0, hold, 0)[rows_of(hold)]
    new = np.tile(np.eye(3), (n, 1, 1))
    old = np.zeros((n, 3, 2 + hold))
    new[:, 0, 2], new[:, 1, 2], new[:, 2, 0] = moved[0].imag / own, moved[0].real, -shares * turns**2
    old[:, 0, 0] = old[:, 1, 1] = np.cos(own)
    old[:, 0, 1], old[:, 1, 0] = np.sin(own) / own, -own * np.sin(own)
    old[:, 0, 2:], old[:, 1, 2:] = -(moved[1:].imag / own).T, -moved[1:].real.T
    step = np.zeros((n, 2 + hold, 2 + hold))
    step[:, :3] = np.linalg.solve(new, old)
    step[:, np.arange(3, 2 + hold), np.arange(2, 1 + hold)] = 1.0
    return np.asarray(np.log(np.abs(np.linalg.eigvals(step)).max(axis=1)))
