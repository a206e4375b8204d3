"""Traces over time show the samples of the record, each unit on axes of its own."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise

import matplotlib as mpl
import numpy as np
import pytest
import xarray

mpl.use("Agg")

import matplotlib.pyplot as plt

from bearingdyn import plot
from bearingdyn.analysis import equilibrium, spectrum, transient
from bearingdyn.results import dataset
from rotors import oscillator


@pytest.fixture(autouse=True)
def _closed() -> Iterator[None]:
    yield
    plt.close("all")


def record(n: int = 1000) -> xarray.Dataset:
    """A motion of 2 µm about −40 µm, another, a velocity and a count, at 10 kHz."""
    t = np.arange(n) * 1e-4
    y = -40e-6 + 2e-6 * np.sin(2 * np.pi * 50.0 * t)
    rows = [y, 1e-6 * np.cos(t), 2e-3 * np.sin(30 * t), 7.0 + (t > t[n // 2])]
    made = dataset(
        {"record": (("time", "channel"), np.stack(rows, axis=1), "", "record")},
        {"dt": 1e-4, "decimate": 1},
        {"time": (t, "s"), "channel": (["a.y", "a.x", "a.y.velocity", "left.loaded"], "")},
    )
    return made.assign_coords(unit=("channel", ["m", "m", "m/s", "1"]))


def test_channels_in_one_unit_share_axes_that_hold_the_samples_themselves() -> None:
    data = record()
    upper = plot.time({"run": data})
    panels = upper.figure.axes
    assert [p.get_ylabel() for p in panels] == ["displacement, µm", "velocity, mm/s", "loaded balls"]
    assert [len(p.get_lines()) for p in panels] == [2, 1, 1]
    assert panels[0] is upper
    assert panels[-1].get_xlabel() == "time, s"
    lines = [line for p in panels for line in p.get_lines()]
    for k, line in enumerate(lines):
        np.testing.assert_array_equal(line.get_xdata(), data["time"])
        np.testing.assert_array_equal(line.get_ydata(), data["record"].values[:, k])
        assert line.get_label() == data["channel"].values[k]
    upper.figure.canvas.draw()
    # −40 µm is written −40, and no factor stands elsewhere
    assert "−40" in [t.get_text() for t in upper.get_yticklabels()]
    assert not any(p.yaxis.get_offset_text().get_text() for p in panels)
    # one above the other, between the same edges
    assert len({(round(p.get_position().x0, 6), round(p.get_position().x1, 6)) for p in panels}) == 1


def test_a_long_trace_is_thinned_and_keeps_its_peaks_and_ends() -> None:
    data = record(100_001)
    data["record"][54_321, 0] = 1e-3
    data["record"][100_000, 0] = -1e-3
    (line,) = plot.time({"run": data}, ["a.y"]).get_lines()
    t, y = np.asarray(line.get_xdata()), np.asarray(line.get_ydata())
    # two of a stretch, its ends and the last, shorter stretch
    assert 10_000 < t.size <= 20_000 + 12
    assert (np.diff(t) > 0).all()
    assert (t[0], t[-1]) == (data["time"].values[0], data["time"].values[-1])
    assert y[t == data["time"].values[54_321]] == [1e-3]
    assert y[-1] == -1e-3
    at = np.searchsorted(data["time"].values, t)
    np.testing.assert_array_equal(y, data["record"].values[at, 0])


def test_span_and_mean() -> None:
    ax = plot.time({"run": record()}, ["a.y"], span=(0.01995, 0.06005), about_mean=True)
    (line,) = ax.get_lines()
    t = np.asarray(line.get_xdata())
    assert (t[0], t[-1]) == pytest.approx((0.02, 0.06), abs=1e-12)
    # five whole turns: the mean is −40 µm, its rounding 1e-20 m
    np.testing.assert_allclose(line.get_ydata(), 2e-6 * np.sin(100 * np.pi * t), atol=1e-18)
    assert ax.get_title(loc="left") == "a.y over time, less the mean"


def test_marches_are_told_apart_by_label() -> None:
    one = plot.time({"soft": record(), "stiff": record()}, ["a.y"])
    assert [line.get_label() for line in one.get_lines()] == ["soft", "stiff"]
    assert one.get_title(loc="left") == "a.y over time"
    two = plot.time({"soft": record(), "stiff": record()}, ["a.y", "a.x"])
    assert [line.get_label() for line in two.get_lines()] == [
        "soft: a.y", "stiff: a.y", "soft: a.x", "stiff: a.x",
    ]  # fmt: skip


def test_march_of_an_oscillator_is_drawn_as_it_is() -> None:
    run = transient(
        equilibrium(oscillator()), speed=0.0, dt=1e-5, steps=500,
        record=["body.centre.y", "body.centre.y.velocity"], initial={"body.centre": [0, 2e-6, 0, 0, 0, 0]},
    )  # fmt: skip
    upper = plot.time({"run": run})
    np.testing.assert_array_equal(upper.get_lines()[0].get_ydata(), run["record"].values[:, 0])
    assert upper.get_ylabel() == "displacement, µm"


def test_axes_given_are_shared_out() -> None:
    figure = plt.figure()
    free = figure.add_axes((0.1, 0.1, 0.3, 0.6))
    assert plot.time({"run": record()}, ax=free) is free
    boxes = [a.get_position() for a in figure.axes]
    assert len(boxes) == 3
    assert (boxes[0].y1, boxes[-1].y0) == pytest.approx((0.7, 0.1))
    assert all(low.y1 < high.y0 for high, low in pairwise(boxes))


def test_what_cannot_be_drawn_is_refused() -> None:
    with pytest.raises(ValueError, match=r"channel 'a\.z' of 'run' was not recorded"):
        plot.time({"run": record()}, ["a.z"])
    with pytest.raises(ValueError, match="has no record over time"):
        plot.time({"run": spectrum(record(), "a.y")})
    with pytest.raises(ValueError, match="no sample in it"):
        plot.time({"run": record()}, span=(5.0, 6.0))
    with pytest.raises(ValueError, match="no channel to draw"):
        plot.time({"run": record()}, [])
