"""Shift laws: the factors by which temperature stretches relaxation times, a_T, and raises moduli, b_T.

A reduced frequency is f·a_T, a relaxation time at T is τ(T_ref)·a_T; log10 a_T(T_ref) = 0.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Any, Protocol

import numpy as np
import scipy
from numpy.typing import ArrayLike

from bearingdyn.checks import nonnegative, number, positive, reals, require, vector
from bearingdyn.notice import OutsideIsotherms, warn
from bearingdyn.plausible_ranges import plausible
from bearingdyn.short_repr import short
from bearingdyn.types import Array

GAS_CONSTANT = 8.31446261815324
"""Molar gas constant, J/(mol K), exact in the SI of 2019."""

ZERO_CELSIUS = 273.15
"""0 °C in K."""

Covariance = tuple[tuple[float, ...], ...]

Range = tuple[float, float]

_HOTTEST = 500.0  # °C; no polymer lasts there
_FURTHEST = 40.0  # decades; beyond it a relaxation time has no meaning
_JITTER = 0.5  # K; as far as the mean temperature of an isotherm may miss the one that was meant

NUMBERS = "it must be temperatures in °C"


class ShiftLaw(Protocol):
    """What a shift law offers: its reference temperature and log10 a_T."""

    @property
    def T_ref(self) -> float:
        """Reference temperature, °C."""

    def log_shift(self, T: ArrayLike) -> Array:
        """log10 a_T at the temperatures T, °C; same shape as T."""


def _above_zero(field: str, T: float) -> None:
    """ValueError unless T is a finite temperature above absolute zero, °C."""
    remedy = f"it must lie above -{ZERO_CELSIUS} °C and be finite"
    require(number(field, T, remedy) > -ZERO_CELSIUS, field, T, remedy)
    plausible("temperature", field, T)


@dataclass(frozen=True)
class WLF:
    """Shift law of Williams, Landel and Ferry: log10 a_T = −C1 (T − T_ref)/(C2 + T − T_ref).

    Parameters
    ----------
    C1
        Dimensionless, positive.
    C2
        K, positive; the law holds only above T_ref − C2.
    T_ref
        Reference temperature, °C.
    covariance
        Covariance of (C1, C2), 2×2, of a fitted law.
    measured
        Coldest and hottest isotherm it was found from, °C; None if it was not.

    Raises
    ------
    ValueError
        If a constant is not positive or not finite.

    References
    ----------
    M. L. Williams, R. F. Landel, J. D. Ferry, J. Am. Chem. Soc. 77 (1955) 3701.
    """

    C1: float
    C2: float
    T_ref: float
    covariance: Covariance | None = field(default=None, compare=False)
    measured: Range | None = field(default=None, compare=False)

    __repr__ = short

    def __post_init__(self) -> None:
        _check_range("WLF", self.measured)
        if self.covariance is not None:
            vector("WLF.covariance", self.covariance, (2, 2), "of C1 and C2")
        plausible("temperature", "WLF.T_ref", self.T_ref)
        positive("WLF.C1", self.C1)
        positive("WLF.C2", self.C2, "it must be positive and finite, K")

    def log_shift(self, T: ArrayLike) -> Array:
        """log10 a_T at T, °C.

        Raises
        ------
        ValueError
            If a temperature is at or below T_ref − C2, where the law has its pole.
        """
        x = reals("T", T, NUMBERS) - self.T_ref
        if not np.all(self.C2 + x > 0):
            raise ValueError(
                f"T is {np.min(x) + self.T_ref:.6g} °C; this WLF law holds above "
                f"T_ref - C2 = {self.T_ref - self.C2:.6g} °C only"
            )
        return np.asarray(-self.C1 * x / (self.C2 + x))


@dataclass(frozen=True)
class Arrhenius:
    """Shift law of Arrhenius: ln a_T = (Ea/R)(1/T − 1/T_ref), absolute temperatures.

    Parameters
    ----------
    Ea
        Activation energy, J/mol, positive.
    T_ref
        Reference temperature, °C.
    variance
        Variance of Ea, (J/mol)², of a fitted law.
    measured
        Coldest and hottest isotherm it was found from, °C; None if it was not.

    Raises
    ------
    ValueError
        If Ea is not positive, or T_ref not above absolute zero.
    """

    Ea: float
    T_ref: float
    variance: float | None = field(default=None, compare=False)
    measured: Range | None = field(default=None, compare=False)

    __repr__ = short

    def __post_init__(self) -> None:
        _check_range("Arrhenius", self.measured)
        if self.variance is not None:
            nonnegative("Arrhenius.variance", self.variance)
        Ea = positive("Arrhenius.Ea", self.Ea, "it must be positive and finite, J/mol")
        plausible("activation energy", "Arrhenius.Ea", Ea)
        _above_zero("Arrhenius.T_ref", self.T_ref)

    def log_shift(self, T: ArrayLike) -> Array:
        """log10 a_T at T, °C; ValueError at or below absolute zero."""
        kelvin = reals("T", T, NUMBERS) + ZERO_CELSIUS
        if not np.all(kelvin > 0):
            raise ValueError(f"T is {np.min(kelvin) - ZERO_CELSIUS:.6g} °C; it must lie above -273.15 °C")
        slope = self.Ea / (GAS_CONSTANT * math.log(10))
        return np.asarray(slope * (1 / kelvin - 1 / (self.T_ref + ZERO_CELSIUS)))


@dataclass(frozen=True)
class Joined:
    """Shift law joined at Tg, WLF above it and Arrhenius below: log10 a_T = f(T) − f(T_ref).

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
        Covariance of (C1, C2, Tg, Ea), 4×4, of a fitted law.
    measured
        Coldest and hottest isotherm it was found from, °C; None if it was not.

    Raises
    ------
    ValueError
        If a constant is not positive, or a temperature not above absolute zero.
    """

    C1: float
    C2: float
    Tg: float
    Ea: float
    T_ref: float
    covariance: Covariance | None = field(default=None, compare=False)
    measured: Range | None = field(default=None, compare=False)

    __repr__ = short

    def __post_init__(self) -> None:
        _check_range("Joined", self.measured)
        if self.covariance is not None:
            vector("Joined.covariance", self.covariance, (4, 4), "of C1, C2, Tg and Ea")
        for name, unit in (("C1", ""), ("C2", ", K"), ("Ea", ", J/mol")):
            positive(f"Joined.{name}", getattr(self, name), f"it must be positive and finite{unit}")
        plausible("activation energy", "Joined.Ea", self.Ea)
        _above_zero("Joined.Tg", self.Tg)
        _above_zero("Joined.T_ref", self.T_ref)

    def _from_transition(self, T: Array) -> Array:
        above = np.maximum(T - self.Tg, 0.0)
        below = np.minimum(T, self.Tg) + ZERO_CELSIUS
        slope = self.Ea / (GAS_CONSTANT * math.log(10))
        return np.asarray(
            -self.C1 * above / (self.C2 + above) + slope * (1 / below - 1 / (self.Tg + ZERO_CELSIUS))
        )

    def log_shift(self, T: ArrayLike) -> Array:
        """log10 a_T at T, °C; ValueError at or below absolute zero."""
        T = reals("T", T, NUMBERS)
        if not np.all(T > -ZERO_CELSIUS):
            raise ValueError(f"T is {np.min(T):.6g} °C; it must lie above -273.15 °C")
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

    Raises
    ------
    ValueError
        If the lengths differ, a value is not finite, the temperatures do not increase, or T_ref lies outside.
    """

    T: tuple[float, ...]
    log_aT: tuple[float, ...]
    T_ref: float

    __repr__ = short

    def __post_init__(self) -> None:
        for name in ("T", "log_aT"):
            values = reals(f"ShiftTable.{name}", getattr(self, name), "it must be numbers, one a temperature")
            require(values.ndim == 1, f"ShiftTable.{name}", getattr(self, name), "give a list of numbers")
            object.__setattr__(self, name, tuple(values.tolist()))
        object.__setattr__(self, "T_ref", plausible("temperature", "ShiftTable.T_ref", self.T_ref))
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

    @property
    def measured(self) -> Range:
        """Coldest and hottest temperature of the table, °C."""
        return self.T[0], self.T[-1]

    def _check(self, T: Array) -> None:
        if not np.all((T >= self.T[0]) & (T <= self.T[-1])):
            raise ValueError(
                f"T is {T.tolist()!r} °C; free shifts are known from {self.T[0]:.6g} to {self.T[-1]:.6g} °C "
                "only (take law='wlf' or 'arrhenius' to go beyond)"
            )

    def log_shift(self, T: ArrayLike) -> Array:
        """log10 a_T at T, °C; ValueError outside the table."""
        T = reals("T", T, NUMBERS)
        self._check(T)
        curve = scipy.interpolate.PchipInterpolator(self.T, self.log_aT)
        return np.asarray(curve(T) - curve(self.T_ref))


