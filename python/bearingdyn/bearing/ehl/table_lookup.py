"""The lubricated contact from a table of solutions, in microseconds.

`table.csv` holds solutions of `ehl.steady` for Roelands' viscosity and Dowson and Higginson's density (alpha
2.2e-8 1/Pa, eta0 0.04 Pa s) over M, L and D; `maketable` makes it. Smooth quantities are interpolated by
cubic splines in the place on the load axis (`table_nodes`), L and ln D: the film over the formula of
Nijenbanning, Venner and Moes, the odds K0/(1 − K0), and logarithms of the others.
"""

from __future__ import annotations

import csv
import math
from bisect import bisect_right
from collections import defaultdict
from dataclasses import dataclass
from functools import cache, cached_property
from importlib import resources
from typing import Any

import numpy as np
import scipy
from numpy.typing import ArrayLike

from bearingdyn.bearing.ehl.figures import Figured, Figures
from bearingdyn.bearing.ehl.film_decays import DECAYS, FilmDecays
from bearingdyn.bearing.ehl.table_nodes import place
from bearingdyn.bearing.film_thickness import film_formula
from bearingdyn.checks import require
from bearingdyn.types import Array, Complex

OMEGA = (0.25, 0.5, 1.0, 2.0, 4.0)
"""Frequencies ωa/um at which the table has K and C."""

_LOADS = 140  # places on the load axis to which the lines of one L and D are brought before they are joined
_SLACK = 1e-4  # of the ends: the table has four digits of M
_NO_PIEZO = 1e-6  # L at which the formula of the film is that of an isoviscous oil


@dataclass(frozen=True)
class Lookup(Figured):
    """Result of a table lookup: figures of a contact, and its answer over frequency."""

    M: float
    L: float
    D: float
    figures: Figures
    K: tuple[float, ...]
    """Stiffness over that of the dry contact at `OMEGA`."""
    C: tuple[float, ...]
    """Damping in the scale of C0 at `OMEGA`."""

    @cached_property
    def decays(self) -> FilmDecays:
        """What the film carries along, by um/a: fitted to K and C where the table has them."""
        Omega = np.array(OMEGA)
        answer = np.array(self.K) + 1j * Omega * np.array(self.C) / 1.5
        return FilmDecays.fitted(Omega, answer, self.K0, self.C0 / 1.5 / self.K0, DECAYS)

    @cached_property
    def _rest(self) -> Any:
        """What the decays leave unsaid, which is small and smooth: K, and C/1.5, over Ω."""
        said = self.decays.stiffness(np.array(OMEGA))
        K, C = np.array(self.K) - said.real, np.array(self.C) / 1.5 - said.imag / OMEGA
        nodes = np.array((0.0, *OMEGA))
        return scipy.interpolate.PchipInterpolator(nodes, np.column_stack([(0.0, *K), (0.0, *C)]))

    def stiffness(self, Omega: ArrayLike) -> Complex:
        """Dynamic stiffness F̂/δ̂ over that of the dry contact, at frequencies ωa/um, as `Steady.stiffness`.

        Up to Ω = 4 within 1 % of K where K0 is above .9, 2 % where it is above .7; C within 5 % of C0.
        """
        asked = np.asarray(Omega, dtype=float)
        require(bool(np.isfinite(asked).all()), "Omega", Omega, "frequencies ωa/um must be finite")
        at = np.minimum(np.abs(asked), OMEGA[-1])
        rest = self._rest(at)
        left = rest[..., 0] + 1j * np.sign(asked) * at * rest[..., 1]
        return np.asarray(self.decays.stiffness(asked) + left)


