"""The points of a master curve inside a band, and how far a modulus deviates from them."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from bearingdyn.material.low_end import LATE
from bearingdyn.material.relaxation_spectrum import dense_times, solve_strengths, unit_columns
from bearingdyn.types import Array, Complex

PIN_WEIGHT = 1e3  # of the pin against one point: it is met to some 1e-4
MARGIN = math.log(10.0)  # a relaxation time may lie a decade outside the band


@dataclass(frozen=True)
class Points:
    """Points of a master curve in a band, Hz: ω rad/s, shear moduli Pa, number of the isotherm.

    `pin` is a time, s, and the relaxation modulus, Pa, that a fit is held to there.
    """

    omega: Array
    storage: Array
    loss: Array
    isotherm: NDArray[np.int64]
    band: tuple[float, float]
    pin: tuple[float, float] | None = None

    @property
    def limits(self) -> tuple[float, float]:
        """ln of the shortest and the longest relaxation time the band can tell, s."""
        f_lo, f_hi = self.band
        longest = -math.log(2 * math.pi * f_lo) + MARGIN
        if self.pin is not None and self.pin[0] >= LATE / self.omega.min():
            # what lies between the points and the pin needs a branch there, and it has relaxed at the pin
            longest = math.log(self.pin[0] / LATE)
        return -math.log(2 * math.pi * f_hi) - MARGIN, longest

    def take(self, index: NDArray[np.int64]) -> Points:
        """These points, repeated ones counting twice."""
        omega, storage, loss = self.omega[index], self.storage[index], self.loss[index]
        return Points(omega, storage, loss, self.isotherm[index], self.band, self.pin)

    def pin_row(self, tau: Array) -> Array:
        """Unit spring, branches and dashpot in the modulus at the pin, over its value; (0 or 1, n + 2)."""
        if self.pin is None:
            return np.empty((0, tau.size + 2))
        time, modulus = self.pin
        return np.concatenate([[1.0], np.exp(-time / tau), [0.0]])[None, :] / modulus

    def pin_slope(self, tau: Array) -> Array:
        """Derivative of the branches' part of :meth:`pin_row` with respect to ln τ, (0 or 1, n)."""
        if self.pin is None:
            return np.empty((0, tau.size))
        late = self.pin[0] / tau
        return np.asarray(late * np.exp(-late))[None, :] / self.pin[1]

    def stack(self, storage: Array, loss: Array) -> Array:
        """Rows of G′ over those of G″, relative to what was measured."""
        return np.vstack([storage / self.storage[:, None], loss / self.loss[:, None]])

    def deviations(self, modulus: Complex) -> tuple[Array, Array]:
        """ln(model/measured) of G′ and of tan δ."""
        tan = np.log(modulus.imag / modulus.real) - np.log(self.loss / self.storage)
        return np.log(modulus.real / self.storage), tan

    def dense(self, per_decade: int = 12) -> tuple[Array, Array]:
        """Times of a dense spectrum, a decade beyond the points, and strengths: spring, branches, dashpot."""
        tau, A, target = self.dense_problem(per_decade)
        return tau, solve_strengths(A, target).x

    def dense_problem(self, per_decade: int) -> tuple[Array, Array, Array]:
        """Times, and A and b of the least-squares problem A x ≈ b for the strengths of a dense spectrum."""
        tau = dense_times(float(self.omega.min()), float(self.omega.max()), per_decade, 1.0)
        return tau, *self.log_problem(tau)

    def log_problem(self, tau: Array) -> tuple[Array, Array]:
        """A and b of A x ≈ b for the strengths (spring, branches, dashpot) of branches with these times.

        Rows are the deviations of ln G′ and of ln tan δ to first order, linear in the strengths.
        """
        relative, lossy = np.split(self.stack(*unit_columns(self.omega, tau)), 2)
        target = np.concatenate([np.ones(self.omega.size), np.zeros(self.omega.size)])
        return np.vstack([relative, lossy - relative]), target

    def floor(self) -> tuple[float, float]:
        """rms deviation of ln G′ and ln tan δ of the best dense non-negative spectrum."""
        tau, x = self.dense()
        storage, loss = unit_columns(self.omega, tau)
        modulus = storage @ x + 1j * (loss @ x)
        ds, dt = self.deviations(modulus)
        return float(np.sqrt(np.mean(ds**2))), float(np.sqrt(np.mean(dt**2)))
