"""The five figures of a lubricated contact: films, stiffness and damping, and what carries them."""

from __future__ import annotations

from typing import NamedTuple, Protocol


class Figures(NamedTuple):
    """Figures of a steady film, or their estimated relative errors."""

    Hc: float
    """Film at the centre, h/Rx √(E′Rx/(η0us))."""
    Hmin: float
    """Least film, likewise."""
    H0: float
    """Film h0 of the force law F = κ(δ + h0)^{3/2}, likewise."""
    K0: float
    """Stiffness at low frequency over that of the dry contact, 1.5 F/δ_dry."""
    C0: float
    """Damping at low frequency, c = C0 (F/δ_dry)(2a/us)."""


class _HasFigures(Protocol):
    @property
    def figures(self) -> Figures: ...


class Figured:
    """Something that shows its figures: each of them also by its name."""

    @property
    def Hc(self: _HasFigures) -> float:
        """Film at the centre, h/Rx √(E′Rx/(η0us))."""
        return self.figures.Hc

    @property
    def Hmin(self: _HasFigures) -> float:
        """Least film, likewise."""
        return self.figures.Hmin

    @property
    def H0(self: _HasFigures) -> float:
        """Film h0 of the force law F = κ(δ + h0)^{3/2}, likewise."""
        return self.figures.H0

    @property
    def K0(self: _HasFigures) -> float:
        """Stiffness at low frequency over that of the dry contact, 1.5 F/δ_dry."""
        return self.figures.K0

    @property
    def C0(self: _HasFigures) -> float:
        """Damping at low frequency, c = C0 (F/δ_dry)(2a/us)."""
        return self.figures.C0
