"""The system: an application as plain arrays, ready for the C core.

    M ẍ + (C + Ω G) ẋ + (K + Ω N) x + Σ 2 [G*] L Lᵀ x + Bᵀ g(B x) = f(t)

Layers are kept apart by a factor of their deviatoric matrix, H = L Lᵀ (paper (16), (25)): their modulus is a
property of time or frequency, not of the matrices.
"""

from __future__ import annotations

import difflib
import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
import scipy.linalg

from bearingdyn import core
from bearingdyn.application import COMPONENTS, Part
from bearingdyn.bearing import BallBearing, BearingKernel, LooseFit
from bearingdyn.bearing.raceway_series import RIGID, RacewaySeries
from bearingdyn.cms import Superelement, coupled_blocks
from bearingdyn.material import Maxwell
from bearingdyn.types import Array, Index

# of a motion; the order is the number of derivatives
QUANTITIES = ("displacement", "velocity", "acceleration")
RATES = dict(zip(QUANTITIES, ("", "/s", "/s²"), strict=True))
ALIASES = {"rx": "θx", "ry": "θy", "rz": "θz"}
# below this share of the largest eigenvalue of (K, M) its round-off may hide a slow mode
SLOW = 1e-6
# round-off left in φᵀKφ, as a share of |φ|ᵀ|K||φ|, and in the slow modes, as a share of the fastest of them
ROUND_OFF, SLOW_ROUND_OFF = 1e-12, 1e-13
# below this share of the largest (scaled) eigenvalue a matrix has none: rigid motions of a deviatoric one
RANK = 1e-11
# a test spring in N/m that stands for a bearing when free motions are sought: any stiff value serves
TEST_SPRING = 1e8


@dataclass(frozen=True, eq=False)
class LayerTerm:
    """One viscoelastic material of one part: its deviatoric stiffness is 2 G*(ω) L Lᵀ, L (n, rank)."""

    part: str
    material: Any
    L: Array


@dataclass(frozen=True, eq=False)
class BearingTerm:
    """One bearing or loose fit: B (n_coefs, n) gives its relative coefficients, inner minus outer.

    offset: m along z that the inner ring sits beyond the motion B x. ends: rows (n_coefs, 6) of the interface
    at each end.
    """

    name: str
    bearing: BallBearing | LooseFit
    B: Array
    series: RacewaySeries = RIGID
    offset: float = 0.0
    ends: Mapping[str, Array] = field(default_factory=dict)

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
    """One part: its own coordinates are place @ x, place (m, n).

    rigid (m, 6): its coordinates in unit rigid motions x, y, z, θx, θy, θz of its first interface; NaN where
    it holds itself. source: what it was reduced from.
    """

    name: str
    element: Superelement
    place: Array
    rigid: Array
    source: Part


@dataclass(frozen=True, eq=False)
class SpringTerm:
    """Springs and dampers (k,), N/m and N s/m, on the motion across @ x, across (k, n).

    ends: rows (k, 6) of the interface at each end.
    """

    name: str
    across: Array
    stiffness: Array
    damping: Array
    ends: Mapping[str, Array] = field(default_factory=dict)


