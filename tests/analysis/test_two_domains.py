"""Time and frequency domain tell one story: one march under forty sines against the harmonic response."""

from __future__ import annotations

import motor as example
import numpy as np
import pytest

import bearingdyn as bd
from marches import BASE, OUTPUTS, lines, marched
from twins.linear_twin import discrete_response


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
