"""The law of softening fitted to a strain sweep."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import scipy

from bearingdyn.checks import positive, require
from bearingdyn.material.amplitude import Payne, PayneFit
from bearingdyn.material.reading import StrainSweep, read_strain_sweep
from bearingdyn.notice import TensionAsShear, warn
from bearingdyn.types import Array, Complex

_RISE = 0.01  # of G′ from a smaller strain to a larger one: noise of an instrument, and no more
_SLACK = 1.05  # of the isotherms' strain: the sweep begins there or below
_CONFIDENCE = 0.9  # with which a D outside the range is refuted
_PARAMETERS = 7  # of the law and the two constants it stands on
_EXACT = 1e-12  # squared relative misfit of a point that is round-off
_FACTORS = (0.2, 20.0)  # of D sought, over the fall of G′ within the sweep
_CUT = 5e-3  # of ln D
_KEPT = 1.02  # times L that F shall be: the sweep's points are not all strains


def fit_payne(
    sweep: StrainSweep | str | Path | Any,
    *,
    strain_of_isotherms: float,
    lowest_trusted: float | None = None,
    p: float = 2.0,
    D: float | None = None,
    area: float | None = None,
    mode: str | None = None,
) -> Payne:
    """Fit the law of softening to a strain sweep.

    The law is added to a modulus measured at the isotherms' strain: what counts is the change from there.
    F(γ) and L(γ) therefore go through the trusted point nearest to that strain, and the squared deviations of
    G′ and G″ from them are least. A sweep of usual width does not determine D (the plateaus at very small and
    very large strain are both outside it): unless given it is the smallest that the sweep does not refute
    with 90 % confidence and that leaves a spring, F ≥ L, all over the sweep. `fit.D_range` says how
    open it is.

    Parameters
    ----------
    sweep
        StrainSweep, or what `read_strain_sweep` takes.
    strain_of_isotherms
        Shear strain amplitude at which the linear modulus was measured, a fraction.
    lowest_trusted
        Lowest shear strain, a fraction, at which the sweep is believed; below, small forces make artefacts.
        None: all of it.
    p
        Sharpness of the law's bends.
    D
        Breakable storage modulus, Pa, where it is known.
    area
        Of the specimen, m²: force/(|G| γ) of the sweep is checked against it.
    mode
        "shear" or "tension", where the table does not tell.

    Returns
    -------
    Payne
        With `fit` and the strains it was found from.

    Raises
    ------
    ValueError
        For a sweep in which G′ rises with strain, that starts above the isotherms' strain or ends below it,
        with fewer than six trusted points, or whose force does not fit modulus and area.

    Warns
    -----
    TensionAsShear
        For a sweep in tension, which is turned into shear by γ = √3 ε.
    """
    if not isinstance(sweep, StrainSweep):
        sweep = read_strain_sweep(sweep, mode)  # type: ignore[arg-type]
    gamma_r = positive("strain_of_isotherms", strain_of_isotherms, "it must be a fraction, as 0.0015")
    sweep.check_area(area)
    sweep = _in_shear(sweep)
    low = 0.0 if lowest_trusted is None else positive("lowest_trusted", lowest_trusted)
    keep = sweep.strain >= low * (1 - 1e-9)
    gamma, G = sweep.strain[keep], (sweep.storage + 1j * sweep.loss)[keep]
    if gamma.size < 6:
        raise ValueError(
            f"{sweep.source}: {gamma.size} points from {100 * low:.3g} % strain on; the law needs six: "
            f"measure more, or trust smaller strains (lowest_trusted)"
        )
    if not gamma[0] <= _SLACK * gamma_r:
        raise ValueError(
            f"{sweep.source}: the sweep starts at {100 * gamma[0]:.4g} % strain, above the isotherms' "
            f"{100 * gamma_r:.4g} %; what happens between them is unknown: measure from "
            f"{100 * gamma_r:.3g} % on, or correct strain_of_isotherms (a fraction, shear)"
        )
    if not gamma[-1] * _SLACK >= gamma_r:
        raise ValueError(
            f"{sweep.source}: the sweep ends at {100 * gamma[-1]:.4g} % strain, below the isotherms' "
            f"{100 * gamma_r:.4g} %; strain_of_isotherms is a fraction, .0015 for .15 %"
        )
    before = np.minimum.accumulate(G.real)
    rise = G.real / before - 1
    worst = int(np.argmax(rise))
    if not rise[worst] <= _RISE:
        raise ValueError(
            f"{sweep.source}: G′ rises by {100 * rise[worst]:.2g} % with strain, up to "
            f"{100 * gamma[worst]:.4g} %; a filled rubber softens: leave out what small forces disturb "
            f"(lowest_trusted), or the sweep hardens for another reason and is not for this law"
        )
    fall = float(G.real[0] - G.real[-1])
    if not fall > _RISE * G.real[0]:
        raise ValueError(
            f"{sweep.source}: G′ falls by {100 * fall / G.real[0]:.2g} % over the sweep; there is no "
            f"softening to fit, and the linear modulus serves"
        )

    at = int(np.argmin(np.abs(np.log(gamma / gamma_r))))
    p = positive("p", p, "it must be a positive exponent")
    require(p <= 20, "p", p, "it must be at most 20; the law's usual is 2")
    loss = _loss(gamma, G.imag, p, at)

    def found(value: float) -> _Found:
        return _with_D(gamma, G.real, value, p, at, loss)

    if D is None:
        D_low, D_high, best = _open_range(found, fall, 2 * gamma.size - _PARAMETERS)
        D_low = _least_elastic(found, D_low, max(D_high, _FACTORS[1] * fall), gamma, p)
        value = D_low
    else:
        value = positive("D", D, "it must be positive and finite, Pa")
        D_low, D_high, best = value, value, found(value)
    best = found(value)
    model = best.model
    report = PayneFit(
        sweep.frequency,
        sweep.temperature,
        gamma,
        G.real,
        G.imag,
        best.linear,
        float(np.abs(model.real / G.real - 1).max()),
        float(np.abs((model.imag / model.real) / (G.imag / G.real) - 1).max()),
        (D_low, D_high),
        sweep.source,
    )
    gamma_c, m, Lm, gamma_l = best.law
    return Payne(value, gamma_c, m, Lm, gamma_l, p, gamma_r, (float(gamma[0]), float(gamma[-1])), report)


@dataclass(frozen=True)
class _Found:
    """A law of given D: γc, m, Lm, γl, what it is added to, its G* at the points, and its squared misfit."""

    law: tuple[float, float, float, float]
    linear: complex
    model: Complex
    cost: float


@dataclass(frozen=True)
class _Loss:
    """The best loss: Lm, γl, the constant below it, G″ of both, Pa, and its squared misfit."""

    Lm: float
    gamma_l: float
    constant: float
    model: Array
    cost: float


def _loss(gamma: Array, loss: Array, p: float, at: int) -> _Loss:
    """The best loss through point `at`."""
    x = np.log(gamma)
    middle = float(x.mean())
    scale = float(np.abs(loss).max())

    def shape(q: float) -> Array:
        v = np.exp(p * (x - q))
        return np.asarray(v / (1 + v))

    def strength(q: float) -> float:
        """Never negative: a loss that falls with strain is none of this law's."""
        d = shape(q) - shape(q)[at]
        return max(float(d @ (loss - loss[at]) / max(float(d @ d), 1e-300)), 0.0)

    def cost(q: float) -> float:
        d = shape(q) - shape(q)[at]
        return float(np.sum(((strength(q) * d - (loss - loss[at])) / scale) ** 2))

    grid = np.linspace(middle - 4, middle + 4, 81)
    near = grid[int(np.argmin([cost(q) for q in grid]))]
    bent = float(
        scipy.optimize.minimize_scalar(
            cost, bounds=(near - 0.2, near + 0.2), method="bounded", options={"xatol": 1e-10}
        ).x
    )
    Lm = strength(bent)
    constant = float(loss[at] - Lm * shape(bent)[at])
    return _Loss(Lm, float(np.exp(bent)), constant, constant + Lm * shape(bent), cost(bent))


