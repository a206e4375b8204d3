"""Loads, one class for each course in time, and what the core needs to know of each."""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from dataclasses import dataclass
from typing import ClassVar, TypedDict, cast

import numpy as np
from numpy.typing import ArrayLike

from bearingdyn.application.channel import GROUND
from bearingdyn.application.place import GRAVITY, Place
from bearingdyn.checks import nonnegative, positive, real, require, vector
from bearingdyn.plausible_ranges import plausible
from bearingdyn.short_repr import short
from bearingdyn.types import Array

FORCE = "six numbers (Fx, Fy, Fz, Mx, My, Mz) in N and N m"
ACCELERATION = "three finite numbers (x, y, z) in m/s²"


class CoreLoad(TypedDict):
    """One load in the fields of the core's `bd_load_data`; kind as the core names it."""

    kind: str
    omega: float
    p_cos: Array
    p_sin: Array
    time: Array
    value: Array


@dataclass(frozen=True, eq=False)
class Load(ABC):
    """A load: what acts at a place, or on all parts together.

    Parameters
    ----------
    where
        An interface or point; GROUND for a motion of the ground, GRAVITY for the weight of all parts.
    """

    kind: ClassVar[str]
    where: Place

    @property
    @abstractmethod
    def size(self) -> str:
        """The amount, in words."""

    @abstractmethod
    def core(self, rows: Array) -> CoreLoad:
        """The load as the core takes it.

        Parameters
        ----------
        rows
            (3 or 6, n): motion of the place by the system's coordinates; the force on these is rowsᵀ f.
        """

    def _name(self, field: str) -> str:
        return f"load at {self.where}: {field}"


@dataclass(frozen=True, eq=False)
class DirectedLoad(Load):
    """A load with a direction: force and moment (6,), N and N m, or an acceleration (3,), m/s².

    The acceleration is that of the ground at GROUND, and that of a falling body at GRAVITY.
    """

    vector: Array

    def __post_init__(self) -> None:
        of_all = self.where in (GROUND, GRAVITY)
        shape, meaning = ((3,), ACCELERATION) if of_all else ((6,), FORCE)
        object.__setattr__(self, "vector", vector(self._label, self.vector, shape, meaning))
        self._check_magnitudes(1.0, f"{self._label}:")
        if self.where == GRAVITY:
            plausible("field of gravity", "gravity", float(np.linalg.norm(self.vector)))

    @property
    def _label(self) -> str:
        """Its name in messages."""
        special = {GROUND: "acceleration of the base", GRAVITY: "gravity"}
        return special.get(self.where, f"load at {self.where}")

    def _check_magnitudes(self, factor: float, name: str) -> None:
        """Check the magnitude of every entry times the factor."""
        for k, x in enumerate(self.vector.tolist()):
            if self.where in (GROUND, GRAVITY):
                kind = "gravity" if self.where == GRAVITY else "acceleration"
            else:
                kind = "force" if k < 3 else "moment"
            plausible(kind, f"{name} {kind} along {'xyz'[k % 3]}", factor * x)

    @property
    def size(self) -> str:
        return str(np.round(self.vector, 6).tolist())

    def _force(self, rows: Array) -> Array:
        """(n,), where a place without rotation takes the force alone."""
        return np.asarray(self.vector[: rows.shape[0]] @ rows)


@dataclass(frozen=True, eq=False)
class ConstantLoad(DirectedLoad):
    """A load that stays as it is.

    Parameters
    ----------
    where, vector
        Place, and force and moment (6,), N and N m, there; or an acceleration (3,), m/s², at GROUND or
        GRAVITY.

    Raises
    ------
    ValueError
        If the vector has another shape or is not finite.
    """

    kind: ClassVar[str] = "constant"

    __repr__ = short

    def core(self, rows: Array) -> CoreLoad:
        force = self._force(rows)
        return _core(self.kind, force, np.zeros_like(force))


@dataclass(frozen=True, eq=False)
class HarmonicLoad(DirectedLoad):
    """A load vector·cos(2π f t + φ), zero-to-peak.

    Parameters
    ----------
    where, vector
        As in `ConstantLoad`.
    frequency
        f, Hz, positive.
    phase
        φ, rad.

    Raises
    ------
    ValueError
        If the vector has another shape, the frequency is not positive, or a number is not finite.
    """

    kind: ClassVar[str] = "harmonic"
    frequency: float
    phase: float = 0.0

    __repr__ = short

    def __post_init__(self) -> None:
        super().__post_init__()
        remedy = "it must be positive, in Hz (leave it out for a constant load)"
        frequency = positive(self._name("frequency"), self.frequency, remedy)
        object.__setattr__(self, "frequency", plausible("frequency", self._name("frequency"), frequency))
        phase = plausible("angle", self._name("phase"), self.phase, "it must be finite, in rad")
        object.__setattr__(self, "phase", phase)

    @property
    def size(self) -> str:
        turned = f", phase {self.phase:g} rad" if self.phase else ""
        return f"{super().size} at {self.frequency:g} Hz{turned}"

    def core(self, rows: Array) -> CoreLoad:
        force, c, s = self._force(rows), math.cos(self.phase), math.sin(self.phase)
        return _core(self.kind, c * force, -s * force, omega=2 * math.pi * self.frequency)


