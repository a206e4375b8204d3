"""What a Maxwell model keeps beside the law of softening, for the time domain.

In time the law is a spring E and a Maxwell branch of strength 2 L whose rate is the running frequency Ω. The
rest, G_lin(ω) − F(γr) − i L(γr), has to be a Maxwell model itself; as its loss is less than its storage's
slope would have it (Kramers and Kronig), it is rendered within a percent or so, never with too much.
What it lacks at Ω is added there, to the law's branch and to a branch so slow that it bears no lasting
load: a spring that followed Ω would lose some of that load whenever it weakens.

One tone then meets the law to round-off. Of several, those away from Ω meet what was added for Ω. Of a model
with a band the rest is fitted so that this is nearly right there, too: its loss is left so short that the
branch of rate Ω, which adds it, brings the slope of the storage as well. What stays is a tenth of a percent
of the modulus at 1.6 Ω, for −i L(γr), the same at all frequencies, is no Maxwell model's.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import scipy
from numpy.typing import NDArray

from bearingdyn.short_repr import short
from bearingdyn.types import Array, Complex

_POINTS = 80  # of the fit, evenly in ln ω
_APART = 1.6  # ratio of a second tone's frequency to Ω at which the fit makes what is added for Ω right, too
_FILL = 1e-4  # weight of what is left to add at Ω itself: it is added, so that it only decides between equals
_LOSS = 10.0  # in that, weight of the loss against the storage
_LEAST = 0.1  # of a material's loss that may stay where the law would take more: near the ends of a band
TABLE = 129  # frequencies of the correction, evenly in ln ω: it is linear between them
_DECADE = 10.0  # of a model without a band: so far beyond its times


@dataclass(frozen=True)
class Rest:
    """The rest of a law of softening: a Maxwell model of G_lin − F(γr) − i L(γr), and what it misses.

    Attributes
    ----------
    G0, G, tau, eta0
        As those of Maxwell.
    omega
        First and last angular frequency it was fitted between, rad/s.
    misses
        (TABLE,) rest less what it should be, Pa, complex, at frequencies evenly spaced in ln ω between them.
    lacks
        (2, TABLE) what is added there, Pa, none of it negative: to the strength of the slow branch, and to
        the law's loss, whose branch brings as much storage.
    """

    G0: float
    G: Array
    tau: Array
    eta0: float
    omega: tuple[float, float]
    misses: Complex
    lacks: Array

    __repr__ = short

    def complex_modulus(self, omega: Any) -> Complex:
        """G*, Pa, at ω rad/s, any shape."""
        w = np.asarray(omega, dtype=np.float64)
        x = w[..., None] * self.tau
        return np.asarray(self.G0 + 1j * w * self.eta0 + (x / (1 + x * x) * (x + 1j)) @ self.G)

    def lacking(self, rate: float) -> tuple[float, float]:
        """`lacks`, Pa, at an angular frequency, rad/s: linear between its points over ln ω, held outside."""
        at = np.linspace(math.log(self.omega[0]), math.log(self.omega[1]), self.lacks.shape[1])
        storage, loss = (float(np.interp(math.log(rate), at, values)) for values in self.lacks)
        return storage, loss


def held_at(material: Any, gamma: float, rate: float) -> Any:
    """The Maxwell model that a march has of one with a law of softening, while the amplitude stays.

    Parameters
    ----------
    material
        Maxwell model with a law.
    gamma, rate
        Shear strain amplitude, and mean angular frequency, rad/s.
    """
    law, rest = material.payne, material.rest
    storage, loss = rest.lacking(rate)
    spring, branch = float(law.elastic(gamma)), float(law.loss(gamma)) + loss
    return replace(
        material,
        # the slow branch is a spring to what lasts no longer than the memory
        G0=rest.G0 + spring + storage,
        G=np.append(rest.G, 2.0 * branch),
        tau=np.append(rest.tau, 1.0 / rate),
        payne=None,
    )


def rest_of(material: Any) -> Rest:
    """The rest of a Maxwell model with a law of softening.

    Raises
    ------
    ValueError
        Where the law takes more storage, or loss, than the model has: one of them is of another rubber.
    """
    law = material.payne
    band = _band(material)
    omega = np.geomspace(*band, _POINTS)
    F, L = float(law.storage(law.gamma_r)), float(law.loss(law.gamma_r))
    linear = _modulus(material, omega)
    wanted = linear - F - 1j * L
    if not np.all(wanted.real > 0):
        worst = int(np.argmin(wanted.real))
        raise ValueError(
            f"payne: the law's breakable storage at the isotherms' strain, {F:.4g} Pa, exceeds the storage "
            f"modulus {linear.real[worst]:.4g} Pa that the material has at "
            f"{omega[worst] / 2 / math.pi:.3g} Hz: the law is of a harder rubber; scale it, law.scaled(...)"
        )
    shapes, target = _shapes(material.tau, omega), wanted - 1j * omega * material.eta0
    # never too much loss: the law's branch can add some, and take none away; nor too much storage, with
    # what that branch brings. All of it is linear in the strengths, and so is what is left to add
    allowed = np.maximum(target.imag, _LEAST * (linear.imag - omega * material.eta0))
    size = np.abs(linear)[:, None]
    left = ((_LOSS - 1.0) * shapes.imag + shapes.real) / size
    within = _within_times(material.tau, omega)
    of = omega[within]
    off, aimed = [], []
    for ratio in (_APART, 1.0 / _APART):
        # at `ratio` times Ω: what the rest misses there, less what is added for Ω: a spring, and a branch
        # of rate Ω with the loss that is missed, whose storage at Ω that spring is short of
        added = 2j * ratio / (1j * ratio + 1.0) - 1.0
        near, meant = shapes[within], target[within]
        there = _shapes(material.tau, ratio * of) - near.real - near.imag * added
        own = _modulus(material, ratio * of) - F - 1j * (L + ratio * of * material.eta0)
        own = own - meant.real - meant.imag * added
        off += [there.real / size[within], there.imag / size[within]]
        aimed += [own.real / size[within, 0], own.imag / size[within, 0]]
    scale = float(np.median(linear.real))
    # a model without a band may be asked far beyond its times, where its loss falls below what the law takes.
    # Between the times a second tone suffers from that, and is not asked for
    fill = _FILL if material.band is not None else 1.0 / _FILL
    errors, goals = scale * np.vstack(off), np.concatenate(aimed)
    # unknown beside the strengths: the largest of the four errors at each Ω
    largest = -np.tile(np.eye(of.size), (len(off), 1))
    limits = np.vstack([shapes.imag, shapes.real - shapes.imag])
    found = scipy.optimize.linprog(
        np.concatenate([-fill * scale * left.sum(axis=0), np.ones(of.size)]),
        A_ub=np.block(
            [
                [errors, largest],
                [-errors, largest],
                [limits, np.zeros((len(limits), of.size))],
            ]
        ),
        b_ub=np.concatenate([goals, -goals, allowed / scale, (target.real - allowed) / scale]),
    ).x[: shapes.shape[1]]
    G0, G = scale * float(found[0]), scale * found[1:]
    at = np.geomspace(*band, TABLE)
    branches = 1j * at * material.eta0 + _shapes(material.tau, at)[:, 1:] @ G
    misses = G0 + branches - (_modulus(material, at) - F - 1j * L)
    loss = np.maximum(-misses.imag, 0.0)
    spare = min(max(float((misses.real + loss).max()), 0.0), G0)
    misses = misses - spare
    lacks = np.stack([np.maximum(-misses.real - loss, 0.0), loss])
    return Rest(G0 - spare, G, material.tau, material.eta0, band, misses, lacks)


def _within_times(tau: Array, omega: Array) -> NDArray[np.bool_]:
    """Which ω lie between the rates of a model's branches; all, where none does."""
    within = np.zeros(omega.shape, dtype=bool)
    if tau.size:
        within = (omega * tau.max() >= 1.0) & (omega * tau.min() <= 1.0)
    return within if within.any() else ~within


def _shapes(tau: Array, omega: Array) -> Complex:
    """(ω, 1 + n) G* of a spring and of each branch, over their strengths."""
    x = omega[:, None] * tau
    return np.column_stack([np.ones_like(omega), x / (1 + x * x) * (x + 1j)])


def _modulus(material: Any, omega: Array) -> Complex:
    """G*, Pa, without the warning of a band."""
    strengths = np.concatenate([[material.G0], material.G])
    return np.asarray(1j * omega * material.eta0 + _shapes(material.tau, omega) @ strengths)


def _band(material: Any) -> tuple[float, float]:
    """Angular frequencies, rad/s, between which the rest is sought."""
    if material.band is not None:
        return 2 * math.pi * material.band[0], 2 * math.pi * material.band[1]
    if not material.tau.size:
        return 1.0, 1e5
    return 1 / (_DECADE * float(material.tau.max())), _DECADE / float(material.tau.min())
