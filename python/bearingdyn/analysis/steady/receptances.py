"""Receptances between bearings, loads and outputs, line by line, with G*(ω) of any law.

The structure answers through a reference stiffness and damping of the bearings, so that a rotor which floats
without them does not stand out; what the reference takes away the balance gives back. What moves is the
harmonic response of the core, what stands a solve with G*(0).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
import scipy

from bearingdyn import core
from bearingdyn.analysis.linearised import Linear
from bearingdyn.analysis.steady.layer_lines import SoftLayers, soft_layers
from bearingdyn.kept_by_object import kept_by_object
from bearingdyn.system import System
from bearingdyn.types import Array, Complex, Index

# reference stiffnesses of a system of which its answer at 0 Hz is kept
REFERENCES = 4
# sets of forces whose answer at rest is kept
FORCES = 4


@dataclass(frozen=True, eq=False)
class AtRest:
    """Receptances at 0 Hz: D + Ω N, factored for all speeds.

    N, of damping that turns, has few rows that are not zero, E their unit columns and n what stands in them:

        (D + Ω E n)⁻¹ F = X − Ω Y (1 + Ω n Y)⁻¹ n X,   X = D⁻¹ F,   Y = D⁻¹ E
    """

    triangles: tuple[Array, Index]
    turning: Array
    gives: Array
    felt: Array
    free: dict[bytes, tuple[Array, Array]] = field(default_factory=dict)

    @classmethod
    def of(cls, D: Array, N: Array) -> AtRest:
        """Of D and N (n, n)."""
        triangles = scipy.linalg.lu_factor(D)
        own = np.flatnonzero(N.any(axis=1))
        gives = scipy.linalg.lu_solve(triangles, np.eye(len(D))[:, own])
        return cls(triangles, N[own], gives, N[own] @ gives)

    def solve(self, speed: float, forces: Array) -> Array:
        """Motions (n, i) under forces (n, i) at a speed, rad/s."""
        X, turned = self._without_speed(forces)
        if not len(self.turning):
            return X
        share = np.linalg.solve(np.eye(len(self.felt)) + speed * self.felt, speed * turned)
        return np.asarray(X - self.gives @ share)

    def _without_speed(self, forces: Array) -> tuple[Array, Array]:
        """X and n X; those of the last few forces are kept, as every speed asks them anew."""
        key = forces.tobytes()
        known = self.free.get(key)
        if known is None:
            if len(self.free) >= FORCES:
                self.free.clear()
            X, _ = scipy.linalg.lapack.dgetrs(*self.triangles, forces)
            known = self.free[key] = np.asarray(X), self.turning @ X
        return known


@dataclass(frozen=True, eq=False)
class Kept:
    """Of one system, for receptances at many speeds: its model in the core, and what it answers at rest.

    Parameters
    ----------
    model
        The core's.
    at_rest
        By the bytes of a reference stiffness, D at 0 Hz with it.
    """

    model: core.Model
    at_rest: dict[bytes, AtRest]


@kept_by_object
def kept(system: System) -> Kept:
    """Make ready what receptances of a system need at every speed."""
    return Kept(system.model([], relaxed=False), {})


@dataclass(frozen=True, eq=False)
class Receptances:
    """Receptances of a system without its balls' forces but with a reference of them.

    Parameters
    ----------
    system
        The system.
    K, C
        Reference stiffness and damping (m, m) of all bearings' coefficients; none of the layers' coordinates.
    balls
        What lubricated balls add by frequency, as `Equilibrium.balls` says; None: nothing.
    """

    system: System
    K: Array
    C: Array
    balls: Callable[[Array], tuple[Complex, Array] | None] | None = None

    @cached_property
    def B(self) -> Array:
        """All bearings' coefficients, and the coordinates of layers that soften (m, n)."""
        return np.vstack([self.system.B, self.soft.rows(self.system.n)])

    @cached_property
    def soft(self) -> SoftLayers:
        """The layers that soften."""
        return soft_layers(self.system)

    @cached_property
    def of_layers(self) -> slice:
        """The coordinates of layers that soften among all."""
        return slice(len(self.system.B), len(self.K))

    @cached_property
    def _bearings(self) -> tuple[Array, Array]:
        """The reference of the bearings alone."""
        own = slice(len(self.system.B))
        return self.K[own, own], self.C[own, own]

    def films(self, omega: Array) -> Complex:
        """What lubricated balls add to the tangents (f, m, m); nothing at 0 Hz, where their law holds."""
        found = np.zeros((len(omega), *self.K.shape), dtype=np.complex128)
        moving = omega != 0.0
        balls = self.balls and self.balls(omega[moving])
        if balls:
            k, v = balls
            own = slice(v.shape[1])
            found[moving, own, own] = np.einsum("fb,bk,bl->fkl", k, v, v, optimize=True)
        return found

    def answer(self, omega: Array, speed: float, rows: Array, forces: Complex | Array) -> Complex:
        """Motions rows (k, n) with the reference on, under forces (i, n), (f, k, i)."""
        out = np.zeros((len(omega), len(rows), len(forces)), dtype=np.complex128)
        rest = omega == 0.0
        if rest.any():
            # a mean has no imaginary part
            out[rest] = rows @ self._standing.solve(speed, np.real(forces).T)
        if not rest.all():
            out[~rest] = self._moving(omega[~rest], speed, rows, forces)
        return out

    @cached_property
    def _standing(self) -> AtRest:
        """D at 0 Hz with the reference on, and springs on free motions that no bearing feels."""
        known, key = kept(self.system).at_rest, self.K.tobytes()
        if key not in known:
            if len(known) >= REFERENCES:
                known.clear()
            known[key] = AtRest.of(self._found_at_rest(), self.system.N)
        return known[key]

    def _found_at_rest(self) -> Array:
        linear = Linear(self.system, *self._bearings)
        moduli = linear.moduli(np.zeros(1))[0]
        held = linear.held_at_rest(moduli, np.vstack([np.zeros(self.system.n), self.B]))
        K = held.K + self.B.T @ self.K @ self.B
        for layer, G in zip(self.system.layers, moduli.real, strict=True):
            K += 2.0 * G * (layer.L @ layer.L.T)
        return np.asarray(K)

    def _moving(self, omega: Array, speed: float, rows: Array, forces: Complex | Array) -> Complex:
        """The same where no ω is 0; at −ω the conjugate of what unit forces give at ω."""
        backwards, omega = omega < 0.0, np.abs(omega)
        modulus = Linear(self.system, *self._bearings).moduli(omega)
        balls = self.balls and self.balls(omega)
        found = np.zeros((len(omega), len(rows), len(forces)), dtype=np.complex128)
        for unit, part in ((1.0, np.real(forces)), (1j, np.imag(forces))):
            # as unit forces: what is no larger than their round-off drives nothing
            size = np.abs(part).max(axis=1, initial=0.0)
            if not size.any():
                continue
            driven = part / np.where(size > 0.0, size, 1.0)[:, None]
            own = core.harmonic(
                kept(self.system).model, omega, modulus, *self._bearings, driven, rows, speed, None, balls
            )
            own[backwards] = own[backwards].conj()
            found += unit * size * own
        return found
