"""The system: an application as plain arrays, ready for the C core.

    M ẍ + (C + Ω G) ẋ + (K + Ω N) x + Σ 2 [G*] L Lᵀ x + Bᵀ g(B x) = f(t)

Layers are kept apart by a factor of their deviatoric matrix, H = L Lᵀ (paper (16), (25)): their modulus is a
property of time or frequency, not of the matrices.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any, TypeAlias

import numpy as np
import scipy.linalg

from bearingdyn import core
from bearingdyn.application import COMPONENTS, Channel, Part
from bearingdyn.bearing import RIGID, BallBearing, BearingKernel, LooseFit, RacewaySeries
from bearingdyn.checks import meant
from bearingdyn.cms import Superelement, Viscoelastic, coupled_blocks
from bearingdyn.magnitude import check_speed_value, plausible
from bearingdyn.material import Maxwell
from bearingdyn.short import short
from bearingdyn.types import Array, Index

# of layers at rest: "relaxed", "instantaneous", a time after loading, s, or a modulus for each, Pa
Modulus: TypeAlias = str | float | Sequence[float]

# below this share of the largest eigenvalue of (K, M) its round-off may hide a slow mode
SLOW = 1e-6
# round-off left in φᵀKφ, as a share of |φ|ᵀ|K||φ|, and in the slow modes, as a share of the fastest of them
ROUND_OFF, SLOW_ROUND_OFF = 1e-12, 1e-13
# below this share of the largest (scaled) eigenvalue a matrix has none: rigid motions of a deviatoric one
RANK = 1e-11
# of two entries that should be equal, as a share of the largest of the matrix: far above the round-off of
# double precision in any change of coordinates, far below what a wrong sign makes
ASYMMETRY = 1e-9
# a test spring in N/m that stands for a bearing when free motions are sought: any stiff value serves
TEST_SPRING = 1e8


@dataclass(frozen=True, eq=False)
class LayerTerm:
    """One viscoelastic material of one part: its deviatoric stiffness is 2 G*(ω) L Lᵀ, L (n, rank).

    strain: (rank,), γ² = Σ strain |Lᵀx|² is the square of the shear strain amplitude that counts for a law of
    softening; None where the material has none.
    """

    part: str
    material: Any
    L: Array
    strain: Array | None = None

    __repr__ = short


@dataclass(frozen=True, eq=False)
class BearingTerm:
    """One bearing or loose fit.

    Parameters
    ----------
    name, bearing
        Its name and what it is.
    B
        (n_coefs, n); B x are its relative raceway coefficients, inner minus outer, m.
    series
        Which coefficients they are.
    offset
        Distance along z, m, of the inner ring from where B x puts it.
    ends
        Rows (n_coefs, 6) of the interface at each end, by the interface's name.
    """

    name: str
    bearing: BallBearing | LooseFit
    B: Array
    series: RacewaySeries = RIGID
    offset: float = 0.0
    ends: Mapping[str, Array] = field(default_factory=dict)

    __repr__ = short

    def kernel(self) -> BearingKernel:
        """The bearing as the contact kernel takes it, its offset in the axial distance of the grooves."""
        kernel = self.bearing.kernel(self.series)
        if self.offset == 0.0:
            return kernel
        # e0 = x0² + y0² − A² moves by offset (2 x0 + offset), without cancellation
        shift = self.offset * (2.0 * kernel.x0 + self.offset)
        return replace(kernel, x0=kernel.x0 + self.offset, e0=kernel.e0 + shift)


@dataclass(frozen=True, eq=False)
class PartTerm:
    """One part of the system.

    Parameters
    ----------
    name, element
        Its name and its matrices.
    place
        (m, n); place @ x are the coordinates of the part.
    rigid
        (m, 6), its coordinates in unit rigid motions x, y, z, θx, θy, θz of its first interface; NaN for a
        part that holds itself.
    source
        What it was reduced from.
    """

    name: str
    element: Superelement
    place: Array
    rigid: Array
    source: Part

    __repr__ = short


@dataclass(frozen=True, eq=False)
class SpringTerm:
    """Springs and dampers of one joint.

    Parameters
    ----------
    name
        Of the joint.
    across
        (k, n); across @ x are the motions that they resist.
    stiffness, damping
        (k,), N/m and N s/m (N m/rad and N m s/rad of rotations).
    ends
        Rows (k, 6) of the interface at each end, by the interface's name.
    """

    name: str
    across: Array
    stiffness: Array
    damping: Array
    ends: Mapping[str, Array] = field(default_factory=dict)

    __repr__ = short


@dataclass(frozen=True, eq=False)
class LoadTerm:
    """One load: kind one of bearingdyn.core.LOAD_KINDS, columns (n,), table for a sampled one.

    part: the part it acts on, if one; own_cos, own_sin: the columns in the part's coordinates.
    """

    kind: str
    omega: float
    p_cos: Array
    p_sin: Array
    time: Array
    value: Array
    part: str = ""
    own_cos: Array | None = None
    own_sin: Array | None = None

    __repr__ = short


@dataclass(frozen=True, eq=False, kw_only=True)
class System:
    """Matrices (n, n), terms, and rows (3 or 6, n) of every interface and output by name.

    All fields are given by name; M, C, G, K, N is the order wherever the matrices are listed.

    Raises
    ------
    ValueError
        For M, C or K that is not symmetric, G or N that is not skew-symmetric, and matrices of unequal
        shape or with an entry that is not finite; names the matrix and the entry.
    """

    M: Array
    C: Array
    G: Array
    K: Array
    N: Array
    layers: tuple[LayerTerm, ...] = ()
    bearings: tuple[BearingTerm, ...] = ()
    loads: tuple[LoadTerm, ...] = ()
    outputs: Mapping[str, Array] = field(default_factory=dict)
    standstill: tuple[str, ...] = ()
    """Parts that turn with the shaft, but whose damping is written for the fixed frame."""
    inertia: Array | None = None
    """(n, 3) kg: −inertia @ ü is the force of a ground that moves with ü; NaN where a part holds itself."""
    parts: tuple[PartTerm, ...] = ()
    springs: tuple[SpringTerm, ...] = ()
    held: tuple[tuple[str, ...], ...] = ()
    """Interfaces that the ground holds rigidly, those that are one joint together."""
    turning: tuple[str, ...] = ()
    """Parts that turn with the shaft."""
    positions: Mapping[str, Array] = field(default_factory=dict)
    """Where interfaces and outputs stand, (3,) m, from the first interface of the first part."""
    inputs: str = ""
    """What the system was assembled from, as `bearingdyn.inputs` writes it."""

    def __post_init__(self) -> None:
        """Check the matrices."""
        for name in "MCGKN":
            check_matrix(name, getattr(self, name), self.n, sign=-1 if name in "GN" else 1)

    def __repr__(self) -> str:
        """One line instead of the matrices."""
        counts = f"{len(self.layers)} layers, {len(self.bearings)} bearings, {len(self.loads)} loads"
        return f"<System of {self.n} coordinates, {counts}>"

    @property
    def n(self) -> int:
        """Number of coordinates."""
        return int(self.M.shape[0])

    @property
    def B(self) -> Array:
        """All bearings' coefficients, one under another, (coefs, n)."""
        return np.vstack([np.zeros((0, self.n)), *(b.B for b in self.bearings)])

    def rows(self, name: str) -> Array:
        """Rows (3 or 6, n) of an interface or output.

        Raises
        ------
        ValueError
            Where none has that name.
        """
        if name not in self.outputs:
            raise ValueError(f"{name!r} is no interface or output; {meant(name, self.outputs)}")
        return self.outputs[name]

    def row(self, channel: str | Channel) -> Array:
        """Row (n,) of one component: "shaft.left.y"; rotations are θx, θy, θz or rx, ry, rz.

        Raises
        ------
        ValueError
            Where the place or the component does not exist.
        """
        wanted = Channel.parse(channel) if isinstance(channel, str) else channel
        place = f"{wanted.site}.{wanted.component}"
        if place in self.outputs:
            raise ValueError(f"{place!r} is a place; add what of it is meant, as {place + '.y'!r}")
        rows = self.rows(wanted.site)
        if wanted.index is None or wanted.index >= rows.shape[0]:
            known = list(COMPONENTS[: rows.shape[0]])
            raise ValueError(f"{str(channel)!r}: {wanted.site} has {known}, not {wanted.component!r}")
        return np.asarray(rows[wanted.index])

    def check_speed(self, speed: float) -> None:
        """Refuse a speed at which the damping of a part would be wrong.

        Damping of material that turns acts on ẋ − Ω J x. Without its circulatory part, a whirl that it makes
        unstable would look damped.

        Raises
        ------
        ValueError
            For a speed (rad/s) that is not finite, and for any but 0 where the damping of a part that turns
            is known at rest only; names the part.
        """
        plausible("speed", "speed", speed, "it must be one finite number, in rad/s")
        for term in self.bearings:
            if isinstance(term.bearing, BallBearing):
                check_speed_value(f"bearing {term.name!r}: speed", speed, term.bearing.Dpw)
        if speed != 0.0 and self.standstill:
            raise ValueError(
                f"{self.standstill[0]!r} turns with the shaft, and its damping is known for a part at rest "
                f"only; put it outside the bearings, or compute at speed 0"
            )

    def static_load(self) -> Array:
        """Sum of the constant loads, (n,)."""
        return sum((p.p_cos for p in self.loads if p.kind == "constant"), np.zeros(self.n))

    def static_moduli(self, modulus: Modulus = "relaxed") -> list[float]:
        """Shear modulus of each layer, Pa, at "relaxed" G0, "instantaneous", or G(t) at a time t, s."""
        return [static_modulus(layer, modulus) for layer in self.layers]

    def stiffness(self, modulus: Modulus = "relaxed") -> Array:
        """K (n, n) with every layer at its "relaxed" modulus G0, its "instantaneous" one, or G(t), t in s.

        A sequence gives the modulus of each layer itself, Pa.
        """
        K = self.K.copy()
        moduli = modulus if isinstance(modulus, Sequence) and not isinstance(modulus, str) else None
        for G, layer in zip(moduli or self.static_moduli(modulus), self.layers, strict=True):
            K += 2.0 * G * (layer.L @ layer.L.T)
        return K

    def viscous(self) -> Array:
        """C with the parallel dashpots 2 η0 L Lᵀ of the layers, (n, n)."""
        C = self.C.copy()
        for layer in self.layers:
            C += 2.0 * getattr(layer.material, "eta0", 0.0) * (layer.L @ layer.L.T)
        return C

    def transformed(self, T: Array) -> System:
        """The same system in coordinates q, x = T q; T (n, m)."""

        def congruence(A: Array) -> Array:
            return np.asarray(T.T @ A @ T)

        return replace(
            self,
            M=congruence(self.M),
            C=congruence(self.C),
            G=congruence(self.G),
            K=congruence(self.K),
            N=congruence(self.N),
            layers=tuple(replace(t, L=T.T @ t.L) for t in self.layers),
            bearings=tuple(replace(t, B=t.B @ T) for t in self.bearings),
            loads=tuple(replace(t, p_cos=T.T @ t.p_cos, p_sin=T.T @ t.p_sin) for t in self.loads),
            outputs={name: rows @ T for name, rows in self.outputs.items()},
            inertia=None if self.inertia is None else T.T @ self.inertia,
            parts=tuple(replace(t, place=t.place @ T) for t in self.parts),
            springs=tuple(replace(t, across=t.across @ T) for t in self.springs),
        )

    def blocks(self) -> list[Index]:
        """Coordinates that the structure couples, its bearings left out, block by block."""
        touched = [np.abs(layer.L).sum(axis=1) for layer in self.layers]
        return coupled_blocks(self.M, self.C, self.G, self.K, self.N, *(np.outer(t, t) for t in touched))

    def basis(self, modulus: Modulus = "relaxed") -> tuple[Array, Array]:
        """ω² (n,) and modes T (n, n), x = T q, of the structure, its bearings left out, block by block."""
        K = self.stiffness(modulus)
        T = np.zeros((self.n, self.n))
        squares = np.zeros(self.n)
        for block in self.blocks():
            inside = np.ix_(block, block)
            squares[block], T[inside] = natural(K[inside], self.M[inside])
        return squares, T

    def modal(self) -> tuple[System, Array]:
        """The system in modes of its relaxed stiffness and mass, block by block, and T with x = T q.

        Layers that soften have there what their law leaves (`Maxwell.rest`).

        M is then exactly the identity and the relaxed stiffness exactly diagonal, as a long march needs.
        """
        moduli = self.marched_moduli()
        squares, T = self.basis(moduli)
        modal = self.transformed(T)
        relaxed = np.zeros((self.n, self.n))
        for G, layer in zip(moduli, modal.layers, strict=True):
            relaxed += 2.0 * G * (layer.L @ layer.L.T)
        # K + relaxed, formed again in `stiffness`, is diagonal to the last bit
        return replace(modal, M=np.eye(self.n), K=np.diag(squares) - relaxed), T

    def free_motions(self, modulus: str = "relaxed") -> Array:
        """Motions (n, m) that nothing holds, mass-normalised; bearings count as springs."""
        K = self.stiffness(modulus) + TEST_SPRING * (self.B.T @ self.B)
        squares, shapes = natural(K, self.M)
        return np.asarray(shapes[:, squares <= 0.0])

    def marched_moduli(self) -> list[float]:
        """Shear modulus, Pa, of each layer in a march: relaxed, or what a law of softening leaves."""
        return [
            static_modulus(layer, "relaxed") if layer.strain is None else layer.material.rest.G0
            for layer in self.layers
        ]

    def model(
        self,
        channels: list[tuple[int, Array | None, int, int]],
        relaxed: bool = True,
        memory: float | None = None,
    ) -> core.Model:
        """The core's model.

        Parameters
        ----------
        channels
            Kind, row (n,), bearing and index of what a march records.
        relaxed
            True, for a march: K holds the layers at their G0, and branches do the rest. False, for a
            harmonic response: the whole deviatoric stiffness is left to a modulus given per frequency.
        memory
            Time, s, over which layers that soften remember their amplitude; needed for their march.

        Raises
        ------
        ValueError
            Without a memory that is needed.
        """
        C = self.viscous() if relaxed else self.C
        K = self.stiffness(self.marched_moduli()) if relaxed else self.K
        empty = np.zeros(0)
        layers = [_marched(t, memory) if relaxed else (t.L, empty, empty) for t in self.layers]
        return core.Model(
            M=self.M,
            C=C,
            G=self.G,
            K=K,
            N=self.N,
            layers=layers,
            bearings=[(t.kernel().packed(), t.B) for t in self.bearings],
            loads=[(t.kind, t.omega, t.p_cos, t.p_sin, t.time, t.value) for t in self.loads],
            channels=channels,
        )


