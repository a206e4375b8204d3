"""The lubricated contact in metres and newtons."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import Literal

import numpy as np
import scipy
from numpy.typing import ArrayLike

from bearingdyn.bearing.ehl.dimensionless_groups import scales
from bearingdyn.bearing.ehl.oil import Density, Viscosity
from bearingdyn.bearing.ehl.steady_film import Steady, steady
from bearingdyn.bearing.ehl.table_lookup import Lookup, lookup
from bearingdyn.bearing.hertz import PointContact
from bearingdyn.bearing.lubricant import Lubricant
from bearingdyn.checks import number, positive, require
from bearingdyn.types import Array, Complex

_OFF = 0.1  # where a viscous damping no longer describes the contact


@dataclass(frozen=True)
class LubricatedContact:
    """A lubricated contact under load with its film, as `look_up` returns it, in SI units."""

    contact: PointContact
    F: float
    """Load, N."""
    us: float
    """Sum of the surface speeds, m/s."""
    eta0: float
    """Viscosity at ambient pressure, Pa s."""
    alpha: float
    """Pressure–viscosity coefficient, 1/Pa."""
    steady: Steady | Lookup
    """Its figures in the scales of Moes."""

    @property
    def M(self) -> float:
        """Load in the scale of Moes."""
        return self.steady.M

    @property
    def L(self) -> float:
        """Lubricant in the scale of Moes."""
        return self.steady.L

    @property
    def D(self) -> float:
        """Rx/Ry."""
        return self.steady.D

    @property
    def _film(self) -> float:
        return self.contact.Rx * math.sqrt(self.eta0 * self.us / (2 * self.contact.modulus * self.contact.Rx))

    @property
    def dry_stiffness(self) -> float:
        """Stiffness of the dry contact, N/m."""
        return 1.5 * self.F / self.contact.approach(self.F)

    @property
    def hc(self) -> float:
        """Film at the centre."""
        return self.steady.Hc * self._film

    @property
    def hmin(self) -> float:
        """Least film."""
        return self.steady.Hmin * self._film

    @property
    def h0(self) -> float:
        """Film h0 of the force law F = κ(δ + h0)^{3/2}."""
        return self.steady.H0 * self._film

    @property
    def delta(self) -> float:
        """Approach of the bodies."""
        return self.contact.approach(self.F) - self.h0

    @property
    def k0(self) -> float:
        """Stiffness at low frequency, N/m."""
        return self.steady.K0 * self.dry_stiffness

    @property
    def c0(self) -> float:
        """Damping at low frequency, N s/m."""
        return self.steady.C0 * self.dry_stiffness / 1.5 * self._passage

    @property
    def _passage(self) -> float:
        """Time in which the oil goes through half of the contact, a/um, s."""
        return 2 * self.contact.semi_axes(self.F)[1] / self.us

    def stiffness(self, frequency: ArrayLike) -> Complex:
        """Dynamic stiffness K(ω) + iωc(ω) of a small harmonic approach, N/m, at frequencies in Hz."""
        asked = np.asarray(frequency, dtype=float)
        require(bool(np.isfinite(asked).all()), "frequency", frequency, "it must be finite, in Hz")
        return np.asarray(self.steady.stiffness(2 * math.pi * asked * self._passage) * self.dry_stiffness)

    @cached_property
    def viscous_limit(self) -> float:
        """Frequency, Hz, from which on c(ω) is 10 % or more off c0."""

        def inside(Omega: float) -> float:
            C = 1.5 * complex(self.steady.stiffness(Omega)).imag / Omega
            return _OFF - abs(C / self.steady.C0 - 1)

        low, high = 0.05, 0.1
        while inside(high) > 0:
            low, high = high, 1.5 * high
        return float(scipy.optimize.brentq(inside, low, high, xtol=1e-3 * low)) / (
            2 * math.pi * self._passage
        )


@dataclass(frozen=True)
class SolvedContact(LubricatedContact):
    """A lubricated contact with its maps of pressure and film, as `solve` returns it, in SI units."""

    steady: Steady
    """The solution in the scales of Moes, with the estimated errors of its figures."""

    @property
    def x(self) -> Array:
        """Places along the rolling direction, (nx,)."""
        return self.steady.X * self.contact.semi_axes(self.F)[1]

    @property
    def y(self) -> Array:
        """Places across, (ny,)."""
        return self.steady.Y * self.contact.semi_axes(self.F)[0]

    @property
    def pressure(self) -> Array:
        """Pressure (ny, nx), Pa."""
        return self.steady.pressure * self.contact.pressure(self.F)

    @property
    def film(self) -> Array:
        """Film (ny, nx)."""
        return self.steady.film * self._film


def solve(
    contact: PointContact,
    lubricant: Lubricant,
    F: float,
    us: float,
    temperature: float,
    *,
    viscosity: Viscosity = "roelands",
    density: Density = "dowson-higginson",
    grid: int | Literal["auto"] = "auto",
    inlet: float | None = None,
    accuracy: float = 0.01,
) -> SolvedContact:
    """Lubricated contact in SI units under a load, solved: film, and answer to a small harmonic approach.

    Parameters
    ----------
    contact
        The bodies, Rx ≤ Ry: they roll across the long axis of the contact.
    lubricant, temperature
        Oil and its temperature at the inlet, °C.
    F
        Load, N.
    us
        Sum of the surface speeds u1 + u2, m/s; its sign is of no effect.
    viscosity, density, grid, inlet, accuracy
        As in `steady`.

    Raises
    ------
    ValueError
        If a value is out of range: no speed, a temperature outside the oil's viscosity law, an M or L outside
        what is solved, a grid that cannot resolve the film.
    ArithmeticError
        If the solution does not converge.
    """
    M, L, D, speed, eta0, alpha = _checked(contact, lubricant, F, us, temperature)
    found = steady(
        M,
        L,
        D,
        viscosity=viscosity,
        density=density,
        grid=grid,
        inlet=inlet,
        accuracy=accuracy,
        alpha=alpha,
        eta0=eta0,
    )
    return SolvedContact(contact, float(F), speed, eta0, alpha, found)


def look_up(
    contact: PointContact, lubricant: Lubricant, F: float, us: float, temperature: float
) -> LubricatedContact:
    """Lubricated contact in SI units under a load, not solved but by the table, in microseconds.

    Parameters
    ----------
    contact, lubricant, F, us, temperature
        As in `solve`.

    Raises
    ------
    ValueError
        As `solve`, and outside of the table.
    """
    M, L, D, speed, eta0, alpha = _checked(contact, lubricant, F, us, temperature)
    return LubricatedContact(contact, float(F), speed, eta0, alpha, lookup(M, L, D))


def _checked(
    contact: PointContact, lubricant: Lubricant, F: float, us: float, temperature: float
) -> tuple[float, float, float, float, float, float]:
    """M, L, D, |us|, η0 and α of a contact that rolls and is lubricated."""
    require(
        isinstance(contact, PointContact),
        "contact",
        contact,
        "give a PointContact, such as brg.inner_contact",
    )
    require(isinstance(lubricant, Lubricant), "lubricant", lubricant, "give a Lubricant")
    wider = f"it must not exceed Ry = {contact.Ry!r} m: the film is solved for rolling across the long axis"
    require(contact.Rx <= contact.Ry, "contact.Rx", contact.Rx, wider)
    positive("F", F, "the contact load in N must be positive")
    speed = abs(number("us", us, "it must be a finite speed u1 + u2, in m/s"))
    require(speed != 0, "us", us, "without speed there is no film: give u1 + u2 in m/s")
    eta0, alpha = lubricant.viscosity(temperature), lubricant.pressure_coefficient(temperature)
    return *scales(contact, F, speed, eta0, alpha), speed, eta0, alpha
