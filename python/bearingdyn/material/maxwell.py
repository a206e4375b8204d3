"""The generalised Maxwell model: spring, dashpot and branches in parallel (paper fig. 1, eqs 6, 7, 17-19)."""

from __future__ import annotations

import json
import math
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike

from bearingdyn.checks import (
    instance,
    items,
    nonnegative,
    number,
    positive,
    real,
    reals,
    require,
    truth,
    vector,
)
from bearingdyn.material.amplitude import Payne, Rest, Softening, rest_of
from bearingdyn.material.bulk_relaxation import BulkRelaxation
from bearingdyn.material.creep import creep_compliance
from bearingdyn.material.doubt import Doubt
from bearingdyn.material.fit_report import FitReport, OutsideBand
from bearingdyn.material.low_end import LowEnd
from bearingdyn.material.reach_of_data import warn_before, warn_beyond
from bearingdyn.material.retuning import Retunable
from bearingdyn.material.shift_laws import Law, RhoT, law_from_dict, law_to_dict, moved_shift
from bearingdyn.material.spread import Drawable, Spread
from bearingdyn.notice import UnusualMagnitude, warn
from bearingdyn.pictures import picture
from bearingdyn.plausible_ranges import check_bulk, check_density, check_waves, plausible
from bearingdyn.types import Array, Complex
from bearingdyn.units import takes

_ROUNDING = 1.001  # of the edges of a band
UNSEEN = 1e-5  # of G0: below what any measurement resolves, and what MPa for Pa leave of a branch


def _branches(name: str, values: ArrayLike) -> Array:
    try:
        array = real(values)
    except (TypeError, ValueError):
        raise ValueError(f"Maxwell.{name} is {values!r}; it must be real numbers, one per branch") from None
    if array.ndim != 1:
        raise ValueError(
            f"Maxwell.{name} has shape {array.shape}; it must be one-dimensional, a value per branch"
        )
    array.flags.writeable = False
    return array


