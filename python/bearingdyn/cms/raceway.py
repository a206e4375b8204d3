"""The raceway of a flexible ring, as coordinates of its part."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from bearingdyn.bearing import RacewaySeries
from bearingdyn.checks import positive
from bearingdyn.cms.frozen_matrices import frozen
from bearingdyn.short_repr import short
from bearingdyn.types import Array


@dataclass(frozen=True, eq=False)
class Raceway:
    """The raceway of a flexible ring: the motion of its groove centre as Fourier coefficients in azimuth.

    Parameters
    ----------
    series
        The coefficients.
    arm
        Radius, m, at which tilts become axial motion.
    rows
        (len(series), n) coefficients from the superelement's coordinates; a load of balls g acts as rowsᵀ g.
    give
        What the ring adds to Hertz at each ball by itself, beyond the coefficients, m/N (mostly negative, for
        the coefficients have some of Hertz's dent); it goes into the law of the contact.
    Z
        Number of balls it was worked out for; None: any, and no give.
    """

    series: RacewaySeries
    arm: float
    rows: Array
    give: float = 0.0
    Z: int | None = None

    __repr__ = short

    def __post_init__(self) -> None:
        n = np.shape(self.rows)[-1] if np.ndim(self.rows) else 0
        object.__setattr__(self, "rows", frozen("rows", self.rows, (len(self.series), n)))
        positive("arm", self.arm, "it must be a positive radius in m")