@dataclass(frozen=True)
class RhoT:
    """Law of vertical shift, rubber elasticity: moduli at T are those at T_ref times b_T = ρT/(ρ_ref T_ref).

    Parameters
    ----------
    T_ref
        Reference temperature, °C.
    expansion
        Volumetric thermal expansion, 1/K, 0 to 0.01: ρ = ρ_ref/(1 + expansion (T − T_ref)).

    Raises
    ------
    ValueError
        If T_ref is not above absolute zero, or the expansion is out of range.
    """

    T_ref: float
    expansion: float = 0.0

    __repr__ = short

    def __post_init__(self) -> None:
        _above_zero("RhoT.T_ref", self.T_ref)
        number("RhoT.expansion", self.expansion)
        require(
            0 <= self.expansion < 1e-2,
            "RhoT.expansion",
            self.expansion,
            "it must lie between 0 and 0.01, 1/K (rubber: 6e-4)",
        )

    def factor(self, T: ArrayLike) -> Array:
        """b_T at T, °C; same shape as T. ValueError where ρT is not positive."""
        T = reals("T", T, NUMBERS)
        density = 1 + self.expansion * (T - self.T_ref)
        if not (np.all(T > -ZERO_CELSIUS) and np.all(density > 0)):
            raise ValueError(f"T is {T.tolist()!r} °C; ρT must be positive")
        return np.asarray((T + ZERO_CELSIUS) / (self.T_ref + ZERO_CELSIUS) / density)


