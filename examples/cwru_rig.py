"""The rig of Case Western Reserve University as a model: a rotor, its spalled drive end 6205, the housing.

The spall is a hole made by a spark, 0.18 mm across, under contacts 0.6 to 0.9 mm long: the groove beside it
goes on carrying the ball, so that a ball neither drops as into a trench nor reaches the bottom (`hole`).
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

import bearingdyn as bd

RATE = 12_000.0  # Hz, of the records
G = 9.80665
SENSOR = "housing.top.y.acceleration"
INCH = 25.4e-3
SPALL = 0.007 * INCH  # m, across; 0.011 in deep, which no ball reaches
BELOW = -math.pi / 2  # rad, azimuth of the outer race's spall: at six o'clock, in the load zone


@dataclass(frozen=True)
class Rig:
    """The numbers of the model; the last five are fitted to the inner race's record."""

    weight: float = 50.0
    """N on the drive end: half of a 2 hp motor's rotor, and some of the coupling."""
    thrust: float = 50.0
    """N, of the fan end's spring washer; with the clearance it makes the angle that the lines show."""
    clearance: float = 7e-6
    """m, diametral: normal, less some interference; by the frequency of the inner race's line."""
    mode_mass: float = 600.0
    """kg: seen from the bearing. So heavy that the housing does not give way at its resonances, where 6 kg
    would as much as the contacts: of the modes only what the sensor feels counts."""
    frequency: tuple[float, ...] = (2617.8, 2891.4, 3315.3, 3601.0, 3759.5)
    """Hz, of the housing's modes."""
    damping: tuple[float, ...] = (0.0542, 0.0122, 0.0141, 0.0203, 0.0358)
    gain: tuple[float, ...] = (1.0520, -0.4859, 0.3173, -0.8448, 0.7831)
    """1/kg, acceleration at the sensor for a vertical force of one newton far above the mode."""
    axial: tuple[float, ...] = (1.5990, -0.6325, -0.3261, 0.4867, -0.0053)
    """1/kg, the same for an axial force."""
    noise: float = 0.032
    """g rms at the sensor, white."""


def hole(
    ball: bd.BallBearing, body: str, width: float, load: float, aside: float = 0.0
) -> tuple[float, float]:
    """Width and depth, m, of the pit that lets go of as much of a contact as a hole of that width.

    A strip of the hole's width takes f = F(x2) − F(x1), F(x) = (3x − x³)/4, of a Hertz contact's load, x over
    half the ellipse's length. What is left, (1 − f) of the stiffness, presses at the same approach δ as a
    whole contact at δ(1 − f)^(2/3). The contact meets the hole half its short axis before and after it.
    `aside`: of the hole's middle from the ellipse's, over half its length.
    """
    contact = ball.inner_contact if body == "inner" else ball.outer_contact
    a, b = contact.semi_axes(load)
    low, high = np.clip([aside - width / (2 * a), aside + width / (2 * a)], -1.0, 1.0)
    lost = (3 * (high - low) - (high**3 - low**3)) / 4
    return width + 2 * b, float(contact.approach(load) * (1 - (1 - lost) ** (2 / 3)))


def ball_bearing(
    rig: Rig, body: str | None, width: float, angle: float, scatter: float = 0.0, seed: int = 0
) -> bd.BallBearing:
    """The 6205, with a spall on a race (or none), its balls' diameters scattered by so much, m."""
    sizes = np.random.default_rng(seed).normal(0.0, scatter, 9) if scatter else ()
    sound = bd.catalogue.bearing("6205", clearance=rig.clearance, damping=100.0, oversize=tuple(sizes))
    if body is None:
        return sound
    # the load that the hole is under: of a ball where it stands, or on its way around with the inner ring
    state = bd.equilibrium(application(rig, sound)).bearings["drive"]
    around = 2 * math.pi * np.arange(9) / 9
    load = (
        float(np.interp(angle % (2 * math.pi), around, state.loads, period=2 * math.pi))
        if body == "outer"
        else float(state.loads.mean())
    )
    load = max(load, 0.1 * float(state.loads.mean()))  # a ball without load at rest is shaken on to it
    pit = bd.Pit(body, angle, *hole(sound, body, width, load))
    return bd.catalogue.bearing(
        "6205", clearance=rig.clearance, damping=100.0, oversize=tuple(sizes), defects=[pit]
    )


