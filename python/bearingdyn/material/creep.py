"""Creep compliance of a generalised Maxwell model, exact, by the partial fractions of 1/G*.

With s = iω, G(s) = G0 + η0 s + Σ G_i s τ_i/(1 + s τ_i) has its zeros on the negative real axis, one between
any two neighbouring poles −1/τ_i, so 1/(s G(s)) is a sum of simple fractions and J(t) one of exponentials.
Reference: N.W. Tschoegl, The Phenomenological Theory of Linear Viscoelastic Behavior, Springer 1989, ch. 3.
"""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import scipy
from numpy.typing import ArrayLike

from bearingdyn.types import Array

_EDGE = 1e-12  # of an interval between two poles, which brackets the zero from inside


def creep_compliance(G0: float, G: Array, tau: Array, eta0: float, t: ArrayLike) -> Array:
    """Creep compliance J(t), 1/Pa, of spring G0, branches (G, tau) and dashpot eta0 in parallel; t ≥ 0 s."""
    t = np.asarray(t, dtype=np.float64)
    if not np.all(t >= 0):
        raise ValueError("t: a creep compliance exists for times t >= 0 s only")
    # equal times are one branch, a branch without strength is none
    rates, place = np.unique(1 / tau[G > 0], return_inverse=True)
    strengths = np.bincount(place.reshape(-1), G[G > 0], rates.size).astype(np.float64)
    J = np.zeros(t.shape)
    if G0 > 0:
        J += 1 / G0
    else:  # a double pole at s = 0; viscosity Σ G τ + η0
        viscosity = eta0 + float(np.sum(strengths / rates))
        J += t / viscosity + float(np.sum(strengths / rates**2)) / viscosity**2
    for r in _zeros(G0, eta0, rates, strengths):  # residue of e^{st}/(s G) at s = −r
        slope = eta0 + float(np.sum(strengths * rates / (rates - r) ** 2))
        J -= np.exp(-r * t) / (r * slope)
    return np.asarray(J)


def _zeros(G0: float, eta0: float, rates: Array, strengths: Array) -> list[float]:
    """Rates r > 0 with G(s = −r) = 0, rising."""

    def modulus(r: float) -> float:
        return float(G0 - eta0 * r - np.sum(strengths * r / (rates - r)))

    edges = rates.tolist()
    brackets = list(pairwise(edges))
    if G0 > 0 and edges:
        brackets.insert(0, (0.0, edges[0]))
    if eta0 > 0 and (edges or G0 > 0):  # beyond the last pole G falls from +∞ (or G0) to −∞
        low = edges[-1] if edges else 0.0
        # there G(−r) < G0 + 2 ΣG − η0 r for r > 2 low
        high = 2 * low + 2 * (G0 + 2 * float(strengths.sum())) / eta0
        brackets.append((low, high))
    found = []
    for low, high in brackets:
        a, b = low + _EDGE * (high - low), high - _EDGE * (high - low)
        if modulus(a) > 0 > modulus(b):
            found.append(float(scipy.optimize.brentq(modulus, a, b, xtol=1e-300, rtol=1e-14, maxiter=1000)))
        else:  # a branch so weak that pole and zero cancel to the edge
            found.append(a if modulus(a) <= 0 else b)
    return found
