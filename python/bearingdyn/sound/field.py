"""Sound pressure away from a radiating surface, at points and in directions."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from bearingdyn.checks import instance, positive, real, require, vector, whole
from bearingdyn.plausible_ranges import plausible
from bearingdyn.sound.radiation import Radiation
from bearingdyn.types import Array, Complex

# points on a triangle, degree 4 (Dunavant): barycentric coordinates and weights
_A, _B = 0.445948490915965, 0.091576213509771
_PHI = np.array([[1 - 2 * a if i == j else a for j in range(3)] for a in (_A, _B) for i in range(3)])
_WEIGHT = np.repeat([0.223381589678011, 0.109951743655322], 3)
GIVE = "give what bd.sound.solve returns"
CHUNK = 2_000_000  # distances at a time: 16 MB


def pressure_at(radiation: Radiation, points: ArrayLike) -> Complex:
    """Sound field outside a surface: pressure at points, of a unit of each shape.

    Parameters
    ----------
    radiation
        The solution on the surface.
    points
        (p, 3), m.

    Returns
    -------
    numpy.ndarray
        (p, n) complex, zero-to-peak, Pa; time as exp(+iωt).

    Raises
    ------
    ValueError
        For a point nearer to a triangle than that is long, where the field is known no better than the
        surface, or one below the floor.
    """
    instance("radiation", radiation, Radiation, GIVE)
    x = _places("points", points)
    surface = radiation.surface
    floor = surface.floor
    if floor is not None and not bool((x[:, 1] >= floor).all()):
        low = x[np.argmin(x[:, 1])].tolist()
        raise ValueError(f"points has {low}; it must lie above the floor at y = {floor} m")
    for place in x:
        near = np.linalg.norm(surface.middles - place, axis=1)
        if not near.min() >= surface.size:
            raise ValueError(
                f"points has {place.tolist()}, {near.min():.3g} m from the surface; it must lie at least a "
                f"triangle's length, {surface.size:.3g} m, away"
            )
    found = _potentials(radiation, x)
    if floor is not None:  # the image of the source seen from x is the source seen from the image of x
        found = found + _potentials(radiation, x * [1.0, -1.0, 1.0] + [0.0, 2.0 * floor, 0.0])
    return found


def _potentials(radiation: Radiation, x: Array) -> Complex:
    """∫ (p ∂G/∂n − G ∂p/∂n) dA at the points x."""
    y, weight, pressure, slope = _sources(radiation)
    normal = np.repeat(radiation.surface.normals, len(_WEIGHT), axis=0)
    k = radiation.wave_number
    found = np.empty((len(x), pressure.shape[1]), dtype=np.complex128)
    step = max(1, CHUNK // len(y))
    for at in range(0, len(x), step):
        d = y[None] - x[at : at + step, None]
        r = np.linalg.norm(d, axis=2)
        G = weight * np.exp(-1j * k * r) / (4.0 * np.pi * r)
        along = np.einsum("xqi,qi->xq", d, normal) / r
        found[at : at + step] = (-(1.0 / r + 1j * k) * along * G) @ pressure - G @ slope
    return found


def _sources(radiation: Radiation) -> tuple[Array, Array, Complex, Complex]:
    """Positions (q, 3) on the surface, weights (q,), pressures and their slopes (q, n)."""
    surface = radiation.surface
    corners = surface.points[surface.faces]
    y = np.einsum("qa,tai->tqi", _PHI, corners).reshape(-1, 3)
    weight = (surface.areas[:, None] * _WEIGHT).ravel()
    p = np.einsum("qa,tan->tqn", _PHI, radiation.pressure[surface.faces])
    slope = -2j * np.pi * radiation.frequency * radiation.density * radiation.shapes
    return y, weight, p.reshape(len(y), -1), np.repeat(slope, len(_WEIGHT), axis=0)


def far_field(radiation: Radiation, directions: ArrayLike) -> Complex:
    """Amplitude of the far sound field: p = far_field · exp(−ikr)/r at a large distance r.

    Parameters
    ----------
    radiation
        The solution on the surface.
    directions
        (d, 3), of unit length; above a floor that of the floor's own half of space.

    Returns
    -------
    numpy.ndarray
        (d, n) complex, Pa m for a unit of each shape.

    Raises
    ------
    ValueError
        For directions that are not of unit length.
    """
    instance("radiation", radiation, Radiation, GIVE)
    u = _places("directions", directions)
    if not bool(np.allclose(np.linalg.norm(u, axis=1), 1.0, rtol=0.0, atol=1e-6)):
        raise ValueError("directions has a vector that is not of unit length; divide each by its length")
    y, weight, pressure, slope = _sources(radiation)
    normal = np.repeat(radiation.surface.normals, len(_WEIGHT), axis=0)
    k = radiation.wave_number

    def half(u: Array, shift: Array | float) -> Complex:
        wave = weight * np.exp(1j * k * (u @ y.T + shift)) / (4.0 * np.pi)
        found: Complex = (1j * k * (u @ normal.T) * wave) @ pressure - wave @ slope
        return found

    floor = radiation.surface.floor
    total = half(u, 0.0)
    if floor is not None:
        total = total + half(u * [1.0, -1.0, 1.0], 2.0 * floor * u[:, 1:2])
    return total


def far_power(radiation: Radiation, amplitudes: ArrayLike = (1.0,), order: int = 24) -> float:
    """Power of the sound field through a sphere, or above a floor half a sphere, far away, W.

    Parameters
    ----------
    radiation
        The solution on the surface.
    amplitudes
        Of the shapes (n,), complex, zero-to-peak.
    order
        Points along the polar angle; twice as many lie along the azimuth.

    Returns
    -------
    float
        ∮ |p|² / 2ρc, W, which is the power that leaves the surface.
    """
    from numpy.polynomial.legendre import leggauss

    instance("radiation", radiation, Radiation, GIVE)
    z, w = leggauss(whole("order", order, 1))
    half = radiation.surface.floor is not None
    if half:
        z, w = 0.5 * (z + 1.0), 0.5 * w
    phi = np.arange(2 * order) * np.pi / order
    r = np.sqrt(1.0 - z**2)
    u = np.stack(
        [np.outer(r, np.sin(phi)), np.repeat(z[:, None], phi.size, axis=1), np.outer(r, np.cos(phi))], axis=-1
    )
    p = far_field(radiation, u.reshape(-1, 3)) @ np.asarray(amplitudes)
    intensity = np.abs(p.reshape(order, -1)) ** 2 / (2.0 * radiation.density * radiation.sound_speed)
    return float(w @ intensity.sum(axis=1) * np.pi / order)


# ISO 3744:2010, table B.1: the ten key positions on a hemisphere of radius 1, the last coordinate upwards
HEMISPHERE = (
    *((-0.99, 0.0, 0.15), (0.50, -0.86, 0.15), (0.50, 0.86, 0.15), (-0.45, 0.77, 0.45), (-0.45, -0.77, 0.45)),
    *((0.89, 0.0, 0.45), (0.33, 0.57, 0.75), (-0.66, 0.0, 0.75), (0.33, -0.57, 0.75), (0.0, 0.0, 1.0)),
)


def hemisphere_positions(radius: float, centre: ArrayLike = (0.0, 0.0, 0.0)) -> tuple[Array, float]:
    """Sound field on a hemisphere: the ten microphone positions of ISO 3744 above a floor, and its area.

    Parameters
    ----------
    radius
        m; at least twice the source's characteristic distance, and 1 m.
    centre
        (3,), m, on the floor; y points upwards.

    Returns
    -------
    tuple
        Positions (10, 3), m, and area 2πr², m².

    References
    ----------
    ISO 3744:2010, annex B.
    """
    radius = positive("radius", radius, "it must be a positive radius in m")
    plausible("microphone", "radius", radius)
    at = vector("centre", centre, (3,), "x, y and z in m")
    key = np.array(HEMISPHERE)
    key /= np.linalg.norm(key, axis=1)[:, None]  # the table's two digits lie up to .5 % off the sphere
    return at + radius * key[:, [0, 2, 1]] * [1.0, 1.0, -1.0], 2.0 * np.pi * radius**2


def box_positions(low: ArrayLike, high: ArrayLike, distance: float = 1.0) -> tuple[Array, float]:
    """Sound field on a box: the nine microphone positions of ISO 3744 around a machine, and its area.

    Parameters
    ----------
    low, high
        Opposite corners (3,), m, of the smallest box around the machine; it stands on the floor y = low[1].
    distance
        Between that box and the microphones', m.

    Returns
    -------
    tuple
        Positions (9, 3), m: four at half the height before the sides, four above the corners and one on top;
        and the area 4(ab + bc + ca), m².

    References
    ----------
    ISO 3744:2010, annex C.
    """
    a0, a1 = vector("low", low, (3,), "x, y and z in m"), vector("high", high, (3,), "x, y and z in m")
    require(bool((a1 > a0).all()), "high", a1.tolist(), f"it must exceed low, {a0.tolist()}, in x, y and z")
    d = positive("distance", distance, "it must be a positive distance in m")
    plausible("microphone", "distance", d)
    plausible("machine", "the side from low to high", float((a1 - a0).max()))
    a, b = 0.5 * (a1[0] - a0[0]) + d, 0.5 * (a1[2] - a0[2]) + d
    c = float(a1[1] - a0[1]) + d
    middle = np.array([0.5 * (a0[0] + a1[0]), a0[1], 0.5 * (a0[2] + a1[2])])
    sides = [(a, c / 2, 0), (0, c / 2, b), (-a, c / 2, 0), (0, c / 2, -b)]
    corners = [(a, c, b), (-a, c, b), (-a, c, -b), (a, c, -b), (0, c, 0)]
    return middle + np.array(sides + corners, dtype=np.float64), 4.0 * (a * b + b * c + c * a)


def _places(field: str, given: ArrayLike) -> Array:
    remedy = "it must be (n, 3), finite"
    try:
        x = real(given)
    except (TypeError, ValueError):
        raise ValueError(f"{field} is {given!r}; {remedy}") from None
    if x.ndim != 2 or x.shape[1] != 3 or not np.isfinite(x).all():
        raise ValueError(f"{field} has shape {x.shape}; {remedy}")
    return x
