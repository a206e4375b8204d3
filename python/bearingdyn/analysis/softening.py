"""The harmonic response of layers that soften with their own amplitude: one strain for each layer, iterated.

The linear system answers once, at the modulus of the isotherms, to the loads and to forces on the few
coordinates y of the softening layers. What the softening takes away is then a spring on these alone,

    y = (I + R Δ)⁻¹ y_linear,   Δ = 2 [G*(γ) − G_lin] on each layer,   γ² = Σ strain |y|²

with R the receptance of the coordinates, so that the strain of every layer is found from small matrices,
whatever the size of the system and however many levels of excitation are asked for.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
import scipy
from numpy.typing import NDArray

from bearingdyn import core
from bearingdyn.checks import positive, require
from bearingdyn.notice import BeyondSweep, warn
from bearingdyn.system import LayerTerm, System
from bearingdyn.types import Array, Complex, Index

if TYPE_CHECKING:
    from bearingdyn.analysis.linearised import Linear
    from bearingdyn.analysis.softening_zones import Zones

# below this strain the law is at its limit of small ones to 1e-12
NO_STRAIN = 1e-10
# every so many frequencies are solved first, and the others begin on a cubic spline through them
EVERY, FEWEST = 4, 4
# of ln γ, the last step; its square is what strains and motions lack then
CLOSE = 5e-6
# Newton converges in some five steps; a step in ln γ is cut to this, so that it cannot leap over a bend
STEPS, LEAP = 80, 0.7
# periods of the slowest motion that a march remembers: its ripple then moves the amplitude by 0.01 %
MEMORY = 5.0
SLACK = 1.02  # of the highest strain of a sweep, before a warning


@dataclass(frozen=True, eq=False)
class Softened:
    """Responses of layers that soften, over frequencies f, cases c and softening layers l.

    Attributes
    ----------
    x
        (f, k, c) motions of the rows asked for.
    strain
        (f, l, c) the strain that counts.
    modulus
        (f, l, c) G* at that strain, Pa.
    zone_strain
        (f, q, c) the strain of each zone; None where there are no zones.
    """

    x: Complex
    strain: Array
    modulus: Complex
    _linear: _Linear
    _loss: Complex
    zone_strain: Array | None = None

    def each(self) -> Complex:
        """Motions (f, k, i) under each force alone, of unit size, at the moduli of the first case."""
        of, first = self._linear, self._loss[:, :, :1]
        alone = np.linalg.solve(np.eye(of.R.shape[1]) + of.R * first.transpose(0, 2, 1), of.seen)
        return np.asarray(of.direct - of.by_layers @ (first * alone))


@dataclass(frozen=True, eq=False)
class _Linear:
    """The linear response of rows k and layer coordinates r to forces i, and to those coordinates' own.

    direct (f, k, i), by_layers (f, k, r), seen (f, r, i), R (f, r, r).
    """

    direct: Complex
    by_layers: Complex
    seen: Complex
    R: Complex


def softening_layers(system: System) -> list[int]:
    """Which of a response's layers soften."""
    return [k for k, layer in enumerate(system.layers) if layer.strain is not None]


def softened(
    state: Linear,
    omega: Array,
    force: Array,
    rows: Array,
    speed: float,
    drives: Sequence[Complex],
    tell: core.Progress | None = None,
    zones: Zones | None = None,
) -> list[Softened]:
    """Response of layers that soften: motions rows (k, n) under forces (i, n) driven together or alone.

    Parameters
    ----------
    state
        The linear system.
    omega
        (f,) rad/s.
    drives
        Of each level (f, i, c): how strongly, zero-to-peak and with its phase, each force acts in each case.
    zones
        Of the layers, each with a strain of its own; None: one strain for a layer.

    Raises
    ------
    ArithmeticError
        Where the strain is not found.
    """
    system = state.system
    soft = [system.layers[k] for k in softening_layers(system)]
    own = np.vstack([layer.L.T for layer in soft])
    modulus = state.moduli(omega)
    x = state.solve(omega, np.vstack([force, own]), np.vstack([rows, own]), speed, tell, modulus)
    k, i = len(rows), len(force)
    of = _Linear(x[:, :k, :i], x[:, :k, i:], x[:, k:, :i], x[:, k:, i:])
    ranks = [layer.L.shape[1] for layer in soft]
    linear = modulus[:, softening_layers(system), None]
    found, near = [], None
    for drive in drives:
        y, strain, change, near = _strains(omega, of.R, of.seen @ drive, soft, ranks, near)
        loss = np.repeat(2 * change, ranks, axis=1)  # (f, r, c)
        forces, of_zones = loss * y, None
        if zones is not None:
            y, forces, of_zones, strain = _by_zones(zones, omega, of.R, of.seen @ drive, y)
        moved = of.direct @ drive - np.einsum("fkr,frc->fkc", of.by_layers, forces)
        found.append(Softened(moved, strain, linear + change, of, loss, of_zones))
    return found


