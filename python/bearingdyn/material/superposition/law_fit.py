"""Laws fitted: to shifts that were found freely, or directly to the data, with covariance either way.

A law is sought in parameters that keep it in its range: logarithms of positive constants, the distance of
the pole below the coldest isotherm.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np
import scipy

from bearingdyn.material.shift_laws import (
    WLF,
    Arrhenius,
    Covariance,
    Joined,
    Law,
    ShiftTable,
)
from bearingdyn.material.superposition.free_shifts import Superposition
from bearingdyn.types import Array

LawName = Literal["wlf", "arrhenius", "joined", "free"]

_LOG_STEEPEST = np.log(1e4)  # ln of the largest C1 sought: at it the law is a straight line


@dataclass(frozen=True)
class _Form:
    """A law of p parameters: bounds, starts, and how a vector becomes constants and a law."""

    lower: Array
    upper: Array
    starts: tuple[Array, ...]
    constants: Callable[[Array], Array]
    law: Callable[[Array], WLF | Arrhenius | Joined]


def _form(name: LawName, T: Array, T_ref: float) -> _Form:
    coldest = min(float(T.min()), T_ref)
    if name == "arrhenius":
        return _Form(
            np.log([1e2]),
            np.log([1e7]),
            (np.log([1e5]),),
            np.exp,
            lambda p: Arrhenius(float(np.exp(p[0])), T_ref),
        )
    if name == "wlf":
        lowest = max(0.0, T_ref - coldest) + 1.0  # K; the pole stays 1 K below the coldest isotherm

        def wlf(p: Array) -> Array:
            return np.array([np.exp(p[0]), lowest + np.exp(p[1])])

        starts = tuple(np.array([np.log(C1), np.log(d)]) for d in (10.0, 50.0, 200.0) for C1 in (5.0, 20.0))
        lower, upper = np.array([np.log(1e-6), np.log(1e-3)]), np.array([_LOG_STEEPEST, np.log(1e5)])
        return _Form(lower, upper, starts, wlf, lambda p: WLF(float(wlf(p)[0]), float(wlf(p)[1]), T_ref))

    low, high = float(T[1]), float(T[-2])

    def joined(p: Array) -> Array:
        return np.array([np.exp(p[0]), np.exp(p[1]), p[2], np.exp(p[3])])

    def law(p: Array) -> Joined:
        C1, C2, Tg, Ea = (float(v) for v in joined(p))
        return Joined(C1, C2, Tg, Ea, T_ref)

    starts = tuple(
        np.array([np.log(12.0), np.log(50.0), Tg, np.log(2e5)]) for Tg in np.linspace(low, high, 7)[1:-1]
    )
    lower = np.array([np.log(0.1), np.log(1.0), low, np.log(1e3)])
    upper = np.array([_LOG_STEEPEST, np.log(1e4), high, np.log(1e7)])
    return _Form(lower, upper, starts, joined, law)


def constants_of(name: LawName) -> int:
    """How many constants a law has, its offset not counted."""
    return {"arrhenius": 1, "wlf": 2, "joined": 4, "free": 0}[name]


def require_isotherms(name: LawName, count: int) -> None:
    """ValueError if so many isotherms cannot determine the fit of a law and its offset."""
    needed = constants_of(name) + 1
    if count < max(2, needed):
        raise ValueError(
            f"law is {name!r} with {needed} constants, the data {count} isotherms; take a simpler law"
        )


def fit_law(T: Array, shifts: Array, T_ref: float, name: LawName, pinned: bool = False) -> tuple[Law, float]:
    """Fit a law to shifts, decades, at T, °C; and the shift at T_ref that it implies.

    Parameters
    ----------
    pinned
        The shifts are meant as they are: that at T_ref is zero.

    Raises
    ------
    ValueError
        If there are fewer isotherms than constants, or the shifts do not fall with temperature.
    """
    require_isotherms(name, T.size)
    if name == "free":
        offset = 0.0 if pinned else float(scipy.interpolate.PchipInterpolator(T, shifts)(T_ref))
        return ShiftTable(tuple(T), tuple(shifts - offset), T_ref), offset
    if not np.polyfit(T, shifts, 1)[0] < 0:
        raise ValueError(f"law is {name!r}; the shifts do not fall with temperature; take law='free'")
    form = _form(name, T, T_ref)
    free = 0 if pinned else 1

    def residual(p: Array) -> Array:
        return np.asarray((0.0 if pinned else p[-1]) + form.law(p[: p.size - free]).log_shift(T) - shifts)

    best = None
    for start in form.starts:
        first = np.append(start, np.interp(T_ref, T, shifts)) if free else start
        bounds = (np.append(form.lower, [-np.inf] * free), np.append(form.upper, [np.inf] * free))
        found = scipy.optimize.least_squares(
            residual, first, jac="3-point", bounds=bounds, x_scale="jac", max_nfev=300
        )
        if best is None or found.cost < best.cost * (1 - 1e-9):
            best = found
    assert best is not None  # every form has starts
    p = best.x[: best.x.size - free]
    freedom = T.size - best.x.size
    variance = 2 * best.cost / freedom if freedom > 0 else None
    return _with_covariance(form, p, best.jac, variance), 0.0 if pinned else float(best.x[-1])


def _with_covariance(form: _Form, p: Array, J: Array, variance: float | None) -> Law:
    """The law, with the covariance of its constants unless a bound is reached or no freedom is left."""
    law = form.law(p)
    inside = np.all((p > form.lower + 1e-3) & (p < form.upper - 1e-3))
    if variance is None or not inside:
        return law
    inner = variance * np.linalg.pinv(J.T @ J)[: p.size, : p.size]
    h = 1e-6
    D = np.column_stack(
        [(form.constants(p + h * e) - form.constants(p - h * e)) / (2 * h) for e in np.eye(p.size)]
    )
    full = D @ inner @ D.T
    if isinstance(law, Arrhenius):
        return replace(law, variance=float(full[0, 0]))
    covariance: Covariance = tuple(tuple(float(v) for v in row) for row in full)
    return replace(law, covariance=covariance)


def fit_law_to_data(
    fit: Superposition, start: Law, T_ref: float, name: LawName
) -> tuple[Law, tuple[float, float], Array]:
    """Fit a law whose shifts superpose the data best, from that of free shifts as a start.

    Every point is shifted by its own temperature. Returned are the law with its covariance, the rms relative
    misfit of G′ and G″, and the shifts of the points, decades, (n,).
    """
    T = fit.dma.temperature
    form = _form(name, fit.T, T_ref)
    fit.weigh_evenly()

    def points(p: Array) -> Array:
        return form.law(p).log_shift(T)

    def jacobian(p: Array) -> Array:
        h = 1e-6
        direction = np.column_stack(
            [(points(p + h * e) - points(p - h * e)) / (2 * h) for e in np.eye(p.size)]
        )
        return fit.slopes(points(p), direction)

    p = _parameters(start, form)
    found = scipy.optimize.least_squares(
        lambda q: fit.solve(points(q)).residual,
        p,
        jac=jacobian,
        bounds=(form.lower, form.upper),
        x_scale="jac",
        xtol=1e-8,
        ftol=1e-10,
        max_nfev=60,
    )
    freedom = max(1, found.fun.size - p.size - fit.solve(points(found.x)).basis.shape[1])
    law = _with_covariance(form, found.x, found.jac, 2 * found.cost / freedom)
    return law, fit.misfit(points(found.x)), points(found.x)


def _parameters(law: Law, form: _Form) -> Array:
    """The vector whose law this is, just inside the bounds."""
    match law:
        case Arrhenius():
            p: Sequence[float] = [np.log(law.Ea)]
        case WLF():
            lowest = float(form.constants(np.array([0.0, -700.0]))[1])
            p = [np.log(law.C1), np.log(max(law.C2 - lowest, 1e-2))]
        case Joined():
            p = [np.log(law.C1), np.log(law.C2), law.Tg, np.log(law.Ea)]
        case ShiftTable():
            raise ValueError("law = 'free' has no constants to fit to the data")
    return np.asarray(np.clip(np.asarray(p), form.lower + 1e-2, form.upper - 1e-2))
