"""The one door to the C core: typed calls, and statuses turned into exceptions.

Everything here is arrays in, arrays out; what the arrays mean is said in csrc/bearingdyn.h.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, TypeAlias

import numpy as np
from numpy.typing import ArrayLike

from bearingdyn import _core
from bearingdyn.types import Array, Complex

if TYPE_CHECKING:
    from bearingdyn.bearing.kernel import BearingKernel

Progress: TypeAlias = Callable[[int, int], object]
Model = _core.Model

LAWS = {"constant": 0, "table": 1, "load": 2}
LOAD_KINDS = {"constant": 0, "harmonic": 1, "rotating": 2, "sampled": 3}
CHANNEL_KINDS = {
    "displacement": 0,
    "velocity": 1,
    "acceleration": 2,
    "force": 3,
    "ball": 4,
    "loaded": 5,
    "contact_loss": 6,
    "branch_loss": 7,
}
ENERGIES = (
    "kinetic",
    "elastic",
    "stored",
    "indentation",
    "load",
    "turning",
    "linear",
    "branch",
    "contact",
    "throughput",
)
INTERRUPTED, NOT_FINITE = 1, -7
ISAS = {"best": 0, "base": 1, "avx2": 2, "avx512": 3}


class SolverError(RuntimeError):
    """A march that could not go on: `report` says where, `partial` holds what was computed up to then.

    report: a Report, with step, t in s and residual relative to the largest bearing force.
    partial: a Dataset as `transient` returns it.
    """

    def __init__(self, message: str, report: Report, partial: object = None) -> None:
        super().__init__(message)
        self.report = report
        self.partial = partial

    def __reduce__(self) -> tuple[object, ...]:
        return type(self), (str(self), self.report, self.partial)


class Interrupted(KeyboardInterrupt):
    """A march ended by the user. `partial` holds what was computed up to then.

    partial: a Dataset as `transient` returns it; `resume=` goes on from there.
    """

    def __init__(self, message: str, partial: object = None) -> None:
        super().__init__(message)
        self.partial = partial

    def __reduce__(self) -> tuple[object, ...]:
        return type(self), (str(self), self.partial)


@dataclass(frozen=True, kw_only=True)
class Scheme:
    """Newmark's scheme, and how exactly the bearing forces are found in it.

    The step, the speed and the audit are arguments of the analysis that marches.

    Parameters
    ----------
    beta, gamma
        Newmark's numbers; ¼ and ½, the average acceleration, add no damping of their own.
    tolerance
        Of the bearing forces, relative to the largest.
    max_iterations
        Of Newton's iteration in a step.
    isa
        Instruction set of the kernels: "best", or one of those the core was compiled for.

    Raises
    ------
    ValueError
        From the march, for a number that makes no scheme.

    References
    ----------
    N. M. Newmark, J. Eng. Mech. 85 (1959) 67.
    """

    beta: float = 0.25
    gamma: float = 0.5
    tolerance: float = 1e-9
    max_iterations: int = 40
    isa: str = "best"


@dataclass(frozen=True)
class Stepping:
    """How the core steps a state: step, speed, audit and scheme (bd_scheme).

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
    """

    dt: float
    speed: float | tuple[ArrayLike, ArrayLike] = field(default=0.0, kw_only=True)
    audit: bool = field(default=False, kw_only=True)
    scheme: Scheme = field(default=Scheme(), kw_only=True)

    @property
    def profile(self) -> tuple[Array, Array]:
        """Times in s and speeds in rad/s, (n,) each; one of each for a constant speed."""
        times, speeds = self.speed if isinstance(self.speed, tuple) else ([0.0], [self.speed])
        return np.asarray(times, dtype=np.float64), np.asarray(speeds, dtype=np.float64)


@dataclass(frozen=True)
class Report:
    """Where and how a march ended (bd_report)."""

    status: int
    steps: int
    iterations: int
    refreshes: int
    refactors: int
    grazing: int
    t: float
    residual: float
    bearing: int

    @property
    def text(self) -> str:
        """The status in words."""
        return _core.status_text(self.status)


def kernel_tuple(kernel: BearingKernel) -> tuple[object, ...]:
    """A bearing as the core parses it; radial coefficients must come before axial ones."""
    axial, flaws = np.asarray(kernel.axial), kernel.imperfections
    if np.any(np.diff(axial) < 0):
        raise ValueError("axial must list all radial coefficients (0) before the axial ones (1)")
    return (
        int(kernel.Z),
        kernel.order,
        kernel.sine,
        int(np.count_nonzero(axial == 0)),
        float(kernel.x0),
        float(kernel.y0),
        float(kernel.A),
        float(kernel.e0),
        float(kernel.kappa),
        float(kernel.h0),
        LAWS[kernel.damping_law],
        float(kernel.damping_c),
        np.asarray(kernel.damping_table, dtype=np.float64).reshape(-1, 2),
        float(kernel.cage_ratio),
        float(kernel.angle0),
        (
            float(flaws.spin_ratio),
            float(flaws.ball_diameter),
            float(flaws.inner_radius),
            float(flaws.outer_radius),
            flaws.waves,
            flaws.pits,
            flaws.oversize,
        ),
    )


def maxwell_stress(rate: Array, dt: float | Array, G0: float, eta0: float, G: Array, tau: Array) -> Array:
    """Deviatoric stress (nt, m) of a material point under a strain rate (nt, m) linear between samples.

    dt in s, one number or (nt − 1,); G in Pa and tau in s, (N,). From e = 0 and S = 0; paper eq (9).
    """
    steps = np.broadcast_to(np.asarray(dt, dtype=np.float64), (max(len(rate) - 1, 0),))
    return _core.maxwell_stress(rate, steps, G0, eta0, G, tau)


def bearing_force(
    kernel: BearingKernel,
    z: Array,
    z_rate: Array,
    angle: float,
    cage_speed: float,
    shaft_angle: float = 0.0,
    shaft_speed: float = 0.0,
) -> tuple[Array, Array, Array, Array]:
    """Force g (n,) = +∇V on a bearing's coefficients, tangents dg/dz, dg/dż (n, n), ball loads (Z,) in N."""
    return _core.bearing_force(kernel_tuple(kernel), z, z_rate, angle, cage_speed, shaft_angle, shaft_speed)


