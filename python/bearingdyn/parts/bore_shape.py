"""The bore of a housing that is not round, and what it makes of the race of the ring pressed into it."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import ArrayLike

from bearingdyn.checks import instance, items, nonnegative, number, real, require, whole
from bearingdyn.plausible_ranges import plausible
from bearingdyn.types import Array


@dataclass(frozen=True)
class BoreShape:
    """How a bore departs from the circle, by waves around it, and how tightly a ring sits in it.

    Parameters
    ----------
    waves
        order n ≥ 2 -> (a, b), m: the radius of the bore is larger by a cos nψ + b sin nψ, ψ from x towards y.
        An ovalised bore has order 2, a foot or a stud each Z places the order Z.
    interference
        Of the ring in the round bore, m on the radius.

    Raises
    ------
    ValueError
        For an order below 2, which is a fit or a place, not a shape, or numbers that are not finite.
    """

    waves: Mapping[int, tuple[float, float]] = field(default_factory=dict)
    interference: float = 0.0

    def __post_init__(self) -> None:
        remedy = "orders of a bore's shape are whole numbers from 2: 0 is the fit, 1 where the bore is"
        instance("waves", self.waves, Mapping, "it must be {order: (cosine, sine) in m}")
        for n, pair in self.waves.items():
            whole("waves", n, 2, remedy=remedy)
            values = items(f"waves[{n}]", pair, "it must be (cosine, sine) in m")
            require(len(values) == 2, f"waves[{n}]", pair, "it must be (cosine, sine) in m")
            for value in values:
                number(f"waves[{n}]", value, "it must be (cosine, sine) in m")
                plausible("bore wave", f"waves[{n}]", value)
        nonnegative("interference", self.interference, "it must be a length in m on the radius, zero or more")
        plausible("interference", "interference", self.interference)

    @classmethod
    def from_points(cls, points: ArrayLike, highest: int = 8, interference: float = 0.0) -> BoreShape:
        """The shape of a measured or computed bore, from points of its surface.

        Parameters
        ----------
        points
            (k, 2) x and y, m, as deformed: of a solid's mesh, the nodes of the bore plus their displacement.
        highest
            Order up to which waves are fitted.
        interference
            m on the radius.

        Returns
        -------
        BoreShape
            About the centre of the points' best circle, by least squares.

        Raises
        ------
        ValueError
            For fewer points than there are waves, or gaps between them in which waves would hide.
        """
        whole("highest", highest, 2)
        at = real(points)
        good = at.ndim == 2 and at.shape[1] == 2 and bool(np.isfinite(at).all())
        require(good, "points", points, "it must hold x and y, m, of points of the bore, (k, 2)")
        if not len(at) >= 2 * highest + 1:
            raise ValueError(
                f"points holds {len(at)} points; waves to order {highest} need {2 * highest + 1}: give more, "
                f"or a lower highest"
            )
        centre = at.mean(axis=0)
        psi = np.arctan2(*(at - centre).T[::-1])
        around = np.sort(psi)
        gap = float(np.diff(np.append(around, around[0] + 2 * math.pi)).max())
        if not gap < math.pi / highest:
            raise ValueError(
                f"points leave {math.degrees(gap):.3g} degrees of the bore open; waves to order {highest} "
                f"need less than {180 / highest:.3g}: give points there, or a lower highest"
            )
        orders = np.arange(1, highest + 1)
        for _ in range(3):  # the centre moves by what is left of order 1
            r, psi = np.hypot(*(at - centre).T), np.arctan2(*(at - centre).T[::-1])
            waves = np.outer(psi, orders)
            found = np.linalg.lstsq(
                np.hstack([np.ones((len(r), 1)), np.cos(waves), np.sin(waves)]), r, rcond=None
            )[0]
            centre = centre + [found[1], found[1 + highest]]
        return cls(
            {int(n): (float(found[n]), float(found[highest + n])) for n in orders[1:]},
            interference=interference,
        )

    def parted(self, compliance: Mapping[int, float]) -> tuple[float, float]:
        """Interference, m on the radius, at which a ring just follows the bore all round, and the azimuth.

        Parameters
        ----------
        compliance
            order -> m/N, 0 among them, radial, of the ring's outside, of unit loads on its coefficients.

        Returns
        -------
        tuple of float
            m and rad.
        """
        psi = np.linspace(0.0, 2.0 * math.pi, 48 * max([2, *self.waves]) + 1)
        pull: Array = np.zeros_like(psi)
        for n, (a, b) in self.waves.items():
            # a load f on the coefficient of cos nψ is f cos nψ/π per rad, of order 0 f/2π
            pull += (a * np.cos(n * psi) + b * np.sin(n * psi)) / (compliance[n] * math.pi)
        worst = int(np.argmax(pull))
        return float(pull[worst]) * 2.0 * math.pi * compliance[0], float(psi[worst])
