"""What a harmonic analysis is asked for: forces and ground motions in, motions and forces out."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from bearingdyn.application import COMPONENTS, GROUND
from bearingdyn.bearing.raceway_series import NET
from bearingdyn.system import RATES, PartTerm, SpringTerm, System, component_of
from bearingdyn.types import Array, Complex


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
    """A motion row @ x, or a force: the sum of what parts, springs and bearings put on something.

    parts: a part, and which of its coordinates is balanced. springs: a spring, and the share (k,) of each of
    its forces. bearings: the first coefficient of a bearing among all, its B, and the share (coefs,) of each
    of its forces.
    """

    name: str
    row: Array | None = None
    parts: tuple[tuple[PartTerm, int], ...] = ()
    springs: tuple[tuple[SpringTerm, Array], ...] = ()
    bearings: tuple[tuple[int, Array, Array], ...] = ()

    @property
    def is_force(self) -> bool:
        """Whether it is a force or moment."""
        return self.row is None

    @property
    def turning(self) -> bool:
        """Whether it is a rotation or moment."""
        return component_of(self.name) in COMPONENTS[3:]

    def unit(self, quantity: str) -> str:
        """Unit of a force, or of a motion's displacement, velocity or acceleration."""
        if self.is_force:
            return "N m" if self.turning else "N"
        return ("rad" if self.turning else "m") + RATES[quantity]

    @property
    def rows(self) -> Array:
        """Motions (k, n) that it is computed from."""
        if self.row is not None:
            return self.row[None]
        return np.vstack(
            [
                *(term.place for term, _ in self.parts),
                *(spring.across for spring, _ in self.springs),
                *(B for _, B, _ in self.bearings),
            ]
        )

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
        first = 0
        for hung in system.bearings:
            if hung.name == place and not on_ground:
                term = NET[COMPONENTS.index(component)] if component in COMPONENTS[:3] else None
                if term not in hung.series.terms:
                    offered = [
                        f"force.{c}" for c, t in zip("xyz", NET, strict=True) if t in hung.series.terms
                    ]
                    raise ValueError(f"{name!r}: bearing {place!r} offers {', '.join(offered)}")
                return cls(name, bearings=((first, hung.B, np.eye(len(hung.B))[hung.series.index(*term)]),))
            first += len(hung.B)
        head, _, interface = place.partition(".")
        owner = next((term for term in system.parts if term.name == head), None)
        if owner is not None and interface not in owner.element.interfaces:
            known = sorted(owner.element.interfaces)
            raise ValueError(f"{name!r}: forces pass through interfaces; {head!r} has {known}")
        if owner is None:
            raise ValueError(
                f"{name!r}: {place!r} is no bearing and no interface of the system; there are bearings "
                f"{[b.name for b in system.bearings]} and parts {[t.name for t in system.parts]}"
            )
        if component not in COMPONENTS:
            raise ValueError(f"{name!r}: there are {list(COMPONENTS)}, not {component!r}")
        k = COMPONENTS.index(component)
        if not on_ground:
            return cls(name, parts=((owner, int(owner.element.interfaces[interface][k])),))
        supports = [s for s in system.springs if s.name == f"{place}–{GROUND}"]
        if supports:
            return cls(name, springs=tuple((s, np.eye(6)[k]) for s in supports))
        for joint in system.held:
            if place in joint:
                return cls._held(system, name, joint, k)
        raise ValueError(f"{name!r}: {place!r} is no interface that the ground holds")

    @classmethod
    def _held(cls, system: System, name: str, joint: tuple[str, ...], k: int) -> Output:
        """Component k of what all that is fastened to a joint of interfaces puts on the ground there."""
        parts = [
            (term, int(term.element.interfaces[rest][k]))
            for term in system.parts
            for head, _, rest in (interface.partition(".") for interface in joint)
            if term.name == head
        ]
        # the force g on a relative motion J u of the joint pulls it by −Jᵀ g
        springs = [(s, -s.ends[i][:, k]) for s in system.springs for i in joint if i in s.ends]
        firsts = np.cumsum([0, *(len(b.B) for b in system.bearings)]).tolist()
        bearings = [
            (first, b.B, -b.ends[i][:, k])
            for first, b in zip(firsts, system.bearings, strict=False)
            for i in joint
            if i in b.ends
        ]
        return cls(name, None, tuple(parts), tuple(springs), tuple(bearings))

    def force(
        self, x: Complex, omega: Array, speed: float, K: Array, C: Array, inputs: Sequence[Input]
    ) -> Complex:
        """Force (f, i) from the motions x (f, k, i), per unit force or ground acceleration."""
        total = np.zeros((omega.size, x.shape[2]), dtype=np.complex128)
        at = 0

        def taken(count: int) -> Complex:
            nonlocal at
            at += count
            return x[:, at - count : at]

        def sprung(stiff: Array, damped: Array, motion: Complex) -> Complex:
            rates = stiff + 1j * omega[:, None] * damped
            return np.asarray(np.einsum("fk,fki->fi", rates, motion))

        for term, index in self.parts:
            total += _balance(term, index, taken(len(term.place)), omega, speed, inputs)
        for spring, share in self.springs:
            total += sprung(share * spring.stiffness, share * spring.damping, taken(len(spring.across)))
        for first, B, share in self.bearings:
            own = slice(first, first + len(B))
            total += sprung(share @ K[own, own], share @ C[own, own], taken(len(B)))
        return total


def _balance(
    term: PartTerm, k: int, x: Complex, omega: Array, speed: float, inputs: Sequence[Input]
) -> Complex:
    """Force (f, i) that a part puts on what joins its coordinate k, from its motions (f, n, i)."""
    e = term.element
    D = (
        -(omega[:, None] ** 2) * e.M[k]
        + 1j * omega[:, None] * (e.C[k] + speed * e.G[k])
        + (e.K[k] + speed * np.asarray(e.N)[k])
    )
    for soft in e.viscoelastic:
        G = np.asarray(soft.material.complex_modulus(omega))
        D = D + 2.0 * G[:, None] * soft.H[k]
    force = -np.einsum("fk,fki->fi", D, x)
    for i, given in enumerate(inputs):
        if given.axis is not None:
            force[:, i] -= e.M[k] @ term.rigid[:, given.axis]
        elif given.part == term.name and given.load is not None:
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
        count = len(output.rows)
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
