"""Damped modes against what they say of the march and of the frequency-dependent eigenproblem."""

from __future__ import annotations

from functools import cache

import motor as example
import numpy as np
import pytest

from bearingdyn.analysis import Equilibrium, equilibrium, modes
from marches import ring_down_of_a_layered_rotor
from rotors import LIKE_MEASURED
from twins.linear_twin import dynamic_stiffness


@cache
def built(design: int) -> Equilibrium:
    return equilibrium(example.motor(example.designs(LIKE_MEASURED)[design]))


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
