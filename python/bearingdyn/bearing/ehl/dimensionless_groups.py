"""The dimensionless contact: lengths over Hertz' semi-axes, pressures over Hertz' pressure, films over a²/Rx.

A contact has three numbers, M, L and D = Rx/Ry (H. Moes). X = x/a along the rolling direction, Y = y/b across
it, k = a/b ≤ 1, P = p/p_h, H = h Rx/a², time T = t um/a, um = us/2.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cache, cached_property

import numpy as np

from bearingdyn.bearing.hertz import PointContact
from bearingdyn.types import Array

LOAD = 2 * math.pi / 3  # ∫∫ P dX dY of every load


@cache
def _quadrature() -> tuple[Array, Array]:
    nodes, weights = np.polynomial.legendre.leggauss(48)
    return nodes, weights


@dataclass(frozen=True)
class Groups:
    """Dimensionless coefficients of the lubricated contact's equations, in Hertz' units for one (M, L, D)."""

    M: float
    L: float
    D: float

    @cached_property
    def _contact(self) -> PointContact:
        return PointContact(Rx=1.0, Ry=1 / self.D, modulus=0.5)  # E′ = 2E* = 1

    @cached_property
    def _half_width(self) -> float:
        """a/Rx = (…)(F/E′Rx²)^⅓."""
        return self._contact.semi_axes(1.0)[1]

    @cached_property
    def k(self) -> float:
        """a/b, the inverse ellipticity."""
        return 1 / self._contact.chi

    @cached_property
    def _pressure(self) -> float:
        """p_h/E′ = (…)(F/E′Rx²)^⅓."""
        return self._contact.pressure(1.0)

    @cached_property
    def approach(self) -> float:
        """Dry Hertz approach, over a²/Rx."""
        return self._contact.approach(1.0) / self._half_width**2

    @property
    def compliance(self) -> float:
        """Factor of ∫∫ P dX dY / (k √(X² + Y²/k²)) in the film."""
        return 2 * self._pressure / (math.pi * self._half_width)

    @property
    def curvature(self) -> float:
        """Factor of Y²/2 in the film; that of X²/2 is 1."""
        return self.D / self.k**2

    @property
    def speed(self) -> float:
        """λ = 6 η0 us Rx²/(a³ p_h)."""
        return float(6 / (self._half_width**3 * self._pressure) * self.M ** (-4 / 3))

    @property
    def piezo(self) -> float:
        """α p_h."""
        return float(self._pressure * self.L * self.M ** (1 / 3))

    @property
    def moes(self) -> float:
        """Film in Moes' scale, h/Rx √(E′Rx/η0us), over H."""
        return float(self._half_width**2 * self.M ** (2 / 3))

    def dry_gap(self, X: float = 0.0, Y: float = 0.0) -> float:
        """Gap of the dry Hertz contact at (X, 0) or (0, Y) outside of it, over a²/Rx.

        The ellipsoidal potential, ∫₀^{w₁}(x²/(a²+w) + y²/(b²+w) − 1) dw/√((a²+w)(b²+w)w), w = a²s².
        """
        r2, own = (X**2, 1.0) if X else ((Y / self.k) ** 2, self.k**-2)
        if r2 <= own:
            return 0.0
        nodes, weights = _quadrature()
        half = math.sqrt(r2 - own) / 2
        s2 = (half * (nodes + 1)) ** 2
        integrand = (r2 / (own + s2) - 1) / np.sqrt((1 + s2) * (self.k**-2 + s2))
        return self._pressure / (self._half_width * self.k) * 2 * half * float(weights @ integrand)

    def reach(self, gap: float, *, along: bool) -> float:
        """Distance from the centre, X or Y, at which the dry gap is `gap` (over a²/Rx)."""

        def at(r: float) -> float:
            return self.dry_gap(X=r) if along else self.dry_gap(Y=r)

        low, high = 1.0, 2.0
        while at(high) < gap:
            high *= 2
        for _ in range(50):
            middle = (low + high) / 2
            low, high = (middle, high) if at(middle) < gap else (low, middle)
        return high


def scales(
    contact: PointContact, F: float, us: float, eta0: float, alpha: float
) -> tuple[float, float, float]:
    """Dimensionless groups M, L, D of a contact under F, N, u1 + u2 = us, m/s, eta0, Pa s, alpha, 1/Pa."""
    E, Rx = 2 * contact.modulus, contact.Rx
    speed = eta0 * us / (E * Rx)
    return F / (E * Rx**2) * speed**-0.75, alpha * E * speed**0.25, Rx / contact.Ry
