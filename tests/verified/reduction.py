"""Reduced parts against their own unreduced equations, over frequency and in time."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import scipy.sparse

from bearingdyn.cms import Dynamics, FullModel, march
from bearingdyn.material import Maxwell
from bearingdyn.parts import Housing, damping_sample
from verified.row import Row

RUBBER = Maxwell(1e6, [2e6, 3e6, 10e6], [1e-2, 1e-3, 1e-4], K=2e9, density=1200.0)
SOURCE = "sparse solves of the unreduced equations"
REASON = "the accuracy demanded of a reduction up to 5 kHz"


def _receptance(model: FullModel, frequency: float, loaded: int) -> float:
    """|motion/force| at the first interface's coordinate `loaded`, the second one held (or the reverse)."""
    nothing = scipy.sparse.csr_matrix((1, model.n))
    transfer = Dynamics(model, nothing).solve(2.0 * math.pi * frequency)[0]
    free = np.arange(6) + 6 * (loaded // 6)
    return float(np.abs(transfer.receptance(free)[loaded % 6, loaded % 6]))


def reduction() -> list[Row]:
    """Receptances of the layered sample and a housing, and the peak of the sample's motion under a pulse."""
    sample = replace(damping_sample(RUBBER, refinement=0.5), inertia=1)
    housing = Housing(0.16, 0.20, 0.03, 0.078, bore_height=0.12, f_max=15e3, element_size=0.03)
    found = []
    for name, full, element, loaded, places in (
        ("sample", sample.full_model(), sample.superelement(), 7, (100.0, 1e3, 3e3, 5e3)),
        ("housing", housing.body.full_model(), housing.superelement(), 1, (500.0, 2e3, 4e3)),
    ):
        small = FullModel.of(element)
        for f in places:
            case = f"{name}, {element.n} of {full.n} coordinates, radial receptance at {f:g} Hz, m/N"
            expected, computed = (_receptance(m, f, loaded) for m in (full, small))
            found.append(Row(case, SOURCE, expected, computed, 0.01, REASON))
    dt, steps = 4e-6, 400
    t = dt * np.arange(steps + 1)
    load = np.zeros((steps + 1, 6))
    load[:, 1] = np.where(t < 5e-4, 100.0 * np.sin(math.pi * t / 5e-4) ** 2, 0.0)
    peak = [
        float(np.abs(march(m, {"outer": load}, dt, fixed=["inner"]).motion["outer"][:, 1]).max())
        for m in (sample.full_model(), sample.superelement())
    ]
    case = "sample, largest radial motion under a pulse of 0.5 ms, m"
    found.append(Row(case, SOURCE, *peak, 0.01, REASON))
    return found
