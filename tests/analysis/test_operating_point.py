"""The warm running state: closed forms of heat in slab and ring, and a fixed point that balances its heat."""

from __future__ import annotations

import math
import warnings

import numpy as np
import pytest

import bearingdyn as bd
from bearingdyn.bearing import Mounting, Seat
from bearingdyn.demo import motor
from bearingdyn.notice import UnloadedBearing, UnusualMagnitude

OIL = bd.bearing.Lubricant(bd.bearing.Walther.iso_vg(32))
RUBBER = bd.Maxwell(G0=1e6, G=[2e6], tau=[1e-4], K=2e9, density=1150.0)
SPEED = 3000 * math.pi / 30


class TestNetwork:
    def test_slab_with_heat_of_its_own(self):
        """Both faces at one temperature: the middle qL²/8k above them, the mean qL²/12k."""
        area, L, k, W = 0.01, 0.004, 0.25, 8.0
        net = bd.ThermalNetwork(20.0)
        net.link("left", "air", 1e6)
        net.link("right", "air", 1e6)
        net.slab("rubber", "left", "right", area=area, thickness=L, conductivity=k)
        q = W / (area * L)
        rise = net.peak("rubber", {"rubber": W}) - 20
        # half a percent is asked for; cells give 1/24²
        assert rise == pytest.approx(q * L**2 / (8 * k), rel=5e-3)
        assert net.temperatures({"rubber": W})["rubber"] - 20 == pytest.approx(q * L**2 / (12 * k), rel=5e-3)

    def test_slab_cooled_on_one_side(self):
        area, L, k, W = 0.01, 0.004, 0.25, 2.0
        net = bd.ThermalNetwork(0.0)
        net.link("right", "air", 1e6)
        net.slab("rubber", "left", "right", area=area, thickness=L, conductivity=k)
        q = W / (area * L)
        assert net.temperatures({"rubber": W})["left"] == pytest.approx(q * L**2 / (2 * k), rel=5e-3)

    def test_ring_with_heat_of_its_own(self):
        """Outer face held, inner face insulated: T(a) = q/4k [b² − a² − 2a² ln(b/a)] (Carslaw & Jaeger)."""
        a, b, width, k, W = 0.02, 0.03, 0.016, 0.2, 5.0
        net = bd.ThermalNetwork(0.0)
        net.link("outside", "air", 1e6)
        net.ring("rubber", "inside", "outside", r_inner=a, r_outer=b, width=width, conductivity=k)
        q = W / (math.pi * (b**2 - a**2) * width)
        rise = q / (4 * k) * (b**2 - a**2 - 2 * a**2 * math.log(b / a))
        assert net.temperatures({"rubber": W})["inside"] == pytest.approx(rise, rel=5e-3)

    def test_ring_without_heat_conducts_as_a_logarithm(self):
        a, b, width, k = 0.02, 0.03, 0.016, 0.2
        net = bd.ThermalNetwork(0.0)
        net.link("outside", "air", 1e9)
        net.ring("rubber", "inside", "outside", r_inner=a, r_outer=b, width=width, conductivity=k)
        rise = math.log(b / a) / (2 * math.pi * k * width)
        assert net.temperatures({"inside": 1.0})["inside"] == pytest.approx(rise, rel=1e-6)

    def test_order_of_accuracy_is_two(self):
        exact, errors = 1 / 8, []
        for cells in (8, 16):
            net = bd.ThermalNetwork(0.0)
            net.link("l", "air", 1e9)
            net.link("r", "air", 1e9)
            net.slab("s", "l", "r", area=1.0, thickness=1.0, conductivity=1.0, cells=cells)
            errors.append(abs(net.temperatures({"s": 1.0})["s"] - exact * 2 / 3))
        assert errors[0] / errors[1] == pytest.approx(4, rel=0.05)

    def test_what_cannot_cool_is_named(self):
        net = bd.ThermalNetwork()
        net.link("a", "b", 1.0)
        with pytest.raises(ValueError, match=r"^network is \['a', 'b'\]; these nodes have no way to the air"):
            net.temperatures({"a": 1.0})

    @pytest.mark.parametrize(
        ("act", "message"),
        [
            (lambda n: n.link("a", "b", 0.0), "^conductance of 'a' to 'b' is 0.0"),
            (lambda n: n.link("a", "a", 1.0), "^b is 'a'; a node cannot be joined to itself"),
            (lambda n: n.temperatures({"x": 1.0}), "^heat is 'x'"),
            (lambda n: n.temperatures({"a": math.nan}), "^heat of 'a' is nan"),
            (
                lambda n: n.ring("r", "a", "b", r_inner=2.0, r_outer=1.0, width=1.0, conductivity=1.0),
                "^r_outer is ",
            ),
        ],
    )
    def test_bad_input_is_named(self, act, message):
        net = bd.ThermalNetwork()
        net.link("a", "air", 1.0)
        with pytest.raises(ValueError, match=message):
            act(net)


