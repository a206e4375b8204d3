"""Marches that several tests ask: under many sines at once, and ringing down."""

from __future__ import annotations

from functools import cache

import motor as example
import numpy as np

import bearingdyn as bd
from bearingdyn import core
from bearingdyn.analysis import Equilibrium, equilibrium, transient
from rotors import LIKE_MEASURED, motor

BASE = 20.0  # Hz: the sines are whole multiples, so that all of them repeat after 1/BASE
OUTPUTS = [*example.OUTPUTS, "right_housing.top.y", "left_ring.centre.y"]


@cache
def built(design: int) -> bd.Application:
    return example.motor(example.designs(LIKE_MEASURED)[design])


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
    loads = list(app.plan.loads)
    app.load("shaft.middle", (0, amplitude, 0, 0, 0, 0), time=t, value=np.resize(wave, t.size))
    try:
        state = bd.equilibrium(app)
    finally:
        app.plan.loads[:] = loads
    run = bd.transient(
        state.linearised() if linear else state,
        speed=0.0,
        dt=dt,
        steps=per,
        settle=settle,
        record=[*OUTPUTS, "left.loaded", "right.loaded"] if not linear else OUTPUTS,
        scheme=core.Scheme(tolerance=1e-13),
    )
    record = run["record"].values
    if not linear:
        # every ball stays in contact, or the two domains would tell two stories
        assert (record[:, len(OUTPUTS) :] == 7).all()
    spectrum = np.fft.fft(np.roll(record[:, : len(OUTPUTS)], 1, axis=0), axis=0)[harmonics] * 2 / per
    return spectrum / (amplitude * np.exp(1j * phase))[:, None], state.linearised()


def poles(record: np.ndarray, dt: float, order: int) -> np.ndarray:
    """Poles (order,), rad/s, of a sum of decaying exponentials sampled at dt, record (samples, channels).

    Matrix pencil of a block Hankel matrix (Hua & Sarkar, IEEE Trans. ASSP 38 (1990) 814-824).
    """
    scaled = record / np.abs(record).max(axis=0)
    rows = len(scaled) // 2
    hankel = np.hstack([scaled[i : i + len(scaled) - rows] for i in range(rows)])
    right = np.linalg.svd(hankel, full_matrices=False)[2][:order]
    shift = scaled.shape[1]
    z = np.linalg.eigvals(np.linalg.lstsq(right[:, :-shift].T, right[:, shift:].T, rcond=None)[0])
    return np.log(z.astype(complex)) / dt


def ring_down_of_a_layered_rotor() -> tuple[np.ndarray, Equilibrium]:
    """Poles of the nonlinear march, layers by their history, balls in contact, struck by 0.1 N."""
    dt, keep, strike = 2e-6, 20, 2e-4
    app = motor()
    app.load("shaft.end", (0, 0.1, 0, 0, 0, 0), time=[0.0, strike / 2, strike], value=[0.0, 1.0, 0.0])
    state = equilibrium(app)
    channels = [
        "shaft.end.y",
        "shaft.right.y",
        "shaft.left.θx",
        "ring.centre.y",
        "block.centre.y",
        "cap.centre.y",
    ]
    settle = round(strike / dt)
    run = transient(state, speed=0.0, dt=dt, steps=keep * 1000, settle=settle, decimate=keep, record=channels)
    rest = np.array([state.system.row(c) @ state.x for c in channels])
    return poles(run.record.values - rest, keep * dt, order=30), state
