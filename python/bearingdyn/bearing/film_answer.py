"""How both lubricated contacts of a ball together answer a small harmonic motion, by load and frequency."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeAlias

import numpy as np
import scipy

from bearingdyn.bearing import ehl
from bearingdyn.bearing.hertz import PointContact
from bearingdyn.bearing.lubricant import Lubricant
from bearingdyn.short_repr import short
from bearingdyn.types import Array, Complex

_LOADS = 12  # of so many loads the answer is looked up, and splines over ln Q tell that of others
_Pair: TypeAlias = tuple[ehl.LubricatedContact, ehl.LubricatedContact]


@dataclass(frozen=True, eq=False)
class AnswerUnderLoads:
    """Answer of films: the dynamic stiffness of lubricated balls under given loads.

    Parameters
    ----------
    found
        Both contacts at some loads (n).
    to_balls
        (b, n), interpolates from these to the balls.
    """

    found: tuple[_Pair, ...]
    to_balls: Array

    __repr__ = short

    def stiffness(self, omega: Array) -> Complex:
        """Stiffness of each ball over that of its dry contacts, (f, b), at omega (f,), rad/s."""
        f = np.asarray(omega) / (2 * np.pi)
        ratios = np.empty((f.size, len(self.found)), dtype=np.complex128)
        for n, pair in enumerate(self.found):
            dry = sum(one.dry_stiffness**-1 for one in pair)
            ratios[:, n] = dry / sum(1 / one.stiffness(f) for one in pair)
        return ratios @ self.to_balls.T


@dataclass(frozen=True)
class FilmAnswer:
    """Answer of a ball's two films to motion, from the table of `ehl`: its contacts and their oil.

    Contacts that it does not hold answer as the nearest that it holds.

    Parameters
    ----------
    inner, outer
        The contacts.
    lubricant, temperature
        Oil and its temperature at the inlet, °C.
    us
        Sum of the surface speeds of each contact, m/s.
    """

    inner: PointContact
    outer: PointContact
    lubricant: Lubricant
    temperature: float
    us: float

    def loads(self) -> tuple[float, float]:
        """Least and largest load at which the table holds both contacts, N."""
        low, high = 0.0, np.inf
        for contact in (self.inner, self.outer):
            M, _, D = self._groups(contact)
            least, largest = ehl.loads_between(D)
            # a hair inside, for round-off
            low, high = max(low, least / M * (1 + 1e-9)), min(high, largest / M * (1 - 1e-9))
        return low, high

    def turning_load(self) -> float:
        """Load, N, at which both contacts have turned from rigid bodies on a film to Hertz contacts."""
        groups = (self._groups(contact) for contact in (self.inner, self.outer))
        return max(ehl.turning_load(D) / M for M, _, D in groups)

    def damping(self, Q: float) -> float:
        """Damping of a ball at low frequency under a load that the table holds, N s/m."""
        return in_series(*self._looked_up(Q))

    def passages(self, Q: float) -> tuple[float, float]:
        """Times in which the oil passes half of the inner and of the outer contact under a load, a/um, s."""
        inner, outer = (2 * contact.semi_axes(Q)[1] / self.us for contact in (self.inner, self.outer))
        return inner, outer

    def under(self, loads: Array) -> AnswerUnderLoads:
        """The answer of balls under loads (b,), N; one that the table does not hold is taken at its end."""
        held = np.log(np.clip(loads, *self.loads()))
        nodes, to_balls = held, np.eye(held.size)
        if held.size > _LOADS:
            nodes = np.linspace(held.min(), held.max() + 1e-9, _LOADS)
            to_balls = scipy.interpolate.CubicSpline(nodes, np.eye(_LOADS))(held)
        found = [self._looked_up(float(Q)) for Q in np.exp(nodes)]
        return AnswerUnderLoads(tuple(found), to_balls)

    def _looked_up(self, Q: float) -> _Pair:
        eta0 = self.lubricant.viscosity(self.temperature)
        alpha = self.lubricant.pressure_coefficient(self.temperature)
        inner, outer = (
            ehl.LubricatedContact(contact, Q, self.us, eta0, alpha, ehl.lookup(M * Q, L, D))
            for contact in (self.inner, self.outer)
            for M, L, D in (self._groups(contact),)
        )
        return inner, outer

    def _groups(self, contact: PointContact) -> tuple[float, float, float]:
        """M under 1 N, and the L and D of the table that are nearest."""
        oil, T = self.lubricant, self.temperature
        M, L, D = ehl.scales(contact, 1.0, self.us, oil.viscosity(T), oil.pressure_coefficient(T))
        return M, *ehl.nearest_in_table(L, D)


def in_series(inner: ehl.LubricatedContact, outer: ehl.LubricatedContact) -> float:
    """What two films answer at low frequency: damping in series, k²(c_i/k_i² + c_o/k_o²), N s/m."""
    k = 1 / (1 / inner.k0 + 1 / outer.k0)
    return k**2 * (inner.c0 / inner.k0**2 + outer.c0 / outer.k0**2)
