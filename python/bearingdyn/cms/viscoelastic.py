"""The viscoelastic materials inside a part."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np
import scipy

from bearingdyn.checks import positive
from bearingdyn.cms.frozen_matrices import check_symmetry, frozen, frozen_sparse
from bearingdyn.short_repr import short
from bearingdyn.types import Array


class ComplexModulus(Protocol):
    """A viscoelastic material as a reduction needs it: its shear modulus depends on the frequency."""

    def complex_modulus(self, omega: Any) -> Any:
        """G*(ω) in Pa for ω in rad/s."""


@dataclass(frozen=True, eq=False)
class Viscoelastic:
    """One viscoelastic material inside a superelement, or inside a full model.

    Parameters
    ----------
    material
        Anything with ``complex_modulus(omega)``; the time domain needs a Maxwell model.
    H
        (n, n) ∫BᵀT2B dV, m, dense if reduced and sparse (csr) if not; the deviatoric stiffness is 2·G*(ω)·H
        (paper (16), (23)).
    volume
        Of the material, m³: its mean square shear strain is 2 xᵀHx/volume. None where it is not known; a law
        of softening needs it.
    concentration
        (n,) strain that counts for a law of softening over the rms one, by coordinate; None: 1.
    """

    material: ComplexModulus
    H: Any
    volume: float | None = None
    concentration: Array | None = None

    __repr__ = short

    def __post_init__(self) -> None:
        if not callable(getattr(self.material, "complex_modulus", None)):
            raise ValueError(
                f"material is {self.material!r}; a viscoelastic material must have complex_modulus(omega)"
            )
        sparse = scipy.sparse.issparse(self.H)
        n = self.H.shape[0] if sparse else np.shape(self.H)[0] if np.ndim(self.H) else 0
        H = frozen_sparse("H", self.H, n) if sparse else frozen("H", self.H, (n, n))
        check_symmetry("H", H, 1)
        object.__setattr__(self, "H", H)
        if self.volume is not None:
            positive("volume", self.volume, "it must be a positive volume in m³")
        if self.concentration is not None:
            object.__setattr__(self, "concentration", frozen("concentration", self.concentration, (n,)))
