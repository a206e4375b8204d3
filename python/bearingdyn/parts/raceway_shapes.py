"""Shapes of one order of a ring, chosen by what its raceways and interfaces feel up to a frequency.

From static shapes at several moduli and the answers to their inertia, and the motion at a few frequencies (a
rational Krylov space), a rich basis is made. Of it the fewest shapes are kept whose receptances at the
raceways, transmissions and dynamic stiffness at the interfaces are those of the rich one over 0…f_max.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import pairwise, zip_longest
from typing import Any

import numpy as np
import scipy

from bearingdyn.cms import orthogonalise
from bearingdyn.fem import Harmonic, factorise
from bearingdyn.short_repr import short
from bearingdyn.types import Array, Complex, Index

PROMISE = 1e-2  # f_max: receptances are right to this up to there
WANTED = 4e-3  # what the choice aims at against the rich basis, which is itself not the whole
STILL = 2e-4  # the same at rest, at any modulus
LOSS = 0.02  # loss factor at which a part without rubber is judged: no error is told at an undamped resonance
MOMENTS = 2  # answers to inertia, beyond the static shapes
PATH = 24  # evenly spaced frequencies at which the small models are compared, besides their resonances
BANDS = 8  # of 0…f_max, in each of which the moduli are taken as one to find the resonances
OWN = 1e-10  # energy of a combination of shapes of unit energy, below which it is not one of its own
FIRST = (0.55, 0.8)  # of f_max: where the first rich basis meets the whole model, after its resonances
PASSES = 3  # how many such meetings must go well in a row
CHECKS = 16  # and how many there are at most
APART = 0.03  # of f_max: meetings nearer than that tell the same
RICH = 0.2  # of what is wanted, the error of the rich basis there


@dataclass(frozen=True, eq=False, kw_only=True)
class PortShapes:
    """Shapes of a ring, of one order, as its raceway feels them.

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
    """Order of a raceway's shapes: the body's matrices in it, what is held, and its ports.

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
        """Motion (n, faces + ports) of the whole model under unit motions of the faces and unit port loads,
        and what the ports and faces feel (see `felt`)."""
        D = self.dynamic(shear, omega)
        inner, r = self.inner, self.R.shape[1]
        load = np.hstack([-(D[inner][:, self.held] @ self.R), self.ports[:, inner].T])
        u = np.zeros((self.h.n, load.shape[1]), dtype=np.complex128)
        u[self.held, :r] = self.R
        # with a loss, no pivot is near zero
        u[inner] = factorise(D[inner][:, inner].astype(np.complex128)).solve(load.astype(np.complex128))
        T = np.vstack([self.R.T @ (D @ u)[self.held], self.ports @ u])
        return u, T


def felt(D: Complex, L: Array, faces: int) -> Complex:
    """For choosing raceway shapes: reactions of faces and motions of ports, (faces + ports) square.

    Under unit motions of the faces and unit loads on the ports, of a small model of dynamic stiffness D and
    ports L.
    """
    r = faces
    load = np.hstack([-D[r:, :r], L[:, r:].T])
    u = np.zeros((len(D), load.shape[1]), dtype=np.complex128)
    u[:r, :r] = np.eye(r)
    u[r:] = np.linalg.solve(D[r:, r:], load)
    reaction = (D @ u)[:r]
    reaction[:, r:] -= L[:, :r].T  # of the unit loads, what the faces' own shapes take
    return np.vstack([reaction, L @ u])


def misfit(got: Any, wanted: Any, scale: Array) -> float:
    """How far a raceway's shapes miss what is felt, each entry over the mean size of its two ports."""
    off, size = (float(np.linalg.norm(a / scale, 2)) for a in (got - wanted, wanted))
    return off / max(size, 1.0)


def own_scale(T: Complex, usual: Array) -> Array:
    """Sizes by which raceway shapes are judged, entry by entry of what is felt.

    Those of their ports there, but no antiresonance counts for less than a tenth of what is usual.
    """
    own = np.maximum(np.abs(np.diag(T)), 0.1 * usual)
    return np.asarray(np.sqrt(np.outer(own, own)))


