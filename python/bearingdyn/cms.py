"""Component mode synthesis: a finite element model becomes a superelement (paper section 3.3, (21)-(25)).

A superelement is what the rest of the package knows of a part: reduced matrices, the coordinates of its
rigid six-degree-of-freedom interfaces, and rows that give the motion of named points. Interface coordinates
come first, six after six in the order (x, y, z, θx, θy, θz), then the modal coordinates of the
fixed-interface modes (Craig & Bampton, AIAA Journal 6 (1968) 1313-1319).
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, Protocol

import numpy as np
import scipy.linalg
import scipy.sparse
import scipy.sparse.csgraph
from numpy.typing import ArrayLike, NDArray

from bearingdyn.fem.eigen import factorise, lowest_modes, rigid_body_residual, rigid_transfer

Float = NDArray[np.float64]
Index = NDArray[np.intp]

SYMMETRY = 1e-9  # largest accepted |A - Aᵀ| over the largest |A|: congruence stays far below it


class ComplexModulus(Protocol):
    """A material whose shear modulus depends on the frequency."""

    def complex_modulus(self, omega: Any) -> Any:
        """G*(ω) in Pa for ω in rad/s."""


def _frozen(name: str, value: ArrayLike, shape: tuple[int, ...]) -> Float:
    array = np.array(value, dtype=np.float64)
    if array.shape != shape:
        raise ValueError(f"{name} has shape {array.shape}; it must be {shape}")
    if not np.isfinite(array).all():
        raise ValueError(f"{name} has an entry that is not finite: {array[~np.isfinite(array)][0]}")
    array.setflags(write=False)
    return array


def _check_symmetry(name: str, A: Float, sign: float) -> None:
    scale = np.abs(A).max(initial=0.0)
    error = np.abs(A - sign * A.T).max(initial=0.0)
    if error > SYMMETRY * scale:
        kind = "symmetric" if sign > 0 else "skew-symmetric"
        raise ValueError(f"{name} must be {kind}; it is off by {error:.3g} where entries reach {scale:.3g}")


@dataclass(frozen=True, eq=False)
class Viscoelastic:
    """One viscoelastic material inside a superelement.

    material: anything with ``complex_modulus(omega)``; the time domain needs a Maxwell model.
    H: (n, n) ∫BᵀT2B dV reduced, m; the deviatoric stiffness is 2·G*(ω)·H (paper (16), (23)).
    """

    material: ComplexModulus
    H: Float

    def __post_init__(self) -> None:
        if not callable(getattr(self.material, "complex_modulus", None)):
            raise ValueError(
                f"material is {self.material!r}; a viscoelastic material must have complex_modulus(omega)"
            )
        n = np.shape(self.H)[0] if np.ndim(self.H) else 0
        H = _frozen("H", self.H, (n, n))
        _check_symmetry("H", H, 1.0)
        object.__setattr__(self, "H", H)


@dataclass(frozen=True, eq=False)
class Surface:
    """A surface of a part: ∫ v_n² dA = q̇ᵀ W q̇ of the normal velocity. area: m²; W: (n, n) symmetric, m²."""

    area: float
    W: Float

    def __post_init__(self) -> None:
        if not (self.area > 0 and math.isfinite(self.area)):
            raise ValueError(f"area is {self.area}; a surface has a positive area in m²")
        n = np.shape(self.W)[0] if np.ndim(self.W) else 0
        W = _frozen("W", self.W, (n, n))
        _check_symmetry("W", W, 1.0)
        object.__setattr__(self, "W", W)


@dataclass(frozen=True, eq=False)
class Superelement:
    """A reduced part: M ẍ + (C + Ω G) ẋ + (K + Ω N) x + Σ 2 G*(ω) H x = f.

    M, C, K: (n, n) symmetric mass (kg), viscous damping (N s/m) and stiffness (N/m). K holds the elastic
        regions and the volumetric part of viscoelastic ones, not their deviatoric part.
    G: (n, n) skew, kg: the gyroscopic force on the left-hand side is Ω G ẋ, with G[θx, θy] = +Ip and
        G[θy, θx] = -Ip.
    interfaces: name -> (6,) indices of the coordinates x, y, z, θx, θy, θz of a rigid joint.
    outputs: name -> rows (6, n) or (3, n), the motion of a named point (interfaces are outputs too); a load f
        there acts as rowsᵀ f.
    viscoelastic: the materials whose deviatoric stiffness is kept apart.

    N: (n, n) skew, N s/m: the circulatory force Ω N x on the left-hand side, there when the damping C belongs
        to material that turns with the shaft; zero by default.
    surfaces: name -> Surface, from which sound is radiated.

    Raises ValueError for a wrong shape, a matrix with non-finite entries or without its symmetry, an index
    out of range or used twice, or a name used twice.
    """

    M: Float
    C: Float
    K: Float
    G: Float
    interfaces: Mapping[str, Index]
    outputs: Mapping[str, Float] = field(default_factory=dict)
    viscoelastic: tuple[Viscoelastic, ...] = ()
    N: Float | None = None
    surfaces: Mapping[str, Surface] = field(default_factory=dict)

    def __post_init__(self) -> None:
        n = np.shape(self.M)[0] if np.ndim(self.M) else 0
        if n == 0:
            raise ValueError(f"M has shape {np.shape(self.M)}; it must be (n, n) with n of at least 1")
        if self.N is None:
            object.__setattr__(self, "N", np.zeros((n, n)))
        for name, sign in (("M", 1.0), ("C", 1.0), ("K", 1.0), ("G", -1.0), ("N", -1.0)):
            A = _frozen(name, getattr(self, name), (n, n))
            _check_symmetry(name, A, sign)
            object.__setattr__(self, name, A)

        taken: dict[int, str] = {}
        interfaces: dict[str, Index] = {}
        for name, given in self.interfaces.items():
            index = np.array(given)
            if index.shape != (6,) or not np.issubdtype(index.dtype, np.integer):
                raise ValueError(
                    f"interfaces[{name!r}] is {given!r}; it must be 6 integers (of x, y, z, θx, θy, θz)"
                )
            index = index.astype(np.intp)
            for i in index.tolist():
                if not 0 <= i < n:
                    raise ValueError(f"interfaces[{name!r}] holds index {i}; it must lie in 0...{n - 1}")
                if i in taken:
                    raise ValueError(f"interfaces[{name!r}] and [{taken[i]!r}] share index {i}; use it once")
                taken[i] = name
            index.setflags(write=False)
            interfaces[name] = index
        object.__setattr__(self, "interfaces", interfaces)

        outputs: dict[str, Float] = {}
        for name, rows in self.outputs.items():
            if name in interfaces:
                raise ValueError(f"outputs has {name!r}, the name of an interface ; choose another")
            count = np.shape(rows)[0] if np.ndim(rows) else 0
            if count not in (3, 6):
                raise ValueError(f"outputs[{name!r}] has shape {np.shape(rows)}; it must be (3 or 6, {n})")
            outputs[name] = _frozen(f"outputs[{name!r}]", rows, (count, n))
        object.__setattr__(self, "outputs", outputs)

        object.__setattr__(self, "surfaces", dict(self.surfaces))
        for name, surface in self.surfaces.items():
            if surface.W.shape != (n, n):
                raise ValueError(f"surfaces[{name!r}].W has shape {surface.W.shape}; it must be ({n}, {n})")

        object.__setattr__(self, "viscoelastic", tuple(self.viscoelastic))
        for i, part in enumerate(self.viscoelastic):
            if part.H.shape != (n, n):
                raise ValueError(f"viscoelastic[{i}].H has shape {part.H.shape}; it must be ({n}, {n})")

    @property
    def n(self) -> int:
        """Number of coordinates."""
        return int(self.M.shape[0])

    def rows(self, name: str) -> Float:
        """Rows (6, n) or (3, n) giving the motion of an interface or output point.

        Raises ValueError when the superelement has no such name.
        """
        if name in self.interfaces:
            return np.eye(self.n)[self.interfaces[name]]
        if name in self.outputs:
            return self.outputs[name]
        known = sorted([*self.interfaces, *self.outputs])
        raise ValueError(f"no interface or output {name!r}; there are {known}")

    def stiffness(self, omega: float = 0.0) -> NDArray[np.complex128]:
        """Complex stiffness K + Σ 2 G*(ω) H, (n, n), N/m (paper (20)); ω in rad/s."""
        K = self.K.astype(np.complex128)
        for part in self.viscoelastic:
            K = K + 2.0 * complex(np.asarray(part.material.complex_modulus(omega)).item()) * part.H
        return K


@dataclass(frozen=True, eq=False)
class RigidInterface:
    """A set of finite element coordinates that moves as one rigid body with six coordinates q: u[dofs] = T q.

    dofs: (m,) indices into the model's coordinates.
    T: (m, 6) for q = (x, y, z, θx, θy, θz) of the reference point.
    position: (3,) reference point, m.
    """

    dofs: Index
    T: Float
    position: Float

    def __post_init__(self) -> None:
        dofs = np.array(self.dofs)
        if dofs.ndim != 1 or dofs.size == 0 or not np.issubdtype(dofs.dtype, np.integer):
            raise ValueError(f"dofs has shape {dofs.shape}, type {dofs.dtype}; it must be a list of integers")
        if np.unique(dofs).size != dofs.size:
            raise ValueError("dofs names a coordinate twice; name each once")
        object.__setattr__(self, "dofs", dofs.astype(np.intp))
        object.__setattr__(self, "T", _frozen("T", self.T, (dofs.size, 6)))
        object.__setattr__(self, "position", _frozen("position", self.position, (3,)))


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
    if (f_max is None) == (n_modes is None):
        raise ValueError(f"f_max={f_max} and n_modes={n_modes}: give exactly one of the two")
    if f_max is not None and not f_max >= 0.0:
        raise ValueError(f"f_max is {f_max}; it must be a frequency in Hz, not negative")
    if n_modes is not None and not n_modes >= 0:
        raise ValueError(f"n_modes is {n_modes}; it must not be negative")
    n = np.shape(K)[0]
    if np.shape(K) != (n, n) or np.shape(M) != (n, n):
        raise ValueError(f"M has shape {np.shape(M)} and K {np.shape(K)}; both must be square and alike")
    b = np.asarray(dofs, dtype=np.intp)
    if b.ndim != 1 or b.size == 0 or np.unique(b).size != b.size or b.min() < 0 or b.max() >= n:
        raise ValueError(f"dofs {dofs!r} must be distinct indices in 0...{n - 1}, at least one")
    T = np.eye(b.size) if T is None else np.asarray(T, dtype=np.float64)
    if T.ndim != 2 or T.shape[0] != b.size:
        raise ValueError(f"T has shape {T.shape}; it must be ({b.size}, r), a row for each of dofs")
    limit = n if n_modes is None else min(n_modes, n)
    cut = math.inf if f_max is None else f_max

    K, M = scipy.sparse.csr_matrix(K), scipy.sparse.csr_matrix(M)
    inner = np.setdiff1d(np.arange(n), b)
    K_ib = K[inner][:, b] @ T
    K_ii, M_ii = K[inner][:, inner], M[inner][:, inner]
    static = np.zeros((inner.size, T.shape[1]))
    frequencies: list[Float] = []
    shapes: list[Float] = []
    # Bending planes, stretch and torsion of a shaft do not couple: each block is solved by itself.
    count, label = scipy.sparse.csgraph.connected_components(abs(K_ii) + abs(M_ii), directed=False)
    for block in range(count):
        at = np.flatnonzero(label == block)
        k, m = K_ii[at][:, at], M_ii[at][:, at]
        try:
            lu = factorise(k)
            static[at] = -lu.solve(np.ascontiguousarray(K_ib[at]))
            frequency, phi = lowest_modes(k, m, cut, limit, lu)
        except (np.linalg.LinAlgError, RuntimeError) as error:
            raise ValueError(
                f"dofs {b} leave the model free to move, or M or K is not positive definite ({error}); "
                "a body is held by one rigid interface of six coordinates"
            ) from error
        shape = np.zeros((inner.size, frequency.size))
        shape[at] = phi
        frequencies.append(frequency)
        shapes.append(shape)

    frequency = np.concatenate([np.zeros(0), *frequencies])
    phi = np.hstack([np.zeros((inner.size, 0)), *shapes])
    order = np.argsort(frequency, kind="stable")[:limit]
    r = T.shape[1]
    Psi = np.zeros((n, r + order.size))
    Psi[b, :r], Psi[inner, :r], Psi[inner, r:] = T, static, phi[:, order]
    K_c = T.T @ (K[b] @ Psi[:, :r])
    return Basis(Psi, np.asarray(0.5 * (K_c + K_c.T)), frequency[order])


def modal_damping(M: ArrayLike, K: ArrayLike, zeta: float) -> Float:
    """Viscous damping (n, n), N s/m, that gives every free elastic mode of (M, K) the damping ratio zeta.

    C = M Φ diag(2 ζ ω) Φᵀ M with ΦᵀMΦ = I, rigid-body modes undamped: the same matrix serves the time and
    the frequency domain. M (n, n) must be positive definite. A mode counts as rigid when its ω² is below
    round-off of the largest.

    Raises ValueError for zeta outside 0...1 or an M that is not positive definite.
    Reference: Wilson & Penzien, Int. J. Num. Meth. Eng. 4 (1972) 5-10.
    """
    m, k = np.asarray(M, dtype=np.float64), np.asarray(K, dtype=np.float64)
    if not 0.0 <= zeta < 1.0:
        raise ValueError(f"zeta is {zeta}; a damping ratio lies in 0 <= zeta < 1")
    if zeta == 0.0:
        return np.zeros_like(m)
    if not np.all(np.diag(m) > 0):
        raise ValueError("M has a diagonal entry that is not positive; modal damping needs a mass for each")
    C = np.zeros_like(m)
    for block in coupled_blocks(m, k):  # so that round-off does not couple what M and K do not
        inside = np.ix_(block, block)
        m_b, k_b = m[inside], k[inside]
        s = 1.0 / np.sqrt(np.diag(m_b))  # metres and radians brought to one scale before the rank decision
        try:
            lam, phi = scipy.linalg.eigh(s[:, None] * k_b * s, s[:, None] * m_b * s)
        except np.linalg.LinAlgError as error:
            raise ValueError(
                f"M is not positive definite ({error}); modal damping needs one that is"
            ) from error
        elastic = lam > 100.0 * len(lam) * np.finfo(float).eps * np.abs(lam).max()
        MPhi = m_b @ (s[:, None] * phi[:, elastic])
        C[inside] = (MPhi * (2.0 * zeta * np.sqrt(lam[elastic]))) @ MPhi.T
    return C


def coupled_blocks(*matrices: Float) -> list[Index]:
    """Coordinates that any nonzero entry of the (n, n) matrices couples, block by block."""
    pattern = scipy.sparse.csr_matrix(sum((np.asarray(A) != 0.0) for A in matrices))
    count, label = scipy.sparse.csgraph.connected_components(pattern, directed=False)
    return [np.flatnonzero(label == b) for b in range(count)]


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
    surfaces: Mapping[str, tuple[Any, Float]] | None = None,
) -> Superelement:
    """Superelement of an elastic body free in space, by Craig-Bampton reduction.

    M, K, G: (n, n) dense or sparse; G skew, its force being Ω G ẋ.
    interfaces: name -> rigid interface, no coordinate in two of them; outputs: name -> rows (6, n) or (3, n).
    spin: (n, n) generator J of a turn about z for a body of revolution that turns with the shaft: its damping
        then acts on ẋ - Ω J x, and the superelement has the circulatory matrix N = -C J.
    damping: ratio ζ of every elastic mode (modal_damping), of the free body or of the body held at the
        interface `held`. Dampers then act on the motion relative to that interface, never on rigid motion.
    f_max, n_modes: as in craig_bampton.
    surfaces: name -> rows (q, n) of the normal motion at integration points, and weights (q,), m².

    Raises ValueError for interfaces that overlap, or a stiffness that resists rigid motion.
    """
    if not interfaces:
        raise ValueError("interfaces is empty; a part needs at least one to be joined by")
    owner: dict[int, str] = {}
    for name, face in interfaces.items():
        for i in face.dofs.tolist():
            if owner.setdefault(i, name) != name:
                raise ValueError(f"interfaces {owner[i]!r} and {name!r} share coordinate {i}; move one")
    faces = list(interfaces.values())
    basis = craig_bampton(
        M,
        K,
        np.concatenate([f.dofs for f in faces]),
        scipy.linalg.block_diag(*[f.T for f in faces]),
        f_max=f_max,
        n_modes=n_modes,
    )
    r = 6 * len(faces)
    R = rigid_transfer([f.position for f in faces], np.mean([f.position for f in faces], axis=0))
    residual = rigid_body_residual(K, basis.Psi[:, :r] @ R)
    if not residual < 1e-6:
        raise ValueError(f"K resists rigid motion (relative force {residual:.2g}); the body must be free")
    P = np.eye(r) - R @ np.linalg.solve(R.T @ R, R.T)
    k = P.T @ basis.K @ P  # rigid motion costs nothing: remove what cancellation left
    K_r = basis.stiffness()
    K_r[:r, :r] = 0.5 * (k + k.T)
    M_r = basis.reduce(M)
    if held is None:
        C = modal_damping(M_r, K_r, damping)
    else:
        own = np.arange(6) + 6 * list(interfaces).index(held)
        others = np.setdiff1d(np.arange(len(M_r)), own)
        inside = np.ix_(others, others)
        relative = np.eye(len(M_r))[others]
        carried = rigid_transfer([f.position for f in faces], interfaces[held].position)
        relative[:, own] -= np.vstack([carried, np.zeros((len(M_r) - r, 6))])[others]
        C = relative.T @ modal_damping(M_r[inside], K_r[inside], damping) @ relative
    N = np.zeros_like(M_r)
    if spin is not None and damping > 0.0:
        CJ = C @ np.linalg.solve(M_r, basis.Psi.T @ (M @ (spin @ basis.Psi)))
        N = -0.5 * (CJ - CJ.T)
    rows: Mapping[str, Any] = outputs or {}
    return Superelement(
        M=M_r,
        C=C,
        K=K_r,
        G=np.zeros_like(M_r) if G is None else basis.reduce(G, skew=True),
        interfaces={name: np.arange(6 * i, 6 * i + 6) for i, name in enumerate(interfaces)},
        outputs={name: np.asarray(row @ basis.Psi) for name, row in rows.items()},
        N=N,
        surfaces={name: _surface(r @ basis.Psi, w) for name, (r, w) in (surfaces or {}).items()},
    )


def _surface(rows: Float, weights: Float) -> Surface:
    W = rows.T @ (weights[:, None] * rows)
    return Surface(float(weights.sum()), np.asarray(0.5 * (W + W.T)))
