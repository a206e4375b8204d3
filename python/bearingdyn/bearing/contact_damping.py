"""The damping of a contact: its laws over the approach, and its value in a lubricated contact."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import Literal, TypeAlias

import numpy as np
import scipy
from numpy.typing import ArrayLike

from bearingdyn.bearing.film_answer import FilmAnswer
from bearingdyn.bearing.film_thickness import moes_groups
from bearingdyn.bearing.hertz import PointContact, resultant_deflection_coefficient
from bearingdyn.checks import nonnegative, number, positive, require, two, vector
from bearingdyn.plausible_ranges import plausible
from bearingdyn.short_repr import short
from bearingdyn.types import Array


def resultant_damping(inner: tuple[float, float], outer: tuple[float, float]) -> float:
    """Damping of one ball from its two contacts in series, each a pair (κ in N/m^1.5, c in N s/m), N s/m.

    Spring and damper pairs in series, c = k²(c_i/k_i² + c_o/k_o²) with k ∝ κ^{2/3} under one force, as long
    as the dampers carry little of it (ω ≪ k/c).

    Parameters
    ----------
    inner
        (κ, c) of the inner contact, N/m^1.5 and N s/m.
    outer
        (κ, c) of the outer contact.

    Raises
    ------
    ValueError
        If κ is not positive or c negative.
    """
    remedy = "it must be (κ, c) in N/m^1.5 and N s/m"
    inner, outer = two("inner", inner, remedy), two("outer", outer, remedy)
    kappa = resultant_deflection_coefficient(inner[0], outer[0])
    return math.fsum(nonnegative("c", c) * math.pow(kappa / k, 4 / 3) for k, c in (inner, outer))


Law: TypeAlias = Literal["constant", "table", "load", "film", "carried"]
KernelFields: TypeAlias = tuple[Law, float, Array]


@dataclass(frozen=True)
class ConstantDamping:
    """Constant damping of a contact, c(δ) = c, N s/m. The force jumps where contact is lost.

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
    """Damping of a contact by a table, c(δ) linear between its points, end values held outside.

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
    """Damping of a contact in step with its stiffness, c(δ) = time·(3/2)κ√(δ + h0); none where it is open.

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


FILM_NODES = 65
"""Nodes of FilmDamping over w, the core's BD_FILM_NODES."""


