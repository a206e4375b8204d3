"""The steady film of a point contact, and how the contact answers a small harmonic approach."""

from __future__ import annotations

import dataclasses
import math
from dataclasses import dataclass
from functools import cached_property
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from bearingdyn.bearing.ehl import harmonic_approach
from bearingdyn.bearing.ehl.dimensionless_groups import LOAD, Groups
from bearingdyn.bearing.ehl.figures import Figured, Figures
from bearingdyn.bearing.ehl.flooding import Flooding
from bearingdyn.bearing.ehl.grid import Grid, prolonged
from bearingdyn.bearing.ehl.newton import Border, NegativeFilm, State, newton
from bearingdyn.bearing.ehl.oil import Density, Oil, Viscosity
from bearingdyn.bearing.ehl.reynolds import Reynolds
from bearingdyn.bearing.film_thickness import dimensionless_film
from bearingdyn.checks import nonnegative, positive, require
from bearingdyn.types import Array, Complex

_M, _L, _D = (0.5, 2e4), (0.0, 30.0), (0.01, 1.0)  # solved without failure in between
_COARSEST = 17  # nodes of a square grid
_THICK = (4.0, 2.0, 1.0, 0.5, 0.2)  # L on the way from Hertz to an oil that is thin under pressure
_LEVELS = 3  # refinements from the grid that starts at Hertz to the finest
# Two grids of pitch 2Δ and Δ differ by (2^p − 1) errors of the finer. The order p of films is 1.7 to 2.3.
_FINER = 1 / (2**1.7 - 1)
_EXTRAPOLATED = 1 / (2**1.7 - 1) - 1 / 3
# K0 and C0 jump by some 1e-3 and 1e-2 where the rupture passes a node. Steps from grid to grid that fall by
# less than this are such jumps, no trend; extrapolation from two grids would add a third to them.
_FALLS = 0.5
_FILMS = np.array([True, True, True, False, False])  # of Figures, those without jumps


@dataclass(frozen=True, repr=False)
class Level:
    """The steady film on one grid."""

    equations: Reynolds
    state: State

    @cached_property
    def figures(self) -> Figures:
        """Numbers of this grid."""
        groups, H = self.equations.groups, self.state.H
        K0, C0 = harmonic_approach.quasi_static(self.equations, self.state)
        return Figures(
            Hc=groups.moes * float(H[0, self.equations.grid.origin]),
            Hmin=groups.moes * _least(H),
            H0=groups.moes * (self.state.H0 + groups.approach),
            K0=K0,
            C0=C0,
        )


