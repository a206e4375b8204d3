"""What a harmonic analysis is asked for: forces and ground motions in, motions and forces out."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np

from bearingdyn.application import COMPONENTS, GROUND, QUANTITIES, Channel, Place
from bearingdyn.bearing import NET
from bearingdyn.material import answer_of
from bearingdyn.system import PartTerm, SpringTerm, System
from bearingdyn.types import Array, Complex

# G* (f, i), Pa, of rubbers that soften, by part and place among its rubbers
Moduli: TypeAlias = Mapping[tuple[str, int], Complex]


@dataclass(frozen=True, eq=False)
class Input:
    """An input of a harmonic analysis: a unit force, or a unit acceleration of the ground along an axis.

    Parameters
    ----------
    name
        The channel.
    force
        On the system (n,), N; −M R for the ground.
    axis
        Of the ground's motion; None for a force.
    part, load
        Part that a force acts on, and the force (m,) in the coordinates of that part.
    """

    name: str
    force: Array
    axis: int | None = None
    part: str = ""
    load: Array | None = None

    @property
    def turning(self) -> bool:
        """Whether it is a moment."""
        return Channel.parse(self.name).is_rotation

    def rate(self, omega: Array) -> Complex:
        """Velocity over motion x of the system under it, (f,) at omega (f,): iω, or (iω)² for the ground.

        A unit of the ground's is one of its velocity; x is what one of its acceleration, iω, drives.
        """
        return np.asarray((1j * omega) ** (1 if self.axis is None else 2))

    @classmethod
    def of(cls, system: System, name: str) -> Input:
        """An input by its channel.

        Raises
        ------
        ValueError
            For an unknown channel, and for the ground under a part that holds itself.
        """
        channel = _without_quantity(name)
        axis = channel.index
        if not channel.of_ground:
            force, place = system.row(channel), Place.parse(channel.at)
            for term in system.parts:
                if term.name == place.part:
                    own = term.element.rows(place.name)[axis]
                    return cls(name, force, part=place.part, load=own)
            return cls(name, force, part=place.part)
        if axis is None or axis >= 3:
            known = list(COMPONENTS[:3])
            raise ValueError(f"{name!r}: the ground moves along {known}, not {channel.component!r}")
        if system.inertia is None:
            raise ValueError(f"{name!r}: the system was made without an application and knows no ground")
        for term in system.parts:
            if np.isnan(term.rigid).any():
                raise ValueError(
                    f"{name!r}: part {term.name!r} has no rigid motion of its own (no interface, or a "
                    f"stiffness that holds it); base motion needs parts that are free by themselves"
                )
        return cls(name, -system.inertia[:, axis], axis)


@dataclass(frozen=True, eq=False)
class Output:
    """An output of a harmonic analysis: a motion row @ x, or a force, the sum of all that act on something.

    Parameters
    ----------
    name
        The channel.
    row
        (n,), of a motion.
    parts
        Of each part, which of its coordinates is in balance with the force.
    springs
        Of each spring, the share (k,) of each of its forces.
    bearings
        Of each bearing, the index of its first coefficient among all, its B, and the share (coefs,) of each
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
        return Channel.parse(self.name).is_rotation

    def unit(self, quantity: str) -> str:
        """Unit of a force, or of a motion's displacement, velocity or acceleration."""
        channel = Channel.parse(self.name)
        return channel.force_unit if self.is_force else channel.motion_unit(quantity)

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

        Raises
        ------
        ValueError
            For an unknown channel; says what there is.
        """
        channel = _without_quantity(name)
        if not channel.is_force:
            return cls(name, system.row(channel))
        on_ground, place, k = channel.quantity == "reaction", channel.at, channel.index
        first = 0
        for hung in system.bearings:
            if hung.name == place and not on_ground:
                term = NET[k] if k is not None and k < 3 else None
                if term not in hung.series.terms:
                    offered = [
                        f"force.{c}" for c, t in zip("xyz", NET, strict=True) if t in hung.series.terms
                    ]
                    raise ValueError(f"{name!r}: bearing {place!r} offers {', '.join(offered)}")
                return cls(name, bearings=((first, hung.B, np.eye(len(hung.B))[hung.series.index(*term)]),))
            first += len(hung.B)
        owner = next((term for term in system.parts if f"{place}.".startswith(f"{term.name}.")), None)
        if owner is None:
            raise ValueError(
                f"{name!r}: {place!r} is neither a bearing nor an interface of the system; there are "
                f"bearings "
                f"{[b.name for b in system.bearings]} and parts {[t.name for t in system.parts]}"
            )
        interfaces = {str(Place(owner.name, n)): index for n, index in owner.element.interfaces.items()}
        if place not in interfaces:
            known = sorted(owner.element.interfaces)
            raise ValueError(f"{name!r}: forces pass through interfaces; {owner.name!r} has {known}")
        if k is None:
            raise ValueError(f"{name!r}: there are {list(COMPONENTS)}, not {channel.component!r}")
        if not on_ground:
            return cls(name, parts=((owner, int(interfaces[place][k])),))
        supports = [s for s in system.springs if s.name == f"{place}–{GROUND}"]
        if supports:
            return cls(name, springs=tuple((s, np.eye(6)[k]) for s in supports))
        for joint in system.held:
            if place in joint:
                return cls._held(system, name, joint, k)
        raise ValueError(f"{name!r}: {place!r} is no interface that the ground holds")

    @classmethod
    def _held(cls, system: System, name: str, joint: tuple[str, ...], k: int) -> Output:
        """Component k of the force on the ground from everything fastened to a joint of interfaces."""
        parts = [
            (term, int(term.element.interfaces[place.name][k]))
            for term in system.parts
            for place in map(Place.parse, joint)
            if term.name == place.part
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
        self,
        x: Complex,
        omega: Array,
        speed: float,
        bearings: Complex,
        inputs: Sequence[Input],
        moduli: Moduli | None = None,
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
            total += _balance(term, index, taken(len(term.place)), omega, speed, inputs, moduli or {})
        for spring, share in self.springs:
            total += sprung(share * spring.stiffness, share * spring.damping, taken(len(spring.across)))
        for first, B, share in self.bearings:
            own = slice(first, first + len(B))
            total += np.einsum("k,fkl,fli->fi", share, bearings[:, own, own], taken(len(B)), optimize=True)
        return total


def _without_quantity(name: str) -> Channel:
    """A channel by its name, of which the analysis says whether displacement or a rate of it is meant."""
    channel = Channel.parse(name)
    if channel.quantity in QUANTITIES:
        raise ValueError(
            f"{name!r} names a quantity, which holds for all outputs here; leave .{channel.quantity} out and "
            f"give quantity={channel.quantity!r}"
        )
    return channel


def _balance(
    term: PartTerm,
    k: int,
    x: Complex,
    omega: Array,
    speed: float,
    inputs: Sequence[Input],
    moduli: Moduli,
) -> Complex:
    """Force (f, i) that a part exerts through its coordinate k, from its motions (f, n, i)."""
    e = term.element
    D = (
        -(omega[:, None] ** 2) * e.M[k]
        + 1j * omega[:, None] * (e.C[k] + speed * e.G[k])
        + (e.K[k] + speed * np.asarray(e.N)[k])
    )
    sheared = np.zeros((omega.size, x.shape[2]), dtype=np.complex128)
    for place, soft in enumerate(e.viscoelastic):
        if (term.name, place) in moduli:
            sheared += 2.0 * moduli[term.name, place] * np.einsum("k,fki->fi", soft.H[k], x)
            continue
        G = answer_of(soft.material, omega)
        D = D + 2.0 * G[:, None] * soft.H[k]
    force = -np.einsum("fk,fki->fi", D, x) - sheared
    for i, given in enumerate(inputs):
        if given.axis is not None:
            force[:, i] -= e.M[k] @ term.rigid[:, given.axis]
        elif given.part == term.name and given.load is not None:
            force[:, i] += given.load[k]
    return np.asarray(force)


def requested(outputs: Sequence[Output], n: int) -> Array:
    """All rows (k, n) that the outputs of a harmonic analysis need, stacked."""
    return np.vstack([np.zeros((0, n)), *(o.rows for o in outputs)])


def recovered(
    outputs: Sequence[Output],
    inputs: Sequence[Input],
    x: Complex,
    omega: Array,
    speed: float,
    power: int,
    bearings: Complex,
    moduli: Moduli | None = None,
) -> Complex:
    """The outputs (f, o, i) of a harmonic analysis from the motions (f, k, i) of the `requested` rows.

    power: 0, 1, 2 for displacement, velocity, acceleration. bearings: their dynamic stiffness
    (f, coefs, coefs), `Linear.dynamic`. moduli: of rubbers that soften, where x is of
    such.
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
            response[:, k] = scale * output.force(own, omega, speed, bearings, inputs, moduli)
            continue
        response[:, k] = scale * own[:, 0] * (rate**power)[:, None]
        for i, given in enumerate(inputs):
            if given.axis is not None and Channel.parse(output.name).index == given.axis:
                response[:, k, i] += 1.0
    return response
