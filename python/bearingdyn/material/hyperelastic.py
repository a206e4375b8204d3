"""Strain energies of rubber at finite strain: neo-Hookean, Mooney–Rivlin and Yeoh.

Each is W(Ī1, Ī2) of the invariants of the isochoric left Cauchy–Green tensor b̄ = J^(−2/3) F Fᵀ, per unit
of its own initial shear modulus: what a part is made of (its relaxed modulus and K) stays in the material,
and the law says only how the stress goes on from there. The energy of volume, ½K(J − 1)², is the same for
all.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol, runtime_checkable

import numpy as np
from numpy.typing import ArrayLike

from bearingdyn.checks import number, require
from bearingdyn.pictures import page
from bearingdyn.types import Array

Derivatives = tuple[Array, Array, Array, Array]


@runtime_checkable
class Hyperelastic(Protocol):
    """A hyperelastic law: strain energy of Ī1 and Ī2 for a shear modulus of one."""

    def derivatives(self, I1: ArrayLike, I2: ArrayLike) -> Derivatives:
        """W, ∂W/∂Ī1, ∂W/∂Ī2 and ∂²W/∂Ī1², of the shape of I1 and I2."""


def _checked(law: str, leading: float, names: str) -> None:
    require(leading > 0, names, leading, f"{law} needs it positive: twice this sum is its shear modulus")


@dataclass(frozen=True)
class NeoHooke:
    """Hyperelastic, neo-Hookean rubber, W = ½G(Ī1 − 3): right to some 30 % of strain if little filled."""

    _repr_html_ = page

    def derivatives(self, I1: ArrayLike, I2: ArrayLike) -> Derivatives:
        """W, ∂W/∂Ī1, ∂W/∂Ī2 and ∂²W/∂Ī1² for a shear modulus of one."""
        I1 = np.asarray(I1, dtype=np.float64)
        return 0.5 * (I1 - 3.0), np.full_like(I1, 0.5), np.zeros_like(I1), np.zeros_like(I1)


@dataclass(frozen=True)
class MooneyRivlin:
    """Hyperelastic Mooney–Rivlin rubber, W = C10(Ī1 − 3) + C01(Ī2 − 3), scaled to the shear modulus.

    Parameters
    ----------
    C10, C01
        In any unit, such as Pa from a test: only their ratio counts, for 2(C10 + C01) is the shear modulus,
        which the material gives.

    Raises
    ------
    ValueError
        For coefficients that are not finite, or whose sum is not positive.
    """

    C10: float
    C01: float

    _repr_html_ = page

    def __post_init__(self) -> None:
        for name in ("C10", "C01"):
            object.__setattr__(self, name, number(f"MooneyRivlin.{name}", getattr(self, name)))
        _checked("Mooney–Rivlin", self.C10 + self.C01, "MooneyRivlin.C10 + C01")

    def derivatives(self, I1: ArrayLike, I2: ArrayLike) -> Derivatives:
        """W, ∂W/∂Ī1, ∂W/∂Ī2 and ∂²W/∂Ī1² for a shear modulus of one."""
        I1, I2 = np.asarray(I1, dtype=np.float64), np.asarray(I2, dtype=np.float64)
        scale = 0.5 / (self.C10 + self.C01)
        a, b = scale * self.C10, scale * self.C01
        return a * (I1 - 3.0) + b * (I2 - 3.0), np.full_like(I1, a), np.full_like(I1, b), np.zeros_like(I1)


@dataclass(frozen=True)
class Yeoh:
    """Hyperelastic Yeoh rubber, W = C10(Ī1 − 3) + C20(Ī1 − 3)² + C30(Ī1 − 3)³, scaled to the shear modulus.

    Parameters
    ----------
    C10, C20, C30
        In any unit, such as Pa from a test: only their ratios count, for 2·C10 is the shear modulus, which
        the material gives. Filled rubber has C20 < 0 < C30.

    Raises
    ------
    ValueError
        For coefficients that are not finite, or a C10 that is not positive.
    """

    C10: float
    C20: float
    C30: float = 0.0

    _repr_html_ = page

    def __post_init__(self) -> None:
        for name in ("C10", "C20", "C30"):
            number(f"Yeoh.{name}", getattr(self, name))
        _checked("Yeoh", self.C10, "Yeoh.C10")

    def derivatives(self, I1: ArrayLike, I2: ArrayLike) -> Derivatives:
        """W, ∂W/∂Ī1, ∂W/∂Ī2 and ∂²W/∂Ī1² for a shear modulus of one."""
        x = np.asarray(I1, dtype=np.float64) - 3.0
        b, c = 0.5 * self.C20 / self.C10, 0.5 * self.C30 / self.C10
        return (
            x * (0.5 + x * (b + x * c)),
            0.5 + x * (2.0 * b + 3.0 * c * x),
            np.zeros_like(x),
            2.0 * b + 6.0 * c * x,
        )


NEO_HOOKE = NeoHooke()
