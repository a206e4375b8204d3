"""An application: parts joined at rigid interfaces, bearings hung between them, loads applied.

The builder only takes notes and checks names; `bearingdyn.system.assemble` makes matrices of them.
"""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike

from bearingdyn.application.notes import (
    GRAVITY,
    GROUND,
    Bush,
    Connection,
    HungBearing,
    HungFit,
    Load,
    Part,
    Support,
)
from bearingdyn.application.plan import Plan
from bearingdyn.application.summary import summary
from bearingdyn.bearing import BallBearing, LooseFit
from bearingdyn.cms import Viscoelastic
from bearingdyn.types import Array


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


def _three(name: str, value: ArrayLike) -> Array:
    vector = np.array(value, dtype=np.float64)
    if vector.shape != (3,) or not np.isfinite(vector).all():
        raise ValueError(f"{name} is {vector.tolist()}; give three finite numbers (x, y, z) in m/s²")
    return vector


def _load(
    where: str,
    vector: Array,
    frequency: float | None,
    phase: float,
    time: ArrayLike | None,
    value: ArrayLike | None,
) -> Load:
    """A load by its course in time: constant, harmonic or sampled."""
    if frequency is None and phase != 0.0:
        raise ValueError(f"load at {where}: phase is {phase}; it belongs to a frequency, and none is given")
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
        return Load(where, "harmonic", vector, 2 * math.pi * frequency, phase)
    if time is None and value is None:
        return Load(where, "constant", vector)
    t = np.atleast_1d(np.array([] if time is None else time, dtype=np.float64))
    v = np.atleast_1d(np.array([] if value is None else value, dtype=np.float64))
    if t.ndim != 1 or t.shape != v.shape or t.size < 2:
        raise ValueError(
            f"load at {where}: time has {t.size} samples and value {v.size}; give two or more of each"
        )
    if not (np.isfinite(t).all() and np.isfinite(v).all() and (np.diff(t) > 0).all()):
        raise ValueError(f"load at {where}: time must increase and all samples must be finite")
    return Load(where, "sampled", vector, time=t, value=v)


def _through(name: str, offset: ArrayLike, stiffness: Array | None) -> Array:
    """An offset (6,) that acts through springs."""
    vector = _six(name, offset)
    if stiffness is None or (vector[stiffness == 0.0] != 0.0).any():
        raise ValueError(f"{name} is {vector.tolist()}; it acts through springs: give a stiffness there")
    return vector


