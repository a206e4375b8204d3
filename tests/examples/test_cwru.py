"""The rig of Case Western Reserve University: what holds, on the measured records or on made ones."""

from __future__ import annotations

import math
import warnings

import cwru
import cwru_fit
import cwru_rig
import cwru_signal
import numpy as np
import pytest

import bearingdyn as bd
from bearingdyn.notice import CoarseStep
from measured import DATA

SIDEBANDS = ("1-2", "1-1", "1+1", "1+2")


@pytest.fixture(scope="module")
def found():
    records = cwru.load_records(DATA / "cwru")
    if records is None:
        pytest.skip(f"measured data {DATA / 'cwru'} are not here")
    return cwru.compare(cwru_rig.Rig(), records, seconds=2.0)


@pytest.mark.slow
def test_lines_stand_where_they_are_measured(found):
    """Of both races, within .5 %: the line of the work's list. The fan end's thrust sets both."""
    for lines in found.values():
        assert max(abs(frequency) for frequency, _, _ in lines.values()) < 5e-3


@pytest.mark.slow
def test_levels_of_the_record_that_was_fitted(found):
    """All lines and sidebands of the first two orders within 1.5 dB (found: 1.1 in 4 s), of the third in 4.

    Third: 3-1 and 3+2 are 2.9 and 3.1 dB high, lines that scatter by 1.1 and 1.5 dB in the record itself.
    """
    levels = {name: abs(level) for name, (_, level, _) in found["inner"].items()}
    assert max(level for name, level in levels.items() if name[0] in "12") < 1.5
    assert max(levels.values()) < 4.0


@pytest.mark.slow
def test_levels_of_the_record_that_was_not_fitted(found):
    """Predicted within the 3 dB of the line that are asked; NOT so the third harmonic, -4.3 dB."""
    lines = found["outer"]
    assert max(abs(lines[name][1]) for name in ("1", "2")) < 3.0
    assert max(abs(against) for _, _, against in lines.values()) < 3.0
    assert -5.0 < lines["3"][1] < -3.0


@pytest.mark.slow
def test_the_fit_is_that_of_the_record():
    """Begun at the example's own numbers it stays there: the lines alone explain 89 % of their power."""
    records = cwru.load_records(DATA / "cwru")
    if records is None:
        pytest.skip(f"measured data {DATA / 'cwru'} are not here")
    record, rpm = records["inner"]
    rig = cwru_rig.Rig()
    _, force, near = cwru_rig.run(
        rig, cwru_rig.ball_bearing(rig, "inner", cwru_rig.SPALL, cwru_rig.BELOW), rpm, 2.0
    )
    fitted, left = cwru_fit.fit_lines(rig, record[: len(force)], force, near)
    assert left < 0.15
    # the envelope, which comes after, moves the modes by less than their half widths, 140 Hz to 35 Hz
    assert np.abs(np.subtract(fitted.frequency, rig.frequency)).max() < 100.0


@pytest.mark.slow
def test_growth_with_size_is_what_the_example_says():
    """0.25, 0.48, 0.37 g and 0.43, 0.66, 0.58 g, kurtosis 5 to 8, quoted in its text: rounded to 2 %."""
    found = cwru.growth(cwru_rig.Rig(), 0.5)
    for body, said in (("inner", (0.25, 0.48, 0.37)), ("outer", (0.43, 0.66, 0.58))):
        assert [rms for rms, _ in found[body]] == pytest.approx(said, rel=0.04)
        assert all(5 < kurtosis < 8 for _, kurtosis in found[body])


def test_a_hole_lets_go_of_a_part_of_a_contact():
    """As much as the ellipse has over it: all of it, none, half, and as of a strip by quadrature."""
    rig = cwru_rig.Rig()
    ball = cwru_rig.ball_bearing(rig, None, 0.0, 0.0)
    contact, load = ball.outer_contact, 20.0
    (a, b), whole = contact.semi_axes(load), contact.approach(load)
    width, depth = cwru_rig.hole(ball, "outer", 2 * a, load)
    assert (width, depth) == (pytest.approx(2 * a + 2 * b), pytest.approx(whole))
    assert cwru_rig.hole(ball, "outer", a, load, aside=1.6)[1] == pytest.approx(0.0, abs=1e-12)
    assert cwru_rig.hole(ball, "outer", 2 * a, load, aside=1.0)[1] == pytest.approx(
        whole * (1 - 0.5 ** (2 / 3))
    )
    # pressure sqrt(1 - x² - y²) over the strip |x| < .3
    x = np.linspace(-0.3, 0.3, 2001)
    share = np.trapezoid(math.pi / 2 * (1 - x**2), x) / (2 * math.pi / 3)
    assert cwru_rig.hole(ball, "outer", 0.6 * a, load)[1] == pytest.approx(
        whole * (1 - (1 - share) ** (2 / 3)), rel=1e-6
    )


