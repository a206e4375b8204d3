"""What balls on films add by frequency to the stiffness and damping of their bearing."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from bearingdyn.bearing import AnswerUnderLoads, BallBearing, BearingKernel, FilmDamping
from bearingdyn.short_repr import short
from bearingdyn.system import BearingTerm
from bearingdyn.types import Array, Complex

_SLOW = 0.01  # rad/s, where c(ω) is c


@dataclass(frozen=True, eq=False)
class LubricatedBalls:
    """The pressed balls of a bearing on films, at one cage angle or several.

    Parameters
    ----------
    law
        Damping of a ball over load and frequency.
    kappa
        Of a ball, N/m^1.5.
    loads
        Of the balls (b,), N.
    across
        Of each, how its approach follows from the bearing's coefficients (b, n), over √(number of angles).
    give
        Compliance of the ring at a ball of its own, m/N, in series with the contacts.
    """

    law: FilmDamping
    kappa: float
    loads: Array
    across: Array
    give: float = 0.0

    __repr__ = short

    @cached_property
    def _answer(self) -> AnswerUnderLoads:
        assert self.law.answer is not None
        return self.law.answer.under(self.loads)

    @cached_property
    def _low(self) -> tuple[Array, Array, Array]:
        """Stiffness (b,), N/m, and damping, N s/m, that the tangents have, and that over the answer's own."""
        s = (self.loads / self.kappa) ** (2 / 3)
        dry, c = 1.5 * self.kappa * np.sqrt(s), self.law.at(s)
        own = dry * self._answer.stiffness(np.array([_SLOW]))[0].imag / _SLOW
        return dry, c, c / own

    def stiffness(self, omega: Array) -> Complex:
        """What the frequency adds to each ball's stiffness, N/m, (f, b), at omega (f,), rad/s.

        K(ω) + iω(c(ω) − c) − (3/2)κ√s. c(ω) is in proportion to the answer's, so that it is c at low
        frequency where contact fades too. With a give, of both in series, less what the tangents then have.
        """
        dry, c, share = self._low
        k = dry * self._answer.stiffness(omega)
        k = k.real + 1j * share * k.imag
        soft = 1 + self.give * dry
        return np.asarray(k / (1 + self.give * k) - dry / soft - 1j * omega[:, None] * c / soft**2)


def lubricated_balls(term: BearingTerm, z: Array, loads: Array) -> LubricatedBalls | None:
    """The pressed balls of a bearing with coefficients z and loads (Z,); None unless it runs on films."""
    bearing = term.bearing
    law = bearing.damping if isinstance(bearing, BallBearing) else None
    if not (isinstance(law, FilmDamping) and law.answer is not None):
        return None
    kernel, pressed = term.kernel(), loads > 0
    phi = azimuth_terms(kernel, kernel.angle0)
    angle = contact_angles(kernel, z, kernel.angle0)[:, None]
    across = np.where(np.asarray(kernel.axial, dtype=bool), np.sin(angle), np.cos(angle)) * phi
    return LubricatedBalls(law, kernel.kappa, loads[pressed], across[pressed], kernel.give)


def averaged(found: Sequence[LubricatedBalls | None]) -> LubricatedBalls | None:
    """Lubricated balls at several cage angles, each angle with the same weight."""
    balls = [one for one in found if one is not None]
    if not balls:
        return None
    return LubricatedBalls(
        balls[0].law,
        balls[0].kappa,
        np.concatenate([one.loads for one in balls]),
        np.concatenate([one.across for one in balls]) / math.sqrt(len(balls)),
        balls[0].give,
    )


def azimuth_terms(kernel: BearingKernel, azimuth: float) -> Array:
    """Azimuth terms of lubricated balls: cos or sin of order·ψ of each coefficient at each ball (Z, n)."""
    psi = azimuth + 2 * math.pi * np.arange(kernel.Z)[:, None] / kernel.Z
    return np.where(kernel.sine, np.sin(kernel.order * psi), np.cos(kernel.order * psi))


def contact_angles(kernel: BearingKernel, z: Array, azimuth: float) -> Array:
    """Contact angles of lubricated balls (Z,), rad, of raceway coefficients z, the first ball at
    the azimuth, rad; surfaces taken as smooth."""
    phi = azimuth_terms(kernel, azimuth)
    axial = np.asarray(kernel.axial, dtype=bool)
    return np.asarray(
        np.arctan2(kernel.x0 + phi[:, axial] @ z[axial], kernel.y0 + phi[:, ~axial] @ z[~axial])
    )