def port_shapes(
    order: Order,
    levels: Sequence[Sequence[float]],
    shear: Callable[[float], Sequence[complex]],
    f_max: float,
    slow: float,
) -> PortShapes:
    """Raceway shapes of one order: those that its raceway and faces feel up to f_max.

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
    h, r = order.h, order.R.shape[1]
    M = h.mass_matrix(order.density)
    K = h.stiffness(order.bulk, levels[0])
    rigid: Array = np.zeros((h.n, 0))
    if not order.held.size and h.order <= 1:
        motion = np.zeros((h.n, 2 if h.order else 1))
        motion[h.free] = h.rigid_shapes(np.arange(h.mesh.r.size))[h.free]
        rigid = np.asarray(np.linalg.solve(np.linalg.cholesky(motion.T @ (M @ motion)), motion.T).T)
    faces, rich = _rich(order, levels, M, rigid, slow if rigid.size else 0.0)

    def small_model() -> _Small:
        shapes = np.hstack(rich)
        shapes -= rigid @ (rigid.T @ (M @ shapes))
        energy = np.sum(shapes * (K @ shapes), axis=0)
        shapes = shapes[:, energy > 0] / np.sqrt(energy[energy > 0])
        for _ in range(2):  # twice, for round-off
            energy, mix = np.linalg.eigh(shapes.T @ (K @ shapes))
            shapes = shapes @ (mix / np.sqrt(np.abs(energy)))[:, energy > OWN]
        frequency, shapes = orthogonalise(shapes, K, M)
        shapes = shapes / (2 * np.pi * frequency)  # of unit energy
        return _Small(order, faces, rigid, shapes, levels, shear, f_max)

    small, missed = small_model(), 0.0
    # the first basis meets the whole at its resonances, a richer one where it differs most from the last
    most = 2 * np.pi * f_max
    meetings = [most, *sorted(small.resonances, reverse=True), *(most * share for share in FIRST)]
    passed: list[tuple[float, float]] = []
    for _ in range(CHECKS if f_max > 0 else 0):
        apart = (w for w in meetings if all(abs(w - v) > APART * most for v, _ in passed))
        omega = next(apart, None)
        if omega is None:
            break
        u, T = order.motion(lossy(shear(omega)), omega)
        error = small.missed(T, lossy(shear(omega)), omega)
        if error < RICH * WANTED:
            passed.append((omega, error))
            if len(passed) == PASSES:
                break
            continue
        u[:, :r] -= faces
        rich.append(np.hstack([u.real, u.imag]))
        poorer, small, passed, missed = small, small_model(), [], error
        meetings = small.unlike(poorer)
    missed = max((error for _, error in passed), default=missed)
    kept, error = small.choose()
    _, internal = orthogonalise(small.shapes @ kept, K, M)
    return PortShapes(
        Psi=np.hstack([faces, rigid, internal]), faces=r, rigid=rigid.shape[1], error=error + missed
    )


def lossy(shear: Sequence[complex]) -> Complex:
    """For a raceway's shapes, moduli with a loss where nothing has one."""
    G = np.asarray(shear, dtype=np.complex128)
    return G if np.abs(G.imag).max() > 0 else G * (1 + 1j * LOSS)


