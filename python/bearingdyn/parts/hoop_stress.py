"""The hoop stress of a body of revolution along a circle on its surface, by its coordinates."""

from __future__ import annotations

import numpy as np

from bearingdyn.material import Elastic
from bearingdyn.parts.revolved_strain import Placed
from bearingdyn.types import Array


def hoop_stress_rows(
    placed: Placed, n: int, material: Elastic, r: float, z: tuple[float, float], azimuth: Array
) -> Array:
    """Stress along the circle, (azimuths, n), Pa by unit coordinates, by the strains of the surface alone.

    σ = E/(1 − ν²) (ε_φ + ν ε_z), of a surface that little presses on; a pressure p adds −ν/(1 − ν) p.

    Parameters
    ----------
    placed, n
        Families of shapes with their coordinates, and how many coordinates there are.
    r
        Of the surface, m.
    z
        Two places on it, m, between which it is stretched by ε_z; their middle is that of the circle.
    azimuth
        (p,), rad.
    """
    E, nu = material.E, material.nu
    rows = np.zeros((azimuth.size, n))
    for h, Psi, places in placed:
        whole, order = h.complete(Psi.copy()), h.order
        # at φ = 0 the cosine family moves along x and z, the turned one along −y
        ends = [h.point_rows(r, at, 0.0, whole) for at in z]
        across = [h.point_rows(r, at, 0.0, whole, sine=True)[1] if order else 0.0 for at in z]
        radial, slip = 0.5 * (ends[0][0] + ends[1][0]), -0.5 * (across[0] + across[1])
        hoop = (radial + order * slip) / r
        axial = (ends[1][2] - ends[0][2]) / (z[1] - z[0])
        stress = E / (1 - nu**2) * (hoop + nu * axial)
        for copy, (index, sign) in enumerate(places):
            wave = np.sin(order * azimuth) if copy else np.cos(order * azimuth)
            rows[:, index] += np.outer(wave, sign * stress)
    return rows
