"""The system: an application as plain arrays, ready for the C core.

    M ẍ + (C + Ω G) ẋ + (K + Ω N) x + Σ 2 [G*] L Lᵀ x + Bᵀ g(B x) = f(t)

Layers are kept apart by a factor of their deviatoric matrix, H = L Lᵀ (paper (16), (25)): their modulus is a
property of time or frequency, not of the matrices.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import scipy.linalg
from numpy.typing import NDArray

from bearingdyn import core
from bearingdyn.application import COMPONENTS, GROUND, Application
from bearingdyn.bearing import BallBearing
from bearingdyn.cms import coupled_blocks
from bearingdyn.material import Maxwell

Array = NDArray[np.float64]

QUANTITIES = ("displacement", "velocity", "acceleration")
ALIASES = {"rx": "θx", "ry": "θy", "rz": "θz"}
# below this share of the largest (scaled) eigenvalue a deviatoric matrix has no strain: its rigid motions
RANK = 1e-11
# below this share of the largest eigenvalue of (K, M) its round-off may hide a slow mode
SLOW = 1e-6
# round-off left in φᵀKφ, as a share of |φ|ᵀ|K||φ|, and in the slow modes, as a share of the fastest of them
ROUND_OFF, SLOW_ROUND_OFF = 1e-12, 1e-13
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
    """One bearing: B (n_coefs, n) gives its relative raceway coefficients, inner minus outer."""

    name: str
    bearing: BallBearing
    B: Array


@dataclass(frozen=True, eq=False)
class LoadTerm:
    """One load: kind as in bearingdyn.core.LOAD_KINDS, columns (n,), table for a sampled one."""

    kind: str
    omega: float
    p_cos: Array
    p_sin: Array
    time: Array
    value: Array


@dataclass(frozen=True, eq=False)
class System:
    """Matrices (n, n), terms, and rows (3 or 6, n) of every interface and point by name."""

    M: Array
    C: Array
    K: Array
    G: Array
    N: Array
    layers: tuple[LayerTerm, ...]
    bearings: tuple[BearingTerm, ...]
    loads: tuple[LoadTerm, ...]
    outputs: Mapping[str, Array]

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
            raise ValueError(f"{name!r} is no interface or point; there are {sorted(self.outputs)}")
        return self.outputs[name]

    def row(self, channel: str) -> Array:
        """Row (n,) of one component: "shaft.left.y"; rotations are θx, θy, θz or rx, ry, rz.

        Raises ValueError when the place or component does not exist.
        """
        place, _, component = channel.rpartition(".")
        rows = self.rows(place)
        component = ALIASES.get(component, component)
        if component not in COMPONENTS[: rows.shape[0]]:
            raise ValueError(
                f"{channel!r}: {place} has {list(COMPONENTS[: rows.shape[0]])}, not {component!r}"
            )
        return np.asarray(rows[COMPONENTS.index(component)])

    def static_load(self) -> Array:
        """Sum of the constant loads, (n,)."""
        return sum((p.p_cos for p in self.loads if p.kind == "constant"), np.zeros(self.n))

    def stiffness(self, modulus: str = "relaxed") -> Array:
        """K with every layer at its "relaxed" modulus G0 or its "instantaneous" one, (n, n)."""
        K = self.K.copy()
        for layer in self.layers:
            G = _static_modulus(layer, modulus)
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
        )

    def blocks(self) -> list[NDArray[np.intp]]:
        """Coordinates that the structure without its bearings couples, block by block."""
        touched = [np.abs(layer.L).sum(axis=1) for layer in self.layers]
        return coupled_blocks(self.M, self.C, self.K, self.G, self.N, *(np.outer(t, t) for t in touched))

    def modal(self) -> tuple[System, Array]:
        """The system in modes of its relaxed stiffness and mass, block by block, and T with x = T q.

        M is then exactly the identity and the relaxed stiffness exactly diagonal, which a long march wants.
        """
        K = self.stiffness()
        T = np.zeros((self.n, self.n))
        squares = np.zeros(self.n)
        for block in self.blocks():
            inside = np.ix_(block, block)
            squares[block], T[inside] = _natural(K[inside], self.M[inside])
        modal = self.transformed(T)
        relaxed = np.zeros((self.n, self.n))
        for layer in modal.layers:
            relaxed += 2.0 * _static_modulus(layer, "relaxed") * (layer.L @ layer.L.T)
        # K + relaxed, formed again in `stiffness`, is diagonal to the last bit
        return replace(modal, M=np.eye(self.n), K=np.diag(squares) - relaxed), T

    def free_motions(self, modulus: str = "relaxed") -> Array:
        """Motions (n, m) that nothing holds, bearings counted as springs, mass-normalised."""
        K = self.stiffness(modulus) + TEST_SPRING * (self.B.T @ self.B)
        squares, shapes = _natural(K, self.M)
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
            [(core.kernel_tuple(t.bearing.kernel()), t.B) for t in self.bearings],
            [(core.LOAD_KINDS[t.kind], t.omega, t.p_cos, t.p_sin, t.time, t.value) for t in self.loads],
            channels,
        )


def _natural(K: Array, M: Array) -> tuple[Array, Array]:
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


def is_rotation(channel: str) -> bool:
    """Whether a channel "place.component" is a rotation."""
    component = channel.rpartition(".")[2]
    return ALIASES.get(component, component) in COMPONENTS[3:]


def _static_modulus(layer: LayerTerm, modulus: str) -> float:
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


def _factor(H: Array) -> Array:
    """L (n, rank) with H = L Lᵀ, rigid motions left out."""
    scale = np.sqrt(np.diag(H))
    scale[scale == 0.0] = 1.0
    values, vectors = np.linalg.eigh(H / np.outer(scale, scale))
    keep = values > RANK * values[-1]
    return np.asarray(scale[:, None] * vectors[:, keep] * np.sqrt(values[keep]))


def _coordinates(app: Application) -> tuple[dict[str, NDArray[np.intp]], int]:
    """Global index of every part's coordinates (-1: held by the ground), and how many there are."""
    local = {name: np.full(element.n, -2, dtype=np.intp) for name, element in app.parts.items()}

    def places(interface: str) -> tuple[str, NDArray[np.intp]]:
        part, _, name = interface.partition(".")
        return part, app.parts[part].interfaces[name]

    partner = {c.a: c.b for c in app.connections} | {c.b: c.a for c in app.connections}
    for support in app.supports.values():
        if support.rigid:
            for interface in (support.interface, partner.get(support.interface)):
                if interface is not None:
                    part, index = places(interface)
                    local[part][index] = -1
    count = 0
    for part, element in app.parts.items():
        for name, index in element.interfaces.items():
            other = partner.get(f"{part}.{name}")
            if local[part][index[0]] == -2 and other is not None:
                other_part, other_index = places(other)
                if local[other_part][other_index[0]] >= 0:
                    local[part][index] = local[other_part][other_index]
        for i in range(element.n):
            if local[part][i] == -2:
                local[part][i] = count
                count += 1
    return local, count


