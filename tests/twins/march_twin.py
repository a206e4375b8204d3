"""NumPy twin of the march and of the harmonic response: what csrc/newmark.c and csrc/harmonic.c must do.

Dense, in the caller's order of coordinates, with a full Newton iteration on all accelerations in every step:

    M a + (C + ΩG) v + (K + ΩN + Ω̇G) x + Σ_l L_l Σ_i s_li + Σ_b B_bᵀ g_b(B_b x, B_b v, t) = f(t)
    x = x̃ + βΔt² a,  v = ṽ + γΔt a,  s′ = E s + 2Gτ (old ẏ + new ẏ′),  y = Lᵀx.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from twins.bearing_twin import bearing_force
from twins.maxwell_twin import branch_weights


@dataclass
class System:
    """What bd_model_data describes: matrices (n, n), and lists of the tuples below."""

    M: np.ndarray
    C: np.ndarray
    G: np.ndarray
    K: np.ndarray
    N: np.ndarray
    layers: list[tuple[np.ndarray, np.ndarray, np.ndarray]] = field(default_factory=list)
    """L (n, rank), modulus (branches,), tau (branches,)"""
    bearings: list[tuple[Any, np.ndarray]] = field(default_factory=list)
    """BearingKernel, B (coefficients, n)"""
    loads: list[tuple[str, float, np.ndarray, np.ndarray, np.ndarray, np.ndarray]] = field(
        default_factory=list
    )
    """kind, omega, p_cos (n,), p_sin (n,), time, value"""
    channels: list[tuple[str, np.ndarray, int, int]] = field(default_factory=list)
    """kind, row (n,), bearing, index"""


@dataclass
class State:
    t: float
    x: np.ndarray
    v: np.ndarray
    a: np.ndarray
    stress: list[np.ndarray]
    """per layer (branches, rank)"""


@dataclass(frozen=True)
class Turn:
    """How the shaft turns at one time: Ω, Ω̇, angle."""

    speed: float
    rate: float
    angle: float


Speed = float | tuple[Any, Any]
"""rad/s: constant, or (times, values), linear between and held outside"""


def turn_at(speed: Speed, t: float, before: float, after: float) -> Turn:
    """Ω, its mean rate from t − before to t + after, and ∫Ω dt from t = 0."""
    if not isinstance(speed, tuple):
        return Turn(speed, 0.0, speed * t)
    times, values = (np.asarray(s, float) for s in speed)
    now, left, right = np.interp([t, t - before, t + after], times, values)
    # the trapezoidal rule is exact between knots; outside them the speed is held
    low, high = sorted((0.0, t))
    knots = np.concatenate([[low], times[(times > low) & (times < high)], [high]])
    angle = np.sign(t) * np.trapezoid(np.interp(knots, times, values), knots)
    return Turn(now, (right - left) / (before + after), angle)


def force(system: System, turn: Turn, t: float) -> np.ndarray:
    """f(t), (n,)."""
    total = np.zeros(len(system.M))
    for kind, omega, p_cos, p_sin, time, value in system.loads:
        if kind == "constant":
            total += p_cos
        elif kind == "harmonic":
            total += p_cos * np.cos(omega * t) + p_sin * np.sin(omega * t)
        elif kind == "rotating":
            # −d²/dt² of the whirling centre e^{iθ}: Ω² e^{iθ} − Ω̇ i e^{iθ}
            c, s = np.cos(turn.angle), np.sin(turn.angle)
            total += p_cos * (turn.speed**2 * c + turn.rate * s) + p_sin * (turn.speed**2 * s - turn.rate * c)
        else:
            total += p_cos * np.interp(t, time, value)
    return total


def bearings(
    system: System, turn: Turn, x: np.ndarray, v: np.ndarray
) -> list[tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]]:
    """g, ∂g/∂z, ∂g/∂ż and ball loads of every bearing."""
    return [
        bearing_force(
            s,
            B @ x,
            B @ v,
            s.angle0 + s.cage_ratio * turn.angle,
            s.cage_ratio * turn.speed,
            turn.angle,
            turn.speed,
        )
        for s, B in system.bearings
    ]


def structure_matrices(system: System, turn: Turn) -> tuple[np.ndarray, np.ndarray]:
    """C + ΩG and K + ΩN + Ω̇G."""
    C = system.C + turn.speed * system.G
    return C, system.K + turn.speed * system.N + turn.rate * system.G


def start(system: System, speed: Speed, t: float, x: np.ndarray, v: np.ndarray, dt: float) -> State:
    """Relaxed branches, and the acceleration that satisfies the equation of motion."""
    turn = turn_at(speed, t, 0.0, dt / 2)
    C, K = structure_matrices(system, turn)
    rest = force(system, turn, t) - C @ v - K @ x
    for (_, B), (g, *_) in zip(system.bearings, bearings(system, turn, x, v), strict=True):
        rest = rest - B.T @ g
    stress = [np.zeros((len(tau), L.shape[1])) for L, _, tau in system.layers]
    return State(t, x.copy(), v.copy(), np.linalg.solve(system.M, rest), stress)


def step(system: System, s: State, dt: float, beta: float, gamma: float, speed: Speed) -> State:
    """One step of Newmark's scheme, by Newton's method on a."""
    t = s.t + dt
    turn = turn_at(speed, t, dt / 2, dt / 2)
    C_now, K_now = structure_matrices(system, turn)
    x_old = s.x + dt * s.v + (0.5 - beta) * dt**2 * s.a
    v_old = s.v + (1 - gamma) * dt * s.a
    linear = system.M + gamma * dt * C_now + beta * dt**2 * K_now
    history, now = [], []
    for (L, modulus, tau), stress in zip(system.layers, s.stress, strict=True):
        E, old, new = branch_weights(dt / tau)
        scale = 2 * modulus * tau
        history.append(E[:, None] * stress + (scale * old)[:, None] * (s.v @ L))
        now.append(scale * new)
        linear = linear + gamma * dt * now[-1].sum() * L @ L.T
    f = force(system, turn, t)

    a = s.a.copy()
    for _ in range(50):
        x, v = x_old + beta * dt**2 * a, v_old + gamma * dt * a
        r = system.M @ a + C_now @ v + K_now @ x - f
        J = linear.copy()
        for (L, _, _), h, w in zip(system.layers, history, now, strict=True):
            r = r + L @ (h.sum(axis=0) + w.sum() * (v @ L))
        for (_, B), (g, K, C, _) in zip(system.bearings, bearings(system, turn, x, v), strict=True):
            r = r + B.T @ g
            J = J + B.T @ (beta * dt**2 * K + gamma * dt * C) @ B
        change = np.linalg.solve(J, r)
        a = a - change
        if np.abs(change).max() <= 1e-14 * np.abs(a).max():
            break
    else:
        raise ArithmeticError(f"no convergence at t = {t}")
    x, v = x_old + beta * dt**2 * a, v_old + gamma * dt * a
    stress = [h + w[:, None] * (v @ L) for (L, _, _), h, w in zip(system.layers, history, now, strict=True)]
    return State(t, x, v, a, stress)


def observe(system: System, s: State, speed: Speed, dt: float) -> np.ndarray:
    """One row of the record, (channels,)."""
    found = bearings(system, turn_at(speed, s.t, dt / 2, dt / 2), s.x, s.v)
    row = []
    for kind, weights, bearing, index in system.channels:
        if kind in ("displacement", "velocity", "acceleration"):
            row.append(weights @ {"displacement": s.x, "velocity": s.v, "acceleration": s.a}[kind])
        elif kind == "force":
            row.append(found[bearing][0][index])
        elif kind == "ball":
            row.append(found[bearing][3][index])
        else:
            row.append(np.count_nonzero(found[bearing][3] > 0))
    return np.array(row)


def march(
    system: System,
    s: State,
    dt: float,
    steps: int,
    decimate: int = 1,
    *,
    beta: float = 0.25,
    gamma: float = 0.5,
    speed: Speed = 0.0,
    done: int = 0,
) -> tuple[np.ndarray, State]:
    """Record (rows, channels) and the state after `steps`; `done` steps of the same dt came before."""
    rows = []
    for n in range(1, steps + 1):
        s = step(system, s, dt, beta, gamma, speed)
        if (done + n) % decimate == 0:
            rows.append(observe(system, s, speed, dt))
    return np.array(rows).reshape(len(rows), len(system.channels)), s


def harmonic(
    system: System,
    omega: np.ndarray,
    modulus: np.ndarray,
    bearing_K: np.ndarray,
    bearing_C: np.ndarray,
    forces: np.ndarray,
    rows: np.ndarray,
    speed: float,
) -> np.ndarray:
    """Complex response (frequencies, outputs, inputs); modulus (frequencies, layers) complex."""
    out = []
    B = np.vstack([B for _, B in system.bearings]) if system.bearings else np.zeros((0, len(system.M)))
    for w, moduli in zip(omega, modulus, strict=True):
        D = system.K + speed * system.N - w**2 * system.M + 1j * w * (system.C + speed * system.G)
        for (L, _, _), G in zip(system.layers, moduli, strict=True):
            D = D + 2 * G * L @ L.T
        D = D + B.T @ (bearing_K + 1j * w * bearing_C) @ B
        out.append(rows @ np.linalg.solve(D, forces.T))
    return np.array(out)


def random_system(
    rng: np.random.Generator,
    sizes: Sequence[int],
    layers: Sequence[tuple[int, int, int]],
    kernels: Sequence[tuple[Callable[[], Any], int, int]],
) -> System:
    """A motor in small, coordinates shuffled.

    sizes: coordinates of each block. layers: block, rank and number of branches of each. kernels: of each
    bearing a function that makes its BearingKernel, the block of its inner and that of its outer ring (−1:
    ground). Unit masses, frequencies of 30 Hz to 6 kHz, 2 % damping, loads and channels of every kind.
    """
    n = sum(sizes)
    M, C, G, K, N = (np.zeros((n, n)) for _ in range(5))
    shuffled = rng.permutation(n)
    blocks = np.split(shuffled, np.cumsum(sizes)[:-1])
    for b, block in enumerate(blocks):
        m = len(block)
        at = np.ix_(block, block)
        w = 2 * np.pi * np.geomspace(30.0 if b == 0 else 500.0, 6e3, m)
        A = 0.1 * rng.standard_normal((m, m)) / m
        M[at] = np.eye(m) + A + A.T
        K[at], C[at] = np.diag(w**2), np.diag(0.04 * w)
        A = rng.standard_normal((m, m))
        G[at], C[at] = 0.1 * (A - A.T), C[at] + 2.0 * A @ A.T / m
        A = rng.standard_normal((m, m))
        N[at] = 3.0 * (A - A.T)
    system = System(M, C, G, K, N)
    for b, rank, branches in layers:
        L = np.zeros((n, rank))
        L[blocks[b]] = rng.standard_normal((len(blocks[b]), rank))
        system.layers.append((L, 10 ** rng.uniform(4, 6.5, branches), 10 ** rng.uniform(-6.5, -2, branches)))
    for make, inner, outer in kernels:
        spec = make()
        B = np.zeros((len(spec.order), n))
        B[:, blocks[inner]] = 0.7 * rng.standard_normal((len(B), sizes[inner]))
        if outer >= 0 and outer != inner:
            B[:, blocks[outer]] = -rng.standard_normal((len(B), sizes[outer]))
        system.bearings.append((spec, B))
    scales = {"constant": 400.0, "harmonic": 80.0, "rotating": 2e-4, "sampled": 1.0}
    time, value = np.array([1e-5, 7e-5, 2e-4]), np.array([30.0, -60.0, 40.0])
    for kind, scale in scales.items():
        p = scale * rng.standard_normal((2, n))
        system.loads.append((kind, 2 * np.pi * 700.0, p[0], p[1], time, value))
    for kind in ("displacement", "velocity", "acceleration", "displacement"):
        system.channels.append((kind, rng.standard_normal(n), 0, 0))
    for b, (spec, _) in enumerate(system.bearings):
        for kind, count in (("force", len(spec.order)), ("ball", spec.Z), ("loaded", 1)):
            system.channels.append((kind, np.zeros(n), b, int(rng.integers(count))))
    return system
