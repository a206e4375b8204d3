"""Quasi-static equilibrium of a turning bearing: centrifugal load and gyroscopic moment of the balls.

A. B. Jones (1960) and T. A. Harris, Rolling Bearing Analysis (high-speed ball bearings). Each ball is held by
two contacts with angles of their own: n_i = (sinα_i, cosα_i) along z and r towards the inner groove centre,
n_o away from the outer one. With t = (cosα, −sinα) the ball is in balance if
Q_i n_i + T_i t_i − Q_o n_o − T_o t_o + (0, F_c) = 0, where the tangential forces T = λ M_g/Dw, λ_i + λ_o = 2,
turn the ball's axis with the cage: M_g = J ω_m ω_R sinβ about the direction of travel.

Derivatives are complex steps, exact to round-off. The gyroscopic moment has no potential: the tangent is not
symmetric at speed.
"""

from __future__ import annotations

import math
from contextlib import suppress
from dataclasses import dataclass
from functools import cached_property
from typing import Any, Literal, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from bearingdyn.bearing.ball_bearing import BallBearing
from bearingdyn.bearing.energy_minimum import minimum
from bearingdyn.checks import number, require, vector
from bearingdyn.plausible_ranges import check_speed_value, plausible
from bearingdyn.types import Array

_STEP = 1e-30
_ITERATIONS = 80
# of the loads of a ball; beside it the round-off of distances, which a lightly loaded ball feels more
_BALANCED = 1e-11
# cosines of contact angles (80°, 70°) between which a ball is taken to have left the inner race
_OPEN = (0.17, 0.34)
_ROUNDING = 8 * float(np.finfo(float).eps)


class Balls(NamedTuple):
    """Balls of a turning bearing with their inertia loads, in the order of their azimuth; all (Z,)."""

    azimuth: Array
    """rad, from x towards y."""
    Q_i: Array
    """Load of the inner contact, N."""
    Q_o: Array
    """Load of the outer contact, N."""
    alpha_i: Array
    """Contact angle at the inner race, rad; positive if the inner ring is pushed towards +z there."""
    alpha_o: Array
    """Contact angle at the outer race, rad."""
    centrifugal: Array
    """Centrifugal force F_c, N."""
    gyroscopic: Array
    """Gyroscopic moment M_g, N m."""
    orbit: Array
    """Orbital speed ω_m, rad/s."""


class _Motion(NamedTuple):
    orbit: Any
    centrifugal: Any
    gyroscopic: Any


