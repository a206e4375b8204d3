"""Static equilibrium of a loaded ring: found everywhere, and right."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.optimize import brentq

from bearingdyn.application import Application
from bearingdyn.bearing import BallBearing
from bearingdyn.bearing.catalogue import bearing
from bearingdyn.parts import RigidBody
from bearingdyn.system import assemble

ISO = dict(Z=7, Dw=11.5e-3, Dpw=43.5e-3, fi=0.52, fo=0.53)


def load(**components: float) -> np.ndarray:
    return np.array([components.get(name, 0.0) for name in ("Fx", "Fy", "Fz", "Mx", "My", "Mz")])


class TestEquilibrium:
    @pytest.mark.parametrize("designation", ["6202", "6305", "6306"])
    @pytest.mark.parametrize("clearance", [0.0, 10e-6, 40e-6])
    @pytest.mark.parametrize("fraction", [1e-6, 1e-3, 0.03, 0.3, 1.0, 2.0])
    def test_found_from_a_touch_to_twice_the_static_rating(self, designation, clearance, fraction):
        brg = bearing(designation, clearance=clearance)
        F = fraction * brg.static_rating
        for direction in (
            load(Fx=1), load(Fy=-1), load(Fz=1), load(Fz=-1), load(Fx=0.6, Fy=-0.6, Fz=0.3),
            load(Fy=-1, Fz=0.02), load(Fx=1, My=0.3 * brg.Dpw), load(Mx=brg.Dpw / 2),
        ):  # fmt: skip
            f = F * direction
            for angle in (0.0, 0.1, math.pi / brg.Z):
                q = brg.displacement(f, angle)
                scale = np.array([1, 1, 1, brg.arm, brg.arm, 1])
                # 1e-12 of the load, unless round-off of play (1e-16·Pd/δ) is more at the lightest loads
                np.testing.assert_allclose(brg.force(q, angle) / scale, f / scale, rtol=0, atol=2e-10 * F)
                assert q[5] == 0

    @pytest.mark.parametrize("radial", [0.0, 1.0, 60.0, 500.0, 5e3])
    def test_preloaded_motor_bearing(self, radial):
        brg = bearing("6305", clearance=15e-6)
        f = load(Fy=-radial, Fz=180.0)
        np.testing.assert_allclose(brg.force(brg.displacement(f, 0.2), 0.2), f, atol=1e-8)

    def test_radial_equilibrium_against_a_scalar_root(self):
        # Y-direction load on a ball: the sum κ Σ (δ cosψ − Pd/2)^{3/2} cosψ solved by hand
        brg = bearing("6306", clearance=20e-6)
        psi = 2 * math.pi * np.arange(8) / 8

        def held(d):
            return brg.kappa * (np.maximum(d * np.cos(psi) - 10e-6, 0) ** 1.5 * np.cos(psi)).sum() - 3000.0

        # groove-centre distances rounded to 1e-19 m
        assert brg.displacement(load(Fx=3000.0))[0] == pytest.approx(
            brentq(held, 0, 1e-3, xtol=1e-16), rel=1e-11
        )

    def test_rest_without_load(self):
        assert not bearing("6305", clearance=10e-6).displacement(np.zeros(6)).any()
        assert not BallBearing(**ISO, contact_angle=0.3).displacement(np.zeros(6)).any()

    def test_moment_about_the_shaft_is_carried_by_whatever_holds_it(self):
        brg = bearing("6305", clearance=10e-6)
        np.testing.assert_array_equal(
            brg.displacement(load(Fx=50.0, Mz=3.0)), brg.displacement(load(Fx=50.0))
        )

    def test_work_of_loading_is_the_stored_energy(self):
        # Clapeyron for s^{3/2} without play: ∫F dδ = (2/5) F δ
        brg = BallBearing(**ISO, clearance=0.0)
        d = brg.displacement(load(Fx=1000.0))[0]
        work, _ = quad(lambda x: brg.force([x, 0, 0, 0, 0, 0])[0], 0, d, epsrel=1e-10)
        # groove-centre distances change the lever of no ball at α = 0: exact but for the quadrature
        assert work == pytest.approx(0.4 * 1000.0 * d, rel=1e-8)


class TestBetweenTwoRings:
    """A bearing between two bodies, as an application assembles it."""

    @pytest.fixture
    def rings(self):
        app = Application()
        app.add("inner", RigidBody(1.0, (1e-3,) * 3))
        app.add("outer", RigidBody(2.0, (2e-3,) * 3))
        app.bearing(
            "b", bearing("6305", clearance=0.0, film=1e-6), inner="inner.centre", outer="outer.centre"
        )
        for name in ("inner", "outer"):
            app.ground(f"{name}.centre", stiffness=(1e3,) * 6)  # springs: every motion stays a coordinate
        return assemble(app)

    def test_action_is_reaction_in_all_six_components(self, rings):
        brg = bearing("6305", clearance=0.0, film=1e-6)
        f = brg.force([3e-6, -2e-6, 8e-6, 1e-4, -2e-4, 1e-3], 0.3)
        # the coefficients' forces g with f = Bᵀ g of the bearing alone
        g = np.linalg.lstsq(brg.coefficients().T, f, rcond=None)[0]
        inner, outer = (rings.rows(f"{name}.centre") @ rings.B.T @ g for name in ("inner", "outer"))
        np.testing.assert_allclose(inner, f, rtol=1e-12, atol=1e-12 * np.abs(f).max())
        np.testing.assert_allclose(inner + outer, 0, atol=1e-12 * np.abs(f).max())

    def test_rings_moved_together_feel_nothing(self, rings):
        # both rings are one rigid body about their common reference
        together = rings.rows("inner.centre").T + rings.rows("outer.centre").T
        np.testing.assert_array_equal(rings.B @ together, 0)
