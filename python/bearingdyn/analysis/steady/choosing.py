"""Which lines of several bases matter: chosen by what the balls move on them, refined till none is missed."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from bearingdyn import core
from bearingdyn.analysis.steady.balance import Balance, Found, newton
from bearingdyn.analysis.steady.problem import Problem
from bearingdyn.analysis.steady.torus import Lines
from bearingdyn.types import Array, Complex, Index

# a line is left out while it would move less than this share of the largest
NEGLIGIBLE = 1e-5
# lines taken at first, added each time, and at most
FIRST, ADDED, MOST = 40, 80, 500
ROUNDS = 8
# orders of a base that nothing else asks for
ORDERS = 8
# samples of a lattice, at most
MOST_SAMPLES = 40_000
# frequencies at which the structure is asked when lines are weighed
ASKED = 160


@dataclass(frozen=True, eq=False)
class Candidates:
    """For choosing lines, all candidates (c, d), the mean left out, with their frequencies, rad/s, rising."""

    index: Index
    omega: Array
    caps: list[int]


def candidates(problem: Problem, speed: float, harmonics: int) -> Candidates:
    """Candidates for choosing lines: combinations of the bases below the highest harmonic."""
    bases = problem.bases
    omega = bases.frequencies(speed)
    kernels = [t.kernel() for t in problem.system.bearings]
    passage = max(
        (k.Z * k.cage_ratio * abs(speed) for k in kernels if k.cage_ratio), default=float(np.abs(omega).max())
    )
    wave_orders = [
        int(row[1]) for k in kernels for row in k.imperfections.waves if row[0] != core.WAVE_KINDS["ball"]
    ]
    spins = [
        int(row[1]) for k in kernels for row in k.imperfections.waves if row[0] == core.WAVE_KINDS["ball"]
    ]
    highest = harmonics * passage
    caps = []
    for base in bases.bases:
        own = abs(base.frequency(speed))
        if base.name.startswith(("ball pass", "cage")):
            cap = int(highest / own)
        elif base.name in ("shaft", "inner ring", "outer ring"):
            cap = max([ORDERS, *(n + 4 for n in wave_orders)])
        elif base.name == "ball spin":
            cap = max([4, *(n + 2 for n in spins)])
        else:
            cap = ORDERS
        caps.append(max(1, min(cap, int(highest / own))))
    grids = np.meshgrid(*(np.arange(-c, c + 1) for c in caps), indexing="ij")
    index = np.stack([g.ravel() for g in grids], axis=1)
    frequency = index @ omega
    # one of each pair n, −n: the one that turns forwards
    keep = (frequency > 0.0) & (frequency <= highest * (1 + 1e-9))
    index, frequency = index[keep], frequency[keep]
    order = np.argsort(frequency, kind="stable")
    return Candidates(index[order], frequency[order], caps)


@dataclass(frozen=True, eq=False)
class Weigher:
    """Choosing among lines: how far a force on each would move the bearings, interpolated."""

    omega: Array
    answer: Array

    @classmethod
    def of(cls, problem: Problem, speed: float, low: float, high: float) -> Weigher:
        """Asked between two frequencies, rad/s."""
        omega = np.geomspace(max(low, 1e-4 * high), high, ASKED)
        B = problem.receptances.B
        return cls(omega, np.abs(problem.receptances.answer(omega, speed, B, B)).max(axis=2))

    def moved(self, omega: Array, force: Complex) -> Array:
        """(c,) of the force (c, m): the larger answer of both neighbours."""
        place = np.clip(np.searchsorted(self.omega, omega), 1, len(self.omega) - 1)
        answer = np.maximum(self.answer[place], self.answer[place - 1])
        return np.asarray((answer * np.abs(force)).max(axis=1))


def lattice(index: Index, offered: Candidates) -> Lines:
    """Choosing lines, a lattice for them that tells all candidates apart as far as samples allow."""
    whole = 1.0
    for cap in offered.caps:
        whole *= 4 * cap
    samples = int(min(max(whole, 1024), MOST_SAMPLES))
    return Lines.several(index, offered.caps, samples)


def balanced(
    problem: Problem,
    speed: float,
    harmonics: int,
    tolerance: float,
    start: tuple[Index, Complex] | None = None,
    tell: Callable[[int, int], object] | None = None,
) -> tuple[Balance, Found, float]:
    """Balance a motion of several bases by choosing its lines; and the largest share left out."""
    offered = candidates(problem, speed, harmonics)
    zero = np.zeros((1, len(problem.bases.bases)), dtype=np.intp)
    begun = problem.balance(lattice(np.vstack([zero, *_loaded(problem, speed)]), offered), speed)
    weigher = Weigher.of(problem, speed, float(offered.omega[0]), float(offered.omega[-1]))
    lines = begun.lines
    z = problem.standing(lines)
    if start is not None:
        lines = Lines(start[0], lines.steps, lines.samples)
        z = start[1].copy()
    balance = problem.balance(lines, speed)
    left = np.inf
    found: Found | None = None
    for turn in range(ROUNDS):
        size = _sizes(balance, z, offered, weigher)
        have = {tuple(n) for n in lines.index.tolist()}
        new = np.array([tuple(n) not in have for n in offered.index.tolist()])
        largest = max(float(np.abs(z[1:]).max(initial=0.0)), float(size.max(initial=0.0)), 1e-30)
        missing = np.where(new, size / largest, 0.0)
        left = float(missing.max(initial=0.0))
        if found is not None and (left <= NEGLIGIBLE or lines.count >= MOST):
            break
        wanted = np.argsort(-missing)[: FIRST if turn == 0 else ADDED]
        wanted = wanted[missing[wanted] > 0.3 * NEGLIGIBLE]
        wanted = wanted[: max(0, MOST - lines.count)]
        chosen = np.vstack([lines.index, offered.index[np.sort(wanted)]])
        grown = _apart(Lines(chosen, lines.steps, lines.samples))
        z = lines.moved(z, grown)
        lines = grown
        balance = problem.balance(lines, speed)
        found = newton(balance, z, tolerance=tolerance)
        if not found.converged:
            break
        z = found.z
        if tell is not None:
            tell(turn + 1, ROUNDS)
    assert found is not None
    if found.converged:
        left = max(left, _above(problem, balance, found.z, speed, harmonics))
    return balance, found, left


def _sizes(balance: Balance, z: Complex, offered: Candidates, weigher: Weigher) -> Array:
    """(c,) how far what the balls press on each line would move the bearings."""
    lines = balance.lines
    zero = np.zeros((1, lines.index.shape[1]), dtype=np.intp)
    everything = Lines(np.vstack([zero, offered.index]), lines.steps, lines.samples)
    pressed = balance.press(z, tangents=False)
    g = np.zeros((lines.samples, z.shape[1]))
    for own, along in zip(balance.slots, pressed.bearings, strict=True):
        g[:, own] = along.g
    return weigher.moved(offered.omega, everything.amplitudes(g)[1:])


def _above(problem: Problem, balance: Balance, z: Complex, speed: float, harmonics: int) -> float:
    """The largest share of a line above the highest harmonic, up to twice that, which was never offered."""
    more = candidates(problem, speed, 2 * harmonics)
    # the same lines on a lattice that tells those above apart
    grid = lattice(balance.lines.index, more)
    if len(_apart(grid).index) < len(grid.index):
        return 0.0
    above = more.omega > float(candidates(problem, speed, harmonics).omega[-1])
    if not above.any():
        return 0.0
    beyond = Candidates(more.index[above], more.omega[above], more.caps)
    weigher = Weigher.of(problem, speed, float(beyond.omega[0]), float(beyond.omega[-1]))
    size = _sizes(problem.balance(grid, speed), z, beyond, weigher)
    largest = max(float(np.abs(z[1:]).max(initial=0.0)), 1e-30)
    return float(size.max(initial=0.0)) / largest


def _apart(lines: Lines) -> Lines:
    """The lines without those that fall on an earlier one of the lattice."""
    folded = np.minimum(lines.place, lines.samples - lines.place)
    _, first = np.unique(folded, return_index=True)
    return Lines(lines.index[np.sort(first)], lines.steps, lines.samples)


def _loaded(problem: Problem, speed: float) -> list[Index]:
    from bearingdyn.analysis.steady.torus import load_lines

    found = [n for n in load_lines(problem.system, problem.bases, speed) if any(n)]
    return [np.array([n]) for n in found]
