"""Which way round the shaft whirls in a mode."""

from __future__ import annotations

import numpy as np

from bearingdyn.application import Place
from bearingdyn.system import System
from bearingdyn.types import Array, Complex

# kinetic energy of the lateral motion, of the whole: below it a mode does not whirl, it turns or stretches
LATERAL = 1e-8


def whirl(system: System, shapes: Complex) -> Array:
    """Whirl (m,) of modes, −1 backward … 1 forward: of the turning parts, in shapes (m, n) e^{λt}, Im λ > 0.

    It is 2 Σ Im(x y*)/Σ(|x|² + |y|²) over the interfaces and outputs of those parts. Where they do not move
    sideways, as a rigid body that tilts about its centre, their tilts θx, θy take the place of x, y.
    """
    turning = set(system.turning)
    rows = [r for name, r in system.outputs.items() if not turning or Place.parse(name).part in turning]
    mass = np.abs(np.einsum("mi,ij,mj->m", shapes.conj(), system.M, shapes))
    found = np.zeros(len(shapes))
    for first, heavy in ((3, _tilting(system)), (0, float(np.abs(system.M).max()))):
        both = [np.array([r[k] for r in rows if len(r) > k]) for k in (first, first + 1)]
        x, y = (r.reshape(-1, system.n) @ shapes.T for r in both)
        size = (np.abs(x) ** 2 + np.abs(y) ** 2).sum(axis=0)
        turns = 2.0 * (x * y.conj()).imag.sum(axis=0)
        np.divide(turns, size, out=found, where=size * heavy > LATERAL * mass)
    return found


def _tilting(system: System) -> float:
    """The largest moment of inertia of a part about x or y of its first interface, kg m²; 0 if unknown."""
    inertia = [np.einsum("ik,ij,jk->k", t.rigid[:, 3:5], t.element.M, t.rigid[:, 3:5]) for t in system.parts]
    return float(np.nanmax(inertia, initial=0.0)) if inertia else 0.0
