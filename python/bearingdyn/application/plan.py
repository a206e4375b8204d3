"""The plan of an application: its parts, joints and loads, and what follows from them without matrices."""

from __future__ import annotations

import math
from collections.abc import Sized

import numpy as np

from bearingdyn.application.channel import GROUND
from bearingdyn.application.free_motions import arm, rigid_shapes
from bearingdyn.application.joints import BearingJoint, Bush, Connection, LooseJoint, Support
from bearingdyn.application.loads import Load
from bearingdyn.application.part import Part
from bearingdyn.application.place import GRAVITY, Place
from bearingdyn.cms import HasRoundFaces, Raceway, RoundFace, Superelement
from bearingdyn.notice import FewOrders, warn
from bearingdyn.types import Array


class Plan:
    """The plan of an application: parts, joints, bearings and loads by name.

    `Application` writes it and checks what it writes; `bearingdyn.system.assemble` makes matrices of it.

    Attributes
    ----------
    parts
        Reduced parts, each at its temperature.
    reduced
        The same parts as they were reduced, before a temperature was put on them.
    sources
        What each part was reduced from.
    connections, supports, springs, bearings, fits
        Joints; supports by the interface they hold, bearings and fits by name.
    loads
        In the order in which they were given.
    free_interfaces
        Interfaces left unjoined on purpose, and raceways without balls.
    temperatures
        °C, of the parts that were given one.
    unjudged
        Bearings by name, and connections, that were joined with fits=False.
    """

    def __init__(self) -> None:
        self.parts: dict[str, Superelement] = {}
        self.reduced: dict[str, Superelement] = {}
        self.sources: dict[str, Part] = {}
        self.connections: list[Connection] = []
        self.supports: dict[Place, Support] = {}
        self.bearings: dict[str, BearingJoint] = {}
        self.fits: dict[str, LooseJoint] = {}
        self.loads: list[Load] = []
        self.free_interfaces: set[Place] = set()
        self.springs: list[Bush] = []
        self.temperatures: dict[str, float] = {}
        self.unjudged: set[str | Connection] = set()
        self._rigid: dict[str, Array | None] = {}

    def __repr__(self) -> str:
        told: dict[str, Sized] = {
            "parts": self.parts,
            "bearings": self.bearings,
            "joints": [*self.connections, *self.supports, *self.springs, *self.fits],
            "loads": self.loads,
        }
        listed = [f"{len(held)} {kind}" for kind, held in told.items()]
        names = f" ({', '.join([*self.parts, *self.bearings])})" if self.parts else ""
        return f"<Plan: {', '.join(listed)}{names}>"

    def copy(self) -> Plan:
        """A plan of the same parts, joints and loads, to which more can be written."""
        other = Plan()
        for name, value in vars(self).items():
            setattr(other, name, value.copy())
        return other

    def put(self, name: str, source: Part, element: Superelement) -> None:
        """Write a part, or another in the place of one."""
        self.sources[name], self.reduced[name], self.parts[name] = source, element, element
        self._rigid.pop(name, None)

    def names(self) -> list[str]:
        """All interfaces and points, "part.name"."""
        return [f"{p}.{n}" for p, e in self.parts.items() for n in (*e.interfaces, *e.outputs)]

    def check_new(self, kind: str, name: str) -> None:
        """Check the name of a new "part", "bearing" or "fit".

        Raises
        ------
        ValueError
            If it is no word, has a dot, is reserved or taken.
        """
        reserved = (str(GROUND), str(GRAVITY))
        if not isinstance(name, str) or not name or "." in name or name in reserved:
            raise ValueError(
                f'{kind} name is {name!r}; it must be a word without dots, and not "{GROUND}" or "{GRAVITY}"'
            )
        if name in self.parts or name in self.bearings or name in self.fits:
            raise ValueError(
                f"{kind} {name!r}: the name is taken; give each part, bearing and fit its own name"
            )

    def check_part(self, name: str) -> None:
        """Check that there is a part of that name; ValueError otherwise."""
        if not isinstance(name, str) or name not in self.parts:
            raise ValueError(f"{name!r} names no part of the application; there are {sorted(self.parts)}")

    def place(self, name: str | Place) -> Place:
        """A place by its name, on a part of the application.

        Raises
        ------
        ValueError
            If the name is not that of a place, or there is no such part.
        """
        place = Place.parse(name)
        if place.part not in self.parts:
            known = sorted(self.parts)
            raise ValueError(f"{str(place)!r} names no part of the application; there are {known}")
        return place

    def interface(self, name: str | Place) -> Place:
        """A place that is an interface, where six motions can be joined.

        Raises
        ------
        ValueError
            If there is no such interface; a raceway is not an interface.
        """
        place = self.place(name)
        element = self.parts[place.part]
        if place.name in element.raceways:
            raise ValueError(
                f"{place} is a raceway, not a rigid interface; it serves as the inner or outer of a bearing"
            )
        if place.name not in element.interfaces:
            raise ValueError(
                f"{place.part!r} has no interface {place.name!r}; it has {sorted(element.interfaces)}"
            )
        return place

    def interface_or_ground(self, name: str | Place) -> Place:
        """An interface, or GROUND for "ground"; ValueError for anything else."""
        return GROUND if isinstance(name, str | Place) and str(name) == str(GROUND) else self.interface(name)

    def raceway_or_interface(self, name: str | Place) -> Place:
        """A raceway, an interface, or GROUND for "ground"; ValueError for anything else."""
        if isinstance(name, str | Place) and str(name) == str(GROUND):
            return GROUND
        place = self.place(name)
        return self.interface(place) if self.raceway(place) is None else place

    def rows(self, place: Place) -> Array:
        """Motion (3 or 6, n) of a place by the coordinates of its part; ValueError if it is unknown."""
        return self.parts[place.part].rows(place.name)

    def raceway(self, place: Place) -> Raceway | None:
        """The raceway at a place; None where there is none."""
        return self.parts[place.part].raceways.get(place.name) if place.part in self.parts else None

    def faces(self, place: Place) -> tuple[RoundFace, ...]:
        """Cylinders that the part at a place offers there; none where it knows of none, or of the ground."""
        if place.part not in self.parts:
            return ()
        source = self.sources[place.part]
        # a squeezed or bonded part says more than its matrices; one of another's making may say less
        known = source if isinstance(source, HasRoundFaces) else self.parts[place.part]
        return known.round_faces().get(place.name, ())

    def check_raceway(self, joint: BearingJoint) -> None:
        """Check a new bearing against the raceway it is hung in, if it is hung in one.

        Raises
        ------
        ValueError
            If the raceway was made for another arm, or carries a bearing already.

        Warns
        -----
        FewOrders
            If the raceway moves by fewer orders than the bearing has balls.
        """
        name, arm = joint.name, joint.bearing.arm
        found = [(place, race) for place in (joint.inner, joint.outer) if (race := self.raceway(place))]
        taken = {place for b in self.bearings.values() for place in (b.inner, b.outer)}
        for place, raceway in found:
            if raceway.Z not in (None, joint.bearing.Z):
                raise ValueError(
                    f"bearing {name!r} has {joint.bearing.Z} balls and {place} was made for {raceway.Z}; "
                    f"make the ring with bearing="
                )
            if not math.isclose(raceway.arm, arm, rel_tol=1e-9):
                raise ValueError(
                    f"bearing {name!r} has its arm at {arm:.9g} m and {place} at {raceway.arm:.9g} m; "
                    f"make the ring with arm=bearing.arm"
                )
            if place in taken:
                raise ValueError(
                    f"bearing {name!r}: {place} carries a bearing already; give each its own raceway"
                )
            order, Z = max(n for _, n, _ in raceway.series.terms), joint.bearing.Z
            if order < Z:
                warn(
                    f"bearing {name!r} has {Z} balls, whose loads bend the ring by cos {Z}ψ, and {place} "
                    f"moves by orders to {order}: make the ring with bearing=, or with order={Z + 1}",
                    FewOrders,
                )
        if len({raceway.series for _, raceway in found}) > 1:
            raise ValueError(
                f"bearing {name!r}: {joint.inner} and {joint.outer} move by other orders; make both rings "
                f"with the same order="
            )

    def check_fit(self, joint: LooseJoint) -> None:
        """Check a new loose fit against the raceways it joins.

        Raises
        ------
        ValueError
            If one is in use already, or a flexible bore does not fit the ring: by its orders, or its radius.
        """
        name = joint.name
        for place in (joint.ring, joint.bore):
            if place in self.raceways_used():
                raise ValueError(f"fit {name!r}: {place} is in use already; give each its own")
        ring, bore = self.raceway(joint.ring), self.raceway(joint.bore)
        if ring is None or bore is None:
            return
        if ring.series != bore.series:
            orders = [max(n for _, n, _ in race.series.terms) for race in (ring, bore)]
            raise ValueError(
                f"fit {name!r}: {joint.ring} moves by orders to {orders[0]} and {joint.bore} to {orders[1]}; "
                f"make the bore, a Groove or a FlexibleBore, with order={orders[0]}"
            )
        if not math.isclose(ring.arm, bore.arm, rel_tol=0.01):
            raise ValueError(
                f"fit {name!r}: {joint.ring} has a radius of {ring.arm:.6g} m and {joint.bore} of "
                f"{bore.arm:.6g} m; make the bore with that radius, a Groove with arm={ring.arm:.6g}"
            )

    def raceways_used(self) -> set[Place]:
        """Raceways that carry balls, or that a loose fit joins, among the other ends of bearings."""
        ends = {place for b in self.bearings.values() for place in (b.inner, b.outer)}
        ends |= {place for f in self.fits.values() for place in (f.ring, f.bore)}
        return {place for place in ends if self.raceway(place)}

    def partners(self) -> dict[Place, Place]:
        """Which interface each connected one moves with."""
        return {c.a: c.b for c in self.connections} | {c.b: c.a for c in self.connections}

    def turning_parts(self) -> set[str]:
        """Parts that turn with the shaft: those with gyroscopic forces, and what is connected to them."""
        turning = {name for name, element in self.parts.items() if np.any(element.G)}
        pairs = [{c.a.part, c.b.part} for c in self.connections]
        while True:
            joined = {name for pair in pairs if pair & turning for name in pair}
            if joined <= turning:
                return turning
            turning |= joined

    def ring_speeds(self, joint: BearingJoint) -> tuple[float, float]:
        """Speeds of inner and outer ring of a bearing over that of the shaft.

        A ring turns where its part is known to turn. What the bearing says itself is taken as long as it does
        not contradict; where nothing is known, the inner ring turns.

        Raises
        ------
        ValueError
            For a bearing that says of a ring another speed than that of the turning part it is hung on.
        """
        known = self.turning_parts()
        turns = [end.part in known for end in (joint.inner, joint.outer)]
        told = joint.bearing.turning
        if told is None:
            return (float(turns[0]), float(turns[1])) if any(turns) else joint.bearing.ring_speeds
        for ring, end, turning, speed in zip(
            ("inner", "outer"), (joint.inner, joint.outer), turns, joint.bearing.ring_speeds, strict=True
        ):
            if turning and speed != 1.0:
                raise ValueError(
                    f"bearing {joint.name!r}: turning is {told!r}, and its {ring} ring is hung on {end}, "
                    f"which turns with the shaft; leave turning out, or hang the rings the other way round"
                )
        return joint.bearing.ring_speeds

    def joined_parts(self, part: str) -> set[str]:
        """A part and all parts that rigid connections join to it."""
        found, pairs = {part}, [{c.a.part, c.b.part} for c in self.connections]
        while True:
            more = {name for pair in pairs if pair & found for name in pair}
            if more <= found:
                return found
            found |= more

    def check_joints(self) -> None:
        """Check that every interface and raceway is used or declared free.

        Raises
        ------
        ValueError
            Naming the interface and what to do with it, or if there are no parts.
        """
        if not self.parts:
            raise ValueError("the application has no parts; add some with app.add(name, part)")
        used = {place for pair in self._joined() for place in pair}
        used |= {place for c in self.connections for place in (c.a, c.b)}
        used |= self.supports.keys() | self.free_interfaces
        for part, element in self.parts.items():
            for place in (Place(part, name) for name in element.raceways):
                if place not in used:
                    raise ValueError(
                        f"raceway {place} carries no balls; name it as a ring of a bearing, or declare "
                        f'app.free("{place}")'
                    )
            for place in (Place(part, name) for name in element.interfaces):
                if place not in used:
                    raise ValueError(
                        f"interface {place} is not connected; connect it, ground it, hang a bearing on it, "
                        f'or declare app.free("{place}")'
                    )

    def mass(self, part: str) -> float | None:
        """Mass of a part by its translation along y, kg; None where it has no rigid motion of its own."""
        R = self.rigid_shapes(part)
        return None if R is None else float(R[:, 1] @ self.parts[part].M @ R[:, 1])

    def rigid_shapes(self, part: str) -> Array | None:
        """Coordinates (n, 6) of a part that moves as a rigid body with its first interface.

        None for a part without interfaces, or one whose own stiffness resists a rigid motion.
        """
        if part not in self._rigid:
            self._rigid[part] = rigid_shapes(self.parts[part])
        return self._rigid[part]

    def positions(self) -> dict[str, Array]:
        """Where interfaces, points and raceways stand, (3,) m, from the first interface of the first part.

        Arms follow from the rigid motions of each part; joined interfaces, springs and bearings stand at one
        place. Left out are parts without rigid motion, and those that nothing joins to the first.
        """
        arms: dict[str, dict[str, Array]] = {}
        for part, element in self.parts.items():
            R = self.rigid_shapes(part)
            if R is not None:
                names = (*element.interfaces, *element.outputs)
                arms[part] = {name: arm(element.rows(name), R) for name in names}
                for name, raceway in element.raceways.items():
                    centre = np.linalg.pinv(raceway.series.rigid(raceway.arm)) @ raceway.rows
                    arms[part][name] = arm(centre, R)
        pairs = [(c.a, c.b) for c in self.connections] + self._joined()
        origin = {part: np.zeros(3) for part in list(arms)[:1]}
        left = [pair for pair in pairs if GROUND not in pair]
        while True:
            for known, new in [*left, *((b, a) for a, b in left)]:
                ready = known.part in origin and new.part not in origin
                if ready and known.name in arms[known.part] and new.name in arms.get(new.part, {}):
                    known_at = origin[known.part] + arms[known.part][known.name]
                    origin[new.part] = known_at - arms[new.part][new.name]
                    break
            else:
                break
        return {f"{p}.{name}": origin[p] + a for p in origin for name, a in arms[p].items()}

    def _joined(self) -> list[tuple[Place, Place]]:
        """The two ends of each spring, bearing and fit."""
        pairs = [(s.a, s.b) for s in self.springs]
        pairs += [(b.inner, b.outer) for b in self.bearings.values()]
        return pairs + [(f.ring, f.bore) for f in self.fits.values()]