def _marched(layer: LayerTerm, memory: float | None) -> tuple[Any, ...]:
    """A layer as a march takes it: L, strengths and times of its branches, and how it softens."""
    if layer.strain is None:
        return layer.L, np.asarray(layer.material.G), np.asarray(layer.material.tau)
    if memory is None:
        raise ValueError(
            f"layer {layer.part!r} softens with its amplitude, and memory is None; give the time, s, over "
            f"which it remembers it: five periods of the slowest motion"
        )
    law, rest = layer.material.payne, layer.material.rest
    softening = (
        law.D,
        law.gamma_c,
        law.m,
        law.Lm,
        law.gamma_l,
        law.p,
        float(memory),
        layer.material.G0 - rest.G0,
        np.asarray(layer.strain),
        *rest.omega,
        np.stack([rest.misses.real, rest.misses.imag]),
    )
    return layer.L, rest.G, rest.tau, softening


def check_matrix(name: str, A: Array, n: int, sign: int) -> None:
    """Refuse A that is not (n, n), finite, and symmetric (sign 1) or skew-symmetric (sign −1): ValueError.

    Round-off of a congruence transformation, a share of the largest entry, is let through.
    """
    if A.shape != (n, n):
        raise ValueError(f"{name} has the shape {A.shape}; it must be {(n, n)}, as M")
    if not np.isfinite(A).all():
        i, j = np.argwhere(~np.isfinite(A))[0]
        raise ValueError(f"{name}[{i}, {j}] is {A[i, j]}; every entry must be finite")
    off = np.abs(A - sign * A.T)
    i, j = np.unravel_index(np.argmax(off), off.shape) if n else (0, 0)
    if n and off[i, j] > ASYMMETRY * np.abs(A).max():
        kind = "symmetric" if sign > 0 else "skew-symmetric"
        raise ValueError(
            f"{name}[{i}, {j}] is {A[i, j]:g} and {name}[{j}, {i}] is {A[j, i]:g}; {name} must be {kind}"
        )


