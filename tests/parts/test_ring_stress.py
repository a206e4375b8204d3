"""Hoop stress at the outside of a ring: against plane elasticity, and of a bearing on a bed."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from bearingdyn.material import STEEL
from bearingdyn.parts import FlexibleBearing, FlexibleRing, RingBed
from flexible_rings import B6305, CUSHIONED, MM, RING
from verified.ring_theory import annulus_hoop

LOAD = (0.0, -3000.0, 0.0, 0.0, 0.0, 0.0)


@pytest.mark.parametrize("sine", [0, 1])
def test_every_order_has_the_stress_of_plane_elasticity(sine: int) -> None:
    a, b, width = 40 * MM, 60 * MM, 1 * MM
    ring = FlexibleRing(a, b, width, arm=50 * MM, groove=width, outside="flexible", refinement=2.0, f_max=0.0)
    element = ring.superelement()
    raceway, psi = element.raceways["raceway"], np.linspace(0.1, 6.0, 40)
    rows = ring.body.hoop_stress(b, (-0.05 * width, 0.05 * width), psi, STEEL)
    flexible = np.linalg.pinv(element.K, rcond=1e-13)
    for n in (2, 3, 4, 6):
        stress = rows @ flexible @ raceway.rows[raceway.series.index(0, n, sine)]
        exact = annulus_hoop(n, a, b) / (width * a * math.pi)  # of a unit load on the coefficient
        wave = np.sin(n * psi) if sine else np.cos(n * psi)
        # quadratic elements: their strain at an edge is second order in the pitch
        np.testing.assert_allclose(stress, exact * wave, rtol=0, atol=5e-3 * abs(exact))


def test_the_outside_is_stretched_below_the_heaviest_ball() -> None:
    """Under a load that the bed spreads, the outside is stretched most below the ball that carries most."""
    bearing = FlexibleBearing(B6305, replace(RING, outside=RingBed(1e10), f_max=0.0))
    q, psi = bearing.displacement(LOAD, -math.pi / 2), np.linspace(0, 2 * math.pi, 360, endpoint=False)
    stress = bearing.hoop_stress(q, psi, -math.pi / 2)
    assert math.degrees(psi[np.argmax(stress)]) == pytest.approx(270.0, abs=1.0)
    # symmetric about the load, ball 7 of 7 straight below
    np.testing.assert_allclose(
        stress, bearing.hoop_stress(q, math.pi - psi, -math.pi / 2), atol=1e-6 * stress.max()
    )
    # no more than the load as one force at an arm of the radius
    assert 0 < stress.max() < 3000.0 * 30 * MM / (17 * MM * (3.5 * MM) ** 2 / 6)


def test_an_outside_that_is_kept_round_is_refused() -> None:
    bearing = FlexibleBearing(B6305, RING)
    with pytest.raises(
        ValueError, match=r"ring\.outside is 'rigid'; an outside that is kept round has no hoop"
    ):
        bearing.hoop_stress(np.zeros(6), [0.0])
    soft = FlexibleBearing(B6305, replace(CUSHIONED, f_max=0.0))
    assert np.isfinite(soft.hoop_stress(soft.displacement(LOAD), [0.0, 1.0])).all()
