"""The sheet says of every bearing what the single functions say, and names what it doubts."""

from __future__ import annotations

import math
import warnings
from dataclasses import replace

import numpy as np
import pytest

import bearingdyn as bd
from bearingdyn.analysis import single_bearing
from bearingdyn.bearing import Running, equivalent_life, load_distribution, rating_life
from bearingdyn.bearing.rating import Phase, modified_life
from bearingdyn.demo import motor
from bearingdyn.notice import BearingWarning

OIL = bd.bearing.Lubricant(bd.bearing.Walther.iso_vg(32))
SPEED = 3000 * math.pi / 30
BALL = bd.catalogue.bearing("6205")


def one(name: str = "6205", **load: float) -> bd.Equilibrium:
    return single_bearing(bd.catalogue.bearing(name), name="b", **load)


def test_single_bearing_is_that_of_the_single_functions():
    sheet = bd.bearing_sheet(one(radial=2000.0, axial=300.0), speed=SPEED, oil=OIL, temperature=70.0)
    row = sheet.sel(bearing="b")
    # the shaft holds the ring upright, as a large bearing arm would: find the tilts' moment first
    q = np.zeros(6)
    for _ in range(30):  # Newton on x, y, z with tilts held
        r = np.array([0, -2000.0, 300.0]) - BALL.force(q)[:3]
        q[:3] += np.linalg.solve(BALL.stiffness(q)[:3, :3], r) if q.any() else [0, -3e-5, 5e-5]
    found = load_distribution(BALL, q)
    k = int(found.load_inner.argmax())
    # 1e9 N m/rad hold the tilts
    assert float(row["ball_load"]) == pytest.approx(found.load_inner[k], rel=1e-4)
    assert float(row["pressure_inner"]) == pytest.approx(found.pressure_inner[k], rel=1e-4)
    assert float(row["pressure_outer"]) == pytest.approx(found.pressure_outer[k], rel=1e-4)
    assert float(row["contact_angle"]) == pytest.approx(found.angle_inner[k], rel=1e-3)
    assert float(row["L10rh"]) == pytest.approx(float(row["L10r"]) * 1e6 / 3000 / 60, rel=1e-9)
    life = modified_life(
        float(row["L10r"]), float(row["C"]) / float(row["L10r"]) ** (1 / 3), C0=float(row["C0"]),
        Dpw=BALL.Dpw, speed=SPEED, viscosity=OIL.kinematic.viscosity(70.0),
    )  # fmt: skip
    assert float(row["L10mh"]) == pytest.approx(life.hours, rel=1e-9)
    assert float(row["kappa"]) == pytest.approx(life.kappa, rel=1e-12)


def test_life_of_a_pure_thrust_is_the_reference_life():
    row = bd.bearing_sheet(one("7205", axial=2000.0)).sel(bearing="b")
    assert float(row["L10r"]) == pytest.approx(
        rating_life(bd.catalogue.bearing("7205"), (0, 0, 2000.0, 0, 0, 0)), rel=1e-9
    )
    assert float(row["loaded_balls"]) == 13


def test_lines_are_of_the_loaded_angle():
    """theory.md §4.5: the ball pass of a 6202 under thrust stands a percent above the nominal one."""
    row = bd.bearing_sheet(one("6202", axial=180.0), speed=SPEED).sel(bearing="b")
    nominal = bd.catalogue.bearing("6202").frequencies(SPEED).BPFO
    assert 1.005 < float(row["BPFO"]) / nominal < 1.03


def test_all_bearings_of_an_equilibrium_at_once():
    state = bd.equilibrium(motor(None))
    sheet = bd.bearing_sheet(state, speed=SPEED, oil=OIL, temperature={"left": 60.0, "right": 80.0})
    assert sheet["bearing"].values.tolist() == ["left", "right"]
    assert sheet["temperature"].values.tolist() == [60.0, 80.0]
    total = sum(float(sheet["radial_load"].sel(bearing=b)) for b in ("left", "right"))
    assert total == pytest.approx(1000.0, rel=1e-3)
    for name in ("left", "right"):
        K = state.bearings[name].K
        assert float(sheet["stiffness_y"].sel(bearing=name)) == K[1, 1]
    assert all("units" in v.attrs for v in sheet.variables.values())


def test_a_flexible_ring_is_rated_by_its_own_balls():
    """The life of loads that no rigid ring would have: from the sheet and by hand."""
    state = one(radial=2000.0)
    skewed = state.bearings["b"]
    Q = skewed.loads * np.linspace(0.5, 1.5, skewed.loads.size)
    other = replace(state, bearings={"b": replace(skewed, loads=Q)})
    assert float(bd.bearing_sheet(other)["L10r"][0]) == pytest.approx(
        bd.bearing.life_of_loads(BALL, Q), rel=1e-12
    )


def test_a_duty_cycle_follows_miner():
    light, heavy = one(radial=1000.0), one(radial=3000.0)
    sheet = bd.bearing_sheet(light, duty=[(light, 100.0, 60.0, 0.7), (heavy, 200.0, 60.0, 0.3)])
    lives = [float(bd.bearing_sheet(s)["L10r"][0]) for s in (light, heavy)]
    by_hand = equivalent_life([Phase(0.7, 100.0, lives[0]), Phase(0.3, 200.0, lives[1])])[1]
    assert float(sheet["duty_life"][0]) == pytest.approx(by_hand, rel=1e-12)


