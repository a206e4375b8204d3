"""The one door to the C core: typed calls, and statuses turned into exceptions.

Everything here is arrays in, arrays out; what the arrays mean is said in csrc/bearingdyn.h.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, dataclass, field
from itertools import zip_longest
from typing import Any, Protocol

import numpy as np
from numpy.typing import ArrayLike

from bearingdyn import _core
from bearingdyn.progress import Progress as Progress
from bearingdyn.short_repr import short
from bearingdyn.types import Array, Complex, Index

Model = _core.Model

# the words that C owns, in the lists of csrc/bearingdyn.h
DAMPING_LAWS = _core.DAMPING_LAWS
LOAD_KINDS = _core.LOAD_KINDS
CHANNEL_KINDS = _core.CHANNEL_KINDS
WAVE_KINDS = _core.WAVE_KINDS
PIT_KINDS = _core.PIT_KINDS
SETTLED = _core.SETTLED
ISAS = _core.ISAS
ENERGIES = _core.ENERGIES
REPORT_FIELDS = _core.REPORT_FIELDS
INTERRUPTED = _core.STATUSES["INTERRUPTED"]
NO_CONVERGENCE = _core.STATUSES["NO_CONVERGENCE"]


class Packable(Protocol):
    """Packable for a call of the core: a dict of named fields, such as a bearing."""

    def packed(self) -> dict[str, object]:
        """The fields by name."""


class SolverError(RuntimeError):
    """The core's error: a march that could not go on.

    Attributes
    ----------
    report
        Where it stopped: a Report, with step, t in s and residual relative to the largest bearing force.
    partial
        What was computed up to then, a Dataset as `transient` returns it.
    """

    def __init__(self, message: str, report: Report, partial: object = None) -> None:
        super().__init__(message)
        self.report = report
        self.partial = partial

    def __reduce__(self) -> tuple[object, ...]:
        return type(self), (str(self), self.report, self.partial)


class Interrupted(KeyboardInterrupt):
    """A march in the core ended by the user.

    Attributes
    ----------
    partial
        What was computed up to then, a Dataset as `transient` returns it; `resume=` goes on from there.
    """

    def __init__(self, message: str, partial: object = None) -> None:
        super().__init__(message)
        self.partial = partial

    def __reduce__(self) -> tuple[object, ...]:
        return type(self), (str(self), self.partial)


@dataclass(frozen=True, kw_only=True)
class Scheme:
    """The core's scheme, Newmark's, and how exactly the bearing forces are found in it.

    The step, the speed and the audit are arguments of the analysis that marches.

    Parameters
    ----------
    beta, gamma
        Newmark's numbers; ¼ and ½, the average acceleration, add no damping of their own.
    tolerance
        Of the bearing forces, relative to the largest.
    max_iterations
        Of Newton's iteration in a step, 1 to 1000. A step cannot be interrupted, and from the eleventh
        iteration on corrections are halved: after 1000 the halves are below the smallest double.
    isa
        Instruction set of the kernels, one of ISAS: "best", or one that this machine has.
    hold
        Order 1, 2 or 3 of the polynomial that an exact step holds the bearing forces by, through as many
        steps' ends before its own: the step is of one order more. Newmark's step has none.

    Raises
    ------
    ValueError, TypeError
        Naming the field, its value and what it must be.

    References
    ----------
    N. M. Newmark, J. Eng. Mech. 85 (1959) 67.
    """

    beta: float = 0.25
    gamma: float = 0.5
    tolerance: float = 1e-9
    max_iterations: int = 40
    isa: str = "best"
    hold: int = 3

    def __post_init__(self) -> None:
        if self.hold not in (1, 2, 3):
            raise ValueError(f"hold is {self.hold!r}; it is the order of a polynomial: give 1, 2 or 3")
        object.__setattr__(self, "hold", int(self.hold))
        if not isinstance(self.isa, str):
            raise ValueError(f"scheme.isa is {self.isa!r}; it must be one of {sorted(ISAS)}")
        try:
            Stepping(1.0, scheme=self)
        except (TypeError, OverflowError) as error:  # of what is no number, or none that a double holds
            raise ValueError(str(error)) from None


@dataclass(frozen=True)
class Stepping:
    """Core: how a state is stepped, by step, speed, audit and scheme (bd_scheme).

    Parameters
    ----------
    dt
        Step, s.
    speed
        Of the shaft, rad/s: one number, or (times in s, speeds), linear between and held outside.
    audit
        Whether energies and works are integrated.
    scheme
        Newmark's scheme.

    Raises
    ------
    ValueError, TypeError
        Naming the field, its value and what it must be.
    """

    dt: float
    speed: float | tuple[ArrayLike, ArrayLike] = field(default=0.0, kw_only=True)
    audit: bool = field(default=False, kw_only=True)
    scheme: Scheme = field(default_factory=Scheme, kw_only=True)

    __repr__ = short

    def __post_init__(self) -> None:
        _core.check_scheme(self.packed())

    @property
    def profile(self) -> tuple[Array, Array]:
        """Times in s and speeds in rad/s, (n,) each; one of each for a constant speed."""
        try:
            times, speeds = self.speed if isinstance(self.speed, tuple) else ([0.0], [self.speed])
            return np.asarray(times, dtype=np.float64), np.asarray(speeds, dtype=np.float64)
        except (TypeError, ValueError):
            raise ValueError(
                f"speed is {self.speed!r}; it must be a number in rad/s or (times in s, speeds in rad/s)"
            ) from None

    def packed(self) -> dict[str, object]:
        """The fields by name, as the core parses them."""
        times, speeds = self.profile
        own = {"dt": self.dt, "audit": self.audit, "times": times, "speeds": speeds}
        scheme = asdict(self.scheme)
        del scheme["hold"]  # the modes of an exact step hold it
        return {**own, **scheme}


@dataclass(frozen=True)
class Report:
    """The core's report of where and how a march ended (bd_report); the sum of two is of one after the other.

    The fields are those of REPORT_FIELDS, which says of each whether it adds, or the first or last counts.
    `peaks` is the largest load of one ball at the end of any step, N, of each bearing in their order.
    """

    status: int = 0
    steps: int = 0
    iterations: int = 0
    refreshes: int = 0
    refactors: int = 0
    grazing: int = 0
    open_steps: int = 0
    open_t: float = -1.0
    open_bearing: int = -1
    t: float = 0.0
    residual: float = 0.0
    bearing: int = -1
    peaks: tuple[float, ...] = ()

    def __add__(self, later: Report) -> Report:
        mine, its = vars(self), vars(later)

        def both(a: Any, b: Any, how: str) -> Any:
            if how == "sum":
                return a + b
            return a if how == "first" and a >= 0 else b

        fields = {n: both(mine[n], its[n], how) for n, how in REPORT_FIELDS.items()}
        peaks = tuple(max(pair) for pair in zip_longest(self.peaks, later.peaks, fillvalue=0.0))
        return Report(**fields, peaks=peaks)

    @property
    def counts(self) -> dict[str, int]:
        """The fields that add, by name."""
        return {name: getattr(self, name) for name, how in REPORT_FIELDS.items() if how == "sum"}

    @property
    def text(self) -> str:
        """The status in words."""
        return _core.status_text(self.status)


def maxwell_stress(rate: Array, dt: float | Array, G0: float, eta0: float, G: Array, tau: Array) -> Array:
    """Core (C): deviatoric stress (nt, m) by the history update, the strain rate (nt, m) linear in between.

    It starts from e = 0 and S = 0.

    Parameters
    ----------
    rate
        Strain rate, 1/s.
    dt
        Between samples, s: one number or (nt − 1,).
    G0, eta0
        Relaxed modulus, Pa, and viscosity of the dashpot, Pa s.
    G, tau
        Moduli (N,), Pa, and relaxation times (N,), s, of the branches.

    Returns
    -------
    numpy.ndarray
        Deviatoric stress, Pa.

    References
    ----------
    Paper, eq (9) without its volumetric part.
    """
    steps = np.broadcast_to(np.asarray(dt, dtype=np.float64), (max(len(rate) - 1, 0),))
    return _core.maxwell_stress(rate, steps, G0, eta0, G, tau)


def bearing_force(
    kernel: Packable,
    z: Array,
    z_rate: Array,
    angle: float,
    cage_speed: float,
    shaft_angle: float = 0.0,
    shaft_speed: float = 0.0,
) -> tuple[Array, Array, Array, Array]:
    """Core (C): force of a bearing on its raceways' coefficients, tangents, load of each ball.

    Parameters
    ----------
    kernel
        The bearing, as `BearingKernel` packs it.
    z, z_rate
        Coefficients (n,) of the raceways, inner minus outer, m and rad, and their rates.
    angle, cage_speed
        Azimuth of the first ball, rad, and speed of the cage, rad/s.
    shaft_angle, shaft_speed
        Of the shaft, rad and rad/s, by which waves and pits turn.

    Returns
    -------
    tuple of numpy.ndarray
        g (n,) = +∇V, dg/dz (n, n), dg/dż (n, n), and the loads of the balls (Z,), N.
    """
    return _core.bearing_force(kernel.packed(), z, z_rate, angle, cage_speed, shaft_angle, shaft_speed)


def bearing_settle(
    kernel: Packable, loads: Array, radius: Array, angle: float, shaft_angle: float = 0.0
) -> tuple[Array, Array, Array]:
    """Core (C): where a bearing comes to rest under each of many loads, its outer ring held.

    Parameters
    ----------
    kernel
        The bearing, as `BearingKernel` packs it.
    loads
        (m, n) on the coefficients of the raceways, N.
    radius
        (m,) of the order of the expected displacement, m, positive.
    angle
        Azimuth of the first ball, rad.
    shaft_angle
        Of the shaft, rad.

    Returns
    -------
    tuple of numpy.ndarray
        Coefficients (m, n), loads of the balls (m, Z), N, and how each case ended (m,), codes of SETTLED.
    """
    return _core.bearing_settle(kernel.packed(), loads, radius, angle, shaft_angle)


@dataclass(frozen=True, eq=False)
class Along:
    """Core: answer for one bearing along the samples (s) of a motion.

    Parameters
    ----------
    g
        Force on its coefficients (s, n), N.
    loads
        Of the balls (s, Z), N.
    heat, pressing, turning
        Power that its contacts turn into heat, that presses its balls in all (over a period the same), and
        that cage and rings feed in (s,), W.
    K, C
        Tangents dg/dz, dg/dż (s, n, n); empty where they were not asked for.
    pressed
        What each ball presses into films that are carried (s, Z), b dδ/dt, m/s; empty for others.
    """

    g: Array
    loads: Array
    heat: Array
    pressing: Array
    turning: Array
    K: Array
    C: Array
    pressed: Array

    __repr__ = short


def bearing_along(
    kernel: Packable,
    z: Array,
    z_rate: Array,
    angle: Array,
    speed: Array,
    *,
    window: float = 0.0,
    tangents: bool = True,
) -> Along:
    """Call of the core: forces of a bearing, sample by sample, along a motion that is given.

    Parameters
    ----------
    kernel
        The bearing, as `BearingKernel` packs it.
    z, z_rate
        Coefficients (s, n) of the raceways, m and rad, and their rates.
    angle
        (s, 4) rad: azimuth of the first ball, turn of the inner ring, of the outer ring, spin of a ball. They
        need not belong to one time.
    speed
        (4,) of the same, rad/s.
    window
        Time between samples, s, over which a force that jumps as a film closes is spread; 0 for none.
    tangents
        Whether K and C are wanted.

    Raises
    ------
    ArithmeticError
        Where a force is not finite.
    """
    g, loads, heat, pressing, turning, K, C, pressed = _core.bearing_along(
        kernel.packed(), z, z_rate, angle, speed, window, tangents
    )
    none, still = np.zeros((0, 0, 0)), np.zeros((0, 0))
    K, C, pressed = (
        none if K is None else K,
        none if C is None else C,
        still if pressed is None else pressed,
    )
    return Along(g, loads, heat, pressing, turning, K, C, pressed)


def march(
    model: Model,
    state: Array,
    stepping: Stepping,
    steps: int,
    decimate: int = 1,
    *,
    start: bool = False,
    progress: Progress | None = None,
    modes: dict[str, Array] | None = None,
) -> tuple[Array, Array, Report]:
    """Core (C): march a state, and say how far it came, whatever the status.

    Parameters
    ----------
    model, state
        What is marched, and from where.
    stepping
        Step, speed, audit and scheme.
    steps, decimate
        How many steps, and every how many a row is kept.
    start
        Whether the acceleration is first made to satisfy the equation of motion.
    progress
        Told of the steps done and of all there are, every 0.05 s.
    modes
        For exact steps, the linear part's own (`analysis.exact_step`); None for Newmark's.

    Returns
    -------
    tuple
        The record (rows, channels), the new state, and the report.
    """
    record, new_state, report = model.march(
        state=state,
        steps=steps,
        decimate=decimate,
        scheme=stepping.packed(),
        start=start,
        progress=progress,
        modes=modes,
    )
    return record, new_state, Report(**report)


@dataclass(frozen=True, eq=False)
class MarchCall:
    """Call of the C core for a march, not yet made: the arguments of `core.march`."""

    model: Model
    state: Array
    stepping: Stepping
    steps: int
    decimate: int = 1
    start: bool = False
    progress: Progress | None = None
    modes: dict[str, Array] | None = None


def march_abreast(calls: Sequence[MarchCall]) -> list[tuple[Array, Array, Report]]:
    """Call of the core: march several states in one thread, those of one structure side by side.

    Parameters
    ----------
    calls
        Those that share their matrices, layers, step and constant speed to the bit go up to eight abreast,
        which takes less time; the rest one after another. Not abreast go audits, exact steps,
        run-ups and layers that soften.

    Returns
    -------
    list of tuple
        What `march` returns of each, to the bit.
    """
    found = _core.march_abreast(
        [
            (
                call.model,
                call.state,
                call.steps,
                call.decimate,
                call.stepping.packed(),
                call.start,
                call.progress,
                call.modes,
            )
            for call in calls
        ]
    )
    return [(record, state, Report(**report)) for record, state, report in found]


def harmonic(
    model: Model,
    omega: Array,
    modulus: Complex,
    bearing_K: Array,
    bearing_C: Array,
    force: Array,
    row: Array,
    speed: float = 0.0,
    progress: Progress | None = None,
    balls: tuple[Complex, Array] | None = None,
) -> Complex:
    """Core (C): complex response (frequencies, outputs, inputs) of its model to unit forces.

    Parameters
    ----------
    model
        What responds.
    omega
        Angular frequencies (f,), rad/s.
    modulus
        G*(ω) of the layers (f, layers), Pa.
    bearing_K, bearing_C
        Linearised bearings (coefficients, coefficients), N/m and N s/m.
    force, row
        Forces (inputs, n) and rows of the outputs (outputs, n).
    speed
        Of the shaft, rad/s, for the gyroscopic and circulatory forces.
    progress
        Told of the frequencies done and of all there are.
    balls
        What balls add to that by frequency: stiffness (f, balls), N/m, and the v (balls, coefficients) of
        each, whose v vᵀ it multiplies.

    Returns
    -------
    numpy.ndarray
        The response, m/N and its like.

    Raises
    ------
    ArithmeticError
        Where the dynamic stiffness is singular.

    References
    ----------
    Paper, eq (20).
    """
    none = np.zeros((np.size(omega), 0), dtype=np.complex128), np.zeros((0, np.size(bearing_K, -1)))
    ball, across = none if balls is None else balls
    return model.harmonic(omega, speed, modulus, bearing_K, bearing_C, ball, across, force, row, progress)


def changed_layers(
    receptance: Complex,
    which: Index,
    alone: Complex,
    change: Complex,
    slope: Complex,
    end: ArrayLike,
    isa: str = "best",
) -> tuple[Complex, Complex]:
    """Core (C): motions of layers whose moduli have changed (csrc/changed_layers.h).

    Parameters
    ----------
    receptance
        R (f, r, r) of the layers' coordinates, layer after layer, m/N and its like.
    which
        (e,) the frequency that each entry is of.
    alone
        (e, r) their motions at the linear moduli.
    change
        (e, layers) of the complex shear moduli, Pa.
    slope
        (e, layers) its derivative by something of the layer, such as the logarithm of its strain.
    end
        Where each layer's coordinates end.
    isa
        Instruction set.

    Returns
    -------
    tuple of numpy.ndarray
        y (e, r) = (I + R Δ)⁻¹ alone, Δ = 2 change on each layer, and its derivatives (e, layers, r).

    Raises
    ------
    ArithmeticError
        Where the changed system is singular.
    """
    rows = receptance if receptance.strides[2] == receptance.itemsize else np.ascontiguousarray(receptance)
    return _core.changed_layers(rows, which, alone, change, slope, np.asarray(end, dtype=np.int32), isa)


def helmholtz(
    points: Array, faces: Index, wave_number: float, floor: float | None = None
) -> tuple[Complex, Complex, Complex, Complex, Complex]:
    """Call of the core: integral operators of sound outside triangles (csrc/radiation.h), exp(+iωt).

    Parameters
    ----------
    points, faces
        Corners (n, 3), m, and triangles (m, 3), anticlockwise seen from outside.
    wave_number
        ω/c, 1/m.
    floor
        Height y, m, of a rigid floor; None: free field.

    Returns
    -------
    tuple of numpy.ndarray
        V (m, m), V1 (n, m), Kt (n, m), K (n, n) and D (n, n), complex.

    References
    ----------
    J.-C. Nédélec, Acoustic and Electromagnetic Equations, Springer 2001, section 3.4.
    """
    return _core.helmholtz(points, np.asarray(faces, dtype=np.int32), wave_number, floor)


def time_of(model: Model, state: Array) -> float:
    """Core: the time that a state holds, s.

    Parameters
    ----------
    model, state
        The state, and the model it is of.
    """
    return float(model.unpack(state, True)[0])


def energies(model: Model, state: Array) -> dict[str, float]:
    """Core: what the audit of a march integrated, J, by the names of ENERGIES.

    Parameters
    ----------
    model, state
        The state, and the model it is of.
    """
    return model.unpack(state, True)[4]
