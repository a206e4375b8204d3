"""Softening of a filled rubber with the amplitude of its strain (the Payne effect), as an additive law.

    F(γ) = D (1 + u^p)^(−m/p),  u = γ/γc        breakable part of the storage modulus
    L(γ) = Lm v^p/(1 + v^p),    v = γ/γl        loss modulus of its breaking and healing
    E(γ) = F(γ) − L(γ) ≥ 0                      spring that is left when L is a Maxwell branch

A rubber whose modulus G_lin(ω) was measured at the strain γr has, in a vibration of strain amplitude γ and
mean angular frequency Ω,

    G*(ω) = G_lin(ω) − F(γr) − i L(γr) + E(γ) + 2 L(γ) iω/(iω + Ω)

of which the last two are F(γ) + i L(γ) where all of the vibration is at ω = Ω.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace
from typing import Self

import numpy as np
from numpy.typing import ArrayLike

from bearingdyn.checks import instance, number, positive, require, two
from bearingdyn.material.amplitude.report import PayneFit
from bearingdyn.pictures import page
from bearingdyn.plausible_ranges import plausible
from bearingdyn.short_repr import short
from bearingdyn.types import Array, Complex

_LARGEST = 0.5  # shear strain: beyond, no law of small strain holds; strain was probably given in percent
_BEYOND = 3.0  # times the larger of γc and γl: how far E is asked to stay positive without a sweep


@dataclass(frozen=True)
class Payne:
    """Law of softening of a filled rubber: loss of stiffness with amplitude, and damping that comes of it.

    Parameters
    ----------
    D
        Breakable part of the storage modulus in shear, Pa: what it loses from the smallest to very large
        strain.
    gamma_c
        Shear strain at which it breaks, zero-to-peak, as a fraction (0.004 is 0.4 %).
    m
        Slope: F falls as γ^−m far above gamma_c.
    Lm
        Loss modulus at large strain that the breaking adds, Pa.
    gamma_l
        Shear strain at which half of it is there (p = 2).
    p
        Sharpness of both bends. 2 renders strain sweeps of carbon-black rubber; a larger one keeps small
        strains more linear.
    gamma_r
        Shear strain at which the linear modulus was measured (that of the isotherms), a fraction.
    strains
        Lowest and highest strain that the law was found from; beyond the highest an answer comes with a
        warning (BeyondSweep). None: nothing is known.
    fit
        Report of the fit the law comes from.

    Raises
    ------
    ValueError
        If a value is outside its range, and where E = F − L becomes negative within the strains (without them
        up to three times gamma_c or gamma_l): no spring and branch make such a law.

    References
    ----------
    A. R. Payne, J. Appl. Polym. Sci. 6 (1962) 57; the form of F is Carreau's.

    Examples
    --------
    >>> import bearingdyn as bd
    >>> law = bd.Payne(D=2.0344e6, gamma_c=3.588e-3, m=0.4817, Lm=0.1663e6, gamma_l=3.132e-3)
    >>> print(f"{law.modulus(0.01) / 1e6:.4f} MPa")
    1.2060+0.1514j MPa
    """

    D: float
    gamma_c: float
    m: float
    Lm: float
    gamma_l: float
    p: float = 2.0
    gamma_r: float = 1.5e-3
    strains: tuple[float, float] | None = None
    fit: PayneFit | None = field(default=None, compare=False, repr=False)

    __repr__ = short
    _repr_html_ = page

    def __post_init__(self) -> None:
        instance("Payne.fit", self.fit, (PayneFit, type(None)), "leave it out: fit_payne gives it")
        for name in ("D", "gamma_c", "m", "gamma_l", "p", "gamma_r"):
            object.__setattr__(self, name, positive(f"Payne.{name}", getattr(self, name)))
        remedy = "it must be zero or positive, and finite, Pa"
        object.__setattr__(self, "Lm", number("Payne.Lm", self.Lm, remedy))
        require(self.Lm >= 0, "Payne.Lm", self.Lm, remedy)
        plausible("shear modulus", "Payne.D", self.D)
        for name in ("gamma_c", "gamma_l", "gamma_r"):
            value = getattr(self, name)
            require(
                value <= _LARGEST,
                f"Payne.{name}",
                value,
                f"a strain is a fraction of at most {_LARGEST:g} here; was it in percent? Then give "
                f"{value / 100:g}",
            )
        if self.strains is not None:
            low, high = two("Payne.strains", self.strains, "give lowest and highest")
            require(0 < low < high < math.inf, "Payne.strains", self.strains, "give lowest and highest")
            object.__setattr__(self, "strains", (low, high))
        top = self.strains[1] if self.strains is not None else _BEYOND * max(self.gamma_c, self.gamma_l)
        gamma = np.geomspace(1e-3 * self.gamma_c, max(top, self.gamma_r), 200)
        elastic = self.elastic(gamma)
        worst = int(np.argmin(elastic))
        if not elastic[worst] >= 0:
            raise ValueError(
                f"Payne: at a strain of {100 * gamma[worst]:.3g} % the loss L = "
                f"{float(self.loss(gamma[worst])):.4g} Pa exceeds the storage F = "
                f"{float(self.storage(gamma[worst])):.4g} Pa; E = F − L must not be negative: take a smaller "
                f"Lm, or a larger D"
            )

    def storage(self, gamma: ArrayLike) -> Array:
        """F, Pa, the breakable storage modulus left at strain amplitudes γ ≥ 0, any shape."""
        u = _strain(gamma) / self.gamma_c
        return np.asarray(self.D * (1.0 + u**self.p) ** (-self.m / self.p))

    def loss(self, gamma: ArrayLike) -> Array:
        """L, Pa, the loss modulus that comes of breaking and healing, at strain amplitudes γ ≥ 0."""
        v = (_strain(gamma) / self.gamma_l) ** self.p
        return np.asarray(self.Lm * v / (1.0 + v))

    def elastic(self, gamma: ArrayLike) -> Array:
        """E = F − L, Pa: the spring beside the Maxwell branch of strength 2 L."""
        return self.storage(gamma) - self.loss(gamma)

    def modulus(self, gamma: ArrayLike) -> Complex:
        """F + iL, Pa, at strain amplitudes γ ≥ 0, for a vibration at one frequency."""
        return self.storage(gamma) + 1j * self.loss(gamma)

    def dynamic(self, omega: ArrayLike, gamma: ArrayLike, mean: ArrayLike | None = None) -> Complex:
        """E + 2 L iω/(iω + Ω), Pa: what a tone meets in a vibration of several.

        Parameters
        ----------
        omega
            Angular frequency of the tone, rad/s.
        gamma
            Strain amplitude of the whole vibration, √Σ γ_k².
        mean
            Its mean angular frequency Ω = √(Σ ω_k² γ_k² / Σ γ_k²), rad/s; None: the tone is alone.
        """
        w = np.asarray(omega, dtype=np.float64)
        if mean is None:
            return np.asarray(self.storage(gamma) + 1j * np.sign(w) * self.loss(gamma))
        Omega = np.asarray(mean, dtype=np.float64)
        return np.asarray(self.elastic(gamma) + 2.0 * self.loss(gamma) * 1j * w / (1j * w + Omega))

    def change(self, omega: ArrayLike, gamma: ArrayLike, mean: ArrayLike | None = None) -> Complex:
        """What is added to the modulus measured at gamma_r, Pa, at another amplitude; see `dynamic`."""
        w = np.asarray(omega, dtype=np.float64)
        there = self.storage(self.gamma_r) + 1j * np.sign(w) * self.loss(self.gamma_r)
        return np.asarray(self.dynamic(w, gamma, mean) - there)

    def slope(self, gamma: ArrayLike) -> Complex:
        """dF/d ln γ + i dL/d ln γ, Pa, at strain amplitudes γ ≥ 0, for a vibration at one frequency."""
        strain = _strain(gamma)
        u, v = (strain / self.gamma_c) ** self.p, (strain / self.gamma_l) ** self.p
        storage = -self.m * self.D * u * (1.0 + u) ** (-self.m / self.p - 1.0)
        return np.asarray(storage + 1j * self.p * self.Lm * v / (1.0 + v) ** 2)

    def scaled(self, factor: float) -> Self:
        """The law of a rubber harder by this factor: D and Lm times it."""
        positive("factor", factor)
        return replace(self, D=self.D * factor, Lm=self.Lm * factor)


def _strain(gamma: ArrayLike) -> Array:
    strain = np.asarray(gamma, dtype=np.float64)
    if not np.all(strain >= 0):
        raise ValueError("gamma: a strain amplitude is zero or positive")
    return strain


class Softening:
    """What a material offers that may carry a law of softening."""

    payne: Payne | None

    def with_payne(self, law: Payne | None) -> Self:
        """The same material with a law of softening by amplitude, or, None, without."""
        require(law is None or isinstance(law, Payne), "law", law, "give a bd.Payne, or None for none")
        return replace(self, payne=law)  # type: ignore[type-var]

    def modulus_at(self, omega: ArrayLike, strain: ArrayLike, mean: ArrayLike | None = None) -> Complex:
        """G*(ω), Pa, in a vibration of this shear strain amplitude.

        Parameters
        ----------
        omega
            Angular frequency, rad/s.
        strain
            Shear strain amplitude of the whole vibration, zero-to-peak, a fraction; the static part is left
            out.
        mean
            Mean angular frequency Ω of a vibration of several tones, rad/s; None: the tone is alone.

        Raises
        ------
        ValueError
            Without a law of softening.
        """
        if self.payne is None:
            raise ValueError(
                f"{type(self).__name__}.payne is None; a modulus at a strain needs a law of softening: "
                f"material.with_payne(bd.fit_payne(...))"
            )
        linear = self.complex_modulus(omega)  # type: ignore[attr-defined]
        return np.asarray(linear + self.payne.change(omega, strain, mean))
