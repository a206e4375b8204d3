"""Surfaces of a part that radiate sound."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from bearingdyn.checks import positive
from bearingdyn.cms.frozen_matrices import check_symmetry, frozen
from bearingdyn.short_repr import short
from bearingdyn.types import Array


@dataclass(frozen=True, eq=False)
class Surface:
    """A surface of a part that radiates sound: ∫ v_n² dA = q̇ᵀ W q̇ of its normal velocity v_n.

    Parameters
    ----------
    area
        m².
    W
        (n, n) symmetric, m².
    """

    area: float
    W: Array

    __repr__ = short

    def __post_init__(self) -> None:
        positive("area", self.area, "it must be a positive area in m²")
        n = np.shape(self.W)[0] if np.ndim(self.W) else 0
        W = frozen("W", self.W, (n, n))
        check_symmetry("W", W, 1)
        object.__setattr__(self, "W", W)
