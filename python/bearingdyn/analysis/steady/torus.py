"""The lines of a steady motion, and where it is sampled: a motion of several base frequencies is a torus.

A line is a whole-number combination n of the base frequencies ω; the motion is Σ Re z_n e^{i n·θ} over the
base angles θ = ω t. What the balls do with it depends on the angles alone. So the torus may be sampled along
any path that covers it: along θ_j = 2π s_j i/N with whole numbers s line n becomes harmonic n·s mod N of one
discrete Fourier transform, and no frequency needs to be commensurate with another.

References
----------
K. S. Kundert, J. K. White and A. Sangiovanni-Vincentelli, Steady-State Methods for Simulating Analog and
Microwave Circuits, Kluwer 1990, chapter 6 (maps to artificial frequencies).
"""

from __future__ import annotations

import itertools
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import scipy

from bearingdyn.checks import require
from bearingdyn.system import System
from bearingdyn.types import Array, Complex, Index

# samples for each of the harmonics: a damper that a ball closes makes its force jump, and the samples see
# the place of it to second order; with 20 the twentieth line of a machine that loses contact is right to 1e-3
PER_HARMONIC = 20
LEAST_SAMPLES = 128
# lattices tried for several bases, and the largest share of a box that may lie aliased inside the lines
TRIALS = 40
# two ratios of speeds closer than this are one base
SAME = 1e-12


@dataclass(frozen=True)
class Base:
    """One base of a torus, a frequency: `ratio` times the shaft's speed, or `omega` of a load, rad/s."""

    name: str
    ratio: float = 0.0
    omega: float = 0.0

    def frequency(self, speed: float) -> float:
        """rad/s at a speed of the shaft, rad/s."""
        return self.ratio * speed if self.ratio else self.omega


@dataclass(frozen=True)
class Turning:
    """How a bearing's bodies turn on the torus: of cage, rings and spin, the base and its multiple."""

    base: tuple[int | None, ...]
    multiple: tuple[float, ...]
    ratio: tuple[float, ...]
    angle0: float


@dataclass(frozen=True)
class Bases:
    """The bases of a system's torus, its frequencies, and what turns with them."""

    bases: tuple[Base, ...]
    bearings: tuple[Turning, ...]

    def frequencies(self, speed: float) -> Array:
        """(d,) rad/s at a speed, rad/s."""
        return np.array([base.frequency(speed) for base in self.bases])

    @classmethod
    def of(cls, system: System, subharmonic: int = 1) -> Bases:
        """Those that the bearings, unbalances and harmonic loads of a system bring in.

        A perfect bearing repeats with every ball that passes; one that is not perfect with its cage, and with
        the ring or ball that carries the fault.

        Raises
        ------
        ValueError
            For a sampled load, for a subharmonic of several bases, and where nothing turns or drives.
        """
        kernels = [term.kernel() for term in system.bearings]
        needed: list[tuple[str, float]] = []
        for kernel in kernels:
            faults = kernel.imperfections
            if kernel.cage_ratio and faults.none:
                needed.append((f"ball pass of {kernel.Z} balls", kernel.Z * kernel.cage_ratio))
            if faults.none:
                continue
            needed.append(("cage", kernel.cage_ratio))
            kinds = _carriers(faults)
            needed += [(name, ratio) for name, ratio in _others(kernel) if name in kinds]
        if any(load.kind == "rotating" for load in system.loads):
            needed.append(("shaft", 1.0))
        found: list[Base] = []
        for name, ratio in sorted(needed, key=lambda n: n[0] == "shaft"):
            if ratio and not any(_same(ratio, base.ratio) for base in found):
                found.append(Base("shaft" if _same(ratio, 1.0) else name, ratio))
        # a passage is so many turns of a cage that is a base already
        cages = [b.ratio for b in found if b.name == "cage"]
        found = [
            b
            for b in found
            if not (b.name.startswith("ball pass") and any(_multiple(b.ratio, c) for c in cages))
        ]
        for load in system.loads:
            require(
                load.kind != "sampled",
                "source: a load",
                load.kind,
                "a steady motion has no sampled loads; give constant, harmonic or rotating ones",
            )
            omega = load.omega
            if load.kind == "harmonic" and not any(_same(omega, b.omega) for b in found):
                found.append(Base(f"load of {omega / (2 * np.pi):g} Hz", omega=omega))
        require(
            bool(found),
            "source",
            system,
            "nothing in it turns or drives: there is no base frequency; give it a bearing, an unbalance or a "
            "harmonic load, or ask bd.equilibrium for its state at rest",
        )
        if subharmonic > 1:
            require(
                len(found) == 1,
                "subharmonic",
                subharmonic,
                f"there are {len(found)} base frequencies ({', '.join(b.name for b in found)}), which have "
                "no common period to divide; leave it out",
            )
            b = found[0]
            found = [Base(f"1/{subharmonic} of {b.name}", b.ratio / subharmonic, b.omega / subharmonic)]
        return cls(tuple(found), tuple(_turning(kernel, found) for kernel in kernels))


