"""What the contact kernel is told about a bearing."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from bearingdyn.bearing.contact_damping import Law
from bearingdyn.bearing.imperfections import Imperfections
from bearingdyn.checks import require
from bearingdyn.short_repr import short
from bearingdyn.types import Array


@dataclass(frozen=True, eq=False)
class BearingKernel:
    """One bearing as the contact kernel sees it.

    Groove-centre displacement of the inner race relative to the outer, a Fourier series in the azimuth ψ:
    radial dY(ψ) and axial dX(ψ), each the sum of its coefficients z_k times cos or sin of order[k]·ψ.
    The groove centres stand at (x0 + dX, y0 + dY); δ is their distance less A. Ball j (from 1) is at
    ψ_j = angle + 2π(j − 1)/Z, where `angle` is what the caller passes: at the start of a run, `angle0`.
    """

    Z: int
    """Number of balls."""
    axial: NDArray[np.intc]
    """(n,) 0 for a radial coefficient, 1 for an axial one."""
    order: NDArray[np.intc]
    """(n,) order in the azimuth, ≥ 0."""
    sine: NDArray[np.intc]
    """(n,) 0 for cos, 1 for sin."""
    x0: float
    """Axial distance of the groove centres at z = 0, m."""
    y0: float
    """Radial distance of the groove centres at z = 0, m."""
    A: float
    """Distance of the groove centres at which a ball just touches both races, m."""
    e0: float
    """x0² + y0² − A², formed without cancellation, m²."""
    kappa: float
    """Deflection coefficient of both contacts of a ball in series, N/m^1.5."""
    h0: float
    """Film thickness of both contacts of a ball together, m."""
    damping_law: Law
    damping_c: float
    """c in N s/m ("constant"), damping time in s ("load"), scale in m ("film", "carried"); 0 for "table"."""
    damping_table: Array = field(default_factory=lambda: np.zeros((0, 2)))
    """(n, 2) rows (δ in m, c in N s/m), "table", or c and its rise per cell, N s/m, "film", s, "carried"."""
    echoes: Array = field(default_factory=lambda: np.zeros((0, 4)))
    """(n, 4) rows of decay and strength, 1/s, real and imaginary parts, "carried"; else empty."""
    cage_ratio: float = 0.5
    """Cage speed over shaft speed."""
    angle0: float = 0.0
    """Azimuth of the first ball at the start, rad."""
    inner_ratio: float = 1.0
    """Speed of the inner ring over that of the shaft."""
    outer_ratio: float = 0.0
    """Speed of the outer ring over that of the shaft."""
    shoulder: int = 0
    """+1, −1: axial load on the inner ring is borne towards +z, −z only; 0: both ways."""
    open_sine: float = 0.0
    """Sine of the contact angle on the open side from which a ball runs off."""
    give: float = 0.0
    """Compliance that the ring adds to Hertz at a ball of its own, m/N; negative where a wall stiffens it."""
    imperfections: Imperfections = field(default_factory=Imperfections)
    """Waves, pits and unequal balls; none by default."""

    __repr__ = short

    def stored(self, loads: Array) -> float:
        """Energy, J, of the contacts under loads (Z,), N: ∫κ u³ ds = (2/5) F u² + ½ give F², κ u³ = F."""
        return float((loads * (0.4 * (loads / self.kappa) ** (2 / 3) + 0.5 * self.give * loads)).sum())

    def packed(self) -> dict[str, object]:
        """The fields by name, as the core parses them (bd_bearing_data).

        Raises
        ------
        ValueError
            Unless all radial coefficients come before the axial ones.
        """
        axial = np.asarray(self.axial)
        ordered = not np.any(np.diff(axial) < 0)
        require(ordered, "axial", self.axial, "list all radial coefficients (0) before the axial ones (1)")
        return {
            "n_balls": self.Z,
            "order": self.order,
            "sine": self.sine,
            "n_radial": int(np.count_nonzero(axial == 0)),
            "x0": self.x0,
            "y0": self.y0,
            "A": self.A,
            "e0": self.e0,
            "kappa": self.kappa,
            "h0": self.h0,
            "give": self.give,
            "law": self.damping_law,
            "c": self.damping_c,
            "table": np.asarray(self.damping_table, dtype=np.float64).reshape(-1, 2),
            "echoes": np.asarray(self.echoes, dtype=np.float64).reshape(-1, 4),
            "cage_ratio": self.cage_ratio,
            "angle0": self.angle0,
            "inner_ratio": self.inner_ratio,
            "outer_ratio": self.outer_ratio,
            "shoulder": self.shoulder,
            "open_sine": self.open_sine,
            "imperfections": self.imperfections.packed(),
        }
