"""Sound outside vibrating surfaces at one frequency: the exterior Helmholtz problem, solved directly.

Pressure p and its slope g = ∂p/∂n = −iωρ v on the surface, time as exp(+iωt), obey two equations,

    (½ − K) p = −V g        and        D p = −(½ + K′) g.

Each alone fails at frequencies of the inside. Their sum (½ − K + α D) p = −(V + α(½ + K′)) g with a complex
α does not (Burton and Miller); by Galerkin's method, p linear and g constant on triangles, it gives p. With
a real α = L, the longest side of the box around the surface, it fails only where the inside resonates with
slopes −p/L at its walls: at kL above 2.06, and above a floor at 1.81, as among all insides of one volume the
ball is the lowest (Daners), and none has more than L³, with its image 2 L³. The
reaction ⟨h, p⟩ of one velocity's pressure on another's is then taken from the form

    F(h, g) = −⟨h, V g⟩ + ⟨(½ + K′)h, p_g⟩ + ⟨p_h, (½ + K′)g⟩ + ⟨D p_h, p_g⟩,

which is exact for the exact p and stationary there: its error is the product of the errors of p_h and p_g. It
is symmetric besides, so that reciprocity holds to round-off, and it keeps the small power of quadrupoles at
low frequency, which ⟨h, p⟩ itself loses in the error of p.

References
----------
A. J. Burton, G. F. Miller, Proc. R. Soc. Lond. A 323 (1971) 201.
D. Daners, Math. Ann. 335 (2006) 767.
J.-C. Nédélec, Acoustic and Electromagnetic Equations, Springer 2001.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
import scipy.linalg
import scipy.sparse
from numpy.typing import ArrayLike

from bearingdyn.checks import instance, positive
from bearingdyn.core import helmholtz
from bearingdyn.notice import CoarsePanels, warn
from bearingdyn.pictures import page
from bearingdyn.short_repr import short
from bearingdyn.sound.triangle_surface import TriangleSurface
from bearingdyn.types import Array, Complex

# k L up to which the real factor holds, with room to what the module says: free, and above a floor
SAFE, SAFE_ON_FLOOR = 2.0, 1.75
DENSITY, SOUND_SPEED = 1.204, 343.2  # of air at 20 °C, kg/m³ and m/s
PANELS = 6.0  # in a wavelength, along the longest side of a triangle


@dataclass(frozen=True, eq=False)
class Radiation:
    """Radiation of a surface at one frequency when it moves in given shapes.

    Parameters
    ----------
    surface
        The surface, and its floor.
    shapes
        Outward normal velocity (triangles, n) of each of n shapes.
    frequency
        Hz.
    density, sound_speed
        Of the medium, kg/m³ and m/s.
    pressure
        At the corners, (points, n), Pa for a unit of each shape; time as exp(+iωt).
    impedance
        (n, n) symmetric, N s/m: of shape j's pressure on shape i, ∫ p_j v_i dA.
    """

    surface: TriangleSurface
    shapes: Array
    frequency: float
    density: float
    sound_speed: float
    pressure: Complex
    impedance: Complex

    __repr__ = short
    _repr_html_ = page

    @property
    def wave_number(self) -> float:
        """ω/c, 1/m."""
        return 2.0 * np.pi * self.frequency / self.sound_speed

    @cached_property
    def resistance(self) -> Array:
        """Radiation resistance R = Re Z, (n, n), by which amplitudes v give the power ½ vᴴ R v."""
        return np.asarray(0.5 * (self.impedance.real + self.impedance.real.T))

    def power(self, amplitudes: ArrayLike = (1.0,)) -> float:
        """Sound power of the shapes with zero-to-peak amplitudes (n,), complex, together, W."""
        v = np.asarray(amplitudes)
        return float((0.5 * v.conj() @ self.resistance @ v).real)

    def efficiency(self, amplitudes: ArrayLike = (1.0,)) -> float:
        """Radiation efficiency: the power over ½ ρ c ∫ |v|² dA."""
        v = self.shapes @ np.asarray(amplitudes)
        plane = 0.5 * self.density * self.sound_speed * float(self.surface.areas @ np.abs(v) ** 2)
        return self.power(amplitudes) / plane


def solve(
    surface: TriangleSurface,
    shapes: ArrayLike,
    frequency: float,
    *,
    density: float = DENSITY,
    sound_speed: float = SOUND_SPEED,
    coarse: bool = False,
    below: bool | None = None,
) -> Radiation:
    """Solve the radiation of a surface that moves in given shapes, at one frequency.

    Parameters
    ----------
    surface
        Closed, or open on its floor alone.
    shapes
        Outward normal velocity (triangles, n) of each shape, m/s, real; amplitudes may be complex.
    frequency
        Hz.
    density, sound_speed
        Of the medium, kg/m³ and m/s; those of air at 20 °C.

    coarse
        Whether panels longer than a sixth of the wavelength are meant, and pass without a warning.
    below
        Whether the frequency counts as below all resonances of the inside: the factor of the sum is real
        there. None: below 1/L in wave numbers. Solutions that are interpolated over frequency want one answer
        for all of them, as the errors of the two differ.

    Returns
    -------
    Radiation
        Pressure on the surface, impedance and resistance.

    Raises
    ------
    ValueError
        For a frequency, density or speed of sound that is not positive, and shapes of another number of
        triangles.

    Warns
    -----
    CoarsePanels
        Where a triangle is longer than a sixth of the wavelength.
    """
    instance("surface", surface, TriangleSurface, "it must be a bd.sound.TriangleSurface")
    frequency, density = positive("frequency", frequency), positive("density", density)
    sound_speed = positive("sound_speed", sound_speed)
    B = np.asarray(shapes)
    if B.ndim != 2 or len(B) != len(surface.faces) or B.dtype.kind not in "iuf" or not np.isfinite(B).all():
        raise ValueError(
            f"shapes has shape {B.shape}; it must be ({len(surface.faces)}, n): the normal velocity of each "
            "triangle in m/s, real and finite"
        )
    if not coarse:
        warn_of_coarse_panels(surface, frequency, sound_speed)
    k = 2.0 * np.pi * frequency / sound_speed
    X, F = _pressure(surface, B, k, k * surface.extent <= 1.0 if below is None else below)
    rate = -2j * np.pi * frequency * density  # g = −iωρ v
    return Radiation(surface, B, frequency, density, sound_speed, rate * X, rate * F)


def below_resonances(surface: TriangleSurface, frequency: float, sound_speed: float) -> bool:
    """Whether a radiation at this frequency, Hz, lies safely below all resonances of the inside."""
    safe = SAFE if surface.floor is None else SAFE_ON_FLOOR
    return bool(2.0 * np.pi * frequency / sound_speed * surface.extent <= safe)


def warn_of_coarse_panels(surface: TriangleSurface, frequency: float, sound_speed: float) -> None:
    """Warn where a triangle is too coarse for the radiation: longer than a sixth of the wavelength."""
    wavelength = sound_speed / frequency
    if not surface.size <= wavelength / PANELS * (1.0 + 1e-9):
        warn(
            f"the longest side of a triangle is {1e3 * surface.size:.3g} mm, and a sixth of the wavelength "
            f"at {frequency:.5g} Hz is {1e3 * wavelength / PANELS:.3g} mm; mesh the surface more finely, or "
            f"stay below {sound_speed / (PANELS * surface.size):.4g} Hz",
            CoarsePanels,
        )


def _pressure(surface: TriangleSurface, B: Array, k: float, below: bool) -> tuple[Complex, Complex]:
    """p of unit slopes B at the corners, (points, n), and the form F, (n, n)."""
    V, V1, Kt, K, D = helmholtz(surface.points, surface.faces, k, surface.floor)
    P0, P1 = _masses(surface)
    L = Kt @ B + 0.5 * (P0 @ B)
    # Burton and Miller's factor: its sign keeps the sum well conditioned. Below all resonances it is real,
    # lest errors of p get out of phase and drown the power of quadrupoles, (ka)⁵/27 of what swings to and fro
    alpha = surface.extent if below else -1j / k
    right = -(V1 @ B) - alpha * L
    K *= -1.0
    K += alpha * D + (0.5 * P1).toarray()
    factors = scipy.linalg.lu_factor(K, overwrite_a=True, check_finite=False)
    X = scipy.linalg.lu_solve(factors, right, overwrite_b=True, check_finite=False)
    cross = L.T @ X
    return X, -(B.T @ (V @ B)) + cross + cross.T + X.T @ (D @ X)


def _masses(surface: TriangleSurface) -> tuple[scipy.sparse.csr_matrix, scipy.sparse.csr_matrix]:
    """⟨φ_a, 1_t⟩ (points, triangles) and ⟨φ_a, φ_b⟩ (points, points)."""
    faces, A = surface.faces, surface.areas
    n, m = len(surface.points), len(faces)
    P0 = scipy.sparse.csr_matrix((np.repeat(A / 3.0, 3), (faces.ravel(), np.repeat(np.arange(m), 3))), (n, m))
    pairs = (np.repeat(faces, 3, axis=1).ravel(), np.tile(faces, 3).ravel())
    weight = A[:, None] / 12.0 * (1.0 + np.eye(3).ravel())
    return P0, scipy.sparse.csr_matrix((weight.ravel(), pairs), (n, n))


def radiated_power(
    points: ArrayLike,
    faces: ArrayLike,
    velocity: ArrayLike,
    frequency: float,
    *,
    density: float = DENSITY,
    sound_speed: float = SOUND_SPEED,
    floor: float | None = None,
) -> float:
    """Power of the radiation of a closed surface of triangles that vibrates at one frequency.

    Parameters
    ----------
    points, faces
        Corners (n, 3), m, and triangles (m, 3), anticlockwise seen from outside.
    velocity
        Outward normal velocity (m,) of the triangles, complex, zero-to-peak, m/s.
    frequency
        Hz.
    density, sound_speed
        Of the medium, kg/m³ and m/s; those of air at 20 °C.
    floor
        Height y, m, of a rigid floor; None: free field.

    Returns
    -------
    float
        Mean power over a period, W.

    Raises
    ------
    ValueError
        As `TriangleSurface` and `solve` do.

    Warns
    -----
    CoarsePanels
        Where a triangle is longer than a sixth of the wavelength.
    """
    surface, kept = closed_surface(points, faces, floor)
    v = np.asarray(velocity)
    if v.ndim != 1 or v.shape != kept.shape:
        raise ValueError(
            f"velocity has shape {v.shape}; it must be ({kept.size},), one for each of the faces"
        )
    both = np.stack([v[kept].real, v[kept].imag], axis=1)
    return solve(surface, both, frequency, density=density, sound_speed=sound_speed).power([1.0, 1j])


def closed_surface(
    points: ArrayLike, faces: ArrayLike, floor: float | None = None
) -> tuple[TriangleSurface, Array]:
    """Surface for a radiation, checked, and which faces it has kept: those on the floor radiate nothing."""
    surface = TriangleSurface(np.asarray(points), np.asarray(faces), floor)
    if surface.floor is None:
        return surface, np.ones(len(np.asarray(faces)), dtype=bool)
    y = np.asarray(points)[np.asarray(faces), 1]
    tiny = 2e-9 * float(np.ptp(np.asarray(points), axis=0).max())
    return surface, np.asarray(~(np.abs(y - surface.floor) <= tiny).all(axis=1))
