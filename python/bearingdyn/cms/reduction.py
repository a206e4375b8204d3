"""Craig-Bampton reduction with rigid interfaces, and shapes at several moduli of viscoelastic regions."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import scipy
from numpy.typing import ArrayLike

from bearingdyn.cms.damping import modal_damping
from bearingdyn.cms.full import FullModel, RigidInterface
from bearingdyn.cms.superelement import ComplexModulus, Float, Index, Superelement, Viscoelastic
from bearingdyn.fem.eigen import factorise, lowest_modes, rigid_body_residual, rigid_transfer
from bearingdyn.material import Maxwell

DISTINCT = 1e-12  # energy of a difference of shapes, over that of a shape, below which it is round-off


@dataclass(frozen=True, eq=False)
class Basis:
    """Shapes of a reduction, u = Psi q.

    Psi: (n, r + m), the r constraint modes and then m fixed-interface modes of unit modal mass.
    K: (r, r) stiffness of the constraint modes, N/m; it is the exact static stiffness seen at the interfaces.
    frequency: (m,) frequencies of the fixed-interface modes, Hz.
    """

    Psi: Float
    K: Float
    frequency: Float

    def reduce(self, A: Any, *, skew: bool = False) -> Float:
        """Psiᵀ A Psi for a symmetric (or skew) A, (r + m, r + m), round-off asymmetry removed."""
        a = self.Psi.T @ (A @ self.Psi)
        return np.asarray(0.5 * (a - a.T) if skew else 0.5 * (a + a.T))

    def stiffness(self) -> Float:
        """Reduced stiffness, (r + m, r + m): constraint and fixed-interface modes do not couple in K."""
        return np.asarray(scipy.linalg.block_diag(self.K, np.diag((2.0 * np.pi * self.frequency) ** 2)))


@dataclass(frozen=True, eq=False)
class _Held:
    """A model with some coordinates held: the rest in blocks that do not couple, each with factors."""

    K: Any
    held: Index
    inner: Index
    blocks: list[tuple[Index, Any, Any, Any]]  # coordinates within inner, stiffness, mass, factors

    def solve(self, load: Any) -> Float:
        """Static motion (inner, m) under loads (inner, m), the interface held."""
        u = np.zeros(load.shape)
        for at, _, _, lu in self.blocks:
            u[at] = lu.solve(np.ascontiguousarray(load[at]))
        return u

    def static(self, T: Float) -> Float:
        """Static motion (inner, r) that goes with interface motions T (held, r)."""
        return -self.solve(np.asarray(self.K[self.inner][:, self.held] @ T))

    def modes(self, f_max: float | None, n_modes: int | None) -> tuple[Float, Float]:
        """Rising frequencies (m,), Hz, and shapes (inner, m) of unit modal mass, the interface held."""
        limit = self.inner.size if n_modes is None else min(n_modes, self.inner.size)
        found = [(np.zeros(0), np.zeros((self.inner.size, 0)))]
        for at, k, m, lu in self.blocks:
            try:
                frequency, phi = lowest_modes(k, m, math.inf if f_max is None else f_max, limit, lu)
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
    inner = np.setdiff1d(np.arange(K.shape[0]), held)
    K_ii, M_ii = K[inner][:, inner], M[inner][:, inner]
    # Bending planes, stretch and torsion of a shaft do not couple: each block is solved by itself.
    count, label = scipy.sparse.csgraph.connected_components(abs(K_ii) + abs(M_ii), directed=False)
    blocks = []
    for block in range(count):
        at = np.flatnonzero(label == block)
        k, m = K_ii[at][:, at], M_ii[at][:, at]
        try:
            blocks.append((at, k, m, factorise(k)))
        except RuntimeError as error:
            raise _free_to_move(held, error) from error
    return _Held(K, held, inner, blocks)


def _free_to_move(held: Index, error: Exception) -> ValueError:
    return ValueError(
        f"dofs {held} leave the model free to move, or M or K is not positive definite ({error}); "
        "a body is held by one rigid interface of six coordinates"
    )


def _check_truncation(f_max: float | None, n_modes: int | None) -> None:
    if (f_max is None) == (n_modes is None):
        raise ValueError(f"f_max={f_max} and n_modes={n_modes}: give exactly one of the two")
    if f_max is not None and not f_max >= 0.0:
        raise ValueError(f"f_max is {f_max}; it must be a frequency in Hz, not negative")
    if n_modes is not None and not n_modes >= 0:
        raise ValueError(f"n_modes is {n_modes}; it must not be negative")


def craig_bampton(
    M: Any,
    K: Any,
    dofs: ArrayLike,
    T: ArrayLike | None = None,
    *,
    f_max: float | None = None,
    n_modes: int | None = None,
) -> Basis:
    """Constraint modes of an interface and the fixed-interface modes, for dense or sparse symmetric M and K.

    M, K: (n, n) mass, kg, and stiffness, N/m, of the free model.
    dofs: (m,) interface coordinates; T: (m, r) makes them move as u[dofs] = T q (default: each by itself).
    f_max: keep the fixed-interface modes up to this frequency, Hz; or n_modes: keep that many. Give one of
        the two. Three to four times the highest frequency of interest keeps
        frequencies to about 0.1 %, twice to about 1 %.

    Raises ValueError for shapes that do not fit, for both or neither of f_max and n_modes, and for an
    interface that leaves the rest of the model free to move.
    Reference: Craig & Bampton (1968); paper (21).
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
    """Real shear moduli, Pa, at which shapes are taken: a list over the viscoelastic materials per level.

    moduli: the same levels for every material; (G,) is the paper's basis at one modulus.
    By default two levels for each material: its relaxed modulus, for the static state (or, if that is zero,
    |G*| at the slowest branch), and |G*| at ω = 1/τ of its fastest branch, the end of the band in which
    the branches describe it. Where these are more than a hundredfold apart, a third level, their geometric
    mean, keeps the stiffness between them within some 0.3 %; two would leave 5 % at a thousandfold.

    Raises ValueError for a modulus that is not positive, or a material that names neither.
    """
    if not materials:
        return [[]]
    if moduli is not None:
        if not moduli or not all(0 < G < math.inf for G in moduli):
            raise ValueError(f"moduli is {tuple(moduli)}; it needs one or more positive shear moduli, Pa")
        return [[float(G)] * len(materials) for G in moduli]
    low, high = [], []
    for material in materials:
        tau = np.asarray(getattr(material, "tau", ()), dtype=np.float64)
        G0 = abs(complex(material.complex_modulus(0.0)))
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
        bare = replace(material, fit=None, band=None) if isinstance(material, Maxwell) else material
        high.append(abs(complex(bare.complex_modulus(1 / tau.min()))))
    ratio = float(np.max(np.divide(high, low)))
    if ratio < 1.001:
        return [low]
    return [low, high] if ratio <= 100.0 else [low, np.sqrt(np.multiply(low, high)).tolist(), high]


