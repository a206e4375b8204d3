"""The static state from which everything else starts."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from bearingdyn import core
from bearingdyn.application import Application
from bearingdyn.bearing.minimum import minimum
from bearingdyn.system import LoadTerm, System, assemble

Array = NDArray[np.float64]

# ω², 1/s², of the test spring on free motions: of the order of a rotor's on its bearings, else of no effect
HOLD = 1e6


@dataclass(frozen=True, eq=False)
class BearingState:
    """A bearing in the static state, linearised at rest.

    z (5,) relative raceway coefficients, m; g (5,) force on them, N; K, C (5, 5) tangents, N/m and N s/m;
    loads (Z,) of the balls, N.
    """

    z: Array
    g: Array
    K: Array
    C: Array
    loads: Array

    @property
    def radial_stiffness(self) -> float:
        """Mean of the two radial diagonal tangents, N/m."""
        return float(self.K[0, 0] + self.K[1, 1]) / 2


@dataclass(frozen=True, eq=False)
class Equilibrium:
    """A static state: x (n,) of the system, and every bearing by name.

    Layers carry their relaxed modulus G0. The free spin of shafts about z is left at zero.
    """

    system: System
    x: Array
    bearings: Mapping[str, BearingState]

    def displacement(self, name: str) -> Array:
        """Static motion of an interface or point, (6,) or (3,), m and rad."""
        return self.system.rows(name) @ self.x

    @property
    def bearing_K(self) -> Array:
        """Tangent stiffness of all bearings on their coefficients, block-diagonal, N/m."""
        return _diagonal([b.K for b in self.bearings.values()])

    @property
    def bearing_C(self) -> Array:
        """Tangent damping of all bearings on their coefficients, block-diagonal, N s/m."""
        return _diagonal([b.C for b in self.bearings.values()])

    def linearised(self) -> System:
        """The system about this state: bearings replaced by their tangents, constant loads left out."""
        s = self.system
        B = s.B
        return replace(
            s,
            K=s.K + B.T @ self.bearing_K @ B,
            C=s.C + B.T @ self.bearing_C @ B,
            bearings=(),
            loads=tuple(load for load in s.loads if load.kind != "constant"),
        )


def _diagonal(blocks: list[Array]) -> Array:
    n = sum(len(b) for b in blocks)
    out = np.zeros((n, n))
    at = 0
    for b in blocks:
        out[at : at + len(b), at : at + len(b)] = b
        at += len(b)
    return out


def equilibrium(app: Application | System, angle: float = 0.0) -> Equilibrium:
    """Nonlinear static state under the constant loads, layers relaxed, the cage at `angle` (rad).

    The energy of the relaxed structure and of the balls is convex; its minimum is found by Newton steps in a
    trust region, in modes of the structure, from the unloaded state.

    Raises ValueError where a body is free to move, ArithmeticError where no balance is found.
    """
    system = app if isinstance(app, System) else assemble(app)
    if not math.isfinite(angle):
        raise ValueError(f"angle is {angle}; the cage angle must be finite, in rad")
    # the angle stays with the system, so that what starts from here finds the balls where they are
    turned = tuple(
        replace(t, bearing=replace(t.bearing, angle0=t.bearing.angle0 + angle)) for t in system.bearings
    )
    system = replace(system, bearings=turned)
    modal, T = system.modal()
    # motions that nothing holds (the spin of shafts) are held here: no load drives them
    free = T.T @ system.M @ system.free_motions()
    structure = modal.stiffness() + HOLD * (free @ free.T)
    load = modal.static_load()
    B = modal.B
    kernels = [t.kernel() for t in modal.bearings]
    sizes = np.cumsum([0, *(len(k.order) for k in kernels)])
    still = [np.zeros(len(k.order)) for k in kernels]

    def press(z: Array) -> list[tuple[Array, Array, Array, Array]]:
        return [
            core.bearing_force(k, z[a:b], rest, k.angle0, 0.0)
            for k, a, b, rest in zip(kernels, sizes, sizes[1:], still, strict=False)
        ]

    def energy(q: Array) -> tuple[float, Array, Array, float]:
        pressed = press(B @ q)
        stored, held = 0.5 * float(q @ structure @ q), 0.0
        for kernel, (_, _, _, loads) in zip(kernels, pressed, strict=True):
            # ∫κ s^{3/2} ds = (2/5) F s, s = (F/κ)^{2/3}
            stored += float(0.4 * (loads * (loads / kernel.kappa) ** (2 / 3)).sum())
            held += float(loads.sum())
        g = np.concatenate([np.zeros(0), *(p[0] for p in pressed)])
        K = _diagonal([p[1] for p in pressed])
        return stored, structure @ q + B.T @ g, structure + B.T @ K @ B, held

    # the first trust region, in modal amplitude: how far the load moves the body in a microsecond's push
    expected = max(1e-6, *(k.h0 + abs(k.e0) / k.A for k in kernels)) if kernels else 1e-6
    q = minimum(energy, load, expected * np.sqrt(np.trace(system.M) / system.n))

    states = {}
    for term, p, a, b in zip(modal.bearings, press(B @ q), sizes, sizes[1:], strict=False):
        states[term.name] = BearingState((B @ q)[a:b], *p)
    return Equilibrium(system, T @ q, states)


def with_loads(system: System, loads: tuple[LoadTerm, ...]) -> System:
    """The system under other loads."""
    return replace(system, loads=loads)
