"""Where the oil reaches to, and how fine a grid has to be."""

from __future__ import annotations

import math
from dataclasses import dataclass

from bearingdyn.bearing.ehl.dimensionless_groups import Groups
from bearingdyn.bearing.ehl.grid import Grid

_UPSTREAM = 2.0  # the oil begins this many a before the dry contact at least
_SIDEWAYS = 1.25  # and ends this many a beside it
_OUTLET = 4.0  # gap behind the contact, over hc; the film ruptures at less than 2 hc
_ERROR = 0.30  # of the central film, relative, times (Δx/a)²/(hc Rx/a²)^{4/3}
# Under a thick film the pressure reaches over √(2 Hc), and C0 jumps a little where the rupture passes a node.
_THICK = 0.8  # pitch over √(2 Hc · error)
_FLATTEST = 4.0  # pitch across over pitch along, in a long ellipse


@dataclass(frozen=True)
class Flooding:
    """Extent of the oil that floods the contact: X from −inlet to outlet, |Y| to side."""

    inlet: float
    outlet: float
    side: float
    flattened: float
    """Pitch across over pitch along, in metres each."""

    @classmethod
    def around(cls, groups: Groups, Hc: float, gap: float | None) -> Flooding:
        """Oil up to a gap of `gap` hc in front, 0.4 `gap` beside; None: the customary extent.

        Customary are distances such as X = −4.5 and |Y| = 3 for M = 20, L = 10, D = 1 (C. H. Venner,
        A. A. Lubrecht 2000), gaps of 19 and 7.5 hc. A long ellipse has the wedge of a line contact, which
        needs 75 hc for half a per cent, and an isoviscous film carries load far from the centre.
        """
        if gap is None:
            isoviscous = math.exp(-groups.L / 2)
            front = 75 - 56 * groups.D**2 + 123 * isoviscous
            beside = 20 - 12.5 * groups.D**2 + 55 * isoviscous
            least = 1 + _UPSTREAM, 1 + _SIDEWAYS * groups.k
        else:
            front, beside, least = gap, 0.4 * gap, (1.0, 1.0)
        return cls(
            inlet=max(least[0], groups.reach(front * Hc, along=True)),
            outlet=max(1.5, groups.reach(_OUTLET * Hc, along=True)),
            side=max(least[1], groups.reach(beside * Hc, along=False)),
            flattened=min(_FLATTEST, max(1.0, 0.4 / groups.k)),
        )

    @staticmethod
    def pitch(error: float, Hc: float) -> float:
        """Δx/a at which a central film Hc errs by about `error`, relative, and C0 by a few times that."""
        return float(math.sqrt(error) * min(Hc ** (2 / 3) / math.sqrt(_ERROR), _THICK * math.sqrt(2 * Hc)))

    def grid(self, groups: Groups, pitch: float, levels: int) -> Grid:
        """Coarsest grid whose refinement, `levels` times over, has the pitch Δx/a or less."""
        coarse = pitch * 2**levels
        dx = coarse * min(1.0, self.inlet / (coarse * math.ceil(self.inlet / coarse)))
        before, behind = round(self.inlet / dx), math.ceil(self.outlet / dx - 1e-9)
        rows = math.ceil(self.side / (self.flattened * dx * groups.k) - 1e-9)
        return Grid(before + behind + 1, rows + 1, before, dx, self.side / rows)

    def square(self, n: int) -> Grid:
        """Grid of n × n nodes on the whole contact."""
        before = round((n - 1) * self.inlet / (self.inlet + self.outlet))
        return Grid(n, (n + 1) // 2, before, self.inlet / before, 2 * self.side / (n - 1))