def orthogonalise(shapes: Float, K: Any, M: Any) -> tuple[Float, Float]:
    """Combine shapes (n, m) into modes of each other: unit modal mass, diagonal stiffness.

    The shapes come with energies uᵀKu of at most about one; combinations with less than DISTINCT are
    dropped as round-off. Returns rising frequencies (p,), Hz, and shapes (n, p), p <= m.
    """
    if not shapes.shape[1]:
        return np.zeros(0), shapes
    energy, mix = np.linalg.eigh(shapes.T @ (K @ shapes))
    kept = energy > DISTINCT
    shapes = shapes @ (mix[:, kept] / np.sqrt(energy[kept]))
    inverse, turn = np.linalg.eigh(shapes.T @ (M @ shapes))
    order = np.argsort(-inverse)
    return 1.0 / (2.0 * np.pi * np.sqrt(inverse[order])), shapes @ (turn[:, order] / np.sqrt(inverse[order]))


def basis_of(
    model: FullModel,
    *,
    f_max: float | None = None,
    n_modes: int | None = None,
    moduli: Sequence[float] | None = None,
    attach: Iterable[str] = (),
) -> Basis:
    """Shapes of a model's reduction; the arguments are those of `reduce`."""
    _check_truncation(f_max, n_modes)
    if not model.interfaces:
        raise ValueError("interfaces is empty; a part needs at least one to be joined by")
    levels = modulus_levels([part.material for part in model.viscoelastic], moduli)
    faces = list(model.interfaces.values())
    b = np.concatenate([f.dofs for f in faces])
    T = scipy.linalg.block_diag(*[f.T for f in faces])
    K = model.stiffness(levels[0])
    held = _hold(K, model.M, b)
    r = T.shape[1]
    static = held.static(T)
    Psi = np.zeros((model.n, r))
    Psi[b], Psi[held.inner] = T, static
    K_c = T.T @ (held.K[b] @ Psi)
    K_c = 0.5 * (K_c + K_c.T)
    frequency, phi = held.modes(f_max, n_modes)

    extra = []
    rows = [model.outputs[name] for name in attach]
    if rows:  # static shapes under loads at the points, the interfaces held (Craig & Chang 1977)
        load = scipy.sparse.vstack(rows).T.tocsr()[held.inner].toarray()
        extra.append(held.solve(load))
    unit = 1.0 / np.sqrt(np.diag(K_c))
    for level in levels[1:]:
        other = _hold(model.stiffness(level), model.M, b)
        # Rigid motion of all interfaces has the same shape at every modulus: those of the first add nothing.
        extra.append(((other.static(T) - static) * unit)[:, 0 if model.grounded else 6 :])
        if rows:
            extra.append(other.solve(load))
    if extra:
        K_ii, M_ii = held.K[held.inner][:, held.inner], model.M[held.inner][:, held.inner]
        if rows:  # unit energy each
            extra = [u / np.sqrt(np.maximum(np.sum(u * (K_ii @ u), axis=0), 1e-300)) for u in extra]
        frequency, phi = orthogonalise(np.hstack([*extra, phi / (2 * np.pi * frequency)]), K_ii, M_ii)
    whole = np.zeros((model.n, frequency.size))
    whole[held.inner] = phi
    return Basis(np.hstack([Psi, whole]), np.asarray(K_c), frequency)