class Application(Plan):
    """Parts, joints, bearings and loads, by name.

    An interface is named "part.interface" ("shaft.left"); a point that a part offers for output and loads
    is named in the same manner. Every interface must be joined, grounded, given a bearing, or declared free.

    Names are checked at once, joints when the system is assembled; either way a ValueError names the part and
    interface. Lengths, forces, masses in SI; vectors in the order (x, y, z, θx, θy, θz).

    >>> import bearingdyn as bd
    >>> app = bd.Application()
    >>> app.add("mass", bd.RigidBody(mass=2.0, inertia=(1e-3, 1e-3, 1e-3)))
    >>> app.ground("mass.centre", stiffness=[1e6] * 6)
    >>> app.load("mass.centre", (0, -20.0, 0, 0, 0, 0))
    >>> print(f"{bd.equilibrium(app).displacement('mass.centre')[1] * 1e6:.1f} µm")
    -20.0 µm
    """

    def __repr__(self) -> str:
        """The summary, or that there is nothing yet."""
        return self.summary() if self.parts else "<Application without parts>"

    def add(self, name: str, part: Part) -> None:
        """Add a part under a name. One object may be added under several names; it is reduced once.

        Raises ValueError if the name is taken, reserved or holds a dot.
        """
        if not name or "." in name or name in (GROUND, GRAVITY):
            raise ValueError(
                f'part name {name!r} must be a word without dots and not "{GROUND}" or "{GRAVITY}"'
            )
        if name in self.parts or name in self.bearings or name in self.fits:
            raise ValueError(f"part {name!r} is there already; give each part and bearing its own name")
        twin = next((known for known, source in self.sources.items() if source is part), None)
        # the twin's own, before a temperature was put on it
        self.reduced[name] = part.superelement() if twin is None else self.reduced[twin]
        self.parts[name] = self.reduced[name]
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
        self,
        interface: str,
        stiffness: ArrayLike | None = None,
        damping: ArrayLike | None = None,
        offset: ArrayLike | None = None,
    ) -> None:
        """Hold an interface: rigidly, or by six stiffnesses (N/m, N m/rad) and/or six dampings.

        offset: (6,) m and rad, where the springs carry no force: they pull the interface there (preload by
        displacement). Choose the stiffness of what presses.

        Raises ValueError if the interface is unknown or grounded already, a number negative, or an offset
        has no spring to act through.
        """
        self._interface(interface)
        if interface in self.supports:
            raise ValueError(f"{interface} is grounded already; give stiffness and damping in one call")
        k = None if stiffness is None else _six(f"stiffness of {interface}", stiffness, positive=True)
        c = None if damping is None else _six(f"damping of {interface}", damping, positive=True)
        d = None if offset is None else _through(f"offset of {interface}", offset, k)
        self.supports[interface] = Support(interface, k, c, d)

    def spring(
        self,
        a: str,
        b: str,
        stiffness: ArrayLike,
        damping: ArrayLike | None = None,
        offset: ArrayLike | None = None,
    ) -> None:
        """Hang six springs (N/m, N m/rad) and dampers between two interfaces; b may be "ground".

        Both references are taken to lie at one place, as in a bush: the springs act on x_a − x_b − offset.
        offset: (6,) m and rad, preload by displacement.

        Raises ValueError if an interface is unknown, both are one, a number is negative, or an offset has no
        spring to act through.
        """
        self._interface(a)
        if b != GROUND:
            self._interface(b)
        if a == b:
            raise ValueError(f"a spring has both ends at {a}; name two interfaces")
        name = f"spring between {a} and {b}"
        k = _six(f"stiffness of the {name}", stiffness, positive=True)
        c = np.zeros(6) if damping is None else _six(f"damping of the {name}", damping, positive=True)
        d = np.zeros(6) if offset is None else _through(f"offset of the {name}", offset, k)
        self.springs.append(Bush(a, b, k, c, d))

    def free(self, interface: str) -> None:
        """Declare that an interface is left unjoined on purpose, or a raceway without balls."""
        if self.raceway(interface) is None:
            self._interface(interface)
        self.free_interfaces.add(interface)

    def bearing(
        self, name: str, bearing: BallBearing, *, inner: str, outer: str, offset: float = 0.0
    ) -> None:
        """Hang a bearing between the interface of its inner ring and that of its outer ring or "ground".

        outer may be the raceway of a flexible ring, "ring.raceway", made for this bearing's arm.
        offset: m, how far along z the inner ring sits beyond where it is drawn: a spacer or nut that
        preloads two bearings against each other by displacement.

        Raises ValueError if a name is unknown or taken, the raceway has another arm, or the offset is not
        finite.
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
        if not math.isfinite(offset):
            raise ValueError(f"bearing {name!r}: offset is {offset}; it must be a finite length in m")
        self.bearings[name] = HungBearing(name, bearing, inner, outer, float(offset))

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
        self.loads.append(_load(where, force, frequency, phase, time, value))

    def gravity(self, acceleration: ArrayLike) -> None:
        """Weight of every part: acceleration (3,) of a falling body, m/s², such as (0, -9.81, 0).

        Raises ValueError for a wrong shape, or if there is gravity already.
        """
        if any(load.where == GRAVITY for load in self.loads):
            raise ValueError("gravity is given already; one acceleration holds for all parts")
        self.loads.append(Load(GRAVITY, "constant", _three("gravity", acceleration)))

    def base_motion(
        self,
        acceleration: ArrayLike,
        *,
        frequency: float | None = None,
        phase: float = 0.0,
        time: ArrayLike | None = None,
        value: ArrayLike | None = None,
    ) -> None:
        """Move the ground, all of it together without turning: acceleration (3,), m/s², in time as a `load`.

        Everything is then reckoned relative to the moving ground, where each part feels −M R ü, R its rigid
        translation: exact, for the supports see the relative motion alone. Recorded motions are relative too.

        Raises ValueError for a wrong shape or an unsorted table.
        """
        vector = _three("acceleration of the base", acceleration)
        self.loads.append(_load(GROUND, vector, frequency, phase, time, value))

    def temperature(self, part: str, T: float) -> None:
        """Put a part's viscoelastic materials at a temperature, °C, by the shift law of each.

        Raises ValueError for an unknown part, one without viscoelastic material, or a material without law.
        """
        if part not in self.parts:
            raise ValueError(f"{part!r} names no part of the application; there are {sorted(self.parts)}")
        element = self.parts[part]
        if not element.viscoelastic:
            raise ValueError(f"part {part!r} has no viscoelastic material; a temperature changes nothing")
        moved = []
        for term in element.viscoelastic:
            at = getattr(term.material, "at", None)
            if at is None:
                raise ValueError(
                    f"part {part!r}: {type(term.material).__name__} has no shift law; use a Maxwell model "
                    f"with one"
                )
            try:
                moved.append(Viscoelastic(at(T), term.H))
            except ValueError as error:
                raise ValueError(f"part {part!r} at {T} °C: {error}") from None
        self.parts[part] = replace(element, viscoelastic=tuple(moved))
        self.temperatures[part] = float(T)

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

    def summary(self) -> str:
        """What is connected to what, masses, loads, and which motions nothing holds: read it first."""
        return summary(self)