@dataclass(frozen=True, eq=False)
class FilmDamping:
    """Damping of a lubricated contact over its load, which vanishes smoothly where contact is lost.

    c over w = √s/(√s + √scale), s = δ + h0 = (Q/κ)^{2/3}, by monotone cubics between nodes of equal distance
    in w, from c = 0 with a level slope at w = 0 to the value at w = 1: force and tangent are continuous
    everywhere. `bearing.lubricate` makes one from the film of both contacts.

    Parameters
    ----------
    scale
        The s at which w is a half, m.
    c
        (65,) damping of one ball, N s/m, at w = 0, 1/64, …, 1; zero at the first.
    answer
        How the contacts answer by frequency, for analyses with contacts="film"; None: as this damping says,
        at any.
    load
        At which it was found, N; None: not known.

    Raises
    ------
    ValueError
        If scale is not positive, or a value is negative, not finite, or not zero at w = 0.
    """

    scale: float
    c: Array
    answer: FilmAnswer | None
    load: float | None

    __repr__ = short

    def __init__(
        self, scale: float, c: ArrayLike, answer: FilmAnswer | None = None, load: float | None = None
    ) -> None:
        remedy = "leave it to bearing.lubricate, or None"
        require(isinstance(answer, FilmAnswer | None), "damping.answer", answer, remedy)
        positive("damping.scale", scale, "an approach in metres must be positive and finite")
        plausible("offset", "damping.scale", scale)
        y = vector("damping.c", c, (FILM_NODES,), "dampings in N s/m at w = 0, 1/64, …, 1")
        require(bool((y >= 0).all()), "damping.c", c, "it must be zero or positive")
        require(y[0] == 0, "damping.c[0]", float(y[0]), "it must be zero, where contact is lost")
        plausible("contact damping", "the largest damping.c", float(y.max()))
        y = y.copy()
        y.flags.writeable = False
        object.__setattr__(self, "scale", float(scale))
        object.__setattr__(self, "c", y)
        object.__setattr__(self, "answer", answer)
        object.__setattr__(self, "load", None if load is None else positive("damping.load", load))

    @cached_property
    def _rises(self) -> Array:
        """Slopes by cells at the nodes, (65,): monotone where c is (F. N. Fritsch, R. E. Carlson 1980)."""
        rises = scipy.interpolate.PchipInterpolator(np.arange(FILM_NODES), self.c).derivative()(
            np.arange(FILM_NODES)
        )
        rises[0] = 0.0
        return np.asarray(rises)

    def at(self, s: ArrayLike) -> Array:
        """c, N s/m, at s = δ + h0, m, any shape."""
        root = np.sqrt(np.maximum(np.asarray(s, dtype=float), 0.0))
        w = root / (root + math.sqrt(self.scale))
        nodes = np.arange(FILM_NODES)
        curve = scipy.interpolate.CubicHermiteSpline(nodes, self.c, self._rises)
        return np.asarray(curve((FILM_NODES - 1) * w))

    def behind(self, give: float, kappa: float) -> FilmDamping:
        """The damping felt where a spring lies between contact and ring, c/(1 + give k)², at low frequency.

        k = (3/2)κ√s is the stiffness of film and solids: of a motion the contact takes the share
        1/(1 + give k), and the force of its damper moves the whole by as little again.

        Parameters
        ----------
        give
            m/N; negative where a wall stiffens the ring.
        kappa
            Of the ball, N/m^1.5.
        """
        w = np.arange(FILM_NODES - 1) / (FILM_NODES - 1)
        k = 1.5 * kappa * math.sqrt(self.scale) * w / (1 - w)
        # a wall may stiffen without bound at loads that no ball bears: held where it doubles k
        c = self.c[:-1] / np.maximum(1 + give * k, 0.5) ** 2
        return FilmDamping(self.scale, np.append(c, c[-1]), self.answer, self.load)

    def kernel_fields(self) -> KernelFields:
        """Law, scale and nodes as the kernel takes them."""
        return "film", self.scale, np.column_stack([self.c, self._rises])


Damping: TypeAlias = ConstantDamping | TabulatedDamping | LoadDamping | FilmDamping


def as_damping(damping: object) -> Damping:
    """A law of contact damping, or a plain number of N s/m as ConstantDamping; ValueError otherwise."""
    if isinstance(damping, ConstantDamping | TabulatedDamping | LoadDamping | FilmDamping):
        return damping
    remedy = (
        "give the damping of one ball in N s/m, zero or positive, "
        "or ConstantDamping, TabulatedDamping, LoadDamping or FilmDamping"
    )
    return ConstantDamping(nonnegative("damping", number("damping", damping, remedy), remedy))


def wijnant_damping(contact: PointContact, F: float, us: float, eta0: float, alpha: float) -> float:
    """Damping of one lubricated contact, N s/m, after Y. H. Wijnant (1998). UNVERIFIED.

    c = C (F/δ)(2a/us), C = r M^{−s}, r = .98 − L/60, s = .83 − .008L; δ the dry approach, a the half-width in
    rolling direction. The form was written from memory and not read again in its source; that its load number
    is the M of Nijenbanning, Venner and Moes is an assumption of this package. Values of 4 to 15 N s/m are
    quoted for it.

    Parameters
    ----------
    contact, F, us, eta0, alpha
        As in `nijenbanning_venner_moes`.

    Raises
    ------
    ValueError
        If a value is not positive, Rx > Ry, or L ≥ 58.8, where r vanishes.
    """
    M, L, _ = moes_groups(contact, F, us, eta0, alpha)
    require(
        L < 58.8,
        "alpha",
        alpha,
        f"it must give a lubricant number below 58.8, where the fit of the damping ends; here L is {L:.3g}",
    )
    C = (0.98 - L / 60) * M ** -(0.83 - 0.008 * L)
    return float(C * F / contact.approach(F) * 2 * contact.semi_axes(F)[1] / us)
