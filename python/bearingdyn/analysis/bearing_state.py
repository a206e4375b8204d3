"""A bearing in the static state, linearised at rest."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from bearingdyn.analysis.lubricated_balls import LubricatedBalls
from bearingdyn.bearing import NET, RIGID, RacewaySeries
from bearingdyn.types import Array


@dataclass(frozen=True, eq=False)
class BearingState:
    """State of a bearing at rest, and the bearing linearised in it.

    Parameters
    ----------
    z
        Relative raceway coefficients (n,), m.
    g
        Force on them (n,), N.
    K, C
        Tangents (n, n), N/m and N s/m.
    loads
        Of the balls (Z,), N.
    series
        Which coefficients they are; between rigid rings there are five.
    balls
        Pressed balls on films, which answer by frequency; None where K and C say all.
    """

    z: Array
    g: Array
    K: Array
    C: Array
    loads: Array
    series: RacewaySeries = RIGID
    balls: LubricatedBalls | None = None

    def __repr__(self) -> str:
        """One line: the loaded balls, the force and the stiffness."""
        force = ", ".join(f"{f:.4g}" for f in self.force)
        return (
            f"<BearingState: {int((self.loads > 0).sum())} of {self.loads.size} balls loaded, at most "
            f"{self.loads.max(initial=0.0):.4g} N; force ({force}) N, radial stiffness "
            f"{self.radial_stiffness:.4g} N/m>"
        )

    @property
    def radial_stiffness(self) -> float:
        """Mean of the two radial diagonal tangents, N/m; of the balls alone, without the rings' own give."""
        x, y = (self.series.index(0, 1, sine) for sine in (0, 1))
        return float(self.K[x, x] + self.K[y, y]) / 2

    @property
    def force(self) -> Array:
        """Force (3,) of the inner ring on the balls, x, y, z, N."""
        return np.array([self.g[self.series.index(*t)] if t in self.series.terms else 0.0 for t in NET])