def reduce(
    model: FullModel,
    *,
    f_max: float | None = None,
    n_modes: int | None = None,
    moduli: Sequence[float] | None = None,
    damping: float = 0.0,
    held: str | None = None,
    attach: Iterable[str] = (),
) -> Superelement:
    """Superelement of a full model: constraint modes of its interfaces and shapes that vanish on them.

    f_max: keep the fixed-interface modes up to this frequency, Hz; or n_modes: keep that many. Give one.
    moduli: shear moduli, Pa, at which the constraint modes of a viscoelastic part are taken
        (modulus_levels). The first serves as reference: constraint modes, fixed-interface modes, diagonal
        stiffness. Each further one adds the differences of its constraint modes, up to 6 (i - 1) shapes for
        i interfaces.
    damping: ratio ζ of every elastic mode (modal_damping) of the body with only its elastic stiffness, free
        or held at the interface `held`. Dampers then act on the motion relative to that interface, never on
        rigid motion. It is added to the model's own C.
    attach: outputs where loads may act: their static shapes at each modulus join the basis, so that the
        motion a load there causes is statically exact, which truncated modes leave to chance.

    Raises ValueError for a stiffness that resists rigid motion (unless model.grounded), interfaces that leave
    the body free to move, an unknown output, and values outside their range.
    Reference: paper (21)-(25); Craig & Bampton (1968); attachment, Craig & Chang, AIAA Paper 77-405 (1977).
    """
    attach = tuple(attach)
    for name in attach:
        if name not in model.outputs:
            raise ValueError(f"attach has {name!r}; the outputs are {sorted(model.outputs)}")
    if held is not None and held not in model.interfaces:
        raise ValueError(f"held is {held!r}; the interfaces are {sorted(model.interfaces)}")
    basis = basis_of(model, f_max=f_max, n_modes=n_modes, moduli=moduli, attach=attach)
    return project(model, basis, damping=damping, held=held)