def _rich(
    order: Order, levels: Sequence[Sequence[float]], M: Any, rigid: Array, slow: float
) -> tuple[Array, list[Array]]:
    """Unit motions of the faces (n, r) at the first level; static shapes at all, and answers to inertia."""
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

    def __init__(
        self,
        order: Order,
        faces: Array,
        rigid: Array,
        shapes: Array,
        levels: Sequence[Sequence[float]],
        shear: Callable[[float], Sequence[complex]],
        f_max: float,
    ) -> None:
        h, self.shapes = order.h, shapes
        Psi = np.hstack([faces, rigid, shapes])
        self.r, self.fixed = faces.shape[1], faces.shape[1] + rigid.shape[1]
        self.size = shapes.shape[1]
        self.L = order.ports @ Psi
        self.several = len(self.L) > 2
        self.free = bool(rigid.shape[1])
        self.rigid = np.zeros((self.r + len(self.L),) * 2)
        self.rigid[self.r :, self.r :] = self.L[:, self.r : self.fixed] @ self.L[:, self.r : self.fixed].T
        zero = [0.0] * len(order.bulk)
        self.M = Psi.T @ (h.mass_matrix(order.density) @ Psi)
        self.K = Psi.T @ (h.stiffness(order.bulk, zero) @ Psi)
        self.H = [Psi.T @ (h.stiffness(zero, e) @ Psi) for e in np.eye(len(order.bulk))]
        for A in (self.K, *self.H):
            A[self.r : self.fixed], A[:, self.r : self.fixed] = 0.0, 0.0
        still = 60.0 if self.free else 0.0  # rad/s: a free body has no receptance at rest
        rest = [np.asarray(level, dtype=np.complex128) for level in levels]
        rest += [np.sqrt(a * b) for a, b in pairwise(rest)]
        omegas = [2 * np.pi * f_max * k / PATH for k in range(1, PATH + 1)] if f_max > 0 else []
        self.resonances = self._resonances(shear, 2 * np.pi * f_max)
        omegas += self.resonances
        self.points = [(G, still) for G in rest] + [(lossy(shear(w)), w) for w in omegas]
        self.limits = np.array([STILL] * len(rest) + [WANTED] * len(omegas))
        self.D = [self.dynamic(G, w) for G, w in self.points]
        self.wanted = [felt(D, self.L, self.r) for D in self.D]
        sizes = [
            np.abs(np.diag(self.elastic(t, w))) for t, (_, w) in zip(self.wanted, self.points, strict=True)
        ]
        self.usual = np.median(sizes, axis=0)

    def dynamic(self, shear: Any, omega: float) -> Complex:
        """Dynamic stiffness of the small model."""
        D = self.K - omega**2 * self.M
        return np.asarray(D + sum(G * H for G, H in zip(shear, self.H, strict=True)), dtype=np.complex128)

    def _resonances(self, shear: Callable[[float], Sequence[complex]], most: float) -> list[float]:
        """Those below `most`, rad/s, with the faces held: there a small error is felt most.

        With several raceways, one of which springs may hold, also those with all of them held.
        """
        f, found = self.fixed, []
        free = [np.eye(self.size)]
        if self.several:
            free.append(scipy.linalg.null_space(self.L[:, f:]))
        for k in range(BANDS if most > 0 else 0):
            low, high = most * k / BANDS, most * (k + 1) / BANDS
            G = lossy(shear(0.5 * (low + high))).real
            for Z in free:
                K = Z.T @ self.dynamic(G, 0.0).real[f:, f:] @ Z
                slowness = scipy.linalg.eigh(Z.T @ self.M[f:, f:] @ Z, K, eigvals_only=True)
                own = slowness[slowness > 1 / most**2] ** -0.5
                found += own[(own > low) & (own <= high)].tolist()
        return found

    def elastic(self, T: Complex, omega: float) -> Complex:
        """What is felt less what a free body does as a whole: that is exact, and may be cancelled by what
        will hold it."""
        return T + self.rigid / omega**2 if self.free else T

    def missed(self, T: Complex, shear: Any, omega: float) -> float:
        """Error of the rich basis against the whole model."""
        got = felt(self.dynamic(shear, omega), self.L, self.r)
        return self._misfit(got, T, omega)

    def unlike(self, other: _Small) -> list[float]:
        """Frequencies, rad/s, from where the two differ most; resonances and the others of the path in turn.

        In turn, for a basis may come right where the last was worst, and not yet at a sharp resonance.
        """
        differ = {
            w: self._misfit(felt(other.dynamic(G, w), other.L, other.r), wanted, w)
            for (G, w), wanted, limit in zip(self.points, self.wanted, self.limits, strict=True)
            if limit == WANTED
        }
        sharp = set(self.resonances)
        found = sorted(differ, key=lambda w: -differ[w])
        pairs = zip_longest([w for w in found if w in sharp], [w for w in found if w not in sharp])
        return [w for pair in pairs for w in pair if w is not None]

    def choose(self) -> tuple[Array, float]:
        """Combinations (m, k) of the internal shapes that are kept, and the largest error."""
        basis = np.zeros((self.size, 0))
        if not len(self.L) + self.r:
            return basis, 0.0
        basis = _joined(basis, self._answers(self.D[0])[:, self.r :].real)
        while True:
            got = [self._felt(D, basis) for D in self.D]
            errors = np.array(
                [self._misfit(g, t, w) for g, t, (_, w) in zip(got, self.wanted, self.points, strict=True)]
            )
            worst = int(np.argmax(errors / self.limits))
            found = float(errors[self.limits == self.limits[-1]].max())
            if errors[worst] <= self.limits[worst] or basis.shape[1] == self.size:
                return basis, found
            # of what all ports move there, the part that is missed most
            own = own_scale(self.elastic(self.wanted[worst], self.points[worst][1]), self.usual)
            mix = np.linalg.svd((got[worst] - self.wanted[worst]) / own)[2][0].conj() / np.sqrt(np.diag(own))
            u = self._answers(self.D[worst]) @ mix
            # in whichever phase most of it is new
            fresh = np.stack([u.real, u.imag], axis=1)
            fresh -= basis @ (basis.T @ fresh)
            more = _joined(basis, fresh @ np.linalg.svd(fresh, full_matrices=False)[2][:1].T)
            if more.shape[1] == basis.shape[1]:
                return basis, found
            basis = more

    def _misfit(self, got: Complex, wanted: Complex, omega: float) -> float:
        """Of what is felt; at rest, and where one raceway may be held by springs, also of the stiffness."""
        error = misfit(got, wanted, own_scale(self.elastic(wanted, omega), self.usual))
        if self.several or omega == self.points[0][1]:
            stiff = np.linalg.inv(wanted)
            own = np.sqrt(np.outer(np.abs(np.diag(stiff)), np.abs(np.diag(stiff))))
            error = max(error, misfit(np.linalg.inv(got), stiff, own))
        return error

    def _answers(self, D: Complex) -> Complex:
        """Internal part (m, faces + ports) of the motion under unit motions of faces and loads on ports."""
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
