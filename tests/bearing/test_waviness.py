"""Waviness and pits as a vibration sensor sees them: the lines of theory.md §2, in Hz and in orders."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np
import pytest
from scipy import signal

from bearingdyn.analysis import equilibrium, transient
from bearingdyn.application import Application
from bearingdyn.bearing import BallBearing
from bearingdyn.bearing.imperfections import Pit, Waviness
from bearingdyn.parts import RigidBody

# Dw/Dpw = 1/4 and cos α = 0.8: γ = 0.2, cage 0.4, spin (1 − γ²)·2 = 1.92 of the shaft's speed, so that every
# line is a whole multiple of 1/25 of it
Z, CAGE, SPIN = 8, 0.4, 1.92
SHAFT = 50.0  # Hz
TURNS = 25
BIN = SHAFT / TURNS
STEPS = 20_000  # per record
DT = TURNS / SHAFT / STEPS


def rotor(damping: float, load: Sequence[float], **flaws: Any) -> Application:
    """2 kg on one angular contact bearing, damped against the ground."""
    bearing = BallBearing(Z, 10e-3, 40e-3, 0.52, 0.53, contact_angle=math.acos(0.8), damping=20.0, **flaws)
    app = Application()
    app.add("rotor", RigidBody(2.0, (2e-3, 2e-3, 2e-3), rotating=True))
    # springs and dampers keep the tilts, which one bearing holds softly, from ringing long
    app.ground("rotor.centre", (0, 0, 0, 2e4, 2e4, 1e3), (damping,) * 3 + (1e-3 * damping,) * 3)
    app.bearing("b", bearing, inner="rotor.centre", outer="ground")
    app.load("rotor.centre", load)
    return app


def velocities(**flaws: Any) -> dict[str, np.ndarray]:
    """Spectra (m/s, zero-to-peak) of the shaft's translations in steady running, by bins of 2 Hz."""
    app = rotor(3e3, (0, 0, 1000.0, 0, 0, 0), **flaws)
    found = transient(
        equilibrium(app),
        speed=2 * np.pi * SHAFT,
        dt=DT,
        steps=STEPS,
        settle=STEPS // 2,  # 0.25 s at decay rates of 100/s and more
        record=[f"rotor.centre.{name}.velocity" for name in "xyz"],
    )
    spectra = 2 * np.abs(np.fft.rfft(found.record.values, axis=0)) / STEPS
    return dict(zip("xyz", spectra.T, strict=True))


def lines(spectrum: np.ndarray, floor: float) -> dict[int, float]:
    """Bins above a floor and their amplitudes."""
    return {int(k): float(spectrum[k]) for k in np.flatnonzero(spectrum > floor)}


def bins(*orders: float) -> set[int]:
    """Multiples of the shaft's speed as bins."""
    found = {abs(order) * TURNS for order in orders}
    assert all(abs(b - round(b)) < 1e-9 for b in found)
    return {round(b) for b in found}


NM = 1e-9
# wave: (body, n), and where theory.md §2 has its lines, in orders of the shaft's speed: axial, radial
INNER, OUTER = Z * (1 - CAGE), Z * CAGE
LINES = [
    ("inner", Z, [INNER], []),
    ("inner", 2 * Z, [2 * INNER], []),
    ("inner", Z + 1, [], [INNER + 1]),
    ("inner", Z - 1, [], [INNER - 1]),
    ("inner", 2 * Z + 1, [], [2 * INNER + 1]),
    ("inner", 2 * Z - 1, [], [2 * INNER - 1]),
    ("inner", 1, [], [1]),  # eccentric races are qZ + 1 with q = 0
    ("outer", Z, [OUTER], []),
    ("outer", 2 * Z, [2 * OUTER], []),
    ("outer", Z + 1, [], [OUTER]),
    ("outer", Z - 1, [], [OUTER]),
    ("outer", 2 * Z + 1, [], [2 * OUTER]),
    ("outer", 2 * Z - 1, [], [2 * OUTER]),
    ("ball", 2, [2 * SPIN], [2 * SPIN + CAGE, 2 * SPIN - CAGE]),
    ("ball", 4, [4 * SPIN], [4 * SPIN + CAGE, 4 * SPIN - CAGE]),
]


