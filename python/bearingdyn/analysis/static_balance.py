"""The balance of a structure and its balls: the minimum of their energy, in few coordinates.

At rest, an elastic mode of the structure gives way by e = (f − Bᵀg)/ω² to the load f and the few bearing
forces g. The state therefore lies in the span of the motions that cost nothing, of f/ω² and of Bᵀ/ω²: some
twenty coordinates, whatever the structure's, and no approximation.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import scipy.linalg

from bearingdyn import core
from bearingdyn.analysis.bearing_state import BearingState
from bearingdyn.application import COMPONENTS, Place
from bearingdyn.bearing import NoBalance, minimum
from bearingdyn.system import BearingTerm, Contacts, Modulus, System
from bearingdyn.types import Array

# ω², 1/s², of the test spring on free motions: of the order of a rotor's on its bearings, else of no effect
HOLD = 1e6
# of the largest singular value of the bearings' coefficients on the motions that cost nothing: round-off
UNFELT = 1e-9


def diagonal_blocks(blocks: Sequence[Array]) -> Array:
    """Blocks of the matrix in which a static balance is written: square matrices along its diagonal."""
    n = sum(len(b) for b in blocks)
    out = np.zeros((n, n))
    at = 0
    for b in blocks:
        out[at : at + len(b), at : at + len(b)] = b
        at += len(b)
    return out


@dataclass(frozen=True, eq=False)
class Statics:
    """A structure whose static balance is sought, in its modes: squares (n,) ω², held (n, n) test springs."""

    system: System
    T: Array
    squares: Array
    held: Array
    B: Array
    load: Array

    @classmethod
    def of(cls, system: System, modulus: Modulus) -> Statics:
        """The structure with its layers at a modulus, under its constant loads."""
        squares, T = system.basis(modulus)
        B = system.B @ T
        still = np.flatnonzero(squares <= 0.0)
        held = np.zeros((system.n, system.n))
        if still.size:
            free = scipy.linalg.null_space(B[:, still], rcond=UNFELT) if len(B) else np.eye(still.size)
            held[np.ix_(still, still)] = HOLD * (free @ free.T)
        return cls(system, T, squares, held, B, T.T @ system.static_load())

    def balance(
        self, bearings: Sequence[BearingTerm], start: Array | None = None, contacts: Contacts = "viscous"
    ) -> tuple[Array, dict[str, BearingState]]:
        """Modal coordinates (n,) at rest, and every bearing there.

        Films that remember stand as viscous ones do under the mean load of the loaded balls, and a little off
        under others. Raises ArithmeticError that names the body which found no support.
        """
        kernels = [t.kernel(contacts) for t in bearings]
        sizes = np.cumsum([0, *(len(k.order) for k in kernels)])
        rest = np.zeros(sizes[-1])

        def press(z: Array) -> list[tuple[Array, Array, Array, Array]]:
            return [
                core.bearing_force(k, z[a:b], rest[a:b], k.angle0, 0.0)
                for k, a, b in zip(kernels, sizes, sizes[1:], strict=False)
            ]

        def energy(q: Array, B: Array, structure: Array) -> tuple[float, Array, Array, float]:
            pressed = press(B @ q)
            stored, total = 0.5 * float(q @ structure @ q), 0.0
            for kernel, (_, _, _, loads) in zip(kernels, pressed, strict=True):
                stored += kernel.stored(loads)
                total += float(loads.sum())
            g = np.concatenate([np.zeros(0), *(p[0] for p in pressed)])
            K = diagonal_blocks([p[1] for p in pressed])
            return stored, structure @ q + B.T @ g, structure + B.T @ K @ B, total

        # the first trust region, in modal amplitude: how far the load moves the body in a microsecond's push
        expected = max([1e-6, *(k.h0 + abs(k.e0) / k.A for k in kernels)])
        radius = expected * float(np.sqrt(np.trace(self.system.M) / self.system.n))
        structure = np.diag(self.squares) + self.held
        basis = self._span()
        few, narrow = basis.T @ structure @ basis, self.B @ basis
        try:
            c = minimum(
                lambda c: energy(c, narrow, few),
                basis.T @ self.load,
                radius,
                None if start is None else basis.T @ start,
            )
            # in all coordinates: what round-off left, mostly nothing
            q = minimum(lambda q: energy(q, self.B, structure), self.load, radius, basis @ c)
        except NoBalance as error:
            z = basis @ error.z if error.z.size == basis.shape[1] else error.z
            raise ArithmeticError(f"{lost(self.system, self.T @ z)}; {error}") from None
        z = self.B @ q
        return q, {
            term.name: BearingState(z[a:b], *p, series=term.series)
            for term, p, a, b in zip(bearings, press(z), sizes, sizes[1:], strict=False)
        }

    def _span(self) -> Array:
        """Orthonormal basis (n, k) of what can move at rest: modes that cost nothing, and Λ⁻¹ [f, Bᵀ]."""
        still = self.squares <= 0.0
        forces = np.column_stack([self.load, self.B.T])[~still] / self.squares[~still, None]
        sizes = np.linalg.norm(forces, axis=0)
        elastic = np.linalg.qr(forces[:, sizes > 0.0] / sizes[sizes > 0.0])[0]
        basis = np.zeros((self.system.n, int(still.sum()) + elastic.shape[1]))
        basis[np.flatnonzero(still), np.arange(int(still.sum()))] = 1.0
        basis[~still, int(still.sum()) :] = elastic
        return basis


def lost(system: System, x: Array) -> str:
    """Which body moved furthest where a static balance failed, in a motion x (n,), and in which direction."""
    best = ("the structure", 0, 0.0)
    for name, rows in system.outputs.items():
        motion = rows[:3] @ x
        k = int(np.argmax(np.abs(motion)))
        if abs(motion[k]) > abs(best[2]):
            best = (repr(Place.parse(name).part), k, float(motion[k]))
    name, k, size = best
    return f"{name} finds no support along {COMPONENTS[k]}: it has moved by {size:.3g} m there"
