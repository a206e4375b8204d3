"""Sound power and intensity of spheres (reference page §4.6)."""

from __future__ import annotations

import math

import numpy as np

from bearingdyn.sound import TriangleSurface, panel_forces, radiated_power
from spheres import DENSITY, SPEED, shapes, sphere
from verified.row import Row, rows


def spheres() -> list[Row]:
    """A pulsating and a rigidly oscillating sphere of 50 mm, the latter at the resonance inside too."""
    a = 0.05
    points, faces = sphere(8, a)
    v = shapes(points, faces, radius=a)
    cases = []
    for f in (200.0, 1000.0, 3432.0):
        x = (2 * math.pi * f * a / SPEED) ** 2
        rho_c = DENSITY * SPEED
        for k, name, want in (
            (0, "pulsating", 2 * np.pi * a**2 * rho_c * x / (1 + x)),
            (1, "oscillating", 2 * np.pi / 3 * rho_c * a**2 * x**2 / (4 + x**2)),
        ):
            got = radiated_power(points, faces, v[:, k], f)
            cases.append((f"sphere of 50 mm, {name}, {f:g} Hz, power", want, got))
    return rows("4.6", 2e-3, "512 flat triangles of the sphere's volume", "closed form", cases)


def intensities() -> list[Row]:
    """Sound intensity at the pole of a rigidly oscillating sphere of 50 mm."""
    a = 0.05
    points, faces = sphere(8, a)
    surface, v = TriangleSurface(points, faces), shapes(points, faces, radius=a)[:, 1]
    pole = int(np.argmax(v))
    cases = []
    for f in (200.0, 1000.0, 3432.0):
        x = (2 * math.pi * f * a / SPEED) ** 2
        want = 0.5 * DENSITY * SPEED * v[pole] ** 2 * x**2 / (4 + x**2)
        got = 0.5 * panel_forces(surface, v, f)[pole].real * v[pole] / surface.areas[pole]
        cases.append((f"sphere of 50 mm, oscillating, {f:g} Hz, intensity", float(want), float(got)))
    return rows("4.6", 1e-2, "one of 512 flat triangles", "closed form", cases)
