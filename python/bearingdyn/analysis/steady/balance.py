"""The balance of harmonics: z + R h(z) = z_F at every line, the forces of the balls found in time.

    h = g(z, ż) − K z − C ż,   R = B (D + Bᵀ (K + iωC) B)⁻¹ Bᵀ,   z_F likewise of the loads

with any reference K, C; alternating frequency and time, T. M. Cameron and J. H. Griffin, J. Appl. Mech. 56
(1989) 149.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from itertools import pairwise

import numpy as np

from bearingdyn import core
from bearingdyn.analysis.steady.krylov import gmres
from bearingdyn.analysis.steady.layer_lines import Softened, SoftLayers
from bearingdyn.analysis.steady.receptances import Receptances
from bearingdyn.analysis.steady.torus import Bases, Lines, body_angles, load_lines
from bearingdyn.kept_by_object import kept_by_object
from bearingdyn.system import System
from bearingdyn.types import Array, Complex

# m: a motion smaller than this is none
TINY = 1e-15
# residual below which only round-off is left
ROUND_OFF = 1e-14
# samples for each line at which Newton's iteration asks tangents, at least: of a product of tangents and a
# change on the lines, only tangents of more than five times the highest line then fold onto them
TANGENT_SAMPLES = 6


@dataclass(frozen=True, eq=False)
class Pressed:
    """Balance of a steady motion: what balls and softening layers do along it, and their forces on the lines.

    Parameters
    ----------
    bearings
        Of each bearing its samples.
    g
        Force on all coefficients (L, m).
    K, C
        Mean tangents (m, m), block-diagonal, of the bearings.
    softened
        What the layers do that soften.
    """

    bearings: tuple[core.Along, ...]
    g: Complex
    K: Array
    C: Array
    softened: Softened

    @property
    def has_tangents(self) -> bool:
        """Whether the tangents are there, sample by sample."""
        return all(a.K.size for a in self.bearings)

    def without_tangents(self) -> Pressed:
        """The same without tangents and powers, to be kept of many motions: loads and forces along it."""
        none, powers = np.zeros((0, 0, 0)), dict.fromkeys(("heat", "pressing", "turning"), np.zeros(0))
        return replace(self, bearings=tuple(replace(a, K=none, C=none, **powers) for a in self.bearings))

    @classmethod
    def unknown(cls) -> Pressed:
        """Of a motion of which only the amplitudes are kept."""
        none = np.zeros((0, 0), dtype=np.complex128)
        softened = SoftLayers(()).along(none, np.zeros(0), np.zeros(0))
        return cls((), none, np.zeros((0, 0)), np.zeros((0, 0)), softened)


@dataclass(frozen=True, eq=False)
class Balance:
    """Harmonic balance: the equations of a steady motion of one system at one speed on chosen lines.

    Parameters
    ----------
    system, bases, receptances
        The system, what turns in it, and what its structure answers.
    lines
        Lines and samples.
    speed
        Of the shaft, rad/s.
    rows
        (k, n) motions that are asked for beside the bearings' own.
    standing
        (k,) of layers that soften their coordinates where they stand still.
    """

    system: System
    bases: Bases
    receptances: Receptances
    lines: Lines
    speed: float
    rows: Array | None = None
    standing: Array = field(default_factory=lambda: np.zeros(0))

    @cached_property
    def omega(self) -> Array:
        """(L,) rad/s of the lines; of the mean 0, else not 0."""
        return np.asarray(self.lines.index @ self.bases.frequencies(self.speed))

    @cached_property
    def slots(self) -> list[slice]:
        """Of every bearing its coefficients among all."""
        ends = np.cumsum([0, *(len(t.B) for t in self.system.bearings)]).tolist()
        return [slice(a, b) for a, b in pairwise(ends)]

    @cached_property
    def kernels(self) -> tuple[_Packed, ...]:
        return packed(self.system)

    @cached_property
    def bodies(self) -> list[tuple[Array, Array]]:
        """Of every bearing the angles (N, 4) of its bodies, rad, and their speeds (4,), rad/s."""
        angles = self.lines.angles()
        return [
            (body_angles(turning, angles), self.speed * np.array(turning.ratio))
            for turning in self.bases.bearings
        ]

    @cached_property
    def loads(self) -> list[tuple[int, Complex]]:
        """Lines that loads drive, and their forces (n,)."""
        found = load_lines(self.system, self.bases, self.speed)
        return [(self._line(n), force) for n, force in found.items()]

    def _line(self, n: Sequence[int]) -> int:
        return int(np.flatnonzero((self.lines.index == np.array(n)).all(axis=1))[0])

    @cached_property
    def _above(self) -> Array:
        B = self.receptances.B
        return B if self.rows is None else np.vstack([B, self.rows])

    @cached_property
    def _answers(self) -> Complex:
        """(L, m + k, m) of coefficients and rows to forces on coefficients."""
        return self.receptances.answer(self.omega, self.speed, self._above, self.receptances.B)

    @cached_property
    def _driven(self) -> Complex:
        out = np.zeros((self.lines.count, len(self._above)), dtype=np.complex128)
        for line, force in self.loads:
            omega = self.omega[line : line + 1]
            out[line] += self.receptances.answer(omega, self.speed, self._above, force[None])[0, :, 0]
        return out

    @cached_property
    def R(self) -> Complex:
        """(L, m, m) with the reference on."""
        m = len(self.receptances.B)
        return np.ascontiguousarray(self._answers[:, :m])

    @cached_property
    def driven(self) -> Complex:
        """z_F (L, m): what the loads alone would do, with the reference on."""
        return self._driven[:, : len(self.receptances.B)]

    def towards(self, speed: float, a: Balance, b: Balance) -> Balance:
        """The balance at a speed near by, its receptances straight on from here by the slope from a to b."""
        near = replace(self, speed=speed)
        share = (speed - self.speed) / (b.speed - a.speed)
        near.__dict__.update(
            _answers=self._answers + share * (b._answers - a._answers),
            _driven=self._driven + share * (b._driven - a._driven),
            kernels=self.kernels,
            slots=self.slots,
        )
        return near

    def moved(self, z: Complex, g: Complex) -> Complex:
        """Amplitudes (L, k) of the rows."""
        m = len(self.receptances.B)
        h = self.excess(z, g)
        return np.asarray(self._driven[:, m:] - (self._answers[:, m:] @ h[:, :, None])[:, :, 0])

    def window(self, lines: Lines) -> float:
        """Time between samples, s; of several bases, whose samples have none, 1/12 of the fastest line's."""
        if lines.index.shape[1] == 1:
            return float(2 * np.pi / abs(self.bases.frequencies(self.speed)[0]) / lines.samples)
        # a motion that begins at rest has no line yet
        fastest = np.abs(self.omega).max() or np.abs(self.bases.frequencies(self.speed)).max()
        return float(2 * np.pi / 12 / fastest)

    def rates(self, z: Complex) -> Complex:
        """Amplitudes of the rate of change."""
        return np.asarray(1j * self.omega[:, None] * z)

    def press(self, z: Complex, *, tangents: bool = True, lines: Lines | None = None) -> Pressed:
        """What balls and softening layers do along the motion z (L, m)."""
        lines = lines or self.lines
        signal = lines.signals(np.hstack([z, self.rates(z)]))
        m = z.shape[1]
        bodies = self.bodies if lines is self.lines else replace(self, lines=lines).bodies
        found = []
        K, C = np.zeros((m, m)), np.zeros((m, m))
        g = np.zeros((lines.samples, m))
        for kernel, own, (angles, speeds) in zip(self.kernels, self.slots, bodies, strict=True):
            along = core.bearing_along(
                kernel,
                signal[:, own],
                signal[:, m + own.start : m + own.stop],
                angles,
                speeds,
                window=self.window(lines),
                tangents=tangents,
            )
            g[:, own] = along.g
            if tangents:
                K[own, own], C[own, own] = along.K.mean(axis=0), along.C.mean(axis=0)
            found.append(along)
        force = lines.amplitudes(g)
        of_layers = self.receptances.of_layers
        softened = self.receptances.soft.along(z[:, of_layers], self.omega, self.standing)
        force[:, of_layers] = softened.change * z[:, of_layers] + softened.lasting
        return Pressed(tuple(found), force, K, C, softened)

    def excess(self, z: Complex, g: Complex) -> Complex:
        """h (L, m): the balls' force less the reference's."""
        return np.asarray(g - z @ self.receptances.K.T - self.rates(z) @ self.receptances.C.T)

    def residual(self, z: Complex, pressed: Pressed) -> Complex:
        """z + R h − z_F (L, m), m."""
        h = self.excess(z, pressed.g)
        return np.asarray(z + (self.R @ h[:, :, None])[:, :, 0] - self.driven)

    def linearised(self, pressed: Pressed, sparse: bool = False) -> Linearised:
        """The derivative of the residual, preconditioned; or nearly it, from fewer samples."""
        return Linearised.of(self, pressed, *(_sparser(self.lines) if sparse else (self.lines, 1)))


