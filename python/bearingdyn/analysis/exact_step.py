"""The exact step: the linear part's own motion over one step, prepared for the core (csrc/exact.c).

In modes of the relaxed structure (System.modal), scaled so that energy is a plain sum of squares,

    ξ' = w v,   v' = −w ξ − (C + Ω G) v − Ω N ξ/w − Σ L √(2G) σ − Bᵀ g + f,   σ' = √(2G) Lᵀ v − σ/τ

is a skew matrix and what dissipates. Its modes are well conditioned; in them a step is one factor each.
What nothing holds (w = 0) has no ξ: its displacement is the integral of its velocity, kept beside the modes,
so that no double root arises.

The bearing forces g are polynomials through the ends of the last steps: `held_forces`.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import scipy.linalg

from bearingdyn.analysis.held_forces import phi, rows_of, weights_of
from bearingdyn.system import System
from bearingdyn.types import Array, Complex, Index

LANES = 8  # to which the core pads (bearingdyn.h)
WORST = 1e8  # condition of modes; so many digits of sixteen may cancel
NODES = np.polynomial.legendre.leggauss(64)  # enough for 40 rad of a mode within a step
SKEW = 1e-13  # of the largest entry: below it a matrix is skew but for round-off
BY_NUMBER = ("Z", "X", "V", "A", "S")  # arrays with a row for each number of a state


def _padded(n: int) -> int:
    return -(-n // LANES) * LANES


@dataclass(frozen=True, eq=False)
class _Group:
    """Modes of coordinates that the structure couples.

    Attributes
    ----------
    block
        Its coordinates.
    loose
        Those of them that nothing holds.
    roots
        (j,) real ones first, then one of each pair.
    shapes
        (k, j) of the scaled motion, and `inverse` (j, k); of a pair the motion is 2 Re.
    reals
        How many are real.
    """

    block: Index
    loose: Index
    roots: Complex
    shapes: Complex
    inverse: Complex
    reals: int

    @property
    def sizes(self) -> tuple[int, int, int]:
        """Doubles of real modes, of one part of the pairs, of loose coordinates."""
        return _padded(self.reals), _padded(len(self.roots) - self.reals), _padded(len(self.loose))

    @property
    def modes(self) -> int:
        """Doubles of its modes."""
        real, pairs, _ = self.sizes
        return real + 2 * pairs

    @property
    def width(self) -> int:
        """Doubles of all of it."""
        return self.modes + self.sizes[2]

    def split(self, values: Complex) -> Array:
        """Values (…, j) of modes as the core keeps them (…, k): real ones, real parts, imaginary parts."""
        real, pairs, loose = self.sizes
        r = self.reals
        out = np.zeros((*values.shape[:-1], real + 2 * pairs + loose))
        out[..., :r] = values[..., :r].real
        rest = values[..., r:]
        out[..., real : real + rest.shape[-1]] = rest.real
        out[..., real + pairs : real + pairs + rest.shape[-1]] = rest.imag
        return out

    def seen(self, rows: Complex) -> Array:
        """What real rows, given on the modes (…, j), read of the core's numbers: 2 Re of a pair."""
        weights = np.where(np.arange(len(self.roots)) < self.reals, 1.0, 2.0)
        return self.split(np.conj(rows) * weights)


