"""Figures of a measurement: what is drawn is what was measured, in the axes given."""

from __future__ import annotations

import math
from dataclasses import replace

import matplotlib as mpl
import numpy as np
import pytest

from bearingdyn import plot
from bearingdyn.material import fit_dense, fit_maxwell, kk_ratio, master_curve, read_dma, sample_dma_path

mpl.use("Agg")
import matplotlib.pyplot as plt

SOLID = {"K": 2e9, "density": 1200.0}


@pytest.fixture(scope="module")
def dma():
    """The made measurement."""
    return read_dma(sample_dma_path())


@pytest.fixture(scope="module")
def master(dma):
    """Its master curve."""
    return master_curve(dma)


@pytest.fixture(autouse=True)
def _closed():
    yield
    plt.close("all")


def test_causality_shows_every_ratio_and_crosses_what_is_left_out(dma):
    """A line per isotherm; the flagged point is crossed; its axes are those given."""
    ax = plt.figure().add_subplot()
    assert plot.causality(dma, ax) is ax
    drawn = np.concatenate([line.get_ydata() for line in ax.lines if len(line.get_xdata()) > 2])
    np.testing.assert_array_equal(drawn, kk_ratio(dma))
    f = np.tile(np.logspace(0, 2, 9), 5)
    T = np.repeat([0.0, 10.0, 20.0, 30.0, 40.0], 9)
    # below 30 Hz the loss that belongs to this storage: (π/2) dG′/d ln ω
    loss = math.pi / 2 * 0.2 * 3e6 * f**0.2 * np.where(f > 30, (f / 30) ** 2, 1.0)
    ringing = replace(dma, frequency=f, temperature=T, storage=3e6 * f**0.2, loss=loss, isotherm=None)
    ax = plot.causality(ringing)
    crosses = [line for line in ax.lines if line.get_marker() == "x"]
    assert len(crosses) == 1
    assert crosses[0].get_xdata().min() > 30


@pytest.mark.parametrize("kind", ["dma", "master"])
def test_cole_cole_and_van_gurp_palmen_show_the_points(dma, master, kind):
    """Free of frequency: the same points whether shifted or not, and the model through them."""
    data = {"dma": dma, "master": master}[kind]
    model = fit_maxwell(master, 5, **SOLID)
    ax = plot.cole_cole(data, model)
    points = np.asarray(ax.collections[0].get_offsets())
    np.testing.assert_allclose(points, np.column_stack([data.storage, data.loss]) / 1e6, rtol=1e-14)
    ax = plot.van_gurp_palmen(data, model)
    points = np.asarray(ax.collections[0].get_offsets())
    np.testing.assert_allclose(points[:, 0], np.hypot(data.storage, data.loss) / 1e6, rtol=1e-14)
    np.testing.assert_allclose(np.tan(np.radians(points[:, 1])), data.tan_delta, rtol=1e-12)
    x, y = ax.lines[0].get_data()
    near = np.interp(np.log(points[:, 0]), np.log(x), y)
    # 1 % noise on either modulus: 0.4° on δ, and what it moves along |G*|
    assert np.abs(near - points[:, 1]).mean() < 1.0


def test_spectrum_shows_every_branch(master):
    """Few branches and the dense spectrum, both in full."""
    few, dense = fit_maxwell(master, 5, **SOLID), fit_dense(master, **SOLID)
    ax = plot.spectrum_of({"five": few, "dense": dense})
    for line, model in zip(ax.lines, (few, dense), strict=True):
        np.testing.assert_array_equal(line.get_xdata(), model.spectrum()[0])
        np.testing.assert_array_equal(line.get_ydata(), model.spectrum()[1] / 1e6)
    with pytest.raises(ValueError, match="nothing to draw"):
        plot.spectrum_of({})


def test_shifts_show_a_joined_law(dma):
    """Points of the isotherms and the law through them."""
    master = master_curve(dma, law="joined")
    ax = plot.shifts(master)
    grid, values = ax.lines[1].get_data()
    np.testing.assert_allclose(values, master.law.log_shift(grid), rtol=1e-14)
