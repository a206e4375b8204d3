"""The lowest eigenpairs of K φ = λ M φ by Lanczos on K⁻¹M, several vectors at a time.

Grimes, Lewis & Simon, SIAM J. Matrix Anal. Appl. 15 (1994) 228-272. A block meets at once what a single
vector meets by round-off alone: modes of equal frequency. It takes more vectors, for 20 modes of a block of
30 thousand coordinates 95, 104, 144 and 208 in blocks of 1, 2, 4 and 8, which pays where factors answer
several in the time of few: PARDISO four in that of two, SuperLU each by itself.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from bearingdyn.types import Array

# residual over θ = 1/λ at which a pair has converged: φ errs by it over the relative gap, λ by its square
TOLERANCE = 1e-10
TINY = np.finfo(np.float64).tiny
SEEN = 1e-5  # the same at which λ is known to 1e-10, so that the proof may begin
DEPENDENT = 1e-12  # part of a vector below which what is left of it is round-off
PROOF, FRESH = 3, 2  # steps that so many fresh random vectors take without meeting a missed pair
SAME = 1e-9  # relative change of λ above which the answer is another one


def lowest_pairs(
    solve: Callable[[Array], Array],
    M: Any,
    count: int,
    limit: float,
    most: int,
    width: int = 2,
    start: Array | None = None,
) -> tuple[Array, Array] | None:
    """Lowest eigenpairs of K φ = λ M φ: rising λ (m,) and φ (n, m) with φᵀMφ = 1; None if `most` is too few.

    Every vector is kept and each new block is made M-orthogonal to all of them, twice, so that no pair comes
    back as a copy of itself. Once all wanted pairs are seen, a few fresh random vectors join. What the
    block missed, such as modes of equal frequency more numerous than it is wide, is then the largest part of
    what is left and grows with every step. The answer stands when PROOF steps have changed nothing.

    Parameters
    ----------
    solve
        K⁻¹ b of b (n, p), for a positive definite K.
    M
        (n, n) sparse, positive definite.
    count
        Highest number of pairs.
    limit
        Highest λ.
    most
        Number of vectors at which to give up.
    width
        Vectors at a time.
    start
        (n, k) vectors in which the lowest modes are strong, to begin with; a random one joins them. None:
        `width` random ones.
    """
    krylov = _Krylov(solve, M, width)
    if start is None:
        krylov.join(width)
    else:
        krylov.begin(start)
        krylov.join(1)
    known, steps = np.zeros(0), 0
    while krylov.size <= most:
        krylov.step()
        theta, y, residual = krylov.pairs()
        bound = theta + residual
        number = min(count, int(np.count_nonzero(bound >= 1.0 / limit)))
        # a pair beyond is told from those wanted by its bound, or is itself exact
        edge = 1.0 / limit if number < count else theta[number - 1]
        asked = (np.arange(theta.size) < number) | (bound >= edge)
        worst = (
            float((residual / np.maximum(theta, TINY))[asked].max(initial=0.0))
            if theta.size > number
            else np.inf
        )
        if not worst <= SEEN:
            known, steps = np.zeros(0), 0
        elif steps and known.size == number and np.allclose(known, theta[:number], rtol=SAME, atol=0.0):
            steps += 1
            if steps > PROOF and worst <= TOLERANCE:
                return 1.0 / theta[:number], krylov.shapes(y[:, :number])
        else:
            known, steps = theta[:number], 1
            krylov.join(FRESH)
    return None


class _Krylov:
    """M-orthonormal vectors V (n, m), the projection VᵀMK⁻¹MV of them, and the block that comes next."""

    def __init__(self, solve: Callable[[Array], Array], M: Any, width: int) -> None:
        self.solve, self.M, self.width = solve, M, width
        self.kept = np.zeros((M.shape[0], 0), order="F")  # V and room for what comes
        self.T = np.zeros((0, 0))
        self.next = self.mass_next = self.mass_last = np.zeros((M.shape[0], 0))
        self.rest = np.zeros((0, 0))  # (p, width of the last block): K⁻¹M V − V T = next · rest
        self.draws = np.random.default_rng(0)  # every run gives the same numbers

    @property
    def V(self) -> Array:
        """The vectors (n, m)."""
        return self.kept[:, : len(self.T)]

    @property
    def size(self) -> int:
        """Number of vectors once the next block has joined."""
        return len(self.T) + int(self.next.shape[1])

    def join(self, width: int) -> None:
        """Widen the next block by random vectors, orthogonal to all, their lowest modes strengthened."""
        fresh = self.solve(self.M @ self.draws.standard_normal((self.M.shape[0], width)))
        for _ in range(2):
            fresh, mass_fresh, _, _ = self._orthonormal(fresh, self.V, self.next)
        self.rest = np.vstack([self.rest, np.zeros((fresh.shape[1], self.rest.shape[1]))])
        self.next = np.hstack([self.next, fresh])
        self.mass_next = np.hstack([self.mass_next, mass_fresh])

    def begin(self, start: Array) -> None:
        """Make vectors (n, k) the first block."""
        self.next, self.mass_next, _, _ = self._orthonormal(start, self.V)
        self.rest = np.zeros((self.next.shape[1], 0))

    def step(self) -> None:
        """Take in the next block and find the one after it."""
        if not self.next.shape[1]:  # the vectors span an invariant space: what is outside of it is not met
            self.join(self.width)
        old, p = len(self.T), self.next.shape[1]
        last, here = self.mass_last, self.mass_next
        before = self.V[:, old - last.shape[1] :]
        answer = self.solve(here)
        # by the recurrence of three blocks, which rounding soon breaks, and then by all of them
        near = np.zeros((old + p, p))
        near[old:] = here.T @ answer
        answer = answer - self.next @ near[old:]
        if last.shape[1]:
            near[old - last.shape[1] : old] = last.T @ answer
            answer -= before @ near[old - last.shape[1] : old]
        self._keep(self.next)
        self.next, self.mass_next, self.rest, far = self._orthonormal(answer, self.kept[:, : old + p])
        self.mass_last = here
        T = np.zeros((old + p, old + p))
        T[:old, :old] = self.T
        T[:, old:] = column = near + far
        T[old:, :old] = column[:old].T
        T[old:, old:] = 0.5 * (column[old:] + column[old:].T)
        self.T = T

    def pairs(self) -> tuple[Array, Array, Array]:
        """Ritz values θ of K⁻¹M (m,), falling, their combinations (m, m) and residuals in the M-norm (m,)."""
        theta, y = np.linalg.eigh(self.T)
        theta, y = theta[::-1], y[:, ::-1]
        residual = np.linalg.norm(self.rest @ y[len(y) - self.rest.shape[1] :], axis=0)
        return theta, y, residual

    def shapes(self, y: Array) -> Array:
        """Vectors (n, k) of combinations y (m, k)."""
        return np.asarray(self.V @ y)

    def _keep(self, block: Array) -> None:
        """Put a block behind the vectors."""
        old, p = len(self.T), block.shape[1]
        if old + p > self.kept.shape[1]:
            kept, self.kept = self.kept, np.empty((len(block), 2 * (old + p)), order="F")
            self.kept[:, :old] = kept[:, :old]
        self.kept[:, old : old + p] = block

    def _orthonormal(self, w: Array, *others: Array) -> tuple[Array, Array, Array, Array]:
        """Take others V out of w: q (n, p) and M q with w = V c + q r, and r (p, width), c (m, width)."""
        mass_w = self.M @ w
        least = DEPENDENT * np.sqrt(np.sum(w * mass_w, axis=0))
        c = np.vstack([v.T @ mass_w for v in others])
        at = 0
        for v in others:
            w = w - v @ c[at : at + v.shape[1]]
            at += v.shape[1]
        mass_w, r = self.M @ w, np.eye(w.shape[1])
        for _ in range(2):  # one turn leaves the rounding of the largest part in the smallest
            size = np.sqrt(np.maximum(np.sum(w * mass_w, axis=0), 0.0))
            own = np.divide(1.0, size, out=np.zeros_like(size), where=size > least)
            squares, turn = np.linalg.eigh((w * own).T @ (mass_w * own))
            kept = squares > DEPENDENT
            scale = np.sqrt(squares[kept])
            to_q = own[:, None] * turn[:, kept] / scale
            w, mass_w = w @ to_q, mass_w @ to_q
            r = (scale[:, None] * turn[:, kept].T * size) @ r
            least = np.zeros(w.shape[1])
        return w, mass_w, r, c