@dataclass(frozen=True, eq=False)
class ExactModes:
    """Modes of a system's linear part at one speed, and what they make of a step.

    Attributes
    ----------
    system
        In modes of its relaxed structure (`System.modal`).
    speed
        rad/s of the shaft.
    squares
        ω² (n,) of those, layers relaxed.
    groups
        Modes of what the structure couples, with velocities, gyroscopic forces and branches.
    """

    system: System
    speed: float
    squares: Array
    groups: tuple[_Group, ...]

    @classmethod
    def of(cls, system: System, speed: float) -> ExactModes:
        """The modes of a system, in modes of its relaxed structure, at one speed, rad/s.

        Raises
        ------
        ValueError
            Where modes of layers and structure fall together so closely that they cannot be told apart.
        """
        squares = np.diag(system.stiffness(system.marched_moduli()))
        return cls(
            system, speed, squares, tuple(_modes_of(system, b, squares, speed) for b in system.blocks())
        )

    def start(self, x: Array, v: Array, stress: Array) -> Array:
        """Numbers (k,) of a state: x, v (n,), and what the branches bear, layer by layer."""
        system, groups, at = self.system, self.groups, 0
        # σ = stress/√(2G), by block
        scaled: list[list[Array]] = [[np.zeros(0)] for _ in groups]
        for layer in system.layers:
            rank = layer.L.shape[1]
            for G in layer.material.G:
                for own, group in zip(scaled, groups, strict=True):
                    if np.abs(layer.L[group.block]).max(initial=0.0) > 0:
                        own.append(stress[at : at + rank] / math.sqrt(2 * G))
                at += rank
        starts = (
            _start(g, self.squares, x, v, np.concatenate(own)) for g, own in zip(groups, scaled, strict=True)
        )
        return np.concatenate([np.zeros(0), *starts])

    def step(self, dt: float, hold: int) -> dict[str, Array]:
        """What the core needs for steps of size dt, s, with forces of an order: arrays of bd_exact_data."""
        system, n, m = self.system, self.system.n, len(self.system.B)
        widths = [g.width for g in self.groups]
        total = sum(widths)
        starts = np.cumsum([0, *(t.L.shape[1] * len(t.material.G) for t in system.layers)])
        count = 1 + sum(order + 1 for order in range(1, hold + 1))
        out = {
            "roots": np.zeros((1, total)),
            "weights": np.zeros((count, total)),
            "P": np.zeros((m, total)),
            "Z": np.zeros((total, 2 * m)),
            "load": np.zeros((2 * len(system.loads), total)),
            "X": np.zeros((total, n)),
            "V": np.zeros((total, n)),
            "A": np.zeros((total, n)),
            "S": np.zeros((total, int(starts[-1]))),
        }
        loose, joined, at = [np.zeros((count, 0))], np.zeros((hold, 2, m, m)), 0
        for group, width in zip(self.groups, widths, strict=True):
            here = slice(at, at + width)
            at += width
            parts = {k: v[here] if k in BY_NUMBER else v[:, here] for k, v in out.items()}
            parts["roots"][:] = group.split(group.roots)
            parts["weights"][:] = group.split(weights_of(group.roots, dt, hold, 0))
            _place_motion(system, group, self.squares, parts, starts)
            _place_loads(system, group, self.squares, parts["load"], self.speed, dt)
            rows = _loose_rows(group, self.squares, dt, hold)
            _join(group, parts, rows, joined)
            loose.append(rows.reshape(count, -1))
        return {
            **out,
            "roots": out["roots"][0],
            "table": np.array([g.sizes for g in self.groups], dtype=np.float64),
            "loose": np.concatenate(loose, axis=1),
            "W": -joined.reshape(2 * hold, m * m),
        }


def _modes_of(system: System, block: Index, squares: Array, speed: float) -> _Group:
    """Modes of one block."""
    n = len(block)
    held = squares[block] > 0
    w = np.sqrt(np.where(held, squares[block], 0.0))
    e = np.flatnonzero(held)
    inside = np.ix_(block, block)
    C = system.viscous()[inside] + speed * system.G[inside]
    N = speed * system.N[inside]
    if np.abs(N[:, ~held]).max(initial=0.0) > 1e-9 * np.abs(N).max(initial=0.0):
        raise ValueError(
            "method is 'exact', and damping that turns drives a motion that nothing holds; take 'newmark'"
        )
    layers = [t for t in system.layers if np.abs(t.L[block]).max(initial=0.0) > 0]
    strength = [np.sqrt(2 * g) * t.L[block] for t in layers for g in t.material.G]
    rate = [np.full(t.L.shape[1], 1 / tau) for t in layers for tau in t.material.tau]
    S = np.hstack([np.zeros((n, 0)), *strength])
    size = len(e) + n + S.shape[1]
    v = slice(len(e), len(e) + n)
    A = np.zeros((size, size))
    A[np.arange(len(e)), len(e) + e] = w[e]
    A[v, : len(e)] = -N[:, e] / w[e]
    A[len(e) + e, np.arange(len(e))] -= w[e]
    A[v, v] = -C
    A[v, len(e) + n :] = -S
    A[len(e) + n :, v] = S.T
    A[np.arange(len(e) + n, size), np.arange(len(e) + n, size)] = -np.concatenate([np.zeros(0), *rate])
    if np.abs(A + A.T).max() <= SKEW * np.abs(A).max():
        roots, shapes, reals = _skew_modes(A)
    else:
        roots, shapes, reals = _damped_modes(A)
    whole = np.hstack([shapes, np.conj(shapes[:, reals:])])
    condition = np.linalg.cond(whole)
    if not condition < WORST:
        raise ValueError(
            f"method is 'exact', and modes of the linear part fall together (condition {condition:.2g}); "
            f"change the speed a little, or take method='newmark'"
        )
    inverse = np.linalg.inv(whole)[: shapes.shape[1]]
    return _Group(block, block[~held], roots, shapes, inverse, reals)