def housing(rig: Rig) -> bd.Superelement:
    """Modes in parallel, up and along: the bore moves by their sum, the sensor by their gains."""
    omega, m = 2 * math.pi * np.array(rig.frequency), rig.mode_mass
    k, n = m * omega**2, len(omega)
    held = {0: (2 * m, 2 * k[-1]), **dict.fromkeys((3, 4, 5), (0.01, 1e6))}  # what the sensor does not feel
    size = 6 + 2 * (n - 1)
    M, C, K, top = np.zeros((size, size)), np.zeros((size, size)), np.zeros((size, size)), np.zeros((3, size))
    for way, (at, gains) in enumerate(((1, rig.gain), (2, rig.axial))):
        T = np.zeros((n, size))  # modal coordinates from the bore's displacement that way, and modes 2 … n
        own = slice(6 + way * (n - 1), 6 + (way + 1) * (n - 1))
        T[0, at], T[0, own] = 1.0, -1.0
        T[1:, own] = np.eye(n - 1)
        for A, diagonal in ((M, np.full(n, m)), (C, 2 * np.array(rig.damping) * m * omega), (K, k)):
            A += T.T @ np.diag(diagonal) @ T
        top[1] += (np.array(gains) * m) @ T
    for at, (mass, stiff) in held.items():
        M[at, at], K[at, at], C[at, at] = mass, stiff, 0.05 * math.sqrt(mass * stiff)
    return bd.Superelement(
        M=M, C=C, G=np.zeros_like(M), K=K, interfaces={"bore": np.arange(6)}, outputs={"top": top}
    )


def felt_at(rig: Rig, frequency: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Acceleration at the sensor, g/N, for a vertical and an axial force of the bearing, by frequency, Hz."""
    found = np.zeros((2, *np.shape(frequency)), complex)
    for f0, z, y, a in zip(rig.frequency, rig.damping, rig.gain, rig.axial, strict=True):
        mode = -(frequency**2) / (f0**2 - frequency**2 + 2j * z * f0 * frequency) / G
        found[0] += y * mode
        found[1] += a * mode
    return found[0], found[1]


def application(rig: Rig, ball: bd.BallBearing) -> bd.Application:
    """Rotor, drive end bearing, housing."""
    app = bd.Application()
    app.add("rotor", bd.RigidBody(3.0, (5e-3, 5e-3, 3e-3), rotating=True))
    app.ground("rotor.centre", [0, 0, 0, 2e4, 2e4, 0], [0, 0, 20, 1, 1, 0])
    app.add("housing", housing(rig))
    app.bearing("drive", ball, inner="rotor.centre", outer="housing.bore")
    app.load("rotor.centre", (0, -rig.weight, rig.thrust, 0, 0, 0))
    return app


def steps_in_a_sample(ball: bd.BallBearing, rpm: float) -> int:
    """Twenty steps while a ball drops into the spall and out, as `CoarseStep` asks; at least ten (8.3 µs).

    A ball drops into a pit of limited depth within sqrt(Dw depth), or half the pit's width.
    """
    rolling = (1 - ball.cage_ratio) * rpm * math.pi / 30 * (ball.Dpw - ball.Dw) / 2  # m/s, on either race
    edge = min((min(p.width, 2 * math.sqrt(ball.Dw * p.depth)) for p in ball.defects), default=math.inf)
    return max(10, math.ceil(1.01 * 20 / RATE * rolling / edge))


def march(
    rig: Rig,
    ball: bd.BallBearing,
    rpm: float,
    seconds: float,
    channels: Sequence[str],
    more: int | None = None,
) -> tuple[np.ndarray, dict[str, float]]:
    """The channels, a column each, in SI units, and the bearing's lines, Hz; `more` steps to a sample."""
    more = steps_in_a_sample(ball, rpm) if more is None else more
    speed = rpm * math.pi / 30
    eq = bd.with_loaded_cages(bd.equilibrium(application(rig, ball)), speed)
    found = bd.transient(
        eq, speed=speed, dt=1 / RATE / more, steps=int(seconds * RATE) * more, settle=1500 * more,
        decimate=more, record=channels,
    )  # fmt: skip
    cage, shaft = eq.system.bearings[0].bearing.cage_ratio, rpm / 60
    lines = {"outer": 9 * cage * shaft, "inner": 9 * (1 - cage) * shaft, "shaft": shaft}
    return found.record.values, lines


def run(
    rig: Rig, ball: bd.BallBearing, rpm: float, seconds: float
) -> tuple[np.ndarray, np.ndarray, dict[str, float]]:
    """Acceleration at the sensor, g, no noise; the bearing's force y and z (n, 2), N; and its lines, Hz."""
    found, lines = march(rig, ball, rpm, seconds, [SENSOR, "drive.force.y", "drive.force.z"])
    return found[:, 0] / G, found[:, 1:], lines


def with_noise(rig: Rig, signal: np.ndarray, seed: int) -> np.ndarray:
    """The record as a sensor writes it."""
    return signal + np.random.default_rng(seed).normal(0.0, rig.noise, len(signal))
