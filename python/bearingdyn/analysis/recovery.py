"""What a harmonic analysis is asked for: forces and ground motions in, motions and forces out."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from bearingdyn.application import COMPONENTS, GROUND
from bearingdyn.bearing.series import NET
from bearingdyn.system import PartTerm, System, component_of

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]


@dataclass(frozen=True, eq=False)
class Input:
    """A unit force, or a unit acceleration of the ground along an axis (0, 1, 2).

    force (n,): on the system, N, or −M R for the ground. part, load: the part a force acts on, and the force
    (m,) in its own coordinates.
    """

    name: str
    force: Array
    axis: int | None = None
    part: str = ""
    load: Array | None = None

    @property
    def turning(self) -> bool:
        """Whether it is a moment."""
        return component_of(self.name) in COMPONENTS[3:]

    @classmethod
    def of(cls, system: System, name: str) -> Input:
        """An input by its channel.

        Raises ValueError for an unknown one, or the ground under a part that holds itself.
        """
        place, _, component = name.rpartition(".")
        if place != GROUND:
            force = system.row(name)
            head, _, rest = place.partition(".")
            for term in system.parts:
                if term.name == head:
                    own = term.element.rows(rest)[COMPONENTS.index(component_of(name))]
                    return cls(name, force, part=head, load=own)
            return cls(name, force, part=head)
        if component not in COMPONENTS[:3]:
            raise ValueError(f"{name!r}: the ground moves along {list(COMPONENTS[:3])}, not {component!r}")
        if system.inertia is None:
            raise ValueError(f"{name!r}: the system was made without an application and knows no ground")
        for term in system.parts:
            if np.isnan(term.rigid).any():
                raise ValueError(
                    f"{name!r}: part {term.name!r} has no rigid motion of its own (no interface, or a "
                    f"stiffness that holds it); base motion needs parts that are free by themselves"
                )
        axis = COMPONENTS.index(component)
        return cls(name, -system.inertia[:, axis], axis)


@dataclass(frozen=True, eq=False)
class Output:
    """A motion, or a force through a bearing, a support or an interface, from the motions rows (k, n).

    bearing: (first, pick): the bearing's first coefficient among all, and pick (coefs,) of its force.
    part, index: the part whose coordinate `index` is balanced. spring: stiffness and damping of a support.
    """

    name: str
    rows: Array
    bearing: tuple[int, Array] | None = None
    part: PartTerm | None = None
    index: int = 0
    spring: tuple[float, float] | None = None

    @property
    def is_force(self) -> bool:
        """Whether it is a force or moment."""
        return self.bearing is not None or self.part is not None or self.spring is not None

    @property
    def turning(self) -> bool:
        """Whether it is a rotation or moment."""
        return component_of(self.name) in COMPONENTS[3:]

    @classmethod
    def of(cls, system: System, name: str) -> Output:
        """An output by its channel.

        Raises ValueError for an unknown one.
        """
        place, _, _ = name.rpartition(".")
        component = component_of(name)
        on_ground = place.startswith(f"{GROUND}.")
        if not on_ground and not place.endswith(".force"):
            return cls(name, system.row(name))
        place = place.removeprefix(f"{GROUND}.") if on_ground else place.removesuffix(".force")
        if on_ground:
            for support in system.springs:
                if support.name == f"{place}–{GROUND}" and component in COMPONENTS:
                    k = COMPONENTS.index(component)
                    law = (float(support.stiffness[k]), float(support.damping[k]))
                    return cls(name, support.across[k], spring=law)
            if place not in system.outputs or system.rows(place).any():
                raise ValueError(f"{name!r}: {place!r} is no interface that the ground holds")
        first = 0
        for hung in system.bearings:
            if hung.name == place:
                if component not in COMPONENTS[:3]:
                    raise ValueError(f"{name!r}: a bearing offers force.x, force.y and force.z")
                pick, net = np.zeros(len(hung.B)), NET[COMPONENTS.index(component)]
                if net in hung.series.terms:
                    pick[hung.series.index(*net)] = 1.0
                return cls(name, hung.B, (first, pick))
            first += len(hung.B)
        head, _, interface = place.partition(".")
        for term in system.parts:
            if term.name == head:
                known = sorted(term.element.interfaces)
                if interface not in known:
                    raise ValueError(f"{name!r}: forces pass through interfaces; {head!r} has {known}")
                if component not in COMPONENTS:
                    raise ValueError(f"{name!r}: there are {list(COMPONENTS)}, not {component!r}")
                index = term.element.interfaces[interface][COMPONENTS.index(component)]
                return cls(name, term.place, part=term, index=int(index))
        raise ValueError(
            f"{name!r}: {place!r} is no bearing and no interface of the system; there are bearings "
            f"{[b.name for b in system.bearings]} and parts {[t.name for t in system.parts]}"
        )

    def force(
        self, x: Complex, omega: Array, speed: float, K: Array, C: Array, inputs: Sequence[Input]
    ) -> Complex:
        """Force (f, i) from the motions x (f, k, i), per unit force or ground acceleration."""
        if self.bearing is not None:
            first, pick = self.bearing
            own = slice(first, first + len(pick))
            stiff, damped = pick @ K[own, own], pick @ C[own, own]
            return np.asarray(
                np.einsum("k,fki->fi", stiff, x) + 1j * omega[:, None] * np.einsum("k,fki->fi", damped, x)
            )
        if self.spring is not None:
            stiffness, damping = self.spring
            return np.asarray((stiffness + 1j * omega[:, None] * damping) * x[:, 0])
        assert self.part is not None
        e, k = self.part.element, self.index
        D = (
            -(omega[:, None] ** 2) * e.M[k]
            + 1j * omega[:, None] * (e.C[k] + speed * e.G[k])
            + (e.K[k] + speed * np.asarray(e.N)[k])
        )
        for term in e.viscoelastic:
            G = np.asarray(term.material.complex_modulus(omega))
            D = D + 2.0 * G[:, None] * term.H[k]
        force = -np.einsum("fk,fki->fi", D, x)
        for i, given in enumerate(inputs):
            if given.axis is not None:
                force[:, i] -= e.M[k] @ self.part.rigid[:, given.axis]
            elif given.part == self.part.name and given.load is not None:
                force[:, i] += given.load[k]
        return np.asarray(force)


def requested(outputs: Sequence[Output], n: int) -> Array:
    """All rows that the outputs need, one under another, (k, n)."""
    return np.vstack([np.zeros((0, n)), *(o.rows for o in outputs)])


def recovered(
    outputs: Sequence[Output],
    inputs: Sequence[Input],
    x: Complex,
    omega: Array,
    speed: float,
    power: int,
    K: Array,
    C: Array,
) -> Complex:
    """Response (f, o, i) from the motions x (f, k, i) of `requested` rows, per unit of each input.

    power: 0, 1, 2 for displacement, velocity, acceleration.
    """
    response = np.zeros((omega.size, len(outputs), len(inputs)), dtype=np.complex128)
    rate = 1j * omega
    # a ground input is of the quantity asked for: its acceleration is rate^(2 − power) of it
    scale = np.stack([rate ** (2 - power if i.axis is not None else 0) for i in inputs] or [rate], axis=1)[
        :, : len(inputs)
    ]
    at = 0
    for k, output in enumerate(outputs):
        count = 1 if output.rows.ndim == 1 else len(output.rows)
        own = x[:, at : at + count]
        at += count
        if output.is_force:
            response[:, k] = scale * output.force(own, omega, speed, K, C, inputs)
            continue
        response[:, k] = scale * own[:, 0] * (rate**power)[:, None]
        for i, given in enumerate(inputs):
            if given.axis is not None and component_of(output.name) == COMPONENTS[given.axis]:
                response[:, k, i] += 1.0
    return response
