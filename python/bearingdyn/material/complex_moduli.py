"""Complex moduli for the direct harmonic analysis (paper §3.2): tabulated, a power law, fractional Zener.

Each has `complex_modulus(omega)` like the Maxwell model, so that harmonic analyses take it as it is, `at(T)`
if it has a shift law, and `maxwell(n, band)`, its approximation for the time domain with the error of it.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from typing import Literal

import numpy as np
import scipy
from numpy.typing import ArrayLike

from bearingdyn.checks import instance, number, positive, real, require, two
from bearingdyn.material.amplitude import Payne, Softening
from bearingdyn.material.bulk_relaxation import BulkRelaxation
from bearingdyn.material.dma import DMAData
from bearingdyn.material.identification import fit_maxwell
from bearingdyn.material.low_end import LowEnd
from bearingdyn.material.maxwell import Maxwell
from bearingdyn.material.reach_of_data import warn_beyond
from bearingdyn.material.shift_laws import Law, ShiftTable, moved_shift
from bearingdyn.material.superposition import MasterCurve, one_curve
from bearingdyn.pictures import picture
from bearingdyn.plausible_ranges import check_density, check_waves, plausible
from bearingdyn.short_repr import short
from bearingdyn.types import Array, Complex

_PER_DECADE = 40  # points at which a modulus is handed to the fit


def _check_companions(owner: str, model: TabulatedModulus | PowerLaw | FractionalZener) -> None:
    """ValueError for a law, a temperature, a softening or a volume that is none."""
    law, T = model.law, model.temperature
    is_law = law is None or (not isinstance(law, type) and callable(getattr(law, "log_shift", None)))
    require(is_law, f"{owner}.law", law, "give a law of shifts, as WLF(C1, C2, T_ref)")
    if T is not None:
        number(f"{owner}.temperature", T, "it must be a temperature in °C, or None")
    instance(f"{owner}.payne", model.payne, (Payne, type(None)), "give a Payne law, as fit_payne(...)")
    instance(f"{owner}.bulk", model.bulk, (BulkRelaxation, type(None)), "give a BulkRelaxation, or None")


def _check(owner: str, values: dict[str, float]) -> None:
    """ValueError naming the first of the values that is not positive, or the density if no solid has it."""
    for name, value in values.items():
        positive(f"{owner}.{name}", value)
    check_density(f"{owner}.density", values["density"])
    plausible("bulk modulus", f"{owner}.K", values["K"])
    check_waves(f"{owner}.K", values["K"], values["density"])


def _approximate(
    modulus: Callable[[ArrayLike], Complex],
    band: tuple[float, float],
    n: int | Literal["auto"],
    K: float,
    density: float,
    law: Law | None,
    temperature: float | None,
    tolerance: float,
) -> Maxwell:
    """Maxwell model of a modulus in a band, Hz; its `fit` holds the rms and largest error."""
    low, high = two("band", band, "it must be a lower and a higher frequency, both positive, Hz")
    if not 0 < low < high < math.inf:
        raise ValueError(f"band is {band!r} Hz; it must be a lower and a higher frequency, both positive")
    count = max(40, round(_PER_DECADE * math.log10(high / low)))
    f = np.geomspace(low, high, count)
    f[0], f[-1] = low, high  # to the last bit
    G = modulus(2 * np.pi * f)
    T = 20.0 if temperature is None else temperature
    stand_in = ShiftTable((T - 1.0, T + 1.0), (0.0, 0.0), T)
    points = MasterCurve(
        f, G.real, G.imag, np.full(count, T), "shear", T, {}, {}, law or stand_in, 0.0, (0.0, 0.0)
    )
    found = fit_maxwell(points, n, (low, high), K=K, density=density, tolerance=tolerance)
    return replace(found, law=law, temperature=temperature)


def _factor(owner: str, law: Law | None, temperature: float | None, T: float) -> float:
    """a_T from the temperature at which the modulus `owner` holds to T, °C."""
    if law is None or temperature is None:
        raise ValueError("law is None: a material can be moved to another temperature only by a shift law")
    return float(10 ** moved_shift(owner, law, temperature, T))


@dataclass(frozen=True, eq=False)
class TabulatedModulus(Softening):
    """Complex modulus as a table in shear: ln G′ and ln tan δ interpolated over ln f, monotonically.

    Parameters
    ----------
    frequency
        Hz, (n,), rising, at least two.
    storage, loss
        Shear moduli, Pa, (n,), positive.
    K, density
        Bulk modulus, Pa, and density, kg/m³.
    law, temperature
        Shift law, and the temperature, °C, at which the table holds, for :meth:`at`.
    payne
        Law of softening with the amplitude of strain; None for none.
    bulk
        Relaxation of the bulk modulus, whose value at rest K then is; None: K is constant.

    Raises
    ------
    ValueError
        If a value is out of range, or a modulus is asked for outside the table. At rest it is the lowest
        storage modulus.
    """

    frequency: Array
    storage: Array
    loss: Array
    K: float
    density: float
    law: Law | None = None
    temperature: float | None = None
    payne: Payne | None = None
    bulk: BulkRelaxation | None = None

    __repr__ = short

    def _repr_html_(self) -> str:
        return str(picture("as_html", self))

    def __post_init__(self) -> None:
        _check_companions("TabulatedModulus", self)
        _check("TabulatedModulus", {"K": self.K, "density": self.density})
        for name in ("frequency", "storage", "loss"):
            try:
                values = real(getattr(self, name))
            except (TypeError, ValueError):
                remedy = "it must be real numbers, two or more"
                require(False, f"TabulatedModulus.{name}", getattr(self, name), remedy)
                raise
            if values.ndim != 1 or values.size < 2 or values.size != np.size(self.frequency):
                raise ValueError(
                    f"TabulatedModulus.{name} has shape {values.shape}; it must be one-dimensional, with "
                    "two values or more, and as many as there are frequencies"
                )
            if not (np.all(values > 0) and np.all(np.isfinite(values))):
                raise ValueError(f"TabulatedModulus.{name}: every value must be positive and finite")
            kind = {"frequency": "frequency", "storage": "shear modulus"}.get(name, "branch modulus")
            for limit in (values.min(), values.max()):
                plausible(kind, f"TabulatedModulus.{name}", float(limit))
            values.flags.writeable = False
            object.__setattr__(self, name, values)
        if not np.all(np.diff(self.frequency) > 0):
            raise ValueError(f"TabulatedModulus.frequency is {self.frequency!r}; it must rise strictly, Hz")

    @property
    def low_end(self) -> LowEnd:
        """The table says nothing of times beyond its lowest frequency; a static answer there warns."""
        return LowEnd.of_band(float(self.frequency[0]), float(self.storage[0]))

    @classmethod
    def from_master(
        cls, master: MasterCurve | DMAData, *, K: float, density: float, per_decade: int = 10
    ) -> TabulatedModulus:
        """A master curve, or one sweep, in shear as a table: points averaged geometrically in classes.

        ValueError if the curve is in tension (``master.to_shear`` first).
        """
        master = one_curve(master)
        if master.mode != "shear":
            raise ValueError("master is in tension: convert it by master.to_shear(K=...) or to_shear(nu=...)")
        logs = np.log(np.array([master.frequency, master.storage, master.loss]))
        cell = np.floor(per_decade * logs[0] / math.log(10)).astype(np.int64)
        kinds = np.unique(cell)
        f, storage, loss = np.exp([[row[cell == c].mean() for c in kinds] for row in logs])
        return cls(f, storage, loss, K, density, master.law, master.T_ref)

    def complex_modulus(self, omega: ArrayLike, *, doubt: bool = True) -> Complex:
        """G*(ω), Pa, at ω rad/s, any shape; ValueError outside the table.

        Parameters
        ----------
        omega
            Angular frequency, rad/s, any shape; at rest the answer is that of the lowest frequency.
        doubt
            Warn of rest, which no table reaches.

        Warns
        -----
        BeyondData
            At ω = 0.
        """
        omega = np.asarray(omega, dtype=np.float64)
        f = np.abs(omega) / (2 * np.pi)
        low, high = self.frequency[0], self.frequency[-1]
        rest = f == 0
        inside = rest | ((f >= low * (1 - 1e-9)) & (f <= high * (1 + 1e-9)))
        if not np.all(inside):
            raise ValueError(
                f"omega is {omega[~inside].flat[0]:.6g} rad/s; the table reaches from {low:.6g} to "
                f"{high:.6g} Hz"
            )
        if doubt and np.any(rest):
            warn_beyond([("the table", self)], math.inf, "the modulus at rest, at 0 Hz,")
        x = np.log(np.clip(np.where(rest, low, f), low, high))
        storage = np.exp(scipy.interpolate.PchipInterpolator(np.log(self.frequency), np.log(self.storage))(x))
        tan = np.exp(
            scipy.interpolate.PchipInterpolator(np.log(self.frequency), np.log(self.loss / self.storage))(x)
        )
        return np.asarray(storage * (1 + 1j * np.sign(omega) * tan))

    def at(self, T: float) -> TabulatedModulus:
        """The same material at T, °C: frequencies over a_T; warnings and errors as :meth:`Maxwell.at`."""
        factor = _factor("TabulatedModulus", self.law, self.temperature, T)
        bulk = None if self.bulk is None else self.bulk.moved(factor)
        return replace(self, frequency=self.frequency / factor, temperature=float(T), bulk=bulk)

    def maxwell(
        self,
        n: int | Literal["auto"] = 5,
        band: tuple[float, float] | None = None,
        tolerance: float = 0.02,
    ) -> Maxwell:
        """Its Maxwell approximation in a band, Hz (the table unless given); `fit` holds the error."""
        band = band or (float(self.frequency[0]), float(self.frequency[-1]))
        made = _approximate(
            self.complex_modulus, band, n, self.K, self.density, self.law, self.temperature, tolerance
        )
        return replace(made.with_payne(self.payne), bulk=self.bulk)


@dataclass(frozen=True)
class PowerLaw(Softening):
    """Complex modulus by a power law, the paper's "simple exponential function": G* = G_ref (iω/ω_ref)^α.

    |G*| grows as ω^α and the loss factor is tan(απ/2) at all frequencies: the only causal modulus with a
    constant loss factor.

    Parameters
    ----------
    modulus
        |G*| at the reference frequency, Pa.
    exponent
        α, 0 < α < 1.
    frequency
        Reference frequency, Hz.
    K, density
        Bulk modulus, Pa, and density, kg/m³.
    law, temperature
        Shift law, and the temperature, °C, at which the modulus holds, for :meth:`at`.
    payne
        Law of softening with the amplitude of strain; None for none.
    bulk
        Relaxation of the bulk modulus, whose value at rest K then is; None: K is constant.

    Raises
    ------
    ValueError
        If a value is outside its range or not finite.

    References
    ----------
    Paper §3.2.
    """

    modulus: float
    exponent: float
    frequency: float
    K: float
    density: float
    law: Law | None = None
    temperature: float | None = None
    payne: Payne | None = None
    bulk: BulkRelaxation | None = None

    def _repr_html_(self) -> str:
        return str(picture("as_html", self))

    def __post_init__(self) -> None:
        values = {"modulus": self.modulus, "frequency": self.frequency, "K": self.K, "density": self.density}
        _check_companions("PowerLaw", self)
        _check("PowerLaw", values)
        plausible("shear modulus", "PowerLaw.modulus", self.modulus)
        exponent = number("PowerLaw.exponent", self.exponent)
        require(0 < exponent < 1, "PowerLaw.exponent", self.exponent, "it must lie between 0 and 1")

    @classmethod
    def of_loss_factor(
        cls, modulus: float, loss_factor: float, frequency: float, *, K: float, density: float
    ) -> PowerLaw:
        """By the loss factor: α = (2/π) arctan η. ValueError unless it is positive."""
        positive("loss_factor", loss_factor)
        return cls(modulus, 2 / math.pi * math.atan(loss_factor), frequency, K, density)

    def complex_modulus(self, omega: ArrayLike) -> Complex:
        """G*(ω), Pa, at ω rad/s, any shape; the conjugate at −ω, 0 at rest."""
        x = np.asarray(omega, dtype=np.float64) / (2 * np.pi * self.frequency)
        turn = np.exp(0.5j * np.pi * self.exponent * np.sign(x))
        return np.asarray(self.modulus * np.abs(x) ** self.exponent * turn)

    def at(self, T: float) -> PowerLaw:
        """The same material at T, °C; warnings and errors as :meth:`Maxwell.at`."""
        factor = _factor("PowerLaw", self.law, self.temperature, T)
        bulk = None if self.bulk is None else self.bulk.moved(factor)
        return replace(self, frequency=self.frequency / factor, temperature=float(T), bulk=bulk)

    def maxwell(
        self, n: int | Literal["auto"] = 5, *, band: tuple[float, float], tolerance: float = 0.02
    ) -> Maxwell:
        """Its Maxwell approximation in a band, Hz; `fit` holds the error."""
        made = _approximate(
            self.complex_modulus, band, n, self.K, self.density, self.law, self.temperature, tolerance
        )
        return replace(made.with_payne(self.payne), bulk=self.bulk)


@dataclass(frozen=True)
class FractionalZener(Softening):
    """Complex modulus by a fractional Zener model: G* = (G0 + G∞ (iωτ)^α)/(1 + (iωτ)^α).

    Parameters
    ----------
    G0, G_inf
        Relaxed and unrelaxed modulus, Pa, 0 ≤ G0 < G_inf.
    tau
        Relaxation time, s.
    alpha
        Order, 0 < alpha ≤ 1; 1 is the Maxwell model with one branch.
    K, density
        Bulk modulus, Pa, and density, kg/m³.
    law, temperature
        Shift law, and the temperature, °C, at which tau holds, for :meth:`at`.
    payne
        Law of softening with the amplitude of strain; None for none.
    bulk
        Relaxation of the bulk modulus, whose value at rest K then is; None: K is constant.

    Raises
    ------
    ValueError
        If a value is outside its range or not finite.

    References
    ----------
    T. Pritz, J. Sound Vib. 195 (1996) 103.
    """

    G0: float
    G_inf: float
    tau: float
    alpha: float
    K: float
    density: float
    law: Law | None = field(default=None)
    temperature: float | None = None
    payne: Payne | None = None
    bulk: BulkRelaxation | None = None

    def _repr_html_(self) -> str:
        return str(picture("as_html", self))

    def __post_init__(self) -> None:
        values = {"G_inf": self.G_inf, "tau": self.tau, "K": self.K, "density": self.density}
        _check_companions("FractionalZener", self)
        _check("FractionalZener", values)
        remedy = f"it must lie between 0 and G_inf = {float(self.G_inf):g} Pa"
        require(
            0 <= number("FractionalZener.G0", self.G0) < self.G_inf, "FractionalZener.G0", self.G0, remedy
        )
        remedy = "it must lie above 0 and be at most 1"
        alpha = number("FractionalZener.alpha", self.alpha)
        require(0 < alpha <= 1, "FractionalZener.alpha", self.alpha, remedy)
        for name, value in (("G0", self.G0), ("G_inf", self.G_inf)):
            plausible("shear modulus", f"FractionalZener.{name}", value)
        plausible("relaxation time", "FractionalZener.tau", self.tau)

    def complex_modulus(self, omega: ArrayLike) -> Complex:
        """G*(ω), Pa, at ω rad/s, any shape; the conjugate at −ω, G0 at rest."""
        x = np.asarray(omega, dtype=np.float64) * self.tau
        power = np.abs(x) ** self.alpha * np.exp(0.5j * np.pi * self.alpha * np.sign(x))
        return np.asarray((self.G0 + self.G_inf * power) / (1 + power))

    def at(self, T: float) -> FractionalZener:
        """The same material at T, °C; warnings and errors as :meth:`Maxwell.at`."""
        factor = _factor("FractionalZener", self.law, self.temperature, T)
        bulk = None if self.bulk is None else self.bulk.moved(factor)
        return replace(self, tau=self.tau * factor, temperature=float(T), bulk=bulk)

    def maxwell(
        self, n: int | Literal["auto"] = 5, *, band: tuple[float, float], tolerance: float = 0.02
    ) -> Maxwell:
        """Its Maxwell approximation in a band, Hz; `fit` holds the error."""
        made = _approximate(
            self.complex_modulus, band, n, self.K, self.density, self.law, self.temperature, tolerance
        )
        return replace(made.with_payne(self.payne), bulk=self.bulk)
