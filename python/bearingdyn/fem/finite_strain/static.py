"""Static balance of a body that rigid surfaces squeeze: Newton's method, with contact that may open."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np

from bearingdyn.fem.factors import factorise
from bearingdyn.types import Array, Index

TOLERANCE = 1e-11  # out-of-balance force over the largest nodal force: what round-off leaves is some 1e-13
ITERATIONS = 25
SMALLEST = 1 / 64  # step, over the whole squeeze, below which the search is given up
SETTLED = 1e-3  # out-of-balance force, over the largest, from which contact may change
PATIENCE, HOPELESS = 10, 0.01  # iterations after which an out-of-balance force so large is given up
CHANGES = 20  # further iterations for each wall
GENTLE = 4  # changes of contact after which one coordinate changes at a time
LEAST_VOLUME = 0.05  # ratio of areas or volumes at a point below which a trial step is shortened


class State(Protocol):
    """What a static balance asks of a body at finite strain."""

    @property
    def volume_ratio(self) -> float:
        """Positive where no element is turned inside out."""

    @property
    def force(self) -> Array:
        """Nodal forces (n,) that hold it, N."""

    @property
    def pressures(self) -> Array:
        """The pressures of the elements, Pa."""

    def pressures_after(self, du: Array) -> Array:
        """Those that a further displacement (n,) leads to, linearised."""

    def tangent(self, pressures: Array | None = None) -> Any:
        """Sparse (n, n), N/m, its geometric part at given pressures."""


@dataclass(frozen=True, eq=False)
class Wall:
    """A wall for a static state: frictionless, coordinates cannot pass: sign·u <= gap + sign·travel·s.

    Parameters
    ----------
    at
        (k,) coordinates.
    sign
        +1 if the wall stands at the coordinates' greater side, −1 if at the lesser.
    gap
        (k,) distance of each from the wall at s = 0, m.
    travel
        Motion of the wall along the coordinates, m, at s = 1.
    """

    at: Index
    sign: float
    gap: Array
    travel: float


@dataclass(frozen=True, eq=False)
class Balance:
    """The balance of a static state at finite strain.

    Parameters
    ----------
    u
        (n,) displacement, m.
    state
        The body there.
    touching
        Of each wall, (k,) whether a coordinate stands at it.
    """

    u: Array
    state: Any
    touching: tuple[Any, ...]


class NoBalance(ArithmeticError):
    """No static balance at finite strain was found beyond a share of the squeeze.

    Parameters
    ----------
    share
        Of the squeeze asked for that was reached.
    reason
        What stopped it.
    state
        The body where it stopped.
    """

    def __init__(self, share: float, reason: str, state: Any) -> None:
        super().__init__(reason)
        self.share = share
        self.reason = reason
        self.state = state


def balance(
    state: Callable[[Array], State],
    n: int,
    free: Index,
    held: Index,
    travel: Array | Callable[[float], Array],
    walls: Sequence[Wall] = (),
    check: Callable[[Any], str | None] = lambda state: None,
) -> Balance:
    """Static balance at finite strain: the state after held coordinates and walls have travelled.

    Parameters
    ----------
    state
        The body under a displacement (n,).
    n
        Number of coordinates.
    free
        Coordinates that exist; the others stay at zero.
    held
        Coordinates that are moved.
    travel
        How far each of them is moved, m; or that by the share s of the whole, as of a surface that turns.
    walls
        Rigid surfaces without friction.
    check
        Why a converged state is refused; None if it is not.

    Raises
    ------
    NoBalance
        With the share of the travel that was reached, where steps of 1/64 of it fail.
    """
    u = np.zeros(n)
    touching = tuple(wall.gap <= 1e-9 * max(abs(wall.travel), float(np.ptp(wall.gap))) for wall in walls)
    reached, step = 0.0, 1.0
    reasons: list[str] = []  # since the last step that worked
    here = Balance(u, state(u), touching)
    moved = travel if callable(travel) else (lambda share: share * travel)
    if not np.any(moved(1.0)) and not any(wall.travel for wall in walls):
        return here  # nothing moves, and there are no forces to measure a balance by
    while reached < 1.0:
        target = min(1.0, reached + step)
        try:
            here = _newton(state, n, free, held, moved(target), walls, here, target)
            refused = check(here.state)
            if refused:
                reasons.insert(0, refused)  # what is known of a state tells more than a search that failed
                raise _Failed(refused)
        except _Failed as failure:
            reasons.append(str(failure))
            step *= 0.5
            here = Balance(u, state(u), touching)
            if step < SMALLEST:
                raise NoBalance(reached, reasons[0], here.state) from None
            continue
        u, touching, reached = here.u, here.touching, target
        reasons.clear()
        step = min(2.0 * step, 1.0)
    return here


class _Failed(Exception):
    """A step of the squeeze that does not work."""


def _newton(
    state: Callable[[Array], State],
    n: int,
    free: Index,
    held: Index,
    place: Array,
    walls: Sequence[Wall],
    start: Balance,
    target: float,
) -> Balance:
    """One step, from a balanced state, to where the held coordinates are at their place.

    Pressures are iterated beside the displacements (the mixed form of Newton's method): those of a trial
    displacement are the bulk modulus times what it gets wrong of the volume, and would spoil the next
    tangent.
    """
    p = start.state.pressures
    u, now, touching = start.u, start.state, [t.copy() for t in start.touching]
    worst, changes = np.inf, 0
    for iteration in range(ITERATIONS + sum(wall.at.size > 0 for wall in walls) * CHANGES):
        goal = np.full(n, np.nan)
        goal[held] = place
        for wall, touch in zip(walls, touching, strict=True):
            goal[wall.at[touch]] = (wall.sign * wall.gap + wall.travel * target)[touch]
        given = np.flatnonzero(~np.isnan(goal))
        open_ = np.setdiff1d(free, given)
        f, K = now.force, now.tangent(p)
        jump = goal[given] - u[given]
        du = np.zeros(n)
        du[given] = jump
        load = -f[open_] - K[open_][:, given] @ jump
        try:
            du[open_] = factorise(K[open_][:, open_]).solve(load)
        except RuntimeError:
            raise _Failed("the tangent of the body is singular: it buckles, or is free to move") from None
        share = 1.0
        while True:
            trial = state(u + share * du)
            if trial.volume_ratio > LEAST_VOLUME:
                break
            share *= 0.5
            if share < 1e-2:
                raise _Failed(
                    "elements turn inside out; squeeze less, recess the free ends, or let the surfaces slip"
                )
        p = p + share * (now.pressures_after(du) - p)
        u, now = u + share * du, trial
        f = now.force
        scale = float(np.abs(f).max())
        residual = float(np.abs(f[open_]).max(initial=0.0))
        if not np.isfinite(residual):
            raise _Failed("the forces are not finite")
        near = share == 1.0 and residual <= SETTLED * scale
        if near and _contact_changes(walls, touching, u, f, target, scale, gently=changes > GENTLE):
            changes, worst = changes + 1, np.inf
            continue
        # balanced, or as balanced as round-off lets it be
        if near and residual <= (TOLERANCE if residual < 0.5 * worst else 1e-9) * scale:
            return Balance(u, now, tuple(touching))
        worst = min(worst, residual)
        if worst > HOPELESS * scale and iteration >= PATIENCE:
            break
    raise _Failed(
        "the search for balance does not settle: a free surface folds over the edge of a bond, or the body "
        "buckles; recess the free ends, let the surfaces slip, or squeeze less"
    )


def _contact_changes(
    walls: Sequence[Wall],
    touching: list[Any],
    u: Array,
    f: Array,
    target: float,
    scale: float,
    gently: bool,
) -> bool:
    """Let coordinates come to touch that are past a wall; if there are none, let go of those that are pulled.

    `gently` changes one coordinate of each wall at a time: all at once may come back to where it was.
    """
    past = [wall.sign * u[wall.at] - wall.gap - wall.sign * wall.travel * target for wall in walls]
    for sign, excess in (
        (
            True,
            [
                np.where(t, -1.0, p - 1e-9 * abs(w.travel))
                for w, t, p in zip(walls, touching, past, strict=True)
            ],
        ),
        (
            False,
            [
                np.where(t, w.sign * f[w.at] - 1e-9 * scale, -1.0)
                for w, t in zip(walls, touching, strict=True)
            ],
        ),
    ):
        if not any((x > 0.0).any() for x in excess):
            continue
        for touch, x in zip(touching, excess, strict=True):
            if gently and (x > 0.0).any():
                touch[np.argmax(x)] = sign
            else:
                touch[x > 0.0] = sign
        return True
    return False
