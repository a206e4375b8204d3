"""Bearings beyond one row at rest: balls with inertia, pairs, fits."""

from __future__ import annotations

import math

import numpy as np
from scipy.optimize import brentq

from bearingdyn.bearing import BallBearing, Mounting, Pair, Running, Seat
from verified.closed_forms import axial, closed_forms, jones
from verified.row import MM, RPM, Row


def jones_harris() -> list[Row]:
    """A 218-class angular contact bearing at 10 000 rpm under three axial loads."""
    brg = BallBearing(16, 22.225 * MM, 125.26 * MM, 0.5232, 0.5232, contact_angle=math.radians(40))
    running, found = Running(brg, 10_000 * RPM), []
    source = (
        "Jones' equations in Harris' unknowns, solved apart by a root finder (tests/verified/closed_forms.py)"
    )
    for load in (8e3, 17.8e3, 44.5e3):
        balls = running.balls(running.displacement((0, 0, load, 0, 0, 0)))
        a_i, a_o, Q_i, Q_o = jones(brg, 10_000 * RPM, load)
        for name, want, got in (
            ("inner contact angle (°)", math.degrees(a_i), math.degrees(balls.alpha_i[0])),
            ("outer contact angle (°)", math.degrees(a_o), math.degrees(balls.alpha_o[0])),
            ("inner ball load (N)", Q_i, balls.Q_i[0]),
            ("outer ball load (N)", Q_o, balls.Q_o[0]),
        ):
            case = f"218, 10 000 rpm, {load / 1e3:g} kN: {name}"
            found.append(Row(case, source, want, float(got), 1e-8, "two solutions of one set of equations"))
    return found


def pairs() -> list[Row]:
    """Two rows back to back and face to face, preloaded by 200 N."""
    alpha, width, force = math.radians(25), 15e-3, 200.0
    row = BallBearing(13, 7.938 * MM, 38.5 * MM, 0.52, 0.53, contact_angle=alpha)
    s = float(brentq(lambda s: axial(row, s) - force, 0, 1e-4, xtol=1e-18))
    one, half = closed_forms(row, s), width / 2
    reason = "distances of mm leave ten digits of indentations of µm"
    source = "closed form of two rows, reference page §2"
    found = []
    for name, sense in (("DB", 1), ("DF", -1)):
        pair = Pair(row, name, width, preload_force=force)  # type: ignore[arg-type]
        K = pair.stiffness(np.zeros(6))
        z = float(brentq(lambda z: axial(row, s + z) - axial(row, s - z) - 500.0, 0, 1e-4, xtol=1e-18))
        for case, want, got in (
            ("approach of each row under 200 N (µm)", s * 1e6, pair.approach * 1e6),
            ("axial stiffness, 2 × single (N/m)", 2 * one["zz"], K[2, 2]),
            ("radial stiffness, 2 × single (N/m)", 2 * one["xx"], K[0, 0]),
            (
                "moment stiffness (N m)",
                2 * (one["tt"] + half**2 * one["xx"] + sense * width * abs(one["xt"])),
                K[4, 4],
            ),
            (
                "displacement under 500 N axial (µm)",
                z * 1e6,
                pair.displacement((0, 0, 500.0, 0, 0, 0))[2] * 1e6,
            ),
        ):
            found.append(Row(f"{name}: {case}", source, want, float(got), 1e-9, reason))
    return found


def fits() -> list[Row]:
    """What press fits of one steel take from a 6205-like bearing."""
    brg = BallBearing(9, 7.94 * MM, 39.04 * MM, 0.52, 0.53, clearance=20e-6)
    d, D = 25 * MM, 52 * MM
    race_i, race_o = 31.1 * MM, 46.98 * MM
    source = "T. A. Harris, Rolling Bearing Analysis, one material: I·d/d_race and I·D_race/D"
    shaft, housing = Mounting(d, D, shaft=Seat(12e-6)), Mounting(d, D, housing=Seat(9e-6))
    return [
        Row(case, source, want * 1e6, -mounting.clearance_change(brg) * 1e6, 1e-12, "closed form")
        for case, want, mounting in (
            ("clearance lost to 12 µm on a solid shaft (µm)", 12e-6 * d / race_i, shaft),
            ("clearance lost to 9 µm in a very thick housing (µm)", 9e-6 * race_o / D, housing),
        )
    ]