# a ball's wave has no direction
CASES = [
    (*case, way) for case in LINES for way in ("radial", "axial") if case[0] != "ball" or way == "radial"
]


@pytest.mark.parametrize(("body", "n", "axial", "radial", "direction"), CASES)
def test_a_wave_makes_its_lines_and_no_others(
    body: str, n: int, axial: list[float], radial: list[float], direction: str
) -> None:
    """Pure axial load: no varying compliance. 1 nm against indentations of 10 µm: products stay at −80 dB."""
    wave = Waviness(body, n, NM, 0.4, direction, ball=3 if body == "ball" else None)  # type: ignore[arg-type]
    found = velocities(waviness=[wave])
    largest = max(spectrum.max() for spectrum in found.values())
    floor = 1e-3 * largest  # −60 dB
    assert set(lines(found["z"], floor)) == bins(*axial)
    for name in "xy":
        assert set(lines(found[name], floor)) == bins(*radial)


@pytest.mark.parametrize(("body", "n"), [("inner", 3), ("inner", Z + 3), ("outer", 4), ("ball", 3)])
def test_other_orders_excite_nothing(body: str, n: int) -> None:
    wave = Waviness(body, n, NM, 0.4)  # type: ignore[arg-type]
    silent, loud = velocities(waviness=[wave]), velocities(waviness=[Waviness("inner", Z, NM, 0.4)])
    largest = max(spectrum.max() for spectrum in loud.values())
    for spectrum in silent.values():
        assert spectrum[1:].max() < 1e-3 * largest


def test_response_is_linear_in_small_waves() -> None:
    """Twice the amplitude, twice the lines; two waves add."""
    inner, outer = Waviness("inner", Z, NM, 0.4), Waviness("outer", 2 * Z + 1, NM, 1.4)
    twice = Waviness("inner", Z, 2 * NM, 0.4)
    one, other, double, both = (velocities(waviness=w) for w in ([inner], [outer], [twice], [inner, outer]))
    (axial,), (radial,) = bins(INNER), bins(2 * OUTER)
    # 1 nm of 10 µm: 1e-4
    assert double["z"][axial] == pytest.approx(2 * one["z"][axial], rel=1e-3)
    assert both["z"][axial] == pytest.approx(one["z"][axial], rel=1e-3)
    assert both["x"][radial] == pytest.approx(other["x"][radial], rel=1e-3)


def test_an_axial_wave_at_low_frequency_moves_the_shaft_by_its_amplitude() -> None:
    """Far below resonance balls stay pressed as they were: an axial wave of order Z carries the shaft along.

    z = −A cos(…) for the inner race, whose surface moves towards the balls; 240 Hz against 1 kHz.
    """
    amplitude = velocities(waviness=[Waviness("inner", Z, NM, 0.4, "axial")])["z"].max()
    # dynamic magnification 1/(1 − (ω/ω0)²) and damping, from the stiffness at the equilibrium
    static = equilibrium(rotor(3e3, (0, 0, 1000.0, 0, 0, 0)))
    k, c = static.bearings["b"].K[2, 2], 3e3 + static.bearings["b"].C[2, 2]
    omega = 2 * np.pi * INNER * SHAFT
    carried = abs((k + 1j * omega * static.bearings["b"].C[2, 2]) / (k - 2.0 * omega**2 + 1j * omega * c))
    # 1e-4 for products of waves and indentation, and Newmark's (ωΔt)²/12
    assert amplitude == pytest.approx(omega * NM * carried, rel=1e-3)


# ---------------------------------------------------------------- pits