def march(
    model: Model,
    state: Array,
    stepping: Stepping,
    steps: int,
    decimate: int = 1,
    *,
    start: bool = False,
    progress: Progress | None = None,
) -> tuple[Array, Array, Report]:
    """March a state; returns the record (rows, channels), the new state and the report, whatever its status.

    With `start`, the acceleration is first made to satisfy the equation of motion.
    """
    (times, speeds), scheme = stepping.profile, stepping.scheme
    record, new_state, report = model.march(
        state,
        steps,
        decimate,
        stepping.dt,
        scheme.beta,
        scheme.gamma,
        times,
        speeds,
        scheme.tolerance,
        scheme.max_iterations,
        stepping.audit,
        ISAS[scheme.isa],
        start,
        progress,
    )
    return record, new_state, Report(*report)


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
) -> Complex:
    """Complex response (frequencies, outputs, inputs) to unit forces; paper eq (20).

    omega (f,) rad/s; modulus (f, layers) G*(ω) in Pa; bearing_K, bearing_C (coefficients, coefficients)
    linearised bearings; force (inputs, n); row (outputs, n). Raises ArithmeticError where the dynamic
    stiffness is singular.
    """
    return model.harmonic(omega, speed, modulus, bearing_K, bearing_C, force, row, progress)


def time_of(model: Model, state: Array) -> float:
    """Time of a state, s."""
    return float(model.unpack(state)[0])


def energies(model: Model, state: Array) -> dict[str, float]:
    """What the audit of a march integrated, J: the names of ENERGIES."""
    values: Sequence[float] = model.unpack(state)[4].tolist()
    return dict(zip(ENERGIES, values, strict=True))
