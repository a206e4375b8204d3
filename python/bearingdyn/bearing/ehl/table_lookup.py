"""The lubricated contact from a table of solutions, in microseconds.

`table.csv` holds solutions of `ehl.steady` for Roelands' viscosity and Dowson and Higginson's density (alpha
2.2e-8 1/Pa, eta0 0.04 Pa s) over M, L and D; `maketable` makes it. Between them smooth quantities are
interpolated by cubic splines in ln M, L and ln D: the film over the formula of Nijenbanning, Venner and Moes,
and logarithms of the others.
"""

from __future__ import annotations

import csv
import math
from dataclasses import dataclass
from functools import cache
from importlib import resources

import numpy as np
import scipy

from bearingdyn.bearing.ehl.steady_film import Figures
from bearingdyn.bearing.film_thickness import dimensionless_film
from bearingdyn.checks import number, require
from bearingdyn.types import Array

OMEGA = (0.25, 0.5, 1.0, 2.0, 4.0)
"""Frequencies ωa/um at which the table has K and C."""


@dataclass(frozen=True)
class Lookup:
    """Figures of a contact looked up in the table, and its answer over frequency."""

    figures: Figures
    K: tuple[float, ...]
    """Stiffness over that of the dry contact at `OMEGA`."""
    C: tuple[float, ...]
    """Damping in the scale of C0 at `OMEGA`."""


@dataclass(frozen=True, repr=False)
class _Splines:
    ends: list[tuple[float, float]]
    """Of ln M, L and ln D, with room for round-off."""
    knots: tuple[list[float], list[float], list[float]]
    coefficients: Array
    """(M, L, D, quantity)."""


def lookup(M: float, L: float, D: float) -> Lookup:
    """Film, stiffness and damping of a lubricated contact by interpolation in the table.

    Parameters
    ----------
    M, L, D
        As in `steady`.

    Raises
    ------
    ValueError
        Outside of the table; `steady` solves there.

    Notes
    -----
    Against a dozen new solutions between its nodes: from M = 100 on .5 % of Hc, 1 % of H0, 3 % of Hmin, .002
    of K0, 2.5 % of C0. Below, where a narrow contact begins to be lost, 3 % of the films, .13 of K0 and 14 %
    of C0.
    """
    splines = _splines()
    place = (
        math.log(number("M", M)) if M > 0 else math.nan,
        number("L", L),
        math.log(D) if D > 0 else math.nan,
    )
    for name, value, x, (low, high) in zip("MLD", (M, L, D), place, splines.ends, strict=True):
        if not low <= x <= high:
            ends = (low, high) if name == "L" else (math.exp(low), math.exp(high))
            require(False, name, value, f"the table holds {ends[0]:g}..{ends[1]:g}; use ehl.steady there")
    (i, u), (j, v), (k, w) = (_basis(knots, x) for knots, x in zip(splines.knots, place, strict=True))
    block = splines.coefficients[i : i + 4, j : j + 4, k : k + 4]
    q = (w @ (v @ (u @ block.reshape(4, -1)).reshape(4, -1)).reshape(4, -1)).tolist()
    Hc = dimensionless_film(M, L, D) * math.exp(q[0])
    K0, C0 = 1 - math.exp(q[3]), math.exp(q[4])
    n = len(OMEGA)
    return Lookup(
        Figures(Hc, Hc * math.exp(q[1]), Hc * math.exp(q[2]), K0, C0),
        tuple(K0 + x for x in q[5 : 5 + n]),
        tuple(C0 * x for x in q[5 + n :]),
    )


@cache
def _splines() -> _Splines:
    text = resources.files("bearingdyn.bearing.ehl").joinpath("table.csv").read_text(encoding="utf-8")
    rows = [{name: float(x) for name, x in row.items()} for row in csv.DictReader(text.splitlines())]
    axes = tuple(np.unique([row[name] for row in rows]) for name in "MLD")
    values = np.full((*map(len, axes), 5 + 2 * len(OMEGA)), np.nan)
    for row in rows:
        at = tuple(int(np.searchsorted(axis, row[name])) for axis, name in zip(axes, "MLD", strict=True))
        Hc = row["Hc"]
        values[at] = (
            math.log(Hc / dimensionless_film(row["M"], row["L"], row["D"])),
            math.log(row["Hmin"] / Hc),
            math.log(row["H0"] / Hc),
            math.log(1 - row["K0"]),
            math.log(row["C0"]),
            *(row[f"K_{x:g}"] for x in OMEGA),
            *(row[f"C_{x:g}"] for x in OMEGA),
        )
    if not np.isfinite(values).all():
        raise RuntimeError("table.csv lacks points: make it again with bearingdyn.bearing.ehl.maketable")
    M, L, D = np.log(axes[0]), axes[1], np.log(axes[2])
    knots = []
    for along, axis in enumerate((M, L, D)):
        spline = scipy.interpolate.make_interp_spline(axis, values, k=3, axis=along)
        knots.append(spline.t.tolist())
        values = np.moveaxis(spline.c, 0, along)
    ends = [(float(axis[0]) - 1e-12, float(axis[-1]) + 1e-12) for axis in (M, L, D)]
    return _Splines(ends, (knots[0], knots[1], knots[2]), np.ascontiguousarray(values))


def _basis(knots: list[float], x: float) -> tuple[int, Array]:
    """First of the four cubic B-splines that are not zero at x, and their values (C. de Boor)."""
    last = len(knots) - 5
    i = 3
    while i < last and x >= knots[i + 1]:
        i += 1
    values = [1.0]
    for degree in (1, 2, 3):
        saved, grown = 0.0, []
        for r, value in enumerate(values):
            right, left = knots[i + r + 1], knots[i + 1 - degree + r]
            part = value / (right - left)
            grown.append(saved + (right - x) * part)
            saved = (x - left) * part
        values = [*grown, saved]
    return i - 3, np.array(values)
