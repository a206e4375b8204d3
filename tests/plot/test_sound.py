"""Figures of sound: what the curves and colours show is what the results hold."""

from __future__ import annotations

import matplotlib.pyplot as plt
import numpy as np
import pytest
import xarray
from matplotlib import colormaps

from bearingdyn import plot


@pytest.fixture(autouse=True)
def closed():
    yield
    plt.close("all")


def contributions() -> xarray.Dataset:
    """A made one: two paths that add to 1 mW, then one that takes half of the other's away; a silent one."""
    alone = np.array([[4e-4, 1e-4, 0.0], [4e-3, 1e-3, 0.0]])
    shares = np.array([[7e-4, 3e-4, 0.0], [2e-3, -1e-3, 0.0]])
    return xarray.Dataset(
        {
            "power": ("frequency", [1e-3, 1e-3]),
            "path_power": (("frequency", "path"), shares), "path_alone": (("frequency", "path"), alone),
            "mode_power": (("frequency", "mode"), shares), "mode_alone": (("frequency", "mode"), alone),
        },
        {
            "frequency": [100.0, 200.0], "path": ["left", "right", "direct"],
            "mode": ["1: 90 Hz", "2: 210 Hz", "others"],
        },
        {"input": "shaft.y"},
    )  # fmt: skip


@pytest.mark.parametrize("by", ["path", "mode"])
def test_levels_and_shares_are_drawn(by: str) -> None:
    data = contributions()
    ax = plot.sound_contributions(data, by=by)
    together, *each = ax.get_lines()
    assert together.get_ydata() == pytest.approx([90.0, 90.0])
    assert [line.get_label() for line in each] == [str(n) for n in data[by].values[:2]]
    assert each[0].get_ydata() == pytest.approx(10 * np.log10([4e8, 4e9]))
    lower = ax.figure.axes[1]
    assert lower.get_lines()[0].get_ydata() == pytest.approx([70.0, 200.0])
    assert lower.get_lines()[1].get_ydata() == pytest.approx([30.0, -100.0])
    assert lower.get_ylabel() == "share, %"


def test_intensity_is_red_where_sound_leaves_and_white_where_none_does() -> None:
    corners = np.array(
        [[[0.0, 0, 0], [0, 0.1, 0], [0.1, 0, 0]], [[0.0, 0, 0], [0.1, 0, 0], [0, 0, 0.1]],
         [[0.0, 0, 0], [0, 0, 0.1], [0, 0.1, 0]], [[0.1, 0, 0], [0, 0.1, 0], [0, 0, 0.1]]]
    )  # fmt: skip
    data = xarray.Dataset(
        {
            "intensity": ("panel", [2e-6, 0.0, -2e-6, 1e-6], {"units": "W/(m² N²)"}),
            "corners": (("panel", "corner", "axis"), corners),
            "power": ((), 3e-9, {"units": "W/N²"}),
        },
        attrs={"frequency": 500.0, "input": "plate.y"},
    )
    ax = plot.sound_intensity(data)
    faces, pure = ax.collections[0], colormaps["RdBu_r"]([1.0, 0.5, 0.0, 0.75])
    # matplotlib sorts faces by depth; red less blue sorts both alike
    shown, pure = (c[np.argsort(c[:, 0] - c[:, 2])] for c in (faces.get_facecolor(), pure))
    # the light leaves .85 to all of a colour, and one hue
    assert (shown[:, :3] >= 0.85 * pure[:, :3] - 1e-9).all()
    assert (shown[:, :3] <= pure[:, :3] + 1e-9).all()
    assert ax.get_title(loc="left") == "500 Hz, plate.y: 3 nW/N²"
    assert ax.figure.axes[1].get_ylabel() == "sound intensity, µW/(m² N²)"
    low, high = ax.figure.axes[1].get_ylim()
    assert (low, high) == (-2e-6, 2e-6)