def _skew_modes(A: Array) -> tuple[Complex, Complex, int]:
    """Roots, exactly on the imaginary axis, and orthonormal modes of a skew matrix: energy then stays."""
    T, Q = scipy.linalg.schur(0.5 * (A - A.T))
    reals, pairs, k = [], [], 0
    while k < len(A):
        if k + 1 < len(A) and abs(T[k, k + 1]) > SKEW * np.abs(A).max():
            pairs.append((0.5 * (T[k, k + 1] - T[k + 1, k]), Q[:, k], Q[:, k + 1]))
            k += 2
        else:
            reals.append(Q[:, k])
            k += 1
    # A (q1 + i q2) = (−b q2 + i b q1) = i b (q1 + i q2)
    roots = np.concatenate([np.zeros(len(reals)), [1j * b for b, _, _ in pairs]]).astype(np.complex128)
    columns = [*reals, *(q1 + 1j * q2 for _, q1, q2 in pairs)]
    return roots, np.array(columns, dtype=np.complex128).T.reshape(len(A), -1), len(reals)


def _damped_modes(A: Array) -> tuple[Complex, Complex, int]:
    """Roots and modes of a real matrix: the real ones, then one of each pair."""
    roots, shapes = scipy.linalg.eig(A)
    real, upper = np.flatnonzero(roots.imag == 0), np.flatnonzero(roots.imag > 0)
    order = np.concatenate([real, upper])
    return roots[order], shapes[:, order].astype(np.complex128), len(real)


def _forced(roots: Complex, omega: float, dt: float) -> tuple[Complex, Complex]:
    """∫₀ʰ exp(λ(h − s)) exp(iωs) ds of each root, and of that the integral over time, (j,) each."""
    one = np.exp(1j * omega * dt) * dt * phi((roots - 1j * omega) * dt, 1)[1]
    s, share = 0.5 * dt * (NODES[0] + 1), 0.5 * dt * NODES[1]
    left = dt - s
    two = (phi(roots[:, None] * left, 1)[1] * left * np.exp(1j * omega * s)) @ share
    return one, two


def _motions(group: _Group, squares: Array) -> tuple[Complex, Complex, Complex]:
    """Displacement and velocity (n, j) of the modes, and what forces on coordinates put into them (j, n)."""
    n, held = len(group.block), squares[group.block] > 0
    e = int(held.sum())
    position = np.zeros((n, len(group.roots)), dtype=np.complex128)
    position[held] = group.shapes[:e] / np.sqrt(squares[group.block][held])[:, None]
    return position, group.shapes[e : e + n], group.inverse[:, e : e + n]


def _start(group: _Group, squares: Array, x: Array, v: Array, branches: Array) -> Array:
    """Numbers of a group at x, v (n,), with its branches' σ."""
    held = squares[group.block] > 0
    swung = (np.sqrt(np.where(held, squares[group.block], 0.0)) * x[group.block])[held]
    out = group.split(group.inverse @ np.concatenate([swung, v[group.block], branches]))
    out[group.modes : group.modes + len(group.loose)] = x[group.loose]
    return out


