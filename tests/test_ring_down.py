"""Damped modes against what they say of the march and of the frequency-dependent eigenproblem."""

from __future__ import annotations

import sys
from functools import cache
from pathlib import Path

import numpy as np
import pytest

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "examples"))

import motor as example

from bearingdyn.analysis import Equilibrium, equilibrium, modes, transient
from rotors import motor, motor_rubber
from test_modes import dynamic_stiffness


@cache
def built(design: int) -> Equilibrium:
    return equilibrium(example.motor(example.designs(motor_rubber())[design]))


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


def test_poles_of_a_ring_down_are_the_damped_modes():
    found, state = ring_down_of_a_layered_rotor()
    expected = modes(state, damped=True)
    vertical = [np.abs(state.system.row("shaft.end.y") @ s) for s in expected["shape"].values]
    value, f = expected.eigenvalue.values, expected.frequency.values
    # those that the strike moves: the vertical plane's, slower than its spectrum reaches
    chosen = value[(np.array(vertical) > 1e-5) & (f < 3000.0)]
    assert chosen.size >= 6
    errors = np.array([np.abs(found - v).min() / abs(v) for v in chosen])
    print(
        "\n".join(
            f"{abs(v) / 2 / np.pi:8.1f} Hz  off by {100 * e:.4f} %"
            for v, e in zip(chosen, errors, strict=True)
        )
    )
    # the project's bound; the scheme shifts frequencies by (ωΔt)²/12, below 2e-4 at 3 kHz
    assert errors.max() < 5e-3
    damping = np.array([-(p := found[np.abs(found - v).argmin()]).real / abs(p) for v in chosen])
    np.testing.assert_allclose(damping, -chosen.real / np.abs(chosen), rtol=0.02)


@pytest.mark.parametrize("design", [0, 2])
@pytest.mark.parametrize("speed", [0.0, example.SPEED])
def test_damped_modes_of_the_motor_solve_the_frequency_dependent_eigenproblem(design, speed):
    """λ²M + λ(C + ΩG) + K + ΩN + 2 G(λ) H, G(λ) continued to complex λ, for every mode below 60 kHz."""
    state = built(design)
    system = state.linearised()
    found = modes(state, speed=speed, damped=True)
    below = found.frequency.values < 6e4
    assert np.count_nonzero(below) > 50
    worst = 0.0
    for value, shape in zip(found.eigenvalue.values[below], found["shape"].values[below], strict=True):
        terms = dynamic_stiffness(system, value, speed)
        size = sum(np.abs(term @ shape).max() for term in terms)
        worst = max(worst, float(np.abs(sum(terms) @ shape).max() / size))
    print(f"largest residual {worst:.1e}")
    # the project's bound, against the same terms without their cancellation
    assert worst < 1e-8
