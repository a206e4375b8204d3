"""One row of the verification, and how rows share their source and tolerance."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Iterable
from decimal import Decimal

import numpy as np
from numpy.typing import NDArray

from bearingdyn.material import Elastic

MM = 1e-3
RPM = math.pi / 30
INDEPENDENT = "computed independently for this project"


@dataclasses.dataclass(frozen=True)
class Row:
    """One comparison; `tolerance` is relative, and `reason` says why it is what it is."""

    case: str
    source: str
    expected: float
    computed: float
    tolerance: float
    reason: str

    @property
    def error(self) -> float:
        """Relative error."""
        return abs(self.computed - self.expected) / abs(self.expected)

    @property
    def holds(self) -> bool:
        """Whether the error is within the tolerance (NaN is not)."""
        return self.error <= self.tolerance


def rows(
    section: str, tolerance: float, reason: str, source: str, cases: Iterable[tuple[str, float, float]]
) -> list[Row]:
    """Rows that share their source and tolerance, from (case, expected, computed)."""
    where = f"{source}, reference page {section}"
    return [Row(name, where, float(want), float(got), tolerance, reason) for name, want, got in cases]


def to_the_digit(section: str, source: str, cases: Iterable[tuple[str, str, float]]) -> list[Row]:
    """Rows held to half of the last digit of the expected value as it is written."""
    found = []
    for name, written, got in cases:
        half = 0.5 * 10.0 ** int(Decimal(written).as_tuple().exponent)
        # a value that ends in 5 may have been rounded either way
        tolerance = 1.01 * half / abs(float(written))
        found += rows(
            section, tolerance, "half of the last digit given", source, [(name, float(written), got)]
        )
    return found


def steel(E: float) -> Elastic:
    return Elastic(E, 0.3, 7850.0)


def unit_rubber(nu: float) -> Elastic:
    """G = 1 MPa: bodies in mm then have the stiffnesses of tables for G = 1, by `as_printed`."""
    return Elastic(2e6 * (1 + nu), nu, 1200.0)


def as_printed(K: NDArray[np.complex128]) -> NDArray[np.float64]:
    """Stiffness (6 i, 6 i) of bodies in mm with G = 1 MPa, as for G = 1 and the bare lengths."""
    s = np.tile([10**-1.5] * 3 + [10**1.5] * 3, len(K) // 6)
    return np.asarray(K.real * np.outer(s, s))
