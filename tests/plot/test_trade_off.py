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


def test_small_numbers_are_written_in_a_multiple_of_their_unit_and_no_factor_stands_apart():
    cases = [
        study.Case({"i": i}, {"sag": s, "peak": 1e-12 / s, "rate": 1e7 * s, "load": 3e-9 / s})
        for i, s in enumerate((1e-5, 2e-5, 4e-5))
    ]
    table = study.table(cases, {"sag": "m", "peak": "m/N", "rate": "1/s"})
    ax = plot.trade_off(table, "sag", "peak", "rate")
    ax.figure.canvas.draw()
    assert (ax.get_xlabel(), ax.get_ylabel()) == ("sag, µm", "peak, nm/N")
    # the axes hold metres, their ticks are micrometres
    np.testing.assert_allclose(ax.collections[0].get_offsets()[:, 0], [1e-5, 2e-5, 4e-5], rtol=1e-15)
    written = dict(zip(ax.get_xticks(), (t.get_text() for t in ax.get_xticklabels()), strict=True))
    assert all(float(text) == pytest.approx(value * 1e6, abs=1e-9) for value, text in written.items())
    for axis in (a for axes in ax.figure.axes for a in (axes.xaxis, axes.yaxis)):
        assert axis.get_offset_text().get_text() == ""
    # the legend stands above the points
    assert ax.get_legend().get_window_extent().y0 >= ax.get_window_extent().y1
    bare = plot.trade_off(table, "load", "rate")
    assert (bare.get_xlabel(), bare.get_ylabel()) == ("load, 10⁻⁶", "rate, 1/s")


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
