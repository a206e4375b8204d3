"""The law of softening fitted to a strain sweep."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
import scipy

from bearingdyn.checks import positive
from bearingdyn.material.amplitude.law import Payne
from bearingdyn.material.amplitude.sweep import StrainSweep, in_shear, read_strain_sweep
from bearingdyn.short_repr import short
from bearingdyn.types import Array, Complex

_RISE = 0.01  # of G′ from a smaller strain to a larger one: noise of an instrument, and no more
_SLACK = 1.05  # of the isotherms' strain: the sweep begins there or below
# the squared misfit may be this much larger than the least: what is taken of a D that the sweep leaves open
_OPEN = 1.25
_FACTORS = (0.2, 20.0)  # of D sought, over the fall of G′ within the sweep
_CUT = 5e-3  # of ln D


@dataclass(frozen=True)
class PayneFit:
    """How well a law renders the strain sweep it was fitted to.

    Attributes
    ----------
    frequency, temperature
        Of the sweep, Hz and °C.
    strain
        Shear strain of the points used, a fraction, (n,).
    storage, loss
        Measured moduli, Pa, (n,).
    linear
        What the law is added to at this frequency: G* of the sweep less F + iL, Pa.
    storage_max, tan_delta_max
        Largest relative deviation of G′ and of tan δ.
    D_range
        Lowest and highest D that render the sweep with less than 1.25 times the least squared misfit: how
        far the sweep leaves it open; the lowest is taken. inf where a larger D is always as good.
    """

    frequency: float
    temperature: float
    strain: Array = field(compare=False, repr=False)
    storage: Array = field(compare=False, repr=False)
    loss: Array = field(compare=False, repr=False)
    linear: complex
    storage_max: float
    tan_delta_max: float
    D_range: tuple[float, float]
    source: str = ""

    __repr__ = short

    @property
    def D_known(self) -> bool:
        """Whether the sweep holds D within a factor of two."""
        return self.D_range[1] < 2 * self.D_range[0]


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

    G′ and G″ of the sweep are F(γ) and L(γ) over a constant each; relative deviations are least in the
    squares. A sweep of usual width does not determine D (the plateau at very small and very large strain are
    both outside it): D is the smallest that renders it with no more than 1.25 times the least squared misfit,
    unless given. `fit.D_range` says how open it is.

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
        For a sweep in which G′ rises with strain, that starts above the isotherms' strain, with fewer than
        six trusted points, or whose force does not fit modulus and area.

    Warns
    -----
    TensionAsShear
        For a sweep in tension, which is turned into shear by γ = √3 ε.
    """
    if not isinstance(sweep, StrainSweep):
        sweep = read_strain_sweep(sweep, mode)  # type: ignore[arg-type]
    gamma_r = positive("strain_of_isotherms", strain_of_isotherms, "it must be a fraction, as 0.0015")
    sweep.check_area(area)
    sweep = in_shear(sweep)
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

    loss = _loss(gamma, G.imag, p)

    def found(value: float) -> _Found:
        return _with_D(gamma, G.real, value, p, loss)

    if D is None:
        D_low, D_high, best = _open_range(found, fall)
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


def _loss(gamma: Array, loss: Array, p: float) -> _Loss:
    x = np.log(gamma)
    middle = float(x.mean())

    def parts(q: float) -> tuple[Array, Array]:
        v = np.exp(p * (x - q))
        A = np.stack([v / (1 + v), np.ones_like(v)], axis=1) / loss[:, None]
        return A, np.asarray(np.linalg.lstsq(A, np.ones(x.size))[0], dtype=np.float64)

    def cost(q: float) -> float:
        A, s = parts(q)
        return float(np.sum((A @ s - 1) ** 2))

    grid = np.linspace(middle - 4, middle + 4, 81)
    at = grid[int(np.argmin([cost(q) for q in grid]))]
    bent = scipy.optimize.minimize_scalar(
        cost, bounds=(at - 0.2, at + 0.2), method="bounded", options={"xatol": 1e-10}
    ).x
    A, s = parts(bent)
    if s[0] < 0:  # the loss falls with strain: none of it is this law's
        s = np.array([0.0, np.sum(1 / loss) / np.sum(1 / loss**2)])
    return _Loss(float(s[0]), float(np.exp(bent)), float(s[1]), A @ s * loss, float(np.sum((A @ s - 1) ** 2)))


def _with_D(gamma: Array, G: Array, D: float, p: float, loss: _Loss) -> _Found:
    """The best law of this D, G (n,) being G′; storage and loss are two problems of their own."""
    x = np.log(gamma)
    middle = float(x.mean())
    weight = 1 / G**2 / np.sum(1 / G**2)

    def storage(q: Array) -> Array:
        """With the constant under it that serves best."""
        shape = D * (1 + np.exp(p * (x - q[0]))) ** (-np.exp(np.clip(q[1], -9.0, 9.0)) / p)
        return np.asarray(shape + weight @ (G - shape))

    starts = [np.array([middle + d, s]) for d, s in ((-0.3, -1.5), (0.3, -0.5), (1.3, 0.8))]
    fits = [
        scipy.optimize.least_squares(
            lambda q: storage(q) / G - 1, s, method="lm", xtol=1e-12, ftol=1e-14, max_nfev=400
        )
        for s in starts
    ]
    first = min(fits, key=lambda r: float(r.cost))
    gamma_c, m = (float(v) for v in np.exp(first.x))
    shape = D * (1 + (gamma / gamma_c) ** p) ** (-m / p)
    linear = complex(float(weight @ (G - shape)), loss.constant)
    model = storage(first.x) + 1j * loss.model
    return _Found((gamma_c, m, loss.Lm, loss.gamma_l), linear, model, float(2 * first.cost) + loss.cost)


def _open_range(found: Any, fall: float) -> tuple[float, float, _Found]:
    """Lowest and highest D whose storage is rendered as well as may be asked, and the best of all."""
    values = fall * np.geomspace(*_FACTORS, 13)
    laws = [found(float(v)) for v in values]
    costs = np.array([law.cost for law in laws])
    k = int(np.argmin(costs))
    limit = _OPEN * costs[k]

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
