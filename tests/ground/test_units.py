"""Units at the door: factors, speeds in rpm, quantities of pint, and the slips that the checks catch."""

from __future__ import annotations

import inspect
import math
import warnings
from typing import Any

import numpy as np
import pytest

import bearingdyn as bd
from bearingdyn import units
from bearingdyn.notice import UnusualMagnitude
from bearingdyn.units import MPa, deg, g_mm, kN, mm, rpm, um

RUBBER = bd.Maxwell(G0=1e6, G=[2e6], tau=[1e-4], K=2e9, density=1150.0)


def bench() -> bd.Application:
    app = bd.Application()
    app.add("rotor", bd.RigidBody(mass=2.0, inertia=(2e-3, 2e-3, 1e-3), rotating=True))
    app.ground("rotor.centre", stiffness=[1e6] * 3 + [1e4] * 3, damping=[20.0] * 3 + [0.2] * 3)
    app.unbalance("rotor.centre", 20 * g_mm)
    return app


@pytest.mark.parametrize(
    ("text", "factor"),
    [  # BIPM, SI brochure (2019), and NIST SP 811 for the inch, the stokes and the poise
        ("mm", 1e-3), ("µm", 1e-6), ("inch", 0.0254), ("N/µm", 1e6), ("kN/mm", 1e6), ("g mm", 1e-6),
        ("kg mm²", 1e-6), ("MPa", 1e6), ("bar", 1e5), ("rpm", 2 * math.pi / 60), ("deg", math.pi / 180),
        ("cSt", 1e-6), ("mm²/s", 1e-6), ("mPa s", 1e-3), ("cP", 1e-3), ("1/GPa", 1e-9), ("t/mm³", 1e12),
        ("N/mm^1.5", 1e3**1.5), ("N m s/rad", 1.0), ("(m/s)/(N m)", 1.0), ("N/(m s)", 1.0), ("", 1.0),
    ],
)  # fmt: skip
def test_a_unit_has_the_factor_of_the_si_brochure(text: str, factor: float) -> None:
    assert units.read(text).factor == pytest.approx(factor, rel=1e-14)  # two roundings


def test_each_factor_is_what_its_heading_says() -> None:
    named = {name for names in units.FACTORS.values() for name in names}
    assert named == {k for k, v in vars(units).items() if isinstance(v, float)} - {"KELVIN", "μm"} | {"µm"}
    texts = {"Nm": "N m", "Nmm": "N mm", "minute": "min", "hour": "h", "us": "µs", "um": "µm", "N_mm": "N/mm"}
    texts |= {"N_um": "N/µm", "kN_mm": "kN/mm", "g_mm": "g mm", "kg_mm": "kg mm", "kg_mm2": "kg mm²"}
    texts |= {"g_cm3": "g/cm³", "t_mm3": "t/mm³", "mPa_s": "mPa s"}
    for heading, names in units.FACTORS.items():
        for name in names:
            unit = units.read(texts.get(name, name))
            assert unit.alike(units.read(heading.rpartition(", ")[2])), name
            assert getattr(units, "um" if name == "µm" else name) == pytest.approx(unit.factor, rel=1e-14)


@pytest.mark.parametrize("text", ["mm mm(", "m)", "/", "m/", "10", "furlong", "m^", "N*", "m//s"])
def test_a_text_that_is_no_unit_is_refused_by_name(text: str) -> None:
    with pytest.raises(ValueError, match="unit is") as caught:
        units.read(text)
    assert repr(text) in str(caught.value)


def test_an_angle_is_a_dimension_so_that_a_speed_is_no_frequency() -> None:
    assert not units.read("rpm").alike(units.read("Hz"))
    assert units.read("rpm").alike(units.read("deg/s"))


# ------------------------------------------------------------------------------------------------ slips