@dataclass(frozen=True)
class _Packed:
    """A kernel packed once for many calls."""

    fields: dict[str, object]

    def packed(self) -> dict[str, object]:
        return self.fields


@kept_by_object
def packed(system: System) -> tuple[_Packed, ...]:
    """Harmonic balance's kernels of the bearings, packed once for many calls."""
    return tuple(_Packed(term.kernel().packed()) for term in system.bearings)


@dataclass(frozen=True, eq=False)
class Linearised:
    """Harmonic balance, linearised at a motion: P⁻¹ J times vectors; P has the mean tangent alone.

    Vectors are amplitudes as real numbers: of (L, m) complex their (L, m, 2) parts, flat; the mean's
    imaginary part is kept at zero.
    """

    balance: Balance
    lines: Lines
    tangents: tuple[Array, ...]
    softened: Softened
    inverse: Complex = field(repr=False)
    R: Complex = field(repr=False)

    @classmethod
    def of(cls, balance: Balance, pressed: Pressed, lines: Lines, stride: int) -> Linearised:
        reference = balance.receptances
        omega = balance.omega[:, None, None]
        off = (pressed.K - reference.K) + 1j * omega * (pressed.C - reference.C)
        m = len(reference.K)
        each = np.arange(m)[reference.of_layers]
        off[:, each, each] += pressed.softened.change
        P = np.eye(m) + balance.R @ off
        inverse = np.linalg.inv(P)
        tangents = tuple(
            np.concatenate([a.K[::stride], a.C[::stride]], axis=2)
            - np.concatenate([pressed.K[own, own], pressed.C[own, own]], axis=1)
            for own, a in zip(balance.slots, pressed.bearings, strict=True)
        )
        # P⁻¹ (I + R (T − Z)) = I + P⁻¹ R (T − T̄)
        inverse_R = np.asarray(inverse @ balance.R)
        return cls(balance, lines, tangents, pressed.softened, np.asarray(inverse), inverse_R)

    def forced(self, z: Complex) -> Complex:
        """What the tangents less their mean make of a change z (L, m)."""
        b = self.balance
        m = z.shape[1]
        signal = self.lines.signals(np.hstack([z, b.rates(z)]))
        g = np.zeros((self.lines.samples, m))
        for own, T in zip(b.slots, self.tangents, strict=True):
            both = np.concatenate([signal[:, own], signal[:, m + own.start : m + own.stop]], axis=1)
            g[:, own] = np.einsum("nij,nj->ni", T, both)
        force = self.lines.amplitudes(g)
        of_layers = b.receptances.of_layers
        force[:, of_layers] = self.softened.forced(z[:, of_layers])
        return force

    def product(self, vector: Array) -> Array:
        """P⁻¹ J times a vector."""
        z = unflat(vector, self.balance)
        return vector + flat((self.R @ self.forced(z)[:, :, None])[:, :, 0])

    def prepared(self, residual: Complex) -> Array:
        """P⁻¹ times a residual, as a vector."""
        return flat((self.inverse @ residual[:, :, None])[:, :, 0])

    def solve(self, residual: Complex, tolerance: float) -> tuple[Complex, float]:
        """J⁻¹ residual (L, m), and what the solve left, relative."""
        x, left = gmres(self.product, self.prepared(residual), tolerance)
        return unflat(x, self.balance), left