def _by_zones(
    zones: Zones, omega: Array, R: Complex, linear: Complex, y: Complex
) -> tuple[Complex, Complex, Array, Array]:
    """Motions and forces (f, r, c), strains of zones (f, q, c) and of layers (f, l, c), begun at y."""
    count, _, cases = y.shape
    flat = [np.ascontiguousarray(a.transpose(0, 2, 1)).reshape(count * cases, -1) for a in (linear, y)]
    found = zones.found(np.repeat(omega, cases), np.repeat(R, cases, axis=0), *flat)
    moved, forces = (a.reshape(count, cases, -1).transpose(0, 2, 1) for a in found[:2])
    of_zones, of_layers = (a.reshape(count, cases, -1).transpose(0, 2, 1) for a in found[2:])
    return moved, forces, of_zones, of_layers


def _strains(
    omega: Array,
    R: Complex,
    linear: Complex,
    soft: Sequence[LayerTerm],
    ranks: Sequence[int],
    near: Array | None,
) -> tuple[Complex, Array, Complex, Array]:
    """Layer coordinates y (f, r, c), strain, change of modulus and `near` (f, l, c) of the next level.

    near: ln γ less that of the linear motions, from which to begin.
    """
    count, _, cases = linear.shape
    weights = _weights(soft, ranks)

    def flat(values: Any) -> Any:  # (f, ·, c) to (e, ·)
        return values.transpose(0, 2, 1).reshape(count * cases, -1)

    def shaped(values: Any) -> Any:  # and back
        return values.reshape(count, cases, -1).transpose(0, 2, 1)

    alone, w = flat(linear), np.repeat(omega, cases)
    which = np.repeat(np.arange(count), cases)
    y, moving = alone.copy(), w > 0  # at rest there is no amplitude
    begin = _log_strain(y, weights)
    shift = np.zeros(begin.shape) if near is None else flat(near)
    coarse = which % EVERY == 0
    _iterate(w, R, which, alone, soft, begin, shift, y, moving & coarse)
    known = np.arange(0, count, EVERY)
    if known.size >= FEWEST:
        # over the frequencies the shift is smooth, so that the others begin where they almost are
        between = scipy.interpolate.make_interp_spline(known, shaped(shift)[known])(np.arange(count))
        shift[~coarse] = flat(between)[~coarse]
    _iterate(w, R, which, alone, soft, begin, shift, y, moving & ~coarse)
    change = np.zeros(begin.shape, dtype=np.complex128)
    change[moving], _ = _laws(w[moving], (begin + shift)[moving], soft)
    return shaped(y), shaped(_strain(y, weights)), shaped(change), shaped(shift)


def _iterate(
    w: Array,
    R: Complex,
    which: Index,
    alone: Complex,
    soft: Sequence[LayerTerm],
    begin: Array,
    shift: Array,
    y: Complex,
    chosen: NDArray[np.bool_],
) -> None:
    """Newton's iteration of the entries chosen (e,) in ln γ = begin + shift (e, l); shift and y are filled.

    Raises
    ------
    ArithmeticError
        Where it does not converge.
    """
    ranks = [layer.L.shape[1] for layer in soft]
    ends, weights = np.cumsum(ranks), _weights(soft, ranks)
    todo = np.flatnonzero(chosen)
    for _ in range(STEPS):
        if not todo.size:
            return
        at = begin[todo] + shift[todo]
        law, slope = _laws(w[todo], at, soft)
        there, moved = core.changed_layers(R, which[todo], alone[todo], law, slope, ends)
        step, close = _newton(there, moved, at, weights)
        shift[todo] = np.maximum(at + step, np.log(NO_STRAIN)) - begin[todo]
        # the last step is taken along the derivatives: what is left is of the second order in CLOSE
        y[todo[close]] = there[close] + np.einsum("el,elr->er", step[close], moved[close])
        todo = todo[~close]
    raise ArithmeticError(
        f"the strain of the layers was not found at {w[todo[0]] / 2 / np.pi:.6g} Hz: the response may "
        f"jump there from one amplitude to another; take a smaller amplitude"
    )


def _weights(soft: Sequence[LayerTerm], ranks: Sequence[int]) -> Array:
    """Weights (r, l) of |y|² in the γ² of each layer."""
    weights = np.zeros((sum(ranks), len(soft)))
    first = 0
    for k, (layer, rank) in enumerate(zip(soft, ranks, strict=True)):
        weights[first : first + rank, k] = layer.strain
        first += rank
    return weights


