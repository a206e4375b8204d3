"""A waterfall shows the numbers it is given, over what changes."""

from __future__ import annotations

from collections.abc import Iterator

import matplotlib
import numpy as np
import pytest
import xarray

from bearingdyn import plot

matplotlib.use("Agg")


@pytest.fixture(autouse=True)
def _closed() -> Iterator[None]:
    import matplotlib.pyplot as plt

    yield
    plt.close("all")


def pieces(speed: np.ndarray) -> xarray.Dataset:
    frequency = np.linspace(0.0, 500.0, 51)
    amplitude = 1e-6 * np.exp(-(((frequency[None, :] - speed[:, None] / (2 * np.pi)) / 15.0) ** 2))
    data = xarray.Dataset(
        {
            "amplitude": (("time", "frequency"), amplitude, {"units": "m"}),
            "speed": ("time", speed, {"units": "rad/s"}),
        },
        coords={"time": np.arange(speed.size) * 0.1, "frequency": frequency},
        attrs={"channel": "shaft.disc.y"},
    )
    return data


def test_a_waterfall_stands_over_speed_in_a_run_up_and_over_time_else() -> None:
    run_up = plot.waterfall(pieces(np.linspace(100.0, 900.0, 9)), f_max=300.0)
    assert run_up.get_ylabel() == "speed, rpm"
    mesh = run_up.collections[0]
    assert mesh.get_array().shape == (9, 31)  # type: ignore[union-attr]
    # the largest line of each piece lies at the speed
    at = np.linspace(0.0, 300.0, 31)[np.asarray(mesh.get_array()).argmax(axis=1)]  # type: ignore[union-attr]
    assert at == pytest.approx(np.linspace(100.0, 900.0, 9) / (2 * np.pi), abs=5.0)  # lines are 10 Hz apart
    assert plot.waterfall(pieces(np.full(9, 300.0))).get_ylabel() == "time, s"
    with pytest.raises(ValueError, match="f_max"):
        plot.waterfall(pieces(np.full(9, 300.0)), f_max=-1.0)