def project(model: FullModel, basis: Basis, *, damping: float = 0.0, held: str | None = None) -> Superelement:
    """Superelement of a model in a given basis (Psiᵀ A Psi for each of its matrices); see `reduce`."""
    faces = list(model.interfaces.values())
    r = 6 * len(faces)
    R = rigid_transfer([f.position for f in faces], np.mean([f.position for f in faces], axis=0))
    M = basis.reduce(model.M)
    P = np.eye(len(M))
    if not model.grounded:
        rigid = basis.Psi[:, :r] @ R
        for name, A in [
            ("K", model.K),
            *((f"viscoelastic[{i}].H", p.H) for i, p in enumerate(model.viscoelastic)),
        ]:
            residual = rigid_body_residual(A, rigid)
            if not residual < 1e-6:
                raise ValueError(
                    f"{name} resists rigid motion (relative force {residual:.2g}); the body must be free"
                )
        P[:r, :r] -= R @ np.linalg.solve(R.T @ R, R.T)  # rigid motion costs nothing: remove round-off
    if model.viscoelastic:
        K = P.T @ basis.reduce(model.K) @ P
    else:
        K = basis.stiffness()
        k = P[:r, :r].T @ basis.K @ P[:r, :r]
        K[:r, :r] = 0.5 * (k + k.T)
    E = K if model.E is None else P.T @ basis.reduce(model.E) @ P
    if held is None:
        C = modal_damping(M, E, damping)
    else:
        own = np.arange(6) + 6 * list(model.interfaces).index(held)
        others = np.setdiff1d(np.arange(len(M)), own)
        inside = np.ix_(others, others)
        relative = np.eye(len(M))[others]
        carried = rigid_transfer([f.position for f in faces], model.interfaces[held].position)
        relative[:, own] -= np.vstack([carried, np.zeros((len(M) - r, 6))])[others]
        C = relative.T @ modal_damping(M[inside], E[inside], damping) @ relative
    N = np.zeros_like(M)
    if model.spin is not None and damping > 0.0:
        CJ = C @ np.linalg.solve(M, basis.Psi.T @ (model.M @ (model.spin @ basis.Psi)))
        N = -0.5 * (CJ - CJ.T)
    if model.C is not None:
        C = C + basis.reduce(model.C)
    return Superelement(
        M=M,
        C=C,
        K=K,
        G=np.zeros_like(M) if model.G is None else basis.reduce(model.G, skew=True),
        interfaces={name: np.arange(6 * i, 6 * i + 6) for i, name in enumerate(model.interfaces)},
        outputs={name: np.asarray(row @ basis.Psi) for name, row in model.outputs.items()},
        viscoelastic=tuple(
            Viscoelastic(part.material, P.T @ basis.reduce(part.H) @ P) for part in model.viscoelastic
        ),
        N=N,
    )


def reduce_free_body(
    M: Any,
    K: Any,
    interfaces: Mapping[str, RigidInterface],
    outputs: Mapping[str, Any] | None = None,
    *,
    G: Any = None,
    spin: Any = None,
    damping: float = 0.0,
    held: str | None = None,
    f_max: float | None = None,
    n_modes: int | None = None,
) -> Superelement:
    """Superelement of an elastic body free in space, by Craig-Bampton reduction.

    M, K, G: (n, n) dense or sparse; G skew, its force being Ω G ẋ.
    interfaces: name -> rigid interface, no coordinate in two of them; outputs: name -> rows (6, n) or (3, n).
    spin: (n, n) generator J of a turn about z for a body of revolution that turns with the shaft: its damping
        then acts on ẋ - Ω J x, and the superelement has the circulatory matrix N = -C J.
    damping: ratio ζ of every elastic mode (modal_damping), of the free body or of the body held at the
        interface `held`. Dampers then act on the motion relative to that interface, never on rigid motion.
    f_max, n_modes: as in craig_bampton.

    Raises ValueError for interfaces that overlap, or a stiffness that resists rigid motion.
    """
    model = FullModel(M, K, interfaces, outputs or {}, G=G, spin=spin)
    return reduce(model, f_max=f_max, n_modes=n_modes, damping=damping, held=held)
