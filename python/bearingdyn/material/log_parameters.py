"""Logarithms of a Maxwell model's parameters by the names of a fit: ln G0, ln G1 …, ln tau1 …, ln eta0."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Protocol

import numpy as np

from bearingdyn.types import Array


class HasParameters(Protocol):
    """What has parameters whose logarithms are taken: spring, strengths, times and dashpot of `Maxwell`."""

    @property
    def G0(self) -> float: ...
    @property
    def G(self) -> Array: ...
    @property
    def tau(self) -> Array: ...
    @property
    def eta0(self) -> float: ...


def place_of(name: str) -> tuple[str, int]:
    """Place of a logarithmic parameter by its name: ("G", 2) of "ln G2", ("tau", 1) of "ln tau1"."""
    plain = name.removeprefix("ln ")
    stem = plain.rstrip("0123456789")
    return stem, int(plain[len(stem) :])


def logarithms(model: HasParameters, names: Sequence[str]) -> Array:
    """Logarithms (len(names),) of these parameters of a Maxwell model."""
    found = []
    for kind, k in map(place_of, names):
        if kind == "G":
            found.append(model.G[k - 1] if k else model.G0)
        else:
            found.append(model.tau[k - 1] if kind == "tau" else model.eta0)
    return np.asarray(np.log(found))


def moved(model: HasParameters, names: Sequence[str], step: Array) -> tuple[float, Array, Array, float]:
    """A Maxwell model's parameters, the logarithms of some moved by `step`."""
    G0, G, tau, eta0 = model.G0, model.G.copy(), model.tau.copy(), model.eta0
    for (kind, k), factor in zip(map(place_of, names), np.exp(step), strict=True):
        if kind == "tau":
            tau[k - 1] *= factor
        elif kind == "eta":
            eta0 *= factor
        elif k == 0:
            G0 *= factor
        else:
            G[k - 1] *= factor
    return G0, G, tau, eta0
