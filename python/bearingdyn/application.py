"""An application: parts joined at rigid interfaces, bearings hung between them, loads applied.

The builder only takes notes and checks names; `bearingdyn.system.assemble` makes matrices of them.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import ArrayLike, NDArray

from bearingdyn.bearing import BallBearing, LooseFit
from bearingdyn.cms import Raceway, Superelement

Array = NDArray[np.float64]

COMPONENTS = ("x", "y", "z", "θx", "θy", "θz")
GROUND = "ground"


class Part(Protocol):
    """Anything that becomes a superelement."""

    def superelement(self) -> Superelement:
        """The part's reduced matrices."""


@dataclass(frozen=True)
class Connection:
    """Two interfaces that move as one."""

    a: str
    b: str


@dataclass(frozen=True, eq=False)
class Support:
    """An interface held by the ground: rigidly (both None) or by six springs and six dampers."""

    interface: str
    stiffness: Array | None
    damping: Array | None

    @property
    def rigid(self) -> bool:
        """Whether nothing moves here."""
        return self.stiffness is None and self.damping is None


@dataclass(frozen=True)
class HungBearing:
    """A bearing between two interfaces; outer may be a raceway of a flexible ring, or "ground"."""

    name: str
    bearing: BallBearing
    inner: str
    outer: str


@dataclass(frozen=True)
class HungFit:
    """A flexible ring's outside, a raceway, loose in a bore: an interface or "ground"."""

    name: str
    fit: LooseFit
    ring: str
    bore: str


@dataclass(frozen=True, eq=False)
class Load:
    """A force and moment at an interface or point, in the manner its kind says.

    kind "constant": vector. "harmonic": vector·cos(ωt + phase). "rotating": an unbalance, force
    Ω²·unbalance·(cos(Ωt + phase), sin(Ωt + phase)) in (x, y). "sampled": vector × value(time).
    """

    where: str
    kind: str
    vector: Array
    omega: float = 0.0
    phase: float = 0.0
    unbalance: float = 0.0
    time: Array | None = None
    value: Array | None = None


def _six(name: str, value: ArrayLike, positive: bool = False) -> Array:
    vector = np.array(value, dtype=np.float64)
    if vector.shape != (6,):
        raise ValueError(
            f"{name} has shape {vector.shape}; give six numbers (x, y, z, θx, θy, θz) in SI units"
        )
    if not np.isfinite(vector).all():
        raise ValueError(f"{name} is {vector.tolist()}; every number must be finite")
    if positive and not (vector >= 0).all():
        raise ValueError(f"{name} is {vector.tolist()}; stiffness and damping cannot be negative")
    return vector