@dataclass(frozen=True, repr=False)
class Steady(Figured):
    """Steady film of a fully flooded point contact, isothermal; scales of H. Moes."""

    M: float
    L: float
    D: float
    levels: tuple[Level, ...]
    """The grids solved, the finest last."""
    extrapolated: bool
    """Whether figures are extrapolated to no pitch, or those of the finest grid."""

    def __repr__(self) -> str:
        numbers = ", ".join(f"{name}={value:.4g}" for name, value in self.figures._asdict().items())
        return f"Steady(M={self.M:g}, L={self.L:g}, D={self.D:g}: {numbers})"

    @cached_property
    def figures(self) -> Figures:
        """Hc, Hmin, H0, K0 and C0."""
        return Figures(*map(float, self._found[0]))

    @cached_property
    def error(self) -> Figures:
        """Relative errors of `figures` by the grid, estimated from the three finest; NaN with one grid only.

        Of figures that jump from grid to grid, and do not settle, the error is their scatter.
        """
        best, error = self._found
        return Figures(*map(float, error / np.abs(best)))

    @cached_property
    def _found(self) -> tuple[Array, Array]:
        """Figures and their absolute errors."""
        grids = np.array([level.figures for level in self.levels[-3:]])
        return _limit(grids, _FILMS) if self.extrapolated else _finest(grids)

    @property
    def approach(self) -> float:
        """Approach δ of the bodies over that of the dry contact."""
        groups = self.levels[-1].equations.groups
        return 1 - self.H0 / groups.moes / groups.approach

    @property
    def X(self) -> Array:
        """Places along the rolling direction of the finest grid, x/a, (nx,)."""
        return self.levels[-1].equations.grid.X

    @property
    def Y(self) -> Array:
        """Places across, y/b, both halves, (2 ny − 1,)."""
        Y = self.levels[-1].equations.grid.Y
        return np.concatenate([-Y[:0:-1], Y])

    @property
    def pressure(self) -> Array:
        """Pressure over the Hertz pressure, (Y, X), of the finest grid."""
        return _whole(self.levels[-1].state.P)

    @property
    def film(self) -> Array:
        """Film h/Rx √(E′Rx/(η0us)), (Y, X), of the finest grid."""
        return _whole(self.levels[-1].state.H) * self.levels[-1].equations.groups.moes

    def stiffness(self, Omega: ArrayLike) -> Complex:
        """Dynamic stiffness F̂/δ̂ of a harmonic approach δ̂ e^{iωt} over that of the dry contact.

        Parameters
        ----------
        Omega
            Frequencies ωa/um, any shape; complex ones for motions that decay.

        Returns
        -------
        complex, shape of `Omega`; K + iΩC/1.5 with C as in `C0`.
        """
        asked = np.asarray(Omega, dtype=complex)
        require(bool(np.isfinite(asked).all()), "Omega", Omega, "frequencies ωa/um must be finite")
        used = self.levels[-3:] if self.extrapolated else self.levels[-1:]
        found = np.array(
            [
                [harmonic_approach.stiffness(v.equations, v.state, x) for x in asked.ravel()] or np.zeros(0)
                for v in used
            ]
        )
        best = _limit(found.real)[0] + 1j * _limit(found.imag)[0]
        return np.asarray(best.reshape(asked.shape))


