"""Stability of a periodic motion: Floquet multipliers of the structure, its branches and the balls' tangents.

A small departure u from the motion obeys u̇ = A u − E (K(t) z + C(t) ż) with z and ż rows of u, A constant
with the mean tangents in it, and K and C what the tangents of the balls along the motion are beside their
mean. Over a double step Δ the force of the balls is a parabola through its values at 0, Δ/2 and Δ, and what
A makes of it is exact:

    u(Δ) = e^{AΔ} u(0) − Σ_j W_j h_j,   h_j = K_j z_j + C_j ż_j,   z_j = Z (e^{Aτ_j} u(0) − Σ_i W_i(τ_j) h_i)

so that a period is a product of matrices, of fourth order in Δ. The highest modes of the structure, and what
hardly moves the bearings, follow at once: what they give way by is kept as a flexibility, in which tangents
soften.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import scipy

from bearingdyn.analysis.steady.balance import Balance, Found
from bearingdyn.analysis.steady.layer_lines import frozen
from bearingdyn.analysis.steady.problem import Problem
from bearingdyn.analysis.steady.torus import Lines
from bearingdyn.material import Maxwell
from bearingdyn.system import System
from bearingdyn.types import Array, Complex, Index

# modes above so many times the highest line that counts follow at once: a tangent of the harmonic k shakes
# modes up to k/2 of the base by itself, so that those left out need tangents of twice the lines
FOLLOWS = 1.0
# the same of one motion by itself, whose multipliers may take longer
FOLLOWS_ONE = 3.0
# modes of a block that are kept however slowly it runs
ALWAYS = 10
# of a block's static flexibility, below which the bearings do not feel one of its poles
FELT = 1e-5
# of the fastest mode kept, the ω that a floating motion is measured by
FLOATING = 0.1
# samples of a period, at least, for the stability of one steady state
SAMPLES = 256
# poles of one state are all kept, what the bearings do not feel as well
ALL = -1.0
# multipliers of one state that are kept
KEPT = 6
# a multiplier this near to the real axis, as a share of its size, is real
REAL = 1e-6


@dataclass(frozen=True, eq=False)
class Chunk:
    """For stability, one block of the structure in first order, u = (q, q̇, branches): parts of A, rows of z.

    Parameters
    ----------
    A, speed_A
        (n, n): A is A + speed·speed_A.
    Z, V
        Rows (m, n) of z and ż.
    E
        (n, m), what a force on z does to u̇.
    touched
        Which of all coefficients the block moves with.
    """

    A: Array
    speed_A: Array
    Z: Array
    V: Array
    E: Array
    touched: Index


@dataclass(frozen=True, eq=False)
class FirstOrder:
    """For stability, the structure in first order by blocks, and flexibility (m, m) of its fast modes."""

    chunks: tuple[Chunk, ...]
    flexibility: Array

    @property
    def size(self) -> int:
        """Numbers of u."""
        return sum(len(c.A) for c in self.chunks)

    @classmethod
    def of(
        cls, system: System, fastest: float, band: tuple[float, float] = (1.0, 1e4), felt: float = FELT
    ) -> FirstOrder:
        """A system, its modes above `fastest`, rad/s, as a flexibility.

        Parameters
        ----------
        system
            The system; a law that is no Maxwell model is taken as its Maxwell approximation in `band`.
        fastest
            rad/s.
        band
            Hz.
        felt
            Of a block's static flexibility, below which the bearings do not feel one of its poles.
        """
        system = maxwell_system(system, band)
        modal, _ = system.modal()
        squares = np.diag(modal.stiffness("relaxed"))
        B = modal.B
        chunks = []
        flexibility = np.zeros((len(B), len(B)))
        for index in modal.blocks():
            touched = np.flatnonzero(np.abs(B[:, index]).any(axis=1))
            # what no bearing feels is no motion of theirs; of one state it is told, but for what floats
            if not touched.size and not (felt < 0.0 and (squares[index] > 0.0).all()):
                continue
            rank = np.argsort(np.argsort(squares[index]))
            slow = (squares[index] <= fastest**2) | (rank < ALWAYS)
            kept, fast = index[slow], index[~slow]
            flexibility += (B[:, fast] / squares[fast]) @ B[:, fast].T
            chunk = _chunk(modal, kept, touched, squares, FLOATING * fastest)
            if touched.size and len(chunk.A) > 2 * len(kept):
                chunk, gives = _felt_alone(chunk, felt)
                flexibility[np.ix_(touched, touched)] += gives
            chunks.append(chunk)
        return cls(tuple(chunks), flexibility)


def maxwell_system(system: System, band: tuple[float, float]) -> System:
    """For stability, the system with every law without branches replaced by its Maxwell approximation."""
    from dataclasses import replace

    if all(isinstance(t.material, Maxwell) for t in system.layers):
        return system
    models: dict[int, Maxwell] = {}
    for t in system.layers:
        if not isinstance(t.material, Maxwell):
            models.setdefault(id(t.material), t.material.maxwell("auto", band=band))
    return replace(
        system,
        layers=tuple(replace(t, material=models.get(id(t.material), t.material)) for t in system.layers),
    )


def _chunk(modal: System, kept: Index, touched: Index, squares: Array, floating: float) -> Chunk:
    """One block of a modal system in first order, with the modes kept."""
    n = len(kept)
    inside = np.ix_(kept, kept)
    branches = [
        (t.L[kept], 2.0 * G, tau)
        for t in modal.layers
        if np.abs(t.L[kept]).any()
        for G, tau in zip(t.material.G, t.material.tau, strict=True)
        if G > 0.0
    ]
    size = 2 * n + sum(L.shape[1] for L, _, _ in branches)
    A, speed_A = np.zeros((size, size)), np.zeros((size, size))
    # ω q for q, so that u² is twice the energy and a period hardly stretches it; ω of what floats is given
    omega = np.sqrt(np.maximum(squares[kept], 0.0))
    scale = np.where(omega > 0.0, omega, floating)
    A[:n, n : 2 * n] = np.diag(scale)
    A[n : 2 * n, :n] = -np.diag(squares[kept] / scale)
    A[n : 2 * n, n : 2 * n] = -modal.viscous()[inside]
    speed_A[n : 2 * n, :n] = -modal.N[inside] / scale
    speed_A[n : 2 * n, n : 2 * n] = -modal.G[inside]
    at = 2 * n
    for L, G, tau in branches:
        own = slice(at, at + L.shape[1])
        # s = √(2G) r: the branch's own energy is r²/2, as the modes' are
        A[n : 2 * n, own] = -math.sqrt(G) * L
        A[own, n : 2 * n] = math.sqrt(G) * L.T
        A[own, own] = -np.eye(L.shape[1]) / tau
        at += L.shape[1]
    B = modal.B[np.ix_(touched, kept)]
    Z, V, E = np.zeros((len(B), size)), np.zeros((len(B), size)), np.zeros((size, len(B)))
    Z[:, :n] = B / scale
    V[:, n : 2 * n] = B
    E[n : 2 * n] = B.T
    return Chunk(A, speed_A, Z, V, E, touched)


def _felt_alone(chunk: Chunk, least: float) -> tuple[Chunk, Array]:
    """A block with branches in its poles: those that the bearings feel, and the flexibility of the others.

    A block that turns stays as it is.
    """
    none = np.zeros((len(chunk.touched),) * 2)
    if chunk.speed_A.any():
        return chunk, none
    values, vectors = np.linalg.eig(chunk.A)
    basis = np.zeros_like(chunk.A)
    k, keep = 0, []
    for value, v in zip(values, vectors.T, strict=True):
        if value.imag < 0.0:
            continue
        width = 2 if value.imag > 0.0 else 1
        basis[:, k] = v.real
        if width == 2:
            basis[:, k + 1] = v.imag
        keep.append((k, width, abs(value)))
        k += width
    if k != len(values) or not np.linalg.cond(basis) < 1e8:
        return chunk, none
    inverse = np.linalg.inv(basis)
    A, Z, V, E = inverse @ chunk.A @ basis, chunk.Z @ basis, chunk.V @ basis, inverse @ chunk.E
    static = np.abs(chunk.Z @ np.linalg.solve(chunk.A, chunk.E)).max()
    felt = np.zeros(len(values), dtype=bool)
    gives = none
    for k, width, size in keep:
        own = slice(k, k + width)
        if np.linalg.norm(Z[:, own]) * np.linalg.norm(E[own]) > least * size * static:
            felt[own] = True
        else:
            gives = gives - Z[:, own] @ np.linalg.solve(A[own, own], E[own])
    kept = np.flatnonzero(felt)
    inside = A[np.ix_(kept, kept)]
    return Chunk(inside, np.zeros_like(inside), Z[:, kept], V[:, kept], E[kept], chunk.touched), gives


@dataclass(frozen=True, eq=False)
class Propagator:
    """Stability of a steady motion: a double step of the structure at one speed.

    u(Δ) = after u(0) − W h, with rows of z, ż on the way.

    Parameters
    ----------
    after
        e^{AΔ} (n, n).
    W
        (n, 3m) of the forces at 0, Δ/2 and Δ.
    free
        (6m, n) z and ż at 0, Δ/2 and Δ without forces.
    felt
        (4m, 3m) what they lose by the forces at Δ/2 and Δ.
    """

    after: Array
    W: Array
    free: Array
    felt: Array

    @classmethod
    def of(cls, model: FirstOrder, speed: float, step: float, K: Array, C: Array) -> Propagator:
        """Of a double step, s, at a speed, rad/s, with mean tangents K, C (m, m)."""
        m, n = len(model.flexibility), model.size
        A = np.zeros((n, n))
        rows = np.zeros((2, m, n))
        E = np.zeros((n, m))
        at = 0
        for chunk in model.chunks:
            own = slice(at, at + len(chunk.A))
            A[own, own] = chunk.A + speed * chunk.speed_A
            rows[0, chunk.touched, own], rows[1, chunk.touched, own] = chunk.Z, chunk.V
            E[own, chunk.touched] = chunk.E
            at += len(chunk.A)
        A -= E @ (K @ rows[0] + C @ rows[1])
        half, first = _exponential(A, E, step, 0.5)
        full, whole = half @ half, _advance(half, first)
        both = rows.reshape(2 * m, n)
        free = np.concatenate([both, both @ half, both @ full])
        felt = np.concatenate([both @ first.reshape(n, 3 * m), both @ whole.reshape(n, 3 * m)])
        return cls(full, whole.reshape(n, 3 * m), free, felt)

    def steps(self, K: Array, C: Array) -> Array:
        """S (steps, 3m, 6m): the forces at the three places are S · free · u(0).

        Parameters
        ----------
        K, C
            (2·steps + 1, m, m) tangents at every place, the last that of the first.
        """
        m = K.shape[1]
        T = np.concatenate([K, C], axis=2)
        count = (len(K) - 1) // 2
        S = np.zeros((count, 3 * m, 6 * m))
        # the force at the beginning is known from u(0); those later feel it and one another
        S[:, :m, : 2 * m] = T[:-1:2]
        later = np.zeros((count, 2 * m, 4 * m))
        later[:, :m, : 2 * m], later[:, m:, 2 * m :] = T[1::2], T[2::2]
        felt = later @ self.felt
        right = np.concatenate([-(felt[:, :, :m] @ T[:-1:2]), later], axis=2)
        # near the unit matrix, and with fewer columns than what stands on the right
        S[:, m:] = np.linalg.inv(np.eye(2 * m) + felt[:, :, m:]) @ right
        return S

    def over(self, S: Array) -> Array:
        """What all steps make of u (n, n)."""
        U = np.eye(len(self.after))
        for s in S:
            U = (self.after - self.W @ (s @ self.free)) @ U
        return U

    def along(self, S: Array, u: Array) -> Array:
        """z (steps, m) at the beginning of every step from u (n,)."""
        m = len(self.free) // 6
        out = np.zeros((len(S), m), dtype=u.dtype)
        for i, s in enumerate(S):
            seen = self.free @ u
            out[i] = seen[:m]
            u = self.after @ u - self.W @ (s @ seen)
        return out


def _exponential(A: Array, E: Array, step: float, share: float) -> tuple[Array, Array]:
    """e^{Aτ}, and weights (n, 3, m) of a parabola of forces, τ = share · step.

    A chain that makes 1, s and s² drives E: one exponential gives all three (C. F. Van Loan, IEEE Trans.
    Autom. Control 23 (1978) 395).
    """
    n, m = E.shape
    F = np.zeros((n + 3 * m, n + 3 * m))
    F[:n, :n] = A
    F[:n, n : n + m] = E
    eye = np.eye(m)
    # x2′ = 2 x1/Δ, x1′ = x0/Δ
    F[n : n + m, n + m : n + 2 * m] = 2.0 / step * eye
    F[n + m : n + 2 * m, n + 2 * m :] = 1.0 / step * eye
    whole = scipy.linalg.expm(F * (share * step))
    powers = np.stack([whole[:n, n + k * m : n + (k + 1) * m] for k in range(3)], axis=1)
    # powers: of inputs 1, 2 s, s² (s from 0 to 1 over the step)
    powers = powers * np.array([1.0, 0.5, 1.0])[None, :, None]
    return whole[:n, :n], _lagrange(powers)


# parabolas that are 1 at s = 0, ½, 1, in powers of s
LAGRANGE = np.array([[1.0, -3.0, 2.0], [0.0, 4.0, -4.0], [0.0, -1.0, 2.0]])


def _lagrange(powers: Array) -> Array:
    return np.asarray(np.einsum("jp,npm->njm", LAGRANGE, powers))


def _advance(half: Array, weights: Array) -> Array:
    """Weights of the whole step from those of its first half.

    ∫₀^Δ e^{A(Δ−t)} s^p dt = half ∫₀^{Δ/2} … + ∫₀^{Δ/2} e^{A(Δ/2−t)} (s + ½)^p dt.
    """
    # Lagrange → powers of the half step
    powers = np.einsum("pj,njm->npm", np.linalg.inv(LAGRANGE), weights)
    later = np.stack(
        [powers[:, 0], powers[:, 1] + 0.5 * powers[:, 0], powers[:, 2] + powers[:, 1] + 0.25 * powers[:, 0]],
        axis=1,
    )
    n, _, m = powers.shape
    return _lagrange((half @ powers.reshape(n, 3 * m)).reshape(n, 3, m) + later)


@dataclass(frozen=True)
class Stability:
    """Stability: multipliers (k,) of a period, s, the largest first."""

    multipliers: Complex
    period: float

    @property
    def largest(self) -> complex:
        """The multiplier that is largest in size."""
        return complex(self.multipliers[0])

    @property
    def stable(self) -> bool:
        """Whether every small departure dies away."""
        return bool(abs(self.largest) < 1.0)

    @property
    def growth(self) -> float:
        """Rate of growth of the fastest departure, 1/s; negative where it dies away."""
        return math.log(max(abs(self.largest), 1e-300)) / self.period

    @property
    def loss(self) -> str:
        """How stability is lost, or would be first: "fold", "flip" or "neimark-sacker"."""
        return kind(self.largest)


def kind(multiplier: complex) -> str:
    """Kind of a loss of stability: what a multiplier of this phase brings where it leaves the unit circle."""
    if abs(multiplier.imag) <= REAL * abs(multiplier):
        return "fold" if multiplier.real > 0 else "flip"
    return "neimark-sacker"


@dataclass(frozen=True, eq=False)
class Floquet:
    """Stability of a motion, and what a period makes of a departure, (n, n)."""

    stability: Stability
    once: Array
    propagator: Propagator
    steps: Array

    def antiperiodic(self, lines: Lines) -> Complex | None:
        """Amplitudes (L, m), on lines of twice the period, of the departure whose multiplier is −1.

        None where none is near.
        """
        values, vectors = np.linalg.eig(self.once)
        real = [k for k, v in enumerate(values) if kind(complex(v)) == "flip"]
        if not real:
            return None
        k = min(real, key=lambda k: abs(values[k] + 1.0))
        z = self.propagator.along(self.steps, np.real(vectors[:, k]))
        twice = np.concatenate([z, -z])
        spectrum = np.fft.rfft(twice, axis=0) / len(z)
        out = np.zeros((lines.count, z.shape[1]), dtype=np.complex128)
        count = min(lines.count, len(spectrum))
        out[1:count:2] = spectrum[1:count:2]
        return out


def band_of(highest: float) -> int:
    """Half octave, of rad/s, up to which stability keeps modes, for lines up to `highest`."""
    return math.ceil(2.0 * math.log2(FOLLOWS * highest))


def floquet(
    model: FirstOrder,
    speed: float,
    period: float,
    K: Array,
    C: Array,
    kept: int = 6,
) -> Floquet:
    """Stability by Floquet: multipliers of a period from tangents (2·steps, m, m) evenly along it.

    Parameters
    ----------
    model, speed, period
        The structure, the speed, rad/s, and the period, s.
    K, C
        Tangents of all bearings.
    kept
        Multipliers.
    """
    count = len(K) // 2
    # what follows at once softens the tangents: h = K (z − F h) + C ż
    give = np.eye(K.shape[1]) + K @ model.flexibility
    K, C = np.split(np.linalg.solve(give, np.concatenate([K, C], axis=2)), 2, axis=2)
    K0, C0 = K.mean(axis=0), C.mean(axis=0)
    propagator = Propagator.of(model, speed, period / count, K0, C0)
    K, C = K - K0, C - C0
    S = propagator.steps(np.concatenate([K, K[:1]]), np.concatenate([C, C[:1]]))
    once = propagator.over(S)
    values = np.asarray(np.linalg.eigvals(once), dtype=np.complex128)
    order = np.argsort(-np.abs(values))[:kept]
    return Floquet(Stability(values[order], period), once, propagator, S)


def pooled(blocks: Sequence[Array], m: int) -> Array:
    """Tangents (N, n, n) of every bearing as one (N, m, m), for stability."""
    out = np.zeros((len(blocks[0]), m, m))
    at = 0
    for b in blocks:
        n = b.shape[1]
        out[:, at : at + n, at : at + n] = b
        at += n
    return out


def stability_of(
    problem: Problem, balance: Balance, found: Found, model: FirstOrder | None = None, samples: int = SAMPLES
) -> Stability | None:
    """Stability of a steady motion with one base: its multipliers; None for several bases."""
    if len(problem.bases.bases) != 1 or not problem.system.bearings:
        return None
    model = model or first_order(problem, balance, found)
    lines = balance.lines
    count = max(samples, 2 * (lines.samples // 2))
    pressed = balance.press(found.z, lines=Lines(lines.index, lines.steps, count))
    m = len(problem.system.B)
    period = 2 * np.pi / abs(float(problem.bases.frequencies(balance.speed)[0]))
    K = pooled([a.K for a in pressed.bearings], m)
    C = pooled([a.C for a in pressed.bearings], m)
    return floquet(model, balance.speed, period, K, C, KEPT).stability


def first_order(problem: Problem, balance: Balance, found: Found) -> FirstOrder:
    """For the stability of one steady motion, the structure in first order up to its highest line.

    Layers that soften keep the amplitude that they have in the motion.
    """
    highest = float(np.abs(balance.omega).max())
    lowest = float(np.abs(balance.omega[1:]).min())
    band = (lowest / (20 * np.pi), highest / (2 * np.pi))
    system = frozen(problem.system, found.pressed.softened, band)
    return FirstOrder.of(system, FOLLOWS_ONE * highest, band, felt=ALL)
