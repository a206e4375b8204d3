"""Layers that soften in a steady motion: the strain of each from all its lines, and what softening takes.

Beside the bearings' coefficients stand the coordinates y of the layers, as further unknowns of the balance;
the structure answers with the modulus of the isotherms, and what the softening takes away is a force on them,
line by line,

    2 [G*(ω_n, γ, Ω) − G_lin(ω_n)] y_n,   γ² = Σ_n strain |y_n|²,   Ω² = Σ_n ω_n² γ_n²/γ²

of the lines n without the mean. At the equilibrium, y_s, the spring D bears P y_s of the lasting load, P what
G0 has more than the rest of the law; as it weakens to E it loses what broke, as in a march,

    2 [E (y_0 − y_s) + (E/D) P y_s − P y_0]

more than G0 bears. So Newton's iteration has the strains in it, and its derivative is a number on each line
and two products of rank one for a layer.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from itertools import pairwise
from typing import Any

import numpy as np

from bearingdyn.analysis.softening import NO_STRAIN, softening_layers
from bearingdyn.kept_by_object import kept_by_object
from bearingdyn.material import Maxwell, held_at
from bearingdyn.system import LayerTerm, System
from bearingdyn.types import Array, Complex


@dataclass(frozen=True, eq=False)
class Softened:
    """What softening does along one steady motion of the layers (l) that soften.

    Parameters
    ----------
    strain, mean
        (l,) strain amplitude of each, and its mean angular frequency, rad/s.
    change, lasting
        (L, k) the force on each coordinate is change y + lasting.
    by, of
        (q, L, k): the force changes by Σ_q by_q Re Σ conj(of_q) dy besides.
    """

    strain: Array
    mean: Array
    change: Complex
    lasting: Complex
    by: Complex
    of: Complex

    def forced(self, y: Complex) -> Complex:
        """Change of force (L, k) by that of strain and mean frequency alone, of a change y (L, k)."""
        sizes = np.einsum("qlk,lk->q", self.of.conj(), y).real
        return np.asarray(np.einsum("q,qlk->lk", sizes, self.by))


@dataclass(frozen=True, eq=False)
class SoftLayers:
    """The layers of a steady motion that soften, in coordinates y (k,) of the size of a motion, m."""

    layers: tuple[LayerTerm, ...]

    @cached_property
    def slots(self) -> list[slice]:
        """Of every layer its coordinates among y."""
        ends = np.cumsum([0, *(layer.L.shape[1] for layer in self.layers)]).tolist()
        return [slice(a, b) for a, b in pairwise(ends)]

    @cached_property
    def scales(self) -> list[float]:
        """Of every layer what its own coordinates Lᵀx are divided by, √m."""
        return [float(np.linalg.norm(layer.L, 2)) or 1.0 for layer in self.layers]

    def rows(self, n: int) -> Array:
        """(k, n) of y = rows x."""
        own = [layer.L.T / scale for layer, scale in zip(self.layers, self.scales, strict=True)]
        return np.vstack([np.zeros((0, n)), *own])

    def along(self, y: Complex, omega: Array, standing: Array) -> Softened:
        """What softening does along amplitudes y (L, k) of lines omega (L,), rad/s, about `standing` (k,)."""
        count = len(self.layers)
        if not count:
            none = np.zeros((0, *y.shape), dtype=np.complex128)
            return Softened(np.zeros(0), np.zeros(0), np.zeros_like(y), np.zeros_like(y), none, none)
        strain, mean = np.zeros(count), np.ones(count)
        change = np.zeros(y.shape, dtype=np.complex128)
        lasting = np.zeros_like(change)
        by, of = np.zeros((2, 2 * count, *y.shape), dtype=np.complex128)
        moving, resting = np.flatnonzero(omega != 0.0), np.flatnonzero(omega == 0.0)
        w = omega[moving]
        slowest = float(np.abs(w).min()) if w.size else 1.0
        for k, (layer, own, scale) in enumerate(zip(self.layers, self.slots, self.scales, strict=True)):
            weight = np.asarray(layer.strain) * scale**2
            z = y[moving, own]
            squares = (np.abs(z) ** 2) @ weight
            gamma = float(np.sqrt(squares.sum()))
            law = layer.material.payne
            still = gamma < NO_STRAIN
            rate = slowest if still else float(np.sqrt(squares @ w**2)) / gamma
            strain[k], mean[k] = gamma, rate
            stiff = 2.0 * scale**2
            change[moving, own] = stiff * law.change(w, gamma, rate)[:, None]
            E, P = float(law.elastic(gamma)), borne(layer.material)
            change[resting, own] = stiff * (E - P)
            lost = (1.0 - P / law.D) * standing[own]
            lasting[resting, own] = -stiff * E * lost
            if still:
                continue
            slope, turned = law.slope(gamma), 1j * w / (1j * w + rate)
            over_strain = slope.real - slope.imag + 2.0 * slope.imag * turned
            over_mean = -2.0 * float(law.loss(gamma)) * turned / (1j * w + rate)
            by[2 * k, moving, own] = stiff * over_strain[:, None] * z
            of[2 * k, moving, own] = weight * z / gamma**2
            by[2 * k, resting, own] = stiff * (slope.real - slope.imag) * (y[resting, own] - lost)
            by[2 * k + 1, moving, own] = stiff * over_mean[:, None] * z
            of[2 * k + 1, moving, own] = weight * (w**2 - rate**2)[:, None] * z / (rate * gamma**2)
        return Softened(strain, mean, change, lasting, by, of)


def borne(material: Any) -> float:
    """P, Pa, of a steady motion's lasting load: what the relaxed modulus has more than the law's rest."""
    if isinstance(material, Maxwell):
        return material.G0 - material.rest.G0
    return float(material.payne.storage(material.payne.gamma_r))


@kept_by_object
def soft_layers(system: System) -> SoftLayers:
    """The layers of a system that soften in its steady motions; maybe none."""
    return SoftLayers(tuple(system.layers[k] for k in softening_layers(system)))


def frozen(system: System, softened: Softened | None, band: tuple[float, float]) -> System:
    """For stability of a steady motion, the system whose layers keep the amplitude that they have in it.

    Laws without branches are taken as their Maxwell models in `band`, Hz.
    """
    if softened is None or not softened.strain.size:
        return system
    held: list[LayerTerm] = list(system.layers)
    for number, k in enumerate(softening_layers(system)):
        law: Any = held[k].material
        if not isinstance(law, Maxwell):
            law = law.with_payne(None).maxwell("auto", band=band).with_payne(law.payne)
        at = held_at(law, float(softened.strain[number]), float(softened.mean[number]))
        held[k] = replace(held[k], material=at, strain=None)
    return replace(system, layers=tuple(held))