def steady(
    M: float,
    L: float,
    D: float = 1.0,
    *,
    viscosity: Viscosity = "roelands",
    density: Density = "dowson-higginson",
    grid: int | Literal["auto"] = "auto",
    inlet: float | None = None,
    accuracy: float = 0.01,
    alpha: float = 2.2e-8,
    eta0: float = 0.04,
    nodes: int = 400_000,
) -> Steady:
    """Solve the steady film of a smooth, isothermal, fully flooded point contact with a Newtonian oil.

    Parameters
    ----------
    M
        Load F/(E′Rx²) (E′Rx/(η0us))^¾, 2/E′ = Σ(1 − ν²)/E, us = u1 + u2; 0.5 to 2e4.
    L
        Lubricant αE′ (η0us/(E′Rx))^¼, 0 (isoviscous) to 30.
    D
        Ratio Rx/Ry of the radii along and across the rolling, 0.01 to 1.
    viscosity, density
        Laws of the oil over pressure.
    grid
        "auto" sizes the grid by `accuracy` and extrapolates from it and one of twice its pitch; K0 and C0,
        where they jump from grid to grid, from a line over pitch² fitted to three grids. A number n takes
        n × n nodes on the whole contact and extrapolates nothing.
    inlet
        Gap at which the oil begins, over hc, with 0.4 of it at the sides. Left out, the extent is that of
        published solutions. Oil that reaches further (100) adds some 1 % to the film of a circular contact
        and, at M = 20 to 100, 7 to 3 % to C0, and takes .01 to 0 from K0; a narrow contact hardly changes.
        Rigid bodies (M below 3.5 D^−0.59) have .5 to .77 of the film of endless oil (P. L. Kapitza 1955) in
        published extents, short of it as 1/√inlet.
    accuracy
        Relative error of the central film that "auto" aims at.
    alpha, eta0
        Pressure–viscosity coefficient, 1/Pa, and viscosity, Pa s: Roelands' and Dowson and Higginson's laws
        know absolute pressures. Without effect for "barus" with "incompressible".
    nodes
        Most nodes on one half of the contact; a finer grid is refused.

    Returns
    -------
    Steady

    Raises
    ------
    ValueError
        If a number is out of range, or the grid cannot resolve the film.
    ArithmeticError
        If the solution does not converge.

    References
    ----------
    C. H. Venner, A. A. Lubrecht, Multilevel Methods in Lubrication, 2000.
    H. Moes, Lubrication and Beyond, 2000.
    """
    _within("M", positive("M", M), _M)
    _within("L", nonnegative("L", L), _L)
    _within("D", positive("D", D), _D)
    require(viscosity in ("roelands", "barus"), "viscosity", viscosity, 'it must be "roelands" or "barus"')
    laws = ("dowson-higginson", "incompressible")
    require(density in laws, "density", density, f"it must be {' or '.join(map(repr, laws))}")
    aim = positive("accuracy", accuracy)
    require(1e-4 <= aim <= 0.1, "accuracy", accuracy, "it must lie in 1e-4..0.1")
    if inlet is not None:
        require(positive("inlet", inlet) >= 5, "inlet", inlet, "the oil must begin at a gap of 5 hc or more")
    groups = Groups(float(M), float(L), float(D))
    oil = Oil(viscosity, density, groups.piezo, positive("alpha", alpha), positive("eta0", eta0))
    require(
        eta0 > 6.4e-5, "eta0", eta0, "it must exceed 6.31e-5 Pa s for Roelands' law (give Pa s, not mPa s)"
    )
    expected = dimensionless_film(M, max(L, 1e-6), D) / groups.moes
    flooding = Flooding.around(groups, expected, inlet)
    compressed = expected / float(oil.relative_density(np.ones(1))[0][0])

    if grid == "auto":
        first = flooding.grid(groups, flooding.pitch(aim / 2, compressed), _LEVELS)
        needed = first.nx * first.ny * 4**_LEVELS
        remedy = f"needs some {needed:.1e} nodes here: ask for less, or allow more than nodes = {nodes}"
        require(needed <= nodes, "accuracy", accuracy, remedy)
        levels = _cascade(groups, oil, first, _LEVELS, compressed)
        return Steady(groups.M, groups.L, groups.D, levels, extrapolated=True)
    n = int(grid) if isinstance(grid, int | np.integer) else 0
    remedy = 'give "auto", or nodes along a side such as 65 or 129: a multiple of four and one, 17 or more'
    require(n >= _COARSEST and n % 4 == 1, "grid", grid, remedy)
    require(
        n * (n + 1) // 2 <= nodes, "grid", grid, f"is too large for nodes = {nodes}: give less or allow more"
    )
    halvings = 1
    while (n - 1) % 2 ** (halvings + 2) == 0 and (n - 1) // 2 ** (halvings + 1) >= _COARSEST - 1:
        halvings += 1
    first = flooding.square((n - 1) // 2**halvings + 1)
    try:
        levels = _cascade(groups, oil, first, halvings, compressed)
    except ArithmeticError as failure:
        enough = (flooding.inlet + flooding.outlet) / flooding.pitch(0.1, compressed)
        enough = 4 * math.ceil(enough / 4) + 1
        negative = isinstance(failure, NegativeFilm)
        if n >= enough and not negative:
            raise
        fails = "comes out negative" if negative else "does not converge"
        raise ValueError(
            f"grid is {n}; too coarse for a film of {compressed:.2g} a²/Rx, which {fails}; "
            f"give {max(enough, n + 4)} or more"
        ) from None
    return Steady(groups.M, groups.L, groups.D, levels, extrapolated=False)


def _limit(grids: Array, smooth: Array | bool = False) -> tuple[Array, Array]:
    """Limit of figures (n, …) on up to three grids, each of half the pitch before, and its error.

    By the two finest, which differ by three errors of the finer; figures that are not smooth and do not
    settle by least squares of a + b·pitch² over all three.
    """
    fine = grids[-1]
    if len(grids) == 1:
        return fine, np.full(fine.shape, math.nan)
    step = fine - grids[-2]
    limit = fine + step / 3
    if len(grids) == 2:
        return limit, np.abs(step) / 3
    before = grids[-2] - grids[-3]
    settles = np.abs(step) <= _FALLS * np.abs(before)
    limit = np.where(settles | smooth, limit, (4 * fine + 3 * grids[-2] - grids[-3]) / 6)
    # what the order that the three grids show would add instead of a third
    other = step**2 / np.where(settles & (step != 0), before - step, 1.0)
    by_order = np.maximum(_EXTRAPOLATED * np.abs(step), np.abs(other - step / 3))
    # a jump may hide in three grids that look settled: nothing less than the last step is promised
    by_order = np.where(smooth, by_order, np.maximum(by_order, np.abs(step)))
    scatter = np.abs(limit - grids[-2:]).max(axis=0)
    return limit, np.where(settles, by_order, scatter)


def _finest(grids: Array) -> tuple[Array, Array]:
    """Figures (n, …) of the finest of up to three grids, and their error."""
    steps = np.abs(np.diff(grids, axis=0))
    if len(steps) == 0:
        return grids[-1], np.full(grids[-1].shape, math.nan)
    settles = steps[-1] <= _FALLS * steps[0] if len(steps) == 2 else True
    return grids[-1], np.where(settles, _FINER * steps[-1], steps.max(axis=0))


def _cascade(groups: Groups, oil: Oil, first: Grid, halvings: int, Hc: float) -> tuple[Level, ...]:
    """Solutions on ever finer grids, each begun from the one before, the first from Hertz' pressure."""
    levels: list[Level] = []
    grid = first
    for k in range(halvings + 1):
        equations = Reynolds(grid, groups, oil)
        try:
            if levels:
                before = levels[-1]
                centre = float(before.state.H[0, before.equations.grid.origin])
                P, H0 = _laid(equations, prolonged(before.state.P), centre)
                state = newton(equations, P, H0, Border())
            else:
                state = _begun(equations, Hc)
            levels.append(Level(equations, state))
        except ArithmeticError:
            if k == halvings:
                raise
            levels = []  # too coarse: the next grid begins anew
        grid = grid.refined()
    return tuple(levels)


def _begun(equations: Reynolds, Hc: float) -> State:
    """The solution from Hertz' pressure; if need be by way of oils that pressure thickens more."""
    grid, groups = equations.grid, equations.groups
    P, H0 = _laid(equations, np.sqrt(np.maximum(0, 1 - grid.X**2 - grid.Y[:, None] ** 2)), Hc)
    try:
        return newton(equations, P, H0, Border())
    except ArithmeticError:
        if _THICK[0] <= groups.L:
            raise
    for L in _THICK:
        if groups.L < L:
            thicker = dataclasses.replace(groups, L=L)
            oil = dataclasses.replace(equations.oil, piezo=thicker.piezo)
            state = newton(dataclasses.replace(equations, groups=thicker, oil=oil), P, H0, Border())
            P, H0 = state.P, state.H0
    return newton(equations, P, H0, Border())


def _laid(equations: Reynolds, P: Array, Hc: float) -> tuple[Array, float]:
    """The pressures scaled to the load, and H0 so that the film at the centre is Hc, or positive all over."""
    P = P * (LOAD / float((equations.grid.weights * P).sum()))
    H = equations.film(P, 0.0)
    return P, max(Hc - float(H[0, equations.grid.origin]), 0.3 * Hc - float(H.min()))


def _within(field: str, value: float, limits: tuple[float, float]) -> None:
    low, high = limits
    require(low <= value <= high, field, value, f"it must lie in {low:g}..{high:g}, where the film is solved")


def _whole(half: Array) -> Array:
    return np.concatenate([half[:0:-1], half])


def _least(H: Array) -> float:
    """Least of a surface (ny, nx), by the parabolas through its least node and its neighbours."""
    j, i = np.unravel_index(int(H.argmin()), H.shape)
    best = float(H[j, i])
    if 0 < i < H.shape[1] - 1:
        best -= _dip(float(H[j, i - 1]), float(H[j, i]), float(H[j, i + 1]))
    if 0 < j < H.shape[0] - 1:
        best -= _dip(float(H[j - 1, i]), float(H[j, i]), float(H[j + 1, i]))
    return best


def _dip(left: float, middle: float, right: float) -> float:
    bend = left - 2 * middle + right
    return (right - left) ** 2 / (8 * bend) if bend > 0 else 0.0
