"""The force law of a ball bearing between two rigid rings.

Coordinates q (6,) = (x, y, z, θx, θy, θz): the inner ring relative to the outer, z along the shaft,
references on the axis at mid-width. Balls have no degrees of freedom; each is one spring and damper between
the groove centres (paper §2.2). Tilts enter linearly: an exact rotation adds −½Rθ² to the radial motion,
which matters from milliradians on (1.7 % in a pure-moment case of 4 mrad).
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from typing import TypeAlias

import numpy as np
from numpy.typing import ArrayLike

from bearingdyn.bearing.contact_pressure import check_bearing_pressure
from bearingdyn.bearing.energy_minimum import minimum
from bearingdyn.bearing.geometry import Geometry
from bearingdyn.bearing.hertz import PointContact
from bearingdyn.bearing.kernel import BearingKernel
from bearingdyn.bearing.load_and_motion_checks import check_load, check_motion, warn_of_lean
from bearingdyn.bearing.open_side import OPEN_SIDE_REMEDY, runs_off
from bearingdyn.bearing.raceway_series import RIGID, RacewaySeries
from bearingdyn.checks import number, vector
from bearingdyn.notice import OpenSideWarning, warn
from bearingdyn.plausible_ranges import check_speed_value, plausible
from bearingdyn.types import Array

_Response: TypeAlias = tuple[Array, Array, Array, Array]
_MOTION = "(x, y, z, θx, θy, θz) of the inner ring relative to the outer ring"


class RigidRingLaw(ABC):
    """What a ball bearing answers to a motion of its rigid rings: force, tangents, loads, equilibrium."""

    Dpw: float
    film: float
    angle0: float

    @property
    @abstractmethod
    def geometry(self) -> Geometry:
        """Balls and grooves."""

    @property
    @abstractmethod
    def inner_contact(self) -> PointContact:
        """Contact of a ball with the inner race."""

    @property
    @abstractmethod
    def outer_contact(self) -> PointContact:
        """Contact of a ball with the outer race."""

    @property
    @abstractmethod
    def static_rating(self) -> float:
        """Radial load with 4.2 GPa in the heavier contact, N."""

    @property
    @abstractmethod
    def kappa(self) -> float:
        """Deflection coefficient of one ball, N/m^1.5."""

    @property
    @abstractmethod
    def arm(self) -> float:
        """Arm of tilts and moments, m."""

    @property
    @abstractmethod
    def cage_ratio(self) -> float:
        """Cage speed over shaft speed."""

    @property
    @abstractmethod
    def _kernel(self) -> BearingKernel:
        """The bearing as the contact kernel takes it, between rigid rings."""

    def coefficients(self, series: RacewaySeries = RIGID) -> Array:
        """(n, 6) matrix from q to the raceway coefficients, lengths in m.

        Rows by default: radial cos ψ (x), radial sin ψ (y), axial mean (z), axial cos ψ (−R θy), axial
        sin ψ (+R θx).
        """
        return series.rigid(self.arm)

    def relative(self, q: ArrayLike) -> Array:
        """Raceway coefficients (5,), m, of a relative motion q (6,), m and rad."""
        return self.coefficients() @ vector("q", q, (6,), _MOTION)

    def force(
        self, q: ArrayLike, angle: float = 0.0, velocity: ArrayLike | None = None, speed: float = 0.0
    ) -> Array:
        """Load (6,), N and N m, that holds the inner ring at q: +∇V (minus it acts on the ring).

        Parameters
        ----------
        q
            (6,) inner relative to outer ring, m and rad.
        angle
            Cage angle, rad: the first ball stands at angle0 + angle.
        velocity
            (6,) rate of q, m/s and rad/s; None is rest.
        speed
            Speed of the shaft, rad/s; the cage turns at cage_ratio × speed and moves the balls through
            their indentations, which damping resists.

        Raises
        ------
        ValueError
            On a wrong shape, a value that is not finite, a motion that no bearing makes, or pressures above
            21 GPa.

        Warns
        -----
        BearingWarning
            Where a pressure exceeds 4.2 GPa (ISO 76), or the rings lean by more than .01 rad.
        OpenSideWarning
            Where balls are pressed onto the open side of an angular contact bearing.
        """
        rate = np.zeros(6) if velocity is None else velocity
        g, _, _, loads = self._checked(q, angle, rate, speed)
        self._doubt(q, angle, loads)
        return self.coefficients().T @ g

    def stiffness(self, q: ArrayLike, angle: float = 0.0) -> Array:
        """Tangent stiffness (6, 6) ∂force/∂q at rest, symmetric, N/m, N and N m; warns as `force`."""
        B, (_, K, _, loads) = self.coefficients(), self._checked(q, angle, np.zeros(6), 0.0)
        self._doubt(q, angle, loads)
        return B.T @ K @ B

    def damping_matrix(self, q: ArrayLike, angle: float = 0.0) -> Array:
        """Tangent damping (6, 6) ∂force/∂velocity at rest, symmetric, N s/m, N s and N m s."""
        B = self.coefficients()
        return B.T @ self._checked(q, angle, np.zeros(6), 0.0)[2] @ B

    def ball_loads(self, q: ArrayLike, angle: float = 0.0) -> Array:
        """Contact load (Z,) of each ball at rest, N, balls in the order of their azimuth."""
        return self._checked(q, angle, np.zeros(6), 0.0)[3]

    def energy(self, q: ArrayLike, angle: float = 0.0) -> float:
        """Energy stored in the contacts at rest, Σ (2/5)κ(δ + film)^{5/2}, J."""
        return self._kernel.stored(self.ball_loads(q, angle))

    def displacement(self, load: ArrayLike, angle: float = 0.0) -> Array:
        """Static equilibrium q (6,) of the inner ring under a load (6,), θz held, outer ring fixed.

        Where the loaded balls leave a motion free (a ring resting on one ball rolls sideways), the
        ring stays at its origin in that motion.

        Parameters
        ----------
        load
            (6,) forces N and moments N m on the inner ring; whatever holds θz carries the moment about z.
        angle
            Cage angle, rad.

        Raises
        ------
        ValueError
            On a wrong shape or a value that is not finite, for a load that presses balls onto the open side
            of an angular contact bearing, and for one under which a pressure exceeds 21 GPa.
        ArithmeticError
            If no equilibrium is found.

        Warns
        -----
        BearingWarning
            Where a pressure exceeds 4.2 GPa (ISO 76), or the rings lean by more than .01 rad.
        """
        f = vector("load", load, (6,), "(Fx, Fy, Fz, Mx, My, Mz) on the inner ring in N and N m")
        check_load("load", f)
        angle = plausible("turned angle", "angle", angle, "it must be a finite angle in rad")
        turn = self.angle0 + angle
        R = self.arm
        target = np.array([f[0], f[1], f[2], -f[4] / R, f[3] / R])
        still = np.zeros(5)
        shaft = angle / self.cage_ratio if self.cage_ratio else 0.0
        from bearingdyn import core  # late: the compiled kernel is needed only here and in _evaluate

        def stored(z: Array) -> tuple[float, Array, Array, float]:
            g, K, _, loads = core.bearing_force(self._kernel, z, still, turn, 0.0, shaft)
            return self._kernel.stored(loads), g, K, float(loads.sum())

        expected = (
            (float(np.linalg.norm(target)) / self.kappa) ** (2 / 3) + abs(self.geometry.Pd) / 2 + self.film
        )
        z = minimum(stored, target, expected or 1e-9)
        loads = core.bearing_force(self._kernel, z, still, turn, 0.0, shaft)[3]
        astray = runs_off(self._kernel, z, loads, turn) if self._kernel.shoulder else ""
        if astray:
            raise ValueError(f"load is {f.tolist()}; {astray}; {OPEN_SIDE_REMEDY}")
        check_bearing_pressure(self, loads)
        warn_of_lean(math.hypot(z[3], z[4]) / R)
        return np.array([z[0], z[1], z[2], z[4] / R, -z[3] / R, 0.0])

    def evaluate(self, q: ArrayLike, angle: float = 0.0) -> _Response:
        """Force (5,), stiffness and damping (5, 5) on the raceway coefficients and loads (Z,), at rest.

        For searches, which pass through motions that no bearing makes: q is not judged, nor are pressures.
        """
        return self._evaluate(q, angle, np.zeros(6), 0.0)

    def _doubt(self, q: ArrayLike, angle: float, loads: Array) -> None:
        """Warn of a motion that overloads the balls, presses them onto the open side, or leans far."""
        check_bearing_pressure(self, loads)
        if not loads.max(initial=0.0) > 0:
            return
        z = self.relative(q)
        astray = runs_off(self._kernel, z, loads, self.angle0 + angle) if self._kernel.shoulder else ""
        if astray:
            warn(f"at this q {astray}; {OPEN_SIDE_REMEDY}", OpenSideWarning)
        warn_of_lean(math.hypot(z[3], z[4]) / self.arm)

    def _checked(self, q: ArrayLike, angle: float, velocity: ArrayLike, speed: float) -> _Response:
        """`_evaluate` at a motion that a bearing can make."""
        check_motion("q", vector("q", q, (6,), _MOTION))
        plausible("turned angle", "angle", angle, "it must be a finite angle in rad")
        return self._evaluate(q, angle, velocity, speed)

    def _evaluate(self, q: ArrayLike, angle: float, velocity: ArrayLike, speed: float) -> _Response:
        from bearingdyn import core

        z = self.relative(q)
        zdot = self.coefficients() @ vector("velocity", velocity, (6,), f"rate of {_MOTION}")
        angle = number("angle", angle, "it must be a finite angle in rad")
        turn = self.angle0 + angle
        cage = self.cage_ratio * plausible("speed", "speed", speed, "it must be a finite speed in rad/s")
        check_speed_value("speed", speed, self.Dpw)
        # the shaft has turned so far that the cage stands at `angle`
        shaft = angle / self.cage_ratio if self.cage_ratio else 0.0
        response: _Response = core.bearing_force(self._kernel, z, zdot, turn, cage, shaft, speed)
        return response
