"""The rig of Case Western Reserve University: what holds, on the measured records or on made ones."""

from __future__ import annotations

import math
import warnings

import cwru
import numpy as np
import pytest

from bearingdyn.notice import CoarseStep
from measured import DATA


@pytest.fixture(scope="module")
def found():
    records = cwru.load_records(DATA / "cwru")
    if records is None:
        pytest.skip(f"measured data {DATA / 'cwru'} are not here")
    return cwru.compare(cwru.Rig(), records, seconds=2.0)


@pytest.mark.slow
def test_lines_stand_where_they_are_measured(found):
    """Of both races, within .5 %: the line of the work's list. The fan end's thrust sets both."""
    for lines in found.values():
        assert max(abs(frequency) for frequency, _, _ in lines.values()) < 5e-3


@pytest.mark.slow
def test_levels_of_the_record_that_was_fitted(found):
    assert max(abs(level) for _, level, _ in found["outer"].values()) < 3.0


@pytest.mark.slow
def test_sidebands_of_the_record_that_was_not_fitted(found):
    """Of the force, which knows no housing, within the 3 dB of the line that are asked.

    Found: -0.4, -0.5, -2.5, +1.0 dB. The sensor's are +2.3, +0.7, -3.0, -0.2 in 4 s: half a decibel is left
    for the length of the record.
    """
    assert max(abs(found["force"][name][2]) for name in cwru.SIDEBANDS) < 3.0
    assert max(abs(found["inner"][name][2]) for name in (*cwru.SIDEBANDS, "2")) < 3.5


@pytest.mark.slow
def test_level_of_the_record_that_was_not_fitted(found):
    """NOT within 3 dB: +5.4, in another bearing with another path to the sensor (the example says why)."""
    assert 3.0 < found["inner"]["1"][1] < 6.5


def test_the_record_that_was_not_fitted_repeats_itself_better_than_the_model_does_it():
    """So that its own scatter, or slip that spreads the lines, is no excuse for what is not within 3 dB.

    Found: .16 dB of the line, at most .62 of its sidebands and 1.27 of the second's; spread at most .63.
    """
    records = cwru.load_records(DATA / "cwru")
    if records is None:
        pytest.skip(f"measured data {DATA / 'cwru'} are not here")
    record, rpm = records["inner"]
    found = cwru.repeats(record, "inner", {"inner": 157.4, "shaft": rpm / 60})
    assert found["1"][0] < 0.3
    assert max(found[name][0] for name in cwru.SIDEBANDS) < 1.0
    assert max(scatter for name, (scatter, _) in found.items() if name[0] == "2") < 1.5
    assert max(abs(spread) for _, spread in found.values()) < 1.0


def test_slip_would_spread_a_line():
    """A made tone that wanders by a hertz, found in full in pieces of a quarter of a second alone."""
    t = np.arange(int(8 * cwru.RATE)) / cwru.RATE
    phase = 2 * math.pi * 157.0 * t + 2.0 * np.sin(2 * math.pi * 0.5 * t)
    wandering = (1.0 + 0.5 * np.cos(phase)) * np.cos(2 * math.pi * 3000.0 * t)
    still = (1.0 + 0.5 * np.cos(2 * math.pi * 157.0 * t)) * np.cos(2 * math.pi * 3000.0 * t)
    near = {"outer": 157.0, "shaft": 29.0}
    assert cwru.repeats(wandering, "outer", near, 0.25)["1"][1] > 3.0  # J1(2) of it is left: 4.8 dB
    assert abs(cwru.repeats(still, "outer", near, 0.25)["1"][1]) < 0.2


@pytest.mark.slow
def test_made_records_are_known_again(capsys):
    """The example without data: other modes and gains, by which the levels differ and the lines do not."""
    rig = cwru.Rig()
    found = cwru.compare(rig, cwru.made_records(rig, 1.0), seconds=1.0)
    assert "inner race, predicted" in capsys.readouterr().out
    for lines in found.values():
        # a second resolves half a hertz of the lowest line
        assert max(abs(frequency) for frequency, _, _ in lines.values()) < 5e-3
    assert abs(found["inner"]["1"][1]) < 3.0


@pytest.mark.parametrize("body", ["inner", "outer"])
def test_a_labelled_record_has_the_steps_that_its_spall_asks_for(body):
    """`CoarseStep` asks for twenty in the passage of a ball; half of them are too few for it."""
    rig = cwru.Rig()
    for width, rpm in ((0.1e-3, 1800.0), (0.2e-3, 1720.0)):
        ball = cwru.ball_bearing(rig, body, width, 0.0)
        more = cwru.steps_in_a_sample(ball, rpm)
        with warnings.catch_warnings():
            warnings.simplefilter("error", CoarseStep)
            cwru.march(rig, ball, rpm, 1 / cwru.RATE, [cwru.SENSOR], more)
        with pytest.warns(CoarseStep):
            cwru.march(rig, ball, rpm, 1 / cwru.RATE, [cwru.SENSOR], int(0.9 * more))
    assert cwru.steps_in_a_sample(cwru.ball_bearing(rig, None, 0.0, 0.0), 1800.0) == 10


def test_a_labelled_record_keeps_its_seed_and_its_truth(tmp_path):
    case = {"seed": 4, "seconds": 0.1, "folder": str(tmp_path)}
    truth, again = cwru.labelled(case), cwru.labelled(case)
    assert truth == again
    with np.load(tmp_path / "000004.npz") as kept:
        assert kept["drive_end"].shape == (1200,)
        assert kept["seed"] == 4
        assert all(math.isclose(kept[name], value) for name, value in truth.items())
