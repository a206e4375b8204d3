"""Rings pressed into bores that are not round, against plane elasticity."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
import scipy

from bearingdyn.material import STEEL
from bearingdyn.parts import BoreShape, FlexibleBearing, FlexibleRing, Layer
from flexible_rings import B6305, LAYER, RING

A, B, WIDTH = 0.040, 0.060, 1e-3  # a slice: plane stress
SLICE = FlexibleRing(
    A, B, WIDTH, arm=0.05, groove=WIDTH, order=2, outside="flexible", f_max=0.0, refinement=2.0
)


def michell(n: int, r: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """σ_rr, σ_rθ and 2G u_r of the four stress functions r^n, r^−n, r^(n+2), r^(2−n) times cos nθ.

    Barber, Elasticity (2010), tables 8.1 and 9.1, in plane stress.
    """
    kappa = (3 - STEEL.nu) / (1 + STEEL.nu)
    radial = np.array([-n * (n - 1), -n * (n + 1), -(n + 1) * (n - 2), -(n + 2) * (n - 1)])
    shear = np.array([n * (n - 1), -n * (n + 1), n * (n + 1), -n * (n - 1)])
    power = np.array([n - 2.0, -n - 2.0, n, -n])
    motion = np.array([-n, n, kappa - n - 1, kappa + n - 1]) * r ** (power + 1)
    return radial * r**power, shear * r**power, motion


@pytest.mark.parametrize("n", [2, 3, 7])
def test_the_race_follows_the_bore_as_plane_elasticity_has_it(n: int) -> None:
    at_a, at_b = michell(n, A), michell(n, B)
    # no stress inside, no friction outside, the outside moved by 1 m
    G = STEEL.E / (2 * (1 + STEEL.nu))
    # orders of magnitude apart: each function by its size outside
    size = np.abs(at_b[2])
    rows = np.array([at_a[0], at_a[1], at_b[1], at_b[2]]) / size
    rows /= np.abs(rows).max(axis=1)[:, None]
    amplitudes = np.linalg.solve(rows, [0, 0, 0, 2 * G / np.abs(at_b[2] / size).max()])
    wanted = float((at_a[2] / size) @ amplitudes) / (2 * G)
    (wave,) = SLICE.race_waves(BoreShape({n: (3e-6, 4e-6)}, interference=1e-3))
    assert wave.order == n
    # a section 1 mm wide is in plane stress to some 1e-4
    assert wave.amplitude == pytest.approx(5e-6 * wanted, rel=5e-4)
    # largest where 3 cos nψ + 4 sin nψ is
    assert wave.phase == pytest.approx(-math.atan2(4, 3))


def test_a_ring_parts_from_a_bore_that_its_fit_does_not_fill() -> None:
    bore = BoreShape({2: (20e-6, 0.0)})
    with pytest.raises(ValueError, match=r"bore.interference is 0 m; the ring parts .* at 0 degrees") as told:
        RING.race_waves(bore)
    least = float(str(told.value).split("at least ")[1].split(" m")[0])
    # a thin ring pressed by p all round gives p r²/(E t); bent by p₂ cos 2ψ it gives p₂ r⁴·12/(9 E t³): the
    # fit must be at least h (t/r)²·9/12 at the mean radius, thick as it is to a quarter
    t, r = 3.5e-3, 29.25e-3
    assert least == pytest.approx(20e-6 * (t / r) ** 2 * 0.75, rel=0.25)
    assert RING.race_waves(replace(bore, interference=least))[0].order == 2  # what is told does
    with pytest.raises(ValueError, match="make it at least"):
        RING.race_waves(replace(bore, interference=0.98 * least))


def test_points_of_a_bore_give_its_shape() -> None:
    psi = np.linspace(0, 2 * math.pi, 90, endpoint=False)
    r = 0.031 + 5e-6 * np.cos(2 * psi) - 2e-6 * np.sin(3 * psi)
    points = np.stack([r * np.cos(psi) + 1e-3, r * np.sin(psi) - 2e-3], axis=-1)
    found = BoreShape.from_points(points, highest=4, interference=1e-5)
    assert found.interference == 1e-5
    # second order in the shape over the radius: 1e-9 m
    np.testing.assert_allclose(found.waves[2], (5e-6, 0.0), atol=3e-9)
    np.testing.assert_allclose(found.waves[3], (0.0, -2e-6), atol=3e-9)
    np.testing.assert_allclose(found.waves[4], (0.0, 0.0), atol=3e-9)
    with pytest.raises(ValueError, match="need 9"):
        BoreShape.from_points(points[:8], highest=4)
    with pytest.raises(ValueError, match="degrees of the bore open"):
        BoreShape.from_points(points[:45], highest=4)


def test_an_ovalised_bore_loads_the_balls_on_its_short_axis() -> None:
    """Wide along x: the race closes along y, where a load sinks less, and the balls beside it part."""
    assert RING.bearing is not None
    bore = BoreShape({2: (8e-6, 0.0)}, interference=1e-5)
    wave = RING.race_waves(bore)
    # a ring 3.5 mm thick follows: its race moves nearly as the bore does
    assert wave[0].amplitude == pytest.approx(8e-6, rel=0.1)
    oval = replace(RING.bearing, waviness=wave)
    load, angle = (0.0, -3000.0, 0.0, 0.0, 0.0, 0.0), -0.5 * math.pi
    theta = 2 * math.pi / 7 * np.arange(7)  # of the balls, from below
    rise = {}
    for name, bearing, wide in (("round", RING.bearing, 0.0), ("oval", oval, wave[0].amplitude)):

        def carried(depth: float, wide: float = wide) -> float:
            closed = depth * np.cos(theta) - 5e-6 + wide * np.cos(2 * theta)  # Pd = 10 µm
            return float((B6305.kappa * np.maximum(closed, 0.0) ** 1.5) @ np.cos(theta)) - 3000.0

        own = scipy.optimize.brentq(carried, 0.0, 1e-4)
        rise[name] = (-FlexibleBearing(bearing, RING).displacement(load, angle)[1], own)
    flexible, stiff = np.subtract(rise["round"], rise["oval"])
    # Hertz's contacts alone in the same race; the rigid bore adds some 4 % of stiffness
    assert flexible == pytest.approx(stiff, rel=0.05)
    assert stiff > 3e-6


def test_bad_shapes_are_named() -> None:
    for waves, name in (
        ({1: (1e-6, 0.0)}, "waves"),
        ({2: (math.nan, 0.0)}, r"waves\[2\]"),
        ({2: 5e-6}, r"waves\[2\] is 5e-06"),
        ({2: (5e-6,)}, r"waves\[2\] is \(5e-06,\)"),
        ([2, 5e-6], "waves is"),
        (None, "waves is None"),
    ):
        with pytest.raises(ValueError, match=name):
            BoreShape(waves)  # type: ignore[arg-type]
    with pytest.raises(ValueError, match="interference"):
        BoreShape({}, interference=-1e-6)
    with pytest.raises(ValueError, match="layer is given"):
        replace(RING, layer=LAYER).race_waves(BoreShape({2: (1e-6, 0.0)}))
    assert isinstance(LAYER, Layer)