def rung(speed: Any, steps: int, load: Sequence[float], pit: Pit) -> np.ndarray:
    """Radial acceleration (steps,) in y, m/s², after half a record of settling."""
    app = rotor(600.0, load, defects=[pit])
    found = transient(
        equilibrium(app),
        speed=speed,
        dt=DT,
        steps=steps,
        settle=STEPS // 2,
        record=["rotor.centre.y.acceleration"],
    )
    return np.asarray(found.record.values[:, 0])


def envelope(acceleration: np.ndarray) -> np.ndarray:
    """Of what rings above 1.5 kHz, mean removed: varying compliance lies far below."""
    high = signal.sosfiltfilt(signal.butter(4, 1500.0, "high", fs=1 / DT, output="sos"), acceleration)
    shape = np.abs(signal.hilbert(high))
    return np.asarray(shape - shape.mean())


RADIAL = (0.0, -600.0, 400.0, 0, 0, 0)
PITS = {"outer": Pit("outer", -np.pi / 2, 0.8e-3, 4e-6), "inner": Pit("inner", 0.3, 0.8e-3, 4e-6)}
"""of the outer race in the middle of its load zone"""
ORDERS = {"outer": OUTER, "inner": INNER}


@pytest.mark.parametrize("body", PITS)
def test_envelope_of_a_pit_peaks_at_the_ball_pass_frequency(body: str) -> None:
    """BPFO = Z·0.4·50 = 160 Hz; BPFI = 240 Hz with sidebands of the shaft, under a radial load; 2 Hz bins."""
    acceleration = rung(2 * np.pi * SHAFT, STEPS, RADIAL, PITS[body])
    spectrum = np.abs(np.fft.rfft(envelope(acceleration)))
    (expected,), shaft = bins(ORDERS[body]), TURNS
    near = slice(expected - 2 * shaft // 3, expected + 2 * shaft // 3)
    highest = near.start + int(np.argmax(spectrum[near]))
    if body == "outer":
        highest = 10 + int(np.argmax(spectrum[10 : round(1.5 * expected)]))
    assert abs(highest - expected) <= 1
    quiet = np.median(spectrum[10:400])
    assert spectrum[highest] > 20 * quiet
    sidebands = [spectrum[expected + k * shaft + d] for k in (-1, 1) for d in (-1, 0, 1)]
    lower, upper = max(sidebands[:3]), max(sidebands[3:])
    if body == "inner":  # the load zone modulates what turns with the shaft
        assert min(lower, upper) > 0.1 * spectrum[expected]
    else:
        assert max(lower, upper) < 0.01 * spectrum[expected]


@pytest.mark.parametrize("body", PITS)
def test_a_pit_keeps_its_order_in_a_run_up(body: str) -> None:
    """30 to 60 Hz in 1 s: resampled against the shaft's angle the envelope has its line at Z·0.4 or Z·0.6."""
    settle, end = STEPS // 2 * DT, 1.0
    low, high = 2 * np.pi * 30.0, 2 * np.pi * 60.0
    steps = round(end / DT)
    speed = ([settle, settle + end], [low, high])
    shape = envelope(rung(speed, steps, RADIAL, PITS[body]))
    t = DT * np.arange(1, steps + 1)
    angle = (low * t + (high - low) / (2 * end) * t**2) / (2 * np.pi)  # turns
    turns = 40  # of 45
    even = np.interp(angle[0] + np.arange(turns * 200) / 200, angle, shape)
    spectrum = np.abs(np.fft.rfft((even - even.mean()) * np.hanning(len(even))))
    order = np.arange(len(spectrum)) / turns
    near = (order > ORDERS[body] - 0.7) & (order < ORDERS[body] + 0.7)
    peak = order[near][np.argmax(spectrum[near])]
    assert abs(peak - ORDERS[body]) <= 1 / turns
    assert spectrum[near].max() > 10 * np.median(spectrum[order < 20])
    # in Hz it is smeared over an octave
    in_hertz = np.abs(np.fft.rfft((shape - shape.mean()) * np.hanning(len(shape))))
    assert spectrum[near].max() / len(even) > 3 * in_hertz[round(ORDERS[body] * 45 * end)] / len(shape)