def natural(K: Array, M: Array) -> tuple[Array, Array]:
    """ω² (n,) and mass-normalised shapes (n, n) of a symmetric (K, M); an ω² within round-off becomes zero.

    The ω² of a suspension at 1 Hz is 1e-12 of that of a layer's inner mode at 1 MHz. The slow modes are
    therefore solved for once more, among themselves.

    Raises
    ------
    ValueError
        For a mass matrix that is not positive definite.
    """
    try:
        squares, shapes = scipy.linalg.eigh(K, M)
    except np.linalg.LinAlgError:
        raise ValueError(
            "the mass matrix is not positive definite: a coordinate has no mass; give every body a mass and "
            "moments of inertia"
        ) from None
    slow = squares < SLOW * squares[-1]
    noise = np.zeros(len(squares))
    if slow.any():
        inner = shapes[:, slow].T @ K @ shapes[:, slow]
        squares[slow], turn = np.linalg.eigh(0.5 * (inner + inner.T))
        shapes[:, slow] = shapes[:, slow] @ turn
        noise[slow] = SLOW_ROUND_OFF * np.abs(squares[slow]).max()
    noise = np.maximum(noise, ROUND_OFF * np.sum(np.abs(shapes) * (np.abs(K) @ np.abs(shapes)), axis=0))
    squares[np.abs(squares) <= noise] = 0.0
    return squares, shapes


