"""How well a law of softening renders the strain sweep it was fitted to."""

from __future__ import annotations

from dataclasses import dataclass, field

from bearingdyn.short_repr import short
from bearingdyn.types import Array


@dataclass(frozen=True)
class PayneFit:
    """Report of a fitted law of softening: how well it renders the sweep over amplitude.

    Attributes
    ----------
    frequency, temperature
        Of the sweep, Hz and °C.
    strain
        Shear strain of the points used, a fraction, (n,).
    storage, loss
        Measured moduli, Pa, (n,).
    linear
        What the law is added to at this frequency: G* of the sweep less F + iL, Pa.
    storage_max, tan_delta_max
        Largest relative deviation of G′ and of tan δ.
    D_range
        Lowest and highest D that the sweep does not refute with 90 % confidence (F test), and with which the
        law keeps a spring, F ≥ L; the lowest is taken. inf where a larger D is always as good.
    """

    frequency: float
    temperature: float
    strain: Array = field(compare=False, repr=False)
    storage: Array = field(compare=False, repr=False)
    loss: Array = field(compare=False, repr=False)
    linear: complex
    storage_max: float
    tan_delta_max: float
    D_range: tuple[float, float]
    source: str = ""

    __repr__ = short

    @property
    def D_known(self) -> bool:
        """Whether the sweep holds D within a factor of two."""
        return self.D_range[1] < 2 * self.D_range[0]
