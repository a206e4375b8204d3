"""Two or three equal ball bearings side by side, set against each other or one behind the other."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import ClassVar, Literal

import scipy

from bearingdyn.bearing.ball_bearing import BallBearing
from bearingdyn.bearing.row_set import RowSet, touching

Arrangement = Literal["DB", "DF", "DT"]
Threefold = Literal["DBD", "DFD", "DTD"]


@dataclass(frozen=True)
class Pair(RowSet):
    """A pair of equal bearings on one shaft and in one housing, all four rings rigid.

    Motions q (6,) and loads (6,) are of both inner rings together relative to both outer rings, reference on
    the axis midway between the rows; q = 0 is the preloaded pair without load.

    Parameters
    ----------
    row
        One bearing; by itself its inner ring carries axial load towards +z.
    arrangement
        "DB" back to back: the lines of contact meet the axis outside the pair, as wide a base as there is for
        moments. "DF" face to face: they meet it between the rows. "DT" tandem: both rows carry towards +z.
    distance
        Between the middles of the rows, m.
    preload
        How much closer than touching the rings of the two rows are clamped, both rows together, m: the axial
        gap between the rings before clamping. Not for "DT".
    preload_force
        Axial force of each row on the other, N, instead of `preload`.

    Raises
    ------
    ValueError
        Naming the field: a wrong type or arrangement, a distance or preload that is not positive or zero,
        both preloads at once, or a preload of a tandem.

    Examples
    --------
    >>> import math
    >>> import bearingdyn as bd
    >>> from bearingdyn.bearing import Pair
    >>> row = bd.BallBearing(Z=14, Dw=9e-3, Dpw=50e-3, fi=0.52, fo=0.53, contact_angle=math.radians(15))
    >>> pair = Pair(row, "DB", distance=0.015, preload_force=200.0)
    >>> k = pair.stiffness([0.0] * 6)
    >>> bool(k[0, 0] > k[2, 2] > 0)  # radially stiffer than axially
    True
    """

    SENSES: ClassVar[Mapping[str, tuple[int, ...]]] = {"DB": (1, -1), "DF": (-1, 1), "DT": (1, 1)}

    arrangement: Arrangement

    @cached_property
    def approach(self) -> float:
        """Axial approach of the rings of each row from touching, without load, m."""
        if self.preload_force:
            return _approach(self.row, self.preload_force)
        return (self.preload or 0.0) / 2

    @property
    def lifts(self) -> tuple[float, float]:
        """`approach` of the row at −distance/2 and of the row at +distance/2, m."""
        return self.approach, self.approach


@dataclass(frozen=True)
class Triplet(RowSet):
    """A triplet of equal bearings on one shaft and in one housing: two rows in tandem against a third.

    Motions q (6,) and loads (6,) are of all inner rings together relative to all outer rings, reference on
    the axis at the middle row; q = 0 is the preloaded triplet without load.

    Parameters
    ----------
    row
        One bearing; by itself its inner ring carries axial load towards +z.
    arrangement
        "DBD" the two rows at −distance and 0 carry towards +z, back to back with the third, which carries
        towards −z (TBT); "DFD" the same face to face (TFT); "DTD" all three carry towards +z. The other way
        round: `app.bearing(…, mirrored=True)`.
    distance
        Between the middles of neighbouring rows, m.
    preload
        How much closer than touching the rings are clamped, tandem and third row together, m. Not for "DTD".
    preload_force
        Axial force of the third row on the other two, N, of which each carries half, instead of `preload`.

    Raises
    ------
    ValueError
        Naming the field: a wrong type or arrangement, a distance or preload that is not positive or zero,
        both preloads at once, or a preload of a tandem.

    Examples
    --------
    >>> import math
    >>> import bearingdyn as bd
    >>> from bearingdyn.bearing import Triplet
    >>> row = bd.BallBearing(Z=14, Dw=9e-3, Dpw=50e-3, fi=0.52, fo=0.53, contact_angle=math.radians(15))
    >>> held = Triplet(row, "DBD", distance=0.015, preload_force=300.0)
    >>> [round(loads.mean()) for loads in held.ball_loads([0.0] * 6)]  # the third row holds the other two
    [38, 38, 74]
    """

    SENSES: ClassVar[Mapping[str, tuple[int, ...]]] = {
        "DBD": (1, 1, -1),
        "DFD": (-1, -1, 1),
        "DTD": (1, 1, 1),
    }

    arrangement: Threefold

    @cached_property
    def approaches(self) -> tuple[float, float]:
        """Axial approach, without load, of the rings of each tandem row and of the third row, m."""
        if self.preload_force:
            return _approach(self.row, self.preload_force / 2), _approach(self.row, self.preload_force)
        if not self.preload:
            return 0.0, 0.0
        whole = self.preload

        def surplus(third: float) -> float:
            return _thrust(self.row, third) - 2 * _thrust(self.row, whole - third)

        third = float(scipy.optimize.brentq(surplus, 0.0, whole, xtol=1e-18, rtol=1e-14))
        return whole - third, third

    @property
    def lifts(self) -> tuple[float, float, float]:
        """Of the rows at −distance, 0 and +distance, as `approaches` has them, m."""
        tandem, third = self.approaches
        return tandem, tandem, third


def _thrust(row: BallBearing, approach: float) -> float:
    """Axial force of a row whose rings are closer than touching by `approach`, m; N."""
    return float(row.force([0, 0, touching(row) + approach, 0, 0, 0])[2])


def _approach(row: BallBearing, force: float) -> float:
    """How much closer than touching an axial force, N, presses the rings of a row, m."""
    return float(row.displacement([0, 0, force, 0, 0, 0])[2]) - touching(row)
