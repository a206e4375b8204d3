"""Damped modes with lubricated contacts, stiff and damped as they are at the frequency of each mode."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import scipy

from bearingdyn.system import System
from bearingdyn.types import Array, Complex

_BAND = 1.1  # modes within this ratio of frequencies are found together
_CLOSE = 1e-10  # change of an eigenvalue, relative, at which the search ends
_STEPS = 30

Eigen = Callable[[System], tuple[Complex, Complex]]
Balls = Callable[[Array], tuple[Complex, Array] | None]


def film_modes(
    system: System, speed: float, balls: Balls, values: Complex, eigen: Eigen
) -> tuple[Complex, Complex]:
    """Modes on films: λ (m,), shapes (n, m) of λ²M + λ(C + ΩG) + K + ΩN + layers(λ) + B'Z(|Im λ|)B.

    Band by band of frequencies the films are springs and dashpots as they are in its middle, and `eigen`
    finds all modes; each is then followed to the Z of its own frequency. Z is of motions that go on: at λ
    it is Re Z + λ Im Z/ω, good to the first order in the damping ratio.

    Parameters
    ----------
    system
        With its bearings linearised, all but what the films add by frequency.
    values
        Eigenvalues (m,) of that system, by increasing size: as many are found.
    balls
        What is added at omega (f,): stiffness (f, b) and its v (b, n).

    Raises
    ------
    ArithmeticError
        Where a mode is not found.
    """
    found = np.zeros(values.size, dtype=np.complex128)
    shapes = np.zeros((system.n, values.size), dtype=np.complex128)
    first = 0
    while first < values.size:
        last = first + int(np.searchsorted(np.abs(values[first:]), _BAND * np.abs(values[first]), "right"))
        near = values[first:last]
        middle = float(np.sqrt(np.abs(near[0]) * np.abs(near[-1])))
        near_values, near_shapes = eigen(_held(system, balls, middle))
        # the films change little: each mode is the one whose eigenvalue is nearest, and nobody's else
        distance = np.abs(near[:, None] - near_values[None, :])
        _, chosen = scipy.optimize.linear_sum_assignment(distance)
        for k, i in enumerate(chosen, start=first):
            found[k], shapes[:, k] = _followed(system, speed, balls, near_values[i], near_shapes[:, i])
        first = last
    return found, shapes


def _held(system: System, balls: Balls, omega: float) -> System:
    """The system with its films as springs and dashpots, as they are at omega, rad/s."""
    Z = _added(balls, omega)
    return replace(system, K=system.K + Z.real, C=system.C + Z.imag / omega)


def _added(balls: Balls, omega: float) -> Complex:
    found = balls(np.array([omega]))
    if found is None:
        return np.zeros((), dtype=np.complex128)
    k, v = found
    return np.asarray((v.T * k[0]) @ v)


def _followed(
    system: System, speed: float, balls: Balls, value: complex, shape: Complex
) -> tuple[complex, Complex]:
    """The eigenvalue at which the films are those of its own frequency, by Newton's method on (λ, shape)."""
    still = system.stiffness() + speed * system.N
    rates = system.viscous() + speed * system.G
    x = shape / np.linalg.norm(shape)
    held = x.conj()
    for _ in range(_STEPS):
        omega = abs(value.imag)
        Z = _added(balls, omega)
        T = value**2 * system.M + value * (rates + Z.imag / omega) + still + Z.real
        slope = 2 * value * system.M + rates + Z.imag / omega
        for layer in system.layers:
            G, tau = np.asarray(layer.material.G), np.asarray(layer.material.tau)
            inert = 1 + value * tau
            H = 2 * (layer.L @ layer.L.T)
            T = T + (G * value * tau / inert).sum() * H
            slope = slope + (G * tau / inert**2).sum() * H
        try:
            y = np.linalg.solve(T, slope @ x)
        except np.linalg.LinAlgError:  # met to the last bit, as a motion that nothing couples can be
            return value, np.asarray(x)
        share = complex(held @ y)
        step = complex(held @ x) / share
        value, x = value - step, y / np.linalg.norm(y)
        if abs(step) < _CLOSE * abs(value):
            return value, np.asarray(x)
        held = x.conj()
    raise ArithmeticError(
        f"the mode near {abs(value) / 2 / np.pi:.6g} Hz was not found with the films of its own frequency; "
        f'contacts="viscous" gives it with those of low frequency'
    )
