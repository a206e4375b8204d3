"""The picture of a study: every case where its numbers say, the front ringed, axes with their units."""

from __future__ import annotations

import matplotlib as mpl
import numpy as np
import pytest

mpl.use("Agg")

import matplotlib.pyplot as plt

from bearingdyn import plot, study

POINTS = [(1.0, 5.0), (2.0, 4.0), (2.0, 3.0), (4.0, 3.0), (4.0, 1.0), (np.nan, 0.0)]


@pytest.fixture(autouse=True)
def _closed():
    yield
    plt.close("all")


@pytest.fixture
def table():
    cases = [
        study.Case({"i": i, "rubber": "soft"}, {"k": k, "peak": peak, "power": 10.0**i})
        for i, (k, peak) in enumerate(POINTS)
    ]
    return study.table(cases, {"k": "N/m", "peak": "m/N"})


def test_cases_lie_where_their_numbers_say_and_the_front_is_ringed_and_joined(table):
    ax = plot.trade_off(study.pareto(table, minimise=["k", "peak"]), "k", "peak")
    np.testing.assert_array_equal(ax.collections[0].get_offsets(), POINTS[:5])
    (front,) = ax.get_lines()
    # by hand: (2, 4) loses to (2, 3), (4, 3) to (4, 1)
    np.testing.assert_array_equal(front.get_xydata(), [(1, 5), (2, 3), (4, 1)])
    assert front.get_linestyle() == "-"
    assert "3 of 5" in front.get_label()
    assert (ax.get_xlabel(), ax.get_ylabel()) == ("k, N/m", "peak, m/N")


def test_third_aim_is_a_colour_and_its_front_is_not_joined(table):
    ax = plot.trade_off(study.pareto(table, minimise=["k", "peak", "power"]), "k", "peak", "power")
    np.testing.assert_array_equal(ax.collections[0].get_array(), [1.0, 10.0, 100.0, 1000.0, 10000.0])
    assert ax.get_lines()[0].get_linestyle() == "None"
    assert any(other.get_ylabel() == "power" for other in ax.figure.axes)


def test_front_is_ringed_only_where_the_case_is_drawn(table):
    marked = study.pareto(table, minimise=["k", "peak"])
    hidden = marked.assign(power=("case", [1.0, 2.0, np.nan, 4.0, 5.0, 6.0]))
    ax = plot.trade_off(hidden, "k", "peak", "power")
    np.testing.assert_array_equal(ax.get_lines()[0].get_xydata(), [(1, 5), (4, 1)])
    assert "2 of 4" in ax.get_lines()[0].get_label()


def test_wide_positive_columns_have_logarithmic_axes(table):
    ax = plot.trade_off(table, "k", "power")
    assert (ax.get_xscale(), ax.get_yscale()) == ("linear", "log")
    assert not ax.get_lines()


def test_axes_given_are_drawn_into(table):
    _, given = plt.subplots()
    assert plot.trade_off(table, "k", "peak", ax=given) is given


@pytest.mark.parametrize("name", ["rubber", "error", "nothing"])
def test_column_that_holds_no_numbers_is_refused(table, name):
    with pytest.raises(ValueError, match=f"'{name}' is no column of numbers"):
        plot.trade_off(table, "k", name)


def test_study_without_a_finite_case_is_refused():
    failed = study.table([study.Case({"k": 1.0}, {"y": np.nan})])
    with pytest.raises(ValueError, match="no case has a finite number"):
        plot.trade_off(failed, "k", "y")
