"""What the contact kernel is told about a bearing, and the laws of contact damping."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Literal, TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

from bearingdyn.bearing.excitation import Imperfections
from bearingdyn.checks import nonnegative, number, require, vector
from bearingdyn.magnitude import plausible
from bearingdyn.short import short
from bearingdyn.types import Array

Law: TypeAlias = Literal["constant", "table", "load"]
KernelFields: TypeAlias = tuple[Law, float, Array]


@dataclass(frozen=True)
class ConstantDamping:
    """c(δ) = c, N s/m: the paper's harmonic case (30 N s/m). The force jumps where contact is lost.

    At the edge of the film, δ + h0 = 0, the law is taken in its set-valued sense: F is any force in
    [0, c dδ/dt] there, and a step of a march that ends in the jump finds the one that balances. A table with
    c > 0 at that place is treated likewise.

    Raises
    ------
    ValueError
        If c is negative or not finite.
    """

    c: float

    def __post_init__(self) -> None:
        c = nonnegative("damping.c", self.c, "the damping of one ball in N s/m must be zero or positive")
        plausible("contact damping", "damping.c", c)

    def kernel_fields(self) -> KernelFields:
        """Law, constant and table as the kernel takes them."""
        return "constant", float(self.c), np.zeros((0, 2))


@dataclass(frozen=True, eq=False)
class TabulatedDamping:
    """c(δ) linear between table points, end values held outside.

    At an inner table point the slope is that of the interval below it.

    Parameters
    ----------
    delta
        (n,) contact indentations δ (film not included), m, strictly increasing, n ≥ 2.
    c
        (n,) damping of one ball, N s/m, ≥ 0.

    Raises
    ------
    ValueError
        If the table is unsorted, ragged, too short, negative or not finite.
    """

    delta: Array
    c: Array

    __repr__ = short

    def __init__(self, delta: ArrayLike, c: ArrayLike) -> None:
        n = np.size(delta)
        require(n >= 2, "damping.delta", delta, "a table needs two points or more (else ConstantDamping)")
        x = vector("damping.delta", delta, (n,), "indentations in metres")
        y = vector("damping.c", c, (n,), "one damping in N s/m for each delta")
        require(bool((np.diff(x) > 0).all()), "damping.delta", delta, "it must be strictly increasing")
        require(bool((y >= 0).all()), "damping.c", c, "it must be zero or positive")
        plausible("contact damping", "the largest damping.c", float(y.max()))
        plausible("offset", "the largest damping.delta", float(np.abs(x).max()))
        for array in (x, y):
            array.flags.writeable = False
        object.__setattr__(self, "delta", x)
        object.__setattr__(self, "c", y)

    def kernel_fields(self) -> KernelFields:
        """Law, constant and table as the kernel takes them."""
        return "table", 0.0, np.column_stack([self.delta, self.c])


@dataclass(frozen=True)
class LoadDamping:
    """c(δ) = time × linearised stiffness, time·(3/2)κ√(δ + h0): vanishes where contact is lost.

    Values of (0.25–2.5)e-5 s are quoted for lubricated contacts; unverified here.

    Raises
    ------
    ValueError
        If `time` (s) is negative or not finite.
    """

    time: float

    def __post_init__(self) -> None:
        remedy = "the damping time in seconds must be zero or positive"
        plausible("contact damping time", "damping.time", nonnegative("damping.time", self.time, remedy))

    def kernel_fields(self) -> KernelFields:
        """Law, constant and table as the kernel takes them."""
        return "load", float(self.time), np.zeros((0, 2))


Damping: TypeAlias = ConstantDamping | TabulatedDamping | LoadDamping


def as_damping(damping: object) -> Damping:
    """The damping law itself, or a plain number of N s/m as ConstantDamping; ValueError otherwise."""
    if isinstance(damping, ConstantDamping | TabulatedDamping | LoadDamping):
        return damping
    remedy = (
        "give the damping of one ball in N s/m, zero or positive, "
        "or ConstantDamping, TabulatedDamping or LoadDamping"
    )
    return ConstantDamping(nonnegative("damping", number("damping", damping, remedy), remedy))


@dataclass(frozen=True, eq=False)
class BearingKernel:
    """One bearing as the contact kernel sees it.

    Groove-centre displacement of the inner race relative to the outer, a Fourier series in the azimuth ψ:
    radial dY(ψ) and axial dX(ψ), each the sum of its coefficients z_k times cos or sin of order[k]·ψ.
    The groove centres stand at (x0 + dX, y0 + dY); δ is their distance less A. Ball j (from 1) is at
    ψ_j = angle + 2π(j − 1)/Z, where `angle` is what the caller passes: at the start of a run, `angle0`.
    """

    Z: int
    """Number of balls."""
    axial: NDArray[np.intc]
    """(n,) 0 for a radial coefficient, 1 for an axial one."""
    order: NDArray[np.intc]
    """(n,) order in the azimuth, ≥ 0."""
    sine: NDArray[np.intc]
    """(n,) 0 for cos, 1 for sin."""
    x0: float
    """Axial distance of the groove centres at z = 0, m."""
    y0: float
    """Radial distance of the groove centres at z = 0, m."""
    A: float
    """Distance of the groove centres at which a ball just touches both races, m."""
    e0: float
    """x0² + y0² − A², formed without cancellation, m²."""
    kappa: float
    """Deflection coefficient of both contacts of a ball in series, N/m^1.5."""
    h0: float
    """Film thickness of both contacts of a ball together, m."""
    damping_law: Law
    damping_c: float
    """c in N s/m ("constant") or the damping time in s ("load"); 0 for "table"."""
    damping_table: Array = field(default_factory=lambda: np.zeros((0, 2)))
    """(n, 2) rows (δ in m, c in N s/m); empty unless the law is "table"."""
    cage_ratio: float = 0.5
    """Cage speed over shaft speed."""
    angle0: float = 0.0
    """Azimuth of the first ball at the start, rad."""
    inner_ratio: float = 1.0
    """Speed of the inner ring over that of the shaft."""
    outer_ratio: float = 0.0
    """Speed of the outer ring over that of the shaft."""
    shoulder: int = 0
    """+1, −1: axial load on the inner ring is borne towards +z, −z only; 0: both ways."""
    open_sine: float = 0.0
    """Sine of the contact angle on the open side from which a ball runs off."""
    give: float = 0.0
    """Compliance that the ring adds to Hertz at a ball of its own, m/N; negative where a wall stiffens it."""
    imperfections: Imperfections = field(default_factory=Imperfections)
    """Waves, pits and unequal balls; none by default."""

    __repr__ = short

    def stored(self, loads: Array) -> float:
        """Energy, J, of the contacts under loads (Z,), N: ∫κ u³ ds = (2/5) F u² + ½ give F², κ u³ = F."""
        return float((loads * (0.4 * (loads / self.kappa) ** (2 / 3) + 0.5 * self.give * loads)).sum())

    def packed(self) -> dict[str, object]:
        """The fields by name, as the core parses them (bd_bearing_data).

        Raises
        ------
        ValueError
            Unless all radial coefficients come before the axial ones.
        """
        axial = np.asarray(self.axial)
        ordered = not np.any(np.diff(axial) < 0)
        require(ordered, "axial", self.axial, "list all radial coefficients (0) before the axial ones (1)")
        return {
            "n_balls": self.Z,
            "order": self.order,
            "sine": self.sine,
            "n_radial": int(np.count_nonzero(axial == 0)),
            "x0": self.x0,
            "y0": self.y0,
            "A": self.A,
            "e0": self.e0,
            "kappa": self.kappa,
            "h0": self.h0,
            "give": self.give,
            "law": self.damping_law,
            "c": self.damping_c,
            "table": np.asarray(self.damping_table, dtype=np.float64).reshape(-1, 2),
            "cage_ratio": self.cage_ratio,
            "angle0": self.angle0,
            "inner_ratio": self.inner_ratio,
            "outer_ratio": self.outer_ratio,
            "shoulder": self.shoulder,
            "open_sine": self.open_sine,
            "imperfections": self.imperfections.packed(),
        }