def _same(a: float, b: float) -> bool:
    return abs(a - b) <= SAME * max(abs(a), abs(b))


def _multiple(a: float, b: float) -> bool:
    return _same(a / b, round(a / b))


def _others(kernel: object) -> list[tuple[str, float]]:
    """Names and ratios of the bodies of a bearing beside its cage."""
    k = kernel
    return [
        ("inner ring", k.inner_ratio),  # type: ignore[attr-defined]
        ("outer ring", k.outer_ratio),  # type: ignore[attr-defined]
        ("ball spin", k.imperfections.spin_ratio),  # type: ignore[attr-defined]
    ]


def _carriers(faults: object) -> set[str]:
    """Which bodies beside the cage carry a fault."""
    from bearingdyn import core

    waves = {v: k for k, v in core.WAVE_KINDS.items()}
    pits = {v: k for k, v in core.PIT_KINDS.items()}
    names = [waves[int(row[0])] for row in faults.waves] + [  # type: ignore[attr-defined]
        pits[int(row[0])]
        for row in faults.pits  # type: ignore[attr-defined]
    ]
    bodies = {"inner": "inner ring", "outer": "outer ring", "ball": "ball spin"}
    return {bodies[name.split("_")[0]] for name in names}


def _turning(kernel: object, bases: Sequence[Base]) -> Turning:
    """Which base turns which body of a bearing, and how often in a period of it."""
    k = kernel
    ratios = [k.cage_ratio, *(ratio for _, ratio in _others(k))]  # type: ignore[attr-defined]
    carried = _carriers(k.imperfections)  # type: ignore[attr-defined]
    counts = [True, *(name in carried for name, _ in _others(k))]
    base: list[int | None] = []
    multiple = []
    for ratio, counted in zip(ratios, counts, strict=True):
        place = None
        if ratio and counted:
            # the cage of a perfect bearing turns by one ball in a period of its passage
            place = next(
                j
                for j, b in enumerate(bases)
                if b.ratio and (_same(ratio, b.ratio) or (_whole_balls(ratio, b.ratio, k.Z)))  # type: ignore[attr-defined]
            )
        base.append(place)
        multiple.append(0.0 if place is None else ratio / bases[place].ratio)
    return Turning(tuple(base), tuple(multiple), tuple(ratios), float(k.angle0))  # type: ignore[attr-defined]


def _whole_balls(ratio: float, base: float, Z: int) -> bool:
    """Whether Z turns of a body are a whole number of periods of a base."""
    return _multiple(Z * ratio, base)