class TestOperatingPoint:
    def test_heat_made_is_heat_carried_away(self):
        warm = bd.operating_point(motor(RUBBER), speed=SPEED, oil=OIL, tolerance=1e-4)
        T = warm.temperatures
        d, D, B = 0.017, 0.040, 0.012
        film = 320.0 * math.pi * B
        out = sum(
            film * d * (T[f"{s}.inner"] - T["air"]) + film * D * (T[f"{s}_layer.housing"] - T["air"])
            for s in ("left", "right")
        )
        # temperatures repeat within 1e-4 of some 3 K
        assert out == pytest.approx(sum(warm.heat.values()), rel=2e-4)
        # and the friction is that of the temperatures found
        for side in ("left", "right"):
            mean = (T[f"{side}.inner"] + T[f"{side}.outer"]) / 2
            assert warm.viscosity[side] == pytest.approx(OIL.kinematic.viscosity(mean), rel=1e-5)
            assert warm.friction[side].power == pytest.approx(warm.heat[side], rel=1e-12)

    def test_a_layer_insulates_its_bearing(self):
        bare, layered = (bd.operating_point(motor(r), speed=SPEED, oil=OIL) for r in (None, RUBBER))
        assert layered.temperatures["left.outer"] > bare.temperatures["left.outer"] + 3

    def test_rings_that_part_in_temperature_change_the_clearance(self):
        warm = bd.operating_point(motor(None), speed=SPEED, oil=OIL)
        inner, outer = (warm.temperatures[f"left.{ring}"] for ring in ("inner", "outer"))
        balls = (inner + outer) / 2
        race_i, race_o = 28.5e-3 - 6.746e-3, 28.5e-3 + 6.746e-3
        taken = 11.5e-6 * (race_o * (outer - 20) - race_i * (inner - 20) - 2 * 6.746e-3 * (balls - 20))
        assert warm.clearance["left"] == pytest.approx(8e-6 + taken, rel=2e-3)

    def test_vibration_heats_a_layer_as_its_loss_modulus_says(self):
        motion = [0, 2e-5, 0, 0, 0, 0]
        warm = bd.operating_point(
            motor(RUBBER), speed=SPEED, oil=OIL, layer_heat={"left_layer": (200.0, motion)}
        )
        layer = bd.Layer(0.020, 0.024, 0.014, RUBBER)
        K = layer.stiffness(2 * math.pi * 200.0)
        expected = 0.5 * 2 * math.pi * 200.0 * K.imag[7, 7] * motion[1] ** 2
        assert warm.heat["left_layer"] == pytest.approx(expected, rel=1e-9)
        assert expected > 0.01

    def test_a_made_runaway_is_found_and_named(self):
        """Heat that doubles every 5 K against a network that carries a few W at most."""
        with pytest.raises(
            bd.ThermalRunaway, match=r"node 'left_layer.*' has \d+ °C after \d+ rounds, and rising"
        ):
            bd.operating_point(
                motor(RUBBER),
                speed=SPEED,
                oil=OIL,
                layer_heat={"left_layer": lambda T: 5 * 2 ** ((T - 20) / 5)},
            )

    def test_just_below_the_runaway_there_is_a_point(self):
        """W = W0 e^{(T−Ta)/s} into a conductance G has a steady state while e W0 < s G (Semenov)."""
        s = 10.0
        G, conductance = 1.0, {}
        for name, share in (("below", 0.9), ("above", 1.15)):
            conductance[name] = share * s * G / math.e
        for name, W0 in conductance.items():
            net = bd.ThermalNetwork(20.0)
            for node in ("left", "right"):
                net.link(f"{node}.inner", "air", 1e4)
                net.link(f"{node}.outer", "air", 1e4)
            net.link("left_layer", "air", G)

            def run(W0=W0, net=net):
                return bd.operating_point(
                    motor(RUBBER), speed=SPEED, oil=OIL, network=net,
                    layer_heat={"left_layer": lambda T: W0 * math.exp((T - 20) / s)},
                )  # fmt: skip

            if name == "above":
                with pytest.raises(bd.ThermalRunaway, match="left_layer"):
                    run()
                continue
            rise = run().temperatures["left_layer"] - 20
            assert G * rise == pytest.approx(W0 * math.exp(rise / s), rel=5e-3)

    def test_fits_that_eat_the_clearance_are_named(self):
        tight = {"left": Mounting(0.017, 0.040, shaft=Seat(interference=40e-6))}
        with pytest.raises(ValueError, match=r"^clearance of bearing 'left' is -.*have eaten it"):
            bd.operating_point(motor(None), speed=SPEED, oil=OIL, mountings=tight)

    def test_it_is_a_dataset_with_units(self):
        data = bd.operating_point(motor(None), speed=SPEED, oil=OIL, friction_model="four-term").dataset()
        assert all("units" in v.attrs for v in data.variables.values())
        assert float(data["temperature"].sel(node="air")) == 20.0
        assert (np.diff(data["heat"]) < 2).all()

    @pytest.mark.parametrize(
        ("change", "message"),
        [
            ({"oil": "VG32"}, "^oil is 'VG32'; give a bd.bearing.Lubricant"),
            ({"speed": math.nan}, "^speed is nan"),
            ({"layer_heat": {"left_lay": 1.0}}, "^layer_heat is 'left_lay'; did you mean 'left_layer'"),
            ({"layer_heat": {"left_layer": -1.0}}, r"^layer_heat\['left_layer'\] is -1.0"),
            ({"mountings": {"middle": Mounting(0.017, 0.04)}}, "^mountings is 'middle'"),
            ({"network": bd.ThermalNetwork()}, "^network is 'left.inner'; it is not there"),
            ({"tolerance": 0.0}, "^tolerance is 0.0"),
        ],
    )
    def test_bad_input_is_named(self, change, message):
        given = {"speed": SPEED, "oil": OIL, **change}
        with pytest.raises(ValueError, match=message):
            bd.operating_point(motor(RUBBER), **given)


