"""Shapes of a reduction: Craig-Bampton's, at several moduli of viscoelastic regions, made orthogonal."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import scipy
from numpy.typing import ArrayLike

from bearingdyn.checks import whole
from bearingdyn.cms.full_model import FullModel
from bearingdyn.cms.reduction_options import check_f_max, check_moduli, check_rounds
from bearingdyn.cms.viscoelastic import ComplexModulus
from bearingdyn.fem import factorise, lowest_modes
from bearingdyn.material import Maxwell, answer_of
from bearingdyn.short_repr import short
from bearingdyn.types import Array, Index

DISTINCT = 1e-12  # energy of a difference of shapes, over that of a shape, below which it is round-off


@dataclass(frozen=True, eq=False)
class Basis:
    """The basis of a reduction: shapes, u = Psi q.

    Parameters
    ----------
    Psi
        (n, r + m), the r constraint modes and then m fixed-interface modes of unit modal mass.
    K
        (r, r) stiffness of the constraint modes, N/m; it is the exact static stiffness seen at the
        interfaces.
    frequency
        (m,) frequencies of the fixed-interface modes, Hz.
    """

    Psi: Array
    K: Array
    frequency: Array

    __repr__ = short

    def reduce(self, A: Any, *, skew: bool = False) -> Array:
        """Psiᵀ A Psi for a symmetric (or skew) A, (r + m, r + m), round-off asymmetry removed."""
        a = self.Psi.T @ (A @ self.Psi)
        return np.asarray(0.5 * (a - a.T) if skew else 0.5 * (a + a.T))

    def stiffness(self) -> Array:
        """Reduced stiffness, (r + m, r + m): constraint and fixed-interface modes do not couple in K."""
        return np.asarray(scipy.linalg.block_diag(self.K, np.diag((2.0 * np.pi * self.frequency) ** 2)))


@dataclass(frozen=True, eq=False)
class _Held:
    """A model with some coordinates held: the rest in blocks that do not couple, each with factors."""

    K: Any
    across: Any  # stiffness (inner, held)
    held: Index
    inner: Index
    blocks: list[tuple[Index, Any, Any, Any]]  # coordinates within inner, stiffness, mass, factors

    def solve(self, load: Any) -> Array:
        """Static motion (inner, m) under loads (inner, m), the interface held."""
        u = np.zeros(load.shape)
        for at, _, _, lu in self.blocks:
            u[at] = lu.solve(np.ascontiguousarray(load[at]))
        return u

    def static(self, T: Array) -> Array:
        """Static motion (inner, r) that goes with interface motions T (held, r)."""
        return -self.solve(np.asarray(self.across @ T))

    def modes(
        self, f_max: float | None, n_modes: int | None, near: Array | None = None
    ) -> tuple[Array, Array]:
        """Rising frequencies (m,), Hz, and shapes (inner, m) of unit modal mass, the interface held.

        `near` (inner, k) are vectors in which low modes are strong, as for `lowest_modes`.
        """
        limit = self.inner.size if n_modes is None else min(n_modes, self.inner.size)
        found = [(np.zeros(0), np.zeros((self.inner.size, 0)))]
        for at, k, m, lu in self.blocks:
            try:
                top, close = math.inf if f_max is None else f_max, None if near is None else near[at]
                frequency, phi = lowest_modes(k, m, top, limit, lu, close)
            except (np.linalg.LinAlgError, RuntimeError) as error:
                raise _free_to_move(self.held, error) from error
            shape = np.zeros((self.inner.size, frequency.size))
            shape[at] = phi
            found.append((frequency, shape))
        frequency = np.concatenate([f for f, _ in found])
        order = np.argsort(frequency, kind="stable")[:limit]
        return frequency[order], np.hstack([phi for _, phi in found])[:, order]


def _hold(K: Any, M: Any, held: Index) -> _Held:
    """Hold some coordinates of a free model. Raises ValueError if the rest can still move."""
    K, M = scipy.sparse.csr_matrix(K), scipy.sparse.csr_matrix(M)
    free = np.ones(K.shape[0], dtype=bool)
    free[held] = False
    inner = np.flatnonzero(free)
    rows = K[inner]
    K_ii, M_ii = rows[:, inner], M[inner][:, inner]
    # Bending planes, stretch and torsion of a shaft do not couple: each block is solved by itself.
    label = _coupled_by(K_ii, M_ii)
    blocks = []
    for block in range(label.max(initial=-1) + 1):
        at = np.flatnonzero(label == block)
        k, m = (K_ii, M_ii) if at.size == inner.size else (K_ii[at][:, at], M_ii[at][:, at])
        try:
            blocks.append((at, k, m, factorise(k)))
        except RuntimeError as error:
            raise _free_to_move(held, error) from error
    return _Held(K, rows[:, held], held, inner, blocks)


def _coupled_by(K: Any, M: Any) -> Index:
    """Number (n,) of the block of each coordinate: nonzero entries join them."""
    stiff = K.copy()
    stiff.eliminate_zeros()
    # mostly the first coordinate is joined to all others by the stiffness alone
    first = (
        scipy.sparse.csgraph.breadth_first_order(stiff, 0, return_predecessors=False)
        if len(K.indptr) > 1
        else ()
    )
    if len(first) == K.shape[0]:
        return np.zeros(K.shape[0], dtype=np.intp)
    both = abs(stiff) + abs(M)
    return np.asarray(scipy.sparse.csgraph.connected_components(both, directed=False)[1])


def _free_to_move(held: Index, error: Exception) -> ValueError:
    return ValueError(
        f"dofs {held} leave the model free to move, or M or K is not positive definite ({error}); "
        "a body is held by one rigid interface of six coordinates"
    )


def _check_truncation(f_max: float | None, n_modes: int | None) -> None:
    if (f_max is None) == (n_modes is None):
        raise ValueError(f"f_max is {f_max} and n_modes is {n_modes}; give exactly one of the two")
    if f_max is not None:
        check_f_max(f_max, may_be_infinite=True)
    if n_modes is not None:
        whole("n_modes", n_modes, 0)


def craig_bampton(
    M: Any,
    K: Any,
    dofs: ArrayLike,
    T: ArrayLike | None = None,
    *,
    f_max: float | None = None,
    n_modes: int | None = None,
) -> Basis:
    """A basis by Craig and Bampton: constraint and fixed-interface modes, for dense or sparse M and K.

    Parameters
    ----------
    M, K
        (n, n) mass, kg, and stiffness, N/m, of the free model.
    dofs
        (m,) interface coordinates.
    T
        (m, r) makes them move as u[dofs] = T q; None: each by itself.
    f_max
        Keep the fixed-interface modes up to this frequency, Hz. Three to four times the highest frequency of
        interest keeps frequencies to about 0.1 %, twice to about 1 %.
    n_modes
        Instead of f_max: keep so many.

    Returns
    -------
    Basis

    Raises
    ------
    ValueError
        For shapes that do not fit, for both or neither of f_max and n_modes, and for an interface that leaves
        the rest of the model free to move.

    References
    ----------
    Craig & Bampton (1968); paper (21).
    """
    _check_truncation(f_max, n_modes)
    n = np.shape(K)[0]
    if np.shape(K) != (n, n) or np.shape(M) != (n, n):
        raise ValueError(f"M has shape {np.shape(M)} and K {np.shape(K)}; both must be square and alike")
    b = np.asarray(dofs, dtype=np.intp)
    if b.ndim != 1 or b.size == 0 or np.unique(b).size != b.size or b.min() < 0 or b.max() >= n:
        raise ValueError(f"dofs {dofs!r} must be distinct indices in 0...{n - 1}, at least one")
    T = np.eye(b.size) if T is None else np.asarray(T, dtype=np.float64)
    if T.ndim != 2 or T.shape[0] != b.size:
        raise ValueError(f"T has shape {T.shape}; it must be ({b.size}, r), a row for each of dofs")
    held = _hold(K, M, b)
    r = T.shape[1]
    static, (frequency, phi) = held.static(T), held.modes(f_max, n_modes)
    Psi = np.zeros((n, r + frequency.size))
    Psi[b, :r], Psi[held.inner, :r], Psi[held.inner, r:] = T, static, phi
    K_c = T.T @ (held.K[b] @ Psi[:, :r])
    return Basis(Psi, np.asarray(0.5 * (K_c + K_c.T)), frequency)


def modulus_levels(
    materials: Sequence[ComplexModulus], moduli: Sequence[float] | None = None
) -> list[list[float]]:
    """Levels of a basis: real shear moduli, Pa, at which its shapes are taken.

    By default there are two levels for each material: its relaxed modulus, for the static state (or, if that
    is zero, the magnitude of G* at the slowest branch), and the magnitude of G* at ω = 1/τ of its fastest
    branch, the end of the band in which the branches describe it. Where these are more than a hundredfold
    apart, a third level, their geometric mean, keeps the stiffness between them within some 0.3 %; two would
    leave 5 % at a thousandfold.

    Parameters
    ----------
    materials
        The viscoelastic materials of the model.
    moduli
        The same levels for every material instead; (G,) is the paper's basis at one modulus.

    Returns
    -------
    list of list of float
        For each level, a modulus for each material.

    Raises
    ------
    ValueError
        For a modulus that is not positive, or a material that names neither.
    """
    if not materials:
        return [[]]
    if moduli is not None:
        return [[G] * len(materials) for G in check_moduli(moduli)]
    low, high = [], []
    for material in materials:
        tau = np.asarray(getattr(material, "tau", ()), dtype=np.float64)
        G0 = abs(complex(answer_of(material, 0.0)))
        if tau.size == 0:
            if not G0 > 0:
                raise ValueError(
                    "moduli must be given: the material names no relaxation times to choose them by"
                )
            low.append(G0)
            high.append(G0)
            continue
        low.append(G0 if G0 > 0 else abs(complex(material.complex_modulus(1 / tau.max()))))
        # shapes want the branches' whole range, also beyond the band of a fit: without it nothing warns
        bare = (
            replace(material, fit=None, band=None, spread=None) if isinstance(material, Maxwell) else material
        )
        high.append(abs(complex(bare.complex_modulus(1 / tau.min()))))
    ratio = float(np.max(np.divide(high, low)))
    if ratio < 1.001:
        return [low]
    return [low, high] if ratio <= 100.0 else [low, np.sqrt(np.multiply(low, high)).tolist(), high]


def orthogonalise(shapes: Array, K: Any, M: Any) -> tuple[Array, Array]:
    """Combine shapes of a basis into modes of each other: unit modal mass, diagonal stiffness.

    Parameters
    ----------
    shapes
        (n, m), with energies uᵀKu of at most about one; combinations with less than DISTINCT are dropped as
        round-off.
    K, M
        Stiffness, N/m, and mass, kg, (n, n).

    Returns
    -------
    frequency : Array
        (p,), Hz, rising, p <= m.
    shapes : Array
        (n, p).
    """
    if not shapes.shape[1]:
        return np.zeros(0), shapes
    energy, mix = np.linalg.eigh(shapes.T @ (K @ shapes))
    kept = energy > DISTINCT
    shapes = shapes @ (mix[:, kept] / np.sqrt(energy[kept]))
    inverse, turn = np.linalg.eigh(shapes.T @ (M @ shapes))
    order = np.argsort(-inverse)
    return 1.0 / (2.0 * np.pi * np.sqrt(inverse[order])), shapes @ (turn[:, order] / np.sqrt(inverse[order]))


def inertia_shapes(solve: Any, M: Any, shapes: Array, inner: Index, rounds: int) -> list[Array]:
    """Shapes of a basis: static answers (n, m) to the inertia of shapes (n, m), then to that of the answers.

    They stand in for the truncated modes: each round makes the error smaller by the square of the frequency
    over that of the first truncated mode.

    Parameters
    ----------
    solve
        Function that finds the static motion (inner, m) under loads (inner, m), the interfaces held.
    M
        Mass (n, n), kg.
    shapes
        Shapes (n, m) whose inertia is the first load.
    inner
        The coordinates that are not held.
    rounds
        How often the answers' inertia is answered again.

    Returns
    -------
    list of Array
        (n, m) for each round, scaled to an energy uᵀKu of one.

    References
    ----------
    Quasi-static compensation, Shyu, Ma & Hulbert, Mech. Struct. Mach. 25 (1997) 379-401.
    """
    found = []
    for _ in range(rounds):
        u = np.zeros_like(shapes)
        load = np.asarray((M @ shapes)[inner])
        u[inner] = solve(load)
        energy = np.sum(u[inner] * load, axis=0)  # uᵀKu: u is zero elsewhere
        shapes = u[:, energy > 0] / np.sqrt(energy[energy > 0])
        found.append(shapes)
    return found


def basis_of(
    model: FullModel,
    *,
    f_max: float | None = None,
    n_modes: int | None = None,
    moduli: Sequence[float] | None = None,
    inertia: int = 1,
    attach: Iterable[str] = (),
    ports: Any = None,
) -> Basis:
    """The basis of a model's reduction.

    Parameters
    ----------
    model
        The part's unreduced equations.
    f_max, n_modes, moduli, inertia, attach
        As in `reduce`.
    ports
        (p, n) rows, as those of raceways, whose unit loads bring their static shapes too; None: none.

    Returns
    -------
    Basis

    Raises
    ------
    ValueError
        As `reduce`.
    """
    _check_truncation(f_max, n_modes)
    if not model.interfaces:
        raise ValueError("interfaces is empty; a part needs at least one to be joined by")
    check_rounds(inertia)
    for name in (attach := tuple(attach)):
        if name not in model.outputs:
            raise ValueError(f"attach has {name!r}; the outputs are {sorted(model.outputs)}")
    levels = modulus_levels([part.material for part in model.viscoelastic], moduli)
    faces = list(model.interfaces.values())
    b = np.concatenate([f.dofs for f in faces])
    T = scipy.linalg.block_diag(*[f.T for f in faces])
    rows = [model.outputs[name] for name in attach] + ([] if ports is None else [ports])
    load = scipy.sparse.vstack(rows).toarray().T if rows else np.zeros((model.n, 0))

    extra: list[Array] = []
    near = None
    for level in levels:
        K = model.stiffness(level)
        at = _hold(K, model.M, b)
        shapes = np.zeros((model.n, T.shape[1] + load.shape[1]))
        shapes[b, : T.shape[1]] = T
        shapes[at.inner] = np.hstack([at.static(T), at.solve(load[at.inner])])
        static, points = np.hsplit(shapes, [T.shape[1]])
        if level is levels[0]:
            held, K_0, Psi = at, K, static
            K_c = T.T @ (K[b] @ Psi)
            K_c = 0.5 * (K_c + K_c.T)
        else:
            # Rigid motion of all interfaces has the same shape at every modulus: the first six add nothing.
            new = slice(0 if model.grounded else 6, None)
            extra.append((static - Psi)[:, new] / np.sqrt(np.diag(K_c)[new]))
        energy = np.sum(points * (K @ points), axis=0)
        extra.append(
            points[:, energy > 0.0] / np.sqrt(energy[energy > 0.0])
        )  # none for a point on an interface
        answers = inertia_shapes(at.solve, model.M, static, at.inner, inertia)
        if level is levels[0] and answers:
            near = answers[-1][at.inner]
        extra += answers
    frequency, modes = held.modes(f_max, n_modes, near)
    internal = np.zeros((model.n, frequency.size))
    internal[held.inner] = modes
    if any(u.shape[1] for u in extra):
        frequency, internal = orthogonalise(
            np.hstack([*extra, internal / (2 * np.pi * frequency)]), K_0, model.M
        )
    return Basis(np.hstack([Psi, internal]), np.asarray(K_c), frequency)
