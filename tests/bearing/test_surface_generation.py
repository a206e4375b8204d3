"""Surfaces by a seeded law, scatter of balls, spalls and dents; and that they reach the contacts."""

from __future__ import annotations

import dataclasses
import math

import numpy as np
import pytest

from bearingdyn.bearing import BallBearing, WavinessSpectrum, dent, diameter_scatter, spall

BRG = BallBearing(9, 7.94e-3, 39.04e-3, 0.52, 0.53, clearance=0.0, film=2e-6)


def test_amplitudes_follow_the_law():
    waves = WavinessSpectrum(1e-6, exponent=1.5, order=2).draw("inner", range(2, 50), seed=1)
    orders = np.array([w.order for w in waves])
    np.testing.assert_allclose([w.amplitude for w in waves], 1e-6 * (2 / orders) ** 1.5, rtol=1e-13)


def test_seed_makes_the_surface_and_orders_do_not_disturb_each_other():
    law = WavinessSpectrum(1e-6, scatter="rayleigh")
    first = law.draw("outer", range(2, 30), seed=7)
    assert law.draw("outer", range(2, 30), seed=7) == first
    assert law.draw("outer", [12], seed=7) == (first[10],)
    assert law.draw("outer", range(2, 30), seed=8) != first


def test_phases_are_even_and_rayleigh_has_the_law_as_its_rms():
    law = WavinessSpectrum(1e-6, exponent=0.0, scatter="rayleigh")
    waves = law.draw("inner", range(1, 4001), seed=3)
    # of n = 4000: mean resultant and relative error of the mean square are both near 1/√n = 1.6 %; 4 times
    assert abs(np.exp([1j * w.phase for w in waves]).mean()) < 0.064
    assert np.mean([w.amplitude**2 for w in waves]) == pytest.approx(1e-12, rel=0.064)


def test_each_ball_has_a_surface_of_its_own():
    waves = WavinessSpectrum(1e-7).draw("ball", [2, 4], seed=5, Z=9)
    assert len(waves) == 18
    assert len({w.phase for w in waves}) == 18
    assert {w.ball for w in waves} == set(range(1, 10))


def test_race_waves_reach_the_contacts():
    # a centred ring with a film: ball j carries κ(film + Σ A_n cos(nψ_j + phase))^{3/2}, as with the cage at
    # angle 0 the inner race has not turned
    waves = WavinessSpectrum(0.1e-6).draw("inner", range(2, 12), seed=2)
    loads = dataclasses.replace(BRG, waviness=waves).ball_loads(np.zeros(6))
    psi = 2 * math.pi * np.arange(9) / 9
    rise = sum(w.amplitude * np.cos(w.order * psi + w.phase) for w in waves)
    # a wave of the inner race towards +r presses the ball by its height in a radial contact
    np.testing.assert_allclose(loads, BRG.kappa * (2e-6 + rise) ** 1.5, rtol=1e-9)


def test_diameters_scatter_normally_and_press_the_balls():
    sizes = diameter_scatter(2000, 0.1e-6, seed=4)
    # standard error of σ is σ/√2n = 1.6 %, of the mean σ/√n = 2.2 % of σ; 4 of each
    assert np.std(sizes) == pytest.approx(0.1e-6, rel=0.064)
    assert abs(np.mean(sizes)) < 0.09e-6 * 0.1
    few = diameter_scatter(9, 0.1e-6, seed=4)
    loads = dataclasses.replace(BRG, oversize=few).ball_loads(np.zeros(6))
    # a ball larger by d is pressed by d between both races
    np.testing.assert_allclose(loads, BRG.kappa * (2e-6 + np.array(few)) ** 1.5, rtol=1e-9)


def test_dent_is_the_cap_of_the_particle():
    pit = dent("inner", 0.3, width=60e-6, particle=100e-6)
    # 30-40-50: the cap of a sphere of radius 50 µm over a radius of 30 µm is 10 µm high
    assert pit.depth == pytest.approx(10e-6, rel=1e-12)
    assert (pit.width, pit.body, pit.angle) == (60e-6, "inner", 0.3)


def test_a_ball_in_a_long_spall_drops_to_its_bottom():
    # 2√(Dw h) = 0.252 mm at 2 µm depth: ball 1 stands on the middle of a longer and of a shorter one
    for length, drop in ((0.5e-3, 1e-6), (50e-6, 7.94e-3 / 2 - math.sqrt((7.94e-3 / 2) ** 2 - (25e-6) ** 2))):
        pit = spall("outer", 0.0, length, 1e-6)
        loads = dataclasses.replace(BRG, defects=(pit,)).ball_loads(np.zeros(6))
        # the drop of theory.md §2; differences of radii of mm leave 1e-18 m
        assert loads[0] == pytest.approx(BRG.kappa * (2e-6 - drop) ** 1.5, rel=1e-9)
        np.testing.assert_allclose(loads[1:], BRG.kappa * 2e-6**1.5, rtol=1e-9)


@pytest.mark.parametrize(
    ("make", "field"),
    [
        (lambda: WavinessSpectrum(-1e-6), "spectrum.amplitude"),
        (lambda: WavinessSpectrum(1e-6, math.nan), "spectrum.exponent"),
        (lambda: WavinessSpectrum(1e-6, order=0), "spectrum.order"),
        (lambda: WavinessSpectrum(1e-6, scatter="white"), "spectrum.scatter"),
        (lambda: WavinessSpectrum(1e-6).draw("cage", [2], 1), "body"),
        (lambda: WavinessSpectrum(1e-6).draw("inner", [0], 1), "orders"),
        (lambda: WavinessSpectrum(1e-6).draw("inner", [2], -1), "seed"),
        (lambda: WavinessSpectrum(1e-6).draw("ball", [2], 1), "Z"),
        (lambda: WavinessSpectrum(1e-6).draw("inner", [2], 1, Z=9), "Z"),
        (lambda: diameter_scatter(9, -1e-7, 1), "deviation"),
        (lambda: dent("inner", 0.0, 60e-6, 50e-6), "width"),
        (lambda: spall("inner", 0.0, 0.0, 1e-6), "defects.width"),
    ],
)
def test_bad_input_is_named(make, field):
    with pytest.raises(ValueError, match=f"^{field} is "):
        make()