def test_the_housing_answers_as_its_modes_say():
    """The superelement by `frequency_response` against `felt_at`, from which the fit is made."""
    rig = cwru_rig.Rig()
    app = bd.Application()
    app.add("housing", cwru_rig.housing(rig))
    app.free("housing.bore")
    eq = bd.equilibrium(app)
    frequency = np.array([2600.0, 2900.0, 3300.0, 3700.0])
    found = bd.frequency_response(
        eq, frequency, inputs=["housing.bore.y", "housing.bore.z"], outputs=["housing.top.y"]
    )["response"].values[:, 0, :]
    own = np.array(cwru_rig.felt_at(rig, frequency)).T * cwru_rig.G
    assert np.allclose(-((2 * math.pi * frequency[:, None]) ** 2) * found, own, rtol=1e-6)


def test_the_records_repeat_themselves_better_than_the_model_does_it():
    """So that its own scatter, or slip that spreads the lines, is no excuse for what is not within 3 dB.

    Found: .16 dB of the inner race's line, at most .62 of its sidebands and 1.27 of the second's; spread at
    most .63. Of the outer race's three lines at most .1.
    """
    records = cwru.load_records(DATA / "cwru")
    if records is None:
        pytest.skip(f"measured data {DATA / 'cwru'} are not here")
    record, rpm = records["outer"]
    outer = cwru_signal.repeats(record, "outer", {"outer": 105.0, "shaft": rpm / 60})
    assert max(scatter for scatter, _ in outer.values()) < 0.3
    record, rpm = records["inner"]
    found = cwru_signal.repeats(record, "inner", {"inner": 157.4, "shaft": rpm / 60})
    assert found["1"][0] < 0.3
    assert max(found[name][0] for name in SIDEBANDS) < 1.0
    assert max(scatter for name, (scatter, _) in found.items() if name[0] == "2") < 1.5
    assert max(abs(spread) for _, spread in found.values()) < 1.0


def test_slip_would_spread_a_line():
    """A made tone that wanders by a hertz, found in full in pieces of a quarter of a second alone."""
    t = np.arange(int(8 * cwru_rig.RATE)) / cwru_rig.RATE
    phase = 2 * math.pi * 157.0 * t + 2.0 * np.sin(2 * math.pi * 0.5 * t)
    wandering = (1.0 + 0.5 * np.cos(phase)) * np.cos(2 * math.pi * 3000.0 * t)
    still = (1.0 + 0.5 * np.cos(2 * math.pi * 157.0 * t)) * np.cos(2 * math.pi * 3000.0 * t)
    near = {"outer": 157.0, "shaft": 29.0}
    assert cwru_signal.repeats(wandering, "outer", near, 0.25)["1"][1] > 3.0  # J1(2) of it is left: 4.8 dB
    assert abs(cwru_signal.repeats(still, "outer", near, 0.25)["1"][1]) < 0.2


@pytest.mark.slow
def test_made_records_are_known_again(capsys):
    """The example without data: other modes and gains, by which the levels differ and the lines do not."""
    rig = cwru_rig.Rig()
    found = cwru.compare(rig, cwru.made_records(rig, 1.0), seconds=1.0)
    assert "outer race, predicted" in capsys.readouterr().out
    for lines in found.values():
        # a second resolves half a hertz of the lowest line
        assert max(abs(frequency) for frequency, _, _ in lines.values()) < 5e-3
    assert abs(found["outer"]["1"][1]) < 3.0


@pytest.mark.parametrize("body", ["inner", "outer"])
def test_a_labelled_record_has_the_steps_that_its_spall_asks_for(body):
    """`CoarseStep` asks for twenty in the passage of a ball; half of them are too few for it."""
    rig = cwru_rig.Rig()
    for width, rpm in ((0.1e-3, 1800.0), (0.2e-3, 1720.0)):
        ball = cwru_rig.ball_bearing(rig, body, width, 0.0)
        more = cwru_rig.steps_in_a_sample(ball, rpm)
        with warnings.catch_warnings():
            warnings.simplefilter("error", CoarseStep)
            cwru_rig.march(rig, ball, rpm, 1 / cwru_rig.RATE, [cwru_rig.SENSOR], more)
        with pytest.warns(CoarseStep):
            cwru_rig.march(rig, ball, rpm, 1 / cwru_rig.RATE, [cwru_rig.SENSOR], int(0.9 * more))
    assert cwru_rig.steps_in_a_sample(cwru_rig.ball_bearing(rig, None, 0.0, 0.0), 1800.0) == 10


def test_a_labelled_record_keeps_its_seed_and_its_truth(tmp_path):
    case = {"seed": 4, "seconds": 0.1, "folder": str(tmp_path)}
    truth, again = cwru.labelled(case), cwru.labelled(case)
    assert truth == again
    with np.load(tmp_path / "000004.npz") as kept:
        assert kept["drive_end"].shape == (1200,)
        assert kept["seed"] == 4
        assert all(math.isclose(kept[name], value) for name, value in truth.items())
