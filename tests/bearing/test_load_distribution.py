"""Load distribution, contact angles, pressures, and the stiffness averaged over a ball's passage."""

from __future__ import annotations

import dataclasses
import math
import warnings

import numpy as np
import pytest
from scipy.optimize import brentq

from bearingdyn.bearing import (
    BallBearing,
    BearingWarning,
    Running,
    load_distribution,
    passage,
    without_spin,
)
from bearingdyn.bearing.catalogue import bearing
from bearingdyn.material import Elastic

METAL = Elastic(207e9, 0.3, 7850.0)
SIX_202 = BallBearing(8, 5.953e-3, 25e-3, 0.52, 0.53, clearance=10e-6, material=METAL, ball_material=METAL)
B218 = BallBearing(16, 22.225e-3, 125.26e-3, 0.5232, 0.5232, contact_angle=math.radians(40))


def load(**components: float) -> np.ndarray:
    return np.array([components.get(name, 0.0) for name in ("Fx", "Fy", "Fz", "Mx", "My", "Mz")])


def test_6202_under_axial_preload():
    d = load_distribution(SIX_202, SIX_202.displacement(load(Fz=180.0)))
    # theory.md §3.5, printed digits
    np.testing.assert_allclose(np.degrees(d.angle_inner), 14.8804, atol=5e-5)
    np.testing.assert_allclose(d.load_outer, 87.6163, rtol=6e-7)
    assert d.loaded == 8


def test_loads_and_angles_give_back_the_load():
    brg, f = bearing("6306", clearance=15e-6), load(Fx=3e3, Fy=-1e3, Fz=2e3)
    d = load_distribution(brg, brg.displacement(f, 0.3), 0.3)
    carried = [
        (d.load_inner * np.cos(d.angle_inner) * np.cos(d.azimuth)).sum(),
        (d.load_inner * np.cos(d.angle_inner) * np.sin(d.azimuth)).sum(),
        (d.load_inner * np.sin(d.angle_inner)).sum(),
    ]
    # equilibrium to 1e-12 of the load
    np.testing.assert_allclose(carried, f[:3], atol=1e-8)


def test_running_bearing_has_two_angles():
    running = Running(B218, 1000.0)
    d = load_distribution(running, running.displacement(load(Fz=17.8e3)))
    assert (d.angle_inner > d.angle_outer).all()
    assert (d.load_outer > d.load_inner).all()
    # 3Q/2πab by the formula
    a, b = B218.inner_contact.semi_axes(float(d.load_inner[0]))
    assert d.pressure_inner[0] == pytest.approx(1.5 * d.load_inner[0] / (math.pi * a * b), rel=1e-12)


def test_pressure_over_the_static_limit_names_the_ball():
    brg = bearing("6205", clearance=0.0)
    # the load at which ball 4, at azimuth 3·40°, has 4.2 GPa: p ∝ Q^⅓
    Q = brg.inner_contact.load_at_pressure(4.2e9)
    direction = np.array([math.cos(math.radians(120)), math.sin(math.radians(120)), 0, 0, 0, 0])

    def place(share):
        return (share * Q / brg.kappa) ** (2 / 3) * direction

    with warnings.catch_warnings():
        warnings.simplefilter("error")
        load_distribution(brg, place(0.999))
    with pytest.warns(BearingWarning, match=r"ball 4: 4\.2\d* GPa on the inner race"):
        load_distribution(brg, place(1.03))


def test_ellipse_on_the_shoulder_warns_and_a_ball_beyond_it_is_refused():
    brg = bearing("6205", clearance=20e-6)
    q = brg.displacement(load(Fz=8e3))
    d = load_distribution(brg, q)
    alpha = d.angle_inner[0]
    # a shoulder whose edge lies at an angle φ on a groove of radius f·Dw is f·Dw(1 − cosφ) high
    just_below, just_above = (0.52 * brg.Dw * (1 - math.cos(alpha + e)) for e in (-0.01, 0.02))
    with pytest.warns(BearingWarning, match=r"contact angle .*ellipse") as warned:
        load_distribution(brg, q, shoulder=just_above)
    # one warning a race
    assert len(warned) == 2
    with pytest.raises(ValueError, match=r"beyond the shoulder: ball \d.*inner race"):
        load_distribution(brg, q, shoulder=just_below)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        load_distribution(brg, brg.displacement(load(Fz=200.0)), shoulder=0.2 * brg.Dw)


def test_mean_radial_stiffness_over_the_passage():
    # radial load along x: where balls stand unevenly the ring moves in y too; so solve both by hand, with
    # Newton on x and bisection on y, at each of eight angles
    brg, F, n = bearing("6306", clearance=10e-6), 3000.0, 8
    Pd, kappa = 10e-6, brg.kappa
    found = []
    for k in range(n):
        psi = 2 * math.pi / 8 * k / n + 2 * math.pi * np.arange(8) / 8

        def held(x, y, psi=psi):
            s = np.maximum(x * np.cos(psi) + y * np.sin(psi) - Pd / 2, 0)
            return kappa * s**1.5, 1.5 * kappa * np.sqrt(s)

        def across(x, psi=psi, held=held):
            return brentq(lambda y: held(x, y)[0] @ np.sin(psi), -1e-4, 1e-4, xtol=1e-18)

        x = brentq(
            lambda x, psi=psi, held=held, across=across: held(x, across(x))[0] @ np.cos(psi) - F,
            1e-6, 1e-3, xtol=1e-18,
        )  # fmt: skip
        found.append(held(x, across(x))[1] @ np.cos(psi) ** 2)
    # groove centres in line: all displacement is indentation; the root finder leaves 1e-12
    assert passage(brg, load(Fx=F), n).mean_stiffness[0, 0] == pytest.approx(np.mean(found), rel=1e-8)


def test_passage_under_axial_load_changes_nothing():
    p = passage(SIX_202, load(Fz=180.0), 5)
    # theory.md §3.5
    assert p.mean_stiffness[0, 0] == pytest.approx(9.533296e7, rel=1e-7)
    np.testing.assert_allclose(p.stiffness[:, 2, 2], 1.561296e7, rtol=4e-7)
    assert p.mean_displacement[2] == pytest.approx(77.76e-6, abs=5e-9)
    five = without_spin(p.stiffness)
    assert five.shape == (5, 5, 5)
    np.testing.assert_array_equal(five[0], p.stiffness[0][:5, :5])


def test_bad_input_is_named():
    brg = SIX_202
    uneven = dataclasses.replace(brg, oversize=(1e-6,) + (0.0,) * 7)
    for field, call in {
        "n": lambda: passage(brg, load(Fz=1.0), 0),
        "load": lambda: passage(brg, [1.0]),
        "bearing": lambda: passage(uneven, load(Fz=1.0)),
        "q": lambda: load_distribution(brg, [1.0]),
        "shoulder": lambda: load_distribution(brg, np.zeros(6), shoulder=math.nan),
        "stiffness": lambda: without_spin(np.eye(5)),
    }.items():
        with pytest.raises(ValueError, match=f"^{field} is "):
            call()
