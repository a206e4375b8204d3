"""The band of a response whose materials are not exactly known."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace

import numpy as np

from bearingdyn.analysis.equilibrium import Equilibrium, equilibrium
from bearingdyn.application import Application
from bearingdyn.checks import number, reals, require, whole
from bearingdyn.material import Maxwell, normals
from bearingdyn.notice import Notice
from bearingdyn.system import System, system_of
from bearingdyn.types import Array

SEED = 0


@dataclass(frozen=True)
class Band:
    """Response band, or that of another real quantity, over draws: its ends and the median."""

    lower: Array
    median: Array
    upper: Array


def band_of(draws: Array, coverage: float) -> Band:
    """Band of a response over draws: covers this share of further draws, at each place by itself.

    Parameters
    ----------
    draws
        (draws, ...), real.
    coverage
        Share between 0 and 1.

    Returns
    -------
    Band
        Of quantiles whose expected coverage is exact: k of n draws lie below with k/(n + 1).

    Raises
    ------
    ValueError
        For a share that is none, and for too few draws for it.
    """
    remedy = "it must be a share between 0 and 1, as 0.9"
    share = number("coverage", coverage, remedy)
    require(0 < share < 1, "coverage", coverage, remedy)
    least = int(np.ceil(2 / (1 - share) - 1e-9)) - 1
    draws = reals("draws", draws, "they must be real numbers, the draws first")
    count = len(draws) if draws.ndim else 0
    remedy = f"a band over {share:g} of them needs at least {least}"
    require(count >= least, "number of draws", count, remedy)
    tail = (1 - share) / 2
    ends = np.quantile(draws, [tail, 0.5, 1 - tail], axis=0, method="weibull")
    return Band(*ends)


def drawn_sources(
    source: Equilibrium | Application | System, n: int, seed: int = SEED
) -> Iterator[Equilibrium | System]:
    """For a response's band: the source with its layers' materials drawn from their spreads, n times.

    Layers of equal material are of one batch, and drawn together. An equilibrium is found anew for each draw.

    Parameters
    ----------
    source
        As `frequency_response` takes it.
    n
        Number of draws.
    seed
        Of the Sobol sequence's scrambling.

    Raises
    ------
    ValueError
        Where no layer's material has a spread; for one of the bulk modulus, which stands in the matrices.
    """
    n = whole("uncertainty", n, 2)
    system = source.system if isinstance(source, Equilibrium) else system_of("source", source)
    kinds: list[Maxwell] = []
    for layer in system.layers:
        m = layer.material
        if isinstance(m, Maxwell) and m.spread is not None and m.spread.axes and m not in kinds:
            remedy = (
                f"layer {layer.part!r} has its bulk modulus in its matrices; build the machine for each "
                f"draw, with study.band"
            )
            require(m.spread.K == 0, "Maxwell.spread.K", m.spread.K, remedy)
            kinds.append(m)
    require(
        bool(kinds),
        "uncertainty",
        n,
        "no layer's material has a spread; fit it with fit_maxwell, or use material.with_spread(level=…)",
    )
    ends = np.cumsum([0, *(len(m.uncertain().axes) for m in kinds)])
    for z in normals(n, int(ends[-1]), seed):
        drawn = [m.drawn(z[a:b]) for m, a, b in zip(kinds, ends, ends[1:], strict=False)]
        layers = tuple(
            replace(t, material=drawn[kinds.index(t.material)]) if t.material in kinds else t
            for t in system.layers
        )
        changed = replace(system, layers=layers)
        if isinstance(source, Equilibrium):
            yield _again(source, changed)
        else:
            yield changed


def _again(eq: Equilibrium, system: System) -> Equilibrium:
    """The equilibrium of a system that differs a little, in the same state of its layers."""
    if eq.after is not None:
        return equilibrium(system, start=eq, after=eq.after, average=eq.average)
    return equilibrium(system, start=eq, modulus=eq.modulus, average=eq.average)


def response_band(
    source: Equilibrium | Application | System,
    response: Callable[[Equilibrium | System], Array],
    n: int,
    coverage: float,
) -> Band:
    """Band of the magnitude of a complex response over n draws of the layers' materials.

    Parameters
    ----------
    source
        As `frequency_response` takes it.
    response
        Of a drawn source, complex.
    n
        Number of draws.
    coverage
        Share of further draws that the band covers.
    """
    band_of(np.zeros((whole("uncertainty", n, 2), 1)), coverage)
    with warnings.catch_warnings():  # the response itself has warned
        warnings.simplefilter("ignore", Notice)
        return band_of(np.array([np.abs(response(s)) for s in drawn_sources(source, n)]), coverage)
