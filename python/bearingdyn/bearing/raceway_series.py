"""The Fourier series, in the azimuth, of the displacement of a race's groove centre: which terms it has."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from bearingdyn.checks import whole
from bearingdyn.types import Array


@dataclass(frozen=True)
class RacewaySeries:
    """The Fourier coefficients by which a raceway moves (its groove centre), radial ones first.

    Each term is (axial, order, sine): coefficient k multiplies cos or sin (sine 0 or 1) of order·ψ in the
    radial (axial 0) or axial (1) displacement of the groove centre, m.

    Raises
    ------
    ValueError
        For a term named twice, an order below 0, a sine of order 0, or axial before radial.
    """

    terms: tuple[tuple[int, int, int], ...]

    def __post_init__(self) -> None:
        terms = tuple((int(a), int(n), int(s)) for a, n, s in self.terms)
        object.__setattr__(self, "terms", terms)
        if len(set(terms)) != len(terms) or not terms:
            raise ValueError(f"terms is {terms}; it must name at least one coefficient, and each once")
        for axial, order, sine in terms:
            if axial not in (0, 1) or sine not in (0, 1) or order < 0 or (order == 0 and sine):
                raise ValueError(
                    f"terms has {(axial, order, sine)}; each must be (0 or 1, order >= 0, 0 or 1)"
                )
        if any(a[0] > b[0] for a, b in pairwise(terms)):
            raise ValueError(f"terms is {terms}; it must list all radial coefficients before the axial ones")

    @classmethod
    def up_to(cls, order: int) -> RacewaySeries:
        """All coefficients of the orders 0 to `order`, 2(2·order + 1) of them."""
        highest = whole("order", order, 0)
        one = [(n, sine) for n in range(highest + 1) for sine in ((0, 1) if n else (0,))]
        return cls(tuple((axial, n, sine) for axial in (0, 1) for n, sine in one))

    def __len__(self) -> int:
        return len(self.terms)

    def index(self, axial: int, order: int, sine: int) -> int:
        """Place of a term.

        Raises
        ------
        ValueError
            When it is not there.
        """
        return self.terms.index((axial, order, sine))

    @property
    def columns(self) -> tuple[NDArray[np.intc], NDArray[np.intc], NDArray[np.intc]]:
        """The terms' axial, order and sine, (n,) each, as the contact kernel takes them."""
        axial, order, sine = np.array(self.terms, dtype=np.intc).T.copy()
        return axial, order, sine

    def rigid(self, arm: float) -> Array:
        """(n, 6) matrix from a rigid ring's motion (x, y, z, θx, θy, θz), tilts at `arm` in m, to the terms.

        Terms that a rigid ring does not have are zero.
        """
        B = np.zeros((len(self), 6))
        for term, column, value in (
            ((0, 1, 0), 0, 1.0),
            ((0, 1, 1), 1, 1.0),
            ((1, 0, 0), 2, 1.0),
            ((1, 1, 0), 4, -arm),
            ((1, 1, 1), 3, arm),
        ):
            if term in self.terms:
                B[self.terms.index(term), column] = value
        return B


RIGID = RacewaySeries(((0, 1, 0), (0, 1, 1), (1, 0, 0), (1, 1, 0), (1, 1, 1)))
"""The five coefficients of a rigid ring."""

NET = ((0, 1, 0), (0, 1, 1), (1, 0, 0))
"""Terms on which the force of the balls is their resultant along x, y and z."""