def _strain(y: Complex, weights: Array) -> Array:
    """γ (e, l) of coordinates y (e, r)."""
    return np.asarray(np.sqrt((y.real**2 + y.imag**2) @ weights))


def _log_strain(y: Complex, weights: Array) -> Array:
    """ln γ (e, l) of coordinates y (e, r), of the least strain where there is less."""
    return np.asarray(np.log(np.maximum(_strain(y, weights), NO_STRAIN)))


def _laws(w: Array, g: Array, soft: Sequence[LayerTerm]) -> tuple[Complex, Complex]:
    """Change of modulus (e, l) at ln γ = g (e, l), and its slope over it."""
    change, slope = np.zeros((2, *g.shape), dtype=np.complex128)
    for k, layer in enumerate(soft):
        gamma = np.exp(g[:, k])
        change[:, k] = layer.material.payne.change(w, gamma)
        slope[:, k] = layer.material.payne.slope(gamma)
    return change, slope


def _newton(y: Complex, moved: Complex, g: Array, weights: Array) -> tuple[Array, NDArray[np.bool_]]:
    """Newton's step (e, l) in ln γ, and where it is the last (e,).

    What is to vanish is ln γ(y) − g, of motions y (e, r) and their derivatives (e, l, r).
    """
    gamma = _strain(y, weights)
    held = gamma < NO_STRAIN
    gamma = np.maximum(gamma, NO_STRAIN)
    residual = np.log(gamma) - g
    power = (y.conj()[:, None, :] * moved).real @ weights  # (e, m, k): of layer k by layer m
    J = np.where(held[:, :, None], 0.0, power.transpose(0, 2, 1) / gamma[:, :, None] ** 2)
    J -= np.eye(g.shape[1])
    step = -np.linalg.solve(J, residual[..., None])[..., 0]
    size = np.abs(step).max(axis=1)
    return step * np.minimum(1.0, LEAP / np.maximum(size, 1e-300))[:, None], size < CLOSE


def warn_of_strain(system: System, strain: Array) -> None:
    """Warn of softening layers that vibrate beyond the sweep their law comes from; strain (…, l, c)."""
    for number, k in enumerate(softening_layers(system)):
        layer = system.layers[k]
        known = layer.material.payne.strains
        reached = float(strain[..., number, :].max())
        if known is not None and reached > SLACK * known[1]:
            warn(
                f"layer {layer.part!r} vibrates with up to {100 * reached:.3g} % shear strain, beyond the "
                f"{100 * known[1]:.3g} % of the strain sweep its law of softening comes from: there the law "
                f"extrapolates",
                BeyondSweep,
            )


def moduli_of(system: System, modulus: Complex) -> dict[tuple[str, int], Complex]:
    """In an analysis with softening, G* (f, c), Pa, of each rubber that softens, by part and place in it."""
    found, seen, number = {}, dict[str, int](), 0
    for layer in system.layers:
        place = seen.get(layer.part, 0)
        seen[layer.part] = place + 1
        if layer.strain is not None:
            found[layer.part, place] = modulus[:, number]
            number += 1
    return found


def layer_names(system: System) -> list[str]:
    """Softening results' names of layers: the part's, numbered where it has several."""
    parts = [system.layers[k].part for k in softening_layers(system)]
    return [
        name if parts.count(name) == 1 else f"{name} {parts[: k + 1].count(name)}"
        for k, name in enumerate(parts)
    ]


def memory_of(system: System, drive: float | tuple[Array, Array], memory: float | None) -> float | None:
    """Softening in a march: time, s, over which layers remember their amplitude; None where none softens.

    Unless given, it is five periods of the slowest thing that moves the system: the shaft at its slowest
    speed, and harmonic loads.

    Raises
    ------
    ValueError
        For a memory that is not positive, and where nothing tells it.
    """
    if not softening_layers(system):
        return None
    if memory is not None:
        return positive("memory", memory, "it must be a positive time, s")
    speeds = np.abs(drive[1]) if isinstance(drive, tuple) else np.array([abs(drive)])
    slowest = [float(w) for w in speeds if w > 0]
    slowest += [load.omega for load in system.loads if load.kind == "harmonic" and load.omega > 0]
    require(
        bool(slowest),
        "memory",
        memory,
        "a layer softens with its amplitude, and neither a speed nor a harmonic load tells over which time "
        "that is; give five periods of the slowest motion, s",
    )
    return MEMORY * 2 * np.pi / min(slowest)
