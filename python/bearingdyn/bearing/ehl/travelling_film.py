"""The answer of a contact whose film is formed at the inlet and carried through at the speed um.

K̂/K_H = 1 + (A + iΩB) S(Ω), S = ½∫₋₁¹ J0(Ωs) e^{−iΩs} dy with s = √(1 − y²): each strip of the contact keeps
the film that the inlet made when it passed there. A and B follow from the stiffness and damping at low
frequency, A = K0/K_H − 1, B = C0/1.5 + Aπ/4.
"""

from __future__ import annotations

import math
from functools import cache
from typing import Any

import numpy as np
import scipy

from bearingdyn.types import Array, Complex

_LAST = 16.0  # ωa/um, beyond which the integral is formed anew; a motor's kHz stay below


@cache
def _strips() -> tuple[Array, Array]:
    """s and weights of ½∫₋₁¹ dy = ½∫₀^π sinφ dφ, s = sinφ."""
    nodes, weights = np.polynomial.legendre.leggauss(40)
    phi = math.pi / 2 * (nodes + 1)
    return np.sin(phi), math.pi / 4 * weights * np.sin(phi)


def _integral(Omega: Array) -> Complex:
    s, weights = _strips()
    at = Omega[..., None] * s
    return np.asarray((scipy.special.j0(at) * np.exp(-1j * at)) @ weights)


@cache
def _spline() -> Any:
    """S by its real and imaginary part, to 1e-9."""
    nodes = np.linspace(0.0, _LAST, 801)
    return scipy.interpolate.CubicSpline(nodes, _integral(nodes).view(np.float64).reshape(-1, 2))


def stiffness(K0: float, C0: float, Omega: Array) -> Complex:
    """Stiffness by a travelling film: F̂/δ̂ over the dry contact's at ωa/um; K0 and C0 as in `ehl.Steady`."""
    asked = np.asarray(Omega, dtype=float)
    S = _spline()(np.minimum(asked, _LAST)).view(np.complex128)[..., 0]
    if (asked > _LAST).any():
        S = np.where(asked > _LAST, _integral(asked), S)
    A = K0 - 1
    B = C0 / 1.5 + A * math.pi / 4
    return np.asarray(1 + (A + 1j * np.asarray(Omega) * B) * S)
