"""What is not known of a rubber: named sources of doubt with their intervals, and the rubber in them."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike

from bearingdyn.checks import instance, number, positive, real, require, two
from bearingdyn.material.doubt import SIGMA, Doubt
from bearingdyn.material.fit_report import FitReport
from bearingdyn.material.log_parameters import logarithms as logarithms_of
from bearingdyn.material.log_parameters import moved
from bearingdyn.material.maxwell import Maxwell
from bearingdyn.material.random_numbers import uniforms
from bearingdyn.material.superposition import MasterCurve
from bearingdyn.pictures import page
from bearingdyn.plausible_ranges import check_bulk
from bearingdyn.short_repr import short
from bearingdyn.types import Array

_LATE = 100.0  # times the reach, at which a modulus relaxes that the data leave open: 1 % loss at their end
_GRID = 40  # frequencies of a band at which a fit's doubt is weighed
_SMALL = 1e-5  # of a logarithm, for a slope


@dataclass(frozen=True, eq=False)
class Doubts:
    """The doubts about one rubber, as `doubts` finds them; a mapping by name, and a source of materials.

    Attributes
    ----------
    material
        The rubber as it is.
    sources
        Each doubt.
    """

    material: Maxwell
    sources: tuple[Doubt, ...]

    __repr__ = short
    _repr_html_ = page

    def __iter__(self) -> Iterator[str]:
        return iter(d.name for d in self.sources)

    def __len__(self) -> int:
        return len(self.sources)

    def __getitem__(self, name: str) -> Doubt:
        """The doubt of a name; ValueError naming those that there are."""
        for d in self.sources:
            if d.name == name:
                return d
        raise ValueError(f"doubt is {name!r}; there are {list(self)}")

    def ranges(self) -> dict[str, tuple[float, float]]:
        """Interval of each by name, as `study.sobol` takes them."""
        return {d.name: (d.low, d.high) for d in self.sources}

    def varied(self, **values: float) -> Maxwell:
        """The rubber with these values of its doubts, the rest being nominal.

        Parameters
        ----------
        **values
            By name.

        Returns
        -------
        Maxwell
            "level", "specimen" and "fit" multiply all moduli in shear; "loss" multiplies tan δ in the middle
            of the band and leaves |G*| there; "relaxed" multiplies G0 and leaves what the data tell as it is;
            "temperature" is how much warmer it is, °C, its band staying where it was measured.

        Raises
        ------
        ValueError
            For an unknown name, or a value that is not finite.
        """
        given = {self[name].name: number(name, value) for name, value in values.items()}
        m = replace(self.material, doubts=())
        if given.get("loss", 1.0) != 1.0:
            assert m.band is not None  # a fit has one
            middle = 2 * math.pi * math.sqrt(m.band[0] * m.band[1])
            m = replace(m.with_loss_factor(given["loss"] * float(m.loss_factor(middle)), middle), fit=m.fit)
        if "relaxed" in given:
            m = _relaxing(m, given["relaxed"])
        factor = math.prod(given.get(name, 1.0) for name in ("level", "specimen", "fit"))
        m = replace(
            m,
            G0=m.G0 * factor,
            G=m.G * factor,
            eta0=m.eta0 * factor,
            K=given.get("K", m.K),
            payne=None if m.payne is None else m.payne.scaled(factor),
            low_end=None if m.low_end is None else m.low_end.moved(1.0, factor),
        )
        warmer = given.get("temperature", 0.0)
        if warmer:
            assert m.temperature is not None  # `doubts` asked for a law
            # what was measured stays measured
            m = replace(m.at(m.temperature + warmer), band=self.material.band, temperature=m.temperature)
        return m

    def drawn(self, u: ArrayLike) -> Maxwell:
        """The rubber at a point u of the unit cube, (len(self),), 0 < u < 1, by the quantile of each."""
        point = real(u)
        require(point.shape == (len(self),), "u", u, f"it must be ({len(self)},): one for each of {[*self]}")
        return self.varied(**{d.name: float(d.quantile(x)) for d, x in zip(self.sources, point, strict=True)})

    def carried(self) -> Maxwell:
        """The rubber as it is, with its doubts (`Maxwell.doubts`), so that a file of it keeps them."""
        return replace(self.material, doubts=self.sources)

    def draws(self, n: int, seed: int = 0) -> list[Maxwell]:
        """n rubbers drawn from all doubts at once, by a scrambled Sobol sequence, the same for one seed."""
        return [self.drawn(u) for u in uniforms(n, len(self), seed)]


def doubts(
    material: Maxwell,
    master: MasterCurve | None = None,
    *,
    level: ArrayLike | None = None,
    specimen: ArrayLike | None = None,
    K: ArrayLike | None = None,
    temperature: ArrayLike | None = None,
    relaxed: ArrayLike | None = None,
    after: float = 3600.0,
) -> Doubts:
    """Name the doubts about a rubber, what is not known of it: what its data tell, and what the user adds.

    Parameters
    ----------
    material
        Its fit gives the doubts "fit" and "loss": factors on |G*| and on tan δ in its band, by its bootstrap
        or covariance, as normal sources. Its low end gives "relaxed": the factors on G0 that its data allow.
        Doubts that it carries (`Doubts.carried`) stand, unless the same is given or found anew.
    master
        The curve it was fitted to. Runs that disagree give "level": from the stiffest to the softest of them.
    level
        (low, high) factor on all moduli in shear; instead of what the runs say.
    specimen
        (low, high) factor on them, for what a specimen's shape and thickness leave open: a disc read by G A/t
        is softer than the rubber by `specimen_factor`, so (1, 1/factor).
    K
        (low, high) bulk modulus, Pa; rubber without fillers has some 2 GPa, of others 1 to 3 GPa are told.
    temperature
        (low, high) by how much it is warmer than the material says, °C.
    relaxed
        (low, high) factor on G0, instead of what the data allow.
    after
        Time, s, that a load has rested for: the data allow a modulus then, and none forever.

    Returns
    -------
    Doubts

    Raises
    ------
    ValueError
        For intervals that do not hold the nominal value, a temperature without shift law, and where nothing
        is in doubt: no fit, no runs, and nothing given.

    Examples
    --------
    >>> import bearingdyn as bd
    >>> rubber = bd.Maxwell(G0=1e6, G=[2e6], tau=[1e-4], K=2e9, density=1150.0)
    >>> unknown = bd.doubts(rubber, K=(1e9, 3e9), specimen=(1.0, 1.034))
    >>> list(unknown), unknown.varied(specimen=1.034).G0
    (['specimen', 'K'], 1034000.0)
    """
    instance("material", material, Maxwell, "give a Maxwell model: fit_maxwell makes one")
    instance("master", master, (MasterCurve, type(None)), "give the master curve, or None")
    found: list[Doubt] = []

    def given(name: str, value: ArrayLike | None, nominal: float, unit: str = "1") -> None:
        if value is not None:
            low, high = two(name, value, f"it must be (low, high), {unit if unit != '1' else 'factors'}")
            found.append(Doubt(name, nominal, float(low), float(high), "given", unit=unit))

    if level is None and master is not None and len(set(master.levels.values())) > 1:
        own = [1.0 / f for f in master.levels.values()]
        words = f"runs {', '.join(master.levels)} disagree"
        found.append(Doubt("level", 1.0, min(own), max(own), words))
    given("level", level, 1.0)
    given("specimen", specimen, 1.0)
    given("K", K, material.K, "Pa")
    for end in () if K is None else (found[-1].low,):
        check_bulk("K", end, material.G0)
    if temperature is not None:
        require(material.law is not None, "temperature", temperature, "the material has no shift law")
    given("temperature", temperature, 0.0, "°C")
    if relaxed is None and not any(d.name == "relaxed" for d in material.doubts):
        found += _long_times(material, positive("after", after, "it must be a positive time, s"))
    elif relaxed is not None:
        require(material.G0 > 0, "relaxed", relaxed, "the material has no relaxed modulus")
        given("relaxed", relaxed, 1.0)
        high = 1.0 + float(material.G.sum()) / material.G0
        require(found[-1].high < high, "relaxed", relaxed, f"all branches together allow {high:.3g}")
        require(found[-1].low >= 0, "relaxed", relaxed, "a factor on G0 is 0 or more")
    if material.fit is not None and material.fit.names:
        found += _fitted(material, material.fit)
    known = {d.name for d in found}
    for carried in material.doubts:
        if carried.name in known:
            continue
        if carried.name == "K":
            remedy = f"the material that carries it has another K, {material.K:g} Pa: give K=(low, high)"
            require(carried.nominal == material.K, "nominal K of a doubt", carried.nominal, remedy)
        found.append(carried)
    remedy = "nothing is in doubt: give its master curve, or intervals such as K=(1e9, 3e9)"
    require(bool(found), "material", material, remedy)
    return Doubts(material, tuple(found))


def _long_times(m: Maxwell, after: float) -> list[Doubt]:
    """Doubt in G0 by what the data say of a long time, s; none where they say all, or nothing."""
    end = m.low_end
    if end is None or not m.G0 > 0:
        return []
    value = float(m.relaxation(after, doubt=False))
    low, high = end.bounds(after, value)
    # a spring may be what the data do not see relax; of a plateau they see all
    late = m.G.sum() if end.plateau else m.G[m.tau >= end.reach].sum()
    low, high = min(low / value, 1.0), max(min(high / value, 1.0 + float(late) / m.G0), 1.0)
    if not low < high:
        return []
    words = f"the data reach {end.reach:.3g} s" + (
        ", with a plateau" if end.plateau else f" of {after:.3g} s"
    )
    return [Doubt("relaxed", 1.0, low, high, words)]


def _relaxing(m: Maxwell, factor: float) -> Maxwell:
    """With G0 times a factor, and the modulus that the data tell left as it is.

    What the spring loses relaxes long after the data end; what it gains, the slowest branches lose.
    """
    if factor <= 1.0:
        reach = m.low_end.reach if m.low_end is not None else float(m.tau.max(initial=1.0))
        G, tau = np.append(m.G, (1.0 - factor) * m.G0), np.append(m.tau, _LATE * reach)
    else:
        G, tau, left = m.G.copy(), m.tau, (factor - 1.0) * m.G0
        for k in np.argsort(tau)[::-1]:
            taken = min(left, float(G[k]))
            G[k] -= taken
            left -= taken
    end = m.low_end
    if end is not None and m.band is not None:
        end = replace(
            end, interval=(min(end.interval[0], factor * m.G0), max(end.interval[1], factor * m.G0))
        )
    return replace(m, G0=factor * m.G0, G=G, tau=tau, low_end=end)


def _fitted(m: Maxwell, fit: FitReport) -> list[Doubt]:
    """Doubt that a fit leaves in the modulus of its band: "fit", a factor on it, and "loss", one on tan δ.

    By the refits of the bootstrap where there are any, else by its covariance. Strengths one by one may be
    wide open where the modulus is not, so that it is the modulus that is asked.
    """
    omega = 2 * np.pi * np.geomspace(*fit.band, _GRID)
    bare = replace(m, fit=None, band=None, low_end=None)

    def logarithms(step: Array) -> Array:
        G0, G, tau, eta0 = moved(bare, fit.names, step)
        modulus = replace(bare, G0=G0, G=G, tau=tau, eta0=eta0).complex_modulus(omega)
        return np.concatenate([np.log(np.abs(modulus)), np.log(modulus.imag / modulus.real)])

    if len(fit.bootstrap) > 1:
        own = logarithms_of(m, fit.names)
        deviation = np.std([logarithms(row - own) for row in fit.bootstrap], axis=0, ddof=1)
        words = f"bootstrap of the fit, {len(fit.bootstrap)} refits"
    else:
        small = _SMALL * np.eye(len(fit.names))
        J = np.array([(logarithms(e) - logarithms(-e)) / (2 * _SMALL) for e in small]).T
        deviation = np.sqrt(np.maximum(np.einsum("fp,pq,fq->f", J, fit.covariance, J), 0.0))
        words = "scatter of the points about the fit"
    names = ("fit", "loss") if m.G0 > 0 and m.G.any() else ("fit",)
    wide = np.exp(SIGMA * np.sqrt(np.mean(deviation.reshape(2, -1) ** 2, axis=1))).tolist()
    return [
        Doubt(name, 1.0, 1.0 / w, w, words, "normal") for name, w in zip(names, wide, strict=False) if w > 1.0
    ]