@pytest.mark.parametrize(
    ("make", "said"),
    [
        (lambda: bd.Layer(26 * mm * mm, 28 * mm * mm, 16 * mm, RUBBER), "converted twice"),
        (lambda: bd.Layer(26 * mm, 28 * mm, 16 * mm * mm * mm, RUBBER), "width"),
        (lambda: bd.Layer(26, 28, 16, RUBBER), "in mm"),
        (lambda: bd.Section(50, 25), "in mm"),
        (lambda: bd.Section(50 * mm, 25 * mm * mm), "converted twice"),
        (lambda: bd.Elastic(210e3, 0.3, 7850), "in MPa"),
        (lambda: bd.Elastic(210e3 * MPa * MPa, 0.3, 7850), "Elastic.E"),
        (lambda: bd.Elastic(210e3 * MPa, 0.3, 7.85), "g/cm³"),
        (lambda: bd.BallBearing(8, 5.953, 25, 0.52, 0.53, clearance=10 * um), "Dw"),
        (lambda: bd.BallBearing(8, 6 * mm, 25 * mm, 0.52, 0.53, contact_angle=15), "degrees"),
        (lambda: bench().load("rotor.centre", (0, 5 * kN * kN * kN, 0, 0, 0, 0)), "force along y"),
        (lambda: bench().unbalance("rotor.centre", 20 * g_mm * 1e6 * 1e6), "g mm"),
        (lambda: bd.Housing(90 * mm * mm, 120 * mm * mm, 20 * mm * mm, 40 * mm * mm), "converted twice"),
    ],
)
def test_a_unit_typed_twice_or_left_out_is_caught_by_its_magnitude(make: Any, said: str) -> None:
    """Refused, or used with a warning that asks for the unit."""
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        try:
            make()
        except ValueError as error:
            told = [str(error)]
        else:
            told = [str(w.message) for w in caught if issubclass(w.category, UnusualMagnitude)]
    assert any(said in text for text in told), told


# ------------------------------------------------------------------------------------------------ rpm


def test_every_analysis_that_takes_a_speed_takes_rpm() -> None:
    for name in sorted(bd.PUBLIC["analysis"]["analysis"]):
        made = getattr(bd, name)
        if inspect.isfunction(made):
            known = inspect.signature(made).parameters
            takes = {"speed", "speeds"} & known.keys()
            # a table for other programs, which take rad/s, and what one speed's cages are
            plain = ("stiffness_table", "cage_ratios", "with_loaded_cages")
            assert not takes or "rpm" in known or name in plain, name


def test_rpm_and_rad_per_second_give_the_same_numbers_bit_for_bit() -> None:
    app, one = bench(), 3000 * rpm
    place = ["rotor.centre.y"]
    pairs = [(bd.modes(app, speed=one)["frequency"], bd.modes(app, rpm=3000)["frequency"])]
    f = [20.0, 99.0]
    pairs.append(
        (
            bd.frequency_response(app, f, place, place, speed=one)["response"],
            bd.frequency_response(app, f, place, place, rpm=3000)["response"],
        )
    )
    pairs.append(
        (
            bd.unbalance_response(app, [one, 2 * one], place)["response"],
            bd.unbalance_response(app, None, place, rpm=[3000, 6000])["response"],
        )
    )
    pairs.append((bd.campbell(app, [0.0, one])["frequency"], bd.campbell(app, rpm=[0, 3000])["frequency"]))
    march = {"dt": 1e-5, "steps": 50, "record": place}
    pairs.append(
        (bd.transient(app, speed=one, **march)["record"], bd.transient(app, rpm=3000, **march)["record"])
    )
    ramp = bd.transient(app, speed=([0.0, 1e-3], [0.0, one]), **march)["record"]
    pairs.append((ramp, bd.transient(app, rpm=([0.0, 1e-3], [0, 3000]), **march)["record"]))
    for first, second in pairs:
        assert np.array_equal(first.values, second.values)


def test_a_speed_is_given_once() -> None:
    with pytest.raises(ValueError, match=r"rpm is 3000; it must be left out, as speed is given too"):
        bd.modes(bench(), speed=1.0, rpm=3000)
    with pytest.raises(ValueError, match=r"speed is None; give it in rad/s, or rpm="):
        bd.transient(bench(), dt=1e-5, steps=1, record=[])
    with pytest.raises(ValueError, match="rpm is nan"):
        bd.modes(bench(), rpm=math.nan)


# ------------------------------------------------------------------------------------------------ pint


@pytest.fixture(scope="module")
def ureg() -> Any:
    return pytest.importorskip("pint").UnitRegistry()