@dataclass(frozen=True, eq=False)
class LoadTerm:
    """One load: kind as in bearingdyn.core.LOAD_KINDS, columns (n,), table for a sampled one.

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


@dataclass(frozen=True, eq=False)
class System:
    """Matrices (n, n), terms, and rows (3 or 6, n) of every interface and point by name."""

    inputs: str = field(default="", kw_only=True)
    """What the system was assembled from, as `bearingdyn.inputs` writes it."""
    M: Array
    C: Array
    K: Array
    G: Array
    N: Array
    layers: tuple[LayerTerm, ...]
    bearings: tuple[BearingTerm, ...]
    loads: tuple[LoadTerm, ...]
    outputs: Mapping[str, Array]
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
    """Where interfaces and points stand, (3,) m, from the first interface of the first part."""

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
        """Rows (3 or 6, n) of an interface or point.

        Raises ValueError when there is none of that name.
        """
        if name not in self.outputs:
            near = difflib.get_close_matches(name, self.outputs, n=1)
            meant = f"; did you mean {near[0]!r}?" if near else ";"
            raise ValueError(f"{name!r} is no interface or point{meant} there are {sorted(self.outputs)}")
        return self.outputs[name]

    def row(self, channel: str) -> Array:
        """Row (n,) of one component: "shaft.left.y"; rotations are θx, θy, θz or rx, ry, rz.

        Raises ValueError when the place or component does not exist.
        """
        if channel in self.outputs:
            raise ValueError(f"{channel!r} is a place; add what of it is meant, as {channel + '.y'!r}")
        place = channel.rpartition(".")[0]
        rows = self.rows(place)
        component = component_of(channel)
        if component not in COMPONENTS[: rows.shape[0]]:
            raise ValueError(
                f"{channel!r}: {place} has {list(COMPONENTS[: rows.shape[0]])}, not {component!r}"
            )
        return np.asarray(rows[COMPONENTS.index(component)])

    def check_speed(self, speed: float) -> None:
        """Refuse a speed (rad/s) that is not finite, or at which a part's damping would be wrong: ValueError.

        Damping of material that turns acts on ẋ − Ω J x; without its circulatory part a whirl that it drives
        unstable would look damped.
        """
        if not math.isfinite(speed):
            raise ValueError(f"speed is {speed}; it must be finite, in rad/s")
        if speed != 0.0 and self.standstill:
            raise ValueError(
                f"{self.standstill[0]!r} turns with the shaft, and its damping is known for a part at rest "
                f"only; put it outside the bearings, or compute at speed 0"
            )

    def static_load(self) -> Array:
        """Sum of the constant loads, (n,)."""
        return sum((p.p_cos for p in self.loads if p.kind == "constant"), np.zeros(self.n))

    def stiffness(self, modulus: str = "relaxed") -> Array:
        """K with every layer at its "relaxed" modulus G0 or its "instantaneous" one, (n, n)."""
        K = self.K.copy()
        for layer in self.layers:
            G = static_modulus(layer, modulus)
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
            K=congruence(self.K),
            G=congruence(self.G),
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
        """Coordinates that the structure without its bearings couples, block by block."""
        touched = [np.abs(layer.L).sum(axis=1) for layer in self.layers]
        return coupled_blocks(self.M, self.C, self.K, self.G, self.N, *(np.outer(t, t) for t in touched))

    def basis(self, modulus: str = "relaxed") -> tuple[Array, Array]:
        """ω² (n,) and modes T (n, n), x = T q, of the structure without its bearings, block by block."""
        K = self.stiffness(modulus)
        T = np.zeros((self.n, self.n))
        squares = np.zeros(self.n)
        for block in self.blocks():
            inside = np.ix_(block, block)
            squares[block], T[inside] = natural(K[inside], self.M[inside])
        return squares, T

    def modal(self) -> tuple[System, Array]:
        """The system in modes of its relaxed stiffness and mass, block by block, and T with x = T q.

        M is then exactly the identity and the relaxed stiffness exactly diagonal, which a long march wants.
        """
        squares, T = self.basis()
        modal = self.transformed(T)
        relaxed = np.zeros((self.n, self.n))
        for layer in modal.layers:
            relaxed += 2.0 * static_modulus(layer, "relaxed") * (layer.L @ layer.L.T)
        # K + relaxed, formed again in `stiffness`, is diagonal to the last bit
        return replace(modal, M=np.eye(self.n), K=np.diag(squares) - relaxed), T

    def free_motions(self, modulus: str = "relaxed") -> Array:
        """Motions (n, m) that nothing holds, bearings counted as springs, mass-normalised."""
        K = self.stiffness(modulus) + TEST_SPRING * (self.B.T @ self.B)
        squares, shapes = natural(K, self.M)
        return np.asarray(shapes[:, squares <= 0.0])

    def model(self, channels: list[tuple[int, Array | None, int, int]], relaxed: bool = True) -> core.Model:
        """The core's model. With `relaxed`, layers carry G0 inside K, as the march wants; else K leaves all
        of their deviatoric part to a modulus given per frequency."""
        C = self.viscous() if relaxed else self.C
        K = self.stiffness("relaxed") if relaxed else self.K
        empty = np.zeros(0)
        layers = [
            (t.L, np.asarray(t.material.G), np.asarray(t.material.tau)) if relaxed else (t.L, empty, empty)
            for t in self.layers
        ]
        return core.Model(
            self.M,
            C,
            self.G,
            K,
            self.N,
            layers,
            [(core.kernel_tuple(t.kernel()), t.B) for t in self.bearings],
            [(core.LOAD_KINDS[t.kind], t.omega, t.p_cos, t.p_sin, t.time, t.value) for t in self.loads],
            channels,
        )


def natural(K: Array, M: Array) -> tuple[Array, Array]:
    """ω² (n,) and mass-normalised shapes (n, n) of a symmetric (K, M); what is only round-off is zero.

    A suspension of 1 Hz beside a layer's inner mode of 1 MHz is 1e-12 of it: the slow modes are therefore
    solved for again, among themselves.

    Raises ValueError for a mass matrix that is not positive definite.
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
    """L (n, rank) with A = L Lᵀ of a positive semi-definite matrix, what is only round-off left out."""
    scale = np.sqrt(np.maximum(np.diag(A), 0.0))
    scale[scale == 0.0] = 1.0
    values, vectors = np.linalg.eigh(A / np.outer(scale, scale))
    keep = values > RANK * values[-1]
    return np.asarray(scale[:, None] * vectors[:, keep] * np.sqrt(values[keep]))


def component_of(channel: str) -> str:
    """Component of a channel "place.component": rx, ry, rz are θx, θy, θz."""
    component = channel.rpartition(".")[2]
    return ALIASES.get(component, component)


def is_rotation(channel: str) -> bool:
    """Whether a channel "place.component" is a rotation."""
    return component_of(channel) in COMPONENTS[3:]


def static_modulus(layer: LayerTerm, modulus: str) -> float:
    if not isinstance(layer.material, Maxwell):
        raise ValueError(
            f"layer {layer.part!r} has the material {type(layer.material).__name__}; statics and the time "
            f"domain need a Maxwell model: fit one with fit_maxwell"
        )
    if modulus == "relaxed":
        return float(layer.material.G0)
    if modulus == "instantaneous":
        return float(layer.material.G_instantaneous)
    raise ValueError(f'modulus is {modulus!r}; it must be "relaxed" or "instantaneous"')
