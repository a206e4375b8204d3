"""The demo's housing in another finite element program, on the same mesh (benchmarks/peers_fem.py)."""

from __future__ import annotations

import dataclasses

import numpy as np
import scipy.linalg

from bearingdyn.fem import assemble_solid, block_with_bore, lowest_modes
from bearingdyn.parts import Housing
from verified.row import Row

CALCULIX = "CalculiX 2.20, C3D20, same nodes"

# Hz, as CalculiX prints them: the base held, and the bore free, or rigid by *RIGID BODY
BORE_FREE = (636.5743, 1483.877, 2120.298, 3321.114, 4917.080, 5400.971, 5681.737, 7661.630)
BORE_RIGID = (717.9510, 2193.728, 2789.028, 4955.736, 7260.811, 7812.545, 8005.965, 9463.244)


def calculix() -> list[Row]:
    """The pedestal of examples/motor.py in some 300 bricks: the full model, and its superelement."""
    volume = (0.16 * 0.20 - np.pi / 4 * 0.078**2) * 0.030
    part = Housing(0.16, 0.20, 0.030, 0.078, 0.12, f_max=40e3, element_size=(volume / 300) ** (1 / 3))
    assert part.element_size is not None
    solid = assemble_solid(block_with_bore(0.16, 0.20, 0.030, 0.078, 0.12, part.element_size))
    free = np.flatnonzero(np.repeat(solid.points[:, 1] > -0.12 + 1e-9, 3))
    K = solid.stiffness(part.material)[free][:, free]
    M = part.material.density * solid.mass[free][:, free]
    full = lowest_modes(K, M, n_modes=8)[0]
    rows = [
        Row(f"housing, bore free, mode {i} (Hz)", CALCULIX, want, got, 1e-6, "the seven digits printed")
        for i, (want, got) in enumerate(zip(BORE_FREE, full, strict=True), 1)
    ]
    for f_max in (40e3, 20e3):
        s = dataclasses.replace(part, f_max=f_max).superelement()
        loose = np.setdiff1d(np.arange(s.n), s.interfaces["feet"])
        inside = np.ix_(loose, loose)
        reduced = np.sqrt(scipy.linalg.eigh(s.K[inside], s.M[inside], eigvals_only=True)) / (2 * np.pi)
        rows += [
            Row(
                f"housing reduced to {f_max / 1e3:g} kHz, bore rigid, mode {i} (Hz)",
                CALCULIX,
                want,
                got,
                5e-3,
                "asked for to 0.5 %; modes up to a quarter of where the reduction ends",
            )
            for i, (want, got) in enumerate(zip(BORE_RIGID, reduced, strict=False), 1)
            if want < 0.25 * f_max
        ]
    return rows
