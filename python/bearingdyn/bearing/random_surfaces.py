"""Surfaces drawn at random but repeatably: waves of a race or a ball, and diameters of balls."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Literal

import numpy as np

from bearingdyn.bearing.imperfections import BODIES, Body, Waviness
from bearingdyn.checks import nonnegative, number, require, whole
from bearingdyn.plausible_ranges import plausible


@dataclass(frozen=True)
class WavinessSpectrum:
    """Random waves of a race or a ball by their amplitudes over the order n, amplitude (order/n)^exponent.

    Parameters
    ----------
    amplitude
        At the reference order, m.
    exponent
        Rate at which waves shrink with their order; 1 to 2 is reported for measured races (unverified).
    order
        Reference order, ≥ 1.
    scatter
        "none": each wave has the amplitude of the law; "rayleigh": it is Rayleigh-distributed with the law as
        its root mean square, as that of a Gaussian surface is.

    Raises
    ------
    ValueError
        Naming the field, its value and what would be right.
    """

    amplitude: float
    exponent: float = 1.0
    order: int = 1
    scatter: Literal["none", "rayleigh"] = "none"

    def __post_init__(self) -> None:
        remedy = "it must be zero or positive, and finite, in m"
        plausible("waviness", "spectrum.amplitude", nonnegative("spectrum.amplitude", self.amplitude, remedy))
        number("spectrum.exponent", self.exponent)
        whole = isinstance(self.order, int) and self.order >= 1
        require(whole, "spectrum.order", self.order, "it must be a whole number of waves, one or more")
        known = self.scatter in ("none", "rayleigh")
        require(known, "spectrum.scatter", self.scatter, 'it must be "none" or "rayleigh"')

    def at(self, order: int) -> float:
        """Amplitude by the law, m."""
        return float(self.amplitude * (self.order / order) ** self.exponent)

    def draw(
        self,
        body: Body,
        orders: Iterable[int],
        seed: int,
        *,
        direction: Literal["radial", "axial"] = "radial",
        Z: int | None = None,
    ) -> tuple[Waviness, ...]:
        """Waves of the given orders with even phases; the same seed gives the same surface.

        The wave of an order does not depend on which other orders are drawn.

        Parameters
        ----------
        body
            "inner", "outer" or "ball".
        orders
            Whole numbers ≥ 1.
        seed
            ≥ 0. Different surfaces need different seeds.
        direction
            Of a race's waves.
        Z
            Number of balls, for body "ball": each ball gets a surface of its own.

        Raises
        ------
        ValueError
            Naming the field, its value and what would be right.
        """
        require(body in BODIES, "body", body, f"it must be one of {BODIES}")
        require(isinstance(seed, int) and seed >= 0, "seed", seed, "it must be a whole number, zero or more")
        on_ball = body == "ball"
        given = Z is not None and Z >= 1
        require(given == on_ball, "Z", Z, "give the number of balls with body 'ball', and only then")
        waves = []
        for order in orders:
            whole = isinstance(order, int) and order >= 1
            require(whole, "orders", order, "it must be whole numbers of waves, one or more")
            for ball in range(1, (Z or 1) + 1):
                random = np.random.default_rng([seed, order, ball])
                phase = float(random.uniform(0, 2 * math.pi))
                # Rayleigh of unit root mean square
                size = math.sqrt(random.standard_exponential()) if self.scatter == "rayleigh" else 1.0
                which = ball if on_ball else None
                waves.append(Waviness(body, order, self.at(order) * size, phase, direction, which))
        return tuple(waves)


def diameter_scatter(Z: int, deviation: float, seed: int) -> tuple[float, ...]:
    """Random deviations of Z ball diameters, m, normal, of a standard deviation: `oversize` of BallBearing.

    Parameters
    ----------
    Z
        Number of balls.
    deviation
        Standard deviation of a diameter, m.
    seed
        Whole number ≥ 0; the same seed gives the same balls.

    Raises
    ------
    ValueError
        For a Z or seed that is not a whole number, or a negative deviation.
    """
    Z = whole("Z", Z, 1, 10**6, "it must be a whole number of balls")
    require(isinstance(seed, int) and seed >= 0, "seed", seed, "it must be a whole number, zero or more")
    sigma = nonnegative("deviation", deviation, "it must be zero or positive, and finite, in m")
    plausible("oversize", "deviation", sigma)
    return tuple(float(x) for x in sigma * np.random.default_rng(seed).standard_normal(Z))