@dataclass(frozen=True)
class Running:
    """A turning bearing with the inertia of its balls; its rings turn as its `turning` says.

    Parameters
    ----------
    bearing
        The bearing; waviness, defects and unequal balls are not taken. Half of its film is on each race; a κ
        of its own is shared by the races as Hertz's would be.
    speed
        Speed of the shaft, rad/s.
    control
        Race on which the balls do not spin, which sets the ball's attitude β: "outer" with λ_o = 2, λ_i = 0,
        or "inner" with λ_i = λ_o = 1, as Harris has it.

    Raises
    ------
    ValueError
        Naming the field: a bearing with imperfections, a speed that is not finite, an unknown control.
    """

    bearing: BallBearing
    speed: float
    control: Literal["outer", "inner"] = "outer"

    def __post_init__(self) -> None:
        require(isinstance(self.bearing, BallBearing), "bearing", self.bearing, "give a BallBearing")
        flaws = self.bearing.waviness or self.bearing.defects or self.bearing.oversize
        require(
            not flaws, "bearing", self.bearing, "it must have neither waviness, defects nor unequal balls"
        )
        plausible("speed", "speed", self.speed, "it must be a finite speed in rad/s")
        check_speed_value("speed", self.speed, self.bearing.Dpw)
        require(self.control in ("outer", "inner"), "control", self.control, 'it must be "outer" or "inner"')

    def balls(self, q: ArrayLike, angle: float = 0.0) -> Balls:
        """Loads, contact angles and inertia forces of the balls with the inner ring at q (6,), m and rad.

        Raises
        ------
        ValueError
            On a wrong shape.
        ArithmeticError
            If a ball finds no balance.
        """
        psi, I, _ = self._grooves(self.bearing.relative(q), angle)
        b = self._balance(I)
        n_o, n_i, Q_o, Q_i = self._contacts(b, I)
        motion = self._motion(n_o, n_i)
        return Balls(
            psi,
            Q_i,
            Q_o,
            np.arctan2(*n_i),
            np.arctan2(*n_o),
            motion.centrifugal,
            motion.gyroscopic,
            motion.orbit,
        )

    def force(self, q: ArrayLike, angle: float = 0.0) -> Array:
        """Load (6,), N and N m, that holds the inner ring at q (6,), m and rad; as BallBearing.force."""
        return self.bearing.coefficients().T @ self._response(self.bearing.relative(q), angle)[0]

    def stiffness(self, q: ArrayLike, angle: float = 0.0) -> Array:
        """Tangent (6, 6) ∂force/∂q, the balls in balance; N/m, N and N m. Not symmetric at speed."""
        B = self.bearing.coefficients()
        return B.T @ self._response(self.bearing.relative(q), angle)[1] @ B

    def displacement(self, load: ArrayLike, angle: float = 0.0) -> Array:
        """Equilibrium q (6,) of the inner ring under a load (6,) in N and N m; as BallBearing.displacement.

        The convex problem without gyroscopic moment is solved first, then Newton's method on the whole.

        Raises
        ------
        ValueError
            On a wrong shape or a value that is not finite.
        ArithmeticError
            If no equilibrium is found.
        """
        f = vector("load", load, (6,), "(Fx, Fy, Fz, Mx, My, Mz) on the inner ring in N and N m")
        R = self.bearing.arm
        target = np.array([f[0], f[1], f[2], -f[4] / R, f[3] / R])
        still = self.bearing.displacement(f, angle)
        if self.speed == 0:
            return still
        expected = float(np.linalg.norm(self.bearing.relative(still))) + self._throw
        z = minimum(lambda z: self._frozen(z, angle), target, expected)
        g, K = self._response(z, angle)
        scale = float(np.linalg.norm(target)) + self.bearing.Z * self._nominal_force
        for _ in range(_ITERATIONS):
            residual = float(np.linalg.norm(target - g))
            if residual <= 1e-10 * scale:
                return np.array([z[0], z[1], z[2], z[4] / R, -z[3] / R, 0.0])
            step = np.linalg.lstsq(K, target - g, rcond=1e-12)[0]
            for _ in range(30):
                with suppress(ArithmeticError):  # too far for the balls: halve
                    g_new, K_new = self._response(z + step, angle)
                    if float(np.linalg.norm(target - g_new)) < residual:
                        break
                step = step / 2
            else:
                break
            z, g, K = z + step, g_new, K_new
        raise ArithmeticError(
            f"no equilibrium at {self.speed:.6g} rad/s under {f.tolist()}: {residual:.3g} N are left; "
            "is the load enough to hold the balls against their centrifugal force?"
        )

    # ------------------------------------------------------------ geometry and kinematics

    @cached_property
    def _races(self) -> tuple[float, float, float, float]:
        """Groove centre to ball centre without load (inner, outer), m, and κ_i, κ_o, N/m^1.5."""
        brg = self.bearing
        share = brg.kappa / _series(brg.inner_contact.kappa, brg.outer_contact.kappa)
        rest = [(f - 0.5) * brg.Dw - brg.film / 2 for f in (brg.fi, brg.fo)]
        return rest[0], rest[1], share * brg.inner_contact.kappa, share * brg.outer_contact.kappa

    @cached_property
    def _mass(self) -> float:
        return self.bearing.ball_material.density * math.pi / 6 * self.bearing.Dw**3

    @cached_property
    def _nominal_force(self) -> float:
        """Centrifugal force at the nominal orbital speed, N."""
        return self._mass * self.bearing.Dpw / 2 * (self.bearing.cage_ratio * self.speed) ** 2

    @cached_property
    def _throw(self) -> float:
        """How far the nominal centrifugal force presses a ball into the outer race, m."""
        return float((self._nominal_force / self._races[3]) ** (2 / 3))

    def _grooves(self, z: Array, angle: float) -> tuple[Array, Array, Array]:
        """Azimuths (Z,), inner groove centres from the outer, (2, Z) axial and radial, and rows on z."""
        brg = self.bearing
        start = brg.angle0 + number("angle", angle, "it must be a finite angle in rad")
        psi = start + 2 * math.pi * np.arange(brg.Z) / brg.Z
        c, s, one, no = np.cos(psi), np.sin(psi), np.ones(brg.Z), np.zeros(brg.Z)
        rows = np.array([[no, no, one, c, s], [c, s, no, no, no]])  # (2, 5, Z)
        kernel = brg.kernel()
        return psi, np.array([[kernel.x0], [kernel.y0]]) + np.einsum("akj,k->aj", rows, z), rows

    def _contacts(self, b: Any, I: Any) -> tuple[Any, Any, Any, Any]:
        """Unit vectors n_o, n_i (2, Z) as (sinα, cosα), and loads Q_o, Q_i (Z,)."""
        rest_i, rest_o, kappa_i, kappa_o = self._races
        l_o, l_i = _length(b), _length(I - b)
        return b / l_o, (I - b) / l_i, _load(kappa_o, l_o - rest_o), _load(kappa_i, l_i - rest_i)

    def _motion(self, n_o: Any, n_i: Any) -> _Motion:
        """Orbit, centrifugal force and gyroscopic moment of a ball rolling on both races (Harris)."""
        brg, ratio = self.bearing, self.bearing.Dw / self.bearing.Dpw
        # a ball far from the inner race has no angle there: it runs on as one with equal angles would
        part = (n_i[1] - _OPEN[0]) / (_OPEN[1] - _OPEN[0])
        part = np.where(part.real <= 0, 0.0, np.where(part.real >= 1, 1.0, part * part * (3 - 2 * part)))
        mixed = n_o + part * (n_i - n_o)
        (s_o, c_o), (s_i, c_i) = n_o, mixed / _length(mixed)
        tan = s_o / (c_o + ratio) if self.control == "outer" else s_i / (c_i - ratio)
        outer = (c_o + tan * s_o) / (1 + ratio * c_o)
        inner = (c_i + tan * s_i) / (1 - ratio * c_i)
        at_inner, at_outer = (turns * self.speed for turns in brg.ring_speeds)
        orbit = (at_inner * outer + at_outer * inner) / (outer + inner)
        spin = (at_inner - at_outer) / ((outer + inner) * ratio)  # ω_R cosβ, against the orbit
        inertia = self._mass * brg.Dw**2 / 10
        return _Motion(orbit, self._mass * brg.Dpw / 2 * orbit**2, inertia * orbit * spin * tan)

    # ------------------------------------------------------------ balls in balance

    def _forces(self, b: Any, I: Any) -> tuple[Any, Any, Any]:
        """Force of the inner race on the ball (2, Z), couple on the ring (Z,), sum of forces on the ball."""
        n_o, n_i, Q_o, Q_i = self._contacts(b, I)
        motion = self._motion(n_o, n_i)
        T_i, T_o = (share * motion.gyroscopic / self.bearing.Dw for share in self._shares(Q_i))
        t_o, t_i = np.array([n_o[1], -n_o[0]]), np.array([n_i[1], -n_i[0]])
        inner = Q_i * n_i + T_i * t_i
        total = inner - Q_o * n_o - T_o * t_o
        total[1] = total[1] + motion.centrifugal
        # T_i acts fi·Dw from the groove centre, about which Q_i has no moment
        return inner, T_i * self.bearing.fi * self.bearing.Dw, total

    def _shares(self, Q_i: Any) -> tuple[Any, Any]:
        """λ_i, λ_o; an open inner contact carries no tangential force."""
        lam = 0.0 * Q_i.real if self.control == "outer" else np.where(Q_i.real > 0, 1.0, 0.0)
        return lam, 2.0 - lam

    def _start(self, I: Array) -> Array:
        """Ball on the line of the groove centres where it is squeezed, else thrown against the outer race."""
        rest_i, rest_o, kappa_i, kappa_o = self._races
        length = _length(I)
        squeeze = np.maximum(length - rest_i - rest_o, 0.0)
        part = 1 / (1 + (kappa_o / kappa_i) ** (2 / 3))  # δ_o of δ under one load
        return np.asarray(I / length * (rest_o + np.where(squeeze > 0, part * squeeze, self._throw)))

    def _settle(self, I: Array, push: Array) -> Array:
        """Ball centres (2, Z) under constant forces `push` (2, Z): Newton on a convex energy, damped."""
        rest_i, rest_o, kappa_i, kappa_o = self._races
        b = self._start(I)

        def energy(b: Array) -> Array:
            rise = _stored(kappa_o, _length(b) - rest_o) + _stored(kappa_i, _length(I - b) - rest_i)
            return np.asarray(rise - (push * b).sum(0))

        def unbalanced(b: Array) -> Array:
            n_o, n_i, Q_o, Q_i = self._contacts(b, I)
            return np.asarray(_length(Q_i * n_i - Q_o * n_o + push))

        n_o, n_i, Q_o, Q_i = self._contacts(b, I)
        for _ in range(_ITERATIONS):
            r = Q_i * n_i - Q_o * n_o + push
            size, load = _length(r), np.abs(push).sum(0) + Q_i + Q_o
            H = _hessian(n_o, Q_o, kappa_o, _length(b)) + _hessian(n_i, Q_i, kappa_i, _length(I - b))
            settled = size <= _BALANCED * load + _ROUNDING * rest_o * _norm(H)
            if settled.all():
                break
            stiff = _norm(H)
            damp = np.where(stiff > 0, 1e-13 * stiff, 1.0)
            step = np.linalg.solve(H + damp[:, None, None] * np.eye(2), r.T[:, :, None])[:, :, 0].T
            step *= np.minimum(1.0, 0.2 * rest_o / np.maximum(_length(step), 1e-300)) * ~settled
            before, part = energy(b), np.ones(b.shape[1])
            for _ in range(40):
                trial = _moved(b, part * step)
                # near the end the energy's round-off hides its fall, which the forces still show
                worse = (energy(trial) > before) & ~(unbalanced(trial) < size)
                if not worse.any():
                    break
                part = np.where(worse, part / 2, part)
            b = _moved(b, part * step)
            n_o, n_i, Q_o, Q_i = self._contacts(b, I)
        return b

    def _balance(self, I: Array) -> Array:
        """Ball centres (2, Z) from the outer groove centres at which all forces on each ball vanish."""
        push = np.zeros_like(I)
        push[1] = self._nominal_force
        b = self._settle(I, push)
        limit = 0.2 * self._races[1]
        # a trial that leaves the range of the kinematics is not finite, and is refused below
        with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
            _, _, r = self._forces(b, I)
            for _ in range(_ITERATIONS):
                _, _, Q_o, Q_i = self._contacts(b, I)
                J = self._jacobian(b, I, 0)[2]
                size = _length(r)
                allowed = _BALANCED * (Q_o + Q_i + self._nominal_force)
                allowed += _ROUNDING * self._races[1] * _norm(J)
                if (size <= allowed).all():
                    return b
                if not np.isfinite(J).all():
                    break
                step = -np.einsum("jab,bj->aj", np.linalg.pinv(J), r)
                step *= np.minimum(1.0, limit / np.maximum(_length(step), 1e-300))
                part = np.ones(b.shape[1])
                for _ in range(40):
                    trial = _moved(b, part * step)
                    _, _, r_new = self._forces(trial, I)
                    worse = ~(_length(r_new) <= np.maximum(size, allowed))
                    if not worse.any():
                        break
                    part = np.where(worse, part / 2, part)
                b, r = trial, r_new
        j = int(np.argmax(~(size <= allowed)))
        raise ArithmeticError(
            f"ball {j + 1} finds no balance at {self.speed:.6g} rad/s: {size[j]:.3g} N are left"
        )

    def _jacobian(self, b: Array, I: Array, of: int) -> tuple[Array, Array, Array]:
        """∂(inner force, couple, sum)/∂b (of = 0) or ∂I (of = 1): (Z, 2, 2), (Z, 2), (Z, 2, 2)."""
        inner, couple, total = [], [], []
        for k in (0, 1):
            turn = np.zeros((2, 1), complex)
            turn[k] = 1j * _STEP
            F, C, S = self._forces(b + turn, I + 0j) if of == 0 else self._forces(b + 0j, I + turn)
            inner.append(F.imag.T / _STEP)
            couple.append(C.imag / _STEP)
            total.append(S.imag.T / _STEP)
        return np.stack(inner, -1), np.stack(couple, -1), np.stack(total, -1)

    # ------------------------------------------------------------ the ring

    def _response(self, z: Array, angle: float) -> tuple[Array, Array]:
        """Force g (5,) on the raceway coefficients z (5,), and its tangent (5, 5), the balls in balance."""
        psi, I, rows = self._grooves(z, angle)
        b = self._balance(I)
        F, couple, _ = self._forces(b, I)
        # a couple C about the direction of travel is the axial force −C/R at the arm, of order 1 alone
        bend = np.array([0 * psi, 0 * psi, 0 * psi, np.cos(psi), np.sin(psi)]) / -self.bearing.arm
        g = np.einsum("akj,aj->k", rows, F) + bend @ couple
        F_b, C_b, S_b = self._jacobian(b, I, 0)
        F_I, C_I, S_I = self._jacobian(b, I, 1)
        follow = -np.linalg.pinv(S_b) @ S_I  # ∂b/∂I
        dF = F_I + F_b @ follow
        dC = C_I + np.einsum("ja,jab->jb", C_b, follow)
        K = np.einsum("akj,jab,blj->kl", rows, dF, rows) + np.einsum("kj,jb,blj->kl", bend, dC, rows)
        return g, K

    def _frozen(self, z: Array, angle: float) -> tuple[float, Array, Array, float]:
        """Energy, force, tangent, sum of loads under the nominal centrifugal force alone: convex."""
        rest_i, rest_o, kappa_i, kappa_o = self._races
        _, I, rows = self._grooves(z, angle)
        push = np.zeros_like(I)
        push[1] = self._nominal_force
        b = self._settle(I, push)
        n_o, n_i, Q_o, Q_i = self._contacts(b, I)
        l_o, l_i = _length(b), _length(I - b)
        H_o, H_i = _hessian(n_o, Q_o, kappa_o, l_o), _hessian(n_i, Q_i, kappa_i, l_i)
        stored = _stored(kappa_o, l_o - rest_o) + _stored(kappa_i, l_i - rest_i) - push[1] * (b[1] - rest_o)
        K = np.einsum("akj,jab,blj->kl", rows, H_i - H_i @ np.linalg.pinv(H_i + H_o) @ H_i, rows)
        return float(stored.sum()), np.einsum("akj,aj->k", rows, Q_i * n_i), K, float((Q_i + Q_o).sum())


