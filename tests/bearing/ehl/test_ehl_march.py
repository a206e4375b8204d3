"""The contact in time, against its linearisation and against Newton's law."""

from __future__ import annotations

import math

import numpy as np
import pytest
import scipy

from bearingdyn.bearing import ehl


@pytest.fixture(scope="module")
def contact() -> ehl.Steady:
    return ehl.steady(100, 10, grid=33)


def _answer(contact: ehl.Steady, Omega: float, n: int) -> complex:
    """F̂/δ̂ over Hertz of the second of two periods of n steps."""
    motion = ehl.march(
        contact,
        dt=2 * math.pi / Omega / n,
        steps=2 * n,
        approach=lambda T: 1e-4 * math.sin(Omega * T),
    )
    phase = np.exp(-1j * Omega * motion.T[-n:])
    # sums of a whole period: its mean and its start fall out
    return complex(phase @ motion.force[-n:] / (phase @ motion.approach[-n:])) / 1.5


@pytest.mark.parametrize("Omega", [0.5, pytest.param(2.0, marks=pytest.mark.slow)])
def test_a_small_harmonic_approach_is_answered_as_the_linearisation_says(
    contact: ehl.Steady, Omega: float
) -> None:
    linear = complex(contact.stiffness(Omega))
    # 0.5 % was asked at 80 steps a period; at Ω = 2 the damping is a hundredth of the stiffness
    answer = _answer(contact, Omega, 80)
    assert abs(answer - linear) < 5e-3 * abs(linear)
    if Omega < 1:
        assert answer.imag == pytest.approx(linear.imag, rel=5e-3)


def test_the_march_is_of_second_order(contact: ehl.Steady) -> None:
    linear = complex(contact.stiffness(1.0))
    errors = [abs(_answer(contact, 1.0, n) - linear) for n in (20, 40)]
    assert 1.7 < math.log2(errors[0] / errors[1]) < 2.3


@pytest.mark.slow
@pytest.mark.parametrize("Omega", [0.3, 1.0, 2.0])
def test_a_free_ball_rings_down_as_the_pole_of_the_linearisation(contact: ehl.Steady, Omega: float) -> None:
    mass = 1 / Omega**2

    def excess(x: complex) -> complex:
        return complex(contact.stiffness(x)) - mass * x * x

    pole = scipy.optimize.newton(excess, Omega * (1 + 0.01j), tol=1e-9)
    # the first swings still carry the film that was there before: it is gone after 2 a/um
    waited = 1 + math.ceil(2 * Omega / math.pi)
    steps = 80 * (waited + 2) + 20
    motion = ehl.march(contact, dt=2 * math.pi / Omega / 80, steps=steps, mass=mass, velocity=1e-4 * Omega)
    y = motion.approach - motion.approach[0]
    peaks = [k for k in range(1, len(y) - 1) if y[k - 1] < y[k] >= y[k + 1]]
    a, b = peaks[waited : waited + 2]
    # 2 % was asked
    assert np.log(_peak(y, a) / _peak(y, b)) == pytest.approx(2 * math.pi * pole.imag / pole.real, rel=0.02)


def _peak(y: np.ndarray, k: int) -> float:
    bend = y[k - 1] - 2 * y[k] + y[k + 1]
    return float(y[k] - (y[k + 1] - y[k - 1]) ** 2 / (8 * bend))


def test_a_ball_pulled_off_flies_by_newtons_law_and_lands() -> None:
    contact, mass = ehl.steady(100, 10, grid=25), 0.5

    def load(T: float) -> float:
        return 1 - 1.6 * math.exp(-(((T - 3) / 1.2) ** 2))

    motion = ehl.march(contact, dt=0.1, steps=140, mass=mass, load=load)
    assert motion.force.min() < 1e-4  # lost, but for the wedge of the wide gap
    assert motion.approach.min() < -1
    assert motion.force[-60:].max() > 2  # landed
    assert (motion.force >= 0).all()
    assert motion.Hmin.min() > 0
    # momentum, 1.5 mass Δv = ∫(load − force) dT; the sum errs by some 1 % of the impulse of the landing
    push = np.array([load(T) for T in motion.T]) - motion.force
    impulse = np.r_[0.0, np.cumsum((push[1:] + push[:-1]) / 2 * 0.1)]
    assert np.abs(1.5 * mass * motion.velocity - impulse).max() < 0.02 * np.abs(impulse).max()
    # in flight, ahead of the landing, the sum is exact to its order
    flight = (motion.T > 5) & (motion.T < 6.5)
    assert np.abs((1.5 * mass * motion.velocity - impulse)[flight]).max() < 5e-3 * np.abs(impulse).max()


def test_nothing_moves_without_a_push(contact: ehl.Steady) -> None:
    still = ehl.march(contact, dt=0.1, steps=5, mass=1.0)
    assert np.abs(still.force - 1).max() < 1e-9
    assert np.ptp(still.approach) < 1e-9


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"dt": 0.0, "steps": 1, "mass": 1.0}, "dt is 0.0"),
        ({"dt": 0.1, "steps": 0, "mass": 1.0}, "steps is 0"),
        ({"dt": 0.1, "steps": 1}, "approach, mass is "),
        ({"dt": 0.1, "steps": 1, "mass": -1.0}, "mass is -1"),
        ({"dt": 0.1, "steps": 1, "approach": lambda T: 1.0}, r"approach\(0\) is 1.0"),
        ({"dt": 0.1, "steps": 1, "mass": 1.0, "load": lambda T: math.nan}, r"load\(0\) is nan"),
    ],
)
def test_bad_input_is_named(contact: ehl.Steady, options: dict, message: str) -> None:
    with pytest.raises(ValueError, match=message):
        ehl.march(contact, **options)
