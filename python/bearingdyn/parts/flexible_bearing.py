"""A ball bearing by itself, one of its rings elastic: force, stiffness and loads of the balls at rest."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import cached_property
from typing import NamedTuple

import numpy as np
import scipy
from numpy.typing import ArrayLike

from bearingdyn.bearing import OPEN_SIDE_REMEDY, BallBearing, BearingKernel, minimum, runs_off
from bearingdyn.checks import instance, numbers, vector
from bearingdyn.cms import Superelement
from bearingdyn.material import warn_beyond
from bearingdyn.parts.flexible_ring import FlexibleRing
from bearingdyn.parts.ring_support import waves
from bearingdyn.pictures import page
from bearingdyn.types import Array, Index


class _State(NamedTuple):
    z: Array
    """(n,) coefficients of the raceway, m."""
    g: Array
    """(n,) force of the inner ring on the relative coefficients, N."""
    K: Array
    """(n, n) tangent of the balls, N/m."""
    loads: Array


@dataclass(frozen=True)
class FlexibleBearing:
    """A bearing with one flexible ring, on a rigid shaft in a rigid housing at rest; rubber at its relaxed
    modulus.

    As BallBearing: q (6,) is the motion of the inner ring, m and rad, here against the housing; where the
    inner ring is the flexible one, of its seat.

    Raises
    ------
    ValueError
        For a ring made for another arm, or one that no rigid interface holds.
    """

    bearing: BallBearing
    ring: FlexibleRing

    _repr_html_ = page

    def __post_init__(self) -> None:
        instance("bearing", self.bearing, BallBearing, "it must be a bd.BallBearing")
        instance("ring", self.ring, FlexibleRing, "it must be a bd.FlexibleRing")
        own = self.ring.bearing
        if own is None or own.Z != self.bearing.Z:
            told = "None" if own is None else f"one of {own.Z} balls"
            raise ValueError(
                f"ring.bearing is {told}; what a ring gives beyond Hertz depends on its {self.bearing.Z} "
                f"balls: make it with bearing="
            )
        assert self.ring.arm is not None
        if not math.isclose(self.bearing.arm, self.ring.arm, rel_tol=1e-9):
            raise ValueError(
                f"ring.arm is {self.ring.arm:.9g}; it must be the bearing's, {self.bearing.arm:.9g} m"
            )
        if self.ring.layer is None and self.ring.outside == "flexible":
            raise ValueError(f"ring.outside is {self.ring.outside!r}, and nothing holds the ring")

    @cached_property
    def _element(self) -> Superelement:
        return self.ring.superelement()

    @cached_property
    def raceway_stiffness(self) -> Array:
        """Static stiffness (n, n) of the raceway's coefficients, the ring's outside held, N/m."""
        element = self._element
        warn_beyond(
            [("the ring", term.material) for term in element.viscoelastic],
            math.inf,
            "the static stiffness",
        )
        rest = np.setdiff1d(np.arange(element.n), element.interfaces[self.ring.held])
        K = element.stiffness().real[np.ix_(rest, rest)]
        rows = element.raceways["raceway"].rows[:, rest]
        S = np.linalg.inv(rows @ np.linalg.solve(K, rows.T))
        return np.asarray(0.5 * (S + S.T))

    @cached_property
    def _relative(self) -> Array:
        return self.bearing.coefficients(self._element.raceways["raceway"].series)

    @cached_property
    def _kernel(self) -> BearingKernel:
        raceway = self._element.raceways["raceway"]
        return replace(self.bearing.kernel(raceway.series), give=raceway.give)

    def _press(self, relative: Array, angle: float) -> tuple[float, Array, Array, Array]:
        """Energy of the balls, force, tangent and loads at relative coefficients."""
        from bearingdyn import core  # late: only here is the compiled kernel needed

        b = self.bearing
        kernel = self._kernel
        shaft = angle / b.cage_ratio if b.cage_ratio else 0.0
        g, K, _, loads = core.bearing_force(kernel, relative, 0 * relative, b.angle0 + angle, 0.0, shaft)
        return kernel.stored(loads), g, K, loads

    def _settle(self, q: ArrayLike, angle: float) -> _State:
        """The raceway's shape at which the ring balances the balls, the inner ring held at q."""
        own = self._relative @ vector("q", q, (6,), "(x, y, z, θx, θy, θz) of the inner ring")
        S = self.raceway_stiffness

        def stored(z: Array) -> tuple[float, Array, Array, float]:
            energy, g, K, loads = self._press(own - z, angle)
            return energy + 0.5 * float(z @ S @ z), S @ z - g, S + K, float(loads.sum())

        # the first guess of a size; the trust region grows by itself
        z = minimum(stored, np.zeros(len(S)), 1e-6)
        _, g, K, loads = self._press(own - z, angle)
        return _State(z, g, K, loads)

    def raceway(self, q: ArrayLike, angle: float = 0.0) -> Array:
        """Displacement (n,) of the raceway, m, coefficients as in RacewaySeries.up_to(ring.order); an inner
        ring's against its seat."""
        return self._sign * self._settle(q, angle).z

    @property
    def _sign(self) -> float:
        """Of the load of the balls on the ring: the outer one is pressed by g, the inner one by −g."""
        return -1.0 if self.ring.inner else 1.0

    def race(self, q: ArrayLike, azimuth: ArrayLike, angle: float = 0.0) -> Array:
        """Displacement (p, 2) of the race at azimuths (p,), rad: radial and axial, m, by its orders."""
        return self._around("raceway", self._sign * self._settle(q, angle).g, azimuth)

    def outside(self, q: ArrayLike, azimuth: ArrayLike, angle: float = 0.0) -> Array:
        """The same of the ring's outside, where it stands on beds or points.

        A bed of stiffness k presses the ring there by k times the radial motion, Pa.

        Raises
        ------
        ValueError
            For a ring whose outside is kept round, or in rubber.
        """
        if self.ring.back not in self.ring.body.grooves:
            raise ValueError(
                f"ring.outside is {self.ring.outside!r}; its outside does not move by orders: "
                f"give the ring a RingBed or RingPoints"
            )
        return self._around(self.ring.back, self._sign * self._settle(q, angle).g, azimuth)

    def hoop_stress(self, q: ArrayLike, azimuth: ArrayLike, angle: float = 0.0) -> Array:
        """Stress along the ring's outside at mid-width, an inner one's bore, (p,), Pa, by its orders.

        It is that of the bending between the balls, without fit and spin. The pressure p of what holds the
        ring is left out, which adds −ν/(1 − ν) p.

        Parameters
        ----------
        q
            Of the inner ring, as in `force`.
        azimuth
            (p,), rad.
        angle
            Of the cage.

        Raises
        ------
        ValueError
            For a ring whose outside is kept round.
        """
        ring = self.ring
        if ring.layer is None and ring.back not in ring.body.grooves:
            raise ValueError(
                f"ring.outside is {ring.outside!r}; an outside that is kept round has no hoop strain: give "
                f"the ring a RingBed, RingPoints or rubber"
            )
        psi = numbers("azimuth", azimuth, "it must hold angles in rad")
        # a gauge of a tenth of the width along the axis
        z = (-0.05 * ring.width, 0.05 * ring.width)
        rows = ring.body.hoop_stress(ring.seat, z, psi, ring.material)
        x = np.zeros(self._element.n)
        x[self._rest] = self._deformed(self._sign * self._settle(q, angle).g)
        return rows @ x[: rows.shape[1]]

    @property
    def _rest(self) -> Index:
        """Coordinates but those of the seat, which is held."""
        return np.setdiff1d(np.arange(self._element.n), self._element.interfaces[self.ring.held])

    def _deformed(self, g: Array) -> Array:
        """The ring's coordinates but those of its seat, under loads g on the raceway."""
        element, rest = self._element, self._rest
        K = element.stiffness().real[np.ix_(rest, rest)]
        return np.asarray(np.linalg.solve(K, element.raceways["raceway"].rows[:, rest].T @ g))

    def _around(self, name: str, g: Array, azimuth: ArrayLike) -> Array:
        element, psi = self._element, numbers("azimuth", azimuth, "it must hold angles in rad")
        rest, x = self._rest, self._deformed(g)
        # the ring's own coordinates come first; what stands around it moves its outside only through them
        found = self.ring.body.superelement().raceways[name]
        z = (
            found.rows @ x[: found.rows.shape[1]]
            if name == self.ring.back
            else element.raceways[name].rows[:, rest] @ x
        )
        return np.stack([waves(found.series, psi, axial) @ z for axial in (0, 1)], axis=-1)

    def force(self, q: ArrayLike, angle: float = 0.0) -> Array:
        """Load (6,), N and N m, that holds the inner ring at q: +∇V, with the ring settled."""
        return np.asarray(self._relative.T @ self._settle(q, angle).g)

    def stiffness(self, q: ArrayLike, angle: float = 0.0) -> Array:
        """Tangent stiffness (6, 6) ∂force/∂q, the ring following; N/m, N and N m."""
        K = self._settle(q, angle).K
        # balls and ring in series: K − K (S + K)⁻¹ K
        series = K - K @ scipy.linalg.solve(self.raceway_stiffness + K, K, assume_a="pos")
        return np.asarray(self._relative.T @ (0.5 * (series + series.T)) @ self._relative)

    def ball_loads(self, q: ArrayLike, angle: float = 0.0) -> Array:
        """Contact load (Z,) of each ball, N, balls in the order of their azimuth."""
        return self._settle(q, angle).loads

    def energy(self, q: ArrayLike, angle: float = 0.0) -> float:
        """Energy stored in the contacts and the ring, J; force is its gradient."""
        z = self._settle(q, angle).z
        own = self._relative @ np.asarray(q, dtype=np.float64)
        return self._press(own - z, angle)[0] + 0.5 * float(z @ self.raceway_stiffness @ z)

    def displacement(self, load: ArrayLike, angle: float = 0.0) -> Array:
        """Static equilibrium q (6,) of the inner ring under a load (6,), θz held, the housing fixed.

        Raises
        ------
        ValueError
            For a load of another shape, or one that presses balls onto the open side.
        ArithmeticError
            If no equilibrium is found.
        """
        f = vector("load", load, (6,), "(Fx, Fy, Fz, Mx, My, Mz) on the inner ring in N and N m")
        S, B = self.raceway_stiffness, self._relative
        # tilts as lengths at the arm, so that all unknowns are of one kind
        unit = np.diag([1.0, 1.0, 1.0, 1 / self.bearing.arm, 1 / self.bearing.arm])
        J = np.hstack([B[:, :5] @ unit, -np.eye(len(S))])

        def stored(x: Array) -> tuple[float, Array, Array, float]:
            energy, g, K, loads = self._press(J @ x, angle)
            z = x[5:]
            gradient = J.T @ g
            gradient[5:] += S @ z
            hessian = J.T @ K @ J
            hessian[5:, 5:] += S
            return energy + 0.5 * float(z @ S @ z), gradient, hessian, float(loads.sum())

        size = (float(np.linalg.norm(f)) / self.bearing.kappa) ** (2 / 3) + abs(self.bearing.geometry.Pd) / 2
        x = minimum(stored, np.concatenate([unit @ f[:5], np.zeros(len(S))]), size or 1e-9)
        kernel, relative = self._kernel, J @ x
        astray = runs_off(kernel, relative, self._press(relative, angle)[3], self.bearing.angle0 + angle)
        if astray:
            raise ValueError(f"load is {f.tolist()}; {astray}; {OPEN_SIDE_REMEDY}")
        return np.concatenate([unit @ x[:5], [0.0]])
