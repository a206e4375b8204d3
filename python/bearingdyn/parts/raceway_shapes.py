"""Shapes of one order of a ring, chosen by what its raceways and interfaces feel up to a frequency.

From static shapes at several moduli and the answers to their inertia, and the motion at a few frequencies (a rational
Krylov space), a rich basis is made. Of it the fewest shapes are kept whose receptances at the raceways,
transmissions and dynamic stiffness at the interfaces are those of the rich one over 0…f_max.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import scipy

from bearingdyn.cms import orthogonalise
from bearingdyn.fem import Harmonic, factorise
from bearingdyn.short import short
from bearingdyn.types import Array, Complex, Index

PROMISE = 1e-2  # f_max: receptances are right to this up to there
WANTED = 4e-3  # what the choice aims at against the rich basis, which is itself not the whole
STILL = 4e-4  # the same at rest, at any modulus
LOSS = 0.02  # loss factor at which a part without rubber is judged: no error is told at an undamped resonance
MOMENTS = 2  # answers to inertia, beyond the static shapes
PATH = 24  # frequencies at which the small models are compared


@dataclass(frozen=True, eq=False, kw_only=True)
class PortShapes:
    """Shapes of one order.

    Parameters
    ----------
    Psi
        (n, columns): unit motions of the interfaces, rigid motions where nothing is held, internal shapes.
    faces, rigid
        How many of the first two there are.
    error
        Estimate of the largest relative error of the receptances over 0…f_max.
    """

    Psi: Array
    faces: int
    rigid: int
    error: float

    __repr__ = short


@dataclass(frozen=True, eq=False, kw_only=True)
class Order:
    """One order of a body of revolution: its matrices, what is held, and its ports.

    Parameters
    ----------
    h
        Matrices.
    bulk, density
        Of each region, Pa and kg/m³.
    held, R
        Coordinates on rigid faces, and their shapes, a column each.
    ports
        (p, n) rows of the raceways' coefficients.
    """

    h: Harmonic
    bulk: Sequence[float]
    density: Sequence[float]
    held: Index
    R: Array
    ports: Array

    @property
    def inner(self) -> Index:
        """Coordinates that are not held."""
        return np.setdiff1d(self.h.free, self.held)

    def dynamic(self, shear: Any, omega: float) -> Any:
        """Dynamic stiffness (n, n), sparse."""
        return self.h.stiffness(self.bulk, shear) - omega**2 * self.h.mass_matrix(self.density)

    def motion(self, shear: Any, omega: float) -> tuple[Complex, Complex]:
        """Motion (n, faces + ports) of the whole model under unit motions of the faces and unit port loads, and
        what the ports and faces feel (see `felt`)."""
        D = self.dynamic(shear, omega)
        inner, r = self.inner, self.R.shape[1]
        load = np.hstack([-(D[inner][:, self.held] @ self.R), self.ports[:, inner].T])
        u = np.zeros((self.h.n, load.shape[1]), dtype=np.complex128)
        u[self.held, :r] = self.R
        lu = scipy.sparse.linalg.splu(D[inner][:, inner].tocsc().astype(np.complex128))
        u[inner] = lu.solve(load.astype(np.complex128))
        T = np.vstack([u[:, :r].T @ (D @ u), self.ports @ u])
        return u, T


def felt(D: Complex, L: Array, faces: int) -> Complex:
    """(faces + ports, faces + ports): reaction of the faces and motion of the ports, by unit motions of the faces and
    unit loads on the ports, of a small model of dynamic stiffness D and ports L."""
    r = faces
    load = np.hstack([-D[r:, :r], L[:, r:].T])
    u = np.zeros((len(D), load.shape[1]), dtype=np.complex128)
    u[:r, :r] = np.eye(r)
    u[r:] = np.linalg.solve(D[r:, r:], load)
    return np.vstack([(D @ u)[:r], L @ u])


def misfit(got: Complex, wanted: Complex, scale: Array) -> float:
    """Relative error of what is felt, each entry by the geometric mean of its two ports' own sizes."""
    return float(np.linalg.norm((got - wanted) / scale, 2) / max(np.linalg.norm(wanted / scale, 2), 1.0))


def own_scale(T: Sequence[Complex]) -> list[Array]:
    """Sizes by which entries are judged at each point: of its ports there, but no antiresonance counts for less than a
    tenth of what is usual."""
    own = np.array([np.abs(np.diag(t)) for t in T])
    own = np.maximum(own, 0.1 * np.median(own, axis=0))
    return [np.sqrt(np.outer(a, a)) for a in own]