def test_quantities_of_pint_are_taken_where_numbers_are(ureg: Any) -> None:
    Q = ureg.Quantity
    layer = bd.Layer(Q(26, "mm"), Q(2.8, "cm"), width=Q(16, "mm"), material=RUBBER)
    assert (layer.r_inner, layer.r_outer, layer.width) == pytest.approx((0.026, 0.028, 0.016), rel=1e-15)
    shaft = bd.Shaft([bd.Section(Q(300, "mm"), Q(30, "mm"))], {"left": Q(20, "mm"), "right": 0.28})
    assert shaft.seats["left"] == pytest.approx(0.02)
    assert type(shaft.seats["left"]) is float
    ball = bd.BallBearing(8, Q(6, "mm"), Q(25, "mm"), 0.52, 0.53, contact_angle=Q(15, "deg"))
    assert ball.contact_angle == pytest.approx(15 * deg, rel=1e-15)
    rubber = bd.Maxwell(Q(1, "MPa"), Q([1.0, 2.0], "MPa"), Q([1.0, 0.1], "ms"), K=Q(2, "GPa"), density=1150.0)
    assert rubber.G.tolist() == [1e6, 2e6]
    assert rubber.tau == pytest.approx([1e-3, 1e-4])
    app = bench()
    app.load("rotor.centre", (0, Q(-1, "kN"), 0, Q(30, "N*mm"), 0, 0))
    assert app.plan.loads[-1].vector.tolist() == [0, -1000.0, 0, 0.03, 0, 0]  # type: ignore[attr-defined]
    app.unbalance("rotor.centre", Q(20, "g*mm"))
    assert app.plan.loads[-1].moment == pytest.approx(2e-5)  # type: ignore[attr-defined]
    assert bd.modes(app, speed=Q(3000, "rpm")).attrs["speed"] == pytest.approx(3000 * rpm, rel=1e-14)
    run = bd.transient(app, speed=0.0, dt=Q(10, "us"), steps=1, record=["rotor.centre.y"])
    assert run.attrs["dt"] == pytest.approx(1e-5)


def test_a_quantity_of_something_else_is_refused_by_name(ureg: Any) -> None:
    Q = ureg.Quantity
    with pytest.raises(ValueError, match=r"width is 16 megapascal; it must be in m"):
        bd.Layer(0.026, 0.028, width=Q(16, "MPa"), material=RUBBER)
    with pytest.raises(ValueError, match=r"vector\[3\] is 30 newton; it must be in N m"):
        bench().load("rotor.centre", (0, 0, 0, Q(30, "N"), 0, 0))
    with pytest.raises(ValueError, match=r"speed is 50 hertz; it must be in rad/s, and 1 Hz is 2π rad/s"):
        bd.modes(bench(), speed=Q(50, "Hz"))
    with pytest.raises(ValueError, match=r"frequency is .* it must be in Hz"):
        bd.frequency_response(bench(), Q([50.0], "rad/s"), ["rotor.centre.y"], ["rotor.centre.y"])
    with pytest.raises(ValueError, match="entries one by one"):
        bench().load("rotor.centre", Q([0, 1, 0, 0, 0, 0], "N"))


# ------------------------------------------------------------------------------------------------ display


def test_a_result_can_be_shown_in_other_units() -> None:
    place = ["rotor.centre.y", "rotor.centre.y.velocity", "rotor.centre.θx"]
    run = bd.transient(bench(), rpm=3000, dt=1e-5, steps=20, record=place)
    shown = units.display(run, "µm", "ms")
    assert shown["unit"].values.tolist() == ["µm", "m/s", "rad"]
    assert shown["time"].attrs["units"] == "ms"
    assert shown["time"].values == pytest.approx(1e3 * run["time"].values)
    assert shown["record"].values[:, 0] == pytest.approx(1e6 * run["record"].values[:, 0])
    assert np.array_equal(shown["record"].values[:, 1:], run["record"].values[:, 1:])
    assert run["time"].attrs["units"] == "s", "the result given is left as it is"
    speeds = units.display(bd.campbell(bench(), rpm=[0, 3000]), "rpm", "kHz")
    assert speeds["speed"].values == pytest.approx([0, 3000])
    with pytest.raises(ValueError, match="'MPa'; nothing in this result"):
        units.display(run, "MPa")
    with pytest.raises(ValueError, match="of the same"):
        units.display(run, "mm", "µm")
