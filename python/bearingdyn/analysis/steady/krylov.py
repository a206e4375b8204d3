"""Linear solves of the balance: generalised minimal residuals on vectors of real numbers."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from bearingdyn.types import Array

# below this share of the right-hand side a residual of an inexact Newton step is of no more use
LARGEST_SPACE = 150


def gmres(
    product: Callable[[Array], Array], right: Array, tolerance: float, most: int = LARGEST_SPACE
) -> tuple[Array, float]:
    """GMRES in a Krylov space: x with A x ≈ right, from zero, and what is left of `right`, relative.

    Parameters
    ----------
    product
        A times a vector (n,).
    right
        (n,).
    tolerance
        Of the residual, relative to the right-hand side.
    most
        Vectors kept; it does not restart.

    References
    ----------
    Y. Saad and M. H. Schultz, SIAM J. Sci. Stat. Comput. 7 (1986) 856.
    """
    size = float(np.linalg.norm(right))
    if not size > 0.0:
        return np.zeros_like(right), 0.0
    most = min(most, right.size)
    V = np.zeros((most + 1, right.size))
    H = np.zeros((most + 1, most))
    V[0] = right / size
    turns = np.zeros((most, 2))
    g = np.zeros(most + 1)
    g[0] = size
    k = 0
    while k < most:
        w = product(V[k])
        # twice is enough (Kahan): the basis stays orthogonal to round-off
        for _ in range(2):
            part = V[: k + 1] @ w
            w = w - part @ V[: k + 1]
            H[: k + 1, k] += part
        beyond = float(np.linalg.norm(w))
        for j in range(k):
            c, s = turns[j]
            a, b = H[j, k], H[j + 1, k]
            H[j, k], H[j + 1, k] = c * a + s * b, c * b - s * a
        radius = float(np.hypot(H[k, k], beyond))
        c, s = (H[k, k] / radius, beyond / radius) if radius > 0.0 else (1.0, 0.0)
        turns[k] = c, s
        H[k, k] = radius
        g[k], g[k + 1] = c * g[k], -s * g[k]
        k += 1
        if abs(g[k]) <= tolerance * size or not beyond > 0.0:
            break
        V[k] = w / beyond
    y = np.zeros(k)
    for j in reversed(range(k)):
        y[j] = (g[j] - H[j, j + 1 : k] @ y[j + 1 :]) / H[j, j] if H[j, j] != 0.0 else 0.0
    return np.asarray(y @ V[:k]), abs(float(g[k])) / size