def assemble(app: Application) -> System:
    """An application as arrays.

    Raises ValueError for an interface left loose, a body that nothing holds (named, with its direction), a
    dead load on a layer without relaxed modulus.
    """
    app.check_joints()
    index, n = _coordinates(app)
    if n == 0:
        raise ValueError("everything is grounded rigidly; nothing is left to move")

    select = {}  # part coordinates = select @ system coordinates
    for part, place in index.items():
        select[part] = np.zeros((place.size, n))
        moving = np.flatnonzero(place >= 0)
        select[part][moving, place[moving]] = 1.0

    M, C, K, G, N, firm = (np.zeros((n, n)) for _ in range(6))
    layers: list[LayerTerm] = []
    outputs: dict[str, Array] = {}
    for part, element in app.parts.items():
        own = (element.M, element.C, element.K, element.G, element.N)
        for total, A in zip((M, C, K, G, N), own, strict=True):
            total += select[part].T @ np.asarray(A) @ select[part]
        for term in element.viscoelastic:
            layers.append(LayerTerm(part, term.material, select[part].T @ _factor(term.H)))
        relaxed = [getattr(term.material, "G0", 0.0) for term in element.viscoelastic]
        if all(relaxed):
            deviatoric = (2.0 * G0 * t.H for G0, t in zip(relaxed, element.viscoelastic, strict=True))
            firm += select[part].T @ sum(deviatoric, np.asarray(element.K)) @ select[part]
        for name in (*element.interfaces, *element.outputs):
            outputs[f"{part}.{name}"] = element.rows(name) @ select[part]

    for support in app.supports.values():
        rows = outputs[support.interface]
        for total, values in ((K, support.stiffness), (firm, support.stiffness), (C, support.damping)):
            if values is not None:
                total += rows.T @ (values[:, None] * rows)

    bearings = []
    for hung in app.bearings.values():
        relative = outputs[hung.inner] - (outputs[hung.outer] if hung.outer != GROUND else 0.0)
        bearings.append(BearingTerm(hung.name, hung.bearing, hung.bearing.coefficients() @ relative))

    system = System(M, C, K, G, N, tuple(layers), tuple(bearings), _loads(app, outputs), outputs)
    _check_held(system, firm)
    return system


