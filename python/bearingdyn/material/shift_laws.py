"""Shift laws: the factor a_T by which temperature stretches relaxation times, b_T by which it raises moduli.

A reduced frequency is f·a_T, a relaxation time at T is τ(T_ref)·a_T; log10 a_T(T_ref) = 0.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Any, Protocol

import numpy as np
import scipy
from numpy.typing import ArrayLike

from bearingdyn.types import Array

GAS_CONSTANT = 8.31446261815324
"""Molar gas constant, J/(mol K), exact in the SI of 2019."""

ZERO_CELSIUS = 273.15
"""0 °C in K."""

Covariance = tuple[tuple[float, ...], ...]


class ShiftLaw(Protocol):
    """What a shift law offers: its reference temperature and log10 a_T."""

    @property
    def T_ref(self) -> float:
        """Reference temperature, °C."""

    def log_shift(self, T: ArrayLike) -> Array:
        """log10 a_T at the temperatures T, °C; same shape as T."""


def _finite(name: str, value: float) -> None:
    if not math.isfinite(value):
        raise ValueError(f"{name} is {value!r}; it must be a finite number")


@dataclass(frozen=True)
class WLF:
    """Williams–Landel–Ferry: log10 a_T = −C1 (T − T_ref)/(C2 + T − T_ref).

    Parameters
    ----------
    C1
        Dimensionless, positive.
    C2
        K, positive; the law holds only above T_ref − C2.
    T_ref
        Reference temperature, °C.
    covariance
        Of (C1, C2), 2×2, when fitted.

    Reference: M.L. Williams, R.F. Landel, J.D. Ferry, J. Am. Chem. Soc. 77 (1955) 3701.
    """

    C1: float
    C2: float
    T_ref: float
    covariance: Covariance | None = field(default=None, compare=False)

    def __post_init__(self) -> None:
        _finite("WLF.T_ref", self.T_ref)
        for name, value in (("C1", self.C1), ("C2", self.C2)):
            if not (value > 0 and math.isfinite(value)):
                raise ValueError(f"WLF.{name} is {value!r}; it must be positive and finite")

    def log_shift(self, T: ArrayLike) -> Array:
        """log10 a_T at T, °C.

        Raises
        ------
        ValueError
            If a temperature is at or below T_ref − C2, where the law has its pole.
        """
        x = np.asarray(T, dtype=float) - self.T_ref
        if not np.all(self.C2 + x > 0):
            raise ValueError(
                f"T = {np.min(x) + self.T_ref:.6g} °C: this WLF law holds above "
                f"T_ref - C2 = {self.T_ref - self.C2:.6g} °C only"
            )
        return np.asarray(-self.C1 * x / (self.C2 + x))


@dataclass(frozen=True)
class Arrhenius:
    """Arrhenius: ln a_T = (Ea/R)(1/T − 1/T_ref), absolute temperatures.

    Parameters
    ----------
    Ea
        Activation energy, J/mol, positive.
    T_ref
        Reference temperature, °C.
    variance
        Of Ea, (J/mol)², when fitted.
    """

    Ea: float
    T_ref: float
    variance: float | None = field(default=None, compare=False)

    def __post_init__(self) -> None:
        if not (self.Ea > 0 and math.isfinite(self.Ea)):
            raise ValueError(f"Arrhenius.Ea is {self.Ea!r} J/mol; it must be positive and finite")
        if not (self.T_ref > -ZERO_CELSIUS and math.isfinite(self.T_ref)):
            raise ValueError(f"Arrhenius.T_ref is {self.T_ref!r} °C; it must lie above -273.15 °C")

    def log_shift(self, T: ArrayLike) -> Array:
        """log10 a_T at T, °C; ValueError at or below absolute zero."""
        kelvin = np.asarray(T, dtype=float) + ZERO_CELSIUS
        if not np.all(kelvin > 0):
            raise ValueError(f"T = {np.min(kelvin) - ZERO_CELSIUS:.6g} °C: must lie above -273.15 °C")
        slope = self.Ea / (GAS_CONSTANT * math.log(10))
        return np.asarray(slope * (1 / kelvin - 1 / (self.T_ref + ZERO_CELSIUS)))


@dataclass(frozen=True)
class Joined:
    """WLF above the glass transition, Arrhenius below, joined at Tg: log10 a_T = f(T) − f(T_ref).

    f = −C1 (T − Tg)/(C2 + T − Tg) for T ≥ Tg and (Ea/R ln 10)(1/T − 1/Tg), absolute temperatures, below.

    Parameters
    ----------
    C1, C2
        Dimensionless and K, positive, of the WLF law referred to Tg.
    Tg
        Temperature at which the two meet, °C.
    Ea
        Activation energy below Tg, J/mol, positive.
    T_ref
        Reference temperature, °C; on either side of Tg.
    covariance
        Of (C1, C2, Tg, Ea), 4×4, when fitted.
    """

    C1: float
    C2: float
    Tg: float
    Ea: float
    T_ref: float
    covariance: Covariance | None = field(default=None, compare=False)

    def __post_init__(self) -> None:
        _finite("Joined.T_ref", self.T_ref)
        for name, value in (("C1", self.C1), ("C2", self.C2), ("Ea", self.Ea)):
            if not (value > 0 and math.isfinite(value)):
                raise ValueError(f"Joined.{name} is {value!r}; it must be positive and finite")
        for name, value in (("Tg", self.Tg), ("T_ref", self.T_ref)):
            if not (value > -ZERO_CELSIUS and math.isfinite(value)):
                raise ValueError(f"Joined.{name} is {value!r} °C; it must lie above -273.15 °C")

    def _from_transition(self, T: Array) -> Array:
        above = np.maximum(T - self.Tg, 0.0)
        below = np.minimum(T, self.Tg) + ZERO_CELSIUS
        slope = self.Ea / (GAS_CONSTANT * math.log(10))
        return np.asarray(
            -self.C1 * above / (self.C2 + above) + slope * (1 / below - 1 / (self.Tg + ZERO_CELSIUS))
        )

    def log_shift(self, T: ArrayLike) -> Array:
        """log10 a_T at T, °C; ValueError at or below absolute zero."""
        T = np.asarray(T, dtype=float)
        if not np.all(T > -ZERO_CELSIUS):
            raise ValueError(f"T = {np.min(T):.6g} °C: must lie above -273.15 °C")
        return np.asarray(self._from_transition(T) - self._from_transition(np.asarray(float(self.T_ref))))


@dataclass(frozen=True)
class ShiftTable:
    """Shifts as a table, interpolated monotonically (PCHIP), never extrapolated.

    Parameters
    ----------
    T
        Temperatures, °C, strictly increasing, at least two.
    log_aT
        log10 a_T at each.
    T_ref
        Reference temperature, °C; the table is offset so that log10 a_T(T_ref) = 0.
    """

    T: tuple[float, ...]
    log_aT: tuple[float, ...]
    T_ref: float

    def __post_init__(self) -> None:
        object.__setattr__(self, "T", tuple(float(v) for v in self.T))
        object.__setattr__(self, "log_aT", tuple(float(v) for v in self.log_aT))
        if len(self.T) != len(self.log_aT) or len(self.T) < 2:
            raise ValueError(
                f"ShiftTable: {len(self.T)} temperatures and {len(self.log_aT)} shifts; "
                "must be as many of each, at least two"
            )
        if not np.all(np.diff(self.T) > 0):
            raise ValueError("ShiftTable.T: temperatures must increase strictly and be finite")
        if not np.all(np.isfinite(self.log_aT)):
            raise ValueError("ShiftTable.log_aT: every shift must be finite")
        self._check(np.asarray(self.T_ref))

    def _check(self, T: Array) -> None:
        if not np.all((T >= self.T[0]) & (T <= self.T[-1])):
            raise ValueError(
                f"T is {T.tolist()!r} °C; free shifts are known from {self.T[0]:.6g} to {self.T[-1]:.6g} °C "
                "only "
                "(take law='wlf' or 'arrhenius' to go beyond)"
            )

    def log_shift(self, T: ArrayLike) -> Array:
        """log10 a_T at T, °C; ValueError outside the table."""
        T = np.asarray(T, dtype=float)
        self._check(T)
        curve = scipy.interpolate.PchipInterpolator(self.T, self.log_aT)
        return np.asarray(curve(T) - curve(self.T_ref))


@dataclass(frozen=True)
class RhoT:
    """Vertical shift of rubber elasticity: moduli at T are those at T_ref times b_T = ρT/(ρ_ref T_ref).

    Parameters
    ----------
    T_ref
        Reference temperature, °C.
    expansion
        Volumetric thermal expansion, 1/K, ≥ 0: ρ = ρ_ref/(1 + expansion (T − T_ref)).
    """

    T_ref: float
    expansion: float = 0.0

    def __post_init__(self) -> None:
        if not (self.T_ref > -ZERO_CELSIUS and math.isfinite(self.T_ref)):
            raise ValueError(f"RhoT.T_ref is {self.T_ref!r} °C; it must lie above -273.15 °C")
        if not 0 <= self.expansion < 1e-2:
            raise ValueError(
                f"RhoT.expansion is {self.expansion!r} 1/K; it must lie between 0 and 0.01 (rubber: 6e-4)"
            )

    def factor(self, T: ArrayLike) -> Array:
        """b_T at T, °C; same shape as T. ValueError where ρT is not positive."""
        T = np.asarray(T, dtype=float)
        density = 1 + self.expansion * (T - self.T_ref)
        if not (np.all(T > -ZERO_CELSIUS) and np.all(density > 0)):
            raise ValueError(f"T is {T.tolist()!r} °C; ρT must be positive")
        return np.asarray((T + ZERO_CELSIUS) / (self.T_ref + ZERO_CELSIUS) / density)


Law = WLF | Arrhenius | Joined | ShiftTable


def law_to_dict(law: Law) -> dict[str, Any]:
    """The numbers of a law, ready for JSON; :func:`law_from_dict` reads them back."""
    if isinstance(law, WLF):
        return {"law": "wlf", "C1": law.C1, "C2": law.C2, "T_ref": law.T_ref}
    if isinstance(law, Arrhenius):
        return {"law": "arrhenius", "Ea": law.Ea, "T_ref": law.T_ref}
    if isinstance(law, Joined):
        numbers = {"C1": law.C1, "C2": law.C2, "Tg": law.Tg, "Ea": law.Ea}
        return {"law": "joined", **numbers, "T_ref": law.T_ref}
    return {"law": "free", "T": list(law.T), "log_aT": list(law.log_aT), "T_ref": law.T_ref}


def law_from_dict(data: dict[str, Any]) -> Law:
    """The law written by :func:`law_to_dict`; ValueError if it is none."""
    match data:
        case {"law": "wlf", "C1": C1, "C2": C2, "T_ref": T_ref}:
            return WLF(C1, C2, T_ref)
        case {"law": "arrhenius", "Ea": Ea, "T_ref": T_ref}:
            return Arrhenius(Ea, T_ref)
        case {"law": "joined", "C1": C1, "C2": C2, "Tg": Tg, "Ea": Ea, "T_ref": T_ref}:
            return Joined(C1, C2, Tg, Ea, T_ref)
        case {"law": "free", "T": T, "log_aT": log_aT, "T_ref": T_ref}:
            return ShiftTable(tuple(T), tuple(log_aT), T_ref)
    raise ValueError(
        f"law is {data!r}; it must hold law 'wlf' (C1, C2), 'arrhenius' (Ea), 'joined' (C1, C2, Tg, Ea) or "
        "'free' (T, log_aT), and T_ref"
    )
