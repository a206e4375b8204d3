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
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from bearingdyn import core
from bearingdyn.checks import positive, require
from bearingdyn.notice import BeyondSweep, warn
from bearingdyn.system import LayerTerm, System
from bearingdyn.types import Array, Complex

if TYPE_CHECKING:
    from bearingdyn.analysis.linearised import Linear

# below this strain the law is at its limit of small ones to 1e-12
NO_STRAIN = 1e-10
# of ln γ, before the last step is judged; motions then hold to some 1e-10
CLOSE = 1e-9
# Newton converges in some five steps; a step in ln γ is cut to this, so that it cannot leap over a bend
STEPS, LEAP = 80, 0.7
SLOPE = 1e-4  # of ln γ, over which the law's slope is taken
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
    each
        (f, k, i) motions under each force alone, of unit size, at the moduli of the first case.
    strain
        (f, l) each case, (f, l, c): the strain that counts.
    change
        (f, l, c) G* less that of the isotherms, Pa.
    """

    x: Complex
    each: Complex
    strain: Array
    change: Complex


def softening_layers(system: System) -> list[int]:
    """Which layers soften."""
    return [k for k, layer in enumerate(system.layers) if layer.strain is not None]


def softened(
    state: Linear,
    omega: Array,
    force: Array,
    rows: Array,
    speed: float,
    drives: Sequence[Complex],
    tell: core.Progress | None = None,
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

    Raises
    ------
    ArithmeticError
        Where the strain is not found.
    """
    system = state.system
    soft = [system.layers[k] for k in softening_layers(system)]
    own = np.vstack([layer.L.T for layer in soft])
    x = state.solve(omega, np.vstack([force, own]), np.vstack([rows, own]), speed, tell)
    k, i = len(rows), len(force)
    direct, by_layers = x[:, :k, :i], x[:, :k, i:]
    seen, R = x[:, k:, :i], x[:, k:, i:]
    ends = np.cumsum([0, *(layer.L.shape[1] for layer in soft)])
    parts = [slice(a, b) for a, b in pairwise(ends.tolist())]
    found = []
    for drive in drives:
        linear = seen @ drive
        y, strain, change = _strains(omega, R, linear, soft, parts)
        loss = np.repeat(2 * change, np.diff(ends), axis=1)  # (f, r, c)
        first = loss[:, :, :1]
        alone = np.linalg.solve(np.eye(R.shape[1]) + R * first.transpose(0, 2, 1), seen)
        found.append(
            Softened(
                direct @ drive - by_layers @ (loss * y),
                direct - by_layers @ (first * alone),
                strain,
                change,
            )
        )
    return found


def _strains(
    omega: Array, R: Complex, linear: Complex, soft: Sequence[LayerTerm], parts: Sequence[slice]
) -> tuple[Complex, Array, Complex]:
    """Layer coordinates y (f, r, c), strain (f, l, c) and change of modulus (f, l, c)."""
    count, rank, cases = linear.shape
    alone = linear.transpose(0, 2, 1).reshape(-1, rank)
    receptance = np.repeat(R, cases, axis=0)
    w = np.repeat(omega, cases)
    y = alone.copy()
    g = np.log(np.maximum(_strain(y, soft, parts), NO_STRAIN))
    change = np.zeros(g.shape, dtype=np.complex128)
    todo = np.flatnonzero(w > 0)  # at rest there is no amplitude
    for _ in range(STEPS):
        if not todo.size:
            break
        change[todo], slope = _laws(w[todo], g[todo], soft)
        y[todo], residual, J = _evaluate(
            receptance[todo], alone[todo], change[todo], slope, g[todo], soft, parts
        )
        near = np.abs(residual).max(axis=1) < CLOSE
        step = -np.linalg.solve(J, residual[..., None])[..., 0]
        step *= np.minimum(1.0, LEAP / np.maximum(np.abs(step).max(axis=1), 1e-300))[:, None]
        g[todo] = np.maximum(g[todo] + step, np.log(NO_STRAIN))
        todo = todo[~near]
    if todo.size:
        raise ArithmeticError(
            f"the strain of the layers was not found at {w[todo[0]] / 2 / np.pi:.6g} Hz: the response may "
            f"jump there from one amplitude to another; take a smaller amplitude"
        )
    strain = _strain(y, soft, parts)
    shaped = (count, cases, -1)
    return (
        y.reshape(shaped).transpose(0, 2, 1),
        strain.reshape(shaped).transpose(0, 2, 1),
        change.reshape(shaped).transpose(0, 2, 1),
    )


