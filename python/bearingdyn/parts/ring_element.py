"""The superelement of a flexible ring: its body's, upon supports, with the orders beyond that are folded."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import scipy

from bearingdyn.cms import Superelement, Viscoelastic
from bearingdyn.parts.ring_compliance import RingCompliance
from bearingdyn.parts.ring_support import RingBed, RingPoints, held_by
from bearingdyn.types import Array

STIFF = 100e3  # Hz, the least natural frequency of what follows at once


def upon_supports(
    element: Superelement,
    supports: Sequence[RingBed | RingPoints],
    radius: float,
    width: float,
    side: str = "outside",
    seat: str = "outer",
) -> Superelement:
    """Ring element upon supports: free, between those of one side and their rigid interface."""
    outside = element.raceways[side]
    K, C = held_by(supports, outside.rows, outside.series, radius, width)
    wide = wider(element, 6, "raceway")
    return replace(
        wide,
        K=wide.K + K,
        C=wide.C + C,
        interfaces={**wide.interfaces, seat: np.arange(element.n, element.n + 6)},
    )


def with_folded(
    element: Superelement,
    compliance: RingCompliance,
    folded: Sequence[tuple[int, int, float]],
    normal: Array,
    f_max: float,
    damping: float,
) -> Superelement:
    """Ring element with folded orders: what those beyond do at the balls, and the raceway's compliance.

    Parameters
    ----------
    folded
        (order, sine, compliance), m/N, of each such coordinate.
    normal
        (2,) line of contact in (r, z).
    f_max
        Hz; the coordinates follow at once up to there.
    damping
        Their ratio ζ.
    """
    rate = 2 * math.pi * max(STIFF, 10.0 * f_max)
    own = np.arange(element.n, element.n + len(folded))
    wide = wider(element, len(folded), *element.raceways)
    M, C, K = wide.M.copy(), wide.C.copy(), wide.K.copy()
    M[own, own], C[own, own], K[own, own] = 1.0, 2.0 * damping * rate, rate**2
    raceway = wide.raceways["raceway"]
    rows = raceway.rows.copy()
    for k, (p, sine, c) in zip(own, folded, strict=True):
        for axial, share in enumerate(normal):
            rows[raceway.series.index(axial, p, sine), k] = share * rate * math.sqrt(c)
    carries = replace(raceway, rows=rows, give=compliance.give, Z=compliance.Z)
    return replace(wide, M=M, C=C, K=K, raceways={**wide.raceways, "raceway": carries})


def gyroscopic(element: Superelement, seat: str, back: str, polar_inertia: float) -> Array:
    """Ring element's gyroscopic matrix (n, n): a rigid body with the tilts of its seat, or of `back`.

    `back` is the raceway that tells them where nothing seats the ring.
    """
    if seat in element.interfaces:
        x, y = np.eye(element.n)[element.interfaces[seat][3:5]]
    else:
        raceway = element.raceways[back]
        x, y = (np.linalg.pinv(raceway.series.rigid(raceway.arm)) @ raceway.rows)[3:5]
    return np.asarray(element.G + polar_inertia * (np.outer(x, y) - np.outer(y, x)))


def wider(element: Superelement, count: int, *raceways: str) -> Superelement:
    """Ring element wider by `count` coordinates, without mass and force, for named raceways."""
    none = np.zeros((count, count))

    def grown(A: Array) -> Array:
        return np.asarray(scipy.linalg.block_diag(A, none))

    def padded(rows: Array) -> Array:
        return np.hstack([rows, np.zeros((len(rows), count))])

    def material(v: Viscoelastic) -> Viscoelastic:
        strain = v.concentration
        more = None if strain is None else np.concatenate([strain, np.ones(count)])
        return replace(v, H=grown(v.H), concentration=more)

    return replace(
        element,
        M=grown(element.M),
        C=grown(element.C),
        G=grown(element.G),
        K=grown(element.K),
        N=None if element.N is None else grown(element.N),
        outputs={name: padded(r) for name, r in element.outputs.items()},
        viscoelastic=tuple(map(material, element.viscoelastic)),
        raceways={
            name: replace(element.raceways[name], rows=padded(element.raceways[name].rows))
            for name in raceways
        },
    )
