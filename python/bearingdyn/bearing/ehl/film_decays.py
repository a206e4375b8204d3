"""The answer of a carried film over frequency: what the inlet made of it fades as the oil passes the contact.

The film of each strip was made at the inlet when the oil that is now in the contact passed there, so that a
contact answers an approach with delay, roughly K̂/K_H = 1 + (A + iΩB) S(Ω) with S = ½∫₋₁¹ J0(Ωs) e^{−iΩs} dy,
s = √(1 − y²). As a sum of decays, of which a march needs no more than their present values, that is

    K̂ = K0 (1 + iΩ b N(Ω)),    N = Σ ρ/(iΩ + d),    N(0) = 1,

K0 and b K0 the stiffness and damping at low frequency. The strengths ρ are fitted to K̂ where it is known; the
sum then holds between such places too, as a film's answer is no less smooth than its decays.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import scipy
from numpy.typing import ArrayLike

from bearingdyn.short_repr import short
from bearingdyn.types import Array, Complex

# Of a contact, in um/a: one alone and two pairs, of which the first is given. Least squares of what contacts
# of a 6205 answer; the fast one stands for the 1/√t with which the share of the inlet begins.
DECAYS = np.array([21.0 + 0j, 1.45 - 2.99j, 1.92 - 0.95j])
"""Rates of decay of one contact's film, um/a; of pairs the first."""
# Weight of the strengths in the fit, rising until films give no energy beyond the last frequency, where
# nothing is known of them. Below it they may: surfaces that roll drive them, and with D = 1 and L beyond 20
# the solutions have c(ω) down to −.04 c0 about ωa/um = 2.
_RESTRAINTS = (0.0, 1e-3, 3e-3, 1e-2, 3e-2, 0.1, 0.3, 1.0)
_BEYOND = np.geomspace(1.0, 1e4, 200)  # over the last frequency: where that is asked


@dataclass(frozen=True, eq=False)
class FilmDecays:
    """Decays of a film that answer a harmonic approach: K̂ = K0 (1 + iωb Σ ρ/(iω + d)).

    Parameters
    ----------
    softness
        K0, over the dry stiffness.
    slope
        b, damping at low frequency over K0, a time.
    decays, strengths
        (n,) d and ρ, complex, by the same unit of time; of a pair the first, its strength doubled.
    """

    softness: float
    slope: float
    decays: Complex
    strengths: Complex

    __repr__ = short

    @classmethod
    def fitted(
        cls, omega: Array, answer: Complex, softness: float, slope: float, decays: Complex
    ) -> FilmDecays:
        """The strengths nearest to an answer that meet K0 and b, and give no energy beyond its end.

        Parameters
        ----------
        omega, answer
            (f,) frequencies, and K̂ over the dry stiffness at each.
        softness, slope, decays
            As of the class.

        Raises
        ------
        ArithmeticError
            Where every fit would give energy.
        """
        iw = np.asarray(1j * omega, dtype=np.complex128)
        columns = _modes(iw, decays) * iw[:, None]
        fit = np.vstack([columns.real, columns.imag]) / math.sqrt(omega.size)
        P = (answer / softness - 1) / slope
        goal = np.concatenate([P.real, P.imag]) / math.sqrt(omega.size)
        slow = _modes(np.zeros(1, dtype=np.complex128), decays)[0].real
        first, free = slow / (slow @ slow), scipy.linalg.null_space(slow[None])
        beyond = _modes(np.asarray(1j * _BEYOND * omega.max(), dtype=np.complex128), decays)
        for restraint in _RESTRAINTS:
            rows = np.vstack([fit @ free, restraint * free])
            right = np.concatenate([goal - fit @ first, -restraint * first])
            x = first + free @ np.linalg.lstsq(rows, right, rcond=None)[0]
            if ((beyond @ x).real >= 0).all():
                parts = iter(x.tolist())
                found = [complex(next(parts), next(parts) if d.imag else 0.0) for d in decays.tolist()]
                return cls(softness, slope, decays, np.array(found))
        raise ArithmeticError("no sum of decays answers as this film does without giving energy")

    def stiffness(self, omega: ArrayLike) -> Complex:
        """Dynamic stiffness K̂ over the dry one at frequencies of any shape, in the unit of the decays."""
        iw = 1j * np.asarray(omega, dtype=float)
        N = sum(
            (s / (iw + d) if d.imag == 0 else 0.5 * (s / (iw + d) + s.conjugate() / (iw + d.conjugate())))
            for d, s in zip(self.decays.tolist(), self.strengths.tolist(), strict=True)
        )
        return np.asarray(self.softness * (1 + iw * self.slope * N))


def _modes(iw: Complex, decays: Complex) -> Complex:
    """Columns of N for each mode: of a pair the two of the real and of the imaginary part of its strength."""
    columns = []
    for d in decays.tolist():
        one = 1 / (iw + d)
        if d.imag == 0:
            columns.append(one)
            continue
        other = 1 / (iw + d.conjugate())
        columns += [(one + other) / 2, 0.5j * (one - other)]
    return np.array(columns).T
