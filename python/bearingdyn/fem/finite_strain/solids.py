"""Solids in a deformed state: their elements are those of fem.solid_matrices, at finite strain.

What an element keeps of its volume is what it keeps of div u in the linear theory, so that undeformed all
matrices are those of that theory. In tetrahedra, wedges and pyramids of rubber the inner bubble moves so that
J keeps no linear part: three equations for its three coordinates, solved in each element.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from bearingdyn.fem.finite_strain.deformed import CURRENT, Deformed
from bearingdyn.fem.meshes.solid_element import BUBBLES, HEX20, SolidElement, points, shapes
from bearingdyn.fem.meshes.solid_mesh import SolidMesh
from bearingdyn.fem.node_pairs import NodePairs
from bearingdyn.fem.solid_matrices import bubble_gradients, gradients, pressure_modes
from bearingdyn.material import Hyperelastic
from bearingdyn.types import Array, Index

BLOCK = 128  # elements whose rows are in memory at a time, 20 MB of 27-node bricks
BUBBLE_STEPS = 12  # of Newton's method for the bubble's place; from the linear one it takes three or four


@dataclass(frozen=True, eq=False, kw_only=True)
class SolidElements:
    """Elements of a solid at finite strain, before its deformation.

    Parameters
    ----------
    mesh
        Undeformed.
    laws
        Of each region, in the mesh's order, for a shear modulus of one.
    shear, bulk
        Of each region, Pa.
    incompressible
        Of each region, whether its elements are those of nearly incompressible rubber.
    """

    mesh: SolidMesh
    laws: Sequence[Hyperelastic]
    shear: Sequence[float]
    bulk: Sequence[float]
    incompressible: Sequence[bool]

    @cached_property
    def blocks(self) -> list[_Block]:
        """All elements, in blocks of one kind and region."""
        found = []
        for region, own in enumerate(self.mesh.regions.values()):
            for kind, of_kind in self.mesh.groups:
                at = own[np.isin(own, of_kind)]
                for start in range(0, len(at), BLOCK):
                    nodes = self.mesh.elements[at[start : start + BLOCK], : kind.nodes]
                    found.append(self._block(kind, nodes, region))
        return found

    def _block(self, kind: SolidElement, nodes: Index, region: int) -> _Block:
        p = self.mesh.points[nodes]
        X, w = points(kind)
        bubble = x = volume = None
        soft = self.incompressible[region]
        if soft and kind in BUBBLES:
            D, dV, bubble, x = bubble_gradients(kind, p)
            x = x / np.cbrt(dV.sum(axis=1))[:, None, None]
            modes = np.concatenate([np.ones((*dV.shape, 1)), x], axis=2)
        else:
            D, dV = gradients(kind, p, X, w)
            modes = pressure_modes(kind, p, X, shapes(kind, X)[0], dV) if soft else _pointwise(dV)
        if soft and kind is HEX20:  # its volume is kept at fewer points than its shape
            G, dG = gradients(kind, p, *points(kind, reduced=True))
            volume = _Points(_by_points(G), dG, _pointwise(dG), 0.0, self.bulk[region], self.laws[region])
        bulk = 0.0 if volume is not None else self.bulk[region]
        shape = _Points(_by_points(D), dV, modes, self.shear[region], bulk, self.laws[region])
        return _Block(nodes=nodes, region=region, shape=shape, volume=volume, bubble=bubble)

    @cached_property
    def pairs(self) -> NodePairs:
        """The pattern of all matrices."""
        return NodePairs.of([block.nodes for block in self.blocks], len(self.mesh.points))

    def state(self, u: Array) -> SolidState:
        """The solid displaced by u (3 nodes,): x, y, z of each node in turn."""
        return SolidState(self, u.reshape(-1, 3))


def _pointwise(dV: Array) -> Array:
    """Functions for a pressure of its own at each point."""
    q = dV.shape[1]
    return np.broadcast_to(np.eye(q), (len(dV), q, q))


def _by_points(D: Array) -> Array:
    """∂N/∂X as (m, q, k, 3), from (m, 3 k, q)."""
    m, _, q = D.shape
    return np.ascontiguousarray(D.transpose(0, 2, 1)).reshape(m, q, -1, 3)


@dataclass(frozen=True, eq=False)
class _Points:
    """Integration points of elements: ∂N/∂X (m, q, k, 3), volumes, functions of the pressure, moduli."""

    gradient: Array
    weights: Array
    modes: Array
    shear: float
    bulk: float
    law: Hyperelastic

    def deformed(self, F: Array) -> Deformed:
        m = len(F)
        return Deformed(
            F=F,
            weights=self.weights,
            modes=self.modes,
            laws=[(np.arange(m), self.law)],
            shear=np.full(m, self.shear),
            bulk=np.full(m, self.bulk),
        )


@dataclass(frozen=True, eq=False, kw_only=True)
class _Block:
    """Elements of one kind and region: points for shape, for volume where those differ, and a bubble."""

    nodes: Index
    region: int
    shape: _Points
    volume: _Points | None
    bubble: Array | None

    def moved(self, u: Array) -> _Moved:
        """The block with its nodes displaced by u (nodes, 3)."""
        own = u[self.nodes]  # (m, k, 3)
        if self.bubble is None:
            return _Moved(self, own, None)
        # its bubble starts where the linear theory has it
        H = _displaced(self.shape.gradient, own)
        x, w = self.shape.modes[..., 1:], self.shape.weights[..., None]
        b, still = np.zeros((len(own), 3)), np.eye(3)
        with np.errstate(all="ignore"):  # a trial step may turn elements inside out
            for _ in range(BUBBLE_STEPS):
                F = still + H + np.einsum("ma,mqb->mqab", b, self.bubble)
                J = np.linalg.det(F)
                away = np.einsum("mqx,mq->mx", x * w, J - 1.0)
                cofactor = J[..., None, None] * _inverse(F)
                moved = np.einsum("mqx,mqb,mqba->mxa", x * w, self.bubble, cofactor, optimize=True)
                if not np.all(np.isfinite(moved)):
                    break
                step = np.linalg.solve(moved, away[..., None])[..., 0]
                b = b - step
                if np.abs(step).max() <= 1e-15 * np.abs(own).max():
                    break
        return _Moved(self, own, b)


def _displaced(gradient: Array, u: Array) -> Array:
    """∂u/∂X (m, q, 3, 3) of nodes displaced by u (m, k, 3)."""
    m, q, k, _ = gradient.shape
    flat = gradient.transpose(0, 1, 3, 2).reshape(m, 3 * q, k)
    return np.ascontiguousarray((flat @ u).reshape(m, q, 3, 3).transpose(0, 1, 3, 2))


def _inverse(F: Array) -> Array:
    """F⁻¹ (m, q, 3, 3); no error for singular ones, which a trial step may make."""
    a, b, c = F[..., 0, :], F[..., 1, :], F[..., 2, :]
    adjugate = np.stack([np.cross(b, c), np.cross(c, a), np.cross(a, b)], axis=-1)
    with np.errstate(all="ignore"):
        return np.asarray(adjugate / np.linalg.det(F)[..., None, None])


@dataclass(frozen=True, eq=False)
class _Moved:
    """A block in its deformed place: displacements (m, k, 3) of its nodes, and (m, 3) of its bubbles."""

    block: _Block
    u: Array
    b: Array | None

    @cached_property
    def shape(self) -> Deformed:
        """Points for the change of shape."""
        F = _displaced(self.block.shape.gradient, self.u)
        if self.b is not None and self.block.bubble is not None:
            F += np.einsum("ma,mqb->mqab", self.b, self.block.bubble)
        return self.block.shape.deformed(F + np.eye(3))

    @cached_property
    def volume(self) -> Deformed | None:
        """Points for the change of volume, where they are others."""
        own = self.block.volume
        return None if own is None else own.deformed(np.eye(3) + _displaced(own.gradient, self.u))

    @property
    def parts(self) -> list[tuple[Deformed, Array]]:
        """All points, and their rows of spatial gradients by the nodes' coordinates."""
        found = [(self.shape, self._followed)]
        if self.volume is not None and self.block.volume is not None:
            found.append((self.volume, _rows(self.block.volume.gradient, self.volume.F)))
        return found

    @property
    def _all_rows(self) -> Array:
        """B (m, q, 9, c) by nodes, and by the bubble behind them."""
        gradient = self.block.shape.gradient
        if self.block.bubble is not None:
            gradient = np.concatenate([gradient, self.block.bubble[:, :, None]], axis=2)
        return _rows(gradient, self.shape.F)

    @property
    def _followed(self) -> Array:
        """B (m, q, 9, 3 k) by the nodes, whom a bubble follows."""
        B = self._all_rows
        if self.b is None:
            return B
        D = self.shape.swelling_rows(B)[:, 1:]  # of the linear part of J
        follow = -np.linalg.solve(D[..., -3:], D[..., :-3])
        return np.asarray(B[..., :-3] + B[..., -3:] @ follow[:, None])

    @cached_property
    def _reaction(self) -> Array:
        """Coefficients (m, 3, 1) of the linear pressure that keeps the bubble in its place."""
        B = self._all_rows
        D = self.shape.swelling_rows(B)[:, 1:, -3:]
        pull = self.shape.force(B[..., -3:])
        return np.asarray(-np.linalg.solve(D.transpose(0, 2, 1), pull[..., None]))

    @property
    def pressures(self) -> Array:
        """Coefficients of the pressure, one after the other."""
        return np.concatenate([part.pressures.ravel() for part, _ in self.parts])

    def pressures_after(self, du: Array) -> Array:
        """Those that a further displacement (nodes, 3) leads to, linearised."""
        own = du[self.block.nodes].reshape(len(self.u), -1)
        return np.concatenate([part.pressures_after(B, own).ravel() for part, B in self.parts])

    def force(self) -> Array:
        """(m, 3 k), N."""
        return np.asarray(sum(part.force(B) for part, B in self.parts))

    def stiffness(self, pressures: Array | None) -> Array:
        """Static tangent (m, 3 k, 3 k), N/m, its geometric part at given pressures."""
        total, start = np.zeros(()), 0
        for part, B in self.parts:
            size = part.modes.shape[0] * part.modes.shape[2]
            p = part.pressures
            if pressures is not None:
                p = pressures[start : start + size].reshape(p.shape)
            start += size
            if self.b is not None:
                p = np.concatenate([p[:, :1], self._reaction], axis=1)
            total = total + part.stiffness(B, p)
        return np.asarray(total)

    def deviatoric(self, branches: str) -> Array:
        """H (m, 3 k, 3 k), m; see Deformed.deviatoric."""
        return self.shape.deviatoric(self._followed, branches)


