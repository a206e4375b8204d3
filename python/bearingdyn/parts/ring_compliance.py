"""What a ring gives beyond Hertz: its orders less the half-space's, folded onto those that it carries.

Under loads Q of Z balls, equally spaced, the race sinks at ball i by Σ_j A_ij Q_j beyond Hertz,

    A_ij = Σ_n C_n cos n(ψ_i − ψ_j) − δ_ij Σ_n h_n,

C_n the compliance of order n of the ring and h_n that of the half-space under the same footprint. At the
balls the orders n and p are alike if n ± p is a multiple of Z: cos n(ψ_i − ψ_j) = cos p(ψ_i − ψ_j). What the
orders beyond the highest carried one add is therefore the same as a compliance of the orders p = 0…Z/2,
exactly, and what these have in common is one at each ball by itself: its give.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import scipy
from numpy.typing import NDArray

from bearingdyn.bearing import half_space_orders
from bearingdyn.material import Elastic
from bearingdyn.short_repr import short
from bearingdyn.types import Array

_DEPTHS = 5.0  # e^{-2kt} of what a wall t away changes is 5e-5 where k t is this
_FARTHEST = 160  # highest order at which a ring is solved: a mesh holds no shorter waves
_SMOOTH = 40  # periods of Z orders after which the half-space's sums are tapered


@dataclass(frozen=True, eq=False)
class RingCompliance:
    """Compliance of a ring's race, static, order by order, beyond the half-space's.

    Parameters
    ----------
    Z
        Number of balls.
    order
        Highest order that the ring carries by itself.
    ring, half_space
        (m,) compliance C_n and h_n of the orders n = 0…m − 1, m/N, of a unit load on the coefficient along
        the line of contact. C_n of order 1 of a ring that nothing holds is nan: it moves as a whole.
    give
        What the orders beyond `order` and the half-space leave at each ball by itself, m/N.
    folded
        (Z//2 + 1,) what they add to the orders p = 0…Z/2, m/N.
    """

    Z: int
    order: int
    ring: Array
    half_space: Array
    give: float
    folded: Array

    __repr__ = short

    def of(self, p: int) -> float:
        """Compliance A of the pattern of loads cos p ψ, p = 0…Z/2, beyond Hertz, m/N; p = 0: equal loads."""
        n = np.arange(self.order + 1)
        own = n[_alike(n, p, self.Z)]
        return _times(p, self.Z) * (float(self.ring[own].sum()) + float(self.folded[p])) + self.give

    @property
    def cut(self) -> float:
        """Share of the compliance of equal loads that is not carried by orders, but folded.

        It is static: the ring's own modes of those orders are left out.
        """
        m = _times(0, self.Z)
        return abs(m * float(self.folded[0])) / (m * float(np.nansum(self.ring[: self.order + 1 : self.Z])))


def _alike(n: NDArray[np.integer], p: int, Z: int) -> Array:
    """Orders n that are as p at the balls."""
    return np.asarray((n % Z == p % Z) | ((-n) % Z == p % Z))


def _times(p: int, Z: int) -> float:
    """Eigenvalue of cos p(ψ_i − ψ_j)."""
    return float(Z) if 2 * p % Z == 0 else 0.5 * Z


def ring_compliance(
    of_order: Callable[[int], float],
    low: Array,
    *,
    Z: int,
    half_length: float,
    radius: float,
    depth: float,
    material: Elastic,
) -> RingCompliance:
    """Compliance of a ring at its balls: its give, and the orders folded into it.

    Parameters
    ----------
    of_order
        C_n, m/N, of an order beyond those of `low`.
    low
        (order + 1,) C_n, m/N, of those that are carried; nan where a free ring moves as a whole.
    half_length, radius, material
        As in half_space_orders.
    depth
        From the race to the ring's other face, m.
    """
    order = len(low) - 1
    # where the other face is not felt any more, what is left is the curvature of the race, which falls as
    # 1/n of h_n
    end = min(max(order + 8, int(np.ceil(_DEPTHS * radius / depth))), _FARTHEST)
    steps = order + 1 + np.round((end - order - 1) * np.linspace(0.0, 1.0, 10) ** 1.7).astype(int)
    solved = np.unique(np.concatenate([[order + 1, order + 2, end], steps]))
    count = (2 * _SMOOTH + 1) * Z + 2 * end
    h = half_space_orders(count, half_length, radius, material)
    beyond = np.array([of_order(int(n)) for n in solved]) - h[solved]
    n = np.arange(order + 1, count)
    D = np.where(
        n <= end,
        scipy.interpolate.PchipInterpolator(solved, beyond)(np.minimum(n, end)),
        beyond[-1] * (end / n) * h[n] / h[end],
    )
    # beyond many periods a sum over every Z-th order, Z times, is the sum over all: both fade out together
    fade = 0.5 * (1 + np.cos(np.pi * np.clip((n - end - _SMOOTH * Z) / (_SMOOTH * Z), 0.0, 1.0)))
    tail = D + h[n] * fade
    held = float(h[: order + 1].sum()) + float((h[n] * fade).sum())
    rest = np.array([_times(p, Z) * tail[_alike(n, p, Z)].sum() - held for p in range(Z // 2 + 1)])
    give = float(rest.min())
    folded = np.array([(rest[p] - give) / _times(p, Z) for p in range(Z // 2 + 1)])
    ring = np.concatenate([low, h[n[n <= end]] + D[n <= end]])
    return RingCompliance(Z, order, ring, h[: len(ring)], give, folded)
