"""Tangents averaged over a ball's passage, with balls that lose their load on the way."""

from __future__ import annotations

import math

import numpy as np
import pytest

from bearingdyn.analysis import equilibrium, modes
from bearingdyn.application import Application
from bearingdyn.bearing import BallBearing
from bearingdyn.parts import RigidBody

Z, LOAD = 8, 300.0
SIZE = (Z, 12.303e-3, 52e-3, 0.52, 0.53)
MASS = 2.0


def rotor(angle0: float) -> Application:
    """A body on one bearing under a radial load, its first ball at `angle0` from x; clearance 40 µm."""
    app = Application()
    app.add("rotor", RigidBody(MASS, (0.01, 0.01, 0.005)))
    app.bearing("b", BallBearing(*SIZE, clearance=40e-6, angle0=angle0), inner="rotor.centre", outer="ground")
    # holds what a planar contact leaves free
    app.ground("rotor.centre", stiffness=(0, 0, 1e3, 1e3, 1e3, 1e3))
    app.load("rotor.centre", (0.0, -LOAD, 0, 0, 0, 0))
    return app


def planar(angle0: float) -> tuple[np.ndarray, int]:
    """∂F/∂(x, y) (2, 2), N/m, and the number of loaded balls: Newton on Σ κ δⱼ^{3/2} nⱼ = load, written out.

    Without axial load the contact angle is zero and δⱼ = q·nⱼ − Pd/2.
    """
    kappa = BallBearing(*SIZE, clearance=40e-6).kappa
    azimuth = angle0 + 2 * math.pi * np.arange(Z) / Z
    n = np.stack([np.cos(azimuth), np.sin(azimuth)], axis=1)
    q = np.array([0.0, -40e-6])
    for _ in range(60):
        delta = np.maximum(n @ q - 20e-6, 0.0)
        K = (n * (1.5 * kappa * np.sqrt(delta))[:, None]).T @ n
        q = q + np.linalg.solve(K, np.array([0.0, -LOAD]) - (kappa * delta**1.5) @ n)
    return K, int(np.count_nonzero(delta))


@pytest.mark.parametrize("average", [4, Z, 3])
def test_the_average_is_over_the_places_of_one_passage(average: int) -> None:
    """Ball 1 at k/average of the pitch, by hand: at some places two balls carry, at others three."""
    hand = [planar(2 * math.pi / Z * k / average) for k in range(average)]
    assert len({count for _, count in hand}) > 1, "the number of loaded balls must change on the way"
    wanted = np.mean([K for K, _ in hand], axis=0)
    state = equilibrium(rotor(0.0), average=average)
    # the hand's Newton and the state's tolerance, both 1e-12 of the force
    np.testing.assert_allclose(state.bearings["b"].K[:2, :2], wanted, rtol=1e-6, atol=1e-6 * wanted.max())
    # the state itself is that of the first place
    single = equilibrium(rotor(0.0))
    np.testing.assert_allclose(state.x, single.x, rtol=1e-9, atol=1e-15)
    # and it matters: with a ball below the load the ring is softer by a twentieth than over the passage
    assert single.bearings["b"].K[1, 1] < 0.95 * wanted[1, 1]


def test_modes_swing_on_the_averaged_tangents() -> None:
    """Two modes in the plane, ω² the eigenvalues of the mean tangent over the mass."""
    K = np.mean([planar(2 * math.pi / Z * k / 4)[0] for k in range(4)], axis=0)
    wanted = np.sqrt(np.linalg.eigvalsh(K) / MASS) / (2 * math.pi)
    found = modes(equilibrium(rotor(0.0), average=4)).frequency.values
    np.testing.assert_allclose(found[-2:], wanted, rtol=1e-6)