def _strain(y: Complex, soft: Sequence[LayerTerm], parts: Sequence[slice]) -> Array:
    """γ (e, l) of coordinates y (e, r)."""
    squares = y.real**2 + y.imag**2
    each = [squares[:, part] @ np.asarray(t.strain) for t, part in zip(soft, parts, strict=True)]
    return np.asarray(np.sqrt(np.stack(each, axis=1)))


def _laws(w: Array, g: Array, soft: Sequence[LayerTerm]) -> tuple[Complex, Complex]:
    """Change of modulus (e, l) at ln γ = g (e, l), and its slope over it."""
    change, slope = np.zeros((2, *g.shape), dtype=np.complex128)
    for k, layer in enumerate(soft):
        law, at = layer.material.payne, g[:, k]
        change[:, k] = law.change(w, np.exp(at))
        ahead, back = (law.change(w, np.exp(at + d)) for d in (SLOPE, -SLOPE))
        slope[:, k] = (ahead - back) / (2 * SLOPE)
    return change, slope


def _evaluate(
    R: Complex,
    alone: Complex,
    change: Complex,
    slope: Complex,
    g: Array,
    soft: Sequence[LayerTerm],
    parts: Sequence[slice],
) -> tuple[Complex, Array, Array]:
    """y (e, r) at moduli assumed, ln γ(y) − g (e, l), and the derivative of it (e, l, l)."""
    ranks = [part.stop - part.start for part in parts]
    inverse = np.linalg.inv(np.eye(R.shape[1]) + R * np.repeat(2 * change, ranks, axis=1)[:, None, :])
    y = np.einsum("eij,ej->ei", inverse, alone)
    gamma = _strain(y, soft, parts)
    held = gamma < NO_STRAIN
    residual = np.log(np.maximum(gamma, NO_STRAIN)) - g
    J = np.zeros((len(g), len(soft), len(soft)))
    for m, part in enumerate(parts):
        pull = np.einsum("eij,ej->ei", R[:, :, part], 2 * slope[:, m, None] * y[:, part])
        moved = -np.einsum("eij,ej->ei", inverse, pull)
        for k, (layer, mine) in enumerate(zip(soft, parts, strict=True)):
            power = (y[:, mine].conj() * moved[:, mine]).real @ np.asarray(layer.strain)
            J[:, k, m] = np.where(held[:, k], 0.0, power / np.maximum(gamma[:, k], NO_STRAIN) ** 2)
        J[:, m, m] -= 1.0
    return y, residual, J


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


def moduli_of(system: System, omega: Array, change: Complex) -> dict[tuple[str, int], Complex]:
    """G* (f, c), Pa, of each softening rubber, by its part and its place among that part's rubbers."""
    found, seen, number = {}, dict[str, int](), 0
    for layer in system.layers:
        place = seen.get(layer.part, 0)
        seen[layer.part] = place + 1
        if layer.strain is not None:
            linear = np.asarray(layer.material.complex_modulus(omega))
            found[layer.part, place] = linear[:, None] + change[:, number]
            number += 1
    return found


def layer_names(system: System) -> list[str]:
    """Names of the softening layers: the part's, numbered where it has several rubbers."""
    parts = [system.layers[k].part for k in softening_layers(system)]
    return [
        name if parts.count(name) == 1 else f"{name} {parts[: k + 1].count(name)}"
        for k, name in enumerate(parts)
    ]


def memory_of(system: System, drive: float | tuple[Array, Array], memory: float | None) -> float | None:
    """Time, s, over which layers that soften remember their amplitude in a march; None where none does.

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