@dataclass(frozen=True, repr=False)
class _Pieces:
    """A tensor product of cubic splines in powers of the distance from the left end of each piece."""

    ends: tuple[tuple[float, float], ...]
    breaks: tuple[list[float], ...]
    """Left ends of the pieces along the load axis, L and ln D."""
    coefficients: Array
    """(load, L, D, 16, 4 × quantities): powers of load and L, then of ln D and quantities, highest first."""


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
    """
    if not (M > 0 and D > 0):
        _refuse(M, L, D)
    pieces = _pieces()
    log_D = math.log(D)
    x, y, z = place(math.log(M), log_D), L, log_D
    (low_x, high_x), (low_y, high_y), (low_z, high_z) = pieces.ends
    if not (
        low_x - _SLACK <= x <= high_x + _SLACK
        and low_y - _SLACK <= y <= high_y + _SLACK
        and low_z - _SLACK <= z <= high_z + _SLACK
    ):
        _refuse(M, L, D)
    xs, ys, zs = pieces.breaks
    i, j, k = bisect_right(xs, x, 1) - 1, bisect_right(ys, y, 1) - 1, bisect_right(zs, z, 1) - 1
    u, v, w = x - xs[i], y - ys[j], z - zs[k]
    rows: list[float] = []
    for a in (u * u * u, u * u, u, 1.0):
        b = a * v
        rows += (b * v * v, b * v, b, a)
    partly = np.dot(rows, pieces.coefficients[i, j, k]).reshape(4, -1)
    q = np.dot((w * w * w, w * w, w, 1.0), partly).tolist()
    Hc = film_formula(M, L or _NO_PIEZO, D) * math.exp(q[0])
    K0, C0 = 1 / (1 + math.exp(-q[3])), math.exp(q[4])
    figures = Figures(Hc, Hc * math.exp(q[1]), Hc * math.exp(q[2]), K0, C0)
    K, C = [K0 + x for x in q[5 : 5 + len(OMEGA)]], [C0 * x for x in q[5 + len(OMEGA) :]]
    return Lookup(M, L, D, figures, tuple(K), tuple(C))


def nearest_in_table(L: float, D: float) -> tuple[float, float]:
    """Table lookup: the L and D of the table nearest to those asked."""
    _, (L_low, L_high), (D_low, D_high) = _pieces().ends
    return min(max(L, L_low), L_high), min(max(D, math.exp(D_low)), math.exp(D_high))


def table_ends(D: float) -> tuple[tuple[float, float], tuple[float, float]]:
    """Table lookup: its range at D, least and largest M, least and largest L."""
    return loads_between(D), _pieces().ends[1]


def loads_between(D: float) -> tuple[float, float]:
    """Table lookup: its range of M at D."""
    log_D = math.log(D)
    low, high = _pieces().ends[0]
    # x is linear in ln M
    at_0, at_1 = place(0.0, log_D), place(1.0, log_D)
    return tuple(math.exp((x - at_0) / (at_1 - at_0)) for x in (low, high))  # type: ignore[return-value]


def _refuse(M: float, L: float, D: float) -> None:
    """ValueError that names what lies outside."""
    _, (L_low, L_high), (D_low, D_high) = _pieces().ends
    for name, value, low, high in (
        ("D", D, math.exp(D_low), math.exp(D_high)),
        ("L", L, L_low, L_high),
        ("M", M, *(loads_between(D) if D > 0 else (math.nan, math.nan))),
    ):
        remedy = f"the table holds {low:.4g}..{high:.4g}{f' for D = {D:.3g}' if name == 'M' else ''}"
        require(
            low * (1 - _SLACK) <= value <= high * (1 + _SLACK), name, value, f"{remedy}; use ehl.steady there"
        )


@cache
def _pieces() -> _Pieces:
    text = resources.files("bearingdyn.bearing.ehl").joinpath("table.csv").read_text(encoding="utf-8")
    rows = [{name: float(x) for name, x in row.items()} for row in csv.DictReader(text.splitlines())]
    return joined(rows)


def joined(rows: list[dict[str, float]]) -> _Pieces:
    """Splines for looking up in a table: along the load for each L and D, then over L and ln D."""
    lines = defaultdict(list)
    for row in sorted(rows, key=lambda row: row["M"]):
        lines[row["L"], row["D"]].append((place(math.log(row["M"]), math.log(row["D"])), _smooth(row)))
    L, D = (sorted({key[i] for key in lines}) for i in (0, 1))
    low = max(line[0][0] for line in lines.values())
    high = min(line[-1][0] for line in lines.values())
    # denser about the turn, as the table is
    share = np.linspace(0, 1, _LOADS)
    x = low + (high - low) * share**1.5
    values = np.array(
        [
            [
                scipy.interpolate.CubicSpline([p for p, _ in lines[i, j]], [q for _, q in lines[i, j]])(x)
                for j in D
            ]
            for i in L
        ]
    )
    axes = (x, np.array(L), np.log(D))
    values = np.moveaxis(values, 2, 0)[..., None, :]  # load, L, D, powers, quantity
    for along, axis in enumerate(axes):
        c = scipy.interpolate.CubicSpline(axis, values, axis=along).c
        # the pieces where the nodes were, the four powers folded into those of the axes before
        c = np.moveaxis(np.moveaxis(c, 1, 1 + along), 0, -2)
        values = c.reshape(*c.shape[:-3], -1, c.shape[-1])
    values = values.reshape(*values.shape[:3], 16, -1)
    ends = tuple((float(axis[0]), float(axis[-1])) for axis in axes)
    return _Pieces(ends, tuple(axis[:-1].tolist() for axis in axes), np.ascontiguousarray(values))


def _smooth(row: dict[str, float]) -> list[float]:
    Hc = row["Hc"]
    return [
        math.log(Hc / film_formula(row["M"], row["L"] or _NO_PIEZO, row["D"])),
        math.log(row["Hmin"] / Hc),
        math.log(row["H0"] / Hc),
        math.log(row["K0"] / (1 - row["K0"])),
        math.log(row["C0"]),
        *(row[f"K_{x:g}"] for x in OMEGA),
        *(row[f"C_{x:g}"] for x in OMEGA),
    ]