@dataclass(frozen=True, eq=False)
class SampledLoad(DirectedLoad):
    """A load vector × value(time), linear between the samples; before and after, the end values hold.

    Parameters
    ----------
    where, vector
        As in `ConstantLoad`.
    time
        (k,) s, increasing; two samples or more.
    value
        (k,) factors of the vector.

    Raises
    ------
    ValueError
        If the vector has another shape, there are fewer than two samples or not as many of each, time does
        not increase, or a number is not finite.
    """

    kind: ClassVar[str] = "sampled"
    time: Array
    value: Array

    __repr__ = short

    def __post_init__(self) -> None:
        super().__post_init__()
        t, v = (self._samples("time", self.time), self._samples("value", self.value))
        if t.ndim != 1 or t.shape != v.shape or t.size < 2:
            raise ValueError(
                f"{self._name('time')} has {t.size} samples and value {v.size}; give two or more of each"
            )
        if not (np.isfinite(t).all() and np.isfinite(v).all() and (np.diff(t) > 0).all()):
            raise ValueError(f"{self._name('time')} must increase and all samples must be finite")
        most = float(np.abs(v).max())
        self._check_magnitudes(most, f"{self._label}, its largest value {most:.6g} times its")
        object.__setattr__(self, "time", t)
        object.__setattr__(self, "value", v)

    def _samples(self, field: str, samples: object) -> Array:
        try:
            return np.atleast_1d(real(cast(ArrayLike, samples)))
        except (TypeError, ValueError):
            require(False, self._name(field), samples, "it must be real numbers, two or more")
            raise

    def core(self, rows: Array) -> CoreLoad:
        force = self._force(rows)
        return _core(self.kind, force, np.zeros_like(force), time=self.time, value=self.value)


@dataclass(frozen=True, eq=False)
class Unbalance(Load):
    """The load of a mass off the axis that turns with the shaft: Ω² u (cos(Ωt + φ), sin(Ωt + φ)) in (x, y).

    Parameters
    ----------
    where
        An interface or point.
    moment
        u, mass × eccentricity, kg m; zero or positive.
    phase
        φ, rad from x.

    Raises
    ------
    ValueError
        If the moment is negative or a number is not finite.
    """

    kind: ClassVar[str] = "rotating"
    moment: float
    phase: float = 0.0

    def __post_init__(self) -> None:
        name = f"unbalance at {self.where}"
        moment = nonnegative(name, self.moment, "it must be finite and not negative, in kg m")
        object.__setattr__(self, "moment", plausible("unbalance", name, moment))
        phase = plausible("angle", f"{name}: phase", self.phase, "it must be finite, in rad")
        object.__setattr__(self, "phase", phase)

    @property
    def size(self) -> str:
        return f"{self.moment:g} kg m"

    def core(self, rows: Array) -> CoreLoad:
        # u (cos(θ + φ), sin(θ + φ)) = cos θ · u (c, s) + sin θ · u (−s, c)
        c, s = math.cos(self.phase), math.sin(self.phase)
        along, across = self.moment * np.array([[c, s], [-s, c]]) @ rows[:2]
        return _core(self.kind, along, across)


def in_time(
    where: Place,
    vector: ArrayLike,
    frequency: float | None = None,
    phase: float = 0.0,
    time: ArrayLike | None = None,
    value: ArrayLike | None = None,
) -> DirectedLoad:
    """The load that these arguments of `Application.load` describe.

    Raises
    ------
    ValueError
        If a frequency and samples are given together, or a phase without frequency; and as the loads do.
    """
    given = cast(Array, vector)  # each load makes its own array of it
    if frequency is not None:
        require(
            time is None and value is None,
            f"load at {where}: frequency",
            frequency,
            "give frequency, or time and value, not both",
        )
        return HarmonicLoad(where, given, frequency, phase)
    require(
        phase == 0.0, f"load at {where}: phase", phase, "it belongs to a frequency; give one, or leave it out"
    )
    if time is None and value is None:
        return ConstantLoad(where, given)
    t, v = (cast(Array, [] if a is None else a) for a in (time, value))
    return SampledLoad(where, given, t, v)


def _core(
    kind: str,
    p_cos: Array,
    p_sin: Array,
    omega: float = 0.0,
    time: Array | None = None,
    value: Array | None = None,
) -> CoreLoad:
    none = np.zeros(0)
    return CoreLoad(
        kind=kind,
        omega=omega,
        p_cos=p_cos,
        p_sin=p_sin,
        time=none if time is None else time,
        value=none if value is None else value,
    )