def _loads(app: Application, outputs: Mapping[str, Array]) -> tuple[LoadTerm, ...]:
    terms = []
    nothing = np.zeros(0)
    for load in app.loads:
        rows = outputs[load.where]
        force = load.vector[: rows.shape[0]] @ rows
        zero = np.zeros_like(force)
        c, s = math.cos(load.phase), math.sin(load.phase)
        if load.kind == "harmonic":
            terms.append(LoadTerm("harmonic", load.omega, c * force, -s * force, nothing, nothing))
        elif load.kind == "rotating":
            # u (cos(θ + φ), sin(θ + φ)) = cos θ · u (c, s) + sin θ · u (−s, c)
            along, across = c * rows[0] + s * rows[1], -s * rows[0] + c * rows[1]
            u = load.unbalance
            terms.append(LoadTerm("rotating", 0.0, u * along, u * across, nothing, nothing))
        elif load.kind == "sampled":
            assert load.time is not None
            assert load.value is not None
            terms.append(LoadTerm("sampled", 0.0, force, zero, load.time, load.value))
        else:
            terms.append(LoadTerm("constant", 0.0, force, zero, nothing, nothing))
    return tuple(terms)


def _check_held(system: System, firm: Array) -> None:
    """Nothing may be free to move but the spin of what the bearings carry.

    firm: (n, n) stiffness without the parts that creep (G0 = 0); under a constant load it alone counts.
    """
    unsupported = np.flatnonzero(np.diag(system.M) <= 0.0)
    if unsupported.size:
        raise ValueError(
            f"{unsupported.size} coordinates have no mass (first: {_describe(system, int(unsupported[0]))}); "
            f"give every body a mass and moments of inertia"
        )
    load = system.static_load()
    if not system.bearings and not load.any():
        return  # a free body may be analysed as such: its rigid modes are its answer
    free = system.free_motions("instantaneous")
    if free.shape[1] == 0:
        _check_creep(system, firm, free)
        return
    sites = [(name, rows) for name, rows in system.outputs.items() if rows.shape[0] == 6]
    moving = np.vstack([rows[:5] @ free for _, rows in sites])
    spin = np.vstack([rows[5] @ free for _, rows in sites])
    strengths = np.linalg.svd(moving, compute_uv=False)
    directions = np.linalg.svd(moving)[2]
    if strengths[0] > 1e-6 * max(float(np.abs(spin).max()), strengths[0] * 1e-3):
        motion = free @ directions[0]
        name, component = max(
            ((name, k) for name, rows in sites for k in range(5)),
            key=lambda site: abs(float(dict(sites)[site[0]][site[1]] @ motion)),
        )
        raise ValueError(
            f"{name.partition('.')[0]!r} is free to move in {COMPONENTS[component]} (seen at {name}); "
            f"connect it, ground it or carry it by a bearing"
        )
    torque = free.T @ load
    if np.abs(torque).max() > 1e-9 * max(1.0, float(np.abs(load).max())):
        raise ValueError(
            "a constant load turns a shaft about z, where its bearings do not hold it; "
            "ground that rotation or leave the torque out"
        )
    _check_creep(system, firm, free)


def _check_creep(system: System, firm: Array, free: Array) -> None:
    """A constant load may not rest on a layer without relaxed modulus.

    In such a layer the reduced shapes still resist a change of volume; the rubber itself would flow.
    """
    soft = [t.part for t in system.layers if _static_modulus(t, "relaxed") == 0.0]
    load = system.static_load()
    if not soft or not load.any():
        return
    squares, shapes = _natural(firm + TEST_SPRING * (system.B.T @ system.B), system.M)
    creeping = shapes[:, squares <= 0.0]
    creeping = creeping - free @ (free.T @ (system.M @ creeping))
    if np.abs(creeping.T @ load).max(initial=0.0) > 1e-9 * float(np.abs(shapes.T @ load).max()):
        raise ValueError(
            f"layer {soft[0]!r} has G0 = 0: it creeps without end under a constant load and there is no "
            f"equilibrium; fit the material with a relaxed modulus G0 > 0"
        )


def _describe(system: System, coordinate: int) -> str:
    for name, rows in system.outputs.items():
        for k, row in enumerate(rows):
            if row[coordinate] != 0.0:
                return f"{name}.{COMPONENTS[k]}"
    return f"coordinate {coordinate}"
