"""Radiation resistance over a band of frequencies: solved at a few, between them by polynomials.

Each octave has panels of its own, and Clenshaw and Curtis's points, which nest: 5, 9, 17, 33, 65. R/f² is
smooth in f, and the polynomial through it converges geometrically: twice the points square its error. So the
departure e of the polynomial through every second point tells the error of that through all: 4 e² at
most, seen on bodies before one another, whose echoes swing most (2.3e-2 fell to 7.7e-4, .23 to .054). Its
largest over an octave held in three octaves of other distances, where it was 3 to 36 times the error; at a
single frequency near one solved twice it may be too low, by 1.7 dB at 9 points an octave, .43 at 17.
"""

from __future__ import annotations

import logging
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, fields, replace
from pathlib import Path

import numpy as np

from bearingdyn.kept_arrays import read_arrays, write_arrays
from bearingdyn.notice import RepairedResistance, UnsureInterpolation, warn
from bearingdyn.progress import Progress
from bearingdyn.short_repr import short
from bearingdyn.sound.field import pressure_at
from bearingdyn.sound.radiation import Radiation, below_resonances, solve
from bearingdyn.sound.radiators import Radiators, digest
from bearingdyn.types import Array, Complex

log = logging.getLogger(__name__)

LEVELS = (5, 9, 17, 33, 65)
TOLERANCE = 0.05  # dB of the estimate, at which no further frequencies are solved; above, a word of warning
THREADS = 2
VERSION = 3  # of what a stored octave holds, and of the numbers in it
NEGATIVE = 1e-4  # of the largest eigenvalue: less is the discretisation's own error