def port_shapes(
    order: Order,
    levels: Sequence[Sequence[float]],
    shear: Callable[[float], Sequence[complex]],
    f_max: float,
    slow: float,
) -> PortShapes:
    """Shapes of one order.

    Parameters
    ----------
    levels
        Shear moduli of the regions, Pa, at which static shapes are taken; the first is the reference.
    shear
        G*(ω) of the regions, Pa; ω in rad/s.
    f_max
        Hz; 0: static shapes alone.
    slow
        Rate, 1/s, that holds a free body while its elastic answer is sought.
    """
    h, inner, r = order.h, order.inner, order.R.shape[1]
    M = h.mass_matrix(order.density)
    K = h.stiffness(order.bulk, levels[0])
    rigid = np.zeros((h.n, 0))
    if not order.held.size and h.order <= 1:
        motion = np.zeros((h.n, 2 if h.order else 1))
        motion[h.free] = h.rigid_shapes(np.arange(h.mesh.r.size))[h.free]
        rigid = np.linalg.solve(np.linalg.cholesky(motion.T @ (M @ motion)), motion.T).T
    faces, rich = _rich(order, levels, M, rigid, slow if rigid.size else 0.0)
    if f_max > 0:
        top = 2 * np.pi * f_max
        for omega in (top, 0.6 * top):
            u, _ = order.motion(_lossy(shear(omega), levels), omega)
            u[:, :r] -= faces
            rich.append(np.hstack([u.real, u.imag]))
    shapes = np.hstack(rich)
    shapes -= rigid @ (rigid.T @ (M @ shapes))
    energy = np.sum(shapes * (K @ shapes), axis=0)
    shapes = shapes[:, energy > 0] / np.sqrt(energy[energy > 0])
    frequency, shapes = orthogonalise(shapes, K, M)
    shapes = shapes / (2 * np.pi * frequency)  # of unit energy
    small = _Small(order, np.hstack([faces, rigid, shapes]), r, rigid.shape[1])
    kept, error = small.choose(levels, shear, f_max)
    _, internal = orthogonalise(shapes @ kept, K, M)
    return PortShapes(Psi=np.hstack([faces, rigid, internal]), faces=r, rigid=rigid.shape[1], error=error)


def _lossy(shear: Sequence[complex], levels: Sequence[Sequence[float]]) -> Complex:
    """The moduli, with a loss where nothing has one."""
    G = np.asarray(shear, dtype=np.complex128)
    return G if np.abs(G.imag).max() > 0 else G * (1 + 1j * LOSS)


def _rich(
    order: Order, levels: Sequence[Sequence[float]], M: Any, rigid: Array, slow: float
) -> tuple[Array, list[Array]]:
    """Unit motions of the faces (n, r) at the first level; static shapes at all levels, and answers to inertia."""
    h, inner, r = order.h, order.inner, order.R.shape[1]
    faces = np.zeros((h.n, r))
    rich = []
    for level in levels:
        K = h.stiffness(order.bulk, level)
        lu = factorise((K + slow**2 * M)[inner][:, inner])
        load = np.hstack([-(K[inner][:, order.held] @ order.R), order.ports[:, inner].T])
        u = np.zeros((h.n, load.shape[1]))
        u[order.held, :r] = order.R
        u[inner] = lu.solve(np.asarray(load, order="F"))
        if level is levels[0]:
            faces = u[:, :r].copy()
        else:
            rich.append(u[:, :r] - faces)
        rich.append(u[:, r:])
        for _ in range(MOMENTS):
            u -= rigid @ (rigid.T @ (M @ u))
            answer = np.zeros_like(u)
            answer[inner] = lu.solve(np.asarray((M @ u)[inner], order="F"))
            rich.append(answer)
            u = answer
    return faces, rich


