"""Machines in other programs: a housing on the same mesh (benchmarks/peers_fem.py), a rotor in ROSS."""

from __future__ import annotations

import dataclasses

import numpy as np
import scipy.linalg

import bearingdyn as bd
from bearingdyn.fem import assemble_solid, block_with_bore, lowest_modes
from bearingdyn.parts import Disc, Housing, Section
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


# rad/s, by thrust on each bearing: ROSS 2.3.0 of 16 ShaftElements of 25 mm, a DiskElement at n=6 and two
# BearingElements of `bd.ross_table`, bisected to where the forward frequency is the speed
ROSS = {300.0: 763.6061, 1500.0: 765.3981}


def rotor_for_ross(thrust: float) -> tuple[bd.Equilibrium, dict[str, float]]:
    """A shaft Ø25 × 400 mm with a disc of 5 kg at 150 mm in two 6205, and their stiffness as ROSS takes it.

    Its BearingElement holds no tilt: nor do these bearings, whose arm is .25 mm.
    """
    ball = bd.catalogue.bearing("6205")
    ball = dataclasses.replace(ball, overrides=ball.overrides._replace(arm=2.5e-4))
    table = bd.ross_table(bd.stiffness_table(ball, [[0, 0, thrust, 0, 0, 0]]))
    app = bd.Application()
    shaft = bd.Shaft(
        [Section(0.4, 0.025)], {"left": 0.0, "right": 0.4}, discs=[Disc(0.15, 5.0, 0.012, 0.022)],
        f_max=5000.0, element_length=0.025,
    )  # fmt: skip
    app.add("shaft", shaft)
    for end in ("left", "right"):
        app.bearing(end, ball, inner=f"shaft.{end}", outer="ground", fits=False)
    app.ground("shaft.left", [0, 0, 0, 0, 0, 1.0])
    app.load("shaft.left", (0, 0, 2 * thrust, 0, 0, 0))
    return bd.equilibrium(app), {name: v[0] for name, v in table.items() if name != "frequency"}


def forward_critical(eq: bd.Equilibrium) -> float:
    """Speed, rad/s, that is the frequency of its lowest forward mode, by a secant."""
    speeds = np.array([755.0, 775.0])
    found = bd.campbell(eq, speeds, count=8, damped=False)
    k = next(k for k in range(8) if found.whirl.values[0, k] > 0.9)
    gap = 2 * np.pi * found.frequency.values[:, k] - speeds
    return float(speeds[0] + gap[0] / (gap[0] - gap[1]) * (speeds[1] - speeds[0]))


def ross() -> list[Row]:
    """The rotor's critical speed with the exported table in ROSS, and with the balls here."""
    return [
        Row(
            f"rotor in two 6205 under {thrust:g} N: forward critical speed (rad/s)",
            "ROSS 2.3.0 with the table of bd.ross_table",
            want,
            forward_critical(rotor_for_ross(thrust)[0]),
            1e-3,
            "asked for; a secant of 20 rad/s, and reduction to 5 kHz here",
        )
        for thrust, want in ROSS.items()
    ]