@dataclass(frozen=True, eq=False)
class Octave:
    """Radiation resistance solved in one octave.

    Parameters
    ----------
    low, high
        Its ends, Hz.
    nodes
        Frequencies solved at (j,), Hz, ascending.
    resistance
        (j, n, n) symmetric, N s/m.
    pressure
        (j, p, n) at the microphones per unit of velocity, without the phase of the way from each body, Pa s/m
    size, panels
        Wanted side of the panels, m, and how many there are.
    repaired
        Largest eigenvalue taken off, relative to the largest; 0: none that counts.
    """

    low: float
    high: float
    nodes: Array
    resistance: Array
    pressure: Complex
    size: float
    panels: int
    repaired: float = 0.0

    __repr__ = short

    def weights(self, f: Array, level: int | None = None) -> Array:
        """Of the nodes in the polynomial for R at f, (f, j); `level`: by that many of the nodes alone."""
        step = 1 if level is None else (len(self.nodes) - 1) // (level - 1)
        some = np.arange(0, len(self.nodes), step)
        x = self.nodes[some]
        # Clenshaw and Curtis's barycentric weights: alternating, halved at the ends
        b = (-1.0) ** np.arange(x.size)
        b[[0, -1]] *= 0.5
        d = f[:, None] - x
        exact = d == 0.0
        w = np.where(exact.any(axis=1)[:, None], exact, b / np.where(exact, 1.0, d))
        found = np.zeros((f.size, len(self.nodes)))
        found[:, some] = w / w.sum(axis=1, keepdims=True)
        return found

    def power(self, f: Array, velocity: Complex) -> tuple[Array, Array]:
        """½ vᴴ R v and its error (f,), dB, of velocities (f, n) at frequencies (f,) of the octave."""
        # one quadratic form a node: v* R_j v / f_j²
        parts = np.vstack([velocity.real, velocity.imag])
        forms = np.stack([np.einsum("fa,fa->f", parts, parts @ R) for R in self.resistance], axis=1)
        forms = 0.5 * (forms[: f.size] + forms[f.size :]) / self.nodes**2
        best = f**2 * (forms * self.weights(f)).sum(axis=1)
        rough = f**2 * (forms * self.weights(f, (len(self.nodes) + 1) // 2)).sum(axis=1)
        return best, _difference(best, rough)

    def force(self, f: Array, velocity: Complex) -> Complex:
        """R v (f, n) of velocities (f, n) at frequencies (f,) of the octave, N."""
        w = self.weights(f) * (f[:, None] / self.nodes) ** 2
        return np.asarray(sum(w[:, j : j + 1] * (velocity @ R) for j, R in enumerate(self.resistance)))

    def shares(self, f: Array, velocity: Complex, blocks: Sequence[slice]) -> Array:
        """What each of the blocks of coordinates gives, ½ Re v_b* (R v)_b, (f, blocks)."""
        each = 0.5 * (velocity.conj() * self.force(f, velocity)).real
        return np.stack([each[:, block].sum(axis=1) for block in blocks], axis=1)

    def matrix(self, f: float) -> Array:
        """R at a frequency, (n, n)."""
        w = self.weights(np.array([f]))[0] * (f / self.nodes) ** 2
        return np.asarray(np.tensordot(w, self.resistance, 1))


def _difference(best: Array, rough: Array) -> Array:
    """Error of a power, dB, from that of every second point; 0 where there is none at all."""
    tiny = np.finfo(float).tiny
    e = np.abs(rough - best) / (np.abs(best) + tiny)
    return np.where(best > 0, 10.0 * np.log10(1.0 + 4.0 * e**2), 0.0)


def octaves(low: float, high: float) -> list[tuple[float, float]]:
    """Octaves of a radiation resistance, Hz, from below `low` to `high`, the highest first."""
    found = [(0.5 * high, high)]
    while found[-1][0] > low:
        found.append((0.5 * found[-1][0], found[-1][0]))
    return found


def solved_octave(
    radiators: Radiators,
    low: float,
    high: float,
    *,
    density: float,
    sound_speed: float,
    microphones: Array,
    element_size: float | None = None,
    cache: Path | None = None,
    tell: Progress | None = None,
) -> Octave:
    """Radiation resistance of bodies in one octave, from the folder `cache` where it is known.

    Parameters
    ----------
    radiators
        The bodies.
    low, high
        Ends of the octave, Hz.
    density, sound_speed
        Of the medium, kg/m³ and m/s.
    microphones
        (p, 3), m.
    element_size
        Wanted side of the panels, m; None: by the wavelength.
    cache
        Folder of octaves solved before, by the hash of what they depend on.
    tell
        Told of the frequencies solved.

    Returns
    -------
    Octave
        Resistances at the frequencies solved, and pressures at the microphones.
    """
    size = element_size or radiators.size(sound_speed / high)
    facts = np.array([low, high, density, sound_speed, size, VERSION, *LEVELS, TOLERANCE])
    name = f"radiation-{digest(facts, microphones)[:16]}-{radiators.fingerprint()[:32]}.arrays"
    if cache is not None and (known := _read(cache / name)) is not None:
        _warn(known)
        return known
    surface, rows = radiators.surface(size)
    below = below_resonances(surface, high, sound_speed)

    def at(f: float) -> tuple[Array, Complex]:
        found = solve(surface, rows, f, density=density, sound_speed=sound_speed, coarse=True, below=below)
        return found.resistance, _heard(found, radiators, microphones)

    done: dict[float, tuple[Array, Complex]] = {}
    for level in LEVELS:
        nodes = _nodes(low, high, level)
        fresh = [f for f in nodes.tolist() if f not in done]
        with ThreadPoolExecutor(THREADS) as pool:
            for f, one in zip(fresh, pool.map(at, fresh), strict=True):
                done[f] = one
                if tell is not None:
                    tell(len(done), level)
        R = np.array([done[f][0] for f in nodes.tolist()])
        p = np.array([done[f][1] for f in nodes.tolist()])
        octave = Octave(low, high, nodes, R, p, size, len(surface.faces))
        if level > LEVELS[0] and _unsure(octave) <= TOLERANCE:
            break
    octave = _repaired(octave)
    _warn(octave)
    if cache is not None:
        _write(cache / name, octave)
    log.info("%d panels, %d frequencies from %.4g to %.4g Hz", octave.panels, len(octave.nodes), low, high)
    return octave


def _nodes(low: float, high: float, level: int) -> Array:
    """Clenshaw and Curtis's points; those of one level are bitwise among those of the next."""
    finest = LEVELS[-1] - 1
    i = np.arange(level) * (finest // (level - 1))
    return np.asarray(0.5 * (low + high) - 0.5 * (high - low) * np.cos(np.pi * i / finest))


def _unsure(octave: Octave) -> float:
    """Largest error, dB, of single coordinates and of some mixed ones."""
    n = octave.resistance.shape[1]
    scale = 1.0 / np.sqrt(np.maximum(np.abs(np.einsum("jaa->a", octave.resistance)), np.finfo(float).tiny))
    mixed = np.random.default_rng(1).standard_normal((8, n)) * scale
    probes = np.vstack([np.diag(scale), mixed])
    forms = np.einsum("va,jab,vb->jv", probes, octave.resistance, probes, optimize=True)
    forms = forms / octave.nodes[:, None] ** 2
    # motions that the skin does not take part in have nothing to radiate
    alive = forms.max(axis=0) > 1e-9 * forms.max()
    rough = octave.weights(octave.nodes, (len(octave.nodes) + 1) // 2) @ forms
    return float(_difference(forms[:, alive], rough[:, alive]).max())


def _heard(found: Radiation, radiators: Radiators, microphones: Array) -> Complex:
    """Pressures at the microphones (p, n), each body's with the phase of its way taken off."""
    if not len(microphones):
        return np.zeros((0, found.shapes.shape[1]), dtype=np.complex128)
    return np.asarray(pressure_at(found, microphones) / _ways(radiators, microphones, found.wave_number))


def _ways(radiators: Radiators, microphones: Array, k: float) -> Complex:
    """exp(−ikr) over the way from the middle of each coordinate's body to each microphone, (p, n)."""
    columns = []
    for skin, place in zip(radiators.skins, radiators.places, strict=True):
        r = np.linalg.norm(microphones - (skin.points.mean(axis=0) + place), axis=1)
        columns.append(np.repeat(np.exp(-1j * k * r)[:, None], skin.rows.shape[1], axis=1))
    return np.hstack(columns)


def heard(octave: Octave, radiators: Radiators, f: Array, microphones: Array, sound_speed: float) -> Complex:
    """Resistance's neighbour: pressure at microphones per unit of velocity, (f, p, n), Pa s/m.

    Parameters
    ----------
    octave
        What was solved.
    radiators
        The bodies it was solved for.
    f
        Frequencies (f,) of the octave, Hz.
    microphones
        (p, 3), m.
    sound_speed
        m/s.
    """
    smooth = np.tensordot(octave.weights(f), octave.pressure, 1)
    ways = np.array([_ways(radiators, microphones, 2 * np.pi * one / sound_speed) for one in f])
    return np.asarray(smooth * ways)


def _repaired(octave: Octave) -> Octave:
    """Negative eigenvalues set to zero."""
    R, worst = octave.resistance.copy(), 0.0
    for j, one in enumerate(R):
        own = np.abs(np.diag(one))
        scale = 1.0 / np.sqrt(np.maximum(own, 1e-30 * max(own.max(), 1e-300)))
        w, Q = np.linalg.eigh(scale[:, None] * one * scale)
        if w[0] < 0.0:
            worst = max(worst, -float(w[0] / w[-1]))
            Q = Q / scale[:, None]
            R[j] = one - (Q[:, w < 0] * w[w < 0]) @ Q[:, w < 0].T
    return replace(octave, resistance=R, repaired=worst)


def _warn(octave: Octave) -> None:
    """A word on what an octave holds, whether solved now or before."""
    at = f"between {octave.low:.4g} and {octave.high:.4g} Hz the radiation"
    if not _unsure(octave) <= TOLERANCE:
        warn(
            f"{at} solved at {len(octave.nodes)} frequencies is known to {_unsure(octave):.2g} dB between "
            f"them; the result's interpolation_error says where",
            UnsureInterpolation,
        )
    if octave.repaired > NEGATIVE:
        warn(
            f"{at} resistance of {octave.panels} panels had motions of negative power, {octave.repaired:.1e} "
            f"of the largest; they were set to zero",
            RepairedResistance,
        )


FIELDS = tuple(field.name for field in fields(Octave))


def _write(path: Path, octave: Octave) -> None:
    write_arrays(path, {name: getattr(octave, name) for name in FIELDS})


def _read(path: Path) -> Octave | None:
    """What a file holds; None where there is none, or one that was cut."""
    a = read_arrays(path, FIELDS)
    if a is None:
        if path.exists():
            log.warning("%s cannot be read; the octave is solved again", path)
        return None
    return Octave(
        float(a["low"]), float(a["high"]), a["nodes"], a["resistance"], a["pressure"],
        float(a["size"]), int(a["panels"]), float(a["repaired"]),
    )  # fmt: skip
