"""Time and frequency domain tell one story: one march under forty sines against the harmonic response."""

from __future__ import annotations

import sys
from functools import cache
from pathlib import Path

import numpy as np
import pytest

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "examples"))

import motor as example

import bearingdyn as bd
from bearingdyn import core
from rotors import motor_rubber
from test_motor import discrete_response

BASE = 20.0  # Hz: the sines are whole multiples, so that all of them repeat after 1/BASE
OUTPUTS = [*example.OUTPUTS, "right_housing.top.y", "left_ring.centre.y"]


@cache
def built(design: int) -> bd.Application:
    return example.motor(example.designs(motor_rubber())[design])


def lines(count: int) -> np.ndarray:
    """Multiples (count,) of BASE from 20 to 5000 Hz, spread on a logarithmic scale."""
    highest, guess = round(5000.0 / BASE), count
    while len(found := np.unique(np.round(np.geomspace(1, highest, guess)).astype(int))) < count:
        guess += 1
    return np.append(found[: count - 1], highest)


def marched(
    dt: float, harmonics: np.ndarray, amplitude: float, *, linear: bool
) -> tuple[np.ndarray, bd.system.System]:
    """Response (f, o) per N to sines of one amplitude, N, all in one march; and the linearised system."""
    per = round(1 / (BASE * dt))
    phase = np.pi * np.arange(len(harmonics)) ** 2 / len(harmonics)  # Schroeder: a flat crest
    n = np.arange(per)
    wave = np.cos(2 * np.pi * np.outer(harmonics, n) / per + phase[:, None]).sum(axis=0)

    plain = bd.equilibrium(built(2))
    slowest = -bd.modes(plain, damped=True)["eigenvalue"].values.real.max()
    settle = int(np.ceil(np.log(1e11) / slowest / dt / per)) * per  # what is left: 1e-11
    app = built(2)
    t = dt * np.arange(settle + per + 1)
    loads = list(app.loads)
    app.load("shaft.middle", (0, amplitude, 0, 0, 0, 0), time=t, value=np.resize(wave, t.size))
    try:
        state = bd.equilibrium(app)
    finally:
        app.loads[:] = loads
    run = bd.transient(
        state.linearised() if linear else state,
        speed=0.0,
        dt=dt,
        steps=per,
        settle=settle,
        record=[*OUTPUTS, "left.loaded", "right.loaded"] if not linear else OUTPUTS,
        scheme=core.Scheme(dt, tolerance=1e-13),
    )
    record = run["record"].values
    if not linear:
        # every ball stays in contact, or the two domains would tell two stories
        assert (record[:, len(OUTPUTS) :] == 7).all()
    spectrum = np.fft.fft(np.roll(record[:, : len(OUTPUTS)], 1, axis=0), axis=0)[harmonics] * 2 / per
    return spectrum / (amplitude * np.exp(1j * phase))[:, None], state.linearised()


def norm_of(error: np.ndarray, wanted: np.ndarray) -> float:
    return float(np.linalg.norm(error) / np.linalg.norm(wanted))


@pytest.mark.parametrize(("dt", "count"), [(5e-6, 12), (1e-6, 40)])
def test_one_march_under_many_sines_is_the_harmonic_response(dt, count):
    """The nonlinear march: layers by their history, balls by Newton, all in contact, 1 mN a sine."""
    harmonics = lines(count)
    found, system = marched(dt, harmonics, 1e-3, linear=False)
    wanted = bd.frequency_response(system, BASE * harmonics, [example.INPUT], OUTPUTS)["response"].values[
        :, :, 0
    ]
    whole = norm_of(found - wanted, wanted)
    each = [norm_of(a, b) for a, b in zip(found - wanted, wanted, strict=True)]
    print(f"dt {dt:g} s: {100 * whole:.4f} % of all, at worst {100 * max(each):.3f} % at one frequency")
    # the project's bound; Newmark moves a resonance by (ωΔt)²/12: 2e-3 at 5 kHz and 5 µs, 8e-5 at 1 µs
    assert whole < 0.01
    if dt <= 1e-6:
        assert max(each) < 0.01


@pytest.mark.parametrize(("dt", "count"), [(5e-6, 12), (2.5e-6, 40)])
def test_one_march_under_many_sines_is_the_schemes_own_transfer_function(dt, count):
    """Bearings linearised, nothing but the scheme between: Newmark and branches in z = e^{iωΔt}."""
    harmonics = lines(count)
    found, system = marched(dt, harmonics, 1.0, linear=True)
    per = 1 / (BASE * dt)
    force = system.row(example.INPUT)
    wanted = np.array(
        [[discrete_response(system, system.row(o), force, dt, per / k) for o in OUTPUTS] for k in harmonics]
    )
    error = norm_of(found - wanted, wanted)
    print(f"dt {dt:g} s: {error:.1e}")
    assert error < 1e-8
