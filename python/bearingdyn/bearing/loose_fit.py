"""A ring with clearance in its bore or on its shaft: radial contact that opens and closes, no friction."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from bearingdyn.bearing.kernel import BearingKernel
from bearingdyn.bearing.raceway_series import RacewaySeries
from bearingdyn.checks import nonnegative, positive, require, whole
from bearingdyn.plausible_ranges import plausible
from bearingdyn.types import Index

_SCALE = 1.0  # m; radial motion alone: no result depends on it


@dataclass(frozen=True)
class LooseFit:
    """A loose fit: the seat of a flexible ring, an outer one in its bore or an inner one on its shaft.

    Bore and shaft are rigid interfaces, or move by the same orders as the ring does, as the groove of another
    body of revolution. The gap is closed at stations around the circumference, each a stiff spring
    F = κ δ^{3/2} that only pushes; the contact kernel of the balls computes it, the stations standing still.
    Friction and shoulders, which keep the ring from sliding along the bore and tilting in it, are linear
    springs. In a march, a hard seat that opens and closes costs tenths of a millisecond a step.

    Parameters
    ----------
    clearance
        Bore less outside of the ring, or bore of the ring less shaft, diametral, m.
    stations
        Number of them, twelve or more, and more than twice the highest order of the ring: between two of n a
        ring moves 1/cos(π/n) of the gap, 3.5 % too far at twelve, 0.14 % at sixty.
    kappa
        Of one station, N/m^1.5: at the default 1 kN gives 0.1 µm.
    hold
        Stiffness against sliding along z and, at the ring's radius, against tilting, N/m.

    Raises
    ------
    ValueError
        Naming the field, its value and what would be right.
    """

    clearance: float
    stations: int = 60
    kappa: float = 3e13
    hold: float = 1e8

    def __post_init__(self) -> None:
        gap = nonnegative("clearance", self.clearance, "it must be zero or positive, in m (diametral)")
        plausible("mount clearance", "clearance", gap)
        whole(
            "stations",
            self.stations,
            12,
            remedy="it must be a whole number, 12 or more: between fewer a ring moves farther than its gap",
        )
        kappa = positive("kappa", self.kappa, "it must be positive and finite, in N/m^1.5")
        plausible("deflection coefficient", "kappa", kappa)
        hold = positive("hold", self.hold, "it must be positive and finite, in N/m")
        plausible("stiffness", "hold", hold)

    @property
    def Z(self) -> int:
        """Number of stations."""
        return int(self.stations)

    def turned(self, angle: float) -> LooseFit:
        """The fit with the cage at `angle`, rad: itself."""
        return self

    def kernel(self, series: RacewaySeries) -> BearingKernel:
        """The fit as the contact kernel takes it: radial coefficients alone, ring less bore.

        Raises
        ------
        ValueError
            For a series with axial terms, or too fine for the stations.
        """
        axial, order, sine = series.columns
        require(not axial.any(), "series", series.terms, "a loose fit takes radial terms only")
        least = 2 * int(order.max()) + 1
        require(
            self.stations >= least, "stations", self.stations, f"it must be {least} or more for this ring"
        )
        half = self.clearance / 2
        return BearingKernel(
            Z=self.Z,
            axial=axial,
            order=order,
            sine=sine,
            x0=0.0,
            y0=_SCALE - half,
            A=_SCALE,
            e0=-half * (2 * _SCALE - half),
            kappa=self.kappa,
            h0=0.0,
            damping_law="constant",
            damping_c=0.0,
            cage_ratio=0.0,
        )

    def split(self, series: RacewaySeries) -> tuple[Index, RacewaySeries, Index]:
        """Places of the radial terms, their series, and places of the axial terms that `hold` acts on."""
        radial = [k for k, (axial, _, _) in enumerate(series.terms) if not axial]
        held = [k for k, (axial, order, _) in enumerate(series.terms) if axial and order <= 1]
        return (
            np.array(radial, dtype=np.intp),
            RacewaySeries(tuple(series.terms[k] for k in radial)),
            np.array(held, dtype=np.intp),
        )
