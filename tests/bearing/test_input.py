"""A bearing as a value, and what its constructors refuse."""

from __future__ import annotations

import dataclasses
import math
import pickle

import numpy as np
import pytest

from bearingdyn.bearing import BallBearing, ConstantDamping, LoadDamping, TabulatedDamping
from bearingdyn.bearing.catalogue import CATALOGUE, bearing, entry
from bearingdyn.material import STEEL, Elastic

ISO = dict(Z=7, Dw=11.5e-3, Dpw=43.5e-3, fi=0.52, fo=0.53)
LOOSE = BallBearing(**ISO, clearance=15e-6)


class TestValues:
    def test_replacing_geometry_replaces_what_follows_from_it(self):
        brg = BallBearing(**ISO, clearance=10e-6)
        other = dataclasses.replace(brg, fi=0.53)
        assert other.kappa < brg.kappa
        assert other.arm > brg.arm
        fixed = dataclasses.replace(
            BallBearing(**ISO, clearance=10e-6, kappa=1e10, cage_ratio=0.4, arm=0.02), fi=0.53
        )
        assert (fixed.kappa, fixed.cage_ratio, fixed.arm) == (1e10, 0.4, 0.02)

    def test_equal_and_picklable(self):
        brg = BallBearing(**ISO, clearance=10e-6, damping=TabulatedDamping([0, 1e-6], [1, 2]))
        copy = pickle.loads(pickle.dumps(brg))
        np.testing.assert_array_equal(copy.kernel().damping_table, brg.kernel().damping_table)
        assert BallBearing(**ISO, clearance=10e-6) == BallBearing(**ISO, clearance=10e-6, damping=0.0)
        with pytest.raises(dataclasses.FrozenInstanceError):
            brg.Z = 9

    def test_hybrid_bearing_is_stiffer(self):
        ceramic = Elastic(310e9, 0.26, 3200.0)
        hybrid, plain = (BallBearing(**ISO, clearance=0.0, ball_material=b).kappa for b in (ceramic, STEEL))

        # κ ∝ E*, from two materials
        def modulus(b):
            return 1 / ((1 - 0.3**2) / 210e9 + (1 - b.nu**2) / b.E)

        assert hybrid / plain == pytest.approx(modulus(ceramic) / modulus(STEEL), rel=1e-13)

    def test_catalogue_bearings_fit_their_boundary(self):
        for name in CATALOGUE:
            e = entry(name)
            assert e.bore < e.Dpw - e.Dw
            assert e.Dpw + e.Dw < e.outside
            clearance = None if e.contact_angle else 10e-6
            assert bearing(name, clearance=clearance).static_rating > 0


class TestBadInput:
    @pytest.mark.parametrize(
        ("field", "value"),
        [
            ("Z", 2), ("Z", 7.5), ("Z", math.nan), ("Z", -7), ("Z", "seven"), ("Z", 12),
            ("Dw", 0.0), ("Dw", -1e-3), ("Dw", "0.0115"), ("Dw", math.nan),
            ("Dpw", 0.0), ("Dpw", math.inf), ("Dpw", 20e-3),
            ("fi", 0.5), ("fi", 0.49), ("fi", math.nan), ("fo", 0.5), ("fo", -1.0), ("fo", math.nan),
            ("clearance", -1e-3), ("clearance", math.nan), ("clearance", 10.0), ("clearance", "C3"),
            ("film", -1e-7), ("film", math.nan), ("damping", -30.0),
            ("damping", math.nan), ("damping", "oil"),
            ("kappa", 0.0), ("kappa", math.nan), ("cage_ratio", 1.5), ("cage_ratio", math.nan),
            ("arm", 0.0), ("arm", math.nan), ("angle0", math.inf), ("material", 210e9),
            ("ball_material", None),
        ],
    )  # fmt: skip
    def test_constructor_names_the_field(self, field, value):
        named = "Dpw" if (field, value) in {("Z", 12)} else field
        with pytest.raises(ValueError, match=rf"{named}(\.c)? is .*; "):
            BallBearing(**{**ISO, "clearance": 10e-6, field: value})

    @pytest.mark.parametrize("angle", [-0.1, math.pi / 2, 15.0, math.nan])
    def test_contact_angle_is_in_radians(self, angle):
        with pytest.raises(ValueError, match=r"contact_angle is .*radians"):
            BallBearing(**ISO, contact_angle=angle)

    @pytest.mark.parametrize("both", [{}, {"clearance": 1e-5, "contact_angle": 0.3}])
    def test_exactly_one_of_clearance_and_contact_angle(self, both):
        with pytest.raises(ValueError, match="exactly one"):
            BallBearing(**ISO, **both)

    @pytest.mark.parametrize(
        "make",
        [
            lambda: TabulatedDamping([0.0], [1.0]),
            lambda: TabulatedDamping([0.0, 0.0], [1.0, 1.0]),
            lambda: TabulatedDamping([1e-6, 0.0], [1.0, 1.0]),
            lambda: TabulatedDamping([0.0, 1e-6], [1.0]),
            lambda: TabulatedDamping([0.0, 1e-6], [1.0, -1.0]),
            lambda: TabulatedDamping([0.0, math.nan], [1.0, 1.0]),
            lambda: LoadDamping(-1e-5),
            lambda: ConstantDamping(math.nan),
        ],
    )
    def test_damping_law_names_its_field(self, make):
        with pytest.raises(ValueError, match=r"damping\.(delta|c|time) is "):
            make()

    @pytest.mark.parametrize("bad", [[0, 0, 0], np.zeros((6, 1)), [0, 0, math.nan, 0, 0, 0], "q", 1.0])
    def test_wrong_shapes_are_refused(self, bad):
        brg = LOOSE
        for call in (brg.force, brg.stiffness, brg.ball_loads, brg.relative):
            with pytest.raises(ValueError, match="q is "):
                call(bad)
        with pytest.raises(ValueError, match="velocity is "):
            brg.force(np.zeros(6), velocity=bad)
        with pytest.raises(ValueError, match="load is "):
            brg.displacement(bad)

    def test_angle_and_speed_must_be_finite(self):
        with pytest.raises(ValueError, match="angle is nan"):
            LOOSE.force(np.zeros(6), math.nan)
        with pytest.raises(ValueError, match="speed is inf"):
            LOOSE.force(np.zeros(6), speed=math.inf)

    def test_unknown_designation_lists_the_known(self):
        with pytest.raises(ValueError, match=r"designation is '6999'; the nearest are \d+"):
            bearing("6999", clearance=1e-5)
