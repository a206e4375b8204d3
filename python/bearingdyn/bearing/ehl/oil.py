"""Viscosity and density over pressure, with the derivatives of their logarithms."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal, TypeAlias

import numpy as np

from bearingdyn.types import Array

Viscosity: TypeAlias = Literal["roelands", "barus"]
Density: TypeAlias = Literal["dowson-higginson", "incompressible"]

_ROELANDS_PRESSURE = 1.96e8  # Pa
_ROELANDS_LOG_VISCOSITY = 9.67  # −ln(6.31e-5 Pa s)
_DOWSON_HIGGINSON_PRESSURE = 5.9e8  # Pa


@dataclass(frozen=True)
class Oil:
    """The oil in a contact: viscosity and density over pressure, for one Hertz pressure."""

    viscosity: Viscosity
    density: Density
    piezo: float
    """α p_h."""
    alpha: float
    """α, 1/Pa."""
    eta0: float
    """η0, Pa s."""

    @property
    def pressure(self) -> float:
        """p_h, Pa."""
        return self.piezo / self.alpha

    def log_viscosity(self, P: Array) -> tuple[Array, Array]:
        """ln η/η0 and its derivative by P."""
        if self.viscosity == "barus" or self.piezo == 0:
            return self.piezo * P, np.full_like(P, self.piezo)
        r = self.pressure / _ROELANDS_PRESSURE
        log0 = math.log(self.eta0) + _ROELANDS_LOG_VISCOSITY
        z = self.piezo / (r * log0)
        base = 1 + r * P
        power = base**z
        return log0 * (power - 1), self.piezo * power / base

    def relative_density(self, P: Array) -> tuple[Array, Array]:
        """ρ/ρ0 and its derivative by P."""
        if self.density == "incompressible":
            return np.ones_like(P), np.zeros_like(P)
        r = self.pressure / _DOWSON_HIGGINSON_PRESSURE
        below = 1 + r * P
        return 1 + 0.34 * r * P / below, 0.34 * r / below**2


def relative_density(p: float) -> float:
    """Density ρ/ρ0 of oil at the pressure p, Pa (D. Dowson, G. R. Higginson 1966)."""
    return 1 + 0.34 * p / (_DOWSON_HIGGINSON_PRESSURE + p)