def _rows(gradient: Array, F: Array) -> Array:
    """B (m, q, 9, 3 k): spatial gradients l_ij, i and then j, of nodes with ∂N/∂X (m, q, k, 3)."""
    g = gradient @ _inverse(F)
    m, q, k, _ = g.shape
    B = np.zeros((m, q, 3, 3, k, 3))
    for a in range(3):
        B[:, :, a, :, :, a] = g.transpose(0, 1, 3, 2)
    return B.reshape(m, q, 9, 3 * k)


@dataclass(frozen=True, eq=False)
class SolidState:
    """State of a solid at finite strain.

    Parameters
    ----------
    body
        The elements before deformation.
    u
        (nodes, 3) displacement of the nodes, m.
    """

    body: SolidElements
    u: Array

    @property
    def points(self) -> Array:
        """Where the nodes are now, (nodes, 3), m."""
        return np.asarray(self.body.mesh.points + self.u)

    @cached_property
    def _moved(self) -> list[_Moved]:
        return [block.moved(self.u) for block in self.body.blocks]

    @property
    def elements(self) -> Iterator[tuple[Index, Deformed]]:
        """Nodes (m, k) of blocks of elements, and stretch, stress, stability at their points."""
        for moved in self._moved:
            yield moved.block.nodes, moved.shape

    @property
    def volume_ratio(self) -> float:
        """The least of J at the points."""
        found = [part.J for moved in self._moved for part in (moved.shape, moved.volume) if part is not None]
        least = min(float(J.min()) for J in found)
        return least if np.isfinite(least) else -1.0

    @property
    def energy(self) -> float:
        """Stored energy, J."""
        return sum(
            part.energy for moved in self._moved for part in (moved.shape, moved.volume) if part is not None
        )

    @cached_property
    def force(self) -> Array:
        """Forces (3 nodes,) that hold the nodes where they are, N."""
        n = len(self.u)
        total = np.zeros((n, 3))
        for moved in self._moved:
            f = moved.force().reshape(-1, 3)
            at = moved.block.nodes.ravel()
            total += np.stack([np.bincount(at, f[:, a], n) for a in range(3)], axis=1)
        return total.ravel()

    @cached_property
    def pressures(self) -> Array:
        """Coefficients of the pressure in each element, Pa."""
        return np.concatenate([moved.pressures for moved in self._moved])

    def pressures_after(self, du: Array) -> Array:
        """Those that a further displacement (3 nodes,) leads to, linearised, Pa."""
        by_nodes = du.reshape(-1, 3)
        return np.concatenate([moved.pressures_after(by_nodes) for moved in self._moved])

    def tangent(self, pressures: Array | None = None) -> Any:
        """∂force/∂u, sparse (3 nodes, 3 nodes), N/m; its geometric part at given pressures, if any."""
        given: list[Array | None] = [None] * len(self._moved)
        if pressures is not None:
            sizes = [moved.pressures.size for moved in self._moved]
            given = list(np.split(pressures, np.cumsum(sizes)[:-1]))
        own = dict(zip(map(id, self._moved), given, strict=True))
        return self._gathered(lambda moved: moved.stiffness(own[id(moved)]))

    def _gathered(self, matrix: Callable[[_Moved], Array], regions: Sequence[int] | None = None) -> Any:
        pairs = self.body.pairs
        sums = pairs.zeros()
        for group, moved in enumerate(self._moved):
            if regions is None or moved.block.region in regions:
                pairs.add(sums, group, matrix(moved))
        return pairs.matrix(sums)

    def stiffness(self, regions: Sequence[int]) -> Any:
        """Static tangent of some regions, sparse (3 nodes, 3 nodes), N/m."""
        return self._gathered(lambda moved: moved.stiffness(None), regions)

    def deviatoric(self, regions: Sequence[int], branches: str = CURRENT) -> Any:
        """H of some regions, sparse (3 nodes, 3 nodes), m: what of their tangent the frequency changes."""
        return self._gathered(lambda moved: moved.deviatoric(branches), regions)