class Application:
    """Parts, joints, bearings and loads, by name.

    An interface is named "part.interface" ("shaft.left"); a point that a part offers for output and loads
    is named in the same manner. Every interface must be joined, grounded, given a bearing, or declared free.
    """

    def __init__(self) -> None:
        self.parts: dict[str, Superelement] = {}
        self.sources: dict[str, Part] = {}
        self.connections: list[Connection] = []
        self.supports: dict[str, Support] = {}
        self.bearings: dict[str, HungBearing] = {}
        self.fits: dict[str, HungFit] = {}
        self.loads: list[Load] = []
        self.free_interfaces: set[str] = set()

    def add(self, name: str, part: Part) -> None:
        """Add a part under a name.

        Raises ValueError if the name is taken, reserved or holds a dot.
        """
        if not name or "." in name or name == GROUND:
            raise ValueError(f'part name {name!r} must be a word without dots and not "{GROUND}"')
        if name in self.parts or name in self.bearings or name in self.fits:
            raise ValueError(f"part {name!r} is there already; give each part and bearing its own name")
        self.parts[name] = part.superelement()
        self.sources[name] = part

    def connect(self, a: str, b: str) -> None:
        """Join two interfaces rigidly: they move as one.

        Raises ValueError if either is unknown or connected already, or both are of one part.
        """
        for interface in (a, b):
            self._interface(interface)
            for other in self.connections:
                if interface in (other.a, other.b):
                    partner = other.b if other.a == interface else other.a
                    raise ValueError(
                        f"{interface} is connected already, to {partner}; connect the third part to "
                        f"another interface of either"
                    )
        if a == b:
            raise ValueError(f"{a} cannot be connected to itself")
        if a.partition(".")[0] == b.partition(".")[0]:
            raise ValueError(f"{a} and {b} are of one part; connect interfaces of two parts")
        self.connections.append(Connection(a, b))

    def ground(
        self, interface: str, stiffness: ArrayLike | None = None, damping: ArrayLike | None = None
    ) -> None:
        """Hold an interface: rigidly, or by six stiffnesses (N/m, N m/rad) and/or six dampings.

        Raises ValueError if the interface is unknown or grounded already, or a number negative.
        """
        self._interface(interface)
        if interface in self.supports:
            raise ValueError(f"{interface} is grounded already; give stiffness and damping in one call")
        self.supports[interface] = Support(
            interface,
            None if stiffness is None else _six(f"stiffness of {interface}", stiffness, positive=True),
            None if damping is None else _six(f"damping of {interface}", damping, positive=True),
        )

    def free(self, interface: str) -> None:
        """Declare that an interface is left unjoined on purpose, or a raceway without balls."""
        if self.raceway(interface) is None:
            self._interface(interface)
        self.free_interfaces.add(interface)

    def bearing(self, name: str, bearing: BallBearing, *, inner: str, outer: str) -> None:
        """Hang a bearing between the interface of its inner ring and that of its outer ring or "ground".

        outer may be the raceway of a flexible ring, "ring.raceway", made for this bearing's arm.

        Raises ValueError if a name is unknown or taken, or the raceway has another arm.
        """
        self._new("bearing", name)
        self._interface(inner)
        raceway = self.raceway(outer)
        if raceway is not None and not math.isclose(raceway.arm, bearing.arm, rel_tol=1e-9):
            raise ValueError(
                f"bearing {name!r} has its arm at {bearing.arm:.9g} m and {outer} at {raceway.arm:.9g} m; "
                "make the ring with arm=bearing.arm"
            )
        if outer != GROUND and raceway is None:
            self._interface(outer)
        if raceway is not None and any(b.outer == outer for b in self.bearings.values()):
            raise ValueError(
                f"bearing {name!r}: {outer} carries a bearing already; give each its own raceway"
            )
        if inner == outer:
            raise ValueError(f"bearing {name!r} has both rings at {inner}; name two interfaces")
        self.bearings[name] = HungBearing(name, bearing, inner, outer)

    def fit(self, name: str, fit: LooseFit, *, ring: str, bore: str) -> None:
        """Set a flexible ring's outside, "ring.outside", loosely in the bore of an interface or "ground".

        Raises ValueError if a name is unknown or taken, or the ring's outside is no raceway.
        """
        self._new("fit", name)
        if self.raceway(ring) is None:
            raise ValueError(
                f'fit {name!r}: {ring!r} is no flexible face; make the ring with outside="flexible" and '
                f'name its "outside"'
            )
        if ring in self._raceways_used():
            raise ValueError(f"fit {name!r}: {ring} is in use already; give each its own")
        if bore != GROUND:
            self._interface(bore)
        self.fits[name] = HungFit(name, fit, ring, bore)

    def _new(self, kind: str, name: str) -> None:
        if not name or "." in name:
            raise ValueError(f"{kind} name {name!r} must be a word without dots")
        if name in self.bearings or name in self.parts or name in self.fits:
            raise ValueError(f"{kind} {name!r}: the name is taken; give each part and bearing its own name")

    def _raceways_used(self) -> set[str]:
        return {b.outer for b in self.bearings.values()} | {f.ring for f in self.fits.values()}

    def raceway(self, name: str) -> Raceway | None:
        """The raceway of that name, "ring.raceway"; None where the name is no raceway."""
        part, _, rest = name.partition(".")
        return self.parts[part].raceways.get(rest) if part in self.parts else None

    def load(
        self,
        where: str,
        vector: ArrayLike,
        *,
        frequency: float | None = None,
        phase: float = 0.0,
        time: ArrayLike | None = None,
        value: ArrayLike | None = None,
    ) -> None:
        """Apply a force and moment (Fx, Fy, Fz, Mx, My, Mz), N and N m, at an interface or point.

        Alone it is constant. With `frequency` (Hz) it is vector·cos(2π f t + phase), zero-to-peak. With
        `time` (s, increasing) and `value` it is vector × value(time), linear between samples, ends held.

        Raises ValueError for an unknown place, a wrong shape, or an unsorted table.
        """
        rows = self._rows(where)
        force = _six(f"load at {where}", vector)
        if rows.shape[0] == 3 and force[3:].any():
            raise ValueError(f"load at {where}: the point has no rotation, so its moment must be zero")
        if frequency is None and phase != 0.0:
            raise ValueError(
                f"load at {where}: phase is {phase}; it belongs to a frequency, and none is given"
            )
        if frequency is not None and (time is not None or value is not None):
            raise ValueError(f"load at {where}: give frequency, or time and value, not both")
        if frequency is not None:
            if not (frequency > 0 and math.isfinite(frequency)):
                raise ValueError(
                    f"load at {where}: frequency is {frequency}; it must be positive, in Hz "
                    f"(leave it out for a constant load)"
                )
            if not math.isfinite(phase):
                raise ValueError(f"load at {where}: phase is {phase}; it must be finite, in rad")
            self.loads.append(Load(where, "harmonic", force, 2 * math.pi * frequency, phase))
        elif time is not None or value is not None:
            t = np.atleast_1d(np.array([] if time is None else time, dtype=np.float64))
            v = np.atleast_1d(np.array([] if value is None else value, dtype=np.float64))
            if t.ndim != 1 or t.shape != v.shape or t.size < 2:
                raise ValueError(
                    f"load at {where}: time has {t.size} samples and value {v.size}; give two or more of each"
                )
            if not (np.isfinite(t).all() and np.isfinite(v).all() and (np.diff(t) > 0).all()):
                raise ValueError(f"load at {where}: time must increase and all samples must be finite")
            self.loads.append(Load(where, "sampled", force, time=t, value=v))
        else:
            self.loads.append(Load(where, "constant", force))

    def unbalance(self, where: str, moment: float, phase: float = 0.0) -> None:
        """An unbalance mass × eccentricity (kg m) that turns with the shaft, at `phase` (rad) from x.

        Raises ValueError for an unknown place or a negative moment.
        """
        self._rows(where)
        if not (moment >= 0 and math.isfinite(moment)) or not math.isfinite(phase):
            raise ValueError(
                f"unbalance at {where} is {moment} kg m at {phase} rad; it must be finite and not negative"
            )
        self.loads.append(Load(where, "rotating", np.zeros(6), phase=phase, unbalance=moment))

    def names(self) -> list[str]:
        """All interfaces and points, "part.name"."""
        return [f"{p}.{n}" for p, e in self.parts.items() for n in (*e.interfaces, *e.outputs)]

    def summary(self) -> str:
        """What is connected to what, with masses: a text to read before computing."""
        lines = ["parts"]
        for name, element in self.parts.items():
            mass = self._mass(name)
            lines.append(
                f"  {name:<16} {type(self.sources[name]).__name__:<12} {element.n:4d} coordinates"
                + ("" if mass is None else f"  {mass:9.4f} kg")
            )
        lines.append("joints")
        lines += [f"  {c.a} = {c.b}" for c in self.connections]
        for support in self.supports.values():
            held = "rigid" if support.rigid else "springs and dampers"
            lines.append(f"  {support.interface} = ground ({held})")
        lines += [f"  {name} free" for name in sorted(self.free_interfaces)]
        lines.append("bearings")
        lines += [f"  {b.name}: {b.inner} in {b.outer}, {b.bearing.Z} balls" for b in self.bearings.values()]
        for f in self.fits.values():
            lines.append(f"  {f.name}: {f.ring} loose in {f.bore}, {f.fit.clearance * 1e6:g} µm")
        lines.append("loads")
        lines += [f"  {load.where}: {load.kind} {np.round(load.vector, 6).tolist()}" for load in self.loads]
        return "\n".join(lines)

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
        used |= {i for b in self.bearings.values() for i in (b.inner, b.outer)} | self.free_interfaces
        used |= {i for f in self.fits.values() for i in (f.ring, f.bore)}
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

    def _mass(self, part: str) -> float | None:
        """Mass by the rigid translation along y of a part with interfaces, kg; None without interfaces."""
        element = self.parts[part]
        if not element.interfaces:
            return None
        y = np.zeros(element.n)
        for index in element.interfaces.values():
            y[index[1]] = 1.0
        return float(y @ element.M @ y)

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