def _place_motion(
    system: System, group: _Group, squares: Array, out: dict[str, Array], starts: Index
) -> None:
    """What bearing forces do to a group's numbers (P), and what motions and stresses are of them."""
    block, loose = group.block, len(group.loose)
    position, v, into = _motions(group, squares)
    B = system.B[:, block]
    out["P"][:] = group.split((into @ -B.T).T)
    for name, shapes in (("X", position), ("V", v), ("A", v * group.roots)):
        out[name][:, block] = group.seen(shapes).T
    out["X"][group.modes : group.modes + loose, group.loose] = np.eye(loose)
    out["Z"][:] = np.hstack([out["X"][:, block] @ B.T, out["V"][:, block] @ B.T])
    place = len(group.shapes) - sum(
        t.L.shape[1] * len(t.material.G) for t in system.layers if np.abs(t.L[block]).max(initial=0.0) > 0
    )
    for k, layer in enumerate(system.layers):
        if np.abs(layer.L[block]).max(initial=0.0) > 0:
            rank = layer.L.shape[1]
            for i, g in enumerate(layer.material.G):
                columns = slice(starts[k] + i * rank, starts[k] + (i + 1) * rank)
                out["S"][:, columns] = np.sqrt(2 * g) * group.seen(group.shapes[place : place + rank]).T
                place += rank


def _loose_rows(group: _Group, squares: Array, dt: float, hold: int) -> Array:
    """Weights (k, modes, loose) of loose displacements: the modes' integrated over time once more."""
    r = np.flatnonzero(~(squares[group.block] > 0))
    v = _motions(group, squares)[1][r]
    weights = weights_of(group.roots, dt, hold, 1)
    rows = np.zeros((len(weights), group.modes, group.sizes[2]))
    each = group.seen(weights[:, None, :] * v)[..., : group.modes]
    rows[:, :, : len(r)] = each.transpose(0, 2, 1)
    return rows


def _place_loads(system: System, group: _Group, squares: Array, out: Array, speed: float, dt: float) -> None:
    """What loads do to a group's numbers over a step, per factor at its start; of a table at both ends."""
    r = np.flatnonzero(~(squares[group.block] > 0))
    _, v, into = _motions(group, squares)
    twice = np.where(np.arange(len(group.roots)) < group.reals, 1.0, 2.0)
    first, second = (weights_of(group.roots, dt, 1, ahead)[rows_of(1)] for ahead in (0, 1))

    def taken(factors: tuple[Complex, Complex], b: Complex) -> Array:
        """Of a load on the modes b (j,): by the modes, and by loose coordinates."""
        found = group.split(factors[0] * b)
        found[group.modes : group.modes + len(r)] = (v[r] * (factors[1] * b * twice)).real.sum(axis=1)
        return found

    for k, load in enumerate(system.loads):
        b = into @ load.p_cos[group.block]
        if load.kind == "constant":
            out[2 * k] = taken((first[0] + first[1], second[0] + second[1]), b)
        elif load.kind == "sampled":
            out[2 * k] = taken((first[1], second[1]), b)
            out[2 * k + 1] = taken((first[0], second[0]), b)
        else:
            turns = load.kind == "rotating"
            omega = speed if turns else load.omega
            ahead, back = _forced(group.roots, omega, dt), _forced(group.roots, -omega, dt)
            mean = 0.5 * (ahead[0] + back[0]), 0.5 * (ahead[1] + back[1])
            odd = 0.5j * (ahead[0] - back[0]), 0.5j * (ahead[1] - back[1])
            d = into @ load.p_sin[group.block]
            size = speed**2 if turns else 1.0
            out[2 * k] = size * (taken(mean, b) - taken(odd, d))
            out[2 * k + 1] = size * (taken(odd, b) + taken(mean, d))


def _join(group: _Group, out: dict[str, Array], rows: Array, joined: Array) -> None:
    """Add to z and its rate (order, 2, m, m) what bearing forces at the step's end do through one group."""
    P, Z, modes = out["P"], out["Z"], group.modes
    real, pairs, loose = group.sizes
    m = len(P)
    re, im = slice(real, real + pairs), slice(real + pairs, modes)
    for order in range(len(joined)):
        row = rows_of(order + 1).start  # of the new force
        weight = out["weights"][row]
        moved = P * weight
        moved[:, re] = P[:, re] * weight[re] - P[:, im] * weight[im]
        moved[:, im] = P[:, re] * weight[im] + P[:, im] * weight[re]
        moved[:, modes : modes + loose] = P[:, :modes] @ rows[row]
        both = moved @ Z
        joined[order, 0] += both[:, :m]
        joined[order, 1] += both[:, m:]
