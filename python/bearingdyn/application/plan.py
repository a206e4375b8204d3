"""The notes of an application, and what can be read from them."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from bearingdyn.application.notes import GROUND, Bush, Connection, HungBearing, HungFit, Load, Part, Support
from bearingdyn.application.rigid import arm, rigid_shapes
from bearingdyn.cms import Raceway, Superelement
from bearingdyn.types import Array


class Plan:
    """Parts, joints, bearings and loads as they were noted, by name."""

    def __init__(self) -> None:
        self.parts: dict[str, Superelement] = {}
        self.reduced: dict[str, Superelement] = {}
        self.sources: dict[str, Part] = {}
        self.connections: list[Connection] = []
        self.supports: dict[str, Support] = {}
        self.bearings: dict[str, HungBearing] = {}
        self.fits: dict[str, HungFit] = {}
        self.loads: list[Load] = []
        self.free_interfaces: set[str] = set()
        self.springs: list[Bush] = []
        self.temperatures: dict[str, float] = {}
        self._rigid: dict[str, Array | None] = {}

    def names(self) -> list[str]:
        """All interfaces and points, "part.name"."""
        return [f"{p}.{n}" for p, e in self.parts.items() for n in (*e.interfaces, *e.outputs)]

    def turning_parts(self) -> set[str]:
        """Parts that turn with the shaft: those with gyroscopic forces, and what is connected to them."""
        turning = {name for name, element in self.parts.items() if np.any(element.G)}
        pairs = [{c.a.partition(".")[0], c.b.partition(".")[0]} for c in self.connections]
        while True:
            joined = {name for pair in pairs if pair & turning for name in pair}
            if joined <= turning:
                return turning
            turning |= joined

    def check_joints(self) -> None:
        """Every interface must be used or declared free.

        Raises ValueError naming the interface and what to do with it.
        """
        if not self.parts:
            raise ValueError("the application has no parts; add some with app.add(name, part)")
        used = {i for c in self.connections for i in (c.a, c.b)} | set(self.supports)
        used |= {i for s in self.springs for i in (s.a, s.b)}
        used |= {i for f in self.fits.values() for i in (f.ring, f.bore)}
        used |= {i for b in self.bearings.values() for i in (b.inner, b.outer)} | self.free_interfaces
        for part, element in self.parts.items():
            for raceway in element.raceways:
                if f"{part}.{raceway}" not in used:
                    raise ValueError(
                        f"raceway {part}.{raceway} carries no balls; name it as the outer of a bearing, or "
                        f'declare app.free("{part}.{raceway}")'
                    )
            for interface in element.interfaces:
                if f"{part}.{interface}" not in used:
                    raise ValueError(
                        f"interface {part}.{interface} is not connected; connect it, ground it, hang a "
                        f'bearing on it, or declare app.free("{part}.{interface}")'
                    )

    def mass(self, part: str) -> float | None:
        """Mass by the rigid translation along y, kg; None for a part without rigid motion of its own."""
        R = self.rigid_shapes(part)
        return None if R is None else float(R[:, 1] @ self.parts[part].M @ R[:, 1])

    def raceway(self, name: str) -> Raceway | None:
        """The raceway of that name, "ring.raceway"; None where the name is no raceway."""
        part, _, rest = name.partition(".")
        return self.parts[part].raceways.get(rest) if part in self.parts else None

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
        pairs = [(c.a, c.b) for c in self.connections] + [(s.a, s.b) for s in self.springs]
        pairs += [(b.inner, b.outer) for b in self.bearings.values()]
        pairs += [(f.ring, f.bore) for f in self.fits.values()]
        origin = {part: np.zeros(3) for part in list(arms)[:1]}
        left = [pair for pair in pairs if GROUND not in pair]
        while True:
            for near, far in [*left, *((b, a) for a, b in left)]:
                (known, at), (part, there) = (name.partition(".")[::2] for name in (near, far))
                ready = known in origin and part not in origin
                if ready and at in arms[known] and there in arms.get(part, {}):
                    origin[part] = origin[known] + arms[known][at] - arms[part][there]
                    break
            else:
                break
        return {f"{p}.{name}": origin[p] + a for p in origin for name, a in arms[p].items()}

    def _split(self, name: str) -> tuple[str, str]:
        part, dot, rest = name.partition(".")
        if not dot or part not in self.parts:
            raise ValueError(f"{name!r} names no part of the application; there are {sorted(self.parts)}")
        return part, rest

    def _interface(self, name: str) -> None:
        part, rest = self._split(name)
        known: Sequence[str] = sorted(self.parts[part].interfaces)
        if rest in self.parts[part].raceways:
            raise ValueError(
                f"{name} is a raceway, not a rigid interface; it serves as the outer of a bearing"
            )
        if rest not in known:
            raise ValueError(f"{part!r} has no interface {rest!r}; it has {list(known)}")

    def _rows(self, name: str) -> Array:
        part, rest = self._split(name)
        return self.parts[part].rows(rest)