Law = WLF | Arrhenius | Joined | ShiftTable


def _check_range(name: str, measured: Range | None) -> None:
    """ValueError unless `measured` is None or two temperatures, °C, the colder first."""
    if measured is None:
        return
    remedy = "it must be the coldest and the hottest isotherm's temperature, °C"
    two = isinstance(measured, tuple) and len(measured) == 2
    require(
        two and -ZERO_CELSIUS < measured[0] <= measured[1] < math.inf, f"{name}.measured", measured, remedy
    )


def moved_shift(owner: str, law: Law, start: float, T: float) -> float:
    """Shift log10 a_T by a law from a temperature `start` to T, °C, for a material named `owner`.

    Warns (OutsideIsotherms) where T lies outside the isotherms the law was found from.

    Raises
    ------
    ValueError
        If T is not a temperature a polymer lasts at, or the law has no meaning there.
    """
    T = number(f"{owner}.at: T", T, "it must be one finite number, °C")
    remedy = (
        f"it must lie between -{ZERO_CELSIUS} and {_HOTTEST:g} °C, where polymers last; is it in K or °F?"
    )
    require(-ZERO_CELSIUS < T <= _HOTTEST, f"{owner}.at: T", T, remedy)
    shift = float(law.log_shift(T) - law.log_shift(start))
    if not abs(shift) <= _FURTHEST:
        raise ValueError(
            f"{owner}.at: T is {T:g} °C; its shift law, {type(law).__name__}, moves it by {shift:.3g} "
            f"decades from {start:g} °C, which has no meaning; stay nearer to the temperatures measured"
        )
    if law.measured is not None and not law.measured[0] - _JITTER <= T <= law.measured[1] + _JITTER:
        warn(
            f"{owner}.at: T is {T:g} °C, outside the isotherms measured, {law.measured[0]:.4g} to "
            f"{law.measured[1]:.4g} °C: there its {type(law).__name__} law extrapolates"
            + ("; is it in K? T is in °C" if T - law.measured[1] > 150 else ""),
            OutsideIsotherms,
        )
    return shift


def law_to_dict(law: Law) -> dict[str, Any]:
    """The numbers of a shift law, ready for JSON; :func:`law_from_dict` reads them back."""
    known = {} if law.measured is None else {"measured": list(law.measured)}
    if isinstance(law, WLF):
        return {"law": "wlf", "C1": law.C1, "C2": law.C2, "T_ref": law.T_ref, **known}
    if isinstance(law, Arrhenius):
        return {"law": "arrhenius", "Ea": law.Ea, "T_ref": law.T_ref, **known}
    if isinstance(law, Joined):
        numbers = {"C1": law.C1, "C2": law.C2, "Tg": law.Tg, "Ea": law.Ea}
        return {"law": "joined", **numbers, "T_ref": law.T_ref, **known}
    return {"law": "free", "T": list(law.T), "log_aT": list(law.log_aT), "T_ref": law.T_ref}


def law_from_dict(data: dict[str, Any]) -> Law:
    """The shift law written by :func:`law_to_dict`; ValueError if the data are not one."""
    ends = data.get("measured") if isinstance(data, dict) else None
    measured = (ends[0], ends[1]) if isinstance(ends, list) and len(ends) == 2 else None
    match data:
        case {"law": "wlf", "C1": C1, "C2": C2, "T_ref": T_ref}:
            return WLF(C1, C2, T_ref, measured=measured)
        case {"law": "arrhenius", "Ea": Ea, "T_ref": T_ref}:
            return Arrhenius(Ea, T_ref, measured=measured)
        case {"law": "joined", "C1": C1, "C2": C2, "Tg": Tg, "Ea": Ea, "T_ref": T_ref}:
            return Joined(C1, C2, Tg, Ea, T_ref, measured=measured)
        case {"law": "free", "T": T, "log_aT": log_aT, "T_ref": T_ref}:
            return ShiftTable(tuple(T), tuple(log_aT), T_ref)
    raise ValueError(
        f"law is {data!r}; it must hold law 'wlf' (C1, C2), 'arrhenius' (Ea), 'joined' (C1, C2, Tg, Ea) or "
        "'free' (T, log_aT), and T_ref"
    )