def _sparser(lines: Lines) -> tuple[Lines, int]:
    """Lines of one base on every so manieth of their samples: for tangents, whose errors cost no digits."""
    if lines.index.shape[1] != 1:
        return lines, 1
    most = lines.samples // (TANGENT_SAMPLES * lines.count)
    stride = next((s for s in range(most, 1, -1) if lines.samples % s == 0), 1)
    return Lines(lines.index, lines.steps, lines.samples // stride), stride


def flat(z: Complex) -> Array:
    """Amplitudes (L, m) of a harmonic balance as real numbers."""
    z = np.ascontiguousarray(z)
    z[0].imag = 0.0
    return z.view(np.float64).reshape(-1)


def unflat(vector: Array, balance: Balance) -> Complex:
    """For a harmonic balance, real numbers as amplitudes (L, m)."""
    return np.ascontiguousarray(vector).view(np.complex128).reshape(balance.lines.count, -1)


@dataclass(frozen=True, eq=False)
class Found:
    """Result of a harmonic balance: a motion, and how well it balances.

    Parameters
    ----------
    z
        Amplitudes (L, m) of the bearings' coefficients, m.
    residual
        Largest entry of the residual over the largest amplitude.
    line, coefficient
        Where it is.
    iterations
        Of Newton.
    converged
        Whether the residual is below what was asked for.
    """

    z: Complex
    pressed: Pressed
    residual: float
    line: int
    iterations: int
    converged: bool


def measure(residual: Complex, z: Complex) -> tuple[float, int]:
    """How well a motion balances: the largest residual over the largest amplitude, and its line."""
    sizes = np.abs(residual).max(axis=1, initial=0.0)
    if not sizes.any():
        return float(sizes.sum()), 0
    return float(sizes.max() / max(np.abs(z).max(initial=0.0), TINY)), int(np.argmax(sizes))


def newton(
    balance: Balance,
    z: Complex,
    *,
    tolerance: float = 1e-11,
    most: int = 40,
    tell: Callable[[int, float], object] | None = None,
) -> Found:
    """Newton's iteration of a harmonic balance from amplitudes z, steps halved while they do not help."""
    pressed = balance.press(z)
    r = balance.residual(z, pressed)
    size, line = measure(r, z)
    last = np.inf
    for iteration in range(most):
        if tell is not None:
            tell(iteration, size)
        if not np.isfinite(size):
            break
        if size <= tolerance:
            return Found(z, pressed, size, line, iteration, True)
        # as exact as the quadratic convergence can use, no more
        forcing = min(1e-2, max(0.03 * size, 0.1 * tolerance / size))
        step, _ = balance.linearised(pressed, sparse=True).solve(r, forcing)
        share = 1.0
        while True:
            trial = z - share * step
            tried = balance.press(trial)
            r_new = balance.residual(trial, tried)
            new, where = measure(r_new, trial)
            if new <= (1.0 - 0.1 * share) * size or share < 1.0 / 32.0:
                break
            share *= 0.5
        stuck = new > 0.9 * size and last > 0.9
        last = new / size
        z, pressed, r, size, line = trial, tried, r_new, new, where
        if stuck and size <= max(1e3 * tolerance, ROUND_OFF):
            break
    return Found(z, pressed, size, line, most, bool(size <= max(tolerance, ROUND_OFF)))
