"""Factors of a harmonic's stiffness with some coordinates held: of a narrow section, by a band.

Numbered across a strip, its matrix has a band as narrow as the strip, and LAPACK factorises it in a third of
the time SuperLU takes. Numbering and places depend on the mesh's topology alone, which designs of different
dimensions share.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import scipy

from bearingdyn.fem.factors import Factor, factorise
from bearingdyn.fem.revolution_harmonics import Harmonic
from bearingdyn.types import Array, Index

WIDEST = 320  # subdiagonals: from here on SuperLU is as quick
KEPT = 8  # sets of coordinates at once, of some 2 MB each; a body asks for one
SMALL = 20_000  # coordinates: larger ones are not kept, for memory


@dataclass(frozen=True, eq=False)
class _Band:
    """The band of a topology: order (n,), width, and place of each datum that is used."""

    order: Index
    width: int
    data: Index
    place: Index


class Banded:
    """Factors of a real positive definite matrix by its band; ``.solve(b)`` for b (n,) or (n, m).

    Raises
    ------
    numpy.linalg.LinAlgError
        For a matrix that is not positive definite.
    """

    def __init__(self, data: Array, band: _Band) -> None:
        n, height = band.order.size, band.width + 1
        ab = np.zeros(n * height)
        ab[band.place] = data[band.data]
        self._order = band.order
        self._factors, info = scipy.linalg.lapack.dpbtrf(
            ab.reshape((height, n), order="F"), lower=1, overwrite_ab=1
        )
        if info:
            raise np.linalg.LinAlgError(f"pivot {info} of the band is not positive")

    def solve(self, b: Any) -> Any:
        """A⁻¹ b."""
        x = np.empty_like(b)
        if b.size:
            columns = b[self._order].reshape(len(b), -1)
            x[self._order] = scipy.linalg.lapack.dpbtrs(self._factors, columns, lower=1)[0].reshape(b.shape)
        return x


def held_factors(h: Harmonic, K: Any, inner: Index) -> Factor:
    """Factors of a harmonic's stiffness, of the coordinates that are not held.

    Parameters
    ----------
    h
        The harmonic.
    K
        (n, n) with its pattern; symmetric positive definite, or complex symmetric.
    inner
        Rising numbers of the coordinates that remain.

    Returns
    -------
    Factor
        Its ``.solve(b)`` takes b (inner, m).
    """
    if K.dtype == np.float64 and 0 < inner.size < SMALL:
        band = _known_band(h, inner)
        if band.width <= WIDEST:
            try:
                return Banded(K.data, band)
            except np.linalg.LinAlgError:
                pass  # SuperLU asks for no sign
    return factorise(K[inner][:, inner])


def _known_band(h: Harmonic, inner: Index) -> _Band:
    """The band of a topology, found once and kept with its pattern."""
    known, key = h.pattern.held, np.ascontiguousarray(inner).tobytes()
    band: _Band | None = known.get(key)
    if band is None:
        band = _band(h, inner)
        while len(known) >= KEPT:
            known.pop(next(iter(known)), None)
        known[key] = band
    return band


def _band(h: Harmonic, inner: Index) -> _Band:
    number = h.matrix(np.arange(h.pattern.indices.size, dtype=np.float64))[inner][:, inner].tocoo()
    c = len(h.components)
    node, component = inner // c, inner % c
    r, z = (np.round(x[node] / h.mesh.size, 9) for x in (h.mesh.r, h.mesh.z))
    found = []
    for across, lengthwise in ((r, z), (z, r)):
        order = np.lexsort((component, across, lengthwise))
        rank = np.empty(order.size, dtype=np.intp)
        rank[order] = np.arange(order.size)
        row, column = rank[number.row], rank[number.col]
        low = row >= column
        below = row[low] - column[low]
        width = int(below.max(initial=0))
        place = column[low] * (width + 1) + below
        found.append(_Band(order, width, number.data[low].astype(np.intp), place))
    return min(found, key=lambda band: band.width)