def factor(A: Array) -> Array:
    """L (n, rank) with A = L Lᵀ for a positive semi-definite A; directions within round-off are left out."""
    scale = np.sqrt(np.maximum(np.diag(A), 0.0))
    scale[scale == 0.0] = 1.0
    values, vectors = np.linalg.eigh(A / np.outer(scale, scale))
    keep = values > RANK * values[-1]
    return np.asarray(scale[:, None] * vectors[:, keep] * np.sqrt(values[keep]))


def softening_factor(term: Viscoelastic, part: str) -> tuple[Array, Array | None]:
    """L (n, rank) of a part's rubber, and the weights (rank,) of its coordinates Lᵀx in γ²; None without law.

    The strain that counts has the squares Σ (χ_i x_i …): with the concentration χ of each coordinate,
    γ² = 2 (χx)ᵀ H (χx)/V. L is turned so that both forms are diagonal.

    Raises
    ------
    ValueError
        For a law of softening on rubber whose volume is not known.
    """
    L = factor(term.H)
    if getattr(term.material, "payne", None) is None:
        return L, None
    if term.volume is None:
        raise ValueError(
            f"part {part!r} has a law of softening (payne), and the volume of its rubber is not known: give "
            f"Viscoelastic(material, H, volume=...), or the material without: material.with_payne(None)"
        )
    if term.concentration is None:
        return L, np.full(L.shape[1], 2.0 / term.volume)
    # rigid motion stays rigid when scaled, so that χL = L Qᵀ
    Q = (np.linalg.pinv(L) @ (term.concentration[:, None] * L)).T
    weights, turn = np.linalg.eigh(Q.T @ Q)
    return L @ turn, 2.0 / term.volume * np.maximum(weights, 0.0)


def static_modulus(layer: LayerTerm, modulus: Modulus) -> float:
    """The "relaxed" or "instantaneous" shear modulus of a layer, or G(t), Pa; ValueError for another word."""
    if not isinstance(layer.material, Maxwell):
        raise ValueError(
            f"layer {layer.part!r} has the material {type(layer.material).__name__}; statics and the time "
            f"domain need a Maxwell model: fit one with fit_maxwell"
        )
    if isinstance(modulus, float):
        return float(layer.material.relaxation(modulus))
    if modulus == "relaxed":
        return float(layer.material.G0)
    if modulus == "instantaneous":
        return float(layer.material.G_instantaneous)
    raise ValueError(f'modulus is {modulus!r}; it must be "relaxed" or "instantaneous"')