@takes(G0="Pa", G="Pa", tau="s", eta0="Pa s", K="Pa", density="kg/m³", temperature="°C", band="Hz")
@dataclass(frozen=True, init=False, eq=False)
class Maxwell(Retunable, Softening, Drawable):
    """The generalised Maxwell model, viscoelastic in shear, and elastic in volume unless `bulk` is given.

    Relaxation modulus G_rel(t) = G0 + Σ G_i exp(−t/τ_i), with a dashpot η0 in parallel (paper eqs 6, 7).
    G0 is the relaxed modulus, reached as t → ∞ (the paper calls it instantaneous: theory, §1).
    Two materials are equal if they agree in everything but `band`, `fit`, `low_end`, `spread` and `doubts`.

    Parameters
    ----------
    G0
        Relaxed shear modulus, Pa, ≥ 0 (0: a fluid).
    G, tau
        Strength, Pa, ≥ 0, and relaxation time, s, > 0, of each branch; (N,) each, stored read-only.
    eta0
        Viscosity of the parallel dashpot, Pa s, ≥ 0.
    K
        Bulk modulus at rest, Pa, constant unless `bulk` is given; at least 2/3 of the shear modulus right
        after a step (or at the upper end of the band, if there is one), as Poisson's ratio would otherwise be
        negative.
    density
        Mass density, kg/m³, 10 to 30000; 1e-4 to 0.1 stand for a layer without inertia.
    law
        Shift law (WLF, Arrhenius, Joined, ShiftTable), for :meth:`at`.
    temperature
        Temperature at which tau and eta0 hold, °C; the law's T_ref unless given.
    vertical
        Vertical shift, by which :meth:`at` changes the moduli too; None for none.
    band
        Lowest and highest frequency, Hz, the model is good for; that of the fit unless given. The modulus
        outside it comes with a warning (OutsideBand), at rest with that of the low end.
    fit
        Report of the fit the model comes from.
    low_end
        What data say of its modulus at long times; that of the fit unless given, else of the band, if there
        is one: then the modulus is known down to its lower edge. A static answer beyond it comes with a
        warning (BeyondData). A model without fit and band is believed.
    payne
        Law of softening with the amplitude of strain; G0, G and tau are then those at the law's gamma_r. None
        for none: the material is linear.
    bulk
        Relaxation of the bulk modulus: K is then complex, with loss in volume. None: K is constant.
    spread
        How far the parameters may be off; that of the fit unless given. It goes along to another temperature,
        modulus or loss factor, whose factors count as exact; see `with_spread` and `draws`.
    doubts
        What else is not known of it, as `bd.doubts(...).carried()` gives it; no answer depends on it.

    Raises
    ------
    ValueError
        If a value is outside its range or not finite, or G and tau differ in length.

    Examples
    --------
    >>> import bearingdyn as bd
    >>> rubber = bd.Maxwell(G0=1e6, G=[1e6, 2e6], tau=[1e-3, 1e-4], K=2e9, density=1150.0)
    >>> rubber.relaxation([0.0, 1.0]).round(-3).tolist()
    [4000000.0, 1000000.0]
    >>> G = rubber.complex_modulus(1e4)  # at 1/tau of the second branch half its strength, in phase and out
    >>> print(f"{G.real / 1e6:.2f} {G.imag / 1e6:.2f} MPa")
    2.99 1.10 MPa
    """

    G0: float
    G: Array
    tau: Array
    eta0: float
    K: float
    density: float
    law: Law | None
    temperature: float | None
    vertical: RhoT | None
    band: tuple[float, float] | None = field(repr=False)
    fit: FitReport | None = field(repr=False)
    low_end: LowEnd | None = field(repr=False)
    payne: Payne | None = field(repr=False)
    bulk: BulkRelaxation | None = field(repr=False)
    spread: Spread | None = field(repr=False)
    doubts: tuple[Doubt, ...] = field(repr=False)

    def _repr_html_(self) -> str:
        return str(picture("as_html", self))

    def __repr__(self) -> str:
        """One line: moduli, times, and where it is good."""
        branches = (
            f", {self.tau.size} branches of {self.tau.min():.3g} to {self.tau.max():.3g} s"
            if self.tau.size
            else ""
        )
        band = "" if self.band is None else f", fitted from {self.band[0]:.3g} to {self.band[1]:.3g} Hz"
        at = "" if self.temperature is None else f" at {self.temperature:g} °C"
        dashpot = f", eta0 {self.eta0:.3g} Pa s" if self.eta0 else ""
        return (
            f"<Maxwell{at}: G0 {self.G0:.4g} Pa, at once {self.G0 + self.G.sum():.4g} Pa{branches}{dashpot}, "
            f"K {self.K:.3g} Pa, {self.density:g} kg/m³{band}>"
        )

    def __init__(
        self,
        G0: float,
        G: ArrayLike,
        tau: ArrayLike,
        eta0: float = 0.0,
        *,
        K: float,
        density: float,
        law: Law | None = None,
        temperature: float | None = None,
        vertical: RhoT | None = None,
        band: tuple[float, float] | None = None,
        fit: FitReport | None = None,
        low_end: LowEnd | None = None,
        payne: Payne | None = None,
        bulk: BulkRelaxation | None = None,
        spread: Spread | None = None,
        doubts: Sequence[Doubt] = (),
    ) -> None:
        instance("Maxwell.bulk", bulk, (BulkRelaxation, type(None)), "give a bd.BulkRelaxation, or None")
        instance("Maxwell.fit", fit, (FitReport, type(None)), "it must be the report of a fit, or None")
        shifts = law is None or (callable(getattr(law, "log_shift", None)) and hasattr(law, "T_ref"))
        require(
            shifts and not isinstance(law, type),
            "Maxwell.law",
            law,
            "give a law of shifts, as WLF(C1, C2, T_ref)",
        )
        if band is None and fit is not None:
            band = fit.band
        instance("Maxwell.vertical", vertical, (RhoT, type(None)), "give a RhoT(T_ref), or None")
        instance("Maxwell.low_end", low_end, (LowEnd, type(None)), "leave it out: a fit knows it")
        instance("Maxwell.spread", spread, (Spread, type(None)), "it must be a bd.material.Spread, or None")
        if spread is None and fit is not None:
            spread = Spread.of(fit)
        for doubt in items("Maxwell.doubts", doubts, "give those of bd.doubts(...), in a list"):
            instance("Maxwell.doubts", doubt, Doubt, "give those of bd.doubts(...)")
        edges = band if band is None else vector("Maxwell.band", band, (2,), "lowest and highest, in Hz")
        if temperature is None and law is not None:
            temperature = law.T_ref
        values = {
            "G0": number("Maxwell.G0", G0, "it must be zero or positive, and finite, Pa"),
            "G": _branches("G", G),
            "tau": _branches("tau", tau),
            "eta0": number("Maxwell.eta0", eta0, "it must be zero or positive, and finite, Pa s"),
            "K": number("Maxwell.K", K, "it must be positive and finite, Pa"),
            "density": number("Maxwell.density", density, "it must be positive and finite, kg/m³"),
            "law": law,
            "temperature": temperature,
            "vertical": vertical,
            "band": None if edges is None else (float(edges[0]), float(edges[1])),
            "fit": fit,
            "low_end": low_end if low_end is not None or fit is None else fit.low_end,
            "payne": payne,
            "bulk": bulk,
            "spread": spread,
            "doubts": tuple(doubts),
        }
        for name, value in values.items():
            object.__setattr__(self, name, value)
        self._validate()
        if self.spread is not None and self.spread.fits > self.tau.size:  # branches were taken away since
            object.__setattr__(self, "spread", None)
        if self.low_end is None and self.band is not None:
            known = LowEnd.of_band(self.band[0], self._at(self.band[0]).real)
            object.__setattr__(self, "low_end", known)

    def _validate(self) -> None:
        for name, value, unit in (("G0", self.G0, "Pa"), ("eta0", self.eta0, "Pa s")):
            nonnegative(f"Maxwell.{name}", value, f"it must be zero or positive, and finite, {unit}")
        for name, value, unit in (("K", self.K, "Pa"), ("density", self.density, "kg/m³")):
            positive(f"Maxwell.{name}", value, f"it must be positive and finite, {unit}")
        if self.G.size != self.tau.size:
            raise ValueError(
                f"Maxwell.G has {self.G.size} branches, Maxwell.tau {self.tau.size}: each strength needs "
                "its time"
            )
        for i, (G, tau) in enumerate(zip(self.G.tolist(), self.tau.tolist(), strict=True)):
            nonnegative(f"Maxwell.G[{i}]", G, "it must be zero or positive, and finite, Pa")
            positive(f"Maxwell.tau[{i}]", tau, "it must be positive and finite, s")
            plausible("branch modulus", f"Maxwell.G[{i}]", G)
            plausible("relaxation time", f"Maxwell.tau[{i}]", tau)
        branches = float(self.G.sum())
        if 0 < branches < UNSEEN * self.G0:
            warn(
                f"Maxwell.G is {branches:.4g} Pa in all, {branches / self.G0:.2g} of G0, {self.G0:.4g} Pa: "
                "such branches change nothing; is G in MPa?",
                UnusualMagnitude,
            )
        if not self.G0 + self.eta0 + self.G.sum() > 0:
            raise ValueError(
                "Maxwell: G0, every G and eta0 are zero: the material would carry no shear at all"
            )
        check_density("Maxwell.density", self.density)
        plausible("shear modulus", "Maxwell.G0", self.G0)
        plausible("dashpot viscosity", "Maxwell.eta0", self.eta0)
        check_bulk("Maxwell.K", self.K, self._stiffest())
        plausible("bulk modulus", "Maxwell.K", self.K)
        check_waves("Maxwell.K", self.K, self.density)
        if self.temperature is not None:
            plausible("temperature", "Maxwell.temperature", self.temperature, "it must be finite, °C")
        about = [d.name for d in self.doubts]
        require(len(set(about)) == len(about), "Maxwell.doubts", about, "each may stand once")
        if self.band is not None and not 0 < self.band[0] < self.band[1] < math.inf:
            raise ValueError(f"Maxwell.band is {self.band!r} Hz; it must be a lower and a higher frequency")
        if self.payne is not None:
            require(isinstance(self.payne, Payne), "Maxwell.payne", self.payne, "give a bd.Payne, or None")

    def _stiffest(self) -> float:
        """|G*| at the upper end of the band, or right after a step where there is none, Pa."""
        if self.band is None:
            return self.G_instantaneous
        return abs(self._at(self.band[1]))

    def _at(self, frequency: float) -> complex:
        """G*, Pa, of spring and branches at a frequency, Hz."""
        x = 2 * math.pi * frequency * self.tau
        return self.G0 + complex(x / (1 + x * x) * (x + 1j) @ self.G)

    def __setstate__(self, state: dict[str, object]) -> None:
        self.__dict__.update(state)
        for array in (self.G, self.tau):  # an unpickled array is writeable
            array.flags.writeable = False

    def _key(self) -> tuple[object, ...]:
        branches = (tuple(self.G.tolist()), tuple(self.tau.tolist()))
        return (
            self.G0,
            *branches,
            self.eta0,
            self.K,
            self.density,
            self.law,
            self.temperature,
            self.vertical,
            self.payne,
            self.bulk,
        )

    def __eq__(self, other: object) -> bool:
        return self._key() == other._key() if isinstance(other, Maxwell) else NotImplemented

    def __hash__(self) -> int:
        return hash(self._key())

    @property
    def G_instantaneous(self) -> float:
        """Modulus G0 + Σ G_i right after a step of strain, Pa (the impulse of eta0 left out)."""
        return self.G0 + float(self.G.sum())

    @cached_property
    def rest(self) -> Rest:
        """What stands beside the law of softening in the time domain; ValueError without a law."""
        require(self.payne is not None, "Maxwell.payne", self.payne, "a material without law has no rest")
        return rest_of(self)

    def complex_modulus(self, omega: ArrayLike, *, doubt: bool = True) -> Complex:
        """Complex shear modulus G*(ω) = G0 + iωη0 + Σ G_i iωτ_i/(1 + iωτ_i), Pa.

        Parameters
        ----------
        omega
            Angular frequency, rad/s, any shape.
        doubt
            Warn of rest, ω = 0, where the data do not reach it.

        Returns
        -------
        ndarray
            Complex, the shape of omega; G0 at ω = 0, the conjugate at −ω.

        Raises
        ------
        ValueError
            If a frequency is not finite.

        Warns
        -----
        BeyondData
            At ω = 0, where the data of a fit, or the band of a model that has one, show no plateau.
        OutsideBand
            For other frequencies outside the band.

        References
        ----------
        Paper eqs 17-19.
        """
        omega, doubt = reals("omega", omega, "it must be angular frequencies, rad/s"), truth("doubt", doubt)
        if not np.all(np.isfinite(omega)):
            raise ValueError("omega: every angular frequency must be finite, rad/s")
        self._warn_outside(omega)
        if doubt and np.any(omega == 0.0):
            self._warn_of_times(np.array([math.inf]), "the modulus at rest, at 0 Hz,")
        # in real numbers: products of complex ones have other bits alone than among others on some machines
        x = omega[..., None] * self.tau
        loss = self.G * x / (1 + x * x)
        found = np.empty(omega.shape, dtype=np.complex128)
        found.real = self.G0 + (loss * x).sum(axis=-1)
        found.imag = omega * self.eta0 + loss.sum(axis=-1)
        return found

    def _warn_outside(self, omega: Array) -> None:
        if self.band is None or omega.size == 0:
            return
        f = np.abs(omega[omega != 0]) / (2 * np.pi)
        outside = f[(f < self.band[0] / _ROUNDING) | (f > self.band[1] * _ROUNDING)]
        if outside.size:
            warn(
                f"{outside.min():.3g} to {outside.max():.3g} Hz lies outside the band the Maxwell model was "
                f"fitted in, {self.band[0]:.4g} to {self.band[1]:.4g} Hz: there it extrapolates",
                OutsideBand,
            )

    def _warn_of_times(self, t: Array, what: str) -> None:
        """Warn of times, s, about which the data say nothing: longer by the low end, shorter by the band."""
        if t.size == 0:
            return
        warn_beyond([("the material", self)], float(t.max()), what)
        if t[t > 0].size:
            warn_before(self, float(t[t > 0].min()), f"{what} of the material")

    def bulk_modulus(self, omega: ArrayLike) -> Complex:
        """Complex bulk modulus K*(ω), Pa, at ω rad/s, any shape; K everywhere without `bulk`."""
        if self.bulk is None:
            return np.full(np.shape(omega), complex(self.K))
        return self.bulk.modulus(self.K, omega)

    def loss_factor(self, omega: ArrayLike) -> Array:
        """Loss factor η = tan δ = G″/G′ at angular frequencies ω, rad/s; infinite where G′ = 0."""
        modulus = self.complex_modulus(omega)
        with np.errstate(divide="ignore", invalid="ignore"):
            return np.where(modulus.real > 0, modulus.imag / modulus.real, np.inf)

    def tan_delta(self, omega: ArrayLike) -> Array:
        """The loss factor under its other name, :meth:`loss_factor`."""
        return self.loss_factor(omega)

    def relaxation(self, t: ArrayLike, *, doubt: bool = True) -> Array:
        """Relaxation modulus G_rel(t), Pa, at times t ≥ 0, s, any shape (paper eq. 6).

        The dashpot adds an impulse η0·δ(t) at t = 0, which is left out.

        Parameters
        ----------
        t
            Times, s; 0 gives the instantaneous modulus.
        doubt
            Warn of times that the data do not reach.

        Raises
        ------
        ValueError
            If a time is negative.

        Warns
        -----
        BeyondData
            For times longer than the data of a fit, or the band of a model that has one, speak of.
        OutsideBand
            For times shorter than that band.
        """
        t, doubt = reals("t", t, "it must be times, s"), truth("doubt", doubt)
        if not np.all(t >= 0):
            raise ValueError("t: a relaxation modulus exists for times t >= 0 s only")
        if doubt:
            self._warn_of_times(t, "the relaxation modulus")
        return np.asarray(self.G0 + np.exp(-t[..., None] / self.tau) @ self.G)

    def creep(self, t: ArrayLike) -> Array:
        """Creep compliance J(t), 1/Pa, at times t ≥ 0, s, any shape: strain under a unit step of stress.

        Exact: iωJ* = 1/G* expanded in its poles, which lie between those of G*. With a dashpot J(0) = 0; with
        G0 = 0 the material flows forever.

        Raises
        ------
        ValueError
            If a time is negative.

        Warns
        -----
        BeyondData, OutsideBand
            As `relaxation`.
        """
        times = reals("t", t, "it must be times, s")
        if np.all(times >= 0):
            self._warn_of_times(times, "the creep compliance")
        return creep_compliance(self.G0, self.G, self.tau, self.eta0, times)

    def spectrum(self) -> tuple[Array, Array]:
        """Discrete relaxation spectrum: times, s, rising, and strengths, Pa, of the branches; (N,) each."""
        order = np.argsort(self.tau, kind="stable")
        return self.tau[order], self.G[order]

    def stress(self, strain_rate: ArrayLike, dt: ArrayLike) -> Array:
        """Deviatoric stress history under a strain-rate history, by the history update of the C core.

        s = 2·G0·e + 2·η0·ė + Σ S_i, from e = 0 and S_i = 0 at the first sample, exact for a rate linear
        between samples, dt being free to change from step to step.

        Parameters
        ----------
        strain_rate
            Deviatoric tensorial strain rate ė, 1/s, (nt, …): axis 0 is time.
        dt
            Time step, s: a number, or one per step (nt − 1,).

        Returns
        -------
        ndarray
            Stress at the samples, Pa, the shape of strain_rate.

        Raises
        ------
        ValueError
            If a step is not positive, a rate not finite, or the lengths differ.

        References
        ----------
        Paper eqs 7-11 with the branch stress as the state (theory, §1).
        """
        rate = reals("strain_rate", strain_rate, "it must be rates of strain, 1/s")
        if rate.ndim == 0 or rate.shape[0] == 0:
            raise ValueError(
                f"strain_rate has shape {rate.shape}; axis 0 must be time, with at least one sample"
            )
        if not np.all(np.isfinite(rate)):
            raise ValueError("strain_rate: every value must be finite, 1/s")
        step = reals("dt", dt, "it must be a time step, s, or one between each two samples")
        if step.ndim > 0 and step.shape != (rate.shape[0] - 1,):
            raise ValueError(
                f"dt has shape {step.shape}; it must be one number, or {rate.shape[0] - 1} for "
                f"{rate.shape[0]} samples"
            )
        if not (np.all(step > 0) and np.all(np.isfinite(step))):
            raise ValueError("dt: every time step must be positive and finite, s")

        from bearingdyn import core

        columns = np.ascontiguousarray(rate.reshape(rate.shape[0], -1))
        steps = float(step) if step.ndim == 0 else np.ascontiguousarray(step)
        stress = core.maxwell_stress(columns, steps, self.G0, self.eta0, self.G, self.tau)
        return np.asarray(stress, dtype=np.float64).reshape(rate.shape)

    def at(self, T: float) -> Maxwell:
        """The same material at temperature T, °C: tau and eta0 times a_T(T)/a_T(temperature), by its law.

        Moduli are multiplied by b_T(T)/b_T(temperature) if there is a vertical shift; the band moves along.
        Outside the isotherms the law was found from it warns (OutsideIsotherms).

        Raises
        ------
        ValueError
            If the material has no law, or T lies above 500 °C or where the law has no meaning.
        """
        T = plausible("temperature", "T", T, "it must be one finite temperature, in °C")
        if self.law is None or self.temperature is None:
            raise ValueError(
                "Maxwell.law is None: a material can be moved to another temperature only by a shift law "
                "(law=WLF(C1, C2, T_ref), or one fitted by master_curve)"
            )
        aT = 10 ** moved_shift("Maxwell", self.law, self.temperature, T)
        bT = 1.0
        if self.vertical is not None:
            bT = float(self.vertical.factor(T) / self.vertical.factor(self.temperature))
        return replace(
            self,
            G0=self.G0 * bT,
            G=self.G * bT,
            tau=self.tau * aT,
            eta0=self.eta0 * aT * bT,
            temperature=float(T),
            band=None if self.band is None else (self.band[0] / aT, self.band[1] / aT),
            fit=None,
            low_end=None if self.low_end is None else self.low_end.moved(aT, bT),
            payne=None if self.payne is None else self.payne.scaled(bT),
            bulk=None if self.bulk is None else self.bulk.moved(aT),
        )

    def to_json(self) -> str:
        """The material as JSON text, exact to the last bit; the fit report is left out."""
        data = {
            "G0": self.G0,
            "G": self.G.tolist(),
            "tau": self.tau.tolist(),
            "eta0": self.eta0,
            "K": self.K,
            "density": self.density,
            "law": None if self.law is None else law_to_dict(self.law),
            "temperature": self.temperature,
        }
        if self.vertical is not None:
            data["vertical"] = {"T_ref": self.vertical.T_ref, "expansion": self.vertical.expansion}
        if self.band is not None:
            data["band"] = list(self.band)
        if self.low_end is not None:
            # JSON has no NaN
            known = vars(self.low_end).items()
            data["low_end"] = {k: None if isinstance(v, float) and math.isnan(v) else v for k, v in known}
        if self.payne is not None:
            data["payne"] = {
                name: list(v) if isinstance(v, tuple) else v
                for name, v in vars(self.payne).items()
                if name != "fit"
            }
        if self.bulk is not None:
            data["bulk"] = {name: list(v) for name, v in vars(self.bulk).items()}
        if self.spread is not None:
            data["spread"] = self.spread.told_as
        if self.doubts:
            data["doubts"] = [dict(vars(d)) for d in self.doubts]
        return json.dumps(data, indent=1)

    @classmethod
    def from_json(cls, text: str) -> Maxwell:
        """The material written by :meth:`to_json`; ValueError naming what is missing or unknown."""
        instance("Maxwell.from_json: text", text, str, "give the text that to_json returned")
        try:
            data = json.loads(text)
        except (ValueError, RecursionError) as error:  # integers of thousands of digits, nested without end
            raise ValueError(f"Maxwell.from_json: not JSON: {error}") from error
        required = {"G0", "G", "tau", "K", "density"}
        if not isinstance(data, dict) or not required <= data.keys():
            raise ValueError(f"Maxwell.from_json: needs a JSON object with {', '.join(sorted(required))}")
        unknown = (
            data.keys()
            - required
            - {
                "eta0",
                "law",
                "temperature",
                "vertical",
                "band",
                "low_end",
                "payne",
                "bulk",
                "spread",
                "doubts",
            }
        )
        if unknown:
            raise ValueError(f"Maxwell.from_json: unknown entries {', '.join(sorted(unknown))}")
        law = data.pop("law", None)
        vertical = data.pop("vertical", None)
        known = data.pop("low_end", None)
        softens = data.pop("payne", None)
        relaxes = data.pop("bulk", None)
        spread = data.pop("spread", None)
        about = data.pop("doubts", [])
        try:
            data["doubts"] = tuple(Doubt(**d) for d in about)
            if relaxes is not None:
                data["bulk"] = BulkRelaxation(**relaxes)
            if spread is not None:
                data["spread"] = Spread(**spread)
            if softens is not None:
                data["payne"] = Payne(**softens)
            if known is not None:
                data["low_end"] = LowEnd.from_numbers(known)
            shift = None if vertical is None else RhoT(**vertical)
            return cls(**data, law=None if law is None else law_from_dict(law), vertical=shift)
        except (TypeError, LookupError, OverflowError) as error:
            raise ValueError(f"Maxwell.from_json: {error}") from error