@dataclass(frozen=True, eq=False)
class Lines:
    """Lines (L) of a motion on a torus, the first its mean, and the lattice that it is sampled on.

    Parameters
    ----------
    index
        (L, d) whole numbers.
    steps
        (d,) of the lattice.
    samples
        N, of the lattice.
    """

    index: Index
    steps: Index
    samples: int

    @classmethod
    def harmonics(cls, count: int, per: int = PER_HARMONIC) -> Lines:
        """Harmonics 0 … count of one base."""
        samples = scipy.fft.next_fast_len(max(per * (count + 1), LEAST_SAMPLES), real=True)
        return cls(np.arange(count + 1)[:, None], np.array([1]), int(samples))

    @classmethod
    def several(cls, index: Index, caps: Sequence[int], samples: int) -> Lines:
        """Chosen lines of several bases, on the lattice on which their neighbours fall on them least.

        Parameters
        ----------
        index
            (L, d), the mean first.
        caps
            Of each base the highest order that the bearings answer with.
        samples
            About how many.
        """
        best: tuple[float, Index, int] | None = None
        box = np.array(list(itertools.product(*(range(-2 * c, 2 * c + 1) for c in caps))))
        size = (np.abs(box) / np.maximum(caps, 1)).max(axis=1)
        N = int(scipy.fft.next_fast_len(samples, real=True))
        rng = np.random.default_rng(0)
        first = np.concatenate([[1], np.cumprod([2 * c + 1 for c in caps])[:-1]])
        for trial in range(TRIALS):
            s = first % N if trial == 0 else np.concatenate([[1], rng.integers(1, N, len(caps) - 1)])
            place = box @ s % N
            hit = (place == 0) & (size > 0)
            # the nearest vector that the lattice takes for the mean: two lines alias when they differ by it
            nearest = float(size[hit].min()) if hit.any() else 2.0
            if best is None or nearest > best[0]:
                best = (nearest, s, N)
        assert best is not None
        lines = cls(index, best[1], best[2])
        folded = np.minimum(lines.place, N - lines.place)
        require(
            len(np.unique(folded)) == len(folded),
            "samples",
            samples,
            "some lines fall on one another; give more samples",
        )
        return lines

    @property
    def count(self) -> int:
        """L."""
        return len(self.index)

    @cached_property
    def place(self) -> Index:
        """(L,) harmonic of the discrete transform that each line is, 0 … N − 1."""
        return np.asarray(self.index @ self.steps % self.samples)

    @cached_property
    def _folded(self) -> tuple[Index, Index]:
        upper = self.place > self.samples // 2
        return np.where(upper, self.samples - self.place, self.place), np.flatnonzero(upper)

    def angles(self) -> Array:
        """(N, d) base angles of the samples, rad."""
        turns = np.outer(np.arange(self.samples), self.steps) % self.samples
        return np.asarray(2 * np.pi / self.samples * turns)

    def signals(self, z: Complex) -> Array:
        """Samples (N, m) of amplitudes (L, m)."""
        place, upper = self._folded
        spectrum = np.zeros((self.samples // 2 + 1, z.shape[1]), dtype=np.complex128)
        values = z * (0.5 * self.samples)
        values[0] *= 2.0
        if upper.size:
            values[upper] = values[upper].conj()
        spectrum[place] = values
        return np.asarray(scipy.fft.irfft(spectrum, self.samples, axis=0))

    def amplitudes(self, signal: Array) -> Complex:
        """Amplitudes (L, m) of samples (N, m)."""
        place, upper = self._folded
        z = np.asarray(scipy.fft.rfft(signal, axis=0))[place] * (2.0 / self.samples)
        z[0] *= 0.5
        if upper.size:
            z[upper] = z[upper].conj()
        return np.asarray(z)

    def finer(self, factor: int) -> Lines:
        """The same lines of one base on so many times the samples."""
        return Lines(self.index, self.steps, self.samples * factor)

    def moved(self, z: Complex, lines: Lines, scale: int = 1) -> Complex:
        """Amplitudes of these lines as amplitudes of others, whose orders are `scale` times as high."""
        known = {tuple(scale * n): row for n, row in zip(self.index, z, strict=True)}
        out = np.zeros((lines.count, z.shape[1]), dtype=np.complex128)
        for k, n in enumerate(lines.index):
            if tuple(n) in known:
                out[k] = known[tuple(n)]
            elif tuple(-n) in known:
                out[k] = known[tuple(-n)].conj()
        return out


def body_angles(turning: Turning, angles: Array) -> Array:
    """Angles (N, 4) of a bearing's bodies at angles (N, d) on the torus, rad."""
    out = np.zeros((len(angles), 4))
    for k, (base, multiple) in enumerate(zip(turning.base, turning.multiple, strict=True)):
        if base is not None:
            out[:, k] = multiple * angles[:, base]
    out[:, 0] += turning.angle0
    return out


def load_lines(system: System, bases: Bases, speed: float) -> Mapping[tuple[int, ...], Complex]:
    """Force (n,) of every line that loads drive on the torus: Re f e^{i n·θ}, N."""
    d = len(bases.bases)
    found: dict[tuple[int, ...], Complex] = {}

    def add(line: tuple[int, ...], force: Array | Complex) -> None:
        found[line] = np.asarray(found.get(line, np.zeros(system.n)) + force, dtype=np.complex128)

    for load in system.loads:
        if load.kind == "constant":
            add((0,) * d, load.p_cos)
            continue
        # p_cos cos θ + p_sin sin θ = Re (p_cos − i p_sin) e^{iθ}
        ratio, omega = (1.0, 0.0) if load.kind == "rotating" else (0.0, load.omega)
        base = next(
            j
            for j, b in enumerate(bases.bases)
            if (ratio and b.ratio and _multiple(ratio, b.ratio))
            or (omega and b.omega and _multiple(omega, b.omega))
        )
        b = bases.bases[base]
        n = round(ratio / b.ratio if ratio else omega / b.omega)
        size = speed**2 if load.kind == "rotating" else 1.0
        line = tuple(n if j == base else 0 for j in range(d))
        add(line, np.asarray(size * (load.p_cos - 1j * load.p_sin)))
    return found