def _with_D(gamma: Array, G: Array, D: float, p: float, at: int, loss: _Loss) -> _Found:
    """The best law of this D through point `at`, G (n,) being G′; storage and loss are two problems."""
    x = np.log(gamma)
    middle = float(x.mean())
    scale = float(G.max())

    def shape(q: Array) -> Array:
        return np.asarray(D * (1 + np.exp(p * (x - q[0]))) ** (-np.exp(np.clip(q[1], -9.0, 9.0)) / p))

    def off(q: Array) -> Array:
        F = shape(q)
        return np.asarray((F - F[at] - (G - G[at])) / scale)

    starts = [np.array([middle + d, s]) for d, s in ((-0.3, -1.5), (0.3, -0.5), (1.3, 0.8))]
    fits = [
        scipy.optimize.least_squares(off, s, method="lm", xtol=1e-12, ftol=1e-14, max_nfev=400)
        for s in starts
    ]
    first = min(fits, key=lambda r: float(r.cost))
    gamma_c, m = (float(v) for v in np.exp(first.x))
    F = shape(first.x)
    linear = complex(float(G[at] - F[at]), loss.constant)
    model = linear.real + F + 1j * loss.model
    return _Found((gamma_c, m, loss.Lm, loss.gamma_l), linear, model, float(2 * first.cost) + loss.cost)