def idle() -> bd.Application:
    """A rotor in a bearing with clearance, and nothing that presses it."""
    app = bd.Application()
    app.add("rotor", bd.RigidBody(1.0, (1e-3, 1e-3, 1e-3), rotating=True))
    app.ground("rotor.centre", stiffness=[0, 0, 1e5, 1e3, 1e3, 0])
    app.bearing("b", bd.catalogue.bearing("6205", clearance=1e-5), inner="rotor.centre", outer="ground")
    return app


def test_where_nothing_presses_the_warm_state_says_that_drag_alone_is_in_it():
    with pytest.warns(UnloadedBearing, match="drag alone"):
        bd.operating_point(idle(), speed=100.0, oil=OIL)


@pytest.mark.parametrize("call", [bd.cage_ratios, bd.with_loaded_cages])
def test_where_nothing_presses_a_cage_has_its_nominal_speed_and_it_is_said(call):
    with pytest.warns(UnloadedBearing, match="bearing 'b' carries no load.*nominal speed"):
        call(bd.equilibrium(idle()), 100.0)


def test_a_passage_under_no_load_is_told_of():
    with pytest.warns(UnloadedBearing, match="load is zero"):
        bd.bearing.passage(bd.catalogue.bearing("6205", clearance=1e-5), [0.0] * 6)


@pytest.mark.parametrize(
    ("give", "message"),
    [
        (lambda n: n.film("a", 5000.0, 10.0), "is it in mm²"),
        (lambda n: n.film("a", 0.1, 1e6), "film coefficient|coefficient is"),
        (lambda n: n.slab("s", "a", "b", area=1e-3, thickness=2.0, conductivity=0.2e-3), "conductivity is"),
        (lambda n: n.ring("r", "a", "b", r_inner=26, r_outer=32, width=15, conductivity=0.2), "is it in mm"),
        (lambda n: n.ring("r", "a", "b", r_inner=0.026, r_outer=0.032, width=0.015, conductivity=2e5),
         "is it in mW"),
    ],
)  # fmt: skip
def test_a_network_in_other_units_is_told_of(give, message):
    with warnings.catch_warnings():
        warnings.simplefilter("error", UnusualMagnitude)
        with pytest.raises((ValueError, UnusualMagnitude), match=message):
            give(bd.ThermalNetwork())