class _Small:
    """The model in the rich basis, and the choice of the shapes that are felt."""

    def __init__(self, order: Order, Psi: Array, faces: int, rigid: int) -> None:
        h = order.h
        self.r, self.fixed = faces, faces + rigid
        self.L = order.ports @ Psi
        self.several = len(self.L) > 2
        self.rigid = self.L[:, faces : self.fixed] @ self.L[:, faces : self.fixed].T
        zero = [0.0] * len(order.bulk)
        self.M = Psi.T @ (h.mass_matrix(order.density) @ Psi)
        self.K = Psi.T @ (h.stiffness(order.bulk, zero) @ Psi)
        unit = np.eye(len(order.bulk))
        self.H = [Psi.T @ (h.stiffness(zero, e) @ Psi) for e in unit]
        self.K[faces : self.fixed], self.K[:, faces : self.fixed] = 0.0, 0.0
        for H in self.H:
            H[faces : self.fixed], H[:, faces : self.fixed] = 0.0, 0.0

    def dynamic(self, shear: Any, omega: float) -> Complex:
        D = self.K - omega**2 * self.M
        return np.asarray(D + sum(G * H for G, H in zip(shear, self.H, strict=True)), dtype=np.complex128)

    def choose(
        self, levels: Sequence[Sequence[float]], shear: Callable[[float], Sequence[complex]], f_max: float
    ) -> tuple[Array, float]:
        """Combinations (m, k) of the internal shapes that are kept, and the largest error."""
        free = self.fixed > self.r
        still = 60.0 if free else 0.0  # rad/s: a free body has no receptance at rest
        points = [(np.asarray(level, dtype=np.complex128), still, STILL) for level in levels]
        for a, b in zip(levels, levels[1:], strict=False):
            points.append((np.sqrt(np.multiply(a, b)).astype(np.complex128), still, STILL))
        omegas = 2 * np.pi * f_max * np.linspace(1 / PATH, 1.0, PATH) if f_max > 0 else []
        points += [(_lossy(shear(w), levels), float(w), WANTED) for w in omegas]
        D = [self.dynamic(G, w) for G, w, _ in points]
        if not self.L.shape[0] + self.r:
            return np.zeros((len(self.K) - self.fixed, 0)), 0.0
        wanted = [felt(d, self.L, self.r) for d in D]
        # what a free body does as a whole is exact, and may be cancelled by what will hold it
        elastic = [t + self.rigid / w**2 if free else t for t, (_, w, _) in zip(wanted, points, strict=True)]
        scale = own_scale(elastic)
        basis = np.zeros((len(self.K) - self.fixed, 0))
        basis = _joined(basis, self._answers(D[0])[:, self.r :].real)
        size = len(self.K) - self.fixed
        while True:
            errors = np.array(
                [
                    self._misfit(self._felt(d, basis), t, s) / limit
                    for d, t, s, (*_, limit) in zip(D, wanted, scale, points, strict=True)
                ]
            )
            worst = int(np.argmax(errors))
            moving = errors[-len(omegas) :] * WANTED if len(omegas) else errors[:1] * STILL
            if errors[worst] <= 1.0 or basis.shape[1] == size:
                return basis, float(moving.max())
            # of what all ports move there, the part that is missed most
            gap = (self._felt(D[worst], basis) - wanted[worst]) / scale[worst]
            mix = np.linalg.svd(gap)[2][0].conj() / np.sqrt(np.diag(scale[worst]))
            u = self._answers(D[worst]) @ mix
            more = _joined(basis, np.stack([u.real, u.imag], axis=1))
            if more.shape[1] == basis.shape[1]:
                return basis, float(moving.max())
            basis = more

    def _misfit(self, got: Complex, wanted: Complex, scale: Array) -> float:
        """Of what is felt; where one raceway may be held by springs, also of the stiffness between them."""
        error = misfit(got, wanted, scale)
        if self.several:
            stiff = np.linalg.inv(wanted)
            own = np.sqrt(np.outer(np.abs(np.diag(stiff)), np.abs(np.diag(stiff))))
            error = max(error, misfit(np.linalg.inv(got), stiff, own))
        return error

    def _answers(self, D: Complex) -> Complex:
        """Internal part (m, faces + ports) of the motion under unit motions of the faces and loads on the ports."""
        r, f = self.r, self.fixed
        load = np.hstack([-D[r:, :r], self.L[:, r:].T])
        return np.asarray(np.linalg.solve(D[r:, r:], load)[f - r :])

    def _felt(self, D: Complex, basis: Array) -> Complex:
        f = self.fixed
        T = scipy.linalg.block_diag(np.eye(f), basis)
        return felt(T.T @ D @ T, self.L @ T, self.r)


def _joined(basis: Array, shapes: Array) -> Array:
    """Orthonormal columns that span both; directions that are there already to 1e-7 are left out."""
    for u in shapes.T:
        size = np.linalg.norm(u)
        for _ in range(2):
            u = u - basis @ (basis.T @ u)
        if size > 0 and np.linalg.norm(u) > 1e-7 * size:
            basis = np.hstack([basis, (u / np.linalg.norm(u))[:, None]])
    return basis
