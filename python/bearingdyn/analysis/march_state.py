"""The state of a march: its fingerprint, its check, and the start that a user gives."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from bearingdyn import fingerprint
from bearingdyn.checks import numbers, require
from bearingdyn.material import Maxwell
from bearingdyn.plausible_ranges import plausible
from bearingdyn.system import Contacts, LayerTerm, System
from bearingdyn.types import Array

# a number of a state beyond this belongs to no machine in SI units, and its cube would still be finite
ABSURD = 1e100


@dataclass(frozen=True, eq=False)
class Beginning:
    """State in which a march begins.

    Parameters
    ----------
    x, v
        (n,) in the system's own coordinates.
    stress
        What the branches of the layers bear, layer by layer, branch by branch; None: nothing.
    films
        What the films of each bearing that remembers hold, (1 + 2 echoes, Z) each: what is pressed, then of
        each echo the real and imaginary parts; None: of balls that turn past what stands.
    """

    x: Array
    v: Array
    stress: Array | None
    films: tuple[Array, ...] | None = None


def system_hash(system: System, contacts: Contacts = "viscous") -> str:
    """Fingerprint of the system (32 hexadecimal digits) by which a march knows that a state is its own."""
    bearings = [(t.kernel(contacts).packed(), t.B) for t in system.bearings]
    return fingerprint.fingerprint(
        {
            "matrices": [system.M, system.C, system.G, system.K, system.N],
            "layers": [
                (t.L, *_law(t), *(() if t.strain is None else (t.strain, t.material.payne)))
                for t in system.layers
            ],
            # without memory as before there was any
            "bearings": [
                ({k: v for k, v in packed.items() if k != "echoes" or np.asarray(v).size}, B)
                for packed, B in bearings
            ],
            "loads": system.loads,
        }
    )


def _law(layer: LayerTerm) -> tuple[object, ...]:
    """What tells a layer's law: of a Maxwell model the branches, that other names of it count alike."""
    m = layer.material
    return (m.G0, m.G, m.tau, m.eta0) if isinstance(m, Maxwell) else (m,)


def check_state(field: str, state: Array) -> None:
    """Refuse a march's state with a number that is not finite, or too large for SI units: ValueError."""
    beyond = np.flatnonzero(~(np.abs(state) < ABSURD))
    if beyond.size:
        raise ValueError(
            f"{field} holds a state whose number {beyond[0]} is {state[beyond[0]]:g}; every number must be "
            f"finite and below {ABSURD:g}: the march had diverged, start anew with a smaller dt"
        )


def moved(system: System, x: Array, initial: Mapping[str, ArrayLike]) -> Array:
    """State that a march starts from: coordinates nearest to x (n,) that put every place where it is wanted.

    Raises
    ------
    ValueError
        For a place that does not exist, a displacement that is not finite, or places that cannot make these
        motions together.
    """
    given = {}
    for name, target in initial.items():
        count = len(system.rows(name))
        field, remedy = f"initial[{name!r}]", f"it must be {count} finite numbers, m and rad"
        given[name] = numbers(field, target, remedy)
        require(given[name].shape == (count,), field, target, remedy)
        for k, x_k in enumerate(given[name].tolist()):
            plausible("displacement" if k < 3 else "tilt", f"{field}[{k}]", x_k)
    rows = np.vstack([system.rows(name) for name in given])
    wanted = np.concatenate(list(given.values()))
    x = x + np.linalg.pinv(rows) @ (wanted - rows @ x)
    if np.abs(rows @ x - wanted).max() > 1e-9 * np.abs(wanted).max(initial=1e-9):
        raise ValueError(
            f"initial gives {sorted(initial)} motions that they cannot make together; leave one of them out"
        )
    return x
