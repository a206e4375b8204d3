"""Receptances between bearings, loads and outputs, line by line, with G*(ω) of any law.

The structure without its bearings falls into blocks; what each answers at its few coordinates of interest is
B D⁻¹ Bᵀ. A block that neither turns nor has a law other than Maxwell's is taken apart once into its poles,
D⁻¹ = Σ v wᵀ/(iω − λ); the others are solved frequency by frequency. Blocks are joined through a reference
stiffness and damping of the bearings, (I + R Z)⁻¹ R, so that a rotor which floats without them does not stand
out; what the reference takes away the balance gives back.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property, lru_cache

import numpy as np

from bearingdyn.analysis.linearised import Linear
from bearingdyn.analysis.steady.layer_lines import SoftLayers, soft_layers
from bearingdyn.material import Maxwell, answer_of
from bearingdyn.system import System
from bearingdyn.types import Array, Complex, Index

# digits that joining floating blocks may cost, as in csrc/harmonic.c
LARGEST_JOINT = 1e6
# of a block's answer, by which its poles may miss it: else it is solved frequency by frequency
POLES_AGREE = 1e-10


@dataclass(frozen=True, eq=False)
class Poles:
    """Poles λ (p,) of one block's receptances, D⁻¹ = right (n, p) · 1/(iω − λ) · left (p, n)."""

    values: Complex
    right: Complex
    left: Complex

    @classmethod
    def of(cls, block: System) -> Poles | None:
        """Poles of a block at rest, in modes that something holds; or None where they miss its answer.

        From u = (ω q, q̇, √(2G) of each branch's strain), in which the block is a skew matrix and what
        dissipates: its poles are then well conditioned.
        """
        n = block.n
        w = np.sqrt(np.diag(block.stiffness("relaxed")))
        branches = [
            (math.sqrt(2.0 * G) * term.L, tau)
            for term in block.layers
            for G, tau in zip(term.material.G, term.material.tau, strict=True)
            if G > 0.0
        ]
        strength = np.hstack([np.zeros((n, 0)), *(S for S, _ in branches)])
        rates = np.concatenate([np.zeros(0), *(np.full(S.shape[1], 1.0 / tau) for S, tau in branches)])
        A = np.zeros((2 * n + len(rates),) * 2)
        A[:n, n : 2 * n] = np.diag(w)
        A[n : 2 * n, :n] = -np.diag(w)
        A[n : 2 * n, n : 2 * n] = -block.viscous()
        A[n : 2 * n, 2 * n :] = -strength
        A[2 * n :, n : 2 * n] = strength.T
        A[2 * n :, 2 * n :] = -np.diag(rates)
        values, vectors = np.linalg.eig(A)
        try:
            left = np.asarray(np.linalg.inv(vectors)[:, n : 2 * n], dtype=np.complex128)
            right = np.asarray(vectors[:n] / w[:, None], dtype=np.complex128)
            found = cls(np.asarray(values, dtype=np.complex128), right, left)
            scale = np.sort(np.abs(values))[: max(len(values) // 2, 1)].max()
            for omega in (1e-3 * scale, 0.1 * scale, scale):
                exact = np.linalg.inv(dynamic_stiffness(block, np.array([omega]), 0.0)[0])
                with np.errstate(all="ignore"):  # undamped, it may stand on a pole: then it does not agree
                    own = found.right @ (found.left / (1j * omega - values)[:, None])
                if not np.abs(own - exact).max() <= POLES_AGREE * np.abs(exact).max():
                    return None
        except np.linalg.LinAlgError:
            return None
        return found

    def answer(self, omega: Array, rows: Array, forces: Array | Complex) -> Complex:
        """rows (k, n) D⁻¹ forces (n, i) at every ω, (f, k, i)."""
        right, left = rows @ self.right, self.left @ forces
        residues = (right.T[:, :, None] * left[:, None, :]).reshape(len(self.values), -1)
        at = 1.0 / (1j * omega[:, None] - self.values)
        return np.asarray((at @ residues).reshape(len(omega), len(rows), forces.shape[1]))


def dynamic_stiffness(block: System, omega: Array, speed: float) -> Complex:
    """Receptances' inverse, the dynamic stiffness D (f, n, n) of a system without its bearings."""
    still, moving = block.K + speed * block.N, block.C + speed * block.G
    w = 1j * omega[:, None, None]
    D = np.asarray(still + w * moving + w**2 * block.M, dtype=np.complex128)
    for term in block.layers:
        G = answer_of(term.material, omega)
        D += 2.0 * G[:, None, None] * (term.L @ term.L.T)
    return np.asarray(D)


def part_of(system: System, block: Index) -> System:
    """One block of a system by itself, for its receptances: its matrices and layers alone."""
    inside = np.ix_(block, block)
    return System(
        M=system.M[inside],
        C=system.C[inside],
        G=system.G[inside],
        K=system.K[inside],
        N=system.N[inside],
        layers=tuple(replace(t, L=t.L[block]) for t in system.layers if np.abs(t.L[block]).any()),
    )


@dataclass(frozen=True, eq=False)
class Block:
    """A block of receptances: its coordinates, itself, and its poles if they do not move with speed."""

    index: Index
    system: System
    poles: Poles | None

    @classmethod
    def of(cls, system: System, index: Index) -> Block:
        """A block, its poles found if it has any to keep."""
        own = part_of(system, index)
        still = not (own.G.any() or own.N.any()) and all(isinstance(t.material, Maxwell) for t in own.layers)
        held = still and bool((np.diag(own.stiffness("relaxed")) > 0.0).all())
        return cls(index, own, Poles.of(own) if held else None)

    def answer(self, omega: Array, speed: float, rows: Array, forces: Array | Complex) -> Complex:
        """rows (k, n) D⁻¹ forces (n, i), (f, k, i)."""
        if self.poles is not None:
            return self.poles.answer(omega, rows, forces)
        D = dynamic_stiffness(self.system, omega, speed)
        right = np.broadcast_to(forces, (len(omega), *forces.shape)).astype(np.complex128)
        return np.asarray(rows @ np.linalg.solve(D, right))


@lru_cache(maxsize=4)
def taken_apart(system: System) -> tuple[System, Array, tuple[Block, ...]]:
    """For receptances at many speeds, a system once in its modes, x = T q, T and its blocks."""
    if any(not isinstance(t.material, Maxwell) for t in system.layers):
        modal, T = system, np.eye(system.n)
    else:
        modal, T = system.modal()
    return modal, T, tuple(Block.of(modal, index) for index in modal.blocks())


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

    @property
    def soft(self) -> SoftLayers:
        """The layers that soften."""
        return soft_layers(self.system)

    @property
    def of_layers(self) -> slice:
        """The coordinates of layers that soften among all."""
        return slice(len(self.system.B), len(self.K))

    @cached_property
    def _bearings(self) -> tuple[Array, Array]:
        """The reference of the bearings alone."""
        own = slice(len(self.system.B))
        return self.K[own, own], self.C[own, own]

    @property
    def blocks(self) -> tuple[Block, ...]:
        """The blocks of the structure."""
        return taken_apart(self.system)[2]

    @property
    def modal(self) -> tuple[System, Array]:
        """The system in modes of its own, x = T q, in which blocks are well scaled."""
        return taken_apart(self.system)[:2]

    def reference(self, omega: Array) -> Complex:
        """Z (f, m, m) = K + iωC of the reference, with what lubricated balls add."""
        return np.asarray(self.K + 1j * omega[:, None, None] * self.C + self.films(omega))

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
            turned = self._at_rest + speed * self.system.N if self.system.N.any() else self._at_rest
            out[rest] = rows @ np.linalg.solve(turned, np.transpose(forces))
        if not rest.all():
            out[~rest] = self._joined(omega[~rest], speed, rows, forces)
        return out

    @cached_property
    def _at_rest(self) -> Array:
        """D (n, n) at 0 Hz with the reference on, and springs on free motions that no bearing feels."""
        linear = Linear(self.system, *self._bearings)
        moduli = np.array([answer_of(t.material, 0.0).item() for t in self.system.layers])
        held = linear.held_at_rest(moduli, np.vstack([np.zeros(self.system.n), self.B]))
        K = held.K + self.B.T @ self.K @ self.B
        for layer, G in zip(self.system.layers, moduli.real, strict=True):
            K += 2.0 * G * (layer.L @ layer.L.T)
        return np.asarray(K)

    def _whole(self, omega: Array, speed: float, rows: Array, forces: Complex | Array) -> Complex:
        """All coordinates at once."""
        linear = Linear(self.system, *self._bearings, self.balls)
        found = np.zeros((len(omega), len(rows), len(forces)), dtype=np.complex128)
        for unit, part in ((1.0, np.real(forces)), (1j, np.imag(forces))):
            # as unit forces: what is no larger than their round-off drives nothing
            size = np.abs(part).max(axis=1, initial=0.0)
            if size.any():
                driven = part / np.where(size > 0.0, size, 1.0)[:, None]
                found += unit * size * linear.solve(omega, driven, rows, speed)
        return found

    def _joined(self, omega: Array, speed: float, rows: Array, forces: Complex | Array) -> Complex:
        """Block by block, joined through the reference; all at once where that would cost digits."""
        _, T = self.modal
        m = len(self.B)
        above = np.vstack([self.B, rows]) @ T
        right = np.vstack([self.B, forces]) @ T
        free = np.zeros((len(omega), len(above), len(right)), dtype=np.complex128)
        for block in self.blocks:
            touched = np.flatnonzero(np.abs(above[:, block.index]).any(axis=1))
            driven = np.flatnonzero(np.abs(right[:, block.index]).any(axis=1))
            if touched.size and driven.size:
                rows_in, forces_in = (
                    np.asarray(of[np.ix_(which, block.index)])
                    for of, which in ((above, touched), (right, driven))
                )
                own = block.answer(omega, speed, rows_in, forces_in.T)
                free[np.ix_(np.arange(len(omega)), touched, driven)] += own
        if not m:
            return free
        joint = np.eye(m) + free[:, :m, :m] @ self.reference(omega)
        held = np.linalg.solve(joint, free[:, :m])
        out = free[:, m:, m:] - free[:, m:, :m] @ (self.reference(omega) @ held[:, :, m:])
        lost = np.flatnonzero(~(np.abs(joint).max(axis=(1, 2)) <= LARGEST_JOINT))
        for k in lost:
            out[k] = self._whole(omega[k : k + 1], speed, rows, forces)[0]
        return out