def _open_range(found: Any, fall: float, freedom: int) -> tuple[float, float, _Found]:
    """Lowest and highest D whose storage is rendered as well as may be asked, and the best of all."""
    values = fall * np.geomspace(*_FACTORS, 13)
    laws = [found(float(v)) for v in values]
    costs = np.array([law.cost for law in laws])
    k = int(np.argmin(costs))
    limit = costs[k] * (1 + scipy.stats.f.ppf(_CONFIDENCE, 1, freedom) / freedom) + freedom * _EXACT

    def edge(bad: float, good: float) -> float:
        while abs(np.log(bad / good)) > _CUT:
            half = float(np.sqrt(bad * good))
            bad, good = (half, good) if found(half).cost > limit else (bad, half)
        return good

    above = np.flatnonzero(costs[:k] > limit)
    low = (
        float(values[0]) if above.size == 0 else edge(float(values[above[-1]]), float(values[above[-1] + 1]))
    )
    over = np.flatnonzero(costs[k:] > limit)
    high = np.inf if over.size == 0 else edge(float(values[k + over[0]]), float(values[k + over[0] - 1]))
    return low, high, laws[k]


def _least_elastic(found: Any, low: float, high: float, gamma: Array, p: float) -> float:
    """The least D from `low` on whose law keeps a spring, F ≥ L, over the sweep; `low` where none does.

    The sweep tells how much F falls, so that what is left of it at the largest strain rises with D.
    """

    def keeps(value: float) -> bool:
        gamma_c, m, Lm, gamma_l = found(value).law
        storage = value * (1 + (gamma / gamma_c) ** p) ** (-m / p)
        v = (gamma / gamma_l) ** p
        return bool((storage >= _KEPT * Lm * v / (1 + v)).all())

    if keeps(low) or not keeps(high):
        return low
    bad, good = low, high
    while np.log(good / bad) > _CUT:
        half = float(np.sqrt(bad * good))
        bad, good = (bad, half) if keeps(half) else (half, good)
    return good


def _in_shear(sweep: StrainSweep) -> StrainSweep:
    """The strain sweep in shear; a warning says so where it was in tension."""
    if sweep.mode == "tension":
        warn(
            f"{sweep.source}: a strain sweep in tension is turned into shear by G* = E*/3 and γ = √3 ε: "
            f"strain of {100 * sweep.strain[0]:.3g} to {100 * sweep.strain[-1]:.3g} % becomes "
            f"{100 * np.sqrt(3) * sweep.strain[0]:.3g} to {100 * np.sqrt(3) * sweep.strain[-1]:.3g} %",
            TensionAsShear,
        )
    return sweep.to_shear()