def test_what_one_phase_of_a_duty_cycle_asks_too_much_is_named():
    """Its load, and its film, for which ISO 281 has no factor: then the cycle has no life."""
    light, heavy = one(radial=1000.0), one(axial=20_000.0)
    with pytest.warns(BearingWarning, match=r"'b': duty\[1\]: loaded above its static rating: P0 is 10000 N"):
        sheet = bd.bearing_sheet(light, duty=[(light, 100.0, 60.0, 0.7), (heavy, 200.0, 60.0, 0.3)])
    assert math.isfinite(float(sheet["duty_life"][0]))
    with pytest.warns(BearingWarning, match=r"duty\[0\]: kappa is 0\.0"):
        slow = bd.bearing_sheet(light, oil=OIL, duty=[(light, 1.0, 60.0, 0.7), (light, 100.0, 60.0, 0.3)])
    assert math.isnan(float(slow["duty_life"][0]))
    assert "duty[0]" in str(slow["warnings"].values[0])


def test_makers_ratings_are_taken_where_given():
    sheet = bd.bearing_sheet(one(radial=2000.0), C={"b": 14000.0}, C0={"b": 7850.0})
    assert float(sheet["L10"][0]) == pytest.approx(343.0, rel=1e-9)
    assert float(sheet["static_safety"][0]) == pytest.approx(7850 / 2000, rel=1e-9)


def test_too_much_load_and_too_thin_a_film_are_named():
    with pytest.warns(BearingWarning) as caught:
        sheet = bd.bearing_sheet(one(radial=9000.0), speed=1.0, oil=OIL, temperature=90.0)
    told = sheet["warnings"].values[0]
    assert "loaded above its static rating: P0 is 9000 N" in told
    assert "ISO 281 has no a_ISO below 0.1" in told
    assert any("static rating" in str(w.message) for w in caught)
    assert math.isnan(float(sheet["L10mh"][0]))


@pytest.mark.parametrize("model", ["palmgren", "four-term"])
def test_a_load_above_the_rating_is_told_once(model: str) -> None:
    """Life and friction would each tell of it too."""
    eq = one(radial=9000.0)
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        bd.bearing_sheet(
            eq, speed=SPEED, oil=OIL, temperature=40.0, friction_model=model, duty=[(eq, SPEED, 40.0, 1.0)]
        )
    told = [str(w.message) for w in caught if "above" in str(w.message) and "static rating" in str(w.message)]
    assert len([text for text in told if "duty[0]" not in text]) == 1
    assert len(told) == 2  # the phase of the duty is another state


def test_a_bearing_that_carries_nothing_is_named():
    with pytest.warns(BearingWarning, match="'b': it carries no load"):
        sheet = bd.bearing_sheet(one())
    assert "no load" in str(sheet["warnings"].values[0])


def test_a_low_shoulder_cuts_the_ellipse():
    state = one("7205", axial=4000.0)
    with pytest.warns(BearingWarning, match="shoulder cuts"):
        low = bd.bearing_sheet(state, shoulder={"b": 1.0e-3})
    high = bd.bearing_sheet(state, shoulder={"b": 2.2e-3})
    assert float(low["cut_inner"][0]) > 0
    assert float(high["cut_inner"][0]) == 0
    # Harris' edge of the groove: arccos(1 − h/r)
    ball = bd.catalogue.bearing("7205")
    edge = math.acos(1 - 1.0e-3 / (0.52 * ball.Dw))
    half = float(low["ellipse_inner"][0]) / 2
    reach = math.asin(half / (2 * 0.52 * ball.Dw / 2.04))
    share = (float(low["contact_angle"][0]) + reach - edge) / (2 * reach)
    assert float(low["cut_inner"][0]) == pytest.approx(share, rel=1e-9)


def test_pages_hold_every_number_that_is_known():
    sheet = bd.bearing_sheet(bd.equilibrium(motor(None)), speed=SPEED, oil=OIL, temperature=70.0)
    text, page = bd.sheet_text(sheet), bd.sheet_html(sheet, "A <motor>")
    for words in ("basic reference rating life", "viscosity ratio κ", "cage, Hz", "frictional power, W"):
        assert words in text
    assert "film over roughness" not in text  # no roughness, no line
    assert "A &lt;motor&gt;" in page
    assert page.count("<td>") > 100
    assert f"{float(sheet['L10mh'][0]):.0f}" in page
    assert "NSK" in page


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"eq": "6205"}, "^eq is '6205'; it must be an equilibrium"),
        ({"speed": math.nan}, "^speed is nan"),
        ({"oil": "VG32"}, "^oil is 'VG32'"),
        ({"C": {"bear": 1e4}}, "^C is 'bear'; "),
        ({"C0": {"b": -1.0}}, "^C0 of bearing 'b' is -1.0"),
        ({"shoulder": {"b": math.nan}}, "^shoulder of bearing 'b' is nan"),
        ({"roughness": -1e-8}, "^roughness is -1e-08"),
        ({"duty": [(1, 2, 3)]}, r"^duty\[0\] is \(1, 2, 3\)"),
        ({"oil": OIL, "speed": 100.0, "contamination": 1.5}, "^contamination is 1.5"),
        ({"oil": OIL, "speed": 100.0, "temperature": 230.0}, "^T is 230"),
    ],
)
def test_bad_input_is_named(change, message):
    given = {"eq": one(radial=1000.0), **change}
    with pytest.raises(ValueError, match=message):
        bd.bearing_sheet(**given)


def test_at_speed_the_balls_press_outwards_and_live_less():
    """Each race has its own loads: at 10 000 rpm the outer one of a 6205 bears more."""
    state = Running(BALL, 10_000 * math.pi / 30)
    q = state.displacement((0, -500.0, 200.0, 0, 0, 0))
    found = load_distribution(state, q)
    still = bd.bearing.life_of_loads(BALL, found.load_inner)
    assert bd.bearing.life_of_loads(BALL, found.load_inner, found.load_outer) < still
