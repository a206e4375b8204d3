"""The half-space order by order: what Hertz's contact has already of the give of a race along its azimuth.

A load that varies as cos ky along a half-space, and across it by a profile q(x) of unit integral, sinks it,
on the average weighted by q, by C(k) = (1 − ν²)/(πE) ∫ |q̂(κ)|²/√(κ² + k²) dκ for a unit load per length (the
surface flexibility 2(1 − ν²)/E|k| of Boussinesq in wave numbers). A ball's load on a race of radius R is the
sum of all k. Order n has those of k R in n − ½ … n + ½: their sum is the half-space, and at high n each is
that of the race.
"""

from __future__ import annotations

import numpy as np

from bearingdyn.material import Elastic
from bearingdyn.types import Array

_SPAN = (1e-3, 400.0)  # κR from, κa to: q̂² falls as κ⁻⁴, and what lies below is taken in closed form
_POINTS = 4000


def footprint_profile(x: Array) -> Array:
    """Load on the half-space across the rolling direction: Hertz's pressure summed along it, ¾(1 − x²).

    Parameters
    ----------
    x
        Place from the middle of the contact ellipse, in half-lengths of it.

    Returns
    -------
    Array
        Of unit integral over −1…1.
    """
    return np.asarray(0.75 * np.maximum(1.0 - x * x, 0.0))


def _transform(x: Array) -> Array:
    """Fourier transform of footprint_profile at κa = x: 3(sin x − x cos x)/x³."""
    small = np.abs(x) < 1e-2
    y = np.where(small, 1.0, x)
    return np.where(small, 1.0 - x * x / 10, 3.0 * (np.sin(y) - y * np.cos(y)) / y**3)


def half_space_orders(count: int, half_length: float, radius: float, ring: Elastic) -> Array:
    """Compliance of the half-space in orders 0 to count − 1, m/N, of a unit load on each coefficient.

    Parameters
    ----------
    count
        Number of orders.
    half_length
        Semi-axis of the contact ellipse across the rolling direction, m.
    radius
        Of the race, m.
    ring
        Material.

    Returns
    -------
    Array
        (count,), m/N.

    References
    ----------
    Johnson, Contact Mechanics (1985), §3.2 and appendix 3.
    """
    t = np.linspace(np.log(_SPAN[0] / radius), np.log(_SPAN[1] / half_length), _POINTS)
    kappa = np.exp(t)
    weight = _transform(kappa * half_length) ** 2 * kappa
    edges = np.concatenate([[0.0], (np.arange(count) + 0.5) / radius])
    # ∫₀^K dk/√(κ² + k²) = asinh(K/κ)
    upto = np.asarray(np.trapezoid(weight * np.arcsinh(edges[:, None] / kappa), t, axis=1))
    lowest = kappa[0]
    # ∫₀^κ₀ asinh(K/κ) dκ for K ≫ κ₀
    upto[1:] += lowest * (1.0 + np.log(2.0 * edges[1:] / lowest))
    scale = (1.0 - ring.nu**2) / (np.pi * ring.E)
    return np.asarray(2.0 * scale / np.pi * np.diff(upto))
