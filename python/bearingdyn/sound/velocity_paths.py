"""Velocities of radiating parts taken apart: by the bearings they came through, and by real modes.

Without its bearings the structure has the dynamic stiffness D. As they move together, bearing k exerts the
force −B_kᵀ g_k on it, and so x = D⁻¹ (f − Σ B_kᵀ g_k): what each bearing moves is one term of that sum.
Real modes φ of the whole, its bearings linearised, form a basis: x = Σ φ_j (φ_jᵀ M x).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from bearingdyn.analysis import Input, Linear, part_velocities
from bearingdyn.bearing import NET
from bearingdyn.progress import Progress, told
from bearingdyn.short_repr import short
from bearingdyn.system import PartTerm, natural
from bearingdyn.types import Array, Complex


@dataclass(frozen=True, eq=False)
class VelocityPaths:
    """Paths of the velocities of parts under a unit of one input, and what they are the sum of.

    Parameters
    ----------
    total
        Of the parts' coordinates, one part after the other, (f, m), as the whole moves.
    direct
        What the input moves with no bearing there, (f, m).
    bearings
        What each bearing's force moves, (f, b, m); with `direct` it adds up to `total`.
    force
        Through each bearing from its inner ring to its outer ring, x, y, z (f, b, 3), per unit of the input.
    """

    total: Complex
    direct: Complex
    bearings: Complex
    force: Complex

    __repr__ = short


def velocity_paths(
    state: Linear,
    parts: Sequence[PartTerm],
    frequency: Array,
    given: Input,
    motion: Complex,
    speed: float,
    progress: Progress | bool | None = None,
) -> VelocityPaths:
    """Velocities of parts by the bearings they came through.

    Parameters
    ----------
    state
        The linearised system.
    parts
        Whose coordinates.
    frequency
        (f,), Hz, above 0.
    given
        The input.
    motion
        Of the whole system under it (f, n), as `whole_motion` gives it.
    speed
        Of the shaft, rad/s.
    progress
        As in `frequency_response`.
    """
    system, omega = state.system, 2.0 * np.pi * frequency
    B = system.B
    none = np.zeros((len(B), len(B)))
    apart = replace(state, K=none, C=none, balls=None)
    units = [Input(f"bearing coefficient {c}", row) for c, row in enumerate(B)]
    moved = np.concatenate(part_velocities(apart, parts, frequency, [given, *units], speed, progress), axis=1)
    total = np.concatenate([_velocity(term, motion, omega, given) for term in parts], axis=1)
    # iω turns the motion under a unit acceleration of the ground into that under a unit velocity
    across = (motion @ B.T) * (given.rate(omega) / (1j * omega))[:, None]
    forces = np.einsum("fab,fb->fa", state.dynamic(omega), across)
    found = np.zeros((omega.size, len(system.bearings), moved.shape[1]), dtype=np.complex128)
    net = np.zeros((omega.size, len(system.bearings), 3), dtype=np.complex128)
    at = 0
    for k, hung in enumerate(system.bearings):
        own = slice(at, at + len(hung.B))
        at += len(hung.B)
        found[:, k] = -np.einsum("fmc,fc->fm", moved[:, :, 1:][:, :, own], forces[:, own])
        for axis, term in enumerate(NET):
            if term in hung.series.terms:
                net[:, k, axis] = forces[:, own][:, hung.series.index(*term)]
    return VelocityPaths(total, moved[:, :, 0], found, net)


def whole_motion(
    state: Linear, frequency: Array, given: Input, speed: float, progress: Progress | bool | None = None
) -> Complex:
    """For velocity paths, the motion (f, n) of the whole system under a unit force or ground acceleration.

    Parameters
    ----------
    state
        The linearised system.
    frequency
        (f,), Hz, above 0.
    given
        The input.
    speed
        Of the shaft, rad/s.
    progress
        As in `frequency_response`.
    """
    with told(progress, "frequency") as tell:
        n = state.system.n
        return state.solve(2.0 * np.pi * frequency, given.force[None], np.eye(n), speed, tell)[:, :, 0]


def _velocity(term: PartTerm, motion: Complex, omega: Array, given: Input) -> Complex:
    """Of a part's coordinates (f, m)."""
    found = (motion @ term.place.T) * given.rate(omega)[:, None]
    return found if given.axis is None else np.asarray(found + term.rigid[:, given.axis])


def real_modes(state: Linear, frequency: float) -> tuple[Array, Array]:
    """For velocity paths by mode, real modes at the frequency whose moduli layers and bearings have, Hz.

    Parameters
    ----------
    state
        The linearised system.
    frequency
        Hz, of the stiffness of bearings and layers.

    Returns
    -------
    frequencies : Array
        (n,), Hz.
    shapes : Array
        (n, n), mass-normalised: a basis of all motions.
    """
    system, omega = state.system, np.array([2.0 * np.pi * frequency])
    storage = [float(np.real(t.material.complex_modulus(omega)[0])) for t in system.layers]
    bearings = state.dynamic(omega)[0].real
    K = system.stiffness(storage) + system.B.T @ (0.5 * (bearings + bearings.T)) @ system.B
    squares, shapes = natural(K, system.M)
    return np.sqrt(np.maximum(squares, 0.0)) / (2.0 * np.pi), shapes