def _series(kappa_i: float, kappa_o: float) -> float:
    return float((kappa_i ** (-2 / 3) + kappa_o ** (-2 / 3)) ** -1.5)


def _length(v: Any) -> Any:
    return np.sqrt(v[0] * v[0] + v[1] * v[1])


def _moved(b: Array, step: Array) -> Array:
    """Ball centres after a step, taken along the outer race and across it: a ball thrown there rolls on it.

    A straight step of the same size would leave an indentation of nanometres at once.
    """
    length = _length(b)
    n = b / length
    along = (step[0] * n[1] - step[1] * n[0]) / length
    reach = length + (step * n).sum(0)
    c, s = np.cos(along), np.sin(along)
    return np.asarray(reach * np.array([n[0] * c + n[1] * s, n[1] * c - n[0] * s]))


def _norm(matrices: Array) -> Array:
    return np.asarray(np.linalg.norm(matrices, axis=(1, 2)))


def _load(kappa: float, s: Any) -> Any:
    """κ s^{3/2}, nothing where the contact is open."""
    closed = s.real > 0
    return np.where(closed, kappa * np.where(closed, s, 1.0) ** 1.5, 0.0)


def _stored(kappa: float, s: Array) -> Array:
    return np.asarray(0.4 * kappa * np.maximum(s, 0.0) ** 2.5)


def _hessian(n: Array, Q: Array, kappa: float, length: Array) -> Array:
    """(Z, 2, 2) of (2/5)κ s^{5/2}: (dQ/ds) nnᵀ + (Q/l)(1 − nnᵀ)."""
    stiff = 1.5 * (kappa * kappa * Q) ** (1 / 3)
    outer = np.einsum("aj,bj->jab", n, n)
    return np.asarray((stiff - Q / length)[:, None, None] * outer + (Q / length)[:, None, None] * np.eye(2))
