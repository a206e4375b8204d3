"""A layer that softens with its own strain: its factor, its weights in that strain, its form in a march."""

from __future__ import annotations

from typing import Any

import numpy as np

from bearingdyn.cms import Viscoelastic, coupled_blocks
from bearingdyn.kept_by_object import kept_by_object
from bearingdyn.system.matrix_factor import factor
from bearingdyn.system.terms import LayerTerm
from bearingdyn.types import Array


@kept_by_object
def _linear_factor(term: Viscoelastic) -> Array:
    return factor(term.H)


def softening_factor(term: Viscoelastic, part: str) -> tuple[Array, Array | None]:
    """Of a layer that softens L (n, rank), weights (rank,) of its coordinates Lᵀx in γ²; None without law.

    The strain that counts has the squares Σ (χ_i x_i …): with the concentration χ of each coordinate,
    γ² = 2 (χx)ᵀ H (χx)/V. L is turned so that both forms are diagonal.

    Raises
    ------
    ValueError
        For a law of softening on rubber whose volume is not known.
    """
    L = _linear_factor(term)
    if getattr(term.material, "payne", None) is None:
        return L, None
    if term.volume is None:
        raise ValueError(
            f"part {part!r} has a law of softening (payne), and the volume of its rubber is not known: give "
            f"Viscoelastic(material, H, volume=...), or the material without: material.with_payne(None)"
        )
    if term.concentration is None:
        return L, np.full(L.shape[1], 2.0 / term.volume)
    turned, strain = np.zeros_like(L), np.zeros(L.shape[1])
    for block in coupled_blocks(term.H):  # which L keeps apart
        columns = np.flatnonzero((L[block] != 0.0).any(axis=0))
        own = L[np.ix_(block, columns)]
        # rigid motion stays rigid when scaled, so that χL = L Qᵀ
        Q = (np.linalg.pinv(own) @ (term.concentration[block, None] * own)).T
        weights, turn = np.linalg.eigh(Q.T @ Q)
        turned[np.ix_(block, columns)] = own @ turn
        strain[columns] = 2.0 / term.volume * np.maximum(weights, 0.0)
    return turned, strain


def marched_layer(layer: LayerTerm, memory: float | None) -> tuple[Any, ...]:
    """Softening layer as a march takes it: L, strengths and times of its branches, and how it softens."""
    if layer.strain is None:
        return layer.L, np.asarray(layer.material.G), np.asarray(layer.material.tau)
    if memory is None:
        raise ValueError(
            f"layer {layer.part!r} softens with its amplitude, and memory is None; give the time, s, over "
            f"which it remembers it: five periods of the slowest motion"
        )
    law, rest = layer.material.payne, layer.material.rest
    softening = (
        law.D,
        law.gamma_c,
        law.m,
        law.Lm,
        law.gamma_l,
        law.p,
        float(memory),
        layer.material.G0 - rest.G0,
        np.asarray(layer.strain),
        *rest.omega,
        rest.lacks,
    )
    return layer.L, rest.G, rest.tau, softening
